/* separate.h - bow-ties taken apart. */
#ifndef HE_EDIT_WHOLE_SEPARATE_H
#define HE_EDIT_WHOLE_SEPARATE_H

#include "mesh/mesh.h"

/* vertex_separate: V + (fans - 1) for each vertex, E + 0, F + 0.
 *
 *        o-----o     o-----o             o-----o     o-----o
 *         \  f  \   /  g  /               \  f  \   /  g  /
 *          \     \ /     /                 \     \ /     /
 *           o-----v-----o       --->        o-----v u-----o      u lies where v does, and descends
 *          /     / \     /                 /     / \     /       from it.
 *
 * The fan of the half-edge v stores stays with v; each other one gets a new vertex, in their order
 * about v. A vertex with one fan or none is left alone. Corners keep their values, and the new
 * vertices have those of v.
 *
 * The new ids are appended to `made`, which may be NULL. Refused, all or nothing:
 * HE_NO_SUCH_ELEMENT, HE_DELETED_ELEMENT, HE_REPEATED_ELEMENT; HE_LOCKED_ELEMENT for an edge or
 * face of a fan that leaves v. HE_NO_MEMORY, HE_IDS_EXHAUSTED. vertex_weld is the inverse. */
HE_NODISCARD he_status he_vertex_separate(he_mesh *m, const uint32_t *vertices, size_t count,
                                          he_ids *made, he_error *err);

/* separate_bowties: the same for every vertex. */
HE_NODISCARD he_status he_separate_bowties(he_mesh *m, he_ids *made, he_error *err);

#endif
