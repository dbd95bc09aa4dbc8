#include "server/store/held.h"

#include "base/mem.h"

#include <pthread.h>

struct srv_held {
    srv_store *store;
    pthread_mutex_t lock;
    srv_hold *first;
    bool abandoned;
};

static bool is_over(const srv_held *held, const srv_hold *hold)
{
    return held->abandoned || srv_store_is_durable(held->store, hold->mesh, hold->record);
}

/* Unlinked first: resume may end the hold's life. */
static void resume_all(srv_held *held)
{
    srv_hold *over = NULL;
    pthread_mutex_lock(&held->lock);
    for (srv_hold *hold = held->first, *next; hold != NULL; hold = next) {
        next = hold->next;
        if (!is_over(held, hold)) {
            continue;
        }
        if (hold->previous != NULL) {
            hold->previous->next = next;
        } else {
            held->first = next;
        }
        if (next != NULL) {
            next->previous = hold->previous;
        }
        hold->abandoned = held->abandoned;
        hold->next = over;
        over = hold;
    }
    pthread_mutex_unlock(&held->lock);
    while (over != NULL) {
        srv_hold *next = over->next;
        over->resume(over);
        over = next;
    }
}

static void notified(void *context)
{
    resume_all(context);
}

srv_held *srv_held_new(srv_store *store)
{
    srv_held *held = he_mem_zero(1, sizeof *held);
    if (held == NULL) {
        return NULL;
    }
    held->store = store;
    pthread_mutex_init(&held->lock, NULL);
    srv_store_listen(store, notified, held);
    return held;
}

void srv_held_free(srv_held *held)
{
    if (held != NULL) {
        srv_store_listen(held->store, NULL, NULL);
        pthread_mutex_destroy(&held->lock);
        he_mem_free(held);
    }
}

/* Asked once more under the lock: a notice that came since the caller asked has found nothing, and
 * one that comes later finds the hold. */
bool srv_held_add(srv_held *held, srv_hold *hold)
{
    pthread_mutex_lock(&held->lock);
    bool over = is_over(held, hold);
    hold->abandoned = held->abandoned;
    if (!over) {
        hold->previous = NULL;
        hold->next = held->first;
        if (hold->next != NULL) {
            hold->next->previous = hold;
        }
        held->first = hold;
    }
    pthread_mutex_unlock(&held->lock);
    return !over;
}

void srv_held_abandon(srv_held *held)
{
    pthread_mutex_lock(&held->lock);
    held->abandoned = true;
    pthread_mutex_unlock(&held->lock);
    resume_all(held);
}
