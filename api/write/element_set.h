/* element_set.h - {"selected":true}: the live elements of a kind whose bool attribute of that name
 * is true, in the order of ids. Stands where a list of ids may stand. */
#ifndef HE_API_WRITE_ELEMENT_SET_H
#define HE_API_WRITE_ELEMENT_SET_H

#include "api/json/json_in.h"

/* One member, which is true; its name goes to *name. missing_member, unknown_member for a second
 * one, wrong_type, bad_value for false. */
bool api_in_set(const api_in *in, const char **name);
/* Its elements in the arena, never NULL; none is fine. no_such_attribute with status 422;
 * wrong_type where the attribute is not a bool of one component; limit_exceeded. */
bool api_find_set(const api_in *in, const char *name, const he_mesh *mesh, he_kind kind,
                  api_arena *arena, uint32_t **ids, size_t *count);

#endif
