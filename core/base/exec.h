/* exec.h - one job on several threads.
 *
 * core starts no threads. A host that has some lends them with its watch (watch.h, `exec`): core
 * cuts a job into parts that do not write what another reads, and hands them over. Without a watch,
 * or a host, the parts run one after another on the caller's thread.
 *
 *     he_run_ranges   0 |--0--|--1--|--2--|--3--|-4-| count   each part by whom it finds
 *     he_run_lanes    0 |0 0 0 0 0 0|1 1 1 1 1 1 1 1| count   a lane's stretches in their order
 *
 * What comes out must not depend on the number of threads: ranges are cut by the count alone, and
 * lanes are for work that is the same in whatever number of them it is done (counting, filing). Of
 * parts that fail, the first one's error is the job's; parts that were not begun are left out.
 *
 * Cancelling is the caller's: its thread tells the watch between parts, none of which takes long.
 */
#ifndef HE_BASE_EXEC_H
#define HE_BASE_EXEC_H

#include "base/watch.h"

typedef he_status (*he_part)(void *context, uint32_t part, he_error *err);

/* What a host fills in. `run` calls part(context, i, ...) for each i below `parts`, beginning them
 * in their order, at most `threads` at once of which the caller is one, and steps `watch` (which
 * may be NULL) on the caller's thread. It returns when all parts that were begun have ended: HE_OK,
 * or the error of the first that failed, or HE_CANCELLED. It never waits for a thread that does
 * something else. */
typedef struct he_exec {
    he_status (*run)(void *self, uint32_t parts, he_part part, void *context, he_watch *watch,
                     he_error *err);
    void *self;
    uint32_t threads;
} he_exec;

enum {
    HE_PART_ROWS =
        16384, /* of a range: far longer than handing it over takes, far below a second */
    HE_MOST_LANES = 8
};

/* `from` to `to` of the job's rows; `which` is the number of the range, or of the lane. */
typedef he_status (*he_range)(void *context, uint32_t which, size_t from, size_t to, he_error *err);

/* How many ranges `count` rows are. */
size_t he_ranges(size_t count);
/* Each range once, in any order. HE_CANCELLED, and what `work` fails with. */
HE_NODISCARD he_status he_run_ranges(he_watch *watch, size_t count, he_range work, void *context,
                                     he_error *err);
/* How many lanes are worth it. */
uint32_t he_lanes(const he_watch *watch, size_t count);
/* Lane i goes through its part of the rows in order, a stretch at a time. */
HE_NODISCARD he_status he_run_lanes(he_watch *watch, uint32_t lanes, size_t count, he_range work,
                                    void *context, he_error *err);

#endif
