/* failing.h - allocations that fail on purpose, one after the other.
 *
 * What allocates memory must fail cleanly wherever an allocation fails: it is refused, and nothing
 * has changed. This loop proves it for each allocation of a run:
 *
 *     failing f = {0};
 *     while (failing_next(&f)) {
 *         he_status status = he_edge_split(mesh, e, NULL);
 *         if (!failing_status(&f, status)) {
 *             assert_true(he_mesh_equal(mesh, before));
 *         }
 *     }
 *
 * In its N-th turn the N-th allocation fails. It ends after the first run that makes fewer than N
 * allocations, which must succeed; every earlier run must not. The allocator fails only between
 * failing_next() and failing_status() or failing_end(); it may be called by several threads. */
#ifndef TESTS_FAILING_H
#define TESTS_FAILING_H

#include "base/status.h"

#include <stdbool.h>

/* Whose allocations count and may fail; those of other threads always succeed. */
typedef enum failing_threads {
    FAILING_ALL_THREADS,
    FAILING_THIS_THREAD, /* the thread that calls failing_next() */
    FAILING_OTHER_THREADS
} failing_threads;

/* The state of the loop. It begins as {0}, or with some of its options, which may be changed
 * between two turns. */
typedef struct failing {
    long n;           /* the allocation that fails; after the loop, one that was not made */
    bool may_succeed; /* option: some allocations are optional, and a run succeeds without them */
    bool lasts;       /* option: all allocations after the n-th fail too */
    long sparse;      /* option: if not 0, n grows by n / sparse more than 1 in each turn */
    failing_threads threads; /* option */
    const char *what;        /* option: what was run, for the messages of failures */
    bool is_over;            /* the last run made fewer than n allocations */
} failing;

/* Raises n and begins a run whose n-th allocation will fail. Returns false if the loop is over. */
bool failing_next(failing *f);
/* Ends a run, and returns `succeeded`. Fails the test, naming n, if the run succeeded although its
 * allocation failed, or failed although it did not. */
bool failing_end(failing *f, bool succeeded);
/* Ends a run that returned HE_OK or HE_NO_MEMORY; another status fails the test. Returns true if
 * the status is HE_OK. */
bool failing_status(failing *f, he_status status);

/* Makes the n-th allocation from now on fail, in whatever thread it is made; with n = 0 allocations
 * are only counted. The first call and failing_off() exchange the allocator, so no other thread may
 * allocate meanwhile; later calls only choose another n. */
void failing_at(long n);
/* Returns the number of allocations since failing_at(). */
long failing_count(void);
/* Returns the number of blocks allocated since the allocator was exchanged, less those freed. */
long failing_blocks(void);
/* Restores the allocator of the C library. */
void failing_off(void);
/* Allocations between these two are neither counted nor refused. Pauses may be nested. */
void failing_pause(void);
void failing_resume(void);

#endif
