// region.js - finds the elements that are inside a part of the picture: a polygon, or the path of a
// brush. Pure.
//
// A mask is {width, height, bits}: a Uint8Array with 1 for each pixel of the part, row by row from
// the top. An element is inside if its middle is: the mean of its corners. It is visible if no
// triangle hides its middle; `shown` says for each pixel which triangle is visible there, or -1.

import { faceOf } from './geometry.js';
import { noneOf } from './sets.js';
import { topologyOf } from './topology.js';

export function emptyMask(width, height) {
    return { width, height, bits: new Uint8Array(width * height) };
}

// Returns the mask of a polygon, given by its corners [x, y] in pixels. A polygon that intersects
// itself contains everything that it winds around.
export function polygonMask(corners, width, height) {
    const mask = emptyMask(width, height);
    const crossings = Array.from({ length: height }, () => []);
    corners.forEach(([ax, ay], i) => {
        const [bx, by] = corners[(i + 1) % corners.length];
        const first = Math.max(Math.ceil(Math.min(ay, by) - 0.5), 0);
        const last = Math.min(Math.ceil(Math.max(ay, by) - 0.5), height);
        for (let y = first; y < last; y++) {
            const x = ax + ((y + 0.5 - ay) * (bx - ax)) / (by - ay);
            crossings[y].push([x, by > ay ? 1 : -1]);
        }
    });
    crossings.forEach((row, y) => {
        row.sort(([a], [b]) => a - b);
        let winding = 0;
        row.forEach(([x, sense], i) => {
            winding += sense;
            if (winding !== 0) {
                const begin = Math.min(Math.max(Math.ceil(x - 0.5), 0), width);
                const end = Math.min(Math.max(Math.ceil(row[i + 1][0] - 0.5), 0), width);
                mask.bits.fill(1, y * width + begin, y * width + end);
            }
        });
    });
    return mask;
}

// Adds the pixels within `radius` of a segment to a mask, and calls act(pixel) for each of them.
export function stamp(mask, [ax, ay], [bx, by], radius, act = () => {}) {
    const { width, height, bits } = mask;
    const [dx, dy] = [bx - ax, by - ay];
    const square = dx * dx + dy * dy;
    const low = (a, b) => Math.max(Math.floor(Math.min(a, b) - radius), 0);
    const high = (a, b, most) => Math.min(Math.ceil(Math.max(a, b) + radius), most);
    for (let y = low(ay, by); y < high(ay, by, height); y++) {
        for (let x = low(ax, bx); x < high(ax, bx, width); x++) {
            const [px, py] = [x + 0.5 - ax, y + 0.5 - ay];
            const t = square > 0 ? Math.min(Math.max((px * dx + py * dy) / square, 0), 1) : 0;
            if (Math.hypot(px - t * dx, py - t * dy) <= radius) {
                bits[y * width + x] = 1;
                act(y * width + x);
            }
        }
    }
}

// Returns the set of the elements inside a mask. `matrix` is the product of projection and view,
// column-major. `shown` is null if hidden elements count, too.
export function inside(kind, geometry, { matrix, mask, shown }) {
    const set = noneOf(kind, geometry);
    const clip = clipOf(geometry, matrix);
    const test = (x, y, w) => isInside(x, y, w, { geometry, clip, mask, shown });
    if (kind === 'vertex') {
        for (let id = 0; id < set.length; id++) {
            const at = 3 * id;
            const isThere = geometry.vertices[4 * id + 3] !== 0;
            set[id] = isThere && test(clip[at], clip[at + 1], clip[at + 2]) ? 1 : 0;
        }
    } else if (kind === 'edge') {
        const { from, to } = topologyOf(geometry);
        for (let edge = 0; edge < set.length; edge++) {
            const [a, b] = [3 * from[edge], 3 * to[edge]];
            const [x, y, w] = [0, 1, 2].map((i) => (clip[a + i] + clip[b + i]) / 2);
            set[edge] = test(x, y, w) ? 1 : 0;
        }
    } else {
        eachMiddle(geometry, clip, (face, x, y, w) => {
            set[face] = test(x, y, w) ? 1 : 0;
        });
    }
    return set;
}

// Returns x, y and w of the clip coordinates of all vertices.
function clipOf({ vertices, vertexCount }, matrix) {
    const clip = new Float64Array(3 * vertexCount);
    const rows = [0, 1, 3].map((row) => [0, 4, 8, 12].map((at) => matrix[at + row]));
    for (let id = 0; id < vertexCount; id++) {
        const [x, y, z] = [vertices[4 * id], vertices[4 * id + 1], vertices[4 * id + 2]];
        for (let row = 0; row < 3; row++) {
            const [a, b, c, d] = rows[row];
            clip[3 * id + row] = a * x + b * y + c * z + d;
        }
    }
    return clip;
}

// Calls act(face, x, y, w) with the mean of the clip coordinates of each face's corners. The
// triangles of a face are consecutive, and each corner begins one of the face's edges.
function eachMiddle({ triangles, triangleCount }, clip, act) {
    let [face, corners, x, y, w] = [-1, 0, 0, 0, 0];
    const end = () => corners > 0 && act(face, x / corners, y / corners, w / corners);
    for (let i = 0; i < triangleCount; i++) {
        const at = 4 * i;
        if (triangles[at] === triangles[at + 1]) {
            continue;
        }
        if (faceOf(triangles, i) !== face) {
            end();
            [face, corners, x, y, w] = [faceOf(triangles, i), 0, 0, 0, 0];
        }
        const sides = triangles[at + 3] >>> 29;
        for (let side = 0; side < 3; side++) {
            if (((sides >>> side) & 1) === 1) {
                const corner = 3 * triangles[at + side];
                corners++;
                x += clip[corner];
                y += clip[corner + 1];
                w += clip[corner + 2];
            }
        }
    }
    end();
}

// A place counts as hidden only if a triangle is nearer by more than this fraction of the distance
// to the camera.
const SLACK = 5e-4;

// If a triangle is smaller than this on the screen, in pixels, its own depth counts as slack: then
// the pixel may show a neighbour of the triangle that has the place.
const TINY = 4;

function isInside(x, y, w, { geometry, clip, mask, shown }) {
    if (w <= 0) {
        return false;
    }
    const column = Math.floor(((x / w + 1) / 2) * mask.width);
    const row = Math.floor(((1 - y / w) / 2) * mask.height);
    if (column < 0 || row < 0 || column >= mask.width || row >= mask.height) {
        return false;
    }
    const pixel = row * mask.width + column;
    if (mask.bits[pixel] === 0) {
        return false;
    }
    const triangle = shown === null ? -1 : shown[pixel];
    return triangle < 0 || w <= depthAt(geometry, clip, triangle, x / w, y / w, mask);
}

// Returns how far from the camera a place may be that is not hidden by a triangle: the depth of the
// triangle's plane at a point of the screen, -1 to 1, and the slack. The triangle's barycentric
// coordinates there are a cross product of its clip coordinates, so that corners behind the camera
// do no harm.
function depthAt({ triangles }, clip, triangle, nx, ny, mask) {
    const corners = [0, 1, 2].map((i) => 3 * triangles[4 * triangle + i]);
    const u = corners.map((at) => clip[at] - nx * clip[at + 2]);
    const v = corners.map((at) => clip[at + 1] - ny * clip[at + 2]);
    const depths = corners.map((at) => clip[at + 2]);
    const parts = [0, 1, 2].map((i) => {
        const [j, k] = [(i + 1) % 3, (i + 2) % 3];
        return u[j] * v[k] - u[k] * v[j];
    });
    const sum = parts[0] + parts[1] + parts[2];
    const [low, high] = [Math.min(...depths), Math.max(...depths)];
    const exact = (parts[0] * depths[0] + parts[1] * depths[1] + parts[2] * depths[2]) / sum;
    const depth = sum === 0 ? high : Math.min(Math.max(exact, low), high);
    const reach = Math.max(...u.map(Math.abs)) * mask.width + Math.max(...v.map(Math.abs)) * mask.height;
    const isTiny = reach < 2 * TINY * depth;
    return depth * (1 + SLACK) + (isTiny ? high - low : 0);
}
