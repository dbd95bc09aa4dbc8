/* Polygons are triangulated for file formats that have only triangles. In the meshes of this test,
 * very many faces share two vertices. */
#include "unit/fixture.h"

#include "format/io/export_triangles.h"
#include "tests/failing.h"

/* Makes quadrilaterals with the corners 0, a, 1, b; each quadrilateral has its own vertices a and
 * b. Both diagonals of a quadrilateral exist as edges already: 0-1 belongs to the triangle 0-1-2,
 * and a-b to a triangle beside the quadrilateral. Vertex 2 is connected to the vertex a of every
 * second quadrilateral, so vertices 0, 1 and 2 have a high degree. */
static he_mesh *two_hubs(uint32_t quads)
{
    he_soup soup;
    he_mesh *m = NULL;
    he_soup_init(&soup, NULL);
    for (uint32_t v = 0; v < 3 + 3 * quads; v++) {
        const uint32_t layer = v / 3;
        he_vec3 p = {v < 3 ? v : 0.5, v % 3, 1 + layer};
        assert_int_equal(he_soup_add_vertex(&soup, p, NULL), HE_OK);
    }
    for (uint32_t i = 0; i < quads; i++) {
        uint32_t a = 3 + 3 * i, b = a + 1;
        assert_int_equal(he_soup_add_face(&soup, (uint32_t[]){0, a, 1, b}, 4, NULL), HE_OK);
        assert_int_equal(he_soup_add_face(&soup, (uint32_t[]){b, a, a + 2}, 3, NULL), HE_OK);
        if (i == quads / 2) {
            assert_int_equal(he_soup_add_face(&soup, (uint32_t[]){0, 1, 2}, 3, NULL), HE_OK);
        } else if (i % 2 == 0) {
            assert_int_equal(he_soup_add_face(&soup, (uint32_t[]){2, a + 2, a}, 3, NULL), HE_OK);
        }
    }
    assert_int_equal(he_build(&soup, 0, &m, NULL, NULL), HE_OK);
    he_soup_clear(&soup);
    return m;
}

static void steps_of_a_loop_that_is_refused_count(void **state)
{
    (void)state;
    enum { QUADS = 1000 };
    he_mesh *m = two_hubs(QUADS);
    he_triangulation cut;
    he_edge_lookup lookup;
    he_halfedge first = he_face_halfedge(m, (he_face){0});
    he_triangulation_work walk = {0}, search = {.lookup = &lookup};
    const unsigned flags = HE_ANY_DIAGONALS | HE_AVOID_EDGES;
    assert_int_equal(he_triangulation_make(m, first, flags, &walk, &cut, NULL), HE_DOUBLED_EDGE);
    assert_true(walk.steps > QUADS);
    assert_int_equal(he_edge_lookup_make(m, &lookup, NULL), HE_OK);
    assert_int_equal(he_triangulation_make(m, first, flags, &search, &cut, NULL), HE_DOUBLED_EDGE);
    assert_true(search.steps > 0 && search.steps < QUADS);
    he_edge_lookup_clear(&lookup);
    he_mesh_free(m);
}

static void all_pairs_are_joined_as_turning_finds_them(void **state)
{
    (void)state;
    he_mesh *m = two_hubs(100);
    he_edge_lookup lookup;
    uint64_t steps = 0;
    uint32_t many = 0;
    assert_int_equal(he_edge_lookup_make(m, &lookup, NULL), HE_OK);
    for (uint32_t a = 0; a < m->c.vertices.issued; a++) {
        many += lookup.rank[a] != HE_NONE;
        for (uint32_t b = 0; b < m->c.vertices.issued; b++) {
            bool is = he_find_halfedge(m, (he_vertex){a}, (he_vertex){b}).i != HE_NONE;
            assert_int_equal(he_edge_lookup_has(m, &lookup, (he_vertex){a}, (he_vertex){b}, &steps),
                             is);
        }
    }
    assert_int_equal(many, 3);
    assert_true(lookup.starts[3] > 0);
    he_edge_lookup_clear(&lookup);
    he_mesh_free(m);
}

/* The table of edges must contain exactly the pairs of vertices that were added to it. */
static void what_is_noted_is_joined(void **state)
{
    (void)state;
    enum { HUBS = 40 };
    he_soup soup;
    he_mesh *m = NULL;
    he_edge_lookup lookup;
    uint64_t steps = 0;
    he_soup_init(&soup, NULL);
    for (uint32_t v = 0; v < HUBS * 41; v++) {
        assert_int_equal(he_soup_add_vertex(&soup, (he_vec3){v, v % 7, v % 3}, NULL), HE_OK);
    }
    for (uint32_t v = 0; v < HUBS; v++) {
        for (uint32_t i = 0; i < 39; i++) {
            uint32_t a = HUBS + 40 * v + i;
            assert_int_equal(he_soup_add_face(&soup, (uint32_t[]){v, a, a + 1}, 3, NULL), HE_OK);
        }
    }
    assert_int_equal(he_build(&soup, 0, &m, NULL, NULL), HE_OK);
    he_soup_clear(&soup);
    assert_int_equal(he_edge_lookup_make(m, &lookup, NULL), HE_OK);
    for (uint32_t a = 0; a < HUBS; a++) {
        assert_int_equal(he_edge_lookup_reserve(&lookup, HUBS, NULL), HE_OK);
        for (uint32_t b = a + 1; b < HUBS; b++) {
            if ((a + b) % 3 == 0) {
                he_edge_lookup_add(&lookup, (he_vertex){b}, (he_vertex){a});
            }
        }
    }
    for (uint32_t a = 0; a < HUBS; a++) {
        for (uint32_t b = 0; b < HUBS; b++) {
            bool noted = a != b && (a + b) % 3 == 0;
            assert_int_equal(he_edge_lookup_has(m, &lookup, (he_vertex){a}, (he_vertex){b}, &steps),
                             noted);
        }
    }
    he_edge_lookup_clear(&lookup);
    he_mesh_free(m);
}

/* All faces share two vertices. If the triangulation of each face visited all edges of these two
 * vertices, it would take quadratic time. */
static void faces_about_two_vertices_are_cut_in_linear_time(void **state)
{
    (void)state;
    enum { QUADS = 4000 };
    he_mesh *m = two_hubs(QUADS);
    he_export_triangles cuts;
    assert_int_equal(he_export_triangles_make(m, NULL, &cuts, NULL), HE_OK);
    assert_int_equal(cuts.polygons, QUADS);
    assert_int_equal(cuts.corners.count, 6 * QUADS);
    assert_true(cuts.steps < 500 * QUADS);
    he_export_triangles_clear(&cuts);
    he_mesh_free(m);
}

static void no_memory_for_neighbours(void **state)
{
    (void)state;
    he_mesh *m = two_hubs(100);
    failing f = {0};
    while (failing_next(&f)) {
        he_edge_lookup lookup = {0};
        he_error err = {0};
        he_status status = he_edge_lookup_make(m, &lookup, &err);
        failing_status(&f, status);
        assert_int_equal(err.status, status);
        he_edge_lookup_clear(&lookup);
    }
    assert_int_equal(f.n, 4);
    he_mesh_free(m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(steps_of_a_loop_that_is_refused_count),
        cmocka_unit_test(all_pairs_are_joined_as_turning_finds_them),
        cmocka_unit_test(what_is_noted_is_joined),
        cmocka_unit_test(faces_about_two_vertices_are_cut_in_linear_time),
        cmocka_unit_test(no_memory_for_neighbours),
    };
    return cmocka_run_group_tests_name("format_cuts", tests, NULL, NULL);
}
