/* disk.h - a disk that a test can make full, slow or failing. From disk_install on it is SQLite's
 * default; other programs and other files of the store do not use it. */
#ifndef TESTS_DISK_H
#define TESTS_DISK_H

#include <stdbool.h>

/* Call it before the first store of the process is opened. */
void disk_install(void);
/* From now on writes fail for lack of space, or no longer do. */
void disk_fill(bool full);
/* The N-th write from now on and all later ones fail for lack of space; 0: none does. */
void disk_fill_at(long write);
/* The N-th sync from now on fails; 0: none does. */
void disk_fail_at(long sync);
/* Holds syncs until they are released. */
void disk_hold(bool held);
/* Returns the number of syncs since the last disk_fill_at or disk_fail_at. */
long disk_syncs(void);
/* Returns the number of open connections to a database that may write. */
long disk_writers(void);

#endif
