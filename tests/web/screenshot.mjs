// screenshot.mjs - makes the picture of the README, web/screenshot.png: a torus in the viewer with
// one of its half-edges selected.

import { statSync } from 'node:fs';
import { fileURLToPath } from 'node:url';

import { launch, openPageIn, projector, waitForFrame } from './browser.mjs';
import { getAll, post, startDaemon } from './daemon.mjs';
import { setMode } from './page.mjs';

const file = fileURLToPath(new URL('../../web/screenshot.png', import.meta.url));
const MOST_BYTES = 100 * 1024;

// `endings` are functions to call at the end. `run` takes the place of a test's context, which
// collects such functions.
const endings = [];
const run = { after: (ending) => endings.unshift(ending) };
try {
    const daemon = await startDaemon(run);
    const browser = await launch();
    run.after(() => browser.close());
    await post(daemon, '?id=cube', { name: 'cube', shape: 'cube' });
    const torus = { name: 'torus', shape: 'torus', major_segments: 20, minor_segments: 9 };
    const { id: mesh } = await post(daemon, '?id=torus', torus);
    const page = await openPageIn(run, browser, daemon, { viewport: { width: 940, height: 470 } });
    await page.locator('#meshes button').filter({ hasText: 'torus' }).click();
    await waitForFrame(page, { mesh, revision: 1 });
    await setMode(page, 'Half-edge');
    // A half-edge of the face nearest to a certain point on the canvas, where the near side of the
    // torus is, is selected.
    const { x, y, width, height } = await page.locator('#canvas').boundingBox();
    const projected = await projector(page, daemon, mesh);
    const distance = ({ vertices }) => {
        const at = projected.at(vertices);
        return Math.hypot(at.x - 0.4 * width, at.y - 0.6 * height);
    };
    const [face] = (await getAll(daemon, mesh, 'faces'))
        .filter((one) => projected.isSeen(one))
        .sort((a, b) => distance(a) - distance(b));
    const place = await projected.arrow(face.halfedge);
    await page.mouse.click(x + place.x, y + place.y);
    await waitForFrame(page, { selection: `halfedge:${face.halfedge}` });
    // The wheel moves the camera nearer; when the address changes, the frame has been drawn.
    const address = page.url();
    await page.mouse.wheel(0, -500);
    await page.waitForURL((url) => `${url}` !== address);
    await page.screenshot({ path: file });
    const { size } = statSync(file);
    if (size > MOST_BYTES) {
        throw new Error(`${file} has ${size} bytes, more than ${MOST_BYTES}`);
    }
} finally {
    for (const ending of endings) {
        await ending();
    }
}
