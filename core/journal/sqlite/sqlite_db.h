/* sqlite_db.h - one connection to the database, and the outcomes of its statements. Only this
 * header includes SQLite's.
 *
 * A connection has a table of statements; a statement is prepared when it is first used. Only one
 * thread at a time may use a connection. */
#ifndef HE_JOURNAL_SQLITE_DB_H
#define HE_JOURNAL_SQLITE_DB_H

#include <sqlite3.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* The outcome of a statement. If it is ST_SQL_FULL or a later constant, the caller must roll the
 * transaction back. */
typedef enum st_sql {
    ST_SQL_DONE,
    ST_SQL_ROW,       /* a row can be read */
    ST_SQL_FULL,      /* the disk is full, or the user's quota is used up */
    ST_SQL_BUSY,      /* another program has locked the database */
    ST_SQL_NO_MEMORY, /* memory is out; a retry may succeed */
    ST_SQL_DAMAGED,   /* stored bytes are damaged */
    ST_SQL_FAILED     /* a write, sync or read failed, or the database lacks something that must be
                         there */
} st_sql;

enum { ST_DB_STATEMENTS = 40 };

typedef struct st_db {
    sqlite3 *handle;
    /* texts: the SQL text of each statement, by its number; NULL: no statement has this number */
    const char *const *texts;
    sqlite3_stmt *statements[ST_DB_STATEMENTS];
} st_db;

/* Makes SQLite allocate memory through base/mem.h, which counts it but never refuses it. Every
 * function that opens a database calls it; only the first call has an effect. Returns false if
 * SQLite cannot start. */
bool st_db_prepare(void);

/* Opens a connection. `flags` are SQLite's; `texts` has `count` statements and must outlive the
 * connection. The caller must close the connection even after a failure. */
st_sql st_db_open(st_db *db, const char *path, int flags, const char *const *texts, size_t count);
/* Limits the connection's cache of pages to `kib` KiB, or to proportionally less if the memory
 * budget is below 256 MiB. The limit is needed because the budget refuses SQLite no memory. */
st_sql st_db_set_cache(st_db *db, unsigned kib);
/* Closes the connection. Returns false if SQLite fails to close it. */
bool st_db_close(st_db *db);
/* Returns the last error message of SQLite about the connection. */
const char *st_db_message(const st_db *db);

/* Runs a text of SQL without parameters, such as a pragma, and ignores its rows. */
st_sql st_db_run(st_db *db, const char *text);
/* Runs a text of SQL and stores in *out the number in the first column of its first row, or
 * `otherwise` if there is no row. */
st_sql st_db_number(st_db *db, const char *text, int64_t otherwise, int64_t *out);

/* Binds the parameters of statement `which` and takes the first step. `format` has a letter for
 * each parameter:
 *     i  int64_t or uint64_t        d  double
 *     t  const char *               b  const void *, size_t
 * Texts and bytes are borrowed until the statement is reset. With ST_SQL_ROW *out is the statement:
 * the caller reads its row, gets the next row by st_db_step, and ends it by st_db_reset. With any
 * other outcome the statement is reset already. */
st_sql st_db_find(st_db *db, unsigned which, sqlite3_stmt **out, const char *format, ...);
st_sql st_db_step(st_db *db, sqlite3_stmt *statement);
void st_db_reset(sqlite3_stmt *statement); /* takes NULL */
/* Runs a statement that returns no rows. Parameters are passed as to st_db_find. */
st_sql st_db_do(st_db *db, unsigned which, const char *format, ...);
/* Begins a transaction by the statement number `begin`. If a lack of memory has left the last
 * transaction open, the statement number `end` ends that transaction first. */
st_sql st_db_begin(st_db *db, unsigned begin, unsigned end);
/* Turns a result code of SQLite into ST_SQL_DONE or the constant of a failure. */
st_sql st_db_outcome(const st_db *db, int code);

static inline uint64_t st_db_word(sqlite3_stmt *statement, int column)
{
    return (uint64_t)sqlite3_column_int64(statement, column);
}
/* Copies the text of a column to `out`, cut to `size` bytes with its NUL. */
void st_db_text(sqlite3_stmt *statement, int column, char *out, size_t size);
/* Returns the bytes of a column; NULL if the column is empty. */
const unsigned char *st_db_bytes(sqlite3_stmt *statement, int column, size_t *size);

#endif
