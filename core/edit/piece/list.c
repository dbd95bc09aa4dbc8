#include "edit/piece/list.h"

#include "query/idmap.h"

/* In a list of up to SHORT_LIST ids, repeated ids are found by comparing each pair of ids, which
 * needs no memory. A longer list uses a bit set over the range from the lowest id to the highest.
 * If that range is more than SPARSE_LIST times the length of the list, a hash table is used
 * instead, because clearing the bits would take longer. */
enum { SHORT_LIST = 32, SPARSE_LIST = 256 };

static size_t short_repeat(const uint32_t *ids, size_t count)
{
    for (size_t i = 1; i < count; i++) {
        for (size_t k = 0; k < i; k++) {
            if (ids[k] == ids[i]) {
                return i;
            }
        }
    }
    return count;
}

static he_status sparse_repeat(const uint32_t *ids, size_t count, size_t *at, he_error *err)
{
    he_idmap seen = {.slots = NULL};
    he_status status = HE_OK;
    bool added = true;
    size_t i = 0;
    while (status == HE_OK && i < count) {
        uint32_t index;
        status = he_idmap_add(&seen, ids[i], &index, &added, err);
        if (!added) {
            break;
        }
        i++;
    }
    he_idmap_clear(&seen);
    if (status == HE_OK) {
        *at = i;
    }
    return status;
}

he_status he_list_repeat(const uint32_t *ids, size_t count, size_t *at, he_error *err)
{
    if (count <= SHORT_LIST) {
        *at = short_repeat(ids, count);
        return HE_OK;
    }
    uint32_t low = ids[0], high = ids[0];
    for (size_t i = 1; i < count; i++) {
        low = ids[i] < low ? ids[i] : low;
        high = ids[i] > high ? ids[i] : high;
    }
    if ((high - low) / SPARSE_LIST > count) {
        return sparse_repeat(ids, count, at, err);
    }
    uint64_t *seen = he_bits_new((size_t)(high - low) + 1);
    if (seen == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory to check a list of %zu ids", count);
    }
    size_t i = 0;
    while (i < count && !he_bits_get(seen, ids[i] - low)) {
        he_bits_set(seen, ids[i] - low);
        i++;
    }
    he_mem_free(seen);
    *at = i;
    return HE_OK;
}

he_status he_list_require(const he_mesh *m, he_kind kind, const uint32_t *ids, size_t count,
                          he_status repeated, he_error *err)
{
    for (size_t i = 0; i < count; i++) {
        he_status status = he_mesh_require(m, kind, ids[i], err);
        if (status != HE_OK) {
            return status;
        }
    }
    size_t at = count;
    he_status status = he_list_repeat(ids, count, &at, err);
    if (status == HE_OK && at < count) {
        return he_fail(err, repeated, kind, ids[at], "%s %u is listed twice", he_kind_name(kind),
                       ids[at]);
    }
    return status;
}
