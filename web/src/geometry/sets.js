// sets.js - computes with sets of elements: neighbours, components, regions, borders, sums. Pure.
//
// A set is a Uint8Array with 1 for each element that belongs to it: by id for faces and vertices, by
// the numbers of topology.js for edges. `kind` is 'face', 'edge' or 'vertex'.

import { faceOf, isEdge } from './geometry.js';
import { topologyOf } from './topology.js';

// Returns an empty set.
export function noneOf(kind, geometry) {
    const sizes = {
        face: () => geometry.firstOf.length,
        edge: () => topologyOf(geometry).count,
        vertex: () => geometry.vertexCount,
    };
    return new Uint8Array(sizes[kind]());
}

// Returns the set of all elements.
export function allOf(kind, geometry) {
    const set = noneOf(kind, geometry);
    if (kind === 'edge') {
        return set.fill(1);
    }
    if (kind === 'vertex') {
        for (let id = 0; id < set.length; id++) {
            set[id] = geometry.vertices[4 * id + 3] === 0 ? 0 : 1;
        }
        return set;
    }
    eachTriangle(geometry, (_, face) => {
        set[face] = 1;
    });
    return set;
}

export function countOf(set) {
    let count = 0;
    for (let i = 0; i < set.length; i++) {
        count += set[i];
    }
    return count;
}

// Returns the members of a set in ascending order.
export function membersOf(set) {
    const members = new Uint32Array(countOf(set));
    let at = 0;
    for (let i = 0; i < set.length; i++) {
        if (set[i] === 1) {
            members[at++] = i;
        }
    }
    return members;
}

// Calls act(index, face) for each triangle of a face.
export function eachTriangle({ triangles, triangleCount }, act) {
    for (let i = 0; i < triangleCount; i++) {
        if (triangles[4 * i] !== triangles[4 * i + 1]) {
            act(i, faceOf(triangles, i));
        }
    }
}

// Returns the vertices of a set's elements.
export function verticesOf(kind, set, geometry) {
    if (kind === 'vertex') {
        return set;
    }
    const vertices = noneOf('vertex', geometry);
    if (kind === 'edge') {
        const { count, from, to } = topologyOf(geometry);
        for (let edge = 0; edge < count; edge++) {
            if (set[edge] === 1) {
                vertices[from[edge]] = 1;
                vertices[to[edge]] = 1;
            }
        }
        return vertices;
    }
    const { triangles } = geometry;
    eachTriangle(geometry, (i, face) => {
        if (set[face] === 1) {
            vertices[triangles[4 * i]] = 1;
            vertices[triangles[4 * i + 1]] = 1;
            vertices[triangles[4 * i + 2]] = 1;
        }
    });
    return vertices;
}

// Returns the faces or edges that have one of these vertices.
function around(kind, vertices, geometry) {
    const set = noneOf(kind, geometry);
    if (kind === 'edge') {
        const { count, from, to } = topologyOf(geometry);
        for (let edge = 0; edge < count; edge++) {
            set[edge] = vertices[from[edge]] | vertices[to[edge]];
        }
        return set;
    }
    const { triangles } = geometry;
    eachTriangle(geometry, (i, face) => {
        set[face] |=
            vertices[triangles[4 * i]] |
            vertices[triangles[4 * i + 1]] |
            vertices[triangles[4 * i + 2]];
    });
    return set;
}

// Returns a set with its neighbours: vertices at the other end of an edge, or faces and edges that
// share a vertex with a member, as the operation `select` grows sets.
export function grown(kind, set, geometry) {
    if (kind !== 'vertex') {
        return around(kind, verticesOf(kind, set, geometry), geometry);
    }
    const wider = set.slice();
    const { triangles } = geometry;
    eachTriangle(geometry, (i) => {
        for (let side = 0; side < 3; side++) {
            if (isEdge(triangles, i, side)) {
                const [from, to] = [triangles[4 * i + side], triangles[4 * i + ((side + 1) % 3)]];
                wider[from] |= set[to];
                wider[to] |= set[from];
            }
        }
    });
    return wider;
}

// Returns a set without the members that have a neighbour outside of it.
export function shrunk(kind, set, geometry) {
    return inverted(kind, grown(kind, inverted(kind, set, geometry), geometry), geometry);
}

export function inverted(kind, set, geometry) {
    const all = allOf(kind, geometry);
    for (let i = 0; i < all.length; i++) {
        all[i] &= 1 - (set[i] ?? 0);
    }
    return all;
}

// Returns all elements of the components that have a member of the set. Components are connected by
// edges or by single vertices.
export function connected(kind, set, geometry) {
    const { vertexCount, triangles } = geometry;
    const parents = Uint32Array.from({ length: vertexCount }, (_, i) => i);
    const rootOf = (vertex) => {
        let at = vertex;
        while (parents[at] !== at) {
            parents[at] = parents[parents[at]];
            at = parents[at];
        }
        return at;
    };
    eachTriangle(geometry, (i) => {
        const root = rootOf(triangles[4 * i]);
        parents[rootOf(triangles[4 * i + 1])] = root;
        parents[rootOf(triangles[4 * i + 2])] = root;
    });
    const seeds = verticesOf(kind, set, geometry);
    const isReached = new Uint8Array(vertexCount);
    for (let vertex = 0; vertex < vertexCount; vertex++) {
        if (seeds[vertex] === 1) {
            isReached[rootOf(vertex)] = 1;
        }
    }
    const reached = new Uint8Array(vertexCount);
    for (let vertex = 0; vertex < vertexCount; vertex++) {
        reached[vertex] = isReached[rootOf(vertex)];
    }
    return kind === 'vertex' ? reached : around(kind, reached, geometry);
}

// Returns the unit normals of all faces, three numbers each; those of faces without area are zero.
export function normalsOf(geometry) {
    const normals = new Float64Array(3 * geometry.firstOf.length);
    const { vertices, triangles } = geometry;
    eachTriangle(geometry, (i, face) => {
        const [a, b, c] = [0, 1, 2].map((corner) => 4 * triangles[4 * i + corner]);
        for (let axis = 0; axis < 3; axis++) {
            const [u, v] = [(axis + 1) % 3, (axis + 2) % 3];
            normals[3 * face + axis] +=
                (vertices[b + u] - vertices[a + u]) * (vertices[c + v] - vertices[a + v]) -
                (vertices[b + v] - vertices[a + v]) * (vertices[c + u] - vertices[a + u]);
        }
    });
    for (let at = 0; at < normals.length; at += 3) {
        const length = Math.hypot(normals[at], normals[at + 1], normals[at + 2]) || 1;
        for (let axis = 0; axis < 3; axis++) {
            normals[at + axis] /= length;
        }
    }
    return normals;
}

// A dihedral angle may be larger than the limit by this many radians, because positions are rounded.
const SLACK = 1e-4;

// Returns the faces that are reached from the set across edges at which the normals differ by at
// most `angle` radians.
export function byAngle(set, angle, geometry) {
    const normals = normalsOf(geometry);
    const { count, left, right } = topologyOf(geometry);
    const least = Math.cos(Math.min(angle + SLACK, Math.PI));
    const parents = Uint32Array.from({ length: geometry.firstOf.length }, (_, i) => i);
    const rootOf = (face) => {
        let at = face;
        while (parents[at] !== at) {
            parents[at] = parents[parents[at]];
            at = parents[at];
        }
        return at;
    };
    for (let edge = 0; edge < count; edge++) {
        const [a, b] = [3 * left[edge], 3 * right[edge]];
        const cosine =
            normals[a] * normals[b] +
            normals[a + 1] * normals[b + 1] +
            normals[a + 2] * normals[b + 2];
        if (b >= 0 && cosine >= least) {
            parents[rootOf(right[edge])] = rootOf(left[edge]);
        }
    }
    const isReached = new Uint8Array(set.length);
    for (let face = 0; face < set.length; face++) {
        if (set[face] === 1) {
            isReached[rootOf(face)] = 1;
        }
    }
    const all = allOf('face', geometry);
    for (let face = 0; face < all.length; face++) {
        all[face] &= isReached[rootOf(face)];
    }
    return all;
}

// Returns the edges with a face of the set on one side only.
export function borderOf(set, geometry) {
    const { count, left, right } = topologyOf(geometry);
    const border = new Uint8Array(count);
    for (let edge = 0; edge < count; edge++) {
        const beyond = right[edge] < 0 ? 0 : set[right[edge]];
        border[edge] = set[left[edge]] === beyond ? 0 : 1;
    }
    return border;
}

// Returns the sum of the areas of faces or of the lengths of edges, in units of the mesh; 0 for
// vertices.
export function sizeOf(kind, set, geometry) {
    const { vertices, triangles, frame } = geometry;
    let sum = 0;
    if (kind === 'edge') {
        const { count, from, to } = topologyOf(geometry);
        for (let edge = 0; edge < count; edge++) {
            if (set[edge] === 1) {
                const [a, b] = [4 * from[edge], 4 * to[edge]];
                sum += Math.hypot(
                    vertices[a] - vertices[b],
                    vertices[a + 1] - vertices[b + 1],
                    vertices[a + 2] - vertices[b + 2],
                );
            }
        }
        return sum / frame.scale;
    }
    if (kind === 'face') {
        eachTriangle(geometry, (i, face) => {
            if (set[face] === 1) {
                sum += areaOf(vertices, triangles, i);
            }
        });
    }
    return sum / frame.scale / frame.scale;
}

function areaOf(vertices, triangles, i) {
    const [a, b, c] = [4 * triangles[4 * i], 4 * triangles[4 * i + 1], 4 * triangles[4 * i + 2]];
    const [ux, uy, uz] = [
        vertices[b] - vertices[a],
        vertices[b + 1] - vertices[a + 1],
        vertices[b + 2] - vertices[a + 2],
    ];
    const [vx, vy, vz] = [
        vertices[c] - vertices[a],
        vertices[c + 1] - vertices[a + 1],
        vertices[c + 2] - vertices[a + 2],
    ];
    return Math.hypot(uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx) / 2;
}
