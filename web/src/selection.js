// selection.js - what is selected in a mesh, kept while the mesh changes. No page in here.
//
// Reading takes time, in which something else may be selected and the mesh may change: what is
// selected last stays, and is read again where the mesh has changed since.

import * as api from './api.js';
import { describe } from './around.js';
import { hasVertex, trianglesOfFace } from './geometry.js';

export class Selection {
    chosen = []; // {kind, id, element}, the last chosen last
    around = null; // what describe() says of the last one
    gone = []; // {kind, id, detail} of what was selected until an edit took it away

    #mesh = null;
    #onChange;
    #choice = 0; // of the user
    #change = 0; // of the mesh
    #seen = 0; // the change that what is shown was read after

    // `onChange()` is called when something else was selected.
    constructor(onChange) {
        this.#onChange = onChange;
    }

    // Begin anew with nothing selected in a mesh.
    reset(mesh) {
        this.#mesh = mesh;
        this.#choice++;
        this.#set([], null, []);
    }

    get last() {
        return this.chosen.at(-1);
    }

    // Select an element; `also` keeps those selected before it, if they are of the same kind.
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
                // What was selected before, or what was read of this one, may be older.
                if (change !== this.#change || this.#seen !== this.#change) {
                    await this.#readAgain();
                }
            }
        }
    }

    #take(kind, id, also, read) {
        if (read !== null) {
            const others = also ? this.chosen.filter((s) => s.kind === kind && s.id !== id) : [];
            this.#set([...others, { kind, id, element: read.element }], read.around, []);
            this.#onChange();
        }
    }

    // Select what pick.js chose; null selects nothing.
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

    // The id of what pick.js chose, or null where it is gone meanwhile.
    async idOf({ kind, id, from, to }) {
        if (id !== undefined) {
            return id;
        }
        const halfedge = await api.findHalfedge(this.#mesh, from, to);
        // The half-edges of edge e are 2e and 2e + 1.
        return halfedge !== null && kind === 'edge' ? Math.floor(halfedge / 2) : halfedge;
    }

    // Follow a link of the selected half-edge: 'next', 'prev' or 'twin'.
    async step(link) {
        if (this.last?.kind === 'halfedge') {
            await this.select('halfedge', this.last.element[link]);
        }
    }

    clear() {
        this.#choice++;
        if (this.chosen.length + this.gone.length > 0) {
            this.#set([], null, []);
            this.#onChange();
        }
    }

    #set(chosen, around, gone) {
        Object.assign(this, { chosen, around, gone });
    }

    // The mesh has changed: read what is selected as it is now. Returns a function that puts it in
    // place, and does nothing where something else was selected or the mesh changed meanwhile.
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
                this.#set(chosen, around, [...stillGone, ...lost]);
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

    // The selected elements for the renderer, those that its arrays have: {kind: 'face', id},
    // {kind: 'vertex', id}, or {kind: 'edge' or 'halfedge', from, to}.
    marksIn(geometry) {
        return this.chosen.map(markOf).filter((mark) => isIn(geometry, mark));
    }

    // The half-edges near the last selected element, likewise.
    arrowsIn(geometry) {
        return (this.around?.halfedges ?? []).filter(({ origin, target, face, across }) =>
            isIn(geometry, { kind: 'edge', from: origin, to: target }) &&
            isIn(geometry, { kind: 'face', id: face ?? across }),
        );
    }
}

// Have the arrays what is to be marked?
export function isIn(geometry, { kind, id, from, to }) {
    if (kind === 'face') {
        return trianglesOfFace(geometry, id).length > 0;
    }
    return kind === 'vertex'
        ? hasVertex(geometry, id)
        : hasVertex(geometry, from) && hasVertex(geometry, to);
}

// For the renderer, see Selection.marksIn().
export function markOf({ kind, id, element }) {
    if (kind === 'face' || kind === 'vertex') {
        return { kind, id };
    }
    const [from, to] = kind === 'edge' ? element.vertices : [element.origin, element.target];
    return { kind, from, to };
}

// What still lives of some elements, {kind, id} each, as it is now, and what does not.
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
