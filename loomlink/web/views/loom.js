import { h, link, state, when, facts, hash, table, counted, grouped, say } from '../parts/dom.js';
import { get, put, at } from '../parts/api.js';
import { ask } from '../parts/dialog.js';
import { kinds, send_file } from '../parts/files.js';
import { watch_loom } from '../parts/watch.js';

export async function show({ loom, me, refresh }) {
    const content = await get(at('looms', loom));
    const current = content.releases.filter(release => release.state === 'released');
    const may_look = me.roles.some(role => role !== 'admin'); // administrators set looms up; releases are not open to them
    const past = content.releases.filter(release => release.state !== 'released');
    return {
        title: loom,
        leave: may_look ? watch_loom(loom, () => { say('The releases of this loom have changed'); refresh(); }) : null,
        body: [h('p', { class: 'path' }, link('/looms', {}, 'Looms')), h('div', { class: 'head' }, h('h1', {}, loom), me.roles.includes('admin') ? admin(loom, content, refresh) : null),
            h('h2', {}, 'Released for this loom'),
            current.length === 0 ? h('p', { class: 'empty' }, 'Nothing is released for this loom. As soon as something is, it stands here by itself.')
                : h('ul', { class: 'tiles' }, current.map(release => h('li', {}, tile(loom, release, content.loaded, may_look)))),
            content.faults.length === 0 ? null : [h('h2', {}, 'Faults reported'), h('section', { class: 'card' }, h('ul', { class: 'plain' }, content.faults.map(fault => h('li', {},
                named(at('looms', loom, fault.release), may_look, `Release ${fault.release}${fault.pick ? ', pick ' + grouped(fault.pick) : ''}`), `: ${fault.text}`, h('p', { class: 'soft' }, `${fault.by}, `, when(fault.at))))))],
            past.length === 0 ? null : h('details', {}, h('summary', {}, 'No longer to be woven, or not yet'), table('Past releases', ['Release', 'Design', 'State', 'Since', 'Why'],
                past.map(release => [named(at('looms', loom, release.number), may_look, `Release\u00a0${release.number}`), `${release.design}, revision ${release.revision}`, state(release.state), when(release.since), release.reason]))),
            h('details', {}, h('summary', {}, 'Profile of the loom'), h('section', { class: 'card' }, facts([['Profile', content.profile_name], ['Version here', content.profile_version], ['Hash', hash(content.profile_sha256)],
                ['Hooks', grouped(content.hooks)], ['Feeders', content.feeders], ['File', content.output.toUpperCase()], ['Operators', content.operators.join(', ') || 'none']])))],
    };
}

const named = (to, may_look, text) => (may_look ? link(to, {}, text) : text);

const tile = (loom, release, loaded, may_look) => h(may_look ? 'a' : 'div', { class: 'tile large', href: may_look ? at('looms', loom, release.number) : null },
    h('strong', {}, release.design), h('span', {}, `Release ${release.number}, revision ${release.revision}`), h('span', {}, `${counted(release.ends, 'end')} × ${counted(release.picks, 'pick')}`),
    h('span', { class: 'soft' }, 'Released ', when(release.at), ' by ', release.by),
    release.number === loaded ? h('span', { class: 'state released' }, 'Loaded') : null, release.place ? h('span', {}, `Last woven pick ${grouped(release.place)}`) : null);

function admin(loom, content, refresh) {
    const done = text => answer => { if (answer) { say(text); refresh(); } };
    return h('div', { class: 'buttons' },
        h('button', { type: 'button', onclick: () => ask({ title: 'New version of the profile', text: 'Releases made for the version until now can no longer be pulled: release them again.', button: 'Put it in force', fields: [{ name: 'file', label: 'Profile (JSON)', kind: 'file' }], act: values => send_file(values.file, kinds.profile, profile => put(at('looms', loom, 'profile'), { profile })) }).then(done('The profile is in force')) }, 'New profile …'),
        h('button', { type: 'button', onclick: () => ask({ title: 'Operators', button: 'Set', fields: [{ name: 'operators', label: 'Names to sign in with, with commas between', required: false, value: content.operators.join(', ') }], act: values => put(at('looms', loom, 'operators'), { operators: values.operators.split(',').map(name => name.trim()).filter(Boolean) }) }).then(done('The operators are set')) }, 'Operators …'));
}
