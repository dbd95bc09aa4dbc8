/* Text and binary STL files: reading, errors, and writing. */
#include "unit/format_fixture.h"
#include "tests/failing.h"

#include <float.h>
#include <math.h>

/* --- binary files, built from facets --- */

enum { HEADER = 84, FACET = 50 };

typedef struct file {
    unsigned char bytes[HEADER + 16 * FACET];
    size_t length;
} file;

static void put_word(file *f, uint32_t word)
{
    assert_true(f->length + 4 <= sizeof f->bytes);
    for (unsigned shift = 0; shift < 32; shift += 8) {
        f->bytes[f->length++] = (unsigned char)(word >> shift);
    }
}

static void begin(file *f, const char *header, uint32_t count)
{
    memset(f, 0, sizeof *f);
    memcpy(f->bytes, header, strlen(header));
    f->length = HEADER - 4;
    put_word(f, count);
}

static void put_facet(file *f, const float *corners, unsigned attribute)
{
    float values[12] = {NAN, 0, INFINITY};
    memcpy(values + 3, corners, 9 * sizeof *corners);
    for (size_t i = 0; i < 12; i++) {
        uint32_t bits;
        memcpy(&bits, &values[i], sizeof bits);
        put_word(f, bits);
    }
    f->bytes[f->length++] = (unsigned char)attribute;
    f->bytes[f->length++] = (unsigned char)(attribute >> 8);
}

/* The facets of a tetrahedron. Some coordinates are 0 and some are -0; the reader must treat them
 * as equal. */
static const float facets[4][9] = {{0, 0, 0, 0, 1, 0, 1, 0, 0},
                                   {-0.0f, 0, 0, 1, 0, 0, 0, 0, 1},
                                   {0, -0.0f, -0.0f, 0, 0, 1, -0.0f, 1, 0},
                                   {1, 0, 0, 0, 1, -0.0f, 0, -0.0f, 1}};
static const uint32_t tetrahedron[] = {0, 1, 2, 0, 2, 3, 0, 3, 1, 2, 1, 3};

static he_import read_file(const file *f)
{
    he_import import = {0};
    he_error err = {0};
    if (read_bytes("stl", f->bytes, f->length, &import, &err) != HE_OK) {
        fail_msg("%s", err.text);
    }
    return import;
}

static void binary_is_welded(void **state)
{
    (void)state;
    static const char *const headers[] = {"", "made by hand", "solid", "solid name\nfacet normal",
                                          "  SOLID of any length that fits into the header"};
    for (size_t i = 0; i < sizeof headers / sizeof *headers; i++) {
        for (size_t stray = 0; stray < FACET; stray += 1 + stray * 3) {
            file f;
            begin(&f, headers[i], 4);
            for (size_t k = 0; k < 4; k++) {
                put_facet(&f, facets[k], 0);
            }
            f.length += stray;
            he_import import = read_file(&f);
            expect_counts(&import, 4, 4, 12);
            expect_corners(&import, tetrahedron, 12);
            expect_warning(&import, "welded", "", 8, 0);
            assert_int_equal(import.warnings.count, 1 + (stray > 0));
            if (stray > 0) {
                expect_warning(&import, "trailing_bytes", "", 1, HEADER + 4 * FACET);
            }
            static const uint64_t places[] = {0, 0, 0, FACET};
            for (uint32_t k = 0; k < 4; k++) {
                assert_int_equal(he_source_map_find(&import.faces, k), HEADER + FACET * k);
                assert_int_equal(he_source_map_find(&import.vertices, k), HEADER + places[k]);
            }
            he_mesh *mesh = build_import(&import);
            fixture_counts(mesh, 4, 6, 4);
            he_mesh_free(mesh);
            he_import_clear(&import);
        }
    }
}

static void attribute_bytes_are_noted(void **state)
{
    (void)state;
    file f;
    begin(&f, "COLOR=\xFF\xFF\xFF\xFF", 3);
    put_facet(&f, facets[0], 0);
    put_facet(&f, facets[1], 0x8000);
    put_facet(&f, facets[2], 1);
    he_import import = read_file(&f);
    expect_warning(&import, "attribute_bytes", "", 2, HEADER + FACET);
    he_import_clear(&import);
    begin(&f, "nothing", 0);
    import = read_file(&f);
    expect_counts(&import, 0, 0, 0);
    assert_int_equal(import.warnings.count, 0);
    he_import_clear(&import);
}

static void wrong_bytes_name_their_place(void **state)
{
    (void)state;
    file f;
    begin(&f, "x", 4);
    for (size_t k = 0; k < 4; k++) {
        put_facet(&f, facets[k], 0);
    }
    for (size_t length = 0; length < HEADER; length++) {
        expect_refused_at_byte(&(format_file){"stl", f.bytes, length}, HE_SYNTAX, length,
                               "not an STL file");
    }
    for (size_t length = HEADER; length < f.length; length++) {
        char words[60];
        snprintf(words, sizeof words, "after %zu of the 4 facets", (length - HEADER) / FACET);
        expect_refused_at_byte(&(format_file){"stl", f.bytes, length}, HE_SYNTAX, length, words);
    }
    static const struct {
        uint32_t count;
        he_status status;
        uint64_t at;
        const char *words;
    } rows[] = {
        {3, HE_SYNTAX, HEADER + 3 * FACET, "more than the 3 facets"},
        {0, HE_SYNTAX, HEADER, "more than the 0 facets"},
        {5, HE_SYNTAX, HEADER + 4 * FACET, "after 4 of the 5 facets"},
        {85899346, HE_SYNTAX, HEADER + 4 * FACET, "after 4 of the 85899346 facets"},
        {2147483647, HE_BAD_VALUE, 80, "it would have 2147483647 facets"},
        {4294967295, HE_BAD_VALUE, 80, "it would have 4294967295 facets"},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        size_t length = f.length;
        f.length = HEADER - 4;
        put_word(&f, rows[i].count);
        f.length = length;
        expect_refused_at_byte(&(format_file){"stl", f.bytes, f.length}, rows[i].status, rows[i].at,
                               rows[i].words);
    }
    static const float wrong[][9] = {{0, 0, 0, 0, NAN, 0, 1, 0, 0},
                                     {0, 0, 0, 0, 0, 0, 0, 0, INFINITY}};
    for (size_t i = 0; i < 2; i++) {
        begin(&f, "x", 2);
        put_facet(&f, facets[0], 0);
        put_facet(&f, wrong[i], 0);
        expect_refused_at_byte(&(format_file){"stl", f.bytes, f.length}, HE_NOT_FINITE,
                               HEADER + FACET, "not finite");
    }
    /* The reader accepts a facet with repeated corners, which is refused later, when the mesh is
     * built. */
    static const float thin[9] = {0, 1, 0, -0.0f, 1, 0, 1, 0, 0};
    begin(&f, "x", 3);
    put_facet(&f, facets[0], 0);
    put_facet(&f, facets[1], 0);
    put_facet(&f, thin, 0);
    he_import import = read_file(&f);
    he_mesh *mesh = NULL;
    he_error err = {0};
    assert_int_equal(he_build(&import.soup, 0, &mesh, NULL, &err), HE_REPEATED_CORNER);
    he_import_locate(&import, &err);
    assert_int_equal(err.place, HE_PLACE_BYTE);
    assert_int_equal(err.at, HEADER + 2 * FACET);
    he_import_clear(&import);
}

/* --- text --- */

#define ONE                                                                                  \
    " facet normal 0 0 1\n  outer loop\n   vertex 0 0 0\n   vertex 1 0 0\n   vertex 0 1 0\n" \
    "  endloop\n endfacet\n"
#define TWO                                                                                     \
    " facet normal 0 0 1\n  outer loop\n   vertex 1 0 0\n   vertex 1 1 0\n   vertex -0 1 0.0\n" \
    "  endloop\n endfacet\n"

static void text_in_all_its_forms(void **state)
{
    (void)state;
    static const uint32_t corners[] = {0, 1, 2, 1, 3, 2};
    static const char *const texts[] = {
        "solid\n" ONE TWO "endsolid\n",
        "solid name\r\n" ONE TWO "endsolid name",
        "\n \tSolid NAME\n" ONE "FACET NORMAL 0 0 1\nOUTER LOOP\nVERTEX 1 0 0\nVERTEX 1 1 0\n"
        "VERTEX 0 1 0\nENDLOOP\nENDFACET\nENDSOLID\n",
        "\xEF\xBB\xBFsolid\n" ONE
        "\tfacet\tnormal\t0\t0\t1\n\tOuter\tLoop\n\t\tvertex\t1e0\t.0\t+0\n"
        "\t\tvertex\t1.\t1\t0\n\t\tvertex\t0\t1\t0\n\tendLoop\n\tendFacet\n\nendsolid\n",
        "solid\nfacet normal nan -nan(ind) 1.#QNAN\nouter loop vertex 0 0\n0 vertex 1 0 0 vertex\n"
        "0 1 0 endloop endfacet facet normal 0 0 1 outer loop\nvertex 1 0 0\nvertex 1 1 0\n"
        "vertex 0 1 0\nendloop\nendfacet\nendsolid\n",
        "solid\nfacet\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 "
        "0\nendloop\nendfacet\n" TWO "endsolid one\n",
    };
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        he_import import = read_text("stl", texts[i]);
        expect_counts(&import, 4, 2, 6);
        expect_corners(&import, corners, 6);
        expect_warning(&import, "welded", "", 2, 0);
        assert_int_equal(import.warnings.count, 1);
        he_import_clear(&import);
    }
}

static void several_solids_keep_their_names(void **state)
{
    (void)state;
    he_import import = read_text("stl", "solid\n" ONE "endsolid\nsolid  left arm \n" TWO ONE
                                        "endsolid left arm\nSOLID K\xF6rper\n" TWO "endsolid\n");
    expect_counts(&import, 4, 4, 12);
    assert_string_equal(face_label(&import, "object", 0), "");
    assert_string_equal(face_label(&import, "object", 1), "left arm");
    assert_string_equal(face_label(&import, "object", 2), "left arm");
    assert_string_equal(face_label(&import, "object", 3), "K\xC3\xB6rper");
    expect_warning(&import, "not_utf8", "K?rper", 1, 26);
    assert_int_equal(he_source_map_find(&import.faces, 1), 11);
    assert_int_equal(he_source_map_find(&import.faces, 2), 18);
    assert_int_equal(he_source_map_find(&import.vertices, 0), 4);
    assert_int_equal(he_source_map_find(&import.vertices, 3), 14);
    he_import_clear(&import);
}

static void what_does_not_belong_is_noted(void **state)
{
    (void)state;
    he_import import = read_text("stl", "solid\ncolor 1 0 0\nfacet normal 0 0 1\nouter loop\n"
                                        "vertex 0 0 0 1\nvertex 1 0 0\nvertex 0 1 0\nendloop\n"
                                        "endfacet\ncolor vertex\n");
    expect_counts(&import, 3, 1, 3);
    expect_warning(&import, "unknown_keyword", "color", 2, 2);
    expect_warning(&import, "unknown_keyword", "1", 1, 5);
    expect_warning(&import, "no_endsolid", "", 1, 10);
    assert_int_equal(import.warnings.count, 3);
    he_import_clear(&import);
    import = read_text("stl", "solid nothing\nendsolid nothing\n");
    expect_counts(&import, 0, 0, 0);
    assert_int_equal(import.warnings.count, 0);
    he_import_clear(&import);
}

static void wrong_text_names_its_line(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        he_status status;
        uint64_t line;
        const char *words;
    } rows[] = {
        {"solid state physics\nis fun\n", HE_SYNTAX, 2, "not an STL file"},
        {"solid\nvertex 0 0 0\n", HE_SYNTAX, 2, "'vertex' is outside a facet"},
        {"solid\n" ONE "endfacet\n", HE_SYNTAX, 9, "'endfacet' is outside a facet"},
        {"solid\nfacet\nvertex 0 0 0\nvertex 1 0 0\nendfacet\n", HE_SYNTAX, 5,
         "a facet has 2 corners"},
        {"solid\nfacet\nvertex 0 0 0\nvertex 1 0 0\nvertex 2 0 0\nvertex 3 0 0\n", HE_SYNTAX, 6,
         "begins a fourth vertex in a facet"},
        {"solid\nfacet\nvertex 0 0 a\n", HE_SYNTAX, 3, "'a' is not a number"},
        {"solid\nfacet\nvertex 0 0\nendfacet\n", HE_SYNTAX, 4, "'endfacet' is not a number"},
        {"solid\nfacet\nvertex 0 nan 0\n", HE_NOT_FINITE, 3, "'nan' is not finite"},
        {"solid\nfacet\nvertex 1e999 0 0\n", HE_NOT_FINITE, 3, "is not finite"},
        {"solid\nfacet\nvertex 0 0 0\nfacet\n", HE_SYNTAX, 4, "'facet' comes inside a facet"},
        {"solid\nfacet\nvertex 0 0 0\nsolid x\n", HE_SYNTAX, 4, "'solid' comes inside"},
        {"solid\nfacet\nvertex 0 0 0\nendsolid\n", HE_SYNTAX, 4, "'endsolid' comes inside"},
        {"solid\n" ONE "facet normal 0 0 1\n", HE_SYNTAX, 9, "ends inside a facet"},
        {"solid\nfacet\nvertex 0 0 0\nvertex 1", HE_SYNTAX, 4, "ends inside a facet"},
        {"solid a\x01b\n" ONE, HE_SYNTAX, 1, "control character"},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        expect_refused("stl", rows[i].text, rows[i].status, rows[i].line, rows[i].words);
    }
    he_import import = read_text("stl", "solid\n" ONE TWO "facet\nvertex 0 0 0\nvertex 1 1 0\n"
                                        "vertex 0 0 -0\nendfacet\nendsolid\n");
    he_mesh *mesh = NULL;
    he_error err = {0};
    assert_int_equal(he_build(&import.soup, 0, &mesh, NULL, &err), HE_REPEATED_CORNER);
    he_import_locate(&import, &err);
    assert_int_equal(err.at, 16);
    he_import_clear(&import);
}

static void limits_are_kept(void **state)
{
    (void)state;
    static const struct {
        he_limits limits;
        const char *words;
        uint64_t line, byte;
    } rows[] = {
        {{.vertices = 3}, "more than 3 vertices", 12, HEADER + FACET},
        {{.faces = 1}, "1 faces", 9, 80},
        {{.corners = 5}, "more than 5 corners", 9, HEADER + FACET},
        {{.bytes = 230}, "more than 230 bytes", 5, HEADER},
    };
    static const char text[] = "solid\n" ONE TWO "endsolid\n";
    file f;
    begin(&f, "", 2);
    put_facet(&f, facets[0], 0);
    put_facet(&f, facets[1], 0);
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        he_import import = {0};
        he_error err = {0};
        assert_int_equal(read_pieces(&(format_file){"stl", text, sizeof text - 1}, 1,
                                     &rows[i].limits, &import, &err),
                         HE_LIMIT);
        assert_int_equal(err.place, HE_PLACE_LINE);
        assert_int_equal(read_pieces(&(format_file){"stl", f.bytes, f.length}, 0, &rows[i].limits,
                                     &import, &err),
                         HE_LIMIT);
        assert_int_equal(err.place, HE_PLACE_BYTE);
        assert_int_equal(err.at, rows[i].byte);
        assert_true(i == 1 || strstr(err.text, rows[i].words) != NULL);
    }
}

/* --- many vertices --- */

/* A large grid of triangles. At most positions the corners of six triangles meet: these six corners
 * must become one vertex. */
static void large_grids_are_welded(void **state)
{
    (void)state;
    enum { SIDE = 200 };
    he_reader *reader;
    he_error err = {0};
    assert_int_equal(he_reader_new(he_format_find("stl"), NULL, &reader, &err), HE_OK);
    file f;
    begin(&f, "", 2 * SIDE * SIDE);
    assert_int_equal(he_reader_feed(reader, f.bytes, f.length, &err), HE_OK);
    for (int i = 0; i < SIDE * SIDE; i++) {
        int column = i % SIDE, row = i / SIDE;
        float x = (float)column * 0.1f, y = (float)row * 0.1f;
        float right = (float)(column + 1) * 0.1f, up = (float)(row + 1) * 0.1f;
        f.length = 0;
        put_facet(&f, (float[9]){x, y, 0, right, y, 0, right, up, -0.0f}, 0);
        put_facet(&f, (float[9]){x, y, -0.0f, right, up, 0, x, up, 0}, 0);
        assert_int_equal(he_reader_feed(reader, f.bytes, f.length, &err), HE_OK);
    }
    he_import import;
    assert_int_equal(he_reader_finish(reader, &import, &err), HE_OK);
    he_reader_free(reader);
    expect_counts(&import, (SIDE + 1) * (SIDE + 1), 2 * SIDE * SIDE, 6 * SIDE * SIDE);
    he_mesh *mesh = build_import(&import);
    assert_int_equal(he_mesh_boundary_halfedges(mesh), 4 * SIDE);
    he_mesh_free(mesh);
    he_import_clear(&import);
}

/* --- writing --- */

static void text_is_as_expected(void **state)
{
    (void)state;
    he_mesh *mesh =
        mesh_of_text("off", "OFF 4 2 0\n0 0 0\n1.1 0 0\n0 1e-7 -0\n0 0 5\n3 0 1 2\n3 0 3 1\n");
    he_warnings warnings;
    size_t length;
    char *text = write_bytes("stl", "ascii", mesh, &warnings, &length);
    assert_string_equal(text,
                        "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1.1 0 0\n"
                        "vertex 0 1e-7 -0\nendloop\nendfacet\nfacet normal 0 1 0\n"
                        "outer loop\nvertex 0 0 0\nvertex 0 0 5\nvertex 1.1 0 0\nendloop\n"
                        "endfacet\nendsolid\n");
    assert_int_equal(warnings.count, 0);
    free(text);
    text = write_bytes("stl", "binary", mesh, &warnings, &length);
    assert_int_equal(length, HEADER + 2 * FACET);
    assert_int_equal(strncmp(text, "solid", 5) == 0, 0);
    assert_int_equal(text[80], 2);
    assert_int_equal(warnings.count, 1);
    assert_int_equal(find_warning(&warnings, "rounded", "")->count, 2);
    free(text);
    he_mesh_free(mesh);
}

static void triangles_round_trip(void **state)
{
    (void)state;
    static const char *const names[] = {"ascii", "binary"};
    file f;
    begin(&f, "", 4);
    for (size_t k = 0; k < 4; k++) {
        put_facet(&f, facets[k], 0);
    }
    he_import import = read_file(&f);
    he_mesh *mesh = build_import(&import);
    for (size_t i = 0; i < 2; i++) {
        size_t length, again_length;
        he_warnings warnings;
        char *bytes = write_bytes("stl", names[i], mesh, &warnings, &length);
        assert_int_equal(warnings.count, 0);
        he_import other = {0};
        he_error err = {0};
        assert_int_equal(read_bytes("stl", bytes, length, &other, &err), HE_OK);
        he_mesh *again = build_import(&other);
        assert_true(he_mesh_equal(mesh, again));
        char *repeated = write_encoded("stl", names[i], again, 7, NULL, &again_length);
        assert_int_equal(again_length, length);
        assert_memory_equal(repeated, bytes, length);
        free(repeated);
        free(bytes);
        he_mesh_free(again);
        he_import_clear(&other);
    }
    he_mesh_free(mesh);
    he_import_clear(&import);
}

/* Returns twice the area of all triangles that were read, projected to the plane z = 0. */
static double area_of(const he_import *import)
{
    double sum = 0;
    for (size_t c = 0; c < import->soup.corner_count; c += 3) {
        const he_vec3 *p = import->soup.positions;
        const uint32_t *v = import->soup.corners + c;
        double twice = (p[v[1]].x - p[v[0]].x) * (p[v[2]].y - p[v[0]].y) -
                       (p[v[1]].y - p[v[0]].y) * (p[v[2]].x - p[v[0]].x);
        assert_true(twice > 0);
        sum += twice;
    }
    return sum;
}

static void polygons_are_cut_into_triangles(void **state)
{
    (void)state;
    /* A mesh with an L-shaped face, a triangle, a dart (a concave quadrilateral), and a vertex
     * without faces. */
    he_mesh *mesh = mesh_of_text("off", "OFF 11 3 0\n0 0 0\n4 0 0\n4 2 0\n2 2 0\n2 4 0\n0 4 0\n"
                                        "6 0 0\n9 -3 0\n7 0 0\n9 3 0\n5 5 5\n"
                                        "6 0 1 2 3 4 5\n3 1 6 2\n4 6 7 8 9\n");
    he_warnings warnings;
    size_t length;
    char *bytes = write_bytes("stl", "binary", mesh, &warnings, &length);
    assert_int_equal(length, HEADER + 7 * FACET);
    assert_int_equal(find_warning(&warnings, "triangulated", "")->count, 2);
    assert_int_equal(find_warning(&warnings, "isolated_vertices", "")->count, 1);
    assert_int_equal(warnings.count, 2);
    he_import import = {0};
    assert_int_equal(read_pieces(&(format_file){"stl", bytes, length}, 9, NULL, &import, NULL),
                     HE_OK);
    expect_counts(&import, 10, 7, 21);
    assert_true(area_of(&import) == 2 * (12 + 2 + 3));
    he_mesh *again = build_import(&import);
    he_mesh_free(again);
    he_import_clear(&import);
    free(bytes);
    he_mesh_free(mesh);
}

/* Both diagonals of the square exist as edges of other faces. Since STL has no edges, the square
 * must be cut into triangles nevertheless. */
static void diagonals_that_exist(void **state)
{
    (void)state;
    he_mesh *mesh = fixture_mesh("0123,024,135");
    he_warnings warnings;
    size_t length;
    char *bytes = write_bytes("stl", "binary", mesh, &warnings, &length);
    assert_int_equal(length, HEADER + 4 * FACET);
    assert_int_equal(find_warning(&warnings, "triangulated", "")->count, 1);
    free(bytes);
    he_mesh_free(mesh);
}

static void what_is_lost_is_named(void **state)
{
    (void)state;
    /* A mesh in which two vertices have equal positions, two have positions that are equal as
     * floats, and one has no face. */
    he_mesh *mesh = mesh_of_text("obj", "v 0 0 0\nv 1 0 0 1\nv 0 1 0\nv 1e30 1 0\nv -0 0 0\n"
                                        "v 1.00000000001 0 5\nv 1 0 5\nv 7 7 7\n"
                                        "usemtl red\nf 1 2 3\nf 3 2 4\nf 5 6 7\n");
    he_warnings warnings;
    size_t length;
    char *bytes = write_bytes("stl", "binary", mesh, &warnings, &length);
    assert_int_equal(find_warning(&warnings, "merged", "")->count, 2);
    assert_int_equal(find_warning(&warnings, "rounded", "")->count, 2);
    assert_int_equal(find_warning(&warnings, "isolated_vertices", "")->count, 1);
    assert_non_null(find_warning(&warnings, "attribute_lost", "face material"));
    assert_int_equal(find_warning(&warnings, "no_mesh_again", "")->count, 1);
    assert_int_equal(warnings.count, 5);
    float x;
    memcpy(&x, bytes + HEADER + FACET + 12 + 2 * 12, sizeof x);
    assert_true(x == 1e30f);
    free(bytes);
    bytes = write_bytes("stl", "ascii", mesh, &warnings, &length);
    assert_int_equal(find_warning(&warnings, "merged", "")->count, 1);
    assert_null(find_warning(&warnings, "rounded", ""));
    assert_non_null(strstr(bytes, "vertex 1e30 1 0\n"));
    free(bytes);
    he_mesh_free(mesh);
    mesh = mesh_of_text("off", "OFF 4 1 0\n0 0 0\n1 1 0\n1 0 0\n0 1 0\n4 0 1 2 3\n");
    bytes = write_bytes("stl", "ascii", mesh, &warnings, &length);
    assert_int_equal(find_warning(&warnings, "turned_triangles", "")->count, 1);
    free(bytes);
    he_mesh_free(mesh);
}

static void no_memory_to_cut_polygons(void **state)
{
    (void)state;
    he_mesh *mesh = mesh_of_text("off", "OFF 6 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n2 0 0\n2 1 0\n"
                                        "4 0 1 2 3\n4 1 4 5 2\n");
    failing f = {0};
    while (failing_next(&f)) {
        he_writer *writer = NULL;
        he_error err = {0};
        he_status status = he_writer_new(he_format_find("stl"), mesh, 0, NULL, &writer, &err);
        if (failing_status(&f, status)) {
            he_writer_free(writer);
        } else {
            assert_int_equal(err.status, HE_NO_MEMORY);
        }
    }
    print_message("%ld allocations of the writer failed, each refused\n", f.n - 1);
    assert_true(f.n > 12);
    he_mesh_free(mesh);
}

/* The face is a star polygon that winds around its centre thousands of times. */
static void faces_that_cross_themselves_are_cut_all_the_same(void **state)
{
    (void)state;
    enum { POINTS = 20000 };
    he_soup soup;
    he_mesh *mesh = NULL;
    he_error err = {0};
    he_soup_init(&soup, NULL);
    assert_int_equal(he_soup_begin_face(&soup, &err), HE_OK);
    for (uint32_t i = 0; i < 2 * POINTS; i++) {
        double angle = (double)i / POINTS * 3.14159265358979 * (POINTS - 1);
        double radius = i % 2 == 0 ? 1 : 0.999;
        he_vec3 p = {radius * cos(angle), radius * sin(angle), 0};
        assert_int_equal(he_soup_add_vertex(&soup, p, &err), HE_OK);
        assert_int_equal(he_soup_add_corner(&soup, i, &err), HE_OK);
    }
    assert_int_equal(he_build(&soup, HE_BUILD_TAKE, &mesh, NULL, &err), HE_OK);
    he_warnings warnings;
    size_t length;
    char *bytes = write_encoded("stl", "binary", mesh, 65536, &warnings, &length);
    assert_int_equal(length, HEADER + FACET * (2 * POINTS - 2));
    assert_int_equal(find_warning(&warnings, "turned_triangles", "")->count, 1);
    free(bytes);
    he_mesh_free(mesh);
    he_soup_clear(&soup);
}

static void first_bytes_tell(void **state)
{
    (void)state;
    static const char *const texts[] = {"solid\n", "SOLID x", " \n\tSolid",
                                        "\xEF\xBB\xBFsolid a\n"};
    static const char *const others[] = {"", "soli", "ply\n", "OFF\n", "v 0 0 0\n", "g solid\n"};
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        assert_ptr_equal(he_format_sniff(texts[i], strlen(texts[i])), he_format_find("stl"));
    }
    for (size_t i = 0; i < sizeof others / sizeof *others; i++) {
        assert_ptr_not_equal(he_format_sniff(others[i], strlen(others[i])), he_format_find("stl"));
    }
    file f;
    static const char *const headers[] = {"o part", "", "solid", "made by hand"};
    for (size_t i = 0; i < sizeof headers / sizeof *headers; i++) {
        begin(&f, headers[i], 1);
        put_facet(&f, facets[0], 0);
        assert_ptr_equal(he_format_sniff(f.bytes, f.length), he_format_find("stl"));
    }
    assert_null(he_format_sniff(f.bytes, f.length - 1));
    memset(f.bytes, 'x', f.length);
    assert_null(he_format_sniff(f.bytes, f.length));
    assert_ptr_equal(he_format_of_media_type("model/stl"), he_format_find("stl"));
    assert_ptr_equal(he_format_of_extension("STL"), he_format_find("stl"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(binary_is_welded),
        cmocka_unit_test(attribute_bytes_are_noted),
        cmocka_unit_test(wrong_bytes_name_their_place),
        cmocka_unit_test(text_in_all_its_forms),
        cmocka_unit_test(several_solids_keep_their_names),
        cmocka_unit_test(what_does_not_belong_is_noted),
        cmocka_unit_test(wrong_text_names_its_line),
        cmocka_unit_test(limits_are_kept),
        cmocka_unit_test(large_grids_are_welded),
        cmocka_unit_test(text_is_as_expected),
        cmocka_unit_test(triangles_round_trip),
        cmocka_unit_test(polygons_are_cut_into_triangles),
        cmocka_unit_test(diagonals_that_exist),
        cmocka_unit_test(what_is_lost_is_named),
        cmocka_unit_test(no_memory_to_cut_polygons),
        cmocka_unit_test(faces_that_cross_themselves_are_cut_all_the_same),
        cmocka_unit_test(first_bytes_tell),
    };
    return cmocka_run_group_tests_name("format_stl", tests, NULL, NULL);
}
