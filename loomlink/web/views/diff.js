import { h, link, table, grouped } from '../parts/dom.js';
import { get, at } from '../parts/api.js';

/** In what two revisions differ, in a weaver's words. */
export async function show({ design, search }) {
    const [from, to] = [search.get('from'), search.get('to')];
    if (![from, to].every(number => /^[1-9]\d{0,8}$/.test(number ?? ''))) throw new Error('This address does not name two revisions: choose them in the history of the design');
    const query = `?from=${encodeURIComponent(from)}&to=${encodeURIComponent(to)}`;
    const path = at('designs', design, 'diff');
    const diff = await get(path + query);
    const revision = number => link(at('designs', design, number), {}, `revision ${number}`);
    return {
        title: `${design} ${from} and ${to}`,
        body: [h('p', { class: 'path' }, link('/designs', {}, 'Designs'), ' / ', link(at('designs', design), {}, design)),
            h('h1', {}, `${design}: what changed from ${from} to ${to}`), h('p', { class: 'soft' }, 'From ', revision(from), ' to ', revision(to), '.'),
            diff.equal ? h('p', { class: 'good' }, 'The two are equal.')
                : [h('ul', { class: 'summary' }, diff.summary.map(line => h('li', {}, line))), h('div', { class: 'two' }, card(diff, path, query, from, to),
                    h('div', {}, list('Design tree', diff.tree), crossings(diff.pixels), list('Picks', diff.picks), list('Ends', diff.ends), list('Yarns', diff.yarns), list('Parameters', diff.parameters)))]],
    };
}

const list = (title, items) => (items?.length ? h('section', { class: 'card' }, h('h2', {}, title), h('ul', {}, items.map(item => h('li', {}, item.text)))) : null);

function card(diff, path, query, from, to) {
    if (!diff.pixels.compared) return h('section', { class: 'card' }, h('h2', {}, 'Card image'), h('p', { class: 'empty' }, 'The cards are not compared: ' + diff.pixels.why_not));
    const picture = `/api/v1${path}.png${query}`;
    const drawing = h('p', { class: 'hint', role: 'status' }, 'The picture is being drawn …');
    return h('section', { class: 'card' }, h('h2', {}, 'Card image'), drawing,
        h('img', { class: 'drawing', src: picture, alt: `The card images of revisions ${from} and ${to}, laid on each other`, onload: () => drawing.remove(), onerror: () => { drawing.textContent = 'The picture could not be drawn.'; } }),
        h('p', {}, h('a', { class: 'button', href: picture, download: `compared-${from}-${to}.png` }, 'Download the picture')));
}

/** The crossings themselves, since one of a million is not seen in a picture. */
function crossings(pixels) {
    if (!pixels.runs?.length) return null;
    const ends = run => (run.first_end === run.last_end ? grouped(run.first_end) : `${grouped(run.first_end)} to ${grouped(run.last_end)}`);
    return h('section', { class: 'card' }, h('h2', {}, 'Crossings'), table('Crossings that differ', ['Pick', 'Ends', 'Now'],
        pixels.runs.slice(0, 50).map(run => [grouped(run.pick), ends(run), run.became === 'lifted' ? 'lifted' : 'no longer lifted'])),
    pixels.run_count > 50 ? h('p', { class: 'hint' }, `The first 50 of ${grouped(pixels.run_count)}.`) : null);
}
