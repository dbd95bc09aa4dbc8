// Tests of half-edges, arrows, boundaries, operations, keys and links on the page, in Chromium with
// the real daemon.

import assert from 'node:assert/strict';
import { readFile } from 'node:fs/promises';
import { test } from 'node:test';

import {
    checkAccessible,
    isBoundary,
    isChosen,
    isNear,
    isNext,
    isPrev,
    isSelf,
    isSurface,
    isTwin,
    projector,
    readCanvas,
    readPicture,
    waitForFrame,
} from './browser.mjs';
import { get, getAll, post, startDaemon } from './daemon.mjs';
import {
    cameraOf,
    checkInspector,
    chooseOperation,
    click,
    expectToast,
    fillVector,
    goTo,
    isEdit,
    press,
    setMode,
} from './page.mjs';
import { openMesh, openPage } from './visit.mjs';

const CUBE = { name: 'cube', shape: 'cube' };
const GRID = { name: 'grid', shape: 'grid', columns: 2, rows: 2 };

function colourAt(canvas, { x, y }) {
    return canvas.colour(x, y);
}

// Returns whether a pixel at a place, or one beside it, has a colour: an arrow is few pixels wide,
// and its middle may lie between two.
function hasColour(canvas, { x, y }, is) {
    const near = [-1, 0, 1];
    return near.some((dx) => near.some((dy) => is(canvas.colour(x + dx, y + dy))));
}

async function pickFace({ daemon, mesh, page }) {
    const place = await projector(page, daemon, mesh);
    const [face] = (await getAll(daemon, mesh, 'faces')).filter((one) => place.isSeen(one));
    await click(page, place.at(face.vertices));
    await waitForFrame(page, { selection: `face:${face.id}` });
    return face;
}

test('the same place picks the half-edge of either face', async (t) => {
    const context = await openMesh(t, CUBE);
    const { daemon, mesh, page } = context;
    const place = await projector(page, daemon, mesh);
    const seen = (await getAll(daemon, mesh, 'faces')).filter((face) => place.isSeen(face));
    await setMode(page, 'Half-edge');
    for (const face of seen) {
        for (const id of face.halfedges) {
            await click(page, await place.arrow(id));
            const halfedge = await checkInspector(context, 'halfedge', id);
            assert.equal(halfedge.face, face.id);
        }
    }
    await checkAccessible(page, 'half-edge selected');
});

test('arrows show the half-edge selected, next, prev and twin, then are gone', async (t) => {
    const context = await openMesh(t, GRID);
    const { daemon, mesh, page } = context;
    const place = await projector(page, daemon, mesh);
    // The edge chosen here must lie between two faces, so that both half-edges have a face.
    const { halfedges: [id] } = (await getAll(daemon, mesh, 'edges')).find((e) => !e.boundary);
    const halfedge = await get(daemon, `/${mesh}/halfedges/${id}`);
    const { next, prev, twin } = halfedge;
    const places = Object.fromEntries(
        await Promise.all(
            Object.entries({ self: id, next, prev, twin }).map(async ([role, other]) => [
                role,
                await place.arrow(other),
            ]),
        ),
    );
    const before = await readCanvas(page);
    const tests = { self: isSelf, next: isNext, prev: isPrev, twin: isTwin };
    for (const [role, is] of Object.entries(tests)) {
        assert.ok(!is(colourAt(before, places[role])), `${role} before`);
    }
    await setMode(page, 'Half-edge');
    await click(page, places.self);
    await checkInspector(context, 'halfedge', id);
    const during = await readCanvas(page);
    for (const [role, is] of Object.entries(tests)) {
        const colour = colourAt(during, places[role]);
        assert.ok(hasColour(during, places[role], is), `${role} is ${colour}`);
    }
    await press(page, 'Escape');
    await waitForFrame(page, { selection: '' });
    const afterwards = await readCanvas(page);
    for (const [role, is] of Object.entries(tests)) {
        assert.ok(!is(colourAt(afterwards, places[role])), `${role} after`);
    }
});

test('arrows of a face, an edge and a vertex are drawn on both sides', async (t) => {
    const { daemon, mesh, page } = await openMesh(t, GRID);
    const place = await projector(page, daemon, mesh);
    const vertices = await getAll(daemon, mesh, 'vertices');
    const middle = vertices.find(({ boundary }) => !boundary);
    const edge = (await getAll(daemon, mesh, 'edges')).find((one) => !one.boundary);
    const face = await get(daemon, `/${mesh}/faces/0`);
    const { ids: outgoing } = await get(daemon, `/${mesh}/vertices/${middle.id}/outgoing`);
    const twins = (ids) => ids.flatMap((id) => [id, id ^ 1]);
    for (const [mode, at, selection, halfedges] of [
        ['Face', face.vertices, 'face:0', twins(face.halfedges)],
        ['Edge', edge.vertices, `edge:${edge.id}`, edge.halfedges],
        ['Vertex', [middle.id], `vertex:${middle.id}`, twins(outgoing)],
    ]) {
        await setMode(page, mode);
        await click(page, place.at(at));
        await waitForFrame(page, { selection });
        const canvas = await readCanvas(page);
        for (const id of halfedges) {
            const where = await place.arrow(id);
            assert.ok(hasColour(canvas, where, isNear), `half-edge ${id} near ${selection}`);
        }
    }
});

test('boundary loops are lines of their own colour, until they are closed', async (t) => {
    const { daemon, mesh, page } = await openMesh(t, CUBE);
    const place = await projector(page, daemon, mesh);
    const [face] = (await getAll(daemon, mesh, 'faces')).filter((one) => place.isSeen(one));
    const sides = face.vertices.map((v, i) => [v, face.vertices[(i + 1) % face.degree]]);
    const countOnSides = async () => {
        const canvas = await readCanvas(page);
        return sides.filter((ids) => isBoundary(colourAt(canvas, place.at(ids)))).length;
    };
    assert.equal((await readCanvas(page)).countOf(isBoundary), 0);
    await click(page, place.at(face.vertices));
    await waitForFrame(page, { selection: `face:${face.id}` });
    await press(page, 'x');
    await waitForFrame(page, { revision: 2, selection: '' });
    assert.equal((await get(daemon, `/${mesh}`)).counts.boundary_loops, 1);
    assert.equal(await countOnSides(), 4);
    await press(page, 'Control+z');
    await waitForFrame(page, { revision: 3 });
    assert.equal(await countOnSides(), 0);
    await press(page, 'Control+Shift+Z');
    await waitForFrame(page, { revision: 4 });
    assert.equal(await countOnSides(), 4);
});

test('rings, lengths, angles and areas are those of the API', async (t) => {
    const { daemon, mesh, page } = await openMesh(t, { ...CUBE, size: 2 });
    const measures = () =>
        page.locator('#around [data-measure]').evaluateAll((all) =>
            Object.fromEntries(all.map((dd) => [dd.dataset.measure, dd.textContent])),
        );
    const ring = async (name) =>
        (await page.locator(`[data-ring="${name}"] button`).allTextContents()).map(Number);
    await goTo(page, 'halfedge', 3);
    assert.deepEqual(await measures(), { length: '2', angle: '90\u00b0' });
    for (const name of ['loop', 'ring']) {
        assert.deepEqual(await ring(name), (await get(daemon, `/${mesh}/halfedges/3/${name}`)).ids);
    }
    await goTo(page, 'edge', 5);
    assert.deepEqual(await measures(), { 'fold angle': '90\u00b0' });
    await goTo(page, 'face', 1);
    assert.deepEqual(await measures(), {});
    assert.deepEqual(await ring('faces'), (await get(daemon, `/${mesh}/faces/1/faces`)).ids);
    await goTo(page, 'vertex', 6);
    for (const name of ['outgoing', 'vertices', 'faces']) {
        assert.deepEqual(await ring(name), (await get(daemon, `/${mesh}/vertices/6/${name}`)).ids);
    }
    // The ids of an element's neighbours must be links, too.
    const [first] = await ring('outgoing');
    await page.locator('[data-ring="outgoing"] button').first().click();
    await waitForFrame(page, { selection: `halfedge:${first}` });
});

test('an id that is not there is said, and what is selected stays', async (t) => {
    const { page } = await openMesh(t, CUBE, { allowed: [/status of 404/] });
    await goTo(page, 'face', 2);
    await page.locator('#goto-id').fill('99');
    await page.getByRole('button', { name: 'Go' }).click();
    await expectToast(page, /99/);
    await waitForFrame(page, { selection: 'face:2' });
});

test('going to an element brings it to the middle, F too', async (t) => {
    const { page } = await openMesh(t, { shape: 'grid', columns: 20, rows: 20 });
    const chosen = async () => {
        const canvas = await readCanvas(page);
        const { width, height } = await page.locator('#canvas').boundingBox();
        return [canvas.colour(width / 2, height / 2), canvas.countOf(isChosen)];
    };
    await goTo(page, 'face', 0);
    const [colour, near] = await chosen();
    assert.ok(isChosen(colour), `${colour}`);
    await page.getByRole('button', { name: 'Fit view' }).click();
    const [, far] = await chosen();
    assert.ok(near > 20 * far, `${near} and ${far} pixels`);
    await press(page, 'f');
    await page.locator('#canvas').blur();
    assert.equal((await chosen())[1], near);
});

test('keys pick modes and follow links, only while the view has the focus', async (t) => {
    const context = await openMesh(t, CUBE);
    const { page } = context;
    const mode = () => page.locator('input[name="pick"]:checked').getAttribute('value');
    for (const [key, value] of [['1', 'vertex'], ['2', 'edge'], ['3', 'face'], ['4', 'halfedge']]) {
        await press(page, key);
        assert.equal(await mode(), value);
    }
    await goTo(page, 'halfedge', 0);
    let halfedge = await checkInspector(context, 'halfedge', 0);
    for (const [key, link] of [['n', 'next'], ['t', 'twin'], ['p', 'prev'], ['N', 'next']]) {
        await press(page, key);
        halfedge = await checkInspector(context, 'halfedge', halfedge[link]);
    }
    // Outside of the view a key must not act as a command.
    await page.getByRole('button', { name: 'Refresh' }).press('3');
    assert.equal(await mode(), 'halfedge');
});

test('? shows the keys', async (t) => {
    const { page } = await openMesh(t, CUBE);
    await press(page, '?');
    const help = page.getByRole('dialog');
    await help.waitFor();
    for (const text of ['Next half-edge', 'Undo', 'Show the selection']) {
        assert.ok(await help.getByText(text).isVisible(), text);
    }
    await checkAccessible(page, 'help');
    await page.keyboard.press('Escape');
    assert.ok(await help.isHidden());
    await page.getByRole('button', { name: 'Keys' }).click();
    await help.getByRole('button', { name: 'Close' }).click();
    assert.ok(await help.isHidden());
});

test('the panel has a form for each operation of the table', async (t) => {
    // Operations without required parameters are tried at once, and some are refused for a cube.
    const { daemon, page } = await openMesh(t, CUBE, { allowed: [/status of 422/] });
    const { operations } = await (await fetch(`${daemon.url}/v1/operations`)).json();
    const select = page.locator('#operation');
    const listed = await select.locator('option').allTextContents();
    assert.deepEqual(listed.sort(), operations.map(({ name }) => name).sort());
    for (const { name, params, doc } of operations) {
        await select.selectOption(name);
        await checkAccessible(page, name, '#parameters');
        const labels = await page.locator('#parameters .name').allTextContents();
        assert.deepEqual(labels, params.map((param) => param.name), name);
        const text = await page.locator('#parameters').textContent();
        assert.ok(text.startsWith(doc.replaceAll('`', '')), name);
    }
});

test('an operation takes its elements from the selection', async (t) => {
    const context = await openMesh(t, CUBE);
    const { daemon, mesh, page } = context;
    const face = await pickFace(context);
    // Until the user chooses an operation, the panel must show one that fits the selection.
    assert.match(await page.locator('#operation').inputValue(), /^face_/);
    await chooseOperation(page, 'face_poke');
    assert.equal(await page.locator('#param-face').inputValue(), `${face.id}`);
    await fillVector(page, 'position', [0, 0, 2]);
    await page.getByRole('button', { name: 'Apply' }).click();
    await waitForFrame(page, { revision: 2 });
    const [made] = (await getAll(daemon, mesh, 'vertices')).slice(-1);
    assert.deepEqual(made.position, [0, 0, 2]);

    // If an operation takes an edge and a half-edge is selected, the form must be filled with the
    // edge of the half-edge.
    await goTo(page, 'halfedge', 4);
    await chooseOperation(page, 'edge_split');
    assert.equal(await page.locator('#param-edge').inputValue(), '2');
    await page.locator('#param-t').fill('0.25');
    const sent = page.waitForRequest(isEdit);
    await page.getByRole('button', { name: 'Apply' }).click();
    const { ops } = (await sent).postDataJSON();
    assert.deepEqual(ops, [{ op: 'edge_split', edge: 2, t: 0.25 }]);
    await waitForFrame(page, { revision: 3 });
});

test('several elements are given as a list', async (t) => {
    const { daemon, mesh, page } = await openMesh(t, GRID);
    const place = await projector(page, daemon, mesh);
    await setMode(page, 'Vertex');
    for (const id of [0, 1, 2]) {
        await click(page, place.at([id]), id === 0 ? [] : ['Shift']);
        await page.locator(`#canvas[data-selection$="vertex:${id}"]`).waitFor();
    }
    await waitForFrame(page, { selection: 'vertex:0 vertex:1 vertex:2' });
    const before = await getAll(daemon, mesh, 'vertices');
    await press(page, 'g');
    assert.equal(await page.locator('#operation').inputValue(), 'vertex_move');
    assert.equal(await page.locator('#param-vertex').inputValue(), '0 1 2');
    const by = page.getByRole('group', { name: 'by', exact: true });
    await by.getByRole('button', { name: 'A list' }).click();
    await by.getByRole('textbox').fill('0, 0, 0.5; 0, 0, 0.5; 0, 0, 0.5');
    await page.getByRole('button', { name: 'Apply' }).click();
    await waitForFrame(page, { revision: 2 });
    const moved = await getAll(daemon, mesh, 'vertices');
    moved.forEach(({ position }, i) => {
        const [x, y, z] = before[i].position;
        assert.deepEqual(position, [x, y, i < 3 ? z + 0.5 : z]);
    });
});

test('what a form says wrongly is answered in words', async (t) => {
    const { page } = await openMesh(t, CUBE, { allowed: [/status of 4\d\d/] });
    await chooseOperation(page, 'edge_split');
    await page.locator('#param-edge').fill('2nd');
    const expectRefusal = (pattern) =>
        page.locator('[data-name="edge"] + #verdict').filter({ hasText: pattern }).waitFor();
    await page.getByRole('button', { name: 'Apply' }).click();
    await expectRefusal(/2nd.*not a number/);
    await page.locator('#param-edge').fill('77');
    await page.getByRole('button', { name: 'Apply' }).click();
    // What the server says of the edge, and not of a field, is a message.
    await page.locator('#verdict, #toasts [role="alert"]').filter({ hasText: /77/ }).first().waitFor();
    await checkAccessible(page, 'refused operation');
});

test('a key for an operation that the table has not is answered in words', async (t) => {
    const daemon = await startDaemon(t);
    const { id: mesh } = await post(daemon, '', CUBE);
    const init = () => {
        const { fetch } = window;
        window.fetch = async (path, options) => {
            const answer = await fetch(path, options);
            if (!`${path}`.endsWith('v1/operations')) {
                return answer;
            }
            const { operations } = await answer.json();
            const left = operations.filter(({ name }) => name !== 'face_extrude');
            return Response.json({ operations: left });
        };
    };
    const page = await openPage(t, daemon, { init });
    await waitForFrame(page, { mesh, revision: 1 });
    await page.locator('#operation option').first().waitFor({ state: 'attached' });
    await press(page, 'e');
    await expectToast(page, /face_extrude/);
    await checkAccessible(page, 'missing operation');
});

test('what is shown is in the address, and an address shows it again', async (t) => {
    const context = await openMesh(t, CUBE);
    const { daemon, mesh, page } = context;
    await post(daemon, '', { name: 'other', shape: 'torus' });
    const face = await pickFace(context);
    const unframed = page.url();
    await press(page, 'f');
    await page.waitForURL((url) => `${url}` !== unframed);
    const address = page.url();
    assert.match(address, new RegExp(`#mesh=${mesh}&face=${face.id}&camera=`));
    // The ring around the focused canvas has the colour of the selection, so the focus is removed
    // before counting pixels.
    await page.locator('#canvas').blur();
    const a = await readCanvas(page);
    await page.goto('about:blank'); // otherwise the second page marks what the first one has selected
    const second = await openPage(t, daemon, {
        allowed: [/status of 404/],
        path: `/${new URL(address).hash}`,
    });
    await waitForFrame(second, { mesh, revision: 1, selection: `face:${face.id}` });
    // The cameras of the two pages may differ, but only in the last digits of their numbers.
    const b = await readCanvas(second);
    const counts = [a.countOf(isChosen), b.countOf(isChosen)];
    assert.ok(counts[0] > 1000 && Math.abs(counts[0] - counts[1]) < counts[0] / 100, `${counts}`);
    const wanted = new URLSearchParams(new URL(address).hash).get('camera').split(',');
    const camera = (await cameraOf(second)).split(',');
    wanted.forEach((value, i) => assert.ok(Math.abs(value - camera[i]) < 1e-4, `${camera}`));
    // Now the address changes while the page is open, as if the user had typed another one.
    await second.evaluate(() => {
        window.location.hash = '#mesh=none';
    });
    await expectToast(second, /none/);
    await second.evaluate((id) => {
        window.location.hash = `#mesh=${id}&vertex=3`;
    }, mesh);
    await waitForFrame(second, { mesh, selection: 'vertex:3' });
});

test('an address of a mesh that is gone is said, and another one is shown', async (t) => {
    const daemon = await startDaemon(t);
    const { id: mesh } = await post(daemon, '', CUBE);
    const page = await openPage(t, daemon, {
        allowed: [/status of 404/],
        path: '/#mesh=gone&face=1',
    });
    await waitForFrame(page, { mesh, revision: 1, selection: '' });
    await expectToast(page, /gone/);
});

test('the view is saved as a picture', async (t) => {
    const { page } = await openMesh(t, CUBE);
    const coming = page.waitForEvent('download');
    await page.getByRole('button', { name: 'Screenshot' }).click();
    const download = await coming;
    assert.equal(download.suggestedFilename(), 'cube.png');
    const bytes = await readFile(await download.path());
    assert.deepEqual([...bytes.subarray(1, 4)], [...Buffer.from('PNG')]);
    const { width, height } = await page.locator('#canvas').boundingBox();
    const size = [bytes.readUInt32BE(16), bytes.readUInt32BE(20)];
    assert.deepEqual(size, [Math.round(width), Math.round(height)]);
    // The saved picture must not contain the focus ring of the page.
    const [saved, shown] = [readPicture(bytes), await readCanvas(page)];
    assert.equal(saved.countOf(isSurface), shown.countOf(isSurface));
    assert.ok(saved.countOf(isSurface) > 10000);
});

test('a lost graphics context is said and the view comes back', async (t) => {
    const context = await openMesh(t, GRID);
    const { page } = context;
    await goTo(page, 'face', 1);
    await page.getByRole('button', { name: 'Fit view' }).click();
    const counts = async () => {
        const canvas = await readCanvas(page);
        return [isSurface, isChosen, isBoundary, isNear].map((is) => canvas.countOf(is));
    };
    const before = await counts();
    assert.ok(before.every((count) => count > 100), `${before}`);
    await page.evaluate(() => {
        const gl = document.getElementById('canvas').getContext('webgl2');
        window.lost = gl.getExtension('WEBGL_lose_context');
        window.lost.loseContext();
    });
    await page.getByRole('alert').filter({ hasText: 'Graphics interrupted' }).waitFor();
    await checkAccessible(page, 'context lost');
    await page.evaluate(() => window.lost.restoreContext());
    await page.locator('#context-lost').waitFor({ state: 'hidden' });
    await page.evaluate(() => new Promise((resolve) => requestAnimationFrame(() =>
        requestAnimationFrame(resolve))));
    assert.deepEqual(await counts(), before);
});

test('a tap picks, and a finger orbits', async (t) => {
    const context = await openMesh(t, CUBE, { hasTouch: true });
    const { daemon, mesh, page } = context;
    const place = await projector(page, daemon, mesh);
    const [face] = (await getAll(daemon, mesh, 'faces')).filter((one) => place.isSeen(one));
    const box = await page.locator('#canvas').boundingBox();
    const { x, y } = place.at(face.vertices);
    await page.touchscreen.tap(box.x + x, box.y + y);
    await checkInspector(context, 'face', face.id);
    const session = await page.context().newCDPSession(page);
    const touch = (type, points) => session.send('Input.dispatchTouchEvent', {
        type,
        touchPoints: points,
    });
    const before = page.url();
    await touch('touchStart', [{ x: box.x + x, y: box.y + y }]);
    await touch('touchMove', [{ x: box.x + x + 80, y: box.y + y + 20 }]);
    await touch('touchEnd', []);
    await page.waitForFunction((url) => window.location.href !== url, before);
    await waitForFrame(page, { selection: `face:${face.id}` });
});

test('a mesh far from the origin and a huge one are drawn like any other', async (t) => {
    const daemon = await startDaemon(t);
    const page = await openPage(t, daemon);
    await page.getByRole('heading', { name: 'No meshes yet' }).waitFor();
    const counts = [];
    for (const [size, away] of [[1, 0], [1, 2 ** 30], [1e300, 0], [1e-300, 0]]) {
        const at = ([x, y]) => [away + size * x, away + size * y, away];
        const square = [[0, 0], [1, 0], [1, 1], [0, 1]].map(at);
        const { id: mesh } = await post(daemon, '', { vertices: square, faces: [[0, 1, 2, 3]] });
        await page.getByRole('button', { name: 'Refresh' }).click();
        await page.locator(`#meshes button[data-mesh="${mesh}"]`).click();
        await waitForFrame(page, { mesh, revision: 1 });
        counts.push((await readCanvas(page)).countOf(isSurface));
    }
    assert.ok(counts[0] > 10000);
    for (const count of counts) {
        assert.ok(Math.abs(count - counts[0]) < counts[0] / 50, `${counts}`);
    }
});
