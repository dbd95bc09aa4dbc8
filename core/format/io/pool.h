/* pool.h - values that the corners of a text file name by number: texture coordinates, normals.
 *
 * A corner may name a value that comes later, so the attribute is made at the end. */
#ifndef HE_FORMAT_IO_POOL_H
#define HE_FORMAT_IO_POOL_H

#include "build/build.h"

/* {0} is empty. */
typedef struct he_pool {
    double (*values)[3];
    size_t count, capacity;
    he_ids of;        /* for each corner its value, HE_NONE where it has none; may be shorter
                         than the corners */
    size_t named;     /* corners that have one */
    uint32_t highest; /* value named */
} he_pool;

void he_pool_clear(he_pool *pool);
/* `limit` bounds the bytes held, 0 for no bound. HE_LIMIT, HE_NO_MEMORY. */
HE_NODISCARD he_status he_pool_add(he_pool *pool, const double value[3], uint64_t limit,
                                   he_error *err);
/* Corners come in order, those without a value are left out. HE_NO_MEMORY. */
HE_NODISCARD he_status he_pool_name(he_pool *pool, size_t corner, uint32_t value, he_error *err);
/* The first corner from `corner` on that names a value beyond the last one; SIZE_MAX when there is
 * none. */
size_t he_pool_next_bad(const he_pool *pool, size_t corner);
/* Let a corner name no value. */
void he_pool_forget(he_pool *pool, size_t corner);
/* How many values no corner names; all that are named must be good. HE_NO_MEMORY. */
HE_NODISCARD he_status he_pool_unused(const he_pool *pool, size_t *out, he_error *err);
/* Make the half-edge attribute `name`, if any corner has a value; all must be good. It has three
 * components, or `least` when the third is 0 in all of them. */
HE_NODISCARD he_status he_pool_finish(const he_pool *pool, he_soup *soup, const char *name,
                                      uint32_t least, he_error *err);

#endif
