/* seed.h - the seed of random tests. */
#ifndef TESTS_SEED_H
#define TESTS_SEED_H

#include <stdint.h>

/* Returns the seed in the environment variable SEED, or else one from the clock; prints it, so that
 * a failed run can be repeated. */
uint64_t seed_of_run(void);

#endif
