/* specimens.h - small meshes in the API, and the texts that the API must answer about them. Include
 * this header once per program: its functions are static. */
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

static inline void say(page *p, const char *format, ...) __attribute__((format(printf, 2, 3)));
static inline void say(page *p, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    int length = vsnprintf(p->text + p->used, sizeof p->text - p->used, format, arguments);
    va_end(arguments);
    p->used += (size_t)length;
    assert_true(p->used < sizeof p->text);
}

static inline void say_id(page *p, unsigned id)
{
    if (id == PG_NONE) {
        say(p, "null");
    } else {
        say(p, "%u", id);
    }
}

static inline void say_ids(page *p, const unsigned *ids, unsigned count)
{
    say(p, "[");
    for (unsigned i = 0; i < count; i++) {
        say(p, i == 0 ? "" : ",");
        say_id(p, ids[i]);
    }
    say(p, "]");
}

static inline void say_list(page *p, const pg_list *list)
{
    say_ids(p, list->ids, list->count);
}

static inline bool is_number(const char *p, const char *start)
{
    return (isdigit((unsigned char)*p) || *p == '-') && (p == start || strchr("[:,", p[-1]));
}

/* Returns whether two texts are equal except for the last digits of numbers, which depend on
 * rounding. */
static inline bool same(const char *a, const char *e)
{
    const char *a_start = a, *e_start = e;
    while (*a != '\0' || *e != '\0') {
        if (is_number(a, a_start) && is_number(e, e_start)) {
            char *a_end, *e_end;
            double x = strtod(a, &a_end), y = strtod(e, &e_end);
            if (!(fabs(x - y) <= 1e-12 * fmax(1, fabs(y)))) {
                return false;
            }
            a = a_end;
            e = e_end;
        } else if (*a++ != *e++) {
            return false;
        }
    }
    return true;
}

static inline void expect(const bench_reply *r, const page *wanted)
{
    if (r->status != 200 || !same(r->body, wanted->text)) {
        fail_msg("\n  answered %d %s\n  expected %s", r->status, r->body, wanted->text);
    }
}

/* --- requests --- */

static inline bench_reply get(api_bench *b, const char *format, ...)
    __attribute__((format(printf, 2, 3)));
static inline bench_reply get(api_bench *b, const char *format, ...)
{
    char target[512];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(target, sizeof target, format, arguments);
    va_end(arguments);
    return bench_send(b, "GET", target, NULL, NULL);
}

static inline void expect_get(api_bench *b, const page *wanted, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
static inline void expect_get(api_bench *b, const page *wanted, const char *format, ...)
{
    char target[512];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(target, sizeof target, format, arguments);
    va_end(arguments);
    bench_reply r = get(b, "%s", target);
    expect(&r, wanted);
    bench_reply_free(&r);
}

static inline void expect_post(api_bench *b, const page *wanted, const char *target,
                               const char *body)
{
    bench_reply r = bench_send(b, "POST", target, NULL, body);
    expect(&r, wanted);
    bench_reply_free(&r);
}

static inline unsigned member(const bench_reply *r, const char *name)
{
    const cJSON *value = cJSON_GetObjectItemCaseSensitive(r->json, name);
    assert_non_null(value);
    return cJSON_IsNull(value) ? PG_NONE : (unsigned)value->valuedouble;
}

/* --- specimens --- */

/* In this order: an empty mesh, closed and open meshes, a bow-tie, isolated vertices, polygons,
 * faces that share two edges, two components, two components that touch at a vertex, three fans
 * around a vertex, and a mesh of genus 1. */
static const char *const specimens[] = {
    "",
    "012",
    "021,032,013,123",
    "0123,7654,1045,2156,3267,0374",
    "301,320,431,523,653,634",
    "012,034,056",
    "021,032,013,123,456",
    "0123,3245",
    "01234567",
    "0123,2104",
    "012,346,895",
    "0135,579",
    "012,234,450",
    "0143,1254,2035,3476,4587,5368,6710,7821,8602",
};
enum { SPECIMENS = sizeof specimens / sizeof *specimens };

static inline void put_mesh(api_bench *b, const pg_mesh *pg)
{
    page document = {.used = 0};
    say(&document, "{\"vertices\":[");
    for (unsigned v = 0; v < pg->vertices; v++) {
        const double *p = pg->position[v];
        say(&document, "%s[%g,%g,%g]", v == 0 ? "" : ",", p[0], p[1], p[2]);
    }
    say(&document, "],\"faces\":[");
    for (unsigned f = 0; f < pg->faces; f++) {
        say(&document, f == 0 ? "" : ",");
        say_ids(&document, pg->corners[f], pg->degree[f]);
    }
    say(&document, "]}");
    bench_reply r = bench_send(b, "PUT", "/v1/meshes/m", NULL, document.text);
    if (r.status != 201) {
        fail_msg("%d %s: %s", r.status, document.text, r.body);
    }
    bench_reply_free(&r);
}

/* Asks the API once for the choices that it is free to make, such as the half-edge that it stores
 * with a vertex, so that later answers can be predicted exactly. */
static inline void learn(api_bench *b, pg_mesh *pg)
{
    for (unsigned h = 0; h < pg->halfedges; h++) {
        bench_reply r = get(b, "/v1/meshes/m/halfedges/%u", h);
        pg_learn_next(pg, h, member(&r, "next"));
        bench_reply_free(&r);
    }
    for (unsigned v = 0; v < pg->vertices; v++) {
        bench_reply r = get(b, "/v1/meshes/m/vertices/%u", v);
        pg_learn_vertex(pg, v, member(&r, "halfedge"));
        bench_reply_free(&r);
    }
    for (unsigned f = 0; f < pg->faces; f++) {
        bench_reply r = get(b, "/v1/meshes/m/faces/%u", f);
        pg_learn_face(pg, f, member(&r, "halfedge"));
        bench_reply_free(&r);
    }
}

/* Creates the mesh in the API and as lists of polygons, with one isolated vertex in addition to
 * those of the faces. */
static inline api_bench *begin(const char *faces, pg_mesh *pg)
{
    api_bench *b = bench_new();
    pg_make(pg, faces, 0);
    pg_make(pg, faces, pg->vertices + 1);
    put_mesh(b, pg);
    learn(b, pg);
    return b;
}

static inline void for_each_specimen(void (*try)(api_bench *b, const pg_mesh *pg))
{
    for (int i = 0; i < SPECIMENS; i++) {
        pg_mesh pg;
        api_bench *b = begin(specimens[i], &pg);
        try(b, &pg);
        bench_free(b);
    }
}

static const struct {
    const char *name, *plural;
    const char *relations[6];
} kinds[] = {
    {"vertex", "vertices", {"vertices", "outgoing", "incoming", "edges", "faces"}},
    {"halfedge", "halfedges", {"loop", "ring"}},
    {"edge", "edges", {"vertices", "halfedges", "faces"}},
    {"face", "faces", {"vertices", "halfedges", "edges", "faces"}},
};
enum { VERTEX, HALFEDGE, EDGE, FACE, KINDS };

static inline unsigned count_of(const pg_mesh *pg, int kind)
{
    return kind == VERTEX     ? pg->vertices
           : kind == HALFEDGE ? pg->halfedges
           : kind == EDGE     ? pg->halfedges / 2
                              : pg->faces;
}

#endif
