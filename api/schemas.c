#include "api/schemas.h"

#include <assert.h>
#include <stdio.h>
#include <string.h>

/* One member of one schema; rows of a schema stand together. A schema without a row for a member
 * may have it all the same in answers ("others may be added beside them"), but not in requests.
 *
 * Types: id, count, number, flag, text, point, time, nothing (an empty array), #other for a schema
 * by name; a star before makes it an array (**id: arrays of ids), a plus one that is not empty, a
 * question mark behind lets the whole be null. */
typedef struct member {
    const char *schema, *name, *type;
    bool required;
    const char *doc;
} member;

enum { OPTIONAL = false, REQUIRED = true }; /* to be read in a row of strings */

static const member answers[] = {
    {"counts", "vertices", "count", REQUIRED, "Live ones."},
    {"counts", "halfedges", "count", REQUIRED, "Twice the edges."},
    {"counts", "edges", "count", REQUIRED, NULL},
    {"counts", "faces", "count", REQUIRED, NULL},
    {"counts", "boundary_loops", "count", OPTIONAL, "In the summary."},
    {"counts", "isolated_vertices", "count", OPTIONAL, "In the summary."},
    {"counts", "components", "count", OPTIONAL, "By shared vertices; isolated ones left out."},
    {"counts", "components_by_edge", "count", OPTIONAL, "By shared edges."},

    {"box", "min", "point", REQUIRED, NULL},
    {"box", "max", "point", REQUIRED, NULL},

    {"mesh_item", "id", "text", REQUIRED, NULL},
    {"mesh_item", "name", "text", REQUIRED, NULL},
    {"mesh_item", "revision", "count", REQUIRED, NULL},
    {"mesh_item", "counts", "#counts", REQUIRED, NULL},

    {"mesh_page", "items", "*#mesh_item", REQUIRED, NULL},
    {"mesh_page", "next", "text?", REQUIRED, "The cursor of the next page."},
    {"mesh_page", "listeners", "count", REQUIRED, "Clients that follow events of meshes."},
    {"mesh_page", "memory_bytes", "count", OPTIONAL, "What the whole server holds."},
    {"mesh_page", "memory_budget", "count", OPTIONAL, "What it may hold; 0: no limit is set."},

    {"job", "id", "text", REQUIRED, "Who knows it may look and cancel."},
    {"job", "operation", "text", REQUIRED, "The operationId of the request."},
    {"job", "state", "#job_state", REQUIRED, NULL},
    {"job", "phase", "text?", REQUIRED, "What it is doing, or was last."},
    {"job", "progress", "number", REQUIRED, "From 0 to 1; it never falls."},
    {"job", "mesh", "text?", REQUIRED, "Null while it has no id."},
    {"job", "created", "time", REQUIRED, NULL},
    {"job", "started", "time?", REQUIRED, NULL},
    {"job", "finished", "time?", REQUIRED, NULL},
    {"job", "status", "integer?", REQUIRED, "What the request would have been answered with."},
    {"job", "location", "text?", REQUIRED, "Likewise."},
    {"job", "result", "#job_result?", OPTIONAL,
     "Likewise; null where it has no body or was too large to keep."},
    {"job", "problem", "#problem?", OPTIONAL, "In its place, where that is a refusal."},

    {"job_page", "items", "*#job", REQUIRED, NULL},
    {"job_page", "next", "text?", REQUIRED, "The cursor of the next page."},

    {"summary", "id", "text", REQUIRED, NULL},
    {"summary", "name", "text", REQUIRED, NULL},
    {"summary", "revision", "count", REQUIRED, NULL},
    {"summary", "counts", "#counts", REQUIRED, NULL},
    {"summary", "euler", "integer", REQUIRED, "Used vertices - edges + faces."},
    {"summary", "genus", "integer?", REQUIRED, "Null where a bow-tie makes it meaningless."},
    {"summary", "closed", "flag", REQUIRED, "No boundary, and at least one face."},
    {"summary", "manifold", "flag", REQUIRED, "No bow-tie, and at least one face."},
    {"summary", "degrees", "#degrees", REQUIRED, "How many faces have each degree."},
    {"summary", "bbox", "#box?", REQUIRED, NULL},
    {"summary", "area", "number", REQUIRED, NULL},
    {"summary", "volume", "number?", REQUIRED, "Null unless closed."},
    {"summary", "memory_bytes", "count", REQUIRED, NULL},
    {"summary", "created", "time", REQUIRED, NULL},
    {"summary", "modified", "time", REQUIRED, NULL},

    {"import", "format", "text", REQUIRED, NULL},
    {"import", "vertices", "count", REQUIRED, NULL},
    {"import", "faces", "count", REQUIRED, NULL},
    {"import", "attributes", "*#attribute_read", OPTIONAL, "Those the body has, if any."},
    {"import", "repairs", "*#repair", REQUIRED, "What was asked for, in the order it was done."},
    {"import", "warnings", "*#warning", REQUIRED, NULL},
    {"import", "more_warnings", "count", OPTIONAL, "How many are not listed."},

    {"attribute_read", "domain", "#domain", REQUIRED, NULL},
    {"attribute_read", "name", "text", REQUIRED, NULL},

    {"warning", "code", "text", REQUIRED, NULL},
    {"warning", "detail", "text", REQUIRED, NULL},
    {"warning", "count", "count", REQUIRED, "How often."},
    {"warning", "line", "count", OPTIONAL, "Where first, in a text."},
    {"warning", "byte", "count", OPTIONAL, "Where first, in a binary file."},
    {"warning", "lines", "*count", OPTIONAL, "Where, of the first 100 of all warnings."},
    {"warning", "bytes", "*count", OPTIONAL, "The same in a binary file."},
    {"warning", "vertices", "*id", OPTIONAL, "bowtie, isolated_vertices: the first 100."},

    {"repair", "repair", "#repair_name", REQUIRED, NULL},
    {"repair", "count", "count", REQUIRED,
     "Vertices or faces gone, faces turned, or what was made."},
    {"repair", "gone", "*id", OPTIONAL, "The first 100, numbered from 0 as in the body."},
    {"repair", "into", "*id", OPTIONAL, "For each of these the id of the one that is kept."},
    {"repair", "lines", "*count", OPTIONAL, "For each its line."},
    {"repair", "bytes", "*count", OPTIONAL, "For each its first byte, in a binary file."},
    {"repair", "faces", "*id", OPTIONAL, "orient, fill: the first 100 turned or made."},
    {"repair", "components", "count", OPTIONAL, "orient: in which faces were turned."},
    {"repair", "not_orientable", "count", OPTIONAL, "orient: components that are left to split."},
    {"repair", "clashes", "*id", OPTIONAL, "A face of each of these, of the first 100."},
    {"repair", "vertices", "count", OPTIONAL, "split: how many had several fans."},
    {"repair", "parents", "#parents", OPTIONAL, "split: the first 100."},
    {"repair", "left", "count", OPTIONAL, "fill: boundary loops that stay."},
    {"repair", "tolerance", "number", OPTIONAL, "weld: the one that was used."},
    {"repair", "hole_edges", "count", OPTIONAL, "fill: the one that was used."},

    {"imported", "import", "#import", REQUIRED, "What was read and repaired."},

    {"vertex", "id", "id", REQUIRED, NULL},
    {"vertex", "position", "point", REQUIRED, NULL},
    {"vertex", "halfedge", "id?", REQUIRED, "One that leaves it; a boundary one if there is any."},
    {"vertex", "degree", "count", REQUIRED, "Edges."},
    {"vertex", "boundary", "flag", REQUIRED, NULL},
    {"vertex", "isolated", "flag", REQUIRED, NULL},
    {"vertex", "attributes", "#values_by_name", OPTIONAL, "Values by name, where there are any."},

    {"halfedge", "id", "id", REQUIRED, NULL},
    {"halfedge", "twin", "id", REQUIRED, NULL},
    {"halfedge", "next", "id", REQUIRED, NULL},
    {"halfedge", "prev", "id", REQUIRED, NULL},
    {"halfedge", "origin", "id", REQUIRED, NULL},
    {"halfedge", "target", "id", REQUIRED, NULL},
    {"halfedge", "edge", "id", REQUIRED, NULL},
    {"halfedge", "face", "id?", REQUIRED, "Null on the boundary."},
    {"halfedge", "boundary", "flag", REQUIRED, NULL},
    {"halfedge", "attributes", "#values_by_name", OPTIONAL, "Values by name, where there are any."},

    {"edge", "id", "id", REQUIRED, NULL},
    {"edge", "halfedges", "#pair", REQUIRED, "2 * id and 2 * id + 1."},
    {"edge", "vertices", "#pair", REQUIRED, "Origins of the two half-edges."},
    {"edge", "faces", "#sides", REQUIRED, "Beside the two half-edges."},
    {"edge", "length", "number", REQUIRED, NULL},
    {"edge", "boundary", "flag", REQUIRED, NULL},
    {"edge", "attributes", "#values_by_name", OPTIONAL, "Values by name, where there are any."},

    {"face", "id", "id", REQUIRED, NULL},
    {"face", "halfedge", "id", REQUIRED, NULL},
    {"face", "degree", "count", REQUIRED, "Corners."},
    {"face", "vertices", "*id", REQUIRED, "Counter-clockwise from the half-edge's origin."},
    {"face", "halfedges", "*id", REQUIRED, NULL},
    {"face", "area", "number", REQUIRED, "Of the vector (Newell) area."},
    {"face", "normal", "point", REQUIRED, "Zero where the face is degenerate."},
    {"face", "centroid", "point", REQUIRED, NULL},
    {"face", "attributes", "#values_by_name", OPTIONAL, "Values by name, where there are any."},

    {"attribute_info", "domain", "#domain", REQUIRED, NULL},
    {"attribute_info", "name", "text", REQUIRED, NULL},
    {"attribute_info", "type", "#type_name", REQUIRED, NULL},
    {"attribute_info", "components", "count", REQUIRED, "Numbers of one value."},
    {"attribute_info", "rule", "#rule_name", REQUIRED, NULL},
    {"attribute_info", "default", "#value", REQUIRED, "The value where nothing was written."},
    {"attribute_info", "labels", "*text", OPTIONAL, "In the list: what values index."},
    {"attribute_info", "bytes", "count", REQUIRED, "Of the values as octets."},

    {"attribute_list", "revision", "count", REQUIRED, NULL},
    {"attribute_list", "attributes", "*#attribute_info", REQUIRED, NULL},

    {"attribute_values", "revision", "count", REQUIRED, NULL},
    {"attribute_values", "domain", "#domain", REQUIRED, NULL},
    {"attribute_values", "name", "text", REQUIRED, NULL},
    {"attribute_values", "type", "#type_name", REQUIRED, NULL},
    {"attribute_values", "components", "count", REQUIRED, NULL},
    {"attribute_values", "rule", "#rule_name", REQUIRED, NULL},
    {"attribute_values", "default", "#value", REQUIRED, NULL},
    {"attribute_values", "bytes", "count", REQUIRED, NULL},
    {"attribute_values", "ids", "*id", REQUIRED, NULL},
    {"attribute_values", "values", "*#value", REQUIRED, "One for each id; arrays of components."},
    {"attribute_values", "next", "text?", REQUIRED, "The cursor of the next page."},

    {"attribute_written", "revision", "count", REQUIRED, NULL},
    {"attribute_written", "dry_run", "flag", OPTIONAL, "Nothing was done."},
    {"attribute_written", "attribute", "#attribute_info", OPTIONAL, "Unless it was deleted."},
    {"attribute_written", "created", "#sets", REQUIRED, "Empty."},
    {"attribute_written", "deleted", "#sets", REQUIRED, "Empty."},
    {"attribute_written", "modified", "#sets", REQUIRED, "Empty where it came or went whole."},
    {"attribute_written", "parents", "#parents", REQUIRED, "Empty."},
    {"attribute_written", "merged", "#merged", REQUIRED, "Empty."},
    {"attribute_written", "undoable", "flag", OPTIONAL,
     "Only when false: it is larger than the undo budget. It cannot be undone, and neither can "
     "what "
     "came before."},

    {"element_page", "revision", "count", REQUIRED, NULL},
    {"element_page", "items", "*#element", REQUIRED, NULL},
    {"element_page", "next", "text?", REQUIRED, "The cursor of the next page."},

    {"adjacency", "revision", "count", OPTIONAL, "Once beside many results."},
    {"adjacency", "of", "#of", REQUIRED, NULL},
    {"adjacency", "relation", "text", REQUIRED, NULL},
    {"adjacency", "ids", "*id", REQUIRED, NULL},

    {"dense", "offsets", "*count", REQUIRED, "n + 1 of them into ids."},
    {"dense", "ids", "*id", REQUIRED, NULL},

    {"loop", "halfedge", "id", REQUIRED, NULL},
    {"loop", "length", "count", REQUIRED, "Half-edges."},
    {"loop", "halfedges", "*id", REQUIRED, NULL},
    {"loop", "vertices", "*id", REQUIRED, "Origins of the half-edges."},

    {"boundaries", "revision", "count", REQUIRED, NULL},
    {"boundaries", "loops", "*#loop", REQUIRED, NULL},

    {"component", "faces", "count", REQUIRED, NULL},
    {"component", "vertices", "count", REQUIRED, NULL},
    {"component", "face", "id", REQUIRED, "One of its faces."},

    {"components", "revision", "count", REQUIRED, NULL},
    {"components", "by", "#connection", REQUIRED, NULL},
    {"components", "components", "*#component", REQUIRED, NULL},

    {"broken", "rule", "text", REQUIRED, "I1 to I12."},
    {"broken", "kind", "#element_kind", REQUIRED, NULL},
    {"broken", "id", "id", REQUIRED, NULL},
    {"broken", "detail", "text", REQUIRED, NULL},

    {"defect", "code", "text", REQUIRED, NULL},
    {"defect", "kind", "#element_kind", REQUIRED, NULL},
    {"defect", "id", "id", REQUIRED, NULL},
    {"defect", "detail", "text", REQUIRED, NULL},

    {"check", "revision", "count", REQUIRED, NULL},
    {"check", "valid", "flag", REQUIRED, NULL},
    {"check", "problems", "*#broken", REQUIRED, "Broken invariants."},
    {"check", "defects", "*#defect", REQUIRED, "What a valid mesh may have, such as a bow-tie."},
    {"check", "totals", "#totals", REQUIRED, "How many there are of each; 100 of each are listed."},

    {"sets", "vertices", "*id", REQUIRED, NULL},
    {"sets", "edges", "*id", REQUIRED, "Half-edges of edge e are 2e and 2e + 1."},
    {"sets", "faces", "*id", REQUIRED, NULL},

    {"parents", "vertices", "*#pair", OPTIONAL, "Pairs: child, parent."},
    {"parents", "edges", "*#pair", OPTIONAL, NULL},
    {"parents", "faces", "*#pair", OPTIONAL, NULL},

    {"merged", "vertices", "*#pair", OPTIONAL, "Pairs: what went, what it became part of."},
    {"merged", "edges", "*#pair", OPTIONAL, NULL},
    {"merged", "faces", "*#pair", OPTIONAL, NULL},

    {"edited", "revision", "count", REQUIRED, NULL},
    {"edited", "dry_run", "flag", OPTIONAL, "Nothing was done: the revision and ids are to be."},
    {"edited", "results", "*#done", REQUIRED, "One object an operation: `op` and its results."},
    {"edited", "created", "#sets", REQUIRED, NULL},
    {"edited", "deleted", "#sets", REQUIRED, NULL},
    {"edited", "modified", "#sets", REQUIRED, "Live before and after, with another link or value."},
    {"edited", "parents", "#parents", REQUIRED, NULL},
    {"edited", "merged", "#merged", REQUIRED, NULL},
    {"edited", "replaced", "flag", OPTIONAL, "All ids are new; `results` has the maps."},
    {"edited", "undoable", "flag", OPTIONAL,
     "Only when false: the edit is larger than the undo budget, or a compact. It cannot be undone, "
     "and neither can what came before."},
    {"edited", "undo", "count", OPTIONAL, "After undo and redo: steps that can be undone."},
    {"edited", "redo", "count", OPTIONAL, "After undo and redo: steps that can be done again."},

    {"counted", "vertices", "count", REQUIRED, NULL},
    {"counted", "edges", "count", REQUIRED, NULL},
    {"counted", "faces", "count", REQUIRED, NULL},

    {"entry", "revision", "count", REQUIRED, NULL},
    {"entry", "action", "#action", REQUIRED, NULL},
    {"entry", "inverts", "count", OPTIONAL, "Revision it undid or did again."},
    {"entry", "ops", "*text", REQUIRED, NULL},
    {"entry", "created", "#counted", OPTIONAL, "How many elements, where that is known."},
    {"entry", "deleted", "#counted", OPTIONAL, NULL},
    {"entry", "modified", "#counted", OPTIONAL, NULL},
    {"entry", "undoable", "flag", REQUIRED, "Is it on the undo stack?"},
    {"entry", "bytes", "count", REQUIRED, "What undoing it keeps in memory."},
    {"entry", "time", "time", REQUIRED, NULL},

    {"history", "revision", "count", REQUIRED, NULL},
    {"history", "entries", "*#entry", REQUIRED, "Newest first."},
    {"history", "undo", "count", REQUIRED, "Steps that can be undone."},
    {"history", "redo", "count", REQUIRED, "Steps that can be done again."},
    {"history", "oldest", "count", REQUIRED, "Revision that can still be read and undone to."},
    {"history", "dropped", "count", REQUIRED, "Entries, to keep within the undo budget."},
    {"history", "bytes", "count", REQUIRED, "What entries and their deltas take."},
    {"history", "budget", "count", REQUIRED, "What they may take: the flag --undo-budget."},
    {"history", "next", "text?", REQUIRED, "The cursor of the next page."},

    {"found", "halfedge", "id?", REQUIRED, "From the first vertex to the second."},

    {"measured", "revision", "count", REQUIRED, NULL},
    {"measured", "of", "#of", REQUIRED, NULL},
    {"measured", "measure", "#measure_name", REQUIRED, NULL},
    {"measured", "value", "#measured_value", REQUIRED, "Null where there is none."},

    {"measured_many", "measure", "#measure_name", REQUIRED, NULL},
    {"measured_many", "components", "count", REQUIRED, "1, or 3 of a vector."},
    {"measured_many", "values", "*#measured_value", REQUIRED, "One for each element."},

    {"share", "vertex", "id", REQUIRED, NULL},
    {"share", "weight", "number", REQUIRED, "Above 0; all of a place sum to 1."},

    {"place", "face", "id", REQUIRED, "The one with the least id where there are several."},
    {"place", "distance", "number", REQUIRED, NULL},
    {"place", "point", "point", REQUIRED, NULL},
    {"place", "barycentric", "+#share", REQUIRED,
     "Of the face's triangle: 3 corners, 2 on an edge of it, 1 at a vertex."},

    {"ray_hit", "hit", "#place?", REQUIRED, "Null where the ray meets nothing."},

    {"nearest", "closest", "#place?", REQUIRED, "Null where no face is near enough."},

    {"intersections", "pairs", "*#pair", REQUIRED, "Faces, the lesser id first; in rising order."},
    {"intersections", "total", "count", REQUIRED, "Pairs that were found."},
    {"intersections", "complete", "flag", REQUIRED, "When false there may be more."},

    {"query_results", "revision", "count", REQUIRED, NULL},
    {"query_results", "results", "*#answer", REQUIRED, "In the order of the questions."},

    {"walked", "revision", "count", REQUIRED, NULL},
    {"walked", "walk", "#walk_name", REQUIRED, NULL},
    {"walked", "from", "#of", REQUIRED, NULL},
    {"walked", "to", "#of", OPTIONAL, "shortest_path"},
    {"walked", "path", "*#step_name", OPTIONAL, "path"},
    {"walked", "repeat", "count", OPTIONAL, "path"},
    {"walked", "until", "text", OPTIONAL, "path"},
    {"walked", "depth", "count", OPTIONAL, "rings, breadth_first"},
    {"walked", "limit", "count", OPTIONAL, "breadth_first"},
    {"walked", "by", "text", OPTIONAL, "shortest_path"},
    {"walked", "halfedges", "*id", OPTIONAL, "path, loop"},
    {"walked", "end", "id", OPTIONAL, "path: the last half-edge"},
    {"walked", "vertices", "*id?", OPTIONAL, "loop, shortest_path; null: unreachable"},
    {"walked", "face", "id?", OPTIONAL, "loop"},
    {"walked", "rings", "**id", OPTIONAL, "rings"},
    {"walked", "ids", "*id", OPTIONAL, "breadth_first"},
    {"walked", "depths", "*count", OPTIONAL, "breadth_first"},
    {"walked", "edges", "*id?", OPTIONAL, "shortest_path, edge_loop, edge_ring"},
    {"walked", "length", "number?", OPTIONAL, "shortest_path"},
    {"walked", "closed", "flag", OPTIONAL, "edge_loop, edge_ring"},

    {"parameter", "name", "text", REQUIRED, NULL},
    {"parameter", "plural", "text", OPTIONAL, "Name of the list that may be given instead."},
    {"parameter", "set", "flag", OPTIONAL, "A set may stand for the list: {\"selected\":true}."},
    {"parameter", "type", "text", REQUIRED, NULL},
    {"parameter", "required", "flag", REQUIRED, NULL},
    {"parameter", "nullable", "flag", OPTIONAL, NULL},
    {"parameter", "group", "text", OPTIONAL, "Of parameters of one group one is given."},
    {"parameter", "default", "#scalar", OPTIONAL, NULL},
    {"parameter", "min", "number", OPTIONAL, NULL},
    {"parameter", "max", "number", OPTIONAL, NULL},
    {"parameter", "exclusive", "flag", OPTIONAL, "min and max are not in the range."},
    {"parameter", "choices", "*text", OPTIONAL, NULL},
    {"parameter", "doc", "text", REQUIRED, NULL},

    {"result", "name", "text", REQUIRED, NULL},
    {"result", "type", "text", REQUIRED, NULL},
    {"result", "doc", "text", REQUIRED, NULL},

    {"operation_row", "name", "text", REQUIRED, NULL},
    {"operation_row", "doc", "text", REQUIRED, NULL},
    {"operation_row", "size", "#op_size", REQUIRED, "local or whole."},
    {"operation_row", "params", "*#parameter", REQUIRED, NULL},
    {"operation_row", "results", "*#result", REQUIRED, NULL},
    {"operation_row", "refusals", "*text", REQUIRED, NULL},
    {"operation_row", "change", "#triple?", REQUIRED, "In V, E, F; null where it varies."},

    {"operations", "operations", "*#operation_row", REQUIRED, NULL},

    {"health", "status", "#health_name", REQUIRED, NULL},

    {"version", "name", "text", REQUIRED, NULL},
    {"version", "version", "text", REQUIRED, NULL},

    {"problem_element", "kind", "#element_kind", REQUIRED, NULL},
    {"problem_element", "id", "id", REQUIRED, NULL},
    {"problem_element", "code", "text", OPTIONAL, NULL},
    {"problem_element", "detail", "text", OPTIONAL, NULL},
    {"problem_element", "pointer", "text", OPTIONAL, NULL},

    {"problem", "type", "text", REQUIRED, "A page this server serves."},
    {"problem", "title", "text", REQUIRED, NULL},
    {"problem", "status", "integer", REQUIRED, NULL},
    {"problem", "detail", "text", REQUIRED, NULL},
    {"problem", "code", "text", REQUIRED, "Stable."},
    {"problem", "pointer", "text", OPTIONAL, "JSON pointer into the body."},
    {"problem", "element", "#problem_element", OPTIONAL, NULL},
    {"problem", "elements", "*#problem_element", OPTIONAL, "The first 100."},
    {"problem", "total", "count", OPTIONAL, "How many there are in all."},
    {"problem", "repair", "*#repair_name", OPTIONAL, "The body passes with these repairs."},
    {"problem", "revision", "count", OPTIONAL, "The present one, with 412."},
    {"problem", "supported", "*text", OPTIONAL, "With 406 and 415."},
    {"problem", "request_id", "text", OPTIONAL, NULL},
};

static const member requests[] = {
    {"document", "name", "text?", OPTIONAL, NULL},
    {"document", "vertices", "*point", OPTIONAL, NULL},
    {"document", "faces", "**index", OPTIONAL, "Vertices counter-clockwise, counted from 0."},
    {"document", "attributes", "*#document_attribute", OPTIONAL, "Of any domain."},

    {"document_attribute", "domain", "#domain", REQUIRED, NULL},
    {"document_attribute", "name", "#attribute_name", REQUIRED, NULL},
    {"document_attribute", "type", "#type_name", REQUIRED, NULL},
    {"document_attribute", "components", "count", OPTIONAL, "1 to 16; 1 if not said."},
    {"document_attribute", "rule", "#rule_name", OPTIONAL, NULL},
    {"document_attribute", "default", "#value", OPTIONAL, NULL},
    {"document_attribute", "labels", "+#label", OPTIONAL, NULL},
    {"document_attribute", "values", "*#value", OPTIONAL,
     "One for each element, or none. Edges come as the faces run along them first, half-edges by "
     "edges, that of the first face before its twin."},

    {"attribute", "type", "#type_name", REQUIRED, NULL},
    {"attribute", "components", "count", OPTIONAL, "1 to 16; 1 if not said."},
    {"attribute", "rule", "#rule_name", OPTIONAL,
     "interpolate for float and double, else copy, if not said."},
    {"attribute", "default", "#value", OPTIONAL, "Zero or false if not said."},
    {"attribute", "labels", "+#label", OPTIONAL, "Of a uint32: what its values index."},
    {"attribute", "values", "*#value", OPTIONAL, "One for each live element, in the order of ids."},
    {"attribute", "value", "#value", OPTIONAL, "One for all instead."},
    {"attribute", "expected_revision", "count", OPTIONAL, NULL},
    {"attribute", "dry_run", "flag", OPTIONAL, NULL},

    {"attribute_patch", "ids", "#ids_or_set", REQUIRED, "Ids, \"all\", or {\"NAME\":true}."},
    {"attribute_patch", "values", "*#value", OPTIONAL, "One for each id."},
    {"attribute_patch", "value", "#value", OPTIONAL, "One for all instead."},
    {"attribute_patch", "expected_revision", "count", OPTIONAL, NULL},
    {"attribute_patch", "dry_run", "flag", OPTIONAL, NULL},

    {"mesh_patch", "name", "text?", OPTIONAL, "null removes it."},

    {"copy", "id", "text", OPTIONAL, NULL},
    {"copy", "name", "text", OPTIONAL, NULL},

    {"step", "expected_revision", "count", OPTIONAL, NULL},
    {"step", "steps", "count", OPTIONAL, "How many; 1 without."},
    {"step", "to_revision", "count", OPTIONAL, "As many as lead to its content, or none."},

    {"relation_query", "relation", "text", REQUIRED, NULL},
    {"relation_query", "of", "#of_any", REQUIRED, NULL},
    {"relation_query", "cw", "flag", OPTIONAL, NULL},

    {"find_query", "find", "text", REQUIRED, "halfedge"},
    {"find_query", "vertices", "*id", REQUIRED, "From, to."},

    {"get_query", "get", "#of", REQUIRED, NULL},

    {"measure_query", "measure", "#measure_name", REQUIRED, "Which there are depends on the kind."},
    {"measure_query", "of", "#of_any", REQUIRED, NULL},
    {"measure_query", "weights", "#weights", OPTIONAL,
     "Normals of vertices: how faces share in them; angle if not said."},
    {"measure_query", "crease", "number", OPTIONAL,
     "Normals of half-edges, needed there: the angle in radians, 0 to pi, beyond which an edge "
     "stays sharp."},

    {"ray", "origin", "point", REQUIRED, NULL},
    {"ray", "direction", "point", REQUIRED, "Of any length but zero."},
    {"ray", "max", "number", OPTIONAL, "The distance it reaches; without, any."},

    {"ray_query", "ray", "#ray", REQUIRED, NULL},

    {"closest_query", "closest", "point", REQUIRED, NULL},
    {"closest_query", "max", "number", OPTIONAL, "The distance to look in; without, any."},

    {"pair_limit", "limit", "count", OPTIONAL, "Pairs to list; 100 without."},

    {"intersections_query", "self_intersections", "#pair_limit", REQUIRED,
     "Pairs of faces that share a point which is no corner of both."},

    {"query", "queries", "*#question", REQUIRED, NULL},

    {"walk", "walk", "#walk_name", REQUIRED, NULL},
    {"walk", "from", "#of", REQUIRED, NULL},
    {"walk", "to", "#of", OPTIONAL, "shortest_path"},
    {"walk", "path", "+#step_name", OPTIONAL, "path"},
    {"walk", "repeat", "count", OPTIONAL, "path"},
    {"walk", "until", "text", OPTIONAL, "path: start or boundary"},
    {"walk", "depth", "count", OPTIONAL, "rings, breadth_first"},
    {"walk", "limit", "count", OPTIONAL, "breadth_first"},
    {"walk", "by", "text", OPTIONAL, "shortest_path: length or edges"},

    {"edit_list", "ops", "+#operation", REQUIRED, NULL},
    {"edit_list", "expected_revision", "count", OPTIONAL, NULL},
    {"edit_list", "dry_run", "flag", OPTIONAL, NULL},
};

/* Schemas that are not a list of members, as JSON Schema. */
static const struct {
    const char *name, *json;
} others[] = {
    {"id", "{\"type\":\"integer\",\"minimum\":0,\"maximum\":4294967293}"},
    {"id_or_null", "{\"oneOf\":[{\"$ref\":\"#/components/schemas/id\"},"
                   "{\"type\":\"null\"}]}"},
    {"reference",
     "{\"type\":\"string\",\"pattern\":\"^\\\\$[A-Za-z_][A-Za-z0-9_]*\\\\.[a-z_]+(\\\\.[0-9]+)?$\","
     "\"description\":\"A result of an earlier operation of the list.\"}"},
    {"id_or_reference", "{\"oneOf\":[{\"$ref\":\"#/components/schemas/id\"},"
                        "{\"$ref\":\"#/components/schemas/reference\"}]}"},
    {"point", "{\"type\":\"array\",\"items\":{\"type\":\"number\"},\"minItems\":3,"
              "\"maxItems\":3}"},
    {"points", "{\"oneOf\":[{\"$ref\":\"#/components/schemas/point\"},{\"type\":\"array\","
               "\"items\":{\"$ref\":\"#/components/schemas/point\"},\"minItems\":1}]}"},
    {"mesh_id", "{\"type\":\"string\",\"pattern\":\"^[A-Za-z0-9._-]{1,64}$\"}"},
    {"matrix", "{\"type\":\"array\",\"items\":{\"type\":\"number\"},\"minItems\":16,"
               "\"maxItems\":16,\"description\":\"Row-major, last row 0 0 0 1.\"}"},
    {"value", "{\"oneOf\":[{\"$ref\":\"#/components/schemas/plain\"},{\"type\":\"array\","
              "\"items\":{\"$ref\":\"#/components/schemas/plain\"},\"minItems\":2,"
              "\"maxItems\":16}]}"},
    {"plain", "{\"type\":[\"number\",\"boolean\"]}"},
    {"values_by_name", "{\"type\":\"object\",\"additionalProperties\":"
                       "{\"$ref\":\"#/components/schemas/value\"},\"minProperties\":1}"},
    {"domain", "{\"enum\":[\"vertices\",\"halfedges\",\"edges\",\"faces\",\"mesh\"]}"},
    {"attribute_name", "{\"type\":\"string\",\"minLength\":1,\"maxLength\":63,\"description\":"
                       "\"At most 63 bytes of UTF-8; `position` is built in.\"}"},
    {"type_name", "{\"enum\":[\"bool\",\"int32\",\"uint32\",\"float\",\"double\"]}"},
    {"rule_name", "{\"enum\":[\"copy\",\"interpolate\",\"default\"]}"},
    {"label", "{\"type\":\"string\",\"maxLength\":1024}"},
    {"set", "{\"type\":\"object\",\"additionalProperties\":{\"const\":true},"
            "\"minProperties\":1,\"maxProperties\":1,\"description\":\"The live elements "
            "whose bool attribute of this name is true; none changes nothing.\"}"},
    {"ids_or_set", "{\"oneOf\":[{\"type\":\"array\",\"items\":"
                   "{\"$ref\":\"#/components/schemas/id\"},\"minItems\":1},"
                   "{\"const\":\"all\"},{\"$ref\":\"#/components/schemas/set\"}]}"},
    {"pair", "{\"type\":\"array\",\"items\":{\"$ref\":\"#/components/schemas/id\"},\"minItems"
             "\":2,\"maxItems\":2}"},
    {"sides", "{\"type\":\"array\",\"items\":{\"$ref\":\"#/components/schemas/id_or_null\"},\"m"
              "inItems\":2,\"maxItems\":2}"},
    {"triple", "{\"type\":\"array\",\"items\":{\"type\":\"integer\"},\"minItems\":3,\"maxItems\""
               ":3}"},
    {"scalar", "{\"type\":[\"number\",\"boolean\",\"string\"]}"},
    {"degrees", "{\"type\":\"object\",\"propertyNames\":{\"pattern\":\"^[0-9]+$\"},\"additionalPr"
                "operties\":{\"type\":\"integer\",\"minimum\":1}}"},
    {"totals", "{\"type\":\"object\",\"properties\":{\"problems\":{\"type\":\"integer\",\"minimu"
               "m\":0}},\"required\":[\"problems\"],\"additionalProperties\":{\"type\":\"integer"
               "\",\"minimum\":0}}"},
    {"element_kind", "{\"enum\":[\"vertex\",\"halfedge\",\"edge\",\"face\",\"mesh\"]}"},
    {"repair_name", "{\"enum\":[\"weld\",\"drop_degenerate\",\"drop_duplicates\",\"orient\","
                    "\"split\",\"fill\"]}"},
    {"op_size", "{\"enum\":[\"local\",\"whole\"]}"},
    {"action", "{\"enum\":[\"edit\",\"undo\",\"redo\",\"replace\"]}"},
    {"connection", "{\"enum\":[\"edge\",\"vertex\"]}"},
    {"description",
     "{\"type\":\"object\",\"required\":[\"openapi\",\"info\",\"servers\",\"security\""
     ",\"paths\",\"components\"],\"properties\":{\"openapi\":{\"const\":\"3.1.0\"},\"i"
     "nfo\":{\"$ref\":\"#/components/schemas/any_members\"},\"servers\":{\"type\":\"ar"
     "ray\",\"items\":{\"$ref\":\"#/components/schemas/any_members\"},\"minItems\":1},"
     "\"security\":{\"type\":\"array\",\"maxItems\":0},\"paths\":{\"$ref\":\"#/compone"
     "nts/schemas/any_members\"},\"components\":{\"$ref\":\"#/components/schemas/any_m"
     "embers\"}}}"},
    {"any_members",
     "{\"type\":\"object\",\"additionalProperties\":true,\"minProperties\":1,\"descrip"
     "tion\":\"As OpenAPI 3.1 says.\"}"},
    {"job_state", "{\"enum\":[\"queued\",\"running\",\"done\",\"failed\",\"cancelled\"]}"},
    {"job_result", "{\"anyOf\":[{\"$ref\":\"#/components/schemas/edited\"},"
                   "{\"$ref\":\"#/components/schemas/created\"},"
                   "{\"$ref\":\"#/components/schemas/summary\"}]}"},
    {"health_name", "{\"enum\":[\"alive\",\"ready\"]}"},
    {"element", "{\"oneOf\":[{\"$ref\":\"#/components/schemas/vertex\"},"
                "{\"$ref\":\"#/components/schemas/halfedge\"},"
                "{\"$ref\":\"#/components/schemas/edge\"},"
                "{\"$ref\":\"#/components/schemas/face\"}]}"},
    {"created", "{\"allOf\":[{\"$ref\":\"#/components/schemas/summary\"},"
                "{\"$ref\":\"#/components/schemas/imported\"}]}"},
    {"create", "{\"oneOf\":[{\"$ref\":\"#/components/schemas/document\"},"
               "{\"$ref\":\"#/components/schemas/shape\"}]}"},
    {"answer", "{\"anyOf\":[{\"$ref\":\"#/components/schemas/adjacency\"},"
               "{\"$ref\":\"#/components/schemas/dense\"},"
               "{\"$ref\":\"#/components/schemas/walked\"},"
               "{\"$ref\":\"#/components/schemas/found\"},"
               "{\"$ref\":\"#/components/schemas/measured\"},"
               "{\"$ref\":\"#/components/schemas/measured_many\"},"
               "{\"$ref\":\"#/components/schemas/ray_hit\"},"
               "{\"$ref\":\"#/components/schemas/nearest\"},"
               "{\"$ref\":\"#/components/schemas/intersections\"},"
               "{\"$ref\":\"#/components/schemas/element\"},"
               "{\"$ref\":\"#/components/schemas/problem\"}]}"},
    {"of", "{\"type\":\"object\",\"propertyNames\":"
           "{\"enum\":[\"vertex\",\"halfedge\",\"edge\",\"face\"]},"
           "\"additionalProperties\":{\"$ref\":\"#/components/schemas/id\"},"
           "\"minProperties\":1,\"maxProperties\":1}"},
    {"of_many", "{\"type\":\"object\",\"propertyNames\":"
                "{\"enum\":[\"vertices\",\"halfedges\",\"edges\",\"faces\"]},"
                "\"additionalProperties\":{\"$ref\":\"#/components/schemas/ids_or_all\"},"
                "\"minProperties\":1,\"maxProperties\":1}"},
    {"ids_or_all", "{\"oneOf\":[{\"type\":\"array\",\"items\":"
                   "{\"$ref\":\"#/components/schemas/id\"}},{\"const\":\"all\"}]}"},
    {"of_any", "{\"oneOf\":[{\"$ref\":\"#/components/schemas/of\"},"
               "{\"$ref\":\"#/components/schemas/of_many\"}]}"},
    {"question", "{\"oneOf\":[{\"$ref\":\"#/components/schemas/relation_query\"},"
                 "{\"$ref\":\"#/components/schemas/find_query\"},"
                 "{\"$ref\":\"#/components/schemas/get_query\"},"
                 "{\"$ref\":\"#/components/schemas/measure_query\"},"
                 "{\"$ref\":\"#/components/schemas/ray_query\"},"
                 "{\"$ref\":\"#/components/schemas/closest_query\"},"
                 "{\"$ref\":\"#/components/schemas/intersections_query\"},"
                 "{\"$ref\":\"#/components/schemas/walk\"}]}"},
    {"measure_name",
     "{\"enum\":[\"normal\",\"area\",\"angle_defect\",\"mean_curvature\",\"gaussian_curvature\","
     "\"angle\",\"length\",\"dihedral\",\"cotangent\",\"centroid\"],\"description\":\"Of vertices "
     "normal, area (the mixed one), angle_defect, mean_curvature, gaussian_curvature; of "
     "half-edges "
     "angle and normal, at the corner; of edges length, dihedral (convex above 0), cotangent (the "
     "weight); of faces normal, area, centroid. Angles are in radians.\"}"},
    {"measured_value",
     "{\"oneOf\":[{\"type\":\"number\"},{\"$ref\":\"#/components/schemas/point\"},"
     "{\"type\":\"null\"}]}"},
    {"weights", "{\"enum\":[\"area\",\"angle\",\"uniform\"]}"},
    {"walk_name", "{\"enum\":[\"path\",\"loop\",\"rings\",\"breadth_first\",\"shortest_path\","
                  "\"edge_loop\",\"edge_ring\"]}"},
    {"step_name", "{\"enum\":[\"next\",\"prev\",\"twin\"]}"},
    {"edit", "{\"oneOf\":[{\"$ref\":\"#/components/schemas/edit_one\"},"
             "{\"$ref\":\"#/components/schemas/edit_list\"}]}"},
};

void api_schema_choices(api_out *out, const char *key, const char *const *choices)
{
    api_out_key(out, key);
    api_out_array_begin(out);
    for (; *choices != NULL; choices++) {
        api_out_string(out, *choices);
    }
    api_out_array_end(out);
}

void api_schema_ref(api_out *out, const char *group, const char *name)
{
    char reference[128];
    snprintf(reference, sizeof reference, "#/components/%s/%s", group, name);
    api_out_object_begin(out);
    api_out_key_string(out, "$ref", reference);
    api_out_object_end(out);
}

void api_schema_ref_key(api_out *out, const char *key, const char *name)
{
    api_out_key(out, key);
    api_schema_ref(out, "schemas", name);
}

static void write_base(api_out *out, const char *type, size_t length)
{
    static const struct {
        const char *name, *json; /* the members of the schema object */
    } bases[] = {
        {"id", "\"$ref\":\"#/components/schemas/id\""},
        {"point", "\"$ref\":\"#/components/schemas/point\""},
        {"index", "\"type\":\"integer\",\"minimum\":0"},
        {"count", "\"type\":\"integer\",\"minimum\":0"},
        {"integer", "\"type\":\"integer\""},
        {"number", "\"type\":\"number\""},
        {"flag", "\"type\":\"boolean\""},
        {"text", "\"type\":\"string\""},
        {"time", "\"type\":\"string\",\"format\":\"date-time\""},
    };
    for (size_t i = 0; i < sizeof bases / sizeof bases[0]; i++) {
        if (strlen(bases[i].name) == length && memcmp(bases[i].name, type, length) == 0) {
            char json[96];
            int size = snprintf(json, sizeof json, "{%s}", bases[i].json);
            api_out_raw(out, json, (size_t)size);
            return;
        }
    }
    if (type[0] == '#') {
        char name[64];
        snprintf(name, sizeof name, "%.*s", (int)length - 1, type + 1);
        api_schema_ref(out, "schemas", name);
        return;
    }
    assert(!"a type of the table");
}

static void write_type(api_out *out, const char *type, size_t length, const char *doc)
{
    bool nullable = length > 0 && type[length - 1] == '?';
    if (nullable || doc != NULL) {
        api_out_object_begin(out);
        if (doc != NULL) {
            api_out_key_string(out, "description", doc);
        }
        api_out_key(out, nullable ? "anyOf" : "allOf");
        api_out_array_begin(out);
        write_type(out, type, nullable ? length - 1 : length, NULL);
        if (nullable) {
            api_out_raw(out, "{\"type\":\"null\"}", 15);
        }
        api_out_array_end(out);
        api_out_object_end(out);
    } else if (type[0] == '*' || type[0] == '+') {
        api_out_object_begin(out);
        api_out_key_string(out, "type", "array");
        if (type[0] == '+') {
            api_out_key_u64(out, "minItems", 1);
        }
        api_out_key(out, "items");
        write_type(out, type + 1, length - 1, NULL);
        api_out_object_end(out);
    } else {
        write_base(out, type, length);
    }
}

/* The schema whose rows begin at `rows`; returns how many those are. */
static size_t write_schema(api_out *out, const member *rows, size_t left, bool closed)
{
    size_t count = 0;
    while (count < left && strcmp(rows[count].schema, rows[0].schema) == 0) {
        count++;
    }
    api_out_key(out, rows[0].schema);
    api_out_object_begin(out);
    api_out_key_string(out, "type", "object");
    api_out_key(out, "properties");
    api_out_object_begin(out);
    for (size_t i = 0; i < count; i++) {
        api_out_key(out, rows[i].name);
        write_type(out, rows[i].type, strlen(rows[i].type), rows[i].doc);
    }
    api_out_object_end(out);
    api_out_key(out, "required");
    api_out_array_begin(out);
    for (size_t i = 0; i < count; i++) {
        if (rows[i].required) {
            api_out_string(out, rows[i].name);
        }
    }
    api_out_array_end(out);
    if (closed) {
        api_out_key_bool(out, "additionalProperties", false);
    }
    api_out_object_end(out);
    return count;
}

void api_schemas_write(api_out *out)
{
    for (size_t i = 0; i < sizeof others / sizeof others[0]; i++) {
        api_out_key(out, others[i].name);
        api_out_raw(out, others[i].json, strlen(others[i].json));
    }
    size_t count = sizeof answers / sizeof answers[0];
    for (size_t i = 0; i < count;) {
        i += write_schema(out, answers + i, count - i, false);
    }
    count = sizeof requests / sizeof requests[0];
    for (size_t i = 0; i < count;) {
        i += write_schema(out, requests + i, count - i, true);
    }
}
