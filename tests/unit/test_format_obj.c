/* Reading OBJ files: every form of every line that the reader knows, and every error with its
 * line. */
#include "unit/format_fixture.h"

static const char cube[] = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

static void vertices_and_polygons(void **state)
{
    (void)state;
    he_import import = read_text("obj", "# a square and a triangle\n"
                                        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv -1.5e0 +.5 2.\n"
                                        "f 1 2 3 4\nf 1 4 5\n");
    expect_counts(&import, 5, 2, 7);
    expect_corners(&import, (uint32_t[]){0, 1, 2, 3, 0, 3, 4}, 7);
    assert_true(import.soup.positions[4].x == -1.5 && import.soup.positions[4].y == 0.5 &&
                import.soup.positions[4].z == 2);
    assert_int_equal(import.soup.starts[1], 4);
    assert_int_equal(import.warnings.count, 0);
    assert_int_equal(he_source_map_find(&import.vertices, 4), 6);
    assert_int_equal(he_source_map_find(&import.faces, 1), 8);
    he_mesh *mesh = build_import(&import);
    fixture_counts(mesh, 5, 6, 2);
    he_mesh_free(mesh);
    he_import_clear(&import);
}

static void white_space_and_line_ends(void **state)
{
    (void)state;
    static const char *const texts[] = {
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3",
        "v 0 0 0\r\nv 1 0 0\r\nv 0 1 0\r\nf 1 2 3\r\n",
        "v 0 0 0\r\nv 1 0 0\r\nv 0 1 0\r\nf 1 2 3\r",
        "\n\n  v\t0  0\t 0  \n\tv 1 0 0\t\n#\n   # x\nv   0 1 0   # a vertex\n\nf  1\t2   3  \n\n",
        "\xEF\xBB\xBFv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
        "\xEF\xBB\xBF# mark\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3#end\n",
        "v 0 0 \\\n0\nv 1 \\\r\n  0 0\nv 0 1 0\nf 1 \\\n 2 \\\n 3\n",
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2\\\n3\\\n\n",
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3 \\",
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3 \\\r\n",
        "# a comment does not go on \\\nv 0 0 0\n  # nor here \\\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
        "\\\nv 0 0 0\n\\\n\\\n v 1 0 0\nv 0 1 0\nfo 1 2 3\n",
    };
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        he_import import = read_text("obj", texts[i]);
        expect_counts(&import, 3, 1, 3);
        expect_corners(&import, (uint32_t[]){0, 1, 2}, 3);
        assert_true(import.soup.positions[1].x == 1 && import.soup.positions[2].y == 1);
        assert_int_equal(import.warnings.count, 0);
        he_import_clear(&import);
    }
}

static void lines_that_end_in_returns(void **state)
{
    (void)state;
    static const char *const texts[] = {
        "# old\rv 0 0 0\rv 1 0 0\r\rv 0 1 0\rf 1 2 \\\r 3\r",
        "# old\rv 0 0 0\rv 1 0 0\r\rv 0 1 0\rf 1 2 \\\r 3",
        "\r\rv 0 0 0\rv 1 0 0\rv 0 1 0\rf 1 2 3",
        "\xEF\xBB\xBFv 0 0 0\r\r\rv 1 0 0\rv 0 1 0\rf 1 2 3",
    };
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        he_import import = read_text("obj", texts[i]);
        expect_counts(&import, 3, 1, 3);
        assert_int_equal(import.warnings.count, 0);
        assert_int_equal(he_source_map_find(&import.faces, 0), 6);
        he_import_clear(&import);
        assert_string_equal(he_format_sniff(texts[i], strlen(texts[i]))->name, "obj");
    }
    expect_refused("obj", "v 0 0 0\rv 1 0 x\r", HE_SYNTAX, 2, "'x' is not a number");
    /* the way in which the first line ends decides how all lines of the file end */
    expect_refused("obj", "v 0 0 0\r\r\nv 1 0 0\rv 0 1 0\r\n", HE_SYNTAX, 2, "is not a number");
}

static void vertex_forms(void **state)
{
    (void)state;
    he_import import = read_text("obj", "v 1 2 3 1\nv 1 2 3 0.5\nv 1 2 3 2.0\n");
    expect_counts(&import, 3, 0, 0);
    expect_warning(&import, "vertex_weight", "", 2, 2);
    assert_null(find_column(&import, HE_VERTEX, "color"));
    he_import_clear(&import);

    import = read_text("obj", "v 0 0 0 1 0 0.5\nv 0 0 0 0 1 0\n");
    expect_doubles(&import, &(attribute_shape){HE_VERTEX, "color", 3, 2},
                   (double[]){1, 0, 0.5, 0, 1, 0});
    he_import_clear(&import);

    import = read_text("obj", "v 0 0 0 255 0 7 128\nv 0 0 0 0 1 0\nv 0 0 0\n");
    expect_bytes(&import, HE_VERTEX, 4,
                 (const unsigned char[]){255, 0, 7, 128, 0, 1, 0, 255, 0, 0, 0, 0}, 3);
    expect_warning(&import, "byte_colors", "", 2, 0);
    expect_warning(&import, "vertices_without_color", "", 1, 0);
    he_import_clear(&import);

    import = read_text("obj", "v 0 0 0 1.5 0 1 1\nv 0 0 0 0 2 1 1\n");
    expect_doubles(&import, &(attribute_shape){HE_VERTEX, "color", 3, 2},
                   (double[]){1.5, 0, 1, 0, 2, 1});
    assert_int_equal(import.warnings.count, 0);
    he_import_clear(&import);

    import = read_text("obj", "v 0 0 0\nv 0 0 0\nv 0 0 0 1 1 1\n");
    expect_doubles(&import, &(attribute_shape){HE_VERTEX, "color", 3, 3},
                   (double[]){0, 0, 0, 0, 0, 0, 1, 1, 1});
    expect_warning(&import, "vertices_without_color", "", 2, 0);
    he_import_clear(&import);
}

static void corner_forms(void **state)
{
    (void)state;
    static const char values[] = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0.25 0.5\nvt 1 0\nvt 0.5\n"
                                 "vn 0 0 1\nvn 1 0 0\n";
    static const struct {
        const char *face;
        bool uv, normal;
    } rows[] = {
        {"f 1 2 3", false, false},
        {"f 1/1 2/2 3/3", true, false},
        {"f 1//1 2//1 3//2", false, true},
        {"f 1/1/1 2/2/1 3/3/2", true, true},
        {"f 1/ 2/ 3/", false, false},
        {"f 1// 2// 3//", false, false},
        {"f 1/1/ 2/2/ 3/3/", true, false},
        {"f -3/-3/-2 -2/-2/-2 -1/-1/-1", true, true},
        {"f 1/1/1 2/-2/-2 3/3/-1", true, true},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        char text[300];
        snprintf(text, sizeof text, "%s%s\n", values, rows[i].face);
        he_import import = read_text("obj", text);
        expect_corners(&import, (uint32_t[]){0, 1, 2}, 3);
        assert_int_equal(find_column(&import, HE_HALFEDGE, "uv") != NULL, rows[i].uv);
        assert_int_equal(find_column(&import, HE_HALFEDGE, "normal") != NULL, rows[i].normal);
        if (rows[i].uv) {
            expect_doubles(&import, &(attribute_shape){HE_HALFEDGE, "uv", 2, 3},
                           (double[]){0.25, 0.5, 1, 0, 0.5, 0});
        }
        if (rows[i].normal) {
            expect_doubles(&import, &(attribute_shape){HE_HALFEDGE, "normal", 3, 3},
                           (double[]){0, 0, 1, 0, 0, 1, 1, 0, 0});
        }
        if (!rows[i].uv) {
            expect_warning(&import, "unused_uv", "", 3, 0);
        }
        if (!rows[i].normal) {
            expect_warning(&import, "unused_normal", "", 2, 0);
        }
        assert_int_equal(import.warnings.count, !rows[i].uv + !rows[i].normal);
        he_import_clear(&import);
    }

    /* If any corner uses a third texture coordinate, the attribute has three components. A face may
     * stand in the file before the values to which it refers. */
    he_import import = read_text("obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1/3 2/2 3/1\n"
                                        "vt 1 2 0\nvt 3 4 5\nvt 6\n");
    expect_doubles(&import, &(attribute_shape){HE_HALFEDGE, "uv", 3, 3},
                   (double[]){6, 0, 0, 3, 4, 5, 1, 2, 0});
    he_import_clear(&import);

    import = read_text("obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 1\nvt 1 2\nvn 0 0 1\n"
                              "f 1 2 3\nf 1/1 2 4//1\n");
    expect_doubles(&import, &(attribute_shape){HE_HALFEDGE, "uv", 2, 6},
                   (double[]){0, 0, 0, 0, 0, 0, 1, 2, 0, 0, 0, 0});
    expect_warning(&import, "corners_without_uv", "", 5, 0);
    expect_warning(&import, "corners_without_normal", "", 5, 0);
    he_import_clear(&import);
}

static void corner_values_reach_the_half_edges(void **state)
{
    (void)state;
    he_mesh *mesh = mesh_of_text("obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"
                                        "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvt 9 9\n"
                                        "f 1/1 2/2 3/3\nf 1/5 3/3 4/4\n");
    const he_column *uv = he_mesh_find_column(mesh, HE_HALFEDGE, "uv");
    assert_non_null(uv);
    for (uint32_t f = 0; f < 2; f++) {
        he_halfedge h = he_face_halfedge(mesh, (he_face){f});
        double row[2];
        memcpy(row, he_column_row(uv, h.i), sizeof row);
        assert_int_equal(he_origin(mesh, h).i, 0);
        assert_true(row[0] == (f == 0 ? 0 : 9));
    }
    he_mesh_free(mesh);
}

static void negative_indices(void **state)
{
    (void)state;
    he_import import = read_text("obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\n"
                                        "v 5 0 0\nv 6 0 0\nf -1 -2 1\nf 3 -5 4\n");
    expect_corners(&import, (uint32_t[]){0, 1, 2, 4, 3, 0, 2, 0, 3}, 9);
    he_import_clear(&import);
}

static void positive_indices_may_name_later_vertices(void **state)
{
    (void)state;
    he_import import = read_text("obj", "f 1 2 3\nv 0 0 0\nv 1 0 0\nv 0 1 0\n");
    expect_corners(&import, (uint32_t[]){0, 1, 2}, 3);
    he_import_clear(&import);
}

static void names_and_smoothing(void **state)
{
    (void)state;
    char text[600];
    snprintf(text, sizeof text,
             "%sv 0 0 1\nmtllib a file.mtl\nf 1 2 3\no  the thing \ng left  arm\t\n"
             "usemtl Material #25\ns 3\nf 1 3 4\nf 1 2 5\ng\ns off\nusemtl red\nf 2 3 5\n"
             "g left  arm\no\ns on\nf 3 4 5\n",
             cube);
    he_import import = read_text("obj", text);
    expect_counts(&import, 5, 5, 15);
    static const char *const objects[] = {"", "the thing", "the thing", "the thing", ""};
    static const char *const groups[] = {"", "left  arm", "left  arm", "", "left  arm"};
    static const char *const materials[] = {"", "Material #25", "Material #25", "red", "red"};
    for (size_t f = 0; f < 5; f++) {
        assert_string_equal(face_label(&import, "object", f), objects[f]);
        assert_string_equal(face_label(&import, "group", f), groups[f]);
        assert_string_equal(face_label(&import, "material", f), materials[f]);
    }
    expect_u32s(&import, &(attribute_shape){HE_FACE, "smoothing", 1, 5},
                (uint32_t[]){0, 3, 3, 0, 1});
    assert_null(find_column(&import, HE_FACE, "smoothing")->labels);
    expect_warning(&import, "library_missing", "a", 1, 6);
    expect_warning(&import, "library_missing", "file.mtl", 1, 6);
    he_import_clear(&import);

    /* No attribute is made of a group or object without faces, nor of a setting that all faces have
     * by default. */
    import = read_text("obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\ng\ns off\nf 1 2 3\no late\ng late\n");
    assert_int_equal(import.soup.column_count, 0);
    he_import_clear(&import);

    import =
        read_text("obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\ng one \\\n  two\\\nusemtl lost\nf 1 2 3\n");
    assert_string_equal(face_label(&import, "group", 0), "one    two usemtl lost");
    he_import_clear(&import);
}

static void names_are_utf8(void **state)
{
    (void)state;
    static const char start[] = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    static const struct {
        const char *name, *label;
        bool noted;
    } rows[] = {
        {"K\xC3\xB6rper \xE2\x82\xAC \xF0\x9F\x98\x80",
         "K\xC3\xB6rper \xE2\x82\xAC \xF0\x9F\x98\x80", false},
        {"K\xF6rper", "K\xC3\xB6rper", true},
        {"\xC0\x80", "\xC3\x80\xC2\x80", true},             /* an overlong form */
        {"\xED\xA0\x80", "\xC3\xAD\xC2\xA0\xC2\x80", true}, /* a surrogate */
        {"\xE2\x82", "\xC3\xA2\xC2\x82", true},             /* truncated */
        {"\xF5\x80\x80\x80", "\xC3\xB5\xC2\x80\xC2\x80\xC2\x80", true},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        char text[200];
        snprintf(text, sizeof text, "%so %s\nf 1 2 3\n", start, rows[i].name);
        he_import import = read_text("obj", text);
        assert_string_equal(face_label(&import, "object", 0), rows[i].label);
        assert_int_equal(import.warnings.count, rows[i].noted);
        he_import_clear(&import);
    }
}

static void lines_that_are_passed_over(void **state)
{
    (void)state;
    he_import import =
        read_text("obj", "mtllib /etc/passwd\nv 0 0 0\nv 1 0 0\nv 0 1 0\nl 1 2\nl 2 3\np 1 2 3\n"
                         "vp 0.1 0.2\ncstype bezier\nxyz 1 2 3\ncall evil.obj\nxyz 5\n"
                         "t crease 1/1/0 0 1 4.7\nf 1 2 3\n");
    expect_counts(&import, 3, 1, 3);
    expect_warning(&import, "library_missing", "/etc/passwd", 1, 1);
    expect_warning(&import, "ignored_keyword", "l", 2, 5);
    expect_warning(&import, "ignored_keyword", "p", 1, 7);
    expect_warning(&import, "ignored_keyword", "vp", 1, 8);
    expect_warning(&import, "ignored_keyword", "call", 1, 11);
    expect_warning(&import, "unknown_keyword", "xyz", 2, 10);
    expect_warning(&import, "ignored_keyword", "t", 1, 13);
    char text[HE_WARNING_TEXT];
    he_warning_text(find_warning(&import.warnings, "unknown_keyword", "xyz"), text, sizeof text);
    assert_string_equal(
        text, "a line with the unknown keyword 'xyz' is ignored, 2 times, first on line 10");
    he_warning_text(find_warning(&import.warnings, "ignored_keyword", "p"), text, sizeof text);
    assert_string_equal(text, "a line that begins with 'p' is ignored, because a mesh cannot hold "
                              "what it describes, on line 7");
    he_import_clear(&import);
}

static void the_subject_of_a_warning_stands_in_its_sentence(void **state)
{
    (void)state;
    static const struct {
        const char *text, *subject, *expected;
        uint64_t count;
        he_place place;
    } rows[] = {
        {"keyword % is ignored", "a%sb", "keyword 'a%sb' is ignored, on line 7", 1, HE_PLACE_LINE},
        {"keyword %", "xyz", "keyword 'xyz', 3 times, first at byte 7", 3, HE_PLACE_BYTE},
        {"% is ignored", "", "(unnamed) is ignored", 1, HE_PLACE_NONE},
        {"a face is ignored", NULL, "a face is ignored, 2 times", 2, HE_PLACE_NONE},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        he_warnings warnings = {0};
        const char *subject = rows[i].subject;
        char text[HE_WARNING_TEXT], cut[8];
        for (uint64_t k = 0; k < rows[i].count; k++) {
            he_warnings_add(&warnings,
                            &(he_occurrence){.code = "code",
                                             .text = rows[i].text,
                                             .subject = subject,
                                             .length = subject == NULL ? 0 : strlen(subject),
                                             .place = rows[i].place,
                                             .at = 7 + k});
        }
        size_t length = he_warning_text(&warnings.items[0], text, sizeof text);
        assert_string_equal(text, rows[i].expected);
        assert_int_equal(length, strlen(text));
        assert_int_equal(he_warning_text(&warnings.items[0], cut, sizeof cut), sizeof cut - 1);
        assert_memory_equal(cut, text, sizeof cut - 1);
    }
}

static void notes_have_an_end(void **state)
{
    (void)state;
    char *text = malloc(100000);
    assert_non_null(text);
    size_t length = (size_t)snprintf(text, 100000, "%s", cube);
    for (int i = 0; i < 5000; i++) {
        length += (size_t)snprintf(text + length, 100000 - length, "k%d\n", i);
    }
    he_import import = {0};
    he_error err = {0};
    assert_int_equal(read_pieces(&(format_file){"obj", text, length}, 0, NULL, &import, &err),
                     HE_OK);
    assert_int_equal(import.warnings.count, HE_WARNINGS);
    assert_int_equal(import.warnings.more, 5000 - HE_WARNINGS);
    he_import_clear(&import);
    free(text);
}

static void wrong_indices_name_their_line(void **state)
{
    (void)state;
    static const struct {
        const char *lines;
        uint64_t line;
        const char *words;
    } rows[] = {
        {"f 0 1 2\n", 5, "vertex 0"},
        {"f 1 2 5\n", 5, "vertex 5"},
        {"f 1 2 3\nf 1 2 \\\n 7\n", 6, "vertex 7"},
        {"f 1 2 3\nf 1 2 \\\n -7\n", 7, "vertex -7"},
        {"f 1 2 -5\n", 5, "vertex -5"},
        {"f 1 2 4294967297\n", 5, "vertex 4294967297"},
        {"f 1 2 4294967295\n", 5, "vertex 4294967295"},
        {"f 1 2 2147483648\n", 5, "vertex 2147483648"},
        {"f 1 2 18446744073709551617\n", 5, "vertex 18446744073709551617"},
        {"f 1 2 -2147483648\n", 5, "vertex -2147483648"},
        {"f 1 2 -9223372036854775808\n", 5, "vertex -9223372036854775808"},
        {"f 1 2 99999999999999999999999999999999999999999\n", 5, "vertex 99999"},
        {"vt 0 0\nf 1/1 2/0 3/1\n", 6, "texture coordinate 0"},
        {"vt 0 0\nf 1/1 2/-0 3/1\n", 6, "texture coordinate -0"},
        {"vn 0 0 1\nf 1 2 3\nf 1//1 2//1 3//00\n", 7, "normal 00"},
        {"f 1 2 3\n\n\nf 2 3 4\nf 3 4 9\nf 3 9 1\n", 9, "vertex 9"},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        char text[300];
        snprintf(text, sizeof text, "%s%s", cube, rows[i].lines);
        expect_refused("obj", text, HE_BAD_INDEX, rows[i].line, rows[i].words);
    }
}

static void wrong_values_cost_the_corner_its_value(void **state)
{
    (void)state;
    static const struct {
        const char *lines, *code;
        uint64_t count, at;
        double corner[2];
    } rows[] = {
        {"f 1/1 2/3 3/2\n", "no_such_uv", 1, 7, {0, 0}},
        {"f 1/1 2/-3 3/2\n", "no_such_uv", 1, 7, {0, 0}},
        {"f 1/1 2/99999999999999999999 3/2\n", "no_such_uv", 1, 7, {0, 0}},
        {"f 1/1 2/4294967297 3/2\nf 1/9 3/9 4/1\n", "no_such_uv", 3, 7, {0, 0}},
        {"f 1/1/1 2/2 3/2\n", "no_such_normal", 1, 7, {3, 4}},
        {"f 1/1 2/2/-1 \\\n 3/2//\n", NULL, 0, 0, {0, 0}},
        {"vt nan -1.#IND 7\nf 1/1 2/3 3/2\n", "not_finite", 2, 7, {0, 0}},
        {"vt 5 6 7 8 nan\nf 1/1 2/3 3/2\n", "extra_numbers", 1, 7, {5, 6}},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        char text[300];
        snprintf(text, sizeof text, "%svt 1 2\nvt 3 4\n%s", cube, rows[i].lines);
        if (rows[i].code == NULL) {
            expect_refused("obj", text, HE_SYNTAX, 8, "is not a valid corner");
            continue;
        }
        he_import import = read_text("obj", text);
        const he_warning *note = find_warning(&import.warnings, rows[i].code, "");
        assert_non_null(note);
        assert_int_equal(note->count, rows[i].count);
        assert_int_equal(note->at, rows[i].at);
        const he_column *uv = find_column(&import, HE_HALFEDGE, "uv");
        assert_memory_equal(he_column_row(uv, 1), rows[i].corner, sizeof rows[i].corner);
        he_import_clear(&import);
    }
    /* The corners refer to texture coordinates, but the file has none: no attribute is made, and a
     * warning counts the corners. */
    he_import import = read_text("obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1/1 2/1 3/1\n");
    assert_int_equal(import.soup.column_count, 0);
    assert_int_equal(find_warning(&import.warnings, "no_such_uv", "")->count, 3);
    he_import_clear(&import);
}

static void more_numbers_than_a_vertex_has(void **state)
{
    (void)state;
    he_import import = read_text("obj", "v 1 2 3 4 5\nv 1 2 3 4 5 6 7 8\nv 1 2 3 inf 5 6\n");
    assert_int_equal(find_warning(&import.warnings, "extra_numbers", "")->count, 2);
    assert_int_equal(find_warning(&import.warnings, "not_finite", "")->at, 3);
    assert_int_equal(find_warning(&import.warnings, "vertices_without_color", "")->count, 2);
    expect_bytes(&import, HE_VERTEX, 3, (const unsigned char[]){0, 0, 0, 0, 0, 0, 0, 5, 6}, 3);
    he_import_clear(&import);
}

static void lines_that_begin_with_a_dollar_are_passed_over(void **state)
{
    (void)state;
    static const char text[] = "$ made by a program\n$$v 9 9 9\nv 0 0 0\nv 1 0 0\n"
                               "  $ f 9 9 \\\n 9\nv 0 1 0\nf 1 2 3\n";
    he_import import = read_text("obj", text);
    expect_counts(&import, 3, 1, 3);
    expect_warning(&import, "ignored_keyword", "$", 3, 1);
    assert_int_equal(import.warnings.count, 1);
    assert_ptr_equal(he_format_sniff(text, strlen(text)), he_format_find("obj"));
    he_import_clear(&import);
}

static void wrong_text_names_its_line(void **state)
{
    (void)state;
    static const struct {
        const char *lines;
        he_status status;
        uint64_t line;
        const char *words;
    } rows[] = {
        {"v 1 2\n", HE_SYNTAX, 5, "not 2"},
        {"v\n", HE_SYNTAX, 5, "not 0"},
        {"v 1 2 3 4 x\n", HE_SYNTAX, 5, "'x' is not a number"},
        {"v 1 2 3 4 5 6 7 v 4\n", HE_SYNTAX, 5, "'v' is not a number"},
        {"v 1 2 x\n", HE_SYNTAX, 5, "'x' is not a number"},
        {"v 1 2 0x10\n", HE_SYNTAX, 5, "'0x10' is not a number"},
        {"v 1,5 2,5 3,5\n", HE_SYNTAX, 5, "'1,5' is not a number"},
        {"v 1 2 3e\n", HE_SYNTAX, 5, "'3e' is not a number"},
        {"v 1 2 \\\n\\\n zz\n", HE_SYNTAX, 7, "'zz' is not a number"},
        {"v 1 2 nan\n", HE_NOT_FINITE, 5, "'nan' is not finite"},
        {"v 1 -Inf 2\n", HE_NOT_FINITE, 5, "'-Inf' is not finite"},
        {"v 1 2 1e999\n", HE_NOT_FINITE, 5, "'1e999' is not finite"},
        {"v 1 2 -1.#IND\n", HE_NOT_FINITE, 5, "not finite"},
        {"v 1 2 \x01\x02\xFF\n", HE_SYNTAX, 5, "'\?\?\?' is not a number"},
        {"vt\n", HE_SYNTAX, 5, "needs 1"},
        {"vt 1 2 3 x\n", HE_SYNTAX, 5, "'x' is not a number"},
        {"vt nanx 2\n", HE_SYNTAX, 5, "'nanx' is not a number"},
        {"vn 1 2\n", HE_SYNTAX, 5, "needs 3"},
        {"f\n", HE_TOO_FEW_CORNERS, 5, "the face has no corners"},
        {"f # none\n", HE_TOO_FEW_CORNERS, 5, "the face has no corners"},
        {"f 1 2 a\n", HE_SYNTAX, 5, "'a' is not a valid corner"},
        {"f 1 2 3.0\n", HE_SYNTAX, 5, "'3.0' is not a valid corner"},
        {"f 1 2 3/1/1/1\n", HE_SYNTAX, 5, "is not a valid corner"},
        {"f 1 2 /1\n", HE_SYNTAX, 5, "is not a valid corner"},
        {"f 1 2 --3\n", HE_SYNTAX, 5, "is not a valid corner"},
        {"f 1 2 ++3\n", HE_SYNTAX, 5, "is not a valid corner"},
        {"f 1 2 3\nf 1 2 3x\n", HE_SYNTAX, 6, "is not a valid corner"},
        {"s 1.5\n", HE_SYNTAX, 5, "smoothing"},
        {"s 4294967296\n", HE_SYNTAX, 5, "smoothing"},
        {"1 2 3\n", HE_SYNTAX, 5, "'1' cannot begin"},
        {"{\"vertices\": []}\n", HE_SYNTAX, 5, "cannot begin"},
        {"<html>\n", HE_SYNTAX, 5, "cannot begin"},
        {"g a\tb\x07\n", HE_SYNTAX, 5, "control character 7"},
        {"v 1 2 3\rv 4 5 6\n", HE_SYNTAX, 5, "is not a number"},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        char text[300];
        snprintf(text, sizeof text, "%s%s", cube, rows[i].lines);
        expect_refused("obj", text, rows[i].status, rows[i].line, rows[i].words);
    }
    expect_refused("obj", "", HE_SYNTAX, 1, "no line of it is a vertex");
    expect_refused("obj", "hello world\nthis is not a mesh\n", HE_SYNTAX, 1, "not an OBJ file");
    /* hedge writes an empty mesh as a file of comments only, so such a file must be read as an
     * empty mesh. */
    he_import import = read_text("obj", "# 0 vertices, 0 faces\n");
    expect_counts(&import, 0, 0, 0);
    he_import_clear(&import);
}

static void other_encodings_are_refused(void **state)
{
    (void)state;
    static const char little[] = "\xFF\xFEv\0 \0000\0 \0000\0 \0000\0\n\0";
    static const char big[] = "\xFE\xFF\0v\0 \0000\0 \0000\0 \0000\0\n";
    static const char unmarked[] = "v\0 \0000\0 \0000\0 \0000\0\n\0";
    static const char comment[] = "#\0 \0\n\0v\0 \0000\0\n\0";
    expect_bytes_refused(&(format_file){"obj", little, sizeof little - 1}, HE_UNSUPPORTED, 1,
                         "UTF-16");
    expect_bytes_refused(&(format_file){"obj", big, sizeof big - 1}, HE_UNSUPPORTED, 1, "UTF-16");
    expect_bytes_refused(&(format_file){"obj", unmarked, sizeof unmarked - 1}, HE_UNSUPPORTED, 1,
                         "UTF-16");
    expect_bytes_refused(&(format_file){"obj", comment, sizeof comment - 1}, HE_UNSUPPORTED, 1,
                         "UTF-16");
    static const char zero[] = "v 0 0 0\nv 0 \0 0\n";
    expect_bytes_refused(&(format_file){"obj", zero, sizeof zero - 1}, HE_SYNTAX, 2, "a NUL byte");
    static const char hidden[] = "v 0 0 0\n# a \\\n\0\nv 0 0 0\n";
    expect_bytes_refused(&(format_file){"obj", hidden, sizeof hidden - 1}, HE_SYNTAX, 3,
                         "a NUL byte");
    static const char empty[] = "\xFF\xFE\n\0v\0 \0";
    expect_bytes_refused(&(format_file){"obj", empty, sizeof empty - 1}, HE_UNSUPPORTED, 1,
                         "UTF-16");
}

/* The reader accepts faces that no mesh can represent. When he_build refuses them later, the error
 * must still name the line of the face. */
static void refusals_of_the_builder_get_a_line(void **state)
{
    (void)state;
    static const struct {
        const char *lines;
        he_status status;
        uint64_t line;
    } rows[] = {
        {"f 1 2 3\nf 1 2\n", HE_TOO_FEW_CORNERS, 6},
        {"f 1 2 3\n\nf 4\n", HE_TOO_FEW_CORNERS, 7},
        {"f 1 2 3 4\nf 1 2 1 3\n", HE_REPEATED_CORNER, 6},
        {"f 1 2 3\n# x\nf 1 2 4\n", HE_ORIENTATION, 7},
        {"v 0 0 1\nf 1 2 3\nf 2 1 4\n\nf 1 2 5\n", HE_NONMANIFOLD_EDGE, 9},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        char text[300];
        snprintf(text, sizeof text, "%s%s", cube, rows[i].lines);
        he_import import = read_text("obj", text);
        he_mesh *mesh = NULL;
        he_error err = {0};
        he_status status = he_build(&import.soup, 0, &mesh, NULL, &err);
        he_import_locate(&import, &err);
        if (status != rows[i].status || err.place != HE_PLACE_LINE || err.at != rows[i].line) {
            fail_msg("%s: %s at %llu", rows[i].lines, err.text, (unsigned long long)err.at);
        }
        he_import_clear(&import);
    }
    he_error err = {.kind = HE_VERTEX, .id = 2};
    he_import import = read_text("obj", "v 0 0 0\n\nv 0 0 0\n\n\nv 0 0 0\n");
    he_import_locate(&import, &err);
    assert_int_equal(err.at, 6);
    he_import_clear(&import);
}

static void limits_are_kept(void **state)
{
    (void)state;
    static const char text[] = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nf 1 2 3 4\nf 1/1 2 3\n";
    static const struct {
        he_limits limits;
        he_status status;
        uint64_t line;
    } rows[] = {
        {{.vertices = 4, .faces = 2, .corners = 7}, HE_OK, 0},
        {{.vertices = 3}, HE_LIMIT, 4},
        {{.faces = 1}, HE_LIMIT, 7},
        {{.corners = 6}, HE_LIMIT, 7},
        {{.bytes = 100}, HE_LIMIT, 1},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        he_import import = {0};
        he_error err = {0};
        he_status status = read_pieces(&(format_file){"obj", text, strlen(text)}, 1,
                                       &rows[i].limits, &import, &err);
        assert_int_equal(status, rows[i].status);
        if (status == HE_OK) {
            he_import_clear(&import);
        } else {
            assert_int_equal(err.place, HE_PLACE_LINE);
            assert_int_equal(err.at, rows[i].line);
        }
    }
    /* A line that does not end must be refused before it fills the memory. */
    he_limits limits = {.bytes = 1000};
    he_reader *reader;
    he_error err = {0};
    assert_int_equal(he_reader_new(he_format_find("obj"), &limits, &reader, &err), HE_OK);
    he_status status = HE_OK;
    int fed = 0;
    while (status == HE_OK && fed < 10000) {
        status = he_reader_feed(reader, "f 1 2 3 ", 8, &err);
        fed += 8;
    }
    assert_int_equal(status, HE_LIMIT);
    assert_true(fed < 1100);
    he_reader_free(reader);
}

static void it_is_recognised(void **state)
{
    (void)state;
    static const char *const objs[] = {"v 0 0 0\n", "# x\n\n  mtllib a\n", "o thing",
                                       "\xEF\xBB\xBFv 1"};
    for (size_t i = 0; i < sizeof objs / sizeof *objs; i++) {
        assert_ptr_equal(he_format_sniff(objs[i], strlen(objs[i])), he_format_find("obj"));
    }
    static const char *const others[] = {"",          "sold x", "ply?\n", "gltf",
                                         "{\"v\":1}", "# only", "vx 1"};
    for (size_t i = 0; i < sizeof others / sizeof *others; i++) {
        assert_null(he_format_sniff(others[i], strlen(others[i])));
    }
    assert_ptr_equal(he_format_of_media_type("Model/OBJ; charset=utf-8"), he_format_find("obj"));
    assert_ptr_equal(he_format_of_extension("OBJ"), he_format_find("obj"));
    assert_null(he_format_of_media_type("model/objx"));
    assert_null(he_format_of_media_type("model"));
    assert_null(he_format_find("OBJ "));
    assert_int_equal(he_format_encoding(he_format_find("obj"), "ascii"), 0);
    assert_int_equal(he_format_encoding(he_format_find("obj"), "binary"), -1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(vertices_and_polygons),
        cmocka_unit_test(white_space_and_line_ends),
        cmocka_unit_test(lines_that_end_in_returns),
        cmocka_unit_test(vertex_forms),
        cmocka_unit_test(corner_forms),
        cmocka_unit_test(corner_values_reach_the_half_edges),
        cmocka_unit_test(negative_indices),
        cmocka_unit_test(positive_indices_may_name_later_vertices),
        cmocka_unit_test(names_and_smoothing),
        cmocka_unit_test(names_are_utf8),
        cmocka_unit_test(lines_that_are_passed_over),
        cmocka_unit_test(the_subject_of_a_warning_stands_in_its_sentence),
        cmocka_unit_test(notes_have_an_end),
        cmocka_unit_test(wrong_indices_name_their_line),
        cmocka_unit_test(wrong_values_cost_the_corner_its_value),
        cmocka_unit_test(more_numbers_than_a_vertex_has),
        cmocka_unit_test(lines_that_begin_with_a_dollar_are_passed_over),
        cmocka_unit_test(wrong_text_names_its_line),
        cmocka_unit_test(other_encodings_are_refused),
        cmocka_unit_test(refusals_of_the_builder_get_a_line),
        cmocka_unit_test(limits_are_kept),
        cmocka_unit_test(it_is_recognised),
    };
    return cmocka_run_group_tests_name("format_obj", tests, NULL, NULL);
}
