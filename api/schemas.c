#include "api/schemas.h"

#include <stdio.h>
#include <string.h>

/* One member of one schema; rows of a schema stand together. A schema without a row for a member
 * may have it all the same in answers ("others may be added beside them"), but not in requests.
 *
 * Types: id, count, number, flag, text, point, box, time, any, #other for a schema by name; a star
 * before makes it an array (**id: arrays of ids), a plus one that is not empty, a question mark
 * behind lets the whole be null. */
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

    {"job", "id", "text", REQUIRED, "Who knows it may look and cancel."},
    {"job", "operation", "text", REQUIRED, "The operationId of the request."},
    {"job", "state", "text", REQUIRED, "queued, running, done, failed or cancelled."},
    {"job", "phase", "text?", REQUIRED, "What it is doing, or was last."},
    {"job", "progress", "number", REQUIRED, "From 0 to 1; it never falls."},
    {"job", "mesh", "text?", REQUIRED, "Null while it has no id."},
    {"job", "created", "time", REQUIRED, NULL},
    {"job", "started", "time?", REQUIRED, NULL},
    {"job", "finished", "time?", REQUIRED, NULL},
    {"job", "status", "integer?", REQUIRED, "What the request would have been answered with."},
    {"job", "location", "text?", REQUIRED, "Likewise."},
    {"job", "result", "any", OPTIONAL,
     "Likewise; null where it has no body or was too large to keep."},
    {"job", "problem", "any", OPTIONAL, "In its place, where that is a refusal."},

    {"job_page", "items", "*#job", REQUIRED, NULL},
    {"job_page", "next", "text?", REQUIRED, "The cursor of the next page."},

    {"summary", "id", "text", REQUIRED, NULL},
    {"summary", "name", "text", REQUIRED, NULL},
    {"summary", "revision", "count", REQUIRED, NULL},
    {"summary", "counts", "#counts", REQUIRED, NULL},
    {"summary", "euler", "integer", REQUIRED, "Used vertices - edges + faces."},
    {"summary", "genus", "integer?", REQUIRED, "Null where a bow-tie makes it meaningless."},
    {"summary", "closed", "flag", REQUIRED, NULL},
    {"summary", "manifold", "flag", REQUIRED, "No bow-tie."},
    {"summary", "degrees", "any", REQUIRED, "How many faces have each degree."},
    {"summary", "bbox", "#box?", REQUIRED, NULL},
    {"summary", "area", "number", REQUIRED, NULL},
    {"summary", "volume", "number?", REQUIRED, "Null unless closed."},
    {"summary", "memory_bytes", "count", REQUIRED, NULL},
    {"summary", "created", "time", REQUIRED, NULL},
    {"summary", "modified", "time", REQUIRED, NULL},

    {"import", "format", "text", REQUIRED, NULL},
    {"import", "vertices", "count", REQUIRED, NULL},
    {"import", "faces", "count", REQUIRED, NULL},
    {"import", "repairs", "*any", REQUIRED, NULL},
    {"import", "warnings", "*any", REQUIRED, NULL},
    {"import", "more_warnings", "count", OPTIONAL, "How many are not listed."},

    {"imported", "import", "#import", REQUIRED, "What was read and repaired."},

    {"vertex", "id", "id", REQUIRED, NULL},
    {"vertex", "position", "point", REQUIRED, NULL},
    {"vertex", "halfedge", "id?", REQUIRED, "One that leaves it; a boundary one if there is any."},
    {"vertex", "degree", "count", REQUIRED, "Edges."},
    {"vertex", "boundary", "flag", REQUIRED, NULL},
    {"vertex", "isolated", "flag", REQUIRED, NULL},

    {"halfedge", "id", "id", REQUIRED, NULL},
    {"halfedge", "twin", "id", REQUIRED, NULL},
    {"halfedge", "next", "id", REQUIRED, NULL},
    {"halfedge", "prev", "id", REQUIRED, NULL},
    {"halfedge", "origin", "id", REQUIRED, NULL},
    {"halfedge", "target", "id", REQUIRED, NULL},
    {"halfedge", "edge", "id", REQUIRED, NULL},
    {"halfedge", "face", "id?", REQUIRED, "Null on the boundary."},
    {"halfedge", "boundary", "flag", REQUIRED, NULL},

    {"edge", "id", "id", REQUIRED, NULL},
    {"edge", "halfedges", "*id", REQUIRED, "2 * id and 2 * id + 1."},
    {"edge", "vertices", "*id", REQUIRED, "Origins of the two half-edges."},
    {"edge", "faces", "*#id_or_null", REQUIRED, "Beside the two half-edges."},
    {"edge", "length", "number", REQUIRED, NULL},
    {"edge", "boundary", "flag", REQUIRED, NULL},

    {"face", "id", "id", REQUIRED, NULL},
    {"face", "halfedge", "id", REQUIRED, NULL},
    {"face", "degree", "count", REQUIRED, "Corners."},
    {"face", "vertices", "*id", REQUIRED, "Counter-clockwise from the half-edge's origin."},
    {"face", "halfedges", "*id", REQUIRED, NULL},
    {"face", "area", "number", REQUIRED, "Of the vector (Newell) area."},
    {"face", "normal", "point", REQUIRED, "Zero where the face is degenerate."},
    {"face", "centroid", "point", REQUIRED, NULL},

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
    {"components", "by", "text", REQUIRED, "edge or vertex."},
    {"components", "components", "*#component", REQUIRED, NULL},

    {"broken", "rule", "text", REQUIRED, "I1 to I12."},
    {"broken", "kind", "text", REQUIRED, NULL},
    {"broken", "id", "id", REQUIRED, NULL},
    {"broken", "detail", "text", REQUIRED, NULL},

    {"defect", "code", "text", REQUIRED, NULL},
    {"defect", "kind", "text", REQUIRED, NULL},
    {"defect", "id", "id", REQUIRED, NULL},
    {"defect", "detail", "text", REQUIRED, NULL},

    {"check", "revision", "count", REQUIRED, NULL},
    {"check", "valid", "flag", REQUIRED, NULL},
    {"check", "problems", "*#broken", REQUIRED, "Broken invariants."},
    {"check", "defects", "*#defect", REQUIRED, "What a valid mesh may have, such as a bow-tie."},
    {"check", "totals", "any", REQUIRED, "How many there are of each; 100 of each are listed."},

    {"sets", "vertices", "*id", REQUIRED, NULL},
    {"sets", "edges", "*id", REQUIRED, "Half-edges of edge e are 2e and 2e + 1."},
    {"sets", "faces", "*id", REQUIRED, NULL},

    {"parents", "vertices", "**id", OPTIONAL, "Pairs: child, parent."},
    {"parents", "edges", "**id", OPTIONAL, NULL},
    {"parents", "faces", "**id", OPTIONAL, NULL},

    {"merged", "vertices", "**id", OPTIONAL, "Pairs: what went, what it became part of."},
    {"merged", "edges", "**id", OPTIONAL, NULL},
    {"merged", "faces", "**id", OPTIONAL, NULL},

    {"edited", "revision", "count", REQUIRED, NULL},
    {"edited", "dry_run", "flag", OPTIONAL, "Nothing was done: the revision and ids are to be."},
    {"edited", "results", "*any", REQUIRED, "One object an operation: `op` and its results."},
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
    {"entry", "action", "text", REQUIRED, "edit, undo, redo or replace."},
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

    {"query_results", "revision", "count", REQUIRED, NULL},
    {"query_results", "results", "*#answer", REQUIRED, "In the order of the questions."},

    {"walked", "revision", "count", REQUIRED, NULL},
    {"walked", "walk", "text", REQUIRED, NULL},
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
    {"parameter", "type", "text", REQUIRED, NULL},
    {"parameter", "required", "flag", REQUIRED, NULL},
    {"parameter", "nullable", "flag", OPTIONAL, NULL},
    {"parameter", "group", "text", OPTIONAL, "Of parameters of one group one is given."},
    {"parameter", "default", "any", OPTIONAL, NULL},
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
    {"operation_row", "size", "text", REQUIRED, "local or whole."},
    {"operation_row", "params", "*#parameter", REQUIRED, NULL},
    {"operation_row", "results", "*#result", REQUIRED, NULL},
    {"operation_row", "refusals", "*text", REQUIRED, NULL},
    {"operation_row", "change", "*integer?", REQUIRED, "In V, E, F; null where it varies."},

    {"operations", "operations", "*#operation_row", REQUIRED, NULL},

    {"problem_element", "kind", "text", REQUIRED, NULL},
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
    {"problem", "revision", "count", OPTIONAL, "The present one, with 412."},
    {"problem", "supported", "*text", OPTIONAL, "With 406 and 415."},
    {"problem", "request_id", "text", OPTIONAL, NULL},
};

static const member requests[] = {
    {"document", "name", "text?", OPTIONAL, NULL},
    {"document", "vertices", "*point", OPTIONAL, NULL},
    {"document", "faces", "**index", OPTIONAL, "Vertices counter-clockwise, counted from 0."},

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
    {"matrix", "{\"type\":\"array\",\"items\":{\"type\":\"number\"},\"minItems\":16,"
               "\"maxItems\":16,\"description\":\"Row-major, last row 0 0 0 1.\"}"},
    {"any_object", "{\"type\":\"object\"}"},
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
                 "{\"$ref\":\"#/components/schemas/walk\"}]}"},
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
    api_out_raw(out, "{}", 2);
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
