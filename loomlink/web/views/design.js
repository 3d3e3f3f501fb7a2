import { h, link, say } from '../parts/dom.js';
import { get, post, at } from '../parts/api.js';
import { ask } from '../parts/dialog.js';
import { kinds, send_file } from '../parts/files.js';
import { history } from '../parts/graph.js';

export async function show({ design, me, go, refresh }) {
    const content = await get(at('designs', design));
    const chosen = new Set();
    const compare = h('button', { type: 'button', disabled: true, onclick: () => {
        const [from, to] = [...chosen].sort((a, b) => a - b);
        go(`${at('designs', design, 'diff')}?from=${from}&to=${to}`);
    } }, 'Compare two');
    const on_choose = (number, is_chosen) => {
        if (is_chosen) chosen.add(number);
        else chosen.delete(number);
        compare.disabled = chosen.size !== 2;
        compare.textContent = chosen.size === 2 ? `Compare ${[...chosen].sort((a, b) => a - b).join(' and ')}` : 'Compare two';
    };
    const save = async () => {
        const made = await ask({
            title: 'Save a revision', button: 'Save', fields: [
                { name: 'file', label: 'Design file (.weave)', kind: 'file' },
                { name: 'branch', label: 'Branch', value: content.branches[0]?.name ?? 'main' },
                { name: 'message', label: 'What changed', kind: 'area' }],
            act: values => send_file(values.file, kinds.design, document => post(at('designs', design, 'revisions'), {
                document, branch: values.branch, message: values.message,
                expected: content.branches.find(branch => branch.name === values.branch)?.head ?? null,
            })),
        });
        if (made) { say(`Saved as revision ${made.number}`); refresh(); }
    };
    return {
        title: design,
        body: [h('p', { class: 'path' }, link('/designs', {}, 'Designs')),
            h('div', { class: 'head' }, h('h1', {}, design), h('div', { class: 'buttons' }, compare,
                me.roles.includes('designer') ? h('button', { type: 'button', class: 'main', onclick: save }, 'Save a revision …') : null)),
            content.revisions.length === 0 ? h('p', { class: 'empty' }, 'No revision yet.') : history(design, content.revisions, { chosen, on_choose }),
            content.releases.length === 0 ? null : [h('h2', {}, 'Releases'), h('ul', { class: 'plain' }, content.releases.map(release => h('li', {},
                link(at('looms', release.loom, release.number), {}, `${release.loom}, release ${release.number}`), ` of revision ${release.revision}: ${release.state}`)))]],
    };
}
