// places.js - where the findings of the check lens are: their places in the mesh, and the ball
// around them for the camera. Pure. The vertices are given by their ids in the arrays `geometry`.

import { hasVertex, pointAt, trianglesOfFace } from '../geometry/geometry.js';

// Returns the middle of the box around some vertices and the distance from there to the farthest,
// {center, radius}, in view coordinates; null if the arrays have none of the vertices.
export function ballAround(geometry, vertices) {
    const [low, high] = [[Infinity, Infinity, Infinity], [-Infinity, -Infinity, -Infinity]];
    const live = [...vertices].filter((id) => hasVertex(geometry, id));
    for (const id of live) {
        pointAt(geometry, id).forEach((value, axis) => {
            low[axis] = Math.min(low[axis], value);
            high[axis] = Math.max(high[axis], value);
        });
    }
    if (live.length === 0) {
        return null;
    }
    const center = low.map((value, axis) => (value + high[axis]) / 2);
    let radius = 0;
    for (const id of live) {
        const point = pointAt(geometry, id);
        radius = Math.max(radius, Math.hypot(...point.map((value, axis) => value - center[axis])));
    }
    return { center, radius };
}

// A coordinate smaller than this, in view coordinates, is 0 but for rounding: the arrays have floats.
const NOTHING = 1e-6;

// Returns the middle of some vertices in the mesh's own coordinates, or null.
export function placeOf(geometry, vertices) {
    const ball = ballAround(geometry, vertices);
    const { origin, scale } = geometry.frame;
    const inMesh = (value, axis) => {
        const place = value / scale + origin[axis];
        return Math.abs(place) * scale < NOTHING ? 0 : place;
    };
    return ball?.center.map(inMesh) ?? null;
}

// Returns the length of a closed line through some vertices in the mesh's own coordinates.
export function lengthOf(geometry, vertices) {
    let sum = 0;
    for (let i = 0; i < vertices.length; i++) {
        const ends = [vertices[i], vertices[(i + 1) % vertices.length]];
        const [from, to] = ends.map((id) => pointAt(geometry, id));
        sum += Math.hypot(...from.map((value, axis) => to[axis] - value));
    }
    return sum / geometry.frame.scale;
}

// Returns the unit normal of a polygon through some vertices, the mean over its corners after
// Newell, or null if it has none.
export function normalOf(geometry, vertices) {
    const normal = [0, 0, 0];
    for (let i = 0; i < vertices.length; i++) {
        const [a, b] = [vertices[i], vertices[(i + 1) % vertices.length]].map((id) =>
            pointAt(geometry, id),
        );
        for (let axis = 0; axis < 3; axis++) {
            const [u, v] = [(axis + 1) % 3, (axis + 2) % 3];
            normal[axis] += (a[u] - b[u]) * (a[v] + b[v]);
        }
    }
    const length = Math.hypot(...normal);
    return length > 0 ? normal.map((value) => value / length) : null;
}

// A polygon counts as flat if its corners are at most this part of its size from a plane.
const FLAT = 1e-3;

// Returns whether the polygon through some vertices is flat, so that one face can fill it well.
export function isFlat(geometry, vertices) {
    const normal = normalOf(geometry, vertices);
    const ball = ballAround(geometry, vertices);
    if (normal === null || ball === null) {
        return true;
    }
    const heights = vertices.map((id) =>
        pointAt(geometry, id).reduce((sum, value, axis) => sum + value * normal[axis], 0),
    );
    return Math.max(...heights) - Math.min(...heights) <= 2 * FLAT * ball.radius;
}

// Returns the ids of the corners of some faces.
export function cornersOf(geometry, faces) {
    const corners = new Set();
    for (const face of faces) {
        for (const triangle of trianglesOfFace(geometry, face)) {
            for (let i = 0; i < 3; i++) {
                corners.add(geometry.triangles[4 * triangle + i]);
            }
        }
    }
    return [...corners];
}
