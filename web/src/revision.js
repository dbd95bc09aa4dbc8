// revision.js - everything that is shown of a mesh, and how it is updated. Only this module decides
// which arrays and which answers of the server belong together.
//
//   mesh        its id
//   geometry    the arrays to draw, see geometry.js: updated in place within their layout
//   history     the newest page of the history, as the server sent it
//   summary     as the server sent it; for a large mesh possibly of an earlier revision
//   boundary    half-edges of all boundary loops: origin, target, origin, target, ...; as `summary`
//
// Functions that read return a function that installs the result, so that everything for one frame
// is installed at once.

import * as api from './api.js';
import { VERTEX_ISOLATED, findFaces, headerOf, unpack } from './geometry.js';
import { applyDelta } from './geometry_delta.js';

// The server visits the whole mesh for its summary and its loops. If it has more triangles than
// this, they are read only when nothing else happens.
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

    // Reads the present mesh; calls `onProgress` with the fraction read, 0 to 1.
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

    // Whether summary and boundary are of the revision that is shown, or newer.
    get hasFacts() {
        return this.summary.revision >= this.revision;
    }

    // Reads the changed arrays; `whole` reads everything again. The returned function returns the
    // result of applyDelta(), or null if all arrays are new. It throws a RangeError if the change
    // is not of these arrays: then `whole` is needed.
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
