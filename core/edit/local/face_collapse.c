#include "edit/local/face_collapse.h"

#include "edit/local/collapse.h"
#include "mesh/write.h"

/* Returns the next half-edge to collapse. It runs from the corner of face f that follows vertex `a`
 * to `a`, and its face is the neighbour of f across that side. If f is deleted already, the
 * half-edge runs from vertex `last` to `a`. */
static he_halfedge next_side(const he_mesh *m, he_face f, he_vertex a, he_vertex last)
{
    if (!he_face_is_live(m, f)) {
        return he_find_halfedge(m, last, a);
    }
    he_halfedge h = he_face_halfedge(m, f);
    while (he_origin(m, h).i != a.i) {
        h = he_next(m, h);
    }
    return he_twin(h);
}

/* Refuses a face whose collapse would take too much work. The sides of the face are collapsed one
 * by one. Each collapse visits all faces around the two ends of the side, and one end has gathered
 * the faces of all corners that were merged before. */
static he_status check_work(const he_mesh *m, he_face f, uint32_t n, he_error *err)
{
    uint64_t steps = 0, most = HE_FACE_COLLAPSE_STEPS / n;
    he_halfedge first = he_face_halfedge(m, f), h = first;
    do {
        he_halfedge k = h;
        do {
            if (he_face_of(m, k).i != f.i && !he_is_boundary_halfedge(m, k)) {
                he_halfedge j = k;
                do {
                    j = he_next(m, j);
                } while (++steps <= most && j.i != k.i);
            }
            k = he_swing_ccw(m, k);
        } while (++steps <= most && k.i != h.i);
        h = he_next(m, h);
    } while (steps <= most && h.i != first.i);
    if (steps > most) {
        return he_fail(err, HE_LIMIT, HE_FACE, f.i,
                       "the collapse of face %u, which has %u corners, cannot be checked, because "
                       "the faces around it have too many corners",
                       f.i, n);
    }
    return HE_OK;
}

he_status he_face_collapse(he_mesh *m, he_face f, he_vertex *vertex, he_error *err)
{
    he_status status = he_mesh_require(m, HE_FACE, f.i, err);
    if (status != HE_OK) {
        return status;
    }
    uint32_t n = he_face_degree(m, f);
    he_halfedge stored = he_face_halfedge(m, f);
    he_vertex a = he_origin(m, stored), last = he_origin(m, he_prev(m, stored));
    he_bracket bracket;
    status = check_work(m, f, n, err);
    if (status == HE_OK) {
        status = he_edit_begin(m, &bracket, err);
    }
    if (status != HE_OK) {
        return status;
    }
    for (uint32_t k = 1; status == HE_OK && k < n; k++) {
        /* Vertex a is at the mean of the first k corners. A collapse with this weight moves it to
         * the mean of the first k + 1 corners. */
        double t = (double)k / (k + 1);
        status = he_edge_collapse(m, next_side(m, f, a, last), t, NULL, NULL, err);
    }
    if (status == HE_OK && vertex != NULL) {
        *vertex = a;
    }
    return he_edit_end(m, &bracket, status);
}
