/* sqlite_commit.c - the commit thread, which writes the queue to the database. It is in one of
 * three states:
 *
 *     WRITES   everything queued is taken as one group (take_group) and committed (commit_group),
 *              with a slice of background work. commit_group leads to the states below
 *     FULL     what is queued is lost (lose); only removals are accepted, and the ballast (reserved
 *              disk space) is freed for them; each second seek_space tries to return to WRITES
 *     FAILED   everything appended is lost; the state never ends */
#include "base/mem.h"
#include "journal/sqlite/sqlite_state.h"
#include "system/clock.h"

#include <stdio.h>
#include <sys/prctl.h>

enum {
    GROUP_RECORDS = 4096,
    GROUP_BYTES = 8 << 20,
    /* Bytes of background work in one transaction, if records are waiting to be written, too. */
    SLICE_BESIDE = 64 << 10,
    /* Bytes of background work in one transaction, if no record waits; a record that comes
     * meanwhile has to wait for the transaction. */
    SLICE_ALONE = 256 << 10,
    /* A checkpoint copies the write-ahead log into the database; it is made when the log has this
     * many pages. Records wait for a checkpoint, the longer the more pages it copies. While
     * background work fills the log, checkpoints are made more often, so that a checkpoint takes no
     * longer than one transaction's background work. */
    CHECKPOINT_PAGES = 1000,
    CHECKPOINT_PAGES_BESIDE = 256,
    /* When the write-ahead log has this many bytes, loads of meshes wait for a checkpoint. */
    LONG_LOG = 64 << 20,
    SECOND = 1000000,
    RETRY_MICROS = 20000,
    CLOSING_TRIES = 50
};

/* The items of the queue that are written in one transaction. */
typedef struct group {
    st_item *first, *last;
    uint64_t records /* number of records and notes */, position, made, removed;
    bool freeing;
    /* The stage (a content written in advance) of which this transaction writes a slice; NULL: the
     * background work is a purge, the deletion of what is not needed. */
    st_stage *stage;
    size_t slice; /* bytes of background work in this transaction; 0: none */
    /* True if nothing is left to be purged (deleted) once this transaction is committed. */
    bool purged;
} group;

/* --- taking items from the queue; the caller holds the lock --- */

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

/* Ends the writing of a slice of a stage (a content written in advance), because the slice was
 * written, or never will be. The caller holds the lock. */
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

/* Sets the position up to which every record is durable or was reported as lost. The caller holds
 * the lock. */
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

/* Takes the items that are lost from the queue: all rooms (groups of records), and in the state
 * FAILED all other items, too. The caller holds the lock. */
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

/* Deletes the contents that were written in advance for the lost records of a room. The caller
 * holds the lock. */
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

/* Drops all queued records and reports them as lost. Rooms that are still reserved are lost when
 * records are appended to them. The caller holds the lock; it is released during the report. */
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

/* Copies SQLite's message about a failure, because the next statement replaces the message. */
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

/* Waits a moment, so that other threads can free memory, or another program can release its
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
 * full, the group is tried again without background work. A group that is only a purge (deletion of
 * what is not needed) is not tried again, because the next purge deletes the rows. */
static st_sql insist(st_sqlite *self, group *g, st_progress *progress)
{
    for (unsigned tries = 1;; tries++) {
        st_sql outcome = transact(self, g, progress);
        if (outcome == ST_SQL_FULL && g->slice > 0 && (g->first != NULL || g->stage != NULL)) {
            g->slice = 0;
        } else if (outcome == ST_SQL_DAMAGED && st_purge_gives_up(self)) {
            /* Damage in rows that are being deleted must not stop the journal, so the next try
             * leaves these rows out. */
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
    /* If the mark of the last commit cannot be written, the file still names an older commit. The
     * mark then cannot reveal the loss of newer commits, but it is still true. */
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
    /* The items of the group are freed before the listener is called, because the listener may wake
     * a thread that was refused memory. */
    free_items(g->first);
    if (g->records > 0) {
        tell(self, NULL, g->position);
    }
}

static void count_commit(st_sqlite *self, const group *g, uint64_t micros)
{
    /* A group without records is background work alone, for which no client waits, so it is not
     * counted. */
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

/* Copies the write-ahead log into the database, as far as readers allow. Returns false if the disk
 * failed. */
static bool checkpoint(st_sqlite *self, int how)
{
    const uint64_t begun = st_clock_micros();
    int code = sqlite3_wal_checkpoint_v2(self->db.handle, NULL, how, NULL, NULL);
    st_sql outcome = st_db_outcome(&self->db, code);
    st_histogram_add(&self->checkpoints, st_scale_micros, st_clock_micros() - begun);
    self->log_tried = self->log_pages;
    pthread_mutex_lock(&self->lock);
    /* New loads of meshes still have to wait if loads that are under way may have kept this
     * checkpoint from copying the whole write-ahead log. After a complete checkpoint, new loads
     * read nothing from the log, and the next commit overwrites it from the start. */
    self->log_is_long = self->mode == ST_WRITES && log_is_long(self) && self->loads_taken > 0;
    if (!self->log_is_long) {
        pthread_cond_broadcast(&self->moved);
    }
    pthread_mutex_unlock(&self->lock);
    note_refusal(self, outcome);
    /* A checkpoint that stops because the disk is full is no failure, because the write-ahead log
     * is intact. */
    return (outcome != ST_SQL_FAILED && outcome != ST_SQL_DAMAGED && st_mark_sync(&self->folder)) ||
           (stop_writing(self, ST_WRITES_FAILED), false);
}

static void checkpoint_when_due(st_sqlite *self, const group *g)
{
    const uint64_t pages = g->slice > 0 ? CHECKPOINT_PAGES_BESIDE : CHECKPOINT_PAGES;
    if (self->log_pages < self->log_tried) {
        /* the write-ahead log was overwritten from the start, so the old count of pages is
         * obsolete */
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

/* Frees space on a full disk, by steps that need little space themselves: deletes rows that are not
 * needed and returns free pages to the file system. The caller holds the lock, which is released
 * while the disk works. */
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
                /* After a failed sync the state of the disk is unknown, so nothing more is
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

/* Truncates the write-ahead log if no connection reads it, so that its space is free for other
 * files. */
static bool cut_log(st_sqlite *self)
{
    pthread_mutex_lock(&self->lock);
    const bool is_read = self->loads_taken > 0;
    pthread_mutex_unlock(&self->lock);
    return is_read || checkpoint(self, SQLITE_CHECKPOINT_TRUNCATE);
}

/* Ends the state FULL if the ballast (reserved disk space) can be made again and the disk has some
 * more free space. Without that, the next few changes would fill the disk again. The caller holds
 * the lock, which is released while the disk works. */
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

/* Returns true if the commit thread has something to do now. The caller holds the lock. */
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

/* Does one step of the commit thread's work. The caller holds the lock, which is released while the
 * disk works. */
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
        /* Nothing is to be written, but loads of meshes wait for this checkpoint. */
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
    prctl(PR_SET_NAME, "hedged-store");
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
    /* When the disk is full, items of the queue that delete something may still be there when the
     * thread ends. */
    free_items(self->first);
    self->first = NULL;
    self->end = &self->first;
    pthread_mutex_unlock(&self->lock);
    if (self->mode != ST_WRITES_FAILED) {
        (void)checkpoint(self, SQLITE_CHECKPOINT_TRUNCATE);
    }
    return NULL;
}
