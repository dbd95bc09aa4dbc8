/* reverse.h - faces turned over. */
#ifndef HE_EDIT_WHOLE_REVERSE_H
#define HE_EDIT_WHOLE_REVERSE_H

#include "mesh/mesh.h"

/* reverse: V, E, F + 0. Every listed face, or every face for NULL, runs the other way round. No
 * element comes or goes and edges keep their ends, so that half-edge 2e starts where it did: the
 * two half-edges of an edge change places.
 *
 *         c                        c
 *         o                        o
 *        / ^                      ^ \
 *       v   \           --->     /   v
 *      /  f  \                  /  f  \          face(h) was f, face(twin(h)) is f now
 *     o---h-->o                o<------o
 *     a       b                a       b
 *
 * Corner values stay in their corner: that of a half-edge goes to the one that leaves the same
 * vertex in the same face now. Attributes `normal` of three floats or doubles, on the vertices and
 * corners of these faces and on the faces, change their sign. Its own inverse, bit for bit.
 *
 * Only whole components can be turned over: neighbours across an edge would run along it in one
 * direction, and the fans at a bow-tie chain their holes in one direction too.
 *
 * Refused, all or nothing: HE_NO_SUCH_ELEMENT, HE_DELETED_ELEMENT, HE_REPEATED_ELEMENT;
 * HE_ORIENTATION naming an edge whose other face is not listed; HE_BOWTIE naming a vertex where a
 * fan is not. What is locked keeps its corners and ends, so nothing is refused for it.
 * HE_NO_MEMORY.
 */
HE_NODISCARD he_status he_reverse(he_mesh *m, const uint32_t *faces, size_t count, he_error *err);

#endif
