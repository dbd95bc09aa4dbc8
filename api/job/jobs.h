/* jobs.h - what api needs from above for work that outlives its request: a board of jobs.
 *
 * A request whose work is long, or whose client prefers it, is answered 202 at once; its exchange
 * goes to the board, which runs it on a thread of its own and keeps what it would have answered:
 *
 *      api_end or api_work gives API_JOB
 *          |
 *      api_detach ---- submit --> queued --> running --> done     a success
 *          |                        |          |     --> failed   a problem
 *       202 Location              remove     remove  --> cancelled
 *
 * The board works on an exchange as a server does: api_watch, api_work, api_answer_of, api_free, by
 * one thread at a time. A job shows its end only when that is durable. The server fills this struct
 * in (server/job/job_board.c). */
#ifndef HE_API_JOB_JOBS_H
#define HE_API_JOB_JOBS_H

#include "api/json/text.h"
#include "api/live.h"
#include "api/store.h"

struct api_exchange; /* api.h */

typedef enum api_job_state {
    API_JOB_QUEUED,
    API_JOB_RUNNING,
    API_JOB_DONE,
    API_JOB_FAILED,
    API_JOB_CANCELLED
} api_job_state;

enum { API_JOB_LOCATION = sizeof "/v1/meshes/" + API_MESH_ID };

/* What is known of a job. */
typedef struct api_job {
    char id[API_JOB_ID + 1]; /* unguessable: who knows it may look and cancel */
    uint64_t number;         /* in the order of submission, from 1 */
    api_job_state state;
    const char *operation;             /* name of the route's row */
    const char *phase;                 /* of the work, "" before it runs */
    double progress;                   /* 0 to 1, never falls */
    char mesh[API_MESH_ID + 1];        /* "" while it has no id */
    double created, started, finished; /* seconds since 1970 UTC; 0: not yet */
    int status;                        /* HTTP, of the answer; 0: there is none */
    char location[API_JOB_LOCATION];   /* likewise; "" where it has none */
    const char *body;                  /* JSON, lent for the call; NULL: none, or not kept */
    size_t length;
} api_job;

typedef struct api_jobs {
    void *self;
    /* Takes `work` and fills in what is known of the job; or API_STORE_TOO_MANY when too many wait,
     * API_STORE_NO_MEMORY. */
    api_store_status (*submit)(void *self, struct api_exchange *work, const char *operation,
                               const char *mesh, api_job *out);
    /* Calls show with the job. False when there is none of this id. */
    bool (*find)(void *self, const char *id, void (*show)(void *context, const api_job *job),
                 void *context);
    /* The same with up to `limit` jobs of numbers after `after`, in order. True when there are
     * more. */
    bool (*list)(void *self, uint64_t after, size_t limit,
                 void (*show)(void *context, const api_job *job), void *context);
    /* A job that has not ended is told to end, and show is called; one that has is forgotten, and
     * `*forgotten` set. False when there is none of this id. */
    bool (*remove)(void *self, const char *id, bool *forgotten,
                   void (*show)(void *context, const api_job *job), void *context);
    /* What becomes of a job, in messages that `write` appends: whenever there is news, and `bye`
     * after the last, or when the server stops. API_STORE_ABSENT, API_STORE_LISTENERS,
     * API_STORE_NO_MEMORY. The caller frees the source. */
    api_store_status (*follow)(void *self, const char *id,
                               void (*write)(const api_job *job, bool bye, api_text *text),
                               api_source *out);
} api_jobs;

#endif
