#include "edit/local/split.h"

#include "edit/local/bisect.h"
#include "edit/local/cut.h"
#include "edit/local/diamond.h"
#include "edit/piece/point.h"
#include "mesh/pen.h"

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

/* Splits any edge, or refuses to. */
static __attribute__((noinline)) he_status split_any(he_mesh *m, he_edge e, double t, he_split *out,
                                                     he_error *err)
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

/* --- the common case: two triangles in a mesh without attributes --- */

/* Prefetches what the split will read and write. A split that is recorded takes so long that the
 * processor would find these places late. */
HE_PEN_INLINE void prefetch(const he_content *c, const he_diamond *q)
{
    __builtin_prefetch(&c->position[q->a]);
    __builtin_prefetch(&c->position[q->b]);
    __builtin_prefetch(&c->prev[q->ca], 1);
    __builtin_prefetch(&c->prev[q->bc], 1);
    __builtin_prefetch(&c->face[q->bc], 1);
    __builtin_prefetch(&c->next[q->db], 1);
    __builtin_prefetch(&c->prev[q->db], 1);
    __builtin_prefetch(&c->face[q->db], 1);
    __builtin_prefetch(&c->vertex_halfedge[q->b], 1);
    __builtin_prefetch(&c->face_halfedge[q->f], 1);
    __builtin_prefetch(&c->face_halfedge[q->g], 1);
}

/* Makes the elements that he_bisect_commit and two calls of he_cut_commit would make. Edge `on` is
 * the part of the edge at b, edge `up` leads to c, and edge `low` to d. */
HE_PEN_INLINE he_split write_split(he_pen *pen, const he_diamond *q, double t)
{
    he_content *c = pen->content;
    const he_vec3 p = he_point_between(c->position[q->a], c->position[q->b], t);
    const uint32_t w = he_pen_issue(&c->vertices, 1), e = he_pen_issue(&c->edges, 3);
    const uint32_t f = he_pen_issue(&c->faces, 2), g = f + 1;
    const uint32_t on = 2 * e, off = on + 1, up = on + 2, from_c = on + 3, low = on + 4,
                   to_w = on + 5;
    he_pen_new_vertex(pen, w, on, p);
    he_pen_new_edge(pen, e,
                    (const he_halfedge_links[2]){{q->bc, from_c, w, f}, {to_w, q->db, q->b, g}});
    he_pen_new_edge(pen, e + 1,
                    (const he_halfedge_links[2]){{q->ca, q->h, w, q->f}, {on, q->bc, q->c, f}});
    he_pen_new_edge(pen, e + 2,
                    (const he_halfedge_links[2]){{q->t, q->ad, q->d, q->g}, {q->db, off, w, g}});
    he_pen_new_face(pen, f, on);
    he_pen_new_face(pen, g, q->db);
    he_pen_next(pen, q->h, q->bc, up);
    he_pen_prev(pen, q->ca, q->bc, up);
    he_pen_prev(pen, q->bc, q->h, on);
    he_pen_next(pen, q->bc, q->ca, from_c);
    he_pen_face(pen, q->bc, q->f, f);
    he_pen_origin(pen, q->t, q->b, w);
    he_pen_prev(pen, q->t, q->db, low);
    he_pen_next(pen, q->ad, q->db, low);
    he_pen_next(pen, q->db, q->t, off);
    he_pen_prev(pen, q->db, q->ad, to_w);
    he_pen_face(pen, q->db, q->g, g);
    he_pen_parent(pen, HE_EDGE, e, q->h >> 1);
    he_pen_parent(pen, HE_FACE, f, q->f);
    he_pen_parent(pen, HE_FACE, g, q->g);
    he_pen_vertex_exchange(pen, q->b, q->t, off);
    he_pen_face_exchange(pen, q->f, q->bc, q->bc, up);
    he_pen_face_exchange(pen, q->g, q->t, q->db, low);
    return (he_split){
        .vertex = {w}, .edges = {{e}, {e + 1}, {e + 2}}, .faces = {{f}, {g}}, .sides = 2};
}

/* Splits edge e, in the common case by straight code. `recording` says whether a delta records. The
 * function is compiled once for each value of `recording`. */
HE_PEN_INLINE he_status split(he_mesh *m, he_edge e, double t, bool recording, he_split *out,
                              he_error *err)
{
    /* what he_bisect_reservation and he_cut_reservation ask for */
    static const he_reservation need = {
        .vertices = 1, .edges = 3, .faces = 2, .links = 32, .attributes = 2, .lineage = 3};
    he_diamond q;
    if (!he_has_room(m, &need) || !he_diamond_read(m, e, &q)) {
        return split_any(m, e, t, out, err);
    }
    if (recording) {
        prefetch(&m->c, &q);
    }
    if (q.c == q.d || !(t > 0 && t < 1)) {
        return split_any(m, e, t, out, err);
    }
    he_pen pen = he_pen_begin(m, recording);
    he_split made = write_split(&pen, &q, t);
    he_pen_end(&pen, m);
    if (out != NULL) {
        *out = made;
    }
    return HE_OK;
}

static __attribute__((noinline)) he_status split_recorded(he_mesh *m, he_edge e, double t,
                                                          he_split *out, he_error *err)
{
    return split(m, e, t, true, out, err);
}

he_status he_edge_split(he_mesh *m, he_edge e, double t, he_split *out, he_error *err)
{
    return m->delta != NULL ? split_recorded(m, e, t, out, err) : split(m, e, t, false, out, err);
}
