/* sqlite_keys.c - reads the stored Idempotency-Keys of requests, either those of one mesh or those
 * of the whole store. */
#include "journal/sqlite/sqlite_state.h"

#include <string.h>

/* Selects the keys that belong to the store and not to a mesh, if they are at most ?1 seconds older
 * than the newest such key. */
static const char of_store[] =
    "SELECT * FROM (SELECT " ST_KEPT_COLUMNS
    " FROM kept WHERE mesh = 0 AND time > (SELECT max(time) FROM kept WHERE mesh = 0) - ?1 "
    "ORDER BY time DESC LIMIT ?2) ORDER BY time";
static const char of_mesh[] =
    "SELECT * FROM (SELECT k.mesh, k.text, k.digest, k.time, k.id, k.incarnation, k.revision, "
    "k.metadata, k.position, k.made, k.sum, k.holder FROM kept k JOIN mesh m ON k.mesh = m.key "
    "WHERE m.id = ?3 AND k.time > m.modified - ?1 ORDER BY k.time DESC LIMIT ?2) ORDER BY time";

bool st_kept_row_read(sqlite3_stmt *s, st_kept_texts *texts, st_kept_row *row)
{
    st_db_text(s, 4, texts->id, sizeof texts->id);
    st_db_text(s, 1, texts->text, sizeof texts->text);
    st_db_text(s, 11, texts->holder, sizeof texts->holder);
    *row = (st_kept_row){.mesh = sqlite3_column_int64(s, 0),
                         .holder = texts->holder,
                         .text = texts->text,
                         .id = texts->id,
                         .time = sqlite3_column_double(s, 3),
                         .incarnation = st_db_word(s, 5),
                         .revision = st_db_word(s, 6),
                         .metadata = st_db_word(s, 7),
                         .position = st_db_word(s, 8),
                         .made = st_db_word(s, 9) != 0};
    const void *digest = sqlite3_column_blob(s, 2);
    if (digest == NULL || sqlite3_column_bytes(s, 2) != (int)sizeof row->digest) {
        return false;
    }
    memcpy(row->digest, digest, sizeof row->digest);
    return sqlite3_column_int64(s, 10) == (int64_t)st_kept_row_sum(row);
}

st_sql st_kept_count_damaged(st_db *db, uint64_t *out)
{
    sqlite3_stmt *s = NULL;
    st_kept_texts texts;
    st_kept_row row;
    *out = 0;
    int code = sqlite3_prepare_v2(db->handle, "SELECT " ST_KEPT_COLUMNS " FROM kept", -1, &s, NULL);
    while (code == SQLITE_OK && (code = sqlite3_step(s)) == SQLITE_ROW) {
        *out += st_kept_row_read(s, &texts, &row) ? 0 : 1;
        code = SQLITE_OK;
    }
    const st_sql outcome = code == SQLITE_OK ? ST_SQL_DONE : st_db_outcome(db, code);
    sqlite3_finalize(s);
    return outcome;
}

/* Passes a key to the function `take`. Damaged keys are passed, too, so that a repeated request
 * with such a key is not executed again. */
static bool give(const st_kept_row *row, bool good, st_take_key *take, void *to)
{
    const st_kept_key key = {.key = {.text = row->text,
                                     .holder = row->holder,
                                     .digest = {row->digest[0], row->digest[1]},
                                     .time = row->time,
                                     .of_store = row->made},
                             .id = row->id,
                             .incarnation = row->incarnation,
                             .revision = row->revision,
                             .metadata = row->metadata,
                             .is_damaged = !good};
    return take(to, &key);
}

st_status st_sqlite_keys(void *context, const char *id, st_take_key *take, void *to)
{
    st_sqlite *self = context;
    sqlite3_stmt *s = NULL;
    st_kept_texts texts;
    st_kept_row row;
    bool taken = true;
    uint64_t damaged = 0;
    if (self->only_reads) {
        /* A journal that is open only for reading passes no keys. It does not need them, and
         * damaged keys must not prevent it from reading the mesh. */
        return ST_OK;
    }
    pthread_mutex_lock(&self->cards_lock);
    int code =
        sqlite3_prepare_v2(self->cards.handle, id == NULL ? of_store : of_mesh, -1, &s, NULL);
    if (code == SQLITE_OK) {
        sqlite3_bind_int(s, 1, ST_KEPT_SECONDS);
        sqlite3_bind_int(s, 2, ST_KEPT_KEYS);
        code = id == NULL ? SQLITE_OK : sqlite3_bind_text(s, 3, id, -1, SQLITE_STATIC);
    }
    while (code == SQLITE_OK && taken && (code = sqlite3_step(s)) == SQLITE_ROW) {
        code = SQLITE_OK;
        const bool good = st_kept_row_read(s, &texts, &row);
        taken = give(&row, good, take, to);
        damaged += good ? 0 : 1;
    }
    const st_sql outcome = code == SQLITE_OK ? ST_SQL_DONE : st_db_outcome(&self->cards, code);
    sqlite3_finalize(s);
    pthread_mutex_unlock(&self->cards_lock);
    if (damaged > 0) {
        pthread_mutex_lock(&self->lock);
        self->damaged_keys += damaged;
        pthread_mutex_unlock(&self->lock);
    }
    if (!taken || outcome == ST_SQL_NO_MEMORY) {
        return ST_NO_MEMORY;
    }
    return outcome == ST_SQL_DONE ? ST_OK : ST_FAILED;
}
