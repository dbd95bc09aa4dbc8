/* Deformations: closed forms of each method, what must stay, and random meshes. The environment
 * variables SEED and ROUNDS repeat the random rounds and make them longer. */
#include "tests/unit/dense.h"
#include "tests/unit/random_meshes.h"

#include "deform/deform.h"
#include "deform/rotation.h"
#include "geometry/geometry.h"
#include "mesh/marks.h"
#include "mesh/write.h"
#include "tests/failing.h"
#include "tests/seed.h"

#include <float.h>
#include <math.h>

enum { ALL = 4096 };

/* Lists of vertices for one call. */
typedef struct lists {
    uint32_t handles[ALL], fixed[ALL];
    he_vec3 goals[ALL];
    size_t handle_count, fixed_count;
} lists;

static he_deformed deform(he_mesh *m, he_deform_method method, const lists *l,
                          const he_deform_goal *goal, unsigned steps)
{
    he_deformed done;
    he_error err = {0};
    const he_deform_sets sets = {method, l->handles, l->handle_count, l->fixed, l->fixed_count};
    const he_deform_goal points = {.to = l->goals, .count = l->handle_count};
    if (he_deform(m, &sets, goal == NULL ? &points : goal, steps, &done, &err) != HE_OK) {
        fail_msg("%s", err.text);
    }
    fixture_check(m);
    return done;
}

static he_vec3 at(const he_mesh *m, uint32_t v)
{
    return he_position(m, (he_vertex){v});
}

static double apart(he_vec3 a, he_vec3 b)
{
    return he_vec3_length(he_vec3_sub(a, b));
}

static void add_handle(lists *l, uint32_t v, he_vec3 goal)
{
    assert_true(l->handle_count < ALL);
    l->goals[l->handle_count] = goal;
    l->handles[l->handle_count++] = v;
}

static void add_fixed(lists *l, uint32_t v)
{
    assert_true(l->fixed_count < ALL);
    l->fixed[l->fixed_count++] = v;
}

/* --- the nearest rotation --- */

/* Returns the rotation by an angle around an axis, as the first three rows of a matrix of 16
 * numbers. */
static void turn_about(he_vec3 axis, double angle, double k[16])
{
    const double c = cos(angle), s = sin(angle), d = 1 - c;
    const he_vec3 a = he_vec3_scale(axis, 1 / he_vec3_length(axis));
    const double all[16] = {c + d * a.x * a.x,
                            d * a.x * a.y - s * a.z,
                            d * a.x * a.z + s * a.y,
                            0,
                            d * a.y * a.x + s * a.z,
                            c + d * a.y * a.y,
                            d * a.y * a.z - s * a.x,
                            0,
                            d * a.z * a.x - s * a.y,
                            d * a.z * a.y + s * a.x,
                            c + d * a.z * a.z,
                            0,
                            0,
                            0,
                            0,
                            1};
    memcpy(k, all, sizeof all);
}

static he_vec3 draw_point(md_random *r)
{
    return (he_vec3){2 * md_unit(r) - 1, 2 * md_unit(r) - 1, 2 * md_unit(r) - 1};
}

static he_rotation draw_rotation(md_random *r)
{
    double k[16];
    turn_about(draw_point(r), 6.28 * md_unit(r), k);
    return (he_rotation){{k[0], k[1], k[2], k[4], k[5], k[6], k[8], k[9], k[10]}};
}

static double product(const double a[9], const double b[9])
{
    double sum = 0;
    for (int i = 0; i < 9; i++) {
        sum += a[i] * b[i];
    }
    return sum;
}

static void multiply(const double a[9], const double b[9], double out[9])
{
    for (int i = 0; i < 9; i++) {
        out[i] = a[i - i % 3] * b[i % 3] + a[i - i % 3 + 1] * b[3 + i % 3] +
                 a[i - i % 3 + 2] * b[6 + i % 3];
    }
}

/* Requires that the rows of a matrix are orthogonal and of length 1, and its determinant 1. */
static void require_rotation(const he_rotation *r)
{
    const double *k = r->k;
    const he_vec3 rows[3] = {{k[0], k[1], k[2]}, {k[3], k[4], k[5]}, {k[6], k[7], k[8]}};
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            assert_true(fabs(he_vec3_dot(rows[i], rows[j]) - (i == j)) < 1e-12);
        }
    }
    assert_true(he_vec3_dot(he_vec3_cross(rows[0], rows[1]), rows[2]) > 0);
}

/* Matrices R D R', of which the singular values and the rotation are known: of full rank, flat,
 * with a reflection, lines, points, tiny and huge ones. */
static void no_rotation_is_nearer(void **state)
{
    (void)state;
    md_random r = {seed_of_run()};
    for (int i = 0; i < 20000; i++) {
        const double small = pow(10, -16 * md_unit(&r));
        const double kinds[][3] = {{1, 0.7, 0.3},          {1, 1, 1},      {1, 0.5, 0},
                                   {1, 0.9, -0.4},         {1, 0.5, -0.5}, {1, 0, 0},
                                   {1, small, small},      {1, small, 0},  {1, 1, small},
                                   {1, 0.6, -0.6 * small}, {0, 0, 0}};
        const double *values = kinds[md_below(&r, sizeof kinds / sizeof *kinds)];
        static const double sizes[] = {1, 1, 1e-150, 1e150, 1e-300, 1e300};
        const double size = sizes[md_below(&r, 6)];
        const he_rotation left = draw_rotation(&r), right = draw_rotation(&r);
        const double d[9] = {values[0], 0, 0, 0, values[1], 0, 0, 0, values[2]};
        double half[9], s[9];
        multiply(left.k, d, half);
        multiply(half, right.k, s);
        for (int k = 0; k < 9; k++) {
            s[k] *= size;
        }
        const he_rotation found = he_rotation_nearest(s);
        require_rotation(&found);
        const double most = (values[0] + values[1] + values[2]) * size;
        assert_true(fabs(product(found.k, s) - most) <= 1e-12 * size);
        if (values[1] + values[2] > 0.1) {
            double expected[9];
            multiply(left.k, right.k, expected);
            for (int k = 0; k < 9; k++) {
                assert_true(fabs(found.k[k] - expected[k]) < 1e-11);
            }
        }
    }
}

/* --- closed forms --- */

/* Chooses some vertices in two places of a mesh as handles and fixed ones, and maps them all. */
static void choose_mapped(const he_mesh *m, lists *l, const double k[16])
{
    for (uint32_t v = 0; v < he_mesh_issued(m, HE_VERTEX); v += v % 7 == 0 ? 3 : 11) {
        const he_vec3 p = at(m, v);
        add_handle(l, v,
                   (he_vec3){k[0] * p.x + k[1] * p.y + k[2] * p.z + k[3],
                             k[4] * p.x + k[5] * p.y + k[6] * p.z + k[7],
                             k[8] * p.x + k[9] * p.y + k[10] * p.z + k[11]});
    }
}

static void rigid_handles_move_all_rigidly(void **state)
{
    (void)state;
    md_random r = {seed_of_run()};
    double worst = 0;
    for (int i = 0; i < 40; i++) {
        static lists l;
        l = (lists){.handle_count = 0};
        he_mesh *m = i % 2 ? dense_torus(24) : dense_shape("icosphere", "subdivisions", 3);
        he_mesh *before = dense_copy(m);
        const he_deform_method method = i % 4 < 2 ? HE_DEFORM_ARAP : HE_DEFORM_BIHARMONIC;
        double k[16];
        turn_about(draw_point(&r), method == HE_DEFORM_ARAP ? 6.28 * md_unit(&r) : 0, k);
        k[3] = 9 * md_unit(&r);
        k[7] = -9 * md_unit(&r);
        choose_mapped(m, &l, k);
        const he_deform_goal goal = {.matrix = k};
        const he_deformed done = deform(m, method, &l, i % 8 < 4 ? &goal : NULL, 1);
        for (uint32_t v = 0; v < he_mesh_issued(m, HE_VERTEX); v++) {
            const he_vec3 p = at(before, v);
            const he_vec3 wanted = {k[0] * p.x + k[1] * p.y + k[2] * p.z + k[3],
                                    k[4] * p.x + k[5] * p.y + k[6] * p.z + k[7],
                                    k[8] * p.x + k[9] * p.y + k[10] * p.z + k[11]};
            worst = fmax(worst, apart(at(m, v), wanted));
        }
        assert_true(done.energy < 1e-20);
        assert_int_equal(done.moved, he_mesh_vertices(m));
        he_mesh_free(before);
        he_mesh_free(m);
    }
    print_message("note: rigid handles: off by %g at most\n", worst);
    assert_true(worst < 1e-10);
}

/* With two rows of fixed vertices at one end of a square grid, and two rows of handles at the
 * other, the biharmonic equation of the grid is that of a line: fourth differences are 0, so the
 * displacement is the polynomial of degree 3 through the four rows. */
static void a_strip_bends_like_a_cubic(void **state)
{
    (void)state;
    enum { N = 20 };
    static lists l;
    l = (lists){.handle_count = 0};
    he_mesh *m = dense_grid(N, NULL, 1);
    double size = 0;
    for (uint32_t v = 0; v < he_mesh_issued(m, HE_VERTEX); v++) {
        size = fmax(size, at(m, v).x);
    }
    for (uint32_t v = 0; v < he_mesh_issued(m, HE_VERTEX); v++) {
        const int row = (int)lround(at(m, v).x / size * N);
        const he_vec3 p = at(m, v), up = {p.x, p.y, p.z + 1};
        if (row < 2) {
            add_fixed(&l, v);
        } else if (row > N - 2) {
            add_handle(&l, v, up);
        }
    }
    he_mesh *before = dense_copy(m);
    (void)deform(m, HE_DEFORM_BIHARMONIC, &l, NULL, 1);
    const double knots[4] = {0, 1, N - 1, N}, values[4] = {0, 0, 1, 1};
    double worst = 0;
    for (uint32_t v = 0; v < he_mesh_issued(m, HE_VERTEX); v++) {
        const double x = at(before, v).x / size * N;
        double expected = 0;
        for (int i = 0; i < 4; i++) {
            double term = values[i];
            for (int k = 0; k < 4; k++) {
                term *= k == i ? 1 : (x - knots[k]) / (knots[i] - knots[k]);
            }
            expected += term;
        }
        const he_vec3 way = he_vec3_sub(at(m, v), at(before, v));
        worst = fmax(worst, fabs(way.z - expected) + fabs(way.x) + fabs(way.y));
    }
    print_message("note: off the cubic by %g\n", worst);
    assert_true(worst < 1e-9);
    he_mesh_free(before);
    he_mesh_free(m);
}

/* Makes the handles of a torus: one half of its vertices at an end, turned; fixed: the other
 * end. */
static void bend(const he_mesh *m, lists *l, double angle)
{
    double k[16], most = 0;
    turn_about((he_vec3){0.2, 1, 0.1}, angle, k);
    for (uint32_t v = 0; v < he_mesh_issued(m, HE_VERTEX); v++) {
        most = fmax(most, at(m, v).x);
    }
    for (uint32_t v = 0; v < he_mesh_issued(m, HE_VERTEX); v++) {
        const he_vec3 p = at(m, v);
        if (p.x > 0.8 * most) {
            add_handle(l, v,
                       (he_vec3){k[0] * p.x + k[1] * p.y + k[2] * p.z,
                                 k[4] * p.x + k[5] * p.y + k[6] * p.z,
                                 k[8] * p.x + k[9] * p.y + k[10] * p.z});
        } else if (p.x < -0.8 * most) {
            add_fixed(l, v);
        }
    }
    assert_true(l->handle_count > 0 && l->fixed_count > 0);
}

static void the_energy_falls_with_each_step(void **state)
{
    (void)state;
    for (int shape = 0; shape < 2; shape++) {
        static lists l;
        l = (lists){.handle_count = 0};
        he_mesh *start = shape == 0 ? dense_torus(24) : dense_shape("icosphere", "subdivisions", 3);
        bend(start, &l, 1.2);
        double first = 0, last = INFINITY;
        for (unsigned steps = 1; steps <= 40; steps++) {
            he_mesh *m = dense_copy(start);
            const double energy = deform(m, HE_DEFORM_ARAP, &l, NULL, steps).energy;
            first = steps == 1 ? energy : first;
            assert_true(energy > 0 && energy < last);
            last = energy;
            he_mesh_free(m);
        }
        print_message("note: energy after 1 step %g, after 40 steps %g\n", first, last);
        he_mesh_free(start);
    }
}

/* A part between two handles that turn in opposite directions keeps its lengths better with arap
 * than with the biharmonic displacement. */
static void arap_keeps_lengths_better(void **state)
{
    (void)state;
    static lists l;
    l = (lists){.handle_count = 0};
    he_mesh *start = dense_torus(24);
    bend(start, &l, 1.5);
    double stretched[2] = {0, 0};
    for (int method = 0; method < 2; method++) {
        he_mesh *m = dense_copy(start);
        (void)deform(m, (he_deform_method)method, &l, NULL, 100);
        for (uint32_t h = 0; h < he_mesh_issued(m, HE_HALFEDGE); h += 2) {
            const uint32_t a = he_origin(m, (he_halfedge){h}).i,
                           b = he_target(m, (he_halfedge){h}).i;
            const double ratio = apart(at(m, a), at(m, b)) / apart(at(start, a), at(start, b));
            stretched[method] += (ratio - 1) * (ratio - 1);
        }
        he_mesh_free(m);
    }
    print_message("note: stretch of edges: arap %g, biharmonic %g\n", stretched[0], stretched[1]);
    assert_true(stretched[0] < stretched[1] / 2);
    he_mesh_free(start);
}

/* --- what stays --- */

static void what_lies_behind_fixed_vertices_stays(void **state)
{
    (void)state;
    enum { N = 12 };
    for (int method = 0; method < HE_DEFORM_METHODS; method++) {
        static lists l;
        l = (lists){.handle_count = 0};
        he_mesh *m = dense_grid(N, dense_waves, 1);
        double size = 0;
        for (uint32_t v = 0; v < he_mesh_issued(m, HE_VERTEX); v++) {
            size = fmax(size, at(m, v).x);
        }
        for (uint32_t v = 0; v < he_mesh_issued(m, HE_VERTEX); v++) {
            const int row = (int)lround(at(m, v).x / size * N);
            if (row == 5) {
                add_fixed(&l, v);
            } else if (row == N) {
                add_handle(&l, v, he_vec3_add(at(m, v), (he_vec3){0, 0.1, 0.3}));
            }
        }
        he_mesh *before = dense_copy(m);
        const he_deformed done = deform(m, (he_deform_method)method, &l, NULL, 5);
        uint32_t moved = 0;
        double largest = 0, sum = 0;
        for (uint32_t v = 0; v < he_mesh_issued(m, HE_VERTEX); v++) {
            const int row = (int)lround(at(before, v).x / size * N);
            const double way = apart(at(m, v), at(before, v));
            assert_true(row > 5 ? way > 0 : dense_same_point(at(m, v), at(before, v)));
            moved += way > 0;
            largest = fmax(largest, way);
            sum += way;
        }
        assert_int_equal(done.moved, moved);
        assert_true(fabs(done.largest - largest) < 1e-12);
        assert_true(fabs(done.mean - sum / moved) < 1e-12);
        he_mesh_free(before);
        he_mesh_free(m);
    }
}

/* The deformer uses fields that it made before if all handles move by the same vector; if one of
 * them moves a little differently, it solves for the motion. */
static void a_translation_leads_where_its_equations_do(void **state)
{
    (void)state;
    static const he_vec3 by = {0.3, -0.2, 0.5};
    for (int method = 0; method < HE_DEFORM_METHODS; method++) {
        static lists same, other;
        same = other = (lists){.handle_count = 0};
        he_mesh *m = dense_shape("icosphere", "subdivisions", 4);
        he_mesh *again = dense_copy(m);
        for (uint32_t v = 0; v < he_mesh_issued(m, HE_VERTEX); v++) {
            const he_vec3 p = at(m, v), goal = he_vec3_add(p, by);
            if (p.z > 0.9) {
                add_handle(&same, v, goal);
                add_handle(&other, v, goal);
            } else if (p.z < -0.5) {
                add_fixed(&same, v);
                add_fixed(&other, v);
            }
        }
        other.goals[0].x += 1e-11;
        (void)deform(m, (he_deform_method)method, &same, NULL, 2);
        (void)deform(again, (he_deform_method)method, &other, NULL, 2);
        double worst = 0;
        for (uint32_t v = 0; v < he_mesh_issued(m, HE_VERTEX); v++) {
            worst = fmax(worst, apart(at(m, v), at(again, v)));
        }
        print_message("note: apart by %g\n", worst);
        assert_true(worst > 0 && worst < 1e-10);
        he_mesh_free(again);
        he_mesh_free(m);
    }
}

/* A handle whose goal is its place keeps its bits, and numbers never exceed what a double holds. */
static void extremes_are_told_as_numbers(void **state)
{
    (void)state;
    he_mesh *m = dense_grid(4, NULL, 1);
    he_set_position(m, (he_vertex){0}, (he_vec3){-0.0, -0.0, -0.0});
    static lists l;
    l = (lists){.handle_count = 0};
    add_handle(&l, 0, (he_vec3){0, 0, 0});
    he_mesh *before = dense_copy(m);
    assert_int_equal(deform(m, HE_DEFORM_ARAP, &l, NULL, 2).moved, 0);
    assert_true(he_mesh_equal(m, before));
    for (uint32_t v = 0; v < he_mesh_issued(m, HE_VERTEX); v++) {
        he_set_position(m, (he_vertex){v}, he_vec3_scale(at(m, v), 1e200));
    }
    l = (lists){.handle_count = 0};
    add_handle(&l, 0, (he_vec3){0, 0, 1e200});
    add_fixed(&l, 24);
    const he_deformed done = deform(m, HE_DEFORM_ARAP, &l, NULL, 2);
    assert_true(isfinite(done.energy) && done.energy > 1e307);
    assert_true(isfinite(done.largest) && done.largest >= 1e200);
    he_mesh_free(before);
    he_mesh_free(m);
}

/* The handles that `by` and `to` give go to the same places. */
static void vectors_and_points_agree(void **state)
{
    (void)state;
    const uint32_t handles[] = {3, 17, 40}, fixed[] = {60, 61, 77};
    he_mesh *m = dense_torus(12), *other = dense_copy(m);
    const he_vec3 by = {0.1, 0.2, -0.1};
    he_vec3 to[3];
    for (int i = 0; i < 3; i++) {
        to[i] = he_vec3_add(at(m, handles[i]), by);
    }
    const he_deform_sets sets = {HE_DEFORM_ARAP, handles, 3, fixed, 3};
    assert_int_equal(he_deform(m, &sets, &(he_deform_goal){.by = &by, .count = 1}, 3, NULL, NULL),
                     HE_OK);
    assert_int_equal(
        he_deform(other, &sets, &(he_deform_goal){.to = to, .count = 3}, 3, NULL, NULL), HE_OK);
    assert_true(he_mesh_equal(m, other));
    assert_true(dense_same_point(at(m, 17), to[1]));
    assert_int_equal(he_deform(m, &sets, &(he_deform_goal){.to = to, .count = 2}, 3, NULL, NULL),
                     HE_BAD_VALUE);
    for (unsigned steps = 0; steps <= HE_DEFORM_STEPS + 1; steps += HE_DEFORM_STEPS + 1) {
        assert_int_equal(
            he_deform(m, &sets, &(he_deform_goal){.to = to, .count = 3}, steps, NULL, NULL),
            HE_BAD_VALUE);
    }
    assert_true(he_mesh_equal(m, other));
    he_mesh_free(m);
    he_mesh_free(other);
}

/* --- random meshes --- */

static bool tell(void *context, const char *phase, double done)
{
    long *left = context;
    (void)phase;
    (void)done;
    return --*left != 0;
}

static void require_clean_cancel(const he_mesh *m, const he_deform_sets *sets,
                                 const he_deform_goal *goal, md_random *r)
{
    he_mesh *copy = dense_copy(m);
    he_progress progress;
    long left = md_from(r, 1, 10);
    he_progress_init(&progress, tell, &left);
    he_mesh_set_progress(copy, &progress);
    he_status status = he_deform(copy, sets, goal, 5, NULL, NULL);
    he_mesh_set_progress(copy, NULL);
    /* The commit reports its progress, too, but cannot be cancelled. */
    assert_true(status == HE_OK || he_mesh_equal(copy, m));
    he_mesh_free(copy);
}

/* Requires that a deformation moved nothing but positions, that fixed and locked vertices stayed,
 * and that handles are where they should be. */
static void require_result(const he_mesh *before, const he_mesh *after, const lists *l)
{
    he_marks marks = {.feature = NULL};
    (void)he_marks_find(before, &marks);
    he_mesh *back = dense_copy(after);
    uint64_t *is_handle = he_bits_new((size_t)he_mesh_issued(before, HE_VERTEX) + 1);
    for (size_t i = 0; i < l->handle_count; i++) {
        he_bits_set(is_handle, l->handles[i]);
        assert_true(apart(at(after, l->handles[i]), l->goals[i]) <= 0);
    }
    for (size_t i = 0; i < l->fixed_count; i++) {
        assert_true(dense_same_point(at(before, l->fixed[i]), at(after, l->fixed[i])));
    }
    for (uint32_t v = 0; v < he_mesh_issued(before, HE_VERTEX); v++) {
        if (he_mesh_is_live(before, HE_VERTEX, v)) {
            assert_true(he_vec3_is_finite(at(after, v)));
            he_set_position(back, (he_vertex){v}, at(before, v));
            assert_true(he_bits_get(is_handle, v) || !he_is_locked(&marks, HE_VERTEX, v) ||
                        dense_same_point(at(before, v), at(after, v)));
        }
    }
    for (uint32_t h = 0; h < he_mesh_issued(before, HE_HALFEDGE); h++) {
        if (he_mesh_is_live(before, HE_EDGE, h / 2)) {
            const uint32_t v = he_origin(before, (he_halfedge){h}).i,
                           f = he_face_of(before, (he_halfedge){h}).i;
            if (he_is_locked(&marks, HE_EDGE, h / 2) ||
                (f != HE_NONE && he_is_locked(&marks, HE_FACE, f))) {
                assert_true(he_bits_get(is_handle, v) ||
                            dense_same_point(at(before, v), at(after, v)));
            }
        }
    }
    assert_true(he_mesh_equal(back, before));
    he_mem_free(is_handle);
    he_mesh_free(back);
}

/* Draws handles, with goals near their positions, and fixed vertices. */
static void draw_lists(const he_mesh *m, md_random *r, lists *l)
{
    he_marks marks = {.feature = NULL};
    (void)he_marks_find(m, &marks);
    const uint32_t handles = md_from(r, 1, 20), fixed = md_below(r, 20);
    double size = 0;
    for (uint32_t v = 0; v < he_mesh_issued(m, HE_VERTEX); v++) {
        if (he_mesh_is_live(m, HE_VERTEX, v)) {
            size = fmax(size, he_vec3_extent(he_vec3_sub(at(m, v), at(m, 0))));
        }
    }
    for (uint32_t v = 0; v < he_mesh_issued(m, HE_VERTEX); v++) {
        if (!he_mesh_is_live(m, HE_VERTEX, v)) {
            continue;
        }
        if (md_chance(r, handles) && !he_is_locked(&marks, HE_VERTEX, v) && l->handle_count < ALL) {
            const bool stays = md_chance(r, 10);
            const he_vec3 by = he_vec3_scale(draw_point(r), stays ? 0 : size / 3);
            add_handle(l, v, he_vec3_add(at(m, v), by));
        } else if (md_chance(r, fixed) && l->fixed_count < ALL) {
            add_fixed(l, v);
        }
    }
}

static uint64_t play(const random_family *of, md_random *r)
{
    static lists l;
    l = (lists){.handle_count = 0};
    he_mesh *m = of->make(r);
    random_decorate(m, r);
    draw_lists(m, r, &l);
    he_mesh *before = dense_copy(m);
    const he_deform_sets sets = {(he_deform_method)md_below(r, HE_DEFORM_METHODS), l.handles,
                                 l.handle_count, l.fixed, l.fixed_count};
    const he_deform_goal goal = {.to = l.goals, .count = l.handle_count};
    if (md_chance(r, 20)) {
        require_clean_cancel(m, &sets, &goal, r);
    }
    he_delta *delta = he_delta_new();
    he_error err = {0};
    he_mesh_record(m, delta);
    he_status status = he_deform(m, &sets, &goal, md_from(r, 1, 5), NULL, &err);
    he_mesh_record(m, NULL);
    if (status == HE_OK) {
        fixture_check(m);
        require_result(before, m, &l);
        he_mesh *after = dense_copy(m);
        he_delta_undo(delta, m);
        assert_true(he_mesh_equal_live(m, before));
        he_delta_redo(delta, m);
        assert_true(he_mesh_equal(m, after));
        he_mesh_free(after);
    } else {
        if (status != HE_NOT_FINITE && (status != HE_BAD_VALUE || l.handle_count > 0)) {
            fail_msg("%s, method %d: %s", of->name, (int)sets.method, err.text);
        }
        assert_true(he_mesh_equal(m, before));
    }
    he_delta_free(delta);
    he_mesh_free(before);
    he_mesh_free(m);
    return status == HE_OK;
}

static void random_meshes_stay_valid(void **state)
{
    (void)state;
    const uint64_t seed = seed_of_run(), rounds = seed_setting("ROUNDS", 300);
    uint64_t done = 0;
    for (uint64_t i = 0; i < rounds; i++) {
        md_random r = {seed + i};
        done += play(&random_families[(seed + i) % RANDOM_FAMILIES], &r);
    }
    printf("note: %llu random meshes, of which %llu were deformed\n", (unsigned long long)rounds,
           (unsigned long long)done);
    assert_true(done > rounds / 2);
}

static void every_allocation_may_fail(void **state)
{
    (void)state;
    const uint32_t handles[] = {0, 5}, fixed[] = {9, 10, 11};
    const he_vec3 by = {0.1, 0, 0.2};
    for (int method = 0; method < HE_DEFORM_METHODS; method++) {
        failing f = {0};
        while (failing_next(&f)) {
            failing_pause();
            he_mesh *m = dense_shape("icosphere", "subdivisions", 1);
            he_mesh *before = dense_copy(m);
            const he_deform_sets sets = {(he_deform_method)method, handles, 2, fixed, 3};
            const he_deform_goal goal = {.by = &by, .count = 1};
            failing_resume();
            if (!failing_status(&f, he_deform(m, &sets, &goal, 2, NULL, NULL))) {
                assert_true(he_mesh_equal(m, before));
            }
            he_mesh_free(before);
            he_mesh_free(m);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(no_rotation_is_nearer),
        cmocka_unit_test(rigid_handles_move_all_rigidly),
        cmocka_unit_test(a_strip_bends_like_a_cubic),
        cmocka_unit_test(the_energy_falls_with_each_step),
        cmocka_unit_test(arap_keeps_lengths_better),
        cmocka_unit_test(what_lies_behind_fixed_vertices_stays),
        cmocka_unit_test(a_translation_leads_where_its_equations_do),
        cmocka_unit_test(extremes_are_told_as_numbers),
        cmocka_unit_test(vectors_and_points_agree),
        cmocka_unit_test(random_meshes_stay_valid),
        cmocka_unit_test(every_allocation_may_fail),
    };
    return cmocka_run_group_tests_name("deform", tests, NULL, NULL);
}
