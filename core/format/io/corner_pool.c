#include "format/io/corner_pool.h"

#include <string.h>

void he_corner_pool_clear(he_corner_pool *pool)
{
    he_mem_free(pool->values);
    he_ids_clear(&pool->of);
    *pool = (he_corner_pool){0};
}

he_status he_corner_pool_add(he_corner_pool *pool, const double value[3], uint64_t limit,
                             he_error *err)
{
    if (pool->count == pool->capacity) {
        size_t capacity = he_mem_grown(pool->capacity, pool->count + 1);
        if (pool->count >= HE_MAX_ROWS || (limit != 0 && capacity * sizeof *pool->values > limit)) {
            return he_fail_plain(err, HE_LIMIT,
                                 "the file has more than %zu texture coordinates or normals",
                                 pool->count);
        }
        double(*values)[3] = he_mem_array(pool->values, capacity, sizeof *values);
        if (values == NULL) {
            return he_fail_plain(err, HE_NO_MEMORY, "no memory for %zu texture coordinates",
                                 capacity);
        }
        pool->values = values;
        pool->capacity = capacity;
    }
    memcpy(pool->values[pool->count++], value, sizeof *pool->values);
    return HE_OK;
}

he_status he_corner_pool_name(he_corner_pool *pool, size_t corner, uint32_t value, he_error *err)
{
    he_ids *of = &pool->of;
    if (corner >= of->capacity) {
        he_status status = he_ids_reserve(of, corner + 1 - of->count, err);
        if (status != HE_OK) {
            return status;
        }
    }
    while (of->count < corner) {
        of->ids[of->count++] = HE_NONE;
    }
    of->ids[of->count++] = value;
    pool->named++;
    pool->highest = value > pool->highest ? value : pool->highest;
    return HE_OK;
}

size_t he_corner_pool_next_bad(const he_corner_pool *pool, size_t corner)
{
    if (pool->named == 0 || pool->highest < pool->count) {
        return SIZE_MAX;
    }
    const he_ids *of = &pool->of;
    while (corner < of->count && (of->ids[corner] == HE_NONE || of->ids[corner] < pool->count)) {
        corner++;
    }
    return corner < of->count ? corner : SIZE_MAX;
}

void he_corner_pool_forget(he_corner_pool *pool, size_t corner)
{
    pool->of.ids[corner] = HE_NONE;
    pool->named--;
}

he_status he_corner_pool_unused(const he_corner_pool *pool, size_t *out, he_error *err)
{
    uint64_t *used = he_bits_new(pool->count + 1);
    if (used == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory for %zu bits", pool->count);
    }
    size_t unused = pool->count;
    for (size_t c = 0; c < pool->of.count; c++) {
        uint32_t value = pool->of.ids[c];
        if (value != HE_NONE && !he_bits_get(used, value)) {
            he_bits_set(used, value);
            unused--;
        }
    }
    he_mem_free(used);
    *out = unused;
    return HE_OK;
}

static bool has_third(const he_corner_pool *pool)
{
    for (size_t c = 0; c < pool->of.count; c++) {
        uint32_t value = pool->of.ids[c];
        if (value != HE_NONE && pool->values[value][2] != 0) {
            return true;
        }
    }
    return false;
}

he_status he_corner_pool_finish(const he_corner_pool *pool, he_soup *soup, const char *name,
                                uint32_t least, he_error *err)
{
    if (pool->named == 0) {
        return HE_OK;
    }
    uint32_t components = has_third(pool) ? 3 : least;
    he_column *column;
    he_status status = he_soup_column(
        soup, &(he_column_schema){name, HE_HALFEDGE, HE_DOUBLE, components, HE_INTERPOLATE},
        &column, err);
    if (status == HE_OK) {
        status = he_column_extend(column, soup->corner_count, err);
    }
    if (status != HE_OK) {
        return status;
    }
    for (size_t c = 0; c < pool->of.count; c++) {
        uint32_t value = pool->of.ids[c];
        if (value != HE_NONE) {
            memcpy(he_column_row(column, c), pool->values[value], column->row_bytes);
        }
    }
    return HE_OK;
}
