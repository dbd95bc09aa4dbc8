/* inset.h - faces made smaller within themselves. */
#ifndef HE_EDIT_REGION_INSET_H
#define HE_EDIT_REGION_INSET_H

#include "edit/region/region.h"

/* The work of looking where an inset ends, a corner against a side each. */
enum { HE_INSET_STEPS = 1 << 22 };

/* face_inset: every listed face, or with `region` every set of them connected across edges, is
 * drawn off its surroundings (see region.h), and its rim moves inwards.
 *
 *        o---------------o            o---------------o
 *        |               |            | \           / |
 *        |               |            |   o-------o   |
 *        |       f       |            |   |   f   |   |
 *        |               |    --->    |   o-------o   |
 *        |               |            | /           \ |
 *        o---------------o            o---------------o
 *
 * For one face of n corners V + n, E + 2n, F + n; for a region with a rim of r half-edges V + r,
 * E + 2r, F + r. The listed faces keep their ids and are the inner ones; what is inside a region
 * stays where it is.
 *
 * New vertices have copied values of those they descend from. Interpolated ones are those at their
 * place in the region, as it is made up of triangles, in each face from the mean of its corners to
 * two neighbours: of those about the rim corner the one that comes nearest to the place.
 *
 * With a `factor` above 0 and below 1 each rim corner goes this part of the way to the mean of its
 * face's corners, or of those means of the region's faces about it. With factor 0 the sides of the
 * rim move in parallel by `distance`, within the planes of their faces; at a corner so sharp that
 * it would go further than four times that, it goes less far.
 *
 * CLAMPED. All corners move in proportion, and no further than to 99 % of the way to where first,
 * within one face of the region, a side would lose its length, a corner turn over, or a reflex
 * corner come upon another side. A face that is not planar is looked at along its normal.
 *
 * Refused, all or nothing: what he_region_draw refuses; HE_BAD_VALUE unless 0 < factor < 1, or
 * distance > 0; HE_NO_NORMAL with a distance, naming a face on the rim without area; HE_LIMIT for
 * faces with too many reflex corners and sides; HE_NOT_FINITE. HE_NO_MEMORY, HE_IDS_EXHAUSTED.
 * `out` may be NULL, else he_region_parts_clear frees it. */
HE_NODISCARD he_status he_face_inset(he_mesh *m, const uint32_t *faces, size_t count, bool region,
                                     double factor, double distance, he_region_parts *out,
                                     he_error *err);

#endif
