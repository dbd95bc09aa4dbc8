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
