/* sqlite_db.h - one connection to the database, and what its statements come to. This header alone
 * includes SQLite's.
 *
 * A connection has a table of statements, each prepared at its first use. It is used by one thread
 * at a time. */
#ifndef HE_JOURNAL_SQLITE_DB_H
#define HE_JOURNAL_SQLITE_DB_H

#include <sqlite3.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* How a statement went. After anything below ST_SQL_ROW the transaction is to be rolled back. */
typedef enum st_sql {
    ST_SQL_DONE,
    ST_SQL_ROW,       /* there is a row to be read */
    ST_SQL_FULL,      /* the disk, or its user's share of it, is full */
    ST_SQL_BUSY,      /* another program has locked the database */
    ST_SQL_NO_MEMORY, /* the same may succeed later */
    ST_SQL_DAMAGED,   /* what was read cannot be */
    ST_SQL_FAILED     /* a write, a sync, a read failed, or the database lacks what must be there */
} st_sql;

enum { ST_DB_STATEMENTS = 40 };

typedef struct st_db {
    sqlite3 *handle;
    const char *const *texts; /* of the statements; NULL: a statement that is not there */
    sqlite3_stmt *statements[ST_DB_STATEMENTS];
} st_db;

/* Has SQLite take its memory from base/mem.h, counted but not refused by the budget. Called by
 * every opener; only the first call does something. False when SQLite cannot start. */
bool st_db_prepare(void);

/* `flags` are SQLite's; `texts` has `count` statements and outlives the connection. The caller
 * closes the connection after a failure too. */
st_sql st_db_open(st_db *db, const char *path, int flags, const char *const *texts, size_t count);
/* Bounds the pages that the connection keeps in memory: `kib` where the memory budget is 256 MiB or
 * more, in proportion below, because SQLite is never refused memory. */
st_sql st_db_set_cache(st_db *db, unsigned kib);
/* False where SQLite refuses. */
bool st_db_close(st_db *db);
/* What SQLite last said about the connection. */
const char *st_db_message(const st_db *db);

/* Statements without parameters and rows, such as a pragma: rows are passed over. */
st_sql st_db_run(st_db *db, const char *text);
/* The first number of the first row; `otherwise` where there is none. */
st_sql st_db_number(st_db *db, const char *text, int64_t otherwise, int64_t *out);

/* Binds the parameters of statement `which` as `format` says, a letter each, and takes the first
 * step:
 *     i  int64_t or uint64_t        d  double
 *     t  const char *               b  const void *, size_t
 * Texts and bytes are borrowed until the statement is reset. With ST_SQL_ROW *out is the statement,
 * to be read, stepped on with st_db_step, and reset with st_db_reset; else it is reset already. */
st_sql st_db_find(st_db *db, unsigned which, sqlite3_stmt **out, const char *format, ...);
st_sql st_db_step(st_db *db, sqlite3_stmt *statement);
void st_db_reset(sqlite3_stmt *statement); /* takes NULL */
/* Runs a statement that returns no rows. */
st_sql st_db_do(st_db *db, unsigned which, const char *format, ...);
/* Turns a result code of SQLite into ST_SQL_DONE or a failure. */
st_sql st_db_outcome(const st_db *db, int code);

static inline uint64_t st_db_word(sqlite3_stmt *statement, int column)
{
    return (uint64_t)sqlite3_column_int64(statement, column);
}
/* Copies a text, cut to `size` bytes with its end. */
void st_db_text(sqlite3_stmt *statement, int column, char *out, size_t size);
/* The bytes of a column; NULL where there are none. */
const unsigned char *st_db_bytes(sqlite3_stmt *statement, int column, size_t *size);

#endif
