/* job_table.h - jobs: work that outlives its request. The table runs them, tracks their progress
 * and keeps their answers.
 *
 * A request whose work is long, or whose client prefers it, is answered 202 at once. Its work goes
 * to the job table, which runs it on a thread of the job pool and keeps the answer:
 *
 *      api_detach ---- submit --> queued --> running --> done     a success
 *          |                        |          |     --> failed   a problem
 *       202 Location              remove     remove  --> cancelled
 *
 * Requests that take long but do not become jobs also run on that pool. Answers are kept for a
 * while, up to API_JOBS_KEPT jobs and API_JOBS_BYTES of answers; the jobs that ended first are
 * dropped first. The store keeps a record of each job, so that no job is lost by a restart; a job
 * that had not ended then counts as failed, with the problem `interrupted`. A job frees all its
 * resources except the answer before clients can see its end, and they see the end only when it is
 * durable. An answer may be a file of many megabytes: it is moved into the table and lent to
 * readers, not copied.
 *
 * The table has one lock, held for at most as long as it takes to copy an answer. Progress is
 * reported without the lock, except when listeners have to be woken. The reporting thread may then
 * hold the lock of a mesh, so a thread that holds the table's lock must not take the lock of a mesh
 * and must not free work. */
#ifndef HE_API_JOB_JOB_TABLE_H
#define HE_API_JOB_JOB_TABLE_H

#include "api/job/job.h"
#include "api/json/text.h"
#include "api/live.h"
#include "store/store.h"
#include "system/thread_pool.h"

typedef struct api_job_table api_job_table;

enum {
    API_JOBS_KEPT = 1000,             /* the most jobs in the table: queued, running and ended */
    API_JOBS_BYTES = 64 << 20,        /* bytes of all answers */
    API_JOB_SECONDS = ST_JOB_SECONDS, /* seconds for which an ended job is kept */
    API_JOB_LISTENERS = 1000          /* the most event streams of jobs that are open at one time */
};

typedef struct api_job_table_options {
    /* The store, which keeps the records of jobs and knows which of them are durable. */
    st_store *store;
    /* Runs the task on another thread. Returns false when too many tasks wait already. */
    bool (*submit)(void *pool, const st_task *task);
    void *pool;
    double keep; /* seconds for which an ended job is kept */
} api_job_table_options;

/* Makes a table with the jobs that the store has kept. Returns NULL when memory is out or the jobs
 * cannot be read. */
api_job_table *api_job_table_new(const api_job_table_options *options);
/* Frees the table. No job may be running, or waiting for the job pool or the journal. */
void api_job_table_free(api_job_table *table);
/* Cancels all jobs and accepts no more. */
void api_job_table_stop(api_job_table *table);

/* The answer of a job's work. Its pointers are borrowed until the work is freed, except `body` and
 * `blob`, which the table takes over. */
typedef struct api_job_outcome {
    int status;
    const char *location; /* value of the header Location; "": none */
    char *body;           /* memory of base/mem.h; NULL: none */
    size_t length;
    api_blob blob; /* the answer's body, if it is not in `body` */
    bool shown;    /* as in api_job */
    /* Values of the answer's headers, as in api_job; NULL for a header that the answer does not
     * have. */
    const char *headers[API_JOB_HEADERS];
    st_shown awaits; /* the change that must be durable before clients may see the end of the job */
    bool changed;    /* the work changed a mesh */
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
    /* The mesh whose listeners get events of the job; the work counts as one reference to the mesh.
     * NULL if there is no such mesh. */
    st_mesh *about;
    /* Name of the token of the request that started the job; "" if it had no token. */
    const char *holder;
    /* How many queued and running jobs the token `holder` may have, including this job; 0 is no
     * limit. */
    uint64_t most;
    /* True if the work has claimed the mesh `about`: other requests cannot write to the mesh until
     * the work has ended (store/write.h). */
    bool claims;
} api_job_work;

/* Starts a job that does `work`, which the table then owns; describes the job in `out`. `operation`
 * must be a literal; `mesh` is the id of the job's mesh or "".
 * Returns ST_TOO_MANY if too many jobs wait, ST_QUOTA if the holder has as many as allowed,
 * ST_BEHIND if too many changes wait to be written to the journal, or ST_NO_MEMORY. */
st_status api_job_submit(api_job_table *table, const api_job_work *work, const char *operation,
                         const char *mesh, api_job *out);

/* The id of the job that a client asks for, and the client's token. */
typedef struct api_job_wanted {
    /* The client's token; NULL: the server has no tokens. Jobs that the token does not own
     * (api_token_owns) do not exist for the client. */
    const api_token *viewer;
    const char *id;
} api_job_wanted;

/* Calls `show` with the wanted job, while the table's lock is held. Returns false if there is no
 * such job. */
bool api_job_find(api_job_table *table, api_job_wanted wanted,
                  void (*show)(void *context, const api_job *job), void *context);
/* Borrows the wanted job with its answer until api_job_return is called; `*facts` gets the present
 * description of the job. Returns NULL if there is no such job. */
typedef struct api_job_entry api_job_loan;
api_job_loan *api_job_lend(api_job_table *table, api_job_wanted wanted, api_job *facts);
void api_job_return(api_job_loan *loan);
/* Selects one page of the list of the jobs that a client's token owns, which is in the order of job
 * numbers. */
typedef struct api_job_page {
    const api_token *viewer; /* as in api_job_wanted */
    uint64_t after;          /* the number of the last job before the page */
    size_t limit;            /* how many jobs the page has at most */
} api_job_page;

/* Calls `show` with each job of a page. Returns true if there are more jobs after the page. */
bool api_job_list(api_job_table *table, const api_job_page *page,
                  void (*show)(void *context, const api_job *job), void *context);
/* Cancels the wanted job if it has not ended, and calls `show`; deletes it if it has ended, and
 * sets `*forgotten`.
 * Returns ST_ABSENT if there is no such job, or ST_BEHIND, ST_FULL, ST_FAILED or ST_NO_MEMORY if
 * the store cannot delete it. */
st_status api_job_remove(api_job_table *table, api_job_wanted wanted, bool *forgotten,
                         void (*show)(void *context, const api_job *job), void *context);
/* The number of jobs in each state, and statistics since the server started. */
typedef struct api_job_measures {
    size_t in_state[API_JOB_STATES];
    /* Number of jobs that ended in each final state; 0 for the states that are not final. */
    uint64_t ended[API_JOB_STATES];
    /* waited: times of jobs in the queue; ran: times running; in microseconds. */
    st_distribution waited, ran;
    size_t bytes; /* number of bytes of all answers that are kept */
    size_t listeners, most_listeners;
} api_job_measures;

/* Measures the table of jobs. The function holds the table's lock while it counts the jobs. */
void api_job_measure(api_job_table *table, api_job_measures *out);
/* Opens the event stream of a job: one event for each change of the job, and the event `bye` after
 * the last one or when the server stops. The caller frees the source.
 * Returns ST_ABSENT if there is no such job, ST_LISTENERS if too many clients listen to jobs, or
 * ST_NO_MEMORY. */
st_status api_job_follow(api_job_table *table, api_job_wanted wanted, api_source *out);

#endif
