// One person looks at one page of a mill that is served, and a picture of it is kept: so tools/demo shows what its people see. Ends with 77 where no browser can be started.
//   node tests/page/visit.mjs --origin URL --certificate FILE --password FILE --name NAME --full-name NAME --page PATH --sees TEXT --picture FILE [--press BUTTON] [--tablet] [--whole]
import { readFile } from 'node:fs/promises';
import { parseArgs } from 'node:util';
import { picture_in } from './parts/looks.mjs';
import { pin_of } from './parts/mill.mjs';
import { desk, open_browser, Person, tablet } from './parts/person.mjs';

const word = { type: 'string' }, yes = { type: 'boolean' };
const { values: wish } = parseArgs({ options: { origin: word, certificate: word, password: word, name: word, 'full-name': word, page: word, sees: word, picture: word, press: word, tablet: yes, whole: yes } });

async function visit(browser, mill) {
    const password = (await readFile(wish.password, 'utf8')).split('\n')[0];
    const person = await Person.enter(browser, mill, { name: wish.name, full_name: wish['full-name'], device: wish.tablet ? tablet : desk, password });
    await person.sign_in();
    await person.page.goto(mill.origin + wish.page);
    await person.page.getByRole('heading', { level: 1 }).waitFor();
    await person.settled();
    if (wish.press) await person.button(wish.press).click();
    await person.sees(wish.sees);
    await person.settled();
    await picture_in(person.page, wish.picture, { whole: wish.whole, calm: true });
    person.quiet();
}

const mill = { origin: wish.origin, pin: await pin_of(wish.certificate) };
const browser = await open_browser(mill).catch(error => { console.error(error.message); process.exit(77); });
try {
    await visit(browser, mill);
} finally {
    await browser.close();
}
