// Tests of the gizmo: its handles move, rotate and scale the selection in one edit, and so do its
// numbers, in Chromium with the real daemon.

import assert from 'node:assert/strict';
import { test } from 'node:test';

import { compose } from '../../web/src/kit/affine.js';
import { FIELD_OF_VIEW } from '../../web/src/geometry/view.js';
import { pull } from '../../web/src/gizmo/pull.js';
import { checkAccessible, projector, readCanvas, waitForFrame } from './browser.mjs';
import { get, getAll, post } from './daemon.mjs';
import { goTo, isEdit, press } from './page.mjs';
import { openMesh } from './visit.mjs';

const CUBE = { name: 'cube', shape: 'cube' };

// A camera at y = -10 that looks along y, at a canvas of 800 x 600 pixels. At distance 10 the middle of
// the canvas is the origin.
const VIEW = {
    right: [1, 0, 0],
    up: [0, 0, 1],
    back: [0, -1, 0],
    position: [0, -10, 0],
    width: 800,
    height: 600,
};
const PIXEL = (20 * Math.tan((FIELD_OF_VIEW * Math.PI) / 360)) / 600;

const isNear = (a, b, what) => assert.ok(Math.abs(a - b) < 1e-9 * Math.max(1, Math.abs(b)), `${what}: ${a}, not ${b}`);

test('an arrow moves as far as the pointer, along its axis only', () => {
    const drag = (axis, to) =>
        pull({ kind: 'arrow', axis }, { place: [0, 0, 0], from: [420, 300], to, view: VIEW, isSnapped: false });
    const { move, rotate, scale } = drag(0, [520, 300]);
    isNear(move[0], 100 * PIXEL, 'x');
    // Beside the axis, the nearest point of the axis counts.
    assert.ok(Math.abs(drag(0, [520, 250]).move[0] / move[0] - 1) < 0.01);
    assert.deepEqual([move[1], move[2], rotate, scale], [0, 0, [0, 0, 0], [1, 1, 1]]);
    const up = { place: [0, 0, 0], from: [400, 280], to: [400, 180], view: VIEW, isSnapped: false };
    isNear(pull({ kind: 'arrow', axis: 2 }, up).move[2], 100 * PIXEL, 'z');
});

test('a box scales by the way from the middle, a ring turns around it, and Ctrl snaps', () => {
    const drag = (handle, from, to, isSnapped = false) =>
        pull(handle, { place: [0, 0, 0], from, to, view: VIEW, isSnapped });
    isNear(drag({ kind: 'box', axis: 0 }, [450, 300], [550, 300]).scale[0], 3, 'factor');
    isNear(drag({ kind: 'box', axis: 0 }, [450, 300], [479, 300], true).scale[0], 1.6, 'snapped factor');
    // The y axis points away from the viewer, so that a turn from x to z, which is counter-clockwise on
    // the screen, is a negative turn around y.
    isNear(drag({ kind: 'ring', axis: 1 }, [500, 300], [400, 200]).rotate[1], -90, 'angle');
    isNear(drag({ kind: 'ring', axis: 1 }, [500, 300], [500, 250], true).rotate[1], -30, 'snapped angle');
    // The ring around z is seen from the side: its front goes to the right for a positive turn.
    assert.ok(drag({ kind: 'ring', axis: 2 }, [400, 300], [450, 300]).rotate[2] > 10);
    assert.ok(drag({ kind: 'ring', axis: 2 }, [400, 300], [350, 300]).rotate[2] < -10);
    const even = drag({ kind: 'disc', axis: null }, [400, 300], [440, 280]).scale;
    assert.ok(even[0] > 1 && even[0] === even[1] && even[1] === even[2]);
    // The axis that points at the viewer cannot be dragged along.
    assert.deepEqual(drag({ kind: 'arrow', axis: 1 }, [400, 300], [450, 300]).move, [0, 0, 0]);
});

const handle = (page, name) => page.locator(`#gizmo [data-handle="${name}"] .seen`);

async function middleOf(page, name) {
    const { x, y, width, height } = await handle(page, name).boundingBox();
    return [x + width / 2, y + height / 2];
}

// Returns a place on a handle, in the window.
async function holdOf(page, name) {
    const { x, y } = await page.locator('#canvas').boundingBox();
    const [left, top] = await handle(page, name).evaluate((path) => {
        const point = path.getPointAtLength(0.4 * path.getTotalLength());
        return [point.x, point.y];
    });
    return [x + left, y + top];
}

async function dragHandle(page, name, [dx, dy], during = () => {}) {
    const [x, y] = await holdOf(page, name);
    await page.mouse.move(x, y);
    await page.mouse.down();
    await page.mouse.move(x + dx / 2, y + dy / 2);
    await page.mouse.move(x + dx, y + dy);
    await during();
    await page.mouse.up();
}

const positions = async (daemon, mesh) =>
    (await getAll(daemon, mesh, 'vertices')).map(({ position }) => position);

const isPreview = ([r, g, b]) => r > 225 && g > 225 && b > 225;
const isRed = ([r, g, b]) => r > 200 && g < 150 && b < 150;
const isGreen = ([r, g, b]) => g > 190 && r < 160 && b < 150;
const isBlue = ([r, g, b]) => b > 220 && r < 150 && g > 150 && g < 210;

// Returns the place to which a matrix of 16 numbers maps a point.
const mapped = (matrix, [x, y, z]) =>
    [0, 4, 8].map((row) => matrix[row] * x + matrix[row + 1] * y + matrix[row + 2] * z + matrix[row + 3]);

test('the handles are drawn at the selection, and go away', async (t) => {
    const { daemon, mesh, page } = await openMesh(t, CUBE);
    const colours = async () => {
        const picture = await readCanvas(page);
        return [isRed, isGreen, isBlue].map((test) => picture.countOf(test));
    };
    assert.ok((await colours()).every((count) => count < 30));
    await goTo(page, 'face', 1);
    await page.getByRole('button', { name: 'Gizmo', exact: true }).click();
    assert.ok((await colours()).every((count) => count > 150), `${await colours()}`);
    assert.equal(await page.locator('#gizmo-what').textContent(), '4 vertices');
    await checkAccessible(page, 'the gizmo');
    await goTo(page, 'vertex', 6);
    assert.equal(await page.locator('#gizmo-what').textContent(), '1 vertex');
    await page.getByRole('button', { name: 'Fit view' }).click();
    await page.locator('#canvas:not([data-moving])').waitFor();
    const place = (await projector(page, daemon, mesh)).at([6]);
    const canvas = await page.locator('#canvas').boundingBox();
    const [x, y] = await middleOf(page, 'disc');
    assert.ok(Math.hypot(x - canvas.x - place.x, y - canvas.y - place.y) < 2, `${[x, y]}`);
    // The handles follow the camera.
    const there = await middleOf(page, 'disc');
    await page.locator('#canvas').focus();
    await page.keyboard.press('-');
    await page.locator('#canvas:not([data-moving])').waitFor();
    assert.notDeepEqual(await middleOf(page, 'disc'), there);
    await press(page, 'Escape');
    assert.ok((await colours()).every((count) => count < 30));
    await waitForFrame(page, { selection: 'vertex:6' });
});

for (const [name, way, kind] of [
    ['arrow0', [50, 15], 'move'],
    ['ring2', [40, 10], 'rotate'],
    ['box0', [40, 12], 'scale'],
]) {
    test(`${name} can be dragged: a preview, then one edit that undo takes back`, async (t) => {
        const { daemon, mesh, page } = await openMesh(t, CUBE);
        const selection = [0, 1, 2, 3, 4, 5].map((id) => `face:${id}`).join(' ');
        await press(page, 'a');
        await waitForFrame(page, { selection });
        await press(page, 'w');
        const vertices = [0, 1, 2, 3, 4, 5, 6, 7];
        const before = await positions(daemon, mesh);
        const lines = (await readCanvas(page)).countOf(isPreview);
        const sent = page.waitForRequest(isEdit);
        await dragHandle(page, name, way, async () => {
            let drawn = 0;
            for (let frame = 0; frame < 300 && drawn < lines + 200; frame++) {
                await page.evaluate(() => new Promise(requestAnimationFrame));
                drawn = (await readCanvas(page)).countOf(isPreview);
            }
            assert.ok(drawn >= lines + 200, `${drawn} pixels of the preview are drawn`);
            const typed = await page.locator(`#gizmo-${kind} input`).evaluateAll((all) => all.map(({ value }) => value));
            assert.ok(typed.some((value) => value !== ''), `${typed}`);
            assert.equal((await get(daemon, `/${mesh}`)).revision, 1);
        });
        const { op, matrix, vertices: moved } = (await sent).postDataJSON().ops[0];
        assert.equal(op, 'transform');
        assert.deepEqual(moved, vertices);
        await waitForFrame(page, { revision: 2, selection });
        const after = await positions(daemon, mesh);
        after.forEach((place, id) => {
            const wanted = moved.includes(id) ? mapped(matrix, before[id]) : before[id];
            place.forEach((value, axis) => isNear(value, wanted[axis], `${id}`));
        });
        assert.notDeepEqual(after, before);
        await page.getByRole('button', { name: 'Undo', exact: true }).click();
        await waitForFrame(page, { revision: 3 });
        assert.deepEqual(await positions(daemon, mesh), before);
    });
}

test('Esc during a drag changes nothing, and the gizmo stays', async (t) => {
    const { daemon, mesh, page } = await openMesh(t, CUBE);
    await goTo(page, 'face', 1);
    await press(page, 'w');
    await dragHandle(page, 'arrow2', [0, -60], async () => {
        await page.keyboard.press('Escape');
    });
    assert.ok(await page.locator('#gizmo-note').isVisible());
    await waitForFrame(page, { revision: 1, selection: 'face:1' });
    assert.equal((await get(daemon, `/${mesh}`)).revision, 1);
});

test('numbers move, rotate and scale exactly, and the whole mesh if nothing is selected', async (t) => {
    const { daemon, mesh, page } = await openMesh(t, CUBE);
    await press(page, 'w');
    assert.equal(await page.locator('#gizmo-what').textContent(), 'The whole mesh');
    const before = await positions(daemon, mesh);
    const field = (label) => page.getByLabel(label, { exact: true });
    await field('Move x').fill('2');
    await field('Rotate z, degrees').fill('90');
    await field('Scale y').fill('3');
    await checkAccessible(page, 'numbers', '.stage');
    const sent = page.waitForRequest(isEdit);
    await field('Scale y').press('Enter');
    const operation = (await sent).postDataJSON().ops[0];
    const about = [0, 1, 2].map((axis) => {
        const values = before.map((place) => place[axis]);
        return (Math.min(...values) + Math.max(...values)) / 2;
    });
    const change = { scale: [1, 3, 1], rotate: [0, 0, 90], translate: [2, 0, 0], about };
    assert.deepEqual(operation, { op: 'transform', matrix: compose(change) });
    await waitForFrame(page, { revision: 2 });
    const matrix = compose(change);
    (await positions(daemon, mesh)).forEach((place, id) =>
        place.forEach((value, axis) => isNear(value, mapped(matrix, before[id])[axis], `${id}`)),
    );
    // Numbers that change nothing are not sent.
    await field('Move x').fill('0');
    await field('Move x').press('Enter');
    await waitForFrame(page, { revision: 2 });
    await field('Move x').press('Escape');
    assert.ok(await page.locator('#gizmo-note').isHidden());
});

test('a finger drags a handle', async (t) => {
    const { daemon, mesh, page } = await openMesh(t, CUBE, { hasTouch: true, viewport: { width: 390, height: 800 } });
    await goTo(page, 'face', 1);
    await page.getByRole('button', { name: 'Gizmo', exact: true }).tap();
    await page.locator('#canvas').scrollIntoViewIfNeeded();
    await checkAccessible(page, 'the gizmo on a telephone');
    const [x, y] = await holdOf(page, 'arrow2');
    const session = await page.context().newCDPSession(page);
    const touch = (type, touchPoints) => session.send('Input.dispatchTouchEvent', { type, touchPoints });
    await touch('touchStart', [{ x, y }]);
    await touch('touchMove', [{ x, y: y - 20 }]);
    await touch('touchMove', [{ x, y: y - 40 }]);
    await touch('touchEnd', []);
    await waitForFrame(page, { revision: 2, selection: 'face:1' });
    const { ops } = (await get(daemon, `/${mesh}/edits?limit=1`)).entries[0];
    assert.deepEqual(ops, ['transform']);
});

test('more vertices than are read are moved in one edit', async (t) => {
    const { daemon, mesh, page } = await openMesh(t, { shape: 'grid', columns: 40, rows: 40 });
    await post(daemon, `/${mesh}/edits`, { op: 'face_delete', faces: [0] });
    await waitForFrame(page, { revision: 2 });
    await press(page, 'a');
    await waitForFrame(page, { selection: '1599 faces' });
    await press(page, 'w');
    await page.getByLabel('Move z', { exact: true }).fill('0.5');
    await page.getByLabel('Move z', { exact: true }).press('Enter');
    await waitForFrame(page, { revision: 3 });
    const places = await positions(daemon, mesh);
    assert.equal(places.filter(([, , z]) => z === 0.5).length, places.length);
});
