#include "server/store/feed.h"

#include "base/mem.h"
#include "server/system/clock.h"

#include <assert.h>
#include <string.h>

struct srv_message {
    uint32_t uses; /* by the ring and by listeners, under the feed's lock */
    srv_place place;
    size_t length;
    char bytes[];
};

void srv_feed_init(srv_feed *feed, srv_place place)
{
    *feed = (srv_feed){.floor = place, .newest = place};
    pthread_mutex_init(&feed->lock, NULL);
}

/* --- under the lock --- */

static srv_message *message_at(const srv_feed *feed, size_t i)
{
    return feed->ring[(feed->first + i) & (feed->capacity - 1)];
}

static void release(srv_message *message)
{
    if (message != NULL && --message->uses == 0) {
        he_mem_free(message);
    }
}

static void drop_oldest(srv_feed *feed)
{
    srv_message *message = message_at(feed, 0);
    feed->floor = message->place;
    feed->floor_number++;
    feed->bytes -= message->length;
    feed->first = (feed->first + 1) & (feed->capacity - 1);
    feed->count--;
    release(message);
}

static void drop_all(srv_feed *feed)
{
    while (feed->count > 0) {
        drop_oldest(feed);
    }
    he_mem_free(feed->ring);
    feed->ring = NULL;
    feed->capacity = 0;
    feed->first = 0;
}

static bool reserve_place(srv_feed *feed)
{
    if (feed->count < feed->capacity) {
        return true;
    }
    size_t capacity = feed->capacity == 0 ? 8 : 2 * feed->capacity;
    srv_message **ring = he_mem_array(NULL, capacity, sizeof(srv_message *));
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

static bool is_followed(const srv_feed *feed)
{
    return feed->listeners > 0 ||
           (feed->left != 0 && srv_clock_micros() - feed->left < SRV_FEED_LINGER);
}

static void begin_waiting(srv_feed *feed, srv_listener *listener)
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

static void end_waiting(srv_feed *feed, srv_listener *listener)
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

static void wake_all(srv_feed *feed)
{
    while (feed->waiting != NULL) {
        srv_listener *listener = feed->waiting;
        end_waiting(feed, listener);
        listener->wake(listener->context);
    }
}

static uint64_t newest_number(const srv_feed *feed)
{
    return feed->floor_number + feed->count;
}

/* Places are in the order of stamps: the first message that may not be read. */
static size_t first_forbidden(const srv_feed *feed)
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

void srv_feed_clear(srv_feed *feed)
{
    assert(feed->listeners == 0);
    drop_all(feed);
    pthread_mutex_destroy(&feed->lock);
}

bool srv_feed_is_followed(srv_feed *feed)
{
    pthread_mutex_lock(&feed->lock);
    bool followed = is_followed(feed);
    pthread_mutex_unlock(&feed->lock);
    return followed;
}

static srv_message *message_new(const char *bytes, size_t length)
{
    srv_message *message =
        bytes == NULL || length > SRV_FEED_BYTES ? NULL : he_mem_alloc(sizeof *message + length);
    if (message != NULL) {
        *message = (srv_message){.uses = 1, .length = length};
        memcpy(message->bytes, bytes, length);
    }
    return message;
}

/* Takes the message, at the newest place; NULL: it is lost. */
static void append(srv_feed *feed, srv_message *message)
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
    while (feed->count > SRV_FEED_MESSAGES || feed->bytes > SRV_FEED_BYTES) {
        drop_oldest(feed);
    }
}

void srv_feed_add(srv_feed *feed, srv_place place, const char *bytes, size_t length)
{
    srv_message *message = message_new(bytes, length);
    pthread_mutex_lock(&feed->lock);
    assert(place.stamp > feed->newest.stamp && !feed->ended);
    feed->newest = place;
    append(feed, message);
    pthread_mutex_unlock(&feed->lock);
}

void srv_feed_add_beside(srv_feed *feed, const char *bytes, size_t length)
{
    srv_message *message = message_new(bytes, length);
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

uint64_t srv_feed_newest(srv_feed *feed)
{
    pthread_mutex_lock(&feed->lock);
    uint64_t stamp = feed->newest.stamp;
    pthread_mutex_unlock(&feed->lock);
    return stamp;
}

void srv_feed_allow(srv_feed *feed, uint64_t stamp)
{
    pthread_mutex_lock(&feed->lock);
    if (stamp > feed->allowed) {
        feed->allowed = stamp;
        wake_all(feed);
    }
    pthread_mutex_unlock(&feed->lock);
}

void srv_feed_end(srv_feed *feed)
{
    pthread_mutex_lock(&feed->lock);
    feed->ended = true;
    wake_all(feed);
    pthread_mutex_unlock(&feed->lock);
}

void srv_feed_shed(srv_feed *feed)
{
    pthread_mutex_lock(&feed->lock);
    if (feed->listeners == 0) {
        drop_all(feed);
    }
    pthread_mutex_unlock(&feed->lock);
}

/* --- the listener's side --- */

bool srv_feed_listen(srv_feed *feed, srv_listener *listener, size_t most)
{
    pthread_mutex_lock(&feed->lock);
    bool room = feed->listeners < most;
    if (room) {
        *listener = (srv_listener){.feed = feed, .number = newest_number(feed)};
        feed->listeners++;
    }
    pthread_mutex_unlock(&feed->lock);
    return room;
}

bool srv_feed_rewind(srv_listener *listener, uint64_t key)
{
    srv_feed *feed = listener->feed;
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

void srv_feed_wake(srv_listener *listener, void (*wake)(void *context), void *context)
{
    listener->wake = wake;
    listener->context = context;
}

void srv_feed_leave(srv_listener *listener)
{
    srv_feed *feed = listener->feed;
    if (feed == NULL) {
        return;
    }
    pthread_mutex_lock(&feed->lock);
    end_waiting(feed, listener);
    release(listener->message);
    feed->listeners--;
    feed->left = srv_clock_micros();
    pthread_mutex_unlock(&feed->lock);
    *listener = (srv_listener){0};
}

/* The next message it may read becomes the one it is in the middle of. */
static srv_feed_step next_message(srv_feed *feed, srv_listener *listener)
{
    if (listener->number < feed->floor_number) {
        return feed->floor.stamp <= feed->allowed ? SRV_FEED_BEHIND : SRV_FEED_WAIT;
    }
    if (listener->number == newest_number(feed)) {
        return feed->ended && feed->newest.stamp <= feed->allowed ? SRV_FEED_ENDED : SRV_FEED_WAIT;
    }
    srv_message *message = message_at(feed, (size_t)(listener->number - feed->floor_number));
    if (message->place.stamp > feed->allowed) {
        return SRV_FEED_WAIT;
    }
    message->uses++;
    listener->message = message;
    listener->sent = 0;
    listener->number++;
    return SRV_FEED_GOT;
}

static size_t copy_out(srv_listener *listener, char *buffer, size_t size)
{
    srv_message *message = listener->message;
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

srv_feed_step srv_feed_read(srv_listener *listener, char *buffer, size_t size, size_t *got)
{
    srv_feed *feed = listener->feed;
    srv_feed_step step = SRV_FEED_GOT;
    size_t used = 0;
    pthread_mutex_lock(&feed->lock);
    while (used < size && step == SRV_FEED_GOT) {
        if (listener->message == NULL) {
            step = next_message(feed, listener);
        }
        if (step == SRV_FEED_GOT) {
            used += copy_out(listener, buffer + used, size - used);
        }
    }
    if (used > 0) {
        step = SRV_FEED_GOT;
    } else if (step == SRV_FEED_WAIT) {
        begin_waiting(feed, listener);
    }
    pthread_mutex_unlock(&feed->lock);
    *got = used;
    return step;
}

srv_place srv_feed_skip(srv_listener *listener)
{
    srv_feed *feed = listener->feed;
    pthread_mutex_lock(&feed->lock);
    size_t i = first_forbidden(feed);
    srv_place place = i == 0 ? feed->floor : message_at(feed, i - 1)->place;
    listener->number = feed->floor_number + i;
    pthread_mutex_unlock(&feed->lock);
    return place;
}
