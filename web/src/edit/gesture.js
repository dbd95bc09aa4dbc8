// gesture.js - computes what a drag with a tool does to the selected elements: it returns the lines
// of a preview and the edit to send to the server. Pure.
//
// Points are in view coordinates (see geometry.js); the edit is in coordinates of the mesh.

import { edgesOfTriangles, hasVertex, normalOfFace, pointAt, trianglesOfFace } from '../geometry/geometry.js';
import { membersOf } from '../geometry/sets.js';
import { add, dot, unit } from '../geometry/vectors.js';
import { middleOf, pixelAtOne, reachFrom } from '../geometry/view.js';

// The amount that a tool applies after a click without a drag, as a fraction of the selection's
// size.
const USUAL = 0.2;

// The least and the greatest inset, as fractions of the way from the corners of a face to its
// middle.
const INSET = [0.01, 0.99];

// If a normal of length 1 is shorter than this when projected to the screen, it points almost at
// the viewer or away; then dragging upwards counts as dragging along the normal.
const LEAST_ACROSS = 0.3;

// The tools do not work on more selected elements than this.
const MOST_CROWD = 20000;

// The largest number of lines that preview an edit.
const MOST_LINES = 20000;

// Returns the vector of length 1 with the direction of `a`, or `a` if it has none.
const directionOf = (a) => unit(a) ?? a;

// The operation that a tool runs for each kind of element.
const OPERATIONS = {
    move: {
        vertex: 'vertex_move',
        edge: 'vertex_move',
        halfedge: 'vertex_move',
        face: 'vertex_move',
    },
    extrude: { edge: 'edge_extrude', halfedge: 'edge_extrude', face: 'face_extrude' },
    inset: { face: 'face_inset' },
};

// Starts a tool, 'move', 'extrude' or 'inset', on a Selection: returns a gesture, the data that
// drag() needs, or null if the tool does not fit the selection.
export function begin(tool, selection, geometry) {
    const { kind } = selection;
    const op = OPERATIONS[tool][kind];
    const isNameless = selection.crowd && kind === 'edge' && op !== 'vertex_move';
    if (op === undefined || isNameless || (selection.crowd && selection.count > MOST_CROWD)) {
        return null;
    }
    const chosen = selection.crowd ? membersIn(selection.crowd, geometry) : selection.chosen;
    const ends = chosen.flatMap((one) => endsOf(one));
    const vertices = [...new Set(ends)].filter((id) => hasVertex(geometry, id));
    if (vertices.length === 0) {
        return null;
    }
    const points = vertices.map((id) => pointAt(geometry, id));
    const middle = middleOf(points);
    const pairs = op === 'vertex_move' ? edgesAt(geometry, vertices) : [];
    const reach = reachFrom(middle, points);
    const faces = op === 'face_extrude' ? chosen.map(({ id }) => id) : [];
    const regions = regionsOf(geometry, faces);
    return { tool, op, kind, chosen, geometry, vertices, middle, reach, pairs, regions };
}

// Returns the members of a Crowd in the form of Selection.chosen, with only the corners of each.
// Edges are without ids, so edges can be moved, but not extruded.
function membersIn({ kind, flags, pairs }, geometry) {
    if (kind === 'edge') {
        return Array.from({ length: pairs.length / 2 }, (_, i) => {
            return { kind, element: { vertices: [pairs[2 * i], pairs[2 * i + 1]] } };
        });
    }
    const cornersOf = (id) =>
        kind === 'vertex' ? [id] : edgesOfFace(geometry, id).map(([from]) => from);
    return [...membersOf(flags)].map((id) => {
        return { kind, id, element: { vertices: cornersOf(id) } };
    });
}

function endsOf({ kind, id, element }) {
    if (kind === 'vertex') {
        return [id];
    }
    return kind === 'halfedge' ? [element.origin, element.target] : element.vertices;
}

// Returns the edges of faces that end at some of the given vertices, at most MOST_LINES edges.
export function edgesAt({ triangles, triangleCount, vertexCount }, vertices) {
    // An array is faster than a Set, which matters because millions of triangles are checked.
    const wanted = new Uint8Array(vertexCount);
    vertices.forEach((id) => {
        wanted[id] = 1;
    });
    const found = [];
    for (let i = 0; i < 4 * triangleCount; i += 4) {
        if (wanted[triangles[i]] || wanted[triangles[i + 1]] || wanted[triangles[i + 2]]) {
            found.push(i / 4);
        }
    }
    return edgesOfTriangles(triangles, found).slice(0, MOST_LINES);
}

// Returns what the gesture does if the pointer has moved by (dx, dy) CSS pixels, as {operation,
// lines, text}. If the movement is null (a click), the gesture applies the default amount. `lines`
// are the end points of the preview's lines in pairs, `text` shows the amount, and `operation` is
// null if the edit would change nothing. `view` is Renderer.view.
export function drag(gesture, view, moved) {
    if (gesture.op === 'vertex_move') {
        return move(gesture, moved === null ? [0, 0, 0] : across(gesture, view, moved));
    }
    if (gesture.op === 'edge_extrude') {
        const out = Math.hypot(...gesture.middle) > 0 ? gesture.middle : view.up;
        const usual = directionOf(out).map((value) => USUAL * gesture.reach * value);
        return drawOut(gesture, moved === null ? usual : across(gesture, view, moved));
    }
    return gesture.op === 'face_extrude'
        ? pull(gesture, moved === null ? USUAL * gesture.reach : along(gesture, view, moved))
        : shrink(gesture, moved === null ? USUAL : inwards(gesture, view, moved));
}

// --- from pixels to places ---

// Returns the length in view coordinates of one CSS pixel, in the plane that goes through the
// selection and is parallel to the screen.
function pixelOf({ middle }, view) {
    const depth = -dot(add(middle, view.position, -1), view.back);
    return pixelAtOne(view.height) * Math.max(depth, 0);
}

// Returns the movement of the pointer as a vector parallel to the screen.
function across(gesture, view, [dx, dy]) {
    const pixel = pixelOf(gesture, view);
    return add(view.right.map((value) => dx * pixel * value), view.up, -dy * pixel);
}

// Returns the distance by which faces must move along their normals to follow the pointer.
function along(gesture, view, [dx, dy]) {
    const sum = gesture.chosen
        .map(({ id }) => directionOf(normalOfFace(gesture.geometry, id)))
        .reduce((a, b) => add(a, b));
    const normal = directionOf(sum);
    const seen = [dot(normal, view.right), dot(normal, view.up)];
    const square = dot(seen, seen);
    const [x, y] =
        square < LEAST_ACROSS * LEAST_ACROSS ? [0, 1] : seen.map((value) => value / square);
    return (dx * x - dy * y) * pixelOf(gesture, view);
}

// Returns how far the pointer has moved, as a fraction of the selection's size, limited to the
// range INSET.
function inwards(gesture, view, [dx, dy]) {
    const part = (Math.hypot(dx, dy) * pixelOf(gesture, view)) / (gesture.reach || 1);
    return Math.min(Math.max(part, INSET[0]), INSET[1]);
}

// --- results ---

const inMesh = ({ geometry }, vector) => vector.map((value) => value / geometry.frame.scale);
const textOf = (numbers) => numbers.map((value) => Number(value.toPrecision(3))).join(' ');
const idsOf = ({ chosen }) => chosen.map(({ id }) => id);

function move(gesture, by) {
    const { geometry, vertices, pairs, op } = gesture;
    const moved = new Set(vertices);
    const placeOf = (id) => add(pointAt(geometry, id), moved.has(id) ? by : [0, 0, 0]);
    const vector = inMesh(gesture, by);
    const isStill = by.every((value) => value === 0);
    return {
        operation: isStill ? null : { op, vertices, by: vector },
        lines: pairs.flat().flatMap(placeOf),
        text: `by ${textOf(vector)}`,
    };
}

function drawOut(gesture, by) {
    const { geometry, chosen, kind, op } = gesture;
    const vector = inMesh(gesture, by);
    const lines = chosen.flatMap((one) => {
        const [a, b] = endsOf(one).map((id) => pointAt(geometry, id));
        const [c, d] = [a, b].map((point) => add(point, by));
        return [a, c, c, d, d, b].flat();
    });
    const edges = chosen.map(({ id, element }) => (kind === 'edge' ? id : element.edge));
    return {
        operation: { op, edges: [...new Set(edges)], by: vector },
        lines,
        text: `by ${textOf(vector)}`,
    };
}

// Returns the result of extruding faces by a distance: faces that share an edge move together, as
// face_extrude does with its parameter `region`.
function pull(gesture, length) {
    const { geometry, chosen, op } = gesture;
    const [distance] = inMesh(gesture, [length]);
    const lines = gesture.regions.flatMap(({ faces, rim, inner }) => {
        const normals = faces.map((face) => normalOfFace(geometry, face));
        const normal = directionOf(normals.reduce((a, b) => add(a, b)));
        const place = (point) => add(point, normal, length);
        return [...sidesOf(geometry, rim, place), ...tops(geometry, inner, place)];
    });
    const region = chosen.length > 1;
    const operation = length === 0 ? null : { op, faces: idsOf(gesture), distance, region };
    return { operation, lines, text: `by ${textOf([distance])}` };
}

function shrink(gesture, factor) {
    const { geometry, chosen, op } = gesture;
    const lines = chosen.flatMap(({ id, element }) => {
        const corners = element.vertices.map((vertex) => pointAt(geometry, vertex));
        const middle = corners
            .reduce((a, b) => add(a, b))
            .map((value) => value / corners.length);
        return linesOfFace(geometry, id, (point) => add(point, add(middle, point, -1), factor));
    });
    const operation = { op, faces: idsOf(gesture), factor };
    return { operation, lines, text: `${textOf([100 * factor])} % of the way to the middle` };
}

// Returns lines that show how a face moves if its corners p move to place(p): its edges at the new
// place, and a line from each corner to its new place.
function linesOfFace(geometry, face, place) {
    return sidesOf(geometry, edgesOfFace(geometry, face), place);
}

function sidesOf(geometry, edges, place) {
    return edges.flatMap(([from, to]) => {
        const [a, b] = [from, to].map((id) => pointAt(geometry, id));
        return [a, place(a), place(a), place(b)].flat();
    });
}

function tops(geometry, edges, place) {
    return edges.flatMap((ends) => ends.flatMap((id) => place(pointAt(geometry, id))));
}

function edgesOfFace(geometry, face) {
    return edgesOfTriangles(geometry.triangles, trianglesOfFace(geometry, face));
}

// Divides faces into connected sets, {faces, rim, inner}: `rim` are the edges with no face of the
// set on the other side, in the order of the face's vertices, and `inner` the edges between two
// faces of the set, once each.
export function regionsOf(geometry, faces) {
    const sides = faces.flatMap((face) =>
        edgesOfFace(geometry, face).map((edge) => ({ face, edge, key: `${edge}` })),
    );
    const faceAt = new Map(sides.map(({ key, face }) => [key, face]));
    const across = ({ edge: [from, to] }) => faceAt.get(`${[to, from]}`);
    const regionOf = new Map(faces.map((face) => [face, { faces: [face], rim: [], inner: [] }]));
    for (const side of sides) {
        const [own, other] = [side.face, across(side)].map((face) => regionOf.get(face));
        if (other !== undefined && other !== own) {
            own.faces.push(...other.faces);
            other.faces.forEach((face) => regionOf.set(face, own));
        }
    }
    for (const side of sides) {
        const { rim, inner } = regionOf.get(side.face);
        if (across(side) === undefined) {
            rim.push(side.edge);
        } else if (side.edge[0] < side.edge[1]) {
            inner.push(side.edge);
        }
    }
    return [...new Set(regionOf.values())];
}
