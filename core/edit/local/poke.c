#include "edit/local/poke.h"

#include "edit/piece/point.h"

static he_status collect(const he_mesh *m, he_halfedge first, he_ids *vertices, he_ids *halfedges,
                         he_error *err)
{
    he_halfedge h = first;
    do {
        he_status status = he_ids_add(vertices, he_origin(m, h).i, err);
        if (status == HE_OK) {
            status = he_ids_add(halfedges, h.i, err);
        }
        if (status != HE_OK) {
            return status;
        }
        h = he_next(m, h);
    } while (h.i != first.i);
    return HE_OK;
}

void he_poke_clear(he_poke *poke)
{
    he_ids_clear(&poke->around);
    he_ids_clear(&poke->loop);
}

he_status he_poke_plan(const he_mesh *m, he_halfedge first, bool keep, he_poke *out,
                       he_reservation *need, he_error *err)
{
    he_poke poke = {.first = first, .keep = keep};
    poke.corners = he_loop_length(m, first);
    poke.position = he_loop_mean(m, first);
    if (he_has_columns(m, HE_VERTEX) || he_has_columns(m, HE_HALFEDGE)) {
        he_status status = collect(m, first, &poke.around, &poke.loop, err);
        if (status != HE_OK) {
            he_poke_clear(&poke);
            return status;
        }
    }
    need->vertices++;
    need->edges += poke.corners;
    need->faces += poke.corners - keep;
    need->links += 3 * (size_t)poke.corners;
    need->lineage += poke.corners;
    *out = poke;
    return HE_OK;
}

static he_halfedge new_spoke(he_mesh *m, he_vertex from, he_vertex center, he_ids *edges)
{
    he_edge e = he_new_edge(m);
    he_halfedge spoke = he_edge_halfedge(e, 0);
    he_set_origin(m, spoke, from);
    he_set_origin(m, he_twin(spoke), center);
    if (edges != NULL) {
        edges->ids[edges->count++] = e.i;
    }
    return spoke;
}

he_vertex he_poke_commit(he_mesh *m, const he_poke *poke, he_ids *edges, he_ids *faces)
{
    he_vertex w = he_new_vertex(m);
    he_set_position(m, w, poke->position);
    he_face old = he_face_of(m, poke->first);
    he_halfedge h = poke->first;
    he_halfedge first_spoke = new_spoke(m, he_origin(m, h), w, edges), spoke = first_spoke;
    if (poke->around.count > 0) {
        he_attributes_mean(m, HE_VERTEX, w.i, poke->around.ids, poke->around.count);
        if (poke->keep) {
            he_attributes_mean(m, HE_HALFEDGE, he_twin(spoke).i, poke->loop.ids, poke->loop.count);
            he_attributes_copy(m, HE_HALFEDGE, spoke.i, h.i);
        }
    }
    for (uint32_t i = 0; i < poke->corners; i++) {
        he_halfedge next = he_next(m, h), in = first_spoke, out = he_twin(spoke);
        if (i + 1 < poke->corners) {
            in = new_spoke(m, he_origin(m, next), w, edges);
            if (poke->keep) {
                he_attributes_copy(m, HE_HALFEDGE, in.i, next.i);
                he_attributes_copy(m, HE_HALFEDGE, he_twin(in).i, he_twin(first_spoke).i);
            }
        }
        he_face f = old;
        if (!poke->keep || i > 0) {
            f = he_new_face(m);
            he_set_face_halfedge(m, f, h);
            if (poke->keep) {
                he_attributes_copy(m, HE_FACE, f.i, old.i);
                he_note_parent(m, HE_FACE, f.i, old.i);
            }
            if (faces != NULL) {
                faces->ids[faces->count++] = f.i;
            }
            he_set_face(m, h, f);
        }
        he_link(m, h, in);
        he_link(m, in, out);
        he_link(m, out, h);
        he_set_face(m, in, f);
        he_set_face(m, out, f);
        spoke = in;
        h = next;
    }
    he_set_vertex_halfedge(m, w, he_twin(first_spoke));
    return w;
}

he_status he_face_poke(he_mesh *m, he_face f, const he_vec3 *position, he_vertex *vertex,
                       he_ids *edges, he_ids *faces, he_error *err)
{
    he_status status = he_mesh_require(m, HE_FACE, f.i, err);
    if (status != HE_OK) {
        return status;
    }
    if (position != NULL && !he_point_is_finite(*position)) {
        return he_fail(err, HE_NOT_FINITE, HE_FACE, f.i, "the position must be finite");
    }
    he_poke poke;
    he_reservation need = {0};
    status = he_poke_plan(m, he_face_halfedge(m, f), true, &poke, &need, err);
    if (status != HE_OK) {
        return status;
    }
    if (position != NULL) {
        poke.position = *position;
    }
    status = edges == NULL ? HE_OK : he_ids_reserve(edges, need.edges, err);
    if (status == HE_OK && faces != NULL) {
        status = he_ids_reserve(faces, need.faces, err);
    }
    if (status == HE_OK) {
        status = he_reserve(m, need, err);
    }
    if (status == HE_OK) {
        /* Nothing below can fail. */
        he_vertex w = he_poke_commit(m, &poke, edges, faces);
        if (vertex != NULL) {
            *vertex = w;
        }
    }
    he_poke_clear(&poke);
    return status;
}
