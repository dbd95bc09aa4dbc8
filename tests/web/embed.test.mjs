// Tests of the page in a frame of another page: only the view, and only where the server allows it.

import assert from 'node:assert/strict';
import { createServer } from 'node:http';
import { test } from 'node:test';

import { checkAccessible, launch, waitForFrame } from './browser.mjs';
import { post, startDaemon } from './daemon.mjs';
import { openPage } from './visit.mjs';

const CUBE = { name: 'cube', shape: 'cube' };

// Starts a server of another origin whose page shows an address in a frame. Returns {url, address},
// the latter a function that sets what is in the frame.
async function startHost(t) {
    let framed = '';
    const server = createServer((request, response) => {
        response.setHeader('Content-Type', 'text/html');
        response.end(
            `<!doctype html><html lang="en"><title>Host</title><iframe title="mesh" width="600" height="400" src="${framed}"></iframe></html>`,
        );
    });
    await new Promise((resolve) => {
        server.listen(0, '127.0.0.1', resolve);
    });
    t.after(() => server.close());
    const show = (address) => {
        framed = address;
    };
    return { url: `http://127.0.0.1:${server.address().port}`, show };
}

test('the embedded page has only the view and a link', async (t) => {
    const daemon = await startDaemon(t);
    const { id: mesh } = await post(daemon, '', CUBE);
    const page = await openPage(t, daemon, { path: `/?embed#mesh=${mesh}&face=2` });
    await waitForFrame(page, { mesh, revision: 1, selection: 'face:2' });
    await checkAccessible(page, 'embedded');
    const { width, height } = page.viewportSize();
    const box = await page.locator('#canvas').boundingBox();
    assert.deepEqual(box, { x: 0, y: 0, width, height });
    for (const part of ['.bar', '.meshes', '#details']) {
        assert.ok(await page.locator(part).isHidden(), part);
    }
    // Keys neither edit nor open anything.
    for (const key of ['x', 's', 'Control+z', 'e', 'Control+k', 'v']) {
        await page.locator('#canvas').press(key);
    }
    assert.equal((await (await fetch(`${daemon.url}/v1/meshes/${mesh}`)).json()).revision, 1);
    assert.equal(await page.getByRole('dialog').count(), 0);
    assert.ok(await page.locator('#view-panel').isHidden());
    const link = page.getByRole('link', { name: 'Open in hedge' });
    await link.hover();
    const href = await link.getAttribute('href');
    assert.ok(href.startsWith(`${daemon.url}/#mesh=${mesh}&face=2&camera=`), href);
    // It does not show itself to others.
    const { clients } = await (await fetch(`${daemon.url}/v1/meshes/${mesh}/presence`)).json();
    assert.deepEqual(clients, []);
});

test('a page of an allowed origin shows it in a frame, others do not', async (t) => {
    const host = await startHost(t);
    const browser = await launch();
    t.after(() => browser.close());
    for (const isAllowed of [true, false]) {
        const origin = isAllowed ? host.url : 'https://else.example';
        const daemon = await startDaemon(t, '--allow-frame', origin);
        const { id: mesh } = await post(daemon, '', CUBE);
        host.show(`${daemon.url}/?embed#mesh=${mesh}`);
        const policy = (await fetch(daemon.url)).headers.get('Content-Security-Policy');
        assert.match(policy, new RegExp(`frame-ancestors ${origin}$`));
        assert.match(
            (await fetch(`${daemon.url}/docs`)).headers.get('Content-Security-Policy'),
            /frame-ancestors 'none'$/,
        );
        // The page of another origin is not one of those that openPage() allows.
        const page = await browser.newPage();
        const refused = page.waitForEvent('console', {
            predicate: (message) => message.text().includes('frame-ancestors'),
            timeout: 0,
        });
        refused.catch(() => {}); // if the frame is allowed, nothing is refused
        await page.goto(host.url);
        if (isAllowed) {
            const canvas = page.frameLocator('iframe').locator('#canvas');
            await canvas.and(page.frameLocator('iframe').locator(`[data-mesh="${mesh}"]`)).waitFor();
        } else {
            await refused;
            assert.equal(await page.frameLocator('iframe').locator('#canvas').count(), 0);
        }
        await page.close();
    }
});
