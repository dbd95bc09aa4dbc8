/* limits.h - every maximum that input from outside meets, in one place.
 *
 * Sizes are bytes unless said otherwise. What exceeds one is refused, never cut. */
#ifndef HE_API_LIMITS_H
#define HE_API_LIMITS_H

#include <stddef.h>
#include <stdint.h>

/* Bodies. A parsed control document costs at most API_MAX_*_VALUES * 64 bytes of cJSON nodes beside
 * its strings; of an edit list it is its text and the operation at hand. */
#define API_MAX_CONTROL        ((size_t)1 << 20) /* a control document */
#define API_MAX_CONTROL_VALUES ((size_t)1 << 18)
#define API_MAX_MATERIALS      ((size_t)16 << 20) /* the materials of a mesh document */
#define API_MAX_EDITS          ((size_t)8 << 20)  /* an edit list */
#define API_MAX_EDITS_VALUES   ((size_t)1 << 20)
#define API_DEFAULT_UPLOAD                                                 \
    ((uint64_t)1 << 30) /* a mesh document or file; api_options.max_upload \
                         */

/* Coded bodies. What is unfolded counts against the limits above like a body sent plain; what is
 * sent does too. A member or frame may unfold to API_UNPACK_RATIO times what of its compressed data
 * was read, and all together to API_UNPACK_FREE bytes beyond that: mesh files unfold to ten times
 * their size, zeros to a thousand. After API_UNPACK_TURN plain bytes others have their turn. A
 * frame of zstd may look back over a window of 8 MiB, which is as much as RFC 9659 lets a sender
 * ask for; the decoders of all bodies that are arriving have API_MAX_UNPACKING bytes together. */
#define API_UNPACK_FREE   ((uint64_t)1 << 20)
#define API_UNPACK_TURN   ((size_t)1 << 20)
#define API_MAX_UNPACKING ((size_t)256 << 20)
enum { API_UNPACK_RATIO = 100, API_UNPACK_WINDOW = 23 /* power of two */ };

/* A body of several files. All of it counts against the limits above; what a reader needs beside
 * the mesh's own file is kept until that is read. */
enum {
    API_MAX_PARTS = 64,
    API_MAX_PART_HEADERS = 8192, /* of one part */
    API_MAX_PART_NAME = 1000     /* of a file, a field or a media type */
};

/* Answers are coded when they have more than API_PACK_FROM bytes. Those up to API_PACK_AT_ONCE are
 * coded as a whole, which takes half a millisecond; of longer ones that much is in hand at a time,
 * and others have their turn after API_PACK_TURN. */
enum { API_PACK_FROM = 1024, API_PACK_AT_ONCE = 64 * 1024, API_PACK_TURN = 1 << 20 };

/* JSON */
enum {
    API_MAX_DEPTH = 32,    /* nesting of arrays and objects */
    API_MAX_MEMBERS = 256, /* of one object */
    API_MAX_NUMBER = 60,   /* characters of a number in a control document: cJSON reads 63 */
    API_MAX_DOCUMENT_NUMBER = 1024, /* the same in a mesh document */
    API_MAX_KEY = 256               /* characters of a top-level member's name in a mesh document */
};

/* The request line */
enum {
    API_MAX_URI = 8192,      /* path and query together */
    API_MAX_SEGMENTS = 16,   /* of a path */
    API_MAX_SEGMENT = 512,   /* one decoded segment */
    API_MAX_PARAMETERS = 16, /* of a query */
    API_MAX_REQUEST_ID = 128,
    API_MAX_KEY_LENGTH = 255 /* characters of an Idempotency-Key */
};

/* What a request may ask for */
enum {
    API_DEFAULT_PAGE = 1000, /* items */
    API_MAX_PAGE = 10000,
    API_MAX_PAGE_BYTES = 1 << 26, /* a page of elements ends after the one that passes this */
    API_MAX_OPS = 65536,          /* operations of one edit list */
    /* What the operations of one list may look at and change before the next one is refused: ids
     * named, elements of the mesh for each operation on the whole of it; rows of the delta, of 16
     * bytes. */
    API_MAX_EDITS_ELEMENTS = 1 << 26,
    API_MAX_EDITS_ROWS = 1 << 26,
    API_HUB_USES = 256,        /* of a degree that was counted, see api/write/edit_cost.h */
    API_MAX_IDS = 1 << 24,     /* in one list of ids, what references stand for included */
    API_MAX_OTHERS = 16,       /* meshes that one request names beside its own */
    API_MAX_AS = 64,           /* characters of an "as" name */
    API_MAX_QUERIES = 10000,   /* questions of one query */
    API_MAX_PATH_STEPS = 4096, /* of a traversal's path */
    API_MAX_WALK = 10000000,   /* half-edges a walk may answer with, or a query look at */
    API_HALFEDGE_STEPS = 8,    /* what looking at one of those is charged: base/budget.h */
    /* What all questions of a request may be charged; of larger meshes as much as one pass takes.
     * Up to a second of work: steps take 10 ns and less. */
    API_MAX_STEPS = API_HALFEDGE_STEPS * API_MAX_WALK,
    API_JOB_TIMES = 100, /* a job may be charged so many times as much */
    /* Beside those, what the first search for intersections of a request may be charged, for each
     * element of the mesh. Ordinary surfaces take half of it. */
    API_MEET_STEPS = 320,
    API_MAX_PAIRS = 1 << 20 /* of faces that meet; of polygons perhaps fewer */
};

/* Above these a costly request leaves the worker for the job pool (API_WORK). */
enum {
    API_COSTLY_ELEMENTS = 20000,    /* vertices, half-edges and faces together */
    API_COSTLY_UPLOAD = 256 * 1024, /* bytes received */
    API_COSTLY_EDITS = 2000,        /* operations of one list */
    API_COSTLY_STEPS = 1 << 20      /* bytes of deltas undone or done again */
};

/* Attributes. One column has as many bytes as its domain has ids, times at most 128; files bring as
 * many as they have room for. */
enum {
    API_MAX_ATTRIBUTES = 256, /* of one mesh, where a request would add another */
    API_MAX_LABELS = 100000,  /* of one attribute, in JSON */
    API_MAX_LABEL = 1024      /* characters of one */
};
#define API_MAX_ATTRIBUTE_BYTES ((uint64_t)1 << 30) /* of one column that a request brings */
#define API_MAX_EXACT           ((uint64_t)1 << 53) /* up to here every reader of JSON counts right */

/* Long work. A client that said nothing waits for API_PATIENCE seconds; what will take longer
 * becomes a job. The rates were measured with a torus of a million quads on one busy core: 5.2
 * million vertices and corners were built and summed up in 0.37 s, 6.3 million vertices, half-edges
 * and faces transformed, with the answer, in 0.64 s and copied and summed up in 0.32 s; checked in
 * 0.5 s, and with their intersections in 3.4 s. */
#define API_PATIENCE          1.0
#define API_IMPORT_PER_SECOND 1.2e7
#define API_EDIT_PER_SECOND   1e7
#define API_COPY_PER_SECOND   2e7
#define API_CHECK_PER_SECOND  1e7
#define API_MEET_PER_SECOND   2e6
/* Questions about all of the same torus: the tree of boxes that rays are asked of was made in
 * 1.7 s, its intersections were found in 1.2 s with the tree, curvatures in 0.5 to 0.8 s, a million
 * elements of a flood in 0.24 s, a shortest path in 0.4 s. Numbers are written as text at the rate
 * of measures. */
#define API_TREE_PER_SECOND    3.5e6
#define API_SEARCH_PER_SECOND  5e6
#define API_MEASURE_PER_SECOND 1e7
#define API_FLOOD_PER_SECOND   4e6
#define API_PATH_PER_SECOND    1.2e7
/* 2.7 million were decimated for a progressive mesh in 2.9 s. */
#define API_PROGRESSIVE_PER_SECOND 1e6
/* What a list of operations may have of a worker and of a thread of the pool, beside the mesh's
 * lock, before it is rolled back and begun again on the pool and as a job: in elements that are
 * transformed, API_EDIT_PER_SECOND. An operation counts with its pace. A row of the delta takes as
 * long as half an element, and a step about a hub as long as a sixteenth. The steps of all
 * operations of a list have a maximum, too, which a job meets after half a minute. */
#define API_WORKER_EDITS    ((uint64_t)1 << 16)
#define API_POOL_EDITS      ((uint64_t)1 << 22)
#define API_MAX_EDITS_STEPS ((uint64_t)1 << 33)
enum { API_ROWS_OF_WORK = 2, API_STEPS_OF_WORK = 16 };
enum {
    /* Above this an operation on the whole mesh claims it and works on a copy; below, it takes the
     * lock for a few milliseconds. */
    API_CLAIM_ELEMENTS = 200000,
    /* A list of more operations does, too, and one that turns out to change more rows begins again
     * so: they are coded for the journal, a megabyte and more, while nobody waits for the lock. */
    API_CLAIM_EDITS = 4096,
    API_LOCKED_ROWS = 1 << 17,
    API_DEFAULT_JOBS = 100 /* of one page of the list */
};

/* Of an event: bytes of its data, and rows of the delta it is made from, under the mesh's lock.
 * Beyond either it only says that there was one. */
enum { API_MAX_EVENT = 64 * 1024, API_MAX_EVENT_ROWS = 1 << 15 };

/* Listeners that are brought forward from the history at once, each with a copy of its mesh. */
enum { API_MAX_BACKFILLS = 8 };

enum { API_PROBLEM_ELEMENTS = 100 }; /* named one by one in a problem */

#endif
