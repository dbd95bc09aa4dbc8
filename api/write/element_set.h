/* element_set.h - sets of elements. The set {"selected":true} consists of the live elements whose
 * bool attribute "selected" is true, in the order of ids. A set may replace a list of ids. */
#ifndef HE_API_WRITE_ELEMENT_SET_H
#define HE_API_WRITE_ELEMENT_SET_H

#include "api/json/json_in.h"

/* Reads a set, an object with one member whose value is true; `*name` gets the name of the member.
 * Returns false with missing_member, unknown_member for a second member, wrong_type, or bad_value
 * for the value false. */
bool api_in_set(const api_in *in, const char **name);
/* Reads a set and lists its elements in the arena. An empty set is allowed; `*ids` is not NULL then
 * either. Returns false as api_in_set does, or with no_such_attribute (status 422), wrong_type if
 * the attribute is not a bool with one component, or limit_exceeded. */
bool api_find_set(const api_in *in, const he_mesh *mesh, he_kind kind, api_arena *arena,
                  uint32_t **ids, size_t *count);

#endif
