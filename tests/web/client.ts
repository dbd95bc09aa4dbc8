// client.ts - a TypeScript client that uses the types which openapi-typescript makes of the served
// OpenAPI document. If the document is wrong about a body or an answer, this does not compile.

import createClient from 'openapi-fetch';

import type { paths } from './openapi.js';

// Splits the diagonal of a square, and walks until it is back where it began; returns the elements
// that the walk met.
export async function tour(baseUrl: string) {
    const client = createClient<paths>({ baseUrl });
    const mesh = { mesh: 'square' };

    const made = await client.PUT('/v1/meshes/{mesh}', {
        params: { path: mesh },
        body: {
            vertices: [
                [0, 0, 0],
                [1, 0, 0],
                [1, 1, 0],
                [0, 1, 0],
            ],
            faces: [
                [0, 1, 2],
                [0, 2, 3],
            ],
        },
    });
    // If the server answers with a job (202), because the work takes long, that has a progress.
    if (made.data === undefined || 'progress' in made.data) {
        throw new Error(made.error?.detail);
    }

    const edited = await client.POST('/v1/meshes/{mesh}/edits', {
        params: { path: mesh },
        body: {
            expected_revision: made.data.revision,
            ops: [{ op: 'edge_split', edge: 2, t: 0.25 }],
        },
    });
    // Only a client that asks for octets gets them, as a string.
    if (edited.data === undefined || typeof edited.data === 'string' || 'progress' in edited.data) {
        throw new Error(edited.error?.detail);
    }
    const [vertex] = edited.data.created.vertices;
    if (vertex === undefined) {
        throw new Error('the edge has no new vertex');
    }

    const ring: number[] = [];
    let id = 0;
    do {
        const answer = await client.GET('/v1/meshes/{mesh}/halfedges/{id}', {
            params: { path: { ...mesh, id } },
        });
        if (answer.data === undefined) {
            throw new Error(answer.error?.detail);
        }
        ring.push(answer.data.origin);
        id = answer.data.next;
    } while (id !== 0);

    const beside = await client.GET('/v1/meshes/{mesh}/vertices/{id}/faces', {
        params: { path: { ...mesh, id: vertex } },
    });
    if (beside.data === undefined) {
        throw new Error(beside.error?.detail);
    }

    const refused = await client.POST('/v1/meshes/{mesh}/edits', {
        params: { path: mesh },
        body: { op: 'edge_flip', edge: 0 },
    });
    return {
        faces: made.data.counts.faces,
        vertex,
        ring,
        beside: { of: beside.data.of.vertex, faces: beside.data.ids.length },
        refusal: refused.error?.code,
        element: refused.error?.element?.id,
    };
}
