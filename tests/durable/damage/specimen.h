/* specimen.h - a small store that has a row of each table and a record of each kind, and what it
 * must show when it is opened again.
 *
 * Its meshes: "a" was edited, undone, edited again and renamed; "b" is loaded from a snapshot; "c"
 * was replaced; "d" was removed. Most of it lies in hedge.db, the last changes lie in hedge.db-wal.
 */
#ifndef TESTS_DURABLE_DAMAGE_SPECIMEN_H
#define TESTS_DURABLE_DAMAGE_SPECIMEN_H

#include <stddef.h>

/* The verdict about a damaged copy of the store, from the best to the worst. */
typedef enum specimen_verdict {
    SPECIMEN_WHOLE,   /* everything that was acknowledged is there */
    SPECIMEN_NAMED,   /* something is missing, and a sentence says what */
    SPECIMEN_STOPPED, /* as SPECIMEN_NAMED, and the store accepts no more changes */
    SPECIMEN_REFUSED, /* the store refuses to open, with a sentence that says why */
    SPECIMEN_WRONG    /* something acknowledged is missing or differs, and nothing says so */
} specimen_verdict;

enum { SPECIMEN_WHY = 300 };

/* Makes the store in the empty folder `made` as it is after a clean stop, and copies the files to
 * the folder `killed` as they are when the process is killed right after the last change was
 * acknowledged. */
void specimen_make(const char *made, const char *killed);

/* Opens the store in a folder, loads all meshes and reads everything that is known of them,
 * including all earlier revisions. Then it changes, creates and removes meshes, opens the store
 * once more and reads again. `why` becomes the reason for the verdict. */
specimen_verdict specimen_judge(const char *folder, char why[SPECIMEN_WHY]);

#endif
