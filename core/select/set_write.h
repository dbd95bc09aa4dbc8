/* set_write.h - writes sets of elements into attributes.
 *
 * A set is a bool attribute of vertices, edges or faces, such as `selected`, `locked` or `feature`
 * (marks.h); or all elements whose int attribute, such as `patch`, has a certain value. Requests
 * name such a set as {"selected":true} or {"patch":3} wherever an operation takes a list of
 * elements. If the attribute does not exist, it is created: with the default false or 0, and the
 * rule copy, so that the parts of an element that is cut belong to the set, too. */
#ifndef HE_SELECT_SET_WRITE_H
#define HE_SELECT_SET_WRITE_H

#include "select/set.h"

/* What is done with the elements that the rule finds. */
typedef enum he_set_mode {
    HE_SET_ONLY,  /* they become the set */
    HE_SET_ADD,   /* they are added to the set */
    HE_SET_REMOVE /* they are removed from the set */
} he_set_mode;

/* The set into which the result is written. */
typedef struct he_set_into {
    const char *name; /* of an attribute of the elements */
    /* 0: the attribute is a bool with one component. Otherwise it is an int32 or uint32 with one
     * component and without labels, the elements of the set have this value, and elements that are
     * removed get 0. */
    int32_t value;
    he_set_mode mode;
} he_set_into;

typedef struct he_set_counts {
    uint32_t selected;       /* number of elements of the set afterwards */
    uint32_t added, removed; /* number of elements that joined and left the set */
} he_set_counts;

/* Checks whether a set can be written into the attribute.
 * Returns HE_BAD_VALUE if the name is empty, too long or "position".
 * Returns HE_NO_SUCH_ATTRIBUTE if there is no attribute from which elements could be removed.
 * Returns HE_ATTRIBUTE_CLASH if the attribute has another type than the set needs. */
HE_NODISCARD he_status he_set_into_check(const he_mesh *m, he_kind kind, const he_set_into *into,
                                         he_error *err);

/* Writes the set `set` into an attribute; elements that stay in the attribute's set, or outside it,
 * keep their values. `out` may be NULL. On failure the mesh is as it was.
 * Returns the errors of he_set_into_check.
 * Returns HE_CANCELLED if the work was cancelled, HE_NO_MEMORY if memory is out. */
HE_NODISCARD he_status he_set_write(he_mesh *m, const he_set *set, const he_set_into *into,
                                    he_set_counts *out, he_error *err);

#endif
