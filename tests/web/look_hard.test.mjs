// Tests of the view in Chromium where it is difficult: on a telephone, with a graphics driver that
// cannot draw a look, and with large meshes: what is drawn while the camera moves, and how many bytes
// are given to the graphics memory.

import assert from 'node:assert/strict';
import { test } from 'node:test';

import { checkAccessible, isBackground, isSurface, readCanvas, readPicture, waitForFrame } from './browser.mjs';
import { get, post, startDaemon } from './daemon.mjs';
import { cameraOf, click, expectToast, press } from './page.mjs';
import { countUploads } from './uploads.mjs';
import { lookOf, openView, setLook, waitForDrawing } from './view_panel.mjs';
import { openMesh, openPage } from './visit.mjs';

const TORUS = { name: 'torus', shape: 'torus', major_segments: 24, minor_segments: 12 };

const choose = (page, name) => page.locator('#view-form').getByRole('radio', { name, exact: true }).check();

async function draw(page) {
    await waitForDrawing(page);
    return readCanvas(page);
}

test('on a telephone the panel leaves the mesh in sight', async (t) => {
    const { page } = await openMesh(t, TORUS, { viewport: { width: 320, height: 640 } });
    await openView(page);
    await choose(page, 'Free');
    const panel = await page.locator('#view-panel').boundingBox();
    const canvas = await page.locator('#canvas').boundingBox();
    assert.ok(panel.x >= 0 && panel.x + panel.width <= 320, JSON.stringify(panel));
    assert.ok(panel.y - canvas.y > 240, `${panel.y - canvas.y} pixels of the view are visible`);
    assert.equal(await page.evaluate(() => document.documentElement.scrollWidth), 320);
    assert.equal(
        await page.locator('#view-panel').evaluate((box) => box.scrollWidth - box.clientWidth), 0);
    const controls = await page.locator('#view-panel :is(input, select, button):visible').all();
    assert.ok(controls.length > 25, `${controls.length} controls`);
    for (const control of controls) {
        await control.scrollIntoViewIfNeeded();
        const { x, y, width, height } = await control.boundingBox();
        assert.ok(x >= 0 && x + width <= 320);
        assert.ok(y >= panel.y && y + height <= panel.y + panel.height + 1, `${y} is in the panel`);
    }
    // the view stays where it is, whatever is scrolled
    assert.deepEqual(await page.locator('#canvas').boundingBox(), canvas);
    await checkAccessible(page, 'telephone');
});

test('a look whose program does not compile is given up, and the mesh is drawn plainly', async (t) => {
    const daemon = await startDaemon(t);
    const { id: mesh } = await post(daemon, '', TORUS);
    const page = await openPage(t, daemon, {
        init: () => {
            const { prototype } = WebGL2RenderingContext;
            const { shaderSource } = prototype;
            prototype.shaderSource = function (shader, source) {
                const isLook = source.includes('#define LOOKED') && source.includes('matcap');
                shaderSource.call(this, shader, isLook ? source.replace('void main', 'void 1') : source);
            };
        },
    });
    await waitForFrame(page, { mesh, revision: 1 });
    const before = (await readCanvas(page)).countOf(isSurface);
    await openView(page);
    // The page goes back to a plain look at once, so that the button does not stay pressed.
    await page.locator('#view-form').getByRole('radio', { name: 'X-ray', exact: true }).click();
    await expectToast(page, /This look cannot be drawn.*drawn without it/);
    await page.getByRole('button', { name: 'Close message' }).click(); // it covers a part of the view
    const after = await draw(page);
    assert.equal(after.countOf(isSurface), before);
    assert.equal((await lookOf(page)).way, 'solid');
    assert.ok(await page.getByRole('radio', { name: 'Wires' }).isDisabled());
    await checkAccessible(page, 'look given up');
    // it still can be turned and picked in
    await press(page, '+');
    await waitForDrawing(page);
    assert.ok((await readCanvas(page)).countOf(isSurface) > before);
});

// Turns the wheel until the simpler mesh, which is computed in the background, is drawn, and then lets the
// camera rest. Returns the pictures of both frames, as they are in the canvas.
async function moveAndRest(page) {
    const urls = await page.evaluate(() => new Promise((resolve) => {
        const canvas = document.getElementById('canvas');
        const pictures = [];
        // A frame is in the canvas until the task in which it was drawn ends.
        const observer = new MutationObserver(() => {
            if (canvas.dataset.drawn === ['proxy', 'mesh'][pictures.length]) {
                pictures.push(canvas.toDataURL());
            }
            if (pictures.length === 2) {
                observer.disconnect();
                resolve(pictures);
            }
        });
        observer.observe(canvas, { attributeFilter: ['data-drawn'] });
        let turns = 0;
        const move = () => {
            if (pictures.length === 0) {
                canvas.dispatchEvent(new WheelEvent('wheel', { deltaY: turns++ % 2 ? 10 : -10 }));
                requestAnimationFrame(move);
            }
        };
        move();
    }));
    return urls.map((url) => readPicture(Buffer.from(url.slice(url.indexOf(',') + 1), 'base64')));
}

test('while the camera moves, a simpler mesh is drawn, and the whole one when it rests', async (t) => {
    const side = 220;
    const { page, daemon, mesh } = await openMesh(t, {
        name: 'large', shape: 'torus', major_segments: side, minor_segments: side,
    });
    const drawn = () => page.locator('#canvas').getAttribute('data-drawn');
    await openView(page);
    await page.getByRole('combobox', { name: 'While moving' }).selectOption('Always simpler');
    const [moving, rest] = await moveAndRest(page);
    // the pictures differ, but the simpler mesh covers the same pixels, except at the outline
    assert.notEqual(moving.countOf(isSurface), rest.countOf(isSurface));
    const filled = (canvas) => canvas.count - canvas.countOf(isBackground);
    assert.ok(Math.abs(filled(moving) - filled(rest)) < 0.03 * filled(rest),
        `${filled(moving)} and ${filled(rest)} pixels`);
    // a picked face is one of the mesh
    const box = await page.locator('#canvas').boundingBox();
    await click(page, { x: box.width / 2, y: 0.68 * box.height });
    await page.locator('#canvas[data-selection^="face"]').waitFor();
    const chosen = await page.locator('#canvas').getAttribute('data-selection');
    assert.ok((await get(daemon, `/${mesh}/faces/${chosen.slice(5)}`)).vertices.length === 4);
    await page.getByRole('combobox', { name: 'While moving' }).selectOption('Whole mesh');
    await page.mouse.wheel(0, 100);
    await waitForDrawing(page);
    assert.equal(await drawn(), 'mesh');
});

test('the simpler mesh has the colours of values, where they belong to vertices or faces', async (t) => {
    const side = 220;
    const { page } = await openMesh(t, {
        name: 'large', shape: 'torus', major_segments: side, minor_segments: side,
    });
    await openView(page);
    await page.getByRole('combobox', { name: 'While moving' }).selectOption('Always simpler');
    await setLook(page, { hasEdges: false }); // the simpler mesh has none
    const isColoured = ([r, g, b]) => Math.max(r, g, b) - Math.min(r, g, b) > 60;
    const countColoured = async (key) => {
        await page.getByLabel('Colour by').focus();
        await page.locator(`#colour-by option[value="${key}"]`).waitFor({ state: 'attached' });
        await page.getByLabel('Colour by').selectOption(key);
        await page.locator(`#canvas[data-colour="${key} 1"]`).waitFor();
        return (await moveAndRest(page)).map((picture) => picture.countOf(isColoured));
    };
    for (const key of ['measure/faces/area', 'measure/vertices/gaussian_curvature']) {
        const [moving, still] = await countColoured(key);
        assert.ok(still > 20000 && Math.abs(moving - still) < 0.1 * still, `${key}: ${moving}, then ${still}`);
    }
    // The sides of its triangles are no edges of the mesh, so they have no values.
    const [moving, still] = await countColoured('measure/edges/dihedral');
    assert.ok(still > 20000 && moving < 0.1 * still, `${moving}, then ${still}`);
});

test('a frame uploads nothing, and an edit only what it changed', async (t) => {
    const { page, daemon, mesh } = await openMesh(t, {
        name: 'large', shape: 'torus', major_segments: 200, minor_segments: 200,
    }, { init: countUploads });
    const taken = () => page.evaluate(() => {
        const bytes = window.uploaded;
        window.uploaded = 0;
        return bytes;
    });
    const first = await taken();
    assert.ok(first > 16 * (40000 + 80000), `${first} bytes for 40,000 vertices and 80,000 triangles`);
    for (const state of [{}, { isSmooth: true }, { section: { axis: 'x', at: 0.01 } }, { hasGrid: true, hasBox: true }]) {
        await setLook(page, state);
        await cameraOf(page);
        await taken();
        await press(page, '+');
        await waitForDrawing(page);
        await press(page, '-');
        await waitForDrawing(page);
        const bytes = await taken();
        console.log(`note: ${JSON.stringify(state)}: ${bytes} bytes in two frames`);
        assert.equal(bytes, 0, JSON.stringify(state));
    }
    await setLook(page, { isSmooth: false, section: null, hasGrid: false, hasBox: false });
    await taken();
    await post(daemon, `/${mesh}/edits`, { op: 'face_poke', face: 17 });
    await waitForFrame(page, { mesh, revision: 2 });
    const bytes = await taken();
    console.log(`note: an edit of 40,000 faces: ${bytes} bytes uploaded`);
    assert.ok(bytes > 0 && bytes < 100000, `${bytes}`);
});
