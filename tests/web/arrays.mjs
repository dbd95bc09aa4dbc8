// arrays.mjs - makes the arrays of geometry.js from lists of points and polygons, for tests of modules
// that compute with them.

import { wholeRows } from '../../web/src/geometry/geometry.js';

// Returns a geometry in which view coordinates are those of the points. Polygons are divided into the
// triangles of a fan.
export function arraysOf(points, polygons) {
    const vertices = Float32Array.from(points.flatMap((point) => [...point, 1]));
    const words = polygons.flatMap((polygon, face) =>
        polygon.slice(2).flatMap((corner, i) => {
            const sides = (i === 0 ? 1 : 0) | 2 | (i === polygon.length - 3 ? 4 : 0);
            return [polygon[0], polygon[i + 1], corner, (face | (sides << 29)) >>> 0];
        }),
    );
    return {
        revision: 1,
        frame: { origin: [0, 0, 0], scale: 1 },
        vertices: wholeRows(vertices),
        vertexCount: points.length,
        triangles: wholeRows(Uint32Array.from(words)),
        triangleCount: words.length / 4,
    };
}

// A cube from -half to half.
export function cube(half = 0.5) {
    const points = Array.from({ length: 8 }, (_, i) =>
        [0, 1, 2].map((axis) => ((i >> axis) & 1 ? half : -half)),
    );
    return arraysOf(points, [
        [0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5],
    ]);
}

// A torus around the z axis. Its vertices are on circles whose planes contain the axis.
export function torus(major, minor, [big, small] = [0.7, 0.25]) {
    const points = [];
    const polygons = [];
    const at = (i, k) => (i % major) * minor + (k % minor);
    for (let i = 0; i < major; i++) {
        for (let k = 0; k < minor; k++) {
            const [a, b] = [(2 * Math.PI * i) / major, (2 * Math.PI * k) / minor];
            const reach = big + small * Math.cos(b);
            points.push([reach * Math.cos(a), reach * Math.sin(a), small * Math.sin(b)]);
            polygons.push([at(i, k), at(i + 1, k), at(i + 1, k + 1), at(i, k + 1)]);
        }
    }
    return arraysOf(points, polygons);
}

// Runs a generator to its end; returns {result, pauses}.
export function run(steps) {
    for (let pauses = 0; ; pauses++) {
        const { done, value } = steps.next();
        if (done) {
            return { result: value, pauses };
        }
    }
}
