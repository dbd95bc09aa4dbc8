// Tests of the pure modules that divide an edit into steps and place its half-edges in a drawing.

import assert from 'node:assert/strict';
import { test } from 'node:test';

import { HEIGHT, WIDTH, arrowsOf, loopsOf, projection } from '../../web/src/teach/layout.js';
import { withoutIdle } from '../../web/src/teach/region.js';
import { eulerOf, stepsOf } from '../../web/src/teach/steps.js';

// Returns the state of a mesh, see region.js, of which all vertices belong to a face. `faces` maps ids
// to lists of vertices, `edges` lists the vertices of each edge.
function stateOf(points, edges, faces) {
    const halfedges = new Map();
    const idOf = (from, to) => {
        const edge = edges.findIndex(
            ([a, b]) => (a === from && b === to) || (a === to && b === from),
        );
        return 2 * edge + (edges[edge][0] === from ? 0 : 1);
    };
    for (const [face, corners] of faces) {
        corners.forEach((corner, i) => {
            const next = corners[(i + 1) % corners.length];
            const prev = corners.at(i - 1);
            halfedges.set(idOf(corner, next), {
                next: idOf(next, corners[(i + 2) % corners.length]),
                prev: idOf(prev, corner),
                origin: corner,
                face,
            });
        });
    }
    // What has no face is at a boundary: its next one begins where it ends.
    const targets = edges.flatMap(([a, b]) => [b, a]);
    const loose = edges.flatMap((_, i) => [2 * i, 2 * i + 1]).filter((id) => !halfedges.has(id));
    for (const id of loose) {
        const next = loose.find((other) => targets[other ^ 1] === targets[id]);
        const prev = loose.find((other) => targets[other] === targets[id ^ 1]);
        halfedges.set(id, { next, prev, origin: targets[id ^ 1], face: null });
    }
    const counts = { vertices: points.size, edges: edges.length, faces: faces.size };
    return { halfedges, vertices: points, counts };
}

const SQUARE = new Map([
    [0, [0, 0, 0]],
    [1, [1, 0, 0]],
    [2, [1, 1, 0]],
    [3, [0, 1, 0]],
]);
const RIM = [
    [0, 1],
    [1, 2],
    [2, 3],
    [3, 0],
];

const two = stateOf(SQUARE, [...RIM, [0, 2]], new Map([[0, [0, 1, 2]], [1, [0, 2, 3]]]));
const flipped = stateOf(SQUARE, [...RIM, [1, 3]], new Map([[0, [1, 2, 3]], [1, [1, 3, 0]]]));
const one = stateOf(SQUARE, RIM, new Map([[0, [0, 1, 2, 3]]]));

// Asserts what holds of the steps of every edit.
function checkSteps(before, after) {
    const steps = stepsOf(before, after);
    assert.deepEqual(steps[0].state, before);
    assert.deepEqual(steps.at(-1).state, after);
    // All changes are told: the last step but one is the state after the edit.
    const done = steps.at(-2).state;
    assert.deepEqual(done.counts, after.counts);
    assert.deepEqual([...done.vertices].sort(), [...after.vertices].sort());
    assert.deepEqual(
        [...done.halfedges].sort(([a], [b]) => a - b),
        [...after.halfedges].sort(([a], [b]) => a - b),
    );
    for (const { title, text } of steps) {
        assert.ok(title !== '' && /\.$/.test(text), text);
        assert.ok(!/undefined|null|NaN/.test(text), text);
    }
    return steps;
}

test('the steps of a flip lead from one triangulation to the other', () => {
    const steps = checkSteps(two, flipped);
    assert.ok(steps.some(({ title }) => title === 'Origin of half-edge 8'));
    assert.ok(steps.some(({ links }) => links.length > 0));
    assert.match(steps.at(-1).text, /Euler characteristic, V \u2212 E \+ F, is 1 as before/);
});

test('the steps of a split of a face make an edge and a face, those of a merge delete them', () => {
    const split = checkSteps(one, two);
    assert.equal(split[1].title, 'Edge 4 made');
    assert.equal(split[2].title, 'Face 1 made');
    assert.match(split[1].text, /half-edges 8 and 9/);
    const merge = checkSteps(two, one);
    assert.ok(merge.some(({ title }) => title === 'Edge 4 deleted'));
    assert.ok(merge.some(({ title }) => title === 'Face 1 deleted'));
});

test('a vertex that moves is told, and where the surface changes its shape too', () => {
    const moved = { ...two, vertices: new Map([...SQUARE, [2, [2, 2, 0]]]) };
    assert.equal(checkSteps(two, moved)[1].title, 'Vertex 2 moved');
    const open = stateOf(SQUARE, [...RIM, [0, 2]], new Map([[0, [0, 1, 2]]]));
    const steps = checkSteps(two, open);
    assert.equal(eulerOf(open), eulerOf(two) - 1);
    assert.match(steps.at(-1).text, /was 1 and is 0/);
    assert.ok(steps.some(({ text }) => text.includes('at a boundary now')));
});

test('what does not change is left out', () => {
    const far = [...Array(4).keys()].map((i) => [10 + i, [5 + (i % 2), i, 0]]);
    const points = new Map([...SQUARE, ...far]);
    const more = [[10, 11], [11, 12], [12, 13], [13, 10]];
    const [before, after] = [
        new Map([[0, [0, 1, 2, 3]], [7, [10, 11, 12, 13]]]),
        new Map([[0, [0, 1, 2]], [1, [0, 2, 3]], [7, [10, 11, 12, 13]]]),
    ].map((faces, i) => stateOf(points, [...RIM, ...more, ...(i === 0 ? [] : [[0, 2]])], faces));
    const region = withoutIdle(before, after);
    assert.deepEqual([...region.before.vertices.keys()], [0, 1, 2, 3]);
    assert.equal(region.before.halfedges.size, 8);
    assert.equal(region.after.halfedges.size, 10);
    assert.deepEqual(region.before.counts, before.counts);
});

test('a drawing is upright and fits, and each arrow is on the side of its face', () => {
    const place = projection([two, flipped]);
    for (const [x, y] of [...SQUARE.values()].map(place)) {
        assert.ok(x >= 0 && x <= WIDTH && y >= 0 && y <= HEIGHT, `${x} ${y}`);
    }
    assert.ok(place([0, 1, 0])[1] < place([0, 0, 0])[1]);
    assert.ok(place([1, 0, 0])[0] > place([0, 0, 0])[0]);
    const middle = (points) => [0, 1].map((i) => points.reduce((sum, at) => sum + at[i], 0) / points.length);
    const arrows = arrowsOf(two, place);
    assert.equal(arrows.size, 10);
    for (const [, loop] of loopsOf(two)) {
        const centre = middle(loop.map((id) => place(SQUARE.get(two.halfedges.get(id).origin))));
        for (const id of loop) {
            const distance = (at) => Math.hypot(at[0] - centre[0], at[1] - centre[1]);
            assert.ok(distance(middle(arrows.get(id))) < distance(middle(arrows.get(id ^ 1))), `${id}`);
        }
    }
});

test('a mesh in one point, far away or huge has a drawing', () => {
    for (const [scale, offset] of [[0, 0], [1, 1e12], [1e300, 0], [1e-300, 0]]) {
        const vertices = new Map([...SQUARE].map(([id, at]) => [id, at.map((value) => value * scale + offset)]));
        const arrows = arrowsOf({ ...two, vertices }, projection([{ ...two, vertices }]));
        for (const number of [...arrows.values()].flat(2)) {
            assert.ok(Number.isFinite(number), `${scale} ${offset}`);
        }
    }
});
