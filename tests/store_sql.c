#include "tests/store_sql.h"

#include <setjmp.h>
#include <sqlite3.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

static sqlite3 *open_database(const char *folder)
{
    char path[2 * FOLDER_PATH];
    sqlite3 *db;
    (void)snprintf(path, sizeof path, "%s/hedge.db", folder);
    assert_int_equal(sqlite3_open(path, &db), SQLITE_OK);
    return db;
}

void store_sql_run(const char *folder, const char *sql)
{
    sqlite3 *db = open_database(folder);
    char *message = NULL;
    if (sqlite3_exec(db, sql, NULL, NULL, &message) != SQLITE_OK) {
        fail_msg("%s: %s", sql, message);
    }
    assert_int_equal(sqlite3_close(db), SQLITE_OK);
}

int64_t store_sql_number(const char *folder, const char *sql)
{
    sqlite3 *db = open_database(folder);
    sqlite3_stmt *s;
    assert_int_equal(sqlite3_prepare_v2(db, sql, -1, &s, NULL), SQLITE_OK);
    assert_int_equal(sqlite3_step(s), SQLITE_ROW);
    int64_t number = sqlite3_column_int64(s, 0);
    sqlite3_finalize(s);
    assert_int_equal(sqlite3_close(db), SQLITE_OK);
    return number;
}

void store_sql_wait_for_purge(const char *folder, const told_journal *told)
{
    const st_journal *j = &told->journal;
    const st_room_need need = {.records = 1};
    st_room *room;
    st_card card;
    do {
        assert_int_equal(j->reserve(j->self, &need, &room), ST_OK);
        j->leave(j->self, room);
        assert_int_equal(j->open(j->self, "none", &card, NULL), ST_ABSENT);
    } while (store_sql_number(folder, "SELECT count(*) FROM purge") > 0);
}
