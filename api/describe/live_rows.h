/* live_rows.h - the rows of the table of routes about what happens at a mesh now: its events, and
 * the clients that show themselves. The table in routes.c includes LIVE_ROWS. */
#ifndef HE_API_DESCRIBE_LIVE_ROWS_H
#define HE_API_DESCRIBE_LIVE_ROWS_H

#include "api/describe/media_types.h"
#include "api/describe/parameters.h"
#include "api/request/handlers.h"

#define LIVE_ROWS                                                                                  \
    {.method = "GET",                                                                              \
     .path = "/v1/meshes/{mesh}/events",                                                           \
     .name = "follow_mesh",                                                                        \
     .run = api_events_get,                                                                        \
     .role = API_ROLE_READ,                                                                        \
     .reads = API_READS_CARD,                                                                      \
     .produces = event_stream,                                                                     \
     .parameters = {&api_parameter_last_seen},                                                     \
     .statuses = {200},                                                                            \
     .item = "mesh_event",                                                                         \
     .summary = "Events of a mesh",                                                                \
     .doc =                                                                                        \
         "Server-sent events. `edit`: a new revision as a delta, complete enough to mirror the "   \
         "mesh exactly. `metadata`: the name of the mesh changed. `moment`: a revision was "       \
         "named. "                                                                                 \
         "`presence`: who else is there, and what they show. `job`: a job on this mesh started "   \
         "or "                                                                                     \
         "ended. `resync`: fetch the mesh again, because events were left out. `bye`: the stream " \
         "ends. With Last-Event-ID or `since` the stream continues where a client was "            \
         "interrupted, or begins with `resync` if the history does not reach back that far."},     \
        {.method = "GET",                                                                          \
         .path = "/v1/meshes/{mesh}/presence",                                                     \
         .name = "list_presences",                                                                 \
         .run = api_clients_list,                                                                  \
         .cold = api_clients_list_cold,                                                            \
         .role = API_ROLE_READ,                                                                    \
         .reads = API_READS_CARD,                                                                  \
         .produces = json,                                                                         \
         .statuses = {200},                                                                        \
         .response = "presences",                                                                  \
         .summary = "Who is there",                                                                \
         .doc =                                                                                    \
             "The clients that show themselves at the mesh, with their selections and cameras."},  \
    {                                                                                              \
        .method = "PUT", .path = "/v1/meshes/{mesh}/presence", .name = "put_presence",             \
        .run = api_client_put, .cold = api_client_put_cold, .role = API_ROLE_READ,                 \
        .reads = API_READS_CARD, .body_kind = API_BODY_CONTROL, .consumes = json,                  \
        .produces = json, .statuses = {200, 204, 409, 413, 415}, .request = "presence_put",        \
        .response = "presences", .summary = "Show yourself to others",                             \
        .doc =                                                                                     \
            "What the client shows of itself to the other clients of the mesh. It is no change "   \
            "of the mesh and is not stored. Listeners get it in an event `presence`, at most ten " \
            "times a second. A client is forgotten 30 seconds after its last PUT. At most 64 "     \
            "clients show themselves at a mesh, and 16 with one token. The answer lists who is "   \
            "there, like GET."                                                                     \
    }

#endif
