/* sqlite_backup.h - copies a store to a single file (a backup) while a daemon runs, inspects
 * backups, and restores a store from a backup.
 *
 * A backup is the state of the store at one moment. It is written as NAME.part, synced, checked,
 * and then renamed to NAME, so NAME is always complete.
 *
 * A RESTORE puts the store back to an earlier state. Every mesh then gets a new incarnation,
 * because ETags and event ids that clients got for states after the backup, which the restore
 * removes, must not match later states. A restore takes the lock of the store's folder. It can be
 * interrupted at any step: once the file `restoring` exists, the next start, or the next restore,
 * finishes it.
 *
 *     restored.db    the copy of the backup, checked, with new incarnations
 *     restoring      names the folder for the old store; then, in this order:
 *     before-TIME/   hedge.db, -wal, -shm and hedge.mark are moved into this folder, all together,
 *                    because SQLite would apply a -wal to whatever database lies beside it
 *     hedge.db       restored.db gets this name; `restoring` is removed */
#ifndef HE_JOURNAL_SQLITE_BACKUP_H
#define HE_JOURNAL_SQLITE_BACKUP_H

#include "journal/sqlite/sqlite_journal.h"

/* All functions return false with a sentence in `message` on failure. */

/* Writes the store of a folder to a file, and replaces an existing file of that name; a daemon may
 * be running on the store. Refuses to replace a file of this or another store, or a file that has a
 * -wal or -journal (an unfinished log of SQLite) beside it. */
bool st_sqlite_backup(const char *folder, const char *file, char message[ST_SQLITE_MESSAGE]);
/* Replaces the store of the folder, if there is one, by the backup `file`. The old store is kept in
 * a folder, whose name is written to `before`. Refuses a backup with a -wal or -journal (a log of
 * SQLite) beside it, because the changes in the log would be left out. */
bool st_sqlite_restore(const char *folder, const char *file, char before[ST_SQLITE_MESSAGE],
                       char message[ST_SQLITE_MESSAGE]);
/* Checks that the structure of the file is intact, and that it is a store of a version that this
 * release knows. Its meshes and their records are not checked. */
bool st_sqlite_check_file(const char *file, char message[ST_SQLITE_MESSAGE]);

/* Makes a journal that only reads. `path` is the folder of a store, which a daemon may have open,
 * or a file. The journal refuses every append, does not mark damaged meshes on the disk, and reads
 * meshes even if their card (short description) says that they are damaged. It returns no
 * Idempotency-Keys. Only one thread may use it. */
bool st_sqlite_look(const char *path, st_sqlite_opened *out);

typedef void st_say(void *context, const char *what);
/* Checks the structure of the file of a journal that st_sqlite_look has made. Passes one line for
 * each of the first hundred faults to `say`, and returns the number of these lines. If there are
 * faults, the journal's function `list` from then on lists only meshes whose rows can be read, in
 * the order in which they were created; its parameter `after` must be the last id that was listed,
 * or "". */
unsigned st_sqlite_faults(const st_journal *journal, st_say *say, void *context);

#endif
