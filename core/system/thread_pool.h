/* thread_pool.h - a pool of a few threads that may block, with bounded queues of tasks.
 *
 * The pool runs tasks that would keep a worker, the thread of many connections, from the other
 * connections for too long. Each task belongs to one of three shares, so that no kind of task can
 * occupy all threads:
 *
 *     BRIEF   a client waits for it, but not for long: an import, an edit, a piece of an answer
 *     LONG    a client waits for work that may take long: a check, a query, an export
 *     JOB     no client waits: the request was answered 202
 *
 * Tasks of LONG and JOB together may use all threads but one; tasks of LONG alone, or of JOB alone,
 * all threads but two, if the pool has that many. So an import finds a thread whatever else runs.
 * Each share has a queue of its own, and a full queue refuses tasks: the caller then answers 503
 * rather than let tasks pile up.
 *
 * ORDER. Tasks are ordered by self-clocked fair queueing (Golestani, "A self-clocked fair queueing
 * scheme for broadband applications", 1994). The tasks of one client for one mesh are a flow. A
 * task is stamped with the time at which it would end if the flows took turns: its cost added to
 * the last stamp of the flow, or to the stamp of the task that was begun last, whichever is later.
 * The task with the smallest stamp is next. So short tasks go before long ones, a flow with much
 * work waits behind flows with little, and no task waits for ever. */
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
    /* about how many seconds the task will take; only the ratios of the costs of tasks matter */
    double cost;
    uint64_t flow; /* number of the flow (client and mesh) of the task, see st_pool_flow */
} st_task;

/* Makes a pool. At most `most_waiting` tasks of each share may wait. `name`, of at most 15
 * characters, becomes the name of the threads. Returns NULL if memory or threads are out. */
st_pool *st_pool_new(const char *name, size_t threads, size_t most_waiting);
/* Runs all tasks that are queued, then ends the threads and frees the pool, which may be NULL. */
void st_pool_free(st_pool *pool);
/* Runs task->work(task->context) on one of the threads. Tasks of one flow and share begin in the
 * order of their submission. Returns false if the share's queue is full, or memory is out. */
bool st_pool_submit(st_pool *pool, const st_task *task);
/* The present state of a share (one of the three kinds of tasks). */
typedef struct st_pool_state {
    size_t waiting, most_waiting;
    size_t running;
    uint64_t refused; /* number of tasks refused since the pool was made */
} st_pool_state;

/* Gets the present state of a share. Takes the pool's lock for a moment. */
void st_pool_look(st_pool *pool, st_share share, st_pool_state *out);
/* Returns the number of the flow to which a client's tasks for a mesh belong; client and mesh may
 * be "". */
uint64_t st_pool_flow(const char *client, const char *mesh);

#endif
