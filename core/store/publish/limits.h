/* limits.h - maxima of the store's buffers that clients fill. */
#ifndef HE_STORE_LIMITS_H
#define HE_STORE_LIMITS_H

/* A content or edit that takes more bytes is staged, which means that it is written to the disk
 * before the change is published (journal.h). */
enum { ST_BODY_BYTES = 1 << 20 };

/* A mesh gets a new base, from which it is loaded, when its records take more bytes than this and
 * more than its content. */
enum { ST_BASE_BYTES = 16 << 20 };

/* The most messages, and bytes of messages, that a mesh keeps for its listeners. A listener that
 * falls further behind must fetch the mesh again. */
enum { ST_QUEUE_MESSAGES = 1024, ST_QUEUE_BYTES = 1 << 20 };

/* Microseconds for which a queue without listeners still collects messages, so that a listener
 * whose connection broke can read what it missed. */
enum { ST_QUEUE_LINGER = 30 * 1000 * 1000 };

#endif
