// Questions in a dialog: the keyboard stays in it, Escape leaves it, and the focus goes back to where it was.
import { h, field } from './dom.js';

/**
 * Asks for the fields and runs `act(values)`; an error that it throws is shown and the dialog stays. Resolves to what act gave, or
 * undefined where the person left it.
 * fields: [{name, label, hint, kind: 'text' | 'area' | 'password' | 'number' | 'choice' | 'checks' | 'file', choices, value, required}],
 * of numbers also min (1 where not said), max and step.
 */
export function ask({ title, text, fields = [], button, danger = false, act }) {
    return new Promise(resolve => {
        let result;
        const inputs = new Map(fields.map(f => [f.name, input_of(f)]));
        const trouble = h('p', { class: 'trouble', role: 'alert' });
        const go = h('button', { type: 'submit', class: danger ? 'danger' : 'main' }, button);
        const heading = h('h2', { id: 'asked' }, title);
        const form = h('form', {
            method: 'dialog',
            onsubmit: async event => {
                event.preventDefault();
                go.disabled = true;
                trouble.textContent = '';
                try {
                    result = await act(Object.fromEntries([...inputs].map(([name, input]) => [name, value_of(input)]))) ?? true;
                    dialog.close();
                } catch (error) {
                    trouble.textContent = error.message;
                    go.disabled = false;
                }
            },
        }, heading, text ? h('p', {}, text) : null,
            fields.map(f => field(f.label, inputs.get(f.name), f.hint)), trouble,
            h('div', { class: 'buttons' }, h('button', { type: 'button', onclick: () => dialog.close() }, 'Cancel'), go));
        const dialog = h('dialog', { 'aria-labelledby': 'asked', onclose: () => { dialog.remove(); resolve(result); } }, form);
        document.body.append(dialog);
        dialog.showModal();
        (form.querySelector('input, textarea, select') ?? go).focus();
    });
}

function input_of({ kind = 'text', choices, value, required = true, name, min = 1, max, step }) {
    if (kind === 'area') {
        const area = h('textarea', { rows: 3, required, maxlength: 4000 });
        area.value = value ?? '';
        return area;
    }
    if (kind === 'choice') {
        return h('select', {}, choices.map(([id, text]) => h('option', { value: id, selected: id === value }, text)));
    }
    if (kind === 'checks') return h('fieldset', {}, choices.map(([id, text]) => h('label', { class: 'check' },
        h('input', { type: 'checkbox', value: id, checked: value?.includes(id) }), text)));
    if (kind === 'file') return h('input', { type: 'file', required });
    return h('input', {
        type: kind, required, value, ...(kind === 'number' ? { min, max, step } : {}),
        autocomplete: kind === 'password' ? (name === 'new' ? 'new-password' : 'current-password') : 'off',
    });
}

function value_of(input) {
    if (input.tagName === 'FIELDSET') return [...input.querySelectorAll(':checked')].map(check => check.value);
    if (input.type === 'file') return input.files[0];
    if (input.type === 'number') return input.value === '' ? undefined : Number(input.value);
    return input.value;
}

/** Shows a text that has to be handed on and is told only once, such as a link. */
export function hand_over({ title, text, label, value }) {
    return new Promise(resolve => {
        const shown = h('input', { readonly: true, value, onfocus: () => shown.select() });
        const copied = h('p', { class: 'good', role: 'status' });
        const copy = () => {
            shown.select();
            navigator.clipboard.writeText(value).then(() => { copied.textContent = 'Copied'; }, () => { copied.textContent = 'Selected: copy it with the keyboard'; });
        };
        const dialog = h('dialog', { 'aria-labelledby': 'handed', onclose: () => { dialog.remove(); resolve(true); } },
            h('h2', { id: 'handed' }, title), h('p', {}, text), field(label, shown), copied,
            h('div', { class: 'buttons' }, h('button', { type: 'button', onclick: copy }, 'Copy'),
                h('button', { type: 'button', class: 'main', onclick: () => dialog.close() }, 'Done')));
        document.body.append(dialog);
        dialog.showModal();
        shown.focus();
    });
}

/** A step that is signed: why, and the password again. */
export const sign = ({ title, text, fields = [], button, danger, act, reason = 'Reason' }) => ask({
    title, text, button, danger, act,
    fields: [...fields, { name: 'reason', label: reason, kind: 'area' },
        { name: 'password', label: 'Your password', kind: 'password', hint: 'It opens your key for this one signature.' }],
});
