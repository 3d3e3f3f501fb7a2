// An operator at a tablet finds the release, inspects it down to single crossings, pulls its files, goes to pick 1,234, and says what is wrong.
import assert from 'node:assert/strict';
import { createHash } from 'node:crypto';
import { readFile } from 'node:fs/promises';
import { accessible, large_targets, picture } from '../parts/looks.mjs';

export const title = 'an operator at a tablet finds a release, inspects, pulls, goes to pick 1,234, and reports a fault';

/** Pulls every file that the page offers. Answers their contents by name, each with the hash that the page showed. */
async function pull_all(operator) {
    const files = new Map();
    for (const row of await operator.region('Files for the controller').getByRole('listitem').all()) {
        const button = row.getByRole('link', { name: /^Pull / });
        const download = operator.page.waitForEvent('download');
        await button.tap();
        const pulled = await download;
        const bytes = await readFile(await pulled.path());
        const shown = (await row.getByRole('button', { name: /^Copy hash/ }).textContent()).trim();
        assert.ok(createHash('sha256').update(bytes).digest('hex').startsWith(shown), `${pulled.suggestedFilename()} has another hash than the page shows`);
        files.set(pulled.suggestedFilename(), bytes);
    }
    return files;
}

/** What the pulled table of picks says of one of them, in the words of the page. */
function pick_of(files, number) {
    const [, table] = [...files].find(([name]) => name.endsWith('-picks.csv'));
    const [head, ...rows] = table.toString().trim().split(/\r?\n/).map(line => line.split(','));
    const row = Object.fromEntries(rows[number - 1].map((cell, i) => [head[i], cell]));
    assert.equal(row.pick, String(number));
    return { feeder: row[head.at(-1)], direction: row.direction, yarn: row.yarn };
}

/** Colours in the middle of the card view: crossings that are crisp have few. */
const colours = canvas => canvas.evaluate(element => {
    const { data } = element.getContext('2d').getImageData(element.width / 4, element.height / 4, 200, 200);
    const seen = new Set();
    for (let i = 0; i < data.length; i += 4) seen.add(data.slice(i, i + 3).join());
    return seen.size;
});

async function inspect(operator) {
    const card = operator.page.getByRole('application', { name: /Card image of the release/ });
    await card.scrollIntoViewIfNeeded();
    for (let k = 0; k < 8; ++k) await operator.button('Zoom in').tap();
    await operator.settled();
    await card.tap({ position: { x: 250, y: 200 } });
    await operator.sees(/Pick [\d,]+, end \d+/);
    await picture(operator.page, 'single-crossings', { calm: true });
    assert.ok(await colours(card) <= 6, 'single crossings are blurred');
    await operator.button('Show all').tap();
}

async function go_to_1234(operator, files) {
    const expected = pick_of(files, 1234);
    const go = operator.page.getByLabel('Go to pick');
    await go.fill('1,999');
    await operator.button('Go').tap();
    await operator.sees('This release has the picks 1 to 1,824');
    await go.fill('1,234');
    await operator.button('Go').tap();
    const chosen = operator.page.getByRole('option', { selected: true });
    await chosen.getByText('1,234').waitFor();
    await chosen.getByText(`Feeder ${expected.feeder}`).waitFor();
    await chosen.getByRole('img', { name: expected.direction }).waitFor();
    await operator.sees(`Pick 1,234, feeder ${expected.feeder}, ${expected.direction}, ${expected.yarn}`);
    await operator.sees(/^Pick 1,234, end \d+$/);
    await operator.settled();
    await picture(operator.page, 'pick-1234', { calm: true });
    await operator.button('One pick on').tap();
    await operator.page.getByRole('option', { selected: true }).getByText('1,235').waitFor();
    await operator.button('One pick back').tap();
    await operator.button('Remember as last woven').tap();
    await operator.sees('Pick 1,234 is remembered as the last woven one');
}

async function report(operator) {
    await operator.button('Report a fault …').tap();
    assert.equal(await operator.dialog().getByLabel('Pick').inputValue(), '1234');
    await accessible(operator.page, 'the dialog of a fault');
    await large_targets(operator.page, 'the dialog of a fault');
    await operator.dialog().getByLabel('What is wrong').fill('The weft caught at the left selvedge');
    await picture(operator.page, 'a-fault-is-reported');
    await operator.answered('Send to the designer');
    await operator.sees('The weft caught at the left selvedge');
}

export async function run({ people: { otto, dora } }) {
    await otto.sees('Release 1, revision 2'); // it came up by itself, on the page that was open
    await picture(otto.page, 'a-release-comes-up');
    await otto.page.getByRole('link', { name: /Release 1, revision 2/ }).tap();
    await otto.sees_heading('toddler, release 1');
    await otto.page.getByRole('option').first().waitFor();
    await otto.settled();
    await picture(otto.page, 'a-release-at-the-loom', { calm: true });
    await inspect(otto);
    const files = await pull_all(otto);
    assert.ok([...files.keys()].some(name => name.endsWith('.ep')) && files.has('manifest.json'), [...files.keys()].join(', '));
    await otto.button('Confirm loaded …').tap();
    await otto.answered('Yes, it is loaded');
    await otto.page.getByRole('heading', { level: 1 }).getByText('Loaded').waitFor();
    await go_to_1234(otto, files);
    await otto.page.reload();
    await otto.page.getByRole('option', { selected: true }).getByText('1,234').waitFor();
    await report(otto);

    await dora.home();
    await dora.sees('1 fault reported at the loom');
    await picture(dora.page, 'the-designer-hears-of-it');
    await dora.page.getByRole('link', { name: /1 fault reported/ }).click();
    await dora.sees('The weft caught at the left selvedge');
}
