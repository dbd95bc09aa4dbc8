/* specimens.h - small meshes that tests create through the API, and the texts that the API must
 * answer about them. */
#ifndef TESTS_API_SPECIMENS_H
#define TESTS_API_SPECIMENS_H

#include "tests/api/polygons.h"
#include "tests/api/request.h"

#include <ctype.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

/* --- text --- */

typedef struct page {
    char text[1 << 16];
    size_t used;
} page;

/* Appends formatted text. */
void page_say(page *p, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* Appends an id to the page, or `null` if the id is PG_NONE. */
void page_say_id(page *p, unsigned id);

/* Appends `count` ids to the page as a JSON array. */
void page_say_ids(page *p, const unsigned *ids, unsigned count);

/* Appends a JSON array of the ids in a list. */
void page_say_list(page *p, const pg_list *list);

/* Returns whether two texts are equal; the last digits of numbers may differ, since they depend on
 * rounding. */
bool page_same(const char *a, const char *e);

/* Requires that the answer has the status 200 and that its body equals the text `wanted` in the
 * sense of page_same(). */
void page_expect(const bench_reply *r, const page *wanted);

/* --- requests --- */

/* Sends a GET to the path and query that `format` and its arguments make. */
bench_reply specimen_get(api_bench *b, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

/* Sends a GET and requires that the answer is the text `wanted`. */
void page_expect_get(api_bench *b, const page *wanted, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* Sends a POST and requires that the answer is the text `wanted`. */
void page_expect_post(api_bench *b, const page *wanted, const char *target, const char *body);

/* --- specimens --- */

/* Number of specimens. They are, in this order: an empty mesh, closed and open meshes, a bow-tie,
 * isolated vertices, polygons with more than three sides, two faces that share two edges, two
 * components, two components that touch at a vertex, three fans around a vertex, and a mesh of
 * genus 1. */
enum { SPECIMENS = 14 };
extern const char *const specimens[SPECIMENS];

/* Creates the mesh "m" in the API from the polygons of `pg`. */
void specimen_put(api_bench *b, const pg_mesh *pg);

/* Creates one specimen twice: as the mesh "m" in the API, and as lists of polygons. The mesh has
 * one isolated vertex in addition to the vertices of the faces. */
api_bench *specimen_begin(const char *faces, pg_mesh *pg);

/* Calls `try` for each specimen, with a new service in which the specimen is the only mesh. */
void for_each_specimen(void (*try)(api_bench *b, const pg_mesh *pg));

enum { VERTEX, HALFEDGE, EDGE, FACE, KINDS };
/* A kind of elements: the words for it in the API, and the relations that it has, ended by NULL. */
typedef struct specimen_kind {
    const char *name, *plural;
    const char *relations[6];
} specimen_kind;
extern const specimen_kind specimen_kinds[KINDS];

/* Returns the number of elements of a kind. */
unsigned specimen_count(const pg_mesh *pg, int kind);

#endif
