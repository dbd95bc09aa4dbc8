/* clock.h - the two times of day. */
#ifndef HE_SERVER_CLOCK_H
#define HE_SERVER_CLOCK_H

#include <pthread.h>
#include <stddef.h>
#include <stdint.h>

double srv_clock_utc(void);      /* seconds since 1970 */
uint64_t srv_clock_micros(void); /* monotonic microseconds, for durations and deadlines */

/* pthread_cond_timedwait by CLOCK_MONOTONIC. */
void srv_clock_condition(pthread_cond_t *condition);

enum { SRV_TIMESTAMP = 32 };
/* "2024-05-01T12:00:00.123Z" */
void srv_clock_format(double utc, char out[SRV_TIMESTAMP]);

#endif
