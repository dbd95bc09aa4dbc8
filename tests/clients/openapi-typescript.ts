// openapi-typescript.ts - the story by the types of openapi-typescript and openapi-fetch's calls.

import createClient from 'openapi-fetch';

import type { paths } from './made/schema';
import { base, known, tell } from './story';

// Where an answer may be of several media types, the types named here are meant.
const api = createClient<paths, 'application/json' | 'application/problem+json'>({
    baseUrl: base(),
});

tell({
    async create(vertices, faces) {
        const { data } = await api.POST('/v1/meshes', { body: { vertices, faces } });
        if (data === undefined || !('counts' in data)) {
            throw new Error('no summary');
        }
        return data;
    },
    async split(mesh, edge) {
        const { data } = await api.POST('/v1/meshes/{mesh}/edits', {
            params: { path: { mesh } },
            body: { op: 'edge_split', edge, t: 0.5 },
        });
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
        const { data } = await api.POST('/v1/meshes/{mesh}/traverse', {
            params: { path: { mesh } },
            body: { walk: 'loop', from: { halfedge } },
        });
        if (data === undefined || !('walk' in data) || data.walk !== 'loop') {
            throw new Error('no loop');
        }
        return data;
    },
    async faces(mesh, vertices) {
        const { data } = await api.POST('/v1/meshes/{mesh}/query', {
            params: { path: { mesh } },
            body: { queries: [{ relation: 'faces', of: { vertices } }] },
        });
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
        const params = { path: { mesh, id } };
        const { data, response } = await api.GET('/v1/meshes/{mesh}/faces/{id}', { params });
        return { status: response.status, halfedge: data?.halfedge };
    },
    async remove(mesh) {
        const params = { path: { mesh } };
        return (await api.DELETE('/v1/meshes/{mesh}', { params })).response.status;
    },
});
