/* job_entry.h - one job of a table: what job_table.c and job_events.c share. */
#ifndef HE_API_JOB_JOB_ENTRY_H
#define HE_API_JOB_JOB_ENTRY_H

#include "api/job/job_table.h"

#include <pthread.h>
#include <stdatomic.h>

typedef struct api_job_listener api_job_listener;

/* In the list of its table, whose lock is for all but the atomics, and `work` while it runs. */
typedef struct api_job_entry {
    api_job_table *table;
    api_job facts;     /* but for phase and progress until it has ended */
    char *body;        /* facts.body, owned */
    api_blob blob;     /* facts.blob, owned */
    char *texts;       /* what facts.headers point into, and of a job of before the start the
                          others too; owned */
    api_job_work work; /* self NULL when it has ended */
    st_mesh *about;    /* the mesh whose listeners are told, held; NULL: none, or the job ended */
    st_wait wait;      /* from the end of the work until that is durable */
    bool changed;      /* the work changed something */
    bool is_kept;      /* the store has a note of it */
    bool interrupted;  /* it had not ended when the server stopped before */
    api_job_state end; /* what the work came to, before that shows, */
    double ended;      /* and when it ended */
    uint64_t noted;    /* position of the note of its end, 0: none */
    st_wait accepted;  /* until the note that it was accepted is durable */
    uint32_t uses;     /* by the list, by the pool, by listeners */
    bool listed;
    struct api_job_entry *next, *previous; /* in the order of numbers */
    api_job_listener *waiting;             /* to be woken when something is new */

    _Atomic bool stop;
    _Atomic(const char *) phase;
    _Atomic double progress;
    _Atomic bool awaited; /* somebody waits for more than `shown` */
    _Atomic double shown;
} api_job_entry;

struct api_job_table {
    api_job_table_options options;
    pthread_mutex_t lock;
    api_job_entry *first, *last;
    size_t count;
    size_t bytes; /* of bodies */
    uint64_t submitted;
    size_t listeners;
    bool stopped;
    uint64_t ended[API_JOB_STATES]; /* how many came to each state that is an end */
    st_histogram waited, ran;       /* microseconds */
};

/* All under the table's lock. */
static inline bool api_job_entry_has_ended(const api_job_entry *job)
{
    return job->facts.state >= API_JOB_DONE;
}
/* NULL: there is none for this viewer. */
api_job_entry *api_job_entry_find(const api_job_table *table, const api_token *viewer,
                                  const char *id);
static inline bool api_job_entry_is_seen(const api_job_entry *job, const api_token *viewer)
{
    return api_token_owns(viewer, job->facts.holder, job->facts.mesh);
}
/* The facts as they are now. */
const api_job *api_job_entry_facts(api_job_entry *job);
void api_job_entry_release(api_job_entry *job);

/* job_measure.c, under the table's lock */
void api_job_count_begin(api_job_entry *job);
void api_job_count_end(api_job_entry *job);

/* job_keep.c */
/* The mesh it is about: the one it made, if it made one. */
const char *api_job_entry_mesh(const api_job *facts);
/* Notes the job beyond a restart, by its facts, `end` and `ended`. Where nothing is kept *position
 * is 0. ST_BEHIND, ST_FULL, ST_FAILED, ST_NO_MEMORY. */
st_status api_job_keep(api_job_entry *job, uint64_t *position);
st_status api_job_forget(const api_job_entry *job); /* likewise */
/* The jobs of before the start; those that had not ended then were interrupted. False without
 * memory, or where the store cannot be read. */
bool api_job_restore(api_job_table *table);
/* Puts the job at the end of the list. */
void api_job_entry_append(api_job_table *table, api_job_entry *job);

/* job_events.c */
void api_job_entry_wake(api_job_entry *job);

#endif
