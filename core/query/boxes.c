#include "query/boxes.h"

#include "base/mem.h"

#include <assert.h>
#include <float.h>
#include <math.h>
#include <string.h>

enum {
    BINS = 16,
    /* Capacity of the stack of pairs of nodes. A pair is replaced by at most three pairs, of which
     * two wait on the stack while the third is handled. A pair can be replaced once for each level
     * of the tree below either of its two nodes. */
    PAIRS = 6 * HE_BOXES_STACK
};

typedef struct builder {
    he_boxes tree;
    const he_bounds *boxes; /* box of each item; the items of the tree are triangles, for example */
    const uint32_t *group;  /* group of each item; NULL if there are no groups */
    he_bounds *group_boxes;
    size_t capacity; /* number of nodes for which there is memory */
    he_budget *budget;
} builder;

he_bounds he_bounds_none(void)
{
    return (he_bounds){{DBL_MAX, DBL_MAX, DBL_MAX}, {-DBL_MAX, -DBL_MAX, -DBL_MAX}};
}

void he_bounds_include(he_bounds *b, const he_bounds *other)
{
    for (int k = 0; k < 3; k++) {
        b->min[k] = other->min[k] < b->min[k] ? other->min[k] : b->min[k];
        b->max[k] = other->max[k] > b->max[k] ? other->max[k] : b->max[k];
    }
}

/* Returns half the surface area of a box. */
static double surface(const he_bounds *b)
{
    double x = b->max[0] - b->min[0], y = b->max[1] - b->min[1], z = b->max[2] - b->min[2];
    return x * y + y * z + z * x;
}

/* Returns twice the coordinate of a box's centre along an axis. */
static double middle(const he_bounds *b, int axis)
{
    return b->min[axis] + b->max[axis];
}

/* --- splitting --- */

/* A run of consecutive entries of `order`, the list of all items, that becomes one node of the
 * tree. */
typedef struct run {
    uint32_t node, first, count, depth;
    uint32_t least, most; /* lowest and highest group number of the items in the run */
} run;

typedef struct cut {
    int axis; /* axis across which the run is cut; -1 if no cut was found */
    int bin;  /* items in bins with a lower number than this go to the left part */
    double low, factor;
} cut;

static uint32_t group_of(const builder *b, uint32_t thing)
{
    return b->group == NULL ? 0 : b->group[thing];
}

/* Returns the box that decides whether an item goes to the left or the right part when its run is
 * divided: the box of the item, or the box of the item's group. */
static const he_bounds *place_of(const builder *b, const run *r, uint32_t i)
{
    uint32_t thing = b->tree.order[r->first + i];
    return r->least == r->most || b->group[thing] == 0 ? &b->boxes[thing]
                                                       : &b->group_boxes[b->group[thing]];
}

static int bin_of(const cut *c, const he_bounds *b)
{
    int bin = (int)((middle(b, c->axis) - c->low) * c->factor);
    return bin < 0 ? 0 : bin >= BINS ? BINS - 1 : bin;
}

/* Finds the cheapest cut of a run into two parts across the axis of `c`. Returns false if every cut
 * would leave one part empty. */
static bool find_bin(const builder *b, const run *r, cut *c)
{
    uint32_t counts[BINS] = {0};
    he_bounds bins[BINS];
    double right_cost[BINS];
    for (int i = 0; i < BINS; i++) {
        bins[i] = he_bounds_none();
    }
    for (uint32_t i = 0; i < r->count; i++) {
        const he_bounds *own = place_of(b, r, i);
        int bin = bin_of(c, own);
        counts[bin]++;
        he_bounds_include(&bins[bin], own);
    }
    he_bounds side = he_bounds_none();
    uint32_t held = 0;
    for (int i = BINS - 1; i > 0; i--) {
        he_bounds_include(&side, &bins[i]);
        held += counts[i];
        right_cost[i] = held == 0 || held == r->count ? DBL_MAX : surface(&side) * held;
    }
    double best = DBL_MAX;
    side = he_bounds_none();
    held = 0;
    for (int i = 1; i < BINS; i++) {
        he_bounds_include(&side, &bins[i - 1]);
        held += counts[i - 1];
        if (right_cost[i] < DBL_MAX && held > 0 && surface(&side) * held + right_cost[i] < best) {
            best = surface(&side) * held + right_cost[i];
            c->bin = i;
        }
    }
    return best < DBL_MAX;
}

/* Finds the cheapest cut across the axis along which the middles of the items reach farthest, which
 * is mostly the best axis. */
static cut find_cut(const builder *b, const run *r)
{
    he_bounds middles = he_bounds_none();
    for (uint32_t i = 0; i < r->count; i++) {
        const he_bounds *own = place_of(b, r, i);
        for (int k = 0; k < 3; k++) {
            double x = middle(own, k);
            middles.min[k] = x < middles.min[k] ? x : middles.min[k];
            middles.max[k] = x > middles.max[k] ? x : middles.max[k];
        }
    }
    cut c = {.axis = 0};
    for (int k = 1; k < 3; k++) {
        if (middles.max[k] - middles.min[k] > middles.max[c.axis] - middles.min[c.axis]) {
            c.axis = k;
        }
    }
    c.low = middles.min[c.axis];
    c.factor = BINS / (middles.max[c.axis] - c.low);
    if (!isfinite(c.factor) || !find_bin(b, r, &c)) {
        c.axis = -1;
    }
    return c;
}

static bool goes_left(const builder *b, const run *r, const cut *c, uint32_t i)
{
    if (c->axis < 0) {
        uint32_t limit = r->least + (r->most - r->least + 1) / 2;
        return group_of(b, b->tree.order[r->first + i]) < limit;
    }
    return bin_of(c, place_of(b, r, i)) < c->bin;
}

/* Divides a run into two parts by the cheapest cut. Returns how many items are in the left part. */
static uint32_t divide(builder *b, const run *r)
{
    cut c = {.axis = -1};
    if (r->depth < HE_BOXES_DEEP) {
        c = find_cut(b, r);
    }
    if (c.axis < 0 && (r->depth >= HE_BOXES_DEEP || r->least == r->most)) {
        return r->count / 2;
    }
    uint32_t *order = b->tree.order + r->first, left = 0;
    for (uint32_t i = 0; i < r->count; i++) {
        if (goes_left(b, r, &c, i)) {
            uint32_t swap = order[i];
            order[i] = order[left];
            order[left++] = swap;
        }
    }
    return left;
}

/* Allocates memory for two more nodes. */
static he_status grow(builder *b, he_error *err)
{
    size_t need = (size_t)b->tree.node_count + 2;
    if (need > b->capacity) {
        size_t grown = he_mem_grown(b->capacity, need);
        he_box_node *nodes = he_mem_array(b->tree.nodes, grown, sizeof *nodes);
        if (nodes == NULL) {
            return he_fail_plain(err, HE_NO_MEMORY, "no memory for the boxes of a search tree");
        }
        b->tree.nodes = nodes;
        b->capacity = grown;
    }
    return HE_OK;
}

/* Returns the largest float that is not greater than x. */
static float downward(double x)
{
    float near = (float)x;
    return near > x ? nextafterf(near, -HUGE_VALF) : near;
}

static float upward(double x)
{
    return -downward(-x);
}

/* Finds the box around all items of a run, and the lowest and highest number of their groups. */
static he_bounds look(const builder *b, run *r)
{
    he_bounds bounds = he_bounds_none();
    r->least = r->most = group_of(b, b->tree.order[r->first]);
    for (uint32_t i = 0; i < r->count; i++) {
        uint32_t thing = b->tree.order[r->first + i], group = group_of(b, thing);
        he_bounds_include(&bounds, &b->boxes[thing]);
        r->least = group < r->least ? group : r->least;
        r->most = group > r->most ? group : r->most;
    }
    return bounds;
}

static bool is_leaf(const run *r)
{
    return r->count <= HE_BOXES_LEAF && (r->least == r->most || r->depth >= HE_BOXES_DEEP);
}

static he_status build(builder *b, uint32_t count, he_error *err)
{
    run stack[HE_BOXES_STACK];
    size_t depth = 1;
    stack[0] = (run){.count = count};
    b->tree.node_count = 1;
    while (depth > 0) {
        depth--;
        run r = stack[depth];
        he_status status = grow(b, err);
        if (status == HE_OK) {
            status = he_budget_take(b->budget, r.count, err);
        }
        if (status != HE_OK) {
            return status;
        }
        he_box_node *node = &b->tree.nodes[r.node];
        he_bounds bounds = look(b, &r);
        for (int k = 0; k < 3; k++) {
            node->min[k] = downward(bounds.min[k]);
            node->max[k] = upward(bounds.max[k]);
        }
        if (r.node == 0) {
            b->tree.all = bounds;
        }
        node->first = r.first;
        node->count = r.count;
        if (!is_leaf(&r)) {
            uint32_t left = divide(b, &r), child = b->tree.node_count;
            b->tree.node_count += 2;
            node->first = child;
            node->count = 0;
            stack[depth++] = (run){child + 1, r.first + left, r.count - left, r.depth + 1, 0, 0};
            stack[depth++] = (run){child, r.first, left, r.depth + 1, 0, 0};
        }
    }
    return HE_OK;
}

void he_boxes_clear(he_boxes *tree)
{
    he_mem_free(tree->nodes);
    he_mem_free(tree->order);
    *tree = (he_boxes){.nodes = NULL};
}

static void find_group_boxes(builder *b, uint32_t count, uint32_t groups)
{
    for (uint32_t g = 0; g < groups; g++) {
        b->group_boxes[g] = he_bounds_none();
    }
    for (uint32_t i = 0; i < count; i++) {
        he_bounds_include(&b->group_boxes[b->group[i]], &b->boxes[i]);
    }
}

he_status he_boxes_make(const he_boxed *things, he_budget *budget, he_boxes *out, he_error *err)
{
    const uint32_t count = things->count, *group = things->group;
    builder b = {.boxes = things->boxes, .group = group, .budget = budget};
    /* Most trees have full leaves and need fewer nodes than this; `grow` allocates more if
     * necessary. */
    b.capacity = count / 2 + 4;
    b.tree.nodes = he_mem_array(NULL, b.capacity, sizeof *b.tree.nodes);
    b.tree.order = he_mem_array(NULL, count, sizeof *b.tree.order);
    b.group_boxes =
        group == NULL ? NULL : he_mem_array(NULL, things->groups, sizeof *b.group_boxes);
    he_status status = HE_OK;
    if (b.tree.nodes == NULL || b.tree.order == NULL || (group != NULL && b.group_boxes == NULL)) {
        status = he_fail_plain(err, HE_NO_MEMORY, "no memory for a search tree of %u boxes", count);
    } else {
        for (uint32_t i = 0; i < count; i++) {
            b.tree.order[i] = i;
        }
        if (group != NULL) {
            find_group_boxes(&b, count, things->groups);
        }
        status = build(&b, count, err);
    }
    he_mem_free(b.group_boxes);
    if (status != HE_OK) {
        he_boxes_clear(&b.tree);
        return status;
    }
    *out = b.tree;
    return HE_OK;
}

/* --- pairs --- */

typedef struct node_pair {
    uint32_t a, b;
} node_pair;

static bool apart(const he_box_node *a, const he_box_node *b)
{
    for (int k = 0; k < 3; k++) {
        if (a->min[k] > b->max[k] || b->min[k] > a->max[k]) {
            return true;
        }
    }
    return false;
}

/* Replaces a pair of nodes, of which at least one is no leaf, by pairs in which a node is replaced
 * by its children. */
static size_t split(const he_box_node *nodes, node_pair p, node_pair out[3])
{
    const he_box_node *a = &nodes[p.a], *b = &nodes[p.b];
    if (p.a == p.b) {
        out[0] = (node_pair){a->first, a->first};
        out[1] = (node_pair){a->first + 1, a->first + 1};
        out[2] = (node_pair){a->first, a->first + 1};
        return 3;
    }
    /* If one node of the pair is a leaf, the node that is no leaf is split. If neither node is a
     * leaf, the node with the lower number is split, because it is nearer to the root of the
     * tree. */
    bool first = b->count > 0 || (a->count == 0 && p.a < p.b);
    for (uint32_t side = 0; side < 2; side++) {
        out[side] = first ? (node_pair){a->first + side, p.b} : (node_pair){p.a, b->first + side};
    }
    return 2;
}

he_status he_boxes_visit_pairs(const he_box_node *nodes, const he_boxes_visit *visit, void *context,
                               he_budget *budget, he_error *err)
{
    node_pair stack[PAIRS];
    size_t depth = 0;
    he_status status = HE_OK;
    stack[depth++] = (node_pair){0, 0};
    while (depth > 0 && status == HE_OK) {
        node_pair p = stack[--depth];
        const he_box_node *a = &nodes[p.a], *b = &nodes[p.b];
        status = he_budget_take(budget, 1, err);
        if (status != HE_OK || apart(a, b) ||
            (visit->is_needless != NULL && visit->is_needless(context, p.a, p.b))) {
            continue;
        }
        if (a->count > 0 && b->count > 0) {
            status = visit->try_leaves(context, a, b, err);
            continue;
        }
        assert(depth + 3 <= PAIRS);
        depth += split(nodes, p, stack + depth);
    }
    return status;
}
