#include "system/clock.h"

#include <time.h>

double st_clock_utc(void)
{
    struct timespec now;
    clock_gettime(CLOCK_REALTIME, &now);
    return (double)now.tv_sec + (double)now.tv_nsec / 1e9;
}

uint64_t st_clock_micros(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (uint64_t)now.tv_sec * 1000000U + (uint64_t)now.tv_nsec / 1000U;
}

void st_clock_condition(pthread_cond_t *condition)
{
    pthread_condattr_t attributes;
    pthread_condattr_init(&attributes);
    pthread_condattr_setclock(&attributes, CLOCK_MONOTONIC);
    pthread_cond_init(condition, &attributes);
    pthread_condattr_destroy(&attributes);
}

bool st_clock_wait(pthread_cond_t *condition, pthread_mutex_t *lock, uint64_t until)
{
    const struct timespec at = {.tv_sec = (time_t)(until / 1000000U),
                                .tv_nsec = (long)(until % 1000000U) * 1000};
    return pthread_cond_timedwait(condition, lock, &at) == 0;
}

static char *put_digits(char *at, int value, int digits)
{
    for (int i = digits - 1; i >= 0; i--, value /= 10) {
        at[i] = (char)('0' + value % 10);
    }
    return at + digits;
}

/* Formats a time without the functions of the C library, which would take as long as writing the
 * rest of a line of the access log. */
void st_clock_format(double utc, char out[ST_TIMESTAMP])
{
    time_t seconds = (time_t)utc;
    int millis = (int)((utc - (double)seconds) * 1000);
    struct tm parts;
    if (gmtime_r(&seconds, &parts) == NULL || parts.tm_year < -1900 || parts.tm_year > 8099) {
        parts = (struct tm){.tm_year = 70, .tm_mday = 1};
    }
    char *at = put_digits(out, parts.tm_year + 1900, 4);
    *at++ = '-';
    at = put_digits(at, parts.tm_mon + 1, 2);
    *at++ = '-';
    at = put_digits(at, parts.tm_mday, 2);
    *at++ = 'T';
    at = put_digits(at, parts.tm_hour, 2);
    *at++ = ':';
    at = put_digits(at, parts.tm_min, 2);
    *at++ = ':';
    at = put_digits(at, parts.tm_sec, 2);
    *at++ = '.';
    at = put_digits(at, millis < 0 ? 0 : millis, 3);
    *at++ = 'Z';
    *at = '\0';
}
