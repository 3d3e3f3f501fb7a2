import { h, link, state, when, table, counted } from '../parts/dom.js';
import { get, post, at } from '../parts/api.js';
import { ask } from '../parts/dialog.js';

export async function show({ me, go }) {
    const { designs } = await get('/designs');
    const make = async () => {
        const name = await ask({
            title: 'New design', button: 'Make it', fields: [{ name: 'name', label: 'Name', hint: 'Letters a to z, digits, dot, dash, underscore' }],
            act: async values => { await post('/designs', values); return values.name; },
        });
        if (name) go(at('designs', name));
    };
    return {
        title: 'Designs',
        body: [h('div', { class: 'head' }, h('h1', {}, 'Designs'),
            me.roles.includes('designer') ? h('button', { type: 'button', class: 'main', onclick: make }, 'New design …') : null),
        designs.length === 0 ? h('p', { class: 'empty' }, 'There is no design yet.' + (me.roles.includes('designer') ? ' Make one here, and save its first revision from a .weave file.' : ' Designers save them; they stand here then.'))
            : table('Designs', ['Design', 'Newest revision', 'State', 'Changed', 'Size'], designs.map(design => [
                link(at('designs', design.name), {}, h('strong', {}, design.name)),
                design.newest ? `${design.newest.number}, ${design.newest.message}` : 'none yet', design.newest ? state(design.newest.state) : '',
                design.newest ? [when(design.newest.at), ', ' + design.newest.author] : '',
                design.newest ? `${counted(design.newest.ends, 'end')} × ${counted(design.newest.picks, 'pick')}` : '']))],
    };
}
