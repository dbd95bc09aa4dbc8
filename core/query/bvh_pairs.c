#include "query/bvh_walk.h"
#include "query/meet.h"

#include <assert.h>
#include <stdlib.h>

/* On the way down each level leaves two pairs behind at most; a pair is split on either side. */
enum { PAIRS = 6 * HE_BVH_STACK };

/* A triangle of a leaf, and its box. */
typedef struct prism {
    he_vec3 corner[3];
    double min[3], max[3];
} prism;

typedef struct search {
    const he_bvh *tree;
    const he_mesh *m;
    size_t most;
    uint64_t *budget;
    he_ids *pairs;
    he_watch *watch;
    he_error *err;
} search;

static bool nodes_apart(const he_bvh_node *a, const he_bvh_node *b)
{
    for (int k = 0; k < 3; k++) {
        if (a->min[k] > b->max[k] || b->min[k] > a->max[k]) {
            return true;
        }
    }
    return false;
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

static prism load(const search *s, uint32_t triangle)
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

static he_status try_triangles(search *s, uint32_t i, uint32_t k, const prism *a, const prism *b)
{
    uint32_t f = s->tree->triangles[i].face, g = s->tree->triangles[k].face;
    if (f == g || !he_triangles_meet(a->corner, b->corner)) {
        return HE_OK;
    }
    he_status status = he_ids_reserve(s->pairs, 2, s->err);
    if (status == HE_OK) {
        s->pairs->ids[s->pairs->count++] = f < g ? f : g;
        s->pairs->ids[s->pairs->count++] = f < g ? g : f;
    }
    return status;
}

/* a may be b. */
static he_status try_leaves(search *s, const he_bvh_node *a, const he_bvh_node *b)
{
    prism others[HE_BVH_LEAF];
    he_status status = HE_OK;
    for (uint32_t k = 0; k < b->count; k++) {
        others[k] = load(s, b->first + k);
    }
    for (uint32_t i = 0; i < a->count; i++) {
        const prism own = a == b ? others[i] : load(s, a->first + i);
        for (uint32_t k = a == b ? i + 1 : 0; k < b->count && status == HE_OK; k++) {
            if (!apart(&own, &others[k])) {
                status = try_triangles(s, a->first + i, b->first + k, &own, &others[k]);
            }
        }
    }
    return status;
}

/* False when there may be more than what was found. */
static he_status walk(search *s, size_t begin, bool *complete)
{
    struct {
        uint32_t a, b;
    } stack[PAIRS];
    size_t depth = 0;
    uint64_t steps = 0;
    uint32_t done = 0; /* triangles that met all that are to come */
    he_status status = he_watch_phase(s->watch, "intersecting", 1, s->err);
    stack[depth].a = 0;
    stack[depth++].b = 0;
    *complete = true;
    while (depth > 0 && status == HE_OK) {
        uint32_t at = stack[--depth].a, other = stack[depth].b;
        const he_bvh_node *a = &s->tree->nodes[at], *b = &s->tree->nodes[other];
        if (!he_bvh_spend(s->budget) || (s->pairs->count - begin) / 2 >= s->most) {
            *complete = false;
            break;
        }
        if (nodes_apart(a, b)) {
            continue;
        }
        if (s->watch != NULL && steps++ % HE_WATCH_STRIDE == 0) {
            status = he_watch_step(s->watch, done, s->tree->count, s->err);
        }
        assert(depth + 3 <= PAIRS);
        if (a->count > 0 && b->count > 0) {
            uint64_t tests = (uint64_t)a->count * b->count;
            *s->budget -= tests < *s->budget ? tests : *s->budget;
            status = status == HE_OK ? try_leaves(s, a, b) : status;
            done += a == b ? a->count : 0;
        } else if (at == other) {
            stack[depth].a = a->first;
            stack[depth++].b = a->first;
            stack[depth].a = a->first + 1;
            stack[depth++].b = a->first + 1;
            stack[depth].a = a->first;
            stack[depth++].b = a->first + 1;
        } else {
            /* Split the one that is no leaf, or is higher up: nodes are numbered from the root. */
            bool first = b->count > 0 || (a->count == 0 && at < other);
            for (uint32_t side = 0; side < 2; side++) {
                stack[depth].a = first ? a->first + side : at;
                stack[depth++].b = first ? other : b->first + side;
            }
        }
    }
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

he_status he_bvh_intersections(const he_bvh *tree, const he_mesh *m, size_t most, uint64_t *budget,
                               he_watch *watch, he_ids *pairs, bool *complete, he_error *err)
{
    search s = {tree, m, most, budget, pairs, watch, err};
    size_t begin = pairs->count, kept = begin;
    bool all = true;
    he_status status = tree->count == 0 ? HE_OK : walk(&s, begin, &all);
    if (status != HE_OK) {
        pairs->count = begin;
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
    *complete = all;
    return HE_OK;
}
