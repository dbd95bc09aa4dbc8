// steps.js - divides an edit into steps, each of which changes a few links between half-edges. Pure.
//
// The states before and after the edit are those of region.js. A step is
// {title, text, state, focus, links}: `state` is the state after the step, in which half-edges that
// are not yet linked have next and prev null; `focus` lists the elements that the step is about, as
// {kind, id}; `links` lists changed links as {halfedge, from, to}, half-edges of which the second or
// the third may be null.

import { PLURALS } from '../geometry/kinds.js';

// Returns the steps from one state to another. The first step shows the mesh before the edit, the
// last one the mesh after it.
export function stepsOf(before, after) {
    const steps = new Steps(before, after);
    steps.makeVertices();
    steps.makeEdges();
    steps.makeFaces();
    steps.moveVertices();
    steps.setOrigins();
    steps.setLinks();
    steps.setFaces();
    steps.remove();
    return steps.end();
}

// Returns the Euler characteristic of a state, V - E + F.
export function eulerOf({ counts }) {
    return counts.vertices - counts.edges + counts.faces;
}

class Steps {
    #before;
    #after;
    #state;
    #steps;

    constructor(before, after) {
        [this.#before, this.#after] = [before, after];
        this.#state = copyOf(before);
        this.#steps = [
            {
                title: 'Before',
                text: 'This is the part of the mesh that the operation changes, as it is now.',
                state: copyOf(before),
                focus: [],
                links: [],
            },
        ];
    }

    makeVertices() {
        const made = missing(this.#after.vertices, this.#before.vertices);
        for (const id of made) {
            this.#state.vertices.set(id, this.#after.vertices.get(id));
        }
        this.#state.counts.vertices += made.length;
        this.#add(made, 'vertex', 'made', '');
    }

    makeEdges() {
        const halfedges = missing(this.#after.halfedges, this.#before.halfedges);
        for (const id of halfedges) {
            const { origin } = this.#after.halfedges.get(id);
            this.#state.halfedges.set(id, { next: null, prev: null, origin, face: null });
        }
        const made = [...new Set(halfedges.map((id) => id >> 1))];
        this.#state.counts.edges += made.length;
        const pairs = made.map((edge) => `${2 * edge} and ${2 * edge + 1}`);
        const those = made.length > 4 ? '' : `: the half-edges ${pairs.join(', ')}`;
        this.#add(made, 'edge', 'made', `${those}. The two half-edges of an edge are twins`);
    }

    makeFaces() {
        const made = missing(facesOf(this.#after), facesOf(this.#before));
        this.#state.counts.faces += made.length;
        this.#add(made, 'face', 'made', '. No half-edge belongs to it yet', '. No half-edge belongs to them yet');
    }

    // Moves vertices that stay.
    moveVertices() {
        const moved = [...this.#before.vertices.keys()].filter((id) => {
            const to = this.#after.vertices.get(id);
            return to !== undefined && `${to}` !== `${this.#before.vertices.get(id)}`;
        });
        for (const id of moved) {
            this.#state.vertices.set(id, this.#after.vertices.get(id));
        }
        this.#add(moved, 'vertex', 'moved', '');
    }

    // Half-edges that stay and begin at another vertex now.
    setOrigins() {
        for (const [id, was, is] of this.#changed('origin')) {
            this.#state.halfedges.get(id).origin = is;
            this.#push(
                `Origin of half-edge ${id}`,
                `Half-edge ${id} begins at vertex ${is} now, and no longer at vertex ${was}.`,
                [
                    { kind: 'halfedge', id },
                    { kind: 'vertex', id: is },
                ],
            );
        }
    }

    // Links of next and prev. Setting next of one half-edge also sets prev of the other.
    setLinks() {
        for (const [id, was, is] of this.#changed('next')) {
            this.#state.halfedges.get(id).next = is;
            const after = this.#state.halfedges.get(is);
            if (after !== undefined) {
                after.prev = id;
            }
            const instead = was === null ? '' : ` instead of ${was}`;
            this.#push(
                `Next of half-edge ${id}`,
                `next of ${id} is ${is} now${instead}, and so prev of ${is} is ${id}.`,
                [{ kind: 'halfedge', id }],
                [{ halfedge: id, from: was, to: is }],
            );
        }
        // Links of half-edges outside of the part that is drawn.
        for (const [id, , is] of this.#changed('prev')) {
            this.#state.halfedges.get(id).prev = is;
        }
    }

    // Half-edges that come to another face, those of one face in one step.
    setFaces() {
        const groups = new Map();
        for (const [id, , face] of this.#changed('face')) {
            groups.set(face, [...(groups.get(face) ?? []), id]);
        }
        for (const [face, ids] of groups) {
            for (const id of ids) {
                this.#state.halfedges.get(id).face = face;
            }
            const one = ids.length === 1;
            const those = `Half-edge${one ? '' : 's'} ${ids.join(', ')}`;
            const text =
                face === null
                    ? `${those} ${one ? 'is' : 'are'} at a boundary now: ${one ? 'it has' : 'they have'} no face.`
                    : `${those} belong${one ? 's' : ''} to face ${face} now. A loop of half-edges that follow ` +
                      'each other by next goes once around its face.';
            this.#push(
                face === null ? 'A boundary' : `The loop of face ${face}`,
                text,
                ids.map((id) => ({ kind: 'halfedge', id })),
            );
        }
    }

    // Removes what does not exist any more.
    remove() {
        const faces = missing(facesOf(this.#before), facesOf(this.#after));
        this.#state.counts.faces -= faces.length;
        this.#add(faces, 'face', 'deleted', '');
        const halfedges = missing(this.#before.halfedges, this.#after.halfedges);
        const edges = [...new Set(halfedges.map((id) => id >> 1))];
        this.#state.counts.edges -= edges.length;
        halfedges.forEach((id) => this.#state.halfedges.delete(id));
        this.#add(edges, 'edge', 'deleted', '. Both of its half-edges go', '. Their half-edges go with them');
        const vertices = missing(this.#before.vertices, this.#after.vertices);
        this.#state.counts.vertices -= vertices.length;
        vertices.forEach((id) => this.#state.vertices.delete(id));
        this.#add(vertices, 'vertex', 'deleted', '');
    }

    end() {
        const [was, is] = [this.#before, this.#after].map(eulerOf);
        const end =
            was === is
                ? `The Euler characteristic, V \u2212 E + F, is ${is} as before.`
                : `The Euler characteristic, V \u2212 E + F, was ${was} and is ${is}: the surface has another shape.`;
        this.#steps.push({
            title: 'After',
            text: `This is the mesh after the operation. ${end}`,
            state: copyOf(this.#after),
            focus: [],
            links: [],
        });
        return this.#steps;
    }

    // Returns [id, old value, new value] of each half-edge that stays or was made and whose field
    // changes.
    #changed(field) {
        return [...this.#after.halfedges]
            .map(([id, record]) => [id, this.#state.halfedges.get(id)?.[field], record[field]])
            .filter(([, was, is]) => was !== undefined && was !== is);
    }

    #add(ids, kind, done, end, ends = end) {
        if (ids.length === 0) {
            return;
        }
        const one = ids.length === 1;
        const name = one ? `${capital(kind)} ${ids[0]}` : `${capital(PLURALS[kind])} ${list(ids)}`;
        this.#push(
            `${name} ${done}`,
            `${name} ${one ? 'is' : 'are'} ${done}${one ? end : ends}.`,
            ids.map((id) => ({ kind, id })),
        );
    }

    #push(title, text, focus, links = []) {
        this.#steps.push({ title, text, state: copyOf(this.#state), focus, links });
    }
}

function copyOf({ halfedges, vertices, counts }) {
    return {
        halfedges: new Map([...halfedges].map(([id, record]) => [id, { ...record }])),
        vertices: new Map(vertices),
        counts: { ...counts },
    };
}

// Returns the faces of a state, as a map whose keys are their ids.
function facesOf({ halfedges }) {
    const faces = [...halfedges.values()].map(({ face }) => face).filter((face) => face !== null);
    return new Map(faces.map((face) => [face, true]));
}

// Returns the keys of one map that another one lacks, in order.
function missing(map, other) {
    return [...map.keys()].filter((id) => !other.has(id)).sort((a, b) => a - b);
}

const capital = (word) => `${word[0].toUpperCase()}${word.slice(1)}`;

// Returns ids in words, only the first ones if they are many.
function list(ids) {
    return ids.length > 6 ? `${ids.slice(0, 5).join(', ')} and ${ids.length - 5} more` : ids.join(', ');
}
