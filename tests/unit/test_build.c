/* he_build makes a mesh from a soup of faces, and refuses soups that no mesh can represent. */
#include "fixture.h"
#include "tests/failing.h"

#include <math.h>

static void expect_refusal(const char *faces, he_status reason, he_kind kind, uint32_t id,
                           uint64_t total)
{
    he_soup soup;
    he_mesh *mesh = NULL;
    he_report report;
    he_error err = {0};
    fixture_soup(&soup, faces);
    assert_int_equal(he_build(&soup, HE_BUILD_TAKE, &mesh, &report, &err), reason);
    assert_null(mesh);
    assert_int_equal(report.total, total);
    assert_int_equal(report.defects[0].reason, reason);
    assert_int_equal(report.defects[0].kind, kind);
    assert_int_equal(report.defects[0].id, id);
    assert_int_equal(err.status, reason);
    assert_int_equal(err.id, id);
    assert_true(strlen(err.text) > 10);
    /* After a refusal the soup must still be complete, since a caller may repair it and build
     * again. */
    assert_true(soup.vertex_count > 0 && soup.positions != NULL);
    he_soup_clear(&soup);
}

static void faces_that_share_sides_share_edges_and_the_rest_is_boundary(void **state)
{
    (void)state;
    static const struct {
        const char *faces;
        unsigned v, e, f, boundary;
    } rows[] = {
        {"", 0, 0, 0, 0},
        {"012", 3, 3, 1, 3},
        {"012,023", 4, 5, 2, 4},
        {"0123,7654,1045,2156,3267,0374", 8, 12, 6, 0},
        {"012,034,056", 7, 9, 3, 9},
        {"021,032,013,123", 4, 6, 4, 0},
        {"01234567", 8, 8, 1, 8},
        {"012,210", 3, 3, 2, 0},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        he_mesh *m = fixture_mesh(rows[i].faces);
        fixture_counts(m, rows[i].v, rows[i].e, rows[i].f);
        assert_int_equal(he_mesh_boundary_halfedges(m), rows[i].boundary);
        he_mesh_free(m);
    }
}

static void elements_are_numbered_in_the_order_of_the_faces(void **state)
{
    (void)state;
    he_mesh *m = fixture_mesh("012,023");
    assert_int_equal(he_face_halfedge(m, (he_face){0}).i, 0);
    for (uint32_t i = 0; i < 3; i++) {
        assert_int_equal(he_origin(m, (he_halfedge){2 * i}).i, i);
        assert_int_equal(he_face_of(m, (he_halfedge){2 * i}).i, 0);
    }
    /* The first face has made the edge 0-2 with half-edges 4 and 5, and uses half-edge 4. The
     * second face therefore begins with half-edge 5. */
    assert_int_equal(he_face_halfedge(m, (he_face){1}).i, 5);
    he_mesh_free(m);
}

static void turning_around_a_bowtie_visits_all_its_fans(void **state)
{
    (void)state;
    he_mesh *m = fixture_mesh("012,034,056");
    he_vertex hub = {0};
    assert_int_equal(he_vertex_degree(m, hub), 6);
    assert_int_equal(he_vertex_fans(m, hub), 3);
    assert_true(he_is_boundary_halfedge(m, he_vertex_halfedge(m, hub)));
    he_mesh_free(m);
}

static void a_refusal_names_the_defect_and_leaves_the_soup_complete(void **state)
{
    (void)state;
    expect_refusal("012,01", HE_TOO_FEW_CORNERS, HE_FACE, 1, 1);
    expect_refusal("012,0131", HE_REPEATED_CORNER, HE_FACE, 1, 1);
    expect_refusal("012,103,014", HE_NONMANIFOLD_EDGE, HE_FACE, 2, 1);
    expect_refusal("012,013", HE_ORIENTATION, HE_FACE, 1, 1);
    /* In the first soup two tetrahedra share only vertex 0. In the second soup vertex 0 has a
     * closed and an open fan of faces. */
    expect_refusal("021,032,013,123,054,065,046,456", HE_CLOSED_FAN, HE_VERTEX, 0, 1);
    expect_refusal("021,032,013,123,045", HE_CLOSED_FAN, HE_VERTEX, 0, 1);
}

/* he_build finds defects of single faces first, then those of edges, then those of fans around a
 * vertex; if an edge is faulty, it must not report the fans at the ends of this edge as well. */
static void a_refusal_names_the_defects_of_all_stages(void **state)
{
    (void)state;
    static const struct {
        const char *faces, *defects;
    } rows[] = {
        {"012,103,014,3345", "repeated_corner 3,nonmanifold_edge 2,"},
        {"1,012,103,014,3345", "too_few_corners 0,repeated_corner 4,nonmanifold_edge 3,"},
        {"021,032,013,123,045,678,679,1", "too_few_corners 7,orientation 6,closed_fan 0,"},
        {"021,032,013,123,045,678,679", "orientation 6,closed_fan 0,"},
        {"012,023,013,045", "orientation 2,orientation 2,"},
        {"011,012", "repeated_corner 0,"},
        {"0,1", "too_few_corners 0,too_few_corners 1,"},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        he_soup soup;
        he_report report;
        he_error err = {0};
        he_mesh *mesh = NULL;
        char text[400] = "";
        size_t length = 0;
        uint64_t tried = 0;
        fixture_soup(&soup, rows[i].faces);
        assert_int_not_equal(he_build(&soup, 0, &mesh, &report, &err), HE_OK);
        for (size_t k = 0; k < report.total; k++) {
            length +=
                (size_t)snprintf(text + length, sizeof text - length, "%s %u,",
                                 he_status_slug(report.defects[k].reason), report.defects[k].id);
        }
        assert_string_equal(text, rows[i].defects);
        assert_int_equal(he_build_try(&soup, &tried, &err), HE_OK);
        assert_int_equal(tried, report.total);
        he_soup_clear(&soup);
    }
}

static void a_refusal_names_each_bad_index_and_its_corner(void **state)
{
    (void)state;
    he_soup soup;
    he_mesh *mesh = NULL;
    he_report report;
    he_error err = {0};
    fixture_soup(&soup, "012");
    const uint32_t bad[3] = {0, 1, 7}, worse[3] = {HE_NONE, 1, 2};
    assert_int_equal(he_soup_add_face(&soup, bad, 3, NULL), HE_OK);
    assert_int_equal(he_soup_add_face(&soup, worse, 3, NULL), HE_OK);
    assert_int_equal(he_build(&soup, 0, &mesh, &report, &err), HE_BAD_INDEX);
    assert_int_equal(report.total, 2);
    assert_int_equal(report.defects[0].id, 1);
    assert_int_equal(report.defects[0].corner, 2);
    assert_int_equal(report.defects[0].vertex, 7);
    assert_int_equal(report.defects[1].corner, 0);
    he_soup_clear(&soup);
}

static void a_report_counts_all_defects_and_keeps_the_first_hundred(void **state)
{
    (void)state;
    he_soup soup;
    he_mesh *mesh = NULL;
    he_report report;
    he_error err = {0};
    fixture_soup(&soup, "012");
    for (uint32_t i = 0; i < 250; i++) {
        const uint32_t face[3] = {0, 0, 1};
        assert_int_equal(he_soup_add_face(&soup, face, 3, NULL), HE_OK);
    }
    assert_int_equal(he_build(&soup, 0, &mesh, &report, &err), HE_REPEATED_CORNER);
    assert_int_equal(report.total, 250);
    assert_int_equal(report.defects[99].id, 100);
    he_soup_clear(&soup);
}

static void a_soup_takes_no_more_than_its_limits_and_no_nan(void **state)
{
    (void)state;
    he_soup soup;
    he_error err = {0};
    const uint32_t face[4] = {0, 1, 2, 0};
    he_soup_init(&soup, &(he_limits){.vertices = 3, .faces = 1, .corners = 4});
    for (int i = 0; i < 3; i++) {
        assert_int_equal(he_soup_add_vertex(&soup, (he_vec3){i, 0, 0}, NULL), HE_OK);
    }
    assert_int_equal(he_soup_add_vertex(&soup, (he_vec3){0, 0, 0}, &err), HE_LIMIT);
    assert_int_equal(he_soup_add_vertex(&soup, (he_vec3){0, NAN, 0}, &err), HE_NOT_FINITE);
    assert_int_equal(he_soup_add_face(&soup, face, 4, NULL), HE_OK);
    assert_int_equal(he_soup_add_face(&soup, face, 3, &err), HE_LIMIT);
    assert_int_equal(soup.face_count, 1);
    assert_int_equal(soup.corner_count, 4);
    he_soup_clear(&soup);
    he_soup_init(&soup, &(he_limits){.bytes = 1000});
    he_status status = HE_OK;
    for (int i = 0; i < 100 && status == HE_OK; i++) {
        status = he_soup_add_vertex(&soup, (he_vec3){i, 0, 0}, &err);
    }
    assert_int_equal(status, HE_LIMIT);
    he_soup_clear(&soup);
}

/* he_build looks up all edges of the fan's centre in one list: if that took more than linear time,
 * 400,000 triangles would take minutes. */
static void a_fan_of_400000_triangles_takes_no_quadratic_time(void **state)
{
    (void)state;
    enum { N = 400000 };
    he_soup soup;
    he_mesh *m = NULL;
    he_soup_init(&soup, NULL);
    for (uint32_t i = 0; i <= N; i++) {
        assert_int_equal(he_soup_add_vertex(&soup, (he_vec3){i, 1, 2}, NULL), HE_OK);
    }
    for (uint32_t i = 0; i < N; i++) {
        const uint32_t face[3] = {0, i + 1, (i + 1) % N + 1};
        assert_int_equal(he_soup_add_face(&soup, face, 3, NULL), HE_OK);
    }
    assert_int_equal(he_build(&soup, HE_BUILD_TAKE, &m, NULL, NULL), HE_OK);
    fixture_counts(m, N + 1, 2 * N, N);
    assert_int_equal(he_vertex_degree(m, (he_vertex){0}), N);
    fixture_check(m);
    he_mesh_free(m);
}

/* The mesh is one face with 200,000 corners; in the second round the last corner repeats an earlier
 * one. */
static void a_repeated_corner_is_found_in_a_face_of_200000(void **state)
{
    (void)state;
    enum { N = 200000 };
    for (int repeat = 0; repeat < 2; repeat++) {
        he_soup soup;
        he_mesh *m = NULL;
        he_report report;
        he_soup_init(&soup, NULL);
        assert_int_equal(he_soup_begin_face(&soup, NULL), HE_OK);
        for (uint32_t i = 0; i < N; i++) {
            assert_int_equal(he_soup_add_vertex(&soup, (he_vec3){i, 1, 2}, NULL), HE_OK);
            uint32_t v = repeat && i == N - 1 ? 5 : i;
            assert_int_equal(he_soup_add_corner(&soup, v, NULL), HE_OK);
        }
        he_status status = he_build(&soup, 0, &m, &report, NULL);
        assert_int_equal(status, repeat ? HE_REPEATED_CORNER : HE_OK);
        if (repeat) {
            assert_int_equal(report.defects[0].corner, N - 1);
        } else {
            fixture_counts(m, N, N, 1);
        }
        he_soup_clear(&soup);
        he_mesh_free(m);
    }
}

static uint32_t random_below(uint64_t *seed, uint32_t n)
{
    *seed = *seed * 6364136223846793005u + 1442695040888963407u;
    return (uint32_t)((*seed >> 33) % n);
}

/* Returns whether a half-edge mesh can represent these triangles, decided by the definition alone:
 * every directed edge is used once, and a vertex with a closed fan of faces has no other fan. */
static bool can_hold(uint32_t (*faces)[3], size_t count, uint32_t vertices)
{
    for (size_t i = 0; i < 3 * count; i++) {
        for (size_t k = 0; k < i; k++) {
            if (faces[i / 3][i % 3] == faces[k / 3][k % 3] &&
                faces[i / 3][(i + 1) % 3] == faces[k / 3][(k + 1) % 3]) {
                return false;
            }
        }
    }
    for (uint32_t v = 0; v < vertices; v++) {
        /* follow[a] = b means that a face has the corners v, a, b: around v this face leads from
         * the edge v-a to the edge v-b. */
        uint32_t follow[16], fans = 0, closed = 0;
        bool entered[16] = {false}, seen[16] = {false};
        for (uint32_t i = 0; i < 16; i++) {
            follow[i] = HE_NONE;
        }
        for (size_t i = 0; i < 3 * count; i++) {
            if (faces[i / 3][i % 3] == v) {
                uint32_t b = faces[i / 3][(i + 2) % 3];
                follow[faces[i / 3][(i + 1) % 3]] = b;
                entered[b] = true;
            }
        }
        /* an open fan around v starts at an edge to which no face leads from another edge */
        for (uint32_t i = 0; i < vertices; i++) {
            if (follow[i] != HE_NONE && !entered[i]) {
                fans++;
                for (uint32_t k = i; k != HE_NONE; k = follow[k]) {
                    seen[k] = true;
                }
            }
        }
        for (uint32_t i = 0; i < vertices; i++) {
            if (follow[i] != HE_NONE && !seen[i]) {
                fans++;
                closed++;
                for (uint32_t k = i; !seen[k]; k = follow[k]) {
                    seen[k] = true;
                }
            }
        }
        if (closed > 0 && fans > 1) {
            return false;
        }
    }
    return true;
}

static void random_soups_are_built_exactly_if_a_mesh_can_hold_them(void **state)
{
    (void)state;
    const char *text = getenv("SEED");
    uint64_t seed = text != NULL ? strtoull(text, NULL, 10) : 20261120;
    print_message("seed %llu\n", (unsigned long long)seed);
    size_t held = 0, refused = 0;
    for (int round = 0; round < 60000; round++) {
        uint32_t faces[10][3], vertices = 4 + random_below(&seed, 6);
        size_t count = 1 + random_below(&seed, 10);
        he_soup soup;
        he_mesh *m = NULL;
        he_soup_init(&soup, NULL);
        for (uint32_t v = 0; v < vertices; v++) {
            assert_int_equal(he_soup_add_vertex(&soup, (he_vec3){v, 0, 0}, NULL), HE_OK);
        }
        for (size_t i = 0; i < count; i++) {
            do {
                for (int k = 0; k < 3; k++) {
                    faces[i][k] = random_below(&seed, vertices);
                }
            } while (faces[i][0] == faces[i][1] || faces[i][1] == faces[i][2] ||
                     faces[i][2] == faces[i][0]);
            /* Most faces share an edge with the face before them, so that fans occur and not only
             * separate faces. */
            if (i > 0 && random_below(&seed, 4) != 0) {
                faces[i][0] = faces[i - 1][1];
                faces[i][1] = faces[i - 1][0];
                if (faces[i][2] == faces[i][0] || faces[i][2] == faces[i][1]) {
                    faces[i][2] = faces[i - 1][2];
                }
            }
            assert_int_equal(he_soup_add_face(&soup, faces[i], 3, NULL), HE_OK);
        }
        he_status status = he_build(&soup, 0, &m, NULL, NULL);
        bool expected = can_hold(faces, count, vertices);
        if ((status == HE_OK) != expected) {
            fail_msg("round %d: %s, expected %d", round, he_status_slug(status), expected);
        }
        if (status == HE_OK) {
            fixture_check(m);
            held++;
        } else {
            refused++;
        }
        he_mesh_free(m);
        he_soup_clear(&soup);
    }
    print_message("%zu held, %zu refused\n", held, refused);
    assert_true(held > 1000 && refused > 1000);
}

static void values_of_a_soup_reach_their_corners_and_faces(void **state)
{
    (void)state;
    he_soup soup;
    he_mesh *m = NULL;
    he_column *corner, *face;
    fixture_soup(&soup, "012,023");
    assert_int_equal(
        he_soup_column(&soup, &(he_column_schema){"uv", HE_HALFEDGE, HE_FLOAT, 1, HE_INTERPOLATE},
                       &corner, NULL),
        HE_OK);
    assert_int_equal(he_soup_column(&soup,
                                    &(he_column_schema){"part", HE_FACE, HE_UINT32, 1, HE_COPY},
                                    &face, NULL),
                     HE_OK);
    assert_int_equal(he_soup_column(&soup,
                                    &(he_column_schema){"part", HE_FACE, HE_FLOAT, 1, HE_COPY},
                                    &face, NULL),
                     HE_BAD_VALUE);
    assert_int_equal(he_column_extend(corner, 6, NULL), HE_OK);
    assert_int_equal(he_column_extend(face, 1, NULL), HE_OK);
    for (uint32_t i = 0; i < 6; i++) {
        float value = (float)i;
        memcpy(he_column_row(corner, i), &value, sizeof value);
    }
    memcpy(he_column_row(face, 0), &(uint32_t){9}, 4);
    assert_int_equal(he_build(&soup, 0, &m, NULL, NULL), HE_OK);
    const he_column *built = he_mesh_find_column(m, HE_HALFEDGE, "uv");
    assert_non_null(built);
    for (uint32_t f = 0, i = 0; f < 2; f++) {
        he_halfedge h = he_face_halfedge(m, (he_face){f});
        for (int k = 0; k < 3; k++, i++) {
            float value;
            memcpy(&value, he_column_value(built, h.i), sizeof value);
            assert_true(value == (float)i);
            h = he_next(m, h);
        }
    }
    built = he_mesh_find_column(m, HE_FACE, "part");
    assert_memory_equal(he_column_value(built, 0), &(uint32_t){9}, 4);
    assert_memory_equal(he_column_value(built, 1), &(uint32_t){0}, 4);
    he_mesh_free(m);
    he_soup_clear(&soup);
}

static void a_build_without_memory_is_refused_and_keeps_the_soup(void **state)
{
    (void)state;
    failing f = {0};
    while (failing_next(&f)) {
        failing_pause();
        he_soup soup;
        he_mesh *m = NULL;
        he_error err = {0};
        fixture_soup(&soup, "012,034,056");
        he_column *column;
        assert_int_equal(
            he_soup_column(&soup, &(he_column_schema){"uv", HE_HALFEDGE, HE_FLOAT, 2, HE_COPY},
                           &column, NULL),
            HE_OK);
        failing_resume();
        he_status status = he_build(&soup, f.n % 2 ? HE_BUILD_TAKE : 0, &m, NULL, &err);
        if (failing_status(&f, status)) {
            fixture_check(m);
            he_mesh_free(m);
        } else {
            assert_int_equal(err.status, HE_NO_MEMORY);
            assert_int_equal(soup.vertex_count, 7);
        }
        he_soup_clear(&soup);
    }
    print_message("build: %ld allocations failed in turn\n", f.n - 1);
    assert_true(f.n > 9);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(faces_that_share_sides_share_edges_and_the_rest_is_boundary),
        cmocka_unit_test(elements_are_numbered_in_the_order_of_the_faces),
        cmocka_unit_test(turning_around_a_bowtie_visits_all_its_fans),
        cmocka_unit_test(a_refusal_names_the_defect_and_leaves_the_soup_complete),
        cmocka_unit_test(a_refusal_names_the_defects_of_all_stages),
        cmocka_unit_test(a_refusal_names_each_bad_index_and_its_corner),
        cmocka_unit_test(a_report_counts_all_defects_and_keeps_the_first_hundred),
        cmocka_unit_test(a_soup_takes_no_more_than_its_limits_and_no_nan),
        cmocka_unit_test(a_fan_of_400000_triangles_takes_no_quadratic_time),
        cmocka_unit_test(a_repeated_corner_is_found_in_a_face_of_200000),
        cmocka_unit_test(random_soups_are_built_exactly_if_a_mesh_can_hold_them),
        cmocka_unit_test(values_of_a_soup_reach_their_corners_and_faces),
        cmocka_unit_test(a_build_without_memory_is_refused_and_keeps_the_soup),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
