import { h, link, state, when, sentence } from '../parts/dom.js';
import { get, at } from '../parts/api.js';

/** What waits for this person, by role. */
export async function show({ me }) {
    const [{ items }, keys] = await Promise.all([get('/me/waiting'), keys_to_publish(me)]);
    const tiles = [keys, ...items.map(tile)].filter(Boolean);
    return {
        title: 'Start',
        body: [h('h1', {}, 'Hello, ' + me.full_name), h('h2', {}, 'Waiting for you'),
            tiles.length === 0 ? h('p', { class: 'empty' }, 'Nothing at the moment.') : h('ul', { class: 'tiles' }, tiles.map(one => h('li', {}, one)))],
    };
}

const tile = item => link(item.release ? at('looms', item.loom, item.release) : at('designs', item.design, item.revision), { class: 'tile' },
    h('strong', {}, item.release ? `${item.design} for ${item.loom}` : `${item.design}, revision ${item.revision}`), state(item.state),
    h('span', {}, sentence(item.what)), h('span', { class: 'soft' }, 'since ', when(item.since)));

/** Releases are signed by keys that looms trust; whose those are, an administrator signs. */
async function keys_to_publish(me) {
    if (!me.roles.includes('admin')) return null;
    const { changes } = await get('/trust/pending');
    if (changes.length === 0) return null;
    return link('/people', { class: 'tile' }, h('strong', {}, 'Keys that looms trust'), state('awaiting'),
        h('span', {}, 'People or their keys have changed: sign the list of keys anew'));
}
