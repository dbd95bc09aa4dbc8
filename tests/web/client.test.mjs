// client.test.mjs - a TypeScript client, generated from the OpenAPI document that the daemon
// serves, sends requests to the daemon.

import assert from 'node:assert/strict';
import { execFile } from 'node:child_process';
import { copyFile, mkdtemp, rm, symlink, writeFile } from 'node:fs/promises';
import { tmpdir } from 'node:os';
import path from 'node:path';
import { test } from 'node:test';
import { fileURLToPath, pathToFileURL } from 'node:url';
import { promisify } from 'node:util';

import { startDaemon } from './daemon.mjs';

const here = path.dirname(fileURLToPath(import.meta.url));
const modules = path.resolve(here, '../../web/node_modules');

async function run(program, ...words) {
    try {
        await promisify(execFile)(process.execPath, [path.join(modules, program), ...words]);
    } catch (error) {
        throw new Error(`${program}: ${error.stdout}${error.stderr}`);
    }
}

// Compiles tests/web/client.ts with the types of this daemon; returns the module that it exports.
async function compileClient(t, daemon) {
    const work = await mkdtemp(path.join(tmpdir(), 'hedge-client-'));
    t.after(() => rm(work, { recursive: true }));
    const description = await (await fetch(`${daemon.url}/v1/openapi.json`)).text();
    await writeFile(path.join(work, 'openapi.json'), description);
    await writeFile(path.join(work, 'package.json'), '{"type":"module"}');
    await copyFile(path.join(here, 'client.ts'), path.join(work, 'client.ts'));
    await symlink(modules, path.join(work, 'node_modules'));
    const inside = (name) => path.join(work, name);
    await run(
        'openapi-typescript/bin/cli.js',
        inside('openapi.json'),
        '--output',
        inside('openapi.ts'),
    );
    await run(
        'typescript/bin/tsc',
        ...['--strict', '--target', 'es2022', '--module', 'nodenext', '--lib', 'es2022,dom'],
        ...['--noUncheckedIndexedAccess', '--skipLibCheck'],
        inside('client.ts'),
    );
    return import(pathToFileURL(inside('client.js')));
}

test('a generated TypeScript client compiles and works', async (t) => {
    const daemon = await startDaemon(t);
    const { tour } = await compileClient(t, daemon);
    assert.deepEqual(await tour(daemon.url), {
        faces: 2,
        vertex: 4,
        ring: [0, 1, 4],
        beside: { of: 4, faces: 4 },
        refusal: 'boundary_edge',
        element: 0,
    });
});
