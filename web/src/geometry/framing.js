// framing.js - where the camera should go to show the selection. Pure.

import { normalOfFace, pointAt, trianglesOfFace } from './geometry.js';
import { middleOf, reachFrom } from './view.js';

// If the sum of the faces' unit normals is shorter than this, the faces count as having no common
// direction.
const NOWHERE = 1e-3;

// The ball of a half-edge contains its face, unless the face is more than this many times as large
// as the half-edge with next and prev.
const MOST_TIMES = 8;

// Returns {center, radius, normal}, a ball around the selected elements and the direction that they
// face; null if nothing is selected. The ball of a single vertex contains its neighbours, and that
// of the half-edge selected last contains next, prev and the face. `normal` is the mean normal of the
// selected faces or, if no face is selected, of the faces beside the selection; it is null if these
// faces have no common direction, or if the selection is a Crowd.
export function framing(geometry, selection) {
    if (selection.crowd) {
        return framingOf(geometry, selection.crowd.verticesIn(geometry));
    }
    const marks = selection.marksIn(geometry);
    const arrows = selection.arrowsIn(geometry);
    const placeOf = (id) => pointAt(geometry, id);
    const ids = marks.flatMap(({ kind, id, from, to }) => {
        if (kind === 'vertex') {
            return [id];
        }
        return kind === 'face' ? cornersOf(selection.chosen, id) : [from, to];
    });
    if (ids.length === 0) {
        return null;
    }
    ids.push(...besideHalfedge(geometry, selection.last, arrows));
    const around = ids.length === 1 ? arrows.map(({ target }) => target) : ids;
    const center = middleOf(ids.map(placeOf));
    const faces = marks.filter(({ kind }) => kind === 'face').map(({ id }) => id);
    const beside = arrows.map(({ face }) => face).filter((face) => face !== null);
    return {
        center,
        radius: reachFrom(center, around.map(placeOf)),
        normal: meanNormal(geometry, new Set(faces.length > 0 ? faces : beside)),
    };
}

// Returns a ball around many vertices.
function framingOf(geometry, ids) {
    const [low, high] = [
        [Infinity, Infinity, Infinity],
        [-Infinity, -Infinity, -Infinity],
    ];
    for (const id of ids) {
        for (let axis = 0; axis < 3; axis++) {
            const value = geometry.vertices[4 * id + axis];
            low[axis] = Math.min(low[axis], value);
            high[axis] = Math.max(high[axis], value);
        }
    }
    const center = low.map((value, axis) => (value + high[axis]) / 2);
    return { center, radius: Math.hypot(...center.map((value, axis) => high[axis] - value)), normal: null };
}

// Returns the vertices that are framed with a half-edge; none if `last` is another element. `arrows`
// are the half-edges around it.
function besideHalfedge(geometry, last, arrows) {
    if (last.kind !== 'halfedge') {
        return [];
    }
    const { face } = last.element;
    const near = arrows
        .filter(({ role }) => ['self', 'next', 'prev'].includes(role))
        .flatMap(({ origin, target }) => [origin, target]);
    const corners = face === null ? [] : cornersIn(geometry, face);
    const sizeOf = (ids) => {
        const places = ids.map((id) => pointAt(geometry, id));
        return reachFrom(middleOf(places), places);
    };
    const isHuge = near.length > 0 && sizeOf(corners) > MOST_TIMES * sizeOf(near);
    return isHuge ? near : [...near, ...corners];
}

function cornersIn(geometry, face) {
    return trianglesOfFace(geometry, face).flatMap((triangle) => [
        ...geometry.triangles.subarray(4 * triangle, 4 * triangle + 3),
    ]);
}

function cornersOf(chosen, face) {
    return chosen.find(({ kind, id }) => kind === 'face' && id === face).element.vertices;
}

function meanNormal(geometry, faces) {
    const sum = [0, 0, 0];
    for (const face of faces) {
        const normal = normalOfFace(geometry, face);
        const length = Math.hypot(...normal);
        normal.forEach((value, axis) => {
            sum[axis] += length > 0 ? value / length : 0;
        });
    }
    const length = Math.hypot(...sum);
    return length > NOWHERE ? sum.map((value) => value / length) : null;
}
