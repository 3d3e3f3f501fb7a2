// The weft insertion order as a list that may be long: only what is seen is in the page.
import { h, grouped } from './dom.js';
import { get } from './api.js';

const row_height = 60, page = 200;
const tallest = 8e6; // browsers draw no box higher than some ten million pixels

const arrow = entry => (entry.direction === 'left_to_right' ? '→' : '←');
const direction = entry => (entry.direction === 'left_to_right' ? 'left to right' : 'right to left');
const feeders = entry => (entry.feeder ? `Feeder ${entry.feeder}${entry.second_feeder ? ' and ' + entry.second_feeder : ''}` : 'No weft');

/** A pick in words, as a person reads it to another. */
export const pick_words = entry => [`Pick ${grouped(entry.pick)}`, feeders(entry).toLowerCase(), direction(entry), entry.yarn,
    entry.take_up ? null : 'the cloth stands still'].filter(Boolean).join(', ');

/** A pick as it stands in a list or above it: its feeder in its colour, the way the weft goes, its yarn. */
export function pick_cells(entry) {
    const swatch = h('span', { class: 'swatch', 'aria-hidden': 'true' });
    if (entry.colour) swatch.style.background = entry.colour;
    return [swatch, h('span', { class: 'weft' }, h('span', { class: 'feeder' }, feeders(entry)),
        h('span', { class: 'soft' }, [entry.take_up ? null : 'no take-up', entry.yarn].filter(Boolean).join(', '))),
    h('span', { class: 'direction', role: 'img', 'aria-label': direction(entry) }, arrow(entry))];
}

/**
 * source: path that answers {picks:[{pick, feeder, second_feeder, direction, yarn, colour, take_up}]} for ?from=&count=.
 * Answers {element, show_pick(n), leave()}; `on_choose(pick)` hears which row was touched, `on_known(entry)` what the pick that is shown is.
 */
export function pick_list({ source, picks, on_choose = () => {}, on_known = () => {} }) {
    const pages = new Map();
    let current = null;
    const inner = h('div', { class: 'picks_inner', role: 'presentation' });
    const box = h('div', { class: 'picks', tabindex: 0, role: 'listbox', 'aria-label': 'Picks in the order of insertion', onscroll: () => draw() }, inner);
    inner.style.height = Math.min(picks * row_height, tallest) + 'px';
    const stretch = Math.max(1, (picks * row_height) / tallest);

    function entries(index) {
        const number = Math.floor(index / page);
        if (!pages.has(number)) {
            pages.set(number, null);
            get(`${source}?from=${number * page + 1}&count=${page}`).then(answer => {
                pages.set(number, answer.picks);
                draw();
                tell();
            }, () => pages.delete(number));
        }
        return pages.get(number);
    }

    const entry_of = pick => entries(pick - 1)?.[(pick - 1) % page];

    function tell() {
        const entry = current === null ? null : entry_of(current);
        if (entry) on_known(entry);
    }

    function row_of(number, top) {
        const entry = entry_of(number);
        const row = h('div', {
            class: 'pick' + (number === current ? ' current' : ''), role: 'option', 'aria-selected': number === current, id: 'pick' + number,
            'aria-setsize': picks, 'aria-posinset': number, onclick: () => { select(number); on_choose(number); },
        }, h('span', { class: 'number' }, grouped(number)), ...(entry ? pick_cells(entry) : [h('span', { class: 'soft' }, '…')]));
        row.style.top = top + 'px';
        return row;
    }

    function draw() {
        const scrolled = box.scrollTop;
        const first = Math.max(0, Math.floor(scrolled * stretch / row_height) - 4);
        const last = Math.min(picks, first + Math.ceil(box.clientHeight / row_height) + 9);
        const shift = scrolled - scrolled * stretch;
        inner.replaceChildren(...Array.from({ length: Math.max(0, last - first) }, (_, i) => row_of(first + i + 1, (first + i) * row_height + shift)));
    }

    function select(pick) {
        current = pick;
        box.setAttribute('aria-activedescendant', 'pick' + pick);
        draw();
        tell();
    }

    function show_pick(pick) {
        box.scrollTop = Math.max(0, (pick - 0.5) * row_height / stretch - box.clientHeight / 2);
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
    const watch = new ResizeObserver(draw);
    watch.observe(box);
    return { element: box, show_pick, leave: () => watch.disconnect() };
}
