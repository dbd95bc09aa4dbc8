// changed.js - which faces differ between two revisions of a mesh, given by the arrays of
// geometry.js, and where some faces are. Pure.

import { edgesOfTriangles, trianglesOfFace } from './geometry.js';

// Positions are floats in the unit ball; two roundings differ by less than this.
const CLOSE = 1e-6;

// Returns how points in the view coordinates of the arrays `from` become points in those of the
// arrays `to`: {scale, offset}.
export function placementOf(from, to) {
    const scale = to.frame.scale / from.frame.scale;
    const offset = from.frame.origin.map(
        (value, axis) => (value - to.frame.origin[axis]) * to.frame.scale,
    );
    return { scale, offset };
}

// Returns the ids of the faces that only `before` has, that only `after` has, and that both have but
// with other corners or in another place: {gone, made, moved}.
export function changedFaces(before, after) {
    const { scale, offset } = placementOf(before, after);
    const gone = [];
    const made = [];
    const moved = [];
    const isMoved = movedVertices(before, after, scale, offset);
    for (let face = 0; face < Math.max(before.firstOf.length, after.firstOf.length); face++) {
        const was = trianglesOfFace(before, face);
        const is = trianglesOfFace(after, face);
        if (was.length > 0 && is.length === 0) {
            gone.push(face);
        } else if (was.length === 0 && is.length > 0) {
            made.push(face);
        } else if (was.length !== is.length || differ(before, was, after, is, isMoved)) {
            moved.push(face);
        }
    }
    return { gone, made, moved };
}

// Returns a function that says whether a vertex is elsewhere in `after` than in `before`.
function movedVertices(before, after, scale, offset) {
    return (vertex) => {
        for (let axis = 0; axis < 3; axis++) {
            const was = before.vertices[4 * vertex + axis] * scale + offset[axis];
            if (Math.abs(was - after.vertices[4 * vertex + axis]) > CLOSE) {
                return true;
            }
        }
        return false;
    };
}

function differ(before, was, after, is, isMoved) {
    for (let i = 0; i < was.length; i++) {
        for (let corner = 0; corner < 3; corner++) {
            const vertex = before.triangles[4 * was[i] + corner];
            if (vertex !== after.triangles[4 * is[i] + corner] || isMoved(vertex)) {
                return true;
            }
        }
    }
    return false;
}

const pointsOf = ({ vertices }, ids) =>
    Float32Array.from(ids.flatMap((id) => Array.from(vertices.subarray(4 * id, 4 * id + 3))));

// Returns the coordinates of some faces: of the corners of their triangles, and of the ends of
// their edges: {triangles, lines}, both with three numbers for a point.
export function shapeOfFaces(geometry, faces) {
    const triangles = faces.flatMap((face) => trianglesOfFace(geometry, face));
    const corners = triangles.flatMap((triangle) =>
        Array.from(geometry.triangles.subarray(4 * triangle, 4 * triangle + 3)),
    );
    const ends = edgesOfTriangles(geometry.triangles, triangles).flat();
    return { triangles: pointsOf(geometry, corners), lines: pointsOf(geometry, ends) };
}

// Returns the coordinates of elements, given as marks for the renderer (see selection.js): {triangles,
// lines, dots}.
export function shapeOfMarks(geometry, marks) {
    const faces = marks.filter(({ kind }) => kind === 'face').map(({ id }) => id);
    const { triangles, lines } = shapeOfFaces(geometry, faces);
    const ends = marks
        .filter(({ from }) => from !== undefined)
        .flatMap(({ from, to }) => [from, to]);
    const dots = marks.filter(({ kind }) => kind === 'vertex').map(({ id }) => id);
    return {
        triangles,
        lines: Float32Array.from([...lines, ...pointsOf(geometry, ends)]),
        dots: pointsOf(geometry, dots),
    };
}

// Returns the mean of some points, three numbers for each, or null if there are none.
export function meanOf(...lists) {
    const sum = [0, 0, 0];
    let count = 0;
    for (const points of lists) {
        for (let i = 0; i < points.length; i += 3) {
            sum.forEach((_, axis) => {
                sum[axis] += points[i + axis];
            });
            count++;
        }
    }
    return count === 0 ? null : sum.map((value) => value / count);
}
