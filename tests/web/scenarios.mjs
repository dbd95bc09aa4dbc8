// scenarios.mjs - lists for each operation of the server a mesh on which it can be done, and what a
// user puts into its form: elements by clicks, other values by keys.

import { projector, waitForFrame } from './browser.mjs';
import { getAll, post } from './daemon.mjs';
import { chooseOperation, click, fillVector } from './page.mjs';

// A flat grid, so that a click can reach all of it; vertex 4 y + x lies at (x, y).
const GRID = { shape: 'grid', columns: 3, rows: 3 };

const flat = (points, faces) => ({ vertices: points.map(([x, y]) => [x, y, 0]), faces });

const square = (x, y) => [[x, y], [x + 1, y], [x + 1, y + 1], [x, y + 1]];

const PAIR = flat([...square(0, 0), ...square(2, 0)], [[0, 1, 2, 3], [4, 5, 6, 7]]);

// Two squares with a narrow gap between them.
const GAP = flat([...square(0, 0), ...square(1.05, 0)], [[0, 1, 2, 3], [4, 5, 6, 7]]);

// Two triangles that share only vertex 2.
const BOWTIE = flat(
    [[0, 0], [1, 0], [1, 1], [2, 2], [1, 2]],
    [[0, 1, 2], [2, 3, 4]],
);

// A quadrilateral that its longer diagonal divides into two triangles.
const LONG = flat([[-2, 0], [0, -0.5], [2, 0], [0, 0.5]], [[0, 1, 2], [0, 2, 3]]);

// Three triangles inside each other, with quadrilaterals between them.
const nested = (size) => [[-size, -size], [size, -size], [0, size]];
const NESTED = flat(
    [...nested(1), ...nested(2), ...nested(3)],
    [
        [0, 1, 2],
        ...[0, 3].flatMap((low) =>
            [0, 1, 2].map((i) => {
                const j = (i + 1) % 3;
                return [low + 3 + i, low + 3 + j, low + j, low + i];
            }),
        ),
    ],
);

const cube = (x) =>
    [0, 1].flatMap((z) => [[x, 0, z], [x + 1, 0, z], [x + 1, 1, z], [x, 1, z]]);
const sides = (low) =>
    [[0, 3, 2, 1], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]].map(
        (corners) => corners.map((id) => low + id),
    );
const CUBES = { vertices: [...cube(0), ...cube(2)], faces: [...sides(0), ...sides(8)] };

const vertex = (id) => ({ kind: 'vertex', ends: [id] });
const edge = (...ends) => ({ kind: 'edge', ends });
const halfedge = (...ends) => ({ kind: 'halfedge', ends });
const face = (...corners) => ({ kind: 'face', ends: corners });

const MIDDLE = face(5, 6, 10, 9);
const HOLE = [{ op: 'face_delete', face: 4 }];

// Each row is [operation, mesh, values by parameter, edits made before]. Elements among the values
// are clicked in the view, three numbers are typed as a point, true ticks a checkbox, and text is
// typed or chosen.
export const SCENARIOS = [
    ['vertex_add', GRID, { position: [0, 0, 1] }],
    ['vertex_move', GRID, { vertex: [vertex(5), vertex(6)], by: [0, 0, 0.25] }],
    ['vertex_delete', GRID, { vertex: vertex(5), keep_isolated: true }],
    ['vertex_split', GRID, { vertex: vertex(5), left: vertex(6), right: vertex(4), to: vertex(9) }],
    ['vertex_dissolve', GRID, { vertex: vertex(5) }],
    ['vertex_split_corners', GRID, { a: halfedge(5, 6), b: halfedge(5, 4) }],
    ['vertex_bevel', GRID, { vertex: vertex(5), width: '0.1' }],
    ['edge_bisect', GRID, { edge: edge(5, 6), t: '0.25' }],
    ['edge_join', GRID, { vertex: vertex(0) }],
    ['edge_split', GRID, { edge: edge(5, 6) }],
    ['edge_flip', GRID, { edge: edge(5, 6) }],
    ['edge_collapse', GRID, { halfedge: halfedge(5, 6), t: '1' }],
    ['edge_bevel', GRID, { edge: edge(5, 6), width: '0.1' }],
    ['edge_delete', GRID, { edge: [edge(5, 6), edge(9, 10)] }],
    ['edge_cut', GRID, { edge: [edge(5, 6), edge(6, 10)] }],
    ['edge_weld', PAIR, { a: edge(1, 2), b: edge(4, 7), keep: 'a' }],
    ['edge_extrude', GRID, { edge: [edge(0, 1), edge(1, 2)], by: [0, -0.5, 0] }],
    ['face_add', PAIR, { vertices: [vertex(1), vertex(4), vertex(7), vertex(2)] }],
    ['face_delete', GRID, { face: [face(0, 1, 5, 4), MIDDLE] }],
    ['face_split', GRID, { face: MIDDLE, from: vertex(5), to: vertex(10) }],
    ['face_join', GRID, { edge: edge(5, 6) }],
    ['face_poke', GRID, { face: MIDDLE, position: [0, 0, 0.5] }],
    ['face_triangulate', GRID, { face: [face(0, 1, 5, 4), MIDDLE] }],
    ['hole_fill', GRID, { halfedge: halfedge(5, 6), method: 'fan' }, HOLE],
    ['face_extrude', GRID, { face: [MIDDLE, face(6, 7, 11, 10)], distance: '0.3', region: true }],
    ['face_inset', GRID, { face: MIDDLE, factor: '0.3' }],
    ['face_collapse', GRID, { face: MIDDLE }],
    ['loop_bridge', PAIR, { a: halfedge(2, 1), b: halfedge(4, 7) }],
    ['loop_join', CUBES, { a: halfedge(4, 5), b: halfedge(12, 13) }],
    ['loop_split', NESTED, { a: edge(3, 4), b: edge(4, 5), c: edge(5, 3) }],
    ['transform', GRID, { 'rotate z': '30', 'scale x': '2', vertex: [vertex(5), vertex(6)] }],
    ['plane_split', GRID, { point: [0.05, 0, 0], normal: [1, 0, 0], face: [MIDDLE] }],
    ['plane_cut', GRID, { point: vertex(5), normal: [1, 0.5, 0], keep: 'below' }],
    ['material_set', GRID, {
        name: 'steel', base_color: '0.5 0.5 0.6', metallic: '1', two_sided: 'yes', face: [MIDDLE],
    }],
    ['material_delete', GRID, { name: 'steel' }, [
        { op: 'material_set', name: 'steel', faces: [0] },
    ]],
    ['select', GRID, {
        by: 'region', face: [MIDDLE], angle: '30', cross_features: true, elements: 'edges',
        into: 'part',
    }],
    ['segment', CUBES, { angle: '30', features: 'replace', into: 'side' }],
    ['delaunay', LONG, { edge: [edge(0, 2)] }],
    ['compact', GRID, {}, HOLE],
    ['vertex_weld', GRID, { vertex: [vertex(5), vertex(6)], position: 'lowest' }],
    ['vertex_separate', BOWTIE, { vertex: [vertex(2)] }],
    ['weld', GAP, { tolerance: '0.1' }],
    ['separate_bowties', BOWTIE, {}],
    ['delete_isolated', GRID, {}, [{ op: 'vertex_add', position: [0, 0, 0.5] }]],
    ['triangulate', GRID, {}],
    ['reverse', GRID, {}],
    ['dual', CUBES, {}],
    ['decimate', GRID, { faces: '4' }, [{ op: 'triangulate' }]],
    ['remesh', GRID, { target_faces: '30' }, [{ op: 'triangulate' }]],
    ['smooth', { shape: 'cube' }, { method: 'taubin', steps: '3' }],
    ['fill_holes', GRID, { method: 'fan', max_edges: '8' }, HOLE],
    ['deform', GRID, {
        vertex: [vertex(5)], by: [0, 0, 0.5], fixed_vertex: [vertex(0), vertex(15)], steps: '3',
    }],
    ['append', GRID, { mesh: 'which mesh' }],
    ['deviation', GRID, { with: 'which mesh' }],
    ['subdivide', GRID, { scheme: 'catmull_clark', steps: '2' }],
].map(([name, mesh, filled, before = []]) => ({ name, mesh, filled, before }));

// Makes the mesh of a scenario, shows it in the page, and returns its id.
export async function openScenario({ daemon, page }, { name, mesh: content, before }) {
    const { id: mesh } = await post(daemon, '', { ...content, name });
    for (const op of before) {
        await post(daemon, `/${mesh}/edits`, { ops: [op] });
    }
    await page.evaluate((id) => {
        window.location.hash = `#mesh=${id}`;
    }, mesh);
    await waitForFrame(page, { mesh, revision: 1 + before.length });
    return mesh;
}

// Fills the form of a scenario as a visitor does.
export async function fillForm({ daemon, page, mesh }, { name, filled }) {
    await chooseOperation(page, name);
    const place = await projector(page, daemon, mesh);
    for (const [param, value] of Object.entries(filled)) {
        const field = page.locator(`#param-${param.replace(' ', '-')}`);
        const values = [value].flat();
        if (values[0].kind !== undefined) {
            await page.getByRole('button', { name: `Pick ${param} in the view` }).click();
            for (const [i, element] of values.entries()) {
                const at = await placeOf({ daemon, mesh, place }, element);
                await click(page, at);
                await waitForWords(field, i + 1);
            }
        } else if (Array.isArray(value)) {
            await fillVector(page, param, value);
        } else if (value === true) {
            await field.check();
        } else if (param.includes(' ')) {
            await page.getByLabel(param, { exact: true }).fill(value);
        } else if ((await field.evaluate(({ tagName }) => tagName)) === 'SELECT') {
            // The id of a mesh is not known beforehand: 'which mesh' means the open mesh.
            await field.selectOption(value === 'which mesh' ? mesh : value);
        } else {
            await field.fill(value);
        }
    }
}

// Waits until a field contains `count` words: one id for each click, or one coordinate.
async function waitForWords(field, count) {
    const handle = await field.elementHandle();
    await field.page().waitForFunction(
        ([input, wanted]) => input.value.split(' ').filter(Boolean).length === wanted,
        [handle, count],
    );
}

// Returns the place on the canvas where a click picks an element.
async function placeOf({ daemon, mesh, place }, { kind, ends }) {
    const middle = place.at(ends);
    if (kind !== 'halfedge') {
        return middle;
    }
    const corners = new Set(ends);
    const isBeside = ({ vertices }) => vertices.filter((id) => corners.has(id)).length === 2;
    const beside = (await getAll(daemon, mesh, 'faces')).filter(isBeside);
    const follows = ({ vertices }) =>
        vertices[(vertices.indexOf(ends[0]) + 1) % vertices.length] === ends[1];
    const own = beside.find(follows);
    const { x, y } = place.at((own ?? beside[0]).vertices);
    // The click is moved into the half-edge's face, away from the face on the other side of the
    // edge.
    const away = Math.hypot(x - middle.x, y - middle.y);
    const step = (own === undefined ? -5 : 5) / away;
    return { x: middle.x + step * (x - middle.x), y: middle.y + step * (y - middle.y) };
}
