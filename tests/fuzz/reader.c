#include "fuzz/reader.h"

#include "fuzz/fuzz.h"
#include "fuzz/pieces.h"
#include "query/topology.h"
#include "repair/repair.h"
#include "unit/format_fixture.h"

/* Reads a file in pieces of random sizes. */
static he_status read_cut(const format_file *file, md_random *random, he_import *out, he_error *err)
{
    he_reader *reader = NULL;
    he_status status = he_reader_new(he_format_find(file->format), NULL, &reader, err);
    const uint32_t most = 1u << md_below(random, 11);
    fuzz_pieces pieces = {file->bytes, file->length, most, random, 0};
    char *piece;
    size_t n;
    while (status == HE_OK && (piece = fuzz_pieces_next(&pieces, &n)) != NULL) {
        status = he_reader_feed(reader, piece, n, err);
        free(piece);
    }
    if (status == HE_OK) {
        status = he_reader_finish(reader, out, err);
    }
    he_reader_free(reader);
    return status;
}

static he_import read_again(const char *format, const void *bytes, size_t size)
{
    he_import import = {0};
    he_error err = {0};
    const format_file file = {format, bytes, size};
    he_status status = read_pieces(&file, 0, NULL, &import, &err);
    FUZZ_REQUIRE(status == HE_OK, "%s: %s", format, err.text);
    return import;
}

/* --- writing --- */

/* Returns the format to write: a glTF that was read as JSON is written in the binary container. */
static const char *writer_of(const char *format)
{
    return strcmp(format, "gltf") == 0 ? "glb" : format;
}

static uint32_t corners_of(const he_mesh *mesh)
{
    return 2 * he_mesh_edges(mesh) - he_mesh_boundary_halfedges(mesh);
}

/* How often a mesh must be written and read until further files equal each other. NEVER: they need
 * not be equal; AT_ONCE: the second file equals the first; ROUNDED: the third file equals the
 * second, because the first reading may round positions and cut polygons. */
enum { NEVER, AT_ONCE, ROUNDED };

/* Writes a mesh in one encoding of a format and reads it again: it must have the same size, except
 * in STL, which has no shared vertices. */
static void write_and_read(const he_mesh *mesh, const char *format, const char *encoding,
                           int repeats, md_random *random)
{
    size_t length, length_again;
    char *first = write_encoded(format, encoding, mesh, md_from(random, 1, 5000), NULL, &length);
    he_import import = read_again(format, first, length);
    bool numbered = strcmp(format, "stl") != 0;
    if (numbered || repeats != NEVER) {
        he_mesh *again = NULL;
        he_error err = {0};
        he_status status = he_build(&import.soup, 0, &again, NULL, &err);
        FUZZ_REQUIRE(status == HE_OK, "%s %s: %s", format, encoding, err.text);
        if (numbered) {
            assert_int_equal(he_mesh_vertices(again), he_mesh_vertices(mesh));
            assert_int_equal(he_mesh_faces(again), he_mesh_faces(mesh));
            assert_int_equal(corners_of(again), corners_of(mesh));
        }
        /* A mesh without faces can have an empty table of the format, which the reader does not
         * restore completely, so the second file is compared only if there are faces. */
        if (repeats == AT_ONCE && he_mesh_faces(mesh) > 0) {
            char *repeated = write_encoded(format, encoding, again, md_from(random, 1, 5000), NULL,
                                           &length_again);
            assert_int_equal(length_again, length);
            assert_memory_equal(repeated, first, length);
            free(repeated);
        }
        if (repeats == ROUNDED) {
            write_and_read(again, format, encoding, AT_ONCE, random);
        }
        he_mesh_free(again);
    }
    he_import_clear(&import);
    free(first);
}

/* Returns whether the format can hold the mesh: a coordinate may be too large for the floats of
 * some formats. */
static bool can_write(const he_mesh *mesh, const he_format *format, const char *encoding)
{
    he_writer *writer = NULL;
    he_error err = {0};
    size_t number = (size_t)he_format_encoding(format, encoding);
    he_status status = he_writer_new(format, mesh, number, NULL, &writer, &err);
    FUZZ_REQUIRE(status == HE_OK || status == HE_BEYOND_FLOAT, "%s: %s", format->name, err.text);
    he_writer_free(writer);
    return status == HE_OK;
}

/* Writes the mesh in its own format and, at random, in the other formats. A text encoding keeps all
 * digits of a position; STL keeps them only if the mesh was not changed after it was read. */
static void write_all_formats(const he_mesh *mesh, const char *own, bool repaired,
                              md_random *random)
{
    own = writer_of(own);
    const he_format *row;
    for (size_t i = 0; (row = he_format_at(i)) != NULL; i++) {
        bool mine = strcmp(row->name, own) == 0, stl = strcmp(row->name, "stl") == 0;
        if (row->writing == NULL || row->reading == NULL || (!mine && !md_chance(random, 25))) {
            continue;
        }
        size_t encodings = 0;
        while (row->encodings[encodings] != NULL) {
            encodings++;
        }
        const char *encoding = row->encodings[md_below(random, (uint32_t)encodings)];
        if (!can_write(mesh, row, encoding)) {
            continue;
        }
        bool varies = stl && (repaired || strcmp(encoding, "ascii") != 0);
        /* A repair may leave labels (names of groups or materials) that no face uses. They are not
         * written, so they are gone after the mesh was written and read once. */
        bool rounds = repaired || strcmp(row->name, "glb") == 0;
        int repeats = !mine || varies ? NEVER : rounds ? ROUNDED : AT_ONCE;
        write_and_read(mesh, row->name, encoding, repeats, random);
    }
}

/* --- repairing --- */

typedef struct subject {
    const char *format;
    const void *bytes;
    size_t size;
    md_random random;
} subject;

static void require_report(const he_report *report, size_t vertices, size_t faces)
{
    assert_true(report->total > 0);
    for (size_t i = 0; i < report->total && i < HE_REPORT_DEFECTS; i++) {
        const he_defect *defect = &report->defects[i];
        char text[256];
        he_defect_text(defect, text, sizeof text);
        assert_true(defect->id < (defect->kind == HE_FACE ? faces : vertices));
    }
}

/* Reads the input again and applies a set of repairs. If the mesh is accepted, it must pass
 * he_check. If it is refused, returns the set of repairs that the refusal advises, or 0 if it
 * advises none. */
static unsigned mend(subject *s, unsigned which)
{
    he_repair_plan plan = {.which = which,
                           .tolerance = md_chance(&s->random, 50) ? 0 : md_unit(&s->random),
                           .hole_edges = 3 + md_below(&s->random, 8)};
    he_import import = read_again(s->format, s->bytes, s->size);
    size_t vertices = import.soup.vertex_count, faces = import.soup.face_count;
    he_repaired done = {0};
    he_report report = {.total = 0};
    he_error err = {0};
    he_mesh *mesh = NULL;
    unsigned advised = 0;
    he_status status = he_repair_soup(&import.soup, &plan, &done, &err);
    if (status == HE_OK) {
        status = he_build(&import.soup, 0, &mesh, &report, &err);
    } else {
        assert_int_equal(status, HE_NOT_ORIENTABLE);
    }
    if (status == HE_OK) {
        status = he_repair_mesh(mesh, &plan, &done, &err);
        FUZZ_REQUIRE(status == HE_OK, "%s", err.text);
        fixture_check(mesh);
        write_all_formats(mesh, s->format, true, &s->random);
    } else {
        if (status != HE_NOT_ORIENTABLE) {
            he_repaired_report(&done, &report);
            require_report(&report, vertices, faces);
        }
        assert_int_equal(he_repair_advise(&import.soup, which, &advised, &err), HE_OK);
        assert_true(advised == 0 || (advised & which) == which);
        assert_true(advised != 0 || report.total > 0);
    }
    he_mesh_free(mesh);
    he_repaired_clear(&done);
    he_import_clear(&import);
    return advised;
}

/* Requires that the advised repairs suffice. They are applied with the tolerance for which they
 * were advised: with another one, other vertices would be merged and other defects appear. */
static void mend_as_advised(subject *s, unsigned which)
{
    md_random random = s->random;
    unsigned advised = mend(s, which);
    if (advised != 0) {
        s->random = random; /* both repairs must draw the same tolerance */
        FUZZ_REQUIRE(mend(s, advised) == 0, "%#x, advised after %#x, is not enough", advised,
                     which);
    }
}

/* --- the whole check --- */

static void require_place(const he_error *err)
{
    FUZZ_REQUIRE(err->place != HE_PLACE_NONE, "no place: %s", err->text);
}

void fuzz_reader(const char *format, const void *bytes, size_t size)
{
    subject s = {format, bytes, size, {fuzz_hash(bytes, size)}};
    he_import import = {0}, other = {0};
    he_error err = {0}, second = {0};
    const format_file file = {format, bytes, size};
    he_status status = read_pieces(&file, 0, NULL, &import, &err);
    assert_int_equal(read_cut(&file, &s.random, &other, &second), status);
    if (status != HE_OK) {
        bool same =
            strcmp(err.text, second.text) == 0 && err.place == second.place && err.at == second.at;
        FUZZ_REQUIRE(same, "whole %s %llu, in pieces %s %llu", err.text, (unsigned long long)err.at,
                     second.text, (unsigned long long)second.at);
        require_place(&err);
        return;
    }
    expect_same_imports(&import, &other);
    he_import_clear(&other);
    he_mesh *mesh = NULL;
    he_report report = {.total = 0};
    status = he_build(&import.soup, 0, &mesh, &report, &err);
    if (status == HE_OK) {
        he_ids bowties = {0};
        fixture_check(mesh);
        assert_int_equal(he_bowties_find(mesh, &bowties, NULL), HE_OK);
        he_ids_clear(&bowties);
        write_all_formats(mesh, format, false, &s.random);
    } else {
        require_report(&report, import.soup.vertex_count, import.soup.face_count);
        he_import_locate(&import, &err);
        require_place(&err);
        mend_as_advised(&s, 0);
    }
    he_mesh_free(mesh);
    he_import_clear(&import);
    mend_as_advised(&s, md_below(&s.random, 1u << HE_REPAIR_COUNT));
}
