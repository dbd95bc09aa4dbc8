/* request.h - the test bench: requests to the api without a socket, on the same kind of store as
 * the daemon's. */
#ifndef TESTS_API_REQUEST_H
#define TESTS_API_REQUEST_H

#include "api/describe/routes.h"
#include "api/request/api.h"
#include "store/store.h"

#include <cjson/cJSON.h>

typedef struct api_bench api_bench; /* a service over an empty store */

api_bench *bench_new(void);
/* Makes a bench whose store uses this journal; the store of bench_new() uses a journal in
 * memory. */
api_bench *bench_new_over(const st_journal *journal);
/* Makes a bench with this limit for the memory of undo, and with this limit for an uploaded mesh;
 * `upload` 0: the limit of bench_new(). */
api_bench *bench_new_within(uint64_t undo_budget, uint64_t upload);
/* Makes a service that requires the tokens in `file` (api/token/token_file.h). */
api_bench *bench_new_guarded(const char *file);
/* Makes a service with limits for clients without a token, each of which may use the requests of
 * `burst` seconds at once; `file` NULL: no tokens are required. */
api_bench *bench_new_limited(const char *file, const api_limits *addresses, uint64_t burst);
/* Sets the client address of further requests; a new bench has address 0. `is_beyond`: the address
 * has one connection more than it may have. */
void bench_use_address(api_bench *b, uint64_t address, bool is_beyond);
/* Sets the file of tokens that the next POST /v1/admin/reload will read. */
void bench_change_tokens(api_bench *b, const char *file);
/* Makes POST /v1/admin/backup answer with a file of this text. NULL: the store is in memory only,
 * of which there is no backup. */
void bench_keep(api_bench *b, const char *text);
/* Makes further requests without a header Authorization send this token; NULL: no token. */
void bench_use_token(api_bench *b, const char *token);
void bench_free(api_bench *b);
api_service *bench_service(api_bench *b);
st_store *bench_store(api_bench *b);
/* Runs up to `most` waiting jobs, in order, on this thread; jobs run only here. */
void bench_run_jobs(api_bench *b, size_t most);
/* Sets how many jobs may wait; it is BENCH_JOBS in a new bench. */
enum { BENCH_JOBS = 32 };
void bench_limit_jobs(api_bench *b, size_t most);

typedef struct bench_reply {
    int status;
    char *body; /* ends in NUL; streams are read to their end, or until they would wait */
    size_t length;
    cJSON *json;       /* NULL: the body is not JSON */
    const char *route; /* template, "-" if no route matched */
    api_header headers[API_ANSWER_HEADERS];
    size_t header_count;
    api_exchange *exchange; /* owner of the headers */
} bench_reply;

/* Sends a request. `target` is path and query. `headers` are pairs of name and value, ended by
 * NULL; `headers` may be NULL. A body without a Content-Type is sent as application/json; with a
 * Content-Type of "" the header is left out. `body` NULL: the request has no body. */
bench_reply bench_send(api_bench *b, const char *method, const char *target,
                       const char *const *headers, const char *body);
/* A request whose body may hold any bytes; the members are as in bench_send(). */
typedef struct bench_request {
    const char *method, *target;
    const char *const *headers;
    const char *body;
    size_t length; /* bytes of the body; 0 if there is none */
} bench_request;
bench_reply bench_send_bytes(api_bench *b, const bench_request *request);
/* Sends a request and does not parse the answer; returns false if the service could not allocate
 * the exchange. */
bool bench_try(api_bench *b, const bench_request *request, bench_reply *out);
const char *bench_header(const bench_reply *r, const char *name); /* returns "" when absent */
/* Returns a member of the answer, which must be a string. */
const char *bench_text(const bench_reply *r, const char *member);
void bench_reply_free(bench_reply *r);

/* Shorthands for common requests. */
bench_reply bench_get(api_bench *b, const char *target);
bench_reply bench_post(api_bench *b, const char *target, const char *body);
/* Returns the answer `r`. If its status is not `status`, prints the answer and fails the test. */
bench_reply bench_expect(int status, bench_reply r);
void bench_done(bench_reply r);

#endif
