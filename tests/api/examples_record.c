#include "tests/api/examples_record.h"

#include "api/json/json_out.h"

#include <regex.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { WIDTH = 100, INDENT = 2, NAME = 256, MOST_JOBS = 4 };

/* The default of the daemon's option --undo-budget. */
static const uint64_t UNDO_BUDGET = (uint64_t)256 << 20;

/* --- layout --- */

/* Appends a JSON value without line breaks. */
static void add_line(const api_examples *file, uint32_t value, api_text *out)
{
    api_text text = {0};
    bool quoted = false;
    api_example_value(file, value, &text);
    for (size_t i = 0; i < text.length; i++) {
        char c = text.bytes[i];
        api_text_add_char(out, c);
        if (quoted && c == '\\') {
            api_text_add_char(out, text.bytes[++i]);
        } else if (c == '"') {
            quoted = !quoted;
        } else if (!quoted && (c == ':' || c == ',')) {
            api_text_add_char(out, ' ');
        }
    }
    api_text_clear(&text);
}

static void add_indent(api_text *out, size_t depth)
{
    api_text_add_char(out, '\n');
    for (size_t i = 0; i < depth * INDENT; i++) {
        api_text_add_char(out, ' ');
    }
}

/* Appends a JSON value that begins in column `column` and is followed by a comma, on several lines
 * if it does not fit on one. */
static void lay_out(const api_examples *file, uint32_t value, size_t depth, size_t column,
                    api_text *out)
{
    const he_json *json = &file->json;
    const size_t before = out->length;
    char type = he_json_type(json, value);
    add_line(file, value, out);
    if (column + (out->length - before) + 1 <= WIDTH || (type != '{' && type != '[')) {
        return;
    }
    out->length = before;
    api_text_add_char(out, type);
    for (uint32_t i = he_json_first(json, value); i != HE_NONE;) {
        const uint32_t next = he_json_after(json, value, i);
        size_t start = out->length;
        add_indent(out, depth + 1);
        if (type == '{') {
            add_line(file, i, out);
            api_text_add_string(out, ": ");
        }
        lay_out(file, type == '{' ? he_json_of(i) : i, depth + 1, out->length - start - 1, out);
        if (next != HE_NONE) {
            api_text_add_char(out, ',');
        }
        i = next;
    }
    add_indent(out, depth);
    api_text_add_char(out, type == '{' ? '}' : ']');
}

void examples_lay_out(const char *json, size_t length, api_text *out)
{
    api_examples tree = {0};
    he_error err;
    assert_int_equal(he_json_parse(&tree.json, json, length, 0, NULL, &err), HE_OK);
    lay_out(&tree, 0, 0, 0, out);
    api_text_add_char(out, '\n');
    api_examples_clear(&tree);
}

/* --- the session --- */

typedef struct job {
    /* `shown` is the id of the job in the examples file, `real` its id in the present run */
    char shown[NAME], real[NAME];
} job;

typedef struct session {
    const api_examples *file;
    api_bench *bench;
    job jobs[MOST_JOBS];
    size_t job_count;
} session;

const api_route *examples_route(const char *name)
{
    for (size_t i = 0; i < api_routes().count; i++) {
        if (strcmp(api_routes().rows[i].name, name) == 0) {
            return &api_routes().rows[i];
        }
    }
    fail_msg("an example is of %s, which is no route", name);
    return NULL;
}

/* Reads a member that is a string; without that member `out` becomes "". */
static void string_of(const session *s, uint32_t object, const char *name, char out[NAME])
{
    const he_json *json = &s->file->json;
    (void)he_json_string(json, he_json_find(json, object, name), out, NAME);
}

static void swap_bytes(api_text *text, const char *bytes, size_t length)
{
    api_text_clear(text);
    api_text_add(text, bytes, length);
    api_text_add_char(text, '\0');
    text->length--;
    assert_false(text->failed);
}

/* Replaces each occurrence of the string `from` by `to`. */
static void replace_all(api_text *text, const char *from, const char *to)
{
    api_text out = {0};
    const char *at = text->bytes, *found;
    while ((found = strstr(at, from)) != NULL) {
        api_text_add(&out, at, (size_t)(found - at));
        api_text_add_string(&out, to);
        at = found + strlen(from);
    }
    api_text_add_string(&out, at);
    swap_bytes(text, out.bytes, out.length);
    api_text_clear(&out);
}

/* Replaces parts of the text by what the examples file shows for them. Entry `row` of the file's
 * list "differs" gives a pattern and the text "shown", which replaces each match of the pattern. */
static void show(const session *s, uint32_t row, api_text *text)
{
    char after[NAME], form[NAME], shown[NAME], pattern[2 * NAME + 2];
    regex_t compiled;
    regmatch_t match[2];
    string_of(s, row, "after", after);
    string_of(s, row, "form", form);
    string_of(s, row, "shown", shown);
    snprintf(pattern, sizeof pattern, "(%s)%s", after, form);
    assert_int_equal(regcomp(&compiled, pattern, REG_EXTENDED), 0);
    api_text out = {0};
    const char *at = text->bytes;
    while (regexec(&compiled, at, 2, match, 0) == 0) {
        api_text_add(&out, at, (size_t)match[1].rm_eo);
        api_text_add_string(&out, shown);
        at += match[0].rm_eo;
    }
    api_text_add_string(&out, at);
    swap_bytes(text, out.bytes, out.length);
    api_text_clear(&out);
    regfree(&compiled);
}

/* Replaces the parts of an answer that differ from run to run, such as ids, by the fixed texts that
 * the examples file has in their place. */
static void settle(const session *s, api_text *text)
{
    const he_json *json = &s->file->json;
    uint32_t rows = he_json_find(json, 0, "differs");
    for (size_t i = 0; i < s->job_count; i++) {
        replace_all(text, s->jobs[i].real, s->jobs[i].shown);
    }
    for (uint32_t i = he_json_first(json, rows); i != HE_NONE; i = he_json_after(json, rows, i)) {
        show(s, i, text);
    }
}

static bool is_refusal(const char *type)
{
    return strcmp(type, "application/problem+json") == 0;
}

static bench_reply send(const session *s, uint32_t row, bool async)
{
    char name[NAME], target[NAME], consumes[NAME], accept[NAME];
    api_text path = {0}, body = {0};
    string_of(s, row, "route", name);
    string_of(s, row, "target", target);
    string_of(s, row, "consumes", consumes);
    string_of(s, row, "produces", accept);
    swap_bytes(&path, target, strlen(target));
    for (size_t i = 0; i < s->job_count; i++) {
        replace_all(&path, s->jobs[i].shown, s->jobs[i].real);
    }
    bool has_body = api_example_body(s->file, row, API_EXAMPLE_REQUEST, &body);
    api_text_add_char(&body, '\0');
    /* A refusal is sent as application/problem+json whatever the header Accept says, so this
     * request accepts any media type. */
    const char *headers[7] = {"Accept", accept[0] == '\0' || is_refusal(accept) ? "*/*" : accept};
    size_t used = 2;
    if (consumes[0] != '\0') {
        headers[used++] = "Content-Type";
        headers[used++] = consumes;
    }
    if (async) {
        headers[used++] = "Prefer";
        headers[used++] = "respond-async";
    }
    const api_route *route = examples_route(name);
    bench_reply r =
        bench_send(s->bench, route->method, path.bytes, headers, has_body ? body.bytes : NULL);
    if (r.route == NULL || strcmp(r.route, route->path) != 0) {
        fail_msg("%s %s reaches %s and not %s", route->method, path.bytes, r.route, route->path);
    }
    api_text_clear(&path);
    api_text_clear(&body);
    return r;
}

/* Sends a request of the list "before" in the examples file: it makes what the examples need. */
static void prepare(session *s, uint32_t row)
{
    static const char jobs[] = "/v1/jobs/";
    char id[NAME];
    string_of(s, row, "job", id);
    bench_reply r = send(s, row, id[0] != '\0');
    assert_in_range(r.status, 200, 299);
    if (id[0] != '\0') {
        const char *location = bench_header(&r, "Location");
        assert_int_equal(r.status, 202);
        assert_int_equal(strncmp(location, jobs, strlen(jobs)), 0);
        assert_true(s->job_count < MOST_JOBS);
        job *j = &s->jobs[s->job_count++];
        snprintf(j->shown, sizeof j->shown, "%s", id);
        snprintf(j->real, sizeof j->real, "%s", location + strlen(jobs));
        assert_int_equal(strlen(j->shown), strlen(j->real));
    }
    if (he_json_find(&s->file->json, row, "runs") != HE_NONE) {
        bench_run_jobs(s->bench, 1);
    }
    bench_reply_free(&r);
}

/* --- recording --- */

/* Returns true if the text is a JSON object or array that is written without blanks. */
static bool is_plain_json(const api_text *text)
{
    api_examples tree = {0};
    api_text again = {0};
    he_error err;
    if (text->length == 0 || (text->bytes[0] != '{' && text->bytes[0] != '[') ||
        he_json_parse(&tree.json, text->bytes, text->length, 0, NULL, &err) != HE_OK) {
        return false;
    }
    api_example_value(&tree, 0, &again);
    bool same = again.length == text->length && memcmp(again.bytes, text->bytes, again.length) == 0;
    api_text_clear(&again);
    api_examples_clear(&tree);
    return same;
}

static void write_response(api_out *out, const api_text *text)
{
    if (is_plain_json(text)) {
        api_out_key(out, "response");
        api_out_raw(out, text->bytes, text->length);
        return;
    }
    api_out_key(out, "response_text");
    api_out_array_begin(out);
    for (size_t at = 0; at < text->length;) {
        const char *end = memchr(text->bytes + at, '\n', text->length - at);
        size_t length = end == NULL ? text->length - at : (size_t)(end + 1 - text->bytes) - at;
        api_out_string_length(out, text->bytes + at, length);
        at += length;
    }
    api_out_array_end(out);
}

/* Copies a member of an example to the output, if the example has this member. */
static void copy_member(const session *s, uint32_t row, const char *name, api_out *out)
{
    uint32_t value = he_json_find(&s->file->json, row, name);
    if (value != HE_NONE) {
        api_text text = {0};
        api_example_value(s->file, value, &text);
        api_out_key(out, name);
        api_out_raw(out, text.bytes, text.length);
        api_text_clear(&text);
    }
}

static void record(const session *s, uint32_t row, api_out *out)
{
    static const char *const kept[] = {"route", "target", "consumes", "request", "request_text"};
    char type[NAME];
    api_text text = {0};
    bench_reply r = send(s, row, false);
    swap_bytes(&text, r.body, r.length);
    settle(s, &text);
    snprintf(type, sizeof type, "%s", bench_header(&r, "Content-Type"));
    type[strcspn(type, ";")] = '\0';
    api_out_object_begin(out);
    for (size_t i = 0; i < sizeof kept / sizeof *kept; i++) {
        copy_member(s, row, kept[i], out);
    }
    api_out_key_u64(out, "status", (uint64_t)r.status);
    api_out_key_string(out, "produces", type);
    if (strcmp(type, "application/octet-stream") != 0) { /* bytes would tell a reader nothing */
        write_response(out, &text);
    }
    api_out_object_end(out);
    api_text_clear(&text);
    bench_reply_free(&r);
}

void examples_record(const api_examples *file, api_text *out)
{
    const he_json *json = &file->json;
    session s = {.file = file, .bench = bench_new_within(UNDO_BUDGET, 0)};
    api_text text = {0};
    api_out to;
    api_out_init(&to, &text);
    uint32_t before = he_json_find(json, 0, "before");
    for (uint32_t i = he_json_first(json, before); i != HE_NONE;
         i = he_json_after(json, before, i)) {
        prepare(&s, i);
    }
    api_out_object_begin(&to);
    copy_member(&s, 0, "differs", &to);
    copy_member(&s, 0, "before", &to);
    api_out_key(&to, "examples");
    api_out_array_begin(&to);
    for (uint32_t i = he_json_first(json, file->list); i != HE_NONE;
         i = he_json_after(json, file->list, i)) {
        record(&s, i, &to);
    }
    api_out_array_end(&to);
    api_out_object_end(&to);
    assert_false(text.failed);
    examples_lay_out(text.bytes, text.length, out);
    api_text_clear(&text);
    bench_free(s.bench);
}
