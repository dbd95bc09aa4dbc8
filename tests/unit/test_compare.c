/* Distances between surfaces: closed forms, and random meshes whose distances are also found at
 * samples by a slow search over all triangles. The environment variables SEED and ROUNDS repeat the
 * random rounds and make them longer. */
#include "tests/unit/dense.h"
#include "tests/unit/random_meshes.h"

#include "compare/comparing.h"
#include "geometry/geometry.h"
#include "geometry/scale.h"
#include "mesh/write.h"
#include "tests/unit/backwards.h"
#include "tests/failing.h"
#include "tests/sanitized.h"
#include "tests/seed.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>

/* Both meshes with their trees. */
typedef struct pair {
    he_mesh *mesh[2];
    he_bvh *tree[2];
    he_compared surface[2];
} pair;

static pair pair_of(he_mesh *takes_a, he_mesh *takes_b)
{
    pair p = {{takes_a, takes_b}, {NULL, NULL}, {{NULL, NULL}}};
    for (int i = 0; i < 2; i++) {
        assert_int_equal(he_bvh_new(p.mesh[i], NULL, &p.tree[i], NULL), HE_OK);
        p.surface[i] = (he_compared){p.mesh[i], p.tree[i]};
    }
    return p;
}

static void pair_clear(pair *p)
{
    for (int i = 0; i < 2; i++) {
        he_bvh_free(p->tree[i]);
        he_mesh_free(p->mesh[i]);
    }
}

static he_comparison compare_with(const pair *p, double bound, uint32_t bins)
{
    he_comparison done;
    he_error err = {0};
    const he_compare_options options = {.bound = bound, .bins = bins};
    if (he_compare(p->surface, &options, NULL, &done, &err) != HE_OK) {
        fail_msg("%s", err.text);
    }
    return done;
}

static he_comparison compare(const pair *p, double bound)
{
    return compare_with(p, bound, 10);
}

/* Requires that distances without means are those that were found with them, up to the bound. */
static void require_alone(const pair *p, const he_comparison *done, double bound, double rounding)
{
    const he_comparison alone = compare_with(p, bound, 0);
    for (int i = 0; i < 2; i++) {
        const he_one_sided *a = &alone.side[i], *b = &done->side[i];
        if (!(a->lower <= b->upper + rounding && b->lower <= a->upper + rounding)) {
            fail_msg("%.17g to %.17g is not %.17g to %.17g", a->lower, a->upper, b->lower,
                     b->upper);
        }
        assert_true(a->mean == 0 && a->rms == 0 && a->share[0] == 0);
        assert_int_equal(a->equal_faces, b->equal_faces);
        assert_true(!alone.complete || a->upper <= a->lower + bound + rounding);
    }
    assert_true(alone.bin_width == 0);
    assert_int_equal(alone.complete, done->complete);
}

static void require_near(double value, double wanted, double tolerance)
{
    if (!(fabs(value - wanted) <= tolerance)) {
        fail_msg("%.17g is not %.17g", value, wanted);
    }
}

/* Requires that both bounds are the distance `wanted`. */
static void require_distance(const he_one_sided *side, double wanted)
{
    require_near(side->lower, wanted, 1e-14);
    require_near(side->upper, wanted, 1e-14);
}

static void move(he_mesh *m, double scale, he_vec3 by)
{
    for (uint32_t v = 0; v < he_mesh_issued(m, HE_VERTEX); v++) {
        const he_vec3 p = he_position(m, (he_vertex){v});
        he_set_position(m, (he_vertex){v}, he_vec3_add(he_vec3_scale(p, scale), by));
    }
}

/* --- closed forms --- */

/* The cube [-1/2, 1/2]^3, which another one is compared with that is shifted by d along x: a point
 * of a side at x = -1/2 has the distance d; one at x = 1/2 is inside the other cube, whose nearest
 * side is min(d, distance from the rim) away; those with -1/2 < x < d - 1/2 have d - 1/2 - x. */
static void shifted_cubes_have_closed_forms(void **state)
{
    (void)state;
    static const double shifts[] = {0.125, 0.3, 1, 2.5};
    for (size_t i = 0; i < sizeof shifts / sizeof *shifts; i++) {
        const double d = shifts[i];
        pair p = pair_of(dense_shape("cube", NULL, 0), dense_shape("cube", NULL, 0));
        he_box box;
        assert_true(he_mesh_box(p.mesh[0], &box));
        const double size = box.max.x - box.min.x;
        pair_clear(&p);
        he_mesh *a = dense_shape("cube", NULL, 0), *b = dense_shape("cube", NULL, 0);
        move(a, 1 / size, (he_vec3){0, 0, 0});
        move(b, 1 / size, (he_vec3){d, 0, 0});
        p = pair_of(a, b);
        const he_comparison done = compare(&p, 1e-6);
        require_distance(&done.side[0], d);
        require_distance(&done.side[1], d);
        assert_true(done.complete);
        const he_comparison alone = compare_with(&p, 1e-6, 0);
        require_distance(&alone.side[0], d);
        require_distance(&alone.side[1], d);
        if (d < 0.5) {
            const double inside = d - 2 * d * d + 4.0 / 3 * d * d * d; /* integral of (1 - 2t)^2 */
            require_near(done.side[0].mean, (d + inside + 2 * d * d) / 6, 1e-3 * d);
            require_near(done.side[1].mean, done.side[0].mean, 1e-3 * d);
        }
        pair_clear(&p);
    }
}

/* The faces of an icosahedron of radius 1 are this far from its middle. */
static const double INNER = 0.79465447229176612;

static void concentric_icosahedra_have_closed_forms(void **state)
{
    (void)state;
    he_mesh *a = dense_shape("icosahedron", NULL, 0), *b = dense_shape("icosahedron", NULL, 0);
    const double radius = he_vec3_length(he_position(a, (he_vertex){0}));
    move(a, 1 / radius, (he_vec3){0, 0, 0});
    move(b, 1.5 / radius, (he_vec3){0, 0, 0});
    pair p = pair_of(a, b);
    const he_comparison done = compare(&p, 1e-6);
    require_distance(&done.side[0], 0.5 * INNER);
    require_distance(&done.side[1], 0.5);
    const he_comparison alone = compare_with(&p, 1e-6, 0);
    require_distance(&alone.side[0], 0.5 * INNER);
    require_distance(&alone.side[1], 0.5);
    require_near(done.side[0].mean, 0.5 * INNER, 1e-12);
    require_near(done.side[0].rms, 0.5 * INNER, 1e-12);
    pair_clear(&p);
}

/* A sphere of triangles whose vertices are on the unit sphere is inside it, and its faces are not
 * more than s^2 / 6 below it if s is their longest side. */
static void concentric_spheres_have_the_difference_of_the_radii(void **state)
{
    (void)state;
    he_mesh *a = dense_shape("icosphere", "subdivisions", 4);
    he_mesh *b = dense_shape("icosphere", "subdivisions", 5);
    double longest = 0;
    for (int i = 0; i < 2; i++) {
        he_mesh *m = i == 0 ? a : b;
        const double radius = he_vec3_length(he_position(m, (he_vertex){0}));
        move(m, (i == 0 ? 1 : 2) / radius, (he_vec3){0, 0, 0});
        for (uint32_t e = 0; e < he_mesh_issued(m, HE_EDGE); e++) {
            longest = fmax(longest, he_edge_length(m, (he_edge){e}));
        }
    }
    pair p = pair_of(a, b);
    const he_comparison done = compare(&p, 1e-4);
    assert_true(done.complete && done.upper <= done.lower + 1e-4 * (1 + 1e-9));
    require_near(done.lower, 1, longest * longest / 3);
    require_near(done.side[0].mean, 1, longest * longest / 3);
    require_alone(&p, &done, 1e-4, 1e-13);
    pair_clear(&p);
}

static void parallel_planes_have_one_distance(void **state)
{
    (void)state;
    he_mesh *a = dense_grid(7, NULL, 1), *b = dense_grid(11, NULL, 1);
    he_box box[2];
    assert_true(he_mesh_box(a, &box[0]) && he_mesh_box(b, &box[1]));
    move(b, (box[0].max.x - box[0].min.x) / (box[1].max.x - box[1].min.x), (he_vec3){0, 0, 0.25});
    pair p = pair_of(a, b);
    const he_comparison done = compare(&p, 1e-9);
    for (int i = 0; i < 2; i++) {
        require_distance(&done.side[i], 0.25);
        require_near(done.side[i].mean, 0.25, 1e-14);
        require_near(done.side[i].rms, 0.25, 1e-14);
        assert_int_equal(done.side[i].equal_faces, 0);
        for (uint32_t k = 0; k < 10; k++) {
            require_near(done.side[i].share[k], k == 9, 1e-12);
        }
    }
    require_alone(&p, &done, 1e-9, 1e-14);
    pair_clear(&p);
}

static void a_mesh_is_equal_to_itself_at_once(void **state)
{
    (void)state;
    he_mesh *m = dense_torus(40);
    pair p = pair_of(m, dense_copy(m));
    const he_comparison done = compare(&p, 1e-300);
    require_distance(&done.side[0], 0);
    require_distance(&done.side[1], 0);
    assert_true(done.complete);
    assert_int_equal(done.side[0].equal_faces, 3200);
    assert_int_equal(done.side[0].pieces + done.side[1].pieces, 0);
    require_near(done.side[0].share[0], 1, 1e-12);
    require_alone(&p, &done, 1e-300, 0);
    pair_clear(&p);
}

static void one_moved_vertex_is_found(void **state)
{
    (void)state;
    he_mesh *m = dense_grid(40, NULL, 1), *moved = dense_copy(m);
    he_vec3 at = he_position(m, (he_vertex){840});
    at.z += 0.01;
    he_set_position(moved, (he_vertex){840}, at);
    pair p = pair_of(moved, m);
    const he_comparison done = compare(&p, 1e-6);
    require_distance(&done.side[0], 0.01);
    require_near(done.side[0].place.point.z, at.z, 1e-15);
    require_near(done.side[0].place.near_point.z, at.z - 0.01, 1e-15);
    assert_int_equal(done.side[0].equal_faces, 3194);
    assert_true(done.side[0].place.face < he_mesh_issued(moved, HE_FACE));
    require_alone(&p, &done, 1e-6, 1e-14);
    pair_clear(&p);
}

static void refusals(void **state)
{
    (void)state;
    he_comparison done;
    he_compare_options options = {.bound = 1, .bins = 10};
    for (int i = 0; i < 2; i++) {
        he_mesh *none = he_mesh_new(), *some = dense_shape("cube", NULL, 0);
        pair p = i == 0 ? pair_of(none, some) : pair_of(some, none);
        assert_int_equal(he_compare(p.surface, &options, NULL, &done, NULL), HE_NO_FACES);
        pair_clear(&p);
    }
    pair p = pair_of(dense_shape("cube", NULL, 0), dense_shape("cube", NULL, 0));
    static const double bounds[] = {0, -1, NAN, INFINITY};
    for (size_t i = 0; i < 4; i++) {
        options.bound = bounds[i];
        assert_int_equal(he_compare(p.surface, &options, NULL, &done, NULL),
                         i < 2 ? HE_BAD_VALUE : HE_NOT_FINITE);
    }
    options = (he_compare_options){.bound = 1, .bins = HE_COMPARE_BINS + 1};
    assert_int_equal(he_compare(p.surface, &options, NULL, &done, NULL), HE_BAD_VALUE);
    options.bins = 1;
    pair_clear(&p);
    for (int i = 0; i < 2; i++) {
        he_mesh *small = dense_shape("cube", NULL, 0), *large = dense_shape("cube", NULL, 0);
        move(large, 0x1p95, (he_vec3){0, 0, 0});
        p = i == 0 ? pair_of(small, large) : pair_of(large, small);
        assert_int_equal(he_compare(p.surface, &options, NULL, &done, NULL), HE_LIMIT);
        pair_clear(&p);
    }
}

/* --- random meshes --- */

/* Returns a random point of a random triangle of a tree. */
static he_vec3 random_point(const he_compared *s, md_random *r)
{
    const he_bvh_triangle *t = &s->tree->triangles[md_below(r, s->tree->count)];
    double u = md_unit(r), v = md_unit(r);
    if (u + v > 1) {
        u = 1 - u;
        v = 1 - v;
    }
    const double w[3] = {1 - u - v, u, v};
    he_vec3 p = {0, 0, 0};
    for (int k = 0; k < 3; k++) {
        p = he_vec3_add(p, he_vec3_scale(he_position(s->mesh, (he_vertex){t->vertex[k]}), w[k]));
    }
    return p;
}

static double to_segment(he_vec3 p, he_vec3 a, he_vec3 b)
{
    const he_vec3 ab = he_vec3_sub(b, a), ap = he_vec3_sub(p, a);
    const double length = he_vec3_dot(ab, ab);
    const double t = length > 0 ? fmin(fmax(he_vec3_dot(ap, ab) / length, 0), 1) : 0;
    return he_vec3_length(he_vec3_sub(ap, he_vec3_scale(ab, t)));
}

/* Returns the distance of a point from a triangle: from its plane if the point is above the inside,
 * else from the nearest side. */
static double to_triangle(he_vec3 p, const he_vec3 c[3])
{
    double best = INFINITY;
    he_vec3 n = he_vec3_cross(he_vec3_sub(c[1], c[0]), he_vec3_sub(c[2], c[0]));
    bool above = he_vec3_length(n) > 0;
    for (int k = 0; k < 3; k++) {
        const he_vec3 side = he_vec3_sub(c[(k + 1) % 3], c[k]);
        above = above && he_vec3_dot(he_vec3_cross(n, side), he_vec3_sub(p, c[k])) > 0;
        best = fmin(best, to_segment(p, c[k], c[(k + 1) % 3]));
    }
    return above ? fmin(best, fabs(he_vec3_dot(he_vec3_sub(p, c[0]), n)) / he_vec3_length(n))
                 : best;
}

/* Coordinates are scaled so that their products cannot overflow. */
static double to_surface(he_vec3 p, const he_compared *s)
{
    const int own = he_exponent_of(he_vec3_extent(p));
    const int exponent = own > s->tree->exponent ? own : s->tree->exponent;
    const double scale = ldexp(1, -exponent);
    double best = INFINITY;
    p = he_vec3_scale(p, scale);
    for (uint32_t i = 0; i < s->tree->count; i++) {
        he_vec3 c[3];
        for (int k = 0; k < 3; k++) {
            c[k] = he_position(s->mesh, (he_vertex){s->tree->triangles[i].vertex[k]});
            c[k] = he_vec3_scale(c[k], scale);
        }
        best = fmin(best, to_triangle(p, c));
    }
    return ldexp(best, exponent);
}

static double magnitude(const pair *p)
{
    double most = 0;
    for (int i = 0; i < 2; i++) {
        he_box box;
        if (he_mesh_box(p->mesh[i], &box)) {
            most = fmax(most, fmax(he_vec3_extent(box.min), he_vec3_extent(box.max)));
        }
    }
    return most;
}

/* Requires what holds for every comparison, with or without means. */
static void require_sound(const pair *p, const he_comparison *done, double bound, bool has_means)
{
    const double rounding = 1e-9 * magnitude(p);
    require_near(done->lower, fmax(done->side[0].lower, done->side[1].lower), 0);
    require_near(done->upper, fmax(done->side[0].upper, done->side[1].upper), 0);
    for (int i = 0; i < 2; i++) {
        const he_one_sided *side = &done->side[i];
        assert_true(side->lower >= 0 && side->lower <= side->upper);
        assert_true(!done->complete || side->upper <= side->lower + bound + rounding);
        assert_true(side->mean >= 0 && side->mean <= side->rms + rounding);
        assert_true(side->rms <= side->upper + rounding);
        assert_true(he_mesh_is_live(p->mesh[i], HE_FACE, side->place.face));
        assert_true(he_mesh_is_live(p->mesh[1 - i], HE_FACE, side->place.near_face));
        double distance;
        he_direction(side->place.point, side->place.near_point, &distance);
        require_near(distance, side->lower, rounding);
        require_near(to_surface(side->place.point, &p->surface[1 - i]), side->lower, rounding);
        require_near(to_surface(side->place.point, &p->surface[i]), 0, rounding);
        require_near(to_surface(side->place.near_point, &p->surface[1 - i]), 0, rounding);
        double sum = 0;
        for (uint32_t k = 0; k < 10; k++) {
            assert_true(side->share[k] >= 0);
            sum += side->share[k];
        }
        require_near(sum, has_means, 1e-9);
    }
}

static void require_symmetric(const pair *p, const he_comparison *done, double bound, uint32_t bins)
{
    const pair other = {
        .mesh = {p->mesh[1], p->mesh[0]},
        .tree = {p->tree[1], p->tree[0]},
        .surface = {p->surface[1], p->surface[0]},
    };
    const he_comparison back = compare_with(&other, bound, bins);
    for (int i = 0; i < 2; i++) {
        require_near(back.side[i].lower, done->side[1 - i].lower, 0);
        require_near(back.side[i].upper, done->side[1 - i].upper, 0);
        require_near(back.side[i].mean, done->side[1 - i].mean, 0);
    }
}

static bool tell(void *context, const char *phase, double done)
{
    long *left = context;
    (void)phase;
    (void)done;
    return --*left != 0;
}

static void require_clean_cancel(const pair *p, md_random *r, double bound, uint32_t bins)
{
    he_progress progress;
    long left = md_from(r, 1, 20);
    he_comparison done = {.lower = -1};
    const he_compare_options options = {.bound = bound, .bins = bins};
    he_progress_init(&progress, tell, &left);
    he_status status = he_compare(p->surface, &options, &progress, &done, NULL);
    assert_true(status == HE_OK || (status == HE_CANCELLED && done.lower < 0));
}

/* Makes a second mesh: another one of any family, or a copy with some vertices moved. */
static he_mesh *make_other(const he_mesh *m, md_random *r)
{
    if (md_chance(r, 30)) {
        he_mesh *other = random_families[md_below(r, RANDOM_FAMILIES)].make(r);
        if (he_mesh_faces(other) > 0) {
            return other;
        }
        he_mesh_free(other);
    }
    he_mesh *copy = dense_copy(m);
    const double size = pow(10, -(double)md_below(r, 6));
    he_box box;
    (void)he_mesh_box(m, &box);
    const double extent = he_vec3_extent(he_vec3_sub(box.max, box.min)) * size;
    for (uint32_t v = 0; v < he_mesh_issued(copy, HE_VERTEX); v++) {
        he_vec3 p = he_position(copy, (he_vertex){v});
        if (md_chance(r, 30)) {
            p = he_vec3_add(p, (he_vec3){extent * (md_unit(r) - 0.5), extent * (md_unit(r) - 0.5),
                                         extent * (md_unit(r) - 0.5)});
            he_set_position(copy, (he_vertex){v}, p);
        }
    }
    return copy;
}

static void play(const random_family *of, md_random *r)
{
    he_mesh *m = of->make(r);
    if (he_mesh_faces(m) == 0) {
        he_mesh_free(m);
        return;
    }
    pair p = pair_of(m, make_other(m, r));
    const double bound =
        he_compare_default_bound(p.surface) * (md_chance(r, 20) ? 0.1 : 1 + 30 * md_unit(r));
    if (abs(p.tree[0]->exponent - p.tree[1]->exponent) > 90) {
        he_comparison none;
        const he_compare_options options = {.bound = 1, .bins = 1};
        assert_int_equal(he_compare(p.surface, &options, NULL, &none, NULL), HE_LIMIT);
        pair_clear(&p);
        return;
    }
    const uint32_t bins = md_chance(r, 50) ? 10 : 0;
    const he_comparison done = compare_with(&p, bound, bins);
    /* Far from the origin of coordinates the bound may be smaller than rounding errors. */
    if (!done.complete && bound > 1e-14 * magnitude(&p)) {
        fail_msg("%s: bound %g, coordinates up to %g", of->name, bound, magnitude(&p));
    }
    require_sound(&p, &done, bound, bins > 0);
    for (int k = 0; k < 40; k++) {
        const int i = k % 2;
        const double distance = to_surface(random_point(&p.surface[i], r), &p.surface[1 - i]);
        if (!(distance <= done.side[i].upper + 1e-9 * magnitude(&p))) {
            fail_msg("%s: distance %.17g is above %.17g", of->name, distance, done.side[i].upper);
        }
    }
    if (md_chance(r, 10)) {
        require_symmetric(&p, &done, bound, bins);
        require_clean_cancel(&p, r, bound, bins);
    }
    pair_clear(&p);
}

static void random_meshes_have_sound_bounds(void **state)
{
    (void)state;
    const uint64_t seed = seed_of_run(), rounds = seed_setting("ROUNDS", SANITIZED ? 100 : 500);
    for (uint64_t i = 0; i < rounds; i++) {
        md_random r = {seed + i};
        play(&random_families[(seed + i) % RANDOM_FAMILIES], &r);
    }
    printf("note: %llu random pairs of meshes\n", (unsigned long long)rounds);
}

static void no_sample_is_outside_the_bounds(void **state)
{
    (void)state;
    enum { SAMPLES = SANITIZED ? 100000 : 1000000 };
    md_random r = {seed_of_run()};
    he_mesh *m = dense_torus(60), *simpler = dense_copy(m);
    (void)dense_decimate(simpler, 600, INFINITY);
    pair p = pair_of(m, simpler);
    const double bound = he_compare_default_bound(p.surface) / 10;
    const he_comparison done = compare(&p, bound);
    assert_true(done.complete);
    double most[2] = {0, 0}, sum[2] = {0, 0};
    for (int k = 0; k < SAMPLES; k++) {
        const int i = k % 2;
        he_hit hit;
        he_budget budget = {.left = UINT64_MAX};
        const he_vec3 at = random_point(&p.surface[i], &r);
        assert_int_equal(
            he_bvh_closest(p.tree[1 - i], p.mesh[1 - i], at, INFINITY, &budget, &hit, NULL), HE_OK);
        most[i] = fmax(most[i], hit.distance);
        sum[i] += hit.distance;
    }
    for (int i = 0; i < 2; i++) {
        const he_one_sided *side = &done.side[i];
        print_message("note: %.7f to %.7f, farthest sample %.7f; mean %.7f\n", side->lower,
                      side->upper, most[i], side->mean);
        assert_true(most[i] <= side->upper + 1e-12 && side->upper <= side->lower + bound + 1e-12);
        assert_true(most[i] >= 0.8 * side->lower);
    }
    require_alone(&p, &done, bound, 1e-12);
    const he_comparison alone = compare_with(&p, bound, 0);
    assert_true(alone.complete && most[0] <= alone.side[0].upper + 1e-12 &&
                most[1] <= alone.side[1].upper + 1e-12);
    pair_clear(&p);
}

static void the_order_of_the_parts_does_not_matter(void **state)
{
    (void)state;
    he_mesh *bent = dense_torus(60);
    for (uint32_t v = 0; v < he_mesh_vertices(bent); v++) {
        const he_vec3 p = he_position(bent, (he_vertex){v});
        he_set_position(bent, (he_vertex){v}, (he_vec3){p.x, p.y, p.z + 0.02 * sin(7 * p.x)});
    }
    pair p = pair_of(dense_torus(60), bent);
    static he_comparison alone, parts; /* static, so that padding is equal */
    for (uint32_t bins = 0; bins <= 10; bins += 10) {
        const he_compare_options options = {.bound = 1e-3, .bins = bins};
        he_progress progress;
        uint32_t count;
        backwards_lend(&progress, &count);
        assert_int_equal(he_compare(p.surface, &options, NULL, &alone, NULL), HE_OK);
        assert_int_equal(he_compare(p.surface, &options, &progress, &parts, NULL), HE_OK);
        assert_true(count >= (bins > 0 ? 16 : 8)); /* four parts of each loop */
        assert_memory_equal(&alone, &parts, sizeof alone);
    }
    pair_clear(&p);
}

/* Takes steps until none are left. */
static he_status take_all(he_comparing *part, uint32_t from, uint32_t to, he_error *err)
{
    (void)from;
    (void)to;
    uint64_t *taken = part->upper == NULL ? NULL : (uint64_t *)(void *)part->upper;
    he_status status = he_budget_take(&part->budget, 1, err);
    while (status == HE_OK) {
        ++*taken;
        status = he_budget_take(&part->budget, 1, err);
    }
    return status;
}

static void a_part_takes_no_more_steps_than_are_left(void **state)
{
    (void)state;
    enum { STEPS = 1000 };
    he_mesh *torus = dense_torus(60);
    pair p = pair_of(torus, dense_shape("cube", NULL, 0));
    he_progress progress;
    uint32_t count;
    union {
        uint64_t steps;
        double unused;
    } taken = {.steps = 0};
    backwards_lend(&progress, &count);
    he_comparing c = {.from = p.surface[0],
                      .to = p.surface[1],
                      .budget = {.left = STEPS, .progress = &progress},
                      .triangle = HE_NONE,
                      .upper = &taken.unused};
    assert_int_equal(he_compare_in_parts(&c, take_all, NULL), HE_LIMIT);
    assert_true(count >= 4);
    /* Each part once on the threads that are lent, and the first one again. */
    assert_int_equal(taken.steps, (count + 1) * STEPS);
    assert_int_equal(c.budget.left, 0);
    pair_clear(&p);
}

static void too_few_pieces_leave_wider_bounds(void **state)
{
    (void)state;
    he_mesh *m = dense_torus(40), *simpler = dense_copy(m);
    (void)dense_decimate(simpler, 300, INFINITY);
    pair p = pair_of(m, simpler);
    const double bound = he_compare_default_bound(p.surface) / 100;
    const he_comparison narrow = compare(&p, bound);
    he_comparison wide;
    const he_compare_options options = {.bound = bound, .bins = 10, .most_pieces = 10};
    assert_int_equal(he_compare(p.surface, &options, NULL, &wide, NULL), HE_OK);
    assert_true(narrow.complete && !wide.complete);
    assert_true(wide.lower <= narrow.upper && wide.upper >= narrow.lower);
    assert_true(wide.upper - wide.lower > narrow.upper - narrow.lower);
    pair_clear(&p);
}

static void every_allocation_may_fail(void **state)
{
    (void)state;
    he_mesh *m = dense_torus(16), *simpler = dense_copy(m);
    (void)dense_decimate(simpler, 100, INFINITY);
    pair p = pair_of(m, simpler);
    for (uint32_t bins = 0; bins <= 10; bins += 10) {
        const he_compare_options options = {.bound = 1e-4, .bins = bins};
        failing f = {0};
        while (failing_next(&f)) {
            he_comparison done = {.lower = -1};
            if (!failing_status(&f, he_compare(p.surface, &options, NULL, &done, NULL))) {
                assert_true(done.lower < 0);
            }
        }
    }
    pair_clear(&p);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(shifted_cubes_have_closed_forms),
        cmocka_unit_test(concentric_icosahedra_have_closed_forms),
        cmocka_unit_test(concentric_spheres_have_the_difference_of_the_radii),
        cmocka_unit_test(parallel_planes_have_one_distance),
        cmocka_unit_test(a_mesh_is_equal_to_itself_at_once),
        cmocka_unit_test(one_moved_vertex_is_found),
        cmocka_unit_test(refusals),
        cmocka_unit_test(random_meshes_have_sound_bounds),
        cmocka_unit_test(no_sample_is_outside_the_bounds),
        cmocka_unit_test(the_order_of_the_parts_does_not_matter),
        cmocka_unit_test(a_part_takes_no_more_steps_than_are_left),
        cmocka_unit_test(too_few_pieces_leave_wider_bounds),
        cmocka_unit_test(every_allocation_may_fail),
    };
    return cmocka_run_group_tests_name("compare", tests, NULL, NULL);
}
