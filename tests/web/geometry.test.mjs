// Tests of the page's modules for arrays, arrows, measures, links and picking, without a browser
// and without a server.

import assert from 'node:assert/strict';
import { test } from 'node:test';

import { angleBetween } from '../../web/src/geometry/vectors.js';
import { describe, foldAngle } from '../../web/src/open/around.js';
import { arrowOf, middleOf, pointsOf } from '../../web/src/geometry/arrows.js';
import {
    HEADER_BYTES,
    ROW,
    VERTEX_ISOLATED,
    VERTEX_USED,
    ballOf,
    edgesOfTriangles,
    faceOf,
    findFaces,
    hasVertex,
    isEdge,
    headerOf,
    normalOfFace,
    pointAt,
    trianglesOfFace,
    unpack,
} from '../../web/src/geometry/geometry.js';
import { changedFaces, meanOf, placementOf, shapeOfFaces } from '../../web/src/geometry/changed.js';
import { formatLink, parseLink } from '../../web/src/open/link.js';
import { Others } from '../../web/src/open/others.js';
import { Share } from '../../web/src/open/share.js';
import { choose, readSquare } from '../../web/src/geometry/pick.js';
import {
    distanceToPoint,
    distanceToSegment,
    fitDistance,
    middleOf as middleOfPoints,
    reachFrom,
    turnTo,
} from '../../web/src/geometry/view.js';

// Builds an answer of GET .../geometry as the server sends it: points are [x, y, z, state],
// triangles [a, b, c, face, sides].
function answer(points, triangles, { revision = 1n, frame = [0, 0, 0, 1] } = {}) {
    const buffer = new ArrayBuffer(HEADER_BYTES + 16 * (points.length + triangles.length));
    const view = new DataView(buffer);
    [...'HEDG'].forEach((letter, i) => view.setUint8(i, letter.charCodeAt(0)));
    view.setUint32(4, 2, true);
    view.setBigUint64(8, revision, true);
    view.setBigUint64(24, BigInt(16 * points.length), true);
    view.setBigUint64(32, BigInt(16 * triangles.length), true);
    view.setUint32(40, points.length, true);
    view.setUint32(44, triangles.length, true);
    frame.forEach((value, i) => view.setFloat64(48 + 8 * i, value, true));
    view.setBigUint64(80, 2n ** 50n, true);
    new Float32Array(buffer, HEADER_BYTES, 4 * points.length).set(points.flat());
    const words = triangles.flatMap(([a, b, c, face, sides]) => [a, b, c, face | (sides << 29)]);
    new Uint32Array(buffer, HEADER_BYTES + 16 * points.length).set(words);
    return buffer;
}

// A square beside a triangle, with a deleted vertex, a deleted face and an isolated vertex:
//
//     3---2
//     |   |\            5 alone
//     0---1-4
const POINTS = [
    [0, 0, 0, 1], [0.5, 0, 0, 1], [0.5, 0.5, 0, 1], [0, 0.5, 0, 1], [0.75, 0, 0, 1],
    [0.9, 0.4, 0, 2], [0, 0, 0, 0],
];
const TRIANGLES = [[0, 1, 2, 1, 3], [0, 2, 3, 1, 6], [1, 4, 2, 7, 7]];

test('an answer is unpacked into whole rows of textures', () => {
    const buffer = answer(POINTS, TRIANGLES, { revision: 2n ** 40n, frame: [1e300, -2, 3, 0.25] });
    assert.equal(headerOf(buffer).length, buffer.byteLength);
    const geometry = unpack(buffer);
    const { revision, layout, frame, vertices, triangles, hasIsolated } = geometry;
    const { center, radius } = ballOf(geometry);
    assert.deepEqual([revision, layout], [2 ** 40, 2 ** 50]);
    assert.deepEqual(frame, { origin: [1e300, -2, 3], scale: 0.25 });
    assert.deepEqual([geometry.vertexCount, geometry.triangleCount], [7, 3]);
    for (const array of [vertices, triangles]) {
        assert.equal(array.length, 4 * ROW);
        assert.ok(array.subarray(28).every((value) => value === 0));
    }
    assert.ok(hasIsolated);
    // The deleted vertex at the origin must not belong to the bounding box.
    assert.ok(Math.abs(center[0] - 0.45) < 1e-6 && Math.abs(center[1] - 0.25) < 1e-6);
    assert.ok(Math.abs(radius - Math.hypot(0.45, 0.25)) < 1e-6);
});

test('what is no whole answer is refused', () => {
    const buffer = answer(POINTS, TRIANGLES);
    assert.throws(() => unpack(buffer.slice(0, -16)), RangeError);
    const other = buffer.slice(0);
    new DataView(other).setUint32(4, 3, true);
    assert.throws(() => unpack(other), RangeError);
    new Uint8Array(other)[0] = 0;
    assert.throws(() => headerOf(other), RangeError);
});

test('a mesh without live vertices still has a ball for the camera', () => {
    for (const points of [[], [[0, 0, 0, 0]]]) {
        const geometry = unpack(answer(points, []));
        const { center, radius } = ballOf(geometry);
        assert.deepEqual(center, [0, 0, 0]);
        assert.equal(radius, 1);
        assert.ok(!geometry.hasIsolated);
    }
    const { center, radius } = ballOf(unpack(answer([[0.5, 0, 0, 2]], [])));
    assert.deepEqual([center, radius], [[0.5, 0, 0], 1]);
});

test('faces are found wherever their triangles lie, and again after some were written', () => {
    const rows = [[1, 4, 2, 7, 7], [0, 0, 0, 0, 0], [0, 1, 2, 1, 3], [0, 2, 3, 1, 6]];
    const geometry = unpack(answer(POINTS, rows));
    const found = () => [0, 1, 7, 90].map((face) => trianglesOfFace(geometry, face));
    assert.deepEqual(found(), [[], [2, 3], [0], []]);
    const write = (...changes) => {
        for (const [at, a, b, c, face] of changes) {
            geometry.triangles.set([a, b, c, face], 4 * at);
        }
        findFaces(geometry, changes.map(([at]) => at));
    };
    write([1, 0, 0, 0, 0], [2, 0, 0, 0, 0]);
    assert.deepEqual(found(), [[], [3], [0], []]);
    write([0, 0, 0, 0, 0], [1, 0, 1, 2, 90], [2, 0, 2, 3, 90], [3, 0, 3, 4, 90]);
    assert.deepEqual(found(), [[], [], [], [1, 2, 3]]);
    write([0, 0, 1, 2, 0]);
    assert.deepEqual(found(), [[0], [], [], [1, 2, 3]]);
    write([1, 0, 1, 2, 7]);
    assert.deepEqual(found(), [[0], [], [1], [2, 3]]);
});

test('faces and vertices are found by their ids', () => {
    const geometry = unpack(answer(POINTS, TRIANGLES));
    const { triangles } = geometry;
    assert.deepEqual([0, 1, 2].map((i) => faceOf(triangles, i)), [1, 1, 7]);
    const found = [0, 1, 2, 6, 7, 8].map((face) => trianglesOfFace(geometry, face));
    assert.deepEqual(found, [[], [0, 1], [], [], [2], []]);
    assert.deepEqual([0, 5, 6, 7].map((id) => hasVertex(geometry, id)), [true, true, false, false]);
    assert.deepEqual(pointAt(geometry, 4), [0.75, 0, 0]);
    assert.equal(geometry.vertices[4 * 5 + 3], VERTEX_ISOLATED);
    assert.equal(geometry.vertices[3], VERTEX_USED);
});

test('sides that are edges run as their face does', () => {
    const { triangles } = unpack(answer(POINTS, TRIANGLES));
    assert.deepEqual(edgesOfTriangles(triangles, [0, 1]), [[0, 1], [1, 2], [2, 3], [3, 0]]);
    assert.deepEqual(edgesOfTriangles(triangles, [2]), [[1, 4], [4, 2], [2, 1]]);
    assert.ok(!isEdge(triangles, 0, 2) && isEdge(triangles, 2, 2));
});

test('the largest face id keeps its sides', () => {
    const face = 2 ** 29 - 1;
    const { triangles } = unpack(answer(POINTS, [[0, 1, 2, face, 4]]));
    assert.equal(faceOf(triangles, 0), face);
    assert.deepEqual([0, 1, 2].map((i) => isEdge(triangles, 0, i)), [false, false, true]);
});

// --- arrows ---

test('an arrow lies beside its edge, on the side of its face, and points to the target', () => {
    const geometry = unpack(answer(POINTS, TRIANGLES));
    assert.deepEqual(normalOfFace(geometry, 1), [0, 0, 0.5]);
    const cases = [
        [{ origin: 0, target: 1, face: 1, across: null }, [0, 1]],
        [{ origin: 1, target: 0, face: null, across: 1 }, [0, -1]],
        [{ origin: 2, target: 1, face: 7, across: 1 }, [1, 0]],
        [{ origin: 1, target: 2, face: 1, across: 7 }, [-1, 0]],
    ];
    for (const [halfedge, side] of cases) {
        const arrow = arrowOf(geometry, halfedge);
        const points = pointsOf(arrow, 1);
        assert.equal(points.length, 9);
        const from = pointAt(geometry, halfedge.origin);
        const to = pointAt(geometry, halfedge.target);
        const middle = [0, 1].map((i) => (from[i] + to[i]) / 2);
        for (const point of points) {
            const out = (point[0] - middle[0]) * side[0] + (point[1] - middle[1]) * side[1];
            assert.ok(out > 0, `${point} of ${JSON.stringify(halfedge)}`);
            assert.equal(point[2], 0);
        }
        // The tip of the arrow must be nearer to the target than its other points.
        const away = points.map((p) => Math.hypot(p[0] - to[0], p[1] - to[1]));
        assert.equal(away.indexOf(Math.min(...away)), 7);
        // An arrow of half the thickness must have the same length, and be nearer to the edge.
        const distance = (point) =>
            Math.abs((point[0] - middle[0]) * side[0] + (point[1] - middle[1]) * side[1]);
        const [thick, thin] = [1, 0.5].map((scale) => middleOf(arrow, scale));
        assert.ok(Math.abs(distance(thin) - distance(thick) / 2) < 1e-9);
        const lengths = [1, 0.5].map((scale) => {
            const [start, , , , , , , tip] = pointsOf(arrow, scale);
            return Math.abs((tip[0] - start[0]) * side[1] - (tip[1] - start[1]) * side[0]);
        });
        assert.ok(Math.abs(lengths[0] - lengths[1]) < 1e-9, `${lengths}`);
    }
});

test('where there is no plane there is no arrow', () => {
    const flat = unpack(answer([[0, 0, 0, 1], [1, 0, 0, 1], [2, 0, 0, 1]], [[0, 1, 2, 0, 7]]));
    assert.equal(arrowOf(flat, { origin: 0, target: 1, face: 0, across: null }), null);
});

// --- measures ---

test('angles are right at every size', () => {
    const near = (got, wanted) => assert.ok(Math.abs(got - wanted) < 1e-9, `${got}, not ${wanted}`);
    near(angleBetween([1, 0, 0], [0, 1, 0]), Math.PI / 2);
    near(angleBetween([1e300, 0, 0], [1e-300, 1e-300, 0]), Math.PI / 4);
    near(angleBetween([5e-324, 0, 0], [-2, 0, 0]), Math.PI);
    assert.equal(angleBetween([0, 0, 0], [1, 0, 0]), null);
    assert.equal(foldAngle([0, 0, 1], [0, 0, 0], [1, 0, 0]), null);
    // This is an edge of a cube between a face that looks to -x and one that looks to -y.
    near(foldAngle([0, -1, 0], [-1, 0, 0], [0, 0, -1]), Math.PI / 2);
    near(foldAngle([0, -1, 0], [-1, 0, 0], [0, 0, 1]), -Math.PI / 2);
});

test('an element that went away meanwhile is left out of what is around', async () => {
    const ask = async (queries) => queries.map(() => ({ status: 410 }));
    const face = { id: 3, halfedges: [0, 2, 4] };
    const { rings, measures, halfedges } = await describe('face', face, ask);
    assert.deepEqual(rings, [{ name: 'faces', kind: 'face', ids: [] }]);
    assert.deepEqual(measures, []);
    assert.deepEqual(halfedges, []);
});

// --- links ---

test('a link says what is shown and is read back', () => {
    const camera = [1.5, -2, 0.000001, 0, 0, 0.123456];
    for (const [shown, text] of [
        [
            { mesh: 'm1', kind: 'face', ids: [3], camera, parts: {} },
            '#mesh=m1&face=3&camera=1.5,-2,0.000001,0,0,0.123456',
        ],
        [
            { mesh: 'm1', kind: 'edge', ids: [3, 0], camera: null, parts: { look: 'a,b&c' } },
            '#mesh=m1&edge=3,0&look=a,b%26c',
        ],
        [
            { mesh: 'a&b=c', kind: null, ids: [], camera: null, parts: {} },
            '#mesh=a%26b%3Dc',
        ],
    ]) {
        assert.equal(formatLink(shown), text);
        assert.deepEqual(parseLink(text), shown);
    }
});

test('what a link says wrongly is passed over', () => {
    const nothing = { mesh: null, kind: null, ids: [], camera: null, parts: {} };
    for (const text of ['', '#', '#face=-1', '#vertex=1e3', '#camera=1,2,3', '#camera=1,2,3,4,5,x',
        '#camera=1,2,,4,5,6', '#edge=12345678901', '#face=1,,2', '#face=1,']) {
        assert.deepEqual(parseLink(text), nothing, text);
    }
});

test('registered parts of the page join a link', async () => {
    const share = new Share();
    let look = 'flat';
    const seen = [];
    share.register('look', { get: () => look, set: (text) => seen.push(text) });
    share.register('colour', { get: () => null, set: (text) => seen.push(text) });
    assert.deepEqual(share.parts(false), { look: 'flat' });
    await share.show({ colour: 'area', other: 'x' });
    assert.deepEqual(seen, [null, 'area']);
    look = null;
    assert.deepEqual(share.parts(false), {});
});

// --- changes ---

// Returns the arrays of two triangles with a common edge; `y` moves a vertex.
function pairOf({ y = 0, faces = [0, 1], scale = 1 } = {}) {
    const points = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1 + y, 0]].map((point) =>
        point.map((value) => value * scale),
    );
    const all = [[0, 1, 2, (0x20000000 | 0x40000000 | faces[0]) >>> 0], [1, 3, 2, (0x60000000 | faces[1]) >>> 0]];
    const triangles = Uint32Array.from(all.flat());
    const firstOf = new Uint32Array(8);
    faces.forEach((face, i) => {
        firstOf[face] = i + 1;
    });
    return {
        vertices: Float32Array.from(points.flatMap((point) => [...point, 1])),
        triangles,
        triangleCount: 2,
        firstOf,
        frame: { origin: [0, 0, 0], scale },
    };
}

test('faces that differ between two revisions are found', () => {
    const none = { gone: [], made: [], moved: [] };
    assert.deepEqual(changedFaces(pairOf(), pairOf()), none);
    assert.deepEqual(changedFaces(pairOf(), pairOf({ scale: 0.25 })), none);
    assert.deepEqual(changedFaces(pairOf(), pairOf({ y: 0.5 })), { ...none, moved: [1] });
    assert.deepEqual(changedFaces(pairOf(), pairOf({ faces: [0, 5] })), {
        gone: [1],
        made: [5],
        moved: [],
    });
});

test('view coordinates of one revision are placed in those of another', () => {
    const from = { frame: { origin: [1, 2, 3], scale: 2 } };
    const to = { frame: { origin: [0, 0, 1], scale: 0.5 } };
    const { scale, offset } = placementOf(from, to);
    // The point (3, 2, 4) of the mesh is (4, 0, 2) in the first and (1.5, 1, 1.5) in the second.
    assert.deepEqual([4, 0, 2].map((value, i) => value * scale + offset[i]), [1.5, 1, 1.5]);
});

test('the shape of a face is its triangles and its edges', () => {
    const { triangles, lines } = shapeOfFaces(pairOf(), [1]);
    assert.deepEqual([...triangles], [1, 0, 0, 1, 1, 0, 0, 1, 0]);
    assert.equal(lines.length, 2 * 2 * 3);
    assert.deepEqual(meanOf([0, 0, 0, 2, 4, 6]), [1, 2, 3]);
    assert.equal(meanOf([]), null);
});

test('other clients come, change and go as events tell', () => {
    const others = new Others();
    others.note({ clients: ['a', 'b'], changed: [{ client: 'b', name: 'B' }, { client: 'a', name: 'A' }] });
    others.note({ clients: ['b', 'me'], changed: [{ client: 'me', name: '' }, { client: 'b', name: 'C' }] });
    const [only, ...rest] = others.besides('me');
    assert.deepEqual(rest, []);
    assert.equal(only.name, 'C');
    assert.match(only.color, /^#[0-9a-f]{6}$/);
});

// --- picking ---

// The camera looks down on the plane of the square; a length of 1 is 100 pixels.
const SCREEN = { width: 200, height: 200 };
const MATRIX = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1];
const at = (x, y) => ({ matrix: MATRIX, ...SCREEN, x: 100 + 100 * x, y: 100 - 100 * y });

test('each mode picks its own kind', () => {
    const geometry = unpack(answer(POINTS, TRIANGLES));
    const seen = { under: 0, away: 0, triangles: [0, 1], vertices: [] };
    const screen = at(0.3, 0.04);
    assert.deepEqual(choose('face', geometry, seen, screen), { kind: 'face', id: 1 });
    assert.deepEqual(choose('edge', geometry, seen, screen), { kind: 'edge', from: 0, to: 1 });
    assert.deepEqual(choose('halfedge', geometry, seen, screen), {
        kind: 'halfedge',
        from: 0,
        to: 1,
    });
    assert.deepEqual(choose('vertex', geometry, seen, at(0.4, 0.1)), { kind: 'vertex', id: 1 });
});

test('a half-edge is that of the face under the pointer, or of the hole beside it', () => {
    const geometry = unpack(answer(POINTS, TRIANGLES));
    const pick = (under, away, x, y) =>
        choose('halfedge', geometry, { under, away, triangles: [0, 2], vertices: [] }, at(x, y));
    assert.deepEqual(pick(0, 0, 0.47, 0.2), { kind: 'halfedge', from: 1, to: 2 });
    assert.deepEqual(pick(2, 0, 0.53, 0.2), { kind: 'halfedge', from: 2, to: 1 });
    assert.deepEqual(pick(0, 3, 0.2, -0.03), { kind: 'halfedge', from: 1, to: 0 });
});

test('far from every edge the nearest one of the face is meant', () => {
    const geometry = unpack(answer(POINTS, TRIANGLES));
    const seen = { under: 1, away: 0, triangles: [1], vertices: [] };
    const { from, to } = choose('edge', geometry, seen, at(0.25, 0.35));
    assert.deepEqual([from, to], [2, 3]);
});

test('where nothing is seen nothing is picked', () => {
    const geometry = unpack(answer(POINTS, TRIANGLES));
    const seen = { under: -1, away: Infinity, triangles: [], vertices: [] };
    for (const mode of ['face', 'edge', 'vertex', 'halfedge']) {
        assert.equal(choose(mode, geometry, seen, at(0, 0)), null, mode);
    }
});

test('distances on the screen stop at the ends of a segment and at the camera', () => {
    const { width, height } = SCREEN;
    const segment = (a, b, x, y) => distanceToSegment(MATRIX, width, height, a, b, x, y);
    assert.equal(distanceToPoint(MATRIX, width, height, [0, 0, 0], 103, 104), 5);
    assert.equal(segment([0, 0, 0], [1, 0, 0], 150, 110), 10);
    assert.equal(segment([0, 0, 0], [1, 0, 0], 97, 96), 5);
    assert.equal(segment([0, 0, 0], [0, 0, 0], 103, 104), 5);
    // In this matrix w = -z, so a point with a positive z is behind the camera.
    const perspective = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, -1, 0, 0, 0, 0];
    assert.equal(distanceToPoint(perspective, width, height, [0, 0, 1], 0, 0), Infinity);
    const both = distanceToSegment(perspective, width, height, [0, 0, 1], [0, 1, 2], 0, 0);
    assert.equal(both, Infinity);
    const half = distanceToSegment(perspective, width, height, [0, 0, -1], [0, 0, 1], 100, 100);
    assert.ok(half < 1e-6);
});

test('a narrow canvas needs more distance', () => {
    assert.ok(fitDistance(0.5) > fitDistance(1));
    assert.equal(fitDistance(2), fitDistance(1));
});

test('a camera turns to what looks away from it, and else stays where it is', () => {
    const front = [0, -1, 0];
    assert.deepEqual(turnTo(front, null), front);
    assert.deepEqual(turnTo(front, [0, -1, 0]), front);
    assert.deepEqual(turnTo(front, [0.6, -0.8, 0]), front);
    for (const normal of [[0, 1, 0], [1, 0, 0], [0, 0, -1], [0.8, 0.6, 0]]) {
        const turned = turnTo(front, normal);
        const seen = turned.reduce((sum, value, i) => sum + value * normal[i], 0);
        assert.ok(seen > 0.8, `${normal}: ${turned}`);
        assert.ok(Math.abs(Math.hypot(...turned) - 1) < 1e-9);
    }
});

test('points have a middle and reach some way from it', () => {
    const points = [[0, 0, 0], [2, 0, 0], [2, 4, 0]];
    assert.deepEqual(middleOfPoints(points), [1, 2, 0]);
    assert.ok(Math.abs(reachFrom([1, 2, 0], points) - Math.hypot(1, 2)) < 1e-9);
    assert.equal(reachFrom([1, 2, 3], [[1, 2, 3]]), 0);
    assert.equal(reachFrom([1, 2, 3], []), 0);
});

test('a square of the id buffer is read from its middle outwards', () => {
    const ids = new Uint32Array(4 * 25);
    const put = (x, y, kind, id) => ids.set([kind, id], 4 * (5 * y + x));
    put(0, 0, 1, 7);
    put(3, 2, 1, 4);
    put(2, 4, 1, 4);
    put(1, 1, 2, 9);
    assert.deepEqual(readSquare(ids, 5), { under: 4, away: 1, triangles: [4, 7], vertices: [9] });
    const nothing = { under: -1, away: Infinity, triangles: [], vertices: [] };
    assert.deepEqual(readSquare(new Uint32Array(4), 1), nothing);
});
