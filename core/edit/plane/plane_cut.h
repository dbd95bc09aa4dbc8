/* plane_cut.h - cuts off the part of a mesh on one side of a plane. */
#ifndef HE_EDIT_PLANE_PLANE_CUT_H
#define HE_EDIT_PLANE_PLANE_CUT_H

#include "edit/plane/plane.h"

/* The side of the plane on which the mesh is kept; `above` is the side to which the plane's normal
 * points. */
typedef enum he_cut_side { HE_CUT_ABOVE, HE_CUT_BELOW } he_cut_side;

typedef struct he_cut_parts {
    /* `edges_split` and `faces_split`: numbers of edges and of faces that were split */
    uint32_t edges_split, faces_split;
    uint32_t faces_deleted; /* number of deleted faces, parts of split faces included */
    /* The faces that close the cut, sorted by the lowest id of a half-edge of the cut that each of
     * them closes. */
    he_ids caps;
} he_cut_parts;

/* plane_cut cuts off what is on one side of a plane; V, E and F vary. The mesh is split along the
 * plane (plane_split.h); then the faces on the other side than `keep` are deleted, with edges and
 * vertices that have no face left (erase.h), and so are isolated vertices on that side.
 *
 *         o-----------o             o-----------o              o-----------o
 *        /           /|            /           /|             /           /|
 *       o-----------o |           o-----------o |            o-----------o |
 *      .|...........|.|. --->     |           | |     or     |           | |
 *       |           | o           w-----------w-w            w-----------w-w
 *       |           |/                a hole                     capped
 *       o-----------o
 *
 * Every face belongs to exactly one side, so the parts kept by the two values of `keep` make up the
 * whole mesh. A face in the plane belongs to the side below if it faces up, like the top of a solid
 * below the plane, else to the side above.
 *
 * With `cap` each loop of the cut is closed by one polygon, even if one loop lies inside another.
 * The signed areas of such polygons, and the volume of the mesh, are still correct.
 *
 * If the edit is refused, nothing changes. `out` may be NULL; otherwise he_cut_parts_clear frees
 * it.
 * Returns HE_NOT_FINITE, HE_BAD_VALUE or HE_DOUBLED_EDGE as he_plane_split does.
 * Returns HE_LOCKED_ELEMENT if an element that would be deleted is locked (splitting is allowed).
 * Returns HE_OPEN_LOOP with `cap`, naming a vertex, if a loop of the cut does not stay in the plane
 * because it runs along an older hole. Returns HE_REPEATED_CORNER with `cap` if a loop passes a
 * vertex twice.
 * Returns HE_NO_MEMORY if memory is out.
 * Returns HE_IDS_EXHAUSTED if no ids are left. */
HE_NODISCARD he_status he_plane_cut(he_mesh *m, const he_plane *plane, he_cut_side keep, bool cap,
                                    he_cut_parts *out, he_error *err);
void he_cut_parts_clear(he_cut_parts *parts);

#endif
