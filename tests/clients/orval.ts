// orval.ts - the story by the functions of orval, which call fetch with paths alone.

import { applyEdits, createMesh, deleteMesh, getFace, queryMesh, traverseMesh } from './made/api';
import { base, known, tell } from './story';

const direct = globalThis.fetch;
globalThis.fetch = (path, options) => direct(`${base()}${String(path)}`, options);

tell({
    async create(vertices, faces) {
        const { data, status } = await createMesh({ vertices, faces });
        if (status !== 201 || !('counts' in data)) {
            throw new Error(`${status}`);
        }
        return { id: data.id, vertices: data.counts.vertices, edges: data.counts.edges, faces: data.counts.faces };
    },
    async split(mesh, edge) {
        const { data, status } = await applyEdits(mesh, { op: 'edge_split', edge, t: 0.5 });
        if (status !== 200) {
            throw new Error(`${status}`);
        }
        const done = known(data.results?.[0], 'result');
        if (done.op !== 'edge_split') {
            throw new Error(done.op);
        }
        return { revision: known(data.revision, 'revision'), vertex: done.vertex, edges: known(done.edges, 'edges') };
    },
    async loop(mesh, halfedge) {
        const { data, status } = await traverseMesh(mesh, { walk: 'loop', from: { halfedge } });
        if (status !== 200 || !('walk' in data) || data.walk !== 'loop') {
            throw new Error(`${status}`);
        }
        return { halfedges: data.halfedges, vertices: data.vertices };
    },
    async faces(mesh, vertices) {
        const { data, status } = await queryMesh(mesh, { queries: [{ relation: 'faces', of: { vertices } }] });
        if (status !== 200 || !('results' in data)) {
            throw new Error(`${status}`);
        }
        const answer = known(data.results[0], 'result');
        if (!('offsets' in answer)) {
            throw new Error('no offsets');
        }
        return { offsets: answer.offsets, ids: answer.ids };
    },
    async face(mesh, id) {
        const { data, status } = await getFace(mesh, id);
        return { status, halfedge: status === 200 ? data.halfedge : undefined };
    },
    async remove(mesh) {
        return (await deleteMesh(mesh)).status;
    },
});
