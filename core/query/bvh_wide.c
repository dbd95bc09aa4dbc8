#include "query/bvh_wide.h"

#include "base/mem.h"

#include <float.h>

/* Returns half the surface area of a box. */
static double surface(const he_box_node *b)
{
    double side[3];
    for (int k = 0; k < 3; k++) {
        side[k] = (double)b->max[k] - (double)b->min[k];
    }
    return side[0] * side[1] + side[1] * side[2] + side[2] * side[0];
}

/* Finds the nodes of the binary tree that become the children of a wide node: while there is room,
 * the largest inner node below `from` is replaced by its two children. Returns their number. */
static uint32_t find_children(const he_box_node *nodes, uint32_t from, uint32_t out[HE_BVH_WIDTH])
{
    uint32_t count = 1;
    out[0] = from;
    while (count < HE_BVH_WIDTH) {
        uint32_t largest = HE_BVH_WIDTH;
        double most = -1;
        for (uint32_t i = 0; i < count; i++) {
            const double size = surface(&nodes[out[i]]);
            if (nodes[out[i]].count == 0 && size > most) {
                most = size;
                largest = i;
            }
        }
        if (largest == HE_BVH_WIDTH) {
            break; /* all are leaves */
        }
        out[count++] = nodes[out[largest]].first + 1;
        out[largest] = nodes[out[largest]].first;
    }
    return count;
}

/* Sets a child; `first` is its number among the wide nodes, unless it is a leaf. */
static void set_child(he_bvh_wide *wide, uint32_t i, const he_box_node *nodes, uint32_t node,
                      uint32_t first)
{
    for (int k = 0; k < 3; k++) {
        wide->min[k][i] = nodes[node].min[k];
        wide->max[k][i] = nodes[node].max[k];
    }
    wide->node[i] = node;
    wide->count[i] = nodes[node].count;
    wide->first[i] = nodes[node].count > 0 ? nodes[node].first : first;
}

static void set_no_child(he_bvh_wide *wide, uint32_t i)
{
    for (int k = 0; k < 3; k++) {
        wide->min[k][i] = FLT_MAX;
        wide->max[k][i] = -FLT_MAX;
    }
    wide->node[i] = HE_NONE;
    wide->first[i] = wide->count[i] = 0;
}

/* The wide nodes that were made. */
typedef struct list {
    he_bvh_wide *nodes;
    size_t count, capacity;
} list;

/* Allocates memory for the children of one more node. */
static bool grow(list *l)
{
    const size_t need = l->count + HE_BVH_WIDTH;
    if (need <= l->capacity) {
        return true;
    }
    const size_t capacity = he_mem_grown(l->capacity, need);
    he_bvh_wide *nodes = he_mem_array(l->nodes, capacity, sizeof *nodes);
    if (nodes != NULL) {
        l->nodes = nodes;
        l->capacity = capacity;
    }
    return nodes != NULL;
}

he_bvh_wide *he_bvh_wide_new(const he_box_node *nodes, uint32_t *count)
{
    struct {
        uint32_t node, wide;
    } stack[HE_BVH_WIDTH * HE_BOXES_STACK];
    size_t depth = 1;
    list l = {.count = 1};
    stack[0].node = stack[0].wide = 0;
    while (depth > 0) {
        if (!grow(&l)) {
            he_mem_free(l.nodes);
            return NULL;
        }
        depth--;
        he_bvh_wide *at = &l.nodes[stack[depth].wide];
        uint32_t child[HE_BVH_WIDTH];
        const uint32_t children = find_children(nodes, stack[depth].node, child);
        for (uint32_t i = 0; i < HE_BVH_WIDTH; i++) {
            if (i >= children) {
                set_no_child(at, i);
                continue;
            }
            set_child(at, i, nodes, child[i], (uint32_t)l.count);
            if (nodes[child[i]].count == 0) {
                stack[depth].node = child[i];
                stack[depth++].wide = (uint32_t)l.count++;
            }
        }
    }
    *count = (uint32_t)l.count;
    return he_mem_shrink(l.nodes, l.count * sizeof *l.nodes);
}
