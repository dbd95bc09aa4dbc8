/* Tests of the wide tree of boxes and of searches in it: walking it finds what trying all triangles
 * finds. */
#include "query_specimens.h"

#include "query/bvh_walk.h"

#include <math.h>

/* Counts how often each leaf is below a node of the wide tree, and requires that children have the
 * boxes of the binary tree. */
static void count_leaves(const he_bvh *tree, uint32_t at, uint32_t *counts)
{
    const he_bvh_wide *wide = &tree->wide[at];
    for (int i = 0; i < HE_BVH_WIDTH; i++) {
        if (wide->node[i] == HE_NONE) {
            continue;
        }
        const he_box_node *node = &tree->nodes[wide->node[i]];
        for (int k = 0; k < 3; k++) {
            assert_true(wide->min[k][i] == node->min[k] && wide->max[k][i] == node->max[k]);
        }
        assert_int_equal(wide->count[i], node->count);
        if (node->count > 0) {
            assert_int_equal(wide->first[i], node->first);
            counts[wide->node[i]]++;
        } else {
            assert_true(wide->first[i] > at && wide->first[i] < tree->wide_count);
            count_leaves(tree, wide->first[i], counts);
        }
    }
}

static void the_wide_tree_has_each_leaf_once(void **state)
{
    (void)state;
    uint64_t seed = 25;
    for (int round = 0; round < 20; round++) {
        he_mesh *m = round == 0   ? query_shape("torus", 60, 40, 2, 0.5)
                     : round == 1 ? query_shape("grid", 1, 1, 1, 1)
                                  : query_tangle(&seed);
        he_bvh *tree = NULL;
        assert_int_equal(he_bvh_new(m, NULL, &tree, NULL), HE_OK);
        uint32_t *counts = he_mem_zero(tree->node_count, sizeof *counts);
        assert_non_null(counts);
        count_leaves(tree, 0, counts);
        for (uint32_t at = 0; at < tree->node_count; at++) {
            assert_int_equal(counts[at], tree->nodes[at].count > 0);
        }
        he_mem_free(counts);
        he_bvh_free(tree);
        he_mesh_free(m);
    }
}

/* Points near and very far, from a mesh that is near the origin of coordinates and one that is far
 * from it, where floats round much. */
static void walking_the_tree_finds_what_trying_all_triangles_finds(void **state)
{
    (void)state;
    uint64_t seed = 26;
    for (int round = 0; round < 60; round++) {
        he_mesh *m = query_tangle(&seed);
        const double shift = round % 3 == 0 ? 1e7 : 0;
        for (uint32_t v = 0; v < he_mesh_vertices(m); v++) {
            m->c.position[v].x += shift;
        }
        he_bvh *tree = NULL;
        assert_int_equal(he_bvh_new(m, NULL, &tree, NULL), HE_OK);
        for (int i = 0; i < 60; i++) {
            const double reach = ldexp(1, i % 2 == 0 ? -(i / 4) : 3 * i / 2);
            const he_vec3 on = he_vec3_scale(m->c.position[0], tree->scale);
            const he_vec3 p = he_vec3_add(on, query_random_point(&seed, reach));
            double best = HUGE_VAL;
            for (uint32_t t = 0; t < tree->count; t++) {
                he_vec3 c[3];
                double weight[3];
                he_bvh_corners(tree, m, t, c);
                const he_vec3 back = he_bvh_to_triangle(p, c, weight);
                best = fmin(best, he_vec3_dot(back, back));
            }
            uint32_t hint = i % 3 == 0 ? HE_NONE : (uint32_t)(query_random(&seed) % tree->count);
            he_budget budget = {.left = UINT64_MAX};
            he_bvh_found found;
            assert_int_equal(he_bvh_near(tree, m, &(he_bvh_asked){p, hint}, &budget, &found, NULL),
                             HE_OK);
            /* Coordinates are near 1, and their products are rounded. */
            assert_true(found.far >= best);
            assert_true(sqrt(found.far) <= sqrt(best) * (1 + 1e-14) + 1e-14);
        }
        he_bvh_free(tree);
        he_mesh_free(m);
    }
}

/* The nearest point of thin and of other triangles is no farther away than any point of a fine
 * lattice, and it is a point of the triangle. */
static void the_nearest_point_of_a_triangle_is_nearest(void **state)
{
    (void)state;
    enum { PARTS = 24 };
    uint64_t seed = 27;
    for (int round = 0; round < 4000; round++) {
        const double thin = ldexp(1, -(int)(query_random(&seed) % 40)),
                     far = round % 4 == 0 ? 50 : 1;
        he_vec3 c[3] = {query_random_point(&seed, 1), query_random_point(&seed, 1), {0, 0, 0}};
        c[2] = he_vec3_add(he_vec3_scale(he_vec3_add(c[0], c[1]), 0.5),
                           query_random_point(&seed, thin));
        const int turn = round % 3;
        const he_vec3 t[3] = {c[turn], c[(turn + 1) % 3], c[(turn + 2) % 3]};
        const he_vec3 p = query_random_point(&seed, far);
        double weight[3], best = HUGE_VAL;
        const he_vec3 back = he_bvh_to_triangle(p, t, weight);
        he_vec3 q = {0, 0, 0};
        for (int k = 0; k < 3; k++) {
            assert_true(weight[k] >= 0 && weight[k] <= 1);
            q = he_vec3_add(q, he_vec3_scale(t[k], weight[k]));
        }
        assert_true(fabs(weight[0] + weight[1] + weight[2] - 1) < 1e-12);
        assert_true(he_vec3_extent(he_vec3_sub(he_vec3_sub(p, q), back)) < 1e-13 * far);
        for (int i = 0; i <= PARTS; i++) {
            for (int k = 0; k <= PARTS - i; k++) {
                const double x = (double)i / PARTS, y = (double)k / PARTS;
                const he_vec3 on =
                    he_vec3_add(he_vec3_scale(t[0], 1 - x - y),
                                he_vec3_add(he_vec3_scale(t[1], x), he_vec3_scale(t[2], y)));
                best = fmin(best, he_vec3_length(he_vec3_sub(p, on)));
            }
        }
        assert_true(he_vec3_length(back) <= best + 1e-14 * far);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_wide_tree_has_each_leaf_once),
        cmocka_unit_test(walking_the_tree_finds_what_trying_all_triangles_finds),
        cmocka_unit_test(the_nearest_point_of_a_triangle_is_nearest),
    };
    return cmocka_run_group_tests_name("query_near", tests, NULL, NULL);
}
