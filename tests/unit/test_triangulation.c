/* Tests of triangulating long polygons of any shape: the triangles must be valid, no triangle may
 * be turned over, and the work must be limited. */
#include "unit/fixture.h"

#include "geometry/corner_tree.h"
#include "geometry/ears.h"
#include "geometry/long_faces_keep.h"
#include "geometry/orient.h"
#include "geometry/sweep.h"
#include "geometry/triangulation.h"
#include "mesh/long_faces.h"
#include "mesh/replay.h"
#include "mesh/walk.h"
#include "mesh/write.h"
#include "polygons.h"
#include "seed.h"
#include "tests/failing.h"

#include <math.h>

static int turn(const he_planar_loop *f, uint32_t a, uint32_t b, uint32_t c)
{
    return he_orient2((he_vec2){f->x[a], f->y[a]}, (he_vec2){f->x[b], f->y[b]},
                      (he_vec2){f->x[c], f->y[c]});
}

static double doubled_area(const he_planar_loop *f, uint32_t a, uint32_t b, uint32_t c)
{
    return (f->x[b] - f->x[a]) * (f->y[c] - f->y[a]) - (f->y[b] - f->y[a]) * (f->x[c] - f->x[a]);
}

/* Requires that each triangle in turn cuts its middle corner off the rest of the polygon. It
 * follows that there are n - 2 triangles, that every diagonal is in two of them, and that every
 * side is in one. */
static void assert_cuts_corners(const he_planar_loop *f, const uint32_t *corners)
{
    uint32_t n = f->n, *next = calloc(n, sizeof *next);
    assert_non_null(next);
    for (uint32_t i = 0; i < n; i++) {
        next[i] = (i + 1) % n;
    }
    for (uint32_t k = 0; k + 2 < n; k++) {
        const uint32_t *t = corners + 3 * (size_t)k;
        assert_true(t[0] < n && t[1] < n && t[2] < n);
        assert_int_equal(next[t[0]], t[1]);
        assert_int_equal(next[t[1]], t[2]);
        next[t[0]] = t[2];
        next[t[1]] = HE_NONE;
        if (k + 3 == n) {
            assert_int_equal(next[t[2]], t[0]);
        }
    }
    free(next);
}

/* Requires that all triangles are counter-clockwise, and that their areas add up to the area of the
 * polygon. It follows that the triangles cover the polygon exactly once. */
static void assert_covers(const he_planar_loop *f, const uint32_t *corners)
{
    double whole = 0, sum = 0;
    for (uint32_t i = 1; i + 1 < f->n; i++) {
        whole += doubled_area(f, 0, i, i + 1);
    }
    for (uint32_t k = 0; k + 2 < f->n; k++) {
        const uint32_t *t = corners + 3 * (size_t)k;
        assert_int_equal(turn(f, t[0], t[1], t[2]), 1);
        sum += doubled_area(f, t[0], t[1], t[2]);
    }
    assert_true(fabs(sum - whole) <= 1e-9 * whole);
}

static he_mesh *mesh_of(const polygon_shape *shape, uint32_t n)
{
    he_vec3 *points = calloc(n, sizeof *points);
    assert_non_null(points);
    shape->make(n, points);
    he_mesh *m = polygon_mesh(points, n);
    assert_non_null(m);
    free(points);
    return m;
}

static he_halfedge first_of(const he_mesh *m)
{
    return he_face_halfedge(m, (he_face){0});
}

static void every_shape_is_covered(void **state)
{
    (void)state;
    static const uint32_t sizes[] = {66, 100, 1000, 3000};
    for (unsigned s = 0; s < polygon_shape_count; s++) {
        for (unsigned i = 0; i < 4; i++) {
            he_mesh *m = mesh_of(&polygon_shapes[s], sizes[i]);
            he_triangulation t;
            he_planar_loop f;
            print_message("%s of %u corners\n", polygon_shapes[s].name, sizes[i]);
            assert_int_equal(
                he_triangulation_make(m, first_of(m), HE_ANY_DIAGONALS, NULL, &t, NULL), HE_OK);
            assert_int_equal(he_planar_loop_init(&f, m, first_of(m), NULL), HE_OK);
            assert_cuts_corners(&f, t.corners);
            if (polygon_shapes[s].simple) {
                assert_false(t.degenerate);
                assert_covers(&f, t.corners);
            }
            he_planar_loop_clear(&f);
            he_triangulation_clear(&t);
            he_mesh_free(m);
        }
    }
}

/* The work is counted in steps, not in seconds. Any polygon of n corners may need at most a few
 * times n log n steps. */
static void work_grows_as_n_log_n(void **state)
{
    (void)state;
    static const uint32_t sizes[] = {4096, 65536};
    const char *name = "";
    double most = 0;
    for (unsigned s = 0; s < polygon_shape_count; s++) {
        for (unsigned i = 0; i < 2; i++) {
            uint32_t n = sizes[i];
            he_mesh *m = mesh_of(&polygon_shapes[s], n);
            he_triangulation t;
            assert_int_equal(
                he_triangulation_make(m, first_of(m), HE_ANY_DIAGONALS, NULL, &t, NULL), HE_OK);
            double steps = (double)t.steps / (n * log2(n));
            if (steps > most) {
                most = steps;
                name = polygon_shapes[s].name;
            }
            assert_true(steps < 3 * HE_EAR_STEPS);
            he_triangulation_clear(&t);
            he_mesh_free(m);
        }
    }
    print_message("note: %s takes %.1f steps for each of n log2 n, others less\n", name, most);
}

/* --- random simple polygons, with a simple check of the triangles --- */

/* Returns a pseudo-random number: xorshift64 (Marsaglia 2003). */
static uint64_t random_bits(uint64_t *state)
{
    *state ^= *state << 13;
    *state ^= *state >> 7;
    *state ^= *state << 17;
    return *state >> 11;
}

static bool on_segment(const he_planar_loop *f, uint32_t a, uint32_t b, uint32_t p)
{
    return turn(f, a, b, p) == 0 && fmin(f->x[a], f->x[b]) <= f->x[p] &&
           f->x[p] <= fmax(f->x[a], f->x[b]) && fmin(f->y[a], f->y[b]) <= f->y[p] &&
           f->y[p] <= fmax(f->y[a], f->y[b]);
}

static bool meet(const he_planar_loop *f, uint32_t a, uint32_t b, uint32_t c, uint32_t d)
{
    return (turn(f, a, b, c) * turn(f, a, b, d) < 0 && turn(f, c, d, a) * turn(f, c, d, b) < 0) ||
           on_segment(f, a, b, c) || on_segment(f, a, b, d) || on_segment(f, c, d, a) ||
           on_segment(f, c, d, b);
}

/* Reverses pieces of a random polygon until no two of its sides cross. Returns false if this takes
 * too long, or if a corner lies on a side. The corners are few and lie on a grid, so three corners
 * are often collinear. */
static bool untangle(he_planar_loop *f)
{
    uint32_t n = f->n;
    for (unsigned tries = 0; tries < 2000; tries++) {
        bool found = false;
        for (uint32_t i = 0; i + 2 < n && !found; i++) {
            for (uint32_t k = i + 2; k < n && !found; k++) {
                if (!(i == 0 && k == n - 1) && meet(f, i, i + 1, k, (k + 1) % n)) {
                    for (uint32_t a = i + 1, b = k; a < b; a++, b--) {
                        double x = f->x[a], y = f->y[a];
                        f->x[a] = f->x[b];
                        f->y[a] = f->y[b];
                        f->x[b] = x;
                        f->y[b] = y;
                    }
                    found = true;
                }
            }
        }
        if (!found) {
            double area = 0;
            for (uint32_t i = 0; i < n; i++) {
                uint32_t k = (i + 1) % n, l = (i + 2) % n;
                area += f->x[i] * f->y[k] - f->x[k] * f->y[i];
                /* If a side runs back along the side before it, the two sides share more than a
                 * corner. */
                if (on_segment(f, i, k, l) || on_segment(f, k, l, i)) {
                    return false;
                }
            }
            for (uint32_t i = 0; i < n / 2 && area < 0; i++) {
                double x = f->x[i], y = f->y[i];
                f->x[i] = f->x[n - 1 - i];
                f->y[i] = f->y[n - 1 - i];
                f->x[n - 1 - i] = x;
                f->y[n - 1 - i] = y;
            }
            return true;
        }
    }
    return false;
}

/* Requires that no diagonal of the triangulation meets a side of the polygon except at the
 * diagonal's ends. */
static void assert_inside(const he_planar_loop *f, const uint32_t *corners)
{
    for (uint32_t k = 0; k + 3 < f->n; k++) {
        uint32_t a = corners[3 * (size_t)k], b = corners[3 * (size_t)k + 2];
        for (uint32_t i = 0; i < f->n; i++) {
            uint32_t j = (i + 1) % f->n;
            if (i != a && i != b && j != a && j != b) {
                assert_false(meet(f, a, b, i, j));
            }
        }
    }
}

static void random_polygons_both_ways(void **state)
{
    (void)state;
    enum { MOST = 40, POLYGONS = 400 };
    uint64_t seed = seed_of_run() | 1;
    double x[MOST], y[MOST];
    uint32_t halfedges[MOST] = {0}, corners[3 * MOST];
    he_mesh *m = mesh_of(&polygon_shapes[0], 64);
    unsigned made = 0, swept = 0;
    for (unsigned round = 0; round < POLYGONS; round++) {
        he_planar_loop f = {
            .n = 3 + (uint32_t)(random_bits(&seed) % (MOST - 2)), halfedges, x, y, false, NULL};
        uint32_t side = round % 2 == 0 ? 64 : 1u << 20;
        for (uint32_t i = 0; i < f.n; i++) {
            x[i] = (double)(random_bits(&seed) % side) / side;
            y[i] = (double)(random_bits(&seed) % side) / side;
        }
        if (!untangle(&f)) {
            continue;
        }
        made++;
        bool done = false, stuck = true;
        uint64_t steps = 0;
        assert_int_equal(he_sweep_cut(&f, corners, &done, &steps, NULL), HE_OK);
        assert_true(done);
        assert_cuts_corners(&f, corners);
        assert_covers(&f, corners);
        assert_inside(&f, corners);
        he_triangulation t = {.flat = f, .corners = corners};
        he_triangulation_work work = {0};
        assert_int_equal(he_ears_cut(m, HE_ANY_DIAGONALS, &work, &t, &stuck, NULL), HE_OK);
        assert_false(stuck);
        assert_cuts_corners(&f, corners);
        assert_covers(&f, corners);
        assert_inside(&f, corners);
        swept += t.degenerate;
    }
    print_message("note: %u random polygons, each by ears and by a sweep\n", made);
    assert_int_equal(swept, 0);
    assert_true(made > POLYGONS / 4);
    he_mesh_free(m);
}

static void what_meets_itself_is_not_swept(void **state)
{
    (void)state;
    for (unsigned s = 0; s < polygon_shape_count; s++) {
        he_mesh *m = mesh_of(&polygon_shapes[s], 500);
        he_planar_loop f;
        bool done = false;
        uint64_t steps = 0;
        uint32_t corners[3 * 500];
        assert_int_equal(he_planar_loop_init(&f, m, first_of(m), NULL), HE_OK);
        assert_int_equal(he_sweep_cut(&f, corners, &done, &steps, NULL), HE_OK);
        if (!done && polygon_shapes[s].simple) {
            fail_msg("%s was not swept", polygon_shapes[s].name);
        }
        if (done) {
            assert_cuts_corners(&f, corners);
            assert_covers(&f, corners);
        }
        he_planar_loop_clear(&f);
        he_mesh_free(m);
    }
}

/* --- avoiding existing edges, memory and progress --- */

/* An export prefers triangles whose diagonals are not edges of the mesh already. If the plain
 * triangulation has no such diagonal, the export must use it as it is. */
static void avoiding_edges_changes_nothing_where_there_are_none(void **state)
{
    (void)state;
    for (unsigned s = 0; s < polygon_shape_count; s++) {
        he_mesh *m = mesh_of(&polygon_shapes[s], 700);
        he_triangulation any, avoiding;
        assert_int_equal(he_triangulation_make(m, first_of(m), HE_ANY_DIAGONALS, NULL, &any, NULL),
                         HE_OK);
        assert_int_equal(he_triangulation_make(m, first_of(m), HE_ANY_DIAGONALS | HE_AVOID_EDGES,
                                               NULL, &avoiding, NULL),
                         HE_OK);
        assert_memory_equal(any.corners, avoiding.corners, 3 * sizeof(uint32_t) * 698);
        assert_int_equal(any.degenerate, avoiding.degenerate);
        he_triangulation_clear(&any);
        he_triangulation_clear(&avoiding);
        he_mesh_free(m);
    }
}

static void each_allocation_fails_cleanly(void **state)
{
    (void)state;
    static const char *const names[] = {"comb", "tilted comb", "scribble", "one point"};
    for (unsigned s = 0; s < polygon_shape_count; s++) {
        bool wanted = false;
        for (unsigned i = 0; i < 4; i++) {
            wanted |= strcmp(polygon_shapes[s].name, names[i]) == 0;
        }
        if (!wanted) {
            continue;
        }
        he_mesh *m = mesh_of(&polygon_shapes[s], 2000);
        failing f = {0};
        while (failing_next(&f)) {
            he_triangulation t;
            he_error err = {0};
            he_status status =
                he_triangulation_make(m, first_of(m), HE_AVOID_EDGES, NULL, &t, &err);
            if (failing_status(&f, status)) {
                he_triangulation_clear(&t);
            } else {
                assert_int_equal(err.status, HE_NO_MEMORY);
            }
        }
        assert_true(f.n > 5);
        he_mesh_free(m);
    }
}

static bool give_up(void *context, const char *phase, double done)
{
    (void)phase;
    (void)done;
    ++*(unsigned *)context;
    return false;
}

static void a_long_loop_is_given_up(void **state)
{
    (void)state;
    for (unsigned s = 0; s < polygon_shape_count; s++) {
        he_mesh *m = mesh_of(&polygon_shapes[s], 40000);
        he_progress progress;
        unsigned told = 0;
        he_progress_init(&progress, give_up, &told);
        he_triangulation_work work = {.progress = &progress, .of = 1};
        he_triangulation t;
        assert_int_equal(he_triangulation_make(m, first_of(m), HE_ANY_DIAGONALS, &work, &t, NULL),
                         HE_CANCELLED);
        assert_int_equal(told, 1);
        /* Cancelled work must end soon: after at most one more corner or one more pass over the
         * corners. */
        assert_true(work.steps < 40 * 40000);
        he_mesh_free(m);
    }
}

/* --- triangulations that are kept with a copy of the mesh --- */

static he_replay *replay_of(const polygon_shape *shape, uint32_t n)
{
    he_mesh *m = mesh_of(shape, n);
    he_replay *replay = NULL;
    assert_int_equal(he_replay_new(m, &replay, NULL), HE_OK);
    he_mesh_free(m);
    return replay;
}

static uint64_t steps_of(const he_mesh *m, unsigned flags, uint32_t *first)
{
    he_triangulation t;
    assert_int_equal(he_triangulation_make(m, first_of(m), flags, NULL, &t, NULL), HE_OK);
    uint64_t steps = t.steps;
    memcpy(first, t.corners, 3 * sizeof *first);
    he_triangulation_clear(&t);
    return steps;
}

/* A long face must be triangulated only once for all its users: the tree of bounding boxes, the
 * arrays for a renderer and the writers of triangle formats. */
static void a_long_face_is_cut_once_for_all(void **state)
{
    (void)state;
    enum { N = 5000 };
    he_replay *replay = replay_of(&polygon_shapes[3], N);
    const he_mesh *m = he_replay_mesh(replay);
    uint32_t alone[3], kept[3], avoiding[3];
    uint64_t steps = steps_of(m, HE_ANY_DIAGONALS, alone);
    size_t bytes = he_replay_bytes(replay);
    assert_true(steps > 10 * N);
    assert_null(he_long_faces_find(m, first_of(m)));
    assert_int_equal(he_long_faces_keep(m, NULL, NULL), HE_OK);
    assert_int_equal(he_replay_bytes(replay), bytes + sizeof(he_long_face) + 12 * (N - 2));
    const he_long_face *face = he_long_faces_find(m, first_of(m));
    assert_non_null(face);
    assert_int_equal(he_long_faces_keep(m, NULL, NULL), HE_OK);
    assert_ptr_equal(he_long_faces_find(m, first_of(m)), face);
    assert_int_equal(steps_of(m, HE_ANY_DIAGONALS, kept), N);
    assert_true(steps_of(m, HE_ANY_DIAGONALS | HE_AVOID_EDGES, avoiding) < 10 * N);
    assert_memory_equal(alone, kept, sizeof alone);
    assert_memory_equal(alone, avoiding, sizeof alone);
    he_replay_free(replay);
}

static void a_mesh_that_may_change_keeps_nothing(void **state)
{
    (void)state;
    he_mesh *m = mesh_of(&polygon_shapes[3], 1000);
    assert_int_equal(he_long_faces_keep(m, NULL, NULL), HE_OK);
    assert_null(he_long_faces_find(m, first_of(m)));
    he_mesh_free(m);
}

static void a_copy_that_moves_on_forgets(void **state)
{
    (void)state;
    he_mesh *m = mesh_of(&polygon_shapes[3], 1000);
    he_replay *replay = NULL;
    assert_int_equal(he_replay_new(m, &replay, NULL), HE_OK);
    assert_int_equal(he_long_faces_keep(he_replay_mesh(replay), NULL, NULL), HE_OK);
    he_delta *delta = he_delta_new();
    assert_non_null(delta);
    he_mesh_record(m, delta);
    assert_int_equal(he_reserve(m, (he_reservation){.positions = 1}, NULL), HE_OK);
    he_set_position(m, (he_vertex){7}, (he_vec3){-1, -2, 3});
    he_mesh_record(m, NULL);
    const uint32_t issued[HE_KIND_COUNT] = {
        [HE_VERTEX] = he_mesh_issued(m, HE_VERTEX),
        [HE_EDGE] = he_mesh_issued(m, HE_EDGE),
        [HE_FACE] = he_mesh_issued(m, HE_FACE),
    };
    const he_crossing crossing = {.key = 1, .delta = delta, .issued = issued};
    assert_int_equal(he_replay_cross(replay, &crossing, NULL), HE_OK);
    assert_null(he_long_faces_find(he_replay_mesh(replay), first_of(m)));
    he_replay_free(replay);
    he_delta_free(delta);
    he_mesh_free(m);
}

static void keeping_fails_cleanly(void **state)
{
    (void)state;
    he_replay *replay = replay_of(&polygon_shapes[4], 1000);
    const he_mesh *m = he_replay_mesh(replay);
    he_progress progress;
    unsigned told = 0;
    he_progress_init(&progress, give_up, &told);
    assert_int_equal(he_long_faces_keep(m, &progress, NULL), HE_CANCELLED);
    assert_null(he_long_faces_find(m, first_of(m)));
    failing f = {0};
    while (failing_next(&f)) {
        bool kept = failing_status(&f, he_long_faces_keep(m, NULL, NULL));
        assert_true((he_long_faces_find(m, first_of(m)) != NULL) == kept);
    }
    he_replay_free(replay);
}

/* A hundred corners are searched as a list, and four hundred corners as a tree; both searches must
 * find the same corners. The additional three hundred corners are far from all triangles of the
 * test. */
static void a_list_of_corners_finds_what_a_tree_finds(void **state)
{
    (void)state;
    enum { NEAR = 100, ALL = 400 };
    double x[ALL], y[ALL];
    uint32_t corners[ALL], found = 0;
    uint64_t seed = seed_of_run() | 1, steps = 0;
    he_planar_loop f = {.n = ALL, .x = x, .y = y};
    for (uint32_t i = 0; i < ALL; i++) {
        corners[i] = i;
        x[i] = (i < NEAR ? 0 : 1.5) + (double)(random_bits(&seed) % 64) / 128;
        y[i] = (double)(random_bits(&seed) % 64) / 64;
    }
    he_corner_tree list, tree;
    assert_int_equal(he_corner_tree_make(&list, &f, corners, NEAR, NULL), HE_OK);
    assert_int_equal(he_corner_tree_make(&tree, &f, corners, ALL, NULL), HE_OK);
    assert_int_equal(list.leaves, 0);
    assert_true(tree.leaves > 0);
    for (unsigned round = 0; round < 4000; round++) {
        uint32_t a = (uint32_t)(random_bits(&seed) % NEAR);
        uint32_t b = (uint32_t)(random_bits(&seed) % NEAR);
        uint32_t c = (uint32_t)(random_bits(&seed) % NEAR);
        if (he_planar_loop_turns_left(&f, a, b, c)) {
            uint32_t one = he_corner_tree_find(&list, a, b, c, &steps);
            assert_int_equal(one, he_corner_tree_find(&tree, a, b, c, &steps));
            found += one != HE_NONE;
        }
        if (round % 50 == 0 && he_corner_tree_has(&list, a)) {
            he_corner_tree_remove(&list, a);
            he_corner_tree_remove(&tree, a);
        }
    }
    assert_true(found > 100);
    he_corner_tree_clear(&list);
    he_corner_tree_clear(&tree);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_shape_is_covered),
        cmocka_unit_test(work_grows_as_n_log_n),
        cmocka_unit_test(random_polygons_both_ways),
        cmocka_unit_test(a_list_of_corners_finds_what_a_tree_finds),
        cmocka_unit_test(what_meets_itself_is_not_swept),
        cmocka_unit_test(avoiding_edges_changes_nothing_where_there_are_none),
        cmocka_unit_test(each_allocation_fails_cleanly),
        cmocka_unit_test(a_long_loop_is_given_up),
        cmocka_unit_test(a_long_face_is_cut_once_for_all),
        cmocka_unit_test(a_mesh_that_may_change_keeps_nothing),
        cmocka_unit_test(a_copy_that_moves_on_forgets),
        cmocka_unit_test(keeping_fails_cleanly),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
