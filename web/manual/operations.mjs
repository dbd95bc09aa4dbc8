// operations.mjs - an example of each operation, from which its page is made: the mesh, what is done
// to it, and what the reader should know.
//
// `request` gets functions that find the id of an element by the vertices at its ends or corners, and
// returns the body of POST /v1/meshes/{mesh}/edits. `view` is "top" for meshes in the plane z = 0.
// `before` are edits that prepare the mesh. `use` says when the operation is needed.

const top = (mesh, use, request, more = {}) => ({ mesh, use, request, view: 'top', before: [], ...more });
const solid = (mesh, use, request, more = {}) => top(mesh, use, request, { view: 'solid', ...more });

export const OPERATIONS = {
    vertex_add: top(
        'kite',
        'The vertex has no edges yet. `face_add` connects it. Use both to build a mesh vertex by vertex and face by face.',
        () => ({ op: 'vertex_add', position: [1.5, 0.5, 0] }),
    ),
    vertex_move: top(
        'sheet',
        '`to` gives places, `by` gives vectors: one for all the vertices, or a list with one for each. Only positions change, never links.',
        () => ({ op: 'vertex_move', vertices: [5, 6], by: [0, 0.4, 0] }),
    ),
    vertex_delete: top(
        'sheet',
        'Vertices that have no face left are deleted, too, unless `keep_isolated` is true.',
        () => ({ op: 'vertex_delete', vertex: 5 }),
    ),
    vertex_split: top(
        'patch',
        'The edges between `left` and `right`, counted counter-clockwise, move to the new vertex. A progressive mesh stores a list of these.',
        () => ({ op: 'vertex_split', vertex: 0, left: 3, right: 9, to: [-0.9, 0, 0] }),
    ),
    vertex_dissolve: top(
        'patch',
        'The faces around the vertex become one polygon. Use it to remove detail without a hole.',
        () => ({ op: 'vertex_dissolve', vertex: 0 }),
    ),
    vertex_split_corners: top(
        'sheet',
        'Both half-edges leave the vertex. The new edge divides the corners to their right, and no face is added. `a`, and the half-edges that follow it counter-clockwise up to `b`, get the new vertex as origin.',
        (m) => ({ op: 'vertex_split_corners', a: m.halfedge(5, 6), b: m.halfedge(5, 4) }),
        { after: (answer) => [{ op: 'vertex_move', vertex: answer.results[0].vertex, by: [0, 0.35, 0] }] },
    ),
    vertex_bevel: top(
        'sheet',
        '`width` is the distance from the old vertex along each edge.',
        () => ({ op: 'vertex_bevel', vertex: 5, width: 0.35 }),
    ),
    edge_bisect: top(
        'sheet',
        'The faces beside the edge get one corner more. `edge_split` also cuts these faces.',
        (m) => ({ op: 'edge_bisect', edge: m.edge(5, 6), t: 0.5 }),
    ),
    edge_join: top(
        'sheet',
        'The inverse of `edge_bisect`. The vertex must have exactly two edges, as at the corner of a sheet.',
        () => ({ op: 'edge_join', vertex: 0 }),
    ),
    edge_split: top(
        'patch',
        'This is how a triangle mesh is refined at one place: every face stays a triangle. `t` places the new vertex, 0.5 in the middle.',
        (m) => ({ op: 'edge_split', edge: m.edge(0, 1) }),
    ),
    edge_flip: top(
        'patch',
        'Flips improve triangles without moving a vertex. Four flips of the same edge bring back the mesh as it was.',
        (m) => ({ op: 'edge_flip', edge: m.edge(0, 1) }),
    ),
    edge_collapse: top(
        'patch',
        'The target of the half-edge stays and its origin goes. `t` places the vertex that stays: 0 is the origin, 1 the target, and the middle is the default. All simplification is made of this.',
        (m) => ({ op: 'edge_collapse', halfedge: m.halfedge(0, 1) }),
    ),
    edge_bevel: top(
        'sheet',
        'The edge becomes a face of this `width`, as if it were cut off with a chisel.',
        (m) => ({ op: 'edge_bevel', edge: m.edge(5, 6), width: 0.4 }),
    ),
    edge_delete: top(
        'sheet',
        'The faces beside the edges go, too. To keep the surface closed, use `face_join`.',
        (m) => ({ op: 'edge_delete', edge: m.edge(5, 6) }),
    ),
    edge_cut: top(
        'sheet',
        'Both sides of the cut become boundaries, and vertices along the cut are doubled where the surface comes apart.',
        (m) => ({ op: 'edge_cut', edges: [m.edge(1, 5), m.edge(5, 9)] }),
        { after: (answer) => answer.results[0].vertices.map((vertex) => ({ op: 'vertex_move', vertex, by: [0.2, 0, 0] })) },
    ),
    edge_weld: top(
        'gap',
        'The ends of the two edges are merged, and the edges become one. `keep` says whose positions stay; otherwise it is the middle.',
        (m) => ({ op: 'edge_weld', a: m.edge(1, 2), b: m.edge(4, 7) }),
    ),
    edge_extrude: top(
        'kite',
        'Only boundary edges can be extruded. A chain of edges gives a connected strip.',
        (m) => ({ op: 'edge_extrude', edges: [m.edge(0, 1), m.edge(1, 2)], by: [0.5, -0.5, 0] }),
    ),
    face_add: top(
        'pair',
        'The corners are counted counter-clockwise, seen from outside. Edges that exist are used, others are made.',
        () => ({ op: 'face_add', vertices: [1, 4, 7, 2] }),
    ),
    face_delete: top(
        'sheet',
        'A face inside the surface leaves a hole, whose half-edges form a boundary loop.',
        (m) => ({ op: 'face_delete', face: m.face(5, 6, 10, 9) }),
    ),
    face_split: top(
        'sheet',
        'The two corners must not be neighbours. If a vertex is twice in a face, name the corners by their half-edges.',
        (m) => ({ op: 'face_split', face: m.face(5, 6, 10, 9), from: 5, to: 10 }),
    ),
    face_join: top(
        'sheet',
        'The face of half-edge 2e keeps its id, where e is the edge.',
        (m) => ({ op: 'face_join', edge: m.edge(5, 6) }),
    ),
    face_poke: top(
        'sheet',
        'The new vertex is at the mean of the corners, or at `position`.',
        (m) => ({ op: 'face_poke', face: m.face(5, 6, 10, 9) }),
    ),
    face_triangulate: top(
        'sheet',
        'Renderers and many algorithms need triangles. `triangulate` does this for the whole mesh.',
        (m) => ({ op: 'face_triangulate', faces: [m.face(0, 1, 5, 4), m.face(5, 6, 10, 9)] }),
    ),
    face_extrude: solid(
        'cube',
        '`distance` moves along the normals, `by` along one vector. With `region` the faces move together, without walls between them.',
        (m) => ({ op: 'face_extrude', face: m.highest(), distance: 0.6 }),
    ),
    face_inset: top(
        'sheet',
        '`factor` moves each corner by this fraction towards the middle of the face. Follow it with `face_extrude` to press a recess into a surface.',
        (m) => ({ op: 'face_inset', face: m.face(5, 6, 10, 9), factor: 0.4 }),
    ),
    face_collapse: top(
        'sheet',
        'The faces around it lose a corner each; triangles among them go.',
        (m) => ({ op: 'face_collapse', face: m.face(5, 6, 10, 9) }),
    ),
    loop_bridge: top(
        'pair',
        'Name one half-edge of each hole; the strip begins there.',
        (m) => ({ op: 'loop_bridge', a: m.halfedge(2, 1), b: m.halfedge(4, 7) }),
    ),
    loop_join: solid(
        'cubes',
        'The two faces go, and the solids become one. Both loops need the same number of edges.',
        (m) => ({ op: 'loop_join', a: m.halfedge(1, 2), b: m.halfedge(11, 8) }),
    ),
    loop_split: top(
        'nested',
        'The mesh is cut along a closed path of three edges, and each side gets a triangle as a lid.',
        (m) => ({ op: 'loop_split', a: m.edge(3, 4), b: m.edge(4, 5), c: m.edge(5, 3) }),
        { after: (answer) => answer.results[0].vertices.map((vertex) => ({ op: 'vertex_move', vertex, by: [0, 0, 1.5] })), view: 'solid' },
    ),
    transform: top(
        'sheet',
        'The matrix has 16 numbers, row by row; the last row is 0 0 0 1. Without `vertices` the whole mesh moves.',
        () => ({
            op: 'transform',
            matrix: [0.707, -0.707, 0, 1.5, 0.707, 0.707, 0, -0.621, 0, 0, 1, 0, 0, 0, 0, 1],
            vertices: [5, 6, 9, 10],
        }),
    ),
    plane_split: top(
        'sheet',
        'Nothing moves and no surface is lost: only new vertices and edges along the plane. Vertices within `tolerance` of the plane count as on it.',
        () => ({ op: 'plane_split', point: [1.5, 1.5, 0], normal: [1, 0.35, 0] }),
    ),
    plane_cut: solid(
        'ball',
        '`keep` chooses the side, and `cap` closes the cut with a face.',
        () => ({ op: 'plane_cut', point: [0, 0, 0.2], normal: [0, 0, 1], keep: 'below', cap: true }),
    ),
    delaunay: top(
        'long',
        'The result has no thin triangles that a flip could avoid. Vertices do not move.',
        () => ({ op: 'delaunay' }),
    ),
    compact: top(
        'frame',
        'Ids are never reused, so after many deletions they have gaps. The answer maps old ids to new ones. This clears the undo history.',
        () => ({ op: 'compact' }),
        { before: [{ op: 'vertex_delete', vertex: 0 }] },
    ),
    vertex_weld: top(
        'gap',
        'Give the vertices one by one, or a `tolerance` within which those that are listed are merged.',
        () => ({ op: 'vertex_weld', vertices: [1, 4], position: 'mean' }),
    ),
    vertex_separate: top(
        'bowtie',
        'A bow-tie is a vertex where two fans of faces touch. After this the fans are apart, but still in the same place.',
        () => ({ op: 'vertex_separate', vertex: 2 }),
        { after: (answer) => answer.results[0].vertices.map((vertex) => ({ op: 'vertex_move', vertex, by: [0.25, 0.25, 0] })) },
    ),
    weld: top(
        'gap',
        'Run this after importing an STL file or any file whose parts have vertices of their own.',
        () => ({ op: 'weld', tolerance: 0.1 }),
    ),
    separate_bowties: top(
        'bowtie',
        'Many programs cannot read bow-ties; this removes all of them.',
        () => ({ op: 'separate_bowties' }),
    ),
    delete_isolated: top(
        'kite',
        'Isolated vertices belong to no face; files from scanners often contain them.',
        () => ({ op: 'delete_isolated' }),
        { before: [{ op: 'vertex_add', position: [1.5, 0.5, 0] }] },
    ),
    triangulate: top(
        'sheet',
        'STL, GLB and most renderers hold triangles only. Exports do this by themselves; the mesh keeps its polygons.',
        () => ({ op: 'triangulate' }),
    ),
    reverse: top(
        'kite',
        'If a whole import is inside out, reverse it. To make neighbours agree, import with `repair=orient`.',
        () => ({ op: 'reverse' }),
    ),
    dual: solid(
        'cube',
        'The dual of a cube is an octahedron. The mesh must be closed.',
        () => ({ op: 'dual' }),
    ),
    append: top(
        'kite',
        'The other mesh is copied and gets new ids; the two do not touch until they are welded.',
        () => ({ op: 'append', mesh: 'try-gap' }),
        { needs: ['gap'] },
    ),
    subdivide: solid(
        'cube',
        'catmull_clark takes any faces, loop and sqrt3 triangles only, linear adds faces without moving the surface. Each step makes about four times as many faces.',
        () => ({ op: 'subdivide', scheme: 'catmull_clark', steps: 2 }),
    ),
    decimate: solid(
        'ball',
        'Give the number of `faces`, a `ratio`, or a `max_error` in units of the mesh. The answer says why it stopped and how far the surface moved.',
        () => ({ op: 'decimate', faces: 32 }),
    ),
    remesh: solid(
        'tetrahedron',
        'Simulations need triangles of even size. Feature edges, seams of `uv` and corners stay where they are.',
        () => ({ op: 'remesh', target_faces: 120, steps: 5 }),
    ),
    smooth: solid(
        'bumps',
        '`taubin` and `laplacian` remove bumps, `bilateral` removes noise but keeps sharp edges, `tangential` evens triangles out.',
        () => ({ op: 'smooth', method: 'taubin', steps: 8 }),
    ),
    hole_fill: top(
        'frame',
        'Name a half-edge of the hole: one without a face. The default method puts triangles of good shape into it.',
        (m) => ({ op: 'hole_fill', halfedge: m.hole(5, 6) }),
    ),
    fill_holes: top(
        'frame',
        'A 3D print needs a closed mesh. `max_edges` leaves larger holes, such as the outer boundary of an open surface.',
        () => ({ op: 'fill_holes', max_edges: 8 }),
    ),
    deform: solid(
        'sheet',
        'Pull some vertices to a place, hold others, and the rest of the surface follows as a sheet of rubber would.',
        () => ({ op: 'deform', vertices: [5], by: [0, 0, 0.9], fixed: [0, 3, 12, 15] }),
    ),
    material_set: top(
        'sheet',
        'Materials are written to GLB and OBJ files. Colours are linear, as in glTF.',
        (m) => ({ op: 'material_set', name: 'steel', metallic: 1, base_color: [0.5, 0.5, 0.6], faces: [m.face(5, 6, 10, 9)] }),
    ),
    material_delete: top(
        'sheet',
        'To merge two materials, delete one `to` the other.',
        () => ({ op: 'material_delete', name: 'steel' }),
        { before: [{ op: 'material_set', name: 'steel', faces: [4] }] },
    ),
    select: top(
        'sheet',
        'Other operations then take `{"selected":true}` in place of a list of ids. The set is an attribute, and edits keep it up to date.',
        () => ({ op: 'select', by: 'box', min: [0.5, 0.5, -1], max: [3, 3, 1], elements: 'faces' }),
        { select: true },
    ),
    segment: solid(
        'cube',
        'With an `angle`, patches end at sharp edges. With `planes`, they are as many flat pieces as you ask for.',
        () => ({ op: 'segment', angle: 0.5 }),
        { before: [{ op: 'subdivide', scheme: 'linear', steps: 1 }] },
    ),
    deviation: top(
        'kite',
        'What did a decimation cost? Measure against the mesh as it was before, kept as a copy.',
        () => ({ op: 'deviation', with: 'try-gap' }),
        { needs: ['gap'] },
    ),
};
