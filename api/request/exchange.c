#include "api/request/exchange.h"

#include "api/request/gate.h"
#include "api/request/quota.h"
#include "api/request/token_stream.h"
#include "format/text/number.h"

#include <assert.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

/* --- query parameters --- */

static const char *find_value(const api_exchange *x, const char *name)
{
    for (size_t i = 0; i < x->query.count; i++) {
        if (strcmp(x->query.pairs[i].name, name) == 0) {
            return x->query.pairs[i].value;
        }
    }
    return NULL;
}

const char *api_param_text(const api_exchange *x, const char *name)
{
    return find_value(x, name);
}

bool api_param_flag(const api_exchange *x, const char *name)
{
    const char *value = find_value(x, name);
    return value != NULL && strcmp(value, "true") == 0;
}

uint64_t api_param_u64(const api_exchange *x, const char *name, uint64_t fallback)
{
    const char *value = find_value(x, name);
    uint64_t number = fallback;
    size_t used;
    if (value != NULL && he_u64_parse(value, value + strlen(value), &number, &used) != HE_OK) {
        assert(!"an invalid parameter has passed the checks of the route");
    }
    return number;
}

double api_param_number(const api_exchange *x, const char *name, double fallback)
{
    const char *value = find_value(x, name);
    double number = fallback;
    size_t used;
    if (value != NULL &&
        he_double_parse(value, value + strlen(value), HE_JSON_NUMBER, &number, &used) != HE_OK) {
        assert(!"an invalid parameter has passed the checks of the route");
    }
    return number;
}

static const api_parameter *find_parameter(const api_exchange *x, const char *name)
{
    for (const api_parameter *const *p = x->route->parameters; *p != NULL; p++) {
        if (strcmp((*p)->name, name) == 0) {
            return *p;
        }
    }
    return NULL;
}

int api_param_choice(const api_exchange *x, const char *name)
{
    const char *value = find_value(x, name);
    const api_parameter *parameter = find_parameter(x, name);
    for (int i = 0; value != NULL && parameter != NULL && parameter->choices[i] != NULL; i++) {
        if (strcmp(parameter->choices[i], value) == 0) {
            return i;
        }
    }
    return -1;
}

unsigned api_param_choices(const api_exchange *x, const char *name)
{
    const char *value = find_value(x, name);
    const api_parameter *parameter = find_parameter(x, name);
    unsigned out = 0;
    if (value != NULL && !api_choices_parse(parameter->choices, value, &out)) {
        assert(!"an invalid parameter has passed the checks of the route");
    }
    return out;
}

bool api_param_has_choice(const api_exchange *x, const char *name, const char *choice)
{
    const char *value = find_value(x, name);
    return value != NULL && strcmp(value, choice) == 0;
}

/* --- refusals --- */

bool api_fail(api_exchange *x, int code, const char *format, ...)
{
    char text[API_PROBLEM_DETAIL];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    return api_problem_set(&x->problem, code, "%s", text);
}

bool api_fail_core(api_exchange *x, const he_error *err)
{
    return api_problem_set_core(&x->problem, err);
}

bool api_fail_path(api_exchange *x, const he_error *err)
{
    return api_problem_set_path(&x->problem, err);
}

/* Refuses a request to a mesh whose changes were lost. If the store cannot write now, a write is
 * refused with the reason why it cannot. */
static bool fail_lost(api_exchange *x)
{
    st_health health;
    st_store_health(x->store, &health);
    return (x->route->flags & API_WRITES) && health.status != ST_OK
               ? api_fail_store(x, health.status)
               : api_fail(x, API_STORE_LOST,
                          "a change of this mesh could not be saved and was lost");
}

st_cause api_cause(const api_exchange *x)
{
    return (st_cause){
        .keyed = x->keyed, .job = x->own_job, .holder = x->token == NULL ? "" : x->token->name};
}

bool api_fail_store(api_exchange *x, st_status status)
{
    x->shows_all |= status == ST_ABSENT || status == ST_TAKEN || status == ST_TOO_MANY;
    switch (status) {
    case ST_OK:
        break;
    case ST_ABSENT:
        return api_fail(x, API_NO_SUCH_MESH, "no mesh has the id \"%s\"",
                        x->mesh_id == NULL ? "" : x->mesh_id);
    case ST_TAKEN:
        return api_fail(x, API_MESH_EXISTS, "another mesh has this id");
    case ST_NO_MEMORY:
        return api_fail_memory(x);
    case ST_BUDGET:
        return api_fail(x, API_MEMORY_BUDGET,
                        "the memory budget has not enough space left for the mesh");
    case ST_TOO_MANY:
        return api_fail(x, API_TOO_MANY_MESHES,
                        "the server already holds as many meshes as it is allowed to");
    case ST_BUSY:
        return x->info.job[0] == '\0'
                   ? api_fail(x, API_MESH_BUSY, "a long operation is changing the mesh")
                   : api_fail(x, API_MESH_BUSY, "job %s is changing the mesh: see /v1/jobs/%s",
                              x->info.job, x->info.job);
    case ST_NOTHING:
        return api_fail(x, API_NOTHING_TO_UNDO, "no edit is left to undo");
    case ST_LISTENERS:
        return api_fail(x, API_OVERLOADED, "too many clients are listening to events");
    case ST_AHEAD:
        return api_fail(x, API_NO_SUCH_REVISION,
                        "the mesh does not have the requested revision yet");
    case ST_GONE:
        return api_fail(x, API_REVISION_GONE,
                        "the history does not reach back to the requested revision");
    case ST_ELSEWHERE:
        return api_fail(x, API_UNREACHABLE_REVISION,
                        "neither undo nor redo leads to the requested revision");
    case ST_LOST:
        return fail_lost(x);
    case ST_BEHIND:
        return api_fail(x, API_STORE_BEHIND, "too many changes are waiting for the disk");
    case ST_FULL:
        return api_fail(x, API_STORE_FULL, "the disk is full");
    case ST_FAILED:
        return api_fail(
            x, API_STORE_FAILED,
            "the disk failed, and no changes are accepted until the server is restarted");
    case ST_TOO_LARGE:
        return api_fail(
            x, HE_LIMIT,
            "the change would take more than %d bytes in the history: make it in several steps",
            (int)ST_MOST_BODY);
    case ST_LOADING:
        return api_fail(x, API_LOADING, "the mesh is being loaded from the disk");
    case ST_DAMAGED:
        return api_fail(x, API_MESH_DAMAGED, "%s", x->mesh == NULL ? "" : st_damage(x->mesh));
    case ST_NEWER:
        return api_fail(x, API_MESH_NEWER, "%s", x->mesh == NULL ? "" : st_damage(x->mesh));
    case ST_QUOTA:
        return api_quota_fail_new(x);
    case ST_COLD:
        break;
    }
    return api_fail(x, API_INTERNAL, "the store failed without giving a reason");
}

bool api_fail_memory(api_exchange *x)
{
    return api_fail(x, HE_NO_MEMORY, "no memory for the request");
}

bool api_fail_accept(api_exchange *x)
{
    api_fail(x, API_NOT_ACCEPTABLE,
             "Accept \"%.100s\" allows none of the media types of the answer",
             x->request.headers[API_HEADER_ACCEPT]);
    x->problem.supported = x->route->produces;
    return false;
}

/* --- writing to the mesh --- */

static bool refuse_stale(api_exchange *x, const char *what)
{
    api_fail(x, API_STALE, "%s; the present revision of the mesh is %llu", what,
             (unsigned long long)x->info.revision);
    x->problem.has_revision = true;
    x->problem.revision = x->info.revision;
    return false;
}

bool api_preconditions_hold(api_exchange *x, const uint64_t *expected)
{
    const char *match = x->request.headers[API_HEADER_IF_MATCH];
    const char *none = x->request.headers[API_HEADER_IF_NONE_MATCH];
    if (match != NULL && !api_etag_is_present(match, &x->info)) {
        return refuse_stale(x, "If-Match does not name the present state of the mesh");
    }
    if (none != NULL && api_etag_is_present(none, &x->info)) {
        return api_fail(x, API_PRECONDITION,
                        "the mesh exists in a state in which If-None-Match forbids the request");
    }
    if (expected != NULL && *expected != x->info.revision) {
        char what[64];
        snprintf(what, sizeof what, "the mesh is not at revision %llu",
                 (unsigned long long)*expected);
        return refuse_stale(x, what);
    }
    return true;
}

static bool read_expected(const api_in *expected, uint64_t *revision)
{
    return expected == NULL || api_in_u64(expected, 1, (uint64_t)1 << 53, revision);
}

/* Handles the result of beginning a write: sets x->info and refuses if the write did not begin.
 * x->info is also set for a refusal, which is sent only when the state that it reports is
 * durable. */
static bool write_began(api_exchange *x, st_status status)
{
    x->info = x->write.info;
    x->has_info = status != ST_ABSENT;
    if (status == ST_OK && x->info.busy && !(x->route->flags & API_INTERRUPTS)) {
        st_write_abort(&x->write);
        status = ST_BUSY;
    }
    return status == ST_OK || api_fail_store(x, status);
}

bool api_write_begin(api_exchange *x, const api_in *expected)
{
    uint64_t revision = 0;
    const st_cause cause = api_cause(x);
    if (!read_expected(expected, &revision) ||
        !write_began(x, st_write_begin(x->mesh, &cause, &x->write))) {
        return false;
    }
    if (api_preconditions_hold(x, expected == NULL ? NULL : &revision)) {
        return true;
    }
    st_write_abort(&x->write);
    return false;
}

bool api_write_claim(api_exchange *x, const api_in *expected)
{
    uint64_t revision = 0;
    const st_cause cause = api_cause(x);
    return read_expected(expected, &revision) &&
           write_began(x, st_write_claim(x->mesh, &cause, &x->write)) &&
           /* If the preconditions hold now, they hold until the claim ends, because no other write
            * can change the mesh. */
           api_preconditions_hold(x, expected == NULL ? NULL : &revision);
}

bool api_write_commit(api_exchange *x, const char *ops)
{
    if (!api_gate_may_change(x)) {
        st_write_abort(&x->write);
        return false;
    }
    st_status status = st_write_commit(&x->write, ops);
    if (status != ST_OK) {
        x->has_info = x->has_info && status != ST_ABSENT;
        return status == ST_QUOTA ? api_quota_fail(x) : api_fail_store(x, status);
    }
    x->info = x->write.info;
    api_publish(x, 204);
    return true;
}

bool api_precondition_absent(api_exchange *x)
{
    return x->request.headers[API_HEADER_IF_MATCH] == NULL ||
           api_fail(x, API_PRECONDITION, "If-Match is given, but the mesh does not exist");
}

/* --- long work --- */

void api_defer(api_exchange *x, void (*handler)(api_exchange *x))
{
    if (x->phase == API_PHASE_BODY) {
        x->deferred = handler;
    } else {
        handler(x);
    }
}

bool api_can_be_job(const api_exchange *x)
{
    return x->service->options.jobs != NULL && x->route != NULL && (x->route->flags & API_LONG) &&
           x->phase != API_PHASE_JOB;
}

double api_patience(const api_exchange *x)
{
    if (!api_can_be_job(x)) {
        return HUGE_VAL;
    }
    if (x->prefer.wait >= 0) {
        return x->prefer.wait;
    }
    return x->prefer.respond_async ? -1 : API_PATIENCE;
}

bool api_wants_job(const api_exchange *x, double seconds)
{
    return seconds > api_patience(x);
}

void api_run_long(api_exchange *x, void (*handler)(api_exchange *x), bool costly, double seconds)
{
    assert(x->route->flags & API_LONG);
    x->is_job = api_wants_job(x, seconds);
    x->seconds = seconds;
    if (x->is_job || (costly && x->phase == API_PHASE_BODY)) {
        x->deferred = handler;
    } else {
        handler(x);
    }
}

bool api_is_costly(const api_exchange *x, uint64_t amount, uint64_t threshold)
{
    return x->phase == API_PHASE_BODY && amount > threshold;
}

uint64_t api_elements_of(const he_mesh *mesh)
{
    return (uint64_t)he_mesh_issued(mesh, HE_VERTEX) + he_mesh_issued(mesh, HE_HALFEDGE) +
           he_mesh_issued(mesh, HE_FACE);
}

bool api_is_large(const api_exchange *x, const he_mesh *mesh)
{
    return api_is_costly(x, api_elements_of(mesh), API_COSTLY_ELEMENTS);
}

/* --- answers --- */

void api_publish(api_exchange *x, int status)
{
    x->published = status;
    if (status == 201) {
        snprintf(x->location, sizeof x->location, "/v1/meshes/%s", x->info.id);
    }
}

void api_answer_header(api_exchange *x, const char *name, const char *value)
{
    const char *copy = api_arena_copy(&x->arena, value, strlen(value));
    if (copy == NULL) {
        api_fail_memory(x);
        return;
    }
    size_t i = 0;
    while (i < x->answer.header_count && strcmp(x->answer.headers[i].name, name) != 0) {
        i++;
    }
    assert(i < API_ANSWER_HEADERS);
    x->answer.headers[i] = (api_header){name, copy};
    x->answer.header_count += i == x->answer.header_count;
}

void api_answer_header_format(api_exchange *x, const char *name, const char *format, ...)
{
    char text[API_HEADER_TEXT];
    va_list arguments;
    va_start(arguments, format);
    int length = vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    assert(length >= 0 && (size_t)length < sizeof text);
    (void)length;
    api_answer_header(x, name, text);
}

void api_answer_bytes(api_exchange *x, int status, const char *type, const char *bytes,
                      size_t length)
{
    assert(!x->answered);
    x->answered = true;
    x->answer.status = status;
    x->answer.bytes = bytes;
    x->answer.length = (int64_t)length;
    if (type != NULL) {
        api_answer_header(x, "Content-Type", type);
    }
}

void api_answer_text(api_exchange *x, int status, const char *type)
{
    if (x->text.failed) {
        api_fail_memory(x);
    } else {
        api_answer_bytes(x, status, type, x->text.bytes, x->text.length);
    }
}

void api_answer_json(api_exchange *x, int status)
{
    api_answer_text(x, status, "application/json");
}

void api_answer_empty(api_exchange *x, int status)
{
    api_answer_bytes(x, status, NULL, "", 0);
}

bool api_answer_minimal(api_exchange *x)
{
    if (x->prefer.minimal) {
        api_answer_header(x, "Preference-Applied", "return=minimal");
        api_answer_empty(x, 204);
    }
    return x->prefer.minimal;
}

void api_answer_stream(api_exchange *x, int status, const char *type, const api_stream *stream)
{
    api_answer_bytes(x, status, type, NULL, 0);
    x->answer.length = stream->length;
    x->answer.read = stream->read;
    x->answer.context = stream->self;
    x->stream = stream->self;
    x->free_stream = stream->free;
}

static int64_t read_blob(void *context, char *buffer, size_t size)
{
    api_exchange *x = context;
    int64_t got = x->blob.read(x->blob.self, x->blob_at, buffer, size);
    x->blob_at += got > 0 ? (uint64_t)got : 0;
    return got;
}

void api_answer_blob(api_exchange *x, int status, const char *type, const api_blob *blob)
{
    const api_stream stream = {.length = (int64_t)blob->length, .read = read_blob, .self = x};
    x->blob = *blob;
    x->blob_at = 0;
    api_answer_stream(x, status, type, &stream);
    x->answer.slow = true;
}

void api_answer_live(api_exchange *x, int status, const char *type, const api_source *source)
{
    x->live = *source;
    if (x->token != NULL &&
        !api_token_stream_new(x->service->options.tokens, x->token, source, &x->live)) {
        source->free(source->self);
        api_fail_memory(x);
        return;
    }
    api_answer_bytes(x, status, type, NULL, 0);
    x->answer.length = -1;
    x->answer.live = &x->live;
    x->stream = x->live.self;
    x->free_stream = x->live.free;
}

void api_answer_etag(api_exchange *x, const char *representation)
{
    char etag[API_ETAG];
    api_etag_write(&x->info, representation, etag);
    api_answer_header(x, "ETag", etag);
}

bool api_not_modified_since(api_exchange *x, const char *etag)
{
    char coded[API_ETAG];
    api_coding coding;
    const char *none = x->request.headers[API_HEADER_IF_NONE_MATCH];
    /* A job never answers 304: its client asked for the result, and the mesh may have got the ETag
     * in If-None-Match only after the request was sent. */
    if (none == NULL || x->phase == API_PHASE_JOB ||
        !api_etag_listed(none, etag, &x->codings, &coding)) {
        api_answer_header(x, "ETag", etag);
        return false;
    }
    api_etag_code(etag, coding, coded);
    api_answer_header(x, "ETag", coded);
    api_answer_empty(x, 304);
    return true;
}

void api_answer_kept(api_exchange *x, const char *type, api_kept *kept)
{
    const char *bytes;
    size_t length;
    if (!api_not_modified_since(x, api_kept_etag(kept))) {
        api_kept_bytes(kept, &bytes, &length);
        api_answer_bytes(x, 200, type, bytes, length);
        x->kept = kept;
    }
}

bool api_not_modified(api_exchange *x, const char *representation)
{
    char etag[API_ETAG];
    api_etag_write(&x->info, representation, etag);
    return api_not_modified_since(x, etag);
}
