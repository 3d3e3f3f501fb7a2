// Talks to /api/v1. A failure is an ApiError whose text can be shown as it is.
import { sentence } from './dom.js';

class ApiError extends Error {
    constructor(status, error) {
        const text = told(error) ?? `the server answered ${status}`;
        super(sentence(text));
        this.told = text;
        this.status = status;
        this.is_about_input = ['bad input', 'invalid'].includes(error?.kind);
    }
}

/** What the server says, behind the place that it is about. The place of a refusal is a word for programs. */
function told(error) {
    if (!error?.message || !error.where || ['refused', 'system'].includes(error.kind)) return error?.message;
    const is_field = /^[a-z_]+$/.test(error.where);
    return `${is_field ? error.where.replaceAll('_', ' ') : error.where}: ${error.message}`;
}

let csrf = '';
let leave = () => {};
const known = 'signed-in';

/** What to do when the server no longer knows us. */
export const on_signed_out = action => { leave = action; };

export function remember(signed_in) {
    csrf = signed_in?.csrf ?? '';
    if (csrf) localStorage.setItem(known, 'yes');
    else localStorage.removeItem(known);
}

/** Whether somebody signed in with this browser and did not sign out, so that the server may know who it is. */
export const may_be_known = () => localStorage.getItem(known) !== null;

/** Every call that changes something has an id of its own, so that a repeated one changes nothing twice. */
function request_id() {
    return [...crypto.getRandomValues(new Uint8Array(16))].map(byte => byte.toString(16).padStart(2, '0')).join('');
}

export const get = path => call('GET', path);
export const post = (path, body = {}) => call('POST', path, { request: request_id(), ...body });
export const put = (path, body = {}) => call('PUT', path, { request: request_id(), ...body });

async function call(method, path, body) {
    const headers = { Accept: 'application/json' };
    if (body) headers['Content-Type'] = 'application/json';
    if (method !== 'GET') headers['X-CSRF-Token'] = csrf;
    let answer;
    try {
        answer = await fetch('/api/v1' + path, { method, headers, body: body && JSON.stringify(body), credentials: 'same-origin' });
    } catch {
        throw new ApiError(0, { message: 'The server cannot be reached' });
    }
    const content = await answer.json().catch(() => ({}));
    if (answer.ok) return content;
    const error = new ApiError(answer.status, content.error);
    if (answer.status === 401 && !path.startsWith('/login')) leave();
    throw error;
}

export const at = (...parts) => '/' + parts.map(encodeURIComponent).join('/');
