/* media_types.h - lists of media types, which rows of the table of routes accept in bodies and use
 * for answers. The first type of an answer is the default. */
#ifndef HE_API_DESCRIBE_MEDIA_TYPES_H
#define HE_API_DESCRIBE_MEDIA_TYPES_H

#include "api/header/media.h"

#include <stddef.h>

static const char *const json[] = {"application/json", NULL};
static const char *const packed_too[] = {"application/json", "application/vnd.hedge.edits", NULL};
static const char *const lines_too[] = {"application/json", "application/x-ndjson", NULL};
static const char *const lines_or_octets_too[] = {"application/json", "application/x-ndjson",
                                                  "application/octet-stream", NULL};
static const char *const merge_patch[] = {"application/merge-patch+json", "application/json", NULL};
static const char *const octets[] = {"application/octet-stream", NULL};
static const char *const octets_too[] = {"application/json", "application/octet-stream", NULL};
static const char *const mesh_in[] = {"application/json",
                                      "model/obj",
                                      "model/x-off",
                                      "model/ply",
                                      "application/ply",
                                      "model/stl",
                                      "model/gltf-binary",
                                      "model/gltf+json",
                                      "application/octet-stream",
                                      API_MULTIPART,
                                      NULL};
static const char *const mesh_out[] = {"application/json",  "model/obj", "model/mtl",
                                       "model/x-off",       "model/ply", "model/stl",
                                       "model/gltf-binary", NULL};
static const char *const event_stream[] = {"text/event-stream", NULL};
static const char *const job_results[] = {"application/json",
                                          "application/x-ndjson",
                                          "application/octet-stream",
                                          "application/vnd.hedge.edits",
                                          "model/obj",
                                          "model/mtl",
                                          "model/x-off",
                                          "model/ply",
                                          "model/stl",
                                          "model/gltf-binary",
                                          "application/vnd.sqlite3",
                                          NULL};
static const char *const database[] = {"application/vnd.sqlite3", NULL};
static const char *const plain[] = {"text/plain", NULL};
static const char *const html[] = {"text/html", NULL};
static const char *const anything[] = {"text/html",
                                       "text/javascript",
                                       "text/css",
                                       "image/svg+xml",
                                       "image/png",
                                       "application/json",
                                       "text/plain",
                                       "font/woff2",
                                       "application/octet-stream",
                                       NULL};

#endif
