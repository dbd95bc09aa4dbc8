/* Edits that open, close and extend the boundary of a mesh, and edge_bevel: their results, and
 * which of these edits undo each other. */
#include "edit_script.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "build/build.h"
#include "edit/bevel/edge_bevel.h"
#include "edit/border/edge_extrude.h"
#include "edit/border/seam.h"
#include "mesh/write.h"

#define QCUBE   "0123,7654,1045,2156,3267,0374"
#define TETRA   "021,013,032,123"
#define RING10  "401,430,512,541,652,734,874,845,985,956"
#define STRANGE "012,034,056"
#define HEXAGON "012,023,034,045,056,061"

static const he_vec3 cube[] = {{0, 0, 0},  {1, 0, 0},  {1, 1, 0},  {0, 1, 0},
                               {0, 0, -1}, {1, 0, -1}, {1, 1, -1}, {0, 1, -1}};

static void assert_at(const he_mesh *m, uint32_t v, double x, double y, double z)
{
    he_vec3 p = he_position(m, (he_vertex){v});
    assert_true(fabs(p.x - x) < 1e-12 && fabs(p.y - y) < 1e-12 && fabs(p.z - z) < 1e-12);
}

/* Lets each vertex of `m` store the half-edge that it stores in `like`, so that both meshes can be
 * compared: several half-edges are valid for an interior vertex or a bow-tie. */
static void store_like(he_mesh *m, const he_mesh *like)
{
    for (uint32_t v = 0; v < he_mesh_issued(like, HE_VERTEX); v++) {
        if (he_vertex_is_live(like, (he_vertex){v})) {
            he_set_vertex_halfedge(m, (he_vertex){v}, he_vertex_halfedge(like, (he_vertex){v}));
        }
    }
}

/* --- edge_cut and edge_weld --- */

static void edge_weld_undoes_edge_cut(void **state)
{
    (void)state;
    static const char *const meshes[] = {
        HEXAGON, "012,023",   "012,023,034,045",
        RING10,  "0123,3245", "0154,1265,2376,4598,56a9,67ba,89dc,9aed"};
    unsigned cut = 0;
    for (size_t i = 0; i < sizeof meshes / sizeof *meshes; i++) {
        he_mesh *m = script_mesh(meshes[i], NULL);
        script_add_columns(m);
        uint32_t edges = he_mesh_edges(m);
        for (uint32_t e = 0; e < edges; e++) {
            he_mesh *before = copy_of(m);
            he_seam seam;
            if (he_edge_cut(m, &e, 1, &seam, NULL) != HE_OK) {
                assert_equal(m, before);
                he_mesh_free(before);
                continue;
            }
            assert_valid(m);
            assert_true(he_is_boundary_edge(m, (he_edge){e}));
            assert_int_equal(seam.edges.count, 1);
            assert_int_equal(he_edge_weld(m, (he_edge){e}, (he_edge){seam.edges.ids[0]},
                                          HE_KEEP_MEAN, NULL, NULL),
                             HE_OK);
            assert_valid(m);
            store_like(m, before);
            assert_valid(m);
            assert_true(he_mesh_equal_live(m, before));
            he_seam_clear(&seam);
            he_mesh_free(before);
            cut++;
        }
        he_mesh_free(m);
    }
    assert_true(cut > 20);
}

static void a_cube_cut_along_all_edges_falls_apart(void **state)
{
    (void)state;
    he_mesh *m = script_mesh(QCUBE, cube);
    script_prepare(m, "edge_cut edges=#0,#1,#2,#3,#4,#5,#6,#7,#8,#9,#10,#11");
    assert_counts(m, 24, 24, 6);
    assert_loops(m, "444444");
    for (uint32_t f = 0; f < 6; f++) {
        he_halfedge h = he_face_halfedge(m, (he_face){f});
        for (unsigned i = 0; i < 4; i++, h = he_next(m, h)) {
            assert_int_equal(he_vertex_degree(m, (he_vertex){he_origin(m, h).i}), 2);
        }
    }
    he_mesh_free(m);
}

static void a_cut_leaves_other_fans_unchanged(void **state)
{
    (void)state;
    /* Vertex 0 is a bow-tie with a fan of two faces and a fan of three faces. The edit cuts the fan
     * of three faces. */
    he_mesh *m = script_mesh("012,023,045,056,067", NULL);
    uint32_t e = edge_between(m, 0, 5).i;
    script_prepare(m, "edge_cut edge=0-5");
    assert_valid(m);
    assert_face(m, 0, "012");
    assert_face(m, 1, "023");
    assert_int_equal(he_vertex_fans(m, (he_vertex){0}), 2);
    /* Half-edge 2e of the cut edge must still run between the old vertices 0 and 5. */
    assert_int_equal(he_origin(m, (he_halfedge){2 * e}).i + he_target(m, (he_halfedge){2 * e}).i,
                     5);
    assert_false(he_is_boundary_halfedge(m, (he_halfedge){2 * e}));
    he_mesh_free(m);
}

static void edge_weld_places_the_ends_as_keep_chooses(void **state)
{
    (void)state;
    static const he_vec3 places[] = {{0, 0, 0}, {0, 2, 0}, {-2, 0, 0},
                                     {4, 0, 0}, {6, 0, 0}, {4, 4, 0}};
    static const struct {
        const char *weld;
        double low, high, top;
    } cases[] = {{"edge_weld a=0-1 b=3-5", 2, 2, 3},
                 {"edge_weld a=0-1 b=3-5 keep=mean", 2, 2, 3},
                 {"edge_weld a=0-1 b=3-5 keep=a", 0, 0, 2},
                 {"edge_weld a=0-1 b=3-5 keep=b", 4, 4, 4}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        /* After the weld, the ends of the merged edge must be where the parameter `keep` says: at
         * the mean of the old positions, or at the ends of one of the two welded edges. */
        he_mesh *m = script_mesh("012,345", places);
        script_prepare(m, cases[i].weld);
        assert_counts(m, 4, 5, 2);
        assert_at(m, 0, cases[i].low, 0, 0);
        assert_at(m, 1, cases[i].high, cases[i].top, 0);
        he_mesh_free(m);
    }
}

static void fans_of_a_bowtie_can_be_welded_in_every_order(void **state)
{
    (void)state;
    static const char *const welds[] = {"edge_weld a=0-2 b=0-3", "edge_weld a=0-4 b=0-5",
                                        "edge_weld a=0-6 b=0-7", "edge_weld a=0-8 b=0-1"};
    /* Vertex 0 has four fans of faces; each weld joins two of them, and the test tries every order
     * of the welds. The last weld joins the two ends of the only fan that is left, and so closes
     * the fan. */
    for (unsigned order = 0; order < 256; order++) {
        unsigned used = 0;
        he_mesh *m = script_mesh("012,034,056,078", NULL);
        for (unsigned k = 0; k < 4; k++) {
            unsigned i = order >> 2 * k & 3;
            if (!(used >> i & 1)) {
                used |= 1u << i;
                script_prepare(m, welds[i]);
                assert_valid(m);
            }
        }
        if (used == 15) {
            assert_counts(m, 5, 8, 4);
            assert_false(he_is_boundary_vertex(m, (he_vertex){0}));
        }
        he_mesh_free(m);
    }
}

/* --- edge_extrude --- */

static void deleting_the_walls_undoes_edge_extrude(void **state)
{
    (void)state;
    static const struct {
        const char *mesh, *prepare, *extrude;
    } cases[] = {
        {"012", NULL, "edge_extrude edge=0-1 by=0,0,1"},
        {"012", NULL, "edge_extrude edges=0-1,1-2 by=0,0,1"},
        {"012", NULL, "edge_extrude edges=0-1,1-2,2-0 by=0,0,1"},
        {QCUBE, "face_delete face=0", "edge_extrude edges=0-1,1-2,2-3,3-0 by=0,0,1"},
        {STRANGE, NULL, "edge_extrude edges=0-1,0-4 by=0,0,1"},
        {STRANGE, NULL, "edge_extrude edges=0-1,0-6,3-4 by=0,0,1"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        for (unsigned by_edge = 0; by_edge < 2; by_edge++) {
            he_mesh *m = script_mesh(cases[i].mesh, NULL);
            he_results results = {.each = false};
            script_prepare(m, cases[i].prepare);
            he_mesh *before = copy_of(m);
            assert_int_equal(script_run(m, cases[i].extrude, &results, NULL), HE_OK);
            assert_valid(m);
            assert_true(he_mesh_faces(m) > he_mesh_faces(before));
            /* edge_extrude adds a wall of new faces at the boundary. Deleting these faces, or their
             * edges on the new boundary, must restore the old mesh. */
            char text[128];
            int n =
                snprintf(text, sizeof text, by_edge ? "edge_delete edges=" : "face_delete faces=");
            const he_ids *list = &results.list[by_edge ? 1 : 2];
            for (size_t k = 0; k < list->count; k++) {
                n += snprintf(text + n, sizeof text - (size_t)n, "#%u,", list->ids[k]);
            }
            script_prepare(m, text);
            assert_valid(m);
            assert_int_equal(he_mesh_vertices(m), he_mesh_vertices(before));
            assert_int_equal(he_mesh_edges(m), he_mesh_edges(before));
            if (strcmp(cases[i].mesh, STRANGE) != 0) {
                /* The walls are deleted, but a bow-tie may store another half-edge than before
                 * edge_extrude: the test gives it the old half-edge, so that the meshes can be
                 * compared. */
                store_like(m, before);
                assert_true(he_mesh_equal_live(m, before));
            }
            he_results_clear(&results);
            he_mesh_free(before);
            he_mesh_free(m);
        }
    }
}

static void extruded_edges_that_meet_share_a_new_corner(void **state)
{
    (void)state;
    he_mesh *m = script_mesh("0123", cube);
    he_results results = {.each = false};
    assert_int_equal(script_run(m, "edge_extrude edges=1-2,0-1 by=0,0,3", &results, NULL), HE_OK);
    assert_counts(m, 7, 9, 3);
    /* New vertices are numbered in the order of the vertices from which they were extruded, new
     * faces and edges in the order of the edges given in the request. */
    for (uint32_t v = 0; v < 3; v++) {
        assert_at(m, 4 + v, cube[v].x, cube[v].y, 3);
    }
    assert_face(m, 1, "2156");
    assert_face(m, 2, "1045");
    assert_int_equal(results.list[1].ids[0], edge_between(m, 5, 6).i);
    assert_int_equal(results.list[1].ids[1], edge_between(m, 4, 5).i);
    assert_false(he_is_boundary_vertex(m, (he_vertex){1}));
    /* The edges that the first extrusion made on the boundary can be extruded again. */
    script_prepare(m, "edge_extrude edges=4-5,5-6 by=0,0,1");
    assert_counts(m, 10, 14, 5);
    he_results_clear(&results);
    he_mesh_free(m);
}

/* --- edge_bevel --- */

static void a_cube_edge_bevels_to_a_quadrilateral(void **state)
{
    (void)state;
    he_mesh *m = script_mesh(QCUBE, cube);
    he_results results = {.each = false};
    assert_int_equal(script_run(m, "edge_bevel edge=0-1 width=0.25", &results, NULL), HE_OK);
    assert_counts(m, 10, 15, 7);
    assert_face(m, 6, "89ab");
    assert_face(m, 0, "8b23");
    assert_face(m, 2, "a945");
    assert_face(m, 3, "2ba56");
    assert_face(m, 5, "98374");
    assert_at(m, 8, 0, 0.25, 0);
    assert_at(m, 9, 0, 0, -0.25);
    assert_at(m, 10, 1, 0, -0.25);
    assert_at(m, 11, 1, 0.25, 0);
    assert_int_equal(results.id[0], 6);
    assert_int_equal(results.list[1].count, 4);
    assert_int_equal(results.list[2].count, 4);
    assert_int_equal(results.list[2].ids[0], edge_between(m, 8, 9).i);
    assert_int_equal(results.list[2].ids[3], edge_between(m, 11, 8).i);
    he_results_clear(&results);
    he_mesh_free(m);
}

static void a_bevel_is_narrower_than_the_edges_it_cuts(void **state)
{
    (void)state;
    he_mesh *m = script_mesh(QCUBE, cube);
    script_prepare(m, "vertex_move vertex=4 to=0,0,-9;edge_bevel edge=0-1 width=7");
    /* Each edge is cut at the width 7, but not beyond 99 hundredths of its length. */
    assert_at(m, 8, 0, 0.99, 0);
    assert_at(m, 9, 0, 0, -7);
    assert_int_equal(he_edge_bevel(m, edge_between(m, 6, 7), (double)NAN, NULL, NULL),
                     HE_BAD_VALUE);
    assert_int_equal(he_edge_bevel(m, edge_between(m, 6, 7), (double)INFINITY, NULL, NULL), HE_OK);
    assert_valid(m);
    he_mesh_free(m);
}

static void both_bevels_cut_an_edge_without_length_halfway(void **state)
{
    (void)state;
    static const char *const bevels[] = {"edge_bevel edge=0-1 width=0.25",
                                         "vertex_bevel vertex=0 width=0.25"};
    for (size_t i = 0; i < sizeof bevels / sizeof *bevels; i++) {
        he_mesh *m = script_mesh(QCUBE, cube);
        he_column *column = NULL;
        assert_int_equal(
            he_column_new(&(he_column_schema){"a", HE_VERTEX, HE_DOUBLE, 1, HE_INTERPOLATE},
                          &column, NULL),
            HE_OK);
        assert_int_equal(he_column_extend(column, 8, NULL), HE_OK);
        double value = 8;
        memcpy(he_column_row(column, 3), &value, sizeof value);
        assert_int_equal(he_mesh_add_column(m, column, NULL), HE_OK);
        script_prepare(m, "vertex_move vertex=3 to=0,0,0");
        script_prepare(m, bevels[i]);
        assert_valid(m);
        /* The bevel has cut the edge from 0 to 3 by a new vertex: `cut` is this vertex, the only
         * new neighbour of vertex 3. */
        uint32_t cut = HE_NONE;
        he_halfedge first = he_vertex_halfedge(m, (he_vertex){3}), h = first;
        do {
            uint32_t w = he_target(m, h).i;
            cut = w == 0 || w > 7 ? w : cut;
            h = he_swing_ccw(m, h);
        } while (h.i != first.i);
        assert_at(m, cut, 0, 0, 0);
        memcpy(&value, he_column_value(he_mesh_find_column(m, HE_VERTEX, "a"), cut), sizeof value);
        assert_true(fabs(value - 4) < 1e-12);
        he_mesh_free(m);
    }
}

static void a_bevel_beside_a_hole_keeps_the_ends_of_its_edge(void **state)
{
    (void)state;
    static const he_vec3 square[] = {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}};
    he_mesh *m = script_mesh("012,023", square);
    he_edge e = edge_between(m, 0, 2);
    bool from_0 = he_origin(m, he_edge_halfedge(e, 0)).i == 0;
    script_prepare(m, "edge_bevel edge=0-2 width=1");
    assert_counts(m, 8, 10, 3);
    /* The new face has six corners. Three are at one end of the bevelled edge: a new vertex on the
     * neighbouring edge, the old end, a new vertex on the next neighbouring edge. Three are at the
     * other end of the edge. */
    assert_face(m, 2, from_0 ? "405627" : "425607");
    assert_at(m, 0, 0, 0, 0);
    assert_at(m, 2, 4, 4, 0);
    assert_loops(m, "8");
    he_mesh_free(m);
}

static void bevels_of_tiny_and_huge_edges_have_finite_positions(void **state)
{
    (void)state;
    static const double scales[] = {1e-320, 1e-300, 1e300, 1.5e308};
    static const double widths[] = {1e-322, 1e-300, 1, 1e308};
    for (unsigned i = 0; i < 4; i++) {
        for (unsigned k = 0; k < 4; k++) {
            he_vec3 places[8];
            for (unsigned v = 0; v < 8; v++) {
                places[v] =
                    (he_vec3){(2 * cube[v].x - 1) * scales[i], (2 * cube[v].y - 1) * scales[i],
                              (2 * cube[v].z + 1) * scales[i]};
            }
            he_mesh *m = script_mesh(QCUBE, places);
            he_status status = he_edge_bevel(m, edge_between(m, 0, 1), widths[k], NULL, NULL);
            assert_int_equal(status, HE_OK);
            /* assert_counts() also requires that positions are finite */
            assert_counts(m, 10, 15, 7);
            he_mesh_free(m);
        }
    }
}

/* --- marks, attribute values, parents and survivors --- */

enum { FIRST_VALUE = 10 };

/* Adds a column of attribute values, one double per element; element i has the value 10 * i. */
static void add_column(he_mesh *m, he_kind domain, he_rule rule)
{
    he_column *column = NULL;
    assert_int_equal(
        he_column_new(&(he_column_schema){"value", domain, HE_DOUBLE, 1, rule}, &column, NULL),
        HE_OK);
    size_t rows = he_mesh_issued(m, domain);
    assert_int_equal(he_column_extend(column, rows, NULL), HE_OK);
    for (size_t row = 0; row < rows; row++) {
        double value = FIRST_VALUE * (double)row;
        memcpy(he_column_row(column, row), &value, sizeof value);
    }
    assert_int_equal(he_mesh_add_column(m, column, NULL), HE_OK);
}

static double value_of(const he_mesh *m, he_kind domain, uint32_t id)
{
    double value;
    memcpy(&value, he_column_value(he_mesh_find_column(m, domain, "value"), id), sizeof value);
    return value;
}

static void values_of_new_elements_follow_the_rule_of_their_column(void **state)
{
    (void)state;
    static const struct {
        const char *mesh, *script;
        he_kind domain;
        he_rule rule;
        uint32_t id;
        double value;
    } cases[] = {
        {"012,023", "edge_cut edge=0-2", HE_EDGE, HE_COPY, 5, 20},
        {"012,023", "edge_cut edge=0-2", HE_EDGE, HE_DEFAULT, 5, 0},
        {"012,345", "edge_weld a=0-1 b=3-4", HE_EDGE, HE_INTERPOLATE, 0, 0},
        {"012,345", "edge_weld a=0-1 b=3-4 keep=b", HE_EDGE, HE_INTERPOLATE, 0, 0},
        {"012,345", "edge_weld a=0-1 b=3-4", HE_HALFEDGE, HE_COPY, 1, 60},
        {"012,023", "edge_extrude edge=2-3 by=0,0,1", HE_VERTEX, HE_COPY, 5, 30},
        {"012", "edge_extrude edge=1-2 by=0,0,1", HE_FACE, HE_COPY, 1, 0},
        {"012", "edge_extrude edge=1-2 by=0,0,1", HE_EDGE, HE_COPY, 5, 10},
        {"012", "edge_extrude edge=1-2 by=0,0,1", HE_EDGE, HE_COPY, 4, 0},
        {"012", "edge_extrude edge=1-2 by=0,0,1", HE_HALFEDGE, HE_COPY, 3, 40},
        {"012", "edge_extrude edge=1-2 by=0,0,1", HE_HALFEDGE, HE_COPY, 10, 20},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        he_mesh *m = script_mesh(cases[i].mesh, NULL);
        add_column(m, cases[i].domain, cases[i].rule);
        script_prepare(m, cases[i].script);
        assert_valid(m);
        if (value_of(m, cases[i].domain, cases[i].id) != cases[i].value) {
            fail_msg("%s: %s %u holds %g", cases[i].script, he_kind_name(cases[i].domain),
                     cases[i].id, value_of(m, cases[i].domain, cases[i].id));
        }
        he_mesh_free(m);
    }

    he_mesh *m = script_mesh(QCUBE, cube);
    add_column(m, HE_VERTEX, HE_INTERPOLATE);
    add_column(m, HE_HALFEDGE, HE_INTERPOLATE);
    /* `at_0` and `at_3` are the half-edges of face 0 that leave vertices 0 and 3; the corners of
     * face 0 at these vertices have the same ids as the half-edges. */
    uint32_t at_0 = halfedge_between(m, 0, 1).i, at_3 = halfedge_between(m, 3, 0).i;
    double expected = FIRST_VALUE * (0.75 * at_0 + 0.25 * at_3);
    script_prepare(m, "edge_bevel edge=0-1 width=0.25");
    assert_true(fabs(value_of(m, HE_VERTEX, 8) - 7.5) < 1e-12);
    assert_true(fabs(value_of(m, HE_VERTEX, 11) - 12.5) < 1e-12);
    uint32_t corner = halfedge_between(m, 8, 11).i;
    assert_int_equal(he_face_of(m, (he_halfedge){corner}).i, 0);
    assert_true(fabs(value_of(m, HE_HALFEDGE, corner) - expected) < 1e-9);
    he_mesh_free(m);
}

static void changes_name_parents_of_new_elements_and_survivors_of_welds(void **state)
{
    (void)state;
    static const struct {
        const char *mesh, *script, *vertices, *edges, *faces, *merged_vertices, *merged_edges;
    } cases[] = {
        {HEXAGON, "edge_cut edge=0-1", "7 1", "12 0", "", "", ""},
        {"012,345", "edge_weld a=0-1 b=3-4", "", "", "", "4 0 3 1", "3 0"},
        {"012", "edge_extrude edge=1-2 by=0,0,1", "3 1 4 2", "5 1", "1 0", "", ""},
        {QCUBE, "edge_bevel edge=0-1 width=0.1", "8 0 9 0 10 1 11 1", "12 0 13 0", "6 0", "", ""},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        he_mesh *m = script_mesh(cases[i].mesh, NULL);
        he_delta *delta = he_delta_new();
        he_changes changes;
        assert_non_null(delta);
        he_mesh_record(m, delta);
        script_prepare(m, cases[i].script);
        assert_int_equal(he_changes_find(m, delta, 0, delta->count, false, &changes, NULL), HE_OK);
        assert_ids(&changes.parents[HE_VERTEX], cases[i].vertices);
        assert_ids(&changes.parents[HE_EDGE], cases[i].edges);
        assert_ids(&changes.parents[HE_FACE], cases[i].faces);
        assert_ids(&changes.merged[HE_VERTEX], cases[i].merged_vertices);
        assert_ids(&changes.merged[HE_EDGE], cases[i].merged_edges);
        he_changes_clear(&changes);
        he_mesh_record(m, NULL);
        he_delta_free(delta);
        he_mesh_free(m);
    }
}

/* --- a vertex with a thousand edges --- */

enum { SPOKES = 1000 };

static he_mesh *wheel(void)
{
    he_soup soup;
    he_mesh *m = NULL;
    he_soup_init(&soup, NULL);
    assert_int_equal(he_soup_add_vertex(&soup, (he_vec3){0, 0, 0}, NULL), HE_OK);
    for (uint32_t i = 0; i < SPOKES; i++) {
        double angle = 6.283185307179586 * i / SPOKES;
        assert_int_equal(he_soup_add_vertex(&soup, (he_vec3){cos(angle), sin(angle), 0}, NULL),
                         HE_OK);
    }
    for (uint32_t i = 0; i < SPOKES; i++) {
        const uint32_t corners[3] = {0, 1 + i, 1 + (i + 1) % SPOKES};
        assert_int_equal(he_soup_add_face(&soup, corners, 3, NULL), HE_OK);
    }
    assert_int_equal(he_build(&soup, 0, &m, NULL, NULL), HE_OK);
    he_soup_clear(&soup);
    return m;
}

static void a_wheel_of_1000_spokes_is_extruded_bevelled_and_cut(void **state)
{
    (void)state;
    uint32_t spokes[SPOKES], rim[SPOKES];
    he_mesh *m = wheel();
    for (uint32_t i = 0; i < SPOKES; i++) {
        spokes[i] = edge_between(m, 0, 1 + i).i;
        rim[i] = edge_between(m, 1 + i, 1 + (i + 1) % SPOKES).i;
    }
    assert_int_equal(he_edge_extrude(m, rim, SPOKES, (he_vec3){0, 0, 1}, NULL, NULL), HE_OK);
    assert_counts(m, 1 + 2 * SPOKES, 4 * SPOKES, 2 * SPOKES);
    he_bevel bevel;
    assert_int_equal(he_edge_bevel(m, (he_edge){spokes[0]}, 0.001, &bevel, NULL), HE_OK);
    assert_int_equal(he_face_degree(m, bevel.face), SPOKES - 1 + 3);
    assert_valid(m);
    he_bevel_clear(&bevel);
    he_mesh_free(m);

    m = wheel();
    assert_int_equal(he_edge_cut(m, spokes, SPOKES, NULL, NULL), HE_OK);
    assert_counts(m, 3 * SPOKES, 3 * SPOKES, SPOKES);
    he_mesh_free(m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(edge_weld_undoes_edge_cut),
        cmocka_unit_test(a_cube_cut_along_all_edges_falls_apart),
        cmocka_unit_test(a_cut_leaves_other_fans_unchanged),
        cmocka_unit_test(edge_weld_places_the_ends_as_keep_chooses),
        cmocka_unit_test(fans_of_a_bowtie_can_be_welded_in_every_order),
        cmocka_unit_test(deleting_the_walls_undoes_edge_extrude),
        cmocka_unit_test(extruded_edges_that_meet_share_a_new_corner),
        cmocka_unit_test(a_cube_edge_bevels_to_a_quadrilateral),
        cmocka_unit_test(a_bevel_is_narrower_than_the_edges_it_cuts),
        cmocka_unit_test(both_bevels_cut_an_edge_without_length_halfway),
        cmocka_unit_test(a_bevel_beside_a_hole_keeps_the_ends_of_its_edge),
        cmocka_unit_test(bevels_of_tiny_and_huge_edges_have_finite_positions),
        cmocka_unit_test(values_of_new_elements_follow_the_rule_of_their_column),
        cmocka_unit_test(changes_name_parents_of_new_elements_and_survivors_of_welds),
        cmocka_unit_test(a_wheel_of_1000_spokes_is_extruded_bevelled_and_cut),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
