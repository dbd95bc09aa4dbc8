// frames.mjs - measures frames while the camera moves: the time that the page's scripts take, the time until
// the frame is drawn (by software, so that this says nothing about graphics hardware), and the bytes that
// are given to the graphics memory.

import { waitForFrame } from './browser.mjs';
import { post } from './daemon.mjs';
import { countUploads } from './uploads.mjs';
import { waitForDrawing } from './view_panel.mjs';

const MOVED = 15;

// Moves the camera, and returns for each frame the median of the time of scripts and of the time until it
// is drawn, and the mean of the bytes that were uploaded. Returns null if what is `drawn`, 'mesh' or
// 'proxy', is not drawn.
function framesWhileMoving(page, drawn) {
    return page.evaluate(async ([wanted, count]) => {
        const canvas = document.getElementById('canvas');
        const gl = canvas.getContext('webgl2');
        const pixel = new Uint8Array(4);
        const [scripts, wholes] = [[], []];
        let [bytes, hasDrawn] = [0, false];
        for (let turn = 0; scripts.length < count && turn < 10 * count; turn++) {
            const before = window.uploaded;
            const start = performance.now();
            canvas.dispatchEvent(new WheelEvent('wheel', { deltaY: turn % 2 ? 10 : -10 }));
            const handled = performance.now() - start;
            // The observer runs when the task of the frame ends.
            const times = await new Promise((resolve) => {
                let began;
                window.frameBegins = () => {
                    began = performance.now();
                };
                new MutationObserver((_, observer) => {
                    const scripted = performance.now() - began;
                    observer.disconnect();
                    gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel);
                    resolve([handled + scripted, performance.now() - began]);
                }).observe(canvas, { attributeFilter: ['data-drawn'] });
            });
            // What is drawn for the first time is uploaded then, which is not counted.
            const isKnown = hasDrawn;
            hasDrawn ||= canvas.dataset.drawn === wanted;
            if (isKnown && canvas.dataset.drawn === wanted) {
                scripts.push(times[0]);
                wholes.push(times[1]);
                bytes += window.uploaded - before;
            }
        }
        if (scripts.length < count) {
            return null; // there is no simpler mesh
        }
        const middle = (values) => values.sort((a, b) => a - b)[Math.floor(count / 2)];
        return { script: middle(scripts), whole: middle(wholes), bytes: bytes / count };
    }, [drawn, MOVED]);
}

// Opens a torus of side * side faces, and returns rows {faces, drawn, script, whole, bytes}: frames of the
// whole mesh and, if there is one, of the simpler mesh.
export async function measureMoving(browser, daemon, side) {
    const shape = { shape: 'torus', major_segments: side, minor_segments: side };
    const { id: mesh, counts } = await post(daemon, '', { name: `moved ${side}`, ...shape });
    const page = await browser.newPage({ viewport: { width: 1280, height: 800 } });
    page.setDefaultTimeout(120000);
    await page.addInitScript(countUploads);
    await page.addInitScript(markFrames);
    await page.goto(`${daemon.url}/#mesh=${mesh}`);
    await waitForFrame(page, { mesh, revision: 1 });
    const rows = [];
    for (const [hurry, drawn] of [['never', 'mesh'], ['always', 'proxy']]) {
        await page.evaluate((wanted) => {
            const { look } = document.getElementById('canvas');
            look.state = { ...look.state, hurry: wanted };
        }, hurry);
        await waitForDrawing(page);
        const frames = await framesWhileMoving(page, drawn);
        if (frames !== null) {
            rows.push({ faces: counts.faces, drawn, ...frames });
        }
    }
    await page.close();
    return rows;
}

// Runs in the page before its scripts: calls window.frameBegins() before the functions of a frame.
function markFrames() {
    const original = window.requestAnimationFrame;
    window.requestAnimationFrame = (act) =>
        original.call(window, (time) => {
            window.frameBegins?.();
            act(time);
        });
}
