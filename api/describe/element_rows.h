/* element_rows.h - rows of the table of routes that differ in the kind of element.
 *
 * vertices_list, vertex_get, vertex_faces: `one` and `many` are the kind's names, `what` is the
 * name of a relation of core/query/adjacency.h. The table in routes.c uses `json` as
 * well. */
#ifndef HE_API_DESCRIBE_ELEMENT_ROWS_H
#define HE_API_DESCRIBE_ELEMENT_ROWS_H

#include "api/describe/parameters.h"
#include "api/request/handlers.h"

static const char *const json[] = {"application/json", NULL};
static const char *const lines_too[] = {"application/json", "application/x-ndjson", NULL};

#define ELEMENTS(of, one, many, words)                                                            \
    {                                                                                             \
        .method = "GET", .path = "/v1/meshes/{mesh}/" many, .name = many "_list", .kind = (of),   \
        .run = api_elements_list, .role = API_ROLE_READ, .reads = API_READS_LOCKED,               \
        .cost = api_elements_cost, .flags = API_EXPENSIVE | API_LONG, .produces = lines_too,      \
        .parameters = {&api_parameter_revision, &api_parameter_limit, &api_parameter_cursor},     \
        .headers = {&next_page}, .statuses = {200, 202, 304, 410}, .response = one "_page",       \
        .line = (one), .summary = "List the " words,                                              \
        .doc = "A page in the order of ids, or all of them as lines of JSON that end in "         \
               "{\"end\":true,\"count\":n}. Pages go on with the revision they began with while " \
               "the history holds it."                                                            \
    }

#define ELEMENT(of, one, many, text)                                                            \
    {                                                                                           \
        .method = "GET", .path = "/v1/meshes/{mesh}/" many "/{id}", .name = one "_get",         \
        .kind = (of), .run = api_element_get, .role = API_ROLE_READ, .reads = API_READS_LOCKED, \
        .produces = json, .parameters = {&api_parameter_revision}, .statuses = {200, 304, 410}, \
        .response = (one), .summary = "One " one " with all its links",                         \
        .doc = text " A deleted one is 410, one that never was is 404."                         \
    }

#define ADJACENCY(of, one, many, what, title, text)                                              \
    {                                                                                            \
        .method = "GET", .path = "/v1/meshes/{mesh}/" many "/{id}/" what, .name = one "_" what,  \
        .kind = (of), .relation = (what), .run = api_relation_get, .role = API_ROLE_READ,        \
        .reads = API_READS_LOCKED, .produces = json,                                             \
        .parameters = {&api_parameter_revision, &api_parameter_turning},                         \
        .statuses = {200, 304, 410}, .response = one "_" what, .summary = (title), .doc = (text) \
    }

#define AROUND "Counter-clockwise from the stored half-edge, each once."

#endif
