/* Tests of parallel work: each part of the work must run exactly once, on any of the threads, and
 * the result must not depend on the number of threads. */
#include "tests/unit/fixture.h"

#include "algo/decimate.h"
#include "algo/subdivide.h"
#include "base/parallel.h"
#include "geometry/geometry.h"
#include "mesh/walk.h"
#include "system/parallel.h"
#include "tests/failing.h"
#include "tests/sanitized.h"

#include <math.h>
#include <pthread.h>
#include <stdatomic.h>

static const size_t hand_counts[] = {0, 1, 7};
enum { HAND_COUNTS = 3 };

/* --- parts --- */

enum { PARTS = 500, OWNERS = 4, ROUNDS = 20 };

typedef struct tally {
    _Atomic uint32_t runs[PARTS];
    /* NULL, or a pool on which each part of the work runs further parts */
    const he_parallel *parallel;
    uint32_t failing; /* parts of the work fail if their index is this number or higher */
} tally;

static he_status count_part(void *context, uint32_t part, he_error *err)
{
    tally *t = context;
    atomic_fetch_add(&t->runs[part], 1);
    return part < t->failing ? HE_OK
                             : he_fail_plain(err, HE_NO_MEMORY, "part %u of the work", part);
}

static he_status cut_again(void *context, uint32_t part, he_error *err)
{
    tally *t = context;
    (void)part;
    return t->parallel->run(t->parallel->self, PARTS, count_part, t, NULL, err);
}

static bool ran_each(const tally *t, uint32_t times)
{
    for (size_t i = 0; i < PARTS; i++) {
        if (atomic_load(&t->runs[i]) != times) {
            return false;
        }
    }
    return true;
}

static void *own_work(void *context)
{
    const he_parallel *parallel = context;
    for (int round = 0; round < ROUNDS; round++) {
        tally t = {.parallel = parallel, .failing = PARTS};
        if (parallel->run(parallel->self, 8, cut_again, &t, NULL, NULL) != HE_OK ||
            !ran_each(&t, 8)) {
            return context;
        }
    }
    return NULL;
}

static void each_part_is_run_once_whoever_else_has_work(void **state)
{
    (void)state;
    for (size_t i = 0; i < HAND_COUNTS; i++) {
        pthread_t owners[OWNERS];
        st_parallel *hands = st_parallel_new(hand_counts[i]);
        const he_parallel *parallel = st_parallel_host(hands);
        assert_int_equal(parallel->threads, hand_counts[i] + 1);
        for (size_t k = 0; k < OWNERS; k++) {
            assert_int_equal(
                pthread_create(&owners[k], NULL, own_work, (void *)(uintptr_t)parallel), 0);
        }
        for (size_t k = 0; k < OWNERS; k++) {
            void *failed;
            pthread_join(owners[k], &failed);
            assert_null(failed);
        }
        st_parallel_free(hands);
    }
}

static void of_parts_that_fail_the_first_one_is_told(void **state)
{
    (void)state;
    for (size_t i = 0; i < HAND_COUNTS; i++) {
        st_parallel *hands = st_parallel_new(hand_counts[i]);
        const he_parallel *parallel = st_parallel_host(hands);
        for (uint32_t unlucky = 0; unlucky < PARTS; unlucky += 7) {
            tally t = {.failing = unlucky};
            he_error err = {0};
            char text[64];
            assert_int_equal(parallel->run(parallel->self, PARTS, count_part, &t, NULL, &err),
                             HE_NO_MEMORY);
            snprintf(text, sizeof text, "part %u of the work", unlucky);
            assert_string_equal(err.text, text);
            assert_int_equal(atomic_load(&t.runs[unlucky]), 1);
            uint32_t runs = 0;
            for (uint32_t part = unlucky; part < PARTS; part++) {
                runs += atomic_load(&t.runs[part]);
            }
            assert_true(runs <= hand_counts[i] + 1);
        }
        st_parallel_free(hands);
    }
}

/* --- cancelling work that runs in parallel --- */

typedef struct listener {
    pthread_t owner;
    long told, give_up_at;
    bool elsewhere;
} listener;

static bool hear(void *context, const char *phase, double done)
{
    listener *l = context;
    (void)phase, (void)done;
    l->elsewhere |= !pthread_equal(l->owner, pthread_self());
    return ++l->told != l->give_up_at;
}

static void work_is_given_up_between_parts_on_its_own_thread(void **state)
{
    (void)state;
    for (size_t i = 0; i < HAND_COUNTS; i++) {
        st_parallel *hands = st_parallel_new(hand_counts[i]);
        const he_parallel *parallel = st_parallel_host(hands);
        tally t = {.failing = PARTS};
        listener l = {.owner = pthread_self(), .give_up_at = 1};
        he_progress progress;
        he_error err = {0};
        he_progress_init(&progress, hear, &l);
        assert_int_equal(parallel->run(parallel->self, PARTS, count_part, &t, &progress, &err),
                         HE_CANCELLED);
        assert_int_equal(err.status, HE_CANCELLED);
        assert_false(l.elsewhere);
        st_parallel_free(hands);
    }
}

/* --- parallel algorithms of core --- */

/* SIDE makes the meshes of the tests so large that they are divided into several parts of work,
 * vertices as well as faces. If `shuffled` is set, vertices and faces are in random order. */
enum { SIDE = SANITIZED ? 150 : 220 };
_Static_assert(HE_PART_ROWS < SIDE * SIDE, "the vertices are one part");

static uint32_t scatter(uint32_t i, uint32_t count, bool shuffled)
{
    /* `count` is never a multiple of the prime 7919 in this test, so different values of i give
     * different results. */
    return shuffled ? (uint32_t)((uint64_t)i * 7919u % count) : i;
}

static void add_torus(he_soup *soup, bool shuffled)
{
    const uint32_t count = SIDE * SIDE;
    for (uint32_t v = 0; v < count; v++) {
        assert_int_equal(he_soup_add_vertex(soup, (he_vec3){v, v % SIDE, v % 7}, NULL), HE_OK);
    }
    for (uint32_t n = 0; n < 2 * count; n++) {
        uint32_t f = scatter(n, 2 * count, shuffled), q = f / 2, i = q / SIDE, j = q % SIDE;
        uint32_t down = (i + 1) % SIDE * SIDE, right = (j + 1) % SIDE;
        const uint32_t low[3] = {q, down + j, down + right},
                       high[3] = {q, down + right, i * SIDE + right};
        uint32_t corners[3];
        for (size_t k = 0; k < 3; k++) {
            corners[k] = scatter(f % 2 == 0 ? low[k] : high[k], count, shuffled);
        }
        assert_int_equal(he_soup_add_face(soup, corners, 3, NULL), HE_OK);
    }
}

/* Adds quads and pentagons with holes between them, and a fan of triangles around one vertex. */
static void add_mixed(he_soup *soup)
{
    for (uint32_t v = 0; v < (SIDE + 1) * (SIDE + 1) + 2 * SIDE * SIDE; v++) {
        assert_int_equal(he_soup_add_vertex(soup, (he_vec3){v % 31, v % 17, v}, NULL), HE_OK);
    }
    const uint32_t row = SIDE + 1, hub = row * row;
    for (uint32_t q = 0; q < SIDE * SIDE; q++) {
        uint32_t a = q / SIDE * row + q % SIDE;
        const uint32_t corners[4] = {a, a + 1, a + row + 1, a + row};
        if (q % 11 != 3) {
            assert_int_equal(he_soup_add_face(soup, corners, q % 11 == 5 ? 3 : 4, NULL), HE_OK);
        }
    }
    for (uint32_t i = 1; i < SIDE * SIDE; i++) {
        const uint32_t corners[3] = {hub, hub + i, hub + i + 1};
        assert_int_equal(he_soup_add_face(soup, corners, 3, NULL), HE_OK);
    }
}

static void make_soup(int which, he_soup *soup)
{
    he_soup_init(soup, NULL);
    if (which < 2) {
        add_torus(soup, which == 1);
    } else {
        add_mixed(soup);
    }
}

static he_mesh *build_with(he_soup *soup, const he_parallel *parallel)
{
    he_mesh *mesh = NULL;
    he_progress progress;
    he_progress_init(&progress, NULL, NULL);
    progress.parallel = parallel;
    soup->limits.progress = &progress;
    assert_int_equal(he_build(soup, 0, &mesh, NULL, NULL), HE_OK);
    soup->limits.progress = NULL;
    return mesh;
}

static void a_mesh_is_the_same_in_every_bit_on_1_2_and_8_threads(void **state)
{
    (void)state;
    for (int which = 0; which < 3; which++) {
        he_soup soup;
        make_soup(which, &soup);
        he_mesh *alone = build_with(&soup, NULL);
        for (size_t i = 0; i < HAND_COUNTS; i++) {
            st_parallel *hands = st_parallel_new(hand_counts[i]);
            he_mesh *mesh = build_with(&soup, st_parallel_host(hands));
            assert_true(he_mesh_equal(alone, mesh));
            he_mesh_free(mesh);
            st_parallel_free(hands);
        }
        he_mesh_free(alone);
        he_soup_clear(&soup);
    }
}

/* Returns an array with the normals of all faces, followed by the normals of all corners. The
 * caller must free the array. */
static he_vec3 *normals_of(const he_mesh *mesh, he_progress *progress)
{
    size_t faces = he_mesh_issued(mesh, HE_FACE),
           corners = 2 * (size_t)he_mesh_issued(mesh, HE_EDGE);
    he_vec3 *normals = malloc((faces + corners) * sizeof *normals);
    assert_non_null(normals);
    assert_int_equal(he_face_normals(mesh, progress, normals, NULL), HE_OK);
    assert_int_equal(he_corner_normals(mesh, 0.5, progress, normals + faces, NULL), HE_OK);
    return normals;
}

enum { SCHEMES = HE_SQRT3 - HE_LOOP + 1 };

/* The result of an operation on the whole mesh, or its error, since the scheme `loop` and
 * decimation refuse faces that are not triangles. */
typedef struct outcome {
    he_mesh *mesh;
    he_status status;
    he_error error;
} outcome;

/* Decimates a copy of the mesh to a third of its faces. */
static outcome decimate(const he_mesh *mesh, he_progress *progress)
{
    outcome s = {.mesh = NULL};
    const he_decimate_options options = {he_mesh_faces(mesh) / 3, INFINITY, HE_BOUNDARY_WEIGHT};
    assert_int_equal(he_mesh_copy(mesh, &s.mesh, NULL), HE_OK);
    he_mesh_set_progress(s.mesh, progress);
    s.status = he_decimate(s.mesh, &options, NULL, &s.error);
    he_mesh_set_progress(s.mesh, NULL);
    return s;
}

static outcome subdivide(const he_mesh *mesh, int scheme, he_progress *progress)
{
    outcome s = {.mesh = NULL};
    assert_int_equal(he_mesh_copy(mesh, &s.mesh, NULL), HE_OK);
    he_mesh_set_progress(s.mesh, progress);
    s.status = he_subdivide(s.mesh, (he_scheme)(HE_LOOP + scheme), 1, NULL, &s.error);
    he_mesh_set_progress(s.mesh, NULL);
    return s;
}

static void expect_same_outcome(const outcome *alone, const outcome *helped)
{
    assert_int_equal(alone->status, helped->status);
    assert_int_equal(alone->error.id, helped->error.id);
    assert_string_equal(alone->error.text, helped->error.text);
    assert_true(he_mesh_equal(alone->mesh, helped->mesh));
}

/* What is computed from one mesh without threads. */
typedef struct expected {
    he_mesh *mesh;
    he_vec3 *normals; /* as normals_of() returns them */
    outcome subdivisions[SCHEMES], decimation;
} expected;

static expected compute_alone(he_soup *soup)
{
    expected alone = {.mesh = build_with(soup, NULL)};
    alone.normals = normals_of(alone.mesh, NULL);
    for (int scheme = 0; scheme < SCHEMES; scheme++) {
        alone.subdivisions[scheme] = subdivide(alone.mesh, scheme, NULL);
    }
    alone.decimation = decimate(alone.mesh, NULL);
    return alone;
}

static void clear(expected *alone)
{
    for (int scheme = 0; scheme < SCHEMES; scheme++) {
        he_mesh_free(alone->subdivisions[scheme].mesh);
    }
    he_mesh_free(alone->decimation.mesh);
    free(alone->normals);
    he_mesh_free(alone->mesh);
}

static void expect_same_results(const expected *alone, const he_parallel *parallel)
{
    const he_mesh *mesh = alone->mesh;
    size_t count = he_mesh_issued(mesh, HE_FACE) + 2 * (size_t)he_mesh_issued(mesh, HE_EDGE);
    he_progress progress;
    he_progress_init(&progress, NULL, NULL);
    progress.parallel = parallel;
    he_vec3 *helped = normals_of(mesh, &progress);
    assert_memory_equal(alone->normals, helped, count * sizeof *helped);
    free(helped);
    for (int scheme = 0; scheme < SCHEMES; scheme++) {
        outcome by_hands = subdivide(mesh, scheme, &progress);
        expect_same_outcome(&alone->subdivisions[scheme], &by_hands);
        he_mesh_free(by_hands.mesh);
    }
    outcome by_hands = decimate(mesh, &progress);
    expect_same_outcome(&alone->decimation, &by_hands);
    he_mesh_free(by_hands.mesh);
}

static void whole_operations_are_the_same_on_1_2_and_8_threads(void **state)
{
    (void)state;
    for (int which = 0; which < 3; which++) {
        he_soup soup;
        make_soup(which, &soup);
        expected alone = compute_alone(&soup);
        for (size_t i = 0; i < HAND_COUNTS; i++) {
            st_parallel *hands = st_parallel_new(hand_counts[i]);
            expect_same_results(&alone, st_parallel_host(hands));
            st_parallel_free(hands);
        }
        clear(&alone);
        he_soup_clear(&soup);
    }
}

/* The member `run` of he_parallel for a host whose threads are all slow except the one with the
 * last part: each part begins before an earlier part ends, so no part is skipped because an earlier
 * one failed. On one thread, this is done by running the parts from the last to the first. */
static he_status run_backwards(void *self, uint32_t parts, he_part part, void *context,
                               he_progress *progress, he_error *err)
{
    he_status status = HE_OK;
    (void)self, (void)progress;
    for (uint32_t i = parts; i-- > 0;) {
        he_error failure = {0};
        he_status ended = part(context, i, &failure);
        if (ended != HE_OK) {
            status = ended;
            if (err != NULL) {
                *err = failure;
            }
        }
    }
    return status;
}

/* The kernel must not rely on a part being skipped because an earlier part fails: the other part
 * may have begun already. So a part must be safe whatever the other parts find. For example, the
 * scheme loop refuses a mesh with a quad although other parts contain only triangles. */
static void parts_may_end_in_any_order_even_if_one_fails(void **state)
{
    (void)state;
    static const he_parallel backwards = {run_backwards, NULL, 8};
    for (int which = 0; which < 3; which++) {
        he_soup soup;
        make_soup(which, &soup);
        expected alone = compute_alone(&soup);
        he_mesh *mesh = build_with(&soup, &backwards);
        assert_true(he_mesh_equal(alone.mesh, mesh));
        expect_same_results(&alone, &backwards);
        he_mesh_free(mesh);
        clear(&alone);
        he_soup_clear(&soup);
    }
}

static void defects_are_the_same_on_1_2_and_8_threads(void **state)
{
    (void)state;
    /* Three faces, each of which adds a defect to the mesh: the first two have edges that two other
     * faces use already, and the third gives a vertex a second fan of faces. */
    static const uint32_t extra[3][3] = {{0, 1, 5000}, {0, SIDE, SIDE + 1}, {9, 10, 11}};
    for (int which = 0; which < 3; which++) {
        static he_report alone, report;
        he_error first = {0}, err = {0};
        he_soup soup;
        he_mesh *mesh = NULL;
        make_soup(0, &soup);
        assert_int_equal(he_soup_add_face(&soup, extra[which], 3, NULL), HE_OK);
        he_status status = he_build(&soup, 0, &mesh, &alone, &first);
        assert_true(status != HE_OK);
        for (size_t i = 0; i < HAND_COUNTS; i++) {
            st_parallel *hands = st_parallel_new(hand_counts[i]);
            he_progress progress;
            he_progress_init(&progress, NULL, NULL);
            progress.parallel = st_parallel_host(hands);
            soup.limits.progress = &progress;
            assert_int_equal(he_build(&soup, 0, &mesh, &report, &err), status);
            assert_int_equal(report.total, alone.total);
            assert_memory_equal(
                report.defects, alone.defects,
                (report.total < HE_REPORT_DEFECTS ? report.total : HE_REPORT_DEFECTS) *
                    sizeof *report.defects);
            assert_string_equal(err.text, first.text);
            st_parallel_free(hands);
        }
        soup.limits.progress = NULL;
        he_soup_clear(&soup);
    }
}

/* --- memory --- */

static void memory_that_runs_out_leaves_nothing_behind(void **state)
{
    (void)state;
    he_soup soup;
    make_soup(2, &soup);
    st_parallel *hands = st_parallel_new(1);
    he_progress progress;
    he_progress_init(&progress, NULL, NULL);
    progress.parallel = st_parallel_host(hands);
    soup.limits.progress = &progress;
    failing f = {0};
    while (failing_next(&f)) {
        he_mesh *mesh = NULL;
        he_error err = {0};
        he_status status = he_build(&soup, 0, &mesh, NULL, &err);
        assert_true(status == HE_OK || (status == HE_NO_MEMORY && mesh == NULL));
        he_mesh_free(mesh);
        failing_status(&f, status);
        assert_int_equal(failing_blocks(), 0);
    }
    assert_true(f.n > 10);
    st_parallel_free(hands);
    soup.limits.progress = NULL;
    he_soup_clear(&soup);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_part_is_run_once_whoever_else_has_work),
        cmocka_unit_test(of_parts_that_fail_the_first_one_is_told),
        cmocka_unit_test(work_is_given_up_between_parts_on_its_own_thread),
        cmocka_unit_test(a_mesh_is_the_same_in_every_bit_on_1_2_and_8_threads),
        cmocka_unit_test(whole_operations_are_the_same_on_1_2_and_8_threads),
        cmocka_unit_test(parts_may_end_in_any_order_even_if_one_fails),
        cmocka_unit_test(defects_are_the_same_on_1_2_and_8_threads),
        cmocka_unit_test(memory_that_runs_out_leaves_nothing_behind),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
