/* sqlite_backup.h - stores as single files: made beside a running daemon, looked into, put back.
 *
 * A backup is the state of one moment. It is finished when it has its name: written beside as
 * NAME.part, synced, checked, renamed.
 *
 * A RESTORE puts a store back in time, so that every mesh gets a new incarnation: what was told of
 * the states that are gone (ETags, event ids) must not be told again of others. It takes the lock
 * of the folder. Its steps can be interrupted anywhere: from the moment that the file `restoring`
 * is there the next start, or the next restore, finishes it.
 *
 *     restored.db    the copy of the backup, checked, with new incarnations
 *     restoring      names the folder for what was there before; then, in this order:
 *     before-TIME/   hedge.db, -wal, -shm and hedge.mark are moved into it, all together, for a
 *                    -wal beside another database would be replayed onto it
 *     hedge.db       restored.db gets this name; `restoring` is removed */
#ifndef HE_JOURNAL_SQLITE_BACKUP_H
#define HE_JOURNAL_SQLITE_BACKUP_H

#include "journal/sqlite/sqlite_journal.h"

/* All give false with a sentence in `message` where something is wrong. */

/* Writes the store of a folder, which a daemon may have open, to a file, in place of one of that
 * name. Not over a file of this or another store, nor where a -wal or -journal of that name lies
 * beside. */
bool st_sqlite_backup(const char *folder, const char *file, char message[ST_SQLITE_MESSAGE]);
/* Replaces the store of the folder, if there is one; `before` is where the old one is kept. Not
 * from a file with a -wal or -journal beside it: what lies in that would be lost. */
bool st_sqlite_restore(const char *folder, const char *file, char before[ST_SQLITE_MESSAGE],
                       char message[ST_SQLITE_MESSAGE]);
/* Is the structure of the file whole, and is it a store that this release knows? Of its meshes and
 * their records nothing is said. */
bool st_sqlite_check_file(const char *file, char message[ST_SQLITE_MESSAGE]);

/* A journal that only reads: a folder's store, which a daemon may have open, or a file. What is
 * appended is refused, what is found damaged is not written down, and what is on a card of damage
 * keeps nobody from reading on. It has no keys. One thread may use it. */
bool st_sqlite_look(const char *path, st_sqlite_opened *out);

typedef void st_say(void *context, const char *what);
/* Looks through the structure of such a journal's file and says what is wrong with it, a line each
 * for the first hundred; returns how many. Where there is anything, meshes are listed from then on
 * in the order in which they were made, those that can be reached: `after` is the last that was
 * listed, or "". */
unsigned st_sqlite_faults(const st_journal *journal, st_say *say, void *context);

#endif
