/* Benchmark of spatial queries: making a tree of boxes, rays, nearest points, intersections, and
 * curvature, on a bumpy torus of about a million triangles; and intersections where all triangles
 * share a vertex.
 *
 *     build/tests/bench/space */
#include "build/build.h"
#include "geometry/vec3.h"
#include "mesh/walk.h"
#include "query/bvh.h"
#include "query/curvature.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

enum { SIDE = 724, VERTICES = SIDE * SIDE, FACES = 2 * VERTICES, ASKED = 200000 };

static double seconds(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static uint64_t state = 88172645463325252u;

/* Returns a pseudo-random number from -1 to 1: xorshift64 (Marsaglia 2003). */
static double random_number(void)
{
    state ^= state << 13;
    state ^= state >> 7;
    state ^= state << 17;
    return ldexp((double)(state >> 11), -52) - 1;
}

static void require(he_status status)
{
    if (status != HE_OK) {
        fprintf(stderr, "%s\n", he_status_title(status));
        exit(1);
    }
}

static he_mesh *torus(void)
{
    static const double TURN = 6.283185307179586 / SIDE;
    he_soup soup;
    he_mesh *m;
    he_soup_init(&soup, NULL);
    for (uint32_t i = 0; i < VERTICES; i++) {
        uint32_t minor = i % SIDE, major = i / SIDE;
        double u = minor * TURN, v = major * TURN, r = 1 + 0.01 * random_number() / 8;
        he_vec3 p = {(3 + r * cos(v)) * cos(u), (3 + r * cos(v)) * sin(u), r * sin(v)};
        require(he_soup_add_vertex(&soup, p, NULL));
    }
    for (uint32_t q = 0; q < VERTICES; q++) {
        uint32_t i = q / SIDE, j = q % SIDE, up = (i + 1) % SIDE * SIDE, right = (j + 1) % SIDE;
        const uint32_t triangles[2][3] = {{q, i * SIDE + right, up + right},
                                          {q, up + right, up + j}};
        require(he_soup_add_face(&soup, triangles[0], 3, NULL));
        require(he_soup_add_face(&soup, triangles[1], 3, NULL));
    }
    require(he_build(&soup, HE_BUILD_TAKE, &m, NULL, NULL));
    return m;
}

static he_vec3 random_point(double reach)
{
    return (he_vec3){reach * random_number(), reach * random_number(), reach * random_number()};
}

static void show(const char *what, double took, const he_budget *budget, uint32_t hits)
{
    printf("%-16s %8.2f us each   %6.1f steps each   %u of %d\n", what, 1e6 * took / ASKED,
           (double)(UINT64_MAX - budget->left) / ASKED, hits, ASKED);
}

/* Measures building the tree of boxes, and finding all pairs of intersecting faces. */
static void show_intersections(const char *what, const he_mesh *m, const he_bvh *tree)
{
    he_budget budget = {.left = UINT64_MAX};
    he_ids pairs = {0};
    bool complete;
    double start = seconds();
    require(he_bvh_intersections(tree, m, (size_t)1 << 20, &budget, &pairs, &complete, NULL));
    printf("%-16s %8.2f s   %.1f steps a triangle   %zu pairs%s\n", what, seconds() - start,
           (double)(UINT64_MAX - budget.left) / tree->count, pairs.count / 2,
           complete ? "" : " and more");
    he_ids_clear(&pairs);
}

/* Measures a fan of triangles: a disc, a cone, or a disc that is folded once per spoke. */
static void show_fan(const char *what, double height, double stride)
{
    enum { SPOKES = 60000 };
    he_soup soup;
    he_mesh *m;
    he_bvh *tree;
    he_soup_init(&soup, NULL);
    for (uint32_t i = 0; i <= SPOKES; i++) {
        double turn = 6.283185307179586 * (stride == 1 ? i : fmod(i * stride, SPOKES) / 2) / SPOKES;
        he_vec3 p = {cos(turn), sin(turn), 0.3 * cos(turn)};
        require(he_soup_add_vertex(&soup, i < SPOKES ? p : (he_vec3){0, 0, height}, NULL));
    }
    for (uint32_t i = 0; i < SPOKES; i++) {
        const uint32_t triangle[3] = {SPOKES, i, (i + 1) % SPOKES};
        require(he_soup_add_face(&soup, triangle, 3, NULL));
    }
    require(he_build(&soup, HE_BUILD_TAKE, &m, NULL, NULL));
    require(he_bvh_new(m, NULL, &tree, NULL));
    show_intersections(what, m, tree);
    he_bvh_free(tree);
    he_mesh_free(m);
}

int main(void)
{
    he_mesh *m = torus();
    he_bvh *tree;
    he_hit hit;
    double start = seconds();
    require(he_bvh_new(m, NULL, &tree, NULL));
    printf("tree             %8.2f s   %u triangles   %u nodes   %.1f bytes a triangle\n",
           seconds() - start, tree->count, tree->node_count,
           (double)(tree->node_count * (sizeof *tree->nodes + sizeof *tree->discs) +
                    tree->wide_count * sizeof *tree->wide + tree->count * sizeof *tree->triangles) /
               tree->count);

    he_budget budget = {.left = UINT64_MAX};
    uint32_t hits = 0;
    start = seconds();
    for (int i = 0; i < ASKED; i++) {
        he_vec3 from = random_point(5), along = random_point(1);
        require(he_bvh_ray(tree, m, &(he_ray){from, along, HUGE_VAL}, &budget, &hit, NULL));
        hits += hit.face != HE_NONE;
    }
    show("rays", seconds() - start, &budget, hits);

    static const double reaches[] = {1, 5, 100};
    for (int k = 0; k < 3; k++) {
        char name[32];
        snprintf(name, sizeof name, "nearest in %g", reaches[k]);
        budget.left = UINT64_MAX;
        hits = 0;
        start = seconds();
        for (int i = 0; i < ASKED; i++) {
            require(
                he_bvh_closest(tree, m, random_point(reaches[k]), HUGE_VAL, &budget, &hit, NULL));
            hits += hit.face != HE_NONE;
        }
        show(name, seconds() - start, &budget, hits);
    }

    budget.left = UINT64_MAX;
    hits = 0;
    start = seconds();
    for (int i = 0; i < ASKED; i++) {
        uint32_t v = (uint32_t)((random_number() + 1) / 2 * VERTICES);
        he_vec3 p = he_vec3_add(m->c.position[v], random_point(0.01));
        require(he_bvh_closest(tree, m, p, HUGE_VAL, &budget, &hit, NULL));
        hits += hit.face != HE_NONE;
    }
    show("nearest, beside", seconds() - start, &budget, hits);

    show_intersections("intersections", m, tree);
    show_fan("a disc's", 0, 1);
    show_fan("a cone's", 1, 1);
    show_fan("a folded disc's", 0, 7919);

    he_curvature *all = malloc(VERTICES * sizeof *all);
    start = seconds();
    require(he_curvatures(m, NULL, 0, UINT64_MAX, NULL, all, NULL));
    printf("curvatures       %8.2f s   %d vertices\n", seconds() - start, VERTICES);

    free(all);
    he_bvh_free(tree);
    he_mesh_free(m);
    return 0;
}
