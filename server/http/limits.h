/* limits.h - maxima of what a connection may hold. */
#ifndef HE_SERVER_HTTP_LIMITS_H
#define HE_SERVER_HTTP_LIMITS_H

/* Bytes of answers that the system keeps for a connection until the client has taken them; it keeps
 * as much again for its own records. Left alone it lets a client who does not read hold 3 MiB. Over
 * loopback more is not faster; a far client gets this much a round trip. An answer that is made
 * while it is sent begins with SRV_FIRST_SEND_BUFFER, until its client has taken some: what nobody
 * takes is not made, and not kept. */
enum { SRV_SEND_BUFFER = 128 * 1024, SRV_FIRST_SEND_BUFFER = 16 * 1024 };

#endif
