#include "api/describe/routes.h"

#include "api/describe/element_rows.h"
#include "api/describe/parameters.h"
#include "api/document/summary.h"
#include "api/request/handlers.h"
#include "api/request/mesh_access.h"

/* --- media types --- */

static const char *const json[] = {"application/json", NULL};
static const char *const merge_patch[] = {"application/merge-patch+json", "application/json", NULL};
static const char *const octets[] = {"application/octet-stream", NULL};
static const char *const octets_too[] = {"application/json", "application/octet-stream", NULL};
static const char *const lines_too[] = {"application/json", "application/x-ndjson", NULL};
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
                                          "model/obj",
                                          "model/mtl",
                                          "model/x-off",
                                          "model/ply",
                                          "model/stl",
                                          "model/gltf-binary",
                                          NULL};
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

/* --- headers --- */

static const api_told_header next_page = {"Link", "The next page, where there is one."};
static const api_told_header disposition = {"Content-Disposition", "A name for a file."};
static const api_told_header warnings = {"Export-Warnings", "What the format could not carry."};

/* --- the table --- */

static const api_route routes[] = {
    /* the collection */
    {.method = "GET",
     .path = "/v1/meshes",
     .name = "meshes_list",
     .run = api_meshes_list,
     .role = API_ROLE_READ,
     .reads = API_READS_CARD,
     .produces = json,
     .parameters = {&api_parameter_limit, &api_parameter_cursor},
     .headers = {&next_page},
     .statuses = {200},
     .response = "mesh_page",
     .summary = "List the meshes",
     .doc = "A page of ids, names, revisions and counts, in the order of ids."},
    {.method = "POST",
     .path = "/v1/meshes",
     .name = "meshes_create",
     .begin = api_meshes_create_begin,
     .body = api_meshes_create_body,
     .run = api_meshes_create,
     .role = API_ROLE_WRITE,
     .flags = API_WRITES | API_COSTLY | API_LONG | API_KEYED_NEW,
     .body_kind = API_BODY_UPLOAD,
     .consumes = mesh_in,
     .produces = json,
     .parameters = {&api_parameter_format, &api_parameter_name, &api_parameter_identity,
                    &api_parameter_repair, &api_parameter_tolerance, &api_parameter_hole_edges},
     .statuses = {201, 202, 409, 413, 415, 422},
     .request = "create",
     .response = "created",
     .summary = "Create a mesh",
     .doc = "From a mesh document, a shape, or a file. A file that refers to others, as a .gltf to "
            "its .bin and an OBJ file to its .mtl, comes with them as multipart/form-data, each "
            "under the name by which it is referred to. A surface that is no mesh is refused; the "
            "problem names each offending "
            "element, and the repairs that would let it pass."},

    /* one mesh */
    {.method = "GET",
     .path = "/v1/meshes/{mesh}",
     .name = "mesh_get",
     .run = api_summary_get,
     .role = API_ROLE_READ,
     .reads = API_READS_VIEW,
     .cost = api_summary_cost,
     .tag = "summary",
     .flags = API_EXPENSIVE | API_LONG,
     .produces = json,
     .parameters = {&api_parameter_revision},
     .statuses = {200, 202, 304, 410},
     .response = "summary",
     .summary = "Summary of a mesh",
     .doc = "Counts, topology and measures of the present revision, or of the one that is named."},
    {.method = "PATCH",
     .path = "/v1/meshes/{mesh}",
     .name = "mesh_patch",
     .run = api_mesh_patch,
     .role = API_ROLE_WRITE,
     .flags = API_WRITES | API_KEYED,
     .body_kind = API_BODY_CONTROL,
     .consumes = merge_patch,
     .produces = json,
     .statuses = {200, 204, 409, 412, 413, 415, 422},
     .request = "mesh_patch",
     .response = "summary",
     .summary = "Change the name",
     .doc = "A JSON merge patch (RFC 7396) of the mesh's own members; the content and its revision "
            "stay."},
    {.method = "PUT",
     .path = "/v1/meshes/{mesh}",
     .name = "mesh_put",
     .begin = api_mesh_put_begin,
     .body = api_mesh_put_body,
     .run = api_mesh_put,
     .role = API_ROLE_WRITE,
     .flags = API_WRITES | API_COSTLY | API_LONG | API_MAY_CREATE,
     .body_kind = API_BODY_UPLOAD,
     .consumes = mesh_in,
     .produces = json,
     .parameters = {&api_parameter_format, &api_parameter_name, &api_parameter_repair,
                    &api_parameter_tolerance, &api_parameter_hole_edges},
     .statuses = {200, 201, 202, 204, 409, 412, 413, 415, 422},
     .request = "create",
     .response = "created",
     .summary = "Replace a mesh, or create it under this id",
     .doc = "The body is that of a create. Replacing makes a new revision and ends the undo stack. "
            "With If-None-Match: * an existing mesh is 412."},
    {.method = "DELETE",
     .path = "/v1/meshes/{mesh}",
     .name = "mesh_delete",
     .run = api_mesh_delete,
     .role = API_ROLE_WRITE,
     .reads = API_READS_CARD,
     .flags = API_WRITES | API_INTERRUPTS,
     .produces = json,
     .statuses = {204, 412},
     .summary = "Delete a mesh",
     .doc = "Its id may be used again; entity tags and event ids do not repeat."},
    {.method = "GET",
     .path = "/v1/meshes/{mesh}/content",
     .name = "content_get",
     .run = api_content_get,
     .role = API_ROLE_READ,
     .reads = API_READS_SNAPSHOT,
     .cost = api_content_cost,
     .flags = API_EXPENSIVE | API_OWN_ACCEPT | API_LONG,
     .produces = mesh_out,
     .parameters = {&api_parameter_revision, &api_parameter_format_out, &api_parameter_encoding,
                    &api_parameter_compress},
     .headers = {&warnings},
     .statuses = {200, 202, 304, 410, 422},
     .response = "document",
     .summary = "Export a mesh",
     .doc =
         "In the format that `format` or Accept asks for. What the format cannot carry is named "
         "in the header Export-Warnings, at most 1000 bytes, the rest as \"and 3 more\". A "
         "position beyond the range of floats is refused by glb and binary stl. A mesh holds "
         "texture coordinates `uv` with v upward, as OBJ, PLY and OFF do (glTF's runs down), and "
         "colours `color` of 0 to 1, which are bytes "
         "in PLY; reading and writing convert both. A file is sent at once however large the mesh "
         "is, unless a job is preferred: for each million faces a thread works about a second "
         "before the first byte of STL, half of that before one of GLB, and little before others; "
         "what takes longer than the server's limit for reads is 503 `read_timeout`."},
    {.method = "GET",
     .path = "/v1/meshes/{mesh}/geometry",
     .name = "geometry_get",
     .run = api_geometry_get,
     .role = API_ROLE_READ,
     .reads = API_READS_LOCKED,
     .cost = api_geometry_cost,
     .flags = API_EXPENSIVE | API_LONG,
     .produces = octets,
     .parameters = {&api_parameter_drawn, &api_parameter_layout},
     .statuses = {200, 202, 304},
     .summary = "Arrays to draw a mesh from",
     .doc =
         "Little-endian: a header of 96 bytes (\"HEDG\", u32 version 2, u64 revision, u64 base, "
         "u64 bytes of vertices, u64 bytes of triangles, u32 vertices, u32 triangles, f64 x 3 "
         "origin, f64 scale, u64 layout, u32 rows of vertices and u32 of triangles in this "
         "answer); then for each vertex id f32 x 4, (position - origin) * scale and 0 dead, 1 "
         "used or 2 isolated; then for each slot u32 x 4, three vertices and the face's id with "
         "bits 29 to 31 for the sides that are edges of the face, or four zeros where the slot "
         "is free. With `since` and `layout` of an answer before, the rows that changed: of the "
         "vertices, then of the triangles, u32 places, zeros up to a multiple of 16 bytes, and "
         "the rows for them. The arrays are first grown with zeros to the vertices and triangles "
         "of the header. A base of 0 says that all rows are there and the arrays begin afresh: "
         "the server may answer so at any time, and does where the layout is another."},
    {.method = "GET",
     .path = "/v1/meshes/{mesh}/progressive",
     .name = "progressive_get",
     .run = api_progressive_get,
     .role = API_ROLE_READ,
     .reads = API_READS_SNAPSHOT,
     .cost = api_progressive_cost,
     .flags = API_EXPENSIVE | API_LONG,
     .produces = octets,
     .parameters = {&api_parameter_revision, &api_parameter_base_faces, &api_parameter_most_error,
                    &api_parameter_boundary_weight, &api_parameter_most_splits},
     .statuses = {200, 202, 304, 410, 422},
     .summary = "A mesh from coarse to fine",
     .doc =
         "The mesh decimated, and the vertex splits that lead back to it with all ids: any number "
         "of them leaves a mesh. Of the revision before a decimate, and with the same faces, "
         "max_error and boundary_weight, it is the record of that edit: the base is the mesh that "
         "the edit made. Little-endian: \"HEDP\", u32 version 1, u64 revision, u32 "
         "vertices, edges and faces of the base, splits here, splits there are, 0, ids issued of "
         "vertices, edges and faces, 0, f64 x 3 least and largest coordinates; vertices (u32 id, "
         "0, f64 x 3), edges (u32 id, origin, target, 0), faces (u32 id, three corners); then "
         "splits: u32 bytes, new vertex u, the vertex v it leaves, left and right corner, "
         "half-edges from u to those three, left face (u, v, left), right face (v, u, right), "
         "number of faces in which u takes the place of v, 0, f64 x 3 places of u and of v, u32 "
         "those faces, up to a multiple of 8 bytes. 2^32 - 1 is none."},
    {.method = "POST",
     .path = "/v1/meshes/{mesh}/copy",
     .name = "mesh_copy",
     .run = api_mesh_copy,
     .role = API_ROLE_WRITE,
     .reads = API_READS_SNAPSHOT,
     .cost = api_mesh_copy_cost,
     .flags = API_WRITES | API_LONG | API_KEYED_NEW,
     .body_kind = API_BODY_OPTION,
     .consumes = json,
     .produces = json,
     .parameters = {&api_parameter_revision},
     .statuses = {201, 202, 409, 410, 412, 413, 415, 422},
     .request = "copy",
     .response = "summary",
     .summary = "Copy a mesh",
     .doc = "An independent mesh with the same ids and attributes and a history of its own; of an "
            "earlier revision where one is named."},

    /* its elements: a collection, an element and what is adjacent to it, for each kind */
    ELEMENTS(HE_VERTEX, "vertex", "vertices", "vertices"),
    ELEMENTS(HE_HALFEDGE, "halfedge", "halfedges", "half-edges"),
    ELEMENTS(HE_EDGE, "edge", "edges", "edges"),
    ELEMENTS(HE_FACE, "face", "faces", "faces"),
    ELEMENT(HE_VERTEX, "vertex", "vertices",
            "One vertex: its position, a half-edge that leaves it, its degree."),
    ELEMENT(HE_HALFEDGE, "halfedge", "halfedges",
            "One half-edge: its twin, next, prev, origin, target, edge and face."),
    ELEMENT(HE_EDGE, "edge", "edges", "One edge: its half-edges, ends, faces and length."),
    ELEMENT(HE_FACE, "face", "faces",
            "One face: its corners, half-edges, area, normal and centroid."),
    ADJACENCY(HE_VERTEX, "vertex", "vertices", "vertices", "Neighbours of a vertex",
              "The vertices at the other ends of its edges. " AROUND),
    ADJACENCY(HE_VERTEX, "vertex", "vertices", "outgoing", "Half-edges that leave a vertex",
              "Those that have it as their origin. " AROUND),
    ADJACENCY(HE_VERTEX, "vertex", "vertices", "incoming", "Half-edges that arrive at a vertex",
              "The twins of those that leave it, in their order. " AROUND),
    ADJACENCY(HE_VERTEX, "vertex", "vertices", "edges", "Edges of a vertex",
              "Those that end at it. " AROUND),
    ADJACENCY(HE_VERTEX, "vertex", "vertices", "faces", "Faces around a vertex",
              "Those left of the half-edges that leave it; holes are left out. " AROUND),
    ADJACENCY(HE_HALFEDGE, "halfedge", "halfedges", "loop", "The loop of a half-edge",
              "The half-edges around its face or hole, from itself by next."),
    ADJACENCY(HE_HALFEDGE, "halfedge", "halfedges", "ring", "The ring of a half-edge",
              "The half-edges that leave its origin, counter-clockwise from itself."),
    ADJACENCY(HE_EDGE, "edge", "edges", "vertices", "Ends of an edge",
              "Origin and target of its half-edge 2 * id."),
    ADJACENCY(HE_EDGE, "edge", "edges", "halfedges", "Half-edges of an edge",
              "2 * id and 2 * id + 1."),
    ADJACENCY(HE_EDGE, "edge", "edges", "faces", "Faces beside an edge",
              "Those left of its half-edges, each once; holes are left out."),
    ADJACENCY(HE_FACE, "face", "faces", "vertices", "Corners of a face",
              "The origins of its half-edges. " AROUND),
    ADJACENCY(HE_FACE, "face", "faces", "halfedges", "Half-edges of a face",
              "Those that have it on their left. " AROUND),
    ADJACENCY(HE_FACE, "face", "faces", "edges", "Edges of a face",
              "Those of its half-edges. " AROUND),
    ADJACENCY(HE_FACE, "face", "faces", "faces", "Faces beside a face",
              "Those across its edges; holes are left out. " AROUND),

    {.method = "GET",
     .path = "/v1/meshes/{mesh}/materials",
     .name = "materials_list",
     .run = api_materials_list,
     .role = API_ROLE_READ,
     .reads = API_READS_LOCKED,
     .produces = json,
     .parameters = {&api_parameter_revision},
     .statuses = {200, 304, 410},
     .response = "material_list",
     .summary = "List the materials",
     .doc = "A face names its material in the attribute `material`; the label \"\" is none. The "
            "operations `material_set` and `material_delete` change materials. Colours are linear, "
            "as in glTF; those of an OBJ file's library are taken and written as linear too, as "
            "Blender does."},

    /* attributes */
    {.method = "GET",
     .path = "/v1/meshes/{mesh}/attributes",
     .name = "attributes_list",
     .run = api_attributes_list,
     .role = API_ROLE_READ,
     .reads = API_READS_LOCKED,
     .produces = json,
     .parameters = {&api_parameter_revision},
     .statuses = {200, 304, 410},
     .response = "attribute_list",
     .summary = "List the attributes",
     .doc = "All of them, of every domain, without their values."},
    {.method = "GET",
     .path = "/v1/meshes/{mesh}/attributes/{domain}/{name}",
     .name = "attribute_get",
     .run = api_attribute_get,
     .role = API_ROLE_READ,
     .reads = API_READS_LOCKED,
     .cost = api_attribute_cost,
     .flags = API_EXPENSIVE | API_LONG,
     .produces = octets_too,
     .parameters = {&api_parameter_revision, &api_parameter_limit, &api_parameter_cursor,
                    &api_parameter_ids},
     .headers = {&next_page},
     .statuses = {200, 202, 304, 410},
     .response = "attribute_values",
     .summary = "Values of an attribute",
     .doc = "A page of live elements in the order of ids, or those that `ids` names. As octets: a "
            "row for each id ever issued, dead ones hold the default; bool is one byte, the other "
            "types are 4 or 8, little-endian, without gaps."},
    {.method = "PUT",
     .path = "/v1/meshes/{mesh}/attributes/{domain}/{name}",
     .name = "attribute_put",
     .begin = api_attribute_put_begin,
     .body = api_attribute_put_body,
     .run = api_attribute_put,
     .role = API_ROLE_WRITE,
     .flags = API_WRITES | API_COSTLY | API_REHEARSED,
     .body_kind = API_BODY_UPLOAD,
     .consumes = octets_too,
     .produces = json,
     .parameters = {&api_parameter_type, &api_parameter_components, &api_parameter_rule,
                    &api_parameter_dry_run},
     .statuses = {200, 201, 204, 409, 412, 413, 415, 422},
     .request = "attribute",
     .response = "attribute_written",
     .summary = "Create an attribute, or replace it",
     .doc = "As a whole, with the values of all elements, one for all, or the default. As octets: "
            "rows as GET gives them, described by the query; what they say of dead elements is not "
            "looked at. One revision, which can be undone."},
    {.method = "PATCH",
     .path = "/v1/meshes/{mesh}/attributes/{domain}/{name}",
     .name = "attribute_patch",
     .run = api_attribute_patch,
     .role = API_ROLE_WRITE,
     .flags = API_WRITES | API_COSTLY | API_KEYED | API_REHEARSED,
     .body_kind = API_BODY_EDITS,
     .consumes = json,
     .produces = json,
     .statuses = {200, 204, 409, 412, 413, 415, 422},
     .request = "attribute_patch",
     .response = "attribute_written",
     .summary = "Write values by ids",
     .doc = "A value for each id, or one for all. One revision, which can be undone; none where "
            "nothing changes."},
    {.method = "DELETE",
     .path = "/v1/meshes/{mesh}/attributes/{domain}/{name}",
     .name = "attribute_delete",
     .run = api_attribute_delete,
     .role = API_ROLE_WRITE,
     .flags = API_WRITES | API_REHEARSED,
     .produces = json,
     .parameters = {&api_parameter_dry_run},
     .statuses = {200, 204, 409, 412},
     .response = "attribute_written",
     .summary = "Delete an attribute",
     .doc = "One revision, which can be undone."},

    /* questions */
    {.method = "POST",
     .path = "/v1/meshes/{mesh}/query",
     .name = "query_post",
     .run = api_query_post,
     .role = API_ROLE_READ,
     .reads = API_READS_VIEW,
     .cost = api_query_cost,
     .flags = API_LONG,
     .body_kind = API_BODY_CONTROL,
     .consumes = json,
     .produces = octets_too,
     .parameters = {&api_parameter_revision},
     .statuses = {200, 202, 410, 413, 415, 422},
     .request = "query",
     .response = "query_results",
     .summary = "Ask many questions at once",
     .doc =
         "Adjacency, walks, elements, half-edges between vertices, measures, rays, nearest points "
         "and self-intersections, all of one revision. One question about many elements may be "
         "answered as octets: of a relation n + 1 offsets and the ids as 32-bit integers, of a "
         "measure doubles, NaN for null; all little-endian. What is asked about all of a mesh and "
         "would take more than a second becomes a job where the client does not wait: the first "
         "ray or nearest point of 580,000 quads, self-intersections of 340,000, relations and "
         "measures of all of some million."},
    {.method = "POST",
     .path = "/v1/meshes/{mesh}/traverse",
     .name = "traverse_post",
     .run = api_traverse_post,
     .role = API_ROLE_READ,
     .reads = API_READS_VIEW,
     .cost = api_traverse_cost,
     .flags = API_LONG,
     .body_kind = API_BODY_CONTROL,
     .consumes = json,
     .produces = json,
     .parameters = {&api_parameter_revision},
     .statuses = {200, 202, 410, 413, 415, 422},
     .request = "walk",
     .response = "walked",
     .summary = "Walk over a mesh",
     .doc = "Paths of next, prev and twin, loops, rings, breadth-first and shortest paths. "
            "Where the client does not wait, a walk that meets 4 million elements becomes a job, "
            "and so does a shortest path on a mesh of 2 million quads."},
    {.method = "GET",
     .path = "/v1/meshes/{mesh}/boundaries",
     .name = "boundaries_get",
     .run = api_boundaries_get,
     .role = API_ROLE_READ,
     .reads = API_READS_VIEW,
     .cost = api_cost_of_mesh,
     .tag = "boundaries",
     .flags = API_EXPENSIVE | API_LONG,
     .produces = json,
     .parameters = {&api_parameter_revision},
     .statuses = {200, 202, 304, 410},
     .response = "boundaries",
     .summary = "Boundary loops",
     .doc = "Each boundary half-edge is in one loop."},
    {.method = "GET",
     .path = "/v1/meshes/{mesh}/components",
     .name = "components_get",
     .run = api_components_get,
     .role = API_ROLE_READ,
     .reads = API_READS_VIEW,
     .cost = api_cost_of_mesh,
     .tag = "components",
     .flags = API_EXPENSIVE | API_LONG,
     .produces = json,
     .parameters = {&api_parameter_revision, &api_parameter_by},
     .statuses = {200, 202, 304, 410},
     .response = "components",
     .summary = "Connected components",
     .doc = "Isolated vertices are left out."},
    {.method = "GET",
     .path = "/v1/meshes/{mesh}/check",
     .name = "check_get",
     .run = api_check_get,
     .role = API_ROLE_READ,
     .reads = API_READS_VIEW,
     .cost = api_check_cost,
     .tag = "check",
     .flags = API_EXPENSIVE | API_LONG,
     .produces = json,
     .parameters = {&api_parameter_revision, &api_parameter_meets, &api_parameter_merge,
                    &api_parameter_flat, &api_parameter_small},
     .statuses = {200, 202, 304, 410, 413},
     .response = "check",
     .summary = "Check a mesh",
     .doc =
         "Every broken invariant by its number, and every defect a valid mesh may have: vertices "
         "of several fans, without an edge or in one place with another, edges without length, "
         "faces that have no area or are not flat, components that are small or inside out. A "
         "component is inside out when it is closed and its volume negative: one that bounds a "
         "hollow within another is listed too, though that is as it should be, and a component "
         "more than about 1e107 times smaller than the mesh's largest coordinate never is. Of each "
         "the first "
         "are listed and all counted."},

    /* edits */
    {.method = "POST",
     .path = "/v1/meshes/{mesh}/edits",
     .name = "edits_post",
     .run = api_edits_post,
     .role = API_ROLE_WRITE,
     .flags = API_WRITES | API_LONG | API_KEYED | API_REHEARSED,
     .body_kind = API_BODY_EDITS,
     .consumes = json,
     .produces = json,
     .statuses = {200, 202, 204, 409, 412, 413, 415, 422},
     .request = "edit",
     .response = "edited",
     .summary = "Edit a mesh",
     .doc = "One operation, or a list that is applied as a whole or not at all: one revision and "
            "one undo step."},
    {.method = "GET",
     .path = "/v1/meshes/{mesh}/edits",
     .name = "edits_list",
     .run = api_edits_list,
     .role = API_ROLE_READ,
     .reads = API_READS_LOCKED,
     .produces = json,
     .parameters = {&api_parameter_limit, &api_parameter_cursor, &api_parameter_since},
     .headers = {&next_page},
     .statuses = {200, 304, 410},
     .response = "history",
     .summary = "History of a mesh",
     .doc =
         "What each revision did, newest first. `oldest` can still be read; `dropped` entries were "
         "dropped to keep within the undo budget, of revisions that may still be on the disk. The "
         "steps to undo that were taken first go with them; what was undone can be done again "
         "until the next "
         "edit, however full the history is."},
    {.method = "POST",
     .path = "/v1/meshes/{mesh}/undo",
     .name = "undo_post",
     .run = api_undo_post,
     .role = API_ROLE_WRITE,
     .flags = API_WRITES | API_KEYED,
     .body_kind = API_BODY_OPTION,
     .consumes = json,
     .produces = json,
     .statuses = {200, 204, 409, 410, 412, 413, 415, 422},
     .request = "step",
     .response = "edited",
     .summary = "Undo the last edit",
     .doc =
         "The last edit, the last `steps`, or all that were done since revision `to_revision`: at "
         "once, each as a new revision, or not at all. The sets are what all of it comes to."},
    {.method = "POST",
     .path = "/v1/meshes/{mesh}/redo",
     .name = "redo_post",
     .run = api_redo_post,
     .role = API_ROLE_WRITE,
     .flags = API_WRITES | API_KEYED,
     .body_kind = API_BODY_OPTION,
     .consumes = json,
     .produces = json,
     .statuses = {200, 204, 409, 410, 412, 413, 415, 422},
     .request = "step",
     .response = "edited",
     .summary = "Do again what was undone",
     .doc =
         "What was undone last, the last `steps`, or as far as revision `to_revision` was: each as "
         "a new revision, with the ids it had."},

    {.method = "GET",
     .path = "/v1/meshes/{mesh}/events",
     .name = "events_get",
     .run = api_events_get,
     .role = API_ROLE_READ,
     .reads = API_READS_CARD,
     .produces = event_stream,
     .parameters = {&api_parameter_last_seen},
     .statuses = {200},
     .summary = "Every change as it happens",
     .doc = "Server-Sent Events: `edit` holds a revision as a delta, exact enough to keep a copy "
            "link for link; `metadata` a new name; `job` that one of this mesh has begun or ended; "
            "`resync` says to fetch the mesh anew, `bye` that the stream ends. Last-Event-ID or "
            "`since` goes on where a client was cut off, "
            "or gives one `resync` where the history does not reach."},

    /* jobs */
    {.method = "GET",
     .path = "/v1/jobs",
     .name = "jobs_list",
     .run = api_jobs_list,
     .role = API_ROLE_READ,
     .produces = json,
     .parameters = {&api_parameter_limit, &api_parameter_cursor},
     .headers = {&next_page},
     .statuses = {200},
     .response = "job_page",
     .summary = "List the jobs",
     .doc = "A page in the order of their submission, without results and problems."},
    {.method = "GET",
     .path = "/v1/jobs/{job}",
     .name = "job_get",
     .run = api_job_get,
     .role = API_ROLE_READ,
     .produces = json,
     .statuses = {200},
     .response = "job",
     .summary = "How far a job is",
     .doc =
         "With what the request would have been answered with, once it has ended: its result or "
         "problem. What is no JSON, or a whole mesh, is fetched by `result_link`. A job that has "
         "ended is kept for an hour, if there is room, also when the server is started again: then "
         "without an answer of more than 64 KiB, and one that had not ended has failed, with the "
         "problem `interrupted`: nothing of it was done."},
    {.method = "GET",
     .path = "/v1/jobs/{job}/result",
     .name = "job_result",
     .run = api_job_result,
     .role = API_ROLE_READ,
     .flags = API_OWN_ACCEPT | API_TAG_OF_OTHERS,
     .produces = job_results,
     .headers = {&disposition, &warnings},
     .statuses = {200, 202, 304},
     .response = "job_result",
     .summary = "The answer of a job by itself",
     .doc = "The body that the request would have been answered with, and its type: `result_link` "
            "of the job leads here. Files, octets and lines are fetched here alone. 202 with the "
            "job until it has ended, 404 where it failed or has no body."},
    {.method = "GET",
     .path = "/v1/jobs/{job}/events",
     .name = "job_events",
     .run = api_job_events,
     .role = API_ROLE_READ,
     .produces = event_stream,
     .statuses = {200},
     .summary = "How a job goes on",
     .doc = "Server-Sent Events: `job` holds the job whenever it has come further, the last with "
            "its result or problem where that is small; `bye` says that the stream ends."},
    {.method = "DELETE",
     .path = "/v1/jobs/{job}",
     .name = "job_delete",
     .run = api_job_delete,
     .role = API_ROLE_READ,
     .produces = json,
     .statuses = {202, 204},
     .response = "job",
     .summary = "Cancel or forget a job",
     .doc = "One that waits or runs is told to end (202): what it had changed is undone and its "
            "memory given back. One that has ended is forgotten (204)."},

    /* tokens */
    {.method = "GET",
     .path = "/v1/token",
     .name = "token_get",
     .run = api_token_get,
     .role = API_ROLE_READ,
     .flags = API_STORELESS,
     .produces = json,
     .statuses = {200},
     .response = "token",
     .summary = "Who one is",
     .doc = "What the token of the request may do. Where the server asks for no tokens the name is "
            "null and the role admin."},
    {.method = "POST",
     .path = "/v1/admin/reload",
     .name = "reload_post",
     .run = api_admin_reload,
     .role = API_ROLE_ADMIN,
     .flags = API_STORELESS,
     .produces = json,
     .statuses = {200, 409},
     .response = "reloaded",
     .summary = "Read the file of tokens again",
     .doc = "As SIGHUP does. A token that is not in it any more is refused from now on, and its "
            "event streams end with `bye`. Where the file is wrong what was in force stays, and "
            "the refusal names the line."},

    /* the tables */
    {.method = "GET",
     .path = "/v1/operations",
     .name = "operations_get",
     .run = api_operations_get,
     .role = API_ROLE_OPEN,
     .flags = API_STORELESS,
     .produces = json,
     .statuses = {200},
     .response = "operations",
     .summary = "The operation table",
     .doc = "Every operation with its parameters, results, refusals and its change in V, E and F."},
    {.method = "GET",
     .path = "/v1/openapi.json",
     .name = "openapi_get",
     .run = api_openapi_get,
     .role = API_ROLE_OPEN,
     .flags = API_STORELESS,
     .produces = json,
     .statuses = {200},
     .response = "description",
     .summary = "This document",
     .doc = "The API as OpenAPI 3.1."},

    /* beside the API */
    {.method = "GET",
     .path = "/livez",
     .name = "live_get",
     .run = api_live_get,
     .role = API_ROLE_OPEN,
     .flags = API_FIXED,
     .produces = json,
     .statuses = {200},
     .response = "health",
     .summary = "Is the process alive?",
     .doc = "It answers, whatever else is wrong."},
    {.method = "GET",
     .path = "/readyz",
     .name = "ready_get",
     .run = api_ready_get,
     .role = API_ROLE_OPEN,
     .flags = API_FIXED,
     .produces = json,
     .statuses = {200},
     .response = "readiness",
     .summary = "Does the server take requests?",
     .doc = "503 `not_ready` while it starts and stops, and 503 `store_failed` when a write or a "
            "sync of the disk failed: then no change is taken until it is started again. A full "
            "disk is no reason to take it out of service, for reads go on and meshes can be "
            "deleted: `\"store\": \"full\"` with 200, until there is space again."},
    {.method = "GET",
     .path = "/version",
     .name = "version_get",
     .run = api_version_get,
     .role = API_ROLE_OPEN,
     .flags = API_FIXED,
     .produces = json,
     .statuses = {200},
     .response = "version",
     .summary = "Version of the server",
     .doc = "Its name, and its version as in \"info\" of this document."},
    {.method = "GET",
     .path = "/problems/{code}",
     .name = "problem_get",
     .run = api_problem_get,
     .role = API_ROLE_OPEN,
     .flags = API_FIXED,
     .produces = html,
     .statuses = {200},
     .summary = "What a problem means",
     .doc = "Where `type` of a problem leads: a page about its code."},
    {.method = "GET",
     .path = "/",
     .name = "page_get",
     .run = api_page_get,
     .role = API_ROLE_OPEN,
     .flags = API_FIXED,
     .produces = html,
     .statuses = {200, 304},
     .summary = "The viewer",
     .doc = "A page to look at meshes, to edit them and to see what they are made of."},
    {.method = "GET",
     .path = "/docs",
     .name = "docs_get",
     .run = api_page_get,
     .role = API_ROLE_OPEN,
     .flags = API_FIXED,
     .produces = html,
     .statuses = {200, 304},
     .summary = "The manual of the API",
     .doc = "This document as a page."},
    {.method = "GET",
     .path = "/assets/{asset}",
     .name = "asset_get",
     .run = api_page_get,
     .role = API_ROLE_OPEN,
     .flags = API_FIXED | API_OWN_ACCEPT,
     .produces = anything,
     .statuses = {200, 304},
     .summary = "Files of the viewer",
     .doc = "Scripts and styles of the two pages."},
};

api_route_table api_routes(void)
{
    return (api_route_table){routes, sizeof routes / sizeof routes[0]};
}

const int *api_route_common(void)
{
    static const int common[] = {400, 403, 404, 405, 406, 408, 414, 421,
                                 431, 500, 501, 503, 505, 507, 0};
    return common;
}
