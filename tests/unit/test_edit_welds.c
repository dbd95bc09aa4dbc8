/* Edits that weld vertices, separate bow-ties, and split, dissolve and bevel vertices: single
 * cases, which edits undo each other, which ids survive, and attribute values. */
#include "edit_script.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "edit/bevel/vertex_bevel.h"
#include "edit/merge/weld.h"
#include "mesh/write.h"

#define QCUBE   "0123,7654,1045,2156,3267,0374"
#define STRANGE "012,034,056"
#define HEXAGON "012,023,034,045,056,061"
#define CF3     "0123,3245"
#define BOARD   "0154,2376,56a9,89dc,abfe"

/* --- inverses --- */

/* Requires that two meshes are equal, except that a vertex may store another half-edge: the
 * function first lets each vertex of `m` store the half-edge that the vertex stores in `before`. */
static void assert_same_rings(he_mesh *m, const he_mesh *before)
{
    for (uint32_t v = 0; v < he_mesh_issued(before, HE_VERTEX); v++) {
        he_set_vertex_halfedge(m, (he_vertex){v}, he_vertex_halfedge(before, (he_vertex){v}));
    }
    assert_true(he_mesh_equal_live(m, before));
}

static void collapsing_the_new_edge_undoes_a_split_at_the_boundary(void **state)
{
    (void)state;
    he_mesh *m = script_mesh(CF3, NULL), *before = copy_of(m);
    script_prepare(m, "vertex_split_corners a=3-0 b=3-2");
    assert_counts(m, 7, 8, 2);
    script_prepare(m, "edge_collapse halfedge=6-3 t=1");
    assert_counts(m, 6, 7, 2);
    assert_same_rings(m, before);
    he_mesh_free(before);
    he_mesh_free(m);
}

/* Splits a vertex and collapses the new edge. This must restore the mesh, or be refused if the new
 * edge is an interior edge between two boundary vertices. */
static void split_and_collapse(const he_mesh *before, uint32_t a, uint32_t b)
{
    he_mesh *m = copy_of(before);
    he_results results = {.each = false};
    char text[64];
    snprintf(text, sizeof text, "vertex_split_corners a=#%u b=#%u", a, b);
    he_status status = script_run(m, text, &results, NULL);
    if (status == HE_OK) {
        he_edge e = {results.id[1]};
        he_vertex u = {results.id[0]}, v = he_origin(before, (he_halfedge){a});
        assert_counts(m, he_mesh_vertices(before) + 1, he_mesh_edges(before) + 1,
                      he_mesh_faces(before));
        assert_int_equal(he_origin(m, he_edge_halfedge(e, 0)).i, u.i);
        assert_int_equal(he_target(m, he_edge_halfedge(e, 0)).i, v.i);
        assert_int_equal(he_origin(m, (he_halfedge){a}).i, u.i);
        assert_int_equal(he_origin(m, (he_halfedge){b}).i, v.i);
        bool across = !he_is_boundary_edge(m, e) && he_is_boundary_vertex(m, u) &&
                      he_is_boundary_vertex(m, v);
        snprintf(text, sizeof text, "edge_collapse halfedge=#%u t=1", 2 * e.i);
        status = script_run(m, text, NULL, NULL);
        assert_int_equal(status, across ? HE_LINK_CONDITION : HE_OK);
        assert_true(!across || he_vertex_fans(before, v) > 1);
        assert_valid(m);
        if (!across) {
            assert_same_rings(m, before);
        }
    } else {
        assert_int_equal(status, HE_NO_FACE);
        assert_true(he_vertex_fans(before, he_origin(before, (he_halfedge){a})) > 1);
    }
    he_results_clear(&results);
    he_mesh_free(m);
}

static void a_vertex_split_is_undone_by_a_collapse_where_allowed(void **state)
{
    (void)state;
    static const char *const meshes[] = {CF3, HEXAGON, QCUBE, STRANGE, BOARD, "012", "012,021"};
    for (size_t i = 0; i < sizeof meshes / sizeof *meshes; i++) {
        he_mesh *m = script_mesh(meshes[i], NULL);
        for (uint32_t a = 0; a < he_mesh_issued(m, HE_HALFEDGE); a++) {
            he_halfedge b = he_swing_ccw(m, (he_halfedge){a});
            for (; b.i != a; b = he_swing_ccw(m, b)) {
                split_and_collapse(m, a, b.i);
            }
        }
        he_mesh_free(m);
    }
}

static void welds_undo_the_separation_of_bowties(void **state)
{
    (void)state;
    he_mesh *m = script_mesh(STRANGE, NULL), *before = copy_of(m);
    he_results results = {.each = false};
    assert_int_equal(script_run(m, "vertex_separate vertex=0", &results, NULL), HE_OK);
    assert_counts(m, 9, 9, 3);
    assert_int_equal(results.list[0].count, 2);
    assert_loops(m, "333");
    script_prepare(m, "vertex_weld vertices=8,0,7");
    assert_counts(m, 7, 9, 3);
    assert_int_equal(he_vertex_fans(m, (he_vertex){0}), 3);
    assert_face(m, 0, "012");
    assert_face(m, 1, "034");
    assert_face(m, 2, "056");
    he_vec3 p = he_position(m, (he_vertex){0}), q = he_position(before, (he_vertex){0});
    assert_memory_equal(&p, &q, sizeof p);
    script_prepare(m, "separate_bowties");
    assert_counts(m, 9, 9, 3);
    script_prepare(m, "weld tolerance=0");
    assert_counts(m, 7, 9, 3);
    he_results_clear(&results);
    he_mesh_free(before);
    he_mesh_free(m);

    /* In this mesh, four vertices are bow-ties of two fans each. */
    m = script_mesh(BOARD, NULL);
    script_prepare(m, "separate_bowties");
    assert_counts(m, 20, 20, 5);
    assert_loops(m, "44444");
    script_prepare(m, "weld tolerance=0");
    assert_counts(m, 16, 20, 5);
    he_mesh_free(m);
}

static void face_poke_and_vertex_dissolve_undo_each_other(void **state)
{
    (void)state;
    for (unsigned f = 0; f < 6; f++) {
        he_mesh *m = script_mesh(QCUBE, NULL), *before = copy_of(m);
        char text[64];
        snprintf(text, sizeof text, "face_poke face=%u", f);
        script_prepare(m, text);
        assert_counts(m, 9, 16, 9);
        script_prepare(m, "vertex_dissolve vertex=8");
        assert_counts(m, 8, 12, 6);
        assert_true(he_mesh_equal_live(m, before));
        he_mesh_free(before);
        he_mesh_free(m);
    }
    he_mesh *m = script_mesh(HEXAGON, NULL);
    script_prepare(m, "vertex_dissolve vertex=0");
    assert_counts(m, 6, 6, 1);
    assert_face(m, 0, "123456");
    script_prepare(m, "face_poke face=0");
    assert_counts(m, 7, 12, 6);
    he_mesh_free(m);
}

/* --- cases --- */

static void a_cube_vertex_bevels_to_a_triangle_of_limited_width(void **state)
{
    (void)state;
    static const he_vec3 cube[] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                                   {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
    he_mesh *m = script_mesh("0321,4567,0154,1265,2376,3047", cube);
    he_edge kept = edge_between(m, 0, 1);
    he_results results = {.each = false};
    assert_int_equal(script_run(m, "vertex_bevel vertex=0 width=0.25", &results, NULL), HE_OK);
    assert_counts(m, 10, 15, 7);
    assert_int_equal(results.list[0].count, 2);
    assert_int_equal(results.list[1].count, 3);
    assert_int_equal(results.id[2], 6);
    assert_int_equal(he_face_degree(m, (he_face){6}), 3);
    assert_int_equal(he_origin(m, he_face_halfedge(m, (he_face){6})).i, 0);
    /* The old edge from 0 to 1 must keep its id. The bevel has replaced the end 0 of this edge by
     * one of the three new vertices. */
    he_halfedge h = he_edge_halfedge(kept, 0);
    he_vertex end = he_origin(m, h).i == 1 ? he_target(m, h) : he_origin(m, h);
    he_vec3 p = he_position(m, end);
    assert_true(p.x == 0.25 && p.y == 0 && p.z == 0);
    he_results_clear(&results);
    /* If the width is too large for the edges, the bevel must use the largest possible width. */
    script_prepare(m, "vertex_bevel vertex=6 width=1e300");
    assert_counts(m, 12, 18, 8);
    p = he_position(m, (he_vertex){6});
    assert_true(fabs(p.x + p.y + p.z - 2.01) < 1e-12);
    he_mesh_free(m);
}

/* A vertex is merged into the vertex with the lowest id within the tolerance, but never into a
 * vertex that is itself merged into another one. Vertex 1 is near 0 and near 2, but 2 is not near 0
 * and must not be merged into it. */
static void a_weld_does_not_merge_along_a_chain(void **state)
{
    (void)state;
    static const he_vec3 line[] = {{0, 0, 0}, {0.6, 0, 0}, {1.2, 0, 0}, {1.5, 0, 0}, {9, 0, 0}};
    he_mesh *m = script_mesh("+++++", line);
    he_results results = {.each = false};
    assert_int_equal(script_run(m, "weld tolerance=0.75", &results, NULL), HE_OK);
    assert_counts(m, 3, 0, 0);
    assert_int_equal(results.list[0].count, 2);
    assert_int_equal(results.list[0].ids[0], 0);
    assert_int_equal(results.list[0].ids[1], 2);
    assert_true(fabs(he_position(m, (he_vertex){0}).x - 0.3) < 1e-12);
    assert_true(fabs(he_position(m, (he_vertex){2}).x - 1.35) < 1e-12);
    he_results_clear(&results);
    he_mesh_free(m);
}

/* The weld looks up near vertices in the cells of a grid, but only distances may decide which
 * vertices are merged: also at negative coordinates, at the borders of cells, and where cells are
 * smaller than the gap between neighbouring doubles. */
static void only_distance_decides_what_a_weld_merges_at_any_scale(void **state)
{
    (void)state;
    static const struct {
        he_vec3 a, b;
        double tolerance;
        bool one;
    } cases[] = {
        {{0, 0, 0}, {-0.0, 0, 0}, 0, true},
        {{1, 2, 3}, {1, 2, 3.0000000000000004}, 0, false},
        {{-1e-9, 0, 0}, {1e-9, 0, 0}, 3e-9, true},
        {{-1, -1, -1}, {1, 1, 1}, 3.47, true},
        {{-1, -1, -1}, {1, 1, 1}, 3.46, false},
        {{1e300, 0, 0}, {1e300, 0, 0}, 1e-300, true},
        {{1e300, 0, 0}, {1e300, 1e-301, 0}, 1e-300, true},
        {{1e300, 0, 0}, {-1e300, 0, 0}, 1e299, false},
        {{1.7e308, 0, 0}, {-1.7e308, 0, 0}, 1.7e308, false},
        {{3, 0, 0}, {4, 0, 0}, 1, true},
        {{1e9, 0, 0}, {1e9 + 1, 0, 0}, 1, true},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        he_vec3 points[2] = {cases[i].a, cases[i].b};
        he_mesh *m = script_mesh("++", points);
        assert_int_equal(he_weld_near(m, cases[i].tolerance, HE_MERGE_MEAN, NULL, NULL, NULL),
                         HE_OK);
        assert_int_equal(he_mesh_vertices(m), cases[i].one ? 1 : 2);
        assert_valid(m);
        he_mesh_free(m);
    }
}

/* The weld looks up near vertices in the cells of a grid. It must not take quadratic time, neither
 * if all vertices lie in one cell nor if each vertex has a cell of its own. */
static void a_weld_of_100000_vertices_takes_no_quadratic_time(void **state)
{
    (void)state;
    enum { COUNT = 100000 };
    static const double tolerances[] = {0, 1e-310, 1e-20, 0.5, 1e300};
    static const uint32_t left[] = {COUNT, COUNT, COUNT, COUNT, 1};
    for (size_t i = 0; i < sizeof tolerances / sizeof *tolerances; i++) {
        he_mesh *m = he_mesh_new();
        assert_non_null(m);
        assert_int_equal(he_reserve(m, (he_reservation){.vertices = COUNT}, NULL), HE_OK);
        for (uint32_t k = 0; k < COUNT; k++) {
            he_vertex v = he_new_vertex(m);
            he_set_vertex_halfedge(m, v, (he_halfedge){HE_NONE});
            he_set_position(m, v, (he_vec3){1e3 + k, 7, -1e5});
        }
        assert_int_equal(he_weld_near(m, tolerances[i], HE_MERGE_MEAN, NULL, NULL, NULL), HE_OK);
        assert_int_equal(he_mesh_vertices(m), left[i]);
        he_mesh_free(m);
    }
}

static void nan_is_refused_as_tolerance_and_width_without_change(void **state)
{
    (void)state;
    he_mesh *m = script_mesh(QCUBE, NULL), *before = copy_of(m);
    assert_int_equal(he_weld_near(m, NAN, HE_MERGE_MEAN, NULL, NULL, NULL), HE_BAD_VALUE);
    assert_int_equal(he_vertex_bevel(m, (he_vertex){0}, NAN, NULL, NULL, NULL, NULL), HE_BAD_VALUE);
    assert_equal(m, before);
    he_mesh_free(before);
    he_mesh_free(m);
}

static void welds_and_bevels_of_huge_positions_leave_a_valid_mesh(void **state)
{
    (void)state;
    static const he_vec3 far[] = {{1.7e308, 1.7e308, -1.7e308},
                                  {1.7e308, -1.7e308, -1.7e308},
                                  {1.7976931348623157e308, 0, 1e308},
                                  {-1.7976931348623157e308, 0, 1}};
    static const char *const edits[] = {"vertex_weld vertices=0,1,2,3", "weld tolerance=1.7e308",
                                        "vertex_bevel vertex=0 width=1e308",
                                        "vertex_bevel vertex=1 width=1"};
    for (size_t i = 0; i < sizeof edits / sizeof *edits; i++) {
        he_mesh *m = script_mesh("021,013,032,123", far);
        (void)script_run(m, edits[i], NULL, NULL);
        assert_valid(m);
        he_mesh_free(m);
    }
}

/* --- surviving ids --- */

typedef struct edit {
    he_mesh *m;
    he_delta *delta;
    he_changes changes;
} edit;

static edit edit_run(const char *mesh, const char *prepare, const char *script)
{
    edit e = {script_mesh(mesh, NULL), he_delta_new(), {.replaced = false}};
    assert_non_null(e.delta);
    script_prepare(e.m, prepare);
    he_mesh_record(e.m, e.delta);
    script_prepare(e.m, script);
    assert_int_equal(he_changes_find(e.m, e.delta, 0, e.delta->count, false, &e.changes, NULL),
                     HE_OK);
    assert_valid(e.m);
    return e;
}

static void edit_end(edit *e)
{
    he_mesh_record(e->m, NULL);
    he_changes_clear(&e->changes);
    he_delta_free(e->delta);
    he_mesh_free(e->m);
}

static void changes_name_survivors_of_merges_and_parents_of_splits(void **state)
{
    (void)state;
    /* The edges of face 012 are 0 (from 0 to 1), 1 (1 to 2) and 2 (2 to 0); those of face 345 are 3
     * (3 to 4), 4 (4 to 5) and 5 (5 to 3). The weld merges vertex 4 into 2, and vertex 5 into 1. */
    edit e =
        edit_run("012,345", "vertex_move vertices=2,4 to=5,0,0;vertex_move vertices=1,5 to=5,1,0",
                 "weld tolerance=0");
    assert_ids(&e.changes.merged[HE_VERTEX], "4 2 5 1");
    assert_ids(&e.changes.merged[HE_EDGE], "4 1");
    assert_ids(&e.changes.deleted[HE_EDGE], "4");
    assert_face(e.m, 0, "012");
    assert_face(e.m, 1, "321");
    /* Edge 4 was merged into edge 1, which must still run from 1 to 2. */
    assert_int_equal(he_origin(e.m, (he_halfedge){2}).i, 1);
    assert_int_equal(he_face_of(e.m, (he_halfedge){3}).i, 1);
    edit_end(&e);

    /* The weld gives the two faces equal corners, so the faces must be merged, too. */
    e = edit_run("012,345",
                 "vertex_move vertices=0,4 to=0,0,0;vertex_move vertices=1,5 to=5,1,0;"
                 "vertex_move vertices=2,3 to=0,5,0",
                 "weld tolerance=0");
    assert_ids(&e.changes.merged[HE_FACE], "1 0");
    assert_ids(&e.changes.merged[HE_EDGE], "3 2 4 0 5 1");
    assert_ids(&e.changes.modified[HE_FACE], "");
    edit_end(&e);

    e = edit_run(HEXAGON, NULL, "vertex_dissolve vertex=0");
    assert_ids(&e.changes.deleted[HE_FACE], "1 2 3 4 5");
    assert_int_equal(e.changes.merged[HE_FACE].count, 10);
    edit_end(&e);

    e = edit_run(STRANGE, NULL, "vertex_separate vertices=1,0");
    assert_ids(&e.changes.parents[HE_VERTEX], "7 0 8 0");
    assert_int_equal(e.changes.modified[HE_EDGE].count, 4);
    edit_end(&e);

    e = edit_run(QCUBE, NULL, "vertex_bevel vertex=0 width=0.1");
    assert_ids(&e.changes.parents[HE_VERTEX], "8 0 9 0");
    assert_ids(&e.changes.created[HE_EDGE], "12 13 14");
    assert_ids(&e.changes.created[HE_FACE], "6");
    assert_ids(&e.changes.modified[HE_VERTEX], "0");
    assert_ids(&e.changes.deleted[HE_EDGE], "");
    edit_end(&e);

    e = edit_run(CF3, NULL, "vertex_split_corners a=3-0 b=3-2");
    assert_ids(&e.changes.parents[HE_VERTEX], "6 3");
    assert_ids(&e.changes.created[HE_EDGE], "7");
    assert_ids(&e.changes.modified[HE_FACE], "0");
    edit_end(&e);
}

/* --- values --- */

/* Makes a mesh with an attribute "a" of one double for each element of a kind, and runs a script on
 * the mesh. Element i has the value 10 * i before the script; new elements get -1 by default. */
static he_mesh *after(const char *mesh, he_kind domain, he_rule rule, const char *script)
{
    he_mesh *m = script_mesh(mesh, NULL);
    he_column *column = NULL;
    double fallback = -1;
    assert_int_equal(
        he_column_new(&(he_column_schema){"a", domain, HE_DOUBLE, 1, rule}, &column, NULL), HE_OK);
    memcpy(column->fallback, &fallback, sizeof fallback);
    size_t rows = he_mesh_issued(m, domain);
    assert_int_equal(he_column_extend(column, rows, NULL), HE_OK);
    for (size_t i = 0; i < rows; i++) {
        double value = 10.0 * (double)i;
        memcpy(he_column_row(column, i), &value, sizeof value);
    }
    assert_int_equal(he_mesh_add_column(m, column, NULL), HE_OK);
    script_prepare(m, script);
    assert_valid(m);
    return m;
}

static void assert_value(const he_mesh *m, he_kind domain, uint32_t row, double expected)
{
    double value;
    memcpy(&value, he_column_value(he_mesh_find_column(m, domain, "a"), row), sizeof value);
    if (!(fabs(value - expected) < 1e-12)) {
        fail_msg("%s %u holds %g, not %g", he_kind_name(domain), row, value, expected);
    }
}

static void assert_corner(const he_mesh *m, uint32_t face, uint32_t vertex, double expected)
{
    he_halfedge h = he_face_halfedge(m, (he_face){face});
    while (he_origin(m, h).i != vertex) {
        h = he_next(m, h);
    }
    assert_value(m, HE_HALFEDGE, h.i, expected);
}

static void vertex_values_follow_the_rule_of_their_column(void **state)
{
    (void)state;
    static const struct {
        const char *mesh, *script;
        he_rule rule;
        uint32_t vertex;
        double value;
    } cases[] = {
        {"++++", "vertex_weld vertices=3,1,2", HE_INTERPOLATE, 1, 10},
        {"++++", "vertex_weld vertices=3,1,2 position=lowest", HE_INTERPOLATE, 1, 10},
        {"++++", "vertex_weld vertices=3,1,2", HE_COPY, 1, 10},
        {"++++", "vertex_weld vertices=3,1,2", HE_DEFAULT, 1, 10},
        {"120,134", "vertex_separate vertex=1", HE_INTERPOLATE, 5, 10},
        {"120,134", "vertex_separate vertex=1", HE_DEFAULT, 5, -1},
        {CF3, "vertex_split_corners a=3-0 b=3-2", HE_COPY, 6, 30},
        {"021,013,032,123", "vertex_bevel vertex=3 width=1e9", HE_COPY, 4, 30},
        {"021,013,032,123", "vertex_bevel vertex=3 width=1e9", HE_DEFAULT, 3, 30},
        {"021,013,032,123", "vertex_bevel vertex=3 width=1e9", HE_DEFAULT, 4, -1},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        he_mesh *m = after(cases[i].mesh, HE_VERTEX, cases[i].rule, cases[i].script);
        assert_value(m, HE_VERTEX, cases[i].vertex, cases[i].value);
        he_mesh_free(m);
    }
    /* The bevel cuts each edge at 99 hundredths of its length, so the interpolated values must be
     * nearly equal to the values at the far ends of the edges. */
    he_mesh *m =
        after("021,013,032,123", HE_VERTEX, HE_INTERPOLATE, "vertex_bevel vertex=3 width=1e9");
    const uint32_t made[3] = {3, 4, 5};
    for (int i = 0; i < 3; i++) {
        he_halfedge h = he_vertex_halfedge(m, (he_vertex){made[i]}), first = h;
        while (he_target(m, h).i > 2) {
            h = he_swing_ccw(m, h);
            assert_true(h.i != first.i);
        }
        assert_value(m, HE_VERTEX, made[i], 0.01 * 30 + 0.99 * 10 * he_target(m, h).i);
    }
    he_mesh_free(m);
}

static void edge_and_face_values_follow_the_rule_of_their_column(void **state)
{
    (void)state;
    static const char MEET[] = "vertex_move vertices=2,4 to=5,0,0;"
                               "vertex_move vertices=1,5 to=5,1,0;weld tolerance=0";
    he_mesh *m = after("012,345", HE_EDGE, HE_INTERPOLATE, MEET);
    assert_value(m, HE_EDGE, 1, 10);
    he_mesh_free(m);
    m = after("012,345", HE_EDGE, HE_COPY, MEET);
    assert_value(m, HE_EDGE, 1, 10);
    he_mesh_free(m);
    m = after("012,345", HE_FACE, HE_COPY, MEET);
    assert_value(m, HE_FACE, 1, 10);
    he_mesh_free(m);
    m = after(HEXAGON, HE_FACE, HE_INTERPOLATE, "vertex_dissolve vertex=0");
    assert_value(m, HE_FACE, 0, 25);
    he_mesh_free(m);
    m = after(HEXAGON, HE_FACE, HE_COPY, "vertex_dissolve vertex=0");
    assert_value(m, HE_FACE, 0, 0);
    he_mesh_free(m);
    m = after(QCUBE, HE_FACE, HE_COPY, "vertex_bevel vertex=0 width=0.1");
    assert_value(m, HE_FACE, 5, 50);
    assert_value(m, HE_FACE, 6, -1);
    he_mesh_free(m);
    m = after(QCUBE, HE_EDGE, HE_COPY, "vertex_bevel vertex=0 width=0.1");
    assert_value(m, HE_EDGE, 0, 0);
    assert_value(m, HE_EDGE, 12, -1);
    he_mesh_free(m);
}

/* The values belong to half-edges: in face 012 these are 0 (from 0 to 1), 2 (1 to 2) and 4 (2 to
 * 0), in face 345 they are 6 (from 3 to 4), 8 (4 to 5) and 10 (5 to 3). */
static void corners_keep_values_and_a_bevel_interpolates_new_ones(void **state)
{
    (void)state;
    static const char MEET[] = "vertex_move vertices=2,4 to=5,0,0;"
                               "vertex_move vertices=1,5 to=5,1,0;weld tolerance=0";
    he_mesh *m = after("012,345", HE_HALFEDGE, HE_DEFAULT, MEET);
    assert_corner(m, 0, 1, 20);
    assert_corner(m, 0, 2, 40);
    assert_corner(m, 1, 2, 80);
    assert_corner(m, 1, 1, 100);
    he_mesh_free(m);

    /* The half-edges of face 0123 are 0 (from 0 to 1), 2 (1 to 2), 4 (2 to 3) and 6 (3 to 0); in
     * face 3245 the half-edge from 3 to 2 is 5. */
    m = after(CF3, HE_HALFEDGE, HE_COPY, "vertex_split_corners a=3-0 b=3-2");
    assert_corner(m, 0, 3, 60);
    assert_corner(m, 0, 6, 60);
    assert_corner(m, 1, 3, 50);
    he_mesh_free(m);

    m = after(HEXAGON, HE_HALFEDGE, HE_COPY, NULL);
    he_mesh *before = copy_of(m);
    script_prepare(m, "vertex_dissolve vertex=0");
    he_halfedge h = he_face_halfedge(m, (he_face){0}), first = h;
    do {
        double value;
        memcpy(&value, he_column_value(he_mesh_find_column(before, HE_HALFEDGE, "a"), h.i),
               sizeof value);
        assert_value(m, HE_HALFEDGE, h.i, value);
        h = he_next(m, h);
    } while (h.i != first.i);
    he_mesh_free(before);
    he_mesh_free(m);

    /* The half-edges of face 021 are 0 (from 0 to 2), 2 (2 to 1) and 4 (1 to 0). The bevel cuts off
     * the corner at vertex 0; it cuts the edges there at 99 hundredths of their length. */
    m = after("021,013,032,123", HE_HALFEDGE, HE_INTERPOLATE, "vertex_bevel vertex=0 width=1e9");
    he_halfedge out = {0};
    assert_value(m, HE_HALFEDGE, out.i, 0.01 * 0 + 0.99 * 20);
    assert_value(m, HE_HALFEDGE, he_prev(m, out).i, 0.01 * 0 + 0.99 * 40);
    he_mesh_free(m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(collapsing_the_new_edge_undoes_a_split_at_the_boundary),
        cmocka_unit_test(a_vertex_split_is_undone_by_a_collapse_where_allowed),
        cmocka_unit_test(welds_undo_the_separation_of_bowties),
        cmocka_unit_test(face_poke_and_vertex_dissolve_undo_each_other),
        cmocka_unit_test(a_cube_vertex_bevels_to_a_triangle_of_limited_width),
        cmocka_unit_test(a_weld_does_not_merge_along_a_chain),
        cmocka_unit_test(only_distance_decides_what_a_weld_merges_at_any_scale),
        cmocka_unit_test(a_weld_of_100000_vertices_takes_no_quadratic_time),
        cmocka_unit_test(nan_is_refused_as_tolerance_and_width_without_change),
        cmocka_unit_test(welds_and_bevels_of_huge_positions_leave_a_valid_mesh),
        cmocka_unit_test(changes_name_survivors_of_merges_and_parents_of_splits),
        cmocka_unit_test(vertex_values_follow_the_rule_of_their_column),
        cmocka_unit_test(edge_and_face_values_follow_the_rule_of_their_column),
        cmocka_unit_test(corners_keep_values_and_a_bevel_interpolates_new_ones),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
