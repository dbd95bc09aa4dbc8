/* separate.h - separates the fans of bow-ties. */
#ifndef HE_EDIT_WHOLE_SEPARATE_H
#define HE_EDIT_WHOLE_SEPARATE_H

#include "mesh/mesh.h"

/* vertex_separate gives each fan of a bow-tie its own vertex: V + (fans - 1) for each listed
 * vertex, E + 0, F + 0.
 *
 *        o-----o     o-----o             o-----o     o-----o
 *         \  f  \   /  g  /               \  f  \   /  g  /
 *          \     \ /     /                 \     \ /     /
 *           o-----v-----o       --->        o-----v u-----o      u lies where v does, and descends
 *          /     / \     /                 /     / \     /       from it.
 *
 * The fan of the half-edge that v stores keeps v. Each other fan gets a new vertex, in the order of
 * the fans around v. A vertex with one fan or none is not changed. Corners keep their values, and
 * the new vertices have the values of v.
 *
 * vertex_weld is the inverse. The ids of the new vertices are appended to `made`, which may be
 * NULL. If the edit is refused, nothing changes.
 * Returns HE_NO_SUCH_ELEMENT or HE_DELETED_ELEMENT if an element is not live.
 * Returns HE_REPEATED_ELEMENT if an element is listed twice.
 * Returns HE_LOCKED_ELEMENT if an edge or face of a fan that would get a new vertex is locked.
 * Returns HE_NO_MEMORY if memory is out.
 * Returns HE_IDS_EXHAUSTED if no ids are left. */
HE_NODISCARD he_status he_vertex_separate(he_mesh *m, const uint32_t *vertices, size_t count,
                                          he_ids *made, he_error *err);

/* separate_bowties: runs vertex_separate for every bow-tie of the mesh. */
HE_NODISCARD he_status he_separate_bowties(he_mesh *m, he_ids *made, he_error *err);

#endif
