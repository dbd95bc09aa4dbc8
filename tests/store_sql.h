/* store_sql.h - SQL on the database in a store's folder, beside the store or while it is closed:
 * what is on the disk, and damage to it. */
#ifndef TESTS_STORE_SQL_H
#define TESTS_STORE_SQL_H

#include "tests/store_folder.h"

#include <stdint.h>

/* Runs statements; fails the test if one of them fails. */
void store_sql_run(const char *folder, const char *sql);
/* Returns the number in the first column and row of the result of a query. */
int64_t store_sql_number(const char *folder, const char *sql);
/* Waits until nothing is left to purge. A deleted content is purged in steps between commits, so
 * this function commits until all is gone. */
void store_sql_wait_for_purge(const char *folder, const told_journal *told);

#endif
