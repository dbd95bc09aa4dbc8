/* Edits that extrude and inset regions of faces, collapse and reverse faces, make the dual of a
 * mesh, and append a mesh. The tests check which ids survive, positions, and attribute values. */
#include "edit_script.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "build/build.h"
#include "edit/region/extrude.h"
#include "edit/region/inset.h"
#include "edit/whole/append.h"
#include "edit/whole/dual.h"
#include "edit/whole/reverse.h"
#include "mesh/write.h"
#include "tests/failing.h"

#define QCUBE "0123,7654,1045,2156,3267,0374"

/* Positions of the corners of a unit square in the plane z = 0 and of a triangle beside the
 * square. */
static const he_vec3 flat[] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {2, 0.5, 0}};

static const he_vec3 cube[] = {{0, 0, 0}, {0, 1, 0}, {1, 1, 0}, {1, 0, 0},
                               {0, 0, 1}, {0, 1, 1}, {1, 1, 1}, {1, 0, 1}};

static void assert_at(const he_mesh *m, uint32_t v, double x, double y, double z)
{
    he_vec3 p = he_position(m, (he_vertex){v});
    if (fabs(p.x - x) + fabs(p.y - y) + fabs(p.z - z) > 1e-12) {
        fail_msg("vertex %u is at %.17g, %.17g, %.17g", v, p.x, p.y, p.z);
    }
}

static void run(he_mesh *m, const char *operation)
{
    he_error err = {.status = HE_OK};
    if (script_run(m, operation, NULL, &err) != HE_OK) {
        fail_msg("%s: %s", operation, err.text);
    }
    assert_valid(m);
}

/* makes a square grid of columns x columns quadrilaterals */
static he_mesh *grid(uint32_t columns)
{
    he_soup soup;
    he_mesh *m = NULL;
    uint32_t across = columns + 1;
    he_soup_init(&soup, NULL);
    for (uint32_t i = 0; i < across * across; i++) {
        uint32_t column = i % across, row = i / across;
        he_vec3 p = {column, row, 0};
        assert_int_equal(he_soup_add_vertex(&soup, p, NULL), HE_OK);
    }
    for (uint32_t i = 0; i < columns * columns; i++) {
        uint32_t v = i / columns * across + i % columns;
        const uint32_t corners[4] = {v, v + 1, v + across + 1, v + across};
        assert_int_equal(he_soup_add_face(&soup, corners, 4, NULL), HE_OK);
    }
    assert_int_equal(he_build(&soup, 0, &m, NULL, NULL), HE_OK);
    he_soup_clear(&soup);
    return m;
}

/* --- extrude --- */

static void an_extruded_face_is_on_top_and_keeps_its_id(void **state)
{
    (void)state;
    he_mesh *m = script_mesh("0123,214", flat);
    he_edge shared = edge_between(m, 1, 2);
    he_results results = {.each = false};
    assert_int_equal(script_run(m, "face_extrude face=0 distance=2", &results, NULL), HE_OK);
    assert_counts(m, 9, 14, 6);
    assert_face(m, 0, "5678");
    assert_face(m, 1, "214");
    assert_face(m, 2, "0165");
    assert_face(m, 3, "1276");
    assert_int_equal(edge_between(m, 1, 2).i, shared.i);
    for (uint32_t v = 0; v < 4; v++) {
        assert_at(m, v, flat[v].x, flat[v].y, 0);
        assert_at(m, 5 + v, flat[v].x, flat[v].y, 2);
    }
    assert_int_equal(results.list[0].count, 4);
    assert_int_equal(results.list[0].ids[0], 5);
    assert_int_equal(results.list[1].count, 8);
    assert_int_equal(results.list[2].count, 4);
    assert_int_equal(results.list[2].ids[3], 5);
    he_results_clear(&results);
    he_mesh_free(m);
}

static void a_region_moves_as_one_with_what_is_inside(void **state)
{
    (void)state;
    he_mesh *m = grid(4);
    he_edge inner = edge_between(m, 12, 13);
    run(m, "face_extrude faces=5,6,9,10 by=0,0,3 region=1");
    assert_counts(m, 25 + 8, 40 + 16, 16 + 8);
    assert_at(m, 12, 2, 2, 3);
    assert_at(m, 6, 1, 1, 0);
    /* The inner edge 12-13 belongs to the extruded region. Its end 13 lies at the rim of the
     * region, so a new vertex must have replaced 13 as an end of this edge. */
    he_halfedge h = he_edge_halfedge(inner, 0);
    h = he_origin(m, h).i == 12 ? h : he_twin(h);
    assert_int_equal(he_origin(m, h).i, 12);
    assert_true(he_target(m, h).i >= 25);
    he_mesh_free(m);
}

static void a_ring_of_faces_has_two_rims(void **state)
{
    (void)state;
    he_mesh *m = grid(5);
    run(m, "face_extrude faces=6,7,8,11,13,16,17,18 distance=1 region=1");
    assert_counts(m, 36 + 16, 60 + 32, 25 + 16);
    he_mesh_free(m);
}

static void faces_that_touch_at_a_vertex_are_two_regions(void **state)
{
    (void)state;
    he_mesh *m = grid(2);
    run(m, "face_extrude faces=0,3 distance=1 region=1");
    assert_counts(m, 9 + 8, 12 + 16, 4 + 8);
    he_mesh_free(m);
}

static void sides_descend_from_their_faces(void **state)
{
    (void)state;
    he_mesh *m = script_mesh("0123,214", flat);
    he_delta *delta = he_delta_new();
    he_changes changes;
    he_mesh_record(m, delta);
    run(m, "face_extrude face=0 by=0,0,1");
    he_mesh_record(m, NULL);
    assert_int_equal(he_changes_find(m, delta, 0, delta->count, false, &changes, NULL), HE_OK);
    assert_int_equal(changes.parents[HE_FACE].count, 8);
    assert_int_equal(changes.parents[HE_FACE].ids[0], 2);
    assert_int_equal(changes.parents[HE_FACE].ids[1], 0);
    assert_int_equal(changes.parents[HE_VERTEX].count, 8);
    assert_int_equal(changes.parents[HE_EDGE].count, 8);
    he_changes_clear(&changes);
    he_delta_free(delta);
    he_mesh_free(m);
}

static he_column *add_column(he_mesh *m, const char *name, he_kind domain, he_type type)
{
    he_column *column = NULL;
    assert_int_equal(
        he_column_new(&(he_column_schema){name, domain, type, 1, HE_COPY}, &column, NULL), HE_OK);
    assert_int_equal(he_column_extend(column, he_mesh_issued(m, domain), NULL), HE_OK);
    assert_int_equal(he_mesh_add_column(m, column, NULL), HE_OK);
    return column;
}

static double number_at(const he_column *column, uint32_t row)
{
    double value;
    memcpy(&value, he_column_value(column, row), sizeof value);
    return value;
}

static void corner_values_follow_the_corners_of_the_top(void **state)
{
    (void)state;
    he_mesh *m = script_mesh("0123,214", flat);
    he_column *u = add_column(m, "u", HE_HALFEDGE, HE_DOUBLE);
    for (uint32_t h = 0; h < he_mesh_issued(m, HE_HALFEDGE); h++) {
        double value = h + 100;
        memcpy(he_column_row(u, h), &value, sizeof value);
    }
    double corner[4];
    for (uint32_t v = 0; v < 4; v++) {
        corner[v] = number_at(u, halfedge_between(m, v, (v + 1) % 4).i);
    }
    run(m, "face_inset face=0 factor=0.5");
    for (uint32_t v = 0; v < 4; v++) {
        uint32_t w = (v + 1) % 4;
        assert_true(number_at(u, halfedge_between(m, 5 + v, 5 + w).i) == corner[v]);
        assert_true(number_at(u, halfedge_between(m, v, w).i) == corner[v]);
        assert_true(number_at(u, halfedge_between(m, w, 5 + w).i) == corner[w]);
        assert_true(number_at(u, halfedge_between(m, 5 + w, 5 + v).i) == corner[w]);
        assert_true(number_at(u, halfedge_between(m, 5 + v, v).i) == corner[v]);
    }
    he_mesh_free(m);
}

/* --- inset --- */

static void a_factor_is_a_part_of_the_way_to_the_mean(void **state)
{
    (void)state;
    he_mesh *m = script_mesh("0123,214", flat);
    run(m, "face_inset face=0 factor=0.5");
    assert_face(m, 0, "5678");
    assert_at(m, 5, 0.25, 0.25, 0);
    assert_at(m, 7, 0.75, 0.75, 0);
    assert_at(m, 0, 0, 0, 0);
    he_mesh_free(m);
}

static void a_distance_moves_sides_in_parallel(void **state)
{
    (void)state;
    static const he_vec3 wide[] = {{0, 0, 0}, {4, 0, 0}, {4, 1, 0}, {0, 1, 0}};
    he_mesh *m = script_mesh("0123", wide);
    run(m, "face_inset face=0 distance=0.25");
    assert_at(m, 4, 0.25, 0.25, 0);
    assert_at(m, 5, 3.75, 0.25, 0);
    assert_at(m, 6, 3.75, 0.75, 0);
    he_mesh_free(m);
}

static void an_inset_ends_before_a_side_vanishes(void **state)
{
    (void)state;
    static const he_vec3 wide[] = {{0, 0, 0}, {4, 0, 0}, {4, 1, 0}, {0, 1, 0}};
    he_mesh *m = script_mesh("0123", wide);
    run(m, "face_inset face=0 distance=100");
    assert_at(m, 4, 0.495, 0.495, 0);
    assert_at(m, 6, 4 - 0.495, 1 - 0.495, 0);
    he_mesh_free(m);
}

/* The face has a reflex corner (the angle inside is more than 180 degrees). While the inset grows,
 * this corner would meet the side below before any side vanishes: the inset must end there. */
static void an_inset_ends_before_a_reflex_corner_meets_a_side(void **state)
{
    (void)state;
    static const he_vec3 notched[] = {{0, 0, 0}, {20, 0, 0}, {20, 10, 0}, {10, 1, 0}, {0, 10, 0}};
    he_mesh *m = script_mesh("01234", notched);
    run(m, "face_inset face=0 distance=100");
    he_vec3 tip = he_position(m, (he_vertex){8});
    he_vec3 left = he_position(m, (he_vertex){5});
    assert_true(tip.y > left.y);
    assert_true(tip.y - left.y < 0.02);
    assert_true(left.y > 0.3 && left.y < 0.6);
    he_mesh_free(m);
}

static void a_region_keeps_what_is_inside_in_place(void **state)
{
    (void)state;
    he_mesh *m = grid(4);
    run(m, "face_inset faces=5,6,9,10 distance=0.25 region=1");
    assert_at(m, 12, 2, 2, 0);
    assert_at(m, 25, 1.25, 1.25, 0);
    assert_counts(m, 33, 56, 24);
    he_mesh_free(m);
    /* The rim of the region moves towards the vertex in the middle of the region, but must never
     * reach this vertex. */
    m = grid(4);
    run(m, "face_inset faces=5,6,9,10 distance=9 region=1");
    assert_at(m, 12, 2, 2, 0);
    assert_at(m, 25, 1.99, 1.99, 0);
    he_mesh_free(m);
}

/* If the values at a face's corners are a linear function of position, the value at each new vertex
 * of an inset must be the value of this function at the position of the vertex. */
static void values_of_an_inset_are_those_at_its_place(void **state)
{
    (void)state;
    static const he_vec3 wide[] = {{0, 0, 0}, {4, 0, 0}, {4, 1, 0}, {0, 1, 0}};
    static const he_vec3 house[] = {{0, 0, 0}, {3, 0, 0}, {4, 2, 0}, {2, 3, 0}, {0, 2, 0}};
    static const struct {
        const char *mesh;
        const he_vec3 *positions;
        const char *operation;
    } cases[] = {
        {"0123,214", flat, "face_inset face=0 factor=0.5"},
        {"0123,214", flat, "face_inset faces=0,1 factor=0.999"},
        {"0123,214", flat, "face_inset faces=0,1 factor=0.25 region=1"},
        {"012", flat, "face_inset face=0 distance=0.1"},
        {"0123", wide, "face_inset face=0 distance=0.25"},
        {"0123", wide, "face_inset face=0 distance=100"},
        {"01234", house, "face_inset face=0 distance=0.5"},
        {"01234", house, "face_inset face=0 factor=0.75"},
        {NULL, NULL, "face_inset faces=5,6,9,10 distance=0.25 region=1"},
        {NULL, NULL, "face_inset faces=5,6,9 distance=0.25 region=1"},
        {NULL, NULL, "face_inset faces=5,6,9 factor=0.5 region=1"},
        {NULL, NULL, "face_inset faces=0,1,2,3,4,8,12 distance=0.125 region=1"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        he_mesh *m =
            cases[i].mesh == NULL ? grid(4) : script_mesh(cases[i].mesh, cases[i].positions);
        uint32_t old = he_mesh_issued(m, HE_VERTEX);
        he_column *field = add_column(m, "field", HE_VERTEX, HE_DOUBLE);
        he_column *parent = add_column(m, "parent", HE_VERTEX, HE_DOUBLE);
        field->rule = HE_INTERPOLATE;
        parent->rule = HE_COPY;
        for (uint32_t v = 0; v < old; v++) {
            he_vec3 p = he_position(m, (he_vertex){v});
            double value = 3 * p.x - 2 * p.y + 1, id = v;
            memcpy(he_column_row(field, v), &value, sizeof value);
            memcpy(he_column_row(parent, v), &id, sizeof id);
        }
        run(m, cases[i].operation);
        for (uint32_t v = old; v < he_mesh_issued(m, HE_VERTEX); v++) {
            he_vec3 p = he_position(m, (he_vertex){v});
            assert_true(fabs(number_at(field, v) - (3 * p.x - 2 * p.y + 1)) < 1e-12);
            uint32_t below = (uint32_t)number_at(parent, v);
            (void)edge_between(m, below, v);
        }
        he_mesh_free(m);
    }
}

/* Even if the values at a face's corners are no linear function of position, the values at the new
 * vertices of an inset must lie between the values at the corners. */
static void values_of_an_inset_lie_between_those_of_its_corners(void **state)
{
    (void)state;
    static const he_vec3 notched[] = {{0, 0, 0}, {20, 0, 0}, {20, 10, 0}, {10, 1, 0}, {0, 10, 0}};
    static const he_vec3 point[] = {{1, 1, 1}, {1, 1, 1}, {1, 1, 1}, {1, 1, 1}, {1, 1, 1}};
    static const he_vec3 vast[] = {{-1e308, 0, 0},
                                   {1e308, -1e308, 0},
                                   {1e308, 1e308, 0},
                                   {0, 1e308, 1e308},
                                   {-1e308, 1e308, 0}};
    const he_vec3 *const places[] = {notched, point, vast};
    static const char *const operations[] = {"face_inset face=0 factor=0.9",
                                             "face_inset face=0 distance=0.3"};
    for (size_t i = 0; i < 6; i++) {
        he_mesh *m = script_mesh("01234", places[i / 2]);
        he_column *field = add_column(m, "field", HE_VERTEX, HE_DOUBLE);
        field->rule = HE_INTERPOLATE;
        for (uint32_t v = 0; v < 5; v++) {
            double value = v % 2;
            memcpy(he_column_row(field, v), &value, sizeof value);
        }
        he_error err = {.status = HE_OK};
        he_status status = script_run(m, operations[i % 2], NULL, &err);
        assert_true(status == HE_OK || status == HE_NO_NORMAL || status == HE_NOT_FINITE);
        assert_valid(m);
        for (uint32_t v = 5; v < he_mesh_issued(m, HE_VERTEX); v++) {
            assert_true(number_at(field, v) >= 0 && number_at(field, v) <= 1);
        }
        he_mesh_free(m);
    }
}

static void a_factor_out_of_range_is_refused(void **state)
{
    (void)state;
    static const double bad[] = {-0.5, 1, 2, NAN};
    const uint32_t face = 0;
    he_mesh *m = script_mesh("0123", flat), *before = copy_of(m);
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        assert_int_equal(he_face_inset(m, &face, 1, false, (he_inset_width){bad[i], 0}, NULL, NULL),
                         HE_BAD_VALUE);
        assert_equal(m, before);
    }
    assert_int_equal(he_face_inset(m, &face, 1, false, (he_inset_width){0, NAN}, NULL, NULL),
                     HE_BAD_VALUE);
    assert_int_equal(he_face_inset(m, &face, 1, false, (he_inset_width){0, INFINITY}, NULL, NULL),
                     HE_OK);
    assert_valid(m);
    he_mesh_free(before);
    he_mesh_free(m);
}

/* --- collapse --- */

static void a_collapsed_face_leaves_its_first_corner_at_the_mean(void **state)
{
    (void)state;
    he_mesh *m = grid(4);
    he_halfedge stored = he_face_halfedge(m, (he_face){5});
    uint32_t first = he_origin(m, stored).i;
    he_results results = {.each = false};
    assert_int_equal(script_run(m, "face_collapse face=5", &results, NULL), HE_OK);
    assert_counts(m, 22, 36, 15);
    assert_int_equal(results.id[0], first);
    assert_at(m, first, 1.5, 1.5, 0);
    assert_int_equal(he_vertex_degree(m, (he_vertex){first}), 8);
    he_results_clear(&results);
    he_mesh_free(m);
}

/* --- reverse --- */

static void reversing_twice_leads_back_bit_for_bit(void **state)
{
    (void)state;
    static const char *const meshes[] = {QCUBE, "012,034,056", "012,345+", "012,023,034", ""};
    for (size_t i = 0; i < sizeof meshes / sizeof *meshes; i++) {
        he_mesh *m = script_mesh(meshes[i], NULL);
        script_add_columns(m);
        he_mesh *before = copy_of(m);
        run(m, "reverse");
        assert_int_equal(he_mesh_equal(m, before), meshes[i][0] == '\0');
        run(m, "reverse");
        assert_equal(m, before);
        he_mesh_free(before);
        he_mesh_free(m);
    }
}

static void a_reversed_face_keeps_its_corners_and_their_values(void **state)
{
    (void)state;
    he_mesh *m = script_mesh("0123,214", flat);
    he_column *u = add_column(m, "u", HE_HALFEDGE, HE_DOUBLE);
    he_column *normal = NULL;
    assert_int_equal(
        he_column_new(&(he_column_schema){"normal", HE_FACE, HE_FLOAT, 3, HE_COPY}, &normal, NULL),
        HE_OK);
    assert_int_equal(he_column_extend(normal, 2, NULL), HE_OK);
    assert_int_equal(he_mesh_add_column(m, normal, NULL), HE_OK);
    const float up[3] = {0, 0, 1};
    memcpy(he_column_row(normal, 0), up, sizeof up);
    for (uint32_t v = 0; v < 4; v++) {
        double value = v + 1;
        memcpy(he_column_row(u, halfedge_between(m, v, (v + 1) % 4).i), &value, sizeof value);
    }
    he_edge e = edge_between(m, 0, 1);
    uint32_t origin = he_origin(m, he_edge_halfedge(e, 0)).i;
    run(m, "reverse");
    assert_face(m, 0, "3210");
    assert_face(m, 1, "412");
    assert_int_equal(he_origin(m, he_edge_halfedge(e, 0)).i, origin);
    for (uint32_t v = 0; v < 4; v++) {
        assert_true(number_at(u, halfedge_between(m, v, (v + 3) % 4).i) == v + 1);
    }
    float down[3];
    memcpy(down, he_column_value(normal, 0), sizeof down);
    assert_true(down[2] == -1);
    he_mesh_free(m);
}

static void part_of_a_component_is_not_reversed(void **state)
{
    (void)state;
    he_mesh *m = script_mesh(QCUBE, cube);
    he_error err = {.status = HE_OK};
    assert_int_equal(script_run(m, "reverse faces=0,2,3,4,5", NULL, &err), HE_ORIENTATION);
    assert_int_equal(err.kind, HE_EDGE);
    he_mesh_free(m);
    m = script_mesh("012,034", NULL);
    assert_int_equal(script_run(m, "reverse face=0", NULL, &err), HE_BOWTIE);
    assert_int_equal(err.kind, HE_VERTEX);
    assert_int_equal(err.id, 0);
    he_mesh_free(m);
}

/* --- dual --- */

static void the_dual_of_a_cube_is_an_octahedron(void **state)
{
    (void)state;
    he_mesh *m = script_mesh(QCUBE, cube);
    run(m, "dual");
    assert_counts(m, 6, 12, 8);
    assert_int_equal(he_mesh_issued(m, HE_VERTEX), 14);
    for (uint32_t i = 0; i < 8; i++) {
        assert_false(he_mesh_is_live(m, HE_VERTEX, i));
    }
    assert_at(m, 8, 0.5, 0.5, 0);
    for (uint32_t f = 6; f < 14; f++) {
        assert_int_equal(he_face_degree(m, (he_face){f}), 3);
    }
    he_mesh_free(m);
}

/* Returns the number of live vertices with smaller ids than v. Vertices with equal ranks in two
 * meshes correspond to each other although their ids differ. */
static uint32_t rank_of(const he_mesh *m, uint32_t v)
{
    uint32_t rank = 0;
    for (uint32_t i = 0; i < v; i++) {
        rank += he_mesh_is_live(m, HE_VERTEX, i);
    }
    return rank;
}

static void the_dual_of_the_dual_has_the_links_of_the_mesh(void **state)
{
    (void)state;
    static const char *const meshes[] = {QCUBE, "021,013,032,123",
                                         "012,023,034,045,051,621,632,643,654,615"};
    for (size_t i = 0; i < sizeof meshes / sizeof *meshes; i++) {
        he_mesh *m = script_mesh(meshes[i], NULL), *before = copy_of(m);
        run(m, "dual");
        run(m, "dual");
        assert_int_equal(he_mesh_edges(m), he_mesh_edges(before));
        uint32_t first = he_mesh_issued(m, HE_EDGE) - he_mesh_edges(m);
        for (uint32_t h = 0; h < 2 * he_mesh_edges(m); h++) {
            /* The dual of a mesh turns each edge by a right angle, so in the dual of the dual each
             * half-edge has the opposite direction. */
            he_halfedge old = {h}, new = {2 * first + (h ^ 1)};
            assert_int_equal(he_next(m, new).i, 2 * first + (he_next(before, old).i ^ 1));
            assert_int_equal(rank_of(m, he_origin(m, new).i), he_origin(before, old).i);
        }
        he_mesh_free(before);
        he_mesh_free(m);
    }
}

/* --- append --- */

static void what_is_appended_is_the_other_mesh(void **state)
{
    (void)state;
    he_mesh *m = script_mesh("0123", flat), *other = script_mesh("0123,214", flat);
    he_appended made;
    script_prepare(other, "face_delete face=0");
    he_mesh *before = copy_of(m), *left = copy_of(other);
    assert_int_equal(he_append(m, other, &made, NULL), HE_OK);
    assert_counts(m, 4 + 3, 4 + 3, 1 + 1);
    assert_int_equal(made.vertices.count, 3);
    assert_int_equal(made.vertices.ids[0], 4);
    assert_int_equal(made.faces.count, 1);
    assert_face(m, made.faces.ids[0], "546");
    assert_at(m, 6, 2, 0.5, 0);
    assert_face(m, 0, "0123");
    assert_equal(other, left);
    he_appended_clear(&made);
    he_mesh_free(left);
    he_mesh_free(before);
    he_mesh_free(other);
    he_mesh_free(m);
}

static void name_labels(he_column *column, const char *a, const char *b)
{
    uint32_t index;
    column->labels = he_labels_new();
    assert_non_null(column->labels);
    assert_int_equal(he_labels_add(column->labels, a, strlen(a), &index, NULL), HE_OK);
    assert_int_equal(he_labels_add(column->labels, b, strlen(b), &index, NULL), HE_OK);
}

static const char *label_at(const he_mesh *m, uint32_t f)
{
    const he_column *column = he_mesh_find_column(m, HE_FACE, "group");
    uint32_t index;
    memcpy(&index, he_column_value(column, f), sizeof index);
    return he_labels_get(column->labels, index);
}

static void labels_are_joined(void **state)
{
    (void)state;
    he_mesh *m = script_mesh("012,034", NULL), *other = script_mesh("012,034", NULL);
    he_column *own = add_column(m, "group", HE_FACE, HE_UINT32);
    he_column *theirs = add_column(other, "group", HE_FACE, HE_UINT32);
    const uint32_t one = 1;
    name_labels(own, "left", "right");
    name_labels(theirs, "top", "left");
    memcpy(he_column_row(own, 1), &one, sizeof one);
    memcpy(he_column_row(theirs, 1), &one, sizeof one);
    he_mesh *before = copy_of(m);
    he_delta *delta = he_delta_new();
    he_mesh_record(m, delta);
    assert_int_equal(he_append(m, other, NULL, NULL), HE_OK);
    he_mesh_record(m, NULL);
    assert_string_equal(label_at(m, 0), "left");
    assert_string_equal(label_at(m, 1), "right");
    assert_string_equal(label_at(m, 2), "top");
    assert_string_equal(label_at(m, 3), "left");
    assert_int_equal(he_labels_count(he_mesh_find_column(m, HE_FACE, "group")->labels), 3);
    he_mesh *after = copy_of(m);
    he_delta_undo(delta, m);
    assert_true(he_mesh_equal_live(m, before));
    assert_int_equal(he_labels_count(he_mesh_find_column(m, HE_FACE, "group")->labels), 2);
    he_delta_redo(delta, m);
    assert_equal(m, after);
    he_mesh_free(after);
    he_delta_free(delta);
    he_mesh_free(before);
    he_mesh_free(other);
    he_mesh_free(m);
}

static void labels_are_joined_or_nothing_changes_when_memory_is_out(void **state)
{
    (void)state;
    failing f = {0};
    while (failing_next(&f)) {
        failing_pause();
        he_mesh *m = script_mesh("012,034", NULL), *other = script_mesh("012,034", NULL);
        name_labels(add_column(m, "group", HE_FACE, HE_UINT32), "left", "right");
        name_labels(add_column(other, "group", HE_FACE, HE_UINT32), "top", "left");
        (void)add_column(other, "weight", HE_VERTEX, HE_FLOAT);
        he_mesh *before = copy_of(m);
        failing_resume();
        he_status status = he_append(m, other, NULL, NULL);
        bool failed = !failing_status(&f, status);
        assert_valid(m);
        if (failed) {
            assert_equal(m, before);
        }
        he_mesh_free(before);
        he_mesh_free(other);
        he_mesh_free(m);
        assert_true(f.n < 200);
    }
}

static void attributes_only_one_has_are_at_their_default_elsewhere(void **state)
{
    (void)state;
    he_mesh *m = script_mesh("012", NULL), *other = script_mesh("012", NULL);
    he_column *own = add_column(m, "own", HE_VERTEX, HE_DOUBLE);
    he_column *theirs = add_column(other, "theirs", HE_VERTEX, HE_DOUBLE);
    const double one = 1, seven = 7;
    memcpy(own->fallback, &seven, sizeof seven);
    for (uint32_t v = 0; v < 3; v++) {
        memcpy(he_column_row(own, v), &one, sizeof one);
        memcpy(he_column_row(theirs, v), &one, sizeof one);
    }
    memcpy(theirs->fallback, &seven, sizeof seven);
    he_column *title = NULL;
    assert_int_equal(
        he_column_new(&(he_column_schema){"title", HE_MESH_KIND, HE_DOUBLE, 1, HE_COPY}, &title,
                      NULL),
        HE_OK);
    assert_int_equal(he_column_extend(title, 1, NULL), HE_OK);
    memcpy(he_column_row(title, 0), &one, sizeof one);
    assert_int_equal(he_mesh_add_column(other, title, NULL), HE_OK);
    assert_int_equal(he_append(m, other, NULL, NULL), HE_OK);
    theirs = NULL;
    for (uint32_t v = 0; v < 6; v++) {
        const he_column *there = he_mesh_find_column(m, HE_VERTEX, "theirs");
        assert_true(number_at(he_mesh_find_column(m, HE_VERTEX, "own"), v) == (v < 3 ? 1 : 7));
        assert_true(number_at(there, v) == (v < 3 ? 7 : 1));
    }
    assert_true(number_at(he_mesh_find_column(m, HE_MESH_KIND, "title"), 0) == 1);
    assert_valid(m);
    he_mesh_free(other);
    he_mesh_free(m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_extruded_face_is_on_top_and_keeps_its_id),
        cmocka_unit_test(a_region_moves_as_one_with_what_is_inside),
        cmocka_unit_test(a_ring_of_faces_has_two_rims),
        cmocka_unit_test(faces_that_touch_at_a_vertex_are_two_regions),
        cmocka_unit_test(sides_descend_from_their_faces),
        cmocka_unit_test(corner_values_follow_the_corners_of_the_top),
        cmocka_unit_test(a_factor_is_a_part_of_the_way_to_the_mean),
        cmocka_unit_test(a_distance_moves_sides_in_parallel),
        cmocka_unit_test(an_inset_ends_before_a_side_vanishes),
        cmocka_unit_test(an_inset_ends_before_a_reflex_corner_meets_a_side),
        cmocka_unit_test(a_region_keeps_what_is_inside_in_place),
        cmocka_unit_test(values_of_an_inset_are_those_at_its_place),
        cmocka_unit_test(values_of_an_inset_lie_between_those_of_its_corners),
        cmocka_unit_test(a_factor_out_of_range_is_refused),
        cmocka_unit_test(a_collapsed_face_leaves_its_first_corner_at_the_mean),
        cmocka_unit_test(reversing_twice_leads_back_bit_for_bit),
        cmocka_unit_test(a_reversed_face_keeps_its_corners_and_their_values),
        cmocka_unit_test(part_of_a_component_is_not_reversed),
        cmocka_unit_test(the_dual_of_a_cube_is_an_octahedron),
        cmocka_unit_test(the_dual_of_the_dual_has_the_links_of_the_mesh),
        cmocka_unit_test(what_is_appended_is_the_other_mesh),
        cmocka_unit_test(labels_are_joined),
        cmocka_unit_test(labels_are_joined_or_nothing_changes_when_memory_is_out),
        cmocka_unit_test(attributes_only_one_has_are_at_their_default_elsewhere),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
