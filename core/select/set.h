/* set.h - sets of elements of one kind, and how sets of different kinds follow from each other. */
#ifndef HE_SELECT_SET_H
#define HE_SELECT_SET_H

#include "mesh/walk.h"

/* A set has one bit for each id of its kind that was ever issued; the bits of deleted elements are
 * 0. The kind is HE_VERTEX, HE_EDGE or HE_FACE. he_set_clear frees the bits. */
typedef struct he_set {
    he_kind kind;
    uint32_t issued;
    uint64_t *bits;
} he_set;

/* Makes an empty set.
 * Returns HE_NO_MEMORY if memory is out. */
HE_NODISCARD he_status he_set_new(const he_mesh *m, he_kind kind, he_set *out, he_error *err);
void he_set_clear(he_set *set);

static inline bool he_set_has(const he_set *set, uint32_t id)
{
    return he_bits_get(set->bits, id);
}
static inline void he_set_add(he_set *set, uint32_t id)
{
    he_bits_set(set->bits, id);
}

/* Replaces a set by the other live elements of its kind. */
void he_set_invert(const he_mesh *m, he_set *set);

/* Adds to `out` the vertices or edges of the faces in `faces`; if `out` is a set of faces, the
 * faces themselves. Returns HE_CANCELLED if the work was cancelled. */
HE_NODISCARD he_status he_set_of_faces(const he_mesh *m, const he_set *faces, he_set *out,
                                       he_error *err);

/* Which corners of an edge or face must be in a set of vertices, so that it belongs to the set. */
typedef enum he_corner_rule { HE_ALL_CORNERS, HE_ANY_CORNER } he_corner_rule;

/* Adds to `out` the edges or faces of which all corners, or any corner, are in `vertices`; if `out`
 * is a set of vertices, the vertices themselves.
 * Returns HE_CANCELLED if the work was cancelled. */
HE_NODISCARD he_status he_set_of_vertices(const he_mesh *m, const he_set *vertices,
                                          he_corner_rule which, he_set *out, he_error *err);

#endif
