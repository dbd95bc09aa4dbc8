// layout.js - where the vertices and half-edges of a state (see region.js) are in a flat drawing.
// Pure.
//
// The drawing looks along the average normal of the faces. Each half-edge is an arrow beside its
// edge, on the side of its face.

import { add, cross, dot, scale, subtract, unit } from '../geometry/vectors.js';

// The size of the drawing, and the free space at its border.
export const WIDTH = 640;
export const HEIGHT = 420;
const MARGIN = 46;

// How far an arrow lies beside its edge, and how much shorter it is at each end, as fractions of the
// edge's length, and the most of each in the units of the drawing.
const BESIDE = 0.05;
const SHORTER = 0.14;
const MOST_BESIDE = 9;
const MOST_SHORTER = 30;

// Returns a function from a position in space to a point [x, y] of the drawing, in which all vertices
// of the states fit.
export function projection(states) {
    const points = states.flatMap(({ vertices }) => [...vertices.values()]);
    const low = [0, 1, 2].map((i) => Math.min(...points.map((point) => point[i])));
    const high = [0, 1, 2].map((i) => Math.max(...points.map((point) => point[i])));
    const centre = low.map((value, i) => value / 2 + high[i] / 2);
    const size = Math.max(...high.map((value, i) => value - low[i])) || 1;
    const local = (point) => scale(subtract(point, centre), 1 / size);
    const normal =
        unit(
            states
                .flatMap((state) => [...loopsOf(state).values()].map((loop) => areaOf(state, loop, local)))
                .reduce((sum, area) => add(sum, area), [0, 0, 0]),
        ) ?? [0, 0, 1];
    // The drawing is upright where the view is: the vertical axis is z, or y for what lies flat.
    const up = Math.abs(normal[2]) > 0.9 ? [0, 1, 0] : [0, 0, 1];
    const right = unit(cross(up, normal));
    const above = cross(normal, right);
    const flat = (point) => {
        const at = local(point);
        return [dot(at, right), -dot(at, above)];
    };
    const drawn = points.map(flat);
    const box = [0, 1].map((i) => [
        Math.min(...drawn.map((at) => at[i])),
        Math.max(...drawn.map((at) => at[i])),
    ]);
    const spans = box.map(([from, to]) => to - from);
    const factor = Math.min(
        (WIDTH - 2 * MARGIN) / (spans[0] || 1e-9),
        (HEIGHT - 2 * MARGIN) / (spans[1] || 1e-9),
        1e6,
    );
    return (point) => {
        const at = flat(point);
        return [0, 1].map((i) => {
            const middle = box[i][0] / 2 + box[i][1] / 2;
            return [WIDTH, HEIGHT][i] / 2 + (at[i] - middle) * factor;
        });
    };
}

// Returns twice the area of a loop as a vector along its normal.
function areaOf({ halfedges, vertices }, loop, local) {
    const corners = loop.map((id) => local(vertices.get(halfedges.get(id).origin)));
    return corners
        .map((corner, i) => cross(corner, corners[(i + 1) % corners.length]))
        .reduce((sum, part) => add(sum, part), [0, 0, 0]);
}

// Returns the loops of half-edges that are whole: a map from faces to lists of half-edges, in the
// order of next.
export function loopsOf({ halfedges }) {
    const loops = new Map();
    for (const [first, { face }] of halfedges) {
        if (face === null || loops.has(face)) {
            continue;
        }
        const loop = [];
        let at = first;
        do {
            loop.push(at);
            at = halfedges.get(at)?.next;
        } while (at !== first && halfedges.get(at)?.face === face && loop.length <= halfedges.size);
        if (at === first) {
            loops.set(face, loop);
        }
    }
    return loops;
}

// Returns the arrows of a state: a map from half-edges to [[x, y], [x, y]]. `place` is a projection.
export function arrowsOf(state, place) {
    const { halfedges, vertices } = state;
    const points = new Map([...vertices].map(([id, position]) => [id, place(position)]));
    const sides = sidesOf(state, points);
    const arrows = new Map();
    for (const [id, { origin }] of halfedges) {
        const target = halfedges.get(id ^ 1)?.origin;
        const [from, to] = [points.get(origin), points.get(target)];
        if (from !== undefined && to !== undefined) {
            arrows.set(id, arrow(from, to, sides.get(id) ?? sides.get(id ^ 1) ?? 1));
        }
    }
    return arrows;
}

// Returns on which side of its edge each half-edge of a whole loop lies: 1 is left of its direction,
// as one sees it, and -1 is right, which is so for faces that are seen from behind.
function sidesOf(state, points) {
    const sides = new Map();
    for (const loop of loopsOf(state).values()) {
        const corners = loop.map((id) => points.get(state.halfedges.get(id).origin));
        const area = corners
            .map(([x, y], i) => {
                const [u, v] = corners[(i + 1) % corners.length];
                return x * v - u * y;
            })
            .reduce((sum, part) => sum + part, 0);
        // The y axis of the drawing points down, so loops that are seen from the front have a
        // negative area.
        loop.forEach((id) => sides.set(id, area > 0 ? -1 : 1));
    }
    return sides;
}

function arrow(from, to, side) {
    const along = subtract(to, from);
    const length = Math.hypot(...along) || 1;
    const [x, y] = scale(along, 1 / length);
    const beside = side * Math.min(MOST_BESIDE, BESIDE * length + 2);
    const shorter = Math.min(MOST_SHORTER, SHORTER * length);
    return [
        [from[0] + y * beside + x * shorter, from[1] - x * beside + y * shorter],
        [to[0] + y * beside - x * shorter, to[1] - x * beside - y * shorter],
    ];
}
