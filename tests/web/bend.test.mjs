// Tests that the tool Move bends what is around: which vertices stay, that the newest position wins,
// and in Chromium what is drawn while a part is dragged, the edit at the end, and giving up.

import assert from 'node:assert/strict';
import { test } from 'node:test';

import { Bend, placesOf } from '../../web/src/bend/bend.js';
import { unpack } from '../../web/src/geometry/geometry.js';
import { heldAround, neighboursOf, waysFrom } from '../../web/src/bend/ways.js';
import { checkAccessible, isChosen, projector, readCanvas, waitForFrame } from './browser.mjs';
import { get, getAll, getGeometry, post, startDaemon } from './daemon.mjs';
import { click, isEdit, press, setMode } from './page.mjs';
import { openMesh } from './visit.mjs';

const GRID = { name: 'sheet', shape: 'grid', columns: 20, rows: 20 };
const MIDDLE = 220; // the vertex in the middle of the grid

// --- which vertices stay ---

test('ways along edges are those of the sheet, and lead nowhere else', async (t) => {
    const daemon = await startDaemon(t);
    const { id: mesh } = await post(daemon, '', GRID);
    const ops = [{ op: 'vertex_add', position: [0, 0, 9] }];
    await post(daemon, `/${mesh}/edits`, { ops });
    const geometry = unpack(await getGeometry(daemon, mesh));
    const vertices = await getAll(daemon, mesh, 'vertices');
    const ways = waysFrom(geometry, [MIDDLE]);
    const { starts, ends } = neighboursOf(geometry);
    assert.equal(ways[MIDDLE], 0);
    assert.equal(ways[441], Infinity);
    for (const { id, position } of vertices.slice(0, 441)) {
        const straight = Math.hypot(...vertices[MIDDLE].position.map((x, i) => x - position[i]));
        assert.ok(ways[id] >= straight * geometry.frame.scale - 1e-6, `vertex ${id}`);
        assert.ok(ways[id] <= straight * geometry.frame.scale * 1.5, `vertex ${id}`);
        assert.ok(starts[id + 1] - starts[id] >= 2 && !ends.subarray(starts[id], starts[id + 1]).includes(id));
    }
});

test('the vertices that stay separate what bends from the rest', async (t) => {
    const daemon = await startDaemon(t);
    const { id: mesh } = await post(daemon, '', GRID);
    const geometry = unpack(await getGeometry(daemon, mesh));
    const { starts, ends } = neighboursOf(geometry);
    const count = (reach) => {
        const held = new Set(heldAround(geometry, [MIDDLE], reach));
        const reached = new Set([MIDDLE]);
        for (const at of reached) {
            for (const next of ends.subarray(starts[at], starts[at + 1])) {
                if (!held.has(next)) {
                    reached.add(next);
                }
            }
        }
        return { held: held.size, bent: reached.size };
    };
    const [near, far, all] = [0.2, 0.6, 1].map(count);
    assert.ok(near.bent < far.bent && far.bent < all.bent, `${near.bent}, ${far.bent}, ${all.bent}`);
    assert.ok(near.bent > 1 && all.bent < 441 && all.bent > 400);
    assert.ok([near, far, all].every(({ held }) => held > 0 && held < 80));
    const everything = [...Array(441).keys()];
    assert.deepEqual(heldAround(geometry, everything, 0.3), []);
});

// --- one request at a time ---

// Stands for an element of the page.
function element(members = {}) {
    const listeners = {};
    return {
        ...members,
        addEventListener: (type, listen) => (listeners[type] = listen),
        setAttribute() {},
        send: (type) => listeners[type](),
    };
}

function makeBend(geometry, ask) {
    const elements = {
        box: element({ hidden: true }),
        toggle: element({ checked: true }),
        row: element({ hidden: false }),
        radius: element({ value: '30' }),
        reach: element(),
        said: element(),
    };
    const shown = [];
    const acts = { geometry: () => geometry, ask, show: (...what) => shown.push(what) };
    return { bend: new Bend(elements, acts), elements, shown };
}

const MOVE = { operation: { op: 'vertex_move', vertices: [0], by: [0, 0, 0] }, lines: [1], text: '' };
const moveBy = (x) => ({ ...MOVE, operation: { ...MOVE.operation, by: [x, 0, 0] } });
const TRIANGLE = {
    vertices: new Float32Array([0, 0, 0, 1, 1, 0, 0, 1, 0, 1, 0, 1]),
    triangles: new Uint32Array([0, 1, 2, 7 << 29]),
    vertexCount: 3,
    triangleCount: 1,
    frame: { origin: [1, 2, 3], scale: 2 },
};
const settled = () => new Promise((resolve) => setImmediate(resolve));

test('steps are fetched one at a time, and the newest position wins', async () => {
    const asked = [];
    const { bend, shown } = makeBend(TRIANGLE, ({ by }) => {
        return new Promise((resolve) => asked.push({ x: by[0], resolve }));
    });
    bend.offer(true);
    for (const x of [1, 2, 3, 4]) {
        const { operation, lines } = bend.follow(moveBy(x));
        assert.deepEqual([operation.op, operation.by[0], lines.length], ['deform', x, 0]);
    }
    assert.deepEqual(asked.map(({ x }) => x), [1]);
    shown.length = 0;
    asked[0].resolve({ ids: new Uint32Array([0]), positions: new Float64Array([1, 2, 4]) });
    await settled();
    assert.deepEqual(shown, [[new Uint32Array([0]), new Float32Array([0, 0, 2])]]);
    assert.deepEqual(asked.map(({ x }) => x), [1, 4]);
    bend.end();
    bend.cancel();
    assert.equal(shown.length, 1, 'what is shown stays until the edit has been made');
    bend.settle();
    assert.deepEqual(shown.at(-1), [null]);
    asked[1].resolve({ ids: new Uint32Array([0]), positions: new Float64Array([9, 9, 9]) });
    await settled();
    assert.equal(shown.length, 2, 'an answer that comes later is not shown');
});

test('nothing bends unless it is wanted and a part is moved', () => {
    const { bend, elements } = makeBend(TRIANGLE, () => assert.fail('nothing is asked'));
    assert.equal(bend.follow(moveBy(1)).operation.op, 'vertex_move');
    bend.offer(true);
    elements.toggle.checked = false;
    assert.equal(bend.follow(moveBy(1)).operation.op, 'vertex_move');
    elements.toggle.checked = true;
    const still = { ...MOVE, operation: null };
    assert.equal(bend.follow(still), still);
    bend.end();
    elements.toggle.checked = true;
    const whole = moveBy(1);
    whole.operation.vertices = [0, 1, 2];
    assert.equal(bend.follow(whole), whole, 'a move of the whole mesh is a plain move');
});

test('a drag that begins before the edit of the last one has been made is another drag', async () => {
    const asked = [];
    const { bend, shown } = makeBend(TRIANGLE, ({ vertices }, signal) => {
        return new Promise(() => asked.push({ vertices, signal }));
    });
    bend.offer(true);
    bend.follow(moveBy(1));
    bend.end();
    const next = moveBy(2);
    next.operation.vertices = [1];
    assert.deepEqual(bend.follow(next).operation.vertices, [1]);
    assert.deepEqual(asked.map(({ vertices }) => vertices), [[0], [1]]);
    assert.deepEqual(asked.map(({ signal }) => signal.aborted), [true, false]);
    assert.deepEqual(shown, [[null]]);
    bend.settle();
    assert.equal(asked[1].signal.aborted, false, 'the edit of the first drag does not end the second one');
});

test('a refusal is shown, and the next position is tried', async () => {
    let fails = true;
    const { bend, elements, shown } = makeBend(TRIANGLE, async () => {
        if (fails) {
            throw new Error('vertex 0 is locked');
        }
        return { ids: new Uint32Array(0), positions: new Float64Array(0) };
    });
    bend.offer(true);
    bend.follow(moveBy(1));
    await settled();
    assert.equal(elements.said.textContent, 'vertex 0 is locked');
    fails = false;
    bend.follow(moveBy(2));
    await settled();
    assert.equal(elements.said.textContent, '');
    bend.cancel();
    assert.deepEqual(shown.at(-1), [null]);
});

test('places are in the coordinates of the view', () => {
    assert.deepEqual(placesOf([1, 2, 3, 2, 2, 2.5], TRIANGLE.frame), new Float32Array([0, 0, 0, 2, 0, -1]));
});

// --- in the page ---

const START = [60, 60];

// Selects the vertex in the middle, turns bending on and drags by some pixels without releasing.
// Returns the place of the vertex before. It is picked by a click, which does not move the camera.
async function beginDrag({ daemon, mesh, page }, by) {
    const from = (await projector(page, daemon, mesh)).at([MIDDLE]);
    // A selection that comes later would put the tool down, so nothing is selected at first.
    await press(page, 'Escape');
    await waitForFrame(page, { selection: '' });
    await setMode(page, 'Vertex');
    await click(page, from);
    await waitForFrame(page, { selection: `vertex:${MIDDLE}` });
    await page.locator('#canvas').focus();
    await press(page, 'g');
    await page.getByLabel('Bend the surface around it').check();
    const box = await page.locator('#canvas').boundingBox();
    const [x, y] = [box.x + START[0], box.y + START[1]];
    await page.mouse.move(x, y);
    await page.mouse.down();
    await page.mouse.move(x + by[0] / 2, y + by[1] / 2);
    await page.mouse.move(x + by[0], y + by[1]);
    return from;
}

// Waits until the canvas passes a test of its pixels, for some thousand frames.
async function waitForPicture(page, what, test) {
    for (let frame = 0; frame < 3000; frame++) {
        if (test(await readCanvas(page))) {
            return;
        }
        await page.evaluate(() => new Promise(requestAnimationFrame));
    }
    assert.fail(`the view does not show ${what}`);
}

// Returns where an operation deform would move vertices, by id.
async function previewOf(daemon, mesh, operation) {
    const answer = await fetch(`${daemon.url}/v1/meshes/${mesh}/deform`, {
        method: 'POST',
        headers: { 'Content-Type': 'application/json' },
        body: JSON.stringify(operation),
    });
    assert.equal(answer.status, 200);
    const bytes = await answer.arrayBuffer();
    const count = bytes.byteLength / 28;
    const positions = new Float64Array(bytes, 0, 3 * count);
    const ids = [...new Uint32Array(bytes, 24 * count, count)];
    return new Map(ids.map((id, i) => [id, [...positions.subarray(3 * i, 3 * i + 3)]]));
}

const positionsOf = async (daemon, mesh) =>
    (await getAll(daemon, mesh, 'vertices')).map(({ position }) => position);

test('a drag shows the bent mesh before there is an edit, and the edit is one step', async (t) => {
    const context = await openMesh(t, GRID);
    const { daemon, mesh, page } = context;
    const before = await positionsOf(daemon, mesh);
    const [asked, edits] = [[], []];
    page.on('request', (request) => {
        if (request.url().endsWith('/deform')) {
            asked.push(request.postDataJSON());
        } else if (isEdit(request)) {
            edits.push(request.postDataJSON());
        }
    });
    const from = await beginDrag(context, [80, -50]);
    await waitForPicture(
        page,
        'the moved vertex',
        (canvas) =>
            isChosen(canvas.colour(from.x + 80, from.y - 50)) && !isChosen(canvas.colour(from.x, from.y)),
    );
    await checkAccessible(page, 'bending');
    assert.equal((await get(daemon, `/${mesh}`)).revision, 1);
    assert.equal(edits.length, 0);
    assert.ok(asked.length >= 1);
    const moved = await previewOf(daemon, mesh, asked.at(-1));
    assert.ok(moved.size > 20 && moved.size < 441, `${moved.size} vertices follow`);
    await page.mouse.up();
    await waitForFrame(page, { mesh, revision: 2 });
    assert.equal(edits.length, 1);
    const [operation] = edits[0].ops;
    assert.deepEqual([operation.op, operation.vertices], ['deform', [MIDDLE]]);
    assert.deepEqual(operation, asked.at(-1));
    const after = await positionsOf(daemon, mesh);
    assert.deepEqual(after, before.map((position, id) => moved.get(id) ?? position));
    assert.equal(await page.locator('#bend').isVisible(), false);
    const drawn = await page.evaluate(() => [...document.querySelector('#canvas').geometry.vertices]);
    const { frame } = unpack(await getGeometry(daemon, mesh));
    after.flat().forEach((value, i) => {
        const [id, axis] = [Math.floor(i / 3), i % 3];
        const wanted = (value - frame.origin[axis]) * frame.scale;
        assert.ok(Math.abs(drawn[4 * id + axis] - wanted) < 1e-5, `vertex ${id}`);
    });
    await press(page, 'Control+z');
    await waitForFrame(page, { mesh, revision: 3 });
    assert.deepEqual(await positionsOf(daemon, mesh), before);
});

test('Esc during a drag shows the mesh as it is, and nothing was edited', async (t) => {
    const context = await openMesh(t, GRID);
    const { daemon, mesh, page } = context;
    const from = await beginDrag(context, [70, -60]);
    await waitForPicture(page, 'the moved vertex', (canvas) =>
        isChosen(canvas.colour(from.x + 70, from.y - 60)),
    );
    await page.keyboard.press('Escape');
    await waitForPicture(
        page,
        'the vertex where it was',
        (canvas) =>
            isChosen(canvas.colour(from.x, from.y)) &&
            !isChosen(canvas.colour(from.x + 70, from.y - 60)),
    );
    await page.mouse.up();
    assert.equal((await get(daemon, `/${mesh}`)).revision, 1);
    assert.equal(await page.locator('#direct-note').isVisible(), false);
});

test('the slider says how far the bending reaches, up to all', async (t) => {
    const context = await openMesh(t, GRID);
    const { page } = context;
    const asked = [];
    page.on('request', (request) => {
        if (request.url().endsWith('/deform')) {
            asked.push(request.postDataJSON().fixed.length);
        }
    });
    const answered = () => page.waitForResponse((answer) => answer.url().endsWith('/deform'));
    const first = answered();
    await beginDrag(context, [20, 20]);
    await first;
    await page.keyboard.press('Escape');
    await page.mouse.up();
    const near = asked.at(-1);
    await press(page, 'g');
    const slider = page.locator('#bend-radius');
    await slider.waitFor();
    await slider.focus();
    await page.keyboard.press('End');
    assert.equal(await page.locator('#bend-reach').textContent(), 'all but the farthest');
    await page.keyboard.press('Escape');
    assert.equal(await page.locator('#direct-note').isVisible(), false);
    const second = answered();
    await beginDrag(context, [20, 20]);
    await second;
    assert.ok(near > 0 && asked.at(-1) > 0 && near !== asked.at(-1), `${asked}`);
    await page.keyboard.press('Escape');
    await page.mouse.up();
});
