// Tests of the tools that select many elements: hovering, boxes, lassos and the brush, changes of the
// selection, loops and rings, and named sets, in Chromium with the real daemon.

import assert from 'node:assert/strict';
import { test } from 'node:test';

import { checkAccessible, isChosen, projector, readCanvas, waitForFrame, waitForTold } from './browser.mjs';
import { get, getAll, post } from './daemon.mjs';
import { chooseOperation, click, goTo, isEdit, press, setMode } from './page.mjs';
import { openMesh } from './visit.mjs';

const GRID = { name: 'grid', shape: 'grid', columns: 6, rows: 6 };
const TORUS = { name: 'ring', shape: 'torus', major_segments: 12, minor_segments: 8 };
const CUBE = { name: 'cube', shape: 'cube' };
const LARGE = { name: 'large', shape: 'grid', columns: 40, rows: 40 };

const button = (page, name) => page.locator(`#select-${name}`);
const textOf = (page) => page.locator('#select-said').textContent();

// Drags the pointer along places on the canvas.
async function drag(page, places, during = () => {}) {
    const box = await page.locator('#canvas').boundingBox();
    const [first, ...rest] = places.map(({ x, y }) => [box.x + x, box.y + y]);
    await page.mouse.move(...first);
    await page.mouse.down();
    for (const place of rest) {
        await page.mouse.move(...place);
    }
    await during();
    await page.mouse.up();
}

const expectSelection = (page, kind, ids) =>
    waitForFrame(page, { selection: ids.map((id) => `${kind}:${id}`).join(' ') });

const meanOf = (places) => ({
    x: places.reduce((sum, { x }) => sum + x, 0) / places.length,
    y: places.reduce((sum, { y }) => sum + y, 0) / places.length,
});

// Returns a box around some places on the canvas, as two opposite corners.
function boxAround(places, gap) {
    const [xs, ys] = [places.map(({ x }) => x), places.map(({ y }) => y)];
    return [
        { x: Math.min(...xs) - gap, y: Math.min(...ys) - gap },
        { x: Math.max(...xs) + gap, y: Math.max(...ys) + gap },
    ];
}

const isInBox = ({ x, y }, [low, high]) => x > low.x && x < high.x && y > low.y && y < high.y;

// The middles of elements on the canvas, by the vertices of each element.
const middlesOf = (place, elements) =>
    elements.map(({ id, vertices }) => ({ id, at: place.at(vertices ?? [id]) }));

test('the element under the pointer is outlined, of the kind that clicks pick', async (t) => {
    const { daemon, mesh, page } = await openMesh(t, GRID);
    const place = await projector(page, daemon, mesh);
    const face = await get(daemon, `/${mesh}/faces/14`);
    const line = page.locator('#hover-line');
    const box = await page.locator('#canvas').boundingBox();
    const moveTo = ({ x, y }) => page.mouse.move(box.x + x, box.y + y);
    for (const [mode, kind, at] of [
        ['Face', 'face', face.vertices],
        ['Edge', 'edge', face.vertices.slice(0, 2)],
        ['Vertex', 'vertex', face.vertices.slice(0, 1)],
        ['Half-edge', 'halfedge', face.vertices.slice(0, 2)],
    ]) {
        await setMode(page, mode);
        await moveTo({ x: 5, y: 5 });
        assert.equal(await line.getAttribute('d'), '');
        await moveTo(place.at(at));
        await page.locator(`#hover-line[data-kind="${kind}"]`).waitFor({ state: 'attached' });
        const outline = await line.evaluate((path) => {
            const { x, y, width, height } = path.getBBox();
            return { x: x + width / 2, y: y + height / 2 };
        });
        const middle = place.at(at);
        if (kind !== 'face') {
            assert.ok(Math.hypot(outline.x - middle.x, outline.y - middle.y) < 3, kind);
        }
    }
    // The outline is seen, is not part of the selection, and stays on the element when it moves.
    await setMode(page, 'Face');
    await moveTo(place.at(face.vertices));
    await page.locator('#hover-line[data-kind="face"]').waitFor({ state: 'attached' });
    const isOutline = ([r, g, b]) => r > 200 && g > 225 && b < 150;
    assert.ok((await readCanvas(page)).countOf(isOutline) > 60);
    const before = await line.getAttribute('d');
    await page.locator('#canvas').focus();
    await page.keyboard.press('+');
    await page.waitForFunction((old) => document.getElementById('hover-line').getAttribute('d') !== old, before);
    await waitForFrame(page, { selection: '' });
    await checkAccessible(page, 'hovering', '.stage');
    await moveTo({ x: 5, y: 5 });
    assert.equal((await readCanvas(page)).countOf(isOutline), 0);
});

test('a box selects exactly the elements whose middle is inside', async (t) => {
    const { daemon, mesh, page } = await openMesh(t, GRID);
    const place = await projector(page, daemon, mesh);
    const faces = await getAll(daemon, mesh, 'faces');
    const half = faces.filter(({ centroid }) => centroid[0] < 0);
    assert.equal(half.length, 18);
    for (const [mode, kind, plural] of [
        ['Face', 'face', 'faces'],
        ['Edge', 'edge', 'edges'],
        ['Vertex', 'vertex', 'vertices'],
    ]) {
        await setMode(page, mode);
        const elements = middlesOf(place, await getAll(daemon, mesh, plural));
        const middles = middlesOf(place, half).map(({ at }) => at);
        const box = boxAround(middles, 3);
        const wanted = elements.filter(({ at }) => isInBox(at, box)).map(({ id }) => id);
        await button(page, 'box').click();
        await drag(page, box, () => checkAccessible(page, `a box around ${plural}`, '.stage'));
        await expectSelection(page, kind, wanted.sort((a, b) => a - b));
        const counts = (await get(daemon, `/${mesh}`)).counts;
        assert.match(await textOf(page), new RegExp(`^${wanted.length} ${plural} of ${counts[plural]}`));
        await page.locator('#select-done').click();
    }
});

test('a lasso around one half of a grid selects exactly its faces, Shift adds, Ctrl removes', async (t) => {
    const { daemon, mesh, page } = await openMesh(t, GRID);
    const place = await projector(page, daemon, mesh);
    const faces = await getAll(daemon, mesh, 'faces');
    const idsOf = (test) => faces.filter(({ centroid }) => test(centroid)).map(({ id }) => id);
    // The corners of a part of the grid, which a little larger lasso goes around.
    const around = (x0, x1) =>
        [[x0, -0.5], [x1, -0.5], [x1, 0.5], [x0, 0.5], [x0, -0.5]].map(([x, y]) => place.atPlace([x, y, 0]));
    await press(page, 'l');
    assert.equal(await button(page, 'lasso').getAttribute('aria-pressed'), 'true');
    await drag(page, around(-0.5, 0));
    const left = idsOf(([x]) => x < 0);
    await expectSelection(page, 'face', left);
    assert.match(await textOf(page), /^18 faces of 36, area 0\.5$/);
    await page.keyboard.down('Shift');
    await drag(page, around(1 / 6, 1 / 3));
    await page.keyboard.up('Shift');
    const strip = idsOf(([x]) => x > 1 / 6 && x < 1 / 3);
    await expectSelection(page, 'face', [...left, ...strip].sort((a, b) => a - b));
    await page.keyboard.down('Control');
    await drag(page, around(-1 / 3, -1 / 6));
    await page.keyboard.up('Control');
    const gone = idsOf(([x]) => x > -1 / 3 && x < -1 / 6);
    const rest = [...left, ...strip].filter((id) => !gone.includes(id));
    await expectSelection(page, 'face', rest.sort((a, b) => a - b));
    // What is selected is painted, and what is not is not.
    await page.keyboard.press('Escape');
    assert.ok(await page.locator('#select-note').isHidden());
    const picture = await readCanvas(page);
    for (const { id, at } of middlesOf(place, faces)) {
        if (id !== rest.at(-1)) {
            assert.equal(isChosen(picture.colour(at.x, at.y)), rest.includes(id), `face ${id}`);
        }
    }
    // The choice in the panel does what the keys do.
    await button(page, 'how').selectOption('remove');
    await button(page, 'lasso').click();
    await drag(page, around(-0.5, 0));
    await expectSelection(page, 'face', strip);
});

test('what is hidden is selected only through the mesh', async (t) => {
    const { daemon, mesh, page } = await openMesh(t, CUBE);
    const place = await projector(page, daemon, mesh);
    const faces = await getAll(daemon, mesh, 'faces');
    const seen = faces.filter((face) => place.isSeen(face)).map(({ id }) => id);
    assert.equal(seen.length, 3);
    const { width, height } = await page.locator('#canvas').boundingBox();
    const all = [{ x: 4, y: 4 }, { x: width - 4, y: height - 4 }];
    await button(page, 'box').click();
    await drag(page, all);
    await expectSelection(page, 'face', seen);
    await page.locator('#select-through').check();
    await drag(page, all);
    await expectSelection(page, 'face', faces.map(({ id }) => id));
    // Of the eight corners one is hidden.
    await page.locator('#select-through').uncheck();
    await page.locator('#select-done').click();
    await setMode(page, 'Vertex');
    await button(page, 'box').click();
    await drag(page, all);
    await page.waitForFunction(
        () => document.getElementById('canvas').dataset.selection.split(' ').length === 7,
    );
    assert.equal(await textOf(page), '7 vertices of 8');
});

test('the brush paints faces, as wide as it is set, and is seen while it paints', async (t) => {
    const { daemon, mesh, page } = await openMesh(t, GRID);
    const place = await projector(page, daemon, mesh);
    const faces = middlesOf(place, await getAll(daemon, mesh, 'faces'));
    await press(page, 'd');
    await page.locator('#brush-size').fill('3');
    const row = faces.slice(12, 18);
    await drag(page, row.map(({ at }) => at), async () => {
        await page.waitForFunction(() => document.getElementById('brush-ring').getAttribute('r') === '3');
        await checkAccessible(page, 'painting', '.stage');
        while ((await readCanvas(page)).countOf(isChosen) < 1000);
        // The selection changes only when the stroke ends.
        await waitForFrame(page, { selection: '' });
    });
    await expectSelection(page, 'face', row.map(({ id }) => id));
    await page.locator('#brush-size').fill('120');
    await drag(page, [faces[0].at, faces[0].at]);
    const near = (at) => Math.hypot(at.x - faces[0].at.x, at.y - faces[0].at.y) < 110;
    const sure = faces.filter(({ at }) => near(at)).map(({ id }) => id);
    await page.waitForFunction((ids) => {
        const chosen = document.getElementById('canvas').dataset.selection.split(' ');
        return ids.every((id) => chosen.includes(`face:${id}`)) && !chosen.includes('face:17');
    }, sure);
    // Esc ends painting, so that a drag turns the camera again.
    await page.keyboard.press('Escape');
    assert.equal(await button(page, 'paint').getAttribute('aria-pressed'), 'false');
    const before = page.url();
    await drag(page, [{ x: 20, y: 20 }, { x: 80, y: 40 }]);
    await page.locator('#canvas:not([data-moving])').waitFor();
    assert.notEqual(page.url(), before);
});

test('a finger draws a box', async (t) => {
    const { daemon, mesh, page } = await openMesh(t, GRID, {
        hasTouch: true,
        viewport: { width: 390, height: 800 },
    });
    const place = await projector(page, daemon, mesh);
    const faces = middlesOf(place, await getAll(daemon, mesh, 'faces'));
    const corners = boxAround(faces.slice(0, 2).map(({ at }) => at), 2);
    const wanted = faces.filter(({ at }) => isInBox(at, corners)).map(({ id }) => id);
    await button(page, 'box').tap();
    await checkAccessible(page, 'a box on a telephone');
    const box = await page.locator('#canvas').boundingBox();
    const session = await page.context().newCDPSession(page);
    const touch = (type, points) =>
        session.send('Input.dispatchTouchEvent', {
            type,
            touchPoints: points.map(({ x, y }) => ({ x: box.x + x, y: box.y + y })),
        });
    await touch('touchStart', [corners[0]]);
    await touch('touchMove', [meanOf(corners)]);
    await touch('touchMove', [corners[1]]);
    await touch('touchEnd', []);
    await expectSelection(page, 'face', wanted);
});

test('the selection grows, shrinks, and is inverted, by buttons and by keys', async (t) => {
    const { page } = await openMesh(t, { ...GRID, columns: 9, rows: 9 });
    for (const name of ['grow', 'shrink', 'invert', 'connected', 'around', 'loop', 'ring']) {
        assert.ok(await button(page, name).isDisabled(), name);
    }
    await goTo(page, 'face', 40);
    await button(page, 'grow').click();
    const nine = [30, 31, 32, 39, 40, 41, 48, 49, 50];
    await expectSelection(page, 'face', nine);
    await press(page, ']');
    await page.waitForFunction(() => document.getElementById('select-said').textContent.startsWith('25 faces'));
    await waitForFrame(page, { revision: 1 });
    await press(page, '[');
    await expectSelection(page, 'face', nine);
    await press(page, 'y');
    await page.waitForFunction(() => document.getElementById('select-said').textContent.startsWith('72 faces'));
    await button(page, 'invert').click();
    await expectSelection(page, 'face', nine);
    await button(page, 'boundary').click();
    await page.waitForFunction(() => document.getElementById('select-said').textContent.startsWith('12 edges'));
    assert.match(await textOf(page), /^12 edges of 180, length 1\.3333$/);
    assert.ok(await page.getByRole('radio', { name: 'Edge', exact: true }).isChecked());
    await press(page, 'k');
    await page.waitForFunction(() => document.getElementById('select-said').textContent.startsWith('180 edges'));
    await press(page, 'Escape');
    await waitForFrame(page, { selection: '' });
    await setMode(page, 'Face');
    await press(page, 'a');
    await page.waitForFunction(() => document.getElementById('select-said').textContent.startsWith('81 faces'));
    await checkAccessible(page, 'all selected');
});

test('faces are selected up to sharper edges than the angle in the field', async (t) => {
    const { daemon, mesh, page } = await openMesh(t, { name: 'can', shape: 'cylinder', segments: 24 });
    const faces = await getAll(daemon, mesh, 'faces');
    const sides = faces.filter(({ vertices }) => vertices.length === 4).map(({ id }) => id);
    await goTo(page, 'face', sides[3]);
    await page.locator('#select-angle').fill('14');
    await page.locator('#select-angle').press('Enter');
    await waitForFrame(page, { revision: 1, selection: `face:${sides[3]}` });
    await page.locator('#select-angle').fill('16');
    await button(page, 'around').click();
    await expectSelection(page, 'face', sides);
});

test('the loop of an edge of a torus closes, and so does its ring', async (t) => {
    const { daemon, mesh, page } = await openMesh(t, TORUS);
    const place = await projector(page, daemon, mesh);
    const edges = await getAll(daemon, mesh, 'edges');
    await goTo(page, 'edge', 0);
    const expectCount = (count) =>
        page.waitForFunction(
            (wanted) => document.getElementById('canvas').dataset.selection.split(' ').length === wanted,
            count,
        );
    // A torus of 12 x 8 quads has loops of 12 edges around the hole and of 8 around the tube.
    const selected = async () => {
        const ids = await page.locator('#canvas').evaluate(({ dataset }) =>
            dataset.selection.split(' ').map((word) => Number(word.split(':')[1])),
        );
        return ids.map((id) => edges.find((edge) => edge.id === id));
    };
    await button(page, 'loop').click();
    await page.waitForFunction(
        () => document.getElementById('canvas').dataset.selection.split(' ').length > 1,
    );
    const loop = await selected();
    const degrees = new Map();
    loop.flatMap(({ vertices }) => vertices).forEach((id) => degrees.set(id, (degrees.get(id) ?? 0) + 1));
    assert.ok([...degrees.values()].every((degree) => degree === 2), 'the loop is closed');
    assert.equal(degrees.size, loop.length);
    await goTo(page, 'edge', 0);
    await press(page, 'r');
    await expectCount(loop.length === 12 ? 8 : 12);
    const ring = await selected();
    const ends = ring.flatMap(({ vertices }) => vertices);
    assert.equal(new Set(ends).size, ends.length, 'edges of a ring share no vertex');
    // With the mouse: Alt and a click selects the loop of the edge under the pointer, and Ctrl its ring.
    await press(page, 'Escape');
    await waitForFrame(page, { selection: '' });
    await setMode(page, 'Edge');
    await page.getByRole('button', { name: 'Fit view' }).click();
    // An edge at the top of the torus is hidden by nothing.
    const points = (await getAll(daemon, mesh, 'vertices')).map(({ position }) => position);
    const heightOf = ({ vertices }) => Math.min(...vertices.map((id) => points[id][2]));
    const seen = edges.reduce((best, edge) => (heightOf(edge) > heightOf(best) ? edge : best));
    await click(page, place.at(seen.vertices), ['Alt']);
    await page.waitForFunction(
        (id) => document.getElementById('canvas').dataset.selection.split(' ').includes(`edge:${id}`),
        seen.id,
    );
    const first = (await selected()).length;
    assert.ok(first === 12 || first === 8);
    await click(page, place.at(seen.vertices), ['Alt', 'Control']);
    await expectCount(20 - first);
    // If clicks pick faces, the strip of faces between the edges of the ring is selected.
    await setMode(page, 'Face');
    await click(page, place.at(seen.vertices), ['Alt']);
    await page.waitForFunction(
        (count) => document.getElementById('select-said').textContent.startsWith(`${count} faces`),
        20 - first,
    );
});

test('a set is saved, chosen again, used in a form, and deleted', async (t) => {
    const { daemon, mesh, page } = await openMesh(t, GRID, { allowed: [/status of 4\d\d/] });
    await goTo(page, 'face', 14);
    await button(page, 'grow').click();
    const nine = [7, 8, 9, 13, 14, 15, 19, 20, 21];
    await expectSelection(page, 'face', nine);
    await page.locator('#set-name').fill('lid');
    await page.locator('#set-save').click();
    await waitForFrame(page, { revision: 2 });
    const values = async (name) => (await get(daemon, `/${mesh}/attributes/faces/${name}`)).values;
    assert.deepEqual((await values('lid')).flatMap((one, id) => (one ? [id] : [])), nine);
    await waitForTold(page, /“lid” has 9 faces/);
    const row = page.locator('#sets .set');
    await row.waitFor();
    assert.equal(await row.count(), 1);
    await press(page, 'Escape');
    await waitForFrame(page, { selection: '' });
    await row.click();
    await expectSelection(page, 'face', nine);
    await checkAccessible(page, 'a named set', '#details');
    // Edges have ids that the page must ask for.
    await button(page, 'boundary').click();
    await page.waitForFunction(() => document.getElementById('select-said').textContent.startsWith('12 edges'));
    await page.locator('#set-name').fill('rim');
    await page.locator('#set-save').click();
    await waitForFrame(page, { revision: 3 });
    const rim = (await get(daemon, `/${mesh}/attributes/edges/rim`)).values;
    const edges = await getAll(daemon, mesh, 'edges');
    for (const { id, faces } of edges) {
        const [a, b] = faces.map((face) => nine.includes(face));
        assert.equal(rim[id], a !== b, `edge ${id}`);
    }
    assert.deepEqual(
        await page.locator('#sets-faces option').evaluateAll((options) => options.map(({ value }) => value)),
        ['the selection', 'lid'],
    );
    // The name of an attribute that is no set is refused, and the attribute stays as it is.
    const put = await fetch(`${daemon.url}/v1/meshes/${mesh}/attributes/edges/weight`, {
        method: 'PUT',
        headers: { 'Content-Type': 'application/json' },
        body: JSON.stringify({ type: 'double' }),
    });
    assert.equal(put.status, 201);
    await waitForFrame(page, { revision: 4 });
    await page.locator('#set-name').fill('weight');
    await page.locator('#set-save').click();
    await page.getByRole('alert').filter({ hasText: 'weight is an attribute of type double' }).waitFor();
    assert.equal((await get(daemon, `/${mesh}`)).revision, 4);
    await chooseOperation(page, 'face_delete');
    await page.locator('#param-face').fill('lid');
    const sent = page.waitForRequest(isEdit);
    await page.locator('#parameters').getByRole('button', { name: 'Apply' }).click();
    assert.deepEqual((await sent).postDataJSON().ops[0].faces, { lid: true });
    await waitForFrame(page, { revision: 5 });
    assert.equal((await get(daemon, `/${mesh}`)).counts.faces, 36 - 9);
    await page.getByRole('button', { name: 'Delete the set lid of faces' }).click();
    await waitForFrame(page, { revision: 6 });
    await page.waitForFunction(() => document.querySelectorAll('#sets .set').length === 1);
});

test('more elements than are read are selected, drawn, counted, and edited', async (t) => {
    // A dry run of the form may name a face that the other client has just deleted.
    const { daemon, mesh, page } = await openMesh(t, LARGE, { allowed: [/status of 422/] });
    await press(page, 'a');
    await waitForFrame(page, { selection: '1600 faces' });
    assert.equal(await page.locator('#element-title').textContent(), '1,600 faces');
    assert.equal(await textOf(page), '1,600 faces of 1,600, area 1');
    assert.ok((await readCanvas(page)).countOf(isChosen) > 50000);
    await chooseOperation(page, 'face_inset');
    assert.equal(await page.locator('#param-face').inputValue(), 'the selection');
    await page.locator('#param-factor').fill('0.5');
    await page.locator('#verdict').filter({ hasText: 'Would make' }).waitFor();
    const sent = page.waitForRequest(isEdit);
    await page.locator('#parameters').getByRole('button', { name: 'Apply' }).click();
    assert.equal((await sent).postDataJSON().ops[0].faces.length, 1600);
    await waitForFrame(page, { revision: 2 });
    const { counts } = await get(daemon, `/${mesh}`);
    assert.equal(counts.faces, 1600 * 5);
    await waitForTold(page, /1,600 to 8,000 faces/);
    // The selection stays while another client edits the mesh, but for what the edit deletes.
    const { revision } = await post(daemon, `/${mesh}/edits`, { op: 'face_delete', faces: [0, 1, 2] });
    await waitForFrame(page, { revision, selection: '1597 faces' });
    await page.getByRole('button', { name: 'Delete', exact: true }).click();
    await waitForFrame(page, { revision: revision + 1, selection: '' });
    assert.equal((await get(daemon, `/${mesh}`)).counts.faces, 8000 - 1600);
});

test('edges that were drawn around are named by their ids when an edit takes them', async (t) => {
    const { daemon, mesh, page } = await openMesh(t, LARGE);
    await setMode(page, 'Edge');
    await press(page, 'a');
    await waitForFrame(page, { selection: '3280 edges' });
    assert.equal(await textOf(page), '3,280 edges of 3,280, length 82');
    await page.locator('#set-name').fill('every');
    await page.locator('#set-save').click();
    await waitForFrame(page, { revision: 2 });
    const { values } = await get(daemon, `/${mesh}/attributes/edges/every?limit=10000`);
    assert.equal(values.filter(Boolean).length, 3280);
    await press(page, 'Escape');
    await waitForFrame(page, { selection: '' });
    await page.locator('#sets .set').click();
    await waitForFrame(page, { selection: '3280 edges' });
});
