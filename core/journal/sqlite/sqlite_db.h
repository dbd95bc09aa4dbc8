/* sqlite_db.h - one connection to the database, and the outcomes of its statements. Only this
 * header includes SQLite's.
 *
 * A connection has a table of statements, each prepared at its first use. It is used by one thread
 * at a time. */
#ifndef HE_JOURNAL_SQLITE_DB_H
#define HE_JOURNAL_SQLITE_DB_H

#include <sqlite3.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* The outcome of a statement. After anything from ST_SQL_FULL on, the caller must roll the
 * transaction back. */
typedef enum st_sql {
    ST_SQL_DONE,
    ST_SQL_ROW,       /* a row can be read */
    ST_SQL_FULL,      /* the disk, or the user's quota, is full */
    ST_SQL_BUSY,      /* another program has locked the database */
    ST_SQL_NO_MEMORY, /* a retry may succeed */
    ST_SQL_DAMAGED,   /* stored bytes are damaged */
    ST_SQL_FAILED     /* a write, sync or read failed, or the database lacks something that must be
                         there */
} st_sql;

enum { ST_DB_STATEMENTS = 40 };

typedef struct st_db {
    sqlite3 *handle;
    const char *const *texts; /* texts of the statements; NULL: no such statement */
    sqlite3_stmt *statements[ST_DB_STATEMENTS];
} st_db;

/* Makes SQLite allocate by base/mem.h, counted but never refused by the budget. Every function that
 * opens a database calls it; only the first call has an effect. Returns false if SQLite cannot
 * start. */
bool st_db_prepare(void);

/* Opens a connection. `flags` are SQLite's; `texts` has `count` statements and must outlive the
 * connection. The caller closes the connection after a failure too. */
st_sql st_db_open(st_db *db, const char *path, int flags, const char *const *texts, size_t count);
/* Limits the pages that the connection caches: `kib` if the memory budget is 256 MiB or more, in
 * proportion below, because SQLite is never refused memory. */
st_sql st_db_set_cache(st_db *db, unsigned kib);
/* Returns false if SQLite fails to close. */
bool st_db_close(st_db *db);
/* Returns SQLite's last message about the connection. */
const char *st_db_message(const st_db *db);

/* Runs a text of SQL without parameters, such as a pragma, and ignores its rows. */
st_sql st_db_run(st_db *db, const char *text);
/* Runs a text of SQL and reads the first number of the first row; `otherwise` if there is no
 * row. */
st_sql st_db_number(st_db *db, const char *text, int64_t otherwise, int64_t *out);

/* Binds the parameters of statement `which` as `format` says, a letter each, and takes the first
 * step:
 *     i  int64_t or uint64_t        d  double
 *     t  const char *               b  const void *, size_t
 * Texts and bytes are borrowed until the statement is reset. With ST_SQL_ROW *out is the statement:
 * the caller reads it, steps on with st_db_step, and resets it with st_db_reset. With any other
 * outcome it is reset already. */
st_sql st_db_find(st_db *db, unsigned which, sqlite3_stmt **out, const char *format, ...);
st_sql st_db_step(st_db *db, sqlite3_stmt *statement);
void st_db_reset(sqlite3_stmt *statement); /* takes NULL */
/* Runs a statement that returns no rows. Its parameters are those of st_db_find. */
st_sql st_db_do(st_db *db, unsigned which, const char *format, ...);
/* Begins a transaction with statement `begin`. If there was no memory to end the last one,
 * statement `end` ends it first. */
st_sql st_db_begin(st_db *db, unsigned begin, unsigned end);
/* Turns a result code of SQLite into ST_SQL_DONE or a failure. */
st_sql st_db_outcome(const st_db *db, int code);

static inline uint64_t st_db_word(sqlite3_stmt *statement, int column)
{
    return (uint64_t)sqlite3_column_int64(statement, column);
}
/* Copies a text, cut to `size` bytes with its NUL. */
void st_db_text(sqlite3_stmt *statement, int column, char *out, size_t size);
/* Returns the bytes of a column; NULL if it is empty. */
const unsigned char *st_db_bytes(sqlite3_stmt *statement, int column, size_t *size);

#endif
