// Tests that a file which refers to other files is sent to the server together with those, in one
// request.
import assert from 'node:assert/strict';
import { File } from 'node:buffer'; // in node 18, File is not a global
import { test } from 'node:test';

import { batchesOf } from '../../web/src/wire/batches.js';
import { get, startDaemon } from './daemon.mjs';
import { expectToast } from './page.mjs';
import { openPage } from './visit.mjs';

const gltf = (uri) => JSON.stringify({
    asset: { version: '2.0' },
    buffers: [{ byteLength: 36, uri }],
    bufferViews: [{ buffer: 0, byteLength: 36 }],
    accessors: [{ bufferView: 0, componentType: 5126, count: 3, type: 'VEC3' }],
    meshes: [{ primitives: [{ attributes: { POSITION: 0 } }] }],
});
const TRIANGLE = new Float32Array([0, 0, 0, 1, 0, 0, 0, 1, 0]);
const OBJ = 'mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n';

async function grouped(...files) {
    const named = files.map(([name, text = '']) => new File([text], name));
    const batches = await batchesOf(named);
    return batches.map(({ file, beside }) => [file, ...beside].map(({ name }) => name).join(' '));
}

test('a mesh takes what it names', async () => {
    assert.deepEqual(await grouped(['a.bin'], ['a.gltf'], ['b.bin']), ['a.gltf a.bin b.bin']);
    assert.deepEqual(await grouped(['A.OBJ'], ['a.mtl']), ['A.OBJ a.mtl']);
    // images are not sent, and each other mesh file is sent in a request of its own
    assert.deepEqual(await grouped(['a.gltf'], ['a.png'], ['b.stl'], ['a.bin']),
        ['a.gltf a.bin', 'b.stl']);
    // each of two mesh files is sent with the files that it names; a file that no mesh
    // file names is sent by itself
    assert.deepEqual(
        await grouped(['a.gltf', gltf('the%20first.bin')], ['b.obj', OBJ], ['a.mtl'],
            ['the first.bin'], ['c.bin']),
        ['a.gltf the first.bin', 'b.obj a.mtl', 'c.bin']);
    assert.deepEqual(await grouped(['a.mtl'], ['b.off']), ['a.mtl', 'b.off']);
    assert.deepEqual(await grouped(), []);
});

test('a glTF asset is chosen with its buffer', async (t) => {
    const daemon = await startDaemon(t);
    const page = await openPage(t, daemon);
    const sent = [];
    page.on('request', (request) => {
        if (request.method() === 'POST') {
            sent.push(request.headers()['content-type']);
        }
    });
    await page.locator('#file').setInputFiles([
        { name: 'part.bin', mimeType: '', buffer: Buffer.from(TRIANGLE.buffer) },
        { name: 'part.gltf', mimeType: '', buffer: Buffer.from(gltf('part.bin')) },
    ]);
    await page.locator('#mesh-title').filter({ hasText: /^part$/ }).waitFor();
    await page.locator('#canvas[data-revision="1"]').waitFor();
    const { items } = await get(daemon, '');
    assert.deepEqual(items.map(({ name, counts }) => [name, counts.vertices, counts.faces]),
        [['part', 3, 1]]);
    assert.equal(sent.length, 1);
    assert.match(sent[0], /^multipart\/form-data; boundary=/);
});

test('an OBJ is dropped with its library, and a buffer that is missing is named', async (t) => {
    const daemon = await startDaemon(t);
    const page = await openPage(t, daemon, { allowed: [/status of 422/] });
    const drop = async (files) => {
        const transfer = await page.evaluateHandle((list) => {
            const made = new DataTransfer();
            list.forEach(([name, text]) => made.items.add(new File([text], name)));
            return made;
        }, files);
        await page.dispatchEvent('body', 'drop', { dataTransfer: transfer });
    };
    await drop([['a.mtl', 'newmtl red\nKd 1 0 0\n'], ['tile.obj', OBJ]]);
    await page.locator('#mesh-title').filter({ hasText: /^tile$/ }).waitFor();
    await drop([['part.gltf', gltf('part.bin')], ['other.bin', '1']]);
    await expectToast(page, /the file 'part.bin' of a buffer was not sent; the files sent are other.bin/);
    const { items } = await get(daemon, '');
    assert.deepEqual(items.map(({ name }) => name), ['tile']);
});
