#include "api/read/elements.h"

#include "api/json/attribute_value.h"
#include "api/request/handlers.h"
#include "geometry/geometry.h"
#include "mesh/walk.h"

#include <string.h>

uint32_t api_write_vertex(api_out *out, const he_mesh *mesh, he_vertex v)
{
    uint32_t degree = he_vertex_degree(mesh, v);
    api_out_object_begin(out);
    api_out_key_id(out, "id", v.i);
    api_out_key_vec3(out, "position", he_position(mesh, v));
    api_out_key_id(out, "halfedge", he_vertex_halfedge(mesh, v).i);
    api_out_key_u64(out, "degree", degree);
    api_out_key_bool(out, "boundary", he_is_boundary_vertex(mesh, v));
    api_out_key_bool(out, "isolated", he_is_isolated(mesh, v));
    uint32_t numbers = api_write_attributes(out, mesh, HE_VERTEX, v.i);
    api_out_object_end(out);
    return degree + numbers;
}

uint32_t api_write_halfedge(api_out *out, const he_mesh *mesh, he_halfedge h)
{
    api_out_object_begin(out);
    api_out_key_id(out, "id", h.i);
    api_out_key_id(out, "twin", he_twin(h).i);
    api_out_key_id(out, "next", he_next(mesh, h).i);
    api_out_key_id(out, "prev", he_prev(mesh, h).i);
    api_out_key_id(out, "origin", he_origin(mesh, h).i);
    api_out_key_id(out, "target", he_target(mesh, h).i);
    api_out_key_id(out, "edge", he_edge_of(h).i);
    api_out_key_id(out, "face", he_face_of(mesh, h).i);
    api_out_key_bool(out, "boundary", he_is_boundary_halfedge(mesh, h));
    uint32_t numbers = api_write_attributes(out, mesh, HE_HALFEDGE, h.i);
    api_out_object_end(out);
    return 1 + numbers;
}

uint32_t api_write_edge(api_out *out, const he_mesh *mesh, he_edge e)
{
    he_halfedge a = he_edge_halfedge(e, 0), b = he_edge_halfedge(e, 1);
    api_out_object_begin(out);
    api_out_key_id(out, "id", e.i);
    api_out_key_ids(out, "halfedges", (const uint32_t[]){a.i, b.i}, 2);
    api_out_key_ids(out, "vertices", (const uint32_t[]){he_origin(mesh, a).i, he_origin(mesh, b).i},
                    2);
    api_out_key(out, "faces");
    api_out_array_begin(out);
    api_out_id(out, he_face_of(mesh, a).i);
    api_out_id(out, he_face_of(mesh, b).i);
    api_out_array_end(out);
    api_out_key_number(out, "length", he_edge_length(mesh, e));
    api_out_key_bool(out, "boundary", he_is_boundary_edge(mesh, e));
    uint32_t numbers = api_write_attributes(out, mesh, HE_EDGE, e.i);
    api_out_object_end(out);
    return 2 + numbers;
}

uint32_t api_write_face(api_out *out, const he_mesh *mesh, he_face f)
{
    he_face_shape shape = he_face_measure(mesh, f);
    he_halfedge first = he_face_halfedge(mesh, f), h = first;
    api_out_object_begin(out);
    api_out_key_id(out, "id", f.i);
    api_out_key_id(out, "halfedge", first.i);
    api_out_key_u64(out, "degree", shape.degree);
    api_out_key(out, "vertices");
    api_out_array_begin(out);
    for (uint32_t i = 0; i < shape.degree; i++, h = he_next(mesh, h)) {
        api_out_id(out, he_origin(mesh, h).i);
    }
    api_out_array_end(out);
    api_out_key(out, "halfedges");
    api_out_array_begin(out);
    h = first;
    for (uint32_t i = 0; i < shape.degree; i++, h = he_next(mesh, h)) {
        api_out_id(out, h.i);
    }
    api_out_array_end(out);
    api_out_key_number(out, "area", shape.area);
    api_out_key_vec3(out, "normal", shape.normal);
    api_out_key_vec3(out, "centroid", shape.centroid);
    uint32_t numbers = api_write_attributes(out, mesh, HE_FACE, f.i);
    api_out_object_end(out);
    return shape.degree + numbers;
}

uint32_t api_write_element(api_out *out, const he_mesh *mesh, he_kind kind, uint32_t id)
{
    switch (kind) {
    case HE_VERTEX:
        return api_write_vertex(out, mesh, (he_vertex){id});
    case HE_HALFEDGE:
        return api_write_halfedge(out, mesh, (he_halfedge){id});
    case HE_EDGE:
        return api_write_edge(out, mesh, (he_edge){id});
    case HE_FACE:
        return api_write_face(out, mesh, (he_face){id});
    case HE_MESH_KIND:
    case HE_KIND_COUNT:
        break;
    }
    api_out_null(out);
    return 0;
}

void api_write_reference(api_out *out, he_kind kind, uint32_t id)
{
    api_out_object_begin(out);
    api_out_key_id(out, he_kind_name(kind), id);
    api_out_object_end(out);
}

void api_write_adjacency(api_out *out, uint64_t revision, const he_relation *relation, uint32_t id,
                         const he_ids *ids)
{
    api_out_object_begin(out);
    api_out_key_u64(out, "revision", revision);
    api_out_key(out, "of");
    api_write_reference(out, relation->of, id);
    api_out_key_string(out, "relation", relation->name);
    api_out_key_ids(out, "ids", ids->ids, ids->count);
    api_out_object_end(out);
}

void api_element_get(api_exchange *x)
{
    he_error err = {0};
    if (he_mesh_require(x->content, x->kind, x->id, &err) != HE_OK) {
        api_fail_path(x, &err);
    } else if (!api_not_modified(x, "element")) {
        api_write_element(&x->out, x->content, x->kind, x->id);
        api_answer_json(x, 200);
    }
}

void api_relation_get(api_exchange *x)
{
    const char *name = x->route->relation;
    const he_relation *relation = he_relation_find(x->kind, name, strlen(name));
    he_ids ids = {0};
    he_error err = {0};
    unsigned flags = api_param_flag(x, "cw") ? HE_CLOCKWISE : 0;
    if (he_mesh_require(x->content, x->kind, x->id, &err) != HE_OK) {
        api_fail_path(x, &err);
    } else if (!api_not_modified(x, "adjacency")) {
        if (he_relation_append(x->content, relation, x->id, flags, &ids, &err) == HE_OK) {
            api_write_adjacency(&x->out, x->info.revision, relation, x->id, &ids);
            api_answer_json(x, 200);
        } else {
            api_fail_path(x, &err);
        }
    }
    he_ids_clear(&ids);
}
