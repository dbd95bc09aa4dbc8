// vectors.js - sums and products of vectors, lists of numbers of which most have three. Pure.

// Returns a + factor * b.
export const add = (a, b, factor = 1) => a.map((value, i) => value + factor * b[i]);
export const subtract = (a, b) => a.map((value, i) => value - b[i]);
export const scale = (a, factor) => a.map((value) => value * factor);
export const dot = (a, b) => a.reduce((sum, value, i) => sum + value * b[i], 0);
export const length = (a) => Math.hypot(...a);

export function cross(a, b) {
    return [0, 1, 2].map((i) => {
        const [u, v] = [(i + 1) % 3, (i + 2) % 3];
        return a[u] * b[v] - a[v] * b[u];
    });
}

// Returns the vector of length 1 with the direction of `a`, or null if `a` has none.
export function unit(a) {
    const size = length(a);
    return size > 0 ? a.map((value) => value / size) : null;
}

// Returns the angle between two vectors, 0 to pi; null if one of them has no direction. The arc tangent
// is exact for small angles, too, where the arc cosine is not.
export function angleBetween(a, b) {
    // Both vectors are scaled so that their longest component is 1, because products could overflow.
    const [u, v] = [a, b].map((one) => {
        const longest = Math.max(...one.map(Math.abs));
        return one.map((value) => value / longest);
    });
    const angle = Math.atan2(length(cross(u, v)), dot(u, v));
    return Number.isNaN(angle) ? null : angle;
}
