/* broadcast_queue.h - messages for many listeners, stored once.
 *
 * A queue is bounded; any number of listeners read its messages, each at its own pace. Messages are
 * bytes whose meaning the queue does not know. Each has a place: a stamp, which is never lower than
 * that of an older message, and a key, which may be. A message that is no change of the mesh gets
 * the place of the newest message. Messages are also numbered without gaps.
 *
 *        floor                                     newest
 *          |    [m] [m] [m] [m] [m] [m] [m]          |
 *       dropped          ^           ^   may not be read yet
 *                    listener     allowed
 *
 * The oldest messages are dropped beyond ST_QUEUE_MESSAGES or ST_QUEUE_BYTES. A listener that had
 * not read one of them is behind: its next read returns ST_QUEUE_BEHIND once, then it continues at
 * the newest message it may read. The queue never waits for it, and a listener keeps no more memory
 * than the message that it is reading.
 *
 * A listener may read a message once its stamp is allowed: a revision that is not yet durable is in
 * the queue, in order, but no listener reads it (rule D1 of durability_wait.h).
 *
 * Every function takes the queue's lock. Wake functions are called under this lock and may not call
 * functions of the queue. */
#ifndef HE_STORE_BROADCAST_QUEUE_H
#define HE_STORE_BROADCAST_QUEUE_H

#include "store/publish/limits.h"
#include "system/histogram.h"

#include <pthread.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct st_place {
    uint64_t stamp, key;
} st_place;

typedef struct st_message st_message;

/* One listener of a queue. It is in the caller's storage, which must exist until st_queue_leave has
 * returned, even if another thread is calling `wake`. */
typedef struct st_listener {
    struct st_queue *queue; /* NULL: not listening */
    uint64_t number;        /* number of the message that the listener read last, or is reading */
    st_message *message;    /* the message being read; NULL: none */
    size_t sent;            /* bytes of `message` that were read */
    void (*wake)(void *context);
    void *context;
    bool waiting; /* the listener is in the list of listeners to wake */
    struct st_listener *next, *previous;
} st_listener;

/* Counts that all queues of a store share, updated without a lock. */
typedef struct st_queue_counts {
    _Atomic uint64_t messages; /* messages added */
    _Atomic uint64_t bytes;    /* bytes of messages in the queues */
    _Atomic uint64_t behind;   /* how often a listener fell behind */
    /* Microseconds from adding a message until a listener read it, counted for each listener. */
    st_histogram lag;
} st_queue_counts;

typedef struct st_queue {
    st_queue_counts *counts;
    pthread_mutex_t lock;
    st_message **ring; /* size: a power of two */
    size_t capacity, first, count;
    size_t bytes; /* bytes of the messages */
    /* Place of the last message dropped, and place of the last message added. */
    st_place floor, newest;
    uint64_t floor_number; /* number of the last message dropped; the ring holds all later ones */
    uint64_t allowed;      /* messages with stamps up to this one may be read */
    bool ended;            /* the newest message is the last one */
    bool lost;             /* no stamp above `allowed` will ever be allowed */
    size_t listeners;
    uint64_t left; /* when the last listener left; 0 if there never was one */
    st_listener *waiting;
} st_queue;

/* Makes an empty queue, as if its newest message were at `place`. `counts` must outlive the
 * queue. */
void st_queue_init(st_queue *queue, st_place place, st_queue_counts *counts);
/* Frees the messages of the queue. No listener may be left. */
void st_queue_clear(st_queue *queue);

/* Returns true if a listener exists, or existed in the last ST_QUEUE_LINGER microseconds. Otherwise
 * no message need be made. */
bool st_queue_is_followed(st_queue *queue);
/* Adds a message; its bytes are copied. With NULL bytes, or if memory is out, every listener
 * becomes behind, because it cannot read a message at this place. */
void st_queue_add(st_queue *queue, st_place place, const char *bytes, size_t length);
/* Adds a message at the place of the newest message. Does nothing after st_queue_end. */
void st_queue_add_beside(st_queue *queue, const char *bytes, size_t length);
/* Returns the stamp of the newest message. */
uint64_t st_queue_newest(st_queue *queue);
/* Allows messages with stamps up to this one to be read, and wakes the listeners that wait for
 * them. */
void st_queue_allow(st_queue *queue, uint64_t stamp);
/* Declares that messages with stamps that are not allowed by now will never be allowed, because
 * their changes are lost. */
void st_queue_lose(st_queue *queue);
/* Declares that no message will be added any more. */
void st_queue_end(st_queue *queue);
/* Frees the messages of the queue if it has no listener. */
void st_queue_shed(st_queue *queue);

/* Adds a listener, which begins after the newest message, even if that may not be read yet. Returns
 * false if `most` listeners exist already. */
bool st_queue_listen(st_queue *queue, st_listener *listener, size_t most);
/* Moves a listener back to just after the first message with this key. Returns false if a message
 * that it should read was dropped. */
bool st_queue_rewind(st_listener *listener, uint64_t key);
/* Sets the function that is called when a listener that got ST_QUEUE_WAIT can read on. The caller
 * must do this before the first read. */
void st_queue_wake(st_listener *listener, void (*wake)(void *context), void *context);
/* Removes a listener; does nothing if it does not listen. */
void st_queue_leave(st_listener *listener);

typedef enum st_queue_result {
    ST_QUEUE_GOT,  /* *got bytes of a message were read */
    ST_QUEUE_WAIT, /* nothing to read now; `wake` will be called */
    ST_QUEUE_BEHIND,
    ST_QUEUE_LOST, /* the next message will never be allowed */
    ST_QUEUE_ENDED
} st_queue_result;

st_queue_result st_queue_read(st_listener *listener, char *buffer, size_t size, size_t *got);
/* Lets a listener continue, after ST_QUEUE_BEHIND or ST_QUEUE_LOST, from the newest message that
 * may be read, and returns the place of that message. */
st_place st_queue_skip(st_listener *listener);

#endif
