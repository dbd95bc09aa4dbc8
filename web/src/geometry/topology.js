// topology.js - the edges of the polygons in the arrays of geometry.js, and which faces are beside
// each edge. Pure.
//
// The arrays have no ids of edges, so edges are numbered here in an order of their own, which is
// valid for one revision. A side is a triangle's number times 3 plus 0, 1 or 2: see geometry.js.

import { faceOf, isEdge } from './geometry.js';

// A vertex with more edges than this gets a table of its own, because a search among the edges of a
// vertex takes as long as there are edges.
const MANY = 64;

const kept = new WeakMap(); // arrays -> {revision, topology}

// Returns the topology of the arrays `geometry`: {count, from, to, left, right, edgeOfSide}. Edge e
// leads from vertex from[e] to vertex to[e]; left[e] is the face in which it has this direction, and
// right[e] the face on the other side, or -1. edgeOfSide[s] is the edge of side s, or -1 if the side
// is a diagonal. It is computed once for each revision.
export function topologyOf(geometry) {
    const { revision, layout } = geometry;
    const known = kept.get(geometry);
    if (known?.revision === revision && known.layout === layout) {
        return known.topology;
    }
    const topology = build(geometry);
    kept.set(geometry, { revision, layout, topology });
    return topology;
}

function build({ vertexCount, triangles, triangleCount }) {
    const sides = 3 * triangleCount;
    // The sides by their lower vertex: those of vertex v are sideAt[startOf[v]] and so on.
    const startOf = new Uint32Array(vertexCount + 1);
    const isSide = (side) => isEdge(triangles, Math.floor(side / 3), side % 3);
    const fromOf = (side) => triangles[4 * Math.floor(side / 3) + (side % 3)];
    const toOf = (side) => triangles[4 * Math.floor(side / 3) + (((side % 3) + 1) % 3)];
    for (let side = 0; side < sides; side++) {
        if (isSide(side)) {
            startOf[Math.min(fromOf(side), toOf(side)) + 1]++;
        }
    }
    for (let vertex = 0; vertex < vertexCount; vertex++) {
        startOf[vertex + 1] += startOf[vertex];
    }
    const total = startOf[vertexCount];
    const sideAt = new Uint32Array(total);
    const next = startOf.slice();
    for (let side = 0; side < sides; side++) {
        if (isSide(side)) {
            sideAt[next[Math.min(fromOf(side), toOf(side))]++] = side;
        }
    }
    const edgeOfSide = new Int32Array(sides).fill(-1);
    const [from, to] = [new Uint32Array(total), new Uint32Array(total)];
    const [left, right] = [new Int32Array(total), new Int32Array(total)];
    let count = 0;
    const place = (side, edge) => {
        const face = faceOf(triangles, Math.floor(side / 3));
        edgeOfSide[side] = edge;
        if (edge === count) {
            [from[edge], to[edge], left[edge], right[edge]] = [fromOf(side), toOf(side), face, -1];
            count++;
        } else {
            right[edge] = face;
        }
    };
    for (let vertex = 0; vertex < vertexCount; vertex++) {
        const [begin, end] = [startOf[vertex], startOf[vertex + 1]];
        const first = count;
        const table = end - begin > MANY ? new Map() : null;
        for (let at = begin; at < end; at++) {
            const side = sideAt[at];
            const other = Math.max(fromOf(side), toOf(side));
            let edge = table?.get(other) ?? count;
            if (table === null) {
                for (edge = first; edge < count && Math.max(from[edge], to[edge]) !== other; edge++);
            }
            table?.set(other, edge);
            place(side, edge);
        }
    }
    return {
        count,
        from: from.subarray(0, count),
        to: to.subarray(0, count),
        left: left.subarray(0, count),
        right: right.subarray(0, count),
        edgeOfSide,
    };
}

// Returns the numbers of edges that are given by their vertices: pairs of ids, one after another.
// The number of a pair that is no edge is -1.
export function edgesBetween(topology, pairs) {
    const wanted = new Map();
    const keyOf = (a, b) => (a < b ? a * 2 ** 26 + b : b * 2 ** 26 + a);
    for (let i = 0; i < pairs.length; i += 2) {
        wanted.set(keyOf(pairs[i], pairs[i + 1]), i / 2);
    }
    const found = new Int32Array(pairs.length / 2).fill(-1);
    for (let edge = 0; wanted.size > 0 && edge < topology.count; edge++) {
        const at = wanted.get(keyOf(topology.from[edge], topology.to[edge]));
        if (at !== undefined) {
            found[at] = edge;
        }
    }
    return found;
}
