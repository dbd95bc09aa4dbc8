#include "system/counters.h"

#include "base/mem.h"

#include <assert.h>
#include <stdatomic.h>
#include <unistd.h>

/* The largest number of copies of a table of counters. More copies would take memory and save
 * little time: there are about as many counting threads as cores, and a cache line that two threads
 * share is still fast enough. */
enum { MOST_COPIES = 8, LINE = 64 / sizeof(uint64_t) };

struct st_counters {
    size_t count;  /* number of counters in each copy */
    size_t stride; /* distance between two copies in `values`, in words */
    size_t copies; /* number of copies, a power of two */
    _Atomic uint64_t values[];
};

/* The number of threads that have counted so far. Each thread gets a number when it counts for the
 * first time. */
static _Atomic size_t threads;
/* the number of the calling thread, from 1; 0: it has no number yet */
static _Thread_local size_t own_number;

static size_t number(void)
{
    if (own_number == 0) {
        own_number = atomic_fetch_add_explicit(&threads, 1, memory_order_relaxed) + 1;
    }
    return own_number;
}

st_counters *st_counters_new(size_t count)
{
    const long cores = sysconf(_SC_NPROCESSORS_ONLN);
    size_t copies = 1;
    while (copies < MOST_COPIES && (long)copies < cores) {
        copies *= 2;
    }
    const size_t stride = (count + LINE - 1) / LINE * LINE;
    st_counters *counters =
        he_mem_zero(1, sizeof *counters + copies * stride * sizeof counters->values[0]);
    if (counters != NULL) {
        counters->count = count;
        counters->stride = stride;
        counters->copies = copies;
    }
    return counters;
}

void st_counters_free(st_counters *counters)
{
    he_mem_free(counters);
}

static _Atomic uint64_t *own_copy(st_counters *counters)
{
    return counters->values + (number() & (counters->copies - 1)) * counters->stride;
}

void st_counters_add(st_counters *counters, size_t at, uint64_t amount)
{
    assert(at < counters->count);
    atomic_fetch_add_explicit(own_copy(counters) + at, amount, memory_order_relaxed);
}

void st_counters_add_pair(st_counters *counters, size_t at, size_t other, uint64_t amount)
{
    _Atomic uint64_t *copy = own_copy(counters);
    assert(at < counters->count && other < counters->count);
    atomic_fetch_add_explicit(copy + at, 1, memory_order_relaxed);
    atomic_fetch_add_explicit(copy + other, amount, memory_order_relaxed);
}

uint64_t st_counters_sum(const st_counters *counters, size_t at)
{
    uint64_t sum = 0;
    assert(at < counters->count);
    for (size_t i = 0; i < counters->copies; i++) {
        sum += atomic_load_explicit(&counters->values[i * counters->stride + at],
                                    memory_order_relaxed);
    }
    return sum;
}
