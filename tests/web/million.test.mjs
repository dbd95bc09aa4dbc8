// Tests that a torus of a million quadrilaterals can be opened, picked in, edited and undone.

import assert from 'node:assert/strict';
import { test } from 'node:test';

import { countBytes, isChosen, isSurface, readCanvas, waitForFrame } from './browser.mjs';
import { get, post, startDaemon } from './daemon.mjs';
import { checkInspector, click, goTo, press, setMode } from './page.mjs';
import { openPage } from './visit.mjs';

const SIDE = 1000;

const waitForStatistics = (page, { faces, revision }) =>
    page.waitForFunction(
        ([count, at]) => {
            const of = (name) => document.querySelector(`[data-statistic="${name}"]`).textContent;
            return of('faces').replaceAll(',', '') === count && of('revision') === at;
        },
        [`${faces}`, `${revision}`],
    );

test('a torus of a million quads opens, is picked in, edited and undone', async (t) => {
    const daemon = await startDaemon(t);
    const shape = { shape: 'torus', major_segments: SIDE, minor_segments: SIDE };
    const { id: mesh, counts } = await post(daemon, '', { name: 'torus', ...shape });
    assert.equal(counts.faces, SIDE * SIDE);
    const page = await openPage(t, daemon, { path: `/#mesh=${mesh}` });
    await waitForFrame(page, { mesh, revision: 1 });
    assert.ok((await readCanvas(page)).countOf(isSurface) > 50000);

    const { width, height } = await page.locator('#canvas').boundingBox();
    const place = { x: width / 2, y: 0.68 * height };
    const picked = async (kind) => {
        await click(page, place);
        await page.locator(`#canvas[data-selection^="${kind}"]`).waitFor();
        const selection = await page.locator('#canvas').getAttribute('data-selection');
        const id = Number(selection.slice(kind.length + 1));
        await checkInspector({ daemon, mesh, page }, kind, id);
        return id;
    };
    const face = await picked('face');
    await press(page, 'f');
    await page.locator('#canvas').blur();
    const canvas = await readCanvas(page);
    assert.ok(isChosen(canvas.colour(width / 2, height / 2)));
    assert.ok(canvas.countOf(isChosen) > 1000);

    // After an edit the page must fetch only the changed parts of the arrays, and the statistics.
    const bytes = await countBytes(page);
    const whole = [];
    page.on('request', (request) => {
        if (request.url().endsWith('/geometry')) {
            whole.push(request.url());
        }
    });
    await page.getByRole('button', { name: 'Split' }).click();
    await waitForFrame(page, { revision: 2 });
    assert.equal((await get(daemon, `/${mesh}`)).counts.faces, counts.faces + 3);
    await waitForStatistics(page, { faces: counts.faces + 3, revision: 2 });
    console.log(`note: an edit of ${counts.faces} faces: ${bytes()} bytes`);
    assert.ok(bytes() > 100 && bytes() < 65536, `${bytes()} bytes`);
    // The last of the new faces must have the members that the server says.
    const made = counts.faces + 2;
    await goTo(page, 'face', made);
    await checkInspector({ daemon, mesh, page }, 'face', made);
    await press(page, 'Control+z');
    await waitForFrame(page, { revision: 3, selection: '' });
    assert.equal((await get(daemon, `/${mesh}`)).counts.faces, counts.faces);
    // After an edit of another client the page must not fetch more bytes than after its own edit.
    const before = bytes();
    await post(daemon, `/${mesh}/edits`, { op: 'face_poke', face });
    await waitForFrame(page, { revision: 4 });
    assert.ok(bytes() - before < 65536, `${bytes() - before} bytes`);
    assert.deepEqual(whole, []);
    await goTo(page, 'face', face);
    await setMode(page, 'Edge');
    await picked('edge');
});
