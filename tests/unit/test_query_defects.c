/* Tests of the search for defects in meshes whose links are valid. The meshes are small with known
 * defects, or the results are compared with a check of all pairs of elements. */
#include "query_specimens.h"

#include "geometry/geometry.h"
#include "query/defects.h"
#include "query/topology.h"
#include "tests/failing.h"

#include <float.h>
#include <limits.h>
#include <math.h>

static he_defects found;

static void find(const he_mesh *m, he_thresholds t)
{
    assert_int_equal(he_defects_find(m, &t, NULL, &found, NULL), HE_OK);
}

static he_mesh *mesh_at(const char *faces, const he_vec3 *positions)
{
    he_mesh *m = fixture_mesh(faces);
    memcpy(m->c.position, positions, m->c.vertices.issued * sizeof *positions);
    return m;
}

/* Requires that this many defects of each code were found; `totals` is indexed by the code. */
static void expect_totals(const uint64_t totals[HE_DEFECTS])
{
    for (he_defect_code code = 0; code < HE_DEFECTS; code++) {
        if (found.of[code].total != totals[code]) {
            fail_msg("%llu of %s, not %llu", (unsigned long long)found.of[code].total,
                     he_defect_name(code), (unsigned long long)totals[code]);
        }
    }
}

static const he_defect_found *first(he_defect_code code)
{
    assert_true(found.of[code].count > 0);
    return &found.of[code].listed[0];
}

static void shapes_have_no_defects(void **state)
{
    (void)state;
    static const struct {
        const char *name;
        double args[4];
    } rows[] = {{"cube", {1}},
                {"icosphere", {3, 1}},
                {"dodecahedron", {1}},
                {"grid", {20, 20, 1, 1}},
                {"uv_sphere", {12, 7, 1}},
                {"torus", {16, 8, 2, 0.5}},
                {"cylinder", {12, 1, 2, 0}}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        const double *a = rows[i].args;
        he_mesh *m = query_shape(rows[i].name, a[0], a[1], a[2], a[3]);
        find(m, he_thresholds_of(m));
        expect_totals((uint64_t[HE_DEFECTS]){0});
        he_mesh_free(m);
    }
}

static void an_empty_mesh_has_no_defects(void **state)
{
    (void)state;
    he_mesh *m = he_mesh_new();
    find(m, he_thresholds_of(m));
    expect_totals((uint64_t[HE_DEFECTS]){0});
    he_mesh_free(m);
}

static void bowties_and_isolated_vertices_are_named(void **state)
{
    (void)state;
    const he_vec3 at[] = {{0, 0, 0},   {1, 0, 0}, {1, 1, 0}, {-1, 0, 0},
                          {-1, -1, 0}, {0, 0, 1}, {0, 1, 1}};
    he_mesh *m = mesh_at("012,034,056", at);
    find(m, (he_thresholds){0, 1, 0, 0});
    assert_int_equal(found.of[HE_DEFECT_BOWTIE].total, 1);
    assert_int_equal(first(HE_DEFECT_BOWTIE)->id, 0);
    assert_true(first(HE_DEFECT_BOWTIE)->value == 3);
    he_mesh_free(m);
    m = query_with_dead_rows(); /* vertex 3 is isolated; vertices 4 and higher are deleted */
    find(m, (he_thresholds){0, 1, 0, 0});
    assert_int_equal(found.of[HE_DEFECT_ISOLATED].total, 1);
    assert_int_equal(first(HE_DEFECT_ISOLATED)->id, 3);
    he_mesh_free(m);
}

static void edges_no_longer_than_merge_are_named(void **state)
{
    (void)state;
    const he_vec3 at[] = {{0, 0, 0}, {1, 0, 0}, {1, 0.001, 0}, {0, 1, 0}};
    he_mesh *m = mesh_at("0123", at);
    find(m, (he_thresholds){0, 1, 0, 0});
    expect_totals((uint64_t[HE_DEFECTS]){0});
    find(m, (he_thresholds){0.001, 1, 0, 0});
    assert_int_equal(found.of[HE_DEFECT_SHORT].total, 1);
    assert_int_equal(first(HE_DEFECT_SHORT)->id, 1);
    assert_true(first(HE_DEFECT_SHORT)->value == 0.001);
    assert_int_equal(found.of[HE_DEFECT_DUPLICATE].total, 1);
    assert_int_equal(first(HE_DEFECT_DUPLICATE)->id, 2);
    assert_int_equal(first(HE_DEFECT_DUPLICATE)->other, 1);
    assert_true(first(HE_DEFECT_DUPLICATE)->value == 0.001);
    he_mesh_free(m);
}

static void faces_without_area_or_width_are_named(void **state)
{
    (void)state;
    const he_vec3 at[] = {{0, 0, 0}, {2, 0, 0}, {4, 0, 0}, {1, 0.001, 0}, {2, -5, 1}};
    he_mesh *m = mesh_at("012,023,104", at); /* the first face has no area, the second is thin */
    find(m, (he_thresholds){0, 1, 0, 0});
    assert_int_equal(found.of[HE_DEFECT_DEGENERATE].total, 1);
    assert_int_equal(first(HE_DEFECT_DEGENERATE)->id, 0);
    assert_true(first(HE_DEFECT_DEGENERATE)->value == 0);
    find(m, (he_thresholds){0.00101, 1, 0, 0});
    assert_int_equal(found.of[HE_DEFECT_DEGENERATE].total, 2);
    assert_int_equal(found.of[HE_DEFECT_DEGENERATE].listed[1].id, 1);
    assert_true(fabs(found.of[HE_DEFECT_DEGENERATE].listed[1].value - 0.001) < 1e-12);
    he_mesh_free(m);
}

static void faces_that_are_not_flat_are_named(void **state)
{
    (void)state;
    const he_vec3 at[] = {{0, 0, 0}, {1, 0, 0.1}, {1, 1, 0}, {0, 1, 0.1}};
    he_mesh *m = mesh_at("0123", at);
    find(m, (he_thresholds){0, 0.0501, 0, 0});
    assert_int_equal(found.of[HE_DEFECT_NONPLANAR].total, 0);
    find(m, (he_thresholds){0, 0.0499, 0, 0});
    assert_int_equal(found.of[HE_DEFECT_NONPLANAR].total, 1);
    assert_int_equal(first(HE_DEFECT_NONPLANAR)->id, 0);
    assert_true(fabs(first(HE_DEFECT_NONPLANAR)->value - 0.05) < 1e-12);
    /* Faces of equal shape must all be judged flat or all not flat, however large or small they
     * are. */
    for (int k = -1000; k <= 1000; k += 100) {
        for (uint32_t v = 0; v < 4; v++) {
            m->c.position[v] = (he_vec3){ldexp(at[v].x, k), ldexp(at[v].y, k), ldexp(at[v].z, k)};
        }
        find(m, he_thresholds_of(m));
        assert_int_equal(found.of[HE_DEFECT_NONPLANAR].total, 1);
        assert_true(fabs(ldexp(first(HE_DEFECT_NONPLANAR)->value, -k) - 0.05) < 1e-12);
        assert_int_equal(found.of[HE_DEFECT_DEGENERATE].total, 0);
    }
    he_mesh_free(m);
}

/* --- components --- */

static void small_components_are_named_by_their_lowest_face(void **state)
{
    (void)state;
    const he_vec3 at[] = {{0, 0, 0}, {9, 0, 0},    {9, 9, 0},    {0, 9, 0},
                          {5, 5, 1}, {5.01, 5, 1}, {5, 5.01, 1}, {5.02, 5.02, 1}};
    he_mesh *m = mesh_at("0123,456,657", at);
    he_thresholds t = he_thresholds_of(m);
    find(m, t);
    assert_int_equal(found.of[HE_DEFECT_SMALL].total, 1);
    assert_int_equal(first(HE_DEFECT_SMALL)->id, 1);
    assert_true(fabs(first(HE_DEFECT_SMALL)->value - 0.02 * sqrt(2)) < 1e-12);
    t.small = 0.028;
    find(m, t);
    assert_int_equal(found.of[HE_DEFECT_SMALL].total, 0);
    he_mesh_free(m);
}

/* The mesh consists of two tetrahedra, one inside the other: the faces of the outer tetrahedron
 * point outward, those of the inner one point inward. */
static const he_vec3 nested[] = {{0, 0, 0}, {8, 0, 0}, {0, 8, 0}, {0, 0, 8},
                                 {1, 1, 1}, {2, 1, 1}, {1, 2, 1}, {1, 1, 2}};

static void closed_components_of_negative_volume_are_inside_out(void **state)
{
    (void)state;
    he_mesh *m = mesh_at("021,013,032,123,465,457,476,567", nested);
    find(m, he_thresholds_of(m));
    assert_int_equal(found.of[HE_DEFECT_INSIDE_OUT].total, 0);
    he_mesh_free(m);
    /* The inner tetrahedron is the wall of a cavity, so its faces point the right way. The query
     * cannot know this and must list the inner tetrahedron as inside out. */
    m = mesh_at("021,013,032,123,456,475,467,576", nested);
    find(m, he_thresholds_of(m));
    assert_int_equal(found.of[HE_DEFECT_INSIDE_OUT].total, 1);
    assert_int_equal(first(HE_DEFECT_INSIDE_OUT)->id, 4);
    assert_true(fabs(first(HE_DEFECT_INSIDE_OUT)->value + 1.0 / 6) < 1e-12);
    he_mesh_free(m);
    /* The outer tetrahedron lacks the face 123, so it is not closed and must not be listed as
     * inside out. */
    m = mesh_at("012,031,023", nested);
    find(m, he_thresholds_of(m));
    assert_int_equal(found.of[HE_DEFECT_INSIDE_OUT].total, 0);
    he_mesh_free(m);
}

static void a_flat_closed_component_has_neither_side(void **state)
{
    (void)state;
    he_vec3 at[] = {{0.1, 0.2, 0}, {1.3, 0.7, 0}, {0.9, 1.7, 0}, {-0.3, 1.2, 0}};
    for (int v = 0; v < 4; v++) {
        at[v].z = 0.3 * at[v].x + 0.7 * at[v].y;
    }
    he_mesh *m = mesh_at("0123,3210", at);
    find(m, he_thresholds_of(m));
    assert_int_equal(found.of[HE_DEFECT_INSIDE_OUT].total, 0);
    he_mesh_free(m);
}

static void labels_of_components_are_those_of_the_list(void **state)
{
    (void)state;
    for (size_t i = 0; i < QUERY_SPECIMENS; i++) {
        he_mesh *m = fixture_mesh(query_specimens[i]);
        he_components list = {0};
        uint32_t *labels = NULL, count;
        assert_int_equal(he_components_find(m, HE_JOINED_BY_EDGE, &list, NULL), HE_OK);
        assert_int_equal(he_components_label(m, &labels, &count, NULL), HE_OK);
        assert_int_equal(count, list.count);
        for (uint32_t c = 0; c < count; c++) {
            uint32_t faces = 0;
            for (uint32_t f = 0; f < m->c.faces.issued; f++) {
                faces += labels[f] == c;
            }
            assert_int_equal(faces, list.components[c].faces);
            assert_int_equal(labels[list.components[c].face], c);
        }
        he_mem_free(labels);
        he_components_clear(&list);
        he_mesh_free(m);
    }
}

/* --- positions --- */

/* Counts the vertices that must be listed as duplicates: each vertex that is within `merge` of an
 * earlier vertex that is not listed itself. */
static uint64_t search_all(const he_mesh *m, double merge, bool *listed)
{
    uint64_t total = 0;
    for (uint32_t v = 0; v < m->c.vertices.issued; v++) {
        listed[v] = false;
        for (uint32_t u = 0; u < v && !listed[v]; u++) {
            he_vec3 d = he_vec3_sub(m->c.position[u], m->c.position[v]);
            listed[v] = !listed[u] && hypot(hypot(d.x, d.y), d.z) <= merge;
        }
        total += listed[v];
    }
    return total;
}

static void duplicates_are_those_that_trying_all_finds(void **state)
{
    (void)state;
    uint64_t seed = 7, met = 0;
    for (int round = 0; round < 200; round++) {
        he_mesh *m = query_shape("grid", 9, 9, 1, 1);
        bool listed[100];
        double far = round % 3 == 0 ? 0 : ldexp(1, (int)(query_random(&seed) % 60));
        double merge = ldexp((double)(query_random(&seed) % 64), -8);
        for (uint32_t v = 0; v < 100; v++) {
            double *x = &m->c.position[v].x;
            for (int k = 0; k < 3; k++) {
                /* The coordinates are on a lattice, so that distances are often exactly the limit,
                 * and zeros of both signs occur. */
                x[k] = ldexp((double)(query_random(&seed) % 256) - 128, -8) + far;
                x[k] = round % 2 == 0 ? x[k] : floor(x[k] * 4) / 4 * -1;
            }
        }
        if (round % 4 == 0) {
            merge = 0;
        }
        uint64_t total = search_all(m, merge, listed);
        find(m, (he_thresholds){merge, DBL_MAX, 0, query_random(&seed)});
        const he_defect_list *list = &found.of[HE_DEFECT_DUPLICATE];
        assert_int_equal(list->total, total);
        for (uint32_t i = 0; i < list->count; i++) {
            assert_true(listed[list->listed[i].id] && !listed[list->listed[i].other]);
            assert_true(list->listed[i].other < list->listed[i].id);
            assert_true(list->listed[i].value <= merge);
        }
        met += total;
        he_mesh_free(m);
    }
    assert_true(met > 1000);
}

static void the_first_are_listed_and_all_are_counted(void **state)
{
    (void)state;
    he_mesh *m = query_shape("grid", 39, 39, 1, 1);
    memset(m->c.position, 0, m->c.vertices.issued * sizeof *m->c.position);
    find(m, he_thresholds_of(m));
    expect_totals((uint64_t[HE_DEFECTS]){[HE_DEFECT_DUPLICATE] = 1599,
                                         [HE_DEFECT_SHORT] = 2 * 39 * 40,
                                         [HE_DEFECT_DEGENERATE] = 39 * 39,
                                         [HE_DEFECT_SMALL] = 1});
    for (uint32_t i = 0; i < HE_DEFECTS_LISTED; i++) {
        assert_int_equal(found.of[HE_DEFECT_DEGENERATE].listed[i].id, i);
        assert_int_equal(found.of[HE_DEFECT_DUPLICATE].listed[i].id, i + 1);
        assert_int_equal(found.of[HE_DEFECT_DUPLICATE].listed[i].other, 0);
    }
    he_mesh_free(m);
}

static void hostile_coordinates_give_finite_values(void **state)
{
    (void)state;
    static const double odd[] = {0,      1,     -1,    DBL_MAX, -DBL_MAX, DBL_MIN,
                                 5e-324, 1e-77, 1e154, -1e308,  1e-160,   -0.0};
    uint64_t seed = 23;
    for (int round = 0; round < 4000; round++) {
        he_mesh *m = fixture_mesh(query_specimens[query_random(&seed) % QUERY_SPECIMENS]);
        uint64_t kinds = 1 + query_random(&seed) % 12;
        for (uint32_t v = 0; v < he_mesh_vertices(m); v++) {
            for (int k = 0; k < 3; k++) {
                (&m->c.position[v].x)[k] = odd[query_random(&seed) % kinds];
            }
        }
        he_thresholds t = he_thresholds_of(m);
        if (round % 2 == 0) {
            t = (he_thresholds){fabs(odd[query_random(&seed) % 12]),
                                fabs(odd[query_random(&seed) % 12]),
                                fabs(odd[query_random(&seed) % 12]), 0};
        }
        assert_true(isfinite(t.merge) && isfinite(t.flat) && isfinite(t.small));
        find(m, t);
        for (he_defect_code code = 0; code < HE_DEFECTS; code++) {
            for (uint32_t i = 0; i < found.of[code].count; i++) {
                assert_true(isfinite(found.of[code].listed[i].value));
            }
        }
        he_mesh_free(m);
    }
}

/* --- cancelling --- */

typedef struct patience {
    long calls, most;
    double done;
} patience;

static bool tell(void *context, const char *phase, double done)
{
    patience *p = context;
    assert_true(phase[0] != '\0' && done >= p->done && done <= 1);
    p->done = done;
    return p->calls++ < p->most;
}

static void a_search_can_be_given_up(void **state)
{
    (void)state;
    he_mesh *m = query_shape("torus", 120, 100, 2, 0.5);
    he_thresholds t = he_thresholds_of(m);
    long calls = 0;
    for (long most = 0; most <= calls; most++) {
        patience p = {.most = most == 0 ? LONG_MAX : most - 1};
        he_progress progress;
        he_progress_init(&progress, tell, &p);
        he_status status = he_defects_find(m, &t, &progress, &found, NULL);
        assert_int_equal(status, most == 0 ? HE_OK : HE_CANCELLED);
        calls = most == 0 ? p.calls : calls;
    }
    assert_true(calls > 10);
    he_mesh_free(m);
}

static void a_starved_search_says_so(void **state)
{
    (void)state;
    he_mesh *m = mesh_at("021,013,032,123,456,475,467,576", nested);
    he_thresholds t = he_thresholds_of(m);
    memset(&found, 0x55, sizeof found);
    failing f = {0};
    while (failing_next(&f)) {
        he_defects before = found;
        if (!failing_status(&f, he_defects_find(m, &t, NULL, &found, NULL))) {
            assert_memory_equal(&before, &found, sizeof found);
        }
    }
    assert_int_equal(found.of[HE_DEFECT_INSIDE_OUT].total, 1);
    he_mesh_free(m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(shapes_have_no_defects),
        cmocka_unit_test(an_empty_mesh_has_no_defects),
        cmocka_unit_test(bowties_and_isolated_vertices_are_named),
        cmocka_unit_test(edges_no_longer_than_merge_are_named),
        cmocka_unit_test(faces_without_area_or_width_are_named),
        cmocka_unit_test(faces_that_are_not_flat_are_named),
        cmocka_unit_test(small_components_are_named_by_their_lowest_face),
        cmocka_unit_test(closed_components_of_negative_volume_are_inside_out),
        cmocka_unit_test(a_flat_closed_component_has_neither_side),
        cmocka_unit_test(labels_of_components_are_those_of_the_list),
        cmocka_unit_test(duplicates_are_those_that_trying_all_finds),
        cmocka_unit_test(the_first_are_listed_and_all_are_counted),
        cmocka_unit_test(hostile_coordinates_give_finite_values),
        cmocka_unit_test(a_search_can_be_given_up),
        cmocka_unit_test(a_starved_search_says_so),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
