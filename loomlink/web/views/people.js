import { h, table, say, hash } from '../parts/dom.js';
import { get, post, put, at } from '../parts/api.js';
import { ask } from '../parts/dialog.js';

const roles = [['designer', 'Designer'], ['approver', 'Approver'], ['operator', 'Operator'], ['engineer', 'Engineer'], ['admin', 'Administrator']];

export async function show({ refresh }) {
    const [{ people }, policy] = await Promise.all([get('/people'), get('/policy')]);
    const done = text => answer => { if (answer) { say(text); refresh(); } };
    const invitation = (title, answer) => ask({ title, text: `Hand this link on by a safe way; it works once: ${location.origin}/join#${answer.code}`, button: 'Done', act: () => true });
    const invite = async () => {
        const answer = await ask({ title: 'Invite somebody', button: 'Make an invitation', fields: [{ name: 'roles', label: 'Roles', kind: 'checks', choices: roles }], act: values => post('/invitations', values) });
        if (answer) { await invitation('The invitation', answer); refresh(); }
    };
    const reset = async person => {
        const answer = await ask({ title: `New key for ${person.full_name}`, text: 'The old key is revoked: what it signed stays, and it signs nothing more. The person joins again under the same name.', danger: true, button: 'Revoke and invite', act: () => post(at('people', person.name, 'reset')) });
        if (answer) { await invitation('The new invitation', answer); refresh(); }
    };
    const change_roles = person => ask({ title: 'Roles of ' + person.full_name, button: 'Set', fields: [{ name: 'roles', label: 'Roles', kind: 'checks', choices: roles, value: person.roles }], act: values => post(at('people', person.name, 'roles'), values) }).then(done('The roles are set'));
    const change_policy = () => ask({
        title: 'Policy of the site', button: 'Put in force', fields: [
            { name: 'approvals', label: 'People who must approve', kind: 'number', value: policy.approvals }, { name: 'release_signatures', label: 'People who must sign a release', kind: 'number', value: policy.release_signatures },
            { name: 'simulation', label: 'Simulation before approval', kind: 'choice', value: policy.simulation, choices: [['required', 'Required'], ['optional', 'Not required']] },
            { name: 'fidelity', label: 'Least fidelity', kind: 'choice', value: policy.fidelity, choices: [['draft', 'draft'], ['standard', 'standard'], ['reference', 'reference']] },
            { name: 'index_valid_hours', label: 'Hours that a loom may go on without the server', kind: 'number', value: policy.index_valid_hours }],
        act: values => put('/policy', { ...policy, ...values }),
    }).then(done('The policy is in force'));
    return {
        title: 'People',
        body: [h('div', { class: 'head' }, h('h1', {}, 'People'), h('div', { class: 'buttons' }, h('button', { type: 'button', onclick: change_policy }, 'Policy …'), h('button', { type: 'button', class: 'main', onclick: invite }, 'Invite …'))),
            table('People', ['Name', 'Full name', 'Roles', 'Key', 'Change'], people.map(person => [person.name, person.full_name, person.active ? person.roles.join(', ') : 'disabled', person.key ? hash(person.key) : 'none',
                h('div', { class: 'buttons' }, h('button', { type: 'button', onclick: () => change_roles(person) }, 'Roles …'), h('button', { type: 'button', onclick: () => reset(person) }, 'New key …'),
                    h('button', { type: 'button', onclick: () => post(at('people', person.name, person.active ? 'disable' : 'enable')).then(done('Done'), error => say(error.message)) }, person.active ? 'Disable' : 'Enable'))]))],
    };
}
