/* exchange.h - one request as handlers see it. Internal to api/.
 *
 * By the time a row's `run` is called, service.c has found the route, decoded path and query,
 * checked Content-Type, Accept and the size of the body, parsed a control document, and taken a
 * reference to the mesh (or answered 404). A handler reads those, and either answers or fills
 * x->problem and returns: service.c then answers the problem. Answering nothing is a bug and
 * becomes 500. A problem that is filled wins over an answer, whose headers are then dropped.
 *
 *     void api_mesh_get(api_exchange *x)
 *     {
 *         const he_mesh *mesh = api_read_begin(x);
 *         if (mesh == NULL) {
 *             return;
 *         }
 *         if (!api_not_modified(x, "summary")) {
 *             write_summary(&x->out, mesh, &x->info);
 *             api_answer_json(x, 200);
 *         }
 *         api_read_end(x);
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
#include "base/siphash.h"
#include "store/write.h"

struct api_service {
    st_store *store;
    api_route_tree *routes;
    api_options options;
    api_backfills backfills;
    api_unpack_room unpacking; /* of the decoders of bodies that are arriving */
};

/* Where an exchange is, forwards only: on a worker, on a thread that may block, a job, answered. */
typedef enum api_phase { API_PHASE_BODY, API_PHASE_WORK, API_PHASE_JOB, API_PHASE_DONE } api_phase;

enum { API_LOCATION = 512 }; /* a path of this API, escaped */
/* Headers a handler may ask for when the client's connection is out of reach. */
enum { API_KEPT_HEADERS = 3 };

struct api_exchange {
    api_service *service;
    st_store *store;
    api_arena arena;
    api_phase phase;

    /* --- the request --- */
    api_request request;
    const api_route *route; /* NULL where none matched */
    bool head;              /* HEAD: the server sends the headers only */
    const char *mesh_id;    /* of the path, well formed; NULL: none */
    he_kind kind;           /* of {domain}, or the row's */
    uint32_t id;            /* of {id} */
    const char *code;       /* of {code} */
    const char *attribute;  /* of {name} */
    const char *job_id;     /* of {job}, any text */
    api_query query;
    const char *media_in;  /* which of route->consumes the body is, NULL without a body */
    const char *media_out; /* which of route->produces is wanted */
    api_prefer prefer;
    char allow[API_ALLOW]; /* methods of a path that does not take this one */
    const char *key;       /* Idempotency-Key, NULL without one or where the row takes none */
    he_siphash hash;       /* of a keyed request */
    st_keyed *keyed;       /* the request with its key; NULL: none, or it was settled */
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
    st_mesh_info info; /* filled by read_begin, write_begin and write_commit */
    bool has_info;
    bool shows_all; /* the answer may show more of the store than `info`: see api_answer's shown */
    uint64_t since; /* all records up to here were durable when the exchange began */
    st_write write; /* of the mesh; a claim outlives the handler that began it */
    st_snapshot *past; /* the earlier revision the request is about; NULL: the present, or taken */

    /* --- the handler's own, freed by `free_state` with the exchange --- */
    void *state;
    void (*free_state)(void *state);
    void (*deferred)(api_exchange *x);
    bool is_job;          /* `deferred` is to be one */
    double seconds;       /* that it may take; 0: not estimated */
    he_watch watch;       /* of the work: threads for it, and who is told */
    api_problem given_up; /* why the watch ended it; code HE_OK: no reason was given */
    const char *kept[API_KEPT_HEADERS];

    /* --- the answer --- */
    int published; /* see api_publish; 0: nothing was */
    char location[API_LOCATION];
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

/* A header of the request, NULL when absent. */
const char *api_header_of(const api_exchange *x, const char *name);

/* --- locks --- */
/* Under the shared lock, with x->info filled; NULL (and 404) when the mesh was removed. Where the
 * request names an earlier revision (past.h) that one, and NULL without a problem when the handler
 * has to run again in api_work. */
const he_mesh *api_read_begin(api_exchange *x);
void api_read_end(api_exchange *x);
/* Begins x->write, with x->info filled and preconditions checked (If-Match, If-None-Match).
 * `expected` is a cursor at the body's expected_revision or NULL. On false the problem is filled
 * and no lock is held. Ended by api_write_commit or st_write_abort. */
bool api_write_begin(api_exchange *x, const api_in *expected);
/* Begins a claim as x->write, for a long edit that works without the lock (store/write.h). It is
 * ended with the exchange if not before. */
bool api_write_claim(api_exchange *x, const api_in *expected);
/* Commits x->write and publishes (api_publish) 204. False, with the problem filled, where a claimed
 * mesh was removed meanwhile. */
bool api_write_commit(api_exchange *x, const char *ops);
/* Do If-Match, If-None-Match and the expected revision (NULL: none) hold for x->info? */
bool api_preconditions_hold(api_exchange *x, const uint64_t *expected);
/* An immutable copy of the present revision, or of the one api_read_begin would give, with x->info
 * filled; 404, 410, 507 or no problem on NULL. Released by the caller through the store. Not on a
 * worker thread for large meshes: see api_defer. */
st_snapshot *api_snapshot_of(api_exchange *x, const he_mesh **content);

/* If-None-Match: * or If-Match while the mesh of a PUT is absent. */
bool api_precondition_absent(api_exchange *x);

/* --- work --- */
/* Run `handler` instead of the present one, on a thread that may block. Call and return, before
 * taking a lock. In api_work it is called at once. */
void api_defer(api_exchange *x, void (*handler)(api_exchange *x));
/* The same for work that may take so long that it becomes a job: where the client prefers that, or
 * `seconds` are more than it will wait. Otherwise deferred if `costly`, or called at once. The
 * route has API_LONG. A read whose client prefers a job is one before its handler is called, so
 * that only those whose length can be told beforehand call this. */
void api_run_long(api_exchange *x, void (*handler)(api_exchange *x), bool costly, double seconds);
/* Does the client prefer a job to an answer that may take long? */
bool api_prefers_job(const api_exchange *x);
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
/* An answer that goes on: takes `source`, freed with the exchange. `idle` is a literal. */
void api_answer_live(api_exchange *x, int status, const char *type, const api_source *source,
                     const char *idle);
/* A header of the answer, in place of one of this name; `value` is copied. Before or after the
 * answer. */
void api_answer_header(api_exchange *x, const char *name, const char *value);
void api_answer_header_format(api_exchange *x, const char *name, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
/* The ETag of x->info in this representation. */
void api_answer_etag(api_exchange *x, const char *representation);
/* Puts the ETag; true when If-None-Match names it, and then 304 was answered. */
bool api_not_modified(api_exchange *x, const char *representation);
/* The same with a tag that is no mesh's. */
bool api_not_modified_since(api_exchange *x, const char *etag);
/* The same before a snapshot is taken, which a client with the present state does not need. True as
 * well where the mesh is gone. */
bool api_not_modified_yet(api_exchange *x, const char *representation);

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
