/* The tests check which of the old elements keep their ids in an edit, and which parents and merged
 * elements the edit reports. */
#include "edit_script.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "mesh/walk.h"

#define HEXAGON "012,023,034,045,056,061"

typedef struct edit {
    he_mesh *m;
    he_delta *delta;
    he_changes changes;
} edit;

static edit edit_begin(const char *mesh)
{
    edit e = {script_mesh(mesh, NULL), he_delta_new(), {.replaced = false}};
    assert_non_null(e.delta);
    he_mesh_record(e.m, e.delta);
    return e;
}

static void edit_run(edit *e, const char *script)
{
    script_prepare(e->m, script);
    he_changes_clear(&e->changes);
    assert_int_equal(he_changes_find(e->m, e->delta, 0, e->delta->count, false, &e->changes, NULL),
                     HE_OK);
    assert_valid(e->m);
}

static void edit_end(edit *e)
{
    he_mesh_record(e->m, NULL);
    he_changes_clear(&e->changes);
    he_delta_free(e->delta);
    he_mesh_free(e->m);
}

static void edge_bisect_keeps_the_id_for_the_part_at_the_origin(void **state)
{
    (void)state;
    edit e = edit_begin("0123");
    /* Edge 0 runs from vertex 0 to vertex 1. When it is bisected, the part at vertex 0 must keep
     * the id of the edge. */
    edit_run(&e, "edge_bisect edge=#0 t=0.25");
    assert_int_equal(he_target(e.m, (he_halfedge){0}).i, 4);
    assert_int_equal(he_origin(e.m, (he_halfedge){8}).i, 4);
    assert_int_equal(he_target(e.m, (he_halfedge){8}).i, 1);
    assert_ids(&e.changes.created[HE_EDGE], "4");
    assert_ids(&e.changes.parents[HE_EDGE], "4 0");
    assert_face(e.m, 0, "04123");
    he_vec3 a = he_position(e.m, (he_vertex){0}), b = he_position(e.m, (he_vertex){1});
    he_vec3 w = he_position(e.m, (he_vertex){4});
    assert_true(w.x == a.x + 0.25 * (b.x - a.x));
    edit_end(&e);
}

static void edge_join_keeps_the_lower_id_of_the_two_edges(void **state)
{
    (void)state;
    edit e = edit_begin("01234");
    edit_run(&e, "edge_join vertex=1");
    assert_ids(&e.changes.deleted[HE_EDGE], "1");
    assert_ids(&e.changes.deleted[HE_VERTEX], "1");
    assert_ids(&e.changes.merged[HE_EDGE], "1 0");
    assert_int_equal(he_origin(e.m, (he_halfedge){0}).i, 0);
    assert_int_equal(he_target(e.m, (he_halfedge){0}).i, 2);
    assert_face(e.m, 0, "0234");
    edit_end(&e);
}

static void edge_split_keeps_the_ids_of_the_edge_and_both_faces(void **state)
{
    (void)state;
    edit e = edit_begin("012,103");
    edit_run(&e, "edge_split edge=#0");
    /* The split makes vertex 4. New edge 5 is the second half of the split edge, new edge 6
     * connects vertices 4 and 2, and new edge 7 connects vertices 4 and 3. */
    assert_ids(&e.changes.created[HE_EDGE], "5 6 7");
    assert_ids(&e.changes.created[HE_FACE], "2 3");
    assert_ids(&e.changes.parents[HE_EDGE], "5 0");
    assert_ids(&e.changes.parents[HE_FACE], "2 0 3 1");
    assert_face(e.m, 0, "042");
    assert_face(e.m, 2, "412");
    assert_face(e.m, 1, "403");
    assert_face(e.m, 3, "143");
    assert_true(edge_between(e.m, 0, 4).i == 0 && edge_between(e.m, 4, 1).i == 5);
    assert_true(edge_between(e.m, 4, 2).i == 6 && edge_between(e.m, 4, 3).i == 7);
    edit_end(&e);

    e = edit_begin("01234,105678");
    edit_run(&e, "edge_split edge=#0");
    assert_face(e.m, 0, "09234");
    assert_face(e.m, 2, "912");
    assert_face(e.m, 1, "905");
    assert_face(e.m, 3, "195678");
    edit_end(&e);
}

static void edge_collapse_keeps_the_target_and_the_edges_at_it(void **state)
{
    (void)state;
    edit e = edit_begin(HEXAGON);
    uint32_t to2 = edge_between(e.m, 0, 2).i, from2 = edge_between(e.m, 1, 2).i;
    uint32_t to6 = edge_between(e.m, 0, 6).i, from6 = edge_between(e.m, 1, 6).i;
    edit_run(&e, "edge_collapse halfedge=1-0");
    assert_false(he_mesh_is_live(e.m, HE_VERTEX, 1));
    assert_true(edge_between(e.m, 0, 2).i == to2 && edge_between(e.m, 0, 6).i == to6);
    char expected[64];
    snprintf(expected, sizeof expected, "%u %u %u %u", from6, to6, from2, to2);
    assert_ids(&e.changes.merged[HE_EDGE], expected);
    assert_ids(&e.changes.merged[HE_VERTEX], "1 0");
    assert_ids(&e.changes.deleted[HE_FACE], "0 5");
    assert_ids(&e.changes.merged[HE_FACE], "");
    edit_end(&e);

    /* If the request names an edge e instead of a half-edge, the operation collapses half-edge 2e:
     * the origin of this half-edge is deleted. */
    e = edit_begin("0123");
    edit_run(&e, "edge_collapse edge=#1 t=0");
    assert_face(e.m, 0, "023");
    assert_true(he_position(e.m, (he_vertex){2}).x == 1);
    edit_end(&e);
}

static void edge_collapse_places_the_vertex_at_t_or_at_to(void **state)
{
    (void)state;
    static const struct {
        const char *operation;
        double x;
    } cases[] = {
        {"edge_collapse halfedge=0-1", 0.5},         {"edge_collapse halfedge=0-1 t=0", 0},
        {"edge_collapse halfedge=0-1 t=1", 1},       {"edge_collapse halfedge=0-1 t=0.25", 0.25},
        {"edge_collapse halfedge=1-0 t=0.25", 0.75}, {"edge_collapse edge=0-1 to=7,8,9", 7},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        edit e = edit_begin("0123");
        edit_run(&e, cases[i].operation);
        uint32_t v = he_mesh_is_live(e.m, HE_VERTEX, 0) ? 0 : 1;
        assert_true(he_position(e.m, (he_vertex){v}).x == cases[i].x);
        edit_end(&e);
    }
}

static void vertex_split_keeps_old_ids_and_reports_parents(void **state)
{
    (void)state;
    edit e = edit_begin(HEXAGON);
    uint32_t left = edge_between(e.m, 0, 1).i, right = edge_between(e.m, 0, 4).i;
    edit_run(&e, "vertex_split vertex=0 left=1 right=4 to=9,9,9");
    assert_ids(&e.changes.parents[HE_VERTEX], "7 0");
    char expected[64];
    snprintf(expected, sizeof expected, "13 %u 14 %u", left, right);
    assert_ids(&e.changes.parents[HE_EDGE], expected);
    assert_true(edge_between(e.m, 0, 1).i == left && edge_between(e.m, 0, 4).i == right);
    assert_true(edge_between(e.m, 7, 0).i == 12 && edge_between(e.m, 7, 1).i == 13);
    assert_face(e.m, 0, "712");
    assert_face(e.m, 2, "734");
    assert_face(e.m, 3, "045");
    assert_face(e.m, 6, "701");
    assert_face(e.m, 7, "074");
    assert_true(he_position(e.m, (he_vertex){7}).x == 9);
    edit_end(&e);
}

static void face_split_and_face_join_keep_the_id_of_the_first_face(void **state)
{
    (void)state;
    edit e = edit_begin("01234");
    edit_run(&e, "face_split face=0 from=1 to=4");
    assert_face(e.m, 0, "014");
    assert_face(e.m, 1, "1234");
    assert_ids(&e.changes.parents[HE_FACE], "1 0");
    assert_int_equal(he_origin(e.m, (he_halfedge){10}).i, 1);
    edit_end(&e);

    e = edit_begin("012,023");
    edit_run(&e, "face_join edge=0-2");
    /* Half-edge 2e of the joined edge e belongs to face 0, so face 0 must survive. */
    assert_face(e.m, 0, "0123");
    assert_ids(&e.changes.merged[HE_FACE], "1 0");
    edit_end(&e);
}

static void face_poke_keeps_the_id_for_the_first_triangle(void **state)
{
    (void)state;
    edit e = edit_begin("0123");
    edit_run(&e, "face_poke face=0 position=1,2,3");
    assert_face(e.m, 0, "014");
    assert_face(e.m, 1, "124");
    assert_face(e.m, 3, "304");
    assert_ids(&e.changes.parents[HE_FACE], "1 0 2 0 3 0");
    assert_int_equal(he_face_halfedge(e.m, (he_face){0}).i, 0);
    edit_end(&e);
}

static void face_triangulate_reports_the_face_as_parent_of_each_part(void **state)
{
    (void)state;
    edit e = edit_begin("0123456");
    edit_run(&e, "face_triangulate face=0");
    assert_int_equal(he_face_halfedge(e.m, (he_face){0}).i, 0);
    assert_int_equal(e.changes.parents[HE_FACE].count, 2 * 4);
    for (size_t i = 0; i < 4; i++) {
        assert_int_equal(e.changes.parents[HE_FACE].ids[2 * i + 1], 0);
    }
    edit_end(&e);
}

static void edge_flip_turns_the_edge_and_keeps_all_ids(void **state)
{
    (void)state;
    edit e = edit_begin("012,103");
    he_halfedge h = {0};
    edit_run(&e, "edge_flip edge=#0");
    /* Before the flip, half-edge 0 ran from 0 to 1 with vertex 2 on its left; now it must run from
     * 3 to 2 with vertex 0 on its left. */
    assert_int_equal(he_origin(e.m, h).i, 3);
    assert_int_equal(he_target(e.m, h).i, 2);
    assert_face(e.m, 0, "032");
    assert_face(e.m, 1, "123");
    assert_ids(&e.changes.modified[HE_FACE], "0 1");
    assert_ids(&e.changes.created[HE_EDGE], "");
    edit_end(&e);
}

static void deleting_removes_only_the_vertices_that_it_isolates(void **state)
{
    (void)state;
    edit e = edit_begin("0123,3245");
    edit_run(&e, "face_delete face=0");
    assert_ids(&e.changes.deleted[HE_VERTEX], "0 1");
    assert_ids(&e.changes.deleted[HE_FACE], "0");
    edit_end(&e);

    e = edit_begin("0123,3245+");
    edit_run(&e, "face_delete face=0 keep_isolated=1");
    assert_ids(&e.changes.deleted[HE_VERTEX], "");
    assert_true(he_is_isolated(e.m, (he_vertex){0}));
    edit_end(&e);

    /* vertex_delete must not delete other vertices that were isolated before, like vertex 4. */
    e = edit_begin("0123+");
    edit_run(&e, "vertex_delete vertex=1");
    assert_ids(&e.changes.deleted[HE_VERTEX], "0 1 2 3");
    edit_end(&e);
}

static void edits_without_effect_report_no_changes(void **state)
{
    (void)state;
    static const char *const operations[] = {
        "vertex_move vertex=1 by=0,0,0",
        "transform matrix=1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1",
        "face_triangulate face=0",
        "plane_split point=9,0,0 normal=1,0,0",
        "plane_split point=0,0,0 normal=1,0,0",
        "delaunay",
    };
    for (size_t i = 0; i < sizeof operations / sizeof *operations; i++) {
        edit e = edit_begin("012");
        edit_run(&e, operations[i]);
        assert_true(he_changes_none(&e.changes));
        edit_end(&e);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(edge_bisect_keeps_the_id_for_the_part_at_the_origin),
        cmocka_unit_test(edge_join_keeps_the_lower_id_of_the_two_edges),
        cmocka_unit_test(edge_split_keeps_the_ids_of_the_edge_and_both_faces),
        cmocka_unit_test(edge_collapse_keeps_the_target_and_the_edges_at_it),
        cmocka_unit_test(edge_collapse_places_the_vertex_at_t_or_at_to),
        cmocka_unit_test(vertex_split_keeps_old_ids_and_reports_parents),
        cmocka_unit_test(face_split_and_face_join_keep_the_id_of_the_first_face),
        cmocka_unit_test(face_poke_keeps_the_id_for_the_first_triangle),
        cmocka_unit_test(face_triangulate_reports_the_face_as_parent_of_each_part),
        cmocka_unit_test(edge_flip_turns_the_edge_and_keeps_all_ids),
        cmocka_unit_test(deleting_removes_only_the_vertices_that_it_isolates),
        cmocka_unit_test(edits_without_effect_report_no_changes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
