// Levels of detail in the page: the mesh from coarse to fine, a slider, and the way back.

import assert from 'node:assert/strict';
import { test } from 'node:test';

import { checkAccessible, isSurface, readCanvas, waitForFrame } from './browser.mjs';
import { get, post } from './daemon.mjs';
import { click, expectToast, press } from './page.mjs';
import { openMesh } from './visit.mjs';

const SPHERE = { name: 'sphere', shape: 'icosphere', subdivisions: 2 };
const FACES = 320;

const levels = (page) => page.getByRole('button', { name: 'Levels' });
const slider = (page) => page.getByRole('slider', { name: 'Level' });

// Until a frame with so many faces is on the screen.
const waitForFaces = (page, faces) => page.locator(`#canvas[data-faces="${faces}"]`).waitFor();

const waitForMesh = (page) => page.locator('#canvas:not([data-faces])').waitFor();

// The faces of all frames from now on, until one has so many.
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
    const { daemon, mesh, page } = await openMesh(t, SPHERE);
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

    // Who works by keys is at the slider.
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

    // Nothing is picked or edited.
    const { width, height } = await page.locator('#canvas').boundingBox();
    await click(page, { x: width / 2, y: height / 2 });
    await press(page, 'x');
    await press(page, 'g');
    for (const name of ['Move', 'Apply', 'Split', 'Delete']) {
        assert.ok(await page.getByRole('button', { name, exact: true }).isDisabled(), name);
    }
    assert.match(await page.locator('#level-hint').textContent(), /Picking and editing are off/);
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
    // Without motion the mesh is there as soon as it has come.
    await levels(page).click();
    await waitForFaces(page, FACES);
    const { items } = await get(daemon, '');
    const { id: sphere } = items.find(({ name }) => name === 'sphere');
    await post(daemon, `/${sphere}/edits`, { op: 'face_poke', face: 0 });
    await waitForFrame(page, { revision: 2 });
    await waitForMesh(page);
    await page.getByRole('status').filter({ hasText: 'Back to the mesh' }).waitFor();

    await levels(page).click();
    await waitForFaces(page, FACES + 2);
    // Who picks for a field wants the mesh, who wants levels no longer picks.
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

    // A cube has no triangles: the server says what to do.
    await levels(page).click();
    await expectToast(page, /triangulate first/);
    assert.ok(await page.locator('#levels').isHidden());
    assert.equal(await levels(page).getAttribute('aria-pressed'), 'false');
    assert.ok(await page.getByRole('button', { name: 'Apply', exact: true }).isVisible());
});
