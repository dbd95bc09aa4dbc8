#include "api/request/api.h"

#include "api/job/job_out.h"
#include "api/request/admit.h"
#include "api/request/content_encoding.h"
#include "api/request/gate.h"
#include "api/request/gather.h"
#include "api/request/idempotency.h"
#include "api/request/mesh_access.h"
#include "api/request/rating.h"

#include <assert.h>
#include <stdio.h>
#include <string.h>

/* --- the end of an exchange --- */

static const char *header_of_answer(const api_answer *answer, const char *name)
{
    for (size_t i = 0; i < answer->header_count; i++) {
        const char *other = answer->headers[i].name;
        /* Most names differ in the first byte, which is faster than a call. */
        if (other[0] == name[0] && strcmp(other, name) == 0) {
            return answer->headers[i].value;
        }
    }
    return NULL;
}

static bool has_header(const api_exchange *x, const char *name)
{
    return header_of_answer(&x->answer, name) != NULL;
}

/* Adds a header to the answer, unless it has one with this name. Name and value must stay valid as
 * long as the exchange: they are not copied, so that this works when memory is out. */
static void put_header(api_exchange *x, const char *name, const char *value)
{
    if (x->answer.header_count < API_ANSWER_HEADERS && !has_header(x, name)) {
        x->answer.headers[x->answer.header_count++] = (api_header){name, value};
    }
}

static void free_blob(api_exchange *x)
{
    if (x->blob.self != NULL && x->blob.free != NULL) {
        x->blob.free(x->blob.self);
    }
    x->blob.self = NULL;
}

static void drop_answer(api_exchange *x)
{
    if (x->free_stream != NULL) {
        x->free_stream(x->stream);
        x->free_stream = NULL;
    }
    free_blob(x);
    x->answer = (api_answer){.route = x->answer.route, .close = x->answer.close};
    x->answered = false;
    x->kept = NULL;
}

static void answer_problem(api_exchange *x)
{
    drop_answer(x);
    api_text_empty(&x->text);
    api_problem_write(&x->problem, x->request.request_id, &x->text);
    x->answered = true;
    if (x->text.failed) {
        x->answer.status = 507;
        x->answer.bytes = api_problem_unwritten();
        x->answer.length = (int64_t)strlen(x->answer.bytes);
    } else {
        x->answer.status = api_problem_http(&x->problem);
        x->answer.bytes = x->text.bytes;
        x->answer.length = (int64_t)x->text.length;
    }
    put_header(x, "Content-Type", "application/problem+json");
    if (x->problem.code == API_METHOD_NOT_ALLOWED) {
        put_header(x, "Allow", x->allow);
    }
    if (x->problem.code == API_UNSUPPORTED_ENCODING) {
        put_header(x, "Accept-Encoding", api_codings_list);
    }
    const char *challenge = api_gate_challenge(x);
    if (challenge != NULL) {
        put_header(x, "WWW-Authenticate", challenge);
    }
    const char *retry = api_problem_retry(&x->problem, x->retry);
    if (retry != NULL) {
        put_header(x, "Retry-After", retry);
    }
}

/* Replaces the answer by the bare status of api_publish, because the write took effect. */
static void answer_published(api_exchange *x)
{
    x->problem = (api_problem){0};
    drop_answer(x);
    x->answered = true;
    x->answer.status = x->published;
    x->answer.bytes = "";
    if (x->published == 201) {
        put_header(x, "Location", x->location);
    }
}

/* Returns true if the route answers in several media types under one URL, so that caches must look
 * at Accept. */
static bool varies(const api_exchange *x)
{
    const api_route *route = x->route;
    return route != NULL && !x->at_gate && route->produces[0] != NULL &&
           route->produces[1] != NULL && !(route->flags & API_FIXED);
}

/* Ends the claim on the mesh (store/write.h) before the answer is sent, so that the client can
 * write to the mesh again as soon as it has the answer. */
static void end_claim(api_exchange *x)
{
    if (x->write.claimed) {
        st_write_abort(&x->write);
    }
}

/* If the work was stopped from outside (api_give_up), replaces the problem by the reason that
 * api_give_up has stored. */
static void end_given_up(api_exchange *x)
{
    if (x->progress.cancelled && x->problem.code != HE_OK) {
        x->problem = x->given_up;
        if (x->problem.code == HE_OK) {
            api_fail(x, HE_CANCELLED, "cancelled while %s", x->progress.phase);
        }
    }
}

/* Returns what must be durable before the answer is sent. An answer that is not about one mesh
 * alone, and also a refusal, may show whether other meshes exist; so it waits for the changes of
 * all meshes. */
static st_shown shown(const api_exchange *x)
{
    if (x->route == NULL || x->at_gate || (x->route->flags & (API_FIXED | API_STORELESS))) {
        return (st_shown){.position = 0};
    }
    /* Failures of the server itself depend on no mesh, so their answers wait for nothing. If they
     * waited for a journal that cannot be written, the client would get a refusal about lost
     * changes instead of this failure. */
    if (x->problem.code != HE_OK && api_problem_http(&x->problem) >= 500) {
        return (st_shown){.position = 0};
    }
    if (x->has_info && !x->shows_all) {
        st_shown one = st_shown_of(&x->info);
        one.position = x->noted > one.position ? x->noted : one.position;
        return one;
    }
    /* A write may have read other meshes. Their changes come before the write in the journal, so
     * waiting for the position of the write itself is enough. */
    if (x->published != 0 && x->has_info && x->info.position != 0) {
        return (st_shown){.position = x->info.position, .since = x->since};
    }
    return st_shown_all(x->store, x->since);
}

/* Frees what the handler needed for its work: its state, the body and the mesh. */
static void free_work(api_exchange *x)
{
    if (x->free_state != NULL) {
        x->free_state(x->state);
        x->free_state = NULL;
    }
    api_document_clear(&x->document);
    api_text_clear(&x->body);
    api_arrays_clear(&x->arrays);
    st_snapshot_release(x->snapshot);
    x->snapshot = NULL;
    st_release(x->mesh);
    x->mesh = NULL;
}

/* Frees the body of a write and lets its mesh be evicted, because the answer needs neither while it
 * waits for the disk and then for the client. */
static void let_go(api_exchange *x)
{
    if (x->route != NULL && (x->route->flags & API_WRITES) && x->keyed == NULL &&
        x->free_stream == NULL && x->blob.self == NULL) {
        free_work(x);
    }
}

static api_step finish(api_exchange *x)
{
    end_claim(x);
    if (x->phase == API_PHASE_JOB) {
        api_gather(x);
    }
    end_given_up(x);
    if (x->problem.code == HE_OK && !x->answered) {
        api_fail(x, API_INTERNAL,
                 "the server has no answer for the route %s, which is an error in the server",
                 x->route == NULL ? "-" : x->route->name);
    }
    if (x->problem.code != HE_OK && x->published != 0) {
        answer_published(x);
    } else if (x->problem.code != HE_OK) {
        answer_problem(x);
    }
    put_header(x, "X-Request-Id", x->request.request_id);
    put_header(x, "X-Content-Type-Options", "nosniff");
    /* An answer with an ETag may be cached and revalidated; other answers may not be stored. */
    put_header(x, "Cache-Control", has_header(x, "ETag") ? "no-cache" : "no-store");
    if (x->rates != NULL) {
        api_rate_fields_of(x, &x->rate_fields);
        put_header(x, "RateLimit-Policy", x->rate_fields.policy);
        put_header(x, "RateLimit", x->rate_fields.left);
    }
    if (api_content_encoding_varies(x)) {
        put_header(x, "Vary", varies(x) ? "Accept, Accept-Encoding" : "Accept-Encoding");
    } else if (varies(x)) {
        put_header(x, "Vary", "Accept");
    }
    /* api_idempotency_settle may set x->noted, which shown() reads, so it is called first. */
    api_idempotency_settle(x);
    x->answer.shown = shown(x);
    x->answer.changed = x->published != 0;
    if (x->phase != API_PHASE_JOB) {
        /* Answers that are kept for jobs and Idempotency-Keys are not compressed. */
        api_content_encoding_answer(x);
    }
    let_go(x);
    x->phase = API_PHASE_DONE;
    return API_READY;
}

/* Ends an exchange with an answer before the body was read. The connection is closed, so that the
 * rest of the body is not taken for the next request. */
static api_step finish_early(api_exchange *x)
{
    x->answer.close =
        x->request.has_body && (!x->request.has_length || x->arrived < x->request.length);
    return finish(x);
}

/* --- beginning an exchange --- */

static bool copy_request(api_exchange *x, const api_request *request)
{
    const char *id = request->request_id == NULL ? "" : request->request_id;
    x->request = *request;
    x->request.method = api_arena_copy(&x->arena, request->method, strlen(request->method));
    x->request.path = api_arena_copy(&x->arena, request->path, strlen(request->path));
    x->request.query = api_arena_copy(&x->arena, request->query, strlen(request->query));
    size_t length = strlen(id);
    length = length > API_MAX_REQUEST_ID ? API_MAX_REQUEST_ID : length;
    x->request.request_id = api_arena_copy(&x->arena, id, length);
    return x->request.method != NULL && x->request.path != NULL && x->request.query != NULL &&
           x->request.request_id != NULL;
}

/* --- turning an exchange into a job --- */

/* Copies the headers of the request, because the work of a job reads them after the connection has
 * ended: preconditions when it commits, Accept when it answers. Returns false, with nothing
 * changed, when memory is out. */
static bool copy_headers(api_exchange *x)
{
    const char *copies[API_REQUEST_HEADERS] = {NULL};
    for (size_t i = 0; i < API_REQUEST_HEADERS; i++) {
        const char *value = x->request.headers[i];
        if (value != NULL) {
            copies[i] = api_arena_copy(&x->arena, value, strlen(value));
            if (copies[i] == NULL) {
                return false;
            }
        }
    }
    memcpy(x->request.headers, copies, sizeof copies);
    return true;
}

void api_set_progress(api_exchange *x, bool (*tell)(void *context, const char *phase, double done),
                      void *context)
{
    he_progress_init(&x->progress, tell, context);
    x->progress.parallel = x->service->options.parallel;
    x->out.progress = &x->progress;
}

void api_set_worker_progress(api_exchange *x,
                             bool (*tell)(void *context, const char *phase, double done),
                             void *context)
{
    if (x->route != NULL && !(x->route->flags & API_WRITES)) {
        api_set_progress(x, tell, context);
    }
}

void api_give_up(api_exchange *x, int code, const char *text)
{
    x->given_up = (api_problem){0};
    api_problem_set(&x->given_up, code, "%s", text);
}

api_load api_load_of(const api_exchange *x)
{
    const char *mesh = x->mesh_id != NULL ? x->mesh_id : api_param_text(x, "id");
    uint64_t amount = x->received;
    if (x->mesh != NULL) {
        st_mesh_info info;
        amount += st_read_card(x->mesh, &info);
    }
    double seconds = (double)amount / API_EDIT_PER_SECOND;
    return (api_load){.reads = !(x->route->flags & API_WRITES),
                      .seconds = x->seconds > seconds ? x->seconds : seconds,
                      .mesh = mesh == NULL ? "" : mesh};
}

static api_exchange *exchange_new(api_service *service, const api_request *request)
{
    api_exchange *x = st_spares_take(&service->exchanges, sizeof *x);
    if (x == NULL) {
        return NULL;
    }
    memset(x, 0, sizeof *x);
    x->service = service;
    x->store = service->store;
    x->since = st_waits_durable(st_store_waits(x->store));
    x->kind = HE_KIND_COUNT;
    x->answer.route = "-";
    x->coding_in = API_IDENTITY;
    x->codings = (api_codings){.allowed = {[API_IDENTITY] = true}, .best = API_IDENTITY};
    api_out_init(&x->out, &x->text);
    api_set_progress(x, NULL, NULL);
    if (!copy_request(x, request)) {
        api_arena_clear(&x->arena);
        st_spares_put(&service->exchanges, x);
        return NULL;
    }
    return x;
}

static void answer_job(api_exchange *x, const api_job *job)
{
    api_write_job(&x->out, job, true);
    api_answer_header_format(x, "Location", "/v1/jobs/%s", job->id);
    if (x->prefer.respond_async) {
        api_answer_header(x, "Preference-Applied", "respond-async");
    }
    api_answer_json(x, 202);
}

/* Returns the bytes of the answer, which the job will own; NULL when memory is out or the answer
 * has no bytes. */
static char *take_bytes(api_exchange *x)
{
    const api_answer *answer = &x->answer;
    char *bytes = NULL;
    if (answer->bytes != NULL && answer->bytes == x->text.bytes) {
        bytes = he_mem_shrink(x->text.bytes, answer->length > 0 ? (size_t)answer->length : 0);
        x->text = (api_text){0};
    } else if (answer->bytes != NULL && answer->length > 0) {
        bytes = he_mem_alloc((size_t)answer->length);
        if (bytes != NULL) {
            memcpy(bytes, answer->bytes, (size_t)answer->length);
        }
    }
    return bytes;
}

/* Runs the work of the exchange as a job of the job table. */
static void run_job(void *self, const char *id, api_job_progress *progress, void *context,
                    api_job_outcome *out)
{
    api_exchange *x = self;
    x->own_job = id;
    api_set_progress(x, progress, context);
    api_work(x);
    const api_answer *answer = api_answer_of(x);
    const char *location = header_of_answer(answer, "Location");
    const char *type = header_of_answer(answer, "Content-Type");
    out->status = answer->status;
    out->location = location == NULL ? "" : location;
    for (size_t i = 0; i < API_JOB_HEADERS; i++) {
        out->headers[i] = header_of_answer(answer, api_job_header_names[i]);
    }
    out->shown =
        x->free_stream == NULL && type != NULL &&
        (api_media_is(type, "application/json") || api_media_is(type, "application/problem+json"));
    out->length = (size_t)answer->length;
    out->body = take_bytes(x);
    out->blob = x->blob;
    x->blob.self = NULL;
    out->awaits = answer->shown;
    out->changed = answer->changed;
}

static void free_job(void *self)
{
    api_free(self);
}

api_exchange *api_detach(api_exchange *x)
{
    api_job_table *jobs = x->service->options.jobs;
    assert(x->phase == API_PHASE_JOB);
    api_exchange *answer = exchange_new(x->service, &x->request);
    if (answer == NULL || !copy_headers(x)) {
        api_free(answer);
        return NULL;
    }
    memset(answer->request.headers, 0, sizeof answer->request.headers);
    answer->route = x->route;
    answer->answer.route = x->answer.route;
    answer->prefer = x->prefer;
    answer->codings = x->codings;
    answer->rates = x->rates;
    answer->rate_key = x->rate_key;
    answer->rate = x->rate;
    answer->rate_state = x->rate_state;
    api_job job;
    const uint64_t most = api_token_limit(x->token, API_LIMIT_JOBS);
    const api_job_work work = {.self = x,
                               .run = run_job,
                               .free = free_job,
                               .seconds = api_load_of(x).seconds,
                               .about = x->mesh,
                               .holder = x->token == NULL ? "" : x->token->name,
                               .most = most,
                               .claims = x->write.claimed};
    const char *mesh = x->mesh_id != NULL ? x->mesh_id : api_param_text(x, "id");
    st_status status = api_job_submit(jobs, &work, x->route->name, mesh == NULL ? "" : mesh, &job);
    if (status == ST_OK) {
        answer_job(answer, &job);
    } else {
        api_free(x);
    }
    if (status == ST_TOO_MANY) {
        api_fail(answer, API_TOO_MANY_JOBS, "too many jobs are waiting");
    } else if (status == ST_QUOTA) {
        api_limited_count(&answer->service->limited, API_CLIENT_TOKEN, API_LIMIT_JOBS);
        api_fail(answer, API_TOO_MANY_JOBS_OF_TOKEN,
                 "the token may have at most %llu jobs that wait or run", (unsigned long long)most);
    } else if (status != ST_OK) {
        api_fail_store(answer, status);
    }
    finish(answer);
    return answer;
}

/* Receives decompressed bytes of the body. */
static bool take_body(void *context, const char *bytes, size_t length)
{
    api_exchange *x = context;
    x->received += length;
    api_idempotency_body(x, bytes, length);
    if (x->received > api_body_cap(x)) {
        api_refuse_size(x);
    } else if (x->route->body_kind == API_BODY_UPLOAD) {
        x->route->body(x, bytes, length);
    } else {
        api_text_add(&x->body, bytes, length);
        if (x->body.failed) {
            api_fail_memory(x);
        }
    }
    return x->problem.code == HE_OK && !x->answered;
}

static bool begin(api_exchange *x)
{
    if (!api_admit(x) || !api_idempotency_begin(x)) {
        return false;
    }
    x->reading = (api_reading){x->route->reads, x->route->cost, x->route->tag, x->route->run};
    x->prefer = api_prefer_read(x->request.headers[API_HEADER_PREFER]);
    x->body.maximum = (size_t)api_body_cap(x);
    if (x->coding_in != API_IDENTITY) {
        x->decompressor = api_decompressor_new(x->coding_in, &x->service->decompressing, take_body,
                                               x, &x->problem);
        if (x->decompressor == NULL) {
            return false;
        }
    }
    if (x->route->begin != NULL) {
        api_read_at_head(x);
    }
    return x->problem.code == HE_OK && !x->answered;
}

api_exchange *api_begin(api_service *service, const api_request *request, api_step *step)
{
    api_exchange *x = exchange_new(service, request);
    if (x == NULL) {
        return NULL;
    }
    st_store_serve(x->store);
    *step = begin(x) ? API_MORE : finish_early(x);
    st_store_serve(NULL);
    return x;
}

/* --- the request's body --- */

api_step api_body(api_exchange *x, const char *bytes, size_t length, size_t *used)
{
    *used = length;
    if (x->phase != API_PHASE_BODY) {
        return API_READY;
    }
    if (length == 0) {
        return API_MORE;
    }
    bool good;
    st_store_serve(x->store);
    if (x->arrived + length > api_body_cap(x)) {
        good = api_refuse_size(x);
    } else if (x->decompressor != NULL) {
        good = api_decompressor_feed(x->decompressor, bytes, length, used, &x->problem);
    } else {
        good = take_body(x, bytes, length);
    }
    x->arrived += *used;
    api_rating_charge(x, *used);
    const api_step step = good ? API_MORE : finish_early(x);
    st_store_serve(NULL);
    return step;
}

/* Ends the decompression of the body, when all of it has arrived, and frees the decoder, which may
 * hold megabytes. */
static bool end_coding(api_exchange *x)
{
    bool good = x->decompressor == NULL || api_decompressor_end(x->decompressor, &x->problem);
    api_decompressor_free(x->decompressor);
    x->decompressor = NULL;
    return good;
}

/* Parses the document of a body, which has arrays beside its JSON if it is of the type
 * API_PACKED_EDITS. */
static bool parse_document(api_exchange *x, api_in_options *options)
{
    api_bytes text = api_text_bytes(&x->body);
    const bool packed = x->media_in != NULL && api_media_is(x->media_in, API_PACKED_EDITS);
    if (packed) {
        x->ops.arrays = &x->arrays;
    }
    if (packed && !api_packed_open(text, &x->arrays, &text, &x->problem)) {
        return false;
    }
    options->before = packed ? (size_t)(text.at - x->body.bytes) : 0;
    return api_document_parse(text, options, &x->document, &x->root, &x->problem);
}

static bool parse_body(api_exchange *x)
{
    api_body_kind kind = x->route->body_kind;
    if (x->has_root) {
        return true; /* it was parsed to answer from the card of a mesh (load_and_go_on) */
    }
    if (kind == API_BODY_NONE || kind == API_BODY_UPLOAD) {
        return kind == API_BODY_NONE || x->received > 0 || api_refuse_empty(x);
    }
    if (x->received == 0) {
        return kind == API_BODY_OPTION || api_refuse_empty(x);
    }
    if (x->media_in != NULL && api_media_is(x->media_in, "application/octet-stream")) {
        return true; /* the handler reads the bytes in x->body */
    }
    api_in_options options = {.values = API_MAX_CONTROL_VALUES};
    if (kind == API_BODY_EDITS) {
        x->ops.name = "ops";
        options = (api_in_options){.values = API_MAX_EDITS_VALUES, .items = &x->ops};
    }
    x->has_root = parse_document(x, &options);
    if (x->ops.at == NULL && x->ops.arrays == NULL) {
        api_text_clear(&x->body);
    }
    return x->has_root;
}

/* Resets a reading request that took too long for a worker thread, so that it starts again on a
 * thread that may block. */
static void begin_anew(api_exchange *x)
{
    drop_answer(x);
    x->problem = (api_problem){0};
    api_text_empty(&x->text);
    api_out_init(&x->out, &x->text);
    api_set_progress(x, NULL, NULL);
    x->deferred = api_read;
}

static api_step finish_or_go_on(api_exchange *x)
{
    if (x->phase == API_PHASE_BODY && x->progress.cancelled && x->problem.code != HE_OK) {
        begin_anew(x);
    }
    if (x->deferred == NULL || x->answered || x->problem.code != HE_OK) {
        return finish(x);
    }
    x->phase = x->is_job ? API_PHASE_JOB : API_PHASE_WORK;
    return x->is_job ? API_JOB : API_WORK;
}

static void decode_and_read(api_exchange *x)
{
    if (x->route->decode == NULL || x->route->decode(x)) {
        api_read(x);
    }
}

static void run(api_exchange *x)
{
    if ((x->route->flags & API_COSTLY) && api_is_costly(x, x->received, API_COSTLY_UPLOAD)) {
        x->deferred = decode_and_read;
    } else {
        decode_and_read(x);
    }
}

static void parse_and_run(api_exchange *x)
{
    if (parse_body(x)) {
        run(x);
    }
}

/* Handles a request whose body has arrived: looks up its Idempotency-Key, parses and decodes its
 * document, and runs the handler. A large document is parsed on a thread that may block. */
static void go_on(api_exchange *x)
{
    if (!api_idempotency_find(x)) {
        return;
    }
    if (x->body.length > API_COSTLY_UPLOAD) {
        x->deferred = parse_and_run;
    } else {
        parse_and_run(x);
    }
}

/* Loads the mesh and handles the request as if the mesh had been in memory. This thread may block,
 * so it also does the work that a worker thread would defer, except the work of a job. A handler
 * that answers from the mesh's card reads the document of the body, so it is parsed before. */
static void load_and_go_on(api_exchange *x)
{
    if ((x->route->cold != NULL && !parse_body(x)) || api_answer_from_card(x) ||
        !api_load_mesh(x)) {
        return;
    }
    x->phase = API_PHASE_BODY;
    go_on(x);
    x->phase = API_PHASE_WORK;
    while (x->deferred != NULL && !x->is_job && !x->answered && x->problem.code == HE_OK) {
        void (*handler)(api_exchange * x) = x->deferred;
        x->deferred = NULL;
        handler(x);
    }
}

static api_step end(api_exchange *x)
{
    if (!end_coding(x)) {
        return finish(x);
    }
    if (x->is_cold) {
        x->deferred = load_and_go_on;
    } else {
        go_on(x);
    }
    return finish_or_go_on(x);
}

static api_step work(api_exchange *x)
{
    void (*handler)(api_exchange * x) = x->deferred;
    he_error err = {0};
    x->deferred = NULL;
    /* The request may have waited long for this thread, and the client may have disconnected. */
    if (he_progress_step(&x->progress, 0, 1, &err) != HE_OK) {
        api_fail_core(x, &err);
    } else {
        handler(x);
    }
    return finish_or_go_on(x);
}

api_step api_end(api_exchange *x)
{
    if (x->phase != API_PHASE_BODY) {
        return API_READY;
    }
    st_store_serve(x->store);
    const api_step step = end(x);
    st_store_serve(NULL);
    return step;
}

api_step api_work(api_exchange *x)
{
    if (x->phase != API_PHASE_WORK && x->phase != API_PHASE_JOB) {
        return API_READY;
    }
    st_store_serve(x->store);
    const api_step step = work(x);
    st_store_serve(NULL);
    return step;
}

const api_answer *api_answer_of(const api_exchange *x)
{
    return &x->answer;
}

void api_charge(api_exchange *x, uint64_t bytes)
{
    api_rating_charge(x, bytes);
}

void api_free(api_exchange *x)
{
    if (x == NULL) {
        return;
    }
    if (x->free_stream != NULL) {
        x->free_stream(x->stream);
    }
    free_blob(x);
    api_decompressor_free(x->decompressor);
    api_compressor_free(x->compressor);
    he_mem_free(x->coded);
    api_text_clear(&x->text);
    end_claim(x);
    if (x->keyed != NULL) {
        st_keyed_end(x->keyed);
    }
    free_work(x);
    api_token_release(x->token);
    api_arena_clear(&x->arena);
    st_spares_put(&x->service->exchanges, x);
}

api_exchange *api_handle(api_service *service, const api_request *request, const char *body,
                         size_t length)
{
    api_step step;
    api_exchange *x = api_begin(service, request, &step);
    if (x == NULL) {
        return NULL;
    }
    for (size_t at = 0, used; step == API_MORE && at < length; at += used) {
        step = api_body(x, body + at, length - at, &used);
    }
    if (step == API_MORE) {
        step = api_end(x);
    }
    if (step == API_WORK) {
        step = api_work(x);
    }
    if (step == API_JOB) {
        api_exchange *answer = api_detach(x);
        if (answer == NULL) {
            api_free(x);
        }
        x = answer;
    }
    return x;
}
