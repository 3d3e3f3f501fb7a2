import { h, link, state, when, facts, hash, table, counted, say } from '../parts/dom.js';
import { get, post, at } from '../parts/api.js';
import { ask, sign } from '../parts/dialog.js';
import { card_view } from '../parts/card_view.js';

const views = [['card', 'Card image'], ['face', 'Face'], ['back', 'Back'], ['floats', 'Floats'], ['layers', 'Layers']];

export async function show({ design, revision, me, refresh }) {
    const path = at('designs', design, 'revisions', revision);
    const [content, { looms }] = await Promise.all([get(path), get('/looms')]);
    const card = card_view({ source: `/api/v1${path}/card`, picks: content.picks, ends: content.ends, label: 'Card image' });
    return {
        title: `${design} ${revision}`,
        leave: card.leave,
        body: [h('p', { class: 'path' }, link('/designs', {}, 'Designs'), ' / ', link(at('designs', design), {}, design)),
            h('div', { class: 'head' }, h('h1', {}, `Revision ${revision} `, state(content.state)), actions(path, content, looms, me, refresh)),
            h('p', {}, content.message),
            missing(content),
            h('div', { class: 'two' },
                h('section', { class: 'card' }, h('h2', {}, 'What it is'), facts([
                    ['Saved by', content.author_name, ', ', when(content.at)], ['Size', `${counted(content.ends, 'end')} × ${counted(content.picks, 'pick')}`],
                    ['Made from', content.parents.length ? content.parents.map(parent => link(at('designs', design, parent), {}, `revision ${parent} `)) : 'nothing before it'],
                    ['Revision', hash(content.sha256)], ['Design', hash(content.design_sha256)], ['Scene', hash(content.scene_sha256)], ['Card', hash(content.card_sha256)]]),
                h('p', {}, h('a', { href: `/api/v1${path}/document`, download: `${design}-${revision}.weave` }, 'Download the design'))),
                pictures(path, card)),
            checks(path, content, looms),
            evidence(content), decisions(content), comments(path, content, refresh)],
    };
}

/** What still stands between this revision and the loom. */
function missing(content) {
    if (!content.missing.length) return null;
    return h('section', { class: 'notice' }, h('h2', {}, 'Still missing'), h('ul', {}, content.missing.map(text => h('li', {}, text))));
}

function pictures(path, card) {
    const place = h('div', { class: 'picture' }, card.element);
    const picture = h('img', { class: 'pixels', alt: '' });
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

function checks(path, content, looms) {
    const place = h('div', {});
    const choice = h('select', { 'aria-label': 'Loom' }, looms.map(loom => h('option', { value: loom.name }, loom.name)));
    const check = async () => {
        place.replaceChildren(h('p', { class: 'waiting' }, 'Checking …'));
        try {
            const report = await get(`${path}/check?loom=${encodeURIComponent(choice.value)}`);
            place.replaceChildren(h('p', {}, `${counted(report.errors, 'error')}, ${counted(report.warnings, 'warning')}, ${counted(report.not_evaluated.length, 'rule')} not evaluated.`),
                report.findings.length === 0 ? h('p', { class: 'good' }, 'Nothing was found.') : table('Findings', ['Severity', 'Rule', 'Pick', 'End', 'What'], report.findings.map(finding =>
                    [h('span', { class: 'severity ' + finding.severity }, finding.severity), finding.rule, finding.pick ?? '', finding.end ?? '', finding.message])));
        } catch (error) {
            place.replaceChildren(h('p', { class: 'trouble', role: 'alert' }, error.message));
        }
    };
    return h('section', { class: 'card' }, h('h2', {}, 'Validation'), looms.length === 0 ? h('p', { class: 'empty' }, 'There is no loom yet.')
        : h('div', { class: 'row' }, choice, h('button', { type: 'button', onclick: check }, 'Check for this loom')), place,
        content.waivers.length ? table('Waived findings', ['Rule', 'Loom', 'By', 'Reason'], content.waivers.map(waiver => [waiver.rule, waiver.loom, waiver.by, waiver.reason])) : null);
}

function evidence(content) {
    return h('section', { class: 'card' }, h('h2', {}, 'Evidence'), content.evidence.length === 0 ? h('p', { class: 'empty' }, 'No evidence yet.')
        : table('Evidence', ['Kind', 'Of', 'Result', 'Signed by', 'When', 'Counts'], content.evidence.map(item => [item.kind, item.covers, item.result, item.signer, when(item.at),
            item.stale ? h('span', { class: 'state withdrawn', title: item.stale }, 'stale: ' + item.stale) : h('span', { class: 'good' }, 'counts')])));
}

function decisions(content) {
    return h('section', { class: 'card' }, h('h2', {}, 'Decisions'), content.decisions.length === 0 ? h('p', { class: 'empty' }, 'None yet.')
        : h('ul', { class: 'plain' }, content.decisions.map(decision => h('li', {}, h('strong', {}, decision.what), ` by ${decision.by}, `, when(decision.at), h('p', {}, decision.reason)))));
}

function comments(path, content, refresh) {
    const text = h('textarea', { rows: 2, required: true, maxlength: 4000, 'aria-label': 'Comment' });
    return h('section', { class: 'card' }, h('h2', {}, 'Comments'), h('ul', { class: 'plain' }, content.comments.map(comment => h('li', {},
        h('strong', {}, comment.by), ' ', when(comment.at), comment.pick ? h('span', { class: 'soft' }, ` pick ${comment.pick}${comment.end ? ', end ' + comment.end : ''}`) : null, h('p', {}, comment.text)))),
        h('form', { onsubmit: async event => { event.preventDefault(); try { await post(`${path}/comment`, { text: text.value }); refresh(); } catch (error) { say(error.message); } } }, text, h('button', {}, 'Comment')));
}

function actions(path, content, looms, me, refresh) {
    const done = text => answer => { if (answer) { say(text); refresh(); } };
    const may = content.may ?? [];
    const button = (name, text, act, kind) => may.includes(name) ? h('button', { type: 'button', class: kind, onclick: act }, text) : null;
    const loom_choices = looms.map(loom => [loom.name, loom.name]);
    return h('div', { class: 'buttons' },
        button('submit', 'Submit …', () => sign({ title: 'Submit for approval', text: 'The revision cannot change; approvers are told.', button: 'Sign and submit', act: values => post(`${path}/submit`, values) }).then(done('Submitted')), 'main'),
        button('request-changes', 'Ask for changes …', () => sign({ title: 'Ask for changes', button: 'Sign and send', reason: 'What should change', act: values => post(`${path}/request-changes`, values) }).then(done('Changes requested'))),
        button('waive', 'Waive a finding …', () => sign({ title: 'Waive a finding', button: 'Sign and waive', fields: [{ name: 'rule', label: 'Rule', hint: 'As the check names it, such as float.face' }, { name: 'loom', label: 'Loom', kind: 'choice', choices: loom_choices }], act: values => post(`${path}/waive`, values) }).then(done('Waived'))),
        button('approve', 'Approve …', () => sign({ title: `Approve revision ${content.number}`, text: `You approve exactly this revision, ${content.sha256.slice(0, 12)}.`, button: 'Sign and approve', act: values => post(`${path}/approve`, values) }).then(done('Approved')), 'main'),
        button('release', 'Release to a loom …', () => release(content, loom_choices).then(done('Released')), 'main'));
}

/** Which loom, and which of its feeders carries which of the design's yarns. */
async function release(content, loom_choices) {
    const loom = await ask({ title: 'Release to a loom', button: 'Next', fields: [{ name: 'loom', label: 'Loom', kind: 'choice', choices: loom_choices }], act: values => values.loom });
    if (!loom) return undefined;
    const before = (await get(at('looms', loom))).releases.find(other => other.design === content.design && other.state === 'released');
    return sign({
        title: `Release to ${loom}`, button: 'Sign and release', text: before ? `It takes the place of release ${before.number}.` : undefined,
        fields: content.feeders.map((feeder, i) => ({ name: 'feeder' + i, kind: 'number', value: i + 1, label: `Loom feeder for ${feeder.name} (${feeder.yarn})` })),
        act: ({ reason, password, ...feeders }) => post('/releases', {
            design: content.design, revision: content.number, loom, feeders: content.feeders.map((_, i) => feeders['feeder' + i]),
            supersedes: before?.number ?? null, reason, password,
        }),
    });
}
