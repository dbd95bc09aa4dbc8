// Tests of levels of detail on the page: the mesh is shown from coarse to fine, a slider chooses a
// level, and at the end the mesh itself is shown again.

import assert from 'node:assert/strict';
import { test } from 'node:test';

import { checkAccessible, isSurface, readCanvas, waitForFrame, waitForTold } from './browser.mjs';
import { cuttable } from './cuttable.mjs';
import { get, post, startDaemon } from './daemon.mjs';
import { holdLevels } from './held.mjs';
import { click, expectToast, press } from './page.mjs';
import { openMesh, openPage } from './visit.mjs';

const SPHERE = { name: 'sphere', shape: 'icosphere', subdivisions: 2 };
const FACES = 320;

const levels = (page) => page.getByRole('button', { name: 'Levels' });
const back = (page) => page.getByRole('button', { name: 'Back to the mesh' });
const slider = (page) => page.getByRole('slider', { name: 'Level' });

// Waits until a frame with this number of faces is on the screen.
const waitForFaces = (page, faces) => page.locator(`#canvas[data-faces="${faces}"]`).waitFor();

const waitForMesh = (page) => page.locator('#canvas:not([data-faces])').waitFor();

// Waits until everything drawn so far is on the screen.
const waitForFrames = (page) =>
    page.evaluate(
        () =>
            new Promise((resolve) => {
                requestAnimationFrame(() => requestAnimationFrame(resolve));
            }),
    );

// Opens a mesh like openMesh(), but levels of detail arrive only as far as the test allows.
async function openHeld(t, options) {
    const daemon = await startDaemon(t);
    const { id: mesh } = await post(daemon, '', SPHERE);
    const held = await holdLevels(t, daemon);
    const page = await openPage(t, held, options);
    await waitForFrame(page, { mesh, revision: 1 });
    // Presses the button that shows levels; returns the object that controls the answer, see
    // held.mjs.
    const ask = async () => {
        const next = held.next();
        await levels(page).click();
        return next;
    };
    return { daemon, mesh, page, ask };
}

// Lets the page have a part of an answer, and waits until the page has read that part.
async function sendTo(page, answer, part) {
    answer.sendTo(part);
    await page.waitForFunction(
        (least) => document.getElementById('level-progress').value > least,
        part - 0.1,
    );
    await waitForFrames(page);
}

async function checkGivenUp(page) {
    await waitForMesh(page);
    assert.ok(await page.locator('#levels').isHidden());
    assert.equal(await levels(page).getAttribute('aria-pressed'), 'false');
}

// Returns a promise of the numbers of faces in all frames from now on, up to the first frame with
// `faces` faces.
function seenUntil(page, faces) {
    return page.evaluate(
        (last) =>
            new Promise((resolve) => {
                const canvas = document.getElementById('canvas');
                const seen = [];
                const look = () => {
                    if (canvas.dataset.faces !== undefined) {
                        seen.push(Number(canvas.dataset.faces));
                    }
                    if (seen.at(-1) === last) {
                        observer.disconnect();
                        resolve(seen);
                    }
                };
                const observer = new MutationObserver(look);
                observer.observe(canvas, { attributeFilter: ['data-faces'] });
                look();
            }),
        faces,
    );
}

test('a mesh is shown from coarse to fine, and any level by a slider', async (t) => {
    const { daemon, mesh, page } = await openMesh(t, SPHERE, { reducedMotion: 'no-preference' });
    const surface = async () => (await readCanvas(page)).countOf(isSurface);
    const whole = await surface();
    const seen = seenUntil(page, FACES);
    await levels(page).focus();
    await page.keyboard.press('Enter');
    const counts = await seen;
    assert.equal(counts[0], 4);
    assert.ok(counts.length > 5, `${counts.length} frames`);
    assert.ok(counts.every((count, i) => i === 0 || count > counts[i - 1]), `${counts}`);
    await page.getByRole('button', { name: 'Play' }).waitFor();
    assert.equal(await page.locator('#level-faces').textContent(), '320 of 320 faces');
    assert.ok(await page.locator('#level-progress').isHidden());

    // The focus must be on the slider, so that users of a keyboard can move it at once.
    assert.equal(await page.evaluate(() => document.activeElement.id), 'level');
    await page.keyboard.press('Home');
    await waitForFaces(page, 4);
    assert.equal(await slider(page).getAttribute('aria-valuetext'), '4 of 320 faces');
    const coarse = await surface();
    await page.keyboard.press('ArrowRight');
    await waitForFaces(page, 6);
    await page.keyboard.press('End');
    await waitForFaces(page, FACES);
    const fine = await surface();
    assert.ok(coarse < fine - 5000, `a tetrahedron is smaller: ${coarse} of ${fine}`);
    await slider(page).fill('100');
    await waitForFaces(page, 204);
    await checkAccessible(page, 'levels', 'main');

    // While a level is shown, a click must pick nothing, and a key must edit nothing.
    const { width, height } = await page.locator('#canvas').boundingBox();
    await click(page, { x: width / 2, y: height / 2 });
    await press(page, 'x');
    await press(page, 'g');
    for (const name of ['Move', 'Apply', 'Split', 'Delete']) {
        assert.ok(await page.getByRole('button', { name, exact: true }).isDisabled(), name);
    }
    assert.match(await page.locator('#level-hint').textContent(), /You cannot pick or edit/);
    await press(page, 'Escape');
    await waitForMesh(page);
    assert.equal(await page.locator('#canvas').getAttribute('data-selection'), '');
    assert.ok(await page.locator('#levels').isHidden());
    assert.equal(await levels(page).getAttribute('aria-pressed'), 'false');
    assert.equal(await surface(), whole);
    await click(page, { x: width / 2, y: height / 2 });
    await page.locator('#canvas[data-selection^="face"]').waitFor();
    assert.equal((await get(daemon, `/${mesh}`)).revision, 1);
});

test('levels are given up when the mesh changes, is picked in, or another is opened', async (t) => {
    const { daemon, page } = await openMesh(t, SPHERE, { allowed: [/422/] });
    await page.emulateMedia({ reducedMotion: 'reduce' });
    await post(daemon, '', { name: 'cube', shape: 'cube' });
    await page.getByRole('button', { name: 'Refresh' }).click();
    await levels(page).click();
    await waitForFaces(page, FACES);
    const { items } = await get(daemon, '');
    const { id: sphere } = items.find(({ name }) => name === 'sphere');
    await post(daemon, `/${sphere}/edits`, { op: 'face_poke', face: 0 });
    await waitForFrame(page, { revision: 2 });
    await waitForMesh(page);
    await waitForTold(page, /Back to the mesh/);

    await levels(page).click();
    await waitForFaces(page, FACES + 2);
    // If a field waits for a click in the view, showing levels must end that, because levels have
    // no ids.
    await page.getByRole('button', { name: 'Pick position in the view' }).click();
    await waitForMesh(page);
    await page.getByText('Click a vertex for position').waitFor();
    await levels(page).click();
    await waitForFaces(page, FACES + 2);
    assert.ok(await page.locator('#pick-note').isHidden());
    const { id: cube } = items.find(({ name }) => name === 'cube');
    await page.locator('#meshes button').filter({ hasText: 'cube' }).click();
    await waitForFrame(page, { mesh: cube, revision: 1 });
    await waitForMesh(page);
    assert.ok(await page.locator('#levels').isHidden());

    // The faces of a cube are no triangles, so the server refuses levels and says what to do.
    await levels(page).click();
    await expectToast(page, /triangulate first/);
    assert.ok(await page.locator('#levels').isHidden());
    assert.equal(await levels(page).getAttribute('aria-pressed'), 'false');
    assert.ok(await page.getByRole('button', { name: 'Apply', exact: true }).isVisible());
});

test('who wants no motion sees nothing between the base and all', async (t) => {
    const { page, ask } = await openHeld(t, { reducedMotion: 'reduce' });
    const seen = seenUntil(page, FACES);
    const answer = await ask();
    for (const part of [0.25, 0.5, 0.75]) {
        await sendTo(page, answer, part);
    }
    answer.sendTo(1);
    answer.end();
    assert.deepEqual(await seen, [4, FACES]);
});

test('levels are given up while they are waited for, and asked for again', async (t) => {
    const { page, ask } = await openHeld(t, { reducedMotion: 'reduce' });
    for (const giveUp of [
        () => back(page).click(),
        () => levels(page).click(),
        () => page.keyboard.press('Escape'),
    ]) {
        const answer = await ask();
        await page.getByText('The server is computing the levels').waitFor();
        assert.equal(await levels(page).getAttribute('aria-pressed'), 'true');
        await giveUp();
        await checkGivenUp(page);
        await answer.closed();
    }
    const first = await ask();
    await sendTo(page, first, 0.5);
    await waitForFaces(page, 4);
    await back(page).click();
    await checkGivenUp(page);
    await first.closed();
    const second = await ask();
    second.sendTo(1);
    second.end();
    await waitForFaces(page, FACES);
    assert.equal(await page.getByRole('alert').count(), 0);
});

test('playing waits for what has not come, and can be stopped and begun again', async (t) => {
    const { page, ask } = await openHeld(t, { reducedMotion: 'no-preference' });
    const answer = await ask();
    const valueText = () => slider(page).getAttribute('aria-valuetext');
    await sendTo(page, answer, 0.5);
    // Screen readers must hear "Playing" instead of each level that is shown while playing.
    assert.equal(await valueText(), 'Playing');
    await page.getByRole('button', { name: 'Pause' }).click();
    await page.getByRole('button', { name: 'Play' }).waitFor();
    assert.match(await valueText(), /^\d+ of 320 faces$/);
    const place = await slider(page).inputValue();
    answer.sendTo(1);
    answer.end();
    await page.locator('#level-progress').waitFor({ state: 'hidden' });
    await waitForFrames(page);
    assert.equal(await slider(page).inputValue(), place);
    await page.getByRole('button', { name: 'Play' }).click();
    await waitForFaces(page, FACES);
    // If the slider is at its end, playing must begin with the coarsest level.
    await page.getByRole('button', { name: 'Play' }).waitFor();
    const again = seenUntil(page, 4);
    await page.getByRole('button', { name: 'Play' }).click();
    assert.deepEqual(await again, [FACES, 4]);
    await page.getByRole('button', { name: 'Pause' }).click();
    await back(page).click();
    await checkGivenUp(page);
});

test('levels stay when the connection was lost and the mesh is as it was', async (t) => {
    const daemon = await startDaemon(t);
    const way = await cuttable(t, daemon);
    const { id: mesh } = await post(daemon, '', SPHERE);
    const page = await openPage(t, way, { allowed: [/ERR_/], reducedMotion: 'reduce' });
    await waitForFrame(page, { mesh, revision: 1 });
    const connection = (state) =>
        page.locator(`#connection[data-state="${state}"]`).waitFor({ state: 'attached' });
    await levels(page).click();
    await waitForFaces(page, FACES);
    way.cut();
    await connection('lost');
    const caughtUp = page.waitForResponse(/geometry\?since=/);
    way.mend();
    await connection('on');
    await (await caughtUp).finished();
    await waitForFrames(page);
    await waitForFaces(page, FACES);
    await page.keyboard.press('Home');
    await waitForFaces(page, 4);
    assert.equal(await page.getByText('Back to the mesh').count(), 1);
    // Changes that were made while levels were shown must be visible afterwards.
    way.cut();
    await connection('lost');
    await post(daemon, `/${mesh}/edits`, { op: 'face_poke', face: 0 });
    way.mend();
    await waitForFrame(page, { mesh, revision: 2 });
    await checkGivenUp(page);
});

test('a mesh that changes while its levels come is shown as it is now', async (t) => {
    const { daemon, mesh, page, ask } = await openHeld(t);
    const answer = await ask();
    await sendTo(page, answer, 0.5);
    await post(daemon, `/${mesh}/edits`, { op: 'face_poke', face: 0 });
    await waitForFrame(page, { mesh, revision: 2 });
    await waitForTold(page, /Back to the mesh/);
    await checkGivenUp(page);
    await answer.closed();
    assert.equal(await page.getByRole('alert').count(), 0);
});

test('levels that break off are said, and the mesh is back', async (t) => {
    const { mesh, page, ask } = await openHeld(t, { allowed: [/ERR_INCOMPLETE_CHUNKED/] });
    for (const [stop, text] of [['breakOff', /cannot be reached/], ['end', /did not arrive completely/]]) {
        const answer = await ask();
        await sendTo(page, answer, 0.5);
        answer[stop]();
        await expectToast(page, text);
        await checkGivenUp(page);
        await waitForFrame(page, { mesh, revision: 1 });
        await page.getByRole('button', { name: 'Close message' }).click();
    }
});

test('levels of another revision than the one that is shown are not', async (t) => {
    const { mesh, page } = await openMesh(t, SPHERE);
    await page.route('**/progressive', async (route) => {
        const body = await (await route.fetch()).body();
        body.writeBigUInt64LE(2n, 8);
        await route.fulfill({ body });
    });
    await levels(page).click();
    await waitForTold(page, /Back to the mesh/);
    await checkGivenUp(page);
    await waitForFrame(page, { mesh, revision: 1 });
    assert.equal(await page.getByRole('alert').count(), 0);
});
