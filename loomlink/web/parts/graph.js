// The history of a design as a graph: newest on top, a lane a branch, merges as lines that join.
import { h, svg, link, state, when } from './dom.js';
import { at } from './api.js';

const step = 56, lane_width = 22, lanes_shown = 8;
const lane_colours = ['#1f3a4d', '#c8641b', '#4a7c59', '#7a4f9a', '#a8893b', '#2a7f9e', '#9e3d52', '#5b6770'];

/** Lane of each revision, newest first: the first parent keeps its child's lane. */
function lanes_of(revisions) {
    const lane = new Map(), open = [];
    for (const revision of revisions) {
        let mine = open.indexOf(revision.number);
        if (mine < 0) {
            mine = open.indexOf(null);
            if (mine < 0) mine = open.push(null) - 1;
        }
        lane.set(revision.number, mine);
        open.forEach((wanted, i) => { if (wanted === revision.number) open[i] = null; });
        revision.parents.forEach((parent, i) => {
            if (open.includes(parent)) return;
            if (i === 0) open[mine] = parent;
            else {
                const free = open.indexOf(null);
                if (free < 0) open.push(parent);
                else open[free] = parent;
            }
        });
    }
    return lane;
}

/** revisions: [{number, parents, state, author, at, message, branches}] newest first; chosen: Set of numbers, changed in place. */
export function history(design, revisions, { chosen, on_choose }) {
    const lane = lanes_of(revisions);
    const row = new Map(revisions.map((revision, i) => [revision.number, i]));
    const x = number => 14 + Math.min(lane.get(number), lanes_shown - 1) * lane_width, y = number => step / 2 + row.get(number) * step;
    const wide = 28 + (Math.min(Math.max(...lane.values(), 0), lanes_shown - 1)) * lane_width;
    const colour = number => lane_colours[lane.get(number) % lane_colours.length];
    const lines = revisions.flatMap(revision => revision.parents.filter(parent => row.has(parent)).map(parent => svg('path', {
        d: `M${x(revision.number)} ${y(revision.number)} C${x(revision.number)} ${y(revision.number) + step / 2} ${x(parent)} ${y(revision.number) + step / 2} ${x(parent)} ${y(revision.number) + step} L${x(parent)} ${y(parent)}`,
        fill: 'none', stroke: colour(lane.get(parent) > lane.get(revision.number) ? parent : revision.number), 'stroke-width': 2.5,
    })));
    const dots = revisions.map(revision => svg('circle', { cx: x(revision.number), cy: y(revision.number), r: 6, fill: colour(revision.number), stroke: '#fff', 'stroke-width': 2 }));
    const drawing = svg('svg', { width: wide, height: revisions.length * step, 'aria-hidden': 'true' }, lines, dots);
    const list = h('ol', { class: 'revisions' }, revisions.map(revision => h('li', {},
        h('label', { class: 'choose', title: 'Choose for comparing' }, h('input', {
            type: 'checkbox', checked: chosen.has(revision.number), 'aria-label': `Choose revision ${revision.number} for comparing`,
            onchange: event => on_choose(revision.number, event.target.checked),
        })),
        link(at('designs', design, revision.number), { class: 'revision' }, h('strong', {}, 'Revision ' + revision.number), ' ', revision.message || 'no message'),
        h('span', { class: 'soft by' }, when(revision.at), ', ', revision.author),
        revision.branches.map(branch => h('span', { class: 'branch' }, branch)), state(revision.state))));
    return h('div', { class: 'history' }, drawing, list);
}
