// flips.js - finds the edges of a flat triangulation that are not Delaunay. Pure.

// Returns the operation that flips one edge which is not Delaunay, in a list, or null if there is
// none. `triangles` is {points, faces, edges}: `points` maps vertices to positions, `faces` maps faces
// to their three vertices, `edges` maps edges to {vertices, faces}. The z coordinates are not used.
export function nextFlip({ points, faces, edges }) {
    for (const [edge, { vertices, faces: beside }] of edges) {
        if (beside.some((face) => face === null)) {
            continue;
        }
        const [left, right] = beside.map((face) => faces.get(face));
        const far = right.find((vertex) => !vertices.includes(vertex));
        if (isInCircle(left.map((vertex) => points.get(vertex)), points.get(far))) {
            return [{ op: 'edge_flip', edge }];
        }
    }
    return null;
}

// Returns whether a point is inside of the circle through the corners of a triangle, which are
// counter-clockwise. A point that is on the circle but for rounding errors is not inside.
function isInCircle(corners, [x, y]) {
    const rows = corners.map(([u, v]) => [u - x, v - y, (u - x) ** 2 + (v - y) ** 2]);
    const [a, b, c] = rows;
    const determinant =
        a[0] * (b[1] * c[2] - b[2] * c[1]) -
        a[1] * (b[0] * c[2] - b[2] * c[0]) +
        a[2] * (b[0] * c[1] - b[1] * c[0]);
    const size = Math.max(...rows.flat().map(Math.abs));
    return determinant > 1e-9 * size ** 3;
}
