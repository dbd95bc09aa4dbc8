/* pace.h - limits on time that hold on every machine, however slow, busy or instrumented: the
 * processor time of work is compared with that of other work in the same run. The kernel counts
 * pauses of a virtual machine as processor time, so a test fails only if every attempt was slow. */
#ifndef TESTS_PACE_H
#define TESTS_PACE_H

#include <stddef.h>

/* The number of attempts that must all be slow before work counts as slow. */
enum { PACE_TRIES = 3 };

/* Returns the processor time in seconds that this process has used so far. */
double pace_seconds(void);
/* Returns the seconds that a fixed piece of work takes now on this machine: some milliseconds of
 * arithmetic and of random reads in a megabyte, compiled like the tests. */
double pace_unit(void);

/* Fails the test if the time of `work` grows like the square of its size: if `size` items take more
 * than 50 times as long as a tenth of them. `work` is called with `context` and a number of items,
 * and returns its time in seconds. A time of less than a twentieth of a second is never too
 * long. */
void pace_require_linear(const char *what, double (*work)(const void *context, size_t size),
                         const void *context, size_t size);

#endif
