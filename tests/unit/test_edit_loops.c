/* Edits that join, split and bridge loops of edges: cases from the design documents, which ids
 * survive, which edits undo each other, and how far a bridge is twisted. */
#include "edit_script.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "build/build.h"
#include "edit/border/bridge.h"
#include "edit/border/loop_join.h"
#include "edit/border/loop_split.h"
#include "edit/local/erase.h"
#include "geometry/vec3.h"
#include "mesh/write.h"

#define CF4       "023,321,031,647,675,745"
#define BIPYRAMID "013,123,203,104,214,024"
/* Two open cylinders of six sides each. The vertices are numbered by digits and letters: the first
 * cylinder has the vertices 0 to b (11), the second c (12) to n (23). */
#define CYLINDERS "0176,1287,2398,34a9,45ba,506b,cdji,dekj,eflk,fgml,ghnm,hcin"

/* Requires that the links of two meshes are equal. Only the half-edge that a vertex stores may
 * differ, if it is a valid choice in both meshes. */
static void assert_same_links(he_mesh *m, const he_mesh *other)
{
    for (uint32_t v = 0; v < he_mesh_issued(other, HE_VERTEX); v++) {
        if (he_vertex_is_live(m, (he_vertex){v})) {
            he_set_vertex_halfedge(m, (he_vertex){v}, he_vertex_halfedge(other, (he_vertex){v}));
        }
    }
    assert_true(he_mesh_equal_live(m, other));
}

static void loop_join_makes_a_closed_mesh_of_two_open_tetrahedra(void **state)
{
    (void)state;
    he_mesh *m = script_mesh(CF4, NULL);
    script_prepare(m, "loop_join a=2-0 b=4-6");
    assert_valid(m);
    assert_counts(m, 5, 9, 6);
    assert_loops(m, "");
    assert_int_equal(euler_of(m), 2);
    he_mesh_free(m);
}

static void a_bridge_and_a_join_make_a_torus_of_two_cylinders(void **state)
{
    (void)state;
    he_mesh *m = script_mesh("0176,1287,2398,34a9,45ba,506b", NULL);
    assert_loops(m, "66");
    he_mesh_free(m);

    m = script_mesh(CYLINDERS, NULL);
    assert_counts(m, 24, 36, 12);
    assert_loops(m, "6666");
    /* A bridge connects one end of the first cylinder to one end of the second cylinder; then a
     * join connects the two remaining open ends, which makes a torus. */
    script_prepare(m, "loop_bridge a=6-7 b=13-12");
    assert_valid(m);
    assert_counts(m, 24, 42, 18);
    assert_loops(m, "66");
    script_prepare(m, "loop_join a=1-0 b=18-19");
    assert_valid(m);
    assert_counts(m, 18, 36, 18);
    assert_loops(m, "");
    assert_int_equal(euler_of(m), 0);
    he_mesh_free(m);
}

static void the_first_loop_survives_loop_join(void **state)
{
    (void)state;
    he_mesh *m = script_mesh(CF4, NULL);
    he_delta *delta = he_delta_new();
    he_changes changes = {.replaced = false};
    assert_non_null(delta);
    uint32_t kept = edge_between(m, 0, 2).i, gone = edge_between(m, 4, 6).i;
    he_vec3 a = he_position(m, (he_vertex){2}), b = he_position(m, (he_vertex){6});
    he_mesh_record(m, delta);
    script_prepare(m, "loop_join a=2-0 b=4-6");
    he_mesh_record(m, NULL);
    assert_int_equal(he_changes_find(m, delta, 0, delta->count, false, &changes, NULL), HE_OK);
    /* The edit loop_join has the half-edges a and b as arguments. It merges the target of b into
     * the origin of a, and then, one by one, the vertices that follow along the two loops. The list
     * `merged` consists of pairs: the first vertex of a pair is merged into the second. */
    static const uint32_t merged[] = {6, 2, 4, 0, 5, 1};
    assert_int_equal(changes.merged[HE_VERTEX].count, 6);
    for (unsigned i = 0; i < 6; i++) {
        assert_int_equal(changes.merged[HE_VERTEX].ids[i], merged[i]);
    }
    assert_int_equal(changes.merged[HE_EDGE].ids[0], gone);
    assert_int_equal(changes.merged[HE_EDGE].ids[1], kept);
    assert_int_equal(changes.deleted[HE_EDGE].count, 3);
    assert_int_equal(changes.created[HE_EDGE].count, 0);
    assert_int_equal(changes.modified[HE_FACE].count, 3);
    assert_face(m, 3, "207");
    he_vec3 p = he_position(m, (he_vertex){2});
    assert_true(p.x == (a.x + b.x) / 2 && p.y == (a.y + b.y) / 2 && p.z == (a.z + b.z) / 2);
    he_changes_clear(&changes);
    he_delta_free(delta);
    he_mesh_free(m);
}

static void loop_split_reports_the_new_vertices_edges_and_faces(void **state)
{
    (void)state;
    he_mesh *m = script_mesh(BIPYRAMID, NULL);
    he_loop_parts parts;
    he_edge a = edge_between(m, 0, 1), b = edge_between(m, 1, 2), c = edge_between(m, 2, 0);
    assert_int_equal(he_loop_split(m, a, c, b, &parts, NULL), HE_OK);
    assert_valid(m);
    assert_int_equal(euler_of(m), 4);
    /* Half-edge 2a of edge `a` runs from 0 to 1 in face 0. The edit cuts the mesh open along the
     * loop 0-1-2: faces 3 to 5 get the copies 5, 6 and 7 of the loop's vertices, and a new face
     * closes each of the two holes. */
    static const char *const faces[] = {"013", "123", "203", "654", "764", "574", "102", "567"};
    for (uint32_t f = 0; f < 8; f++) {
        assert_face(m, f, faces[f]);
    }
    for (uint32_t i = 0; i < 3; i++) {
        assert_int_equal(parts.vertices[i].i, 5 + i);
        he_vec3 p = he_position(m, (he_vertex){i}), q = he_position(m, parts.vertices[i]);
        assert_true(p.x == q.x && p.y == q.y && p.z == q.z);
    }
    assert_int_equal(parts.edges[0].i, edge_between(m, 5, 6).i);
    assert_int_equal(parts.edges[2].i, edge_between(m, 7, 5).i);
    assert_int_equal(edge_between(m, 0, 1).i, a.i);
    assert_int_equal(edge_between(m, 2, 0).i, c.i);
    assert_int_equal(parts.faces[0].i, 6);
    assert_int_equal(parts.faces[1].i, 7);
    he_mesh_free(m);
}

/* --- inverses --- */

static void loop_join_undoes_loop_split(void **state)
{
    (void)state;
    static const struct {
        const char *mesh;
        uint32_t v[3];
    } cases[] = {
        {BIPYRAMID, {0, 1, 2}},
        {BIPYRAMID, {2, 1, 0}},
        /* The cycle 0-1-2 surrounds a face of an octahedron that is divided into three
         * triangles. */
        {"016,126,206,023,034,041,521,532,543,514", {0, 1, 2}},
        /* The mesh is a torus of three by three squares, each cut into two triangles; the first
         * cycle runs around it the long way, the second one through its tube. */
        {"014,043,125,154,203,235,347,376,458,487,536,568,671,610,782,721,860,802", {0, 1, 2}},
        {"014,043,125,154,203,235,347,376,458,487,536,568,671,610,782,721,860,802", {0, 3, 6}},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const uint32_t *v = cases[i].v;
        he_mesh *m = script_mesh(cases[i].mesh, NULL);
        script_add_columns(m);
        he_mesh *before = copy_of(m);
        int was = euler_of(m);
        he_loop_parts parts;
        he_edge a = edge_between(m, v[0], v[1]);
        assert_int_equal(he_loop_split(m, a, edge_between(m, v[1], v[2]),
                                       edge_between(m, v[2], v[0]), &parts, NULL),
                         HE_OK);
        assert_valid(m);
        assert_int_equal(euler_of(m), was + 2);
        he_halfedge there = he_edge_halfedge(a, 1), other = he_edge_halfedge(parts.edges[0], 0);
        assert_int_equal(he_face_of(m, there).i, parts.faces[0].i);
        assert_int_equal(he_face_of(m, other).i, parts.faces[1].i);
        assert_int_equal(he_loop_join(m, there, other, NULL, NULL), HE_OK);
        assert_valid(m);
        /* A face may store any of its half-edges. The test gives each face the half-edge that it
         * stored before, so that the meshes can be compared. */
        for (uint32_t f = 0; f < he_mesh_issued(before, HE_FACE); f++) {
            he_set_face_halfedge(m, (he_face){f}, he_face_halfedge(before, (he_face){f}));
        }
        assert_same_links(m, before);
        he_mesh_free(before);
        he_mesh_free(m);
    }
}

static void loop_split_undoes_loop_join_once_its_faces_are_deleted(void **state)
{
    (void)state;
    he_mesh *m = script_mesh(CF4, NULL);
    script_prepare(m, "loop_join a=2-0 b=4-6;loop_split a=0-1 b=1-2 c=2-0");
    assert_valid(m);
    assert_counts(m, 8, 12, 8);
    script_prepare(m, "face_delete faces=6,7");
    assert_counts(m, 8, 12, 6);
    assert_loops(m, "33");
    assert_face(m, 0, "023");
    assert_face(m, 1, "321");
    he_mesh_free(m);
}

static void deleting_the_new_faces_undoes_loop_bridge(void **state)
{
    (void)state;
    static const char *const cases[][2] = {{CYLINDERS, "loop_bridge a=6-7 b=13-12"},
                                           {"012,3456", "loop_bridge a=1-0 b=4-3"},
                                           {CF4, "loop_bridge a=4-6 b=2-0"},
                                           {"0123,456789", "loop_bridge a=1-0 b=5-4"}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        he_mesh *m = script_mesh(cases[i][0], NULL);
        script_add_columns(m);
        he_mesh *before = copy_of(m);
        script_prepare(m, cases[i][1]);
        assert_valid(m);
        for (uint32_t f = he_mesh_issued(before, HE_FACE); f < he_mesh_issued(m, HE_FACE); f++) {
            assert_int_equal(he_face_delete(m, &f, 1, HE_DROP_ISOLATED, NULL), HE_OK);
        }
        assert_true(he_mesh_equal_live(m, before));
        he_mesh_free(before);
        he_mesh_free(m);
    }
}

/* --- the twist --- */

static const double TURN = 6.283185307179586;

/* Makes two parallel disks that face each other: one with n corners and, above it, one with k
 * corners, rotated by the angle `turn`. All positions are multiplied by `scale`. */
static he_mesh *disks(uint32_t n, uint32_t k, double turn, double scale)
{
    he_soup soup;
    he_mesh *m = NULL;
    he_soup_init(&soup, NULL);
    for (uint32_t i = 0; i < n + k; i++) {
        double angle = i < n ? TURN * i / n : TURN * (i - n) / k + turn;
        he_vec3 p = {scale * cos(angle), scale * sin(angle), i < n ? 0 : scale};
        assert_int_equal(he_soup_add_vertex(&soup, p, NULL), HE_OK);
    }
    assert_int_equal(he_soup_begin_face(&soup, NULL), HE_OK);
    for (uint32_t i = 0; i < n; i++) {
        assert_int_equal(he_soup_add_corner(&soup, i, NULL), HE_OK);
    }
    assert_int_equal(he_soup_begin_face(&soup, NULL), HE_OK);
    for (uint32_t i = k; i-- > 0;) {
        assert_int_equal(he_soup_add_corner(&soup, n + i, NULL), HE_OK);
    }
    assert_int_equal(he_build(&soup, HE_BUILD_TAKE, &m, NULL, NULL), HE_OK);
    he_soup_clear(&soup);
    return m;
}

/* Returns the angle around the z axis between the two ends of an edge, as a fraction of a full
 * turn. */
static double twist_of(const he_mesh *m, uint32_t e)
{
    he_halfedge h = {2 * e};
    he_vec3 p = he_position(m, he_origin(m, h)), q = he_position(m, he_target(m, h));
    double angle = atan2(p.y, p.x) - atan2(q.y, q.x);
    return fabs(remainder(angle, TURN)) / TURN;
}

static double bridge_disks(he_mesh *m, uint32_t n, uint32_t k)
{
    he_bridge bridge;
    double most = 0;
    he_halfedge a = halfedge_between(m, 1, 0), b = he_twin(he_face_halfedge(m, (he_face){1}));
    assert_int_equal(he_loop_bridge(m, a, b, &bridge, NULL), HE_OK);
    assert_valid(m);
    assert_int_equal(bridge.edges.count, n == k ? n : n + k);
    assert_int_equal(bridge.faces.count, bridge.edges.count);
    assert_int_equal(he_mesh_boundary_halfedges(m), 0);
    assert_int_equal(euler_of(m), 2);
    for (size_t i = 0; i < bridge.edges.count; i++) {
        he_halfedge rung = {2 * bridge.edges.ids[i]};
        most = fmax(most, twist_of(m, bridge.edges.ids[i]));
        assert_true(he_origin(m, rung).i < n && he_target(m, rung).i >= n);
        assert_int_equal(he_face_of(m, he_twin(rung)).i, bridge.faces.ids[i]);
    }
    /* The first edge of the bridge must begin at the origin of half-edge `a`, the first argument of
     * the edit. */
    assert_int_equal(he_origin(m, (he_halfedge){2 * bridge.edges.ids[0]}).i, 1);
    he_bridge_clear(&bridge);
    return most;
}

static void a_bridge_of_equal_loops_is_not_twisted(void **state)
{
    (void)state;
    static const uint32_t sizes[] = {3, 4, 7, 12, 255, 256, 257, 300, 1000};
    static const double scales[] = {1, 1e300, 1e-300};
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        uint32_t n = sizes[i];
        for (uint32_t turned = 0; turned < n; turned += 1 + n / 3) {
            he_mesh *m = disks(n, n, TURN * (turned + 0.3) / n, scales[turned % 3]);
            double most = bridge_disks(m, n, n);
            assert_true(fabs(most - 0.3 / n) < 1e-9);
            he_mesh_free(m);
        }
    }
}

static void a_bridge_of_unequal_loops_is_not_twisted(void **state)
{
    (void)state;
    for (uint32_t n = 3; n < 60; n += 1 + n / 4) {
        for (uint32_t k = 3; k < 700; k += 1 + k / 2) {
            he_mesh *m = disks(n, k, 0.1 * n, 1);
            double most = bridge_disks(m, n, k);
            assert_true(n == k || most < 0.501 / n + 0.501 / k);
            he_mesh_free(m);
        }
    }
}

/* All corners of the small loop are nearest to one corner of the large loop, so many triangles of
 * the bridge meet at this corner. */
static void a_small_loop_at_one_corner_of_a_large_one_is_bridged(void **state)
{
    (void)state;
    for (uint32_t n = 3; n < 9; n++) {
        he_mesh *m = disks(n, 100, 0, 1);
        for (uint32_t i = 0; i < 100; i++) {
            he_vec3 p = he_vec3_scale(he_position(m, (he_vertex){n + i}), 1e-3);
            assert_int_equal(p.z > 0, 1);
            p.x += 1;
            he_set_position(m, (he_vertex){n + i}, p);
        }
        he_bridge bridge;
        assert_int_equal(he_loop_bridge(m, he_twin(he_face_halfedge(m, (he_face){1})),
                                        halfedge_between(m, 1, 0), &bridge, NULL),
                         HE_OK);
        assert_valid(m);
        assert_int_equal(bridge.faces.count, n + 100);
        he_bridge_clear(&bridge);
        he_mesh_free(m);
    }
}

/* The loop of half-edge 1-0 passes the bow-tie 0 twice. The bridge fills both gaps between the two
 * fans at vertex 0, so the fans become one. */
static void a_bridge_joins_the_fans_of_a_bowtie_and_loop_join_does_not(void **state)
{
    (void)state;
    he_mesh *m = script_mesh("012,034,56789a", NULL);
    assert_int_equal(he_vertex_fans(m, (he_vertex){0}), 2);
    script_prepare(m, "loop_bridge a=1-0 b=6-5");
    assert_valid(m);
    assert_loops(m, "");
    assert_int_equal(he_vertex_fans(m, (he_vertex){0}), 1);
    assert_false(he_is_boundary_vertex(m, (he_vertex){0}));
    he_mesh_free(m);

    /* loop_join deletes face 012 and puts the triangle 567 in its place. The gaps between the two
     * fans at vertex 0 stay open, so vertex 0 still has two fans. */
    m = script_mesh("012,034,567", NULL);
    script_prepare(m, "loop_join a=0-1 b=6-5");
    assert_valid(m);
    assert_counts(m, 5, 6, 2);
    assert_int_equal(he_vertex_fans(m, (he_vertex){0}), 2);
    he_mesh_free(m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(loop_join_makes_a_closed_mesh_of_two_open_tetrahedra),
        cmocka_unit_test(a_bridge_and_a_join_make_a_torus_of_two_cylinders),
        cmocka_unit_test(the_first_loop_survives_loop_join),
        cmocka_unit_test(loop_split_reports_the_new_vertices_edges_and_faces),
        cmocka_unit_test(loop_join_undoes_loop_split),
        cmocka_unit_test(loop_split_undoes_loop_join_once_its_faces_are_deleted),
        cmocka_unit_test(deleting_the_new_faces_undoes_loop_bridge),
        cmocka_unit_test(a_bridge_of_equal_loops_is_not_twisted),
        cmocka_unit_test(a_bridge_of_unequal_loops_is_not_twisted),
        cmocka_unit_test(a_small_loop_at_one_corner_of_a_large_one_is_bridged),
        cmocka_unit_test(a_bridge_joins_the_fans_of_a_bowtie_and_loop_join_does_not),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
