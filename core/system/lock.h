/* lock.h - locks that measure how long a thread waits for them.
 *
 * Each thread has a sum of its own, so that a thread working for a request can tell how much of the
 * time was spent waiting. Taking a lock that is free does not read the clock. */
#ifndef HE_SYSTEM_LOCK_H
#define HE_SYSTEM_LOCK_H

#include <pthread.h>
#include <stdint.h>

void st_lock_read(pthread_rwlock_t *lock);
void st_lock_write(pthread_rwlock_t *lock);
void st_lock_mutex(pthread_mutex_t *lock);

/* Counts a wait for other requests that is not for a lock. It began at `since` by
 * st_clock_micros. */
void st_lock_count(uint64_t since);
/* Returns the microseconds that the calling thread has waited in these functions since it began. */
uint64_t st_lock_waited(void);

#endif
