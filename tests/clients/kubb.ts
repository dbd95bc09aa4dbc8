// kubb.ts - the story by the functions of kubb.

import { applyEdits } from './made/clients/applyEdits';
import { createMesh } from './made/clients/createMesh';
import { deleteMesh } from './made/clients/deleteMesh';
import { getFace } from './made/clients/getFace';
import { queryMesh } from './made/clients/queryMesh';
import { traverseMesh } from './made/clients/traverseMesh';
import { base, known, tell } from './story';

// kubb's fetch names no media type by itself.
const config = { baseURL: base(), headers: { 'Content-Type': 'application/json' } };

tell({
    async create(vertices, faces) {
        const { data } = await createMesh({ vertices, faces }, undefined, undefined, config);
        if (!('counts' in data)) {
            throw new Error('no summary');
        }
        return data;
    },
    async split(mesh, edge) {
        const body = { op: 'edge_split' as const, edge, t: 0.5 };
        const { data } = await applyEdits(mesh, body, undefined, config);
        if (data === undefined || !('results' in data)) {
            throw new Error('no edit');
        }
        const done = known(data.results?.[0], 'result');
        if (done.op !== 'edge_split') {
            throw new Error(done.op);
        }
        return { revision: data.revision, vertex: done.vertex, edges: done.edges };
    },
    async loop(mesh, halfedge) {
        const body = { walk: 'loop' as const, from: { halfedge } };
        const { data } = await traverseMesh(mesh, body, undefined, undefined, config);
        if (!('walk' in data) || data.walk !== 'loop') {
            throw new Error('no loop');
        }
        return data;
    },
    async faces(mesh, vertices) {
        const body = { queries: [{ relation: 'faces' as const, of: { vertices } }] };
        const { data } = await queryMesh(mesh, body, undefined, undefined, config);
        if (!('results' in data)) {
            throw new Error('no answers');
        }
        const answer = known(data.results[0], 'result');
        if (!('offsets' in answer)) {
            throw new Error('no offsets');
        }
        return answer;
    },
    async face(mesh, id) {
        const { data, status } = await getFace(mesh, id, undefined, undefined, config);
        return { status, halfedge: status === 200 ? data.halfedge : undefined };
    },
    async remove(mesh) {
        return (await deleteMesh(mesh, undefined, config)).status;
    },
});
