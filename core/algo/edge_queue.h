/* edge_queue.h - an inline priority queue of edges, the least priority first.
 *
 * A bucket holds the edges whose priorities agree in exponent and two binary digits: edges whose
 * priorities differ by less than a quarter may come in either order. Within a bucket edges are in
 * order of arrival, mostly by id, so that neighbours are near in memory; that saves more time than
 * a finer order would, and a finer order gives no better mesh. The edges of a bucket are stored in
 * chunks of 64 bytes, and a chunk is taken out as a whole, so that the data of its edges can be
 * prefetched. */
#ifndef HE_ALGO_EDGE_QUEUE_H
#define HE_ALGO_EDGE_QUEUE_H

#include "mesh/mesh.h"

#include <string.h>

enum {
    HE_QUEUE_SHIFT = 21,
    HE_QUEUE_BUCKETS = 1 << (31 - HE_QUEUE_SHIFT),
    HE_QUEUE_WORDS = HE_QUEUE_BUCKETS / 64,
    HE_QUEUE_CHUNK = 14
};

typedef struct he_queue_chunk {
    uint32_t next; /* the next chunk of the bucket, or of the free list; HE_NONE at the end */
    uint32_t count;
    uint32_t edges[HE_QUEUE_CHUNK];
} he_queue_chunk;

typedef struct he_edge_queue {
    he_queue_chunk *chunks;
    /* The first chunk of each bucket; all later chunks of the bucket are full. */
    uint32_t *first;
    /* `free` is the first chunk of the list of emptied chunks; chunks from index `used` on were
     * never used */
    uint32_t free, used;
    /* One bit for each bucket: set if the bucket has edges. */
    uint64_t filled[HE_QUEUE_WORDS];
    size_t word; /* index of a word of `filled`; no word before that has a bit set */
} he_edge_queue;

/* Makes a queue with room for `edges` edges. The caller must clear it, even after a failure.
 * Returns HE_NO_MEMORY if memory is out. */
HE_NODISCARD static inline he_status he_queue_init(he_edge_queue *queue, uint32_t edges,
                                                   he_error *err)
{
    size_t partly = edges < HE_QUEUE_BUCKETS ? edges : HE_QUEUE_BUCKETS;
    memset(queue, 0, sizeof *queue);
    queue->free = HE_NONE;
    queue->chunks = he_mem_array(NULL, edges / HE_QUEUE_CHUNK + partly + 1, sizeof *queue->chunks);
    queue->first = he_mem_array(NULL, HE_QUEUE_BUCKETS, sizeof *queue->first);
    if (queue->chunks == NULL || queue->first == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory for a queue of %u edges", edges);
    }
    memset(queue->first, 0xFF, HE_QUEUE_BUCKETS * sizeof *queue->first);
    return HE_OK;
}

static inline void he_queue_clear(he_edge_queue *queue)
{
    he_mem_free(queue->chunks);
    he_mem_free(queue->first);
}

/* Returns the bucket of a priority, which must not be negative. Buckets have the order of their
 * priorities. */
static inline uint32_t he_queue_bucket(float priority)
{
    uint32_t bits;
    memcpy(&bits, &priority, sizeof bits);
    return bits >> HE_QUEUE_SHIFT; /* the sign bit is 0 */
}

static inline void he_queue_put(he_edge_queue *queue, uint32_t edge, float priority)
{
    size_t bucket = he_queue_bucket(priority), word = bucket / 64;
    uint32_t *first = &queue->first[bucket];
    if (*first == HE_NONE || queue->chunks[*first].count == HE_QUEUE_CHUNK) {
        uint32_t fresh = queue->free;
        if (fresh == HE_NONE) {
            fresh = queue->used++;
        } else {
            queue->free = queue->chunks[fresh].next;
        }
        queue->chunks[fresh].next = *first;
        queue->chunks[fresh].count = 0;
        *first = fresh;
    }
    queue->chunks[*first].edges[queue->chunks[*first].count++] = edge;
    queue->filled[word] |= (uint64_t)1 << bucket % 64;
    queue->word = word < queue->word ? word : queue->word;
}

/* Takes some of the edges of least priority out of the queue, all of one bucket. Returns their
 * number; 0 if the queue is empty. */
static inline uint32_t he_queue_take(he_edge_queue *queue, uint32_t edges[HE_QUEUE_CHUNK],
                                     uint32_t *bucket)
{
    while (queue->word < HE_QUEUE_WORDS && queue->filled[queue->word] == 0) {
        queue->word++;
    }
    if (queue->word == HE_QUEUE_WORDS) {
        return 0;
    }
    size_t bit = (size_t)__builtin_ctzll(queue->filled[queue->word]);
    *bucket = (uint32_t)(queue->word * 64 + bit);
    uint32_t *first = &queue->first[*bucket], taken = *first;
    he_queue_chunk *chunk = &queue->chunks[taken];
    memcpy(edges, chunk->edges, sizeof chunk->edges);
    *first = chunk->next;
    chunk->next = queue->free;
    queue->free = taken;
    if (*first == HE_NONE) {
        queue->filled[queue->word] &= queue->filled[queue->word] - 1;
    } else {
        __builtin_prefetch(&queue->chunks[*first]);
    }
    return chunk->count;
}

#endif
