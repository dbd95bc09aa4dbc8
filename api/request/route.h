/* route.h - one row of the table of routes: a method and path, and everything that depends on them.
 *
 * The table is api/describe/routes.c, which stands above the handlers that it names and is passed
 * down to the service. The rows drive dispatch, 404, 405 with Allow, HEAD and OPTIONS, the checks
 * of query parameters, Content-Type and Accept, the maximum size of bodies, the OpenAPI document,
 * labels of metrics, and the tests, which must produce every status that a row declares.
 *
 * A template is literal segments and variables. {mesh} matches a mesh id; {id} an element id;
 * {domain} is vertices, halfedges, edges, faces or mesh; {name} is an attribute's name; {code} and
 * {job} any segment; {asset} the rest of the path. */
#ifndef HE_API_REQUEST_ROUTE_H
#define HE_API_REQUEST_ROUTE_H

#include "api/header/path.h"
#include "api/request/api.h"
#include "store/store.h"

/* The kind of body determines its maximum size and how it is read before the handler runs. */
typedef enum api_body_kind {
    API_BODY_NONE,    /* a body is refused */
    API_BODY_OPTION,  /* a control document or nothing */
    API_BODY_CONTROL, /* a control document, parsed into x->root */
    API_BODY_EDITS,   /* an edit list: a control document whose `ops` are left in x->ops */
    API_BODY_UPLOAD   /* passed piece by piece to the row's `body` */
} api_body_kind;

typedef enum api_param_type {
    API_PARAM_TEXT,   /* text of at most `max` bytes */
    API_PARAM_FLAG,   /* true or false */
    API_PARAM_U64,    /* a whole number within min and max */
    API_PARAM_NUMBER, /* a finite number within min and max */
    API_PARAM_CHOICE, /* one of `choices` */
    API_PARAM_CHOICES /* some of `choices`, separated by commas, each at most once */
} api_param_type;

typedef struct api_parameter {
    const char *name;
    api_param_type type;
    double min, max;
    const char *const *choices; /* ends in NULL */
    const char *doc;
} api_parameter;

/* What a handler reads of the mesh whose id is in the path: see mesh_access.h. */
typedef enum api_reads {
    API_READS_NONE, /* nothing of the mesh */
    API_READS_CARD, /* x->info without the content */
    /* Only for a write: `cost` reads the content under the shared lock, which is released before
     * the handler runs and begins a write (exchange.h). */
    API_READS_BEFORE,
    API_READS_LOCKED,  /* the content under the shared lock: for short work */
    API_READS_VIEW,    /* LOCKED on a worker, SNAPSHOT elsewhere, so that writers need not wait */
    API_READS_SNAPSHOT /* an immutable copy of the content */
} api_reads;

/* What a read costs: above API_COSTLY_ELEMENTS it leaves the worker, and if it takes more seconds
 * than the client will wait it becomes a job, where the row has API_LONG. */
typedef struct api_cost {
    uint64_t elements;
    double seconds; /* 0: not estimated */
} api_cost;

typedef struct api_reading {
    api_reads reads;
    /* Estimates the cost, before the mesh is read; NULL where it is always small. It may change
     * x->reading for this request, and is called again where the work continues. Returns false with
     * the problem filled if the request can be refused already. */
    bool (*cost)(api_exchange *x, const he_mesh *mesh, api_cost *out);
    /* The representation of the answer (etag.h), if If-None-Match may be answered before the
     * handler runs; NULL: the handler checks first that its target exists. A read that may become a
     * job needs a tag, which `cost` may set, unless it cannot be known before. */
    const char *tag;
    void (*run)(api_exchange *x); /* the handler */
} api_reading;

enum {
    API_WRITES = 1,     /* changes something; If-Match is read */
    API_COSTLY = 2,     /* a write whose cost grows with the upload: large ones leave the worker */
    API_MAY_CREATE = 4, /* the mesh need not exist */
    API_OWN_ACCEPT = 8, /* the handler evaluates Accept (?format= comes first) */
    API_FIXED = 16,     /* not under /v1: independent of the API version */
    API_IDEMPOTENCY_KEY = 32, /* reads Idempotency-Key; kept with the mesh: idempotency.h */
    /* The handler reads Idempotency-Key for making a mesh; the answer is kept with the store, not
     * with a mesh. */
    API_IDEMPOTENCY_KEY_NEW = 64,
    API_LONG = 128,       /* may become a job: reads Prefer, may answer 202 */
    API_INTERRUPTS = 256, /* allowed during a long edit of the mesh */
    API_REHEARSED = 512,  /* takes `dry_run`: an answer may describe a state that does not exist */
    API_UNLIMITED = 8192, /* not counted by limits of clients: monitoring must get in */
    /* The answer repeats that of another request, which may have had no ETag. */
    API_TAG_OF_OTHERS = 4096,
    /* Answers show nothing that is stored, so they wait for no journal; the same holds for those
     * with API_FIXED. */
    API_STORELESS = 2048,
    /* A read whose cost grows with the mesh. It is refused to pages of other sites, which could
     * make the server work even though they cannot read the answer. */
    API_EXPENSIVE = 1024
};

/* A header that only some of a route's 200 answers have. */
typedef struct api_told_header {
    const char *name, *doc;
} api_told_header;

enum { API_ROUTE_PARAMETERS = 8, API_ROUTE_HEADERS = 3, API_ROUTE_STATUSES = 20 };

typedef struct api_route {
    const char *method;   /* rows of GET answer HEAD too */
    const char *path;     /* path template */
    const char *name;     /* operationId */
    he_kind kind;         /* kind of the elements it is about, if any */
    const char *relation; /* relation to read; NULL: the elements themselves */
    /* Chooses a reader by x->media_in, before the body of an upload arrives. NULL if there is
     * nothing to choose. */
    void (*begin)(api_exchange *x);
    /* What the function `begin` reads of the mesh: NONE; CARD, which is x->info; or LOCKED. If the
     * mesh is absent or not in memory, it reads nothing. */
    api_reads begin_reads;
    void (*body)(api_exchange *x, const char *bytes, size_t length);
    /* Reads the document into x->state before the mesh is obtained; NULL if `cost` or `run` reads
     * it. Returns false with the problem filled, or with x->deferred set to a function that calls
     * api_read in the end. */
    bool (*decode)(api_exchange *x);
    void (*run)(api_exchange *x); /* called in api_end or in api_work */
    /* Handles a request to a mesh that is not in memory, on a thread that may block, with x->info
     * from the mesh's card: answers without loading the mesh, or returns with neither answer nor
     * problem, and then the mesh is loaded. If it is NULL, the mesh is always loaded. */
    void (*cold)(api_exchange *x, st_cold *cold);
    api_reads reads;
    bool (*cost)(api_exchange *x, const he_mesh *mesh,
                 api_cost *out); /* like tag, see api_reading */
    const char *tag;
    api_role role; /* the least role that a token needs: gate.h */
    unsigned flags;
    api_body_kind body_kind;
    const char *const *consumes; /* media types of the body; NULL: none */
    const char *const *produces; /* media types of a success; the first is the default */
    const api_parameter *parameters[API_ROUTE_PARAMETERS]; /* ends in NULL */
    /* The headers that 200 answers of the route may have besides ETag and Location; ends in
     * NULL. */
    const api_told_header *headers[API_ROUTE_HEADERS];
    /* All statuses of the route besides those of api_route_common; ends in 0. */
    int statuses[API_ROUTE_STATUSES];
    /* The names of OpenAPI component schemas of the body and the answer; NULL if there is none or
     * it is not JSON. */
    const char *request, *response;
    const char *item;    /* schema of a line of NDJSON, or of an event of a stream */
    const char *summary; /* a few words */
    const char *doc;     /* a sentence or two */
} api_route;

/* Reads a list of `choices`, separated by commas, as a bit set. Returns false if it names an
 * unknown one, repeats one, or is empty. */
bool api_choices_parse(const char *const *choices, const char *list, unsigned *out);

/* The values that a path gives to the variables of its template. */
typedef struct api_variables {
    const char *mesh;                   /* decoded but not checked; NULL: not in the template */
    he_kind domain;                     /* HE_KIND_COUNT: not in the template */
    const char *id, *code, *name, *job; /* as for `mesh` */
} api_variables;

/* The templates of a table as a tree of path segments, so that finding a route does not depend on
 * the number of rows. `table` outlives it. api_route_tree_new returns NULL when memory is out. */
typedef struct api_route_tree api_route_tree;
api_route_tree *api_route_tree_new(api_route_table table);
void api_route_tree_free(api_route_tree *tree);

/* Returns the row for a method and path, or NULL. Then `allow` lists the methods of the path; it is
 * "" if the path matches no template. */
enum { API_ALLOW = 64 };
const api_route *api_route_find(const api_route_tree *tree, const char *method,
                                const api_path *path, api_variables *out, char allow[API_ALLOW]);

/* Finds the first segment of a path that matches no template; NULL if the path is only too short.
 * `list` names the literals that templates have there, "" if there are none or any text fits. */
enum { API_CHOICES = 256 };
const char *api_route_choices(const api_route_tree *tree, const api_path *path,
                              char list[API_CHOICES]);

#endif
