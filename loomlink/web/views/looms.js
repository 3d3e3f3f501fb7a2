import { h, link, counted, say } from '../parts/dom.js';
import { get, post, at } from '../parts/api.js';
import { ask } from '../parts/dialog.js';
import { kinds, send_file } from '../parts/files.js';

export async function show({ me, refresh }) {
    const { looms } = await get('/looms');
    const is_admin = me.roles.includes('admin');
    const add = () => ask({
        title: 'New loom', button: 'Add it', fields: [{ name: 'name', label: 'Name' }, { name: 'file', label: 'Profile (JSON)', kind: 'file' }],
        act: values => send_file(values.file, kinds.profile, profile => post('/looms', { name: values.name, profile })),
    }).then(done => { if (done) { say('The loom is added'); refresh(); } });
    return {
        title: 'Looms',
        body: [h('div', { class: 'head' }, h('h1', {}, 'Looms'), is_admin ? h('button', { type: 'button', class: 'main', onclick: add }, 'New loom …') : null),
            looms.length === 0 ? h('p', { class: 'empty' }, is_admin ? 'There is no loom yet. Add one by its profile.' : 'No loom is open to you. An administrator says who works at which loom.')
                : h('ul', { class: 'tiles' }, looms.map(loom => h('li', {}, link(at('looms', loom.name), { class: 'tile large' },
                    h('strong', {}, loom.name), h('span', {}, loom.profile_name), h('span', {}, loom.released ? counted(loom.released, 'release') : 'Nothing released'),
                    loom.loaded ? h('span', { class: 'state released' }, 'Loaded: ' + loom.loaded) : h('span', { class: 'soft' }, 'Nothing loaded')))))],
    };
}
