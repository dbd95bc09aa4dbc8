/* reverse.h - reverses the orientation of faces. */
#ifndef HE_EDIT_WHOLE_REVERSE_H
#define HE_EDIT_WHOLE_REVERSE_H

#include "mesh/mesh.h"

/* reverse reverses the orientation of faces: V, E, F + 0. The loop of every listed face, or of
 * every face if `faces` is NULL, is reversed. No element is made or deleted. The half-edges of an
 * edge keep their origins, and exchange their faces.
 *
 *         c                        c
 *         o                        o
 *        / ^                      ^ \
 *       v   \           --->     /   v
 *      /  f  \                  /  f  \          face(h) was f, face(twin(h)) is f now
 *     o---h-->o                o<------o
 *     a       b                a       b
 *
 * Corner values stay in their corner: the value of a half-edge moves to the half-edge that now
 * leaves the vertex inside the face. Attributes `normal` of three floats or doubles, on the
 * vertices and corners of these faces and on the faces, change their sign. Reversing twice restores
 * every bit.
 *
 * Only whole components can be reversed. Otherwise two faces would run along their common edge in
 * one direction, or two fans of a bow-tie would have different orientations.
 *
 * If the edit is refused, nothing changes. Locked elements (marks.h) are allowed, because they keep
 * their corners and ends.
 * Returns HE_NO_SUCH_ELEMENT or HE_DELETED_ELEMENT if an element is not live.
 * Returns HE_REPEATED_ELEMENT if an element is listed twice.
 * Returns HE_ORIENTATION naming an edge, if only one of its two faces is listed.
 * Returns HE_BOWTIE naming a vertex, if one of its fans is listed and another one is not.
 * Returns HE_NO_MEMORY if memory is out. */
HE_NODISCARD he_status he_reverse(he_mesh *m, const uint32_t *faces, size_t count, he_error *err);

#endif
