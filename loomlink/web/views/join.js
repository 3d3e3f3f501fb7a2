import { h, field } from '../parts/dom.js';
import { post } from '../parts/api.js';

// The code stands behind # in the invitation's link, so it is never sent in a request line.
export async function show({ signed_in, go }) {
    const code = h('input', { required: true, value: location.hash.slice(1), autocomplete: 'off' });
    const name = h('input', { required: true, autocomplete: 'username', autocapitalize: 'none', maxlength: 64, pattern: '[a-z0-9][a-z0-9._\\-]*' });
    const full_name = h('input', { required: true, autocomplete: 'name', maxlength: 128 });
    const password = h('input', { type: 'password', required: true, minlength: 12, autocomplete: 'new-password' });
    const again = h('input', { type: 'password', required: true, autocomplete: 'new-password' });
    const trouble = h('p', { class: 'trouble', role: 'alert' });
    return {
        title: 'Join',
        body: h('form', {
            class: 'card narrow',
            onsubmit: async event => {
                event.preventDefault();
                if (password.value !== again.value) {
                    trouble.textContent = 'The two passwords differ';
                    return;
                }
                try {
                    signed_in(await post('/invitations/accept', { code: code.value.trim(), name: name.value, full_name: full_name.value, password: password.value }));
                    await go('/', { replace: true });
                } catch (error) {
                    trouble.textContent = error.message;
                }
            },
        }, h('h1', {}, 'Join with an invitation'),
            field('Invitation code', code), field('Name to sign in with', name, 'Small letters a to z, digits, dot, dash, underscore'),
            field('Full name', full_name, 'It stands beside everything that you sign'),
            field('Password', password, 'At least 12 characters. It also seals your signing key: nobody can reset it for you without giving you a new key.'),
            field('Password again', again), trouble, h('button', { class: 'main', type: 'submit' }, 'Join')),
    };
}
