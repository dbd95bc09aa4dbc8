/* clock.h - the two times of day. */
#ifndef HE_SYSTEM_CLOCK_H
#define HE_SYSTEM_CLOCK_H

#include <pthread.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

double st_clock_utc(void);      /* seconds since 1970 */
uint64_t st_clock_micros(void); /* monotonic microseconds, for durations and deadlines */

/* A condition for st_clock_wait. */
void st_clock_condition(pthread_cond_t *condition);
/* Wait with `lock` held until somebody wakes the condition, or nobody in particular. False when
 * st_clock_micros has come to `until`. */
bool st_clock_wait(pthread_cond_t *condition, pthread_mutex_t *lock, uint64_t until);

enum { ST_TIMESTAMP = 32 };
/* "2024-05-01T12:00:00.123Z" */
void st_clock_format(double utc, char out[ST_TIMESTAMP]);

#endif
