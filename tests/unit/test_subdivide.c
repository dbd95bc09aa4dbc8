/* Tests of subdivision against what the papers prove: numbers of elements in closed form, limit
 * positions, boundaries and creases that are cubic B-splines, darts and corners. Other tests in
 * this file are about attributes, ids, undo and cancelling.
 *  The limit position of a vertex is a weighted sum of the positions of the vertex and its
 * neighbours. A subdivision step must not change the limit position, so the tests compute it
 * before and after a step. */
#include "edit_script.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "algo/shape.h"
#include "algo/subdivide.h"
#include "build/build.h"
#include "mesh/check.h"
#include "mesh/marks.h"
#include "mesh/write.h"
#include "tests/failing.h"

static const he_scheme schemes[] = {HE_LOOP, HE_CATMULL_CLARK, HE_LINEAR, HE_SQRT3};
enum { SCHEMES = 4 };
static const double PI = 3.14159265358979323846;

static he_mesh *shape(const char *name, double size)
{
    he_soup soup;
    double args[HE_SHAPE_PARAMS];
    he_mesh *m = NULL;
    const he_shape *s = he_shape_find(name, strlen(name));
    assert_non_null(s);
    he_shape_defaults(s, args);
    args[0] = size;
    assert_int_equal(he_shape_make(s, args, NULL, &soup, NULL), HE_OK);
    assert_int_equal(he_build(&soup, HE_BUILD_TAKE, &m, NULL, NULL), HE_OK);
    he_soup_clear(&soup);
    return m;
}

static void subdivide(he_mesh *m, he_scheme scheme, unsigned steps)
{
    he_error err = {.status = HE_OK};
    if (he_subdivide(m, scheme, steps, NULL, &err) != HE_OK) {
        fail_msg("%s", err.text);
    }
    assert_valid(m);
}

static void assert_near(he_vec3 a, he_vec3 b, double within)
{
    if (!(fabs(a.x - b.x) <= within && fabs(a.y - b.y) <= within && fabs(a.z - b.z) <= within)) {
        fail_msg("%.17g %.17g %.17g is not %.17g %.17g %.17g", a.x, a.y, a.z, b.x, b.y, b.z);
    }
}

static he_vec3 plus(he_vec3 a, double t, he_vec3 b)
{
    return (he_vec3){a.x + t * b.x, a.y + t * b.y, a.z + t * b.z};
}

static he_vec3 at(const he_mesh *m, uint32_t v)
{
    return he_position(m, (he_vertex){v});
}

/* Makes n triangles or quads around vertex 0, not all in one plane. */
static he_mesh *wheel(unsigned n, bool quads)
{
    he_soup soup;
    he_mesh *m = NULL;
    he_soup_init(&soup, NULL);
    assert_int_equal(he_soup_add_vertex(&soup, (he_vec3){0.1, -0.2, 0.7}, NULL), HE_OK);
    unsigned rim = quads ? 2 * n : n;
    for (unsigned i = 0; i < rim; i++) {
        double angle = 2 * PI * i / rim, r = 1 + 0.3 * (i % 3) + 0.1 * (i % 2);
        he_vec3 p = {r * cos(angle), r * sin(angle), 0.2 * (i % 4)};
        assert_int_equal(he_soup_add_vertex(&soup, p, NULL), HE_OK);
    }
    for (unsigned i = 0; i < n; i++) {
        uint32_t a = quads ? 2 * i : i;
        uint32_t corners[4] = {0, 1 + a, 1 + (a + 1) % rim, 1 + (a + 2) % rim};
        assert_int_equal(he_soup_add_face(&soup, corners, quads ? 4 : 3, NULL), HE_OK);
    }
    assert_int_equal(he_build(&soup, HE_BUILD_TAKE, &m, NULL, NULL), HE_OK);
    he_soup_clear(&soup);
    return m;
}

/* Returns the sum of the positions of the neighbours of v. If `across` is true, returns the sum of
 * the positions of the corners opposite to v in the quads at v. */
static he_vec3 ring(const he_mesh *m, uint32_t v, bool across)
{
    he_vec3 sum = {0, 0, 0};
    he_halfedge first = he_vertex_halfedge(m, (he_vertex){v}), h = first;
    do {
        he_halfedge to = across ? he_next(m, he_next(m, h)) : he_twin(h);
        sum = plus(sum, 1, at(m, he_origin(m, to).i));
        h = he_swing_ccw(m, h);
    } while (h.i != first.i);
    return sum;
}

static he_vec3 loop_limit(const he_mesh *m, unsigned n)
{
    double c = 0.375 + 0.25 * cos(2 * PI / n), beta = (0.625 - c * c) / n;
    double w = 1 / (3 / (8 * beta) + n);
    he_vec3 none = {0, 0, 0};
    return plus(plus(none, 1 - n * w, at(m, 0)), w, ring(m, 0, false));
}

static he_vec3 catmull_clark_limit(const he_mesh *m, unsigned n)
{
    he_vec3 sum = plus((he_vec3){0, 0, 0}, (double)n * n, at(m, 0));
    sum = plus(plus(sum, 4, ring(m, 0, false)), 1, ring(m, 0, true));
    return plus((he_vec3){0, 0, 0}, 1.0 / (n * (n + 5)), sum);
}

static he_vec3 sqrt3_limit(const he_mesh *m, unsigned n)
{
    double alpha = (4 - 2 * cos(2 * PI / n)) / 9, beta = 3 * alpha / (1 + 3 * alpha);
    return plus(plus((he_vec3){0, 0, 0}, 1 - beta, at(m, 0)), beta / n, ring(m, 0, false));
}

static void steps_keep_limit_positions(void **state)
{
    (void)state;
    for (unsigned n = 3; n < 40; n += n < 10 ? 1 : 7) {
        he_mesh *m = wheel(n, false);
        he_vec3 limit = loop_limit(m, n);
        subdivide(m, HE_LOOP, 1);
        assert_near(loop_limit(m, n), limit, 1e-12);
        subdivide(m, HE_LOOP, 3);
        assert_near(loop_limit(m, n), limit, 1e-12);
        he_mesh_free(m);
        m = wheel(n, true);
        limit = catmull_clark_limit(m, n);
        subdivide(m, HE_CATMULL_CLARK, 1);
        assert_near(catmull_clark_limit(m, n), limit, 1e-12);
        subdivide(m, HE_CATMULL_CLARK, 3);
        assert_near(catmull_clark_limit(m, n), limit, 1e-12);
        he_mesh_free(m);
        m = wheel(n, false);
        limit = sqrt3_limit(m, n);
        subdivide(m, HE_SQRT3, 1);
        assert_near(sqrt3_limit(m, n), limit, 1e-12);
        subdivide(m, HE_SQRT3, 4);
        assert_near(sqrt3_limit(m, n), limit, 1e-12);
        he_mesh_free(m);
    }
}

/* By the paper, the limit of a regular vertex in the scheme `loop` has weight one half for the
 * vertex itself, and a twelfth for each neighbour. */
static void a_regular_vertex_has_the_known_limit(void **state)
{
    (void)state;
    he_mesh *m = wheel(6, false);
    he_vec3 limit = plus(plus((he_vec3){0, 0, 0}, 0.5, at(m, 0)), 1.0 / 12, ring(m, 0, false));
    subdivide(m, HE_LOOP, 7);
    assert_near(at(m, 0), limit, 1e-4);
    he_mesh_free(m);
}

/* The limit of a vertex v with three quads is (9 v + 4 e + f) / 24, where e is the sum of its
 * neighbours and f the sum of the opposite corners of its quads. At the corner v = (s, s, s) of a
 * cube, e is (s, s, s) and f is (-s, -s, -s). */
static void the_corner_of_a_cube_comes_to_half_its_place(void **state)
{
    (void)state;
    he_mesh *m = shape("cube", 2);
    he_vec3 corner = at(m, 0);
    subdivide(m, HE_CATMULL_CLARK, 6);
    assert_near(at(m, 0), plus((he_vec3){0, 0, 0}, 0.5, corner), 5e-3);
    assert_near(catmull_clark_limit(m, 3), plus((he_vec3){0, 0, 0}, 0.5, corner), 1e-12);
    he_mesh_free(m);
}

static void counts_follow_their_formulas(void **state)
{
    (void)state;
    he_subdivide_counts c[4];
    he_mesh *m = script_mesh("021,013,032,123", NULL);
    assert_int_equal(he_subdivide(m, HE_LOOP, 4, c, NULL), HE_OK);
    for (unsigned i = 0, faces = 16; i < 4; i++, faces *= 4) {
        assert_int_equal(c[i].faces, faces);
        assert_int_equal(c[i].edges, faces * 3 / 2);
        assert_int_equal(c[i].vertices, 2 + faces / 2);
    }
    assert_counts(m, c[3].vertices, c[3].edges, c[3].faces);
    he_mesh_free(m);
    m = script_mesh("021,013,032,123", NULL);
    assert_int_equal(he_subdivide(m, HE_SQRT3, 4, c, NULL), HE_OK);
    for (unsigned i = 0, faces = 12; i < 4; i++, faces *= 3) {
        assert_int_equal(c[i].faces, faces);
        assert_int_equal(c[i].vertices, 2 + faces / 2);
    }
    assert_counts(m, c[3].vertices, c[3].edges, c[3].faces);
    he_mesh_free(m);
    /* A grid of k by k quads has 4 k edges on its boundary. */
    for (unsigned s = 1; s < 3; s++) {
        m = script_mesh("0143,1254,3476,4587", NULL);
        assert_int_equal(he_subdivide(m, schemes[s], 3, c, NULL), HE_OK);
        for (unsigned i = 0, k = 4; i < 3; i++, k *= 2) {
            assert_int_equal(c[i].vertices, (k + 1) * (k + 1));
            assert_int_equal(c[i].edges, 2 * k * (k + 1));
            assert_int_equal(c[i].faces, k * k);
        }
        assert_int_equal(he_mesh_boundary_halfedges(m), 4 * 16);
        he_mesh_free(m);
    }
    /* Two steps of the scheme sqrt3 together divide each side of a triangle into three, and each
     * triangle into nine. */
    m = script_mesh("012", NULL);
    assert_int_equal(he_subdivide(m, HE_SQRT3, 2, c, NULL), HE_OK);
    assert_int_equal(c[1].faces, 9);
    assert_int_equal(c[1].vertices, 10);
    assert_int_equal(he_mesh_boundary_halfedges(m), 9);
    he_mesh_free(m);
}

static const char GRID[] = "014,043,125,154,347,376,458,487";

static he_vec3 slanted(he_vec3 p)
{
    return (he_vec3){2 * p.x - p.y + 3, p.x + p.z / 2 - 1, p.y - 4 * p.z};
}

static void affine_maps_go_before_or_after(void **state)
{
    (void)state;
    for (unsigned s = 0; s < SCHEMES; s++) {
        he_mesh *a = script_mesh(GRID, NULL), *b = script_mesh(GRID, NULL);
        for (uint32_t v = 0; v < he_mesh_vertices(b); v++) {
            he_set_position(b, (he_vertex){v}, slanted(at(b, v)));
        }
        subdivide(a, schemes[s], 4);
        subdivide(b, schemes[s], 4);
        for (uint32_t v = 0; v < he_mesh_vertices(a); v++) {
            assert_near(at(b, v), slanted(at(a, v)), 1e-10);
        }
        he_mesh_free(a);
        he_mesh_free(b);
    }
}

static void a_flat_grid_stays_flat_and_regular(void **state)
{
    (void)state;
    for (unsigned s = 0; s < SCHEMES; s++) {
        he_vec3 p[9];
        for (unsigned i = 0; i < 9; i++) {
            unsigned row = i / 3;
            p[i] = (he_vec3){i % 3, row, 0};
        }
        he_mesh *m = script_mesh(GRID, p);
        subdivide(m, schemes[s], 2);
        for (uint32_t v = 0; v < he_mesh_vertices(m); v++) {
            he_vec3 q = at(m, v);
            assert_true(q.z == 0 && q.x >= 0 && q.x <= 2 && q.y >= 0 && q.y <= 2);
        }
        /* The centre of the grid must stay in its place. */
        assert_near(at(m, 4), p[4], 1e-15);
        he_mesh_free(m);
    }
}

/* Returns (before + 4 v + after) / 6, the limit position of a vertex v on a boundary or feature
 * curve, where `before` and `after` are its neighbours on the curve. */
static he_vec3 spline(const he_mesh *m, uint32_t before, uint32_t v, uint32_t after)
{
    he_vec3 sum = plus(plus(at(m, before), 4, at(m, v)), 1, at(m, after));
    return plus((he_vec3){0, 0, 0}, 1.0 / 6, sum);
}

static he_vec3 boundary_spline(const he_mesh *m, uint32_t v)
{
    he_halfedge h = he_vertex_halfedge(m, (he_vertex){v});
    return spline(m, he_origin(m, he_prev(m, h)).i, v, he_target(m, h).i);
}

static void boundaries_are_cubic_splines(void **state)
{
    (void)state;
    static const struct {
        he_scheme scheme;
        unsigned steps;
    } runs[] = {{HE_LOOP, 1}, {HE_LOOP, 3}, {HE_CATMULL_CLARK, 2}, {HE_SQRT3, 2}, {HE_SQRT3, 4}};
    for (unsigned i = 0; i < sizeof runs / sizeof *runs; i++) {
        he_mesh *m = wheel(7, false);
        he_vec3 limit[8];
        for (uint32_t v = 1; v < 8; v++) {
            limit[v] = boundary_spline(m, v);
        }
        subdivide(m, runs[i].scheme, runs[i].steps);
        for (uint32_t v = 1; v < 8; v++) {
            assert_near(boundary_spline(m, v), limit[v], 1e-12);
        }
        he_mesh_free(m);
    }
}

static void subdivide_marked(const char *marks, he_scheme scheme, unsigned steps, he_mesh **before,
                             he_mesh **after)
{
    he_mesh *m = wheel(6, false);
    script_prepare(m, marks);
    *before = copy_of(m);
    subdivide(m, scheme, steps);
    *after = m;
}

static uint32_t features(const he_mesh *m)
{
    const he_column *column = he_mark_find(m, HE_EDGE, "feature");
    uint32_t count = 0;
    for (uint32_t e = 0; e < he_mesh_edges(m); e++) {
        count += he_is_marked(column, e);
    }
    return count;
}

/* Returns the neighbour of vertex 0 along the feature edge that connected vertices 0 and `rim`
 * before the subdivision. */
static uint32_t along(const he_mesh *m, uint32_t rim)
{
    const he_column *column = he_mark_find(m, HE_EDGE, "feature");
    he_halfedge first = he_vertex_halfedge(m, (he_vertex){0}), h = first;
    uint32_t best = HE_NONE;
    double least = INFINITY;
    do {
        he_vec3 d = plus(at(m, he_target(m, h).i), -1, at(m, rim));
        double distance = d.x * d.x + d.y * d.y + d.z * d.z;
        if (he_is_marked(column, he_edge_of(h).i) && distance < least) {
            least = distance;
            best = he_target(m, h).i;
        }
        h = he_swing_ccw(m, h);
    } while (h.i != first.i);
    assert_int_not_equal(best, HE_NONE);
    return best;
}

static void creases_are_curves_darts_smooth_and_corners_stay(void **state)
{
    (void)state;
    static const struct {
        he_scheme scheme;
        unsigned steps, parts;
    } runs[] = {{HE_LOOP, 1, 2}, {HE_LOOP, 2, 4}, {HE_CATMULL_CLARK, 2, 4}, {HE_SQRT3, 2, 3}};
    for (unsigned i = 0; i < sizeof runs / sizeof *runs; i++) {
        he_mesh *a, *b;
        subdivide_marked("mark feature edges=0-1,0-4", runs[i].scheme, runs[i].steps, &a, &b);
        assert_int_equal(features(b), 2 * runs[i].parts);
        assert_near(spline(b, along(b, 1), 0, along(b, 4)), spline(a, 1, 0, 4), 1e-12);
        he_mesh_free(a);
        he_mesh_free(b);
        subdivide_marked("mark feature edges=0-1,0-3,0-5", runs[i].scheme, runs[i].steps, &a, &b);
        assert_int_equal(features(b), 3 * runs[i].parts);
        assert_near(at(b, 0), at(a, 0), 0);
        he_mesh_free(a);
        he_mesh_free(b);
    }
    /* If exactly one feature edge ends at a vertex (a dart), the vertex must move as if there were
     * no features. The new vertex in the middle of this edge must lie on the old edge. */
    he_mesh *a, *b, *smooth = wheel(6, false);
    subdivide_marked("mark feature edge=0-1", HE_LOOP, 1, &a, &b);
    subdivide(smooth, HE_LOOP, 1);
    assert_near(at(b, 0), at(smooth, 0), 0);
    he_vec3 middle = plus(plus((he_vec3){0, 0, 0}, 0.5, at(a, 0)), 0.5, at(a, 1));
    assert_near(at(b, along(b, 1)), middle, 1e-15);
    he_mesh_free(smooth);
    he_mesh_free(a);
    he_mesh_free(b);
}

static void locked_bowtie_and_isolated_vertices_stay(void **state)
{
    (void)state;
    for (unsigned s = 0; s < SCHEMES; s++) {
        he_mesh *m = wheel(6, false);
        script_prepare(m, "mark locked vertices=0,2");
        he_vec3 p = at(m, 0), q = at(m, 2);
        subdivide(m, schemes[s], 2);
        assert_near(at(m, 0), p, 0);
        assert_near(at(m, 2), q, 0);
        he_mesh_free(m);
        m = script_mesh("012,034,056+", NULL);
        p = at(m, 0);
        q = at(m, 7);
        he_vec3 corner = at(m, 1);
        subdivide(m, schemes[s], 3);
        assert_near(at(m, 0), p, 0);
        assert_near(at(m, 1), corner, 0);
        assert_near(at(m, 7), q, 0);
        assert_true(he_is_isolated(m, (he_vertex){7}));
        assert_int_equal(he_vertex_fans(m, (he_vertex){0}), 3);
        he_mesh_free(m);
    }
}

/* --- attributes --- */

static he_column *add_column(he_mesh *m, const char *name, he_kind domain, he_type type,
                             uint32_t components, he_rule rule)
{
    he_column *column;
    assert_int_equal(
        he_column_new(&(he_column_schema){name, domain, type, components, rule}, &column, NULL),
        HE_OK);
    assert_int_equal(he_column_extend(column, he_mesh_issued(m, domain), NULL), HE_OK);
    assert_int_equal(he_mesh_add_column(m, column, NULL), HE_OK);
    return column;
}

static void values_linear_in_the_position_remain_so(void **state)
{
    (void)state;
    for (unsigned s = 0; s < SCHEMES; s++) {
        he_mesh *m = wheel(6, false);
        he_column *same = add_column(m, "p", HE_VERTEX, HE_DOUBLE, 3, HE_INTERPOLATE);
        he_column *sum = add_column(m, "sum", HE_VERTEX, HE_DOUBLE, 1, HE_INTERPOLATE);
        for (uint32_t v = 0; v < he_mesh_vertices(m); v++) {
            he_vec3 p = at(m, v);
            double value = 2 * p.x - 3 * p.y + p.z + 5;
            memcpy(he_column_row(same, v), &p, sizeof p);
            memcpy(he_column_row(sum, v), &value, sizeof value);
        }
        subdivide(m, schemes[s], 2);
        const he_column *now = he_mesh_find_column(m, HE_VERTEX, "p");
        const he_column *total = he_mesh_find_column(m, HE_VERTEX, "sum");
        for (uint32_t v = 0; v < he_mesh_vertices(m); v++) {
            he_vec3 p = at(m, v);
            double value;
            assert_memory_equal(he_column_value(now, v), &p, sizeof p);
            memcpy(&value, he_column_value(total, v), sizeof value);
            assert_true(fabs(value - (2 * p.x - 3 * p.y + p.z + 5)) < 1e-12);
        }
        he_mesh_free(m);
    }
}

/* The attribute `feature` is true by default, so the new edges inside faces get the value true.
 * They must nevertheless not become creases. */
static void what_comes_inside_faces_is_smooth_in_all_steps(void **state)
{
    (void)state;
    for (unsigned s = 0; s < SCHEMES; s++) {
        he_mesh *m = wheel(6, false), *plain = wheel(6, false);
        he_column *feature = add_column(m, "feature", HE_EDGE, HE_BOOL, 1, HE_COPY);
        *feature->fallback = 1;
        subdivide(m, schemes[s], 3);
        subdivide(plain, schemes[s], 3);
        assert_true(features(m) > he_mesh_edges(m) / 2);
        for (uint32_t v = 0; v < he_mesh_vertices(m); v++) {
            assert_near(at(m, v), at(plain, v), 0);
        }
        he_mesh_free(plain);
        he_mesh_free(m);
    }
}

/* A corner attribute without a smoothing rule has the positions of the vertices as its values.
 * After a step, each value must be equal to the position of its vertex. */
static void corners_are_refined_within_their_face(void **state)
{
    (void)state;
    static const char *const meshes[] = {"012,023,034", "0123,024", "01234,0456"};
    for (unsigned i = 0; i < 3; i++) {
        he_mesh *m = script_mesh(meshes[i], NULL);
        he_column *column = add_column(m, "uv", HE_HALFEDGE, HE_DOUBLE, 3, HE_INTERPOLATE);
        he_column *group = add_column(m, "group", HE_FACE, HE_UINT32, 1, HE_COPY);
        for (uint32_t h = 0; h < 2 * he_mesh_edges(m); h++) {
            if (!he_is_boundary_halfedge(m, (he_halfedge){h})) {
                he_vec3 p = at(m, he_origin(m, (he_halfedge){h}).i);
                p.x += 100 * he_face_of(m, (he_halfedge){h}).i; /* different in each face */
                memcpy(he_column_row(column, h), &p, sizeof p);
            }
        }
        for (uint32_t f = 0; f < he_mesh_faces(m); f++) {
            memcpy(he_column_row(group, f), &f, sizeof f);
        }
        subdivide(m, HE_LINEAR, 2);
        const he_column *uv = he_mesh_find_column(m, HE_HALFEDGE, "uv");
        const he_column *of = he_mesh_find_column(m, HE_FACE, "group");
        for (uint32_t h = 0; h < 2 * he_mesh_edges(m); h++) {
            he_vec3 p = at(m, he_origin(m, (he_halfedge){h}).i), value;
            uint32_t f = he_face_of(m, (he_halfedge){h}).i, parent;
            if (f == HE_NONE) {
                continue;
            }
            memcpy(&parent, he_column_value(of, f), sizeof parent);
            memcpy(&value, he_column_value(uv, h), sizeof value);
            value.x -= 100.0 * parent;
            assert_near(value, p, 1e-12);
        }
        he_mesh_free(m);
    }
}

/* The scheme sqrt3 flips edges. Afterwards every corner must have a value that comes from the old
 * face in whose area the corner lies. */
static void corners_of_flipped_triangles_are_of_their_face(void **state)
{
    (void)state;
    he_mesh *m = wheel(6, false);
    he_column *column = add_column(m, "c", HE_HALFEDGE, HE_DOUBLE, 1, HE_INTERPOLATE);
    he_column *group = add_column(m, "group", HE_FACE, HE_UINT32, 1, HE_COPY);
    for (uint32_t h = 0; h < 2 * he_mesh_edges(m); h++) {
        uint32_t f = he_face_of(m, (he_halfedge){h}).i;
        double value = f;
        if (f != HE_NONE) {
            memcpy(he_column_row(column, h), &value, sizeof value);
            memcpy(he_column_row(group, f), &f, sizeof f);
        }
    }
    subdivide(m, HE_SQRT3, 1);
    const he_column *c = he_mesh_find_column(m, HE_HALFEDGE, "c");
    const he_column *of = he_mesh_find_column(m, HE_FACE, "group");
    for (uint32_t h = 0; h < 2 * he_mesh_edges(m); h++) {
        uint32_t f = he_face_of(m, (he_halfedge){h}).i, parent;
        double value;
        if (f != HE_NONE && he_origin(m, (he_halfedge){h}).i < 7) {
            memcpy(&value, he_column_value(c, h), sizeof value);
            memcpy(&parent, he_column_value(of, f), sizeof parent);
            assert_true(value == parent);
        }
    }
    he_mesh_free(m);
}

/* --- ids --- */

static void old_ids_name_the_parts_at_their_origin(void **state)
{
    (void)state;
    for (unsigned s = 0; s < 3; s++) {
        he_mesh *m = script_mesh(GRID, NULL);
        script_prepare(m, "face_delete face=3");
        he_mesh *before = copy_of(m);
        uint32_t edges = he_mesh_issued(m, HE_EDGE);
        subdivide(m, schemes[s], 1);
        assert_false(he_mesh_is_live(m, HE_FACE, 3));
        for (uint32_t e = 0, next = he_mesh_issued(before, HE_VERTEX); e < edges; e++) {
            if (he_mesh_is_live(before, HE_EDGE, e)) {
                assert_int_equal(he_origin(m, (he_halfedge){2 * e}).i,
                                 he_origin(before, (he_halfedge){2 * e}).i);
                assert_int_equal(he_target(m, (he_halfedge){2 * e}).i, next++);
            }
        }
        for (uint32_t f = 0; f < he_mesh_issued(before, HE_FACE); f++) {
            if (he_mesh_is_live(before, HE_FACE, f)) {
                assert_int_equal(he_origin(m, he_face_halfedge(m, (he_face){f})).i,
                                 he_origin(before, he_face_halfedge(before, (he_face){f})).i);
            }
        }
        he_mesh_free(before);
        he_mesh_free(m);
    }
}

/* --- undo, cancelling --- */

static void undo_is_one_step_and_issues_no_id_again(void **state)
{
    (void)state;
    he_mesh *m = wheel(6, false), *before = copy_of(m);
    he_delta *delta = he_delta_new();
    he_mesh_record(m, delta);
    subdivide(m, HE_LOOP, 3);
    he_changes changes;
    assert_int_equal(he_changes_find(m, delta, 0, delta->count, false, &changes, NULL), HE_OK);
    assert_true(changes.replaced && !changes.renumbered);
    he_changes_clear(&changes);
    assert_int_equal(delta->count, 1);
    he_mesh_record(m, NULL);
    he_mesh *after = copy_of(m);
    uint32_t issued = he_mesh_issued(m, HE_FACE);
    assert_int_equal(he_delta_ready(delta, m, NULL), HE_OK);
    he_delta_undo(delta, m);
    assert_valid(m);
    assert_true(he_mesh_equal_live(m, before));
    assert_int_equal(he_mesh_issued(m, HE_FACE), issued);
    assert_int_equal(he_delta_ready(delta, m, NULL), HE_OK);
    he_delta_redo(delta, m);
    assert_equal(m, after);
    he_delta_free(delta);
    he_mesh_free(after);
    he_mesh_free(before);
    he_mesh_free(m);
}

static void making_ready_for_undo_may_lack_memory(void **state)
{
    (void)state;
    failing f = {0};
    while (failing_next(&f)) {
        failing_pause();
        he_mesh *m = wheel(6, false), *before = copy_of(m);
        he_delta *delta = he_delta_new();
        he_mesh_record(m, delta);
        subdivide(m, HE_CATMULL_CLARK, 2);
        he_mesh_record(m, NULL);
        he_mesh *after = copy_of(m);
        failing_resume();
        he_status status = he_delta_ready(delta, m, NULL);
        failing_status(&f, status);
        assert_equal(m, after);
        assert_int_equal(he_delta_ready(delta, m, NULL), HE_OK);
        he_delta_undo(delta, m);
        assert_valid(m);
        assert_true(he_mesh_equal_live(m, before));
        he_delta_free(delta);
        he_mesh_free(after);
        he_mesh_free(before);
        he_mesh_free(m);
    }
}

static unsigned told;
static double last;

static bool give_up_at(void *context, const char *phase, double done)
{
    (void)phase;
    assert_true(done >= last && done <= 1);
    last = done;
    return ++told < *(unsigned *)context;
}

static void it_can_be_given_up_wherever_it_tells(void **state)
{
    (void)state;
    for (unsigned s = 0; s < SCHEMES; s++) {
        he_status status = HE_CANCELLED;
        for (unsigned n = 1; status == HE_CANCELLED; n++) {
            he_mesh *m = wheel(6, false), *before = copy_of(m);
            add_column(m, "uv", HE_HALFEDGE, HE_DOUBLE, 2, HE_INTERPOLATE);
            add_column(before, "uv", HE_HALFEDGE, HE_DOUBLE, 2, HE_INTERPOLATE);
            he_progress progress;
            told = 0;
            last = 0;
            he_progress_init(&progress, give_up_at, &n);
            he_mesh_set_progress(m, &progress);
            status = he_subdivide(m, schemes[s], 2, NULL, NULL);
            he_mesh_set_progress(m, NULL);
            if (status == HE_CANCELLED) {
                assert_equal(m, before);
            } else {
                assert_int_equal(status, HE_OK);
                assert_true(n > 8);
            }
            he_mesh_free(m);
            he_mesh_free(before);
        }
    }
}

static void coordinates_as_large_as_doubles_get_stay_finite(void **state)
{
    (void)state;
    for (unsigned s = 0; s < SCHEMES; s++) {
        he_mesh *m = wheel(6, false);
        for (uint32_t v = 0; v < he_mesh_vertices(m); v++) {
            he_vec3 p = {v % 2 ? 1.797e308 : -1.797e308, 1.797e308, v};
            he_set_position(m, (he_vertex){v}, p);
        }
        subdivide(m, schemes[s], 3); /* also checks that positions are finite (I11) */
        assert_true(at(m, 0).y > 1.79e308);
        he_mesh_free(m);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(steps_keep_limit_positions),
        cmocka_unit_test(a_regular_vertex_has_the_known_limit),
        cmocka_unit_test(the_corner_of_a_cube_comes_to_half_its_place),
        cmocka_unit_test(counts_follow_their_formulas),
        cmocka_unit_test(affine_maps_go_before_or_after),
        cmocka_unit_test(a_flat_grid_stays_flat_and_regular),
        cmocka_unit_test(boundaries_are_cubic_splines),
        cmocka_unit_test(creases_are_curves_darts_smooth_and_corners_stay),
        cmocka_unit_test(locked_bowtie_and_isolated_vertices_stay),
        cmocka_unit_test(values_linear_in_the_position_remain_so),
        cmocka_unit_test(what_comes_inside_faces_is_smooth_in_all_steps),
        cmocka_unit_test(corners_are_refined_within_their_face),
        cmocka_unit_test(corners_of_flipped_triangles_are_of_their_face),
        cmocka_unit_test(old_ids_name_the_parts_at_their_origin),
        cmocka_unit_test(undo_is_one_step_and_issues_no_id_again),
        cmocka_unit_test(making_ready_for_undo_may_lack_memory),
        cmocka_unit_test(it_can_be_given_up_wherever_it_tells),
        cmocka_unit_test(coordinates_as_large_as_doubles_get_stay_finite),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
