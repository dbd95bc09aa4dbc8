// selection.js - the selection in a mesh, kept while the mesh changes. No page in here.
//
// While an element is read, another one may be selected and the mesh may change: the last selection
// stays, and is read again if the mesh has changed since.

import * as api from './api.js';
import { describe } from './around.js';
import { hasVertex, trianglesOfFace } from './geometry.js';

export class Selection {
    chosen = []; // {kind, id, element}, in the order of selection
    around = null; // result of describe() for the last one
    gone = []; // {kind, id, detail} of selected elements that an edit removed

    #mesh = null;
    #onChange;
    #choice = 0; // counts selections by the user
    #change = 0; // counts changes of the mesh
    #seen = 0; // the change after which the shown data was read

    // `onChange()` is called when the selection changes.
    constructor(onChange) {
        this.#onChange = onChange;
    }

    // Starts with an empty selection in a mesh.
    reset(mesh) {
        this.#mesh = mesh;
        this.#choice++;
        this.#set([], null, []);
    }

    get last() {
        return this.chosen.at(-1);
    }

    // Selects an element; `also` keeps elements selected before it, if they are of the same kind.
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
                // Other selected elements, or what was read of this one, may be outdated.
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

    // Selects what pick.js chose; null selects nothing.
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

    // Returns the id of what pick.js chose, or null if it is gone.
    async idOf({ kind, id, from, to }) {
        if (id !== undefined) {
            return id;
        }
        const halfedge = await api.findHalfedge(this.#mesh, from, to);
        // The half-edges of edge e are 2e and 2e + 1.
        return halfedge !== null && kind === 'edge' ? Math.floor(halfedge / 2) : halfedge;
    }

    // Follows a link of the selected half-edge: 'next', 'prev' or 'twin'.
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

    // The mesh has changed: reads the selected elements again. Returns a function that installs the
    // result; it does nothing if the selection or the mesh changed meanwhile.
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

    // Returns the selected elements that the renderer's arrays contain: {kind: 'face', id}, {kind:
    // 'vertex', id}, or {kind: 'edge' or 'halfedge', from, to}.
    marksIn(geometry) {
        return this.chosen.map(markOf).filter((mark) => isIn(geometry, mark));
    }

    // Returns the half-edges near the last selected element that the arrays contain.
    arrowsIn(geometry) {
        return (this.around?.halfedges ?? []).filter(({ origin, target, face, across }) =>
            isIn(geometry, { kind: 'edge', from: origin, to: target }) &&
            isIn(geometry, { kind: 'face', id: face ?? across }),
        );
    }
}

// Returns whether the arrays contain the element.
export function isIn(geometry, { kind, id, from, to }) {
    if (kind === 'face') {
        return trianglesOfFace(geometry, id).length > 0;
    }
    return kind === 'vertex'
        ? hasVertex(geometry, id)
        : hasVertex(geometry, from) && hasVertex(geometry, to);
}

// Converts an element for the renderer, see Selection.marksIn().
export function markOf({ kind, id, element }) {
    if (kind === 'face' || kind === 'vertex') {
        return { kind, id };
    }
    const [from, to] = kind === 'edge' ? element.vertices : [element.origin, element.target];
    return { kind, from, to };
}

// Reads some elements, {kind, id} each, and returns those that are still live and those that are
// not.
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
