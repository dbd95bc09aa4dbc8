// hey-api.ts - the story by the functions of @hey-api/openapi-ts.

import { client } from './made/client.gen';
import { applyEdits, createMesh, deleteMesh, getFace, queryMesh, traverseMesh } from './made/sdk.gen';
import { base, known, tell } from './story';

client.setConfig({ baseUrl: base() });

tell({
    async create(vertices, faces) {
        const { data } = await createMesh({ body: { vertices, faces } });
        if (data === undefined || !('counts' in data)) {
            throw new Error('no summary');
        }
        return { id: data.id, vertices: data.counts.vertices, edges: data.counts.edges, faces: data.counts.faces };
    },
    async split(mesh, edge) {
        const { data } = await applyEdits({ path: { mesh }, body: { op: 'edge_split', edge, t: 0.5 } });
        if (data === undefined || !('results' in data)) {
            throw new Error('no edit');
        }
        const done = known(data.results?.[0], 'result');
        if (done.op !== 'edge_split') {
            throw new Error(done.op);
        }
        return { revision: known(data.revision, 'revision'), vertex: done.vertex, edges: known(done.edges, 'edges') };
    },
    async loop(mesh, halfedge) {
        const { data } = await traverseMesh({ path: { mesh }, body: { walk: 'loop', from: { halfedge } } });
        if (data === undefined || !('walk' in data) || data.walk !== 'loop') {
            throw new Error('no loop');
        }
        return { halfedges: data.halfedges, vertices: data.vertices };
    },
    async faces(mesh, vertices) {
        const body = { queries: [{ relation: 'faces', of: { vertices } }] };
        const { data } = await queryMesh({ path: { mesh }, body });
        if (data === undefined || !('results' in data)) {
            throw new Error('no answers');
        }
        const answer = known(data.results[0], 'result');
        if (!('offsets' in answer)) {
            throw new Error('no offsets');
        }
        return { offsets: answer.offsets, ids: answer.ids };
    },
    async face(mesh, id) {
        const { data, response } = await getFace({ path: { mesh, id } });
        return { status: response.status, halfedge: data?.halfedge };
    },
    async remove(mesh) {
        return (await deleteMesh({ path: { mesh } })).response.status;
    },
});
