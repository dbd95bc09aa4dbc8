// levels.js - the arrays to draw a mesh from at any level of detail, see geometry.js for what they
// look like. Pure.
//
// Vertices and triangles lie in the order in which they come, not at their ids: a level is so many
// of both from the first on, and the next one has a vertex and its triangles more. What lies behind
// is as it was when it was last shown. So a split gives its neighbours what the next level has of
// them, and takes back what this one had; what a collapse undoes is the same the other way round.

import { ROW, VERTEX_ISOLATED, VERTEX_USED, wholeRows } from './geometry.js';
import { unreadable } from './progressive.js';

// All three sides of a triangle are edges.
const SIDES = 7 << 29;

// Changes are told by blocks of so many texels, of which no row of a texture has a part.
const BLOCK = 256;

export class Levels {
    // As the renderer takes it.
    geometry;
    count = 0; // splits that have come
    level = 0; // splits that are done
    most; // splits there are

    #origin;
    #scale;
    #base; // vertices and faces of the base
    #isolated = 0;
    #placeOf; // of ids, from 1 on
    #triangleOf;
    #faces = 0;
    // Of each split: the vertex that is left and its position at the other level; where what it
    // moves, and the triangles of the level it makes, end.
    #from;
    #other;
    #movedEnd;
    #faceEnd;
    #moved = new Uint32Array(1024);
    #changed;

    // What a ProgressiveReader begins with, and the frame of the mesh's geometry.
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

    // Has all of the base come?
    get hasBase() {
        const { vertexCount } = this.geometry;
        return vertexCount >= this.#base.vertices && this.#faces >= this.#base.faces;
    }

    // That have come.
    get faces() {
        return this.#faces;
    }

    // Of the splits, 0 to 1.
    get part() {
        return this.most > 0 ? this.count / this.most : 1;
    }

    // --- what comes ---

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

    // The next split of the mesh; it is not done yet.
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

    // In view coordinates.
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

    // Where something is that has come.
    #find(places, id) {
        if (!(places[id] > 0)) {
            throw unreadable();
        }
        return places[id] - 1;
    }

    // --- levels ---

    // Do or undo splits until so many are done, of those that have come.
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

    // What split i moves has vertex `to` where it had `from`, and the vertex it leaves the position
    // it has at the other level.
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

    // What is to be sent to the graphics memory since this was asked for last: {vertices,
    // triangles}, ranges [begin, end] of texels in rising order, none of which leaves its row.
    takeChanges() {
        const { vertexCount, triangleCount } = this.geometry;
        return {
            vertices: this.#changed.vertices.take(vertexCount),
            triangles: this.#changed.triangles.take(triangleCount),
        };
    }
}

// Which blocks of an array are not in the graphics memory as they are now, of those that are shown.
class Changes {
    #blocks;
    #shown = 0; // texels when they were taken last; what lies behind may be old

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
