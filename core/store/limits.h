/* limits.h - maxima of the store's buffers that the outside fills. */
#ifndef HE_STORE_LIMITS_H
#define HE_STORE_LIMITS_H

/* A whole content that takes more is staged (journal.h) before it is published. */
enum { ST_BODY_BYTES = 1 << 20 };

/* A new base is made when the records of a mesh take more than this and more than its content. */
enum { ST_BASE_BYTES = 16 << 20 };

/* How far the listeners of one mesh may be behind before they are sent to fetch anew: messages, and
 * their bytes. */
enum { ST_QUEUE_MESSAGES = 1024, ST_QUEUE_BYTES = 1 << 20 };

/* How long a queue that nobody listens to goes on collecting, so that a listener that was cut off
 * finds what it missed: microseconds. */
enum { ST_QUEUE_LINGER = 30 * 1000 * 1000 };

#endif
