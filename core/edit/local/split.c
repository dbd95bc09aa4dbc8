#include "edit/local/split.h"

#include "edit/local/bisect.h"
#include "edit/local/cut.h"
#include "edit/piece/point.h"

static he_status check(const he_mesh *m, he_edge e, double t, he_error *err)
{
    he_prefetch_links(m, he_edge_halfedge(e, 0));
    if (!he_edge_is_live(m, e)) {
        return he_mesh_require(m, HE_EDGE, e.i, err);
    }
    he_prefetch_about(m, e);
    he_prefetch_ends(m, e);
    if (!(t > 0 && t < 1)) {
        return he_fail(err, HE_BAD_VALUE, HE_EDGE, e.i, "\"t\" must be between 0 and 1, not %g", t);
    }
    he_halfedge h = he_edge_halfedge(e, 0), back = he_twin(h);
    he_vertex c = he_target(m, he_next(m, h)), d = he_target(m, he_next(m, back));
    if (!he_is_boundary_edge(m, e) && c.i == d.i) {
        return he_fail(err, HE_DOUBLED_EDGE, HE_VERTEX, c.i,
                       "a split of edge %u would make two diagonals that both end at vertex %u",
                       e.i, c.i);
    }
    return HE_OK;
}

he_status he_edge_split(he_mesh *m, he_edge e, double t, he_split *out, he_error *err)
{
    he_status status = check(m, e, t, err);
    if (status != HE_OK) {
        return status;
    }
    he_halfedge h = he_edge_halfedge(e, 0), back = he_twin(h);
    he_reservation need = {0};
    he_bisect_reservation(&need);
    if (!he_is_boundary_halfedge(m, h)) {
        he_cut_reservation(3, &need);
    }
    if (!he_is_boundary_halfedge(m, back)) {
        he_cut_reservation(he_loop_length(m, back), &need);
    }
    status = he_reserve(m, need, err);
    if (status != HE_OK) {
        return status;
    }
    /* Nothing below can fail. */
    he_halfedge on = he_bisect_commit(m, e, t);
    he_split made = {.vertex = he_origin(m, on), .edges = {he_edge_of(on)}};
    he_halfedge diagonal;
    if (!he_is_boundary_halfedge(m, on)) {
        diagonal = he_cut_commit(m, on, he_next(m, he_next(m, on)));
        made.faces[made.sides++] = he_face_of(m, he_twin(diagonal));
        made.edges[made.sides] = he_edge_of(diagonal);
    }
    if (!he_is_boundary_halfedge(m, back)) {
        diagonal = he_cut_commit(m, he_next(m, he_next(m, back)), back);
        made.faces[made.sides++] = he_face_of(m, he_twin(diagonal));
        made.edges[made.sides] = he_edge_of(diagonal);
    }
    if (out != NULL) {
        *out = made;
    }
    return HE_OK;
}
