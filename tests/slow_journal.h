/* slow_journal.h - a journal in which a record becomes durable, or is lost, only when the test says
 * so. It stores nothing, so no mesh can be loaded from it. slow_journal_open_keeping makes one that
 * has bodies encoded and contents staged like a journal that stores them, and shows the newest. */
#ifndef TESTS_SLOW_JOURNAL_H
#define TESTS_SLOW_JOURNAL_H

#include "journal/journal.h"

#include <pthread.h>

typedef struct slow_journal {
    pthread_mutex_t lock;   /* protects the members below */
    pthread_cond_t changed; /* a record was appended */
    uint64_t newest;        /* its position */
    uint64_t durable;       /* the last position reported; UINT64_MAX: nothing waits */
    uint64_t groups;        /* groups appended so far */
    char key[32];           /* Idempotency-Key of the newest record's request */
    st_record record; /* the first record of the newest group; its texts live as long as the mesh */
    st_room *room;    /* of the newest group */
    st_stage *stage;  /* of the newest group's first record */
    /* result of reserving and staging, except that deletions are accepted if it is ST_FULL */
    st_status refuse;
    void (*staging)(void);   /* called while an edit is staged; NULL: not called */
    size_t staged_edits;     /* edits staged so far */
    size_t out;              /* rooms and stages that were neither published nor given back */
    pthread_mutex_t telling; /* held while the listener is called */
    bool is_heard;
    st_journal_listener listener;
} slow_journal;

/* Opens the journal with nothing durable. `journal` outlives the store that uses it. */
st_journal slow_journal_open(slow_journal *journal);
/* Opens a journal that has bodies encoded. */
st_journal slow_journal_open_keeping(slow_journal *journal);
/* Returns the content that the newest group brought, or NULL if it was not staged. */
const he_mesh *slow_journal_staged(const slow_journal *journal);
/* Waits until this many records were appended. */
void slow_journal_wait(slow_journal *journal, uint64_t position);
uint64_t slow_journal_newest(slow_journal *journal);
/* Makes all records up to this position durable. */
void slow_journal_advance(slow_journal *journal, uint64_t position);
/* Reports a loss; the test must advance past it afterwards. */
void slow_journal_lose(slow_journal *journal, const st_loss *loss);

#endif
