// gesture.js - what a drag means for the elements that are selected: lines that show it and the
// edit it comes to. Pure.
//
// Places are in view coordinates (see geometry.js); the edit is in those of the mesh.

import { edgesOfTriangles, hasVertex, normalOfFace, pointAt, trianglesOfFace } from './geometry.js';
import { middleOf, pixelAtOne, reachFrom } from './view.js';

// Of what is selected, where a tool is used by a click and not by a drag.
const USUAL = 0.2;

// How far an inset goes at most and at least, of the way to the middle.
const INSET = [0.01, 0.99];

// A normal of which less than this is across the view is drawn along by dragging upwards.
const LEAST_ACROSS = 0.3;

// More lines than this are not shown.
const MOST_LINES = 20000;

const add = (a, b, factor = 1) => a.map((value, i) => value + factor * b[i]);
const dot = (a, b) => a.reduce((sum, value, i) => sum + value * b[i], 0);
const unit = (a) => a.map((value) => value / (Math.hypot(...a) || 1));

// The operation of the server's table that a tool comes to for a kind of element.
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

// A tool, 'move', 'extrude' or 'inset', put to what is chosen (see Selection): what drag() needs,
// or null where it does not fit.
export function begin(tool, chosen, geometry) {
    const kind = chosen.at(-1)?.kind;
    const op = OPERATIONS[tool][kind];
    if (op === undefined) {
        return null;
    }
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

function endsOf({ kind, id, element }) {
    if (kind === 'vertex') {
        return [id];
    }
    return kind === 'halfedge' ? [element.origin, element.target] : element.vertices;
}

// The polygon edges on all triangles at some vertices.
function edgesAt({ triangles, triangleCount, vertexCount }, vertices) {
    const wanted = new Uint8Array(vertexCount); // of millions of triangles each is looked at
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

// What it comes to when the pointer has moved by (dx, dy) CSS pixels, or null for a click, which
// means the usual: {operation, lines, text}, where `lines` are coordinates of ends in pairs, and
// the operation is null where it would change nothing. `view` is what Renderer.view says.
export function drag(gesture, view, moved) {
    if (gesture.op === 'vertex_move') {
        return move(gesture, moved === null ? [0, 0, 0] : across(gesture, view, moved));
    }
    if (gesture.op === 'edge_extrude') {
        const out = Math.hypot(...gesture.middle) > 0 ? gesture.middle : view.up;
        const usual = unit(out).map((value) => USUAL * gesture.reach * value);
        return drawOut(gesture, moved === null ? usual : across(gesture, view, moved));
    }
    return gesture.op === 'face_extrude'
        ? pull(gesture, moved === null ? USUAL * gesture.reach : along(gesture, view, moved))
        : shrink(gesture, moved === null ? USUAL : inwards(gesture, view, moved));
}

// --- from pixels to places ---

// How long a pixel is where the selection is.
function pixelOf({ middle }, view) {
    const depth = -dot(add(middle, view.position, -1), view.back);
    return pixelAtOne(view.height) * Math.max(depth, 0);
}

// In the plane of the view.
function across(gesture, view, [dx, dy]) {
    const pixel = pixelOf(gesture, view);
    return add(view.right.map((value) => dx * pixel * value), view.up, -dy * pixel);
}

// Along the normal of the faces, so that it follows the pointer.
function along(gesture, view, [dx, dy]) {
    const sum = gesture.chosen
        .map(({ id }) => unit(normalOfFace(gesture.geometry, id)))
        .reduce((a, b) => add(a, b));
    const normal = unit(sum);
    const seen = [dot(normal, view.right), dot(normal, view.up)];
    const square = dot(seen, seen);
    const [x, y] =
        square < LEAST_ACROSS * LEAST_ACROSS ? [0, 1] : seen.map((value) => value / square);
    return (dx * x - dy * y) * pixelOf(gesture, view);
}

// The part of the way to the middle.
function inwards(gesture, view, [dx, dy]) {
    const part = (Math.hypot(dx, dy) * pixelOf(gesture, view)) / (gesture.reach || 1);
    return Math.min(Math.max(part, INSET[0]), INSET[1]);
}

// --- what it comes to ---

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

// Faces that share an edge move as one, as the operation's `region` says.
function pull(gesture, length) {
    const { geometry, chosen, op } = gesture;
    const [distance] = inMesh(gesture, [length]);
    const lines = gesture.regions.flatMap(({ faces, rim, inner }) => {
        const normals = faces.map((face) => normalOfFace(geometry, face));
        const normal = unit(normals.reduce((a, b) => add(a, b)));
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
    return { operation, lines, text: `${textOf([100 * factor])} % of the way` };
}

// The sides of a face where `place` puts them, and lines from there to where they are.
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

// Faces as sets of those that are connected across edges: {faces, rim, inner} each, where `rim` are
// the edges beside faces that are not among them, as the face runs along them, and `inner` the
// others, once.
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
