/* failing.h - allocations that fail on purpose, one after the other.
 *
 * What allocates memory must fail cleanly wherever an allocation fails: it is refused, and nothing
 * has changed. fails_cleanly() proves it for each allocation that a run makes:
 *
 *     static int split(void *context) { return he_edge_split(...); }
 *     static bool unchanged(void *context) { return he_mesh_equal(...); }
 *     assert_true(fails_cleanly(split, unchanged, &mesh) > 5);
 *
 * A run that reaches the failing allocation must not succeed, unless the caller says that some
 * allocations are optional, such as those that only shrink a block. What a run prepares or inspects
 * with allocations that are not on trial stands between failing_pause() and failing_resume(). The
 * hook of base/mem.h is installed during runs only; `compare` allocates from the C library. */
#ifndef TESTS_FAILING_H
#define TESTS_FAILING_H

#include <stdbool.h>

/* What is run, and what is expected of it. */
typedef struct failing {
    int (*run)(void *context);      /* returns a status, or the status of an HTTP answer */
    bool (*compare)(void *context); /* after a refused run: is everything as before? may be NULL */
    void *context;
    int done;         /* the status of a run that succeeds */
    int refused;      /* the status of a run without memory */
    bool may_succeed; /* a run may succeed although an allocation failed */
    bool sticky;      /* all allocations after the N-th fail too */
    const char *what; /* begins the messages of failures; may be NULL */
} failing;

/* Runs with the N-th allocation failing, for N = 1, 2, 3 ..., until a run makes fewer than N
 * allocations; that run must succeed. Fails the test, naming N, if another run ends otherwise than
 * declared or `compare` returns false. Returns the last N, which is one more than the number of
 * allocations of the last run. */
long fails_as(const failing *f);

/* Calls fails_as() for a run that returns HE_OK or HE_NO_MEMORY. */
long fails_cleanly(int (*run)(void *context), bool (*compare)(void *context), void *context);

/* Installs an allocator that refuses the n-th request from now on; with n = 0 it only counts. */
void failing_begin(long n);
/* Restores the allocator of the C library. Returns the number of requests that were counted. */
long failing_end(void);
/* Requests between these two are neither counted nor refused. */
void failing_pause(void);
void failing_resume(void);

#endif
