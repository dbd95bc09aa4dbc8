/* exchange.h - one request as handlers see it. Internal to api/.
 *
 * By the time a row's `run` is called, service.c has found the route, decoded path and query,
 * checked Content-Type, Accept and the size of the body, parsed a control document, and obtained
 * the mesh as the row's `reads` says (or answered 404; mesh_access.h). A handler reads the results
 * of these steps and either answers, or fills x->problem, which service.c then sends. A handler
 * that does neither is a bug and becomes 500. If it does both, the problem is sent and the answer
 * with its headers is dropped.
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
 * The arena, the texts and the handler's state are freed with the exchange, after the answer was
 * sent. */
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
#include "api/presence/presences.h"
#include "api/request/api.h"
#include "api/request/route.h"
#include "api/token/tickets.h"
#include "base/siphash.h"
#include "store/write.h"
#include "system/spare.h"

struct api_service {
    st_store *store;
    /* The documents GET /v1/operations, GET /v1/problems and GET /v1/openapi.json. They depend on
     * the options only and are made when first requested; NULL: not yet. */
    _Atomic(api_kept *) operations, problems, openapi;
    api_route_table table;
    api_route_tree *routes; /* `table` as a tree of path segments */
    api_options options;
    api_backfills backfills;
    api_presences *presences;
    api_tickets *tickets;
    /* The token buckets that limit the requests of each access token and of each address; NULL: no
     * client is limited. */
    api_rates *token_rates, *address_rates;
    api_limited limited;
    api_metrics *metrics;
    api_decompressor_room decompressing; /* counts the memory of all decoders of request bodies */
    /* Freed blocks: of exchanges, and of what api/write/edits.c needs for an edit. */
    st_spares exchanges, edits;
};

/* The phases of an exchange: it receives the body on a worker thread, works on a thread that may
 * block, works in a job, or is answered. An exchange never returns to an earlier phase. */
typedef enum api_phase { API_PHASE_BODY, API_PHASE_WORK, API_PHASE_JOB, API_PHASE_DONE } api_phase;

enum { API_LOCATION = 512 }; /* the most bytes that a percent-encoded path of this API has */

struct api_exchange {
    api_service *service;
    st_store *store;
    api_arena arena;
    api_phase phase;

    /* --- the request --- */
    api_request request;
    const api_route *route; /* the row of the table of routes; NULL: no route matched */
    bool head;              /* true if the method is HEAD: the server sends no body */
    const char *mesh_id;    /* id of the mesh in the path, well formed; NULL: none */
    he_kind kind; /* kind of element that {domain} in the path names, or that the route is about */
    uint32_t id;  /* {id} in the path */
    uint64_t revision;     /* {revision} in the path */
    const char *code;      /* {code} in the path */
    const char *attribute; /* {name} in the path */
    const char *job_id;    /* the text in the path in the place of {job}; it was not checked */
    /* The client's token; the exchange counts as one reference to it. NULL: the route is open, or
     * the server has no tokens. */
    api_token *token;
    bool rehearses_only;   /* true if the token allows only a dry run of this write (gate.h) */
    bool has_bad_token;    /* true if the request has an unknown token */
    api_rates *rates;      /* the table with the client's bucket; NULL: the client has no limit */
    api_rate_key rate_key; /* key of the client's bucket */
    api_rate rate;         /* the client's rate */
    api_rate_state rate_state; /* what the bucket held after the request was admitted or refused */
    /* True if the request was refused before anything in the store was read. */
    bool at_gate;
    api_query query;
    const char *media_in;  /* media type of the body, one of route->consumes; NULL without a body */
    const char *media_out; /* media type of the answer, one of route->produces */
    api_prefer prefer;
    char allow[API_ALLOW]; /* the methods that the path has, for the header Allow of a 405 */
    const char *key;       /* Idempotency-Key; NULL: none, or the route does not read it */
    he_siphash hash;       /* hash of the request, if it has an Idempotency-Key */
    /* The store's entry of the Idempotency-Key; NULL: the request has no key, or
     * api_idempotency_settle has ended the entry. */
    st_keyed *keyed;
    /* Position in the journal at which the Idempotency-Key was recorded; the answer is sent only
     * when that record is durable. 0: there is no such record. */
    uint64_t noted;
    const char *own_job;  /* id of the job that does the work of this exchange; NULL: no job does */
    api_coding coding_in; /* content coding of the body */
    api_codings codings;  /* content codings that the answer may have */

    /* --- the request's body --- */
    api_text body;
    uint64_t arrived;  /* bytes received, before decompression */
    uint64_t received; /* bytes after decompression */
    api_decompressor
        /* Decompresses the request's body; NULL: the body is not compressed, or has ended. */
        *decompressor;
    api_document document;
    bool has_root;
    api_in root;       /* cursor at the outermost value of a control document */
    api_arrays arrays; /* arrays beside the JSON, if the body is of the type API_PACKED_EDITS */
    api_items ops;     /* the operations of an edit list, whose text is in `body` */

    /* --- the mesh --- */
    /* The mesh that the path names; the exchange counts as one reference to it. NULL: the path
     * names no mesh, or the mesh does not exist or is not in memory. */
    st_mesh *mesh;
    /* True if the mesh is not in memory: it is loaded after the body has arrived. */
    bool is_cold;
    st_mesh_info info; /* description of the mesh, set whenever the mesh is read or written */
    bool has_info;
    /* True if the answer may show more of the store than `info`; it is then sent only after more
     * changes are durable (`shown` in api_answer). */
    bool shows_all;
    /* The position in the journal up to which it was durable when the exchange began. */
    uint64_t since;
    /* The write to the mesh; if it is a claim (api_write_claim), it outlives the handler that began
     * it. */
    st_write write;
    /* What the handler reads, and how: initially a copy of the members `reads`, `cost`, `tag` and
     * `run` of the route. */
    api_reading reading;
    const he_mesh *content; /* the mesh that the handler may read while it runs; NULL: none */
    /* The snapshot that owns `content`; NULL: `content` is read under the shared lock. */
    st_snapshot *snapshot;
    bool keeps; /* true if `snapshot` is needed until the exchange is freed */

    /* --- the handler's state, which `free_state` frees with the exchange --- */
    void *state;
    void (*free_state)(void *state);
    void (*deferred)(api_exchange *x);
    bool is_job;          /* true if `deferred` must run as a job */
    double seconds;       /* estimated duration; 0: not estimated */
    he_progress progress; /* the threads that the work may use, and the callback for its progress */
    /* Why the work was stopped (api_give_up); the code of this problem is HE_OK if no reason was
     * given. */
    api_problem given_up;

    /* --- the answer --- */
    /* The status given to api_publish, 201 or 204; 0: the write has not taken effect. */
    int published;
    char location[API_LOCATION];
    char retry[API_RETRY];
    api_rate_fields rate_fields;
    api_problem problem;
    api_text text;
    api_out out; /* writes JSON to `text` */
    bool answered;
    api_answer answer;
    void *stream;
    void (*free_stream)(void *stream);
    api_source live;
    /* Compresses the answer, or has its uncompressed bytes (api_compressor_whole); NULL: the answer
     * has no compressor. */
    api_compressor *compressor;
    char *coded;    /* the compressed bytes of an answer that was compressed in one call */
    api_kept *kept; /* the answer's body, if it is one that never changes (kept.h), else NULL */
    /* The answer's body, if it is a blob; freed with the exchange unless it is borrowed. */
    api_blob blob;
    uint64_t blob_at;
};

/* --- query parameters: they were checked against the route, so these functions cannot fail --- */
const char *api_param_text(const api_exchange *x, const char *name); /* returns NULL if absent */
bool api_param_flag(const api_exchange *x, const char *name);        /* returns false if absent */
uint64_t api_param_u64(const api_exchange *x, const char *name, uint64_t fallback);
double api_param_number(const api_exchange *x, const char *name, double fallback);
/* Returns the index of the parameter's value in its list of choices, or -1 if the parameter is
 * absent. */
int api_param_choice(const api_exchange *x, const char *name);
/* Returns the choices that the parameter names, as a bit set of their indices. */
unsigned api_param_choices(const api_exchange *x, const char *name);
bool api_param_has_choice(const api_exchange *x, const char *name, const char *choice);

/* Returns what the journal records about who makes the request's changes: Idempotency-Key, job and
 * token. */
st_cause api_cause(const api_exchange *x);

/* --- writing to the mesh --- */
/* Begins x->write, fills x->info and checks preconditions (If-Match, If-None-Match). `expected` is
 * a cursor at the body's expected_revision, or NULL. api_write_commit or st_write_abort ends the
 * write. On failure returns false with the problem filled and without holding a lock. */
bool api_write_begin(api_exchange *x, const api_in *expected);
/* Begins x->write as a claim, which reserves the mesh for a long edit that works on a copy without
 * the mesh's lock (store/write.h). The exchange ends the claim if the handler did not. */
bool api_write_claim(api_exchange *x, const api_in *expected);
/* Commits x->write. From then on the client gets at least 204, even if the answer fails
 * (api_publish). Returns false with the problem filled and nothing changed if the journal has no
 * space, or if a claimed mesh was deleted meanwhile. */
bool api_write_commit(api_exchange *x, const char *ops);
/* Returns true if If-Match, If-None-Match and the expected revision (NULL: none) hold for x->info;
 * otherwise fills the problem. */
bool api_preconditions_hold(api_exchange *x, const uint64_t *expected);
/* Returns true if the preconditions hold for a PUT to a mesh that does not exist: If-None-Match
 * with "*" holds then, If-Match does not. */
bool api_precondition_absent(api_exchange *x);

/* --- long work --- */
/* Arranges that `handler` runs instead of the handler that calls this function, on a thread that
 * may block. The caller must hold no lock, and must return after the call. If the caller is already
 * on such a thread (api_work), `handler` is called at once. */
void api_defer(api_exchange *x, void (*handler)(api_exchange *x));
/* Runs `handler`, whose work may be long. The work becomes a job if the client prefers that, or if
 * `seconds` is longer than the client will wait. Otherwise `handler` runs on a thread that may
 * block if `costly` is set, else it is called at once. The route must have API_LONG. Handlers that
 * read leave this to mesh_access.h. */
void api_run_long(api_exchange *x, void (*handler)(api_exchange *x), bool costly, double seconds);
/* Returns the seconds that the client will wait; longer work becomes a job. A negative result: all
 * work becomes a job. HUGE_VAL: no work becomes a job. */
double api_patience(const api_exchange *x);
/* Returns true if work that takes this many seconds must become a job. */
bool api_wants_job(const api_exchange *x, double seconds);
/* Returns true if work on `amount` elements or bytes must move from a worker thread to a thread
 * that may block, because `amount` exceeds `threshold`. Returns false in api_work, which is on such
 * a thread. */
bool api_is_costly(const api_exchange *x, uint64_t amount, uint64_t threshold);
/* Returns the number of all ids of vertices, half-edges and faces, including deleted elements,
 * which is the cost of work on the whole mesh. */
uint64_t api_elements_of(const he_mesh *mesh);
/* Returns true if work on the whole mesh must move from a worker thread to a thread that may block.
 * Returns false in api_work, which is on such a thread. */
bool api_is_large(const api_exchange *x, const he_mesh *mesh);

/* --- answers: a handler calls one of these functions, once --- */
/* Declares that the write took effect, so that a refusal would be wrong. If a problem comes up
 * later (no memory for the answer, the mesh deleted meanwhile), the client gets `status`, 201 or
 * 204, without a body. If `status` is 201, the header Location is made from x->info, which must
 * describe the new mesh. */
void api_publish(api_exchange *x, int status);
/* Both functions answer with the text that x->out has written: api_answer_json with the media type
 * application/json, api_answer_text with `type`. */
void api_answer_json(api_exchange *x, int status);
void api_answer_text(api_exchange *x, int status, const char *type);
/* Answers with bytes that must stay valid as long as the service or the exchange. */
void api_answer_bytes(api_exchange *x, int status, const char *type, const char *bytes,
                      size_t length);
/* Answers 200 with a body that never changes and outlives the exchange, or 304 if the client has it
 * (If-None-Match). */
void api_answer_kept(api_exchange *x, const char *type, api_kept *kept);
void api_answer_empty(api_exchange *x, int status); /* answers with `status` and without a body */
/* If the client prefers return=minimal, answers 204 and returns true. */
bool api_answer_minimal(api_exchange *x);
/* An answer's body that is made while it is sent. */
typedef struct api_stream {
    int64_t length; /* length of the body in bytes; -1: unknown */
    int64_t (*read)(void *self, char *buffer, size_t size); /* as `read` in api_answer */
    void *self;
    void (*free)(void *self); /* NULL: the stream is borrowed */
} api_stream;

/* Answers with a stream. The exchange then owns the stream, and frees it when the exchange ends. */
void api_answer_stream(api_exchange *x, int status, const char *type, const api_stream *stream);
/* Answers with a blob. If its `free` is not NULL, the exchange then owns the blob. A job keeps the
 * blob without copying it. */
void api_answer_blob(api_exchange *x, int status, const char *type, const api_blob *blob);
/* Answers with a stream without a known end, which is sent while the client's token is valid. The
 * exchange then owns `source`, and frees it when the exchange ends. */
void api_answer_live(api_exchange *x, int status, const char *type, const api_source *source);
/* Sets a header of the answer, replacing one with this name; `value` is copied. It may be called
 * before or after the function that answers. */
void api_answer_header(api_exchange *x, const char *name, const char *value);
/* Sets a header to a formatted value, which must have less than API_HEADER_TEXT bytes: the caller
 * knows how long its parts are. A value with text of the client, such as a part of the path or the
 * query, goes to api_answer_header. */
enum { API_HEADER_TEXT = 1024 };
void api_answer_header_format(api_exchange *x, const char *name, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
/* Sets the ETag of the answer, made from the mesh's state in x->info and the name of the
 * representation (etag.h). */
void api_answer_etag(api_exchange *x, const char *representation);
/* Sets the ETag. If If-None-Match names that tag, answers 304 and returns true. In a job it always
 * returns false, because the client asked for the result. */
bool api_not_modified(api_exchange *x, const char *representation);
/* Does what api_not_modified does, with the given ETag instead of an ETag made from the mesh's
 * revision. */
bool api_not_modified_since(api_exchange *x, const char *etag);

/* --- refusals: they fill x->problem and always return false --- */
bool api_fail(api_exchange *x, int code, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
/* Refuses the request because of a refusal of core about its body (api_problem_set_core). */
bool api_fail_core(api_exchange *x, const he_error *err);
/* Refuses the request because of a refusal of core about its path (api_problem_set_path). */
bool api_fail_path(api_exchange *x, const he_error *err);
bool api_fail_store(api_exchange *x, st_status status);
bool api_fail_memory(api_exchange *x);
/* Refuses the request because its header Accept allows none of the route's media types. */
bool api_fail_accept(api_exchange *x);

#endif
