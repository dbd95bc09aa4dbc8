// Tests that edits of other clients appear on the page, even if its event stream is cut or refused,
// and that the selection survives them.

import assert from 'node:assert/strict';
import { test } from 'node:test';

import {
    checkAccessible,
    isBoundary,
    isChosen,
    isSurface,
    readCanvas,
    waitForFrame,
} from './browser.mjs';
import { cuttable } from './cuttable.mjs';
import { get, post, startDaemon } from './daemon.mjs';
import { checkInspector, expectToast, goTo, press } from './page.mjs';
import { openMesh, openPage } from './visit.mjs';

const CUBE = { name: 'cube', shape: 'cube' };
const GRID = { name: 'grid', shape: 'grid', columns: 3, rows: 3 };
const edit = (daemon, mesh, operation) => post(daemon, `/${mesh}/edits`, operation);
const noteOf = (page, state) => page.locator(`#connection[data-state="${state}"]`);

// Returns a list to which the URL of each further request of the page is added, if it contains a
// certain text.
function requestsOf(page, text) {
    const found = [];
    page.on('request', (request) => {
        if (request.url().includes(text)) {
            found.push(request.url());
        }
    });
    return found;
}

// Waits until a condition holds. If it never does, the time limit of the whole test ends the wait.
async function waitFor(holds) {
    while (!(await holds()));
}

// Holds back the page's first request that matches a pattern. Returns {asked, release()}: a promise
// that resolves when the page has sent the request, and a function that lets the answer through.
async function hold(page, pattern) {
    let release;
    let ask;
    const asked = new Promise((resolve) => {
        ask = resolve;
    });
    const held = new Promise((resolve) => {
        release = resolve;
    });
    await page.route(pattern, async (route) => {
        ask();
        await held;
        await route.continue();
    });
    return { asked, release };
}

test('what one page does is seen on another, and costs no whole mesh', async (t) => {
    const { daemon, mesh, page } = await openMesh(t, CUBE);
    const second = await openPage(t, daemon, { path: `/#mesh=${mesh}` });
    await waitForFrame(second, { mesh, revision: 1 });
    const fetched = requestsOf(second, '/geometry');
    await goTo(page, 'face', 0);
    await page.getByRole('button', { name: 'Split' }).click();
    await waitForFrame(page, { revision: 2 });
    await waitForFrame(second, { revision: 2, selection: '' });
    await second.getByRole('button', { name: 'Undo' }).click();
    await waitForFrame(page, { revision: 3 });
    await edit(daemon, mesh, { op: 'vertex_move', vertex: 7, by: [0, 0, 0.4] });
    await waitForFrame(page, { revision: 4 });
    await waitForFrame(second, { revision: 4 });
    const { counts } = await get(daemon, `/${mesh}`);
    for (const one of [page, second]) {
        const shown = await one.locator('[data-statistic="faces"]').textContent();
        assert.equal(shown, `${counts.faces}`);
        await one.getByRole('button', { name: 'Fit view' }).click();
    }
    assert.deepEqual(fetched.filter((url) => !url.includes('since=')), []);
    // Both pages must show the same picture as a page that has just been opened.
    await press(page, 'Escape');
    const third = await openPage(t, daemon, { path: `/#mesh=${mesh}` });
    await waitForFrame(third, { mesh, revision: 4 });
    const pictures = [];
    for (const one of [page, second, third]) {
        await one.locator('#canvas').blur();
        pictures.push(await one.screenshot({ clip: await one.locator('#canvas').boundingBox() }));
    }
    assert.deepEqual(pictures[0], pictures[2]);
    assert.deepEqual(pictures[1], pictures[2]);
});

test('many edits at once are fetched together', async (t) => {
    const { daemon, mesh, page } = await openMesh(t, CUBE);
    const fetched = requestsOf(page, '/geometry?since=');
    const { asked, release } = await hold(page, '**/geometry?since=*');
    for (let i = 0; i < 20; i++) {
        await edit(daemon, mesh, { op: 'face_poke', face: i });
    }
    await asked;
    assert.equal(fetched.length, 1);
    release();
    await waitForFrame(page, { revision: 21 });
    assert.ok(fetched.length <= 3, `${fetched.length} requests`);
});

test('a mesh that is replaced, renamed or compacted is shown as it is now', async (t) => {
    const { daemon, mesh, page } = await openMesh(t, GRID);
    await edit(daemon, mesh, { op: 'face_delete', face: 4 });
    await waitForFrame(page, { revision: 2 });
    await edit(daemon, mesh, { op: 'compact' });
    await waitForFrame(page, { revision: 3 });
    await goTo(page, 'face', 7);
    await fetch(`${daemon.url}/v1/meshes/${mesh}`, {
        method: 'PATCH',
        headers: { 'Content-Type': 'application/merge-patch+json' },
        body: '{"name":"sieve"}',
    });
    await page.locator('#mesh-title').filter({ hasText: 'sieve' }).waitFor();
    assert.equal(await page.locator('[aria-current] .mesh-name').textContent(), 'sieve');
    const answer = await fetch(`${daemon.url}/v1/meshes/${mesh}`, {
        method: 'PUT',
        headers: { 'Content-Type': 'application/json' },
        body: JSON.stringify({ shape: 'icosphere', subdivisions: 1 }),
    });
    const { revision } = await answer.json();
    await waitForFrame(page, { revision });
    assert.equal(await page.locator('[data-statistic="faces"]').textContent(), '80');
});

test('a stream that is cut is said, and goes on where it was', async (t) => {
    const daemon = await startDaemon(t);
    const way = await cuttable(t, daemon);
    const { id: mesh } = await post(daemon, '', CUBE);
    const page = await openPage(t, way, { allowed: [/ERR_/] });
    await waitForFrame(page, { mesh, revision: 1 });
    await goTo(page, 'face', 0);
    way.cut();
    await noteOf(page, 'lost').waitFor();
    await page.getByText('Connection lost').waitFor();
    await checkAccessible(page, 'connection lost');
    await edit(daemon, mesh, { op: 'face_poke', face: 0 });
    await edit(daemon, mesh, { op: 'vertex_move', vertex: 8, by: [0, 0, -0.5] });
    await waitForFrame(page, { revision: 1, selection: 'face:0' });
    assert.ok((await readCanvas(page)).countOf(isSurface) > 1000);
    way.mend();
    await waitForFrame(page, { revision: 3, selection: 'face:0' });
    await noteOf(page, 'on').waitFor({ state: 'attached' });
    assert.ok(await page.locator('#connection').isHidden());
    // The stream is cut once more, and this time no event is missed.
    way.cut();
    await noteOf(page, 'lost').waitFor();
    way.mend();
    await noteOf(page, 'on').waitFor({ state: 'attached' });
    await edit(daemon, mesh, { op: 'face_poke', face: 1 });
    await waitForFrame(page, { revision: 4 });
    assert.equal(await page.getByRole('alert').count(), 0);
});

test('an edit before a stream that opens late is shown', async (t) => {
    const { daemon, page } = await openMesh(t, CUBE);
    const { id: other } = await post(daemon, '', GRID);
    const { asked, release } = await hold(page, `**/meshes/${other}/events*`);
    await page.getByRole('button', { name: 'Refresh' }).click();
    await page.locator(`#meshes button[data-mesh="${other}"]`).click();
    await asked;
    // The page must stop waiting for the stream after a while, and show the mesh.
    await waitForFrame(page, { mesh: other, revision: 1 });
    await edit(daemon, other, { op: 'face_poke', face: 0 });
    release();
    await waitForFrame(page, { mesh: other, revision: 2 });
});

test('a mesh that is deleted while it is open is said, and stays to be seen', async (t) => {
    const { daemon, mesh, page } = await openMesh(t, CUBE);
    await goTo(page, 'face', 0);
    await fetch(`${daemon.url}/v1/meshes/${mesh}`, { method: 'DELETE' });
    await page.getByText('This mesh was deleted').waitFor();
    await page.locator('#meshes li').waitFor({ state: 'detached' });
    for (const name of ['Split', 'Undo', 'Apply']) {
        assert.ok(await page.getByRole('button', { name }).isDisabled(), name);
    }
    assert.ok((await readCanvas(page)).countOf(isSurface) > 1000);
    await checkAccessible(page, 'deleted');
    const { id: other } = await post(daemon, '', { name: 'other', shape: 'torus' });
    await page.getByRole('button', { name: 'Refresh' }).click();
    await page.locator(`#meshes button[data-mesh="${other}"]`).click();
    await waitForFrame(page, { mesh: other, revision: 1 });
    assert.ok(await page.locator('#connection').isHidden());
});

test('a selection survives the edits of others, and its members are the new ones', async (t) => {
    const context = await openMesh(t, GRID);
    const { daemon, mesh, page } = context;
    await goTo(page, 'face', 4);
    await edit(daemon, mesh, { op: 'edge_split', edge: 5 });
    await waitForFrame(page, { revision: 2, selection: 'face:4' });
    await checkInspector(context, 'face', 4);
    const { vertices } = await get(daemon, `/${mesh}/faces/4`);
    await edit(daemon, mesh, { op: 'vertex_move', vertex: vertices[0], by: [0, 0, 0.3] });
    await waitForFrame(page, { revision: 3, selection: 'face:4' });
    await checkInspector(context, 'face', 4);
    await page.locator('#canvas').blur();
    assert.ok((await readCanvas(page)).countOf(isChosen) > 1000);
});

test('an element that is gone is said, with a way to what it is part of', async (t) => {
    const context = await openMesh(t, GRID);
    const { daemon, mesh, page } = context;
    const gone = page.locator('#element-gone li');
    // A collapse merges the selected vertex into another one; the page must offer to select that
    // other vertex.
    const { vertices } = await get(daemon, `/${mesh}/edges/5`);
    const made = await edit(daemon, mesh, {
        dry_run: true,
        ops: [{ op: 'edge_collapse', edge: 5 }],
    });
    const [[lost, heir]] = made.merged.vertices;
    assert.deepEqual([lost, heir].sort(), [...vertices].sort());
    await goTo(page, 'vertex', lost);
    await edit(daemon, mesh, { op: 'edge_collapse', edge: 5 });
    await waitForFrame(page, { revision: 2, selection: '' });
    assert.match(await gone.textContent(), new RegExp(`^Vertex ${lost} is gone`));
    assert.equal(await page.locator('#element-title').textContent(), 'Nothing selected');
    await checkAccessible(page, 'gone');
    await gone.getByRole('button').focus();
    await page.keyboard.press('Enter');
    await checkInspector(context, 'vertex', heir);
    assert.equal(await gone.count(), 0);
    // An undo removes the faces into which a face was divided; the page must offer to select the
    // face that was divided.
    const { created } = await edit(daemon, mesh, { op: 'face_poke', face: 8 });
    await waitForFrame(page, { revision: 3 });
    await goTo(page, 'face', created.faces[0]);
    await page.getByRole('button', { name: 'Undo' }).click();
    await waitForFrame(page, { revision: 4, selection: '' });
    await page.getByRole('button', { name: 'Redo' }).click();
    await waitForFrame(page, { revision: 5 });
    assert.equal(await gone.count(), 0); // the face exists again
    await goTo(page, 'face', created.faces[0]);
    await page.getByRole('button', { name: 'Undo' }).click();
    await waitForFrame(page, { revision: 6, selection: '' });
    await gone.getByRole('button', { name: 'Face 8' }).click();
    await checkInspector(context, 'face', 8);
    // If a face is deleted, nothing replaces it, so the page must offer no other element.
    await edit(daemon, mesh, { op: 'face_delete', face: 8 });
    await waitForFrame(page, { revision: 7, selection: '' });
    assert.match(await gone.textContent(), /^Face 8 is gone/);
    assert.equal(await gone.getByRole('button').count(), 0);
    await press(page, 'Escape');
    assert.equal(await gone.count(), 0);
});

test('what is selected while a change is fetched stays selected', async (t) => {
    const context = await openMesh(t, GRID);
    const { daemon, mesh, page } = context;
    await goTo(page, 'face', 4);
    const { asked, release } = await hold(page, '**/geometry?since=*');
    await edit(daemon, mesh, { op: 'vertex_move', vertex: 0, by: [0, 0, 0.3] });
    await asked;
    await goTo(page, 'face', 0);
    release();
    await waitForFrame(page, { revision: 2, selection: 'face:0' });
    await checkInspector(context, 'face', 0);
    // The answer about face 0 is made before an edit of the mesh, but arrives after the edit.
    const late = await hold(page, '**/faces/0');
    await page.locator('#goto-id').fill('0');
    await page.getByRole('button', { name: 'Go', exact: true }).click();
    await late.asked;
    await edit(daemon, mesh, { op: 'vertex_move', vertex: 0, by: [0, 0, 0.3] });
    await waitForFrame(page, { revision: 3 });
    late.release();
    await checkInspector(context, 'face', 0);
});

test('what a rival has undone is not undone again, and that is said', async (t) => {
    const context = await openMesh(t, CUBE, { allowed: [/status of 412/] });
    const { daemon, mesh, page } = context;
    await edit(daemon, mesh, { op: 'face_poke', face: 0 });
    await waitForFrame(page, { revision: 2 });
    await page.route('**/undo', async (route) => {
        await post(daemon, `/${mesh}/undo`, {});
        await route.continue();
    }, { times: 1 });
    await page.getByRole('button', { name: 'Undo' }).click();
    await expectToast(page, /another client made these changes.*: undo of face_poke/);
    await waitForFrame(page, { revision: 3 });
    assert.ok(await page.getByRole('button', { name: 'Undo', exact: true }).isDisabled());
    assert.ok(await page.getByRole('button', { name: 'Redo' }).isEnabled());
});

test('boundary loops are read only where some are shown', async (t) => {
    const { daemon, mesh, page } = await openMesh(t, CUBE);
    const asked = requestsOf(page, '/boundaries');
    assert.ok(await page.getByLabel('Show boundary loops').isHidden());
    await edit(daemon, mesh, { op: 'face_poke', face: 0 });
    await waitForFrame(page, { revision: 2 });
    assert.deepEqual(asked, []);
    await edit(daemon, mesh, { op: 'face_delete', face: 1 });
    await waitForFrame(page, { revision: 3 });
    assert.equal(asked.length, 1);
    const drawn = async () => (await readCanvas(page)).countOf(isBoundary);
    assert.ok((await drawn()) > 100);
    await page.getByLabel('Show boundary loops').uncheck();
    await edit(daemon, mesh, { op: 'face_delete', face: 2 });
    await waitForFrame(page, { revision: 4 });
    assert.equal(asked.length, 1);
    assert.equal(await drawn(), 0);
    await checkAccessible(page, 'boundary off');
    await page.getByLabel('Show boundary loops').check();
    await waitFor(async () => (await drawn()) > 100);
    assert.equal(asked.length, 2);
});
