// Tests in Chromium that a click in a hole picks a boundary half-edge of the hole, whatever is
// visible through it.

import assert from 'node:assert/strict';
import { test } from 'node:test';

import { checkAccessible, projector, waitForFrame } from './browser.mjs';
import { get, getAll, post } from './daemon.mjs';
import { checkInspector, chooseOperation, click, setMode } from './page.mjs';
import { openMesh } from './visit.mjs';

const CUBE = { name: 'cube', shape: 'cube' };

// Opens a cube without one of the faces that the camera sees, so that the insides of the others are
// visible through the hole. `rim` has the boundary half-edges, in the order of the loop.
async function openBox(t) {
    const context = await openMesh(t, CUBE);
    const { daemon, mesh, page } = context;
    const place = await projector(page, daemon, mesh);
    const [face] = (await getAll(daemon, mesh, 'faces')).filter((one) => place.isSeen(one));
    await post(daemon, `/${mesh}/edits`, { op: 'face_delete', face: face.id });
    await waitForFrame(page, { revision: 2 });
    const { loops } = await get(daemon, `/${mesh}/boundaries`);
    assert.equal(loops.length, 1);
    await setMode(page, 'Half-edge');
    return { ...context, place, rim: loops[0].halfedges, corners: loops[0].vertices };
}

const between = (a, b, part) => ({ x: a.x + part * (b.x - a.x), y: a.y + part * (b.y - a.y) });

// Returns the place that is `pixels` away from `a` in the direction of `b`.
function towards(a, b, pixels) {
    return between(a, b, pixels / Math.hypot(b.x - a.x, b.y - a.y));
}

test('in a hole a click near the rim picks the boundary half-edge there', async (t) => {
    const context = await openBox(t);
    const { page, place, rim, corners } = context;
    const middle = place.at(corners);
    for (const [i, id] of rim.entries()) {
        const side = place.at([corners[i], corners[(i + 1) % rim.length]]);
        for (const pixels of [2, 7]) {
            await click(page, towards(side, middle, pixels));
            const halfedge = await checkInspector(context, 'halfedge', id);
            assert.equal(halfedge.boundary, true, `${pixels} pixels from half-edge ${id}`);
            await click(page, { x: 4, y: 4 });
            await waitForFrame(page, { selection: '' });
        }
        await click(page, await place.arrow(id));
        await checkInspector(context, 'halfedge', id);
    }
    await checkAccessible(page, 'boundary half-edge selected');
});

test('beside a hole a click on the surface picks the half-edge of the face', async (t) => {
    const context = await openBox(t);
    const { daemon, mesh, page, place } = context;
    const seen = (await getAll(daemon, mesh, 'faces')).filter((face) => place.isSeen(face));
    assert.equal(seen.length, 2);
    for (const face of seen) {
        for (const id of face.halfedges) {
            await click(page, await place.arrow(id));
            const halfedge = await checkInspector(context, 'halfedge', id);
            assert.equal(halfedge.face, face.id);
        }
    }
});

test('a hole is filled by a click in its middle', async (t) => {
    const { daemon, mesh, page, place, rim, corners } = await openBox(t);
    await chooseOperation(page, 'hole_fill');
    await page.getByRole('button', { name: 'Pick halfedge in the view' }).click();
    await click(page, place.at(corners));
    await page.locator('#verdict').filter({ hasText: 'Would make' }).waitFor();
    assert.ok(rim.includes(Number(await page.locator('#param-halfedge').inputValue())));
    await page.getByRole('button', { name: 'Apply' }).click();
    await waitForFrame(page, { revision: 3 });
    assert.equal((await get(daemon, `/${mesh}`)).counts.boundary_loops, 0);
});
