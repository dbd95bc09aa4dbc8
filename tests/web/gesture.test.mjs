// Tests what a drag does when several faces are selected.

import assert from 'node:assert/strict';
import { test } from 'node:test';

import { ROW } from '../../web/src/geometry/geometry.js';
import { begin, drag, regionsOf } from '../../web/src/edit/gesture.js';

// Makes the arrays of a mesh of squares, of two triangles each, from the ids of their corners.
// Vertex 3 y + x lies at (x, y).
function squares(faces) {
    const vertices = new Float32Array(4 * ROW);
    for (let id = 0; id < 12; id++) {
        vertices.set([id % 3, Math.floor(id / 3), 0, 1], 4 * id);
    }
    const triangles = new Uint32Array(4 * ROW);
    const firstOf = [];
    faces.forEach(([a, b, c, d], face) => {
        const word = (sides) => (face | (sides << 29)) >>> 0;
        triangles.set([a, b, c, word(0b011)], 8 * face);
        triangles.set([a, c, d, word(0b110)], 8 * face + 4);
        firstOf.push(2 * face + 1); // see findFaces()
    });
    const triangleCount = 2 * faces.length;
    const frame = { origin: [0, 0, 0], scale: 1 };
    return { vertices, triangles, triangleCount, vertexCount: 12, firstOf, frame };
}

// Two squares with a common edge, and one that shares no edge with them.
const FACES = [[0, 1, 4, 3], [1, 2, 5, 4], [6, 7, 10, 9]];

test('faces that share an edge are one region, the edge is inside', () => {
    const geometry = squares(FACES);
    const regions = regionsOf(geometry, [0, 1, 2]);
    assert.deepEqual(regions.map(({ faces }) => faces.sort()), [[0, 1], [2]]);
    const [pair, single] = regions;
    assert.deepEqual(pair.inner, [[1, 4]]);
    assert.equal(pair.rim.length, 6);
    assert.ok(!pair.rim.some((edge) => `${edge}` === '1,4' || `${edge}` === '4,1'));
    assert.deepEqual([single.rim.length, single.inner.length], [4, 0]);
    assert.deepEqual(regionsOf(geometry, [1]).map(({ rim }) => rim.length), [4]);
});

test('all faces that are selected are drawn where they will be', () => {
    const geometry = squares(FACES);
    const chosen = FACES.map((vertices, id) => ({ kind: 'face', id, element: { vertices } }));
    const view = { right: [1, 0, 0], up: [0, 0, 1], back: [0, -1, 0], position: [0, -9, 0] };
    const gesture = begin('extrude', { kind: 'face', chosen, crowd: null }, geometry);
    const { operation, lines } = drag(gesture, { ...view, height: 100 }, [0, -10]);
    assert.deepEqual(operation.faces, [0, 1, 2]);
    assert.equal(operation.region, true);
    // Each of the ten outer edges is drawn as two lines, one for a side face and one for the edge's
    // new position. The inner edge is drawn as one line, for its new position. A line has two ends
    // of three coordinates.
    assert.equal(lines.length, 3 * 2 * (2 * 10 + 1));
    const heights = new Set(lines.filter((_, i) => i % 3 === 2));
    assert.deepEqual([...heights], [0, operation.distance]);
    assert.ok(operation.distance > 0);
});
