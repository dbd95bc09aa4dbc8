/* thread_pool.h - a few threads that may block, with bounded queues.
 *
 * Tasks run here that would keep a worker from its other connections for too long. They are of
 * three shares, so that none of these can occupy all threads:
 *
 *     BRIEF   a client waits for it, but not for long: an import, an edit, a piece of an answer
 *     LONG    a client waits for work that may take long: a check, a query, an export
 *     JOB     no client waits: the request was answered 202
 *
 * LONG and JOB together may use all threads but one, and either alone all but two, if there are
 * that many. So an import finds a thread whatever else runs. Each share has a queue of its own, and
 * a full one refuses: the caller answers 503 rather than let work pile up.
 *
 * ORDER. Tasks are ordered by self-clocked fair queueing (Golestani, "A self-clocked fair queueing
 * scheme for broadband applications", 1994). A flow is a client with a mesh. A task is stamped with
 * the time at which it would end if the flows took turns: its cost added to the flow's last stamp,
 * or to that of the task begun last, whichever is later. The smallest stamp is next. So short tasks
 * go before long ones, a flow with much work waits behind flows with little, and no task waits for
 * ever. */
#ifndef HE_SYSTEM_THREAD_POOL_H
#define HE_SYSTEM_THREAD_POOL_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct st_pool st_pool;

typedef enum st_share { ST_SHARE_BRIEF, ST_SHARE_LONG, ST_SHARE_JOB, ST_SHARES } st_share;

typedef struct st_task {
    void (*work)(void *context);
    void *context;
    st_share share;
    double cost;   /* about how many seconds it takes; only the ratio to other tasks counts */
    uint64_t flow; /* see st_pool_flow */
} st_task;

/* Makes a pool. `most_waiting` tasks of each share may wait. `name`, of at most 15 characters, is
 * what the system shows for the threads. Returns NULL if memory or threads are out. */
st_pool *st_pool_new(const char *name, size_t threads, size_t most_waiting);
/* Runs all tasks that are queued, then ends the threads and frees the pool, which may be NULL. */
void st_pool_free(st_pool *pool);
/* Runs task->work(task->context) on one of the threads. Tasks of one flow and share begin in the
 * order of their submission. Returns false if the share's queue is full, or memory is out. */
bool st_pool_submit(st_pool *pool, const st_task *task);
/* The present state of a share. */
typedef struct st_pool_state {
    size_t waiting, most_waiting;
    size_t running;
    uint64_t refused; /* tasks refused since the start */
} st_pool_state;

/* Gets the present state of a share. Takes the pool's lock for a moment. */
void st_pool_look(st_pool *pool, st_share share, st_pool_state *out);
/* Returns the flow to which a client's requests for a mesh belong; client and mesh may be "". */
uint64_t st_pool_flow(const char *client, const char *mesh);

#endif
