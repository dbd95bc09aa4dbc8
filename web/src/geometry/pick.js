// pick.js - chooses one element from the contents of the id buffer around the pointer. Pure.
//
// The id buffer is an image in which each pixel has the kind and the id of the element that is
// visible there. From it the renderer reads which triangles and vertices are near the pointer. In
// edge mode only edges can be picked, in vertex mode only vertices, and so on. In these two modes a
// visible edge or vertex near the pointer is chosen; if there is none, an edge or a corner of the
// face under the pointer. holes.js chooses the half-edges of holes.

import { edgesOfTriangles, faceOf, pointAt, trianglesOfFace } from './geometry.js';
import { holeAt, holeAround } from './holes.js';
import { distanceToPoint, distanceToSegment } from './view.js';

// An edge or vertex is chosen if it is visible within this many CSS pixels of the pointer.
export const REACH = 8;

// Arrows of half-edges are drawn beside their edges. The arrow of a boundary half-edge is in the
// hole, so a boundary half-edge is also chosen if its edge is within this many CSS pixels.
export const HOLE_REACH = 20;

// Numbers for the kinds of elements in the id buffer, see shaders.js.
const TRIANGLE = 1;
const VERTEX = 2;

// Returns which elements a square of `size` x `size` pixels of the id buffer contains: {under,
// away, triangles, vertices}. `triangles` and `vertices` are lists of indices, sorted by distance
// from the middle of the square; `under` is the triangle nearest to the middle, or -1 if there is
// none, and `away` is its distance in pixels. `ids` has four numbers for each pixel: kind, id, 0,
// 0.
export function readSquare(ids, size) {
    const radius = (size - 1) / 2;
    const found = [];
    for (let i = 0; i < size * size; i++) {
        if (ids[4 * i] !== 0) {
            const dx = (i % size) - radius;
            const dy = Math.floor(i / size) - radius;
            found.push({ kind: ids[4 * i], id: ids[4 * i + 1], away: dx * dx + dy * dy });
        }
    }
    found.sort((a, b) => a.away - b.away);
    const unique = (kind) => [
        ...new Set(found.filter((one) => one.kind === kind).map(({ id }) => id)),
    ];
    const nearestOne = found.find(({ kind }) => kind === TRIANGLE);
    return {
        under: nearestOne?.id ?? -1,
        away: Math.sqrt(nearestOne?.away ?? Infinity),
        triangles: unique(TRIANGLE),
        vertices: unique(VERTEX),
    };
}

// Returns the element to pick at the pointer: {kind: 'face', id}, {kind: 'vertex', id}, {kind:
// 'edge', from, to} or {kind: 'halfedge', from, to}, or null if there is none. `mode` is the kind
// that may be picked, `seen` a result of readSquare(), and `screen` {matrix, width, height, x, y}:
// the camera's matrix, and the size of the canvas and the place of the pointer in CSS pixels. For
// half-edges, `seen` must reach HOLE_REACH, and `screen` has in addition `boundary`, the boundary
// half-edges of the mesh as in Content, and `look(x, y)`, which returns what readSquare() sees at
// another place.
export function choose(mode, geometry, seen, screen) {
    if (mode === 'face') {
        return seen.under < 0
            ? null
            : { kind: 'face', id: faceOf(geometry.triangles, seen.under) };
    }
    if (mode === 'vertex') {
        return chooseVertex(geometry, seen, screen);
    }
    return mode === 'edge'
        ? chooseEdge(geometry, seen, screen)
        : chooseHalfedge(geometry, seen, screen);
}

function chooseEdge(geometry, seen, screen) {
    const distance = (edge) => pixelsTo(geometry, screen, edge);
    const [edge] =
        nearest(edgesOfTriangles(geometry.triangles, seen.triangles), distance, REACH) ??
        nearest(edgesUnder(geometry, seen), distance, Infinity) ?? [];
    return edge === undefined ? null : { kind: 'edge', from: edge[0], to: edge[1] };
}

function pixelsTo(geometry, { matrix, width, height, x, y }, [from, to]) {
    const ends = [pointAt(geometry, from), pointAt(geometry, to)];
    return distanceToSegment(matrix, width, height, ...ends, x, y);
}

// If the pointer is in a hole and near the hole's rim, chooses the boundary half-edge there,
// whatever is visible through the hole. Else, if a face is under the pointer, chooses its half-edge
// on the edge nearest to the pointer; but if the face is seen from behind through a hole, and none
// of its edges is near, the nearest half-edge of the hole. If the pointer is beside the surface,
// chooses from the nearest visible edge the half-edge on the side of the pointer, which usually is
// a boundary half-edge.
function chooseHalfedge(geometry, seen, screen) {
    const near = chooseNear(geometry, seen, screen);
    const hole = holeAt(geometry, seen, screen);
    if (hole !== null && hole.distance <= Math.min(HOLE_REACH, near?.distance ?? Infinity)) {
        return { kind: 'halfedge', from: hole.from, to: hole.to };
    }
    if (seen.under < 0 || seen.away > 0) {
        const edge = near ?? (seen.away <= REACH ? chooseEdge(geometry, seen, screen) : null);
        return edge && { kind: 'halfedge', from: edge.to, to: edge.from };
    }
    const around = near === null ? holeAround(geometry, seen, screen) : null;
    if (around !== null) {
        return { kind: 'halfedge', ...around };
    }
    const face = trianglesOfFace(geometry, faceOf(geometry.triangles, seen.under));
    const edge = chooseEdge(geometry, { under: seen.under, triangles: face }, screen);
    return edge && { ...edge, kind: 'halfedge' };
}

// Returns the visible edge that is nearest to the pointer, as {from, to, distance}, or null if none
// is within REACH.
function chooseNear(geometry, seen, screen) {
    const edges = edgesOfTriangles(geometry.triangles, seen.triangles);
    const found = nearest(edges, (edge) => pixelsTo(geometry, screen, edge), REACH);
    return found && { from: found[0][0], to: found[0][1], distance: found[1] };
}

function chooseVertex(geometry, seen, screen) {
    const distance = (vertex) =>
        distanceToPoint(
            screen.matrix,
            screen.width,
            screen.height,
            pointAt(geometry, vertex),
            screen.x,
            screen.y,
        );
    const corners = edgesUnder(geometry, seen).map(([from]) => from);
    const [vertex] =
        nearest(seen.vertices, distance, Infinity) ?? nearest(corners, distance, Infinity) ?? [];
    return vertex === undefined ? null : { kind: 'vertex', id: vertex };
}

function edgesUnder(geometry, seen) {
    if (seen.under < 0) {
        return [];
    }
    const { triangles } = geometry;
    return edgesOfTriangles(triangles, trianglesOfFace(geometry, faceOf(triangles, seen.under)));
}

// Returns the candidate nearest to the pointer and its distance, [candidate, pixels], or null if
// none is within `reach`.
function nearest(candidates, distance, reach) {
    let best = null;
    for (const candidate of candidates) {
        const pixels = distance(candidate);
        if (pixels <= reach && Number.isFinite(pixels) && (best === null || pixels < best[1])) {
            best = [candidate, pixels];
        }
    }
    return best;
}
