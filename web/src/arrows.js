// arrows.js - half-edges as flat arrows beside their edges, on the side of their face. Pure.
//
//        from o----------------o to         body: two triangles; head: one
//                 ======>
//              (the face)

import { normalOfFace, pointAt } from './geometry.js';

// Along the edge in parts of its length; what is across in those too, or less where the face is thin.
const OFFSET = 0.11;
const START = 0.16;
const END = 0.84;
const HEAD = 0.16;
const BODY_WIDTH = 0.028;
const HEAD_WIDTH = 0.08;
const THIN = 2.2; // of the face's mean width

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

// Nine points a half-edge, three triangles. `halfedge` is {origin, target, face, across}, where
// `across` is the face of its twin: a boundary half-edge lies in that one's plane. Empty where there
// is no length or no plane.
export function arrowOf(geometry, { origin, target, face, across }) {
    const from = pointAt(geometry, origin);
    const edge = subtract(pointAt(geometry, target), from);
    const area = normalOfFace(geometry, face ?? across);
    const normal = unit(area);
    const left = normal && unit(cross(normal, edge));
    if (!left) {
        return [];
    }
    const length = Math.hypot(...edge);
    const size = Math.min(length, (THIN * Math.hypot(...area)) / 2 / length);
    const at = (t, side) => along(along(from, edge, t), left, size * (OFFSET + side));
    const neck = END - (HEAD * size) / length;
    const body = [
        at(START, -BODY_WIDTH),
        at(neck, -BODY_WIDTH),
        at(neck, BODY_WIDTH),
        at(START, BODY_WIDTH),
    ];
    return [
        body[0], body[1], body[2],
        body[0], body[2], body[3],
        at(neck, -HEAD_WIDTH), at(END, 0), at(neck, HEAD_WIDTH),
    ];
}

// Where the middle of an arrow's body is, for whoever looks for its colour.
export function middleOf(geometry, halfedge) {
    const points = arrowOf(geometry, halfedge);
    return points.length === 0 ? null : along(points[0], subtract(points[2], points[0]), 0.5);
}
