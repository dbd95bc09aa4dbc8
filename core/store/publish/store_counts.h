/* store_counts.h - the counters of a store, for monitoring (st_store_measure).
 *
 * Counters are updated without a lock. The memory of all meshes is a sum that is computed without
 * visiting the meshes: each mesh remembers the size that it has in the sum; when its size changes
 * (st_mesh_weigh) the difference is added, and when it is freed its size is subtracted. */
#ifndef HE_STORE_STORE_COUNTS_H
#define HE_STORE_STORE_COUNTS_H

#include "store/publish/broadcast_queue.h"
#include "system/histogram.h"

#include <stdatomic.h>

/* The outcome of loading a mesh from the disk. */
typedef enum st_loaded {
    ST_LOADED_WHOLE,
    ST_LOADED_NOTHING, /* no mesh with the id exists */
    ST_LOADED_DAMAGED, /* it cannot be read */
    ST_LOADED_FAILED,  /* the mesh could not be loaded: memory was out, or the disk failed */
    ST_LOADED_COUNT
} st_loaded;

/* The purposes for which a mesh uses memory, which are counted separately. */
typedef enum st_weight {
    ST_WEIGHT_MESHES, /* not bytes, but the number of meshes: 1 for each mesh in memory */
    ST_WEIGHT_VERTICES,
    ST_WEIGHT_EDGES,
    ST_WEIGHT_FACES,
    ST_WEIGHT_CONTENT, /* bytes of the mesh itself */
    ST_WEIGHT_HISTORY, /* bytes of entries and deltas */
    ST_WEIGHT_COUNT
} st_weight;

typedef struct st_store_counts {
    _Atomic uint64_t weights[ST_WEIGHT_COUNT];
    _Atomic uint64_t copies;    /* bytes of cached copies of meshes */
    _Atomic uint64_t revisions; /* revisions made */
    /* number of meshes that were evicted: removed from memory to free it */
    _Atomic uint64_t evicted;
    _Atomic uint64_t loads[ST_LOADED_COUNT];
    st_histogram load_time; /* how many microseconds the loads that found a mesh took */
    st_queue_counts queues; /* the counts that the message queues of all meshes share */
} st_store_counts;

static inline void st_count(_Atomic uint64_t *counter, uint64_t amount)
{
    atomic_fetch_add_explicit(counter, amount, memory_order_relaxed);
}

static inline uint64_t st_counted(const _Atomic uint64_t *counter)
{
    return atomic_load_explicit(counter, memory_order_relaxed);
}

#endif
