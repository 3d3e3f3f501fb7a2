// The main ways by the keyboard alone: sign in, save, submit with a signature, compare, go to a pick. What has the focus is seen all the time.
import { picture } from '../parts/looks.mjs';
import { Person } from '../parts/person.mjs';
import { loom } from './1-a-mill-opens.mjs';

export const title = 'the keyboard alone is enough to sign in, to submit, to compare and to go to a pick';

/** Goes to a link or button by Tab, and presses Enter. */
async function press(person, target) {
    await person.tab_to(target);
    await person.page.keyboard.press('Enter');
}

async function sign_in(person) {
    await person.page.goto(person.mill.origin + '/');
    await person.sees_heading('Sign in');
    await person.tab_to(person.page.getByLabel('Name'));
    await person.page.keyboard.type(person.name);
    await person.page.keyboard.press('Tab');
    await person.page.keyboard.type(person.password);
    await person.page.keyboard.press('Enter');
    await person.sees_heading('Hello, ' + person.full_name);
}

async function submit_and_compare(designer) {
    const { page } = designer;
    await press(designer, designer.link('Designs'));
    await press(designer, designer.link('toddler'));
    await designer.sees_heading('toddler');
    await press(designer, designer.button('Save a revision …'));
    await designer.dialog().getByLabel('Design file (.weave)').setInputFiles(designer.mill.designs.shoes); // the system's own dialog is not ours
    await designer.tab_to(designer.dialog().getByLabel('What changed'));
    await page.keyboard.type('Back to the first cloth, to be woven beside the other');
    await press(designer, designer.button('Save', designer.dialog()));
    await press(designer, page.getByRole('link', { name: /Revision 3/ }));
    await designer.sees_heading('toddler, revision 3');
    await press(designer, designer.button('Submit …'));
    await designer.tab_to(designer.dialog().getByLabel('Reason'));
    await page.keyboard.type('For comparison');
    await designer.tab_to(designer.dialog().getByLabel('Your password'));
    await page.keyboard.type(designer.password);
    await page.keyboard.press('Enter');
    await designer.sees('Submitted');
    await press(designer, designer.button('Face'));
    await page.getByRole('img', { name: 'Face of the cloth' }).waitFor();
    await press(designer, designer.button('Card image'));
    await designer.tab_to(page.getByRole('application', { name: /Card image/ }));
    await page.keyboard.press('ArrowRight');
    await designer.sees('Pick 1, end 2');
    await press(designer, designer.link('toddler'));
    for (const number of [3, 2]) {
        await designer.tab_to(page.getByLabel(`Choose revision ${number} for comparing`));
        await page.keyboard.press('Space');
    }
    await picture(page, 'the-focus-is-seen');
    await press(designer, designer.button('Compare 2 and 3'));
    await designer.sees_heading('toddler: what changed from 2 to 3');
}

async function go_to_a_pick(operator) {
    const { page } = operator;
    await press(operator, operator.link('Looms'));
    await press(operator, page.getByRole('link', { name: loom }));
    await press(operator, page.getByRole('link', { name: /Release 1, revision 2/ }));
    await operator.sees_heading('toddler, release 1');
    await operator.tab_to(page.getByLabel('Go to pick'));
    await page.keyboard.type('321');
    await page.keyboard.press('Enter');
    await page.getByRole('option', { selected: true }).getByText('321').waitFor();
    await operator.tab_to(page.getByRole('listbox'));
    await page.keyboard.press('ArrowDown');
    await page.getByRole('option', { selected: true }).getByText('322').waitFor();
    await operator.sees(/^Pick 322, end \d+$/);
}

/** Escape leaves a dialog, and the focus is where it was. */
async function leave_a_dialog(admin) {
    await press(admin, admin.link('People'));
    await press(admin, admin.button('Change the policy …'));
    await admin.dialog().waitFor();
    await admin.page.keyboard.press('Escape');
    await admin.dialog().waitFor({ state: 'detached' });
    await admin.page.waitForFunction(() => document.activeElement?.textContent === 'Change the policy …');
}

export async function run({ browser, mill, people }) {
    for (const [name, act] of [['dora', submit_and_compare], ['otto', go_to_a_pick], ['mary', leave_a_dialog]]) {
        const { full_name } = people[name];
        const person = await Person.enter(browser, mill, { name, full_name });
        people[name + '_by_keyboard'] = person;
        await sign_in(person);
        await act(person);
    }
}
