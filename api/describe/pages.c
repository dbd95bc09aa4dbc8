#include "api/describe/openapi.h"
#include "api/describe/operations.h"
#include "api/describe/page_records.h"
#include "api/request/handlers.h"

#include <stdatomic.h>
#include <stdio.h>
#include <string.h>

/* The Content-Security-Policy of the viewer page, which may run its own scripts and connect to its
 * own server only. The names of those that may show it in a frame follow. */
static const char viewer_policy[] =
    "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data: blob:; "
    "connect-src 'self'; base-uri 'none'; form-action 'none'; "
    "require-trusted-types-for 'script'; trusted-types 'none'; frame-ancestors";
static const char text_policy[] =
    "default-src 'none'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

/* The struct before each table has the values of the JSON members of one answer. */

typedef struct shown_health {
    const char *status;
} shown_health;

static const api_field health_fields[] = {
    API_FIELD("status", "#health_name", shown_health, status, .required = true),
};
const api_record api_health_record = API_RECORD("health", health_fields);

typedef struct shown_readiness {
    const char *status, *store, *memory;
} shown_readiness;

static const api_field readiness_fields[] = {
    API_FIELD("status", "#health_name", shown_readiness, status, .required = true),
    API_FIELD("store", "#store_name", shown_readiness, store, .required = true,
              .doc = "full: the disk is full, and only deletions are accepted."),
    API_FIELD("memory", "#memory_name", shown_readiness, memory, .required = true,
              .doc = "full: requests that need much memory are refused."),
};
const api_record api_readiness_record = API_RECORD("readiness", readiness_fields);

typedef struct shown_version {
    const char *name, *version;
} shown_version;

static const api_field version_fields[] = {
    API_FIELD("name", "text", shown_version, name, .required = true),
    API_FIELD("version", "text", shown_version, version, .required = true),
};
const api_record api_version_record = API_RECORD("version", version_fields);

typedef struct shown_index {
    const char *name, *version, *meshes, *jobs, *operations, *problems, *openapi, *docs;
} shown_index;

static const api_field index_fields[] = {
    API_FIELD("name", "text", shown_index, name, .required = true),
    API_FIELD("version", "text", shown_index, version, .required = true),
    API_FIELD("meshes", "text", shown_index, meshes, .required = true,
              .doc = "The path of the list of meshes."),
    API_FIELD("jobs", "text", shown_index, jobs, .required = true,
              .doc = "The path of the list of jobs."),
    API_FIELD("operations", "text", shown_index, operations, .required = true,
              .doc = "The path of the table of operations."),
    API_FIELD("problems", "text", shown_index, problems, .required = true,
              .doc = "The path of the table of problems."),
    API_FIELD("openapi", "text", shown_index, openapi, .required = true,
              .doc = "The path of the OpenAPI document."),
    API_FIELD("docs", "text", shown_index, docs, .required = true,
              .doc = "The path of the manual."),
};
const api_record api_index_record = API_RECORD("index", index_fields);

/* The values of the JSON members of one row of the table of problems. */
typedef struct shown_code {
    const char *code, *title, *doc;
    int status;
    char docs[64];
} shown_code;

static const api_field code_fields[] = {
    API_FIELD("code", "text", shown_code, code, .required = true),
    API_FIELD("status", "integer", shown_code, status, .required = true,
              .doc = "The usual HTTP status; if an element of the path does not exist, it is 404 "
                     "or 410 instead of 422."),
    API_FIELD("title", "text", shown_code, title, .required = true),
    API_FIELD("doc", "text", shown_code, doc, .required = true, .doc = "What the problem means."),
    API_FIELD("docs", "text", shown_code, docs, .required = true,
              .doc = "The path of its page in the manual."),
};
const api_record api_problem_row_record = API_RECORD("problem_row", code_fields);

/* The table of problems, from which the JSON members of the answer are written. */
typedef struct code_table {
    int count;
} code_table;

static void write_codes(api_out *out, const void *value)
{
    const code_table *table = value;
    api_out_array_begin(out);
    for (int code = HE_OK + 1; code < table->count; code++) {
        shown_code shown = {.code = api_code_slug(code),
                            .status = api_code_http(code),
                            .title = api_code_title(code),
                            .doc = api_code_explanation(code)};
        snprintf(shown.docs, sizeof shown.docs, "/docs/problems/%s", shown.code);
        api_record_write(out, &api_problem_row_record, &shown);
    }
    api_out_array_end(out);
}

static const api_field problems_fields[] = {
    API_FIELD_MADE("problems", "*#problem_row", write_codes, .required = true),
};
const api_record api_problems_record = API_RECORD("problems", problems_fields);

static void answer(api_exchange *x, const api_record *record, const void *value)
{
    api_record_write(&x->out, record, value);
    api_answer_json(x, 200);
}

void api_live_get(api_exchange *x)
{
    answer(x, &api_health_record, &(shown_health){"alive"});
}

void api_ready_get(api_exchange *x)
{
    const api_options *options = &x->service->options;
    st_health health;
    if (options->ready != NULL && !options->ready(options->ready_context)) {
        api_fail(x, API_NOT_READY, "the server is starting or stopping");
        return;
    }
    st_store_health(x->store, &health);
    if (health.status == ST_FAILED) {
        api_fail(x, API_STORE_FAILED, "the disk failed%s%s: start the server again",
                 health.reason[0] == '\0' ? "" : ", ", health.reason);
        return;
    }
    const bool full = options->is_full != NULL && options->is_full(options->ready_context);
    answer(x, &api_readiness_record,
           &(shown_readiness){.status = "ready",
                              .store = health.status == ST_FULL ? "full" : "writable",
                              .memory = full ? "full" : "free"});
}

void api_version_get(api_exchange *x)
{
    answer(x, &api_version_record, &(shown_version){"hedged", x->service->options.version});
}

void api_index_get(api_exchange *x)
{
    answer(x, &api_index_record,
           &(shown_index){.name = "hedged",
                          .version = x->service->options.version,
                          .meshes = "/v1/meshes",
                          .jobs = "/v1/jobs",
                          .operations = "/v1/operations",
                          .problems = "/v1/problems",
                          .openapi = "/v1/openapi.json",
                          .docs = "/docs"});
}

/* Sets the policy of a page; only the viewer itself, and not the manual, may be shown in frames. */
static void set_policy(api_exchange *x)
{
    const api_options *options = &x->service->options;
    const bool framed = options->frame_count > 0 && strcmp(x->request.path, "/") == 0;
    api_text policy = {0};
    api_text_add_string(&policy, viewer_policy);
    for (size_t i = 0; framed && i < options->frame_count; i++) {
        api_text_add_format(&policy, " %s", options->frames[i]);
    }
    api_text_add_string(&policy, framed ? "" : " 'none'");
    api_text_add_char(&policy, '\0');
    if (policy.failed) {
        (void)api_fail_memory(x);
    } else {
        api_answer_header(x, "Content-Security-Policy", policy.bytes);
    }
    api_text_clear(&policy);
}

/* Returns the file of the pages that is served under a path, or NULL. */
static const api_asset *find_asset(const api_exchange *x, const char *path)
{
    const api_options *options = &x->service->options;
    return options->asset == NULL ? NULL : options->asset(options->asset_context, path);
}

static void put_page_headers(api_exchange *x)
{
    set_policy(x);
    api_answer_header(x, "Referrer-Policy", "no-referrer");
}

/* Answers that nothing is at the path: with a page if the route has one for this and the client
 * accepts HTML, otherwise with a problem. */
static void answer_missing(api_exchange *x)
{
    const char *accept = x->request.headers[API_HEADER_ACCEPT];
    const api_asset *page = x->route->flags & API_MISSING_PAGE ? find_asset(x, "/docs/404") : NULL;
    if (page == NULL || accept == NULL || strstr(accept, "text/html") == NULL) {
        api_fail(x, API_NO_SUCH_ROUTE, "the server has no path \"%.150s\"", x->request.path);
    } else {
        const char *bytes;
        size_t length;
        api_kept_bytes(page->body, &bytes, &length);
        put_page_headers(x);
        api_answer_bytes(x, 404, page->type, bytes, length);
        x->kept = page->body;
    }
}

void api_page_get(api_exchange *x)
{
    /* The path is looked up as it was received, without decoding, because paths of assets contain
     * no percent escapes. */
    const api_asset *asset = find_asset(x, x->request.path);
    if (asset == NULL) {
        answer_missing(x);
        return;
    }
    api_answer_header(x, "Cache-Control",
                      asset->immutable ? "public, max-age=31536000, immutable" : "no-cache");
    if (strncmp(asset->type, "text/html", 9) == 0) {
        put_page_headers(x);
    }
    api_answer_kept(x, asset->type, asset->body);
}

void api_problem_get(api_exchange *x)
{
    int code = api_code_find(x->code);
    if (code < 0) {
        api_fail(x, API_NO_SUCH_ROUTE, "no problem has the code \"%.100s\"", x->code);
        return;
    }
    char page[64];
    snprintf(page, sizeof page, "/docs/problems/%s", api_code_slug(code));
    if (find_asset(x, page) != NULL) {
        /* The reference is relative, so that it is correct behind a proxy that adds a prefix. */
        api_answer_header_format(x, "Location", "..%s", page);
        api_answer_empty(x, 303);
        return;
    }
    api_problem_page(code, &x->text);
    api_answer_header(x, "Content-Security-Policy", text_policy);
    api_answer_text(x, 200, "text/html; charset=utf-8");
}

/* Answers with the document that is kept in `place`. If no request has needed the document before,
 * it is made with the function `write`. */
static void answer_document(api_exchange *x, _Atomic(api_kept *) *place,
                            void (*write)(api_out *out, const api_options *options))
{
    api_kept *found = atomic_load(place);
    if (found == NULL) {
        write(&x->out, &x->service->options);
        api_kept *made = x->text.failed ? NULL : api_kept_new(x->text.bytes, x->text.length);
        api_text_clear(&x->text);
        if (made == NULL) {
            api_fail_memory(x);
            return;
        }
        /* If another thread was faster, `found` now points to the document that the other thread
         * made; that document is sent. */
        if (atomic_compare_exchange_strong(place, &found, made)) {
            found = made;
        } else {
            api_kept_free(made);
        }
    }
    api_answer_header(x, "Cache-Control", "no-cache");
    api_answer_kept(x, "application/json", found);
}

static void write_operations(api_out *out, const api_options *options)
{
    (void)options;
    api_operations_write(out);
}

void api_operations_get(api_exchange *x)
{
    answer_document(x, &x->service->operations, write_operations);
}

static void write_problems(api_out *out, const api_options *options)
{
    (void)options;
    api_record_write(out, &api_problems_record, &(code_table){API_CODE_COUNT});
}

void api_problems_get(api_exchange *x)
{
    answer_document(x, &x->service->problems, write_problems);
}

static void write_openapi(api_out *out, const api_options *options)
{
    api_openapi_write(out, options->version, options->public_url);
}

void api_openapi_get(api_exchange *x)
{
    answer_document(x, &x->service->openapi, write_openapi);
}
