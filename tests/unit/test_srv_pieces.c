/* Large documents written in pieces by several threads. They must be, byte by byte, the documents
 * that one thread writes. */
#include "unit/format_fixture.h"

#include "edit/local/erase.h"
#include "model/random.h"
#include "system/parallel.h"
#include "tests/failing.h"
#include "tests/sanitized.h"
#include "tests/seed.h"

/* --- the mesh --- */

/* A text that grows. */
typedef struct text {
    char *bytes;
    size_t length, capacity;
} text;

static void add(text *t, const char *format, ...) __attribute__((format(printf, 2, 3)));
static void add(text *t, const char *format, ...)
{
    enum { LINE = 200 };
    va_list args;
    if (t->capacity - t->length < LINE) {
        t->capacity = 2 * t->capacity + LINE;
        t->bytes = realloc(t->bytes, t->capacity);
        assert_non_null(t->bytes);
    }
    va_start(args, format);
    t->length += (size_t)vsnprintf(t->bytes + t->length, LINE, format, args);
    va_end(args);
}

/* Writes an OBJ file of a grid of SIDE x SIDE squares, some of them cut into triangles, with
 * texture coordinates and normals of corners, colours of vertices, and lines that begin objects,
 * groups, materials and smoothing groups at random places. */
static void add_grid(text *t, md_random *r)
{
    enum { SIDE = 140, ROW = SIDE + 1, CHANGES = 2 };
    static const char *const keywords[] = {"o part", "g group", "usemtl stuff", "s "};
    for (uint32_t i = 0; i < ROW * ROW; i++) {
        add(t, "v %u %u %.17g %.3f 0.5 0.25\n", i % ROW, i / ROW, md_unit(r), md_unit(r));
        add(t, "vt %.6f %.6f\nvn 0 0 1\n", md_unit(r), md_unit(r));
    }
    for (uint32_t i = 0; i < SIDE * SIDE; i++) {
        uint32_t a = i / SIDE * ROW + i % SIDE + 1, b = a + 1, c = b + ROW, d = a + ROW;
        uint32_t uv = md_from(r, 1, ROW * ROW);
        if (md_chance(r, CHANGES)) {
            add(t, "%s%u\n", keywords[md_below(r, 4)], md_below(r, 5));
        }
        if (md_chance(r, 30)) {
            add(t, "f %u/%u/%u %u/%u/%u %u/%u/%u\n", a, a, a, b, b, b, c, c, c);
            add(t, "f %u/%u/%u %u/%u/%u %u/%u/%u\n", a, a, a, c, c, c, d, uv, d);
        } else {
            add(t, "f %u/%u/%u %u/%u/%u %u/%u/%u %u/%u/%u\n", a, a, a, b, b, b, c, c, c, d, uv, d);
        }
    }
}

/* Deletes about one face in eight, with the vertices that belonged to no other face, and long rows
 * of faces, so that whole pieces are empty. */
static void delete_faces(he_mesh *mesh, md_random *r)
{
    uint32_t faces = mesh->c.faces.issued, from = md_below(r, faces / 2), to = from + faces / 3;
    for (uint32_t f = 0; f < faces; f++) {
        if ((f >= from && f < to) || md_chance(r, 12)) {
            he_error err = {0};
            if (he_face_delete(mesh, &f, 1, md_chance(r, 20), &err) != HE_OK) {
                fail_msg("%s", err.text);
            }
        }
    }
}

static he_mesh *grid(md_random *r)
{
    text t = {0};
    add_grid(&t, r);
    he_mesh *mesh = mesh_of_text("obj", t.bytes);
    free(t.bytes);
    return mesh;
}

/* A mesh with two faces, one on each side of a loop of so many edges that neither fits into the
 * buffer of a piece. */
static he_mesh *coin(void)
{
    enum { EDGES = 150000 };
    text t = {0};
    for (uint32_t i = 0; i < EDGES; i++) {
        add(&t, "v %u %u 0\n", i, i % 3);
    }
    for (int side = 0; side < 2; side++) {
        add(&t, "f");
        for (uint32_t i = 0; i < EDGES; i++) {
            add(&t, " %u", side == 0 ? i + 1 : EDGES - i);
        }
        add(&t, "\n");
    }
    he_mesh *mesh = mesh_of_text("obj", t.bytes);
    free(t.bytes);
    return mesh;
}

/* --- writing --- */

/* A document in memory; the caller frees its bytes. */
typedef struct document {
    char *bytes;
    size_t length;
} document;

/* Writes the mesh in the format and encoding, on the threads of `parallel` if that is not NULL.
 * Returns the status of he_writer_new. */
static he_status write_on(const he_format *format, size_t encoding, const he_mesh *mesh,
                          const he_parallel *parallel, document *out)
{
    he_writer *writer = NULL;
    he_error err = {0};
    he_progress progress;
    he_progress_init(&progress, NULL, NULL);
    progress.parallel = parallel;
    he_status status = he_writer_new(format, mesh, encoding, &progress, &writer, &err);
    if (status != HE_OK) {
        return status;
    }
    static const size_t sizes[] = {131072, 700, 4096, 511, 1000000, 1};
    size_t capacity = 0, n = 0;
    *out = (document){NULL, 0};
    for (size_t turn = 0;; turn++) {
        size_t size = sizes[turn % (sizeof sizes / sizeof *sizes)];
        if (capacity - out->length < size) {
            capacity = 2 * capacity + size;
            out->bytes = realloc(out->bytes, capacity);
            assert_non_null(out->bytes);
        }
        n = he_writer_read(writer, out->bytes + out->length, size);
        if (n == 0) {
            break;
        }
        out->length += n;
    }
    he_writer_free(writer);
    return HE_OK;
}

/* How many threads help the one that reads. */
static const uint32_t hand_counts[] = {9, 1};
enum { HAND_COUNTS = SANITIZED ? 1 : 2 };

/* Returns true if several threads can write documents of the format. */
static bool is_cut(const he_format *format)
{
    return format->writing != NULL && format->writing->cut != NULL;
}

static void require_equal_documents(const he_mesh *mesh)
{
    const he_format *format;
    for (size_t i = 0; (format = he_format_at(i)) != NULL; i++) {
        for (size_t e = 0; is_cut(format) && format->encodings[e] != NULL; e++) {
            document alone;
            assert_int_equal(write_on(format, e, mesh, NULL, &alone), HE_OK);
            for (size_t k = 0; k < HAND_COUNTS; k++) {
                document together;
                st_parallel *hands = st_parallel_new(hand_counts[k]);
                assert_non_null(hands);
                assert_int_equal(write_on(format, e, mesh, st_parallel_host(hands), &together),
                                 HE_OK);
                st_parallel_free(hands);
                if (alone.length != together.length ||
                    memcmp(alone.bytes, together.bytes, alone.length) != 0) {
                    fail_msg("%s %s differs with %u more threads", format->name,
                             format->encodings[e], hand_counts[k]);
                }
                free(together.bytes);
            }
            free(alone.bytes);
        }
    }
}

/* --- tests --- */

static void pieces_make_the_document_that_one_thread_writes(void **state)
{
    (void)state;
    md_random r = {seed_of_run()};
    for (int round = 0; round < (SANITIZED ? 1 : 2); round++) {
        he_mesh *mesh = grid(&r);
        if (!SANITIZED) {
            require_equal_documents(mesh);
        }
        delete_faces(mesh, &r);
        require_equal_documents(mesh);
        he_mesh_free(mesh);
    }
}

static void a_row_longer_than_a_piece_is_written_whole(void **state)
{
    (void)state;
    he_mesh *mesh = coin();
    require_equal_documents(mesh);
    he_mesh_free(mesh);
}

/* Threads that want memory for pieces and get none leave the document to one thread. */
static void without_memory_for_pieces_one_thread_writes(void **state)
{
    (void)state;
    md_random r = {seed_of_run()};
    he_mesh *mesh = grid(&r);
    st_parallel *hands = st_parallel_new(1);
    const he_format *format = he_format_find("off");
    document wanted, got;
    unsigned refused = 0, written = 0;
    assert_int_equal(write_on(format, 0, mesh, NULL, &wanted), HE_OK);
    failing f = {.may_succeed = true, .what = "writing in pieces"};
    while (failing_next(&f)) {
        he_status status = write_on(format, 0, mesh, st_parallel_host(hands), &got);
        if (failing_status(&f, status)) {
            assert_int_equal(got.length, wanted.length);
            assert_memory_equal(got.bytes, wanted.bytes, wanted.length);
            free(got.bytes);
            written++;
        } else {
            refused++;
        }
    }
    assert_true(refused > 0 && written > 4);
    free(wanted.bytes);
    st_parallel_free(hands);
    he_mesh_free(mesh);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pieces_make_the_document_that_one_thread_writes),
        cmocka_unit_test(a_row_longer_than_a_piece_is_written_whole),
        cmocka_unit_test(without_memory_for_pieces_one_thread_writes),
    };
    return cmocka_run_group_tests_name("srv_pieces", tests, NULL, NULL);
}
