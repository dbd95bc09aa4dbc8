/* clock.h - the wall clock and the monotonic clock. */
#ifndef HE_SYSTEM_CLOCK_H
#define HE_SYSTEM_CLOCK_H

#include <pthread.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

double st_clock_utc(void); /* seconds since 1970 */
/* Returns the time of the monotonic clock in microseconds, for durations and deadlines. */
uint64_t st_clock_micros(void);

/* Initialises a condition for st_clock_wait. */
void st_clock_condition(pthread_cond_t *condition);
/* Waits, with `lock` held, until the condition is signalled; may return early (spurious wake-up).
 * Returns false when st_clock_micros has reached `until`. */
bool st_clock_wait(pthread_cond_t *condition, pthread_mutex_t *lock, uint64_t until);

enum { ST_TIMESTAMP = 32 };
/* Writes a time such as "2024-05-01T12:00:00.123Z". */
void st_clock_format(double utc, char out[ST_TIMESTAMP]);

#endif
