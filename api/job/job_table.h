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

/* Makes a table with the jobs that the store has kept. Returns NULL when memory is out or the jobs
 * cannot be read. */
api_job_table *api_job_table_new(const api_job_table_options *options);
/* Frees the table. No job may be running, or waiting for the pool or the journal. */
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

/* The function by which work reports its phase and the fraction that is done, 0 to 1. It returns
 * false if the work must stop. */
typedef bool api_job_progress(void *context, const char *phase, double done);

/* The work of a job. `run` is called at most once, by one thread; `free` is always called. `id` is
 * the id of the job and is valid until `free` is called. */
typedef struct api_job_work {
    void *self;
    void (*run)(void *self, const char *id, api_job_progress *progress, void *context,
                api_job_outcome *out);
    void (*free)(void *self);
    double seconds; /* estimated duration */
    /* The mesh whose listeners get events of the job, to which the work holds a reference; NULL if
     * there is none. */
    st_mesh *about;
    const char *holder; /* name of the token that started it; "" if there was no token */
    /* The number of queued and running jobs that this holder may have, this one included; 0 is no
     * limit. */
    uint64_t most;
    bool claims; /* the work has claimed that mesh (store/write.h) */
} api_job_work;

/* Starts a job: takes `work` and describes the job in `out`. `operation` must be a literal; `mesh`
 * is the id of the job's mesh or "".
 * Returns ST_TOO_MANY if too many jobs wait, ST_QUOTA if the holder has as many as allowed, or
 * ST_BEHIND or ST_NO_MEMORY. */
st_status api_job_submit(api_job_table *table, const api_job_work *work, const char *operation,
                         const char *mesh, api_job *out);

/* The job that a client asks for. */
typedef struct api_job_wanted {
    /* The client's token; NULL: the server asks for none. Jobs that it does not own
     * (api_token_owns) do not exist for the client. */
    const api_token *viewer;
    const char *id;
} api_job_wanted;

/* Calls `show` with a job, while the table's lock is held. Returns false if there is no such
 * job. */
bool api_job_find(api_job_table *table, api_job_wanted wanted,
                  void (*show)(void *context, const api_job *job), void *context);
/* Borrows a job, with its answer, until api_job_return; `*facts` describes the job as it is now.
 * Returns NULL if there is no such job. */
typedef struct api_job_entry api_job_loan;
api_job_loan *api_job_lend(api_job_table *table, api_job_wanted wanted, api_job *facts);
void api_job_return(api_job_loan *loan);
/* A page of the list of the jobs that a client's token owns, in the order of their numbers. */
typedef struct api_job_page {
    const api_token *viewer; /* as in api_job_wanted */
    uint64_t after;          /* the number of the last job before the page */
    size_t limit;            /* how many jobs the page has at most */
} api_job_page;

/* Calls `show` with the jobs of a page. Returns true if there are more after it. */
bool api_job_list(api_job_table *table, const api_job_page *page,
                  void (*show)(void *context, const api_job *job), void *context);
/* Cancels a job that has not ended and calls `show`; or deletes a job that has ended and sets
 * `*forgotten`.
 * Returns ST_ABSENT if there is no such job, or ST_BEHIND, ST_FULL, ST_FAILED or ST_NO_MEMORY if
 * the store cannot delete it. */
st_status api_job_remove(api_job_table *table, api_job_wanted wanted, bool *forgotten,
                         void (*show)(void *context, const api_job *job), void *context);
/* The number of jobs in each state, and statistics since the server started. */
typedef struct api_job_measures {
    size_t in_state[API_JOB_STATES];
    uint64_t ended[API_JOB_STATES]; /* zero for states that are not final */
    st_distribution waited, ran;    /* time in the queue, and time running; microseconds */
    size_t bytes;                   /* bytes of the answers that are kept */
    size_t listeners, most_listeners;
} api_job_measures;

/* Measures the table of jobs. It holds the table's lock for as long as counting the jobs takes. */
void api_job_measure(api_job_table *table, api_job_measures *out);
/* Opens the event stream of a job: one event for each change of the job, and `bye` after the last
 * one or when the server stops. The caller frees the source.
 * Returns ST_ABSENT if there is no such job, ST_LISTENERS if it has too many listeners, or
 * ST_NO_MEMORY. */
st_status api_job_follow(api_job_table *table, api_job_wanted wanted, api_source *out);

#endif
