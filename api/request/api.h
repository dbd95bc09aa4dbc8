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
 *       api_work returns API_READY or API_JOB
 *           |
 *       api_detach: the exchange now belongs to a job (job_table.h); another one answers the client
 *           |
 *       api_answer -- status, headers, and a body as bytes, as a reader to pull from, or as a
 *           |         source that may have nothing to give at the moment (live.h)
 *           |
 *       api_free
 *
 * The server must not send the answer before the changes that it shows are durable (`shown` in
 * api_answer). api_handle does all steps in one call on bytes in memory, for tests. */
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
    const char *query;      /* the query as received, without '?'; "" if there is none */
    const char *request_id; /* the client's X-Request-Id, or one that the server has made */
    /* Values of the headers; NULL for a header that is absent. */
    const char *headers[API_REQUEST_HEADERS];
    bool has_length; /* Content-Length was given */
    uint64_t length;
    bool has_body;       /* true if a body follows; its length may be unknown */
    api_rate_key client; /* key of the client's address, shared by all clients at that address */
    /* True if the client's address has more connections than allowed: the request must be
     * refused. */
    bool is_beyond;
    /* True if the header Origin names a configured site, whose pages may make any request. */
    bool has_consent;
} api_request;

typedef enum api_step { API_MORE, API_READY, API_WORK, API_JOB } api_step;

/* What the work of api_work or of a job costs, so that the server can schedule it. */
typedef struct api_load {
    bool reads;       /* the work changes nothing */
    double seconds;   /* estimated duration in seconds; for some work the estimate is far too low */
    const char *mesh; /* id of the mesh that the work reads or writes; "" if there is none */
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
    /* True if a call of `read` may compute for milliseconds: do not call it on a worker thread. */
    bool slow;
    /* True if the body is numbers whose bits differ from one to the next: compressing takes longer
     * than computing them, and makes it a tenth shorter. */
    bool is_dense;
    int64_t (*read)(void *context, char *buffer, size_t size);
    void *context;
    /* The body if it has no known end, such as an event stream; then `bytes` and `read` are NULL.
     * NULL for other bodies. */
    const api_source *live;
    bool close; /* true if the server must close the connection after this answer */
    /* The changes that must be durable before the answer is sent (durability_wait.h). */
    st_shown shown;
    bool changed; /* true if the request has changed a mesh */
    /* Path template of the route, for logs and metrics; "-" when no route matched. */
    const char *route;
} api_answer;

/* A file that belongs to the web page. */
typedef struct api_asset {
    const char *type; /* media type of the file */
    /* True if the file's path contains a hash of its bytes, so that clients may cache it for
     * ever. */
    bool immutable;
    api_kept *body;
} api_asset;

/* Settings of the server; 0 selects the default in limits.h. */
typedef struct api_options {
    uint64_t max_upload; /* the most bytes of a mesh document or file */
    const char *version; /* version of the server, such as "0.1.0" */
    const char *public_url;
    /* Serves the web page: finds the file of a path ("/", "/assets/..."), which lives as long as
     * the service, or returns NULL. */
    const api_asset *(*asset)(void *context, const char *path);
    void *asset_context;
    /* The origins whose pages may show the viewer in a frame. */
    const char *const *frames;
    size_t frame_count;
    /* Returns true if /readyz shall answer that the server is ready; NULL: always. */
    bool (*ready)(void *context);
    /* Returns true if memory is short and no mesh can be evicted; /readyz then answers that the
     * server is not ready. NULL: never. */
    bool (*is_full)(void *context);
    void *ready_context; /* context of `ready` and `is_full` */
    /* Gets how many bytes the process has allocated, by its own count, and how many it may allocate
     * (0: no limit). NULL: not reported. */
    void (*memory)(uint64_t *used, uint64_t *budget);
    api_limits address_limits; /* limits of each address for requests without a token */
    /* How many seconds' worth of requests and bytes a client may use at once; 0 stands for one
     * second. */
    uint64_t limit_burst;
    /* The tokens that clients may use; NULL: no token is needed, every client may do everything. */
    api_tokens *tokens;
    /* Reads the server's files again, such as the token file. On failure returns false with a
     * sentence in `message`, and the server continues with the old contents. NULL: there are no
     * files. */
    bool (*reload)(void *context, char *message, size_t size);
    void *reload_context;
    /* Writes the whole store to a file; the time grows with the size of the store. NULL: the store
     * is in memory only.
     * Returns ST_BUSY while the file of the last backup exists, or ST_FAILED with a sentence in
     * `message`. */
    st_status (*backup)(void *context, api_blob *out, char *message, size_t size);
    void *backup_context;
    /* The table of jobs; NULL: no request becomes a job, and the routes of jobs do not exist. */
    api_job_table *jobs;
    bool plain_answers;          /* never compress answers */
    const he_parallel *parallel; /* threads for the parallel parts of large work; NULL: none */
    /* Threads that look up missed events in the history; NULL: listeners that missed events must
     * fetch the mesh again. */
    st_pool *pool;
    st_pool *makers; /* threads that compute pieces of answers; used for metrics only; NULL: none */
    /* Returns how many lines of the log were dropped; NULL: not reported. */
    uint64_t (*log_dropped)(const void *log);
    const void *log;
    const char *commit; /* git commit of the build; "" or NULL if unknown */
} api_options;

/* A table of routes. The server passes the table of api/describe/routes.h. */
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
/* Passes a piece of the body. If it returns API_MORE, `used` may be less than `length`, because the
 * call has worked long enough: the caller serves other connections, then passes the rest of the
 * piece. */
api_step api_body(api_exchange *exchange, const char *bytes, size_t length, size_t *used);
api_step api_end(api_exchange *exchange);
api_step api_work(api_exchange *exchange);
/* Turns the exchange into a job, which then owns it. Returns a new exchange whose answer, 202 or
 * 503, the server sends to the client. Returns NULL when memory is out; the caller then still owns
 * `exchange`. */
api_exchange *api_detach(api_exchange *exchange);
/* Sets a callback for progress; it must be called before api_work. The working thread calls `tell`
 * as progress.h says. */
void api_set_progress(api_exchange *exchange,
                      bool (*tell)(void *context, const char *phase, double done), void *context);
/* Sets a callback for progress; it must be called before api_end. While api_end handles a request
 * that only reads, `tell` is called as progress.h says. If `tell` stops such a request, api_end
 * returns API_WORK, and api_work starts it again from its beginning. */
void api_set_worker_progress(api_exchange *exchange,
                             bool (*tell)(void *context, const char *phase, double done),
                             void *context);
/* Sets the problem that the client gets if the callback `tell` stops the work, instead of
 * HE_CANCELLED. `tell` calls it before it returns false. */
void api_give_up(api_exchange *exchange, int code, const char *text);
/* Returns true if the request becomes a job when its client prefers that; false if its route does
 * not allow jobs. */
bool api_can_be_job(const api_exchange *exchange);
/* Returns the cost of the work of the exchange. The server calls it after api_end or api_work
 * returned API_WORK or API_JOB, before the work begins. */
api_load api_load_of(const api_exchange *exchange);
const api_answer *api_answer_of(const api_exchange *exchange);
/* Counts transferred bytes against the client's limit: those of the answer, and those of a body
 * that the server read without passing it to api_body. */
void api_charge(api_exchange *exchange, uint64_t bytes);
/* The values of the headers RateLimit-Policy and RateLimit of a request, both "" if the client has
 * no limit. The server sends them itself when it does not send the answer of the exchange. */
typedef struct api_rate_fields {
    char policy[API_RATE_FIELD], left[API_RATE_FIELD];
} api_rate_fields;
void api_rate_fields_of(const api_exchange *exchange, api_rate_fields *out);
/* Passes the quotas of all tokens to the store; called after the token file was read. Returns false
 * when memory is out; the old quotas then stay. */
bool api_service_apply_quotas(api_service *service);
/* Returns the counters of refusals by client limits (api/limit/limit.h), to which the server adds
 * the refusals that it makes before an exchange has begun. */
api_limited *api_service_limited(api_service *service);
/* Returns the table of the clients that show themselves to others, whose work the server does on a
 * thread of its own (api_presences_run). */
struct api_presences *api_service_presences(const api_service *service);
void api_free(api_exchange *exchange);
/* Sets the route and the problem code in `served`, for metrics, from an exchange that ended. If
 * `exchange` is NULL, sets API_NO_ROUTE and leaves the problem code as it is. */
void api_served_as(const api_service *service, const api_exchange *exchange, api_served *served);

/* Runs a whole exchange at once, with the whole body, for tests. Returns NULL when memory is out.
 * The caller frees the exchange. */
api_exchange *api_handle(api_service *service, const api_request *request, const char *body,
                         size_t length);

#endif
