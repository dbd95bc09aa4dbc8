#include "edit/local/flip.h"

#include "edit/local/cut.h"
#include "edit/local/diamond.h"
#include "mesh/marks.h"
#include "mesh/pen.h"

/* Checks that the origin of h, which loses one edge by the flip, keeps at least three edges or is
 * on the boundary. Three steps around the vertex decide whether its degree is at least 4; a walk
 * around the whole vertex would be slow at a vertex with many edges. */
static he_status check_end(const he_mesh *m, he_halfedge h, he_error *err)
{
    he_halfedge second = he_swing_ccw(m, he_swing_ccw(m, h));
    he_vertex v = he_origin(m, h);
    if ((second.i != h.i && second.i != he_swing_cw(m, h).i) || he_is_boundary_vertex(m, v)) {
        return HE_OK;
    }
    return he_fail(err, HE_LOW_DEGREE, HE_VERTEX, v.i,
                   "vertex %u has degree %u, which is too low for it to lose edge %u", v.i,
                   second.i == h.i ? 2u : 3u, he_edge_of(h).i);
}

static he_status check_marks(const he_mesh *m, he_edge e, he_error *err)
{
    he_marks marks;
    if (!he_marks_find(m, &marks)) {
        return HE_OK;
    }
    if (he_is_feature(&marks, e)) {
        return he_fail(err, HE_FEATURE_EDGE, HE_EDGE, e.i, "edge %u is a feature edge", e.i);
    }
    he_halfedge h = he_edge_halfedge(e, 0);
    he_status status = he_require_unlocked(&marks, HE_EDGE, e.i, err);
    if (status == HE_OK) {
        status = he_require_unlocked(&marks, HE_FACE, he_face_of(m, h).i, err);
    }
    if (status == HE_OK) {
        status = he_require_unlocked(&marks, HE_FACE, he_face_of(m, he_twin(h)).i, err);
    }
    return status;
}

static he_status check(const he_mesh *m, he_edge e, he_error *err)
{
    he_prefetch_links(m, he_edge_halfedge(e, 0));
    if (!he_edge_is_live(m, e)) {
        return he_mesh_require(m, HE_EDGE, e.i, err);
    }
    he_prefetch_about(m, e);
    if (he_is_boundary_edge(m, e)) {
        return he_fail(err, HE_BOUNDARY_EDGE, HE_EDGE, e.i, "edge %u has only one face", e.i);
    }
    he_halfedge h = he_edge_halfedge(e, 0), t = he_twin(h);
    he_vertex c = he_target(m, he_next(m, h)), d = he_target(m, he_next(m, t));
    if (c.i == d.i) {
        return he_fail(err, HE_SAME_ENDS, HE_EDGE, e.i,
                       "both ends of edge %u would become vertex %u", e.i, c.i);
    }
    he_status status = check_end(m, h, err);
    if (status == HE_OK) {
        status = check_end(m, t, err);
    }
    if (status != HE_OK) {
        return status;
    }
    /* The search for an edge from c to d walks in both directions around c. It starts at
     * the half-edge twin(next(h)), which leaves c on the border of face(h), so it finds an edge of
     * that face or of a face next to it after few steps. */
    he_halfedge joined = he_find_halfedge_from(m, he_twin(he_next(m, h)), d);
    if (joined.i != HE_NONE) {
        return he_fail(err, HE_DOUBLED_EDGE, HE_EDGE, he_edge_of(joined).i,
                       "edge %u already joins vertices %u and %u", he_edge_of(joined).i, c.i, d.i);
    }
    he_face f = he_face_of(m, h), g = he_face_of(m, t);
    /* Edge e joins vertices a and b. If face f is a triangle, its corners are a, b and c, so d is
     * not among them. */
    if (!he_is_triangle(m, h) && he_face_corner(m, f, d).i != HE_NONE) {
        return he_fail(err, HE_REPEATED_CORNER, HE_FACE, f.i, "face %u would use vertex %u twice",
                       f.i, d.i);
    }
    if (!he_is_triangle(m, t) && he_face_corner(m, g, c).i != HE_NONE) {
        return he_fail(err, HE_REPEATED_CORNER, HE_FACE, g.i, "face %u would use vertex %u twice",
                       g.i, c.i);
    }
    return check_marks(m, e, err);
}

/* Moves the origin of h from its vertex a to the next corner of the face of twin(h), which loses
 * the corner at a. `side` is the half-edge that follows twin(h); it moves into the face of h. */
static void turn_end(he_mesh *m, he_halfedge h, he_halfedge side)
{
    he_vertex a = he_origin(m, h);
    he_face g = he_face_of(m, side);
    if (he_vertex_halfedge(m, a).i == h.i) {
        he_set_vertex_halfedge(m, a, side);
    }
    if (he_face_halfedge(m, g).i == side.i) {
        he_set_face_halfedge(m, g, he_twin(h));
    }
    he_set_face(m, side, he_face_of(m, h));
    he_set_origin(m, h, he_target(m, side));
}

/* Upper limit of the links that a flip writes. */
enum { FLIP_LINKS = 20 };

/* Flips any edge, or refuses to. */
static __attribute__((noinline)) he_status flip_any(he_mesh *m, he_edge e, he_error *err)
{
    he_status status = check(m, e, err);
    if (status == HE_OK) {
        status = he_reserve(m, (he_reservation){.links = FLIP_LINKS, .attributes = 2}, err);
    }
    if (status != HE_OK) {
        return status;
    }
    /* Nothing below can fail. */
    he_halfedge h = he_edge_halfedge(e, 0), t = he_twin(h);
    he_halfedge from_b = he_next(m, h), from_a = he_next(m, t);
    he_halfedge before_h = he_prev(m, h), before_t = he_prev(m, t);
    he_halfedge from_c = he_next(m, from_b), from_d = he_next(m, from_a);
    turn_end(m, h, from_a);
    turn_end(m, t, from_b);
    he_link(m, before_h, from_a);
    he_link(m, from_a, h);
    he_link(m, h, from_c);
    he_link(m, before_t, from_b);
    he_link(m, from_b, t);
    he_link(m, t, from_d);
    he_attributes_move(m, HE_HALFEDGE, h.i, from_d.i);
    he_attributes_move(m, HE_HALFEDGE, t.i, from_c.i);
    return HE_OK;
}

/* --- the common case: two triangles in a mesh without attributes --- */

/* Prefetches what the flip will write but does not read before. */
HE_PEN_INLINE void prefetch(const he_content *c, const he_diamond *q)
{
    __builtin_prefetch(&c->face[q->ad], 1);
    __builtin_prefetch(&c->face[q->bc], 1);
    __builtin_prefetch(&c->next[q->db], 1);
    __builtin_prefetch(&c->prev[q->ad], 1);
    __builtin_prefetch(&c->vertex_halfedge[q->a], 1);
    __builtin_prefetch(&c->vertex_halfedge[q->b], 1);
    __builtin_prefetch(&c->face_halfedge[q->f], 1);
    __builtin_prefetch(&c->face_halfedge[q->g], 1);
}

/* Returns true if c has few edges and none of them leads to d. The function walks around c in both
 * directions, beginning behind the two edges of the diamond. */
HE_PEN_INLINE bool are_apart(const he_content *c, const he_diamond *q)
{
    enum { ROUNDS = 8 };
    uint32_t up = q->bc ^ 1u, down = q->ca;
    for (int round = 0; round < ROUNDS; round++) {
        up = c->prev[up] ^ 1u;
        if (up == down) {
            return true;
        }
        if (c->origin[up ^ 1u] == q->d) {
            return false;
        }
        down = c->next[down ^ 1u];
        if (up == down) {
            return true;
        }
        if (c->origin[down ^ 1u] == q->d) {
            return false;
        }
    }
    return false;
}

/* Returns true if the flip is certainly allowed: a and b keep at least three edges, and c and d are
 * different vertices that no edge joins. */
HE_PEN_INLINE bool may_flip(const he_content *c, const he_diamond *q)
{
    const uint32_t second_a = c->prev[q->ca ^ 1u] ^ 1u, second_b = c->prev[q->db ^ 1u] ^ 1u;
    return !((q->c == q->d) | (second_a == q->h) | (second_a == q->ad) | (second_b == q->t) |
             (second_b == q->bc)) &&
           are_apart(c, q);
}

HE_PEN_INLINE void write_flip(he_pen *pen, const he_diamond *q)
{
    he_pen_face(pen, q->ad, q->g, q->f);
    he_pen_face(pen, q->bc, q->f, q->g);
    he_pen_origin(pen, q->h, q->a, q->d);
    he_pen_origin(pen, q->t, q->b, q->c);
    /* The loop of f becomes h, ca, ad; that of g becomes t, db, bc. */
    he_pen_next(pen, q->h, q->bc, q->ca);
    he_pen_prev(pen, q->h, q->ca, q->ad);
    he_pen_next(pen, q->ca, q->h, q->ad);
    he_pen_prev(pen, q->ca, q->bc, q->h);
    he_pen_next(pen, q->ad, q->db, q->h);
    he_pen_prev(pen, q->ad, q->t, q->ca);
    he_pen_next(pen, q->t, q->ad, q->db);
    he_pen_prev(pen, q->t, q->db, q->bc);
    he_pen_next(pen, q->db, q->t, q->bc);
    he_pen_prev(pen, q->db, q->ad, q->t);
    he_pen_next(pen, q->bc, q->ca, q->t);
    he_pen_prev(pen, q->bc, q->h, q->db);
    he_pen_vertex_exchange(pen, q->a, q->h, q->ad);
    he_pen_vertex_exchange(pen, q->b, q->t, q->bc);
    he_pen_face_exchange(pen, q->f, q->bc, q->bc, q->h);
    he_pen_face_exchange(pen, q->g, q->ad, q->ad, q->t);
}

/* Flips edge e, in the common case by straight code. `recording` says whether a delta records. The
 * function is compiled once for each value of `recording`. */
HE_PEN_INLINE he_status flip(he_mesh *m, he_edge e, bool recording, he_error *err)
{
    he_diamond q;
    if (m->c.column_count > 0 || !he_diamond_read(m, e, &q) ||
        (recording && m->delta->capacity - m->delta->count < FLIP_LINKS)) {
        return flip_any(m, e, err);
    }
    prefetch(&m->c, &q);
    if (!may_flip(&m->c, &q)) {
        return flip_any(m, e, err);
    }
    he_pen pen = he_pen_begin(m, recording);
    write_flip(&pen, &q);
    he_pen_end(&pen, m);
    return HE_OK;
}

static __attribute__((noinline)) he_status flip_recorded(he_mesh *m, he_edge e, he_error *err)
{
    return flip(m, e, true, err);
}

he_status he_edge_flip(he_mesh *m, he_edge e, he_error *err)
{
    return m->delta != NULL ? flip_recorded(m, e, err) : flip(m, e, false, err);
}
