/* limits.h - every maximum that input from outside has to respect, in one place.
 *
 * Sizes are in bytes unless the comment names another unit. Input over a maximum is refused, never
 * cut. */
#ifndef HE_API_LIMITS_H
#define HE_API_LIMITS_H

#include <stddef.h>
#include <stdint.h>

/* The largest bodies of requests. A parsed control document (a JSON body other than a mesh) costs
 * at most API_MAX_*_VALUES * 64 bytes of cJSON nodes plus its strings. A list of edits needs memory
 * for its text plus the nodes of one operation at a time. */
#define API_MAX_CONTROL        ((size_t)1 << 20) /* a control document */
#define API_MAX_CONTROL_VALUES ((size_t)1 << 18)
#define API_MAX_MATERIALS      ((size_t)16 << 20) /* text of the materials in a mesh document */
#define API_MAX_EDITS          ((size_t)8 << 20)  /* an edit list */
#define API_MAX_EDITS_VALUES   ((size_t)1 << 20)
/* The largest mesh document or file, unless api_options.max_upload is set. */
#define API_DEFAULT_UPLOAD ((uint64_t)1 << 30)

/* Limits of compressed bodies. Both the compressed and the decompressed size of a body must respect
 * the limits above. Each gzip member or zstd frame may decompress to API_DECOMPRESS_RATIO times the
 * compressed bytes that were read from it; the whole body may exceed the sum of these by
 * API_DECOMPRESS_FREE bytes. (Mesh files decompress to ten times their size, zeros to a thousand
 * times.) After API_DECOMPRESS_TURN decompressed bytes the thread serves other requests. A zstd
 * frame may use a window of 8 MiB, the largest that RFC 9659 allows. The decoders of all bodies in
 * transfer may allocate API_MAX_DECOMPRESSING bytes together. */
#define API_DECOMPRESS_FREE   ((uint64_t)1 << 20)
#define API_DECOMPRESS_TURN   ((size_t)1 << 20)
#define API_MAX_DECOMPRESSING ((size_t)256 << 20)
enum { API_DECOMPRESS_RATIO = 100, API_DECOMPRESS_WINDOW = 23 /* log2 of the window */ };

/* Limits of a body that contains several files (multipart/form-data). The whole body counts against
 * the limits above. Files that the reader of a mesh file needs besides that file are kept until the
 * reader is done. */
enum {
    API_MAX_PARTS = 64,
    API_MAX_PART_HEADERS = 8192, /* bytes of headers per part */
    API_MAX_PART_NAME = 1000     /* bytes of a file name, a field name or a media type */
};

/* Answers longer than API_COMPRESS_FROM bytes are compressed. An answer of up to
 * API_COMPRESS_AT_ONCE bytes is compressed in one call, which takes a tenth of a millisecond. A
 * longer one is compressed in pieces of API_COMPRESS_AT_ONCE bytes, and the thread serves other
 * requests after API_COMPRESS_TURN bytes. */
enum { API_COMPRESS_FROM = 1024, API_COMPRESS_AT_ONCE = 64 * 1024, API_COMPRESS_TURN = 1 << 20 };

/* Limits of JSON bodies */
enum {
    API_MAX_DEPTH = 32,    /* nesting depth of arrays and objects */
    API_MAX_MEMBERS = 256, /* members per object */
    API_MAX_NUMBER = 60, /* characters of a number in a control document: cJSON reads at most 63 */
    API_MAX_DOCUMENT_NUMBER = 1024, /* characters of a number in a mesh document */
    API_MAX_KEY = 256               /* characters of a top-level member's name in a mesh document */
};

/* Limits of the request line and of two headers */
enum {
    API_MAX_URI = 8192,      /* bytes of path and query together */
    API_MAX_SEGMENTS = 16,   /* segments per path */
    API_MAX_SEGMENT = 512,   /* bytes of one segment after percent-decoding */
    API_MAX_PARAMETERS = 16, /* parameters per query string */
    API_MAX_REQUEST_ID = 128,
    API_MAX_KEY_LENGTH = 255 /* characters of an Idempotency-Key */
};

/* Limits of what a request may ask for */
enum {
    API_DEFAULT_PAGE = 1000, /* items per page if the request does not say how many */
    API_MAX_PAGE = 10000,
    /* How many meshes one request for a list looks at, to find those whose names contain a text.
     * For tokens with prefixes, a sorted list has no such limit: it looks at all meshes that the
     * token can see, whatever it searches for. */
    API_MAX_SEARCHED = 20000,
    /* A page of elements ends with the item with which it becomes larger than this. */
    API_MAX_PAGE_BYTES = 1 << 26,
    API_MAX_OPS = 65536, /* operations per edit list */
    /* Limits of the work that the operations of one edit list may do; the operation that would
     * exceed a limit is refused. API_MAX_EDITS_ELEMENTS counts the ids that operations name, plus
     * all elements of the mesh for each operation on the whole mesh. API_MAX_EDITS_ROWS counts the
     * rows of the delta, the record of changed elements (16 bytes each). */
    API_MAX_EDITS_ELEMENTS = 1 << 26,
    API_MAX_EDITS_ROWS = 1 << 26,
    /* How many times the cached degree of a vertex or face is used before its half-edges are
     * counted again (edit_cost.h). */
    API_HUB_USES = 256,
    /* Ids per list in a request, including the ids for which references to earlier results
     * stand. */
    API_MAX_IDS = 1 << 24,
    API_MAX_NAMED_MESHES = 16, /* meshes that one request may name besides its own */
    API_MAX_AS = 64,           /* characters of a result name ("as") */
    API_MAX_QUERIES = 10000,   /* questions per query request */
    API_MAX_PATH_STEPS = 4096, /* steps in the path of a traversal */
    API_MAX_WALK = 10000000,   /* half-edges that a walk may return, or that a query may visit */
    API_HALFEDGE_STEPS = 8, /* steps of work charged for visiting one half-edge (base/budget.h) */
    /* How many steps of work all questions of one request may take together. On a mesh with more
     * elements than API_MAX_WALK, a request may take as many steps as one pass over the mesh. A
     * step takes at most 10 ns, so API_MAX_STEPS is up to a second of work. */
    API_MAX_STEPS = API_HALFEDGE_STEPS * API_MAX_WALK,
    /* A query that runs as a job may take API_JOB_TIMES * API_MAX_STEPS steps. */
    API_JOB_TIMES = 100,
    /* Additional steps, per element of the mesh, for the first search for self-intersections in a
     * request. Ordinary surfaces need half of them. */
    API_MEET_STEPS = 320,
    /* The number of pairs of intersecting triangles after which a search for intersecting faces
     * stops. A pair of polygons may count several times. */
    API_MAX_PAIRS = 1 << 20
};

/* A request that costs more than one of these amounts runs on a thread of the job pool instead of a
 * worker thread, which must not block for long (API_WORK). */
enum {
    API_COSTLY_ELEMENTS = 20000,    /* number of vertices, half-edges and faces together */
    API_COSTLY_UPLOAD = 256 * 1024, /* bytes of an uploaded body */
    API_COSTLY_EDITS = 2000,        /* operations per edit list */
    API_COSTLY_STEPS = 1 << 20      /* bytes of deltas to undo or redo */
};

/* Limits of attributes. The column of an attribute takes at most 128 bytes per id of its domain
 * (vertices, faces ...). Columns from files are limited by memory only. */
enum {
    API_MAX_ATTRIBUTES = 256, /* attributes per mesh, checked when a request adds one */
    API_MAX_LABELS = 100000,  /* labels that a JSON body may give to an attribute */
    API_MAX_LABEL = 1024      /* characters per label */
};
#define API_MAX_ATTRIBUTE_BYTES ((uint64_t)1 << 30) /* bytes of a column that a request sends */
/* Up to this number every JSON reader reads integers exactly. */
#define API_MAX_EXACT ((uint64_t)1 << 53)

/* Estimates for long-running requests. Unless the client says otherwise, it waits up to
 * API_PATIENCE seconds; a request that will take longer becomes a job. The rates, in elements per
 * second, were measured on one busy core with a torus of a million quads: building and summarizing
 * 5.2 million vertices and corners took 0.37 s; transforming 6.3 million vertices, half-edges and
 * faces took 0.64 s with the answer; copying and summarizing these elements took 0.32 s; checking
 * them took 0.5 s, and 3.4 s with the search for self-intersections. */
#define API_PATIENCE          1.0
#define API_IMPORT_PER_SECOND 1.2e7
#define API_EDIT_PER_SECOND   1e7
#define API_COPY_PER_SECOND   2e7
#define API_CHECK_PER_SECOND  1e7
#define API_MEET_PER_SECOND   2e6
/* Rates of queries on the whole of a torus of a million quads: building the tree of boxes for ray
 * queries took 1.7 s, finding the self-intersections 1.2 s more, computing curvatures 0.5 to 0.8 s,
 * a flood fill over a million elements 0.24 s, a shortest path 0.4 s. API_MEASURE_PER_SECOND is
 * also the rate at which numbers are written as text. */
#define API_BVH_PER_SECOND     3.5e6
#define API_SEARCH_PER_SECOND  5e6
#define API_MEASURE_PER_SECOND 1e7
#define API_FLOOD_PER_SECOND   4e6
#define API_PATH_PER_SECOND    1.2e7
/* Elements of both meshes per second of making their trees of boxes and comparing them with the
 * default bound. A comparison makes at most API_MAX_PIECES parts of triangles in each direction,
 * about a million in a second. */
#define API_COMPARE_PER_SECOND 1e6
enum { API_MAX_PIECES = 1 << 21 };
/* Rates of deformations: making the system of equations of 300,000 elements took 0.2 s for arap and
 * 1 s for biharmonic, a step of arap 0.02 s. */
#define API_ARAP_PER_SECOND       1.5e6
#define API_BIHARMONIC_PER_SECOND 3e5
#define API_BEND_PER_SECOND       1.5e7
/* Elements per second of making a progressive mesh: for 2.7 million elements it took 2.9 s. */
#define API_PROGRESSIVE_PER_SECOND 1e6
/* How much work a list of operations may do while it holds the mesh's lock, on a worker thread and
 * on a thread of the job pool. A list that exceeds its budget is rolled back and started again, on
 * the job pool or as a job. The unit is the work of transforming one element (API_EDIT_PER_SECOND);
 * slower operations count more per element. One row of the delta counts as half an element; one
 * step around a vertex of high degree counts as a sixteenth of an element. API_MAX_EDITS_STEPS
 * limits the steps of all operations of a list, even in a job, which reaches it after half a
 * minute. */
#define API_WORKER_EDITS    ((uint64_t)1 << 16)
#define API_POOL_EDITS      ((uint64_t)1 << 22)
#define API_MAX_EDITS_STEPS ((uint64_t)1 << 33)
enum { API_ROWS_OF_WORK = 2, API_STEPS_OF_WORK = 16 };
enum {
    /* An operation on the whole of a mesh with more elements than this claims the mesh: it works on
     * a copy, without the mesh's lock, while other writes are refused or wait. On a smaller mesh it
     * holds the lock for a few milliseconds. */
    API_CLAIM_ELEMENTS = 200000,
    /* A list of more operations than this also claims the mesh, that is, works on a copy without
     * the lock. A list that turns out to change more rows than API_LOCKED_ROWS is started again
     * with a claim, with every kind of store: readers of the mesh wait for the lock on worker
     * threads, which then answer nobody, so it must not be held while many rows are made and
     * encoded for the journal. */
    API_CLAIM_EDITS = 4096,
    /* An operation that runs more often than this, once for each item of a list, claims the mesh,
     * too. The runs take less time than as many operations. */
    API_CLAIM_RUNS = 1 << 17,
    API_LOCKED_ROWS = 1 << 17,
    /* Jobs per page of the list of jobs if the request does not say how many. */
    API_DEFAULT_JOBS = 100
};

/* Limits of one event: the bytes of its data, and the rows of the delta it is made from while the
 * mesh's lock is held. An event over either limit only says that the mesh changed. */
enum { API_MAX_EVENT = 64 * 1024, API_MAX_EVENT_ROWS = 1 << 15 };

/* Limits of presences (api/presence). A client is forgotten API_PRESENCE_SECONDS after it was last
 * put; the listeners of a mesh are told of changes at most once in API_PRESENCE_MICROS. */
enum {
    API_MAX_PRESENCE = 4096,       /* bytes of the body that a client puts */
    API_PRESENCE_CLIENT = 40,      /* characters of a client's id */
    API_PRESENCE_NAME = 64,        /* bytes of a client's name */
    API_PRESENCE_IDS = 256,        /* ids of selected elements */
    API_MAX_PRESENT_OF_MESH = 64,  /* clients that show themselves at one mesh */
    API_MAX_PRESENT = 4096,        /* clients that show themselves at all meshes */
    API_MAX_PRESENT_OF_TOKEN = 16, /* clients with one token that show themselves at one mesh */
    API_PRESENCE_SECONDS = 30,
    API_PRESENCE_MICROS = 100000
};

/* The number of listeners that may be sent missed events from the history at the same time; each
 * needs a copy of its mesh. */
enum { API_MAX_BACKFILLS = 8 };

enum { API_PROBLEM_ELEMENTS = 100 }; /* elements that the body of one problem lists at most */

#endif
