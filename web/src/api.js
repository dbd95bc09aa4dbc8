// api.js - the only module that talks to the server. Paths are relative, so that the page works
// behind any prefix.

import { HEADER_BYTES, headerOf } from './geometry.js';

const KINDS = { vertex: 'vertices', halfedge: 'halfedges', edge: 'edges', face: 'faces' };

// Media types by the end of a file's name; what is not here the server is asked to refuse.
const MEDIA_TYPES = {
    obj: 'model/obj',
    off: 'model/x-off',
    ply: 'model/ply',
    stl: 'model/stl',
    glb: 'model/gltf-binary',
    json: 'application/json',
};

// What the server (or the way to it) refused: an RFC 9457 problem.
export class Problem extends Error {
    constructor({ status = 0, title = '', detail = '', code = '', pointer = '' }) {
        super(detail || title);
        this.status = status;
        this.title = title;
        this.detail = detail;
        this.code = code;
        this.pointer = pointer;
    }
}

function unreachable() {
    return new Problem({
        title: 'No connection',
        detail: 'The server cannot be reached. Is hedged still running?',
    });
}

// The problem in an answer's text, or one made of its status where there is none.
function problemOf(status, text) {
    try {
        const problem = JSON.parse(text);
        if (typeof problem.detail === 'string' || typeof problem.title === 'string') {
            return new Problem({ ...problem, status });
        }
    } catch {
        // Not JSON: some gateway answered.
    }
    const detail = `The server answered with status ${status}.`;
    return new Problem({ status, title: 'Request failed', detail });
}

async function request(path, options = {}) {
    let answer;
    try {
        answer = await fetch(path, { cache: 'no-cache', ...options });
    } catch (error) {
        throw error.name === 'AbortError' ? error : unreachable();
    }
    if (!answer.ok) {
        throw problemOf(answer.status, await answer.text());
    }
    return answer;
}

async function getJson(path, signal) {
    return (await request(path, { signal })).json();
}

// The page waits for its answers: what takes long must not become a job.
const PATIENT = { Prefer: 'wait=600' };

async function postJson(path, body, headers = {}) {
    const answer = await request(path, {
        method: 'POST',
        headers: { 'Content-Type': 'application/json', ...headers },
        body: JSON.stringify(body),
    });
    return answer.json();
}

function meshPath(mesh) {
    return `v1/meshes/${encodeURIComponent(mesh)}`;
}

// The server's own OpenAPI document.
export function getDescription() {
    return getJson('v1/openapi.json');
}

// One page of the list: {items, next}; `next` is the cursor of the page after it, or null.
export function listMeshes(cursor = null) {
    const after = cursor === null ? '' : `&cursor=${encodeURIComponent(cursor)}`;
    return getJson(`v1/meshes?limit=200${after}`);
}

export function getSummary(mesh, signal) {
    return getJson(meshPath(mesh), signal);
}

// How many steps can be undone and redone: {undo, redo}.
export function getHistory(mesh, signal) {
    return getJson(`${meshPath(mesh)}/edits?limit=1`, signal);
}

export function getElement(mesh, kind, id) {
    return getJson(`${meshPath(mesh)}/${KINDS[kind]}/${id}`);
}

// Many questions of one revision, answered in order; a failed one by its problem.
export async function query(mesh, queries) {
    return (await postJson(`${meshPath(mesh)}/query`, { queries })).results;
}

// Many elements of one revision, in order; null for one that does not live.
export async function getElements(mesh, wanted) {
    const results = await query(mesh, wanted.map(({ kind, id }) => ({ get: { [kind]: id } })));
    return results.map((result) => ('status' in result ? null : result));
}

// {revision, loops: [{halfedges, vertices, ...}]}
export function getBoundaries(mesh, signal) {
    return getJson(`${meshPath(mesh)}/boundaries`, signal);
}

// The operation table: [{name, doc, params, ...}].
export async function getOperations() {
    return (await getJson('v1/operations')).operations;
}

// The ids of the elements of another kind beside one, such as the faces of a vertex.
export async function getAdjacent(mesh, kind, id, relation) {
    return (await getJson(`${meshPath(mesh)}/${KINDS[kind]}/${id}/${relation}`)).ids;
}

// The half-edge from one vertex to another, null when there is none.
export async function findHalfedge(mesh, from, to) {
    const [{ halfedge }] = await query(mesh, [{ find: 'halfedge', vertices: [from, to] }]);
    return halfedge;
}

// The arrays to draw a mesh from, as an ArrayBuffer; `onProgress` gets the part that has come, 0 to
// 1. Its header says how long it is: Content-Length may be that of a compressed body.
export async function getGeometry(mesh, onProgress, signal) {
    const answer = await request(`${meshPath(mesh)}/geometry`, { signal });
    const reader = answer.body.getReader();
    let whole = new Uint8Array(HEADER_BYTES);
    let at = 0;
    const take = (bytes) => {
        const room = bytes.subarray(0, whole.length - at);
        whole.set(room, at);
        at += room.length;
        return bytes.subarray(room.length);
    };
    for (;;) {
        const { done, value } = await readOn(reader);
        if (done) {
            break;
        }
        let rest = take(value);
        if (at === HEADER_BYTES && whole.length === HEADER_BYTES) {
            const header = whole;
            whole = new Uint8Array(headerOf(header.buffer).length);
            whole.set(header.subarray(0, whole.length));
        }
        rest = take(rest);
        if (rest.length > 0) {
            reader.cancel();
            const detail = 'The geometry of the mesh is longer than it says.';
            throw new Problem({ title: 'Answer too long', detail });
        }
        onProgress(at / whole.length);
    }
    if (at < HEADER_BYTES || at !== whole.length) {
        const detail = 'The geometry of the mesh broke off.';
        throw new Problem({ title: 'Answer cut short', detail });
    }
    return whole.buffer;
}

async function readOn(reader) {
    try {
        return await reader.read();
    } catch (error) {
        throw error.name === 'AbortError' ? error : unreachable();
    }
}

// Edits name the revision they were meant for: 412 when the mesh has moved on.
export function edit(mesh, operation, revision) {
    const body = { expected_revision: revision, ops: [operation] };
    return postJson(`${meshPath(mesh)}/edits`, body, PATIENT);
}

export function undo(mesh, revision) {
    return postJson(`${meshPath(mesh)}/undo`, { expected_revision: revision });
}

export function redo(mesh, revision) {
    return postJson(`${meshPath(mesh)}/redo`, { expected_revision: revision });
}

// Create a mesh of a file; `onProgress` gets the sent part, 0 to 1. Returns the new mesh's summary.
// fetch cannot tell how much was sent, hence XMLHttpRequest.
export function upload(file, onProgress) {
    const dot = file.name.lastIndexOf('.');
    const name = dot > 0 ? file.name.slice(0, dot) : file.name;
    const type = MEDIA_TYPES[file.name.slice(dot + 1).toLowerCase()];
    return new Promise((resolve, reject) => {
        const sender = new XMLHttpRequest();
        sender.open('POST', `v1/meshes?name=${encodeURIComponent(name)}`);
        sender.setRequestHeader('Content-Type', type ?? (file.type || 'application/octet-stream'));
        sender.setRequestHeader('Prefer', PATIENT.Prefer);
        sender.upload.onprogress = (event) => {
            onProgress(event.lengthComputable ? event.loaded / event.total : 0);
        };
        sender.onload = () => {
            if (sender.status >= 200 && sender.status < 300) {
                resolve(JSON.parse(sender.responseText));
            } else {
                reject(problemOf(sender.status, sender.responseText));
            }
        };
        sender.onerror = () => reject(unreachable());
        sender.send(file);
    });
}
