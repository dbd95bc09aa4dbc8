// Triangles, frames and picking by numbers alone: no browser, no server.

import assert from 'node:assert/strict';
import { test } from 'node:test';

import {
    Elements,
    Polygon,
    VERTEX_ISOLATED,
    VERTEX_USED,
    edgesOfTriangles,
    faceOf,
    frameOf,
    isEdge,
    pack,
    slotOf,
    trianglesOfFace,
} from '../../web/src/geometry.js';
import { choose } from '../../web/src/pick.js';
import { distanceToPoint, distanceToSegment, fitDistance } from '../../web/src/view.js';

function triangulate(points) {
    const polygon = new Polygon();
    const triangles = [];
    polygon.begin(points.length);
    points.forEach(([x, y, z = 0], slot) => polygon.add(slot, x, y, z));
    polygon.triangulate((a, b, c, sides) => triangles.push({ corners: [a, b, c], sides }));
    return triangles;
}

function signedArea([a, b, c]) {
    return ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])) / 2;
}

function polygonArea(points) {
    return points.reduce((sum, [x, y], i) => {
        const [u, v] = points[(i + 1) % points.length];
        return sum + (x * v - y * u) / 2;
    }, 0);
}

// Edges come out once each in their direction, diagonals twice and opposite.
function checkSides(triangles, n) {
    const edges = new Set();
    const diagonals = new Map();
    for (const { corners, sides } of triangles) {
        for (let side = 0; side < 3; side++) {
            const from = corners[side];
            const to = corners[(side + 1) % 3];
            if ((sides >> side) & 1) {
                assert.equal(to, (from + 1) % n, `side ${from}-${to} is not an edge`);
                assert.ok(!edges.has(from), `edge ${from}-${to} comes twice`);
                edges.add(from);
            } else {
                diagonals.set(`${from}-${to}`, (diagonals.get(`${from}-${to}`) ?? 0) + 1);
            }
        }
    }
    assert.equal(edges.size, n);
    for (const [diagonal, count] of diagonals) {
        assert.equal(count, 1, diagonal);
        assert.equal(diagonals.get(diagonal.split('-').reverse().join('-')), 1, diagonal);
    }
}

// A tiling without overlap: all triangles wind like the polygon and their areas add up.
function checkTiling(points) {
    const triangles = triangulate(points);
    assert.equal(triangles.length, points.length - 2);
    checkSides(triangles, points.length);
    let sum = 0;
    for (const { corners } of triangles) {
        const area = signedArea(corners.map((corner) => points[corner]));
        assert.ok(area > 0, `triangle ${corners} has area ${area}`);
        sum += area;
    }
    const whole = polygonArea(points);
    assert.ok(Math.abs(sum - whole) <= 1e-9 * whole, `${sum} is not ${whole}`);
    return triangles;
}

const SQUARE = [[0, 0], [1, 0], [1, 1], [0, 1]];
const ARROW = [[0, 0], [2, 1], [0, 2], [0.5, 1]];
const COMB = [
    [0, 0], [9, 0], [9, 4], [8, 4], [8, 1], [7, 1], [7, 4], [6, 4], [6, 1], [5, 1], [5, 4],
    [4, 4], [4, 1], [3, 1], [3, 4], [2, 4], [2, 1], [1, 1], [1, 4], [0, 4],
];

// A spiral of one arm, drawn out and back.
function spiral(steps) {
    const at = (i, r) => {
        const angle = i / 3;
        return [(r + angle) * Math.cos(angle), (r + angle) * Math.sin(angle)];
    };
    const outer = Array.from({ length: steps }, (_, i) => at(i, 3));
    const inner = Array.from({ length: steps }, (_, i) => at(steps - 1 - i, 1.5));
    return [...outer, ...inner];
}

test('a triangle is itself, with three edges', () => {
    assert.deepEqual(triangulate([[0, 0], [1, 0], [0, 1]]), [{ corners: [0, 1, 2], sides: 7 }]);
});

test('polygons convex and concave are tiled, from whichever corner they start', () => {
    for (const polygon of [SQUARE, ARROW, COMB, spiral(40)]) {
        for (let start = 0; start < polygon.length; start++) {
            checkTiling([...polygon.slice(start), ...polygon.slice(0, start)]);
        }
    }
});

test('a concave quad is cut at its reflex corner', () => {
    const diagonals = checkTiling(ARROW)
        .flatMap(({ corners, sides }) =>
            corners.map((corner, i) => ((sides >> i) & 1 ? null : [corner, corners[(i + 1) % 3]])),
        )
        .filter(Boolean);
    assert.deepEqual(diagonals.map((pair) => pair.sort()), [[1, 3], [1, 3]]);
});

test('collinear corners keep their edges on triangles that have an area', () => {
    checkTiling([[0, 0], [0.5, 0], [1, 0], [0, 1]]);
    checkTiling([[0, 0], [1, 0], [2, 0], [3, 0], [3, 1], [3, 2], [1.5, 2], [0, 2], [0, 1]]);
});

test('the plane may stand in any direction, and windings are kept', () => {
    const turns = [
        ([x, y]) => [x, y, 3],
        ([x, y]) => [3, x, y],
        ([x, y]) => [y, 3, x],
        ([x, y]) => [y, x, -3], // seen from below
        ([x, y]) => [x, x + y, 2 * x - y],
    ];
    const flat = triangulate(COMB).length;
    for (const turn of turns) {
        const triangles = triangulate(COMB.map(turn));
        assert.equal(triangles.length, flat);
        checkSides(triangles, COMB.length);
    }
    // The sum of the triangles' vector areas is the polygon's.
    const points = COMB.map(([x, y]) => [y, x, 0]);
    for (const { corners } of triangulate(points)) {
        assert.ok(signedArea(corners.map((corner) => points[corner])) < 0);
    }
});

test('random star-shaped polygons are tiled', () => {
    let seed = Number(process.env.SEED ?? 12345);
    const random = () => {
        seed = (Math.imul(seed, 1103515245) + 12345) & 0x7fffffff;
        return seed / 0x7fffffff;
    };
    for (let round = 0; round < 300; round++) {
        const n = 3 + Math.floor(random() * 40);
        const polygon = Array.from({ length: n }, (_, i) => {
            const angle = (2 * Math.PI * (i + 0.8 * random())) / n;
            const radius = 0.1 + random();
            return [radius * Math.cos(angle), radius * Math.sin(angle)];
        });
        // Few corners may leave the centre outside; then it is no star.
        if (n > 6) {
            checkTiling(polygon);
        }
    }
});

test('degenerate polygons still give n - 2 triangles', () => {
    const line = Array.from({ length: 9 }, (_, i) => [i, 0]);
    const point = Array.from({ length: 7 }, () => [1, 1]);
    const bow = [[0, 0], [1, 1], [1, 0], [0, 1]];
    for (const polygon of [line, point, bow]) {
        const triangles = triangulate(polygon);
        assert.equal(triangles.length, polygon.length - 2);
        const edges = triangles.flatMap(({ sides }) => [sides & 1, (sides >> 1) & 1, sides >> 2]);
        assert.equal(edges.filter(Boolean).length, polygon.length);
    }
});

test('a large polygon takes no quadratic time, a hostile one an end', () => {
    const circle = Array.from({ length: 200000 }, (_, i) => {
        const angle = (2 * Math.PI * i) / 200000;
        return [Math.cos(angle), Math.sin(angle)];
    });
    const saw = Array.from({ length: 20000 }, (_, i) => [i, i % 2]);
    saw.push([20000, 1e6], [-1, 1e6]);
    const start = process.cpuUsage();
    assert.equal(triangulate(circle).length, circle.length - 2);
    assert.equal(triangulate(saw).length, saw.length - 2);
    const seconds = process.cpuUsage(start).user / 1e6;
    assert.ok(seconds < 30, `${seconds} s of processor time`);
});

function cubeWithGaps() {
    const elements = new Elements();
    const ids = [2, 3, 5, 7, 11, 13, 17, 19];
    ids.forEach((id, i) => {
        elements.addVertex({ id, position: [(i & 1) * 4 + 100, ((i >> 1) & 1) * 2, i >> 2] });
    });
    elements.addVertex({ id: 4000000000, position: [104, 2, 1] });
    const faces = [
        [0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4],
        [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5],
    ];
    faces.forEach((face, i) => {
        elements.addFace({ id: 10 * i + 1, vertices: face.map((corner) => ids[corner]) });
    });
    return elements;
}

test('ids with gaps become slots and back', () => {
    const { vertexIds, faceIds, triangles, vertices } = pack(cubeWithGaps());
    assert.deepEqual([...faceIds], [1, 11, 21, 31, 41, 51]);
    assert.equal(slotOf(vertexIds, 11), 4);
    assert.equal(slotOf(vertexIds, 4000000000), 8);
    assert.equal(slotOf(vertexIds, 4), -1);
    assert.equal(slotOf(new Uint32Array(0), 4), -1);
    assert.equal(triangles.length, 4 * 12);
    for (let triangle = 0; triangle < 12; triangle++) {
        assert.equal(faceOf(triangles, triangle), triangle >> 1);
        const edges = [0, 1, 2].filter((side) => isEdge(triangles, triangle, side));
        assert.equal(edges.length, 2);
    }
    assert.equal(vertices[3], VERTEX_USED);
    assert.equal(vertices[4 * 8 + 3], VERTEX_ISOLATED);
});

test('the edges of a face are its sides in order of its winding', () => {
    const { triangles } = pack(cubeWithGaps());
    const edges = edgesOfTriangles(triangles, trianglesOfFace(triangles, 1));
    const next = new Map(edges);
    assert.equal(edges.length, 4);
    assert.deepEqual([4, next.get(4), next.get(next.get(4))], [4, 5, 7]);
});

test('ids out of order and unknown corners are refused', () => {
    const elements = new Elements();
    elements.addVertex({ id: 3, position: [0, 0, 0] });
    const again = () => elements.addVertex({ id: 3, position: [0, 0, 0] });
    assert.throws(again, /id 3 comes after id 3/);
    elements.addFace({ id: 0, vertices: [3, 4, 5] });
    assert.throws(() => pack(elements), /face 0 has unknown vertex 4/);
});

test('a mesh of any size and place fills the unit ball', () => {
    for (const [scale, shift] of [[1, 0], [1e-300, 0], [1e308, 0], [1e-3, 1e6], [1, -1e12]]) {
        const elements = new Elements();
        [[-1, -1, -1], [1, 1, 1], [0, 0, 1]].forEach((position, id) => {
            elements.addVertex({ id, position: position.map((v) => v * scale + shift) });
        });
        const { vertices } = pack(elements);
        const radius = Math.hypot(...vertices.subarray(0, 3));
        assert.ok(Math.abs(radius - 1) < 1e-3, `${radius} at scale ${scale} and shift ${shift}`);
    }
});

test('no vertices, or all in one place, have a frame', () => {
    assert.deepEqual(frameOf(new Float64Array(0)), { center: [0, 0, 0], half: 1 });
    assert.deepEqual(frameOf(new Float64Array([7, 8, 9])), { center: [7, 8, 9], half: 1 });
    assert.equal(pack(new Elements()).triangles.length, 0);
});

test('the frame that is given is kept', () => {
    const first = pack(cubeWithGaps());
    const elements = cubeWithGaps();
    elements.addVertex({ id: 4000000001, position: [1000, 0, 0] });
    const second = pack(elements, first.frame);
    assert.deepEqual(second.frame, first.frame);
    assert.deepEqual(second.vertices.subarray(0, 24), first.vertices.subarray(0, 24));
});

// A camera at (0, 0, 5) that looks down z: x and y at z = 0 are 10 pixels a unit on 100 x 100.
const CAMERA = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, -1, 0, 0, 4, 5];

test('distances on the screen', () => {
    const at = (...point) => distanceToPoint(CAMERA, 100, 100, point, 50, 50);
    assert.equal(at(0, 0, 0), 0);
    assert.equal(at(1, 0, 0), 10);
    assert.equal(at(0, 1, 2.5), 20);
    assert.equal(at(0, 0, 6), Infinity);
    const between = (a, b) => distanceToSegment(CAMERA, 100, 100, a, b, 50, 50);
    assert.equal(between([1, -1, 0], [1, 1, 0]), 10);
    assert.equal(between([2, 0, 0], [3, 0, 0]), 20);
    assert.equal(between([2, 0, 0], [2, 0, 0]), 20);
    assert.equal(between([0, 0, 6], [1, 0, 7]), Infinity);
    // The part behind the camera does not count; the part before it runs out of the picture.
    assert.ok(Math.abs(between([1, 0, 0], [1, 0, 9]) - 10) < 1e-9);
    assert.ok(fitDistance(1) < fitDistance(0.5));
    assert.equal(fitDistance(1), fitDistance(2));
});

test('a pick gives what the mode asks for and nothing else', () => {
    const elements = new Elements();
    SQUARE.forEach(([x, y], id) => elements.addVertex({ id, position: [4 * x, 4 * y, 0] }));
    elements.addFace({ id: 0, vertices: [0, 1, 2, 3] });
    const geometry = pack(elements, { center: [0, 0, 0], half: 1 / Math.sqrt(3) });
    const screen = { matrix: CAMERA, width: 100, height: 100 };
    const look = (mode, x, y, seen) => choose(mode, geometry, seen, { ...screen, x, y });
    const face = { under: 0, triangles: [0, 1], vertices: [] };
    const nothing = { under: -1, triangles: [], vertices: [] };

    assert.deepEqual(look('face', 60, 40, face), { kind: 'face', face: 0 });
    // The bottom edge runs from (50, 50) to (90, 50).
    assert.deepEqual(look('edge', 70, 47, face), { kind: 'edge', from: 0, to: 1 });
    // In the middle of the face, beyond reach of all edges, the nearest one; never the diagonal.
    assert.deepEqual(look('edge', 80, 29, face), { kind: 'edge', from: 1, to: 2 });
    assert.deepEqual(look('vertex', 60, 40, face), { kind: 'vertex', vertex: 0 });
    assert.deepEqual(look('vertex', 60, 40, { ...face, vertices: [2] }), {
        kind: 'vertex',
        vertex: 2,
    });
    for (const mode of ['face', 'edge', 'vertex']) {
        assert.equal(look(mode, 60, 40, nothing), null);
    }
});
