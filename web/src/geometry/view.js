// view.js - computes which part of the mesh the camera sees, and where a point of the mesh appears
// on the screen. Pure.
//
// The mesh is within the unit ball, and the z axis points up, as in the shapes that the server
// makes.

export const FIELD_OF_VIEW = 36; // vertical, in degrees
export const UP = [0, 0, 1];

// The direction from the middle of a newly opened mesh to the camera; length 1.
export const DIRECTION = unit([0.62, -1, 0.58]);

function unit(vector) {
    const length = Math.hypot(...vector);
    return vector.map((value) => value / length);
}

// Returns how far from the middle of a ball the camera must be to see the whole ball in a canvas
// whose width / height is `aspect`; the unit is the radius of the ball.
export function fitDistance(aspect) {
    const vertical = Math.tan((FIELD_OF_VIEW * Math.PI) / 360);
    const narrow = Math.atan(vertical * Math.min(aspect, 1));
    return 1.1 / Math.sin(narrow);
}

// Returns the length that one CSS pixel covers at distance 1 from the camera, for a canvas of this
// height in CSS pixels.
export function pixelAtOne(height) {
    return (2 * Math.tan((FIELD_OF_VIEW * Math.PI) / 360)) / height;
}

// Returns the middle of the bounding box of some points.
export function middleOf(points) {
    const [low, high] = [Math.min, Math.max].map((pick) =>
        [0, 1, 2].map((axis) => pick(...points.map((point) => point[axis]))),
    );
    return low.map((value, axis) => (value + high[axis]) / 2);
}

// Returns the distance from a place to the farthest of some points, or 0 if there are no points.
export function reachFrom(place, points) {
    const away = (point) => Math.hypot(...point.map((value, i) => value - place[i]));
    return Math.max(0, ...points.map(away));
}

// A surface counts as visible if the cosine of the angle between its normal and the direction to
// the camera is at least this.
const LEAST_SEEN = 0.3;

// Returns a direction from which a surface with this normal is visible; all directions are vectors
// of length 1 that point towards the camera. Returns `direction` itself if the surface is visible
// from there, or if `normal` is null; otherwise a direction near the normal that leans towards
// `direction`.
export function turnTo(direction, normal) {
    if (normal === null) {
        return direction;
    }
    const seen = direction.reduce((sum, value, i) => sum + value * normal[i], 0);
    return seen >= LEAST_SEEN
        ? direction
        : unit(normal.map((value, i) => value + 0.5 * (direction[i] - seen * normal[i])));
}

// Returns the matrix, 16 numbers row by row, that maps points of the mesh to clip coordinates.
// `matrix` is the product of projection and view, column-major, for view coordinates; `frame` says
// how the server has made these from the mesh, see geometry.js.
export function clipMatrixOf(matrix, { origin, scale }) {
    return [0, 1, 2, 3].flatMap((row) => {
        const [x, y, z] = [0, 4, 8].map((at) => matrix[at + row] * scale);
        const moved = x * origin[0] + y * origin[1] + z * origin[2];
        return [x, y, z, matrix[12 + row] - moved];
    });
}

// Returns the clip coordinates [x, y, z, w] of a point; `matrix` is the product of projection and
// view, column-major.
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

// A point is on the screen only if it is at least this far in front of the camera.
const NEAREST = 1e-6;

// Returns the distance in pixels from (x, y) to a point; Infinity if that point is behind the
// camera.
export function distanceToPoint(matrix, width, height, point, x, y) {
    const clip = toClip(matrix, point);
    if (clip[3] < NEAREST) {
        return Infinity;
    }
    const [px, py] = toScreen(clip, width, height);
    return Math.hypot(px - x, py - y);
}

// Returns the pixel [x, y] at which a point appears, or null if it is behind the camera.
export function placeOnScreen({ matrix, width, height }, point) {
    const clip = toClip(matrix, point);
    return clip[3] < NEAREST ? null : toScreen(clip, width, height);
}

// Returns the point of a segment that is nearest to (x, y) on the screen, as {x, y, distance} in
// pixels; only the part of the segment in front of the camera counts. Returns null if there is
// none.
export function nearestOnSegment({ matrix, width, height, x, y }, from, to) {
    let a = toClip(matrix, from);
    let b = toClip(matrix, to);
    if (a[3] < NEAREST && b[3] < NEAREST) {
        return null;
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
    const place = { x: ax + s * dx, y: ay + s * dy };
    return { ...place, distance: Math.hypot(place.x - x, place.y - y) };
}

// Returns the distance in pixels from (x, y) on the screen to the part of a segment that is in
// front of the camera; Infinity if it is behind the camera.
export function distanceToSegment(matrix, width, height, from, to, x, y) {
    return nearestOnSegment({ matrix, width, height, x, y }, from, to)?.distance ?? Infinity;
}

// Returns the point where a segment meets the plane at distance NEAREST in front of the camera; its
// end points are `behind` and `before` this plane. All points are in clip coordinates.
function cutAtCamera(behind, before) {
    const t = (NEAREST - behind[3]) / (before[3] - behind[3]);
    return behind.map((value, i) => value + t * (before[i] - value));
}
