// Tests of selections by rule: the form of `select` shows what its rule needs, a lasso is drawn in
// the view, and the set that was found fills other forms, in Chromium with the real daemon.

import assert from 'node:assert/strict';
import { test } from 'node:test';

import { checkAccessible, projector, waitForFrame } from './browser.mjs';
import { get, getAll, post } from './daemon.mjs';
import { chooseOperation, fillVector, goTo, isEdit, press } from './page.mjs';
import { openMesh } from './visit.mjs';

const CAN = { name: 'can', shape: 'cylinder', segments: 12 };
const GRID = { name: 'grid', shape: 'grid', columns: 6, rows: 6 };

const choose = (page, name) => chooseOperation(page, name);
const field = (page, name) => page.locator(`#param-${name}`);

const shown = (page) =>
    page
        .locator('#parameters .field:not([hidden])')
        .evaluateAll((rows) => rows.map((row) => row.dataset.name));

const expectVerdict = (page, pattern) =>
    page.locator('#verdict').filter({ hasText: pattern }).waitFor();

const expectToast = (page, text) =>
    page.locator('#toasts [role="status"]').filter({ hasText: text }).waitFor();

async function apply(page) {
    const sent = page.waitForRequest(isEdit);
    await page.getByRole('button', { name: 'Apply' }).click();
    return (await sent).postDataJSON().ops[0];
}

// Waits until the page has selected these elements.
const expectSelection = (page, kind, ids) =>
    waitForFrame(page, { selection: ids.map((id) => `${kind}:${id}`).join(' ') });

const ALWAYS = ['elements', 'mode', 'into', 'value'];

test('the form shows what the rule needs, and sends nothing else', async (t) => {
    const { page } = await openMesh(t, CAN);
    await choose(page, 'select');
    assert.deepEqual(await shown(page), ['by', 'face', 'angle', 'cross_features', ...ALWAYS]);
    await field(page, 'angle').fill('30');
    await field(page, 'by').selectOption('component');
    assert.deepEqual(await shown(page), ['by', 'face', 'edge', 'vertex', ...ALWAYS]);
    assert.equal(await page.locator('#parameters .or:not([hidden])').count(), 2);
    await field(page, 'by').selectOption('measure');
    assert.deepEqual(await shown(page), ['by', 'measure', 'from', 'to', ...ALWAYS]);
    await checkAccessible(page, 'a measure', '#details');
    await field(page, 'measure').selectOption('degree');
    await field(page, 'from').fill('12');
    await expectVerdict(page, 'Would select: 2 elements (+2).');
    assert.deepEqual(await apply(page), {
        op: 'select', by: 'measure', measure: 'degree', from: 12, mode: 'only',
    });
    await expectToast(page, 'The set \u201cselected\u201d of faces has 2 elements (+2).');
    await field(page, 'by').selectOption('box');
    assert.deepEqual(await shown(page), ['by', 'min', 'max', 'corners', ...ALWAYS]);
    await fillVector(page, 'min', [-9, -9, -9]);
    assert.equal(await page.locator('#verdict').textContent(), '');
    await fillVector(page, 'max', [9, 9, 9]);
    await field(page, 'elements').selectOption('edges');
    await expectVerdict(page, 'Would select: 36 elements (+36).');
});

test('seeds come from the selection, and what is found fills the next form', async (t) => {
    const { daemon, mesh, page } = await openMesh(t, CAN);
    const faces = await getAll(daemon, mesh, 'faces');
    const sides = faces.filter(({ vertices }) => vertices.length === 4).map(({ id }) => id);
    await goTo(page, 'face', sides[0]);
    await choose(page, 'select');
    assert.equal(await field(page, 'face').inputValue(), `${sides[0]}`);
    await field(page, 'angle').fill('35');
    await expectVerdict(page, 'Would select: 12 elements (+12).');
    await apply(page);
    await expectSelection(page, 'face', sides);
    // What was selected fills another form, and can be named there as a set.
    await choose(page, 'face_extrude');
    assert.equal(await field(page, 'face').inputValue(), sides.join(' '));
    await choose(page, 'face_delete');
    await field(page, 'face').fill('selected');
    await expectVerdict(page, '\u221212 F');
    assert.deepEqual((await apply(page)).faces, { selected: true });
    await waitForFrame(page, { revision: 3 });
    assert.equal((await get(daemon, `/${mesh}`)).counts.faces, 2);
});

test('a set of an int attribute is shown, grows, and is undone', async (t) => {
    const { daemon, mesh, page } = await openMesh(t, GRID, { allowed: [/status of 4\d\d/] });
    await goTo(page, 'vertex', 24);
    await choose(page, 'select');
    await field(page, 'by').selectOption('grow');
    assert.equal(await field(page, 'vertex').inputValue(), '24');
    await field(page, 'into').fill('part');
    await field(page, 'value').fill('7');
    await apply(page);
    await expectSelection(page, 'vertex', [17, 23, 24, 25, 31]);
    await expectToast(page, 'The set \u201cpart=7\u201d of vertices has 5 elements (+5).');
    await field(page, 'vertex').fill('part=7');
    await expectVerdict(page, 'Would select: 13 elements (+8).');
    assert.deepEqual((await apply(page)).vertices, { part: 7 });
    await waitForFrame(page, { revision: 3 });
    const values = async () =>
        (await get(daemon, `/${mesh}/attributes/vertices/part`)).values.filter((one) => one === 7);
    assert.equal((await values()).length, 13);
    await page.getByRole('button', { name: 'Undo', exact: true }).click();
    await waitForFrame(page, { revision: 4 });
    assert.equal((await values()).length, 5);
    await field(page, 'vertex').fill('parts=7');
    await expectVerdict(page, /Not possible:.*parts/);
});

// Returns whether a point is inside a polygon (even-odd rule).
function isInside([x, y], corners) {
    return corners.reduce((inside, [ax, ay], i) => {
        const [bx, by] = corners[(i + 1) % corners.length];
        const crosses = ay > y !== by > y && x < ax + ((y - ay) * (bx - ax)) / (by - ay);
        return crosses ? !inside : inside;
    }, false);
}

for (const [where, matrix] of [
    ['at the origin', null],
    ['far away', [1, 0, 0, 4e6, 0, 1, 0, -3e6, 0, 0, 1, 0, 0, 0, 0, 1]],
]) {
    test(`a lasso is drawn around vertices of a mesh ${where}`, async (t) => {
        const { daemon, mesh, page } = await openMesh(t, GRID);
        if (matrix !== null) {
            await post(daemon, `/${mesh}/edits`, { op: 'transform', matrix });
            await waitForFrame(page, { revision: 2 });
            await page.reload();
            await waitForFrame(page, { mesh, revision: 2 });
        }
        await choose(page, 'select');
        await field(page, 'by').selectOption('lasso');
        await field(page, 'elements').selectOption('vertices');
        await page.getByRole('button', { name: 'Draw polygon in the view' }).click();
        await checkAccessible(page, 'drawing');
        const box = await page.locator('#canvas').boundingBox();
        const corners = [[0.3, 0.35], [0.55, 0.2], [0.7, 0.5], [0.5, 0.75]];
        const places = corners.map(([x, y]) => [box.x + x * box.width, box.y + y * box.height]);
        await page.mouse.move(...places[0]);
        await page.mouse.down();
        for (const place of places.slice(1)) {
            await page.mouse.move(...place);
        }
        await page.mouse.up();
        await page.waitForFunction(
            () => document.getElementById('param-polygon').value.split('\n').length === 4,
        );
        const place = await projector(page, daemon, mesh);
        const wanted = (await getAll(daemon, mesh, 'vertices'))
            .filter(({ id }) => {
                const { x, y } = place.at([id]);
                return isInside([x, y], corners.map(([u, v]) => [u * box.width, v * box.height]));
            })
            .map(({ id }) => id);
        assert.ok(wanted.length > 2 && wanted.length < 40, `${wanted}`);
        await expectVerdict(page, `Would select: ${wanted.length} elements`);
        await apply(page);
        await expectSelection(page, 'vertex', wanted);
    });
}

test('Esc gives up a lasso, and a click without a drag draws none', async (t) => {
    const { page } = await openMesh(t, GRID);
    await choose(page, 'select');
    await field(page, 'by').selectOption('lasso');
    const draw = page.getByRole('button', { name: 'Draw polygon in the view' });
    await draw.click();
    await page.locator('#lasso-note').waitFor();
    await press(page, 'Escape');
    assert.ok(await page.locator('#lasso-note').isHidden());
    await draw.click();
    await page.locator('#canvas').click();
    assert.ok(await page.locator('#lasso-note').isHidden());
    assert.equal(await field(page, 'polygon').inputValue(), '');
    await waitForFrame(page, { selection: '' });
});

test('patches are counted, and their borders are shown', async (t) => {
    const { daemon, mesh, page } = await openMesh(t, CAN);
    await choose(page, 'segment');
    assert.deepEqual(await shown(page), ['angle', 'planes', 'features', 'into']);
    assert.equal(await page.locator('#parameters .or:not([hidden])').count(), 1);
    await field(page, 'angle').fill('35');
    await expectVerdict(page, 'Would divide the faces into 3 patches, with 24 feature edges.');
    await checkAccessible(page, 'segment', '#details');
    await apply(page);
    await expectToast(page, 'The faces are divided into 3 patches, with 24 feature edges.');
    const edges = await getAll(daemon, mesh, 'edges');
    const { values } = await get(daemon, `/${mesh}/attributes/edges/feature`);
    const marked = edges.filter((_, i) => values[i]).map(({ id }) => id);
    await expectSelection(page, 'edge', marked);
    // The number of planes takes the place of the angle.
    await field(page, 'planes').fill('14');
    assert.equal(await field(page, 'angle').inputValue(), '');
    await field(page, 'features').selectOption('ignore');
    await expectVerdict(page, 'Would divide the faces into 14 patches.');
});

test('a set of many elements is selected, too', async (t) => {
    const { page } = await openMesh(t, { shape: 'grid', columns: 40, rows: 40 });
    await choose(page, 'select');
    await field(page, 'by').selectOption('cone');
    await fillVector(page, 'normal', [0, 0, 1]);
    await field(page, 'angle').fill('6');
    await apply(page);
    await expectToast(page, 'The set \u201cselected\u201d of faces has 1,600 elements (+1,600).');
    await waitForFrame(page, { revision: 2, selection: '1600 faces' });
});
