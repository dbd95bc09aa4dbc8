/* keep.h - values of vertices that become one, kept by their corners.
 *
 *     o---o o---o              o---o---o       Both sides have a vertex attribute "uv" of their
 * own. | 3 | | 8 |              | 3 | 8 |       As one vertex they could have one value, so that |
 * | |   |     --->     |   |   |       "uv" becomes an attribute of corners, and each keeps | 4 | |
 * 9 |              | 4 | 9 |       what it showed. o---o o---o              o---o---o
 *
 * A weld has means of positions and of nothing else. Where a vertex with corners goes into one with
 * another value of an attribute, all corners of the mesh get the values of their vertices, under
 * the attribute's name. The attribute of vertices goes then, unless a vertex without corners has a
 * value of it that is not the default.
 *
 * CORNERS MAY HAVE AN ATTRIBUTE OF THAT NAME, which is never changed. Where it has the same type,
 * and the corners about the vertices that go have the values of these, all is kept already. Else
 * the name is NAME_2, or the first one after that for which this holds or which is free.
 *
 * Marks (marks.h) are not values, and stay. A vertex without corners has nowhere to leave its
 * value: that of the vertex it goes into stays. Where an attribute's rule is `default`, a vertex
 * that goes and holds the default says nothing. */
#ifndef HE_EDIT_PIECE_KEEP_H
#define HE_EDIT_PIECE_KEEP_H

#include "mesh/mesh.h"

/* gone[i] becomes part of into[i]. */
typedef struct he_keep_pairs {
    const uint32_t *gone, *into;
    size_t count;
} he_keep_pairs;

/* How many values of vertices differ from that of the one they go into: 0 where nothing is to be
 * kept. */
uint64_t he_keep_count(const he_mesh *m, const he_keep_pairs *pairs);
/* Between CHECK and RESERVE of an edit, inside he_edit_begin: HE_NO_MEMORY and HE_CANCELLED leave
 * what was begun to he_edit_end. */
HE_NODISCARD he_status he_keep_values(he_mesh *m, const he_keep_pairs *pairs, he_error *err);

#endif
