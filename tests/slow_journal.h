/* slow_journal.h - a journal in which a record becomes durable, or is lost, only when the test says
 * so. It stores nothing, so no mesh can be loaded from it. slow_journal_open_keeping makes one to
 * which the store writes edits and whole meshes as bytes, as it does to a journal on a disk; a test
 * can examine the bytes written last. */
#ifndef TESTS_SLOW_JOURNAL_H
#define TESTS_SLOW_JOURNAL_H

#include "journal/journal.h"

#include <pthread.h>

typedef struct slow_journal {
    pthread_mutex_t lock;   /* protects the members below */
    pthread_cond_t changed; /* signalled when a record was appended */
    uint64_t newest;        /* position of the newest record */
    uint64_t durable;       /* the last position reported; UINT64_MAX: nothing waits */
    uint64_t groups;        /* groups appended so far */
    char key[32];           /* Idempotency-Key of the newest record's request */
    st_record record; /* the first record of the newest group; its texts live as long as the mesh */
    st_room *room;    /* the space reserved for the newest group */
    st_stage *stage;  /* the staged content of the newest group's first record */
    /* the result of reserving and staging, except that deletions are accepted if it is ST_FULL */
    st_status refuse;
    uint64_t fulls;               /* how often it was full, as it reports */
    st_journal_measures measures; /* what it reports of itself */
    void (*staging)(void);        /* called while an edit is staged; NULL: not called */
    size_t staged_edits;          /* edits staged so far */
    size_t out;                   /* rooms and stages that were neither published nor given back */
    pthread_mutex_t telling;      /* held while the listener is called */
    bool is_heard;
    st_journal_listener listener;
} slow_journal;

/* Opens the journal; nothing is durable at first. `journal` must outlive the store that uses it. */
st_journal slow_journal_open(slow_journal *journal);
/* Opens the journal so that the store encodes bodies for it, as for a journal on a disk. */
st_journal slow_journal_open_keeping(slow_journal *journal);
/* Returns the content that was staged for the newest group of records, or NULL if none was. */
const he_mesh *slow_journal_staged(const slow_journal *journal);
/* Waits until this many records were appended. */
void slow_journal_wait(slow_journal *journal, uint64_t position);
uint64_t slow_journal_newest(slow_journal *journal);
/* Makes all records up to this position durable. */
void slow_journal_advance(slow_journal *journal, uint64_t position);
/* Reports that changes were lost; the test must then advance past the lost records. */
void slow_journal_lose(slow_journal *journal, const st_loss *loss);

#endif
