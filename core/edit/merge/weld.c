#include "edit/merge/weld.h"

#include "edit/piece/list.h"
#include "geometry/point_grid.h"
#include "mesh/walk.h"

he_status he_vertex_weld(he_mesh *m, const uint32_t *vertices, size_t count, he_merge_place place,
                         he_vertex *into, uint64_t *moved, he_error *err)
{
    he_ids gone = {0}, to = {0};
    he_status status = he_list_require(m, HE_VERTEX, vertices, count, HE_REPEATED_ELEMENT, err);
    uint32_t lowest = HE_NONE;
    for (size_t i = 0; i < count; i++) {
        lowest = vertices[i] < lowest ? vertices[i] : lowest;
    }
    for (size_t i = 0; status == HE_OK && i < count; i++) {
        if (vertices[i] != lowest) {
            status = he_ids_add(&gone, vertices[i], err);
            if (status == HE_OK) {
                status = he_ids_add(&to, lowest, err);
            }
        }
    }
    if (status == HE_OK && gone.count > 0) {
        const he_merge how = {gone.ids, to.ids, gone.count, place};
        status = he_merge_vertices(m, &how, moved, err);
    }
    he_ids_clear(&gone);
    he_ids_clear(&to);
    if (status == HE_OK && into != NULL) {
        *into = (he_vertex){lowest};
    }
    return status;
}

/* Finds all vertices to be merged: vertex gone[i] is no farther than `tolerance` from vertex to[i],
 * into which it will be merged. */
static he_status find_pairs(const he_mesh *m, double tolerance, he_ids *gone, he_ids *to,
                            he_error *err)
{
    uint32_t issued = he_mesh_issued(m, HE_VERTEX);
    he_point_grid grid;
    he_status status = he_point_grid_make(
        &grid, &(he_point_grid_points){.at = m->c.position, .tolerance = tolerance},
        he_mesh_vertices(m), m->progress, err);
    if (status != HE_OK) {
        return status;
    }
    for (uint32_t v = 0; status == HE_OK && v < issued; v++) {
        status = he_progress_at(m->progress, v, issued, err);
        if (status != HE_OK || !he_vertex_is_live(m, (he_vertex){v})) {
            continue;
        }
        uint32_t home, found = he_point_grid_find(&grid, he_position(m, (he_vertex){v}), &home);
        if (found == HE_NONE) {
            he_point_grid_keep(&grid, home, v);
            continue;
        }
        status = he_ids_add(gone, v, err);
        if (status == HE_OK) {
            status = he_ids_add(to, found, err);
        }
    }
    he_point_grid_clear(&grid);
    return status;
}

he_status he_weld_near(he_mesh *m, double tolerance, he_merge_place place, he_ids *into,
                       uint64_t *moved, he_error *err)
{
    he_ids gone = {0}, to = {0}, stay = {0};
    if (!(tolerance >= 0)) {
        return he_fail_plain(err, HE_BAD_VALUE,
                             "the tolerance must be finite and not negative, not %g", tolerance);
    }
    he_status status = he_progress_phase(m->progress, "comparing", 0.4, err);
    if (status == HE_OK) {
        status = find_pairs(m, tolerance, &gone, &to, err);
    }
    for (size_t i = 0; status == HE_OK && i < to.count; i++) {
        status = he_ids_add(&stay, to.ids[i], err);
    }
    if (status == HE_OK) {
        status = he_ids_sort(&stay, err);
    }
    if (status == HE_OK && into != NULL) {
        status = he_ids_reserve(into, stay.count, err);
    }
    if (status == HE_OK && gone.count > 0) {
        const he_merge how = {gone.ids, to.ids, gone.count, place};
        status = he_merge_vertices(m, &how, moved, err);
    }
    for (size_t i = 0; status == HE_OK && into != NULL && i < stay.count; i++) {
        into->ids[into->count++] = stay.ids[i];
    }
    he_ids_clear(&gone);
    he_ids_clear(&to);
    he_ids_clear(&stay);
    return status;
}
