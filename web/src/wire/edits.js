// edits.js - changes a mesh, and reads and names the revisions of its history.
//
// An edit request names the revision that it is meant for; the server answers 412 if the mesh has
// changed. `work` is as in jobs.js.

import { postJson } from './jobs.js';
import { Problem } from './problem.js';
import { getJson, meshPath, request } from './request.js';

// Number of edits in one page of a mesh's history.
const HISTORY_PAGE = 20;

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

// Returns one page of a mesh's history, newest edits first: {revision, entries, undo, redo, next}.
// `undo` and `redo` are the numbers of steps that can be undone and redone, `next` is the cursor of
// the next page, or null.
export function getHistory(mesh, cursor = null, signal = undefined) {
    const after = cursor === null ? '' : `&cursor=${encodeURIComponent(cursor)}`;
    return getJson(`${meshPath(mesh)}/edits?limit=${HISTORY_PAGE}${after}`, signal);
}

// Names a revision of a mesh; null takes its name away.
export function nameRevision(mesh, revision, name) {
    return request(`${meshPath(mesh)}/edits/${revision}`, {
        method: 'PATCH',
        headers: { 'Content-Type': 'application/merge-patch+json', Prefer: 'return=minimal' },
        body: JSON.stringify({ name }),
    });
}
