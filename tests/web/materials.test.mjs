// Tests that materials survive the way from an OBJ file and its MTL library, as a GLB file, to
// three.js and back: names and colours must stay at the same faces. three.js must also read the MTL
// library that the server writes.
import assert from 'node:assert/strict';
import { test } from 'node:test';

import { GLTFExporter } from '../../web/node_modules/three/examples/jsm/exporters/GLTFExporter.js';
import { GLTFLoader } from '../../web/node_modules/three/examples/jsm/loaders/GLTFLoader.js';
import { MTLLoader } from '../../web/node_modules/three/examples/jsm/loaders/MTLLoader.js';
import { post, startDaemon } from './daemon.mjs';
import { FileReader } from './file_reader.mjs';

const LIBRARY = `newmtl red
Kd 1 0.25 0
d 0.5
newmtl green
Kd 0 0.75 0.125
Ke 0 2 0
Pm 0.5
Pr 0.25
`;
const SOURCE = [
    'mtllib two.mtl',
    ...[0, 1, 2, 3, 4, 5, 6, 7].map((i) => `v ${i & 1} ${(i >> 1) & 1} ${i >> 2}`),
    'usemtl red', 'f 1 3 4 2', 'f 5 6 8 7', 'usemtl green', 'f 1 2 6 5', 'f 3 7 8 4',
    'usemtl red', 'f 1 5 7 3', 'f 2 4 8 6',
].join('\n');

async function create(url, body, type) {
    const headers = type === undefined ? {} : { 'Content-Type': type };
    const answer = await fetch(`${url}/v1/meshes`, { method: 'POST', headers, body });
    const made = await answer.json();
    assert.equal(answer.status, 201, JSON.stringify(made));
    return made;
}

const content = (url, id, format) => fetch(`${url}/v1/meshes/${id}/content?format=${format}`);

const materials = async (url, id) =>
    (await (await fetch(`${url}/v1/meshes/${id}/materials`)).json()).materials;

// Returns the centre of each triangle, and the material with which three.js draws it.
async function drawn(glb) {
    const { scene } = await new GLTFLoader().parseAsync(glb, '');
    const triangles = [];
    scene.traverse((object) => {
        if (!object.isMesh) {
            return;
        }
        const { index, attributes: { position } } = object.geometry;
        const { name, color, opacity, metalness, roughness } = object.material;
        const look = [...color.toArray(), opacity, metalness, roughness].map((n) => n.toFixed(4));
        for (let i = 0; i < index.count; i += 3) {
            const middle = ['getX', 'getY', 'getZ'].map((get) =>
                ([0, 1, 2].reduce((sum, k) => sum + position[get](index.getX(i + k)), 0) / 3).toFixed(3));
            triangles.push(`${middle} ${name} ${look}`);
        }
    });
    return { scene, triangles: triangles.sort() };
}

test('materials stay at their faces on the way to three.js and back', async (t) => {
    const { url } = await startDaemon(t);
    const form = new FormData();
    form.append('mesh', new Blob([SOURCE]), 'cube.obj');
    form.append('library', new Blob([LIBRARY]), 'two.mtl');
    const mesh = await create(url, form);
    assert.deepEqual(mesh.import.warnings.map(({ code }) => code), []);

    const [red, green] = await materials(url, mesh.id);
    assert.deepEqual(red.base_color, [1, 0.25, 0, 0.5]);
    assert.deepEqual(green.emission, [0, 2, 0]);

    const glb = await (await content(url, mesh.id, 'glb')).arrayBuffer();
    const { scene, triangles } = await drawn(glb);
    assert.equal(triangles.length, 12);
    const count = (name) => triangles.filter((line) => line.includes(` ${name} `)).length;
    assert.equal(count('red'), 8);
    assert.equal(count('green'), 4);
    assert.ok(triangles.some((line) => line.endsWith('red 1.0000,0.2500,0.0000,0.5000,0.0000,1.0000')));
    assert.ok(triangles.some((line) => line.endsWith('green 0.0000,0.7500,0.1250,1.0000,0.5000,0.2500')));

    // The file that three.js writes must have the same materials at the same triangles.
    globalThis.FileReader = FileReader;
    const written = await new GLTFExporter().parseAsync(scene, { binary: true });
    const back = await create(url, written, 'model/gltf-binary');
    const again = await (await content(url, back.id, 'glb')).arrayBuffer();
    assert.deepEqual((await drawn(again)).triangles, triangles);
    assert.deepEqual((await materials(url, back.id)).map(({ name }) => name).sort(), ['green', 'red']);

    // If the server reads its own file, the mesh must have six faces, and a colour that is changed
    // must appear in the next file.
    const own = await create(url, glb, 'model/gltf-binary');
    assert.equal(own.counts.faces, 6);
    assert.deepEqual(await materials(url, own.id), [red, green]);
    await post({ url }, `/${own.id}/edits`,
        { op: 'material_set', name: 'red', base_color: [0, 0, 1], faces: [2] });
    const changed = await drawn(await (await content(url, own.id, 'glb')).arrayBuffer());
    assert.equal(changed.triangles.filter((line) =>
        line.endsWith('red 0.0000,0.0000,1.0000,0.5000,0.0000,1.0000')).length, 10);

    // the library must have the name that the OBJ file gives it
    const answer = await content(url, mesh.id, 'mtl');
    assert.match(answer.headers.get('Content-Disposition'), /filename="two\.mtl"/);
    assert.match(await (await content(url, mesh.id, 'obj')).text(), /^mtllib two\.mtl$/m);
    const { materialsInfo } = new MTLLoader().parse(await answer.text(), '');
    assert.deepEqual(materialsInfo.red.kd.map(Number), [1, 0.25, 0]);
    assert.equal(Number(materialsInfo.green.pm ?? materialsInfo.green.Pm), 0.5);
});
