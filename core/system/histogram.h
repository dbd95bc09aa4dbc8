/* histogram.h - histograms that threads add to without a lock.
 *
 * All histograms have the same number of buckets: for each bound of its scale, a bucket counts the
 * values up to this bound and above the bound before; one more bucket counts the values above the
 * last bound. Threads add at any time; a copy of a histogram has all values that were added before
 * the copying began, and may have or lack values that are added during the copying. */
#ifndef HE_SYSTEM_HISTOGRAM_H
#define HE_SYSTEM_HISTOGRAM_H

#include <stdatomic.h>
#include <stddef.h>
#include <stdint.h>

enum { ST_BOUNDS = 14, ST_BUCKETS = ST_BOUNDS + 1 };

/* A scale of a histogram has ST_BOUNDS numbers in rising order, the upper bounds of its buckets. */
/* The scale for times: 100 microseconds to 300 seconds. */
extern const uint64_t st_scale_micros[ST_BOUNDS];
/* the scale for counts of things: 1 to 8192, each bound twice the one before */
extern const uint64_t st_scale_counts[ST_BOUNDS];

/* Returns the bucket of a value, 0 to ST_BOUNDS. */
static inline size_t st_bucket_of(const uint64_t scale[ST_BOUNDS], uint64_t value)
{
    size_t bucket = 0;
    while (bucket < ST_BOUNDS && value > scale[bucket]) {
        bucket++;
    }
    return bucket;
}

/* A histogram. Zeroed memory is an empty histogram. */
typedef struct st_histogram {
    _Atomic uint64_t buckets[ST_BUCKETS];
    _Atomic uint64_t sum; /* sum of the values */
} st_histogram;

void st_histogram_add(st_histogram *histogram, const uint64_t scale[ST_BOUNDS], uint64_t value);

/* A copy of a histogram as plain numbers, not changed by other threads. */
typedef struct st_distribution {
    uint64_t buckets[ST_BUCKETS];
    uint64_t sum;
} st_distribution;

void st_histogram_copy(const st_histogram *histogram, st_distribution *out);

#endif
