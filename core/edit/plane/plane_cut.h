/* plane_cut.h - cuts off what is on one side of a plane. */
#ifndef HE_EDIT_PLANE_PLANE_CUT_H
#define HE_EDIT_PLANE_PLANE_CUT_H

#include "edit/plane/plane.h"

/* The side of the plane that is kept; above is the side that the normal points to. */
typedef enum he_cut_side { HE_CUT_ABOVE, HE_CUT_BELOW } he_cut_side;

typedef struct he_cut_parts {
    uint32_t edges_split, faces_split; /* as by plane_split */
    uint32_t faces_deleted;            /* parts on the other side are counted too */
    he_ids caps; /* the new faces, in the order of the half-edges they began with */
} he_cut_parts;

/* plane_cut: V, E, F vary. The mesh is split along the plane (plane_split.h); then the faces of
 * the other side are deleted, with edges and vertices that have no face left (erase.h), and
 * isolated vertices on that side.
 *
 *         o-----------o             o-----------o              o-----------o
 *        /           /|            /           /|             /           /|
 *       o-----------o |           o-----------o |            o-----------o |
 *      .|...........|.|. --->     |           | |     or     |           | |
 *       |           | o           w-----------w-w            w-----------w-w
 *       |           |/                a hole                     capped
 *       o-----------o
 *
 * Every face counts to one side, so the results for both sides together make the whole: a face in
 * the plane counts as below if it faces up, like the top of a solid below, else as above.
 *
 * With `cap` each loop of the cut becomes one polygon, even if the section has several loops, one
 * inside another: their signed areas, and the volume, are then still right.
 *
 * If it is refused, nothing changes. `out` may be NULL; otherwise he_cut_parts_clear frees it.
 * Returns HE_NOT_FINITE, HE_BAD_VALUE or HE_DOUBLED_EDGE as he_plane_split does.
 * Returns HE_LOCKED_ELEMENT if an element that would be deleted is locked (splitting is allowed).
 * Returns HE_OPEN_LOOP with `cap`, naming a vertex, if a loop leaves the plane along an older hole.
 * Returns HE_REPEATED_CORNER with `cap` if a loop passes a vertex twice.
 * Returns HE_NO_MEMORY if memory is out.
 * Returns HE_IDS_EXHAUSTED if no ids are left. */
HE_NODISCARD he_status he_plane_cut(he_mesh *m, const he_plane *plane, he_cut_side keep, bool cap,
                                    he_cut_parts *out, he_error *err);
void he_cut_parts_clear(he_cut_parts *parts);

#endif
