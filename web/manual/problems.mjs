// problems.mjs - for each code of a problem: its cure, and requests of which the last one is refused
// with this code. `when` says when a problem occurs that no single request can show.
//
// `mesh` names meshes of meshes.mjs that are made first; `steps` may be a function of functions that
// find the elements of the last one. With `flags` the requests are sent to a daemon of their own with
// these options; with `token`, to one that needs tokens, where TOKEN stands for a token of this role.

const edit = (mesh, body) => ({ method: 'POST', path: `/v1/meshes/try-${mesh}/edits`, body });
const create = (body, query = '') => ({ method: 'POST', path: `/v1/meshes${query}`, body });
const put = (id, body, more = {}) => ({ method: 'PUT', path: `/v1/meshes/${id}`, body, ...more });
const get = (path, headers) => ({ path, ...(headers && { headers }) });
const post = (path, body, headers) => ({ method: 'POST', path, body, ...(headers && { headers }) });

// Returns a row whose example is one edit of a mesh.
const refused = (mesh, body, cure) => ({
    mesh,
    cure,
    steps: (m) => [edit([mesh].flat().at(-1), typeof body === 'function' ? body(m) : body)],
});

// Returns a row whose example is the creation of a mesh from a document.
const wrongMesh = (vertices, faces, cure) => ({ cure, steps: [create({ vertices, faces })] });

const mark = (domain, name, ids) => ({
    method: 'PUT',
    path: `/v1/meshes/try-patch/attributes/${domain}/${name}`,
    body: { type: 'bool', values: Array.from({ length: domain === 'edges' ? 19 : 10 }, (_, i) => ids.includes(i)) },
});

const POINTS = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1]];

export const PROBLEMS = {
    // --- resources ---
    no_memory: { cure: 'Try again later, or with a smaller request. The administrator can give the machine more memory.', when: 'The machine has no memory left.' },
    ids_exhausted: { cure: 'Send the operation `compact`, which gives all elements new ids without gaps.', when: 'A mesh has issued some four thousand million ids.' },
    limit_exceeded: { cure: 'Divide the request into several smaller ones; the detail says how much is allowed.', mesh: 'cube', steps: [edit('cube', { op: 'subdivide', steps: 12 }), edit('cube', { op: 'subdivide', steps: 6 }), edit('cube', { op: 'subdivide', steps: 6 }), edit('cube', { op: 'subdivide', steps: 6 })] },
    cancelled: { cure: 'Send the request again if it was cancelled by mistake. Nothing was changed.', when: 'A client has sent `DELETE /v1/jobs/{job}` while the job was running.' },

    // --- wrong input ---
    syntax: { cure: 'Open the file at the line or byte that the detail names. Often the file was cut off while it was copied, or its name has the wrong extension.', steps: [{ method: 'POST', path: '/v1/meshes?format=off', headers: { 'Content-Type': 'model/x-off' }, body: 'OFF\n3 1 0\n0 0 zero\n' }] },
    bad_value: refused('kite', { op: 'edge_split', edge: 2, t: 2 }, 'Use a value in the range that the detail gives. `GET /v1/operations` has the range of every parameter.'),
    not_finite: { cure: 'Find the place where your program divides by zero, or where a number becomes too large for a double.', mesh: 'kite', steps: [edit('kite', { op: 'vertex_move', vertex: 0, by: [1e308, 0, 0] }), edit('kite', { op: 'vertex_move', vertex: 0, by: [1e308, 0, 0] })] },
    bad_index: wrongMesh(POINTS.slice(0, 3), [[0, 1, 3]], 'Count vertices from 0. Formats such as OBJ count from 1, so an index that was copied from there is one too large.'),
    unsupported: { cure: 'Export the file again without this feature; the detail says which it is and often which command helps.', steps: [{ method: 'POST', path: '/v1/meshes?format=gltf', headers: { 'Content-Type': 'model/gltf+json' }, body: '{"asset":{"version":"2.0"},"extensionsRequired":["KHR_draco_mesh_compression"],"meshes":[]}' }] },
    beyond_float: { cure: 'Scale the mesh down with `transform`, or export as OBJ, OFF, PLY in text, or JSON.', mesh: 'kite', steps: [edit('kite', { op: 'vertex_move', vertex: 0, to: [1e300, 0, 0] }), get('/v1/meshes/try-kite/content?format=stl')] },
    corrupt: { cure: 'Report it, with the answer of `GET /v1/meshes/{mesh}/check`: this is an error in the server. Undo, or an earlier revision, still has the mesh as it was.', when: 'The server itself has made an error. No request should ever get this answer.' },

    // --- wrong elements ---
    no_such_element: refused('kite', { op: 'edge_split', edge: 99 }, 'List the elements (`GET /v1/meshes/{mesh}/edges`) and use an id from there. Ids of a file and ids of a mesh may differ.'),
    deleted_element: { cure: 'Read what your edit made, in `created` of its answer, instead of keeping old ids. After an undo, the id is valid again.', mesh: 'kite', steps: [edit('kite', { op: 'face_delete', face: 0 }), edit('kite', { op: 'face_delete', face: 0 })] },
    repeated_element: refused('kite', { op: 'face_delete', faces: [0, 0] }, 'Remove the repetition: a list of elements is a set. A list for each of whose elements an operation runs is refused with [repeated](/docs/problems/repeated) instead.'),

    // --- shapes that are no mesh ---
    too_few_corners: wrongMesh(POINTS, [[0, 1, 2], [0, 2]], 'Leave out faces with two corners, or add `repair=drop_degenerate`.'),
    not_triangle: refused('sheet', { op: 'decimate', faces: 4 }, 'Send the operation `triangulate` first, in the same list.'),
    repeated_corner: wrongMesh(POINTS, [[0, 1, 2, 1]], 'Give each corner a vertex of its own, or add `repair=drop_degenerate` if the face has no area.'),
    nonmanifold_edge: wrongMesh([...POINTS, [0, -1, 0]], [[0, 1, 2], [1, 0, 4], [0, 1, 5]], 'Add `repair=split`: the third face gets an edge of its own, in the same place.'),
    orientation: wrongMesh(POINTS, [[0, 1, 2], [0, 3, 2]].map((face, i) => (i === 0 ? face : [3, 0, 2].reverse())), 'Add `repair=orient`: the server then reverses faces until neighbours agree.'),
    not_orientable: {
        cure: 'Add `repair=orient,split`: the server orients what it can, and cuts the strip where it cannot.',
        steps: [create({
            vertices: [[1, 0, 0], [2, 0, 0], [-0.5, 0.9, -0.3], [-1, 1.7, 0.3], [-0.5, -0.9, 0.3], [-1, -1.7, -0.3]],
            faces: [[0, 1, 3, 2], [2, 3, 5, 4], [4, 5, 0, 1]],
        }, '?repair=orient')],
    },
    doubled_edge: {
        cure: 'Choose other elements; two vertices can have only one edge between them. With a file, `repair=split` divides one of the vertices.',
        mesh: 'tetrahedron',
        steps: (m) => [
            edit('tetrahedron', { op: 'face_poke', face: m.face(0, 2, 3) }),
            edit('tetrahedron', { op: 'face_poke', face: m.face(1, 2, 3) }),
            edit('tetrahedron', { op: 'edge_flip', edge: m.edge(0, 1) }),
        ],
    },
    closed_fan: wrongMesh(
        [[0, 0, 0], [1, 0, 1], [0, 1, 1], [-1, -1, 1], [1, 0, -1], [0, 1, -1], [-1, -1, -1]],
        [[0, 1, 2], [0, 2, 3], [0, 3, 1], [0, 5, 4], [0, 6, 5], [0, 4, 6]],
        'Add `repair=split`: each fan of faces then gets a vertex of its own.',
    ),

    // --- refusals of edits ---
    boundary_edge: refused('kite', { op: 'edge_flip', edge: 0 }, 'Choose an edge with a face on each side. `GET .../edges/{id}` has `"boundary":true` for the others.'),
    not_boundary: refused('sheet', (m) => ({ op: 'hole_fill', halfedge: m.halfedge(5, 6) }), 'Choose an element of a hole: a half-edge whose `face` is null. `GET .../boundaries` lists one of each hole.'),
    interior_vertex: refused('patch', { op: 'face_add', vertices: [0, 3, 5] }, 'Choose vertices on the boundary. A vertex that is surrounded by faces has no room for another one.'),
    boundary_vertex: refused('patch', { op: 'vertex_dissolve', vertex: 2 }, 'Choose a vertex inside the surface, or use `vertex_delete`.'),
    bowtie: refused('bowtie', { op: 'vertex_split', vertex: 2, left: 1, right: 0, to: [0, 0, 0] }, 'Send `vertex_separate` first: each fan of faces then has a vertex of its own.'),
    not_neighbour: refused('patch', { op: 'vertex_split', vertex: 0, left: 6, right: 9, to: [0, 0, 0] }, 'Use two vertices that an edge joins to it: `GET .../vertices/{id}/vertices`.'),
    no_sector: refused('patch', { op: 'vertex_split', vertex: 2, left: 9, right: 3, to: [-2, 0, 0] }, 'Exchange `left` and `right`, or choose neighbours with a face between them.'),
    not_a_corner: refused('sheet', (m) => ({ op: 'face_split', face: m.face(5, 6, 10, 9), from: 5, to: 0 }), 'Use corners of this face: `GET .../faces/{id}/vertices`.'),
    same_corner: refused('sheet', (m) => ({ op: 'face_split', face: m.face(5, 6, 10, 9), from: 5, to: 5 }), 'Name two different corners.'),
    different_origins: refused('sheet', (m) => ({ op: 'vertex_split_corners', a: m.halfedge(5, 6), b: m.halfedge(6, 5) }), 'Name two half-edges with the same `origin`: `GET .../vertices/{id}/outgoing`.'),
    no_face: refused('bowtie', (m) => ({ op: 'vertex_split_corners', a: m.halfedge(2, 0), b: m.halfedge(2, 3) }), 'Choose corners of which at least one is in a face.'),
    adjacent_corners: refused('sheet', (m) => ({ op: 'face_split', face: m.face(5, 6, 10, 9), from: 5, to: 6 }), 'Choose two corners that are not neighbours: they already have an edge.'),
    shared_boundary: { cure: 'Join the other edge first, or remove the vertex between the two with `edge_join`.', mesh: 'sheet', steps: (m) => [edit('sheet', { op: 'edge_bisect', edge: m.edge(5, 6) }), edit('sheet', { op: 'face_join', edge: m.edge(5, 6) })] },
    wrong_degree: refused('sheet', { op: 'edge_join', vertex: 5 }, 'Choose a vertex with exactly two edges, or use `vertex_dissolve`.'),
    triangle_side: { cure: 'Use `vertex_delete` or `edge_collapse`: a triangle cannot lose a corner and stay a face.', mesh: 'kite', steps: [edit('kite', { op: 'edge_join', vertex: 1 })] },
    low_degree: { cure: 'Use `edge_join` to remove the vertex of degree two first.', mesh: 'sheet', steps: (m) => [edit('sheet', { op: 'edge_bisect', edge: m.edge(5, 6) }), edit('sheet', { op: 'edge_bevel', edge: m.edge(5, 6), width: 0.1 })] },
    same_ends: { cure: 'Choose another edge. This one lies inside a vertex of degree two of both faces.', when: 'An edge is flipped whose two faces surround a vertex with only two edges.' },
    link_condition: refused('tetrahedron', (m) => ({ op: 'edge_collapse', halfedge: m.halfedge(0, 1) }), 'Choose another edge. This one is on a cycle of three edges that is not a face, or the mesh is too small to lose more.'),
    branching_chain: refused('bowtie', (m) => ({ op: 'edge_extrude', edges: [m.edge(1, 2), m.edge(2, 3), m.edge(0, 2), m.edge(2, 4)], by: [0, 0, 1] }), 'Extrude one chain at a time, or separate the bow-tie with `vertex_separate`.'),
    same_loop: refused('frame', (m) => ({ op: 'loop_bridge', a: m.hole(5, 6), b: m.hole(9, 10) }), 'Name half-edges of two different holes.'),
    shared_vertex: refused('sheet', (m) => ({ op: 'loop_join', a: m.halfedge(5, 6), b: m.halfedge(9, 10) }), 'Choose loops that do not touch, or move them apart first.'),
    loop_length: { cure: 'Make the numbers equal with `edge_bisect`, or use `loop_bridge`, which takes any numbers.', mesh: 'cubes', steps: (m) => [edit('cubes', { op: 'edge_bisect', edge: m.edge(1, 2) }), edit('cubes', { op: 'loop_join', a: m.halfedge(1, 2), b: m.halfedge(11, 8) })] },
    open_loop: { cure: 'Close the holes first with `fill_holes`, or cut without `cap`.', mesh: 'cube', steps: [edit('cube', { op: 'face_delete', face: 2 }), edit('cube', { op: 'plane_cut', point: [0, 0, 0], normal: [0, 0, 1], keep: 'below', cap: true })] },
    not_a_cycle: refused('nested', (m) => ({ op: 'loop_split', a: m.edge(3, 4), b: m.edge(4, 5), c: m.edge(6, 7) }), 'Name three edges that lead from vertex to vertex and back: each shares an end with the next.'),
    shared_face: refused('tetrahedron', (m) => ({ op: 'loop_split', a: m.edge(0, 1), b: m.edge(1, 2), c: m.edge(2, 0) }), 'Choose a cycle that is not the outline of a face.'),
    isolated_vertex: { cure: 'Send `delete_isolated` first.', mesh: 'cube', steps: [edit('cube', { op: 'vertex_add', position: [3, 0, 0] }), edit('cube', { op: 'dual' })] },
    no_rim: refused('tetrahedron', { op: 'face_extrude', faces: [0, 1, 2, 3], distance: 1, region: true }, 'Leave out at least one face, or move the whole component with `transform`.'),
    rim_meets_itself: refused('sheet', { op: 'face_extrude', faces: [1, 2, 5, 8, 7, 6, 3], distance: 1, region: true }, 'Add a face at the vertex that the problem names, or take one away there.'),
    no_faces: refused(['points', 'kite'], { op: 'deviation', with: 'try-points' }, 'Measure against a mesh that has faces.'),
    no_normal: { cure: 'Use `by` with a vector instead of `distance`, or remove the face without area first.', mesh: 'kite', steps: (m) => [edit('kite', { op: 'vertex_move', vertex: 1, to: [0.5, 0.5, 0] }), edit('kite', { op: 'face_extrude', face: m.face(0, 1, 2), distance: 1 })] },
    no_such_attribute: refused('kite', { op: 'select', by: 'attribute', attribute: 'heat', elements: 'faces', from: 0 }, 'List the attributes: `GET .../attributes`. Names are case-sensitive.'),
    attribute_clash: { cure: 'Delete or rename one of the two attributes, or choose another name with `into`.', mesh: 'kite', steps: [{ method: 'PUT', path: '/v1/meshes/try-kite/attributes/faces/patch', body: { type: 'double' } }, edit('kite', { op: 'segment', angle: 0.5 })] },
    feature_edge: { cure: 'Set the attribute `feature` of the edge to false if the line need not be kept.', mesh: 'patch', steps: (m) => [mark('edges', 'feature', [m.edge(0, 1)]), edit('patch', { op: 'edge_flip', edge: m.edge(0, 1) })] },
    locked_element: { cure: 'Set the attribute `locked` of the element to false, or leave the element out.', mesh: 'patch', steps: [mark('vertices', 'locked', [0]), edit('patch', { op: 'vertex_move', vertex: 0, by: [0, 0, 1] })] },

    // --- the body ---
    malformed_json: { cure: 'Check the byte that the detail names. A comma after the last member and single quotes are the most frequent causes.', steps: [create('{"shape":"cube",}')] },
    unknown_member: { cure: 'Compare the spelling with the page of the operation or route. The detail often names the member that was probably meant.', steps: [create({ shape: 'cube', sise: 2 })] },
    duplicate_member: { cure: 'Leave one of the two.', steps: [create('{"shape":"cube","shape":"torus"}')] },
    missing_member: refused('kite', { op: 'edge_split' }, 'Add the member that the detail names.'),
    wrong_type: refused('kite', { op: 'edge_split', edge: 'two' }, 'Write numbers without quotes, points as lists of three numbers, and flags as true or false.'),
    unexpected_body: { cure: 'Send the request without a body. Perhaps POST was meant instead of GET.', mesh: 'kite', steps: [{ method: 'DELETE', path: '/v1/meshes/try-kite', body: { sure: true } }] },
    missing_body: { cure: 'Send a body with the header Content-Type: application/json.', steps: [{ method: 'POST', path: '/v1/meshes' }] },
    unknown_operation: refused('kite', { op: 'split_edge', edge: 2 }, 'Use a name of [the list of operations](/docs/operations). The object comes first: edge_split.'),
    conflicting_members: refused('kite', { op: 'face_delete', face: 0, faces: [1] }, 'Keep the one that you mean.'),
    bad_reference: refused('kite', { ops: [{ op: 'face_poke', face: 0 }, { op: 'vertex_move', vertex: '$peak.vertex', by: [0, 0, 1] }] }, 'Give the earlier operation the member `"as":"peak"`, and check the name of the result on its page.'),
    repeated: refused('kite', { op: 'edge_split', edges: [2, 4, 2] }, 'Name each element once. To split an edge into many parts, split the parts that the first split made. A list of elements that an operation treats together is refused with [repeated_element](/docs/problems/repeated_element) instead.'),
    repeated_name: refused('kite', { ops: [{ op: 'face_poke', face: 0, as: 'a' }, { op: 'face_poke', face: 1, as: 'a' }] }, 'Give each operation of the list another name.'),

    // --- the request line and its headers ---
    bad_path: { cure: 'Percent-encode mesh ids and attribute names once, not twice, and as UTF-8.', steps: [get('/v1/meshes/%zz')] },
    bad_query: { cure: 'Percent-encode the values of the query.', steps: [get('/v1/meshes?limit=%zz')] },
    unknown_parameter: { cure: 'Compare with the parameters of the route. Names are never ignored, so that a misspelt one is found.', steps: [get('/v1/meshes?limt=2')] },
    repeated_parameter: { cure: 'Give each parameter once. A list is one parameter with commas: `repair=weld,fill`.', steps: [get('/v1/meshes?limit=2&limit=3')] },
    bad_parameter: { cure: 'Use a value of the type and range that the page of the route gives.', steps: [get('/v1/meshes?limit=many')] },
    bad_cursor: { cure: 'Begin again without `cursor`, and then pass on the member `next` unchanged.', steps: [get('/v1/meshes?cursor=abc')] },
    bad_header: { cure: 'Correct the header that the detail names.', mesh: 'kite', steps: [{ method: 'POST', path: '/v1/meshes/try-kite/edits', headers: { 'Idempotency-Key': ' ' }, body: { op: 'face_poke', face: 0 } }] },
    bad_id: { cure: 'Choose an id of letters, digits, dot, underscore and hyphen. Use the name of the mesh for other text.', steps: [put('my%20mesh', { shape: 'cube' })] },
    reserved_name: { cure: 'Read positions with `GET .../vertices`, and change them with `vertex_move` or `transform`. Choose another name for your own values.', mesh: 'kite', steps: [{ method: 'DELETE', path: '/v1/meshes/try-kite/attributes/vertices/position' }] },
    bad_framing: { cure: 'Let your HTTP library set Content-Length and Transfer-Encoding. A proxy between client and server may also have changed the request.', steps: [{ method: 'POST', path: '/v1/meshes', headers: { 'Content-Type': 'application/json', 'Content-Length': 'two' } }], when: 'A message has two lengths, or a length that is no number. No HTTP library sends such a message.' },
    bad_encoding: { cure: 'Send the body as the header Content-Encoding says, or leave out the header.', steps: [{ method: 'POST', path: '/v1/meshes', headers: { 'Content-Type': 'application/json', 'Content-Encoding': 'gzip' }, body: '{"shape":"cube"}' }] },
    bad_multipart: { cure: 'Let your HTTP library build the form: `curl -F file=@part.gltf`, `FormData` in JavaScript.', steps: [{ method: 'POST', path: '/v1/meshes', headers: { 'Content-Type': 'multipart/form-data; boundary=x' }, body: '--x\r\nno header' }] },
    unauthorized: { cure: 'Send the header `Authorization: Bearer TOKEN`. The administrator makes tokens with `hedged --new-token NAME ROLE`.', token: 'read', steps: [get('/v1/meshes')] },
    forbidden: { cure: 'Use a token with the role that the member `role` names.', token: 'read', steps: [{ method: 'POST', path: '/v1/meshes', headers: { Authorization: 'Bearer TOKEN' }, body: { shape: 'cube' } }] },
    prefix: { cure: 'Begin the id with one of the prefixes of the token, which `GET /v1/token` lists, or let the server choose the id.', token: 'write prefix=team-', steps: [{ method: 'PUT', path: '/v1/meshes/mine', headers: { Authorization: 'Bearer TOKEN' }, body: { shape: 'cube' } }] },
    foreign_origin: { cure: 'Start the server with `--allow-origin https://your.site`, or send the request from your own server.', steps: [{ method: 'POST', path: '/v1/meshes', headers: { Origin: 'https://elsewhere.example' }, body: { shape: 'cube' } }] },
    no_such_route: { cure: 'Compare the path with [the list of routes](/docs/routes). Paths begin with /v1.', steps: [get('/v1/mesh')] },
    no_such_mesh: { cure: 'List the meshes with `GET /v1/meshes`. With tokens, a mesh that the token may not see gives the same answer.', steps: [get('/v1/meshes/try-nothing')] },
    no_such_job: { cure: 'Read the result of a job within an hour after it has ended.', steps: [get('/v1/jobs/try-nothing')] },
    no_such_result: { cure: 'Read the job: its member `state` or `problem` says what happened.', when: 'A job has failed or was cancelled, and its result is read.' },
    no_such_revision: { cure: 'Use a revision up to the present one, which `GET /v1/meshes/{mesh}` shows.', mesh: 'kite', steps: [get('/v1/meshes/try-kite/vertices?revision=99')] },
    method_not_allowed: { cure: 'Use one of the methods in the header Allow.', steps: [{ method: 'PATCH', path: '/v1/meshes', body: {} }] },
    not_acceptable: { cure: 'Leave out the header Accept, or name one of the types in `supported`.', steps: [get('/v1/meshes', { Accept: 'text/csv' })] },
    timeout: { cure: 'Send the body faster, or compress it. A connection that sends nothing for a while is closed.', when: 'The client stops sending in the middle of a request.' },
    mesh_exists: { cure: 'Choose another id, or replace the mesh with PUT.', mesh: 'kite', steps: [create({ shape: 'cube' }, '?id=try-kite')] },
    nothing_to_undo: { cure: 'Nothing is wrong: the mesh is as it was when it was created or replaced. `GET .../edits` shows how many steps there are.', mesh: 'kite', steps: [post('/v1/meshes/try-kite/undo')] },
    nothing_to_redo: { cure: 'Nothing is wrong. A new edit after an undo clears what could be redone.', mesh: 'kite', steps: [post('/v1/meshes/try-kite/redo')] },
    unreachable_revision: { cure: 'Read the revision with `?revision=`, and put it back with `POST .../copy` or PUT.', mesh: 'kite', steps: [edit('kite', { op: 'face_poke', face: 0 }), post('/v1/meshes/try-kite/undo'), edit('kite', { op: 'face_poke', face: 1 }), post('/v1/meshes/try-kite/undo', { to_revision: 2 })] },
    mesh_busy: { cure: 'Wait Retry-After seconds and send the request again. Reading is possible all the time.', when: 'Another client has begun a long operation on the same mesh, such as decimating a million faces.' },
    idempotency_in_progress: { cure: 'Wait Retry-After seconds and repeat the request with the same key: you then get the answer of the first one.', when: 'A request is repeated with its Idempotency-Key before the first one is answered.' },
    client_taken: { cure: 'Choose another id for the client, at random, and keep it while the page is open.', when: 'Two clients with different tokens show themselves at one mesh under the same id.' },
    backup_kept: { cure: 'Fetch the earlier backup from its job, and then delete this job.', when: 'A second backup is asked for while the first is still kept.' },
    nothing_kept: { cure: 'Start the server with `--store sqlite:DIR` if meshes should be kept.', steps: [post('/v1/admin/backup')] },
    reload_failed: { cure: 'Correct the line that the detail names, and reload again. Until then the previous tokens are valid.', when: 'The file of tokens has a wrong line while the server runs.' },
    revision_gone: { cure: 'Read the mesh at its present revision. `--undo-budget` says how far back the history reaches.', flags: ['--undo-budget', '0'], mesh: 'kite', steps: [edit('kite', { op: 'face_poke', face: 0 }), get('/v1/meshes/try-kite/vertices?revision=1')] },
    stale_revision: { cure: 'Another client was faster. Read the mesh again, decide whether the edit still makes sense, and send it with the new revision.', mesh: 'kite', steps: [edit('kite', { op: 'face_poke', face: 0 }), edit('kite', { op: 'face_poke', face: 1, expected_revision: 1 })] },
    precondition_failed: { cure: 'Leave out If-None-Match to replace the mesh, or choose another id.', mesh: 'kite', steps: [put('try-kite', { shape: 'cube' }, { headers: { 'If-None-Match': '*' } })] },
    body_too_large: { cure: 'Compress the body with gzip or zstd, send arrays of bytes instead of JSON, or ask the administrator for a larger `--max-upload`.', flags: ['--max-upload', '1K'], steps: [create({ vertices: Array.from({ length: 40 }, (_, i) => [i / 7, i / 3, 0.123456789]), faces: [] })] },
    uri_too_long: { cure: 'Use `POST .../query`, which takes its lists in the body.', steps: [get(`/v1/meshes?contains=${'long-'.repeat(1700)}`)] },
    unsupported_media_type: { cure: 'Use one of the types in `supported`. For JSON: `Content-Type: application/json`.', steps: [{ method: 'POST', path: '/v1/meshes', headers: { 'Content-Type': 'text/csv' }, body: '0,0,0' }] },
    unsupported_encoding: { cure: 'Use gzip or zstd, or send the body uncompressed.', steps: [{ method: 'POST', path: '/v1/meshes', headers: { 'Content-Type': 'application/json', 'Content-Encoding': 'br' }, body: '{"shape":"cube"}' }] },
    wrong_host: { cure: 'Start the server with `--allow-host NAME` for the name by which clients call it.', steps: [get('/v1/meshes', { Host: 'meshes.example' })] },
    headers_too_large: { cure: 'Send fewer or shorter headers. Cookies of other pages of the same host are a frequent cause.', steps: [get('/v1/meshes', { Cookie: 'a'.repeat(20000) })] },
    idempotency_mismatch: { cure: 'Make a new key for each new request, and repeat a key only with an identical request.', mesh: 'kite', steps: [
        { method: 'POST', path: '/v1/meshes/try-kite/edits', headers: { 'Idempotency-Key': 'first' }, body: { op: 'face_poke', face: 0 } },
        { method: 'POST', path: '/v1/meshes/try-kite/edits', headers: { 'Idempotency-Key': 'first' }, body: { op: 'face_poke', face: 1 } },
    ] },
    unclear_parts: { cure: 'Send one mesh file with the files that it refers to. With several, choose one by `?format=`.', steps: [{ method: 'POST', path: '/v1/meshes', headers: { 'Content-Type': 'multipart/form-data; boundary=x' }, body: '--x\r\nContent-Disposition: form-data; name="f"; filename="notes.txt"\r\n\r\nhello\r\n--x--\r\n' }] },
    rate_limit: { cure: 'Wait Retry-After seconds. Put many questions into one `POST .../query` and many edits into one list.', flags: ['--address-requests', '1', '--limit-burst', '1'], steps: [get('/v1/meshes'), get('/v1/meshes'), get('/v1/meshes')] },
    too_many_connections: { cure: 'Keep connections open and use them again, instead of opening one for each request.', when: 'A client has more connections than `--address-connections` allows.' },
    too_many_jobs_of_token: { cure: 'Wait for one of your jobs, or cancel one with `DELETE /v1/jobs/{job}`.', when: 'A token has more jobs than `--token-jobs` allows.' },

    // --- the server ---
    internal: { cure: 'Report it with the `request_id`, which the log of the server has, too.', when: 'The server itself has made an error. No request should ever get this answer.' },
    mesh_damaged: { cure: 'Restore a backup (`hedged --restore`), or replace the mesh by PUT.', when: 'The disk has returned other bytes than were written.' },
    mesh_newer: { cure: 'Start the newer release again, or restore a backup of this release.', when: 'A newer release of hedged has used the same folder.' },
    not_implemented: { cure: 'Use a method of the list of routes, and the transfer coding chunked or none.', steps: [{ method: 'POST', path: '/v1/meshes', headers: { 'Content-Type': 'application/json', 'Transfer-Encoding': 'gzip, chunked' }, body: '{"shape":"cube"}' }] },
    not_ready: { cure: 'Wait until `GET /readyz` is answered 200.', when: 'The server is just starting or stopping.' },
    overloaded: { cure: 'Wait Retry-After seconds. The administrator can raise `--max-connections`.', when: 'More clients are connected than the server allows.' },
    too_many_coded_bodies: { cure: 'Send the body uncompressed, or wait Retry-After seconds.', when: 'Many large compressed bodies arrive at once.' },
    read_timeout: { cure: 'Add the header `Prefer: respond-async`: the request then becomes a job, which has no limit.', when: 'A question to a very large mesh takes longer than `--read-seconds`.' },
    too_many_jobs: { cure: 'Wait Retry-After seconds. The administrator can raise `--job-queue`.', when: 'More jobs are waiting than the server allows.' },
    too_many_present: { cure: 'Wait Retry-After seconds. A client that stops showing itself is forgotten after half a minute.', when: 'More clients show themselves at a mesh, or at all meshes, than the server allows.' },
    too_many_tickets: { cure: 'Use each ticket at once. One that is not used is forgotten after a minute.', when: 'Many tickets were made and not used.' },
    loading: { cure: 'Wait Retry-After seconds: the mesh is being read, and the next request finds it in memory.', when: 'A very large mesh that was not used for long is read from the disk.' },
    store_behind: { cure: 'Wait Retry-After seconds. Combine many small edits into lists.', when: 'Edits arrive faster than the disk can write them.' },
    store_lost: { cure: 'Send the request again: the answer then shows what was really saved.', when: 'The disk fails while another client changes the same mesh.' },
    store_failed: { cure: 'The administrator must look at the disk and start the server again. Everything that was acknowledged before is there.', when: 'A write or an fsync of the disk fails.' },
    interrupted: { cure: 'Send the request again; nothing was changed.', when: 'The server is stopped while a job is running.' },
    backup_failed: { cure: 'Make room on the disk, and ask for the backup again.', when: 'The disk has no room for a copy of the store.' },
    version_not_supported: { cure: 'Speak HTTP/1.1. A proxy can translate from HTTP/2.', when: 'A client speaks another version of HTTP without asking first.' },
    store_full: { cure: 'Delete meshes, or give the disk more room; then send the request again.', when: 'The disk is full.' },
    memory_budget: { cure: 'Delete meshes that are not needed, use a smaller mesh, or ask the administrator for a larger `--memory-budget`.', flags: ['--memory-budget', '64M'], steps: [create({ shape: 'grid', columns: 1000, rows: 1000 })] },
    quota: { cure: 'Delete a mesh that this token has created, or make one smaller.', token: 'write', flags: ['--token-meshes', '1'], steps: [
        { method: 'POST', path: '/v1/meshes', headers: { Authorization: 'Bearer TOKEN' }, body: { shape: 'cube' } },
        { method: 'POST', path: '/v1/meshes', headers: { Authorization: 'Bearer TOKEN' }, body: { shape: 'torus' } },
    ] },
    too_many_meshes: { cure: 'Delete a mesh, or ask the administrator for a larger `--max-meshes`.', flags: ['--max-meshes', '1'], steps: [create({ shape: 'cube' }), create({ shape: 'torus' })] },
};
