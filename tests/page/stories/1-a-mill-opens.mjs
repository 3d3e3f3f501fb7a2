// The first administrator joins by the link that the server printed, and makes the mill ready: policy, people, a loom, the keys it trusts.
import assert from 'node:assert/strict';
import { accessible, picture } from '../parts/looks.mjs';
import { Person, tablet } from '../parts/person.mjs';

export const title = 'an administrator makes the mill ready, and people join by their links';
export const loom = 'EP 2688 hall 3';

const newcomers = [
    { name: 'dora', full_name: 'Dora Weftwright-Featherstonehaugh of the Lower Mill', role: 'Designer' },
    { name: 'abel', full_name: 'Abel Reed', role: 'Approver' },
    { name: 'otto', full_name: 'Otto Shed', role: 'Operator', device: tablet },
    { name: 'emil', full_name: 'Emil Heald', role: 'Engineer' },
];

async function invite(admin, role) {
    await admin.button('Invite …').click();
    await admin.dialog().getByLabel(role).check();
    await admin.answer('Make an invitation');
    await admin.dialog().getByLabel('Link').waitFor();
    const link = await admin.dialog().getByLabel('Link').inputValue();
    await admin.button('Copy', admin.dialog()).click();
    await admin.sees('Copied');
    assert.equal(await admin.page.evaluate(() => navigator.clipboard.readText()), link);
    return link;
}

async function set_policy(admin) {
    await admin.to('People');
    await admin.button('Change the policy …').click();
    await admin.dialog().getByLabel('Simulation before approval').selectOption('Not required');
    await admin.dialog().getByLabel('Share of the crossings').fill('7.5');
    await accessible(admin.page, 'the dialog of the policy');
    await admin.answered('Put in force');
    await admin.sees('not required', 'Nothing can be approved until more join: this asks for 1 approver, and there are 0');
    await admin.settled();
    await admin.button('Change the policy …').click();
    assert.equal(await admin.dialog().getByLabel('Share of the crossings').inputValue(), '7.5');
    await admin.button('Cancel', admin.dialog()).click();
}

/** A file that cannot be a profile is told by its name: a picture and what is too large before anything is sent, a design by the server. */
async function refused_files(admin) {
    const says = async (file, words) => {
        await admin.dialog().getByLabel('Profile (JSON)').setInputFiles(file);
        await admin.answer('Add it', { Name: loom });
        await admin.dialog().getByRole('alert').filter({ hasText: words }).waitFor();
    };
    const bytes = (name, buffer) => ({ name, mimeType: 'application/octet-stream', buffer });
    await says(bytes('four.png', Buffer.from('\x89PNG\r\n', 'latin1')), 'four.png: is no profile of a loom, which is a text');
    await says(bytes('large.json', Buffer.alloc(2 ** 20 + 1, ' ')), 'large.json: has 1.0 MB, and a profile of a loom has 1.0 MB at most');
    await admin.refused(() => says(admin.mill.designs.plain, 'plain.weave: profile: is a design, no profile of a loom'));
}

/** A browser that sends far too much hears so from the server, and is not cut off. */
async function send_too_much(admin) {
    await admin.refused(async () => {
        const status = await admin.page.evaluate(() => fetch('/api/v1/looms', { method: 'POST', headers: { 'Content-Type': 'application/json' }, body: ' '.repeat(2e7) }).then(answer => answer.status));
        assert.equal(status, 413);
    });
}

async function add_loom(admin) {
    await admin.to('Looms');
    await admin.sees('There is no loom yet');
    await admin.button('New loom …').click();
    await refused_files(admin);
    await admin.dialog().getByLabel('Profile (JSON)').setInputFiles(admin.mill.profile);
    await admin.answered('Add it', { Name: loom });
    await admin.page.getByRole('link', { name: loom }).click();
    await admin.sees_heading(loom);
    await admin.sees('Nothing is released for this loom');
    await admin.button('Operators …').click();
    await admin.answered('Set', { 'Names to sign in with, with commas between': 'otto' });
    await admin.settled();
    await admin.page.getByText('Profile of the loom').click();
    await admin.page.getByRole('definition').getByText('otto', { exact: true }).waitFor();
}

async function sign_keys(admin) {
    await admin.home();
    await admin.page.getByRole('link', { name: /Keys that looms trust/ }).click();
    await admin.sees('The key of abel is not listed yet');
    await picture(admin.page, 'people-and-keys', { whole: true });
    await admin.button('Sign the list …').click();
    await admin.answered('Sign the list');
    await admin.sees('The signed list is as people are now');
    await admin.home();
    await admin.sees('Nothing at the moment');
}

export async function run({ browser, mill, people }) {
    const admin = await Person.enter(browser, mill, { name: 'mary', full_name: 'Mary Loom' });
    people.mary = admin;
    await admin.page.goto(mill.origin + '/');
    await admin.sees_heading('Sign in');
    await picture(admin.page, 'sign-in');
    await admin.page.goto(mill.invitation);
    await admin.sees_heading('Join with an invitation');
    await picture(admin.page, 'join');
    await admin.join(mill.invitation);
    await set_policy(admin);
    for (const { role, ...who } of newcomers) {
        const link = await invite(admin, role);
        if (role === 'Designer') await picture(admin.page, 'an-invitation');
        await admin.button('Done', admin.dialog()).click();
        people[who.name] = await Person.enter(browser, mill, who);
        await people[who.name].join(link);
        await people[who.name].sees('Nothing at the moment');
        assert.ok(!people[who.name].page.url().includes('#'), 'the code stays in the address');
    }
    const late = await Person.enter(browser, mill, { name: 'late', full_name: 'Late Comer' });
    await late.page.goto(mill.origin + '/join#%ff'); // no link of ours, and no reason to break down
    await late.sees_heading('Join with an invitation');
    await late.refused(async () => { // a link works once
        await late.ask_to_join(mill.invitation);
        await late.sees('this code is not, or no longer, good');
    });
    late.quiet();
    await late.context.close();
    await admin.to('People');
    await admin.sees('Policy of the site');
    assert.equal(await admin.page.getByText('until more join').count(), 0);
    await add_loom(admin);
    await send_too_much(admin);
    await sign_keys(admin);
}
