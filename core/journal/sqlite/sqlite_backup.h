/* sqlite_backup.h - copies a store to a single file while a daemon runs, inspects such a file, and
 * restores a store from it.
 *
 * A backup is the state of the store at one moment. It is written as NAME.part, synced, checked,
 * and then renamed to NAME, so NAME is always complete.
 *
 * A RESTORE puts the store back to an earlier state. Every mesh then gets a new incarnation,
 * because ETags and event ids that clients got for states that no longer exist must not match other
 * states. It takes the lock of the folder. It can be interrupted at any step: once the file
 * `restoring` exists, the next start, or the next restore, finishes it.
 *
 *     restored.db    the copy of the backup, checked, with new incarnations
 *     restoring      names the folder for the old store; then, in this order:
 *     before-TIME/   hedge.db, -wal, -shm and hedge.mark are moved into it, all together, because a
 *                    -wal beside another database would be replayed onto it
 *     hedge.db       restored.db gets this name; `restoring` is removed */
#ifndef HE_JOURNAL_SQLITE_BACKUP_H
#define HE_JOURNAL_SQLITE_BACKUP_H

#include "journal/sqlite/sqlite_journal.h"

/* All functions return false with a sentence in `message` on failure. */

/* Writes the store of a folder to a file, and replaces a file of that name; a daemon may be running
 * on the store. Refuses to replace a file of this or another store, or a file that has a -wal or
 * -journal beside it. */
bool st_sqlite_backup(const char *folder, const char *file, char message[ST_SQLITE_MESSAGE]);
/* Replaces the store of the folder, if there is one, by the backup `file`. `before` is the folder
 * where the old store is kept. Refuses a backup with a -wal or -journal beside it, because the
 * changes in that would be left out. */
bool st_sqlite_restore(const char *folder, const char *file, char before[ST_SQLITE_MESSAGE],
                       char message[ST_SQLITE_MESSAGE]);
/* Checks that the structure of the file is intact, and that it is a store of a version that this
 * release knows. Its meshes and their records are not checked. */
bool st_sqlite_check_file(const char *file, char message[ST_SQLITE_MESSAGE]);

/* Makes a journal that only reads. `path` is the folder of a store, which a daemon may have open,
 * or a file. The journal refuses every append, stores no finding of damage, and reads meshes even
 * if their card says that they are damaged. It has no keys. Only one thread may use it. */
bool st_sqlite_look(const char *path, st_sqlite_opened *out);

typedef void st_say(void *context, const char *what);
/* Checks the structure of the file of a journal that st_sqlite_look has made, and passes what is
 * wrong with it to `say`, one line for each of the first hundred faults; returns their number. If
 * there are any, the journal's `list` from then on lists the meshes that can be reached, in the
 * order in which they were created; its parameter `after` must be the last id that was listed, or
 * "". */
unsigned st_sqlite_faults(const st_journal *journal, st_say *say, void *context);

#endif
