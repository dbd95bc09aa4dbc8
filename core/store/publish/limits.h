/* limits.h - maxima of the store's buffers that clients fill. */
#ifndef HE_STORE_LIMITS_H
#define HE_STORE_LIMITS_H

/* A content that takes more bytes is staged: written to the disk before it is published
 * (journal.h). */
enum { ST_BODY_BYTES = 1 << 20 };

/* A mesh gets a new base, from which it is loaded, when its records take more bytes than this and
 * more than its content. */
enum { ST_BASE_BYTES = 16 << 20 };

/* Messages, and their bytes, that listeners of one mesh may be behind before they must fetch the
 * mesh again. */
enum { ST_QUEUE_MESSAGES = 1024, ST_QUEUE_BYTES = 1 << 20 };

/* Microseconds for which a queue without listeners goes on collecting, so that a listener that
 * was cut off finds what it missed. */
enum { ST_QUEUE_LINGER = 30 * 1000 * 1000 };

#endif
