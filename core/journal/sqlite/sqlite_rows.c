/* sqlite_rows.c - writes records (changes of meshes) to the tables of the database, within a
 * transaction of the commit thread. */
#include "journal/sqlite/sqlite_state.h"

#include <string.h>

const char *const st_writer_texts[ST_WRITER_STATEMENTS] = {
    [ST_SQL_BEGIN] = "BEGIN IMMEDIATE",
    [ST_SQL_COMMIT] = "COMMIT",
    [ST_SQL_ROLLBACK] = "ROLLBACK",
    [ST_SQL_MESH] = "SELECT " ST_MESH_COLUMNS " FROM mesh WHERE incarnation = ?1",
    [ST_SQL_MESH_MAKE] = "INSERT INTO mesh(" ST_MESH_COLUMNS ") VALUES "
                         "(?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9, ?10, ?11, ?12, ?13, ?14, ?15, ?16, "
                         "?17, ?18, ?19, ?20)",
    [ST_SQL_MESH_PUT] = "UPDATE mesh SET name = ?2, metadata = ?3, revision = ?4, record = ?5, "
                        "chain = ?6, modified = ?7, vertices = ?8, edges = ?9, faces = ?10, "
                        "boundary = ?11, bytes = ?12, base = ?13, damage = ?14, sum = ?15 "
                        "WHERE key = ?1",
    [ST_SQL_MESH_DELETE] = "DELETE FROM mesh WHERE key = ?1",
    [ST_SQL_RECORD] = "SELECT bytes FROM record WHERE mesh = ?1 AND number = ?2",
    [ST_SQL_RECORD_MAKE] = "INSERT INTO record VALUES (?1, ?2, ?3)",
    [ST_SQL_RECORDS_FIRST] = "SELECT number, length(bytes) FROM record "
                             "WHERE mesh = ?1 AND number < ?2 ORDER BY number",
    [ST_SQL_RECORDS_DELETE] = "DELETE FROM record WHERE mesh = ?1 AND number <= ?2",
    [ST_SQL_SNAPSHOT_MAKE] = "INSERT OR REPLACE INTO snapshot(" ST_SNAPSHOT_COLUMNS ") VALUES "
                             "(?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9)",
    [ST_SQL_SNAPSHOT_DELETE] = "DELETE FROM snapshot WHERE key = ?1",
    [ST_SQL_SNAPSHOTS_BEFORE] = "SELECT " ST_SNAPSHOT_COLUMNS " FROM snapshot "
                                "WHERE mesh = ?1 AND number < ?2",
    [ST_SQL_SNAPSHOTS_FROM] = "SELECT " ST_SNAPSHOT_COLUMNS " FROM snapshot "
                              "WHERE mesh = ?1 AND number >= ?2 ORDER BY number DESC",
    [ST_SQL_PART_MAKE] = "INSERT INTO part VALUES (?1, ?2, ?3)",
    [ST_SQL_PARTS_DELETE] = "DELETE FROM part WHERE snapshot = ?1 AND part IN "
                            "(SELECT part FROM part WHERE snapshot = ?1 LIMIT ?2)",
    [ST_SQL_PURGE_MAKE] = "INSERT OR REPLACE INTO purge(" ST_PURGE_COLUMNS ") "
                          "VALUES (?1, ?2, ?3, ?4)",
    [ST_SQL_PURGE_ALL] = "SELECT " ST_PURGE_COLUMNS " FROM purge",
    [ST_SQL_PURGE_DELETE] = "DELETE FROM purge WHERE kind = ?1 AND key = ?2",
    [ST_SQL_KEPT_MAKE] = "INSERT OR REPLACE INTO kept(mesh, text, digest, time, id, incarnation, "
                         "revision, metadata, position, made, sum, holder) "
                         "VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9, ?10, ?11, ?12)",
    [ST_SQL_KEPT_DELETE] = "DELETE FROM kept WHERE mesh = ?1",
    [ST_SQL_KEPT_TRIM] = "DELETE FROM kept WHERE (mesh, holder, text) IN (SELECT mesh, holder, "
                         "text FROM kept WHERE time < ?1 ORDER BY time LIMIT 2)",
    [ST_SQL_KEPT_OLDEST] = "DELETE FROM kept WHERE (mesh, holder, text) IN (SELECT mesh, holder, "
                           "text FROM kept ORDER BY time LIMIT 2)",
    [ST_SQL_KEPT_CUT] = "DELETE FROM kept WHERE mesh = ?1 AND (holder, text) IN (SELECT holder, "
                        "text FROM kept WHERE mesh = ?1 ORDER BY time DESC LIMIT ?3 OFFSET ?2)",
    [ST_SQL_JOB] = "SELECT " ST_JOB_COLUMNS " FROM job WHERE id = ?1",
    [ST_SQL_JOB_MAKE] = "INSERT OR REPLACE INTO job(" ST_JOB_COLUMNS ") VALUES "
                        "(?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9, ?10, ?11, ?12, ?13, ?14, ?15, ?16, "
                        "?17, ?18, ?19, ?20)",
    [ST_SQL_JOB_DONE] = "UPDATE job SET state = ?2, mesh = ?3, progress = ?4, finished = ?5, "
                        "status = ?6, sum = ?7 WHERE id = ?1",
    [ST_SQL_JOB_DELETE] = "DELETE FROM job WHERE id = ?1",
    [ST_SQL_JOBS_TRIM] = "DELETE FROM job WHERE id IN (SELECT id FROM job WHERE finished > 0 AND "
                         "finished < ?1 ORDER BY finished LIMIT 2)",
    [ST_SQL_STATE_PUT] = "UPDATE state SET commits = ?1, position = ?2, meshes = ?3, sum = ?4",
};

/* --- cached rows of the table of meshes, called heads --- */

static st_sql make_row(st_sqlite *self, const st_mesh_row *row)
{
    const st_card *c = &row->card;
    return st_db_do(&self->db, ST_SQL_MESH_MAKE, "ittiiiiiiddiiiiiitit", row->key, c->id, c->name,
                    c->incarnation, row->origin, c->metadata, c->revision, c->record, row->chain,
                    c->created, c->modified, (uint64_t)c->counts.vertices,
                    (uint64_t)c->counts.edges, (uint64_t)c->counts.faces,
                    (uint64_t)c->counts.boundary, c->bytes, row->base, c->damage,
                    (uint64_t)st_mesh_row_sum(row), c->holder);
}

static st_sql put_row(st_sqlite *self, const st_mesh_row *row)
{
    const st_card *c = &row->card;
    return st_db_do(&self->db, ST_SQL_MESH_PUT, "itiiiidiiiiiiti", row->key, c->name, c->metadata,
                    c->revision, c->record, row->chain, c->modified, (uint64_t)c->counts.vertices,
                    (uint64_t)c->counts.edges, (uint64_t)c->counts.faces,
                    (uint64_t)c->counts.boundary, c->bytes, row->base, c->damage,
                    (uint64_t)st_mesh_row_sum(row));
}

static st_sql flush(st_sqlite *self, st_head *head)
{
    st_sql outcome = ST_SQL_DONE;
    if (head->dirty) {
        outcome = head->made ? make_row(self, &head->row) : put_row(self, &head->row);
        head->dirty = head->made = false;
    }
    return outcome;
}

static bool holds(const st_head *head, uint64_t incarnation)
{
    return head->row.key != 0 && head->row.card.incarnation == incarnation;
}

/* Finds the place in the cache for the row of a mesh. If the changed row of another mesh is there,
 * that row is first written to the database. */
static st_sql place_of(st_sqlite *self, uint64_t incarnation, st_head **out)
{
    *out = &self->heads.slots[incarnation % ST_HEADS];
    return holds(*out, incarnation) ? ST_SQL_DONE : flush(self, *out);
}

/* Reads the row of a mesh. Returns ST_SQL_DONE if there is no such mesh. */
static st_sql read_row(st_sqlite *self, uint64_t incarnation, st_mesh_row *out, bool *good)
{
    sqlite3_stmt *s;
    st_sql outcome = st_db_find(&self->db, ST_SQL_MESH, &s, "i", incarnation);
    if (outcome == ST_SQL_ROW) {
        *good = st_mesh_row_read(s, out);
        st_db_reset(s);
    }
    return outcome;
}

st_sql st_head_find(st_sqlite *self, uint64_t incarnation, st_head **out)
{
    st_head *head;
    bool good = false;
    st_sql outcome = place_of(self, incarnation, &head);
    *out = NULL;
    if (outcome == ST_SQL_DONE && !holds(head, incarnation)) {
        head->row.key = 0;
        outcome = read_row(self, incarnation, &head->row, &good);
        if (outcome != ST_SQL_ROW || !good) {
            head->row.key = 0;
            return outcome == ST_SQL_ROW ? ST_SQL_DAMAGED : outcome;
        }
    }
    *out = head;
    return outcome == ST_SQL_ROW ? ST_SQL_DONE : outcome;
}

void st_head_touch(st_sqlite *self, st_head *head)
{
    if (!head->dirty && !head->listed) {
        head->next = self->heads.dirty;
        self->heads.dirty = head;
        head->listed = true;
    }
    head->dirty = true;
}

static void unlist(st_sqlite *self)
{
    for (st_head *head = self->heads.dirty; head != NULL; head = head->next) {
        head->listed = false;
    }
    self->heads.dirty = NULL;
}

void st_heads_forget(st_sqlite *self)
{
    unlist(self);
    for (size_t i = 0; i < ST_HEADS; i++) {
        self->heads.slots[i].row.key = 0;
        self->heads.slots[i].dirty = self->heads.slots[i].made = false;
    }
}

st_sql st_heads_flush(st_sqlite *self)
{
    st_sql outcome = ST_SQL_DONE;
    for (st_head *head = self->heads.dirty; head != NULL && outcome == ST_SQL_DONE;
         head = head->next) {
        outcome = flush(self, head);
    }
    unlist(self);
    return outcome;
}

/* --- records --- */

/* Removes a mesh, even if its row is damaged: the key of the row is found in the table's index. */
static st_sql remove_mesh(st_sqlite *self, uint64_t incarnation)
{
    st_head *head;
    st_mesh_row row = {.key = 0};
    bool good;
    st_sql outcome = place_of(self, incarnation, &head);
    if (outcome == ST_SQL_DONE) {
        outcome = flush(self, head);
    }
    if (outcome == ST_SQL_DONE) {
        head->row.key = 0;
        outcome = read_row(self, incarnation, &row, &good);
        /* A mesh that is removed was created before, so it must have a row; a missing row is a
         * failure. */
        outcome = outcome == ST_SQL_DONE ? ST_SQL_FAILED : outcome;
    }
    if (outcome == ST_SQL_ROW) {
        outcome = st_db_do(&self->db, ST_SQL_MESH_DELETE, "i", row.key);
    }
    if (outcome == ST_SQL_DONE) {
        outcome = st_db_do(&self->db, ST_SQL_KEPT_DELETE, "i", row.key);
        self->keys -= (uint64_t)sqlite3_changes(self->db.handle);
    }
    return outcome == ST_SQL_DONE ? st_purge_mesh(self, row.key) : outcome;
}

static st_sql make_mesh(st_sqlite *self, const st_queued *entry, st_head **out)
{
    st_head *head;
    st_sql outcome = place_of(self, entry->incarnation, &head);
    if (outcome == ST_SQL_DONE) {
        head->row = (st_mesh_row){.key = ++self->last_mesh,
                                  .card = {.incarnation = entry->incarnation},
                                  .origin = entry->incarnation,
                                  .chain = st_chain_of_origin(entry->incarnation),
                                  .base = 1};
        head->made = true;
        st_head_touch(self, head);
    }
    *out = head;
    return outcome;
}

/* Writes the row of a record. If mesh data or a large edit was written in advance for the record (a
 * stage), it now becomes part of the mesh. */
static st_sql add_frame(st_sqlite *self, st_head *head, const st_queued *entry, uint64_t chain)
{
    const bool is_base = entry->barrier && !entry->staged_edit &&
                         (entry->stage != NULL || entry->kind == ST_RECORD_CONTENT);
    st_sql outcome = ST_SQL_DONE;
    /* If a record's mesh data was written in advance, the row of that snapshot also contains the
     * encoded record, so the record needs no row of its own. */
    if (!is_base || entry->stage == NULL) {
        outcome = st_db_do(&self->db, ST_SQL_RECORD_MAKE, "iib", head->row.key, entry->number,
                           entry->frame, entry->size);
    }
    if (outcome == ST_SQL_DONE && entry->stage != NULL) {
        const st_snapshot_row row = {.key = entry->stage->key,
                                     .mesh = head->row.key,
                                     .number = entry->number,
                                     .revision = entry->revision,
                                     .parts = entry->stage->parts,
                                     .chain = chain,
                                     .facts = entry->frame,
                                     .facts_size = entry->size};
        outcome = st_stage_adopt(self, &row);
    }
    if (outcome == ST_SQL_DONE && is_base && entry->number > 1) {
        head->row.base = entry->number;
        /* The damage that the card (short description) of the mesh stated was in records that will
         * be deleted now, so it is removed from the card. */
        head->row.card.damage[0] = '\0';
        outcome = st_purge_before(self, head->row.key, entry->number, entry->stage == NULL);
    }
    return outcome;
}

static st_sql add_entry(st_sqlite *self, st_queued *entry)
{
    if (entry->kind == ST_RECORD_REMOVE) {
        return remove_mesh(self, entry->incarnation);
    }
    st_head *head;
    st_sql outcome = entry->number == 1 ? make_mesh(self, entry, &head)
                                        : st_head_find(self, entry->incarnation, &head);
    if (outcome != ST_SQL_DONE) {
        return outcome;
    }
    if (head == NULL || head->row.card.record + 1 != entry->number) {
        /* the number of the record is not one more than that of the last record on the disk */
        return ST_SQL_FAILED;
    }
    uint64_t chain = st_frame_seal(entry->frame, entry->size, head->row.chain);
    outcome = add_frame(self, head, entry, chain);
    head->row.chain = chain;
    head->row.card.record = entry->number;
    st_head_touch(self, head);
    return outcome;
}

/* Each time an Idempotency-Key is stored, up to two expired keys are deleted. Counting the keys of
 * a mesh takes longer, so it is done only for about one in CUT_EVERY new keys, chosen at random;
 * then keys beyond the limit are deleted. */
enum { CUT_EVERY = 64, CUT_MOST = 16 * CUT_EVERY };

static st_sql trim_keys(st_sqlite *self, const st_kept_row *row, uint32_t sum)
{
    st_sql outcome = st_db_do(&self->db, ST_SQL_KEPT_TRIM, "d", row->time - ST_KEPT_SECONDS);
    self->keys -= (uint64_t)sqlite3_changes(self->db.handle);
    if (outcome == ST_SQL_DONE && self->keys > self->most_keys) {
        outcome = st_db_do(&self->db, ST_SQL_KEPT_OLDEST, "");
        self->keys -= (uint64_t)sqlite3_changes(self->db.handle);
    }
    if (outcome == ST_SQL_DONE && sum % CUT_EVERY == 0) {
        outcome = st_db_do(&self->db, ST_SQL_KEPT_CUT, "iii", row->mesh, (int64_t)ST_KEPT_KEYS,
                           (int64_t)CUT_MOST);
        self->keys -= (uint64_t)sqlite3_changes(self->db.handle);
    }
    return outcome;
}

static st_sql keep_key(st_sqlite *self, const st_sqlite_room *room, const st_head *head)
{
    st_kept_row row = room->key;
    if (row.mesh != 0 && head == NULL) {
        /* the mesh and its keys were removed, so the new key is not stored */
        return ST_SQL_DONE;
    }
    row.mesh = row.mesh == 0 ? 0 : head->row.key;
    const uint32_t sum = st_kept_row_sum(&row);
    st_sql outcome =
        st_db_do(&self->db, ST_SQL_KEPT_MAKE, "itbdtiiiiiit", row.mesh, row.text, row.digest,
                 sizeof row.digest, row.time, row.id, row.incarnation, row.revision, row.metadata,
                 row.position, (uint64_t)row.made, (uint64_t)sum, row.holder);
    /* a key that replaces an equal key is counted twice until the daemon is restarted */
    self->keys++;
    return outcome == ST_SQL_DONE ? trim_keys(self, &row, sum) : outcome;
}

/* Stores the Idempotency-Key of a request that changed nothing. The mesh of the request may have
 * been removed in the meantime. */
static st_sql add_note(st_sqlite *self, const st_sqlite_room *room)
{
    st_head *head = NULL;
    st_sql outcome = ST_SQL_DONE;
    if (room->has_key && room->key.mesh != 0) {
        outcome = st_head_find(self, room->key.incarnation, &head);
    }
    if (outcome == ST_SQL_DAMAGED) {
        return ST_SQL_DONE; /* no key is stored for a mesh whose row is damaged */
    }
    return outcome == ST_SQL_DONE && room->has_key ? keep_key(self, room, head) : outcome;
}

static st_sql add_records(st_sqlite *self, st_sqlite_room *room)
{
    st_sql outcome = ST_SQL_DONE;
    st_head *head = NULL;
    for (size_t i = 0; i < room->count && outcome == ST_SQL_DONE; i++) {
        outcome = add_entry(self, &room->entries[i]);
    }
    if (outcome == ST_SQL_DONE && room->entries[room->count - 1].kind != ST_RECORD_REMOVE) {
        outcome = st_head_find(self, room->card.incarnation, &head);
        if (outcome == ST_SQL_DONE && head == NULL) {
            return ST_SQL_FAILED;
        }
    }
    if (outcome == ST_SQL_DONE && head != NULL) {
        st_card before = head->row.card;
        head->row.card = room->card;
        memcpy(head->row.card.damage, before.damage, sizeof before.damage);
        st_head_touch(self, head);
    }
    return outcome == ST_SQL_DONE && room->has_key ? keep_key(self, room, head) : outcome;
}

st_sql st_rows_add_room(st_sqlite *self, st_sqlite_room *room)
{
    st_sql outcome = room->count > 0 ? add_records(self, room) : add_note(self, room);
    return outcome == ST_SQL_DONE ? st_notes_add_job(self, room) : outcome;
}

st_sql st_rows_condemn(st_sqlite *self, const st_condemned *condemned)
{
    const st_finding *finding = &condemned->finding;
    st_head *head;
    st_sql outcome = st_head_find(self, finding->incarnation, &head);
    if (outcome == ST_SQL_DAMAGED) {
        return ST_SQL_DONE; /* the row of the mesh states damage already */
    }
    if (outcome == ST_SQL_DONE && head != NULL && head->row.base == finding->base &&
        head->row.card.damage[0] == '\0') {
        memcpy(head->row.card.damage, finding->damage, sizeof finding->damage);
        st_head_touch(self, head);
    }
    return outcome;
}
