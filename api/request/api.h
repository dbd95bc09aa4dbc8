/* api.h - from requests to answers, without sockets.
 *
 * The server passes a request in pieces and sends the answer. An exchange is one request with its
 * answer; one thread at a time uses it:
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
 *       api_detach: the exchange now belongs to a job (job_table.h); another one answers the client
 *           |
 *       api_answer -- status, headers, and a body as bytes, as a reader to pull from, or as a
 *           |         source that may have nothing to give at the moment (live.h)
 *           |
 *       api_free
 *
 * The server must not send the answer before the changes named in api_answer's `shown` are durable.
 * api_handle does all steps in one call on bytes in memory, for tests. */
#ifndef HE_API_REQUEST_API_H
#define HE_API_REQUEST_API_H

#include "api/header/kept.h"
#include "api/header/request_header.h"
#include "api/job/job_table.h"
#include "api/live.h"
#include "api/metric/metrics.h"
#include "api/token/token_set.h"
#include "base/parallel.h"
#include "system/thread_pool.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct api_exchange api_exchange;
typedef struct api_service api_service;

/* A request as it was received: nothing is decoded. */
typedef struct api_request {
    const char *method;
    const char *path;       /* raw, percent-encoded, begins with '/' */
    const char *query;      /* raw, without '?', "" when absent */
    const char *request_id; /* echoed; if the client sent none, the server made one */
    const char *headers[API_REQUEST_HEADERS]; /* values, NULL where absent */
    bool has_length;                          /* Content-Length was given */
    uint64_t length;
    bool has_body;       /* a body follows, of known length or chunked */
    api_rate_key client; /* key of the client's address; clients that share an address share it */
    bool is_beyond;      /* the address has more connections than it may: refuse */
    bool has_consent;    /* the Origin is one that was configured: its pages may do anything */
} api_request;

typedef enum api_step { API_MORE, API_READY, API_WORK, API_JOB } api_step;

/* What the work of api_work or of a job costs, so that the server can schedule it. */
typedef struct api_load {
    bool reads;       /* it changes nothing */
    double seconds;   /* estimated duration; far too low for some work */
    const char *mesh; /* id of its mesh, "" without one */
} api_load;

enum { API_ANSWER_HEADERS = 16 };

typedef struct api_header {
    const char *name, *value;
} api_header;

typedef struct api_answer {
    int status;
    api_header headers[API_ANSWER_HEADERS];
    size_t header_count;
    /* The body is either `bytes` or comes from `read`, which returns up to `size` bytes, 0 at the
     * end, or -1 on failure (the server then cuts the connection, so that the client notices). It
     * never blocks on a lock for long. */
    const char *bytes;
    int64_t length; /* -1: unknown, with `read` only */
    bool slow;      /* `read` computes for milliseconds: do not call it on a worker */
    int64_t (*read)(void *context, char *buffer, size_t size);
    void *context;
    /* Instead of both, an answer without a known end; NULL if not used. */
    const api_source *live;
    bool close;        /* close the connection after this answer */
    st_shown shown;    /* hold the answer back until this is durable (durability_wait.h) */
    bool changed;      /* the request changed a mesh */
    const char *route; /* path template for logs and metrics; "-" when no route matched */
} api_answer;

/* A file of the web page. */
typedef struct api_asset {
    const char *type; /* media type */
    bool immutable;   /* its path contains a hash of its content */
    api_kept *body;
} api_asset;

/* Settings of the server; 0 selects the default in limits.h. */
typedef struct api_options {
    uint64_t max_upload; /* bytes of a mesh document or file */
    const char *version; /* such as "0.1.0" */
    const char *public_url;
    /* Serves the web page: finds the file of a path ("/", "/assets/..."), which lives as long as
     * the service, or returns NULL. */
    const api_asset *(*asset)(void *context, const char *path);
    void *asset_context;
    bool (*ready)(void *context); /* for /readyz; NULL: always ready */
    /* Returns true if memory is short and no mesh can leave it, for /readyz; NULL: never short. */
    bool (*is_full)(void *context);
    void *ready_context; /* of both */
    /* Returns how many bytes the process holds by its own count, and the most it may hold (0: no
     * limit). NULL: not reported. */
    void (*memory)(uint64_t *used, uint64_t *budget);
    api_limits address_limits; /* limits per address of clients without a token */
    uint64_t limit_burst;      /* burst: seconds' worth of rate that a bucket holds; 0: one */
    api_tokens *tokens;        /* NULL: no token is needed, every client may do everything */
    /* Reads the server's files again, the file of tokens among them. On failure returns false with
     * a sentence in `message`, and the old contents stay in force. NULL: there are no files. */
    bool (*reload)(void *context, char *message, size_t size);
    void *reload_context;
    /* Writes the whole store to a file; the time grows with the size of the store. NULL: the store
     * is in memory only.
     * Returns ST_BUSY while the last backup exists, or ST_FAILED with a sentence in `message`. */
    st_status (*backup)(void *context, api_blob *out, char *message, size_t size);
    void *backup_context;
    api_job_table *jobs; /* NULL: nothing becomes a job, and the routes of jobs do not exist */
    bool plain_answers;  /* never compress answers */
    const he_parallel *parallel; /* threads for parallel parts of large work; NULL: none */
    st_pool *pool;   /* runs backfills from the history; NULL: listeners fetch the mesh again */
    st_pool *makers; /* threads that compute pieces of answers, named in metrics; NULL: none */
    /* Returns how many lines of the log were dropped; NULL: not reported. */
    uint64_t (*log_dropped)(const void *log);
    const void *log;
    const char *commit; /* git commit of the build; "" or NULL if unknown */
} api_options;

/* The table of routes: api/describe/routes.h. */
typedef struct api_route_table {
    const struct api_route *rows;
    size_t count;
} api_route_table;

/* Makes a service. It borrows its arguments: store, rows and pointers in the options must outlive
 * it. Returns NULL when memory is out. */
api_service *api_service_new(st_store *store, api_route_table routes, const api_options *options);
void api_service_free(api_service *service);
/* Returns the counters in which the server counts requests and connections; they live as long as
 * the service. */
api_metrics *api_metrics_of(const api_service *service);

/* Begins an exchange. Returns NULL when memory is out. `request` is copied, but not the values of
 * its headers: they must live until api_free, or until api_detach, which copies them for the
 * job. */
api_exchange *api_begin(api_service *service, const api_request *request, api_step *step);
/* Passes a piece of the body. With API_MORE, `used` may be less than `length`: the call has worked
 * long enough. The caller serves other connections, then passes the rest. */
api_step api_body(api_exchange *exchange, const char *bytes, size_t length, size_t *used);
api_step api_end(api_exchange *exchange);
api_step api_work(api_exchange *exchange);
/* Turns the exchange into a job. Returns a new exchange to answer the client with, 202 or 503, and
 * takes `exchange`. Returns NULL, and takes nothing, when memory is out. */
api_exchange *api_detach(api_exchange *exchange);
/* Sets a callback for progress, before api_work; the working thread calls `tell` as progress.h
 * says. */
void api_set_progress(api_exchange *exchange,
                      bool (*tell)(void *context, const char *phase, double done), void *context);
/* Sets a callback for progress, before api_end: `tell` is called as progress.h says while api_end
 * works on a read. If `tell` stops a read, the read is started again from its beginning: api_end
 * returns API_WORK. */
void api_set_worker_progress(api_exchange *exchange,
                             bool (*tell)(void *context, const char *phase, double done),
                             void *context);
/* Sets the problem that the client gets instead of HE_CANCELLED. The callback `tell` calls it
 * before it returns false. */
void api_give_up(api_exchange *exchange, int code, const char *text);
/* Returns true if the request may become a job if its client prefers that. */
bool api_can_be_job(const api_exchange *exchange);
/* Returns the cost of the work, after API_WORK or API_JOB and before the work begins. */
api_load api_load_of(const api_exchange *exchange);
const api_answer *api_answer_of(const api_exchange *exchange);
/* Counts bytes that were transferred, of a body that was not passed to api_body or of the answer,
 * against the limit of the client. */
void api_charge(api_exchange *exchange, uint64_t bytes);
/* The values of the headers RateLimit-Policy and RateLimit for a request, if the server itself
 * answers in place of the exchange. Both are "" if the client has no limit. */
typedef struct api_rate_fields {
    char policy[API_RATE_FIELD], left[API_RATE_FIELD];
} api_rate_fields;
void api_rate_fields_of(const api_exchange *exchange, api_rate_fields *out);
/* Sets the quotas of all tokens in the store, after the file of tokens was read. Returns false when
 * memory is out; the old quotas then stay. */
bool api_service_apply_quotas(api_service *service);
/* Returns the counters of refusals by client limits (api/limit/limit.h), to which the server adds
 * refusals that happen before there is an exchange. */
api_limited *api_service_limited(api_service *service);
void api_free(api_exchange *exchange);
/* Fills in the route and the problem of a request that ended. If `exchange` is NULL, there is no
 * route, and the problem is the one already in `served`. */
void api_served_as(const api_service *service, const api_exchange *exchange, api_served *served);

/* Runs a whole exchange at once, with the whole body, for tests. Returns NULL when memory is out.
 * The caller frees the exchange. */
api_exchange *api_handle(api_service *service, const api_request *request, const char *body,
                         size_t length);

#endif
