/* keep.h - keeps the values of vertices that are merged, by moving them to their corners.
 *
 * In this example the vertices of both sides have an attribute "uv" with different values. A merged
 * vertex could have only one value, so "uv" becomes an attribute of corners, and each side keeps
 * its values:
 *
 *     o---o o---o              o---o---o
 *     | 3 | | 8 |              | 3 | 8 |
 *     |   | |   |     --->     |   |   |
 *     | 4 | | 9 |              | 4 | 9 |
 *     o---o o---o              o---o---o
 *
 * When vertices are welded, only their positions are averaged, never their attributes. If a vertex
 * with corners is merged into one with another value of an attribute, all corners of the mesh get
 * the values of their vertices, under the attribute's name. The attribute of vertices is then
 * deleted, unless a vertex without corners has a value of it that is not the default.
 *
 * If corners already have an attribute of that name, it is never changed. If it is of the vertex
 * attribute's type, and the corners at the merged vertices have the values of these vertices,
 * nothing needs to be moved. Otherwise the values move to a new attribute of corners called NAME_2,
 * or NAME_ with the first higher number that is free. If an existing corner attribute with such a
 * name already has these values, no new attribute is made.
 *
 * Marks (marks.h) are not moved. A vertex without corners cannot keep its value: the value of the
 * vertex it is merged into stays. If an attribute's rule is `default`, a vertex that has the
 * default value has no value to keep. */
#ifndef HE_EDIT_PIECE_KEEP_H
#define HE_EDIT_PIECE_KEEP_H

#include "mesh/write.h"

/* The merges of one weld: vertex gone[i] is merged into vertex into[i]. */
typedef struct he_keep_pairs {
    const uint32_t *gone, *into;
    size_t count;
} he_keep_pairs;

/* The values that a weld under way must keep: he_keep_begin fills this struct, he_keep_end clears
 * it. */
typedef struct he_keeping {
    /* The number of values that would be lost: those in which a merged vertex differs from the
     * vertex into which it is merged. */
    uint64_t count;
    /* The bracket (edits that succeed or fail together) that encloses the weld; begun only if
     * `count` is above 0. */
    he_bracket bracket;
} he_keeping;

/* Moves the values of vertices that the weld would lose to corners. An edit must call it after its
 * checks and before it reserves memory. On failure the mesh is as it was, and the caller must not
 * call he_keep_end.
 * Returns HE_NO_MEMORY if memory is out.
 * Returns HE_CANCELLED if the work was cancelled. */
HE_NODISCARD he_status he_keep_begin(he_mesh *m, const he_keep_pairs *pairs, he_keeping *out,
                                     he_error *err);
/* Ends what he_keep_begin began. The caller passes the outcome of the weld as `status`, which is
 * also the return value. If the weld failed, the values at corners move back to the vertices. If
 * the weld succeeded, `moved` (which may be NULL) gets the number of values that moved to
 * corners. */
he_status he_keep_end(he_mesh *m, he_keeping *kept, he_status status, uint64_t *moved);

#endif
