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
#include "model/random.h"
#include "remesh/remesh.h"
#include "tests/failing.h"
#include "tests/seed.h"

#include <math.h>

/* --- random meshes --- */

typedef struct family {
    const char *name;
    he_mesh *(*make)(md_random *r);
} family;

static double wobble(md_random *r, double size)
{
    return (2 * md_unit(r) - 1) * size;
}

/* Moves each vertex by up to `size` in each direction. */
static void shake(he_mesh *m, md_random *r, double size)
{
    for (uint32_t v = 0; v < he_mesh_issued(m, HE_VERTEX); v++) {
        he_vec3 p = he_position(m, (he_vertex){v});
        p = he_vec3_add(p, (he_vec3){wobble(r, size), wobble(r, size), wobble(r, size)});
        he_set_position(m, (he_vertex){v}, p);
    }
}

static void delete_faces(he_mesh *m, md_random *r, uint32_t percent)
{
    for (uint32_t f = 0; f < he_mesh_issued(m, HE_FACE); f++) {
        if (he_mesh_is_live(m, HE_FACE, f) && md_chance(r, percent)) {
            assert_int_equal(he_face_delete(m, &f, 1,
                                            md_chance(r, 20) ? HE_KEEP_ISOLATED : HE_DROP_ISOLATED,
                                            NULL),
                             HE_OK);
        }
    }
}

static he_mesh *make_scan(md_random *r)
{
    he_mesh *m = dense_shape("icosphere", "subdivisions", md_from(r, 1, 4));
    shake(m, r, md_unit(r) * 0.1);
    delete_faces(m, r, md_chance(r, 50) ? 0 : md_below(r, 30));
    return m;
}

static he_mesh *make_solid(md_random *r)
{
    static const char *const names[] = {"cube",     "tetrahedron", "octahedron", "dodecahedron",
                                        "cylinder", "cone",        "prism",      "torus"};
    he_mesh *m = NULL;
    while (m == NULL) {
        const char *name = names[md_below(r, sizeof names / sizeof *names)];
        m = he_shape_find(name, strlen(name)) == NULL ? NULL : dense_shape(name, NULL, 0);
    }
    return m;
}

static he_mesh *make_sheet(md_random *r)
{
    he_mesh *m = dense_grid(md_from(r, 1, 20), md_chance(r, 50) ? dense_waves : NULL, 1);
    if (md_chance(r, 40)) {
        shake(m, r, md_unit(r) * 0.3);
    }
    delete_faces(m, r, md_chance(r, 30) ? 0 : md_below(r, 40));
    return m;
}

/* A checkerboard: all inner vertices are bow-ties. */
static he_mesh *make_bowties(md_random *r)
{
    uint32_t side = md_from(r, 2, 9);
    he_mesh *m = dense_grid(side, NULL, 1);
    for (uint32_t i = 0; i < side * side; i++) {
        const uint32_t two[2] = {2 * i, 2 * i + 1};
        if ((i / side + i % side) % 2 == 1 && md_chance(r, 90)) {
            assert_int_equal(he_face_delete(m, two, 2, HE_DROP_ISOLATED, NULL), HE_OK);
        }
    }
    return m;
}

/* A grid that is squeezed in one or two directions, with vertices that are at one place or on one
 * line. */
static he_mesh *make_slivers(md_random *r)
{
    he_mesh *m = md_chance(r, 50) ? dense_grid(md_from(r, 1, 12), dense_waves, 1)
                                  : dense_cube(md_from(r, 1, 6));
    double x = pow(10, -(double)md_below(r, 12)), z = pow(10, -(double)md_below(r, 12));
    he_vec3 last = {0, 0, 0};
    for (uint32_t v = 0; v < he_mesh_issued(m, HE_VERTEX); v++) {
        he_vec3 p = he_position(m, (he_vertex){v});
        p = (he_vec3){p.x * x, p.y, p.z * z};
        p = md_chance(r, 5) ? last : p;
        p.x = md_chance(r, 5) ? last.x : p.x;
        he_set_position(m, (he_vertex){v}, p);
        last = p;
    }
    return m;
}

/* A mesh whose coordinates are huge, tiny, or large compared with its size. */
static he_mesh *make_far(md_random *r)
{
    he_mesh *m = md_chance(r, 50) ? make_scan(r) : make_solid(r);
    static const double scales[] = {1e300, 1e-300, 1e150, 1e-150, 1, 1, 1};
    double scale = scales[md_below(r, sizeof scales / sizeof *scales)];
    double shift = scale == 1 ? pow(10, md_below(r, 14)) : md_below(r, 10);
    for (uint32_t v = 0; v < he_mesh_issued(m, HE_VERTEX); v++) {
        he_vec3 p = he_position(m, (he_vertex){v});
        if (he_mesh_is_live(m, HE_VERTEX, v)) {
            p = (he_vec3){(p.x + shift) * scale, (p.y - shift) * scale, p.z * scale};
            he_set_position(m, (he_vertex){v}, p);
        }
    }
    return m;
}

/* A fan around one vertex of very many edges. */
static he_mesh *make_hub(md_random *r)
{
    uint32_t count = md_from(r, 3, 400);
    he_soup soup;
    he_soup_init(&soup, NULL);
    (void)dense_add_vertex(&soup, 0, 0, md_unit(r));
    for (uint32_t i = 0; i < count; i++) {
        double a = 6.283185307179586 * i / count;
        (void)dense_add_vertex(&soup, cos(a), sin(a), 0);
    }
    uint32_t last = md_chance(r, 50) ? count : count - 1;
    for (uint32_t i = 0; i < last; i++) {
        dense_add_triangle(&soup, 0, 1 + i, 1 + (i + 1) % count);
    }
    return dense_built(&soup);
}

static const family families[] = {
    {"scan", make_scan},       {"solid", make_solid},     {"sheet", make_sheet},
    {"bowties", make_bowties}, {"slivers", make_slivers}, {"far", make_far},
    {"hub", make_hub},
};

/* --- marks and attributes --- */

static void set_bytes(he_mesh *m, he_kind kind, const char *name, md_random *r, uint32_t percent)
{
    he_column *column = NULL;
    assert_int_equal(
        he_column_new(&(he_column_schema){name, kind, HE_BOOL, 1, HE_COPY}, &column, NULL), HE_OK);
    assert_int_equal(he_column_extend(column, he_mesh_issued(m, kind), NULL), HE_OK);
    for (uint32_t i = 0; i < he_mesh_issued(m, kind); i++) {
        bool live = kind == HE_HALFEDGE ? he_edge_is_live(m, (he_edge){i >> 1})
                                        : he_mesh_is_live(m, kind, i);
        *he_column_row(column, i) = live && md_chance(r, percent);
    }
    assert_int_equal(he_mesh_add_column(m, column, NULL), HE_OK);
}

static void set_numbers(he_mesh *m, he_kind kind, he_rule rule, md_random *r)
{
    he_column *column = NULL;
    uint32_t rows = he_mesh_issued(m, kind == HE_HALFEDGE ? HE_EDGE : kind);
    rows *= kind == HE_HALFEDGE ? 2 : 1;
    const he_column_schema schema = {"number", kind, HE_DOUBLE, 2, rule};
    assert_int_equal(he_column_new(&schema, &column, NULL), HE_OK);
    assert_int_equal(he_column_extend(column, rows, NULL), HE_OK);
    for (uint32_t i = 0; i < rows; i++) {
        const double value[2] = {md_unit(r), 1};
        bool live = kind == HE_HALFEDGE ? he_edge_is_live(m, (he_edge){i >> 1}) &&
                                              !he_is_boundary_halfedge(m, (he_halfedge){i})
                                        : he_mesh_is_live(m, kind, i);
        if (live) {
            memcpy(he_column_row(column, i), value, sizeof value);
        }
    }
    assert_int_equal(he_mesh_add_column(m, column, NULL), HE_OK);
}

static void decorate(he_mesh *m, md_random *r)
{
    static const he_kind kinds[] = {HE_VERTEX, HE_EDGE, HE_FACE, HE_HALFEDGE};
    static const he_rule rules[] = {HE_COPY, HE_INTERPOLATE, HE_DEFAULT};
    for (size_t i = 0; i < 4; i++) {
        if (i < 3 && md_chance(r, 15)) {
            set_bytes(m, kinds[i], "locked", r, md_from(r, 1, 20));
        }
        if (md_chance(r, 15)) {
            set_numbers(m, kinds[i], rules[md_below(r, 3)], r);
        }
    }
    if (md_chance(r, 25)) {
        set_bytes(m, HE_EDGE, "feature", r, md_from(r, 1, 20));
    }
}

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
    he_remesh_options options = {.by_length = md_chance(r, 70),
                                 .edge_length = extent * pow(10, -1.7 * md_unit(r)),
                                 .target_faces = md_from(r, 1, 4000),
                                 .steps = md_from(r, 1, 6),
                                 .project = md_chance(r, 80),
                                 .fixed_boundary = md_chance(r, 20),
                                 .crease = md_chance(r, 70) ? HE_REMESH_CREASE : md_unit(r) * 3};
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
        options.edge_length = 1;
    }
    return options;
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

static void play(const family *of, md_random *r)
{
    he_mesh *m = of->make(r);
    decorate(m, r);
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
        printf("    %u faces, %s %g, %u steps\n", he_mesh_faces(m),
               options.by_length ? "edge_length" : "target_faces",
               options.by_length ? options.edge_length : options.target_faces, options.steps);
    }
    he_mesh_record(m, delta);
    he_status status = he_remesh(m, &options, &done, &err);
    he_mesh_record(m, NULL);
    if (status != HE_OK) {
        fail_msg("%s, %s %g, %u steps: %s", of->name,
                 options.by_length ? "edge_length" : "target_faces",
                 options.by_length ? options.edge_length : options.target_faces, options.steps,
                 err.text);
    }
    fixture_check(m);
    require_locks(before, m, chosen);
    require_numbers(m);
    assert_int_equal(euler(m), euler(before));
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
        const family *of = &families[(seed + i) % (sizeof families / sizeof *families)];
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
