import { h, link } from '../parts/dom.js';

export const show = async () => ({
    title: 'Not found',
    body: [h('h1', {}, 'There is no such page'), h('p', {}, link('/', { class: 'button' }, 'To the start'))],
});
