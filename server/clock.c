#include "server/clock.h"

#include <stdio.h>
#include <time.h>

double srv_clock_utc(void)
{
    struct timespec now;
    clock_gettime(CLOCK_REALTIME, &now);
    return (double)now.tv_sec + (double)now.tv_nsec / 1e9;
}

uint64_t srv_clock_micros(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (uint64_t)now.tv_sec * 1000000U + (uint64_t)now.tv_nsec / 1000U;
}

void srv_clock_format(double utc, char out[SRV_TIMESTAMP])
{
    time_t seconds = (time_t)utc;
    int millis = (int)((utc - (double)seconds) * 1000);
    struct tm parts;
    if (gmtime_r(&seconds, &parts) == NULL) {
        parts = (struct tm){.tm_year = 70, .tm_mday = 1};
    }
    char date[SRV_TIMESTAMP - 8];
    strftime(date, sizeof date, "%Y-%m-%dT%H:%M:%S", &parts);
    snprintf(out, SRV_TIMESTAMP, "%s.%03dZ", date, millis);
}
