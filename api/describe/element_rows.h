/* element_rows.h - macros for those rows of the table of routes that differ only in the kind of
 * element (vertex, edge, face...).
 *
 * The macros make rows such as list_vertices, get_vertex and list_vertex_faces. `one` and `many`
 * are the singular and plural name of the kind, `what` is the name of a relation in
 * core/query/adjacency.h. The table in routes.c includes ELEMENT_ROWS. The macros name `next_page`,
 * the description of the response header Link, which routes.c defines. */
#ifndef HE_API_DESCRIBE_ELEMENT_ROWS_H
#define HE_API_DESCRIBE_ELEMENT_ROWS_H

#include "api/describe/media_types.h"
#include "api/describe/parameters.h"
#include "api/request/handlers.h"

#define ELEMENTS(of, one, many, words, media, more)                                              \
    {                                                                                            \
        .method = "GET", .path = "/v1/meshes/{mesh}/" many, .name = "list_" many, .kind = (of),  \
        .run = api_elements_list, .role = API_ROLE_READ, .reads = API_READS_LOCKED,              \
        .cost = api_elements_cost, .flags = API_EXPENSIVE | API_LONG, .produces = (media),       \
        .parameters = {&api_parameter_revision, &api_parameter_limit, &api_parameter_cursor},    \
        .headers = {&next_page}, .statuses = {200, 202, 304, 410}, .response = one "_page",      \
        .item = (one), .summary = "List the " words,                                             \
        .doc =                                                                                   \
            "A page of elements in the order of ids; as application/x-ndjson, all elements in "  \
            "lines of JSON, with {\"end\":true,\"count\":n} as the last line. Later pages show " \
            "the same revision as the first page, as long as the history holds that "            \
            "revision." more                                                                     \
    }

#define ELEMENT(of, one, many, text)                                                            \
    {                                                                                           \
        .method = "GET", .path = "/v1/meshes/{mesh}/" many "/{id}", .name = "get_" one,         \
        .kind = (of), .run = api_element_get, .role = API_ROLE_READ, .reads = API_READS_LOCKED, \
        .produces = json, .parameters = {&api_parameter_revision}, .statuses = {200, 304, 410}, \
        .response = (one), .summary = "One " one " with all its links",                         \
        .doc = text " The answer is 410 if the element was deleted, 404 if it never existed."   \
    }

#define ADJACENCY(of, one, many, what, title, text)                                              \
    {                                                                                            \
        .method = "GET", .path = "/v1/meshes/{mesh}/" many "/{id}/" what,                        \
        .name = "list_" one "_" what, .kind = (of), .relation = (what), .run = api_relation_get, \
        .role = API_ROLE_READ, .reads = API_READS_LOCKED, .produces = json,                      \
        .parameters = {&api_parameter_revision, &api_parameter_turning},                         \
        .statuses = {200, 304, 410}, .response = one "_" what, .summary = (title), .doc = (text) \
    }

#define AROUND                                                                                \
    "They are listed counter-clockwise, each once, beginning at the half-edge in the member " \
    "`halfedge`."

/* All rows about elements, in the order that they have in the table of routes. */
#define ELEMENT_ROWS                                                                               \
    ELEMENTS(HE_VERTEX, "vertex", "vertices", "vertices", lines_too, ""),                          \
        ELEMENTS(HE_HALFEDGE, "halfedge", "halfedges", "half-edges", lines_too, ""),               \
        ELEMENTS(HE_EDGE, "edge", "edges", "edges", lines_too, ""),                                \
        ELEMENTS(HE_FACE, "face", "faces", "faces", lines_or_octets_too,                           \
                 " As application/octet-stream, the corners of all n faces: n + 1 offsets, the "   \
                 "vertices at the corners (those of face i begin at position offsets[i] and end "  \
                 "before position offsets[i + 1]), the ids of the faces, and n itself, as "        \
                 "little-endian 32-bit integers."),                                                \
        ELEMENT(HE_VERTEX, "vertex", "vertices",                                                   \
                "One vertex: its position, a half-edge that leaves it, its degree."),              \
        ELEMENT(HE_HALFEDGE, "halfedge", "halfedges",                                              \
                "One half-edge: its twin, next, prev, origin, target, edge and face."),            \
        ELEMENT(HE_EDGE, "edge", "edges", "One edge: its half-edges, ends, faces and length."),    \
        ELEMENT(HE_FACE, "face", "faces",                                                          \
                "One face: its corners, half-edges, area, normal and centroid."),                  \
        ADJACENCY(HE_VERTEX, "vertex", "vertices", "vertices", "Neighbours of a vertex",           \
                  "The vertices at the other ends of the edges of the vertex. " AROUND),           \
        ADJACENCY(HE_VERTEX, "vertex", "vertices", "outgoing", "Half-edges that leave a vertex",   \
                  "The half-edges whose origin is the vertex. " AROUND),                           \
        ADJACENCY(HE_VERTEX, "vertex", "vertices", "incoming",                                     \
                  "Half-edges that arrive at a vertex",                                            \
                  "The half-edges whose target is the vertex, in the order of their twins, which " \
                  "leave the vertex. " AROUND),                                                    \
        ADJACENCY(HE_VERTEX, "vertex", "vertices", "edges", "Edges of a vertex",                   \
                  "The edges that end at the vertex. " AROUND),                                    \
        ADJACENCY(HE_VERTEX, "vertex", "vertices", "faces", "Faces around a vertex",               \
                  "The faces that have the vertex as a corner; holes are left out. " AROUND),      \
        ADJACENCY(HE_HALFEDGE, "halfedge", "halfedges", "loop", "The loop of a half-edge",         \
                  "The half-edges around the face or hole that is on the left of the half-edge: "  \
                  "first the half-edge itself, then each `next` in turn."),                        \
        ADJACENCY(HE_HALFEDGE, "halfedge", "halfedges", "ring", "The ring of a half-edge",         \
                  "The half-edges with the same origin, counter-clockwise, beginning with the "    \
                  "half-edge itself."),                                                            \
        ADJACENCY(HE_EDGE, "edge", "edges", "vertices", "Ends of an edge",                         \
                  "The two ends of the edge: the origin and the target of half-edge 2 * id."),     \
        ADJACENCY(HE_EDGE, "edge", "edges", "halfedges", "Half-edges of an edge",                  \
                  "The two half-edges of the edge: 2 * id and 2 * id + 1."),                       \
        ADJACENCY(HE_EDGE, "edge", "edges", "faces", "Faces beside an edge",                       \
                  "The one or two faces that the edge belongs to; holes are left out."),           \
        ADJACENCY(HE_FACE, "face", "faces", "vertices", "Corners of a face",                       \
                  "The vertices of the face. " AROUND),                                            \
        ADJACENCY(HE_FACE, "face", "faces", "halfedges", "Half-edges of a face",                   \
                  "The half-edges that have the face on their left. " AROUND),                     \
        ADJACENCY(HE_FACE, "face", "faces", "edges", "Edges of a face",                            \
                  "The edges of the face. " AROUND),                                               \
        ADJACENCY(HE_FACE, "face", "faces", "faces", "Faces beside a face",                        \
                  "The faces that share an edge with the face; holes are left out. " AROUND)

#endif
