#include "tests/slow_journal.h"

#include <stdio.h>

static st_status reserve(void *self, const st_room_need *need, st_room **out)
{
    (void)self;
    (void)need;
    *out = NULL;
    return ST_OK;
}

static void leave(void *self, st_room *room)
{
    (void)self;
    (void)room;
}

static uint64_t append(void *self, st_room *room, const st_record *records, size_t count)
{
    (void)room;
    slow_journal *journal = self;
    pthread_mutex_lock(&journal->lock);
    const st_record *record = &records[count - 1];
    uint64_t position = journal->newest += count;
    journal->groups++;
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
