// pull.js - computes what a drag of one of the gizmo's handles does: a movement, a rotation or a
// scaling. Pure.
//
// A change is {move, rotate, scale}: a vector in view coordinates, angles around the axes in degrees,
// and factors, as compose() in affine.js takes them.

import { add, cross, dot } from '../geometry/vectors.js';
import { pixelAtOne } from '../geometry/view.js';
import { AXES, SIZES, pixelAt } from './shape.js';

export const NOTHING = Object.freeze({ move: [0, 0, 0], rotate: [0, 0, 0], scale: [1, 1, 1] });

// If the plane of a ring is seen at a smaller angle than this (its sine), the pointer's way along the
// ring counts, and not the place where it meets the plane.
const LEAST_SEEN = 0.15;

// A scaling never makes anything smaller than this.
const LEAST_SCALE = 0.01;

// With Ctrl held, angles are multiples of SNAP_ANGLE degrees, and factors of SNAP_SCALE.
const SNAP_ANGLE = 15;
const SNAP_SCALE = 0.1;

// Returns the ray from the camera through a point of the canvas, {from, along}. `view` is
// Renderer.view with `width`.
function rayAt([x, y], view) {
    const pixel = pixelAtOne(view.height);
    const right = (x - view.width / 2) * pixel;
    const up = (view.height / 2 - y) * pixel;
    const along = add(add(view.back.map((value) => -value), view.right, right), view.up, up);
    return { from: view.position, along };
}

// Returns where on a line the point is that is nearest to the ray through a point of the canvas, as a
// multiple of the line's direction, a vector of length 1; null if the ray is parallel to the line.
function alongLine(place, direction, point, view) {
    const { from, along } = rayAt(point, view);
    const between = add(from, place, -1);
    const [b, c] = [dot(direction, along), dot(along, along)];
    const [d, e] = [dot(direction, between), dot(along, between)];
    const divisor = c - b * b;
    return divisor < 1e-9 * c ? null : (c * d - b * e) / divisor;
}

// Returns the angle of a point of the canvas around an axis, in degrees, as seen from the tip of the
// axis; null if the plane of the ring is seen too much from the side.
function angleAround(place, axis, point, view) {
    const normal = AXES[axis];
    const { from, along } = rayAt(point, view);
    const slope = dot(along, normal) / Math.hypot(...along);
    if (Math.abs(slope) < LEAST_SEEN) {
        return null;
    }
    const t = dot(add(place, from, -1), normal) / dot(along, normal);
    const out = add(add(from, along, t), place, -1);
    const [u, v] = [AXES[(axis + 1) % 3], AXES[(axis + 2) % 3]];
    return (Math.atan2(dot(out, v), dot(out, u)) * 180) / Math.PI;
}

const snapped = (value, step, isOn) => (isOn ? Math.round(value / step) * step : value);

// Returns the change that a drag makes. `handle` is {kind, axis}: 'arrow', 'box', 'ring' or 'disc',
// and 0 to 2; `place` is the gizmo's middle, `from` and `to` are points of the canvas in CSS pixels,
// and `view` is Renderer.view with the `width` of the canvas. `isSnapped` says that Ctrl is held.
export function pull({ kind, axis }, { place, from, to, view, isSnapped }) {
    const change = { move: [0, 0, 0], rotate: [0, 0, 0], scale: [1, 1, 1] };
    if (kind === 'ring') {
        change.rotate[axis] = snapped(turn(axis, { place, from, to, view }), SNAP_ANGLE, isSnapped);
        return change;
    }
    if (kind === 'disc') {
        const factor = Math.exp((to[0] - from[0] - (to[1] - from[1])) / SIZES.ring);
        change.scale.fill(scaleOf(factor, isSnapped));
        return change;
    }
    const [begin, end] = [from, to].map((point) => alongLine(place, AXES[axis], point, view));
    if (begin === null || end === null) {
        return change;
    }
    if (kind === 'arrow') {
        change.move[axis] = end - begin;
    } else if (begin !== 0) {
        change.scale[axis] = scaleOf(end / begin, isSnapped);
    }
    return change;
}

function scaleOf(factor, isSnapped) {
    return Math.max(snapped(factor, SNAP_SCALE, isSnapped), isSnapped ? SNAP_SCALE : LEAST_SCALE);
}

// Returns the angle in degrees, -180 to 180, by which a drag turns around an axis.
function turn(axis, { place, from, to, view }) {
    const [begin, end] = [from, to].map((point) => angleAround(place, axis, point, view));
    if (begin !== null && end !== null) {
        return ((((end - begin + 180) % 360) + 360) % 360) - 180;
    }
    // Seen from the side, the front of the ring is a line on the screen, along which the pointer goes.
    const towards = add(view.position, place, -1);
    const way = cross(AXES[axis], towards);
    const seen = [dot(way, view.right), -dot(way, view.up)];
    const length = Math.hypot(...seen) || 1;
    const pixels = ((to[0] - from[0]) * seen[0] + (to[1] - from[1]) * seen[1]) / length;
    const radius = SIZES.ring * pixelAt(place, view);
    return ((pixels * pixelAt(place, view)) / radius) * (180 / Math.PI);
}
