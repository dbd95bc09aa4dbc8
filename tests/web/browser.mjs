// browser.mjs - starts Chromium, opens the page in it, and reads what the page's canvas shows.

import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { createRequire } from 'node:module';

import { PerspectiveCamera, Vector3 } from '../../web/node_modules/three/build/three.module.js';
import { MOST_PIXELS, arrowOf, middleOf } from '../../web/src/geometry/arrows.js';
import { ballOf, pointAt, unpack } from '../../web/src/geometry/geometry.js';
import { DIRECTION, FIELD_OF_VIEW, UP, fitDistance, pixelAtOne } from '../../web/src/geometry/view.js';
import { get, getGeometry } from './daemon.mjs';
import { readPng } from './png.mjs';

// The packages belong to the page, so they are in web/node_modules.
const require = createRequire(new URL('../../web/package.json', import.meta.url));
const { chromium } = require('playwright-core');
const axe = readFileSync(require.resolve('axe-core/axe.min.js'), 'utf8');

// A limit for tests that wait for something that never happens. A page is asked at most once a
// second whether it still works, and is closed after this many answers. Answers are counted and not
// seconds, so that no test fails because a machine is slow or pauses for a while. If a page does
// not answer at all, the program that runs the tests ends the test.
const MOST_ANSWERS = 600;
const APART = 1000;

const pause = () => new Promise((resolve) => setTimeout(resolve, APART).unref());

// Closes a page that has given MOST_ANSWERS answers, so that a test that still waits for it fails
// with a reason.
async function guard(page) {
    for (let answers = 0; answers < MOST_ANSWERS; answers++) {
        await pause();
        // A page that is navigating refuses the call, which is an answer, too.
        await page.evaluate(() => {}).catch(() => {});
        if (page.isClosed()) {
            return;
        }
    }
    await page.context().close({ reason: `the page answered ${MOST_ANSWERS} times, and still waits` });
}

// WebGL is drawn by software (SwiftShader), and the layers of the page are put together without the
// GPU process.
const FLAGS = [
    '--no-sandbox',
    '--use-angle=swiftshader',
    '--enable-unsafe-swiftshader',
    '--disable-gpu-compositing',
    '--in-process-gpu', // saves one process for each browser
    '--disable-quic',
    '--no-first-run',
    '--disable-background-networking',
    '--disable-component-update',
    '--disable-sync',
];

export function launch() {
    return chromium.launch({
        timeout: 0, // no limit: the browser starts, or ends with an error
        executablePath: process.env.CHROMIUM ?? '/usr/bin/chromium-headless-shell',
        args: FLAGS,
    });
}

// Opens the page in a fresh profile. When the test ends, the page must have had no error, no breach
// of its content security policy and no request to another host. `allowed` are regular expressions
// for the console errors that the test provokes.
export async function openPageIn(
    t,
    browser,
    daemon,
    { allowed = [], init, path = '/', ...options } = {},
) {
    const context = await browser.newContext({
        viewport: { width: 1280, height: 800 },
        colorScheme: 'dark', // that of the colours below
        // Changes by others are not marked for a moment, so that pictures depend on no time.
        reducedMotion: 'reduce',
        ...options,
    });
    const page = await context.newPage();
    page.setDefaultTimeout(180_000); // what has not come by then does not come: the test fails and says where
    guard(page);
    const wrong = [];
    page.on('pageerror', (error) => wrong.push(`page error: ${error.stack}`));
    page.on('console', (message) => {
        // The page tells what it shows at times of its own, so that this may be on its way when a test
        // deletes the mesh or stops the daemon.
        const isLate =
            message.location().url.endsWith('/presence') && /status of 404|ERR_/.test(message.text());
        if (message.type() === 'error' && !isLate && !allowed.some((text) => text.test(message.text()))) {
            wrong.push(`console: ${message.text()}`);
        }
    });
    page.on('request', (request) => {
        if (!request.url().startsWith(`${daemon.url}/`) && !/^(data|blob):/.test(request.url())) {
            wrong.push(`foreign request: ${request.url()}`);
        }
    });
    await page.addInitScript(() => {
        document.addEventListener('securitypolicyviolation', (event) => {
            console.error(`policy: ${event.violatedDirective} ${event.blockedURI}`);
        });
    });
    await page.addInitScript(keepTold);
    if (init) {
        await page.addInitScript(init);
    }
    daemon.closers.push(() => context.close());
    t.after(() => assert.deepEqual(wrong, []));
    await page.goto(daemon.url + path);
    return page;
}

// Runs in the page: keeps the texts of success messages, because the page shows them only for some
// seconds.
export function keepTold() {
    window.told = [];
    new MutationObserver((changes) => {
        for (const node of changes.flatMap(({ addedNodes }) => [...addedNodes])) {
            if (node.role === 'status') {
                window.told.push(node.textContent);
            }
        }
    }).observe(document, { childList: true, subtree: true });
}

// Waits until the page has shown a success message; the message may have disappeared since.
export function waitForTold(page, pattern) {
    return page.waitForFunction(
        ([source, flags]) => window.told.some((text) => new RegExp(source, flags).test(text)),
        [pattern.source, pattern.flags],
    );
}

// Waits until the page has drawn the revision `revision` with a selection such as 'face:3' and, if
// given, with the materials of a certain revision.
export function waitForFrame(page, { mesh, revision, selection, materials }) {
    return page.waitForFunction(
        (wanted) => {
            const { dataset } = document.getElementById('canvas');
            return Object.entries(wanted).every(([name, value]) => dataset[name] === `${value}`);
        },
        Object.fromEntries(
            Object.entries({ mesh, revision, selection, materials }).filter(([, v]) => v !== undefined),
        ),
    );
}

// Counts from now on how many bytes a page gets over the network, including headers and event
// streams. Returns a function that returns their number.
export async function countBytes(page) {
    const session = await page.context().newCDPSession(page);
    let bytes = 0;
    session.on('Network.responseReceived', ({ response }) => {
        bytes += response.encodedDataLength;
    });
    session.on('Network.dataReceived', ({ dataLength }) => {
        bytes += dataLength;
    });
    await session.send('Network.enable');
    return () => bytes;
}

// Requires that the page in its present state, or a part of it, breaks no rule of axe (a checker of
// accessibility).
export async function checkAccessible(page, state, part = 'html') {
    // The page's content security policy does not apply to code that the debugging protocol
    // evaluates.
    if (!(await page.evaluate(() => 'axe' in window))) {
        await page.evaluate(axe);
    }
    const { violations } = await page.evaluate(
        // Only violations are wanted, so that axe need not list the elements that pass.
        (within) => window.axe.run(within, { resultTypes: ['violations'] }),
        part,
    );
    const found = violations.map(({ id, nodes }) => `${id}: ${nodes.map((n) => n.html).join(' ')}`);
    assert.deepEqual(found, [], state);
}

// Returns functions that say where elements of a mesh are on the canvas. They compute this from the
// API's numbers and from a camera in the position in which the page starts.
export async function projector(page, daemon, mesh) {
    const geometry = unpack(await getGeometry(daemon, mesh));
    const { width, height } = await page.locator('#canvas').boundingBox();
    const camera = new PerspectiveCamera(FIELD_OF_VIEW, width / height, 0.01, 100);
    const ball = ballOf(geometry);
    const center = new Vector3(...ball.center);
    camera.up.set(...UP);
    camera.position.set(...DIRECTION);
    camera.position.multiplyScalar(fitDistance(width / height) * ball.radius).add(center);
    camera.lookAt(center);
    camera.updateMatrixWorld();
    const placeOf = (id) => new Vector3(...pointAt(geometry, id));
    const toCanvas = (place) => {
        place.project(camera);
        return { x: ((place.x + 1) / 2) * width, y: ((1 - place.y) / 2) * height };
    };
    const middle = (ids) =>
        ids.reduce((sum, id) => sum.add(placeOf(id)), new Vector3()).divideScalar(ids.length);
    return {
        // Returns the pixel at the mean of the positions of some vertices.
        at(ids) {
            return toCanvas(middle(ids));
        },
        // Returns the pixel of a place in the mesh's own coordinates.
        atPlace(position) {
            const { origin, scale } = geometry.frame;
            return toCanvas(new Vector3(...position.map((x, i) => (x - origin[i]) * scale)));
        },
        // Returns the pixel in the middle of a half-edge's arrow.
        async arrow(id) {
            const halfedge = await get(daemon, `/${mesh}/halfedges/${id}`);
            const { face: across } = await get(daemon, `/${mesh}/halfedges/${halfedge.twin}`);
            const drawn = arrowOf(geometry, { ...halfedge, across });
            const depth = -placeOf(halfedge.origin).applyMatrix4(camera.matrixWorldInverse).z;
            const scale = (MOST_PIXELS * pixelAtOne(height) * depth) / drawn.size;
            return toCanvas(new Vector3(...middleOf(drawn, Math.min(scale, 1))));
        },
        // Returns whether a face of a convex mesh turns its front to the camera.
        isSeen({ vertices: ids }) {
            const [a, b, c] = ids.map(placeOf);
            const normal = b.clone().sub(a).cross(c.clone().sub(a));
            return normal.dot(camera.position.clone().sub(a)) > 0;
        },
    };
}

// Returns the pixels of the canvas: colour(x, y) is [red, green, blue].
export async function readCanvas(page) {
    const clip = await page.locator('#canvas').boundingBox();
    return readPicture(await page.screenshot({ clip }));
}

// Returns the pixels of any picture.
export function readPicture(png) {
    const { width, channels, pixels } = readPng(png);
    const count = pixels.length / channels;
    // A literal, because copying a part of the array for each pixel takes ten times as long.
    const colourOf = (pixel) => {
        const at = channels * pixel;
        return [pixels[at], pixels[at + 1], pixels[at + 2]];
    };
    return {
        count,
        width,
        height: count / width,
        colour(x, y) {
            return colourOf(Math.round(y) * width + Math.round(x));
        },
        // Counts the pixels for which a test of [red, green, blue] is true.
        countOf(test) {
            let found = 0;
            for (let pixel = 0; pixel < count; pixel++) {
                found += test(colourOf(pixel)) ? 1 : 0;
            }
            return found;
        },
        // Returns the mean of the places of all pixels whose colour passes the test.
        centreOf(test) {
            const sum = { x: 0, y: 0, count: 0 };
            for (let pixel = 0; pixel < count; pixel++) {
                if (test(colourOf(pixel))) {
                    sum.x += pixel % width;
                    sum.y += Math.floor(pixel / width);
                    sum.count++;
                }
            }
            return { x: sum.x / sum.count, y: sum.y / sum.count };
        },
    };
}

// Whether a pixel has one of the colours of gl/marks.js or gl/shaders.js, with a tolerance.
export const isBackground = ([r, g, b]) => r < 20 && g < 24 && b < 30;
export const isChosen = ([r, g, b]) => r > 90 && r > g + 25 && g > b + 25;
export const isBoundary = ([r, g, b]) => r < 100 && g > 150 && b > 170;
export const isNext = ([r, g, b]) => g > 180 && g > r + 60 && g > b + 60;
export const isPrev = ([r, g, b]) => r > 180 && b > 200 && g < 160;
export const isTwin = ([r, g, b]) => b > 200 && r < 140 && g > 120 && g < 200;
export const isSelf = ([r, g, b]) => r > 220 && g > 150 && g < 200 && b < 110;
export const isNear = ([r, g, b]) => r > 225 && g > 225 && b > 225;
export const isSurface = ([r, g, b]) => r > 60 && b > r && b - r < 60 && g >= r;
