// A site that asks for a simulation before the approval: a machine is enrolled, what it signs is filed by the page, and counts.
import assert from 'node:assert/strict';
import { picture } from '../parts/looks.mjs';

export const title = 'evidence of an enrolled machine is filed by the page, and an approval is possible then';

async function ask_for_simulations(admin) {
    await admin.to('People');
    await admin.button('Change the policy …').click();
    await admin.dialog().getByLabel('Simulation before approval').selectOption('Required');
    await admin.answered('Put in force');
    await admin.settled();
    await admin.button('Add a machine …').click();
    await admin.answer('Make a code', { 'What it is called': 'box' });
    await admin.dialog().getByLabel('Code').waitFor();
    const code = await admin.dialog().getByLabel('Code').inputValue();
    await admin.button('Done', admin.dialog()).click();
    return code;
}

async function save_and_submit(designer, { designs }) {
    await designer.to('Designs');
    await designer.button('New design …').click();
    await designer.answered('Make it', { Name: 'plain' });
    await designer.sees('No revision yet');
    await designer.button('Save a revision …').click();
    await designer.dialog().getByLabel('Design file (.weave)').setInputFiles(designs.plain);
    await designer.answered('Save', { 'What changed': 'A plain weave' });
    await designer.page.getByRole('link', { name: /Revision 1/ }).click();
    await designer.button('Submit …').click();
    await designer.answered('Sign and submit', { Reason: 'Ready' });
    await designer.sees('Submitted');
}

async function file_evidence(person, file) {
    await person.button('File evidence …').click();
    await person.dialog().getByLabel('Evidence file').setInputFiles(file);
    await person.answer('File it');
}

export async function run({ mill, people: { mary, dora, abel } }) {
    const code = await ask_for_simulations(mary);
    await save_and_submit(dora, mill);
    await abel.page.goto(mill.origin + '/designs/plain/1');
    await abel.sees('A simulation of this very design and scene', 'Simulations count that a machine known here has signed');
    assert.equal(await abel.button('Approve …').count(), 0, 'an approval is offered that would be refused');
    await picture(abel.page, 'a-simulation-is-missing', { whole: true });

    await file_evidence(dora, { name: 'result.json', mimeType: 'application/json', buffer: Buffer.from('{"residual": 0}') });
    await dora.dialog().getByRole('alert').filter({ hasText: /^result.json: is no evidence that a machine signed/ }).waitFor();
    await dora.button('Cancel', dora.dialog()).click();
    const access = await mary.page.evaluate(() => fetch('/api/v1/access-key').then(answer => answer.json()));
    await file_evidence(dora, await mill.simulate(code, access));
    await dora.dialog().waitFor({ state: 'detached' });
    await dora.region('Evidence').getByRole('row', { name: /^simulation .* counts$/ }).waitFor();
    await picture(dora.page, 'evidence-that-counts', { whole: true });

    await abel.page.reload();
    await abel.button('Approve …').click();
    await abel.answered('Sign and approve', { Reason: 'It holds together' });
    await abel.sees('Approved by Abel Reed');
}
