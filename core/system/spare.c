#include "system/spare.h"

#include "base/mem.h"
#include "system/memory.h"

#include <stdbool.h>

/* AddressSanitizer finds a use of a freed block only if the block is really freed. */
#if defined(__SANITIZE_ADDRESS__)
static const bool keeps = false;
#else
static const bool keeps = true;
#endif

void *st_spares_take(st_spares *spares, size_t size)
{
    for (int i = 0; i < ST_SPARES; i++) {
        /* The load is cheaper than the exchange, which finds an empty place as well. */
        if (atomic_load_explicit(&spares->blocks[i], memory_order_relaxed) != NULL) {
            void *block = atomic_exchange_explicit(&spares->blocks[i], NULL, memory_order_acquire);
            if (block != NULL) {
                return block;
            }
        }
    }
    return he_mem_alloc(size);
}

void st_spares_put(st_spares *spares, void *block)
{
    for (int i = 0; keeps && i < ST_SPARES && !st_memory_is_full(); i++) {
        void *none = NULL;
        if (atomic_load_explicit(&spares->blocks[i], memory_order_relaxed) == NULL &&
            atomic_compare_exchange_strong_explicit(&spares->blocks[i], &none, block,
                                                    memory_order_release, memory_order_relaxed)) {
            return;
        }
    }
    he_mem_free(block);
}

void st_spares_clear(st_spares *spares)
{
    for (int i = 0; i < ST_SPARES; i++) {
        he_mem_free(atomic_exchange(&spares->blocks[i], NULL));
    }
}
