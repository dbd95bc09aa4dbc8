/* sqlite_index.c - compares the table of meshes with its indexes. If the index entry of a mesh is
 * damaged, the mesh seems not to exist, and another mesh could be created with its id.
 *
 * SQLite's integrity_check looks up each row in each index, at random places of the file, which
 * takes half a minute for a million meshes. The functions below read the table and its indexes
 * sequentially. The table and an index agree if quick_check finds their structure intact, if the
 * entries of the index are sorted, so that a lookup finds every entry, and if the sum of the hashes
 * of all entries equals the sum of the hashes of all rows. */
#include "base/siphash.h"
#include "journal/sqlite/sqlite_state.h"

#include <string.h>

enum { ROWS, IDS, INCARNATIONS, STATEMENTS };
static const char *const texts[STATEMENTS] = {
    [ROWS] = "SELECT key, id, incarnation FROM mesh NOT INDEXED",
    [IDS] = "SELECT key, id FROM mesh INDEXED BY sqlite_autoindex_mesh_1 ORDER BY id",
    [INCARNATIONS] = "SELECT key, incarnation FROM mesh INDEXED BY sqlite_autoindex_mesh_2 "
                     "ORDER BY incarnation",
};

/* Sums of hashes over the ids of all meshes and over their incarnations (numbers that no two meshes
 * share). Each hash includes the key of the row. */
typedef struct sums {
    uint64_t ids, incarnations;
} sums;

static uint64_t hash_of(const st_sqlite *self, int64_t key, const void *bytes, size_t size)
{
    const uint64_t seed[2] = {self->identity.secret[0] ^ (uint64_t)key, self->identity.secret[1]};
    return he_siphash_of(seed, bytes, size);
}

static uint64_t hash_of_text(const st_sqlite *self, sqlite3_stmt *s, int column)
{
    const void *text = sqlite3_column_text(s, column);
    return hash_of(self, sqlite3_column_int64(s, 0), text == NULL ? "" : text,
                   (size_t)sqlite3_column_bytes(s, column));
}

static uint64_t hash_of_word(const st_sqlite *self, sqlite3_stmt *s, int column)
{
    const uint64_t word = st_db_word(s, column);
    return hash_of(self, sqlite3_column_int64(s, 0), &word, sizeof word);
}

static st_sql sum_rows(const st_sqlite *self, st_db *db, sums *out)
{
    sqlite3_stmt *s;
    st_sql outcome = st_db_find(db, ROWS, &s, "");
    for (; outcome == ST_SQL_ROW; outcome = st_db_step(db, s)) {
        out->ids += hash_of_text(self, s, 1);
        out->incarnations += hash_of_word(self, s, 2);
    }
    return outcome;
}

static st_sql sum_ids(const st_sqlite *self, st_db *db, sums *out)
{
    char last[ST_MESH_ID + 1] = "", id[ST_MESH_ID + 1];
    sqlite3_stmt *s;
    st_sql outcome = st_db_find(db, IDS, &s, "");
    for (; outcome == ST_SQL_ROW; outcome = st_db_step(db, s)) {
        st_db_text(s, 1, id, sizeof id);
        if (strcmp(last, id) >= 0) {
            st_db_reset(s);
            return ST_SQL_DAMAGED;
        }
        memcpy(last, id, sizeof last);
        out->ids += hash_of_text(self, s, 1);
    }
    return outcome;
}

static st_sql sum_incarnations(const st_sqlite *self, st_db *db, sums *out)
{
    int64_t last = INT64_MIN;
    bool first = true;
    sqlite3_stmt *s;
    st_sql outcome = st_db_find(db, INCARNATIONS, &s, "");
    for (; outcome == ST_SQL_ROW; outcome = st_db_step(db, s)) {
        const int64_t incarnation = sqlite3_column_int64(s, 1);
        if (!first && incarnation <= last) {
            st_db_reset(s);
            return ST_SQL_DAMAGED;
        }
        first = false;
        last = incarnation;
        out->incarnations += hash_of_word(self, s, 1);
    }
    return outcome;
}

static st_sql quick_check(st_db *db)
{
    sqlite3_stmt *s = NULL;
    int code = sqlite3_prepare_v2(db->handle, "PRAGMA quick_check('mesh')", -1, &s, NULL);
    code = code == SQLITE_OK ? sqlite3_step(s) : code;
    const char *said = code == SQLITE_ROW ? (const char *)sqlite3_column_text(s, 0) : NULL;
    st_sql outcome = said == NULL              ? st_db_outcome(db, code)
                     : strcmp(said, "ok") == 0 ? ST_SQL_DONE
                                               : ST_SQL_DAMAGED;
    sqlite3_finalize(s);
    return outcome;
}

st_sql st_index_check(st_sqlite *self)
{
    st_db db = {.handle = self->db.handle, .texts = texts};
    sums rows = {0, 0}, entries = {0, 0};
    st_sql outcome = quick_check(&db);
    if (outcome == ST_SQL_DONE) {
        outcome = sum_rows(self, &db, &rows);
    }
    if (outcome == ST_SQL_DONE) {
        outcome = sum_ids(self, &db, &entries);
    }
    if (outcome == ST_SQL_DONE) {
        outcome = sum_incarnations(self, &db, &entries);
    }
    for (size_t i = 0; i < STATEMENTS; i++) {
        sqlite3_finalize(db.statements[i]);
    }
    const bool same = rows.ids == entries.ids && rows.incarnations == entries.incarnations;
    return outcome == ST_SQL_DONE && !same ? ST_SQL_DAMAGED : outcome;
}
