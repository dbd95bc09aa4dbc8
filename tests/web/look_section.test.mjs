// Tests of the section plane in Chromium: what is cut away, the face of the cut, its measures, and
// that both follow the mesh and the user.

import assert from 'node:assert/strict';
import { test } from 'node:test';

import {
    checkAccessible, isBackground, isSurface, projector, readCanvas, waitForFrame,
} from './browser.mjs';
import { get, post } from './daemon.mjs';
import { cameraOf, click, setMode } from './page.mjs';
import { isCap, lookOf, openView, setLook, waitForDrawing } from './view_panel.mjs';
import { openMesh } from './visit.mjs';

// A unit cube in the middle of the coordinates.
const CUBE = {
    name: 'cube',
    vertices: [0, 1, 2, 3, 4, 5, 6, 7].map((i) => [0, 1, 2].map((axis) => ((i >> axis) & 1) - 0.5)),
    faces: [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]],
};
const TORUS = {
    name: 'torus', shape: 'torus', major_segments: 24, minor_segments: 12,
    major_radius: 1, minor_radius: 0.25,
};

const choose = (page, name) => page.locator('#section-axes').getByRole('radio', { name, exact: true }).check();
const text = (page, id) => page.locator(`#section-${id}`).textContent();
const numberOf = async (page, id) => Number.parseFloat(await text(page, id));
const polygon = (corners, radius) => 2 * corners * radius * Math.sin(Math.PI / corners);

async function draw(page) {
    await waitForDrawing(page);
    return readCanvas(page);
}

function near(found, wanted, what) {
    assert.ok(Math.abs(found - wanted) < 2e-5 * wanted, `${what}: ${found}, not ${wanted}`);
}

test('a cube cut in its middle shows a face of four sides, and its outline is 4', async (t) => {
    const { page, daemon, mesh } = await openMesh(t, CUBE);
    const place = await projector(page, daemon, mesh);
    const whole = await readCanvas(page);
    assert.equal(whole.countOf(isCap), 0);
    await openView(page);
    await choose(page, 'X');
    const cut = await draw(page);
    assert.deepEqual(await Promise.all(['length', 'area', 'loops'].map((id) => text(page, id))),
        ['4', '1', '1 closed loop']);
    // The camera looks from the side of positive x: what is there is cut away, and the face of the cut
    // is visible. Its colour ends at its four sides.
    const inside = [[0, 0, 0], [0, 0.45, 0.45], [0, -0.45, -0.45], [0, 0.45, -0.45], [0, -0.45, 0.45]];
    const outside = [[0, 0.55, 0.2], [0, -0.55, 0.2], [0, 0.1, -0.56]];
    for (const at of inside) {
        const { x, y } = place.atPlace(at);
        assert.ok(isCap(cut.colour(x, y)), `${at}: ${cut.colour(x, y)}`);
    }
    for (const at of outside) {
        const { x, y } = place.atPlace(at);
        assert.ok(!isCap(cut.colour(x, y)), `${at}: ${cut.colour(x, y)}`);
    }
    const corner = place.atPlace([0.49, 0.49, 0.49]);
    assert.ok(isSurface(whole.colour(corner.x, corner.y)) || !isBackground(whole.colour(corner.x, corner.y)));
    assert.ok(cut.countOf(isBackground) > whole.countOf(isBackground) + 5000);
    await checkAccessible(page, 'section');

    // flipped, the other half is shown, whose cut is seen from its back
    await page.getByRole('button', { name: 'Flip' }).click();
    const flipped = await draw(page);
    assert.ok(flipped.countOf(isCap) < 1500, `${flipped.countOf(isCap)} pixels of the cut`);
    assert.ok(isSurface(flipped.colour(corner.x, corner.y)) || !isBackground(flipped.colour(corner.x, corner.y)));
    assert.equal(await text(page, 'length'), '4');

    await choose(page, 'None');
    const again = await draw(page);
    assert.equal(again.countOf(isCap), 0);
    assert.equal(again.countOf(isSurface), whole.countOf(isSurface));
});

test('slider and number move the plane, in the coordinates of the mesh', async (t) => {
    const { page } = await openMesh(t, {
        ...CUBE, vertices: CUBE.vertices.map(([x, y, z]) => [100 + 40 * x, 7 + 40 * y, 40 * z]),
    });
    await openView(page);
    await page.getByRole('combobox', { name: 'Unit' }).selectOption('mm');
    await choose(page, 'Z');
    await draw(page);
    assert.equal(await page.locator('#section-at').inputValue(), '0');
    assert.equal(await text(page, 'length'), '160\u00a0mm');
    assert.equal(await text(page, 'area'), '1600\u00a0mm\u00b2');
    const middle = (await readCanvas(page)).centreOf(isCap);
    const slider = page.getByRole('slider', { name: 'Position', exact: true });
    await slider.fill('900');
    const high = (await draw(page)).centreOf(isCap);
    assert.ok(high.y < middle.y - 30, `${high.y} is above ${middle.y}`);
    assert.equal((await lookOf(page)).section.at, 16);
    const exact = page.getByLabel('Exact position of the section');
    assert.equal(await exact.inputValue(), '16');
    await exact.fill('-19.5');
    await exact.press('Enter');
    const low = (await draw(page)).centreOf(isCap);
    assert.ok(low.y > middle.y + 30);
    assert.equal(await slider.inputValue(), '13');
    // beyond the mesh nothing is cut
    await exact.fill('50');
    await exact.press('Enter');
    await draw(page);
    assert.deepEqual([await text(page, 'length'), await text(page, 'loops')], ['0\u00a0mm', 'none']);
});

test('a torus is cut into two circles, whose length and area are known', async (t) => {
    const { page } = await openMesh(t, TORUS);
    await openView(page);
    await choose(page, 'Y');
    const cut = await draw(page);
    near(await numberOf(page, 'length'), 2 * polygon(12, 0.25), 'two circles of 12 corners');
    near(await numberOf(page, 'area'), 12 * 0.25 ** 2 * Math.sin(Math.PI / 6), 'their area');
    assert.equal(await text(page, 'loops'), '2 closed loops');
    // the camera is on the side of negative y, so the half that is left shows the two circles
    await page.getByRole('button', { name: 'Flip' }).click();
    const flipped = await draw(page);
    const [a, b] = [cut, flipped].map((canvas) => canvas.countOf(isCap));
    assert.ok(Math.max(a, b) > 1500, `${a} and ${b} pixels`);
    await choose(page, 'Z');
    await draw(page);
    near(await numberOf(page, 'length'), polygon(24, 1.25) + polygon(24, 0.75), 'two rings');
});

test('the hole of a ring is not covered by the face of the cut', async (t) => {
    const { page, daemon, mesh } = await openMesh(t, TORUS);
    await setLook(page, { section: { axis: 'z', at: 0 } });
    const place = await projector(page, daemon, mesh);
    const canvas = await readCanvas(page);
    const ring = [0.3, 1.7, 3.1, 4.4, 5.9].map((a) => [Math.cos(a), Math.sin(a), 0]);
    for (const at of ring) {
        const { x, y } = place.atPlace(at);
        assert.ok(isCap(canvas.colour(x, y)), `${at}: ${canvas.colour(x, y)}`);
    }
    const hole = place.atPlace([0, 0, 0]);
    assert.ok(!isCap(canvas.colour(hole.x, hole.y)));
});

test('a sphere has the outline of its great circle, and the section follows an edit', async (t) => {
    const { page, daemon, mesh } = await openMesh(t, {
        name: 'sphere', shape: 'icosphere', subdivisions: 4,
    });
    await openView(page);
    await choose(page, 'Free');
    await draw(page);
    const radius = Math.hypot(...(await get(daemon, `/${mesh}/vertices/0`)).position);
    const length = await numberOf(page, 'length');
    // the sphere is made of triangles, so its circle is a little shorter
    assert.ok(length < 2 * Math.PI * radius && length > 1.995 * Math.PI * radius, `${length}`);
    assert.equal(await text(page, 'loops'), '1 closed loop');
    const before = (await readCanvas(page)).countOf(isCap);
    assert.ok(before > 5000, `${before} pixels of the cut`);

    // another client scales the mesh, and the plane stays in its middle
    const matrix = [0.5, 0, 0, 0, 0, 0.5, 0, 0, 0, 0, 0.5, 0, 0, 0, 0, 1];
    await post(daemon, `/${mesh}/edits`, { op: 'transform', matrix });
    await waitForFrame(page, { mesh, revision: 2 });
    await draw(page);
    near(await numberOf(page, 'length'), length / 2, 'after the edit');
    // removing a face through which the plane goes opens the loop, and there is no face of the cut
    const { items } = await get(daemon, `/${mesh}/faces?limit=10000`);
    const vertices = (await get(daemon, `/${mesh}/vertices?limit=10000`)).items;
    const x = (id) => vertices.find((one) => one.id === id).position[0];
    const face = items.find((one) =>
        one.vertices.some((id) => x(id) > 1e-3) && one.vertices.some((id) => x(id) < -1e-3));
    await post(daemon, `/${mesh}/edits`, { op: 'face_delete', face: face.id });
    await waitForFrame(page, { mesh, revision: 3 });
    assert.equal((await draw(page)).countOf(isCap) < before / 40, true);
    assert.equal(await text(page, 'loops'), '1 open line');
    await post(daemon, `/${mesh}/undo`, {});
    await waitForFrame(page, { mesh, revision: 4 });
    await draw(page);
    assert.equal(await text(page, 'loops'), '1 closed loop');
});

test('a free plane is turned by angles and laid across the view', async (t) => {
    const { page } = await openMesh(t, CUBE);
    await openView(page);
    await choose(page, 'Free');
    await page.getByRole('slider', { name: 'Turn' }).fill('45');
    await draw(page);
    // across two edges of the cube
    near(await numberOf(page, 'length'), 2 + 2 * Math.SQRT2, 'diagonal');
    await page.getByRole('slider', { name: 'Tilt' }).fill('90');
    await draw(page);
    near(await numberOf(page, 'length'), 4, 'level');
    await page.getByRole('button', { name: 'Across the view' }).click();
    const canvas = await draw(page);
    const { section } = await lookOf(page);
    const camera = (await cameraOf(page)).split(',').map(Number);
    const away = [0, 1, 2].map((axis) => camera[axis] - camera[axis + 3]);
    section.normal.forEach((value, axis) =>
        assert.ok(Math.abs(value - away[axis] / Math.hypot(...away)) < 1e-4, `${section.normal}`));
    assert.ok(canvas.countOf(isCap) > 20000);
    await checkAccessible(page, 'free section');
});

test('what is cut away can be neither seen nor picked, and marks on it are hidden', async (t) => {
    const { page, daemon, mesh } = await openMesh(t, CUBE);
    const place = await projector(page, daemon, mesh);
    const corner = place.atPlace([0.5, 0.5, 0.5]);
    const steps = [-0.45, -0.3, -0.15, 0, 0.15, 0.3, 0.45];
    const places = steps.flatMap((y) => steps.map((z) => place.atPlace([0.5, y, z])));
    const isDot = ([r, g, b]) => r > 200 && g > 200 && b > 200;
    await setMode(page, 'Vertex');
    const whole = await draw(page);
    assert.ok(isDot(whole.colour(corner.x, corner.y)));
    // A pointer that rests on the mesh makes the page keep an image of what is where.
    const box = await page.locator('#canvas').boundingBox();
    const middle = place.atPlace([0.5, 0, 0]);
    await page.mouse.move(box.x + middle.x, box.y + middle.y);
    await page.mouse.move(box.x + middle.x + 1, box.y + middle.y);
    await setLook(page, { section: { axis: 'x', at: -0.1 } });
    const cut = await readCanvas(page);
    assert.ok(!isDot(cut.colour(corner.x, corner.y)));
    // a place in front of the face of the cut, which cannot be picked
    const front = places.find(({ x, y }) => isCap(cut.colour(x, y)));
    await setMode(page, 'Face');
    await draw(page);
    await click(page, front);
    await page.locator('#canvas:not([data-selection=""])').waitFor();
    const selection = await page.locator('#canvas').getAttribute('data-selection');
    const { vertices } = await get(daemon, `/${mesh}/faces/${selection.slice(5)}`);
    // the face in front was cut away, so the one behind it was picked
    assert.ok(!vertices.every((id) => CUBE.vertices[id][0] > 0), `${vertices}`);
});

test('another mesh is opened whole, and levels of detail are shown without the section', async (t) => {
    const { page, daemon } = await openMesh(t, { name: 'sphere', shape: 'icosphere', subdivisions: 2 });
    await setLook(page, { section: { axis: 'x', at: 0 }, isSmooth: true });
    assert.ok((await readCanvas(page)).countOf(isCap) > 3000);
    await page.getByRole('button', { name: 'Levels' }).click();
    await page.locator('#canvas[data-faces="320"]').waitFor();
    assert.equal((await draw(page)).countOf(isCap), 0);
    await page.getByRole('button', { name: 'Back to the mesh' }).click();
    await page.locator('#canvas:not([data-faces])').waitFor();
    assert.ok((await draw(page)).countOf(isCap) > 3000);
    const { id } = await post(daemon, '', CUBE);
    await page.getByRole('button', { name: 'Refresh' }).click();
    await page.locator(`#meshes button[data-mesh="${id}"]`).click();
    await waitForFrame(page, { mesh: id });
    assert.equal((await draw(page)).countOf(isCap), 0);
    assert.equal((await lookOf(page)).section, null);
});
