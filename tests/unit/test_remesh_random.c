/* Remeshing of random meshes: rough scans, shapes with sharp edges, sheets with holes, bow-ties,
 * slivers, and meshes far from the origin, with random marks, attributes and sets of faces. The
 * mesh must pass the checker, what must stay must be as it was, undo and redo must work, and a
 * cancelled or refused remeshing must change nothing. The environment variables SEED and ROUNDS
 * repeat a run and make it longer. */
#include "tests/unit/dense.h"

#include "algo/shape.h"
#include "edit/local/erase.h"
#include "geometry/geometry.h"
#include "mesh/marks.h"
#include "mesh/write.h"
#include "remesh/remesh.h"
#include "tests/failing.h"
#include "tests/seed.h"
#include "tests/unit/random_meshes.h"

#include <math.h>

/* --- what must stay --- */

static bool same_place(const he_mesh *a, const he_mesh *b, he_vertex v)
{
    const he_vec3 p = he_position(a, v), q = he_position(b, v);
    const double before[] = {p.x, p.y, p.z}, after[] = {q.x, q.y, q.z};
    uint64_t x[3], y[3];
    memcpy(x, before, sizeof x);
    memcpy(y, after, sizeof y);
    return x[0] == y[0] && x[1] == y[1] && x[2] == y[2];
}

static void require_locks(const he_mesh *before, const he_mesh *after, const uint64_t *chosen)
{
    he_marks marks = {.feature = NULL};
    (void)he_marks_find(before, &marks);
    for (uint32_t v = 0; v < he_mesh_issued(before, HE_VERTEX); v++) {
        if (he_is_locked(&marks, HE_VERTEX, v)) {
            assert_true(he_mesh_is_live(after, HE_VERTEX, v));
            assert_true(same_place(before, after, (he_vertex){v}));
        }
    }
    for (uint32_t h = 0; h < 2 * he_mesh_issued(before, HE_EDGE); h++) {
        if (he_is_locked(&marks, HE_EDGE, h >> 1)) {
            assert_true(he_mesh_is_live(after, HE_EDGE, h >> 1));
            assert_int_equal(he_origin(before, (he_halfedge){h}).i,
                             he_origin(after, (he_halfedge){h}).i);
        }
    }
    for (uint32_t f = 0; f < he_mesh_issued(before, HE_FACE); f++) {
        if (!he_mesh_is_live(before, HE_FACE, f) ||
            (he_bits_get(chosen, f) && !he_is_locked(&marks, HE_FACE, f))) {
            continue;
        }
        assert_true(he_mesh_is_live(after, HE_FACE, f));
        he_halfedge h = he_face_halfedge(before, (he_face){f});
        for (unsigned i = 0; i < 3; i++) {
            assert_int_equal(he_face_of(after, h).i, f);
            assert_int_equal(he_origin(after, h).i, he_origin(before, h).i);
            assert_true(same_place(before, after, he_origin(before, h)));
            h = he_next(before, h);
        }
    }
}

/* Requires that the second component of each attribute is 1, or the default 0 where the rule is
 * `default`: values are weighted means. */
static void require_numbers(const he_mesh *m)
{
    for (size_t i = 0; i < he_mesh_columns(m); i++) {
        const he_column *column = he_mesh_column(m, i);
        if (column == NULL || column->type != HE_DOUBLE) {
            continue;
        }
        for (uint32_t row = 0; row < column->rows; row++) {
            double value[2];
            memcpy(value, he_column_value(column, row), sizeof value);
            assert_true(value[0] >= 0 && value[0] <= 1 + 1e-9);
            assert_true(fabs(value[1] - 1) < 1e-9 || value[1] == 0);
        }
    }
}

static int euler(const he_mesh *m)
{
    return (int)he_mesh_vertices(m) - (int)he_mesh_edges(m) + (int)he_mesh_faces(m);
}

/* --- cancelling --- */

/* Cancels the work at the N-th report of progress. */
typedef struct stopper {
    long left;
    double last;
} stopper;

static bool tell(void *context, const char *phase, double done)
{
    stopper *s = context;
    (void)phase;
    assert_true(done >= s->last && done <= 1);
    s->last = done;
    return --s->left != 0;
}

static void require_clean_cancel(const he_mesh *m, const he_remesh_options *options, md_random *r)
{
    he_mesh *copy = dense_copy(m);
    he_progress progress;
    stopper s = {.left = md_from(r, 1, 30)};
    he_progress_init(&progress, tell, &s);
    he_mesh_set_progress(copy, &progress);
    he_status status = he_remesh(copy, options, NULL, NULL);
    he_mesh_set_progress(copy, NULL);
    assert_true(status == HE_CANCELLED || (status == HE_OK && s.left > 0));
    assert_true(status == HE_OK || he_mesh_equal(copy, m));
    he_mesh_free(copy);
}

/* --- the rounds --- */

static he_remesh_options draw(const he_mesh *m, md_random *r, he_ids *faces, uint64_t **chosen)
{
    he_box box;
    (void)he_surface_box(m, &box);
    he_vec3 half = he_vec3_sub(he_vec3_scale(box.max, 0.5), he_vec3_scale(box.min, 0.5));
    double extent = 2 * he_vec3_extent(half);
    he_remesh_options options = {.by = (he_remesh_by)md_below(r, 3),
                                 .error = extent * pow(10, -1.5 - 1.5 * md_unit(r)),
                                 .edge_length = extent * pow(10, -1.7 * md_unit(r)),
                                 .target_faces = md_from(r, 1, 4000),
                                 .steps = md_from(r, 1, 6),
                                 .project = md_chance(r, 80),
                                 .fixed_boundary = md_chance(r, 20),
                                 .keep_seams = md_chance(r, 50),
                                 .crease = md_chance(r, 70) ? HE_REMESH_CREASE : md_unit(r) * 3};
    if (options.by == HE_REMESH_BY_ERROR) {
        options.min_length = options.edge_length / 4;
        options.max_length = md_chance(r, 50) ? 0 : options.edge_length * 2;
    }
    bool some = md_chance(r, 30);
    *chosen = he_bits_new((size_t)he_mesh_issued(m, HE_FACE) + 1);
    assert_non_null(*chosen);
    for (uint32_t f = 0; f < he_mesh_issued(m, HE_FACE); f++) {
        if (he_mesh_is_live(m, HE_FACE, f) && (!some || md_chance(r, 60))) {
            he_bits_set(*chosen, f);
            assert_int_equal(he_ids_add(faces, f, NULL), HE_OK);
        }
    }
    if (some && faces->count > 0) {
        options.faces = faces->ids;
        options.face_count = faces->count;
    }
    for (uint32_t f = 0; f < he_mesh_issued(m, HE_FACE) && options.faces == NULL; f++) {
        he_bits_set(*chosen, f);
    }
    if (!(options.edge_length > 0)) {
        options.edge_length = options.error = 1;
        options.min_length = options.max_length = 0;
    }
    return options;
}

/* Returns the largest coordinate of the faces. */
static double largest(const he_mesh *m)
{
    he_box box;
    (void)he_surface_box(m, &box);
    return fmax(he_vec3_extent(box.min), he_vec3_extent(box.max));
}

static void require_undo(he_delta *delta, he_mesh *m, const he_mesh *before)
{
    he_mesh *after = dense_copy(m);
    he_delta_undo(delta, m);
    assert_true(he_mesh_equal_live(m, before));
    fixture_check(m);
    he_delta_redo(delta, m);
    assert_true(he_mesh_equal(m, after));
    he_mesh_free(after);
}

static void play(const random_family *of, md_random *r)
{
    he_mesh *m = of->make(r);
    random_decorate(m, r);
    he_mesh *before = dense_copy(m);
    he_ids faces = {0};
    uint64_t *chosen = NULL;
    he_remesh_options options = draw(m, r, &faces, &chosen);
    he_delta *delta = he_delta_new();
    he_remeshed done = {.faces = 0};
    he_error err = {0};
    assert_non_null(delta);
    if (md_chance(r, 20)) {
        require_clean_cancel(m, &options, r);
    }
    if (getenv("VERBOSE") != NULL) {
        printf("    %u faces, by %d: %g, %u, %g, %u steps\n", he_mesh_faces(m), (int)options.by,
               options.edge_length, options.target_faces, options.error, options.steps);
    }
    he_mesh_record(m, delta);
    he_status status = he_remesh(m, &options, &done, &err);
    he_mesh_record(m, NULL);
    if (status != HE_OK) {
        fail_msg("%s: %s", of->name, err.text);
    }
    fixture_check(m);
    require_locks(before, m, chosen);
    require_numbers(m);
    assert_int_equal(euler(m), euler(before));
    /* the points of faces outside the set are at the distance 0 */
    if (he_mesh_faces(m) > 0) {
        const dense_apart apart = dense_measure(m, before);
        assert_true(apart.farthest <= done.distance * (1 + 1e-9) + 1e-12 * largest(before));
    }
    assert_true(isfinite(done.mean) && done.smallest_angle >= 0 && done.largest_angle < 3.2);
    assert_true(done.shortest <= done.mean * (1 + 1e-12) &&
                done.mean <= done.longest * (1 + 1e-12));
    require_undo(delta, m, before);
    he_delta_free(delta);
    he_ids_clear(&faces);
    he_mem_free(chosen);
    he_mesh_free(before);
    he_mesh_free(m);
}

static void random_meshes_stay_valid(void **state)
{
    (void)state;
    uint64_t seed = seed_of_run(), rounds = seed_setting("ROUNDS", 300);
    for (uint64_t i = 0; i < rounds; i++) {
        md_random r = {seed + i};
        const random_family *of = &random_families[(seed + i) % RANDOM_FAMILIES];
        if (getenv("VERBOSE") != NULL) {
            printf("round %llu: SEED=%llu %s\n", (unsigned long long)i,
                   (unsigned long long)(seed + i), of->name);
            (void)fflush(stdout);
        }
        play(of, &r);
    }
    printf("note: %llu random meshes\n", (unsigned long long)rounds);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(random_meshes_stay_valid),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
