/* sqlite_journal.h - the journal that stores meshes in a folder, by SQLite.
 *
 * One thread, the commit thread, writes and checkpoints through one connection. It commits
 * everything queued as one group, waits for the disk once, calls the listener, and takes the next
 * group: all that was queued during that sync. Other connections only read. (SQLite 3.7.0 to 3.51.2
 * can lose pages when one connection commits while another checkpoints; so no other connection
 * commits or checkpoints.)
 *
 * FAULTS OF THE DISK. If the disk is full, the commit of a group is tried again without background
 * work. If the group still does not fit, it is lost, with everything queued, and the journal is
 * FULL: it accepts only removals, frees its ballast (a file that reserves disk space) for them, and
 * checks each second whether the disk has space again for the ballast and some more. After any
 * other failed write or sync the journal is FAILED until a restart, because the state of the pages
 * on the disk is then unknown. Reads go on in both states. */
#ifndef HE_JOURNAL_SQLITE_JOURNAL_H
#define HE_JOURNAL_SQLITE_JOURNAL_H

#include "journal/journal.h"
#include "journal/sqlite/sqlite_message.h"

typedef struct st_sqlite_options {
    /* `folder` is the path of the store's folder, which is made if it is missing */
    const char *folder;
    const char *release; /* `release` is the name of this release, for messages */
    /* the most bytes of records that may be queued or have space reserved; 0: ST_SQLITE_QUEUE */
    uint64_t queue_bytes;
    /* The most Idempotency-Keys that are stored for all meshes together; 0: ST_SQLITE_KEYS. */
    uint64_t keys;
} st_sqlite_options;

enum { ST_SQLITE_QUEUE = 64 << 20, ST_SQLITE_KEYS = 1 << 20 };

typedef struct st_sqlite_opened {
    st_journal journal;
    /* True if the store is new: it was made by this start of the daemon, or by an earlier start
     * that was killed before its end. The store then contains only what such a start has put into
     * it. */
    bool made;
    /* If opening failed, the reason; else a warning, or "" if there is nothing to warn about. */
    char message[ST_SQLITE_MESSAGE];
} st_sqlite_opened;

/* Opens the store. Returns false with the reason in `message` if another daemon has the folder, if
 * the file is no store, if a newer release wrote it, if commits that were acknowledged are missing,
 * or if the system refuses. */
bool st_sqlite_open(const st_sqlite_options *options, st_sqlite_opened *out);

/* Returns the version of the SQLite library in use, a text that is never freed. */
const char *st_sqlite_library(void);

#endif
