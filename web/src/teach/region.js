// region.js - reads the part of a mesh that an operation changes, as it is before and after the
// operation. The operation is applied to a copy of the mesh, which is deleted again.
//
// A state is {halfedges, vertices, counts}: `halfedges` maps ids to {next, prev, origin, face}, where
// face is null at a boundary; `vertices` maps ids to positions; `counts` are the numbers of vertices,
// edges and faces of the whole mesh. Elements that a state lacks do not exist in it.

import { formatCount } from '../kit/dom.js';
import * as api from '../wire/api.js';
import { Problem } from '../wire/api.js';

// The largest number of edges that an operation may change, and of faces that the mesh may have.
const MOST_EDGES = 60;
const MOST_FACES = 200000;

// Returns {before, after} for an operation on a mesh; `faces` is the number of faces of the mesh. Fails
// with a Problem if the operation is refused, or changes too much to be drawn.
export async function readRegion(mesh, operation, faces) {
    if (faces > MOST_FACES) {
        const limit = formatCount(MOST_FACES);
        throw tooLarge(`Meshes of more than ${limit} faces cannot be shown step by step.`);
    }
    const changes = await api.tryEdit(mesh, operation);
    const edges = new Set(changes === null ? [] : edgesIn(changes));
    if (changes === null || changes.replaced || edges.size > MOST_EDGES) {
        throw tooLarge(`Only operations that change at most ${MOST_EDGES} edges can be shown step by step.`);
    }
    return withCopy(mesh, async (copy) => {
        await api.edit(copy, operation);
        return withoutIdle(...(await readBoth([mesh, copy], changes)));
    });
}

// Calls act(copy) with the id of a copy of a mesh, deletes the copy, also if the page is left meanwhile,
// and returns the result.
async function withCopy(mesh, act) {
    const { id } = await api.copy(mesh, 'step by step').catch((error) => {
        if (error.status === 401 || error.status === 403) {
            const words = 'The steps are read from a copy of the mesh, and the server lets this page make none.';
            error.detail = `${words} ${error.detail ?? ''}`.trim();
        }
        throw error;
    });
    // Nobody else has changed the copy, so it is deleted in whatever state it is.
    const leave = () => api.remove(id, '*', true).catch(() => {});
    window.addEventListener('pagehide', leave);
    try {
        const result = await act(id);
        await api.remove(id, '*');
        return result;
    } catch (error) {
        await api.remove(id, '*').catch(() => {}); // the first error is the one to show
        throw error;
    } finally {
        window.removeEventListener('pagehide', leave);
    }
}

function tooLarge(detail) {
    return new Problem({ title: 'Too large to be shown', detail });
}

function* edgesIn({ created, deleted, modified }) {
    for (const { edges = [] } of [created, deleted, modified]) {
        yield* edges;
    }
}

// Reads two meshes, of which the second is the first one after an edit.
async function readBoth(meshes, changes) {
    const parts = [
        [changes.deleted, changes.modified],
        [changes.created, changes.modified],
    ];
    const faces = await Promise.all(meshes.map((mesh, i) => facesIn(mesh, parts[i])));
    const edges = [...new Set(edgesIn(changes))].flatMap((edge) => [2 * edge, 2 * edge + 1]);
    const halfedges = [...new Set([...edges, ...faces.flat().flatMap((id) => [id, id ^ 1])])];
    const records = await Promise.all(meshes.map((mesh) => getAll(mesh, 'halfedge', halfedges)));
    const lone = [changes.created, changes.deleted, changes.modified].flatMap(({ vertices = [] }) => vertices);
    const vertices = [
        ...new Set([...lone, ...records.flatMap((found) => [...found.values()].map(({ origin }) => origin))]),
    ];
    return Promise.all(
        meshes.map(async (mesh, i) => {
            const [points, { counts }] = await Promise.all([
                getAll(mesh, 'vertex', vertices),
                api.getSummary(mesh),
            ]);
            return {
                halfedges: new Map(
                    [...records[i]].map(([id, { next, prev, origin, face }]) => [id, { next, prev, origin, face }]),
                ),
                vertices: new Map([...points].map(([id, { position }]) => [id, position])),
                counts: { vertices: counts.vertices, edges: counts.edges, faces: counts.faces },
            };
        }),
    );
}

// Returns the half-edges of all faces that are in `parts` or beside an edge in `parts`.
async function facesIn(mesh, parts) {
    const named = parts.flatMap(({ faces = [] }) => faces);
    const edges = await getAll(mesh, 'edge', parts.flatMap((part) => part.edges ?? []));
    const beside = [...edges.values()].flatMap(({ faces }) => faces).filter((face) => face !== null);
    const faces = await getAll(mesh, 'face', [...new Set([...named, ...beside])]);
    return [...faces.values()].flatMap(({ halfedges }) => halfedges);
}

// Returns a map from ids to the elements of a mesh, without those that do not exist.
async function getAll(mesh, kind, ids) {
    if (ids.length === 0) {
        return new Map();
    }
    const answers = await api.query(mesh, ids.map((id) => ({ get: { [kind]: id } })));
    return new Map(
        answers.flatMap((answer, i) => ('status' in answer || answer.type ? [] : [[ids[i], answer]])),
    );
}

// Returns two states without what does not change: only half-edges that change stay, the loops of
// their faces, the twins of all these, and their vertices. Pure.
export function withoutIdle(before, after) {
    const states = [before, after];
    const ids = new Set(states.flatMap(({ halfedges }) => [...halfedges.keys()]));
    const changed = [...ids].filter((id) => {
        const [was, is] = states.map(({ halfedges }) => halfedges.get(id));
        return JSON.stringify(was) !== JSON.stringify(is);
    });
    const faces = new Set(
        changed.flatMap((id) => states.map(({ halfedges }) => halfedges.get(id)?.face ?? null)),
    );
    const moved = new Set(
        [...before.vertices].filter(([id, at]) => `${at}` !== `${after.vertices.get(id)}`).map(([id]) => id),
    );
    const isKept = (id) =>
        changed.includes(id) ||
        states.some(({ halfedges }) => {
            const { face = null, origin = null } = halfedges.get(id) ?? {};
            return (face !== null && faces.has(face)) || moved.has(origin);
        });
    const kept = new Set([...ids].filter((id) => isKept(id) || isKept(id ^ 1)));
    return Object.fromEntries(
        Object.entries({ before, after }).map(([name, state]) => [name, onlyWith(state, kept, states)]),
    );
}

function onlyWith({ halfedges, vertices, counts }, kept, [before, after]) {
    const corners = new Set(
        [before, after].flatMap((state) => [...kept].map((id) => state.halfedges.get(id)?.origin)),
    );
    const isLone = (id) => !before.vertices.has(id) || !after.vertices.has(id);
    return {
        halfedges: new Map([...halfedges].filter(([id]) => kept.has(id))),
        vertices: new Map([...vertices].filter(([id]) => corners.has(id) || isLone(id))),
        counts,
    };
}
