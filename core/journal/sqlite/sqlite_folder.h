/* sqlite_folder.h - the folder of a store, and those of its files that SQLite does not open.
 *
 *     lock       locked (flock) by the daemon as long as it runs; contains its process id and host
 *     hedge.db   the database, with -wal and -shm: only SQLite opens them
 *     hedge.mark the last commit of the database, compared with it at the start
 *     ballast    space that is freed when the disk is full, so that meshes can be deleted
 *     fresh      exists from before the database is made until the first start is over
 *
 * THE MARK. A damaged byte in the write-ahead log (-wal) makes SQLite silently drop that commit and
 * all after it. The mark reveals this loss: it contains the number of the last commit, and is
 * written after each commit, alternately to two places of the file, so that one of them is always
 * intact. A database whose last commit is older than the mark has lost commits. */
#ifndef HE_JOURNAL_SQLITE_FOLDER_H
#define HE_JOURNAL_SQLITE_FOLDER_H

#include "journal/sqlite/sqlite_message.h"

#include <limits.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct st_folder {
    char path[PATH_MAX];
    /* Descriptors of the folder, of its file `lock` and of the mark; -1: not open. */
    int folder, lock, mark;
    /* a sentence about the latest failure of a function of this header */
    char message[ST_SQLITE_MESSAGE];
} st_folder;

typedef struct st_mark {
    uint64_t store, commits, position;
} st_mark;

/* Makes the store's folder if it is missing, and locks it. The caller must call st_folder_close
 * even after a failure. Returns false if another process has the lock, or the system reports an
 * error. */
bool st_folder_open(st_folder *folder, const char *path);
void st_folder_close(st_folder *folder); /* also releases the lock */
/* Returns a warning if the file system of the folder has locks or syncs that are not reliable; ""
 * otherwise. */
const char *st_folder_doubt(const st_folder *folder);

/* Writes a sentence to folder->message: that an action, such as `what` = "cannot make", failed with
 * errno for the file `name` of the folder ("" names the folder itself). Returns false. */
bool st_folder_fail(st_folder *folder, const char *what, const char *name);

/* Writes the path of the folder that contains the file or folder `path` to `out`. */
void st_folder_above(const char *path, char out[PATH_MAX]);
/* Makes the path of the file `name` in the folder. Returns false if it is too long. */
bool st_folder_path(const st_folder *folder, const char *name, char out[PATH_MAX]);
bool st_folder_has(const st_folder *folder, const char *name);
/* Makes an empty file in the folder that only its owner may read, unless the file exists. */
bool st_folder_make(st_folder *folder, const char *name);
/* Returns true if the folder has a file of this name, empty or not. */
bool st_folder_finds(const st_folder *folder, const char *name);
/* Removes a file of the folder durably. Returns false if the file still exists. */
bool st_folder_drop(st_folder *folder, const char *name);
/* Makes the creations, renames and removals in the folder durable. */
bool st_folder_sync(st_folder *folder);

/* Opens the file of the mark (the note of the last commit), or makes an empty file. Must be called
 * before the other functions whose names begin with st_mark. */
bool st_mark_open(st_folder *folder);
/* Reads the newest mark (note of the last commit) that is intact. Returns false if there is
 * none. */
bool st_mark_read(st_folder *folder, st_mark *out);
/* Writes the mark (note of the last commit) without waiting for the disk. */
bool st_mark_write(st_folder *folder, const st_mark *mark);
bool st_mark_sync(st_folder *folder);

/* Returns true if the file system has enough free space for writes to be worth trying again. */
bool st_folder_has_space(st_folder *folder);
/* Makes the ballast (space that is freed when the disk is full) unless it exists. Returns false if
 * there is no space for it. */
bool st_ballast_make(st_folder *folder);
/* Removes the ballast (reserved disk space). Returns false if there was none. */
bool st_ballast_drop(st_folder *folder);
/* Removes the ballast (reserved disk space) if the disk is too full for the daemon to start.
 * Returns false if the disk is not that full. */
bool st_ballast_drop_for_start(st_folder *folder);

#endif
