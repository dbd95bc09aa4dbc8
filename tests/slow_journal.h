/* slow_journal.h - a journal in which a record becomes durable, or is lost, only when the test says
 * so. It stores nothing, so no mesh can be loaded from it. If it was opened by
 * slow_journal_open_keeping, the store encodes edits and whole meshes as for a journal on a disk,
 * and the test can examine the latest encoded bytes. */
#ifndef TESTS_SLOW_JOURNAL_H
#define TESTS_SLOW_JOURNAL_H

#include "journal/journal.h"

#include <pthread.h>

typedef struct slow_journal {
    pthread_mutex_t lock;   /* protects the members below */
    pthread_cond_t changed; /* signalled when records were appended */
    uint64_t newest;        /* position of the newest record */
    /* The newest position reported as durable; UINT64_MAX: all positions are durable, also future
     * ones. */
    uint64_t durable;
    uint64_t groups; /* number of groups of records appended so far */
    char key[32];    /* Idempotency-Key of the request that made the newest record */
    /* first record of the newest group of records; the record's strings are valid as long as its
     * mesh exists */
    st_record record;
    st_room *room;   /* memory reserved for the newest group of records */
    st_stage *stage; /* mesh data of `record`, if it was written in advance (staged) */
    /* result of each reservation of memory and of writing mesh data in advance; but if it is
     * ST_FULL, deletions succeed */
    st_status refuse;
    /* number of times that the disk was full, as the journal reports it */
    uint64_t fulls;
    st_journal_measures measures; /* measurements that the journal reports */
    /* Function that the journal calls while an edit is written in advance; NULL: none. */
    void (*staging)(void);
    size_t staged_edits; /* number of edits that were encoded in advance (staged) */
    /* number of reservations (rooms) and of staged mesh data that were neither appended nor
     * released */
    size_t out;
    pthread_mutex_t telling; /* held while the journal calls its listener */
    bool is_heard;
    st_journal_listener listener;
} slow_journal;

/* Opens the journal, in which no record is durable until the test says so. `journal` must outlive
 * the store that uses it. */
st_journal slow_journal_open(slow_journal *journal);
/* Opens the journal so that the store encodes records for it, as for a journal on a disk. */
st_journal slow_journal_open_keeping(slow_journal *journal);
/* Returns the mesh that was written in advance for the newest group of records; NULL if none
 * was. */
const he_mesh *slow_journal_staged(const slow_journal *journal);
/* Waits until records up to this position were appended. */
void slow_journal_wait(slow_journal *journal, uint64_t position);
uint64_t slow_journal_newest(slow_journal *journal);
/* Reports to the store that all records up to this position are durable. */
void slow_journal_advance(slow_journal *journal, uint64_t position);
/* Reports to the store that the changes in `loss` were lost; the test must then advance past the
 * lost records. */
void slow_journal_lose(slow_journal *journal, const st_loss *loss);

#endif
