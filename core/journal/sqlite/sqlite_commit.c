/* sqlite_commit.c - the commit thread, which writes the queue to the database. It is in one of
 * three states:
 *
 *     WRITES   All queued items become one group (take_group), which is committed together with
 *              some background work (commit_group). If that fails, the state becomes FULL or
 *              FAILED.
 *     FULL     The disk is full, and all queued records are lost (lose). Only removals of meshes
 *              are accepted; a file that reserves disk space, the ballast, is deleted to make room
 *              for them. Each second seek_space tries to return to WRITES.
 *     FAILED   The disk has failed. All records that are appended are lost. This state never
 *              ends. */
#include "base/mem.h"
#include "journal/sqlite/sqlite_state.h"
#include "system/clock.h"
#include "system/thread_start.h"

#include <stdio.h>

enum {
    GROUP_RECORDS = 4096,
    GROUP_BYTES = 8 << 20,
    /* Bytes of background work in one transaction while records are waiting to be written. */
    SLICE_BESIDE = 64 << 10,
    /* Bytes of background work in one transaction while no record is waiting. A record that arrives
     * during this transaction must wait for its end. */
    SLICE_ALONE = 256 << 10,
    /* A checkpoint copies the write-ahead log into the database. It is made when the log has grown
     * by this many pages. Records wait for a checkpoint, the longer the more pages it copies. While
     * background work fills the log, checkpoints are made more often, so that each takes no longer
     * than one transaction with background work. */
    CHECKPOINT_PAGES = 1000,
    CHECKPOINT_PAGES_BESIDE = 256,
    /* While the write-ahead log has more bytes than this, meshes are not loaded until a checkpoint
     * has copied the log. */
    LONG_LOG = 64 << 20,
    SECOND = 1000000,
    RETRY_MICROS = 20000,
    CLOSING_TRIES = 50
};

/* The items of the queue that one transaction writes to the database. */
typedef struct group {
    st_item *first, *last;
    uint64_t records /* number of records and notes */, position, made, removed;
    bool freeing;
    /* The stage (mesh data that is written before its record) of which this transaction writes some
     * parts. If it is NULL, the background work is a purge, which deletes rows that are not
     * needed. */
    st_stage *stage;
    size_t slice; /* bytes of background work in this transaction; 0: none */
    /* True if no rows are left to be purged (deleted) once this transaction is committed. */
    bool purged;
} group;

/* --- taking items from the queue; the caller holds self->lock --- */

static void count_room(group *g, const st_sqlite_room *room)
{
    for (size_t i = 0; i < room->count; i++) {
        g->made += room->entries[i].number == 1;
        g->removed += room->entries[i].kind == ST_RECORD_REMOVE;
    }
    g->records += room->count > 0 ? room->count : 1;
    g->position = room->last;
    g->freeing |= room->freeing;
}

static void take_group(st_sqlite *self, group *g)
{
    size_t bytes = 0;
    *g = (group){.first = self->first, .position = self->told, .stage = self->stages};
    st_item **at = &self->first;
    while (*at != NULL && g->records < GROUP_RECORDS && bytes < GROUP_BYTES) {
        g->last = *at;
        if (g->last->kind == ST_ITEM_ROOM) {
            count_room(g, st_room_of(g->last));
            bytes += st_room_of(g->last)->charge;
        }
        at = &g->last->next;
    }
    if (g->last == NULL) {
        g->first = NULL;
    } else {
        self->first = *at;
        g->last->next = NULL;
        if (self->first == NULL) {
            self->end = &self->first;
        }
    }
    g->slice = g->stage != NULL || !self->purged ? g->records > 0 ? SLICE_BESIDE : SLICE_ALONE : 0;
}

static void put_back(st_sqlite *self, const group *g)
{
    if (g->last != NULL) {
        g->last->next = self->first;
        if (self->first == NULL) {
            self->end = &g->last->next;
        }
        self->first = g->first;
    }
}

/* --- reporting to the listener --- */

static void tell(st_sqlite *self, const st_loss *loss, uint64_t position)
{
    pthread_mutex_lock(&self->telling);
    if (self->is_heard && loss != NULL) {
        self->listener.lost(self->listener.context, loss);
    }
    if (self->is_heard) {
        self->listener.moved(self->listener.context, position);
    }
    pthread_mutex_unlock(&self->telling);
}

static void free_item(st_item *item)
{
    switch (item->kind) {
    case ST_ITEM_ROOM: {
        st_sqlite_room *room = st_room_of(item);
        for (size_t i = 0; i < room->count; i++) {
            he_mem_free(room->entries[i].stage);
        }
        he_mem_free(room);
        break;
    }
    case ST_ITEM_REBASE:
    case ST_ITEM_UNSTAGE:
        he_mem_free((char *)item - offsetof(st_stage, item));
        break;
    case ST_ITEM_CONDEMN:
        he_mem_free((char *)item - offsetof(st_condemned, item));
        break;
    }
}

static void free_items(st_item *item)
{
    while (item != NULL) {
        st_item *next = item->next;
        free_item(item);
        item = next;
    }
}

static uint64_t charge_of(const st_item *item)
{
    uint64_t charge = 0;
    for (; item != NULL; item = item->next) {
        charge += item->kind == ST_ITEM_ROOM ? st_room_of((st_item *)item)->charge : 0;
    }
    return charge;
}

/* Ends the work on the parts of a stage (mesh data that is written before its record) that a thread
 * has passed to the commit thread. `status` is ST_OK if the parts were written, else why they never
 * will be. The caller holds self->lock. */
static void end_slice(st_sqlite *self, st_stage *stage, st_status status)
{
    st_stage **at = &self->stages;
    while (*at != stage) {
        at = &(*at)->next;
    }
    *at = stage->next;
    stage->status = status;
    stage->waits = false;
    pthread_cond_broadcast(&self->moved);
}

/* Sets the position up to which every record is either durable or reported as lost. The caller
 * holds self->lock. */
static void move(st_sqlite *self, uint64_t position)
{
    self->told = position;
    if (self->waiting > 0) {
        pthread_cond_broadcast(&self->moved);
    }
}

/* --- faults of the disk --- */

static void stop_writing(st_sqlite *self, st_write_mode mode)
{
    pthread_mutex_lock(&self->lock);
    if (mode > self->mode) {
        self->mode = mode;
        self->fulls += mode == ST_WRITES_FULL;
    }
    self->generation++;
    self->old_rooms = self->rooms;
    self->losing = true;
    self->log_is_long = false;
    while (self->stages != NULL) {
        end_slice(self, self->stages, mode == ST_WRITES_FULL ? ST_FULL : ST_FAILED);
    }
    pthread_cond_broadcast(&self->moved);
    pthread_mutex_unlock(&self->lock);
}

/* Takes the lost items from the queue: all groups of records, and in the state FAILED every other
 * item, too. The caller holds self->lock. */
static st_item *take_lost(st_sqlite *self)
{
    st_item *lost = NULL, **lost_end = &lost, **at = &self->first;
    while (*at != NULL) {
        st_item *item = *at;
        if (item->kind == ST_ITEM_ROOM || self->mode == ST_WRITES_FAILED) {
            *at = item->next;
            item->next = NULL;
            *lost_end = item;
            lost_end = &item->next;
        } else {
            at = &item->next;
        }
    }
    self->end = at;
    return lost;
}

static bool has_room(const st_sqlite *self)
{
    for (const st_item *item = self->first; item != NULL; item = item->next) {
        if (item->kind == ST_ITEM_ROOM) {
            return true;
        }
    }
    return false;
}

/* The records of this group are lost. Queues the deletion of the mesh data that was written in
 * advance for them. The caller holds self->lock. */
static void unstage(st_sqlite *self, st_sqlite_room *room)
{
    for (size_t i = 0; i < room->count; i++) {
        st_stage *stage = room->entries[i].stage;
        if (stage != NULL && self->mode != ST_WRITES_FAILED) {
            stage->item.kind = ST_ITEM_UNSTAGE;
            st_queue_put(self, &stage->item);
            room->entries[i].stage = NULL;
        }
    }
}

/* Drops all queued records and reports them as lost. Records that are appended later into memory
 * that was reserved before the loss will be lost, too. The caller holds self->lock, which is
 * released during the report. */
static void lose(st_sqlite *self)
{
    st_item *lost = take_lost(self);
    group g = {.position = self->told};
    for (st_item *item = lost; item != NULL; item = item->next) {
        if (item->kind == ST_ITEM_ROOM) {
            count_room(&g, st_room_of(item));
            unstage(self, st_room_of(item));
        }
    }
    self->meshes += g.removed - g.made;
    self->lost += g.records;
    const bool full = self->mode == ST_WRITES_FULL;
    const st_loss loss = {.from = self->told + 1,
                          .to = g.position,
                          .status = full ? ST_FULL : ST_FAILED,
                          .reason = full ? "the disk is full" : "the disk failed"};
    pthread_mutex_unlock(&self->lock);
    if (g.records > 0) {
        tell(self, &loss, g.position);
    }
    pthread_mutex_lock(&self->lock);
    self->charged -= charge_of(lost);
    move(self, g.position);
    self->losing = self->old_rooms > 0 || has_room(self);
    pthread_mutex_unlock(&self->lock);
    free_items(lost);
    pthread_mutex_lock(&self->lock);
}

/* --- one transaction --- */

static st_sql apply(st_sqlite *self, st_item *item)
{
    st_stage *stage = (st_stage *)((char *)item - offsetof(st_stage, item));
    switch (item->kind) {
    case ST_ITEM_ROOM:
        return st_rows_add_room(self, st_room_of(item));
    case ST_ITEM_REBASE:
        return st_stage_rebase(self, stage);
    case ST_ITEM_UNSTAGE:
        return st_stage_drop(self, stage);
    case ST_ITEM_CONDEMN:
        break;
    }
    return st_rows_condemn(self, (st_condemned *)((char *)item - offsetof(st_condemned, item)));
}

static st_sql write_slice(st_sqlite *self, group *g)
{
    g->purged = false;
    if (g->slice == 0) {
        return ST_SQL_DONE;
    }
    return g->stage != NULL ? st_stage_write(self, g->stage, g->slice / HE_STORED_PART)
                            : st_purge_slice(self, g->slice, &g->purged);
}

static st_sql put_progress(st_sqlite *self, const st_progress *progress)
{
    return st_db_do(&self->db, ST_SQL_STATE_PUT, "iiii", progress->commits, progress->position,
                    progress->meshes, (uint64_t)st_progress_sum(progress));
}

/* Copies SQLite's message about a failure, because the next statement would replace the message. */
static void note_refusal(st_sqlite *self, st_sql outcome)
{
    if (outcome == ST_SQL_FAILED || outcome == ST_SQL_DAMAGED) {
        pthread_mutex_lock(&self->lock);
        (void)snprintf(self->refusal, sizeof self->refusal, "%s", st_db_message(&self->db));
        pthread_mutex_unlock(&self->lock);
    }
}

static st_sql transact(st_sqlite *self, group *g, st_progress *progress)
{
    *progress = (st_progress){self->progress.commits + 1, g->position,
                              self->progress.meshes + g->made - g->removed};
    const uint64_t keys = self->keys;
    st_sql outcome = st_db_begin(&self->db, ST_SQL_BEGIN, ST_SQL_ROLLBACK);
    for (st_item *item = g->first; item != NULL && outcome == ST_SQL_DONE; item = item->next) {
        outcome = apply(self, item);
    }
    if (outcome == ST_SQL_DONE) {
        outcome = write_slice(self, g);
    }
    if (outcome == ST_SQL_DONE) {
        outcome = st_heads_flush(self);
    }
    if (outcome == ST_SQL_DONE) {
        outcome = put_progress(self, progress);
    }
    if (outcome == ST_SQL_DONE) {
        const uint64_t begun = st_clock_micros();
        outcome = st_db_do(&self->db, ST_SQL_COMMIT, "");
        st_histogram_add(&self->syncs, st_scale_micros, st_clock_micros() - begun);
    }
    if (outcome == ST_SQL_DONE) {
        self->purged |= g->purged;
        return outcome;
    }
    note_refusal(self, outcome);
    st_heads_forget(self);
    self->keys = keys;
    if (sqlite3_get_autocommit(self->db.handle) == 0) {
        (void)st_db_do(&self->db, ST_SQL_ROLLBACK, "");
    }
    return outcome;
}

/* Waits RETRY_MICROS, in which other threads may free memory or another program may release its
 * lock. */
static void rest(st_sqlite *self)
{
    sqlite3_db_release_memory(self->db.handle);
    const uint64_t until = st_clock_micros() + RETRY_MICROS;
    pthread_mutex_lock(&self->lock);
    while (st_clock_wait(&self->work, &self->lock, until)) {
    }
    pthread_mutex_unlock(&self->lock);
}

static bool is_closing(st_sqlite *self)
{
    pthread_mutex_lock(&self->lock);
    bool closing = self->closing;
    pthread_mutex_unlock(&self->lock);
    return closing;
}

/* Tries to commit a group of queued items until the disk has accepted or refused it. If the disk is
 * full, the group is tried again without background work. If the group is only background work that
 * deletes rows, it is not tried again, because the next purge deletes these rows. */
static st_sql insist(st_sqlite *self, group *g, st_progress *progress)
{
    for (unsigned tries = 1;; tries++) {
        st_sql outcome = transact(self, g, progress);
        if (outcome == ST_SQL_FULL && g->slice > 0 && (g->first != NULL || g->stage != NULL)) {
            g->slice = 0;
        } else if (outcome == ST_SQL_DAMAGED && st_purge_gives_up(self)) {
            /* The damage is in rows that are being deleted. It must not stop the journal, so the
             * next try leaves these rows alone. */
        } else if ((outcome == ST_SQL_NO_MEMORY || outcome == ST_SQL_BUSY) &&
                   (tries < CLOSING_TRIES || !is_closing(self))) {
            rest(self);
        } else {
            return outcome;
        }
    }
}

static void write_mark(st_sqlite *self)
{
    /* The mark is a file that names the last commit. If it cannot be written, it still names an
     * older commit: a loss of newer commits then stays unnoticed, but nothing in the file is
     * false. */
    (void)st_mark_write(&self->folder, &(st_mark){self->identity.store, self->progress.commits,
                                                  self->progress.position});
}

static void end_group(st_sqlite *self, group *g, size_t slice_wanted)
{
    const bool wrote = g->stage != NULL && g->slice > 0;
    pthread_mutex_lock(&self->lock);
    if (wrote) {
        st_stage_written(g->stage);
    }
    if (g->stage != NULL && slice_wanted > 0 &&
        (!wrote || g->stage->slice->written == g->stage->slice->count)) {
        end_slice(self, g->stage, wrote ? ST_OK : ST_FULL);
    }
    self->charged -= charge_of(g->first);
    move(self, g->position);
    pthread_mutex_unlock(&self->lock);
    /* The items are freed before the listener is called, because the listener may wake a thread
     * that waits for memory. */
    free_items(g->first);
    if (g->records > 0) {
        tell(self, NULL, g->position);
    }
}

static void count_commit(st_sqlite *self, const group *g, uint64_t micros)
{
    /* A group without records is only background work, for which no client waits, so its time is
     * not counted. */
    if (g->records > 0) {
        st_histogram_add(&self->commits, st_scale_micros, micros);
        st_histogram_add(&self->groups, st_scale_counts, g->records);
    }
}

static bool commit_group(st_sqlite *self, group *g)
{
    st_progress progress;
    const size_t slice = g->slice;
    const uint64_t begun = st_clock_micros();
    st_sql outcome = insist(self, g, &progress);
    if (outcome == ST_SQL_DONE) {
        self->progress = progress;
        count_commit(self, g, st_clock_micros() - begun);
        write_mark(self);
        end_group(self, g, slice);
        return true;
    }
    pthread_mutex_lock(&self->lock);
    put_back(self, g);
    pthread_mutex_unlock(&self->lock);
    stop_writing(self, outcome == ST_SQL_FULL ? ST_WRITES_FULL : ST_WRITES_FAILED);
    return false;
}

/* --- checkpoints --- */

static bool log_is_long(const st_sqlite *self)
{
    return self->log_pages * ST_LOG_PAGE_BYTES > LONG_LOG;
}

/* Copies pages of the write-ahead log into the database, except pages that must wait because
 * connections still read the log. Returns false if the disk failed. */
static bool checkpoint(st_sqlite *self, int how)
{
    const uint64_t begun = st_clock_micros();
    int code = sqlite3_wal_checkpoint_v2(self->db.handle, NULL, how, NULL, NULL);
    st_sql outcome = st_db_outcome(&self->db, code);
    st_histogram_add(&self->checkpoints, st_scale_micros, st_clock_micros() - begun);
    self->log_tried = self->log_pages;
    pthread_mutex_lock(&self->lock);
    /* If meshes were being loaded, their connections may have kept this checkpoint from copying the
     * whole write-ahead log, and new loads must go on waiting. After a complete checkpoint, new
     * loads read nothing from the log, and the next commit overwrites the log from its start. */
    self->log_is_long = self->mode == ST_WRITES && log_is_long(self) && self->loads_taken > 0;
    if (!self->log_is_long) {
        pthread_cond_broadcast(&self->moved);
    }
    pthread_mutex_unlock(&self->lock);
    note_refusal(self, outcome);
    /* If the disk is full, the checkpoint stops, but the write-ahead log is intact, so this is no
     * failure. */
    return (outcome != ST_SQL_FAILED && outcome != ST_SQL_DAMAGED && st_mark_sync(&self->folder)) ||
           (stop_writing(self, ST_WRITES_FAILED), false);
}

static void checkpoint_when_due(st_sqlite *self, const group *g)
{
    const uint64_t pages = g->slice > 0 ? CHECKPOINT_PAGES_BESIDE : CHECKPOINT_PAGES;
    if (self->log_pages < self->log_tried) {
        /* The write-ahead log was overwritten from its start, so the number of pages at the last
         * checkpoint no longer means anything. */
        self->log_tried = 0;
    }
    if (self->log_pages >= self->log_tried + pages) {
        (void)checkpoint(self, SQLITE_CHECKPOINT_PASSIVE);
    }
}

int st_commit_log_grew(void *context, sqlite3 *db, const char *name, int pages)
{
    st_sqlite *self = context;
    (void)db;
    (void)name;
    self->log_pages = (uint64_t)pages;
    return SQLITE_OK;
}

/* --- the disk is full --- */

/* Frees disk space by steps that need little space themselves: deletes rows that are not needed,
 * and returns free pages of the database to the file system. The caller holds self->lock, which is
 * released while the disk works. */
static bool make_space(st_sqlite *self)
{
    bool good, closing;
    do {
        group g;
        st_progress progress;
        take_group(self, &g);
        g.slice = self->purged ? 0 : SLICE_ALONE;
        pthread_mutex_unlock(&self->lock);
        const st_sql outcome = transact(self, &g, &progress);
        good = outcome == ST_SQL_DONE;
        if (good) {
            self->progress = progress;
            write_mark(self);
            end_group(self, &g, 0);
            good = checkpoint(self, SQLITE_CHECKPOINT_PASSIVE);
            pthread_mutex_lock(&self->lock);
        } else {
            pthread_mutex_lock(&self->lock);
            put_back(self, &g);
            if (outcome == ST_SQL_DAMAGED && st_purge_gives_up(self)) {
                good = true;
            } else if (outcome == ST_SQL_FAILED || outcome == ST_SQL_DAMAGED) {
                /* After a failed sync it is unknown what is on the disk, so nothing more is
                 * written. */
                pthread_mutex_unlock(&self->lock);
                stop_writing(self, ST_WRITES_FAILED);
                pthread_mutex_lock(&self->lock);
            }
        }
        closing = self->closing;
    } while (good && !self->purged && !closing);
    return good;
}

/* Truncates the write-ahead log if no connection is reading it, which frees its disk space for
 * other files. */
static bool cut_log(st_sqlite *self)
{
    pthread_mutex_lock(&self->lock);
    const bool is_read = self->loads_taken > 0;
    pthread_mutex_unlock(&self->lock);
    return is_read || checkpoint(self, SQLITE_CHECKPOINT_TRUNCATE);
}

/* Ends the state FULL if the ballast (a file that reserves disk space) can be made again and some
 * more disk space is free. With less free space the next few changes would fill the disk again. The
 * caller holds self->lock, which is released while the disk works. */
static void seek_space(st_sqlite *self)
{
    pthread_mutex_unlock(&self->lock);
    bool found = st_folder_has_space(&self->folder);
    pthread_mutex_lock(&self->lock);
    if ((!found && self->purged && self->first == NULL) || !make_space(self)) {
        return;
    }
    pthread_mutex_unlock(&self->lock);
    found = cut_log(self) && st_ballast_make(&self->folder) && st_folder_has_space(&self->folder);
    pthread_mutex_lock(&self->lock);
    if (found && self->mode == ST_WRITES_FULL) {
        self->mode = ST_WRITES;
    }
}

/* --- the thread --- */

/* Returns true if the commit thread has something to do now. The caller holds self->lock. */
static bool has_work(const st_sqlite *self)
{
    switch (self->mode) {
    case ST_WRITES:
        return self->first != NULL || self->stages != NULL || (!self->purged && !self->closing) ||
               (self->log_is_long && self->loads_taken == 0);
    case ST_WRITES_FULL:
        return self->losing ? has_room(self) || self->old_rooms == 0 : has_room(self);
    case ST_WRITES_FAILED:
        break;
    }
    return self->first != NULL || (self->losing && self->old_rooms == 0);
}

/* Does one step of the commit thread's work. The caller holds self->lock, which is released while
 * the disk works. */
static void work_once(st_sqlite *self)
{
    if (self->mode == ST_WRITES_FAILED || self->losing) {
        lose(self);
        return;
    }
    group g;
    take_group(self, &g);
    const bool full = self->mode == ST_WRITES_FULL;
    pthread_mutex_unlock(&self->lock);
    if (full) {
        g.slice = 0;
        (void)st_ballast_drop(&self->folder);
    }
    if (g.first == NULL && g.slice == 0) {
        /* Nothing is waiting to be written, but threads that load meshes wait for this
         * checkpoint. */
        (void)checkpoint(self, SQLITE_CHECKPOINT_PASSIVE);
    } else if (commit_group(self, &g)) {
        checkpoint_when_due(self, &g);
    }
    pthread_mutex_lock(&self->lock);
}

void *st_commit_thread(void *context)
{
    st_sqlite *self = context;
    uint64_t tried = st_clock_micros();
    st_thread_name("hedged-store");
    pthread_mutex_lock(&self->lock);
    for (;;) {
        if (has_work(self)) {
            work_once(self);
            continue;
        }
        if (self->closing) {
            break;
        }
        self->idle = true;
        if (self->mode != ST_WRITES_FULL || self->losing) {
            pthread_cond_wait(&self->work, &self->lock);
        } else if (!st_clock_wait(&self->work, &self->lock, tried + SECOND)) {
            seek_space(self);
            tried = st_clock_micros();
        }
        self->idle = false;
    }
    /* If the disk is full when the thread ends, the queue may still have items that ask for
     * deletions. */
    free_items(self->first);
    self->first = NULL;
    self->end = &self->first;
    pthread_mutex_unlock(&self->lock);
    if (self->mode != ST_WRITES_FAILED) {
        (void)checkpoint(self, SQLITE_CHECKPOINT_TRUNCATE);
    }
    return NULL;
}
