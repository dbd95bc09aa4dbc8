/* extrude.h - faces pulled out of the surface. */
#ifndef HE_EDIT_REGION_EXTRUDE_H
#define HE_EDIT_REGION_EXTRUDE_H

#include "edit/region/region.h"

/* face_extrude: every listed face, or with `region` every set of them connected across edges, is
 * drawn off its surroundings (see region.h) and moved.
 *
 *                                                 o-------o
 *        o-------o-------o                       /|  f   /|
 *       /       /       /                   o---/-o-----/-o
 *      /   f   /       /       --->        /   o-------o / /
 *     o-------o-------o                   /    |/      |/ /
 *                                        o-----o-------o-o
 *
 * For one face of n corners V + n, E + 2n, F + n; for a region with a rim of r half-edges V + r,
 * E + 2r, F + r. The listed faces keep their ids and are on top; vertices and edges inside a region
 * go along. A face on the boundary leaves its boundary edges where they were.
 *
 * It moves by the vector `by`, or when that is NULL by `distance`, which may be negative, along its
 * normal: of a region the direction of the sum of its faces' vector areas.
 *
 * Refused, all or nothing: what he_region_draw refuses; HE_NO_NORMAL with a distance, naming a face
 * where that direction is zero; HE_NOT_FINITE for a place that is not. HE_NO_MEMORY,
 * HE_IDS_EXHAUSTED. `out` may be NULL, else he_region_parts_clear frees it. */
HE_NODISCARD he_status he_face_extrude(he_mesh *m, const uint32_t *faces, size_t count, bool region,
                                       const he_vec3 *by, double distance, he_region_parts *out,
                                       he_error *err);

#endif
