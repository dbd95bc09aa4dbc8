// measure.mjs [FOLDER] - measures how long meshes of a thousand, a hundred thousand and a million
// faces take to open, to draw, to pick in and to edit, and how many bytes the page fetches after an
// edit; if FOLDER is given, saves a screenshot of each mesh there. Then measures how long levels of
// detail take: a frame of all triangles, the time until the coarsest level is shown, the frames
// while levels are played, and the frames after the slider was moved. This is not a test: what it
// prints depends on the machine.

import { writeFile } from 'node:fs/promises';
import path from 'node:path';

import { countBytes, launch, waitForFrame } from './browser.mjs';
import { get, post, startDaemon } from './daemon.mjs';

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

const browser = await launch();
try {
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
} finally {
    await browser.close();
    for (const cleanup of cleanups) {
        await cleanup();
    }
}
