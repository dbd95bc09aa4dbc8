#include "tests/failing_memory.h"

#include "base/mem.h"

#include <stdatomic.h>
#include <stdlib.h>

static _Atomic long calls, fails_at;

static void *failing_resize(void *context, void *memory, size_t size)
{
    (void)context;
    if (size == 0) {
        free(memory);
        return NULL;
    }
    return atomic_fetch_add(&calls, 1) + 1 == atomic_load(&fails_at) ? NULL : realloc(memory, size);
}

void failing_memory_begin(void)
{
    static const he_mem_hook hook = {failing_resize, NULL};
    failing_memory_at(0);
    he_mem_set_hook(&hook);
}

void failing_memory_end(void)
{
    he_mem_set_hook(NULL);
}

void failing_memory_at(long n)
{
    atomic_store(&calls, 0);
    atomic_store(&fails_at, n);
}

long failing_memory_chosen(void)
{
    return atomic_load(&fails_at);
}

long failing_memory_calls(void)
{
    return atomic_load(&calls);
}
