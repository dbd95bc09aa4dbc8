/* lock.h - locks that measure how long a thread waits for them.
 *
 * Each thread has its own sum of its waiting times, so that a thread can tell how much of a
 * request's time was spent waiting. Taking a lock that is free does not read the clock. */
#ifndef HE_SYSTEM_LOCK_H
#define HE_SYSTEM_LOCK_H

#include <pthread.h>
#include <stdint.h>

void st_lock_read(pthread_rwlock_t *lock);
void st_lock_write(pthread_rwlock_t *lock);
void st_lock_mutex(pthread_mutex_t *lock);

/* Adds to the calling thread's sum of waiting times a wait for other requests that was no wait for
 * a lock. The wait began at `since` (st_clock_micros) and ends now. */
void st_lock_count(uint64_t since);
/* Returns how many microseconds the calling thread has waited for locks, or in waits that
 * st_lock_count added, since the thread began. */
uint64_t st_lock_waited(void);

#endif
