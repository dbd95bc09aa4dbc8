// reading.js - reads the values by which a mesh is coloured, all of one revision.

import * as api from '../wire/api.js';
import { Corners, facesOf, verticesOf } from '../geometry/corners.js';

// Reads the values of a source for the mesh that is shown, `content`. Returns a promise of {revision,
// source, ids, numbers, corners}: `numbers` are by id, see Source.read(), `ids` the elements that exist,
// and `corners` is null unless half-edges or edges have the values. Fails with status 410 if the server
// no longer has the revision, and with 404 if the mesh does not have the attribute any more.
export async function readValues(source, content, signal) {
    const { mesh, revision, geometry } = content;
    // The ids are taken now, because the arrays change while the server answers.
    const kind = source.kind;
    const own = kind === 'vertices' ? verticesOf(geometry) : facesOf(geometry);
    const needsCorners = kind === 'edges' || kind === 'halfedges' || source.needsCorners === true;
    const corners = needsCorners ? await readCorners(mesh, own, revision, signal) : null;
    const ids = kind === 'vertices' || kind === 'faces' ? own : corners[kind];
    const numbers = await source.read({ mesh, revision, ids, corners }, signal);
    return { revision, source, ids, numbers, corners };
}

async function readCorners(mesh, faces, revision, signal) {
    const [vertices, halfedges] = await Promise.all(
        ['vertices', 'halfedges'].map((relation) =>
            api.relateAll(mesh, relation, 'faces', revision, signal),
        ),
    );
    return new Corners(faces, vertices, halfedges);
}
