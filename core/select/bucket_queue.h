/* bucket_queue.h - a queue of candidates that serves those with the least error first, nearly.
 *
 * Errors are floats of at least 0. Those that agree in the exponent and the first bits of the
 * fraction, and so differ by less than 4 per cent, are in one bucket, first in, first out. So a
 * candidate is added or taken in constant time, while a heap would need the logarithm of the length
 * of the queue. */
#ifndef HE_SELECT_BUCKET_QUEUE_H
#define HE_SELECT_BUCKET_QUEUE_H

#include "base/mem.h"

#include <stdbool.h>

enum { HE_BUCKETS = 1 << 13, HE_BUCKET_SHIFT = 18, HE_BUCKET_WORDS = HE_BUCKETS / 64 };

/* A face that a patch may take next. */
typedef struct he_queued {
    uint32_t face, patch;
    uint32_t next; /* index of the next candidate in the bucket, or in the list of free entries */
} he_queued;

typedef struct he_bucket_queue {
    he_queued *pool;
    uint32_t count, capacity;
    uint32_t unused; /* the first entry of the list of free entries; HE_NO_CANDIDATE: none */
    uint32_t first[HE_BUCKETS], last[HE_BUCKETS];
    uint64_t full[HE_BUCKET_WORDS]; /* one bit for each bucket: it is not empty */
    /* one bit for each word of `full`: it is not 0 */
    uint64_t words[(HE_BUCKET_WORDS + 63) / 64];
} he_bucket_queue;

#define HE_NO_CANDIDATE UINT32_MAX

/* Makes an empty queue; NULL if memory is out. */
he_bucket_queue *he_bucket_queue_new(void);
void he_bucket_queue_free(he_bucket_queue *queue);
/* Adds a candidate.
 * Returns HE_NO_MEMORY if memory is out. */
HE_NODISCARD he_status he_bucket_queue_add(he_bucket_queue *queue, float error, uint32_t face,
                                           uint32_t patch, he_error *err);
/* Takes a candidate of the first bucket that is not empty. Returns false if the queue is empty. */
bool he_bucket_queue_take(he_bucket_queue *queue, he_queued *out);

#endif
