// browser.mjs - Chromium, the page in it, and what its canvas shows.

import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { createRequire } from 'node:module';

import { PerspectiveCamera, Vector3 } from '../../web/node_modules/three/build/three.module.js';
import { middleOf } from '../../web/src/arrows.js';
import { pointAt, unpack } from '../../web/src/geometry.js';
import { DIRECTION, FIELD_OF_VIEW, UP, fitDistance } from '../../web/src/view.js';
import { get, getGeometry } from './daemon.mjs';

// The packages are the page's: they live in web/node_modules.
const require = createRequire(new URL('../../web/package.json', import.meta.url));
const { chromium } = require('playwright-core');
const axe = readFileSync(require.resolve('axe-core/axe.min.js'), 'utf8');

const FLAGS = [
    '--headless=new',
    '--no-sandbox',
    '--use-angle=swiftshader',
    '--enable-unsafe-swiftshader',
    '--disable-quic',
    '--no-first-run',
    '--disable-background-networking',
    '--disable-component-update',
    '--disable-sync',
];

export function launch() {
    return chromium.launch({
        executablePath: process.env.CHROMIUM ?? '/usr/bin/chromium',
        args: FLAGS,
    });
}

// Open the page in a fresh profile. When the test ends the page must have had no error, no breach
// of its content security policy and no request to another host. `allowed` are expressions for
// console errors that the test provokes.
export async function openPage(
    t,
    browser,
    daemon,
    { allowed = [], init, path = '/', ...options } = {},
) {
    const context = await browser.newContext({
        viewport: { width: 1280, height: 800 },
        ...options,
    });
    const page = await context.newPage();
    page.setDefaultTimeout(20000);
    const wrong = [];
    page.on('pageerror', (error) => wrong.push(`page error: ${error.stack}`));
    page.on('console', (message) => {
        if (message.type() === 'error' && !allowed.some((text) => text.test(message.text()))) {
            wrong.push(`console: ${message.text()}`);
        }
    });
    page.on('request', (request) => {
        if (!request.url().startsWith(`${daemon.url}/`) && !/^(data|blob):/.test(request.url())) {
            wrong.push(`foreign request: ${request.url()}`);
        }
    });
    await page.exposeFunction('reportViolation', (text) => wrong.push(`policy: ${text}`));
    await page.addInitScript(() => {
        document.addEventListener('securitypolicyviolation', (event) => {
            window.reportViolation(`${event.violatedDirective} ${event.blockedURI}`);
        });
    });
    if (init) {
        await page.addInitScript(init);
    }
    t.after(async () => {
        await context.close();
        assert.deepEqual(wrong, []);
    });
    await page.goto(daemon.url + path);
    return page;
}

// Wait for a frame of a revision with a selection such as 'face:3'.
export function waitForFrame(page, { mesh, revision, selection }) {
    return page.waitForFunction(
        (wanted) => {
            const { dataset } = document.getElementById('canvas');
            return Object.entries(wanted).every(([name, value]) => dataset[name] === `${value}`);
        },
        Object.fromEntries(
            Object.entries({ mesh, revision, selection }).filter(([, v]) => v !== undefined),
        ),
    );
}

export async function checkAccessible(page, state) {
    // Not a script of the page: the policy does not apply to what the protocol evaluates.
    await page.evaluate(axe);
    const { violations } = await page.evaluate(() => window.axe.run());
    const found = violations.map(({ id, nodes }) => `${id}: ${nodes.map((n) => n.html).join(' ')}`);
    assert.deepEqual(found, [], state);
}

// Where elements of a mesh just opened are on the canvas, from the API's numbers and a camera put
// where view.js says.
export async function projector(page, daemon, mesh) {
    const geometry = unpack(await getGeometry(daemon, mesh));
    const { width, height } = await page.locator('#canvas').boundingBox();
    const camera = new PerspectiveCamera(FIELD_OF_VIEW, width / height, 0.01, 100);
    const center = new Vector3(...geometry.center);
    camera.up.set(...UP);
    camera.position.set(...DIRECTION);
    camera.position.multiplyScalar(fitDistance(width / height) * geometry.radius).add(center);
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
        // The pixel of the mean of some vertices.
        at(ids) {
            return toCanvas(middle(ids));
        },
        // The pixel in the middle of a half-edge's arrow.
        async arrow(id) {
            const halfedge = await get(daemon, `/${mesh}/halfedges/${id}`);
            const { face: across } = await get(daemon, `/${mesh}/halfedges/${halfedge.twin}`);
            return toCanvas(new Vector3(...middleOf(geometry, { ...halfedge, across })));
        },
        // Does a face of a convex mesh turn its front to the camera?
        isSeen({ vertices: ids }) {
            const [a, b, c] = ids.map(placeOf);
            const normal = b.clone().sub(a).cross(c.clone().sub(a));
            return normal.dot(camera.position.clone().sub(a)) > 0;
        },
    };
}

// A page of a context that decodes pictures: the viewer's policy allows no such thing.
const decoders = new WeakMap();

async function decode(context, png) {
    if (!decoders.has(context)) {
        decoders.set(context, await context.newPage());
    }
    const { width, data } = await decoders.get(context).evaluate(async (base64) => {
        const bytes = Uint8Array.from(atob(base64), (c) => c.charCodeAt(0));
        const image = await createImageBitmap(new Blob([bytes], { type: 'image/png' }));
        const canvas = new OffscreenCanvas(image.width, image.height);
        const context2d = canvas.getContext('2d');
        context2d.drawImage(image, 0, 0);
        const pixels = context2d.getImageData(0, 0, image.width, image.height).data;
        let text = '';
        for (let i = 0; i < pixels.length; i += 32768) {
            text += String.fromCharCode(...pixels.subarray(i, i + 32768));
        }
        return { width: image.width, data: btoa(text) };
    }, png.toString('base64'));
    return { width, pixels: Buffer.from(data, 'base64') };
}

// What the canvas shows: colour(x, y) -> [red, green, blue].
export async function readCanvas(page) {
    const clip = await page.locator('#canvas').boundingBox();
    const { width, pixels } = await decode(page.context(), await page.screenshot({ clip }));
    return {
        count: pixels.length / 4,
        colour(x, y) {
            const at = 4 * (Math.round(y) * width + Math.round(x));
            return [...pixels.subarray(at, at + 3)];
        },
        // Of how many pixels a test of [red, green, blue] is true.
        countOf(test) {
            const colour = [0, 0, 0];
            let count = 0;
            for (let at = 0; at < pixels.length; at += 4) {
                colour[0] = pixels[at];
                colour[1] = pixels[at + 1];
                colour[2] = pixels[at + 2];
                count += test(colour) ? 1 : 0;
            }
            return count;
        },
    };
}

// The colours of render.js and shaders.js, loosely.
export const isBackground = ([r, g, b]) => r < 20 && g < 24 && b < 30;
export const isChosen = ([r, g, b]) => r > 90 && r > g + 25 && g > b + 25;
export const isBoundary = ([r, g, b]) => r < 100 && g > 150 && b > 170;
export const isNext = ([r, g, b]) => g > 180 && g > r + 60 && g > b + 60;
export const isPrev = ([r, g, b]) => r > 180 && b > 200 && g < 160;
export const isTwin = ([r, g, b]) => b > 200 && r < 140 && g > 120 && g < 200;
export const isSelf = ([r, g, b]) => r > 220 && g > 150 && g < 200 && b < 110;
export const isNear = ([r, g, b]) => r > 225 && g > 225 && b > 225;
export const isSurface = ([r, g, b]) => r > 60 && b > r && b - r < 60 && g >= r;
