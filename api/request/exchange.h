/* exchange.h - one request as handlers see it. Internal to api/.
 *
 * By the time a row's `run` is called, service.c has found the route, decoded path and query,
 * checked Content-Type, Accept and the size of the body, parsed a control document, and obtained
 * the mesh as the row's `reads` says (or answered 404; mesh_access.h). A handler reads those and
 * either answers, or fills x->problem, which service.c then sends. A handler that does neither is a
 * bug and becomes 500. If it does both, the problem is sent and the answer with its headers is
 * dropped.
 *
 *     void api_vertex_get(api_exchange *x)
 *     {
 *         he_error err = {0};
 *         if (he_mesh_require(x->content, HE_VERTEX, x->id, &err) != HE_OK) {
 *             api_fail_path(x, &err);
 *         } else if (!api_not_modified(x, "element")) {
 *             api_write_vertex(&x->out, x->content, (he_vertex){x->id});
 *             api_answer_json(x, 200);
 *         }
 *     }
 *
 * Everything in the arena, the texts and the state are freed with the exchange, after the answer
 * was sent. */
#ifndef HE_API_REQUEST_EXCHANGE_H
#define HE_API_REQUEST_EXCHANGE_H

#include "api/event/event_backfill.h"
#include "api/header/compressor.h"
#include "api/header/cursor.h"
#include "api/header/decompressor.h"
#include "api/header/etag.h"
#include "api/header/media.h"
#include "api/header/prefer.h"
#include "api/json/json_in.h"
#include "api/json/json_out.h"
#include "api/limits.h"
#include "api/request/api.h"
#include "api/request/route.h"
#include "api/token/tickets.h"
#include "base/siphash.h"
#include "store/write.h"

struct api_service {
    st_store *store;
    /* Documents about the API, which depend on nothing but the options. NULL: not written yet. */
    _Atomic(api_kept *) operations, openapi;
    api_route_table table;
    api_route_tree *routes; /* of `table` */
    api_options options;
    api_backfills backfills;
    api_tickets *tickets;
    api_rates *token_rates, *address_rates; /* buckets; NULL: no client has a limit */
    api_limited limited;
    api_metrics *metrics;
    api_decompressor_room decompressing; /* memory of the decoders of request bodies */
};

/* How far an exchange is. It only moves forward: on a worker, on a thread that may block, in a job,
 * answered. */
typedef enum api_phase { API_PHASE_BODY, API_PHASE_WORK, API_PHASE_JOB, API_PHASE_DONE } api_phase;

enum { API_LOCATION = 512 }; /* a path of this API, escaped */

struct api_exchange {
    api_service *service;
    st_store *store;
    api_arena arena;
    api_phase phase;

    /* --- the request --- */
    api_request request;
    const api_route *route; /* NULL: no route matched */
    bool head;              /* HEAD: the server sends the headers only */
    const char *mesh_id;    /* in the path, well formed; NULL: none */
    he_kind kind;           /* {domain} of the path, or the row's */
    uint32_t id;            /* {id} of the path */
    const char *code;       /* {code} of the path */
    const char *attribute;  /* {name} of the path */
    const char *job_id;     /* {job} of the path, any text */
    api_token *token;       /* a reference; NULL: the route is open, or the server asks for none */
    bool rehearses_only;    /* the token may only do a dry run of this write: gate.h */
    bool has_bad_token;     /* the request has an unknown token */
    api_rates *rates;       /* where the client's bucket is; NULL: it has no limit */
    api_rate_key rate_key;  /* key of the client's bucket */
    api_rate rate;          /* the client's rate */
    api_rate_state rate_state; /* the bucket after the request was let in or refused */
    bool at_gate;              /* refused at the gate, before anything stored was read */
    api_query query;
    const char *media_in;  /* the type of the body, out of route->consumes; NULL without a body */
    const char *media_out; /* the type of the answer, out of route->produces */
    api_prefer prefer;
    char allow[API_ALLOW]; /* after 405: the methods of the path */
    const char *key;       /* Idempotency-Key; NULL: none, or the row takes none */
    he_siphash hash;       /* hash of a request with a key */
    st_keyed *keyed;       /* the entry of the key; NULL: none, or it was settled */
    uint64_t noted;        /* position of the record that the answer waits for; 0: none */
    const char *own_job;   /* id of the job that does this work; NULL: none */
    api_coding coding_in;  /* content coding of the body */
    api_codings codings;   /* content codings that the answer may have */

    /* --- the request's body --- */
    api_text body;
    uint64_t arrived;               /* bytes received, compressed */
    uint64_t received;              /* bytes after decompression */
    api_decompressor *decompressor; /* decoder; NULL: the body is uncompressed, or has ended */
    api_document document;
    bool has_root;
    api_in root;   /* root of a control document */
    api_items ops; /* operations of an edit list, which lies in `body` */

    /* --- the mesh --- */
    st_mesh *mesh;     /* a reference; NULL: the route has none, or the mesh is absent */
    bool is_cold;      /* the mesh is not in memory; it is looked for after the body arrived */
    st_mesh_info info; /* filled by read_begin, write_begin and write_commit */
    bool has_info;
    /* Whether the answer may show more of the store than `info`: see `shown` of api_answer. */
    bool shows_all;
    uint64_t since;      /* all records up to this position were durable when the exchange began */
    st_write write;      /* of the mesh; a claim outlives the handler that began it */
    api_reading reading; /* what the row says the handler reads */
    const he_mesh *content; /* the mesh while a handler that reads runs; NULL: none */
    st_snapshot *snapshot;  /* owner of `content`; NULL: it is under the shared lock */
    bool keeps;             /* keep `snapshot` until the exchange is freed */

    /* --- state of the handler, freed by `free_state` with the exchange --- */
    void *state;
    void (*free_state)(void *state);
    void (*deferred)(api_exchange *x);
    bool is_job;          /* `deferred` shall run as a job */
    double seconds;       /* estimated duration; 0: not estimated */
    he_progress progress; /* threads and callback for the work */
    api_problem given_up; /* why the work was stopped; code HE_OK: no reason given */

    /* --- the answer --- */
    int published; /* see api_publish; 0: nothing was published */
    char location[API_LOCATION];
    char retry[API_RETRY];
    api_rate_fields rate_fields;
    api_problem problem;
    api_text text;
    api_out out; /* writes x->text */
    bool answered;
    api_answer answer;
    void *stream;
    void (*free_stream)(void *stream);
    api_source live;
    api_compressor *compressor; /* compresses the answer, or owns all of it; NULL: neither */
    char *coded;                /* the whole compressed answer */
    api_kept *kept;             /* the answer's body, if it never changes; NULL: it is another */
    api_blob blob;              /* the answer; freed with the exchange unless it is borrowed */
    uint64_t blob_at;
};

/* --- query parameters: already checked against the row, so these functions cannot fail --- */
const char *api_param_text(const api_exchange *x, const char *name); /* NULL when absent */
bool api_param_flag(const api_exchange *x, const char *name);        /* false when absent */
uint64_t api_param_u64(const api_exchange *x, const char *name, uint64_t fallback);
double api_param_number(const api_exchange *x, const char *name, double fallback);
/* Returns the index of the choice, -1 if the parameter is absent. */
int api_param_choice(const api_exchange *x, const char *name);
/* Returns a bit set of the choices that are named. */
unsigned api_param_choices(const api_exchange *x, const char *name);
bool api_param_has_choice(const api_exchange *x, const char *name, const char *choice);

/* Returns the cause to store with the request's changes. */
st_cause api_cause(const api_exchange *x);

/* --- writes --- */
/* Begins x->write, fills x->info and checks preconditions (If-Match, If-None-Match). `expected` is
 * a cursor at the body's expected_revision, or NULL. api_write_commit or st_write_abort ends the
 * write. Returns false, without a lock, with the problem filled. */
bool api_write_begin(api_exchange *x, const api_in *expected);
/* Begins x->write as a claim, for a long edit that works without the lock (store/write.h). The
 * exchange ends it if the handler did not. */
bool api_write_claim(api_exchange *x, const api_in *expected);
/* Commits x->write. From then on the client gets at least 204, even if the answer fails
 * (api_publish). Returns false with the problem filled and nothing changed if the journal has no
 * space, or if a claimed mesh was deleted meanwhile. */
bool api_write_commit(api_exchange *x, const char *ops);
/* Returns true if If-Match, If-None-Match and the expected revision (NULL: none) hold for x->info;
 * otherwise fills the problem. */
bool api_preconditions_hold(api_exchange *x, const uint64_t *expected);
/* Returns true if the preconditions hold for a PUT to a mesh that does not exist: If-None-Match: *
 * does, If-Match does not. */
bool api_precondition_absent(api_exchange *x);

/* --- work --- */
/* Makes `handler` run instead of the present handler, on a thread that may block. The present one
 * must call it before it takes a lock, and then return. In api_work `handler` runs at once. */
void api_defer(api_exchange *x, void (*handler)(api_exchange *x));
/* Runs `handler`, whose work may be long. It becomes a job if the client prefers that, or if
 * `seconds` exceeds the client's patience; otherwise it is deferred to a thread that may block if
 * `costly` is set, or called at once. The route must have API_LONG. Handlers that read leave this
 * to mesh_access.h. */
void api_run_long(api_exchange *x, void (*handler)(api_exchange *x), bool costly, double seconds);
/* Returns the seconds that the client will wait; longer work becomes a job. Negative: all work
 * becomes a job. HUGE_VAL: no work can. */
double api_patience(const api_exchange *x);
/* Returns true if work that takes this many seconds must become a job. */
bool api_wants_job(const api_exchange *x, double seconds);
/* Returns true if work on this many elements (or bytes) should leave the worker. Returns false in
 * api_work. */
bool api_is_costly(const api_exchange *x, uint64_t amount, uint64_t threshold);
/* Returns the number of ids of vertices, half-edges and faces, dead ones included: the cost of work
 * on the whole mesh. */
uint64_t api_elements_of(const he_mesh *mesh);
/* Returns true if work on the whole mesh should leave the worker. Returns false in api_work. */
bool api_is_large(const api_exchange *x, const he_mesh *mesh);

/* --- answers: call one of these, once --- */
/* Declares that the write took effect, so that a refusal would be wrong. If a problem comes up
 * later (no memory for the answer, the mesh deleted meanwhile), the client gets `status`, 201 or
 * 204, without a body. With 201, x->info is the new mesh's, and Location is made from it. */
void api_publish(api_exchange *x, int status);
/* Answers with the text that x->out wrote, as application/json or as another type. */
void api_answer_json(api_exchange *x, int status);
void api_answer_text(api_exchange *x, int status, const char *type);
/* Answers with bytes that must stay valid as long as the service or the exchange. */
void api_answer_bytes(api_exchange *x, int status, const char *type, const char *bytes,
                      size_t length);
/* Answers 200 with a body that never changes and outlives the exchange, or 304 if the client has it
 * (If-None-Match). */
void api_answer_kept(api_exchange *x, const char *type, api_kept *kept);
void api_answer_empty(api_exchange *x, int status); /* without a body: 204 and others */
/* If the client prefers return=minimal, answers 204 and returns true. */
bool api_answer_minimal(api_exchange *x);
/* A body that is made while it is sent. */
typedef struct api_stream {
    int64_t length;                                         /* -1: unknown */
    int64_t (*read)(void *self, char *buffer, size_t size); /* as in api_answer */
    void *self;
    void (*free)(void *self); /* NULL: the stream is borrowed */
} api_stream;

/* Answers with a stream, which it takes and frees with the exchange. */
void api_answer_stream(api_exchange *x, int status, const char *type, const api_stream *stream);
/* Answers with a blob, which it takes if the blob has a function `free`. A job keeps the blob
 * without copying it. */
void api_answer_blob(api_exchange *x, int status, const char *type, const api_blob *blob);
/* Answers with a stream without a known end, which is sent while the token is valid. Takes `source`
 * and frees it with the exchange. */
void api_answer_live(api_exchange *x, int status, const char *type, const api_source *source);
/* Sets a header of the answer, replacing one with this name; `value` is copied. Call it before or
 * after the answer. */
void api_answer_header(api_exchange *x, const char *name, const char *value);
void api_answer_header_format(api_exchange *x, const char *name, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
/* Sets the ETag of x->info for this representation. */
void api_answer_etag(api_exchange *x, const char *representation);
/* Sets the ETag. If If-None-Match names it, answers 304 and returns true. A job never does that:
 * its client asked for the result. */
bool api_not_modified(api_exchange *x, const char *representation);
/* Does what api_not_modified does for a tag that is not a mesh's. */
bool api_not_modified_since(api_exchange *x, const char *etag);

/* --- refusals: they fill x->problem and always return false --- */
bool api_fail(api_exchange *x, int code, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
bool api_fail_core(api_exchange *x, const he_error *err); /* an error about the body */
bool api_fail_path(api_exchange *x, const he_error *err); /* an error about the path */
bool api_fail_store(api_exchange *x, st_status status);
bool api_fail_memory(api_exchange *x);
/* Refuses because Accept allows none of the route's types. */
bool api_fail_accept(api_exchange *x);

#endif
