import { h, link, state, when, facts, hash, size, counted, grouped, say, field, sentence } from '../parts/dom.js';
import { get, post, put, at } from '../parts/api.js';
import { ask, sign } from '../parts/dialog.js';
import { card_view } from '../parts/card_view.js';
import { pick_list, pick_cells, pick_words } from '../parts/pick_list.js';
import { watch_loom } from '../parts/watch.js';

/** What an operator needs at the loom: the files, the card, the picks, and where weaving stopped. */
export async function show({ loom, release, me, refresh }) {
    const source = at('looms', loom, 'releases', release);
    const [content, hall] = await Promise.all([get(source), get(at('looms', loom))]);
    const is_loaded = content.state === 'released' && hall.loaded === content.number;
    const stop = watch_loom(loom, () => get(source).then(now => { if (now.state !== content.state || now.manifest_sha256 !== content.manifest_sha256) refresh(); }, refresh));
    const desk = content.state === 'released' ? weaving(loom, source, content) : null;
    const files = desk ? pulling(loom, source, content) : null;
    return {
        title: `${content.design} for ${loom}`,
        leave: () => { stop(); desk?.leave(); },
        body: [h('p', { class: 'path' }, link('/looms', {}, 'Looms'), ' / ', link(at('looms', loom), {}, loom)),
            h('div', { class: 'head' }, h('h1', {}, `${content.design}, release ${release} `, state(content.state), is_loaded ? h('span', { class: 'state released' }, 'Loaded') : null),
                buttons(loom, content, is_loaded, desk, refresh)),
            desk ? null : why_not(content, hall.releases.find(one => one.number === content.number)),
            is_loaded ? [desk.body, files] : [files, desk?.body],
            faults(hall.faults.filter(fault => fault.release === content.number)), about(content, me)],
    };
}

/** Go to a pick, see it in the card and in the list, remember it. */
function weaving(loom, source, content) {
    const may_keep = (content.may ?? []).includes('loaded');
    const number = h('input', { inputmode: 'numeric', autocomplete: 'off', value: grouped(content.place ?? 1), onfocus: () => number.select() });
    const trouble = h('p', { class: 'trouble', role: 'alert' });
    const now = h('div', { class: 'now' });
    const heard = h('p', { class: 'unseen', 'aria-live': 'polite' });
    const on_known = entry => {
        now.replaceChildren(h('strong', { class: 'number' }, 'Pick ' + grouped(entry.pick)), ...pick_cells(entry));
        heard.textContent = pick_words(entry);
    };
    let current = content.place ?? 1;
    const remember_pick = pick => {
        current = pick;
        number.value = grouped(pick);
        trouble.textContent = '';
    };
    const list = pick_list({ source: `${source}/picks`, picks: content.picks, on_choose: pick => card.show_pick(pick), on_known });
    const card = card_view({
        source: `/api/v1${source}/card`, picks: content.picks, ends: content.ends, label: 'Card image of the release',
        on_place: pick => { if (pick !== current) list.show_pick(pick); remember_pick(pick); },
    });
    const show_pick = pick => {
        remember_pick(pick);
        list.show_pick(pick);
        card.show_pick(pick);
    };
    const go = event => {
        event.preventDefault();
        const typed = number.value.trim(); // digits, in groups of three or in none: 1.5 is no pick 15
        const wanted = /^(\d+|\d{1,3}([\s.,'’]\d{3})+)$/.test(typed) ? Number(typed.replace(/\D/g, '')) : NaN;
        if (Number.isInteger(wanted) && wanted >= 1 && wanted <= content.picks) show_pick(wanted);
        else trouble.textContent = `This release has the picks 1 to ${grouped(content.picks)}`;
    };
    const keep = async () => {
        try {
            await put(at('looms', loom, 'place'), { release: content.number, pick: current });
            say(`Pick ${grouped(current)} is remembered as the last woven one`);
        } catch (error) { say(error.message); }
    };
    const step = by => show_pick(Math.min(Math.max(current + by, 1), content.picks));
    const body = [h('div', { class: 'go_to' },
        h('form', { onsubmit: go }, field('Go to pick', number), h('button', { class: 'main' }, 'Go')),
        h('button', { type: 'button', 'aria-label': 'One pick back', onclick: () => step(-1) }, '−'), h('button', { type: 'button', 'aria-label': 'One pick on', onclick: () => step(1) }, '+'),
        now, may_keep ? h('button', { type: 'button', onclick: keep }, 'Remember as last woven') : null, trouble, heard),
    h('div', { class: 'two wide_left' }, h('section', { class: 'card' }, h('h2', {}, 'Card image'), card.element), h('section', { class: 'card' }, h('h2', {}, 'Picks'), list.element))];
    setTimeout(() => (content.place ? show_pick(content.place) : list.show_pick(1)));
    return { body, leave: () => { card.leave(); list.leave(); }, pick: () => current };
}

/** The files, to be taken one by one into a folder. */
function pulling(loom, source, content) {
    const pull = (name, path) => h('a', { class: 'button', href: `/api/v1${source}${path}`, download: name, onclick: () => say(`${name} is on its way to the downloads`) }, 'Pull ' + name);
    return h('section', { class: 'card' }, h('h2', {}, 'Files for the controller'),
        content.label ? h('p', { class: 'soft' }, sentence(content.label)) : null,
        h('ul', { class: 'files' }, content.files.map(file => h('li', {}, pull(file.name, `/files/${encodeURIComponent(file.name)}`), h('span', {}, size(file.size)), hash(file.sha256, 8))),
            h('li', {}, pull('manifest.json', '/manifest'), h('span', {}, 'signed'), hash(content.manifest_sha256, 8))),
        h('p', { class: 'hint' }, 'Pull all of them into one folder, then check it before loading: ', h('code', {}, `loomlink verify-files FOLDER --loom '${loom}'`),
            '. The program does both at once: ', h('code', {}, `loomlink pull '${loom}' --release ${content.number} --to FOLDER`)));
}

function why_not(content, listed) {
    const who = listed ? [h('span', { class: 'soft' }, `${listed.by}, `, when(content.since))] : [];
    if (content.state === 'awaiting') {
        return h('section', { class: 'notice' }, h('h2', {}, 'Not yet'),
            h('p', {}, `It cannot be pulled before ${counted(content.signatures_missing, 'more person', 'more people')} signed it.`));
    }
    return h('section', { class: 'notice bad', role: 'alert' }, h('h2', {}, content.state === 'withdrawn' ? 'Recalled: do not weave it' : 'Do not weave it any more'),
        h('p', {}, content.state === 'withdrawn' ? 'Take its files off the loom. ' : 'Another release took its place, or the loom has another profile now. ', content.reason), h('p', {}, who));
}

const faults = list => (list.length === 0 ? null : h('section', { class: 'card' }, h('h2', {}, 'Faults reported'), h('ul', { class: 'plain' }, list.map(fault => h('li', {},
    fault.pick ? h('strong', {}, `Pick ${grouped(fault.pick)}${fault.end ? ', end ' + grouped(fault.end) : ''}: `) : null, fault.text, h('p', { class: 'soft' }, `${fault.by}, `, when(fault.at)))))));

/** Operators do not see designs, so for them the revision is no link. */
const about = (content, me) => h('details', {}, h('summary', {}, 'What this release is bound to'), h('section', { class: 'card' }, facts([
    ['Revision', me.roles.some(role => ['designer', 'approver', 'engineer'].includes(role)) ? link(at('designs', content.design, content.revision), {}, `${content.design} ${content.revision}`) : `${content.design} ${content.revision}`, ' ', hash(content.revision_sha256)],
    ['Profile', `${content.profile_name}, version ${content.profile_version} `, hash(content.profile_sha256)],
    ['Manifest', hash(content.manifest_sha256)], ['Signed by', content.signatures.map(signature => signature.person).join(', ')], ['Feeders', content.feeder_words.join('; ')], ['Reason', content.reason], ['Since', when(content.since)]])));

function buttons(loom, content, is_loaded, desk, refresh) {
    const done = text => answer => { if (answer) { say(text); refresh(); } };
    const may = content.may ?? [];
    const button = (name, text, kind, act) => (may.includes(name) ? h('button', { type: 'button', class: kind, onclick: act }, text) : null);
    const path = at('looms', loom, 'releases', content.number);
    return h('div', { class: 'buttons' },
        button('loaded', 'Confirm loaded …', is_loaded ? null : 'main', () => ask({ title: 'Loaded on the loom?', text: `You confirm that ${content.design}, release ${content.number}, was verified and is loaded on ${loom}.`, button: 'Yes, it is loaded', act: () => post(at('looms', loom, 'loaded'), { release: content.number }) }).then(done('Confirmed'))),
        button('fault', 'Report a fault …', null, () => ask({ title: 'Report a fault', button: 'Send to the designer', fields: [{ name: 'text', label: 'What is wrong', kind: 'area' }, { name: 'pick', label: 'Pick', kind: 'number', required: false, value: desk?.pick() }, { name: 'end', label: 'End', kind: 'number', required: false }], act: values => post(at('looms', loom, 'faults'), { release: content.number, ...values }) }).then(done('The designer is told'))),
        button('sign', 'Sign …', 'main', () => sign({ title: 'Sign the release', button: 'Sign', act: values => post(`${path}/sign`, values) }).then(done('Signed'))),
        button('withdraw', 'Withdraw …', 'danger', () => sign({ title: 'Withdraw this release', text: 'No loom can pull it any more; terminals in watch mode remove its files.', danger: true, button: 'Sign and withdraw', act: values => post(`${path}/withdraw`, values) }).then(done('Withdrawn'))));
}
