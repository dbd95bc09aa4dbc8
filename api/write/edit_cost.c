#include "api/write/edit_cost.h"

#include "api/limits.h"
#include "mesh/walk.h"

void api_edit_cost_clear(api_edit_cost *cost)
{
    for (int kind = 0; kind < HE_KIND_COUNT; kind++) {
        he_ids_clear(&cost->named[kind]);
        he_ids_clear(&cost->reached[kind]);
    }
}

/* Adds one id to the elements that an edit visits. Ids beyond API_COSTLY_ELEMENTS are not
 * collected: it is then known that the edit is too costly for a worker thread. */
static he_status gather(api_edit_cost *cost, const he_param *param, uint32_t id, he_error *err)
{
    he_ids *lists = (param->flags & HE_REACHES) != 0 ? cost->reached : cost->named;
    if (cost->count > API_COSTLY_ELEMENTS) {
        return HE_OK;
    }
    cost->count++;
    return he_ids_add(&lists[param->kind], id, err);
}

he_status api_edit_cost_add(api_edit_cost *cost, const api_call *call, he_error *err)
{
    he_status status = HE_OK;
    for (size_t i = 0; i < he_op_params(call->op) && status == HE_OK; i++) {
        const he_param *param = &call->op->params[i];
        const he_arg *arg = &call->args[i];
        if (!arg->given) {
            continue;
        }
        if (param->type == HE_PARAM_ELEMENT && !arg->list) {
            status = gather(cost, param, arg->id, err);
        } else if (param->type == HE_PARAM_ELEMENT || param->type == HE_PARAM_ELEMENTS ||
                   param->type == HE_PARAM_CYCLE) {
            for (size_t j = 0; j < arg->count && status == HE_OK; j++) {
                status = gather(cost, param, arg->ids[j], err);
            }
        }
    }
    return status;
}

/* Returns the number of half-edges around the origin of the half-edge `first` or, if `turn` is
 * false, around the face or hole of `first`; at most `most`. */
static uint64_t steps(const he_mesh *mesh, he_halfedge first, bool turn, uint64_t most)
{
    he_halfedge h = first;
    uint64_t count = 0;
    do {
        h = turn ? he_swing_ccw(mesh, h) : he_next(mesh, h);
        count++;
    } while (h.i != first.i && count < most);
    return count;
}

/* Returns the number of half-edges around both ends of an edge and around its faces. A hole beside
 * the edge is counted only if `holes` is true: operations that name an edge, such as edge_split, do
 * not walk around the hole, but operations that name a half-edge do. */
static uint64_t about_edge(const he_mesh *mesh, he_edge e, bool holes, uint64_t most)
{
    uint64_t count = 0;
    for (unsigned side = 0; side < 2; side++) {
        he_halfedge h = he_edge_halfedge(e, side);
        count += steps(mesh, h, true, most);
        if (holes || !he_is_boundary_halfedge(mesh, h)) {
            count += steps(mesh, h, false, most);
        }
    }
    return count;
}

static uint64_t about(const he_mesh *mesh, he_kind kind, uint32_t id, uint64_t most)
{
    switch (kind) {
    case HE_VERTEX:
        return he_is_isolated(mesh, (he_vertex){id})
                   ? 1
                   : steps(mesh, he_vertex_halfedge(mesh, (he_vertex){id}), true, most);
    case HE_HALFEDGE:
        return about_edge(mesh, he_edge_of((he_halfedge){id}), true, most);
    case HE_EDGE:
        return about_edge(mesh, (he_edge){id}, false, most);
    case HE_FACE:
        return steps(mesh, he_face_halfedge(mesh, (he_face){id}), false, most);
    case HE_MESH_KIND:
    case HE_KIND_COUNT:
        break;
    }
    return 0;
}

/* Returns the number of corners of all faces around a vertex, plus one for each hole there. */
static uint64_t about_faces_of(const he_mesh *mesh, he_vertex v, uint64_t most)
{
    he_halfedge first = he_vertex_halfedge(mesh, v), h = first;
    uint64_t count = 0;
    if (he_is_isolated(mesh, v)) {
        return 1;
    }
    do {
        count += he_is_boundary_halfedge(mesh, h) ? 1 : steps(mesh, h, false, most);
        h = he_swing_ccw(mesh, h);
    } while (h.i != first.i && count < most);
    return count;
}

/* Returns a sum over the vertices of a loop: of the number of edges at the vertex or, if `faces` is
 * true, of the number of corners of all faces around the vertex. */
static uint64_t along(const he_mesh *mesh, he_halfedge first, bool faces, uint64_t most)
{
    he_halfedge h = first;
    uint64_t count = 0;
    do {
        count +=
            faces ? about_faces_of(mesh, he_origin(mesh, h), most) : steps(mesh, h, true, most);
        h = he_next(mesh, h);
    } while (h.i != first.i && count < most);
    return count;
}

static uint64_t reach(const he_mesh *mesh, he_kind kind, uint32_t id, uint64_t most)
{
    uint64_t count = 0;
    switch (kind) {
    case HE_VERTEX:
        return about_faces_of(mesh, (he_vertex){id}, most);
    case HE_HALFEDGE:
        return along(mesh, (he_halfedge){id}, false, most) +
               reach(mesh, HE_EDGE, he_edge_of((he_halfedge){id}).i, most);
    case HE_EDGE:
        for (unsigned side = 0; side < 2; side++) {
            he_halfedge h = he_edge_halfedge((he_edge){id}, side);
            count += about_faces_of(mesh, he_origin(mesh, h), most);
            count += he_is_boundary_halfedge(mesh, h) ? 1 : along(mesh, h, false, most);
        }
        return count;
    case HE_FACE:
        return along(mesh, he_face_halfedge(mesh, (he_face){id}), true, most);
    case HE_MESH_KIND:
    case HE_KIND_COUNT:
        break;
    }
    return count;
}

/* Adds to `total` what the function `count` returns for each of `ids`, until the sum exceeds
 * `most`. Returns the sum. */
static uint64_t add_all(const he_mesh *mesh, he_kind kind, const he_ids *ids,
                        uint64_t (*count)(const he_mesh *mesh, he_kind kind, uint32_t id,
                                          uint64_t most),
                        uint64_t total, uint64_t most)
{
    for (size_t i = 0; i < ids->count && total <= most; i++) {
        uint32_t id = ids->ids[i];
        if (id < he_mesh_issued(mesh, kind) && he_mesh_is_live(mesh, kind, id)) {
            total += count(mesh, kind, id, most + 1);
        }
    }
    return total;
}

bool api_edit_cost_exceeds(const api_edit_cost *cost, const he_mesh *mesh, uint64_t most)
{
    uint64_t total = 0;
    if (cost->count > API_COSTLY_ELEMENTS) {
        return true;
    }
    for (he_kind kind = HE_VERTEX; kind <= HE_FACE; kind++) {
        total = add_all(mesh, kind, &cost->named[kind], about, total, most);
        total = add_all(mesh, kind, &cost->reached[kind], reach, total, most);
    }
    return total > most;
}

/* --- what the operations of a list are charged --- */

/* Vertices and faces with fewer half-edges are not kept in the cache (api_hubs). */
enum { HUB = 256 };

/* Returns what the function `steps` returns, and remembers high numbers of half-edges in a
 * cache. */
static uint64_t hub_steps(const he_mesh *mesh, he_halfedge first, bool turn, uint64_t most,
                          api_hubs *hubs)
{
    uint32_t id = turn ? he_origin(mesh, first).i : he_face_of(mesh, first).i;
    if (id >= HE_MAX_ROWS) {
        /* A hole has no id, so its number of half-edges is not cached. */
        return steps(mesh, first, turn, most);
    }
    uint32_t key = 2 * id + 2 + (turn ? 0 : 1);
    size_t slot = key / 2 % (sizeof hubs->slots / sizeof hubs->slots[0]);
    if (hubs->slots[slot].key == key && hubs->slots[slot].uses++ < API_HUB_USES) {
        return hubs->slots[slot].steps;
    }
    uint64_t count = steps(mesh, first, turn, most);
    if (count >= HUB) {
        hubs->slots[slot].key = key;
        hubs->slots[slot].uses = 0;
        hubs->slots[slot].steps = count;
    }
    return count;
}

static uint64_t walk_about_edge(const he_mesh *mesh, he_edge e, bool holes, uint64_t most,
                                api_hubs *hubs)
{
    uint64_t count = 0;
    for (unsigned side = 0; side < 2; side++) {
        he_halfedge h = he_edge_halfedge(e, side);
        count += hub_steps(mesh, h, true, most, hubs);
        if (holes || !he_is_boundary_halfedge(mesh, h)) {
            count += hub_steps(mesh, h, false, most, hubs);
        }
    }
    return count;
}

/* Returns the sum of the degrees of all vertices of the face of the half-edge `h`, except the
 * vertex where `h` begins. */
static uint64_t walk_about_corners(const he_mesh *mesh, he_halfedge h, uint64_t most,
                                   api_hubs *hubs)
{
    uint64_t count = 0;
    for (he_halfedge k = he_next(mesh, h); k.i != h.i && count < most; k = he_next(mesh, k)) {
        count += hub_steps(mesh, k, true, most, hubs);
    }
    return count;
}

/* How many steps are charged for sorting, comparing and relinking one face. */
enum { FACE_STEPS = 250 };

static uint64_t walk_about_faces(const he_mesh *mesh, he_vertex v, uint64_t most, api_hubs *hubs)
{
    he_halfedge first = he_vertex_halfedge(mesh, v), h = first;
    uint64_t count = 0;
    do {
        count += FACE_STEPS;
        count += he_is_boundary_halfedge(mesh, h) ? 0 : walk_about_corners(mesh, h, most, hubs);
        h = he_swing_ccw(mesh, h);
    } while (h.i != first.i && count < most);
    return count;
}

static uint64_t walk_about(const he_mesh *mesh, const he_param *param, uint32_t id, uint64_t most,
                           api_hubs *hubs)
{
    if (id >= he_mesh_issued(mesh, param->kind) || !he_mesh_is_live(mesh, param->kind, id)) {
        return 0;
    }
    switch (param->kind) {
    case HE_VERTEX:
        if (he_is_isolated(mesh, (he_vertex){id})) {
            return 1;
        }
        return (param->flags & HE_REACHES) != 0
                   ? walk_about_faces(mesh, (he_vertex){id}, most, hubs)
                   : hub_steps(mesh, he_vertex_halfedge(mesh, (he_vertex){id}), true, most, hubs);
    case HE_HALFEDGE:
        return walk_about_edge(mesh, he_edge_of((he_halfedge){id}), true, most, hubs);
    case HE_EDGE:
        return walk_about_edge(mesh, (he_edge){id}, false, most, hubs);
    case HE_FACE: {
        he_halfedge first = he_face_halfedge(mesh, (he_face){id});
        return (param->flags & HE_REACHES) != 0 ? hub_steps(mesh, first, true, most, hubs) +
                                                      walk_about_corners(mesh, first, most, hubs)
                                                : hub_steps(mesh, first, false, most, hubs);
    }
    case HE_MESH_KIND:
    case HE_KIND_COUNT:
        break;
    }
    return 0;
}

uint64_t api_edit_cost_steps(const api_call *call, const he_mesh *mesh, uint64_t most,
                             api_hubs *hubs)
{
    const bool runs_each = he_op_each(call->op, call->args) != NULL;
    const uint64_t runs = he_op_runs(call->op, call->args);
    uint64_t count = 0;
    for (size_t i = 0; i < he_op_params(call->op); i++) {
        const he_param *param = &call->op->params[i];
        const he_arg *arg = &call->args[i];
        if (!arg->given || (param->flags & HE_WALKS) == 0) {
            continue;
        }
        /* A value that is not in a list is the same in all runs. */
        const uint64_t times = arg->list ? 1 : runs;
        const uint32_t *ids = param->type == HE_PARAM_ELEMENT && !arg->list ? &arg->id : arg->ids;
        const size_t ids_count = param->type == HE_PARAM_ELEMENT && !arg->list ? 1 : arg->count;
        for (size_t j = 0; j < ids_count && count <= most; j++) {
            const uint64_t around = walk_about(mesh, param, ids[j], most, hubs);
            count += around <= most / (times > 0 ? times : 1) ? times * around : most + 1;
        }
    }
    if (runs_each) {
        return count;
    }
    /* An operation visits each half-edge only a few times, even if the half-edge is near many of
     * the elements that the operation names. */
    uint64_t all = 8 * (uint64_t)he_mesh_count(mesh, HE_HALFEDGE);
    return count < all ? count : all;
}
