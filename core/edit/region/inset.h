/* inset.h - insets faces: makes them smaller inside a ring of quads. */
#ifndef HE_EDIT_REGION_INSET_H
#define HE_EDIT_REGION_INSET_H

#include "edit/region/region.h"

/* The limit of steps for finding how far an inset can go before corners or sides of a face meet.
 * Testing one corner against one side counts as one step. */
enum { HE_INSET_STEPS = 1 << 22 };

/* Says how far an inset goes, in one of two ways. With a `factor` above 0 and below 1, each corner
 * on the rim goes this fraction of the way to the mean of the corners of its face. If a corner
 * belongs to several faces of a region, it goes towards the mean of these means. With factor 0, the
 * sides of the rim move in parallel by `distance`, within the planes of their faces. At a sharp
 * corner, where the corner would have to move farther than four times `distance`, it moves less. */
typedef struct he_inset_width {
    double factor, distance;
} he_inset_width;

/* face_inset: every listed face, or with `region` every set of listed faces connected across edges,
 * is detached from its surroundings by a ring of quads (see region.h), and its rim moves inwards.
 *
 *        o---------------o            o---------------o
 *        |               |            | \           / |
 *        |               |            |   o-------o   |
 *        |       f       |            |   |   f   |   |
 *        |               |    --->    |   o-------o   |
 *        |               |            | /           \ |
 *        o---------------o            o---------------o
 *
 * For one face of n corners V + n, E + 2n, F + n; for a region with a rim of r half-edges V + r, E
 * + 2r, F + r. The listed faces keep their ids and become the inner faces; vertices inside a region
 * do not move.
 *
 * New vertices copy the values of the vertices they descend from. Interpolated attributes get the
 * values that the region has at the new position. To find these values, each face is divided into
 * triangles, each of two neighbouring corners and the mean of all corners. Of the triangles at the
 * old corner, the one nearest to the new position is chosen, and values are interpolated in it.
 *
 * The motion of all corners is scaled down by one factor if necessary. It ends at 99 % of the time
 * at which, within one face of the region, a side would have no length, a corner would flip, or a
 * reflex corner would hit another side. A face that is not planar is projected along its normal.
 *
 * If the edit is refused, nothing changes. `out` may be NULL; otherwise he_region_parts_clear frees
 * it.
 * Returns HE_NO_RIM, HE_RIM_MEETS_ITSELF, HE_LOCKED_ELEMENT and others as he_region_draw does.
 * Returns HE_BAD_VALUE unless 0 < factor < 1, or distance > 0.
 * Returns HE_NO_NORMAL, naming a face, if a distance is given and a face on the rim has no area.
 * Returns HE_LIMIT if faces have too many reflex corners and sides.
 * Returns HE_NOT_FINITE if a position is not finite.
 * Returns HE_NO_MEMORY if memory is out.
 * Returns HE_IDS_EXHAUSTED if no ids are left. */
HE_NODISCARD he_status he_face_inset(he_mesh *m, const uint32_t *faces, size_t count, bool region,
                                     he_inset_width width, he_region_parts *out, he_error *err);

#endif
