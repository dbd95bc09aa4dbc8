// ways.js - how far vertices are from others along the edges of the triangles, and which vertices
// hold the mesh while a part of it bends. Pure.

import { hasVertex } from '../geometry/geometry.js';

// With "all", the vertices that are farther than this fraction of the greatest distance stay, since
// without any that stay the whole mesh would only be moved.
const HELD = 0.95;

// Returns the neighbours of each vertex: those of vertex v are ends[starts[v]] to
// ends[starts[v + 1] - 1]; some are there twice.
export function neighboursOf({ triangles, triangleCount, vertexCount }) {
    const starts = new Uint32Array(vertexCount + 2);
    // A slot without a face is four zeros; no face has a vertex twice.
    const isFace = (i) => triangles[i] !== triangles[i + 1];
    for (let i = 0; i < 4 * triangleCount; i += 4) {
        for (let k = 0; k < 3 && isFace(i); k++) {
            starts[triangles[i + k] + 2] += 2;
        }
    }
    for (let v = 2; v < starts.length; v++) {
        starts[v] += starts[v - 1];
    }
    const ends = new Uint32Array(starts[vertexCount + 1]);
    for (let i = 0; i < 4 * triangleCount; i += 4) {
        for (let k = 0; k < 3 && isFace(i); k++) {
            const at = triangles[i + k];
            ends[starts[at + 1]++] = triangles[i + ((k + 1) % 3)];
            ends[starts[at + 1]++] = triangles[i + ((k + 2) % 3)];
        }
    }
    return { starts, ends };
}

// A queue of vertices, the nearest first (a binary heap). A vertex may be in it several times.
class Nearest {
    #vertices = [];
    #ways = [];

    get isEmpty() {
        return this.#vertices.length === 0;
    }

    add(vertex, way) {
        let at = this.#vertices.length;
        while (at > 0) {
            const above = (at - 1) >> 1;
            if (this.#ways[above] <= way) {
                break;
            }
            this.#put(at, this.#vertices[above], this.#ways[above]);
            at = above;
        }
        this.#put(at, vertex, way);
    }

    // Removes and returns the first one, [vertex, way].
    take() {
        const first = [this.#vertices[0], this.#ways[0]];
        const [vertex, way] = [this.#vertices.pop(), this.#ways.pop()];
        const count = this.#vertices.length;
        let at = 0;
        for (let below = 1; below < count; below = 2 * at + 1) {
            if (below + 1 < count && this.#ways[below + 1] < this.#ways[below]) {
                below++;
            }
            if (this.#ways[below] >= way) {
                break;
            }
            this.#put(at, this.#vertices[below], this.#ways[below]);
            at = below;
        }
        if (count > 0) {
            this.#put(at, vertex, way);
        }
        return first;
    }

    #put(at, vertex, way) {
        this.#vertices[at] = vertex;
        this.#ways[at] = way;
    }
}

// Returns how far each vertex is from the nearest of `sources` along edges, in view coordinates
// (Dijkstra); Infinity if no edges lead there.
export function waysFrom(geometry, sources, { starts, ends } = neighboursOf(geometry)) {
    const { vertices } = geometry;
    const ways = new Float64Array(geometry.vertexCount).fill(Infinity);
    const queue = new Nearest();
    for (const id of sources) {
        ways[id] = 0;
        queue.add(id, 0);
    }
    while (!queue.isEmpty) {
        const [at, way] = queue.take();
        for (let i = starts[at]; i < starts[at + 1] && way === ways[at]; i++) {
            const to = ends[i];
            const length = Math.hypot(
                vertices[4 * at] - vertices[4 * to],
                vertices[4 * at + 1] - vertices[4 * to + 1],
                vertices[4 * at + 2] - vertices[4 * to + 2],
            );
            if (way + length < ways[to]) {
                ways[to] = way + length;
                queue.add(to, ways[to]);
            }
        }
    }
    return ways;
}

// Returns which vertices must stay so that only what is near the moved ones bends: those beyond a
// fraction `reach` of the greatest way that have a neighbour that is not. If `reach` is 1, all bends
// but the farthest. What lies behind them stays, too. Returns [] if none stay, for example because all
// vertices are moved.
export function heldAround(geometry, sources, reach) {
    const neighbours = neighboursOf(geometry);
    const ways = waysFrom(geometry, sources, neighbours);
    const { starts, ends } = neighbours;
    const most = ways.reduce((a, b) => (b < Infinity ? Math.max(a, b) : a), 0);
    const limit = most * Math.min(reach, HELD);
    const held = [];
    for (let id = 0; id < ways.length; id++) {
        if (ways[id] > limit && ways[id] < Infinity && hasVertex(geometry, id)) {
            let isRim = false;
            for (let i = starts[id]; i < starts[id + 1] && !isRim; i++) {
                isRim = ways[ends[i]] <= limit;
            }
            if (isRim) {
                held.push(id);
            }
        }
    }
    return held;
}
