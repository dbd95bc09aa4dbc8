// routes.mjs - the example requests of the routes, by operationId.
//
// A route without a row is requested as it is, of the mesh "try-kite" and its element 0. `setup` are
// requests that are sent before; JOB stands for the job that one of them begins. `answer: false`: the
// page shows no answer, because it would be another one each time; `run: false`: readers cannot try
// the route, because it is a page, or would disturb other users of their server.

const post = (path, body) => ({ method: 'POST', path, body });
const kite = (path) => `/v1/meshes/try-kite${path}`;
const poke = post(kite('/edits'), { op: 'face_poke', face: 0 });
const weight = {
    method: 'PUT',
    path: kite('/attributes/faces/weight'),
    body: { type: 'double', values: [0.5, 2] },
};
const job = {
    method: 'PUT',
    path: '/v1/meshes/try-job',
    headers: { Prefer: 'respond-async' },
    body: { shape: 'torus', major_segments: 24, minor_segments: 12 },
};
const presence = { client: 'b7Qw', name: 'Ada', selection: { kind: 'face', ids: [0] } };
const page = { answer: false, run: false };
const task = { answer: false, run: false };

export const ROUTES = {
    list_meshes: { path: '/v1/meshes?contains=try&sort=name&limit=2', answer: false },
    create_mesh: { path: '/v1/meshes?id=try-box', body: { shape: 'cube', size: 2 } },
    update_mesh: { headers: { 'Content-Type': 'application/merge-patch+json' }, body: { name: 'My first mesh' } },
    replace_mesh: { mesh: 'kite', body: { shape: 'octahedron' } },
    export_mesh: { path: kite('/content?format=obj') },
    get_progressive_mesh: { mesh: 'ball' },
    copy_mesh: { body: { id: 'try-copy' } },
    list_materials: { setup: [post(kite('/edits'), { op: 'material_set', name: 'steel', metallic: 1, faces: [0] })] },
    list_attributes: { setup: [weight] },
    get_attribute: { path: kite('/attributes/faces/weight'), setup: [weight] },
    replace_attribute: { path: weight.path, body: weight.body },
    update_attribute: { path: weight.path, body: { ids: [1], values: [7] }, setup: [weight] },
    delete_attribute: { path: weight.path, setup: [weight] },
    query_mesh: {
        body: { queries: [{ relation: 'faces', of: { vertex: 0 } }, { measure: 'area', of: { faces: 'all' } }, { closest: [2, 0, 0] }] },
    },
    traverse_mesh: { mesh: 'patch', body: { walk: 'rings', from: { vertex: 0 }, depth: 2 } },
    compare_mesh: { setup: [post(kite('/edits'), { op: 'vertex_move', vertex: 0, by: [0, 0, 0.5] })], body: { with: 1, bound: 0.001 } },
    preview_deform: { mesh: 'sheet', body: { op: 'deform', vertices: [5], by: [0, 0, 1], fixed: [0, 3, 12, 15] } },
    apply_edits: { body: { op: 'edge_split', edge: 2, t: 0.5 } },
    list_edits: { setup: [poke] },
    name_revision: {
        path: kite('/edits/2'),
        headers: { 'Content-Type': 'application/merge-patch+json' },
        body: { name: 'with a peak' },
        setup: [poke],
    },
    put_presence: { body: presence },
    list_presences: { setup: [{ method: 'PUT', path: kite('/presence'), body: presence }] },
    undo_edits: { setup: [poke] },
    redo_edits: { setup: [poke, post(kite('/undo'))] },
    follow_mesh: { path: kite('/events?since=1'), setup: [poke], events: 1 },
    list_jobs: { setup: [job], answer: false },
    get_job: { setup: [job], answer: false },
    delete_job: { setup: [job], answer: false },
    get_job_result: { setup: [job], answer: false },
    follow_job: { setup: [job], events: 1, answer: false },
    create_ticket: { setup: [{ method: 'PUT', path: '/v1/meshes/try-kite', body: { shape: 'cube' } }], body: { path: kite('/content?format=obj') } },
    reload_tokens: task,
    back_up_store: task,
    list_operations: { answer: false },
    list_problems: { answer: false },
    get_openapi: { answer: false },
    get_metrics: { answer: false },
    get_problem: { path: '/problems/boundary_edge', ...page },
    get_viewer: page,
    get_docs: page,
    get_docs_page: { path: '/docs/operations/edge_split', ...page },
    get_asset: { path: '/assets/LICENSES.txt', ...page },
};
