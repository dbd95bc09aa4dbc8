#include "journal/sqlite/sqlite_schema.h"

#include "journal/crc32c.h"

#include <string.h>

static const char *const tables[] = {
    "CREATE TABLE meta(name TEXT PRIMARY KEY, value, sum INTEGER NOT NULL) WITHOUT ROWID",
    "CREATE TABLE state(one INTEGER PRIMARY KEY CHECK (one = 1), commits INTEGER NOT NULL, "
    "position INTEGER NOT NULL, meshes INTEGER NOT NULL, sum INTEGER NOT NULL)",
    /* The key of a row of `mesh` is never used for another mesh, even if a new mesh gets the id of
     * a removed mesh. The columns `fence` and `node` always have their default values. */
    "CREATE TABLE mesh(key INTEGER PRIMARY KEY AUTOINCREMENT, id TEXT NOT NULL UNIQUE, "
    "name TEXT NOT NULL, incarnation INTEGER NOT NULL UNIQUE, origin INTEGER NOT NULL, "
    "metadata INTEGER NOT NULL, revision INTEGER NOT NULL, record INTEGER NOT NULL, "
    "chain INTEGER NOT NULL, created REAL NOT NULL, modified REAL NOT NULL, "
    "vertices INTEGER NOT NULL, edges INTEGER NOT NULL, faces INTEGER NOT NULL, "
    "boundary INTEGER NOT NULL, bytes INTEGER NOT NULL, base INTEGER NOT NULL, "
    "damage TEXT NOT NULL, fence INTEGER NOT NULL DEFAULT 0, node TEXT NOT NULL DEFAULT '', "
    "holder TEXT NOT NULL DEFAULT '', sum INTEGER NOT NULL)",
    /* The records of all meshes are in one table, which is stored as one tree, so that small
     * records share pages. */
    "CREATE TABLE record(mesh INTEGER, number INTEGER, bytes BLOB NOT NULL, "
    "PRIMARY KEY(mesh, number)) WITHOUT ROWID",
    "CREATE TABLE snapshot(key INTEGER PRIMARY KEY AUTOINCREMENT, mesh INTEGER NOT NULL, "
    "number INTEGER NOT NULL, revision INTEGER NOT NULL, parts INTEGER NOT NULL, "
    "process INTEGER NOT NULL, chain INTEGER NOT NULL, facts BLOB NOT NULL, sum INTEGER NOT NULL)",
    "CREATE INDEX snapshot_of_mesh ON snapshot(mesh, number)",
    "CREATE TABLE part(snapshot INTEGER, part INTEGER, bytes BLOB NOT NULL, "
    "PRIMARY KEY(snapshot, part))",
    "CREATE TABLE kept(mesh INTEGER, holder TEXT NOT NULL DEFAULT '', text TEXT, "
    "digest BLOB NOT NULL, time REAL NOT NULL, id TEXT NOT NULL, incarnation INTEGER NOT NULL, "
    "revision INTEGER NOT NULL, metadata INTEGER NOT NULL, position INTEGER NOT NULL, "
    "made INTEGER NOT NULL, sum INTEGER NOT NULL, PRIMARY KEY(mesh, holder, text)) WITHOUT ROWID",
    "CREATE INDEX kept_by_time ON kept(time)",
    "CREATE TABLE purge(kind INTEGER, key INTEGER, before INTEGER NOT NULL, sum INTEGER NOT NULL, "
    "PRIMARY KEY(kind, key)) WITHOUT ROWID",
    "CREATE TABLE job(id TEXT PRIMARY KEY, holder TEXT NOT NULL, number INTEGER NOT NULL, state "
    "INTEGER NOT NULL, operation TEXT NOT NULL, "
    "phase TEXT NOT NULL, mesh TEXT NOT NULL, location TEXT NOT NULL, progress REAL NOT NULL, "
    "created REAL NOT NULL, started REAL NOT NULL, finished REAL NOT NULL, "
    "status INTEGER NOT NULL, shown INTEGER NOT NULL, type TEXT NOT NULL, "
    "disposition TEXT NOT NULL, tag TEXT NOT NULL, warnings TEXT NOT NULL, body BLOB, "
    "sum INTEGER NOT NULL) WITHOUT ROWID",
    "CREATE INDEX job_by_end ON job(finished)",
    /* the orders in which meshes are listed (st_card_order) */
    "CREATE INDEX mesh_by_name ON mesh(name COLLATE NOCASE, id)",
    "CREATE INDEX mesh_by_modified ON mesh(modified, id)",
    "CREATE INDEX mesh_by_bytes ON mesh(bytes, id)",
};
enum { TABLES = sizeof tables / sizeof *tables };

/* How many of the tables above each version of the schema has. */
static const size_t tables_of[ST_SCHEMA_VERSION + 1] = {
    [1] = TABLES - 5, [2] = TABLES - 3, [3] = TABLES - 3, [4] = TABLES};

/* --- checksums --- */

static uint32_t begin(const char *table)
{
    return st_crc32c(0, table, strlen(table) + 1);
}

static uint32_t add_word(uint32_t sum, uint64_t word)
{
    return st_crc32c(sum, &word, sizeof word);
}

static uint32_t add_time(uint32_t sum, double time)
{
    return st_crc32c(sum, &time, sizeof time);
}

/* Adds a text and its NUL to a checksum. Without the NUL, the pairs of texts "a", "bc" and "ab",
 * "c" would have equal checksums. */
static uint32_t add_text(uint32_t sum, const char *text)
{
    return st_crc32c(sum, text, strlen(text) + 1);
}

uint32_t st_progress_sum(const st_progress *p)
{
    return add_word(add_word(add_word(begin("state"), p->commits), p->position), p->meshes);
}

uint32_t st_mesh_row_sum(const st_mesh_row *row)
{
    const st_card *card = &row->card;
    uint32_t sum = add_word(begin("mesh"), (uint64_t)row->key);
    sum = add_text(add_text(sum, card->id), card->name);
    sum = add_word(add_word(sum, card->incarnation), row->origin);
    sum = add_word(add_word(sum, card->metadata), card->revision);
    sum = add_word(add_word(sum, card->record), row->chain);
    sum = add_time(add_time(sum, card->created), card->modified);
    sum = add_word(add_word(sum, card->counts.vertices), card->counts.edges);
    sum = add_word(add_word(sum, card->counts.faces), card->counts.boundary);
    sum = add_word(add_word(sum, card->bytes), row->base);
    sum = add_text(sum, card->damage);
    /* If a mesh has no holder (owner), the column `holder` is left out of the checksum. So the
     * checksum equals that of older versions, which had no such column. */
    return card->holder[0] == '\0' ? sum : add_text(sum, card->holder);
}

uint32_t st_snapshot_row_sum(const st_snapshot_row *row)
{
    uint32_t sum = add_word(begin("snapshot"), (uint64_t)row->key);
    sum = add_word(add_word(sum, (uint64_t)row->mesh), row->number);
    sum = add_word(add_word(sum, row->revision), row->parts);
    sum = add_word(add_word(sum, row->process), row->chain);
    return st_crc32c(sum, row->facts, row->facts_size);
}

uint32_t st_purge_row_sum(const st_purge_row *row)
{
    return add_word(add_word(add_word(begin("purge"), row->kind), (uint64_t)row->key), row->before);
}

uint32_t st_kept_row_sum(const st_kept_row *row)
{
    uint32_t sum = add_text(add_word(begin("kept"), (uint64_t)row->mesh), row->text);
    /* If a key has no holder (owner), the column `holder` is left out of the checksum. So the
     * checksum equals that of older versions, which had no such column. */
    sum = row->holder[0] == '\0' ? sum : add_text(sum, row->holder);
    sum = add_time(add_word(add_word(sum, row->digest[0]), row->digest[1]), row->time);
    sum = add_word(add_text(sum, row->id), row->incarnation);
    sum = add_word(add_word(sum, row->revision), row->metadata);
    return add_word(add_word(sum, row->position), row->made ? 1 : 0);
}

uint32_t st_job_sum(const st_job *job)
{
    uint32_t sum = add_word(add_text(begin("job"), job->id), job->number);
    sum = add_text(add_text(add_word(sum, job->state), job->operation), job->phase);
    sum = add_text(add_text(add_text(sum, job->mesh), job->location), job->holder);
    sum = add_time(add_time(sum, job->progress), job->created);
    sum = add_time(add_time(sum, job->started), job->finished);
    sum = add_word(add_word(sum, (uint64_t)job->status), job->shown ? 1 : 0);
    for (size_t i = 0; i < ST_JOB_HEADERS; i++) {
        sum = add_text(sum, job->headers[i]);
    }
    sum = add_word(sum, job->body == NULL ? 0 : 1 + (uint64_t)job->length);
    return job->body == NULL ? sum : st_crc32c(sum, job->body, job->length);
}

uint32_t st_part_sum(int64_t snapshot, uint64_t part, const unsigned char *bytes, size_t size)
{
    return st_crc32c(add_word(add_word(begin("part"), (uint64_t)snapshot), part), bytes, size);
}

/* --- rows that are read --- */

static bool sum_is(sqlite3_stmt *statement, int column, uint32_t sum)
{
    return sqlite3_column_type(statement, column) == SQLITE_INTEGER &&
           sqlite3_column_int64(statement, column) == (int64_t)sum;
}

static uint32_t count_of(sqlite3_stmt *statement, int column)
{
    return (uint32_t)sqlite3_column_int64(statement, column);
}

bool st_mesh_row_read(sqlite3_stmt *s, st_mesh_row *out)
{
    *out = (st_mesh_row){.key = sqlite3_column_int64(s, 0)};
    st_card *card = &out->card;
    st_db_text(s, 1, card->id, sizeof card->id);
    st_db_text(s, 2, card->name, sizeof card->name);
    card->incarnation = st_db_word(s, 3);
    out->origin = st_db_word(s, 4);
    card->metadata = st_db_word(s, 5);
    card->revision = st_db_word(s, 6);
    card->record = st_db_word(s, 7);
    out->chain = st_db_word(s, 8);
    card->created = sqlite3_column_double(s, 9);
    card->modified = sqlite3_column_double(s, 10);
    card->counts = (st_counts){count_of(s, 11), count_of(s, 12), count_of(s, 13), count_of(s, 14)};
    card->bytes = st_db_word(s, 15);
    out->base = st_db_word(s, 16);
    st_db_text(s, 17, card->damage, sizeof card->damage);
    st_db_text(s, 19, card->holder, sizeof card->holder);
    return sum_is(s, 18, st_mesh_row_sum(out));
}

bool st_snapshot_row_read(sqlite3_stmt *s, st_snapshot_row *out)
{
    *out = (st_snapshot_row){.key = sqlite3_column_int64(s, 0),
                             .mesh = sqlite3_column_int64(s, 1),
                             .number = st_db_word(s, 2),
                             .revision = st_db_word(s, 3),
                             .parts = st_db_word(s, 4),
                             .process = st_db_word(s, 5),
                             .chain = st_db_word(s, 6)};
    out->facts = st_db_bytes(s, 7, &out->facts_size);
    return sum_is(s, 8, st_snapshot_row_sum(out));
}

bool st_purge_row_read(sqlite3_stmt *s, st_purge_row *out)
{
    *out = (st_purge_row){.kind = (st_purge_kind)sqlite3_column_int64(s, 0),
                          .key = sqlite3_column_int64(s, 1),
                          .before = st_db_word(s, 2)};
    return sum_is(s, 3, st_purge_row_sum(out));
}

/* Returns the text of a column, or "" if the column has no text; never NULL. */
static const char *text_of(sqlite3_stmt *s, int column)
{
    const unsigned char *text = sqlite3_column_text(s, column);
    return text == NULL ? "" : (const char *)text;
}

bool st_job_read(sqlite3_stmt *s, st_job *out)
{
    *out = (st_job){.number = st_db_word(s, 1),
                    .state = (st_job_state)sqlite3_column_int64(s, 2),
                    .operation = text_of(s, 3),
                    .phase = text_of(s, 4),
                    .mesh = text_of(s, 5),
                    .location = text_of(s, 6),
                    .holder = text_of(s, 7),
                    .progress = sqlite3_column_double(s, 8),
                    .created = sqlite3_column_double(s, 9),
                    .started = sqlite3_column_double(s, 10),
                    .finished = sqlite3_column_double(s, 11),
                    .status = (int)sqlite3_column_int64(s, 12),
                    .shown = st_db_word(s, 13) != 0};
    enum { HEADERS_AT = 14, BODY_AT = HEADERS_AT + ST_JOB_HEADERS, SUM_AT };
    st_db_text(s, 0, out->id, sizeof out->id);
    for (int i = 0; i < ST_JOB_HEADERS; i++) {
        out->headers[i] = text_of(s, HEADERS_AT + i);
    }
    if (sqlite3_column_type(s, BODY_AT) != SQLITE_NULL) {
        const void *bytes = st_db_bytes(s, BODY_AT, &out->length);
        out->body = bytes == NULL ? "" : bytes;
    }
    return out->state >= ST_JOB_ACCEPTED && out->state <= ST_JOB_CANCELLED &&
           sum_is(s, SUM_AT, st_job_sum(out));
}

/* --- the whole database --- */

#define SET_VERSION "PRAGMA user_version = 4"

enum { META_PUT, META_GET, STATE_PUT, STATE_GET, TABLE_GET, STATEMENTS };
static const char *const texts[STATEMENTS] = {
    [META_PUT] = "INSERT INTO meta VALUES (?1, ?2, ?3)",
    [META_GET] = "SELECT value, sum FROM meta WHERE name = ?1",
    [STATE_PUT] = "INSERT INTO state VALUES (1, ?1, ?2, ?3, ?4)",
    [TABLE_GET] = "SELECT 1 FROM sqlite_schema WHERE sql = ?1 AND sql LIKE '% ' || name || '%'",
    [STATE_GET] = "SELECT commits, position, meshes, sum FROM state",
};

/* Returns a copy of the connection `db` that uses the SQL statements of this file. */
static st_db borrowed(const st_db *db)
{
    return (st_db){.handle = db->handle, .texts = texts};
}

static void give_back(st_db *mine)
{
    for (size_t i = 0; i < STATEMENTS; i++) {
        sqlite3_finalize(mine->statements[i]);
    }
}

static uint32_t meta_sum(const char *name, uint64_t word, const char *text)
{
    return add_text(add_word(add_text(begin("meta"), name), word), text);
}

static st_sql put_meta(st_db *db, const char *name, uint64_t word)
{
    return st_db_do(db, META_PUT, "tii", name, word, (uint64_t)meta_sum(name, word, ""));
}

static st_sql make_rows(st_db *db, const st_identity *identity)
{
    static const st_progress nothing = {0, 0, 0};
    const uint64_t sum = meta_sum("made_by", 0, identity->made_by);
    st_sql outcome = put_meta(db, "store", identity->store);
    if (outcome == ST_SQL_DONE) {
        outcome = put_meta(db, "secret_1", identity->secret[0]);
    }
    if (outcome == ST_SQL_DONE) {
        outcome = put_meta(db, "secret_2", identity->secret[1]);
    }
    if (outcome == ST_SQL_DONE) {
        outcome = st_db_do(db, META_PUT, "tti", "made_by", identity->made_by, sum);
    }
    if (outcome == ST_SQL_DONE) {
        outcome = st_db_do(db, STATE_PUT, "iiii", nothing.commits, nothing.position, nothing.meshes,
                           (uint64_t)st_progress_sum(&nothing));
    }
    return outcome;
}

st_sql st_schema_make(st_db *db, const st_identity *identity)
{
    st_sql outcome = st_db_run(db, "BEGIN IMMEDIATE");
    for (size_t i = 0; i < TABLES && outcome == ST_SQL_DONE; i++) {
        outcome = st_db_run(db, tables[i]);
    }
    if (outcome == ST_SQL_DONE) {
        st_db mine = borrowed(db);
        outcome = make_rows(&mine, identity);
        give_back(&mine);
    }
    if (outcome == ST_SQL_DONE) {
        outcome = st_db_run(db, "PRAGMA application_id = 0x68656467");
    }
    if (outcome == ST_SQL_DONE) {
        outcome = st_db_run(db, SET_VERSION);
    }
    return outcome == ST_SQL_DONE ? st_db_run(db, "COMMIT") : outcome;
}

/* Reads the version of the schema. Returns ST_SQL_DAMAGED if no release ever wrote this version. */
static st_sql read_version(st_db *db, int64_t *out)
{
    st_sql outcome = st_db_number(db, "PRAGMA user_version", 0, out);
    return outcome == ST_SQL_DONE && (*out < 1 || *out > ST_SCHEMA_VERSION) ? ST_SQL_DAMAGED
                                                                            : outcome;
}

st_sql st_schema_raise(st_db *db)
{
    int64_t version;
    st_sql outcome = read_version(db, &version);
    if (outcome != ST_SQL_DONE || version == ST_SCHEMA_VERSION) {
        return outcome;
    }
    outcome = st_db_run(db, "BEGIN IMMEDIATE");
    for (size_t i = tables_of[version]; i < TABLES && outcome == ST_SQL_DONE; i++) {
        outcome = st_db_run(db, tables[i]);
    }
    if (outcome == ST_SQL_DONE) {
        outcome = st_db_run(db, SET_VERSION);
    }
    return outcome == ST_SQL_DONE ? st_db_run(db, "COMMIT") : outcome;
}

st_sql st_schema_check(st_db *db)
{
    int64_t version = 0;
    st_db mine = borrowed(db);
    st_sql outcome = read_version(db, &version);
    for (size_t i = 0; outcome == ST_SQL_DONE && i < tables_of[version]; i++) {
        sqlite3_stmt *s;
        outcome = st_db_find(&mine, TABLE_GET, &s, "t", tables[i]);
        if (outcome == ST_SQL_ROW) {
            st_db_reset(s);
        }
        outcome = outcome == ST_SQL_ROW    ? ST_SQL_DONE
                  : outcome == ST_SQL_DONE ? ST_SQL_DAMAGED
                                           : outcome;
    }
    give_back(&mine);
    return outcome;
}

/* Reads the value of a name from the table `meta`: a number into *word, or, if `text` is not NULL,
 * a text into `text`. */
static st_sql get_meta(st_db *db, const char *name, uint64_t *word, char *text)
{
    sqlite3_stmt *s;
    st_sql outcome = st_db_find(db, META_GET, &s, "t", name);
    if (outcome != ST_SQL_ROW) {
        return outcome == ST_SQL_DONE ? ST_SQL_DAMAGED : outcome;
    }
    if (text != NULL) {
        st_db_text(s, 0, text, ST_RELEASE);
    } else {
        *word = st_db_word(s, 0);
    }
    bool good = sum_is(s, 1, meta_sum(name, text == NULL ? *word : 0, text == NULL ? "" : text));
    st_db_reset(s);
    return good ? ST_SQL_DONE : ST_SQL_DAMAGED;
}

st_sql st_identity_read(st_db *db, st_identity *out)
{
    st_db mine = borrowed(db);
    st_sql outcome = get_meta(&mine, "store", &out->store, NULL);
    if (outcome == ST_SQL_DONE) {
        outcome = get_meta(&mine, "secret_1", &out->secret[0], NULL);
    }
    if (outcome == ST_SQL_DONE) {
        outcome = get_meta(&mine, "secret_2", &out->secret[1], NULL);
    }
    if (outcome == ST_SQL_DONE) {
        outcome = get_meta(&mine, "made_by", NULL, out->made_by);
    }
    give_back(&mine);
    return outcome;
}

st_sql st_progress_read(st_db *db, st_progress *out)
{
    st_db mine = borrowed(db);
    sqlite3_stmt *s;
    st_sql outcome = st_db_find(&mine, STATE_GET, &s, "");
    if (outcome == ST_SQL_ROW) {
        *out = (st_progress){st_db_word(s, 0), st_db_word(s, 1), st_db_word(s, 2)};
        outcome = sum_is(s, 3, st_progress_sum(out)) ? ST_SQL_DONE : ST_SQL_DAMAGED;
    } else if (outcome == ST_SQL_DONE) {
        outcome = ST_SQL_DAMAGED;
    }
    give_back(&mine);
    return outcome;
}
