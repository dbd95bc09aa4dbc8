// docs.test.mjs - tests the manual at /docs in Chromium, with the content security policy that the
// daemon sends.

import assert from 'node:assert/strict';
import { test } from 'node:test';

import { typeOf } from '../../web/src/wire/schema.js';
import { checkAccessible } from './browser.mjs';
import { startDaemon } from './daemon.mjs';
import { openPage } from './visit.mjs';

async function openManual(t, options = {}) {
    const daemon = await startDaemon(t);
    const page = await openPage(t, daemon, { path: '/docs', ...options });
    const description = await (await fetch(`${daemon.url}/v1/openapi.json`)).json();
    return { daemon, page, description };
}

test('shows every endpoint with its parameters, bodies and answers', async (t) => {
    const { page, description } = await openManual(t);
    await page.waitForSelector('#refusals');
    for (const [path, { parameters, ...methods }] of Object.entries(description.paths)) {
        for (const [method, operation] of Object.entries(methods)) {
            const text = await page.locator(`#${operation.operationId}`).innerText();
            assert.ok(text.includes(`${method.toUpperCase()} ${path}`), operation.operationId);
            assert.ok(text.includes(operation.description.replaceAll('`', '')));
            for (const { name } of [...parameters, ...operation.parameters]) {
                assert.ok(text.includes(name), `${operation.operationId}: ${name}`);
            }
            for (const status of Object.keys(operation.responses)) {
                assert.ok(text.includes(status), `${operation.operationId}: ${status}`);
            }
        }
    }
    const answer = description.paths['/v1/meshes/{mesh}/faces/{id}'].get.responses['200'];
    const { example } = answer.content['application/json'];
    const shown = await page.locator('#get_face pre').innerText();
    assert.deepEqual(JSON.parse(shown), example);
    await checkAccessible(page, 'the manual');
});

test('has a place for every link', async (t) => {
    const { page, description } = await openManual(t);
    await page.waitForSelector('#refusals');
    const { lost, schemas } = await page.evaluate(() => ({
        lost: [...document.querySelectorAll('a[href^="#"]')]
            .map((link) => link.getAttribute('href').slice(1))
            .filter((id) => document.getElementById(id) === null),
        schemas: document.querySelectorAll('section[id^="schema-"]').length,
    }));
    assert.deepEqual(lost, []);
    assert.equal(schemas, Object.keys(description.components.schemas).length);
});

test('opens at the place a link names', async (t) => {
    const { page } = await openManual(t, { path: '/docs#schema-edited' });
    await page.waitForFunction(() => {
        const place = document.getElementById('schema-edited')?.getBoundingClientRect();
        return place !== undefined && place.top >= 0 && place.top < innerHeight;
    });
});

test('is readable on a telephone', async (t) => {
    const { page } = await openManual(t, { viewport: { width: 360, height: 640 } });
    await page.waitForSelector('#refusals');
    assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth));
    await checkAccessible(page, 'the manual, narrow');
});

test('says why there is nothing to show', async (t) => {
    const { page } = await openManual(t, {
        allowed: [/500/],
        init: () => {
            const real = window.fetch;
            window.fetch = (path, options) =>
                path.includes('openapi')
                    ? Promise.resolve(new Response('', { status: 500 }))
                    : real(path, options);
        },
    });
    await page.waitForFunction(() => document.body.innerText.includes('status 500'));
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
