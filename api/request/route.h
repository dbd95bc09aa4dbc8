/* route.h - one row of the table of routes: a method and path, and all there is to know about it.
 *
 * The table is api/describe/routes.c, which stands above the handlers it names and is handed down
 * to the service. From the rows come dispatch, 404, 405 with Allow, HEAD and OPTIONS, the check of
 * query parameters, Content-Type and Accept, the caps of bodies, the OpenAPI document, labels of
 * metrics, and the tests' duty to hit every status a row declares.
 *
 * A template is literal segments and variables. {mesh} matches a mesh id; {id} an element id;
 * {domain} vertices, halfedges, edges, faces or mesh and nothing else; {name} that of an attribute;
 * {code} and {job} any segment; {asset} the rest of the path. */
#ifndef HE_API_REQUEST_ROUTE_H
#define HE_API_REQUEST_ROUTE_H

#include "api/header/path.h"
#include "api/request/api.h"
#include "store/store.h"

/* What a request's body is, and so its cap and what happens to it before the handler. */
typedef enum api_body_kind {
    API_BODY_NONE,    /* refused when there is one */
    API_BODY_OPTION,  /* a control document or nothing */
    API_BODY_CONTROL, /* a control document, parsed into x->root */
    API_BODY_EDITS,   /* the same with the cap of an edit list, whose `ops` are left in x->ops */
    API_BODY_UPLOAD   /* handed piece by piece to the row's `body` */
} api_body_kind;

typedef enum api_param_type {
    API_PARAM_TEXT,   /* of at most `max` bytes */
    API_PARAM_FLAG,   /* true or false */
    API_PARAM_U64,    /* a whole number within min and max */
    API_PARAM_NUMBER, /* a finite number within min and max */
    API_PARAM_CHOICE, /* one of `choices` */
    API_PARAM_CHOICES /* some of them, joined by commas, each once */
} api_param_type;

typedef struct api_parameter {
    const char *name;
    api_param_type type;
    double min, max;
    const char *const *choices; /* ends in NULL */
    const char *doc;
} api_parameter;

/* What a handler reads of the mesh that its path names: see mesh_access.h. */
typedef enum api_reads {
    API_READS_NONE,   /* nothing */
    API_READS_CARD,   /* what is known of a mesh beside its content */
    API_READS_BEFORE, /* of a write: `cost` looks at the content, as LOCKED; it is given back before
                         the handler, which begins a write of it (exchange.h) */
    API_READS_LOCKED, /* the content, which nobody changes meanwhile: for what is short */
    API_READS_VIEW, /* as LOCKED on a worker, as SNAPSHOT elsewhere, where writers need not wait */
    API_READS_SNAPSHOT /* an immutable copy of the content */
} api_reads;

/* What reading takes: more than API_COSTLY_ELEMENTS leave the worker, and seconds that the client
 * will not wait for make a job where the row has API_LONG. */
typedef struct api_cost {
    uint64_t elements;
    double seconds; /* 0: not estimated */
} api_cost;

typedef struct api_reading {
    api_reads reads;
    /* What will be read of the mesh at hand, found before it is: NULL where that is little. False
     * with the problem filled where it can be told already that the request is refused. It may
     * change x->reading for this request. Called again where the work goes on. */
    bool (*cost)(api_exchange *x, const he_mesh *mesh, api_cost *out);
    /* The representation that is answered with (etag.h), where If-None-Match may be answered before
     * the handler runs; NULL: the handler looks what it is asked for first. What may be a job has
     * one, which `cost` may set, unless it cannot be known before. */
    const char *tag;
    void (*run)(api_exchange *x); /* the handler */
} api_reading;

enum {
    API_WRITES = 1,       /* changes something; If-Match is read */
    API_COSTLY = 2,       /* a write that costs the upload: large ones leave the worker */
    API_MAY_CREATE = 4,   /* the mesh need not exist */
    API_OWN_ACCEPT = 8,   /* the handler reads Accept itself (?format= comes first) */
    API_FIXED = 16,       /* not under /v1: the same whatever the version */
    API_KEYED = 32,       /* Idempotency-Key is read, and the answer kept with the mesh: keyed.h */
    API_KEYED_NEW = 64,   /* the same of what makes a mesh: kept with the store */
    API_LONG = 128,       /* may become a job: Prefer is read, and 202 may be the answer */
    API_INTERRUPTS = 256, /* is not kept out by a long edit of the mesh */
    API_REHEARSED = 512,  /* takes `dry_run`: an answer may be about nothing that is */
    API_UNLIMITED =
        8192, /* limits of clients do not count it: watchers of the server must get in */
    API_TAG_OF_OTHERS = 4096, /* the answer of another request, which need not have had a tag */
    API_STORELESS = 2048,     /* answers show nothing that is stored, and wait for no journal; so do
                                 those of API_FIXED */
    API_EXPENSIVE = 1024 /* a read that costs the mesh: refused to pages of other sites, which need
                            not be able to read the answer to make us work */
};

/* A header that only some of a route's answers with 200 have. */
typedef struct api_told_header {
    const char *name, *doc;
} api_told_header;

enum { API_ROUTE_PARAMETERS = 8, API_ROUTE_HEADERS = 3, API_ROUTE_STATUSES = 20 };

typedef struct api_route {
    const char *method;   /* GET rows answer HEAD too */
    const char *path;     /* the template */
    const char *name;     /* operationId */
    he_kind kind;         /* of the elements it is about, where it is about any */
    const char *relation; /* what lies beside them; NULL: themselves */
    /* Before the body, of uploads only: choose a reader by x->media_in. NULL: nothing to do. */
    void (*begin)(api_exchange *x);
    api_reads begin_reads; /* of it: NONE; CARD, which is x->info; or LOCKED. Where the mesh is
                              absent or not in memory, it reads nothing */
    void (*body)(api_exchange *x, const char *bytes, size_t length);
    /* Reads the document into x->state, before the mesh is obtained: NULL where `cost` or `run`
     * does. False with the problem filled; or with x->deferred, which calls api_read in the end. */
    bool (*decode)(api_exchange *x);
    void (*run)(api_exchange *x); /* in api_end, or in api_work */
    /* Of a mesh that is not in memory, with x->info of its card, on a thread that may block:
     * answers without loading it, or returns with neither answer nor problem. NULL: it is loaded.
     */
    void (*cold)(api_exchange *x, st_cold *cold);
    api_reads reads;
    bool (*cost)(api_exchange *x, const he_mesh *mesh,
                 api_cost *out); /* like tag, see api_reading */
    const char *tag;
    api_role role; /* the least that a token needs: gate.h */
    unsigned flags;
    api_body_kind body_kind;
    const char *const *consumes; /* media types of the body, NULL for none */
    const char *const *produces; /* of a success, the first is the default */
    const api_parameter *parameters[API_ROUTE_PARAMETERS]; /* ends in NULL */
    const api_told_header *headers[API_ROUTE_HEADERS];     /* likewise; beside ETag and Location */
    int statuses[API_ROUTE_STATUSES]; /* all it answers, besides those of api_route_common; 0 ends
                                       */
    const char *request, *response;   /* component schemas of OpenAPI, NULL: not JSON or nothing */
    const char *line;    /* the same of a line, where application/x-ndjson is produced */
    const char *summary; /* a few words */
    const char *doc;     /* a sentence or two */
} api_route;

/* The set of `choices` that a list of them joined by commas names, a bit each; false where it names
 * another, one twice, or none. */
bool api_choices_parse(const char *const *choices, const char *list, unsigned *out);

/* What the segments of a path gave to the variables of its template. */
typedef struct api_variables {
    const char *mesh; /* as decoded, not yet checked; NULL where the template has none */
    he_kind domain;   /* HE_KIND_COUNT where it has none */
    const char *id, *code, *name, *job; /* like mesh */
} api_variables;

/* The templates of a table as a tree of their segments: a request is found by the segments of its
 * path, however many rows there are. `table` outlives it. NULL when memory is out. */
typedef struct api_route_tree api_route_tree;
api_route_tree *api_route_tree_new(api_route_table table);
void api_route_tree_free(api_route_tree *tree);

/* The row for a method and path. NULL when there is none: then `allow` lists the methods of the
 * path, and is "" where the path matches no template. */
enum { API_ALLOW = 64 };
const api_route *api_route_find(const api_route_tree *tree, const char *method,
                                const api_path *path, api_variables *out, char allow[API_ALLOW]);

/* The first segment of a path that no template has in its place, NULL when templates go on where
 * the path ends. `list` is what templates have there, "" when that may be anything or nothing. */
enum { API_CHOICES = 256 };
const char *api_route_choices(const api_route_tree *tree, const api_path *path,
                              char list[API_CHOICES]);

#endif
