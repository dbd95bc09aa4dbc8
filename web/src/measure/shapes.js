// shapes.js - computes lengths, angles and circles from points [x, y, z]. Pure.

import { add, angleBetween, cross, dot, subtract } from '../geometry/vectors.js';

export function distance(a, b) {
    return Math.hypot(...subtract(a, b));
}

export function middle(points) {
    return [0, 1, 2].map((i) => points.reduce((sum, p) => sum + p[i], 0) / points.length);
}

// Returns the angle at the point `at` between two other points; null if one of them is `at`.
export function angleAt(from, at, to) {
    return angleBetween(subtract(from, at), subtract(to, at));
}

// Returns the circle through three points, {center, radius, axes}, where `axes` are two vectors of
// length 1 in its plane; null if the points are on a line.
export function circleThrough(a, b, c) {
    const [u, v] = [subtract(b, a), subtract(c, a)];
    const normal = cross(u, v);
    const square = dot(normal, normal);
    const longest = Math.max(dot(u, u), dot(v, v));
    if (!(square > 1e-24 * longest * longest)) {
        return null;
    }
    // The centre is where the planes that halve both sides meet, in the plane of the points.
    const toCenter = cross(
        subtract(v.map((x) => x * dot(u, u)), u.map((x) => x * dot(v, v))),
        normal,
    ).map((x) => x / (2 * square));
    const radius = Math.hypot(...toCenter);
    const first = toCenter.map((x) => -x / radius);
    const up = normal.map((x) => x / Math.sqrt(square));
    return { center: add(a, toCenter, 1), radius, axes: [first, cross(up, first)] };
}

// Returns points on a circle, the first one again at the end.
export function pointsOf({ center, radius, axes }, count) {
    return Array.from({ length: count + 1 }, (_, i) => {
        const angle = (2 * Math.PI * i) / count;
        return add(
            add(center, axes[0], radius * Math.cos(angle)),
            axes[1],
            radius * Math.sin(angle),
        );
    });
}

// Returns a line through some points as pairs of its neighbours: [a, b, b, c, ...].
export function pairsOf(points) {
    return points.slice(1).flatMap((point, i) => [points[i], point]);
}
