#include "edit/border/loop_join.h"

#include "edit/piece/keep.h"
#include "edit/piece/point.h"
#include "edit/piece/ring.h"
#include "mesh/marks.h"
#include "query/idmap.h"

/* The plan of a join of two loops: half-edge a[i] is joined to b[i]. The first loop is listed
 * forwards, the second backwards. So vertex i of the first loop is the origin of a[i], and vertex i
 * of the second loop is the target of b[i]. */
typedef struct plan {
    he_mesh *m;
    he_ids a, b;
    uint32_t n;
    /* the n vertices of the second loop, followed by the n vertices of the first */
    he_idmap vertices;
} plan;

static void clear(plan *p)
{
    he_ids_clear(&p->a);
    he_ids_clear(&p->b);
    he_idmap_clear(&p->vertices);
}

static he_halfedge side_of_a(const plan *p, uint32_t i)
{
    return (he_halfedge){p->a.ids[i]};
}

static he_halfedge side_of_b(const plan *p, uint32_t i)
{
    return (he_halfedge){p->b.ids[i]};
}

static he_vertex stays(const plan *p, uint32_t i)
{
    return (he_vertex){p->vertices.ids.ids[p->n + i]};
}

static he_vertex goes(const plan *p, uint32_t i)
{
    return (he_vertex){p->vertices.ids.ids[i]};
}

/* Returns the vertex into which the join merges v, or v itself if it is not merged. */
static he_vertex becomes(const plan *p, he_vertex v)
{
    uint32_t i = he_idmap_find(&p->vertices, v.i);
    return i < p->n ? stays(p, i) : v;
}

static he_vec3 place(const plan *p, uint32_t i)
{
    return he_point_between(he_position(p->m, stays(p, i)), he_position(p->m, goes(p, i)), 0.5);
}

/* --- the two loops --- */

static he_status find_loops(plan *p, he_halfedge a, he_halfedge b, he_error *err)
{
    he_status status = HE_OK;
    he_halfedge h = a;
    do {
        if (h.i == b.i) {
            return he_fail(err, HE_SAME_LOOP, HE_HALFEDGE, b.i,
                           "half-edges %u and %u lie on the same loop", a.i, b.i);
        }
        status = he_ids_add(&p->a, h.i, err);
        h = he_next(p->m, h);
    } while (status == HE_OK && h.i != a.i);
    h = b;
    do {
        status = status == HE_OK ? he_ids_add(&p->b, h.i, err) : status;
        h = he_prev(p->m, h);
    } while (status == HE_OK && h.i != b.i);
    if (status == HE_OK && p->a.count != p->b.count) {
        return he_fail(
            err, HE_LOOP_LENGTH, HE_HALFEDGE, b.i,
            "the loop of half-edge %u has %zu edges, but the loop of half-edge %u has %zu", a.i,
            p->a.count, b.i, p->b.count);
    }
    p->n = (uint32_t)p->a.count;
    return status;
}

static he_status find_vertices(plan *p, he_error *err)
{
    uint32_t index = 0;
    bool added = true;
    he_status status = HE_OK;
    for (uint32_t i = 0; status == HE_OK && i < 2 * p->n; i++) {
        he_vertex v =
            i < p->n ? he_target(p->m, side_of_b(p, i)) : he_origin(p->m, side_of_a(p, i - p->n));
        status = he_idmap_add(&p->vertices, v.i, &index, &added, err);
        if (status == HE_OK && !added) {
            return i >= p->n && index < p->n
                       ? he_fail(err, HE_SHARED_VERTEX, HE_VERTEX, v.i,
                                 "vertex %u lies on both loops", v.i)
                       : he_fail(err, HE_REPEATED_CORNER, HE_VERTEX, v.i,
                                 "one of the two loops passes vertex %u twice", v.i);
        }
    }
    return status;
}

static he_status check_sides(const plan *p, he_error *err)
{
    for (uint32_t i = 0; i < p->n; i++) {
        uint32_t e = he_edge_of(side_of_a(p, i)).i, f = he_edge_of(side_of_b(p, i)).i;
        if (he_is_boundary_halfedge(p->m, he_twin(side_of_a(p, i))) &&
            he_is_boundary_halfedge(p->m, he_twin(side_of_b(p, i)))) {
            return he_fail(err, HE_BOUNDARY_EDGE, HE_EDGE, e,
                           "edges %u and %u would merge into an edge that has no face", e, f);
        }
    }
    return HE_OK;
}

/* --- checks that no face or edge becomes invalid --- */

/* Adds the faces around the origin of `first` to the set `seen`. It leaves out the face of
 * half-edge `own`, which belongs to a joined loop. If `again` is true, it refuses a face that is
 * already in the set. */
static he_status gather_faces(const plan *p, he_halfedge own, he_halfedge first, bool again,
                              he_idmap *seen, he_error *err)
{
    he_halfedge h = first;
    uint32_t loop = he_face_of(p->m, own).i;
    do {
        uint32_t index, f = he_face_of(p->m, h).i;
        bool added = true;
        if (f != HE_NONE && f != loop) {
            he_status status = he_idmap_add(seen, f, &index, &added, err);
            if (status != HE_OK) {
                return status;
            }
        }
        if (again && !added) {
            return he_fail(err, HE_REPEATED_CORNER, HE_FACE, f,
                           "face %u has two corners that would become the same vertex", f);
        }
        h = he_swing_ccw(p->m, h);
    } while (h.i != first.i);
    return HE_OK;
}

static he_status check_faces(const plan *p, uint32_t i, he_error *err)
{
    he_idmap seen = {.log2 = 0};
    he_halfedge a = side_of_a(p, i), b = he_twin(side_of_b(p, i));
    he_status status = gather_faces(p, a, a, false, &seen, err);
    if (status == HE_OK) {
        status = gather_faces(p, he_twin(b), b, true, &seen, err);
    }
    he_idmap_clear(&seen);
    return status;
}

/* Adds the neighbours of the origin of `first` to the set `seen`, as they will be after the join.
 * It leaves out the half-edges in `skip`, and refuses a neighbour that is already in the set. */
static he_status gather_neighbours(const plan *p, he_halfedge first, const he_halfedge skip[2],
                                   he_idmap *seen, he_error *err)
{
    he_halfedge h = first;
    do {
        uint32_t index;
        bool added = true;
        if (h.i != skip[0].i && h.i != skip[1].i) {
            he_status status =
                he_idmap_add(seen, becomes(p, he_target(p->m, h)).i, &index, &added, err);
            if (status != HE_OK) {
                return status;
            }
        }
        if (!added) {
            uint32_t e = he_edge_of(h).i;
            return he_fail(err, HE_DOUBLED_EDGE, HE_EDGE, e,
                           "edge %u and another edge would join the same two vertices", e);
        }
        h = he_swing_ccw(p->m, h);
    } while (h.i != first.i);
    return HE_OK;
}

/* Checks that after the join no two edges at vertex i of the loops join one pair of vertices. The
 * edges of the second loop are left out, because they are merged into edges of the first loop. */
static he_status check_neighbours(const plan *p, uint32_t i, he_error *err)
{
    he_idmap seen = {.log2 = 0};
    const he_halfedge none[2] = {{HE_NONE}, {HE_NONE}};
    he_halfedge b = he_twin(side_of_b(p, i));
    const he_halfedge own[2] = {b, side_of_b(p, i == 0 ? p->n - 1 : i - 1)};
    he_status status = gather_neighbours(p, side_of_a(p, i), none, &seen, err);
    if (status == HE_OK) {
        status = gather_neighbours(p, b, own, &seen, err);
    }
    he_idmap_clear(&seen);
    return status;
}

/* --- marks --- */

static he_status check_vertex_locks(const plan *p, const he_marks *marks, uint32_t i, he_error *err)
{
    const he_mesh *m = p->m;
    he_vec3 from = he_position(m, stays(p, i)), to = place(p, i);
    he_status status = he_require_unlocked(marks, HE_VERTEX, goes(p, i).i, err);
    if (status == HE_OK && (from.x != to.x || from.y != to.y || from.z != to.z)) {
        status = he_require_unlocked(marks, HE_VERTEX, stays(p, i).i, err);
    }
    return status == HE_OK ? he_require_unlocked_about(m, marks, he_twin(side_of_b(p, i)), err)
                           : status;
}

static he_status check_marks(const plan *p, he_error *err)
{
    he_marks marks;
    if (!he_marks_find(p->m, &marks)) {
        return HE_OK;
    }
    he_status status =
        he_require_unlocked(&marks, HE_FACE, he_face_of(p->m, side_of_a(p, 0)).i, err);
    for (uint32_t i = 0; status == HE_OK && i < p->n; i++) {
        status = check_vertex_locks(p, &marks, i, err);
    }
    return status;
}

/* --- writing --- */

static he_status reserve(const plan *p, he_error *err)
{
    size_t n = p->n;
    he_reservation need = {.deleted_vertices = n, .deleted_edges = n, .deleted_faces = 2};
    need.links = n * (6 + HE_SETTLE_LINKS);
    for (uint32_t i = 0; i < p->n; i++) {
        need.links += he_vertex_degree(p->m, goes(p, i));
    }
    need.positions = n;
    need.attributes = n;
    need.lineage = 2 * n;
    return he_reserve(p->m, need, err);
}

static void move_ring(he_mesh *m, he_halfedge first, he_vertex to)
{
    he_halfedge h = first;
    do {
        /* he_swing_ccw() reads no origins, so this walk may change origins on its way. */
        he_set_origin(m, h, to);
        h = he_swing_ccw(m, h);
    } while (h.i != first.i);
}

/* Replaces the twin of b[i] by a[i] in the loop of that twin. If the half-edge before or after this
 * twin is the twin of b[i - 1] or b[i + 1], that half-edge is replaced, too, so a[i] is linked to
 * its replacement a[i - 1] or a[i + 1]. */
static void sew_side(const plan *p, uint32_t i)
{
    he_mesh *m = p->m;
    uint32_t before = i == 0 ? p->n - 1 : i - 1, after = i + 1 == p->n ? 0 : i + 1;
    he_halfedge a = side_of_a(p, i), outer = he_twin(side_of_b(p, i));
    he_halfedge prev = he_prev(m, outer), next = he_next(m, outer);
    he_face f = he_face_of(m, outer);
    if (prev.i == he_twin(side_of_b(p, before)).i) {
        prev = side_of_a(p, before);
    }
    if (next.i == he_twin(side_of_b(p, after)).i) {
        next = side_of_a(p, after);
    }
    he_link(m, prev, a);
    he_link(m, a, next);
    he_set_face(m, a, f);
    if (f.i != HE_NONE && he_face_halfedge(m, f).i == outer.i) {
        he_set_face_halfedge(m, f, a);
    }
    he_attributes_move(m, HE_HALFEDGE, a.i, outer.i);
}

static void commit(const plan *p)
{
    he_mesh *m = p->m;
    const he_face faces[2] = {he_face_of(m, side_of_a(p, 0)), he_face_of(m, side_of_b(p, 0))};
    for (uint32_t i = 0; i < p->n; i++) {
        move_ring(m, he_twin(side_of_b(p, i)), stays(p, i));
    }
    for (uint32_t i = 0; i < p->n; i++) {
        sew_side(p, i);
    }
    for (uint32_t i = 0; i < p->n; i++) {
        he_vertex into = stays(p, i), gone = goes(p, i);
        he_edge kept = he_edge_of(side_of_a(p, i)), dropped = he_edge_of(side_of_b(p, i));
        he_set_position(m, into, place(p, i));
        he_note_merged(m, HE_VERTEX, gone.i, into.i);
        he_note_merged(m, HE_EDGE, dropped.i, kept.i);
        he_delete_vertex(m, gone);
        he_delete_edge(m, dropped);
    }
    for (unsigned k = 0; k < 2; k++) {
        if (faces[k].i != HE_NONE) {
            he_delete_face(m, faces[k]);
        }
    }
    for (uint32_t i = 0; i < p->n; i++) {
        he_ring_settle(m, stays(p, i), side_of_a(p, i));
    }
}

static he_status check(plan *p, he_halfedge a, he_halfedge b, he_error *err)
{
    he_status status = he_mesh_require(p->m, HE_HALFEDGE, a.i, err);
    if (status == HE_OK) {
        status = he_mesh_require(p->m, HE_HALFEDGE, b.i, err);
    }
    if (status == HE_OK) {
        status = find_loops(p, a, b, err);
    }
    if (status == HE_OK) {
        status = find_vertices(p, err);
    }
    if (status == HE_OK) {
        status = check_sides(p, err);
    }
    for (uint32_t i = 0; status == HE_OK && i < p->n; i++) {
        status = check_faces(p, i, err);
    }
    for (uint32_t i = 0; status == HE_OK && i < p->n; i++) {
        status = check_neighbours(p, i, err);
    }
    return status == HE_OK ? check_marks(p, err) : status;
}

/* Performs the join. First moves the attribute values that merged vertices would lose to corners;
 * if the join fails, moves them back. */
static he_status write(plan *p, uint64_t *moved, he_error *err)
{
    const uint32_t *ids = p->vertices.ids.ids;
    const he_keep_pairs pairs = {ids, ids + p->n, p->n};
    he_keeping kept;
    he_status status = he_keep_begin(p->m, &pairs, &kept, err);
    if (status != HE_OK) {
        return status;
    }
    status = reserve(p, err);
    if (status == HE_OK) {
        /* Nothing below can fail. */
        commit(p);
    }
    return he_keep_end(p->m, &kept, status, moved);
}

he_status he_loop_join(he_mesh *m, he_halfedge a, he_halfedge b, uint64_t *moved, he_error *err)
{
    plan p = {.m = m};
    he_status status = check(&p, a, b, err);
    if (status == HE_OK) {
        status = write(&p, moved, err);
    }
    clear(&p);
    return status;
}
