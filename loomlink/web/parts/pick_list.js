// The weft insertion order as a list that may be long: only what is seen is in the page.
import { h } from './dom.js';
import { get } from './api.js';

const row_height = 48, page = 200;

/**
 * source: path that answers {picks:[{pick, feeder, direction, yarn, colour, take_up}]} for ?from=&count=.
 * Answers {element, show_pick(n)}; `on_choose(pick)` hears which row was touched.
 */
export function pick_list({ source, picks, on_choose = () => {} }) {
    const pages = new Map();
    let current = null;
    const inner = h('div', { class: 'picks_inner', role: 'presentation' });
    const box = h('div', { class: 'picks', tabindex: 0, role: 'listbox', 'aria-label': 'Picks in the order of insertion', onscroll: () => draw() }, inner);
    inner.style.height = Math.min(picks * row_height, 8e6) + 'px';
    const stretch = Math.max(1, (picks * row_height) / 8e6); // browsers draw no box higher than some ten million pixels

    function entries(from) {
        const number = Math.floor(from / page);
        if (!pages.has(number)) {
            pages.set(number, null);
            get(`${source}?from=${number * page + 1}&count=${page}`).then(answer => { pages.set(number, answer.picks); draw(); },
                () => pages.delete(number));
        }
        return pages.get(number);
    }

    function row_of(index, top) {
        const entry = entries(index)?.[index % page];
        const number = index + 1;
        const row = h('div', {
            class: 'pick' + (number === current ? ' current' : ''), role: 'option', 'aria-selected': number === current, id: 'pick' + number,
            'aria-setsize': picks, 'aria-posinset': number, onclick: () => { select(number); on_choose(number); },
        }, h('span', { class: 'number' }, number.toLocaleString('en')), ...(entry ? cells(entry) : [h('span', { class: 'soft' }, '…')]));
        row.style.top = top + 'px';
        return row;
    }

    const cells = entry => {
        const swatch = h('span', { class: 'swatch', 'aria-hidden': 'true' });
        if (entry.colour) swatch.style.background = entry.colour;
        return [h('span', { class: 'feeder' }, entry.feeder ? 'Feeder ' + entry.feeder : 'no weft'), swatch,
            h('span', { class: 'yarn' }, entry.yarn ?? ''),
            h('span', { class: 'direction', 'aria-label': entry.direction === 'left_to_right' ? 'left to right' : 'right to left' },
                entry.direction === 'left_to_right' ? '→' : '←'),
            h('span', { class: 'soft' }, entry.take_up ? '' : 'no take-up')];
    };

    function draw() {
        const scrolled = box.scrollTop;
        const first = Math.max(0, Math.floor(scrolled * stretch / row_height) - 4);
        const last = Math.min(picks, first + Math.ceil(box.clientHeight / row_height) + 9);
        const shift = scrolled - scrolled * stretch;
        inner.replaceChildren(...Array.from({ length: Math.max(0, last - first) }, (_, i) => row_of(first + i, (first + i) * row_height + shift)));
    }

    function select(pick) {
        current = pick;
        box.setAttribute('aria-activedescendant', 'pick' + pick);
        draw();
    }

    function show_pick(pick) {
        box.scrollTop = Math.max(0, (pick - 1) * row_height / stretch - box.clientHeight / 2 + row_height / 2);
        select(pick);
    }

    box.addEventListener('keydown', event => {
        const moves = { ArrowDown: 1, ArrowUp: -1, PageDown: 20, PageUp: -20, Home: -picks, End: picks };
        if (!(event.key in moves)) return;
        event.preventDefault();
        const next = Math.min(Math.max((current ?? 0) + moves[event.key], 1), picks);
        show_pick(next);
        on_choose(next);
    });
    new ResizeObserver(draw).observe(box);
    return { element: box, show_pick };
}
