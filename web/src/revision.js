// revision.js - all that is shown of a mesh at one revision. Only here is it decided which arrays
// and which answers of the server belong together.
//
//   mesh, revision     of what
//   geometry           the arrays to draw, see geometry.js
//   boundary           the half-edges of all boundary loops: origin, target, origin, target, ...
//   summary, history   as the server says them

import * as api from './api.js';
import { unpack } from './geometry.js';

// How often a mesh that changes while it is being read is read again.
const READS = 5;

// The mesh as it is now; `onProgress` gets the part that has been read, 0 to 1.
export async function readRevision(mesh, onProgress, signal) {
    for (let i = 0; i < READS; i++) {
        const geometry = unpack(await api.getGeometry(mesh, onProgress, signal));
        const { revision } = geometry;
        const [summary, history] = await Promise.all([
            api.getSummary(mesh, signal),
            api.getHistory(mesh, signal),
        ]);
        const boundary =
            summary.counts.boundary_loops > 0
                ? await api.getBoundaries(mesh, signal)
                : { revision, loops: [] };
        if ([summary, history, boundary].every((answer) => answer.revision === revision)) {
            const ends = endsOf(boundary.loops);
            return { mesh, revision, geometry, boundary: ends, summary, history };
        }
    }
    throw new api.Problem({
        title: 'Mesh too busy',
        detail: 'The mesh changed each time while it was being read.',
    });
}

function endsOf(loops) {
    const ends = new Uint32Array(2 * loops.reduce((sum, { vertices }) => sum + vertices.length, 0));
    let at = 0;
    for (const { vertices } of loops) {
        for (let i = 0; i < vertices.length; i++) {
            ends[at++] = vertices[i];
            ends[at++] = vertices[(i + 1) % vertices.length];
        }
    }
    return ends;
}
