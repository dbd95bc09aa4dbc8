#include "api/edit_cost.h"

#include "api/limits.h"
#include "mesh/walk.h"

void api_edit_cost_clear(api_edit_cost *cost)
{
    for (int kind = 0; kind < HE_KIND_COUNT; kind++) {
        he_ids_clear(&cost->named[kind]);
    }
}

/* Beyond the most that a worker may look at it is enough to know that there are more. */
static he_status gather(api_edit_cost *cost, he_kind kind, uint32_t id, he_error *err)
{
    if (cost->count > API_COSTLY_ELEMENTS) {
        return HE_OK;
    }
    cost->count++;
    return he_ids_add(&cost->named[kind], id, err);
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
        if (param->type == HE_PARAM_ELEMENT) {
            status = gather(cost, param->kind, arg->id, err);
        } else if (param->type == HE_PARAM_ELEMENTS || param->type == HE_PARAM_CYCLE) {
            for (size_t j = 0; j < arg->count && status == HE_OK; j++) {
                status = gather(cost, param->kind, arg->ids[j], err);
            }
        }
    }
    return status;
}

/* Steps about the origin of `first`, or around its face or hole; at most `most`. */
static uint64_t steps(const he_mesh *mesh, he_halfedge first, bool turn, uint64_t most)
{
    he_halfedge h = first;
    uint64_t count = 0;
    do {
        h = turn ? he_turn_ccw(mesh, h) : he_next(mesh, h);
        count++;
    } while (h.i != first.i && count < most);
    return count;
}

/* A hole is as long as it likes beside an edge that is split; only what names one of its half-edges
 * goes around it. */
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

bool api_edit_cost_exceeds(const api_edit_cost *cost, const he_mesh *mesh, uint64_t most)
{
    uint64_t total = 0;
    if (cost->count > API_COSTLY_ELEMENTS) {
        return true;
    }
    for (he_kind kind = HE_VERTEX; kind <= HE_FACE; kind++) {
        const he_ids *named = &cost->named[kind];
        for (size_t i = 0; i < named->count && total <= most; i++) {
            uint32_t id = named->ids[i];
            if (id < he_mesh_issued(mesh, kind) && he_mesh_is_live(mesh, kind, id)) {
                total += about(mesh, kind, id, most + 1);
            }
        }
    }
    return total > most;
}
