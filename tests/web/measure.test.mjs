// Tests of the tool that measures: closed forms, clicks in the view, ids, and changes of the mesh.

import assert from 'node:assert/strict';
import { test } from 'node:test';

import { formatAngle, formatLength } from '../../web/src/kit/lengths.js';
import { angleAt, circleThrough, distance, pointsOf } from '../../web/src/measure/shapes.js';
import { checkAccessible, projector, readCanvas, waitForFrame } from './browser.mjs';
import { get, getAll, post } from './daemon.mjs';
import { click, expectToast, goTo, press } from './page.mjs';
import { openMesh } from './visit.mjs';

const CUBE = { name: 'cube', shape: 'cube' };
const near = (a, b, by = 1e-12) => assert.ok(Math.abs(a - b) <= by, `${a} is not ${b}`);

test('angles and circles of points have their closed forms', () => {
    near(angleAt([1, 0, 0], [0, 0, 0], [0, 3, 0]), Math.PI / 2);
    near(angleAt([1, 0, 0], [0, 0, 0], [1, 1e-9, 0]), 1e-9, 1e-24);
    assert.equal(angleAt([1, 2, 3], [1, 2, 3], [0, 0, 0]), null);
    const points = [[1, 2, 3], [4, 1, 0], [0, 5, 2]];
    const circle = circleThrough(...points);
    points.forEach((point) => near(distance(point, circle.center), circle.radius));
    // in the same plane: the normal of the points is at a right angle to the radius
    pointsOf(circle, 7).forEach((point) => near(distance(point, circle.center), circle.radius));
    near(circleThrough([2, 0, 0], [0, 2, 0], [-2, 0, 0]).radius, 2);
    // an equilateral triangle of side 1, far from the origin
    const far = [[0, 0, 0], [1, 0, 0], [0.5, Math.sqrt(3) / 2, 0]].map((p) => p.map((x) => x + 1000));
    near(circleThrough(...far).radius, 1 / Math.sqrt(3), 1e-9);
    assert.equal(circleThrough([0, 0, 0], [1, 1, 1], [3, 3, 3]), null);
    assert.equal(formatAngle(Math.PI / 4), '45\u00b0');
    assert.equal(formatLength(1 / 3), '0.333333');
});

const results = (page) => page.locator('#measure-results li');
const values = (page) => results(page).locator('strong').allTextContents();

async function expectValues(page, wanted) {
    await page.waitForFunction(
        (texts) => {
            const shown = [...document.querySelectorAll('#measure-results strong')];
            return shown.map((node) => node.textContent).join('|') === texts.join('|');
        },
        wanted,
    );
}

const start = (page) => page.locator('#measure-button').click();

async function measureIds(page, kind, ids) {
    const count = await results(page).count();
    await page.getByLabel('What to measure').selectOption(kind);
    await page.getByLabel('Ids', { exact: true }).fill(ids);
    await page.getByLabel('Ids', { exact: true }).press('Enter');
    await results(page).nth(count).waitFor();
    return (await values(page)).at(-1);
}

test('each measure of a cube by ids has its closed form', async (t) => {
    const { page } = await openMesh(t, CUBE);
    await start(page);
    await checkAccessible(page, 'the tool that measures');
    assert.equal(await measureIds(page, 'distance', '0 6'), formatLength(Math.sqrt(3)));
    assert.equal(await measureIds(page, 'edge', '4'), '1');
    assert.equal(await measureIds(page, 'angle', '1 0 3'), '90\u00b0');
    assert.equal(await measureIds(page, 'angle', '1 0 2'), '45\u00b0');
    assert.equal(await measureIds(page, 'faces', '1 2'), '90\u00b0');
    assert.equal(await measureIds(page, 'faces', '0 1'), '180\u00b0');
    assert.equal(await measureIds(page, 'area', '0 1 2'), '3');
    // the corners of a square of side 1 are on a circle of radius 1 / sqrt(2)
    assert.equal(await measureIds(page, 'radius', '4 5 6'), formatLength(Math.SQRT1_2));
    assert.equal(await measureIds(page, 'wall', '3'), '1');
    await checkAccessible(page, 'a list of results');
    const note = results(page).last().locator('.measure-note');
    assert.match(await note.textContent(), /^from face 3 to face \d$/);
    await page.getByRole('button', { name: 'Remove all' }).click();
    assert.equal(await results(page).count(), 0);
});

test('loops are those of a hole, and those that go straight on', async (t) => {
    const { daemon, mesh, page } = await openMesh(t, { name: 'tube', shape: 'torus', major_segments: 6, minor_segments: 4 });
    const edges = await getAll(daemon, mesh, 'edges');
    await start(page);
    const { edges: loop } = await post(daemon, `/${mesh}/traverse`, { walk: 'edge_loop', from: { edge: 0 } });
    const lengths = loop.map((id) => edges.find((edge) => edge.id === id).length);
    const sum = lengths.reduce((a, b) => a + b, 0);
    assert.equal(await measureIds(page, 'loop', '0'), formatLength(sum));
    assert.match(await results(page).locator('.measure-note').textContent(), /^closed edge loop of \d edges$/);

    await post(daemon, `/${mesh}/edits`, { op: 'face_delete', face: 5 });
    await waitForFrame(page, { mesh, revision: 2 });
    const rim = (await getAll(daemon, mesh, 'edges')).filter(({ boundary }) => boundary);
    const around = rim.reduce((total, { length }) => total + length, 0);
    assert.equal(rim.length, 4);
    assert.equal(await measureIds(page, 'loop', `${rim[1].id}`), formatLength(around));
    assert.match(
        await results(page).last().locator('.measure-note').textContent(),
        /^boundary loop of 4 edges$/,
    );
});

test('clicks measure: they snap to vertices, and else hit the surface exactly', async (t) => {
    const { daemon, mesh, page } = await openMesh(t, CUBE);
    const project = await projector(page, daemon, mesh);
    const faces = (await getAll(daemon, mesh, 'faces')).filter((face) => project.isSeen(face));
    const [top] = faces.filter(({ normal }) => normal[2] === 1);
    await press(page, 'm');
    assert.equal(await page.locator('#measure-button').getAttribute('aria-pressed'), 'true');
    const [a, b] = top.vertices;
    const corner = project.at([a]);
    await click(page, { x: corner.x + 4, y: corner.y + 3 }); // near, but not at the vertex
    await page.locator('#measure-hint').filter({ hasText: 'second' }).waitFor();
    await click(page, project.at([b]));
    await expectValues(page, ['1']);
    // the label is in the view, at the middle of the line, and the line is drawn
    const label = await page.locator('.ruler-label').boundingBox();
    const canvas = await page.locator('#canvas').boundingBox();
    const middle = project.at([a, b]);
    near(label.x + label.width / 2 - canvas.x, middle.x, 3);
    assert.ok(label.y - canvas.y < middle.y && middle.y - label.y + canvas.y < 60);
    const isPink = ([red, green, blue]) => red > 200 && green < 180 && blue > 150;
    const place = project.at([a, a, a, b]);
    assert.ok(isPink((await readCanvas(page)).colour(place.x, place.y)));

    await page.getByLabel('What to measure').selectOption('wall');
    await click(page, project.at(top.vertices));
    await expectValues(page, ['1', '1']);
    await page.getByLabel('What to measure').selectOption('faces');
    for (const { vertices } of faces.slice(0, 2)) {
        await click(page, project.at(vertices));
    }
    await expectValues(page, ['1', '1', '90\u00b0']);
    await page.getByLabel('What to measure').selectOption('edge');
    await click(page, project.at([a, b]));
    await expectValues(page, ['1', '1', '90\u00b0', '1']);
    // from a vertex to the middle of the face, where no vertex is near
    await page.getByLabel('What to measure').selectOption('distance');
    await click(page, project.at([a]));
    await page.locator('#measure-hint').filter({ hasText: 'second' }).waitFor();
    await click(page, project.at(top.vertices));
    await results(page).nth(4).waitFor();
    near(Number((await values(page))[4]), Math.SQRT1_2, 5e-3); // a click is as exact as a pixel
    // what is clicked is not selected
    await page.locator('#canvas[data-selection=""]').waitFor();

    // a click beside the mesh says so
    await click(page, { x: 8, y: 8 });
    await page.locator('#measure-said').filter({ hasText: 'nothing to measure' }).waitFor();
    // Esc first forgets the click, then ends the tool; the results stay
    await click(page, project.at([a]));
    await page.locator('#measure-hint').filter({ hasText: 'second' }).waitFor();
    await press(page, 'Escape');
    await page.locator('#measure-hint').filter({ hasText: 'first' }).waitFor();
    await press(page, 'Escape');
    assert.equal(await page.locator('#measure-button').getAttribute('aria-pressed'), 'false');
    assert.equal(await results(page).count(), 5);
    await page.getByRole('radio', { name: 'Face', exact: true }).check();
    await click(page, project.at(top.vertices));
    await waitForFrame(page, { selection: `face:${top.id}` });
});

test('measuring puts other tools down, and measures what it says whatever clicks picked before', async (t) => {
    const { daemon, mesh, page } = await openMesh(t, CUBE);
    const project = await projector(page, daemon, mesh);
    const faces = (await getAll(daemon, mesh, 'faces')).filter((face) => project.isSeen(face));
    const [a, b] = faces[0].vertices;
    await click(page, project.at(faces[0].vertices));
    await waitForFrame(page, { selection: `face:${faces[0].id}` });
    await press(page, 'e');
    await press(page, 'm');
    await page.getByLabel('What to measure').selectOption('edge');
    await press(page, '3'); // clicks pick faces, if one does not measure
    await click(page, project.at([a, b]));
    await expectValues(page, ['1']);
    assert.equal((await get(daemon, `/${mesh}`)).revision, 1);
    // A tool that is taken up ends measuring.
    await press(page, 'w');
    assert.equal(await page.locator('#measure-button').getAttribute('aria-pressed'), 'false');
});

test('the area of the selection is measured', async (t) => {
    const { page } = await openMesh(t, CUBE);
    await goTo(page, 'face', 2);
    await start(page);
    await page.getByLabel('What to measure').selectOption('area');
    await page.locator('#measure-form').getByRole('button').click();
    await expectValues(page, ['1']);
});

test('results follow the mesh, and say when their elements are gone', async (t) => {
    const { daemon, mesh, page } = await openMesh(t, CUBE);
    await start(page);
    await measureIds(page, 'distance', '0 1');
    await measureIds(page, 'wall', '1');
    const scale = { op: 'transform', matrix: [3, 0, 0, 0, 0, 3, 0, 0, 0, 0, 3, 0, 0, 0, 0, 1] };
    await post(daemon, `/${mesh}/edits`, scale);
    await expectValues(page, ['3', '3']);
    await post(daemon, `/${mesh}/edits`, { op: 'vertex_delete', vertex: 0 });
    await expectValues(page, ['gone', 'none']);
    await checkAccessible(page, 'results that are gone');
    await post(daemon, `/${mesh}/undo`, {});
    await expectValues(page, ['3', '3']);
});

test('a result is copied with a click, and removed with another', async (t) => {
    const { page } = await openMesh(t, CUBE, { permissions: ['clipboard-read', 'clipboard-write'] });
    await start(page);
    await measureIds(page, 'distance', '0 6');
    await page.getByRole('button', { name: /^Copy/ }).click();
    await page.locator('#measure-said').filter({ hasText: 'Copied' }).waitFor();
    const copied = await page.evaluate(() => navigator.clipboard.readText());
    assert.equal(copied, formatLength(Math.sqrt(3)));
    await page.getByRole('button', { name: /^Remove/ }).click();
    assert.equal(await results(page).count(), 0);
    assert.equal(await page.locator('.ruler-label').count(), 0);
});

test('ids that cannot be measured are refused in words', async (t) => {
    const { page } = await openMesh(t, CUBE);
    await start(page);
    await page.getByLabel('Ids', { exact: true }).fill('0');
    await page.getByLabel('Ids', { exact: true }).press('Enter');
    await expectToast(page, /needs the ids of 2 vertices/);
    await page.getByLabel('Ids', { exact: true }).fill('0 99');
    await page.getByLabel('Ids', { exact: true }).press('Enter');
    await expectToast(page, /there is no vertex 99/);
    await page.getByLabel('What to measure').selectOption('area');
    await page.getByLabel('Ids', { exact: true }).press('Enter');
    await expectToast(page, /Select faces/);
    assert.equal(await measureIds(page, 'angle', '0 0 1'), 'none');
    assert.equal(await measureIds(page, 'radius', '0 1 1'), 'none');
    assert.equal(await results(page).count(), 2);
});

test('on a phone of 320 pixels, the tool fits', async (t) => {
    const { page } = await openMesh(t, CUBE, { viewport: { width: 320, height: 640 } });
    await start(page);
    await measureIds(page, 'wall', '3');
    assert.equal(await page.evaluate(() => document.documentElement.scrollWidth), 320);
    await checkAccessible(page, 'measuring on a phone');
});
