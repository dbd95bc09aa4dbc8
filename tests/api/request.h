/* request.h - requests to the api without a socket, against the store the daemon uses. */
#ifndef TESTS_API_REQUEST_H
#define TESTS_API_REQUEST_H

#include "api/describe/routes.h"
#include "api/request/api.h"
#include "store/store.h"

#include <cjson/cJSON.h>

typedef struct api_bench api_bench; /* a service over an empty store */

api_bench *bench_new(void);
/* Over another journal than that in memory. */
api_bench *bench_new_over(const st_journal *journal);
/* `upload` bytes are the most a body of a mesh may have; 0 for as many as bench_new allows. */
api_bench *bench_new_within(uint64_t undo_budget, uint64_t upload);
/* A service that asks for tokens, those of `file` (api/token/token_file.h). */
api_bench *bench_new_guarded(const char *file);
/* The same with limits for clients without a token, and of `burst` seconds; `file` NULL: no tokens
 * are asked for. */
api_bench *bench_new_limited(const char *file, const api_limits *addresses, uint64_t burst);
/* Requests come from this address from now on, 0 at first; `is_beyond`: by a connection that is one
 * more than that may have. */
void bench_use_address(api_bench *b, uint64_t address, bool is_beyond);
/* What POST /v1/admin/reload reads from now on. */
void bench_change_tokens(api_bench *b, const char *file);
/* POST /v1/admin/backup gives a file with this text from now on; NULL: nothing is kept. */
void bench_keep(api_bench *b, const char *text);
/* Requests carry this token from now on, where they have no Authorization; NULL: none. */
void bench_use_token(api_bench *b, const char *token);
void bench_free(api_bench *b);
api_service *bench_service(api_bench *b);
st_store *bench_store(api_bench *b);
/* Jobs wait until this runs them: without threads, in their order, up to `most`. */
void bench_run_jobs(api_bench *b, size_t most);
/* How many may wait; BENCH_JOBS at first. */
enum { BENCH_JOBS = 32 };
void bench_limit_jobs(api_bench *b, size_t most);

typedef struct bench_reply {
    int status;
    char *body; /* ends in NUL; streams are read to their end, and ended where they would wait */
    size_t length;
    cJSON *json;       /* NULL when the body is none */
    const char *route; /* template, "-" when none matched */
    api_header headers[API_ANSWER_HEADERS];
    size_t header_count;
    api_exchange *exchange; /* what the headers live in */
} bench_reply;

/* `target` is path and query. `headers` are pairs name, value that end in NULL, or NULL; a body
 * without a Content-Type among them is application/json; one that is "" is not sent. `body` NULL
 * sends none. */
bench_reply bench_send(api_bench *b, const char *method, const char *target,
                       const char *const *headers, const char *body);
bench_reply bench_send_bytes(api_bench *b, const char *method, const char *target,
                             const char *const *headers, const char *body, size_t length);
/* The same without parsing the answer; false when there was no memory for any. */
bool bench_try(api_bench *b, const char *method, const char *target, const char *const *headers,
               const char *body, size_t length, bench_reply *out);
const char *bench_header(const bench_reply *r, const char *name); /* "" when absent */
void bench_reply_free(bench_reply *r);

/* The usual cases. */
bench_reply bench_get(api_bench *b, const char *target);
bench_reply bench_post(api_bench *b, const char *target, const char *body);
/* The answer as it came; with another status the test fails and says what came instead. */
bench_reply bench_expect(int status, bench_reply r);
void bench_done(bench_reply r);

#endif
