/* http_buffer.h - the memory libmicrohttpd keeps for each connection: counted, and given back while
 * the connection is idle.
 *
 * libmicrohttpd takes SRV_BUFFER_BYTES from mmap() for each connection, zeroes all of it after each
 * request and keeps it until the connection ends: ten thousand clients who once asked something
 * would hold 350 MB. It has no option for that. So this module defines mmap(), munmap() and
 * epoll_wait() for the whole program, to which the dynamic linker binds libmicrohttpd's calls, as
 * it does with an allocator of one's own.
 *
 *   B1  mmap() of exactly that size by libmicrohttpd's workers takes a buffer from one reserved
 *       range, and munmap() of a buffer puts it back; both save the system call. All other calls
 *       are the system's unchanged.
 *   B2  A worker that is about to wait in epoll_wait() gives back the pages of its connections that
 *       have been idle for a second; at once when memory is full; a few each time, so that nobody
 *       waits for it. It is the one thread that reads and writes these pages.
 *   B3  Only pages that are all zeros are given back: the system puts zeros in their place, so that
 *       the library cannot tell, whatever it keeps there.
 *   B4  What a buffer holds is counted by st_memory_count: all of it from the beginning of a
 *       request, and what was not given back while idle. */
#ifndef HE_SERVER_HTTP_HTTP_BUFFER_H
#define HE_SERVER_HTTP_HTTP_BUFFER_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Holds all that http_syntax.h lets through of a head, and the head of its answer; and is above 32
 * KiB, to which libmicrohttpd uses malloc(). No larger: it zeroes all of it after each request, and
 * with 64 connections of 128 KiB that leaves the cache and costs more than half of the throughput.
 */
enum { SRV_BUFFER_BYTES = 36 * 1024 };

enum { SRV_NO_BUFFER = UINT32_MAX };

/* Reserve address space for so many buffers; their pages come as they are written. Before
 * libmicrohttpd starts; a second time keeps what there is, beyond which the system is asked as
 * without this module. False when there is no room. */
bool srv_buffers_reserve(size_t most);

/* The one this thread took last, SRV_NO_BUFFER when it took none since the last call: libmicrohttpd
 * takes a connection's buffer right before it tells of the connection. */
uint32_t srv_buffer_taken(void);

/* Its connection waits for a request, or has begun one. For the worker that took it, with the
 * microseconds of the monotonic clock. SRV_NO_BUFFER does nothing. */
void srv_buffer_rest(uint32_t buffer, uint64_t now);
void srv_buffer_use(uint32_t buffer);

#endif
