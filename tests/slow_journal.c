#include "tests/slow_journal.h"

#include "base/mem.h"
#include "tests/journal_room.h"

#include <stdio.h>

struct st_stage {
    he_mesh *content;
};

static void count_out(slow_journal *journal, int by)
{
    pthread_mutex_lock(&journal->lock);
    journal->out += (size_t)by;
    pthread_mutex_unlock(&journal->lock);
}

static st_status reserve(void *self, const st_room_need *need, st_room **out)
{
    slow_journal *journal = self;
    (void)need;
    *out = NULL;
    return journal->refuse;
}

static st_status reserve_kept(void *self, const st_room_need *need, st_room **out)
{
    slow_journal *journal = self;
    st_status status = journal_room_new(journal->refuse, need, out);
    count_out(journal, status == ST_OK);
    return status;
}

static void leave(void *self, st_room *room)
{
    if (room != NULL) {
        count_out(self, -1);
        journal_room_free(room);
    }
}

static st_status stage_content(void *self, const he_mesh *content, st_stage **out)
{
    slow_journal *journal = self;
    if (journal->refuse != ST_OK) {
        return journal->refuse;
    }
    st_stage *stage = he_mem_zero(1, sizeof *stage);
    if (stage == NULL || he_mesh_copy(content, &stage->content, NULL) != HE_OK) {
        he_mem_free(stage);
        return ST_NO_MEMORY;
    }
    *out = stage;
    count_out(journal, 1);
    return ST_OK;
}

/* Counts an edit whose bytes are written in advance; the bytes are not stored. */
static st_status stage_edit(void *self, const unsigned char *bytes, size_t size, st_stage **out)
{
    slow_journal *journal = self;
    (void)bytes;
    (void)size;
    if (journal->refuse != ST_OK) {
        return journal->refuse;
    }
    if (journal->staging != NULL) {
        journal->staging();
    }
    st_stage *stage = he_mem_zero(1, sizeof *stage);
    if (stage == NULL) {
        return ST_NO_MEMORY;
    }
    *out = stage;
    journal->staged_edits++;
    count_out(journal, 1);
    return ST_OK;
}

static void free_stage(st_stage *stage)
{
    if (stage != NULL) {
        he_mesh_free(stage->content);
        he_mem_free(stage);
    }
}

static void unstage(void *self, st_stage *stage)
{
    count_out(self, -1);
    free_stage(stage);
}

const he_mesh *slow_journal_staged(const slow_journal *journal)
{
    return journal->stage == NULL ? NULL : journal->stage->content;
}

static st_status open_none(void *self, const char *id, st_card *card, st_reader **reader)
{
    (void)self;
    (void)id;
    (void)card;
    (void)reader;
    return ST_ABSENT;
}

static st_status list_none(void *self, const char *after, st_card *out, size_t limit, size_t *count)
{
    (void)self;
    (void)after;
    (void)out;
    (void)limit;
    *count = 0;
    return ST_OK;
}

static st_status list_none_by(void *self, const st_card_page *page, st_card *out, size_t *count)
{
    (void)self;
    (void)page;
    (void)out;
    *count = 0;
    return ST_OK;
}

static uint64_t count_none(void *self)
{
    (void)self;
    return 0;
}

static void tell_health(void *self, st_health *out)
{
    const slow_journal *journal = self;
    *out = (st_health){.status = journal->refuse == ST_FULL || journal->refuse == ST_FAILED
                                     ? journal->refuse
                                     : ST_OK,
                       .fulls = journal->fulls};
}

static void tell_measures(void *self, st_journal_measures *out)
{
    *out = ((const slow_journal *)self)->measures;
}

/* Stores the first record of the newest group, with its room (reserved memory) and its stage (data
 * written in advance), so that tests can examine them. The caller must hold the lock. */
static void keep_newest(slow_journal *journal, st_room *room, const st_record *first)
{
    journal_room_free(journal->room);
    free_stage(journal->stage);
    journal->out -= (size_t)(room != NULL) + (size_t)(first->stage != NULL);
    journal->room = room;
    journal->stage = first->stage;
    journal->record = *first;
}

static uint64_t append(void *self, st_room *room, const st_record *records, size_t count)
{
    slow_journal *journal = self;
    pthread_mutex_lock(&journal->lock);
    const st_record *record = &records[count - 1];
    uint64_t position = journal->newest += count;
    journal->groups++;
    keep_newest(journal, room, records);
    snprintf(journal->key, sizeof journal->key, "%s", record->key == NULL ? "" : record->key->text);
    pthread_cond_broadcast(&journal->changed);
    pthread_mutex_unlock(&journal->lock);
    return position;
}

static void listen_to(void *self, const st_journal_listener *listener)
{
    slow_journal *journal = self;
    pthread_mutex_lock(&journal->telling);
    journal->is_heard = listener != NULL;
    if (listener != NULL) {
        journal->listener = *listener;
    }
    pthread_mutex_unlock(&journal->telling);
}

static void close_journal(void *self)
{
    slow_journal *journal = self;
    journal_room_free(journal->room);
    free_stage(journal->stage);
    pthread_cond_destroy(&journal->changed);
    pthread_mutex_destroy(&journal->lock);
    pthread_mutex_destroy(&journal->telling);
}

st_journal slow_journal_open(slow_journal *journal)
{
    *journal = (slow_journal){.newest = 0};
    pthread_mutex_init(&journal->lock, NULL);
    pthread_mutex_init(&journal->telling, NULL);
    pthread_cond_init(&journal->changed, NULL);
    return (st_journal){.self = journal,
                        .secret = {1, 2},
                        .reserve = reserve,
                        .leave = leave,
                        .append = append,
                        .listen = listen_to,
                        .close = close_journal};
}

st_journal slow_journal_open_keeping(slow_journal *journal)
{
    st_journal kept = slow_journal_open(journal);
    kept.keeps = true;
    kept.reserve = reserve_kept;
    kept.stage = stage_content;
    kept.stage_edit = stage_edit;
    kept.unstage = unstage;
    kept.open = open_none;
    kept.list = list_none;
    kept.list_by = list_none_by;
    kept.keys = journal_keys_none;
    kept.count = count_none;
    kept.health = tell_health;
    kept.measure = tell_measures;
    return kept;
}

void slow_journal_wait(slow_journal *journal, uint64_t position)
{
    pthread_mutex_lock(&journal->lock);
    while (journal->newest < position) {
        pthread_cond_wait(&journal->changed, &journal->lock);
    }
    pthread_mutex_unlock(&journal->lock);
}

uint64_t slow_journal_newest(slow_journal *journal)
{
    pthread_mutex_lock(&journal->lock);
    uint64_t newest = journal->newest;
    pthread_mutex_unlock(&journal->lock);
    return newest;
}

void slow_journal_advance(slow_journal *journal, uint64_t position)
{
    pthread_mutex_lock(&journal->telling);
    journal->durable = position;
    if (journal->is_heard) {
        journal->listener.moved(journal->listener.context, position);
    }
    pthread_mutex_unlock(&journal->telling);
}

void slow_journal_lose(slow_journal *journal, const st_loss *loss)
{
    pthread_mutex_lock(&journal->telling);
    if (journal->is_heard) {
        journal->listener.lost(journal->listener.context, loss);
    }
    pthread_mutex_unlock(&journal->telling);
}
