/* store_sql.h - SQL on the database of a store, which may be open or closed: tests see what is on
 * the disk, and damage it. */
#ifndef TESTS_STORE_SQL_H
#define TESTS_STORE_SQL_H

#include "tests/store_folder.h"

#include <stdint.h>

/* Runs SQL statements; fails the test if one of them fails. */
void store_sql_run(const char *folder, const char *sql);
/* Returns the number in the first column and row of the result of a query. */
int64_t store_sql_number(const char *folder, const char *sql);
/* Waits until the store has erased the stored data of all deleted meshes. It does so in steps
 * between commits, so this function commits until nothing is left to erase. */
void store_sql_wait_for_purge(const char *folder, const told_journal *told);

#endif
