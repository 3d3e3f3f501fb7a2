// An approver withdraws a release: it vanishes from the operator's page, which was open at it, and its files cannot be pulled any more.
import assert from 'node:assert/strict';
import { accessible, picture } from '../parts/looks.mjs';
import { loom } from './1-a-mill-opens.mjs';

export const title = 'a recall makes a release vanish from the loom';

export async function run({ people: { abel, otto } }) {
    await otto.page.getByRole('option', { selected: true }).getByText('1,234').waitFor();
    const pull = await otto.page.getByRole('link', { name: /^Pull .*\.ep$/ }).getAttribute('href');

    await abel.to('Looms');
    await abel.page.getByRole('link', { name: loom }).click();
    await abel.page.getByRole('link', { name: /Release 1, revision 2/ }).click();
    await abel.page.getByRole('option', { selected: true }).getByText('1,234').waitFor();
    for (const person of [abel, otto]) await person.settled(); // what is asked for once it is recalled is refused, and the console says so
    await abel.button('Withdraw …').click();
    await picture(abel.page, 'a-recall-is-signed');
    await abel.answered('Sign and withdraw', { Reason: 'The weft catches at the selvedge: the toe has to be bound anew' });
    await abel.sees('Recalled: do not weave it');

    await otto.page.getByRole('alert').getByText('Recalled: do not weave it').waitFor(); // without any doing of the operator's
    await otto.sees('The weft catches at the selvedge: the toe has to be bound anew');
    assert.equal(await otto.page.getByRole('link', { name: /^Pull / }).count(), 0, 'a recalled release can be pulled');
    assert.equal(await otto.page.getByRole('option').count(), 0);
    await picture(otto.page, 'recalled');
    await accessible(otto.page, 'a recalled release');
    await otto.refused(async () => {
        const { status } = await otto.page.evaluate(path => fetch(path).then(answer => ({ status: answer.status })), pull);
        assert.equal(status, 409, 'the file of a recalled release');
    });

    await otto.link(loom).tap();
    await otto.sees('Nothing is released for this loom');
    await otto.page.getByText('No longer to be woven, or not yet').tap();
    await otto.page.getByRole('table').getByText('Withdrawn').waitFor();
    await picture(otto.page, 'the-loom-after-a-recall');
}
