// geometry.js - elements in, typed arrays for drawing out. Pure: no page, no network, no WebGL.
//
// A mesh is drawn from two arrays, laid out as the renderer's textures read them:
//
//   vertices   4 floats each:  x, y, z, state (VERTEX_USED or VERTEX_ISOLATED)
//   triangles  4 words each:   corners a, b, c, and face | sides << 29
//
//            c              bit 29: a -> b is an edge of the polygon
//           / \             bit 30: b -> c
//          a---b            bit 31: c -> a
//                           a bit that is clear marks a diagonal, which is not drawn
//
// Corners and faces are slots: places in `vertexIds` and `faceIds`, both ascending. Ids have gaps
// where elements were deleted; slots have none. slotOf() and the two arrays lead back and forth.
//
// Positions are moved and scaled into the unit ball ("view coordinates") in double precision before
// they are rounded to floats, so that a mesh far from the origin or of any size draws the same. The
// frame that says how stays with a mesh across its edits: what did not move does not move.

export const VERTEX_USED = 1;
export const VERTEX_ISOLATED = 2;

const SIDE_SHIFT = 29;
const FACE_MASK = 2 ** SIDE_SHIFT - 1;

// Most tests of a point against a triangle that one polygon may cost. Beyond it ears are cut
// unchecked: a polygon of a hundred thousand corners then looks wrong instead of stopping the page.
const MAX_EAR_TESTS = 2e7;

// The sine under which three corners count as collinear. An ear cut there would have no area, and
// the two edges on it would not be drawn.
const COLLINEAR = 1e-10;

// A typed array that grows.
class Column {
    constructor(Type) {
        this.array = new Type(1024);
        this.length = 0;
    }

    push(value) {
        if (this.length === this.array.length) {
            const larger = new this.array.constructor(2 * this.length);
            larger.set(this.array);
            this.array = larger;
        }
        this.array[this.length++] = value;
    }

    get values() {
        return this.array.subarray(0, this.length);
    }
}

// Gathers the vertices and faces of a mesh as the server lists them, in the order of their ids.
export class Elements {
    #vertexIds = new Column(Uint32Array);
    #positions = new Column(Float64Array);
    #faceIds = new Column(Uint32Array);
    #starts = new Column(Uint32Array);
    #corners = new Column(Uint32Array);

    constructor() {
        this.#starts.push(0);
    }

    addVertex({ id, position }) {
        Elements.#addId(this.#vertexIds, id);
        for (let axis = 0; axis < 3; axis++) {
            this.#positions.push(position[axis]);
        }
    }

    addFace({ id, vertices }) {
        Elements.#addId(this.#faceIds, id);
        for (const vertex of vertices) {
            this.#corners.push(vertex);
        }
        this.#starts.push(this.#corners.length);
    }

    static #addId(ids, id) {
        if (ids.length > 0 && id <= ids.array[ids.length - 1]) {
            throw new RangeError(`id ${id} comes after id ${ids.array[ids.length - 1]}`);
        }
        ids.push(id);
    }

    get vertexIds() {
        return this.#vertexIds.values;
    }

    get positions() {
        return this.#positions.values;
    }

    get faceIds() {
        return this.#faceIds.values;
    }

    // Face i has corners[starts[i]] ... corners[starts[i + 1] - 1]: vertex ids.
    get starts() {
        return this.#starts.values;
    }

    get corners() {
        return this.#corners.values;
    }
}

// The slot of an id in an ascending array of ids, -1 when it is not there.
export function slotOf(ids, id) {
    let low = 0;
    let high = ids.length - 1;
    while (low <= high) {
        const middle = (low + high) >>> 1;
        if (ids[middle] === id) {
            return middle;
        }
        if (ids[middle] < id) {
            low = middle + 1;
        } else {
            high = middle - 1;
        }
    }
    return -1;
}

// The frame in which positions fit the unit ball: their box's centre, and half of its longest side.
export function frameOf(positions) {
    const low = [Infinity, Infinity, Infinity];
    const high = [-Infinity, -Infinity, -Infinity];
    for (let i = 0; i < positions.length; i++) {
        const axis = i % 3;
        low[axis] = Math.min(low[axis], positions[i]);
        high[axis] = Math.max(high[axis], positions[i]);
    }
    if (positions.length === 0) {
        return { center: [0, 0, 0], half: 1 };
    }
    // Halves first: the sum or difference of two large doubles may be infinite.
    const center = low.map((value, axis) => value / 2 + high[axis] / 2);
    const half = Math.max(...low.map((value, axis) => high[axis] / 2 - value / 2));
    return { center, half: half > 0 ? half : 1 };
}

function toView(frame, value, axis) {
    return (2 * (value / 2 - frame.center[axis] / 2)) / frame.half / Math.sqrt(3);
}

// The arrays for drawing `elements`. Without a frame one is made.
export function pack(elements, frame = frameOf(elements.positions)) {
    const { vertexIds, positions, faceIds, starts, corners } = elements;
    if (faceIds.length > FACE_MASK) {
        throw new RangeError(`a mesh of ${faceIds.length} faces cannot be drawn`);
    }
    const vertices = new Float32Array(4 * vertexIds.length);
    for (let slot = 0; slot < vertexIds.length; slot++) {
        for (let axis = 0; axis < 3; axis++) {
            vertices[4 * slot + axis] = toView(frame, positions[3 * slot + axis], axis);
        }
        vertices[4 * slot + 3] = VERTEX_ISOLATED;
    }
    const triangles = new Uint32Array(4 * Math.max(corners.length - 2 * faceIds.length, 0));
    const polygon = new Polygon();
    let at = 0;
    for (let face = 0; face < faceIds.length; face++) {
        polygon.begin(starts[face + 1] - starts[face]);
        for (let i = starts[face]; i < starts[face + 1]; i++) {
            const slot = slotOf(vertexIds, corners[i]);
            if (slot < 0) {
                throw new RangeError(`face ${faceIds[face]} has unknown vertex ${corners[i]}`);
            }
            vertices[4 * slot + 3] = VERTEX_USED;
            polygon.add(
                slot,
                toView(frame, positions[3 * slot], 0),
                toView(frame, positions[3 * slot + 1], 1),
                toView(frame, positions[3 * slot + 2], 2),
            );
        }
        polygon.triangulate((a, b, c, sides) => {
            triangles[at++] = a;
            triangles[at++] = b;
            triangles[at++] = c;
            triangles[at++] = face | (sides << SIDE_SHIFT);
        });
    }
    return {
        frame,
        radius: radiusOf(vertices),
        hasIsolated: hasIsolated(vertices),
        vertices,
        triangles,
        vertexIds,
        faceIds,
    };
}

// How far the vertices reach from the frame's centre; never nothing: a camera must stand further.
function radiusOf(vertices) {
    let radius = 0;
    for (let i = 0; i < vertices.length; i += 4) {
        radius = Math.max(radius, Math.hypot(vertices[i], vertices[i + 1], vertices[i + 2]));
    }
    return radius > 0 ? radius : 1;
}

function hasIsolated(vertices) {
    for (let i = 3; i < vertices.length; i += 4) {
        if (vertices[i] === VERTEX_ISOLATED) {
            return true;
        }
    }
    return false;
}

// The slot of a triangle's face, and whether its side i is an edge of the polygon.
export function faceOf(triangles, triangle) {
    return triangles[4 * triangle + 3] & FACE_MASK;
}

export function isEdge(triangles, triangle, side) {
    return ((triangles[4 * triangle + 3] >>> (SIDE_SHIFT + side)) & 1) === 1;
}

// The polygon edges on some triangles, as pairs of vertex slots in the direction of their face.
export function edgesOfTriangles(triangles, which) {
    const edges = [];
    for (const triangle of which) {
        for (let side = 0; side < 3; side++) {
            if (isEdge(triangles, triangle, side)) {
                edges.push([
                    triangles[4 * triangle + side],
                    triangles[4 * triangle + ((side + 1) % 3)],
                ]);
            }
        }
    }
    return edges;
}

export function trianglesOfFace(triangles, face) {
    const found = [];
    for (let triangle = 0; 4 * triangle < triangles.length; triangle++) {
        if (faceOf(triangles, triangle) === face) {
            found.push(triangle);
        }
    }
    return found;
}

// One polygon, cut into triangles: ear clipping (Meisters, "Polygons have ears", 1975) in the plane
// of its Newell normal (Sutherland, Sproull, Schumacker, 1974). Kept for many polygons in turn, so
// that a mesh of a million faces does not allocate a million times.
//
//     begin(n)  add() n times  triangulate(emit)
//
// emit(a, b, c, sides) gets n - 2 triangles wound as the polygon is, with bit i of `sides` set
// where side i is an edge of the polygon. A polygon that crosses itself or has no area still gives
// n - 2 triangles.
export class Polygon {
    #count = 0;
    #slots = [];
    #points = new Float64Array(3 * 16);
    #flat = new Float64Array(2 * 16);
    #next = new Int32Array(16);
    #prev = new Int32Array(16);
    #isReflex = new Uint8Array(16);
    #reflex = []; // all corners with that mark, and some that have lost it
    #tests = 0;

    begin(count) {
        this.#count = 0;
        this.#tests = 0;
        if (count > this.#next.length) {
            this.#points = new Float64Array(3 * count);
            this.#flat = new Float64Array(2 * count);
            this.#next = new Int32Array(count);
            this.#prev = new Int32Array(count);
            this.#isReflex = new Uint8Array(count);
        }
    }

    add(slot, x, y, z) {
        const i = this.#count++;
        this.#slots[i] = slot;
        this.#points[3 * i] = x;
        this.#points[3 * i + 1] = y;
        this.#points[3 * i + 2] = z;
    }

    triangulate(emit) {
        const n = this.#count;
        if (n === 3) {
            emit(this.#slots[0], this.#slots[1], this.#slots[2], 7);
            return;
        }
        this.#flatten();
        this.#reflex.length = 0;
        for (let i = 0; i < n; i++) {
            this.#next[i] = (i + 1) % n;
            this.#prev[i] = (i + n - 1) % n;
        }
        for (let i = 0; i < n; i++) {
            this.#isReflex[i] = this.#isConvex(i) ? 0 : 1;
            if (this.#isReflex[i]) {
                this.#reflex.push(i);
            }
        }
        let left = n;
        let corner = 0;
        let misses = 0;
        while (left > 3) {
            // Without an ear in a whole round the polygon is degenerate: cut here all the same.
            if (misses < left && !this.#isEar(corner)) {
                corner = this.#next[corner];
                misses++;
                continue;
            }
            this.#emit(corner, emit);
            const before = this.#prev[corner];
            const after = this.#next[corner];
            this.#next[before] = after;
            this.#prev[after] = before;
            this.#isReflex[corner] = 0;
            // A cut never makes a neighbour reflex, only convex.
            for (const neighbour of [before, after]) {
                if (this.#isReflex[neighbour] && this.#isConvex(neighbour)) {
                    this.#isReflex[neighbour] = 0;
                }
            }
            left--;
            misses = 0;
            // Skipping a corner keeps a round polygon from becoming a fan of slivers.
            corner = this.#next[after];
        }
        this.#emit(corner, emit);
    }

    // Drop the axis that the normal is closest to, keeping the winding counter-clockwise.
    #flatten() {
        const n = this.#count;
        const p = this.#points;
        const normal = [0, 0, 0];
        for (let i = 0; i < n; i++) {
            const j = (i + 1) % n;
            for (let axis = 0; axis < 3; axis++) {
                const u = (axis + 1) % 3;
                const v = (axis + 2) % 3;
                // Relative to the first corner: far from the origin the products cancel badly.
                normal[axis] +=
                    (p[3 * i + u] - p[u]) * (p[3 * j + v] - p[v]) -
                    (p[3 * i + v] - p[v]) * (p[3 * j + u] - p[u]);
            }
        }
        const size = normal.map(Math.abs);
        const drop = size.indexOf(Math.max(...size));
        const first = (drop + (normal[drop] < 0 ? 2 : 1)) % 3;
        const second = (drop + (normal[drop] < 0 ? 1 : 2)) % 3;
        for (let i = 0; i < n; i++) {
            this.#flat[2 * i] = p[3 * i + first] - p[first];
            this.#flat[2 * i + 1] = p[3 * i + second] - p[second];
        }
    }

    // Twice the signed area of the corners i, j, k.
    #area(i, j, k) {
        const q = this.#flat;
        return (
            (q[2 * j] - q[2 * i]) * (q[2 * k + 1] - q[2 * i + 1]) -
            (q[2 * j + 1] - q[2 * i + 1]) * (q[2 * k] - q[2 * i])
        );
    }

    #isConvex(i) {
        const q = this.#flat;
        const a = this.#prev[i];
        const c = this.#next[i];
        const before = (q[2 * i] - q[2 * a]) ** 2 + (q[2 * i + 1] - q[2 * a + 1]) ** 2;
        const after = (q[2 * c] - q[2 * i]) ** 2 + (q[2 * c + 1] - q[2 * i + 1]) ** 2;
        return this.#area(a, i, c) > COLLINEAR * Math.sqrt(before) * Math.sqrt(after);
    }

    // A convex corner whose triangle holds no other corner. Only reflex ones can be inside; those
    // that are so no longer leave the list as they are met.
    #isEar(i) {
        if (this.#isReflex[i]) {
            return false;
        }
        const a = this.#prev[i];
        const c = this.#next[i];
        for (let at = 0; at < this.#reflex.length && this.#tests < MAX_EAR_TESTS; at++) {
            const r = this.#reflex[at];
            this.#tests++;
            if (!this.#isReflex[r]) {
                this.#reflex[at--] = this.#reflex[this.#reflex.length - 1];
                this.#reflex.length--;
            } else if (r !== a && r !== c && this.#contains(a, i, c, r)) {
                return false;
            }
        }
        return true;
    }

    // Is corner r in the closed triangle? Another corner at the same place does not count.
    #contains(a, b, c, r) {
        return (
            this.#area(a, b, r) >= 0 &&
            this.#area(b, c, r) >= 0 &&
            this.#area(c, a, r) >= 0 &&
            !this.#isSamePlace(a, r) &&
            !this.#isSamePlace(b, r) &&
            !this.#isSamePlace(c, r)
        );
    }

    #isSamePlace(i, j) {
        const q = this.#flat;
        return q[2 * i] === q[2 * j] && q[2 * i + 1] === q[2 * j + 1];
    }

    #emit(b, emit) {
        const n = this.#count;
        const a = this.#prev[b];
        const c = this.#next[b];
        const sides =
            ((a + 1) % n === b ? 1 : 0) | ((b + 1) % n === c ? 2 : 0) | ((c + 1) % n === a ? 4 : 0);
        emit(this.#slots[a], this.#slots[b], this.#slots[c], sides);
    }
}
