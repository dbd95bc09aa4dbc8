/* topology.c - GET .../boundaries and GET .../components: the boundary loops and the components of
 * the whole mesh. */
#include "api/request/handlers.h"

#include "api/read/records.h"
#include "mesh/walk.h"
#include "query/topology.h"
#include "query/traverse.h"

/* --- GET .../boundaries --- */

/* The values of the JSON members of a boundary loop. */
typedef struct shown_loop {
    const he_mesh *mesh;
    he_boundary loop;
    const he_ids *halfedges;
} shown_loop;

static void write_halfedges(api_out *out, const void *value)
{
    const he_ids *halfedges = ((const shown_loop *)value)->halfedges;
    api_out_ids(out, halfedges->ids, halfedges->count);
}

static void write_origins(api_out *out, const void *value)
{
    const shown_loop *shown = value;
    api_out_array_begin(out);
    for (size_t i = 0; i < shown->halfedges->count; i++) {
        api_out_id(out, he_origin(shown->mesh, (he_halfedge){shown->halfedges->ids[i]}).i);
    }
    api_out_array_end(out);
}

static const api_field loop_fields[] = {
    API_FIELD("halfedge", "id", shown_loop, loop.halfedge, .required = true),
    API_FIELD("length", "count", shown_loop, loop.length, .required = true,
              .doc = "The number of half-edges."),
    API_FIELD_MADE("halfedges", "*id", write_halfedges, .required = true),
    API_FIELD_MADE("vertices", "*id", write_origins, .required = true,
                   .doc = "Origins of the half-edges."),
};
const api_record api_loop_record = API_RECORD("loop", loop_fields);

/* The boundary loops of a mesh, from which the JSON members of an answer are written. */
typedef struct shown_boundaries {
    uint64_t revision;
    const he_mesh *mesh;
    const he_boundaries *found;
    he_error *err; /* gets the reason if there is no memory for the half-edges of a loop */
} shown_boundaries;

static void write_loops(api_out *out, const void *value)
{
    const shown_boundaries *shown = value;
    he_ids halfedges = {0};
    he_status status = HE_OK;
    api_out_array_begin(out);
    for (size_t i = 0; i < shown->found->count && status == HE_OK; i++) {
        const shown_loop loop = {shown->mesh, shown->found->loops[i], &halfedges};
        halfedges.count = 0;
        status = he_traverse_loop(shown->mesh, (he_halfedge){loop.loop.halfedge}, &halfedges,
                                  shown->err);
        if (status == HE_OK) {
            api_record_write(out, &api_loop_record, &loop);
        }
    }
    api_out_array_end(out);
    he_ids_clear(&halfedges);
}

static const api_field boundaries_fields[] = {
    API_FIELD("revision", "count", shown_boundaries, revision, .required = true),
    API_FIELD_MADE("loops", "*#loop", write_loops, .required = true),
};
const api_record api_boundaries_record = API_RECORD("boundaries", boundaries_fields);

void api_boundaries_get(api_exchange *x)
{
    he_boundaries found = {0};
    he_error err = {0};
    if (he_boundaries_find(x->content, &found, &err) == HE_OK) {
        const shown_boundaries shown = {x->info.revision, x->content, &found, &err};
        api_record_write(&x->out, &api_boundaries_record, &shown);
    }
    he_boundaries_clear(&found);
    if (err.status == HE_OK) {
        api_answer_json(x, 200);
    } else {
        api_fail_core(x, &err);
    }
}

/* --- GET .../components --- */

static const api_field component_fields[] = {
    API_FIELD("faces", "count", he_component, faces, .required = true),
    API_FIELD("vertices", "count", he_component, vertices, .required = true),
    API_FIELD("face", "id", he_component, face, .required = true,
              .doc = "The id of a face of the component."),
};
const api_record api_component_record = API_RECORD("component", component_fields);

/* The components of a mesh, from which the JSON members of an answer are written. */
typedef struct shown_components {
    uint64_t revision;
    const char *by;
    const he_components *found;
} shown_components;

static void write_components(api_out *out, const void *value)
{
    const he_components *found = ((const shown_components *)value)->found;
    api_out_array_begin(out);
    for (size_t i = 0; i < found->count; i++) {
        api_record_write(out, &api_component_record, &found->components[i]);
    }
    api_out_array_end(out);
}

static const api_field components_fields[] = {
    API_FIELD("revision", "count", shown_components, revision, .required = true),
    API_FIELD("by", "#connection", shown_components, by, .required = true),
    API_FIELD_MADE("components", "*#component", write_components, .required = true),
};
const api_record api_components_record = API_RECORD("components", components_fields);

void api_components_get(api_exchange *x)
{
    const bool by_vertex = api_param_has_choice(x, "by", "vertex");
    he_components found = {0};
    he_error err = {0};
    if (he_components_find(x->content, by_vertex ? HE_JOINED_BY_VERTEX : HE_JOINED_BY_EDGE, &found,
                           &err) != HE_OK) {
        api_fail_core(x, &err);
        return;
    }
    api_record_write(&x->out, &api_components_record,
                     &(shown_components){x->info.revision, by_vertex ? "vertex" : "edge", &found});
    he_components_clear(&found);
    api_answer_json(x, 200);
}
