/* broadcast_queue.h - messages for many listeners, kept once.
 *
 * A queue is bounded; any number of listeners read its messages, each at its own pace.
 * Messages are bytes; what they mean is their maker's business. Each has a place: a stamp, which
 * never falls, and a key, which may. What is no change is put beside
 * the newest one, at its place. Listeners go by numbers, which have no gaps.
 *
 *        floor                                     newest
 *          |    [m] [m] [m] [m] [m] [m] [m]          |
 *       dropped          ^           ^   may not be read yet
 *                    listener     allowed
 *
 * The oldest messages are dropped beyond ST_QUEUE_MESSAGES or ST_QUEUE_BYTES. A listener that had
 * not read one of them is behind: it is told so once and goes on at the newest message it may
 * read. It is never waited for, and never costs more than the message it is in the middle of.
 *
 * A message may be read once its stamp is allowed: a revision that is not yet durable is in the
 * queue, in its order, and is seen by nobody (D1).
 *
 * Every function takes the queue's lock; wakes are called under it and may not call back. */
#ifndef HE_STORE_BROADCAST_QUEUE_H
#define HE_STORE_BROADCAST_QUEUE_H

#include "store/limits.h"
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

/* In the storage of its owner, who outlives no call of `wake` that it has not ended by
 * st_queue_leave. */
typedef struct st_listener {
    struct st_queue *queue; /* NULL: it listens to none */
    uint64_t number;        /* of the message it read last, or is reading */
    st_message *message;    /* being read, NULL: none */
    size_t sent;            /* of it */
    void (*wake)(void *context);
    void *context;
    bool waiting; /* in the list of those to be woken */
    struct st_listener *next, *previous;
} st_listener;

/* What the queues of a store count together, without a lock. */
typedef struct st_queue_counts {
    _Atomic uint64_t messages; /* that were added */
    _Atomic uint64_t bytes;    /* of messages that are kept */
    _Atomic uint64_t behind;   /* how often a listener was told that it is behind */
    st_histogram lag; /* microseconds from adding a message to its having been read, once for each
                         listener */
} st_queue_counts;

typedef struct st_queue {
    st_queue_counts *counts;
    pthread_mutex_t lock;
    st_message **ring; /* a power of two of places */
    size_t capacity, first, count;
    size_t bytes;           /* of messages */
    st_place floor, newest; /* the last that is not in the ring, and the last of all */
    uint64_t floor_number;  /* the ring holds those after it, up to the newest */
    uint64_t allowed;       /* stamps up to here may be read */
    bool ended;             /* nothing comes after `newest` */
    bool lost;              /* nothing more will be allowed */
    size_t listeners;
    uint64_t left; /* when the last listener went, 0: there was none */
    st_listener *waiting;
} st_queue;

/* What comes is after `place`. `counts` outlives the queue. */
void st_queue_init(st_queue *queue, st_place place, st_queue_counts *counts);
/* Nobody may listen. */
void st_queue_clear(st_queue *queue);

/* Does, or did until lately, anybody listen, so that messages are worth making? */
bool st_queue_is_followed(st_queue *queue);
/* Add a message; its bytes are copied. NULL bytes, or no memory: who reads up to here is behind. */
void st_queue_add(st_queue *queue, st_place place, const char *bytes, size_t length);
/* The same at the place of the newest message. After the end it is left out. */
void st_queue_add_beside(st_queue *queue, const char *bytes, size_t length);
/* The newest stamp. */
uint64_t st_queue_newest(st_queue *queue);
/* Messages up to this stamp may be read: wakes who waits. */
void st_queue_allow(st_queue *queue, uint64_t stamp);
/* What is not allowed by now never will be. */
void st_queue_lose(st_queue *queue);
/* Nothing will be added any more. */
void st_queue_end(st_queue *queue);
/* Forget the messages if nobody listens. */
void st_queue_shed(st_queue *queue);

/* Begin after the newest message, allowed or not; false when `most` listen already. */
bool st_queue_listen(st_queue *queue, st_listener *listener, size_t most);
/* Go back to what follows the first message of this key: false when that is not all there. */
bool st_queue_rewind(st_listener *listener, uint64_t key);
/* What to call after ST_QUEUE_WAIT. Before the first read. */
void st_queue_wake(st_listener *listener, void (*wake)(void *context), void *context);
/* Accepts a listener that listens to none. */
void st_queue_leave(st_listener *listener);

typedef enum st_queue_result {
    ST_QUEUE_GOT,  /* *got of them */
    ST_QUEUE_WAIT, /* nothing now; `wake` will be called */
    ST_QUEUE_BEHIND,
    ST_QUEUE_LOST, /* what comes next never will be allowed */
    ST_QUEUE_ENDED
} st_queue_result;

st_queue_result st_queue_read(st_listener *listener, char *buffer, size_t size, size_t *got);
/* After ST_QUEUE_BEHIND or ST_QUEUE_LOST: go on from the newest message that may be read, whose
 * place this is. */
st_place st_queue_skip(st_listener *listener);

#endif
