// Every page at a desk and at a tablet: nothing breaks a rule of accessibility, nothing is cut off, and a finger in a glove meets what it aims at.
import { accessible, large_targets, picture } from '../parts/looks.mjs';
import { desk, Person, tablet } from '../parts/person.mjs';
import { loom } from './1-a-mill-opens.mjs';

export const title = 'every page keeps to the rules of accessibility, at a desk and at a tablet';

const hall = '/looms/' + encodeURIComponent(loom);
const pages = [
    ['start', '/', /Hello/], ['designs', '/designs', 'Designs'], ['a design', '/designs/toddler', 'toddler'],
    ['a revision', '/designs/toddler/2', 'toddler, revision 2'], ['a comparison', '/designs/toddler/diff?from=1&to=2', /what changed/],
    ['looms', '/looms', 'Looms'], ['a loom', hall, loom], ['a release', hall + '/1', /toddler, release 1/], ['the log', '/log', 'Log'],
    ['people', '/people', 'People'], ['the account', '/account', /Vera/], ['no such page', '/nowhere', /no such page/],
    ['no such design', '/designs/nothing', /did not work/],
    ['no number', '/designs/toddler/abc', /no such page/], ['no two revisions', '/designs/toddler/diff', /did not work/],
];

/** Somebody who may see everything. */
async function enter_with_all_roles({ browser, mill, people }) {
    const { mary } = people;
    await mary.to('People');
    await mary.button('Invite …').click();
    for (const role of ['Designer', 'Approver', 'Operator', 'Engineer', 'Administrator']) await mary.dialog().getByLabel(role).check();
    await mary.answer('Make an invitation');
    const link = await mary.dialog().getByLabel('Link').inputValue();
    await mary.button('Done', mary.dialog()).click();
    people.vera = await Person.enter(browser, mill, { name: 'vera', full_name: 'Vera Everywhere' });
    await people.vera.join(link);
    await mary.to('Looms');
    await mary.page.getByRole('link', { name: loom }).click();
    await mary.button('Operators …').click();
    await mary.answered('Set', { 'Names to sign in with, with commas between': 'otto, vera' });
    await mary.settled();
}

async function look_at(person, [name, path, heading], device, is_tablet) {
    await person.page.goto(person.mill.origin + path);
    await person.sees_heading(heading);
    await person.settled();
    if (name === 'a revision') {
        await person.button('Check for this loom').click();
        await person.sees(/0 errors/);
    }
    const folded = person.page.locator('details:not([open]) > summary');
    while (await folded.count()) await folded.first().click();
    await person.page.evaluate(() => scrollTo(0, 0));
    await picture(person.page, `${device}-${name.replaceAll(' ', '-')}`, { whole: true });
    await accessible(person.page, `${name}, ${device}`);
    if (is_tablet) await large_targets(person.page, `${name}, ${device}`);
}

/** The page's own way to an address that is no UTF-8, such as an old bookmark's: the server answers it by itself when it is loaded. */
async function follow_a_broken_address(person) {
    await person.page.evaluate(() => {
        history.pushState(null, '', '/designs/%ff');
        dispatchEvent(new PopStateEvent('popstate'));
    });
    await person.sees_heading(/no such page/);
}

export async function run({ browser, mill, people }) {
    await enter_with_all_roles({ browser, mill, people });
    await follow_a_broken_address(people.vera);
    for (const [device, size] of [['desk', desk], ['tablet', tablet]]) {
        const person = await Person.enter(browser, mill, { name: 'vera', full_name: 'Vera Everywhere', device: size });
        people['vera_at_' + device] = person;
        for (const [name, path, heading] of [['signing in', '/', 'Sign in'], ['joining', '/join', /Join/]]) await look_at(person, [name, path, heading], device, device === 'tablet');
        await person.sign_in();
        await person.refused(async () => { for (const page of pages) await look_at(person, page, device, device === 'tablet'); });
    }
}
