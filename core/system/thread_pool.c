#include "system/thread_pool.h"

#include "base/mem.h"
#include "system/thread_start.h"

#include <pthread.h>
#include <string.h>

/* The number of stamps (virtual times) that are kept for flows. A flow is all tasks of one client
 * for one mesh (thread_pool.h). Flows whose hashes have equal low bits share a stamp and are
 * scheduled like one flow. */
enum { FLOWS = 256 };

enum { NAME = 16 /* most bytes of a thread's name with its NUL, a limit of prctl(2) */ };

typedef struct waiting {
    st_task task;
    double stamp;
    /* number of the task; tasks are numbered in the order in which they were submitted */
    uint64_t number;
} waiting;

/* The waiting tasks of one share (kind of tasks), as a binary heap. The parent of the task at index
 * i is at index (i - 1) / 2, and no task is to begin before its parent. */
typedef struct queue {
    waiting *heap;
    size_t count, room;
    size_t running, most_running;
    uint64_t refused;
} queue;

struct st_pool {
    pthread_mutex_t lock;
    pthread_cond_t wake;
    bool ending;
    size_t capacity; /* most tasks that each queue can hold */
    queue queues[ST_SHARES];
    /* how many tasks of the shares LONG and JOB may run at a time, counted together */
    size_t most_long;
    /* number of threads that wait for `wake`, or were woken and have not continued yet */
    size_t idle;
    double clock;         /* stamp (virtual end time) of the task that began last */
    double stamps[FLOWS]; /* for each flow, the stamp of its newest task */
    uint64_t submitted;
    char name[NAME];
    pthread_t *threads;
    size_t thread_count;
};

/* --- the queue of a share --- */

static bool is_before(const waiting *a, const waiting *b)
{
    return a->stamp != b->stamp ? a->stamp < b->stamp : a->number < b->number;
}

/* Makes sure that a queue has memory for one more task. Returns false if memory is out. */
static bool make_room(queue *q)
{
    if (q->count < q->room) {
        return true;
    }
    size_t room = q->room == 0 ? 16 : 2 * q->room;
    waiting *heap = he_mem_array(q->heap, room, sizeof *heap);
    if (heap != NULL) {
        q->heap = heap;
        q->room = room;
    }
    return heap != NULL;
}

/* Adds a task to a queue. make_room must have succeeded before. */
static void push(queue *q, const waiting *w)
{
    size_t at = q->count++;
    while (at > 0 && is_before(w, &q->heap[(at - 1) / 2])) {
        q->heap[at] = q->heap[(at - 1) / 2];
        at = (at - 1) / 2;
    }
    q->heap[at] = *w;
}

static waiting pop(queue *q)
{
    waiting top = q->heap[0];
    const waiting last = q->heap[--q->count];
    size_t at = 0, child = 1;
    while (child < q->count) {
        if (child + 1 < q->count && is_before(&q->heap[child + 1], &q->heap[child])) {
            child++;
        }
        if (!is_before(&q->heap[child], &last)) {
            break;
        }
        q->heap[at] = q->heap[child];
        at = child;
        child = 2 * at + 1;
    }
    q->heap[at] = last;
    return top;
}

/* --- the pool; the caller holds its lock --- */

static bool may_begin(const st_pool *pool, st_share share)
{
    const queue *q = &pool->queues[share];
    size_t long_running = pool->queues[ST_SHARE_LONG].running + pool->queues[ST_SHARE_JOB].running;
    return q->count > 0 && q->running < q->most_running &&
           (share == ST_SHARE_BRIEF || long_running < pool->most_long);
}

/* Returns the share (kind of tasks) whose first task is to begin next; ST_SHARES if no task may
 * begin now. */
static st_share next_share(const st_pool *pool)
{
    st_share next = ST_SHARES;
    for (st_share share = 0; share < ST_SHARES; share++) {
        if (may_begin(pool, share) &&
            (next == ST_SHARES ||
             is_before(&pool->queues[share].heap[0], &pool->queues[next].heap[0]))) {
            next = share;
        }
    }
    return next;
}

static bool is_empty(const st_pool *pool)
{
    size_t count = 0;
    for (st_share share = 0; share < ST_SHARES; share++) {
        count += pool->queues[share].count;
    }
    return count == 0;
}

/* Unlocks the pool. Wakes a thread only if there is a task that may begin now, because waking a
 * thread in vain costs more time than a short task. The signal is sent after the lock is released,
 * because the woken thread needs the lock at once. A thread that has finished a task looks for the
 * next one without a signal. */
static void unlock(st_pool *pool)
{
    const bool wakes = pool->idle > 0 && next_share(pool) != ST_SHARES;
    pthread_mutex_unlock(&pool->lock);
    if (wakes) {
        pthread_cond_signal(&pool->wake);
    }
}

static void run_next(st_pool *pool, st_share share)
{
    queue *q = &pool->queues[share];
    const waiting next = pop(q);
    pool->clock = next.stamp > pool->clock ? next.stamp : pool->clock;
    q->running++;
    unlock(pool); /* another thread is woken if another waiting task may begin now */
    next.task.work(next.task.context);
    pthread_mutex_lock(&pool->lock);
    q->running--;
}

static void *run(void *context)
{
    st_pool *pool = context;
    st_thread_name_nicer(pool->name);
    pthread_mutex_lock(&pool->lock);
    while (!pool->ending || !is_empty(pool)) {
        st_share share = next_share(pool);
        if (share == ST_SHARES) {
            pool->idle++;
            pthread_cond_wait(&pool->wake, &pool->lock);
            pool->idle--;
        } else {
            run_next(pool, share);
        }
    }
    /* The pool is closing, so no task is added any more. All waiting threads are woken so that they
     * end. */
    pthread_cond_broadcast(&pool->wake);
    pthread_mutex_unlock(&pool->lock);
    return NULL;
}

static size_t all_but(size_t threads, size_t kept)
{
    return threads > kept + 1 ? threads - kept : 1;
}

st_pool *st_pool_new(const char *name, size_t threads, size_t most_waiting)
{
    st_pool *pool = he_mem_zero(1, sizeof *pool);
    if (pool == NULL) {
        return NULL;
    }
    pthread_mutex_init(&pool->lock, NULL);
    pthread_cond_init(&pool->wake, NULL);
    memcpy(pool->name, name, strnlen(name, NAME - 1));
    pool->capacity = most_waiting;
    pool->most_long = all_but(threads, 1);
    pool->queues[ST_SHARE_BRIEF].most_running = threads;
    pool->queues[ST_SHARE_LONG].most_running = all_but(threads, 2);
    pool->queues[ST_SHARE_JOB].most_running = all_but(threads, 2);
    pool->threads = he_mem_zero(threads, sizeof *pool->threads);
    bool started = pool->threads != NULL;
    for (st_share share = 0; share < ST_SHARES; share++) {
        started = make_room(&pool->queues[share]) && started;
    }
    while (started && pool->thread_count < threads) {
        started = pthread_create(&pool->threads[pool->thread_count], NULL, run, pool) == 0;
        pool->thread_count += started;
    }
    if (!started) {
        st_pool_free(pool);
        return NULL;
    }
    return pool;
}

void st_pool_free(st_pool *pool)
{
    if (pool == NULL) {
        return;
    }
    pthread_mutex_lock(&pool->lock);
    pool->ending = true;
    pthread_cond_broadcast(&pool->wake);
    pthread_mutex_unlock(&pool->lock);
    for (size_t i = 0; i < pool->thread_count; i++) {
        pthread_join(pool->threads[i], NULL);
    }
    pthread_mutex_destroy(&pool->lock);
    pthread_cond_destroy(&pool->wake);
    for (st_share share = 0; share < ST_SHARES; share++) {
        he_mem_free(pool->queues[share].heap);
    }
    he_mem_free(pool->threads);
    he_mem_free(pool);
}

bool st_pool_submit(st_pool *pool, const st_task *task)
{
    pthread_mutex_lock(&pool->lock);
    queue *q = &pool->queues[task->share];
    bool accepted = q->count < pool->capacity && !pool->ending && make_room(q);
    if (accepted) {
        double *last = &pool->stamps[task->flow % FLOWS];
        double begin = *last > pool->clock ? *last : pool->clock;
        *last = begin + task->cost;
        push(q, &(waiting){.task = *task, .stamp = *last, .number = pool->submitted++});
    }
    q->refused += !accepted;
    unlock(pool);
    return accepted;
}

void st_pool_look(st_pool *pool, st_share share, st_pool_state *out)
{
    pthread_mutex_lock(&pool->lock);
    const queue *q = &pool->queues[share];
    *out = (st_pool_state){.waiting = q->count,
                           .most_waiting = pool->capacity,
                           .running = q->running,
                           .refused = q->refused};
    pthread_mutex_unlock(&pool->lock);
}

/* Adds a text and its NUL to a hash (FNV-1a, 64 bits). Without the NUL, the pairs of texts "a",
 * "bc" and "ab", "c" would have equal hashes. */
static uint64_t add_text(uint64_t hash, const char *text)
{
    do {
        hash = (hash ^ (unsigned char)*text) * UINT64_C(0x100000001b3);
    } while (*text++ != '\0');
    return hash;
}

uint64_t st_pool_flow(const char *client, const char *mesh)
{
    return add_text(add_text(UINT64_C(0xcbf29ce484222325), client), mesh);
}
