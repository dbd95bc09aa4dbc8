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
