#include "store/publish/broadcast_queue.h"

#include "base/mem.h"
#include "system/clock.h"

#include <assert.h>
#include <string.h>

struct st_message {
    /* number of references to the message, from the ring of the queue and from listeners; guarded
     * by the queue's lock */
    uint32_t uses;
    st_place place;
    uint64_t made; /* time (st_clock_micros) at which the message was added */
    size_t length;
    char bytes[];
};

static void count(_Atomic uint64_t *counter, uint64_t amount)
{
    atomic_fetch_add_explicit(counter, amount, memory_order_relaxed);
}

void st_queue_init(st_queue *queue, st_place place, st_queue_counts *counts)
{
    *queue = (st_queue){.counts = counts, .floor = place, .newest = place};
    pthread_mutex_init(&queue->lock, NULL);
}

/* --- functions that need the queue's lock --- */

static st_message *message_at(const st_queue *queue, size_t i)
{
    return queue->ring[(queue->first + i) & (queue->capacity - 1)];
}

static void release(st_message *message)
{
    if (message != NULL && --message->uses == 0) {
        he_mem_free(message);
    }
}

static void drop_oldest(st_queue *queue)
{
    st_message *message = message_at(queue, 0);
    queue->floor = message->place;
    queue->floor_number++;
    queue->bytes -= message->length;
    count(&queue->counts->bytes, 0 - (uint64_t)message->length);
    queue->first = (queue->first + 1) & (queue->capacity - 1);
    queue->count--;
    release(message);
}

static void drop_all(st_queue *queue)
{
    while (queue->count > 0) {
        drop_oldest(queue);
    }
    he_mem_free(queue->ring);
    queue->ring = NULL;
    queue->capacity = 0;
    queue->first = 0;
}

static bool reserve_place(st_queue *queue)
{
    if (queue->count < queue->capacity) {
        return true;
    }
    size_t capacity = queue->capacity == 0 ? 8 : 2 * queue->capacity;
    st_message **ring = he_mem_array(NULL, capacity, sizeof(st_message *));
    if (ring == NULL) {
        return false;
    }
    for (size_t i = 0; i < queue->count; i++) {
        ring[i] = message_at(queue, i);
    }
    he_mem_free(queue->ring);
    queue->ring = ring;
    queue->capacity = capacity;
    queue->first = 0;
    return true;
}

static bool is_followed(const st_queue *queue)
{
    return queue->listeners > 0 ||
           (queue->left != 0 && st_clock_micros() - queue->left < ST_QUEUE_LINGER);
}

static void begin_waiting(st_queue *queue, st_listener *listener)
{
    if (!listener->waiting) {
        listener->waiting = true;
        listener->previous = NULL;
        listener->next = queue->waiting;
        if (listener->next != NULL) {
            listener->next->previous = listener;
        }
        queue->waiting = listener;
    }
}

static void end_waiting(st_queue *queue, st_listener *listener)
{
    if (!listener->waiting) {
        return;
    }
    listener->waiting = false;
    if (listener->previous != NULL) {
        listener->previous->next = listener->next;
    } else {
        queue->waiting = listener->next;
    }
    if (listener->next != NULL) {
        listener->next->previous = listener->previous;
    }
}

static void wake_all(st_queue *queue)
{
    while (queue->waiting != NULL) {
        st_listener *listener = queue->waiting;
        end_waiting(queue, listener);
        listener->wake(listener->context);
    }
}

static uint64_t newest_number(const st_queue *queue)
{
    return queue->floor_number + queue->count;
}

/* Returns the index of the first message that listeners may not read yet. Messages are sorted by
 * their stamps. */
static size_t first_forbidden(const st_queue *queue)
{
    size_t low = 0, high = queue->count;
    while (low < high) {
        size_t middle = low + (high - low) / 2;
        if (message_at(queue, middle)->place.stamp <= queue->allowed) {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    return low;
}

/* --- functions that add and drop messages --- */

void st_queue_clear(st_queue *queue)
{
    assert(queue->listeners == 0);
    drop_all(queue);
    pthread_mutex_destroy(&queue->lock);
}

bool st_queue_is_followed(st_queue *queue)
{
    pthread_mutex_lock(&queue->lock);
    bool followed = is_followed(queue);
    pthread_mutex_unlock(&queue->lock);
    return followed;
}

static st_message *message_new(const char *bytes, size_t length)
{
    st_message *message =
        bytes == NULL || length > ST_QUEUE_BYTES ? NULL : he_mem_alloc(sizeof *message + length);
    if (message != NULL) {
        *message = (st_message){.uses = 1, .made = st_clock_micros(), .length = length};
        memcpy(message->bytes, bytes, length);
    }
    return message;
}

/* Appends a message, which the queue then owns. If `message` is NULL, memory was out when it was
 * made. The queue is then emptied, and each listener learns that it has missed messages. */
static void append(st_queue *queue, st_message *message)
{
    if (message == NULL || !reserve_place(queue)) {
        release(message);
        drop_all(queue);
        queue->floor = queue->newest;
        queue->floor_number++;
        return;
    }
    message->place = queue->newest;
    queue->ring[(queue->first + queue->count) & (queue->capacity - 1)] = message;
    queue->count++;
    queue->bytes += message->length;
    count(&queue->counts->messages, 1);
    count(&queue->counts->bytes, message->length);
    while (queue->count > ST_QUEUE_MESSAGES || queue->bytes > ST_QUEUE_BYTES) {
        drop_oldest(queue);
    }
}

void st_queue_add(st_queue *queue, st_place place, const char *bytes, size_t length)
{
    st_message *message = message_new(bytes, length);
    pthread_mutex_lock(&queue->lock);
    assert(place.stamp >= queue->newest.stamp && !queue->ended);
    queue->newest = place;
    append(queue, message);
    pthread_mutex_unlock(&queue->lock);
}

void st_queue_add_beside(st_queue *queue, const char *bytes, size_t length)
{
    st_message *message = message_new(bytes, length);
    pthread_mutex_lock(&queue->lock);
    if (queue->ended) {
        release(message);
    } else {
        append(queue, message);
        if (queue->newest.stamp <= queue->allowed) {
            wake_all(queue);
        }
    }
    pthread_mutex_unlock(&queue->lock);
}

void st_queue_nudge(st_queue *queue)
{
    pthread_mutex_lock(&queue->lock);
    queue->nudges++;
    wake_all(queue);
    pthread_mutex_unlock(&queue->lock);
}

uint64_t st_queue_newest(st_queue *queue)
{
    pthread_mutex_lock(&queue->lock);
    uint64_t stamp = queue->newest.stamp;
    pthread_mutex_unlock(&queue->lock);
    return stamp;
}

void st_queue_allow(st_queue *queue, uint64_t stamp)
{
    pthread_mutex_lock(&queue->lock);
    if (stamp > queue->allowed && !queue->lost) {
        queue->allowed = stamp;
        wake_all(queue);
    }
    pthread_mutex_unlock(&queue->lock);
}

void st_queue_lose(st_queue *queue)
{
    pthread_mutex_lock(&queue->lock);
    queue->lost = true;
    wake_all(queue);
    pthread_mutex_unlock(&queue->lock);
}

void st_queue_end(st_queue *queue)
{
    pthread_mutex_lock(&queue->lock);
    queue->ended = true;
    wake_all(queue);
    pthread_mutex_unlock(&queue->lock);
}

void st_queue_shed(st_queue *queue)
{
    pthread_mutex_lock(&queue->lock);
    if (queue->listeners == 0) {
        drop_all(queue);
    }
    pthread_mutex_unlock(&queue->lock);
}

/* --- functions of listeners --- */

bool st_queue_listen(st_queue *queue, st_listener *listener, size_t most)
{
    pthread_mutex_lock(&queue->lock);
    bool room = queue->listeners < most;
    if (room) {
        *listener =
            (st_listener){.queue = queue, .number = newest_number(queue), .nudges = queue->nudges};
        queue->listeners++;
    }
    pthread_mutex_unlock(&queue->lock);
    return room;
}

bool st_queue_rewind(st_listener *listener, uint64_t key)
{
    st_queue *queue = listener->queue;
    pthread_mutex_lock(&queue->lock);
    bool found = queue->floor.key == key;
    uint64_t number = queue->floor_number;
    for (size_t i = 0; i < queue->count && !found; i++) {
        found = message_at(queue, i)->place.key == key;
        number++;
    }
    if (found) {
        listener->number = number;
    }
    pthread_mutex_unlock(&queue->lock);
    return found;
}

void st_queue_wake(st_listener *listener, void (*wake)(void *context), void *context)
{
    listener->wake = wake;
    listener->context = context;
}

void st_queue_leave(st_listener *listener)
{
    st_queue *queue = listener->queue;
    if (queue == NULL) {
        return;
    }
    pthread_mutex_lock(&queue->lock);
    end_waiting(queue, listener);
    release(listener->message);
    queue->listeners--;
    queue->left = st_clock_micros();
    pthread_mutex_unlock(&queue->lock);
    *listener = (st_listener){0};
}

/* If the listener may read the next message of the queue, makes it the listener's current
 * message. */
static st_queue_result next_message(st_queue *queue, st_listener *listener)
{
    if (listener->number < queue->floor_number) {
        return queue->floor.stamp <= queue->allowed ? ST_QUEUE_BEHIND : ST_QUEUE_WAIT;
    }
    if (listener->number == newest_number(queue)) {
        return queue->ended && queue->newest.stamp <= queue->allowed ? ST_QUEUE_ENDED
                                                                     : ST_QUEUE_WAIT;
    }
    st_message *message = message_at(queue, (size_t)(listener->number - queue->floor_number));
    if (message->place.stamp > queue->allowed) {
        return ST_QUEUE_WAIT;
    }
    message->uses++;
    listener->message = message;
    listener->sent = 0;
    listener->number++;
    return ST_QUEUE_GOT;
}

static size_t copy_out(st_listener *listener, char *buffer, size_t size)
{
    st_queue_counts *counts = listener->queue->counts;
    st_message *message = listener->message;
    size_t length = message->length - listener->sent;
    length = length < size ? length : size;
    memcpy(buffer, message->bytes + listener->sent, length);
    listener->sent += length;
    if (listener->sent == message->length) {
        st_histogram_add(&counts->lag, st_scale_micros, st_clock_micros() - message->made);
        listener->message = NULL;
        release(message);
    }
    return length;
}

st_queue_result st_queue_read(st_listener *listener, char *buffer, size_t size, size_t *got)
{
    st_queue *queue = listener->queue;
    st_queue_result step = ST_QUEUE_GOT;
    size_t used = 0;
    pthread_mutex_lock(&queue->lock);
    while (used < size && step == ST_QUEUE_GOT) {
        if (listener->message == NULL) {
            step = next_message(queue, listener);
        }
        if (step == ST_QUEUE_GOT) {
            used += copy_out(listener, buffer + used, size - used);
        }
    }
    if (used > 0) {
        step = ST_QUEUE_GOT;
    } else if (step == ST_QUEUE_BEHIND) {
        count(&queue->counts->behind, 1);
    } else if (step == ST_QUEUE_WAIT && queue->lost) {
        step = ST_QUEUE_LOST;
    } else if (step == ST_QUEUE_WAIT && listener->nudges != queue->nudges) {
        listener->nudges = queue->nudges;
        step = ST_QUEUE_NUDGED;
    } else if (step == ST_QUEUE_WAIT) {
        begin_waiting(queue, listener);
    }
    pthread_mutex_unlock(&queue->lock);
    *got = used;
    return step;
}

st_place st_queue_skip(st_listener *listener)
{
    st_queue *queue = listener->queue;
    pthread_mutex_lock(&queue->lock);
    size_t i = first_forbidden(queue);
    st_place place = i == 0 ? queue->floor : message_at(queue, i - 1)->place;
    listener->number = queue->floor_number + i;
    pthread_mutex_unlock(&queue->lock);
    return place;
}
