// Tests of the view in Chromium where it is difficult: on a telephone, with a graphics driver that
// cannot draw a look, and with large meshes: what is drawn while the camera moves, and how many bytes
// are given to the graphics memory.

import assert from 'node:assert/strict';
import { test } from 'node:test';

import { checkAccessible, isBackground, isSurface, readCanvas, waitForFrame } from './browser.mjs';
import { get, post, startDaemon } from './daemon.mjs';
import { cameraOf, click, expectToast, press } from './page.mjs';
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
    await choose(page, 'X-ray');
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

test('while the camera moves, a simpler mesh is drawn, and the whole one when it rests', async (t) => {
    const side = 220;
    const { page, daemon, mesh } = await openMesh(t, {
        name: 'large', shape: 'torus', major_segments: side, minor_segments: side,
    });
    const drawn = () => page.locator('#canvas').getAttribute('data-drawn');
    await openView(page);
    await page.getByRole('combobox', { name: 'While moving' }).selectOption('Always simpler');
    // The simpler mesh is computed in the background; the wheel is turned until it is used.
    const box = await page.locator('#canvas').boundingBox();
    await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
    await page.mouse.down();
    let isProxy = false;
    for (let i = 0; !isProxy; i++) {
        await page.mouse.move(box.x + box.width / 2 + (i % 2) * 40, box.y + box.height / 2);
        await waitForDrawing(page);
        isProxy = (await drawn()) === 'proxy';
    }
    const moving = await readCanvas(page);
    await page.mouse.up();
    await page.locator('#canvas[data-drawn="mesh"]').waitFor();
    const rest = await draw(page);
    // the simpler mesh covers the same pixels, except at the outline
    const filled = (canvas) => canvas.count - canvas.countOf(isBackground);
    assert.ok(Math.abs(filled(moving) - filled(rest)) < 0.03 * filled(rest),
        `${filled(moving)} and ${filled(rest)} pixels`);
    // a picked face is one of the mesh
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
    const box = await page.locator('#canvas').boundingBox();
    const canvas = page.locator('#canvas');
    const isColoured = ([r, g, b]) => Math.max(r, g, b) - Math.min(r, g, b) > 60;
    // Returns the numbers of coloured pixels while the camera moves, and when it rests.
    const countColoured = async (key) => {
        await page.locator('#colour-by').selectOption(key);
        await page.locator(`#canvas[data-color="${key} 1"]`).waitFor();
        await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
        await page.mouse.down();
        let isProxy = false;
        for (let i = 0; !isProxy; i++) {
            await page.mouse.move(box.x + box.width / 2 + (i % 2), box.y + box.height / 2);
            await waitForDrawing(page);
            isProxy = (await canvas.getAttribute('data-drawn')) === 'proxy';
        }
        const moving = (await readCanvas(page)).countOf(isColoured);
        await page.mouse.up();
        await page.locator('#canvas[data-drawn="mesh"]').waitFor();
        return [moving, (await draw(page)).countOf(isColoured)];
    };
    for (const key of ['KEYF', 'KEYV']) {
        const [moving, still] = await countColoured(key);
        assert.ok(still > 20000 && Math.abs(moving - still) < 0.1 * still, `${key}: ${moving}, then ${still}`);
    }
    // The sides of its triangles are no edges of the mesh, so they have no values.
    const [moving, still] = await countColoured('KEYE');
    assert.ok(still > 20000 && moving < 0.1 * still, `${moving}, then ${still}`);
});

// Counts the bytes that are given to the graphics memory.
function countUploads() {
    window.uploaded = 0;
    const { prototype } = WebGL2RenderingContext;
    for (const name of ['bufferData', 'bufferSubData', 'texImage2D', 'texSubImage2D']) {
        const original = prototype[name];
        prototype[name] = function (...values) {
            const data = values.findLast((one) => ArrayBuffer.isView(one) || one instanceof ArrayBuffer);
            if (name.startsWith('tex')) {
                // width x height texels of 16 bytes: all textures of the mesh have such texels
                const [width, height] = values.slice(name === 'texImage2D' ? 3 : 4);
                window.uploaded += data === undefined ? 0 : 16 * width * height;
            } else {
                window.uploaded += data?.byteLength ?? 0;
            }
            return original.apply(this, values);
        };
    }
}

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
