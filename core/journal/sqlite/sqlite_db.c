#include "journal/sqlite/sqlite_db.h"

#include "base/mem.h"
#include "system/memory.h"

#include <assert.h>
#include <errno.h>
#include <pthread.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

/* --- memory --- */

/* SQLite asks its allocator for the size of a block of memory, which base/mem.h cannot tell. So the
 * size is stored in the HEADER bytes before each block. */
enum { HEADER = 16, ROUND = 8 };

static void *block_resize(void *memory, int size)
{
    unsigned char *block = memory == NULL ? NULL : (unsigned char *)memory - HEADER;
    block = st_memory_resize_unrefused(block, (size_t)size + HEADER);
    if (block == NULL) {
        return NULL;
    }
    memcpy(block, &size, sizeof size);
    return block + HEADER;
}

static void *block_new(int size)
{
    return block_resize(NULL, size);
}

static void block_free(void *memory)
{
    if (memory != NULL) {
        he_mem_free((unsigned char *)memory - HEADER);
    }
}

static int block_size(void *memory)
{
    int size = 0;
    if (memory != NULL) {
        memcpy(&size, (unsigned char *)memory - HEADER, sizeof size);
    }
    return size;
}

static int block_round(int size)
{
    return (size + ROUND - 1) / ROUND * ROUND;
}

static int memory_start(void *context)
{
    (void)context;
    return SQLITE_OK;
}

static void memory_stop(void *context)
{
    (void)context;
}

static bool is_prepared;

static void prepare(void)
{
    static const sqlite3_mem_methods methods = {.xMalloc = block_new,
                                                .xFree = block_free,
                                                .xRealloc = block_resize,
                                                .xSize = block_size,
                                                .xRoundup = block_round,
                                                .xInit = memory_start,
                                                .xShutdown = memory_stop};
    is_prepared = sqlite3_config(SQLITE_CONFIG_MALLOC, &methods) == SQLITE_OK &&
                  sqlite3_config(SQLITE_CONFIG_MEMSTATUS, 0) == SQLITE_OK &&
                  sqlite3_initialize() == SQLITE_OK;
}

bool st_db_prepare(void)
{
    static pthread_once_t once = PTHREAD_ONCE_INIT;
    pthread_once(&once, prepare);
    return is_prepared;
}

/* --- connections --- */

/* How many milliseconds a statement waits for the lock of another program. */
enum { BUSY_MILLIS = 5000 };

st_sql st_db_open(st_db *db, const char *path, int flags, const char *const *texts, size_t count)
{
    assert(count <= ST_DB_STATEMENTS);
    *db = (st_db){.texts = texts};
    int code = sqlite3_open_v2(path, &db->handle, flags | SQLITE_OPEN_NOMUTEX, NULL);
    if (db->handle == NULL) {
        return ST_SQL_NO_MEMORY;
    }
    sqlite3_extended_result_codes(db->handle, 1);
    sqlite3_busy_timeout(db->handle, BUSY_MILLIS);
    /* When SQLite closes a database it makes a checkpoint, but reports no errors of it. So this
     * checkpoint is switched off, and st_db_close makes one itself. */
    sqlite3_db_config(db->handle, SQLITE_DBCONFIG_NO_CKPT_ON_CLOSE, 1, NULL);
    sqlite3_db_config(db->handle, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, NULL);
    sqlite3_db_config(db->handle, SQLITE_DBCONFIG_DEFENSIVE, 1, NULL);
    return st_db_outcome(db, code);
}

/* The smallest page cache of a connection is 16 pages, so that all pages on the way from the root
 * of a table's tree to a row fit into the cache. */
enum { LEAST_CACHE_KIB = 64, FULL_CACHE_BUDGET = 256 << 20 };

st_sql st_db_set_cache(st_db *db, unsigned kib)
{
    const uint64_t budget = st_memory_budget();
    uint64_t share =
        budget == 0 || budget >= FULL_CACHE_BUDGET ? kib : kib * budget / FULL_CACHE_BUDGET;
    char text[64];
    share = share < LEAST_CACHE_KIB ? LEAST_CACHE_KIB : share;
    /* The pragma cache_size takes a negative number as KiB and a positive number as pages. */
    (void)snprintf(text, sizeof text, "PRAGMA cache_size = -%u", (unsigned)share);
    return st_db_run(db, text);
}

bool st_db_close(st_db *db)
{
    for (size_t i = 0; i < ST_DB_STATEMENTS; i++) {
        sqlite3_finalize(db->statements[i]);
    }
    bool closed = sqlite3_close(db->handle) == SQLITE_OK;
    *db = (st_db){.texts = NULL};
    return closed;
}

const char *st_db_message(const st_db *db)
{
    return db->handle == NULL ? "no memory" : sqlite3_errmsg(db->handle);
}

st_sql st_db_outcome(const st_db *db, int code)
{
    switch (code & 0xff) {
    case SQLITE_OK:
    case SQLITE_DONE:
        return ST_SQL_DONE;
    case SQLITE_ROW:
        return ST_SQL_ROW;
    case SQLITE_FULL:
        return ST_SQL_FULL;
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
        return ST_SQL_BUSY;
    case SQLITE_NOMEM:
        return ST_SQL_NO_MEMORY;
    case SQLITE_CORRUPT:
    case SQLITE_NOTADB:
        return ST_SQL_DAMAGED;
    case SQLITE_IOERR:
        if (code == SQLITE_IOERR_NOMEM) {
            return ST_SQL_NO_MEMORY;
        }
        /* SQLite reports a full disk only if a write fails with ENOSPC, and never when it extends
         * the -shm file. So the error of the system is examined here. A sync that fails with ENOSPC
         * counts as a failure of the disk. */
        if (code == SQLITE_IOERR_WRITE || code == SQLITE_IOERR_SHMSIZE) {
            const int reason = sqlite3_system_errno(db->handle);
            return reason == EDQUOT || reason == ENOSPC ? ST_SQL_FULL : ST_SQL_FAILED;
        }
        return ST_SQL_FAILED;
    default:
        return ST_SQL_FAILED;
    }
}

/* --- statements --- */

st_sql st_db_number(st_db *db, const char *text, int64_t otherwise, int64_t *out)
{
    sqlite3_stmt *statement = NULL;
    int code = sqlite3_prepare_v2(db->handle, text, -1, &statement, NULL);
    int64_t number = otherwise;
    bool first = true;
    while (code == SQLITE_OK || code == SQLITE_ROW) {
        if (code == SQLITE_ROW && first) {
            number = sqlite3_column_int64(statement, 0);
            first = false;
        }
        code = sqlite3_step(statement);
    }
    sqlite3_finalize(statement);
    if (code == SQLITE_DONE) {
        *out = number;
    }
    return st_db_outcome(db, code);
}

st_sql st_db_run(st_db *db, const char *text)
{
    int64_t ignored;
    return st_db_number(db, text, 0, &ignored);
}

static int bind(sqlite3_stmt *statement, const char *format, va_list *values)
{
    int code = SQLITE_OK;
    for (int i = 1; format[i - 1] != '\0' && code == SQLITE_OK; i++) {
        switch (format[i - 1]) {
        case 'i':
            code = sqlite3_bind_int64(statement, i, va_arg(*values, int64_t));
            break;
        case 'd':
            code = sqlite3_bind_double(statement, i, va_arg(*values, double));
            break;
        case 't':
            code =
                sqlite3_bind_text(statement, i, va_arg(*values, const char *), -1, SQLITE_STATIC);
            break;
        case 'b': {
            const void *bytes = va_arg(*values, const void *);
            code = sqlite3_bind_blob64(statement, i, bytes, va_arg(*values, size_t), SQLITE_STATIC);
            break;
        }
        default:
            code = SQLITE_MISUSE;
        }
    }
    return code;
}

static st_sql start(st_db *db, unsigned which, sqlite3_stmt **out, const char *format,
                    va_list *values)
{
    sqlite3_stmt *statement = db->statements[which];
    int code = SQLITE_OK;
    if (statement == NULL) {
        code = sqlite3_prepare_v3(db->handle, db->texts[which], -1, SQLITE_PREPARE_PERSISTENT,
                                  &db->statements[which], NULL);
        statement = db->statements[which];
    }
    if (code == SQLITE_OK) {
        code = bind(statement, format, values);
    }
    if (code == SQLITE_OK) {
        code = sqlite3_step(statement);
    }
    *out = code == SQLITE_ROW ? statement : NULL;
    if (code != SQLITE_ROW) {
        st_db_reset(statement);
    }
    return st_db_outcome(db, code);
}

st_sql st_db_find(st_db *db, unsigned which, sqlite3_stmt **out, const char *format, ...)
{
    va_list values;
    va_start(values, format);
    st_sql outcome = start(db, which, out, format, &values);
    va_end(values);
    return outcome;
}

st_sql st_db_do(st_db *db, unsigned which, const char *format, ...)
{
    sqlite3_stmt *statement;
    va_list values;
    va_start(values, format);
    st_sql outcome = start(db, which, &statement, format, &values);
    va_end(values);
    st_db_reset(statement);
    return outcome == ST_SQL_ROW ? ST_SQL_DONE : outcome;
}

st_sql st_db_begin(st_db *db, unsigned begin, unsigned end)
{
    st_sql outcome = ST_SQL_DONE;
    if (sqlite3_get_autocommit(db->handle) == 0) {
        outcome = st_db_do(db, end, "");
    }
    return outcome == ST_SQL_DONE ? st_db_do(db, begin, "") : outcome;
}

st_sql st_db_step(st_db *db, sqlite3_stmt *statement)
{
    int code = sqlite3_step(statement);
    if (code != SQLITE_ROW) {
        st_db_reset(statement);
    }
    return st_db_outcome(db, code);
}

void st_db_reset(sqlite3_stmt *statement)
{
    if (statement != NULL) {
        sqlite3_reset(statement);
        sqlite3_clear_bindings(statement);
    }
}

void st_db_text(sqlite3_stmt *statement, int column, char *out, size_t size)
{
    const unsigned char *text = sqlite3_column_text(statement, column);
    (void)snprintf(out, size, "%s", text == NULL ? "" : (const char *)text);
}

const unsigned char *st_db_bytes(sqlite3_stmt *statement, int column, size_t *size)
{
    const unsigned char *bytes = sqlite3_column_blob(statement, column);
    *size = bytes == NULL ? 0 : (size_t)sqlite3_column_bytes(statement, column);
    return bytes;
}
