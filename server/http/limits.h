/* limits.h - maximum sizes per connection. */
#ifndef HE_SERVER_HTTP_LIMITS_H
#define HE_SERVER_HTTP_LIMITS_H

/* Bytes of answers that the kernel buffers for a connection until the client reads them; it needs
 * as much again for bookkeeping. By default it would buffer 3 MiB for a client that does not read.
 * On loopback a larger buffer is not faster; a distant client receives this much per round trip. An
 * answer that is made while it is sent begins with SRV_FIRST_SEND_BUFFER until its client has read
 * some of it, so that little is made for a client that reads nothing. */
enum { SRV_SEND_BUFFER = 128 * 1024, SRV_FIRST_SEND_BUFFER = 16 * 1024 };

#endif
