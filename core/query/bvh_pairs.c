#include "query/bvh_pairs.h"

#include "geometry/triangle_intersection.h"
#include "query/bvh_walk.h"

#include <stdlib.h>

/* A triangle in a leaf of the tree: its corners, and the box around it. */
typedef struct prism {
    he_vec3 corner[3];
    double min[3], max[3];
} prism;

/* The hubs at which all triangles below a node of the tree have a corner (a hub is a position at
 * which very many triangles meet, hubs.h), and the face to which all these triangles belong. Unused
 * entries are HE_NONE. */
enum { HUBS = HE_HUBS_OF, COMMON = HUBS + 1 };

typedef struct common {
    uint32_t of[COMMON]; /* hubs first, the face last */
} common;

typedef struct walk {
    he_pair_search search;
    /* The hubs and the face that all triangles below each node share. NULL if the mesh has neither
     * hubs nor faces of very many triangles. */
    common *commons;
    /* number of triangles that were tested against all triangles after them in the tree */
    uint32_t done;
    uint32_t leaves; /* number of leaves whose triangles were tested against one another */
} walk;

/* Progress is reported once for every TOLD leaves. */
enum { TOLD = 1024 };

/* --- triangles --- */

uint32_t he_pair_hub(const he_pair_search *s, uint32_t i, uint32_t k)
{
    const uint32_t *a = s->hubs_of + (size_t)i * HUBS, *b = s->hubs_of + (size_t)k * HUBS;
    for (int x = 0; x < HUBS && a[x] != HE_NONE; x++) {
        for (int y = 0; y < HUBS; y++) {
            if (a[x] == b[y]) {
                return a[x];
            }
        }
    }
    return HE_NONE;
}

he_status he_pair_try(he_pair_search *s, uint32_t i, uint32_t k, const he_vec3 a[3],
                      const he_vec3 b[3], he_error *err)
{
    uint32_t f = s->tree->triangles[i].face, g = s->tree->triangles[k].face;
    if (f == g) {
        return HE_OK;
    }
    he_status status = he_budget_take(s->budget, HE_BVH_PAIR, err);
    if (status != HE_OK || !he_triangles_intersect(a, b)) {
        return status;
    }
    status = he_ids_reserve(s->pairs, 2, err);
    if (status == HE_OK) {
        s->pairs->ids[s->pairs->count++] = f < g ? f : g;
        s->pairs->ids[s->pairs->count++] = f < g ? g : f;
    }
    return status == HE_OK && s->pairs->count >= s->most
               ? he_fail_plain(err, HE_LIMIT, "more pairs of faces intersect than can be listed")
               : status;
}

static bool apart(const prism *a, const prism *b)
{
    for (int k = 0; k < 3; k++) {
        if (a->min[k] > b->max[k] || b->min[k] > a->max[k]) {
            return true;
        }
    }
    return false;
}

static prism load(const he_pair_search *s, uint32_t triangle)
{
    prism p;
    he_bvh_corners(s->tree, s->m, triangle, p.corner);
    for (int k = 0; k < 3; k++) {
        double x[3];
        for (int i = 0; i < 3; i++) {
            x[i] = k == 0 ? p.corner[i].x : k == 1 ? p.corner[i].y : p.corner[i].z;
        }
        double least = x[0] < x[1] ? x[0] : x[1], most = x[0] > x[1] ? x[0] : x[1];
        p.min[k] = least < x[2] ? least : x[2];
        p.max[k] = most > x[2] ? most : x[2];
    }
    return p;
}

/* Tests each triangle of leaf a against each triangle of leaf b for intersection. Leaf a and leaf b
 * may be one leaf. */
static he_status try_leaves(void *context, const he_box_node *a, const he_box_node *b,
                            he_error *err)
{
    walk *w = context;
    he_pair_search *s = &w->search;
    prism others[HE_BOXES_LEAF];
    he_status status = he_budget_take(s->budget, (uint64_t)a->count * b->count, err);
    for (uint32_t k = 0; k < b->count; k++) {
        others[k] = load(s, b->first + k);
    }
    for (uint32_t i = 0; i < a->count; i++) {
        const prism own = a == b ? others[i] : load(s, a->first + i);
        for (uint32_t k = a == b ? i + 1 : 0; k < b->count && status == HE_OK; k++) {
            if (!apart(&own, &others[k]) &&
                (s->hubs_of == NULL || he_pair_hub(s, a->first + i, b->first + k) == HE_NONE)) {
                status =
                    he_pair_try(s, a->first + i, b->first + k, own.corner, others[k].corner, err);
            }
        }
    }
    if (a == b) {
        w->done += a->count;
        if (status == HE_OK) {
            status = w->leaves++ % TOLD == 0
                         ? he_progress_step(s->budget->progress, w->done, s->tree->count, err)
                         : HE_OK;
        }
    }
    return status;
}

/* --- nodes --- */

static bool have(const common *c, uint32_t what, int from, int to)
{
    for (int i = from; i < to; i++) {
        if (c->of[i] == what) {
            return true;
        }
    }
    return false;
}

static common both(const common *a, const common *b)
{
    common out = {{HE_NONE, HE_NONE, HE_NONE, HE_NONE}};
    int count = 0;
    for (int i = 0; i < HUBS; i++) {
        if (a->of[i] != HE_NONE && have(b, a->of[i], 0, HUBS)) {
            out.of[count++] = a->of[i];
        }
    }
    out.of[HUBS] = a->of[HUBS] == b->of[HUBS] ? a->of[HUBS] : HE_NONE;
    return out;
}

static common of_triangle(const he_pair_search *s, uint32_t i)
{
    common out = {{HE_NONE, HE_NONE, HE_NONE, s->tree->triangles[i].face}};
    for (int k = 0; k < HUBS && s->hubs_of != NULL; k++) {
        out.of[k] = s->hubs_of[(size_t)i * HUBS + (size_t)k];
    }
    return out;
}

/* Finds for each node of the tree the hubs and the face that all triangles below the node share.
 * Children have higher numbers than their parent, so the loop runs from the highest number to the
 * lowest. */
static void find_commons(walk *w)
{
    for (uint32_t at = w->search.tree->node_count; at-- > 0;) {
        const he_box_node *node = &w->search.tree->nodes[at];
        if (node->count == 0) {
            w->commons[at] = both(&w->commons[node->first], &w->commons[node->first + 1]);
            continue;
        }
        w->commons[at] = of_triangle(&w->search, node->first);
        for (uint32_t i = 1; i < node->count; i++) {
            common other = of_triangle(&w->search, node->first + i);
            w->commons[at] = both(&w->commons[at], &other);
        }
    }
}

/* Returns true if the box lies outside the slab between the two parallel planes that bound a disc.
 * The test has a margin larger than the rounding of the disc's normal to floats (bvh_disc.c). */
static bool is_beside(const he_bvh_disc *slab, const he_box_node *box)
{
    double off = 0, reach = slab->thick, size = 0;
    for (int k = 0; k < 3; k++) {
        double from = 0.5 * ((double)box->min[k] + box->max[k]) - slab->center[k];
        double half = 0.5 * ((double)box->max[k] - box->min[k]);
        off += slab->normal[k] * from;
        reach += fabs((double)slab->normal[k]) * half;
        size += fabs(from) + half;
    }
    return fabs(off) > reach + 1e-6 * size;
}

/* Returns true if no triangle below node a needs to be tested against a triangle below node b. The
 * function is used only if there are hubs or faces of very many triangles; in other meshes the
 * boxes separate triangles well enough. */
static bool is_needless(void *context, uint32_t a, uint32_t b)
{
    const walk *w = context;
    const he_bvh *tree = w->search.tree;
    common shared = both(&w->commons[a], &w->commons[b]);
    if (shared.of[0] != HE_NONE || shared.of[HUBS] != HE_NONE) {
        /* Triangles that meet at a hub are tested by he_pairs_at_hub; triangles of one face are
         * never tested against one another. */
        return true;
    }
    return a != b && (is_beside(&tree->discs[a], &tree->nodes[b]) ||
                      is_beside(&tree->discs[b], &tree->nodes[a]));
}

/* --- the whole search --- */

static he_status prepare(walk *w, he_error *err)
{
    const he_bvh *tree = w->search.tree;
    if (tree->hubs.count == 0 && !tree->has_wide_faces) {
        return HE_OK;
    }
    w->commons = he_mem_array(NULL, tree->node_count, sizeof *w->commons);
    w->search.hubs_of = tree->hubs.count == 0
                            ? NULL
                            : he_mem_array(NULL, tree->count, HUBS * sizeof *w->search.hubs_of);
    if (w->commons == NULL || (tree->hubs.count > 0 && w->search.hubs_of == NULL)) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory for the shared vertices of %u triangles",
                             tree->count);
    }
    if (w->search.hubs_of != NULL) {
        he_hubs_of_triangles(&tree->hubs, tree->count, w->search.hubs_of);
    }
    find_commons(w);
    return HE_OK;
}

static he_status search(walk *w, he_error *err)
{
    static const he_boxes_visit plain = {NULL, try_leaves}, grouped = {is_needless, try_leaves};
    he_pair_search *s = &w->search;
    he_status status = he_progress_phase(s->budget->progress, "intersecting", 1, err);
    if (status == HE_OK) {
        status = prepare(w, err);
    }
    for (uint32_t hub = 0; hub < s->tree->hubs.count && status == HE_OK; hub++) {
        status = he_pairs_at_hub(s, hub, err);
    }
    if (status == HE_OK) {
        status = he_boxes_visit_pairs(s->tree->nodes, w->commons == NULL ? &plain : &grouped, w,
                                      s->budget, err);
    }
    he_mem_free(w->commons);
    he_mem_free(s->hubs_of);
    return status;
}

static int compare(const void *left, const void *right)
{
    const uint32_t *a = left, *b = right;
    if (a[0] != b[0]) {
        return a[0] < b[0] ? -1 : 1;
    }
    return (a[1] > b[1]) - (a[1] < b[1]);
}

he_status he_bvh_intersections(const he_bvh *tree, const he_mesh *m, size_t most, he_budget *budget,
                               he_ids *pairs, bool *complete, he_error *err)
{
    size_t begin = pairs->count, kept = begin, room = (SIZE_MAX - begin) / 2;
    walk w = {.search = {tree, m, budget, begin + 2 * (most < room ? most : room), pairs, NULL}};
    he_error own = {0};
    he_status status = tree->count == 0 ? HE_OK : search(&w, &own);
    if (status != HE_OK && status != HE_LIMIT) {
        pairs->count = begin;
        if (err != NULL) {
            *err = own;
        }
        return status;
    }
    if (pairs->count > begin) {
        qsort(pairs->ids + begin, (pairs->count - begin) / 2, 2 * sizeof *pairs->ids, compare);
    }
    for (size_t i = begin; i < pairs->count; i += 2) {
        if (kept == begin || compare(pairs->ids + kept - 2, pairs->ids + i) != 0) {
            pairs->ids[kept++] = pairs->ids[i];
            pairs->ids[kept++] = pairs->ids[i + 1];
        }
    }
    pairs->count = kept;
    *complete = status == HE_OK;
    return HE_OK;
}
