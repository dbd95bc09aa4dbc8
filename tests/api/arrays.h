/* arrays.h - a client of GET .../geometry: fetches all rows once, then changes. */
#ifndef TESTS_API_ARRAYS_H
#define TESTS_API_ARRAYS_H

#include "tests/api/request.h"

#include "mesh/mesh.h"

enum { HEADER = 96, ROW = 16, VERTEX_PART = 0, TRIANGLE_PART = 1 };

typedef struct arrays {
    uint64_t revision, layout; /* 0: nothing yet */
    char *rows[2];
    uint32_t count[2];
    char frame[32];
    /* number of answers with all rows and with changes, and the bytes of the latter */
    uint64_t whole, changes, bytes;
} arrays;

void arrays_forget(arrays *c);
/* arrays_ask requests what changed since the arrays' revision, arrays_apply applies such an answer,
 * and arrays_update does both. */
bench_reply arrays_ask(api_bench *b, const char *mesh, const arrays *c);
void arrays_apply(arrays *c, const char *body, size_t length);
void arrays_update(api_bench *b, const char *mesh, arrays *c);
void arrays_assert_same(const arrays *a, const arrays *b);
/* Checks that the triangles of each live face are consecutive and in order, that all other slots
 * are zeros, and that each vertex has its row.
 */
void arrays_check(const arrays *c, const he_mesh *m);

/* Reads little-endian numbers at any address. */
uint32_t arrays_u32(const char *p);
uint64_t arrays_u64(const char *p);

#endif
