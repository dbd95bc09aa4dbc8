/* limits.h - the sizes of the send buffers that the kernel has for a connection. */
#ifndef HE_SERVER_HTTP_LIMITS_H
#define HE_SERVER_HTTP_LIMITS_H

/* How many bytes of answers the kernel buffers for a connection until the client reads them; it
 * needs as much memory again for bookkeeping. By default it would buffer 3 MiB for a client that
 * does not read. On loopback a buffer larger than SRV_SEND_BUFFER is not faster; a distant client
 * receives at most one buffer per round trip. A connection begins with a buffer of
 * SRV_FIRST_SEND_BUFFER bytes, so that only a small part of an answer is made in vain if the client
 * reads nothing. */
enum { SRV_SEND_BUFFER = 128 * 1024, SRV_FIRST_SEND_BUFFER = 16 * 1024 };

#endif
