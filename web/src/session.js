// session.js - the open mesh, what is selected in it, and what may be done to it. No page in here:
// whoever shows it passes `onChange` and reads the properties.
//
// Everything shown is of one revision. An edit names that revision, so that nobody splits what
// another client has changed in the meantime: then the mesh is read again and the refusal shown.

import * as api from './api.js';
import { Elements, pack, slotOf } from './geometry.js';

// How often a mesh that changes while it is being read is read again.
const READS = 5;

export class Session {
    mesh = null; // id, or null when none is open
    summary = null;
    geometry = null; // packed, see geometry.js
    history = { undo: 0, redo: 0 };
    selection = []; // {kind, id, element}, the last chosen last
    loading = null; // part of the mesh that has been read, 0 to 1, or null
    busy = false; // an edit is under way

    #onChange;
    #opening = null;
    #choice = 0;

    // `onChange(what)`: 'mesh' (another), 'revision', 'selection' or 'state' (loading, busy).
    constructor(onChange) {
        this.#onChange = onChange;
    }

    // Open a mesh and show it once all of it is there. A later call overtakes an earlier one.
    async open(mesh) {
        this.#opening?.abort();
        const opening = new AbortController();
        this.#opening = opening;
        try {
            const content = await this.#read(mesh, null, opening.signal);
            Object.assign(this, content, { mesh, selection: [] });
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
        const content = await this.#read(mesh, this.geometry.frame, undefined);
        const selection = await refresh(mesh, this.selection);
        if (this.mesh === mesh) {
            Object.assign(this, content, { selection });
            this.#choice++;
            this.#onChange('revision');
        }
    }

    // Select an element; `also` keeps the one selected before it, if it is of the same kind.
    async select(kind, id, also = false) {
        const choice = ++this.#choice;
        const element = await api.getElement(this.mesh, kind, id);
        if (choice !== this.#choice) {
            return;
        }
        const others = also ? this.selection.filter((s) => s.kind === kind && s.id !== id) : [];
        this.selection = [...others.slice(-1), { kind, id, element }];
        this.#onChange('selection');
    }

    // Select what pick.js chose; null selects nothing.
    async pick(chosen, also) {
        if (chosen === null) {
            this.clearSelection();
            return;
        }
        const { vertexIds, faceIds } = this.geometry;
        if (chosen.kind === 'face') {
            await this.select('face', faceIds[chosen.face], also);
        } else if (chosen.kind === 'vertex') {
            await this.select('vertex', vertexIds[chosen.vertex], also);
        } else {
            const ends = [vertexIds[chosen.from], vertexIds[chosen.to]];
            const edge = await api.findEdge(this.mesh, ...ends);
            if (edge !== null) {
                await this.select('edge', edge, also);
            }
        }
    }

    clearSelection() {
        this.#choice++;
        if (this.selection.length > 0) {
            this.selection = [];
            this.#onChange('selection');
        }
    }

    // The selected elements in slots of `geometry`, for the renderer. What is not in the revision
    // shown has none.
    get marks() {
        return this.selection
            .map(({ kind, id, element }) => this.#markOf(kind, id, element))
            .filter((mark) => Object.values(mark).every((value) => value !== -1));
    }

    #markOf(kind, id, element) {
        const { vertexIds, faceIds } = this.geometry;
        if (kind === 'face') {
            return { kind, face: slotOf(faceIds, id) };
        }
        if (kind === 'vertex') {
            return { kind, vertex: slotOf(vertexIds, id) };
        }
        const [from, to] =
            kind === 'edge' ? element.vertices : [element.origin, element.target];
        return { kind, from: slotOf(vertexIds, from), to: slotOf(vertexIds, to) };
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
            await send(this.summary.revision);
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

    // Summary, geometry and history of one revision.
    async #read(mesh, frame, signal) {
        for (let i = 0; i < READS; i++) {
            const summary = await api.getSummary(mesh, signal);
            const elements = await this.#readElements(mesh, summary.counts, signal);
            const history = await api.getHistory(mesh, signal);
            if (history.revision === summary.revision) {
                return { summary, history, geometry: pack(elements, frame ?? undefined) };
            }
        }
        throw new api.Problem({
            title: 'Mesh too busy',
            detail: 'The mesh changed each time while it was being read.',
        });
    }

    async #readElements(mesh, counts, signal) {
        const elements = new Elements();
        const total = counts.vertices + counts.faces;
        let count = 0;
        for (const [kind, add] of [
            ['vertex', (item) => elements.addVertex(item)],
            ['face', (item) => elements.addFace(item)],
        ]) {
            for await (const items of api.elements(mesh, kind, signal)) {
                items.forEach(add);
                count += items.length;
                this.#setLoading(total > 0 ? Math.min(count / total, 1) : 1);
            }
        }
        return elements;
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
