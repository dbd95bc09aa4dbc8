/* job_table.h - jobs: work that outlives its request. The table runs them, tracks their progress
 * and keeps their answers.
 *
 * A request whose work is long, or whose client prefers it, is answered 202 at once. Its work goes
 * to the table, which runs it on a thread of the pool and keeps the answer:
 *
 *      api_detach ---- submit --> queued --> running --> done     a success
 *          |                        |          |     --> failed   a problem
 *       202 Location              remove     remove  --> cancelled
 *
 * Jobs share the pool with requests that are merely long. Answers are kept for a while, up to
 * API_JOBS_KEPT jobs and API_JOBS_BYTES of answers; the jobs that ended first are dropped first.
 * The store keeps a record of each job, so that no job is lost by a restart; a job that had not
 * ended is then failed, as interrupted. A job frees all its other resources before clients can see
 * its end, and they see it only when it is durable. An answer may be a file of many megabytes: it
 * is moved into the table and lent to readers, not copied.
 *
 * The table has one lock, held for at most as long as it takes to copy an answer. Progress is
 * reported without it, except when listeners have to be woken. Then a thread takes it while holding
 * a mesh's lock: so code that holds it takes no mesh's lock and frees no work. */
#ifndef HE_API_JOB_JOB_TABLE_H
#define HE_API_JOB_JOB_TABLE_H

#include "api/job/job.h"
#include "api/json/text.h"
#include "api/live.h"
#include "store/store.h"
#include "system/thread_pool.h"

typedef struct api_job_table api_job_table;

enum {
    API_JOBS_KEPT = 1000,             /* jobs, including those queued and running */
    API_JOBS_BYTES = 64 << 20,        /* bytes of answers */
    API_JOB_SECONDS = ST_JOB_SECONDS, /* seconds for which an ended job is kept */
    API_JOB_LISTENERS = 1000          /* clients that listen to jobs at one time */
};

typedef struct api_job_table_options {
    st_store *store; /* knows what is durable */
    /* Runs the task on another thread. Returns false when too many tasks wait already. */
    bool (*submit)(void *pool, const st_task *task);
    void *pool;
    double keep; /* seconds for which an ended job is kept */
} api_job_table_options;

/* Makes a table with the jobs that the store has kept. Returns NULL when memory is out or they
 * cannot be read. */
api_job_table *api_job_table_new(const api_job_table_options *options);
/* No job may be running, or waiting for the pool or the journal. */
void api_job_table_free(api_job_table *table);
/* Cancels all jobs and accepts no more. */
void api_job_table_stop(api_job_table *table);

/* The answer of a job's work, borrowed until the work is freed; the table takes `body`. */
typedef struct api_job_outcome {
    int status;
    const char *location; /* "": none */
    char *body;           /* from he_mem; NULL: none */
    size_t length;
    api_blob blob;                        /* instead of `body`; the table takes it */
    bool shown;                           /* as in api_job */
    const char *headers[API_JOB_HEADERS]; /* NULL for a header that is missing */
    st_shown awaits;                      /* clients see the end when this is durable */
    bool changed;                         /* the work changed a mesh */
} api_job_outcome;

/* Reports the phase and the fraction done, 0 to 1. Returns false if the work shall stop. */
typedef bool api_job_progress(void *context, const char *phase, double done);

/* The work of a job. `run` is called at most once, by one thread; `free` is always called. The id
 * is the job's and lives until `free`. */
typedef struct api_job_work {
    void *self;
    void (*run)(void *self, const char *id, api_job_progress *progress, void *context,
                api_job_outcome *out);
    void (*free)(void *self);
    double seconds; /* estimated duration */
    /* the mesh whose listeners get events; the work holds a reference. NULL: none */
    st_mesh *about;
    const char *holder; /* name of the token that started it; "" if there was no token */
    /* queued and running jobs allowed to this holder, this one included; 0: no limit */
    uint64_t most;
    bool claims; /* the work has claimed that mesh (store/write.h) */
} api_job_work;

/* Takes `work` and describes the job in `out`. `operation` is a literal; `mesh` is the id of the
 * job's mesh or "".
 * Returns ST_TOO_MANY if too many jobs wait, ST_QUOTA if the holder has as many as allowed, or
 * ST_BEHIND or ST_NO_MEMORY. */
st_status api_job_submit(api_job_table *table, const api_job_work *work, const char *operation,
                         const char *mesh, api_job *out);

/* `viewer` is the token of the client that asks. Jobs that it does not own (api_token_owns) do not
 * exist for it. */

/* Calls `show` with the job, under the lock. Returns false if there is no job with this id. */
bool api_job_find(api_job_table *table, const api_token *viewer, const char *id,
                  void (*show)(void *context, const api_job *job), void *context);
/* Borrows the job with this id, with its answer, until api_job_return; `*facts` describes it as it
 * is now. Returns NULL if there is none. */
typedef struct api_job_entry api_job_loan;
api_job_loan *api_job_lend(api_job_table *table, const api_token *viewer, const char *id,
                           api_job *facts);
void api_job_return(api_job_loan *loan);
/* Calls `show` with up to `limit` jobs whose numbers are above `after`, in order. Returns true if
 * there are more.
 */
bool api_job_list(api_job_table *table, const api_token *viewer, uint64_t after, size_t limit,
                  void (*show)(void *context, const api_job *job), void *context);
/* Cancels a job that has not ended and calls `show`; deletes one that has ended and sets
 * `*forgotten`.
 * Returns ST_ABSENT if there is no such job, or ST_BEHIND, ST_FULL, ST_FAILED or ST_NO_MEMORY if
 * the store cannot delete it. */
st_status api_job_remove(api_job_table *table, const api_token *viewer, const char *id,
                         bool *forgotten, void (*show)(void *context, const api_job *job),
                         void *context);
/* The number of jobs in each state, and statistics since the start. */
typedef struct api_job_measures {
    size_t in_state[API_JOB_STATES];
    uint64_t ended[API_JOB_STATES]; /* zero for states that are not final */
    st_distribution waited, ran;    /* time in the queue, and time running; microseconds */
    size_t bytes;                   /* bytes of the answers that are kept */
    size_t listeners, most_listeners;
} api_job_measures;

/* Holds the table's lock for as long as counting the jobs takes. */
void api_job_measure(api_job_table *table, api_job_measures *out);
/* Opens a stream of events: one for each change of the job, and `bye` after the last or when the
 * server stops. The caller frees the source.
 * Returns ST_ABSENT, ST_LISTENERS or ST_NO_MEMORY. */
st_status api_job_follow(api_job_table *table, const api_token *viewer, const char *id,
                         api_source *out);

#endif
