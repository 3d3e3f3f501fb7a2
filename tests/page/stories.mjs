// Stories of loomlink's page: people at real browsers, a real server, no stand-ins. Pictures of what they see are left in build/page-stories.
//   node tests/page/stories.mjs          WEAVE_BIN: the folder of the programs; CHROMIUM: the browser
import { readdir } from 'node:fs/promises';
import { clear_pictures, picture } from './parts/looks.mjs';
import { open_mill } from './parts/mill.mjs';
import { open_browser } from './parts/person.mjs';

const folder = new URL('stories/', import.meta.url);

/** Runs one story. A failure leaves pictures of what each person saw last. */
async function tell(story, here) {
    const began = Date.now();
    try {
        await story.run(here);
        for (const person of Object.values(here.people)) person.quiet();
        console.log(`passed  ${story.title} (${((Date.now() - began) / 1000).toFixed(1)} s)`);
        return true;
    } catch (error) {
        console.log(`FAILED  ${story.title}\n${error.stack ?? error}`);
        for (const [name, person] of Object.entries(here.people)) await picture(person.page, `failed-${name}`, { whole: true }).catch(() => {});
        for (const person of Object.values(here.people)) console.log(`${person.name} was at ${person.page.url()}`, ...person.troubles);
        return false;
    }
}

async function main() {
    await clear_pictures();
    const stories = [];
    for (const name of (await readdir(folder)).sort()) stories.push(await import(new URL(name, folder)));
    const mill = await open_mill();
    let browser, all_passed = true;
    try {
        browser = await open_browser(mill);
        const here = { browser, mill, people: {} };
        for (const story of stories) {
            all_passed = await tell(story, here); // each goes on where the one before it ended
            if (!all_passed) break;
        }
        if (!all_passed) console.log(mill.told());
    } finally {
        await browser?.close();
        await mill.stop();
    }
    return all_passed;
}

process.exitCode = await main().catch(error => { console.error(error); return false; }) ? 0 : 1;
