/* request.h - the test bench, which calls the api without a socket. Its store is of the same kind
 * as that of the daemon. */
#ifndef TESTS_API_REQUEST_H
#define TESTS_API_REQUEST_H

#include "api/describe/routes.h"
#include "api/request/api.h"
#include "store/store.h"

#include <cjson/cJSON.h>

/* A service with an empty store, and the settings for the next requests to it. */
typedef struct api_bench api_bench;

api_bench *bench_new(void);
/* Makes a bench whose store writes to `journal`; the store of bench_new() has a journal in memory
 * only. */
api_bench *bench_new_over(const st_journal *journal);
/* Makes a bench with a memory budget `undo` for undo, and a limit `upload` on the bytes of an
 * uploaded mesh; `upload` 0 means the limit of bench_new(). */
api_bench *bench_new_within(uint64_t undo_budget, uint64_t upload);
/* Makes a bench whose service requires the tokens in the text `file` (api/token/token_file.h). */
api_bench *bench_new_guarded(const char *file);
/* Makes a bench with rate limits for clients without a token. Such a client may spend at once what
 * the limit allows in `burst` seconds. `file` is the text of a file of tokens; if it is NULL, no
 * token is required. */
api_bench *bench_new_limited(const char *file, const api_limits *addresses, uint64_t burst);
/* Sets the client address of all further requests; a new bench has the address 0. If `is_beyond` is
 * true, the service treats the connection as one more than the address may have. */
void bench_use_address(api_bench *b, uint64_t address, bool is_beyond);
/* Sets the file of tokens that the next POST /v1/admin/reload will read. */
void bench_change_tokens(api_bench *b, const char *file);
/* Makes POST /v1/admin/backup answer with a file that contains `text`. If `text` is NULL, POST
 * /v1/admin/backup fails because a store in memory has no backup. */
void bench_keep(api_bench *b, const char *text);
/* Sends `token` with all further requests that have no header Authorization; NULL: no token is
 * sent. */
void bench_use_token(api_bench *b, const char *token);
void bench_free(api_bench *b);
api_service *bench_service(api_bench *b);
st_store *bench_store(api_bench *b);
/* Runs the waiting jobs in order on the calling thread, at most `most` of them. The bench runs no
 * job at any other time. */
void bench_run_jobs(api_bench *b, size_t most);
/* Sets how many jobs may wait in the queue; a new bench lets BENCH_JOBS wait. */
enum { BENCH_JOBS = 32 };
void bench_limit_jobs(api_bench *b, size_t most);

typedef struct bench_reply {
    int status;
    char *body; /* the body, ended by NUL; if the answer is a stream: all that can be read without
                   waiting */
    size_t length;
    cJSON *json;       /* the body, parsed; NULL: the body is not JSON */
    const char *route; /* path template of the route that matched, "-" if none did */
    api_header headers[API_ANSWER_HEADERS];
    size_t header_count;
    /* the service's object for the request and its answer; it owns the memory of `headers` */
    api_exchange *exchange;
} bench_reply;

/* Sends a request. `target` is path and query. `headers` are pairs of name and value, ended by
 * NULL; `headers` may be NULL. A body without a Content-Type is sent as application/json; with a
 * Content-Type of "" the header is left out. If `body` is NULL, the request has no body. */
bench_reply bench_send(api_bench *b, const char *method, const char *target,
                       const char *const *headers, const char *body);
/* A request whose body may hold any bytes; the members are as in bench_send(). */
typedef struct bench_request {
    const char *method, *target;
    const char *const *headers;
    const char *body;
    size_t length; /* number of bytes in the body; 0 if there is no body */
} bench_request;
bench_reply bench_send_bytes(api_bench *b, const bench_request *request);
/* Sends a request without parsing the body of the answer as JSON. Returns false if the service
 * could not allocate the exchange. */
bool bench_try(api_bench *b, const bench_request *request, bench_reply *out);
/* Returns the value of a header of the answer; "" if the answer has no such header. */
const char *bench_header(const bench_reply *r, const char *name);
/* Returns a member of the answer's JSON; the member must be a string. */
const char *bench_text(const bench_reply *r, const char *member);
void bench_reply_free(bench_reply *r);

/* Shorthands for common requests. */
bench_reply bench_get(api_bench *b, const char *target);
bench_reply bench_post(api_bench *b, const char *target, const char *body);
/* Returns the answer `r`. If its status is not `status`, prints the answer and fails the test. */
bench_reply bench_expect(int status, bench_reply r);
void bench_done(bench_reply r);

#endif
