/* kept_journal.h - a journal that stores its records in memory, encoded as on a disk, so that
 * meshes can be loaded from it again. Everything is durable at once. Tests can damage records and
 * can make the opening of a mesh wait. The memory comes from the C library, so that tests of
 * failing allocations affect the store alone. */
#ifndef TESTS_KEPT_JOURNAL_H
#define TESTS_KEPT_JOURNAL_H

#include "journal/journal.h"

typedef struct kept_journal kept_journal;

kept_journal *kept_journal_new(void);
/* Frees the journal after its store. Fails the test if a room, stage or reader still exists. */
void kept_journal_free(kept_journal *journal);
/* Opens the journal for a store. It may be opened again after that store was freed: closing it
 * keeps its records. */
st_journal kept_journal_open(kept_journal *journal);

/* From now on reserving and staging return `status`, except that deletions are accepted if it is
 * ST_FULL. */
void kept_journal_refuse(kept_journal *journal, st_status status);
/* From now on appended records are dropped, as if the process had ended before. */
void kept_journal_ignore(kept_journal *journal);
/* Threads that open a mesh wait until the journal is released; returns when `openers` threads
 * wait. */
void kept_journal_stop(kept_journal *journal);
void kept_journal_await(kept_journal *journal, size_t openers);
void kept_journal_go(kept_journal *journal);

/* What is stored of a mesh. */
typedef struct kept_facts {
    size_t records; /* after the base */
    uint64_t base;  /* revision of the base */
    size_t opened;  /* how often a reader was opened */
    size_t parts;   /* parts of contents that were read */
    bool condemned;
} kept_facts;
kept_facts kept_journal_facts(kept_journal *journal, const char *id);
/* Returns the number of edits that were staged. */
size_t kept_journal_staged_edits(kept_journal *journal);
/* Returns the number of rooms, stages and readers that exist. */
size_t kept_journal_out(kept_journal *journal);

/* Damages the body of record n after the base (n from 0): cuts its end off (KEPT_CUT) or flips a
 * bit (KEPT_TURNED), undetected or (KEPT_SUM) with a wrong checksum, as a disk would. KEPT_NEWER
 * changes version 1 in the first byte to 2, and back. */
typedef enum kept_damage { KEPT_CUT, KEPT_TURNED, KEPT_SUM, KEPT_NEWER } kept_damage;
void kept_journal_damage(kept_journal *journal, const char *id, size_t n, kept_damage how,
                         size_t at);

#endif
