/* specimen.h - a small store with a row in each table and a journal record of each kind, and the
 * check that a damaged copy of it shows what it must show when it is opened again.
 *
 * Its meshes: "a" was edited, undone, edited again and renamed; "b" is loaded from a snapshot; "c"
 * was replaced; "d" was removed. Most of the store is in hedge.db, the last changes are in
 * hedge.db-wal. */
#ifndef TESTS_DURABLE_DAMAGE_SPECIMEN_H
#define TESTS_DURABLE_DAMAGE_SPECIMEN_H

#include <stddef.h>

/* The verdicts about a damaged copy of the store, from the best to the worst. */
typedef enum specimen_verdict {
    SPECIMEN_WHOLE,   /* everything that was acknowledged is there */
    SPECIMEN_NAMED,   /* something is missing, and the store reports what */
    SPECIMEN_STOPPED, /* something is missing, the store reports what, and it refuses further
                         changes */
    SPECIMEN_REFUSED, /* the store cannot be opened and reports why */
    /* something acknowledged is missing or differs, and the store does not report it */
    SPECIMEN_WRONG
} specimen_verdict;

enum { SPECIMEN_WHY = 300 };

/* Makes the store. Both folders must be empty. `made` gets the store's files as a clean stop leaves
 * them; `killed` gets them as they are if the process is killed right after the last change was
 * acknowledged. */
void specimen_make(const char *made, const char *killed);

/* Opens the store in a folder, loads all meshes and reads everything about them, including all
 * earlier revisions. Then it changes, creates and removes meshes, opens the store once more and
 * reads everything again. Returns the verdict, and writes the reason for it to `why`. */
specimen_verdict specimen_judge(const char *folder, char why[SPECIMEN_WHY]);

#endif
