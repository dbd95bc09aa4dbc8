// Tests of two pages with one mesh: who is there, what they have selected, what they change, and links
// to what one of them shows.

import assert from 'node:assert/strict';
import { test } from 'node:test';

import { checkAccessible, readCanvas, waitForFrame } from './browser.mjs';
import { get, post } from './daemon.mjs';
import { cameraOf, goTo, press } from './page.mjs';
import { openMesh, openPage } from './visit.mjs';

const GRID = { name: 'grid', shape: 'grid', columns: 4, rows: 4 };
const people = (page) => page.locator('#people li');

async function openTwo(t) {
    const opened = await openMesh(t, GRID);
    const second = await openPage(t, opened.daemon, { path: `/#mesh=${opened.mesh}` });
    await waitForFrame(second, { mesh: opened.mesh, revision: 1 });
    await people(opened.page).waitFor();
    await people(second).waitFor();
    return { ...opened, second };
}

async function setName(page, name) {
    await page.getByRole('textbox', { name: 'Your name, as others see it' }).fill(name);
    await page.keyboard.press('Tab');
}

// Returns how many pixels of the canvas have nearly this colour, [red, green, blue].
async function countOf(page, wanted) {
    const { width, height, colour } = await readCanvas(page);
    let count = 0;
    for (let y = 0; y < height; y += 2) {
        for (let x = 0; x < width; x += 2) {
            count += colour(x, y).every((value, i) => Math.abs(value - wanted[i]) < 12);
        }
    }
    return count;
}

const colourOf = (page) =>
    people(page)
        .locator('.sample')
        .evaluate((sample) => getComputedStyle(sample).backgroundColor.match(/\d+/g).map(Number));

test('each sees who else is there and what they have selected', async (t) => {
    const { daemon, mesh, page, second } = await openTwo(t);
    const before = await get(daemon, `/${mesh}`);
    await setName(second, 'Ada <i>');
    await people(page).getByText('Ada <i>').waitFor();
    await people(page).getByText('nothing selected').waitFor();
    const colour = await colourOf(page);
    await page.locator('#canvas').blur();
    assert.equal(await countOf(page, colour), 0);
    await goTo(second, 'face', 5);
    await people(page).getByText('face 5').waitFor();
    const label = page.locator('#others .who');
    await label.getByText('Ada <i>').waitFor();
    // The outline of the face has the colour of the other client.
    await page.waitForFunction(() => !document.querySelector('#others .who').hidden);
    assert.ok((await countOf(page, colour)) > 10);
    await checkAccessible(page, 'another client');
    for (const [kind, words] of [['edge', 'edge 3'], ['halfedge', 'half-edge 3'], ['vertex', 'vertex 3']]) {
        await goTo(second, kind, 3);
        await people(page).getByText(words).waitFor();
        await label.waitFor();
        assert.ok((await countOf(page, colour)) > 5, kind);
    }
    await press(second, 'Escape');
    await people(page).getByText('nothing selected').waitFor();
    await label.waitFor({ state: 'detached' });
    assert.equal(await countOf(page, colour), 0);
    // The name stays with the browser profile, the mesh has not changed.
    assert.deepEqual(await get(daemon, `/${mesh}`), before);
});

test('who closes the page is gone at once', async (t) => {
    const { page, second } = await openTwo(t);
    await page.getByText('1 other at this mesh.').waitFor();
    await second.goto('about:blank');
    await page.getByText('Nobody else is at this mesh.').waitFor();
    assert.equal(await people(page).count(), 0);
});

test('one sees what another looks at', async (t) => {
    const { page, second } = await openTwo(t);
    await second.locator('#canvas').focus();
    await second.keyboard.press('Shift+ArrowLeft');
    const camera = await cameraOf(second);
    const numbers = (text) => text.split(',').map((value) => Number(Number(value).toPrecision(3)));
    await page.waitForFunction(
        async (mesh) => {
            const { clients } = await (await fetch(`v1/meshes/${mesh}/presence`)).json();
            return clients.length === 2;
        },
        await page.locator('#canvas').getAttribute('data-mesh'),
    );
    // The camera of the second page arrives with its next presence.
    let seen;
    for (let tries = 0; tries < 300 && seen?.join() !== numbers(camera).join(); tries++) {
        await people(page).getByRole('button').click();
        await page.evaluate(() => new Promise(requestAnimationFrame));
        const now = await cameraOf(page);
        seen = now === undefined ? undefined : numbers(now);
    }
    assert.deepEqual(seen, numbers(camera));
});

test('a change by another client is marked for a moment, an own one is not', async (t) => {
    const options = { reducedMotion: 'no-preference' };
    const { daemon, mesh, page } = await openMesh(t, GRID, options);
    const isMark = [244, 246, 250];
    await page.clock.install();
    await page.clock.pauseAt(new Date(Date.now() + 1e6));
    await page.locator('#canvas').blur();
    await post(daemon, `/${mesh}/edits`, { op: 'face_poke', face: 5 });
    // The clock is turned a little at a time, so that the mark is still there when it is seen.
    const shown = page.locator('#canvas[data-revision="2"]');
    for (let steps = 0; steps < 3000 && (await shown.count()) === 0; steps++) {
        await page.clock.runFor(16);
    }
    assert.ok((await countOf(page, isMark)) > 10);
    // The mark goes away by itself.
    await page.clock.runFor(2000);
    assert.equal(await countOf(page, isMark), 0);
    await page.clock.resume();
    await goTo(page, 'face', 9);
    await page.getByRole('button', { name: 'Split' }).click();
    await waitForFrame(page, { revision: 3 });
    await press(page, 'Escape');
    await page.locator('#canvas').blur();
    assert.equal(await countOf(page, isMark), 0);
});

test('a link shows another what one sees', async (t) => {
    const { daemon, mesh, page } = await openMesh(t, GRID);
    await page.context().grantPermissions(['clipboard-read', 'clipboard-write']);
    await goTo(page, 'face', 3);
    await page.locator('#canvas').focus();
    await page.keyboard.press('Shift+ArrowLeft');
    const camera = await cameraOf(page);
    await page.getByRole('button', { name: 'Share' }).click();
    await page.getByText('Link copied').waitFor();
    const link = await page.evaluate(() => navigator.clipboard.readText());
    assert.ok(link.startsWith(`${daemon.url}/#mesh=${mesh}&face=3&camera=`), link);
    const other = await openPage(t, daemon, { path: link.slice(daemon.url.length) });
    await waitForFrame(other, { mesh, revision: 1, selection: 'face:3' });
    assert.equal(await cameraOf(other), camera);
});

test('a link shows the look, the section and the colours, too', async (t) => {
    const { daemon, mesh, page } = await openMesh(t, GRID);
    await page.getByRole('button', { name: 'View', exact: true }).click();
    await page.getByRole('radio', { name: 'X-ray' }).check();
    await page.locator('#section-axes').getByRole('radio', { name: 'X', exact: true }).check();
    await page.getByLabel('Exact position of the section').fill('0.25');
    await page.locator('#colour-by').focus();
    await page.locator('#colour-by option[value="measure/faces/area"]').waitFor({ state: 'attached' });
    await page.locator('#colour-by').selectOption('measure/faces/area');
    await page.locator('#canvas[data-colour^="measure/faces/area"]').waitFor();
    const shown = await page.evaluate(() => new URLSearchParams(location.hash.slice(1)).get('mesh'));
    assert.equal(shown, mesh);
    await page.context().grantPermissions(['clipboard-read', 'clipboard-write']);
    await page.getByRole('button', { name: 'Share' }).click();
    await page.getByText('Link copied').waitFor();
    const link = await page.evaluate(() => navigator.clipboard.readText());
    const other = await openPage(t, daemon, { path: link.slice(daemon.url.length) });
    await other.locator('#canvas[data-colour^="measure/faces/area"]').waitFor();
    await other.getByRole('button', { name: 'View', exact: true }).click();
    assert.ok(await other.getByRole('radio', { name: 'X-ray' }).isChecked());
    assert.equal(await other.getByLabel('Exact position of the section').inputValue(), '0.25');
    // A link of another origin may say anything.
    const wrong = await openPage(t, daemon, { path: `/#mesh=${mesh}&look={"way":7&colour=x~y~z~1` });
    await waitForFrame(wrong, { mesh, revision: 1 });
});

test('a link with several elements selects them all', async (t) => {
    const { daemon, mesh } = await openMesh(t, GRID);
    const page = await openPage(t, daemon, { path: `/#mesh=${mesh}&face=3,7,1&unknown=part` });
    await waitForFrame(page, { mesh, revision: 1, selection: 'face:3 face:7 face:1' });
});

test('a server that shows nobody is told about, and the page works', async (t) => {
    const { daemon, mesh, page } = await openMesh(t, GRID, { allowed: [/503/] });
    for (let i = 0; i < 64; i++) {
        await fetch(`${daemon.url}/v1/meshes/${mesh}/presence`, {
            method: 'PUT',
            headers: { 'Content-Type': 'application/json' },
            body: JSON.stringify({ client: `c${i}` }),
        });
    }
    const second = await openPage(t, daemon, {
        path: `/#mesh=${mesh}`,
        allowed: [/503/],
    });
    await second.getByText('The server does not show you to others now.').waitFor();
    await checkAccessible(second, 'many clients', '#details');
    await goTo(second, 'face', 2);
    await page.locator('#people li').first().waitFor();
});
