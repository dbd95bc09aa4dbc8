// hey-api.ts - the story by the functions of @hey-api/openapi-ts.

import { client } from './made/client.gen';
import * as made from './made/sdk.gen';
import { base, known, tell } from './story';

client.setConfig({ baseUrl: base() });

tell({
    async create(vertices, faces) {
        const { data } = await made.createMesh({ body: { vertices, faces } });
        if (data === undefined || !('counts' in data)) {
            throw new Error('no summary');
        }
        return data;
    },
    async split(mesh, edge) {
        const body = { op: 'edge_split' as const, edge, t: 0.5 };
        const { data } = await made.applyEdits({ path: { mesh }, body });
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
        const { data } = await made.traverseMesh({ path: { mesh }, body });
        if (data === undefined || !('walk' in data) || data.walk !== 'loop') {
            throw new Error('no loop');
        }
        return data;
    },
    async faces(mesh, vertices) {
        const body = { queries: [{ relation: 'faces' as const, of: { vertices } }] };
        const { data } = await made.queryMesh({ path: { mesh }, body });
        if (data === undefined || !('results' in data)) {
            throw new Error('no answers');
        }
        const answer = known(data.results[0], 'result');
        if (!('offsets' in answer)) {
            throw new Error('no offsets');
        }
        return answer;
    },
    async face(mesh, id) {
        const { data, response } = await made.getFace({ path: { mesh, id } });
        return { status: known(response, 'answer').status, halfedge: data?.halfedge };
    },
    async remove(mesh) {
        const { response } = await made.deleteMesh({ path: { mesh } });
        return known(response, 'answer').status;
    },
});
