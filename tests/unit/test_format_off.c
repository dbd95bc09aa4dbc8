/* Reading OFF files: headers, colours, counts, and every error with its line. */
#include "unit/format_fixture.h"
#include "tests/failing.h"

#include <math.h>

static void plain_files(void **state)
{
    (void)state;
    static const char *const texts[] = {
        "OFF\n3 1 3\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n",
        "OFF 3 1 3\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2",
        "OFF\r\n3 1 0\r\n0 0 0\r\n1 0 0\r\n0 1 0\r\n3 0 1 2\r\n",
        "off\n3 1 999999999999999999999\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n",
        "3 1 3\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n",
        "# a\n\n  OFF # b\n 3 # d\n1 0#e\n\n0 0 0 # f\n\n1 0 0\n#\n0\t1 0\n # g\n3  0 1 2 # h\n#",
        "OFF\n3 1\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n", /* the header has no number of edges */
        /* the number of edges is on a line of its own */
        "OFF\n3 1\n17\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n",
        /* each number of the header is on a line of its own */
        "OFF\n3\n1\n3\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n",
        /* each vertex and each face is spread over several lines */
        "OFF\n3 1 3\n0 0\n0\n1\n0 0\n0 1\n0\n3\n0 1\n2\n",
        "# a\rOFF\r3 1 3\r0 0 0\r1 0 0\r0 1 0\r3 0 1 2\r",
        "\xEF\xBB\xBFOFF\n3 1 3\n0 0 0\n1e0 .0 0.\n0 +1 0\n3 0 1 2\n\n\n",
    };
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        he_import import = read_text("off", texts[i]);
        expect_counts(&import, 3, 1, 3);
        expect_corners(&import, (uint32_t[]){0, 1, 2}, 3);
        assert_true(import.soup.positions[0].x == 0 && import.soup.positions[1].x == 1 &&
                    import.soup.positions[2].y == 1);
        assert_int_equal(import.soup.column_count, 0);
        assert_int_equal(import.warnings.count, 0);
        he_import_clear(&import);
    }
    he_import import = read_text("off", "OFF +2 +1 nan\n0 0 0\n1 0 0\n3 +0 1 +0\n");
    expect_corners(&import, (uint32_t[]){0, 1, 0}, 3);
    he_import_clear(&import);
    import = read_text("off", "NOFF 2 0 0\n0 0 0 0 0 1\n1 0 0 nan 0 -inf\n");
    expect_doubles(&import, &(attribute_shape){HE_VERTEX, "normal", 3, 2},
                   (double[]){0, 0, 1, 0, 0, 0});
    expect_warning(&import, "not_finite", "", 2, 3);
    he_import_clear(&import);
    import = read_text("off", "OFF\n0 0 0\n");
    expect_counts(&import, 0, 0, 0);
    he_import_clear(&import);
    import = read_text("off", "OFF 2 0 0\n1 2 3\n4 5 6\n");
    expect_counts(&import, 2, 0, 0);
    he_import_clear(&import);
}

static void polygons_and_lines(void **state)
{
    (void)state;
    he_import import = read_text("off", "OFF\n5 2 6\n0 0 0\n1 0 0\n\n1 1 0\n0 1 0\n-1 .5 0\n"
                                        "4 0 1 2 3\n# x\n3 0 3 4\n");
    expect_corners(&import, (uint32_t[]){0, 1, 2, 3, 0, 3, 4}, 7);
    assert_int_equal(he_source_map_find(&import.vertices, 1), 4);
    assert_int_equal(he_source_map_find(&import.vertices, 2), 6);
    assert_int_equal(he_source_map_find(&import.faces, 1), 11);
    he_mesh *mesh = build_import(&import);
    fixture_counts(mesh, 5, 6, 2);
    he_mesh_free(mesh);
    he_import_clear(&import);
}

static void vertex_data_in_every_mix(void **state)
{
    (void)state;
    static const struct {
        const char *header, *first, *second;
        bool normal, uv;
        uint32_t color; /* expected number of components of a colour, 0 if there are no colours */
    } rows[] = {
        {"COFF", "0 0 0 0.5 0 1", "1 0 0 1 1 0.25", false, false, 3},
        {"COFF", "0 0 0 0.5 0 1 0.25", "1 0 0 1 1 0.25 1", false, false, 4},
        {"NOFF", "0 0 0 0 0 1", "1 0 0 0 1 0", true, false, 0},
        {"STOFF", "0 0 0 0.5 0.25", "1 0 0 1 0", false, true, 0},
        {"CNOFF", "0 0 0 0 0 1 0.5 0 1", "1 0 0 0 1 0 1 1 0.25", true, false, 3},
        {"NCOFF", "0 0 0 0 0 1 0.5 0 1 1", "1 0 0 0 1 0 1 1 0.25 0", true, false, 4},
        {"STNOFF", "0 0 0 0 0 1 0.5 0.25", "1 0 0 0 1 0 1 0", true, true, 0},
        {"STCOFF", "0 0 0 0.5 0 1 0.5 0.25", "1 0 0 1 1 0.25 1 0", false, true, 3},
        {"STCNOFF", "0 0 0 0 0 1 0.5 0 1 0.25 0.5 0.25", "1 0 0 0 1 0 1 1 0.25 1 1 0", true, true,
         4},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        char text[300];
        snprintf(text, sizeof text, "%s\n2 0 0\n%s\n%s\n", rows[i].header, rows[i].first,
                 rows[i].second);
        he_import import = read_text("off", text);
        expect_counts(&import, 2, 0, 0);
        assert_int_equal(import.warnings.count, 0);
        assert_int_equal(import.soup.column_count,
                         rows[i].normal + rows[i].uv + (rows[i].color != 0));
        assert_true(import.soup.positions[1].x == 1);
        if (rows[i].normal) {
            expect_doubles(&import, &(attribute_shape){HE_VERTEX, "normal", 3, 2},
                           (double[]){0, 0, 1, 0, 1, 0});
        }
        if (rows[i].uv) {
            expect_doubles(&import, &(attribute_shape){HE_VERTEX, "uv", 2, 2},
                           (double[]){0.5, 0.25, 1, 0});
        }
        if (rows[i].color == 3) {
            expect_doubles(&import, &(attribute_shape){HE_VERTEX, "color", 3, 2},
                           (double[]){0.5, 0, 1, 1, 1, 0.25});
        }
        if (rows[i].color == 4) {
            const he_column *color = find_column(&import, HE_VERTEX, "color");
            assert_int_equal(color->components, 4);
            assert_int_equal(color->type, HE_DOUBLE);
        }
        he_import_clear(&import);
    }
}

static void integer_colors_are_bytes(void **state)
{
    (void)state;
    /* Texture coordinates must not be read as colours, nor decide whether the colours are bytes. */
    he_import import = read_text("off", "STCOFF\n3 0 0\n0 0 0 255 0 7 0.5 0.25\n"
                                        "0 0 0 1 2 3 128 0 0\n0 0 0 0 0 0 0 0\n");
    expect_bytes(&import, HE_VERTEX, 4,
                 (const unsigned char[]){255, 0, 7, 255, 1, 2, 3, 128, 0, 0, 0, 255}, 3);
    assert_int_equal(import.warnings.count, 0);
    he_import_clear(&import);
    static const struct {
        const char *vertex;
        double color[3];
        bool bytes; /* whether a warning must say that the colours were read as bytes */
    } rows[] = {
        {"1 0 1", {1 / 255.0, 0, 1 / 255.0}, false}, {"1 0 1.0", {1, 0, 1}, false},
        {"255 0 1e1", {1, 0, 10 / 255.0}, true},     {"255 0 .5", {255, 0, .5}, false},
        {"700 0 4294967296", {1, 0, 1}, true},       {"700 0 1", {1, 0, 1 / 255.0}, false},
        {"2 0 -1", {2 / 255.0, 0, 0}, true},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        char text[200];
        snprintf(text, sizeof text, "COFF\n1 0 0\n0 0 0 %s 1\n", rows[i].vertex);
        import = read_text("off", text);
        const he_column *column = find_column(&import, HE_VERTEX, "color");
        assert_memory_equal(he_column_value(column, 0), rows[i].color, sizeof rows[i].color);
        assert_int_equal(import.warnings.count, rows[i].bytes);
        he_import_clear(&import);
    }
}

/* If the line of a vertex lacks the normal that the header announces, the normal must be 0, with a
 * warning; it must not be read from the next vertex's line. */
static void vertices_without_what_is_announced(void **state)
{
    (void)state;
    he_import import = read_text("off", "NOFF\n3 1 0\n0 0 0\n1 0 0 0 0 1\n1 1 0\n3 0 1 2\n");
    expect_counts(&import, 3, 1, 3);
    expect_doubles(&import, &(attribute_shape){HE_VERTEX, "normal", 3, 2},
                   (double[]){0, 0, 0, 0, 0, 1});
    expect_warning(&import, "missing_numbers", "", 2, 3);
    he_mesh *mesh = build_import(&import);
    const he_column *column = he_mesh_find_column(mesh, HE_VERTEX, "normal");
    assert_memory_equal(he_column_value(column, 2), ((double[]){0, 0, 0}), 24);
    he_mesh_free(mesh);
    he_import_clear(&import);

    static const char *const headers[] = {"COFF", "NOFF", "STOFF", "STCNOFF"};
    for (size_t i = 0; i < 4; i++) {
        char text[200];
        snprintf(text, sizeof text, "%s\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n", headers[i]);
        import = read_text("off", text);
        expect_counts(&import, 3, 1, 3);
        assert_int_equal(import.soup.column_count, 0);
        expect_warning(&import, "missing_numbers", "", 3, 3);
        he_import_clear(&import);
    }
    import = read_text("off", "CNOFF\n4 0 0\n0 0 0 0 0 1\n1 0 0 0 0 1 7 8 9\n1 1 0\n"
                              "1 1 1 0 1 0 3\n");
    expect_bytes(&import, HE_VERTEX, 3, (const unsigned char[]){0, 0, 0, 7, 8, 9, 0, 0, 0, 0, 0, 0},
                 4);
    expect_doubles(&import, &(attribute_shape){HE_VERTEX, "normal", 3, 4},
                   (double[]){0, 0, 1, 0, 0, 1, 0, 0, 0, 0, 1, 0});
    expect_warning(&import, "missing_numbers", "", 2, 3);
    expect_warning(&import, "color_index", "", 1, 6);
    he_import_clear(&import);
    import = read_text("off", "STNOFF\n2 0 0\n0 0 0 0 0 1\n1 0 0 0 0 1 .5 .5\n");
    expect_doubles(&import, &(attribute_shape){HE_VERTEX, "uv", 2, 2}, (double[]){0, 0, .5, .5});
    expect_warning(&import, "missing_numbers", "", 1, 3);
    he_import_clear(&import);

    /* If the normals or colours stand on lines of their own, these look like further vertices: the
     * error must say what is wrong with the file. */
    expect_refused("off", "NOFF\n2 0 0\n0 0 0\n0 0 1\n1 0 0\n0 0 1\n", HE_SYNTAX, 5,
                   "must be on the same line");
    expect_refused("off", "COFF\n2 1 0\n0 0 0\n7 8 9\n1 0 0\n7 8 9\n3 0 1 2\n", HE_SYNTAX, 6,
                   "from line 3 on, vertices");
}

static void face_colors(void **state)
{
    (void)state;
    static const char start[] = "OFF\n4 3 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n";
    char text[400];
    snprintf(text, sizeof text, "%s3 0 1 2 255 0 7\n3 0 2 3 1 2 3 128\n3 3 2 1\n", start);
    he_import import = read_text("off", text);
    expect_bytes(&import, HE_FACE, 4,
                 (const unsigned char[]){255, 0, 7, 255, 1, 2, 3, 128, 0, 0, 0, 0}, 3);
    he_import_clear(&import);

    snprintf(text, sizeof text, "%s3 0 1 2\n3 0 2 3 1 .5 0 # c\n3 3 2 1 0 0 1\n", start);
    import = read_text("off", text);
    expect_doubles(&import, &(attribute_shape){HE_FACE, "color", 3, 3},
                   (double[]){0, 0, 0, 1, .5, 0, 0, 0, 1});
    he_import_clear(&import);

    snprintf(text, sizeof text, "%s3 0 1 2 9\n3 0 2 3 1 2\n3 3 2 1 1 2 3 4 5\n", start);
    import = read_text("off", text);
    assert_null(find_column(&import, HE_FACE, "color"));
    expect_warning(&import, "color_index", "", 1, 7);
    expect_warning(&import, "extra_numbers", "", 2, 8);
    he_import_clear(&import);

    import = read_text("off", "OFF\n2 0 0\n0 0 0 1 2 3\n1 0 0\n");
    assert_int_equal(import.soup.column_count, 0);
    expect_warning(&import, "extra_numbers", "", 1, 3);
    he_import_clear(&import);

    import = read_text("off", "COFF\n1 0 0\n0 0 0 5\n");
    expect_warning(&import, "color_index", "", 1, 3);
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
        {"", HE_SYNTAX, 1, "before its counts"},
        {"OFF\n", HE_SYNTAX, 1, "before its counts"},
        {"OFF\n# x\n3\n", HE_SYNTAX, 3, "before its counts"},
        {"OFF\n3\n# x\n", HE_SYNTAX, 3, "before its counts"},
        {"OFF\n3\n# x", HE_SYNTAX, 3, "before its counts"},
        {"PLY\n3 1 3\n", HE_SYNTAX, 1, "'PLY' is not the header"},
        {"OFFX\n3 1 3\n", HE_SYNTAX, 1, "is not the header"},
        {"CCOFF\n3 1 3\n", HE_SYNTAX, 1, "is not the header"},
        {"-3 1 3\n", HE_SYNTAX, 1, "is not the header"},
        {"#\n4OFF\n3 1 3\n", HE_UNSUPPORTED, 2, "'4OFF' is not supported"},
        {"nOFF\n3 1 3\n", HE_UNSUPPORTED, 1, "'nOFF' is not supported"},
        {"STCN4nOFF\n3 1 3\n", HE_UNSUPPORTED, 1, "is not supported"},
        {"OFF BINARY 3 1 3\n", HE_SYNTAX, 1, "'3' is not allowed on the line of the word BINARY"},
        {"OFF BINARYS\n", HE_SYNTAX, 1, "'BINARYS' is not a count"},
        {"OFF\n-3 1 3\n", HE_SYNTAX, 2, "'-3' is not a count"},
        {"OFF\n3.0 1 3\n", HE_SYNTAX, 2, "'3.0' is not a count"},
        {"OFF\n3 1 3 4\n", HE_SYNTAX, 2, "'4' is not allowed after"},
        {"OFF\n3 1 x\n", HE_SYNTAX, 2, "'x' is not a number"},
        {"OFF\n353535235358 6 0\n", HE_BAD_VALUE, 2, "353535235358 vertices"},
        {"OFF\n18446744073709551615 6 0\n", HE_BAD_VALUE, 2, "18446744073709551615 vertices"},
        {"OFF\n18446744073709551617 6 0\n", HE_BAD_VALUE, 2, "18446744073709551617 vertices"},
        {"OFF\n3 4294967295 0\n", HE_BAD_VALUE, 2, "4294967295 faces"},
        {"OFF\n4000000000 1 0\n", HE_BAD_VALUE, 2, "4000000000 vertices"},
        {"OFF\n2000000000 1 0\n0 0 0\n\n", HE_SYNTAX, 4, "1 of the 2000000000 vertices"},
        {"OFF\n1 2000000000 0\n0 0 0\n3 0 0 0\n", HE_SYNTAX, 4, "1 of the 2000000000 faces"},
        {"OFF\n2 0 0\n0 0 0\n1 1\n", HE_SYNTAX, 4, "1 of the 2 vertices"},
        {"OFF\n1 1 0\n0 0 0\n3 0 0\n", HE_SYNTAX, 4, "0 of the 1 faces"},
        {"OFF\n1 1 0\n0 0 0\n2000000000 0 0 0\n", HE_SYNTAX, 4, "0 of the 1 faces"},
        {"OFF\n1 1 0\n0 0 0\n4294967295 0 0 0\n", HE_BAD_VALUE, 4, "4294967295 corners in a face"},
        {"OFF\n1 1 0\n0 0 0\n-1 0 0 0\n", HE_SYNTAX, 4, "'-1' is not a count"},
        {"OFF\n1 1 0\n0 0 0\n3 0 0 1\n", HE_BAD_INDEX, 4, "vertex 1; the vertices are 0 to 0"},
        {"OFF\n1 1 0\n0 0 0\n3 0 \n\n-1 0\n", HE_BAD_INDEX, 6, "vertex -1"},
        {"OFF\n1 1 0\n0 0 0\n3 0 4294967296 0\n", HE_BAD_INDEX, 4, "vertex 4294967296"},
        {"OFF\n1 1 0\n0 0 0\n3 0 18446744073709551616 0\n", HE_BAD_INDEX, 4,
         "18446744073709551616"},
        {"OFF\n1 1 0\n0 0 0\n3 0 0.0 0\n", HE_SYNTAX, 4, "'0.0' is not a valid corner"},
        {"OFF\n1 1 0\n0 0 0\n3 0 0 0 red\n", HE_SYNTAX, 4, "'red' is not a number"},
        {"OFF\n1 0 0\n0 0 x\n", HE_SYNTAX, 3, "'x' is not a number"},
        {"OFF\n1 0 0\n0 0 nan\n", HE_NOT_FINITE, 3, "'nan' is not finite"},
        {"OFF\n1 0 0\n0 1e400 0\n", HE_NOT_FINITE, 3, "'1e400' is not finite"},
        {"COFF\n1 0 0\n0 0 0 1 2\n", HE_SYNTAX, 3, "the line has 5 numbers"},
        {"COFF\n1 0 0\n0 0 0 1 2 3 4 5\n", HE_SYNTAX, 3, "the line has 8 numbers"},
        {"NOFF\n1 0 0\n0 0 0 0 1\n", HE_SYNTAX, 3, "the line has 5 numbers"},
        {"STCOFF\n1 0 0\n0 0 0 0 1\n", HE_SYNTAX, 3, "the line has 5 numbers"},
        /* a normal on a line of its own must not be read as a vertex, nor a vertex as a normal */
        {"NOFF\n2 1 0\n0 0 .5\n0 0 1\n1 0 .5\n0 0 1\n3 0 1 0\n", HE_SYNTAX, 6,
         "comes after the last face"},
        {"STOFF\n3 0 0\n0 0 0\n.5 .5\n1 0 0\n.5 .5\n0 1 0\n.5 .5\n", HE_SYNTAX, 5,
         "the line has 5 numbers"},
        {"NOFF\n2 0 0\n0 0\n0 0 0 1\n1 0 0\n", HE_SYNTAX, 5, "the line has 3 numbers"},
        {"OFF\n2 0 0\n0 0\n1 0 0\n", HE_SYNTAX, 4, "the line has 5 numbers"},
        {"OFF\n1 1 0\n0 0 0\n3 0 0 0\n3 0 0 0\n", HE_SYNTAX, 5, "'3' comes after the last face"},
        {"OFF\n1 0 0\n0 0 0\nx\n", HE_SYNTAX, 4, "'x' comes after the last face"},
        /* if the header says a wrong number of vertices, faces must be neither lost nor made of
         * vertices */
        {"OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 1 2\n", HE_SYNTAX, 7, "after the last face"},
        {"OFF\n4 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n", HE_SYNTAX, 6, "0 of the 1 faces"},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        expect_refused("off", rows[i].text, rows[i].status, rows[i].line, rows[i].words);
    }
    static const char wide[] = "\xFF\xFEO\0F\0F\0\n\0";
    expect_bytes_refused(&(format_file){"off", wide, sizeof wide - 1}, HE_UNSUPPORTED, 1, "UTF-16");
}

static void limits_are_kept(void **state)
{
    (void)state;
    static const char text[] = "OFF\n4 1 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n";
    static const struct {
        he_limits limits;
        he_status status;
        uint64_t line;
    } rows[] = {
        {{.vertices = 4, .faces = 1, .corners = 4}, HE_OK, 0},
        {{.vertices = 3}, HE_LIMIT, 2},
        {{.vertices = 4, .faces = 0, .corners = 3}, HE_LIMIT, 7},
        {{.bytes = 100}, HE_LIMIT, 3},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        he_import import = {0};
        he_error err = {0};
        he_status status = read_pieces(&(format_file){"off", text, strlen(text)}, 0,
                                       &rows[i].limits, &import, &err);
        assert_int_equal(status, rows[i].status);
        if (status == HE_OK) {
            he_import_clear(&import);
        } else {
            assert_int_equal(err.place, HE_PLACE_LINE);
            assert_int_equal(err.at, rows[i].line);
        }
    }
}

/* A header with a large number of elements must not make the reader allocate memory for them before
 * they arrive. */
static void a_count_allocates_nothing(void **state)
{
    (void)state;
    static const char *const texts[] = {
        "OFF\n2147483646 2147483646 0\n0 0 0\n",
        "OFF\n1 2147483646 0\n0 0 0\n2147483646 0 0\n",
        "STCNOFF\n2147483646 2147483646 0\n",
    };
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        he_import import = {0};
        he_error err = {0};
        failing_at(0);
        he_status status =
            read_pieces(&(format_file){"off", texts[i], strlen(texts[i])}, 0, NULL, &import, &err);
        assert_int_equal(status, HE_SYNTAX);
        assert_in_range(failing_count(), 1, 12);
        failing_off();
    }
}

/* --- binary --- */

typedef struct body {
    unsigned char bytes[400];
    size_t length;
} body;

static void put_text(body *b, const char *text)
{
    memcpy(b->bytes + b->length, text, strlen(text));
    b->length += strlen(text);
}

static void put_whole(body *b, uint32_t value)
{
    for (int shift = 24; shift >= 0; shift -= 8) {
        b->bytes[b->length++] = (unsigned char)(value >> shift);
    }
}

static void put_floats(body *b, const float *values, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        uint32_t bits;
        memcpy(&bits, &values[i], sizeof bits);
        put_whole(b, bits);
    }
}

/* Makes a binary OFF file of a square of two triangles. The first triangle has a colour; the second
 * has a single number where its colour would be. */
static body square_body(const char *header)
{
    static const float vertices[4][12] = {
        {0, 0, 0, 0, 0, 1, 1, 0, 0, 1, 0, 0.25f},
        {1, 0, 0, 0, 0, 1, 0, 1, 0, 1, 1, 0},
        {1, 1, 0, 0, 0, 1, 0, 0, 1, 0.5f, 1, 1},
        {0, 1, 0, 0, 0, 1, INFINITY, 0, 0, 1, 0, 1},
    };
    body b = {.length = 0};
    put_text(&b, header);
    put_whole(&b, 4);
    put_whole(&b, 2);
    put_whole(&b, 99);
    for (size_t i = 0; i < 4; i++) {
        put_floats(&b, vertices[i], strstr(header, "STCN") != NULL ? 12 : 3);
    }
    for (uint32_t f = 0; f < 2; f++) {
        put_whole(&b, 3);
        put_whole(&b, 0);
        put_whole(&b, 1 + f);
        put_whole(&b, 2 + f);
        put_whole(&b, f == 0 ? 3 : 1);
        put_floats(&b, (float[]){1, 0.5f, 0}, f == 0 ? 3 : 1);
    }
    return b;
}

static void a_binary_body_is_read_with_a_note(void **state)
{
    (void)state;
    static const char *const headers[] = {"OFF BINARY\n", "# made by\r\nOFF BINARY # so\r\n",
                                          "STCNOFF BINARY\n", "# x\rSTCNOFF BINARY\r"};
    static const uint32_t corners[] = {0, 1, 2, 0, 2, 3};
    static const double face_colors[] = {1, 0.5, 0, 0, 0, 0};
    static const double uv[] = {0, 0.25, 1, 0, 1, 1, 0, 1};
    static const double normal[] = {0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1};
    static const double colors[] = {1, 0, 0, 1, 0, 1, 0, 1, 0, 0, 1, 0.5, 0, 0, 0, 1};
    for (size_t i = 0; i < sizeof headers / sizeof *headers; i++) {
        he_import import = {0};
        he_error err = {0};
        body b = square_body(headers[i]);
        size_t header = strlen(headers[i]);
        put_text(&b, "\n"); /* an additional byte after the last face */
        assert_int_equal(read_bytes("off", b.bytes, b.length, &import, &err), HE_OK);
        expect_counts(&import, 4, 2, 6);
        expect_corners(&import, corners, 6);
        assert_true(import.soup.positions[2].x == 1 && import.soup.positions[2].y == 1);
        expect_doubles(&import, &(attribute_shape){HE_FACE, "color", 3, 2}, face_colors);
        expect_warning(&import, "binary_off", "", 1, header);
        expect_warning(&import, "trailing_bytes", "", 1, b.length - 1);
        expect_warning(&import, "extra_numbers", "", 1, b.length - 9);
        assert_int_equal(he_source_map_find(&import.vertices, 1), header + 12 + (i < 2 ? 12 : 48));
        if (i >= 2) {
            expect_doubles(&import, &(attribute_shape){HE_VERTEX, "uv", 2, 4}, uv);
            expect_doubles(&import, &(attribute_shape){HE_VERTEX, "normal", 3, 4}, normal);
            expect_doubles(&import, &(attribute_shape){HE_VERTEX, "color", 4, 4}, colors);
            expect_warning(&import, "not_finite", "", 1, header + 12 + 3 * 48 + 24);
        }
        he_mesh_free(build_import(&import));
        he_import_clear(&import);
    }
}

static void a_wrong_binary_body_names_its_byte(void **state)
{
    (void)state;
    static const char header[] = "OFF BINARY\n";
    enum { H = sizeof header - 1, FACES = H + 12 + 48 };
    static const struct {
        size_t where; /* offset of the word of the file that is replaced by `word` */
        uint32_t word;
        he_status status;
        uint64_t at;
        const char *words;
    } rows[] = {
        {H, 0xFFFFFFFF, HE_BAD_VALUE, H, "declares 4294967295 vertices, more than"},
        {H, 2147483646, HE_SYNTAX, H + 116, "of the 2147483646 vertices"},
        {H + 4, 0x80000000, HE_BAD_VALUE, H + 4, "declares 2147483648 faces, more than"},
        {H + 4, 2147483646, HE_SYNTAX, H + 116, "2 of the 2147483646 faces"},
        {H + 4, 1, HE_SYNTAX, H + 92, "more than the 1 faces"},
        {H + 12, 0x7F800000, HE_NOT_FINITE, H + 12, "is not finite"},
        {FACES, 0xFFFFFFFD, HE_BAD_VALUE, FACES,
         "declares 4294967293 corners in a face, more than"},
        {FACES, 2147483646, HE_BAD_INDEX, FACES + 20,
         "there is no vertex 1065353216; the vertices are 0 to 3"},
        {FACES + 8, 4, HE_BAD_INDEX, FACES + 8, "there is no vertex 4; the vertices are 0 to 3"},
        {FACES + 8, 0xFFFFFFFF, HE_BAD_INDEX, FACES + 8, "there is no vertex -1"},
        {FACES + 16, 0xFFFFFFFF, HE_BAD_VALUE, FACES + 16, "4294967295 numbers of a colour"},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        body b = square_body(header);
        size_t length = b.length;
        b.length = rows[i].where;
        put_whole(&b, rows[i].word);
        expect_refused_at_byte(&(format_file){"off", b.bytes, length}, rows[i].status, rows[i].at,
                               rows[i].words);
    }
    body b = square_body(header);
    for (size_t length = H; length < b.length; length++) {
        expect_refused_at_byte(&(format_file){"off", b.bytes, length}, HE_SYNTAX, length,
                               "the file ends");
    }
    expect_refused_at_byte(&(format_file){"off", header, H - 1}, HE_SYNTAX, H - 1,
                           "before its counts");
}

static void it_is_recognised(void **state)
{
    (void)state;
    static const char *const offs[] = {"OFF\n",  "# x\n\n STCNOFF 1 2 3", "off 3 1 2",
                                       "4OFF\n", "\xEF\xBB\xBFNOFF\n",    "OFF BINARY\n"};
    for (size_t i = 0; i < sizeof offs / sizeof *offs; i++) {
        assert_ptr_equal(he_format_sniff(offs[i], strlen(offs[i])), he_format_find("off"));
    }
    static const char *const others[] = {"OFFICE", "3 1 3\n", "# OFF", "O", "Noff"};
    for (size_t i = 0; i < sizeof others / sizeof *others; i++) {
        assert_null(he_format_sniff(others[i], strlen(others[i])));
    }
    assert_ptr_equal(he_format_of_media_type("model/x-off"), he_format_find("off"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(plain_files),
        cmocka_unit_test(polygons_and_lines),
        cmocka_unit_test(vertex_data_in_every_mix),
        cmocka_unit_test(integer_colors_are_bytes),
        cmocka_unit_test(vertices_without_what_is_announced),
        cmocka_unit_test(face_colors),
        cmocka_unit_test(wrong_text_names_its_line),
        cmocka_unit_test(limits_are_kept),
        cmocka_unit_test(a_count_allocates_nothing),
        cmocka_unit_test(a_binary_body_is_read_with_a_note),
        cmocka_unit_test(a_wrong_binary_body_names_its_byte),
        cmocka_unit_test(it_is_recognised),
    };
    return cmocka_run_group_tests_name("format_off", tests, NULL, NULL);
}
