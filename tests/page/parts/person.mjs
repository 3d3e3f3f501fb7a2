// Somebody in front of a browser of his or her own, who finds things by what stands on them.
import assert from 'node:assert/strict';
import { chromium } from 'playwright-core';

export const desk = { viewport: { width: 1440, height: 900 } };
export const tablet = { viewport: { width: 1024, height: 768 }, hasTouch: true, isMobile: true };
const patience = 180000; // nothing here depends on speed
const given_up = 15000;
const password_of = name => `the warp and the weft of ${name}`;

/** Chromium takes this server's certificate alone, and finds no other host. */
export const open_browser = mill => chromium.launch({
    executablePath: process.env.CHROMIUM ?? '/usr/bin/chromium',
    args: ['--no-sandbox', '--disable-gpu', '--disable-quic', `--ignore-certificate-errors-spki-list=${mill.pin}`, '--host-resolver-rules=MAP * ~NOTFOUND , EXCLUDE localhost'],
});

export class Person {
    /** `device` is `desk` or `tablet`. */
    static async enter(browser, mill, { name, full_name, device = desk, password = password_of(name) }) {
        const person = new Person();
        Object.assign(person, { mill, name, full_name, password, troubles: [], refusals: 0, is_refused: false, in_flight: new Map() });
        person.context = await browser.newContext({ ...device, locale: 'en-GB', timezoneId: 'UTC', acceptDownloads: true });
        await person.context.grantPermissions(['clipboard-write', 'clipboard-read'], { origin: mill.origin });
        person.page = await person.context.newPage();
        person.page.setDefaultTimeout(patience);
        person.watch();
        return person;
    }

    /** What a person does not see, but what must not be: errors on the console, and requests to elsewhere. */
    watch() {
        const tell = text => {
            if (this.is_refused && /status of 4\d\d/.test(text)) ++this.refusals;
            else this.troubles.push(`${this.name} at ${this.page.url()}: ${text}`);
        };
        this.page.on('console', message => { if (['error', 'warning'].includes(message.type())) tell(`console: ${message.text()}`); });
        this.page.on('pageerror', error => tell(`script: ${error.message}`));
        this.page.on('request', request => { if (!/^(blob|data):/.test(request.url()) && new URL(request.url()).origin !== this.mill.origin) tell(`asked elsewhere: ${request.url()}`); });
        this.page.on('request', request => this.in_flight.set(request, Date.now()));
        for (const end of ['requestfinished', 'requestfailed']) this.page.on(end, request => this.in_flight.delete(request));
        this.page.on('response', response => { if (response.status() >= 500) tell(`${response.status()} of ${response.url()}`); });
    }

    /** Does something that the server must refuse; the browser says so on its console, perhaps a little later. */
    async refused(act) {
        const before = this.refusals;
        this.is_refused = true;
        await act();
        while (this.refusals === before) await this.page.waitForTimeout(100);
        await this.page.waitForTimeout(500);
        this.is_refused = false;
    }

    /** Waits until nothing asked of the server is open: what follows a click is there then. Of pictures that the page gave up, no end is told. */
    async settled() {
        const is_open = began => Date.now() - began < given_up;
        for (let calm = 0; calm < 3; calm = [...this.in_flight.values()].some(is_open) ? 0 : calm + 1) await this.page.waitForTimeout(100);
    }

    quiet() { assert.deepEqual(this.troubles, []); }

    button(name, within = this.page) { return within.getByRole('button', { name, exact: true }); }
    link(name, within = this.page) { return within.getByRole('link', { name, exact: true }); }
    heading(name) { return this.page.getByRole('heading', { name }); }
    region(name) { return this.page.locator('section', { has: this.page.getByRole('heading', { name, exact: true }) }); }
    dialog() { return this.page.getByRole('dialog'); }
    async sees(...texts) { for (const text of texts) await this.page.getByText(text).filter({ visible: true }).first().waitFor(); }
    async sees_heading(name) { await this.heading(name).first().waitFor(); }

    /** Goes by the bar at the top. */
    async to(name) {
        await this.page.getByRole('navigation', { name: 'Main' }).getByRole('link', { name, exact: true }).click();
        await this.page.getByRole('heading', { level: 1, name, exact: true }).waitFor();
    }
    async home() {
        await this.link('loomlink').click();
        await this.sees_heading('Hello, ' + this.full_name);
    }

    /** Opens the link of an invitation, says who joins, and sends it. */
    async ask_to_join(link) {
        await this.page.goto(link);
        await this.sees_heading('Join with an invitation');
        await this.page.getByLabel('Name to sign in with').fill(this.name);
        await this.page.getByLabel('Full name').fill(this.full_name);
        await this.page.getByLabel('Password', { exact: true }).fill(this.password);
        await this.page.getByLabel('Password again').fill(this.password);
        await this.button('Join').click();
    }
    async join(link) {
        await this.ask_to_join(link);
        await this.sees_heading('Hello, ' + this.full_name);
    }

    async sign_in() {
        await this.page.goto(this.mill.origin + '/');
        await this.page.getByLabel('Name').fill(this.name);
        await this.page.getByLabel('Password').fill(this.password);
        await this.button('Sign in').click();
        await this.sees_heading('Hello, ' + this.full_name);
    }

    /** Answers the dialog that is open: texts into its fields, the password again, and its button. */
    async answer(button, fields = {}, { password = this.password } = {}) {
        const dialog = this.dialog();
        for (const [label, value] of Object.entries(fields)) await dialog.getByLabel(label, { exact: true }).fill(value);
        const secret = dialog.getByLabel('Your password');
        if (await secret.count()) await secret.fill(password);
        await this.button(button, dialog).click();
    }
    async answered(button, fields = {}) {
        await this.answer(button, fields);
        await this.dialog().waitFor({ state: 'detached' });
    }

    /** Presses Tab until `target` has the focus; the focus must be seen on the way. */
    async tab_to(target, most = 80) {
        await this.settled(); // a page that is renewed takes the focus with it
        for (let presses = 0; presses < most; ++presses) {
            await this.page.keyboard.press('Tab');
            if (!await target.evaluate(element => element === document.activeElement)) continue;
            const outline = await target.evaluate(element => getComputedStyle(element).outlineStyle);
            assert.notEqual(outline, 'none', `${this.name}: the focus on ${target} is not seen`);
            return;
        }
        assert.fail(`${this.name}: ${target} is not reached by Tab`);
    }
}
