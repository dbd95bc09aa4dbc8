#include "server/jobs.h"

#include "mesh/mem.h"

#include <pthread.h>

typedef struct job {
    void (*work)(void *context);
    void *context;
} job;

struct srv_jobs {
    pthread_mutex_t lock;
    pthread_cond_t wake;
    bool ending;
    job *ring;
    size_t capacity, first, count;
    pthread_t *threads;
    size_t thread_count;
};

static void *run(void *context)
{
    srv_jobs *jobs = context;
    pthread_mutex_lock(&jobs->lock);
    for (;;) {
        while (jobs->count == 0 && !jobs->ending) {
            pthread_cond_wait(&jobs->wake, &jobs->lock);
        }
        if (jobs->count == 0) {
            break;
        }
        job next = jobs->ring[jobs->first];
        jobs->first = (jobs->first + 1) % jobs->capacity;
        jobs->count--;
        pthread_mutex_unlock(&jobs->lock);
        next.work(next.context);
        pthread_mutex_lock(&jobs->lock);
    }
    pthread_mutex_unlock(&jobs->lock);
    return NULL;
}

srv_jobs *srv_jobs_new(size_t threads, size_t queue)
{
    srv_jobs *jobs = he_mem_zero(1, sizeof *jobs);
    if (jobs == NULL) {
        return NULL;
    }
    pthread_mutex_init(&jobs->lock, NULL);
    pthread_cond_init(&jobs->wake, NULL);
    jobs->capacity = queue;
    jobs->ring = he_mem_zero(queue, sizeof *jobs->ring);
    jobs->threads = he_mem_zero(threads, sizeof *jobs->threads);
    if (jobs->ring == NULL || jobs->threads == NULL) {
        srv_jobs_free(jobs);
        return NULL;
    }
    for (size_t i = 0; i < threads; i++) {
        if (pthread_create(&jobs->threads[i], NULL, run, jobs) != 0) {
            srv_jobs_free(jobs);
            return NULL;
        }
        jobs->thread_count++;
    }
    return jobs;
}

void srv_jobs_free(srv_jobs *jobs)
{
    if (jobs == NULL) {
        return;
    }
    pthread_mutex_lock(&jobs->lock);
    jobs->ending = true;
    pthread_cond_broadcast(&jobs->wake);
    pthread_mutex_unlock(&jobs->lock);
    for (size_t i = 0; i < jobs->thread_count; i++) {
        pthread_join(jobs->threads[i], NULL);
    }
    pthread_mutex_destroy(&jobs->lock);
    pthread_cond_destroy(&jobs->wake);
    he_mem_free(jobs->ring);
    he_mem_free(jobs->threads);
    he_mem_free(jobs);
}

bool srv_jobs_submit(srv_jobs *jobs, void (*work)(void *context), void *context)
{
    pthread_mutex_lock(&jobs->lock);
    bool accepted = jobs->count < jobs->capacity && !jobs->ending;
    if (accepted) {
        jobs->ring[(jobs->first + jobs->count) % jobs->capacity] = (job){work, context};
        jobs->count++;
        pthread_cond_signal(&jobs->wake);
    }
    pthread_mutex_unlock(&jobs->lock);
    return accepted;
}
