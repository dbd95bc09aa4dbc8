/* extrude.h - extrudes faces out of the surface. */
#ifndef HE_EDIT_REGION_EXTRUDE_H
#define HE_EDIT_REGION_EXTRUDE_H

#include "edit/region/region.h"

/* How an extrusion moves a face or region: by the vector `by`, or if that is NULL by `distance`,
 * which may be negative, along its normal. A region's normal is the direction of the sum of its
 * faces' vector areas. */
typedef struct he_extrude_motion {
    const he_vec3 *by;
    double distance;
} he_extrude_motion;

/* face_extrude: every listed face, or with `region` every set of listed faces connected across
 * edges, is detached from its surroundings by a ring of quads (see region.h) and moved.
 *
 *                                                 o-------o
 *        o-------o-------o                       /|  f   /|
 *       /       /       /                   o---/-o-----/-o
 *      /   f   /       /       --->        /   o-------o / /
 *     o-------o-------o                   /    |/      |/ /
 *                                        o-----o-------o-o
 *
 * For one face of n corners V + n, E + 2n, F + n; for a region with a rim of r half-edges V + r, E
 * + 2r, F + r. The listed faces keep their ids and are on top; vertices and edges inside a region
 * move with them. The old vertices and edges on the rim stay where they were.
 *
 * If the edit is refused, nothing changes. `out` may be NULL; otherwise he_region_parts_clear frees
 * it.
 * Returns HE_NO_RIM, HE_RIM_MEETS_ITSELF, HE_LOCKED_ELEMENT and others as he_region_draw does.
 * Returns HE_NO_NORMAL, naming a face, if a distance is given and the direction of the normal is
 * zero.
 * Returns HE_NOT_FINITE if a position is not finite.
 * Returns HE_NO_MEMORY if memory is out.
 * Returns HE_IDS_EXHAUSTED if no ids are left. */
HE_NODISCARD he_status he_face_extrude(he_mesh *m, const uint32_t *faces, size_t count, bool region,
                                       he_extrude_motion motion, he_region_parts *out,
                                       he_error *err);

#endif
