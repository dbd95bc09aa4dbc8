// openapi.test.mjs - tests that the OpenAPI document uses only what generators of clients
// understand, and that the paths that a newcomer tries first lead somewhere.

import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { mkdtemp, rm, writeFile } from 'node:fs/promises';
import { tmpdir } from 'node:os';
import path from 'node:path';
import { test } from 'node:test';
import { fileURLToPath } from 'node:url';

import { startDaemon } from './daemon.mjs';

const plain = fileURLToPath(new URL('../../.ci/openapi/plain.mjs', import.meta.url));

// Returns what the checkers of OpenAPI documents find wrong with the document after `change`.
async function faultsOf(folder, document, change) {
    const copy = structuredClone(document);
    change(copy);
    const file = path.join(folder, 'openapi.json');
    await writeFile(file, JSON.stringify(copy));
    const { status, stdout } = spawnSync(process.execPath, [plain, file], { encoding: 'utf8' });
    assert.equal(status, stdout === '' ? 0 : 1);
    return stdout;
}

const planted = [
    ['an enum or const without a type', ({ schemas }) => delete schemas.domain.type],
    ['a list of types', ({ schemas }) => (schemas.label.type = ['string', 'null'])],
    ['an allOf of one', ({ schemas }) => (schemas.created.allOf.length = 1)],
    ['a union of requirements', ({ schemas }) => (schemas.counts.anyOf = [{ required: ['edges'] }])],
    ['without a format', ({ schemas }) => delete schemas.id.format],
    ['without a discriminator', ({ schemas }) => delete schemas.walk.discriminator],
];

test('the document has none of the faults that the lint finds, and the lint finds each', async (t) => {
    const { url } = await startDaemon(t);
    const document = await (await fetch(`${url}/v1/openapi.json`)).json();
    const folder = await mkdtemp(path.join(tmpdir(), 'hedge-openapi-'));
    t.after(() => rm(folder, { recursive: true }));
    assert.equal(await faultsOf(folder, document, () => {}), '');
    for (const [fault, plant] of planted) {
        const said = await faultsOf(folder, document, ({ components }) => plant(components));
        assert.match(said, new RegExp(fault), fault);
    }
    const rename = (copy) => (copy.paths['/v1/meshes'].get.operationId = 'meshes_list');
    assert.match(await faultsOf(folder, document, rename), /no verb/);
    const untag = (copy) => delete copy.paths['/v1/meshes'].get.tags;
    assert.match(await faultsOf(folder, document, untag), /no tag/);
    const strip = (copy) => {
        delete copy.paths['/v1/meshes'].get.responses[200].content['application/json'].schema;
    };
    assert.match(await faultsOf(folder, document, strip), /without a schema/);
    const loosen = (copy) => (copy.paths['/v1/meshes'].post.requestBody.content['model/gltf+json'].schema = {});
    assert.match(await faultsOf(folder, document, loosen), /may be anything/);
});

test('each part of a union is told apart by its discriminator', async (t) => {
    const { url } = await startDaemon(t);
    const { components } = await (await fetch(`${url}/v1/openapi.json`)).json();
    const listed = await (await fetch(`${url}/v1/operations`)).json();
    const names = listed.operations.map(({ name }) => name);
    const unions = { operation: 'op', done: 'op', shape: 'shape', walk: 'walk', walked: 'walk', mesh_event: 'event', job_event: 'event' };
    for (const [union, member] of Object.entries(unions)) {
        const { oneOf, discriminator } = components.schemas[union];
        assert.equal(discriminator.propertyName, member);
        assert.deepEqual(Object.values(discriminator.mapping), oneOf.map(({ $ref }) => $ref));
        for (const [name, reference] of Object.entries(discriminator.mapping)) {
            const schema = components.schemas[reference.slice(reference.lastIndexOf('/') + 1)];
            assert.equal(schema.properties[member].const, name);
            assert.ok(schema.required.includes(member));
        }
    }
    assert.deepEqual(Object.keys(components.schemas.operation.discriminator.mapping), names);
});

test('numbers that are angles say that they are in radians', async (t) => {
    const { url } = await startDaemon(t);
    const { components } = await (await fetch(`${url}/v1/openapi.json`)).json();
    const { operations } = await (await fetch(`${url}/v1/operations`)).json();
    const angles = operations.flatMap(({ name, params, results }) =>
        [...params.map((row) => [`op_${name}`, row]), ...results.map((row) => [`done_${name}`, row])]
            .filter(([, { unit }]) => unit !== undefined),
    );
    assert.deepEqual(angles.map(([schema, { name }]) => `${schema} ${name}`).sort(), [
        'done_fill_holes bend', 'done_hole_fill bend', 'done_remesh largest_angle',
        'done_remesh smallest_angle', 'op_remesh crease', 'op_segment angle', 'op_select angle',
    ]);
    for (const [schema, { name, unit }] of angles) {
        assert.equal(unit, 'radians');
        assert.match(components.schemas[schema].properties[name].description, / In radians\./);
    }
});

test('the first paths that one tries lead somewhere', async (t) => {
    const { url } = await startDaemon(t);
    const index = await (await fetch(`${url}/v1`)).json();
    assert.equal(index.name, 'hedged');
    for (const name of ['meshes', 'jobs', 'operations', 'problems', 'openapi', 'docs']) {
        assert.equal((await fetch(url + index[name])).status, 200, name);
    }
    const manual = await fetch(`${url}/docs/`);
    assert.equal(manual.url, `${url}/docs`);
    assert.match(await manual.text(), /<title>hedge/);
    const refused = await (await fetch(`${url}/v1/mesh`)).json();
    assert.match(refused.detail, /is not one of meshes, jobs/);
});
