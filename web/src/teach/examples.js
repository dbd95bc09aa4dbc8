// examples.js - the examples with a guide: for each one a mesh, and steps with what they say and do.
// Pure.
//
// An example is {title, about, document, steps}; `document` is what POST /v1/meshes takes. A step is
// {text, act}; `act` is null, or one of
//
//   {edit}           operations, a list or a function of the mesh's triangles, see flips.js
//   {select}         {kind, ids} to select
//   {press}          the id of a button of the page to press
//
// A step with `while` is repeated as long as its function of the mesh's triangles returns operations.

import { nextFlip } from './flips.js';

const SHEET = { name: 'sheet', shape: 'grid', width: 4, height: 3, columns: 8, rows: 6 };

// Returns the operations that fold the half of a sheet in front of a crease: `point` and `along` are
// a point and the direction of the crease, in the plane of the sheet.
function fold(point, along, degrees) {
    const [x, y] = along;
    return [
        {
            op: 'select',
            by: 'half_space',
            point,
            normal: [-y, x, 0],
            elements: 'vertices',
            into: 'fold',
        },
        { op: 'transform', vertices: { fold: true }, matrix: turnAround(point, along, degrees) },
    ];
}

// Returns the matrix, 16 numbers row by row, of a rotation around an axis through a point.
export function turnAround(point, along, degrees) {
    const length = Math.hypot(...along);
    const [x, y, z] = along.map((value) => value / length);
    const [c, s] = [Math.cos((degrees * Math.PI) / 180), Math.sin((degrees * Math.PI) / 180)];
    const d = 1 - c;
    const rows = [
        [c + x * x * d, x * y * d - z * s, x * z * d + y * s],
        [y * x * d + z * s, c + y * y * d, y * z * d - x * s],
        [z * x * d - y * s, z * y * d + x * s, c + z * z * d],
    ];
    const moved = rows.map((row) => row.reduce((sum, value, i) => sum + value * point[i], 0));
    return [...rows.flatMap((row, i) => [...row, point[i] - moved[i]]), 0, 0, 0, 1];
}

const CREASES = [
    { point: [0.3, 0, 0], along: [0.4, -1, 0] },
    { point: [-0.9, 0, 0], along: [0.3, 1, 0] },
];

// The faces of a board of 6 x 6 squares that have the colour of its corner.
const DARK = [...Array(36).keys()].filter((face) => (face + Math.floor(face / 6)) % 2 === 0);

// Twelve points around an oval, as a fan of triangles around the first point.
const OVAL = {
    name: 'fan',
    vertices: [...Array(12).keys()].map((i) => {
        const angle = (i * Math.PI) / 6;
        const radius = 1 + 0.06 * ((i * 5) % 7);
        return [2 * radius * Math.cos(angle), radius * Math.sin(angle), 0];
    }),
    faces: [...Array(10).keys()].map((i) => [0, i + 1, i + 2]),
};

export const EXAMPLES = [
    {
        title: 'Fold a sheet of paper',
        about: 'Creases are cut into a sheet by planes, and each side is turned around its crease.',
        document: SHEET,
        steps: [
            {
                text: 'This sheet is a grid of quads. All of its outer half-edges are at the boundary: they have no face.',
                act: null,
            },
            {
                text:
                    'The operation plane_split makes a crease. Where the plane crosses an edge it makes a ' +
                    'vertex, and where it crosses a face an edge. Nothing moves.',
                act: {
                    edit: [{ op: 'plane_split', point: CREASES[0].point, normal: [1, 0.4, 0] }],
                },
            },
            {
                text:
                    'The operation select names the vertices beyond the crease, and transform turns them ' +
                    'around it. Both are one step of the history, because they were sent as one list.',
                act: { edit: fold(CREASES[0].point, CREASES[0].along, 75) },
            },
            {
                text: 'A second crease on the other side of the sheet.',
                act: {
                    edit: [{ op: 'plane_split', point: CREASES[1].point, normal: [1, -0.3, 0] }],
                },
            },
            {
                text:
                    'The second fold. The links between the half-edges are those of the flat sheet: only ' +
                    'positions have changed. Undo unfolds it again, to the last bit.',
                act: { edit: fold(CREASES[1].point, CREASES[1].along, 60) },
            },
        ],
    },
    {
        title: 'A chessboard with holes',
        about: 'Faces that meet only in a vertex make it a bow-tie. The check finds them, and one operation parts them.',
        document: { name: 'board', shape: 'grid', width: 6, height: 6, columns: 6, rows: 6 },
        steps: [
            { text: 'A board of 36 squares. It is one component with one boundary loop.', act: null },
            {
                text: 'Here the squares of one colour are selected.',
                act: { select: { kind: 'face', ids: DARK } },
            },
            {
                text:
                    'They are deleted in one step. Now the other squares touch only at their corners. Such a ' +
                    'vertex is a bow-tie: its faces form more than one fan, and a walk around it by twin and ' +
                    'next reaches only one of them.',
                act: { edit: DARK.map((face) => ({ op: 'face_delete', face })) },
            },
            { text: 'The check lists each bow-tie, with a way to see it.', act: { press: 'check' } },
            {
                text:
                    'separate_bowties gives each fan a vertex of its own. The board falls into many ' +
                    'components, which you find in the statistics.',
                act: { edit: [{ op: 'separate_bowties' }] },
            },
        ],
    },
    {
        title: 'Flips that spread',
        about: 'A triangulation becomes Delaunay by flips of edges, each of which may make another one necessary.',
        document: OVAL,
        steps: [
            {
                text:
                    'A fan of long triangles. An edge between two triangles is Delaunay if the circle around ' +
                    'one of them does not contain the far corner of the other one.',
                act: null,
            },
            {
                text:
                    'This edge was not Delaunay and was flipped: it joins the other two corners of its two ' +
                    'triangles. The edges around it may have become wrong by that, so flips spread.',
                act: { edit: (triangles) => nextFlip(triangles) },
                while: (triangles) => nextFlip(triangles),
            },
            {
                text:
                    'Now every edge is Delaunay. No other triangulation of these points has a larger smallest ' +
                    'angle. The operation delaunay does all of this in one step, and finds nothing left to do here.',
                act: { edit: [{ op: 'delaunay' }] },
            },
        ],
    },
    {
        title: 'A progressive mesh',
        about: 'A coarse mesh and a list of vertex splits, each of which adds one vertex.',
        document: { name: 'ball', shape: 'icosphere', subdivisions: 4 },
        steps: [
            {
                text: 'A ball of 5,120 triangles, made by dividing the triangles of an icosahedron.',
                act: null,
            },
            {
                text:
                    'The server has collapsed edges until few triangles were left, and sends the coarse mesh ' +
                    'first. Each vertex split that follows undoes a collapse. Move the slider to see any ' +
                    'level; every level is a mesh without gaps.',
                act: { press: 'progressive' },
            },
        ],
    },
];
