/* defect_positions.c - finds groups of vertices that have equal positions, or whose distance is
 * below a threshold. */
#include "query/defects.h"

#include "geometry/point_grid.h"
#include "geometry/scale.h"
#include "mesh/walk.h"

static double distance(he_vec3 p, he_vec3 q)
{
    he_vec3 d = he_vec3_sub(p, q);
    double extent = he_vec3_extent(d);
    return extent == 0 ? 0 : he_vec3_length(he_vec3_scale(d, 1 / extent)) * extent;
}

he_status he_defects_of_positions(const he_mesh *m, double merge, uint64_t seed,
                                  he_progress *progress, he_defects *out, he_error *err)
{
    he_point_grid grid = {0};
    const he_vec3 *at = m->c.position;
    he_status status = he_progress_phase(progress, "comparing positions", 0.5, err);
    if (status == HE_OK) {
        status = he_point_grid_make(
            &grid, &(he_point_grid_points){.at = at, .tolerance = merge, .seed = seed},
            m->c.vertices.live, progress, err);
    }
    for (uint32_t v = 0; v < m->c.vertices.issued && status == HE_OK; v++) {
        status = he_progress_at(progress, v, m->c.vertices.issued, err);
        if (m->c.vertex_halfedge[v] == HE_DEAD) {
            continue;
        }
        uint32_t home, found = he_point_grid_find(&grid, at[v], &home);
        if (found == HE_NONE) {
            he_point_grid_keep(&grid, home, v);
        } else {
            he_defects_add(out, HE_DEFECT_DUPLICATE, v, found, distance(at[v], at[found]));
        }
    }
    he_point_grid_clear(&grid);
    return status;
}
