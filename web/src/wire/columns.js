// columns.js - reads values of all elements as bytes: measures, neighbours and attributes. Most functions
// read one revision, and fail with status 410 if the server no longer has it. `kind` is 'vertices',
// 'halfedges', 'edges' or 'faces'.

import { query } from './elements.js';
import { finish } from './jobs.js';
import { meshPath, request } from './request.js';
import { getDescription } from './service.js';

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

// Returns the values of a label attribute of faces, by id, as a Uint32Array; fails with status 410
// if the server no longer has the revision.
export async function getFaceLabels(mesh, name, revision, signal) {
    const path = `${meshPath(mesh)}/attributes/faces/${encodeURIComponent(name)}`;
    const headers = { Accept: 'application/octet-stream', Prefer: 'wait=30' };
    const answer = await request(`${path}?revision=${revision}`, { signal, headers });
    return new Uint32Array(await answer.arrayBuffer());
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
