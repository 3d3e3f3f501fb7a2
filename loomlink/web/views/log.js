import { h, when, hash, table, facts, grouped, field } from '../parts/dom.js';
import { get } from '../parts/api.js';
import { leaf_hash, inclusion_holds, consistency_holds } from '../parts/merkle.js';

const kept = 'log-head';
const page = 100;

const words = {
    'access.given': 'Access to simd given', 'design.added': 'Design made', 'evidence.added': 'Evidence added', 'log.exported': 'Log downloaded', 'log.viewed': 'Log looked at',
    'design.viewed': 'Design looked at', 'loom.index_pulled': 'List of releases pulled', 'loom.viewed': 'Loom looked at', 'loom.watched': 'Loom watched',
    'revision.checked': 'Checked for a loom', 'loom.added': 'Loom added', 'loom.fault_reported': 'Fault reported', 'loom.loaded': 'Loaded on the loom', 'loom.operators_set': 'Operators set',
    'loom.place_kept': 'Last pick remembered', 'loom.profile_set': 'Profile put in force', 'person.disabled': 'Disabled', 'person.enabled': 'Enabled',
    'person.invited': 'Invited', 'person.joined': 'Joined', 'person.password_changed': 'Password changed', 'person.password_rehashed': 'Password kept by a costlier hash', 'person.reset': 'Key revoked, invited again',
    'person.roles_set': 'Roles set', 'person.signed_in': 'Signed in', 'person.signed_out': 'Signed out', 'policy.set': 'Policy put in force',
    'release.in_force': 'Release in force', 'release.made': 'Release made', 'release.pulled': 'File pulled', 'release.signed': 'Release signed', 'release.viewed': 'Release looked at',
    'release.withdrawn': 'Release withdrawn', 'revision.approved': 'Approved', 'revision.changes_requested': 'Changes requested',
    'revision.commented': 'Comment', 'revision.exported': 'Evidence downloaded', 'revision.pulled': 'Design downloaded', 'revision.saved': 'Revision saved',
    'revision.submitted': 'Submitted', 'revision.validated': 'Validated', 'revision.viewed': 'Revision looked at', 'revision.waived': 'Finding waived',
    'signer.enrolled': 'Machine enrolled', 'signer.invited': 'Machine invited', 'signer.revoked': 'Machine revoked', 'trust.published': 'List of keys signed',
    // Only looks, which leave a record where they are refused and at no other time.
    'access.key': 'Key of access tokens looked at', 'audit.consistency': 'Proof that the log only grew', 'audit.head': 'Head of the log looked at',
    'audit.inclusion': 'Proof that the log holds a record', 'designs': 'List of designs looked at', 'looms': 'List of looms looked at', 'me': 'Own account looked at',
    'me.waiting': 'What waits looked at', 'openapi': 'Description of the API looked at', 'people': 'List of people looked at', 'policy': 'Policy looked at', 'signers': 'List of machines looked at',
    'trust': 'List of keys looked at', 'trust.pending': 'What a next list of keys would change looked at',
};

/** What a record is about: a design or loom, and which revision, release or file of it. */
function about({ subject, data }) {
    return [subject, data?.revision ? `revision ${data.revision}` : null, data?.loom && data.loom !== subject ? data.loom : null, data?.release ? `release ${data.release}` : null,
        data?.pick ? `pick ${grouped(data.pick)}` : null, data?.file].filter(Boolean).join(', ');
}

// What older versions sent away is told by the name of its call, where that is no longer one.
const what = event => (event.kind === 'refused' ? `Refused: ${words[event.data.what] ?? 'call ' + event.data.what}` : words[event.kind] ?? event.kind);

export async function show({ search, go }) {
    const size = (await get('/audit/head')).size;
    const from = Math.max(0, Number(search.get('from') ?? size - page + 1) || 0); // room for the record of this very look
    const design = search.get('design') ?? '';
    const { events } = await get(`/events?from=${from}&limit=${page}${design ? '&design=' + encodeURIComponent(design) : ''}`);
    const head = await get('/audit/head'); // looking is a record of its own, so the head is asked for after it
    const last = head.size - 1;
    const verdict = h('p', { role: 'status', class: 'verdict' });
    const check = async () => {
        verdict.className = 'verdict';
        verdict.textContent = 'Checking …';
        const troubles = await verify(head, events).catch(error => [error.message]);
        verdict.className = 'verdict ' + (troubles.length ? 'trouble' : 'good');
        verdict.textContent = troubles.length ? troubles.join('. ')
            : `The log holds: ${events.length} records shown here are in it, and it only grew since this browser last looked.`;
    };
    const filter = h('input', { value: design, maxlength: 64, autocomplete: 'off' });
    const to = first => `/log?from=${Math.max(0, first)}${design ? '&design=' + encodeURIComponent(design) : ''}`;
    return {
        title: 'Log',
        body: [h('div', { class: 'head' }, h('h1', {}, 'Log'), h('div', { class: 'buttons' },
            h('button', { type: 'button', class: 'main', onclick: check }, 'Verify what is shown'),
            h('a', { class: 'button', href: '/api/v1/audit/bundle', download: 'audit-bundle.json' }, 'Download the bundle'))),
        h('section', { class: 'card' }, facts([['Records', grouped(head.size)], ['Root', hash(head.root)], ['Signed', when(head.at, true)]]), verdict,
            h('p', { class: 'hint' }, 'To verify offline what you download here: ', h('code', {}, 'loomlink audit verify audit-bundle.json --trust trust.json --fingerprint TRUST'),
                '. The list of keys, trust.json, is best taken once and kept: ', h('code', {}, 'loomlink trust show -o trust.json'), '. It tells the fingerprint, which an administrator confirms another way.')),
        h('form', { class: 'row', onsubmit: event => { event.preventDefault(); go(`/log?from=0&design=${encodeURIComponent(filter.value)}`); } }, field('Only this design', filter), h('button', {}, 'Show')),
        events.length === 0 ? h('p', { class: 'empty' }, design ? `There is no record about a design '${design}'.` : 'No record yet.')
            : table('Records', ['No.', 'When', 'Who', 'What', 'About', 'Why', 'Signed'], events.toReversed().map(event => [grouped(event.seq), when(event.at, true), event.actor, h('span', { title: event.kind }, what(event)), about(event), event.reason ?? '', event.signed ? h('span', { class: 'good' }, '✓ ' + event.signed) : '']), { class: 'records' }),
        h('nav', { class: 'buttons', 'aria-label': 'Pages' }, !design && from > 0 ? h('a', { class: 'button', href: to(from - page) }, 'Older') : null,
            events.length === page && events.at(-1).seq < last ? h('a', { class: 'button', href: to(events.at(-1).seq + 1) }, 'Newer') : null)],
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
