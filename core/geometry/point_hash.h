/* point_hash.h - the hash of a point, for hash tables of points (geometry/point_grid.h,
 * format/io/weld.h). */
#ifndef HE_GEOMETRY_POINT_HASH_H
#define HE_GEOMETRY_POINT_HASH_H

#include "mesh/mesh.h"

#include <stdint.h>
#include <string.h>

static inline uint64_t he_point_hash_add(uint64_t h, double value)
{
    uint64_t bits;
    value = value == 0 ? 0 : value; /* -0 becomes 0 */
    memcpy(&bits, &value, sizeof bits);
    h = (h ^ bits) * 0x9E3779B97F4A7C15;
    return h ^ h >> 32;
}

/* Returns the hash of a point. Points with equal coordinates have equal hashes; 0 and -0 count as
 * equal. A client that does not know `seed`, a random number, cannot choose many points with one
 * hash. */
static inline uint32_t he_point_hash(uint64_t seed, he_vec3 p)
{
    uint64_t h = he_point_hash_add(he_point_hash_add(he_point_hash_add(seed, p.x), p.y), p.z);
    return (uint32_t)(h * 0xBF58476D1CE4E5B9 >> 32);
}

#endif
