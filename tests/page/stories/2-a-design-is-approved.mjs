// A designer submits, an approver asks for changes; the designer saves better work, the approver approves it with a signature and releases it.
// The operator's tablet shows the loom all the while.
import assert from 'node:assert/strict';
import { readFile } from 'node:fs/promises';
import { accessible, picture } from '../parts/looks.mjs';
import { loom } from './1-a-mill-opens.mjs';

export const title = 'a designer submits, an approver asks for changes, approves with a signature and releases';

async function save(designer, file, message) {
    await designer.button('Save a revision …').click();
    await designer.dialog().getByLabel('Design file (.weave)').setInputFiles(file);
    await designer.answered('Save', { 'What changed': message });
}

async function make_design(designer, { designs }) {
    await designer.to('Designs');
    await designer.sees('There is no design yet');
    await picture(designer.page, 'no-design-yet');
    await designer.button('New design …').click();
    await designer.answered('Make it', { Name: 'toddler' });
    await designer.sees_heading('toddler');
    await designer.sees('No revision yet');
    await designer.refused(async () => {
        await designer.button('Save a revision …').click();
        await designer.dialog().getByLabel('Design file (.weave)').setInputFiles({ name: 'x.weave', mimeType: 'text/plain', buffer: Buffer.from('{"no": "design"}') });
        await designer.answer('Save', { 'What changed': 'Nothing good' });
        await designer.dialog().getByRole('alert').filter({ hasText: /^x.weave: is not a .weave document/ }).waitFor();
        await picture(designer.page, 'a-file-is-refused');
        await designer.button('Cancel', designer.dialog()).click();
    });
    await save(designer, designs.shoes, 'Twelve toddler shoes in one cloth');
    await designer.page.getByRole('link', { name: /Revision 1/ }).click();
    await designer.sees_heading('toddler, revision 1');
}

async function look_at_pictures(designer) {
    const pictures = designer.region('Pictures');
    for (const view of ['Face', 'Back', 'Floats', 'Layers']) {
        await designer.button(view, pictures).click();
        const shown = pictures.getByRole('img', { name: `${view} of the cloth` });
        await shown.waitFor();
        await shown.evaluate(image => image.decode());
        if (view === 'Face') await picture(designer.page, 'the-face-of-the-cloth');
    }
    await designer.button('Card image', pictures).click();
}

async function check_and_submit(designer) {
    await designer.button('Check for this loom').click();
    await designer.sees(/0 errors/);
    await picture(designer.page, 'a-revision-is-checked', { whole: true });
    await designer.button('Submit …').click();
    await designer.dialog().getByLabel(loom).check();
    await accessible(designer.page, 'the dialog of a signature');
    await designer.refused(async () => {
        await designer.answer('Sign and submit', { Reason: 'Ready to be judged' }, { password: 'not my password at all' });
        await designer.dialog().getByRole('alert').filter({ hasText: /password/ }).waitFor();
        await picture(designer.page, 'a-wrong-password');
    });
    await designer.answered('Sign and submit');
    await designer.sees('Submitted');
    await designer.sees('1 approval of somebody who did not work on it');
    assert.equal(await designer.button('Approve …').count(), 0, 'an author may approve');
}

async function ask_for_changes(approver) {
    await approver.home();
    await approver.page.getByRole('link', { name: /toddler, revision 1/ }).click();
    await approver.sees_heading('toddler, revision 1');
    const card = approver.page.getByRole('application', { name: /Card image/ });
    await card.click({ position: { x: 380, y: 200 } });
    await approver.sees(/Pick [\d,]+, end \d+/);
    await approver.page.getByLabel('Comment', { exact: true }).fill('This end leans over its neighbour <b>a lot</b>');
    await approver.page.getByLabel('About the place marked in the card image').check();
    await approver.button('Send the comment').click();
    await approver.sees('This end leans over its neighbour <b>a lot</b>', /at pick [\d,]+, end \d+/);
    await approver.button('Ask for changes …').click();
    await picture(approver.page, 'changes-are-asked-for');
    await approver.answered('Sign and send', { 'What should change': 'Exchange the crossing at pick 1,234, end 100: the weft floats there' });
    await approver.sees('Changes requested');
}

async function save_better_work(designer, { designs }) {
    await designer.home();
    await designer.sees('Changes were requested');
    await picture(designer.page, 'what-waits-for-the-designer');
    await designer.page.getByRole('link', { name: /toddler, revision 1/ }).click();
    await designer.sees('Exchange the crossing at pick 1,234, end 100');
    await designer.link('toddler').click();
    await save(designer, designs.better, 'The crossing at pick 1,234 exchanged, as Abel asked, so that the weft no longer floats over the end beside it');
    await designer.page.getByRole('link', { name: /Revision 2/ }).click();
    await designer.sees_heading('toddler, revision 2');
    await designer.button('Submit …').click();
    await designer.dialog().getByLabel(loom).check();
    await designer.answered('Sign and submit', { Reason: 'As asked for' });
    await designer.sees('Submitted');
}

async function approve_and_release(approver) {
    await approver.home();
    await approver.page.getByRole('link', { name: /toddler, revision 2/ }).click();
    await approver.button('Approve …').click();
    await approver.sees('You approve exactly this revision');
    await picture(approver.page, 'an-approval-is-signed');
    await approver.answered('Sign and approve', { Reason: 'The float is gone' });
    await approver.sees('A release to a loom', 'Approved by Abel Reed');
    await approver.button('Release to a loom …').click();
    await approver.dialog().getByLabel('Loom').selectOption(loom);
    await approver.answer('Next');
    await approver.sees(`Release to ${loom}`);
    await approver.refused(async () => {
        await approver.dialog().getByLabel(/^Loom feeder/).first().fill('99');
        await approver.answer('Sign and release', { Reason: 'For the autumn season' });
        await approver.dialog().getByRole('alert').filter({ hasText: 'Feeders: this loom has no feeder 99, it has 1 to' }).waitFor();
    });
    await approver.dialog().getByLabel(/^Loom feeder/).first().fill('1');
    await approver.answered('Sign and release');
    await approver.page.getByRole('heading', { level: 1 }).getByText('Released').waitFor();
    await picture(approver.page, 'released', { whole: true });
}

export async function run({ mill, people: { dora, abel, otto } }) {
    await otto.to('Looms');
    await otto.page.getByRole('link', { name: loom }).click();
    await otto.sees('Nothing is released for this loom');
    await picture(otto.page, 'a-loom-without-a-release');

    await make_design(dora, mill);
    await look_at_pictures(dora);
    await check_and_submit(dora);
    await ask_for_changes(abel);
    await save_better_work(dora, mill);
    await approve_and_release(abel);

    // What a comment says is text, never markup, and the document comes back as it was given.
    const download = dora.page.waitForEvent('download');
    await dora.link('Download the design').click();
    assert.deepEqual(await readFile(await (await download).path()), await readFile(mill.designs.better));
}
