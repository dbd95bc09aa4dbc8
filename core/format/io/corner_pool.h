/* corner_pool.h - pools of values, such as texture coordinates and normals, that the corners of
 * faces in a text file refer to by index.
 *
 * A corner may name a value that comes later, so the attribute is made at the end. */
#ifndef HE_FORMAT_IO_CORNER_POOL_H
#define HE_FORMAT_IO_CORNER_POOL_H

#include "build/build.h"

/* {0} is empty. */
typedef struct he_corner_pool {
    double (*values)[3];
    size_t count, capacity;
    /* The index in the pool of each corner's value; HE_NONE for a corner without a value. The
     * list may be shorter than the number of corners. */
    he_ids of;
    size_t named;     /* number of corners that have a value */
    uint32_t highest; /* highest index of a value that a corner refers to */
} he_corner_pool;

void he_corner_pool_clear(he_corner_pool *pool);
/* Adds a value to the pool. `limit` is the most bytes that the pool may have, 0 for no limit.
 * Returns HE_LIMIT if the pool would be larger.
 * Returns HE_NO_MEMORY if memory is out. */
HE_NODISCARD he_status he_corner_pool_add(he_corner_pool *pool, const double value[3],
                                          uint64_t limit, he_error *err);
/* Sets which value a corner refers to. Corners must come in order; those without a value are left
 * out.
 * Returns HE_NO_MEMORY if memory is out. */
HE_NODISCARD he_status he_corner_pool_name(he_corner_pool *pool, size_t corner, uint32_t value,
                                           he_error *err);
/* Returns the first corner, from `corner` on, that refers to a value beyond the last one; SIZE_MAX
 * if there is none. */
size_t he_corner_pool_next_bad(const he_corner_pool *pool, size_t corner);
/* Makes a corner refer to no value. */
void he_corner_pool_forget(he_corner_pool *pool, size_t corner);
/* Counts the values that no corner refers to. All indices must be valid.
 * Returns HE_NO_MEMORY if memory is out. */
HE_NODISCARD he_status he_corner_pool_unused(const he_corner_pool *pool, size_t *out,
                                             he_error *err);
/* Makes the half-edge attribute `name` from the values, if any corner has a value; all indices must
 * be valid. The attribute has three components, or only `least` if the third component is 0 in all
 * values. */
HE_NODISCARD he_status he_corner_pool_finish(const he_corner_pool *pool, he_soup *soup,
                                             const char *name, uint32_t least, he_error *err);

#endif
