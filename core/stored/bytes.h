/* bytes.h - writes numbers as bytes and reads them, for core/stored and core/journal. Writing
 * advances a pointer; reading advances a cursor that never passes its end. */
#ifndef HE_STORED_BYTES_H
#define HE_STORED_BYTES_H

#include "mesh/mesh.h"

#include <string.h>

_Static_assert(
    __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__,
    "the stored formats are little-endian, and numbers are copied as they lie in memory");

enum { HE_VARINT_BYTES = 10, HE_LINK_BYTES = 5 };

static inline unsigned char *he_put_bytes(unsigned char *to, const void *from, size_t size)
{
    if (size > 0) {
        memcpy(to, from, size);
    }
    return to + size;
}
static inline unsigned char *he_put_byte(unsigned char *to, unsigned value)
{
    *to = (unsigned char)value;
    return to + 1;
}
static inline unsigned char *he_put_u32(unsigned char *to, uint32_t value)
{
    return he_put_bytes(to, &value, sizeof value);
}
static inline unsigned char *he_put_u64(unsigned char *to, uint64_t value)
{
    return he_put_bytes(to, &value, sizeof value);
}
static inline unsigned char *he_put_varint(unsigned char *to, uint64_t value)
{
    for (; value >= 128; value >>= 7) {
        *to++ = (unsigned char)(value | 128);
    }
    *to = (unsigned char)value;
    return to + 1;
}
/* Codes the signed difference of two 32-bit numbers as a number below 2^33. */
static inline uint64_t he_difference(uint32_t value, uint32_t from)
{
    return value >= from ? 2 * (uint64_t)(value - from) : 2 * (uint64_t)(from - value) - 1;
}
/* Codes a link (an id, HE_NONE or HE_DEAD) as a number, which takes at most HE_LINK_BYTES as a
 * varint. An id is coded as its difference to `row`, the row of the array in which the link is
 * stored. */
static inline uint64_t he_link_code(uint32_t link, uint32_t row)
{
    return link == HE_NONE ? 0 : link == HE_DEAD ? 1 : 2 + he_difference(link, row);
}

typedef struct he_cursor {
    const unsigned char *begin, *at, *end;
} he_cursor;

static inline he_cursor he_cursor_over(const unsigned char *bytes, size_t size)
{
    return (he_cursor){bytes, bytes, bytes + size};
}
/* Returns HE_CORRUPT, with an error that names the byte at the cursor. */
static inline he_status he_refuse_at(const he_cursor *c, he_error *err, const char *what)
{
    return he_fail_at(err, HE_CORRUPT, HE_PLACE_BYTE, (uint64_t)(c->at - c->begin), "%s", what);
}

static inline size_t he_left(const he_cursor *c)
{
    return (size_t)(c->end - c->at);
}
static inline bool he_take_bytes(he_cursor *c, size_t size, void *out)
{
    if (size > he_left(c)) {
        return false;
    }
    if (size > 0) {
        memcpy(out, c->at, size);
    }
    c->at += size;
    return true;
}
static inline bool he_take_u32(he_cursor *c, uint32_t *out)
{
    return he_take_bytes(c, sizeof *out, out);
}
static inline bool he_take_u64(he_cursor *c, uint64_t *out)
{
    return he_take_bytes(c, sizeof *out, out);
}
/* Reads a varint (a number in as many bytes as it needs, stored.h). Returns false at the end of the
 * bytes, if the value is above `most`, or if it is not coded in as few bytes as possible. */
static inline bool he_take_varint(he_cursor *c, uint64_t most, uint64_t *out)
{
    uint64_t value = 0;
    const unsigned char *at = c->at;
    for (unsigned shift = 0; at < c->end && shift < 64; shift += 7) {
        unsigned char byte = *at++;
        uint64_t bits = byte & 127u;
        if (bits << shift >> shift != bits || (byte == 0 && shift > 0)) {
            return false;
        }
        value |= bits << shift;
        if (byte < 128) {
            if (value > most) {
                return false;
            }
            c->at = at;
            *out = value;
            return true;
        }
    }
    return false;
}
/* Adds to `from` a difference coded by he_difference. Returns false if the sum does not fit 32
 * bits. */
static inline bool he_add_difference(uint32_t from, uint64_t code, uint32_t *out)
{
    int64_t change = code & 1 ? -(int64_t)(code >> 1) - 1 : (int64_t)(code >> 1);
    int64_t value = (int64_t)from + change;
    *out = (uint32_t)value;
    return value >= 0 && value <= UINT32_MAX;
}
enum { HE_DIFFERENCE_BITS = 33 };
static inline bool he_take_difference(he_cursor *c, uint32_t from, uint32_t *out)
{
    uint64_t code;
    return he_take_varint(c, ((uint64_t)1 << HE_DIFFERENCE_BITS) - 1, &code) &&
           he_add_difference(from, code, out);
}
static inline bool he_take_link(he_cursor *c, uint32_t row, uint32_t *out)
{
    uint64_t code;
    if (!he_take_varint(c, ((uint64_t)1 << HE_DIFFERENCE_BITS) + 1, &code)) {
        return false;
    }
    if (code < 2) {
        *out = code == 0 ? HE_NONE : HE_DEAD;
        return true;
    }
    return he_add_difference(row, code - 2, out) && *out < HE_DEAD;
}

#endif
