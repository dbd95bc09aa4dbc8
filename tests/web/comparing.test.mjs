// Tests of the form that compares the open mesh with another one or an earlier revision.

import assert from 'node:assert/strict';
import { test } from 'node:test';

import { checkAccessible, waitForFrame } from './browser.mjs';
import { post } from './daemon.mjs';
import { expectToast } from './page.mjs';
import { openMesh } from './visit.mjs';

const CUBE = { name: 'cube', shape: 'cube' };
const SHIFT = [{ op: 'transform', matrix: [1, 0, 0, 0.25, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1] }];

const result = (page) => page.locator('#compare-result');

async function expectDistance(page, wanted) {
    const first = result(page).locator('dd').first();
    await first.waitFor();
    assert.equal(await first.textContent(), wanted);
}

test('a mesh is compared with its past and with another mesh, and the places are shown', async (t) => {
    const { daemon, mesh, page } = await openMesh(t, CUBE);
    await post(daemon, `/${mesh}/edits`, { ops: SHIFT });
    await waitForFrame(page, { mesh, revision: 2 });
    await page.getByLabel('Revision to compare with').fill('1');
    await page.getByRole('button', { name: 'Compare' }).click();
    await expectDistance(page, '0.25');
    await checkAccessible(page, 'comparison');
    const place = result(page).getByRole('button').first();
    const [, face] = (await place.textContent()).match(/^face (\d+)$/);
    await place.click();
    await page.locator(`#canvas[data-selection="face:${face}"]`).waitFor();

    const { id: same } = await post(daemon, `/${mesh}/copy`, { name: 'same' });
    await page.getByLabel('Compare with', { exact: true }).selectOption('mesh');
    await page.getByLabel('Mesh to compare with').focus();
    await page.locator(`#compare-mesh option[value="${same}"]`).waitFor({ state: 'attached' });
    assert.equal(await page.locator(`#compare-mesh option[value="${mesh}"]`).count(), 0);
    await page.getByLabel('Mesh to compare with').selectOption(same);
    await page.getByRole('button', { name: 'Compare' }).click();
    await page.waitForFunction(
        () => document.querySelector('#compare-result dd')?.textContent === '0',
    );

    await post(daemon, `/${mesh}/edits`, { ops: SHIFT });
    await waitForFrame(page, { mesh, revision: 3 });
    assert.equal(await result(page).locator('dd').count(), 0, 'an outdated comparison is removed');
});

test('a revision that does not exist is refused in words', async (t) => {
    const { page } = await openMesh(t, CUBE, { allowed: [/422/] });
    await page.getByLabel('Revision to compare with').fill('7');
    await page.getByRole('button', { name: 'Compare' }).click();
    await expectToast(page, /no revision 7 yet/);
    assert.equal(await result(page).locator('dd').count(), 0);
});
