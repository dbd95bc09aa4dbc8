// arrows.js - half-edges as flat arrows beside their edges, on the side of their face. Pure.
//
//        from o----------------o to         body: two triangles; head: one
//                 ======>
//              (the face)
//
// An arrow is as long as its edge, but its thickness stops growing when the edge is long on the
// screen. So each point is the sum of a place on the edge and a vector away from it, the point's
// `spread`, which is multiplied by a scale from 0 to 1.

import { normalOfFace, pointAt } from './geometry.js';
import { add, cross, subtract, unit } from './vectors.js';

// Where an arrow begins and ends along its edge, as fractions of the edge's length.
const START = 0.16;
const END = 0.84;
// The distance of an arrow from its edge, and its widths, as fractions of the edge's length; if the
// face is thin, they are fractions of a smaller length.
const OFFSET = 0.1;
const HEAD = 0.15;
const BODY_WIDTH = 0.022;
const HEAD_WIDTH = 0.068;
const THIN = 2.2; // the length they are parts of is at most this times the mean width of the face

// An arrow is at most as thick as the arrow of an edge that is this many CSS pixels long.
export const MOST_PIXELS = 130;

// Returns the arrow of a half-edge as nine points (three triangles): {size, places, spreads}; null
// if the edge has length 0 or the face has no normal. `halfedge` is {origin, target, face, across};
// `across` is the face of its twin, in whose plane the arrow of a boundary half-edge is drawn.
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
    const [start, end] = [START, END].map((t) => add(from, edge, t));
    const spread = (back, side) =>
        add(
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

// Returns the points of an arrow whose spreads are multiplied by `scale`.
export function pointsOf({ places, spreads }, scale) {
    return places.map((place, i) => add(place, spreads[i], scale));
}

// Returns the middle of an arrow's body, the point where tests check the arrow's colour.
export function middleOf(arrow, scale) {
    const [first, , third] = pointsOf(arrow, scale);
    return add(first, subtract(third, first), 0.5);
}
