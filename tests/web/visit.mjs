// visit.mjs - opens the page for the tests of a file, with a daemon behind it.

import { after } from 'node:test';

import { launch, openPageIn, waitForFrame } from './browser.mjs';
import { post, startDaemon } from './daemon.mjs';

// The browser that all tests of a file share; the first test that opens a page starts it.
let browser;
after(async () => (await browser)?.close());

export async function openPage(t, daemon, options) {
    browser ??= launch();
    return openPageIn(t, await browser, daemon, options);
}

// Starts a daemon with one mesh, and opens the page that shows it.
export async function openMesh(t, document, options) {
    const daemon = await startDaemon(t);
    const { id: mesh } = await post(daemon, '', document);
    const page = await openPage(t, daemon, options);
    await waitForFrame(page, { mesh, revision: 1 });
    return { daemon, mesh, page };
}
