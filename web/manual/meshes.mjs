// meshes.mjs - the small meshes of the manual's examples, as bodies for PUT /v1/meshes/{mesh}. Each
// is served to the reader under the id "try-NAME".

// Returns a mesh in the plane z = 0.
const flat = (points, faces) => ({ vertices: points.map(([x, y]) => [x, y, 0]), faces });

const square = (x, y) => [[x, y], [x + 1, y], [x + 1, y + 1], [x, y + 1]];

// Vertex 4 y + x of the sheet lies at (x, y); face 3 y + x has this vertex at its lower left.
const sheet = () => {
    const columns = [0, 1, 2, 3];
    const points = columns.flatMap((y) => columns.map((x) => [x, y]));
    const faces = [0, 1, 2].flatMap((y) =>
        [0, 1, 2].map((x) => {
            const low = 4 * y + x;
            return [low, low + 1, low + 5, low + 4];
        }),
    );
    return flat(points, faces);
};

// Returns a surface of triangles over a square, with bumps.
const bumps = () => {
    const size = 9;
    const rows = Array.from({ length: size }, (_, i) => i);
    const vertices = rows.flatMap((y) => rows.map((x) => [x, y, ((7 * x + 5 * y * y) % 6) / 5]));
    const faces = rows.slice(1).flatMap((y) =>
        rows.slice(1).flatMap((x) => {
            const at = size * y + x;
            return [[at - size - 1, at - size, at], [at - size - 1, at, at - 1]];
        }),
    );
    return { vertices, faces };
};

// Returns a sheet whose middle face is missing.
const frame = () => {
    const { vertices, faces } = sheet();
    return { vertices, faces: faces.filter((_, i) => i !== 4) };
};

const cube = (x) =>
    [0, 1].flatMap((z) => [[x, 0, z], [x + 1, 0, z], [x + 1, 1, z], [x, 1, z]]);
const sides = (low) =>
    [[0, 3, 2, 1], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]].map(
        (corners) => corners.map((id) => low + id),
    );

const nested = (size) => [[-size, -size], [size, -size], [0, size]];

export const MESHES = {
    // Two triangles. Edge 2 is the diagonal.
    kite: flat(square(0, 0), [[0, 1, 2], [0, 2, 3]]),
    // A long diagonal, which a Delaunay triangulation would not have.
    long: flat([[-2, 0], [0, -0.7], [2, 0], [0, 0.7]], [[0, 1, 2], [0, 2, 3]]),
    sheet: sheet(),
    frame: frame(),
    // Two inner vertices, 0 and 1, in a ring of eight.
    patch: flat(
        [[-0.5, 0], [0.5, 0], [-1.5, 0], [-1, -0.9], [0, -0.95], [1, -0.9], [1.5, 0], [1, 0.9], [0, 0.95], [-1, 0.9]],
        [
            [0, 2, 3], [0, 3, 4], [0, 4, 1], [0, 1, 8], [0, 8, 9], [0, 9, 2],
            [1, 4, 5], [1, 5, 6], [1, 6, 7], [1, 7, 8],
        ],
    ),
    // Two squares side by side, with a gap as wide as they are.
    pair: flat([...square(0, 0), ...square(2, 0)], [[0, 1, 2, 3], [4, 5, 6, 7]]),
    // Two squares with a narrow gap.
    gap: flat([...square(0, 0), ...square(1.08, 0)], [[0, 1, 2, 3], [4, 5, 6, 7]]),
    // Two triangles that share only vertex 2.
    bowtie: flat([[0, 0], [1, 0], [1, 1], [2, 2], [1, 2]], [[0, 1, 2], [2, 3, 4]]),
    // Three triangles inside each other, with quads between them.
    nested: flat(
        [...nested(1), ...nested(2), ...nested(3)],
        [
            [0, 1, 2],
            ...[0, 3].flatMap((low) =>
                [0, 1, 2].map((i) => [low + 3 + i, low + 3 + ((i + 1) % 3), low + ((i + 1) % 3), low + i]),
            ),
        ],
    ),
    points: { vertices: [[0, 0, 1], [1, 0, 1], [0, 1, 1]], faces: [] },
    bumps: bumps(),
    cube: { shape: 'cube' },
    cubes: { vertices: [...cube(0), ...cube(2)], faces: [...sides(0), ...sides(8)] },
    ball: { shape: 'icosphere', subdivisions: 1 },
    torus: { shape: 'torus', major_segments: 12, minor_segments: 6 },
    tetrahedron: { shape: 'tetrahedron' },
};
