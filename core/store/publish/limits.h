/* limits.h - the largest sizes that those buffers of the store may have which clients fill. */
#ifndef HE_STORE_LIMITS_H
#define HE_STORE_LIMITS_H

/* Mesh data, or an encoded edit, of more than ST_BODY_BYTES bytes is staged, which means that it is
 * written to the disk before the change is published (journal.h). */
enum { ST_BODY_BYTES = 1 << 20 };

/* A mesh gets a new base, the stored mesh data from which it is loaded, when its records since the
 * last base take more than ST_BASE_BYTES bytes and more bytes than its data. */
enum { ST_BASE_BYTES = 16 << 20 };

/* ST_QUEUE_MESSAGES and ST_QUEUE_BYTES are the most messages, and bytes of messages, that a mesh
 * keeps for its listeners. A listener that falls further behind must fetch the mesh again. */
enum { ST_QUEUE_MESSAGES = 1024, ST_QUEUE_BYTES = 1 << 20 };

/* Microseconds for which a queue of messages still collects them after its last listener left, so
 * that a listener whose connection broke can read what it missed. */
enum { ST_QUEUE_LINGER = 30 * 1000 * 1000 };

#endif
