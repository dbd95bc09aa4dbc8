// Tests of the list of revisions, and of uploads and edits that take long: how the page shows their
// progress, cancels them, and shows their end.

import assert from 'node:assert/strict';
import { test } from 'node:test';

import { checkAccessible, waitForFrame, waitForTold } from './browser.mjs';
import { get, post, startDaemon } from './daemon.mjs';
import { chooseOperation, expectToast, fillVector, isEdit } from './page.mjs';
import { openMesh, openPage } from './visit.mjs';

const CUBE = { name: 'cube', shape: 'cube' };

const rowsOf = (page) =>
    page.locator('#history li').evaluateAll((rows) =>
        rows.map((row) => [
            Number(row.dataset.revision),
            row.querySelector('.ops').textContent,
            row.querySelector('button.entry') !== null,
            row.hasAttribute('aria-current'),
        ]),
    );

test('the history says what was done, and a click goes back to a revision', async (t) => {
    const { daemon, mesh, page } = await openMesh(t, CUBE);
    assert.deepEqual(await rowsOf(page), []);
    for (const operation of [
        { op: 'face_poke', face: 0 },
        { op: 'edge_split', edge: 0 },
        { op: 'vertex_move', vertex: 0, by: [0, 0, 0.1] },
    ]) {
        await post(daemon, `/${mesh}/edits`, operation);
    }
    await waitForFrame(page, { revision: 4 });
    assert.deepEqual(await rowsOf(page), [
        [4, 'vertex_move', false, true],
        [3, 'edge_split', true, false],
        [2, 'face_poke', true, false],
        [1, 'original', true, false],
    ]);
    const poke = page.locator('#history li[data-revision="2"]');
    assert.match(await poke.locator('.entry').textContent(), /\+8$/);
    await checkAccessible(page, 'history');
    await poke.locator('button.entry').focus();
    await page.keyboard.press('Enter');
    await waitForFrame(page, { revision: 6 });
    assert.equal((await get(daemon, `/${mesh}`)).counts.faces, 9);
    assert.deepEqual((await rowsOf(page)).slice(0, 2), [
        [6, 'undo of edge_split', false, false],
        [5, 'undo of vertex_move', false, false],
    ]);
    // The focus must stay in the list, and not go back to the top of the page.
    assert.equal(await page.evaluate(() => document.activeElement.id), 'history');
    await page.getByRole('button', { name: 'Redo' }).click();
    await waitForFrame(page, { revision: 7 });
    assert.deepEqual((await rowsOf(page))[0], [7, 'redo of edge_split', false, true]);
    await page.locator('#history button.entry').last().click();
    await waitForFrame(page, { revision: 9 });
    assert.equal((await get(daemon, `/${mesh}`)).counts.faces, 6);
    assert.ok(await page.getByRole('button', { name: 'Undo', exact: true }).isDisabled());
    // Nothing is left to undo: the mesh is as it was made, and that row is marked.
    const rows = await rowsOf(page);
    assert.deepEqual(rows.pop(), [1, 'original', false, true]);
    assert.ok(rows.every(([, , canGo, isNow]) => !canGo && !isNow));
});

test('the history says in words that a mesh was replaced', async (t) => {
    const { daemon, mesh, page } = await openMesh(t, CUBE);
    await fetch(`${daemon.url}/v1/meshes/${mesh}`, {
        method: 'PUT',
        headers: { 'Content-Type': 'application/json' },
        body: JSON.stringify({ shape: 'torus' }),
    });
    await waitForFrame(page, { revision: 2 });
    assert.deepEqual(await rowsOf(page), [[2, 'replaced by another mesh', false, true]]);
    await checkAccessible(page, 'replaced', '#details');
});

test('a long history is read on by a button', async (t) => {
    const { daemon, mesh, page } = await openMesh(t, CUBE);
    for (let i = 0; i < 25; i++) {
        await post(daemon, `/${mesh}/edits`, { op: 'face_poke', face: i });
    }
    await waitForFrame(page, { revision: 26 });
    assert.equal((await rowsOf(page)).length, 20);
    await page.getByRole('button', { name: 'Show older' }).click();
    await page.locator('#history li').nth(25).waitFor();
    assert.ok(await page.getByRole('button', { name: 'Show older' }).isHidden());
    const revisions = (await rowsOf(page)).map(([revision]) => revision);
    assert.deepEqual(revisions, Array.from({ length: 26 }, (_, i) => 26 - i));
});

// Makes the page believe that the server's jobs still run. Returns a function that ends this.
async function keepRunning(page) {
    let isHeld = true;
    await page.route('**/v1/jobs/*', async (route) => {
        const answer = await route.fetch();
        const running = { state: 'running', phase: 'reading', progress: 0.4, finished: null };
        await (isHeld && route.request().method() === 'GET' && answer.ok()
            ? route.fulfill({ json: { ...(await answer.json()), ...running } })
            : route.fulfill({ response: answer }));
    });
    return () => {
        isHeld = false;
    };
}

async function runWhole(page, name) {
    await chooseOperation(page, name);
    await page.getByRole('button', { name: 'Apply' }).click();
}

test('an operation on the whole mesh shows how far it is, and how it ended', async (t) => {
    const { daemon, mesh, page } = await openMesh(t, { shape: 'icosphere', subdivisions: 2 });
    const asked = page.waitForRequest(isEdit);
    const release = await keepRunning(page);
    await runWhole(page, 'compact');
    assert.equal((await asked).headers().prefer, 'respond-async');
    await page.getByText('compact: reading').waitFor();
    assert.equal(await page.locator('#work-progress').evaluate((bar) => bar.value), 0.4);
    assert.ok(await page.getByRole('button', { name: 'Undo', exact: true }).isDisabled());
    await checkAccessible(page, 'working');
    release();
    await waitForTold(page, /compact.*All ids are new\. This edit cannot be undone\./);
    await checkAccessible(page, 'done');
    await waitForFrame(page, { mesh, revision: 2 });
    assert.ok(await page.locator('#work').isHidden());
    assert.equal((await get(daemon, `/${mesh}`)).revision, 2);
    // A small edit must not request a job.
    const small = page.waitForRequest(isEdit);
    await chooseOperation(page, 'face_poke');
    await page.locator('#param-face').fill('0');
    await page.getByRole('button', { name: 'Apply' }).click();
    assert.equal((await small).headers().prefer, undefined);
    await waitForFrame(page, { revision: 3 });
});

test('an operation that is refused as a job says why', async (t) => {
    // If the form is filled slowly, the page tries the edit as a dry run before the user sends it,
    // and the dry run may be refused.
    const { page } = await openMesh(t, CUBE, { allowed: [/status of 400/] });
    await chooseOperation(page, 'plane_split');
    await fillVector(page, 'point', [0, 0, 0]);
    await fillVector(page, 'normal', [0, 0, 0]);
    await page.getByRole('button', { name: 'Apply' }).click();
    await expectToast(page, /normal/);
    await waitForFrame(page, { revision: 1 });
});

// Answers the page's request with a job of the test's own, which runs until it is cancelled; a job
// of the daemon would have ended before the page could cancel it.
async function fakeJob(page, pattern) {
    const job = { id: 'fake', state: 'running', phase: 'pairing', progress: 0.7, finished: null };
    let body = job;
    await page.route(pattern, (route) =>
        route.request().method() === 'POST'
            ? route.fulfill({ status: 202, json: { ...job, state: 'queued', progress: 0 } })
            : route.continue(),
    );
    await page.route('**/v1/jobs/fake', (route) => {
        if (route.request().method() === 'DELETE') {
            body = { ...job, state: 'cancelled', finished: '2026-01-01T00:00:00.000Z' };
        }
        return route.fulfill({ json: body });
    });
}

test('a job is given up by its button, and nothing is changed', async (t) => {
    const { daemon, mesh, page } = await openMesh(t, CUBE);
    await fakeJob(page, '**/edits');
    await runWhole(page, 'compact');
    await page.getByText('compact: pairing').waitFor();
    await page.getByRole('button', { name: 'Cancel', exact: true }).focus();
    await page.keyboard.press('Enter');
    await expectToast(page, /Cancelled/);
    assert.ok(await page.locator('#work').isHidden());
    assert.equal((await get(daemon, `/${mesh}`)).revision, 1);
    await page.unrouteAll();
    await runWhole(page, 'compact');
    await waitForFrame(page, { revision: 2 });
});

test('an upload is given up while it is sent and while it is read', async (t) => {
    const daemon = await startDaemon(t);
    const page = await openPage(t, daemon, { allowed: [/ERR_FAILED|ERR_ABORTED/] });
    const upload = (name) =>
        page.locator('#file').setInputFiles({
            name,
            mimeType: '',
            buffer: Buffer.from('OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n'),
        });
    const cancel = page.getByRole('button', { name: 'Cancel the upload' });
    await page.route('**/v1/meshes?name=*', () => {}, { times: 1 }); // never answered
    await upload('sent.off');
    await page.getByText('sent.off').waitFor();
    await cancel.click();
    await expectToast(page, /Cancelled/);
    await page.getByRole('button', { name: 'Close message' }).click();
    await fakeJob(page, '**/v1/meshes?name=*');
    await upload('read.off');
    await page.getByText('Reading read.off: pairing').waitFor();
    await checkAccessible(page, 'upload as a job');
    await cancel.click();
    await expectToast(page, /Cancelled/);
    assert.ok(await page.locator('#uploading').isHidden());
    assert.deepEqual((await get(daemon, '')).items, []);
    // From here on the daemon answers the page's requests itself, so the page must wait for the
    // daemon's job.
    await page.unrouteAll();
    await upload('whole.off');
    await waitForTold(page, /Read whole\.off.*3 vertices, 1 face/);
    await page.locator('#canvas[data-revision="1"]').waitFor();
    assert.equal((await get(daemon, '')).items[0].name, 'whole');
});
