/* limits.h - maxima of the server's own buffers that the outside fills. */
#ifndef HE_SERVER_LIMITS_H
#define HE_SERVER_LIMITS_H

/* Of one feed: what listeners may be behind before they are sent to fetch anew. */
enum { SRV_FEED_MESSAGES = 1024, SRV_FEED_BYTES = 1 << 20 };

/* How long a feed that nobody listens to goes on collecting, so that who was cut off finds what it
 * missed: microseconds. */
enum { SRV_FEED_LINGER = 30 * 1000 * 1000 };

/* Listeners that are brought forward from the history at once, each with a copy of its mesh. */
enum { SRV_MAX_CATCH_UPS = 8 };

#endif
