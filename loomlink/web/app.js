// Which view a path shows, and the bar above all of them.
import { h, link, say } from './parts/dom.js';
import { get, post, may_be_known, on_signed_out, remember } from './parts/api.js';

const views = [
    ['/join', 'join'], ['/', 'home'], ['/designs', 'designs'], ['/designs/:design', 'design'],
    ['/designs/:design/diff', 'diff'], ['/designs/:design/:revision', 'revision'], ['/looms', 'looms'],
    ['/looms/:loom', 'loom'], ['/looms/:loom/:release', 'release'], ['/log', 'log'], ['/people', 'people'],
    ['/account', 'account'],
];

const numbers = [':revision', ':release'];

let me = null;
let shown = { leave() {} };
let latest = 0; // which of several views that are on their way is wanted

function found(path) {
    for (const [pattern, name] of views) {
        const parts = pattern.split('/'), given = path.replace(/(.)\/$/, '$1').split('/');
        if (parts.length !== given.length || !parts.every((part, i) => part.startsWith(':') || part === given[i])) continue;
        if (parts.some((part, i) => numbers.includes(part) && !/^[1-9]\d{0,8}$/.test(given[i]))) return null;
        try {
            return { name, names: Object.fromEntries(parts.flatMap((part, i) =>
                part.startsWith(':') ? [[part.slice(1), decodeURIComponent(given[i])]] : [])) };
        } catch {
            return null; // an address that is no UTF-8 names nothing
        }
    }
    return null;
}

/** Goes to a path of this page. */
export function go(to, { replace = false } = {}) {
    history[replace ? 'replaceState' : 'pushState'](null, '', to);
    return show();
}

/** Shows what the path names. `again`: what is there stays until the new is ready, and where the reader was. */
async function show({ again = false } = {}) {
    const mine = ++latest;
    const main = document.getElementById('main');
    const target = found(location.pathname);
    const name = !target ? 'lost' : !me && target.name !== 'join' ? 'login' : target.name;
    bar();
    if (!again) {
        shown.leave?.();
        shown = { leave() {} };
        main.replaceChildren(h('p', { class: 'waiting' }, 'Loading …'));
    }
    let content;
    try {
        const view = await import(`./views/${name}.js`);
        content = await view.show({ ...target?.names, me, go, refresh: () => show({ again: true }), signed_in, search: new URLSearchParams(location.search) });
    } catch (error) {
        if (again && error.status === 0) return say(error.message); // the line is down: what is there stays
        content = trouble(error);
    }
    if (mine !== latest) return content.leave?.();
    shown.leave?.();
    shown = content;
    main.replaceChildren(...[content.body].flat(3).filter(Boolean));
    document.title = content.title + ' · loomlink';
    if (again && document.activeElement !== document.body) return;
    main.focus({ preventScroll: true });
    if (!again) scrollTo(0, 0);
}

const trouble = error => ({
    title: 'Trouble',
    body: [h('h1', {}, 'That did not work'), h('p', { class: 'trouble', role: 'alert' }, error.message),
        h('p', { class: 'buttons' }, h('button', { type: 'button', class: 'main', onclick: () => show() }, 'Try again'), link('/', { class: 'button' }, 'To the start'))],
});

function signed_in(answer) {
    remember(answer);
    me = answer?.person ?? null;
}

async function sign_out() {
    await post('/logout').catch(() => {});
    signed_in(null);
    go('/');
}

function bar() {
    const place = document.getElementById('bar');
    if (!me) {
        place.replaceChildren(link('/', { class: 'name' }, 'loomlink'));
        return;
    }
    const has = (...roles) => roles.some(role => me.roles.includes(role));
    const entry = (to, text) => link(to, { 'aria-current': location.pathname === to || location.pathname.startsWith(to + '/') ? 'page' : null }, text);
    place.replaceChildren(
        link('/', { class: 'name' }, 'loomlink'),
        h('nav', { 'aria-label': 'Main' },
            has('designer', 'approver', 'engineer') ? entry('/designs', 'Designs') : null,
            entry('/looms', 'Looms'),
            has('engineer') ? entry('/log', 'Log') : null,
            has('admin') ? entry('/people', 'People') : null),
        h('div', { class: 'who' }, entry('/account', h('span', { class: 'cut' }, me.full_name)), h('button', { type: 'button', onclick: sign_out }, 'Sign out')));
}

document.addEventListener('click', event => {
    const anchor = event.target.closest?.('a[href]');
    if (!anchor || event.defaultPrevented || event.button !== 0 || event.ctrlKey || event.metaKey || event.shiftKey) return;
    const url = new URL(anchor.href);
    if (url.origin !== location.origin || anchor.hasAttribute('download') || url.pathname.startsWith('/api/') || anchor.target) return;
    if (anchor.getAttribute('href').startsWith('#')) return;
    event.preventDefault();
    go(url.pathname + url.search);
});
addEventListener('popstate', () => show());
on_signed_out(() => {
    if (!me) return;
    signed_in(null);
    say('Your sign-in has ended; sign in again');
    show();
});

signed_in_before();
async function signed_in_before() {
    try {
        if (may_be_known()) signed_in(await get('/me'));
    } catch (error) {
        if (error.status === 401) signed_in(null);
    }
    show();
}
