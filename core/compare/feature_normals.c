#include "compare/feature_normals.h"

#include <stdlib.h>

/* A vertex with more triangles is a hub. */
enum { HUB = 64 };

static he_vec3 triangle_normal(const he_feature_normals *n, uint32_t triangle, he_vec3 corner[3])
{
    he_vec3 unit;
    he_bvh_corners(n->tree, n->mesh, triangle, corner);
    he_vec3_normalise(
        he_vec3_cross(he_vec3_sub(corner[1], corner[0]), he_vec3_sub(corner[2], corner[0])), &unit);
    return unit;
}

static he_status reserve(he_feature_normals *n, he_error *err)
{
    const size_t vertices = n->mesh->c.vertices.issued;
    n->vertex = he_mem_zero(vertices, sizeof *n->vertex);
    n->first = he_mem_zero(vertices + 1, sizeof *n->first);
    n->at = he_mem_array(NULL, 3 * (size_t)n->tree->count, sizeof *n->at);
    return n->vertex != NULL && n->first != NULL && n->at != NULL
               ? HE_OK
               : he_fail_plain(err, HE_NO_MEMORY, "no memory for the normals of %zu vertices",
                               vertices);
}

/* Lists the triangles at each vertex, by counting. */
static void list_triangles(he_feature_normals *n)
{
    const uint32_t vertices = n->mesh->c.vertices.issued, count = n->tree->count;
    for (uint32_t i = 0; i < count; i++) {
        for (int k = 0; k < 3; k++) {
            n->first[n->tree->triangles[i].vertex[k]]++;
        }
    }
    uint32_t sum = 0;
    for (uint32_t v = 0; v <= vertices; v++) {
        sum += n->first[v];
        n->first[v] = sum;
    }
    /* Each entry is now the end of its list; filling the lists backward moves it to the begin. */
    for (uint32_t i = count; i-- > 0;) {
        for (int k = 0; k < 3; k++) {
            n->at[--n->first[n->tree->triangles[i].vertex[k]]] = i;
        }
    }
}

/* --- edges between hubs --- */

static bool is_hub(const he_feature_normals *n, uint32_t v)
{
    return n->first[v + 1] - n->first[v] > HUB;
}

static int compare_ends(const he_hub_edge *a, const he_hub_edge *b)
{
    return a->low != b->low     ? (a->low < b->low ? -1 : 1)
           : a->high != b->high ? (a->high < b->high ? -1 : 1)
                                : 0;
}

static int compare_sides(const void *left, const void *right)
{
    const he_hub_edge *a = left, *b = right;
    const int ends = compare_ends(a, b);
    return ends != 0 ? ends : a->triangle < b->triangle ? -1 : a->triangle > b->triangle;
}

/* Counts the sides of triangles between two hubs, and puts them into the list unless it is NULL. */
static size_t list_sides(const he_feature_normals *n, he_hub_edge *list)
{
    size_t count = 0;
    for (uint32_t i = 0; i < n->tree->count; i++) {
        const uint32_t *v = n->tree->triangles[i].vertex;
        const bool hub[3] = {is_hub(n, v[0]), is_hub(n, v[1]), is_hub(n, v[2])};
        he_vec3 p[3];
        for (int k = 0; k < 3 && hub[0] + hub[1] + hub[2] > 1; k++) {
            const uint32_t a = v[k], b = v[(k + 1) % 3];
            if (!hub[k] || !hub[(k + 1) % 3]) {
                continue;
            }
            if (list != NULL) {
                list[count] =
                    (he_hub_edge){a < b ? a : b, a < b ? b : a, i, triangle_normal(n, i, p)};
            }
            count++;
        }
    }
    return count;
}

/* Adds up the normals at each edge between hubs. */
static he_status list_hub_edges(he_feature_normals *n, he_budget *budget, he_error *err)
{
    he_status status = he_budget_take(budget, n->tree->count, err);
    const size_t sides = status == HE_OK ? list_sides(n, NULL) : 0;
    if (sides == 0) {
        return status;
    }
    /* The second look at all triangles, and sorting, which compares each side that often. */
    uint64_t steps = n->tree->count;
    for (size_t half = sides; half > 0; half /= 2) {
        steps += sides;
    }
    status = he_budget_take(budget, steps, err);
    if (status != HE_OK) {
        return status;
    }
    n->hub_edges = he_mem_array(NULL, sides, sizeof *n->hub_edges);
    if (n->hub_edges == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory for the normals of %zu edges", sides);
    }
    he_hub_edge *list = n->hub_edges;
    (void)list_sides(n, list);
    qsort(list, sides, sizeof *list, compare_sides);
    size_t count = 0;
    for (size_t i = 0; i < sides; i++) {
        if (count > 0 && compare_ends(&list[count - 1], &list[i]) == 0) {
            list[count - 1].normal = he_vec3_add(list[count - 1].normal, list[i].normal);
        } else {
            list[count++] = list[i];
        }
    }
    n->hub_edge_count = count;
    return HE_OK;
}

static he_vec3 hub_edge_normal(const he_feature_normals *n, uint32_t a, uint32_t b)
{
    const he_hub_edge wanted = {.low = a < b ? a : b, .high = a < b ? b : a};
    size_t low = 0, high = n->hub_edge_count;
    while (high - low > 1) {
        const size_t middle = low + (high - low) / 2;
        if (compare_ends(&n->hub_edges[middle], &wanted) <= 0) {
            low = middle;
        } else {
            high = middle;
        }
    }
    return n->hub_edges[low].normal;
}

/* --- the whole --- */

he_status he_feature_normals_make(const he_mesh *m, const he_bvh *tree, he_budget *budget,
                                  he_feature_normals *out, he_error *err)
{
    out->mesh = m;
    out->tree = tree;
    he_status status = reserve(out, err);
    if (status != HE_OK) {
        return status;
    }
    status = he_budget_take(budget, 2 * (uint64_t)tree->count + m->c.vertices.issued, err);
    if (status != HE_OK) {
        return status;
    }
    list_triangles(out);
    status = list_hub_edges(out, budget, err);
    for (uint32_t i = 0; i < tree->count && status == HE_OK; i++) {
        he_vec3 p[3];
        const he_vec3 normal = triangle_normal(out, i, p);
        for (int k = 0; k < 3; k++) {
            const double angle =
                he_vec3_angle(he_vec3_sub(p[(k + 1) % 3], p[k]), he_vec3_sub(p[(k + 2) % 3], p[k]));
            he_vec3 *sum = &out->vertex[tree->triangles[i].vertex[k]];
            *sum = he_vec3_add(*sum, he_vec3_scale(normal, angle));
        }
        status = he_budget_take(budget, HE_BVH_LOOK, err);
    }
    return status;
}

void he_feature_normals_clear(he_feature_normals *normals)
{
    he_mem_free(normals->vertex);
    he_mem_free(normals->first);
    he_mem_free(normals->at);
    he_mem_free(normals->hub_edges);
    *normals = (he_feature_normals){.vertex = NULL};
}

static bool has_corner(const he_bvh_triangle *t, uint32_t v)
{
    return t->vertex[0] == v || t->vertex[1] == v || t->vertex[2] == v;
}

/* Returns the sum of the normals of the triangles that have both vertices, which are searched at
 * the one with fewer triangles. */
static he_vec3 edge_normal(const he_feature_normals *n, uint32_t a, uint32_t b)
{
    if (is_hub(n, a) && is_hub(n, b)) {
        return hub_edge_normal(n, a, b);
    }
    if (n->first[a + 1] - n->first[a] > n->first[b + 1] - n->first[b]) {
        const uint32_t swap = a;
        a = b;
        b = swap;
    }
    he_vec3 sum = {0, 0, 0}, p[3];
    for (uint32_t i = n->first[a]; i < n->first[a + 1]; i++) {
        if (has_corner(&n->tree->triangles[n->at[i]], b)) {
            sum = he_vec3_add(sum, triangle_normal(n, n->at[i], p));
        }
    }
    return sum;
}

he_vec3 he_feature_normal(const he_feature_normals *n, const he_bvh_found *found)
{
    const uint32_t *vertex = n->tree->triangles[found->triangle].vertex;
    he_vec3 p[3];
    for (int k = 0; k < 3; k++) {
        const double before = found->weight[(k + 1) % 3], after = found->weight[(k + 2) % 3];
        if (!(before > 0) && !(after > 0)) {
            return n->vertex[vertex[k]];
        }
    }
    for (int k = 0; k < 3; k++) {
        if (!(found->weight[k] > 0)) {
            return edge_normal(n, vertex[(k + 1) % 3], vertex[(k + 2) % 3]);
        }
    }
    return triangle_normal(n, found->triangle, p);
}
