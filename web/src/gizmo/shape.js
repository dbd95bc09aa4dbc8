// shape.js - where the handles of the gizmo are on the screen. Pure.
//
// The gizmo has for each axis an arrow, which moves, a box, which scales, and a ring, which rotates,
// and in its middle a disc, which scales evenly. Its size on the screen is always the same. Places
// are in view coordinates, see geometry.js.

import { add, dot } from '../geometry/vectors.js';
import { pixelAtOne, placeOnScreen } from '../geometry/view.js';

// Sizes in CSS pixels, at the distance of the middle: where arrows begin and end, where boxes are,
// and the radius of the rings.
export const SIZES = { begin: 14, tip: 74, box: 112, ring: 92 };

const STEPS = 48; // corners of a ring

export const AXES = [
    [1, 0, 0],
    [0, 1, 0],
    [0, 0, 1],
];

// Returns the length of a CSS pixel at a place, in view coordinates; 0 if the place is behind the
// camera. `view` is Renderer.view.
export function pixelAt(place, view) {
    const depth = -dot(add(place, view.position, -1), view.back);
    return pixelAtOne(view.height) * Math.max(depth, 0);
}

// Returns the handles around a place, or null if it is behind the camera: {middle, arrows, boxes,
// rings}. An arrow is [begin, tip], a box its middle, and a ring is a list of pieces, each a list of
// points; only the half of a ring that is in front is included. `screen` is {matrix, width, height},
// points are in CSS pixels. An axis that points at the viewer has no arrow and no box: they are null.
export function handlesAt(place, view, screen) {
    const pixel = pixelAt(place, view);
    const middle = pixel > 0 ? placeOnScreen(screen, place) : null;
    if (middle === null) {
        return null;
    }
    const on = (axis, pixels) => placeOnScreen(screen, add(place, AXES[axis], pixels * pixel));
    const lines = AXES.map((_, axis) => {
        const ends = [SIZES.begin, SIZES.tip, SIZES.box].map((pixels) => on(axis, pixels));
        const isSeen =
            !ends.includes(null) &&
            Math.hypot(ends[1][0] - middle[0], ends[1][1] - middle[1]) > SIZES.begin;
        return isSeen ? ends : null;
    });
    return {
        middle,
        arrows: lines.map((ends) => ends && ends.slice(0, 2)),
        boxes: lines.map((ends) => ends && ends[2]),
        rings: AXES.map((_, axis) => ringAround(axis, place, pixel * SIZES.ring, { view, screen })),
    };
}

function ringAround(axis, place, radius, { view, screen }) {
    const [u, v] = [AXES[(axis + 1) % 3], AXES[(axis + 2) % 3]];
    const towards = add(view.position, place, -1);
    const pieces = [];
    let piece = [];
    for (let step = 0; step <= STEPS; step++) {
        const angle = (2 * Math.PI * step) / STEPS;
        const out = u.map((value, i) => Math.cos(angle) * value + Math.sin(angle) * v[i]);
        const isFront = dot(out, towards) >= -1e-6 * Math.hypot(...towards);
        const point = isFront ? placeOnScreen(screen, add(place, out, radius)) : null;
        if (point !== null) {
            piece.push(point);
        } else if (piece.length > 0) {
            pieces.push(piece);
            piece = [];
        }
    }
    return [...pieces, piece].filter(({ length }) => length > 1);
}
