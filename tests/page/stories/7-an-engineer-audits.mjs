// An engineer looks at the history, compares two revisions, verifies the log in the browser, and takes the proofs along.
import assert from 'node:assert/strict';
import { readFile } from 'node:fs/promises';
import { picture } from '../parts/looks.mjs';

export const title = 'an engineer compares two revisions and verifies the log';

async function download(person, name) {
    const coming = person.page.waitForEvent('download');
    await person.link(name).click();
    const file = await coming;
    return { name: file.suggestedFilename(), text: (await readFile(await file.path())).toString() };
}

async function compare(engineer) {
    await engineer.to('Designs');
    await engineer.link('toddler').click();
    await engineer.page.getByRole('link', { name: /Revision 2/ }).waitFor();
    assert.ok(await engineer.button('Compare two').isDisabled());
    await engineer.page.getByLabel('Choose revision 1 for comparing').check();
    await engineer.page.getByLabel('Choose revision 2 for comparing').check();
    await picture(engineer.page, 'the-history');
    await engineer.button('Compare 1 and 2').click();
    await engineer.sees_heading('toddler: what changed from 1 to 2');
    const row = engineer.page.getByRole('table').getByRole('row', { name: '1,234 100 lifted' });
    await row.waitFor();
    const shown = engineer.page.getByRole('img', { name: /laid on each other/ });
    await shown.evaluate(image => image.decode());
    await picture(engineer.page, 'two-revisions-compared', { whole: true });
}

async function verify(engineer) {
    await engineer.to('Log');
    await engineer.sees('Release withdrawn', 'File pulled', 'Last pick remembered', 'loomlink audit verify audit-bundle.json --trust trust.json --fingerprint TRUST');
    for (const round of ['first', 'second']) {
        await engineer.button('Verify what is shown').click();
        await engineer.page.getByText(/^The log holds: \d+ records/).waitFor();
        if (round === 'first') await engineer.page.reload();
    }
    await picture(engineer.page, 'the-log-holds');
}

/** A browser that holds another head than the log grew from says so. */
async function find_rewriting(engineer) {
    await engineer.page.evaluate(() => {
        const head = JSON.parse(localStorage.getItem('log-head'));
        localStorage.setItem('log-head', JSON.stringify({ ...head, root: '0'.repeat(64) }));
    });
    await engineer.page.reload();
    await engineer.button('Verify what is shown').click();
    await engineer.sees('its history was rewritten');
    await picture(engineer.page, 'a-rewritten-log-is-found');
}

export async function run({ people: { emil } }) {
    await compare(emil);
    await verify(emil);
    await emil.page.getByLabel('Only this design').fill('toddler');
    await emil.button('Show').click();
    await emil.page.getByRole('cell', { name: 'Revision saved' }).first().waitFor();
    assert.equal(await emil.page.getByRole('cell', { name: 'Joined' }).count(), 0);
    const bundle = await download(emil, 'Download the bundle');
    assert.equal(bundle.name, 'audit-bundle.json');
    assert.ok(bundle.text.length > 10000, 'the bundle has too little in it');
    await emil.to('Designs');
    await emil.link('toddler').click();
    await emil.page.getByRole('link', { name: /Revision 2/ }).click();
    const evidence = JSON.parse((await download(emil, 'Download the evidence')).text);
    assert.equal(evidence.format, 'loomlink-revision-bundle');
    assert.equal(evidence.revision.number, 2);
    await emil.to('Log');
    await find_rewriting(emil);
}
