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

/* The statement that reads the table, and one for each index. */
enum { IDS, INCARNATIONS, NAMES, TIMES, SIZES, INDEXES, ROWS = INDEXES, STATEMENTS };
static const char *const texts[STATEMENTS] = {
    [ROWS] = "SELECT key, id, incarnation, name, modified, bytes FROM mesh NOT INDEXED",
    [IDS] = "SELECT key, id FROM mesh INDEXED BY sqlite_autoindex_mesh_1 ORDER BY id",
    [INCARNATIONS] = "SELECT key, incarnation FROM mesh INDEXED BY sqlite_autoindex_mesh_2 "
                     "ORDER BY incarnation",
    [NAMES] = "SELECT key, name, id FROM mesh INDEXED BY mesh_by_name "
              "ORDER BY name COLLATE NOCASE, id",
    [TIMES] = "SELECT key, modified, id FROM mesh INDEXED BY mesh_by_modified "
              "ORDER BY modified, id",
    [SIZES] = "SELECT key, bytes, id FROM mesh INDEXED BY mesh_by_bytes ORDER BY bytes, id",
};

/* The columns that have indexes; the numbers are those of the columns that ROWS selects. */
typedef enum indexed_column { ID = 1, INCARNATION, NAME, MODIFIED, BYTES } indexed_column;
enum { MOST_COLUMNS = 2 };

static int by_id(const st_card *a, const st_card *b)
{
    return strcmp(a->id, b->id);
}

static int by_incarnation(const st_card *a, const st_card *b)
{
    const int64_t x = (int64_t)a->incarnation, y = (int64_t)b->incarnation;
    return (x > y) - (x < y);
}

static int by_name(const st_card *a, const st_card *b)
{
    return st_card_compare(ST_BY_NAME, a, b);
}

static int by_modified(const st_card *a, const st_card *b)
{
    return st_card_compare(ST_BY_MODIFIED, b, a);
}

static int by_bytes(const st_card *a, const st_card *b)
{
    return st_card_compare(ST_BY_BYTES, b, a);
}

/* The columns of each index, in the order in which its statement selects them after the key, and
 * the order of its entries. */
static const struct {
    size_t count;
    indexed_column columns[MOST_COLUMNS];
    int (*compare)(const st_card *a, const st_card *b);
} indexes[INDEXES] = {
    [IDS] = {1, {ID}, by_id},
    [INCARNATIONS] = {1, {INCARNATION}, by_incarnation},
    [NAMES] = {2, {NAME, ID}, by_name},
    [TIMES] = {2, {MODIFIED, ID}, by_modified},
    [SIZES] = {2, {BYTES, ID}, by_bytes},
};

/* The sums of the hashes of the entries of each index. Each hash includes the key of the row. */
typedef struct sums {
    uint64_t of[INDEXES];
} sums;

/* Adds the value of the column that is in place `at` of a statement to a hash. */
static uint64_t add_value(uint64_t hash, sqlite3_stmt *s, int at, indexed_column column)
{
    const uint64_t seed[2] = {hash, (uint64_t)column};
    if (column == ID || column == NAME) {
        const void *text = sqlite3_column_text(s, at);
        return he_siphash_of(seed, text == NULL ? "" : text, (size_t)sqlite3_column_bytes(s, at));
    }
    if (column == MODIFIED) {
        const double time = sqlite3_column_double(s, at);
        return he_siphash_of(seed, &time, sizeof time);
    }
    const uint64_t word = st_db_word(s, at);
    return he_siphash_of(seed, &word, sizeof word);
}

/* Returns the hash with which the hashes of a row's entries begin. */
static uint64_t hash_of_key(const st_sqlite *self, sqlite3_stmt *s)
{
    const int64_t key = sqlite3_column_int64(s, 0);
    return he_siphash_of(self->identity.secret, &key, sizeof key);
}

static st_sql sum_rows(const st_sqlite *self, st_db *db, sums *out)
{
    sqlite3_stmt *s;
    st_sql outcome = st_db_find(db, ROWS, &s, "");
    for (; outcome == ST_SQL_ROW; outcome = st_db_step(db, s)) {
        const uint64_t key = hash_of_key(self, s);
        for (size_t i = 0; i < INDEXES; i++) {
            uint64_t hash = key;
            for (size_t k = 0; k < indexes[i].count; k++) {
                const indexed_column column = indexes[i].columns[k];
                hash = add_value(hash, s, (int)column, column);
            }
            out->of[i] += hash;
        }
    }
    return outcome;
}

/* Copies the value in place `at` of a statement to the member of a card that the column has. */
static void read_value(sqlite3_stmt *s, int at, indexed_column column, st_card *out)
{
    switch (column) {
    case ID:
        st_db_text(s, at, out->id, sizeof out->id);
        break;
    case INCARNATION:
        out->incarnation = st_db_word(s, at);
        break;
    case NAME:
        st_db_text(s, at, out->name, sizeof out->name);
        break;
    case MODIFIED:
        out->modified = sqlite3_column_double(s, at);
        break;
    case BYTES:
        out->bytes = st_db_word(s, at);
        break;
    }
}

static st_sql sum_entries(const st_sqlite *self, st_db *db, size_t index, sums *out)
{
    st_card entries[2] = {{.bytes = 0}};
    size_t now = 0;
    bool first = true;
    sqlite3_stmt *s;
    st_sql outcome = st_db_find(db, (unsigned)index, &s, "");
    for (; outcome == ST_SQL_ROW; outcome = st_db_step(db, s)) {
        uint64_t hash = hash_of_key(self, s);
        for (size_t k = 0; k < indexes[index].count; k++) {
            const indexed_column column = indexes[index].columns[k];
            hash = add_value(hash, s, (int)k + 1, column);
            read_value(s, (int)k + 1, column, &entries[now]);
        }
        if (!first && indexes[index].compare(&entries[1 - now], &entries[now]) >= 0) {
            st_db_reset(s);
            return ST_SQL_DAMAGED;
        }
        first = false;
        now = 1 - now;
        out->of[index] += hash;
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
    sums rows = {{0}}, entries = {{0}};
    st_sql outcome = quick_check(&db);
    if (outcome == ST_SQL_DONE) {
        outcome = sum_rows(self, &db, &rows);
    }
    for (size_t i = 0; i < INDEXES && outcome == ST_SQL_DONE; i++) {
        outcome = sum_entries(self, &db, i, &entries);
    }
    for (size_t i = 0; i < STATEMENTS; i++) {
        sqlite3_finalize(db.statements[i]);
    }
    const bool same = memcmp(&rows, &entries, sizeof rows) == 0;
    return outcome == ST_SQL_DONE && !same ? ST_SQL_DAMAGED : outcome;
}
