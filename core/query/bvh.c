#include "query/bvh.h"

#include "draw/draw_arrays.h"
#include "geometry/geometry.h"
#include "geometry/long_faces_keep.h"
#include "geometry/scale.h"
#include "mesh/walk.h"
#include "query/bvh_disc.h"

#include <string.h>

/* --- the triangles --- */

static he_status count_triangles(const he_mesh *m, uint32_t *out, he_error *err)
{
    uint64_t corners = 2 * (uint64_t)m->c.edges.live - m->c.boundary_halfedges;
    uint64_t count = corners - 2 * (uint64_t)m->c.faces.live;
    if (count > (uint64_t)1 << 31) {
        return he_fail_plain(err, HE_IDS_EXHAUSTED,
                             "the mesh has %llu triangles, which are too many for a search tree",
                             (unsigned long long)count);
    }
    *out = (uint32_t)count;
    return HE_OK;
}

static he_status list_triangles(he_bvh *tree, const he_mesh *m, he_error *err)
{
    he_frame frame = he_frame_of(m);
    he_draw_arrays d;
    he_status status = he_draw_arrays_init(&d, m, &frame, err);
    if (status != HE_OK) {
        return status;
    }
    uint32_t at = 0;
    for (uint32_t f = 0; f < m->c.faces.issued; f++) {
        if (m->c.face_halfedge[f] == HE_DEAD) {
            continue;
        }
        he_draw_arrays_walk walk;
        uint32_t row[HE_DRAWN_ROW];
        he_draw_arrays_begin(&d, f, &walk);
        while (he_draw_arrays_next(&d, &walk, row)) {
            tree->triangles[at++] = (he_bvh_triangle){{row[0], row[1], row[2]}, f};
        }
    }
    tree->count = at;
    he_draw_arrays_clear(&d);
    return HE_OK;
}

static he_bounds *find_boxes(const he_bvh *tree, const he_mesh *m)
{
    he_bounds *boxes = he_mem_array(NULL, tree->count, sizeof *boxes);
    for (uint32_t i = 0; boxes != NULL && i < tree->count; i++) {
        he_bounds bounds = he_bounds_none();
        for (int k = 0; k < 3; k++) {
            he_vec3 p = he_vec3_scale(m->c.position[tree->triangles[i].vertex[k]], tree->scale);
            he_bounds corner = {{p.x, p.y, p.z}, {p.x, p.y, p.z}};
            he_bounds_include(&bounds, &corner);
        }
        boxes[i] = bounds;
    }
    return boxes;
}

/* --- groups: triangles that boxes cannot separate --- */

static uint32_t end_of_face(const he_bvh *tree, uint32_t i)
{
    uint32_t face = tree->triangles[i].face;
    while (i < tree->count && tree->triangles[i].face == face) {
        i++;
    }
    return i;
}

/* Puts the triangles of each face that has many triangles into a group, and numbers these groups.
 * The list of triangles is sorted by face. Returns the number of groups, including group 0 of all
 * other triangles. */
static uint32_t group_faces(const he_bvh *tree, uint32_t *group)
{
    uint32_t groups = 1;
    for (uint32_t i = 0, end; i < tree->count; i = end) {
        end = end_of_face(tree, i);
        bool wide = end - i >= HE_HUB_SPOKES;
        for (uint32_t k = i; k < end; k++) {
            group[k] = wide ? groups : 0;
        }
        groups += wide;
    }
    return groups;
}

/* Puts the triangles that meet at a hub (a position at which very many triangles meet, hubs.h) into
 * a group, and numbers these groups. A triangle at several hubs belongs to the group of the hub
 * with the most triangles. */
static uint32_t group_spokes(const he_bvh *tree, uint32_t groups, uint32_t *group)
{
    const he_hubs *hubs = &tree->hubs;
    for (uint32_t h = 0; h < hubs->count; h++) {
        uint32_t size = hubs->first[h + 1] - hubs->first[h];
        for (uint32_t i = hubs->first[h]; i < hubs->first[h + 1]; i++) {
            uint32_t *own = &group[hubs->spokes[i]];
            bool larger = *own >= groups &&
                          hubs->first[*own - groups + 1] - hubs->first[*own - groups] < size;
            *own = *own == 0 || larger ? groups + h : *own;
        }
    }
    return groups + hubs->count;
}

static bool has_wide_faces(const he_bvh *tree)
{
    for (uint32_t i = 0, end; i < tree->count; i = end) {
        end = end_of_face(tree, i);
        if (end - i >= HE_HUB_SPOKES) {
            return true;
        }
    }
    return false;
}

/* Finds the groups of triangles that boxes cannot separate. *group stays NULL if there are no such
 * groups; group 0 has the triangles that need no group. */
static he_status find_groups(he_bvh *tree, const he_mesh *m, he_budget *budget, uint32_t **group,
                             uint32_t *groups, he_error *err)
{
    const size_t stride = sizeof *tree->triangles / sizeof tree->triangles->vertex[0];
    he_status status =
        he_hubs_find(m, tree->triangles[0].vertex, stride, tree->count, budget, &tree->hubs, err);
    tree->has_wide_faces = has_wide_faces(tree);
    *groups = 1;
    if (status != HE_OK || (!tree->has_wide_faces && tree->hubs.count == 0)) {
        return status;
    }
    *group = he_mem_array(NULL, tree->count, sizeof **group);
    if (*group == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory for the groups of %u triangles",
                             tree->count);
    }
    *groups = group_spokes(tree, group_faces(tree, *group), *group);
    return HE_OK;
}

/* --- the tree --- */

/* Sorts the triangles into the order of the tree's leaves. */
static bool arrange(he_bvh *tree, he_boxes *boxes)
{
    he_bvh_triangle *sorted = he_mem_array(NULL, tree->count, sizeof *sorted);
    uint32_t *place = tree->hubs.count == 0 ? NULL : he_mem_array(NULL, tree->count, sizeof *place);
    if (sorted == NULL || (tree->hubs.count > 0 && place == NULL)) {
        he_mem_free(sorted);
        he_mem_free(place);
        return false;
    }
    for (uint32_t i = 0; i < tree->count; i++) {
        sorted[i] = tree->triangles[boxes->order[i]];
    }
    for (uint32_t i = 0; place != NULL && i < tree->count; i++) {
        place[boxes->order[i]] = i;
    }
    for (uint32_t i = 0; place != NULL && i < tree->hubs.first[tree->hubs.count]; i++) {
        tree->hubs.spokes[i] = place[tree->hubs.spokes[i]];
    }
    he_mem_free(place);
    he_mem_free(tree->triangles);
    tree->triangles = sorted;
    tree->discs = he_mem_array(NULL, boxes->node_count, sizeof *tree->discs);
    if (tree->discs == NULL) {
        return false;
    }
    tree->nodes = he_mem_shrink(boxes->nodes, boxes->node_count * sizeof *tree->nodes);
    tree->node_count = boxes->node_count;
    boxes->nodes = NULL;
    tree->wide = he_bvh_wide_new(tree->nodes, &tree->wide_count);
    memcpy(tree->min, boxes->all.min, sizeof tree->min);
    memcpy(tree->max, boxes->all.max, sizeof tree->max);
    return tree->wide != NULL;
}

void he_bvh_free(he_bvh *tree)
{
    if (tree != NULL) {
        he_mem_free(tree->nodes);
        he_mem_free(tree->discs);
        he_mem_free(tree->wide);
        he_mem_free(tree->triangles);
        he_hubs_clear(&tree->hubs);
        he_mem_free(tree);
    }
}

static he_status build(he_bvh *tree, const he_mesh *m, uint32_t count, he_budget *budget,
                       he_error *err)
{
    uint32_t *group = NULL, groups = 1;
    he_bounds *bounds = NULL;
    he_boxes boxes = {.nodes = NULL};
    he_status status = HE_OK;
    tree->triangles = he_mem_array(NULL, count, sizeof *tree->triangles);
    if (tree->triangles == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory for a search tree of %u triangles",
                             count);
    }
    status = list_triangles(tree, m, err);
    if (status == HE_OK) {
        status = find_groups(tree, m, budget, &group, &groups, err);
    }
    if (status != HE_OK) {
        goto out;
    }
    bounds = find_boxes(tree, m);
    if (bounds == NULL) {
        status = he_fail_plain(err, HE_NO_MEMORY,
                               "no memory for the bounding boxes of %u triangles", count);
        goto out;
    }
    status = he_boxes_make(&(he_boxed){bounds, count, group, groups}, budget, &boxes, err);
    if (status == HE_OK && !arrange(tree, &boxes)) {
        status =
            he_fail_plain(err, HE_NO_MEMORY, "no memory for a search tree of %u triangles", count);
    }
    if (status == HE_OK) {
        status = he_bvh_find_discs(tree, m, budget, err);
    }
out:
    he_mem_free(group);
    he_mem_free(bounds);
    he_boxes_clear(&boxes);
    return status;
}

he_status he_bvh_new(const he_mesh *m, he_progress *progress, he_bvh **out, he_error *err)
{
    uint32_t count = 0;
    he_box bounds;
    he_budget budget = {.left = UINT64_MAX, .progress = progress};
    he_status status = count_triangles(m, &count, err);
    if (status == HE_OK) {
        status = he_long_faces_keep(m, progress, err);
    }
    if (status != HE_OK) {
        return status;
    }
    he_bvh *tree = he_mem_zero(1, sizeof *tree);
    if (tree == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory for a search tree of boxes");
    }
    he_surface_box(m, &bounds);
    tree->exponent = he_exponent_of(fmax(he_vec3_extent(bounds.min), he_vec3_extent(bounds.max)));
    tree->scale = ldexp(1, -tree->exponent);
    if (count > 0) {
        status = he_progress_phase(progress, "sorting by position", 1, err);
        status = status == HE_OK ? build(tree, m, count, &budget, err) : status;
    }
    if (status != HE_OK) {
        he_bvh_free(tree);
        return status;
    }
    *out = tree;
    return HE_OK;
}
