import { h, link, counted, say } from '../parts/dom.js';
import { get, post, at } from '../parts/api.js';
import { ask } from '../parts/dialog.js';

export async function show({ me, refresh }) {
    const { looms } = await get('/looms');
    const add = () => ask({
        title: 'New loom', button: 'Add it', fields: [{ name: 'name', label: 'Name' }, { name: 'file', label: 'Profile (JSON)', kind: 'file' }],
        act: async values => post('/looms', { name: values.name, profile: await values.file.text() }),
    }).then(done => { if (done) { say('The loom is added'); refresh(); } });
    return {
        title: 'Looms',
        body: [h('div', { class: 'head' }, h('h1', {}, 'Looms'), me.roles.includes('admin') ? h('button', { type: 'button', class: 'main', onclick: add }, 'New loom …') : null),
            looms.length === 0 ? h('p', { class: 'empty' }, 'No loom is open to you.') : h('ul', { class: 'tiles' }, looms.map(loom => h('li', {}, link(at('looms', loom.name), { class: 'tile large' },
                h('strong', {}, loom.name), h('span', {}, loom.profile_name), h('span', {}, counted(loom.released, 'release')),
                loom.loaded ? h('span', { class: 'state released' }, 'Loaded: ' + loom.loaded) : h('span', { class: 'soft' }, 'Nothing loaded')))))],
    };
}
