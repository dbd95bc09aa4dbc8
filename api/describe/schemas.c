#include "api/describe/schemas.h"

#include "api/describe/schema_rows.h"
#include "query/adjacency.h"

#include <assert.h>
#include <stdio.h>
#include <string.h>

/* Schemas that the tables of members cannot express, as JSON Schema. */
static const struct {
    const char *name, *json;
} others[] = {
    {"id", "{\"type\":\"integer\",\"format\":\"int64\",\"minimum\":0,\"maximum\":4294967293}"},
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
    {"color", "{\"type\":\"array\",\"items\":{\"type\":\"number\",\"minimum\":0},\"minItems\":3,"
              "\"maxItems\":3,\"description\":\"Linear red, green and blue.\"}"},
    {"color_alpha", "{\"type\":\"array\",\"items\":{\"type\":\"number\",\"minimum\":0,\"maximum\":"
                    "1},\"minItems\":3,"
                    "\"maxItems\":4,\"description\":\"Linear red, green and blue, and opacity.\"}"},
    {"fraction", "{\"type\":\"number\",\"minimum\":0,\"maximum\":1}"},
    {"material_name", "{\"type\":\"string\",\"minLength\":1,\"maxLength\":1023,\"description\":"
                      "\"At most 1023 bytes of UTF-8 without control characters.\"}"},
    {"shown_name",
     "{\"type\":\"string\",\"pattern\":\"^[^\\\\u0000-\\\\u001F\\\\u007F-\\\\u009F"
     "\\\\u2028-\\\\u202E\\\\u2066-\\\\u2069]*$\",\"description\":\"A name that people see: "
     "without control characters, and without characters that end a line or change "
     "the direction of the text after them.\"}"},
    {"mesh_id", "{\"type\":\"string\",\"pattern\":\"^[A-Za-z0-9._-]{1,64}$\"}"},
    {"matrix", "{\"type\":\"array\",\"items\":{\"type\":\"number\"},\"minItems\":16,"
               "\"maxItems\":16,\"description\":\"Row-major, last row 0 0 0 1.\"}"},
    {"value", "{\"oneOf\":[{\"$ref\":\"#/components/schemas/plain\"},{\"type\":\"array\","
              "\"items\":{\"$ref\":\"#/components/schemas/plain\"},\"minItems\":2,"
              "\"maxItems\":16}]}"},
    {"plain", "{\"oneOf\":[{\"type\":\"number\"},{\"type\":\"boolean\"}]}"},
    {"values_by_name", "{\"type\":\"object\",\"additionalProperties\":"
                       "{\"$ref\":\"#/components/schemas/value\"},\"minProperties\":1}"},
    {"domain",
     "{\"type\":\"string\",\"enum\":[\"vertices\",\"halfedges\",\"edges\",\"faces\",\"mesh\"]}"},
    {"attribute_name", "{\"type\":\"string\",\"minLength\":1,\"maxLength\":63,\"description\":"
                       "\"At most 63 bytes of UTF-8; `position` is built in.\"}"},
    {"type_name",
     "{\"type\":\"string\",\"enum\":[\"bool\",\"int32\",\"uint32\",\"float\",\"double\"]}"},
    {"rule_name", "{\"type\":\"string\",\"enum\":[\"copy\",\"interpolate\",\"default\"]}"},
    {"client_id", "{\"type\":\"string\",\"maxLength\":40,\"pattern\":\"^[A-Za-z0-9._-]{1,40}$\"}"},
    {"label", "{\"type\":\"string\",\"maxLength\":1024}"},
    {"set", "{\"type\":\"object\",\"additionalProperties\":{\"oneOf\":[{\"type\":\"boolean\","
            "\"const\":true},{\"type\":\"integer\",\"format\":\"int64\"}]},"
            "\"minProperties\":1,\"maxProperties\":1,\"description\":\"The live elements "
            "whose bool attribute of this name is true, or whose int32 or uint32 attribute of "
            "this name has this value.\"}"},
    {"polygon", "{\"type\":\"array\",\"items\":{\"type\":\"array\",\"items\":{\"type\":"
                "\"number\"},\"minItems\":2,\"maxItems\":2},\"minItems\":3}"},
    {"matrix_projective", "{\"type\":\"array\",\"items\":{\"type\":\"number\"},\"minItems\":16,"
                          "\"maxItems\":16,\"description\":\"Row-major.\"}"},
    {"ids_or_set",
     "{\"oneOf\":[{\"type\":\"array\",\"items\":"
     "{\"$ref\":\"#/components/schemas/id\"},\"minItems\":1},"
     "{\"type\":\"string\",\"const\":\"all\"},{\"$ref\":\"#/components/schemas/set\"}]}"},
    {"pair", "{\"type\":\"array\",\"items\":{\"$ref\":\"#/components/schemas/id\"},\"minItems"
             "\":2,\"maxItems\":2}"},
    {"sides", "{\"type\":\"array\",\"items\":{\"$ref\":\"#/components/schemas/id_or_null\"},\"m"
              "inItems\":2,\"maxItems\":2}"},
    {"triple", "{\"type\":\"array\",\"items\":{\"type\":\"integer\",\"format\":\"int64\"},"
               "\"minItems\":3,\"maxItems\":3}"},
    {"scalar", "{\"oneOf\":[{\"type\":\"number\"},{\"type\":\"boolean\"},{\"type\":\"string\"}]}"},
    {"degrees", "{\"type\":\"object\",\"propertyNames\":{\"pattern\":\"^[0-9]+$\"},"
                "\"additionalProperties\":{\"type\":\"integer\",\"format\":\"int64\","
                "\"minimum\":1}}"},
    {"totals", "{\"type\":\"object\",\"properties\":{\"problems\":{\"type\":\"integer\","
               "\"format\":\"int64\",\"minimum\":0}},\"required\":[\"problems\"],"
               "\"additionalProperties\":{\"type\":\"integer\",\"format\":\"int64\","
               "\"minimum\":0}}"},
    {"element_kind",
     "{\"type\":\"string\",\"enum\":[\"vertex\",\"halfedge\",\"edge\",\"face\",\"mesh\"]}"},
    {"repair_name",
     "{\"type\":\"string\",\"enum\":[\"weld\",\"drop_degenerate\",\"drop_duplicates\",\"orient\","
     "\"split\",\"fill\"]}"},
    {"op_size", "{\"type\":\"string\",\"enum\":[\"local\",\"whole\"]}"},
    {"action", "{\"type\":\"string\",\"enum\":[\"edit\",\"undo\",\"redo\",\"replace\"]}"},
    {"connection", "{\"type\":\"string\",\"enum\":[\"edge\",\"vertex\"]}"},
    {"description",
     "{\"type\":\"object\",\"required\":[\"openapi\",\"info\",\"servers\",\"security\",\"tags\","
     "\"paths\",\"components\"],\"properties\":{\"openapi\":{\"type\":\"string\","
     "\"const\":\"3.1.0\"},\"info\":{\"$ref\":\"#/components/schemas/any_members\"},"
     "\"servers\":{\"type\":\"array\",\"items\":{\"$ref\":\"#/components/schemas/any_members\"},"
     "\"minItems\":1},\"security\":{\"type\":\"array\",\"items\":{\"type\":\"object\"},"
     "\"maxItems\":0},"
     "\"tags\":{\"type\":\"array\",\"items\":{\"$ref\":\"#/components/schemas/any_members\"},"
     "\"minItems\":1},\"paths\":{\"$ref\":\"#/components/schemas/any_members\"},"
     "\"components\":{\"$ref\":\"#/components/schemas/any_members\"}}}"},
    {"any_members",
     "{\"type\":\"object\",\"additionalProperties\":true,\"minProperties\":1,\"description\":\"A "
     "document as the OpenAPI 3.1 specification describes it.\"}"},
    {"job_state",
     "{\"type\":\"string\",\"enum\":[\"queued\",\"running\",\"done\",\"failed\",\"cancelled\"]}"},
    {"job_result", "{\"anyOf\":[{\"$ref\":\"#/components/schemas/edited\"},"
                   "{\"$ref\":\"#/components/schemas/created\"},"
                   "{\"$ref\":\"#/components/schemas/check\"},"
                   "{\"$ref\":\"#/components/schemas/summary\"},"
                   "{\"$ref\":\"#/components/schemas/query_results\"},"
                   "{\"$ref\":\"#/components/schemas/walked\"},"
                   "{\"$ref\":\"#/components/schemas/comparison\"},"
                   "{\"$ref\":\"#/components/schemas/boundaries\"},"
                   "{\"$ref\":\"#/components/schemas/components\"},"
                   "{\"$ref\":\"#/components/schemas/vertex_page\"},"
                   "{\"$ref\":\"#/components/schemas/halfedge_page\"},"
                   "{\"$ref\":\"#/components/schemas/edge_page\"},"
                   "{\"$ref\":\"#/components/schemas/face_page\"},"
                   "{\"$ref\":\"#/components/schemas/attribute_values\"},"
                   "{\"$ref\":\"#/components/schemas/document\"}]}"},
    {"role_name", "{\"type\":\"string\",\"enum\":[\"read\",\"write\",\"admin\",\"metrics\"]}"},
    {"presence_kind", "{\"type\":\"string\",\"enum\":[\"vertex\",\"halfedge\",\"edge\",\"face\"]}"},
    {"health_name", "{\"type\":\"string\",\"enum\":[\"alive\",\"ready\"]}"},
    {"memory_name", "{\"type\":\"string\",\"enum\":[\"free\",\"full\"]}"},
    {"store_name", "{\"type\":\"string\",\"enum\":[\"writable\",\"full\"]}"},
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
    {"of", "{\"oneOf\":[{\"$ref\":\"#/components/schemas/of_vertex\"},"
           "{\"$ref\":\"#/components/schemas/of_halfedge\"},"
           "{\"$ref\":\"#/components/schemas/of_edge\"},"
           "{\"$ref\":\"#/components/schemas/of_face\"}]}"},
    {"of_many", "{\"oneOf\":[{\"$ref\":\"#/components/schemas/of_vertices\"},"
                "{\"$ref\":\"#/components/schemas/of_halfedges\"},"
                "{\"$ref\":\"#/components/schemas/of_edges\"},"
                "{\"$ref\":\"#/components/schemas/of_faces\"}]}"},
    {"ids_or_all",
     "{\"oneOf\":[{\"type\":\"array\",\"items\":"
     "{\"$ref\":\"#/components/schemas/id\"}},{\"type\":\"string\",\"const\":\"all\"}]}"},
    {"mesh_or_revision", "{\"oneOf\":[{\"$ref\":\"#/components/schemas/mesh_id\"},"
                         "{\"type\":\"integer\",\"format\":\"int64\",\"minimum\":1}]}"},
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
     "{\"type\":\"string\",\"enum\":[\"normal\",\"area\",\"angle_defect\",\"mean_curvature\","
     "\"gaussian_curvature\","
     "\"angle\",\"length\",\"dihedral\",\"cotangent\",\"centroid\",\"degree\",\"smallest_angle\"],"
     "\"description\":\"Of vertices "
     "normal, area (the mixed one), angle_defect, mean_curvature, gaussian_curvature, degree (the "
     "number of edges); of half-edges "
     "angle and normal, at the corner; of edges length, dihedral (convex above 0), cotangent (the "
     "weight); of faces normal, area, centroid, degree (the number of corners), smallest_angle. "
     "Angles are in radians.\"}"},
    {"measured_value",
     "{\"oneOf\":[{\"type\":\"number\"},{\"$ref\":\"#/components/schemas/point\"},"
     "{\"type\":\"null\"}]}"},
    {"weights", "{\"type\":\"string\",\"enum\":[\"area\",\"angle\",\"uniform\"]}"},
    {"find_name", "{\"type\":\"string\",\"enum\":[\"halfedge\",\"edge\",\"faces\"]}"},
    {"until_name", "{\"type\":\"string\",\"enum\":[\"start\",\"boundary\"]}"},
    {"path_measure", "{\"type\":\"string\",\"enum\":[\"length\",\"edges\"]}"},
    {"resync_reason",
     "{\"type\":\"string\",\"enum\":[\"replaced\",\"gap\",\"lost\",\"busy\",\"incarnation\","
     "\"future\"]}"},
    {"bye_reason", "{\"type\":\"string\",\"enum\":[\"deleted\",\"ended\",\"stopping\",\"token\"]}"},
    {"vertex_row",
     "{\"type\":\"array\",\"items\":{\"oneOf\":[{\"type\":\"number\"},{\"type\":\"null\"}]},"
     "\"minItems\":5,\"maxItems\":5,\"description\":\"Id, x, y, z, half-edge; the half-edge is "
     "null "
     "if the vertex is isolated.\"}"},
    {"halfedge_row",
     "{\"type\":\"array\",\"items\":{\"$ref\":\"#/components/schemas/id_or_null\"},"
     "\"minItems\":5,\"maxItems\":5,\"description\":\"Id, next, prev, origin, face; the face is "
     "null on the boundary.\"}"},
    {"face_row", "{\"type\":\"array\",\"items\":{\"$ref\":\"#/components/schemas/id\"},"
                 "\"minItems\":2,\"maxItems\":2,\"description\":\"Id, half-edge.\"}"},
    {"value_row",
     "{\"type\":\"array\",\"items\":{\"anyOf\":[{\"$ref\":\"#/components/schemas/plain\"},"
     "{\"type\":\"null\"}]},\"minItems\":2,\"maxItems\":17,\"description\":\"Id, then the numbers "
     "of the value; null is a number that is not finite.\"}"},
    {"values_of_domain",
     "{\"type\":\"object\",\"additionalProperties\":{\"type\":\"array\",\"items\":"
     "{\"$ref\":\"#/components/schemas/value_row\"}},\"description\":\"Rows by the attribute's "
     "name.\"}"},
    {"written_values",
     "{\"type\":\"object\",\"additionalProperties\":"
     "{\"$ref\":\"#/components/schemas/values_of_domain\"},\"description\":\"By domain: vertices, "
     "halfedges, edges, faces, mesh.\"}"},
    {"step_name", "{\"type\":\"string\",\"enum\":[\"next\",\"prev\",\"twin\"]}"},
    {"edit", "{\"oneOf\":[{\"$ref\":\"#/components/schemas/operation\"},"
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

static void write_reference(api_out *out, const char *key, const char *name, size_t length)
{
    char reference[128];
    snprintf(reference, sizeof reference, "#/components/schemas/%.*s", (int)length, name);
    api_out_key_string(out, key, reference);
}

void api_schema_reference(api_out *out, const char *name)
{
    write_reference(out, "$ref", name, strlen(name));
}

void api_schema_union(api_out *out, const char *name, const char *member, const char *prefix,
                      const char *const *values)
{
    char schema[64];
    api_out_key(out, name);
    api_out_object_begin(out);
    api_out_key(out, "oneOf");
    api_out_array_begin(out);
    for (size_t i = 0; values[i] != NULL; i++) {
        snprintf(schema, sizeof schema, "%s_%s", prefix, values[i]);
        api_schema_ref(out, "schemas", schema);
    }
    api_out_array_end(out);
    api_out_key(out, "discriminator");
    api_out_object_begin(out);
    api_out_key_string(out, "propertyName", member);
    api_out_key(out, "mapping");
    api_out_object_begin(out);
    for (size_t i = 0; values[i] != NULL; i++) {
        snprintf(schema, sizeof schema, "%s_%s", prefix, values[i]);
        write_reference(out, values[i], schema, strlen(schema));
    }
    api_out_object_end(out);
    api_out_object_end(out);
    api_out_object_end(out);
}

void api_schema_ref_key(api_out *out, const char *key, const char *name)
{
    api_out_key(out, key);
    api_schema_ref(out, "schemas", name);
}

/* The basic types in the tables of members (schema_rows.h). */
typedef struct base {
    const char *name, *ref, *type, *format;
    bool from_zero;
} base;

static const base bases[] = {
    {"id", "id", NULL, NULL, false},
    {"point", "point", NULL, NULL, false},
    {"index", NULL, "integer", "int64", true},
    {"count", NULL, "integer", "int64", true},
    {"integer", NULL, "integer", "int64", false},
    {"number", NULL, "number", NULL, false},
    {"flag", NULL, "boolean", NULL, false},
    {"text", NULL, "string", NULL, false},
    {"time", NULL, "string", "date-time", false},
};

/* Writes the schema of a basic type into an object that the caller has begun. */
static void write_base(api_out *out, const char *name, size_t length)
{
    size_t i = 0;
    while (strlen(bases[i].name) != length || memcmp(bases[i].name, name, length) != 0) {
        i++;
        assert(i < sizeof bases / sizeof bases[0]);
    }
    if (bases[i].ref != NULL) {
        api_schema_reference(out, bases[i].ref);
        return;
    }
    api_out_key_string(out, "type", bases[i].type);
    if (bases[i].format != NULL) {
        api_out_key_string(out, "format", bases[i].format);
    }
    if (bases[i].from_zero) {
        api_out_key_u64(out, "minimum", 0);
    }
}

static void write_type(api_out *out, const char *type, size_t length, const char *doc)
{
    api_out_object_begin(out);
    if (doc != NULL) {
        api_out_key_string(out, "description", doc);
    }
    if (type[0] == '=') {
        char value[32];
        snprintf(value, sizeof value, "%.*s", (int)length - 1, type + 1);
        api_out_key_string(out, "type", "string");
        api_out_key_string(out, "const", value);
    } else if (type[length - 1] == '?') {
        api_out_key(out, "anyOf");
        api_out_array_begin(out);
        write_type(out, type, length - 1, NULL);
        api_out_raw(out, "{\"type\":\"null\"}", 15);
        api_out_array_end(out);
    } else if (type[0] == '*' || type[0] == '+') {
        api_out_key_string(out, "type", "array");
        if (type[0] == '+') {
            api_out_key_u64(out, "minItems", 1);
        }
        api_out_key(out, "items");
        write_type(out, type + 1, length - 1, NULL);
    } else if (type[0] == '#') {
        write_reference(out, "$ref", type + 1, length - 1);
    } else {
        write_base(out, type, length);
    }
    api_out_object_end(out);
}

/* Returns member `i` of the schema whose rows begin at `rows`; if the table `record` is not NULL,
 * member `i` of that table instead. After the last member, returns a row whose schema is NULL. */
static api_member member_at(const api_member *rows, const api_record *record, size_t i)
{
    if (record != NULL) {
        const api_field *field = &record->fields[i];
        return i < record->count ? (api_member){rows->schema, field->name, field->type,
                                                field->required, field->doc}
                                 : (api_member){0};
    }
    return rows[i].schema != NULL && strcmp(rows[i].schema, rows->schema) == 0 ? rows[i]
                                                                               : (api_member){0};
}

/* Writes the schema whose rows begin at `rows`, and returns the number of its rows. With `closed`
 * no other members are allowed. */
static size_t write_schema(api_out *out, const api_member *rows, bool closed)
{
    const api_record *record = rows->name == NULL ? api_record_find(rows->schema) : NULL;
    size_t count = 0;
    api_out_key(out, rows->schema);
    api_out_object_begin(out);
    api_out_key_string(out, "type", "object");
    api_out_key(out, "properties");
    api_out_object_begin(out);
    for (api_member m = member_at(rows, record, 0); m.schema != NULL;
         m = member_at(rows, record, ++count)) {
        api_out_key(out, m.name);
        write_type(out, m.type, strlen(m.type), m.doc);
    }
    api_out_object_end(out);
    api_out_key(out, "required");
    api_out_array_begin(out);
    for (size_t i = 0; i < count; i++) {
        const api_member m = member_at(rows, record, i);
        if (m.required) {
            api_out_string(out, m.name);
        }
    }
    api_out_array_end(out);
    if (closed) {
        api_out_key_bool(out, "additionalProperties", false);
    }
    api_out_object_end(out);
    return record != NULL ? 1 : count;
}

/* Writes the schema of an object with one member, such as of_vertex for {"vertex":5} or of_vertices
 * for {"vertices":[1,2]}. */
static void write_reference_schema(api_out *out, const char *member, const char *schema)
{
    char name[32];
    snprintf(name, sizeof name, "of_%s", member);
    api_out_key(out, name);
    api_out_object_begin(out);
    api_out_key_string(out, "type", "object");
    api_out_key(out, "properties");
    api_out_object_begin(out);
    api_schema_ref_key(out, member, schema);
    api_out_object_end(out);
    api_schema_choices(out, "required", (const char *const[]){member, NULL});
    api_out_key_bool(out, "additionalProperties", false);
    api_out_object_end(out);
}

/* Writes the schema of the answer to a question about one relation: vertex_faces, for example, for
 * the faces around a vertex. */
static void write_adjacency_schema(api_out *out, const he_relation *relation)
{
    static const char *const required[] = {"revision", "of", "relation", "ids", NULL};
    char name[64], text[64];
    snprintf(name, sizeof name, "%s_%s", he_kind_name(relation->of), relation->name);
    api_out_key(out, name);
    api_out_object_begin(out);
    api_out_key_string(out, "type", "object");
    api_out_key(out, "properties");
    api_out_object_begin(out);
    api_out_key(out, "revision");
    write_type(out, "count", strlen("count"), NULL);
    snprintf(name, sizeof name, "of_%s", he_kind_name(relation->of));
    api_schema_ref_key(out, "of", name);
    api_out_key(out, "relation");
    api_out_object_begin(out);
    api_out_key_string(out, "type", "string");
    api_out_key_string(out, "const", relation->name);
    api_out_object_end(out);
    snprintf(text, sizeof text, "Ids of %s.", he_kind_plural(relation->gives));
    api_out_key(out, "ids");
    write_type(out, "*id", strlen("*id"), text);
    api_out_object_end(out);
    api_schema_choices(out, "required", required);
    api_out_object_end(out);
}

/* Writes the schemas that are unions of schemas from the tables of members. */
static void write_unions(api_out *out)
{
    static const char *const walks[] = {"path",          "loop",      "rings",     "breadth_first",
                                        "shortest_path", "edge_loop", "edge_ring", NULL};
    static const char *const mesh_events[] = {"edit", "metadata", "moment", "presence",
                                              "job",  "resync",   "bye",    NULL};
    static const char *const job_events[] = {"job", "bye", NULL};
    api_schema_union(out, "walk", "walk", "walk", walks);
    api_schema_union(out, "walked", "walk", "walked", walks);
    api_schema_union(out, "mesh_event", "event", "mesh_event", mesh_events);
    api_schema_union(out, "job_event", "event", "job_event", job_events);
}

void api_schemas_write(api_out *out)
{
    for (size_t i = 0; i < sizeof others / sizeof others[0]; i++) {
        api_out_key(out, others[i].name);
        api_out_raw(out, others[i].json, strlen(others[i].json));
    }
    for (const api_member *row = api_answer_members; row->schema != NULL;) {
        row += write_schema(out, row, false);
    }
    for (const api_member *row = api_request_members; row->schema != NULL;) {
        row += write_schema(out, row, true);
    }
    for (he_kind kind = HE_VERTEX; kind <= HE_FACE; kind++) {
        write_reference_schema(out, he_kind_name(kind), "id");
        write_reference_schema(out, he_kind_plural(kind), "ids_or_all");
    }
    for (size_t i = 0; i < he_relation_count(); i++) {
        write_adjacency_schema(out, he_relation_at(i));
    }
    write_unions(out);
}
