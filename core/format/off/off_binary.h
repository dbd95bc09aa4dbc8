/* off_binary.h - the body of an OFF file whose header says BINARY.
 *
 *     V F E                          32 bits each, like all numbers below; big-endian
 *     x y z [normal] [r g b a] [s t] floats, for each vertex
 *     n v1 ... vn c [c numbers]      for each face: whole numbers, then floats of a colour
 *
 * A colour of a face has c = 3 or 4 numbers; c = 0 means none, and other numbers are reported as a
 * warning and ignored. */
#ifndef HE_FORMAT_OFF_OFF_BINARY_H
#define HE_FORMAT_OFF_OFF_BINARY_H

#include "format/off/off_values.h"

/* The bytes of a vertex with all its values. The reader reads the body in parts, such as a vertex,
 * each when all its bytes have come; no part is longer than HE_OFF_LONGEST. */
enum { HE_OFF_LONGEST = 4 * (3 + 3 + 4 + 2) };

typedef enum he_off_part {
    HE_OFF_COUNTS,
    HE_OFF_VERTEX,
    HE_OFF_DEGREE,
    HE_OFF_CORNER,
    HE_OFF_COLOR_COUNT,
    HE_OFF_COLOR,
    HE_OFF_END
} he_off_part;

typedef struct he_off_binary {
    he_off_values *values;
    unsigned has;     /* flags of off_values.h: the values that each vertex has */
    he_off_part part; /* what comes next */
    uint64_t offset;  /* offset of the next byte */
    uint64_t vertices, faces;
    /* `left` is how many corners of the face, or numbers of its colour, are still to come;
     * `color_count` is how many numbers the colour has in all. */
    uint32_t left, color_count;
    double color[4];
    unsigned char held[HE_OFF_LONGEST];
    size_t held_count;
    uint64_t trailing;
} he_off_binary;

/* Prepares to read a binary body. `offset` is the length of the header, which the caller has
 * read. */
void he_off_binary_init(he_off_binary *binary, he_off_values *values, unsigned has,
                        uint64_t offset);
/* Reads the next bytes of the body; an error names the byte.
 * Returns HE_SYNTAX, HE_BAD_VALUE, HE_BAD_INDEX or HE_NOT_FINITE if the bytes are not valid.
 * Returns HE_LIMIT if a limit of the import would be exceeded.
 * Returns HE_NO_MEMORY if memory is out. */
HE_NODISCARD he_status he_off_binary_feed(he_off_binary *binary, const unsigned char *bytes,
                                          size_t n, he_error *err);
HE_NODISCARD he_status he_off_binary_finish(he_off_binary *binary, he_error *err);

#endif
