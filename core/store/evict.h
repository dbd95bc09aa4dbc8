/* evict.h - meshes that nobody uses leave memory while it is short, and come back from the journal
 * when they are asked for. */
#ifndef HE_STORE_EVICT_H
#define HE_STORE_EVICT_H

#include "store/store.h"

/* Sees to it that `bytes` more and a sixteenth of the memory budget are free, as far as that can
 * be had: frees what is only kept for later, then meshes, the least recently used first. Without a
 * lock. */
void st_make_room(st_store *store, uint64_t bytes);

#endif
