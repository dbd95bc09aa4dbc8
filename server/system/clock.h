/* clock.h - the two times of day. */
#ifndef HE_SERVER_SYSTEM_CLOCK_H
#define HE_SERVER_SYSTEM_CLOCK_H

#include <pthread.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

double srv_clock_utc(void);      /* seconds since 1970 */
uint64_t srv_clock_micros(void); /* monotonic microseconds, for durations and deadlines */

/* A condition for srv_clock_wait. */
void srv_clock_condition(pthread_cond_t *condition);
/* Wait with `lock` held until somebody wakes the condition, or nobody in particular. False when
 * srv_clock_micros has come to `until`. */
bool srv_clock_wait(pthread_cond_t *condition, pthread_mutex_t *lock, uint64_t until);

enum { SRV_TIMESTAMP = 32 };
/* "2024-05-01T12:00:00.123Z" */
void srv_clock_format(double utc, char out[SRV_TIMESTAMP]);

#endif
