// Tests that mouse, wheel, keyboard and fingers move the camera, and that it turns to the
// selection.

import assert from 'node:assert/strict';
import { test } from 'node:test';

import {
    checkAccessible,
    isBackground,
    isChosen,
    isNear,
    isSurface,
    projector,
    readCanvas,
    waitForFrame,
} from './browser.mjs';
import { getAll, post, startDaemon } from './daemon.mjs';
import { cameraOf, click, expectToast, goTo, press } from './page.mjs';
import { openMesh, openPage } from './visit.mjs';

const CUBE = { name: 'cube', shape: 'cube' };

// Returns how many pixels of the canvas show the mesh, and the mean of their places.
async function look(page) {
    const canvas = await readCanvas(page);
    const isMesh = (colour) => !isBackground(colour);
    return { size: canvas.countOf(isMesh), ...canvas.centreOf(isMesh) };
}

// Calls `act` and waits until the address shows that the camera has moved.
async function moved(page, act) {
    const address = page.url();
    await act();
    await page.waitForURL((url) => `${url}` !== address);
    await page.locator('#canvas').blur();
    return look(page);
}

const near = (a, b) => Math.abs(a - b) < 2;

async function middleOf(page) {
    const box = await page.locator('#canvas').boundingBox();
    return [box.x + box.width / 2, box.y + box.height / 2];
}

test('the wheel zooms, towards the pointer', async (t) => {
    const { page } = await openMesh(t, CUBE);
    const start = await look(page);
    const [x, y] = await middleOf(page);
    await page.mouse.move(x, y);
    const nearer = await moved(page, () => page.mouse.wheel(0, -300));
    assert.ok(nearer.size > 1.1 * start.size, `${nearer.size} after ${start.size}`);
    const further = await moved(page, () => page.mouse.wheel(0, 900));
    assert.ok(further.size < 0.9 * start.size, `${further.size} after ${start.size}`);
    await page.getByRole('button', { name: 'Fit view' }).click();
    await page.mouse.move(x + 300, y);
    const aside = await moved(page, () => page.mouse.wheel(0, -300));
    assert.ok(aside.x < start.x - 5, `${aside.x} after ${start.x}`);
});

test('the right button pans', async (t) => {
    const { page } = await openMesh(t, CUBE);
    const start = await look(page);
    const [x, y] = await middleOf(page);
    await page.mouse.move(x, y);
    const after = await moved(page, async () => {
        await page.mouse.down({ button: 'right' });
        await page.mouse.move(x + 60, y - 40, { steps: 3 });
        await page.mouse.up({ button: 'right' });
    });
    assert.ok(Math.abs(after.x - start.x - 60) < 12, `${after.x} after ${start.x}`);
    assert.ok(Math.abs(after.y - start.y + 40) < 12, `${after.y} after ${start.y}`);
    await waitForFrame(page, { selection: '' });
});

test('the keyboard zooms, pans and orbits', async (t) => {
    const { page } = await openMesh(t, CUBE);
    const start = await look(page);
    const nearer = await moved(page, () => press(page, '+'));
    assert.ok(nearer.size > 1.3 * start.size);
    const back = await moved(page, () => press(page, '-'));
    assert.ok(Math.abs(back.size - start.size) < start.size / 500);
    const panned = await moved(page, () => press(page, 'ArrowRight'));
    assert.ok(!near(panned.x, start.x) && near(panned.y, start.y));
    await page.getByRole('button', { name: 'Fit view' }).click();
    await cameraOf(page);
    const turned = await moved(page, () => press(page, 'Shift+ArrowRight'));
    assert.notEqual(turned.size, start.size);
    assert.ok(Math.abs(turned.x - start.x) < 20);
});

test('two fingers zoom and pan, and pick nothing', async (t) => {
    const { page } = await openMesh(t, CUBE, { hasTouch: true });
    const session = await page.context().newCDPSession(page);
    const [x, y] = await middleOf(page);
    const touch = (type, places) =>
        session.send('Input.dispatchTouchEvent', {
            type,
            touchPoints: places.map(([dx, dy], id) => ({ x: x + dx, y: y + dy, id })),
        });
    const start = await look(page);
    const wider = await moved(page, async () => {
        await touch('touchStart', [[-40, 0], [40, 0]]);
        await touch('touchMove', [[-60, 0], [60, 0]]);
        await touch('touchMove', [[-80, 0], [80, 0]]);
        await touch('touchEnd', []);
    });
    assert.ok(wider.size > 1.5 * start.size, `${wider.size} after ${start.size}`);
    await page.getByRole('button', { name: 'Fit view' }).click();
    const beside = await moved(page, async () => {
        await touch('touchStart', [[-40, 0], [40, 0]]);
        await touch('touchMove', [[-20, 0], [60, 0]]);
        await touch('touchMove', [[10, 0], [90, 0]]);
        await touch('touchEnd', []);
    });
    assert.ok(beside.x > start.x + 20, `${beside.x} after ${start.x}`);
    await waitForFrame(page, { selection: '' });
});

test('an element on the far side is seen when one goes to it', async (t) => {
    const { daemon, mesh, page } = await openMesh(t, { shape: 'icosphere', subdivisions: 2 });
    const place = await projector(page, daemon, mesh);
    const faces = await getAll(daemon, mesh, 'faces');
    const hidden = faces.filter((face) => !place.isSeen(face));
    for (const { id, vertices, halfedges } of [hidden[0], hidden.at(-1)]) {
        await goTo(page, 'face', id);
        await page.locator('#canvas').blur();
        const canvas = await readCanvas(page);
        const { width, height } = await page.locator('#canvas').boundingBox();
        const middle = canvas.colour(width / 2, height / 2);
        assert.ok(isChosen(middle), `face ${id}: ${middle}`);
        assert.ok(canvas.countOf(isNear) > 200, `arrows of face ${id}`);
        await page.getByRole('button', { name: 'Fit view' }).click();
        for (const [kind, other] of [['vertex', vertices[0]], ['halfedge', halfedges[0]]]) {
            await goTo(page, kind, other);
            await page.locator('#canvas').blur();
            // A half-edge is framed with its face, so it is beside the middle.
            const seen = await readCanvas(page);
            const isShown =
                kind === 'vertex'
                    ? isChosen(seen.colour(width / 2, height / 2))
                    : seen.countOf(isChosen) > 50;
            assert.ok(isShown, `${kind} ${other}`);
            await page.getByRole('button', { name: 'Fit view' }).click();
        }
    }
});

test('all faces that are selected are filled, and X deletes them all', async (t) => {
    const { daemon, mesh, page } = await openMesh(t, { shape: 'grid', columns: 3, rows: 3 });
    const place = await projector(page, daemon, mesh);
    const faces = await getAll(daemon, mesh, 'faces');
    const chosen = [faces[0], faces[4], faces[8]];
    for (const [i, { id, vertices }] of chosen.entries()) {
        await click(page, place.at(vertices), i === 0 ? [] : ['Shift']);
        await page.locator(`#canvas[data-selection$="face:${id}"]`).waitFor();
    }
    await page.locator('#canvas').blur();
    const canvas = await readCanvas(page);
    for (const { id, vertices } of faces) {
        const { x, y } = place.at(vertices);
        const wanted = chosen.some((one) => one.id === id);
        const is = wanted ? isChosen : isSurface;
        assert.ok(is(canvas.colour(x, y)), `face ${id} is ${canvas.colour(x, y)}`);
    }
    await checkAccessible(page, 'several selected');
    await press(page, 'x');
    await waitForFrame(page, { revision: 2, selection: '' });
    const left = (await getAll(daemon, mesh, 'faces')).map(({ id }) => id);
    assert.deepEqual(left, [1, 2, 3, 5, 6, 7]);
});

test('a mesh larger than a texture is said, and another one is drawn after it', async (t) => {
    const daemon = await startDaemon(t);
    const grid = { shape: 'grid', columns: 50, rows: 50 };
    const { id: large } = await post(daemon, '', { name: 'large', ...grid });
    const { id: small } = await post(daemon, '', CUBE);
    const page = await openPage(t, daemon, {
        path: `/#mesh=${large}`,
        init: () => {
            const { prototype } = WebGL2RenderingContext;
            const real = prototype.getParameter;
            prototype.getParameter = function getParameter(name) {
                return name === this.MAX_TEXTURE_SIZE ? 2 : real.call(this, name);
            };
        },
    });
    await expectToast(page, /larger than the graphics memory/);
    await page.getByRole('button', { name: 'Close message' }).click();
    await waitForFrame(page, { mesh: large, revision: 1 });
    assert.equal((await readCanvas(page)).countOf(isSurface), 0);
    await goTo(page, 'face', 7);
    await page.locator(`#meshes button[data-mesh="${small}"]`).click();
    await waitForFrame(page, { mesh: small, revision: 1 });
    assert.ok((await readCanvas(page)).countOf(isSurface) > 10000);
});
