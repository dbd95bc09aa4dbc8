// selection.js - the selected elements of a mesh, which stay selected while the mesh changes. This
// module does not touch the page.
//
// If few elements are selected, the server's data about each of them is in `chosen`. Otherwise, and
// until these data have arrived, the selected elements are a Crowd, and `chosen` is empty.
//
// While a selected element is being read from the server, the user may select another one, and the
// mesh may change. Only the last selection counts; its elements are read again if the mesh has
// changed.

import * as api from '../wire/api.js';
import { describe } from './around.js';
import { Crowd } from './crowd.js';
import { PLURALS } from '../geometry/kinds.js';
import { hasVertex, trianglesOfFace } from '../geometry/geometry.js';

// If more elements are selected than this, their data is not read from the server.
export const MOST_READ = 1000;

export class Selection {
    chosen = []; // {kind, id, element}, in the order of selection
    crowd = null; // a Crowd, or null
    around = null; // result of describe() for the element selected last
    gone = []; // {kind, id, detail} of elements that were selected until an edit deleted them

    #mesh = null;
    #geometryNow;
    #onChange;
    #choice = 0; // counts selections by the user
    #change = 0; // counts changes of the mesh
    #seen = 0; // value of #change when the data of `chosen` was read

    // `geometryNow()` returns the arrays of the mesh that is shown, see geometry.js. `onChange()` is
    // called when the selection changes.
    constructor(geometryNow, onChange) {
        this.#geometryNow = geometryNow;
        this.#onChange = onChange;
    }

    // Clears the selection, and from then on selects elements of another mesh.
    reset(mesh) {
        this.#mesh = mesh;
        this.#choice++;
        this.#set([], null, []);
    }

    get last() {
        return this.chosen.at(-1);
    }

    // The kind of the selected elements, or null.
    get kind() {
        return this.crowd?.kind ?? this.last?.kind ?? null;
    }

    get count() {
        return this.crowd?.count ?? this.chosen.length;
    }

    // The selected elements as text: `face:3 face:7`, or their number, `1600 faces`.
    get name() {
        return this.crowd === null
            ? this.chosen.map(({ kind, id }) => `${kind}:${id}`).join(' ')
            : `${this.count} ${PLURALS[this.kind]}`;
    }

    // The selected elements as a Crowd; null if nothing or half-edges are selected.
    get asCrowd() {
        if (this.crowd !== null || this.chosen.length === 0 || this.kind === 'halfedge') {
            return this.crowd;
        }
        const ids = this.chosen.map(({ id }) => id);
        if (this.kind === 'edge') {
            const pairs = Uint32Array.from(this.chosen.flatMap(({ element }) => element.vertices));
            return new Crowd('edge', { pairs, ids });
        }
        const flags = new Uint8Array(Math.max(...ids) + 1);
        ids.forEach((id) => {
            flags[id] = 1;
        });
        return new Crowd(this.kind, { flags });
    }

    // Returns the ids of all selected elements.
    async ids() {
        return this.crowd === null ? this.chosen.map(({ id }) => id) : this.crowd.ids(this.#mesh);
    }

    // Selects the members of a Crowd, at once; if they are few, their data is then read.
    async choose(crowd) {
        const choice = ++this.#choice;
        if (crowd.count === 0) {
            this.clear();
            return;
        }
        this.#set([], null, [], crowd);
        this.#onChange();
        if (crowd.count <= MOST_READ) {
            const ids = await crowd.ids(this.#mesh);
            if (choice === this.#choice) {
                await this.selectAll(crowd.kind, ids);
            }
        }
    }

    // Selects an element; if `also` is true, elements of the same kind that were selected before
    // stay selected.
    async select(kind, id, also = false) {
        const choice = ++this.#choice;
        const change = this.#change;
        let read = null;
        try {
            const element = await api.getElement(this.#mesh, kind, id);
            read = { element, around: await this.#describe({ kind, element }) };
        } finally {
            if (choice === this.#choice) {
                this.#take(kind, id, also, read);
                // If the mesh has changed meanwhile, the other selected elements, or the answers
                // about this element, are outdated and read again.
                if (change !== this.#change || this.#seen !== this.#change) {
                    await this.#readAgain();
                }
            }
        }
    }

    // Selects several elements of one kind, in place of those that were selected; leaves out those
    // that do not exist.
    async selectAll(kind, ids) {
        const choice = ++this.#choice;
        const change = this.#change;
        if (ids.length > MOST_READ) {
            const crowd = await Crowd.read(this.#mesh, kind, ids, this.#geometryNow());
            if (choice === this.#choice) {
                await this.choose(crowd);
            }
            return;
        }
        const [chosen] = await readAll(this.#mesh, ids.map((id) => ({ kind, id })));
        const around = await this.#describe(chosen.at(-1));
        if (choice === this.#choice) {
            this.#set(chosen, around, []);
            this.#onChange();
            if (change !== this.#change) {
                await this.#readAgain();
            }
        }
    }

    #take(kind, id, also, read) {
        if (read !== null && also && this.crowd?.kind === kind) {
            this.#set([], null, [], this.crowd.with(id, read.element));
            this.#onChange();
        } else if (read !== null) {
            const others = also ? this.chosen.filter((s) => s.kind === kind && s.id !== id) : [];
            this.#set([...others, { kind, id, element: read.element }], read.around, []);
            this.#onChange();
        }
    }

    // Selects the element that choose() in pick.js returned; if it is null, clears the selection.
    async pick(chosen, also) {
        if (chosen === null) {
            this.clear();
            return;
        }
        const id = await this.idOf(chosen);
        if (id !== null) {
            await this.select(chosen.kind, id, also);
        }
    }

    // Returns the id of the element that choose() in pick.js returned, or null if the mesh does not
    // have it any more.
    async idOf({ kind, id, from, to }) {
        if (id !== undefined) {
            return id;
        }
        const halfedge = await api.findHalfedge(this.#mesh, from, to);
        // The half-edges of edge e are 2e and 2e + 1.
        return halfedge !== null && kind === 'edge' ? Math.floor(halfedge / 2) : halfedge;
    }

    // Selects the half-edge that is 'next', 'prev' or 'twin' of the selected half-edge.
    async step(link) {
        if (this.last?.kind === 'halfedge') {
            await this.select('halfedge', this.last.element[link]);
        }
    }

    clear() {
        this.#choice++;
        if (this.count + this.gone.length > 0) {
            this.#set([], null, []);
            this.#onChange();
        }
    }

    #set(chosen, around, gone, crowd = null) {
        Object.assign(this, { chosen, around, gone, crowd });
    }

    // Called when the mesh has changed: reads the selected elements again. Returns a function that
    // puts the results into this object; it does nothing if the user has selected something else or
    // the mesh has changed again.
    async read() {
        const change = ++this.#change;
        const choice = this.#choice;
        const [[chosen, lost], [, stillGone]] = await Promise.all(
            [this.chosen, this.gone].map((elements) => readAll(this.#mesh, elements)),
        );
        const around = await this.#describe(chosen.at(-1));
        return () => {
            if (choice === this.#choice && change === this.#change) {
                this.#seen = change;
                const crowd = this.crowd?.keptIn(this.#geometryNow()) ?? null;
                const isLeft = crowd !== null && crowd.count > 0;
                this.#set(chosen, around, [...stillGone, ...lost], isLeft ? crowd : null);
            }
        };
    }

    async #readAgain() {
        const put = await this.read();
        put();
        this.#onChange();
    }

    async #describe(chosen) {
        return chosen === undefined
            ? null
            : describe(chosen.kind, chosen.element, (queries) => api.query(this.#mesh, queries));
    }

    // Returns those selected elements that the arrays `geometry` contain, as marks for the
    // renderer: {kind: 'face', id}, {kind: 'vertex', id}, or {kind: 'edge' or 'halfedge', from,
    // to}.
    marksIn(geometry) {
        return this.chosen.map(markOf).filter((mark) => isIn(geometry, mark));
    }

    // Returns the half-edges to draw as arrows: those around the element selected last, if the
    // arrays `geometry` contain them.
    arrowsIn(geometry) {
        return (this.around?.halfedges ?? []).filter(({ origin, target, face, across }) =>
            isIn(geometry, { kind: 'edge', from: origin, to: target }) &&
            isIn(geometry, { kind: 'face', id: face ?? across }),
        );
    }
}

// Returns whether the arrays `geometry` contain an element, given as a mark for the renderer.
export function isIn(geometry, { kind, id, from, to }) {
    if (kind === 'face') {
        return trianglesOfFace(geometry, id).length > 0;
    }
    return kind === 'vertex'
        ? hasVertex(geometry, id)
        : hasVertex(geometry, from) && hasVertex(geometry, to);
}

// Returns the mark that the renderer draws for an element, see Selection.marksIn().
export function markOf({ kind, id, element }) {
    if (kind === 'face' || kind === 'vertex') {
        return { kind, id };
    }
    const [from, to] = kind === 'edge' ? element.vertices : [element.origin, element.target];
    return { kind, from, to };
}

// Reads some elements, {kind, id} each. Returns two arrays: {kind, id, element} of those that
// exist, and {kind, id, detail} of those that were deleted.
export async function readAll(mesh, chosen) {
    if (chosen.length === 0) {
        return [[], []];
    }
    const answers = await api.query(mesh, chosen.map(({ kind, id }) => ({ get: { [kind]: id } })));
    const read = chosen.map(({ kind, id }, i) => ({ kind, id, answer: answers[i] }));
    return [
        read
            .filter(({ answer }) => !('status' in answer))
            .map(({ kind, id, answer: element }) => ({ kind, id, element })),
        read
            .filter(({ answer }) => 'status' in answer)
            .map(({ kind, id, answer }) => ({ kind, id, detail: answer.detail })),
    ];
}
