/* path.h - splitting and decoding the request target.
 *
 * The raw path is split at '/' first and each segment decoded then, so an encoded slash can never
 * make another segment. In the last one it is part of the text, for names of attributes may hold
 * one; elsewhere it is refused, and so are %00, bad escapes and bytes that are not UTF-8
 * everywhere. */
#ifndef HE_API_HEADER_PATH_H
#define HE_API_HEADER_PATH_H

#include "api/json/arena.h"
#include "api/json/problem.h"
#include "api/limits.h"

typedef struct api_path {
    const char *segments[API_MAX_SEGMENTS]; /* decoded, in the arena */
    size_t count;                           /* 0 for "/" */
    bool has_slash;                         /* the last segment holds one, which was escaped */
} api_path;

/* bad_path (400), no_such_route (404: an empty segment such as in "//" or a trailing slash, or too
 * many), no_memory. */
bool api_path_split(const char *raw, api_arena *arena, api_path *out, api_problem *problem);

/* One name=value pair of the query, decoded; '+' is a plus sign, not a space. */
typedef struct api_pair {
    const char *name, *value;
} api_pair;

typedef struct api_query {
    api_pair pairs[API_MAX_PARAMETERS];
    size_t count;
} api_query;

/* "" is an empty query. A pair without '=' is bad_query, and so is an empty name. */
bool api_query_split(const char *raw, api_arena *arena, api_query *out, api_problem *problem);

/* `text` as a decimal number of 1 to 10 digits below 2^32 - 2: an element id. */
bool api_path_id(const char *text, uint32_t *out);
/* Can `text` name a mesh: [A-Za-z0-9._-]{1,64}, not "." or ".."? */
bool api_path_is_mesh_id(const char *text);

#endif
