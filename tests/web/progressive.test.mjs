// Tests of levels of detail: the bytes of GET .../progressive that the daemon sends, and the arrays
// that the page makes of them.

import assert from 'node:assert/strict';
import { test } from 'node:test';

import { faceOf, unpack } from '../../web/src/geometry/geometry.js';
import { Levels } from '../../web/src/geometry/levels.js';
import { Pace } from '../../web/src/geometry/pace.js';
import { ProgressiveReader } from '../../web/src/geometry/progressive.js';
import { get, getAll, getGeometry, post, startDaemon } from './daemon.mjs';
import { numbersFrom } from './random.mjs';

const SEED = Number(process.env.SEED ?? Date.now() % 2 ** 32);
console.log(`note: SEED=${SEED}`);

const MESHES = [
    { shape: 'icosphere', subdivisions: 3 },
    { shape: 'torus', major_segments: 24, minor_segments: 12 },
    { shape: 'grid', columns: 12, rows: 9 },
    // The mesh has a bow-tie (two triangles that share a vertex), a separate triangle, and an
    // isolated vertex.
    {
        vertices: [
            [0, 0, 0], [1, 0, 0], [1, 1, 0], [-1, 0, 0], [-1, -1, 0], [2, 1, 0], [9, 9, 9],
            [5, 0, 0], [6, 0, 0], [5, 1, 0],
        ],
        faces: [[0, 1, 2], [0, 3, 4], [1, 5, 2], [7, 8, 9]],
    },
];

async function makeMesh(daemon, content, ops = []) {
    const { id } = await post(daemon, '', content);
    await post(daemon, `/${id}/edits`, { ops: [{ op: 'triangulate' }] });
    if (ops.length > 0) {
        await post(daemon, `/${id}/edits`, { ops });
    }
    return id;
}

async function getStream(daemon, mesh) {
    const answer = await fetch(`${daemon.url}/v1/meshes/${mesh}/progressive`);
    assert.equal(answer.status, 200);
    return new Uint8Array(await answer.arrayBuffer());
}

// Reads the bytes of an answer in parts, whose lengths nextLength() returns. Returns the levels,
// and the ids of their vertices.
function read(stream, frame, nextLength) {
    let levels;
    const ids = [];
    const reader = new ProgressiveReader((header) => {
        levels = new Levels(header, frame);
        return {
            addVertex(id, place) {
                ids.push(id);
                levels.addVertex(id, place);
            },
            addFace: (...face) => levels.addFace(...face),
            addSplit(split) {
                ids.push(split.vertex);
                levels.addSplit(split);
            },
        };
    });
    for (let at = 0; at < stream.length;) {
        const length = nextLength();
        reader.push(stream.subarray(at, at + length));
        at += length;
    }
    reader.end();
    return { levels, ids };
}

const WHOLE = { origin: [0, 0, 0], scale: 1 };

const readWhole = (stream, frame = WHOLE) => read(stream, frame, () => stream.length);

// Returns the three corners of each triangle that is drawn.
function cornersOf({ triangles, triangleCount }) {
    return Array.from({ length: triangleCount }, (_, i) => [
        ...triangles.subarray(4 * i, 4 * i + 3),
    ]);
}

// Returns the half-edges of some triangles as texts of origin and target. Two triangles must not
// have the same half-edge, because otherwise they are no surface.
function halfedgesOf(triangles) {
    const found = new Set();
    for (const [a, b, c] of triangles) {
        for (const halfedge of [`${a}>${b}`, `${b}>${c}`, `${c}>${a}`]) {
            assert.ok(!found.has(halfedge), `${halfedge} twice`);
            found.add(halfedge);
        }
    }
    return found;
}

const edgeOf = (halfedge) => halfedge.split('>').map(Number).sort((a, b) => a - b).join();

const edgesOf = (triangles) => new Set([...halfedgesOf(triangles)].map(edgeOf));

// Checks that the triangles around each vertex form one fan, in which neighbours share an edge.
function checkFans(triangles) {
    const next = new Map();
    for (const corners of triangles) {
        corners.forEach((v, i) => {
            next.set(v, next.get(v) ?? new Map());
            next.get(v).set(corners[(i + 1) % 3], corners[(i + 2) % 3]);
        });
    }
    for (const [vertex, around] of next) {
        const [first] = around.keys();
        let steps = 0;
        let at = first;
        do {
            at = around.get(at);
            steps++;
        } while (at !== first && at !== undefined && steps < around.size);
        assert.ok(at === first && steps === around.size, `fans of ${vertex}`);
    }
}

test('all splits lead back to the mesh with its ids and places', async (t) => {
    const below = numbersFrom(SEED);
    const daemon = await startDaemon(t);
    const worn = [
        { op: 'vertex_delete', vertex: 40 },
        { op: 'edge_flip', edge: 200 },
        { op: 'edge_split', edge: 90 },
        { op: 'decimate', ratio: 0.8 },
    ];
    const meshes = await Promise.all([
        ...MESHES.map((content) => makeMesh(daemon, content)),
        makeMesh(daemon, { shape: 'grid', columns: 12, rows: 12 }, worn),
    ]);
    for (const mesh of meshes) {
        const geometry = unpack(await getGeometry(daemon, mesh));
        const stream = await getStream(daemon, mesh);
        const nextLength = () => 1 + below(300);
        const { levels, ids } = read(stream, geometry.frame, nextLength);
        levels.goTo(levels.most);
        const shown = levels.geometry;
        const { counts } = await get(daemon, `/${mesh}`);
        assert.equal(shown.vertexCount, counts.vertices);
        assert.equal(shown.triangleCount, counts.faces);
        assert.equal(levels.faces, counts.faces);
        assert.equal(shown.hasIsolated, counts.isolated_vertices > 0);
        // Vertices must be drawn where the mesh has them, bit for bit.
        for (let i = 0; i < shown.vertexCount; i++) {
            const place = shown.vertices.subarray(4 * i, 4 * i + 4);
            assert.deepEqual(place, geometry.vertices.subarray(4 * ids[i], 4 * ids[i] + 4));
        }
        const triangles = cornersOf(shown).map((corners) => corners.map((i) => ids[i]));
        for (const { id, vertices } of await getAll(daemon, mesh, 'faces')) {
            const i = triangles.findIndex((_, k) => faceOf(shown.triangles, k) === id);
            const turn = triangles[i].indexOf(vertices[0]);
            const turned = [0, 1, 2].map((k) => triangles[i][(turn + k) % 3]);
            assert.deepEqual(turned, vertices, `face ${id}`);
        }
        const edges = (await getAll(daemon, mesh, 'edges')).map((edge) =>
            [...edge.vertices].sort((a, b) => a - b).join(),
        );
        assert.deepEqual([...edgesOf(triangles)].sort(), edges.sort());
    }
});

test('any level of a closed mesh is a closed manifold', async (t) => {
    const daemon = await startDaemon(t);
    for (const [content, euler] of [[MESHES[0], 2], [MESHES[1], 0]]) {
        const mesh = await makeMesh(daemon, content);
        const { levels } = readWhole(await getStream(daemon, mesh));
        const step = Math.ceil(levels.most / 40);
        for (let level = 0; level <= levels.most; level += step) {
            levels.goTo(level);
            const { vertices, vertexCount } = levels.geometry;
            const triangles = cornersOf(levels.geometry);
            const halfedges = halfedgesOf(triangles);
            const edges = new Set([...halfedges].map(edgeOf));
            assert.equal(2 * edges.size, halfedges.size, 'each half-edge has a twin');
            assert.equal(vertexCount - edges.size + triangles.length, euler, `level ${level}`);
            const used = new Set(triangles.flat());
            assert.equal(used.size, vertexCount);
            assert.ok([...used].every((i) => i < vertexCount && vertices[4 * i + 3] === 1));
            checkFans(triangles);
        }
        assert.ok(levels.most > 100);
    }
});

test('a level is the same from either side, and its changes are told', async (t) => {
    const below = numbersFrom(SEED);
    const daemon = await startDaemon(t);
    const mesh = await makeMesh(daemon, { shape: 'icosphere', subdivisions: 4 });
    const stream = await getStream(daemon, mesh);
    const { levels } = readWhole(stream);
    const { geometry } = levels;
    const sent = {
        vertices: new Float32Array(geometry.vertices.length).fill(NaN),
        triangles: new Uint32Array(geometry.triangles.length).fill(-1),
    };
    const seen = new Map();
    const wanted = Array.from({ length: 40 }, () => below(levels.most + 1));
    for (const level of [0, ...wanted, levels.most, ...wanted.reverse(), 0]) {
        levels.goTo(level);
        assert.equal(levels.level, level);
        const changes = levels.takeChanges();
        for (const [name, ranges] of Object.entries(changes)) {
            for (const [begin, end] of ranges) {
                sent[name].set(geometry[name].subarray(4 * begin, 4 * end), 4 * begin);
            }
        }
        const shown = [
            geometry.vertices.slice(0, 4 * geometry.vertexCount),
            geometry.triangles.slice(0, 4 * geometry.triangleCount),
        ];
        assert.deepEqual(sent.vertices.slice(0, shown[0].length), shown[0]);
        assert.deepEqual(sent.triangles.slice(0, shown[1].length), shown[1]);
        assert.deepEqual(shown, seen.get(level) ?? shown);
        seen.set(level, shown);
    }
    levels.goTo(levels.most);
    levels.takeChanges();
    levels.goTo(levels.most - 1);
    const { vertices, triangles } = levels.takeChanges();
    assert.ok(vertices.length === 1 && triangles.length < 8, 'little changes, little is sent');
});

test('levels can be shown while more come', async (t) => {
    const daemon = await startDaemon(t);
    const mesh = await makeMesh(daemon, MESHES[0]);
    const stream = await getStream(daemon, mesh);
    let levels;
    const reader = new ProgressiveReader((header) => (levels = new Levels(header, WHOLE)));
    for (let at = 0; at < stream.length; at += 1000) {
        reader.push(stream.subarray(at, at + 1000));
        if (levels.hasBase) {
            assert.equal(levels.part, levels.count / levels.most);
            levels.goTo(levels.most);
            assert.equal(levels.level, levels.count);
            halfedgesOf(cornersOf(levels.geometry));
            levels.goTo(Math.floor(levels.count / 2));
        }
    }
    reader.end();
    levels.goTo(levels.most);
    const all = readWhole(stream).levels;
    all.goTo(all.most);
    assert.deepEqual(levels.geometry, all.geometry);
    assert.equal(levels.part, 1);
    // A mesh that cannot be simplified, such as a tetrahedron, must have one level only.
    const least = await makeMesh(daemon, { shape: 'tetrahedron' });
    const { levels: only } = readWhole(await getStream(daemon, least));
    assert.ok(only.hasBase && only.most === 0 && only.part === 1);
});

test('what is no stream of levels is refused', async (t) => {
    const daemon = await startDaemon(t);
    const stream = await getStream(daemon, await makeMesh(daemon, MESHES[0]));
    const readIt = (bytes) => () => readWhole(bytes);
    const changed = (at, value) => {
        const bytes = stream.slice();
        new DataView(bytes.buffer).setUint32(at, value, true);
        return readIt(bytes);
    };
    readIt(stream)();
    const size = [16, 20, 24].map((at) => new DataView(stream.buffer).getUint32(at, true));
    const splits = 104 + 32 * size[0] + 16 * (size[1] + size[2]);
    for (const length of [0, 8, 100, 104, 150, splits, splits + 50, stream.length - 1]) {
        assert.throws(readIt(stream.slice(0, length)), /did not arrive completely/, `${length} bytes`);
    }
    assert.throws(readIt(Uint8Array.of(...stream, 0)), /longer/);
    for (const [at, value] of [
        [0, 1], // not the bytes "HEDP"
        [4, 2], // another version
        [104, 0xfffffff0], // no such vertex
        [splits, 8], // a wrong length of a split
        [splits + 4, 0xfffffff0], // an invalid id of its new vertex
        [splits + 8, 0xfffffff0], // an invalid id of the vertex that it splits
        [splits + 12, 0xfffffff0], // an invalid corner
        [splits + 32, 0xfffffff0], // an invalid face
        [splits + 96, 0xfffffff0], // an invalid face in the list of faces that get the new vertex
    ]) {
        assert.throws(changed(at, value), /cannot read/, `byte ${at}`);
    }
    assert.throws(changed(28, 0xffffffff), RangeError);
});

test('each position of the slider has a level of its own, and all are between the ends', () => {
    for (const [faces, levels] of [[4, 0], [0, 3], [4, 1], [12, 640], [4, 5000], [4, 655358]]) {
        const pace = new Pace(faces, levels);
        assert.equal(pace.levelAt(0), 0);
        assert.equal(pace.levelAt(pace.positions), levels);
        for (let position = 1; position <= pace.positions; position++) {
            const level = pace.levelAt(position);
            assert.ok(level > pace.levelAt(position - 1), `${position} of ${levels}`);
            assert.equal(pace.positionOf(level), position);
        }
        assert.ok(pace.seconds > 1 && pace.seconds < 8);
    }
});
