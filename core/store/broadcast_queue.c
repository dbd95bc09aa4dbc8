#include "store/broadcast_queue.h"

#include "base/mem.h"
#include "system/clock.h"

#include <assert.h>
#include <string.h>

struct st_message {
    uint32_t uses; /* by the ring and by listeners, under the feed's lock */
    st_place place;
    size_t length;
    char bytes[];
};

void st_queue_init(st_queue *feed, st_place place)
{
    *feed = (st_queue){.floor = place, .newest = place};
    pthread_mutex_init(&feed->lock, NULL);
}

/* --- under the lock --- */

static st_message *message_at(const st_queue *feed, size_t i)
{
    return feed->ring[(feed->first + i) & (feed->capacity - 1)];
}

static void release(st_message *message)
{
    if (message != NULL && --message->uses == 0) {
        he_mem_free(message);
    }
}

static void drop_oldest(st_queue *feed)
{
    st_message *message = message_at(feed, 0);
    feed->floor = message->place;
    feed->floor_number++;
    feed->bytes -= message->length;
    feed->first = (feed->first + 1) & (feed->capacity - 1);
    feed->count--;
    release(message);
}

static void drop_all(st_queue *feed)
{
    while (feed->count > 0) {
        drop_oldest(feed);
    }
    he_mem_free(feed->ring);
    feed->ring = NULL;
    feed->capacity = 0;
    feed->first = 0;
}

static bool reserve_place(st_queue *feed)
{
    if (feed->count < feed->capacity) {
        return true;
    }
    size_t capacity = feed->capacity == 0 ? 8 : 2 * feed->capacity;
    st_message **ring = he_mem_array(NULL, capacity, sizeof(st_message *));
    if (ring == NULL) {
        return false;
    }
    for (size_t i = 0; i < feed->count; i++) {
        ring[i] = message_at(feed, i);
    }
    he_mem_free(feed->ring);
    feed->ring = ring;
    feed->capacity = capacity;
    feed->first = 0;
    return true;
}

static bool is_followed(const st_queue *feed)
{
    return feed->listeners > 0 ||
           (feed->left != 0 && st_clock_micros() - feed->left < ST_QUEUE_LINGER);
}

static void begin_waiting(st_queue *feed, st_listener *listener)
{
    if (!listener->waiting) {
        listener->waiting = true;
        listener->previous = NULL;
        listener->next = feed->waiting;
        if (listener->next != NULL) {
            listener->next->previous = listener;
        }
        feed->waiting = listener;
    }
}

static void end_waiting(st_queue *feed, st_listener *listener)
{
    if (!listener->waiting) {
        return;
    }
    listener->waiting = false;
    if (listener->previous != NULL) {
        listener->previous->next = listener->next;
    } else {
        feed->waiting = listener->next;
    }
    if (listener->next != NULL) {
        listener->next->previous = listener->previous;
    }
}

static void wake_all(st_queue *feed)
{
    while (feed->waiting != NULL) {
        st_listener *listener = feed->waiting;
        end_waiting(feed, listener);
        listener->wake(listener->context);
    }
}

static uint64_t newest_number(const st_queue *feed)
{
    return feed->floor_number + feed->count;
}

/* Places are in the order of stamps: the first message that may not be read. */
static size_t first_forbidden(const st_queue *feed)
{
    size_t low = 0, high = feed->count;
    while (low < high) {
        size_t middle = low + (high - low) / 2;
        if (message_at(feed, middle)->place.stamp <= feed->allowed) {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    return low;
}

/* --- the maker's side --- */

void st_queue_clear(st_queue *feed)
{
    assert(feed->listeners == 0);
    drop_all(feed);
    pthread_mutex_destroy(&feed->lock);
}

bool st_queue_is_followed(st_queue *feed)
{
    pthread_mutex_lock(&feed->lock);
    bool followed = is_followed(feed);
    pthread_mutex_unlock(&feed->lock);
    return followed;
}

static st_message *message_new(const char *bytes, size_t length)
{
    st_message *message =
        bytes == NULL || length > ST_QUEUE_BYTES ? NULL : he_mem_alloc(sizeof *message + length);
    if (message != NULL) {
        *message = (st_message){.uses = 1, .length = length};
        memcpy(message->bytes, bytes, length);
    }
    return message;
}

/* Takes the message, at the newest place; NULL: it is lost. */
static void append(st_queue *feed, st_message *message)
{
    if (message == NULL || !reserve_place(feed)) {
        release(message);
        drop_all(feed);
        feed->floor = feed->newest;
        feed->floor_number++;
        return;
    }
    message->place = feed->newest;
    feed->ring[(feed->first + feed->count) & (feed->capacity - 1)] = message;
    feed->count++;
    feed->bytes += message->length;
    while (feed->count > ST_QUEUE_MESSAGES || feed->bytes > ST_QUEUE_BYTES) {
        drop_oldest(feed);
    }
}

void st_queue_add(st_queue *feed, st_place place, const char *bytes, size_t length)
{
    st_message *message = message_new(bytes, length);
    pthread_mutex_lock(&feed->lock);
    assert(place.stamp > feed->newest.stamp && !feed->ended);
    feed->newest = place;
    append(feed, message);
    pthread_mutex_unlock(&feed->lock);
}

void st_queue_add_beside(st_queue *feed, const char *bytes, size_t length)
{
    st_message *message = message_new(bytes, length);
    pthread_mutex_lock(&feed->lock);
    if (feed->ended) {
        release(message);
    } else {
        append(feed, message);
        if (feed->newest.stamp <= feed->allowed) {
            wake_all(feed);
        }
    }
    pthread_mutex_unlock(&feed->lock);
}

uint64_t st_queue_newest(st_queue *feed)
{
    pthread_mutex_lock(&feed->lock);
    uint64_t stamp = feed->newest.stamp;
    pthread_mutex_unlock(&feed->lock);
    return stamp;
}

void st_queue_allow(st_queue *feed, uint64_t stamp)
{
    pthread_mutex_lock(&feed->lock);
    if (stamp > feed->allowed) {
        feed->allowed = stamp;
        wake_all(feed);
    }
    pthread_mutex_unlock(&feed->lock);
}

void st_queue_end(st_queue *feed)
{
    pthread_mutex_lock(&feed->lock);
    feed->ended = true;
    wake_all(feed);
    pthread_mutex_unlock(&feed->lock);
}

void st_queue_shed(st_queue *feed)
{
    pthread_mutex_lock(&feed->lock);
    if (feed->listeners == 0) {
        drop_all(feed);
    }
    pthread_mutex_unlock(&feed->lock);
}

/* --- the listener's side --- */

bool st_queue_listen(st_queue *feed, st_listener *listener, size_t most)
{
    pthread_mutex_lock(&feed->lock);
    bool room = feed->listeners < most;
    if (room) {
        *listener = (st_listener){.feed = feed, .number = newest_number(feed)};
        feed->listeners++;
    }
    pthread_mutex_unlock(&feed->lock);
    return room;
}

bool st_queue_rewind(st_listener *listener, uint64_t key)
{
    st_queue *feed = listener->feed;
    pthread_mutex_lock(&feed->lock);
    bool found = feed->floor.key == key;
    uint64_t number = feed->floor_number;
    for (size_t i = 0; i < feed->count && !found; i++) {
        found = message_at(feed, i)->place.key == key;
        number++;
    }
    if (found) {
        listener->number = number;
    }
    pthread_mutex_unlock(&feed->lock);
    return found;
}

void st_queue_wake(st_listener *listener, void (*wake)(void *context), void *context)
{
    listener->wake = wake;
    listener->context = context;
}

void st_queue_leave(st_listener *listener)
{
    st_queue *feed = listener->feed;
    if (feed == NULL) {
        return;
    }
    pthread_mutex_lock(&feed->lock);
    end_waiting(feed, listener);
    release(listener->message);
    feed->listeners--;
    feed->left = st_clock_micros();
    pthread_mutex_unlock(&feed->lock);
    *listener = (st_listener){0};
}

/* The next message it may read becomes the one it is in the middle of. */
static st_queue_result next_message(st_queue *feed, st_listener *listener)
{
    if (listener->number < feed->floor_number) {
        return feed->floor.stamp <= feed->allowed ? ST_QUEUE_BEHIND : ST_QUEUE_WAIT;
    }
    if (listener->number == newest_number(feed)) {
        return feed->ended && feed->newest.stamp <= feed->allowed ? ST_QUEUE_ENDED : ST_QUEUE_WAIT;
    }
    st_message *message = message_at(feed, (size_t)(listener->number - feed->floor_number));
    if (message->place.stamp > feed->allowed) {
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
    st_message *message = listener->message;
    size_t length = message->length - listener->sent;
    length = length < size ? length : size;
    memcpy(buffer, message->bytes + listener->sent, length);
    listener->sent += length;
    if (listener->sent == message->length) {
        listener->message = NULL;
        release(message);
    }
    return length;
}

st_queue_result st_queue_read(st_listener *listener, char *buffer, size_t size, size_t *got)
{
    st_queue *feed = listener->feed;
    st_queue_result step = ST_QUEUE_GOT;
    size_t used = 0;
    pthread_mutex_lock(&feed->lock);
    while (used < size && step == ST_QUEUE_GOT) {
        if (listener->message == NULL) {
            step = next_message(feed, listener);
        }
        if (step == ST_QUEUE_GOT) {
            used += copy_out(listener, buffer + used, size - used);
        }
    }
    if (used > 0) {
        step = ST_QUEUE_GOT;
    } else if (step == ST_QUEUE_WAIT) {
        begin_waiting(feed, listener);
    }
    pthread_mutex_unlock(&feed->lock);
    *got = used;
    return step;
}

st_place st_queue_skip(st_listener *listener)
{
    st_queue *feed = listener->feed;
    pthread_mutex_lock(&feed->lock);
    size_t i = first_forbidden(feed);
    st_place place = i == 0 ? feed->floor : message_at(feed, i - 1)->place;
    listener->number = feed->floor_number + i;
    pthread_mutex_unlock(&feed->lock);
    return place;
}
