/* job_entry.h - the data of one job and of the job table, shared by job_table.c, job_keep.c,
 * job_measure.c and job_events.c only. */
#ifndef HE_API_JOB_JOB_ENTRY_H
#define HE_API_JOB_JOB_ENTRY_H

#include "api/job/job_table.h"

#include <pthread.h>
#include <stdatomic.h>

typedef struct api_job_listener api_job_listener;

/* A job in the list of the job table. The table's lock protects all members except the atomic ones,
 * and except `work` while the work runs. */
typedef struct api_job_entry {
    api_job_table *table;
    /* Description of the job. Its members phase and progress are set only when the job has
     * ended. */
    api_job facts;
    char *body;    /* facts.body, owned by the entry */
    api_blob blob; /* facts.blob, owned by the entry */
    /* The memory of the strings in facts.headers. If the job was loaded from the store after a
     * restart, this is also the memory of the other strings in `facts`. */
    char *texts;
    api_job_work work; /* the work of the job; work.self is NULL when the work has ended */
    /* The mesh whose listeners get events of the job; the entry counts as one reference to it. NULL
     * if the job has no mesh or has ended. */
    st_mesh *about;
    /* The wait, after the work has ended, until the result of the job is durable. */
    st_wait wait;
    bool changed;      /* the work changed a mesh */
    bool is_kept;      /* true if the store has a record of the job */
    bool interrupted;  /* true if the job was queued or running when the server last stopped */
    api_job_state end; /* the final state of the job, set before clients may see it */
    double ended;      /* time at which the job ended, set together with `end` */
    /* Position in the journal at which the end of the job was recorded; 0: not recorded. */
    uint64_t noted;
    st_wait accepted; /* the wait until it is durably recorded that the job was accepted */
    uint32_t uses;    /* number of references: of the list of jobs, the thread pool and listeners */
    bool listed;
    struct api_job_entry *next, *previous; /* neighbours in the list, in the order of job numbers */
    api_job_listener *waiting;             /* listeners to wake when the job changes */

    _Atomic bool stop;
    _Atomic(const char *) phase;
    _Atomic double progress;
    /* A listener waits until `progress` is greater than `shown` by enough to send it. */
    _Atomic bool awaited;
    _Atomic double shown;
} api_job_entry;

struct api_job_table {
    api_job_table_options options;
    pthread_mutex_t lock;
    api_job_entry *first, *last;
    size_t count;
    size_t bytes; /* number of bytes of all answers that are kept */
    uint64_t submitted;
    size_t listeners;
    bool stopped;
    /* Number of jobs that ended in each final state since the server started. */
    uint64_t ended[API_JOB_STATES];
    /* Statistics of how long jobs waited in the queue (`waited`) and ran (`ran`), in
     * microseconds. */
    st_histogram waited, ran;
};

/* Returns true if the job has ended. The caller of this function and of all functions below must
 * hold the table's lock. */
static inline bool api_job_entry_has_ended(const api_job_entry *job)
{
    return job->facts.state >= API_JOB_DONE;
}
/* Finds the job with the wanted id. Returns NULL if there is no such job or the client may not see
 * it. */
api_job_entry *api_job_entry_find(const api_job_table *table, api_job_wanted wanted);
static inline bool api_job_entry_is_seen(const api_job_entry *job, const api_token *viewer)
{
    return api_token_owns(viewer, job->facts.holder, job->facts.mesh);
}
/* Returns the description of a job with its present progress. */
const api_job *api_job_entry_facts(api_job_entry *job);
void api_job_entry_release(api_job_entry *job);

/* Counts the job as started, in the metrics. The caller must hold the table's lock. */
void api_job_count_begin(api_job_entry *job);
void api_job_count_end(api_job_entry *job);

/* The functions from here to api_job_restore are defined in job_keep.c. */
/* Returns the id of the job's mesh: the mesh that it made, if it made one, else the mesh that it
 * was started on. */
const char *api_job_entry_mesh(const api_job *facts);
/* Records the job in the store, from its members `facts`, `end` and `ended`, so that it survives a
 * restart. Sets *position to the record's position in the journal, or to 0 if the store keeps
 * nothing on disk.
 * Returns ST_BEHIND, ST_FULL, ST_FAILED or ST_NO_MEMORY if the store cannot record it. */
st_status api_job_keep(api_job_entry *job, uint64_t *position);
/* Deletes the store's record of a job. Fails with the errors of api_job_keep. */
st_status api_job_forget(const api_job_entry *job);
/* Loads the jobs that the store recorded before the restart of the server. Jobs that had not ended
 * are marked as interrupted. Returns false when memory is out or the store cannot be read. */
bool api_job_restore(api_job_table *table);
/* Appends a job to the list of its table. */
void api_job_entry_append(api_job_table *table, api_job_entry *job);

/* Wakes all listeners that wait for a change of the job. Defined in job_events.c. */
void api_job_entry_wake(api_job_entry *job);

#endif
