// related.js - which elements of a kind belong to the selected elements. Pure.

import { KIND_OF } from '../geometry/kinds.js';

// The members of an element, as the server sends it, that have ids of elements of a kind.
const MEMBERS = {
    vertices: ['vertices', 'origin', 'target'],
    faces: ['face', 'faces'],
    halfedges: ['halfedge', 'halfedges'],
    edges: ['edge'],
};

// Returns the ids of the selected elements of this kind or, if the selected elements are of another
// kind, of the elements of this kind beside them. `chosen` are elements {kind, id, element}.
export function relatedTo(chosen, kind) {
    const ids = chosen.flatMap(({ kind: own, id, element }) => {
        if (own === KIND_OF[kind]) {
            return [id];
        }
        const found = MEMBERS[kind].flatMap((member) => element[member] ?? []);
        // An element names its half-edges, and half-edges 2e and 2e + 1 are those of edge e.
        const edges =
            kind === 'edges' && own === 'face' ? element.halfedges.map((one) => one >>> 1) : [];
        return [...found, ...edges].filter((one) => one !== null);
    });
    return [...new Set(ids)];
}
