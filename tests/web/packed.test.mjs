// Tests the glTF extension EXT_meshopt_compression between the server and other programs: three.js
// must read what the server writes, and the server must read what the encoder of meshoptimizer
// writes, with the same result as three.js.
import assert from 'node:assert/strict';
import { test } from 'node:test';

import { MeshoptEncoder } from '../../web/node_modules/meshoptimizer/index.js';
import {
    MeshoptDecoder,
} from '../../web/node_modules/three/examples/jsm/libs/meshopt_decoder.module.js';
import { GLTFLoader } from '../../web/node_modules/three/examples/jsm/loaders/GLTFLoader.js';
import { startDaemon } from './daemon.mjs';

const EXTENSION = 'EXT_meshopt_compression';

async function meshOf(glb) {
    const loader = new GLTFLoader().setMeshoptDecoder(MeshoptDecoder);
    const { scene } = await loader.parseAsync(glb, '');
    const meshes = [];
    scene.updateMatrixWorld();
    scene.traverse((object) => object.isMesh && meshes.push(object));
    assert.equal(meshes.length, 1);
    return meshes[0];
}

async function create(url, type, body) {
    const answer = await fetch(`${url}/v1/meshes`, {
        method: 'POST', headers: { 'Content-Type': type }, body,
    });
    const made = await answer.json();
    assert.equal(answer.status, 201, JSON.stringify(made));
    return made;
}

async function exported(url, id, query) {
    const answer = await fetch(`${url}/v1/meshes/${id}/content?${query}`);
    assert.equal(answer.status, 200);
    return answer.arrayBuffer();
}

function jsonOf(glb) {
    const length = new DataView(glb).getUint32(12, true);
    return JSON.parse(new TextDecoder().decode(new Uint8Array(glb, 20, length)));
}

// Returns a text for each triangle, which lists its corners from the one with the lowest index on.
// So the texts are equal even if compression rotated the corners of a triangle.
function trianglesOf(index) {
    const list = [];
    for (let i = 0; i < index.length; i += 3) {
        const corners = [...index.slice(i, i + 3)];
        const lowest = corners.indexOf(Math.min(...corners));
        list.push([...corners.slice(lowest), ...corners.slice(0, lowest)].join(' '));
    }
    return list;
}

// Two quadrilaterals and a triangle with a texture seam between them.
const OBJ = `
v 0 0 0
v 1 0 0.125
v 1 1 0
v 0 1 0
v 2 0 0.25
v 2 1 0
v 1.5 2 0.75
vt 0 0
vt 1 0
vt 1 1
vt 0 1
vt 0.3 0.7
vn 0 0 1
vn 0 1 0
f 1/1/1 2/2/1 3/3/1 4/4/1
f 2/5/2 5/2/2 6/3/2 3/5/2
f 3/1/1 6/2/1 7/3/1
`;

test('three.js reads what is packed here', async (t) => {
    const { url } = await startDaemon(t);
    const { id } = await create(url, 'model/obj', OBJ);
    const plain = await exported(url, id, 'format=glb');
    const packed = await exported(url, id, 'format=glb&compress=meshopt');
    const json = jsonOf(packed);
    assert.deepEqual(json.extensionsRequired, [EXTENSION]);
    assert.ok(json.bufferViews.every((view) => view.extensions[EXTENSION].buffer === 0));
    const [seen, wanted] = [await meshOf(packed), await meshOf(plain)];
    const names = Object.keys(wanted.geometry.attributes);
    assert.deepEqual(names.sort(), ['normal', 'position', 'uv']);
    for (const name of names) {
        assert.deepEqual(Array.from(seen.geometry.attributes[name].array),
            Array.from(wanted.geometry.attributes[name].array), name);
    }
    assert.deepEqual(trianglesOf(seen.geometry.index.array),
        trianglesOf(wanted.geometry.index.array));
    // If the server reads its own file, the mesh must be as it was, with its polygons and with the
    // values of corners.
    const back = await create(url, 'model/gltf-binary', packed);
    const text = async (mesh) => new TextDecoder().decode(await exported(url, mesh, 'format=obj'));
    assert.equal(await text(back.id), await text(id));
});

// Builds a GLB from compressed streams: `views` are { bytes, count, stride, mode, filter, target }.
function pack(views, rest) {
    const streams = views.map(({ bytes, count, stride, mode }) =>
        MeshoptEncoder.encodeGltfBuffer(bytes, count, stride, mode));
    let at = 0;
    let plain = 0;
    const bufferViews = views.map(({ count, stride, mode, filter, target }, i) => {
        const view = {
            buffer: 1,
            byteOffset: plain,
            byteLength: count * stride,
            ...(mode === 'ATTRIBUTES' && { byteStride: stride }),
            ...(target && { target }),
            extensions: {
                [EXTENSION]: {
                    buffer: 0, byteOffset: at, byteLength: streams[i].length,
                    byteStride: stride, count, mode, ...(filter && { filter }),
                },
            },
        };
        at += Math.ceil(streams[i].length / 4) * 4;
        plain += Math.ceil((count * stride) / 4) * 4;
        return view;
    });
    const json = {
        asset: { version: '2.0' },
        extensionsUsed: [EXTENSION, 'KHR_mesh_quantization'],
        extensionsRequired: [EXTENSION, 'KHR_mesh_quantization'],
        buffers: [
            { byteLength: at },
            { byteLength: plain, extensions: { [EXTENSION]: { fallback: true } } },
        ],
        bufferViews,
        ...rest,
    };
    const text = new TextEncoder().encode(JSON.stringify(json));
    const length = Math.ceil(text.length / 4) * 4;
    const glb = new Uint8Array(28 + length + at);
    const head = new DataView(glb.buffer);
    [0x46546c67, 2, glb.length, length, 0x4e4f534a].forEach((word, i) => {
        head.setUint32(4 * i, word, true);
    });
    glb.fill(0x20, 20, 20 + length).set(text, 20);
    head.setUint32(20 + length, at, true);
    head.setUint32(24 + length, 0x004e4942, true);
    bufferViews.forEach((view, i) => {
        glb.set(streams[i], 28 + length + view.extensions[EXTENSION].byteOffset);
    });
    return glb.buffer;
}

const SIDE = 12;
const COUNT = SIDE * SIDE;
const cells = Array.from({ length: COUNT }, (_, i) => [i % SIDE, Math.floor(i / SIDE)]);
const TRIANGLES = new Uint32Array(cells.filter(([x, y]) => x < SIDE - 1 && y < SIDE - 1)
    .flatMap(([x, y]) => {
        const v = y * SIDE + x;
        return [v, v + 1, v + SIDE + 1, v, v + SIDE + 1, v + SIDE];
    }));

const bytesOf = ({ buffer, byteOffset, byteLength }) =>
    new Uint8Array(buffer, byteOffset, byteLength);

// Builds a file with 16-bit positions, directions on an octahedron, floats with a common exponent,
// and indices in both modes.
function quantized(mode) {
    const positions = new Int16Array(cells.flatMap(([x, y]) =>
        [3000 * x - 16000, 2500 * y - 16000, Math.round(9000 * Math.sin(x + y)), 0]));
    const normals = new Float32Array(cells.flatMap(([x, y]) => {
        const [a, b] = [Math.sin(x) / 2, Math.cos(y) / 2];
        return [a, b, Math.sqrt(1 - a * a - b * b), 0];
    }));
    const uvs = new Float32Array(cells.flatMap(([x, y]) => [x / SIDE, y / SIDE / SIDE]));
    const colors = new Uint8Array(cells.flatMap(([x, y]) => [20 * x, 20 * y, 255, 255]));
    const short = Uint16Array.from(TRIANGLES);
    return pack([
        { bytes: bytesOf(positions), count: COUNT, stride: 8, mode: 'ATTRIBUTES' },
        {
            bytes: MeshoptEncoder.encodeFilterOct(normals, COUNT, 4, 8),
            count: COUNT, stride: 4, mode: 'ATTRIBUTES', filter: 'OCTAHEDRAL',
        },
        {
            bytes: MeshoptEncoder.encodeFilterExp(uvs, COUNT, 8, 15),
            count: COUNT, stride: 8, mode: 'ATTRIBUTES', filter: 'EXPONENTIAL',
        },
        { bytes: colors, count: COUNT, stride: 4, mode: 'ATTRIBUTES', filter: 'NONE' },
        { bytes: bytesOf(short), count: short.length, stride: 2, mode },
    ], {
        accessors: [
            {
                bufferView: 0, componentType: 5122, normalized: true, count: COUNT, type: 'VEC3',
                min: [-1, -1, -1], max: [1, 1, 1],
            },
            { bufferView: 1, componentType: 5120, normalized: true, count: COUNT, type: 'VEC3' },
            { bufferView: 2, componentType: 5126, count: COUNT, type: 'VEC2' },
            { bufferView: 3, componentType: 5121, normalized: true, count: COUNT, type: 'VEC4' },
            { bufferView: 4, componentType: 5123, count: short.length, type: 'SCALAR' },
        ],
        meshes: [{
            primitives: [{
                attributes: { POSITION: 0, NORMAL: 1, TEXCOORD_0: 2, COLOR_0: 3 }, indices: 4,
            }],
        }],
        nodes: [{ mesh: 0, scale: [10, 10, 2], translation: [1, 2, 3] }],
        scenes: [{ nodes: [0] }],
        scene: 0,
    });
}

const close = (a, b, most, what) => {
    assert.equal(a.length, b.length);
    a.forEach((value, i) => {
        assert.ok(Math.abs(value - b[i]) <= most, `${what} ${i}: ${value}, ${b[i]}`);
    });
};

for (const mode of ['TRIANGLES', 'INDICES']) {
    test(`what meshoptimizer packs as ${mode} is read as three.js reads it`, async (t) => {
        await Promise.all([MeshoptEncoder.ready, MeshoptDecoder.ready]);
        const { url } = await startDaemon(t);
        const glb = quantized(mode);
        const made = await create(url, 'model/gltf-binary', glb);
        assert.deepEqual(made.import.warnings, []);
        assert.deepEqual([made.counts.vertices, made.counts.faces], [COUNT, TRIANGLES.length / 3]);
        const document =
            JSON.parse(new TextDecoder().decode(await exported(url, made.id, 'format=json')));
        const three = await meshOf(glb);
        const { position, normal, uv, color } = three.geometry.attributes;
        const values = (name) => document.attributes
            .find((row) => row.name === name && row.domain === 'vertices').values;
        const all = Array.from({ length: COUNT }, (_, i) => i);
        assert.equal(position.count, COUNT);
        const placed = all.flatMap((i) => [
            1 + 10 * position.getX(i), 2 + 10 * position.getY(i), 3 + 2 * position.getZ(i),
        ]);
        close(document.vertices.flat(), placed, 1e-6, 'position');
        close(values('uv').flat(), all.flatMap((i) => [uv.getX(i), 1 - uv.getY(i)]), 1e-6, 'uv');
        close(values('color').flat(),
            all.flatMap((i) => [color.getX(i), color.getY(i), color.getZ(i), color.getW(i)]),
            1e-6, 'color');
        // Normals must be transformed by the node's matrix, which scales each axis differently.
        const turned = all.flatMap((i) => {
            const v = [normal.getX(i) / 10, normal.getY(i) / 10, normal.getZ(i) / 2];
            const length = Math.hypot(...v);
            return v.map((n) => n / length);
        });
        close(values('normal').flat(), turned, 1e-6, 'normal');
        assert.deepEqual(trianglesOf(document.faces.flat()),
            trianglesOf(three.geometry.index.array));
        assert.deepEqual([...trianglesOf(document.faces.flat())].sort(),
            [...trianglesOf(TRIANGLES)].sort());
    });
}
