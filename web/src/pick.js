// pick.js - from what the id buffer shows around the pointer to one element. Pure.
//
// The renderer says which triangles and vertices are visible near the pointer, nearest first (see
// Renderer.look). Kinds are never mixed: in edge mode only an edge can be picked, and so on. Near
// the pointer what is seen counts; else an edge or a corner of the face under the pointer does.

import { edgesOfTriangles, faceOf, trianglesOfFace } from './geometry.js';
import { distanceToPoint, distanceToSegment } from './view.js';

// CSS pixels around the pointer in which a visible edge or vertex is meant.
export const REACH = 8;

// Returns {kind: 'face', face}, {kind: 'edge', from, to} or {kind: 'vertex', vertex}, all of them
// slots, or null when there is nothing. `seen` is {under, triangles, vertices}; `screen` is
// {matrix, width, height, x, y} in CSS pixels.
export function choose(mode, geometry, seen, screen) {
    if (mode === 'face') {
        return seen.under < 0
            ? null
            : { kind: 'face', face: faceOf(geometry.triangles, seen.under) };
    }
    return mode === 'edge'
        ? chooseEdge(geometry, seen, screen)
        : chooseVertex(geometry, seen, screen);
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
    return vertex === undefined ? null : { kind: 'vertex', vertex };
}

function edgesUnder(geometry, seen) {
    if (seen.under < 0) {
        return [];
    }
    const { triangles } = geometry;
    return edgesOfTriangles(triangles, trianglesOfFace(triangles, faceOf(triangles, seen.under)));
}

function pointAt(geometry, slot) {
    return geometry.vertices.subarray(4 * slot, 4 * slot + 3);
}

// [candidate, distance] of the nearest within reach, or null.
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
