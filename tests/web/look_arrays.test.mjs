// Tests of what the look of the view computes from the arrays of the mesh: outlines of sections,
// normals for smooth shading, the simpler mesh for moving, the bounding box and the grid, and of its
// state. Without a browser.

import assert from 'node:assert/strict';
import { test } from 'node:test';

import { boxOf, edgesAlong, gridBelow, roundStep } from '../../web/src/geometry/extent.js';
import { faceOf, pointAt } from '../../web/src/geometry/geometry.js';
import { cornerNormals, packed } from '../../web/src/geometry/normals.js';
import { cutOutline } from '../../web/src/geometry/outline.js';
import { proxyOf } from '../../web/src/geometry/proxy.js';
import {
    FIRST, anglesOf, normalOfAngles, planeOf, rangeOf, toState,
} from '../../web/src/look/state.js';
import { arraysOf, cube, run, torus } from './arrays.mjs';

const X = [1, 0, 0];
const Z = [0, 0, 1];
const cut = (geometry, normal, at) => run(cutOutline(geometry, { normal, at })).result;

// Requires that two numbers are the same, as far as coordinates of 32 bits can tell.
function near(found, wanted, what, tolerance = 2e-6) {
    assert.ok(Math.abs(found - wanted) <= tolerance * Math.max(1, Math.abs(wanted)),
        `${what}: ${found}, not ${wanted}`);
}

const polygon = (corners, radius) => 2 * corners * radius * Math.sin(Math.PI / corners);
const polygonArea = (corners, radius) =>
    (corners / 2) * radius ** 2 * Math.sin((2 * Math.PI) / corners);

// --- outlines ---

test('a cube that is cut in its middle has an outline of 4 and an area of 1', () => {
    for (const normal of [X, [0, 1, 0], Z, [-1, 0, 0]]) {
        const found = cut(cube(), normal, 0);
        near(found.length, 4, 'length');
        near(found.area, 1, 'area');
        assert.deepEqual([found.closed, found.open], [1, 0]);
        assert.equal(found.lines.length, 6 * 8); // each side is two triangles
    }
    // across a corner: a regular hexagon whose sides are half of a diagonal
    const found = cut(cube(), [1, 1, 1].map((x) => x / Math.sqrt(3)), 0);
    near(found.length, 6 * Math.SQRT1_2, 'hexagon');
    near(found.area, 1.5 * Math.sqrt(3) * 0.5, 'area of the hexagon');
});

test('a plane in which faces lie cuts their rim on one side and nothing on the other', () => {
    const top = cut(cube(), Z, 0.5);
    near(top.length, 4, 'top');
    near(top.area, 1, 'area of the top');
    const bottom = cut(cube(), Z, -0.5);
    assert.deepEqual([bottom.length, bottom.closed, bottom.open], [0, 0, 0]);
    assert.equal(cut(cube(), Z, 3).lines.length, 0);
});

test('a torus is cut into two circles, or into one ring with a hole', () => {
    const [big, small] = [0.7, 0.25];
    const ring = torus(40, 24, [big, small]);
    // the plane contains the axis, and passes through vertices
    const circles = cut(ring, [0, 1, 0], 0);
    assert.deepEqual([circles.closed, circles.open], [2, 0]);
    near(circles.length, 2 * polygon(24, small), 'two circles');
    near(circles.area, 2 * polygonArea(24, small), 'their area');
    const rings = cut(ring, Z, 0);
    assert.deepEqual([rings.closed, rings.open], [2, 0]);
    near(rings.length, polygon(40, big + small) + polygon(40, big - small), 'rings');
    near(rings.area, polygonArea(40, big + small) - polygonArea(40, big - small), 'ring area');
});

test('triangles of the fans cover the cut an odd number of times', () => {
    const { fans } = cut(torus(40, 24), Z, 0);
    const covers = (x, y) => {
        let count = 0;
        for (let i = 0; i < fans.length; i += 9) {
            const side = (a, b) =>
                Math.sign((fans[i + 3 * b] - fans[i + 3 * a]) * (y - fans[i + 3 * a + 1]) -
                    (fans[i + 3 * b + 1] - fans[i + 3 * a + 1]) * (x - fans[i + 3 * a]));
            const signs = [side(0, 1), side(1, 2), side(2, 0)];
            count += signs.every((one) => one > 0) || signs.every((one) => one < 0) ? 1 : 0;
        }
        return count % 2 === 1;
    };
    for (let i = 0; i < 60; i++) {
        const [x, y] = [0.033 * i - 0.991, 0.0123];
        const radius = Math.hypot(x, y);
        if (Math.abs(radius - 0.45) > 0.02 && Math.abs(radius - 0.95) > 0.02) {
            assert.equal(covers(x, y), radius > 0.45 && radius < 0.95, `at ${x}`);
        }
    }
});

test('an open surface has an open outline, without area', () => {
    const sheet = arraysOf(
        [[-1, -1, 0], [0, -1, 0], [1, -1, 0], [1, 1, 0], [0, 1, 0], [-1, 1, 0]],
        [[0, 1, 4, 5], [1, 2, 3, 4]],
    );
    const found = cut(sheet, [0, 1, 0], 0.25);
    near(found.length, 2, 'length');
    assert.deepEqual([found.closed, found.open, found.area], [0, 1, 0]);
    assert.equal(found.fans.length, 0);
});

test('deleted triangles and vertices are not cut', () => {
    const geometry = cube();
    geometry.triangles.fill(0, 0, 4 * geometry.triangleCount);
    assert.deepEqual(cut(geometry, X, 0).lines.length, 0);
});

test('large meshes are cut in slices', () => {
    const { pauses, result } = run(cutOutline(torus(300, 200), { normal: [0, 1, 0], at: 0 }));
    assert.ok(pauses >= 20, `${pauses} pauses for 120,000 triangles`);
    near(result.length, 2 * polygon(200, 0.25), 'length');
});

// --- normals ---

// Unpacks a normal as look_shaders.js does.
function unpacked(word) {
    const [u, v] = [word & 0xffff, word >>> 16].map((half) => half / 32767.5 - 1);
    let [x, y, z] = [u, v, 1 - Math.abs(u) - Math.abs(v)];
    if (z < 0) {
        [x, y] = [(1 - Math.abs(v)) * (u >= 0 ? 1 : -1), (1 - Math.abs(u)) * (v >= 0 ? 1 : -1)];
    }
    const length = Math.hypot(x, y, z);
    return [x, y, z].map((value) => value / length);
}

function sameDirection(found, wanted, what, tolerance = 1e-4) {
    const length = Math.hypot(...wanted);
    found.forEach((value, i) =>
        assert.ok(Math.abs(value - wanted[i] / length) < tolerance, `${what}: ${found}, not ${wanted}`),
    );
}

// Calls `check(corner, normal, triangle)` with the vertex and the normal of each corner.
function eachCorner(geometry, degrees, check) {
    const normals = run(cornerNormals(geometry, degrees)).result;
    assert.equal(normals.length, geometry.triangles.length);
    for (let i = 0; i < geometry.triangleCount; i++) {
        for (let k = 0; k < 3; k++) {
            check(geometry.triangles[4 * i + k], unpacked(normals[4 * i + k]), i);
        }
    }
}

test('normals survive being packed', () => {
    for (let i = 0; i < 500; i++) {
        const [a, b] = [0.37 * i, Math.acos(1 - (2 * i) / 499)];
        const normal = [Math.sin(b) * Math.cos(a), Math.sin(b) * Math.sin(a), Math.cos(b)];
        sameDirection(unpacked(packed(...normal)), normal, `normal ${i}`);
    }
    assert.equal(packed(0, 0, 0), 0);
    assert.notEqual(packed(0, 0, -1), 0);
});

test('edges that are sharper than the crease angle stay sharp', () => {
    const geometry = cube();
    eachCorner(geometry, 40, (_, normal, triangle) => {
        const large = normal.filter((value) => Math.abs(value) > 0.99);
        assert.equal(large.length, 1, `triangle ${triangle}: ${normal}`);
    });
    // however the squares are divided into triangles, a smooth cube has its diagonals as normals
    eachCorner(geometry, 180, (vertex, normal) => {
        sameDirection(normal, pointAt(geometry, vertex), `vertex ${vertex}`);
    });
});

test('the normals of a torus point away from its circle', () => {
    const geometry = torus(64, 48);
    eachCorner(geometry, 40, (vertex, normal) => {
        const [x, y, z] = pointAt(geometry, vertex);
        const reach = Math.hypot(x, y);
        const [cx, cy] = [(0.7 * x) / reach, (0.7 * y) / reach];
        sameDirection(normal, [x - cx, y - cy, z], `vertex ${vertex}`, 0.03);
    });
});

test('a vertex with very many faces has a normal in a time that grows with their number', () => {
    const count = 20000;
    const rim = Array.from({ length: count }, (_, i) => (2 * Math.PI * i) / count);
    const points = [[0, 0, 0.2], ...rim.map((a) => [Math.cos(a), Math.sin(a), 0])];
    const fan = rim.map((_, i) => [0, 1 + i, 1 + ((i + 1) % count)]);
    eachCorner(arraysOf(points, fan), 40, (vertex, normal) => {
        if (vertex === 0) {
            sameDirection(normal, [0, 0, 1], 'apex', 1e-3);
        }
    });
});

test('triangles without area are drawn flat', () => {
    const line = arraysOf([[0, 0, 0], [0.5, 0, 0], [1, 0, 0]], [[0, 1, 2]]);
    const normals = run(cornerNormals(line, 40)).result;
    assert.deepEqual([...normals.subarray(0, 4)], [0, 0, 0, 0]);
});

// --- the simpler mesh ---

test('a large mesh has a simpler one with its shape, made of its own vertices and faces', () => {
    const geometry = torus(700, 500);
    const { result: proxy, pauses } = run(proxyOf(geometry));
    assert.ok(pauses > 50, `${pauses} pauses`);
    const { triangles, triangleCount } = proxy;
    assert.ok(triangleCount > 10000 && triangleCount < geometry.triangleCount / 4, `${triangleCount}`);
    const faces = new Set();
    const corner = (i, k) => pointAt(geometry, triangles[4 * i + k]);
    let volume = 0;
    for (let i = 0; i < triangleCount; i++) {
        const [a, b, c] = [0, 1, 2].map((k) => corner(i, k));
        assert.ok(faceOf(triangles, i) < 700 * 500);
        faces.add(faceOf(triangles, i));
        volume += (a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
            a[2] * (b[0] * c[1] - b[1] * c[0])) / 6;
    }
    // its triangles go round in the direction of the mesh's, and enclose nearly the same volume
    near(volume, 2 * Math.PI ** 2 * 0.7 * 0.25 ** 2, 'volume', 0.02);
    assert.ok(faces.size > 10000);
});

test('a mesh of few large triangles has no simpler one', () => {
    assert.equal(run(proxyOf(cube())).result, null);
});

// --- box and grid ---

test('the box has the sizes of the mesh, and four edges along each axis', () => {
    const box = boxOf(cube(0.25));
    assert.deepEqual(box, { low: [-0.25, -0.25, -0.25], high: [0.25, 0.25, 0.25] });
    for (let axis = 0; axis < 3; axis++) {
        const edges = edgesAlong(box, axis);
        assert.equal(new Set(edges.map(String)).size, 4);
        edges.forEach(([from, to]) =>
            to.forEach((value, i) => assert.equal(value - from[i], i === axis ? 0.5 : 0)));
    }
    const none = { vertices: new Float32Array(8), vertexCount: 2 };
    assert.equal(boxOf(none), null);
});

test('the step of the grid is round, and its lines are at multiples of it', () => {
    for (const [length, step] of [[0.0013, 0.002], [1, 1], [1.01, 2], [4, 5], [7e5, 1e6], [2e-9, 2e-9]]) {
        assert.equal(roundStep(length), step);
    }
    // a mesh of 30 by 10 at (1000, 0, 5), of which view coordinates are a twentieth
    const frame = { origin: [1000, 0, 5], scale: 0.05 };
    const box = { low: [-0.75, -0.25, -0.1], high: [0.75, 0.25, 0.1] };
    const { step, lines } = gridBelow(box, frame);
    assert.equal(step, 5);
    for (const [from, to] of lines) {
        const across = from[0] === to[0] ? 0 : 1;
        const place = from[across] / frame.scale + frame.origin[across];
        assert.ok(Math.abs(place / step - Math.round(place / step)) < 1e-9, `${place}`);
        assert.equal(from[2], box.low[2]);
    }
});

// --- the state ---

test('a look is read from anything, and what is wrong in it is ignored', () => {
    for (const wrong of [null, undefined, 3, 'x', [], { way: 'sideways', crease: 1e9, section: 7 }]) {
        assert.deepEqual(toState(wrong), FIRST);
    }
    const wrongSections = [
        { axis: 'q', at: 1 },
        { axis: 'x', at: Infinity },
        { axis: 'x' },
        { axis: 'free', at: 0 },
        { axis: 'free', at: 0, normal: [0, 0, 0] },
        { axis: 'free', at: 0, normal: [1, 'a', 0] },
    ];
    for (const section of wrongSections) {
        assert.equal(toState({ section }).section, null, JSON.stringify(section));
    }
    const { section } = toState({ section: { axis: 'free', at: 2, normal: [0, 3, 4] } });
    assert.deepEqual(section, { axis: 'free', normal: [0, 0.6, 0.8], at: 2, isFlipped: false });
    const all = { ...FIRST, way: 'wire', isSmooth: true, matcap: 'clay', unit: 'mm', crease: 15 };
    assert.deepEqual(toState({ ...all, other: 1 }), all);
});

test('planes and ranges are computed in the coordinates of the mesh', () => {
    const frame = { origin: [10, 20, 30], scale: 0.5 };
    const plane = planeOf({ normal: X, at: 12, isFlipped: false }, frame);
    assert.deepEqual(plane, { normal: X, at: 1 });
    const flipped = planeOf({ normal: Z, at: 32, isFlipped: true }, frame);
    assert.deepEqual(flipped.normal.map((value) => value + 0), [0, 0, -1]);
    assert.equal(flipped.at, -1);
    const box = { low: [-1, -0.5, 0], high: [1, 0.5, 0.25] };
    assert.deepEqual(rangeOf(X, box, frame), [8, 12]);
    assert.deepEqual(rangeOf([0, -1, 0], box, frame), [-21, -19]);
    for (const [turn, tilt] of [[0, 0], [30, 45], [200, -60], [359, 10]]) {
        assert.deepEqual(anglesOf(normalOfAngles(turn, tilt)), { turn, tilt });
    }
});
