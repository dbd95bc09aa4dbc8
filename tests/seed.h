/* seed.h - settings of random tests in the environment: their seed, and numbers such as ROUNDS. */
#ifndef TESTS_SEED_H
#define TESTS_SEED_H

#include <stdint.h>

/* Returns the seed in the environment variable SEED, or else one from the clock. Prints the seed,
 * so that a failed run can be repeated. */
uint64_t seed_of_run(void);
/* Returns the number in an environment variable, or `fallback` if it is absent or empty. */
uint64_t seed_setting(const char *name, uint64_t fallback);

#endif
