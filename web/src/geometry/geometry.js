// geometry.js - the arrays from which a mesh is drawn, as GET .../geometry sends them. Pure: no
// page, no network, no WebGL.
//
//   vertices   4 floats each:  x, y, z, state (0 if deleted, VERTEX_USED or VERTEX_ISOLATED)
//   triangles  4 words each:   corners a, b, c, and face | sides << 29
//
// Both arrays fill a texture that is ROW texels wide, so that the renderer uploads them unchanged.
// Entries beyond vertexCount and triangleCount are zero.
//
//            c              bit 29: a -> b is an edge of the polygon
//           / \             bit 30: b -> c
//          a---b            bit 31: c -> a
//                           a bit that is clear marks a diagonal, which is not drawn
//
// The index of a vertex is its id. The triangles of a face are consecutive; faces are in no
// particular order; a slot without a face is four zeros. The server moves and scales positions into
// the unit ball ("view coordinates") before rounding them to floats, so that meshes far from the
// origin or of any size are drawn correctly; `frame` has the offset and the scale. As long as the
// number `layout` is the same, faces keep their slots and the frame stays, so that changes can be
// applied to the arrays: see geometry_delta.js.

export const VERTEX_USED = 1;
export const VERTEX_ISOLATED = 2;

// Number of texels in a row of a texture; every WebGL2 allows 2048.
export const ROW = 2048;

export const HEADER_BYTES = 96;
const VERSION = 2;
const SIDE_SHIFT = 29;
const FACE_MASK = 2 ** SIDE_SHIFT - 1;

// Reads the header of an answer, an ArrayBuffer, and returns {revision, base, layout, vertexCount,
// triangleCount, length}. `base` is the revision to which the answer is a change, or 0 if the
// answer contains all rows; `length` is the number of bytes of the whole answer. Throws a
// RangeError if the header is invalid.
export function headerOf(buffer) {
    const view = new DataView(buffer);
    const text = String.fromCharCode(...new Uint8Array(buffer, 0, 4));
    if (text !== 'HEDG' || view.getUint32(4, true) !== VERSION) {
        throw new RangeError('This page cannot read the geometry that the server sent.');
    }
    const [revision, base, vertexBytes, triangleBytes, layout] = [8, 16, 24, 32, 80].map((at) =>
        Number(view.getBigUint64(at, true)),
    );
    const [vertexCount, triangleCount] = [40, 44].map((at) => view.getUint32(at, true));
    const length = HEADER_BYTES + vertexBytes + triangleBytes;
    return { revision, base, layout, vertexCount, triangleCount, length };
}

// Reads an answer that contains all rows, an ArrayBuffer, and returns {revision, layout, frame,
// vertices, vertexCount, triangles, triangleCount, firstOf, hasIsolated}. `firstOf` says where the
// triangles of each face begin, see below. Throws a RangeError if the answer is invalid.
export function unpack(buffer) {
    const { revision, base, layout, vertexCount, triangleCount, length } = headerOf(buffer);
    const trianglesAt = HEADER_BYTES + 16 * vertexCount;
    if (base !== 0 || ![length, trianglesAt + 16 * triangleCount].every(isLengthOf(buffer))) {
        throw new RangeError('The geometry of the mesh did not arrive completely.');
    }
    const view = new DataView(buffer);
    const vertices = wholeRows(new Float32Array(buffer, HEADER_BYTES, 4 * vertexCount));
    const triangles = wholeRows(new Uint32Array(buffer, trianglesAt, 4 * triangleCount));
    return {
        revision,
        layout,
        frame: {
            origin: [48, 56, 64].map((at) => view.getFloat64(at, true)),
            scale: view.getFloat64(72, true),
        },
        vertices,
        vertexCount,
        triangles,
        triangleCount,
        firstOf: firstsOf(triangles, triangleCount),
        hasIsolated: hasIsolated(vertices),
    };
}

const isLengthOf = (buffer) => (length) => length === buffer.byteLength;

// Returns a copy of an array, extended by zeros to a whole number of texture rows, at least one.
export function wholeRows(array) {
    const rows = Math.max(Math.ceil(array.length / (4 * ROW)), 1);
    const whole = new array.constructor(4 * ROW * rows);
    whole.set(array);
    return whole;
}

// Returns a ball around all vertices that are not deleted: the middle of their bounding box, and
// the distance from there to the farthest vertex. The radius is never 0, because the camera must
// stand outside the ball.
export function ballOf({ vertices }) {
    const low = [Infinity, Infinity, Infinity];
    const high = [-Infinity, -Infinity, -Infinity];
    for (let i = 0; i < vertices.length; i += 4) {
        if (vertices[i + 3] !== 0) {
            for (let axis = 0; axis < 3; axis++) {
                low[axis] = Math.min(low[axis], vertices[i + axis]);
                high[axis] = Math.max(high[axis], vertices[i + axis]);
            }
        }
    }
    if (low[0] > high[0]) {
        return { center: [0, 0, 0], radius: 1 };
    }
    const center = low.map((value, axis) => (value + high[axis]) / 2);
    const [x, y, z] = center;
    let square = 0;
    for (let i = 0; i < vertices.length; i += 4) {
        if (vertices[i + 3] !== 0) {
            const [dx, dy, dz] = [vertices[i] - x, vertices[i + 1] - y, vertices[i + 2] - z];
            square = Math.max(square, dx * dx + dy * dy + dz * dz);
        }
    }
    return { center, radius: square > 0 ? Math.sqrt(square) : 1 };
}

function hasIsolated(vertices) {
    for (let i = 3; i < vertices.length; i += 4) {
        if (vertices[i] === VERTEX_ISOLATED) {
            return true;
        }
    }
    return false;
}

// Returns whether the mesh has a vertex with this id, which is not deleted.
export function hasVertex({ vertices }, id) {
    return 4 * id < vertices.length && vertices[4 * id + 3] !== 0;
}

// Returns [x, y, z] of a vertex.
export function pointAt({ vertices }, id) {
    return Array.from(vertices.subarray(4 * id, 4 * id + 3));
}

// Returns the id of the face that a triangle belongs to.
export function faceOf(triangles, triangle) {
    return triangles[4 * triangle + 3] & FACE_MASK;
}

// Returns whether side 0, 1 or 2 of a triangle is an edge of its face, and not a diagonal.
export function isEdge(triangles, triangle, side) {
    return ((triangles[4 * triangle + 3] >>> (SIDE_SHIFT + side)) & 1) === 1;
}

// Returns the sides of some triangles that are edges of their faces, as pairs of vertices in the
// order that they have around the face.
export function edgesOfTriangles(triangles, which) {
    const edges = [];
    for (const triangle of which) {
        for (let side = 0; side < 3; side++) {
            if (isEdge(triangles, triangle, side)) {
                edges.push([
                    triangles[4 * triangle + side],
                    triangles[4 * triangle + ((side + 1) % 3)],
                ]);
            }
        }
    }
    return edges;
}

// --- where the triangles of a face are ---
//
// firstOf[face] is the index of the face's first triangle plus 1, or 0 if it has none. The entry
// may be outdated: that triangle may belong to another face by now, so readers check its face.

const isLive = (triangles, triangle) => triangles[4 * triangle] !== triangles[4 * triangle + 1];

function firstsOf(triangles, count) {
    let most = -1;
    for (let i = 0; i < count; i++) {
        most = Math.max(most, faceOf(triangles, i));
    }
    const firstOf = new Uint32Array(most + 1);
    for (let i = count - 1; i >= 0; i--) {
        if (isLive(triangles, i)) {
            firstOf[faceOf(triangles, i)] = i + 1;
        }
    }
    return firstOf;
}

// Updates geometry.firstOf after some triangles of the array were written; `places` are the indices
// of these triangles in ascending order.
export function findFaces(geometry, places) {
    const { triangles, triangleCount } = geometry;
    let done = -1; // index of the last triangle processed
    for (const place of places) {
        // The face to which this triangle belonged before may still have another triangle, just
        // beside this one.
        for (const at of [place - 1, place, place + 1]) {
            if (at > done && at < triangleCount && isLive(triangles, at)) {
                done = at;
                setFirst(geometry, faceOf(triangles, at), at);
            }
        }
    }
}

function setFirst(geometry, face, triangle) {
    const { triangles, firstOf } = geometry;
    if (face >= firstOf.length) {
        geometry.firstOf = new Uint32Array(face + 1 + (face >>> 3));
        geometry.firstOf.set(firstOf);
    }
    const isOf = (at) => at >= 0 && faceOf(triangles, at) === face && isLive(triangles, at);
    let first = geometry.firstOf[face] - 1;
    // The entry of firstOf is still right if the triangle that it names and the triangle just
    // before `triangle` both belong to the face; otherwise the first triangle must be searched.
    if (first < 0 || first >= triangle || !isOf(first) || !isOf(triangle - 1)) {
        for (first = triangle; isOf(first - 1); first--);
    }
    geometry.firstOf[face] = first + 1;
}

// Returns the indices of the triangles of a face, none if there is no such face.
export function trianglesOfFace({ triangles, triangleCount, firstOf }, face) {
    const found = [];
    const isOf = (at) => faceOf(triangles, at) === face && isLive(triangles, at);
    for (let i = (firstOf[face] ?? 0) - 1; i >= 0 && i < triangleCount && isOf(i); i++) {
        found.push(i);
    }
    return found;
}

// Returns a normal of a face: its length is twice the area of the face, so it may be zero.
export function normalOfFace(geometry, face) {
    const { vertices, triangles } = geometry;
    const normal = [0, 0, 0];
    for (const triangle of trianglesOfFace(geometry, face)) {
        const [a, b, c] = [0, 1, 2].map((i) => 4 * triangles[4 * triangle + i]);
        for (let axis = 0; axis < 3; axis++) {
            const u = (axis + 1) % 3;
            const v = (axis + 2) % 3;
            normal[axis] +=
                (vertices[b + u] - vertices[a + u]) * (vertices[c + v] - vertices[a + v]) -
                (vertices[b + v] - vertices[a + v]) * (vertices[c + u] - vertices[a + u]);
        }
    }
    return normal;
}
