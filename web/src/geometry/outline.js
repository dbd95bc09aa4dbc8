// outline.js - the outline in which a plane cuts a mesh: its lines, its length and its area. Pure.
//
//        + + + +           A vertex is above the plane if its distance along the normal is 0 or
//       /|\ above          more, else below. Each triangle with corners on both sides is cut from
//    --o-+-o------ plane   one edge to another edge. An edge is cut at one point, which its two
//     /  |  \ below        triangles share, so the pieces of the line form loops, which are open
//    - - - - -             only at boundary edges.
//
// With this rule every cut is the one that the plane has when it is moved towards its lower side by
// a length that is smaller than any distance: if faces lie in the plane, their rim is cut, or
// nothing, depending on the side on which the mesh continues.

const PAUSE = 8192; // vertices, triangles or points between two interruptions

// A generator for inSlices() that returns {length, area, closed, open, lines, fans} of the cut with
// the plane of all points p with dot(normal, p) = at; `normal` has the length 1, and all lengths are
// in view coordinates, see geometry.js. `closed` and `open` are the numbers of closed and of open
// loops; `area` is that within the closed loops, less that of holes. `lines` are the end points of the
// pieces, six numbers for each piece. `fans` are the corners of triangles, nine numbers for each: a
// point of the plane is within the closed loops if an odd number of these triangles cover it.
export function* cutOutline(geometry, { normal, at }) {
    const heights = yield* heightsOf(geometry, normal, at);
    const cut = yield* cutsOf(geometry, heights);
    const next = Uint32Array.from(cut.next);
    const { starts, count } = openFirst(next);
    const loops = { length: 0, area: 0, closed: 0, open: 0, lines: [], fans: [] };
    const isDone = new Uint8Array(count);
    let steps = 0;
    for (const start of starts) {
        if (isDone[start]) {
            continue;
        }
        const loop = [start];
        let point = start;
        for (isDone[start] = 1; next[point] > 0 && !isDone[next[point] - 1]; ) {
            point = next[point] - 1;
            isDone[point] = 1;
            loop.push(point);
            if (++steps % PAUSE === 0) {
                yield;
            }
        }
        yield* addLoop(loops, cut.points, loop, next[point] === start + 1, normal);
    }
    return {
        ...loops,
        area: Math.abs(loops.area),
        lines: Float32Array.from(loops.lines),
        fans: Float32Array.from(loops.fans),
    };
}

// Returns the distance of each vertex from the plane.
function* heightsOf({ vertices, vertexCount }, [x, y, z], at) {
    const heights = new Float64Array(vertexCount);
    for (let i = 0; i < vertexCount; i++) {
        if (i % PAUSE === 0) {
            yield;
        }
        heights[i] = x * vertices[4 * i] + y * vertices[4 * i + 1] + z * vertices[4 * i + 2] - at;
    }
    return heights;
}

// Returns the points at which edges are cut, three coordinates each, and for each point the point at
// the other end of its piece of line, plus 1; 0 if no piece begins there.
function* cutsOf(geometry, heights) {
    const { triangles, triangleCount, vertexCount } = geometry;
    const points = [];
    const next = [];
    const found = new Map(); // the point of each edge that is cut
    const pointOf = (below, above) => {
        const key = below * vertexCount + above;
        let point = found.get(key);
        if (point === undefined) {
            point = next.length;
            found.set(key, point);
            next.push(0);
            points.push(...crossing(geometry, heights, below, above));
        }
        return point;
    };
    for (let i = 0; i < 4 * triangleCount; i += 4) {
        if (i % (4 * PAUSE) === 0) {
            yield;
        }
        const isA = heights[triangles[i]] >= 0;
        const isB = heights[triangles[i + 1]] >= 0;
        const isC = heights[triangles[i + 2]] >= 0;
        if ((isA === isB && isB === isC) || triangles[i] === triangles[i + 1]) {
            continue;
        }
        // Of the three sides, one goes up through the plane and one goes down.
        const is = [isA, isB, isC];
        const up = is.findIndex((isAbove, k) => !isAbove && is[(k + 1) % 3]);
        const down = is.findIndex((isAbove, k) => isAbove && !is[(k + 1) % 3]);
        const corner = (k) => triangles[i + (k % 3)];
        const from = pointOf(corner(up), corner(up + 1));
        next[from] = pointOf(corner(down + 1), corner(down)) + 1;
    }
    return { points, next };
}

// Returns the point at which an edge is cut.
function crossing({ vertices }, heights, below, above) {
    const t = heights[below] / (heights[below] - heights[above]);
    return [0, 1, 2].map((axis) => {
        const [from, to] = [vertices[4 * below + axis], vertices[4 * above + axis]];
        return from + t * (to - from);
    });
}

// Returns all points: first those to which no piece of line leads, at which open loops begin.
function openFirst(next) {
    const count = next.length;
    const isEnd = new Uint8Array(count);
    next.forEach((point) => {
        if (point > 0) {
            isEnd[point - 1] = 1;
        }
    });
    const all = Array.from({ length: count }, (_, i) => i);
    return { starts: [...all.filter((i) => !isEnd[i]), ...all.filter((i) => isEnd[i])], count };
}

// Adds the length, the area, the lines and the fan of a loop; `loop` are its points in order.
function* addLoop(loops, points, loop, isClosed, normal) {
    const at = (i) => {
        const first = 3 * loop[i % loop.length];
        return [points[first], points[first + 1], points[first + 2]];
    };
    const origin = at(0);
    const pieces = isClosed ? loop.length : loop.length - 1;
    for (let i = 0; i < pieces; i++) {
        if (i % PAUSE === PAUSE - 1) {
            yield;
        }
        const [from, to] = [at(i), at(i + 1)];
        loops.length += Math.hypot(to[0] - from[0], to[1] - from[1], to[2] - from[2]);
        loops.lines.push(...from, ...to);
        if (isClosed && i > 0 && i < pieces - 1) {
            loops.area += areaOf(origin, from, to, normal);
            loops.fans.push(...origin, ...from, ...to);
        }
    }
    loops[isClosed ? 'closed' : 'open']++;
}

// Returns the area of a triangle in the plane, negative if its corners go round clockwise.
function areaOf(a, b, c, normal) {
    const u = b.map((value, axis) => value - a[axis]);
    const v = c.map((value, axis) => value - a[axis]);
    return (
        0.5 *
        (normal[0] * (u[1] * v[2] - u[2] * v[1]) +
            normal[1] * (u[2] * v[0] - u[0] * v[2]) +
            normal[2] * (u[0] * v[1] - u[1] * v[0]))
    );
}
