import { h, link, state, when, facts, hash, table, counted, grouped, say, field, sentence } from '../parts/dom.js';
import { get, post, at } from '../parts/api.js';
import { ask, sign } from '../parts/dialog.js';
import { kinds, send_file } from '../parts/files.js';
import { card_view } from '../parts/card_view.js';

const views = [['card', 'Card image'], ['face', 'Face'], ['back', 'Back'], ['floats', 'Floats'], ['layers', 'Layers']];

export async function show({ design, revision, me, refresh }) {
    const path = at('designs', design, 'revisions', revision);
    const [content, { looms }] = await Promise.all([get(path), get('/looms')]);
    const place = { pick: undefined, end: undefined };
    const card = card_view({
        source: `/api/v1${path}/card`, picks: content.picks, ends: content.ends, label: 'Card image',
        on_place: (pick, end) => Object.assign(place, { pick, end }),
    });
    return {
        title: `${design} ${revision}`,
        leave: card.leave,
        body: [h('p', { class: 'path' }, link('/designs', {}, 'Designs'), ' / ', link(at('designs', design), {}, design)),
            h('div', { class: 'head' }, h('h1', {}, `${design}, revision ${revision} `, state(content.state)), actions(path, content, looms, refresh)),
            content.message ? h('p', {}, content.message) : null,
            missing(content),
            h('div', { class: 'two wide_left' }, h('div', {}, pictures(path, card), comments(path, content, place, refresh)), h('div', {}, what_it_is(design, path, content, me), decisions(content))),
            checks(path, content, looms, refresh), evidence(path, content, refresh)],
    };
}

/** What still stands between this revision and the loom. */
function missing(content) {
    if (!content.missing.length) return null;
    return h('section', { class: 'notice' }, h('h2', {}, 'Still missing'), h('ul', {}, content.missing.map(text => h('li', {}, sentence(text)))),
        content.needs_simulation ? h('p', {}, 'Simulations count that a machine known here has signed: simulate in the studio on its server, or by ', h('code', {}, 'weave simulate FILE --on SERVER --evidence FILE'), ', and file the evidence below.') : null);
}

function what_it_is(design, path, content, me) {
    const download = (to, name, text) => h('a', { class: 'button', href: `/api/v1${path}/${to}`, download: name }, text);
    return h('section', { class: 'card' }, h('h2', {}, 'What it is'), facts([
        ['Saved by', content.author_name, ', ', when(content.at)], ['Size', `${counted(content.ends, 'end')} × ${counted(content.picks, 'pick')}`],
        ['Made from', content.parents.length ? content.parents.map((parent, i) => [i ? ', ' : '', link(at('designs', design, parent), {}, `revision ${parent}`)]) : 'nothing before it'],
        ['Revision', hash(content.sha256)], ['Design', hash(content.design_sha256)], ['Scene', hash(content.scene_sha256)], ['Card', hash(content.card_sha256)]]),
    h('p', { class: 'buttons' }, download('document', `${design}-${content.number}.weave`, 'Download the design'),
        me.roles.includes('engineer') ? download('bundle', `${design}-${content.number}-evidence.json`, 'Download the evidence') : null));
}

function pictures(path, card) {
    const place = h('div', { class: 'picture' }, card.element);
    const picture = h('img', { class: 'drawing', alt: '' });
    const show_view = (view, name) => {
        if (view === 'card') return place.replaceChildren(card.element);
        picture.src = `/api/v1${path}/picture?view=${view}`;
        picture.alt = `${name} of the cloth`;
        place.replaceChildren(picture);
    };
    const tabs = views.map(([view, name], i) => h('button', {
        type: 'button', 'aria-pressed': i === 0, onclick: event => {
            tabs.forEach(tab => tab.setAttribute('aria-pressed', tab === event.currentTarget));
            show_view(view, name);
        },
    }, name));
    return h('section', { class: 'card' }, h('h2', {}, 'Pictures'), h('div', { class: 'tabs', role: 'group', 'aria-label': 'Picture' }, tabs), place);
}

function checks(path, content, looms, refresh) {
    const place = h('div', {});
    const choice = h('select', { 'aria-label': 'Loom' }, looms.map(loom => h('option', { value: loom.name }, loom.name)));
    const check = async () => {
        place.replaceChildren(h('p', { class: 'waiting' }, 'Checking …'));
        try {
            const loom = choice.value;
            place.replaceChildren(...report_of(path, content, loom, await get(`${path}/check?loom=${encodeURIComponent(loom)}`), refresh));
        } catch (error) {
            place.replaceChildren(h('p', { class: 'trouble', role: 'alert' }, error.message));
        }
    };
    return h('section', { class: 'card' }, h('h2', {}, 'Validation'), looms.length === 0 ? h('p', { class: 'empty' }, 'There is no loom yet.')
        : h('div', { class: 'row' }, choice, h('button', { type: 'button', onclick: check }, 'Check for this loom')), place,
    content.waivers.length ? [h('h3', {}, 'Waived'), table('Waived findings', ['Rule', 'Loom', 'By', 'Reason'], content.waivers.map(waiver => [waiver.rule, waiver.loom, waiver.by, waiver.reason]))] : null);
}

/** Findings, each with the way to let it pass where that may be done, and the rules that nobody could judge. */
function report_of(path, content, loom, report, refresh) {
    const may_waive = content.may.includes('waive') && report.errors > 0;
    const waive = rule => sign({
        title: `Waive ${rule} for ${loom}`, text: 'All findings of this rule for this loom pass. Your reason stands in the log.', button: 'Sign and waive',
        act: values => post(`${path}/waive`, { rule, loom, ...values }),
    }).then(answer => { if (answer) { say('Waived'); refresh(); } });
    const row = finding => [h('span', { class: 'severity ' + finding.severity }, finding.severity), finding.rule, finding.pick ? grouped(finding.pick) : '', finding.end ? grouped(finding.end) : '', sentence(finding.message),
        ...(may_waive ? [finding.severity === 'error' ? h('button', { type: 'button', 'aria-label': `Waive ${finding.rule}`, onclick: () => waive(finding.rule) }, 'Waive …') : ''] : [])];
    return [h('p', { role: 'status', class: report.errors ? 'trouble' : 'good' }, `${counted(report.errors, 'error')}, ${counted(report.warnings, 'warning')}, ${counted(report.not_evaluated.length, 'rule')} not evaluated.`),
        report.findings.length === 0 ? h('p', {}, 'Nothing was found.') : table('Findings', ['Severity', 'Rule', 'Pick', 'End', 'What', ...(may_waive ? ['Let it pass'] : [])], report.findings.map(row)),
        report.not_evaluated.length === 0 ? '' : h('details', {}, h('summary', {}, 'Rules that could not be judged, and why'),
            table('Rules not evaluated', ['Rule', 'Why'], report.not_evaluated.map(rule => [rule.rule, sentence(rule.reason)])))];
}

function evidence(path, content, refresh) {
    const file = () => ask({
        title: 'File evidence', text: 'What a machine found and signed, for this very design and scene.', button: 'File it',
        fields: [{ name: 'file', label: 'Evidence file', kind: 'file', hint: 'As weave simulate --evidence or the studio wrote it' }],
        act: values => send_file(values.file, kinds.evidence, text => post(`${path}/evidence`, signed_evidence(text))),
    }).then(answer => { if (answer) { say('Filed'); refresh(); } });
    return h('section', { class: 'card' }, h('h2', {}, 'Evidence'), content.evidence.length === 0 ? h('p', { class: 'empty' }, 'No evidence yet.')
        : table('Evidence', ['Kind', 'Of', 'Result', 'Signed by', 'When', 'Counts'], content.evidence.map(item => [item.kind, item.covers, item.result, item.signer, when(item.at),
            item.stale ? h('span', { class: 'bad' }, 'stale: ' + item.stale) : h('span', { class: 'good' }, 'counts')])),
    h('p', { class: 'buttons' }, h('button', { type: 'button', onclick: file }, 'File evidence …')));
}

/** What of an evidence file the server takes; it judges the signature. */
function signed_evidence(text) {
    const { format, statement, signature, report } = (() => { try { return JSON.parse(text) ?? {}; } catch { return {}; } })();
    if (format !== 'weave-signed-evidence') throw new Error('is no evidence that a machine signed: weave simulate --evidence writes it, or the studio');
    return { statement, signature, report };
}

/** Who submitted it and what was decided, each with its reason. */
function decisions(content) {
    const steps = [...(content.submission ? [{ what: 'submitted', ...content.submission }] : []), ...content.decisions];
    return h('section', { class: 'card' }, h('h2', {}, 'Decisions'), steps.length === 0 ? h('p', { class: 'soft' }, 'None yet.')
        : h('ul', { class: 'plain' }, steps.map(step => h('li', {}, h('strong', {}, sentence(step.what)), ` by ${step.by}, `, when(step.at), h('p', {}, step.reason)))));
}

/** Comments; a new one can be about the place that is marked in the card. */
function comments(path, content, place, refresh) {
    const text = h('textarea', { rows: 2, required: true, maxlength: 4000 });
    const here = h('input', { type: 'checkbox' });
    const add = async event => {
        event.preventDefault();
        if (here.checked && !place.pick) return say('Mark the place in the card image first');
        try {
            await post(`${path}/comment`, { text: text.value, ...(here.checked ? place : {}) });
            refresh();
        } catch (error) { say(error.message); }
    };
    const where = comment => (comment.pick ? h('span', { class: 'soft' }, ` at pick ${grouped(comment.pick)}${comment.end ? ', end ' + grouped(comment.end) : ''}`) : null);
    return h('section', { class: 'card' }, h('h2', {}, 'Comments'), content.comments.length === 0 ? h('p', { class: 'soft' }, 'None yet.')
        : h('ul', { class: 'plain' }, content.comments.map(comment => h('li', {}, h('strong', {}, comment.by), ', ', when(comment.at), where(comment), h('p', {}, comment.text)))),
    content.may.includes('comment') ? h('form', { onsubmit: add }, field('Comment', text),
        h('label', { class: 'check' }, here, 'About the place marked in the card image'), h('button', {}, 'Send the comment')) : null);
}

function actions(path, content, looms, refresh) {
    const done = text => answer => { if (answer) { say(text); refresh(); } };
    const button = (name, text, act, kind) => (content.may.includes(name) ? h('button', { type: 'button', class: kind, onclick: act }, text) : null);
    const loom_choices = looms.map(loom => [loom.name, loom.name]);
    return h('div', { class: 'buttons' },
        button('submit', 'Submit …', () => sign({
            title: 'Submit for approval', text: 'The revision cannot change; approvers are told.', button: 'Sign and submit',
            fields: looms.length ? [{ name: 'looms', label: 'Meant for, and checked for', kind: 'checks', choices: loom_choices }] : [], act: values => post(`${path}/submit`, values),
        }).then(done('Submitted')), 'main'),
        button('request-changes', 'Ask for changes …', () => sign({ title: 'Ask for changes', button: 'Sign and send', reason: 'What should change', act: values => post(`${path}/request-changes`, values) }).then(done('Changes requested'))),
        button('approve', 'Approve …', () => sign({ title: `Approve revision ${content.number}`, text: `You approve exactly this revision, ${content.sha256.slice(0, 12)}.`, button: 'Sign and approve', act: values => post(`${path}/approve`, values) }).then(done('Approved')), 'main'),
        button('release', 'Release to a loom …', () => release(content, loom_choices).then(done('Released')), 'main'));
}

/** Which loom, and which of its feeders carries which of the design's yarns. */
async function release(content, loom_choices) {
    const loom = await ask({ title: 'Release to a loom', button: 'Next', fields: [{ name: 'loom', label: 'Loom', kind: 'choice', choices: loom_choices }], act: values => values.loom });
    if (!loom) return undefined;
    const before = (await get(at('looms', loom))).releases.find(other => other.design === content.design && other.state === 'released');
    return sign({
        title: `Release to ${loom}`, button: 'Sign and release', text: before ? `It takes the place of release ${before.number}.` : 'The files for the controller are made, read back and compared before they count.',
        fields: content.feeders.map((feeder, i) => ({ name: 'feeder' + i, kind: 'number', value: i + 1, label: `Loom feeder for ${feeder.name} (${feeder.yarn})` })),
        act: ({ reason, password, ...feeders }) => post('/releases', {
            design: content.design, revision: content.number, loom, feeders: content.feeders.map((_, i) => feeders['feeder' + i]),
            supersedes: before?.number ?? null, reason, password,
        }),
    });
}
