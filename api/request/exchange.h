/* exchange.h - one request as handlers see it. Internal to api/.
 *
 * By the time a row's `run` is called, service.c has found the route, decoded path and query,
 * checked Content-Type, Accept and the size of the body, parsed a control document, and
 * obtained the mesh as the row's `reads` says (or answered 404; mesh_access.h). A handler reads
 * those, and either answers or fills x->problem and returns: service.c then answers the problem.
 * Answering nothing is a bug and becomes 500. A problem that is filled wins over an answer, whose
 * headers are then dropped.
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
 * Everything in the arena, texts and state die with the exchange, after the answer was sent. */
#ifndef HE_API_REQUEST_EXCHANGE_H
#define HE_API_REQUEST_EXCHANGE_H

#include "api/event/event_backfill.h"
#include "api/header/cursor.h"
#include "api/header/etag.h"
#include "api/header/media.h"
#include "api/header/pack.h"
#include "api/header/prefer.h"
#include "api/header/unpack.h"
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
    api_route_table table;
    api_route_tree *routes; /* of it */
    api_options options;
    api_backfills backfills;
    api_tickets *tickets;
    api_rates *token_rates, *address_rates; /* NULL: none of them has a limit */
    api_limited limited;
    api_metrics *metrics;
    api_unpack_room unpacking; /* of the decoders of bodies that are arriving */
};

/* Where an exchange is, forwards only: on a worker, on a thread that may block, a job, answered. */
typedef enum api_phase { API_PHASE_BODY, API_PHASE_WORK, API_PHASE_JOB, API_PHASE_DONE } api_phase;

enum { API_LOCATION = 512 }; /* a path of this API, escaped */

struct api_exchange {
    api_service *service;
    st_store *store;
    api_arena arena;
    api_phase phase;

    /* --- the request --- */
    api_request request;
    const api_route *route;    /* NULL where none matched */
    bool head;                 /* HEAD: the server sends the headers only */
    const char *mesh_id;       /* of the path, well formed; NULL: none */
    he_kind kind;              /* of {domain}, or the row's */
    uint32_t id;               /* of {id} */
    const char *code;          /* of {code} */
    const char *attribute;     /* of {name} */
    const char *job_id;        /* of {job}, any text */
    api_token *token;          /* held; NULL: the route is open, or the server asks for none */
    bool rehearses_only;       /* it may do a dry run of the write, and no more: gate.h */
    bool has_bad_token;        /* the request brought a token that is not known */
    api_rates *rates;          /* where the bucket of its client is; NULL: it has no limit */
    api_rate_key rate_key;     /* that of the client */
    api_rate rate;             /* that it has */
    api_rate_state rate_state; /* as it was when the request was let in, or not */
    bool at_gate;              /* it got no further, and nothing that is stored was looked at */
    api_query query;
    const char *media_in;  /* which of route->consumes the body is, NULL without a body */
    const char *media_out; /* which of route->produces is wanted */
    api_prefer prefer;
    char allow[API_ALLOW]; /* methods of a path that does not take this one */
    const char *key;       /* Idempotency-Key, NULL without one or where the row takes none */
    he_siphash hash;       /* of a keyed request */
    st_keyed *keyed;       /* the request with its key; NULL: none, or it was settled */
    uint64_t noted;        /* position of the note that the answer waits for; 0: none */
    const char *own_job;   /* the job that this is the work of; NULL: none */
    api_coding coding_in;  /* of the body */
    api_codings codings;   /* the answer may have */

    /* --- its body --- */
    api_text body;
    uint64_t arrived;   /* bytes, as they were sent */
    uint64_t received;  /* unfolded */
    api_unpack *unpack; /* NULL: of a body that is plain, or has ended */
    api_document document;
    bool has_root;
    api_in root;   /* of a control document */
    api_items ops; /* of an edit list, in `body` */

    /* --- the mesh --- */
    st_mesh *mesh;     /* a reference, NULL where the template has none or it is absent */
    bool is_cold;      /* it is not in memory, and is found when the body is whole */
    st_mesh_info info; /* filled by read_begin, write_begin and write_commit */
    bool has_info;
    bool shows_all; /* the answer may show more of the store than `info`: see api_answer's shown */
    uint64_t since; /* all records up to here were durable when the exchange began */
    st_write write; /* of the mesh; a claim outlives the handler that began it */
    api_reading reading;    /* what the row says, of a handler's way to it */
    const he_mesh *content; /* at hand while a handler runs that reads; NULL: none is */
    st_snapshot *snapshot;  /* which `content` is of; NULL: it is under the shared lock */
    bool keeps;             /* `snapshot` until the exchange is freed */

    /* --- the handler's own, freed by `free_state` with the exchange --- */
    void *state;
    void (*free_state)(void *state);
    void (*deferred)(api_exchange *x);
    bool is_job;          /* `deferred` is to be one */
    double seconds;       /* that it may take; 0: not estimated */
    he_watch watch;       /* of the work: threads for it, and who is told */
    api_problem given_up; /* why the watch ended it; code HE_OK: no reason was given */

    /* --- the answer --- */
    int published; /* see api_publish; 0: nothing was */
    char location[API_LOCATION];
    char retry[API_RETRY], rate_policy[API_RATE_FIELD], rate_field[API_RATE_FIELD];
    api_problem problem;
    api_text text;
    api_out out; /* writes x->text */
    bool answered;
    api_answer answer;
    void *stream;
    void (*free_stream)(void *stream);
    api_source live;
    api_pack *pack; /* codes the answer, or holds all of it; NULL: neither */
    char *coded;    /* all of it */
    api_blob blob;  /* which is sent, freed with the exchange unless it is lent */
    uint64_t blob_at;
};

/* --- query parameters: checked against the row already, so these cannot fail --- */
const char *api_param_text(const api_exchange *x, const char *name); /* NULL when absent */
bool api_param_flag(const api_exchange *x, const char *name);        /* false when absent */
uint64_t api_param_u64(const api_exchange *x, const char *name, uint64_t fallback);
double api_param_number(const api_exchange *x, const char *name, double fallback);
int api_param_choice(const api_exchange *x, const char *name); /* index, -1 when absent */
/* A bit for each choice that is named. */
unsigned api_param_choices(const api_exchange *x, const char *name);
bool api_param_has_choice(const api_exchange *x, const char *name, const char *choice);

/* What the request's changes are made for. */
st_cause api_cause(const api_exchange *x);

/* --- writes --- */
/* Begins x->write, with x->info filled and preconditions checked (If-Match, If-None-Match).
 * `expected` is a cursor at the body's expected_revision or NULL. On false the problem is filled
 * and no lock is held. Ended by api_write_commit or st_write_abort. */
bool api_write_begin(api_exchange *x, const api_in *expected);
/* Begins a claim as x->write, for a long edit that works without the lock (store/write.h). It is
 * ended with the exchange if not before. */
bool api_write_claim(api_exchange *x, const api_in *expected);
/* Commits x->write and publishes (api_publish) 204. False, with the problem filled and nothing
 * done, where the journal has no place for it or a claimed mesh was removed meanwhile. */
bool api_write_commit(api_exchange *x, const char *ops);
/* Do If-Match, If-None-Match and the expected revision (NULL: none) hold for x->info? */
bool api_preconditions_hold(api_exchange *x, const uint64_t *expected);
/* If-None-Match: * or If-Match while the mesh of a PUT is absent. */
bool api_precondition_absent(api_exchange *x);

/* --- work --- */
/* Run `handler` instead of the present one, on a thread that may block. Call and return, before
 * taking a lock. In api_work it is called at once. */
void api_defer(api_exchange *x, void (*handler)(api_exchange *x));
/* The same for work that may take so long that it becomes a job: where the client prefers that, or
 * `seconds` are more than it will wait. Otherwise deferred if `costly`, or called at once. The
 * route has API_LONG. Reads leave that to mesh_access.h. */
void api_run_long(api_exchange *x, void (*handler)(api_exchange *x), bool costly, double seconds);
/* Seconds of work that the client waits for; what takes longer is a job. Negative where all is to
 * be one, HUGE_VAL where nothing can be. */
double api_patience(const api_exchange *x);
/* Is work that may take these seconds to be a job? */
bool api_wants_job(const api_exchange *x, double seconds);
/* Should work on this many elements (or bytes) leave the worker? False in api_work. */
bool api_is_costly(const api_exchange *x, uint64_t amount, uint64_t threshold);
/* Vertices, half-edges and faces that were issued: what work on the whole mesh goes by. */
uint64_t api_elements_of(const he_mesh *mesh);
/* The same of work that costs the mesh. */
bool api_is_large(const api_exchange *x, const he_mesh *mesh);

/* --- answers: one of these, once --- */
/* The write took effect, so that a refusal would be a lie: a problem that comes up from here on (no
 * memory for the answer, a mesh that somebody else has deleted) leaves `status`, 201 or 204,
 * without a body. With 201, x->info is the new mesh's and gives Location. */
void api_publish(api_exchange *x, int status);
/* What x->out wrote, as application/json, or another type. */
void api_answer_json(api_exchange *x, int status);
void api_answer_text(api_exchange *x, int status, const char *type);
/* Bytes that live as long as the service or the exchange. */
void api_answer_bytes(api_exchange *x, int status, const char *type, const char *bytes,
                      size_t length);
void api_answer_empty(api_exchange *x, int status); /* 204 and the like */
/* The answer to a write that the client does not want spelt out: 204 where it prefers
 * return=minimal, else false and nothing. */
bool api_answer_minimal(api_exchange *x);
/* Takes `stream`, freed with the exchange. `length` -1: not known. */
void api_answer_stream(api_exchange *x, int status, const char *type, int64_t length,
                       int64_t (*read)(void *stream, char *buffer, size_t size), void *stream,
                       void (*free_stream)(void *stream));
/* What lies elsewhere: takes `blob`, where that can be freed. A job keeps it as it is. */
void api_answer_blob(api_exchange *x, int status, const char *type, const api_blob *blob);
/* An answer that goes on, for as long as the token is good: takes `source`, freed with the
 * exchange. `idle` is a literal. */
void api_answer_live(api_exchange *x, int status, const char *type, const api_source *source,
                     const char *idle);
/* A header of the answer, in place of one of this name; `value` is copied. Before or after the
 * answer. */
void api_answer_header(api_exchange *x, const char *name, const char *value);
void api_answer_header_format(api_exchange *x, const char *name, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
/* The ETag of x->info in this representation. */
void api_answer_etag(api_exchange *x, const char *representation);
/* Puts the ETag; true when If-None-Match names it, and then 304 was answered. Never in a job: its
 * result is what was asked for. */
bool api_not_modified(api_exchange *x, const char *representation);
/* The same with a tag that is no mesh's. */
bool api_not_modified_since(api_exchange *x, const char *etag);

/* --- refusals: fill x->problem; always false --- */
bool api_fail(api_exchange *x, int code, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
bool api_fail_core(api_exchange *x, const he_error *err); /* about the body */
bool api_fail_path(api_exchange *x, const he_error *err); /* about the path */
bool api_fail_store(api_exchange *x, st_status status);
bool api_fail_memory(api_exchange *x);
/* Accept allows none of what the route answers with. */
bool api_fail_accept(api_exchange *x);

#endif
