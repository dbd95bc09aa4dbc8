// revision.js - all that is shown of a mesh, and how it is brought forward. Only here is it decided
// which arrays and which answers of the server belong together.
//
//   mesh        of what
//   geometry    the arrays to draw, see geometry.js: patched in place within their layout
//   history     the newest page of it, as the server says
//   summary     as the server says; of a large mesh it may be of a revision before
//   boundary    the half-edges of all boundary loops: origin, target, origin, target, ...; likewise
//
// What is read comes back as a function that puts it in place, so that all that belongs to one
// frame is put in place at once.

import * as api from './api.js';
import { VERTEX_ISOLATED, findFaces, headerOf, unpack } from './geometry.js';
import { applyDelta } from './geometry_delta.js';

// The server walks the whole mesh for its summary and its loops. Of more triangles than these they
// are read only when nothing else happens.
const LARGE = 100000;

const NO_BOUNDARY = new Uint32Array();

export class Content {
    history = null;
    summary = null;
    boundary = NO_BOUNDARY;

    constructor(mesh, geometry) {
        this.mesh = mesh;
        this.geometry = geometry;
    }

    // A mesh as it is now; `onProgress` gets the part that has been read, 0 to 1.
    static async read(mesh, withBoundary, onProgress, signal) {
        const geometry = unpack(await api.getGeometry(mesh, onProgress, signal));
        const content = new Content(mesh, geometry);
        const puts = await Promise.all([
            content.readHistory(signal),
            content.readFacts(withBoundary, signal),
        ]);
        puts.forEach((put) => put());
        return content;
    }

    get revision() {
        return this.geometry.revision;
    }

    get isLarge() {
        return this.geometry.triangleCount > LARGE;
    }

    // Are the summary and the boundary those of the revision that is shown, or newer?
    get hasFacts() {
        return this.summary.revision >= this.revision;
    }

    // What the arrays have become; `whole` does without those there are. The function it returns
    // gives what applyDelta() does, or null where all of them are new, and throws a RangeError
    // where the change is of other arrays: then `whole` is needed.
    async readGeometry(whole) {
        if (whole) {
            const buffer = await api.getGeometry(this.mesh, () => {});
            return () => this.#replace(buffer);
        }
        const buffer = await api.getGeometryChanges(this.mesh, this.geometry);
        const isWhole = headerOf(buffer).base === 0;
        return isWhole ? () => this.#replace(buffer) : () => this.#patch(buffer);
    }

    #replace(buffer) {
        this.geometry = unpack(buffer);
        return null;
    }

    #patch(buffer) {
        const { geometry } = this;
        const change = applyDelta(geometry, buffer);
        findFaces(geometry, change.triangles);
        geometry.hasIsolated ||= change.vertices.some(
            (vertex) => geometry.vertices[4 * vertex + 3] === VERTEX_ISOLATED,
        );
        return change;
    }

    async readHistory(signal) {
        const history = await api.getHistory(this.mesh, null, signal);
        return () => {
            this.history = history;
        };
    }

    async readFacts(withBoundary, signal) {
        const summary = await api.getSummary(this.mesh, signal);
        const boundary =
            withBoundary && summary.counts.boundary_loops > 0
                ? endsOf((await api.getBoundaries(this.mesh, signal)).loops)
                : NO_BOUNDARY;
        return () => {
            this.summary = summary;
            this.boundary = boundary;
        };
    }
}

function endsOf(loops) {
    const ends = new Uint32Array(2 * loops.reduce((sum, { vertices }) => sum + vertices.length, 0));
    let at = 0;
    for (const { vertices } of loops) {
        for (let i = 0; i < vertices.length; i++) {
            ends[at++] = vertices[i];
            ends[at++] = vertices[(i + 1) % vertices.length];
        }
    }
    return ends;
}
