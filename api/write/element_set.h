/* element_set.h - sets of elements, which may replace a list of ids.
 *
 * The set {"selected":true} consists of the live elements whose bool attribute "selected" is true,
 * {"patch":3} of those whose int32 or uint32 attribute "patch" is 3; both in the order of ids. */
#ifndef HE_API_WRITE_ELEMENT_SET_H
#define HE_API_WRITE_ELEMENT_SET_H

#include "api/json/json_in.h"

/* A set as a request gives it. */
typedef struct api_set {
    const char *name; /* of the attribute; borrowed from the document */
    bool is_number;   /* the value is `number`; else it is true */
    int64_t number;   /* from -2^31 to 2^32 - 1 */
} api_set;

/* Reads a set, an object with one member. Returns false with missing_member, unknown_member for a
 * second member, wrong_type if the value is neither a number nor a boolean, or bad_value for the
 * value false and for a number that no int32 and no uint32 can be. */
bool api_in_set(const api_in *in, api_set *out);
/* Reads a set and lists its elements in the arena. An empty set is allowed; `*ids` is not NULL then
 * either. Returns false as api_in_set does, or with no_such_attribute, limit_exceeded, or
 * wrong_type if the attribute has several components or another type than the value. */
bool api_find_set(const api_in *in, const he_mesh *mesh, he_kind kind, api_arena *arena,
                  uint32_t **ids, size_t *count);

#endif
