// attributes.js - the attributes and materials of a mesh, and its named sets, which are bool attributes.

import { finish } from './jobs.js';
import { getTag } from './meshes.js';
import { Problem } from './problem.js';
import { getJson, meshPath, request } from './request.js';

// Returns {revision, attributes: [{domain, name, labels, ...}]}.
export function getAttributes(mesh, signal) {
    return getJson(`${meshPath(mesh)}/attributes`, signal);
}

// Returns {revision, materials: [{name, base_color, ...}]}; fails with status 410 if the server no
// longer has the revision.
export function getMaterials(mesh, revision, signal) {
    return getJson(`${meshPath(mesh)}/materials?revision=${revision}`, signal);
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
