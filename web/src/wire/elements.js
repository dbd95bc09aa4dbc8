// elements.js - asks about elements of a mesh and their neighbours, and about the mesh as a surface.

import { API_PLURALS } from '../geometry/kinds.js';
import { postJson, readLong } from './jobs.js';
import { getJson, meshPath, request } from './request.js';

// Returns the elements of a small mesh, at most 1,000; `kinds` is 'vertices', 'edges', 'faces' or
// 'halfedges'.
export async function getElements(mesh, kinds) {
    return (await getJson(`${meshPath(mesh)}/${kinds}?limit=1000`)).items;
}

export function getElement(mesh, kind, id) {
    return getJson(`${meshPath(mesh)}/${API_PLURALS[kind]}/${id}`);
}

// Returns the ids of an element's neighbours of some kind, such as the faces of a vertex.
export async function getAdjacent(mesh, kind, id, relation) {
    return (await getJson(`${meshPath(mesh)}/${API_PLURALS[kind]}/${id}/${relation}`)).ids;
}

// Sends several queries about one revision of a mesh in one request and returns the answers in
// order; the answer to a failed query is a problem.
export async function query(mesh, queries) {
    return (await postJson(`${meshPath(mesh)}/query`, { queries })).results;
}

// Returns the half-edge from one vertex to another, or null if there is none.
export async function findHalfedge(mesh, from, to) {
    const [{ halfedge }] = await query(mesh, [{ find: 'halfedge', vertices: [from, to] }]);
    return halfedge;
}

// Returns the ids of the edges that continue an edge: its 'edge_loop', which leads straight on through
// vertices with four edges, or its 'edge_ring', which leads straight across faces with four edges.
export async function getLine(mesh, walk, edge) {
    return (await postJson(`${meshPath(mesh)}/traverse`, { walk, from: { edge } })).edges;
}

// Returns {revision, loops: [{halfedges, vertices, ...}]}.
export function getBoundaries(mesh, signal) {
    return readLong(`${meshPath(mesh)}/boundaries`, signal);
}

// Returns {revision, components: [{face, faces, vertices}]}.
export function getComponents(mesh, signal) {
    return readLong(`${meshPath(mesh)}/components`, signal);
}

// Returns the ids of the faces of the component that has this face, the nearest first.
export async function getComponent(mesh, face, signal) {
    const walk = { walk: 'breadth_first', from: { face } };
    return (await postJson(`${meshPath(mesh)}/traverse`, walk, null, signal)).ids;
}

// Returns what a check finds: {defects: [{code, detail, ...}], totals: {CODE: count}, ...}, or null if
// the server would need a long time for that.
export async function check(mesh) {
    const answer = await request(`${meshPath(mesh)}/check`);
    return answer.status === 200 ? answer.json() : null;
}

// Returns what a check finds: {revision, problems, defects, totals, thresholds, complete}; with
// `withMeets` also the faces that intersect. If it takes long, `work` shows its progress, see jobs.js.
export function getCheck(mesh, withMeets, signal, work) {
    const asked = withMeets ? '?self_intersections=true' : '';
    return readLong(`${meshPath(mesh)}/check${asked}`, signal, work);
}

// Returns how far the mesh is from another one, or from its own revision if `other` is a number.
export function compare(mesh, other, work) {
    return postJson(`${meshPath(mesh)}/compare`, { with: other }, work);
}
