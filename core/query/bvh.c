#include "query/bvh.h"

#include "mesh/long_faces.h"
#include "mesh/walk.h"
#include "query/bvh_disc.h"
#include "query/drawing.h"
#include "query/geometry.h"
#include "query/scale.h"

#include <string.h>

enum { BINS = 16 };

typedef struct box {
    double min[3], max[3];
} box;

typedef struct builder {
    he_bvh *tree;
    box *boxes;      /* of triangles, in the order in which they were listed */
    uint32_t *order; /* the triangles, rearranged */
    size_t capacity; /* nodes there is room for */
    he_watch *watch;
} builder;

static const box NOTHING = {{DBL_MAX, DBL_MAX, DBL_MAX}, {-DBL_MAX, -DBL_MAX, -DBL_MAX}};

static void include(box *b, const box *other)
{
    for (int k = 0; k < 3; k++) {
        b->min[k] = other->min[k] < b->min[k] ? other->min[k] : b->min[k];
        b->max[k] = other->max[k] > b->max[k] ? other->max[k] : b->max[k];
    }
}

/* Half the surface. */
static double surface(const box *b)
{
    double x = b->max[0] - b->min[0], y = b->max[1] - b->min[1], z = b->max[2] - b->min[2];
    return x * y + y * z + z * x;
}

/* Twice the centre. */
static double middle(const box *b, int axis)
{
    return b->min[axis] + b->max[axis];
}

/* --- the triangles --- */

static he_status count_triangles(const he_mesh *m, uint32_t *out, he_error *err)
{
    uint64_t corners = 2 * (uint64_t)m->c.edges.live - m->c.boundary_halfedges;
    uint64_t count = corners - 2 * (uint64_t)m->c.faces.live;
    if (count > (uint64_t)1 << 31) {
        return he_fail_plain(err, HE_IDS_EXHAUSTED, "the mesh has %llu triangles",
                             (unsigned long long)count);
    }
    *out = (uint32_t)count;
    return HE_OK;
}

static he_status list_triangles(he_bvh *tree, const he_mesh *m, he_error *err)
{
    he_frame frame = he_frame_of(m);
    he_drawing d;
    he_status status = he_drawing_init(&d, m, &frame, err);
    if (status != HE_OK) {
        return status;
    }
    uint32_t at = 0;
    for (uint32_t f = 0; f < m->c.faces.issued; f++) {
        if (m->c.face_halfedge[f] == HE_DEAD) {
            continue;
        }
        he_drawing_walk walk;
        uint32_t row[HE_DRAWN_ROW];
        he_drawing_begin(&d, f, &walk);
        while (he_drawing_next(&d, &walk, row)) {
            tree->triangles[at++] = (he_bvh_triangle){{row[0], row[1], row[2]}, f};
        }
    }
    tree->count = at;
    he_drawing_clear(&d);
    return HE_OK;
}

static void find_boxes(const builder *b, const he_mesh *m)
{
    for (uint32_t i = 0; i < b->tree->count; i++) {
        box bounds = NOTHING;
        for (int k = 0; k < 3; k++) {
            he_vec3 p =
                he_vec3_scale(m->c.position[b->tree->triangles[i].vertex[k]], b->tree->scale);
            box corner = {{p.x, p.y, p.z}, {p.x, p.y, p.z}};
            include(&bounds, &corner);
        }
        b->boxes[i] = bounds;
        b->order[i] = i;
    }
}

/* --- splitting --- */

/* A run of `order` to be made a node. */
typedef struct run {
    uint32_t node, first, count, depth;
} run;

typedef struct cut {
    int axis; /* -1: none was found */
    int bin;  /* what lies in bins below goes left */
    double low, factor;
} cut;

static int bin_of(const cut *c, const box *b)
{
    int bin = (int)((middle(b, c->axis) - c->low) * c->factor);
    return bin < 0 ? 0 : bin >= BINS ? BINS - 1 : bin;
}

/* The cheapest place to cut along one axis; the cost comes back, DBL_MAX where all go one way. */
static double cut_along(const builder *b, const run *r, cut *c)
{
    uint32_t counts[BINS] = {0};
    box bins[BINS];
    double right_cost[BINS];
    for (int i = 0; i < BINS; i++) {
        bins[i] = NOTHING;
    }
    for (uint32_t i = 0; i < r->count; i++) {
        const box *own = &b->boxes[b->order[r->first + i]];
        int bin = bin_of(c, own);
        counts[bin]++;
        include(&bins[bin], own);
    }
    box side = NOTHING;
    uint32_t held = 0;
    for (int i = BINS - 1; i > 0; i--) {
        include(&side, &bins[i]);
        held += counts[i];
        right_cost[i] = held == 0 || held == r->count ? DBL_MAX : surface(&side) * held;
    }
    double best = DBL_MAX;
    side = NOTHING;
    held = 0;
    for (int i = 1; i < BINS; i++) {
        include(&side, &bins[i - 1]);
        held += counts[i - 1];
        if (right_cost[i] < DBL_MAX && held > 0 && surface(&side) * held + right_cost[i] < best) {
            best = surface(&side) * held + right_cost[i];
            c->bin = i;
        }
    }
    return best;
}

static cut find_cut(const builder *b, const run *r)
{
    cut best = {.axis = -1};
    double cost = DBL_MAX;
    box middles = NOTHING;
    for (uint32_t i = 0; i < r->count; i++) {
        const box *own = &b->boxes[b->order[r->first + i]];
        for (int k = 0; k < 3; k++) {
            double x = middle(own, k);
            middles.min[k] = x < middles.min[k] ? x : middles.min[k];
            middles.max[k] = x > middles.max[k] ? x : middles.max[k];
        }
    }
    for (int k = 0; k < 3; k++) {
        double factor = BINS / (middles.max[k] - middles.min[k]);
        if (!isfinite(factor)) {
            continue;
        }
        cut c = {k, 0, middles.min[k], factor};
        double own = cut_along(b, r, &c);
        if (own < cost) {
            cost = own;
            best = c;
        }
    }
    return best;
}

/* How many of the run went left. */
static uint32_t divide(builder *b, const run *r)
{
    cut c = {.axis = -1};
    if (r->depth < HE_BVH_DEEP) {
        c = find_cut(b, r);
    }
    if (c.axis < 0) {
        return r->count / 2;
    }
    uint32_t *order = b->order + r->first, left = 0;
    for (uint32_t i = 0; i < r->count; i++) {
        if (bin_of(&c, &b->boxes[order[i]]) < c.bin) {
            uint32_t swap = order[i];
            order[i] = order[left];
            order[left++] = swap;
        }
    }
    return left;
}

/* Room for two more nodes. */
static he_status grow(builder *b, he_error *err)
{
    size_t need = (size_t)b->tree->node_count + 2;
    if (need > b->capacity) {
        size_t grown = he_mem_grown(b->capacity, need);
        he_bvh_node *nodes = he_mem_array(b->tree->nodes, grown, sizeof *nodes);
        if (nodes == NULL) {
            return he_fail_plain(err, HE_NO_MEMORY, "no memory for the boxes of a tree");
        }
        b->tree->nodes = nodes;
        b->capacity = grown;
    }
    return HE_OK;
}

/* Not greater, not less. */
static float downward(double x)
{
    float near = (float)x;
    return near > x ? nextafterf(near, -HUGE_VALF) : near;
}

static float upward(double x)
{
    return -downward(-x);
}

static he_status build(builder *b, he_error *err)
{
    run stack[HE_BVH_STACK];
    int depth = 0;
    uint32_t made = 0;
    stack[depth++] = (run){0, 0, b->tree->count, 0};
    b->tree->node_count = 1;
    while (depth > 0) {
        run r = stack[--depth];
        he_status status = grow(b, err);
        if (status == HE_OK) {
            status = he_watch_at(b->watch, made++, b->capacity, err);
        }
        if (status != HE_OK) {
            return status;
        }
        he_bvh_node *node = &b->tree->nodes[r.node];
        box bounds = NOTHING;
        for (uint32_t i = 0; i < r.count; i++) {
            include(&bounds, &b->boxes[b->order[r.first + i]]);
        }
        for (int k = 0; k < 3; k++) {
            node->min[k] = downward(bounds.min[k]);
            node->max[k] = upward(bounds.max[k]);
        }
        if (r.node == 0) {
            memcpy(b->tree->min, bounds.min, sizeof bounds.min);
            memcpy(b->tree->max, bounds.max, sizeof bounds.max);
        }
        node->first = r.first;
        node->count = r.count;
        if (r.count > HE_BVH_LEAF) {
            uint32_t left = divide(b, &r), child = b->tree->node_count;
            b->tree->node_count += 2;
            node->first = child;
            node->count = 0;
            stack[depth++] = (run){child + 1, r.first + left, r.count - left, r.depth + 1};
            stack[depth++] = (run){child, r.first, left, r.depth + 1};
        }
    }
    return HE_OK;
}

/* In the order of leaves. */
static bool arrange(builder *b)
{
    he_bvh *tree = b->tree;
    he_bvh_triangle *sorted = he_mem_array(NULL, tree->count, sizeof *sorted);
    if (sorted == NULL) {
        return false;
    }
    for (uint32_t i = 0; i < tree->count; i++) {
        sorted[i] = tree->triangles[b->order[i]];
    }
    he_mem_free(tree->triangles);
    tree->triangles = sorted;
    tree->discs = he_mem_array(NULL, tree->node_count, sizeof *tree->discs);
    if (tree->discs == NULL) {
        return false;
    }
    /* Smaller, so what was there is kept if it cannot be moved. */
    he_bvh_node *nodes = he_mem_array(tree->nodes, tree->node_count, sizeof *nodes);
    tree->nodes = nodes == NULL ? tree->nodes : nodes;
    return true;
}

void he_bvh_free(he_bvh *tree)
{
    if (tree != NULL) {
        he_mem_free(tree->nodes);
        he_mem_free(tree->discs);
        he_mem_free(tree->triangles);
        he_mem_free(tree);
    }
}

he_status he_bvh_new(const he_mesh *m, he_watch *watch, he_bvh **out, he_error *err)
{
    uint32_t count = 0;
    he_box bounds;
    he_status status = count_triangles(m, &count, err);
    if (status == HE_OK) {
        status = he_long_faces_keep(m, watch, err);
    }
    if (status != HE_OK) {
        return status;
    }
    builder b = {.tree = he_mem_zero(1, sizeof *b.tree), .watch = watch};
    if (b.tree == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory for a tree of boxes");
    }
    he_surface_box(m, &bounds);
    b.tree->exponent = he_exponent_of(fmax(he_vec3_extent(bounds.min), he_vec3_extent(bounds.max)));
    b.tree->scale = ldexp(1, -b.tree->exponent);
    if (count == 0) {
        *out = b.tree;
        return HE_OK;
    }
    /* As many as there are when most leaves are full, and one for the first look ahead. */
    b.capacity = count / 2 + 4;
    b.tree->nodes = he_mem_array(NULL, b.capacity, sizeof *b.tree->nodes);
    b.tree->triangles = he_mem_array(NULL, count, sizeof *b.tree->triangles);
    b.boxes = he_mem_array(NULL, count, sizeof *b.boxes);
    b.order = he_mem_array(NULL, count, sizeof *b.order);
    if (b.tree->nodes == NULL || b.tree->triangles == NULL || b.boxes == NULL || b.order == NULL) {
        status = he_fail_plain(err, HE_NO_MEMORY, "no memory for a tree of %u triangles", count);
        goto done;
    }
    status = he_watch_phase(watch, "sorting by place", 1, err);
    if (status == HE_OK) {
        status = list_triangles(b.tree, m, err);
    }
    if (status == HE_OK) {
        find_boxes(&b, m);
        status = build(&b, err);
    }
    if (status == HE_OK && !arrange(&b)) {
        status = he_fail_plain(err, HE_NO_MEMORY, "no memory for a tree of %u triangles", count);
    }
    if (status == HE_OK) {
        he_bvh_find_discs(b.tree, m);
    }
done:
    he_mem_free(b.boxes);
    he_mem_free(b.order);
    if (status != HE_OK) {
        he_bvh_free(b.tree);
        return status;
    }
    *out = b.tree;
    return HE_OK;
}
