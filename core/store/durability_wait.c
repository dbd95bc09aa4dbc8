#include "store/durability_wait.h"

#include "base/mem.h"

#include <pthread.h>

struct st_waits {
    st_store *store;
    pthread_mutex_t lock;
    st_wait *first;
    bool abandoned;
};

static bool is_over(const st_waits *waits, const st_wait *wait)
{
    return waits->abandoned || st_store_is_durable(waits->store, wait->mesh, wait->record);
}

/* Unlinked first: resume may end the wait's life. */
static void resume_all(st_waits *waits)
{
    st_wait *over = NULL;
    pthread_mutex_lock(&waits->lock);
    for (st_wait *wait = waits->first, *next; wait != NULL; wait = next) {
        next = wait->next;
        if (!is_over(waits, wait)) {
            continue;
        }
        if (wait->previous != NULL) {
            wait->previous->next = next;
        } else {
            waits->first = next;
        }
        if (next != NULL) {
            next->previous = wait->previous;
        }
        wait->abandoned = waits->abandoned;
        wait->next = over;
        over = wait;
    }
    pthread_mutex_unlock(&waits->lock);
    while (over != NULL) {
        st_wait *next = over->next;
        over->resume(over);
        over = next;
    }
}

static void notified(void *context)
{
    resume_all(context);
}

st_waits *st_waits_new(st_store *store)
{
    st_waits *waits = he_mem_zero(1, sizeof *waits);
    if (waits == NULL) {
        return NULL;
    }
    waits->store = store;
    pthread_mutex_init(&waits->lock, NULL);
    st_store_listen(store, notified, waits);
    return waits;
}

void st_waits_free(st_waits *waits)
{
    if (waits != NULL) {
        st_store_listen(waits->store, NULL, NULL);
        pthread_mutex_destroy(&waits->lock);
        he_mem_free(waits);
    }
}

/* Asked once more under the lock: a notice that came since the caller asked has found nothing, and
 * one that comes later finds the wait. */
bool st_waits_add(st_waits *waits, st_wait *wait)
{
    pthread_mutex_lock(&waits->lock);
    bool over = is_over(waits, wait);
    wait->abandoned = waits->abandoned;
    if (!over) {
        wait->previous = NULL;
        wait->next = waits->first;
        if (wait->next != NULL) {
            wait->next->previous = wait;
        }
        waits->first = wait;
    }
    pthread_mutex_unlock(&waits->lock);
    return !over;
}

void st_waits_abandon(st_waits *waits)
{
    pthread_mutex_lock(&waits->lock);
    waits->abandoned = true;
    pthread_mutex_unlock(&waits->lock);
    resume_all(waits);
}
