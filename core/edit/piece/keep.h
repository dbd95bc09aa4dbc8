/* keep.h - values of vertices that become one, kept by their corners.
 *
 * Both sides have a vertex attribute "uv" of their own. As one vertex they could have one value, so
 * that "uv" becomes an attribute of corners, and each keeps what it showed:
 *
 *     o---o o---o              o---o---o
 *     | 3 | | 8 |              | 3 | 8 |
 *     |   | |   |     --->     |   |   |
 *     | 4 | | 9 |              | 4 | 9 |
 *     o---o o---o              o---o---o
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

#include "mesh/write.h"

/* gone[i] becomes part of into[i]. */
typedef struct he_keep_pairs {
    const uint32_t *gone, *into;
    size_t count;
} he_keep_pairs;

/* The kept values of one weld, from he_keep_begin to he_keep_end. */
typedef struct he_keeping {
    uint64_t count;     /* values of vertices that differ from that of the one they go into */
    he_bracket bracket; /* begun where there are such values */
} he_keeping;

/* Keeps what would be lost, between CHECK and RESERVE of a weld. Where it fails, the mesh is as it
 * was, and he_keep_end is not called: HE_NO_MEMORY, HE_CANCELLED. */
HE_NODISCARD he_status he_keep_begin(he_mesh *m, const he_keep_pairs *pairs, he_keeping *out,
                                     he_error *err);
/* Ends the weld with its status, which is returned: a failure takes back what was kept. `moved`,
 * where it is not NULL, gets the count of a weld that was done. */
he_status he_keep_end(he_mesh *m, he_keeping *kept, he_status status, uint64_t *moved);

#endif
