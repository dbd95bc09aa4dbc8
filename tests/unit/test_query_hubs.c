/* Tests of the search for intersections where very many triangles meet at one position, the hub.
 * The search must find the same pairs as testing all pairs, in a number of steps that is about
 * proportional to the number of triangles, not to its square. */
#include "query_specimens.h"

#include "geometry/triangle_intersection.h"
#include "geometry/scale.h"
#include "triangle_intersection_oracle.h"
#include "query/bvh.h"
#include "tests/seed.h"
#include "tests/failing.h"

#include <math.h>

static double uniform(uint64_t *seed, double low, double high)
{
    return low + (high - low) * ldexp((double)(query_random(seed) >> 11), -53);
}

static uint32_t below(uint64_t *seed, uint32_t most)
{
    return (uint32_t)(query_random(seed) % most);
}

/* --- test meshes: triangles that share positions, but no vertices --- */

enum { MOST = 400 };

typedef struct specimen {
    he_vec3 corner[MOST][3];
    uint32_t count;
} specimen;

static void add(specimen *s, he_vec3 a, he_vec3 b, he_vec3 c)
{
    if (s->count < MOST) {
        s->corner[s->count][0] = a;
        s->corner[s->count][1] = b;
        s->corner[s->count++][2] = c;
    }
}

static he_vec3 around(double turn, double radius, double z)
{
    return (he_vec3){radius * cos(turn), radius * sin(turn), z};
}

/* Returns a position whose coordinates are whole numbers from -3 to 3. */
static he_vec3 on_grid(uint64_t *seed)
{
    he_vec3 p = {(double)below(seed, 7), (double)below(seed, 7), (double)below(seed, 7)};
    return he_vec3_sub(p, (he_vec3){3, 3, 3});
}

/* A cone of triangles with its tip at `hub`. Its rim is higher than the tip by z; if z is 0, the
 * cone is a flat disc. The rim goes around the axis `turns` times. */
typedef struct cone {
    he_vec3 hub;
    double z, turns, radius;
} cone;

/* Adds a cone of n triangles, which all meet at the cone's tip. */
static void fan(specimen *s, uint32_t n, cone c)
{
    for (uint32_t i = 0; i < n; i++) {
        double step = c.turns * 2 * HE_PI / n;
        he_vec3 from = around(i * step, c.radius, c.z);
        he_vec3 to = around((c.turns == 1 ? (i + 1) % n : i + 1) * step, c.radius, c.z);
        add(s, c.hub, he_vec3_add(c.hub, from), he_vec3_add(c.hub, to));
    }
}

/* Adds n triangles from `hub` to random points of a small grid. The grid is so small that the
 * triangles include equal directions, folds, equal triangles and triangles without area. */
static void burst(specimen *s, uint64_t *seed, uint32_t n, he_vec3 hub, bool is_flat)
{
    for (uint32_t i = 0; i < n; i++) {
        he_vec3 a = on_grid(seed), b = on_grid(seed);
        if (is_flat) {
            a.z = a.x + 2 * a.y;
            b.z = b.x + 2 * b.y;
        }
        add(s, he_vec3_add(hub, a), hub, he_vec3_add(hub, b));
    }
}

/* Adds n triangles that share an edge at `hub`, like the pages of a book. Some of the triangles are
 * equal. */
static void book(specimen *s, uint64_t *seed, uint32_t n, he_vec3 hub)
{
    for (uint32_t i = 0; i < n; i++) {
        he_vec3 page = around(below(seed, 40) * 0.15, 1 + below(seed, 3), 0.25);
        add(s, hub, he_vec3_add(hub, (he_vec3){0, 0, 1}), he_vec3_add(hub, page));
    }
}

static void litter(specimen *s, uint64_t *seed, uint32_t n)
{
    for (uint32_t i = 0; i < n; i++) {
        he_vec3 at = {uniform(seed, -2, 2), uniform(seed, -2, 2), uniform(seed, -1, 1)};
        he_vec3 p[2];
        for (int k = 0; k < 2; k++) {
            he_vec3 way = {uniform(seed, -1, 1), uniform(seed, -1, 1), uniform(seed, -1, 1)};
            p[k] = he_vec3_add(at, he_vec3_scale(way, 0.4));
        }
        add(s, at, p[0], p[1]);
    }
}

static void make(specimen *s, uint64_t *seed, unsigned kind)
{
    const he_vec3 zero = {0, 0, 0}, up = {0, 0, 1}, aside = {1, 2, -1};
    uint32_t n = 33 + below(seed, 60);
    switch (kind) {
    case 0: /* a disc, which may go around its centre more than once */
        fan(s, n, (cone){zero, 0, 1 + below(seed, 3), 1});
        break;
    case 1: /* nested cones */
        fan(s, n, (cone){zero, -1, 1, 1});
        fan(s, n, (cone){below(seed, 2) == 0 ? zero : up, -1, 1, 0.7});
        break;
    case 2: /* a cone closed by a disc, and a second cone that touches the tip of the first */
        fan(s, n, (cone){up, -1, 1, 1});
        fan(s, n, (cone){zero, 0, 1, 1});
        fan(s, n, (cone){up, 1, 1, 1});
        break;
    case 3:
        burst(s, seed, n, zero, true);
        break;
    case 4:
        burst(s, seed, n, aside, false);
        burst(s, seed, n, zero, true);
        break;
    case 5:
        book(s, seed, n, aside);
        fan(s, n, (cone){aside, 0.5, 2, 1});
        break;
    default: /* hubs and ordinary triangles together */
        fan(s, n, (cone){zero, 0.1, 1, 2});
        burst(s, seed, 40, zero, false);
        litter(s, seed, 60);
        break;
    }
}

/* Rotates the triangles, so that no plane is parallel to an axis, and translates them. */
static void turn(specimen *s, uint64_t *seed)
{
    he_vec3 x = {uniform(seed, -1, 1), uniform(seed, -1, 1), 0.3}, y = {0.2, 0.9, -0.7};
    he_vec3 z = he_vec3_cross(x, y), by = {uniform(seed, -9, 9), 3, uniform(seed, -9, 9)};
    for (uint32_t i = 0; i < s->count; i++) {
        for (int k = 0; k < 3; k++) {
            he_vec3 p = s->corner[i][k];
            p = he_vec3_add(he_vec3_add(he_vec3_scale(x, p.x), he_vec3_scale(y, p.y)),
                            he_vec3_scale(z, p.z));
            s->corner[i][k] = he_vec3_add(p, by);
        }
    }
}

static he_mesh *mesh_of(const specimen *s)
{
    he_soup soup;
    he_mesh *m = NULL;
    he_soup_init(&soup, NULL);
    for (uint32_t i = 0; i < s->count; i++) {
        const uint32_t corners[3] = {3 * i, 3 * i + 1, 3 * i + 2};
        for (int k = 0; k < 3; k++) {
            assert_int_equal(he_soup_add_vertex(&soup, s->corner[i][k], NULL), HE_OK);
        }
        assert_int_equal(he_soup_add_face(&soup, corners, 3, NULL), HE_OK);
    }
    assert_int_equal(he_build(&soup, HE_BUILD_TAKE, &m, NULL, NULL), HE_OK);
    he_soup_clear(&soup);
    return m;
}

/* --- the search must find the pairs that a test of all pairs finds --- */

static void expect_pairs(const specimen *s, uint64_t seed)
{
    he_mesh *m = mesh_of(s);
    he_bvh *tree = NULL;
    he_ids pairs = {0};
    he_budget budget = {.left = UINT64_MAX};
    bool complete;
    assert_int_equal(he_bvh_new(m, NULL, &tree, NULL), HE_OK);
    assert_true(tree->hubs.count > 0);
    assert_int_equal(he_bvh_intersections(tree, m, SIZE_MAX, &budget, &pairs, &complete, NULL),
                     HE_OK);
    assert_true(complete);
    size_t at = 0;
    for (uint32_t i = 0; i < s->count; i++) {
        for (uint32_t k = i + 1; k < s->count; k++) {
            bool meet = oracle_triangles_meet(s->corner[i], s->corner[k]);
            bool told = at < pairs.count && pairs.ids[at] == i && pairs.ids[at + 1] == k;
            if (he_triangles_intersect(s->corner[i], s->corner[k]) != meet || told != meet) {
                fail_msg("SEED=%llu: faces %u and %u of %u", (unsigned long long)seed, i, k,
                         s->count);
            }
            at += told ? 2 : 0;
        }
    }
    assert_int_equal(at, pairs.count);
    he_ids_clear(&pairs);
    he_bvh_free(tree);
    he_mesh_free(m);
}

static void pairs_at_a_hub_are_those_that_trying_all_finds(void **state)
{
    (void)state;
    uint64_t first = seed_of_run();
    specimen *s = malloc(sizeof *s);
    assert_non_null(s);
    for (unsigned round = 0; round < 70; round++) {
        uint64_t seed = first + round;
        s->count = 0;
        make(s, &seed, round % 7);
        if (below(&seed, 2) == 0) {
            turn(s, &seed);
        }
        expect_pairs(s, first);
    }
    free(s);
}

/* --- the number of steps must be proportional to the number of triangles --- */

typedef struct searched {
    uint64_t steps;
    size_t pairs;
    bool complete;
} searched;

static searched search_for(const he_mesh *m, uint64_t most)
{
    he_bvh *tree = NULL;
    he_ids pairs = {0};
    he_budget budget = {.left = most};
    searched out;
    assert_int_equal(he_bvh_new(m, NULL, &tree, NULL), HE_OK);
    assert_int_equal(
        he_bvh_intersections(tree, m, (size_t)1 << 20, &budget, &pairs, &out.complete, NULL),
        HE_OK);
    out.steps = most - budget.left;
    out.pairs = pairs.count / 2;
    he_ids_clear(&pairs);
    he_bvh_free(tree);
    return out;
}

/* Makes a fan of n triangles around one vertex, which is higher than the rim of the fan by z. If
 * `is_closed`, a second fan below the first closes the mesh. */
static he_mesh *fan_mesh(uint32_t n, double z, bool is_closed, bool is_tilted)
{
    he_soup soup;
    he_mesh *m = NULL;
    he_soup_init(&soup, NULL);
    for (uint32_t i = 0; i < n + 1 + is_closed; i++) {
        he_vec3 p = i < n ? around(i * 2 * HE_PI / n, 1, 0) : (he_vec3){0, 0, i == n ? z : -1};
        p.z += is_tilted ? 0.7 * p.x - 0.4 * p.y : 0;
        assert_int_equal(he_soup_add_vertex(&soup, p, NULL), HE_OK);
    }
    for (uint32_t i = 0; i < n; i++) {
        const uint32_t up[3] = {n, i, (i + 1) % n}, down[3] = {n + 1, (i + 1) % n, i};
        assert_int_equal(he_soup_add_face(&soup, up, 3, NULL), HE_OK);
        assert_true(!is_closed || he_soup_add_face(&soup, down, 3, NULL) == HE_OK);
    }
    assert_int_equal(he_build(&soup, HE_BUILD_TAKE, &m, NULL, NULL), HE_OK);
    he_soup_clear(&soup);
    return m;
}

/* If two hubs share a rim, the bounding boxes around the triangles of one fan overlap the boxes of
 * the other fan. The search then takes more steps, but still fewer than a test of all pairs. */
static void a_hub_is_searched_in_steps_that_grow_with_its_spokes(void **state)
{
    (void)state;
    static const struct {
        double z;
        bool is_closed, is_tilted;
    } rows[] = {
        {0, false, false}, {0, false, true}, {1, false, false}, {1, true, false}, {1, true, true}};
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        uint64_t last = 0;
        for (uint32_t n = 1000; n <= 4000; n *= 4) {
            he_mesh *m = fan_mesh(n, rows[i].z, rows[i].is_closed, rows[i].is_tilted);
            searched found = search_for(m, UINT64_MAX - 1);
            assert_true(found.complete && found.pairs == 0);
            uint64_t most = rows[i].is_closed ? 13 * last : 100 * (uint64_t)n;
            if (found.steps > most && most > 0) {
                fail_msg("row %zu: %u spokes take %llu steps", i, n,
                         (unsigned long long)found.steps);
            }
            last = found.steps;
            /* The search must count its steps exactly: if the limit is this number of steps, the
             * search completes; if the limit is one step less, it does not. */
            assert_int_equal(search_for(m, found.steps).steps, found.steps);
            assert_true(search_for(m, found.steps).complete);
            assert_false(search_for(m, found.steps - 1).complete);
            he_mesh_free(m);
        }
    }
}

/* All triangles into which a polygon is cut share the polygon's first corner, so they must not be
 * tested against each other. */
static void a_wide_polygon_is_not_tried_with_itself(void **state)
{
    (void)state;
    enum { CORNERS = 8000 };
    he_soup soup;
    he_mesh *m = NULL;
    uint32_t corners[CORNERS];
    he_soup_init(&soup, NULL);
    for (uint32_t i = 0; i < CORNERS; i++) {
        corners[i] = i;
        assert_int_equal(he_soup_add_vertex(&soup, around(i * 2 * HE_PI / CORNERS, 1, 0), NULL),
                         HE_OK);
    }
    assert_int_equal(he_soup_add_face(&soup, corners, CORNERS, NULL), HE_OK);
    assert_int_equal(he_build(&soup, HE_BUILD_TAKE, &m, NULL, NULL), HE_OK);
    he_soup_clear(&soup);
    searched found = search_for(m, 100 * CORNERS);
    assert_true(found.complete && found.pairs == 0);
    he_mesh_free(m);
}

/* --- limits --- */

static void a_full_list_of_pairs_ends_the_search(void **state)
{
    (void)state;
    specimen *s = calloc(1, sizeof *s);
    assert_non_null(s);
    fan(s, 200, (cone){(he_vec3){0, 0, 0}, 0, 40, 1});
    he_mesh *m = mesh_of(s);
    he_bvh *tree = NULL;
    he_ids pairs = {0};
    he_budget budget = {.left = UINT64_MAX};
    bool complete;
    assert_int_equal(he_bvh_new(m, NULL, &tree, NULL), HE_OK);
    assert_int_equal(he_bvh_intersections(tree, m, 500, &budget, &pairs, &complete, NULL), HE_OK);
    assert_false(complete);
    assert_int_equal(pairs.count, 2 * 500);
    he_ids_clear(&pairs);
    he_bvh_free(tree);
    he_mesh_free(m);
    free(s);
}

typedef struct patience {
    uint64_t calls, most;
} patience;

static bool ask(void *context, const char *phase, double done)
{
    patience *p = context;
    assert_true(phase[0] != '\0' && done <= 1);
    return p->calls++ < p->most;
}

/* However many pairs of triangles there are, a cancelled search must end within a known number of
 * steps. */
static void a_search_at_a_hub_ends_when_it_is_given_up(void **state)
{
    (void)state;
    specimen *s = calloc(1, sizeof *s);
    uint64_t seed = 7;
    assert_non_null(s);
    burst(s, &seed, MOST, (he_vec3){0, 0, 0}, true);
    he_mesh *m = mesh_of(s);
    he_bvh *tree = NULL;
    assert_int_equal(he_bvh_new(m, NULL, &tree, NULL), HE_OK);
    for (uint64_t most = 1; most < 20; most += 6) {
        patience p = {.most = most};
        he_progress progress;
        he_progress_init(&progress, ask, &p);
        he_budget budget = {.left = UINT64_MAX, .progress = &progress};
        he_ids pairs = {0};
        bool complete;
        assert_int_equal(he_bvh_intersections(tree, m, SIZE_MAX, &budget, &pairs, &complete, NULL),
                         HE_CANCELLED);
        assert_true(UINT64_MAX - budget.left <= (most + 1) * HE_BUDGET_STRIDE);
        assert_int_equal(pairs.count, 0);
        he_ids_clear(&pairs);
    }
    he_bvh_free(tree);
    he_mesh_free(m);
    free(s);
}

static void starved_hubs_say_so(void **state)
{
    (void)state;
    he_mesh *m = fan_mesh(60, 1, true, false);
    failing f = {.may_succeed = true};
    while (failing_next(&f)) {
        he_bvh *tree = NULL;
        he_ids pairs = {0};
        he_budget budget = {.left = UINT64_MAX};
        bool complete = false;
        he_status status = he_bvh_new(m, NULL, &tree, NULL);
        if (status == HE_OK) {
            status = he_bvh_intersections(tree, m, 1000, &budget, &pairs, &complete, NULL);
        }
        /* If shrinking a block fails, the block stays as it is, so the search may succeed
         * nevertheless. */
        assert_true(!failing_status(&f, status) || complete);
        assert_int_equal(pairs.count, 0);
        he_ids_clear(&pairs);
        he_bvh_free(tree);
    }
    he_mesh_free(m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pairs_at_a_hub_are_those_that_trying_all_finds),
        cmocka_unit_test(a_hub_is_searched_in_steps_that_grow_with_its_spokes),
        cmocka_unit_test(a_wide_polygon_is_not_tried_with_itself),
        cmocka_unit_test(a_full_list_of_pairs_ends_the_search),
        cmocka_unit_test(a_search_at_a_hub_ends_when_it_is_given_up),
        cmocka_unit_test(starved_hubs_say_so),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
