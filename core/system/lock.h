/* lock.h - locks that measure how long a thread waits for them.
 *
 * Each thread has its own sum of these times, so that a thread can tell how much of a request's
 * time was spent waiting. Taking a lock that is free does not read the clock. */
#ifndef HE_SYSTEM_LOCK_H
#define HE_SYSTEM_LOCK_H

#include <pthread.h>
#include <stdint.h>

void st_lock_read(pthread_rwlock_t *lock);
void st_lock_write(pthread_rwlock_t *lock);
void st_lock_mutex(pthread_mutex_t *lock);

/* Adds another wait to the calling thread's sum: one for other requests, but not for a lock. It
 * began at `since` (st_clock_micros) and ends now. */
void st_lock_count(uint64_t since);
/* Returns the microseconds that the calling thread has waited in these functions since it began. */
uint64_t st_lock_waited(void);

#endif
