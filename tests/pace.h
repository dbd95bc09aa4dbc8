/* pace.h - bounds on time that hold on every machine, however slow, busy or instrumented: work is
 * compared with other work of the same run, by processor time in seconds. Time in which a virtual
 * processor was descheduled counts, too, so work is slow only if every attempt is.
 */
#ifndef TESTS_PACE_H
#define TESTS_PACE_H

#include <stddef.h>

/* Attempts before work counts as slow. */
enum { PACE_TRIES = 3 };

/* Returns the processor time of this process so far. */
double pace_seconds(void);
/* Returns the time of a fixed piece of work here and now: some milliseconds of arithmetic and of
 * random reads in a megabyte, compiled like the tests. */
double pace_unit(void);

/* Fails the test if `work` grows more like a square than linearly: if `size` items take over 50
 * times as long as a tenth of them. `work` gets `context` and returns the time of its relevant
 * part. Less than a twentieth of a second is never slow. */
void pace_require_linear(const char *what, double (*work)(const void *context, size_t size),
                         const void *context, size_t size);

#endif
