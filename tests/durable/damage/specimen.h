/* specimen.h - a small store with one of each kind of row and record, and what it must show.
 *
 * Its meshes: "a" is edited, undone, done again and renamed, "b" is loaded from a snapshot, "c" was
 * replaced, "d" was removed. Most of it lies in hedge.db, the last changes in hedge.db-wal. */
#ifndef TESTS_DURABLE_DAMAGE_SPECIMEN_H
#define TESTS_DURABLE_DAMAGE_SPECIMEN_H

#include <stddef.h>

/* What a damaged copy of it turned out to be, the best first. */
typedef enum specimen_verdict {
    SPECIMEN_WHOLE,   /* all is there that was acknowledged */
    SPECIMEN_NAMED,   /* what is not there has a sentence that says so */
    SPECIMEN_STOPPED, /* likewise, but then no change is taken any more */
    SPECIMEN_REFUSED, /* the start is refused with a sentence */
    SPECIMEN_WRONG    /* something acknowledged is not there, or is another thing */
} specimen_verdict;

enum { SPECIMEN_WHY = 300 };

/* Makes it in the empty folder `made`, as it is after the last change was acknowledged, and copies
 * the files to `killed` as a killed process leaves them. */
void specimen_make(const char *made, const char *killed);

/* Opens the store in a folder, loads all meshes and reads all that is known of them, all earlier
 * revisions included; then changes, makes and removes meshes, opens it once more and looks again.
 * `why` says what a verdict stands on. */
specimen_verdict specimen_judge(const char *folder, char why[SPECIMEN_WHY]);

#endif
