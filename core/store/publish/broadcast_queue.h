/* broadcast_queue.h - messages for many listeners, stored once.
 *
 * A queue is bounded; any number of listeners read its messages, each at its own pace. Messages are
 * bytes whose meaning the queue does not know. Each has a place: a stamp, which never falls, and a
 * key, which may. A message that is no change of the mesh is put beside the newest one, at its
 * place. Listeners count messages by numbers, which have no gaps.
 *
 *        floor                                     newest
 *          |    [m] [m] [m] [m] [m] [m] [m]          |
 *       dropped          ^           ^   may not be read yet
 *                    listener     allowed
 *
 * The oldest messages are dropped beyond ST_QUEUE_MESSAGES or ST_QUEUE_BYTES. A listener that had
 * not read one of them is behind: its next read returns ST_QUEUE_BEHIND once, then it continues at
 * the newest message it may read. The queue never waits for it, and it keeps no more memory than
 * the message it is in the middle of.
 *
 * A listener may read a message once its stamp is allowed: a revision that is not yet durable is in
 * the queue, in order, but no listener sees it (D1).
 *
 * Every function takes the queue's lock. Wake functions are called under it and may not call
 * back. */
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

/* One listener of a queue. It is in the caller's storage, which must stay until st_queue_leave has
 * returned, even during a call of `wake`. */
typedef struct st_listener {
    struct st_queue *queue; /* NULL: not listening */
    uint64_t number;        /* number of the message it read last, or is reading */
    st_message *message;    /* message being read; NULL: none */
    size_t sent;            /* bytes of it that were read */
    void (*wake)(void *context);
    void *context;
    bool waiting; /* it is in the list of listeners to wake */
    struct st_listener *next, *previous;
} st_listener;

/* Counts of all queues of a store together, updated without a lock. */
typedef struct st_queue_counts {
    _Atomic uint64_t messages; /* messages added */
    _Atomic uint64_t bytes;    /* bytes of messages in the queues */
    _Atomic uint64_t behind;   /* how often a listener fell behind */
    /* The microseconds from adding a message until it was read, once for each listener. */
    st_histogram lag;
} st_queue_counts;

typedef struct st_queue {
    st_queue_counts *counts;
    pthread_mutex_t lock;
    st_message **ring; /* size: a power of two */
    size_t capacity, first, count;
    size_t bytes;           /* bytes of the messages */
    st_place floor, newest; /* places of the last message dropped, and of the last one added */
    uint64_t floor_number;  /* number of the last message dropped; the ring holds those after it, up
                               to the newest */
    uint64_t allowed;       /* stamps up to this one may be read */
    bool ended;             /* the newest message is the last one */
    bool lost;              /* no further stamp will be allowed */
    size_t listeners;
    uint64_t left; /* when the last listener left, 0 if there was none */
    st_listener *waiting;
} st_queue;

/* Makes an empty queue whose newest message counts as at `place`. `counts` must outlive the
 * queue. */
void st_queue_init(st_queue *queue, st_place place, st_queue_counts *counts);
/* No listener may be left. */
void st_queue_clear(st_queue *queue);

/* Returns true if a listener exists, or did until lately, so that messages are worth making. */
bool st_queue_is_followed(st_queue *queue);
/* Adds a message; its bytes are copied. With NULL bytes, or if memory is out, every listener that
 * has not read beyond this place is behind. */
void st_queue_add(st_queue *queue, st_place place, const char *bytes, size_t length);
/* Adds a message at the place of the newest one. After st_queue_end it does nothing. */
void st_queue_add_beside(st_queue *queue, const char *bytes, size_t length);
/* Returns the newest stamp. */
uint64_t st_queue_newest(st_queue *queue);
/* Allows messages up to this stamp to be read, and wakes the listeners that wait. */
void st_queue_allow(st_queue *queue, uint64_t stamp);
/* Declares that stamps which are not allowed by now never will be, because their changes are
 * lost. */
void st_queue_lose(st_queue *queue);
/* Declares that no message will be added any more. */
void st_queue_end(st_queue *queue);
/* Frees the messages of a queue if it has no listener. */
void st_queue_shed(st_queue *queue);

/* Adds a listener, which begins after the newest message, allowed or not. Returns false if `most`
 * listeners exist already. */
bool st_queue_listen(st_queue *queue, st_listener *listener, size_t most);
/* Moves a listener back to what follows the first message of this key. Returns false if some of
 * that was dropped. */
bool st_queue_rewind(st_listener *listener, uint64_t key);
/* Sets the function that is called when a listener that got ST_QUEUE_WAIT can read on. The caller
 * must do this before the first read. */
void st_queue_wake(st_listener *listener, void (*wake)(void *context), void *context);
/* Removes a listener; does nothing if it does not listen. */
void st_queue_leave(st_listener *listener);

typedef enum st_queue_result {
    ST_QUEUE_GOT,  /* read: *got bytes */
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
