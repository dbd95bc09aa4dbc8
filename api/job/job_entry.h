/* job_entry.h - one job of the table of jobs, for the files job_table.c, job_keep.c, job_measure.c
 * and job_events.c. */
#ifndef HE_API_JOB_JOB_ENTRY_H
#define HE_API_JOB_JOB_ENTRY_H

#include "api/job/job_table.h"

#include <pthread.h>
#include <stdatomic.h>

typedef struct api_job_listener api_job_listener;

/* A job in the list of its table. The table's lock protects all members but the atomics, and `work`
 * while it runs. */
typedef struct api_job_entry {
    api_job_table *table;
    api_job facts; /* phase and progress are copied here only when it has ended */
    char *body;    /* facts.body, owned by the entry */
    api_blob blob; /* facts.blob, owned by the entry */
    /* The memory of the strings of facts.headers, and of all strings of a job from before a
     * restart. */
    char *texts;
    api_job_work work; /* self is NULL when it has ended */
    /* The mesh whose listeners get events of the job, with a reference held; NULL if there is none,
     * or when the job has ended. */
    st_mesh *about;
    st_wait wait;      /* from the end of the work until its result is durable */
    bool changed;      /* the work changed a mesh */
    bool is_kept;      /* the store has a record of it */
    bool interrupted;  /* it was queued or running when the server last stopped */
    api_job_state end; /* the final state, set before clients may see it */
    double ended;      /* and the time of the end */
    uint64_t noted;    /* position of the record of its end, 0: none */
    st_wait accepted;  /* until the record that it was accepted is durable */
    uint32_t uses;     /* references: from the list, the pool and listeners */
    bool listed;
    struct api_job_entry *next, *previous; /* in the order of numbers */
    api_job_listener *waiting;             /* listeners to wake when the job changes */

    _Atomic bool stop;
    _Atomic(const char *) phase;
    _Atomic double progress;
    _Atomic bool awaited; /* a listener waits for more progress than `shown` */
    _Atomic double shown;
} api_job_entry;

struct api_job_table {
    api_job_table_options options;
    pthread_mutex_t lock;
    api_job_entry *first, *last;
    size_t count;
    size_t bytes; /* bytes of all bodies */
    uint64_t submitted;
    size_t listeners;
    bool stopped;
    uint64_t ended[API_JOB_STATES]; /* jobs that ended in each final state */
    st_histogram waited, ran;       /* in microseconds */
};

/* The caller of this and the following functions must hold the table's lock. */
static inline bool api_job_entry_has_ended(const api_job_entry *job)
{
    return job->facts.state >= API_JOB_DONE;
}
/* Finds a job. Returns NULL if no job has the id or the viewer may not see it. */
api_job_entry *api_job_entry_find(const api_job_table *table, api_job_wanted wanted);
static inline bool api_job_entry_is_seen(const api_job_entry *job, const api_token *viewer)
{
    return api_token_owns(viewer, job->facts.holder, job->facts.mesh);
}
/* Returns the description of a job with its present progress. */
const api_job *api_job_entry_facts(api_job_entry *job);
void api_job_entry_release(api_job_entry *job);

/* Counts the job as started, for metrics. The caller must hold the table's lock. */
void api_job_count_begin(api_job_entry *job);
void api_job_count_end(api_job_entry *job);

/* defined in job_keep.c */
/* Returns the id of the job's mesh: the mesh that it made, if it made one, else the mesh that it
 * was started on. */
const char *api_job_entry_mesh(const api_job *facts);
/* Records the job in the store, from its facts, `end` and `ended`, so that it survives a restart.
 * Sets *position to 0 if the store keeps nothing on disk.
 * Returns ST_BEHIND, ST_FULL, ST_FAILED or ST_NO_MEMORY if the store cannot record it. */
st_status api_job_keep(api_job_entry *job, uint64_t *position);
/* Deletes the record of a job. Returns the errors of api_job_keep. */
st_status api_job_forget(const api_job_entry *job);
/* Loads the jobs of the last run; those that had not ended are marked interrupted. Returns false
 * when memory is out or the store cannot be read. */
bool api_job_restore(api_job_table *table);
/* Appends a job to the list of its table. */
void api_job_entry_append(api_job_table *table, api_job_entry *job);

/* defined in job_events.c */
void api_job_entry_wake(api_job_entry *job);

#endif
