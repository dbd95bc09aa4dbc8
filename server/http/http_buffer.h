/* http_buffer.h - counts the memory that libmicrohttpd keeps for each connection, and returns it to
 * the system while the connection is idle.
 *
 * libmicrohttpd allocates SRV_BUFFER_BYTES with mmap() for each connection, zeroes all of it after
 * each request and keeps it until the connection ends: ten thousand idle clients that once sent a
 * request would occupy 350 MB. It has no option to return this memory earlier. So this module
 * defines mmap(), munmap() and epoll_wait() for the whole program. The dynamic linker binds
 * libmicrohttpd's calls to these definitions, as it does for a replaced malloc().
 *
 *   B1  An mmap() of exactly SRV_BUFFER_BYTES, rounded up to pages, takes a buffer from a reserved
 *       range, and munmap() of a buffer puts it back; both save the system call. All other calls go
 *       to the system unchanged.
 *   B2  A worker thread that is about to wait in epoll_wait() returns the pages of those
 *       connections of its own that have been idle for a second (at once when memory is full). It
 *       does this for a few connections each time, so that its clients need not wait. It is the
 *       only thread that reads and writes these pages.
 *   B3  Only pages that are all zeros are returned. When libmicrohttpd uses such a page again, the
 *       system provides a page of zeros, so that the library cannot notice.
 *   B4  st_memory_count counts what a buffer occupies: during a request all of it, and while the
 *       connection is idle the pages that were not returned. */
#ifndef HE_SERVER_HTTP_HTTP_BUFFER_H
#define HE_SERVER_HTTP_HTTP_BUFFER_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* The size of a buffer. It is enough for the largest head that http_syntax.h lets through and the
 * head of the answer. It must be above 32 KiB, because up to that size libmicrohttpd uses malloc().
 * It is not larger, because libmicrohttpd zeroes the buffer after each request: 64 buffers of 128
 * KiB would not fit into the processor's cache, which costs more than half of the throughput. */
enum { SRV_BUFFER_BYTES = 36 * 1024 };

enum { SRV_NO_BUFFER = UINT32_MAX };

/* Reserves address space for this many buffers; pages are allocated when they are written. Must be
 * called before libmicrohttpd starts. A second call does nothing; if more buffers are needed than
 * were reserved, the system provides them. Returns false if there is no address space. */
bool srv_buffers_reserve(size_t most);

/* Returns the number of the buffer that this thread took last, or SRV_NO_BUFFER if it took none
 * since the last call. The buffer belongs to the connection that libmicrohttpd reports next. */
uint32_t srv_buffer_taken(void);

/* srv_buffer_rest records that the connection of a buffer has become idle at `now`, in microseconds
 * of the monotonic clock; srv_buffer_use records that it has begun a request. Both must be called
 * by the worker thread that took the buffer, and do nothing for SRV_NO_BUFFER. */
void srv_buffer_rest(uint32_t buffer, uint64_t now);
void srv_buffer_use(uint32_t buffer);

#endif
