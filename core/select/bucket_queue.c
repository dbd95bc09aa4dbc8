#include "select/bucket_queue.h"

#include <string.h>

he_bucket_queue *he_bucket_queue_new(void)
{
    he_bucket_queue *queue = he_mem_zero(1, sizeof *queue);
    if (queue != NULL) {
        queue->unused = HE_NO_CANDIDATE;
    }
    return queue;
}

void he_bucket_queue_free(he_bucket_queue *queue)
{
    if (queue != NULL) {
        he_mem_free(queue->pool);
        he_mem_free(queue);
    }
}

/* Returns an entry of the pool that is not in use; HE_NO_CANDIDATE if memory is out. */
static uint32_t find_entry(he_bucket_queue *queue)
{
    const uint32_t entry = queue->unused;
    if (entry != HE_NO_CANDIDATE) {
        queue->unused = queue->pool[entry].next;
        return entry;
    }
    if (queue->count == queue->capacity) {
        size_t capacity = he_mem_grown(queue->capacity, (size_t)queue->count + 1);
        he_queued *grown =
            capacity < HE_NO_CANDIDATE ? he_mem_array(queue->pool, capacity, sizeof *grown) : NULL;
        if (grown == NULL) {
            return HE_NO_CANDIDATE;
        }
        queue->pool = grown;
        queue->capacity = (uint32_t)capacity;
    }
    return queue->count++;
}

he_status he_bucket_queue_add(he_bucket_queue *queue, float error, uint32_t face, uint32_t patch,
                              he_error *err)
{
    uint32_t bits;
    memcpy(&bits, &error, sizeof bits);
    const uint32_t bucket = bits >> HE_BUCKET_SHIFT, entry = find_entry(queue);
    if (entry == HE_NO_CANDIDATE) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory to grow patches");
    }
    queue->pool[entry] = (he_queued){face, patch, HE_NO_CANDIDATE};
    if (queue->full[bucket >> 6] >> (bucket & 63) & 1) {
        queue->pool[queue->last[bucket]].next = entry;
    } else {
        queue->first[bucket] = entry;
        queue->full[bucket >> 6] |= (uint64_t)1 << (bucket & 63);
        queue->words[bucket >> 12] |= (uint64_t)1 << (bucket >> 6 & 63);
    }
    queue->last[bucket] = entry;
    return HE_OK;
}

bool he_bucket_queue_take(he_bucket_queue *queue, he_queued *out)
{
    uint32_t high = 0;
    const uint32_t highs = sizeof queue->words / sizeof queue->words[0];
    while (high < highs && queue->words[high] == 0) {
        high++;
    }
    if (high == highs) {
        return false;
    }
    const uint32_t word = high << 6 | (uint32_t)__builtin_ctzll(queue->words[high]);
    const uint32_t bucket = word << 6 | (uint32_t)__builtin_ctzll(queue->full[word]);
    const uint32_t entry = queue->first[bucket];
    *out = queue->pool[entry];
    if (out->next == HE_NO_CANDIDATE) {
        queue->full[word] &= ~((uint64_t)1 << (bucket & 63));
        if (queue->full[word] == 0) {
            queue->words[high] &= ~((uint64_t)1 << (word & 63));
        }
    } else {
        queue->first[bucket] = out->next;
    }
    queue->pool[entry].next = queue->unused;
    queue->unused = entry;
    return true;
}
