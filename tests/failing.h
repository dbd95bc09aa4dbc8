/* failing.h - allocations that fail on purpose, one after the other.
 *
 * A function that allocates memory must fail cleanly whichever allocation fails: it returns an
 * error and has changed nothing. This loop checks it for each allocation of a call:
 *
 *     failing f = {0};
 *     while (failing_next(&f)) {
 *         he_status status = he_edge_split(mesh, e, NULL);
 *         if (!failing_status(&f, status)) {
 *             assert_true(he_mesh_equal(mesh, before));
 *         }
 *     }
 *
 * In the N-th iteration, called a run, the N-th allocation fails. The loop ends after the first run
 * that makes fewer than N allocations, that run must succeed, and every earlier run must fail.
 * Allocations fail only between failing_next() and failing_status() or failing_end(), in the
 * threads that `threads` selects. */
#ifndef TESTS_FAILING_H
#define TESTS_FAILING_H

#include "base/status.h"

#include <stdbool.h>

/* The threads whose allocations are counted and may fail; those of other threads always succeed. */
typedef enum failing_threads {
    FAILING_ALL_THREADS,
    FAILING_THIS_THREAD, /* the thread that calls failing_next() */
    FAILING_OTHER_THREADS
} failing_threads;

/* The state of the loop. The test sets it to {0}, or to zeros with some options; it may change
 * options between two iterations. */
typedef struct failing {
    long n; /* number of the allocation that fails */
    /* option: a run may succeed although an allocation failed, because some allocations are
     * optional */
    bool may_succeed;
    bool lasts;  /* option: the n-th and all later allocations of a run fail */
    long sparse; /* option: if not 0, each iteration raises n by 1 + n / sparse instead of 1 */
    failing_threads threads; /* option */
    /* Option: name of the tested call, which messages about failures show. */
    const char *what;
    bool is_over; /* whether the last run made fewer than n allocations, which ends the loop */
} failing;

/* Raises n and begins a run whose n-th allocation will fail. Returns false if the loop is over. */
bool failing_next(failing *f);
/* Ends a run and returns `succeeded`, which tells whether the tested call succeeded. Fails the
 * test, naming n, if the run succeeded although its n-th allocation failed, or failed although no
 * allocation did. */
bool failing_end(failing *f, bool succeeded);
/* Ends a run that returned HE_OK or HE_NO_MEMORY; another status fails the test. Returns true if
 * the status is HE_OK. */
bool failing_status(failing *f, he_status status);

/* Makes the n-th allocation from now on fail, in any thread; with n = 0, allocations are only
 * counted. The first call replaces the allocator, and failing_off() restores it, so no other thread
 * may allocate during these two calls. Later calls only change n. */
void failing_at(long n);
/* Returns the number of allocations since failing_at(). */
long failing_count(void);
/* Returns the number of blocks that were allocated since failing_at() replaced the allocator and
 * that are not freed yet. */
long failing_blocks(void);
/* Restores the allocator of the C library. */
void failing_off(void);
/* Allocations between failing_pause() and failing_resume() are not counted and do not fail. Pauses
 * may be nested. */
void failing_pause(void);
void failing_resume(void);

#endif
