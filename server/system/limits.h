/* limits.h - maxima of the server's own buffers that the outside fills. */
#ifndef HE_SERVER_SYSTEM_LIMITS_H
#define HE_SERVER_SYSTEM_LIMITS_H

/* Of one feed: what listeners may be behind before they are sent to fetch anew. */
enum { SRV_FEED_MESSAGES = 1024, SRV_FEED_BYTES = 1 << 20 };

/* How long a feed that nobody listens to goes on collecting, so that who was cut off finds what it
 * missed: microseconds. */
enum { SRV_FEED_LINGER = 30 * 1000 * 1000 };

/* Of a connection: what the kernel keeps of answers until the client has taken it, in bytes; it
 * keeps as much again for its own records. Left alone it lets a client who does not read hold 3
 * MiB. Over loopback more is not faster; a far client gets this much a round trip. */
enum { SRV_SEND_BUFFER = 128 * 1024 };

/* Listeners that are brought forward from the history at once, each with a copy of its mesh. */
enum { SRV_MAX_CATCH_UPS = 8 };

#endif
