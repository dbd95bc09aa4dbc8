/* counters.h - a table of counters that many threads add to and one thread sums up now and then.
 *
 * There are several copies of the table. Each thread adds to one copy, which few or no other
 * threads use, so that threads on different cores seldom write to one cache line; a sum adds up the
 * copies. No lock is taken, and adding allocates nothing. A sum is never lower than an earlier
 * one. */
#ifndef HE_SYSTEM_COUNTERS_H
#define HE_SYSTEM_COUNTERS_H

#include <stddef.h>
#include <stdint.h>

typedef struct st_counters st_counters;

/* Makes `count` counters at zero. Returns NULL if memory is out. */
st_counters *st_counters_new(size_t count);
void st_counters_free(st_counters *counters); /* takes NULL */

/* Adds `amount` to counter `at`, which must be below the number of counters. */
void st_counters_add(st_counters *counters, size_t at, uint64_t amount);
/* Adds 1 to counter `at`, and `amount` to counter `other`. */
void st_counters_add_pair(st_counters *counters, size_t at, size_t other, uint64_t amount);
uint64_t st_counters_sum(const st_counters *counters, size_t at);

#endif
