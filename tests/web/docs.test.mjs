// docs.test.mjs - tests the manual at /docs: its pages as texts, their code against a daemon, and what
// they do in Chromium, with the content security policy that the daemon sends.

import assert from 'node:assert/strict';
import { spawn } from 'node:child_process';
import { readFileSync } from 'node:fs';
import { once } from 'node:events';
import { test } from 'node:test';

import { typeOf } from '../../web/src/wire/schema.js';
import { find } from '../../web/src/manual/search.js';
import { BASE } from '../../web/manual/samples.mjs';
import { checkAccessible } from './browser.mjs';
import { startDaemon } from './daemon.mjs';
import { openPage } from './visit.mjs';

// The most pixels that a page may be high, in a window of 1280 pixels.
const HIGHEST = 12000;
// The most bytes of a page, compressed.
const LARGEST = 25000;

const parsed = new Map([['&lt;', '<'], ['&gt;', '>'], ['&quot;', '"'], ['&amp;', '&']]);
const unescape = (text) => text.replace(/&(lt|gt|quot|amp);/g, (found) => parsed.get(found));

async function read(url, path) {
    const answer = await fetch(`${url}${path}`, { headers: { Accept: 'text/html' } });
    return { answer, text: await answer.text() };
}

async function tablesOf(url) {
    const get = async (path) => (await fetch(url + path)).json();
    return {
        openapi: await get('/v1/openapi.json'),
        operations: (await get('/v1/operations')).operations,
        problems: (await get('/v1/problems')).problems,
    };
}

// Returns all pages that links of the manual lead to, from the first one on: a map from paths to
// {text, links}; `links` are absolute addresses.
async function crawl(url) {
    const pages = new Map();
    const waiting = ['/docs'];
    while (waiting.length > 0) {
        const path = waiting.pop();
        if (pages.has(path)) {
            continue;
        }
        const { answer, text } = await read(url, path);
        assert.equal(answer.status, 200, path);
        const links = [...text.matchAll(/<(?:a|link)\s[^>]*?href="([^"]*)"|<script[^>]*src="([^"]*)"|<img[^>]*src="([^"]*)"/g)]
            .map(([, ...found]) => new URL(unescape(found.find(Boolean)), url + path));
        pages.set(path, { text, links });
        waiting.push(...links.filter(({ pathname }) => pathname.startsWith('/docs')).map(({ pathname }) => pathname));
    }
    return pages;
}

test('every operation, route, problem and type has a page, and every link leads somewhere', async (t) => {
    const { url } = await startDaemon(t);
    const { openapi, operations, problems } = await tablesOf(url);
    const pages = await crawl(url);
    const routes = Object.values(openapi.paths).flatMap((methods) => Object.values(methods)).filter(({ operationId }) => operationId);
    for (const [kind, names] of Object.entries({
        operations: operations.map(({ name }) => name),
        routes: routes.map(({ operationId }) => operationId),
        problems: problems.map(({ code }) => code),
        types: Object.keys(openapi.components.schemas).filter((name) => name === 'op_size' || !/^(op|done)_/.test(name)),
    })) {
        for (const name of names) {
            assert.ok(pages.has(`/docs/${kind}/${name}`), `${kind}/${name}`);
        }
    }
    for (const { docs } of [...operations, ...problems]) {
        assert.ok(pages.has(docs), docs);
    }
    const others = new Set();
    for (const [path, { links }] of pages) {
        for (const { origin, pathname, hash } of links) {
            assert.equal(origin, url, `${path} leads to ${origin}`);
            const target = pages.get(pathname);
            if (target === undefined) {
                others.add(pathname);
            } else if (hash !== '') {
                assert.ok(target.text.includes(`id="${decodeURIComponent(hash.slice(1))}"`), `${path}: no ${pathname}${hash}`);
            }
        }
    }
    for (const path of others) {
        assert.equal((await fetch(url + path)).status, 200, path);
    }
    t.diagnostic(`note: ${pages.size} pages`);
});

test('the pages say what the tables say', async (t) => {
    const { url } = await startDaemon(t);
    const { openapi, operations, problems } = await tablesOf(url);
    const textOf = async (path) => unescape((await read(url, path)).text.replaceAll(/<[^>]*>/g, ''));
    for (const { name, doc, params, results, refusals } of operations) {
        const text = await textOf(`/docs/operations/${name}`);
        for (const said of [doc.replaceAll('`', ''), ...[...params, ...results].map((each) => each.name), ...refusals]) {
            assert.ok(text.includes(said), `${name}: ${said}`);
        }
    }
    for (const { code, title, status, doc } of problems) {
        const text = await textOf(`/docs/problems/${code}`);
        for (const said of [code, title, String(status), doc.replaceAll('`', ''), 'What to do']) {
            assert.ok(text.includes(said), `${code}: ${said}`);
        }
    }
    for (const [path, { parameters = [], ...methods }] of Object.entries(openapi.paths)) {
        for (const [method, operation] of Object.entries(methods)) {
            const text = await textOf(`/docs/routes/${operation.operationId}`);
            const names = [...parameters, ...operation.parameters].map(({ name }) => name);
            for (const said of [method.toUpperCase(), path, operation.summary, operation.description.replaceAll('`', ''), ...names, ...Object.keys(operation.responses)]) {
                assert.ok(text.includes(said), `${operation.operationId}: ${said}`);
            }
        }
    }
});

test('pages are compressed, revalidated, and under a strict policy', async (t) => {
    const { url } = await startDaemon(t);
    for (const path of ['/docs', '/docs/operations', '/docs/operations/edge_split', '/docs/half-edges']) {
        const answer = await fetch(url + path, { headers: { 'Accept-Encoding': 'gzip' } });
        assert.equal(answer.headers.get('Content-Encoding'), 'gzip', path);
        assert.equal(answer.headers.get('Cache-Control'), 'no-cache');
        assert.match(answer.headers.get('Content-Security-Policy'), /^default-src 'none'; script-src 'self'/);
        assert.ok(Number(answer.headers.get('Content-Length')) < LARGEST, `${path} has ${answer.headers.get('Content-Length')} bytes`);
        const etag = answer.headers.get('ETag');
        const again = await fetch(url + path, { headers: { 'If-None-Match': etag, 'Accept-Encoding': 'gzip' } });
        assert.equal(again.status, 304, path);
    }
    const problem = await (await fetch(`${url}/v1/meshes/nothing`)).json();
    const page = await fetch(url + problem.type);
    assert.equal(page.url, `${url}/docs/problems/no_such_mesh`);
    assert.equal(page.status, 200);
});

// Returns the requests of a page, in their order: for each its codes by language, and whether it has
// an answer of an event stream.
function codesOf(text) {
    return [...text.matchAll(/<div class="request"[^>]*?>.*?<\/fieldset>/gs)].map(([block]) => ({
        step: JSON.parse(unescape(/data-step="([^"]*)"/.exec(block)?.[1] ?? '{}')),
        codes: Object.fromEntries(['curl', 'python', 'fetch'].map((language) => {
            const [, code] = new RegExp(`<pre class="${language}"[^>]*><code>(.*?)</code>`, 's').exec(block);
            return [language, unescape(code)];
        })),
    }));
}

const PROGRAMS = {
    curl: (code) => ['sh', ['-c', `${code} --fail-with-body --silent --show-error`]],
    python: (code) => ['python3', ['-B', '-c', code]],
    fetch: (code) => [process.execPath, ['--input-type=module', '-e', code]],
    js: (code) => [process.execPath, ['--input-type=module', '-e', code]],
};

async function run(url, language, code) {
    const [program, args] = PROGRAMS[language](code.replaceAll(BASE, url).replace(/-o answer\.bin/, '-o /dev/null'));
    const child = spawn(program, args, { stdio: ['ignore', 'pipe', 'pipe'] });
    const parts = [];
    child.stdout.on('data', (part) => parts.push(part));
    child.stderr.on('data', (part) => parts.push(part));
    const [status] = await once(child, 'close');
    return { status, output: Buffer.concat(parts).toString() };
}

for (const language of ['curl', 'python', 'fetch']) {
    test(`the code for ${language} runs`, async (t) => {
        const { url } = await startDaemon(t);
        let count = 0;
        for (const path of [
            '/docs/start', '/docs/guides/repair', '/docs/guides/batches', '/docs/guides/arrays', '/docs/guides/files',
            '/docs/operations/edge_split', '/docs/operations/face_extrude', '/docs/routes/create_mesh',
            '/docs/routes/get_mesh', '/docs/routes/export_mesh', '/docs/routes/update_mesh', '/docs/routes/get_geometry',
            '/docs/routes/query_mesh', '/docs/routes/list_boundaries', '/docs/routes/delete_mesh', '/docs/problems/boundary_edge',
        ]) {
            const { text } = await read(url, path);
            for (const { id } of (await (await fetch(`${url}/v1/meshes`)).json()).items) {
                await fetch(`${url}/v1/meshes/${id}`, { method: 'DELETE' });
            }
            const shown = [...text.matchAll(/<p class="status(?: refused)?">(\d+)/g)].map(([, status]) => Number(status));
            const refused = shown.some((status) => status >= 400);
            for (const { step, codes } of codesOf(text)) {
                const { status, output } = await run(url, language, codes[language]);
                // curl says by its exit status that a request was refused; the others print the problem.
                const isFine = status === 0 || (language === 'curl' && refused && output.includes('"/problems/'));
                assert.ok(isFine, `${path}: ${step.method} ${step.path}: ${output}\n${codes[language]}`);
                count += 1;
            }
        }
        assert.ok(count > 40, `only ${count} requests`);
        t.diagnostic(`note: ${count} requests in ${language}`);
    });
}

test('the programs of the guides run, and print what they should', async (t) => {
    const { url } = await startDaemon(t);
    const folder = new URL('../../web/manual/guides/', import.meta.url);
    const wanted = {
        'half-edges.md': ['half-edge 0 leads to vertex 1\nhalf-edge 5 leads to vertex 2\nhalf-edge 9 leads to vertex 3\n'],
        'arrays.md': [
            '162 values, the last is 0.99',
            '8 points, 6 faces; face 0 has [0, 3, 2, 1]\nmoved 8\n',
        ],
        'large.md': ['done 65536 faces'],
        'errors.md': ['422 wrong_degree - vertex 3 has degree 3', '422 wrong_degree - vertex 3 has degree 3'],
    };
    for (const [name, outputs] of Object.entries(wanted)) {
        const fences = [...readFileSync(new URL(name, folder), 'utf8').matchAll(/^```(python|js) run\n(.*?)^```$/gms)];
        assert.equal(fences.length, outputs.length, name);
        for (const [i, [, language, code]] of fences.entries()) {
            const { status, output } = await run(url, language, code);
            assert.equal(status, 0, output);
            assert.ok(output.startsWith(outputs[i]), `${name}: ${output}`);
        }
    }
});

test('the list of the search finds pages', async (t) => {
    const { url } = await startDaemon(t);
    const { text } = await read(url, '/docs');
    const index = await (await fetch(new URL(/data-index="([^"]*)"/.exec(text)[1], `${url}/docs`))).json();
    const first = (words) => find(index, words)[0]?.[1];
    assert.equal(first('edge split'), 'docs/operations/edge_split');
    assert.equal(first('edge_spl'), 'docs/operations/edge_split');
    assert.equal(first('stale_revision'), 'docs/problems/stale_revision');
    assert.equal(first('repair'), 'docs/guides/repair');
    assert.equal(first('create a mesh'), 'docs/routes/create_mesh');
    assert.equal(first('/v1/meshes/{mesh}/undo'), 'docs/routes/undo_edits');
    assert.equal(first('Export'), 'docs/routes/export_mesh');
    assert.deepEqual(find(index, 'qwertz'), []);
    assert.deepEqual(find(index, '  '), []);
    assert.ok(find(index, 'vertex').length <= 12);
});

test('is readable without scripts', async (t) => {
    const daemon = await startDaemon(t);
    const page = await openPage(t, daemon, { path: '/docs', javaScriptEnabled: false });
    await page.getByRole('link', { name: 'All pages' }).click();
    await page.waitForURL('**/docs/all');
    await page.getByRole('link', { name: 'edge_flip', exact: true }).click();
    await page.waitForURL('**/docs/operations/edge_flip');
    const text = await page.locator('main').innerText();
    for (const said of ['Flip an edge', 'Before', 'After', '200 OK', 'boundary_edge', 'The edge is on the boundary']) {
        assert.ok(text.includes(said), said);
    }
    assert.equal(await page.locator('svg.mesh[role=img]').count(), 2);
    assert.equal(await page.locator('button').count(), 0);
    assert.equal(await page.locator('.request pre.curl').last().isVisible(), true);
    assert.equal(await page.locator('.request pre.python').last().isVisible(), false);
    await page.locator('.request label', { hasText: 'Python' }).last().click();
    assert.equal(await page.locator('.request pre.python').last().isVisible(), true);
    assert.equal(await page.locator('.request pre.curl').last().isVisible(), false);
});

test('an operation can be tried, and its drawing follows', async (t) => {
    const daemon = await startDaemon(t);
    const page = await openPage(t, daemon, { path: '/docs/operations/edge_split', allowed: [/status of 422/] });
    const request = page.locator('.request').last();
    const after = page.locator('.pair .after svg');
    assert.match(await after.getAttribute('aria-label'), /New: vertex 10/);
    await request.getByText('Change the body').click();
    await request.getByLabel('Body of POST /v1/meshes/try-patch/edits').fill('{"op":"face_poke","face":3}');
    await request.getByRole('button', { name: 'Run' }).click();
    await page.waitForFunction(() => document.querySelector('.live') !== null);
    assert.match(await request.locator('.answer').innerText(), /^200 OK from this server[^]*"face_poke"/);
    await page.waitForFunction(() => /^Your edit/.test(document.querySelector('figcaption').textContent));
    assert.match(await page.locator('figcaption').innerText(), /New: vertex 10, edges 19, 20 and 21, faces 10 and 11/);
    assert.match(await after.getAttribute('aria-label'), /11 vertices, 22 edges, 12 faces/);
    await checkAccessible(page, 'an operation that was tried');

    await request.locator('textarea').fill('{"op":"edge_flip","edge":1}');
    await request.getByRole('button', { name: 'Run' }).click();
    await page.waitForFunction(() => document.querySelector('.status.refused') !== null);
    assert.match(await request.locator('.answer').innerText(), /^422 The edge is on the boundary/);
    await request.locator('textarea').fill('{"op":');
    await request.getByRole('button', { name: 'Run' }).click();
    await request.locator('.wrong', { hasText: 'The body is not JSON' }).waitFor();
    await checkAccessible(page, 'a body that is no JSON');

    // The page's mesh is deleted when it is left.
    const ids = async () => (await (await fetch(`${daemon.url}/v1/meshes`)).json()).items.map(({ id }) => id);
    assert.equal((await ids()).length, 1);
    assert.match((await ids())[0], /^try-patch-/);
    await page.goto(`${daemon.url}/docs/types`);
    while ((await ids()).length > 0) {
        // The request that deletes it is sent while the page is left, and may come after the next one.
    }
});

test('routes, streams, jobs and the steps of a guide can be tried', async (t) => {
    const daemon = await startDaemon(t);
    const page = await openPage(t, daemon, { path: '/docs/routes/list_boundaries', allowed: [/status of 4(12|22)/] });
    const tryLast = async (path, pattern) => {
        await page.goto(daemon.url + path);
        const request = page.locator('.request[data-step]').last();
        await request.getByRole('button', { name: 'Run' }).click();
        await request.locator('.live').waitFor();
        assert.match(await request.locator('.answer').innerText(), pattern, path);
    };
    await tryLast('/docs/routes/list_boundaries', /^200 OK from this server[^]*"loops"/);
    await tryLast('/docs/routes/get_geometry', /192 bytes of application\/octet-stream/);
    await tryLast('/docs/routes/follow_mesh', /event: edit|event: metadata/);
    await tryLast('/docs/routes/delete_mesh', /^204 No Content/);
    await tryLast('/docs/routes/get_job_result', /^200 OK[^]*"try-job"/);
    await tryLast('/docs/problems/stale_revision', /^412 The mesh is at another revision/);
    await tryLast('/docs/half-edges', /"id": 4[^]*"origin": 3/);
    await tryLast('/docs/guides/live', /event: edit/);
});

test('remembers the language, and copies the code for this server', async (t) => {
    const daemon = await startDaemon(t);
    const page = await openPage(t, daemon, { path: '/docs/start', permissions: ['clipboard-read', 'clipboard-write'] });
    const request = page.locator('.request').nth(2);
    await request.locator('label', { hasText: 'fetch' }).click();
    await request.getByRole('button', { name: 'Copy' }).click();
    await request.getByText('Copied').waitFor();
    const copied = await page.evaluate(() => navigator.clipboard.readText());
    assert.ok(copied.includes(`await fetch('${daemon.url}/v1/meshes/try-first/vertices/2')`), copied);
    await page.goto(`${daemon.url}/docs/guides/history`);
    assert.equal(await page.locator('pre.fetch').first().isVisible(), true);
    assert.equal(await page.locator('pre.curl').first().isVisible(), false);
});

test('the search is reached and used by keys', async (t) => {
    const daemon = await startDaemon(t);
    const page = await openPage(t, daemon, { path: '/docs/operations/edge_split' });
    await page.keyboard.press('/');
    await page.keyboard.type('face extr');
    await page.getByRole('link', { name: /^face_extrude/ }).first().waitFor();
    await checkAccessible(page, 'search results');
    await page.keyboard.press('ArrowDown');
    await page.keyboard.press('ArrowUp');
    assert.equal(await page.evaluate(() => document.activeElement.id), 'search');
    await page.keyboard.press('Escape');
    assert.equal(await page.locator('.found').isVisible(), false);
    await page.keyboard.type('u');
    await page.locator('.found').waitFor();
    await page.keyboard.press('Enter');
    await page.waitForURL('**/docs/operations/face_extrude');
    await page.getByLabel('Search the manual').fill('qwertz');
    await page.getByText('No page has “qwertz”.').waitFor();
});

test('an address without a page leads to the search', async (t) => {
    const daemon = await startDaemon(t);
    const page = await openPage(t, daemon, { path: '/docs/operations/split_edges', allowed: [/404/] });
    assert.equal(await page.locator('h1').innerText(), 'There is no such page');
    assert.equal(await page.getByLabel('Search the manual').inputValue(), 'split edges');
    await checkAccessible(page, 'a missing page');
    await page.getByRole('link', { name: 'The first page of the manual' }).click();
    await page.waitForURL('**/docs');
    const { answer } = await read(daemon.url, '/docs/a/b/c');
    assert.equal(answer.status, 404);
    assert.match(answer.headers.get('Content-Type'), /^text\/html/);
});

test('old addresses lead to the new pages', async (t) => {
    const daemon = await startDaemon(t);
    const page = await openPage(t, daemon, { path: '/docs#create_mesh' });
    await page.waitForURL('**/docs/routes/create_mesh');
    for (const [old, now] of [
        ['schema-edited', 'types/edited'], ['schema-op_edge_split', 'operations/edge_split'], ['refusals', 'problems'],
    ]) {
        await page.goto(`${daemon.url}/docs/start`);
        await page.goto(`${daemon.url}/docs#${old}`);
        await page.waitForURL(`**/docs/${now}`);
    }
    await page.goto(`${daemon.url}/docs#guides`);
    assert.equal(await page.locator('h1').innerText(), 'The manual of hedge');
});

for (const [name, options] of Object.entries({
    desktop: {},
    telephone: { viewport: { width: 320, height: 640 } },
    dark: { colorScheme: 'dark' },
})) {
    test(`is accessible and of a reasonable size: ${name}`, async (t) => {
        const daemon = await startDaemon(t);
        const page = await openPage(t, daemon, { path: '/docs', ...options });
        for (const path of [
            '/docs', '/docs/start', '/docs/half-edges', '/docs/guides', '/docs/guides/live', '/docs/guides/errors', '/docs/operations',
            '/docs/operations/select', '/docs/operations/face_extrude', '/docs/routes', '/docs/routes/apply_edits',
            '/docs/problems', '/docs/problems/closed_fan', '/docs/problems/store_full', '/docs/types', '/docs/types/summary', '/docs/all',
        ]) {
            await page.goto(daemon.url + path);
            await page.getByLabel('Search the manual').waitFor();
            const { width, height } = await page.evaluate(() => ({
                width: document.documentElement.scrollWidth - innerWidth, height: document.documentElement.scrollHeight,
            }));
            assert.ok(width <= 0, `${path} is ${width} pixels too wide`);
            assert.ok(name === 'telephone' || height < HIGHEST, `${path} is ${height} pixels high`);
            await checkAccessible(page, `${path}, ${name}`);
        }
    });
}

test('no page is higher than a reader would read', async (t) => {
    const daemon = await startDaemon(t);
    const pages = [...(await crawl(daemon.url)).keys()];
    const page = await openPage(t, daemon, { path: '/docs', javaScriptEnabled: false });
    let highest = ['', 0];
    for (const path of pages) {
        await page.goto(daemon.url + path);
        const { height } = await page.locator('html').boundingBox();
        highest = height > highest[1] ? [path, height] : highest;
    }
    assert.ok(highest[1] < HIGHEST, `${highest[0]} is ${highest[1]} pixels high`);
    t.diagnostic(`note: the highest of ${pages.length} pages is ${highest[0]} with ${highest[1]} pixels`);
});

test('types are words', () => {
    assert.deepEqual(typeOf({ type: 'integer', minimum: 0 }), ['integer from 0']);
    assert.deepEqual(typeOf({ type: 'number', exclusiveMinimum: 0, maximum: 1, default: 1 }), [
        'number above 0 to 1',
        '; 1 if not given',
    ]);
    const id = { $ref: '#/components/schemas/id' };
    assert.deepEqual(typeOf({ type: 'array', items: id }), ['array of ', { ref: 'id' }]);
    assert.deepEqual(typeOf({ anyOf: [id, { type: 'null' }] }), [{ ref: 'id' }, ' or ', 'null']);
    assert.deepEqual(typeOf({ enum: ['a', 'b'] }), ['"a" or "b"']);
    assert.deepEqual(typeOf({ type: 'array', items: id, minItems: 3, maxItems: 3 }), [
        '3 of ',
        { ref: 'id' },
    ]);
    assert.deepEqual(typeOf({ type: 'array', maxItems: 0 }), ['empty array']);
    assert.deepEqual(typeOf({}), ['anything']);
});
