/* topology.c - GET .../boundaries and GET .../components: the boundary loops and the components of
 * the whole mesh. */
#include "api/request/handlers.h"

#include "mesh/walk.h"
#include "query/topology.h"
#include "query/traverse.h"

/* Answers 200 with an object that has the member "revision" and those that `write` writes. */
static void answer(api_exchange *x, bool (*write)(api_exchange *x, const he_mesh *mesh))
{
    api_out_object_begin(&x->out);
    api_out_key_u64(&x->out, "revision", x->info.revision);
    if (write(x, x->content)) {
        api_out_object_end(&x->out);
        api_answer_json(x, 200);
    }
}

/* --- GET .../boundaries --- */

static void write_loop(api_out *out, const he_mesh *mesh, const he_boundary *loop,
                       const he_ids *halfedges)
{
    api_out_object_begin(out);
    api_out_key_id(out, "halfedge", loop->halfedge);
    api_out_key_u64(out, "length", loop->length);
    api_out_key_ids(out, "halfedges", halfedges->ids, halfedges->count);
    api_out_key(out, "vertices");
    api_out_array_begin(out);
    for (size_t i = 0; i < halfedges->count; i++) {
        api_out_id(out, he_origin(mesh, (he_halfedge){halfedges->ids[i]}).i);
    }
    api_out_array_end(out);
    api_out_object_end(out);
}

static bool write_boundaries(api_exchange *x, const he_mesh *mesh)
{
    he_boundaries boundaries = {0};
    he_ids halfedges = {0};
    he_error err = {0};
    he_status status = he_boundaries_find(mesh, &boundaries, &err);
    api_out_key(&x->out, "loops");
    api_out_array_begin(&x->out);
    for (size_t i = 0; i < boundaries.count && status == HE_OK; i++) {
        const he_boundary *loop = &boundaries.loops[i];
        halfedges.count = 0;
        status = he_traverse_loop(mesh, (he_halfedge){loop->halfedge}, &halfedges, &err);
        if (status == HE_OK) {
            write_loop(&x->out, mesh, loop, &halfedges);
        }
    }
    api_out_array_end(&x->out);
    he_ids_clear(&halfedges);
    he_boundaries_clear(&boundaries);
    return status == HE_OK || api_fail_core(x, &err);
}

void api_boundaries_get(api_exchange *x)
{
    answer(x, write_boundaries);
}

/* --- GET .../components --- */

static bool write_components(api_exchange *x, const he_mesh *mesh)
{
    bool by_vertex = api_param_has_choice(x, "by", "vertex");
    he_components found = {0};
    he_error err = {0};
    if (he_components_find(mesh, by_vertex ? HE_JOINED_BY_VERTEX : HE_JOINED_BY_EDGE, &found,
                           &err) != HE_OK) {
        return api_fail_core(x, &err);
    }
    api_out_key_string(&x->out, "by", by_vertex ? "vertex" : "edge");
    api_out_key(&x->out, "components");
    api_out_array_begin(&x->out);
    for (size_t i = 0; i < found.count; i++) {
        const he_component *component = &found.components[i];
        api_out_object_begin(&x->out);
        api_out_key_u64(&x->out, "faces", component->faces);
        api_out_key_u64(&x->out, "vertices", component->vertices);
        api_out_key_id(&x->out, "face", component->face);
        api_out_object_end(&x->out);
    }
    api_out_array_end(&x->out);
    he_components_clear(&found);
    return true;
}

void api_components_get(api_exchange *x)
{
    answer(x, write_components);
}
