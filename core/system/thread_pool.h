/* thread_pool.h - a few threads that may block, and bounded queues before them.
 *
 * What takes longer than a worker may be kept from its other connections runs here. Work comes in
 * three shares, so that none of them can keep the threads from another:
 *
 *     BRIEF   a client waits for it, and not for long: an import, an edit, a piece of an answer
 *     LONG    a client waits for what may take long: a check, a query, an export
 *     JOB     no client waits: it was answered 202
 *
 * LONG and JOB together have all threads but one, and either alone has all but two, as far as there
 * are so many. So an import finds a thread whatever else is asked. Each share has a queue of its
 * own, and a full one refuses: the caller answers 503 rather than let work pile up.
 *
 * WHO IS NEXT. Work is ordered by self-clocked fair queueing (Golestani, "A self-clocked fair
 * queueing scheme for broadband applications", 1994). A flow is a client with a mesh. A task is
 * stamped with the time at which it would end if the flows took turns: its cost after the flow's
 * last stamp, or after that of the task that was begun last, whichever is later. The smallest stamp
 * is next. So short work goes before long work, a flow that asks for much waits behind those that
 * ask for little, and no task is passed over for ever. */
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
    uint64_t flow; /* st_pool_flow */
} st_task;

/* `most_waiting` tasks of each share may wait. `name`, of at most 15 characters, is what the system
 * shows for the threads. Returns NULL when memory or threads are out. */
st_pool *st_pool_new(const char *name, size_t threads, size_t most_waiting);
/* Runs what is queued, then ends. Accepts NULL. */
void st_pool_free(st_pool *pool);
/* Runs task->work(task->context) on some thread. Tasks of one flow and share begin in the order of
 * their submission. Returns false when the share's queue is full, or memory is out. */
bool st_pool_submit(st_pool *pool, const st_task *task);
/* How a share is at the moment. */
typedef struct st_pool_state {
    size_t waiting, most_waiting;
    size_t running;
    uint64_t refused; /* tasks, since the start */
} st_pool_state;

/* Takes the pool's lock for a moment. */
void st_pool_look(st_pool *pool, st_share share, st_pool_state *out);
/* The flow of what this client asks of this mesh; "" for either where there is none. */
uint64_t st_pool_flow(const char *client, const char *mesh);

#endif
