#include "system/parallel.h"

#include "base/mem.h"
#include "system/thread_start.h"

#include <pthread.h>

/* A parallel loop, which runs in parts. The struct is on the stack of the thread that called
 * `run`. */
typedef struct work {
    he_part part;
    void *context;
    uint32_t parts, begun, running;
    bool stopped; /* true if no further parts may begin */
    /* index of the first part that failed; the number of parts if none failed */
    uint32_t failed;
    he_status status;
    he_error err;
    pthread_cond_t ended; /* signalled when no part of this loop is running */
    struct work *next;
} work;

struct st_parallel {
    he_parallel parallel;
    pthread_mutex_t lock;
    pthread_cond_t wake;
    bool ending;
    work *first; /* list of the loops that have parts which no thread has begun yet */
    size_t thread_count;
    pthread_t *threads;
};

/* The caller of each function below holds h->lock. The lock is released only while a part of a loop
 * runs. */

static bool has_parts(const work *w)
{
    return !w->stopped && w->begun < w->parts;
}

static void append(st_parallel *h, work *w)
{
    work **end = &h->first;
    while (*end != NULL) {
        end = &(*end)->next;
    }
    w->next = NULL;
    *end = w;
}

static void take_out(st_parallel *h, const work *w)
{
    for (work **at = &h->first; *at != NULL; at = &(*at)->next) {
        if (*at == w) {
            *at = w->next;
            return;
        }
    }
}

/* Runs the next part of the loop `w` while h->lock is released. If no other part of `w` is running
 * afterwards, the thread that owns `w` is woken and may free it, so the calling thread must not use
 * `w` any more. */
static void run_next(st_parallel *h, work *w)
{
    he_error err = {0};
    uint32_t i = w->begun++;
    w->running++;
    pthread_mutex_unlock(&h->lock);
    he_status status = w->part(w->context, i, &err);
    pthread_mutex_lock(&h->lock);
    if (status != HE_OK) {
        w->stopped = true;
        if (i < w->failed) {
            w->failed = i;
            w->status = status;
            w->err = err;
        }
    }
    if (--w->running == 0) {
        pthread_cond_signal(&w->ended);
    }
}

static void *help(void *context)
{
    st_parallel *h = context;
    st_thread_name_nicer("hedged-parts");
    pthread_mutex_lock(&h->lock);
    while (!h->ending) {
        work *w = h->first;
        if (w == NULL) {
            pthread_cond_wait(&h->wake, &h->lock);
            continue;
        }
        h->first = w->next;
        if (has_parts(w)) {
            append(h, w);
            run_next(h, w);
        }
    }
    pthread_mutex_unlock(&h->lock);
    return NULL;
}

/* The member `run` of he_parallel: runs the parts of a loop on this thread and on idle threads. */
static he_status run(void *self, uint32_t parts, he_part part, void *context, he_progress *progress,
                     he_error *err)
{
    st_parallel *h = self;
    work w = {.part = part, .context = context, .parts = parts, .failed = parts};
    he_status given_up = HE_OK;
    pthread_cond_init(&w.ended, NULL);
    pthread_mutex_lock(&h->lock);
    append(h, &w);
    pthread_cond_broadcast(&h->wake);
    while (has_parts(&w)) {
        uint32_t begun = w.begun;
        pthread_mutex_unlock(&h->lock);
        given_up = he_progress_step(progress, begun, parts, err);
        pthread_mutex_lock(&h->lock);
        if (given_up != HE_OK) {
            w.stopped = true;
        } else if (has_parts(&w)) {
            run_next(h, &w);
        }
    }
    take_out(h, &w);
    while (w.running > 0) {
        pthread_cond_wait(&w.ended, &h->lock);
    }
    pthread_mutex_unlock(&h->lock);
    pthread_cond_destroy(&w.ended);
    if (w.status != HE_OK && err != NULL) {
        *err = w.err;
    }
    return w.status != HE_OK ? w.status : given_up;
}

st_parallel *st_parallel_new(size_t threads)
{
    st_parallel *h = he_mem_zero(1, sizeof *h);
    if (h == NULL) {
        return NULL;
    }
    pthread_mutex_init(&h->lock, NULL);
    pthread_cond_init(&h->wake, NULL);
    h->parallel = (he_parallel){run, h, (uint32_t)threads + 1};
    h->threads = he_mem_zero(threads, sizeof *h->threads);
    bool started = h->threads != NULL;
    while (started && h->thread_count < threads) {
        started = pthread_create(&h->threads[h->thread_count], NULL, help, h) == 0;
        h->thread_count += started;
    }
    if (!started) {
        st_parallel_free(h);
        return NULL;
    }
    return h;
}

void st_parallel_free(st_parallel *h)
{
    if (h == NULL) {
        return;
    }
    pthread_mutex_lock(&h->lock);
    h->ending = true;
    pthread_cond_broadcast(&h->wake);
    pthread_mutex_unlock(&h->lock);
    for (size_t i = 0; i < h->thread_count; i++) {
        pthread_join(h->threads[i], NULL);
    }
    pthread_mutex_destroy(&h->lock);
    pthread_cond_destroy(&h->wake);
    he_mem_free(h->threads);
    he_mem_free(h);
}

const he_parallel *st_parallel_host(const st_parallel *h)
{
    return &h->parallel;
}
