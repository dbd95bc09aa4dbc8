// arrays.js - reads the arrays from which a mesh is drawn, see geometry/geometry.js.

import { HEADER_BYTES, headerOf } from '../geometry/geometry.js';
import { Problem } from './problem.js';
import { meshPath, readOn, request } from './request.js';

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
