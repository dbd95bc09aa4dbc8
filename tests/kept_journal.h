/* kept_journal.h - a journal that keeps its records in memory, encoded as on a disk, so that meshes
 * can be loaded from it. Each record is durable as soon as it is appended. Tests can damage records
 * and can make the opening of a mesh wait. The memory comes from the C library, so that tests of
 * failing allocations affect only the store. The base of a mesh is the record with the whole mesh;
 * its other records are later edits. */
#ifndef TESTS_KEPT_JOURNAL_H
#define TESTS_KEPT_JOURNAL_H

#include "journal/journal.h"

typedef struct kept_journal kept_journal;

kept_journal *kept_journal_new(void);
/* Frees the journal; the store must be freed before. Fails the test if a room (memory reserved for
 * records), stage (mesh data written in advance) or reader still exists. */
void kept_journal_free(kept_journal *journal);
/* Opens the journal for a store. After that store was freed the journal can be opened again with
 * all its records. */
st_journal kept_journal_open(kept_journal *journal);

/* Makes reservations of memory, and the writing of mesh data in advance, fail with `status`; but
 * deletions succeed if `status` is ST_FULL. */
void kept_journal_refuse(kept_journal *journal, st_status status);
/* Makes the journal drop all further records, as if the process had ended before they were
 * written. */
void kept_journal_ignore(kept_journal *journal);
/* After kept_journal_stop, threads that open a mesh wait until kept_journal_go is called;
 * kept_journal_await returns when `openers` threads wait. */
void kept_journal_stop(kept_journal *journal);
void kept_journal_await(kept_journal *journal, size_t openers);
void kept_journal_go(kept_journal *journal);

/* What the journal has stored of a mesh, and how often it was read. */
typedef struct kept_facts {
    size_t records; /* number of records after the base */
    uint64_t base;  /* the revision of the base */
    size_t opened;  /* number of readers that were opened so far */
    size_t parts;   /* number of parts that were read so far; the encoded mesh is stored in parts */
    bool condemned;
} kept_facts;
kept_facts kept_journal_facts(kept_journal *journal, const char *id);
/* Returns the number of edits that were written in advance (staged). */
size_t kept_journal_staged_edits(kept_journal *journal);
/* Returns the number of rooms, stages and readers that are not freed yet. */
size_t kept_journal_out(kept_journal *journal);

/* Damages the n-th record after the base (n from 0), as a disk could. KEPT_CUT removes the end of
 * its body and KEPT_TURNED inverts a bit, and the checksum still matches in both cases; KEPT_SUM
 * makes only the checksum wrong. KEPT_NEWER changes the format version in the first byte from 1 to
 * 3, or from 3 to 1. */
typedef enum kept_damage { KEPT_CUT, KEPT_TURNED, KEPT_SUM, KEPT_NEWER } kept_damage;
void kept_journal_damage(kept_journal *journal, const char *id, size_t n, kept_damage how,
                         size_t at);

#endif
