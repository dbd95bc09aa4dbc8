// mends.js - how each finding of the check lens can be mended. Pure.
//
// A mend is {label, done, make}: the words of its button, the words after it was done, and a
// function that returns a promise of the operations. Its argument `facesOf(face)` reads the ids of
// the faces of a component. A mend of all findings of a group has `title`, too, the words of the
// button that offers it. If it has `parts`, its operations are independent of each other, and
// `parts` names them, as in ['face', 'faces']: those that are refused can be left out.

// Edges of a face count as short if they are shorter than this part of the longest.
const SHORT = 1e-3;

const always = (...operations) => async () => operations;

// The mends of a boundary loop; `wantsTriangles` says that the mesh consists of triangles, or that the
// loop is not flat, so that one face would not be flat, either.
export function mendsOfLoop({ halfedge }, wantsTriangles) {
    const fill = (method) => always({ op: 'hole_fill', halfedge, method });
    const mends = [
        { label: 'Fill with one face', done: 'The hole is filled.', make: fill('polygon') },
        { label: 'Fill with triangles', done: 'The hole is filled.', make: fill('triangulate') },
    ];
    const smooth = { label: 'Fill smoothly', done: 'The hole is filled.', make: fill('smooth') };
    return [...(wantsTriangles ? mends.reverse() : mends), smooth];
}

export function mendsOfComponent({ face }) {
    return [
        {
            label: 'Delete the component',
            done: 'The component is deleted.',
            make: async (facesOf) => [{ op: 'face_delete', faces: await facesOf(face) }],
        },
        {
            label: 'Turn it over',
            done: 'The faces of the component look the other way now.',
            make: async (facesOf) => [{ op: 'reverse', faces: await facesOf(face) }],
        },
    ];
}

// By the code of a defect, the mends of one; `element` is the element of the API that has it.
const MENDS = {
    bowtie: ({ id }) => [
        {
            label: 'Split the vertex',
            done: 'Each fan of faces has a vertex of its own now.',
            make: always({ op: 'vertex_separate', vertices: [id] }),
        },
    ],
    isolated_vertex: ({ id }) => [
        {
            label: 'Delete the vertex',
            done: 'The vertex is deleted.',
            make: always({ op: 'vertex_delete', vertex: id }),
        },
    ],
    duplicate_position: ({ id, other }) => [
        {
            label: 'Weld the two vertices',
            done: 'The vertices are welded.',
            make: always({ op: 'vertex_weld', vertices: [other, id], position: 'lowest' }),
        },
    ],
    zero_length_edge: ({ id }) => [
        {
            label: 'Collapse the edge',
            done: 'The edge is collapsed.',
            make: always({ op: 'edge_collapse', edge: id }),
        },
    ],
    degenerate_face: (defect, element, lengths) => [
        ...mendsOfSliver(element, lengths),
        {
            label: 'Delete the face',
            done: 'The face is deleted.',
            make: always({ op: 'face_delete', faces: [defect.id] }),
        },
    ],
    nonplanar_face: ({ id }) => [
        {
            label: 'Cut into triangles',
            done: 'The face is cut into triangles.',
            make: always({ op: 'face_triangulate', faces: [id] }),
        },
    ],
    small_component: ({ id }) => mendsOfComponent({ face: id }).slice(0, 1),
    inside_out_component: ({ id }) => mendsOfComponent({ face: id }).reverse(),
};

// Returns the mends of a face without area that do not delete it. A face with a short edge is mended
// by collapsing this edge; a triangle whose corners lie in a line, by flipping its longest edge.
function mendsOfSliver(face, lengths) {
    if (face === undefined || lengths.length === 0) {
        return [];
    }
    const edgeAt = (i) => Math.floor(face.halfedges[i] / 2);
    const [shortest, longest] = [Math.min(...lengths), Math.max(...lengths)];
    if (shortest <= SHORT * longest) {
        const edge = edgeAt(lengths.indexOf(shortest));
        const make = always({ op: 'edge_collapse', edge });
        return [{ label: 'Collapse its shortest edge', done: 'The edge is collapsed.', make }];
    }
    const make = always({ op: 'edge_flip', edge: edgeAt(lengths.indexOf(longest)) });
    return face.degree === 3
        ? [{ label: 'Flip its longest edge', done: 'The edge is flipped.', make }]
        : [];
}

// Returns the mends of a defect, as the server sent it; `element` is the element that has it, and
// `lengths` are those of its edges if it is a face.
export function mendsOfDefect(defect, element, lengths) {
    return MENDS[defect.code]?.(defect, element, lengths) ?? [];
}

const each = (items, make) => async () => items.map(make);

// By the name of a group, the mend of all its findings; `thresholds` are those of the check.
const ALL = {
    loops: (loops, isTriangles) => ({
        title: 'Fill all',
        label: 'Fill them',
        done: 'The holes are filled.',
        make: always({ op: 'fill_holes', method: isTriangles ? 'triangulate' : 'polygon' }),
    }),
    bowtie: () => ({
        title: 'Split all',
        label: 'Split them',
        done: 'The bow-ties are split.',
        make: always({ op: 'separate_bowties' }),
    }),
    isolated_vertex: () => ({
        title: 'Delete all',
        label: 'Delete them',
        done: 'The isolated vertices are deleted.',
        make: always({ op: 'delete_isolated' }),
    }),
    duplicate_position: (defects, isTriangles, { merge }) => ({
        title: 'Weld all',
        label: 'Weld them',
        done: 'The vertices are welded.',
        make: always({ op: 'weld', tolerance: merge }),
    }),
    zero_length_edge: (defects, isTriangles, { merge }) => ({
        title: 'Weld the ends of all',
        label: 'Weld their ends',
        done: 'The ends of the edges are welded.',
        make: always({ op: 'weld', tolerance: merge }),
    }),
    nonplanar_face: (defects) => ({
        title: 'Cut all into triangles',
        label: 'Cut them',
        done: 'The faces are cut into triangles.',
        parts: ['face', 'faces'],
        make: each(defects, ({ id }) => ({ op: 'face_triangulate', faces: [id] })),
    }),
    small_component: (defects) => ({
        title: 'Delete all',
        label: 'Delete them',
        done: 'The small components are deleted.',
        parts: ['component', 'components'],
        make: ofComponents('face_delete', defects),
    }),
    inside_out_component: (defects) => ({
        title: 'Turn all over',
        label: 'Turn them over',
        done: 'The components are turned over.',
        parts: ['component', 'components'],
        make: ofComponents('reverse', defects),
    }),
};

const ofComponents = (op, defects) => (facesOf) =>
    Promise.all(defects.map(async ({ id }) => ({ op, faces: await facesOf(id) })));

// Returns the mend of all findings of a group, or null if there is none. `found` are the findings
// as the server sent them.
export function mendOfAll(name, found, isTriangles, thresholds) {
    return found.length > 1 ? (ALL[name]?.(found, isTriangles, thresholds) ?? null) : null;
}
