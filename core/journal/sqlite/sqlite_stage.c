/* sqlite_stage.c - writes mesh data and large edits to the disk in parts before their records are
 * published; data written in this way is called a stage. The calling thread encodes some parts and
 * waits until the commit thread has written them, together with the records of other threads; then
 * it encodes the next parts. */
#include "base/mem.h"
#include "journal/part_packing.h"
#include "journal/sqlite/sqlite_state.h"
#include "stored/bytes.h"

#include <string.h>

/* --- the thread that stages --- */

/* The data that is written to the disk in advance: all data of a mesh, or the bytes of an encoded
 * edit that are not written yet. */
typedef struct source {
    he_stored_writer *content;
    const unsigned char *edit;
    size_t left;
} source;

/* Encodes the next part of the data that is written in advance. Returns the number of bytes of the
 * part; 0 after the last part. */
static size_t next_part(source *from, unsigned char *to, unsigned *coding)
{
    if (from->content != NULL) {
        return he_stored_writer_next(from->content, to, coding);
    }
    const size_t size = from->left < HE_STORED_PART ? from->left : HE_STORED_PART;
    memcpy(to, from->edit, size);
    from->edit += size;
    from->left -= size;
    *coding = HE_CODING_PLAIN;
    return size;
}

/* Fills a slice, an array of at most ST_SLICE_PARTS parts, with the next parts of the data. Returns
 * false if the data ended before the slice was full. */
static bool fill_slice(st_slice *slice, source *from, st_packer *packer)
{
    *slice = (st_slice){.count = 0};
    while (slice->count < ST_SLICE_PARTS) {
        unsigned char *bytes = slice->bytes[slice->count];
        unsigned coding;
        size_t size = next_part(from, bytes + ST_PART_HEAD, &coding);
        if (size == 0) {
            return false;
        }
        size = st_part_pack(packer, bytes + ST_PART_HEAD, size, &coding);
        bytes[ST_PART_HEAD - 1] = (unsigned char)coding;
        slice->sizes[slice->count++] = ST_PART_HEAD + size;
    }
    return true;
}

/* Returns ST_OK if data may be written in advance now, else why the journal refuses it. The caller
 * holds self->lock. */
static st_status refusal(const st_sqlite *self)
{
    return self->mode == ST_WRITES ? ST_OK : self->mode == ST_WRITES_FULL ? ST_FULL : ST_FAILED;
}

static st_status write_slice(st_sqlite *self, st_stage *stage)
{
    pthread_mutex_lock(&self->lock);
    stage->status = refusal(self);
    if (stage->status == ST_OK) {
        st_stage **end = &self->stages;
        while (*end != NULL) {
            end = &(*end)->next;
        }
        *end = stage;
        stage->next = NULL;
        stage->waits = true;
        if (self->idle) {
            pthread_cond_signal(&self->work);
        }
    }
    self->waiting++;
    while (stage->waits) {
        pthread_cond_wait(&self->moved, &self->lock);
    }
    self->waiting--;
    pthread_mutex_unlock(&self->lock);
    return stage->status;
}

static st_status stage_parts(st_sqlite *self, source *from, uint64_t parts, st_stage **out)
{
    st_stage *stage = he_mem_zero(1, sizeof *stage);
    st_slice *slice = he_mem_alloc(sizeof *slice);
    if (stage == NULL || slice == NULL) {
        he_mem_free(stage);
        he_mem_free(slice);
        return ST_NO_MEMORY;
    }
    /* An edit is not compressed, because a load reads its parts into one block of memory as they
     * are. */
    st_packer *packer = from->content == NULL ? NULL : st_packer_new();
    stage->slice = slice;
    stage->parts = parts;
    st_status status = ST_OK;
    for (bool more = true; more && status == ST_OK;) {
        more = fill_slice(slice, from, packer);
        status = slice->count == 0 ? ST_OK : write_slice(self, stage);
    }
    st_packer_free(packer);
    he_mem_free(slice);
    stage->slice = NULL;
    if (status != ST_OK) {
        st_sqlite_unstage(self, stage);
        return status;
    }
    *out = stage;
    return ST_OK;
}

st_status st_sqlite_stage(void *context, const he_mesh *content, st_stage **out)
{
    he_stored_writer writer;
    he_stored_writer_init(&writer, content);
    return stage_parts(context, &(source){.content = &writer}, he_stored_parts(content), out);
}

st_status st_sqlite_stage_edit(void *context, const unsigned char *bytes, size_t size,
                               st_stage **out)
{
    const uint64_t parts = size / HE_STORED_PART + (size % HE_STORED_PART != 0);
    return stage_parts(context, &(source){.edit = bytes, .left = size}, parts, out);
}

static void queue(st_sqlite *self, st_stage *stage, st_item_kind kind)
{
    pthread_mutex_lock(&self->lock);
    stage->item.kind = kind;
    st_queue_put(self, &stage->item);
    pthread_mutex_unlock(&self->lock);
}

void st_sqlite_unstage(void *context, st_stage *stage)
{
    if (stage != NULL && stage->key == 0) {
        /* no part is on the disk yet, so nothing must be deleted there */
        he_mem_free(stage);
    } else if (stage != NULL) {
        queue(context, stage, ST_ITEM_UNSTAGE);
    }
}

void st_sqlite_rebase(void *context, st_stage *stage, const st_record *facts, uint64_t needed)
{
    st_record content = *facts;
    content.kind = ST_RECORD_CONTENT;
    content.stage = stage;
    content.body_size = 0;
    stage->facts_size = st_frame_write(&content, stage->facts);
    stage->incarnation = facts->incarnation;
    stage->number = facts->number;
    stage->revision = facts->revision;
    stage->time = facts->time;
    stage->needed = needed;
    queue(context, stage, ST_ITEM_REBASE);
}

/* --- the commit thread --- */

static st_sql put_row(st_sqlite *self, const st_snapshot_row *row)
{
    return st_db_do(&self->db, ST_SQL_SNAPSHOT_MAKE, "iiiiiiibi", row->key, row->mesh, row->number,
                    row->revision, row->parts, row->process, row->chain, row->facts,
                    row->facts_size, (uint64_t)st_snapshot_row_sum(row));
}

st_sql st_stage_write(st_sqlite *self, st_stage *stage, size_t most)
{
    st_slice *slice = stage->slice;
    st_sql outcome = ST_SQL_DONE;
    int64_t key = stage->key;
    if (key == 0) {
        key = ++self->last_snapshot;
        outcome = put_row(self, &(st_snapshot_row){.key = key,
                                                   .parts = stage->parts,
                                                   .process = self->process,
                                                   .facts = (const unsigned char *)""});
    }
    size_t count = 0;
    for (; count < most && slice->written + count < slice->count && outcome == ST_SQL_DONE;
         count++) {
        unsigned char *bytes = slice->bytes[slice->written + count];
        const size_t size = slice->sizes[slice->written + count];
        const uint64_t part = stage->written + count;
        (void)he_put_u32(bytes, st_part_sum(key, part, bytes + 4, size - 4));
        outcome = st_db_do(&self->db, ST_SQL_PART_MAKE, "iib", key, part, bytes, size);
    }
    /* The parts written here count as written only after the transaction is committed
     * (st_stage_written). */
    stage->writing = outcome == ST_SQL_DONE ? count : 0;
    stage->new_key = key;
    return outcome;
}

void st_stage_written(st_stage *stage)
{
    stage->key = stage->new_key;
    stage->written += stage->writing;
    stage->slice->written += stage->writing;
    stage->writing = 0;
}

st_sql st_stage_adopt(st_sqlite *self, const st_snapshot_row *row)
{
    return put_row(self, row);
}

st_sql st_stage_drop(st_sqlite *self, const st_stage *stage)
{
    if (stage->key == 0) {
        return ST_SQL_DONE;
    }
    st_sql outcome = st_db_do(&self->db, ST_SQL_SNAPSHOT_DELETE, "i", stage->key);
    return outcome == ST_SQL_DONE ? st_purge_add(self, ST_PURGE_PARTS, stage->key, 0) : outcome;
}

/* The record after which the mesh had the staged data. If that record was lost, another record on
 * the disk may have its number. */
typedef struct staged_record {
    bool same; /* true if the record on the disk is the record from which the data was taken */
    /* `chain`: the hash by which this record is connected to the record before it (record_bytes.h);
     * `next`: the hash by which the next record must be connected to this record */
    uint64_t chain, next;
} staged_record;

static st_sql read_record(st_sqlite *self, const st_stage *stage, const st_head *head,
                          staged_record *out)
{
    sqlite3_stmt *s;
    st_frame frame;
    size_t size;
    *out = (staged_record){.same = false};
    st_sql outcome = st_db_find(&self->db, ST_SQL_RECORD, &s, "ii", head->row.key, stage->number);
    if (outcome != ST_SQL_ROW) {
        return outcome;
    }
    const unsigned char *bytes = st_db_bytes(s, 0, &size);
    if (st_frame_read(bytes, size, &frame, NULL) == HE_OK && frame.record.number == stage->number &&
        frame.record.revision == stage->revision && frame.record.time == stage->time) {
        *out = (staged_record){
            .same = true, .chain = frame.chain, .next = st_frame_next_chain(bytes, size)};
    }
    st_db_reset(s);
    return ST_SQL_DONE;
}

/* Returns true if a row of the table of snapshots describes mesh data; other rows of this table
 * describe large edits. */
static bool is_content(const st_snapshot_row *row)
{
    st_frame frame;
    return st_frame_read(row->facts, row->facts_size, &frame, NULL) == HE_OK &&
           !frame.record.staged_edit;
}

/* A base is a record from which a mesh can be loaded. Finds the newest base of the mesh that is
 * newer than its present base and has a revision of at most `needed`. Sets *out to the number of
 * the record, or to 0 if there is no such base. */
static st_sql find_base(st_sqlite *self, const st_head *head, uint64_t needed, uint64_t *out)
{
    sqlite3_stmt *s;
    st_snapshot_row row;
    *out = 0;
    st_sql outcome =
        st_db_find(&self->db, ST_SQL_SNAPSHOTS_FROM, &s, "ii", head->row.key, head->row.base + 1);
    while (outcome == ST_SQL_ROW && *out == 0) {
        if (st_snapshot_row_read(s, &row) && row.revision <= needed && is_content(&row)) {
            *out = row.number;
            st_db_reset(s);
            return ST_SQL_DONE;
        }
        outcome = st_db_step(&self->db, s);
    }
    return outcome;
}

st_sql st_stage_rebase(st_sqlite *self, const st_stage *stage)
{
    st_head *head;
    staged_record record = {.same = false};
    uint64_t base = 0;
    st_sql outcome = st_head_find(self, stage->incarnation, &head);
    if (outcome == ST_SQL_DAMAGED) {
        head = NULL;
    } else if (outcome != ST_SQL_DONE) {
        return outcome;
    }
    /* The base is the record from which the mesh is loaded. Data that shows the mesh before the
     * present base would never be read. */
    if (head != NULL && stage->number > head->row.base) {
        outcome = read_record(self, stage, head, &record);
    }
    if (!record.same) {
        return head != NULL && outcome != ST_SQL_DONE ? outcome : st_stage_drop(self, stage);
    }
    unsigned char facts[ST_FRAME_HEAD];
    memcpy(facts, stage->facts, stage->facts_size);
    st_frame_seal(facts, stage->facts_size, record.chain);
    outcome = put_row(self, &(st_snapshot_row){.key = stage->key,
                                               .mesh = head->row.key,
                                               .number = stage->number,
                                               .revision = stage->revision,
                                               .parts = stage->parts,
                                               .chain = record.next,
                                               .facts = facts,
                                               .facts_size = stage->facts_size});
    if (outcome == ST_SQL_DONE) {
        outcome = find_base(self, head, stage->needed, &base);
    }
    if (outcome == ST_SQL_DONE && base != 0) {
        head->row.base = base;
        /* The damage that the card (short description) of the mesh states may be in records that
         * are deleted now, so it is removed from the card. The next load checks the remaining
         * records again. */
        head->row.card.damage[0] = '\0';
        st_head_touch(self, head);
        outcome = st_purge_before(self, head->row.key, base, false);
    }
    return outcome;
}
