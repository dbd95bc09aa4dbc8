// Tests of what the page does with whole meshes: renaming, duplicating and deleting them, in the
// list and at the open mesh.

import assert from 'node:assert/strict';
import { test } from 'node:test';

import { copyNameOf } from '../../web/src/meshes/acts.js';
import { checkAccessible, waitForFrame, waitForTold } from './browser.mjs';
import { get, post, startDaemon } from './daemon.mjs';
import { expectToast } from './page.mjs';
import { openMesh, openPage } from './visit.mjs';

const CUBE = { name: 'cube', shape: 'cube' };
const BALL = { name: 'ball', shape: 'icosphere' };
const WIDTHS = [360, 800, 1440];

const more = (page) => page.getByRole('button', { name: 'More actions' });
const rowMenu = (page, name) => page.getByRole('button', { name: `Actions for ${name}`, exact: true });
const item = (page, name) => page.getByRole('menuitem', { name, exact: true });
const undo = (page) => page.locator('.toast').getByRole('button', { name: 'Undo' });

async function act(page, button, name) {
    await button.click();
    await item(page, name).click();
}

const namesOf = async (daemon) => (await get(daemon, '')).items.map(({ name }) => name).sort();

// Waits until a request of the page to delete a mesh was answered.
function waitForDelete(page) {
    return page.waitForResponse((answer) => answer.request().method() === 'DELETE');
}

// Opens the page with a clock that the test turns. Returns the methods of the requests to delete
// that the page has sent, too.
async function openWithClock(t, document, options = {}) {
    const daemon = await startDaemon(t);
    const { id: mesh } = await post(daemon, '', document);
    const page = await openPage(t, daemon, options);
    await page.clock.install();
    await page.reload();
    await waitForFrame(page, { mesh, revision: 1 });
    const deletes = [];
    page.on('request', (request) => {
        if (request.method() === 'DELETE') {
            deletes.push(request);
        }
    });
    return { daemon, mesh, page, deletes };
}

test('a copy has a name of its own', () => {
    assert.equal(copyNameOf('cube', ['cube']), 'cube copy');
    assert.equal(copyNameOf('cube', ['cube', 'cube copy']), 'cube copy 2');
    assert.equal(copyNameOf('cube copy', ['cube', 'cube copy', 'cube copy 2']), 'cube copy 3');
});

test('the open mesh is renamed, and its name is changed everywhere', async (t) => {
    const { daemon, mesh, page } = await openMesh(t, CUBE);
    await act(page, more(page), 'Rename');
    const field = page.getByRole('dialog').getByLabel('Name');
    assert.equal(await field.inputValue(), 'cube');
    await checkAccessible(page, 'rename');
    await page.keyboard.type('<b>die</b>'); // the old name is selected, so that typing replaces it
    await page.keyboard.press('Enter');
    await page.getByRole('dialog').waitFor({ state: 'detached' });
    await page.locator('#mesh-title').filter({ hasText: '<b>die</b>' }).waitFor();
    await page.locator('.mesh-name').filter({ hasText: '<b>die</b>' }).waitFor();
    assert.equal((await get(daemon, `/${mesh}`)).name, '<b>die</b>');
    assert.equal((await get(daemon, `/${mesh}`)).revision, 1);
});

test('another mesh of the list is renamed, and may lose its name', async (t) => {
    const { daemon, mesh, page } = await openMesh(t, CUBE);
    const { id: ball } = await post(daemon, '', BALL);
    await page.getByRole('button', { name: 'Refresh' }).click();
    await act(page, rowMenu(page, 'ball'), 'Rename');
    await page.getByRole('dialog').getByLabel('Name').fill('');
    await page.getByRole('dialog').getByRole('button', { name: 'Rename' }).click();
    await rowMenu(page, ball).waitFor();
    assert.equal((await get(daemon, `/${ball}`)).name, '');
    assert.equal(await page.locator('#mesh-title').textContent(), 'cube');
    await waitForFrame(page, { mesh, revision: 1 });
});

test('a name that is refused can be corrected in the dialog', async (t) => {
    const { daemon, mesh, page } = await openMesh(t, CUBE, { allowed: [/status of 4\d\d/] });
    await act(page, more(page), 'Rename');
    const field = page.getByRole('dialog').getByLabel('Name');
    await field.fill('x'.repeat(300));
    await page.keyboard.press('Enter');
    await page.getByRole('dialog').getByRole('alert').filter({ hasText: /256|long/ }).waitFor();
    assert.equal(await field.getAttribute('aria-invalid'), 'true');
    await checkAccessible(page, 'rename refused');
    await field.fill('short');
    await page.keyboard.press('Enter');
    await page.getByRole('dialog').waitFor({ state: 'detached' });
    assert.equal((await get(daemon, `/${mesh}`)).name, 'short');
});

test('a mesh is duplicated, and the copy is opened', async (t) => {
    const { daemon, mesh, page } = await openMesh(t, CUBE);
    await post(daemon, `/${mesh}/edits`, { op: 'face_poke', face: 0 });
    await waitForFrame(page, { mesh, revision: 2 });
    await act(page, more(page), 'Duplicate');
    await waitForTold(page, /Duplicated.*copy of cube/);
    assert.deepEqual(await namesOf(daemon), ['cube', 'cube copy']);
    const copy = (await get(daemon, '')).items.find(({ name }) => name === 'cube copy');
    await waitForFrame(page, { mesh: copy.id, revision: 1 });
    assert.equal(copy.counts.faces, 9);
    // The list shows both, and the copy of the first mesh gets another name.
    await act(page, rowMenu(page, 'cube'), 'Duplicate');
    await page.locator('#mesh-title').filter({ hasText: 'cube copy 2' }).waitFor();
    assert.equal(await page.locator('#meshes li').count(), 3);
});

test('a mesh is deleted after ten seconds, and not before', async (t) => {
    const { daemon, mesh, page, deletes } = await openWithClock(t, CUBE);
    const { id: ball } = await post(daemon, '', BALL);
    await page.getByRole('button', { name: 'Refresh' }).click();
    await page.clock.pauseAt(new Date(Date.now() + 1e6));
    await act(page, more(page), 'Delete');
    const toast = page.locator('.toast').filter({ hasText: 'Deleting cube' });
    await toast.filter({ hasText: 'Deleted in 10 s' }).waitFor();
    assert.equal(await page.locator('.leaving').count(), 1);
    await page.clock.runFor(3000);
    await toast.filter({ hasText: 'Deleted in 7 s' }).waitFor();
    await page.clock.runFor(6900);
    await toast.filter({ hasText: 'Deleted in 1 s' }).waitFor();
    assert.equal(deletes.length, 0);
    assert.deepEqual(await namesOf(daemon), ['ball', 'cube']);
    const answer = waitForDelete(page);
    await page.clock.runFor(200);
    assert.equal((await answer).status(), 204);
    assert.match(deletes[0].headers()['if-match'], /^"[^"*]+"$/);
    assert.deepEqual(await namesOf(daemon), ['ball']);
    // The mesh was open, so the page opens the one beside it.
    await page.clock.resume();
    await waitForFrame(page, { mesh: ball, revision: 1 });
    assert.equal(await page.locator(`#meshes [data-mesh="${mesh}"]`).count(), 0);
});

test('the message with the way back is accessible', async (t) => {
    const { page } = await openWithClock(t, CUBE);
    await page.clock.pauseAt(new Date(Date.now() + 1e6));
    await act(page, more(page), 'Delete');
    await undo(page).waitFor();
    // axe waits by the page's clock, which is turned a little for it.
    let isDone = false;
    const checked = checkAccessible(page, 'deleting').finally(() => {
        isDone = true;
    });
    while (!isDone) {
        await page.clock.runFor(1);
    }
    await checked;
    await undo(page).click();
    await undo(page).waitFor({ state: 'detached' });
});

test('a deletion is undone from the toast or the menu, by keyboard too', async (t) => {
    const { daemon, page, deletes } = await openWithClock(t, CUBE);
    await page.clock.pauseAt(new Date(Date.now() + 1e6));
    await more(page).focus();
    await page.keyboard.press('Enter');
    await page.keyboard.press('End');
    await page.keyboard.press('Enter');
    await undo(page).waitFor();
    // The button has the focus, so that there is time to press it.
    await page.waitForFunction(() => document.activeElement.textContent === 'Undo');
    await page.clock.runFor(9000);
    await page.keyboard.press('Enter');
    await undo(page).waitFor({ state: 'detached' });
    assert.equal(await page.evaluate(() => document.activeElement.id), 'mesh-menu');
    assert.equal(await page.locator('.leaving').count(), 0);
    await page.clock.runFor(60000);
    await act(page, rowMenu(page, 'cube'), 'Delete');
    await undo(page).waitFor();
    await act(page, rowMenu(page, 'cube'), 'Do not delete');
    await undo(page).waitFor({ state: 'detached' });
    await page.clock.runFor(60000);
    assert.equal(deletes.length, 0);
    assert.deepEqual(await namesOf(daemon), ['cube']);
});

test('who leaves the page meanwhile deletes nothing', async (t) => {
    const { daemon, mesh, page, deletes } = await openWithClock(t, CUBE);
    await act(page, more(page), 'Delete');
    await undo(page).waitFor();
    await page.getByRole('link', { name: 'Manual' }).click();
    await page.waitForURL(/docs/);
    await page.goBack();
    await waitForFrame(page, { mesh, revision: 1 });
    await page.clock.fastForward(60000);
    await page.clock.runFor(60000);
    assert.equal(await undo(page).count(), 0);
    assert.equal(deletes.length, 0);
    assert.deepEqual(await namesOf(daemon), ['cube']);
});

test('a mesh that another client changes meanwhile is not deleted', async (t) => {
    const { daemon, mesh, page } = await openWithClock(t, CUBE, { allowed: [/status of 412/] });
    await page.clock.pauseAt(new Date(Date.now() + 1e6));
    await act(page, more(page), 'Delete');
    await undo(page).waitFor();
    await post(daemon, `/${mesh}/edits`, { op: 'face_poke', face: 0 });
    const answer = waitForDelete(page);
    await page.clock.runFor(10000);
    assert.equal((await answer).status(), 412);
    await expectToast(page, /cube was not deleted.*Another client changed it/);
    assert.equal(await page.locator('.leaving').count(), 0);
    assert.deepEqual(await namesOf(daemon), ['cube']);
});

test('several meshes wait at once, each with a way back', async (t) => {
    const { daemon, page } = await openWithClock(t, CUBE);
    for (let i = 0; i < 6; i++) {
        await post(daemon, '', { ...BALL, name: `ball ${i}` });
    }
    await page.getByRole('button', { name: 'Refresh' }).click();
    await page.clock.pauseAt(new Date(Date.now() + 1e6));
    for (let i = 0; i < 6; i++) {
        await act(page, rowMenu(page, `ball ${i}`), 'Delete');
        await page.locator('.toast').nth(i).waitFor();
    }
    await page.locator('.toast').filter({ hasText: 'ball 3' }).getByRole('button').click();
    const answers = [0, 1, 2, 4, 5].map((i) => `ball ${i}`);
    let count = 0;
    const all = page.waitForResponse((answer) => {
        count += answer.request().method() === 'DELETE' ? 1 : 0;
        return count === answers.length;
    });
    await page.clock.runFor(10000);
    await all;
    assert.deepEqual(await namesOf(daemon), ['ball 3', 'cube']);
});

test('menus are operated by keyboard, and fit at each width', async (t) => {
    for (const width of WIDTHS) {
        const { page } = await openMesh(t, CUBE, { viewport: { width, height: 740 } });
        for (const button of [more(page), rowMenu(page, 'cube')]) {
            await button.focus();
            await page.keyboard.press('Enter');
            assert.equal(await button.getAttribute('aria-expanded'), 'true');
            const focused = () => page.evaluate(() => document.activeElement.textContent);
            assert.equal(await focused(), 'Rename');
            await page.keyboard.press('ArrowDown');
            assert.equal(await focused(), 'Duplicate');
            await page.keyboard.press('ArrowUp');
            await page.keyboard.press('ArrowUp');
            assert.equal(await focused(), 'Delete');
            const box = await page.getByRole('menu').boundingBox();
            assert.ok(box.x >= 0 && box.x + box.width <= width && box.y + box.height <= 740);
            await checkAccessible(page, `menu at ${width}`);
            await page.keyboard.press('Escape');
            await page.getByRole('menu').waitFor({ state: 'hidden' });
            assert.equal(await button.getAttribute('aria-expanded'), 'false');
            assert.ok(await button.evaluate((one) => one === document.activeElement));
        }
        const wide = await page.evaluate(() => document.documentElement.scrollWidth);
        assert.ok(wide <= width, `${wide} px at ${width}`);
    }
});
