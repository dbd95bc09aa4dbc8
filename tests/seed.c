#include "tests/seed.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

uint64_t seed_of_run(void)
{
    const char *given = getenv("SEED");
    struct timespec now;
    (void)clock_gettime(CLOCK_REALTIME, &now);
    uint64_t seed = given != NULL ? strtoull(given, NULL, 10)
                                  : (uint64_t)now.tv_sec * 1000003u + (uint64_t)now.tv_nsec;
    printf("note: SEED=%" PRIu64 "\n", seed);
    (void)fflush(stdout); /* a test that hangs is ended, and then nothing else would write it */
    return seed;
}

uint64_t seed_setting(const char *name, uint64_t fallback)
{
    const char *text = getenv(name);
    return text != NULL && text[0] != '\0' ? strtoull(text, NULL, 10) : fallback;
}
