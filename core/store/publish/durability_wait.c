#include "store/publish/durability_wait.h"

#include "base/mem.h"
#include "system/clock.h"

#include <pthread.h>
#include <stdatomic.h>

struct st_waits {
    _Atomic uint64_t newest, durable;
    pthread_mutex_t lock;
    st_wait *top; /* top of the heap of waits: the wait for the earliest position */
    /* number of threads that have taken ended waits off the heap and are calling `resume` for
     * these */
    size_t resuming;
    /* Signalled when more records are durable, when all waits are stopped, or when `resuming`
     * falls. */
    pthread_cond_t caught;
    st_loss *losses;
    size_t loss_count, loss_capacity;
    _Atomic bool has_losses;
    /* One loss that covers all losses for which there was no memory in the list; if `from` is above
     * `to`, there are no such losses. */
    st_loss rest;
    bool stopped;
};

static void raise_to(_Atomic uint64_t *number, uint64_t to)
{
    uint64_t before = atomic_load(number);
    while (before < to && !atomic_compare_exchange_weak(number, &before, to)) {
    }
}

/* --- the heap, a pairing heap (Fredman, Sedgewick, Sleator, Tarjan 1986); the caller holds the
 * lock --- */

static st_wait *meld(st_wait *a, st_wait *b)
{
    if (a == NULL || b == NULL) {
        return a == NULL ? b : a;
    }
    if (b->shown.position < a->shown.position) {
        st_wait *c = a;
        a = b;
        b = c;
    }
    b->beside = a->child;
    a->child = b;
    return a;
}

/* Removes the top of the pairing heap: melds its children in pairs, then melds these pairs from the
 * last to the first. */
static st_wait *without_top(st_wait *top)
{
    st_wait *pairs = NULL, *left = top->child, *all = NULL;
    while (left != NULL) {
        st_wait *a = left, *b = a->beside;
        left = b == NULL ? NULL : b->beside;
        st_wait *pair = meld(a, b);
        pair->beside = pairs;
        pairs = pair;
    }
    while (pairs != NULL) {
        st_wait *next = pairs->beside;
        pairs->beside = NULL;
        all = meld(all, pairs);
        pairs = next;
    }
    return all;
}

/* --- losses of records; the caller holds the lock --- */

static bool concerns(const st_loss *loss, const st_shown *shown)
{
    bool same = loss->incarnation == 0 || shown->incarnation == 0 ||
                loss->incarnation == shown->incarnation;
    /* If all records that the answer shows were durable when the answer was begun (position <=
     * since), none of them can be lost. `since` may be greater than `position`, because the journal
     * may report a record as durable before the thread that wrote it has called
     * st_waits_appended. */
    return same && shown->since < shown->position && loss->from <= shown->position &&
           loss->to > shown->since;
}

static const st_loss *find_loss(const st_waits *waits, const st_shown *shown)
{
    for (size_t i = 0; i < waits->loss_count; i++) {
        if (concerns(&waits->losses[i], shown)) {
            return &waits->losses[i];
        }
    }
    return concerns(&waits->rest, shown) ? &waits->rest : NULL;
}

static bool reserve_loss(st_waits *waits)
{
    if (waits->loss_count < waits->loss_capacity) {
        return true;
    }
    size_t capacity = he_mem_grown(waits->loss_capacity, waits->loss_count + 1);
    st_loss *losses = he_mem_array(waits->losses, capacity, sizeof *losses);
    if (losses == NULL) {
        return false;
    }
    waits->losses = losses;
    waits->loss_capacity = capacity;
    return true;
}

/* If the positions of a loss follow directly those of the newest loss in the list, merges the two.
 * This keeps the list short: after the disk has failed, the journal reports many small losses. */
static bool extend_last(st_waits *waits, const st_loss *loss)
{
    st_loss *last = waits->loss_count == 0 ? NULL : &waits->losses[waits->loss_count - 1];
    if (last == NULL || last->incarnation != loss->incarnation || last->to + 1 != loss->from ||
        last->status != loss->status || last->reason != loss->reason) {
        return false;
    }
    last->to = loss->to;
    return true;
}

/* Stores a loss of records. If memory is out, all later records count as lost, too. This is safe,
 * because it only makes the store refuse more answers. */
void st_waits_lose(st_waits *waits, const st_loss *loss)
{
    pthread_mutex_lock(&waits->lock);
    if (extend_last(waits, loss)) {
        /* The loss was merged into the newest loss of the list. */
    } else if (reserve_loss(waits)) {
        waits->losses[waits->loss_count++] = *loss;
    } else if (loss->from < waits->rest.from) {
        waits->rest = *loss;
        waits->rest.incarnation = 0;
        waits->rest.to = UINT64_MAX;
    }
    atomic_store(&waits->has_losses, true);
    pthread_mutex_unlock(&waits->lock);
}

/* --- waiting --- */

/* Returns true if a wait has ended, and stores how it ended. The caller holds the lock of
 * `waits`. */
static bool is_over(const st_waits *waits, st_wait *wait)
{
    const st_shown *shown = &wait->shown;
    bool durable = shown->position <= atomic_load(&waits->durable);
    const st_loss *loss = durable ? find_loss(waits, shown) : NULL;
    wait->end = loss != NULL ? ST_WAIT_LOST : durable ? ST_WAIT_DURABLE : ST_WAIT_STOPPED;
    wait->status = loss == NULL ? ST_OK : loss->status;
    wait->reason = loss == NULL ? NULL : loss->reason;
    return durable || waits->stopped;
}

/* Calls the function `resume` of each wait that has ended, in the order of positions. All these
 * waits are first taken off the heap, because `resume` may free its wait. */
static void resume_those_over(st_waits *waits)
{
    st_wait *first = NULL, **end = &first;
    pthread_mutex_lock(&waits->lock);
    pthread_cond_broadcast(&waits->caught);
    while (waits->top != NULL && is_over(waits, waits->top)) {
        st_wait *wait = waits->top;
        waits->top = without_top(wait);
        *end = wait;
        end = &wait->beside;
    }
    *end = NULL;
    waits->resuming += first != NULL;
    pthread_mutex_unlock(&waits->lock);
    if (first == NULL) {
        return;
    }
    while (first != NULL) {
        st_wait *next = first->beside;
        first->resume(first);
        first = next;
    }
    pthread_mutex_lock(&waits->lock);
    waits->resuming--;
    pthread_cond_broadcast(&waits->caught);
    pthread_mutex_unlock(&waits->lock);
}

void st_waits_moved(st_waits *waits, uint64_t position)
{
    raise_to(&waits->durable, position);
    resume_those_over(waits);
}

st_waits *st_waits_new(void)
{
    st_waits *waits = he_mem_zero(1, sizeof *waits);
    if (waits != NULL) {
        waits->rest = (st_loss){.from = UINT64_MAX};
        pthread_mutex_init(&waits->lock, NULL);
        st_clock_condition(&waits->caught);
    }
    return waits;
}

void st_waits_free(st_waits *waits)
{
    if (waits != NULL) {
        pthread_cond_destroy(&waits->caught);
        pthread_mutex_destroy(&waits->lock);
        he_mem_free(waits->losses);
        he_mem_free(waits);
    }
}

void st_waits_appended(st_waits *waits, uint64_t position)
{
    raise_to(&waits->newest, position);
}

uint64_t st_waits_newest(const st_waits *waits)
{
    return atomic_load(&waits->newest);
}

uint64_t st_waits_durable(const st_waits *waits)
{
    return atomic_load(&waits->durable);
}

bool st_waits_is_lost(st_waits *waits, const st_shown *shown)
{
    if (!atomic_load(&waits->has_losses)) {
        return false;
    }
    pthread_mutex_lock(&waits->lock);
    bool found = find_loss(waits, shown) != NULL;
    pthread_mutex_unlock(&waits->lock);
    return found;
}

/* Decides whether records are durable. The position is read before the list of losses: the journal
 * reports a loss before it raises the durable position beyond the lost records. */
bool st_waits_is_durable(st_waits *waits, const st_shown *shown)
{
    return shown->position <= atomic_load(&waits->durable) && !st_waits_is_lost(waits, shown);
}

/* Adds a wait, unless it has ended already: records may have become durable since the caller
 * checked. st_waits_moved ends an added wait later. */
bool st_waits_add(st_waits *waits, st_wait *wait)
{
    pthread_mutex_lock(&waits->lock);
    bool over = is_over(waits, wait);
    if (!over) {
        wait->child = wait->beside = NULL;
        waits->top = meld(waits->top, wait);
    }
    pthread_mutex_unlock(&waits->lock);
    return !over;
}

bool st_waits_block(st_waits *waits, uint64_t position, uint64_t until)
{
    pthread_mutex_lock(&waits->lock);
    while (position > atomic_load(&waits->durable) && !waits->stopped &&
           st_clock_wait(&waits->caught, &waits->lock, until)) {
    }
    const bool caught = position <= atomic_load(&waits->durable);
    pthread_mutex_unlock(&waits->lock);
    return caught;
}

void st_waits_stop(st_waits *waits)
{
    pthread_mutex_lock(&waits->lock);
    waits->stopped = true;
    pthread_mutex_unlock(&waits->lock);
    resume_those_over(waits);
    pthread_mutex_lock(&waits->lock);
    while (waits->resuming > 0) {
        pthread_cond_wait(&waits->caught, &waits->lock);
    }
    pthread_mutex_unlock(&waits->lock);
}
