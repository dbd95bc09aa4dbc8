// offered.js - what the selection offers to the form of an operation: ids of the kinds of elements that
// the operation takes. Pure.

import { formatCount } from '../kit/dom.js';
import { roomFor } from './fields.js';

// By kind of element: the function that returns the ids of the elements of this kind to which a
// selected element of another kind refers.
const LINKS = {
    vertex: (element) => (element.origin === undefined ? [] : [element.origin]),
    edge: (element) => (element.edge === undefined ? [] : [element.edge]),
    face: (element) => (typeof element.face === 'number' ? [element.face] : []),
    halfedge: (element) => element.halfedges?.slice(0, 1) ?? [],
};

// Returns the boundary half-edge that a selected element means, or null: its own, that of its edge, or
// the only one beside it. `near` are the half-edges around the element, see around.js.
function boundaryOf({ kind, id, element }, near) {
    if (kind === 'vertex') {
        return element.boundary ? element.halfedge : null;
    }
    if (kind === 'edge') {
        const side = element.faces.indexOf(null);
        return side < 0 ? null : element.halfedges[side];
    }
    if (kind === 'halfedge') {
        const isInner = near.some((one) => one.id === id && one.across === null);
        return element.boundary ? id : isInner ? element.twin : null;
    }
    const beside = near.filter(({ face }) => face === null);
    return beside.length === 1 ? beside[0].id : null;
}

// The kinds of parameters that a selected element fills, and its name for one and for several.
const TAKEN = {
    vertex: { kinds: ['vertex'], names: ['vertex', 'vertices'] },
    edge: { kinds: ['edge'], names: ['edge', 'edges'] },
    face: { kinds: ['face'], names: ['face', 'faces'] },
    halfedge: { kinds: ['halfedge', 'edge'], names: ['half-edge', 'half-edges'] },
};

// The elements of a Selection, {chosen, crowd, around}.
export class Offered {
    #chosen;
    #crowd;
    #around; // half-edges around the element selected last

    constructor({ chosen = [], crowd = null, around = null } = {}) {
        [this.#chosen, this.#crowd, this.#around] = [chosen, crowd, around?.halfedges ?? []];
    }

    // Returns whether another selection has the same elements.
    isSame(other) {
        return keyOf(this.#chosen) === keyOf(other.#chosen) && this.#crowd === other.#crowd;
    }

    // The set of many elements that is selected, a Crowd, or null.
    get crowd() {
        return this.#crowd;
    }

    // The element that was selected last, or undefined.
    get last() {
        return this.#chosen.at(-1);
    }

    // The kind and the number of the selected elements.
    get kind() {
        return this.#crowd?.kind ?? this.last?.kind;
    }

    get count() {
        return this.#crowd?.count ?? this.#chosen.length;
    }

    // Returns which operations take all selected elements, see Chooser.setFilter(); null if nothing
    // is selected.
    get filter() {
        const { count } = this;
        if (count === 0) {
            return null;
        }
        const { kinds, names } = TAKEN[this.kind];
        return {
            title: count === 1 ? `For the selected ${names[0]}` : `For ${formatCount(count)} ${names[1]}`,
            takes: (operation) => roomFor(operation, kinds) >= count,
        };
    }

    // The ids of the elements that are selected one by one.
    get ids() {
        return this.#chosen.map(({ id }) => id);
    }

    // Returns the ids that the selection offers to a parameter that takes elements of a kind: those of the
    // selected elements of this kind, or else of the elements to which the selected ones refer. If
    // `isAtBoundary` is true, the operation takes only half-edges of the boundary.
    idsOf(kind, isAtBoundary) {
        if (kind === 'halfedge' && isAtBoundary) {
            const ids = this.#chosen.map((chosen) => boundaryOf(chosen, this.#around));
            const found = ids.filter((id) => id !== null);
            if (found.length > 0) {
                return [...new Set(found)];
            }
        }
        const direct = this.#chosen.filter((chosen) => chosen.kind === kind);
        return direct.length > 0
            ? direct.map(({ id }) => id)
            : [...new Set(this.#chosen.flatMap(({ element }) => LINKS[kind](element)))];
    }
}

function keyOf(selection) {
    return selection.map(({ kind, id }) => `${kind}:${id}`).join();
}
