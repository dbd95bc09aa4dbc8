/* weld.c - the repair weld: merges vertices whose distance is at most a tolerance. */
#include "build/keep.h"
#include "geometry/point_grid.h"
#include "repair/mend.h"

/* Finds the vertices that are kept and moves their positions to the front of the array. into[v] is
 * set to the new number of vertex v; if v is merged into another vertex, to the new number of that
 * vertex. */
static he_status find_kept(he_mend *m, he_point_grid *grid, uint32_t *into, uint32_t *from,
                           uint32_t *kept, he_error *err)
{
    he_soup *soup = m->soup;
    he_repair_account *account = &m->out->accounts[HE_REPAIR_WELD];
    he_status status = HE_OK;
    *kept = 0;
    for (uint32_t v = 0; v < soup->vertex_count && status == HE_OK; v++) {
        status = he_progress_at(soup->limits.progress, v, soup->vertex_count, err);
        he_vec3 p = soup->positions[v];
        uint32_t home, found = he_point_grid_find(grid, p, &home);
        if (found != HE_NONE) {
            he_mend_name(account, v, found);
            account->count++;
            into[v] = found;
            continue;
        }
        soup->positions[*kept] = p;
        from[*kept] = v;
        he_point_grid_keep(grid, home, *kept);
        into[v] = (*kept)++;
    }
    return status;
}

he_status he_mend_weld(he_mend *m, double tolerance, he_error *err)
{
    he_soup *soup = m->soup;
    he_point_grid grid = {0};
    uint32_t kept = 0, *into = he_mem_array(NULL, soup->vertex_count, sizeof *into);
    uint32_t *from = he_mem_array(NULL, soup->vertex_count, sizeof *from);
    he_status status = HE_OK;
    if (into == NULL || from == NULL) {
        status =
            he_fail_plain(err, HE_NO_MEMORY, "no memory to weld %zu vertices", soup->vertex_count);
        goto out;
    }
    status = he_point_grid_make(
        &grid, &(he_point_grid_points){.at = soup->positions, .tolerance = tolerance},
        soup->vertex_count, soup->limits.progress, err);
    if (status == HE_OK) {
        status = find_kept(m, &grid, into, from, &kept, err);
    }
    if (status == HE_OK && kept < soup->vertex_count) {
        status =
            he_soup_keep_values(soup, into, from, &m->out->accounts[HE_REPAIR_WELD].moved, err);
        m->has_corner_values = he_mend_has_corner_values(soup);
    }
    if (status == HE_OK && kept < soup->vertex_count) {
        for (size_t c = 0; c < soup->corner_count; c++) {
            soup->corners[c] = into[soup->corners[c]];
        }
        soup->vertex_count = kept;
        m->out->vertex_from = from;
        m->out->vertices = kept;
        from = NULL;
    }
out:
    he_point_grid_clear(&grid);
    he_mem_free(into);
    he_mem_free(from);
    return status;
}
