/* plane_cut.h - what lies on one side of a plane, taken away. */
#ifndef HE_EDIT_PLANE_PLANE_CUT_H
#define HE_EDIT_PLANE_PLANE_CUT_H

#include "mesh/mesh.h"

/* The side that stays: above is the one the normal points to. */
typedef enum he_cut_side { HE_CUT_ABOVE, HE_CUT_BELOW } he_cut_side;

typedef struct he_cut_parts {
    uint32_t edges_split, faces_split; /* as by plane_split */
    uint32_t faces_deleted;            /* the parts on the other side among them */
    he_ids caps;                       /* the new faces, by the half-edges they began with */
} he_cut_parts;

/* plane_cut: V, E, F vary. The mesh is split along the plane (plane_split.h), with `tolerance` or,
 * where that is NULL, the default of plane.h; then the faces of the other side go, with edges and
 * vertices that have no face left (erase.h), and isolated vertices on that side.
 *
 *         o-----------o             o-----------o              o-----------o
 *        /           /|            /           /|             /           /|
 *       o-----------o |           o-----------o |            o-----------o |
 *      .|...........|.|. --->     |           | |     or     |           | |
 *       |           | o           w-----------w-w            w-----------w-w
 *       |           |/                a hole                     capped
 *       o-----------o
 *
 * Every face is on one side, so that what the two sides keep makes up the whole: one in the plane
 * is below it when it faces up, as the top of what is below does, else above it.
 *
 * With `cap` each loop of the cut becomes one polygon, also where the section has several loops,
 * one in another: their signed areas, and the volume, are right as they are.
 *
 * Refused, all or nothing: as plane_split (HE_NOT_FINITE, HE_BAD_VALUE, HE_DOUBLED_EDGE);
 * HE_LOCKED_ELEMENT for what would go (splitting is allowed); with `cap` HE_OPEN_LOOP, naming a
 * vertex, when a loop leaves the plane along an older hole, and HE_REPEATED_CORNER when it passes a
 * vertex twice. HE_NO_MEMORY, HE_IDS_EXHAUSTED. `out` may be NULL, else he_cut_parts_clear frees
 * it. */
HE_NODISCARD he_status he_plane_cut(he_mesh *m, he_vec3 point, he_vec3 normal,
                                    const double *tolerance, he_cut_side keep, bool cap,
                                    he_cut_parts *out, he_error *err);
void he_cut_parts_clear(he_cut_parts *parts);

#endif
