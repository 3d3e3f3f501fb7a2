import { h, field } from '../parts/dom.js';
import { post } from '../parts/api.js';

export async function show({ signed_in, refresh }) {
    const name = h('input', { autocomplete: 'username', required: true, maxlength: 64, autocapitalize: 'none' });
    const password = h('input', { type: 'password', autocomplete: 'current-password', required: true });
    const trouble = h('p', { class: 'trouble', role: 'alert' });
    const button = h('button', { class: 'main', type: 'submit' }, 'Sign in');
    return {
        title: 'Sign in',
        body: h('form', {
            class: 'card narrow',
            onsubmit: async event => {
                event.preventDefault();
                button.disabled = true;
                try {
                    signed_in(await post('/login', { name: name.value, password: password.value }));
                    await refresh();
                } catch (error) {
                    trouble.textContent = error.message;
                    password.value = '';
                    button.disabled = false;
                }
            },
        }, h('h1', {}, 'Sign in'), field('Name', name), field('Password', password), trouble, button),
    };
}
