import { h, link, state, when } from '../parts/dom.js';
import { get, at } from '../parts/api.js';

/** What waits for this person, by role. */
export async function show({ me }) {
    const waiting = (await get('/me/waiting')).items;
    const body = [h('h1', {}, 'Hello, ' + me.full_name)];
    body.push(h('h2', {}, 'Waiting for you'));
    body.push(waiting.length === 0 ? h('p', { class: 'empty' }, 'Nothing at the moment.') : h('ul', { class: 'tiles' }, waiting.map(item => h('li', {},
        link(item.release ? at('looms', item.loom, item.release) : at('designs', item.design, item.revision), { class: 'tile' },
            h('strong', {}, item.release ? `${item.design} for ${item.loom}` : `${item.design}, revision ${item.revision}`), state(item.state),
            h('span', {}, item.what), h('span', { class: 'soft' }, when(item.since)))))));
    return { title: 'Start', body };
}
