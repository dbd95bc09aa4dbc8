/* seed.h - the seed of random tests. */
#ifndef TESTS_SEED_H
#define TESTS_SEED_H

#include <stdint.h>

/* Returns SEED of the environment, else a seed from the clock, and prints it, so that a failed run
 * can be repeated.
 */
uint64_t seed_of_run(void);

#endif
