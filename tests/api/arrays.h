/* arrays.h - a client of GET .../geometry, which answers with the arrays that a viewer draws. The
 * client fetches all rows once, and from then on only the changes since the revision that it
 * has. */
#ifndef TESTS_API_ARRAYS_H
#define TESTS_API_ARRAYS_H

#include "tests/api/request.h"

#include "mesh/mesh.h"

enum { HEADER = 96, ROW = 16, VERTEX_PART = 0, TRIANGLE_PART = 1 };

typedef struct arrays {
    uint64_t revision, layout; /* revision and layout stated by the last answer; both are 0 before
                                  the first answer */
    char *rows[2];
    uint32_t count[2];
    char frame[32];
    /* `whole` counts the answers with all rows, `changes` the answers that have only changes;
     * `bytes` is the total length of the bodies of the latter in bytes. */
    uint64_t whole, changes, bytes;
} arrays;

void arrays_forget(arrays *c);
/* arrays_ask requests the changes since the revision in `c`, arrays_apply applies the body of the
 * answer to `c`, and arrays_update does both. */
bench_reply arrays_ask(api_bench *b, const char *mesh, const arrays *c);
void arrays_apply(arrays *c, const char *body, size_t length);
void arrays_update(api_bench *b, const char *mesh, arrays *c);
void arrays_assert_same(const arrays *a, const arrays *b);
/* Checks that the triangles of each live face are consecutive and in order, that rows reserved for
 * triangles not yet made are zeros, and that each live vertex has a row. */
void arrays_check(const arrays *c, const he_mesh *m);

/* arrays_u32 and arrays_u64 read a little-endian number at any address, aligned or not. */
uint32_t arrays_u32(const char *p);
uint64_t arrays_u64(const char *p);

#endif
