/* pace.h - limits on time that hold on every machine, however slow, busy or instrumented: work is
 * compared with other work of the same run, by processor time in seconds. This time includes pauses
 * in which a virtual machine's processor was descheduled, so work counts as slow only if every
 * attempt was slow. */
#ifndef TESTS_PACE_H
#define TESTS_PACE_H

#include <stddef.h>

/* The number of attempts before work counts as slow. */
enum { PACE_TRIES = 3 };

/* Returns the processor time that this process has used so far. */
double pace_seconds(void);
/* Returns the time that a fixed piece of work takes at present on this machine: some milliseconds
 * of arithmetic and of random reads in a megabyte, compiled like the tests. */
double pace_unit(void);

/* Fails the test if the time of `work` grows more like a square than linearly: if `size` items take
 * over 50 times as long as a tenth of them. `work` gets `context` and returns the time of its
 * relevant part. A time of less than a twentieth of a second is never slow. */
void pace_require_linear(const char *what, double (*work)(const void *context, size_t size),
                         const void *context, size_t size);

#endif
