// framing.js - where the camera should go to show the selection. Pure.

import { normalOfFace, pointAt } from './geometry.js';
import { middleOf, reachFrom } from './view.js';

// If the sum of the faces' unit normals is shorter than this, the faces count as having no common
// direction.
const NOWHERE = 1e-3;

// Returns {center, radius, normal}, a ball around the selected elements and the direction that they
// face; null if nothing is selected. The ball of a single vertex contains its neighbours. `normal`
// is the mean normal of the selected faces or, if no face is selected, of the faces beside the
// selection; it is null if these faces have no common direction.
export function framing(geometry, selection) {
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
