#include "api/describe/openapi.h"

#include "api/describe/examples.h"
#include "api/describe/operations.h"
#include "api/describe/routes.h"
#include "api/describe/schemas.h"
#include "api/describe/shape_schemas.h"
#include "api/describe/tags.h"
#include "api/header/media.h"

#include <stdio.h>
#include <string.h>

static const char EVENT_STREAM[] = "text/event-stream";

/* --- the paths of the document --- */

static void write_path_parameter(api_out *out, const char *name)
{
    api_out_object_begin(out);
    api_out_key_string(out, "name", name);
    api_out_key_string(out, "in", "path");
    api_out_key_bool(out, "required", true);
    api_out_key(out, "schema");
    if (strcmp(name, "id") == 0) {
        api_schema_ref(out, "schemas", "id");
    } else if (strcmp(name, "domain") == 0) {
        api_schema_ref(out, "schemas", "domain");
    } else if (strcmp(name, "name") == 0) {
        api_schema_ref(out, "schemas", "attribute_name");
    } else if (strcmp(name, "revision") == 0) {
        api_out_object_begin(out);
        api_out_key_string(out, "type", "integer");
        api_out_key_string(out, "format", "int64");
        api_out_key_number(out, "minimum", 1);
        api_out_key_number(out, "maximum", 9007199254740992.0);
        api_out_object_end(out);
    } else {
        api_out_object_begin(out);
        api_out_key_string(out, "type", "string");
        if (strcmp(name, "mesh") == 0) {
            api_out_key_string(out, "pattern", "^[A-Za-z0-9._-]{1,64}$");
        }
        api_out_object_end(out);
    }
    api_out_object_end(out);
}

static void write_path_parameters(api_out *out, const char *path)
{
    api_out_key(out, "parameters");
    api_out_array_begin(out);
    for (const char *at = strchr(path, '{'); at != NULL; at = strchr(at + 1, '{')) {
        char name[32];
        snprintf(name, sizeof name, "%.*s", (int)strcspn(at + 1, "}"), at + 1);
        write_path_parameter(out, name);
    }
    api_out_array_end(out);
}

static void write_query_parameter(api_out *out, const api_parameter *parameter)
{
    static const char *const flags[] = {"true", "false", NULL};
    api_out_object_begin(out);
    api_out_key_string(out, "name", parameter->name);
    api_out_key_string(out, "in", "query");
    api_out_key_string(out, "description", parameter->doc);
    api_out_key(out, "schema");
    api_out_object_begin(out);
    switch (parameter->type) {
    case API_PARAM_TEXT:
        api_out_key_string(out, "type", "string");
        break;
    case API_PARAM_NAME:
        api_out_key_string(out, "$ref", "#/components/schemas/shown_name");
        break;
    case API_PARAM_FLAG:
        api_out_key_string(out, "type", "string");
        api_schema_choices(out, "enum", flags);
        break;
    case API_PARAM_U64:
        api_out_key_string(out, "type", "integer");
        api_out_key_string(out, "format", parameter->max > INT32_MAX ? "int64" : "int32");
        api_out_key_number(out, "minimum", parameter->min);
        api_out_key_number(out, "maximum", parameter->max);
        break;
    case API_PARAM_NUMBER:
        api_out_key_string(out, "type", "number");
        api_out_key_number(out, "minimum", parameter->min);
        api_out_key_number(out, "maximum", parameter->max);
        break;
    case API_PARAM_CHOICE:
        api_out_key_string(out, "type", "string");
        api_schema_choices(out, "enum", parameter->choices);
        break;
    case API_PARAM_CHOICES:
        api_out_key_string(out, "type", "array");
        api_out_key(out, "items");
        api_out_object_begin(out);
        api_out_key_string(out, "type", "string");
        api_schema_choices(out, "enum", parameter->choices);
        api_out_object_end(out);
        api_out_key_u64(out, "minItems", 1);
        api_out_key_bool(out, "uniqueItems", true);
        break;
    }
    api_out_object_end(out);
    if (parameter->type == API_PARAM_CHOICES) {
        api_out_key_string(out, "style", "form");
        api_out_key_bool(out, "explode", false);
    }
    api_out_object_end(out);
}

/* Writes the schema of the lines of an NDJSON answer: each line has the schema `line`, except the
 * last one, {"end":true,"count":N}. */
static void write_line_schema(api_out *out, const char *line)
{
    static const char end[] =
        "{\"type\":\"object\",\"properties\":{\"end\":{\"type\":\"boolean\",\"const\":true},"
        "\"count\":{\"type\":\"integer\",\"format\":\"int64\",\"minimum\":0,\"description\":\"The "
        "number of lines before this one.\"}},\"required\":[\"end\",\"count\"]}";
    api_out_key(out, "x-item-schema");
    api_out_object_begin(out);
    api_out_key(out, "oneOf");
    api_out_array_begin(out);
    api_schema_ref(out, "schemas", line);
    api_out_raw(out, end, sizeof end - 1);
    api_out_array_end(out);
    api_out_object_end(out);
}

/* Writes the schema of a multipart body of files. The server accepts any name for their field;
 * client code generated from the document uses "files". */
static void write_files_schema(api_out *out)
{
    static const char schema[] =
        "{\"type\":\"object\",\"description\":\"1 to 64 files: one in a mesh format that the "
        "server reads, and the files that it refers to, each with the file name by which it is "
        "referred "
        "to.\",\"properties\":{\"files\":{\"type\":\"array\",\"items\":{\"type\":\"string\","
        "\"format\":\"binary\",\"contentMediaType\":\"application/octet-stream\"}}}}";
    api_out_key(out, "schema");
    api_out_raw(out, schema, sizeof schema - 1);
}

/* Writes the schema of a glTF document, with the members that the reader requires. If the schema
 * allowed any object, generated client code would accept any object as a mesh document, too. */
static void write_gltf_schema(api_out *out)
{
    static const char schema[] =
        "{\"type\":\"object\",\"description\":\"A glTF 2.0 document.\",\"properties\":{\"asset\":"
        "{\"type\":\"object\",\"properties\":{\"version\":{\"type\":\"string\"}},\"required\":"
        "[\"version\"],\"additionalProperties\":true}},\"required\":[\"asset\"],"
        "\"additionalProperties\":true}";
    api_out_key(out, "schema");
    api_out_raw(out, schema, sizeof schema - 1);
}

/* Writes the schema of a body that is not JSON: text, or binary data, for which generated client
 * code uses a blob. */
static void write_bytes_schema(api_out *out, const char *type)
{
    api_out_key(out, "schema");
    api_out_object_begin(out);
    api_out_key_string(out, "type", "string");
    if (strncmp(type, "text/", 5) != 0) {
        api_out_key_string(out, "format", "binary");
    }
    api_out_object_end(out);
}

/* Writes the schema of an event stream: a text that encodes a list of events, each of which has the
 * schema `event`. */
static void write_events_schema(api_out *out, const char *event)
{
    api_out_key(out, "schema");
    api_out_object_begin(out);
    api_out_key_string(out, "type", "string");
    api_out_key_string(out, "contentMediaType", EVENT_STREAM);
    api_out_key(out, "contentSchema");
    api_out_object_begin(out);
    api_out_key_string(out, "type", "array");
    api_schema_ref_key(out, "items", event);
    api_out_object_end(out);
    api_out_object_end(out);
}

/* What the document says about one body of a request or an answer. */
typedef struct body {
    const char *const *types; /* media types, ended by NULL */
    const char *schema;
    /* The name of the schema of one event of a stream, or of one line of an NDJSON answer; NULL for
     * other bodies. The schema of a line is written as an extension, because OpenAPI has a keyword
     * for it (itemSchema) only since version 3.2. */
    const char *item;
    const api_examples *examples;
    api_example_part part;
    /* Name of the route whose examples are shown; NULL: the example of a refusal is shown. */
    const char *route;
} body;

static void write_example(api_out *out, const body *b, const char *type, bool json)
{
    api_text text = {0};
    uint32_t found = b->route != NULL ? api_example_find(b->examples, b->part, b->route, type)
                                      : (json ? api_example_problem(b->examples) : HE_NONE);
    if (found != HE_NONE && api_example_body(b->examples, found, b->part, &text)) {
        api_text_add_char(&text, '\0');
        out->text->failed = out->text->failed || text.failed;
    }
    if (text.length > 0 && !text.failed) {
        api_out_key(out, "example");
        if (json) {
            api_out_raw(out, text.bytes, text.length - 1);
        } else {
            api_out_string(out, text.bytes);
        }
    }
    api_text_clear(&text);
}

/* Writes the member "content": the media types of a body with their schemas and examples. */
static void write_content(api_out *out, const body *b)
{
    api_out_key(out, "content");
    api_out_object_begin(out);
    for (const char *const *types = b->types; *types != NULL; types++) {
        api_out_key(out, *types);
        api_out_object_begin(out);
        size_t length = strlen(*types);
        bool lines = strcmp(*types, "application/x-ndjson") == 0;
        bool json = length >= 4 && strcmp(*types + length - 4, "json") == 0 && !lines;
        if (json && b->schema != NULL && strncmp(*types, "application/", 12) == 0) {
            api_schema_ref_key(out, "schema", b->schema);
        } else if (lines && b->item != NULL) {
            write_bytes_schema(out, *types);
            write_line_schema(out, b->item);
        } else if (strcmp(*types, EVENT_STREAM) == 0) {
            write_events_schema(out, b->item);
        } else if (strcmp(*types, API_MULTIPART) == 0) {
            write_files_schema(out);
        } else if (strcmp(*types, "model/gltf+json") == 0) {
            write_gltf_schema(out);
        } else if (json) {
            /* The schema allows any JSON value, because what a JSON file of the web page contains
             * is unknown. */
            api_out_key(out, "schema");
            api_out_raw(out, "{}", 2);
        } else {
            write_bytes_schema(out, *types);
        }
        write_example(out, b, *types, json);
        api_out_object_end(out);
    }
    api_out_object_end(out);
}

static void write_header(api_out *out, const char *name, const char *doc, bool required)
{
    api_out_key(out, name);
    api_out_object_begin(out);
    api_out_key_string(out, "description", doc);
    if (required) {
        api_out_key_bool(out, "required", true);
    }
    api_out_key(out, "schema");
    api_out_object_begin(out);
    api_out_key_string(out, "type", "string");
    api_out_object_end(out);
    api_out_object_end(out);
}

static bool is_stream(const api_route *route)
{
    return route->produces[0] != NULL && strcmp(route->produces[0], EVENT_STREAM) == 0;
}

/* The names of the rate-limit headers, which the document describes only once, in its
 * components. */
static const char *const rate_headers[] = {"RateLimit-Policy", "RateLimit", NULL};
static const char *const coding_headers[] = {"Content-Encoding", "Vary", NULL};

static void refer_to_headers(api_out *out, const char *const *names)
{
    for (; *names != NULL; names++) {
        api_out_key(out, *names);
        api_schema_ref(out, "headers", *names);
    }
}

static bool answers(const api_route *route, int status)
{
    const int *at = route->statuses;
    while (*at != 0 && *at != status) {
        at++;
    }
    return *at == status;
}

static void write_success_headers(api_out *out, const api_route *route, int status)
{
    bool writes = (route->flags & API_WRITES) != 0;
    bool tagged = answers(route, 304) || (writes && answers(route, status == 204 ? 200 : status));
    tagged = tagged && status != 202;
    bool coded = status != 204 && !is_stream(route);
    bool limited = (route->flags & API_UNLIMITED) == 0;
    if (!tagged && status != 202 && route->headers[0] == NULL && !coded && !limited) {
        return;
    }
    api_out_key(out, "headers");
    api_out_object_begin(out);
    if (status == 202) {
        write_header(out, "Location", "The path of the job.", (route->flags & API_LONG) != 0);
        write_header(
            out, "Preference-Applied",
            "The preference that the server followed: respond-async, if the client asked for it.",
            false);
    }
    if (tagged) {
        /* A dry run makes no state of the mesh that an ETag could name, and an answer 204 that
         * replaces another answer (api_publish) may be sent when the state is not known. So such
         * answers do not always have an ETag. */
        bool always = status != 204 && !(route->flags & (API_REHEARSED | API_TAG_OF_OTHERS));
        write_header(out, "ETag", "The ETag of the state of the mesh that the answer shows.",
                     always);
    }
    if (status == 201) {
        write_header(out, "Location", "The path of the new mesh.", true);
    }
    if (status == 303) {
        write_header(out, "Location", "The path of the page, relative to this path.", true);
    }
    if (route->flags & (API_IDEMPOTENCY_KEY | API_IDEMPOTENCY_KEY_NEW)) {
        write_header(
            out, "Idempotency-Replayed",
            "true: this is the stored answer to an earlier request with this Idempotency-Key.",
            false);
    }
    for (size_t i = 0; status == 200 && route->headers[i] != NULL; i++) {
        write_header(out, route->headers[i]->name, route->headers[i]->doc, false);
    }
    if (coded) {
        refer_to_headers(out, coding_headers);
    }
    if (limited) {
        refer_to_headers(out, rate_headers);
    }
    api_out_object_end(out);
}

static const char *const job_media[] = {"application/json", NULL};

static void write_success(api_out *out, const api_examples *examples, const api_route *route,
                          int status)
{
    const char *what =
        status == 201 ? "Created. The answer has no body and no ETag if memory ran "
                        "out after the mesh was created, or if the request repeats "
                        "an Idempotency-Key whose first answer was not kept."
        : status == 202
            ? "The request is not finished yet: the answer is the job that will finish it."
        : status == 204 ? "Done. The answer has no body."
        : status == 303 ? "The page is in the manual: Location has its path."
        : status == 304 ? "The client's copy is up to date, so the answer has no body."
                        : "Success.";
    api_out_object_begin(out);
    api_out_key_string(out, "description", what);
    write_success_headers(out, route, status);
    if (status == 202) {
        write_content(out, &(body){.types = job_media,
                                   .schema = "job",
                                   .examples = examples,
                                   .part = API_EXAMPLE_RESPONSE,
                                   .route = "delete_job"});
    }
    if (status == 200 || status == 201) {
        write_content(out, &(body){.types = route->produces,
                                   .schema = route->response,
                                   .item = route->item,
                                   .examples = examples,
                                   .part = API_EXAMPLE_RESPONSE,
                                   .route = route->name});
    }
    api_out_object_end(out);
}

/* The refusals whose answers have a special header. All other refusals are described by the
 * component "problem". */
typedef struct refusal {
    int status;
    const char *name, *header, *doc;
    bool required;
} refusal;

static const refusal headed_problems[] = {
    {401, "unauthorized", "WWW-Authenticate",
     "The scheme Bearer, with an error code if the request has an invalid token.", true},
    {403, "forbidden", "WWW-Authenticate",
     "The scheme Bearer, with the role that the request needs, if the token does not have this "
     "role.",
     false},
    {405, "not_allowed", "Allow", "The methods that the path supports.", true},
    {409, "conflict", "Retry-After",
     "The number of seconds after which the request may be sent again, if waiting helps.", false},
    {415, "unsupported", "Accept-Encoding",
     "The supported content codings, if the content coding of the body is not supported.", false},
    {429, "limited", "Retry-After", "Seconds.", true},
    {503, "unavailable", "Retry-After", "Seconds.", true},
};
enum { HEADED_PROBLEMS = sizeof headed_problems / sizeof *headed_problems };

static void write_refusal(api_out *out, int status)
{
    const char *name = "problem";
    for (size_t i = 0; i < HEADED_PROBLEMS; i++) {
        name = headed_problems[i].status == status ? headed_problems[i].name : name;
    }
    api_schema_ref(out, "responses", name);
}

/* Writes the response `row->name` that describes a refusal; `types` are its media types. */
static void write_problem(api_out *out, const api_examples *examples, const refusal *row,
                          const char *const *types)
{
    api_out_key(out, row->name);
    api_out_object_begin(out);
    api_out_key_string(out, "description", "Why the request was refused (RFC 9457).");
    api_out_key(out, "headers");
    api_out_object_begin(out);
    if (row->header != NULL) {
        write_header(out, row->header, row->doc, row->required);
    }
    refer_to_headers(out, coding_headers);
    refer_to_headers(out, rate_headers);
    api_out_object_end(out);
    write_content(out, &(body){.types = types,
                               .schema = "problem",
                               .examples = examples,
                               .part = API_EXAMPLE_RESPONSE});
    api_out_object_end(out);
}

static const char *const problem_media[] = {"application/problem+json", NULL};
static const char *const missing_media[] = {"application/problem+json", "text/html", NULL};

static void write_responses(api_out *out, const api_examples *examples, const api_route *route)
{
    char code[8];
    api_out_key(out, "responses");
    api_out_object_begin(out);
    for (const int *status = route->statuses; *status != 0; status++) {
        snprintf(code, sizeof code, "%d", *status);
        api_out_key(out, code);
        if (*status < 400) {
            write_success(out, examples, route, *status);
        } else {
            write_refusal(out, *status);
        }
    }
    if (route->role != API_ROLE_OPEN) {
        api_out_key(out, "401");
        write_refusal(out, 401);
    }
    for (const int *status = api_route_common(); *status != 0; status++) {
        snprintf(code, sizeof code, "%d", *status);
        if (*status == 404 && (route->flags & API_MISSING_PAGE)) {
            write_problem(out, examples, &(refusal){.name = code}, missing_media);
            continue;
        }
        api_out_key(out, code);
        write_refusal(out, *status);
    }
    api_out_object_end(out);
}

static void write_header_parameter(api_out *out, const char *name, const char *doc)
{
    api_out_object_begin(out);
    api_out_key_string(out, "name", name);
    api_out_key_string(out, "in", "header");
    api_out_key_string(out, "description", doc);
    api_out_key(out, "schema");
    api_out_object_begin(out);
    api_out_key_string(out, "type", "string");
    api_out_object_end(out);
    api_out_object_end(out);
}

/* Writes the request headers that the route reads, as parameters; Accept and Content-Type are not
 * listed. */
static void write_header_parameters(api_out *out, const api_route *route)
{
    if (answers(route, 304)) {
        write_header_parameter(out, "If-None-Match",
                               "The ETag of the client's copy. If the copy is up to date, the "
                               "answer is 304 without a body.");
    }
    if (answers(route, 412)) {
        write_header_parameter(out, "If-Match",
                               "The ETag of the state of the mesh that the request is meant for. "
                               "If the mesh has changed since, the answer is 412.");
        write_header_parameter(out, "If-None-Match",
                               "The ETag of a state in which the request must not be done; or *: "
                               "the request is done only if the mesh does not exist yet.");
    }
    if (route->body_kind != API_BODY_NONE) {
        write_header_parameter(
            out, "Content-Encoding",
            "The content coding of the body: gzip or zstd, but not both. The window of zstd may be "
            "at most 8 MiB. The decompressed body may not exceed the limit of an uncompressed body "
            "nor, past 1 MiB, 100 times its compressed size.");
    }
    if (is_stream(route)) {
        write_header_parameter(out, "Last-Event-ID",
                               "The id of the last event that the client has seen. It overrides "
                               "the parameter `since`.");
    }
    bool minimal = answers(route, 204) && answers(route, 200);
    if (route->flags & API_LONG) {
        write_header_parameter(
            out, "Prefer",
            minimal
                ? "respond-async: run the request as a job and answer 202. wait=N: answer 200 if "
                  "the job takes at most N seconds. return=minimal: answer 204 without a body."
                : "respond-async: run the request as a job and answer 202, unless the answer is an "
                  "error or 304, which is sent at once. wait=N: answer 200 if the job takes at "
                  "most N seconds.");
    } else if (minimal) {
        write_header_parameter(out, "Prefer", "return=minimal: answer 204 without a body.");
    }
    if (route->flags & (API_IDEMPOTENCY_KEY | API_IDEMPOTENCY_KEY_NEW)) {
        write_header_parameter(
            out, "Idempotency-Key",
            "1 to 255 visible characters that the client chooses. For a day, a request with the "
            "same key is not done again: its first answer is repeated with Idempotency-Replayed: "
            "true, in the media type that it had, or is 204 or 201 without a body if it was too "
            "large to keep or the server was "
            "restarted. A different request with the same key is answered 422; while the first is "
            "in progress, 409. Errors are not kept.");
    }
}

/* The maximum length of a route's description. It is longer than the longest `doc` of a route plus
 * the sentence that write_doc may add. */
enum { MOST_DOC = 2000 };

static void write_doc(api_out *out, const api_route *route)
{
    static const char expensive[] =
        "This request is expensive, so pages of other sites may not send it.";
    const char *doc = route->doc == NULL ? "" : route->doc;
    char text[MOST_DOC];
    bool is_expensive = (route->flags & API_EXPENSIVE) != 0;
    snprintf(text, sizeof text, "%s%s%s", doc, doc[0] != '\0' && is_expensive ? " " : "",
             is_expensive ? expensive : "");
    if (text[0] != '\0') {
        api_out_key_string(out, "description", text);
    }
}

/* Writes the member "security", a list of alternatives: a token; for GET, a ticket; or nothing,
 * because a server may have no tokens. The required role is written where OAuth has scopes, which
 * OpenAPI 3.1 allows for other schemes, too. */
static void write_security(api_out *out, const api_route *route)
{
    api_out_key(out, "security");
    api_out_array_begin(out);
    if (route->role != API_ROLE_OPEN) {
        api_out_object_begin(out);
        api_out_key(out, "token");
        api_out_array_begin(out);
        api_out_string(out, api_role_name(route->role));
        api_out_array_end(out);
        api_out_object_end(out);
        if (strcmp(route->method, "GET") == 0) {
            api_out_object_begin(out);
            api_out_key(out, "ticket");
            api_out_array_begin(out);
            api_out_array_end(out);
            api_out_object_end(out);
        }
        api_out_object_begin(out);
        api_out_object_end(out);
    }
    api_out_array_end(out);
}

static void write_operation(api_out *out, const api_examples *examples, const api_route *route)
{
    char method[16] = "";
    for (size_t i = 0; i + 1 < sizeof method && route->method[i] != '\0'; i++) {
        char c = route->method[i];
        method[i] = c >= 'A' && c <= 'Z' ? (char)(c + 32) : c;
    }
    api_out_key(out, method);
    api_out_object_begin(out);
    api_out_key_string(out, "operationId", route->name);
    api_out_key_string(out, "summary", route->summary);
    api_schema_choices(out, "tags", (const char *const[]){api_tag_of(route->path), NULL});
    write_doc(out, route);
    api_out_key(out, "parameters");
    api_out_array_begin(out);
    for (const api_parameter *const *p = route->parameters; *p != NULL; p++) {
        write_query_parameter(out, *p);
    }
    write_header_parameters(out, route);
    api_out_array_end(out);
    if (route->body_kind != API_BODY_NONE) {
        api_out_key(out, "requestBody");
        api_out_object_begin(out);
        api_out_key_bool(out, "required", route->body_kind != API_BODY_OPTION);
        write_content(out, &(body){.types = route->consumes,
                                   .schema = route->request,
                                   .examples = examples,
                                   .part = API_EXAMPLE_REQUEST,
                                   .route = route->name});
        api_out_object_end(out);
    }
    write_security(out, route);
    write_responses(out, examples, route);
    api_out_object_end(out);
}

static bool is_first_of_path(size_t i)
{
    for (size_t j = 0; j < i; j++) {
        if (strcmp(api_routes().rows[j].path, api_routes().rows[i].path) == 0) {
            return false;
        }
    }
    return true;
}

static void write_paths(api_out *out, const api_examples *examples)
{
    api_out_key(out, "paths");
    api_out_object_begin(out);
    for (size_t i = 0; i < api_routes().count; i++) {
        if (!is_first_of_path(i)) {
            continue;
        }
        const char *path = api_routes().rows[i].path;
        api_out_key(out, path);
        api_out_object_begin(out);
        write_path_parameters(out, path);
        for (size_t j = i; j < api_routes().count; j++) {
            if (strcmp(api_routes().rows[j].path, path) == 0) {
                write_operation(out, examples, &api_routes().rows[j]);
            }
        }
        api_out_object_end(out);
    }
    api_out_object_end(out);
}

static void write_security_schemes(api_out *out)
{
    api_out_key(out, "securitySchemes");
    api_out_object_begin(out);
    api_out_key(out, "token");
    api_out_object_begin(out);
    api_out_key_string(out, "type", "http");
    api_out_key_string(out, "scheme", "bearer");
    api_out_key_string(out, "description",
                       "A server with the option --tokens needs a token with at least the role "
                       "that the operation names: read, write (includes read), admin (includes "
                       "everything) or metrics. A dry run of an edit needs only read.");
    api_out_object_end(out);
    api_out_key(out, "ticket");
    api_out_object_begin(out);
    api_out_key_string(out, "type", "apiKey");
    api_out_key_string(out, "in", "query");
    api_out_key_string(out, "name", "ticket");
    api_out_key_string(out, "description",
                       "A ticket, which POST /v1/tickets makes. It replaces the header "
                       "Authorization for one GET and must be the last query parameter.");
    api_out_object_end(out);
    api_out_object_end(out);
}

static void write_shared_headers(api_out *out)
{
    static const char *const codings[] = {"gzip", "zstd", NULL};
    api_out_key(out, "headers");
    api_out_object_begin(out);
    api_out_key(out, "Content-Encoding");
    api_out_object_begin(out);
    api_out_key_string(out, "description",
                       "The content coding of the body, if Accept-Encoding allows one.");
    api_out_key(out, "schema");
    api_out_object_begin(out);
    api_out_key_string(out, "type", "string");
    api_schema_choices(out, "enum", codings);
    api_out_object_end(out);
    api_out_object_end(out);
    write_header(out, "Vary", "The request headers that the answer depends on.", false);
    write_header(out, "RateLimit-Policy",
                 "The limits of the client, if it has limits of requests or bytes per second: a "
                 "quota (q) for a window of w seconds.",
                 false);
    write_header(out, "RateLimit",
                 "How much of each quota is left (r), and the number of seconds until the quota is "
                 "full again (t).",
                 false);
    api_out_object_end(out);
}

static void write_components(api_out *out, const api_examples *examples)
{
    api_out_key(out, "components");
    api_out_object_begin(out);
    api_out_key(out, "schemas");
    api_out_object_begin(out);
    api_schemas_write(out);
    api_operation_schemas_write(out);
    api_shape_schemas_write(out);
    api_out_object_end(out);
    write_shared_headers(out);
    write_security_schemes(out);
    api_out_key(out, "responses");
    api_out_object_begin(out);
    write_problem(out, examples, &(refusal){.name = "problem"}, problem_media);
    for (size_t i = 0; i < HEADED_PROBLEMS; i++) {
        write_problem(out, examples, &headed_problems[i], problem_media);
    }
    api_out_object_end(out);
    api_out_object_end(out);
}

void api_openapi_write(api_out *out, const char *version, const char *url)
{
    api_examples examples;
    if (!api_examples_read(&examples)) {
        out->text->failed = true;
        return;
    }
    api_out_object_begin(out);
    api_out_key_string(out, "openapi", "3.1.0");
    api_out_key(out, "info");
    api_out_object_begin(out);
    api_out_key_string(out, "title", "hedge");
    api_out_key_string(out, "version", version);
    api_out_key_string(
        out, "description",
        "Half-edge meshes over HTTP. Every path with GET also answers HEAD. Every error is "
        "application/problem+json. Bodies of more than 1 KiB are compressed with gzip or zstd if "
        "Accept-Encoding allows, except the positions of preview_deform, which hardly become "
        "shorter; compressed answers have their own ETag, which also works in If-Match. Pages of "
        "other sites may not change anything, and may not send reads that are "
        "described as expensive: such a request is answered 403 if Sec-Fetch-Site is cross-site, "
        "unless the server's option --allow-origin names the Origin of the page.");
    api_out_key(out, "license");
    api_out_object_begin(out);
    api_out_key_string(out, "name", "MIT");
    api_out_key_string(out, "identifier", "MIT");
    api_out_object_end(out);
    api_out_object_end(out);
    api_out_key(out, "servers");
    api_out_array_begin(out);
    api_out_object_begin(out);
    api_out_key_string(out, "url", url != NULL ? url : "/");
    api_out_object_end(out);
    api_out_array_end(out);
    /* This is the default for routes that write no member "security": they need no token. */
    api_out_key(out, "security");
    api_out_array_begin(out);
    api_out_array_end(out);
    api_tags_write(out);
    write_paths(out, &examples);
    write_components(out, &examples);
    api_out_object_end(out);
    api_examples_clear(&examples);
}
