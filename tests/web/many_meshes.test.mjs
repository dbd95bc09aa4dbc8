// Tests of the list with ten thousand meshes, and of names that run from right to left or have
// characters that control text.
//
// With ten thousand meshes, elements are found by their ids: to find them by their roles, Playwright
// computes the names of all buttons.

import assert from 'node:assert/strict';
import { test } from 'node:test';

import { nameInText, seenName, storableName } from '../../web/src/wire/names.js';
import { checkAccessible, waitForTold } from './browser.mjs';
import { post, startDaemon } from './daemon.mjs';
import { openPage } from './visit.mjs';

const COUNT = 10000;
const nameOf = (i) => `mesh ${10000 + i}`;

const rows = (page) => page.locator('#meshes li');
const focused = (page) => page.evaluate(() => document.activeElement.dataset.mesh ?? null);

// Answers requests for the list in place of the daemon, as if it had COUNT meshes: to make so many would
// take longer than the test. Only the last but one is a mesh of the daemon, whose description is given.
// Returns the ids.
async function pretendMany(page, one) {
    const items = Array.from({ length: COUNT }, (_, i) => ({
        ...one,
        id: i === COUNT - 2 ? one.id : `m${i}`,
        name: nameOf(i),
    }));
    await page.route(/\/v1\/meshes\?/, (route) => {
        const query = new URL(route.request().url()).searchParams;
        const found = items.filter(({ name }) => name.includes(query.get('contains') ?? ''));
        const from = Number(query.get('cursor') ?? 0);
        const to = from + Number(query.get('limit'));
        return route.fulfill({
            json: { items: found.slice(from, to), next: to < found.length ? `${to}` : null },
        });
    });
    return items.map(({ id }) => id);
}

test('ten thousand meshes are scrolled, searched and walked through', async (t) => {
    const daemon = await startDaemon(t);
    const one = await post(daemon, '', { name: nameOf(COUNT - 2), shape: 'cube' });
    const page = await openPage(t, daemon, { path: '/docs' });
    const ids = await pretendMany(page, one);
    await page.goto(`${daemon.url}/#mesh=${one.id}`);
    await rows(page).first().waitFor();
    assert.equal(await rows(page).count(), 200);

    // Scrolling reads on, until all meshes are there.
    for (let count = 200; count < COUNT; count = await rows(page).count()) {
        await page.evaluate((had) => {
            const list = document.querySelector('#meshes');
            list.scrollTop = list.scrollHeight;
            return new Promise((resolve) => {
                const look = () => (list.children.length > had ? resolve() : requestAnimationFrame(look));
                look();
            });
        }, count);
    }
    assert.equal(await rows(page).count(), COUNT);
    await page.locator('#more-meshes').waitFor({ state: 'hidden' });
    assert.equal(await rows(page).last().locator('.mesh-name').textContent(), nameOf(COUNT - 1));
    // Only rows near the window are laid out.
    const laidOut = await page.evaluate(
        () =>
            [...document.querySelectorAll('#meshes .mesh-name')].filter((one) =>
                one.checkVisibility({ contentVisibilityAuto: true }),
            ).length,
    );
    assert.ok(laidOut > 0 && laidOut < 200, `${laidOut} rows are laid out`);

    // The list is one stop of the Tab key, and the other keys move in it.
    const stops = () => page.locator('#meshes button:not([tabindex="-1"])').count();
    assert.equal(await stops(), 2);
    await page.locator('#meshes button:not([tabindex="-1"])').first().focus();
    await page.keyboard.press('Home');
    assert.equal(await focused(page), ids[0]);
    await page.keyboard.press('ArrowDown');
    assert.equal(await focused(page), ids[1]);
    await page.keyboard.press('End');
    assert.equal(await focused(page), ids[COUNT - 1]);
    await page.keyboard.press('ArrowUp');
    assert.equal(await focused(page), ids[COUNT - 2]);
    assert.equal(await stops(), 2);
    await page.keyboard.press('Enter');
    await page.locator('#mesh-title').filter({ hasText: nameOf(COUNT - 2) }).waitFor();
    assert.equal(await focused(page), ids[COUNT - 2]);
    await page.keyboard.press('Tab');
    await page.keyboard.press('Tab');
    assert.ok(await page.evaluate(() => document.activeElement.closest('#meshes') === null));

    // A refresh keeps all that was read, the place and the stop.
    const answer = page.waitForResponse((one) => one.url().includes('/v1/meshes?'));
    await page.locator('#refresh').click();
    await answer;
    assert.equal(await rows(page).count(), COUNT);
    await page.locator('#mesh-filter').fill('19998');
    await page.waitForFunction(() => document.querySelectorAll('#meshes li').length === 1);
    await page.locator('#mesh-filter').fill('');
    await page.waitForFunction(() => document.querySelectorAll('#meshes li').length === 200);
});

test('a late page of an earlier search does not let a page be read twice', async (t) => {
    const daemon = await startDaemon(t);
    const one = await post(daemon, '', { name: 'mesh', shape: 'cube' });
    const page = await openPage(t, daemon, { path: '/docs' });
    const asked = []; // {query, answer()} of each later page, in the order of the requests
    await page.route(/\/v1\/meshes\?/, (route) => {
        const query = new URL(route.request().url()).searchParams;
        const contains = query.get('contains') ?? '';
        const from = Number(query.get('cursor')?.split('/')[1] ?? 0);
        const items = Array.from({ length: 200 }, (_, i) => ({ ...one, id: from + i === 0 ? one.id : `m${from + i}` }));
        const answer = () => route.fulfill({ json: { items, next: from < 400 ? `${contains}/${from + 200}` : null } });
        return from === 0 ? answer() : asked.push({ query, answer });
    });
    const next = async (act) => {
        const request = page.waitForRequest(/cursor=/);
        await act();
        await request;
    };
    const more = page.getByRole('button', { name: 'Show more' });
    await page.goto(`${daemon.url}/#mesh=${one.id}`);
    await rows(page).first().waitFor();
    await next(() => more.click());
    // The filter changes while the page is being read.
    const again = page.waitForResponse(/contains=mesh/);
    await page.locator('#mesh-filter').fill('mesh');
    await (await again).finished();
    await page.evaluate(() => new Promise((resolve) => requestAnimationFrame(resolve)));
    await next(() => more.click());
    const late = page.waitForResponse(/cursor=%2F200/);
    await asked[0].answer();
    await (await late).finished();
    await page.evaluate(() => new Promise((resolve) => requestAnimationFrame(resolve)));
    await more.click();
    await asked[1].answer();
    await page.waitForFunction(() => document.querySelectorAll('#meshes li').length === 400);
    assert.deepEqual(asked.map(({ query }) => query.get('cursor')), ['/200', 'mesh/200']);
});

// Runs in the page: breakOff() ends the stream of events as a lost connection does.
function makeBreakable() {
    const send = window.fetch;
    window.fetch = async (path, options) => {
        const answer = await send(path, options);
        if (!`${path}`.endsWith('/events')) {
            return answer;
        }
        const start = (controller) => {
            window.breakOff = () => controller.error(new Error('broken off'));
        };
        return new Response(answer.body.pipeThrough(new TransformStream({ start })));
    };
}

test('without a connection, scrolling asks once, and reads on when the connection is back', async (t) => {
    const daemon = await startDaemon(t);
    const vertices = [[0, 0, 0], [1, 0, 0], [0, 1, 0]];
    for (let i = 0; i < 205; i++) {
        await post(daemon, '', { name: nameOf(i), vertices, faces: [[0, 1, 2]] });
    }
    const page = await openPage(t, daemon, { init: makeBreakable, allowed: [/ERR_INTERNET_DISCONNECTED/] });
    await page.waitForFunction(() => document.querySelectorAll('#meshes li').length === 200);
    await page.locator('#mesh-title').filter({ hasText: nameOf(204) }).waitFor();
    await page.context().setOffline(true);
    await page.evaluate(() => window.breakOff());
    const failures = page.locator('#toasts .toast').filter({ hasText: 'No connection' });
    const scroll = (top) =>
        page.evaluate((to) => {
            const list = document.querySelector('#meshes');
            const scrolled = new Promise((resolve) => list.addEventListener('scroll', resolve, { once: true }));
            list.scrollTop = list.scrollHeight - list.clientHeight - to;
            return scrolled;
        }, top);
    let asked = 0;
    page.on('request', (request) => (asked += request.url().includes('cursor=') ? 1 : 0));
    await scroll(200);
    await failures.waitFor();
    for (const top of [150, 100, 50, 0]) {
        await scroll(top);
    }
    assert.equal(await failures.getAttribute('data-count'), '1');
    assert.equal(asked, 1);
    // The button asks again.
    await page.locator('#more-meshes').click();
    await page.waitForFunction(() => document.querySelector('#toasts [data-count="2"]') !== null);
    assert.equal(asked, 2);
    await page.locator('#connection').filter({ hasText: 'Connection lost' }).waitFor();
    await page.context().setOffline(false);
    await page.waitForFunction(() => document.querySelectorAll('#meshes li').length === 205);
    assert.equal(asked, 3);
});

// --- names ---

const HEBREW = '\u05e9\u05dc\u05d5\u05dd 3';
const MIXED = 'part \u0642\u0637\u0639\u0629 12 (old)';
const OVERRIDE = 'evil\u202egpj.exe\u0007';

test('names are shown without characters that control text', () => {
    assert.equal(seenName(OVERRIDE), 'evil\ufffdgpj.exe\ufffd');
    assert.equal(nameInText('cube'), 'cube');
    assert.equal(nameInText(HEBREW), `\u2068${HEBREW}\u2069`);
    assert.equal(nameInText(`\u2069${HEBREW}`), `\u2068\ufffd${HEBREW}\u2069`);
    assert.equal(storableName(` a\tb\u2066 `), 'a b');
    assert.equal(seenName('a\u2028b\u2029'), 'a\ufffdb\ufffd');
    assert.equal(storableName('a\u2028b'), 'a b');
});

// Returns the left and right edge of a part of an element's text, in pixels.
const edgesOf = (locator, part) =>
    locator.evaluate((element, wanted) => {
        const walker = document.createTreeWalker(element, NodeFilter.SHOW_TEXT);
        for (let node = walker.nextNode(); node !== null; node = walker.nextNode()) {
            const at = node.data.indexOf(wanted);
            if (at >= 0) {
                const range = document.createRange();
                range.setStart(node, at);
                range.setEnd(node, at + wanted.length);
                const { left, right } = range.getBoundingClientRect();
                return { left, right };
            }
        }
        return null;
    }, part);

test('a name from right to left does not turn the words around it', async (t) => {
    const daemon = await startDaemon(t);
    for (const name of ['cube', MIXED, HEBREW]) {
        await post(daemon, '', { name, shape: 'cube' });
    }
    // The server refuses the last name, and the browser tells the console.
    const page = await openPage(t, daemon, { allowed: [/status of 400/] });
    await page.locator('#mesh-title').filter({ hasText: HEBREW }).waitFor();
    assert.equal(await page.title(), `\u2068${HEBREW}\u2069 \u2013 hedge`);
    // The numbers below each name begin at its left edge.
    const lefts = await page
        .locator('.mesh-counts')
        .evaluateAll((all) => all.map((one) => getComputedStyle(one).direction));
    assert.deepEqual(lefts, ['ltr', 'ltr', 'ltr']);
    // In the Hebrew name the digit is at the left of the letters; in a sentence, too.
    const name = page.locator('.mesh-name').filter({ hasText: HEBREW });
    const [letters, digit] = [await edgesOf(name, '\u05e9'), await edgesOf(name, '3')];
    assert.ok(digit.right <= letters.left + 1, JSON.stringify([digit, letters]));
    await page.getByRole('button', { name: 'More actions' }).click();
    await page.getByRole('menuitem', { name: 'Duplicate' }).click();
    await waitForTold(page, /You are looking at the copy of/);
    const toast = page.getByRole('status').filter({ hasText: 'You are looking at the copy of' }).locator('p');
    const [before, inside, after] = [
        await edgesOf(toast, 'of '),
        await edgesOf(toast, '\u05e9'),
        await edgesOf(toast, '.'),
    ];
    assert.ok(before.right <= inside.left && inside.right <= after.left + 1, JSON.stringify({ before, inside, after }));
    await checkAccessible(page, 'names from right to left');
    await page.locator('#mesh-menu').click();
    await page.getByRole('menuitem', { name: 'Rename' }).click();
    const field = page.getByRole('textbox', { name: 'Name', exact: true });
    assert.equal(await field.inputValue(), `${HEBREW} copy`);
    // The server refuses what cannot be seen, and the dialog says so.
    await field.fill(OVERRIDE);
    await page.getByRole('button', { name: 'Rename', exact: true }).click();
    await page.getByText('cannot have the character U+202E').waitFor();
});

test('a mesh that was stored with a name that cannot be seen is shown', async (t) => {
    const daemon = await startDaemon(t);
    await post(daemon, '', { name: 'first', shape: 'cube' });
    const page = await openPage(t, daemon, { path: '/docs' });
    await page.route(/\/v1\/meshes(\?|\/[^/]*$)/, async (route) => {
        const answer = await route.fetch();
        const body = (await answer.text()).replaceAll('"first"', JSON.stringify(OVERRIDE));
        await route.fulfill({ response: answer, body });
    });
    await page.goto(daemon.url);
    await page.locator('#mesh-title').filter({ hasText: 'evil' }).waitFor();
    const seen = seenName(OVERRIDE);
    assert.equal(await page.locator('#mesh-title').textContent(), seen);
    assert.equal(await page.locator('.mesh-name').textContent(), seen);
    assert.equal(await page.title(), `${seen} \u2013 hedge`);
    assert.ok(await page.getByRole('button', { name: `Actions for ${seen}` }).isVisible());
});

test('a file with such a name is stored under one that can be seen', async (t) => {
    const daemon = await startDaemon(t);
    const page = await openPage(t, daemon);
    const buffer = Buffer.from('v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n');
    await page.locator('#file').setInputFiles({ name: 'a\u202eb\u0007.obj', mimeType: '', buffer });
    await page.locator('#mesh-title').filter({ hasText: 'a b' }).waitFor();
});
