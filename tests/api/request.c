#include "tests/api/request.h"

#include "api/request/answer_headers.h"
#include "api/request/exchange.h"

#include "tests/traffic.h"

#include "api/describe/routes.h"
#include "api/event/event_follow.h"
#include "api/job/job_table.h"

#include <pthread.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include <cmocka.h>

typedef struct piece {
    void (*work)(void *context);
    void *context;
} piece;

struct api_bench {
    st_pool *pool; /* the thread pool of the store */
    st_store *store;
    api_job_table *jobs;
    piece waiting[BENCH_JOBS];
    size_t waits, most;
    api_tokens *tokens; /* NULL: requests need no token */
    /* contents of the file of tokens that the next reload reads; NULL: there is no file */
    const char *file;
    char bearer[300]; /* token sent with each request; "": none */
    uint64_t address;
    bool is_beyond;
    const char *kept; /* contents of the backup file that POST /v1/admin/backup answers with */
    bool is_lent;     /* an answer with the backup file exists and is not freed yet */
    api_asset page;   /* the only page of the manual, that of the problem boundary_edge */
    api_service *service;
};

static const api_asset *find_asset(void *context, const char *path)
{
    const api_bench *b = context;
    return strcmp(path, "/docs/problems/boundary_edge") == 0 ? &b->page : NULL;
}

/* Puts a job into the bench's own queue. The bench has no threads: the job runs when the test calls
 * bench_run_jobs. */
static bool submit(void *pool, const st_task *task)
{
    api_bench *b = pool;
    if (b->waits == b->most) {
        return false;
    }
    b->waiting[b->waits++] = (piece){task->work, task->context};
    return true;
}

void bench_run_jobs(api_bench *b, size_t most)
{
    for (; b->waits > 0 && most > 0; most--) {
        piece next = b->waiting[0];
        b->waits--;
        memmove(b->waiting, b->waiting + 1, b->waits * sizeof *b->waiting);
        next.work(next.context);
    }
}

void bench_limit_jobs(api_bench *b, size_t most)
{
    b->most = most;
}

static bool reload(void *context, char *message, size_t size)
{
    api_bench *b = context;
    char why[API_TOKENS_MESSAGE] = "";
    api_tokens *tokens = b->tokens == NULL ? api_tokens_new() : b->tokens;
    bool good = b->file == NULL ||
                (tokens != NULL && api_tokens_load(tokens, b->file, strlen(b->file), why));
    if (b->tokens == NULL) {
        api_tokens_free(tokens);
    }
    snprintf(message, size, "%s", why);
    return good && (b->service == NULL || api_service_apply_quotas(b->service));
}

static int64_t read_kept(void *self, uint64_t at, char *buffer, size_t size)
{
    const api_bench *b = self;
    size_t left = strlen(b->kept) - (size_t)at, length = left < size ? left : size;
    memcpy(buffer, b->kept + at, length);
    return (int64_t)length;
}

static void free_kept(void *self)
{
    ((api_bench *)self)->is_lent = false;
}

static st_status back_up(void *context, api_blob *out, char *message, size_t size)
{
    api_bench *b = context;
    snprintf(message, size, "the disk is full");
    if (b->is_lent || b->kept[0] == '\0') {
        return b->is_lent ? ST_BUSY : ST_FAILED;
    }
    b->is_lent = true;
    *out = (api_blob){b, strlen(b->kept), read_kept, free_kept};
    return ST_OK;
}

typedef struct bench_limits {
    api_limits addresses;
    uint64_t burst;
} bench_limits;

static api_bench *bench_new_with(const st_journal *journal, uint64_t undo_budget, uint64_t upload,
                                 const char *file, const bench_limits *limits)
{
    api_bench *b = calloc(1, sizeof *b);
    assert_non_null(b);
    b->pool = st_pool_new("test", 1, 64);
    assert_non_null(b->pool);
    b->store = st_store_new(&(st_store_options){.undo_budget = undo_budget,
                                                .max_meshes = 100000,
                                                .journal = *journal,
                                                .listeners = 3,
                                                .mesh_listeners = 2,
                                                .render = api_event_render});
    assert_non_null(b->store);
    b->most = BENCH_JOBS;
    b->jobs = api_job_table_new(&(api_job_table_options){
        .store = b->store, .submit = submit, .pool = b, .keep = API_JOB_SECONDS});
    assert_non_null(b->jobs);
    b->file = file;
    if (file != NULL) {
        char message[API_TOKENS_MESSAGE];
        b->tokens = api_tokens_new();
        assert_non_null(b->tokens);
        if (!reload(b, message, sizeof message)) {
            fail_msg("%s", message);
        }
    }
    b->page = (api_asset){.type = "text/html; charset=utf-8", .body = api_kept_new("<p>", 3)};
    assert_non_null(b->page.body);
    b->service = api_service_new(b->store, api_routes(),
                                 &(api_options){.version = "0.0.0-test",
                                                .asset = find_asset,
                                                .asset_context = b,
                                                .max_upload = upload == 0 ? 8 << 20 : upload,
                                                .tokens = b->tokens,
                                                .address_limits = limits->addresses,
                                                .limit_burst = limits->burst,
                                                .reload = reload,
                                                .reload_context = b,
                                                .jobs = b->jobs,
                                                .pool = b->pool});
    assert_non_null(b->service);
    return b;
}

static const bench_limits unlimited = {.burst = 0};

api_bench *bench_new(void)
{
    return bench_new_within(64 << 20, 0);
}

api_bench *bench_new_over(const st_journal *journal)
{
    return bench_new_with(journal, 64 << 20, 0, NULL, &unlimited);
}

api_bench *bench_new_within(uint64_t undo_budget, uint64_t upload)
{
    const st_journal journal = st_journal_memory();
    return bench_new_with(&journal, undo_budget, upload, NULL, &unlimited);
}

api_bench *bench_new_guarded(const char *file)
{
    const st_journal journal = st_journal_memory();
    return bench_new_with(&journal, 64 << 20, 0, file, &unlimited);
}

api_bench *bench_new_limited(const char *file, const api_limits *addresses, uint64_t burst)
{
    const st_journal journal = st_journal_memory();
    const bench_limits limits = {*addresses, burst};
    return bench_new_with(&journal, 64 << 20, 0, file, &limits);
}

void bench_use_address(api_bench *b, uint64_t address, bool is_beyond)
{
    b->address = address;
    b->is_beyond = is_beyond;
}

void bench_keep(api_bench *b, const char *text)
{
    b->kept = text;
    b->service->options.backup = text == NULL ? NULL : back_up;
    b->service->options.backup_context = b;
}

void bench_change_tokens(api_bench *b, const char *file)
{
    b->file = file;
}

void bench_use_token(api_bench *b, const char *token)
{
    b->bearer[0] = '\0';
    if (token != NULL) {
        snprintf(b->bearer, sizeof b->bearer, "Bearer %s", token);
    }
}

void bench_free(api_bench *b)
{
    api_job_table_stop(b->jobs);
    bench_run_jobs(b, BENCH_JOBS);
    api_job_table_free(b->jobs);
    st_pool_free(b->pool);
    api_service_free(b->service);
    st_store_free(b->store);
    api_tokens_free(b->tokens);
    api_kept_free(b->page.body);
    free(b);
}

api_service *bench_service(api_bench *b)
{
    return b->service;
}

st_store *bench_store(api_bench *b)
{
    return b->store;
}

static void read_headers(const char *const *pairs, api_request *request)
{
    for (size_t i = 0; pairs != NULL && pairs[i] != NULL; i += 2) {
        api_request_header header = api_request_header_find(pairs[i], strlen(pairs[i]));
        if (header < API_REQUEST_HEADERS && request->headers[header] == NULL) {
            request->headers[header] = pairs[i + 1];
        }
    }
}

typedef struct signal {
    pthread_mutex_t lock;
    pthread_cond_t changed;
    bool set;
} signal;

static void set_signal(void *context)
{
    signal *s = context;
    pthread_mutex_lock(&s->lock);
    s->set = true;
    pthread_cond_signal(&s->changed);
    pthread_mutex_unlock(&s->lock);
}

static bool take_signal(signal *s, bool wait)
{
    pthread_mutex_lock(&s->lock);
    while (wait && !s->set) {
        pthread_cond_wait(&s->changed, &s->lock);
    }
    bool set = s->set;
    s->set = false;
    pthread_mutex_unlock(&s->lock);
    return set;
}

/* Runs the waiting jobs in order, on the test's thread. */
static void wait_for_jobs(api_bench *b)
{
    signal done = {PTHREAD_MUTEX_INITIALIZER, PTHREAD_COND_INITIALIZER, false};
    assert_true(st_pool_submit(b->pool, &(st_task){.work = set_signal, .context = &done}));
    (void)take_signal(&done, true);
}

/* Reads the part of an event stream that is available now, then runs the waiting jobs, and then
 * reads up to the closing message of the stream. */
static void read_live(api_bench *b, const api_source *live, bench_reply *r)
{
    signal woken = {PTHREAD_MUTEX_INITIALIZER, PTHREAD_COND_INITIALIZER, false};
    bool finished = false;
    size_t capacity = 0;
    int64_t got;
    live->start(live->self, set_signal, &woken);
    do {
        if (capacity < r->length + 4096) {
            capacity = 2 * r->length + 4096;
            r->body = realloc(r->body, capacity + 1);
            assert_non_null(r->body);
        }
        got = live->read(live->self, r->body + r->length, 4096);
        r->length += got > 0 ? (size_t)got : 0;
        if (got == API_READ_WAIT) {
            assert_false(finished);
            wait_for_jobs(b);
            finished = !take_signal(&woken, false);
            if (finished) {
                live->finish(live->self);
            }
        }
    } while (got > 0 || got == API_READ_WAIT);
    assert_int_equal(got, 0);
}

static void read_all(api_bench *b, const api_answer *answer, bench_reply *r)
{
    size_t capacity = 0;
    if (answer->live != NULL) {
        read_live(b, answer->live, r);
    } else if (answer->read == NULL) {
        r->length = answer->length < 0 ? 0 : (size_t)answer->length;
        r->body = malloc(r->length + 1);
        assert_non_null(r->body);
        if (r->length > 0) {
            memcpy(r->body, answer->bytes, r->length);
        }
    } else {
        int64_t got;
        do {
            capacity = 2 * capacity + 4096;
            r->body = realloc(r->body, capacity + 1);
            assert_non_null(r->body);
            while (r->length < capacity && (got = answer->read(answer->context, r->body + r->length,
                                                               capacity - r->length)) > 0) {
                r->length += (size_t)got;
            }
        } while (r->length == capacity);
        assert_int_equal(got, 0);
    }
    r->body[r->length] = '\0';
}

bool bench_try(api_bench *b, const bench_request *sent, bench_reply *out)
{
    const char *mark = strchr(sent->target, '?');
    size_t path_length = mark == NULL ? strlen(sent->target) : (size_t)(mark - sent->target);
    char *path = strndup(sent->target, path_length);
    assert_non_null(path);
    api_request request = {.method = sent->method,
                           .path = path,
                           .query = mark == NULL ? "" : mark + 1,
                           .request_id = "test",
                           .client = {{b->address, 0}},
                           .is_beyond = b->is_beyond,
                           .has_length = sent->body != NULL,
                           .length = sent->length,
                           .has_body = sent->body != NULL};
    read_headers(sent->headers, &request);
    const char **type = &request.headers[API_HEADER_CONTENT_TYPE];
    if (sent->body != NULL && *type == NULL) {
        *type = "application/json";
    } else if (*type != NULL && **type == '\0') {
        *type = NULL;
    }
    const char **authorization = &request.headers[API_HEADER_AUTHORIZATION];
    if (*authorization == NULL && b->bearer[0] != '\0') {
        *authorization = b->bearer;
    }
    bench_reply r = {.exchange = api_handle(b->service, &request, sent->body, sent->length)};
    free(path);
    if (r.exchange == NULL) {
        return false;
    }
    const api_answer *answer = api_answer_of(r.exchange);
    r.status = answer->status;
    r.route = answer->route;
    memcpy(r.headers, answer->headers, sizeof r.headers);
    for (size_t i = 0; i < answer->header_count; i++) {
        assert_true(api_header_is_listed(answer->headers[i].name));
    }
    r.header_count = answer->header_count;
    read_all(b, answer, &r);
    api_charge(r.exchange, r.length);
    *out = r;
    return true;
}

/* Writes a request and its answer to the recorded traffic, which the last step of `make test`
 * compares with the OpenAPI document. Tests with failing allocations record nothing, because their
 * answers may be incomplete. */
static void record(const bench_request *sent, const bench_reply *r)
{
    const char *const *headers = sent->headers;
    char *heads[2];
    size_t size;
    FILE *out = open_memstream(&heads[0], &size);
    assert_non_null(out);
    bool typed = false;
    for (size_t i = 0; headers != NULL && headers[i] != NULL; i += 2) {
        bool type = strcasecmp(headers[i], "content-type") == 0;
        typed |= type;
        if (!type || headers[i + 1][0] != '\0') {
            fprintf(out, "%s: %s\r\n", headers[i], headers[i + 1]);
        }
    }
    if (sent->body != NULL && !typed) {
        fputs("Content-Type: application/json\r\n", out);
    }
    fclose(out);
    out = open_memstream(&heads[1], &size);
    assert_non_null(out);
    for (size_t i = 0; i < r->header_count; i++) {
        fprintf(out, "%s: %s\r\n", r->headers[i].name, r->headers[i].value);
    }
    fclose(out);
    /* The server, not the api, leaves out the body of an answer to HEAD, so a recorded answer has
     * to drop it here. */
    bool head = strcmp(sent->method, "HEAD") == 0;
    const traffic_message asked = {heads[0], sent->body == NULL ? "" : sent->body, sent->length};
    const traffic_message said = {heads[1], head ? "" : r->body, head ? 0 : r->length};
    traffic_record(sent->method, sent->target, &asked, r->status, &said);
    free(heads[0]);
    free(heads[1]);
}

bench_reply bench_send_bytes(api_bench *b, const bench_request *request)
{
    bench_reply r;
    assert_true(bench_try(b, request, &r));
    record(request, &r);
    r.json = cJSON_ParseWithLength(r.body, r.length);
    return r;
}

bench_reply bench_send(api_bench *b, const char *method, const char *target,
                       const char *const *headers, const char *body)
{
    return bench_send_bytes(
        b, &(bench_request){method, target, headers, body, body == NULL ? 0 : strlen(body)});
}

const char *bench_header(const bench_reply *r, const char *name)
{
    for (size_t i = 0; i < r->header_count; i++) {
        if (strcasecmp(r->headers[i].name, name) == 0) {
            return r->headers[i].value;
        }
    }
    return "";
}

const char *bench_text(const bench_reply *r, const char *member)
{
    const cJSON *value = cJSON_GetObjectItem(r->json, member);
    assert_true(cJSON_IsString(value));
    return value->valuestring;
}

void bench_reply_free(bench_reply *r)
{
    free(r->body);
    cJSON_Delete(r->json);
    api_free(r->exchange);
    *r = (bench_reply){0};
}

bench_reply bench_get(api_bench *b, const char *target)
{
    return bench_send(b, "GET", target, NULL, NULL);
}

bench_reply bench_post(api_bench *b, const char *target, const char *body)
{
    return bench_send(b, "POST", target, NULL, body);
}

bench_reply bench_expect(int status, bench_reply r)
{
    if (r.status != status) {
        fail_msg("%d instead of %d: %.300s", r.status, status, r.body);
    }
    return r;
}

void bench_done(bench_reply r)
{
    bench_reply_free(&r);
}
