// Tests that models with a texture can be welded, edited at a seam and exported: every corner must
// keep its texture coordinate, and the seams must be where they were, also if three.js reads them.
//
// The test makes a model. If the variable TEXTURED names a folder, the models in it are tested in
// the same way: OBJ files of triangles, and GLB files with one mesh.
import assert from 'node:assert/strict';
import { readFileSync, readdirSync } from 'node:fs';
import path from 'node:path';
import { test } from 'node:test';

import { GLTFExporter } from '../../web/node_modules/three/examples/jsm/exporters/GLTFExporter.js';
import { GLTFLoader } from '../../web/node_modules/three/examples/jsm/loaders/GLTFLoader.js';
import { Vector3 } from '../../web/node_modules/three/build/three.module.js';
import { post, startDaemon } from './daemon.mjs';
import { FileReader } from './file_reader.mjs';

// Makes a tube that is bent to a ring. For its texture it has two seams, one around the ring and
// one around the tube.
function ring(around, across) {
    const lines = [];
    for (let i = 0; i < around * across; i++) {
        const [a, b] = [Math.floor(i / across) / around, (i % across) / across].map((x) => 2 * Math.PI * x);
        const out = 3 + Math.cos(b);
        lines.push(`v ${[out * Math.cos(a), out * Math.sin(a), Math.sin(b)].map(Math.fround).join(' ')}`);
    }
    for (let i = 0; i < (around + 1) * (across + 1); i++) {
        lines.push(`vt ${Math.floor(i / (across + 1)) / around} ${(i % (across + 1)) / across}`);
    }
    const corner = (i, k) =>
        `${(i % around) * across + (k % across) + 1}/${i * (across + 1) + k + 1}`;
    for (let i = 0; i < around; i++) {
        for (let k = 0; k < across; k++) {
            const [a, b, c, d] = [corner(i, k), corner(i + 1, k), corner(i + 1, k + 1), corner(i, k + 1)];
            lines.push(`f ${a} ${b} ${c}`, `f ${a} ${c} ${d}`);
        }
    }
    return lines.join('\n');
}

// --- faces as lists of corners, {vertex, place, uv}, where v points up ---

function facesOfObj(text) {
    const lines = text.split('\n').map((line) => line.trim().split(/\s+/));
    const rows = (word) => lines.filter((w) => w[0] === word).map((w) => w.slice(1).map(Number));
    const [v, vt] = [rows('v'), rows('vt')];
    return lines.filter((w) => w[0] === 'f').map((w) =>
        w.slice(1).map((corner) => {
            const [a, b] = corner.split('/').map(Number);
            return { vertex: a - 1, place: v[a - 1].slice(0, 3), uv: vt[b - 1].slice(0, 2) };
        }));
}

// Returns a GLB file without its materials, which name images that only a browser can read.
function withoutMaterials(glb) {
    const length = new DataView(glb).getUint32(12, true);
    const json = JSON.parse(Buffer.from(glb, 20, length).toString());
    ['materials', 'textures', 'images'].forEach((name) => delete json[name]);
    json.meshes.flatMap(({ primitives }) => primitives).forEach((it) => delete it.material);
    const copy = Buffer.from(glb.slice(0));
    copy.write(JSON.stringify(json).padEnd(length), 20);
    return copy.buffer;
}

async function meshOf(glb) {
    const { scene } = await new GLTFLoader().parseAsync(withoutMaterials(glb), '');
    const meshes = [];
    scene.updateMatrixWorld();
    scene.traverse((object) => object.isMesh && meshes.push(object));
    assert.equal(meshes.length, 1);
    return meshes[0];
}

function facesOfThree(mesh) {
    const { index, attributes: { position, uv } } = mesh.geometry;
    const corner = (i) => {
        const place = new Vector3().fromBufferAttribute(position, i).applyMatrix4(mesh.matrixWorld);
        return { place: place.toArray(), uv: [uv.getX(i), 1 - uv.getY(i)] };
    };
    return Array.from({ length: index.count / 3 }, (_, f) =>
        [0, 1, 2].map((k) => corner(index.getX(3 * f + k))));
}

const isNear = (a, b, most) => a.every((x, i) => Math.abs(x - b[i]) <= most);

// Returns whether two faces have the same corners in the same order, beginning at any corner.
function sameFace(a, b, size) {
    const same = (p, q) => isNear(p.place, q.place, 1e-5 * size) && isNear(p.uv, q.uv, 1e-5);
    return a.length === b.length && a.some((_, turn) =>
        a.every((corner, i) => same(corner, b[(i + turn) % b.length])));
}

// Finds the sides of faces that are seams, where the face on the other side has other texture
// coordinates. Returns {of, sides}: the number of such sides of each face, and a list of all such
// sides as [face, side].
function seamsOf(faces) {
    const met = new Map();
    const of = faces.map(() => 0);
    const sides = [];
    faces.forEach((face, f) => face.forEach((p, i) => {
        const q = face[(i + 1) % face.length];
        const [from, to] = [p, q].map(({ place }) => place.join());
        const other = met.get(`${to} ${from}`);
        if (other !== undefined && !(isNear(other.p.uv, q.uv, 1e-6) && isNear(other.q.uv, p.uv, 1e-6))) {
            of[f]++;
            of[other.f]++;
            sides.push([f, i]);
        }
        met.set(`${from} ${to}`, { f, p, q });
    }));
    return { of, sides };
}

function checkSame(faces, wanted, size, what) {
    assert.equal(faces.length, wanted.length, what);
    const wrong = wanted.flatMap((face, f) => (sameFace(face, faces[f], size) ? [] : [f]));
    assert.deepEqual(wrong, [], what);
}

// --- what is done with a model ---

async function create(url, type, body, query = '') {
    const answer = await fetch(`${url}/v1/meshes${query}`, {
        method: 'POST',
        headers: { 'Content-Type': type },
        body,
    });
    const made = await answer.json();
    assert.equal(answer.status, 201, JSON.stringify(made));
    return made.id;
}

const content = (url, id, format) => fetch(`${url}/v1/meshes/${id}/content?format=${format}`);
const facesIn = async (url, id) => facesOfObj(await (await content(url, id, 'obj')).text());
const glbOf = async (url, id) => (await content(url, id, 'glb')).arrayBuffer();

// Returns the faces of a file, and the file as a GLB that another program might have written: of
// triangles, with separate vertices at seams.
async function begin(url, name, bytes) {
    if (name.endsWith('.glb')) {
        const glb = new Uint8Array(bytes).buffer;
        return { faces: facesOfThree(await meshOf(glb)), glb };
    }
    const id = await create(url, 'model/obj', bytes);
    const mesh = await meshOf(await glbOf(url, id));
    return {
        faces: facesOfObj(bytes.toString()),
        glb: await new GLTFExporter().parseAsync(mesh, { binary: true }),
    };
}

// Creates a mesh from a GLB and welds it: while it is read (isRepaired), or by an edit. Returns the
// id of the mesh.
async function welded(url, glb, isRepaired) {
    if (isRepaired) {
        return create(url, 'model/gltf-binary', glb, '?repair=weld');
    }
    const id = await create(url, 'model/gltf-binary', glb);
    await post({ url }, `/${id}/edits`, { ops: [{ op: 'weld', tolerance: 0 }, { op: 'compact' }] });
    return id;
}

// Splits the edge at a side that is a seam, pokes the face, and moves the ends of the side. Returns
// which faces these edits changed.
async function edit(url, id, faces, [face, side]) {
    const [p, q] = [side, side + 1].map((i) => faces[face][i % 3]);
    const at = [p.vertex, q.vertex];
    const { results: [{ edge }] } = await post({ url }, `/${id}/query`,
        { queries: [{ find: 'edge', vertices: at }] });
    await post({ url }, `/${id}/edits`, { ops: [
        { op: 'edge_split', edge, t: 0.25 },
        { op: 'face_poke', face },
        { op: 'vertex_move', vertices: at, by: [0, 0, 0.125] },
    ] });
    return faces.flatMap((it, f) => (it.some(({ vertex }) => at.includes(vertex)) ? [f] : []));
}

async function check(t, name, bytes) {
    const { url } = await startDaemon(t);
    const source = await begin(url, name, bytes);
    const size = Math.max(...source.faces.flat().map(({ place }) => Math.hypot(...place)));
    const before = seamsOf(source.faces);
    assert.ok(before.sides.length > 0);
    for (const isRepaired of [true, false]) {
        const id = await welded(url, source.glb, isRepaired);
        const faces = await facesIn(url, id);
        checkSame(faces, source.faces, size, 'welded');
        const seams = seamsOf(faces);
        assert.deepEqual(seams.of, before.of);

        const touched = new Set(await edit(url, id, faces, seams.sides[seams.sides.length >> 1]));
        const edited = await facesIn(url, id);
        const others = faces.flatMap((_, f) => (touched.has(f) ? [] : [f]));
        checkSame(others.map((f) => edited[f]), others.map((f) => faces[f]), size, 'not touched');
        // The split has made two sides of one, and both must be seams.
        const after = seamsOf(edited);
        assert.equal(after.sides.length, before.sides.length + 1);
        const about = new Set([...touched].flatMap((f) => faces[f].map(({ vertex }) => vertex)));
        const inner = others.filter((f) => faces[f].every(({ vertex }) => !about.has(vertex)));
        assert.deepEqual(inner.map((f) => after.of[f]), inner.map((f) => before.of[f]));

        const seen = facesOfThree(await meshOf(await glbOf(url, id)));
        checkSame(seen, edited, size, 'as three.js has it');
        assert.equal(seamsOf(seen).sides.length, after.sides.length);
        t.diagnostic(`${name}: ${faces.length} faces, ${before.sides.length} seams, ` +
            `${after.sides.length} after a split on one; ${touched.size} faces touched`);
    }
}

test('seams stay where they were through a weld, edits and an export', async (t) => {
    globalThis.FileReader = FileReader;
    await check(t, 'ring.obj', Buffer.from(ring(12, 8)));
    const folder = process.env.TEXTURED;
    const files = folder === undefined ? [] : readdirSync(folder);
    for (const name of files.filter((file) => /\.(obj|glb)$/.test(file))) {
        await t.test(name, (sub) => check(sub, name, readFileSync(path.join(folder, name))));
    }
});
