/* api.h - requests in, answers out, no sockets.
 *
 * The server hands over a request in pieces and sends what comes back. An exchange is one request
 * with its answer, used by one thread at a time:
 *
 *       api_begin --- reads line and headers; may answer at once (404, 413, 415, 412 ...)
 *           |
 *       api_body *    for each piece of the body, none after API_READY
 *           |
 *       api_end  ---- API_READY: the answer is there
 *           |         API_WORK:  long; call api_work on a thread that may block, not on a worker
 *           |         API_JOB:   too long to wait for; call api_detach
 *       api_work, which gives API_READY or API_JOB
 *           |
 *       api_detach: the exchange is a job's from now on (jobs.h), the client is answered by another
 *           |
 *       api_answer -- status, headers, and a body as bytes, as a reader to pull from, or as a
 *           |         source that may have to be waited for (live.h)
 *           |
 *       api_free
 *
 * The server must not send the answer before what api_answer's `shown` says is durable.
 * api_handle does all of it at once on bytes in memory: tests live on that. */
#ifndef HE_API_REQUEST_API_H
#define HE_API_REQUEST_API_H

#include "api/header/request_header.h"
#include "api/job/job_table.h"
#include "api/live.h"
#include "api/metric/metrics.h"
#include "api/token/token_set.h"
#include "base/exec.h"
#include "system/thread_pool.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct api_exchange api_exchange;
typedef struct api_service api_service;

/* A request as it came: nothing is decoded. */
typedef struct api_request {
    const char *method;
    const char *path;       /* raw, percent-encoded, begins with '/' */
    const char *query;      /* raw, without '?', "" when absent */
    const char *request_id; /* echoed; the server made one where the client sent none */
    const char *headers[API_REQUEST_HEADERS]; /* values, NULL where absent */
    bool has_length;                          /* Content-Length was given */
    uint64_t length;
    bool has_body;       /* a body will follow, of known length or chunked */
    api_rate_key client; /* of the address it comes from: of clients that share one, the same */
    bool is_beyond;      /* its connection is one more than its address may have */
    bool has_consent;    /* its Origin is one that was configured: such pages may do anything */
} api_request;

typedef enum api_step { API_MORE, API_READY, API_WORK, API_JOB } api_step;

/* What api_work or a job is about to do, so that its host can choose when. */
typedef struct api_load {
    bool reads;       /* it changes nothing */
    double seconds;   /* about how long it takes; far too little for some */
    const char *mesh; /* id of the mesh it is about, "" where there is none */
} api_load;

enum { API_ANSWER_HEADERS = 16 };

typedef struct api_header {
    const char *name, *value;
} api_header;

typedef struct api_answer {
    int status;
    api_header headers[API_ANSWER_HEADERS];
    size_t header_count;
    /* Either bytes, or read: fill up to `size` bytes, 0 at the end, -1 on failure (the
     * connection is then cut, so that the client notices). Never blocks on a lock for long. */
    const char *bytes;
    int64_t length; /* -1: unknown, only with read */
    bool slow;      /* with read: it computes for milliseconds, not on a thread others wait for */
    int64_t (*read)(void *context, char *buffer, size_t size);
    void *context;
    /* Instead of both: an answer that goes on, and what to send now and then when it has nothing.
     * NULL: it is none. */
    const api_source *live;
    const char *idle;
    bool close;        /* the connection must not be used again */
    st_shown shown;    /* the answer waits until that is durable (durability_wait.h) */
    bool changed;      /* the request changed something */
    const char *route; /* template for logs and metrics, "-" when none matched */
} api_answer;

/* Limits a server sets; 0 takes the default of limits.h. */
typedef struct api_options {
    uint64_t max_upload; /* bytes of a mesh document or file */
    const char *version; /* "0.1.0" */
    const char *public_url;
    /* The page: content of a path ("/", "/assets/...") or false. Bytes live as long as the
     * service. `type` and `etag` are set; `immutable` for names that carry a hash. */
    bool (*asset)(void *context, const char *path, const char **bytes, size_t *length,
                  const char **type, const char **etag, bool *immutable);
    void *asset_context;
    bool (*ready)(void *context); /* for /readyz; NULL: always */
    void *ready_context;
    /* Bytes the process holds by its own count, and how many it may hold, 0 for as many as there
     * are; NULL: not told. */
    void (*memory)(uint64_t *used, uint64_t *budget);
    api_limits address_limits; /* of clients without a token, by their address */
    uint64_t limit_burst;      /* seconds that buckets of requests and bytes hold; 0: one */
    api_tokens *tokens;        /* NULL: nobody needs one, and everybody may do everything */
    /* Reads again what the server was told of by files, tokens among them. False with a sentence in
     * `message`, and what was in force stays. NULL: there is nothing to be read. */
    bool (*reload)(void *context, char *message, size_t size);
    void *reload_context;
    /* Writes all that is stored to a file of its own, which takes as long as the store is large.
     * ST_BUSY while the one before is kept, ST_FAILED with a sentence in `message`. NULL: nothing
     * is kept beyond memory. */
    st_status (*backup)(void *context, api_blob *out, char *message, size_t size);
    void *backup_context;
    api_job_table *jobs; /* NULL: nothing becomes a job, and no route shows any */
    bool plain_answers;  /* never coded, whatever a client accepts */
    const he_exec *exec; /* threads for parts of large work; NULL: none */
    st_pool *pool;       /* brings listeners forward from the history; NULL: they fetch anew */
    st_pool *makers;     /* makes pieces of answers, for the metrics; NULL: there is none */
    const char *commit;  /* that the server was built from, "" or NULL where that is not known */
} api_options;

/* The table of routes: api/describe/routes.h. */
typedef struct api_route_table {
    const struct api_route *rows;
    size_t count;
} api_route_table;

/* Borrowed: store, rows and options' pointers outlive the service. NULL when memory is out. */
api_service *api_service_new(st_store *store, api_route_table routes, const api_options *options);
void api_service_free(api_service *service);
/* Where the server counts requests and connections; lives as long as the service. */
api_metrics *api_metrics_of(const api_service *service);

/* NULL when memory is out. `request` is copied, but for the values of its headers: the caller keeps
 * them until api_free, or until api_detach, which copies them for the job. */
api_exchange *api_begin(api_service *service, const api_request *request, api_step *step);
/* `used` may be less than `length`, with API_MORE: enough was done for once. The rest is to be
 * given again, when others that wait for the thread have had their turn. */
api_step api_body(api_exchange *exchange, const char *bytes, size_t length, size_t *used);
api_step api_end(api_exchange *exchange);
api_step api_work(api_exchange *exchange);
/* The exchange to answer the client with, 202 or 503; `exchange` is not the caller's any more.
 * NULL when memory is out: then it still is. */
api_exchange *api_detach(api_exchange *exchange);
/* Before api_work: `tell` is called as watch.h says, by its thread. */
void api_watch(api_exchange *exchange, bool (*tell)(void *context, const char *phase, double done),
               void *context);
/* Before api_end: `tell` is called as watch.h says while api_end works on a read. What it gives up
 * begins anew: api_end returns API_WORK. */
void api_watch_worker(api_exchange *exchange,
                      bool (*tell)(void *context, const char *phase, double done), void *context);
/* Called by `tell` before it returns false: what the client is answered with in place of
 * HE_CANCELLED.
 */
void api_give_up(api_exchange *exchange, int code, const char *text);
/* May the request become a job, if its client prefers that? */
bool api_can_be_job(const api_exchange *exchange);
/* After API_WORK and API_JOB, before the work has begun. */
api_load api_load_of(const api_exchange *exchange);
const api_answer *api_answer_of(const api_exchange *exchange);
/* So many bytes of its body that api_body was not given, or of its answer, went over the wire: they
 * count for its client's limit. */
void api_charge(api_exchange *exchange, uint64_t bytes);
/* The file of tokens was read: tells the store what each of them may hold. False without memory,
 * and what held before holds. */
bool api_service_apply_quotas(api_service *service);
/* What limits of clients have refused (api/limit/limit.h). The server adds to it what it refuses
 * before there is an exchange. */
api_limited *api_service_limited(api_service *service);
void api_free(api_exchange *exchange);
/* Fills in the row and the problem of a request that ended; those of `exchange` NULL are no row and
 * the problem that is in `served`. */
void api_served_as(const api_service *service, const api_exchange *exchange, api_served *served);

/* All of it at once, the whole body given; NULL when memory is out. The caller frees. */
api_exchange *api_handle(api_service *service, const api_request *request, const char *body,
                         size_t length);

#endif
