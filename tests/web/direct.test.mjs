// Tests of the tools of the 3D view: a key or a button selects a tool, and a drag or a click uses
// it, in Chromium with the real daemon.

import assert from 'node:assert/strict';
import { test } from 'node:test';

import { checkAccessible, projector, readCanvas, waitForFrame } from './browser.mjs';
import { get, getAll } from './daemon.mjs';
import { cameraOf, goTo, isEdit, press } from './page.mjs';
import { openMesh } from './visit.mjs';

const CUBE = { name: 'cube', shape: 'cube' };
const GRID = { name: 'grid', shape: 'grid', columns: 2, rows: 2 };

// Where the drags of these tests begin. A drag moves the selected elements wherever it begins.
const START = { x: 60, y: 60 };

async function dragBy(page, x, y, during = () => {}) {
    const box = await page.locator('#canvas').boundingBox();
    const [left, top] = [box.x + START.x, box.y + START.y];
    await page.mouse.move(left, top);
    await page.mouse.down();
    await page.mouse.move(left + x / 2, top + y / 2);
    await page.mouse.move(left + x, top + y);
    await during();
    await page.mouse.up();
}

const clickView = (page) => page.locator('#canvas').click({ position: START });

async function goAndFit(page, kind, id) {
    await goTo(page, kind, id);
    await page.getByRole('button', { name: 'Fit view' }).click();
}

const expectArmed = async (page, tool, isArmed) => {
    const button = page.getByRole('button', { name: tool, exact: true });
    assert.equal(await button.getAttribute('aria-pressed'), `${isArmed}`);
};

const isPreview = ([r, g, b]) => r > 225 && g > 225 && b > 225;

const positions = async (daemon, mesh) =>
    (await getAll(daemon, mesh, 'vertices')).map(({ position }) => position);

const meanOf = (ids, places) =>
    [0, 1, 2].map((axis) => ids.reduce((sum, id) => sum + places[id][axis], 0) / ids.length);

for (const [kind, id, key] of [
    ['vertex', 6, 'vertices'],
    ['edge', 3, 'edges'],
    ['face', 1, 'faces'],
]) {
    test(`G and a drag move the ${kind} as far as the pointer, in one edit`, async (t) => {
        const { daemon, mesh, page } = await openMesh(t, CUBE);
        const element = await get(daemon, `/${mesh}/${key}/${id}`);
        const own = kind === 'vertex' ? [id] : element.vertices;
        const before = await positions(daemon, mesh);
        await goAndFit(page, kind, id);
        const place = await projector(page, daemon, mesh);
        const sent = [];
        page.on('request', (request) => isEdit(request) && sent.push(request.postDataJSON()));
        await press(page, 'g');
        await expectArmed(page, 'Move', true);
        const camera = await cameraOf(page);
        await dragBy(page, 40, -25);
        await waitForFrame(page, { revision: 2 });
        assert.equal(sent.length, 1);
        assert.equal(sent[0].ops[0].op, 'vertex_move');
        await expectArmed(page, 'Move', false);
        assert.ok(camera !== undefined);
        assert.equal(await cameraOf(page), camera);
        const after = await positions(daemon, mesh);
        after.forEach((place, i) => {
            const by = place.map((value, axis) => value - before[i][axis]);
            const wanted = own.includes(i) ? sent[0].ops[0].by : [0, 0, 0];
            by.forEach((value, axis) => assert.ok(Math.abs(value - wanted[axis]) < 1e-9));
        });
        const [from, to] = [before, after].map((all) => place.atPlace(meanOf(own, all)));
        const moved = [to.x - from.x, to.y - from.y];
        assert.ok(Math.hypot(moved[0] - 40, moved[1] + 25) < 0.5, `${moved}`);
    });
}

test('a drag shows what it will do, Esc gives it up', async (t) => {
    const { daemon, mesh, page } = await openMesh(t, CUBE);
    await goAndFit(page, 'face', 1);
    await press(page, 'e');
    await checkAccessible(page, 'armed');
    const before = (await readCanvas(page)).countOf(isPreview);
    await dragBy(page, 0, -80, async () => {
        await page.locator('#direct-amount').filter({ hasText: /^by -?\d/ }).waitFor();
        await page.evaluate(() => new Promise((resolve) => requestAnimationFrame(() =>
            requestAnimationFrame(resolve))));
        assert.ok((await readCanvas(page)).countOf(isPreview) > before + 50);
        await checkAccessible(page, 'dragging');
        await page.keyboard.press('Escape');
    });
    await expectArmed(page, 'Extrude', false);
    assert.ok(await page.locator('#direct-note').isHidden());
    await waitForFrame(page, { revision: 1, selection: 'face:1' });
    assert.equal((await get(daemon, `/${mesh}`)).revision, 1);
    await press(page, 'Escape');
    await waitForFrame(page, { selection: '' });
});

test('E extrudes a face along its normal by a drag, or a little by a click', async (t) => {
    const { daemon, mesh, page } = await openMesh(t, CUBE);
    const faces = await getAll(daemon, mesh, 'faces');
    const before = await positions(daemon, mesh);
    const top = faces.find(({ vertices }) => vertices.every((v) => before[v][2] > 0));
    await goAndFit(page, 'face', top.id);
    await press(page, 'e');
    await dragBy(page, 0, -60);
    await waitForFrame(page, { revision: 2 });
    const { counts } = await get(daemon, `/${mesh}`);
    assert.deepEqual([counts.vertices, counts.edges, counts.faces], [12, 20, 10]);
    const heightOf = async () => {
        const { vertices } = await get(daemon, `/${mesh}/faces/${top.id}`);
        const places = await positions(daemon, mesh);
        return places[vertices[0]][2];
    };
    const first = await heightOf();
    assert.ok(first > before[top.vertices[0]][2] + 0.01, `${first}`);
    await waitForFrame(page, { selection: `face:${top.id}` });
    await press(page, 'e');
    await clickView(page);
    await waitForFrame(page, { revision: 3 });
    assert.ok((await heightOf()) > first + 0.01);
    assert.equal((await get(daemon, `/${mesh}`)).counts.faces, 14);
});

test('E draws a boundary edge out', async (t) => {
    const { daemon, mesh, page } = await openMesh(t, GRID);
    const { id } = (await getAll(daemon, mesh, 'edges')).find((edge) => edge.boundary);
    await goAndFit(page, 'edge', id);
    await press(page, 'e');
    await dragBy(page, 30, 40);
    await waitForFrame(page, { revision: 2 });
    const { counts } = await get(daemon, `/${mesh}`);
    assert.deepEqual([counts.vertices, counts.faces], [11, 5]);
});

test('I insets a face by a drag, S splits, X removes', async (t) => {
    const { daemon, mesh, page } = await openMesh(t, CUBE);
    await goAndFit(page, 'face', 1);
    await press(page, 'i');
    const sent = page.waitForRequest(isEdit);
    await dragBy(page, 50, 0);
    const { ops: [inset] } = (await sent).postDataJSON();
    assert.equal(inset.op, 'face_inset');
    assert.ok(inset.factor > 0.05 && inset.factor < 0.95, `${inset.factor}`);
    await waitForFrame(page, { revision: 2 });
    assert.equal((await get(daemon, `/${mesh}`)).counts.faces, 10);
    await press(page, 's');
    await waitForFrame(page, { revision: 3 });
    assert.equal((await get(daemon, `/${mesh}`)).counts.faces, 13);
    await goTo(page, 'edge', 0);
    await press(page, 's');
    await waitForFrame(page, { revision: 4 });
    const { counts } = await get(daemon, `/${mesh}`);
    await press(page, 'x');
    await waitForFrame(page, { revision: 5 });
    assert.equal((await get(daemon, `/${mesh}`)).counts.vertices, counts.vertices - 1);
});

test('a tool that fits nothing selected shows its form, a button arms as a key does', async (t) => {
    const { daemon, mesh, page } = await openMesh(t, CUBE);
    await press(page, 'i');
    assert.equal(await page.locator('#operation').inputValue(), 'face_inset');
    await expectArmed(page, 'Inset', false);
    await goAndFit(page, 'face', 1);
    await page.getByRole('button', { name: 'Inset', exact: true }).click();
    await expectArmed(page, 'Inset', true);
    await page.getByRole('button', { name: 'Inset', exact: true }).click();
    await expectArmed(page, 'Inset', false);
    await page.getByRole('button', { name: 'Move', exact: true }).click();
    // A click without a drag must move nothing.
    await clickView(page);
    await expectArmed(page, 'Move', false);
    await waitForFrame(page, { revision: 1, selection: 'face:1' });
    assert.equal((await get(daemon, `/${mesh}`)).revision, 1);
});

test('a number typed after a tool was selected by its key is the exact amount', async (t) => {
    const { daemon, mesh, page } = await openMesh(t, CUBE);
    await goAndFit(page, 'face', 1);
    const mode = () => page.locator('input[name="pick"]:checked').getAttribute('value');
    const send = async (keys) => {
        const sent = page.waitForRequest(isEdit);
        await page.locator('#canvas').focus();
        for (const key of keys) {
            await page.keyboard.press(key);
        }
        return (await sent).postDataJSON().ops;
    };
    assert.deepEqual(await send(['e', '0', '.', '3', 'Enter']), [
        { op: 'face_extrude', face: 1, distance: 0.3, region: false },
    ]);
    await waitForFrame(page, { revision: 2, selection: 'face:1' });
    assert.equal(await mode(), 'face');
    assert.deepEqual(await send(['i', '.', '2', '5', 'Enter']), [
        { op: 'face_inset', face: 1, factor: 0.25, region: false },
    ]);
    await waitForFrame(page, { revision: 3 });
    // A digit that follows no tool still is the key of a pick mode.
    await press(page, '1');
    assert.equal(await mode(), 'vertex');
    await goTo(page, 'vertex', 0);
    const { position } = await get(daemon, `/${mesh}/vertices/0`);
    const by = ['-', '1', 'Tab', '0', 'Tab', '2', 'Enter'];
    assert.deepEqual(await send(['g', ...by]), [{ op: 'vertex_move', vertex: 0, by: [-1, 0, 2] }]);
    await waitForFrame(page, { revision: 4 });
    assert.deepEqual((await get(daemon, `/${mesh}/vertices/0`)).position, [
        position[0] - 1,
        position[1],
        position[2] + 2,
    ]);
    assert.equal(await mode(), 'vertex');
});

test('what is selected is collapsed or deleted by a button too', async (t) => {
    const { daemon, mesh, page } = await openMesh(t, GRID);
    const inner = (await getAll(daemon, mesh, 'edges')).find((edge) => !edge.boundary);
    assert.ok(await page.getByRole('button', { name: 'Delete', exact: true }).isDisabled());
    await goTo(page, 'face', 0);
    await page.getByRole('button', { name: 'Delete', exact: true }).click();
    await waitForFrame(page, { revision: 2 });
    assert.equal((await get(daemon, `/${mesh}`)).counts.faces, 3);
    await page.getByRole('button', { name: 'Undo', exact: true }).click();
    await waitForFrame(page, { revision: 3 });
    await goTo(page, 'edge', inner.id);
    await page.getByRole('button', { name: 'Collapse', exact: true }).click();
    await waitForFrame(page, { revision: 4 });
    assert.equal((await get(daemon, `/${mesh}`)).counts.vertices, 8);
});

test('a finger drags with a tool that is armed', async (t) => {
    const { daemon, mesh, page } = await openMesh(t, CUBE, { hasTouch: true });
    await goAndFit(page, 'vertex', 6);
    await page.getByRole('button', { name: 'Move', exact: true }).tap();
    const box = await page.locator('#canvas').boundingBox();
    const session = await page.context().newCDPSession(page);
    const touch = (type, points) =>
        session.send('Input.dispatchTouchEvent', { type, touchPoints: points });
    const [x, y] = [box.x + 80, box.y + 80];
    await touch('touchStart', [{ x, y }]);
    await touch('touchMove', [{ x: x + 30, y: y + 10 }]);
    await touch('touchMove', [{ x: x + 60, y: y + 20 }]);
    await touch('touchEnd', []);
    await waitForFrame(page, { revision: 2, selection: 'vertex:6' });
    const { ops } = (await get(daemon, `/${mesh}/edits?limit=1`)).entries[0];
    assert.deepEqual(ops, ['vertex_move']);
});
