#include "system/resident.h"

#include "system/clock.h"
#include "system/memory.h"

#include <fcntl.h>
#include <malloc.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { MEASURE_MICROS = 100 * 1000 };

/* The resident memory is too near to the memory budget when less than 1/NEAR_SHARE of the budget is
 * left. It is reported again only after the resident memory has grown by 1/GROWTH_SHARE of the
 * budget. The reason: resident memory does not fall at once when meshes are evicted (removed from
 * memory), so otherwise each call would evict more meshes until none is left. */
enum { NEAR_SHARE = 32, GROWTH_SHARE = 192 };

static bool watched;
static _Atomic uint64_t beside;
static _Atomic uint64_t measured; /* time at which `beside` was last measured */
static _Atomic uint64_t told;     /* resident bytes when st_resident_is_beyond last returned true */

/* Returns the resident bytes of the process; 0 if they cannot be read. */
static uint64_t resident(void)
{
    char text[64];
    const int fd = open("/proc/self/statm", O_RDONLY | O_CLOEXEC);
    if (fd < 0) {
        return 0;
    }
    const ssize_t length = read(fd, text, sizeof text - 1);
    close(fd);
    text[length < 0 ? 0 : length] = '\0';
    /* The file contains the number of pages of the address space, then the number of resident
     * pages. */
    const char *second = strchr(text, ' ');
    return second == NULL ? 0 : strtoull(second, NULL, 10) * (uint64_t)sysconf(_SC_PAGESIZE);
}

static void measure(void)
{
    const uint64_t used = st_memory_used(), all = resident();
    atomic_store(&beside, all > used ? all - used : 0);
}

void st_resident_watch(void)
{
    watched = true;
    measure();
}

uint64_t st_resident_beside(void)
{
    const uint64_t bytes = atomic_load_explicit(&beside, memory_order_relaxed);
    const uint64_t half = st_memory_budget() / 2;
    return bytes < half ? bytes : half;
}

void st_resident_measure(void)
{
    const uint64_t now = st_clock_micros();
    uint64_t last = atomic_load(&measured);
    if (watched && now - last >= MEASURE_MICROS &&
        atomic_compare_exchange_strong(&measured, &last, now)) {
        malloc_trim(0);
        measure();
    }
}

bool st_resident_is_beyond(void)
{
    const uint64_t budget = st_memory_budget();
    const uint64_t all = watched && budget > 0 ? resident() : 0;
    if (all <= budget - budget / NEAR_SHARE) {
        atomic_store(&told, 0);
        return false;
    }
    const uint64_t before = atomic_load(&told);
    const bool grew = before == 0 || all > before + budget / GROWTH_SHARE;
    if (grew) {
        atomic_store(&told, all);
    }
    return grew;
}
