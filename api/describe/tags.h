/* tags.h - the groups (tags) into which the OpenAPI document divides the routes. */
#ifndef HE_API_DESCRIBE_TAGS_H
#define HE_API_DESCRIBE_TAGS_H

#include "api/json/json_out.h"

/* Returns the name of the group of the route with this path, a string literal. */
const char *api_tag_of(const char *path);
/* Writes the member "tags": each group with a sentence about it. */
void api_tags_write(api_out *out);

#endif
