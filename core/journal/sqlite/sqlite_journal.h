/* sqlite_journal.h - the journal that keeps meshes in a folder, by SQLite.
 *
 * One thread and one connection write and checkpoint. It commits all that is queued as one group,
 * waits for the disk once, tells the listener, and takes the next: a group forms while the sync
 * before it runs. Other connections only read. (SQLite 3.7.0 to 3.51.2 can lose pages when one
 * connection commits beside a checkpoint on another; so there is no other.)
 *
 * WHEN THE DISK SAYS NO. A group that finds the disk full is tried again without background work;
 * then it is lost, with all that is queued, and the journal is FULL: it admits only removals, gives
 * up its ballast for them, and looks each second whether there is space again, beside the ballast.
 * After any other failure of a write or a sync it is FAILED until a restart: what the kernel said
 * about the pages can no longer be believed. Reads go on in both. */
#ifndef HE_JOURNAL_SQLITE_JOURNAL_H
#define HE_JOURNAL_SQLITE_JOURNAL_H

#include "journal/journal.h"
#include "journal/sqlite/sqlite_message.h"

typedef struct st_sqlite_options {
    const char *folder;   /* made where it is missing */
    const char *release;  /* the name of this one, for messages */
    uint64_t queue_bytes; /* that may be queued or reserved; 0: ST_SQLITE_QUEUE */
    uint64_t keys;        /* that are kept of all meshes together; 0: ST_SQLITE_KEYS */
} st_sqlite_options;

enum { ST_SQLITE_QUEUE = 64 << 20, ST_SQLITE_KEYS = 1 << 20 };

typedef struct st_sqlite_opened {
    st_journal journal;
    bool made; /* the start that made the store is not over: at this one, or as it was killed at an
                  earlier one. It holds nothing but what that start put in */
    char message[ST_SQLITE_MESSAGE]; /* a doubt, "" for none; after a refusal the reason */
} st_sqlite_opened;

/* False with the reason in `message`: another daemon has the folder, the file is a newer release's
 * or no store, what was acknowledged is not all there, the system refuses. */
bool st_sqlite_open(const st_sqlite_options *options, st_sqlite_opened *out);

/* The version of SQLite that the process was given; static. */
const char *st_sqlite_library(void);

#endif
