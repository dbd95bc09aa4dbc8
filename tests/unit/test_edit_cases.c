/* Cases that the design documents list for each operation, and edits at bow-ties. */
#include "edit_script.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "algo/shape.h"
#include "mesh/write.h"
#include "query/topology.h"

#define QCUBE   "0123,7654,1045,2156,3267,0374"
#define RING10  "401,430,512,541,652,734,874,845,985,956"
#define STRANGE "012,034,056"
#define HEXAGON "012,023,034,045,056,061"

static void an_empty_mesh_takes_a_vertex_and_is_empty_again(void **state)
{
    (void)state;
    he_mesh *m = script_mesh("", NULL);
    script_prepare(m, "vertex_add position=1,2,3;vertex_delete vertex=0;compact");
    assert_counts(m, 0, 0, 0);
    assert_int_equal(he_mesh_issued(m, HE_VERTEX), 0);
    he_mesh_free(m);
}

static void three_vertices_make_a_triangle_with_one_boundary_loop(void **state)
{
    (void)state;
    he_mesh *m = script_mesh("+++", NULL);
    script_prepare(m, "face_add vertices=0,1,2");
    assert_counts(m, 3, 3, 1);
    assert_int_equal(he_mesh_count(m, HE_HALFEDGE), 6);
    assert_loops(m, "3");
    assert_face(m, 0, "012");
    assert_int_equal(he_origin(m, he_face_halfedge(m, (he_face){0})).i, 0);
    he_mesh_free(m);
}

static void assert_joins(const he_mesh *m, he_edge e, uint32_t a, uint32_t b)
{
    uint32_t from = he_origin(m, he_edge_halfedge(e, 0)).i;
    uint32_t to = he_target(m, he_edge_halfedge(e, 0)).i;
    assert_true((from == a && to == b) || (from == b && to == a));
}

static void an_edge_flipped_twice_joins_its_old_ends_again(void **state)
{
    (void)state;
    he_mesh *m = script_mesh(RING10, NULL);
    he_edge e = edge_between(m, 4, 5);
    for (unsigned i = 0; i < 2; i++) {
        script_prepare(m, "edge_flip edge=4-5");
        assert_counts(m, 10, 19, 10);
        assert_joins(m, e, 1, 8);
        script_prepare(m, "edge_flip edge=1-8");
        assert_counts(m, 10, 19, 10);
        assert_joins(m, e, 4, 5);
    }
    he_mesh_free(m);
}

static void deleting_an_edge_or_its_two_faces_leaves_the_same_hole(void **state)
{
    (void)state;
    for (unsigned i = 0; i < 2; i++) {
        he_mesh *m = script_mesh(RING10, NULL);
        script_prepare(m, i == 0 ? "edge_delete edge=4-5" : "face_delete faces=3,7");
        assert_counts(m, 10, 18, 8);
        assert_int_equal(euler_of(m), 0);
        assert_int_equal(he_vertex_fans(m, (he_vertex){1}), 2);
        assert_int_equal(he_vertex_fans(m, (he_vertex){8}), 2);
        assert_int_equal(he_mesh_boundary_halfedges(m), 12);
        he_mesh_free(m);
    }
}

static void a_face_joins_two_fans_but_may_not_close_one_beside_others(void **state)
{
    (void)state;
    he_mesh *m = script_mesh(STRANGE, NULL);
    assert_counts(m, 7, 9, 3);
    assert_int_equal(he_vertex_fans(m, (he_vertex){0}), 3);
    he_mesh *before = copy_of(m);
    assert_int_equal(script_run(m, "face_add vertices=3,0,4", NULL, NULL), HE_CLOSED_FAN);
    assert_equal(m, before);
    /* At vertex 0 three fans of faces meet. New faces fill the gaps between the fans one after
     * another; this must work whatever the order in which the links of the boundary connect the
     * fans. */
    script_prepare(m, "face_add vertices=1,0,4");
    assert_int_equal(he_vertex_fans(m, (he_vertex){0}), 2);
    assert_int_equal(script_run(m, "face_add vertices=3,0,2", NULL, NULL), HE_CLOSED_FAN);
    script_prepare(m, "face_add vertices=3,0,6");
    assert_int_equal(he_vertex_fans(m, (he_vertex){0}), 1);
    script_prepare(m, "face_add vertices=5,0,2");
    assert_counts(m, 7, 12, 6);
    assert_false(he_is_boundary_vertex(m, (he_vertex){0}));
    assert_int_equal(script_run(m, "face_add vertices=5,0,2", NULL, NULL), HE_INTERIOR_VERTEX);
    he_mesh_free(before);
    he_mesh_free(m);
}

static void deleted_faces_leave_one_hole_and_hole_fill_closes_it(void **state)
{
    (void)state;
    he_mesh *m = script_mesh(QCUBE, NULL);
    script_prepare(m, "face_delete faces=0,1,2");
    assert_counts(m, 8, 10, 3);
    assert_loops(m, "8");
    he_mesh_free(m);

    m = script_mesh(QCUBE, NULL);
    script_prepare(m, "face_delete face=0");
    assert_counts(m, 8, 12, 5);
    assert_loops(m, "4");
    script_prepare(m, "hole_fill halfedge=0-1");
    assert_counts(m, 8, 12, 6);
    assert_face(m, 6, "0123");
    assert_loops(m, "");
    he_mesh_free(m);
}

static void a_checkerboard_has_bowties_and_can_be_rebuilt(void **state)
{
    (void)state;
    /* The mesh is a grid of three by three squares: if every second square is deleted, five squares
     * are left, which touch only at corners. */
    he_mesh *m = script_mesh("0154,1265,2376,4598,56a9,67ba,89dc,9aed,abfe", NULL);
    script_prepare(m, "face_delete faces=1,3,5,7");
    assert_counts(m, 16, 20, 5);
    for (uint32_t v = 5; v <= 10; v += v == 6 ? 3 : 1) {
        assert_int_equal(he_vertex_fans(m, (he_vertex){v}), 2);
    }
    script_prepare(m, "face_delete faces=0,2,4,6,8 keep_isolated=1");
    assert_counts(m, 16, 0, 0);
    script_prepare(m, "face_add vertices=0,1,5,4;face_add vertices=5,6,10,9;"
                      "face_add vertices=1,2,6,5");
    assert_counts(m, 16, 10, 3);
    assert_int_equal(he_vertex_fans(m, (he_vertex){5}), 1);
    he_mesh_free(m);
}

static void no_edge_of_a_tetrahedron_collapses(void **state)
{
    (void)state;
    he_mesh *m = script_mesh("021,013,032,123", NULL), *before = copy_of(m);
    for (unsigned h = 0; h < 12; h++) {
        char text[64];
        snprintf(text, sizeof text, "edge_collapse halfedge=#%u", h);
        assert_int_equal(script_run(m, text, NULL, NULL), HE_LINK_CONDITION);
        assert_equal(m, before);
    }
    he_mesh_free(before);
    he_mesh_free(m);
}

static void face_join_makes_a_quadrilateral_of_two_triangles(void **state)
{
    (void)state;
    he_mesh *m = script_mesh("021,123,134", NULL);
    he_edge e = edge_between(m, 1, 2);
    he_face kept = he_face_of(m, he_edge_halfedge(e, 0));
    script_prepare(m, "face_join edge=1-2");
    assert_counts(m, 5, 6, 2);
    assert_int_equal(he_face_degree(m, kept), 4);
    he_mesh_free(m);
}

static void collapsing_the_new_edge_undoes_vertex_split_corners(void **state)
{
    (void)state;
    he_mesh *m = script_mesh("0123,3245", NULL), *before = copy_of(m);
    /* Two faces meet at vertex 3. The new edge divides the corner of each of the two faces at
     * vertex 3, and becomes a side of both faces. */
    script_prepare(m, "vertex_split_corners a=3-2 b=3-5");
    assert_counts(m, 7, 8, 2);
    script_prepare(m, "edge_collapse halfedge=6-3 t=1");
    assert_counts(m, 6, 7, 2);
    assert_true(he_mesh_equal_live(m, before));
    he_mesh_free(before);

    before = copy_of(m);
    script_prepare(m, "vertex_split_corners a=2-3 b=2-1;edge_collapse halfedge=7-2 t=1");
    assert_counts(m, 6, 7, 2);
    assert_true(he_mesh_equal_live(m, before));
    he_mesh_free(before);
    he_mesh_free(m);
}

static void loop_join_makes_a_closed_mesh_of_two_open_tetrahedra(void **state)
{
    (void)state;
    he_mesh *m = script_mesh("023,321,031,647,675,745", NULL);
    assert_loops(m, "33");
    script_prepare(m, "loop_join a=0-1 b=5-4");
    assert_counts(m, 5, 9, 6);
    assert_loops(m, "");
    assert_int_equal(euler_of(m), 2);
    he_mesh_free(m);
}

static void face_extrude_adds_a_side_face_for_each_edge(void **state)
{
    (void)state;
    he_mesh *m = script_mesh("0123,214", NULL);
    script_prepare(m, "face_extrude face=0 by=0,0,1");
    assert_counts(m, 9, 14, 6);
    he_mesh_free(m);
}

static void each_cube_vertex_bevels_to_a_triangle(void **state)
{
    (void)state;
    for (unsigned v = 0; v < 8; v++) {
        he_mesh *m = script_mesh(QCUBE, NULL);
        char text[64];
        snprintf(text, sizeof text, "vertex_bevel vertex=%u width=0.1", v);
        script_prepare(m, text);
        assert_counts(m, 10, 15, 7);
        he_mesh_free(m);
    }
}

/* Makes a mesh of the primitive shape `name` with these parameters. */
static he_mesh *make(const char *name, const double *given, size_t count)
{
    double args[HE_SHAPE_PARAMS];
    he_soup soup;
    he_mesh *m = NULL;
    const he_shape *shape = he_shape_find(name, strlen(name));
    assert_non_null(shape);
    he_shape_defaults(shape, args);
    for (size_t i = 0; i < count; i++) {
        args[i] = given[i];
    }
    assert_int_equal(he_shape_make(shape, args, NULL, &soup, NULL), HE_OK);
    assert_int_equal(he_build(&soup, HE_BUILD_TAKE, &m, NULL, NULL), HE_OK);
    he_soup_clear(&soup);
    assert_valid(m);
    return m;
}

static bool is_inner(const he_mesh *m, he_face f)
{
    he_halfedge first = he_face_halfedge(m, f), h = first;
    do {
        if (he_is_boundary_vertex(m, he_origin(m, h))) {
            return false;
        }
        h = he_next(m, h);
    } while (h.i != first.i);
    return true;
}

static void an_inner_face_of_a_grid_collapses_to_a_vertex(void **state)
{
    (void)state;
    static const double cells[] = {4, 4};
    unsigned inner = 0;
    for (uint32_t f = 0; f < 16; f++) {
        he_mesh *m = make("grid", cells, 2);
        assert_counts(m, 25, 40, 16);
        if (is_inner(m, (he_face){f})) {
            char text[64];
            snprintf(text, sizeof text, "face_collapse face=%u", f);
            script_prepare(m, text);
            assert_counts(m, 22, 36, 15);
            inner++;
        }
        he_mesh_free(m);
    }
    assert_int_equal(inner, 4);
}

static void a_torus_has_genus_1_and_a_cylinder_has_two_boundary_loops(void **state)
{
    (void)state;
    static const double torus[] = {3, 3}, sides[] = {6, 1, 2, 0};
    he_topology topology;
    he_mesh *m = make("torus", torus, 2);
    assert_counts(m, 9, 18, 9);
    assert_int_equal(he_topology_find(m, &topology, NULL), HE_OK);
    assert_int_equal(topology.euler, 0);
    assert_true(topology.has_genus);
    assert_int_equal(topology.genus, 1);
    he_topology_clear(&topology);
    he_mesh_free(m);

    m = make("cylinder", sides, 4);
    assert_loops(m, "66");
    he_mesh_free(m);
}

static void solids_have_their_known_counts_and_euler_number_2(void **state)
{
    (void)state;
    static const double three[] = {3};
    static const struct {
        const char *name;
        size_t given;
        uint32_t vertices, edges, faces;
    } cases[] = {
        {"icosphere", 1, 642, 1920, 1280},
        {"cube", 0, 8, 12, 6},
        {"dodecahedron", 0, 20, 30, 12},
        {"icosahedron", 0, 12, 30, 20},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        he_mesh *m = make(cases[i].name, three, cases[i].given);
        assert_counts(m, cases[i].vertices, cases[i].edges, cases[i].faces);
        assert_int_equal(euler_of(m), 2);
        he_mesh_free(m);
    }
}

/* If an operation is refused, the mesh must be equal, bit by bit, to the mesh before the operation:
 * entries of deleted elements, the number of issued ids and all attributes included. */
static void a_refusal_leaves_the_mesh_as_it_was(void **state)
{
    (void)state;
    static const struct {
        const char *mesh, *prepare, *operation;
        he_status status;
    } cases[] = {
        {STRANGE, NULL, "face_add vertices=3,0,4", HE_CLOSED_FAN},
        {RING10, "edge_delete edge=4-5", "edge_flip edge=1-4", HE_BOUNDARY_EDGE},
        {RING10, NULL, "hole_fill halfedge=4-5", HE_NOT_BOUNDARY},
        {"021,013,032,123", NULL, "face_collapse face=2", HE_LINK_CONDITION},
        {"021,123,134", "vertex_delete vertex=4", "vertex_dissolve vertex=2", HE_BOUNDARY_VERTEX},
        {"0123,3245", NULL, "vertex_split_corners a=3-0 b=3-0", HE_SAME_CORNER},
        {"023,321,031,647,675,745", NULL, "loop_join a=0-1 b=0-2", HE_SHARED_VERTEX},
        {"0341,142", NULL, "face_split face=0 from=0 to=2", HE_NOT_A_CORNER},
        {QCUBE, NULL, "edge_cut edges=0-1,6-7", HE_DOUBLED_EDGE},
        {QCUBE, NULL, "face_extrude faces=0,1,2,3,4,5 distance=1 region=1", HE_NO_RIM},
        {QCUBE, NULL, "face_delete faces=0,1,2,1", HE_REPEATED_ELEMENT},
        {QCUBE, "mark locked vertex=6", "vertex_move vertices=0,1,6 by=1,1,1", HE_LOCKED_ELEMENT},
        {QCUBE, "face_delete face=2", "plane_cut point=3.5,0,0 normal=1,0,0 cap=1", HE_OPEN_LOOP},
        {"012", NULL, "dual", HE_BOUNDARY_EDGE},
        {"012,021", NULL, "dual", HE_TOO_FEW_CORNERS},
        {"012+", NULL, "weld tolerance=-1", HE_BAD_VALUE},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        print_message("%s\n", cases[i].operation);
        he_mesh *m = script_mesh(cases[i].mesh, NULL);
        script_add_columns(m);
        script_prepare(m, cases[i].prepare);
        he_mesh *before = copy_of(m);
        assert_int_equal(script_run(m, cases[i].operation, NULL, NULL), cases[i].status);
        assert_equal(m, before);
        he_mesh_free(before);
        he_mesh_free(m);
    }
}

static void an_edge_of_a_quadrilateral_can_be_flipped_and_split(void **state)
{
    (void)state;
    he_mesh *m = script_mesh("0341,142", NULL);
    he_edge e = edge_between(m, 1, 4);
    script_prepare(m, "edge_flip edge=1-4");
    assert_counts(m, 5, 6, 2);
    assert_joins(m, e, 0, 2);
    assert_face(m, 0, "0342");
    assert_face(m, 1, "021");
    he_mesh_free(m);

    m = script_mesh("0341,142", NULL);
    script_prepare(m, "edge_split edge=1-4");
    assert_counts(m, 6, 9, 4);
    he_mesh_free(m);

    m = script_mesh("0341,142", NULL);
    script_prepare(m, "edge_split edge=0-1");
    assert_counts(m, 6, 8, 3);
    he_mesh_free(m);
}

/* Loop's subdivision can be made of splits and flips: first all edges are split, then each new edge
 * between an old and a new vertex is flipped, unless it is half of a split edge. */
static void splits_and_flips_make_a_loop_subdivision(void **state)
{
    (void)state;
    /* The mesh is an octahedron. */
    he_mesh *m = script_mesh("012,023,034,041,521,532,543,514", NULL);
    uint32_t v = he_mesh_vertices(m), e = he_mesh_edges(m), f = he_mesh_faces(m);
    for (uint32_t i = 0; i < e; i++) {
        char text[64];
        snprintf(text, sizeof text, "edge_split edge=#%u", i);
        script_prepare(m, text);
    }
    for (uint32_t i = e; i < he_mesh_issued(m, HE_EDGE); i++) {
        he_halfedge h = he_edge_halfedge((he_edge){i}, 0);
        bool old_from = he_origin(m, h).i < v, old_to = he_target(m, h).i < v;
        /* A split makes three edges, of which the first is one half of the split edge. */
        bool half = (i - e) % 3 == 0;
        if (old_from != old_to && !half) {
            char text[64];
            snprintf(text, sizeof text, "edge_flip edge=#%u", i);
            script_prepare(m, text);
        }
    }
    assert_counts(m, v + e, 2 * e + 3 * f, 4 * f);
    for (uint32_t i = 0; i < 4 * f; i++) {
        assert_int_equal(he_face_degree(m, (he_face){i}), 3);
    }
    for (uint32_t i = v; i < v + e; i++) {
        assert_int_equal(he_vertex_degree(m, (he_vertex){i}), 6);
    }
    he_mesh_free(m);
}

/* Splitting a vertex and collapsing the new edge must restore the mesh, with all its links. */
static void edge_collapse_undoes_vertex_split_link_by_link(void **state)
{
    (void)state;
    static const struct {
        const char *mesh, *split;
        uint32_t v;
    } cases[] = {
        {HEXAGON, "vertex_split vertex=0 left=1 right=3 to=0,0,1", 0},
        {HEXAGON, "vertex_split vertex=0 left=5 right=2 to=0,0,1", 0},
        {HEXAGON, "vertex_split vertex=0 left=2 right=1 to=0,0,1", 0},
        {HEXAGON, "vertex_split vertex=1 left=0 right=null to=0,0,1", 1},
        {HEXAGON, "vertex_split vertex=1 left=null right=0 to=0,0,1", 1},
        {HEXAGON, "vertex_split vertex=1 left=0 right=2 to=0,0,1", 1},
        {HEXAGON, "vertex_split vertex=1 left=2 right=6 to=0,0,1", 1},
        {HEXAGON, "vertex_split vertex=1 left=null right=6 to=0,0,1", 1},
        {QCUBE, "vertex_split vertex=0 left=1 right=3 to=0,0,1", 0},
        {QCUBE, "vertex_split vertex=0 left=3 right=1 to=0,0,1", 0},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        print_message("%s\n", cases[i].split);
        he_mesh *m = script_mesh(cases[i].mesh, NULL), *before = copy_of(m);
        uint32_t u = he_mesh_issued(m, HE_VERTEX);
        script_prepare(m, cases[i].split);
        assert_valid(m);
        char text[64];
        snprintf(text, sizeof text, "edge_collapse halfedge=%u-%u t=1", u, cases[i].v);
        script_prepare(m, text);
        assert_valid(m);
        /* An interior vertex may store any half-edge that leaves it: v gets the half-edge that it
         * had before, so that the meshes can be compared. */
        he_vertex v = {cases[i].v};
        if (!he_is_boundary_vertex(m, v)) {
            he_set_vertex_halfedge(m, v, he_vertex_halfedge(before, v));
        }
        assert_true(he_mesh_equal_live(m, before));
        he_mesh_free(before);
        he_mesh_free(m);
    }
}

static void edge_join_undoes_edge_bisect_and_face_join_undoes_face_split(void **state)
{
    (void)state;
    static const char *const pairs[][2] = {
        {"edge_bisect edge=0-1 t=0.25", "edge_join vertex=8"},
        {"edge_bisect edge=3-7", "edge_join vertex=8"},
        {"face_split face=0 from=0 to=2", "face_join edge=0-2"},
        {"face_split face=0 from=3 to=1", "face_join edge=1-3"},
    };
    for (size_t i = 0; i < sizeof pairs / sizeof *pairs; i++) {
        he_mesh *m = script_mesh(QCUBE, NULL), *before = copy_of(m);
        script_prepare(m, pairs[i][0]);
        assert_false(he_mesh_equal_live(m, before));
        script_prepare(m, pairs[i][1]);
        assert_counts(m, 8, 12, 6);
        for (uint32_t f = 0; f < 6; f++) {
            assert_int_equal(he_face_degree(m, (he_face){f}), 4);
        }
        he_mesh_free(before);
        he_mesh_free(m);
    }
}

static void a_square_is_cut_only_if_corners_lie_on_both_sides(void **state)
{
    (void)state;
    static const he_vec3 square[] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    he_mesh *m = script_mesh("0123", square);
    script_prepare(m, "plane_split point=0,0,0 normal=-1,1,0");
    assert_counts(m, 4, 5, 2);
    (void)edge_between(m, 0, 2);
    he_mesh_free(m);

    m = script_mesh("0123", square);
    script_prepare(m, "plane_split point=0.5,0.5,0 normal=0,1,0");
    assert_counts(m, 6, 7, 2);
    he_mesh_free(m);

    m = script_mesh("0123", square);
    he_mesh *before = copy_of(m);
    script_prepare(m, "plane_split point=0,2,0 normal=0,1,0");
    assert_counts(m, 4, 4, 1);
    assert_equal(m, before);
    he_mesh_free(before);
    he_mesh_free(m);
}

static void two_faces_back_to_back_make_a_closed_mesh(void **state)
{
    (void)state;
    he_mesh *m = script_mesh("012", NULL);
    script_prepare(m, "face_add vertices=0,2,1");
    assert_counts(m, 3, 3, 2);
    assert_loops(m, "");
    script_prepare(m, "face_delete face=0");
    assert_counts(m, 3, 3, 1);
    he_mesh_free(m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_empty_mesh_takes_a_vertex_and_is_empty_again),
        cmocka_unit_test(three_vertices_make_a_triangle_with_one_boundary_loop),
        cmocka_unit_test(an_edge_flipped_twice_joins_its_old_ends_again),
        cmocka_unit_test(deleting_an_edge_or_its_two_faces_leaves_the_same_hole),
        cmocka_unit_test(a_face_joins_two_fans_but_may_not_close_one_beside_others),
        cmocka_unit_test(deleted_faces_leave_one_hole_and_hole_fill_closes_it),
        cmocka_unit_test(a_checkerboard_has_bowties_and_can_be_rebuilt),
        cmocka_unit_test(no_edge_of_a_tetrahedron_collapses),
        cmocka_unit_test(face_join_makes_a_quadrilateral_of_two_triangles),
        cmocka_unit_test(an_edge_of_a_quadrilateral_can_be_flipped_and_split),
        cmocka_unit_test(splits_and_flips_make_a_loop_subdivision),
        cmocka_unit_test(edge_collapse_undoes_vertex_split_link_by_link),
        cmocka_unit_test(edge_join_undoes_edge_bisect_and_face_join_undoes_face_split),
        cmocka_unit_test(two_faces_back_to_back_make_a_closed_mesh),
        cmocka_unit_test(a_square_is_cut_only_if_corners_lie_on_both_sides),
        cmocka_unit_test(collapsing_the_new_edge_undoes_vertex_split_corners),
        cmocka_unit_test(loop_join_makes_a_closed_mesh_of_two_open_tetrahedra),
        cmocka_unit_test(face_extrude_adds_a_side_face_for_each_edge),
        cmocka_unit_test(each_cube_vertex_bevels_to_a_triangle),
        cmocka_unit_test(an_inner_face_of_a_grid_collapses_to_a_vertex),
        cmocka_unit_test(solids_have_their_known_counts_and_euler_number_2),
        cmocka_unit_test(a_torus_has_genus_1_and_a_cylinder_has_two_boundary_loops),
        cmocka_unit_test(a_refusal_leaves_the_mesh_as_it_was),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
