/* sqlite_read.c - reads meshes. One connection to the database reads cards (short descriptions of
 * meshes); ST_LOADS other connections load whole meshes. */
#include "base/mem.h"
#include "journal/part_packing.h"
#include "journal/sqlite/sqlite_state.h"
#include "stored/bytes.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

enum {
    CARD,
    CARDS,
    CARDS_BY, /* the first of the statements for each st_card_order */
    HOLDINGS = CARDS_BY + ST_CARD_ORDERS,
    SNAPSHOT,
    PARTS,
    BASE,
    RECORDS,
    BEGIN,
    COMMIT,
    STATEMENTS
};
static const char *const texts[STATEMENTS] = {
    [CARD] = "SELECT " ST_MESH_COLUMNS " FROM mesh WHERE id = ?1",
    [CARDS] = "SELECT " ST_MESH_COLUMNS " FROM mesh WHERE id > ?1 ORDER BY id LIMIT ?2",
    /* SQLite seeks the first row in the index only if the collation is on the side of ?1 */
    [CARDS_BY + ST_BY_NAME] = "SELECT " ST_MESH_COLUMNS " FROM mesh INDEXED BY mesh_by_name "
                              "WHERE (name, id) > (?1 COLLATE NOCASE, ?2) "
                              "ORDER BY name COLLATE NOCASE, id LIMIT ?3",
    [CARDS_BY + ST_BY_MODIFIED] = "SELECT " ST_MESH_COLUMNS " FROM mesh INDEXED BY "
                                  "mesh_by_modified WHERE (modified, id) < (?1, ?2) "
                                  "ORDER BY modified DESC, id DESC LIMIT ?3",
    [CARDS_BY + ST_BY_BYTES] = "SELECT " ST_MESH_COLUMNS " FROM mesh INDEXED BY mesh_by_bytes "
                               "WHERE (bytes, id) < (?1, ?2) "
                               "ORDER BY bytes DESC, id DESC LIMIT ?3",
    [HOLDINGS] = "SELECT holder, bytes FROM mesh WHERE holder <> ''",
    [SNAPSHOT] = "SELECT " ST_SNAPSHOT_COLUMNS " FROM snapshot WHERE mesh = ?1 AND number = ?2",
    [PARTS] = "SELECT part, bytes FROM part WHERE snapshot = ?1 ORDER BY part",
    [BASE] = "SELECT bytes FROM record WHERE mesh = ?1 AND number = ?2",
    [RECORDS] = "SELECT number, bytes FROM record WHERE mesh = ?1 AND number > ?2 ORDER BY number",
    [BEGIN] = "BEGIN",
    [COMMIT] = "COMMIT",
};

/* What the load of a mesh reads next. The base is the record that has the mesh data with which the
 * load begins. */
typedef enum stage_of_load {
    AT_BASE,
    AT_BASE_PARTS, /* parts of the base's mesh data that are stored in rows of their own */
    /* parts of the base's mesh data that are stored in the row of the base's record */
    AT_INLINE_PARTS,
    AT_RECORDS,
    AT_RECORD_PARTS /* parts of mesh data or of a large edit that belong to the last record read */
} stage_of_load;

struct st_reader {
    st_sqlite *journal;
    st_load_slot *slot;
    st_mesh_row row;
    stage_of_load at;
    st_frame frame;
    /* `number`: the number of the last record read; `chain`: the hash that the next record must
     * state to prove that it follows that record */
    uint64_t number, chain;
    sqlite3_stmt *records, *parts, *base;
    int64_t snapshot;
    uint64_t part, parts_left;
    he_cursor inline_parts;
    st_unpacker *unpacker; /* decompresses parts; NULL before the first compressed part */
    char why[ST_DAMAGE];   /* why reading failed */
};

static st_status status_of(st_sql outcome)
{
    return outcome == ST_SQL_NO_MEMORY ? ST_NO_MEMORY : ST_FAILED;
}

/* --- connections to the database --- */

enum { CACHE_KIB = 2 << 10 };

static st_sql open_one(st_db *db, const char *path)
{
    st_sql outcome = st_db_open(db, path, SQLITE_OPEN_READONLY, texts, STATEMENTS);
    /* The file is not mapped into memory, because then a bad sector of the disk would raise
     * SIGBUS. */
    if (outcome == ST_SQL_DONE) {
        outcome = st_db_run(db, "PRAGMA mmap_size = 0");
    }
    if (outcome == ST_SQL_DONE) {
        outcome = st_db_set_cache(db, CACHE_KIB);
    }
    return outcome == ST_SQL_DONE ? st_db_run(db, "PRAGMA cell_size_check = ON") : outcome;
}

/* Opens a connection for loading meshes. Prepares its statements BEGIN and COMMIT now, so that
 * ending a load needs no memory. */
static st_sql open_loader(st_db *db, const char *path)
{
    st_sql outcome = open_one(db, path);
    if (outcome == ST_SQL_DONE) {
        outcome = st_db_begin(db, BEGIN, COMMIT);
    }
    return outcome == ST_SQL_DONE ? st_db_do(db, COMMIT, "") : outcome;
}

st_sql st_readers_open(st_sqlite *self, const char *path)
{
    st_sql outcome = open_one(&self->cards, path);
    for (size_t i = 0; i < ST_LOADS && outcome == ST_SQL_DONE; i++) {
        outcome = open_loader(&self->loads[i].db, path);
    }
    return outcome;
}

bool st_readers_close(st_sqlite *self)
{
    bool closed = st_db_close(&self->cards);
    for (size_t i = 0; i < ST_LOADS; i++) {
        closed = st_db_close(&self->loads[i].db) && closed;
    }
    return closed;
}

/* Waits until a connection for loading is free and the write-ahead log is not too long. */
static st_load_slot *take_slot(st_sqlite *self)
{
    pthread_mutex_lock(&self->lock);
    self->waiting++;
    while (self->loads_taken == ST_LOADS || self->log_is_long) {
        pthread_cond_wait(&self->moved, &self->lock);
    }
    self->waiting--;
    self->loads_taken++;
    st_load_slot *slot = self->loads;
    while (slot->taken) {
        slot++;
    }
    slot->taken = true;
    pthread_mutex_unlock(&self->lock);
    return slot;
}

static void give_slot(st_sqlite *self, st_load_slot *slot)
{
    pthread_mutex_lock(&self->lock);
    slot->taken = false;
    self->loads_taken--;
    pthread_cond_broadcast(&self->moved);
    if (self->log_is_long && self->loads_taken == 0) {
        pthread_cond_signal(&self->work);
    }
    pthread_mutex_unlock(&self->lock);
}

/* --- cards --- */

st_status st_sqlite_read_card(sqlite3_stmt *s, st_mesh_row *row)
{
    if (!st_mesh_row_read(s, row)) {
        (void)snprintf(row->card.damage, sizeof row->card.damage,
                       "the stored description of the mesh has a wrong checksum");
    }
    return row->card.damage[0] == '\0' ? ST_OK : ST_DAMAGED;
}

/* Finds the card (short description) of a mesh. A journal that is open only for reading finds
 * damaged meshes, too. */
static st_status find_card(st_sqlite *self, st_db *db, const char *id, st_mesh_row *row)
{
    sqlite3_stmt *s;
    if (self->salvage.on && st_salvage_find(self, db, id, row) == ST_SQL_ROW) {
        return ST_OK;
    }
    st_sql outcome = st_db_find(db, CARD, &s, "t", id);
    if (outcome != ST_SQL_ROW) {
        return outcome == ST_SQL_DONE ? ST_ABSENT : status_of(outcome);
    }
    st_status status = st_sqlite_read_card(s, row);
    st_db_reset(s);
    return self->only_reads ? ST_OK : status;
}

/* Reads the rows of a statement that selects cards (short descriptions of meshes); `outcome` is the
 * outcome of its first step. */
static st_sql take_cards(st_db *db, sqlite3_stmt *s, st_sql outcome, st_card *out, size_t *count)
{
    while (outcome == ST_SQL_ROW) {
        st_mesh_row row;
        (void)st_sqlite_read_card(s, &row);
        out[(*count)++] = row.card;
        outcome = st_db_step(db, s);
    }
    return outcome;
}

st_status st_sqlite_list(void *context, const char *after, st_card *out, size_t limit,
                         size_t *count)
{
    st_sqlite *self = context;
    sqlite3_stmt *s;
    st_sql outcome;
    size_t found = 0;
    pthread_mutex_lock(&self->cards_lock);
    if (self->salvage.on) {
        outcome = st_salvage_list(self, after[0] == '\0', out, limit, &found);
    } else {
        outcome = st_db_find(&self->cards, CARDS, &s, "ti", after, (uint64_t)limit);
        outcome = take_cards(&self->cards, s, outcome, out, &found);
    }
    pthread_mutex_unlock(&self->cards_lock);
    if (outcome != ST_SQL_DONE) {
        return status_of(outcome);
    }
    *count = found;
    return ST_OK;
}

/* Begins to read the cards (short descriptions of meshes) of a sorted list. Each list begins after
 * a card that sorts before those of all meshes, if the page has no card to begin after. */
static st_sql find_by(st_db *db, const st_card_page *page, sqlite3_stmt **s)
{
    const unsigned which = CARDS_BY + (unsigned)page->order;
    const st_card *after = page->after;
    const char *id = after == NULL ? "" : after->id;
    const uint64_t limit = page->limit;
    switch (page->order) {
    case ST_BY_NAME:
        return st_db_find(db, which, s, "tti", after == NULL ? "" : after->name, id, limit);
    case ST_BY_MODIFIED:
        return st_db_find(db, which, s, "dti", after == NULL ? INFINITY : after->modified, id,
                          limit);
    case ST_BY_BYTES:
        return st_db_find(db, which, s, "iti", after == NULL ? (uint64_t)INT64_MAX : after->bytes,
                          id, limit);
    case ST_CARD_ORDERS:
        break;
    }
    return ST_SQL_FAILED;
}

st_status st_sqlite_list_by(void *context, const st_card_page *page, st_card *out, size_t *count)
{
    st_sqlite *self = context;
    sqlite3_stmt *s = NULL;
    size_t found = 0;
    pthread_mutex_lock(&self->cards_lock);
    st_sql outcome = find_by(&self->cards, page, &s);
    outcome = take_cards(&self->cards, s, outcome, out, &found);
    pthread_mutex_unlock(&self->cards_lock);
    if (outcome != ST_SQL_DONE) {
        return status_of(outcome);
    }
    *count = found;
    return ST_OK;
}

st_status st_sqlite_holdings(void *context, st_take_holding *take, void *to)
{
    st_sqlite *self = context;
    sqlite3_stmt *s;
    bool taken = true;
    if (self->only_reads) {
        /* A journal that is open only for reading passes no holders (owners of meshes): no mesh is
         * created, so the limits of holders do not matter. */
        return ST_OK;
    }
    pthread_mutex_lock(&self->cards_lock);
    st_sql outcome = st_db_find(&self->cards, HOLDINGS, &s, "");
    while (outcome == ST_SQL_ROW && taken) {
        char holder[ST_HOLDER + 1];
        st_db_text(s, 0, holder, sizeof holder);
        taken = take(to, holder, st_db_word(s, 1));
        if (taken) {
            outcome = st_db_step(&self->cards, s);
        } else {
            st_db_reset(s);
        }
    }
    pthread_mutex_unlock(&self->cards_lock);
    return !taken ? ST_NO_MEMORY : outcome == ST_SQL_DONE ? ST_OK : status_of(outcome);
}

/* --- damage found by loads --- */

/* Returns the damage that an earlier load found in a mesh, or NULL if it found none. The caller
 * holds self->lock. */
static st_finding *find_finding(st_sqlite *self, uint64_t incarnation, uint64_t base)
{
    for (size_t i = 0; i < ST_FINDINGS; i++) {
        st_finding *finding = &self->findings[i];
        if (finding->incarnation == incarnation && finding->base == base &&
            finding->damage[0] != '\0') {
            return finding;
        }
    }
    return NULL;
}

static void note_finding(st_sqlite *self, const st_finding *noted)
{
    pthread_mutex_lock(&self->lock);
    if (find_finding(self, noted->incarnation, noted->base) == NULL) {
        self->findings[self->last_finding++ % ST_FINDINGS] = *noted;
    }
    pthread_mutex_unlock(&self->lock);
}

/* Marks the card (short description) of a mesh as damaged if a load found damage that is not in the
 * mesh's row of the database yet. */
static st_status add_finding(st_sqlite *self, st_mesh_row *row)
{
    st_card *card = &row->card;
    pthread_mutex_lock(&self->lock);
    const st_finding *finding = find_finding(self, card->incarnation, row->base);
    if (finding != NULL) {
        memcpy(card->damage, finding->damage, sizeof card->damage);
    }
    pthread_mutex_unlock(&self->lock);
    return finding == NULL ? ST_OK : ST_DAMAGED;
}

void st_sqlite_condemn(st_reader *reader, const char *damage)
{
    st_sqlite *self = reader->journal;
    st_finding finding = {.incarnation = reader->row.card.incarnation, .base = reader->row.base};
    st_copy_text(finding.damage, damage, ST_DAMAGE - 1);
    note_finding(self, &finding);
    st_condemned *condemned = self->only_reads ? NULL : he_mem_zero(1, sizeof *condemned);
    if (condemned == NULL) {
        /* memory is out, so the damage is not noted; the next load of the mesh finds it again */
        return;
    }
    condemned->item.kind = ST_ITEM_CONDEMN;
    condemned->finding = finding;
    pthread_mutex_lock(&self->lock);
    st_queue_put(self, &condemned->item);
    pthread_mutex_unlock(&self->lock);
}

__attribute__((format(printf, 2, 3))) static st_status damaged(st_reader *reader,
                                                               const char *format, ...)
{
    va_list values;
    va_start(values, format);
    (void)vsnprintf(reader->why, sizeof reader->why, format, values);
    va_end(values);
    return ST_DAMAGED;
}

/* Returns the status for a statement that returned no row, or a row that cannot be read. */
static st_status failed(st_reader *reader, st_sql outcome, const char *what)
{
    return outcome == ST_SQL_DAMAGED
               ? damaged(reader,
                         "%s cannot be read, because a part of the database file is damaged", what)
               : status_of(outcome);
}

/* --- loading --- */

static void end_load(st_reader *reader)
{
    st_db_reset(reader->records);
    st_db_reset(reader->parts);
    st_db_reset(reader->base);
    (void)st_db_do(&reader->slot->db, COMMIT, "");
    give_slot(reader->journal, reader->slot);
    st_unpacker_free(reader->unpacker);
}

static st_status begin_load(st_sqlite *self, const char *id, st_mesh_row *row, st_reader **out)
{
    st_reader *reader = he_mem_zero(1, sizeof *reader);
    if (reader == NULL) {
        return ST_NO_MEMORY;
    }
    reader->journal = self;
    reader->slot = take_slot(self);
    st_sql outcome = st_db_begin(&reader->slot->db, BEGIN, COMMIT);
    st_status status =
        outcome == ST_SQL_DONE ? find_card(self, &reader->slot->db, id, row) : status_of(outcome);
    if (status != ST_OK) {
        end_load(reader);
        he_mem_free(reader);
        return status;
    }
    reader->row = *row;
    *out = reader;
    return ST_OK;
}

st_status st_sqlite_open_mesh(void *context, const char *id, st_card *card, st_reader **reader)
{
    st_sqlite *self = context;
    st_mesh_row row;
    st_status status;
    st_queue_settle(self);
    if (reader != NULL) {
        status = begin_load(self, id, &row, reader);
    } else {
        pthread_mutex_lock(&self->cards_lock);
        status = find_card(self, &self->cards, id, &row);
        pthread_mutex_unlock(&self->cards_lock);
    }
    if (status == ST_OK && !self->only_reads) {
        status = add_finding(self, &row);
        if (status == ST_DAMAGED && reader != NULL) {
            st_sqlite_shut(*reader);
            *reader = NULL;
        }
    }
    if (status == ST_OK || status == ST_DAMAGED) {
        *card = row.card;
    }
    return status;
}

void st_sqlite_shut(st_reader *reader)
{
    if (reader != NULL) {
        end_load(reader);
        he_mem_free(reader);
    }
}

/* Fills in what one step of a load returns to the store: the data of the decoded record, and, where
 * the record lacks them, the name, id and times from the mesh's card (short description). */
static void fill_piece(st_reader *reader, st_piece_kind kind, st_piece *out)
{
    const st_card *card = &reader->row.card;
    *out = (st_piece){.kind = kind, .record = reader->frame.record};
    st_record *record = &out->record;
    record->ops = reader->frame.ops;
    record->name = reader->frame.name;
    if (record->kind == ST_RECORD_MOMENT) {
        record->moment = reader->frame.name;
    }
    if (record->kind != ST_RECORD_RENAME && record->kind != ST_RECORD_CONTENT) {
        record->name = card->name;
    }
    record->id = card->id;
    record->incarnation = card->incarnation;
    record->created = card->created;
}

static st_status read_frame(st_reader *reader, const unsigned char *bytes, size_t size,
                            uint64_t number)
{
    he_error err = {.status = HE_OK};
    const he_status status = st_frame_read(bytes, size, &reader->frame, &err);
    if (status != HE_OK) {
        (void)damaged(reader, "record %llu, byte %llu: %s", (unsigned long long)number,
                      (unsigned long long)err.at, err.text);
        return status == HE_UNSUPPORTED ? ST_NEWER : ST_DAMAGED;
    }
    if (reader->frame.record.number != number) {
        return damaged(reader,
                       "in the place of record %llu the store has a record with the number %llu",
                       (unsigned long long)number, (unsigned long long)reader->frame.record.number);
    }
    reader->number = number;
    return ST_OK;
}

/* Finds the snapshot with the mesh data after record `number`, so that its parts are read next.
 * Returns ST_ABSENT if there is no such snapshot. */
static st_status find_snapshot(st_reader *reader, uint64_t number, bool facts)
{
    st_db *db = &reader->slot->db;
    sqlite3_stmt *s;
    st_snapshot_row row;
    st_sql outcome = st_db_find(db, SNAPSHOT, &s, "ii", reader->row.key, number);
    if (outcome != ST_SQL_ROW) {
        return outcome == ST_SQL_DONE ? ST_ABSENT : failed(reader, outcome, "a snapshot");
    }
    st_status status = st_snapshot_row_read(s, &row)
                           ? ST_OK
                           : damaged(reader, "the snapshot of record %llu has a wrong checksum",
                                     (unsigned long long)number);
    if (status == ST_OK && facts) {
        status = read_frame(reader, row.facts, row.facts_size, number);
        reader->chain = row.chain;
    }
    st_db_reset(s);
    if (status != ST_OK) {
        return status;
    }
    reader->snapshot = row.key;
    reader->parts_left = row.parts;
    reader->part = 0;
    return ST_OK;
}

/* Decompresses a part of mesh data. A part with a coding that this release does not know is left
 * unchanged, because core/stored reports such codings. */
static st_status unpack(st_reader *reader, st_piece *piece)
{
    const char *why = "";
    if ((piece->coding & ~(unsigned)HE_CODING_LINKS) != HE_CODING_PACKED) {
        return ST_OK;
    }
    if (reader->unpacker == NULL) {
        reader->unpacker = st_unpacker_new();
    }
    st_part part = {piece->bytes, piece->size};
    st_status status = reader->unpacker == NULL
                           ? ST_NO_MEMORY
                           : st_part_unpack(reader->unpacker, part, &part, &why);
    piece->bytes = part.bytes;
    piece->size = part.size;
    piece->coding &= ~(unsigned)HE_CODING_PACKED;
    return status != ST_DAMAGED
               ? status
               : damaged(reader,
                         "part %llu of the mesh data after record %llu cannot be decompressed: %s",
                         (unsigned long long)reader->part, (unsigned long long)reader->number, why);
}

/* Reads the next part of a snapshot (stored mesh data) into *out. After the last part *out is left
 * unchanged. */
static st_status read_part(st_reader *reader, bool *got, st_piece *out)
{
    st_db *db = &reader->slot->db;
    size_t size;
    *got = false;
    if (reader->parts_left == 0) {
        st_db_reset(reader->parts);
        reader->parts = NULL;
        return ST_OK;
    }
    st_sql outcome = reader->parts == NULL
                         ? st_db_find(db, PARTS, &reader->parts, "i", reader->snapshot)
                         : st_db_step(db, reader->parts);
    if (outcome == ST_SQL_DONE) {
        reader->parts = NULL;
        return damaged(reader, "part %llu of the mesh data after record %llu is missing",
                       (unsigned long long)reader->part, (unsigned long long)reader->number);
    }
    if (outcome != ST_SQL_ROW) {
        reader->parts = NULL;
        return failed(reader, outcome, "a part of the mesh data");
    }
    const unsigned char *bytes = st_db_bytes(reader->parts, 1, &size);
    uint32_t sum = 0;
    if (size >= ST_PART_HEAD) {
        memcpy(&sum, bytes, sizeof sum);
    }
    if (size < ST_PART_HEAD || st_db_word(reader->parts, 0) != reader->part ||
        sum != st_part_sum(reader->snapshot, reader->part, bytes + sizeof sum, size - sizeof sum)) {
        return damaged(reader, "part %llu of the mesh data after record %llu has a wrong checksum",
                       (unsigned long long)reader->part, (unsigned long long)reader->number);
    }
    *out = (st_piece){.kind = ST_PIECE_PART,
                      .coding = bytes[ST_PART_HEAD - 1],
                      .bytes = bytes + ST_PART_HEAD,
                      .size = size - ST_PART_HEAD};
    st_status status = unpack(reader, out);
    reader->part++;
    reader->parts_left--;
    *got = status == ST_OK;
    return status;
}

/* Reads the next part of mesh data that is stored in the row of its record. There, each part is
 * preceded by its coding and length (stored.h). */
static st_status read_inline_part(st_reader *reader, bool *got, st_piece *out)
{
    he_cursor *c = &reader->inline_parts;
    unsigned char coding;
    uint32_t size;
    *got = he_left(c) > 0;
    if (!*got) {
        st_db_reset(reader->base);
        reader->base = NULL;
        return ST_OK;
    }
    if (!he_take_bytes(c, 1, &coding) || !he_take_u32(c, &size) || size > he_left(c)) {
        return damaged(reader, "the mesh data in record %llu ends within a part",
                       (unsigned long long)reader->number);
    }
    *out = (st_piece){.kind = ST_PIECE_PART, .coding = coding, .bytes = c->at, .size = size};
    c->at += size;
    return ST_OK;
}

static uint64_t parts_in(he_cursor c)
{
    uint64_t parts = 0;
    unsigned char coding;
    uint32_t size;
    for (; he_take_bytes(&c, 1, &coding) && he_take_u32(&c, &size) && size <= he_left(&c);
         c.at += size) {
        parts++;
    }
    return parts;
}

/* Reads the base, the record with which the load of a mesh begins, if its mesh data is in the row
 * of the record. */
static st_status read_inline_base(st_reader *reader)
{
    const uint64_t number = reader->row.base;
    size_t size;
    st_sql outcome =
        st_db_find(&reader->slot->db, BASE, &reader->base, "ii", reader->row.key, number);
    if (outcome != ST_SQL_ROW) {
        return outcome == ST_SQL_DONE
                   ? damaged(reader, "record %llu, from which the mesh is loaded, is missing",
                             (unsigned long long)number)
                   : failed(reader, outcome, "the record from which the mesh is loaded");
    }
    const unsigned char *bytes = st_db_bytes(reader->base, 0, &size);
    st_status status = read_frame(reader, bytes, size, number);
    if (status != ST_OK) {
        return status;
    }
    const st_frame *frame = &reader->frame;
    if (frame->record.kind != ST_RECORD_CONTENT || frame->in_parts) {
        return damaged(reader, "record %llu, from which the mesh is loaded, has no mesh data",
                       (unsigned long long)number);
    }
    if (number == 1 && frame->chain != st_chain_of_origin(reader->row.origin)) {
        return damaged(reader, "record 1 belongs to another mesh");
    }
    reader->chain = st_frame_next_chain(bytes, size);
    reader->inline_parts = he_cursor_over(frame->record.body, frame->record.body_size);
    return ST_OK;
}

static st_status read_base(st_reader *reader, st_piece *out)
{
    st_status status = find_snapshot(reader, reader->row.base, true);
    reader->at = AT_BASE_PARTS;
    /* The mesh data of the base may be in the row of its record, even if the table of snapshots
     * cannot be read. */
    if (status == ST_ABSENT || (status == ST_DAMAGED && reader->journal->salvage.on)) {
        status = read_inline_base(reader);
        reader->at = AT_INLINE_PARTS;
    }
    if (status == ST_OK) {
        fill_piece(reader, ST_PIECE_BASE, out);
        out->parts =
            reader->at == AT_BASE_PARTS ? reader->parts_left : parts_in(reader->inline_parts);
        out->record.body = NULL;
        out->record.body_size = 0;
    }
    return status;
}

/* Ends the load of a mesh. Checks that the last record read is the newest record that the card
 * (short description) of the mesh states. */
static st_status end_of_records(st_reader *reader, st_piece *out)
{
    const st_mesh_row *row = &reader->row;
    if (reader->number != row->card.record) {
        return damaged(reader, "the last record is number %llu, but the mesh should have %llu",
                       (unsigned long long)reader->number, (unsigned long long)row->card.record);
    }
    if (reader->chain != row->chain) {
        return damaged(reader,
                       "the chain of records does not end where it should, after record "
                       "%llu",
                       (unsigned long long)reader->number);
    }
    *out = (st_piece){.kind = ST_PIECE_END};
    return ST_OK;
}

static st_status read_record(st_reader *reader, st_piece *out)
{
    st_db *db = &reader->slot->db;
    size_t size;
    st_sql outcome = reader->records == NULL ? st_db_find(db, RECORDS, &reader->records, "ii",
                                                          reader->row.key, reader->number)
                                             : st_db_step(db, reader->records);
    if (outcome != ST_SQL_ROW) {
        reader->records = NULL;
        return outcome == ST_SQL_DONE ? end_of_records(reader, out)
                                      : failed(reader, outcome, "a record");
    }
    const uint64_t number = st_db_word(reader->records, 0);
    if (number != reader->number + 1) {
        return damaged(reader, "record %llu is missing", (unsigned long long)reader->number + 1);
    }
    const unsigned char *bytes = st_db_bytes(reader->records, 1, &size);
    st_status status = read_frame(reader, bytes, size, number);
    if (status != ST_OK) {
        return status;
    }
    if (reader->frame.chain != reader->chain) {
        return damaged(reader, "the chain of records breaks at record %llu",
                       (unsigned long long)number);
    }
    reader->chain = st_frame_next_chain(bytes, size);
    fill_piece(reader, ST_PIECE_RECORD, out);
    if (reader->frame.in_parts) {
        status = find_snapshot(reader, number, false);
        if (status == ST_ABSENT) {
            return damaged(reader, "the mesh data of record %llu is missing",
                           (unsigned long long)number);
        }
        reader->at = AT_RECORD_PARTS;
        /* This pointer is never followed. It only tells the store that parts of the record come
         * next. */
        out->record.stage = (st_stage *)reader;
        out->parts = reader->parts_left;
        out->record.body = NULL;
    }
    return status;
}

static st_status read_next(st_reader *reader, st_piece *out)
{
    bool got = false;
    st_status status = ST_OK;
    switch (reader->at) {
    case AT_BASE:
        return read_base(reader, out);
    case AT_BASE_PARTS:
    case AT_RECORD_PARTS:
        status = read_part(reader, &got, out);
        break;
    case AT_INLINE_PARTS:
        status = read_inline_part(reader, &got, out);
        break;
    case AT_RECORDS:
        break;
    }
    if (status != ST_OK || got) {
        return status;
    }
    reader->at = AT_RECORDS;
    return read_record(reader, out);
}

st_status st_sqlite_read(st_reader *reader, st_piece *out)
{
    st_status status = read_next(reader, out);
    if (status != ST_OK) {
        *out = (st_piece){.kind = ST_PIECE_END, .why = reader->why};
    }
    return status;
}
