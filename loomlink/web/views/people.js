import { h, table, facts, say, hash, sentence } from '../parts/dom.js';
import { get, post, put, at } from '../parts/api.js';
import { ask, hand_over } from '../parts/dialog.js';

const roles = [['designer', 'Designer'], ['approver', 'Approver'], ['operator', 'Operator'], ['engineer', 'Engineer'], ['admin', 'Administrator']];
const role_words = new Map(roles);

/** Who may do what here, whose keys looms trust, which machines' simulations count, and what the site asks for. */
export async function show({ refresh }) {
    const [{ people }, policy, { changes }, { signers }] = await Promise.all([get('/people'), get('/policy'), get('/trust/pending'), get('/signers')]);
    const done = text => answer => { if (answer) { say(text); refresh(); } };
    return {
        title: 'People',
        body: [h('div', { class: 'head' }, h('h1', {}, 'People'), h('button', { type: 'button', class: 'main', onclick: () => invite(refresh) }, 'Invite …')),
            table('People', ['Name', 'Full name', 'Roles', 'Key', 'Change'], people.map(person => [person.name, person.full_name,
                person.active ? person.roles.map(role => role_words.get(role)).join(', ') : h('span', { class: 'state' }, 'Disabled'), person.key ? hash(person.key, 8) : 'none', changes_of(person, done, refresh)])),
            trust(changes, done), h('div', { class: 'two' }, policy_card(policy, people, done), machines(signers, done, refresh))],
    };
}

const invitation = (title, answer) => hand_over({ title, text: 'Hand this link on by a safe way. It works once.', label: 'Link', value: `${location.origin}/join#${answer.code}` });

async function invite(refresh) {
    const answer = await ask({ title: 'Invite somebody', button: 'Make an invitation', fields: [{ name: 'roles', label: 'Roles', kind: 'checks', choices: roles }], act: values => post('/invitations', values) });
    if (answer) { await invitation('The invitation', answer); refresh(); }
}

function changes_of(person, done, refresh) {
    const button = (text, act) => h('button', { type: 'button', 'aria-label': `${text.replace(' …', '')}: ${person.full_name}`, onclick: act }, text);
    const reset = async () => {
        const answer = await ask({ title: `New key for ${person.full_name}`, text: 'The old key is revoked: what it signed stays, and it signs nothing more. The person joins again under the same name.', danger: true, button: 'Revoke and invite', act: () => post(at('people', person.name, 'reset')) });
        if (answer) { await invitation('The new invitation', answer); refresh(); }
    };
    const set_roles = () => ask({ title: 'Roles of ' + person.full_name, button: 'Set', fields: [{ name: 'roles', label: 'Roles', kind: 'checks', choices: roles, value: person.roles }], act: values => post(at('people', person.name, 'roles'), values) }).then(done('The roles are set'));
    const switch_over = () => post(at('people', person.name, person.active ? 'disable' : 'enable')).then(done(person.active ? 'Disabled: signed out everywhere' : 'Enabled'), error => say(error.message));
    return h('div', { class: 'buttons' }, button('Roles …', set_roles), button('New key …', reset), button(person.active ? 'Disable' : 'Enable', switch_over));
}

/** Looms believe releases by the keys of the newest list; only an administrator's signature makes a new one. */
function trust(changes, done) {
    const publish = () => ask({
        title: 'Sign the list of keys', text: 'Looms trust the keys of this list from now on, and no others.', button: 'Sign the list',
        fields: [{ name: 'password', label: 'Your password', kind: 'password', hint: 'It opens your key for this one signature.' }], act: values => post('/trust', { ...values, keep_server_keys: true }),
    }).then(done('The new list is signed'));
    return h('section', { class: changes.length ? 'notice' : 'card' }, h('h2', {}, 'Keys that looms trust'),
        changes.length === 0 ? h('p', {}, 'The signed list is as people are now.')
            : [h('p', {}, 'The signed list is not as people are now:'), h('ul', {}, changes.map(text => h('li', {}, sentence(text)))),
                h('button', { type: 'button', class: 'main', onclick: publish }, 'Sign the list …')]);
}

function policy_card(policy, people, done) {
    const approvers = people.filter(person => person.active && person.roles.includes('approver')).length;
    const lacking = [['approved', policy.approvals], ['released', policy.release_signatures]].filter(([, asked]) => asked > approvers);
    const percent = Number((100 * policy.coverage).toFixed(6)); // 0.07 is 7 %, whatever floating point makes of it
    const change = () => ask({
        title: 'Policy of the site', button: 'Put in force', fields: [
            { name: 'approvals', label: 'People who must approve', kind: 'number', value: policy.approvals }, { name: 'release_signatures', label: 'People who must sign a release', kind: 'number', value: policy.release_signatures },
            { name: 'simulation', label: 'Simulation before approval', kind: 'choice', value: policy.simulation, choices: [['required', 'Required'], ['optional', 'Not required']] },
            { name: 'fidelity', label: 'Least fidelity', kind: 'choice', value: policy.fidelity, choices: [['draft', 'draft'], ['standard', 'standard'], ['reference', 'reference']] },
            { name: 'coverage', label: 'Share of the crossings that simulations cover, in percent', kind: 'number', value: percent, min: 0, max: 100, step: 'any', hint: '0: any part will do' },
            { name: 'index_valid_hours', label: 'Hours that a loom may go on without the server', kind: 'number', value: policy.index_valid_hours }],
        act: values => put('/policy', { ...policy, ...values, coverage: values.coverage / 100 }),
    }).then(done('The policy is in force'));
    return h('section', { class: 'card' }, h('h2', {}, 'Policy of the site'), facts([['Approvals', policy.approvals], ['Signatures', `${policy.release_signatures} for a release`],
        ['Simulation', policy.simulation === 'required' ? `required, ${policy.fidelity} or better` + (percent > 0 ? `, of ${percent} % of the crossings` : '') : 'not required'], ['Without server', `a loom may go on for ${policy.index_valid_hours} hours`]]),
    lacking.map(([deed, asked]) => h('p', { class: 'soft' }, `Nothing can be ${deed} until more join: this asks for ${asked === 1 ? '1 approver' : asked + ' approvers'}, and there ${approvers === 1 ? 'is' : 'are'} ${approvers}.`)),
    h('p', { class: 'buttons' }, h('button', { type: 'button', onclick: change }, 'Change the policy …')));
}

function machines(signers, done, refresh) {
    const add = async () => {
        const answer = await ask({ title: 'Add a machine', button: 'Make a code', fields: [{ name: 'name', label: 'What it is called' }], act: values => post('/signers', values) });
        if (!answer) return;
        await hand_over({ title: 'The code for the machine', text: 'Give it to the machine by a safe way. It works once.', label: 'Code', value: answer.code });
        refresh();
    };
    const revoke = signer => ask({ title: `Revoke ${signer.name}`, text: 'Its simulations count no more.', danger: true, button: 'Revoke', act: () => post(at('signers', signer.name, 'revoke')) }).then(done('Revoked'));
    return h('section', { class: 'card' }, h('h2', {}, 'Machines whose simulations count'), signers.length === 0 ? h('p', { class: 'soft' }, 'None yet.')
        : h('ul', { class: 'plain' }, signers.map(signer => h('li', { class: 'row' }, h('strong', {}, signer.name), hash(signer.key),
            signer.revoked ? h('span', { class: 'state' }, 'Revoked') : h('button', { type: 'button', class: 'danger', 'aria-label': `Revoke ${signer.name}`, onclick: () => revoke(signer) }, 'Revoke …')))),
    h('p', { class: 'buttons' }, h('button', { type: 'button', onclick: add }, 'Add a machine …')));
}
