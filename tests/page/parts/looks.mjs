// What is asked of every page that a person sees: no violation of accessibility rules, nothing cut off, targets for gloves; and a picture of it.
import assert from 'node:assert/strict';
import { mkdir, readdir, readFile, rm } from 'node:fs/promises';
import { createRequire } from 'node:module';
import path from 'node:path';
import { tree } from './mill.mjs';

export const pictures = path.join(tree, 'build/page-stories');
const axe = await readFile(createRequire(import.meta.url).resolve('axe-core/axe.min.js'), 'utf8');
const least_target = 44; // CSS pixels, for a finger in a glove
let taken = 0;

/** Removes the pictures of the run before. */
export async function clear_pictures() {
    await mkdir(pictures, { recursive: true });
    for (const name of await readdir(pictures)) if (/\.png$/.test(name)) await rm(path.join(pictures, name));
}

/** Keeps a picture of what the person sees in a file; `whole`: of the page to its end; `calm`: when nothing is told in passing any more. */
export async function picture_in(page, file, { whole = false, calm = false } = {}) {
    if (calm) await page.waitForFunction(() => !document.querySelector('#said.shown'));
    await page.evaluate(() => document.fonts.ready);
    await page.screenshot({ path: file, fullPage: whole, animations: 'disabled' });
}

/** The same among the pictures of this run. */
export const picture = (page, name, how) => picture_in(page, path.join(pictures, `${String(++taken).padStart(2, '0')}-${name}.png`), how);

/** Fails where the page, as it is now, breaks a rule of axe-core, or can be moved sideways. */
export async function accessible(page, where) {
    await page.evaluate(axe);
    const found = await page.evaluate(async () => (await globalThis.axe.run()).violations.map(({ id, help, nodes }) => `${id} (${help}): ${nodes.slice(0, 3).map(node => node.target.join(' ')).join(', ')}`));
    assert.deepEqual(found, [], `${where}: axe-core`);
    const [wide, room] = await page.evaluate(() => [document.documentElement.scrollWidth, document.documentElement.clientWidth]);
    assert.ok(wide <= room, `${where}: the page is ${wide - room} pixels wider than the screen`);
}

/** Fails where something to be touched is too small. Links in running text are as high as their line. */
export async function large_targets(page, where) {
    const small = await page.evaluate(least => [...document.querySelectorAll('button, a[href], input, select, textarea, summary, [role=option]')].flatMap(element => {
        const target = element.matches('input[type=checkbox]') ? element.closest('label') : element;
        const { width, height } = target.getBoundingClientRect();
        const text = element.textContent.trim() || element.getAttribute('aria-label') || element.tagName;
        const is_hidden = width === 0 || element.closest('.skip') || getComputedStyle(element).visibility === 'hidden';
        return is_hidden || height >= least - 0.5 ? [] : [`${text}: ${Math.round(height)}`];
    }), least_target);
    assert.deepEqual(small, [], `${where}: targets lower than ${least_target} pixels`);
}
