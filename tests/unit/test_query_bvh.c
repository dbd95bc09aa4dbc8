/* Tests of the queries that use a tree of bounding boxes: rays, nearest points and
 * self-intersections are compared with testing all triangles. */
#include "query_specimens.h"

#include "edit/local/vertex.h"
#include "geometry/orient.h"
#include "geometry/triangle_intersection.h"
#include "query/bvh.h"
#include "query/bvh_disc.h"
#include "query/bvh_walk.h"
#include "tests/failing.h"

#include <float.h>
#include <limits.h>
#include <math.h>

static he_bvh *tree_of(const he_mesh *m)
{
    he_bvh *tree = NULL;
    assert_int_equal(he_bvh_new(m, NULL, &tree, NULL), HE_OK);
    return tree;
}

static he_hit cast(const he_bvh *tree, const he_mesh *m, he_vec3 from, he_vec3 to, double max)
{
    he_hit hit;
    he_budget budget = {.left = UINT64_MAX};
    assert_int_equal(he_bvh_ray(tree, m, &(he_ray){from, to, max}, &budget, &hit, NULL), HE_OK);
    return hit;
}

static he_hit closest(const he_bvh *tree, const he_mesh *m, he_vec3 p, double max)
{
    he_hit hit;
    he_budget budget = {.left = UINT64_MAX};
    assert_int_equal(he_bvh_closest(tree, m, p, max, &budget, &hit, NULL), HE_OK);
    return hit;
}

/* Requires that the face, point, weights and distance of a hit are consistent with each other. */
static void check_hit(const he_mesh *m, const he_hit *hit)
{
    he_vec3 sum = {0, 0, 0};
    double weights = 0;
    assert_true(he_face_is_live(m, (he_face){hit->face}));
    for (int k = 0; k < 3; k++) {
        assert_true(hit->weight[k] >= 0);
        weights += hit->weight[k];
        sum = he_vec3_add(sum, he_vec3_scale(m->c.position[hit->vertex[k]], hit->weight[k]));
        he_halfedge first = he_face_halfedge(m, (he_face){hit->face}), h = first;
        while (he_origin(m, h).i != hit->vertex[k]) {
            h = he_next(m, h);
            assert_int_not_equal(h.i, first.i);
        }
    }
    assert_true(fabs(weights - 1) < 1e-12);
    double size = fmax(he_vec3_extent(sum), 1);
    assert_true(he_vec3_extent(he_vec3_sub(sum, hit->point)) <= 1e-12 * size);
}

/* --- rays --- */

/* Returns the distance at which a ray hits the triangle, by the method of Moeller and Trumbore
 * (1997). The tree of bounding boxes uses another method, which is more exact at edges. */
static double ray_triangle(he_vec3 o, he_vec3 d, he_vec3 a, he_vec3 b, he_vec3 c)
{
    he_vec3 u = he_vec3_sub(b, a), v = he_vec3_sub(c, a), p = he_vec3_cross(d, v);
    he_vec3 s = he_vec3_sub(o, a), q = he_vec3_cross(s, u);
    double det = he_vec3_dot(u, p), x = he_vec3_dot(s, p) / det, y = he_vec3_dot(d, q) / det;
    double t = he_vec3_dot(v, q) / det;
    return det != 0 && x >= 0 && y >= 0 && x + y <= 1 && t >= 0 ? t : HUGE_VAL;
}

static void rays_hit_what_trying_all_triangles_finds(void **state)
{
    (void)state;
    uint64_t seed = 11;
    int hits = 0, misses = 0;
    for (int round = 0; round < 60; round++) {
        he_mesh *m = query_tangle(&seed);
        he_bvh *tree = tree_of(m);
        for (int i = 0; i < 100; i++) {
            he_vec3 o = query_random_point(&seed, 2), d = query_random_point(&seed, 1);
            double unit = he_vec3_length(d), best = HUGE_VAL;
            he_vec3 along = he_vec3_scale(d, 1 / unit);
            for (uint32_t t = 0; t < tree->count; t++) {
                const uint32_t *v = tree->triangles[t].vertex;
                best = fmin(best, ray_triangle(o, along, m->c.position[v[0]], m->c.position[v[1]],
                                               m->c.position[v[2]]));
            }
            he_hit hit = cast(tree, m, o, d, HUGE_VAL);
            if (best == HUGE_VAL) {
                assert_int_equal(hit.face, HE_NONE);
                misses++;
                continue;
            }
            check_hit(m, &hit);
            assert_true(fabs(hit.distance - best) < 1e-9);
            he_vec3 there = he_vec3_add(o, he_vec3_scale(along, hit.distance));
            assert_true(he_vec3_extent(he_vec3_sub(there, hit.point)) < 1e-9);
            assert_int_equal(cast(tree, m, o, d, best * 1.001).face, hit.face);
            assert_int_equal(cast(tree, m, o, d, best * 0.999).face, HE_NONE);
            hits++;
        }
        he_bvh_free(tree);
        he_mesh_free(m);
    }
    assert_true(hits > 500 && misses > 500);
}

static void a_closed_surface_has_no_cracks(void **state)
{
    (void)state;
    uint64_t seed = 12;
    he_mesh *m = query_shape("icosphere", 3, 1, 0, 0);
    he_bvh *tree = tree_of(m);
    he_vec3 middle = {0.1, -0.2, 0.05};
    for (uint32_t e = 0; e < he_mesh_edges(m); e++) {
        he_vec3 a = m->c.position[m->c.origin[2 * e]], b = m->c.position[m->c.origin[2 * e + 1]];
        double t = query_uniform(&seed, 0, 1);
        he_vec3 on = he_vec3_add(he_vec3_scale(a, t), he_vec3_scale(b, 1 - t));
        he_hit hit = cast(tree, m, middle, he_vec3_sub(on, middle), HUGE_VAL);
        assert_int_not_equal(hit.face, HE_NONE);
        hit = cast(tree, m, middle, he_vec3_sub(a, middle), HUGE_VAL);
        assert_int_not_equal(hit.face, HE_NONE);
    }
    he_bvh_free(tree);
    he_mesh_free(m);
}

static void edges_and_vertices_are_hit_once_in_the_least_face(void **state)
{
    (void)state;
    he_mesh *m = query_shape("cube", 2, 0, 0, 0);
    he_bvh *tree = tree_of(m);
    for (int sign = -1; sign <= 1; sign += 2) {
        /* The first ray meets the middle of an edge of the cube, the second one meets a corner. */
        he_vec3 to[2] = {{sign, 1, 0}, {sign, 1, 1}};
        for (int i = 0; i < 2; i++) {
            he_vec3 from = he_vec3_scale(to[i], 3), back = he_vec3_scale(to[i], -1);
            he_hit hit = cast(tree, m, from, back, HUGE_VAL);
            check_hit(m, &hit);
            assert_true(fabs(hit.distance - 2 * he_vec3_length(to[i])) < 1e-12);
            uint32_t least = HE_NONE;
            for (uint32_t h = 0; h < 24; h++) {
                he_vec3 p = m->c.position[m->c.origin[h]], q = m->c.position[m->c.origin[h ^ 1u]];
                he_vec3 point = i == 0 ? he_vec3_scale(he_vec3_add(p, q), 0.5) : p;
                bool there = he_vec3_extent(he_vec3_sub(point, to[i])) == 0;
                least = there && m->c.face[h] < least ? m->c.face[h] : least;
            }
            assert_int_equal(hit.face, least);
        }
    }
    /* A ray that begins on the surface itself must hit there, at distance 0. */
    he_hit hit = cast(tree, m, (he_vec3){0.25, 0.25, 1}, (he_vec3){0, 0, 1}, HUGE_VAL);
    assert_true(hit.face != HE_NONE && hit.distance == 0);
    /* The ray lies in the plane of the cube's top face. It must hit the side face instead of the
     * top face. */
    hit = cast(tree, m, (he_vec3){-5, 0.25, 1}, (he_vec3){1, 0, 0}, HUGE_VAL);
    assert_true(hit.face != HE_NONE && hit.distance == 4);
    he_bvh_free(tree);
    he_mesh_free(m);
}

static void a_ray_needs_a_direction(void **state)
{
    (void)state;
    he_mesh *m = query_shape("cube", 2, 0, 0, 0), *none = he_mesh_new();
    he_bvh *tree = tree_of(m), *empty = tree_of(none);
    he_hit hit;
    he_error err = {0};
    he_budget budget = {.left = 1000};
    const he_vec3 zero = {0, 0, -0.0}, tiny = {0, 0, 5e-324}, huge = {0, 0, DBL_MAX};
    assert_int_equal(he_bvh_ray(tree, m, &(he_ray){zero, zero, 1}, &budget, &hit, &err),
                     HE_BAD_VALUE);
    assert_true(cast(tree, m, zero, tiny, HUGE_VAL).distance == 1);
    assert_true(cast(tree, m, zero, huge, 1).distance == 1);
    assert_int_equal(cast(tree, m, zero, huge, 0.999).face, HE_NONE);
    assert_int_equal(cast(empty, none, zero, tiny, HUGE_VAL).face, HE_NONE);
    assert_int_equal(closest(empty, none, zero, HUGE_VAL).face, HE_NONE);
    he_bvh_free(tree);
    he_bvh_free(empty);
    he_mesh_free(m);
    he_mesh_free(none);
}

static void rays_from_far_out_along_an_axis_are_exact(void **state)
{
    (void)state;
    he_mesh *m = query_shape("cube", 2, 0, 0, 0);
    he_bvh *tree = tree_of(m);
    static const double far[] = {1e10, 1e40, 1e200, DBL_MAX};
    for (int i = 0; i < 4; i++) {
        he_hit hit = cast(tree, m, (he_vec3){0.25, -0.5, far[i]}, (he_vec3){0, 0, -1}, HUGE_VAL);
        check_hit(m, &hit);
        assert_true(fabs(hit.point.x - 0.25) < 1e-12 && fabs(hit.point.y + 0.5) < 1e-12);
        assert_true(hit.point.z == 1 && hit.distance == far[i] - 1);
        hit = cast(tree, m, (he_vec3){1.25, -0.5, far[i]}, (he_vec3){0, 0, -1}, HUGE_VAL);
        assert_int_equal(hit.face, HE_NONE);
    }
    he_bvh_free(tree);
    he_mesh_free(m);
}

/* --- nearest points --- */

/* Returns the distance from p to the nearest of many sample points in the triangle. This distance
 * is never less than the exact distance to the triangle, and hardly more. */
static double sampled(he_vec3 p, he_vec3 a, he_vec3 b, he_vec3 c)
{
    enum { STEPS = 40 };
    double best = HUGE_VAL;
    for (int i = 0; i <= STEPS; i++) {
        for (int k = 0; i + k <= STEPS; k++) {
            he_vec3 q = he_vec3_scale(a, (double)i / STEPS);
            q = he_vec3_add(q, he_vec3_scale(b, (double)k / STEPS));
            q = he_vec3_add(q, he_vec3_scale(c, (double)(STEPS - i - k) / STEPS));
            best = fmin(best, he_vec3_length(he_vec3_sub(p, q)));
        }
    }
    return best;
}

static void the_nearest_point_is_that_of_all_triangles(void **state)
{
    (void)state;
    uint64_t seed = 21;
    for (int round = 0; round < 12; round++) {
        he_mesh *m = query_tangle(&seed);
        he_bvh *tree = tree_of(m);
        for (int i = 0; i < 6; i++) {
            he_vec3 p = query_random_point(&seed, i % 2 == 0 ? 1 : 4);
            double best = HUGE_VAL, side = 0;
            for (uint32_t t = 0; t < tree->count; t++) {
                const uint32_t *v = tree->triangles[t].vertex;
                he_vec3 a = m->c.position[v[0]], b = m->c.position[v[1]], c = m->c.position[v[2]];
                best = fmin(best, sampled(p, a, b, c));
                side = fmax(side, he_vec3_length(he_vec3_sub(a, b)));
                side = fmax(side, he_vec3_length(he_vec3_sub(a, c)));
            }
            he_hit hit = closest(tree, m, p, HUGE_VAL);
            check_hit(m, &hit);
            assert_true(hit.distance <= best + 1e-12 && hit.distance >= best - side / 20);
            assert_true(fabs(he_vec3_length(he_vec3_sub(p, hit.point)) - hit.distance) < 1e-12);
            assert_int_equal(closest(tree, m, p, hit.distance * 0.999).face, HE_NONE);
            assert_int_equal(closest(tree, m, p, hit.distance * 1.001).face, hit.face);
        }
        he_bvh_free(tree);
        he_mesh_free(m);
    }
}

/* A node of the tree has a box and a disc around its triangles. Requires that the lower bounds from
 * the box and from the disc do not exceed the distance from p to any corner of these triangles. */
static void check_bounds(const he_bvh *tree, const he_mesh *m, uint32_t at, he_vec3 p)
{
    const he_box_node *node = &tree->nodes[at];
    double bound = sqrt(he_bvh_to_disc(&tree->discs[at], p));
    uint32_t begin = at, end = at;
    while (tree->nodes[begin].count == 0) {
        begin = tree->nodes[begin].first;
    }
    while (tree->nodes[end].count == 0) {
        end = tree->nodes[end].first + 1;
    }
    end = tree->nodes[end].first + tree->nodes[end].count;
    for (uint32_t t = tree->nodes[begin].first; t < end; t++) {
        he_vec3 c[3];
        he_bvh_corners(tree, m, t, c);
        for (int k = 0; k < 3; k++) {
            const double x[3] = {c[k].x, c[k].y, c[k].z};
            for (int axis = 0; axis < 3; axis++) {
                assert_true(node->min[axis] <= x[axis] && x[axis] <= node->max[axis]);
            }
            double distance = he_vec3_length(he_vec3_sub(p, c[k]));
            assert_true(bound <= distance * (1 + 1e-14));
        }
    }
}

static void boxes_and_discs_hold_what_is_below_them(void **state)
{
    (void)state;
    uint64_t seed = 24;
    for (int round = 0; round < 20; round++) {
        he_mesh *m = round == 0 ? query_shape("torus", 60, 40, 2, 0.5) : query_tangle(&seed);
        he_bvh *tree = tree_of(m);
        for (uint32_t at = 0; at < tree->node_count; at++) {
            for (int i = 0; i < 4; i++) {
                static const double reaches[] = {0.5, 2, 1e3, 1e9};
                check_bounds(tree, m, at, query_random_point(&seed, reaches[i]));
            }
            /* One tested point is on the normal through the centre of the disc, the other in the
             * plane of the disc: at such points the lower bounds are nearly equal to the exact
             * distances. */
            const he_bvh_disc *d = &tree->discs[at];
            he_vec3 c = {d->center[0], d->center[1], d->center[2]},
                    n = {d->normal[0], d->normal[1], d->normal[2]},
                    x = query_random_point(&seed, 1);
            check_bounds(tree, m, at, he_vec3_add(c, he_vec3_scale(n, 1e6)));
            check_bounds(tree, m, at, he_vec3_add(c, he_vec3_scale(he_vec3_cross(n, x), 1e6)));
        }
        he_bvh_free(tree);
        he_mesh_free(m);
    }
}

static void nearest_points_of_a_cube(void **state)
{
    (void)state;
    he_mesh *m = query_shape("cube", 2, 0, 0, 0);
    he_bvh *tree = tree_of(m);
    uint64_t seed = 22;
    for (int i = 0; i < 2000; i++) {
        he_vec3 p = query_random_point(&seed, 3);
        he_vec3 q = {fmin(fmax(p.x, -1), 1), fmin(fmax(p.y, -1), 1), fmin(fmax(p.z, -1), 1)};
        double outside = he_vec3_length(he_vec3_sub(p, q));
        double wanted = outside > 0 ? outside : 1 - he_vec3_extent(p);
        he_hit hit = closest(tree, m, p, HUGE_VAL);
        check_hit(m, &hit);
        assert_true(fabs(hit.distance - wanted) < 1e-12);
    }
    he_hit hit = closest(tree, m, (he_vec3){1, 1, 1}, 0);
    assert_true(hit.face != HE_NONE && hit.distance == 0);
    he_bvh_free(tree);
    he_mesh_free(m);
}

static void faces_without_area_are_the_segments_they_look_like(void **state)
{
    (void)state;
    he_mesh *m = fixture_mesh("012");
    const he_vec3 line[] = {{0, 0, 0}, {2, 0, 0}, {5, 0, 0}},
                  dot[] = {{1, 2, 3}, {1, 2, 3}, {1, 2, 3}};
    memcpy(m->c.position, line, sizeof line);
    he_bvh *tree = tree_of(m);
    he_hit hit = closest(tree, m, (he_vec3){3.5, 2, 0}, HUGE_VAL);
    assert_true(hit.face == 0 && fabs(hit.distance - 2) < 1e-12 && fabs(hit.point.x - 3.5) < 1e-12);
    assert_int_equal(cast(tree, m, (he_vec3){1, 1, 0}, (he_vec3){0, -1, 0}, 9).face, HE_NONE);
    he_bvh_free(tree);
    memcpy(m->c.position, dot, sizeof dot);
    tree = tree_of(m);
    hit = closest(tree, m, (he_vec3){1, 2, 5}, HUGE_VAL);
    assert_true(hit.face == 0 && hit.distance == 2);
    he_bvh_free(tree);
    he_mesh_free(m);
}

/* A vertex without faces cannot be hit. However far away such a vertex is, it must not influence
 * the scale that the tree uses. */
static void a_far_vertex_does_not_hide_faces(void **state)
{
    (void)state;
    static const double far_away[] = {1e60, 1e81, 1e108, -1e200, 1e300, DBL_MAX};
    for (size_t i = 0; i < sizeof far_away / sizeof *far_away; i++) {
        he_mesh *m = query_shape("cube", 2, 0, 0, 0);
        he_vertex v;
        assert_int_equal(he_vertex_add(m, (he_vec3){far_away[i], 0, -far_away[i]}, &v, NULL),
                         HE_OK);
        he_bvh *tree = tree_of(m);
        he_hit hit = cast(tree, m, (he_vec3){0.25, 0.5, 5}, (he_vec3){0, 0, -1}, HUGE_VAL);
        assert_true(hit.face != HE_NONE && hit.distance == 4);
        assert_true(hit.point.x == 0.25 && hit.point.y == 0.5 && hit.point.z == 1);
        hit = closest(tree, m, (he_vec3){0.25, -3, 0.5}, HUGE_VAL);
        assert_true(hit.face != HE_NONE && hit.distance == 2);
        assert_true(hit.point.x == 0.25 && hit.point.y == -1 && hit.point.z == 0.5);
        he_bvh_free(tree);
        he_mesh_free(m);
    }
}

/* One face is far away, the others are near. The ratio of their distances is one for which bvh.h
 * promises that the near faces are found. */
static void a_far_face_does_not_hide_near_ones(void **state)
{
    (void)state;
    static const double far_away[] = {1e10, 1e30, 1e60, 1e70};
    for (size_t i = 0; i < sizeof far_away / sizeof *far_away; i++) {
        he_mesh *m = fixture_mesh("012,345");
        m->c.position[0] = (he_vec3){-1, -1, 0};
        m->c.position[1] = (he_vec3){3, -1, 0};
        m->c.position[2] = (he_vec3){-1, 3, 0};
        for (uint32_t k = 3; k < 6; k++) {
            m->c.position[k] = (he_vec3){far_away[i], k == 4 ? 1 : 0, k == 5 ? 1 : 0};
        }
        he_bvh *tree = tree_of(m);
        he_hit hit = cast(tree, m, (he_vec3){0.25, 0.5, 5}, (he_vec3){0, 0, -1}, HUGE_VAL);
        assert_true(hit.face == 0 && hit.distance == 5);
        hit = closest(tree, m, (he_vec3){0.25, 0.5, 2}, HUGE_VAL);
        assert_true(hit.face == 0 && fabs(hit.distance - 2) < 1e-14);
        he_bvh_free(tree);
        he_mesh_free(m);
    }
}

static void a_tree_of_triangles_in_one_place_has_a_budget(void **state)
{
    (void)state;
    /* All triangles have the same centre, so the tree cannot divide them. */
    he_mesh *m = query_shape("grid", 40, 40, 1, 1);
    memset(m->c.position, 0, he_mesh_issued(m, HE_VERTEX) * sizeof *m->c.position);
    he_bvh *tree = tree_of(m);
    he_hit hit = closest(tree, m, (he_vec3){0, 3, 4}, HUGE_VAL), unused;
    assert_true(hit.face == 0 && hit.distance == 5);
    he_budget budget = {.left = 100};
    assert_int_equal(he_bvh_closest(tree, m, (he_vec3){0, 3, 4}, HUGE_VAL, &budget, &unused, NULL),
                     HE_LIMIT);
    assert_true(budget.left == 0);
    he_bvh_free(tree);
    he_mesh_free(m);
}

static void hostile_coordinates_give_finite_hits(void **state)
{
    (void)state;
    static const double odd[] = {0,      1,     -1,    DBL_MAX, -DBL_MAX, DBL_MIN,
                                 5e-324, 1e-77, 1e154, -1e308,  1e-160,   -0.0};
    uint64_t seed = 23;
    for (int round = 0; round < 4000; round++) {
        he_mesh *m = fixture_mesh(query_specimens[query_random(&seed) % QUERY_SPECIMENS]);
        uint64_t kinds = 1 + query_random(&seed) % 12;
        double x[9];
        for (uint32_t v = 0; v < he_mesh_vertices(m); v++) {
            for (int k = 0; k < 3; k++) {
                (&m->c.position[v].x)[k] = odd[query_random(&seed) % kinds];
            }
        }
        for (int k = 0; k < 9; k++) {
            x[k] = odd[query_random(&seed) % 12];
        }
        x[3] = x[3] == 0 && x[4] == 0 && x[5] == 0 ? 1 : x[3];
        he_bvh *tree = tree_of(m);
        he_hit hits[2] = {
            cast(tree, m, (he_vec3){x[0], x[1], x[2]}, (he_vec3){x[3], x[4], x[5]}, HUGE_VAL),
            closest(tree, m, (he_vec3){x[6], x[7], x[8]}, HUGE_VAL)};
        assert_int_equal(hits[1].face == HE_NONE, he_mesh_faces(m) == 0);
        for (int i = 0; i < 2; i++) {
            const he_hit *h = &hits[i];
            assert_true(h->face == HE_NONE || (h->distance >= 0 && h->distance <= DBL_MAX &&
                                               he_vec3_is_finite(h->point) && h->weight[0] >= 0 &&
                                               h->weight[1] >= 0 && h->weight[2] >= 0));
        }
        he_ids pairs = {0};
        he_budget budget = {.left = UINT64_MAX};
        bool complete;
        assert_int_equal(he_bvh_intersections(tree, m, 1000, &budget, &pairs, &complete, NULL),
                         HE_OK);
        he_ids_clear(&pairs);
        he_bvh_free(tree);
        he_mesh_free(m);
    }
}

/* --- on which side of a plane a point lies --- */

static void orientation_is_exact_where_doubles_round(void **state)
{
    (void)state;
    /* Three points lie in a plane, and their coordinates are exact doubles. The fourth point
     * differs from a point in the plane by one unit in the last place. */
    uint64_t seed = 41;
    for (int i = 0; i < 2000; i++) {
        double base = ldexp(1, (int)(query_random(&seed) % 30));
        he_vec3 p[4];
        for (int k = 0; k < 4; k++) {
            double x = (double)(query_random(&seed) % 1000),
                   y = (double)(query_random(&seed) % 1000);
            p[k] = (he_vec3){base + x, base + y, 3 * (base + x) - 2 * (base + y)};
        }
        assert_int_equal(he_orient3(p[0], p[1], p[2], p[3]), 0);
        he_vec2 a = {p[0].x, p[0].y}, b = {p[1].x, p[1].y}, c = {p[2].x, p[2].y};
        int turn = he_orient2(a, b, c);
        he_vec3 up = p[3], down = p[3];
        up.z = nextafter(up.z, HUGE_VAL);
        down.z = nextafter(down.z, -HUGE_VAL);
        assert_int_equal(he_orient3(p[0], p[1], p[2], down), turn);
        assert_int_equal(he_orient3(p[0], p[1], p[2], up), -turn);
    }
    he_vec2 a = {0.1, 0.1}, b = {0.3, 0.3}, on = {0.7, 0.7}, left = {0.7, nextafter(0.7, 1)};
    assert_int_equal(he_orient2(a, b, on), 0);
    assert_int_equal(he_orient2(a, b, left), 1);
    assert_int_equal(he_orient2(b, a, left), -1);
}

/* --- intersections --- */

static void triangles_meet_where_they_should_not(void **state)
{
    (void)state;
    static const struct {
        const char *what;
        he_vec3 b[3]; /* second triangle; the first triangle is (0,0,0) (2,0,0) (0,2,0) */
        bool meet;
    } rows[] = {
        {"far away", {{5, 5, 5}, {6, 5, 5}, {5, 6, 5}}, false},
        {"above", {{0, 0, 1}, {2, 0, 1}, {0, 2, 1}}, false},
        {"through the middle", {{0.5, 0.5, -1}, {0.5, 0.5, 1}, {3, 3, 0}}, true},
        {"touching the inside with a corner", {{0.5, 0.5, 0}, {1, 1, 1}, {1, 0, 1}}, true},
        {"beside, in the plane", {{3, 0, 0}, {5, 0, 0}, {3, 2, 0}}, false},
        {"inside, in the plane", {{0.1, 0.1, 0}, {0.5, 0.1, 0}, {0.1, 0.5, 0}}, true},
        {"around, in the plane", {{-9, -9, 0}, {9, -9, 0}, {0, 9, 0}}, true},
        {"a neighbour", {{2, 0, 0}, {0, 0, 0}, {1, -1, 0}}, false},
        {"a neighbour that stands up", {{2, 0, 0}, {0, 0, 0}, {1, 1, 1}}, false},
        {"a neighbour folded back", {{2, 0, 0}, {0, 0, 0}, {1, 1, 0}}, true},
        {"twice the same", {{2, 0, 0}, {0, 0, 0}, {0, 2, 0}}, true},
        {"at a corner", {{0, 0, 0}, {-1, 0, 1}, {0, -1, 1}}, false},
        {"at a corner, above", {{0, 0, 0}, {1, 0, 1}, {0, 1, 1}}, false},
        {"at a corner, through", {{0, 0, 0}, {1, 1, -1}, {1, 1, 1}}, true},
        {"at a corner, in the plane", {{0, 0, 0}, {-1, 0, 0}, {0, -1, 0}}, false},
        {"at a corner, in the plane, over", {{0, 0, 0}, {1, 1, 0}, {1, 2, 0}}, true},
        {"at a corner, along a side", {{0, 0, 0}, {1, 0, 0}, {1, 0, 1}}, true},
        {"without area", {{0, 0, -1}, {0.5, 0.5, 0}, {1, 1, 1}}, false},
    };
    const he_vec3 a[3] = {{0, 0, 0}, {2, 0, 0}, {0, 2, 0}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        for (int turn = 0; turn < 18; turn++) {
            he_vec3 c[3], d[3];
            for (int k = 0; k < 3; k++) {
                c[k] = a[(k + turn) % 3];
                d[k] = rows[i].b[turn < 9 ? (k + turn / 3) % 3 : (3 - k + turn / 3) % 3];
            }
            if (he_triangles_intersect(c, d) != rows[i].meet ||
                he_triangles_intersect(d, c) != rows[i].meet) {
                fail_msg("%s, turned %d", rows[i].what, turn);
            }
        }
    }
}

static void pairs_of(const he_mesh *m, size_t most, he_ids *pairs, bool *complete)
{
    he_bvh *tree = tree_of(m);
    he_budget budget = {.left = UINT64_MAX};
    pairs->count = 0;
    assert_int_equal(he_bvh_intersections(tree, m, most, &budget, pairs, complete, NULL), HE_OK);
    he_bvh_free(tree);
}

static void shapes_do_not_meet_themselves(void **state)
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
    he_ids pairs = {0};
    bool complete;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        const double *a = rows[i].args;
        he_mesh *m = query_shape(rows[i].name, a[0], a[1], a[2], a[3]);
        pairs_of(m, 1000, &pairs, &complete);
        if (pairs.count > 0 || !complete) {
            fail_msg("%s: faces %u and %u", rows[i].name, pairs.ids[0], pairs.ids[1]);
        }
        he_mesh_free(m);
    }
    he_ids_clear(&pairs);
}

static void pairs_are_those_that_trying_all_finds(void **state)
{
    (void)state;
    uint64_t seed = 51;
    he_ids pairs = {0};
    size_t met = 0;
    for (int round = 0; round < 40; round++) {
        he_mesh *m = query_tangle(&seed);
        he_bvh *tree = tree_of(m);
        uint32_t faces = he_mesh_faces(m);
        bool *wanted = calloc((size_t)faces * faces, sizeof *wanted), complete;
        assert_non_null(wanted);
        size_t count = 0;
        for (uint32_t i = 0; i < tree->count; i++) {
            for (uint32_t k = 0; k < tree->count; k++) {
                he_vec3 a[3], b[3];
                uint32_t f = tree->triangles[i].face, g = tree->triangles[k].face;
                for (int j = 0; j < 3; j++) {
                    a[j] = m->c.position[tree->triangles[i].vertex[j]];
                    b[j] = m->c.position[tree->triangles[k].vertex[j]];
                }
                if (f < g && !wanted[f * faces + g] && he_triangles_intersect(a, b)) {
                    wanted[f * faces + g] = true;
                    count++;
                }
            }
        }
        pairs_of(m, SIZE_MAX, &pairs, &complete);
        assert_true(complete);
        assert_int_equal(pairs.count, 2 * count);
        for (size_t i = 0; i < pairs.count; i += 2) {
            assert_true(wanted[pairs.ids[i] * faces + pairs.ids[i + 1]]);
        }
        met += count;
        if (count > 1) {
            pairs_of(m, 1, &pairs, &complete);
            assert_true(!complete && pairs.count >= 2);
        }
        free(wanted);
        he_bvh_free(tree);
        he_mesh_free(m);
    }
    assert_true(met > 100);
    he_ids_clear(&pairs);
}

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

static void trees_and_searches_can_be_given_up(void **state)
{
    (void)state;
    he_mesh *m = query_shape("torus", 75, 50, 2, 0.5);
    long calls = 0;
    for (long most = 0; most <= calls; most++) {
        patience p = {.most = most == 0 ? LONG_MAX : most - 1};
        he_progress progress;
        he_bvh *tree = NULL;
        he_ids pairs = {0};
        bool complete;
        he_budget budget = {.left = UINT64_MAX, .progress = &progress};
        he_progress_init(&progress, tell, &p);
        he_progress_span(&progress, 0.5);
        he_status status = he_bvh_new(m, &progress, &tree, NULL);
        if (status == HE_OK) {
            he_progress_span(&progress, 1);
            status = he_bvh_intersections(tree, m, 1000, &budget, &pairs, &complete, NULL);
        } else {
            assert_null(tree);
        }
        assert_int_equal(status, most == 0 ? HE_OK : HE_CANCELLED);
        assert_int_equal(pairs.count, 0);
        calls = most == 0 ? p.calls : calls;
        he_bvh_free(tree);
        he_ids_clear(&pairs);
    }
    assert_true(calls > 10);
    he_mesh_free(m);
}

static void starved_trees_and_searches_say_so(void **state)
{
    (void)state;
    uint64_t seed = 61;
    he_mesh *m = query_tangle(&seed), *polygon = fixture_mesh("01234567");
    const he_mesh *meshes[] = {m, polygon};
    for (int i = 0; i < 2; i++) {
        failing f = {.may_succeed = true}; /* an allocation that shrinks a block may fail without an
                                              error, since the block may stay as it is */
        while (failing_next(&f)) {
            he_bvh *tree = NULL;
            he_ids pairs = {0};
            bool complete;
            he_budget budget = {.left = UINT64_MAX};
            he_status status = he_bvh_new(meshes[i], NULL, &tree, NULL);
            if (status == HE_OK) {
                status =
                    he_bvh_intersections(tree, meshes[i], 1000, &budget, &pairs, &complete, NULL);
            }
            assert_true(failing_status(&f, status) || pairs.count == 0);
            he_ids_clear(&pairs);
            he_bvh_free(tree);
        }
    }
    he_mesh_free(m);
    he_mesh_free(polygon);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rays_hit_what_trying_all_triangles_finds),
        cmocka_unit_test(a_closed_surface_has_no_cracks),
        cmocka_unit_test(edges_and_vertices_are_hit_once_in_the_least_face),
        cmocka_unit_test(a_ray_needs_a_direction),
        cmocka_unit_test(rays_from_far_out_along_an_axis_are_exact),
        cmocka_unit_test(the_nearest_point_is_that_of_all_triangles),
        cmocka_unit_test(boxes_and_discs_hold_what_is_below_them),
        cmocka_unit_test(nearest_points_of_a_cube),
        cmocka_unit_test(faces_without_area_are_the_segments_they_look_like),
        cmocka_unit_test(a_far_vertex_does_not_hide_faces),
        cmocka_unit_test(a_far_face_does_not_hide_near_ones),
        cmocka_unit_test(a_tree_of_triangles_in_one_place_has_a_budget),
        cmocka_unit_test(hostile_coordinates_give_finite_hits),
        cmocka_unit_test(orientation_is_exact_where_doubles_round),
        cmocka_unit_test(triangles_meet_where_they_should_not),
        cmocka_unit_test(shapes_do_not_meet_themselves),
        cmocka_unit_test(pairs_are_those_that_trying_all_finds),
        cmocka_unit_test(trees_and_searches_can_be_given_up),
        cmocka_unit_test(starved_trees_and_searches_say_so),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
