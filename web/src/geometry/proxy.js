// proxy.js - few triangles that stand for those of a large mesh while the camera moves. Pure.
//
// The cube around the unit ball is divided into cells. All vertices in a cell are replaced by the one
// that is nearest to their mean, and only triangles with corners in three cells remain (J. Rossignac
// and P. Borrel, Multi-resolution 3D approximations for rendering complex scenes, 1993). Since the
// corners are vertices of the mesh and each triangle names a face of the mesh, everything that is
// drawn by vertex or by face fits the proxy, too.

import { wholeRows } from './geometry.js';

const PAUSE = 8192;

// Number of cells along each axis: a surface that fills the view has some ten thousand triangles.
const CELLS = 96;

// A proxy with more than this part of the triangles is not worth its memory.
const MOST = 1 / 4;

// If more cells have vertices, the mesh is no surface that a proxy could stand for. The product of
// three such numbers is exact.
const MOST_USED = 2 ** 17;

const SIDES = 7 << 29; // all sides are edges, see geometry.js

// A generator for inSlices() that returns {triangles, triangleCount} in the format of geometry.js,
// or null if the mesh has too few triangles for its size.
export function* proxyOf(geometry) {
    const { cells, means } = yield* meansOf(geometry);
    const { nearest, ranks, used } = yield* nearestTo(geometry, cells, means);
    const { triangles, triangleCount } = geometry;
    const most = used <= MOST_USED ? MOST * triangleCount : 0;
    const found = [];
    const seen = new Set();
    for (let i = 0; i < 4 * triangleCount; i += 4) {
        if (i % (4 * PAUSE) === 0) {
            yield;
        }
        const a = cells[triangles[i]];
        const b = cells[triangles[i + 1]];
        const c = cells[triangles[i + 2]];
        if (a !== b && b !== c && c !== a) {
            const key = keyOf(ranks[a], ranks[b], ranks[c]);
            if (!seen.has(key)) {
                seen.add(key);
                found.push(nearest[a], nearest[b], nearest[c], triangles[i + 3] | SIDES);
            }
            if (seen.size > most) {
                return null;
            }
        }
    }
    return { triangles: wholeRows(Uint32Array.from(found)), triangleCount: seen.size };
}

// Returns a number that triangles have in common if their corners are the same and go round in the same
// direction. A corner is given by the rank of its cell.
function keyOf(a, b, c) {
    const [i, j, k] = a < b && a < c ? [a, b, c] : b < c ? [b, c, a] : [c, a, b];
    return (i * MOST_USED + j) * MOST_USED + k;
}

const cellOf = (value) => Math.min(Math.max(Math.floor(((value + 1) / 2) * CELLS), 0), CELLS - 1);

// Returns the cell of each vertex, and for each cell the sum of the coordinates of its vertices and
// their number.
function* meansOf({ vertices, vertexCount }) {
    const cells = new Uint32Array(vertexCount);
    const means = new Float64Array(4 * CELLS ** 3);
    for (let i = 0; i < vertexCount; i++) {
        if (i % PAUSE === 0) {
            yield;
        }
        const [x, y, z] = [vertices[4 * i], vertices[4 * i + 1], vertices[4 * i + 2]];
        const cell = (cellOf(x) * CELLS + cellOf(y)) * CELLS + cellOf(z);
        cells[i] = cell;
        if (vertices[4 * i + 3] !== 0) {
            means[4 * cell] += x;
            means[4 * cell + 1] += y;
            means[4 * cell + 2] += z;
            means[4 * cell + 3]++;
        }
    }
    return { cells, means };
}

// Returns for each cell the vertex that is nearest to the mean, and the rank of the cell among those
// with vertices, whose number is `used`.
function* nearestTo({ vertices, vertexCount }, cells, means) {
    const nearest = new Uint32Array(CELLS ** 3);
    const ranks = new Uint32Array(CELLS ** 3);
    const least = new Float32Array(CELLS ** 3).fill(Infinity);
    let used = 0;
    for (let i = 0; i < vertexCount; i++) {
        if (i % PAUSE === 0) {
            yield;
        }
        if (vertices[4 * i + 3] !== 0) {
            const cell = cells[i];
            const count = means[4 * cell + 3];
            const x = vertices[4 * i] - means[4 * cell] / count;
            const y = vertices[4 * i + 1] - means[4 * cell + 1] / count;
            const z = vertices[4 * i + 2] - means[4 * cell + 2] / count;
            const square = x * x + y * y + z * z;
            if (least[cell] === Infinity) {
                ranks[cell] = used++;
            }
            if (square < least[cell]) {
                least[cell] = square;
                nearest[cell] = i;
            }
        }
    }
    return { nearest, ranks, used };
}
