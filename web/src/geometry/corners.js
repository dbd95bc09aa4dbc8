// corners.js - which half-edge belongs to each corner of the triangles that are drawn. Pure.
//
// A corner of a face stands for the half-edge of the face that begins there, and the edge of this
// half-edge leads to the next corner. The arrays that are drawn have neither half-edges nor edges, so
// the server is asked for the corners and the half-edges of all faces.

import { faceOf } from './geometry.js';

export const NONE = 0xffffffff;

export class Corners {
    faces; // the ids of all faces in ascending order
    edges; // the ids of all edges in ascending order
    #offsets;
    #vertices;
    #halfedges;
    #places; // by face: its index in `faces` plus 1, or 0

    // `faces` are the ids of all faces in ascending order. `vertices` and `halfedges` are lists
    // {offsets, ids}: those of the face at index i, in the order around the face, are the entries of
    // `ids` from offsets[i] up to offsets[i + 1], exclusively. Throws a RangeError if the lists do
    // not belong together.
    constructor(faces, vertices, halfedges) {
        const count = faces.length;
        if (
            vertices.offsets.length !== count + 1 ||
            halfedges.offsets.length !== count + 1 ||
            vertices.ids.length !== halfedges.ids.length
        ) {
            throw new RangeError('The corners of the faces are of another revision.');
        }
        this.faces = faces;
        this.#offsets = vertices.offsets;
        this.#vertices = vertices.ids;
        this.#halfedges = halfedges.ids;
        this.#places = new Uint32Array(count === 0 ? 0 : faces[count - 1] + 1);
        for (let i = 0; i < count; i++) {
            this.#places[faces[i]] = i + 1;
        }
        this.edges = edgesOf(halfedges.ids);
    }

    // The ids of all half-edges in ascending order: those of edge e are 2e and 2e + 1.
    get halfedges() {
        const all = new Uint32Array(2 * this.edges.length);
        for (let i = 0; i < this.edges.length; i++) {
            all[2 * i] = 2 * this.edges[i];
            all[2 * i + 1] = 2 * this.edges[i] + 1;
        }
        return all;
    }

    // Returns the half-edge at each corner of the triangles of `geometry`, three for a triangle; NONE
    // if the triangle belongs to no face or to one of another revision.
    ofTriangles({ triangles, triangleCount }) {
        const found = new Uint32Array(3 * triangleCount).fill(NONE);
        for (let triangle = 0; triangle < triangleCount; triangle++) {
            const place = this.#places[faceOf(triangles, triangle)] ?? 0;
            if (place === 0 || triangles[4 * triangle] === triangles[4 * triangle + 1]) {
                continue;
            }
            const [begin, end] = [this.#offsets[place - 1], this.#offsets[place]];
            for (let corner = 0; corner < 3; corner++) {
                const vertex = triangles[4 * triangle + corner];
                for (let i = begin; i < end; i++) {
                    if (this.#vertices[i] === vertex) {
                        found[3 * triangle + corner] = this.#halfedges[i];
                        break;
                    }
                }
            }
        }
        return found;
    }

    // Returns the half-edge of a face, or of its twin, that leads from one vertex to another, or
    // null if there is none.
    between(from, to) {
        for (let place = 0; place < this.faces.length; place++) {
            const [begin, end] = [this.#offsets[place], this.#offsets[place + 1]];
            for (let i = begin; i < end; i++) {
                const next = this.#vertices[i + 1 < end ? i + 1 : begin];
                if (this.#vertices[i] === from && next === to) {
                    return this.#halfedges[i];
                }
                if (this.#vertices[i] === to && next === from) {
                    return this.#halfedges[i] ^ 1;
                }
            }
        }
        return null;
    }

    // Returns the number of the component of each face, by id, as GET .../components lists them: faces
    // that share an edge are in one component, and components are in the order of their lowest ids.
    // Ids without a face have NaN.
    components() {
        const { length } = this.faces;
        const parents = Uint32Array.from({ length }, (_, i) => i);
        const rootOf = (i) => {
            while (parents[i] !== i) {
                parents[i] = parents[parents[i]]; // path halving
                i = parents[i];
            }
            return i;
        };
        const owners = new Uint32Array(this.edges.length === 0 ? 0 : this.edges.at(-1) + 1);
        for (let place = 0; place < length; place++) {
            for (let i = this.#offsets[place]; i < this.#offsets[place + 1]; i++) {
                const edge = this.#halfedges[i] >>> 1;
                if (owners[edge] === 0) {
                    owners[edge] = place + 1;
                } else {
                    // The root of a component is its face with the lowest id.
                    const [a, b] = [rootOf(owners[edge] - 1), rootOf(place)];
                    parents[Math.max(a, b)] = Math.min(a, b);
                }
            }
        }
        const labels = new Float64Array(this.#places.length).fill(NaN);
        let count = 0;
        for (let place = 0; place < length; place++) {
            const root = rootOf(place);
            labels[this.faces[place]] = root === place ? count++ : labels[this.faces[root]];
        }
        return labels;
    }
}

// Returns the edges of some half-edges in ascending order, each once.
function edgesOf(halfedges) {
    let most = -1;
    for (let i = 0; i < halfedges.length; i++) {
        most = Math.max(most, halfedges[i] >>> 1);
    }
    const isThere = new Uint8Array(most + 1);
    for (let i = 0; i < halfedges.length; i++) {
        isThere[halfedges[i] >>> 1] = 1;
    }
    return markedIn(isThere);
}

// Returns the indices of the entries that are 1, in ascending order. Loops over all elements of a large
// mesh, here and above, call no function for each one: that would take several times as long.
function markedIn(isThere) {
    let count = 0;
    for (let id = 0; id < isThere.length; id++) {
        count += isThere[id];
    }
    const ids = new Uint32Array(count);
    for (let id = 0, at = 0; at < count; id++) {
        if (isThere[id] === 1) {
            ids[at++] = id;
        }
    }
    return ids;
}

// Returns the ids of all vertices of the arrays in ascending order.
export function verticesOf({ vertices, vertexCount }) {
    const isThere = new Uint8Array(vertexCount);
    for (let id = 0; id < vertexCount; id++) {
        isThere[id] = vertices[4 * id + 3] !== 0 ? 1 : 0;
    }
    return markedIn(isThere);
}

// Returns the ids of all faces of the arrays in ascending order.
export function facesOf({ triangles, triangleCount }) {
    const isLive = (i) => triangles[4 * i] !== triangles[4 * i + 1];
    let most = -1;
    for (let i = 0; i < triangleCount; i++) {
        most = isLive(i) ? Math.max(most, faceOf(triangles, i)) : most;
    }
    const isThere = new Uint8Array(most + 1);
    for (let i = 0; i < triangleCount; i++) {
        if (isLive(i)) {
            isThere[faceOf(triangles, i)] = 1;
        }
    }
    return markedIn(isThere);
}
