import { h, when, hash, table, say, facts } from '../parts/dom.js';
import { get } from '../parts/api.js';
import { leaf_hash, inclusion_holds, consistency_holds } from '../parts/merkle.js';

const kept = 'log-head';
const page = 100;

export async function show({ search, go }) {
    const head = await get('/audit/head');
    const last = Math.max(0, head.size - 1);
    const from = Math.max(0, Number(search.get('from') ?? Math.max(0, head.size - page)) || 0);
    const design = search.get('design') ?? '';
    const { events } = await get(`/events?from=${from}&limit=${page}${design ? '&design=' + encodeURIComponent(design) : ''}`);
    const verdict = h('p', { role: 'status', class: 'verdict' });
    const check = async () => {
        verdict.textContent = 'Checking …';
        const troubles = await verify(head, events);
        verdict.className = 'verdict ' + (troubles.length ? 'trouble' : 'good');
        verdict.textContent = troubles.length ? troubles.join('. ')
            : `The log holds: ${events.length} records shown here are in it, and it only grew since this browser last looked.`;
    };
    const filter = h('input', { value: design, 'aria-label': 'Only this design', placeholder: 'Only this design' });
    const to = first => `/log?from=${Math.max(0, first)}${design ? '&design=' + encodeURIComponent(design) : ''}`;
    return {
        title: 'Log',
        body: [h('div', { class: 'head' }, h('h1', {}, 'Log'), h('div', { class: 'buttons' },
            h('button', { type: 'button', class: 'main', onclick: check }, 'Verify what is shown'),
            h('a', { class: 'button', href: '/api/v1/audit/bundle', download: 'audit-bundle.json' }, 'Download the bundle'))),
            h('section', { class: 'card' }, facts([['Records', head.size.toLocaleString('en')], ['Root', hash(head.root)], ['Signed', when(head.at)]]), verdict,
                h('p', { class: 'hint' }, 'Offline: ', h('code', {}, 'loomlink audit verify audit-bundle.json --key KEY'))),
            h('form', { class: 'row', onsubmit: event => { event.preventDefault(); go(`/log?from=0&design=${encodeURIComponent(filter.value)}`); } }, filter, h('button', {}, 'Show')),
            table('Records', ['No.', 'When', 'Who', 'What', 'About', 'Why', 'Signed'], events.toReversed().map(event => [event.seq, when(event.at, true), event.actor, event.kind, event.subject ?? '', event.reason ?? '', event.signed ? '✓ ' + event.signed : ''])),
            h('nav', { class: 'buttons', 'aria-label': 'Pages' }, from > 0 ? h('a', { class: 'button', href: to(from - page) }, 'Older') : null,
                events.length === page && from + page <= last ? h('a', { class: 'button', href: to(from + page) }, 'Newer') : null)],
    };
}

/** Every record shown is in the tree of this head, and the head that this browser kept is its beginning. */
async function verify(head, events) {
    const troubles = [];
    for (const event of events) {
        const proof = await get(`/audit/inclusion?seq=${event.seq}&size=${head.size}`);
        const leaf = await leaf_hash(event.record);
        if (!await inclusion_holds(leaf, event.seq, head.size, proof.path, head.root)) troubles.push(`Record ${event.seq} is not what the log holds`);
    }
    const before = JSON.parse(localStorage.getItem(kept) ?? 'null');
    if (before && before.site === head.site) {
        if (before.size > head.size) troubles.push(`The log had ${before.size} records before and has ${head.size} now: records were removed`);
        else if (before.size > 0) {
            const proof = await get(`/audit/consistency?from=${before.size}&size=${head.size}`);
            if (!await consistency_holds(before.size, head.size, before.root, head.root, proof.path)) troubles.push('The log is not the one that this browser saw before: its history was rewritten');
        }
    }
    if (troubles.length === 0) localStorage.setItem(kept, JSON.stringify(head));
    return troubles;
}
