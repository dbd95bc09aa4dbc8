/* Tests of the repair split: a surface that is closed and consistently oriented must stay
 * closed. */
#include "repair_fixture.h"

#include "model/random.h"
#include "seed.h"

/* Applies the repair split, and requires that the mesh is closed and has all faces. */
static void expect_closed(const he_soup *soup)
{
    he_repaired done = {0};
    he_repair_plan plan = repair_plan_of(SPLIT);
    he_mesh *mesh = repair_mend(soup, &plan, &done);
    assert_int_equal(he_mesh_boundary_halfedges(mesh), 0);
    assert_int_equal(he_mesh_faces(mesh), soup->face_count);
    he_mesh_free(mesh);
    he_repaired_clear(&done);
}

/* In these closed surfaces, four or more faces meet at some edges, and the repair divides them into
 * pairs. If the faces were paired in their order, two pairs would join the same two fans, so the
 * repair must find other pairs. */
static void pairs_between_the_same_fans_exchange_partners(void **state)
{
    (void)state;
    static const char *const rows[] = {
        /* a tetrahedron and a reversed copy of it, both on the same vertices */
        "031,123,320,321,130,210,023,201",
        /* two pairs of triangles back to back; the second pair is in reverse order */
        "012,013,103,102",
        /* three pairs of triangles back to back, all at one edge; the first and the last triangle
         * form a pair */
        "012,013,014,103,104,102",
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        he_soup soup;
        fixture_soup(&soup, rows[i]);
        expect_closed(&soup);
        he_soup_clear(&soup);
    }
}

static void random_closed_soups_stay_closed(void **state)
{
    (void)state;
    enum { SOUPS = 5000 };
    static const uint32_t faces[4][3] = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
    md_random random = {seed_of_run()};
    for (unsigned i = 0; i < SOUPS; i++) {
        uint32_t vertices = 4 + md_below(&random, 4), solids = 1 + md_below(&random, 8);
        uint32_t list[32][3], count = 4 * solids;
        he_soup soup;
        he_soup_init(&soup, NULL);
        for (uint32_t v = 0; v < vertices; v++) {
            assert_int_equal(he_soup_add_vertex(&soup, (he_vec3){v, v * v, 0}, NULL), HE_OK);
        }
        for (uint32_t s = 0; s < solids; s++) {
            uint32_t corners[4];
            for (uint32_t k = 0; k < 4;) {
                corners[k] = md_below(&random, vertices);
                uint32_t same = 0;
                while (corners[same] != corners[k]) {
                    same++;
                }
                k += same == k;
            }
            for (uint32_t f = 0; f < 4; f++) {
                for (uint32_t c = 0; c < 3; c++) {
                    list[4 * s + f][c] = corners[faces[f][c]];
                }
            }
        }
        for (uint32_t left = count; left > 0; left--) {
            uint32_t pick = md_below(&random, left);
            assert_int_equal(he_soup_add_face(&soup, list[pick], 3, NULL), HE_OK);
            memcpy(list[pick], list[left - 1], sizeof list[pick]);
        }
        expect_closed(&soup);
        he_soup_clear(&soup);
    }
}

/* The faces around one edge are pairs of triangles, back to back. If the faces were paired in the
 * order in which the repair tries them first, every pair would join the same two fans. */
static void an_edge_of_very_many_faces_takes_no_longer(void **state)
{
    (void)state;
    enum { PILLOWS = 100000 };
    he_soup soup;
    he_mesh *mesh = NULL;
    he_repaired done = {0};
    he_repair_plan plan = repair_plan_of(SPLIT);
    he_soup_init(&soup, NULL);
    for (uint32_t v = 0; v < PILLOWS + 2; v++) {
        assert_int_equal(he_soup_add_vertex(&soup, (he_vec3){v, v % 7, v % 3}, NULL), HE_OK);
    }
    for (uint32_t i = 0; i < 2 * PILLOWS; i++) {
        uint32_t v = 2 + (i < PILLOWS ? i : (i + 1) % PILLOWS), back = i >= PILLOWS;
        uint32_t corners[3] = {back, 1 - back, v};
        assert_int_equal(he_soup_add_face(&soup, corners, 3, NULL), HE_OK);
    }
    assert_int_equal(he_repair_soup(&soup, &plan, &done, NULL), HE_OK);
    assert_int_equal(he_build(&soup, 0, &mesh, NULL, NULL), HE_OK);
    assert_int_equal(he_mesh_boundary_halfedges(mesh), 0);
    assert_int_equal(he_mesh_vertices(mesh), 3 * PILLOWS);
    he_mesh_free(mesh);
    he_repaired_clear(&done);
    he_soup_clear(&soup);
}

static void every_failing_allocation_is_survived(void **state)
{
    (void)state;
    he_soup soup;
    fixture_soup(&soup, "012,013,014,015,016,103,104,105,106,102");
    repair_expect_failures_survived(&soup, SPLIT, 15);
    he_soup_clear(&soup);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pairs_between_the_same_fans_exchange_partners),
        cmocka_unit_test(random_closed_soups_stay_closed),
        cmocka_unit_test(an_edge_of_very_many_faces_takes_no_longer),
        cmocka_unit_test(every_failing_allocation_is_survived),
    };
    return cmocka_run_group_tests_name("repair_split", tests, NULL, NULL);
}
