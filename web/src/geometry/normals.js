// normals.js - the normals for smooth shading, one for each corner of a triangle. Pure.
//
// Where two faces meet at an angle that is larger than the crease angle, the edge shall look sharp:
// the normal of a corner is the mean of the normals of those faces around the vertex that are within
// the crease angle of the corner's own face. Each normal is weighted with the angle that the face has
// at the vertex, so that the result does not depend on how polygons are divided into triangles
// (G. Thürmer and C. A. Wüthrich, Computing vertex normals from polygonal facets, 1998).
//
// The result has four words for each triangle: the packed normals of its corners and 0. A packed
// normal is two numbers of 16 bits: the normal projected onto an octahedron that is unfolded into a
// square (Q. Meyer et al., On floating-point normal vectors, 2010). A word 0 stands for no normal:
// the triangle is drawn flat.

const PAUSE = 4096; // triangles or vertices between two interruptions

// Comparing all pairs of corners would take too long at a vertex with more corners than this. There,
// the mean of all normals is used if it is within the crease angle.
const MOST_CORNERS = 48;

// A generator for inSlices() that returns the packed normals of all triangles, as long as the array
// of triangles. `degrees` is the crease angle.
export function* cornerNormals(geometry, degrees) {
    const flat = yield* triangleNormals(geometry);
    const { ends, corners } = yield* cornersOfVertices(geometry);
    const { triangles, vertexCount } = geometry;
    const normals = new Uint32Array(triangles.length);
    const least = Math.cos((Math.min(degrees, 180) * Math.PI) / 180) - 1e-6;
    const around = new Around(geometry, flat, least);
    for (let vertex = 0; vertex < vertexCount; vertex++) {
        if (vertex % PAUSE === 0) {
            yield;
        }
        const begin = vertex === 0 ? 0 : ends[vertex - 1];
        const count = ends[vertex] - begin;
        for (let i = 0; i < count; i += count > MOST_CORNERS ? PAUSE : count) {
            if (i > 0) {
                yield;
            }
            around.write(normals, corners, begin, count, i);
        }
    }
    return normals;
}

// Returns the normals of all triangles, three numbers each, with length 1, or 0 if the triangle has
// no area.
function* triangleNormals({ vertices, triangles, triangleCount }) {
    const normals = new Float32Array(3 * triangleCount);
    for (let i = 0; i < triangleCount; i++) {
        if (i % PAUSE === 0) {
            yield;
        }
        const a = 4 * triangles[4 * i];
        const b = 4 * triangles[4 * i + 1];
        const c = 4 * triangles[4 * i + 2];
        const ux = vertices[b] - vertices[a];
        const uy = vertices[b + 1] - vertices[a + 1];
        const uz = vertices[b + 2] - vertices[a + 2];
        const vx = vertices[c] - vertices[a];
        const vy = vertices[c + 1] - vertices[a + 1];
        const vz = vertices[c + 2] - vertices[a + 2];
        const x = uy * vz - uz * vy;
        const y = uz * vx - ux * vz;
        const z = ux * vy - uy * vx;
        const length = Math.sqrt(x * x + y * y + z * z);
        if (length > 0) {
            normals[3 * i] = x / length;
            normals[3 * i + 1] = y / length;
            normals[3 * i + 2] = z / length;
        }
    }
    return normals;
}

// Returns which corners of triangles are at each vertex: those of vertex v are `corners` from
// ends[v - 1], or 0, to ends[v]. A corner is 4 * triangle + 0, 1 or 2, its place in the array of
// triangles.
function* cornersOfVertices({ triangles, triangleCount, vertexCount }) {
    const ends = new Uint32Array(vertexCount + 1);
    for (let i = 0; i < 4 * triangleCount; i += 4) {
        if (i % (4 * PAUSE) === 0) {
            yield;
        }
        if (triangles[i] !== triangles[i + 1]) {
            ends[triangles[i]]++;
            ends[triangles[i + 1]]++;
            ends[triangles[i + 2]]++;
        }
    }
    let sum = 0;
    for (let vertex = 0; vertex <= vertexCount; vertex++) {
        const count = ends[vertex];
        ends[vertex] = sum;
        sum += count;
    }
    const corners = new Uint32Array(sum);
    for (let i = 0; i < 4 * triangleCount; i += 4) {
        if (i % (4 * PAUSE) === 0) {
            yield;
        }
        if (triangles[i] !== triangles[i + 1]) {
            for (let k = i; k < i + 3; k++) {
                corners[ends[triangles[k]]++] = k;
            }
        }
    }
    return { ends, corners };
}

// Computes the normals of the corners around one vertex.
class Around {
    #geometry;
    #flat;
    #least;
    #x = new Float64Array(MOST_CORNERS);
    #y = new Float64Array(MOST_CORNERS);
    #z = new Float64Array(MOST_CORNERS);
    #weight = new Float64Array(MOST_CORNERS);
    #mean = [0, 0, 0]; // of all corners of a vertex with many

    constructor(geometry, flat, least) {
        [this.#geometry, this.#flat, this.#least] = [geometry, flat, least];
    }

    // Writes the packed normals of `count` corners that begin at `begin` in `corners`, or, if there
    // are many, of a part of them that begins `from` corners later.
    write(normals, corners, begin, count, from) {
        if (count > MOST_CORNERS) {
            this.#writeMany(normals, corners.subarray(begin, begin + count), from);
            return;
        }
        const [flat, x, y, z, weight] = [this.#flat, this.#x, this.#y, this.#z, this.#weight];
        for (let i = 0; i < count; i++) {
            const corner = corners[begin + i];
            const at = 3 * (corner >>> 2);
            x[i] = flat[at];
            y[i] = flat[at + 1];
            z[i] = flat[at + 2];
            weight[i] = this.#angle(corner);
        }
        for (let i = 0; i < count; i++) {
            let [sx, sy, sz] = [0, 0, 0];
            for (let j = 0; j < count; j++) {
                if (i === j || x[i] * x[j] + y[i] * y[j] + z[i] * z[j] >= this.#least) {
                    sx += weight[j] * x[j];
                    sy += weight[j] * y[j];
                    sz += weight[j] * z[j];
                }
            }
            normals[corners[begin + i]] = packed(sx, sy, sz);
        }
    }

    #writeMany(normals, corners, from) {
        const flat = this.#flat;
        if (from === 0) {
            this.#mean = [0, 0, 0];
            for (const corner of corners) {
                const weight = this.#angle(corner);
                for (let axis = 0; axis < 3; axis++) {
                    this.#mean[axis] += weight * flat[3 * (corner >>> 2) + axis];
                }
            }
        }
        const [x, y, z] = this.#mean;
        const least = this.#least * Math.hypot(x, y, z);
        for (const corner of corners.subarray(from, from + PAUSE)) {
            const at = 3 * (corner >>> 2);
            const [nx, ny, nz] = [flat[at], flat[at + 1], flat[at + 2]];
            const isNear = x * nx + y * ny + z * nz >= least;
            normals[corner] = isNear ? packed(x, y, z) : packed(nx, ny, nz);
        }
    }

    // Returns the angle of a triangle at a corner, in radians.
    #angle(corner) {
        const { vertices, triangles } = this.#geometry;
        const k = corner & 3;
        const first = corner - k;
        const at = 4 * triangles[corner];
        const to = 4 * triangles[first + (k === 2 ? 0 : k + 1)];
        const from = 4 * triangles[first + (k === 0 ? 2 : k - 1)];
        const ux = vertices[to] - vertices[at];
        const uy = vertices[to + 1] - vertices[at + 1];
        const uz = vertices[to + 2] - vertices[at + 2];
        const vx = vertices[from] - vertices[at];
        const vy = vertices[from + 1] - vertices[at + 1];
        const vz = vertices[from + 2] - vertices[at + 2];
        const square = (ux * ux + uy * uy + uz * uz) * (vx * vx + vy * vy + vz * vz);
        if (square === 0) {
            return 0;
        }
        const cosine = (ux * vx + uy * vy + uz * vz) / Math.sqrt(square);
        return Math.acos(Math.min(Math.max(cosine, -1), 1));
    }
}

// Packs a normal of any length into 32 bits; returns 0 if it has no direction. look_shaders.js has
// the inverse.
export function packed(x, y, z) {
    const sum = Math.abs(x) + Math.abs(y) + Math.abs(z);
    if (!(sum > 0)) {
        return 0;
    }
    let u = x / sum;
    let v = y / sum;
    if (z < 0) {
        const left = u;
        u = (1 - Math.abs(v)) * (left >= 0 ? 1 : -1);
        v = (1 - Math.abs(left)) * (v >= 0 ? 1 : -1);
    }
    const word = ((Math.round((v + 1) * 32767.5) << 16) | Math.round((u + 1) * 32767.5)) >>> 0;
    // All corners of the square stand for the same normal, so that 0 is free.
    return word === 0 ? 0xffffffff : word;
}
