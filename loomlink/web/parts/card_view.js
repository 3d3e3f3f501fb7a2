// A card image of any size, from the whole of it down to single crossings: tiles come from the server as they are needed.
import { h, grouped } from './dom.js';

const tile = 512;
const most_zoom = 40; // screen pixels a crossing
const colours = { ground: '#f4f1ea', grid: '#d8d2c4', mark: '#d1495b' };

/**
 * source: path of the tiles, which take x, y, w, h, scale; picks count from the bottom, so y is turned here.
 * Answers {element, show_pick(n), leave()}; `on_place(pick, end)` hears where the pointer or the keyboard is, from 1.
 */
export function card_view({ source, picks, ends, on_place = () => {}, label }) {
    const canvas = h('canvas', { tabindex: 0, role: 'application', 'aria-label': label + '. Arrow keys move, plus and minus zoom, Home shows all.' });
    const place = h('output', { class: 'place', 'aria-live': 'polite' });
    const tiles = new Map();
    let zoom = 1, x = 0, y = 0, cursor = null, waiting = false, first = true, wanted = null, scale = devicePixelRatio || 1;

    const fit = () => Math.min(canvas.width / ends, canvas.height / picks);
    const clamp = () => {
        zoom = Math.min(Math.max(zoom, Math.min(fit(), 1)), most_zoom * scale);
        const wide = canvas.width / zoom, high = canvas.height / zoom;
        x = wide >= ends ? (ends - wide) / 2 : Math.min(Math.max(x, 0), ends - wide);
        y = high >= picks ? (picks - high) / 2 : Math.min(Math.max(y, 0), picks - high);
    };
    const draw_soon = () => {
        if (waiting) return;
        waiting = true;
        requestAnimationFrame(() => { waiting = false; draw(); });
    };

    function tile_at(column, row, step) {
        const key = `${column}/${row}/${step}`;
        let found = tiles.get(key);
        if (found) {
            tiles.delete(key); // the newest stand last
            tiles.set(key, found);
            return found;
        }
        const span = tile * step;
        const image = new Image();
        found = { image, ready: false };
        image.onload = () => { found.ready = true; draw_soon(); };
        image.src = `${source}?x=${column * span}&y=${row * span}&w=${Math.min(span, ends - column * span)}&h=${Math.min(span, picks - row * span)}&scale=${step}`;
        tiles.set(key, found);
        if (tiles.size > 96) tiles.delete(tiles.keys().next().value);
        return found;
    }

    function draw() {
        clamp();
        const pen = canvas.getContext('2d');
        pen.fillStyle = colours.ground;
        pen.fillRect(0, 0, canvas.width, canvas.height);
        pen.imageSmoothingEnabled = zoom < 1;
        const step = 2 ** Math.max(0, Math.ceil(Math.log2(1 / zoom)));
        const span = tile * step;
        const left = Math.max(0, Math.floor(x / span)), right = Math.min(Math.ceil(ends / span), Math.ceil((x + canvas.width / zoom) / span));
        const top = Math.max(0, Math.floor(y / span)), bottom = Math.min(Math.ceil(picks / span), Math.ceil((y + canvas.height / zoom) / span));
        // The whole card at its coarsest lies below, so that nothing is blank while its parts are on their way.
        const coarsest = 2 ** Math.max(0, Math.ceil(Math.log2(Math.max(ends, picks) / tile)));
        const whole = tile_at(0, 0, coarsest);
        if (whole.ready) pen.drawImage(whole.image, Math.round(-x * zoom), Math.round(-y * zoom), Math.round(ends * zoom), Math.round(picks * zoom));
        for (let row = top; row < bottom; ++row) {
            for (let column = left; column < right; ++column) {
                const { image, ready } = tile_at(column, row, step);
                if (!ready) continue;
                const wide = Math.min(span, ends - column * span), high = Math.min(span, picks - row * span);
                pen.drawImage(image, Math.round((column * span - x) * zoom), Math.round((row * span - y) * zoom),
                    Math.round(wide * zoom), Math.round(high * zoom));
            }
        }
        if (zoom >= 8) grid(pen);
        if (cursor) {
            band(pen, picks - cursor.pick);
            outline(pen);
        }
    }

    function grid(pen) {
        pen.strokeStyle = colours.grid;
        pen.beginPath();
        for (let end = Math.max(0, Math.ceil(x)); end <= Math.min(ends, x + canvas.width / zoom); ++end) {
            pen.moveTo(Math.round((end - x) * zoom) + 0.5, Math.max(0, -y * zoom));
            pen.lineTo(Math.round((end - x) * zoom) + 0.5, Math.min(canvas.height, (picks - y) * zoom));
        }
        for (let row = Math.max(0, Math.ceil(y)); row <= Math.min(picks, y + canvas.height / zoom); ++row) {
            pen.moveTo(Math.max(0, -x * zoom), Math.round((row - y) * zoom) + 0.5);
            pen.lineTo(Math.min(canvas.width, (ends - x) * zoom), Math.round((row - y) * zoom) + 0.5);
        }
        pen.stroke();
    }

    function band(pen, row) {
        pen.strokeStyle = colours.mark;
        pen.lineWidth = 2 * scale;
        const from = Math.round((row - y) * zoom), high = Math.max(2, Math.round(zoom));
        pen.strokeRect(Math.max(1, -x * zoom), from, Math.min(canvas.width - 2, ends * zoom), high);
        pen.lineWidth = 1;
    }

    function outline(pen) {
        pen.strokeStyle = colours.mark;
        pen.lineWidth = 2 * scale;
        pen.strokeRect(Math.round((cursor.end - 1 - x) * zoom), Math.round((picks - cursor.pick - y) * zoom), Math.max(3, Math.round(zoom)), Math.max(3, Math.round(zoom)));
        pen.lineWidth = 1;
    }

    function tell() {
        place.textContent = cursor ? `Pick ${grouped(cursor.pick)}, end ${grouped(cursor.end)}` : '';
        if (cursor) on_place(cursor.pick, cursor.end);
    }

    function zoom_by(factor, at_x = canvas.width / 2, at_y = canvas.height / 2) {
        const held_x = x + at_x / zoom, held_y = y + at_y / zoom;
        zoom *= factor;
        clamp();
        x = held_x - at_x / zoom;
        y = held_y - at_y / zoom;
        draw_soon();
    }

    function show_all() {
        zoom = fit();
        draw_soon();
    }

    function show_pick(pick) {
        if (first) { // there is no size to draw in yet
            wanted = pick;
            return;
        }
        const was_whole = zoom < 6 * scale;
        cursor = { pick, end: cursor?.end ?? 1 };
        zoom = Math.max(zoom, 6 * scale);
        if (was_whole) x = cursor.end - 0.5 - canvas.width / zoom / 2;
        y = picks - pick + 0.5 - canvas.height / zoom / 2;
        tell();
        draw_soon();
    }

    function step_cursor(picks_on, ends_on) {
        cursor ??= { pick: 1, end: 1 };
        cursor = { pick: Math.min(Math.max(cursor.pick + picks_on, 1), picks), end: Math.min(Math.max(cursor.end + ends_on, 1), ends) };
        const cx = (cursor.end - 0.5 - x) * zoom, cy = (picks - cursor.pick + 0.5 - y) * zoom;
        if (cx < 0 || cx > canvas.width) x = cursor.end - canvas.width / zoom / 2;
        if (cy < 0 || cy > canvas.height) y = picks - cursor.pick + 0.5 - canvas.height / zoom / 2;
        tell();
        draw_soon();
    }

    const keys = {
        ArrowUp: many => step_cursor(many, 0), ArrowDown: many => step_cursor(-many, 0), ArrowLeft: many => step_cursor(0, -many),
        ArrowRight: many => step_cursor(0, many), '+': () => zoom_by(1.5), '=': () => zoom_by(1.5), '-': () => zoom_by(1 / 1.5), Home: show_all,
    };
    canvas.addEventListener('keydown', event => {
        if (!keys[event.key] || event.ctrlKey || event.metaKey) return;
        event.preventDefault();
        keys[event.key](event.shiftKey ? 10 : 1);
    });
    canvas.addEventListener('wheel', event => {
        event.preventDefault();
        zoom_by(1.2 ** (-event.deltaY / 100), event.offsetX * scale, event.offsetY * scale);
    }, { passive: false });

    const fingers = new Map();
    let moved = false;
    canvas.addEventListener('pointerdown', event => {
        canvas.setPointerCapture(event.pointerId);
        fingers.set(event.pointerId, event);
        moved = false;
    });
    canvas.addEventListener('pointermove', event => {
        const before = fingers.get(event.pointerId);
        if (!before) return;
        const gap = () => { const [a, b] = [...fingers.values()]; return Math.hypot(a.offsetX - b.offsetX, a.offsetY - b.offsetY); };
        if (fingers.size === 2) {
            const was = gap();
            fingers.set(event.pointerId, event);
            zoom_by(gap() / Math.max(was, 1), event.offsetX * scale, event.offsetY * scale);
        } else {
            x -= (event.offsetX - before.offsetX) * scale / zoom;
            y -= (event.offsetY - before.offsetY) * scale / zoom;
            fingers.set(event.pointerId, event);
            draw_soon();
        }
        moved ||= Math.hypot(event.offsetX - before.offsetX, event.offsetY - before.offsetY) > 2;
    });
    const lift = event => {
        if (fingers.delete(event.pointerId) && !moved && event.type === 'pointerup') {
            const end = Math.floor(x + event.offsetX * scale / zoom) + 1, pick = picks - Math.floor(y + event.offsetY * scale / zoom);
            if (end >= 1 && end <= ends && pick >= 1 && pick <= picks) {
                cursor = { pick, end };
                tell();
                draw_soon();
            }
        }
    };
    canvas.addEventListener('pointerup', lift);
    canvas.addEventListener('pointercancel', lift);

    const watch = new ResizeObserver(() => {
        scale = devicePixelRatio || 1;
        canvas.width = Math.max(1, Math.round(canvas.clientWidth * scale));
        canvas.height = Math.max(1, Math.round(canvas.clientHeight * scale));
        if (first) {
            first = false;
            if (wanted === null) show_all();
            else show_pick(wanted);
        }
        draw_soon();
    });
    watch.observe(canvas);

    const button = (text, name, act) => h('button', { type: 'button', 'aria-label': name, title: name, onclick: act }, text);
    return {
        element: h('div', { class: 'card_view' }, canvas, h('div', { class: 'card_bar' },
            button('+', 'Zoom in', () => zoom_by(2)), button('−', 'Zoom out', () => zoom_by(0.5)), button('All', 'Show all', show_all), place),
        h('p', { class: 'hint' }, 'Dark: the end is lifted. Pick 1 is at the bottom, end 1 at the left. Drag to move, pinch or turn the wheel to zoom.')),
        show_pick, leave: () => watch.disconnect(),
    };
}
