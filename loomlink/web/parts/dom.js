// Builds elements. Text always goes in as text, never as HTML, so no name or comment can become markup.

/** h('p', {class: 'x', onclick: f}, 'text', child, …): properties that start with "on" are listeners; null children are left out. */
export function h(tag, properties = {}, ...children) {
    return fill(document.createElement(tag), properties, children);
}

/** The same for SVG. */
export function svg(tag, properties = {}, ...children) {
    return fill(document.createElementNS('http://www.w3.org/2000/svg', tag), properties, children);
}

function fill(element, properties, children) {
    for (const [name, value] of Object.entries(properties)) {
        if (value === undefined || value === null || (value === false && !name.startsWith('aria-'))) continue;
        if (name.startsWith('on')) element.addEventListener(name.slice(2), value);
        else element.setAttribute(name, value === true && !name.startsWith('aria-') ? '' : String(value));
    }
    element.append(...children.flat(3).filter(child => child !== null && child !== undefined && child !== false));
    return element;
}

/** A link that the page follows by itself. */
export const link = (to, properties, ...children) => h('a', { href: to, ...properties }, ...children);

/** A time by the reader's clock, with the month in letters, so that nobody takes it for the day; the exact one on hover. */
export function when(iso, to_the_second = false) {
    const time = new Date(iso);
    if (Number.isNaN(time.getTime())) return h('span', {}, String(iso));
    return h('time', { datetime: iso, title: iso },
        time.toLocaleString('en-GB', { dateStyle: 'medium', timeStyle: to_the_second ? 'medium' : 'short' }));
}

/** The first characters of a hash; the whole of it is read out and copied by its button. */
export function hash(text, shown = 12) {
    return h('button', {
        type: 'button', class: 'hash', title: 'Copy ' + text, 'aria-label': 'Copy hash ' + text.slice(0, shown),
        onclick: () => navigator.clipboard?.writeText(text).then(() => say('Copied'), () => say('The browser did not allow copying')),
    }, text.slice(0, shown));
}

/** The server's words, which begin small, where they stand alone. */
export const sentence = text => text.charAt(0).toUpperCase() + text.slice(1);

/** 1234 → "1,234", as all numbers of picks and ends are written here. */
export const grouped = number => number.toLocaleString('en');

/** 2097152 → "2.1 MB". */
export function size(bytes) {
    if (bytes < 1000) return bytes + ' B';
    return bytes < 1e6 ? (bytes / 1e3).toFixed(1) + ' kB' : (bytes / 1e6).toFixed(1) + ' MB';
}

export const counted = (number, one, many = one + 's') => `${grouped(number)} ${number === 1 ? one : many}`;

let hushed;
/** Tells something in passing; screen readers read it out. */
export function say(text) {
    const place = document.getElementById('said');
    place.textContent = text;
    place.classList.add('shown');
    clearTimeout(hushed);
    hushed = setTimeout(() => place.classList.remove('shown'), 5000);
}

const state_words = {
    draft: 'Draft', submitted: 'Submitted', approved: 'Approved', changes_requested: 'Changes requested', released: 'Released',
    superseded: 'Superseded', withdrawn: 'Withdrawn', awaiting: 'Awaiting a signature',
};
export const state = name => h('span', { class: 'state ' + name }, state_words[name] ?? name);

/** A table with a caption for those who cannot see where it stands. */
export function table(caption, heads, rows, properties = {}) {
    return h('div', { class: 'wide', tabindex: 0, role: 'region', 'aria-label': caption }, h('table', properties,
        h('caption', { class: 'unseen' }, caption),
        h('thead', {}, h('tr', {}, heads.map(head => h('th', { scope: 'col' }, head)))),
        h('tbody', {}, rows.map(row => h('tr', {}, row.map(cell => h('td', {}, cell)))))));
}

/** Names and values. */
export const facts = pairs => h('dl', { class: 'facts' },
    pairs.filter(Boolean).map(([name, ...value]) => h('div', {}, h('dt', {}, name), h('dd', {}, ...value))));

/** A labelled field; a group of choices has its label as a legend. */
export function field(label, input, hint) {
    if (input.tagName === 'FIELDSET') {
        input.prepend(h('legend', {}, label));
        return h('div', { class: 'field' }, input, hint ? h('p', { class: 'hint' }, hint) : null);
    }
    input.id ||= 'f' + Math.random().toString(36).slice(2);
    if (hint) input.setAttribute('aria-describedby', input.id + 'h');
    return h('div', { class: 'field' }, h('label', { for: input.id }, label), input,
        hint ? h('p', { class: 'hint', id: input.id + 'h' }, hint) : null);
}
