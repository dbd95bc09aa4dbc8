// session.js - the open mesh, what is selected in it, and what may be done to it. No page in here:
// whoever shows it passes `onChange` and reads the properties.
//
// Everything shown is of one revision. An edit names that revision, so that nobody splits what
// another client has changed in the meantime: then the mesh is read again and the refusal shown.

import * as api from './api.js';
import { describe } from './around.js';
import { hasVertex, trianglesOfFace } from './geometry.js';
import { readRevision } from './revision.js';

export class Session {
    shown = null; // see revision.js; null when no mesh is open
    selection = []; // {kind, id, element}, the last chosen last
    around = null; // what describe() says of the last one
    loading = null; // part of the mesh that has been read, 0 to 1, or null
    busy = false; // an edit is under way

    #onChange;
    #opening = null;
    #choice = 0;

    // `onChange(what)`: 'mesh' (another), 'revision', 'selection' or 'state' (loading, busy).
    constructor(onChange) {
        this.#onChange = onChange;
    }

    // The id of the open mesh or null.
    get mesh() {
        return this.shown?.mesh ?? null;
    }

    // Open a mesh and show it once all of it is there. A later call overtakes an earlier one.
    async open(mesh) {
        this.#opening?.abort();
        const opening = new AbortController();
        this.#opening = opening;
        try {
            const shown = await this.#read(mesh, opening.signal);
            Object.assign(this, { shown, selection: [], around: null });
            this.#choice++;
            this.#onChange('mesh');
        } catch (error) {
            if (error.name !== 'AbortError') {
                throw error;
            }
        } finally {
            if (this.#opening === opening) {
                this.#opening = null;
                this.#setLoading(null);
            }
        }
    }

    // Read the mesh again as it is now. What is selected stays selected where it still lives.
    async reload() {
        const { mesh } = this;
        const shown = await this.#read(mesh, undefined);
        const selection = await refresh(mesh, this.selection);
        const around = await this.#describe(mesh, selection.at(-1));
        if (this.mesh === mesh) {
            Object.assign(this, { shown, selection, around });
            this.#choice++;
            this.#onChange('revision');
        }
    }

    // Select an element; `also` keeps those selected before it, if they are of the same kind.
    async select(kind, id, also = false) {
        const choice = ++this.#choice;
        const { mesh } = this;
        const element = await api.getElement(mesh, kind, id);
        const around = await this.#describe(mesh, { kind, element });
        if (choice !== this.#choice) {
            return;
        }
        const others = also ? this.selection.filter((s) => s.kind === kind && s.id !== id) : [];
        this.selection = [...others, { kind, id, element }];
        this.around = around;
        this.#onChange('selection');
    }

    // Select what pick.js chose; null selects nothing.
    async pick(chosen, also) {
        if (chosen === null) {
            this.clearSelection();
            return;
        }
        const { kind, id, from, to } = chosen;
        if (id !== undefined) {
            await this.select(kind, id, also);
            return;
        }
        const halfedge = await api.findHalfedge(this.mesh, from, to);
        if (halfedge !== null) {
            // The half-edges of edge e are 2e and 2e + 1.
            await this.select(kind, kind === 'edge' ? Math.floor(halfedge / 2) : halfedge, also);
        }
    }

    // Follow a link of the selected half-edge: 'next', 'prev' or 'twin'.
    async step(link) {
        const last = this.selection.at(-1);
        if (last?.kind === 'halfedge') {
            await this.select('halfedge', last.element[link]);
        }
    }

    async #describe(mesh, chosen) {
        return chosen === undefined
            ? null
            : describe(chosen.kind, chosen.element, (queries) => api.query(mesh, queries));
    }

    clearSelection() {
        this.#choice++;
        if (this.selection.length > 0) {
            this.selection = [];
            this.around = null;
            this.#onChange('selection');
        }
    }

    // The selected elements for the renderer, those of the revision shown: {kind: 'face', id},
    // {kind: 'vertex', id}, or {kind: 'edge' or 'halfedge', from, to}.
    get marks() {
        return this.selection.map(markOf).filter((mark) => this.#isShown(mark));
    }

    // The half-edges near the last selected element, likewise.
    get arrows() {
        return (this.around?.halfedges ?? []).filter(({ origin, target, face, across }) =>
            this.#isShown({ kind: 'edge', from: origin, to: target }) &&
            this.#isShown({ kind: 'face', id: face ?? across }),
        );
    }

    #isShown({ kind, id, from, to }) {
        const { geometry } = this.shown;
        if (kind === 'face') {
            return trianglesOfFace(geometry, id).length > 0;
        }
        return kind === 'vertex'
            ? hasVertex(geometry, id)
            : hasVertex(geometry, from) && hasVertex(geometry, to);
    }

    // What Split would do: 'edge_split', 'face_poke', 'face_split' or null.
    get split() {
        const kinds = this.selection.map(({ kind }) => kind).join();
        const operations = {
            edge: 'edge_split',
            halfedge: 'edge_split',
            face: 'face_poke',
            'vertex,vertex': 'face_split',
        };
        return operations[kinds] ?? null;
    }

    async splitSelection() {
        const op = this.split;
        const [first, second] = this.selection;
        if (op === 'edge_split') {
            const edge = first.kind === 'edge' ? first.id : first.element.edge;
            await this.#edit((revision) => api.edit(this.mesh, { op, edge }, revision));
        } else if (op === 'face_poke') {
            await this.#edit((revision) => api.edit(this.mesh, { op, face: first.id }, revision));
        } else if (op === 'face_split') {
            const face = await this.#sharedFace(first.id, second.id);
            const operation = { op, face, from: first.id, to: second.id };
            await this.#edit((revision) => api.edit(this.mesh, operation, revision));
        }
    }

    // The face of which two vertices are corners.
    async #sharedFace(a, b) {
        const [ofA, ofB] = await Promise.all(
            [a, b].map((id) => api.getAdjacent(this.mesh, 'vertex', id, 'faces')),
        );
        const face = ofA.find((id) => ofB.includes(id));
        if (face === undefined) {
            throw new api.Problem({
                title: 'No shared face',
                detail: `Vertices ${a} and ${b} are not corners of one face.`,
            });
        }
        return face;
    }

    // Run an operation of the server's table.
    run(operation) {
        return this.#edit((revision) => api.edit(this.mesh, operation, revision));
    }

    undo() {
        return this.#edit((revision) => api.undo(this.mesh, revision));
    }

    redo() {
        return this.#edit((revision) => api.redo(this.mesh, revision));
    }

    async #edit(send) {
        if (this.busy) {
            return;
        }
        this.#setBusy(true);
        try {
            await send(this.shown.revision);
            await this.reload();
        } catch (error) {
            if (error.status === 412) {
                await this.reload();
            }
            throw error;
        } finally {
            this.#setBusy(false);
        }
    }

    #read(mesh, signal) {
        return readRevision(mesh, (part) => this.#setLoading(part), signal);
    }

    #setLoading(part) {
        this.loading = part;
        this.#onChange('state');
    }

    #setBusy(busy) {
        this.busy = busy;
        if (!busy) {
            this.loading = null;
        }
        this.#onChange('state');
    }
}

function markOf({ kind, id, element }) {
    if (kind === 'face' || kind === 'vertex') {
        return { kind, id };
    }
    const [from, to] = kind === 'edge' ? element.vertices : [element.origin, element.target];
    return { kind, from, to };
}

// What still lives of a selection, as it is now.
async function refresh(mesh, selection) {
    if (selection.length === 0) {
        return [];
    }
    const elements = await api.getElements(mesh, selection);
    return selection
        .map(({ kind, id }, i) => ({ kind, id, element: elements[i] }))
        .filter(({ element }) => element !== null);
}
