/* point_hash.h - the hash of a point, for hash tables of points (geometry/point_grid.h,
 * format/io/weld.h). */
#ifndef HE_GEOMETRY_POINT_HASH_H
#define HE_GEOMETRY_POINT_HASH_H

#include "mesh/mesh.h"

#include <stdint.h>
#include <string.h>

/* Mixes the bits of a coordinate into a hash. Both halves of the product of 128 bits are used: the
 * lower half alone would change in the same way for every seed if only the sign of the coordinate
 * changes, and the next coordinate could undo that. */
static inline uint64_t he_point_hash_add(uint64_t h, double value)
{
    __extension__ typedef unsigned __int128 wide;
    uint64_t bits;
    value = value == 0 ? 0 : value; /* -0 becomes 0 */
    memcpy(&bits, &value, sizeof bits);
    const wide product = (wide)(h ^ bits) * UINT64_C(0x9E3779B97F4A7C15);
    return (uint64_t)product ^ (uint64_t)(product >> 64);
}

/* Returns the hash of a point. Points with equal coordinates have equal hashes; 0 and -0 count as
 * equal. A client that does not know `seed`, a random number, cannot choose many points with one
 * hash. */
static inline uint32_t he_point_hash(uint64_t seed, he_vec3 p)
{
    /* Seeds are addresses, whose upper bits are known. */
    const uint64_t begin = seed * UINT64_C(0x94D049BB133111EB) + UINT64_C(0xBF58476D1CE4E5B9);
    uint64_t h = he_point_hash_add(he_point_hash_add(he_point_hash_add(begin, p.x), p.y), p.z);
    return (uint32_t)(h * 0xBF58476D1CE4E5B9 >> 32);
}

#endif
