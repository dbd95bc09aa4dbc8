// arrows.js - half-edges as flat arrows beside their edges, on the side of their face. Pure.
//
//        from o----------------o to         body: two triangles; head: one
//                 ======>
//              (the face)
//
// An arrow is as long as its edge, but its thickness stops growing where the edge is long on the
// screen. So each point is a place on the edge and a `spread` from there, which is drawn at a scale
// from 0 to 1.

import { normalOfFace, pointAt } from './geometry.js';

// Along the edge in parts of its length.
const START = 0.16;
const END = 0.84;
// The rest in parts of that too, or of less where the face is thin.
const OFFSET = 0.1;
const HEAD = 0.15;
const BODY_WIDTH = 0.022;
const HEAD_WIDTH = 0.068;
const THIN = 2.2; // of the face's mean width

// Arrows are no thicker than that of an edge of so many pixels.
export const MOST_PIXELS = 130;

const subtract = (a, b) => a.map((value, i) => value - b[i]);
const along = (a, b, t) => a.map((value, i) => value + t * b[i]);

function cross(a, b) {
    return [0, 1, 2].map((i) => {
        const [u, v] = [(i + 1) % 3, (i + 2) % 3];
        return a[u] * b[v] - a[v] * b[u];
    });
}

function unit(a) {
    const length = Math.hypot(...a);
    return length > 0 ? a.map((value) => value / length) : null;
}

// Nine points a half-edge, three triangles, as {size, places, spreads}; null where there is no
// length or no plane. `halfedge` is {origin, target, face, across}, where `across` is the face of
// its twin: a boundary half-edge lies in that one's plane.
export function arrowOf(geometry, { origin, target, face, across }) {
    const from = pointAt(geometry, origin);
    const edge = subtract(pointAt(geometry, target), from);
    const area = normalOfFace(geometry, face ?? across);
    const normal = unit(area);
    const left = normal && unit(cross(normal, edge));
    if (!left) {
        return null;
    }
    const length = Math.hypot(...edge);
    const size = Math.min(length, (THIN * Math.hypot(...area)) / 2 / length);
    const [start, end] = [START, END].map((t) => along(from, edge, t));
    const spread = (back, side) =>
        along(
            edge.map((value) => (-back * size * value) / length),
            left,
            (OFFSET + side) * size,
        );
    const body = [
        [start, spread(0, -BODY_WIDTH)],
        [end, spread(HEAD, -BODY_WIDTH)],
        [end, spread(HEAD, BODY_WIDTH)],
        [start, spread(0, BODY_WIDTH)],
    ];
    const points = [
        ...[body[0], body[1], body[2]],
        ...[body[0], body[2], body[3]],
        ...[[end, spread(HEAD, -HEAD_WIDTH)], [end, spread(0, 0)], [end, spread(HEAD, HEAD_WIDTH)]],
    ];
    return {
        size,
        places: points.map(([place]) => place),
        spreads: points.map(([, away]) => away),
    };
}

// The points of an arrow at a scale.
export function pointsOf({ places, spreads }, scale) {
    return places.map((place, i) => along(place, spreads[i], scale));
}

// Where the middle of an arrow's body is, for whoever looks for its colour.
export function middleOf(arrow, scale) {
    const [first, , third] = pointsOf(arrow, scale);
    return along(first, subtract(third, first), 0.5);
}
