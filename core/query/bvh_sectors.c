/* bvh_sectors.c - finds the intersecting pairs among the triangles that meet at one hub, a position
 * at which very many triangles meet (hubs.h).
 *
 * Such a triangle, called a spoke, covers a SECTOR of the directions from the hub. Two spokes share
 * a point other than the hub exactly if their sectors share a direction, because near the hub a ray
 * in that direction lies in both triangles.
 *
 *         .--u        On a unit sphere around the hub, the directions of a sector are an arc of a
 *       .'   |        great circle from u to v, shorter than half of the circle. Boxes around arcs
 *     hub    | arc    separate spokes that boxes around triangles do not: if n spokes form a disc
 *       '.   |        or cone, the box of each arc intersects only the boxes of a few neighbours,
 *         '--v        so n log n steps are enough.
 *
 * The boxes are rounded outward, so intersecting spokes always have intersecting boxes. Pairs of
 * spokes with intersecting boxes are then tested exactly. */
#include "geometry/triangle_intersection.h"
#include "query/bvh_pairs.h"
#include "query/bvh_walk.h"

/* An upper bound of the rounding error of the coordinates of a direction, and of the values that
 * this file computes from directions. */
static const double ROUNDING = 1e-14;

typedef struct sectors {
    he_pair_search *search;
    uint32_t hub;
    uint32_t *spokes; /* the spokes (triangles at the hub) that have area */
    he_bounds *arcs;  /* box around the arc of directions of each spoke */
    uint32_t count;
    /* Indices of `spokes`, in the order of the leaves of the tree of the arcs' boxes. */
    const uint32_t *order;
} sectors;

static void include(he_bounds *b, he_vec3 p, double pad)
{
    const he_bounds point = {{p.x - pad, p.y - pad, p.z - pad}, {p.x + pad, p.y + pad, p.z + pad}};
    he_bounds_include(b, &point);
}

static bool same(he_vec3 a, he_vec3 b)
{
    return a.x == b.x && a.y == b.y && a.z == b.z;
}

/* Returns a box around the arc from u to v on the unit sphere. Each point of the arc is a point of
 * the chord from u to v, scaled to length 1. Along any axis, this scaling moves a point by no more
 * than it moves the middle of the chord. */
static he_bounds about_arc(he_vec3 u, he_vec3 v)
{
    he_bounds bounds = he_bounds_none();
    double pad = fmax(1 - 0.5 * he_vec3_length(he_vec3_add(u, v)), 0) + ROUNDING;
    include(&bounds, u, pad);
    include(&bounds, v, pad);
    return bounds;
}

/* Returns the box around the arc of a triangle's directions, which runs between the directions to
 * the two corners that are not at the hub. */
static he_bounds arc_of(const he_vec3 corner[3], he_vec3 hub)
{
    int at = same(corner[0], hub) ? 0 : same(corner[1], hub) ? 1 : 2;
    he_vec3 u, v;
    he_vec3_normalise(he_vec3_sub(corner[(at + 1) % 3], hub), &u);
    he_vec3_normalise(he_vec3_sub(corner[(at + 2) % 3], hub), &v);
    return about_arc(u, v);
}

/* Translates all boxes so that the mean of all directions is at the origin. The floats of the boxes
 * are finest there and can separate directions that are nearly equal. */
static void center(sectors *s)
{
    he_bounds all = he_bounds_none();
    for (uint32_t i = 0; i < s->count; i++) {
        he_bounds_include(&all, &s->arcs[i]);
    }
    for (uint32_t i = 0; i < s->count; i++) {
        for (int k = 0; k < 3; k++) {
            double middle = 0.5 * (all.min[k] + all.max[k]);
            s->arcs[i].min[k] -= middle;
            s->arcs[i].max[k] -= middle;
        }
    }
}

static he_status load(sectors *s, he_error *err)
{
    const he_bvh *tree = s->search->tree;
    const he_hubs *hubs = &tree->hubs;
    he_vec3 place = he_vec3_scale(hubs->places[s->hub], tree->scale);
    uint32_t first = hubs->first[s->hub], end = hubs->first[s->hub + 1];
    s->spokes = he_mem_array(NULL, end - first, sizeof *s->spokes);
    s->arcs = he_mem_array(NULL, end - first, sizeof *s->arcs);
    if (s->spokes == NULL || s->arcs == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory for the %u triangles at a vertex",
                             end - first);
    }
    he_status status = HE_OK;
    for (uint32_t i = first; i < end && status == HE_OK; i++) {
        he_vec3 corner[3];
        he_bvh_corners(tree, s->search->m, hubs->spokes[i], corner);
        if (he_triangle_has_area(corner)) {
            s->spokes[s->count] = hubs->spokes[i];
            s->arcs[s->count++] = arc_of(corner, place);
        }
        status = he_budget_take(s->search->budget, 1, err);
    }
    center(s);
    return status;
}

static bool apart(const he_bounds *a, const he_bounds *b)
{
    for (int k = 0; k < 3; k++) {
        if (a->min[k] > b->max[k] || b->min[k] > a->max[k]) {
            return true;
        }
    }
    return false;
}

static he_status try_leaves(void *context, const he_box_node *a, const he_box_node *b,
                            he_error *err)
{
    const sectors *s = context;
    he_pair_search *search = s->search;
    he_status status = he_budget_take(search->budget, (uint64_t)a->count * b->count, err);
    for (uint32_t i = 0; i < a->count; i++) {
        for (uint32_t k = a == b ? i + 1 : 0; k < b->count && status == HE_OK; k++) {
            uint32_t left = s->order[a->first + i], right = s->order[b->first + k];
            if (apart(&s->arcs[left], &s->arcs[right]) ||
                he_pair_hub(search, s->spokes[left], s->spokes[right]) != s->hub) {
                continue;
            }
            he_vec3 p[3], q[3];
            he_bvh_corners(search->tree, search->m, s->spokes[left], p);
            he_bvh_corners(search->tree, search->m, s->spokes[right], q);
            status = he_pair_try(search, s->spokes[left], s->spokes[right], p, q, err);
        }
    }
    return status;
}

he_status he_pairs_at_hub(he_pair_search *search, uint32_t hub, he_error *err)
{
    static const he_boxes_visit visit = {NULL, try_leaves};
    sectors s = {.search = search, .hub = hub};
    he_boxes boxes = {.nodes = NULL};
    he_status status = load(&s, err);
    if (status == HE_OK && s.count > 1) {
        status = he_boxes_make(&(he_boxed){.boxes = s.arcs, .count = s.count}, search->budget,
                               &boxes, err);
    }
    if (status == HE_OK && s.count > 1) {
        s.order = boxes.order;
        status = he_boxes_visit_pairs(boxes.nodes, &visit, &s, search->budget, err);
    }
    he_boxes_clear(&boxes);
    he_mem_free(s.spokes);
    he_mem_free(s.arcs);
    return status;
}
