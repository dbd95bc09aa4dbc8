#include "edit/piece/triangles.h"

void he_triangles_clear(he_triangles *plan)
{
    he_triangulation_clear(&plan->of);
    he_mem_free(plan->side);
    plan->side = NULL;
}

he_status he_triangles_plan(const he_mesh *m, he_halfedge first, he_triangulation_work *work,
                            he_triangles *out, he_error *err)
{
    he_triangles plan = {.side = NULL};
    he_status status = he_triangulation_make(m, first, HE_AVOID_EDGES, work, &plan.of, err);
    if (status != HE_OK) {
        return status;
    }
    plan.side = he_mem_array(NULL, plan.of.flat.n, sizeof *plan.side);
    if (plan.side == NULL) {
        he_triangles_clear(&plan);
        return he_fail_plain(err, HE_NO_MEMORY, "no memory to triangulate a loop");
    }
    *out = plan;
    return HE_OK;
}

void he_triangles_reservation(const he_triangles *plan, bool keep, he_reservation *need)
{
    uint32_t n = plan->of.flat.n;
    need->edges += n - 3;
    need->faces += n - 2 - keep;
    need->links += 3 * (size_t)n;
    need->lineage += n - 3;
}

/* Makes the diagonal that cuts the triangle of three corners off the part of the loop that is not
 * filled yet. Returns the diagonal's half-edge inside this triangle. */
static he_halfedge cut_off(he_mesh *m, he_triangles *plan, const uint32_t *corners, bool keep,
                           he_ids *edges)
{
    const he_planar_loop *flat = &plan->of.flat;
    he_edge e = he_new_edge(m);
    he_halfedge d = he_edge_halfedge(e, 0);
    he_set_origin(m, d, he_origin(m, (he_halfedge){flat->halfedge[corners[2]]}));
    he_set_origin(m, he_twin(d), he_origin(m, (he_halfedge){flat->halfedge[corners[0]]}));
    if (keep) {
        he_attributes_copy(m, HE_HALFEDGE, d.i, flat->halfedge[corners[2]]);
        he_attributes_copy(m, HE_HALFEDGE, he_twin(d).i, flat->halfedge[corners[0]]);
    }
    if (edges != NULL) {
        edges->ids[edges->count++] = e.i;
    }
    plan->side[corners[0]] = he_twin(d).i;
    return d;
}

void he_triangles_commit(he_mesh *m, he_triangles *plan, bool keep, he_ids *edges, he_ids *faces)
{
    const he_planar_loop *flat = &plan->of.flat;
    uint32_t n = flat->n, *side = plan->side;
    he_face old = he_face_of(m, (he_halfedge){flat->halfedge[0]});
    uint32_t stored = keep ? he_face_halfedge(m, old).i : HE_NONE;
    memcpy(side, flat->halfedge, n * sizeof *side);
    for (uint32_t k = 0; k + 2 < n; k++) {
        const uint32_t *corners = plan->of.corners + 3 * (size_t)k;
        he_halfedge a = {side[corners[0]]}, b = {side[corners[1]]}, c;
        c = k + 3 < n ? cut_off(m, plan, corners, keep, edges) : (he_halfedge){side[corners[2]]};
        he_face f = old;
        if (stored == HE_NONE || (a.i != stored && b.i != stored && c.i != stored)) {
            f = he_new_face(m);
            he_set_face_halfedge(m, f, a);
            if (keep) {
                he_attributes_copy(m, HE_FACE, f.i, old.i);
                he_note_parent(m, HE_FACE, f.i, old.i);
            }
            if (faces != NULL) {
                faces->ids[faces->count++] = f.i;
            }
        }
        he_link(m, a, b);
        he_link(m, b, c);
        he_link(m, c, a);
        he_set_face(m, a, f);
        he_set_face(m, b, f);
        he_set_face(m, c, f);
    }
}
