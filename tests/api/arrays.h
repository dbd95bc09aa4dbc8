/* arrays.h - a client of GET .../geometry: all rows once, then what changed of them. */
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
    uint64_t whole, changes, bytes; /* answers so far, and the bytes of changes */
} arrays;

void arrays_forget(arrays *c);
/* The answer to what the arrays knows, and bring it up to date with one. */
bench_reply arrays_ask(api_bench *b, const char *mesh, const arrays *c);
void arrays_apply(arrays *c, const char *body, size_t length);
void arrays_update(api_bench *b, const char *mesh, arrays *c);
void arrays_assert_same(const arrays *a, const arrays *b);
/* Each live face's triangles in order in one run, and nothing else but zeros; each vertex its row.
 */
void arrays_check(const arrays *c, const he_mesh *m);

/* Little-endian, at any address. */
uint32_t arrays_u32(const char *p);
uint64_t arrays_u64(const char *p);

#endif
