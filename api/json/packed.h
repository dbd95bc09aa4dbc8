/* packed.h - the media type application/vnd.hedge.edits: a JSON text, and arrays of numbers beside
 * it. Long lists of edits, and the answers to them, are faster to write and to read in this form.
 *
 * All values are little-endian.
 *
 *     0   4   "HEDE"
 *     4   u32 version of this layout of bytes, 1
 *     8   u32 bytes of the JSON text
 *     12  u32 number of arrays
 *     16  u64 revision that the edit made, in an answer; 0 in a request
 *     24  for each array: u32 type of its numbers, u32 numbers in an item, u64 number of items
 *     ..  the JSON text, then zeros up to a multiple of 8 bytes
 *     ..  the arrays, each followed by zeros up to a multiple of 8 bytes; then the body ends
 *
 *     type 1  u32: ids (2^32 - 1 stands for null), or in an answer also the ends of lists
 *     type 2  f64: numbers or coordinates
 *
 * The JSON text is what a body of application/json would be, but {"array":K} may stand in place of
 * a list of ids (type 1, one number in an item), of numbers (type 2, one) or of points (type 2,
 * three); K counts from 0. In an answer all lists of ids are arrays; those of pairs have two
 * numbers in an item. A list of lists is {"ids":{"array":K},"ends":{"array":L}}: list i has the
 * ids before the end number i, from the end before it on. An answer has no member `revision`. */
#ifndef HE_API_JSON_PACKED_H
#define HE_API_JSON_PACKED_H

#include "api/json/problem.h"
#include "api/json/text.h"

#include <stdint.h>

#define API_PACKED_EDITS "application/vnd.hedge.edits"

enum { API_PACKED_U32 = 1, API_PACKED_F64 = 2 };

/* An array of numbers. */
typedef struct api_numbers {
    uint32_t type;  /* API_PACKED_U32 or API_PACKED_F64 */
    uint32_t width; /* numbers in an item */
    size_t count;   /* number of items */
    /* The numbers, at an address that suits them. */
    union {
        const void *bytes;
        const uint32_t *u32;
        const double *f64;
    } at;
} api_numbers;

/* The arrays beside a JSON text. {0} has none. */
typedef struct api_arrays {
    api_numbers *arrays;
    size_t count, capacity;
    /* In an answer that is being written: the bytes of the arrays, with padding, in their order. */
    api_text bytes;
} api_arrays;

void api_arrays_clear(api_arrays *arrays);

/* Finds the JSON text and the arrays in a body, which must outlive them; body.at must be
 * suitably aligned for a double. Refuses the body with HE_BAD_VALUE and the offset of the wrong
 * byte, or with HE_NO_MEMORY. */
bool api_packed_open(api_bytes body, api_arrays *out, api_bytes *json, api_problem *problem);

/* Adds an array to an answer and returns its number. Failure is found by api_packed_write. */
size_t api_packed_add(api_arrays *arrays, uint32_t type, uint32_t width, const void *numbers,
                      size_t count);
/* Writes the body of an answer with these arrays to `out`, which is empty. out->failed is set if
 * memory is out. */
void api_packed_write(const api_arrays *arrays, const api_text *json, api_text *out);
/* Fills in the revision of an answer. */
void api_packed_fill(api_text *body, uint64_t revision);

#endif
