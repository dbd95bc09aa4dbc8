/* Rounding can decide whether an edit moves a vertex. The edit and the oracle (the tests' own model
 * of the edit) compute the new position in different ways, so the oracle must accept both
 * outcomes. */
#include "edit_script.h"
#include "model/corpus.h"
#include "model/marks.h"

#include "mesh/walk.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>

#include <cmocka.h>

#define HEXAGON "012,023,034,045,056,061"
/* two neighbouring doubles, with no other double between them */
#define TARGET 0.87518049095669803
#define ORIGIN 0.87518049095669814

/* Makes a mesh with vertex 0 at `x` and vertex 1 at TARGET. The script `mark` marks elements, so
 * that vertex 1 must not move. */
static he_mesh *kept(double x, const char *mark)
{
    const he_vec3 positions[] = {{x, 0, 0},    {TARGET, 0, 0}, {1, 1, 0}, {0, 1, 0},
                                 {-1, 0.5, 0}, {0, -1, 0},     {1, -1, 0}};
    he_mesh *m = script_mesh(HEXAGON, positions);
    script_prepare(m, mark);
    return m;
}

static or_mesh *oracle_of(const he_mesh *m)
{
    or_mesh *o = or_new();
    md_take(o, m);
    md_read_marks(o, m);
    return o;
}

static void a_target_that_rounding_leaves_in_place_does_not_move(void **state)
{
    (void)state;
    static const char *const marks[2] = {"mark feature edge=1-2", "mark locked vertex=1"};
    assert_true(ORIGIN == nextafter(TARGET, 1));
    for (unsigned i = 0; i < 2; i++) {
        he_mesh *m = kept(ORIGIN, marks[i]);
        he_status refused = i == 0 ? HE_FEATURE_EDGE : HE_LOCKED_ELEMENT;
        assert_int_equal(script_run(m, "edge_collapse halfedge=0-1 t=0", NULL, NULL), refused);
        script_prepare(m, "edge_collapse halfedge=0-1 t=0.25423450207060172");
        assert_true(he_position(m, (he_vertex){1}).x == TARGET);
        assert_valid(m);
        he_mesh_free(m);
    }
}

static void
test_the_oracle_allows_both_where_rounding_decides_whether_the_target_moves(void **state)
{
    (void)state;
    char text[OR_TEXT] = "";
    he_mesh *m = kept(ORIGIN, "mark feature edge=1-2;mark locked vertex=1");
    or_mesh *o = oracle_of(m);
    uint64_t both = OR_BIT(HE_FEATURE_EDGE) | OR_BIT(HE_LOCKED_ELEMENT);
    assert_true(or_edge_collapse(o, &(or_collapse){0, 1, 0.25423450207060172, NULL}) == 0);
    assert_true(o->may == both);
    or_decline(o);
    assert_true(o->may == 0);
    assert_true(or_matches(o, m, text));

    assert_true(or_edge_collapse(o, &(or_collapse){0, 1, 1, NULL}) == 0);
    assert_true(o->may == 0);
    script_prepare(m, "edge_collapse halfedge=0-1 t=1");
    assert_true(or_adopt(o, m, text));
    assert_true(or_matches(o, m, text));
    or_free(o);
    he_mesh_free(m);
}

/* In the oracle (the tests' own model of edits), face_collapse merges the corners of a face one
 * after another. If the real edit refuses one of these merges, the oracle must go back to its state
 * before the first merge. */
static void the_oracle_goes_back_before_all_steps_of_a_face(void **state)
{
    (void)state;
    char text[OR_TEXT] = "";
    he_mesh *m = kept(ORIGIN, "vertex_move vertex=2 to=0.87518049095669803,0,0;"
                              "mark feature edge=1-6");
    or_mesh *o = oracle_of(m);
    assert_true(or_face_collapse(o, 0, 1) == 0);
    assert_true(o->may == OR_BIT(HE_FEATURE_EDGE));
    or_decline(o);
    assert_true(or_matches(o, m, text));
    or_free(o);
    he_mesh_free(m);
}

static void the_oracle_refuses_where_the_target_surely_moves(void **state)
{
    (void)state;
    char text[OR_TEXT] = "";
    he_mesh *m = kept(TARGET - 1e-12, "mark feature edge=1-2");
    or_mesh *o = oracle_of(m);
    assert_true(or_edge_collapse(o, &(or_collapse){0, 1, 0.5, NULL}) == OR_BIT(HE_FEATURE_EDGE));
    assert_true(o->may == 0);
    assert_true(or_matches(o, m, text));
    or_free(o);
    he_mesh_free(m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_target_that_rounding_leaves_in_place_does_not_move),
        cmocka_unit_test(
            test_the_oracle_allows_both_where_rounding_decides_whether_the_target_moves),
        cmocka_unit_test(the_oracle_goes_back_before_all_steps_of_a_face),
        cmocka_unit_test(the_oracle_refuses_where_the_target_surely_moves),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
