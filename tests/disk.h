/* disk.h - a simulated disk that a test can make full, slow or failing. After disk_install, SQLite
 * uses it by default; other processes, and files that the store opens without SQLite, use the real
 * disk. */
#ifndef TESTS_DISK_H
#define TESTS_DISK_H

#include <stdbool.h>

/* Installs the simulated disk; must be called before the process opens its first store. */
void disk_install(void);
/* If `full` is true, all further writes fail for lack of space; if false, writes succeed again. */
void disk_fill(bool full);
/* Makes the N-th write from now on and all later writes fail for lack of space; if `write` is 0,
 * all writes succeed. */
void disk_fill_at(long write);
/* Makes the N-th sync from now on fail; if `sync` is 0, all syncs succeed. */
void disk_fail_at(long sync);
/* If `held` is true, all syncs wait until this function is called with false. */
void disk_hold(bool held);
/* Returns the number of syncs since the last disk_fill_at or disk_fail_at. */
long disk_syncs(void);
/* Returns the number of open connections that may write to a database. */
long disk_writers(void);

#endif
