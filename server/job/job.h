/* job.h - one job of a board: what job_board.c and job_events.c share. */
#ifndef HE_SERVER_JOB_JOB_H
#define HE_SERVER_JOB_JOB_H

#include "server/job/job_board.h"
#include "server/store/held.h"

#include <pthread.h>
#include <stdatomic.h>

typedef struct srv_job_listener srv_job_listener;

/* In the list of its board, whose lock is for all but the atomics, and `work` while it runs. */
typedef struct srv_job {
    srv_board *board;
    api_job facts;      /* but for phase and progress until it has ended */
    char *body;         /* facts.body, owned */
    api_exchange *work; /* NULL when it has ended */
    api_mesh *about;    /* the mesh whose followers are told, with a use; NULL: none, or it ended */
    srv_hold hold;      /* from the end of the work until that is durable */
    uint32_t uses;      /* by the list, by the pool, by listeners */
    bool listed;
    struct srv_job *next, *previous; /* in the order of numbers */
    srv_job_listener *waiting;       /* to be woken when something is new */

    _Atomic bool stop;
    _Atomic(const char *) phase;
    _Atomic double progress;
    _Atomic bool awaited; /* somebody waits for more than `shown` */
    _Atomic double shown;
} srv_job;

struct srv_board {
    srv_board_options options;
    pthread_mutex_t lock;
    srv_job *first, *last;
    size_t count;
    size_t bytes; /* of bodies */
    uint64_t submitted;
    size_t listeners;
    bool stopped;
};

/* All under the board's lock. */
static inline bool srv_job_has_ended(const srv_job *job)
{
    return job->facts.state >= API_JOB_DONE;
}
srv_job *srv_job_find(const srv_board *board, const char *id); /* NULL: none */
/* The facts as they are now. */
const api_job *srv_job_facts(srv_job *job);
void srv_job_release(srv_job *job);

/* job_events.c */
void srv_job_wake(srv_job *job);
/* The member of api_jobs. */
api_store_status srv_job_follow(void *self, const char *id,
                                void (*write)(const api_job *job, bool bye, api_text *text),
                                api_source *out);

#endif
