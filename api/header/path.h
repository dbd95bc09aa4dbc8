/* path.h - splits and decodes the target of a request: its path and its query.
 *
 * The raw path is split at '/' and each segment decoded afterwards, so that an encoded slash (%2F)
 * never separates segments. An encoded slash is allowed in the last segment, because attribute
 * names may contain a slash, and refused elsewhere. %00, malformed escapes and bytes that are not
 * UTF-8 are refused everywhere. */
#ifndef HE_API_HEADER_PATH_H
#define HE_API_HEADER_PATH_H

#include "api/json/arena.h"
#include "api/json/problem.h"
#include "api/limits.h"

typedef struct api_path {
    const char *segments[API_MAX_SEGMENTS]; /* the decoded segments; their memory is in the arena */
    size_t count;                           /* 0 for "/" */
    bool has_slash;                         /* true if the last segment contains an encoded slash */
} api_path;

/* Splits a path into segments and decodes them. Returns false with bad_path (400), with
 * no_such_route (404) for too many segments or an empty one (as in "//" or after a trailing slash),
 * or with no_memory. */
bool api_path_split(const char *raw, api_arena *arena, api_path *out, api_problem *problem);

/* One name=value pair of the query, percent-decoded; '+' means a plus sign, not a space. */
typedef struct api_pair {
    const char *name, *value;
} api_pair;

typedef struct api_query {
    api_pair pairs[API_MAX_PARAMETERS];
    size_t count;
} api_query;

/* Splits a query; "" is an empty query. Returns false with bad_query for a pair without '=' or with
 * an empty name. */
bool api_query_split(const char *raw, api_arena *arena, api_query *out, api_problem *problem);

/* Reads an element id: a decimal number of 1 to 10 digits, below 2^32 - 2. */
bool api_path_id(const char *text, uint32_t *out);
/* Reads a revision: a decimal number from 1 to 2^53. */
bool api_path_revision(const char *text, uint64_t *out);
/* Returns true if `text` can name a mesh: [A-Za-z0-9._-]{1,64}, not "." or "..". */
bool api_path_is_mesh_id(const char *text);

#endif
