/* job_table.h - work that outlives its request: runs it, knows how far it is, keeps how it ended.
 *
 * A request whose work is long, or whose client prefers it, is answered 202 at once; its work goes
 * to the table, which runs it on a thread of the pool and keeps what it would have answered:
 *
 *      api_detach ---- submit --> queued --> running --> done     a success
 *          |                        |          |     --> failed   a problem
 *       202 Location              remove     remove  --> cancelled
 *
 * A job runs on the pool it shares with requests that are merely long. What it would have answered
 * is kept for a while, within API_JOBS_KEPT jobs and API_JOBS_BYTES of answers: the ones that ended
 * first go first. The store keeps a note of it, so that a restart forgets no job: one that had not
 * ended has failed then, as interrupted. Everything else of it is freed before it shows its end,
 * and the end shows only when it is durable. An answer may be a file of many megabytes: it is
 * handed over and lent to readers, not copied.
 *
 * One lock, held for as long as it takes to copy an answer. Progress goes past it. It is taken by
 * threads that hold a mesh's lock, when progress has come far enough for listeners: so no mesh's
 * lock is taken under it, and no work freed. */
#ifndef HE_API_JOB_JOB_TABLE_H
#define HE_API_JOB_JOB_TABLE_H

#include "api/job/job.h"
#include "api/json/text.h"
#include "api/live.h"
#include "store/store.h"
#include "system/thread_pool.h"

typedef struct api_job_table api_job_table;

enum {
    API_JOBS_KEPT = 1000,             /* jobs, those that wait and run included */
    API_JOBS_BYTES = 64 << 20,        /* of answers */
    API_JOB_SECONDS = ST_JOB_SECONDS, /* how long one that has ended is kept */
    API_JOB_LISTENERS = 1000          /* clients that listen to jobs */
};

typedef struct api_job_table_options {
    st_store *store; /* tells what is durable */
    /* Runs the task on another thread, or later; false when too much waits already. */
    bool (*submit)(void *pool, const st_task *task);
    void *pool;
    double keep; /* seconds */
} api_job_table_options;

/* With the jobs that the store has kept. NULL when memory is out, or they cannot be read. */
api_job_table *api_job_table_new(const api_job_table_options *options);
/* Nothing may run, or wait in the pool or for the journal, any more. */
void api_job_table_free(api_job_table *table);
/* Cancels everything, and takes nothing more. */
void api_job_table_stop(api_job_table *table);

/* What the work would have answered, lent until it is freed; the table takes `body`. */
typedef struct api_job_outcome {
    int status;
    const char *location; /* "" for none */
    char *body;           /* from he_mem; NULL: none */
    size_t length;
    api_blob blob;                        /* in place of `body`; the table takes it */
    bool shown;                           /* as in api_job */
    const char *headers[API_JOB_HEADERS]; /* NULL where it has none */
    st_shown awaits;                      /* the end shows when that is durable */
    bool changed;                         /* the work changed something */
} api_job_outcome;

/* Called with the phase and how much of it is done, 0 to 1; false: the work is to end. */
typedef bool api_job_progress(void *context, const char *phase, double done);

/* Work as the table sees it: `run` is called once at most, by one thread, `free` always. The id is
 * the job's, and lives until `free`. */
typedef struct api_job_work {
    void *self;
    void (*run)(void *self, const char *id, api_job_progress *progress, void *context,
                api_job_outcome *out);
    void (*free)(void *self);
    double seconds;     /* about how long it takes */
    st_mesh *about;     /* whose listeners are told, held by the work; NULL: none */
    const char *holder; /* name of the token it is done for, "" for that of nobody */
    uint64_t most;      /* jobs of that holder that may wait or run with this one; 0: all */
    bool claims;        /* the work has claimed that mesh: store/write.h */
} api_job_work;

/* Takes `work` and fills in what is known of the job; or ST_TOO_MANY when too many wait,
 * ST_QUOTA when the holder has as many as it may, ST_BEHIND, ST_NO_MEMORY. `operation` is a
 * literal, `mesh` the id of the mesh the job is about or
 * "". */
st_status api_job_submit(api_job_table *table, const api_job_work *work, const char *operation,
                         const char *mesh, api_job *out);

/* A `viewer` is the token for which jobs are looked up: those that it does not own
 * (api_token_owns) are not there for it. */

/* Calls show with the job, under the lock. False when there is none of this id. */
bool api_job_find(api_job_table *table, const api_token *viewer, const char *id,
                  void (*show)(void *context, const api_job *job), void *context);
/* Lends the facts of the job of this id, with its answer, until api_job_return: NULL when there is
 * none. `*facts` is what is known of the job now. */
typedef struct api_job_entry api_job_loan;
api_job_loan *api_job_lend(api_job_table *table, const api_token *viewer, const char *id,
                           api_job *facts);
void api_job_return(api_job_loan *loan);
/* Calls show with up to `limit` jobs of numbers after `after`, in order. True when there are more.
 */
bool api_job_list(api_job_table *table, const api_token *viewer, uint64_t after, size_t limit,
                  void (*show)(void *context, const api_job *job), void *context);
/* A job that has not ended is told to end, and show is called; one that has ended is forgotten, and
 * `*forgotten` set. ST_ABSENT; where the store cannot forget it ST_BEHIND, ST_FULL, ST_FAILED,
 * ST_NO_MEMORY. */
st_status api_job_remove(api_job_table *table, const api_token *viewer, const char *id,
                         bool *forgotten, void (*show)(void *context, const api_job *job),
                         void *context);
/* The jobs that there are, and what happened since the start. */
typedef struct api_job_measures {
    size_t in_state[API_JOB_STATES];
    uint64_t ended[API_JOB_STATES]; /* zero for states that are no end */
    st_distribution waited, ran;    /* until they were begun, and then; microseconds */
    size_t bytes;                   /* of answers that are kept */
    size_t listeners, most_listeners;
} api_job_measures;

/* Takes the table's lock for as long as it takes to count the jobs. */
void api_job_measure(api_job_table *table, api_job_measures *out);
/* What becomes of a job, as events: whenever there is news, and `bye` after the last, or when the
 * server stops. ST_ABSENT, ST_LISTENERS, ST_NO_MEMORY. The caller frees the source. */
st_status api_job_follow(api_job_table *table, const api_token *viewer, const char *id,
                         api_source *out);

#endif
