// kinds.js - what can be measured, and how: from the server's positions, lengths, areas and rays, so
// that the results are exact for the mesh and not for the picture of it.
//
// A measurement is {kind, refs}. A ref is {vertex}, {edge} or {face} with an id, or {face, point}, a
// place on a face. measure() asks the server and returns what there is to show:
//
//   value    a number, or null with a `note` that says why there is none
//   format   a function that writes the value
//   note     more about the result, or ''
//   lines    end points of lines to draw, in pairs
//   points   points to draw
//   at       where the label stands

import { add, angleBetween, subtract } from '../geometry/vectors.js';
import * as api from '../wire/api.js';
import { formatNumberOf } from '../kit/dom.js';
import { formatAngle, formatArea, formatLength } from '../kit/lengths.js';
import { askAll } from '../open/crowd.js';
import {
    angleAt,
    circleThrough,
    distance,
    middle,
    pairsOf,
    pointsOf,
} from './shapes.js';

// A ray into the mesh begins this part of the size of the mesh below the surface, so that it does not
// meet the surface where it begins.
const SKIN = 1e-7;

const CIRCLE = 64; // corners of the circle that is drawn

// Each kind is {title, takes, count, hint, ids}: `takes` is what a click picks ('point', 'edge' or
// 'face'; 'faces': the selected faces, without clicks), `count` how many clicks are needed, `hint` says
// what to click next, and `ids` is the placeholder of the field for ids.
export const KINDS = {
    distance: {
        title: 'Distance',
        takes: 'point',
        count: 2,
        hint: (done) => (done === 0 ? 'Click the first point.' : 'Click the second point.'),
        ids: 'ids of 2 vertices',
    },
    edge: {
        title: 'Edge length',
        takes: 'edge',
        count: 1,
        hint: () => 'Click an edge.',
        ids: 'id of an edge',
    },
    loop: {
        title: 'Loop length',
        takes: 'edge',
        count: 1,
        hint: () => 'Click an edge of the loop.',
        ids: 'id of an edge',
    },
    angle: {
        title: 'Angle of three points',
        takes: 'point',
        count: 3,
        hint: (done) => ['Click the first point.', 'Click the corner.', 'Click the last point.'][done],
        ids: 'ids of 3 vertices',
    },
    faces: {
        title: 'Angle of two faces',
        takes: 'face',
        count: 2,
        hint: (done) => (done === 0 ? 'Click a face.' : 'Click another face.'),
        ids: 'ids of 2 faces',
    },
    area: {
        title: 'Area of the selection',
        takes: 'faces',
        count: 1,
        hint: () => 'Select faces, then press Measure.',
        ids: 'selected faces, or ids',
    },
    radius: {
        title: 'Radius through three points',
        takes: 'point',
        count: 3,
        hint: (done) => `Click point ${done + 1} of 3.`,
        ids: 'ids of 3 vertices',
    },
    wall: {
        title: 'Wall thickness',
        takes: 'point',
        count: 1,
        hint: () => 'Click a place on the surface.',
        ids: 'id of a face',
    },
};

// The kind of the elements whose ids stand for clicks.
export function elementOf(kind) {
    const { takes } = KINDS[kind];
    return kind === 'wall' || takes === 'faces' ? 'face' : takes === 'point' ? 'vertex' : takes;
}

const MEASURES = {
    distance: measureDistance,
    edge: measureEdge,
    loop: measureLoop,
    angle: measureAngle,
    faces: measureFaces,
    area: measureArea,
    radius: measureRadius,
    wall: measureWall,
};

// Measures; `place` is {mesh, size}, where `size` is the diagonal of the box around the mesh. Fails with
// a Problem if an element does not exist.
export function measure({ kind, refs }, place) {
    return MEASURES[kind](place, refs);
}

function made(value, format, { note = '', lines = [], points = [], at }) {
    return { value, format, note, lines, points, at };
}

// Asks for the present elements of refs, and returns the server's answers.
async function getAll(mesh, kind, ids) {
    return answersOf(await askAll(mesh, ids, (id) => ({ get: { [kind]: id } })));
}

// Throws the first problem among the answers to some questions.
function answersOf(answers) {
    const problem = answers.find((answer) => 'status' in answer);
    if (problem !== undefined) {
        throw new api.Problem(problem);
    }
    return answers;
}

async function pointsAt({ mesh }, refs) {
    const ids = new Set(refs.filter(({ vertex }) => vertex !== undefined).map(({ vertex }) => vertex));
    const found = new Map((await getAll(mesh, 'vertex', [...ids])).map((one) => [one.id, one.position]));
    return refs.map(({ vertex, point }) => point ?? found.get(vertex));
}

// --- the kinds ---

async function measureDistance(place, refs) {
    const points = await pointsAt(place, refs);
    const [a, b] = points;
    const parts = subtract(b, a).map((part, i) => `${'xyz'[i]} ${formatLength(part)}`);
    return made(distance(a, b), formatLength, {
        note: parts.join(', '),
        lines: [a, b],
        points,
        at: middle(points),
    });
}

async function measureEdge(place, [{ edge }]) {
    const [{ vertices, length }] = await getAll(place.mesh, 'edge', [edge]);
    const ends = await pointsAt(place, vertices.map((vertex) => ({ vertex })));
    return made(length, formatLength, { lines: ends, points: ends, at: middle(ends) });
}

// The loop of a boundary edge is that of the hole; the loop of another edge goes straight on at each
// vertex of degree four.
async function measureLoop(place, [{ edge }]) {
    const { mesh } = place;
    const [{ boundary, halfedges, faces }] = await getAll(mesh, 'edge', [edge]);
    const outside = halfedges[faces.indexOf(null)];
    const [found] = answersOf(
        await api.query(mesh, [
            boundary
                ? { relation: 'loop', of: { halfedge: outside } }
                : { walk: 'edge_loop', from: { edge } },
        ]),
    );
    const edges = boundary ? found.ids.map((halfedge) => halfedge >>> 1) : found.edges;
    const [{ values }, { offsets, ids }] = answersOf(
        await api.query(mesh, [
            { measure: 'length', of: { edges } },
            { relation: 'vertices', of: { edges } },
        ]),
    );
    const own = await pointsAt(place, ids.map((vertex) => ({ vertex })));
    const sum = values.reduce((total, value) => total + value, 0);
    const kind = boundary ? 'boundary loop' : found.closed ? 'closed edge loop' : 'edge loop';
    return made(sum, formatLength, {
        note: `${kind} of ${edges.length} ${edges.length === 1 ? 'edge' : 'edges'}`,
        lines: offsets.slice(0, -1).flatMap((at) => [own[at], own[at + 1]]),
        at: middle(own.slice(0, 2)),
    });
}

async function measureAngle(place, refs) {
    const points = await pointsAt(place, refs);
    const [from, at, to] = points;
    const angle = angleAt(from, at, to);
    return made(angle, formatAngle, {
        note: angle === null ? 'Two of the points are in one place.' : '',
        lines: [from, at, at, to],
        points,
        at,
    });
}

async function measureFaces(place, refs) {
    const [a, b] = await getAll(place.mesh, 'face', refs.map(({ face }) => face));
    const angle = angleBetween(a.normal, b.normal);
    return made(angle, formatAngle, {
        note: angle === null ? 'A face without area has no direction.' : 'between the normals',
        lines: [a.centroid, b.centroid],
        points: [a.centroid, b.centroid],
        at: middle([a.centroid, b.centroid]),
    });
}

async function measureArea(place, refs) {
    const faces = refs.map(({ face }) => face);
    const found = await getAll(place.mesh, 'face', faces);
    // The outline are the edges that only one of the faces has.
    const counts = new Map();
    for (const edge of found.flatMap(({ halfedges }) => halfedges.map((one) => one >>> 1))) {
        counts.set(edge, (counts.get(edge) ?? 0) + 1);
    }
    const outline = [...counts].filter(([, count]) => count === 1).map(([edge]) => edge);
    const ends = (await getAll(place.mesh, 'edge', outline)).flatMap(({ vertices }) => vertices);
    const sum = found.reduce((total, { area }) => total + area, 0);
    return made(sum, formatArea, {
        note: formatNumberOf(faces.length, 'face'),
        lines: await pointsAt(place, ends.map((vertex) => ({ vertex }))),
        at: middle(found.map(({ centroid }) => centroid)),
    });
}

async function measureRadius(place, refs) {
    const points = await pointsAt(place, refs);
    const circle = circleThrough(...points);
    if (circle === null) {
        return made(null, formatLength, {
            note: 'The points are on a line.',
            points,
            at: middle(points),
        });
    }
    const { center, radius } = circle;
    return made(radius, formatLength, {
        note: `diameter ${formatLength(2 * radius)}, centre ${center.map(formatLength).join(' ')}`,
        lines: [...pairsOf(pointsOf(circle, CIRCLE)), center, points[0]],
        points: [...points, center],
        at: center,
    });
}

// The wall is measured straight inwards, along the reversed normal of the face.
async function measureWall({ mesh, size }, [{ face, point }]) {
    const [{ normal, centroid }] = await getAll(mesh, 'face', [face]);
    const from = point ?? centroid;
    if (Math.hypot(...normal) === 0) {
        const note = 'A face without area has no direction.';
        return made(null, formatLength, { note, points: [from], at: from });
    }
    const direction = normal.map((part) => -part);
    const origin = add(from, direction, SKIN * size);
    const [{ hit }] = answersOf(await api.query(mesh, [{ ray: { origin, direction } }]));
    if (hit === null) {
        const note = 'There is no surface on the other side.';
        return made(null, formatLength, { note, points: [from], at: from });
    }
    return made(distance(from, hit.point), formatLength, {
        note: `from face ${face} to face ${hit.face}`,
        lines: [from, hit.point],
        points: [from, hit.point],
        at: middle([from, hit.point]),
    });
}
