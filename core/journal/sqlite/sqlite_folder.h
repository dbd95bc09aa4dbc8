/* sqlite_folder.h - the folder of a store, and the files in it that are not SQLite's.
 *
 *     lock       held by the daemon (flock) for as long as it lives: its process and host
 *     hedge.db   the database, with -wal and -shm: only SQLite opens them
 *     hedge.mark how far the database was, to be compared with it at the start
 *     ballast    space that is given up when the disk is full, so that meshes can be deleted
 *     fresh      there from before the database is made until the first start is over
 *
 * THE MARK. A damaged byte in the -wal makes SQLite drop all commits from there on without a word.
 * The mark tells: it is written after each commit, in two slots in turn so that one is always
 * whole, and names the commit. A database that is at an earlier one has lost its end. */
#ifndef HE_JOURNAL_SQLITE_FOLDER_H
#define HE_JOURNAL_SQLITE_FOLDER_H

#include "journal/sqlite/sqlite_message.h"

#include <limits.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct st_folder {
    char path[PATH_MAX];
    int folder, lock, mark;          /* descriptors, -1 where there is none */
    char message[ST_SQLITE_MESSAGE]; /* of the last failure: a sentence */
} st_folder;

typedef struct st_mark {
    uint64_t store, commits, position;
} st_mark;

/* Makes the folder where it is missing, and locks it. False when another process has it, or the
 * system refuses. To be closed in any case. */
bool st_folder_open(st_folder *folder, const char *path);
void st_folder_close(st_folder *folder); /* unlocks */
/* A warning about a file system whose locks or syncs cannot be relied on; "" for any other. */
const char *st_folder_doubt(const st_folder *folder);

/* Says what, such as "cannot make", failed with errno for that file of it, or with "" for itself;
 * false. */
bool st_folder_fail(st_folder *folder, const char *what, const char *name);

/* The folder that a file or folder of that path lies in. */
void st_folder_above(const char *path, char out[PATH_MAX]);
/* The path of a file in it. False where it is too long. */
bool st_folder_path(const st_folder *folder, const char *name, char out[PATH_MAX]);
bool st_folder_has(const st_folder *folder, const char *name);
/* Makes the file, empty and for its owner alone, unless it is there. */
bool st_folder_make(st_folder *folder, const char *name);
/* Is the file there, empty or not? */
bool st_folder_finds(const st_folder *folder, const char *name);
/* Removes the file, for good. False where it is there still. */
bool st_folder_drop(st_folder *folder, const char *name);
/* What was made, renamed and removed in it stays so. */
bool st_folder_sync(st_folder *folder);

/* Opens the mark, empty where it is missing. Before the others. */
bool st_mark_open(st_folder *folder);
/* The newest mark that is whole; false where there is none. */
bool st_mark_read(st_folder *folder, st_mark *out);
/* Does not wait for the disk. */
bool st_mark_write(st_folder *folder, const st_mark *mark);
bool st_mark_sync(st_folder *folder);

/* Is there space for some MiB more? */
bool st_folder_has_space(st_folder *folder);
/* Makes the ballast unless it is there. False where there is no space for it. */
bool st_ballast_make(st_folder *folder);
/* Gives it up. False when there was none. */
bool st_ballast_drop(st_folder *folder);
/* Gives it up where the disk is too full to start from; false where it is not. */
bool st_ballast_drop_for_start(st_folder *folder);

#endif
