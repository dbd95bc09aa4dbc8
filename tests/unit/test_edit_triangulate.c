/* Triangulation of concave, long, tilted and degenerate faces, of faces whose diagonals exist as
 * edges already, and of the faces that fill holes. */
#include "edit_script.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "build/build.h"
#include "edit/border/hole.h"
#include "edit/whole/triangulate.h"
#include "geometry/triangulation.h"
#include "mesh/check.h"
#include "mesh/walk.h"

typedef struct point {
    double x, y;
} point;

/* Maps a point to a tilted plane far from the origin; all coordinates are multiplied by `scale`. */
static he_vec3 lay(point p, double scale)
{
    return (he_vec3){scale * (0.6 * p.x - 0.48 * p.y + 100), scale * (0.8 * p.y + 30),
                     scale * (0.8 * p.x + 0.36 * p.y - 70)};
}

static he_mesh *polygon(const point *points, uint32_t n, double scale)
{
    he_soup soup;
    he_mesh *m = NULL;
    he_soup_init(&soup, NULL);
    assert_int_equal(he_soup_begin_face(&soup, NULL), HE_OK);
    for (uint32_t i = 0; i < n; i++) {
        assert_int_equal(he_soup_add_vertex(&soup, lay(points[i], scale), NULL), HE_OK);
        assert_int_equal(he_soup_add_corner(&soup, i, NULL), HE_OK);
    }
    assert_int_equal(he_build(&soup, 0, &m, NULL, NULL), HE_OK);
    he_soup_clear(&soup);
    return m;
}

static double area(point a, point b, point c)
{
    return ((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x)) / 2;
}

/* Requires that the triangles cover the polygon exactly once: all are oriented counterclockwise,
 * and their areas add up to that of the polygon. */
static void assert_covered(const he_mesh *m, const point *points, uint32_t n)
{
    double whole = 0, sum = 0;
    for (uint32_t i = 0; i < n; i++) {
        whole += area((point){0, 0}, points[i], points[(i + 1) % n]);
    }
    assert_counts(m, n, 2 * n - 3, n - 2);
    for (uint32_t f = 0; f < n - 2; f++) {
        he_halfedge h = he_face_halfedge(m, (he_face){f});
        assert_int_equal(he_face_degree(m, (he_face){f}), 3);
        double part = area(points[he_origin(m, h).i], points[he_target(m, h).i],
                           points[he_target(m, he_next(m, h)).i]);
        assert_true(part > 0);
        sum += part;
    }
    assert_true(fabs(sum - whole) < 1e-9 * whole);
}

static void check_polygon(const point *points, uint32_t n, double scale)
{
    uint32_t face = 0;
    he_ids degenerate = {0};
    he_mesh *m = polygon(points, n, scale);
    assert_int_equal(he_face_triangulate(m, &face, 1, NULL, NULL, &degenerate, NULL), HE_OK);
    assert_int_equal(degenerate.count, 0);
    assert_covered(m, points, n);
    he_ids_clear(&degenerate);
    he_mesh_free(m);
}

static void small_concave_polygons_are_triangulated(void **state)
{
    (void)state;
    static const point dart[] = {{0, 0}, {4, 4}, {0, 1}, {-4, 4}};
    static const point turned_dart[] = {{4, 4}, {0, 1}, {-4, 4}, {0, 0}};
    static const point angle[] = {{0, 0}, {3, 0}, {3, 1}, {1, 1}, {1, 3}, {0, 3}};
    static const point spiral[] = {{0, 0}, {9, 0}, {9, 9}, {2, 9}, {2, 4}, {5, 4}, {5, 6}, {4, 6},
                                   {4, 5}, {3, 5}, {3, 8}, {8, 8}, {8, 1}, {1, 1}, {1, 9}, {0, 9}};
    /* A triangle with additional corners on its straight sides. */
    static const point flat[] = {{0, 0}, {1, 0}, {2, 0}, {3, 0}, {0, 3}, {0, 2}, {0, 1}};
    check_polygon(dart, 4, 1);
    check_polygon(turned_dart, 4, 1);
    check_polygon(angle, 6, 1);
    check_polygon(spiral, 16, 1);
    check_polygon(flat, 7, 1);
}

static void a_dart_is_triangulated_at_any_scale(void **state)
{
    (void)state;
    static const point dart[] = {{0, 0}, {400, 400}, {0, 100}, {-400, 400}};
    static const double scales[] = {1e305, 1e150, 1e-150, 1e-305};
    for (unsigned i = 0; i < 4; i++) {
        check_polygon(dart, 4, scales[i]);
    }
}

/* Polygons with more than HE_EXACT_CORNERS corners are triangulated by ear clipping, not by the
 * slower search for the best diagonals. */
static void stars_combs_and_spirals_of_600_corners_are_triangulated(void **state)
{
    (void)state;
    enum { N = 600 };
    static point points[N];
    /* The points form first a star, then a comb, then a spiral. */
    for (uint32_t i = 0; i < N; i++) {
        double angle = 6.283185307179586 * i / N, radius = i % 2 ? 100 : 30;
        points[i] = (point){radius * cos(angle), radius * sin(angle)};
    }
    check_polygon(points, N, 1);
    points[0] = (point){0, 0};
    points[1] = (point){N, 0};
    for (uint32_t i = 2; i < N; i++) {
        points[i] = (point){N - i, i % 2 ? 1 : 50};
    }
    check_polygon(points, N, 1);
    for (uint32_t i = 0; i < N; i++) {
        uint32_t k = i < N / 2 ? i : N - 1 - i;
        double angle = 0.05 * k, radius = 0.1 * k + (i < N / 2 ? 22 : 20);
        points[i] = (point){radius * cos(angle), radius * sin(angle)};
    }
    check_polygon(points, N, 1);
}

static void a_convex_face_of_20000_corners_takes_no_quadratic_time(void **state)
{
    (void)state;
    enum { N = 20000 };
    point *points = malloc(N * sizeof *points);
    assert_non_null(points);
    for (uint32_t i = 0; i < N; i++) {
        double angle = 6.283185307179586 * i / N;
        points[i] = (point){100 * cos(angle), 100 * sin(angle)};
    }
    check_polygon(points, N, 1);
    free(points);
}

/* Faces without area and faces with sides that cross each other must be triangulated, too, and be
 * reported as degenerate. */
static void degenerate_faces_are_triangulated_and_reported(void **state)
{
    (void)state;
    static const point line[] = {{0, 0}, {1, 0}, {2, 0}, {3, 0}, {4, 0}};
    static const point crossed[] = {{0, 0}, {4, 0}, {0, 3}, {4, 4}};
    static const point same[] = {{1, 1}, {1, 1}, {1, 1}, {1, 1}};
    static point pentagram[105], row[100], comb[100];
    for (uint32_t i = 0; i < 100; i++) {
        row[i] = (point){i, 0};
        comb[i] = (point){i % 2 ? 50 : 0, i};
    }
    for (uint32_t i = 0; i < 105; i++) {
        double angle = 6.283185307179586 * 2 * i / 105;
        pentagram[i] = (point){cos(angle), sin(angle)};
    }
    const struct {
        const point *points;
        uint32_t n;
    } cases[] = {{line, 5},        {crossed, 4}, {same, 4},  {line, 3},
                 {pentagram, 105}, {row, 100},   {comb, 100}};
    for (unsigned i = 0; i < 7; i++) {
        uint32_t face = 0, n = cases[i].n;
        he_ids degenerate = {0};
        he_mesh *m = polygon(cases[i].points, n, 1);
        assert_int_equal(he_face_triangulate(m, &face, 1, NULL, NULL, &degenerate, NULL), HE_OK);
        assert_counts(m, n, 2 * n - 3, n - 2);
        assert_int_equal(degenerate.count, 1);
        assert_int_equal(degenerate.ids[0], 0);
        he_ids_clear(&degenerate);
        he_mesh_free(m);
    }
}

static he_mesh *flat_mesh(const char *faces, const point *points, uint32_t n)
{
    he_vec3 positions[16];
    for (uint32_t i = 0; i < n; i++) {
        positions[i] = (he_vec3){points[i].x, points[i].y, 0};
    }
    return script_mesh(faces, positions);
}

/* If one diagonal of a quadrilateral exists as an edge of another face, the triangulation must use
 * the other diagonal. If the other diagonal lies outside the quadrilateral, the edit must be
 * refused. */
static void diagonals_avoid_existing_edges_or_the_edit_is_refused(void **state)
{
    (void)state;
    static const point square[] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}, {5, 5}, {6, 6}};
    he_mesh *m = flat_mesh("0123,024", square, 5);
    script_prepare(m, "face_triangulate face=0");
    assert_counts(m, 5, 8, 3);
    assert_true(edge_between(m, 1, 3).i < he_mesh_issued(m, HE_EDGE));
    he_mesh_free(m);

    m = flat_mesh("0123,135", square, 6);
    script_prepare(m, "face_triangulate face=0");
    assert_true(edge_between(m, 0, 2).i < he_mesh_issued(m, HE_EDGE));
    he_mesh_free(m);

    /* A dart (a concave quadrilateral) has only one diagonal that lies inside. */
    static const point dart[] = {{0, 0}, {4, 4}, {0, 1}, {-4, 4}, {9, 9}};
    he_mesh *before;
    m = flat_mesh("0123,024", dart, 5);
    before = copy_of(m);
    assert_int_equal(script_run(m, "face_triangulate face=0", NULL, NULL), HE_DOUBLED_EDGE);
    assert_equal(m, before);
    he_mesh_free(before);
    he_mesh_free(m);
}

/* Makes a face of 66 corners: a star, or a convex polygon if `inner` is 1. At `blocked` of its
 * corners no triangle can be cut off, because the diagonal that would cut it off exists as an edge
 * of another face. */
static he_mesh *blocked_star(double inner, uint32_t blocked)
{
    enum { N = 66 };
    he_soup soup;
    he_mesh *m = NULL;
    uint32_t corners[N];
    he_soup_init(&soup, NULL);
    for (uint32_t i = 0; i < N + blocked; i++) {
        double angle = 6.283185307179586 * i / N, radius = i % 2 ? 1 : inner;
        he_vec3 p = {radius * cos(angle), radius * sin(angle), i < N ? 0 : 1};
        assert_int_equal(he_soup_add_vertex(&soup, p, NULL), HE_OK);
        corners[i < N ? i : 0] = i < N ? i : 0;
    }
    assert_int_equal(he_soup_add_face(&soup, corners, N, NULL), HE_OK);
    for (uint32_t i = 0; i < blocked; i++) {
        const uint32_t triangle[3] = {2 * i, (2 * i + 2) % N, N + i};
        assert_int_equal(he_soup_add_face(&soup, triangle, 3, NULL), HE_OK);
    }
    assert_int_equal(he_build(&soup, 0, &m, NULL, NULL), HE_OK);
    he_soup_clear(&soup);
    return m;
}

static void blocked_ears_are_passed_over_or_the_edit_is_refused(void **state)
{
    (void)state;
    he_mesh *m = blocked_star(1, 33);
    script_prepare(m, "face_triangulate face=0");
    assert_counts(m, 66 + 33, 66 + 33 * 3 + 63, 33 + 64);
    he_mesh_free(m);

    m = blocked_star(0.3, 33);
    he_mesh *before = copy_of(m);
    assert_int_equal(script_run(m, "face_triangulate face=0", NULL, NULL), HE_DOUBLED_EDGE);
    assert_equal(m, before);
    he_mesh_free(before);
    he_mesh_free(m);
}

/* Many faces share two corners of very high degree, and the best diagonal of the last face connects
 * these two corners. The triangulation must find in few steps that this edge exists already, even
 * if the same edit made it as a diagonal of an earlier face. */
static void faces_that_share_two_hubs_take_no_quadratic_time(void **state)
{
    (void)state;
    enum { FACES = 20000, LAST = 100 };
    he_soup soup;
    he_mesh *m = NULL;
    he_soup_init(&soup, NULL);
    assert_int_equal(he_soup_add_vertex(&soup, (he_vec3){-1, 0, 0}, NULL), HE_OK);
    assert_int_equal(he_soup_add_vertex(&soup, (he_vec3){1, 0, 0}, NULL), HE_OK);
    for (uint32_t i = 0; i < FACES; i++) {
        uint32_t a = (uint32_t)soup.vertex_count;
        double y = i + LAST < FACES ? 0.1 : 5;
        assert_int_equal(he_soup_add_vertex(&soup, (he_vec3){0, -y, i}, NULL), HE_OK);
        assert_int_equal(he_soup_add_vertex(&soup, (he_vec3){0, y, i}, NULL), HE_OK);
        assert_int_equal(he_soup_add_face(&soup, (uint32_t[]){0, a, 1, a + 1}, 4, NULL), HE_OK);
    }
    assert_int_equal(he_build(&soup, 0, &m, NULL, NULL), HE_OK);
    he_soup_clear(&soup);
    assert_int_equal(he_triangulate(m, NULL, NULL, NULL, NULL), HE_OK);
    assert_counts(m, 2 + 2 * FACES, 5 * FACES, 2 * FACES);
    he_problem problem;
    size_t problems = 0;
    assert_int_equal(he_check(m, &problem, 1, &problems, NULL), HE_OK);
    assert_int_equal(problems, 0);
    assert_true(edge_between(m, 0, 1).i < he_mesh_issued(m, HE_EDGE));
    he_mesh_free(m);
}

/* Two faces have equal corners: only one of them may get the diagonal 0-2, and the other face must
 * get the diagonal 1-3. */
static void two_faces_of_a_list_do_not_get_the_same_diagonal(void **state)
{
    (void)state;
    static const point square[] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    he_mesh *m = flat_mesh("0123,3210", square, 4);
    script_prepare(m, "face_triangulate faces=0,1");
    assert_counts(m, 4, 6, 4);
    he_mesh_free(m);
}

static void a_hole_is_filled_by_each_method(void **state)
{
    (void)state;
    static const point angle[] = {{0, 0}, {3, 0}, {3, 1}, {1, 1}, {1, 3}, {0, 3}};
    static const he_fill methods[] = {HE_FILL_POLYGON, HE_FILL_FAN, HE_FILL_TRIANGULATE};
    static const uint32_t counts[][3] = {{6, 6, 2}, {7, 12, 7}, {6, 9, 5}};
    for (unsigned i = 0; i < 3; i++) {
        he_mesh *m = polygon(angle, 6, 1);
        he_filled filled;
        assert_int_equal(he_hole_fill(m, halfedge_between(m, 1, 0), methods[i], &filled, NULL),
                         HE_OK);
        assert_counts(m, counts[i][0], counts[i][1], counts[i][2]);
        assert_loops(m, "");
        assert_int_equal(filled.faces.count, counts[i][2] - 1);
        assert_int_equal(filled.edges.count, counts[i][1] - 6);
        assert_int_equal(filled.vertex.i, i == 1 ? 6 : HE_NONE);
        he_filled_clear(&filled);
        he_mesh_free(m);
    }
}

static void equal_faces_are_triangulated_equally(void **state)
{
    (void)state;
    static const point angle[] = {{0, 0}, {3, 0}, {3, 1}, {1, 1}, {1, 3}, {0, 3}};
    uint32_t face = 0;
    he_mesh *a = polygon(angle, 6, 1), *b = polygon(angle, 6, 1);
    assert_int_equal(he_face_triangulate(a, &face, 1, NULL, NULL, NULL, NULL), HE_OK);
    assert_int_equal(he_face_triangulate(b, &face, 1, NULL, NULL, NULL, NULL), HE_OK);
    assert_equal(a, b);
    he_mesh_free(a);
    he_mesh_free(b);
}

static he_triangulation triangulation_of(const he_mesh *m, uint32_t face, unsigned flags)
{
    he_triangulation t;
    he_halfedge first = he_face_halfedge(m, (he_face){face});
    assert_int_equal(he_triangulation_make(m, first, flags, NULL, &t, NULL), HE_OK);
    return t;
}

/* With the option HE_ANY_DIAGONALS, the triangulation of a star takes fewer steps than without it,
 * because it does not look for the best diagonals. A polygon whose sides cross gets the same
 * triangles with and without the option. */
static void any_diagonals_take_fewer_steps_than_the_best_ones(void **state)
{
    (void)state;
    enum { N = HE_EXACT_CORNERS };
    point star[N], crossed[N];
    for (uint32_t i = 0; i < N; i++) {
        double angle = 6.283185307179586 * i / N, radius = i % 2 ? 100 : 30;
        star[i] = (point){radius * cos(angle), radius * sin(angle)};
        crossed[i] = (point){(i * 37) % 61, (i * 23) % 59};
    }
    he_mesh *m = polygon(star, N, 1);
    he_triangulation any = triangulation_of(m, 0, HE_ANY_DIAGONALS),
                     best = triangulation_of(m, 0, 0);
    assert_false(any.degenerate);
    assert_false(best.degenerate);
    assert_true(any.steps < N * N);
    assert_true(best.steps > N * N);
    he_triangulation_clear(&any);
    he_triangulation_clear(&best);
    he_mesh_free(m);

    m = polygon(crossed, N, 1);
    any = triangulation_of(m, 0, HE_ANY_DIAGONALS);
    best = triangulation_of(m, 0, 0);
    assert_int_equal(any.degenerate, best.degenerate);
    assert_memory_equal(any.corners, best.corners, 3 * sizeof(uint32_t) * (N - 2));
    he_triangulation_clear(&any);
    he_triangulation_clear(&best);
    he_mesh_free(m);
}

/* All faces share two vertices, so for each diagonal the triangulation searches many edges; these
 * searches must count towards the limit on work. */
static void searching_for_edges_counts_as_work(void **state)
{
    (void)state;
    enum { FACES = 2000 };
    he_soup soup;
    he_mesh *m = NULL;
    he_soup_init(&soup, NULL);
    assert_int_equal(he_soup_add_vertex(&soup, (he_vec3){-1, 0, 0}, NULL), HE_OK);
    assert_int_equal(he_soup_add_vertex(&soup, (he_vec3){1, 0, 0}, NULL), HE_OK);
    for (uint32_t i = 0; i < FACES; i++) {
        uint32_t a = (uint32_t)soup.vertex_count;
        assert_int_equal(he_soup_add_vertex(&soup, (he_vec3){0, -1, i}, NULL), HE_OK);
        assert_int_equal(he_soup_add_vertex(&soup, (he_vec3){0, 1, i}, NULL), HE_OK);
        assert_int_equal(he_soup_add_face(&soup, (uint32_t[]){0, a, 1, a + 1}, 4, NULL), HE_OK);
    }
    assert_int_equal(he_build(&soup, 0, &m, NULL, NULL), HE_OK);
    he_soup_clear(&soup);
    he_triangulation t = triangulation_of(m, 0, HE_AVOID_EDGES);
    assert_true(t.steps > FACES);
    he_triangulation_clear(&t);
    he_mesh_free(m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(small_concave_polygons_are_triangulated),
        cmocka_unit_test(a_dart_is_triangulated_at_any_scale),
        cmocka_unit_test(stars_combs_and_spirals_of_600_corners_are_triangulated),
        cmocka_unit_test(a_convex_face_of_20000_corners_takes_no_quadratic_time),
        cmocka_unit_test(degenerate_faces_are_triangulated_and_reported),
        cmocka_unit_test(diagonals_avoid_existing_edges_or_the_edit_is_refused),
        cmocka_unit_test(blocked_ears_are_passed_over_or_the_edit_is_refused),
        cmocka_unit_test(two_faces_of_a_list_do_not_get_the_same_diagonal),
        cmocka_unit_test(a_hole_is_filled_by_each_method),
        cmocka_unit_test(faces_that_share_two_hubs_take_no_quadratic_time),
        cmocka_unit_test(equal_faces_are_triangulated_equally),
        cmocka_unit_test(any_diagonals_take_fewer_steps_than_the_best_ones),
        cmocka_unit_test(searching_for_edges_counts_as_work),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
