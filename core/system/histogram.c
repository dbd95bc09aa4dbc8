#include "system/histogram.h"

const uint64_t st_scale_micros[ST_BOUNDS] = {100,      300,      1000,      3000,     10000,
                                             30000,    100000,   300000,    1000000,  3000000,
                                             10000000, 30000000, 100000000, 300000000};
const uint64_t st_scale_counts[ST_BOUNDS] = {1,   2,   4,   8,    16,   32,   64,
                                             128, 256, 512, 1024, 2048, 4096, 8192};

void st_histogram_add(st_histogram *histogram, const uint64_t scale[ST_BOUNDS], uint64_t value)
{
    _Atomic uint64_t *bucket = &histogram->buckets[st_bucket_of(scale, value)];
    atomic_fetch_add_explicit(bucket, 1, memory_order_relaxed);
    atomic_fetch_add_explicit(&histogram->sum, value, memory_order_relaxed);
}

void st_histogram_copy(const st_histogram *histogram, st_distribution *out)
{
    for (size_t i = 0; i < ST_BUCKETS; i++) {
        out->buckets[i] = atomic_load_explicit(&histogram->buckets[i], memory_order_relaxed);
    }
    out->sum = atomic_load_explicit(&histogram->sum, memory_order_relaxed);
}
