/* broadcast_queue.h - messages for many listeners, stored once.
 *
 * A queue is bounded; any number of listeners read its messages, each at its own pace. Messages are
 * bytes whose meaning the queue does not know. Each message has a place: a stamp, which is never
 * lower than the stamp of an older message, and a key, which may be lower than that of an older
 * one. A message that describes no change of the mesh gets the place of the newest message.
 * Messages are also numbered without gaps.
 *
 *        floor                                     newest
 *          |    [m] [m] [m] [m] [m] [m] [m]          |
 *       dropped          ^           ^   may not be read yet
 *                    listener     allowed
 *
 * The oldest messages are dropped beyond ST_QUEUE_MESSAGES or ST_QUEUE_BYTES. A listener that had
 * not read a dropped message is behind: its next read returns ST_QUEUE_BEHIND once, then the
 * listener continues at the newest message it may read. The queue never waits for a listener, and a
 * listener keeps no more memory than the message that it is reading.
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

/* One listener of a queue. The struct is in the caller's storage, which must exist until
 * st_queue_leave has returned, even if another thread is calling `wake`. */
typedef struct st_listener {
    struct st_queue *queue; /* NULL: not listening */
    uint64_t number;        /* number of the message that the listener read last, or is reading */
    st_message *message;    /* the message that the listener is reading; NULL: none */
    size_t sent;            /* bytes of `message` that were read */
    void (*wake)(void *context);
    void *context;
    bool waiting;    /* true if the listener is in the list of listeners to wake */
    uint64_t nudges; /* the number of nudges that the listener knows of */
    struct st_listener *next, *previous;
} st_listener;

/* Counts that all queues of a store share, updated without a lock. */
typedef struct st_queue_counts {
    _Atomic uint64_t messages; /* messages added */
    _Atomic uint64_t bytes;    /* bytes of messages in the queues */
    _Atomic uint64_t behind;   /* how often a listener fell behind, so that it missed messages */
    /* Microseconds from adding a message until a listener read it, counted for each listener. */
    st_histogram lag;
} st_queue_counts;

typedef struct st_queue {
    st_queue_counts *counts;
    pthread_mutex_t lock;
    st_message **ring; /* size: a power of two */
    size_t capacity, first, count;
    size_t bytes; /* bytes of the messages */
    /* `floor` is the place of the last message that was dropped, `newest` that of the last message
     * that was added. */
    st_place floor, newest;
    /* number of the last message that was dropped; the ring holds all later messages */
    uint64_t floor_number;
    uint64_t allowed; /* messages with stamps up to this one may be read */
    bool ended;       /* true if no message will follow the newest one */
    /* true if messages with stamps above `allowed` will never be allowed, because their changes are
     * lost */
    bool lost;
    uint64_t nudges; /* how often st_queue_nudge was called */
    size_t listeners;
    uint64_t left; /* time when the last listener left; 0: the queue never had a listener */
    st_listener *waiting;
} st_queue;

/* Makes an empty queue; the next message follows the place (stamp and key) `place`. `counts` must
 * outlive the
 * queue. */
void st_queue_init(st_queue *queue, st_place place, st_queue_counts *counts);
/* Frees the messages of the queue, which may have no listener. */
void st_queue_clear(st_queue *queue);

/* Returns true if the queue has a listener, or had one in the last ST_QUEUE_LINGER microseconds. If
 * it returns false, no message need be made. */
bool st_queue_is_followed(st_queue *queue);
/* Adds a message; its bytes are copied. If the bytes are NULL or memory is out, every listener
 * falls behind, because the message is missing from the queue. */
void st_queue_add(st_queue *queue, st_place place, const char *bytes, size_t length);
/* Adds a message that gets the place (stamp and key) of the newest message. Does nothing after
 * st_queue_end. */
void st_queue_add_beside(st_queue *queue, const char *bytes, size_t length);
/* Makes the next read of each listener that has nothing to read return ST_QUEUE_NUDGED once, and
 * wakes the listeners that wait: something that is no message has changed for them. */
void st_queue_nudge(st_queue *queue);
/* Returns the stamp of the newest message. */
uint64_t st_queue_newest(st_queue *queue);
/* Allows listeners to read messages with stamps up to `stamp`, and wakes the listeners that wait
 * for these messages. */
void st_queue_allow(st_queue *queue, uint64_t stamp);
/* Declares that messages whose stamps are not allowed yet will never be allowed, because their
 * changes are lost. */
void st_queue_lose(st_queue *queue);
/* Declares that no message will be added to the queue any more. */
void st_queue_end(st_queue *queue);
/* Frees the messages of the queue if it has no listener. */
void st_queue_shed(st_queue *queue);

/* Adds a listener, which begins after the newest message, even if listeners may not read that
 * message yet. Returns false if the queue has `most` listeners already. */
bool st_queue_listen(st_queue *queue, st_listener *listener, size_t most);
/* Moves a listener back, so that the next message that it reads is the one after the first message
 * with this key. Returns false if a message that it should read was dropped. */
bool st_queue_rewind(st_listener *listener, uint64_t key);
/* Sets the function that is called when a listener that got ST_QUEUE_WAIT can read on. The caller
 * must do this before the first read. */
void st_queue_wake(st_listener *listener, void (*wake)(void *context), void *context);
/* Removes a listener from the queue; does nothing if it was removed already. */
void st_queue_leave(st_listener *listener);

typedef enum st_queue_result {
    ST_QUEUE_GOT,  /* *got bytes of a message were copied to the reader */
    ST_QUEUE_WAIT, /* the listener has nothing to read now; its function `wake` will be called */
    /* the listener has nothing to read now, and was nudged (st_queue_nudge) since it last waited */
    ST_QUEUE_NUDGED,
    ST_QUEUE_BEHIND,
    /* the listener may never read the next message, because the change of that message is lost */
    ST_QUEUE_LOST,
    ST_QUEUE_ENDED
} st_queue_result;

st_queue_result st_queue_read(st_listener *listener, char *buffer, size_t size, size_t *got);
/* Lets a listener continue, after ST_QUEUE_BEHIND or ST_QUEUE_LOST, from the newest message that
 * may be read, and returns the place of that message. */
st_place st_queue_skip(st_listener *listener);

#endif
