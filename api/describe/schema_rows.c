#include "api/describe/schema_rows.h"

#include "api/ask/records.h"
#include "api/describe/operations.h"
#include "api/describe/page_records.h"
#include "api/document/summary.h"
#include "api/document/upload.h"
#include "api/event/events.h"
#include "api/job/job_out.h"
#include "api/json/attribute_value.h"
#include "api/json/material_value.h"
#include "api/json/problem.h"
#include "api/presence/presences.h"
#include "api/read/records.h"

#include <stddef.h>
#include <string.h>

/* Values of the member `required` in the tables below. */
enum { OPTIONAL = false, REQUIRED = true };

/* The tables of members with which answers are written. */
static const api_record *const records[] = {
    &api_counts_record,
    &api_box_record,
    &api_mesh_item_record,
    &api_job_record,
    &api_summary_record,
    &api_entry_record,
    &api_counted_record,
    &api_job_state_record,
    &api_import_record,
    &api_warning_record,
    &api_health_record,
    &api_readiness_record,
    &api_version_record,
    &api_index_record,
    &api_problem_row_record,
    &api_problems_record,
    &api_token_record,
    &api_ticket_record,
    &api_reloaded_record,
    &api_history_record,
    &api_metadata_record,
    &api_moment_record,
    &api_presence_record,
    &api_presence_selection_record,
    &api_presence_camera_record,
    &api_presences_record,
    &api_presence_news_record,
    &api_resync_record,
    &api_bye_record,
    &api_attribute_read_record,
    &api_attribute_added_record,
    &api_attribute_info_record,
    &api_attribute_list_record,
    &api_attribute_values_record,
    &api_material_record,
    &api_material_list_record,
    &api_broken_record,
    &api_defect_record,
    &api_thresholds_record,
    &api_check_record,
    &api_far_place_record,
    &api_one_sided_record,
    &api_comparison_record,
    &api_problem_element_record,
    &api_problem_record,
    &api_loop_record,
    &api_boundaries_record,
    &api_component_record,
    &api_components_record,
    &api_operation_row_record,
    &api_parameter_record,
    &api_result_record,
    &api_operations_record,
    &api_mesh_page_record,
    &api_job_page_record,
    &api_page_records[HE_VERTEX],
    &api_page_records[HE_HALFEDGE],
    &api_page_records[HE_EDGE],
    &api_page_records[HE_FACE],
};
enum { RECORDS = sizeof records / sizeof *records };

size_t api_record_count(void)
{
    return RECORDS;
}

const api_record *api_record_at(size_t i)
{
    return records[i];
}

const api_record *api_record_find(const char *schema)
{
    size_t i = 0;
    while (i < RECORDS && strcmp(records[i]->schema, schema) != 0) {
        i++;
    }
    return i < RECORDS ? records[i] : NULL;
}

/* A schema whose members are listed here belongs to an answer that functions write without a table.
 * The comment before its rows, or before the first schema of a group, says why. */
const api_member api_answer_members[] = {
    {"counts", NULL, NULL, REQUIRED, NULL},

    {"box", NULL, NULL, REQUIRED, NULL},

    {"mesh_item", NULL, NULL, REQUIRED, NULL},

    {"mesh_page", NULL, NULL, REQUIRED, NULL},

    {"job", NULL, NULL, REQUIRED, NULL},

    {"job_page", NULL, NULL, REQUIRED, NULL},

    {"summary", NULL, NULL, REQUIRED, NULL},

    {"import", NULL, NULL, REQUIRED, NULL},

    {"attribute_read", NULL, NULL, REQUIRED, NULL},

    {"warning", NULL, NULL, REQUIRED, NULL},

    /* Which members there are, and their order, depend on the repair. */
    {"repair", "repair", "#repair_name", REQUIRED, NULL},
    {"repair", "count", "count", REQUIRED,
     "How many vertices or faces the repair removed, how many faces it turned, or how many "
     "elements it made."},
    {"repair", "gone", "*id", OPTIONAL,
     "The first 100 elements that the repair removed, numbered from 0 in the order of the body."},
    {"repair", "into", "*id", OPTIONAL,
     "For each element of `gone`, the id of the element that replaces it."},
    {"repair", "lines", "*count", OPTIONAL, "For each element of `gone`, its line in the body."},
    {"repair", "bytes", "*count", OPTIONAL,
     "For each element of `gone`, its first byte in a binary body."},
    {"repair", "mended", "count", OPTIONAL,
     "drop_degenerate: how many faces lost corners or were cut into triangles."},
    {"repair", "faces", "*id", OPTIONAL,
     "drop_degenerate: the first 100 faces that `mended` counts, numbered as in the body. orient, "
     "fill: the first 100 faces that were turned or made."},
    {"repair", "components", "count", OPTIONAL, "orient: how many components had faces turned."},
    {"repair", "not_orientable", "count", OPTIONAL,
     "orient: how many components cannot be oriented, so that the repair split must cut them."},
    {"repair", "clashes", "*id", OPTIONAL,
     "orient: a face in each of the first 100 components that cannot be oriented."},
    {"repair", "vertices", "count", OPTIONAL,
     "split: how many vertices had several fans of faces."},
    {"repair", "parents", "#parents", OPTIONAL,
     "split: the first 100 new vertices and the vertices that they come from."},
    {"repair", "left", "count", OPTIONAL, "fill: how many boundary loops are left."},
    {"repair", "tolerance", "number", OPTIONAL, "weld: the tolerance that was used."},
    {"repair", "moved", "count", OPTIONAL,
     "weld: how many values of vertices became values of corners, because merged vertices had "
     "different ones."},
    {"repair", "hole_edges", "count", OPTIONAL, "fill: the parameter `hole_edges` that was used."},

    /* The only member is written after the members of a summary (api_answer_stored). */
    {"imported", "import", "#import", REQUIRED,
     "What the server read from the body, and what it repaired."},

    /* The next four schemas are those of elements. A page may have thousands of elements, so the
     * functions that write them do not look each member up in a table. */
    {"vertex", "id", "id", REQUIRED, NULL},
    {"vertex", "position", "point", REQUIRED, NULL},
    {"vertex", "halfedge", "id?", REQUIRED,
     "A half-edge that leaves the vertex; one on the boundary, if there is one."},
    {"vertex", "degree", "count", REQUIRED, "The number of edges at the vertex."},
    {"vertex", "boundary", "flag", REQUIRED, NULL},
    {"vertex", "isolated", "flag", REQUIRED, NULL},
    {"vertex", "attributes", "#values_by_name", OPTIONAL,
     "Values by the name of the attribute, if the mesh has any."},

    {"halfedge", "id", "id", REQUIRED, NULL},
    {"halfedge", "twin", "id", REQUIRED, NULL},
    {"halfedge", "next", "id", REQUIRED, NULL},
    {"halfedge", "prev", "id", REQUIRED, NULL},
    {"halfedge", "origin", "id", REQUIRED, NULL},
    {"halfedge", "target", "id", REQUIRED, NULL},
    {"halfedge", "edge", "id", REQUIRED, NULL},
    {"halfedge", "face", "id?", REQUIRED,
     "The face on the left of the half-edge; null on the boundary."},
    {"halfedge", "boundary", "flag", REQUIRED, NULL},
    {"halfedge", "attributes", "#values_by_name", OPTIONAL,
     "Values by the name of the attribute, if the mesh has any."},

    {"edge", "id", "id", REQUIRED, NULL},
    {"edge", "halfedges", "#pair", REQUIRED, "The half-edges 2 * id and 2 * id + 1."},
    {"edge", "vertices", "#pair", REQUIRED, "The origins of the two half-edges."},
    {"edge", "faces", "#sides", REQUIRED, "The faces of the two half-edges; null on the boundary."},
    {"edge", "length", "number", REQUIRED, NULL},
    {"edge", "boundary", "flag", REQUIRED, NULL},
    {"edge", "attributes", "#values_by_name", OPTIONAL,
     "Values by the name of the attribute, if the mesh has any."},

    {"face", "id", "id", REQUIRED, NULL},
    {"face", "halfedge", "id", REQUIRED, NULL},
    {"face", "degree", "count", REQUIRED, "The number of corners of the face."},
    {"face", "vertices", "*id", REQUIRED,
     "The corners, counter-clockwise from the origin of `halfedge`."},
    {"face", "halfedges", "*id", REQUIRED, NULL},
    {"face", "area", "number", REQUIRED, "The length of the vector area (Newell's method)."},
    {"face", "normal", "point", REQUIRED,
     "The unit normal; a zero vector if the face has no area."},
    {"face", "centroid", "point", REQUIRED, NULL},
    {"face", "attributes", "#values_by_name", OPTIONAL,
     "Values by the name of the attribute, if the mesh has any."},

    {"attribute_info", NULL, NULL, REQUIRED, NULL},

    {"attribute_list", NULL, NULL, REQUIRED, NULL},

    {"material_row", NULL, NULL, REQUIRED, NULL},

    {"material_list", NULL, NULL, REQUIRED, NULL},

    {"attribute_values", NULL, NULL, REQUIRED, NULL},

    /* The revision is filled in when the rest has been written and committed. */
    {"attribute_written", "revision", "count", REQUIRED, NULL},
    {"attribute_written", "dry_run", "flag", OPTIONAL, "Nothing was changed."},
    {"attribute_written", "attribute", "#attribute_info", OPTIONAL,
     "The attribute as it is now; missing if it was deleted."},
    {"attribute_written", "created", "#sets", REQUIRED, "Always empty."},
    {"attribute_written", "deleted", "#sets", REQUIRED, "Always empty."},
    {"attribute_written", "modified", "#sets", REQUIRED,
     "The elements whose values changed; empty if the whole attribute was created or deleted."},
    {"attribute_written", "parents", "#parents", REQUIRED, "Always empty."},
    {"attribute_written", "merged", "#merged", REQUIRED, "Always empty."},
    {"attribute_written", "undoable", "flag", OPTIONAL,
     "Present only if false: the change is larger than the undo budget, so that neither this "
     "change nor an earlier one can be undone."},

    {"vertex_page", NULL, NULL, REQUIRED, NULL},

    {"halfedge_page", NULL, NULL, REQUIRED, NULL},

    {"edge_page", NULL, NULL, REQUIRED, NULL},

    {"face_page", NULL, NULL, REQUIRED, NULL},

    /* One answer may have thousands of adjacencies, and `dense` has ids for each element of the
     * mesh. */
    {"adjacency", "revision", "count", OPTIONAL,
     "The revision; missing if the answer is one of several in `results`, which all have one "
     "revision."},
    {"adjacency", "of", "#of", REQUIRED, NULL},
    {"adjacency", "relation", "text", REQUIRED, NULL},
    {"adjacency", "ids", "*id", REQUIRED, NULL},

    {"dense", "elements", "*id", OPTIONAL,
     "The ids of the elements, in the same order, if the question is about all of them."},
    {"dense", "offsets", "*count", REQUIRED,
     "n + 1 positions in `ids`: the ids of element i begin at position offsets[i] and end before "
     "position offsets[i + 1]."},
    {"dense", "ids", "*id", REQUIRED, NULL},

    {"loop", NULL, NULL, REQUIRED, NULL},

    {"boundaries", NULL, NULL, REQUIRED, NULL},

    {"component", NULL, NULL, REQUIRED, NULL},

    {"components", NULL, NULL, REQUIRED, NULL},

    {"broken", NULL, NULL, REQUIRED, NULL},

    {"defect", NULL, NULL, REQUIRED, NULL},

    {"thresholds", NULL, NULL, REQUIRED, NULL},

    {"check", NULL, NULL, REQUIRED, NULL},

    {"far_place", NULL, NULL, REQUIRED, NULL},

    {"one_sided", NULL, NULL, REQUIRED, NULL},

    {"comparison", NULL, NULL, REQUIRED, NULL},

    /* The members have names from the table of kinds and are written by loops (change_json.c). */
    {"sets", "vertices", "*id", REQUIRED, NULL},
    {"sets", "edges", "*id", REQUIRED, "Edges; the half-edges of edge e are 2e and 2e + 1."},
    {"sets", "faces", "*id", REQUIRED, NULL},

    {"parents", "vertices", "*#pair", OPTIONAL,
     "Pairs: the id of the new element, and the id of the element that it was made from."},
    {"parents", "edges", "*#pair", OPTIONAL, NULL},
    {"parents", "faces", "*#pair", OPTIONAL, NULL},

    {"merged", "vertices", "*#pair", OPTIONAL,
     "Pairs: the id of the element that was removed, and the id of the element that it was merged "
     "into."},
    {"merged", "edges", "*#pair", OPTIONAL, NULL},
    {"merged", "faces", "*#pair", OPTIONAL, NULL},

    /* The revision is filled in when the rest has been written and committed. */
    {"edited", "revision", "count", REQUIRED, NULL},
    {"edited", "dry_run", "flag", OPTIONAL,
     "True for a dry run: nothing was changed, and the answer shows the revision and the ids that "
     "the edit would give."},
    {"edited", "results", "*#done", REQUIRED,
     "One object for each operation: `op` and its results."},
    {"edited", "created", "#sets", REQUIRED, NULL},
    {"edited", "deleted", "#sets", REQUIRED, NULL},
    {"edited", "modified", "#sets", REQUIRED,
     "Elements that were kept, but have a changed link or value."},
    {"edited", "parents", "#parents", REQUIRED, NULL},
    {"edited", "merged", "#merged", REQUIRED, NULL},
    {"edited", "replaced", "flag", OPTIONAL,
     "True if the whole content was replaced; then `created`, `deleted` and `modified` are empty. "
     "After compact all ids are new, and `results` maps the old ids to the new ones; otherwise ids "
     "keep their meaning."},
    {"edited", "undoable", "flag", OPTIONAL,
     "Present only if false: the edit is larger than the undo budget, or is a compact, so that "
     "neither this edit nor an earlier one can be undone."},
    {"edited", "undo", "count", OPTIONAL,
     "After undo and redo: how many steps can still be undone."},
    {"edited", "redo", "count", OPTIONAL, "After undo and redo: how many steps can be redone."},

    {"counted", NULL, NULL, REQUIRED, NULL},

    {"entry", NULL, NULL, REQUIRED, NULL},

    {"history", NULL, NULL, REQUIRED, NULL},

    /* The schemas from here to walked_edge_ring are those of answers to questions. One request asks
     * up to 10000, and each answer is written by the function that has computed it. */
    {"found", "halfedge", "id?", OPTIONAL, "The half-edge from the first vertex to the second."},
    {"found", "edge", "id?", OPTIONAL, "The edge between the two vertices."},
    {"found", "faces", "*id", OPTIONAL,
     "The faces that have both vertices as corners, in the order around the first vertex."},

    {"measured", "revision", "count", REQUIRED, NULL},
    {"measured", "of", "#of", REQUIRED, NULL},
    {"measured", "measure", "#measure_name", REQUIRED, NULL},
    {"measured", "value", "#measured_value", REQUIRED,
     "The measured value; null if the element has none."},

    {"measured_many", "measure", "#measure_name", REQUIRED, NULL},
    {"measured_many", "components", "count", REQUIRED, "1, or 3 for a vector."},
    {"measured_many", "elements", "*id", OPTIONAL,
     "The ids of the elements, in the same order, if the question is about all of them."},
    {"measured_many", "values", "*#measured_value", REQUIRED, "One value for each element."},

    {"share", "vertex", "id", REQUIRED, NULL},
    {"share", "weight", "number", REQUIRED,
     "The vertex's weight, above 0; the weights of one point add up to 1."},

    {"place", "face", "id", REQUIRED,
     "The face that the ray hits, or the nearest face; if there are several, the one with the "
     "lowest id."},
    {"place", "distance", "number", REQUIRED, NULL},
    {"place", "point", "point", REQUIRED, NULL},
    {"place", "barycentric", "+#share", REQUIRED,
     "The barycentric coordinates of the point in a triangle of the face: 3 vertices, 2 for a "
     "point on an edge, 1 for a point at a vertex."},

    {"ray_hit", "hit", "#place?", REQUIRED, "The first hit; null if the ray hits nothing."},

    {"nearest", "closest", "#place?", REQUIRED,
     "The nearest point of the mesh; null if no face is near enough."},

    {"intersections", "pairs", "*#pair", REQUIRED,
     "Pairs of faces, the lower id first, in ascending order."},
    {"intersections", "total", "count", REQUIRED, "How many pairs were found."},
    {"intersections", "complete", "flag", REQUIRED,
     "False if the search stopped at 1048576 pairs, so that there may be more."},

    {"query_results", "revision", "count", REQUIRED, NULL},
    {"query_results", "results", "*#answer", REQUIRED,
     "The answers, in the order of the questions."},

    {"walked_path", "revision", "count", REQUIRED, NULL},
    {"walked_path", "walk", "=path", REQUIRED, NULL},
    {"walked_path", "from", "#of_halfedge", REQUIRED, NULL},
    {"walked_path", "path", "+#step_name", REQUIRED, "The steps that the request gave."},
    {"walked_path", "repeat", "count", OPTIONAL,
     "How many times the request asked to take the steps."},
    {"walked_path", "until", "#until_name", OPTIONAL,
     "The condition at which the request asked to stop."},
    {"walked_path", "halfedges", "*id", REQUIRED,
     "The half-edges of the path, from the first to the last."},
    {"walked_path", "end", "id", REQUIRED, "The last half-edge of the path."},

    {"walked_loop", "revision", "count", REQUIRED, NULL},
    {"walked_loop", "walk", "=loop", REQUIRED, NULL},
    {"walked_loop", "from", "#of_halfedge", REQUIRED, NULL},
    {"walked_loop", "halfedges", "*id", REQUIRED,
     "The half-edges of the loop, in the order in which `next` leads from one to the following "
     "one."},
    {"walked_loop", "vertices", "*id", REQUIRED, "The origins of the half-edges."},
    {"walked_loop", "face", "id?", REQUIRED,
     "The face that the loop bounds; null on the boundary."},

    {"walked_rings", "revision", "count", REQUIRED, NULL},
    {"walked_rings", "walk", "=rings", REQUIRED, NULL},
    {"walked_rings", "from", "#of_vertex", REQUIRED, NULL},
    {"walked_rings", "depth", "count", REQUIRED, NULL},
    {"walked_rings", "rings", "**id", REQUIRED, "The vertices at distance 0, 1, 2 and so on."},

    {"walked_breadth_first", "revision", "count", REQUIRED, NULL},
    {"walked_breadth_first", "walk", "=breadth_first", REQUIRED, NULL},
    {"walked_breadth_first", "from", "#of", REQUIRED, NULL},
    {"walked_breadth_first", "depth", "count", OPTIONAL,
     "The largest distance that the request gave."},
    {"walked_breadth_first", "limit", "count", OPTIONAL,
     "The largest number of ids that the request asked for."},
    {"walked_breadth_first", "ids", "*id", REQUIRED,
     "The ids of the elements that were found, the nearest first."},
    {"walked_breadth_first", "depths", "*count", REQUIRED,
     "The distance of each element from the first, in steps."},

    {"walked_shortest_path", "revision", "count", REQUIRED, NULL},
    {"walked_shortest_path", "walk", "=shortest_path", REQUIRED, NULL},
    {"walked_shortest_path", "from", "#of_vertex", REQUIRED, NULL},
    {"walked_shortest_path", "to", "#of_vertex", REQUIRED, NULL},
    {"walked_shortest_path", "by", "#path_measure", REQUIRED, NULL},
    {"walked_shortest_path", "vertices", "*id?", REQUIRED,
     "The vertices of the path, from its first to its last; null if there is no path."},
    {"walked_shortest_path", "edges", "*id?", REQUIRED,
     "The edges of the path, from its first to its last; null if there is no path."},
    {"walked_shortest_path", "length", "number?", REQUIRED,
     "The length of the path, measured as `by` says; null if there is no path."},

    {"walked_edge_loop", "revision", "count", REQUIRED, NULL},
    {"walked_edge_loop", "walk", "=edge_loop", REQUIRED, NULL},
    {"walked_edge_loop", "from", "#of_edge", REQUIRED, NULL},
    {"walked_edge_loop", "edges", "*id", REQUIRED, NULL},
    {"walked_edge_loop", "closed", "flag", REQUIRED,
     "True if the loop is closed: the last edge leads back to the first."},

    {"walked_edge_ring", "revision", "count", REQUIRED, NULL},
    {"walked_edge_ring", "walk", "=edge_ring", REQUIRED, NULL},
    {"walked_edge_ring", "from", "#of_edge", REQUIRED, NULL},
    {"walked_edge_ring", "edges", "*id", REQUIRED, NULL},
    {"walked_edge_ring", "closed", "flag", REQUIRED,
     "True if the ring is closed: the last edge leads back to the first."},

    /* The values are written until the text reaches its maximum; then the event is written anew
     * with `stale`. */
    {"delta", "base", "count", REQUIRED, "The revision before the change."},
    {"delta", "revision", "count", REQUIRED, NULL},
    {"delta", "stale", "flag", OPTIONAL,
     "True if the change is longer than 64 KiB: besides this member the event then has only `base` "
     "and `revision`, and the client must fetch the mesh again."},
    {"delta", "action", "#action", OPTIONAL, NULL},
    {"delta", "created", "#sets", OPTIONAL, NULL},
    {"delta", "deleted", "#sets", OPTIONAL, NULL},
    {"delta", "modified", "#sets", OPTIONAL, NULL},
    {"delta", "parents", "#parents", OPTIONAL, NULL},
    {"delta", "merged", "#merged", OPTIONAL, NULL},
    {"delta", "attributes_dropped", "*#attribute_read", OPTIONAL,
     "The attributes that were removed from the mesh."},
    {"delta", "attributes_added", "*#attribute_added", OPTIONAL,
     "The attributes that were added to the mesh, after the attributes in `attributes_dropped` "
     "were removed."},
    {"delta", "materials", "*#material_row", OPTIONAL,
     "All materials of the mesh, present only if a material changed."},
    {"delta", "values", "#delta_values", OPTIONAL,
     "All values that were written, complete enough to mirror the mesh exactly."},

    {"attribute_added", NULL, NULL, REQUIRED, NULL},

    /* The members are lists of any length, which end early when the text reaches its maximum. */
    {"delta_values", "vertices", "*#vertex_row", REQUIRED, NULL},
    {"delta_values", "halfedges", "*#halfedge_row", REQUIRED, NULL},
    {"delta_values", "faces", "*#face_row", REQUIRED, NULL},
    {"delta_values", "attributes", "#written_values", REQUIRED, NULL},

    {"metadata", NULL, NULL, REQUIRED, NULL},

    {"moment", NULL, NULL, REQUIRED, NULL},

    {"presence", NULL, NULL, REQUIRED, NULL},

    {"presence_selection", NULL, NULL, REQUIRED, NULL},

    {"presence_camera", NULL, NULL, REQUIRED, NULL},

    {"presences", NULL, NULL, REQUIRED, NULL},

    {"presence_news", NULL, NULL, REQUIRED, NULL},

    {"resync", NULL, NULL, REQUIRED, NULL},

    {"bye", NULL, NULL, REQUIRED, NULL},

    {"job_state_told", NULL, NULL, REQUIRED, NULL},

    /* Events are not written as JSON objects: their members are the fields of text/event-stream. */
    {"mesh_event_edit", "event", "=edit", REQUIRED, NULL},
    {"mesh_event_edit", "id", "text", REQUIRED,
     "The id to send in Last-Event-ID when the client connects again."},
    {"mesh_event_edit", "data", "#delta", REQUIRED, "A new revision."},

    {"mesh_event_metadata", "event", "=metadata", REQUIRED, NULL},
    {"mesh_event_metadata", "data", "#metadata", REQUIRED, "The name changed."},

    {"mesh_event_moment", "event", "=moment", REQUIRED, NULL},
    {"mesh_event_moment", "data", "#moment", REQUIRED, "A revision was named."},

    {"mesh_event_presence", "event", "=presence", REQUIRED, NULL},
    {"mesh_event_presence", "data", "#presence_news", REQUIRED,
     "Clients came, left, or show something else. The first event of a stream lists all that are "
     "there."},

    {"mesh_event_job", "event", "=job", REQUIRED, NULL},
    {"mesh_event_job", "data", "#job_state_told", REQUIRED, "A job on this mesh started or ended."},

    {"mesh_event_resync", "event", "=resync", REQUIRED, NULL},
    {"mesh_event_resync", "id", "text", REQUIRED,
     "The id to send in Last-Event-ID when the client connects again."},
    {"mesh_event_resync", "data", "#resync", REQUIRED, "Tells that events were left out."},

    {"mesh_event_bye", "event", "=bye", REQUIRED, NULL},
    {"mesh_event_bye", "data", "#bye", REQUIRED, "The stream ends."},

    {"job_event_job", "event", "=job", REQUIRED, NULL},
    {"job_event_job", "data", "#job", REQUIRED, "The job as it is now."},

    {"job_event_bye", "event", "=bye", REQUIRED, NULL},
    {"job_event_bye", "data", "#bye", REQUIRED, "The stream ends."},

    {"parameter", NULL, NULL, REQUIRED, NULL},

    {"result", NULL, NULL, REQUIRED, NULL},

    {"operation_row", NULL, NULL, REQUIRED, NULL},

    {"operations", NULL, NULL, REQUIRED, NULL},

    {"problem_row", NULL, NULL, REQUIRED, NULL},

    {"problems", NULL, NULL, REQUIRED, NULL},

    {"token", NULL, NULL, REQUIRED, NULL},

    {"ticket", NULL, NULL, REQUIRED, NULL},

    {"reloaded", NULL, NULL, REQUIRED, NULL},

    {"health", NULL, NULL, REQUIRED, NULL},
    {"readiness", NULL, NULL, REQUIRED, NULL},

    {"version", NULL, NULL, REQUIRED, NULL},

    {"index", NULL, NULL, REQUIRED, NULL},

    {"problem_element", NULL, NULL, REQUIRED, NULL},

    {"problem", NULL, NULL, REQUIRED, NULL},
    {NULL, NULL, NULL, OPTIONAL, NULL},
};

const api_member api_request_members[] = {
    {"document", "name", "#shown_name?", OPTIONAL, "At most 256 bytes of UTF-8."},
    {"document", "vertices", "*point", OPTIONAL, NULL},
    {"document", "faces", "**index", OPTIONAL,
     "For each face the indices of its vertices, counter-clockwise; the first vertex is 0."},
    {"document", "attributes", "*#document_attribute", OPTIONAL,
     "Attributes of vertices, half-edges, edges, faces or the mesh."},
    {"document", "materials", "*#material", OPTIONAL,
     "A face names its material in the attribute `material`."},

    {"material", "name", "#material_name", REQUIRED,
     "The name of the material, which must differ from the names of other materials."},
    {"material", "base_color", "#color_alpha", OPTIONAL, "Default: white."},
    {"material", "metallic", "#fraction", OPTIONAL, "Default: 0."},
    {"material", "roughness", "#fraction", OPTIONAL, "Default: 1."},
    {"material", "emission", "#color", OPTIONAL, "Default: black."},
    {"material", "two_sided", "flag", OPTIONAL,
     "Whether faces are visible from behind. Default: false."},

    {"document_attribute", "domain", "#domain", REQUIRED, NULL},
    {"document_attribute", "name", "#attribute_name", REQUIRED, NULL},
    {"document_attribute", "type", "#type_name", REQUIRED, NULL},
    {"document_attribute", "components", "count", OPTIONAL,
     "How many numbers one value has, from 1 to 16. Default: 1."},
    {"document_attribute", "rule", "#rule_name", OPTIONAL, NULL},
    {"document_attribute", "default", "#value", OPTIONAL, NULL},
    {"document_attribute", "labels", "+#label", OPTIONAL, NULL},
    {"document_attribute", "values", "*#value", OPTIONAL,
     "One value for each element, or an empty list. Edges are in the order in which they first "
     "occur when the sides of the faces are visited in order. Half-edges are in the order of their "
     "edges; of the two half-edges of an edge, the half-edge that belongs to the earlier face "
     "comes first."},

    {"attribute", "type", "#type_name", REQUIRED, NULL},
    {"attribute", "components", "count", OPTIONAL,
     "How many numbers one value has, from 1 to 16. Default: 1."},
    {"attribute", "rule", "#rule_name", OPTIONAL,
     "How edits choose the value of a new element. Default: interpolate for float and double, copy "
     "for other types."},
    {"attribute", "default", "#value", OPTIONAL, "Default: 0 or false."},
    {"attribute", "labels", "+#label", OPTIONAL,
     "Only for type uint32: the texts of the attribute, whose values are indices into this list."},
    {"attribute", "values", "*#value", OPTIONAL,
     "One value for each element, in the order of ids."},
    {"attribute", "value", "#value", OPTIONAL,
     "One value that all elements get, instead of `values`."},
    {"attribute", "expected_revision", "count", OPTIONAL, NULL},
    {"attribute", "dry_run", "flag", OPTIONAL, NULL},

    {"attribute_patch", "ids", "#ids_or_set", REQUIRED,
     "A list of ids, \"all\", or {\"NAME\":true} for the elements whose attribute NAME is true."},
    {"attribute_patch", "values", "*#value", OPTIONAL, "One value for each id."},
    {"attribute_patch", "value", "#value", OPTIONAL,
     "One value that all of these elements get, instead of `values`."},
    {"attribute_patch", "expected_revision", "count", OPTIONAL, NULL},
    {"attribute_patch", "dry_run", "flag", OPTIONAL, NULL},

    {"mesh_patch", "name", "#shown_name?", OPTIONAL,
     "The new name, at most 256 bytes of UTF-8; null removes the name."},

    {"moment_patch", "name", "#shown_name?", OPTIONAL,
     "The new name of the revision, at most 200 bytes of UTF-8; null takes the name away."},

    {"presence_put", "client", "#client_id", REQUIRED,
     "An id that the client chooses for itself, at random: 1 to 40 letters, digits, '.', '_' and "
     "'-'."},
    {"presence_put", "name", "#shown_name?", OPTIONAL,
     "The name to show, at most 64 bytes of UTF-8. If the request has a token, the token's name is "
     "shown instead."},
    {"presence_put", "selection", "#shown_selection?", OPTIONAL,
     "The selected elements of one kind; null: none."},
    {"presence_put", "camera", "#presence_camera?", OPTIONAL, "Where the client looks from."},
    {"presence_put", "leaves", "flag", OPTIONAL,
     "If true, the client leaves: it is forgotten at once. Default: false."},

    {"shown_selection", "kind", "#presence_kind", REQUIRED, NULL},
    {"shown_selection", "ids", "*id", REQUIRED,
     "At most 256 ids: the selected elements, or the first of them."},
    {"shown_selection", "count", "count", OPTIONAL,
     "How many elements are selected. Default: the number of ids."},

    {"ticket_asked", "path", "text", REQUIRED,
     "The path and query of the GET that the ticket is for, exactly as in its URL."},

    {"copy", "id", "text", OPTIONAL, NULL},
    {"copy", "name", "#shown_name", OPTIONAL, "At most 256 bytes of UTF-8."},

    {"step", "expected_revision", "count", OPTIONAL, NULL},
    {"step", "steps", "count", OPTIONAL, "How many edits to undo or redo. Default: 1."},
    {"step", "to_revision", "count", OPTIONAL,
     "Undo or redo as many edits as lead to the content of this revision."},

    {"relation_query", "relation", "text", REQUIRED, NULL},
    {"relation_query", "of", "#of_any", REQUIRED, NULL},
    {"relation_query", "cw", "flag", OPTIONAL, NULL},

    {"find_query", "find", "#find_name", REQUIRED,
     "halfedge: the half-edge from the first vertex to the second. edge: the edge between the two. "
     "faces: the faces that have both vertices as corners."},
    {"find_query", "vertices", "*id", REQUIRED, "The two vertices, first and second."},

    {"get_query", "get", "#of", REQUIRED, NULL},

    {"measure_query", "measure", "#measure_name", REQUIRED,
     "The measure to compute; which ones are possible depends on the kind of element."},
    {"measure_query", "of", "#of_any", REQUIRED, NULL},
    {"measure_query", "weights", "#weights", OPTIONAL,
     "For normals of vertices: how the normals of faces are weighted. Default: angle."},
    {"measure_query", "crease", "number", OPTIONAL,
     "Only for normals of half-edges, which need it: an angle in radians, from 0 to pi. Edges with "
     "a larger angle between the normals of their faces stay sharp."},

    {"ray", "origin", "point", REQUIRED, NULL},
    {"ray", "direction", "point", REQUIRED,
     "The direction of the ray: a vector of any length except zero."},
    {"ray", "max", "number", OPTIONAL, "How far the ray reaches. Default: no limit."},

    {"ray_query", "ray", "#ray", REQUIRED, NULL},

    {"closest_query", "closest", "point", REQUIRED, NULL},
    {"closest_query", "max", "number", OPTIONAL, "How far to search. Default: no limit."},

    {"pair_limit", "limit", "count", OPTIONAL,
     "The largest number of pairs to list. Default: 100."},

    {"intersections_query", "self_intersections", "#pair_limit", REQUIRED,
     "Find pairs of faces that share a point which is not a corner of both."},

    {"query", "queries", "*#question", REQUIRED, NULL},

    {"compare", "with", "#mesh_or_revision", REQUIRED,
     "The id of another mesh, or the number of a revision of this mesh."},
    {"compare", "bound", "number", OPTIONAL,
     "How much the upper bound of a distance may exceed its lower bound; above 0. Default: a "
     "thousandth of the diagonal of the box around both meshes."},
    {"compare", "bins", "count", OPTIONAL,
     "The number of bins of the histograms, 0 to 256. Default: 32. With 0 neither histograms nor "
     "means are computed, which takes about half of the time."},

    {"walk_path", "walk", "=path", REQUIRED, NULL},
    {"walk_path", "from", "#of_halfedge", REQUIRED, NULL},
    {"walk_path", "path", "+#step_name", REQUIRED, "The steps to take in turn."},
    {"walk_path", "repeat", "count", OPTIONAL,
     "How many times to take the steps. Default: once; without limit if `until` is given."},
    {"walk_path", "until", "#until_name", OPTIONAL,
     "Where the walk stops: back at the first half-edge, or at the boundary."},

    {"walk_loop", "walk", "=loop", REQUIRED, NULL},
    {"walk_loop", "from", "#of_halfedge", REQUIRED, NULL},

    {"walk_rings", "walk", "=rings", REQUIRED, NULL},
    {"walk_rings", "from", "#of_vertex", REQUIRED, NULL},
    {"walk_rings", "depth", "count", REQUIRED, "The number of rings around the vertex."},

    {"walk_breadth_first", "walk", "=breadth_first", REQUIRED, NULL},
    {"walk_breadth_first", "from", "#of", REQUIRED, "A vertex or a face."},
    {"walk_breadth_first", "depth", "count", OPTIONAL, "The largest distance. Default: no limit."},
    {"walk_breadth_first", "limit", "count", OPTIONAL, "The largest number of elements to list."},

    {"walk_shortest_path", "walk", "=shortest_path", REQUIRED, NULL},
    {"walk_shortest_path", "from", "#of_vertex", REQUIRED, NULL},
    {"walk_shortest_path", "to", "#of_vertex", REQUIRED, NULL},
    {"walk_shortest_path", "by", "#path_measure", OPTIONAL,
     "What the path minimizes: its length, which is the default, or its number of edges."},

    {"walk_edge_loop", "walk", "=edge_loop", REQUIRED, NULL},
    {"walk_edge_loop", "from", "#of_edge", REQUIRED, NULL},

    {"walk_edge_ring", "walk", "=edge_ring", REQUIRED, NULL},
    {"walk_edge_ring", "from", "#of_edge", REQUIRED, NULL},

    {"edit_list", "ops", "+#operation", REQUIRED, NULL},
    {"edit_list", "expected_revision", "count", OPTIONAL, NULL},
    {"edit_list", "dry_run", "flag", OPTIONAL, NULL},
    {NULL, NULL, NULL, OPTIONAL, NULL},
};
