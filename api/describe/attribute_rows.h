/* attribute_rows.h - the rows of the table of routes about attributes. The table in routes.c
 * includes ATTRIBUTE_ROWS. The rows name `next_page`, the description of the response header Link,
 * which routes.c defines. */
#ifndef HE_API_DESCRIBE_ATTRIBUTE_ROWS_H
#define HE_API_DESCRIBE_ATTRIBUTE_ROWS_H

#include "api/describe/media_types.h"
#include "api/describe/parameters.h"
#include "api/request/handlers.h"
#include "api/request/mesh_access.h"

#define ATTRIBUTE_ROWS                                                                             \
    {.method = "GET",                                                                              \
     .path = "/v1/meshes/{mesh}/attributes",                                                       \
     .name = "list_attributes",                                                                    \
     .run = api_attributes_list,                                                                   \
     .role = API_ROLE_READ,                                                                        \
     .reads = API_READS_LOCKED,                                                                    \
     .produces = json,                                                                             \
     .parameters = {&api_parameter_revision},                                                      \
     .statuses = {200, 304, 410},                                                                  \
     .response = "attribute_list",                                                                 \
     .summary = "List the attributes",                                                             \
     .doc = "The attributes of every domain, without their values."},                              \
        {.method = "GET",                                                                          \
         .path = "/v1/meshes/{mesh}/attributes/{domain}/{name}",                                   \
         .name = "get_attribute",                                                                  \
         .run = api_attribute_get,                                                                 \
         .role = API_ROLE_READ,                                                                    \
         .reads = API_READS_LOCKED,                                                                \
         .cost = api_attribute_cost,                                                               \
         .flags = API_EXPENSIVE | API_LONG,                                                        \
         .produces = octets_too,                                                                   \
         .parameters = {&api_parameter_revision, &api_parameter_limit, &api_parameter_cursor,      \
                        &api_parameter_ids, &api_parameter_type_out},                              \
         .headers = {&next_page},                                                                  \
         .statuses = {200, 202, 304, 410, 422},                                                    \
         .response = "attribute_values",                                                           \
         .summary = "Values of an attribute",                                                      \
         .doc =                                                                                    \
             "A page of elements in the order of ids, or the elements in `ids`. As "               \
             "application/octet-stream: the values of the elements in `ids` in their order, or a " \
             "value for each id that was ever given out, where deleted elements have the "         \
             "default; a "                                                                         \
             "bool is one byte, the other types are 4 or 8 bytes, little-endian, without gaps. "   \
             "`/attributes/vertices/position` reads the positions of the vertices like an "        \
             "attribute "                                                                          \
             "of 3 doubles."},                                                                     \
        {.method = "PUT",                                                                          \
         .path = "/v1/meshes/{mesh}/attributes/{domain}/{name}",                                   \
         .name = "replace_attribute",                                                              \
         .begin = api_attribute_put_begin,                                                         \
         .begin_reads = API_READS_LOCKED,                                                          \
         .body = api_attribute_put_body,                                                           \
         .run = api_attribute_put,                                                                 \
         .reads = API_READS_BEFORE,                                                                \
         .cost = api_cost_of_mesh,                                                                 \
         .role = API_ROLE_WRITE,                                                                   \
         .flags = API_WRITES | API_COSTLY | API_REHEARSED,                                         \
         .body_kind = API_BODY_UPLOAD,                                                             \
         .consumes = octets_too,                                                                   \
         .produces = json,                                                                         \
         .parameters = {&api_parameter_type, &api_parameter_components, &api_parameter_rule,       \
                        &api_parameter_dry_run},                                                   \
         .statuses = {200, 201, 204, 409, 412, 413, 415, 422},                                     \
         .request = "attribute",                                                                   \
         .response = "attribute_written",                                                          \
         .summary = "Create an attribute, or replace it",                                          \
         .doc =                                                                                    \
             "Writes the whole attribute: values for all elements, one value for all, or the "     \
             "default. As application/octet-stream: values as GET gives them, described by the "   \
             "query parameters; the values of deleted elements are ignored. The change is one "    \
             "revision, which can be undone. A PUT to `/attributes/vertices/position` moves all "  \
             "vertices; there the default of `type` is double, and that of `components` is 3. "    \
             "Vertices whose position stays the same are not written, so they may be locked."},    \
        {.method = "PATCH",                                                                        \
         .path = "/v1/meshes/{mesh}/attributes/{domain}/{name}",                                   \
         .name = "update_attribute",                                                               \
         .run = api_attribute_patch,                                                               \
         .reads = API_READS_BEFORE,                                                                \
         .cost = api_cost_of_mesh,                                                                 \
         .role = API_ROLE_WRITE,                                                                   \
         .flags = API_WRITES | API_COSTLY | API_IDEMPOTENCY_KEY | API_REHEARSED,                   \
         .body_kind = API_BODY_EDITS,                                                              \
         .consumes = octets_too,                                                                   \
         .produces = json,                                                                         \
         .parameters = {&api_parameter_type_in, &api_parameter_dry_run},                           \
         .statuses = {200, 204, 409, 412, 413, 415, 422},                                          \
         .request = "attribute_patch",                                                             \
         .response = "attribute_written",                                                          \
         .summary = "Write values by ids",                                                         \
         .doc =                                                                                    \
             "Writes a value for each id, or one value for all ids. As application/octet-stream: " \
             "all ids, of 4 bytes each, and then their values, little-endian, without gaps. The "  \
             "change is one revision, which can be undone; there is no new revision if no value "  \
             "changes. A PATCH of `/attributes/vertices/position` moves the vertices."},           \
    {                                                                                              \
        .method = "DELETE", .path = "/v1/meshes/{mesh}/attributes/{domain}/{name}",                \
        .name = "delete_attribute", .run = api_attribute_delete, .role = API_ROLE_WRITE,           \
        .flags = API_WRITES | API_REHEARSED, .produces = json,                                     \
        .parameters = {&api_parameter_dry_run}, .statuses = {200, 204, 409, 412},                  \
        .response = "attribute_written", .summary = "Delete an attribute",                         \
        .doc = "Deletes the attribute and its values. The change is one revision, which can be "   \
               "undone. "                                                                          \
               "The positions of vertices cannot be deleted."                                      \
    }

#endif
