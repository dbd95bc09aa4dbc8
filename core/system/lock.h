/* lock.h - locks, with the time that is spent on waiting for them.
 *
 * Each thread has a sum of its own, so that who works for a request can tell how much of the time
 * was not work. A lock that is free costs no look at the clock. */
#ifndef HE_SYSTEM_LOCK_H
#define HE_SYSTEM_LOCK_H

#include <pthread.h>
#include <stdint.h>

void st_lock_read(pthread_rwlock_t *lock);
void st_lock_write(pthread_rwlock_t *lock);
void st_lock_mutex(pthread_mutex_t *lock);

/* Counts another kind of wait for other requests, which began at `since` of st_clock_micros. */
void st_lock_count(uint64_t since);
/* Microseconds that the calling thread has waited in these functions since it began. */
uint64_t st_lock_waited(void);

#endif
