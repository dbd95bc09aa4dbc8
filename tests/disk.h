/* disk.h - the disk under SQLite, as a test wants it: full, slow, failing. It stands before the
 * system's as SQLite's default from disk_install on; other programs and other files of the store
 * are not under it. */
#ifndef TESTS_DISK_H
#define TESTS_DISK_H

#include <stdbool.h>

/* Before the first store of the process is opened. */
void disk_install(void);
/* Writes find no space. */
void disk_fill(bool full);
/* The N-th write from now on and all after it find no space; 0: none does. */
void disk_fill_at(long write);
/* The N-th sync from now on fails; 0: none does. */
void disk_fail_at(long sync);
/* Syncs wait until they are let go on. */
void disk_hold(bool held);
/* Since the last disk_fill_at or disk_fail_at. */
long disk_syncs(void);
/* Connections to a database that may write, now. */
long disk_writers(void);

#endif
