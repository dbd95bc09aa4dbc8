#include "api/describe/routes.h"

#include "api/describe/attribute_rows.h"
#include "api/describe/element_rows.h"
#include "api/describe/live_rows.h"
#include "api/describe/media_types.h"
#include "api/describe/parameters.h"
#include "api/document/summary.h"
#include "api/request/handlers.h"
#include "api/request/mesh_access.h"

/* --- response headers of single routes --- */

static const api_told_header next_page = {"Link", "A link to the next page, if there is one."};
static const api_told_header disposition = {"Content-Disposition",
                                            "The name under which a client should save the file."};
static const api_told_header ranges = {"Accept-Ranges",
                                       "`none`: the server ignores the request header Range, "
                                       "because it generates a file while it sends it."};
static const api_told_header warnings = {
    "Export-Warnings", "What the file does not contain because its format cannot hold it."};

/* --- the table of routes --- */

static const api_route routes[] = {
    /* the collection of meshes */
    {.method = "GET",
     .path = "/v1/meshes",
     .name = "list_meshes",
     .run = api_meshes_list,
     .role = API_ROLE_READ,
     .reads = API_READS_CARD,
     .produces = json,
     .parameters = {&api_parameter_limit, &api_parameter_cursor, &api_parameter_sort,
                    &api_parameter_contains},
     .headers = {&next_page},
     .statuses = {200},
     .response = "mesh_page",
     .summary = "List the meshes",
     .doc = "A page of meshes in the order of their ids, or in the order that the parameter `sort` "
            "gives: the id, name, revision and counts of each. While a client reads one page after "
            "another, a mesh that keeps its place in the order is listed exactly once, whatever "
            "else changes; a mesh whose name, time or size changes may be listed twice or not at "
            "all. A cursor belongs to the order of its list: with another `sort` it is refused."},
    {.method = "POST",
     .path = "/v1/meshes",
     .name = "create_mesh",
     .begin = api_meshes_create_begin,
     .body = api_meshes_create_body,
     .run = api_meshes_create,
     .role = API_ROLE_WRITE,
     .flags = API_WRITES | API_COSTLY | API_LONG | API_IDEMPOTENCY_KEY_NEW,
     .body_kind = API_BODY_UPLOAD,
     .consumes = mesh_in,
     .produces = json,
     .parameters = {&api_parameter_format, &api_parameter_name, &api_parameter_identity,
                    &api_parameter_repair, &api_parameter_tolerance, &api_parameter_hole_edges},
     .statuses = {201, 202, 409, 413, 415, 422},
     .request = "create",
     .response = "created",
     .summary = "Create a mesh",
     .doc = "The body is a mesh document, the name of a shape, or a file. A file that refers to "
            "others (a .gltf to its .bin, an OBJ file to its .mtl) is sent together with them as "
            "multipart/form-data, each with the file name by which it is referred to. A surface "
            "that is not a valid mesh is answered with a problem that lists each wrong element, "
            "and the repairs that would make it valid."},

    /* one mesh */
    {.method = "GET",
     .path = "/v1/meshes/{mesh}",
     .name = "get_mesh",
     .run = api_summary_get,
     .cold = api_summary_cold,
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
     .doc = "Counts, topology and measures of the mesh at its present revision, or at the revision "
            "that the parameter `revision` gives."},
    {.method = "PATCH",
     .path = "/v1/meshes/{mesh}",
     .name = "update_mesh",
     .run = api_mesh_patch,
     .reads = API_READS_CARD,
     .role = API_ROLE_WRITE,
     .flags = API_WRITES | API_IDEMPOTENCY_KEY,
     .body_kind = API_BODY_CONTROL,
     .consumes = merge_patch,
     .produces = json,
     .statuses = {200, 204, 409, 412, 413, 415, 422},
     .request = "mesh_patch",
     .response = "summary",
     .summary = "Change the name",
     .doc = "A JSON merge patch (RFC 7396) of the mesh's name. The content and its revision do not "
            "change."},
    {.method = "PUT",
     .path = "/v1/meshes/{mesh}",
     .name = "replace_mesh",
     .begin = api_mesh_put_begin,
     .begin_reads = API_READS_CARD,
     .body = api_mesh_put_body,
     .run = api_mesh_put,
     .reads = API_READS_BEFORE,
     .cost = api_cost_of_mesh,
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
     .doc = "The body has the same forms as in a request that creates a mesh. Replacing a mesh "
            "makes a new revision and clears the undo history. If the mesh exists and the request "
            "has If-None-Match: *, the answer is 412."},
    {.method = "DELETE",
     .path = "/v1/meshes/{mesh}",
     .name = "delete_mesh",
     .run = api_mesh_delete,
     .cold = api_mesh_delete_cold,
     .role = API_ROLE_WRITE,
     .reads = API_READS_CARD,
     .flags = API_WRITES | API_INTERRUPTS,
     .produces = json,
     .statuses = {204, 412},
     .summary = "Delete a mesh",
     .doc = "The id of the deleted mesh may be used again for another mesh; ETags and event ids "
            "are never repeated."},
    {.method = "GET",
     .path = "/v1/meshes/{mesh}/content",
     .name = "export_mesh",
     .run = api_content_get,
     .role = API_ROLE_READ,
     .reads = API_READS_SNAPSHOT,
     .cost = api_content_cost,
     .flags = API_EXPENSIVE | API_OWN_ACCEPT | API_LONG,
     .produces = mesh_out,
     .parameters = {&api_parameter_revision, &api_parameter_format_out, &api_parameter_encoding,
                    &api_parameter_compress},
     .headers = {&warnings, &ranges},
     .statuses = {200, 202, 304, 410, 422},
     .response = "document",
     .summary = "Export a mesh",
     .doc =
         "The file has the format that `format` or Accept names. What the format cannot hold is "
         "listed in the header Export-Warnings, in at most 2000 bytes; the rest is counted, as in "
         "\"and 3 more\". A position too large for a float is an error for glb and binary stl. A "
         "mesh holds texture coordinates `uv` with v upward, as OBJ, PLY and OFF do (in glTF v "
         "runs down), and colours `color` from 0 to 1, which are bytes in PLY; reading and writing "
         "convert both. A file is sent directly however large the mesh is, unless the client "
         "prefers a job. Before the first byte is sent, the server needs about a second for each "
         "million faces in STL, half a second in GLB, and little time in other formats; a request "
         "that takes longer than the server's limit for reads is answered 503 `read_timeout`."},
    {.method = "GET",
     .path = "/v1/meshes/{mesh}/geometry",
     .name = "get_geometry",
     .run = api_geometry_get,
     .role = API_ROLE_READ,
     .reads = API_READS_LOCKED,
     .cost = api_geometry_cost,
     .flags = API_EXPENSIVE | API_LONG,
     .produces = octets,
     .parameters = {&api_parameter_revision, &api_parameter_drawn, &api_parameter_layout},
     .statuses = {200, 202, 304, 410},
     .summary = "Arrays for drawing a mesh",
     .doc =
         "Little-endian. First a header of 96 bytes: \"HEDG\", u32 version 2, u64 revision, u64 "
         "base, u64 bytes of vertices, u64 bytes of triangles, u32 vertices, u32 triangles, f64 x "
         "3 origin, f64 scale, u64 layout, u32 number of vertex rows and u32 number of triangle "
         "rows in this answer. Then a row for each vertex id: f32 x 3, (position - origin) * "
         "scale, and an f32 that is 0 for a deleted, 1 for a used and 2 for an isolated vertex. "
         "Then the rows of triangles: u32 x 4, three vertices and the id of the face, in which "
         "bits 29 to 31 mark the sides of the triangle that are edges of the face; a row of four "
         "zeros is unused. With `since` and `layout` from an earlier answer, only changed rows are "
         "sent. They are sent in two groups, vertices and then triangles; a group is u32 row "
         "numbers, zeros up to a multiple of 16 bytes, and the rows. The client first extends its "
         "arrays with zeros to the numbers of vertices and triangles in the header. A base of 0 "
         "means that all rows are sent and replace the client's arrays: the server may answer so "
         "at any time, and does if the layout has changed. The arrays of an earlier `revision` are "
         "sent as a whole."},
    {.method = "GET",
     .path = "/v1/meshes/{mesh}/progressive",
     .name = "get_progressive_mesh",
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
     .doc = "A decimated mesh, the base, and the vertex splits that lead from it back to the whole "
            "mesh with all ids; after any number of splits the mesh is valid. For the revision "
            "before an edit decimate, with the same faces, max_error and boundary_weight, the base "
            "is the mesh that the edit made. Little-endian. First a header: \"HEDP\", u32 version "
            "1, u64 revision, u32 vertices, edges and faces of the base, splits in this answer, "
            "splits in all, 0, ids issued of vertices, edges and faces, 0, f64 x 3 smallest and "
            "f64 x 3 largest coordinates. Then the base: vertices (u32 id, 0, f64 x 3 position), "
            "edges (u32 id, origin, target, 0), faces (u32 id, three corners). Then the splits, "
            "each: u32 size in bytes, new vertex u, the vertex v that is split, left and right "
            "corner, the half-edges from u to v and to these corners, left face (u, v, left), "
            "right face (v, u, right), number of faces in which u replaces v, 0, f64 x 3 position "
            "of u, f64 x 3 position of v, u32 ids of the faces in which u replaces v, zeros up to "
            "a multiple of 8 bytes. 2^32 - 1 stands for none."},
    {.method = "POST",
     .path = "/v1/meshes/{mesh}/copy",
     .name = "copy_mesh",
     .run = api_mesh_copy,
     .role = API_ROLE_WRITE,
     .reads = API_READS_SNAPSHOT,
     .cost = api_mesh_copy_cost,
     .flags = API_WRITES | API_LONG | API_IDEMPOTENCY_KEY_NEW,
     .body_kind = API_BODY_OPTION,
     .consumes = json,
     .produces = json,
     .parameters = {&api_parameter_revision},
     .statuses = {201, 202, 409, 410, 412, 413, 415, 422},
     .request = "copy",
     .response = "summary",
     .summary = "Copy a mesh",
     .doc = "Makes an independent mesh with the same element ids and attributes and its own "
            "history. It is a copy of the present revision, or of the revision that the parameter "
            "`revision` gives."},

    /* --- elements of a mesh, for each kind: the list, one element, and its neighbours --- */
    ELEMENT_ROWS,

    {.method = "GET",
     .path = "/v1/meshes/{mesh}/materials",
     .name = "list_materials",
     .run = api_materials_list,
     .role = API_ROLE_READ,
     .reads = API_READS_LOCKED,
     .produces = json,
     .parameters = {&api_parameter_revision},
     .statuses = {200, 304, 410},
     .response = "material_list",
     .summary = "List the materials",
     .doc = "A face names its material in the attribute `material`; the label \"\" means that it "
            "has none. The operations `material_set` and `material_delete` change materials. "
            "Colours are linear, as in glTF. The colours in the material library of an OBJ file "
            "are read and written as linear values, too, as Blender does."},

    ATTRIBUTE_ROWS,

    /* queries */
    {.method = "POST",
     .path = "/v1/meshes/{mesh}/query",
     .name = "query_mesh",
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
         "Neighbours, walks, elements, half-edges between vertices, measures, rays, nearest points "
         "and self-intersections, all of the same revision. A single question about many elements "
         "can be answered as application/octet-stream: for a relation n + 1 offsets and the ids as "
         "32-bit integers, for a measure doubles with NaN for null, all little-endian. If the "
         "question is about all elements, their n ids and then n itself follow, as 32-bit "
         "integers. A question that would take more than a second becomes a job, unless the client "
         "waits. Examples are "
         "the first ray or nearest point on 580,000 quads, self-intersections of 340,000 quads, "
         "and relations and measures of all elements of a mesh with several million."},
    {.method = "POST",
     .path = "/v1/meshes/{mesh}/traverse",
     .name = "traverse_mesh",
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
     .doc = "Paths of next, prev and twin, loops, rings, breadth-first search and shortest paths. "
            "A walk that visits 4 million elements, or a shortest path on a mesh of 2 million "
            "quads, becomes a job, unless the client waits."},
    {.method = "GET",
     .path = "/v1/meshes/{mesh}/boundaries",
     .name = "list_boundaries",
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
     .summary = "List the boundary loops",
     .doc = "Each boundary half-edge is in one loop."},
    {.method = "GET",
     .path = "/v1/meshes/{mesh}/components",
     .name = "list_components",
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
     .summary = "List the connected components",
     .doc =
         "The components are listed with their counts. Isolated vertices belong to no component."},
    {.method = "POST",
     .path = "/v1/meshes/{mesh}/compare",
     .name = "compare_mesh",
     .decode = api_compare_decode,
     .run = api_compare_post,
     .role = API_ROLE_READ,
     .reads = API_READS_SNAPSHOT,
     .cost = api_compare_cost,
     .flags = API_EXPENSIVE | API_LONG,
     .body_kind = API_BODY_CONTROL,
     .consumes = json,
     .produces = json,
     .parameters = {&api_parameter_revision},
     .statuses = {200, 202, 410, 413, 415, 422},
     .request = "compare",
     .response = "comparison",
     .summary = "How far two meshes are apart",
     .doc =
         "The Hausdorff distance between the surfaces of this mesh and of another mesh, or of an "
         "earlier revision of this mesh: what did a decimation cost? The answer has a lower and "
         "an upper bound for each direction, the place where the distance is largest, means and "
         "histograms. The bounds hold for all points of the surfaces, not only for samples. A "
         "comparison that would take more than a second becomes a job, unless the client "
         "waits."},
    {.method = "GET",
     .path = "/v1/meshes/{mesh}/check",
     .name = "check_mesh",
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
         "Every broken invariant by its number, and every defect that a valid mesh may have: "
         "vertices that have several fans, have no edge or share a position with another vertex; "
         "edges without length; faces that have no area or are not flat; components that are small "
         "or inside out. A component is inside out if it is closed and its volume is negative: the "
         "wall of a hollow inside another component is listed too, although it is correct, and a "
         "component more than about 1e107 times smaller than the mesh's largest coordinate is "
         "never listed. All defects are counted, and the first 100 of each kind are listed."},

    {.method = "POST",
     .path = "/v1/meshes/{mesh}/deform",
     .name = "preview_deform",
     .decode = api_deform_decode,
     .run = api_deform_post,
     .role = API_ROLE_READ,
     .reads = API_READS_VIEW,
     .cost = api_deform_cost,
     .flags = API_LONG,
     .body_kind = API_BODY_CONTROL,
     .consumes = json,
     .produces = octets,
     .statuses = {200, 202, 413, 415, 422},
     .request = "op_deform",
     .summary = "Preview a deformation",
     .doc = "Computes what the operation `deform` would do, and changes nothing. With n handles "
            "and following vertices, the answer has 28 n bytes, little-endian: three doubles for "
            "the position of each, and then their ids as 32-bit integers. The system of equations "
            "is kept, so a request with other goals for the same handles and fixed vertices of the "
            "same revision takes a fraction of the time."},

    /* edits */
    {.method = "POST",
     .path = "/v1/meshes/{mesh}/edits",
     .name = "apply_edits",
     .decode = api_edits_decode,
     .run = api_edits_post,
     .reads = API_READS_BEFORE,
     .cost = api_edits_cost,
     .role = API_ROLE_WRITE,
     .flags = API_WRITES | API_LONG | API_IDEMPOTENCY_KEY | API_REHEARSED,
     .body_kind = API_BODY_EDITS,
     .consumes = packed_too,
     .produces = packed_too,
     .statuses = {200, 202, 204, 409, 412, 413, 415, 422},
     .request = "edit",
     .response = "edited",
     .summary = "Edit a mesh",
     .doc = "The body is one operation, or a list of operations that is applied completely or not "
            "at all. It makes one revision and one undo step. As application/vnd.hedge.edits, long "
            "lists of ids, numbers and points are arrays of octets beside the JSON, in the request "
            "and in the answer; `/docs/guides/batches` describes the bytes."},
    {.method = "GET",
     .path = "/v1/meshes/{mesh}/edits",
     .name = "list_edits",
     .run = api_edits_list,
     .role = API_ROLE_READ,
     .reads = API_READS_LOCKED,
     .produces = json,
     .parameters = {&api_parameter_limit, &api_parameter_cursor, &api_parameter_since},
     .headers = {&next_page},
     .statuses = {200, 304, 410},
     .response = "history",
     .summary = "History of a mesh",
     .doc = "What each revision did, newest first. `oldest` is the oldest revision that can still "
            "be read. `dropped` tells how many entries were removed to keep within the undo "
            "budget; the oldest undo steps were removed with them. An undone edit can be redone "
            "until the next edit, however full the history is."},
    {.method = "PATCH",
     .path = "/v1/meshes/{mesh}/edits/{revision}",
     .name = "name_revision",
     .run = api_moment_patch,
     .reads = API_READS_CARD,
     .role = API_ROLE_WRITE,
     .flags = API_WRITES | API_IDEMPOTENCY_KEY,
     .body_kind = API_BODY_CONTROL,
     .consumes = merge_patch,
     .produces = json,
     .statuses = {200, 204, 409, 410, 412, 413, 415, 422},
     .request = "moment_patch",
     .response = "entry",
     .summary = "Name a revision",
     .doc = "A JSON merge patch (RFC 7396) of the name of a revision, by which the moment is found "
            "again. The history keeps the name with the entry of the revision, within the undo "
            "budget, and drops both together. The first revision, which is not in the history, "
            "cannot have a name. The content and its revision do not change, but all ETags of the "
            "mesh do, as after a rename, so an edit with an older If-Match is answered 412."},
    {.method = "POST",
     .path = "/v1/meshes/{mesh}/undo",
     .name = "undo_edits",
     .decode = api_undo_decode,
     .run = api_undo_post,
     .reads = API_READS_BEFORE,
     .cost = api_undo_cost,
     .role = API_ROLE_WRITE,
     .flags = API_WRITES | API_IDEMPOTENCY_KEY,
     .body_kind = API_BODY_OPTION,
     .consumes = json,
     .produces = json,
     .statuses = {200, 204, 409, 410, 412, 413, 415, 422},
     .request = "step",
     .response = "edited",
     .summary = "Undo the last edit",
     .doc = "Undoes the last edit, the last `steps` edits, or all edits since revision "
            "`to_revision`, completely or not at all. Each undone edit makes a new revision. The "
            "answer has the changes of all steps together."},
    {.method = "POST",
     .path = "/v1/meshes/{mesh}/redo",
     .name = "redo_edits",
     .decode = api_redo_decode,
     .run = api_undo_post,
     .reads = API_READS_BEFORE,
     .cost = api_undo_cost,
     .role = API_ROLE_WRITE,
     .flags = API_WRITES | API_IDEMPOTENCY_KEY,
     .body_kind = API_BODY_OPTION,
     .consumes = json,
     .produces = json,
     .statuses = {200, 204, 409, 410, 412, 413, 415, 422},
     .request = "step",
     .response = "edited",
     .summary = "Redo what was undone",
     .doc = "Redoes the last undone edit, the last `steps` undone edits, or as many as lead to the "
            "content of revision `to_revision`. Each redone edit makes a new revision, and "
            "elements get the ids they had."},

    LIVE_ROWS,

    /* jobs */
    {.method = "GET",
     .path = "/v1/jobs",
     .name = "list_jobs",
     .run = api_jobs_list,
     .role = API_ROLE_READ,
     .produces = json,
     .parameters = {&api_parameter_limit, &api_parameter_cursor},
     .headers = {&next_page},
     .statuses = {200},
     .response = "job_page",
     .summary = "List the jobs",
     .doc = "A page of jobs in the order in which they were submitted, without their results and "
            "problems."},
    {.method = "GET",
     .path = "/v1/jobs/{job}",
     .name = "get_job",
     .run = api_job_get,
     .role = API_ROLE_READ,
     .produces = json,
     .statuses = {200},
     .response = "job",
     .summary = "State of a job",
     .doc = "When the job has ended, the answer includes what the request would have been answered "
            "with: a result or a problem. Results that are not JSON, or a whole mesh, are fetched "
            "by `result_link`. A job that has ended is kept for an hour, if there is room. It is "
            "also kept across a restart of the server, but then without an answer of more than 64 "
            "KiB. A job that had not ended at a restart has failed with the problem `interrupted`, "
            "and has changed nothing."},
    {.method = "GET",
     .path = "/v1/jobs/{job}/result",
     .name = "get_job_result",
     .run = api_job_result,
     .role = API_ROLE_READ,
     .flags = API_OWN_ACCEPT | API_TAG_OF_OTHERS,
     .produces = job_results,
     .headers = {&disposition, &warnings},
     .statuses = {200, 202, 304},
     .response = "job_result",
     .summary = "Result of a job",
     .doc = "The body and media type that the request would have been answered with. `result_link` "
            "of a job leads to this path. The answer is 202 with the job until the job has ended, "
            "and 404 if the job failed or its answer has no body."},
    {.method = "GET",
     .path = "/v1/jobs/{job}/events",
     .name = "follow_job",
     .run = api_job_events,
     .role = API_ROLE_READ,
     .produces = event_stream,
     .statuses = {200},
     .item = "job_event",
     .summary = "Events of a job",
     .doc = "Server-sent events. `job`: the job, whenever it has made progress; the last event "
            "`job` has the result or problem of the job if that is small. `bye`: the stream ends."},
    {.method = "DELETE",
     .path = "/v1/jobs/{job}",
     .name = "delete_job",
     .run = api_job_delete,
     .role = API_ROLE_READ,
     .produces = json,
     .statuses = {202, 204},
     .response = "job",
     .summary = "Cancel or forget a job",
     .doc = "A job that waits or runs is cancelled, and the answer is 202: what the job had "
            "changed is undone and its memory is freed. A job that has ended is forgotten, and the "
            "answer is 204."},

    /* tokens */
    {.method = "GET",
     .path = "/v1/token",
     .name = "get_token",
     .run = api_token_get,
     .role = API_ROLE_READ,
     .flags = API_STORELESS,
     .produces = json,
     .statuses = {200},
     .response = "token",
     .summary = "Token of the request",
     .doc = "What the token of the request may do. If the server needs no tokens, the name is null "
            "and the role is admin."},
    {.method = "POST",
     .path = "/v1/tickets",
     .name = "create_ticket",
     .run = api_tickets_post,
     .role = API_ROLE_READ,
     .flags = API_STORELESS,
     .body_kind = API_BODY_CONTROL,
     .consumes = json,
     .produces = json,
     .statuses = {200, 413, 415},
     .request = "ticket_asked",
     .response = "ticket",
     .summary = "Make a ticket for one GET without a token",
     .doc = "A ticket lets one GET pass without the header Authorization, which browsers do not "
            "send for images and downloads in a page. `path` in the answer is the path of the "
            "request with a ticket added. The ticket is valid for one GET within 60 seconds, with "
            "the rights of the token that asked for it. A path that needs no token is refused, "
            "because it needs no ticket either."},
    {.method = "POST",
     .path = "/v1/admin/reload",
     .name = "reload_tokens",
     .run = api_admin_reload,
     .role = API_ROLE_ADMIN,
     .flags = API_STORELESS,
     .produces = json,
     .statuses = {200, 409},
     .response = "reloaded",
     .summary = "Reload the token file",
     .doc = "Reads the file of tokens again, as the signal SIGHUP also does. Tokens that are no "
            "longer in the file are not accepted any more, and their event streams end with `bye`. "
            "If the file is wrong, the tokens stay as they are and the problem names the line."},

    {.method = "POST",
     .path = "/v1/admin/backup",
     .name = "back_up_store",
     .run = api_admin_backup,
     .role = API_ROLE_ADMIN,
     .flags = API_LONG,
     .produces = database,
     .headers = {&disposition},
     .statuses = {200, 202, 409},
     .summary = "Back up the store",
     .doc = "Makes a file for `hedged --restore`. The request becomes a job, unless the client "
            "waits; the file is the result of the job. The server keeps one backup at a time: "
            "DELETE the job after you have fetched the file."},

    /* descriptions of the API */
    {.method = "GET",
     .path = "/v1/operations",
     .name = "list_operations",
     .run = api_operations_get,
     .role = API_ROLE_OPEN,
     .flags = API_STORELESS,
     .produces = json,
     .statuses = {200, 304},
     .response = "operations",
     .summary = "List the operations",
     .doc = "Every operation with its parameters, its results, the errors it can give, and how it "
            "changes the numbers of vertices, edges and faces."},
    {.method = "GET",
     .path = "/v1/problems",
     .name = "list_problems",
     .run = api_problems_get,
     .role = API_ROLE_OPEN,
     .flags = API_STORELESS,
     .produces = json,
     .statuses = {200, 304},
     .response = "problems",
     .summary = "List the problems",
     .doc = "Every code that the member `code` of a problem can have, with its usual status, its "
            "title and an explanation."},
    {.method = "GET",
     .path = "/v1/openapi.json",
     .name = "get_openapi",
     .run = api_openapi_get,
     .role = API_ROLE_OPEN,
     .flags = API_STORELESS,
     .produces = json,
     .statuses = {200, 304},
     .response = "description",
     .summary = "This document",
     .doc = "The description of the API in the format OpenAPI 3.1."},

    /* paths that are not under /v1 */
    {.method = "GET",
     .path = "/livez",
     .name = "get_liveness",
     .run = api_live_get,
     .role = API_ROLE_OPEN,
     .flags = API_FIXED | API_UNLIMITED,
     .produces = json,
     .statuses = {200},
     .response = "health",
     .summary = "Is the process alive?",
     .doc = "The answer is 200 as long as the process runs, even if the store has failed."},
    {.method = "GET",
     .path = "/readyz",
     .name = "get_readiness",
     .run = api_ready_get,
     .role = API_ROLE_OPEN,
     .flags = API_FIXED | API_UNLIMITED,
     .produces = json,
     .statuses = {200},
     .response = "readiness",
     .summary = "Does the server take requests?",
     .doc = "The answer is 503 `not_ready` while the server starts or stops, and 503 "
            "`store_failed` after a write or a sync of the disk failed: then no changes are "
            "accepted until the server is restarted. If the disk is full, the answer is 200 with "
            "`\"store\": \"full\"`, because reads continue and meshes can be deleted. If memory is "
            "full, that is, no mesh can be removed from memory and new meshes are refused, the "
            "answer is 200 with `\"memory\": \"full\"`."},
    {.method = "GET",
     .path = "/metrics",
     .name = "get_metrics",
     .run = api_metrics_get,
     .role = API_ROLE_METRICS,
     .flags = API_FIXED | API_UNLIMITED,
     .produces = plain,
     .statuses = {200},
     .summary = "Metrics",
     .doc = "The metrics are in the text format of Prometheus, version 0.0.4; hedged(8) lists "
            "them. If the server needs tokens, the request needs one with the role metrics or "
            "admin. The answer never waits for the disk or for a thread."},
    {.method = "GET",
     .path = "/version",
     .name = "get_version",
     .run = api_version_get,
     .role = API_ROLE_OPEN,
     .flags = API_FIXED,
     .produces = json,
     .statuses = {200},
     .response = "version",
     .summary = "Version of the server",
     .doc = "The server's name and version, as in `info` of this document."},
    {.method = "GET",
     .path = "/v1",
     .name = "get_index",
     .run = api_index_get,
     .role = API_ROLE_OPEN,
     .flags = API_FIXED,
     .produces = json,
     .statuses = {200},
     .response = "index",
     .summary = "Where to begin",
     .doc = "The paths of the list of meshes, the list of jobs, the list of operations, the list "
            "of problems, the OpenAPI document and the manual."},
    {.method = "GET",
     .path = "/problems/{code}",
     .name = "get_problem",
     .run = api_problem_get,
     .role = API_ROLE_OPEN,
     .flags = API_FIXED,
     .produces = html,
     .statuses = {200, 303},
     .summary = "What a problem means",
     .doc = "A page that explains the code of a problem. The member `type` of a problem links to "
            "this page. If the server has its manual, the answer is 303 and leads to the page of "
            "the manual."},
    {.method = "GET",
     .path = "/",
     .name = "get_viewer",
     .run = api_page_get,
     .role = API_ROLE_OPEN,
     .flags = API_FIXED | API_OWN_QUERY,
     .produces = html,
     .parameters = {&api_parameter_embed},
     .statuses = {200, 304},
     .summary = "The viewer",
     .doc =
         "A page to view, inspect and edit meshes. The option --allow-frame says whose pages may "
         "show it in frames."},
    {.method = "GET",
     .path = "/docs",
     .name = "get_docs",
     .run = api_page_get,
     .role = API_ROLE_OPEN,
     .flags = API_FIXED,
     .produces = html,
     .statuses = {200, 304},
     .summary = "The manual",
     .doc = "The first page of the manual."},
    {.method = "GET",
     .path = "/docs/{asset}",
     .name = "get_docs_page",
     .run = api_page_get,
     .role = API_ROLE_OPEN,
     .flags = API_FIXED | API_MISSING_PAGE,
     .produces = html,
     .statuses = {200, 304},
     .summary = "A page of the manual",
     .doc = "Guides, and a page for each operation (`/docs/operations/edge_split`), each route "
            "(`/docs/routes/create_mesh`), each type (`/docs/types/edited`) and each problem "
            "(`/docs/problems/boundary_edge`). If there is no such page, a client that accepts "
            "HTML gets a page with the status 404."},
    {.method = "GET",
     .path = "/assets/{asset}",
     .name = "get_asset",
     .run = api_page_get,
     .role = API_ROLE_OPEN,
     .flags = API_FIXED | API_OWN_ACCEPT,
     .produces = anything,
     .statuses = {200, 304},
     .summary = "Files of the pages",
     .doc = "Scripts and styles of the viewer and the manual."},
};

api_route_table api_routes(void)
{
    return (api_route_table){routes, sizeof routes / sizeof routes[0]};
}

const int *api_route_common(void)
{
    static const int common[] = {400, 403, 404, 405, 406, 408, 414, 421,
                                 429, 431, 500, 501, 503, 505, 507, 0};
    return common;
}
