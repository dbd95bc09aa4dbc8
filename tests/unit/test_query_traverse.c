/* Tests of searches and paths from element to element: the results are compared with distances by
 * the algorithm of Floyd and Warshall, and with results found by hand. */
#include "query_specimens.h"

#include "geometry/geometry.h"
#include "query/traverse.h"
#include "tests/failing.h"

#include <float.h>
#include <math.h>

static void assert_ids(const he_ids *ids, const char *wanted)
{
    char text[512] = "";
    for (size_t i = 0; i < ids->count; i++) {
        size_t used = strlen(text);
        snprintf(text + used, sizeof text - used, i == 0 ? "%u" : " %u", ids->ids[i]);
    }
    assert_string_equal(text, wanted);
}

enum { SMALL = 100 };

/* Distances between all pairs of vertices, or between all pairs of faces; the distance is INFINITY
 * if the two elements are not connected. */
typedef struct distances {
    double d[SMALL][SMALL];
    uint32_t n;
} distances;

static void distances_find(distances *t, const he_mesh *m, he_kind kind, bool by_length)
{
    t->n = he_mesh_issued(m, kind);
    assert_true(t->n <= SMALL);
    for (uint32_t i = 0; i < t->n; i++) {
        for (uint32_t j = 0; j < t->n; j++) {
            t->d[i][j] = i == j ? 0 : INFINITY;
        }
    }
    for (uint32_t e = 0; e < he_mesh_issued(m, HE_EDGE); e++) {
        if (!he_mesh_is_live(m, HE_EDGE, e)) {
            continue;
        }
        const uint32_t *side = kind == HE_VERTEX ? m->c.origin : m->c.face;
        uint32_t a = side[2 * e], b = side[2 * e + 1];
        if (a == HE_NONE || b == HE_NONE) {
            continue;
        }
        he_vec3 p = m->c.position[m->c.origin[2 * e]], q = m->c.position[m->c.origin[2 * e + 1]];
        double length = sqrt(pow(p.x - q.x, 2) + pow(p.y - q.y, 2) + pow(p.z - q.z, 2));
        double step = by_length ? length : 1;
        t->d[a][b] = t->d[b][a] = fmin(t->d[a][b], step);
    }
    for (uint32_t k = 0; k < t->n; k++) {
        for (uint32_t i = 0; i < t->n; i++) {
            for (uint32_t j = 0; j < t->n; j++) {
                t->d[i][j] = fmin(t->d[i][j], t->d[i][k] + t->d[k][j]);
            }
        }
    }
}

static void try_breadth_first(const he_mesh *m, he_kind kind)
{
    distances t;
    distances_find(&t, m, kind, false);
    for (uint32_t from = 0; from < t.n; from++) {
        if (!he_mesh_is_live(m, kind, from)) {
            continue;
        }
        for (uint32_t depth = 0; depth < 6; depth++) {
            he_ids ids = {0}, depths = {0};
            uint32_t bound = depth == 5 ? HE_NONE : depth;
            assert_int_equal(he_traverse_breadth_first(m, &(he_breadth_first){kind, from, bound, 0},
                                                       &ids, &depths, NULL),
                             HE_OK);
            assert_int_equal(ids.count, depths.count);
            assert_int_equal(ids.ids[0], from);
            bool seen[SMALL] = {false};
            for (size_t i = 0; i < ids.count; i++) {
                assert_false(seen[ids.ids[i]]);
                seen[ids.ids[i]] = true;
                assert_true(t.d[from][ids.ids[i]] == depths.ids[i]);
                assert_true(i == 0 || depths.ids[i] >= depths.ids[i - 1]);
            }
            for (uint32_t i = 0; i < t.n; i++) {
                assert_int_equal(seen[i], t.d[from][i] <= bound && !isinf(t.d[from][i]));
            }
            /* If the number of elements in the answer is limited, the answer must be the beginning
             * of the full answer. */
            for (size_t limit = 1; limit <= ids.count + 1; limit++) {
                he_ids some = {0}, at = {0};
                assert_int_equal(
                    he_traverse_breadth_first(m, &(he_breadth_first){kind, from, bound, limit},
                                              &some, &at, NULL),
                    HE_OK);
                size_t n = limit < ids.count ? limit : ids.count;
                assert_int_equal(some.count, n);
                assert_memory_equal(some.ids, ids.ids, 4 * n);
                assert_memory_equal(at.ids, depths.ids, 4 * n);
                he_ids_clear(&some);
                he_ids_clear(&at);
            }
            he_ids_clear(&ids);
            he_ids_clear(&depths);
        }
    }
}

static void try_paths(const he_mesh *m, he_measure by)
{
    distances t;
    distances_find(&t, m, HE_VERTEX, by == HE_BY_LENGTH);
    for (uint32_t a = 0; a < t.n; a++) {
        for (uint32_t b = 0; b < t.n; b++) {
            if (!he_mesh_is_live(m, HE_VERTEX, a) || !he_mesh_is_live(m, HE_VERTEX, b)) {
                continue;
            }
            he_path path;
            assert_int_equal(
                he_traverse_shortest_path(m, (he_vertex){a}, (he_vertex){b}, by, &path, NULL),
                HE_OK);
            assert_int_equal(path.found, !isinf(t.d[a][b]));
            if (path.found) {
                assert_true(fabs(path.length - t.d[a][b]) <= 1e-12 * (1 + t.d[a][b]));
                assert_int_equal(path.vertices.count, path.edges.count + 1);
                assert_int_equal(path.vertices.ids[0], a);
                assert_int_equal(path.vertices.ids[path.edges.count], b);
                double length = 0;
                for (size_t i = 0; i < path.edges.count; i++) {
                    uint32_t e = path.edges.ids[i], from = path.vertices.ids[i];
                    uint32_t side = m->c.origin[2 * e] == from ? 0 : 1;
                    assert_int_equal(m->c.origin[2 * e + side], from);
                    assert_int_equal(m->c.origin[2 * e + 1 - side], path.vertices.ids[i + 1]);
                    length += by == HE_BY_LENGTH ? he_edge_length(m, (he_edge){e}) : 1;
                }
                assert_true(fabs(length - path.length) <= 1e-12 * (1 + length));
            } else {
                assert_int_equal(path.vertices.count + path.edges.count, 0);
            }
            he_path_clear(&path);
        }
    }
}

static void walks_and_paths_agree_with_the_distances_of_all_pairs(void **state)
{
    (void)state;
    for (size_t i = 0; i <= QUERY_SPECIMENS; i++) {
        he_mesh *m =
            i < QUERY_SPECIMENS ? fixture_mesh(query_specimens[i]) : query_with_dead_rows();
        try_breadth_first(m, HE_VERTEX);
        try_breadth_first(m, HE_FACE);
        try_paths(m, HE_BY_EDGES);
        try_paths(m, HE_BY_LENGTH);
        he_mesh_free(m);
    }
}

static void shortest_paths_are_shortest_at_random_positions(void **state)
{
    (void)state;
    uint64_t seed = 3;
    he_mesh *meshes[] = {query_shape("grid", 8, 9, 1, 1), query_shape("torus", 9, 10, 2, 1),
                         query_shape("icosphere", 1, 1, 0, 0), query_shape("disk", 40, 1, 0, 0)};
    for (size_t i = 0; i < 4; i++) {
        for (uint32_t v = 0; v < he_mesh_issued(meshes[i], HE_VERTEX); v++) {
            he_vec3 *p = &meshes[i]->c.position[v];
            p->x = (double)(query_random(&seed) % 1000);
            p->y = (double)(query_random(&seed) % 1000);
            p->z = (double)(query_random(&seed) % 1000);
        }
        try_paths(meshes[i], HE_BY_EDGES);
        try_paths(meshes[i], HE_BY_LENGTH);
        try_breadth_first(meshes[i], HE_FACE);
        he_mesh_free(meshes[i]);
    }
}

static void a_path_repeats_its_steps_until_count_start_or_boundary(void **state)
{
    (void)state;
    static const he_step next[] = {HE_STEP_NEXT}, prev[] = {HE_STEP_PREV};
    static const he_step turn[] = {HE_STEP_PREV, HE_STEP_TWIN};
    static const he_step round[] = {HE_STEP_TWIN, HE_STEP_NEXT};
    he_mesh *m = fixture_mesh("012,023");
    he_ids ids = {0};
    he_halfedge start = {0};
    /* The half-edges of the first face are 0 (from vertex 0 to 1), 2 (1 to 2) and 4 (2 to 0); the
     * half-edges of the second face are 5 (0 to 2), 6 (2 to 3) and 8 (3 to 0). */
    assert_int_equal(he_traverse_path(m, start, &(he_path_steps){next, 1, 4, HE_UNTIL_COUNT, 0},
                                      NULL, &ids, NULL),
                     HE_OK);
    assert_ids(&ids, "0 2 4 0 2");
    ids.count = 0;
    assert_int_equal(he_traverse_path(m, start, &(he_path_steps){prev, 1, 1, HE_UNTIL_COUNT, 0},
                                      NULL, &ids, NULL),
                     HE_OK);
    assert_ids(&ids, "0 4");
    ids.count = 0;
    assert_int_equal(he_traverse_path(m, start, &(he_path_steps){next, 1, 0, HE_UNTIL_COUNT, 0},
                                      NULL, &ids, NULL),
                     HE_OK);
    assert_ids(&ids, "0");
    ids.count = 0;
    assert_int_equal(he_traverse_path(m, start,
                                      &(he_path_steps){next, 1, UINT64_MAX, HE_UNTIL_START, 0},
                                      NULL, &ids, NULL),
                     HE_OK);
    assert_ids(&ids, "0 2 4 0");
    ids.count = 0;
    assert_int_equal(he_traverse_path(m, start, &(he_path_steps){next, 1, 2, HE_UNTIL_START, 0},
                                      NULL, &ids, NULL),
                     HE_OK);
    assert_ids(&ids, "0 2 4");
    ids.count = 0;
    /* The path turns around vertex 0, from the first face across the diagonal 5 to half-edge 9 (0
     * to 3), which is on the boundary. */
    assert_int_equal(he_traverse_path(m, start,
                                      &(he_path_steps){turn, 2, UINT64_MAX, HE_UNTIL_BOUNDARY, 0},
                                      NULL, &ids, NULL),
                     HE_OK);
    assert_ids(&ids, "0 4 5 8 9");
    ids.count = 0;
    /* The path never meets the boundary. It must end when it returns to a half-edge from which it
     * has already begun its list of steps once. */
    assert_int_equal(he_traverse_path(m, start,
                                      &(he_path_steps){next, 1, UINT64_MAX, HE_UNTIL_BOUNDARY, 0},
                                      NULL, &ids, NULL),
                     HE_OK);
    assert_ids(&ids, "0 2 4 0");
    ids.count = 0;
    assert_int_equal(he_traverse_path(m, (he_halfedge){5},
                                      &(he_path_steps){round, 2, UINT64_MAX, HE_UNTIL_BOUNDARY, 0},
                                      NULL, &ids, NULL),
                     HE_OK);
    assert_ids(&ids, "5 4 0 1");
    /* A path of at most 3 steps is appended to the list: the ids that the list has already must
     * stay. */
    assert_int_equal(he_traverse_path(m, start, &(he_path_steps){next, 1, 3, HE_UNTIL_COUNT, 3},
                                      NULL, &ids, NULL),
                     HE_OK);
    assert_ids(&ids, "5 4 0 1 0 2 4 0");
    ids.count = 1;
    he_error err = {0};
    assert_int_equal(he_traverse_path(m, start, &(he_path_steps){next, 1, 4, HE_UNTIL_COUNT, 3},
                                      NULL, &ids, &err),
                     HE_LIMIT);
    assert_int_equal(he_traverse_path(m, start, &(he_path_steps){next, 0, 4, HE_UNTIL_COUNT, 3},
                                      NULL, &ids, &err),
                     HE_BAD_VALUE);
    assert_int_equal(he_traverse_path(m, (he_halfedge){10},
                                      &(he_path_steps){next, 1, 4, HE_UNTIL_COUNT, 0}, NULL, &ids,
                                      &err),
                     HE_NO_SUCH_ELEMENT);
    assert_ids(&ids, "5");
    he_ids_clear(&ids);
    he_mesh_free(m);
}

static void a_loop_follows_next_around_a_face_or_a_hole(void **state)
{
    (void)state;
    he_mesh *m = fixture_mesh("012,023");
    he_ids ids = {0};
    assert_int_equal(he_traverse_loop(m, (he_halfedge){2}, &ids, NULL), HE_OK);
    assert_ids(&ids, "2 4 0");
    ids.count = 0;
    /* A boundary loop follows the boundary half-edges, against the direction of the faces beside
     * them. */
    assert_int_equal(he_traverse_loop(m, (he_halfedge){1}, &ids, NULL), HE_OK);
    assert_ids(&ids, "1 9 7 3");
    assert_int_equal(he_traverse_loop(m, (he_halfedge){99}, &ids, NULL), HE_NO_SUCH_ELEMENT);
    he_ids_clear(&ids);
    he_mesh_free(m);
}

static uint32_t edge_between(const he_mesh *m, uint32_t a, uint32_t b)
{
    he_halfedge h = he_find_halfedge(m, (he_vertex){a}, (he_vertex){b});
    assert_int_not_equal(h.i, HE_NONE);
    return h.i >> 1;
}

static void expect_chain(const he_mesh *m, bool ring, uint32_t edge, size_t count, bool closed)
{
    he_ids ids = {0};
    bool closes = !closed;
    he_status status = ring ? he_traverse_edge_ring(m, (he_edge){edge}, &ids, &closes, NULL)
                            : he_traverse_edge_loop(m, (he_edge){edge}, &ids, &closes, NULL);
    assert_int_equal(status, HE_OK);
    assert_int_equal(ids.count, count);
    assert_int_equal(closes, closed);
    bool met = false;
    for (size_t i = 0; i < count; i++) {
        met = met || ids.ids[i] == edge;
        for (size_t j = 0; j < i; j++) {
            assert_int_not_equal(ids.ids[i], ids.ids[j]);
        }
        if (i + 1 == count && !closed) {
            break;
        }
        uint32_t e = ids.ids[i], f = ids.ids[(i + 1) % count];
        const uint32_t *o = m->c.origin, *g = m->c.face;
        bool share_vertex = o[2 * e] == o[2 * f] || o[2 * e] == o[2 * f + 1] ||
                            o[2 * e + 1] == o[2 * f] || o[2 * e + 1] == o[2 * f + 1];
        bool share_face =
            (g[2 * e] != HE_NONE && (g[2 * e] == g[2 * f] || g[2 * e] == g[2 * f + 1])) ||
            (g[2 * e + 1] != HE_NONE && (g[2 * e + 1] == g[2 * f] || g[2 * e + 1] == g[2 * f + 1]));
        assert_int_equal(share_vertex, !ring);
        assert_int_equal(share_face, ring);
    }
    assert_true(met);
    assert_true(!closed || ids.ids[0] == edge);
    he_ids_clear(&ids);
}

static void edge_loops_pass_vertices_of_degree_4_and_rings_cross_quads(void **state)
{
    (void)state;
    /* On a torus of quads every edge loop and every edge ring must be closed. */
    he_mesh *m = query_shape("torus", 5, 4, 2, 1);
    for (uint32_t e = 0; e < he_mesh_edges(m); e++) {
        bool tube = m->c.origin[2 * e] / 4 == m->c.origin[2 * e + 1] / 4;
        expect_chain(m, false, e, tube ? 4 : 5, true);
        expect_chain(m, true, e, tube ? 5 : 4, true);
    }
    he_mesh_free(m);
    /* On a grid an edge loop goes from one side to the opposite side. An edge ring does so, too;
     * the ring has one edge more than the number of quads that it crosses. */
    m = query_shape("grid", 4, 3, 1, 1);
    for (uint32_t e = 0; e < he_mesh_edges(m); e++) {
        bool along_x = m->c.origin[2 * e] / 5 == m->c.origin[2 * e + 1] / 5;
        bool rim = he_is_boundary_edge(m, (he_edge){e});
        expect_chain(m, false, e, rim ? 1 : along_x ? 4 : 3, false);
        expect_chain(m, true, e, along_x ? 4 : 5, false);
    }
    he_ids ids = {0};
    bool closed;
    /* The edges of an edge loop are listed in order, beginning at that end of the loop to which one
     * comes from the given edge e by leaving it at the origin of half-edge 2e. The grid has 5
     * vertices in each row. */
    uint32_t e = edge_between(m, 6, 7);
    uint32_t a = edge_between(m, 5, 6), c = edge_between(m, 7, 8), d = edge_between(m, 8, 9);
    assert_int_equal(he_traverse_edge_loop(m, (he_edge){e}, &ids, &closed, NULL), HE_OK);
    char wanted[64];
    if (m->c.origin[2 * e] == 6) {
        snprintf(wanted, sizeof wanted, "%u %u %u %u", a, e, c, d);
    } else {
        snprintf(wanted, sizeof wanted, "%u %u %u %u", d, c, e, a);
    }
    assert_ids(&ids, wanted);
    he_ids_clear(&ids);
    he_mesh_free(m);
    /* On a cube no vertex has degree 4, so each edge loop is a single edge; each edge ring has four
     * edges. */
    m = fixture_mesh("0123,7654,1045,2156,3267,0374");
    for (e = 0; e < 12; e++) {
        expect_chain(m, false, e, 1, false);
        expect_chain(m, true, e, 4, true);
    }
    he_mesh_free(m);
    /* On an octahedron the edge loops are its three equators; an edge ring is a single edge,
     * because a ring does not cross triangles. */
    m = query_shape("octahedron", 1, 0, 0, 0);
    for (e = 0; e < 12; e++) {
        expect_chain(m, false, e, 4, true);
        expect_chain(m, true, e, 1, false);
    }
    he_mesh_free(m);
    /* The vertex between the two quads of a bow-tie has four edges, but is on the boundary, so a
     * loop ends there. */
    m = fixture_mesh("0123,0456");
    expect_chain(m, false, edge_between(m, 0, 1), 1, false);
    expect_chain(m, true, edge_between(m, 0, 1), 2, false);
    he_mesh_free(m);
}

static void walks_from_deleted_or_missing_elements_are_refused(void **state)
{
    (void)state;
    he_mesh *m = query_with_dead_rows();
    he_ids a = {0}, b = {0};
    bool closed = true;
    he_path path = {.length = 5};
    he_error err = {0};
    assert_int_equal(he_traverse_loop(m, (he_halfedge){6}, &a, &err), HE_DELETED_ELEMENT);
    assert_int_equal(
        he_traverse_breadth_first(m, &(he_breadth_first){HE_VERTEX, 4, 1, 0}, &a, &b, &err),
        HE_DELETED_ELEMENT);
    assert_int_equal(
        he_traverse_breadth_first(m, &(he_breadth_first){HE_FACE, 1, 1, 0}, &a, &b, &err),
        HE_DELETED_ELEMENT);
    assert_int_equal(
        he_traverse_breadth_first(m, &(he_breadth_first){HE_EDGE, 0, 1, 0}, &a, &b, &err),
        HE_BAD_VALUE);
    assert_int_equal(he_traverse_edge_loop(m, (he_edge){3}, &a, &closed, &err), HE_DELETED_ELEMENT);
    assert_int_equal(he_traverse_edge_ring(m, (he_edge){77}, &a, &closed, &err),
                     HE_NO_SUCH_ELEMENT);
    assert_int_equal(err.kind, HE_EDGE);
    assert_int_equal(err.id, 77);
    assert_int_equal(
        he_traverse_shortest_path(m, (he_vertex){0}, (he_vertex){6}, HE_BY_EDGES, &path, &err),
        HE_DELETED_ELEMENT);
    assert_true(closed && path.length == 5);
    assert_int_equal(a.count + b.count, 0);
    /* An isolated vertex is at distance 0 from itself. */
    assert_int_equal(
        he_traverse_shortest_path(m, (he_vertex){3}, (he_vertex){3}, HE_BY_LENGTH, &path, &err),
        HE_OK);
    assert_true(path.found && path.vertices.count == 1 && path.edges.count == 0);
    assert_true(path.length == 0);
    he_path_clear(&path);
    he_mesh_free(m);
}

/* If a sum of lengths overflows a double, the result must be finite. */
static void a_path_of_huge_lengths_has_a_finite_length(void **state)
{
    (void)state;
    he_mesh *m = query_shape("grid", 3, 1, 1, 1);
    for (uint32_t v = 0; v < 8; v++) {
        m->c.position[v].x = v % 2 == 0 ? DBL_MAX : -DBL_MAX;
    }
    he_path path;
    assert_int_equal(
        he_traverse_shortest_path(m, (he_vertex){0}, (he_vertex){7}, HE_BY_LENGTH, &path, NULL),
        HE_OK);
    assert_true(path.found && path.length == DBL_MAX);
    he_path_clear(&path);
    he_mesh_free(m);
}

/* Runs every search and path on a mesh with broken links, and requires only that each one ends. */
static void walk_all(const he_mesh *m, he_status *worst)
{
    static const he_step steps[] = {HE_STEP_NEXT, HE_STEP_TWIN, HE_STEP_PREV};
    uint32_t rows = he_mesh_issued(m, HE_VERTEX);
    for (uint32_t i = 0; i < rows; i++) {
        he_ids a = {0}, b = {0};
        he_path path = {0};
        bool closed;
        he_status got[10];
        size_t n = 0;
        he_vertex v = {i}, w = {(i * 7 + 3) % rows};
        he_halfedge h = {i};
        got[n++] = he_traverse_path(m, h, &(he_path_steps){steps, 3, UINT64_MAX, HE_UNTIL_START, 0},
                                    NULL, &a, NULL);
        got[n++] = he_traverse_path(
            m, h, &(he_path_steps){steps, 3, UINT64_MAX, HE_UNTIL_BOUNDARY, 0}, NULL, &a, NULL);
        got[n++] = he_traverse_loop(m, h, &a, NULL);
        got[n++] =
            he_traverse_breadth_first(m, &(he_breadth_first){HE_VERTEX, v.i, 3, 0}, &a, &b, NULL);
        got[n++] =
            he_traverse_breadth_first(m, &(he_breadth_first){HE_FACE, i, HE_NONE, 0}, &a, &b, NULL);
        got[n++] = he_traverse_shortest_path(m, v, w, HE_BY_EDGES, &path, NULL);
        he_path_clear(&path);
        got[n++] = he_traverse_shortest_path(m, v, w, HE_BY_LENGTH, &path, NULL);
        he_path_clear(&path);
        got[n++] = he_traverse_edge_loop(m, (he_edge){i}, &a, &closed, NULL);
        got[n++] = he_traverse_edge_ring(m, (he_edge){i}, &a, &closed, NULL);
        for (size_t k = 0; k < n; k++) {
            if (got[k] != HE_OK && got[k] != HE_NO_SUCH_ELEMENT && got[k] != HE_DELETED_ELEMENT) {
                *worst = got[k];
            }
        }
        he_ids_clear(&a);
        he_ids_clear(&b);
    }
}

static void every_walk_ends_on_broken_links(void **state)
{
    (void)state;
    he_mesh *m = fixture_mesh("0123,7654,1045,2156,3267,0374");
    he_ids ids = {0};
    bool closed;
    m->c.next[m->c.next[0]] =
        m->c.next[0]; /* makes a loop of links that never comes back to half-edge 0 */
    assert_int_equal(he_traverse_loop(m, (he_halfedge){0}, &ids, NULL), HE_CORRUPT);
    m->c.next[0] = 1000;
    he_error err = {0};
    assert_int_equal(he_traverse_edge_ring(m, (he_edge){0}, &ids, &closed, &err), HE_CORRUPT);
    assert_int_equal(err.status, HE_CORRUPT);
    assert_int_equal(ids.count, 0);
    he_ids_clear(&ids);
    he_mesh_free(m);
    uint64_t seed = 2;
    int corrupt = 0;
    for (int round = 0; round < 3000; round++) {
        m = fixture_mesh(query_specimens[query_random(&seed) % QUERY_SPECIMENS]);
        for (uint64_t n = 1 + query_random(&seed) % 3; n > 0; n--) {
            query_spoil(m, &seed);
        }
        he_status worst = HE_OK;
        walk_all(m, &worst);
        assert_true(worst == HE_OK || worst == HE_CORRUPT);
        corrupt += worst == HE_CORRUPT;
        he_mesh_free(m);
    }
    assert_true(corrupt > 1000);
}

static void a_walk_without_memory_gives_nothing(void **state)
{
    (void)state;
    he_mesh *m = query_shape("torus", 9, 10, 2, 1);
    static const he_step steps[] = {HE_STEP_NEXT, HE_STEP_NEXT, HE_STEP_TWIN};
    for (int walk = 0; walk < 7; walk++) {
        failing f = {0};
        while (failing_next(&f)) {
            he_status status = HE_OK;
            he_ids a = {0}, b = {0};
            he_path path = {0};
            bool closed;
            switch (walk) {
            case 0:
                status = he_traverse_path(m, (he_halfedge){0},
                                          &(he_path_steps){steps, 3, UINT64_MAX, HE_UNTIL_START, 0},
                                          NULL, &a, NULL);
                break;
            case 1:
                status = he_traverse_loop(m, (he_halfedge){0}, &a, NULL);
                break;
            case 2:
                status = he_traverse_breadth_first(m, &(he_breadth_first){HE_FACE, 0, HE_NONE, 0},
                                                   &a, &b, NULL);
                break;
            case 3:
                status = he_traverse_breadth_first(m, &(he_breadth_first){HE_VERTEX, 0, HE_NONE, 0},
                                                   &a, &b, NULL);
                break;
            case 4:
                status = he_traverse_shortest_path(m, (he_vertex){0}, (he_vertex){44}, HE_BY_LENGTH,
                                                   &path, NULL);
                break;
            case 5:
                status = he_traverse_edge_loop(m, (he_edge){0}, &a, &closed, NULL);
                break;
            default:
                status = he_traverse_edge_ring(m, (he_edge){0}, &a, &closed, NULL);
                break;
            }
            if (!failing_status(&f, status)) {
                assert_int_equal(a.count + b.count, 0);
                assert_false(path.found);
            }
            he_ids_clear(&a);
            he_ids_clear(&b);
            he_path_clear(&path);
        }
        assert_true(f.n > 1);
    }
    he_mesh_free(m);
}

/* The memory that a local search needs must not grow with the size of the mesh. */
static void a_local_walk_allocates_no_more_in_a_larger_mesh(void **state)
{
    (void)state;
    long calls[2];
    for (int i = 0; i < 2; i++) {
        he_mesh *m = query_shape("torus", i == 0 ? 40 : 400, 40, 2, 1);
        he_ids a = {0}, b = {0};
        he_path path;
        failing_at(0);
        assert_int_equal(
            he_traverse_breadth_first(m, &(he_breadth_first){HE_VERTEX, 0, 3, 0}, &a, &b, NULL),
            HE_OK);
        assert_int_equal(
            he_traverse_shortest_path(m, (he_vertex){0}, (he_vertex){3}, HE_BY_EDGES, &path, NULL),
            HE_OK);
        calls[i] = failing_count();
        failing_off();
        assert_int_equal(a.count, 25);
        he_ids_clear(&a);
        he_ids_clear(&b);
        he_path_clear(&path);
        he_mesh_free(m);
    }
    assert_int_equal(calls[0], calls[1]);
}

static bool give_up(void *context, const char *phase, double done)
{
    (void)phase;
    (void)done;
    return ++*(int *)context < 3;
}

static void a_long_path_can_be_given_up(void **state)
{
    (void)state;
    he_mesh *m = fixture_mesh("012,023");
    const he_step steps[] = {HE_STEP_NEXT};
    he_ids ids = {0};
    he_progress progress;
    int told = 0;
    he_progress_init(&progress, give_up, &told);
    assert_int_equal(he_traverse_path(m, (he_halfedge){0},
                                      &(he_path_steps){steps, 1, 1000000, HE_UNTIL_COUNT, 0},
                                      &progress, &ids, NULL),
                     HE_CANCELLED);
    assert_int_equal(told, 3);
    assert_int_equal(ids.count, 0);
    he_ids_clear(&ids);
    he_mesh_free(m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(walks_and_paths_agree_with_the_distances_of_all_pairs),
        cmocka_unit_test(shortest_paths_are_shortest_at_random_positions),
        cmocka_unit_test(a_path_repeats_its_steps_until_count_start_or_boundary),
        cmocka_unit_test(a_long_path_can_be_given_up),
        cmocka_unit_test(a_loop_follows_next_around_a_face_or_a_hole),
        cmocka_unit_test(edge_loops_pass_vertices_of_degree_4_and_rings_cross_quads),
        cmocka_unit_test(walks_from_deleted_or_missing_elements_are_refused),
        cmocka_unit_test(a_path_of_huge_lengths_has_a_finite_length),
        cmocka_unit_test(every_walk_ends_on_broken_links),
        cmocka_unit_test(a_walk_without_memory_gives_nothing),
        cmocka_unit_test(a_local_walk_allocates_no_more_in_a_larger_mesh),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
