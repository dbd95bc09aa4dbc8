/* Defects that are common in mesh files. The test builds a file with each defect, which must get
 * the right refusal and must be accepted with the right repair. */
#include "tests/api/request.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { MOST = 1 << 18 };

typedef struct file {
    char *bytes;
    size_t length;
} file;

static void put_bytes(file *f, const void *bytes, size_t n)
{
    assert_true(f->length + n <= MOST);
    memcpy(f->bytes + f->length, bytes, n);
    f->length += n;
}

static void put(file *f, const char *text)
{
    put_bytes(f, text, strlen(text));
}

static void put_many(file *f, const char *text, int times)
{
    for (int i = 0; i < times; i++) {
        put(f, text);
    }
}

/* --- the files --- */

/* Writes a tetrahedron as binary STL. */
static void put_facets(file *f, const char *header, uint32_t count)
{
    static const float corners[4][9] = {{0, 0, 0, 0, 1, 0, 1, 0, 0},
                                        {0, -0.0F, 0, 1, 0, 0, 0, 0, 1},
                                        {1, 0, 0, 0, 1, 0, 0, 0, 1},
                                        {0, 1, 0, 0, 0, -0.0F, 0, 0, 1}};
    char head[80] = {0};
    memcpy(head, header, strlen(header));
    put_bytes(f, head, sizeof head);
    put_bytes(f, &count, sizeof count);
    for (size_t i = 0; i < 4; i++) {
        put_bytes(f, (char[12]){0}, 12);
        put_bytes(f, corners[i], sizeof corners[i]);
        put_bytes(f, (char[2]){0}, 2);
    }
}

static void solid_with_a_stray_byte(file *f)
{
    put_facets(f, "solid Exported", 4);
    put_bytes(f, "\n", 1);
}

static void count_too_low(file *f)
{
    put_facets(f, "binary", 3);
}

static void count_too_high(file *f)
{
    put_facets(f, "solid", 5);
}

static void capital_facet(file *f)
{
    put(f,
        "solid a\nfacet normal 0 0 1\n outer loop\n  vertex 0 0 0\n  vertex 1 0 0\n  vertex 0 1 0\n"
        " endloop\nendfacet\nFACET NORMAL 0 0 1\n OUTER LOOP\n  VERTEX 1 0 0\n  VERTEX 1 1 0\n"
        "  VERTEX 0 1 0\n ENDLOOP\nENDFACET\nendsolid a\n");
}

static void one_tristrip(file *f)
{
    put(f,
        "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
        "property float z\nelement tristrips 1\nproperty list int int vertex_indices\nend_header\n"
        "0 0 0\n1 0 0\n0 1 0\n1 1 0\n4 0 1 2 3\n");
}

#define SQUARE "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"

static void continued_faces(file *f)
{
    put(f, SQUARE "f 1 2 \\\r\n 3 \\\n\\\n4\n");
}

static void repeated_corners(file *f)
{
    put(f, SQUARE "f 1 2 3\nf");
    put_many(f, " 1 2 3 4", 500);
}

static void index_2_32(file *f)
{
    put(f, SQUARE "f 1 2 4294967297\n");
}

static void index_2_64(file *f)
{
    put(f, SQUARE "f 1 2 18446744073709551617\n");
}

static void index_of_off_2_64(file *f)
{
    put(f, "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 18446744073709551618\n");
}

static void index_of_ply_2_32(file *f)
{
    put(f, "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
           "property float z\nelement face 1\nproperty list int int vertex_indices\nend_header\n"
           "0 0 0\n1 0 0\n0 1 0\n3 0 1 4294967298\n");
}

static void rows_without_bytes(file *f)
{
    put(f, "ply\nformat binary_little_endian 1.0\nelement nothing 4000000000\nend_header\n");
}

static void utf16(file *f)
{
    static const char text[] = SQUARE;
    put_bytes(f, "\xFF\xFE", 2);
    for (const char *p = text; *p != '\0'; p++) {
        put_bytes(f, (char[2]){*p, 0}, 2);
    }
}

static void utf8_mark(file *f)
{
    put(f, "\xEF\xBB\xBF" SQUARE "f 1 2 3 4\n");
}

static void isolated_thousands(file *f)
{
    put(f, SQUARE "f 1 2 3 4\n");
    put_many(f, "v 5 5 5\n", 5000);
}

/* Two tetrahedra share one vertex and nothing else; no edge is on a boundary. */
static void closed_with_a_bowtie(file *f)
{
    put(f, "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv -1 0 0\nv 0 -1 0\nv 0 0 -1\n"
           "f 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\nf 1 6 5\nf 1 5 7\nf 5 6 7\nf 6 1 7\n");
}

/* Two triangles share one vertex and nothing else. */
static void open_bowtie(file *f)
{
    put(f, "v 0 0 0\nv 1 0 0\nv 0 1 0\nv -1 0 0\nv 0 -1 0\nf 1 2 3\nf 1 4 5\n");
}

static void moebius(file *f)
{
    put(f, "v 0 0 0\nv 1 0 0\nv 2 0 1\nv 1 1 1\nv 0 1 2\n"
           "f 1 2 3\nf 2 3 4\nf 3 4 5\nf 4 5 1\nf 5 1 2\n");
}

/* --- the expected answers --- */

static const struct {
    const char *format;
    void (*make)(file *f);
    int status;
    const char *words;
    const char *repair; /* NULL: no repair helps */
    const char *then;
} traps[] = {
    {"stl", solid_with_a_stray_byte, 201, "\"trailing_bytes\"", NULL, NULL},
    {"stl", count_too_low, 400, "more than the 3 facets", NULL, NULL},
    {"stl", count_too_high, 400, "after 4 of the 5 facets", NULL, NULL},
    {"stl", capital_facet, 201, "\"vertices\":4,", NULL, NULL},
    {"ply", one_tristrip, 201, "\"faces\":2,", NULL, NULL},
    {"obj", continued_faces, 201, "\"degrees\":{\"4\":1}", NULL, NULL},
    {"obj", repeated_corners, 422, "line 6: face 1", "drop_degenerate", "\"faces\":1,"},
    {"obj", index_2_32, 422, "line 5: there is no vertex 4294967297", NULL, NULL},
    {"obj", index_2_64, 422, "line 5: there is no vertex 18446744073709551617", NULL, NULL},
    {"off", index_of_off_2_64, 422, "line 6: there is no vertex 18446744073709551618", NULL, NULL},
    {"ply", index_of_ply_2_32, 422, "line 13: there is no vertex 4294967298", NULL, NULL},
    {"ply", rows_without_bytes, 400, "4000000000 rows and no properties", NULL, NULL},
    {"obj", utf16, 422, "line 1: the text is UTF-16", NULL, NULL},
    {"obj", utf8_mark, 201, "\"vertices\":4,", NULL, NULL},
    {"obj", isolated_thousands, 201, "\"count\":5000,\"line\":6,", NULL, NULL},
    {"obj", closed_with_a_bowtie, 422, "line 1: vertex 0: a closed fan", "split",
     "\"vertices\":8,\"halfedges\":24,\"edges\":12,\"faces\":8,\"boundary_loops\":0,"
     "\"isolated_vertices\":0,\"components\":2,"},
    {"obj", open_bowtie, 201, "\"code\":\"bowtie\"", NULL, NULL},
    {"obj", moebius, 422, "another face runs along the edge", "orient,split",
     "\"edges\":11,\"faces\":5,"},
};

static bench_reply send_file(api_bench *b, const char *format, const file *f, const char *repair)
{
    static const char *const headers[] = {"Content-Type", "application/octet-stream", NULL};
    char target[100];
    snprintf(target, sizeof target, "/v1/meshes?format=%s%s%s", format,
             repair == NULL ? "" : "&repair=", repair == NULL ? "" : repair);
    return bench_send_bytes(b, &(bench_request){"POST", target, headers, f->bytes, f->length});
}

static void expect_words(const bench_reply *r, const char *words)
{
    if (strstr(r->body, words) == NULL) {
        fail_msg("no \"%s\" in %.600s", words, r->body);
    }
}

static void each_trap_is_seen(void **state)
{
    (void)state;
    api_bench *b = bench_new();
    file f = {malloc(MOST), 0};
    assert_non_null(f.bytes);
    for (size_t i = 0; i < sizeof traps / sizeof *traps; i++) {
        f.length = 0;
        traps[i].make(&f);
        bench_reply r = send_file(b, traps[i].format, &f, NULL);
        expect_words(&r, traps[i].words);
        r = bench_expect(traps[i].status, r);
        const cJSON *repairs = cJSON_GetObjectItem(r.json, "repair");
        assert_int_equal(repairs != NULL, traps[i].repair != NULL);
        bench_reply_free(&r);
        if (traps[i].repair != NULL) {
            r = bench_expect(201, send_file(b, traps[i].format, &f, traps[i].repair));
            expect_words(&r, traps[i].then);
            bench_reply_free(&r);
        }
    }
    free(f.bytes);
    bench_free(b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(each_trap_is_seen)};
    return cmocka_run_group_tests_name("traps", tests, NULL, NULL);
}
