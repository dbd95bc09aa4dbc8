// Tests of going to an element: what the camera then sees, and which kind of element the page
// offers to go to, in Chromium with the real daemon.

import assert from 'node:assert/strict';
import { test } from 'node:test';

import { PerspectiveCamera, Vector3 } from '../../web/node_modules/three/build/three.module.js';
import { pointAt, unpack } from '../../web/src/geometry/geometry.js';
import { FIELD_OF_VIEW, UP } from '../../web/src/geometry/view.js';
import { isNext, isPrev, isSelf, readCanvas } from './browser.mjs';
import { get, getGeometry, post } from './daemon.mjs';
import { cameraOf, chooseOperation, goTo, press, setMode } from './page.mjs';
import { openMesh } from './visit.mjs';

// Returns how far vertices are from the middle of the picture, as fractions of its half width or
// height: more than 1 is outside.
async function placesOf({ daemon, mesh, page }, ids) {
    const geometry = unpack(await getGeometry(daemon, mesh));
    const { width, height } = await page.locator('#canvas').boundingBox();
    const numbers = (await cameraOf(page)).split(',').map(Number);
    const camera = new PerspectiveCamera(FIELD_OF_VIEW, width / height, 0.001, 100);
    camera.up.set(...UP);
    camera.position.set(...numbers.slice(0, 3));
    camera.lookAt(new Vector3(...numbers.slice(3)));
    camera.updateMatrixWorld();
    return ids.map((id) => {
        const { x, y } = new Vector3(...pointAt(geometry, id)).project(camera);
        return Math.max(Math.abs(x), Math.abs(y));
    });
}

async function seesWithNextAndPrev(context, id) {
    const { daemon, mesh, page } = context;
    await goTo(page, 'halfedge', id);
    await press(page, 'f');
    const { next, prev, origin, target } = await get(daemon, `/${mesh}/halfedges/${id}`);
    const { target: after } = await get(daemon, `/${mesh}/halfedges/${next}`);
    const { origin: before } = await get(daemon, `/${mesh}/halfedges/${prev}`);
    const places = await placesOf(context, [before, origin, target, after]);
    assert.ok(places.every((place) => place < 0.95), `half-edge ${id}: ${places}`);
    assert.ok(places.some((place) => place > 0.2), `half-edge ${id} is far away: ${places}`);
    return readCanvas(page);
}

test('F frames a half-edge with its face, so that next and prev are seen', async (t) => {
    const context = await openMesh(t, { shape: 'grid', columns: 9, rows: 9 });
    const { daemon, mesh } = context;
    for (const id of (await get(daemon, `/${mesh}/faces/40`)).halfedges) {
        const canvas = await seesWithNextAndPrev(context, id);
        for (const isRole of [isNext, isPrev, isSelf]) {
            assert.ok(canvas.countOf(isRole) > 100, `half-edge ${id}, ${isRole}`);
        }
    }
});

test('F frames a short half-edge with next and prev that are long', async (t) => {
    const context = await openMesh(t, { shape: 'grid', columns: 10, rows: 1 });
    const { daemon, mesh } = context;
    for (const id of (await get(daemon, `/${mesh}/faces/4`)).halfedges) {
        await seesWithNextAndPrev(context, id);
    }
});

test('F on a boundary half-edge shows next and prev, and not all of a long loop', async (t) => {
    const context = await openMesh(t, { shape: 'grid', columns: 40, rows: 40 });
    const { daemon, mesh, page } = context;
    const { loops: [{ halfedges: [, id] }] } = await get(daemon, `/${mesh}/boundaries`);
    await seesWithNextAndPrev(context, id);
    // A polygon with many corners is too large to be framed with one of its half-edges.
    await post(daemon, `/${mesh}/edits`, { op: 'hole_fill', halfedge: id });
    await page.locator('#canvas[data-revision="2"]').waitFor();
    await seesWithNextAndPrev(context, id);
});

test('the kind of element to go to follows the pick mode', async (t) => {
    const { page } = await openMesh(t, { shape: 'cube' });
    const kind = page.locator('#goto-kind');
    const modes = [['Half-edge', 'halfedge', '4'], ['Edge', 'edge', '2'], ['Vertex', 'vertex', '1'],
        ['Face', 'face', '3']];
    for (const [mode, value, key] of modes) {
        await setMode(page, mode);
        assert.equal(await kind.inputValue(), value);
        await setMode(page, mode === 'Face' ? 'Edge' : 'Face');
        await press(page, key);
        assert.equal(await kind.inputValue(), value);
    }
    // A field of a form that waits for a click picks elements of its own kind.
    await chooseOperation(page, 'hole_fill');
    await page.getByRole('button', { name: 'Pick halfedge in the view' }).click();
    assert.equal(await kind.inputValue(), 'halfedge');
    // The user may still go to an element of another kind.
    await kind.selectOption('vertex');
    assert.equal(await kind.inputValue(), 'vertex');
});
