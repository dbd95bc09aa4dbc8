/* feed.h - messages for many listeners, kept once.
 *
 * A feed is a bounded queue of messages that any number of listeners read, each at its own pace.
 * Messages are bytes; what they mean is their maker's business. Each has a place: a stamp, which
 * grows with every message of a change, and a key, which need not. What is no change is put beside
 * the newest one, at its place. Listeners go by numbers, which have no gaps.
 *
 *        floor                                     newest
 *          |    [m] [m] [m] [m] [m] [m] [m]          |
 *       dropped          ^           ^   may not be read yet
 *                    listener     allowed
 *
 * The oldest messages are dropped beyond SRV_FEED_MESSAGES or SRV_FEED_BYTES. A listener that had
 * not read one of them is behind: it is told so once and goes on at the newest message it may
 * read. It is never waited for, and never costs more than the message it is in the middle of.
 *
 * A message may be read once its stamp is allowed: a revision that is not yet durable is in the
 * feed, in its order, and is seen by nobody (D1).
 *
 * Every function takes the feed's lock; wakes are called under it and may not call back. */
#ifndef HE_SERVER_STORE_FEED_H
#define HE_SERVER_STORE_FEED_H

#include "server/system/limits.h"

#include <pthread.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct srv_place {
    uint64_t stamp, key;
} srv_place;

typedef struct srv_message srv_message;

/* In the storage of its owner, who outlives no call of `wake` that it has not ended by
 * srv_feed_leave. */
typedef struct srv_listener {
    struct srv_feed *feed; /* NULL: it listens to none */
    uint64_t number;       /* of the message it read last, or is reading */
    srv_message *message;  /* being read, NULL: none */
    size_t sent;           /* of it */
    void (*wake)(void *context);
    void *context;
    bool waiting; /* in the list of those to be woken */
    struct srv_listener *next, *previous;
} srv_listener;

typedef struct srv_feed {
    pthread_mutex_t lock;
    srv_message **ring; /* a power of two of places */
    size_t capacity, first, count;
    size_t bytes;            /* of messages */
    srv_place floor, newest; /* the last that is not in the ring, and the last of all */
    uint64_t floor_number;   /* the ring holds those after it, up to the newest */
    uint64_t allowed;        /* stamps up to here may be read */
    bool ended;              /* nothing comes after `newest` */
    size_t listeners;
    uint64_t left; /* when the last listener went, 0: there was none */
    srv_listener *waiting;
} srv_feed;

/* What comes is after `place`. */
void srv_feed_init(srv_feed *feed, srv_place place);
/* Nobody may listen. */
void srv_feed_clear(srv_feed *feed);

/* Does, or did until lately, anybody listen, so that messages are worth making? */
bool srv_feed_is_followed(srv_feed *feed);
/* Add a message; its bytes are copied. NULL bytes, or no memory: who reads up to here is behind. */
void srv_feed_add(srv_feed *feed, srv_place place, const char *bytes, size_t length);
/* The same at the place of the newest message. After the end it is left out. */
void srv_feed_add_beside(srv_feed *feed, const char *bytes, size_t length);
/* The newest stamp. */
uint64_t srv_feed_newest(srv_feed *feed);
/* Messages up to this stamp may be read: wakes who waits. */
void srv_feed_allow(srv_feed *feed, uint64_t stamp);
/* Nothing will be added any more. */
void srv_feed_end(srv_feed *feed);
/* Forget the messages if nobody listens. */
void srv_feed_shed(srv_feed *feed);

/* Begin after the newest message, allowed or not; false when `most` listen already. */
bool srv_feed_listen(srv_feed *feed, srv_listener *listener, size_t most);
/* Go back to what follows the first message of this key: false when that is not all there. */
bool srv_feed_rewind(srv_listener *listener, uint64_t key);
/* What to call after SRV_FEED_WAIT. Before the first read. */
void srv_feed_wake(srv_listener *listener, void (*wake)(void *context), void *context);
/* Accepts a listener that listens to none. */
void srv_feed_leave(srv_listener *listener);

typedef enum srv_feed_step {
    SRV_FEED_GOT,  /* *got of them */
    SRV_FEED_WAIT, /* nothing now; `wake` will be called */
    SRV_FEED_BEHIND,
    SRV_FEED_ENDED
} srv_feed_step;

srv_feed_step srv_feed_read(srv_listener *listener, char *buffer, size_t size, size_t *got);
/* After SRV_FEED_BEHIND: go on from the newest message that may be read, whose place this is. */
srv_place srv_feed_skip(srv_listener *listener);

#endif
