// Tests that a mesh whose texture has seams survives the way as a GLB file to three.js and back:
// the same texture coordinates must be at the same corners, although three.js has values of
// vertices only.
import assert from 'node:assert/strict';
import { test } from 'node:test';

import { GLTFExporter } from '../../web/node_modules/three/examples/jsm/exporters/GLTFExporter.js';
import { GLTFLoader } from '../../web/node_modules/three/examples/jsm/loaders/GLTFLoader.js';
import { post, startDaemon } from './daemon.mjs';
import { FileReader } from './file_reader.mjs';

// A cube; each of its six faces has a normal and a square of the texture.
const CUBE = [
    ...[0, 1, 2, 3, 4, 5, 6, 7].map((i) => `v ${i & 1} ${(i >> 1) & 1} ${i >> 2}`),
    ...Array.from({ length: 24 }, (_, i) => {
        const [face, corner] = [i >> 2, i & 3];
        return `vt ${(face + (corner === 1 || corner === 2)) / 8} ${(face % 4) / 8 + (corner >> 1) / 16}`;
    }),
    'vn 0 0 -1', 'vn 0 0 1', 'vn 0 -1 0', 'vn 0 1 0', 'vn -1 0 0', 'vn 1 0 0',
    ...['1 3 4 2', '5 6 8 7', '1 2 6 5', '3 7 8 4', '1 5 7 3', '2 4 8 6'].map(
        (face, f) => `f ${face.split(' ').map((v, k) => `${v}/${4 * f + k + 1}/${f + 1}`).join(' ')}`),
].join('\n');

const say = (...numbers) => numbers.map((n) => n.toFixed(5)).join(' ');

// Returns the position and texture coordinate of each corner of an OBJ file, without repetitions.
function cornersOfObj(text) {
    const lines = text.split('\n').map((line) => line.split(' '));
    const rows = (word) => lines.filter((w) => w[0] === word).map((w) => w.slice(1).map(Number));
    const [v, vt] = [rows('v'), rows('vt')];
    const corners = lines.filter((w) => w[0] === 'f').flatMap((w) => w.slice(1));
    return [...new Set(corners.map((corner) => {
        const [a, b] = corner.split('/');
        return say(...v[a - 1], ...vt[b - 1]);
    }))].sort();
}

// Returns the corners of a mesh of three.js in the form that cornersOfObj() returns; three.js has
// texture coordinates whose v points down.
function cornersOfThree(mesh) {
    const { position, uv } = mesh.geometry.attributes;
    return [...new Set(Array.from(mesh.geometry.index.array, (i) =>
        say(position.getX(i), position.getY(i), position.getZ(i), uv.getX(i), 1 - uv.getY(i))))].sort();
}

async function meshOf(glb) {
    const { scene } = await new GLTFLoader().parseAsync(glb, '');
    const meshes = [];
    scene.traverse((object) => object.isMesh && meshes.push(object));
    assert.equal(meshes.length, 1);
    return meshes[0];
}

async function create(url, type, body, query = '') {
    const answer = await fetch(`${url}/v1/meshes${query}`, {
        method: 'POST', headers: { 'Content-Type': type }, body,
    });
    const made = await answer.json();
    assert.equal(answer.status, 201, JSON.stringify(made));
    return made;
}

const content = async (url, id, format) =>
    fetch(`${url}/v1/meshes/${id}/content?format=${format}`);

test('texture coordinates stay at their corners on the way to three.js and back', async (t) => {
    const { url } = await startDaemon(t);
    const mesh = await create(url, 'model/obj', CUBE);
    const wanted = cornersOfObj(CUBE);
    assert.equal(wanted.length, 24);

    const glb = await (await content(url, mesh.id, 'glb')).arrayBuffer();
    const seen = await meshOf(glb);
    assert.deepEqual(cornersOfThree(seen), wanted);
    assert.equal(seen.geometry.index.count, 36);

    globalThis.FileReader = FileReader;
    const written = await new GLTFExporter().parseAsync(seen, { binary: true });
    const apart = await create(url, 'model/gltf-binary', written);
    assert.equal(apart.counts.components, 6);
    const told = apart.import.warnings.find(({ code }) => code === 'open_seams');
    assert.match(told.detail, /repair=weld/);
    assert.equal(told.count, 12);

    const back = await create(url, 'model/gltf-binary', written, '?repair=weld');
    assert.equal(back.counts.vertices, 8);
    assert.equal(back.closed, true);
    assert.ok(back.import.repairs[0].moved > 0);
    assert.deepEqual(cornersOfObj(await (await content(url, back.id, 'obj')).text()), wanted);

    // If the server reads its own file, the mesh must have its polygons, and an edit of one face
    // must leave the other faces as they were.
    const again = await create(url, 'model/gltf-binary', glb);
    assert.equal(again.counts.faces, 6);
    assert.deepEqual(cornersOfObj(await (await content(url, again.id, 'obj')).text()), wanted);
    await post({ url }, `/${again.id}/edits`, { op: 'face_extrude', face: 1, distance: 1 });
    const edited = cornersOfObj(await (await content(url, again.id, 'obj')).text());
    assert.deepEqual(wanted.filter((corner) => !edited.includes(corner)), []);
});
