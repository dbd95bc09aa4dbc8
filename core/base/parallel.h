/* parallel.h - parallel loops: one job on several threads.
 *
 * The kernel starts no threads. A host that has some lends them with its he_progress (progress.h,
 * `parallel`): the kernel cuts a job into parts, none of which writes what another reads, and hands
 * them to the host. Without an he_progress, or if that lends no threads, the parts run one after
 * another on the caller's thread.
 *
 * A job is a loop over the indices of `count` entries (rows) of arrays. It is cut into ranges of
 * HE_PART_ROWS rows, or into lanes: at most HE_MOST_LANES long parts of equal length, each of which
 * is done block by block in order.
 *
 *     he_run_ranges   0 |--0--|--1--|--2--|--3--|-4-| count   any thread takes the next range
 *     he_run_lanes    0 |0 0 0 0 0 0|1 1 1 1 1 1 1 1| count   a lane does its blocks in order
 *
 * The result must not depend on the number of threads: how ranges are cut depends on `count` alone,
 * and lanes are only for work whose result is equal for any number of lanes, such as counting. If
 * several parts fail, the job returns the error of the first of them in order; parts that were not
 * begun are skipped. A part may run although an earlier part fails, so each part must be safe
 * whatever the others find.
 *
 * Only the caller's thread checks for cancellation: it reports progress between parts, so each part
 * must be short. */
#ifndef HE_BASE_PARALLEL_H
#define HE_BASE_PARALLEL_H

#include "base/progress.h"

typedef he_status (*he_part)(void *context, uint32_t part, he_error *err);

/* The functions a host provides. `run` calls part(context, i, ...) for each i below `parts`. It
 * begins the parts in order, on at most `threads` threads at once including the caller's, and
 * reports to `progress` (which may be NULL) on the caller's thread. It returns once every part that
 * was begun has ended: HE_OK, or the error of the first part that failed, or HE_CANCELLED. `run`
 * never waits for a thread that is busy with another job. */
typedef struct he_parallel {
    he_status (*run)(void *self, uint32_t parts, he_part part, void *context, he_progress *progress,
                     he_error *err);
    void *self;
    uint32_t threads;
} he_parallel;

enum {
    /* number of rows of a range: so many that the work on them takes far longer than handing them
     * to a thread, and so few that the work takes far less than a second */
    HE_PART_ROWS = 16384,
    HE_MOST_LANES = 8
};

/* The work of one range, or of one block of a lane: rows `from` to `to` - 1 of the job; `which` is
 * the number of the range or lane. */
typedef he_status (*he_range)(void *context, uint32_t which, size_t from, size_t to, he_error *err);

/* Returns into how many ranges he_run_ranges cuts `count` rows. */
size_t he_ranges(size_t count);
/* Calls `work` once for each range, in any order.
 * Returns HE_CANCELLED if the work was cancelled.
 * Returns the error of `work` if it fails. */
HE_NODISCARD he_status he_run_ranges(he_progress *progress, size_t count, he_range work,
                                     void *context, he_error *err);
/* Returns how many lanes are worth starting for `count` rows. */
uint32_t he_lanes(const he_progress *progress, size_t count);
/* Calls `work` for each block of each lane. The blocks of one lane are done in order. */
HE_NODISCARD he_status he_run_lanes(he_progress *progress, uint32_t lanes, size_t count,
                                    he_range work, void *context, he_error *err);

#endif
