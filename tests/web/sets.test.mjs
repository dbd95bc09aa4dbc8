// Tests of the sets of elements that the page computes from the arrays of a mesh: they agree with the
// sets that the server's operation `select` finds, and with what can be counted by hand.

import assert from 'node:assert/strict';
import { test } from 'node:test';

import { emptyMask, inside, polygonMask, stamp } from '../../web/src/geometry/region.js';
import {
    allOf,
    borderOf,
    byAngle,
    connected,
    countOf,
    grown,
    inverted,
    membersOf,
    noneOf,
    shrunk,
    sizeOf,
    verticesOf,
} from '../../web/src/geometry/sets.js';
import { unpack } from '../../web/src/geometry/geometry.js';
import { edgesBetween, topologyOf } from '../../web/src/geometry/topology.js';
import { combined } from '../../web/src/select/changes.js';
import { get, getAll, getGeometry, post, startDaemon } from './daemon.mjs';
import { numbersFrom } from './random.mjs';

const SEED = Number(process.env.SEED ?? 1);

const PLURALS = { vertex: 'vertices', edge: 'edges', face: 'faces' };

async function meshOf(t, document, ...edits) {
    const daemon = await startDaemon(t);
    const { id: mesh } = await post(daemon, '', document);
    for (const edit of edits) {
        await post(daemon, `/${mesh}/edits`, edit);
    }
    return { daemon, mesh, geometry: unpack(await getGeometry(daemon, mesh)) };
}

// Returns the set that the server finds, as an array of ids.
async function askServer({ daemon, mesh }, kind, rule) {
    await post(daemon, `/${mesh}/edits`, { op: 'select', into: 'found', elements: PLURALS[kind], ...rule });
    const { ids, values } = await get(daemon, `/${mesh}/attributes/${PLURALS[kind]}/found?limit=10000`);
    return ids.filter((_, i) => values[i]);
}

function setOf(kind, ids, geometry) {
    const set = noneOf(kind, geometry);
    ids.forEach((id) => {
        set[id] = 1;
    });
    return set;
}

// The numbers of edges in topology.js by the server's ids, and the other way round.
async function edgesOf({ daemon, mesh, geometry }) {
    const edges = await getAll(daemon, mesh, 'edges');
    const numbers = edgesBetween(topologyOf(geometry), edges.flatMap(({ vertices }) => vertices));
    assert.ok(numbers.every((number) => number >= 0));
    const ids = new Map(edges.map(({ id }, i) => [numbers[i], id]));
    return { numbers: new Map(edges.map(({ id }, i) => [id, numbers[i]])), ids };
}

const SHAPES = [
    { shape: 'torus', major_segments: 9, minor_segments: 7 },
    { shape: 'grid', columns: 7, rows: 5 },
    { shape: 'cylinder', segments: 11 },
];

for (const shape of SHAPES) {
    test(`random sets of a ${shape.shape} grow and shrink as the server's do`, async (t) => {
        console.log(`note: SEED=${SEED}`);
        const below = numbersFrom(SEED);
        // Deleted elements leave gaps among the ids.
        const known = await meshOf(t, shape, { op: 'face_delete', faces: [3, 12] });
        const { geometry } = known;
        const { numbers, ids } = await edgesOf(known);
        for (const kind of ['face', 'edge', 'vertex']) {
            const toOwn = (id) => (kind === 'edge' ? numbers.get(id) : id);
            const toServer = (own) => (kind === 'edge' ? ids.get(own) : own);
            const all = (await getAll(known.daemon, known.mesh, PLURALS[kind])).map(({ id }) => id);
            assert.equal(countOf(allOf(kind, geometry)), all.length);
            for (const density of [0.1, 0.5, 0.9]) {
                const seeds = all.filter(() => below(1000) < 1000 * density);
                const set = setOf(kind, seeds.map(toOwn), geometry);
                for (const [by, change] of [['grow', grown], ['shrink', shrunk]]) {
                    const own = [...membersOf(change(kind, set, geometry))].map(toServer);
                    const wanted = await askServer(known, kind, { by, [PLURALS[kind]]: seeds });
                    assert.deepEqual(own.sort((a, b) => a - b), wanted, `${by} ${kind} ${density}`);
                }
            }
        }
    });
}

test('regions up to an angle, components and borders are those of the server', async (t) => {
    const known = await meshOf(t, { shape: 'cylinder', segments: 24 });
    await post(known.daemon, `/${known.mesh}/edits`, { op: 'face_delete', faces: [5] });
    const { id: cube } = await post(known.daemon, '', { shape: 'cube' });
    await post(known.daemon, `/${known.mesh}/edits`, { op: 'append', mesh: cube });
    known.geometry = unpack(await getGeometry(known.daemon, known.mesh));
    const { geometry } = known;
    const faces = (await getAll(known.daemon, known.mesh, 'faces')).map(({ id }) => id);
    const { ids } = await edgesOf(known);
    for (const seed of [faces[0], faces[10], faces.at(-1)]) {
        const set = setOf('face', [seed], geometry);
        for (const degrees of [1, 20, 100]) {
            const angle = (degrees * Math.PI) / 180;
            assert.deepEqual(
                [...membersOf(byAngle(set, angle, geometry))],
                await askServer(known, 'face', { by: 'region', face: seed, angle }),
                `${degrees} degrees from ${seed}`,
            );
        }
        assert.deepEqual(
            [...membersOf(connected('face', set, geometry))],
            await askServer(known, 'face', { by: 'component', face: seed }),
        );
    }
    for (const list of [faces, faces.slice(0, 7)]) {
        const own = [...membersOf(borderOf(setOf('face', list, geometry), geometry))];
        assert.deepEqual(
            own.map((number) => ids.get(number)).sort((a, b) => a - b),
            await askServer(known, 'edge', { by: 'boundary', faces: list }),
        );
    }
});

test('areas and lengths are those of the server', async (t) => {
    const known = await meshOf(t, { shape: 'torus', major_segments: 12, minor_segments: 8 });
    const { geometry, daemon, mesh } = known;
    const isNear = (a, b) => assert.ok(Math.abs(a - b) <= 1e-5 * b, `${a} and ${b}`);
    const { area } = await get(daemon, `/${mesh}`);
    isNear(sizeOf('face', allOf('face', geometry), geometry), area);
    const edges = await getAll(daemon, mesh, 'edges');
    const sum = edges.reduce((all, { length }) => all + length, 0);
    isNear(sizeOf('edge', allOf('edge', geometry), geometry), sum);
    assert.equal(sizeOf('vertex', allOf('vertex', geometry), geometry), 0);
});

test('a disc that grows and shrinks is the disc again', async (t) => {
    const { geometry } = await meshOf(t, { shape: 'grid', columns: 13, rows: 13 });
    let disc = setOf('face', [84], geometry);
    for (const [steps, count] of [[1, 9], [2, 25], [3, 49], [4, 81]]) {
        disc = grown('face', disc, geometry);
        assert.equal(countOf(disc), count, `after ${steps} steps`);
        const back = shrunk('face', grown('face', disc, geometry), geometry);
        assert.deepEqual(membersOf(back), membersOf(disc));
    }
    const rest = inverted('face', disc, geometry);
    assert.equal(countOf(rest), 169 - 81);
    assert.equal(countOf(combined(disc, rest, 'add')), 169);
    assert.equal(countOf(combined(disc, rest, 'remove')), 81);
    assert.equal(countOf(verticesOf('face', disc, geometry)), 100);
});

test('the edges of a vertex with a thousand edges are found once each', async (t) => {
    const { geometry } = await meshOf(t, { shape: 'cone', segments: 1000 });
    const topology = topologyOf(geometry);
    assert.equal(topology.count, countOf(allOf('face', geometry)) + countOf(allOf('vertex', geometry)) - 2);
    const keys = new Set(
        Array.from(topology.from, (from, i) => `${[from, topology.to[i]].sort((a, b) => a - b)}`),
    );
    assert.equal(keys.size, topology.count);
});

// --- parts of the picture ---

const rowsOf = ({ bits, width, height }) =>
    Array.from({ length: height }, (_, y) => bits.subarray(y * width, (y + 1) * width).join(''));

test('the mask of a polygon has the pixels whose middles are inside', () => {
    assert.deepEqual(rowsOf(polygonMask([[1, 1], [4, 1], [4, 3], [1, 3]], 5, 4)), [
        '00000',
        '01110',
        '01110',
        '00000',
    ]);
    // A polygon that turns twice around its middle contains the middle, whichever way it turns.
    const star = Array.from({ length: 5 }, (_, i) => {
        const angle = (4 * Math.PI * i) / 5;
        return [10 + 9 * Math.sin(angle), 10 - 9 * Math.cos(angle)];
    });
    for (const corners of [star, [...star].reverse()]) {
        const mask = polygonMask(corners, 20, 20);
        assert.equal(mask.bits[10 * 20 + 10], 1);
        assert.equal(mask.bits[2 * 20 + 3], 0);
    }
    // What is outside of the picture is cut off.
    assert.equal(countOf(polygonMask([[-50, -50], [50, -50], [50, 50], [-50, 50]], 6, 3).bits), 18);
});

test('a stroke of a brush covers what is within its radius', () => {
    const mask = emptyMask(40, 20);
    stamp(mask, [10, 10], [30, 10], 4);
    for (let y = 0; y < 20; y++) {
        for (let x = 0; x < 40; x++) {
            const [px, py] = [x + 0.5, y + 0.5];
            const away = Math.hypot(px - Math.min(Math.max(px, 10), 30), py - 10);
            assert.equal(mask.bits[y * 40 + x], away <= 4 ? 1 : 0, `${x} ${y}`);
        }
    }
});

test('what is behind a face is inside only if hidden elements count', () => {
    // Two squares of two triangles each, one above the other, seen from above: the lower is hidden.
    const squares = [0, -0.5].flatMap((z) => [[-1, -1], [1, -1], [1, 1], [-1, 1]].map(([x, y]) => [x, y, z, 1]));
    const words = [0, 4].flatMap((first, face) => [
        first, first + 1, first + 2, face | (3 << 29),
        first, first + 2, first + 3, face | (6 << 29),
    ]);
    const geometry = {
        revision: 1,
        layout: 1,
        vertices: Float32Array.from(squares.flat()),
        vertexCount: 8,
        triangles: Uint32Array.from(words),
        triangleCount: 4,
        firstOf: Uint32Array.of(1, 3),
        frame: { origin: [0, 0, 0], scale: 1 },
    };
    // The matrix puts a camera at z = 3, and a picture of 8 x 8 pixels shows x and y from -3 to 3 there.
    const matrix = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, -1, 0, 0, 0, 3];
    const mask = polygonMask([[0, 0], [8, 0], [8, 8], [0, 8]], 8, 8);
    const shown = new Int32Array(64).fill(-1);
    for (let y = 3; y < 5; y++) {
        for (let x = 3; x < 5; x++) {
            shown[8 * y + x] = x + y >= 7 ? 0 : 1;
        }
    }
    const look = (kind, visible) => [...membersOf(inside(kind, geometry, { matrix, mask, shown: visible }))];
    assert.deepEqual(look('face', null), [0, 1]);
    assert.deepEqual(look('face', shown), [0]);
    assert.deepEqual(look('vertex', null), [0, 1, 2, 3, 4, 5, 6, 7]);
    assert.equal(look('edge', null).length, 8);
});
