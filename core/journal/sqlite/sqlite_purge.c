/* sqlite_purge.c - deletes rows that are no longer needed. The transaction that makes rows
 * unnecessary adds a row to the table `purge`; the rows are deleted later, some at a time. A row of
 * `purge` whose checksum is wrong is skipped, because keeping too much is safe and deleting too
 * much is not. Rows in damaged pages are never deleted. They do no harm: their mesh is removed, and
 * no other mesh ever gets its key. */
#include "journal/sqlite/sqlite_state.h"

st_sql st_purge_add(st_sqlite *self, st_purge_kind kind, int64_t key, uint64_t before)
{
    const st_purge_row row = {kind, key, before};
    self->purged = false;
    return st_db_do(&self->db, ST_SQL_PURGE_MAKE, "iiii", (int64_t)kind, key, before,
                    (uint64_t)st_purge_row_sum(&row));
}

/* Deletes the snapshots (stored mesh data) of a mesh that were taken before record number `before`.
 * After each deletion the query is run again, because the deletion changes the table that the query
 * reads. */
static st_sql drop_snapshots(st_sqlite *self, int64_t mesh, uint64_t before)
{
    for (;;) {
        sqlite3_stmt *s;
        st_snapshot_row row = {.key = 0};
        bool good = false;
        st_sql outcome = st_db_find(&self->db, ST_SQL_SNAPSHOTS_BEFORE, &s, "ii", mesh, before);
        while (outcome == ST_SQL_ROW && !good) {
            good = st_snapshot_row_read(s, &row);
            if (good) {
                st_db_reset(s);
            } else {
                outcome = st_db_step(&self->db, s);
            }
        }
        if (!good) {
            return outcome;
        }
        outcome = st_db_do(&self->db, ST_SQL_SNAPSHOT_DELETE, "i", row.key);
        if (outcome == ST_SQL_DONE) {
            outcome = st_purge_add(self, ST_PURGE_PARTS, row.key, 0);
        }
        if (outcome != ST_SQL_DONE) {
            return outcome;
        }
    }
}

st_sql st_purge_before(st_sqlite *self, int64_t mesh, uint64_t base, bool is_inline)
{
    st_sql outcome = drop_snapshots(self, mesh, base);
    return outcome == ST_SQL_DONE
               ? st_purge_add(self, ST_PURGE_RECORDS, mesh, is_inline ? base : base + 1)
               : outcome;
}

st_sql st_purge_mesh(st_sqlite *self, int64_t mesh)
{
    st_sql outcome = drop_snapshots(self, mesh, INT64_MAX);
    return outcome == ST_SQL_DONE ? st_purge_add(self, ST_PURGE_MESH, mesh, INT64_MAX) : outcome;
}

st_sql st_purge_dead_stages(st_sqlite *self)
{
    return drop_snapshots(self, 0, INT64_MAX);
}

/* --- deleting in slices --- */

/* Finds the records that are deleted in one step, about `bytes` bytes of the oldest records. *last
 * is set to the number of the last of them, or to 0 if there are no records. */
static st_sql end_of_slice(st_sqlite *self, const st_purge_row *row, size_t bytes, uint64_t *last)
{
    sqlite3_stmt *s;
    *last = 0;
    st_sql outcome = st_db_find(&self->db, ST_SQL_RECORDS_FIRST, &s, "ii", row->key, row->before);
    while (outcome == ST_SQL_ROW) {
        const size_t size = (size_t)sqlite3_column_int64(s, 1);
        *last = st_db_word(s, 0);
        if (size >= bytes) {
            st_db_reset(s);
            return ST_SQL_DONE;
        }
        bytes -= size;
        outcome = st_db_step(&self->db, s);
    }
    return outcome;
}

static st_sql purge_records(st_sqlite *self, const st_purge_row *row, size_t bytes, bool *gone)
{
    uint64_t last;
    st_sql outcome = end_of_slice(self, row, bytes, &last);
    *gone = last == 0;
    return outcome == ST_SQL_DONE && last != 0
               ? st_db_do(&self->db, ST_SQL_RECORDS_DELETE, "ii", row->key, last)
               : outcome;
}

static st_sql purge_parts(st_sqlite *self, const st_purge_row *row, size_t bytes, bool *gone)
{
    const size_t parts = bytes / HE_STORED_PART + 1;
    st_sql outcome = st_db_do(&self->db, ST_SQL_PARTS_DELETE, "ii", row->key, (uint64_t)parts);
    *gone = (size_t)sqlite3_changes(self->db.handle) < parts;
    return outcome;
}

static st_sql next_row(st_sqlite *self, st_purge_row *out, bool *found)
{
    sqlite3_stmt *s;
    *found = false;
    st_sql outcome = st_db_find(&self->db, ST_SQL_PURGE_ALL, &s, "");
    while (outcome == ST_SQL_ROW) {
        if (st_purge_row_read(s, out)) {
            *found = true;
            st_db_reset(s);
            return ST_SQL_DONE;
        }
        outcome = st_db_step(&self->db, s);
    }
    return outcome;
}

/* At least SPARE_PAGES pages of the database, and at least 1/SPARE_SHARE of its pages, are kept
 * free for new rows. Other free pages are returned to the file system; while the disk is full, all
 * free pages are. */
enum { SPARE_PAGES = 4096, SPARE_SHARE = 4 };

static st_sql shrink(st_sqlite *self, bool *done)
{
    int64_t spare = 0, pages = 0;
    st_sql outcome = st_db_number(&self->db, "PRAGMA freelist_count", 0, &spare);
    if (outcome == ST_SQL_DONE) {
        outcome = st_db_number(&self->db, "PRAGMA page_count", 0, &pages);
    }
    *done = self->mode == ST_WRITES_FULL ? spare == 0
                                         : spare <= SPARE_PAGES || spare <= pages / SPARE_SHARE;
    return outcome == ST_SQL_DONE && !*done ? st_db_run(&self->db, "PRAGMA incremental_vacuum(64)")
                                            : outcome;
}

/* Deletes rows that a row of the table `purge` lists, about `bytes` bytes of them. The row of
 * `purge` is deleted when nothing that it lists is left, or what is left cannot be deleted. */
static st_sql purge_row(st_sqlite *self, const st_purge_row *row, size_t bytes)
{
    bool gone = row->kind == self->stuck.kind && row->key == self->stuck.key;
    st_sql outcome = ST_SQL_DONE;
    if (!gone) {
        self->purging = *row;
        outcome = row->kind == ST_PURGE_PARTS ? purge_parts(self, row, bytes, &gone)
                                              : purge_records(self, row, bytes, &gone);
    }
    return outcome == ST_SQL_DONE && gone
               ? st_db_do(&self->db, ST_SQL_PURGE_DELETE, "ii", (int64_t)row->kind, row->key)
               : outcome;
}

static st_sql purge_slice(st_sqlite *self, size_t bytes, bool *done)
{
    st_purge_row row;
    bool found;
    st_sql outcome = next_row(self, &row, &found);
    if (outcome != ST_SQL_DONE) {
        return outcome;
    }
    return found ? purge_row(self, &row, bytes) : shrink(self, done);
}

st_sql st_purge_slice(st_sqlite *self, size_t bytes, bool *done)
{
    *done = self->purge_ended;
    self->purging.kind = 0;
    st_sql outcome = *done ? ST_SQL_DONE : purge_slice(self, bytes, done);
    self->purge_damaged = outcome == ST_SQL_DAMAGED;
    return outcome;
}

bool st_purge_gives_up(st_sqlite *self)
{
    const bool damaged = self->purge_damaged;
    self->purge_damaged = false;
    if (damaged && self->purging.kind != 0) {
        self->stuck = self->purging;
    } else if (damaged) {
        self->purge_ended = true;
    }
    return damaged;
}
