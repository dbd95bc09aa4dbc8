// extent.js - the bounding box of a mesh, and the lines of a grid below it. Pure.

// Returns {low, high}, the corners of the bounding box of all vertices that are not deleted, in view
// coordinates; null if there are none.
export function boxOf({ vertices, vertexCount }) {
    const low = [Infinity, Infinity, Infinity];
    const high = [-Infinity, -Infinity, -Infinity];
    for (let i = 0; i < 4 * vertexCount; i += 4) {
        if (vertices[i + 3] !== 0) {
            for (let axis = 0; axis < 3; axis++) {
                low[axis] = Math.min(low[axis], vertices[i + axis]);
                high[axis] = Math.max(high[axis], vertices[i + axis]);
            }
        }
    }
    return low[0] > high[0] ? null : { low, high };
}

// Returns the corner of a box that has the high coordinate on those axes whose bit is set.
function cornerOf({ low, high }, bits) {
    return [0, 1, 2].map((axis) => ((bits >> axis) & 1 ? high : low)[axis]);
}

// Returns the four edges of a box that are parallel to an axis, each [from, to].
export function edgesAlong(box, axis) {
    const others = [0, 1, 2].filter((other) => other !== axis);
    return [0, 1, 2, 3].map((bits) => {
        const base = ((bits & 1) << others[0]) | ((bits >> 1) << others[1]);
        return [cornerOf(box, base), cornerOf(box, base | (1 << axis))];
    });
}

// Returns a round number, 1, 2 or 5 times a power of ten, that is at least `length`.
export function roundStep(length) {
    const power = 10 ** Math.floor(Math.log10(length));
    // Computed powers are not exact.
    const factor = [1, 2, 5, 10].find((one) => one * power >= length * (1 - 1e-9));
    return Number((factor * power).toPrecision(1));
}

// The grid has about this many squares along the longer side of the mesh.
const SQUARES = 10;

// Returns {step, lines} of the grid below a box: `step` is the distance of its lines in the
// coordinates of the mesh, a round number whose multiples have lines; `lines` are pairs of points in
// view coordinates. `frame` is that of the geometry.
export function gridBelow({ low, high }, { origin, scale }) {
    const longest = Math.max(high[0] - low[0], high[1] - low[1], 1e-9) / scale;
    const step = roundStep(longest / SQUARES);
    const toMesh = (value, axis) => value / scale + origin[axis];
    const toView = (value, axis) => (value - origin[axis]) * scale;
    const ends = [0, 1].map((axis) => {
        const first = Math.floor(toMesh(low[axis], axis) / step) - 1;
        const last = Math.ceil(toMesh(high[axis], axis) / step) + 1;
        return { first, count: last - first };
    });
    const z = low[2];
    const lines = [];
    ends.forEach(({ first, count }, axis) => {
        const other = ends[1 - axis];
        const [from, to] = [other.first, other.first + other.count].map((i) =>
            toView(i * step, 1 - axis),
        );
        for (let i = first; i <= first + count; i++) {
            const place = toView(i * step, axis);
            lines.push(
                axis === 0 ? [[place, from, z], [place, to, z]] : [[from, place, z], [to, place, z]],
            );
        }
    });
    return { step, lines };
}
