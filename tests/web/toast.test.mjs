// Tests of messages: what they collect, when they go away, and what they never cover.

import assert from 'node:assert/strict';
import { test } from 'node:test';

import { checkAccessible, waitForFrame } from './browser.mjs';
import { post, startDaemon } from './daemon.mjs';
import { chooseOperation, expectToast, goTo, press } from './page.mjs';
import { openMesh, openPage } from './visit.mjs';

const CUBE = { name: 'cube', shape: 'cube' };
const TETRAHEDRON = { name: 'tetrahedron', shape: 'tetrahedron' };

const alerts = (page) => page.locator('#toasts').getByRole('alert');

// Makes the page show an error with this text.
async function failWith(page, word) {
    await page.evaluate((text) => {
        window.dispatchEvent(new ErrorEvent('error', { error: new Error(text) }));
    }, word);
}

test('a message that is repeated is shown once, with a count', async (t) => {
    const { page } = await openMesh(t, CUBE);
    await failWith(page, 'first');
    await failWith(page, 'second');
    for (let i = 0; i < 3; i++) {
        await failWith(page, 'first');
    }
    const texts = await alerts(page).allTextContents();
    assert.equal(texts.length, 2);
    assert.match(texts[0], /4 times.*first/);
    assert.match(texts[1], /second/);
    assert.ok(!texts[1].includes('times'), texts[1]);
});

test('earlier messages are collected, and all are closed by one button', async (t) => {
    const { page } = await openMesh(t, CUBE);
    const region = page.getByRole('region', { name: 'Messages' });
    for (let i = 0; i < 6; i++) {
        await failWith(page, `word${i}`);
    }
    assert.equal(await alerts(page).count(), 4);
    await region.getByRole('button', { name: '2 earlier' }).click();
    assert.equal(await alerts(page).count(), 6);
    assert.match((await alerts(page).allTextContents())[5], /word0/);
    await checkAccessible(page, 'all messages', '#toasts');
    // Esc closes the message that has the focus, and the next one gets it.
    await alerts(page).first().getByRole('button', { name: 'Close message' }).focus();
    await page.keyboard.press('Escape');
    await page.keyboard.press('Escape');
    assert.equal(await alerts(page).count(), 4);
    assert.match((await alerts(page).allTextContents())[0], /word3/);
    await region.getByRole('button', { name: 'Close all' }).click();
    assert.equal(await alerts(page).count(), 0);
    assert.ok(await region.getByRole('button', { name: 'Close all' }).isHidden());
});

test('a message about a mesh goes away with it, and one about a file stays', async (t) => {
    const { daemon, mesh, page } = await openMesh(t, TETRAHEDRON, { allowed: [/status of 4\d\d/] });
    const { id: other } = await post(daemon, '', CUBE);
    await page.getByRole('button', { name: 'Refresh' }).click();
    await page.locator('#file').setInputFiles({
        name: 'broken.obj',
        mimeType: '',
        buffer: Buffer.from('v 0 0 0\nv 1 zero 0\n'),
    });
    await expectToast(page, /line 2/);
    await chooseOperation(page, 'edge_collapse');
    await page.locator('#param-edge').fill('99');
    await page.getByRole('button', { name: 'Apply' }).click();
    await expectToast(page, /no edge 99/);
    await page.locator(`#meshes button[data-mesh="${other}"]`).click();
    await waitForFrame(page, { mesh: other, revision: 1 });
    assert.equal(await alerts(page).filter({ hasText: 'no edge 99' }).count(), 0);
    await expectToast(page, /line 2/);
    await page.locator(`#meshes button[data-mesh="${mesh}"]`).click();
    await waitForFrame(page, { mesh, revision: 1 });
    assert.equal(await alerts(page).count(), 1);
});

test('the element that a refusal names is a click away', async (t) => {
    const { mesh, page } = await openMesh(t, CUBE, { allowed: [/status of 4\d\d/] });
    await goTo(page, 'edge', 1);
    await chooseOperation(page, 'edge_flip');
    await page.getByRole('button', { name: 'Apply' }).click();
    const show = alerts(page).getByRole('button', { name: /^Show (vertex|edge|face|half-edge) \d+$/ });
    const [, kind, id] = /^Show (\S+) (\d+)$/.exec(await show.textContent());
    await show.click();
    await waitForFrame(page, { mesh, selection: `${kind.replace('-', '')}:${id}` });
});

test('a message of success goes away, but not while the focus is on one', async (t) => {
    const daemon = await startDaemon(t);
    const { id: mesh } = await post(daemon, '', CUBE);
    const page = await openPage(t, daemon);
    await page.clock.install();
    await page.reload();
    await waitForFrame(page, { mesh, revision: 1 });
    await chooseOperation(page, 'triangulate');
    await page.getByRole('button', { name: 'Apply' }).click();
    await waitForFrame(page, { mesh, revision: 2 });
    const toast = page.locator('.toast.well');
    await toast.waitFor();
    await toast.getByRole('button', { name: 'Close message' }).focus();
    await page.clock.fastForward(60_000);
    assert.equal(await toast.count(), 1);
    await page.locator('#canvas').focus();
    await page.clock.fastForward(60_000);
    await toast.waitFor({ state: 'detached' });
});

for (const viewport of [{ width: 1280, height: 700 }, { width: 360, height: 740 }]) {
    test(`messages cover no hint in a window ${viewport.width} wide`, async (t) => {
        const { page } = await openMesh(t, CUBE, { viewport });
        for (let i = 0; i < 4; i++) {
            await failWith(page, `word${i}`);
        }
        await goTo(page, 'face', 0);
        await press(page, 'g');
        await page.locator('#direct-hint').filter({ hasText: /\S/ }).waitFor();
        await page.locator('.stage').scrollIntoViewIfNeeded();
        const note = await page.locator('#direct-note').boundingBox();
        const toasts = await alerts(page).all();
        assert.equal(toasts.length, 4);
        for (const toast of toasts) {
            const box = await toast.boundingBox();
            assert.ok(
                box.y + box.height <= note.y || box.y >= note.y + note.height,
                `${JSON.stringify(box)} covers ${JSON.stringify(note)}`,
            );
            assert.ok(box.x >= 0 && box.x + box.width <= viewport.width, JSON.stringify(box));
        }
        await checkAccessible(page, 'messages and a hint');
    });
}
