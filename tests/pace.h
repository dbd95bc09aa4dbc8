/* pace.h - bounds on time that hold on every machine, however slow, busy or instrumented: work is
 * compared with other work of the same run. Processor time is measured, in seconds. A virtual
 * processor that was away for a while counts as well, so that only what is slow each time is slow.
 */
#ifndef TESTS_PACE_H
#define TESTS_PACE_H

#include <stddef.h>

/* The times that work is tried before it counts as slow. */
enum { PACE_TRIES = 3 };

/* What this process has used so far. */
double pace_seconds(void);
/* What a fixed piece of work takes here and at this moment: some milliseconds of arithmetic and of
 * reads all over a megabyte, compiled as the tests are. */
double pace_unit(void);

/* Fails the test if `work` is closer to quadratic than to linear: if for `size` things it takes
 * over 50 times as long as for a tenth of them. `work` is given `context`, and returns what the
 * part of it took that matters. What takes less than a twentieth of a second is never slow. */
void pace_require_linear(const char *what, double (*work)(const void *context, size_t size),
                         const void *context, size_t size);

#endif
