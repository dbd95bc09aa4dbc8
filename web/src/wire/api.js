// api.js - the only module that talks to the server. Paths are relative, so that the page works
// behind any prefix.

import { API_PLURALS } from '../geometry/kinds.js';
import { EventReader } from './events.js';
import { HEADER_BYTES, headerOf } from '../geometry/geometry.js';
import { storableName } from './names.js';
import { renewToken, token } from './token.js';

// Number of edits in one page of a mesh's history.
const HISTORY_PAGE = 20;

// Milliseconds between requests for the state of a job: JOB_SOON at first, then each time twice as
// many, at most JOB_LATEST.
const JOB_SOON = 60;
const JOB_LATEST = 1000;

// Media type of each extension of file names; the server refuses files with another extension.
const MEDIA_TYPES = {
    obj: 'model/obj',
    off: 'model/x-off',
    ply: 'model/ply',
    stl: 'model/stl',
    glb: 'model/gltf-binary',
    gltf: 'model/gltf+json',
    json: 'application/json',
};

// An error that the server, or a proxy in front of it, answered: the members of an RFC 9457
// problem, and `mesh`, the id of the mesh that the request was about, or null.
export class Problem extends Error {
    constructor({
        status = 0,
        title = '',
        detail = '',
        code = '',
        pointer = '',
        repair = [],
        elements = [],
        total = 0,
        element = null,
        mesh = null,
    }) {
        super(detail || title);
        this.status = status;
        this.title = title;
        this.detail = detail;
        this.code = code;
        this.pointer = pointer;
        this.repair = repair;
        this.elements = elements;
        this.total = total;
        this.element = element;
        this.mesh = mesh;
    }
}

function unreachable() {
    return new Problem({
        title: 'No connection',
        detail: 'The server cannot be reached. Is hedged still running?',
    });
}

// Returns the problem that is in the text of an answer, or, if the text is not a problem document,
// makes a problem from the answer's status.
function problemOf(status, text) {
    try {
        const problem = JSON.parse(text);
        if (typeof problem.detail === 'string' || typeof problem.title === 'string') {
            return new Problem({ ...problem, status });
        }
    } catch {
        // The answer is not JSON, so it comes from a gateway in front of the server.
    }
    const detail = `The server answered with status ${status}.`;
    return new Problem({ status, title: 'Request failed', detail });
}

async function request(path, options = {}) {
    const bearer = token();
    const headers = { ...options.headers };
    if (bearer !== null) {
        headers.Authorization = `Bearer ${bearer}`;
    }
    let answer;
    try {
        answer = await fetch(path, { cache: 'no-cache', ...options, headers });
    } catch (error) {
        throw error.name === 'AbortError' ? error : unreachable();
    }
    if (answer.status === 401 && (await renewToken(bearer))) {
        return request(path, options);
    }
    if (!answer.ok) {
        const problem = problemOf(answer.status, await answer.text());
        problem.mesh = meshOf(path);
        throw problem;
    }
    return answer;
}

// Sends any request, such as an example of the manual, and returns the answer whatever its status is.
export async function sendAny(path, options = {}) {
    const bearer = token();
    const headers = { ...(bearer !== null && { Authorization: `Bearer ${bearer}` }), ...options.headers };
    try {
        return await fetch(path, { cache: 'no-store', ...options, headers });
    } catch (error) {
        throw error.name === 'AbortError' ? error : unreachable();
    }
}

async function getJson(path, signal) {
    return (await request(path, { signal })).json();
}

// Reads an answer that may take long to compute: if the server answers with a job, waits for it.
async function readLong(path, signal, work = null) {
    const answer = await request(path, { signal });
    return answer.status === 202 ? finish(await answer.json(), work, meshOf(path)) : answer.json();
}

// Sends a POST and returns the JSON of the answer, or null if it has no body. If the server answers
// with a job, because the request takes long, waits for the job and returns its result.
async function postJson(path, body, work = null, signal = undefined) {
    const headers = { 'Content-Type': 'application/json' };
    if (work !== null) {
        headers.Prefer = 'respond-async';
    }
    const answer = await request(path, {
        method: 'POST',
        headers,
        body: JSON.stringify(body),
        signal,
    });
    if (answer.status === 204) {
        return null;
    }
    return answer.status === 202 ? finish(await answer.json(), work, meshOf(path)) : answer.json();
}

// Returns the id of the mesh that is in the path of a request, or null.
function meshOf(path) {
    const found = /^v1\/meshes\/([^/?]+)/.exec(path);
    return found === null ? null : decodeURIComponent(found[1]);
}

function meshPath(mesh) {
    return `v1/meshes/${encodeURIComponent(mesh)}`;
}

// Returns a description of the access token that the page's requests carry now: {name, role,
// prefixes, expires}; `name` is null if the server does not require tokens.
export async function getToken() {
    const bearer = token();
    try {
        return await getJson('v1/token');
    } catch (error) {
        // A token with the role `metrics` may not even ask this, so the page cannot use it.
        const reason = 'The token may only read metrics. The page needs the role read or write.';
        if (error.status === 403 && (await renewToken(bearer, reason))) {
            return getToken();
        }
        throw error;
    }
}

// Returns the list of the manual's pages in which its search looks.
export function readIndex(address) {
    return getJson(address);
}

let description = null;

// Returns the server's OpenAPI document, which is read once.
export function getDescription() {
    description ??= getJson('v1/openapi.json').catch((error) => {
        description = null;
        throw error;
    });
    return description;
}

// Returns the query of an address; what is undefined is left out.
function queryOf(values) {
    return Object.entries(values)
        .filter(([, value]) => value !== undefined)
        .map(([name, value]) => `${name}=${encodeURIComponent(value)}`)
        .join('&');
}

// The most meshes in one page of the list, as the server allows.
export const MOST_LISTED = 10000;

// Returns one page of the list of meshes, of at most `limit`: {items, next}; `next` is the cursor of
// the next page, or null. `sort` is 'name', 'modified' (the newest first) or 'bytes' (the largest first); only meshes
// whose names contain the text `contains` are listed, unless it is ''.
export function listMeshes({ sort, contains = '', cursor = null, limit = 200 } = {}) {
    const values = { limit, sort, contains: contains || undefined, cursor: cursor ?? undefined };
    return getJson(`v1/meshes?${queryOf(values)}`);
}

// Returns the meshes among which the user can choose one, in the order of their names.
export async function meshesToChoose() {
    return (await listMeshes({ sort: 'name', limit: MOST_LISTED })).items;
}

// Changes the name of a mesh; null removes it.
export function rename(mesh, name) {
    return request(meshPath(mesh), {
        method: 'PATCH',
        headers: { 'Content-Type': 'application/merge-patch+json', Prefer: 'return=minimal' },
        body: JSON.stringify({ name }),
    });
}

// Names a revision of a mesh; null takes its name away.
export function nameRevision(mesh, revision, name) {
    return request(`${meshPath(mesh)}/edits/${revision}`, {
        method: 'PATCH',
        headers: { 'Content-Type': 'application/merge-patch+json', Prefer: 'return=minimal' },
        body: JSON.stringify({ name }),
    });
}

// Shows something of this page to the other clients of a mesh: {client, name, selection, camera,
// leaves}. `isLeaving` says that the page is being left, and that the request must outlive it.
export function putPresence(mesh, presence, isLeaving = false) {
    return request(`${meshPath(mesh)}/presence`, {
        method: 'PUT',
        headers: { 'Content-Type': 'application/json', Prefer: 'return=minimal' },
        body: JSON.stringify(presence),
        keepalive: isLeaving,
    });
}

// Makes a copy of a mesh and returns its summary; `work` is as in edit().
export function copy(mesh, name, work) {
    return postJson(`${meshPath(mesh)}/copy`, { name }, work);
}

// Returns the entity tag of a mesh's present state.
export async function getTag(mesh) {
    return (await request(`${meshPath(mesh)}/edits?limit=1`)).headers.get('ETag');
}

// Deletes a mesh if it is still in the state that the entity tag names; else fails with status 412.
// `isLeaving` says that the page is being left, and that the request must outlive it.
export function remove(mesh, tag, isLeaving = false) {
    const headers = { 'If-Match': tag };
    return request(meshPath(mesh), { method: 'DELETE', headers, keepalive: isLeaving });
}

export function getSummary(mesh, signal) {
    return getJson(meshPath(mesh), signal);
}

// Returns one page of a mesh's history, newest edits first: {revision, entries, undo, redo, next}.
// `undo` and `redo` are the numbers of steps that can be undone and redone, `next` is the cursor of
// the next page, or null.
export function getHistory(mesh, cursor = null, signal = undefined) {
    const after = cursor === null ? '' : `&cursor=${encodeURIComponent(cursor)}`;
    return getJson(`${meshPath(mesh)}/edits?limit=${HISTORY_PAGE}${after}`, signal);
}

// Returns the elements of a small mesh, at most 1,000; `kinds` is 'vertices', 'edges', 'faces' or
// 'halfedges'.
export async function getElements(mesh, kinds) {
    return (await getJson(`${meshPath(mesh)}/${kinds}?limit=1000`)).items;
}

export function getElement(mesh, kind, id) {
    return getJson(`${meshPath(mesh)}/${API_PLURALS[kind]}/${id}`);
}

// Sends several queries about one revision of a mesh in one request and returns the answers in
// order; the answer to a failed query is a problem.
export async function query(mesh, queries) {
    return (await postJson(`${meshPath(mesh)}/query`, { queries })).results;
}

// --- values of all elements ---
//
// These are read as bytes and from one revision; they fail with status 410 if the server no longer has
// it. `kind` is 'vertices', 'halfedges', 'edges' or 'faces'.

// Returns a measure of all elements that exist, in the order of their ids, as a Float64Array; NaN if
// an element has no value. A vector is three numbers.
export async function measureAll(mesh, measure, kind, revision, signal) {
    const question = { measure, of: { [kind]: 'all' } };
    const bytes = await ask(mesh, question, revision, signal);
    return new Float64Array(bytes, 0, (bytes.byteLength - 4 * (countElements(bytes) + 1)) / 8);
}

// Returns the neighbours of all elements that exist, in the order of their ids: {offsets, ids}; those
// of the element at index i are ids[offsets[i]] to ids[offsets[i + 1] - 1].
export async function relateAll(mesh, relation, kind, revision, signal) {
    const question = { relation, of: { [kind]: 'all' } };
    const bytes = await ask(mesh, question, revision, signal);
    const words = new Uint32Array(bytes);
    const count = countElements(bytes);
    return { offsets: words.subarray(0, count + 1), ids: words.subarray(count + 1, -count - 1) };
}

// An answer about all elements ends with their ids and their number, of 4 bytes each.
function countElements(bytes) {
    return new DataView(bytes).getUint32(bytes.byteLength - 4, true);
}

function ask(mesh, question, revision, signal) {
    return readBytes(`${meshPath(mesh)}/query?revision=${revision}`, {
        method: 'POST',
        headers: { 'Content-Type': 'application/json' },
        body: JSON.stringify({ queries: [question] }),
        signal,
    });
}

// Returns the values of an attribute by id, also of ids without an element, as an ArrayBuffer.
export function getValues(mesh, kind, name, revision, signal) {
    const path = `${meshPath(mesh)}/attributes/${kind}/${encodeURIComponent(name)}`;
    return readBytes(`${path}?revision=${revision}`, { signal });
}

// Reads an answer as bytes. If the server answers with a job, waits for the job and reads its result.
async function readBytes(path, options) {
    const headers = { ...options.headers, Accept: 'application/octet-stream', Prefer: 'wait=30' };
    let answer = await request(path, { ...options, headers });
    if (answer.status === 202) {
        const job = await answer.json();
        await finish(job, null);
        answer = await request(`v1/jobs/${job.id}/result`, { headers, signal: options.signal });
    }
    return answer.arrayBuffer();
}

// Returns which measures the server has, [{name, kind, components}]: it is asked for each measure of
// its description of no elements of each kind, and refuses those that it does not have.
export async function getMeasures(mesh) {
    const { components } = await getDescription();
    const { measure_name: names, domain: kinds } = components.schemas;
    const asked = kinds.enum
        .filter((kind) => kind !== 'mesh')
        .flatMap((kind) => names.enum.map((name) => ({ name, kind })));
    const answers = await query(
        mesh,
        asked.map(({ name, kind }) => ({ measure: name, of: { [kind]: [] } })),
    );
    return asked
        .map((one, i) => ({ ...one, components: answers[i].components }))
        .filter((one) => one.components !== undefined);
}

// Returns what a check finds: {defects: [{code, detail, ...}], totals: {CODE: count}, ...}, or null if
// the server would need a long time for that.
export async function check(mesh) {
    const answer = await request(`${meshPath(mesh)}/check`);
    return answer.status === 200 ? answer.json() : null;
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

// Returns what a check finds: {revision, problems, defects, totals, thresholds, complete}; with
// `withMeets` also the faces that intersect. If it takes long, `work` shows its progress, see edit().
export function getCheck(mesh, withMeets, signal, work) {
    const asked = withMeets ? '?self_intersections=true' : '';
    return readLong(`${meshPath(mesh)}/check${asked}`, signal, work);
}

// Returns how far the mesh is from another one, or from its own revision if `other` is a number.
export function compare(mesh, other, work) {
    return postJson(`${meshPath(mesh)}/compare`, { with: other }, work);
}

// Returns {revision, attributes: [{domain, name, labels, ...}]}.
export function getAttributes(mesh, signal) {
    return getJson(`${meshPath(mesh)}/attributes`, signal);
}

// Returns {revision, materials: [{name, base_color, ...}]}; fails with status 410 if the server no
// longer has the revision.
export function getMaterials(mesh, revision, signal) {
    return getJson(`${meshPath(mesh)}/materials?revision=${revision}`, signal);
}

// Returns the values of a label attribute of faces, by id, as a Uint32Array; fails with status 410
// if the server no longer has the revision.
export async function getFaceLabels(mesh, name, revision, signal) {
    const path = `${meshPath(mesh)}/attributes/faces/${encodeURIComponent(name)}`;
    const headers = { Accept: 'application/octet-stream', Prefer: 'wait=30' };
    const answer = await request(`${path}?revision=${revision}`, { signal, headers });
    return new Uint32Array(await answer.arrayBuffer());
}

// Returns the ids of a set: of the elements of a kind ('vertices', 'edges' or 'faces') whose bool
// attribute `name` is true or, with a `value`, whose int attribute has this value.
export async function getSet(mesh, kind, name, value) {
    const path = `${meshPath(mesh)}/attributes/${kind}/${encodeURIComponent(name)}`;
    const headers = { Accept: 'application/octet-stream', Prefer: 'wait=30' };
    const bytes = await (await request(path, { headers })).arrayBuffer();
    const values = value === undefined ? new Uint8Array(bytes) : new Int32Array(bytes);
    const ids = [];
    values.forEach((one, id) => {
        if (one === (value ?? 1)) {
            ids.push(id);
        }
    });
    return ids;
}

// Makes a named set of the elements with these ids, {domain, name}: a bool attribute. Replaces a set
// with this name; fails if the name is that of another attribute, or if the mesh is not at
// `revision`.
export async function putSet(mesh, { domain, name }, ids, revision) {
    const path = `${meshPath(mesh)}/attributes/${domain}/${encodeURIComponent(name)}`;
    const { attributes } = await getAttributes(mesh);
    const other = attributes.find((it) => it.domain === domain && it.name === name);
    if (other !== undefined && (other.type !== 'bool' || other.components !== 1)) {
        const detail = `${name} is an attribute of type ${other.type}. Choose another name.`;
        throw new Problem({ title: 'No set', detail });
    }
    const tag = await getTag(mesh);
    // A dry run tells how many ids were ever given out, which is the length of the array.
    const tried = await request(path, {
        method: 'PUT',
        headers: { 'Content-Type': 'application/json' },
        body: JSON.stringify({ type: 'bool', dry_run: true, expected_revision: revision }),
    });
    const values = new Uint8Array((await tried.json()).attribute.bytes);
    ids.forEach((id) => {
        values[id] = 1;
    });
    const answer = await request(`${path}?type=bool`, {
        method: 'PUT',
        headers: { 'Content-Type': 'application/octet-stream', 'If-Match': tag },
        body: values,
    });
    return answer.status === 202 ? finish(await answer.json(), null) : answer.json();
}

export async function deleteSet(mesh, { domain, name }) {
    const path = `${meshPath(mesh)}/attributes/${domain}/${encodeURIComponent(name)}`;
    return (await request(path, { method: 'DELETE' })).json();
}

// Returns the ids of the edges that continue an edge: its 'edge_loop', which leads straight on through
// vertices with four edges, or its 'edge_ring', which leads straight across faces with four edges.
export async function getLine(mesh, walk, edge) {
    return (await postJson(`${meshPath(mesh)}/traverse`, { walk, from: { edge } })).edges;
}

// Returns the table of operations: [{name, doc, params, ...}].
export async function getOperations() {
    return (await getJson('v1/operations')).operations;
}

// Returns the ids of an element's neighbours of some kind, such as the faces of a vertex.
export async function getAdjacent(mesh, kind, id, relation) {
    return (await getJson(`${meshPath(mesh)}/${API_PLURALS[kind]}/${id}/${relation}`)).ids;
}

// Returns the half-edge from one vertex to another, or null if there is none.
export async function findHalfedge(mesh, from, to) {
    const [{ halfedge }] = await query(mesh, [{ find: 'halfedge', vertices: [from, to] }]);
    return halfedge;
}

// Reads the arrays from which a mesh is drawn and returns them in one ArrayBuffer, see geometry.js;
// calls `onProgress` with the fraction that has been read, 0 to 1.
export function getGeometry(mesh, onProgress, signal) {
    return readArrays(`${meshPath(mesh)}/geometry`, onProgress, signal);
}

// Returns the arrays of an earlier revision of a mesh.
export function getEarlierGeometry(mesh, revision, signal) {
    return readArrays(`${meshPath(mesh)}/geometry?revision=${revision}`, () => {}, signal);
}

// Returns the changes of the arrays of getGeometry() since this revision and layout, or the
// complete arrays if the server cannot tell the changes: see geometry_delta.js.
export function getGeometryChanges(mesh, { revision, layout }) {
    return readArrays(`${meshPath(mesh)}/geometry?since=${revision}&layout=${layout}`, () => {});
}

// Reads an answer that begins with a header of geometry.js. The length is taken from this header,
// because Content-Length is the compressed length if the body is compressed.
async function readArrays(path, onProgress, signal) {
    const answer = await request(path, { signal });
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
            const detail = 'The geometry of the mesh is longer than its header says.';
            throw new Problem({ title: 'Answer too long', detail });
        }
        onProgress(at / whole.length);
    }
    if (at < HEADER_BYTES || at !== whole.length) {
        const detail = 'The geometry of the mesh did not arrive completely.';
        throw new Problem({ title: 'Answer incomplete', detail });
    }
    return whole.buffer;
}

// Reads a mesh as a coarse mesh followed by refinements; calls `onBytes` with the bytes as they
// arrive, see progressive.js.
export async function getProgressive(mesh, onBytes, signal) {
    // The answer must be the bytes even if it takes long to compute; the server must not answer
    // with a job.
    const headers = { Prefer: 'wait=30' };
    const answer = await request(`${meshPath(mesh)}/progressive`, { signal, headers });
    const reader = answer.body.getReader();
    for (let part = await readOn(reader); !part.done; part = await readOn(reader)) {
        onBytes(part.value);
    }
}

async function readOn(reader) {
    try {
        return await reader.read();
    } catch (error) {
        throw error.name === 'AbortError' ? error : unreachable();
    }
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

// --- events ---

// Listens to the events of a mesh. The first event is the one after `since`, which is the id of an
// event or a revision; if `since` is null, the next one that happens. Calls onOpen when the server
// has answered, onEvent with the name, the data and the id of each event, and onError, once, when
// the stream has ended. Returns an object with close().
export function listen(mesh, since, { onOpen, onEvent, onError }) {
    const closing = new AbortController();
    follow(`${meshPath(mesh)}/events`, since, { onOpen, onEvent }, closing.signal)
        .catch(() => {})
        .then(() => closing.signal.aborted || onError());
    return { close: () => closing.abort() };
}

const HEARD = ['edit', 'metadata', 'moment', 'presence', 'resync', 'bye'];

async function follow(path, since, { onOpen, onEvent }, signal) {
    const headers = { Accept: 'text/event-stream' };
    if (since !== null) {
        headers['Last-Event-ID'] = since;
    }
    const answer = await request(path, { headers, signal, cache: 'no-store' });
    const reader = answer.body.pipeThrough(new TextDecoderStream()).getReader();
    const events = new EventReader();
    onOpen();
    for (let part = await reader.read(); !part.done; part = await reader.read()) {
        for (const { name, data, id } of events.take(part.value)) {
            if (!signal.aborted && HEARD.includes(name)) {
                onEvent(name, JSON.parse(data), id);
            }
        }
    }
}

// --- edits ---
//
// An edit request names the revision that it is meant for; the server answers 412 if the mesh has
// changed.
//
// If `work` is not null, the server may run the edit as a job. Then work.begin(cancel) is called
// once, with a function that cancels the job, and work.show(job) with each state of the job.

// Sends one operation, or a list of which all are done or none.
export function edit(mesh, operations, revision, work = null) {
    const body = { expected_revision: revision, ops: [operations].flat() };
    return postJson(`${meshPath(mesh)}/edits`, body, work);
}

// Returns what an operation, or a list, would change in the present mesh, without changing anything;
// null if the server would need a long time to compute that.
export async function tryEdit(mesh, operations, signal) {
    const answer = await request(`${meshPath(mesh)}/edits`, {
        method: 'POST',
        headers: { 'Content-Type': 'application/json' },
        body: JSON.stringify({ dry_run: true, ops: [operations].flat() }),
        signal,
    });
    return answer.status === 200 ? answer.json() : null;
}

// Returns where an operation `deform` would move vertices, without changing anything: {ids,
// positions}, a Uint32Array and a Float64Array with three numbers for each.
export async function tryDeform(mesh, operation, signal) {
    const answer = await request(`${meshPath(mesh)}/deform`, {
        method: 'POST',
        headers: { 'Content-Type': 'application/json', Prefer: 'wait=10' },
        body: JSON.stringify(operation),
        signal,
    });
    const detail = 'The server takes too long to bend a mesh of this size while it is dragged.';
    if (answer.status !== 200) {
        throw new Problem({ status: answer.status, title: 'Too slow', detail });
    }
    const bytes = await answer.arrayBuffer();
    const count = bytes.byteLength / 28;
    return {
        ids: new Uint32Array(bytes, 24 * count, count),
        positions: new Float64Array(bytes, 0, 3 * count),
    };
}

// Undoes the last step, or all steps since the revision `to`, on a mesh at `revision`.
export function undo(mesh, revision, to = undefined) {
    const body = { expected_revision: revision, to_revision: to };
    return postJson(`${meshPath(mesh)}/undo`, body);
}

// Redoes the step undone last, or as many as lead to the content of the revision `to`.
export function redo(mesh, revision, to = undefined) {
    const body = { expected_revision: revision, to_revision: to };
    return postJson(`${meshPath(mesh)}/redo`, body);
}

// --- jobs ---

function cancelled() {
    return new Problem({ title: 'Cancelled', detail: 'Nothing was changed.', code: 'cancelled' });
}

// Waits for a job: returns its result or throws its problem. `mesh` is the id of the mesh that the job
// is about, or null.
async function finish(first, work, mesh = null) {
    const path = `v1/jobs/${first.id}`;
    let stop = () => {};
    const stopped = () => new Promise((resolve) => {
        stop = resolve;
    });
    work?.begin(async () => {
        // A job that has ended is not cancelled: DELETE would then delete its result.
        if ((await getJson(path)).finished === null) {
            await request(path, { method: 'DELETE' });
        }
        stop();
    });
    let job = first;
    for (let delay = JOB_SOON; job.finished === null; delay = Math.min(2 * delay, JOB_LATEST)) {
        work?.show(job);
        await Promise.race([stopped(), new Promise((resolve) => setTimeout(resolve, delay))]);
        job = await getJson(path);
    }
    if (job.state === 'cancelled') {
        throw cancelled();
    }
    if (job.state === 'failed') {
        throw job.problem ? new Problem({ ...job.problem, mesh }) : problemOf(job.status, '');
    }
    return job.result ?? null;
}

// Creates a mesh from a document or a shape, {shape, ...}, and returns its summary; `work` is as in
// edit().
export function create(document, work) {
    return postJson('v1/meshes', document, work);
}

// Creates a mesh from `batch`, {file, beside}: a file and the files that it refers to. `choices` are
// further query parameters, such as {repair: 'weld,orient'}. Calls `onProgress` with the fraction that has been sent, 0 to 1. Returns the
// summary of the new mesh. Uses XMLHttpRequest because fetch does not report how much was sent.
export async function upload(batch, onProgress, work, choices = {}) {
    const bearer = token();
    const { status, answer } = await send(batch, onProgress, work, choices, bearer);
    if (status === 401) {
        if (await renewToken(bearer)) {
            return upload(batch, onProgress, work, choices);
        }
        throw new Problem({ ...answer, status });
    }
    onProgress(1);
    return status === 202 ? finish(answer, work) : answer;
}

// Returns a multipart form that contains several files.
function formOf(files) {
    const form = new FormData();
    files.forEach((file) => form.append('files', file, file.name));
    return form;
}

// Sends a file, or a form if several files belong together. An answer with status 401 does not
// reject the promise, so that upload() can ask the user for a token.
function send({ file, beside }, onProgress, work, choices, bearer) {
    const dot = file.name.lastIndexOf('.');
    const name = storableName(dot > 0 ? file.name.slice(0, dot) : file.name);
    const type = MEDIA_TYPES[file.name.slice(dot + 1).toLowerCase()];
    return new Promise((resolve, reject) => {
        const sender = new XMLHttpRequest();
        sender.open('POST', `v1/meshes?${queryOf({ name, ...choices })}`);
        if (beside.length === 0) {
            const other = file.type || 'application/octet-stream';
            sender.setRequestHeader('Content-Type', type ?? other);
        }
        sender.setRequestHeader('Prefer', 'respond-async');
        if (bearer !== null) {
            sender.setRequestHeader('Authorization', `Bearer ${bearer}`);
        }
        sender.upload.onprogress = (event) => {
            onProgress(event.lengthComputable ? event.loaded / event.total : 0);
        };
        sender.onload = () => {
            const { status, responseText: text } = sender;
            if ((status >= 200 && status < 300) || status === 401) {
                resolve({ status, answer: JSON.parse(text) });
            } else {
                reject(problemOf(status, text));
            }
        };
        sender.onerror = () => reject(unreachable());
        sender.onabort = () => reject(cancelled());
        work.begin(() => sender.abort());
        sender.send(beside.length === 0 ? file : formOf([file, ...beside]));
    });
}
