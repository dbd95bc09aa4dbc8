/* failing_memory.h - an allocator of which one request fails, in whatever thread it is made. */
#ifndef TESTS_FAILING_MEMORY_H
#define TESTS_FAILING_MEMORY_H

/* Install the allocator, of which no request fails yet, and take it out again. No other thread may
 * allocate meanwhile. */
void failing_memory_begin(void);
void failing_memory_end(void);

/* The n-th request from now on fails; 0: none. */
void failing_memory_at(long n);
/* Return this n, and the number of requests since then. */
long failing_memory_chosen(void);
long failing_memory_calls(void);

#endif
