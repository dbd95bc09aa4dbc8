// meshes.js - lists meshes, and does what concerns a mesh as a whole.

import { postJson } from './jobs.js';
import { getJson, meshPath, queryOf, readOn, request } from './request.js';

// The most meshes in one page of the list, as the server allows.
export const MOST_LISTED = 10000;

// Returns one page of the list of meshes, of at most `limit`: {items, next}; `next` is the cursor of
// the next page, or null. `sort` is 'name', 'modified' (the newest first) or 'bytes' (the largest
// first); only meshes whose names contain the text `contains` are listed, unless it is ''.
export function listMeshes({ sort, contains = '', cursor = null, limit = 200 } = {}) {
    const values = { limit, sort, contains: contains || undefined, cursor: cursor ?? undefined };
    return getJson(`v1/meshes?${queryOf(values)}`);
}

// Returns the meshes among which the user can choose one, in the order of their names.
export async function meshesToChoose() {
    return (await listMeshes({ sort: 'name', limit: MOST_LISTED })).items;
}

export function getSummary(mesh, signal) {
    return getJson(meshPath(mesh), signal);
}

// Returns the entity tag of a mesh's present state.
export async function getTag(mesh) {
    return (await request(`${meshPath(mesh)}/edits?limit=1`)).headers.get('ETag');
}

// Changes the name of a mesh; null removes it.
export function rename(mesh, name) {
    return request(meshPath(mesh), {
        method: 'PATCH',
        headers: { 'Content-Type': 'application/merge-patch+json', Prefer: 'return=minimal' },
        body: JSON.stringify({ name }),
    });
}

// Makes a copy of a mesh and returns its summary; `work` is as in jobs.js.
export function copy(mesh, name, work) {
    return postJson(`${meshPath(mesh)}/copy`, { name }, work);
}

// Creates a mesh from a document or a shape, {shape, ...}, and returns its summary; `work` is as in
// jobs.js.
export function create(document, work) {
    return postJson('v1/meshes', document, work);
}

// Deletes a mesh if it is still in the state that the entity tag names; else fails with status 412.
// `isLeaving` says that the page is being left, and that the request must outlive it.
export function remove(mesh, tag, isLeaving = false) {
    const headers = { 'If-Match': tag };
    return request(meshPath(mesh), { method: 'DELETE', headers, keepalive: isLeaving });
}

// Reads a mesh as a file. `choices` are the query parameters of the export; those that are
// undefined are left out. Calls `onBytes` with the number of bytes that have arrived. Returns
// {blob, suggested, warnings}: the file, the name that the server suggests or null, and the header
// that says what the file lacks, or ''.
export async function getFile(mesh, choices, onBytes, signal) {
    const path = `${meshPath(mesh)}/content?${queryOf(choices)}`;
    const answer = await request(path, { signal, cache: 'no-store' });
    const reader = answer.body.getReader();
    const parts = [];
    let bytes = 0;
    for (let part = await readOn(reader); !part.done; part = await readOn(reader)) {
        parts.push(part.value);
        bytes += part.value.length;
        onBytes(bytes);
    }
    const { headers } = answer;
    const [, suggested = null] = /filename="([^"]+)"/.exec(headers.get('Content-Disposition')) ?? [];
    const warnings = utf8Of(headers.get('Export-Warnings') ?? '');
    return { blob: new Blob(parts, { type: headers.get('Content-Type') }), suggested, warnings };
}

// Returns the text of a header that the server has sent in UTF-8; a browser reads each byte of a
// header as one character.
function utf8Of(header) {
    return new TextDecoder().decode(Uint8Array.from(header, (byte) => byte.charCodeAt(0)));
}
