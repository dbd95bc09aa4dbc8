// pick.js - chooses one element from the contents of the id buffer around the pointer. Pure.
//
// The renderer reads which triangles and vertices are visible near the pointer. Kinds are never
// mixed: in edge mode only an edge can be picked, and so on. A visible edge or vertex near the
// pointer is chosen first, otherwise an edge or a corner of the face under the pointer.

import { edgesOfTriangles, faceOf, pointAt, trianglesOfFace } from './geometry.js';
import { distanceToPoint, distanceToSegment } from './view.js';

// A visible edge or vertex within this many CSS pixels of the pointer is chosen.
export const REACH = 8;

// Kinds in the id buffer, see shaders.js.
const TRIANGLE = 1;
const VERTEX = 2;

// Returns what a square of `size` x `size` pixels of the id buffer shows, nearest to its middle
// first: {under, away, triangles, vertices}, where `under` is the nearest triangle or -1 and `away`
// its distance in pixels. `ids` has kind, id, 0, 0 for each pixel.
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

// Returns {kind: 'face', id}, {kind: 'vertex', id}, {kind: 'edge', from, to} or {kind: 'halfedge',
// from, to}, or null if there is nothing. `seen` is {under, triangles, vertices}; `screen` is
// {matrix, width, height, x, y} in CSS pixels.
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
    const distance = ([from, to]) =>
        distanceToSegment(
            screen.matrix,
            screen.width,
            screen.height,
            pointAt(geometry, from),
            pointAt(geometry, to),
            screen.x,
            screen.y,
        );
    const [edge] =
        nearest(edgesOfTriangles(geometry.triangles, seen.triangles), distance, REACH) ??
        nearest(edgesUnder(geometry, seen), distance, Infinity) ?? [];
    return edge === undefined ? null : { kind: 'edge', from: edge[0], to: edge[1] };
}

// Chooses the half-edge of the face under the pointer on its nearest edge. Beside the surface,
// chooses the boundary half-edge of the nearest visible edge, or the half-edge of its other face.
function chooseHalfedge(geometry, seen, screen) {
    if (seen.under >= 0 && seen.away === 0) {
        const face = trianglesOfFace(geometry, faceOf(geometry.triangles, seen.under));
        const edge = chooseEdge(geometry, { under: seen.under, triangles: face }, screen);
        return edge && { ...edge, kind: 'halfedge' };
    }
    const edge = chooseEdge(geometry, seen, screen);
    return edge && { kind: 'halfedge', from: edge.to, to: edge.from };
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

// Returns [candidate, distance] of the nearest within reach, or null.
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
