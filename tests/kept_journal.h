/* kept_journal.h - a journal that stores its records in memory, encoded as on a disk, so that
 * meshes can be loaded from it again. Everything is durable at once. Tests can damage records and
 * can make the opening of a mesh wait. The memory is allocated by the C library directly, so that
 * tests of failing allocations affect the store alone. The base of a mesh is the record with its
 * whole content; the other records are edits after it. */
#ifndef TESTS_KEPT_JOURNAL_H
#define TESTS_KEPT_JOURNAL_H

#include "journal/journal.h"

typedef struct kept_journal kept_journal;

kept_journal *kept_journal_new(void);
/* Frees the journal after its store. Fails the test if a room, stage or reader still exists. */
void kept_journal_free(kept_journal *journal);
/* Opens the journal for a store. It can be opened again after that store was freed, since closing
 * keeps the records. */
st_journal kept_journal_open(kept_journal *journal);

/* Makes reservations and staging fail with `status`, except that deletions are accepted if it is
 * ST_FULL. */
void kept_journal_refuse(kept_journal *journal, st_status status);
/* Makes the journal drop further records, as if the process had ended before they were written. */
void kept_journal_ignore(kept_journal *journal);
/* kept_journal_stop makes threads that open a mesh wait until the journal is released;
 * kept_journal_await returns when `openers` threads wait. */
void kept_journal_stop(kept_journal *journal);
void kept_journal_await(kept_journal *journal, size_t openers);
void kept_journal_go(kept_journal *journal);

/* What the journal stores of a mesh. */
typedef struct kept_facts {
    size_t records; /* number of records after the base */
    uint64_t base;  /* the revision of the base */
    size_t opened;  /* how often a reader was opened */
    size_t parts;   /* parts of contents that were read */
    bool condemned;
} kept_facts;
kept_facts kept_journal_facts(kept_journal *journal, const char *id);
/* Returns the number of edits that were staged. */
size_t kept_journal_staged_edits(kept_journal *journal);
/* Returns the number of rooms, stages and readers that exist. */
size_t kept_journal_out(kept_journal *journal);

/* Damages the body of the n-th record after the base (n from 0), as a disk could: KEPT_CUT cuts its
 * end off and KEPT_TURNED flips a bit, both without a wrong checksum; KEPT_SUM makes only the
 * checksum wrong. KEPT_NEWER changes the version in the first byte from 1 to 2, and back. */
typedef enum kept_damage { KEPT_CUT, KEPT_TURNED, KEPT_SUM, KEPT_NEWER } kept_damage;
void kept_journal_damage(kept_journal *journal, const char *id, size_t n, kept_damage how,
                         size_t at);

#endif
