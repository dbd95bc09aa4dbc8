/* kept_journal.h - a journal that keeps what it is given in memory, coded, as one on a disk does:
 * meshes can be found in it again. All is durable at once. What is kept can be damaged, and to open
 * a mesh can be made to wait. It takes its memory from the system, so that tests of failing
 * allocations see those of the store alone. */
#ifndef TESTS_KEPT_JOURNAL_H
#define TESTS_KEPT_JOURNAL_H

#include "journal/journal.h"

typedef struct kept_journal kept_journal;

kept_journal *kept_journal_new(void);
/* After the store that it was given to. Fails the test where a room, stage or reader is out. */
void kept_journal_free(kept_journal *journal);
/* May be opened again after its store was freed: closing the journal keeps what it has. */
st_journal kept_journal_open(kept_journal *journal);

/* What reserving and staging are answered from now on, but a removal by ST_FULL. */
void kept_journal_refuse(kept_journal *journal, st_status status);
/* From now on nothing that is appended is kept, as if the process had ended before. */
void kept_journal_ignore(kept_journal *journal);
/* While it is stopped whoever opens a mesh waits; returns when `openers` wait. */
void kept_journal_stop(kept_journal *journal);
void kept_journal_await(kept_journal *journal, size_t openers);
void kept_journal_go(kept_journal *journal);

/* What is kept of a mesh. */
typedef struct kept_facts {
    size_t records; /* after the base */
    uint64_t base;  /* its revision */
    size_t opened;  /* how often it was read from */
    size_t parts;   /* of contents that were read from it */
    bool condemned;
} kept_facts;
kept_facts kept_journal_facts(kept_journal *journal, const char *id);
/* How many edits were staged. */
size_t kept_journal_staged_edits(kept_journal *journal);
/* How many rooms, stages and readers are out. */
size_t kept_journal_out(kept_journal *journal);

/* Damage of the body of the n-th record after the base, n from 0: its end is cut off, or the bit of
 * a byte is turned, and the sum tells of it (as a disk would) or does not. KEPT_NEWER makes version
 * 1 in its first byte 2, and back. */
typedef enum kept_damage { KEPT_CUT, KEPT_TURNED, KEPT_SUM, KEPT_NEWER } kept_damage;
void kept_journal_damage(kept_journal *journal, const char *id, size_t n, kept_damage how,
                         size_t at);

#endif
