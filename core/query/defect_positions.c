/* defect_positions.c - finds vertices that lie at one position, or closer than the threshold. */
#include "query/defects.h"

#include "geometry/near.h"
#include "geometry/scale.h"
#include "mesh/walk.h"

static double distance(he_vec3 p, he_vec3 q)
{
    he_vec3 d = he_vec3_sub(p, q);
    double extent = he_vec3_extent(d);
    return extent == 0 ? 0 : he_vec3_length(he_vec3_scale(d, 1 / extent)) * extent;
}

he_status he_defects_of_positions(const he_mesh *m, double merge, uint64_t seed, he_watch *watch,
                                  he_defects *out, he_error *err)
{
    he_near near = {0};
    const he_vec3 *at = m->c.position;
    he_status status = he_watch_phase(watch, "comparing positions", 0.5, err);
    if (status == HE_OK) {
        status = he_near_make(&near, &(he_near_points){.at = at, .tolerance = merge, .seed = seed},
                              m->c.vertices.live, watch, err);
    }
    for (uint32_t v = 0; v < m->c.vertices.issued && status == HE_OK; v++) {
        status = he_watch_at(watch, v, m->c.vertices.issued, err);
        if (m->c.vertex_halfedge[v] == HE_DEAD) {
            continue;
        }
        uint32_t home, found = he_near_find(&near, at[v], &home);
        if (found == HE_NONE) {
            he_near_keep(&near, home, v);
        } else {
            he_defects_add(out, HE_DEFECT_DUPLICATE, v, found, distance(at[v], at[found]));
        }
    }
    he_near_clear(&near);
    return status;
}
