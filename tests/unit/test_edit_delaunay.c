/* The result of the edit `delaunay` is compared with a circle test of every edge: the circle
 * through a triangle must contain no vertex of the neighbouring triangle. The environment variable
 * SEED=n repeats a random run, ROUNDS=n makes it longer. */
#include "edit_script.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "build/build.h"
#include "edit/local/flip.h"
#include "edit/local/poke.h"
#include "edit/whole/delaunay.h"
#include "edit/whole/triangulate.h"
#include "geometry/geometry.h"
#include "mesh/write.h"
#include "model/shapes.h"
#include "tests/failing.h"
#include "tests/seed.h"

/* --- properties of edges, computed by another method than that of the edit --- */

static bool is_inner(const he_mesh *m, uint32_t e)
{
    return he_mesh_is_live(m, HE_EDGE, e) && !he_is_boundary_edge(m, (he_edge){e}) &&
           he_face_degree(m, he_face_of(m, (he_halfedge){2 * e})) == 3 &&
           he_face_degree(m, he_face_of(m, (he_halfedge){2 * e + 1})) == 3;
}

/* Returns the angle at the corner opposite to half-edge h in its triangle, by the law of
 * cosines. */
static double opposite(const he_mesh *m, he_halfedge h)
{
    double a = he_edge_length(m, he_edge_of(h)), b = he_edge_length(m, he_edge_of(he_next(m, h)));
    double c = he_edge_length(m, he_edge_of(he_prev(m, h)));
    double cosine = b == 0 || c == 0 ? 1 : (b * b + c * c - a * a) / (2 * b * c);
    return acos(cosine < -1 ? -1 : cosine > 1 ? 1 : cosine);
}

static bool is_clearly_crooked(const he_mesh *m, uint32_t e)
{
    he_halfedge h = {2 * e};
    return is_inner(m, e) && opposite(m, h) + opposite(m, he_twin(h)) > 3.14159265358979 + 1e-6;
}

/* Returns how far inside the circle through a, b and c the point d is, relative to the size of the
 * circle; all points have z = 0. */
static double depth_in_circle(he_vec3 a, he_vec3 b, he_vec3 c, he_vec3 d)
{
    long double ax = a.x - d.x, ay = a.y - d.y, bx = b.x - d.x, by = b.y - d.y;
    long double cx = c.x - d.x, cy = c.y - d.y;
    long double aa = ax * ax + ay * ay, bb = bx * bx + by * by, cc = cx * cx + cy * cy;
    long double det =
        ax * (by * cc - bb * cy) - ay * (bx * cc - bb * cx) + aa * (bx * cy - by * cx);
    return (double)(det / (aa * bb + bb * cc + cc * aa));
}

static void assert_delaunay_in_plane(const he_mesh *m)
{
    for (uint32_t e = 0; e < he_mesh_issued(m, HE_EDGE); e++) {
        if (is_inner(m, e)) {
            he_halfedge h = {2 * e}, t = he_twin(h);
            assert_true(depth_in_circle(he_position(m, he_origin(m, h)),
                                        he_position(m, he_target(m, h)),
                                        he_position(m, he_origin(m, he_prev(m, h))),
                                        he_position(m, he_origin(m, he_prev(m, t)))) < 1e-7);
        }
    }
    for (uint32_t f = 0; f < he_mesh_issued(m, HE_FACE); f++) {
        he_vec3 normal;
        assert_true(he_face_normal(m, (he_face){f}, &normal) && normal.z > 0);
    }
}

/* --- small cases --- */

static const he_vec3 KITE[] = {{0, 0, 0}, {4, 0, 0}, {2, 1, 0}, {2, -1, 0}, {9, 9, 9}};

static void the_long_diagonal_of_a_kite_is_flipped_once(void **state)
{
    (void)state;
    he_mesh *m = script_mesh("012,103", KITE);
    he_ids flips = {0};
    he_edge e = edge_between(m, 0, 1);
    assert_int_equal(he_delaunay(m, NULL, 0, &flips, NULL), HE_OK);
    assert_int_equal(flips.count, 1);
    assert_int_equal(flips.ids[0], e.i);
    assert_int_equal(edge_between(m, 2, 3).i, e.i);
    he_mesh *once = copy_of(m);
    assert_int_equal(he_delaunay(m, NULL, 0, &flips, NULL), HE_OK);
    assert_int_equal(flips.count, 0);
    assert_equal(m, once);
    he_ids_clear(&flips);
    he_mesh_free(once);
    he_mesh_free(m);
}

/* If four points are on one circle, both diagonals between them are equally good: neither may be
 * flipped to the other. */
static void neither_diagonal_of_four_points_on_a_circle_is_flipped(void **state)
{
    (void)state;
    static const he_vec3 square[] = {
        {0.1, 0.1, 0.7}, {0.4, 0.1, 0.7}, {0.4, 0.4, 0.7}, {0.1, 0.4, 0.7}};
    static const char *const halves[] = {"012,023", "013,123"};
    for (unsigned i = 0; i < 2; i++) {
        he_mesh *m = script_mesh(halves[i], square), *before = copy_of(m);
        script_prepare(m, "delaunay");
        assert_equal(m, before);
        he_mesh_free(before);
        he_mesh_free(m);
    }
}

static void an_edge_is_kept_where_a_flip_is_impossible(void **state)
{
    (void)state;
    static const he_vec3 pentagon[] = {{0, 0, 0}, {4, 0, 0}, {2, 1, 0}, {1, -1, 0}, {3, -1, 0}};
    static const struct {
        const char *mesh;
        const he_vec3 *at;
    } cases[] = {
        {"012", KITE},          /* edge 0-1, which the edit would flip, is on the boundary */
        {"012,1034", pentagon}, /* edge 0-1 is a side of a quadrilateral */
        /* a flip would make the edge 2-3 of the faces 012 and 103, but the triangles 213 and 023
         * have this edge already */
        {"012,103,213,023", KITE},
        {"012,103,234",
         KITE},            /* a flip would make the edge 2-3, but face 234 has this edge already */
        {"012,021", KITE}, /* two triangles back to back */
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        he_mesh *m = script_mesh(cases[i].mesh, cases[i].at), *before = copy_of(m);
        script_prepare(m, "delaunay");
        assert_equal(m, before);
        he_mesh_free(before);
        he_mesh_free(m);
    }
}

static void mark_features(he_mesh *m, he_type type, const unsigned char *marks)
{
    he_column *column = NULL;
    assert_int_equal(
        he_column_new(&(he_column_schema){"feature", HE_EDGE, type, 1, HE_COPY}, &column, NULL),
        HE_OK);
    size_t rows = he_mesh_issued(m, HE_EDGE);
    assert_int_equal(he_column_extend(column, rows, NULL), HE_OK);
    for (size_t i = 0; i < rows; i++) {
        *he_column_row(column, i) = marks[i];
    }
    assert_int_equal(he_mesh_add_column(m, column, NULL), HE_OK);
}

static void edges_marked_as_features_are_not_flipped(void **state)
{
    (void)state;
    static const unsigned char marks[] = {1, 0, 0, 0, 0};
    static const struct {
        he_type type;
        size_t flips;
    } cases[] = {{HE_BOOL, 0}, {HE_INT32, 1}};
    for (unsigned i = 0; i < 2; i++) {
        he_mesh *m = script_mesh("012,103", KITE);
        he_ids flips = {0};
        mark_features(m, cases[i].type, marks);
        assert_int_equal(edge_between(m, 0, 1).i, 0);
        assert_int_equal(he_delaunay(m, NULL, 0, &flips, NULL), HE_OK);
        assert_int_equal(flips.count, cases[i].flips);
        he_ids_clear(&flips);
        he_mesh_free(m);
    }
}

/* The kite is tested in three forms: small and far from the origin, huge, and tiny. */
static void a_kite_is_flipped_at_any_scale(void **state)
{
    (void)state;
    static const double scales[] = {1e305, 1e150, 1e-150, 1e-305};
    for (unsigned i = 0; i < 4; i++) {
        he_vec3 at[4];
        for (unsigned k = 0; k < 4; k++) {
            at[k] = he_vec3_scale(KITE[k], scales[i]);
        }
        he_mesh *m = script_mesh("012,103", at);
        script_prepare(m, "delaunay");
        (void)edge_between(m, 2, 3);
        he_mesh_free(m);
    }
}

/* --- random points in the plane --- */

static bool is_left(he_vec3 a, he_vec3 b, he_vec3 p)
{
    return (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x) > 1e-9;
}

static bool is_inside(const he_mesh *m, uint32_t f, he_vec3 p)
{
    he_halfedge h = he_face_halfedge(m, (he_face){f}), first = h;
    do {
        if (!is_left(he_position(m, he_origin(m, h)), he_position(m, he_target(m, h)), p)) {
            return false;
        }
        h = he_next(m, h);
    } while (h.i != first.i);
    return true;
}

/* Makes a square of triangles and inserts random points; each new point divides the triangle around
 * it into three. */
static he_mesh *random_points(md_random *r, uint32_t n)
{
    static const he_vec3 square[] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    he_mesh *m = script_mesh("012,023", square);
    for (uint32_t i = 0; i < n; i++) {
        he_vec3 p = {md_unit(r), md_unit(r), 0};
        for (uint32_t f = 0; f < he_mesh_issued(m, HE_FACE); f++) {
            if (is_inside(m, f, p)) {
                assert_int_equal(he_face_poke(m, (he_face){f}, &p, NULL, NULL, NULL, NULL), HE_OK);
                break;
            }
        }
    }
    return m;
}

static void random_points_become_delaunay_by_flips_that_can_be_repeated(void **state)
{
    (void)state;
    uint64_t seed = seed_setting("SEED", 1), rounds = seed_setting("ROUNDS", 200);
    for (uint64_t round = 0; round < rounds; round++) {
        md_random r = {seed + round};
        print_message("SEED=%llu ROUNDS=1\n", (unsigned long long)r.state);
        he_mesh *m = random_points(&r, md_from(&r, 1, 200)), *before = copy_of(m);
        he_delta *delta = he_delta_new();
        he_ids flips = {0};
        assert_non_null(delta);
        he_mesh_record(m, delta);
        assert_int_equal(he_delaunay(m, NULL, 0, &flips, NULL), HE_OK);
        he_mesh_record(m, NULL);
        assert_valid(m);
        assert_delaunay_in_plane(m);
        assert_true(fabs(area_of(m) - 1) < 1e-9);
        /* The edit reports the edges that it flipped, in order: flipping these in the old mesh must
         * give the new one. */
        he_mesh *replay = copy_of(before);
        for (size_t i = 0; i < flips.count; i++) {
            assert_true(is_inner(replay, flips.ids[i]));
            assert_int_equal(he_edge_flip(replay, (he_edge){flips.ids[i]}, NULL), HE_OK);
        }
        assert_equal(replay, m);
        he_mesh_free(replay);
        he_mesh *after = copy_of(m);
        he_delta_undo(delta, m);
        assert_true(he_mesh_equal_live(m, before));
        he_delta_redo(delta, m);
        assert_equal(m, after);
        assert_int_equal(he_delaunay(m, NULL, 0, &flips, NULL), HE_OK);
        assert_int_equal(flips.count, 0);
        assert_equal(m, after);
        he_mesh_free(after);
        he_ids_clear(&flips);
        he_delta_free(delta);
        he_mesh_free(before);
        he_mesh_free(m);
    }
}

/* Edges that are marked as features must not be flipped; all others must be Delaunay afterwards. */
static void all_edges_but_features_become_delaunay(void **state)
{
    (void)state;
    uint64_t seed = seed_setting("SEED", 1);
    for (uint64_t round = 0; round < 50; round++) {
        md_random r = {seed + round};
        he_mesh *m = random_points(&r, 100), *before = copy_of(m);
        uint32_t edges = he_mesh_issued(m, HE_EDGE);
        unsigned char *marks = calloc(edges, 1);
        assert_non_null(marks);
        for (uint32_t e = 0; e < edges; e++) {
            marks[e] = md_chance(&r, 20);
        }
        mark_features(m, HE_BOOL, marks);
        script_prepare(m, "delaunay");
        assert_valid(m);
        for (uint32_t e = 0; e < edges; e++) {
            he_halfedge h = {2 * e};
            if (marks[e]) {
                assert_int_equal(he_origin(m, h).i, he_origin(before, h).i);
                assert_int_equal(he_target(m, h).i, he_target(before, h).i);
            } else {
                assert_false(is_clearly_crooked(m, e));
            }
        }
        free(marks);
        he_mesh_free(before);
        he_mesh_free(m);
    }
}

/* After a point is inserted into a Delaunay triangulation, a request that names only the sides of
 * the triangle around it must be enough: each flip makes the edit test the neighbouring edges
 * (Lawson's insertion). */
static void flips_spread_from_the_listed_edges(void **state)
{
    (void)state;
    md_random r = {seed_setting("SEED", 1)};
    static const he_vec3 square[] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    he_mesh *m = script_mesh("012,023", square);
    size_t spread = 0;
    for (uint32_t i = 0; i < 300; i++) {
        he_vec3 p = {md_unit(&r), md_unit(&r), 0};
        uint32_t f = 0;
        while (f < he_mesh_issued(m, HE_FACE) && !is_inside(m, f, p)) {
            f++;
        }
        if (f == he_mesh_issued(m, HE_FACE)) {
            continue;
        }
        he_halfedge h = he_face_halfedge(m, (he_face){f});
        const uint32_t sides[3] = {h.i >> 1, he_next(m, h).i >> 1, he_prev(m, h).i >> 1};
        he_ids flips = {0};
        assert_int_equal(he_face_poke(m, (he_face){f}, &p, NULL, NULL, NULL, NULL), HE_OK);
        assert_int_equal(he_delaunay(m, sides, 3, &flips, NULL), HE_OK);
        spread += flips.count > 3;
        assert_delaunay_in_plane(m);
        he_ids_clear(&flips);
    }
    assert_true(spread > 10);
    he_mesh_free(m);
}

/* The edit must test only the edges in the request's list and the edges beside a flipped edge. */
static void edges_neither_listed_nor_beside_a_flip_are_not_flipped(void **state)
{
    (void)state;
    static const he_vec3 two[] = {{0, 0, 0}, {4, 0, 0}, {2, 1, 0},  {2, -1, 0},
                                  {0, 9, 0}, {4, 9, 0}, {2, 10, 0}, {2, 8, 0}};
    he_mesh *m = script_mesh("012,103,456,547", two);
    script_prepare(m, "delaunay edge=4-5");
    (void)edge_between(m, 0, 1);
    (void)edge_between(m, 6, 7);
    he_mesh_free(m);
}

/* --- triangles in space --- */

/* memory of the random shapes, allocated once because its tables are large */
static or_mesh *shapes;

static bool random_triangles(md_random *r, he_mesh **out)
{
    shapes = shapes == NULL ? or_new() : shapes;
    he_ids faces = {0};
    md_shape(shapes, r, md_fill_mixed);
    he_mesh *m = md_build(shapes);
    assert_non_null(m);
    for (uint32_t f = 0; f < he_mesh_issued(m, HE_FACE); f++) {
        assert_int_equal(he_ids_add(&faces, f, NULL), HE_OK);
    }
    bool done = faces.count > 0 &&
                he_face_triangulate(m, faces.ids, faces.count, NULL, NULL, NULL, NULL) == HE_OK;
    he_ids_clear(&faces);
    if (!done) {
        he_mesh_free(m);
        return false;
    }
    *out = m;
    return true;
}

static void flips_in_space_end_and_never_enlarge_the_area(void **state)
{
    (void)state;
    uint64_t seed = seed_setting("SEED", 1), rounds = seed_setting("ROUNDS", 2000), all = 0;
    for (uint64_t round = 0; round < rounds; round++) {
        md_random r = {seed + round};
        print_message("SEED=%llu ROUNDS=1\n", (unsigned long long)r.state);
        he_mesh *m;
        he_ids flips = {0};
        if (!random_triangles(&r, &m)) {
            continue;
        }
        double area = area_of(m);
        assert_int_equal(he_delaunay(m, NULL, 0, &flips, NULL), HE_OK);
        assert_valid(m);
        /* The total area of the triangles must not grow: the proof in delaunay.h that the edit
         * terminates relies on this. */
        assert_true(area_of(m) <= area * (1 + 1e-9));
        all += flips.count;
        for (uint32_t e = 0; e < he_mesh_issued(m, HE_EDGE); e++) {
            if (is_clearly_crooked(m, e)) {
                assert_true(he_edge_flip(m, (he_edge){e}, NULL) != HE_OK);
            }
        }
        he_mesh *once = copy_of(m);
        assert_int_equal(he_delaunay(m, NULL, 0, &flips, NULL), HE_OK);
        assert_int_equal(flips.count, 0);
        assert_equal(m, once);
        he_ids_clear(&flips);
        he_mesh_free(once);
        he_mesh_free(m);
    }
    print_message("%llu flips\n", (unsigned long long)all);
    assert_true(all > rounds);
}

/* --- work --- */

/* Makes two rows of n points. All triangles with a side in the lower row have the first point of
 * the upper row as their third corner; all triangles with a side in the upper row have the last
 * point of the lower row as their third corner. The number of necessary flips grows with the square
 * of n. */
static he_mesh *two_rows(uint32_t n)
{
    he_soup soup;
    he_mesh *m = NULL;
    he_soup_init(&soup, NULL);
    for (uint32_t i = 0; i < 2 * n; i++) {
        he_vec3 p = {i % n, i < n ? 0 : 1, 0};
        assert_int_equal(he_soup_add_vertex(&soup, p, NULL), HE_OK);
    }
    for (uint32_t i = 0; i + 1 < n; i++) {
        const uint32_t lower[3] = {i, i + 1, n}, upper[3] = {n + i + 1, n + i, n - 1};
        assert_int_equal(he_soup_add_face(&soup, lower, 3, NULL), HE_OK);
        assert_int_equal(he_soup_add_face(&soup, upper, 3, NULL), HE_OK);
    }
    assert_int_equal(he_build(&soup, HE_BUILD_TAKE, &m, NULL, NULL), HE_OK);
    he_soup_clear(&soup);
    return m;
}

static void too_many_flips_are_refused_without_change(void **state)
{
    (void)state;
    he_ids flips = {0};
    he_error err = {.status = HE_OK};
    he_mesh *m = two_rows(100);
    assert_int_equal(he_delaunay(m, NULL, 0, &flips, NULL), HE_OK);
    assert_true(flips.count > 2000);
    he_mesh_free(m);
    m = two_rows(1000);
    he_mesh *before = copy_of(m);
    size_t count = flips.count;
    assert_int_equal(he_delaunay(m, NULL, 0, &flips, &err), HE_LIMIT);
    assert_int_equal(err.status, HE_LIMIT);
    assert_int_equal(flips.count, count);
    assert_equal(m, before);
    he_ids_clear(&flips);
    he_mesh_free(before);
    he_mesh_free(m);
}

/* However many flips an edit makes, its delta must not be longer than the number of words in the
 * mesh, and must undo and redo all flips. */
static void the_record_of_many_flips_is_no_larger_than_the_mesh(void **state)
{
    (void)state;
    he_ids flips = {0};
    he_mesh *m = two_rows(200), *before = copy_of(m);
    he_delta *delta = he_delta_new();
    he_mesh_record(m, delta);
    assert_int_equal(he_delaunay(m, NULL, 0, &flips, NULL), HE_OK);
    he_mesh_record(m, NULL);
    size_t edges = m->c.edges.live;
    assert_true(flips.count > 16 * edges);
    assert_true(delta->count < 48 * edges);
    assert_valid(m);
    he_mesh *after = copy_of(m);
    he_delta_undo(delta, m);
    assert_equal(m, before);
    he_delta_redo(delta, m);
    assert_equal(m, after);
    he_ids_clear(&flips);
    he_delta_free(delta);
    he_mesh_free(after);
    he_mesh_free(before);
    he_mesh_free(m);
}

/* A vertex has ten thousand edges: if each flip visited all of them, the edit would take quadratic
 * time. */
static void a_vertex_of_10000_edges_takes_no_quadratic_time(void **state)
{
    (void)state;
    enum { SPOKES = 10000 };
    he_soup soup;
    he_mesh *m = NULL;
    md_random r = {1};
    he_soup_init(&soup, NULL);
    for (uint32_t i = 0; i <= SPOKES; i++) {
        double angle = 6.283185307179586 * i / SPOKES, radius = 1 + md_unit(&r);
        he_vec3 p = {radius * cos(angle), radius * sin(angle), 0};
        p = i == SPOKES ? (he_vec3){0, 0, 0} : p;
        assert_int_equal(he_soup_add_vertex(&soup, p, NULL), HE_OK);
    }
    for (uint32_t i = 0; i < SPOKES; i++) {
        const uint32_t triangle[3] = {i, (i + 1) % SPOKES, SPOKES};
        assert_int_equal(he_soup_add_face(&soup, triangle, 3, NULL), HE_OK);
    }
    assert_int_equal(he_build(&soup, HE_BUILD_TAKE, &m, NULL, NULL), HE_OK);
    he_soup_clear(&soup);
    he_ids flips = {0};
    assert_int_equal(he_delaunay(m, NULL, 0, &flips, NULL), HE_OK);
    assert_true(flips.count > SPOKES / 2);
    print_message("%zu flips\n", flips.count);
    assert_valid(m);
    he_ids_clear(&flips);
    he_mesh_free(m);
}

static void delaunay_without_memory_leaves_the_mesh_unchanged(void **state)
{
    (void)state;
    md_random r = {7};
    he_mesh *start = random_points(&r, 60);
    for (unsigned record = 0; record < 2; record++) {
        failing f = {0};
        while (failing_next(&f)) {
            failing_pause();
            he_mesh *m = copy_of(start);
            script_add_columns(m);
            he_mesh *before = copy_of(m);
            he_delta *delta = record ? he_delta_new() : NULL;
            he_mesh_record(m, delta);
            he_ids flips = {0};
            failing_resume();
            he_status status = he_delaunay(m, NULL, 0, &flips, NULL);
            bool failed = !failing_status(&f, status);
            he_mesh_record(m, NULL);
            if (failed) {
                assert_equal(m, before);
                assert_int_equal(flips.count, 0);
            }
            he_ids_clear(&flips);
            he_delta_free(delta);
            he_mesh_free(before);
            he_mesh_free(m);
        }
        assert_true(f.n > 5);
    }
    he_mesh_free(start);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_long_diagonal_of_a_kite_is_flipped_once),
        cmocka_unit_test(neither_diagonal_of_four_points_on_a_circle_is_flipped),
        cmocka_unit_test(an_edge_is_kept_where_a_flip_is_impossible),
        cmocka_unit_test(edges_marked_as_features_are_not_flipped),
        cmocka_unit_test(a_kite_is_flipped_at_any_scale),
        cmocka_unit_test(random_points_become_delaunay_by_flips_that_can_be_repeated),
        cmocka_unit_test(all_edges_but_features_become_delaunay),
        cmocka_unit_test(flips_spread_from_the_listed_edges),
        cmocka_unit_test(edges_neither_listed_nor_beside_a_flip_are_not_flipped),
        cmocka_unit_test(flips_in_space_end_and_never_enlarge_the_area),
        cmocka_unit_test(too_many_flips_are_refused_without_change),
        cmocka_unit_test(the_record_of_many_flips_is_no_larger_than_the_mesh),
        cmocka_unit_test(a_vertex_of_10000_edges_takes_no_quadratic_time),
        cmocka_unit_test(delaunay_without_memory_leaves_the_mesh_unchanged),
    };
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    or_free(shapes);
    return failed;
}
