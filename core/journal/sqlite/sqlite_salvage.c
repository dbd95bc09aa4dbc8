/* sqlite_salvage.c - reads database files whose structure is damaged: reports the faults, and finds
 * meshes without using indexes. The rows of the table of meshes are read in the order of their
 * keys. If a page of the table cannot be read, the keys that follow are tried one by one until the
 * row of a key can be read again. */
#include "journal/sqlite/sqlite_backup.h"
#include "journal/sqlite/sqlite_state.h"

#include <stdio.h>
#include <string.h>

enum { NEXT, AT, LAST, STATEMENTS };
static const char *const texts[STATEMENTS] = {
    [NEXT] = "SELECT " ST_MESH_COLUMNS " FROM mesh NOT INDEXED WHERE key > ?1 ORDER BY key LIMIT 1",
    [AT] = "SELECT " ST_MESH_COLUMNS " FROM mesh NOT INDEXED WHERE key = ?1",
    [LAST] = "SELECT max(key) FROM mesh NOT INDEXED",
};

/* --- faults of the file --- */

/* Passes each line of a text that SQLite returned to the function `say`. Returns the number of
 * lines. */
static unsigned tell_lines(const char *text, st_say *say, void *context)
{
    unsigned told = 0;
    while (*text != '\0') {
        char line[ST_SQLITE_MESSAGE];
        const size_t length = strcspn(text, "\n");
        (void)snprintf(line, sizeof line, "%.*s", (int)(length < 700 ? length : 700), text);
        text += length + (text[length] == '\n');
        if (strncmp(line, "***", 3) != 0 && line[0] != '\0') {
            say(context, line);
            told++;
        }
    }
    return told;
}

static unsigned check_structure(st_sqlite *self, st_say *say, void *context)
{
    unsigned told = 0;
    sqlite3_stmt *s = NULL;
    int code = sqlite3_prepare_v2(self->cards.handle, "PRAGMA integrity_check(100)", -1, &s, NULL);
    code = code == SQLITE_OK ? sqlite3_step(s) : code;
    for (; code == SQLITE_ROW; code = sqlite3_step(s)) {
        const char *said = (const char *)sqlite3_column_text(s, 0);
        if (said != NULL && strcmp(said, "ok") != 0) {
            told += tell_lines(said, say, context);
        }
    }
    if (code != SQLITE_DONE) {
        say(context, st_db_message(&self->cards));
        told++;
    }
    sqlite3_finalize(s);
    return told;
}

unsigned st_sqlite_faults(const st_journal *journal, st_say *say, void *context)
{
    st_sqlite *self = journal->self;
    st_identity identity;
    st_progress progress;
    unsigned told = check_structure(self, say, context);
    if (st_schema_check(&self->cards) != ST_SQL_DONE) {
        say(context, "the file does not have the tables of a store");
        told++;
    }
    if (st_identity_read(&self->cards, &identity) != ST_SQL_DONE) {
        say(context, "the version and settings of the store (table meta) cannot be read");
        told++;
    }
    if (st_progress_read(&self->cards, &progress) != ST_SQL_DONE) {
        say(context, "the number of its last commit (table state) cannot be read");
        told++;
    }
    self->salvage.on = told > 0;
    uint64_t damaged = 0;
    if (st_kept_count_damaged(&self->cards, &damaged) == ST_SQL_DONE && damaged > 0) {
        char text[96];
        (void)snprintf(text, sizeof text,
                       "%llu records of requests with an Idempotency-Key are damaged",
                       (unsigned long long)damaged);
        say(context, text);
        told++;
    }
    return told;
}

/* --- meshes by the keys of their rows --- */

static st_sql find_row(st_db *db, unsigned which, int64_t key, st_mesh_row *out)
{
    sqlite3_stmt *s;
    st_sql outcome = st_db_find(db, which, &s, "i", key);
    if (outcome == ST_SQL_ROW) {
        (void)st_sqlite_read_card(s, out);
        st_db_reset(s);
    }
    return outcome;
}

/* Returns the largest key that a row of the table of meshes can have, according to the counter of
 * keys and to the last row of the table. */
static int64_t last_key(st_db *db)
{
    int64_t counted = 0, found = 0;
    sqlite3_stmt *s;
    (void)st_db_number(db, "SELECT seq FROM sqlite_sequence WHERE name = 'mesh'", 0, &counted);
    if (st_db_find(db, LAST, &s, "") == ST_SQL_ROW) {
        found = sqlite3_column_int64(s, 0);
        st_db_reset(s);
    }
    return found > counted ? found : counted;
}

/* Reads the next row of the table of meshes, skipping rows that cannot be read. Returns ST_SQL_DONE
 * after the last row. */
static st_sql next_row(st_db *db, int64_t after, st_mesh_row *out)
{
    st_sql outcome = find_row(db, NEXT, after, out);
    if (outcome != ST_SQL_DAMAGED) {
        return outcome;
    }
    const int64_t last = last_key(db);
    for (int64_t key = after + 1; key <= last; key++) {
        outcome = find_row(db, AT, key, out);
        if (outcome != ST_SQL_DAMAGED && outcome != ST_SQL_DONE) {
            return outcome;
        }
    }
    return ST_SQL_DONE;
}

static void finalize(st_db *db)
{
    for (size_t i = 0; i < STATEMENTS; i++) {
        sqlite3_finalize(db->statements[i]);
    }
}

st_sql st_salvage_list(st_sqlite *self, bool from_start, st_card *out, size_t limit, size_t *count)
{
    st_salvager *salvage = &self->salvage;
    st_db db = {.handle = self->cards.handle, .texts = texts};
    st_sql outcome = ST_SQL_ROW;
    salvage->last = from_start ? 0 : salvage->last;
    salvage->count = 0;
    limit = limit < ST_SALVAGE_PAGE ? limit : ST_SALVAGE_PAGE;
    while (salvage->count < limit) {
        st_mesh_row row;
        outcome = next_row(&db, salvage->last, &row);
        if (outcome != ST_SQL_ROW) {
            break;
        }
        salvage->last = salvage->page[salvage->count].key = row.key;
        memcpy(salvage->page[salvage->count].id, row.card.id, sizeof row.card.id);
        out[salvage->count++] = row.card;
    }
    *count = salvage->count;
    finalize(&db);
    return outcome == ST_SQL_ROW ? ST_SQL_DONE : outcome;
}

st_sql st_salvage_find(st_sqlite *self, st_db *reader, const char *id, st_mesh_row *out)
{
    const st_salvager *salvage = &self->salvage;
    st_db db = {.handle = reader->handle, .texts = texts};
    st_sql outcome = ST_SQL_DONE;
    for (size_t i = 0; i < salvage->count && outcome == ST_SQL_DONE; i++) {
        if (strcmp(salvage->page[i].id, id) == 0) {
            outcome = find_row(&db, AT, salvage->page[i].key, out);
        }
    }
    finalize(&db);
    return outcome;
}
