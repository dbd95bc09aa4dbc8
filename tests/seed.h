/* seed.h - where random tests begin. */
#ifndef TESTS_SEED_H
#define TESTS_SEED_H

#include <stdint.h>

/* SEED of the environment, else one of the clock's; printed, so that a failed run can be had again.
 */
uint64_t seed_of_run(void);

#endif
