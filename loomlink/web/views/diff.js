import { h, link, table, counted } from '../parts/dom.js';
import { get, at } from '../parts/api.js';

export async function show({ design, search }) {
    const [from, to] = [search.get('from'), search.get('to')];
    const query = `?from=${encodeURIComponent(from)}&to=${encodeURIComponent(to)}`;
    const path = at('designs', design, 'diff');
    const diff = await get(path + query);
    const list = (title, items) => items?.length ? h('section', { class: 'card' }, h('h2', {}, title), h('ul', {}, items.map(item => h('li', {}, item.text)))) : null;
    return {
        title: `${design} ${from} and ${to}`,
        body: [h('p', { class: 'path' }, link('/designs', {}, 'Designs'), ' / ', link(at('designs', design), {}, design)),
            h('h1', {}, `Revision ${from} and ${to}`),
            diff.equal ? h('p', { class: 'good' }, 'The two are equal.') : h('ul', { class: 'summary' }, diff.summary.map(line => h('li', {}, line))),
            diff.equal ? null : h('section', { class: 'card' }, h('h2', {}, 'Card image'), h('img', { class: 'pixels', src: `/api/v1${path}.png${query}`, alt: `Where the card images of ${from} and ${to} differ` })),
            list('Design tree', diff.tree), list('Picks', diff.picks), list('Yarns', diff.yarns), list('Parameters', diff.parameters)],
    };
}
