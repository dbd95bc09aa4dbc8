// measure.mjs [FOLDER] - measures how long meshes of a thousand, a hundred thousand and a million
// faces take to open, to draw, to pick in and to edit, and how many bytes the page fetches after an
// edit; if FOLDER is given, saves a screenshot of each mesh there. Then measures how long levels of
// detail take: a frame of all triangles, the time until the coarsest level is shown, the frames
// while levels are played, and the frames after the slider was moved. At last measures frames while the
// camera moves, see frames.mjs.
//
// Before all that, measures the page itself: the compressed size of what it loads first, the time until
// it can be used, the time from a click to the frame in which what was clicked is highlighted, and the
// clicks, keys and seconds of each task of tasks.mjs. `ONLY=page` ends there.
//
// This is not a test: what it prints depends on the machine, and WebGL is drawn by software.

import { writeFile } from 'node:fs/promises';
import path from 'node:path';

import { countBytes, keepTold, launch, waitForFrame } from './browser.mjs';
import { get, post, startDaemon } from './daemon.mjs';
import { measureMoving } from './frames.mjs';
import { Hand, TASKS, compressedSize } from './tasks.mjs';

const SIDES = [32, 316, 1000];
const FRAMES = 5;
const PLACES = [0, 1000, 500, 900, 700, 0, 1000];

const folder = process.argv[2];
const cleanups = [];
const lifetime = { after: (act) => cleanups.push(act) };

// Returns the milliseconds from `act` until the page shows what `wait` waits for.
async function timed(act, wait) {
    const start = performance.now();
    await act();
    await wait();
    return performance.now() - start;
}

// Moves the camera a little, and returns the time until the frame is drawn.
async function frameTime(page) {
    return page.evaluate(async (frames) => {
        const canvas = document.getElementById('canvas');
        const gl = canvas.getContext('webgl2');
        const pixel = new Uint8Array(4);
        const times = [];
        for (let i = 0; i < frames; i++) {
            canvas.dispatchEvent(new WheelEvent('wheel', { deltaY: i % 2 ? 10 : -10 }));
            const start = performance.now();
            await new Promise((resolve) => requestAnimationFrame(resolve));
            // Reading a pixel waits until the frame is drawn.
            gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel);
            times.push(performance.now() - start);
        }
        return times.sort((a, b) => a - b)[Math.floor(frames / 2)];
    }, FRAMES);
}

async function measure(browser, daemon, side) {
    const shape = { shape: 'torus', major_segments: side, minor_segments: side };
    const { id: mesh, counts } = await post(daemon, '', { name: `torus ${side}`, ...shape });
    const page = await browser.newPage({ viewport: { width: 1280, height: 800 } });
    page.setDefaultTimeout(120000);
    const open = await timed(
        () => page.goto(`${daemon.url}/#mesh=${mesh}`),
        () => waitForFrame(page, { mesh, revision: 1 }),
    );
    const frame = await frameTime(page);
    const { width, height } = await page.locator('#canvas').boundingBox();
    const pick = await timed(
        () => page.locator('#canvas').click({ position: { x: width / 2, y: 0.68 * height } }),
        () => page.locator('#canvas[data-selection^="face"]').waitFor(),
    );
    const bytes = await countBytes(page);
    const edit = await timed(
        () => page.getByRole('button', { name: 'Split' }).click(),
        () => waitForFrame(page, { revision: 2 }),
    );
    const edited = bytes();
    // Measures the time until the page's arrays contain an edit, and until the edit is drawn.
    const start = performance.now();
    await post(daemon, `/${mesh}/edits`, { op: 'face_poke', face: 0 });
    await page.waitForFunction(
        () => document.getElementById('canvas').geometry.revision === 3,
        null,
        { polling: 1 },
    );
    const heard = performance.now() - start;
    await waitForFrame(page, { revision: 3 });
    const rival = performance.now() - start;
    const undo = await timed(
        () => page.locator('#canvas').press('Control+z'),
        () => waitForFrame(page, { revision: 4 }),
    );
    if (folder) {
        await page.screenshot({ path: path.join(folder, `torus-${side}.png`) });
        await page.locator('#canvas').press('f');
        await frameTime(page);
        await writeFile(path.join(folder, `torus-${side}-near.png`), await page.screenshot());
    }
    await page.close();
    const { counts: after } = await get(daemon, `/${mesh}`);
    // The newest edit was made by the other client, so the undo must have undone that edit.
    if (after.faces !== counts.faces + 3) {
        throw new Error(`${after.faces} faces after undo, not ${counts.faces + 3}`);
    }
    const times = [open, frame, pick, edit, heard, rival, undo];
    return { faces: counts.faces, bytes: edited, times };
}

const middle = (times) => times.sort((a, b) => a - b)[Math.floor(times.length / 2)];

async function measureLevels(browser, daemon, side) {
    const shape = { shape: 'torus', major_segments: side, minor_segments: side };
    const { id: mesh } = await post(daemon, '', { name: `triangles ${side}`, ...shape });
    await post(daemon, `/${mesh}/edits`, { op: 'triangulate' });
    const page = await browser.newPage({ viewport: { width: 1280, height: 800 } });
    page.setDefaultTimeout(120000);
    await page.goto(`${daemon.url}/#mesh=${mesh}`);
    await waitForFrame(page, { mesh, revision: 2 });
    const whole = await frameTime(page);
    const base = await timed(
        () => page.getByRole('button', { name: 'Levels' }).click(),
        () => page.locator('#canvas[data-faces]').waitFor(),
    );
    const [played, dragged] = await page.evaluate(async (places) => {
        const [play, slider] = ['level-play', 'level'].map((id) => document.getElementById(id));
        const gl = document.getElementById('canvas').getContext('webgl2');
        const pixel = new Uint8Array(4);
        const frame = async () => {
            await new Promise((resolve) => requestAnimationFrame(resolve));
            gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel);
            return performance.now();
        };
        const frames = [];
        for (let last = await frame(); play.textContent === 'Pause';) {
            const now = await frame();
            frames.push(now - last);
            last = now;
        }
        const jumps = [];
        for (const place of places) {
            slider.value = place;
            slider.dispatchEvent(new Event('input'));
            const start = performance.now();
            await frame(); // in this frame the page goes to the level
            jumps.push((await frame()) - start); // now the level is drawn
        }
        return [frames, jumps];
    }, PLACES);
    await page.close();
    const { counts } = await get(daemon, `/${mesh}`);
    const seconds = played.reduce((sum, time) => sum + time, 0) / 1000;
    const times = [whole, base, middle(played), played.at(-1), middle(dragged), dragged.at(-1)];
    return { faces: counts.faces, frames: played.length, seconds, times };
}

// Makes a torus of side * side faces, opens it in a fresh profile, and returns {page, time}: the
// milliseconds until its first frame is drawn and the operations can be chosen.
async function openFresh(browser, daemon, side) {
    const shape = { shape: 'torus', major_segments: side, minor_segments: side };
    const { id: mesh } = await post(daemon, '', { name: `torus ${side}`, ...shape });
    const context = await browser.newContext({ viewport: { width: 1280, height: 800 } });
    const page = await context.newPage();
    page.setDefaultTimeout(120000);
    const time = await timed(
        () => page.goto(`${daemon.url}/#mesh=${mesh}`),
        async () => {
            await waitForFrame(page, { mesh, revision: 1 });
            await page.locator('#operation option').first().waitFor({ state: 'attached' });
        },
    );
    return { page, time };
}

// Clicks on faces one after another, and returns the milliseconds from each click to the frame in which
// the face is highlighted, as the page sees them.
async function clickTimes(page, count) {
    const { x, y, width, height } = await page.locator('#canvas').boundingBox();
    await page.evaluate(() => {
        const canvas = document.getElementById('canvas');
        window.times = [];
        let start = null;
        addEventListener('pointerup', (event) => (start = event.timeStamp), true);
        new MutationObserver(() => {
            if (start !== null) {
                window.times.push(performance.now() - start);
                start = null;
            }
        }).observe(canvas, { attributeFilter: ['data-selection'] });
    });
    for (let i = 0; i < count; i++) {
        await page.mouse.click(x + width / 2 + 7 * (i - count / 2), y + 0.68 * height);
        await page.waitForFunction((wanted) => window.times.length === wanted, i + 1);
    }
    return page.evaluate(() => window.times);
}

// Does a task of tasks.mjs with a daemon of its own, and returns {clicks, keys, time}.
async function doTask(browser, task) {
    const daemon = await startDaemon(lifetime);
    const made = { daemon, said: [], ...(await task.prepare(daemon)) };
    const context = await browser.newContext({ viewport: { width: 1280, height: 800 } });
    const page = await context.newPage();
    // The tasks wait for messages that the page shows only for a while.
    await page.addInitScript(keepTold);
    if (task.later !== undefined) {
        await page.clock.setFixedTime(Date.now() + task.later);
    }
    await page.goto(daemon.url);
    await (made.mesh === undefined
        ? page.getByRole('heading', { name: 'No meshes yet' }).waitFor()
        : waitForFrame(page, { mesh: made.mesh }));
    const hand = new Hand(page);
    const time = await timed(() => task.run(page, hand, made), () => task.check(made));
    await context.close();
    return { clicks: hand.clicks, keys: hand.keys, time };
}

async function measurePage(browser, daemon) {
    const times = [];
    let size = 0;
    for (let i = 0; i < FRAMES; i++) {
        const { page, time } = await openFresh(browser, daemon, SIDES[0]);
        times.push(time);
        size = await compressedSize(page);
        await page.context().close();
    }
    console.log(`what the page loads first, compressed: ${size} bytes`);
    console.log(`until the page can be used: ${middle(times).toFixed(0)} ms`);
    const { page } = await openFresh(browser, daemon, SIDES[1]);
    const clicks = await clickTimes(page, 2 * FRAMES + 1);
    await page.context().close();
    const most = Math.max(...clicks).toFixed(0);
    console.log(`from click to highlight at ${SIDES[1] ** 2} faces: ${middle(clicks).toFixed(0)} ms, at most ${most} ms`);
    for (const task of TASKS) {
        const { clicks: count, keys, time } = await doTask(browser, task);
        console.log(`${task.name}: ${count} clicks, ${keys} keys, ${(time / 1000).toFixed(1)} s`);
    }
}

const browser = await launch();
try {
    await measurePage(browser, await startDaemon(lifetime));
    if (process.env.ONLY !== 'page') {
        await measureMeshes();
    }
} finally {
    await browser.close();
    for (const cleanup of cleanups) {
        await cleanup();
    }
}

async function measureMeshes() {
    const daemon = await startDaemon(lifetime);
    const line = (cells) => console.log(cells.map((cell) => `${cell}`.padStart(10)).join(''));
    line(['faces', 'open', 'frame', 'pick', 'edit', 'heard', 'rival', 'undo', 'bytes']);
    for (const side of SIDES) {
        const { faces, bytes, times } = await measure(browser, daemon, side);
        line([faces, ...times.map((time) => `${time.toFixed(0)} ms`), bytes]);
    }
    const head = 'triangles whole base frame slowest slide slowest frames seconds';
    line(head.split(' '));
    for (const side of SIDES) {
        const half = Math.round(side / Math.SQRT2);
        const { faces, frames, seconds, times } = await measureLevels(browser, daemon, half);
        const cells = times.map((time) => `${time.toFixed(0)} ms`);
        line([faces, ...cells, frames, seconds.toFixed(1)]);
    }
    line(['faces', 'moving', 'script', 'software', 'uploaded']);
    for (const side of SIDES) {
        for (const { faces, drawn, script, whole, bytes } of await measureMoving(browser, daemon, side)) {
            line([faces, drawn, `${script.toFixed(1)} ms`, `${whole.toFixed(0)} ms`, bytes]);
        }
    }
}
