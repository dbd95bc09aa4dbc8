#include "tests/pace.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdlib.h>
#include <time.h>

#include <cmocka.h>

enum { STEPS = 1 << 20, WORDS = 1 << 18, TIMES_A_TENTH = 50 };

static const double NEVER_SLOW = 0.05;

double pace_seconds(void)
{
    struct timespec t;
    assert_int_equal(clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t), 0);
    return (double)t.tv_sec + (double)t.tv_nsec * 1e-9;
}

double pace_unit(void)
{
    uint32_t *words = malloc(WORDS * sizeof *words);
    assert_non_null(words);
    double start = pace_seconds();
    for (uint32_t i = 0; i < WORDS; i++) {
        words[i] = i * 2654435761U;
    }
    /* Each read depends on the previous one and the sum is used, so that the compiler cannot remove
     * the reads. */
    uint32_t at = 0;
    for (uint32_t i = 0; i < STEPS; i++) {
        at = (words[at % WORDS] ^ at) * 1664525U + i;
    }
    words[0] = at;
    double took = pace_seconds() - start;
    volatile uint32_t used = words[0];
    (void)used;
    free(words);
    return took;
}

void pace_require_linear(const char *what, double (*work)(const void *context, size_t size),
                         const void *context, size_t size)
{
    double tenth = 0, whole = 0;
    for (int tries = 0; tries < PACE_TRIES; tries++) {
        tenth = work(context, size / 10);
        whole = work(context, size);
        if (whole < NEVER_SLOW || whole < TIMES_A_TENTH * tenth) {
            return;
        }
    }
    fail_msg("%s: %.3f s for %zu, %.3f s for a tenth of that", what, whole, size, tenth);
}
