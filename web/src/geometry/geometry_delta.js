// geometry_delta.js - applies changes, as GET .../geometry?since=&layout= sends them, to the arrays
// of geometry.js. Pure: no page, no network, no WebGL.
//
//   0   "HEDG", u32 version         40  u32 vertexCount, u32 triangleCount after the change
//   8   u64 revision                80  u64 layout, below 2^53
//   16  u64 base                    88  u32 vertex rows, u32 triangle rows that follow
//   24  u64 bytes of each part      96  the two parts
//
// The first part has the changed vertices, the second the changed triangles. A part consists of u32
// indices in ascending order, zeros up to a multiple of 16 bytes, and a row of 16 bytes for each
// index. As long as `layout` is the same, a triangle keeps its slot, counts never decrease, and a
// slot without a face is four zeros. The triangles of a face are consecutive.

import { HEADER_BYTES, headerOf } from './geometry.js';

const ROW_BYTES = 16;

// Applies changes to `geometry`: {revision, layout, vertices, vertexCount, triangles,
// triangleCount}, whose arrays may be longer than their counts. An array that is too short is
// replaced by one that is an eighth longer than needed, rounded up to whole texture rows of
// `rowTexels` texels.
//
// Returns {vertices, triangles, grown}: the indices of the changed rows, as Uint32Arrays, and
// whether an array was replaced. Returns null, and does nothing, if the answer contains all rows:
// then the caller must make a new geometry from the answer. Throws a RangeError, and does nothing,
// if the answer is no change of this geometry: then everything must be fetched.
export function applyDelta(geometry, buffer, rowTexels = 2048) {
    const header = headerOf(buffer);
    if (header.base === 0) {
        return null;
    }
    if (header.base !== geometry.revision || header.layout !== geometry.layout) {
        throw new RangeError('The changes from the server are not for the geometry shown.');
    }
    const view = new DataView(buffer);
    const [vertexRows, triangleRows] = [88, 92].map((at) => view.getUint32(at, true));
    const vertices = partAt(buffer, HEADER_BYTES, vertexRows, Float32Array);
    const triangles = partAt(buffer, vertices.end, triangleRows, Uint32Array);
    if (
        triangles.end !== buffer.byteLength ||
        !fits(vertices.places, geometry.vertexCount, header.vertexCount) ||
        !fits(triangles.places, geometry.triangleCount, header.triangleCount)
    ) {
        throw new RangeError('The changes from the server do not fit the geometry shown.');
    }
    const before = [geometry.vertices, geometry.triangles];
    geometry.vertices = grown(geometry.vertices, header.vertexCount, rowTexels);
    geometry.triangles = grown(geometry.triangles, header.triangleCount, rowTexels);
    putRows(geometry.vertices, vertices);
    putRows(geometry.triangles, triangles);
    geometry.vertexCount = header.vertexCount;
    geometry.triangleCount = header.triangleCount;
    geometry.revision = header.revision;
    return {
        vertices: vertices.places,
        triangles: triangles.places,
        grown: before[0] !== geometry.vertices || before[1] !== geometry.triangles,
    };
}

function partAt(buffer, at, count, Row) {
    const rowsAt = at + Math.ceil(count / 4) * ROW_BYTES;
    const end = rowsAt + count * ROW_BYTES;
    if (end > buffer.byteLength) {
        throw new RangeError('The changes of the geometry did not arrive completely.');
    }
    return {
        places: new Uint32Array(buffer, at, count),
        rows: new Row(buffer, rowsAt, 4 * count),
        end,
    };
}

function fits(places, before, after) {
    return after >= before && places.every((place) => place < after);
}

function grown(array, count, rowTexels) {
    if (4 * count <= array.length) {
        return array;
    }
    const texels = Math.ceil((count + count / 8) / rowTexels) * rowTexels;
    const longer = new array.constructor(4 * texels);
    longer.set(array);
    return longer;
}

function putRows(array, { places, rows }) {
    for (let i = 0; i < places.length; i++) {
        array.set(rows.subarray(4 * i, 4 * i + 4), 4 * places[i]);
    }
}
