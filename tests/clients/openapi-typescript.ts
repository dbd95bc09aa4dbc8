// openapi-typescript.ts - the story by the types of openapi-typescript and the calls of openapi-fetch.

import createClient from 'openapi-fetch';

import type { paths } from './made/schema';
import { base, known, tell } from './story';

const api = createClient<paths>({ baseUrl: base() });

tell({
    async create(vertices, faces) {
        const { data } = await api.POST('/v1/meshes', { body: { vertices, faces } });
        if (data === undefined || !('counts' in data)) {
            throw new Error('no summary');
        }
        return { id: data.id, vertices: data.counts.vertices, edges: data.counts.edges, faces: data.counts.faces };
    },
    async split(mesh, edge) {
        const params = { path: { mesh } };
        const { data } = await api.POST('/v1/meshes/{mesh}/edits', { params, body: { op: 'edge_split', edge, t: 0.5 } });
        if (typeof data !== 'object' || !('results' in data)) {
            throw new Error('no edit');
        }
        const done = known(data.results?.[0], 'result');
        if (done.op !== 'edge_split') {
            throw new Error(done.op);
        }
        return { revision: known(data.revision, 'revision'), vertex: done.vertex, edges: known(done.edges, 'edges') };
    },
    async loop(mesh, halfedge) {
        const params = { path: { mesh } };
        const { data } = await api.POST('/v1/meshes/{mesh}/traverse', { params, body: { walk: 'loop', from: { halfedge } } });
        if (data === undefined || !('walk' in data) || data.walk !== 'loop') {
            throw new Error('no loop');
        }
        return { halfedges: data.halfedges, vertices: data.vertices };
    },
    async faces(mesh, vertices) {
        const params = { path: { mesh } };
        const body = { queries: [{ relation: 'faces', of: { vertices } }] };
        const { data } = await api.POST('/v1/meshes/{mesh}/query', { params, body });
        if (typeof data !== 'object' || !('results' in data)) {
            throw new Error('no answers');
        }
        const answer = known(data.results[0], 'result');
        if (!('offsets' in answer)) {
            throw new Error('no offsets');
        }
        return { offsets: answer.offsets, ids: answer.ids };
    },
    async face(mesh, id) {
        const { data, response } = await api.GET('/v1/meshes/{mesh}/faces/{id}', { params: { path: { mesh, id } } });
        return { status: response.status, halfedge: data?.halfedge };
    },
    async remove(mesh) {
        return (await api.DELETE('/v1/meshes/{mesh}', { params: { path: { mesh } } })).response.status;
    },
});
