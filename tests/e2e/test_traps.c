/* Files made to do harm: they promise more data than follows, have elements that need no bytes,
 * nest deeply, or consist of megabytes of what a reader reads slowly. They are sent to a real
 * daemon plain and in gzip. Each must get its answer, within 256 MB of memory beyond its own size,
 * and within ten times the processor time that the same daemon takes for an ordinary file of that
 * size. */
#include "tests/e2e/client.h"

#include "tests/codings.h"
#include "tests/pace.h"
#include "tests/sanitized.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

/* A sanitizer adds memory of its own, so memory is not compared in a build with a sanitizer; and it
 * makes the daemon many times slower, so files are smaller there. */
static const bool counts_memory = !SANITIZED;
enum { ONE = SANITIZED ? 4 << 20 : 16 << 20 };

enum { OVER = 256 << 20, ROOM = 600, TIMES_ORDINARY = 10 };

typedef struct trap {
    const char *what, *type;
    /* The file is `before`, then `part` repeated until the file has `size` bytes, then `after`. A $
     * in these texts stands for a NUL. */
    const char *before, *part, *after;
    size_t size;
    long status;
    const char *words; /* words that the answer must contain */
} trap;

#define ASCII  "ply\nformat ascii 1.0\n"
#define BINARY "ply\nformat binary_little_endian 1.0\n"
#define XYZ    "property float x\nproperty float y\nproperty float z\n"
#define POINT  "element vertex 1\n" XYZ
#define LIST   "element face 1\nproperty list int int vertex_index\nend_header\n$$$$$$$$$$$$"
#define PLY    "model/ply"
#define OBJ    "model/obj"
#define OFF    "model/x-off"
#define STL    "model/stl"
#define GLB    "model/gltf-binary"
#define GLTF   "model/gltf+json"
#define JSON   "application/json"
#define ASSET  "{\"asset\":{\"version\":\"2.0\"},"
#define SCENE                                                                               \
    ASSET "\"scene\":0,\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"mesh\":0}],\"meshes\":[{" \
          "\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}],"
#define ACCESSOR "\"accessors\":[{\"componentType\":5126,\"type\":\"VEC3\","
#define VIEW                                                                                       \
    "\"buffers\":[{\"byteLength\":3,\"uri\":\"data:;base64,AAAA\"}],\"bufferViews\":[{\"buffer\":" \
    "0,"
#define BLANKS "                                                                                "
#define THREE  "v 0 0 0\nv 1 0 0\nv 0 1 0\n"

static const trap traps[] = {
    {"more vertices than bytes", PLY, BINARY "element vertex 4294967295\n" XYZ "end_header\n", "",
     "", 0, 400, "4294967295"},
    {"2^64 vertices", PLY, ASCII "element vertex 18446744073709551616\n" XYZ "end_header\n", "", "",
     0, 400, "18446744073709551616"},
    {"rows whose product wraps", PLY, BINARY "element vertex 357913942\n" XYZ "end_header\n", "",
     "$$$$$$$$", 0, 400, "ends"},
    {"a list of 2^32 - 1", PLY, BINARY POINT LIST "\xFF\xFF\xFF\x7F", "", "$$$$", 0, 400, ""},
    {"a list of -1", PLY, BINARY POINT LIST "\xFF\xFF\xFF\xFF", "", "$$$$", 0, 400, ""},
    {"rows of no bytes", PLY, BINARY "element x 4000000000\nelement vertex 0\n" XYZ "end_header\n",
     "", "", 0, 400, ""},
    {"lines that are not there", PLY, ASCII "element x 4000000000\nend_header\n", "", "", 0, 400,
     ""},
    {"4e9 vertices", OFF, "OFF\n4000000000 1 0\n0 0 0\n", "", "", 0, 400, ""},
    {"2^64 - 1 faces", OFF, "OFF\n1 18446744073709551615 0\n0 0 0\n", "", "", 0, 400, ""},
    {"2^32 - 1 corners", OFF, "OFF\n1 1 0\n0 0 0\n4294967295 0 0 0\n", "", "", 0, 400, ""},
    {"2^32 - 1 facets", STL, BLANKS "\xFF\xFF\xFF\xFF", "", "", 0, 400, "4294967295"},
    {"facets whose product wraps", STL, BLANKS "\x34\x33\x33\x05", "", "$$$$$$$$", 0, 400, ""},
    {"2^32 + 1", OBJ, THREE "f 1 2 4294967297\n", "", "", 0, 422, "line 4"},
    {"2^64 + 1", OBJ, THREE "f 1 2 18446744073709551617\n", "", "", 0, 422, "line 4"},
    {"the least integer", OBJ, THREE "f 1 2 -2147483648\n", "", "", 0, 422, "line 4"},
    {"UTF-16", OBJ, "\xFF\xFEv$ $0$ $0$ $0$\n$", "", "", 0, 422, ""},
    {"a face of four corners again and again", OBJ, THREE "v 1 1 0\nf", " 1 2 4 3", "\n", 4096, 422,
     "repeat"},
    {"a chunk of 4 GiB", GLB, "glTF\2$$$\x1C$$$\xF0\xFF\xFF\xFFJSON{}  ", "", "", 0, 400, ""},
    {"numbers of no bytes", GLTF, SCENE ACCESSOR "\"count\":4000000000}]}", "", "", 0, 413,
     "accessors/0"},
    {"a stride of 2^31 - 1", GLTF,
     SCENE VIEW "\"byteLength\":3,\"byteStride\":2147483647}]," ACCESSOR
                "\"bufferView\":0,\"count\":3}]}",
     "", "", 0, 400, "byteStride"},
    {"an offset that wraps", GLTF,
     SCENE VIEW "\"byteOffset\":18446744073709551608,\"byteLength\":16}]," ACCESSOR
                "\"bufferView\":0,\"count\":1}]}",
     "", "", 0, 400, "byteOffset"},
    {"an offset below 0", GLTF,
     SCENE VIEW "\"byteOffset\":-4,\"byteLength\":3}]," ACCESSOR "\"bufferView\":0,\"count\":1}]}",
     "", "", 0, 400, "byteOffset"},
    {"nodes in a ring", GLTF,
     ASSET "\"scene\":0,\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"children\":[0]}]}", "", "", 0,
     400, "nodes/0"},
    {"90,000 levels", GLTF, ASSET "\"x\":", "[", "", 90000, 400, "deeper"},
    {"a file of levels", GLTF, ASSET "\"x\":", "[", "", ONE, 400, "deeper"},
    {"a file of levels", JSON, "{\"x\":", "[", "", ONE, 400, "deeper"},
    {"a file of one number", JSON, "{\"vertices\":[[", "1", "", ONE, 400, ""},
    {"a file of one name", JSON, "{\"", "n", "", ONE, 400, ""},
    {"a file of blanks", JSON, "", BLANKS, "", ONE, 400, ""},
    {"a file of continued lines", OBJ, "v 0 0 0\nf", " 1\\\n", "", ONE, 422, ""},
    {"a file of one face", OBJ, "v 0 0 0\nf", " 1", "\n", ONE, 422, "repeat"},
    {"a file of one line", OBJ, "v ", "1", "", ONE, 400, ""},
    {"a file of unknown words", OBJ, "v 0 0 0\n", "word\n", "", ONE, 201, ""},
    {"a file of isolated vertices", OBJ, "", "v 0 0 0\n", "", ONE, 201, ""},
    {"a file of names", OBJ, THREE, "g a\ng b\nf 1 2 3\n", "", ONE, 422, ""},
    {"a file of one face", OFF, "OFF\n1 1 0\n0 0 0\n9999999", " 0", "\n", ONE, 400, ""},
    {"a file of blank lines", OFF, "OFF\n", "\n", "", ONE, 400, ""},
    {"a file of comments", PLY, ASCII, "comment x\n", "", ONE, 400, ""},
    {"a file of properties", PLY, ASCII "element vertex 1\n", "property int x\n", "", ONE, 400, ""},
    {"a file of words", STL, "solid\nfacet\n", "vertex 0 0 0\n", "", ONE, 400, ""},
    {"a file of one facet", STL, "solid\n",
     "facet\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n",
     "endsolid\n", ONE, 422, ""},
};

/* Returns a glTF with a tree of nodes, in which each level refers to the next one twice, so that
 * 2^40 meshes would have to be drawn. */
static char *double_nodes(size_t *length)
{
    size_t room = 8192, at;
    char *text = malloc(room);
    assert_non_null(text);
    at = (size_t)snprintf(
        text, room, ASSET "\"scene\":0,\"scenes\":[{\"nodes\":[0]}],\"meshes\":[],\"nodes\":[");
    for (int i = 1; i <= 40; i++) {
        at += (size_t)snprintf(text + at, room - at, "{\"children\":[%d,%d]},", i, i);
    }
    at += (size_t)snprintf(text + at, room - at, "{}]}");
    *length = at;
    return text;
}

static size_t put(char *to, const char *text)
{
    size_t length = strlen(text);
    for (size_t i = 0; i < length; i++) {
        to[i] = text[i] == '$' ? '\0' : text[i];
    }
    return length;
}

static char *bytes_of(const trap *t, size_t *length)
{
    char *bytes = malloc(t->size + 3 * (size_t)ROOM);
    assert_non_null(bytes);
    size_t at = put(bytes, t->before);
    while (at < t->size) {
        at += put(bytes + at, t->part);
    }
    *length = at + put(bytes + at, t->after);
    return bytes;
}

/* The latest result of time_ordinary(). */
static double ordinary;

/* A body to send. `what` describes it in messages, `coding` NULL means that it is not compressed,
 * and `size` is its length after decompression. */
typedef struct upload {
    const char *what, *type, *coding;
    const char *bytes;
    size_t length, size;
} upload;

/* Sends a body; `took` becomes the processor time that the daemon used for it. */
static reply put_body(client *c, const daemon_process *d, const upload *u, double *took)
{
    char content[60], encoding[60];
    snprintf(content, sizeof content, "Content-Type: %s", u->type);
    snprintf(encoding, sizeof encoding, "Content-Encoding: %s", u->coding == NULL ? "" : u->coding);
    const char *const headers[] = {content, u->coding == NULL ? NULL : encoding, NULL};
    const client_request request = {"PUT", "/v1/meshes/trap", headers, u->bytes, u->length};
    double start = daemon_cpu(d);
    reply r = client_send_bytes(c, &request);
    /* If the daemon answers before it has the whole of a long body, it waits a while for the rest
     * and then closes the connection. A client that is still sending may then lose the answer, so
     * the request is sent again. */
    for (int tries = 0; tries < 10 && r.status < 200; tries++) {
        reply_free(&r);
        start = daemon_cpu(d);
        r = client_send_bytes(c, &request);
    }
    *took = daemon_cpu(d) - start;
    return r;
}

/* Returns the processor time that the daemon now takes to import an ordinary file of ONE bytes. */
static double time_ordinary(client *c, const daemon_process *d)
{
    static const trap triangles = {
        .part = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\n", .before = "", .after = "", .size = ONE};
    size_t length;
    char *bytes = bytes_of(&triangles, &length);
    double took;
    const upload u = {"triangles", OBJ, NULL, bytes, length, length};
    reply_done(reply_expect(201, put_body(c, d, &u, &took)));
    reply_done(reply_expect(204, client_send(c, "DELETE", "/v1/meshes/trap", NULL, NULL)));
    free(bytes);
    return took;
}

/* Sends a body, and fails the test if the daemon takes more processor time or memory than a body of
 * this size may take after decompression. */
static reply send(client *c, const daemon_process *d, const upload *u)
{
    const char *what = u->what, *type = u->type;
    const size_t size = u->size;
    double took, most;
    reply r = put_body(c, d, u, &took);
    for (int tries = 1;; tries++) {
        most = TIMES_ORDINARY * ordinary * (size > ONE ? (double)size / ONE : 1);
        if (took <= most) {
            break;
        }
        if (tries == PACE_TRIES) {
            fail_msg("%s, %s: %.2f s for %zu bytes, %.2f s for an ordinary file", type, what, took,
                     size, ordinary);
        }
        reply_free(&r);
        ordinary = time_ordinary(c, d);
        r = put_body(c, d, u, &took);
    }
    size_t peak = daemon_peak(d);
    /* the daemon may hold the body, and the triangle soup or mesh made from it */
    if (counts_memory && peak > OVER + 2 * (size_t)ONE + 40 * 1024 * 1024) {
        fail_msg("%s, %s: %zu MB", type, what, peak >> 20);
    }
    print_message("%s, %s, %s: %ld, %.3f s, %zu MB\n", type, what,
                  u->coding == NULL ? "plain" : u->coding, r.status, took, peak >> 20);
    return r;
}

static void try_trap(client *c, const daemon_process *d, const trap *t, const char *bytes,
                     size_t length)
{
    reply r = send(c, d, &(upload){t->what, t->type, NULL, bytes, length, length});
    if (r.status != t->status || strstr(r.body, t->words) == NULL) {
        fail_msg("%s, %s: %ld instead of %ld with %s: %.300s", t->type, t->what, r.status,
                 t->status, t->words, r.body);
    }
    reply_free(&r);
    /* In gzip, a body that decompresses to more than a hundred times its length may also be refused
     * for that reason (413). */
    size_t packed;
    char *coded = coding_pack("gzip", bytes, length, &packed);
    r = send(c, d, &(upload){t->what, t->type, "gzip", coded, packed, length});
    if (r.status != t->status && !(r.status == 413 && length > 100 * packed)) {
        fail_msg("%s, %s in gzip: %ld instead of %ld: %.300s", t->type, t->what, r.status,
                 t->status, r.body);
    }
    reply_free(&r);
    free(coded);
    r = client_send(c, "DELETE", "/v1/meshes/trap", NULL, NULL);
    assert_int_equal(r.status, t->status == 201 ? 204 : 404);
    reply_free(&r);
}

static void traps_get_their_answer_in_time_and_memory(void **state)
{
    (void)state;
    daemon_process *d = daemon_start((const char *const[]){"--log", "off", NULL});
    client *c = client_new(d);
    ordinary = time_ordinary(c, d);
    print_message("note: an ordinary file: %.3f s\n", ordinary);
    for (size_t i = 0; i < sizeof traps / sizeof *traps; i++) {
        size_t length;
        char *bytes = bytes_of(&traps[i], &length);
        try_trap(c, d, &traps[i], bytes, length);
        free(bytes);
    }
    const trap nodes = {"2^40 nodes", GLTF, "", "", "", 0, 400, "node 40"};
    size_t length;
    char *text = double_nodes(&length);
    try_trap(c, d, &nodes, text, length);
    free(text);
    reply_done(reply_expect(200, client_get(c, "/v1/meshes")));
    client_free(c);
    assert_int_equal(daemon_stop(d), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(traps_get_their_answer_in_time_and_memory)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
