/* slow_journal.h - a journal that lags as far behind as a test tells it to: a record is durable, or
 * lost, when the test says so. It keeps nothing; or it has bodies coded and contents staged as one
 * that keeps them, and shows the newest, but finds no mesh again. */
#ifndef TESTS_SLOW_JOURNAL_H
#define TESTS_SLOW_JOURNAL_H

#include "journal/journal.h"

#include <pthread.h>

typedef struct slow_journal {
    pthread_mutex_t lock;    /* of what follows */
    pthread_cond_t changed;  /* a record was appended */
    uint64_t newest;         /* position */
    uint64_t durable;        /* told last; UINT64_MAX: nothing waits */
    uint64_t groups;         /* that were appended */
    char key[32];            /* Idempotency-Key of the newest record's request */
    st_record record;        /* the newest group's first; its texts are good for the mesh's life */
    st_room *room;           /* of the newest group */
    st_stage *stage;         /* of the newest group's first record */
    st_status refuse;        /* what reserving and staging are answered, but a removal by ST_FULL */
    void (*staging)(void);   /* called while an edit is staged; NULL: nothing is */
    size_t staged_edits;     /* how many were */
    size_t out;              /* rooms and stages that are neither published nor given back */
    pthread_mutex_t telling; /* held while the listener is called */
    bool is_heard;
    st_journal_listener listener;
} slow_journal;

/* Everything is behind. `journal` outlives the store that it is given to. */
st_journal slow_journal_open(slow_journal *journal);
/* One that has bodies coded. */
st_journal slow_journal_open_keeping(slow_journal *journal);
/* The content that the newest group brought, NULL where that was not staged. */
const he_mesh *slow_journal_staged(const slow_journal *journal);
/* Waits until so many records were appended. */
void slow_journal_wait(slow_journal *journal, uint64_t position);
uint64_t slow_journal_newest(slow_journal *journal);
/* All records up to here become durable. */
void slow_journal_advance(slow_journal *journal, uint64_t position);
/* Tells of a loss; an advance past it is to follow. */
void slow_journal_lose(slow_journal *journal, const st_loss *loss);

#endif
