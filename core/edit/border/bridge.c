#include "edit/border/bridge.h"

#include "edit/piece/ring.h"
#include "geometry/vec3.h"
#include "query/idmap.h"

#include <assert.h>

void he_bridge_clear(he_bridge *bridge)
{
    he_ids_clear(&bridge->edges);
    he_ids_clear(&bridge->faces);
}

/* The plan of a strip of faces between two boundary loops. The arrays a and b list the half-edges
 * of the loops: corner i of the first loop is the origin of a[i], corner j of the second loop is
 * the target of b[j]. The second loop is listed backwards, because the two loops run in opposite
 * directions along the strip. */
typedef struct plan {
    const he_mesh *m;
    he_ids a, b;
    /* The new edges between the loops, called rungs. Each is a pair of numbers: a corner of the
     * first loop and a corner of the second loop. */
    he_ids rungs;
    he_idmap corners; /* all vertices of the first loop, followed by those of the second */
    bool repeats;     /* true if a loop passes a vertex twice */
    double scale;     /* a power of two; multiplied by it, all coordinates lie in [-1, 1] */
} plan;

static void clear(plan *p)
{
    he_ids_clear(&p->a);
    he_ids_clear(&p->b);
    he_ids_clear(&p->rungs);
    he_idmap_clear(&p->corners);
}

static he_vertex corner_of_a(const plan *p, uint32_t i)
{
    return he_origin(p->m, (he_halfedge){p->a.ids[i]});
}

static he_vertex corner_of_b(const plan *p, uint32_t j)
{
    return he_target(p->m, (he_halfedge){p->b.ids[j]});
}

/* --- the two loops --- */

static he_status require_hole(const he_mesh *m, he_halfedge h, he_error *err)
{
    he_status status = he_mesh_require(m, HE_HALFEDGE, h.i, err);
    if (status == HE_OK && !he_is_boundary_halfedge(m, h)) {
        return he_fail(err, HE_NOT_BOUNDARY, HE_HALFEDGE, h.i,
                       "half-edge %u belongs to face %u, so it is not on a boundary", h.i,
                       he_face_of(m, h).i);
    }
    return status;
}

static he_status find_first_loop(plan *p, he_halfedge a, he_halfedge b, he_error *err)
{
    he_halfedge h = a;
    he_status status = HE_OK;
    do {
        uint32_t index;
        bool added = false;
        if (h.i == b.i) {
            return he_fail(err, HE_SAME_LOOP, HE_HALFEDGE, b.i,
                           "half-edges %u and %u lie on the same boundary loop", a.i, b.i);
        }
        status = he_ids_add(&p->a, h.i, err);
        if (status == HE_OK) {
            status = he_idmap_add(&p->corners, he_origin(p->m, h).i, &index, &added, err);
        }
        p->repeats |= !added;
        h = he_next(p->m, h);
    } while (status == HE_OK && h.i != a.i);
    return status;
}

static he_status find_second_loop(plan *p, he_halfedge b, he_error *err)
{
    he_halfedge h = b;
    size_t first = p->corners.ids.count;
    he_status status = HE_OK;
    do {
        uint32_t index = 0, v = he_target(p->m, h).i;
        bool added = false;
        status = he_ids_add(&p->b, h.i, err);
        if (status == HE_OK) {
            status = he_idmap_add(&p->corners, v, &index, &added, err);
        }
        if (status == HE_OK && index < first) {
            return he_fail(err, HE_SHARED_VERTEX, HE_VERTEX, v,
                           "vertex %u lies on both boundary loops", v);
        }
        p->repeats |= !added;
        h = he_prev(p->m, h);
    } while (status == HE_OK && h.i != b.i);
    return status;
}

static void find_scale(plan *p)
{
    enum { MOST_EXPONENT = 1000 };
    double extent = 0;
    for (size_t i = 0; i < p->corners.ids.count; i++) {
        he_vertex v = {p->corners.ids.ids[i]};
        extent = fmax(extent, he_vec3_extent(he_position(p->m, v)));
    }
    int exponent = 0;
    (void)frexp(extent, &exponent);
    p->scale = ldexp(1, -exponent < MOST_EXPONENT ? -exponent : MOST_EXPONENT);
}

/* --- rungs: the edges between the two loops --- */

/* Returns the squared distance, in scaled coordinates, between corner i of the first loop and
 * corner j of the second loop. */
static double apart(const plan *p, uint32_t i, uint32_t j)
{
    he_vec3 x = he_vec3_scale(he_position(p->m, corner_of_a(p, i)), p->scale);
    he_vec3 y = he_vec3_scale(he_position(p->m, corner_of_b(p, j)), p->scale);
    he_vec3 way = he_vec3_sub(x, y);
    return he_vec3_dot(way, way);
}

static double twist(const plan *p, uint32_t s)
{
    uint64_t n = p->a.count, m = p->b.count;
    uint64_t pairs = n < HE_TWIST_PAIRS ? n : HE_TWIST_PAIRS;
    double sum = 0;
    for (uint64_t k = 0; k < pairs; k++) {
        uint64_t i = k * n / pairs;
        sum += apart(p, (uint32_t)i, (uint32_t)((s + (2 * i * m + n) / (2 * n)) % m));
    }
    return sum;
}

/* The strip is made face by face. So far it has used i of the n edges of one loop and j of the m
 * edges of the other loop. Returns true if the fractions i / n and j / m differ by less than 1/2.
 * While this holds, a loop that is behind can always advance, because each loop has at least three
 * edges. The condition also ensures that no two rungs join one pair of corners: one side of the
 * strip would have to pass its whole loop while the opposite side stays at one corner. */
static bool is_abreast(uint64_t i, uint64_t n, uint64_t j, uint64_t m)
{
    uint64_t x = i * m, y = j * n;
    return 2 * (x > y ? x - y : y - x) < n * m;
}

static bool steps_along_a(const plan *p, uint32_t i, uint32_t j, uint32_t s)
{
    uint32_t n = (uint32_t)p->a.count, m = (uint32_t)p->b.count;
    if (i == n || j == m) {
        return j == m;
    }
    if (!is_abreast(i + 1, n, j, m)) {
        return false;
    }
    return !is_abreast(i, n, j + 1, m) ||
           apart(p, (i + 1) % n, (s + j) % m) <= apart(p, i % n, (s + j + 1) % m);
}

/* Computes the rungs (the new edges between the loops) if corner 0 of the first loop is paired with
 * corner s of the second loop. The caller has reserved memory for the list of rungs. */
static void make_rungs(plan *p, uint32_t s)
{
    uint32_t n = (uint32_t)p->a.count, m = (uint32_t)p->b.count;
    p->rungs.count = 0;
    for (uint32_t i = 0, j = 0; i < n || j < m;) {
        p->rungs.ids[p->rungs.count++] = i % n;
        p->rungs.ids[p->rungs.count++] = (s + j) % m;
        bool along_a = n == m || steps_along_a(p, i, j, s);
        j += n == m || !along_a;
        i += along_a;
    }
}

static he_status refuse_rung(const plan *p, uint32_t i, uint32_t j, he_error *err)
{
    he_vertex u = corner_of_a(p, i), v = corner_of_b(p, j);
    uint32_t e = he_edge_of(he_find_halfedge(p->m, u, v)).i;
    return he_fail(err, HE_DOUBLED_EDGE, HE_EDGE, e, "edge %u already joins vertices %u and %u", e,
                   u.i, v.i);
}

/* Refuses a pairing of corners in which two rungs (new edges) would join one pair of vertices. This
 * is possible if a loop passes a vertex twice. `first` and `next` are buffers for linked lists of
 * the rungs at each vertex of the first loop. */
static he_status compare_rungs(const plan *p, uint32_t *first, uint32_t *next, he_error *err)
{
    he_ids ends = {0};
    he_status status = HE_OK;
    for (size_t v = 0; v < p->corners.ids.count; v++) {
        first[v] = HE_NONE;
    }
    for (uint32_t k = 0; k < p->rungs.count / 2; k++) {
        uint32_t v = he_idmap_find(&p->corners, corner_of_a(p, p->rungs.ids[2 * (size_t)k]).i);
        next[k] = first[v];
        first[v] = k;
    }
    for (size_t v = 0; status == HE_OK && v < p->corners.ids.count; v++) {
        size_t count = 0;
        ends.count = 0;
        for (uint32_t k = first[v]; status == HE_OK && k != HE_NONE; k = next[k]) {
            count++;
            status = he_ids_add(&ends, corner_of_b(p, p->rungs.ids[2 * (size_t)k + 1]).i, err);
        }
        if (status == HE_OK) {
            status = he_ids_sort(&ends, err);
        }
        if (status == HE_OK && ends.count < count) {
            uint32_t id = p->corners.ids.ids[v];
            status = he_fail(err, HE_DOUBLED_EDGE, HE_VERTEX, id,
                             "two new edges at vertex %u would join the same two vertices, because "
                             "a boundary loop passes that vertex twice",
                             id);
        }
    }
    he_ids_clear(&ends);
    return status;
}

static he_status check_rungs(const plan *p, he_error *err)
{
    for (size_t k = 0; k < p->rungs.count; k += 2) {
        uint32_t i = p->rungs.ids[k], j = p->rungs.ids[k + 1];
        if (he_find_halfedge(p->m, corner_of_a(p, i), corner_of_b(p, j)).i != HE_NONE) {
            return refuse_rung(p, i, j, err);
        }
    }
    if (!p->repeats) {
        return HE_OK;
    }
    uint32_t *first = he_mem_array(NULL, p->corners.ids.count, sizeof *first);
    uint32_t *next = he_mem_array(NULL, p->rungs.count / 2, sizeof *next);
    he_status status = first != NULL && next != NULL
                           ? compare_rungs(p, first, next, err)
                           : he_fail_plain(err, HE_NO_MEMORY, "no memory to compare %zu edges",
                                           p->rungs.count / 2);
    he_mem_free(first);
    he_mem_free(next);
    return status;
}

/* --- the pairing of corners --- */

/* Pairing s joins each corner i of the first loop to corner i + s of the second loop. If an edge
 * already joins two such corners, pairing s is impossible, and this function marks it in `passed`.
 * It may be called only if the loops are equally long and no loop passes a vertex twice: the index
 * of a vertex in p->corners is then the number of its corner. */
static void pass_over_joined(const plan *p, uint64_t *passed)
{
    uint32_t n = (uint32_t)p->a.count;
    for (uint32_t i = 0; i < n; i++) {
        he_halfedge first = {p->a.ids[i]}, h = first;
        do {
            uint32_t index = he_idmap_find(&p->corners, he_target(p->m, h).i);
            if (index != HE_NONE && index >= n) {
                he_bits_set(passed, (index - i) % n);
            }
            h = he_swing_ccw(p->m, h);
        } while (h.i != first.i);
    }
}

/* Returns the pairing of corners with the smallest twist (the sum of squared distances between
 * paired corners, see bridge.h) that is not marked in `passed`, or `count` if all pairings are
 * marked. If `passed` is NULL, no pairing is marked. */
static uint32_t least_twisted(const double *twists, uint32_t count, const uint64_t *passed)
{
    uint32_t best = count;
    for (uint32_t s = 0; s < count; s++) {
        bool open = passed == NULL || !he_bits_get(passed, s);
        best = open && (best == count || twists[s] < twists[best]) ? s : best;
    }
    return best;
}

static he_status try_pairings(plan *p, const double *twists, uint64_t *passed, he_error *err)
{
    uint32_t count = (uint32_t)p->b.count;
    if (p->a.count == count && !p->repeats) {
        pass_over_joined(p, passed);
    }
    for (unsigned i = 0; i < HE_TWIST_TRIES; i++) {
        he_error why = {.status = HE_OK};
        uint32_t s = least_twisted(twists, count, passed);
        if (s == count) {
            break;
        }
        make_rungs(p, s);
        he_status status = check_rungs(p, &why);
        if (status != HE_DOUBLED_EDGE) {
            if (status != HE_OK && err != NULL) {
                *err = why;
            }
            return status;
        }
        he_bits_set(passed, s);
    }
    make_rungs(p, least_twisted(twists, count, NULL));
    return check_rungs(p, err);
}

static he_status choose_rungs(plan *p, he_error *err)
{
    size_t n = p->a.count, m = p->b.count;
    /* A loop of two half-edges would consist of two edges that join one pair of vertices, which
     * invariant I10 of mesh.h forbids. */
    assert(n >= 3 && m >= 3);
    he_status status = he_ids_reserve(&p->rungs, 2 * (n + m), err);
    if (status != HE_OK) {
        return status;
    }
    double *twists = he_mem_array(NULL, m, sizeof *twists);
    uint64_t *passed = he_bits_new(m);
    if (twists == NULL || passed == NULL) {
        status = he_fail_plain(err, HE_NO_MEMORY,
                               "no memory to compare %zu ways to join the two loops", m);
    }
    for (uint32_t s = 0; status == HE_OK && s < m; s++) {
        twists[s] = twist(p, s);
    }
    if (status == HE_OK) {
        status = try_pairings(p, twists, passed, err);
    }
    he_mem_free(twists);
    he_mem_free(passed);
    return status;
}

/* --- writing --- */

/* Makes the face of the strip between rung `at` and the next rung. The face is a triangle if the
 * two rungs have a common end, else a quad. */
static he_face close_face(he_mesh *m, const plan *p, size_t at, const he_ids *edges)
{
    size_t count = p->rungs.count / 2, after = at + 1 == count ? 0 : at + 1;
    const uint32_t *from = p->rungs.ids + 2 * at, *to = p->rungs.ids + 2 * after;
    he_halfedge rung = {2 * edges->ids[after]}, back = {2 * edges->ids[at] + 1};
    he_halfedge a = {p->a.ids[from[0]]}, b = {p->b.ids[from[1]]};
    bool has_a = from[0] != to[0], has_b = from[1] != to[1];
    he_face f = he_new_face(m);
    he_set_face_halfedge(m, f, has_a ? a : b);
    he_set_face(m, rung, f);
    he_set_face(m, back, f);
    if (has_a) {
        he_set_face(m, a, f);
        he_link(m, back, a);
        he_link(m, a, rung);
    } else {
        he_link(m, back, rung);
    }
    if (has_b) {
        he_set_face(m, b, f);
        he_link(m, rung, b);
        he_link(m, b, back);
    } else {
        he_link(m, rung, back);
    }
    return f;
}

static void commit(he_mesh *m, const plan *p, he_bridge *made)
{
    size_t count = p->rungs.count / 2;
    for (size_t k = 0; k < count; k++) {
        he_edge e = he_new_edge(m);
        he_set_origin(m, he_edge_halfedge(e, 0), corner_of_a(p, p->rungs.ids[2 * k]));
        he_set_origin(m, he_edge_halfedge(e, 1), corner_of_b(p, p->rungs.ids[2 * k + 1]));
        made->edges.ids[made->edges.count++] = e.i;
    }
    for (size_t k = 0; k < count; k++) {
        made->faces.ids[made->faces.count++] = close_face(m, p, k, &made->edges).i;
    }
    /* he_ring_settle() walks around a vertex, so it is called once for each vertex. Calling it for
     * each rung would be slow at a vertex with many rungs. */
    for (size_t k = 0; k < p->corners.ids.count; k++) {
        he_vertex v = {p->corners.ids.ids[k]};
        he_ring_settle(m, v, he_vertex_halfedge(m, v));
    }
}

static he_status make_plan(plan *p, he_halfedge a, he_halfedge b, he_error *err)
{
    he_status status = require_hole(p->m, a, err);
    if (status == HE_OK) {
        status = require_hole(p->m, b, err);
    }
    if (status == HE_OK) {
        status = find_first_loop(p, a, b, err);
    }
    if (status == HE_OK) {
        status = find_second_loop(p, b, err);
    }
    if (status == HE_OK) {
        find_scale(p);
        status = choose_rungs(p, err);
    }
    return status;
}

he_status he_loop_bridge(he_mesh *m, he_halfedge a, he_halfedge b, he_bridge *out, he_error *err)
{
    plan p = {.m = m};
    he_bridge made = {.edges = {0}};
    he_status status = make_plan(&p, a, b, err);
    size_t count = p.rungs.count / 2;
    if (status == HE_OK) {
        status = he_ids_reserve(&made.edges, count, err);
    }
    if (status == HE_OK) {
        status = he_ids_reserve(&made.faces, count, err);
    }
    if (status == HE_OK) {
        he_reservation need = {.edges = (uint32_t)count, .faces = (uint32_t)count};
        need.links = 3 * (p.a.count + p.b.count) + HE_SETTLE_LINKS * p.corners.ids.count;
        status = he_reserve(m, need, err);
    }
    if (status == HE_OK) {
        /* Nothing below can fail. */
        commit(m, &p, &made);
        if (out != NULL) {
            *out = made;
            made = (he_bridge){.edges = {0}};
        }
    }
    he_bridge_clear(&made);
    clear(&p);
    return status;
}
