// Tests of the colours by measures and attributes: the maps, what is read from the server, and the
// pixels of the page.

import assert from 'node:assert/strict';
import { test } from 'node:test';

import { Column } from '../../web/src/colour/column.js';
import { COLOURS, MISSING, categorical, indexOf, mapOf } from '../../web/src/colour/maps.js';
import { relatedTo } from '../../web/src/colour/related.js';
import { texelsOfNumbers } from '../../web/src/colour/texels.js';
import { Corners, NONE, facesOf, verticesOf } from '../../web/src/geometry/corners.js';
import { unpack } from '../../web/src/geometry/geometry.js';
import { checkAccessible, projector, readCanvas, waitForFrame, waitForTold } from './browser.mjs';
import { get, getAll, getGeometry, post, startDaemon } from './daemon.mjs';
import { chooseOperation, goTo } from './page.mjs';
import { openMesh } from './visit.mjs';

const CUBE = { name: 'cube', shape: 'cube' };

// --- maps and columns ---

// Returns the relative luminance of an sRGB colour.
function luminance(color) {
    const [r, g, b] = color.map((byte) => {
        const part = byte / 255;
        return part <= 0.04045 ? part / 12.92 : ((part + 0.055) / 1.055) ** 2.4;
    });
    return 0.2126 * r + 0.7152 * g + 0.0722 * b;
}

const colorsOf = (bytes) =>
    Array.from({ length: bytes.length / 4 }, (_, i) => [...bytes.subarray(4 * i, 4 * i + 3)]);

test('a sequential map becomes lighter, and a diverging one is lightest in the middle', () => {
    const lights = colorsOf(mapOf('sequential')).map(luminance);
    assert.equal(lights.length, COLOURS);
    lights.slice(1).forEach((light, i) => assert.ok(light > lights[i] - 1e-3, `${i}`));
    assert.ok(lights.at(-1) - lights[0] > 0.6);
    const both = colorsOf(mapOf('diverging')).map(luminance);
    const lightest = both.indexOf(Math.max(...both));
    assert.ok(Math.abs(lightest - COLOURS / 2) < 2, `${lightest}`);
    assert.ok(Math.abs(both[0] - both.at(-1)) < 0.06, 'both ends are about as dark');
});

test('the first categories have colours that differ from each other and from what is missing', () => {
    const colors = [MISSING, ...Array.from({ length: 12 }, (_, i) => categorical(i))];
    colors.forEach((a, i) => {
        colors.slice(i + 1).forEach((b) => {
            const away = Math.hypot(...a.map((part, k) => part - b[k]));
            assert.ok(away > 40, `${a} and ${b}`);
        });
    });
});

test('a value outside of the range has the colour of its end', () => {
    assert.deepEqual([-1, 0, 1, 2, 9].map((value) => indexOf(value, [0, 2])), [0, 0, 128, 255, 255]);
    assert.deepEqual([1, 2, 3].map((value) => indexOf(value, [2, 2])), [0, 255, 255]);
});

test('a column counts what it has and what is missing', () => {
    const column = new Column(Float64Array.of(4, NaN, 0, 99, 2), [0, 1, 2, 4, 5]);
    assert.deepEqual([column.least, column.most, column.count, column.missing], [0, 4, 3, 2]);
    assert.deepEqual([...column.histogram(4)], [1, 0, 1, 1]);
    assert.deepEqual(column.find(column.isInBin(3, 4)), [0]);
    assert.deepEqual(column.categories.map(({ value }) => value), [0, 2, 4]);
    assert.deepEqual(column.usualRange(false), [0, 4]);
    assert.deepEqual(column.usualRange(true), [-4, 4]);
    const none = new Column(Float64Array.of(NaN), [0]);
    assert.deepEqual([none.count, none.missing, ...none.usualRange(false)], [0, 1, 0, 0]);
    // One extreme value of 1001 must not make the others look equal.
    const numbers = Float64Array.from({ length: 1001 }, (_, i) => (i === 1000 ? 1e6 : i));
    const far = new Column(numbers, numbers.map((_, i) => i));
    assert.deepEqual(far.usualRange(false), [10, 990]);
});

test('large values keep their differences as floats', () => {
    const column = new Column(Float64Array.of(1e15, 1e15 + 1, 1e15 + 4), [0, 1, 2]);
    const texels = texelsOfNumbers('vertices', column, null);
    assert.deepEqual([...texels.subarray(0, 3)], [0, 0.25, 1]);
});

test('elements beside the selected ones are found', () => {
    const face = { id: 1, halfedge: 5, vertices: [0, 2, 3], halfedges: [5, 6, 8] };
    const chosen = [{ kind: 'face', id: 1, element: face }];
    assert.deepEqual(relatedTo(chosen, 'faces'), [1]);
    assert.deepEqual(relatedTo(chosen, 'vertices'), [0, 2, 3]);
    assert.deepEqual(relatedTo(chosen, 'edges'), [2, 3, 4]);
    assert.deepEqual(relatedTo(chosen, 'halfedges'), [5, 6, 8]);
});

// --- corners, against the API ---

async function readCorners(daemon, mesh, faces) {
    const list = async (relation) => {
        const queries = [{ relation, of: { faces: 'all' } }];
        return (await post(daemon, `/${mesh}/query`, { queries })).results[0];
    };
    return new Corners(faces, await list('vertices'), await list('halfedges'));
}

test('corners, edges and components are those of the API', async (t) => {
    const daemon = await startDaemon(t);
    const { id: mesh } = await post(daemon, '', { shape: 'torus', major_segments: 7, minor_segments: 5 });
    const { id: other } = await post(daemon, '', { shape: 'cube' });
    await post(daemon, `/${mesh}/edits`, { ops: [
        { op: 'face_delete', face: 3 },
        { op: 'face_poke', face: 9 },
        { op: 'vertex_delete', vertex: 20 },
        { op: 'append', mesh: other },
        { op: 'vertex_add', position: [5, 5, 5] },
    ] });
    const geometry = unpack(await getGeometry(daemon, mesh));
    const [faces, vertices] = [facesOf(geometry), verticesOf(geometry)];
    const all = await getAll(daemon, mesh, 'faces');
    assert.deepEqual([...faces], all.map(({ id }) => id));
    assert.deepEqual([...vertices], (await getAll(daemon, mesh, 'vertices')).map(({ id }) => id));
    const corners = await readCorners(daemon, mesh, faces);
    assert.deepEqual([...corners.edges], (await getAll(daemon, mesh, 'edges')).map(({ id }) => id));
    const halfedges = new Map((await getAll(daemon, mesh, 'halfedges')).map((one) => [one.id, one]));
    assert.deepEqual([...corners.halfedges], [...halfedges.keys()]);
    corners.ofTriangles(geometry).forEach((id, at) => {
        const triangle = Math.floor(at / 3);
        const words = geometry.triangles.subarray(4 * triangle, 4 * triangle + 4);
        if (words[0] === words[1]) {
            assert.equal(id, NONE);
            return;
        }
        const { origin, target, face } = halfedges.get(id);
        assert.deepEqual([origin, face], [words[at % 3], words[3] & 0x1fffffff]);
        assert.equal(corners.between(origin, target), id);
    });
    assert.equal(corners.between(vertices.at(-1), 0), null);
    const { components } = await get(daemon, `/${mesh}/components?by=edge`);
    const labels = corners.components();
    assert.equal(components.length, 2);
    components.forEach(({ face, faces: count }, i) => {
        assert.equal(labels[face], i);
        assert.equal(labels.filter((label) => label === i).length, count);
    });
});

// --- the page ---

const put = async (daemon, path, body, method = 'PUT') => {
    const answer = await fetch(`${daemon.url}/v1/meshes${path}`, {
        method,
        headers: { 'Content-Type': 'application/json' },
        body: JSON.stringify(body),
    });
    assert.ok(answer.ok, await answer.clone().text());
    return answer.json();
};

const waitForColor = (page, label) =>
    page.waitForFunction((wanted) => document.getElementById('canvas').dataset.colour === wanted, label);

// Chooses what the colours show, and waits for the frame that shows it.
async function colorBy(page, key, revision) {
    await page.getByLabel('Colour by').focus();
    await page.locator(`#colour-by option[value="${key}"]`).waitFor({ state: 'attached' });
    await page.getByLabel('Colour by').selectOption(key);
    await waitForColor(page, `${key} ${revision}`);
}

// Takes the light off the coloured surface, so that pixels have exactly the colours of the map.
async function showFlat(page) {
    await page.getByLabel('Shade the coloured surface').uncheck();
    await settle(page);
}

// Waits until the frame after the present one was drawn.
const settle = (page) =>
    page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));

const faceAttribute = (values, more = {}) => ({ type: 'double', values, ...more });

// Returns a function that requires the colour in the middle of each visible face of a cube.
async function faceChecker({ daemon, mesh, page }) {
    const project = await projector(page, daemon, mesh);
    const faces = (await getAll(daemon, mesh, 'faces')).filter((face) => project.isSeen(face));
    assert.equal(faces.length, 3);
    return async (colorOf) => {
        await settle(page);
        const picture = await readCanvas(page);
        for (const { id, vertices } of faces) {
            const { x, y } = project.at(vertices);
            assert.deepEqual(picture.colour(x, y), colorOf(id), `face ${id}`);
        }
    };
}

const colorIn = (map, value, range) => colorsOf(mapOf(map))[indexOf(value, range)];

test('faces have exactly the colours of the map, and the range moves them', async (t) => {
    const visit = await openMesh(t, CUBE);
    const { daemon, mesh, page } = visit;
    const heat = [0, 1, 2, 3.1, 4, 5];
    await put(daemon, `/${mesh}/attributes/faces/heat`, faceAttribute(heat));
    await waitForFrame(page, { mesh, revision: 2 });
    const expectFaces = await faceChecker(visit);
    await colorBy(page, 'attribute/faces/heat', 2);
    await checkAccessible(page, 'coloured by an attribute');
    await showFlat(page);
    await expectFaces((id) => colorIn('sequential', heat[id], [0, 5]));

    const from = page.getByLabel('Lowest value');
    const to = page.getByLabel('Highest value');
    assert.deepEqual([await from.inputValue(), await to.inputValue()], ['0', '5']);
    await to.fill('4.2');
    await to.press('Enter');
    await expectFaces((id) => colorIn('sequential', heat[id], [0, 4.2]));
    // the keyboard moves the handle by a step of 1/200 of the axis, from 0 to 5
    await page.getByLabel('Lowest colour').press('ArrowRight');
    await page.getByLabel('Lowest colour').press('ArrowRight');
    assert.equal(await from.inputValue(), '0.05');
    await expectFaces((id) => colorIn('sequential', heat[id], [0.05, 4.2]));
    // a handle cannot pass the other one
    await from.fill('99');
    await from.press('Enter');
    assert.equal(await from.inputValue(), '4.2');
    await expectFaces((id) => colorIn('sequential', heat[id], [4.2, 4.2]));
    await page.getByRole('button', { name: 'Reset the range' }).click();
    await expectFaces((id) => colorIn('sequential', heat[id], [0, 5]));

    await page.getByLabel('Colours', { exact: true }).selectOption('diverging');
    await expectFaces((id) => colorIn('diverging', heat[id], [0, 5]));

    await page.getByLabel('Colour by').selectOption('');
    await page.locator('#canvas:not([data-colour])').waitFor();
    assert.ok(await page.locator('#colour-key').isHidden());
    await settle(page);
    const plain = await readCanvas(page);
    const violet = colorIn('diverging', 0, [0, 5]);
    assert.equal(plain.countOf((color) => color.join() === violet.join()), 0);
});

test('values that change elsewhere are shown, and an attribute that goes is said to be gone', async (t) => {
    const visit = await openMesh(t, CUBE, { allowed: [/404/] });
    const { daemon, mesh, page } = visit;
    const path = `/${mesh}/attributes/faces/heat`;
    await put(daemon, path, faceAttribute([0, 1, 2, 3, 4, 5]));
    await waitForFrame(page, { mesh, revision: 2 });
    const expectFaces = await faceChecker(visit);
    await colorBy(page, 'attribute/faces/heat', 2);
    await showFlat(page);
    await put(daemon, path, { ids: [0, 1, 2, 3, 4, 5], values: [9, 9, 3, 2, 1, 0] }, 'PATCH');
    await waitForColor(page, 'attribute/faces/heat 3');
    await expectFaces((id) => colorIn('sequential', [9, 9, 3, 2, 1, 0][id], [0, 9]));
    // a new face has the value of the face that it came from
    await post(daemon, `/${mesh}/edits`, { op: 'face_poke', face: 1 });
    await waitForColor(page, 'attribute/faces/heat 4');
    const project = await projector(page, daemon, mesh);
    const seen = (await getAll(daemon, mesh, 'faces')).filter((face) => project.isSeen(face));
    assert.equal(seen.length, 6);
    const picture = await readCanvas(page);
    for (const { id, vertices } of seen) {
        const { attributes } = await get(daemon, `/${mesh}/faces/${id}`);
        const { x, y } = project.at(vertices);
        assert.deepEqual(picture.colour(x, y), colorIn('sequential', attributes.heat, [0, 9]), `${id}`);
    }

    const { revision } = await post(daemon, `/${mesh}/undo`, { steps: 3 });
    await waitForFrame(page, { mesh, revision });
    await page.locator('#colour-said').filter({ hasText: /does not have .heat. any more/ }).waitFor();
    assert.equal(await page.getByLabel('Colour by').inputValue(), '');
});

test('labels and whole numbers are categories, which can be selected', async (t) => {
    const visit = await openMesh(t, CUBE);
    const { daemon, mesh, page } = visit;
    const kinds = { type: 'uint32', labels: ['steel', 'brass', '<b>wood</b>'], values: [0, 1, 2, 1, 2, 1] };
    await put(daemon, `/${mesh}/attributes/faces/kind`, kinds);
    await put(daemon, `/${mesh}/attributes/faces/patch`, { type: 'int32', values: [7, 7, -3, 7, 12, -3] });
    await put(daemon, `/${mesh}/attributes/faces/marked`, { type: 'bool', values: [true, false, true, true, false, true] });
    await waitForFrame(page, { mesh, revision: 4 });
    const expectFaces = await faceChecker(visit);
    await colorBy(page, 'attribute/faces/kind', 4);
    await showFlat(page);
    await expectFaces((id) => categorical(kinds.values[id]));
    const rows = page.locator('#colour-scale .materials li');
    assert.deepEqual(await rows.allTextContents(), ['steel1 face', 'brass3 faces', '<b>wood</b>2 faces']);
    await checkAccessible(page, 'categories');
    await rows.nth(2).getByRole('button').click();
    await waitForFrame(page, { selection: 'face:2 face:4' });
    assert.deepEqual(await page.locator('#colour-values dd').allTextContents(), ['<b>wood</b>', '<b>wood</b>']);
    await page.locator('#canvas').press('Escape');
    await waitForFrame(page, { selection: '' });

    await colorBy(page, 'attribute/faces/patch', 4);
    await expectFaces((id) => categorical([-3, 7, 12].indexOf([7, 7, -3, 7, 12, -3][id])));
    await colorBy(page, 'attribute/faces/marked', 4);
    assert.deepEqual(await rows.allTextContents(), ['no2 faces', 'yes4 faces']);
    await expectFaces((id) => categorical([1, 0, 1, 1, 0, 1][id]));
    await page.getByLabel('Colours', { exact: true }).selectOption('sequential');
    await expectFaces((id) => colorIn('sequential', [1, 0, 1, 1, 0, 1][id], [0, 1]));
});

test('the choice has every measure and attribute of the API, and their values', async (t) => {
    const daemon = await startDaemon(t);
    const { id: mesh } = await post(daemon, '', { name: 'ball', shape: 'icosphere', subdivisions: 2 });
    await post(daemon, `/${mesh}/edits`, { op: 'face_delete', face: 0 });
    await put(daemon, `/${mesh}/attributes/vertices/weight`, { type: 'float' });
    await put(daemon, `/${mesh}/attributes/halfedges/uv`, { type: 'float', components: 2 });
    await put(daemon, `/${mesh}/attributes/edges/feature`, { type: 'bool' });
    await put(daemon, `/${mesh}/attributes/mesh/author`, { type: 'int32' });
    const { page } = await openAt(t, daemon, mesh, 6);
    await page.getByLabel('Colour by').focus();
    await page.locator('#colour-by option[value="measure/faces/area"]').waitFor({ state: 'attached' });
    const keys = await page.locator('#colour-by option').evaluateAll((all) => all.map(({ value }) => value));
    for (const key of ['vertices/weight', 'halfedges/uv', 'edges/feature']) {
        assert.ok(keys.includes(`attribute/${key}`), key);
    }
    assert.ok(!keys.some((key) => key.includes('author')), 'a value of the mesh has no place on it');
    // the server decides which measures there are: a measure is offered where it answers, else not
    const document = await (await fetch(`${daemon.url}/v1/openapi.json`)).json();
    for (const name of document.components.schemas.measure_name.enum) {
        for (const kind of ['vertices', 'halfedges', 'edges', 'faces']) {
            const queries = [{ measure: name, of: { [kind]: 'all' } }];
            const [answer] = (await post(daemon, `/${mesh}/query`, { queries })).results;
            const key = `measure/${kind}/${name}`;
            assert.equal(keys.includes(key), answer.values !== undefined, key);
            if (answer.values === undefined || answer.components !== 1) {
                continue;
            }
            await colorBy(page, key, 6);
            const known = answer.values.filter((value) => value !== null);
            const missing = answer.values.length - known.length;
            const note = page.locator('.missing');
            assert.equal(await note.count(), missing > 0 ? 1 : 0, key);
            if (missing > 0) {
                assert.match(await note.textContent(), new RegExp(`^No value: ${missing} `));
            }
            // the value of one element
            const kindOf = { vertices: 'vertex', halfedges: 'halfedge', edges: 'edge', faces: 'face' }[kind];
            const items = await getAll(daemon, mesh, kind);
            const at = Math.floor(items.length / 2);
            await goTo(page, kindOf, items[at].id);
            const dd = page.locator(`#colour-values dd[data-value="${items[at].id}"]`);
            await dd.waitFor();
            const text = await dd.textContent();
            const shown = Number(text.split(' ')[0]);
            assert.ok(
                Math.abs(shown - answer.values[at]) <= 1e-5 * Math.abs(answer.values[at]) + 1e-12,
                `${key}: ${text}, ${answer.values[at]}`,
            );
        }
    }
});

async function openAt(t, daemon, mesh, revision, options) {
    const { openPage } = await import('./visit.mjs');
    const page = await openPage(t, daemon, options);
    await waitForFrame(page, { mesh, revision });
    return { page };
}

const GRID = { name: 'grid', shape: 'grid', columns: 2, rows: 2 };

test('vertices, corners and edges have colours, too, and what is missing is grey', async (t) => {
    const visit = await openMesh(t, GRID);
    const { daemon, mesh, page } = visit;
    const edges = await getAll(daemon, mesh, 'edges');
    const faces = await getAll(daemon, mesh, 'faces');
    const weights = edges.map((_, i) => i);
    await put(daemon, `/${mesh}/attributes/edges/weight`, { type: 'float', values: weights });
    const corners = (await getAll(daemon, mesh, 'halfedges')).map(({ face }) => face ?? 0);
    await put(daemon, `/${mesh}/attributes/halfedges/side`, { type: 'float', values: corners });
    const middle = (await getAll(daemon, mesh, 'vertices')).map(({ boundary }) => (boundary ? 0 : 1));
    await put(daemon, `/${mesh}/attributes/vertices/inside`, { type: 'float', values: middle });
    await waitForFrame(page, { mesh, revision: 4 });
    const project = await projector(page, daemon, mesh);
    await page.getByLabel('Show boundary loops').uncheck();
    const at = async (ids) => {
        await settle(page);
        const picture = await readCanvas(page);
        const { x, y } = project.at(ids);
        return picture.colour(x, y);
    };

    await colorBy(page, 'attribute/edges/weight', 4);
    await showFlat(page);
    for (const { id, vertices } of edges.filter(({ boundary }) => !boundary)) {
        const wanted = colorIn('sequential', id, [0, edges.length - 1]);
        assert.deepEqual(await at(vertices), wanted, `edge ${id}`);
    }
    // corners of one face have one value here, so the whole face has
    await colorBy(page, 'attribute/halfedges/side', 4);
    for (const { id, vertices } of faces) {
        assert.deepEqual(await at(vertices), colorIn('sequential', id, [0, 3]), `face ${id}`);
    }
    // between vertices of 0 and 1, in the middle of a square: on the diagonal, or a quarter
    await colorBy(page, 'attribute/vertices/inside', 4);
    const inner = middle.indexOf(1);
    const face = faces.find(({ vertices }) => vertices.includes(inner));
    const triangle = unpack(await getGeometry(daemon, mesh));
    const isCut = [...Array(triangle.triangleCount).keys()].some((i) => {
        const words = triangle.triangles.subarray(4 * i, 4 * i + 4);
        const opposite = face.vertices[(face.vertices.indexOf(inner) + 2) % 4];
        return (words[3] & 0x1fffffff) === face.id && words.includes(inner) && words.slice(0, 3).includes(opposite);
    });
    const found = await at(face.vertices);
    const nearest = [-1, 0, 1].map((step) =>
        colorsOf(mapOf('sequential'))[indexOf(isCut ? 0.5 : 0, [0, 1]) + step]?.join());
    assert.ok(nearest.includes(found.join()), `${found} is none of ${nearest}`);

    // curvature is not defined at the boundary
    await colorBy(page, 'measure/vertices/gaussian_curvature', 4);
    assert.match(await page.locator('.missing').textContent(), /No value: 8 vertices/);
    assert.deepEqual(await at(face.vertices), MISSING);

    // the normals of a flat grid point up: no red and green, all blue
    await colorBy(page, 'measure/vertices/normal', 4);
    const up = await at(face.vertices);
    assert.ok(Math.abs(up[0] - 128) <= 1 && Math.abs(up[1] - 128) <= 1 && up[2] === 255, `${up}`);
    await page.getByLabel('Part of the vector').selectOption('2');
    assert.equal(await page.getByLabel('Lowest value').inputValue(), '1');
    await checkAccessible(page, 'a part of a vector');
});

test('texture coordinates are a checkerboard, and colours are themselves', async (t) => {
    const { daemon, mesh, page } = await openMesh(t, { name: 'sheet', shape: 'grid', columns: 1, rows: 1 });
    const vertices = await getAll(daemon, mesh, 'vertices');
    const uv = vertices.map(({ position: [x, y] }) => [x, y]);
    await put(daemon, `/${mesh}/attributes/vertices/uv`, { type: 'float', components: 2, values: uv });
    const rgb = vertices.map(() => [1, 0.2, 0]);
    await put(daemon, `/${mesh}/attributes/vertices/color`, { type: 'float', components: 3, values: rgb });
    await waitForFrame(page, { mesh, revision: 3 });
    const project = await projector(page, daemon, mesh);
    await colorBy(page, 'attribute/vertices/uv', 3);
    await showFlat(page);
    const picture = await readCanvas(page);
    // the middles of the squares, eight for each unit of u and v
    const [[x0, y0], [x1, y1]] = [uv.reduce((a, b) => [Math.min(a[0], b[0]), Math.min(a[1], b[1])]),
        uv.reduce((a, b) => [Math.max(a[0], b[0]), Math.max(a[1], b[1])])];
    let squares = 0;
    for (let u = Math.floor(8 * x0) + 0.5; u < 8 * x1; u++) {
        for (let v = Math.floor(8 * y0) + 0.5; v < 8 * y1; v++) {
            const { x, y } = project.atPlace([u / 8, v / 8, 0]);
            const isDark = (((Math.floor(u) + Math.floor(v)) % 2) + 2) % 2 === 0;
            assert.equal(picture.colour(x, y)[0] < 100, isDark, `${u} ${v}`);
            squares++;
        }
    }
    assert.ok(squares >= 64);
    await colorBy(page, 'attribute/vertices/color', 3);
    await settle(page);
    const { x, y } = project.atPlace([(x0 + x1) / 2 + 0.01, (y0 + y1) / 2, 0]);
    assert.deepEqual((await readCanvas(page)).colour(x, y), [255, 51, 0]);
});

test('the value under the pointer is shown', async (t) => {
    const visit = await openMesh(t, CUBE);
    const { daemon, mesh, page } = visit;
    await put(daemon, `/${mesh}/attributes/edges/load`, { type: 'float', values: [...Array(12).keys()].map((i) => i / 4) });
    await waitForFrame(page, { mesh, revision: 2 });
    const project = await projector(page, daemon, mesh);
    await colorBy(page, 'attribute/edges/load', 2);
    const faces = (await getAll(daemon, mesh, 'faces')).filter((face) => project.isSeen(face));
    const edge = faces[0].halfedges[0] >> 1;
    const { vertices } = await get(daemon, `/${mesh}/edges/${edge}`);
    await page.locator('#canvas').hover({ position: project.at(vertices) });
    await page.locator('.key-value').filter({ hasText: `Edge ${edge}: ${edge / 4}` }).waitFor();
    await page.locator('#canvas').hover({ position: { x: 5, y: 5 } });
    await page.waitForFunction(() => document.querySelector('.key-value').textContent === '');
});

test('elements in the range, or of a bar of the histogram, are selected', async (t) => {
    const { daemon, mesh, page } = await openMesh(t, CUBE);
    await put(daemon, `/${mesh}/attributes/faces/heat`, faceAttribute([0, 1, 2, 3, 4, 5]));
    await waitForFrame(page, { mesh, revision: 2 });
    await colorBy(page, 'attribute/faces/heat', 2);
    await page.locator('.histogram rect').last().click();
    await waitForFrame(page, { selection: 'face:5' });
    await page.getByLabel('Lowest value').fill('1.5');
    await page.getByLabel('Lowest value').press('Tab');
    await page.getByLabel('Highest value').fill('3');
    await page.getByLabel('Highest value').press('Tab');
    await page.getByRole('button', { name: 'Select what is in the range' }).click();
    await waitForFrame(page, { selection: 'face:2 face:3' });
    assert.equal(await page.locator('#colour-said').textContent(), '2 faces selected.');
});

// --- what operations offer ---

const SHIFT = { op: 'transform', matrix: [1, 0, 0, 0.25, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1] };

test('a comparison leads to colours by the deviation in one click', async (t) => {
    const { daemon, mesh, page } = await openMesh(t, CUBE);
    await post(daemon, `/${mesh}/edits`, SHIFT);
    await waitForFrame(page, { mesh, revision: 2 });
    await page.getByLabel('Revision to compare with').fill('1');
    await page.getByRole('button', { name: 'Compare' }).click();
    await page.getByRole('button', { name: 'Colour by the deviation' }).click();
    await waitForColor(page, 'attribute/vertices/deviation 3');
    assert.equal(await page.locator('#compare-result dd').first().textContent(), '0.25', 'it stays');
    const values = (await getAll(daemon, mesh, 'vertices')).map(({ attributes }) => attributes.deviation);
    assert.deepEqual([Math.min(...values), Math.max(...values)], [0, 0.25]);
    assert.equal(await page.getByLabel('Highest value').inputValue(), '0.25');
    await checkAccessible(page, 'deviation');
});

test('the form of deviation takes an earlier revision, and then offers the colours', async (t) => {
    const { daemon, mesh, page } = await openMesh(t, CUBE);
    await post(daemon, `/${mesh}/edits`, SHIFT);
    await waitForFrame(page, { mesh, revision: 2 });
    await chooseOperation(page, 'deviation');
    await page.getByLabel('with: mesh').selectOption('an earlier revision');
    await checkAccessible(page, 'a field for a revision');
    await page.getByLabel('with: revision').fill('1');
    await page.getByRole('button', { name: 'Apply' }).click();
    await waitForFrame(page, { mesh, revision: 3 });
    await page.locator('#toasts').getByRole('button', { name: 'Colour by the deviation' }).click();
    await waitForColor(page, 'attribute/vertices/deviation 3');
    const [{ ops }] = (await get(daemon, `/${mesh}/edits`)).entries;
    assert.ok(JSON.stringify(ops).includes('deviation'));
});

test('segment offers colours by patch, remesh by quality, and decimate by deviation', async (t) => {
    const { page, mesh } = await openMesh(t, { name: 'ball', shape: 'icosphere', subdivisions: 2 });
    const apply = async (operation, fields) => {
        await chooseOperation(page, operation);
        for (const [name, value] of Object.entries(fields)) {
            await page.locator(`#param-${name}`).fill(value);
        }
        await page.getByRole('button', { name: 'Apply' }).click();
    };
    const offer = (name) => page.locator('#toasts').getByRole('button', { name });
    await apply('segment', { angle: '35' });
    await waitForTold(page, /divided into/);
    await offer('Colour by patch').click();
    await waitForColor(page, 'attribute/faces/patch 2');
    await apply('remesh', { edge_length: '0.3' });
    await waitForFrame(page, { mesh, revision: 3 });
    await offer('Colour by the smallest angle').click();
    await waitForColor(page, 'measure/faces/smallest_angle 3');
    await apply('decimate', { faces: '100' });
    await waitForFrame(page, { mesh, revision: 4 });
    await offer('Colour by the deviation').click();
    await waitForColor(page, 'attribute/vertices/deviation 5');
    await waitForFrame(page, { mesh, revision: 5 });
});

test('on a phone of 320 pixels, the legend fits', async (t) => {
    const { page } = await openMesh(t, CUBE, { viewport: { width: 320, height: 640 } });
    await colorBy(page, 'measure/faces/area', 1);
    assert.equal(await page.evaluate(() => document.documentElement.scrollWidth), 320);
    const key = await page.locator('#colour-key').boundingBox();
    assert.ok(key.x >= 0 && key.x + key.width <= 320);
    await checkAccessible(page, 'colours on a phone');
});
