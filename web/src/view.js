// view.js - where the camera stands and where things are on the screen. Pure.
//
// The mesh is within the unit ball and z is up, as in the server's shapes.

export const FIELD_OF_VIEW = 36; // degrees, vertical
export const UP = [0, 0, 1];

// From the middle of the mesh towards the camera of a mesh just opened; length 1.
export const DIRECTION = unit([0.62, -1, 0.58]);

function unit(vector) {
    const length = Math.hypot(...vector);
    return vector.map((value) => value / length);
}

// How far the camera must be for the mesh to fit a canvas of width / height = aspect, in radii of
// the ball around the mesh.
export function fitDistance(aspect) {
    const vertical = Math.tan((FIELD_OF_VIEW * Math.PI) / 360);
    const narrow = Math.atan(vertical * Math.min(aspect, 1));
    return 1.1 / Math.sin(narrow);
}

// How long a CSS pixel of a canvas of a height is at distance 1 of the camera.
export function pixelAtOne(height) {
    return (2 * Math.tan((FIELD_OF_VIEW * Math.PI) / 360)) / height;
}

// The middle of the box of some points.
export function middleOf(points) {
    const [low, high] = [Math.min, Math.max].map((pick) =>
        [0, 1, 2].map((axis) => pick(...points.map((point) => point[axis]))),
    );
    return low.map((value, axis) => (value + high[axis]) / 2);
}

// How far some points reach from a place; 0 where there are none.
export function reachFrom(place, points) {
    const away = (point) => Math.hypot(...point.map((value, i) => value - place[i]));
    return Math.max(0, ...points.map(away));
}

// Less of the side that looks along `normal` than this is too little to see: cosine of the angle.
const LEAST_SEEN = 0.3;

// From where to look, both of length 1: `direction` itself where a side that looks along `normal`
// is seen from there or there is no normal, else one near the normal on the same side of the mesh.
export function turnTo(direction, normal) {
    if (normal === null) {
        return direction;
    }
    const seen = direction.reduce((sum, value, i) => sum + value * normal[i], 0);
    return seen >= LEAST_SEEN
        ? direction
        : unit(normal.map((value, i) => value + 0.5 * (direction[i] - seen * normal[i])));
}

// Clip coordinates [x, y, z, w] of a point; `matrix` is view and projection, column-major.
function toClip(matrix, point) {
    const clip = [0, 0, 0, 0];
    for (let row = 0; row < 4; row++) {
        clip[row] =
            matrix[row] * point[0] +
            matrix[4 + row] * point[1] +
            matrix[8 + row] * point[2] +
            matrix[12 + row];
    }
    return clip;
}

function toScreen(clip, width, height) {
    return [
        ((clip[0] / clip[3] + 1) / 2) * width,
        ((1 - clip[1] / clip[3]) / 2) * height,
    ];
}

// Nearer to the camera's plane than this a point has no place on the screen.
const NEAREST = 1e-6;

// Pixels from (x, y) to a point, Infinity when it is behind the camera.
export function distanceToPoint(matrix, width, height, point, x, y) {
    const clip = toClip(matrix, point);
    if (clip[3] < NEAREST) {
        return Infinity;
    }
    const [px, py] = toScreen(clip, width, height);
    return Math.hypot(px - x, py - y);
}

// Pixels from (x, y) to the part of a segment that is before the camera.
export function distanceToSegment(matrix, width, height, from, to, x, y) {
    let a = toClip(matrix, from);
    let b = toClip(matrix, to);
    if (a[3] < NEAREST && b[3] < NEAREST) {
        return Infinity;
    }
    if (a[3] < NEAREST) {
        a = cutAtCamera(a, b);
    } else if (b[3] < NEAREST) {
        b = cutAtCamera(b, a);
    }
    const [ax, ay] = toScreen(a, width, height);
    const [bx, by] = toScreen(b, width, height);
    const dx = bx - ax;
    const dy = by - ay;
    const length2 = dx * dx + dy * dy;
    const t = length2 > 0 ? ((x - ax) * dx + (y - ay) * dy) / length2 : 0;
    const s = Math.min(Math.max(t, 0), 1);
    return Math.hypot(ax + s * dx - x, ay + s * dy - y);
}

// The point between `behind` and `before` at which the segment meets the camera's plane.
function cutAtCamera(behind, before) {
    const t = (NEAREST - behind[3]) / (before[3] - behind[3]);
    return behind.map((value, i) => value + t * (before[i] - value));
}
