// levels.js - the arrays to draw a mesh at any level of detail, in the format of geometry.js. Pure.
//
// A level is a coarse mesh, the base, with some of the vertex splits that refine it applied. Unlike
// in geometry.js, the index of a vertex is not its id: vertices and triangles are in the order in
// which they arrive. A level consists of the first vertices and the first triangles in this order,
// and the next level adds one vertex and its triangles. A split also changes earlier entries: the
// vertex that is split moves, and some triangles get the new vertex as a corner. Applying a split
// exchanges such entries with stored ones, and undoing it exchanges them back.

import { ROW, VERTEX_ISOLATED, VERTEX_USED, wholeRows } from './geometry.js';
import { unreadable } from './progressive.js';

// The bits of a triangle's fourth word which say that all three sides are edges.
const SIDES = 7 << 29;

// Changed texels are recorded in blocks of this many texels. ROW is a multiple of this number, so
// that a block never spans two rows of a texture.
const BLOCK = 256;

export class Levels {
    // The arrays of the present level, in the form that the renderer takes.
    geometry;
    count = 0; // splits that have arrived
    level = 0; // splits that are applied
    most; // number of all splits

    #origin;
    #scale;
    #base; // numbers of vertices and faces of the base
    #isolated = 0;
    #placeOf; // index + 1 of each vertex by its id; #triangleOf has those of triangles
    #triangleOf;
    #faces = 0;
    // One entry of each array for each split. #from: the vertex that is split. #other: its position
    // before the split if the split is applied, else its position after it. #movedEnd: where the
    // list of the triangles that the split changes ends in #moved. #faceEnd: the number of
    // triangles that exist after the split.
    #from;
    #other;
    #movedEnd;
    #faceEnd;
    #moved = new Uint32Array(1024);
    #changed;

    // The first argument has the counts that ProgressiveReader passes to `begin`, the second is the
    // `frame` of the mesh's geometry (offset and scale), see geometry.js.
    constructor({ vertices, faces, splits, vertexIds, faceIds }, { origin, scale }) {
        [this.#origin, this.#scale] = [origin, scale];
        this.#base = { vertices, faces };
        this.#placeOf = new Uint32Array(vertexIds);
        this.#triangleOf = new Uint32Array(faceIds);
        this.#from = new Uint32Array(splits);
        this.#other = new Float32Array(3 * splits);
        this.#movedEnd = new Uint32Array(splits);
        this.#faceEnd = new Uint32Array(splits);
        this.most = splits;
        this.geometry = {
            vertices: wholeRows(new Float32Array(4 * (vertices + splits))),
            vertexCount: 0,
            triangles: wholeRows(new Uint32Array(4 * (faces + 2 * splits))),
            triangleCount: 0,
            hasIsolated: false,
        };
        this.#changed = {
            vertices: new Changes(this.geometry.vertices.length / 4),
            triangles: new Changes(this.geometry.triangles.length / 4),
        };
    }

    // Whether the base, the coarsest level, has arrived completely.
    get hasBase() {
        const { vertexCount } = this.geometry;
        return vertexCount >= this.#base.vertices && this.#faces >= this.#base.faces;
    }

    // Number of faces of the finest level that has arrived.
    get faces() {
        return this.#faces;
    }

    // Fraction of the splits that have arrived, 0 to 1.
    get part() {
        return this.most > 0 ? this.count / this.most : 1;
    }

    // --- arriving data ---

    addVertex(id, place) {
        const { geometry } = this;
        this.#put(geometry.vertexCount++, id, place, VERTEX_ISOLATED);
        this.#isolated++;
        geometry.hasIsolated = true;
    }

    addFace(id, corners) {
        const { geometry } = this;
        const places = Array.from(corners, (corner) => this.#vertexOf(corner));
        for (const place of places) {
            const state = 4 * place + 3;
            this.#isolated -= geometry.vertices[state] === VERTEX_ISOLATED ? 1 : 0;
            geometry.vertices[state] = VERTEX_USED;
        }
        geometry.hasIsolated = this.#isolated > 0;
        this.#addTriangle(id, ...places);
        geometry.triangleCount++;
    }

    // Stores the next split without applying it.
    addSplit({ vertex, from, left, right, at, fromAt, moved }) {
        const i = this.count;
        const place = this.#base.vertices + i;
        const beside = this.#vertexOf(from);
        this.#put(place, vertex, at, VERTEX_USED);
        this.#from[i] = beside;
        this.#putPlace(this.#other, 3 * i, fromAt);
        if (left !== null) {
            this.#addTriangle(left.face, place, beside, this.#vertexOf(left.corner));
        }
        if (right !== null) {
            this.#addTriangle(right.face, beside, place, this.#vertexOf(right.corner));
        }
        this.#faceEnd[i] = this.#faces;
        this.#addMoved(i, moved);
        this.count++;
    }

    #put(place, id, position, state) {
        if (id >= this.#placeOf.length || this.#placeOf[id] !== 0) {
            throw unreadable();
        }
        this.#placeOf[id] = place + 1;
        const { vertices } = this.geometry;
        this.#putPlace(vertices, 4 * place, position);
        vertices[4 * place + 3] = state;
    }

    // Stores a position in view coordinates.
    #putPlace(array, at, position) {
        for (let axis = 0; axis < 3; axis++) {
            array[at + axis] = (position[axis] - this.#origin[axis]) * this.#scale;
        }
    }

    #addTriangle(id, a, b, c) {
        if (id >= this.#triangleOf.length || this.#triangleOf[id] !== 0) {
            throw unreadable();
        }
        const { triangles } = this.geometry;
        const at = 4 * this.#faces;
        triangles[at] = a;
        triangles[at + 1] = b;
        triangles[at + 2] = c;
        triangles[at + 3] = id | SIDES;
        this.#triangleOf[id] = ++this.#faces;
    }

    #addMoved(i, moved) {
        const begin = i > 0 ? this.#movedEnd[i - 1] : 0;
        const end = begin + moved.length;
        if (end > this.#moved.length) {
            const longer = new Uint32Array(2 * end);
            longer.set(this.#moved);
            this.#moved = longer;
        }
        for (let k = 0; k < moved.length; k++) {
            this.#moved[begin + k] = this.#find(this.#triangleOf, moved[k]);
        }
        this.#movedEnd[i] = end;
    }

    #vertexOf(id) {
        return this.#find(this.#placeOf, id);
    }

    // Returns the index of the element with this id. Throws a RangeError if this element has not
    // arrived.
    #find(places, id) {
        if (!(places[id] > 0)) {
            throw unreadable();
        }
        return places[id] - 1;
    }

    // --- levels ---

    // Applies or undoes splits until `level` splits are applied, or all that have arrived.
    goTo(level) {
        const wanted = Math.max(Math.min(level, this.count), 0);
        for (; this.level < wanted; this.level++) {
            const place = this.#base.vertices + this.level;
            this.#exchange(this.level, this.#from[this.level], place);
        }
        for (; this.level > wanted; this.level--) {
            const place = this.#base.vertices + this.level - 1;
            this.#exchange(this.level - 1, place, this.#from[this.level - 1]);
        }
        const { geometry } = this;
        geometry.vertexCount = this.#base.vertices + wanted;
        geometry.triangleCount = wanted > 0 ? this.#faceEnd[wanted - 1] : this.#base.faces;
    }

    // Applies split i, or undoes it: replaces vertex `from` by `to` in the triangles that the split
    // changes, and exchanges the position of the split vertex with the stored one.
    #exchange(i, from, to) {
        const { vertices, triangles } = this.geometry;
        const [moved, other, changed] = [this.#moved, this.#other, this.#changed];
        const end = this.#movedEnd[i];
        for (let k = i > 0 ? this.#movedEnd[i - 1] : 0; k < end; k++) {
            const at = 4 * moved[k];
            const corner = triangles[at] === from ? 0 : triangles[at + 1] === from ? 1 : 2;
            triangles[at + corner] = to;
            changed.triangles.note(moved[k]);
        }
        const vertex = this.#from[i];
        for (let axis = 0; axis < 3; axis++) {
            const value = vertices[4 * vertex + axis];
            vertices[4 * vertex + axis] = other[3 * i + axis];
            other[3 * i + axis] = value;
        }
        changed.vertices.note(vertex);
    }

    // Returns what changed since the last call: {vertices, triangles}, ranges [begin, end] of
    // texels in ascending order, each within one row.
    takeChanges() {
        const { vertexCount, triangleCount } = this.geometry;
        return {
            vertices: this.#changed.vertices.take(vertexCount),
            triangles: this.#changed.triangles.take(triangleCount),
        };
    }
}

// Records which blocks of texels of an array have changed since they were uploaded to graphics
// memory, considering only the texels of the present level.
class Changes {
    #blocks;
    #shown = 0; // number of texels shown at the last call of take(); later ones may be outdated

    constructor(length) {
        this.#blocks = new Uint8Array(length / BLOCK);
    }

    note(texel) {
        this.#blocks[(texel / BLOCK) >>> 0] = 1;
    }

    take(shown) {
        const blocks = this.#blocks;
        const end = Math.ceil(shown / BLOCK);
        if (shown > this.#shown) {
            blocks.fill(1, Math.floor(this.#shown / BLOCK), end);
        }
        this.#shown = shown;
        const ranges = [];
        for (let block = 0; block < end; block++) {
            if (blocks[block] === 1) {
                const [begin, next] = [BLOCK * block, BLOCK * (block + 1)];
                const last = ranges.at(-1);
                if (last?.[1] === begin && begin % ROW !== 0) {
                    last[1] = next;
                } else {
                    ranges.push([begin, next]);
                }
                blocks[block] = 0;
            }
        }
        return ranges;
    }
}
