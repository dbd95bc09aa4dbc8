// revision.js - reads and updates all data of a mesh that the page shows, an object of class
// Content. Only this module decides which arrays and which answers of the server belong together.
// Its members are
//
//   mesh        the id of the mesh
//   geometry    the arrays to draw, see geometry.js; changes are applied to them in place
//   history     the newest page of the history, as the server sent it
//   summary     counts and measures, as the server sent them; if the mesh is large, they may be of
//               an earlier revision
//   boundary    ids of the origin and the target of each half-edge of all boundary loops, one after
//               another; of the revision of `summary`
//
// Each function that reads something returns another function that puts the result into the
// Content, so that all results for one frame are put there at once.

import * as api from '../wire/api.js';
import { VERTEX_ISOLATED, findFaces, headerOf, unpack } from '../geometry/geometry.js';
import { applyDelta } from '../geometry/geometry_delta.js';

// The server must visit the whole mesh to compute its summary and its boundary loops. If the mesh
// has more triangles than this, both are read only when the mesh is not changing.
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

    // Reads a mesh in its present revision and returns its Content; calls `onProgress` with the
    // fraction of the arrays that has been read, 0 to 1.
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

    // Whether `summary` and `boundary` belong to the revision that is shown, or to a newer one.
    get hasFacts() {
        return this.summary.revision >= this.revision;
    }

    // Reads the changes of the arrays or, if `whole` is true, all arrays. The returned function
    // puts them into the Content and returns the result of applyDelta(), or null if all arrays are
    // new. The function throws a RangeError if the changes do not belong to the present arrays:
    // then all arrays must be read.
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

    // The returned function takes `onlyNewer`: whether a history is left that is newer than this one.
    async readHistory(signal) {
        const history = await api.getHistory(this.mesh, null, signal);
        return (onlyNewer = false) => {
            if (!onlyNewer || history.revision >= this.history.revision) {
                this.history = history;
            }
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
