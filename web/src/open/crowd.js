// crowd.js - a set of selected elements that may be as large as the mesh. It has no data of the
// server; the selection of few elements has, see selection.js.
//
// A Crowd of faces or vertices is a Uint8Array with 1 for each selected id. A Crowd of edges has the
// ids of their vertices in pairs, because the arrays of geometry.js have no ids of edges; the ids are
// asked from the server when they are needed.

import * as api from '../wire/api.js';
import { hasVertex, trianglesOfFace } from '../geometry/geometry.js';
import { countOf, membersOf, noneOf, verticesOf } from '../geometry/sets.js';
import { edgesBetween, topologyOf } from '../geometry/topology.js';

// The largest number of questions that the server answers in one request.
const MOST_ASKED = 10000;

let serials = 0;

export class Crowd {
    kind;
    count;
    serial = ++serials; // distinguishes this Crowd from all others
    #flags = null; // of faces or vertices
    #pairs = null; // of edges
    #ids = null; // of edges, once they are known

    constructor(kind, { flags = null, pairs = null, ids = null }) {
        this.kind = kind;
        [this.#flags, this.#pairs, this.#ids] = [flags, pairs, ids];
        this.count = flags === null ? pairs.length / 2 : countOf(flags);
    }

    // Makes a Crowd of a set, see sets.js.
    static of(kind, set, geometry) {
        if (kind !== 'edge') {
            return new Crowd(kind, { flags: set });
        }
        const { from, to } = topologyOf(geometry);
        const pairs = new Uint32Array(2 * countOf(set));
        membersOf(set).forEach((edge, i) => {
            pairs[2 * i] = from[edge];
            pairs[2 * i + 1] = to[edge];
        });
        return new Crowd(kind, { pairs });
    }

    // Makes a Crowd of elements that are given by their ids.
    static async read(mesh, kind, ids, geometry) {
        if (kind !== 'edge') {
            const flags = noneOf(kind, geometry);
            ids.forEach((id) => {
                flags[id] = 1;
            });
            return new Crowd(kind, { flags });
        }
        const found = await Crowd.readEdges(mesh, ids);
        return new Crowd(kind, {
            pairs: Uint32Array.from(found.flatMap(({ vertices }) => vertices)),
            ids: found.map(({ id }) => id),
        });
    }

    // Returns the server's data about edges; those that do not exist are left out.
    static async readEdges(mesh, ids) {
        const answers = await askAll(mesh, ids, (id) => ({ get: { edge: id } }));
        return answers.filter(({ vertices }) => vertices !== undefined);
    }

    // The members as a set, see sets.js.
    setIn(geometry) {
        if (this.kind !== 'edge') {
            const set = noneOf(this.kind, geometry);
            set.set(this.#flags.subarray(0, set.length));
            return set;
        }
        const set = noneOf('edge', geometry);
        edgesBetween(topologyOf(geometry), this.#pairs).forEach((edge) => {
            if (edge >= 0) {
                set[edge] = 1;
            }
        });
        return set;
    }

    // The vertices of edges, in pairs.
    get pairs() {
        return this.#pairs;
    }

    // The flags of faces or vertices, by id.
    get flags() {
        return this.#flags;
    }

    // Returns a Crowd with one more member; `element` is the server's data about it.
    with(id, element) {
        if (this.kind === 'edge') {
            const pairs = Uint32Array.from([...this.#pairs, ...element.vertices]);
            return new Crowd('edge', { pairs, ids: this.#ids && [...new Set([...this.#ids, id])] });
        }
        const flags = new Uint8Array(Math.max(this.#flags.length, id + 1));
        flags.set(this.#flags);
        flags[id] = 1;
        return new Crowd(this.kind, { flags });
    }

    // Returns the members that the arrays `geometry` still have, as another Crowd.
    keptIn(geometry) {
        if (this.kind === 'edge') {
            return Crowd.of('edge', this.setIn(geometry), geometry);
        }
        const isThere =
            this.kind === 'face'
                ? (id) => trianglesOfFace(geometry, id).length > 0
                : (id) => hasVertex(geometry, id);
        const flags = this.setIn(geometry);
        for (let id = 0; id < flags.length; id++) {
            flags[id] = flags[id] === 1 && isThere(id) ? 1 : 0;
        }
        return new Crowd(this.kind, { flags });
    }

    // Returns the ids of the members as an array. For edges, the server is asked; those that the mesh
    // does not have any more are left out.
    async ids(mesh) {
        if (this.kind !== 'edge') {
            return [...membersOf(this.#flags)];
        }
        if (this.#ids === null) {
            const pairs = Array.from({ length: this.count }, (_, i) => [
                this.#pairs[2 * i],
                this.#pairs[2 * i + 1],
            ]);
            const answers = await askAll(mesh, pairs, (vertices) => ({ find: 'halfedge', vertices }));
            this.#ids = answers
                .map(({ halfedge }) => halfedge)
                .filter((halfedge) => typeof halfedge === 'number')
                .map((halfedge) => Math.floor(halfedge / 2))
                .sort((a, b) => a - b);
        }
        return this.#ids;
    }

    // Returns the ids of the vertices of all members.
    verticesIn(geometry) {
        return [...membersOf(verticesOf(this.kind, this.setIn(geometry), geometry))];
    }
}

// Asks the server the question `about(item)` for each item, in as few requests as possible, and
// returns the answers in order.
export async function askAll(mesh, items, about) {
    const answers = [];
    for (let at = 0; at < items.length; at += MOST_ASKED) {
        const part = items.slice(at, at + MOST_ASKED);
        answers.push(...(await api.query(mesh, part.map(about))));
    }
    return answers;
}
