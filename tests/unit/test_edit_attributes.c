/* Values of attributes after edits, and errors that callers of the C functions can cause but JSON
 * requests cannot. */
#include "edit_script.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "edit/local/bisect.h"
#include "edit/local/collapse.h"
#include "edit/local/poke.h"
#include "edit/local/split.h"
#include "edit/local/vertex.h"
#include "edit/local/vertex_split.h"
#include "edit/whole/transform.h"
#include "mesh/write.h"

/* Adds a column of attribute values, one double named "a" per element: element i has the value 10 *
 * i, and new elements get -1 by default. */
static void add_column(he_mesh *m, he_kind domain, he_rule rule)
{
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
}

static double value_at(const he_mesh *m, he_kind domain, uint32_t row)
{
    double value;
    const he_column *column = he_mesh_find_column(m, domain, "a");
    memcpy(&value, he_column_value(column, row), sizeof value);
    return value;
}

static void assert_value(const he_mesh *m, he_kind domain, uint32_t row, double expected)
{
    double value = value_at(m, domain, row);
    if (!(fabs(value - expected) < 1e-12)) {
        fail_msg("%s %u holds %g, not %g", he_kind_name(domain), row, value, expected);
    }
}

/* Requires that the attribute "a" has this value at the corner of face `face` at vertex
 * `vertex`. */
static void assert_corner(const he_mesh *m, uint32_t face, uint32_t vertex, double expected)
{
    he_halfedge h = he_face_halfedge(m, (he_face){face});
    while (he_origin(m, h).i != vertex) {
        h = he_next(m, h);
    }
    assert_value(m, HE_HALFEDGE, h.i, expected);
}

/* Makes a mesh with one column of attribute values, runs `script` on the mesh, and returns it. */
static he_mesh *after(const char *mesh, he_kind domain, he_rule rule, const char *script)
{
    he_mesh *m = script_mesh(mesh, NULL);
    add_column(m, domain, rule);
    script_prepare(m, script);
    assert_valid(m);
    return m;
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
        {"012,103", "edge_bisect edge=#0 t=0.25", HE_INTERPOLATE, 4, 2.5},
        {"012,103", "edge_bisect edge=#0 t=0.25", HE_COPY, 4, 0},
        {"012,103", "edge_bisect edge=#0 t=0.25", HE_DEFAULT, 4, -1},
        {"012,103", "edge_split edge=1-2 t=0.5", HE_INTERPOLATE, 4, 15},
        {"0123", "face_poke face=0", HE_INTERPOLATE, 4, 15},
        {"0123", "edge_collapse halfedge=2-1 t=0.75", HE_INTERPOLATE, 1, 12.5},
        {"0123", "edge_collapse halfedge=2-1 to=0,0,0", HE_INTERPOLATE, 1, 15},
        {"0123", "edge_collapse halfedge=2-1 t=0.75", HE_COPY, 1, 10},
        {"0123", "edge_collapse halfedge=2-1 t=0.75", HE_DEFAULT, 1, 10},
        {"012,023", "vertex_split vertex=2 left=0 right=null to=0,0,0", HE_INTERPOLATE, 4, 20},
        {"0123", "hole_fill halfedge=1-0 method=fan", HE_INTERPOLATE, 4, 15},
        {"0123", "plane_split point=0.5,0,0 normal=1,0,0", HE_INTERPOLATE, 4, 5},
        {"0123", "plane_split point=0.5,0,0 normal=1,0,0", HE_COPY, 4, 0},
        {"0123", "plane_split point=0.5,0,0 normal=1,0,0", HE_DEFAULT, 4, -1},
        {"012,103", "edge_flip edge=#0", HE_INTERPOLATE, 0, 0},
        {"012,103", "transform matrix=2,0,0,0,0,2,0,0,0,0,2,0,0,0,0,1", HE_INTERPOLATE, 3, 30},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        he_mesh *m = after(cases[i].mesh, HE_VERTEX, cases[i].rule, cases[i].script);
        assert_value(m, HE_VERTEX, cases[i].vertex, cases[i].value);
        he_mesh_free(m);
    }
}

static void edge_and_face_values_follow_the_rule_of_their_column(void **state)
{
    (void)state;
    he_mesh *m = after("012,023", HE_EDGE, HE_COPY, "edge_split edge=#2");
    assert_value(m, HE_EDGE, 5, 20);
    assert_value(m, HE_EDGE, 6, -1);
    he_mesh_free(m);

    m = after("01234", HE_EDGE, HE_INTERPOLATE, "edge_join vertex=2");
    assert_value(m, HE_EDGE, 1, 15);
    he_mesh_free(m);

    m = after("012,023,034,045,056,061", HE_EDGE, HE_INTERPOLATE, NULL);
    uint32_t kept = edge_between(m, 0, 2).i, gone = edge_between(m, 1, 2).i;
    script_prepare(m, "edge_collapse halfedge=1-0");
    assert_value(m, HE_EDGE, kept, 5.0 * (kept + gone));
    he_mesh_free(m);

    static const char *const cuts[] = {
        "face_split face=1 from=1 to=3",
        "face_poke face=1",
        "face_triangulate face=1",
    };
    for (unsigned i = 0; i < 3; i++) {
        m = after("456,0123", HE_FACE, HE_COPY, cuts[i]);
        assert_value(m, HE_FACE, 1, 10);
        assert_value(m, HE_FACE, 2, 10);
        he_mesh_free(m);
        m = after("456,0123", HE_FACE, HE_DEFAULT, cuts[i]);
        assert_value(m, HE_FACE, 1, 10);
        assert_value(m, HE_FACE, 2, -1);
        he_mesh_free(m);
    }
    m = after("0123", HE_FACE, HE_COPY, "plane_split point=0.5,0,0 normal=1,0,0");
    assert_value(m, HE_FACE, 1, 0);
    he_mesh_free(m);
    m = after("012,023", HE_FACE, HE_COPY, "face_join edge=0-2");
    assert_value(m, HE_FACE, 0, 0);
    he_mesh_free(m);
    m = after("012,023", HE_FACE, HE_INTERPOLATE, "face_join edge=0-2");
    assert_value(m, HE_FACE, 0, 5);
    assert_value(m, HE_FACE, 1, -1); /* face 1 is deleted, so its value is the default */
    he_mesh_free(m);
    m = after("012,103,214", HE_EDGE, HE_COPY, "face_delete face=2;edge_flip edge=0-1;compact");
    assert_value(m, HE_EDGE, edge_between(m, 3, 2).i, 0);
    assert_value(m, HE_EDGE, edge_between(m, 1, 2).i, 10);
    he_mesh_free(m);
    m = after("012,023,034,045,056,061", HE_EDGE, HE_COPY,
              "vertex_split vertex=0 left=1 right=4 to=0,0,1");
    assert_value(m, HE_EDGE, edge_between(m, 7, 0).i, -1);
    assert_value(m, HE_EDGE, edge_between(m, 7, 1).i,
                 value_at(m, HE_EDGE, edge_between(m, 0, 1).i));
    he_mesh_free(m);

    m = after("456,0123", HE_FACE, HE_COPY, "hole_fill halfedge=1-0");
    assert_value(m, HE_FACE, 2, -1);
    he_mesh_free(m);
}

/* In the mesh 012,103 the half-edges of face 0 are 0 (from 0 to 1), 2 (1 to 2) and 4 (2 to 0);
 * those of face 1 are 1 (from 1 to 0), 6 (0 to 3) and 8 (3 to 1). */
static void corner_values_follow_the_rule_of_their_column(void **state)
{
    (void)state;
    he_mesh *m = after("012,103", HE_HALFEDGE, HE_INTERPOLATE, "edge_bisect edge=#0 t=0.25");
    assert_corner(m, 0, 0, 0);
    assert_corner(m, 0, 4, 5);
    assert_corner(m, 0, 1, 20);
    assert_corner(m, 1, 1, 10);
    assert_corner(m, 1, 4, 0.25 * 10 + 0.75 * 60);
    assert_corner(m, 1, 0, 60);
    script_prepare(m, "edge_join vertex=4");
    assert_corner(m, 0, 0, 0);
    assert_corner(m, 1, 1, 10);
    assert_corner(m, 1, 0, 60);
    he_mesh_free(m);

    /* When the edge is divided, the old corner at vertex 1 gets another half-edge. Its value must
     * move to this half-edge, even if the column gives default values to new corners. */
    m = after("012,103", HE_HALFEDGE, HE_DEFAULT, "edge_bisect edge=#0 t=0.25");
    assert_corner(m, 1, 1, 10);
    assert_corner(m, 1, 4, -1);
    he_mesh_free(m);

    m = after("012,103", HE_HALFEDGE, HE_INTERPOLATE, "edge_split edge=#0");
    assert_corner(m, 0, 4, 10);
    assert_corner(m, 2, 4, 10);
    assert_corner(m, 2, 2, 40);
    assert_corner(m, 3, 3, 80);
    assert_corner(m, 3, 1, 10);
    he_mesh_free(m);

    m = after("0123", HE_HALFEDGE, HE_INTERPOLATE, "face_split face=0 from=0 to=2");
    assert_corner(m, 0, 0, 0);
    assert_corner(m, 0, 2, 40);
    assert_corner(m, 1, 0, 0);
    assert_corner(m, 1, 2, 40);
    he_mesh_free(m);

    static const char *const cuts[] = {"face_poke face=0", "face_triangulate face=0"};
    for (unsigned i = 0; i < 2; i++) {
        m = after("0123", HE_HALFEDGE, HE_INTERPOLATE, cuts[i]);
        for (uint32_t f = 0; f < he_mesh_faces(m); f++) {
            he_halfedge first = he_face_halfedge(m, (he_face){f}), h = first;
            do {
                uint32_t v = he_origin(m, h).i;
                assert_value(m, HE_HALFEDGE, h.i, v == 4 ? 30 : 20.0 * v);
                h = he_next(m, h);
            } while (h.i != first.i);
        }
        he_mesh_free(m);
    }

    m = after("012,103", HE_HALFEDGE, HE_INTERPOLATE, "edge_flip edge=#0");
    assert_corner(m, 0, 3, 80);
    assert_corner(m, 1, 2, 40);
    he_mesh_free(m);

    /* The collapse moves a corner of face 1 from the deleted vertex 0 to vertex 1: the corner must
     * keep its value. */
    m = after("012,023,034,045,056,061", HE_HALFEDGE, HE_COPY, NULL);
    double at_0 = value_at(m, HE_HALFEDGE, halfedge_between(m, 0, 2).i);
    script_prepare(m, "edge_collapse halfedge=0-1");
    assert_corner(m, 1, 1, at_0);
    he_mesh_free(m);
}

/* --- normals under transform --- */

static void add_normals(he_mesh *m, he_kind domain, he_type type)
{
    he_column *column = NULL;
    assert_int_equal(
        he_column_new(&(he_column_schema){"normal", domain, type, 3, HE_COPY}, &column, NULL),
        HE_OK);
    size_t rows = he_mesh_issued(m, domain);
    assert_int_equal(he_column_extend(column, rows, NULL), HE_OK);
    const double number[3] = {0, 3, 4};
    const float single[3] = {0, 3, 4};
    for (size_t i = 1; i < rows; i++) { /* element 0 keeps the normal 0, 0, 0 */
        memcpy(he_column_row(column, i),
               type == HE_FLOAT ? (const void *)single : (const void *)number, column->row_bytes);
    }
    assert_int_equal(he_mesh_add_column(m, column, NULL), HE_OK);
}

static void assert_normal(const he_mesh *m, he_kind domain, uint32_t row, double x, double y,
                          double z)
{
    const he_column *column = he_mesh_find_column(m, domain, "normal");
    const double expected[3] = {x, y, z};
    for (int i = 0; i < 3; i++) {
        double number;
        float single;
        if (column->type == HE_FLOAT) {
            memcpy(&single, he_column_value(column, row) + 4 * i, sizeof single);
            number = (double)single;
        } else {
            memcpy(&number, he_column_value(column, row) + 8 * i, sizeof number);
        }
        if (!(fabs(number - expected[i]) < 1e-7)) {
            fail_msg("%s %u, component %d: %g, not %g", he_kind_name(domain), row, i, number,
                     expected[i]);
        }
    }
}

static void a_transform_turns_the_normals_of_what_it_moves(void **state)
{
    (void)state;
    /* The matrix doubles all heights: the normal 0, 3, 4 of a plane must then become 0, 3, 2,
     * scaled to length 1. */
    static const char HIGHER[] = "transform matrix=1,0,0,5,0,1,0,0,0,0,2,0,0,0,0,1";
    static const char MIRROR[] = "transform matrix=1,0,0,0,0,1,0,0,0,0,-1,0,0,0,0,1";
    static const char FLAT[] = "transform matrix=1,0,0,0,0,1,0,0,0,0,0,0,0,0,0,1";
    static const char SHIFT[] = "transform matrix=1,0,0,7,0,1,0,0,0,0,1,0,0,0,0,1";
    static const char SLIM[] = "transform matrix=1e-170,0,0,0,0,1e-170,0,0,0,0,1,0,0,0,0,1";
    const double far = sqrt(13);
    static const he_kind domains[] = {HE_VERTEX, HE_HALFEDGE, HE_FACE};
    for (unsigned i = 0; i < 6; i++) {
        he_kind domain = domains[i % 3];
        he_type type = i < 3 ? HE_FLOAT : HE_DOUBLE;
        he_mesh *m = script_mesh("012,023,324", NULL);
        add_normals(m, domain, type);
        script_prepare(m, SHIFT);
        assert_normal(m, domain, 1, 0, 3, 4);
        script_prepare(m, HIGHER);
        assert_normal(m, domain, 0, 0, 0, 0);
        assert_normal(m, domain, 1, 0, 3 / far, 2 / far);
        assert_normal(m, domain, 2, 0, 3 / far, 2 / far);
        script_prepare(m, MIRROR);
        assert_normal(m, domain, 2, 0, 3 / far, -2 / far);
        he_mesh *slim = copy_of(m);
        script_prepare(slim, SLIM);
        assert_normal(slim, domain, 2, 0, 1, 0);
        he_mesh_free(slim);
        script_prepare(m, FLAT);
        assert_normal(m, domain, 2, 0, 0, -1);
        he_mesh_free(m);
    }
    /* Only vertices 2, 3 and 4 are transformed: the normals of these vertices change, but those of
     * corners and faces change only if all corners of the face are transformed. */
    he_mesh *m = script_mesh("012,023,324", NULL);
    add_normals(m, HE_VERTEX, HE_DOUBLE);
    add_normals(m, HE_HALFEDGE, HE_FLOAT);
    add_normals(m, HE_FACE, HE_DOUBLE);
    he_mesh *start = copy_of(m);
    he_delta *delta = he_delta_new();
    assert_non_null(delta);
    he_mesh_record(m, delta);
    script_prepare(m, "transform matrix=1,0,0,5,0,1,0,0,0,0,2,0,0,0,0,1 vertices=2,3,4");
    he_mesh_record(m, NULL);
    assert_normal(m, HE_VERTEX, 1, 0, 3, 4);
    assert_normal(m, HE_VERTEX, 2, 0, 3 / far, 2 / far);
    assert_normal(m, HE_FACE, 1, 0, 3, 4);
    assert_normal(m, HE_FACE, 2, 0, 3 / far, 2 / far);
    assert_normal(m, HE_HALFEDGE, halfedge_between(m, 2, 0).i, 0, 3 / far, 2 / far);
    assert_normal(m, HE_HALFEDGE, halfedge_between(m, 1, 2).i, 0, 3, 4);
    assert_normal(m, HE_HALFEDGE, halfedge_between(m, 3, 4).i, 0, 3 / far, 2 / far);
    he_delta_undo(delta, m);
    assert_equal(m, start);
    he_delta_free(delta);
    he_mesh_free(start);
    he_mesh_free(m);
}

/* --- marks --- */

static bool marked(const he_mesh *m, he_kind kind, const char *name, uint32_t id)
{
    return *he_column_value(he_mesh_find_column(m, kind, name), id) != 0;
}

static void nothing_is_mixed_into_what_is_locked(void **state)
{
    (void)state;
    he_mesh *m = after("012,023,034,045,056,061", HE_EDGE, HE_INTERPOLATE, "mark locked edge=0-2");
    uint32_t kept = edge_between(m, 0, 2).i;
    script_prepare(m, "edge_collapse halfedge=1-0");
    assert_value(m, HE_EDGE, kept, 10.0 * kept);
    he_mesh_free(m);

    m = after("0123", HE_VERTEX, HE_INTERPOLATE, "mark locked vertex=1");
    const he_vec3 there = he_position(m, (he_vertex){1});
    assert_int_equal(he_edge_collapse(m, halfedge_between(m, 2, 1), 0.25, &there, NULL, NULL),
                     HE_OK);
    assert_value(m, HE_VERTEX, 1, 10);
    he_mesh_free(m);

    static const char *const welds[] = {"edge_weld a=0-1 b=3-4", "edge_weld a=0-1 b=3-4 keep=b"};
    for (unsigned i = 0; i < 2; i++) {
        m = after("012,345", HE_EDGE, HE_INTERPOLATE, "mark locked edge=0-1");
        kept = edge_between(m, 0, 1).i;
        script_prepare(m, welds[i]);
        assert_value(m, HE_EDGE, kept, 10.0 * kept);
        he_mesh_free(m);
    }
}

/* Some of the old vertices are locked, in every combination. The vertices that an edit adds between
 * them must not be locked, whatever the column's rule for values is. */
static void a_lock_does_not_spread_to_a_vertex_between(void **state)
{
    (void)state;
    static const char *const edits[] = {"edge_split edge=0-1",
                                        "edge_bisect edge=1-2",
                                        "face_poke face=0",
                                        "subdivide scheme=loop steps=2",
                                        "subdivide scheme=sqrt3 steps=2",
                                        "subdivide scheme=catmull_clark steps=1"};
    static const he_rule rules[] = {HE_COPY, HE_INTERPOLATE, HE_DEFAULT};
    for (size_t i = 0; i < sizeof edits / sizeof *edits; i++) {
        for (size_t k = 0; k < 3 * 7; k++) {
            he_mesh *m = script_mesh("012,103", NULL);
            he_column *column = NULL;
            assert_int_equal(
                he_column_new(&(he_column_schema){"locked", HE_VERTEX, HE_BOOL, 1, rules[k % 3]},
                              &column, NULL),
                HE_OK);
            assert_int_equal(he_column_extend(column, 4, NULL), HE_OK);
            for (uint32_t v = 0; v < 3; v++) {
                *he_column_row(column, v) = (unsigned char)((k / 3 + 1) >> v & 1);
            }
            assert_int_equal(he_mesh_add_column(m, column, NULL), HE_OK);
            script_prepare(m, edits[i]);
            assert_true(he_mesh_issued(m, HE_VERTEX) > 4);
            for (uint32_t v = 0; v < he_mesh_issued(m, HE_VERTEX); v++) {
                assert_int_equal(marked(m, HE_VERTEX, "locked", v),
                                 v < 3 && ((k / 3 + 1) >> v & 1) != 0);
            }
            he_mesh_free(m);
        }
    }
}

/* If an element with a mark is divided, both parts must have the mark. New elements that are not
 * parts of the divided element must not have it. */
static void both_parts_of_a_divided_element_have_its_mark(void **state)
{
    (void)state;
    he_mesh *m = script_mesh("012,103", NULL);
    script_prepare(m, "mark feature edge=0-1;mark locked face=0;mark selected face=1;"
                      "edge_split edge=0-1");
    assert_true(marked(m, HE_EDGE, "feature", edge_between(m, 0, 4).i));
    assert_true(marked(m, HE_EDGE, "feature", edge_between(m, 4, 1).i));
    assert_false(marked(m, HE_EDGE, "feature", edge_between(m, 4, 2).i));
    assert_true(marked(m, HE_FACE, "locked", 0) && marked(m, HE_FACE, "locked", 2));
    assert_false(marked(m, HE_FACE, "locked", 1) || marked(m, HE_FACE, "locked", 3));
    assert_true(marked(m, HE_FACE, "selected", 1) && marked(m, HE_FACE, "selected", 3));
    script_prepare(m, "mark locked face=0;face_poke face=0");
    for (uint32_t f = 0; f < he_mesh_issued(m, HE_FACE); f++) {
        assert_int_equal(marked(m, HE_FACE, "locked", f), f != 1 && f != 3);
    }
    /* A column that has the name of a mark but another type than marks have is an ordinary
     * attribute. */
    he_mesh_free(m);
    m = script_mesh("012,023", NULL);
    he_column *column = NULL;
    assert_int_equal(he_column_new(&(he_column_schema){"feature", HE_EDGE, HE_UINT32, 1, HE_COPY},
                                   &column, NULL),
                     HE_OK);
    assert_int_equal(he_column_extend(column, 5, NULL), HE_OK);
    memset(column->data, 1, 20);
    assert_int_equal(he_mesh_add_column(m, column, NULL), HE_OK);
    script_prepare(m, "edge_flip edge=0-2");
    he_mesh_free(m);
}

static void bad_numbers_points_and_matrices_are_refused_without_change(void **state)
{
    (void)state;
    static const double bad[] = {0, 1, -0.5, 1.5, NAN, INFINITY};
    he_mesh *m = script_mesh("012,103", NULL), *before = copy_of(m);
    he_edge e = {0};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        assert_int_equal(he_edge_bisect(m, e, bad[i], NULL, NULL, NULL), HE_BAD_VALUE);
        assert_int_equal(he_edge_split(m, e, bad[i], NULL, NULL), HE_BAD_VALUE);
    }
    for (size_t i = 2; i < sizeof bad / sizeof *bad; i++) {
        he_halfedge h = halfedge_between(m, 2, 0);
        assert_int_equal(he_edge_collapse(m, h, bad[i], NULL, NULL, NULL), HE_BAD_VALUE);
    }
    he_vec3 nowhere = {0, NAN, 0};
    double matrix[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 1, 1};
    assert_int_equal(he_vertex_add(m, nowhere, NULL, NULL), HE_NOT_FINITE);
    assert_int_equal(he_face_poke(m, (he_face){0}, &nowhere, NULL, NULL, NULL, NULL),
                     HE_NOT_FINITE);
    assert_int_equal(he_edge_collapse(m, halfedge_between(m, 2, 0), 0.5, &nowhere, NULL, NULL),
                     HE_NOT_FINITE);
    assert_int_equal(he_vertex_split(m, (he_vertex){0}, (he_vertex){3}, (he_vertex){HE_NONE},
                                     nowhere, NULL, NULL),
                     HE_NOT_FINITE);
    assert_int_equal(he_transform(m, matrix, NULL, 0, NULL), HE_BAD_VALUE);
    const uint32_t all[3] = {0, 1, 2};
    const he_vec3 two[2] = {{0, 0, 0}, {1, 1, 1}};
    assert_int_equal(he_vertex_move(m, all, 3, HE_MOVE_TO, two, 2, NULL), HE_BAD_VALUE);
    assert_int_equal(he_vertex_move(m, all, 3, HE_MOVE_BY, two, 0, NULL), HE_BAD_VALUE);
    assert_equal(m, before);
    he_mesh_free(before);
    he_mesh_free(m);
}

/* An edit of positions near the largest double must not overflow: the new positions must be
 * finite. */
static void positions_near_the_largest_double_stay_finite(void **state)
{
    (void)state;
    static const he_vec3 far[] = {{1.7e308, 1.7e308, -1.7e308},
                                  {1.7e308, -1.7e308, -1.7e308},
                                  {1.7976931348623157e308, 0, 1e308},
                                  {-1.7976931348623157e308, 0, 1}};
    static const char *const edits[] = {
        "edge_bisect edge=#0 t=0.3", "edge_split edge=#1",
        "face_poke face=0",          "edge_collapse halfedge=0-1 t=0.7",
        "face_triangulate face=0",   "hole_fill halfedge=1-0 method=fan",
    };
    for (size_t i = 0; i < sizeof edits / sizeof *edits; i++) {
        he_mesh *m = script_mesh("0123", far);
        script_prepare(m, edits[i]);
        assert_valid(m);
        he_mesh_free(m);
    }
}

#define CF4       "023,321,031,647,675,745"
#define BIPYRAMID "013,123,203,104,214,024"

static void values_follow_their_rule_when_loops_are_joined_or_split(void **state)
{
    (void)state;
    static const char join[] = "loop_join a=2-0 b=4-6";
    static const char split[] = "loop_split a=0-1 b=1-2 c=2-0";
    /* The script `join` merges vertex 6 into vertex 2, and the edge 4-6 into the edge 0-2. */
    static const he_rule rules[] = {HE_INTERPOLATE, HE_COPY, HE_DEFAULT};
    for (size_t i = 0; i < 3; i++) {
        he_mesh *m = after(CF4, HE_VERTEX, rules[i], join);
        assert_null(he_mesh_find_column(m, HE_VERTEX, "a"));
        assert_corner(m, 3, 2, 60);
        assert_corner(m, 0, 2, 20);
        he_mesh_free(m);
    }
    he_mesh *m = after(CF4, HE_EDGE, HE_INTERPOLATE, NULL);
    uint32_t kept = edge_between(m, 0, 2).i, corner = halfedge_between(m, 6, 4).i;
    script_prepare(m, join);
    assert_value(m, HE_EDGE, kept, 10.0 * kept);
    he_mesh_free(m);
    m = after(CF4, HE_HALFEDGE, HE_DEFAULT, join);
    assert_corner(m, 3, 2, 10.0 * corner);
    assert_corner(m, 0, 2, 10.0 * halfedge_between(m, 2, 3).i);
    he_mesh_free(m);

    /* The script `split` copies the vertices 0, 1 and 2 to the new vertices 5, 6 and 7. It also
     * copies edge 0, which runs from 0 to 1, to the new edge 9. */
    m = after(BIPYRAMID, HE_VERTEX, HE_COPY, split);
    assert_value(m, HE_VERTEX, 6, 10);
    he_mesh_free(m);
    m = after(BIPYRAMID, HE_VERTEX, HE_DEFAULT, split);
    assert_value(m, HE_VERTEX, 6, -1);
    assert_value(m, HE_VERTEX, 1, 10);
    he_mesh_free(m);
    m = after(BIPYRAMID, HE_EDGE, HE_INTERPOLATE, split);
    assert_value(m, HE_EDGE, 9, 0);
    assert_value(m, HE_EDGE, 10, 10.0 * edge_between(m, 1, 2).i);
    he_mesh_free(m);
    for (he_rule rule = HE_COPY; rule <= HE_DEFAULT; rule++) {
        m = after(BIPYRAMID, HE_HALFEDGE, rule, split);
        assert_corner(m, 3, 6, 10);
        assert_corner(m, 6, 1, 10);
        assert_corner(m, 7, 5, rule == HE_DEFAULT ? -1 : 0);
        he_mesh_free(m);
    }
    m = after("012,345", HE_FACE, HE_COPY, "loop_bridge a=1-0 b=4-3");
    assert_value(m, HE_FACE, 1, 10);
    assert_value(m, HE_FACE, 2, -1);
    he_mesh_free(m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(vertex_values_follow_the_rule_of_their_column),
        cmocka_unit_test(edge_and_face_values_follow_the_rule_of_their_column),
        cmocka_unit_test(a_transform_turns_the_normals_of_what_it_moves),
        cmocka_unit_test(nothing_is_mixed_into_what_is_locked),
        cmocka_unit_test(a_lock_does_not_spread_to_a_vertex_between),
        cmocka_unit_test(both_parts_of_a_divided_element_have_its_mark),
        cmocka_unit_test(corner_values_follow_the_rule_of_their_column),
        cmocka_unit_test(bad_numbers_points_and_matrices_are_refused_without_change),
        cmocka_unit_test(positions_near_the_largest_double_stay_finite),
        cmocka_unit_test(values_follow_their_rule_when_loops_are_joined_or_split),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
