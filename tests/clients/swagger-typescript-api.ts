// swagger-typescript-api.ts - the story by the class of swagger-typescript-api.

import { Api } from './made/api';
import { base, known, tell } from './story';

const { v1 } = new Api({ baseUrl: base() });

tell({
    async create(vertices, faces) {
        const { data } = await v1.createMesh({ vertices, faces });
        if (!('counts' in data)) {
            throw new Error('no summary');
        }
        return data;
    },
    async split(mesh, edge) {
        const { data } = await v1.applyEdits(mesh, { op: 'edge_split', edge, t: 0.5 });
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
        const { data } = await v1.traverseMesh(mesh, { walk: 'loop', from: { halfedge } });
        if (!('walk' in data) || data.walk !== 'loop') {
            throw new Error('no loop');
        }
        return data;
    },
    async faces(mesh, vertices) {
        const body = { queries: [{ relation: 'faces' as const, of: { vertices } }] };
        const { data } = await v1.queryMesh(mesh, body);
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
        // What is not a success is thrown, as an answer with its status.
        try {
            const { data, status } = await v1.getFace(mesh, id);
            return { status, halfedge: data.halfedge };
        } catch (answer) {
            if (answer instanceof Response) {
                return { status: answer.status, halfedge: undefined };
            }
            throw answer;
        }
    },
    async remove(mesh) {
        return (await v1.deleteMesh(mesh)).status;
    },
});
