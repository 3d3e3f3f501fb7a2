import { h, facts, hash, say } from '../parts/dom.js';
import { post } from '../parts/api.js';
import { ask } from '../parts/dialog.js';

export async function show({ me }) {
    const change = () => ask({
        title: 'Change your password', button: 'Change it',
        text: 'Your signing key is sealed anew with the new password; the key itself stays. You sign in again afterwards.',
        fields: [{ name: 'old', label: 'Password until now', kind: 'password' },
            { name: 'new', label: 'New password', kind: 'password', hint: 'At least 12 characters' },
            { name: 'again', label: 'New password again', kind: 'password' }],
        act: async values => {
            if (values.new !== values.again) throw new Error('The two new passwords differ');
            await post('/me/password', { old: values.old, new: values.new });
            say('Your password is changed');
        },
    });
    return {
        title: 'Account',
        body: [h('h1', {}, me.full_name), h('section', { class: 'card' },
            facts([['Name', me.name], ['Roles', me.roles.join(', ')], ['Signing key', me.key ? hash(me.key, 16) : 'none']]),
            h('p', { class: 'buttons' }, h('button', { type: 'button', onclick: change }, 'Change password …')))],
    };
}
