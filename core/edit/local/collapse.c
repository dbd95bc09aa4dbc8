#include "edit/local/collapse.h"

#include "edit/local/cut.h"
#include "edit/local/diamond.h"
#include "edit/piece/point.h"
#include "edit/piece/ring.h"
#include "mesh/marks.h"
#include "mesh/pen.h"

static he_status refuse(he_error *err, he_halfedge h, const char *rule, const char *kind,
                        uint32_t id)
{
    return he_fail(err, HE_LINK_CONDITION, HE_EDGE, he_edge_of(h).i, "edge %u: %s (%s %u)",
                   he_edge_of(h).i, rule, kind, id);
}

/* Returns the corner opposite to h if the face left of h is a triangle, else HE_NONE. */
static he_vertex opposite(const he_mesh *m, he_halfedge h)
{
    return he_is_triangle(m, h) ? he_origin(m, he_prev(m, h)) : (he_vertex){HE_NONE};
}

enum { SMALL_RING = 24, BLOCK = 8 };

/* The half-edges that leave a vertex of low degree, and their targets. The array `target` is padded
 * with HE_NONE to a multiple of BLOCK entries, so that is_in() can compare BLOCK entries at a
 * time. */
typedef struct ring {
    uint32_t count, out[SMALL_RING], target[SMALL_RING];
} ring;

/* The state of two walks around one vertex: `up` is the next half-edge of the counter-clockwise
 * walk, `down` the next one of the clockwise walk. `open` is false as soon as the walks have
 * met. */
typedef struct hands {
    he_halfedge up, down;
    /* The counter-clockwise walk has written `ups` entries at the front of the ring's arrays, the
     * clockwise walk has written `downs` entries at their back. */
    uint32_t ups, downs;
    bool open;
} hands;

static void put(const he_mesh *m, ring *r, uint32_t place, he_halfedge h)
{
    r->out[place] = h.i;
    r->target[place] = he_target(m, h).i;
}

/* Advances each of the two walks by one half-edge. Returns false if more half-edges leave the
 * vertex than the arrays of a ring can hold. */
static bool turn(const he_mesh *m, hands *at, ring *r)
{
    if (at->ups + at->downs + 2 > SMALL_RING) {
        return false;
    }
    put(m, r, at->ups++, at->up);
    if (at->up.i != at->down.i) {
        put(m, r, SMALL_RING - ++at->downs, at->down);
    }
    he_halfedge up = he_swing_ccw(m, at->up);
    at->open = at->up.i != at->down.i && up.i != at->down.i;
    at->up = up;
    at->down = at->open ? he_swing_cw(m, at->down) : at->down;
    return true;
}

/* Puts the half-edges that the two walks have gathered into counter-clockwise order: moves the
 * entries at the back of the arrays directly behind those at the front. Pads the array `target`. */
static void close_ring(const hands *at, ring *r)
{
    r->count = at->ups;
    for (uint32_t i = SMALL_RING - at->downs; i < SMALL_RING; i++) {
        r->out[r->count] = r->out[i];
        r->target[r->count++] = r->target[i];
    }
    for (uint32_t i = r->count; i % BLOCK != 0; i++) {
        r->target[i] = HE_NONE;
    }
}

/* Gathers the half-edges that leave each end of h. A step of a walk waits for memory. Four walks,
 * in two directions around two vertices, therefore advance in turn, so that their waits overlap.
 * Returns false if more half-edges leave an end of h than the arrays of a ring can hold. */
static bool gather(const he_mesh *m, he_halfedge h, ring *of_u, ring *of_v)
{
    ring *const rings[2] = {of_u, of_v};
    hands at[2];
    for (unsigned i = 0; i < 2; i++) {
        he_halfedge from = i == 0 ? h : he_twin(h);
        at[i] = (hands){.up = from, .down = he_swing_cw(m, from), .open = true};
    }
    while (at[0].open || at[1].open) {
        for (unsigned i = 0; i < 2; i++) {
            if (at[i].open && !turn(m, &at[i], rings[i])) {
                return false;
            }
        }
    }
    close_ring(&at[0], of_u);
    close_ring(&at[1], of_v);
    return true;
}

static bool is_in(const ring *r, uint32_t vertex)
{
    unsigned found = 0;
    for (uint32_t i = 0; i < r->count && !found; i += BLOCK) {
        for (uint32_t k = i; k < i + BLOCK; k++) {
            found |= r->target[k] == vertex;
        }
    }
    return found;
}

/* Checks parts L1 and L4 of the link condition (see collapse.h) for half-edge k, which leaves the
 * origin of h. `of_v` lists the half-edges that leave the target of h; if it is NULL, this function
 * walks around the target. `c` and `d` are the opposite corners of the triangles beside h. */
static he_status check_neighbour(const he_mesh *m, he_halfedge h, he_halfedge k, const ring *of_v,
                                 he_vertex c, he_vertex d, he_error *err)
{
    he_vertex v = he_target(m, h), w = he_target(m, k);
    if (w.i != c.i && w.i != d.i &&
        (of_v != NULL ? is_in(of_v, w.i) : he_find_halfedge(m, w, v).i != HE_NONE)) {
        return refuse(err, h,
                      "the edge's ends share a neighbour that is not a corner of the edge's faces",
                      "vertex", w.i);
    }
    /* If the loop of k is a triangle, all its corners are neighbours of the origin of h, so part L4
     * follows from part L1. */
    if (he_prev(m, he_prev(m, k)).i == he_next(m, k).i) {
        return HE_OK;
    }
    he_face f = he_face_of(m, h), g = he_face_of(m, he_twin(h)), x = he_face_of(m, k);
    if (x.i != HE_NONE && x.i != f.i && x.i != g.i && he_face_corner(m, x, v).i != HE_NONE) {
        return refuse(err, h,
                      "both ends of the edge are corners of a face that is not beside the edge",
                      "face", x.i);
    }
    return HE_OK;
}

static he_status check_ring(const he_mesh *m, he_halfedge h, he_error *err)
{
    he_vertex c = opposite(m, h), d = opposite(m, he_twin(h));
    if (c.i != HE_NONE && c.i == d.i) {
        return refuse(err, h, "both triangles beside the edge have the same opposite corner",
                      "vertex", c.i);
    }
    ring of_u, of_v;
    he_status status = HE_OK;
    if (gather(m, h, &of_u, &of_v)) {
        for (uint32_t i = 1; i < of_u.count && status == HE_OK; i++) {
            status = check_neighbour(m, h, (he_halfedge){of_u.out[i]}, &of_v, c, d, err);
        }
        return status;
    }
    for (he_halfedge k = he_swing_ccw(m, h); k.i != h.i && status == HE_OK;
         k = he_swing_ccw(m, k)) {
        status = check_neighbour(m, h, k, NULL, c, d, err);
    }
    return status;
}

/* Checks part L3 of the link condition (collapse.h) for the triangle left of h. */
static he_status check_sides(const he_mesh *m, he_halfedge h, he_error *err)
{
    if (he_is_triangle(m, h) && he_is_boundary_halfedge(m, he_twin(he_next(m, h))) &&
        he_is_boundary_halfedge(m, he_twin(he_prev(m, h)))) {
        return refuse(err, h, "a triangle beside the edge has both its other edges on the boundary",
                      "face", he_face_of(m, h).i);
    }
    return HE_OK;
}

/* Returns true if the origin of h is an interior vertex of three triangles. */
static bool is_apex(const he_mesh *m, he_halfedge h)
{
    he_halfedge second = he_swing_ccw(m, h), third = he_swing_ccw(m, second);
    return he_swing_ccw(m, third).i == h.i && he_is_triangle(m, h) && he_is_triangle(m, second) &&
           he_is_triangle(m, third);
}

static he_status check(const he_mesh *m, he_halfedge h, he_error *err)
{
    he_prefetch_links(m, h);
    if (!he_edge_is_live(m, he_edge_of(h))) {
        return he_mesh_require(m, HE_HALFEDGE, h.i, err);
    }
    he_prefetch_about(m, he_edge_of(h));
    he_prefetch_ends(m, he_edge_of(h));
    he_halfedge t = he_twin(h);
    he_vertex u = he_origin(m, h), v = he_target(m, h);
    if (he_is_boundary_vertex(m, u) && he_is_boundary_vertex(m, v) &&
        !he_is_boundary_edge(m, he_edge_of(h))) {
        return refuse(err, h, "the edge is inside the mesh but both its ends are on the boundary",
                      "vertex", u.i);
    }
    he_status status = check_sides(m, h, err);
    if (status == HE_OK) {
        status = check_sides(m, t, err);
    }
    if (status == HE_OK) {
        status = check_ring(m, h, err);
    }
    if (status == HE_OK && is_apex(m, h) && is_apex(m, t)) {
        return refuse(err, h, "the edge is part of a tetrahedron", "vertex", u.i);
    }
    return status;
}

/* The collapse deletes the origin of h and deletes or moves all edges and faces around it, so none
 * of them may be locked (see marks.h). If `moves` is true, the target of h moves and may not be
 * locked either. */
static he_status check_locks(const he_mesh *m, const he_marks *marks, he_halfedge h, bool moves,
                             he_error *err)
{
    he_vertex u = he_origin(m, h), v = he_target(m, h);
    he_status status = he_require_unlocked(marks, HE_VERTEX, u.i, err);
    if (status == HE_OK && moves) {
        status = he_require_unlocked(marks, HE_VERTEX, v.i, err);
    }
    return status == HE_OK ? he_require_unlocked_about(m, marks, h, err) : status;
}

/* Counts the feature edges at the origin of h. Sets *which to one of them, preferably not to the
 * edge of h. */
static uint32_t count_features(const he_mesh *m, const he_marks *marks, he_halfedge h,
                               he_edge *which)
{
    uint32_t count = 0;
    he_halfedge k = h;
    do {
        if (he_is_feature(marks, he_edge_of(k))) {
            *which = he_edge_of(k);
            count++;
        }
        k = he_swing_ccw(m, k);
    } while (k.i != h.i);
    return count;
}

/* Checks rules F1 to F4 of marks.h, which protect feature edges from a collapse. */
static he_status check_features(const he_mesh *m, const he_marks *marks, he_halfedge h, bool moves,
                                he_error *err)
{
    if (marks->feature == NULL) {
        return HE_OK;
    }
    he_halfedge back = he_twin(h);
    he_vertex u = he_origin(m, h), v = he_target(m, h);
    he_edge e = he_edge_of(h), other = e;
    bool along = he_is_feature(marks, e);
    uint32_t count = count_features(m, marks, h, &other);
    if (!along && count > 0) {
        return he_fail(err, HE_FEATURE_EDGE, HE_EDGE, other.i,
                       "vertex %u would be removed, but lies on feature edge %u", u.i, other.i);
    }
    if (along && count != 2) {
        return he_fail(err, HE_FEATURE_EDGE, HE_EDGE, e.i,
                       "vertex %u would be removed, but %u feature edges meet at it", u.i, count);
    }
    he_edge left = he_edge_of(he_prev(m, h)), right = he_edge_of(he_next(m, back));
    if ((he_is_triangle(m, h) && he_is_feature(marks, left)) ||
        (he_is_triangle(m, back) && he_is_feature(marks, right))) {
        return he_fail(err, HE_FEATURE_EDGE, HE_EDGE, other.i,
                       "feature edge %u would merge into another edge", other.i);
    }
    count = moves ? count_features(m, marks, back, &other) : 0;
    if (count > 0 && !(along && count == 2)) {
        return he_fail(err, HE_FEATURE_EDGE, HE_EDGE, other.i,
                       "vertex %u would move, but lies on feature edge %u", v.i, other.i);
    }
    return HE_OK;
}

static he_status check_marks(const he_mesh *m, he_halfedge h, he_vec3 place, he_error *err)
{
    he_marks marks;
    if (!he_marks_find(m, &marks)) {
        return HE_OK;
    }
    he_vec3 p = he_position(m, he_target(m, h));
    bool moves = place.x != p.x || place.y != p.y || place.z != p.z;
    he_status status = check_locks(m, &marks, h, moves, err);
    return status != HE_OK ? status : check_features(m, &marks, h, moves, err);
}

/* Closes a face from which the collapse has removed one of three sides: `kept` and `gone` are its
 * last two half-edges, which run between two vertices in opposite directions. The face and the edge
 * of `gone` are deleted. `kept` replaces twin(gone) in the face on the far side of that edge. */
static void close_sides(he_mesh *m, he_halfedge kept, he_halfedge gone)
{
    he_halfedge outer = he_twin(gone);
    he_face f = he_face_of(m, kept), x = he_face_of(m, outer);
    he_vertex c = he_origin(m, outer);
    if (he_vertex_halfedge(m, c).i == outer.i) {
        he_set_vertex_halfedge(m, c, kept);
    }
    c = he_origin(m, gone);
    if (he_vertex_halfedge(m, c).i == gone.i) {
        he_set_vertex_halfedge(m, c, he_twin(kept));
    }
    he_link(m, kept, he_next(m, outer));
    he_link(m, he_prev(m, outer), kept);
    he_set_face(m, kept, x);
    if (x.i != HE_NONE && he_face_halfedge(m, x).i == outer.i) {
        he_set_face_halfedge(m, x, kept);
    }
    he_attributes_move(m, HE_HALFEDGE, kept.i, outer.i);
    he_attributes_merge(m, HE_EDGE, he_edge_of(kept).i, he_edge_of(gone).i, 0.5);
    he_note_merged(m, HE_EDGE, he_edge_of(gone).i, he_edge_of(kept).i);
    he_delete_edge(m, he_edge_of(gone));
    he_delete_face(m, f);
}

/* Removes half-edge h from its loop. */
static void unlink_side(he_mesh *m, he_halfedge h)
{
    he_face f = he_face_of(m, h);
    if (f.i != HE_NONE && he_face_halfedge(m, f).i == h.i) {
        he_set_face_halfedge(m, f, he_next(m, h));
    }
    he_link(m, he_prev(m, h), he_next(m, h));
}

static void commit(he_mesh *m, he_halfedge h, he_vec3 position, double t)
{
    he_halfedge back = he_twin(h);
    he_halfedge after = he_next(m, h), before = he_prev(m, h);
    he_halfedge back_after = he_next(m, back), back_before = he_prev(m, back);
    he_vertex u = he_origin(m, h), v = he_target(m, h);
    bool left = he_is_triangle(m, h), right = he_is_triangle(m, back);
    bool interior = !he_is_boundary_vertex(m, u) && !he_is_boundary_vertex(m, v);
    for (he_halfedge k = he_swing_ccw(m, h); k.i != h.i;) {
        he_halfedge next = he_swing_ccw(m, k);
        he_set_origin(m, k, v);
        k = next;
    }
    unlink_side(m, h);
    unlink_side(m, back);
    if (left) {
        close_sides(m, after, before);
    }
    if (right) {
        close_sides(m, back_before, back_after);
    }
    he_set_position(m, v, position);
    he_attributes_merge(m, HE_VERTEX, v.i, u.i, t);
    he_note_merged(m, HE_VERTEX, u.i, v.i);
    he_delete_edge(m, he_edge_of(h));
    he_delete_vertex(m, u);
    if (!interior) {
        he_ring_settle(m, v, after);
    } else if (he_origin(m, he_vertex_halfedge(m, v)).i != v.i) {
        /* v is an interior vertex, which may store any half-edge that leaves it (invariant I8 of
         * mesh.h). he_ring_settle(), which may walk around the whole vertex, is therefore not
         * needed. */
        he_set_vertex_halfedge(m, v, after);
    }
}

/* Collapses any edge, or refuses to. */
static __attribute__((noinline)) he_status
collapse_any(he_mesh *m, he_halfedge h, double t, const he_vec3 *to, double mix, he_error *err)
{
    he_status status = check(m, h, err);
    if (status != HE_OK) {
        return status;
    }
    if (!(t >= 0 && t <= 1)) {
        return he_fail(err, HE_BAD_VALUE, HE_HALFEDGE, h.i, "\"t\" must be from 0 to 1, not %g", t);
    }
    if (to != NULL && !he_point_is_finite(*to)) {
        return he_fail(err, HE_NOT_FINITE, HE_HALFEDGE, h.i, "the position must be finite");
    }
    he_vertex u = he_origin(m, h), v = he_target(m, h);
    he_vec3 place = to != NULL ? *to : he_point_between(he_position(m, u), he_position(m, v), t);
    status = check_marks(m, h, place, err);
    if (status != HE_OK) {
        return status;
    }
    he_reservation need = {.deleted_vertices = 1, .deleted_edges = 3, .deleted_faces = 2};
    need.links = (size_t)he_vertex_degree(m, u) + 24 + HE_SETTLE_LINKS;
    need.positions = 1;
    need.attributes = 5;
    need.lineage = 3;
    status = he_reserve(m, need, err);
    if (status != HE_OK) {
        return status;
    }
    /* Nothing below can fail. */
    commit(m, h, place, mix);
    return HE_OK;
}

/* --- the common case: triangles inside a mesh without attributes --- */

/* The most links that write_collapse writes in elements that stay, beside the origins of the edges
 * that move to the target. */
enum { COLLAPSE_LINKS = 16 };

/* Prefetches what write_collapse reads or writes and may_collapse does not read before. */
HE_PEN_INLINE void prefetch(const he_content *c, const he_diamond *q)
{
    __builtin_prefetch(&c->position[q->a], 1);
    __builtin_prefetch(&c->position[q->b], 1);
    __builtin_prefetch(&c->face[q->ca], 1);
    __builtin_prefetch(&c->face[q->bc], 1);
    __builtin_prefetch(&c->face[q->ad], 1);
    __builtin_prefetch(&c->face[q->db], 1);
    __builtin_prefetch(&c->face_halfedge[q->f], 1);
    __builtin_prefetch(&c->face_halfedge[q->g], 1);
    __builtin_prefetch(&c->vertex_halfedge[q->c], 1);
    __builtin_prefetch(&c->vertex_halfedge[q->d], 1);
}

/* Gathers the half-edges around both ends of h. Returns true if the collapse is certainly allowed:
 * both ends are inside the mesh and have few edges, the origin has at least four and only triangles
 * around it, and the ends have no common neighbour but the opposite corners of the two triangles
 * beside the edge. */
HE_PEN_INLINE bool may_collapse(const he_mesh *m, const he_diamond *q, ring *of_u, ring *of_v)
{
    const he_content *c = &m->c;
    if (c->face[c->vertex_halfedge[q->a]] == HE_NONE ||
        c->face[c->vertex_halfedge[q->b]] == HE_NONE ||
        !gather(m, (he_halfedge){q->h}, of_u, of_v) || of_u->count < 4) {
        return false;
    }
    for (uint32_t i = 1; i + 1 < of_u->count; i++) {
        const uint32_t k = of_u->out[i], side = of_u->out[i + 1] ^ 1u;
        if (c->prev[side] != c->next[k] || (i > 1 && is_in(of_v, of_u->target[i]))) {
            return false;
        }
    }
    return true;
}

/* Puts half-edge `kept` in place of `outer` into the loop of the triangle to the left of `outer`.
 */
HE_PEN_INLINE void replace_side(he_pen *pen, uint32_t kept, he_halfedge_links was, uint32_t outer,
                                he_halfedge_links to)
{
    he_pen_next(pen, kept, was.next, to.next);
    he_pen_prev(pen, kept, was.prev, to.prev);
    he_pen_face(pen, kept, was.face, to.face);
    he_pen_prev(pen, to.next, outer, kept);
    he_pen_next(pen, to.prev, outer, kept);
    he_pen_face_exchange(pen, to.face, outer, outer, kept);
}

/* Writes what commit() writes. In the names of a diamond, a is the vertex that is deleted: its
 * edges `h`, `ca` and `ad` are deleted, `bc` and `db` stay. */
HE_PEN_INLINE void write_collapse(he_pen *pen, const he_diamond *q, const ring *of_a, he_vec3 place)
{
    he_content *c = pen->content;
    const uint32_t ac = q->ca ^ 1u, da = q->ad ^ 1u;
    const he_halfedge_links beyond_c = {c->next[ac], c->prev[ac], q->a, c->face[ac]};
    const he_halfedge_links beyond_d = {c->next[da], c->prev[da], q->d, c->face[da]};
    const he_halfedge_links h = {q->bc, q->ca, q->a, q->f}, t = {q->ad, q->db, q->b, q->g};
    const he_halfedge_links ca = {q->h, q->bc, q->c, q->f}, ad = {q->db, q->t, q->a, q->g};
    for (uint32_t i = 2; i + 1 < of_a->count; i++) {
        he_pen_origin(pen, of_a->out[i], q->a, q->b);
    }
    replace_side(pen, q->bc, (he_halfedge_links){q->ca, q->h, q->b, q->f}, ac, beyond_c);
    replace_side(pen, q->db, (he_halfedge_links){q->t, q->ad, q->d, q->g}, da, beyond_d);
    he_pen_vertex_exchange(pen, q->c, q->ca, q->bc ^ 1u);
    he_pen_vertex_exchange(pen, q->d, da, q->db);
    he_pen_vertex_exchange(pen, q->b, q->t, q->bc);
    const bool left = (q->h & 1u) == 0;
    he_pen_delete_edge(pen, q->h >> 1, (const he_halfedge_links[2]){left ? h : t, left ? t : h});
    const bool first = (q->ca & 1u) == 0;
    he_pen_delete_edge(pen, q->ca >> 1,
                       (const he_halfedge_links[2]){first ? ca : beyond_c, first ? beyond_c : ca});
    const bool second = (q->ad & 1u) == 0;
    he_pen_delete_edge(
        pen, q->ad >> 1,
        (const he_halfedge_links[2]){second ? ad : beyond_d, second ? beyond_d : ad});
    he_pen_delete_face(pen, q->f);
    he_pen_delete_face(pen, q->g);
    he_pen_position(pen, q->b, place);
    he_pen_delete_vertex(pen, q->a);
    he_pen_merged(pen, HE_EDGE, q->ca >> 1, q->bc >> 1);
    he_pen_merged(pen, HE_EDGE, q->ad >> 1, q->db >> 1);
    he_pen_merged(pen, HE_VERTEX, q->a, q->b);
}

/* Collapses the edge of half-edge h in the common case. Returns false, and does nothing, in any
 * other case. `recording` says whether a delta records. The function is compiled once for each
 * value of `recording`. */
HE_PEN_INLINE bool collapse_common(he_mesh *m, he_halfedge h, double t, const he_vec3 *to,
                                   bool recording)
{
    he_diamond q;
    ring of_u, of_v;
    static const he_reservation need = {.deleted_vertices = 1,
                                        .deleted_edges = 3,
                                        .deleted_faces = 2,
                                        .links = SMALL_RING + COLLAPSE_LINKS,
                                        .positions = 1,
                                        .lineage = 3};
    if (!he_has_room(m, &need) || !(t >= 0 && t <= 1) || (to != NULL && !he_point_is_finite(*to)) ||
        !he_diamond_read_from(m, h, &q)) {
        return false;
    }
    prefetch(&m->c, &q);
    if (!may_collapse(m, &q, &of_u, &of_v)) {
        return false;
    }
    he_vec3 place = to != NULL ? *to : he_point_between(m->c.position[q.a], m->c.position[q.b], t);
    he_pen pen = he_pen_begin(m, recording);
    write_collapse(&pen, &q, &of_u, place);
    he_pen_end(&pen, m);
    return true;
}

static __attribute__((noinline)) bool collapse_unrecorded(he_mesh *m, he_halfedge h, double t,
                                                          const he_vec3 *to)
{
    return collapse_common(m, h, t, to, false);
}

static __attribute__((noinline)) bool collapse_recorded(he_mesh *m, he_halfedge h, double t,
                                                        const he_vec3 *to)
{
    return collapse_common(m, h, t, to, true);
}

static he_status collapse(he_mesh *m, he_halfedge h, double t, const he_vec3 *to, double mix,
                          he_error *err)
{
    if (m->delta == NULL ? collapse_unrecorded(m, h, t, to) : collapse_recorded(m, h, t, to)) {
        return HE_OK;
    }
    return collapse_any(m, h, t, to, mix, err);
}

he_status he_edge_collapse(he_mesh *m, he_halfedge h, double t, const he_vec3 *to,
                           he_vertex *vertex, he_error *err)
{
    bool live = h.i < 2 * m->c.edges.issued;
    he_vertex v = live ? he_target(m, h) : (he_vertex){HE_NONE};
    he_status status = collapse(m, h, t, to, to != NULL ? 0.5 : t, err);
    if (status == HE_OK && vertex != NULL) {
        *vertex = v;
    }
    return status;
}

he_status he_edge_collapse_at(he_mesh *m, he_halfedge h, double t, he_vec3 to, he_error *err)
{
    return collapse(m, h, t, &to, t, err);
}
