// picking.js - finds the place of the surface on which the user clicks, from the server's ray and not
// from the picture, so that it is exact.

import { pointAt } from '../geometry/geometry.js';
import * as api from '../wire/api.js';

// A click within this many CSS pixels of a vertex means that vertex.
const NEAR = 10;

// Returns a promise of {face, point} or {vertex} for a click at [x, y] in the window; null if there is
// no surface. `vertex` is the id of the vertex nearest to the click, or null if only a place on a face
// is wanted.
export async function pickPlace({ mesh, geometry }, stage, [x, y], vertex) {
    if (vertex !== null && stage.pixelsFrom(pointAt(geometry, vertex), x, y) <= NEAR) {
        return { vertex };
    }
    const { origin: shift, scale } = geometry.frame;
    const { origin, direction } = stage.rayAt(x, y);
    const from = origin.map((value, i) => value / scale + shift[i]);
    const [{ hit }] = await api.query(mesh, [{ ray: { origin: from, direction } }]);
    return hit === null || hit === undefined ? null : { face: hit.face, point: hit.point };
}
