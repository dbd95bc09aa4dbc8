// told.js - says in words and marks what an edit did, for the drawings of operations. Pure.

const KINDS = ['vertex', 'edge', 'face'];

const pluralOf = (kind) => (kind === 'vertex' ? 'vertices' : `${kind}s`);

// Lists of more ids than this are only counted.
const MOST_IDS = 8;

function listed(kind, ids) {
    const word = ids.length === 1 ? kind : pluralOf(kind);
    if (ids.length > MOST_IDS) {
        return `${ids.length} ${word}`;
    }
    return `${word} ${ids.slice(0, -1).join(', ')}${ids.length > 1 ? ' and ' : ''}${ids.at(-1)}`;
}

// Returns, for example, "vertices 5 and 6, edge 3, 12 faces" for the sets {vertices, edges, faces}.
export function listedSets(sets = {}) {
    return KINDS.map((kind) => [kind, sets[pluralOf(kind)] ?? []])
        .filter(([, ids]) => ids.length > 0)
        .map(([kind, ids]) => listed(kind, ids))
        .join(', ');
}

export const noMarks = () => ({ vertex: new Map(), edge: new Map(), face: new Map() });

// Adds a mark to the elements of sets that have none, and returns the marks.
export function markSets(marks, sets = {}, word) {
    for (const kind of KINDS) {
        for (const id of sets[pluralOf(kind)] ?? []) {
            if (!marks[kind].has(id)) {
                marks[kind].set(id, word);
            }
        }
    }
    return marks;
}

// A drawing of a larger mesh has the ids of marked elements only, and one with more marks no ids.
const MOST_VERTICES = 20;
const MOST_MARKS = 24;

// Returns the value of `ids` (drawing.js) for a drawing in which all ids can be read.
export function idsOf({ points }, view, marks) {
    const count = marks.vertex.size + marks.edge.size + marks.face.size;
    return count > MOST_MARKS ? 'none' : view === 'top' && points.length <= MOST_VERTICES ? 'vertices' : 'marked';
}

// Returns the sentence that describes a drawing to readers who do not see it.
export function sentenceOf(when, mesh, more = '') {
    const count = mesh.points.filter(Boolean).length;
    return `${when}: ${count} vertices, ${mesh.halfedges.length / 2} edges, ${mesh.faces.length} faces.${more}`;
}
