// Tests that the page shows a failed request in a message, and keeps showing what it did before.

import assert from 'node:assert/strict';
import { test } from 'node:test';

import { checkAccessible, isSurface, readCanvas, waitForFrame } from './browser.mjs';
import { get, getGeometry, post, startDaemon } from './daemon.mjs';
import { chooseOperation, expectToast, goTo, press } from './page.mjs';
import { openMesh, openPage } from './visit.mjs';

const CUBE = { name: 'cube', shape: 'cube' };

const closeToast = (page) => page.getByRole('button', { name: 'Close message' }).click();

// Answers to an edit from a server that refuses it, or from a gateway in front of the server.
const REFUSALS = [
    [409, { title: 'Mesh busy', detail: 'a long operation is running on it' }],
    [412, { title: 'Stale', detail: 'the mesh is at revision 9' }],
    [413, { title: 'Too large', detail: 'the body has 9 bytes more than are allowed' }],
    [422, { title: 'Refused', detail: 'face 3 has two corners', pointer: '/ops/0/face' }],
    [429, { title: 'Too many requests', detail: 'try again in a second' }],
    [500, { title: 'Internal error', detail: 'an invariant does not hold' }],
    [503, { title: 'Not now', detail: 'the memory budget is used up' }],
    [507, { title: 'Full', detail: 'no more ids' }],
];

test('each refusal of an edit is said in its own words', async (t) => {
    const context = await openMesh(t, CUBE, { allowed: [/status of [45]\d\d/] });
    const { daemon, mesh, page } = context;
    await goTo(page, 'face', 0);
    for (const [status, problem] of REFUSALS) {
        await page.route('**/edits', (route) => {
            const body = JSON.stringify({ status, code: 'x', ...problem });
            return route.fulfill({ status, contentType: 'application/problem+json', body });
        });
        await page.getByRole('button', { name: 'Split' }).click();
        await expectToast(page, problem.detail);
        const text = await page.getByRole('alert').textContent();
        assert.ok(text.startsWith(problem.title), text);
        assert.equal(text.includes('(at /face)'), status === 422, text);
        await page.unroute('**/edits');
        await closeToast(page);
    }
    // The answer of a gateway is not JSON, which the page must expect.
    await page.route('**/edits', (route) => route.fulfill({ status: 502, body: '<h1>Bad</h1>' }));
    await page.getByRole('button', { name: 'Split' }).click();
    await expectToast(page, /status 502/);
    await page.unroute('**/edits');
    await closeToast(page);
    // None of the failed requests has changed the mesh, and the page must still work.
    assert.equal((await get(daemon, `/${mesh}`)).revision, 1);
    assert.ok((await readCanvas(page)).countOf(isSurface) > 1000);
    await page.getByRole('button', { name: 'Split' }).click();
    await waitForFrame(page, { revision: 2 });
});

test('no more than a few messages stand at once', async (t) => {
    const { page } = await openMesh(t, CUBE, { allowed: [/status of 404/] });
    for (let i = 0; i < 6; i++) {
        await page.locator('#goto-id').fill(`90${i}`);
        await page.getByRole('button', { name: 'Go', exact: true }).click();
        await page.getByRole('alert').filter({ hasText: `90${i}` }).waitFor();
    }
    const texts = await page.getByRole('alert').allTextContents();
    assert.equal(texts.length, 4);
    assert.ok(texts[0].includes('905') && texts[3].includes('902'), `${texts}`);
    await checkAccessible(page, 'several messages');
});

test('geometry that breaks off or is none is said, not drawn', async (t) => {
    const daemon = await startDaemon(t);
    const { id: mesh } = await post(daemon, '', CUBE);
    const { id: other } = await post(daemon, '', { name: 'other', shape: 'torus' });
    const page = await openPage(t, daemon, { path: `/#mesh=${mesh}` });
    await waitForFrame(page, { mesh, revision: 1 });
    const whole = Buffer.from(await getGeometry(daemon, other));
    const wrong = Buffer.from(whole);
    wrong.writeUInt32LE(99, 4);
    for (const [body, text] of [
        [whole.subarray(0, 50), /did not arrive completely/],
        [whole.subarray(0, whole.length - 4), /did not arrive completely/],
        [Buffer.concat([whole, Buffer.alloc(4)]), /longer than its header says/],
        [wrong, /cannot read the geometry/],
    ]) {
        await page.route(`**/${other}/geometry`, (route) => route.fulfill({ body }));
        await page.locator(`#meshes button[data-mesh="${other}"]`).click();
        await expectToast(page, text);
        await page.unroute(`**/${other}/geometry`);
        await closeToast(page);
        await waitForFrame(page, { mesh, revision: 1 });
    }
    assert.ok((await readCanvas(page)).countOf(isSurface) > 1000);
    await page.locator(`#meshes button[data-mesh="${other}"]`).click();
    await waitForFrame(page, { mesh: other, revision: 1 });
});

test('a mesh that changes each time it is read is shown, and what changed put in', async (t) => {
    const daemon = await startDaemon(t);
    const { id: mesh } = await post(daemon, '', CUBE);
    const { id: other } = await post(daemon, '', { name: 'other', shape: 'torus' });
    const page = await openPage(t, daemon, { path: `/#mesh=${mesh}` });
    await waitForFrame(page, { mesh, revision: 1 });
    const poke = { op: 'vertex_move', vertex: 0, by: [0, 0, 0.01] };
    let reads = 0;
    await page.route(`**/${other}/geometry*`, async (route) => {
        const answer = await route.fetch();
        if (++reads < 8) {
            await post(daemon, `/${other}/edits`, poke);
        }
        await route.fulfill({ response: answer });
    });
    await page.locator(`#meshes button[data-mesh="${other}"]`).click();
    await waitForFrame(page, { mesh: other, revision: 8 });
    assert.equal(await page.locator('[data-statistic="revision"]').textContent(), '8');
    assert.ok(reads < 12, `${reads}`);
    assert.equal(await page.getByRole('alert').count(), 0);
});

test('a mesh that is on its way shows how far it is', async (t) => {
    const { daemon, page } = await openMesh(t, CUBE);
    const { id: mesh } = await post(daemon, '', { name: 'other', shape: 'torus' });
    let release;
    const held = new Promise((resolve) => {
        release = resolve;
    });
    await page.route(`**/meshes/${mesh}`, async (route) => {
        await held;
        await route.continue();
    });
    await page.getByRole('button', { name: 'Refresh' }).click();
    await page.locator(`#meshes button[data-mesh="${mesh}"]`).click();
    await page.getByText('Reading the mesh').waitFor();
    const value = () => page.locator('#load-progress').evaluate((bar) => bar.value);
    assert.equal(await value(), 1);
    await checkAccessible(page, 'reading');
    release();
    await waitForFrame(page, { mesh, revision: 1 });
    assert.ok(await page.getByText('Reading the mesh').isHidden());
});

test('a daemon that stops while one works leaves the view and says so', async (t) => {
    // A request that is on its way when the daemon stops is reset.
    const context = await openMesh(t, CUBE, { allowed: [/ERR_CONNECTION_(REFUSED|RESET)/] });
    const { daemon, page } = context;
    await goTo(page, 'face', 3);
    await daemon.stop();
    for (const act of [
        () => page.getByRole('button', { name: 'Split' }).click(),
        () => press(page, 'x'),
        () => page.locator('[data-ring="faces"] button').first().click(),
        () =>
            page.locator('#file').setInputFiles({
                name: 'a.off',
                mimeType: '',
                buffer: Buffer.from('OFF\n0 0 0\n'),
            }),
    ]) {
        await act();
        await expectToast(page, /cannot be reached/);
        await closeToast(page);
    }
    await waitForFrame(page, { selection: 'face:3' });
    assert.ok((await readCanvas(page)).countOf(isSurface) > 1000);
});
