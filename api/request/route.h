/* route.h - one row of the table of routes: a method and path, and everything that depends on them.
 *
 * The table is api/describe/routes.c. It names all handlers, so it is in a higher room than they
 * are, and is passed to the service by pointer. The rows drive dispatch, 404, 405 with Allow, HEAD
 * and OPTIONS, the checks of query parameters, Content-Type and Accept, the maximum size of bodies,
 * the OpenAPI document, labels of metrics, and the tests, which must produce every status that a
 * row declares.
 *
 * The path of a row is a template of literal segments and variables. {mesh} matches a mesh id, {id}
 * an element id, {domain} one of vertices, halfedges, edges, faces and mesh, {revision} a revision,
 * {name} the name of an attribute, {code} and {job} any segment, and {asset} the rest of the path.
 */
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
    /* An edit list: a control document, but its `ops` are parsed one by one from x->ops. */
    API_BODY_EDITS,
    API_BODY_UPLOAD /* a body that is passed piece by piece to the row's `body` */
} api_body_kind;

typedef enum api_param_type {
    /* Text of at most `max` bytes (`max`, `min` and `choices` are members of the parameter's
     * description). */
    API_PARAM_TEXT,
    /* A name that people see: text of at most `max` bytes without the characters that
     * api_unseen_character() finds. */
    API_PARAM_NAME,
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

/* What a handler reads of the mesh whose id is in the path (mesh_access.h). */
typedef enum api_reads {
    API_READS_NONE, /* nothing */
    /* The description of the mesh (x->info), but not its vertices, faces and attributes. */
    API_READS_CARD,
    /* Used for a handler that writes: the function `cost` reads the mesh data under the shared
     * lock, which is released before the handler runs and begins a write (exchange.h). */
    API_READS_BEFORE,
    API_READS_LOCKED, /* the mesh data, under the shared lock: for short work */
    /* API_READS_LOCKED on a worker thread, else API_READS_SNAPSHOT, so that writers need not
     * wait. */
    API_READS_VIEW,
    API_READS_SNAPSHOT /* an immutable snapshot of the mesh data */
} api_reads;

/* What the work of a handler costs. With more than API_COSTLY_ELEMENTS elements it moves from the
 * worker thread to a thread that may block. If it takes more seconds than the client will wait, it
 * becomes a job, provided that the route has API_LONG. */
typedef struct api_cost {
    uint64_t elements;
    double seconds; /* estimated duration; 0: not estimated */
} api_cost;

typedef struct api_reading {
    api_reads reads;
    /* Estimates the cost before the handler runs; NULL if the cost is always small. This function
     * may change x->reading for the request. If the work moves to another thread, the function is
     * called again there. Returns false with the problem filled if the request can be refused
     * already. */
    bool (*cost)(api_exchange *x, const he_mesh *mesh, api_cost *out);
    /* The representation of the answer, from which its ETag is made (etag.h), if a request whose
     * If-None-Match matches may be answered 304 before the handler runs. NULL if the handler itself
     * answers If-None-Match, after checking that its target exists. A read that may become a job
     * should have a tag here, or set one in `cost`, if the tag can be known before the handler
     * runs. */
    const char *tag;
    void (*run)(api_exchange *x); /* the handler */
} api_reading;

enum {
    API_WRITES = 1, /* the route changes something, and reads If-Match */
    /* A write whose cost grows with its upload: a thread that may block works on large uploads. */
    API_COSTLY = 2,
    API_MAY_CREATE = 4, /* the mesh that the path names need not exist */
    /* The handler itself evaluates the header Accept, because ?format= overrides it. */
    API_OWN_ACCEPT = 8,
    API_FIXED = 16, /* the path is not under /v1: it is independent of the API version */
    /* The route reads Idempotency-Key; the answer is kept with the mesh (idempotency.h). */
    API_IDEMPOTENCY_KEY = 32,
    /* The route makes a mesh and reads Idempotency-Key; the answer is kept for the whole store
     * (idempotency.h). */
    API_IDEMPOTENCY_KEY_NEW = 64,
    API_LONG = 128, /* the work may become a job: the route reads Prefer and may answer 202 */
    /* The route is allowed while a long edit that has claimed the mesh works on it
     * (store/write.h). */
    API_INTERRUPTS = 256,
    /* The route has the parameter `dry_run`, so its answer may describe a state that the mesh never
     * had. */
    API_REHEARSED = 512,
    /* The route reads, and its cost grows with the mesh. Requests from pages of other sites are
     * refused, because such pages could make the server work although they cannot read the
     * answer. */
    API_EXPENSIVE = 1024,
    /* Answers of the route show nothing from the store, so they are sent without waiting for the
     * journal, like answers of routes with API_FIXED. */
    API_STORELESS = 2048,
    /* The answer is the result of another request (a job), whose answer may have had no ETag. */
    API_TAG_OF_OTHERS = 4096,
    /* The limits of clients do not apply to the route: monitoring must always get an answer. */
    API_UNLIMITED = 8192,
    /* If nothing is at the path, a client that accepts HTML gets the page /docs/404 with the status
     * 404, and other clients a problem. */
    API_MISSING_PAGE = 16384,
    /* The query belongs to the page that the route answers with; the server does not read it. */
    API_OWN_QUERY = 32768
};

/* A response header of a route, and its description for the OpenAPI document. */
typedef struct api_told_header {
    const char *name, *doc;
} api_told_header;

enum { API_ROUTE_PARAMETERS = 8, API_ROUTE_HEADERS = 3, API_ROUTE_STATUSES = 20 };

typedef struct api_route {
    const char *method; /* method of the route; a row with GET also answers HEAD */
    const char *path;   /* template of the path */
    const char *name;   /* operationId in the OpenAPI document */
    he_kind kind;       /* kind of the elements that the route is about, if any */
    /* Name of the relation between elements that the route reads; NULL: it reads the elements
     * themselves. */
    const char *relation;
    /* Called before the body of an upload arrives: chooses the reader of the body by x->media_in.
     * NULL if there is only one reader. */
    void (*begin)(api_exchange *x);
    /* What the function `begin` reads of the mesh: API_READS_NONE, API_READS_CARD or
     * API_READS_LOCKED. If the mesh does not exist or is not in memory, `begin` reads nothing. */
    api_reads begin_reads;
    void (*body)(api_exchange *x, const char *bytes, size_t length);
    /* Reads the body's JSON document into x->state before the mesh is obtained; NULL if `cost` or
     * `run` reads the document. Returns false with the problem filled, or with x->deferred set to a
     * function that calls api_read in the end. */
    bool (*decode)(api_exchange *x);
    void (*run)(api_exchange *x); /* the handler; called in api_end or in api_work */
    /* Tries to answer a request to a mesh that is not in memory, on a thread that may block, with
     * x->info from the mesh's card (its stored description). If this function sets neither an
     * answer nor a problem, the mesh is loaded and `run` is called. NULL: the mesh is always
     * loaded. */
    void (*cold)(api_exchange *x, st_cold *cold);
    api_reads reads;
    bool (*cost)(api_exchange *x, const he_mesh *mesh,
                 api_cost *out); /* see api_reading, also for `tag` */
    const char *tag;
    api_role role; /* the lowest role that a token needs (gate.h) */
    unsigned flags;
    api_body_kind body_kind;
    const char *const *consumes; /* media types of the body; NULL: none */
    const char *const *produces; /* media types of a successful answer; the first is the default */
    const api_parameter *parameters[API_ROUTE_PARAMETERS]; /* ends in NULL */
    /* The headers that 200 answers of the route may have besides ETag and Location; ends in
     * NULL. */
    const api_told_header *headers[API_ROUTE_HEADERS];
    /* All statuses of the route besides those of api_route_common; ends in 0. */
    int statuses[API_ROUTE_STATUSES];
    /* The names of the OpenAPI schemas of the request's body and of the answer's body; NULL if
     * there is no such body or it is not JSON. */
    const char *request, *response;
    /* Schema of one line of an NDJSON answer, or of one event of an event stream. */
    const char *item;
    const char *summary; /* description of the route in a few words */
    const char *doc;     /* description of the route in a sentence or two */
} api_route;

/* Parses a list of words separated by commas; `out` gets the bit set of their indices in `choices`.
 * Returns false if a word is not in `choices`, if one is repeated, or if the list is empty. */
bool api_choices_parse(const char *const *choices, const char *list, unsigned *out);

/* The values that a path gives to the variables of its template. */
typedef struct api_variables {
    /* Value of {mesh}, percent-decoded but not checked; NULL: not in the template. */
    const char *mesh;
    he_kind domain; /* kind of element that {domain} names; HE_KIND_COUNT: not in the template */
    /* Values of {id} and so on, percent-decoded but not checked; NULL: not in the template. */
    const char *id, *code, *name, *job, *revision;
} api_variables;

/* The templates of a table as a tree of path segments, so that the time to find a route does not
 * depend on the number of rows. `table` must outlive the tree. api_route_tree_new returns NULL when
 * memory is out. */
typedef struct api_route_tree api_route_tree;
api_route_tree *api_route_tree_new(api_route_table table);
void api_route_tree_free(api_route_tree *tree);

/* Returns the row for a method and path. If there is none, returns NULL and sets `allow` to the
 * list of the path's methods, or to "" if the path matches no template. */
enum { API_ALLOW = 64 };
const api_route *api_route_find(const api_route_tree *tree, const char *method,
                                const api_path *path, api_variables *out, char allow[API_ALLOW]);

/* Finds the first segment of a path that matches no template; NULL if the path is only too short.
 * `list` gets the literals that templates have in place of this segment; "" if they have none, or
 * have a variable that matches any text. */
enum { API_CHOICES = 256 };
const char *api_route_choices(const api_route_tree *tree, const api_path *path,
                              char list[API_CHOICES]);

#endif
