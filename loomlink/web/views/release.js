import { h, link, state, when, facts, hash, size, counted, say, field } from '../parts/dom.js';
import { get, post, put, at } from '../parts/api.js';
import { ask, sign } from '../parts/dialog.js';
import { card_view } from '../parts/card_view.js';
import { pick_list } from '../parts/pick_list.js';

/** What an operator needs at the loom: the files, the card, the picks, and where weaving stopped. */
export async function show({ loom, release, me, refresh }) {
    const path = at('looms', loom, release);
    const content = await get(at('looms', loom, 'releases', release));
    const api = `/api/v1${at('looms', loom, 'releases', release)}`;
    const head = [h('p', { class: 'path' }, link('/looms', {}, 'Looms'), ' / ', link(at('looms', loom), {}, loom)),
        h('div', { class: 'head' }, h('h1', {}, `${content.design}, release ${release} `, state(content.state)), buttons(loom, content, me, refresh))];
    if (content.state !== 'released') {
        return { title: `Release ${release}`, body: [...head, h('p', { class: 'notice' }, content.state === 'awaiting'
            ? `It cannot be pulled before ${counted(content.signatures_missing, 'more person', 'more people')} signed it.`
            : `It must not be woven: ${content.reason}`), about(content)] };
    }
    const watch = new WebSocket(`${location.protocol === 'https:' ? 'wss' : 'ws'}://${location.host}/api/v1${at('looms', loom, 'watch')}`);
    watch.onmessage = () => refresh();
    const card = card_view({ source: `${api}/card`, picks: content.picks, ends: content.ends, label: 'Card image of the release' });
    const list = pick_list({ source: `${at('looms', loom, 'releases', release)}/picks`, picks: content.picks, on_choose: pick => show_pick(pick) });
    const number = h('input', { type: 'number', min: 1, max: content.picks, inputmode: 'numeric', value: content.place ?? 1 });
    const show_pick = pick => {
        number.value = pick;
        card.show_pick(pick);
        list.show_pick(pick);
    };
    const asked = () => Math.min(Math.max(Math.round(Number(number.value)) || 1, 1), content.picks);
    const keep = async () => {
        try {
            await put(at('looms', loom, 'place'), { release: Number(release), pick: asked() });
            say(`Pick ${asked()} is remembered as the last woven one`);
        } catch (error) { say(error.message); }
    };
    const step = by => show_pick(Math.min(Math.max(asked() + by, 1), content.picks));
    const body = [...head,
        h('p', { class: 'label' }, content.label),
        h('section', { class: 'card' }, h('h2', {}, 'Files for the controller'), h('ul', { class: 'files' }, content.files.map(file => h('li', {},
            h('a', { class: 'button', href: `${api}/files/${encodeURIComponent(file.name)}`, download: file.name }, 'Pull ' + file.name), ' ',
            h('span', {}, size(file.size)), ' ', hash(file.sha256)))),
            h('p', { class: 'hint' }, 'Pull all files and the manifest into one folder, then check it before loading: ', h('code', {}, 'loomlink verify-files FOLDER'),
                '. The program ', h('code', {}, `loomlink pull '${loom}' ${release}`), ' does both.')),
        h('div', { class: 'go_to' }, h('form', { onsubmit: event => { event.preventDefault(); show_pick(asked()); } }, field('Go to pick', number), h('button', { class: 'main' }, 'Go')),
            h('button', { type: 'button', 'aria-label': 'One pick back', onclick: () => step(-1) }, '−'), h('button', { type: 'button', 'aria-label': 'One pick on', onclick: () => step(1) }, '+'),
            h('button', { type: 'button', onclick: keep }, 'Remember as last woven')),
        h('div', { class: 'two wide_left' }, h('section', { class: 'card' }, h('h2', {}, 'Card image'), card.element), h('section', { class: 'card' }, h('h2', {}, 'Picks'), list.element)),
        about(content)];
    if (content.place) setTimeout(() => show_pick(content.place));
    return { title: `${content.design} for ${loom}`, body, leave: () => { watch.onmessage = null; watch.close(); card.leave(); } };
}

const about = content => h('details', {}, h('summary', {}, 'What this release is bound to'), facts([
    ['Revision', link(at('designs', content.design, content.revision), {}, `${content.design} ${content.revision}`), ' ', hash(content.revision_sha256)], ['Profile', `${content.profile_name}, version ${content.profile_version} `, hash(content.profile_sha256)],
    ['Manifest', hash(content.manifest_sha256)], ['Signed by', content.signatures.map(signature => signature.person).join(', ')], ['Feeders', content.feeder_words.join('; ')], ['Reason', content.reason], ['Since', when(content.since)]]));

function buttons(loom, content, me, refresh) {
    const done = text => answer => { if (answer) { say(text); refresh(); } };
    const may = content.may ?? [];
    return h('div', { class: 'buttons' },
        may.includes('loaded') ? h('button', { type: 'button', class: 'main', onclick: () => ask({ title: 'Loaded on the loom?', text: `You confirm that ${content.design}, release ${content.number}, was verified and is loaded on ${loom}.`, button: 'Yes, it is loaded', act: () => post(at('looms', loom, 'loaded'), { release: content.number }) }).then(done('Confirmed')) }, 'Confirm loaded …') : null,
        may.includes('fault') ? h('button', { type: 'button', onclick: () => ask({ title: 'Report a fault', button: 'Send to the designer', fields: [{ name: 'pick', label: 'Pick', kind: 'number', required: false }, { name: 'end', label: 'End', kind: 'number', required: false }, { name: 'text', label: 'What is wrong', kind: 'area' }], act: values => post(at('looms', loom, 'faults'), { release: content.number, ...values }) }).then(done('The designer is told')) }, 'Report a fault …') : null,
        may.includes('sign') ? h('button', { type: 'button', class: 'main', onclick: () => sign({ title: 'Sign the release', button: 'Sign', act: values => post(at('looms', loom, 'releases', content.number, 'sign'), values) }).then(done('Signed')) }, 'Sign …') : null,
        may.includes('withdraw') ? h('button', { type: 'button', class: 'danger', onclick: () => sign({ title: 'Withdraw this release', text: 'No loom can pull it any more; terminals in watch mode remove its files.', danger: true, button: 'Sign and withdraw', act: values => post(at('looms', loom, 'releases', content.number, 'withdraw'), values) }).then(done('Withdrawn')) }, 'Withdraw …') : null);
}
