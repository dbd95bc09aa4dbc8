/* http_buffer.h - the memory that libmicrohttpd keeps for each connection: counts it, and returns
 * it to the system while the connection is idle.
 *
 * libmicrohttpd allocates SRV_BUFFER_BYTES with mmap() for each connection, zeroes all of it after
 * each request and keeps it until the connection ends: ten thousand idle clients that once sent a
 * request would occupy 350 MB. It has no option for that. So this module defines mmap(), munmap()
 * and epoll_wait() for the whole program. The dynamic linker binds libmicrohttpd's calls to these
 * definitions, as it does for a replaced malloc().
 *
 *   B1  mmap() of exactly that size by libmicrohttpd's workers takes a buffer from one reserved
 *       range, and munmap() of a buffer puts it back; both save the system call. All other calls go
 *       to the system unchanged.
 *   B2  A worker that is about to wait in epoll_wait() returns the pages of its connections that
 *       have been idle for a second (at once when memory is full), a few each time, so that no
 *       client waits for it. It is the only thread that reads and writes these pages.
 *   B3  Only pages that are all zeros are returned: the system replaces them by zeros, so that the
 *       library cannot notice, whatever it keeps there.
 *   B4  st_memory_count counts what a buffer occupies: all of it from the beginning of a request,
 *       and the pages that were not returned while it is idle. */
#ifndef HE_SERVER_HTTP_HTTP_BUFFER_H
#define HE_SERVER_HTTP_HTTP_BUFFER_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* The size of a buffer: large enough for the largest head that http_syntax.h lets through and the
 * head of its answer, and above 32 KiB, up to which libmicrohttpd uses malloc(). Not larger,
 * because libmicrohttpd zeroes it after each request: 64 connections with 128 KiB each do not fit
 * into the cache, which costs more than half of the throughput. */
enum { SRV_BUFFER_BYTES = 36 * 1024 };

enum { SRV_NO_BUFFER = UINT32_MAX };

/* Reserves address space for this many buffers; pages are allocated as they are written. Call it
 * before libmicrohttpd starts. A second call keeps the first reservation; more buffers than that
 * come from the system directly. Returns false if there is no address space. */
bool srv_buffers_reserve(size_t most);

/* Returns the buffer that this thread took last, or SRV_NO_BUFFER if it took none since the last
 * call. libmicrohttpd takes the buffer of a connection right before it reports the connection. */
uint32_t srv_buffer_taken(void);

/* Declares the connection of a buffer idle; srv_buffer_use declares that it has begun a request.
 * Must be called by the worker that took the buffer, with the microseconds of the monotonic clock.
 * SRV_NO_BUFFER does nothing. */
void srv_buffer_rest(uint32_t buffer, uint64_t now);
void srv_buffer_use(uint32_t buffer);

#endif
