// orval.ts - the story by the functions of orval, which call fetch with paths alone.

import * as made from './made/api';
import { base, known, tell } from './story';

const direct = globalThis.fetch;
globalThis.fetch = (path, options) => direct(`${base()}${String(path)}`, options);

tell({
    async create(vertices, faces) {
        const { data, status } = await made.createMesh({ vertices, faces });
        if (status !== 201 || !('counts' in data)) {
            throw new Error(`${status}`);
        }
        return data;
    },
    async split(mesh, edge) {
        const { data, status } = await made.applyEdits(mesh, { op: 'edge_split', edge, t: 0.5 });
        if (status !== 200) {
            throw new Error(`${status}`);
        }
        const done = known(data.results?.[0], 'result');
        if (done.op !== 'edge_split') {
            throw new Error(done.op);
        }
        return { revision: data.revision, vertex: done.vertex, edges: done.edges };
    },
    async loop(mesh, halfedge) {
        const body = { walk: 'loop' as const, from: { halfedge } };
        const { data, status } = await made.traverseMesh(mesh, body);
        if (status !== 200 || !('walk' in data) || data.walk !== 'loop') {
            throw new Error(`${status}`);
        }
        return data;
    },
    async faces(mesh, vertices) {
        const body = { queries: [{ relation: 'faces' as const, of: { vertices } }] };
        const { data, status } = await made.queryMesh(mesh, body);
        if (status !== 200 || !('results' in data)) {
            throw new Error(`${status}`);
        }
        const answer = known(data.results[0], 'result');
        if (!('offsets' in answer)) {
            throw new Error('no offsets');
        }
        return answer;
    },
    async face(mesh, id) {
        const { data, status } = await made.getFace(mesh, id);
        return { status, halfedge: status === 200 ? data.halfedge : undefined };
    },
    async remove(mesh) {
        return (await made.deleteMesh(mesh)).status;
    },
});
