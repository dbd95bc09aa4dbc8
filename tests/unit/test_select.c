/* The operation select on meshes where the result is known beforehand, and how its sets behave in
 * later edits. tests/model/test_select.c compares it with an oracle on random meshes. */
#include "edit_script.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "algo/shape.h"
#include "build/build.h"
#include "mesh/walk.h"
#include "select/lasso.h"
#include "select/select.h"

/* Makes a shape whose first parameters are `first` and `second`. */
static he_mesh *shape_mesh(const char *name, double first, double second)
{
    double args[HE_SHAPE_PARAMS];
    const he_shape *shape = he_shape_find(name, strlen(name));
    he_soup soup;
    he_mesh *m = NULL;
    assert_non_null(shape);
    he_shape_defaults(shape, args);
    args[0] = first;
    args[1] = second;
    assert_int_equal(he_shape_make(shape, args, NULL, &soup, NULL), HE_OK);
    assert_int_equal(he_build(&soup, HE_BUILD_TAKE, &m, NULL, NULL), HE_OK);
    he_soup_clear(&soup);
    return m;
}

/* Returns whether a bool attribute of an element is true. */
static bool has(const he_mesh *m, he_kind kind, const char *name, uint32_t id)
{
    const he_column *column = he_mesh_find_column(m, kind, name);
    assert_non_null(column);
    assert_int_equal(column->type, HE_BOOL);
    return *he_column_value(column, id) != 0;
}

static void assert_set(const he_mesh *m, he_kind kind, const char *name, const char *expected)
{
    he_ids list = {0};
    for (uint32_t id = 0; id < he_mesh_issued(m, kind); id++) {
        if (he_mesh_is_live(m, kind, id) && has(m, kind, name, id)) {
            assert_int_equal(he_ids_add(&list, id, NULL), HE_OK);
        }
    }
    assert_ids(&list, expected);
    he_ids_clear(&list);
}

static uint32_t count_in(const he_mesh *m, he_kind kind, const char *name)
{
    uint32_t count = 0;
    for (uint32_t id = 0; id < he_mesh_issued(m, kind); id++) {
        count += he_mesh_is_live(m, kind, id) && has(m, kind, name, id);
    }
    return count;
}

/* Runs the operation with the elements of a set as its seeds. */
static void select_from(he_mesh *m, const he_select_rule *rule, const char *set, const char *into)
{
    he_ids seeds = {0};
    for (uint32_t id = 0; id < he_mesh_issued(m, rule->of); id++) {
        if (has(m, rule->of, set, id)) {
            assert_int_equal(he_ids_add(&seeds, id, NULL), HE_OK);
        }
    }
    he_select_rule seeded = *rule;
    seeded.seeds = seeds.ids;
    seeded.seed_count = seeds.count;
    seeded.seed_kind = rule->of;
    const he_set_into to = {into, 0, HE_SET_ONLY};
    assert_int_equal(he_select(m, &seeded, &to, NULL, NULL), HE_OK);
    he_ids_clear(&seeds);
}

enum { SIDE = 20, MIDDLE = SIDE / 2 * (SIDE + 1) + SIDE / 2 };

/* Returns an element of the kind near the middle of a grid of SIDE by SIDE cells. */
static uint32_t middle_of(const he_mesh *m, he_kind kind)
{
    const he_halfedge h = he_vertex_halfedge(m, (he_vertex){MIDDLE});
    return kind == HE_VERTEX ? MIDDLE : kind == HE_EDGE ? h.i / 2 : he_face_of(m, h).i;
}

/* Grows the set `disc` and shrinks the result, which becomes the set `again`. */
static void grow_and_shrink(he_mesh *m, he_kind kind, uint32_t steps)
{
    const he_select_rule grow = {.by = HE_BY_GROW, .of = kind, .steps = steps};
    const he_select_rule shrink = {.by = HE_BY_SHRINK, .of = kind, .steps = steps};
    select_from(m, &grow, "disc", "grown");
    assert_true(count_in(m, kind, "grown") > count_in(m, kind, "disc"));
    select_from(m, &shrink, "grown", "again");
}

/* Makes the set `disc`: all elements of a grid that are at most three steps from its middle. */
static void make_disc(he_mesh *m, he_kind kind)
{
    char text[64];
    snprintf(text, sizeof text, "select by=grow %s=%s%u steps=3 into=disc", he_kind_plural(kind),
             kind == HE_EDGE ? "#" : "", middle_of(m, kind));
    script_prepare(m, text);
    if (kind == HE_EDGE) {
        /* The disc around an edge has dents: edges at its border, of which no neighbour is farther
         * away than the disc's other neighbours. Growing and shrinking fills them. */
        const he_select_rule keep = {.by = HE_BY_GROW, .of = kind, .steps = 0};
        grow_and_shrink(m, kind, 1);
        select_from(m, &keep, "again", "disc");
    }
}

static void growing_and_then_shrinking_a_disc_gives_the_disc(void **state)
{
    (void)state;
    static const he_kind kinds[] = {HE_VERTEX, HE_EDGE, HE_FACE};
    for (int triangles = 0; triangles < 2; triangles++) {
        he_mesh *m = shape_mesh("grid", SIDE, SIDE);
        script_prepare(m, triangles ? "triangulate" : NULL);
        for (size_t k = 0; k < 3; k++) {
            const he_kind kind = kinds[k];
            make_disc(m, kind);
            assert_true(count_in(m, kind, "disc") > 20);
            for (uint32_t steps = 1; steps <= 4; steps++) {
                grow_and_shrink(m, kind, steps);
                for (uint32_t id = 0; id < he_mesh_issued(m, kind); id++) {
                    assert_int_equal(has(m, kind, "again", id), has(m, kind, "disc", id));
                }
            }
        }
        he_mesh_free(m);
    }
}

static void a_region_of_a_capped_cylinder_is_its_side_or_a_cap(void **state)
{
    (void)state;
    he_mesh *m = shape_mesh("cylinder", 32, 1);
    uint32_t cap = HE_NONE, side = HE_NONE;
    for (uint32_t f = 0; f < he_mesh_faces(m); f++) {
        *(he_face_degree(m, (he_face){f}) == 4 ? &side : &cap) = f;
    }
    char text[96];
    snprintf(text, sizeof text, "select by=region face=%u angle=0.5", side);
    script_prepare(m, text);
    assert_int_equal(count_in(m, HE_FACE, "selected"), 32);
    /* The sides meet at an angle of 2 pi / 32. */
    snprintf(text, sizeof text, "select by=region face=%u angle=0.19", side);
    script_prepare(m, text);
    assert_int_equal(count_in(m, HE_FACE, "selected"), 1);
    snprintf(text, sizeof text, "select by=region face=%u angle=1.5", cap);
    script_prepare(m, text);
    const uint32_t caps = count_in(m, HE_FACE, "selected");
    assert_true(caps == 1 || caps == 32);
    snprintf(text, sizeof text, "select by=region face=%u angle=1.6", cap);
    script_prepare(m, text);
    assert_int_equal(count_in(m, HE_FACE, "selected"), he_mesh_faces(m));
    he_mesh_free(m);
}

/* Two squares that meet at a right angle, with a triangle without area between them: vertices 1, 2
 * and 4 lie on one line. */
static void a_sliver_neither_joins_nor_separates_what_it_lies_between(void **state)
{
    (void)state;
    static const he_vec3 at[] = {{0, 0, 0},  {1, 0, 0},  {1, 1, 0}, {0, 1, 0}, {1, 0.5, 0},
                                 {1, 0, -1}, {1, 1, -1}, {2, 0, 0}, {2, 1, 0}};
    /* 0123 is flat; the sliver 2 1 4 has the edge 1-2 with it, and the edges 1-4 and 4-2 with the
     * face 1 5 6 2 4, which stands upright. */
    he_mesh *upright = script_mesh("0123,214,41562", at);
    script_prepare(upright, "select by=region face=0 angle=1");
    assert_false(has(upright, HE_FACE, "selected", 2));
    script_prepare(upright, "select by=region face=2 angle=1");
    assert_false(has(upright, HE_FACE, "selected", 0));
    he_mesh_free(upright);
    he_mesh *flat = script_mesh("0123,214,41782", at);
    script_prepare(flat, "select by=region face=0 angle=0");
    assert_set(flat, HE_FACE, "selected", "0 1 2");
    he_mesh_free(flat);
}

static void a_region_stops_at_feature_edges_unless_told_otherwise(void **state)
{
    (void)state;
    he_mesh *m = shape_mesh("grid", 4, 10);
    for (uint32_t e = 0; e < he_mesh_edges(m); e++) {
        const he_halfedge h = {2 * e};
        const bool upright =
            he_position(m, he_origin(m, h)).x == 0 && he_position(m, he_target(m, h)).x == 0;
        char text[48];
        snprintf(text, sizeof text, "mark feature edge=#%u", e);
        script_prepare(m, upright ? text : NULL);
    }
    script_prepare(m, "select by=region face=0 angle=1");
    assert_int_equal(count_in(m, HE_FACE, "selected"), he_mesh_faces(m) / 2);
    script_prepare(m, "select by=region face=0 angle=1 cross_features=1");
    assert_int_equal(count_in(m, HE_FACE, "selected"), he_mesh_faces(m));
    he_mesh_free(m);
}

/* --- the lasso --- */

static const double as_it_is[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};

static bool holds(const double *matrix, const he_vec3 *corners, size_t count, he_vec3 point)
{
    const he_lasso lasso = {matrix, corners, count};
    he_noose *noose = NULL;
    assert_int_equal(he_noose_new(&lasso, &noose, NULL), HE_OK);
    const bool held = he_noose_holds(noose, point);
    he_noose_free(noose);
    return held;
}

static void a_lasso_holds_its_border_and_all_that_it_winds_around(void **state)
{
    (void)state;
    he_vec3 star[5];
    for (int i = 0; i < 5; i++) {
        const double angle = 4 * 3.14159265358979 * i / 5;
        star[i] = (he_vec3){cos(angle), sin(angle), 0};
    }
    assert_true(holds(as_it_is, star, 5, (he_vec3){0, 0, 7}));
    assert_true(holds(as_it_is, star, 5, star[3]));
    assert_false(holds(as_it_is, star, 5, (he_vec3){-0.6, 0, 0}));
    static const he_vec3 square[] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    static const he_vec3 on[] = {{0, 0, 0}, {0.1, 0, 0}, {1, 0.3, 0}, {0, 0.7, 0}, {1, 1, 0}};
    for (size_t i = 0; i < sizeof on / sizeof *on; i++) {
        assert_true(holds(as_it_is, square, 4, on[i]));
    }
    assert_false(holds(as_it_is, square, 4, (he_vec3){nextafter(1, 2), 0.5, 0}));
    assert_false(holds(as_it_is, square, 4, (he_vec3){-1e-300, 0.5, 0}));
    /* a polygon without area holds only points on it */
    static const he_vec3 line[] = {{0, 0, 0}, {1, 1, 0}, {2, 2, 0}};
    assert_true(holds(as_it_is, line, 3, (he_vec3){0.5, 0.5, 0}));
    assert_false(holds(as_it_is, line, 3, (he_vec3){0.5, 0.6, 0}));
}

static void a_lasso_of_a_camera_holds_nothing_behind_the_camera(void **state)
{
    (void)state;
    /* W is -z: the camera looks down along z from the origin. */
    static const double camera[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, -1, 0};
    static const he_vec3 square[] = {
        {-0.5, -0.5, 0}, {0.5, -0.5, 0}, {0.5, 0.5, 0}, {-0.5, 0.5, 0}};
    assert_true(holds(camera, square, 4, (he_vec3){1, 1, -2}));
    assert_true(holds(camera, square, 4, (he_vec3){1e300, -1e300, -2e300}));
    assert_true(holds(camera, square, 4, (he_vec3){1e-300, 1e-300, -2e-300}));
    assert_false(holds(camera, square, 4, (he_vec3){1, 1, -1.9}));
    assert_false(holds(camera, square, 4, (he_vec3){1, 1, 2}));
    assert_false(holds(camera, square, 4, (he_vec3){0, 0, 0}));
    /* numbers at both ends of the range of a double */
    static const he_vec3 huge[] = {{-1e308, -1e308, 0}, {1e308, -1e308, 0}, {0, 1.7e308, 0}};
    assert_true(holds(as_it_is, huge, 3, (he_vec3){3e306, 1.6e308, 0}));
    assert_false(holds(as_it_is, huge, 3, (he_vec3){4e306, 1.6e308, 0}));
    static const double large[16] = {1e300, 0, 0, 0, 0, 1e300, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1e300};
    assert_true(holds(large, square, 4, (he_vec3){0.5, 0.5, 1e308}));
    assert_false(holds(large, square, 4, (he_vec3){0.51, 0.5, 1e308}));
}

static void a_lasso_of_too_many_corners_is_refused(void **state)
{
    (void)state;
    static he_vec3 corners[HE_LASSO_CORNERS + 1];
    for (size_t i = 0; i <= HE_LASSO_CORNERS; i++) {
        const double angle = 6.283185307179586 * (double)i / (HE_LASSO_CORNERS + 1);
        corners[i] = (he_vec3){cos(angle), sin(angle), 0};
    }
    he_noose *noose = NULL;
    he_error err;
    const he_lasso most = {as_it_is, corners, HE_LASSO_CORNERS};
    const he_lasso more = {as_it_is, corners, HE_LASSO_CORNERS + 1};
    assert_int_equal(he_noose_new(&most, &noose, NULL), HE_OK);
    assert_true(he_noose_holds(noose, (he_vec3){0, 0, 0}));
    assert_false(he_noose_holds(noose, (he_vec3){1, 1, 0}));
    he_noose_free(noose);
    assert_int_equal(he_noose_new(&more, &noose, &err), HE_LIMIT);
    assert_non_null(strstr(err.text, "4097 corners; at most 4096"));
}

/* --- the sets --- */

static void results_count_the_elements_that_join_and_leave(void **state)
{
    (void)state;
    he_mesh *m = script_mesh("0123,7654,1045,2156,3267,0374", NULL);
    he_results results = {.each = false};
    script_prepare(m, "mark selected faces=0,1");
    static const struct {
        const char *operation;
        double selected, added, removed;
    } rows[] = {
        {"select by=boundary faces=1,2 mode=add", 3, 1, 0},
        {"select by=boundary faces=2,5 mode=remove", 2, 0, 1},
        {"select by=boundary faces=1,3,4", 3, 2, 1},
        {"select by=boundary faces=1,3,4", 3, 0, 0},
        {"select by=boundary", 0, 0, 3},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        assert_int_equal(script_run(m, rows[i].operation, &results, NULL), HE_OK);
        assert_true(results.number[0] == rows[i].selected);
        assert_true(results.number[1] == rows[i].added);
        assert_true(results.number[2] == rows[i].removed);
    }
    he_results_clear(&results);
    he_mesh_free(m);
}

static int32_t number_at(const he_mesh *m, uint32_t face)
{
    const he_column *column = he_mesh_find_column(m, HE_FACE, "patch");
    int32_t number;
    assert_non_null(column);
    assert_int_equal(column->type, HE_INT32);
    memcpy(&number, he_column_value(column, face), sizeof number);
    return number;
}

static void sets_with_different_values_share_one_attribute(void **state)
{
    (void)state;
    he_mesh *m = script_mesh("0123,7654,1045,2156,3267,0374", NULL);
    script_prepare(m, "select by=boundary faces=0,1 into=patch value=7;"
                      "select by=boundary faces=2 into=patch value=9;"
                      "select by=boundary faces=1,3 into=patch value=9 mode=add");
    static const int32_t first[] = {7, 9, 9, 9, 0, 0};
    for (uint32_t f = 0; f < 6; f++) {
        assert_int_equal(number_at(m, f), first[f]);
    }
    script_prepare(m, "select by=boundary faces=0,1,2 into=patch value=9 mode=remove;"
                      "select by=boundary faces=4 into=patch value=7");
    static const int32_t second[] = {0, 0, 0, 9, 7, 0};
    for (uint32_t f = 0; f < 6; f++) {
        assert_int_equal(number_at(m, f), second[f]);
    }
    he_mesh_free(m);
}

static void the_parts_of_a_face_that_is_cut_stay_in_the_set(void **state)
{
    (void)state;
    he_mesh *m = script_mesh("0123,1045", NULL);
    script_prepare(m, "select by=boundary faces=0;face_poke face=0;edge_split edge=0-1");
    assert_set(m, HE_FACE, "selected", "0 2 3 4 5");
    he_mesh_free(m);
}

static void the_changes_of_a_set_list_its_elements(void **state)
{
    (void)state;
    he_mesh *m = script_mesh("0123,7654,1045,2156,3267,0374", NULL);
    script_prepare(m, "select by=boundary faces=0,1");
    he_delta *delta = he_delta_new();
    assert_non_null(delta);
    (void)he_mesh_record(m, delta);
    script_prepare(m, "select by=boundary faces=1,2,3");
    (void)he_mesh_record(m, NULL);
    he_changes changes = {0};
    assert_int_equal(he_changes_find(m, delta, 0, delta->count, false, &changes, NULL), HE_OK);
    assert_ids(&changes.modified[HE_FACE], "0 2 3");
    assert_int_equal(changes.modified[HE_EDGE].count + changes.modified[HE_VERTEX].count, 0);
    he_changes_clear(&changes);
    he_delta_free(delta);
    he_mesh_free(m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(growing_and_then_shrinking_a_disc_gives_the_disc),
        cmocka_unit_test(a_region_of_a_capped_cylinder_is_its_side_or_a_cap),
        cmocka_unit_test(a_sliver_neither_joins_nor_separates_what_it_lies_between),
        cmocka_unit_test(a_region_stops_at_feature_edges_unless_told_otherwise),
        cmocka_unit_test(a_lasso_holds_its_border_and_all_that_it_winds_around),
        cmocka_unit_test(a_lasso_of_a_camera_holds_nothing_behind_the_camera),
        cmocka_unit_test(a_lasso_of_too_many_corners_is_refused),
        cmocka_unit_test(results_count_the_elements_that_join_and_leave),
        cmocka_unit_test(sets_with_different_values_share_one_attribute),
        cmocka_unit_test(the_parts_of_a_face_that_is_cut_stay_in_the_set),
        cmocka_unit_test(the_changes_of_a_set_list_its_elements),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
