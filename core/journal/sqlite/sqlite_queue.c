/* sqlite_queue.c - reserves memory for groups of records (such memory is called a room), appends
 * records, and queues the groups for the commit thread. */
#include "base/mem.h"
#include "journal/sqlite/sqlite_state.h"

#include <assert.h>
#include <string.h>

st_sqlite_room *st_room_of(st_item *item)
{
    return (st_sqlite_room *)((char *)item - offsetof(st_sqlite_room, item));
}

/* --- reserve --- */

static bool size_of_room(const st_room_need *need, size_t *out)
{
    size_t heads, entries;
    /* A record without its body takes at most ST_FRAME_HEAD bytes. The memory has space for one
     * record more than there are, because a record with a body is not stored with the others, but
     * directly before its body. */
    return !__builtin_mul_overflow(need->records + 1, (size_t)ST_FRAME_HEAD, &heads) &&
           !__builtin_mul_overflow(need->records, sizeof(st_queued), &entries) &&
           !__builtin_add_overflow(heads, entries, out) &&
           !__builtin_add_overflow(*out, sizeof(st_sqlite_room), out) &&
           !__builtin_add_overflow(*out, need->bytes, out);
}

/* Decides whether the queue accepts a group of records of `size` bytes now. The caller holds
 * self->lock. */
static st_status admit(const st_sqlite *self, size_t size, bool freeing)
{
    if (self->mode == ST_WRITES_FAILED) {
        return ST_FAILED;
    }
    if (self->mode == ST_WRITES_FULL && (self->losing || !freeing)) {
        return ST_FULL;
    }
    if (self->charged > 0 &&
        (size > self->queue_bytes || self->charged > self->queue_bytes - size)) {
        return ST_BEHIND;
    }
    return ST_OK;
}

st_status st_sqlite_reserve(void *context, const st_room_need *need, st_room **out)
{
    st_sqlite *self = context;
    size_t size;
    if (need->bytes > ST_MOST_BODY) {
        return ST_TOO_LARGE;
    }
    st_sqlite_room *room = size_of_room(need, &size) ? he_mem_alloc(size) : NULL;
    if (room == NULL) {
        return ST_NO_MEMORY;
    }
    memset(room, 0, sizeof *room);
    room->item.kind = ST_ITEM_ROOM;
    room->charge = size;
    room->freeing = need->freeing;
    room->most = need->records;
    room->heads = (unsigned char *)(room->entries + need->records);
    room->room.bytes = room->heads + (need->records + 1) * ST_FRAME_HEAD;
    room->room.size = need->bytes;
    pthread_mutex_lock(&self->lock);
    st_status status = admit(self, size, need->freeing);
    if (status == ST_OK) {
        room->generation = self->generation;
        self->charged += size;
        self->rooms++;
    }
    pthread_mutex_unlock(&self->lock);
    if (status != ST_OK) {
        he_mem_free(room);
        return status;
    }
    *out = &room->room;
    return ST_OK;
}

/* Counts memory that was reserved for a group of records as used or given back. The caller holds
 * self->lock. */
static void come_back(st_sqlite *self, const st_sqlite_room *room)
{
    self->rooms--;
    if (room->generation != self->generation && --self->old_rooms == 0) {
        pthread_cond_signal(&self->work);
    }
}

void st_sqlite_leave(void *context, st_room *left)
{
    st_sqlite *self = context;
    if (left == NULL) {
        return;
    }
    st_sqlite_room *room = (st_sqlite_room *)left;
    pthread_mutex_lock(&self->lock);
    come_back(self, room);
    self->charged -= room->charge;
    pthread_mutex_unlock(&self->lock);
    he_mem_free(room);
}

/* --- append --- */

static void fill_entry(st_sqlite_room *room, const st_record *record)
{
    st_queued *entry = &room->entries[room->count];
    *entry = (st_queued){.kind = record->kind,
                         .barrier = record->barrier,
                         .incarnation = record->incarnation,
                         .number = record->number,
                         .revision = record->revision,
                         .frame = room->heads + room->count * ST_FRAME_HEAD,
                         .stage = record->stage,
                         .staged_edit = record->staged_edit};
    room->count++;
    if (record->body == NULL) {
        entry->size = st_frame_write(record, entry->frame);
        return;
    }
    unsigned char head[ST_FRAME_HEAD];
    st_record bodyless = *record;
    assert(record->body == room->room.bytes);
    bodyless.body_size = 0;
    size_t size = st_frame_write(&bodyless, head);
    entry->frame = room->room.bytes - size;
    entry->size = size + record->body_size;
    memcpy(entry->frame, head, size);
}

void st_room_key(st_sqlite_room *room, const st_kept_key *kept)
{
    const st_record_key *key = &kept->key;
    st_copy_text(room->key_text, key->text, ST_KEY_TEXT);
    st_copy_text(room->card.id, kept->id, ST_MESH_ID);
    st_copy_text(room->key_holder, key->holder == NULL ? "" : key->holder, ST_KEY_HOLDER);
    room->has_key = true;
    room->key = (st_kept_row){.mesh = key->of_store ? 0 : -1,
                              .holder = room->key_holder,
                              .text = room->key_text,
                              .id = room->card.id,
                              .digest = {key->digest[0], key->digest[1]},
                              .time = key->time,
                              .incarnation = kept->incarnation,
                              .revision = kept->revision,
                              .metadata = kept->metadata,
                              .made = key->of_store};
}

/* Notes in a group of records which job made them. The answer of the job does not exist yet, so 201
 * or 204 is stored as its HTTP status; a later note replaces it by the status of the answer. */
static void fill_job(st_sqlite_room *room, const st_record *record, bool made)
{
    enum { CREATED = 201, NO_CONTENT = 204 };
    st_copy_text(room->job.id, record->job, ST_JOB_ID);
    room->job_word = ST_JOB_WORK;
    room->job.mesh = room->card.id;
    room->job.status = made ? CREATED : NO_CONTENT;
    room->job.finished = record->time;
}

uint64_t st_room_push(st_sqlite *self, st_sqlite_room *room, uint64_t positions)
{
    pthread_mutex_lock(&self->lock);
    come_back(self, room);
    uint64_t position = self->newest += positions;
    room->last = position;
    room->key.position = position;
    self->meshes += room->meshes;
    st_queue_put(self, &room->item);
    pthread_mutex_unlock(&self->lock);
    return position;
}

uint64_t st_sqlite_append(void *context, st_room *taken, const st_record *records, size_t count)
{
    st_sqlite *self = context;
    st_sqlite_room *room = (st_sqlite_room *)taken;
    const st_record *last = &records[count - 1];
    uint64_t made = 0, removed = 0;
    assert(room != NULL && count > 0 && count <= room->most);
    for (size_t i = 0; i < count; i++) {
        fill_entry(room, &records[i]);
        removed += records[i].kind == ST_RECORD_REMOVE;
        made += records[i].number == 1;
    }
    st_card_of_record(last, &room->card);
    if (last->key != NULL) {
        st_room_key(room, &(st_kept_key){.key = *last->key,
                                         .id = last->id,
                                         .incarnation = last->incarnation,
                                         .revision = last->revision,
                                         .metadata = last->metadata});
    }
    if (last->job != NULL) {
        fill_job(room, last, made > 0);
    }
    room->meshes = made - removed;
    return st_room_push(self, room, count);
}

/* --- the queue --- */

void st_queue_put(st_sqlite *self, st_item *item)
{
    item->next = NULL;
    *self->end = item;
    self->end = &item->next;
    if (self->idle) {
        pthread_cond_signal(&self->work);
    }
}

void st_queue_settle(st_sqlite *self)
{
    pthread_mutex_lock(&self->lock);
    const uint64_t newest = self->newest;
    self->waiting++;
    while (self->told < newest) {
        pthread_cond_wait(&self->moved, &self->lock);
    }
    self->waiting--;
    pthread_mutex_unlock(&self->lock);
}

uint64_t st_sqlite_count(void *context)
{
    st_sqlite *self = context;
    pthread_mutex_lock(&self->lock);
    uint64_t count = self->meshes;
    pthread_mutex_unlock(&self->lock);
    return count;
}

void st_sqlite_health(void *context, st_health *out)
{
    static const st_status of_mode[] = {
        [ST_WRITES] = ST_OK, [ST_WRITES_FULL] = ST_FULL, [ST_WRITES_FAILED] = ST_FAILED};
    st_sqlite *self = context;
    pthread_mutex_lock(&self->lock);
    out->status = of_mode[self->mode];
    out->fulls = self->fulls;
    out->damaged_keys = self->damaged_keys;
    memcpy(out->reason, self->refusal, sizeof out->reason);
    pthread_mutex_unlock(&self->lock);
}

void st_sqlite_measure(void *context, st_journal_measures *out)
{
    st_sqlite *self = context;
    st_histogram_copy(&self->commits, &out->commits);
    st_histogram_copy(&self->syncs, &out->syncs);
    st_histogram_copy(&self->groups, &out->groups);
    st_histogram_copy(&self->checkpoints, &out->checkpoints);
    pthread_mutex_lock(&self->lock);
    out->behind = self->newest - self->told;
    out->lost = self->lost;
    out->queued = self->charged;
    pthread_mutex_unlock(&self->lock);
    out->most_queued = self->queue_bytes;
    out->log = self->log_pages * ST_LOG_PAGE_BYTES;
}

void st_sqlite_listen(void *context, const st_journal_listener *listener)
{
    st_sqlite *self = context;
    pthread_mutex_lock(&self->telling);
    self->is_heard = listener != NULL;
    if (listener != NULL) {
        self->listener = *listener;
        pthread_mutex_lock(&self->lock);
        uint64_t told = self->told;
        pthread_mutex_unlock(&self->lock);
        if (told > 0) {
            listener->moved(listener->context, told);
        }
    }
    pthread_mutex_unlock(&self->telling);
}
