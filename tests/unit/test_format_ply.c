/* PLY files: every number type in every encoding, what the names of properties mean, and errors. */
#include "unit/ply_file.h"

#include <float.h>
#include <math.h>

static void expect_points(const he_import *import, const double (*points)[3], size_t count)
{
    assert_int_equal(import->soup.vertex_count, count);
    for (size_t i = 0; i < count; i++) {
        const he_vec3 *p = &import->soup.positions[i];
        assert_true(p->x == points[i][0] && p->y == points[i][1] && p->z == points[i][2]);
    }
}

/* --- types --- */

/* Reads a square in every combination of number types for its coordinates, for the counts of
 * corners, and for the corners. */
static void every_type_in_every_encoding(void **state)
{
    (void)state;
    static const uint32_t corners[] = {0, 1, 2, 0, 2, 3};
    for (ply_encoding e = TEXT; e <= MOST_FIRST; e++) {
        for (size_t i = 0; i < TYPES * WHOLE_TYPES * TYPES; i++) {
            size_t type = i % TYPES, count = i / TYPES % WHOLE_TYPES;
            size_t index = i / TYPES / WHOLE_TYPES;
            char header[400];
            snprintf(header, sizeof header,
                     "element vertex 4\nproperty %s x\nproperty %s y\nproperty %s z\n"
                     "property %s quality\nelement face 2\nproperty list %s %s %s\nend_header\n",
                     ply_types[type].names[0], ply_types[type].names[1],
                     ply_types[type].names[i & 1], ply_types[type].names[0],
                     ply_types[count].names[i & 1], ply_types[index].names[i & 1],
                     i & 1 ? "vertex_index" : "vertex_indices");
            ply_file f;
            ply_begin(&f, e, header);
            for (size_t v = 0; v < 4; v++) {
                for (size_t k = 0; k < 3; k++) {
                    ply_put_value(&f, type, ply_square[v][k]);
                }
                ply_put_value(&f, type, ply_types[type].is_signed ? -3 : 77);
                ply_end_row(&f);
            }
            for (size_t k = 0; k < 6; k++) {
                if (k % 3 == 0) {
                    ply_put_value(&f, count, 3);
                }
                ply_put_value(&f, index, corners[k]);
                if (k % 3 == 2) {
                    ply_end_row(&f);
                }
            }
            he_import import = {0};
            he_error err = {0};
            if (read_pieces(&(format_file){"ply", f.bytes, f.length}, 1 + i % 9, NULL, &import,
                            &err) != HE_OK) {
                fail_msg("%s: %s", header, err.text);
            }
            expect_points(&import, ply_square, 4);
            expect_corners(&import, corners, 6);
            assert_int_equal(import.warnings.count, ply_types[index].is_float);
            if (ply_types[index].is_float) {
                expect_warning(&import, "fraction_indices", ply_types[index].names[0], 1, 9);
            }
            const he_column *column = find_column(&import, HE_VERTEX, "quality");
            assert_non_null(column);
            assert_int_equal(column->type, ply_types[type].column);
            assert_int_equal(column->rows, 4);
            he_import_clear(&import);
        }
    }
}

static void extreme_values_arrive(void **state)
{
    (void)state;
    static const struct {
        size_t type;
        double value;
    } rows[] = {{0, -128},       {0, 127},      {1, 255},         {2, -32768},
                {2, 32767},      {3, 65535},    {4, -2147483648}, {4, 2147483647},
                {5, 4294967295}, {6, -0.0},     {6, 0.1f},        {7, 0.1},
                {7, 5e-324},     {7, -DBL_MAX}, {6, 16777216.0},  {7, 1e300}};
    for (ply_encoding e = TEXT; e <= MOST_FIRST; e++) {
        for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
            size_t type = rows[i].type;
            char header[300];
            snprintf(header, sizeof header,
                     "element vertex 1\nproperty %s q\nproperty double z\nproperty %s y\n"
                     "property %s x\nend_header\n",
                     ply_types[type].names[1], ply_types[type].names[0], ply_types[type].names[1]);
            ply_file f;
            ply_begin(&f, e, header);
            ply_put_value(&f, type, rows[i].value);
            ply_put_value(&f, DOUBLE, 1.5);
            ply_put_value(&f, type, rows[i].value);
            ply_put_value(&f, type, rows[i].value);
            ply_end_row(&f);
            he_import import = ply_read(&f);
            he_vec3 wanted = {rows[i].value, rows[i].value, 1.5};
            assert_memory_equal(import.soup.positions, &wanted, sizeof wanted);
            const he_column *q = find_column(&import, HE_VERTEX, "q");
            const void *row = he_column_row(q, 0);
            if (type == FLOAT) {
                float value = (float)rows[i].value;
                assert_memory_equal(row, &value, sizeof value);
            } else if (type == DOUBLE) {
                assert_memory_equal(row, &rows[i].value, sizeof rows[i].value);
            } else if (ply_types[type].is_signed) {
                int32_t value = (int32_t)rows[i].value;
                assert_memory_equal(row, &value, sizeof value);
            } else {
                uint32_t value = (uint32_t)rows[i].value;
                assert_memory_equal(row, &value, sizeof value);
            }
            he_import_clear(&import);
        }
    }
}

static void elements_and_properties_in_any_order(void **state)
{
    (void)state;
    static const uint32_t corners[] = {0, 1, 2, 3, 0, 2, 3}, groups[] = {7, 9};
    for (ply_encoding e = TEXT; e <= MOST_FIRST; e++) {
        ply_file f;
        ply_begin(&f, e,
                  "comment made by hand # not a comment sign\nobj_info anything at all\n"
                  "element face 2\nproperty float angle\n"
                  "property list ushort uchar vertex_index\nproperty uchar group\n\n"
                  "element vertex 4\nproperty double z\n  property\tshort  x\nproperty float y\n"
                  "element edge 0\nend_header\n");
        ply_put_value(&f, FLOAT, 0.5);
        ply_put_value(&f, 3, 4);
        for (size_t k = 0; k < 4; k++) {
            ply_put_value(&f, UCHAR, corners[k]);
        }
        ply_put_value(&f, UCHAR, 7);
        ply_end_row(&f);
        ply_put_value(&f, FLOAT, -0.5);
        ply_put_value(&f, 3, 3);
        for (size_t k = 4; k < 7; k++) {
            ply_put_value(&f, UCHAR, corners[k]);
        }
        ply_put_value(&f, UCHAR, 9);
        ply_end_row(&f);
        for (size_t v = 0; v < 4; v++) {
            ply_put_value(&f, DOUBLE, ply_square[v][2]);
            ply_put_value(&f, 2, ply_square[v][0]);
            ply_put_value(&f, FLOAT, ply_square[v][1]);
            ply_end_row(&f);
        }
        he_import import = ply_read(&f);
        expect_points(&import, ply_square, 4);
        expect_corners(&import, corners, 7);
        expect_u32s(&import, &(attribute_shape){HE_FACE, "group", 1, 2}, groups);
        assert_int_equal(find_column(&import, HE_FACE, "angle")->type, HE_FLOAT);
        assert_int_equal(import.warnings.count, 0);
        he_import_clear(&import);
    }
}

/* --- properties --- */

static void properties_become_attributes(void **state)
{
    (void)state;
    static const double points[2][3] = {{1, 2, 3}, {4, 5, 6}};
    static const unsigned char colors[] = {255, 0, 7, 128, 0, 1, 2, 3}, faces[] = {9, 8, 7};
    static const float normals[] = {0, 0, 1, 0, 1, 0}, uvs[] = {0.25f, 0.5f, 0.75f, 1};
    static const double qualities[] = {0.1, -1e300};
    static const int32_t marks[] = {-5, 5};
    he_import import =
        read_text("ply", ASCII "element vertex 2\n" XYZ "property float nx\nproperty float ny\n"
                               "property float nz\nproperty uchar red\nproperty uchar green\n"
                               "property uchar blue\nproperty uchar alpha\nproperty float s\n"
                               "property float t\nproperty double quality\nproperty short mark\n"
                               "property float u\nelement face 1\n" CORNER
                               "property uchar red\nproperty uchar green\nproperty uchar blue\n"
                               "end_header\n"
                               "1 2 3 0 0 1 255 0 7 128 .25 .5 .1 -5 1\n"
                               "4 5 6 0 1 0 0 1 2 3 .75 1 -1e300 5 2\n3 0 1 0 9 8 7\n");
    expect_points(&import, points, 2);
    expect_bytes(&import, HE_VERTEX, 4, colors, 2);
    expect_bytes(&import, HE_FACE, 3, faces, 1);
    expect_doubles(&import, &(attribute_shape){HE_VERTEX, "quality", 1, 2}, qualities);
    const he_column *column = find_column(&import, HE_VERTEX, "normal");
    assert_int_equal(column->type, HE_FLOAT);
    assert_int_equal(column->components, 3);
    assert_int_equal(column->rule, HE_INTERPOLATE);
    assert_memory_equal(column->data, normals, sizeof normals);
    column = find_column(&import, HE_VERTEX, "uv");
    assert_int_equal(column->components, 2);
    assert_memory_equal(column->data, uvs, sizeof uvs);
    column = find_column(&import, HE_VERTEX, "mark");
    assert_int_equal(column->rule, HE_COPY);
    assert_memory_equal(column->data, marks, sizeof marks);
    assert_non_null(find_column(&import, HE_VERTEX, "u"));
    assert_int_equal(import.warnings.count, 0);
    he_import_clear(&import);
}

static void groups_have_several_spellings(void **state)
{
    (void)state;
    static const struct {
        const char *properties, *attribute;
        uint32_t components;
        he_type type;
    } rows[] = {
        {"property uchar r\nproperty uchar g\nproperty uchar b\n", "color", 3, HE_FLOAT},
        {"property uchar b\nproperty uchar g\nproperty uchar r\nproperty uchar a\n", "color", 4,
         HE_FLOAT},
        {"property float red\nproperty float green\nproperty float blue\n", "color", 3, HE_FLOAT},
        {"property float u\nproperty float v\n", "uv", 2, HE_FLOAT},
        {"property double texture_u\nproperty float texture_v\n", "uv", 2, HE_DOUBLE},
        {"property float texture_s\nproperty float texture_t\n", "uv", 2, HE_FLOAT},
        {"property char nz\nproperty uchar ny\nproperty short nx\n", "normal", 3, HE_DOUBLE},
        {"property float nx\nproperty float nz\n", "nx", 1, HE_FLOAT},
        {"property int alpha\n", "alpha", 1, HE_INT32},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        char text[500];
        snprintf(text, sizeof text, ASCII "element vertex 1\n" XYZ "%send_header\n0 0 0 1 2 3 4\n",
                 rows[i].properties);
        he_import import = read_text("ply", text);
        const he_column *column = find_column(&import, HE_VERTEX, rows[i].attribute);
        assert_non_null(column);
        assert_int_equal(column->components, rows[i].components);
        assert_int_equal(column->type, rows[i].type);
        he_import_clear(&import);
    }
}

/* The brightest value of a colour component is 1 in a mesh. In a PLY file it is 65535 for the type
 * ushort, 255 for uchar and other types of whole numbers, and 1 for float and double. */
static void colors_of_every_type_are_fractions(void **state)
{
    (void)state;
    static const struct {
        const char *type, *values;
        double first; /* expected value of the first component of the colour */
    } rows[] = {{"uchar", "51 0 255", 0.2}, {"ushort", "13107 0 65535", 0.2},
                {"int", "51 0 255", 0.2},   {"float", "0.2 0 1", 0.2},
                {"double", "0.2 0 1", 0.2}, {"float", "1.5 0 1", 1.5}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        char text[400];
        snprintf(text, sizeof text,
                 ASCII "element vertex 1\n" XYZ "property %s red\nproperty %s green\n"
                       "property %s blue\nend_header\n0 0 0 %s\n",
                 rows[i].type, rows[i].type, rows[i].type, rows[i].values);
        he_import import = read_text("ply", text);
        const he_column *column = find_column(&import, HE_VERTEX, "color");
        bool wide = strcmp(rows[i].type, "double") == 0;
        assert_int_equal(column->type, wide ? HE_DOUBLE : HE_FLOAT);
        if (wide) {
            assert_memory_equal(column->data, ((double[]){rows[i].first, 0, 1}), 24);
        } else {
            assert_memory_equal(column->data, ((float[]){(float)rows[i].first, 0, 1}), 12);
        }
        he_import_clear(&import);
    }
    expect_refused("ply",
                   ASCII "element vertex 1\n" XYZ "property uchar red\nproperty uchar green\n"
                         "property uchar blue\nend_header\n0 0 0 1 .5 1\n",
                   HE_BAD_VALUE, 11, "a value of property 'green' does not fit its type uchar");
}

static void what_is_left_out_is_noted(void **state)
{
    (void)state;
    for (ply_encoding e = TEXT; e <= MOST_FIRST; e++) {
        ply_file f;
        ply_begin(&f, e,
                  "element material 2\nproperty float shine\nproperty int number\n"
                  "element vertex 3\n" XYZ "property list uchar float weights\n"
                  "element face 1\n" CORNER "property list int double heights\n"
                  "element strange 2\nproperty list uchar ushort pairs\nproperty uchar last\n"
                  "end_header\n");
        for (size_t k = 0; k < 2; k++) {
            ply_put_value(&f, FLOAT, 1);
            ply_put_value(&f, INT, 2);
            ply_end_row(&f);
        }
        for (size_t v = 0; v < 3; v++) {
            for (size_t k = 0; k < 3; k++) {
                ply_put_value(&f, FLOAT, ply_square[v][k]);
            }
            ply_put_value(&f, UCHAR, (double)v);
            for (size_t k = 0; k < v; k++) {
                ply_put_value(&f, FLOAT, 0.5);
            }
            ply_end_row(&f);
        }
        for (size_t k = 0; k < 4; k++) {
            ply_put_value(&f, k == 0 ? UCHAR : INT, k == 0 ? 3 : (double)k - 1);
        }
        ply_put_value(&f, INT, 6);
        for (size_t k = 0; k < 6; k++) {
            ply_put_value(&f, DOUBLE, 0.25);
        }
        ply_end_row(&f);
        for (size_t k = 0; k < 2; k++) {
            ply_put_value(&f, UCHAR, 2);
            ply_put_value(&f, 3, 2);
            ply_put_value(&f, 3, 2);
            ply_put_value(&f, UCHAR, 2);
            ply_end_row(&f);
        }
        he_import import = ply_read(&f);
        expect_counts(&import, 3, 1, 3);
        expect_points(&import, ply_square, 3);
        expect_warning(&import, "ignored_element", "material", 1, 3);
        expect_warning(&import, "ignored_list", "weights", 1, 10);
        expect_warning(&import, "ignored_list", "heights", 1, 13);
        expect_warning(&import, "ignored_element", "strange", 1, 14);
        assert_int_equal(import.warnings.count, 4);
        assert_int_equal(import.soup.column_count, 0);
        he_import_clear(&import);
    }
    he_import import = read_text(
        "ply", ASCII "element vertex 1\n" XYZ
                     "property float a_name_of_more_bytes_than_the_name_of_an_attribute_can_have_"
                     "in_all\nproperty float caf\xC3\xA9\nproperty uchar uv\nproperty float s\n"
                     "property float t\nend_header\n0 0 0 1 2 3 4 5 6 7\n\n1 2\n3\n");
    expect_warning(&import, "ignored_property", "caf??", 1, 8);
    expect_warning(&import, "ignored_property", "uv", 1, 9);
    expect_warning(&import, "extra_numbers", "", 1, 13);
    expect_warning(&import, "trailing_lines", "", 2, 15);
    assert_int_equal(import.warnings.count, 5);
    he_import_clear(&import);
    import = read_text("ply", ASCII "element vertex 1\n" XYZ
                                    "property float position\nend_header\n0 0 0 7\n");
    expect_warning(&import, "renamed_property", "position", 1, 7);
    assert_int_equal(import.soup.column_count, 1);
    assert_string_equal(import.soup.columns[0]->name, "position_1");
    he_import_clear(&import);
    static const char trailing[] =
        LITTLE "element vertex 1\nproperty char x\nproperty char y\nproperty char z\nend_header\n"
               "\1\2\3\n\0\0";
    assert_int_equal(read_bytes("ply", trailing, sizeof trailing - 1, &import, &(he_error){0}),
                     HE_OK);
    expect_warning(&import, "trailing_bytes", "", 1, sizeof trailing - 4);
    he_import_clear(&import);
}

static void values_that_are_not_finite(void **state)
{
    (void)state;
    static const float wanted[] = {0, 1, 0, 0};
    for (ply_encoding e = LEAST_FIRST; e <= MOST_FIRST; e++) {
        ply_file f;
        ply_begin(&f, e, "element vertex 4\n" XYZ "property float q\nend_header\n");
        static const double values[] = {NAN, 1, INFINITY, -INFINITY};
        for (size_t v = 0; v < 4; v++) {
            for (size_t k = 0; k < 3; k++) {
                ply_put_value(&f, FLOAT, 0);
            }
            ply_put_value(&f, FLOAT, values[v]);
        }
        he_import import = ply_read(&f);
        assert_memory_equal(find_column(&import, HE_VERTEX, "q")->data, wanted, sizeof wanted);
        expect_warning(&import, "not_finite", "q", 3, f.length - 64);
        he_import_clear(&import);
    }
    he_import import =
        read_text("ply", ASCII "element vertex 4\n" XYZ "property float q\nend_header\n"
                               "0 0 0 nan\n0 0 0 1\n0 0 0 1e999\n0 0 0 -1e39\n");
    assert_memory_equal(find_column(&import, HE_VERTEX, "q")->data, wanted, sizeof wanted);
    expect_warning(&import, "not_finite", "q", 3, 9);
    he_import_clear(&import);
}

/* --- traps --- */

static void lines_that_end_in_returns(void **state)
{
    (void)state;
    static const char text[] =
        "ply\rformat ascii 1.0\relement vertex 3\rproperty float x\rproperty float y\r"
        "property float z\relement face 1\rproperty list int int vertex_index\rend_header\r"
        "0 0 0\r1 0 0\r0 1 0\r3 0 1 2\r";
    he_import import = read_text("ply", text);
    expect_counts(&import, 3, 1, 3);
    assert_int_equal(he_source_map_find(&import.vertices, 2), 12);
    assert_int_equal(import.warnings.count, 0);
    he_import_clear(&import);
    static const char empty[] = "ply\rformat ascii 1.0\relement vertex 0\rend_header";
    import = read_text("ply", empty);
    expect_counts(&import, 0, 0, 0);
    he_import_clear(&import);
}

/* Rhinoceros ends the lines of a header by a carriage return alone. The binary data begins right
 * after the header's last carriage return, even if the first byte of the data looks like the line
 * feed that would complete a line end. */
static void a_header_that_ends_in_returns_before_a_binary_body(void **state)
{
    (void)state;
    static const char header[] = "ply\rformat binary_little_endian 1.0\rcomment made by\r"
                                 "element vertex 3\rproperty char x\rproperty char y\r"
                                 "property char z\relement face 1\r"
                                 "property list uchar uchar vertex_index\rend_header\r";
    static const char body[] = "\n\r\r"
                               "\r\n\0"
                               "\n\n\r"
                               "\3\2\1\0";
    static const uint32_t corners[] = {2, 1, 0};
    char bytes[sizeof header + sizeof body];
    size_t at = sizeof header - 1, length = at + sizeof body - 1;
    memcpy(bytes, header, at);
    memcpy(bytes + at, body, sizeof body - 1);
    he_import import = {0};
    he_error err = {0};
    assert_int_equal(read_bytes("ply", bytes, length, &import, &err), HE_OK);
    expect_counts(&import, 3, 1, 3);
    expect_corners(&import, corners, 3);
    assert_true(import.soup.positions[0].x == 10 && import.soup.positions[1].z == 0);
    assert_int_equal(he_source_map_find(&import.vertices, 1), at + 3);
    assert_int_equal(import.warnings.count, 0);
    he_import_clear(&import);
    for (size_t end = at; end < length; end++) {
        expect_refused_at_byte(&(format_file){"ply", bytes, end}, HE_SYNTAX, end,
                               "the file ends after");
    }
}

static void strips_become_triangles(void **state)
{
    (void)state;
    static const uint32_t corners[] = {0, 1, 2, 2, 1, 3, 2, 3, 4, 4, 3, 0, 1, 2, 3, 0, 4, 2};
    static const double strips[] = {0, 1, 2, 3, 4, 0, -1, 1, 2, 3, -1, -1, 2, 3, -1, 0, 4, 2};
    for (ply_encoding e = TEXT; e <= MOST_FIRST; e++) {
        ply_file f;
        ply_begin(&f, e,
                  "element vertex 5\n" XYZ
                  "element tristrips 1\nproperty list int int vertex_indices\nend_header\n");
        for (size_t v = 0; v < 5; v++) {
            for (size_t k = 0; k < 3; k++) {
                ply_put_value(&f, FLOAT, (double)(v * k));
            }
            ply_end_row(&f);
        }
        ply_put_value(&f, INT, 18);
        for (size_t k = 0; k < 18; k++) {
            ply_put_value(&f, INT, strips[k]);
        }
        ply_end_row(&f);
        he_import import = ply_read(&f);
        expect_counts(&import, 5, 6, 18);
        expect_corners(&import, corners, 18);
        assert_int_equal(he_source_map_find(&import.faces, 0), e == TEXT ? 15 : f.length - 64);
        assert_int_equal(he_source_map_find(&import.faces, 5), e == TEXT ? 15 : f.length - 4);
        he_import_clear(&import);
    }
    /* A file that has triangle strips in an element of their own, and also an element of faces with
     * an attribute. */
    static const uint32_t both[] = {0, 1, 2, 2, 1, 3, 0, 2, 1}, marks[] = {0, 0, 7};
    he_import import = read_text(
        "ply", ASCII "element vertex 4\n" XYZ
                     "element tristrips 3\nproperty list uchar int vertex_index\nproperty int id\n"
                     "element face 1\n" CORNER "property uint mark\nend_header\n"
                     "0 0 0\n1 0 0\n0 1 0\n1 1 0\n3 0 1 2 1\n2 0 1 2\n3 2 1 3 3\n3 0 2 1 7\n");
    expect_corners(&import, both, 9);
    expect_u32s(&import, &(attribute_shape){HE_FACE, "mark", 1, 3}, marks);
    expect_warning(&import, "ignored_property", "id", 1, 9);
    he_import_clear(&import);
}

static void line_ends_of_the_header(void **state)
{
    (void)state;
    /* After the header, whose lines end in CR LF, the first byte of the first coordinate is also a
     * line feed. */
    static const char crlf[] = "ply\r\nformat binary_little_endian 1.0\r\nelement vertex 1\r\n"
                               "property short x\r\nproperty uchar y\r\nproperty char z\r\n"
                               "end_header\r\n\n\r\xFF\r";
    he_import import = {0};
    he_error err = {0};
    assert_int_equal(read_bytes("ply", crlf, sizeof crlf - 1, &import, &err), HE_OK);
    assert_true(import.soup.positions[0].x == 0x0D0A && import.soup.positions[0].y == 255 &&
                import.soup.positions[0].z == 13);
    assert_int_equal(import.warnings.count, 0);
    he_import_clear(&import);
    import = read_text("ply", "\r\n\nply\r\nformat ascii 1.0\r\nelement vertex 1\r\n" XYZ
                              "end_header\r\n\r\ncomment not a row\r\n1 2\t3");
    expect_counts(&import, 1, 0, 0);
    assert_int_equal(he_source_map_find(&import.vertices, 0), 12);
    he_import_clear(&import);
    import = read_text("ply", "\xEF\xBB\xBFply\nformat ascii 1.0\nelement face 0\nend_header");
    expect_counts(&import, 0, 0, 0);
    he_import_clear(&import);
}

static void places_are_known(void **state)
{
    (void)state;
    he_import import = read_text("ply", ASCII "element vertex 4\n" XYZ "element face 3\n" CORNER
                                              "end_header\n0 0 0\n1 0 0\n\n1 1 0\n0 1 0\n3 0 1 2\n"
                                              "3 0 2 3\n3 0 2 0\n");
    he_mesh *mesh = NULL;
    he_error err = {0};
    assert_int_equal(he_build(&import.soup, 0, &mesh, NULL, &err), HE_REPEATED_CORNER);
    he_import_locate(&import, &err);
    assert_int_equal(err.place, HE_PLACE_LINE);
    assert_int_equal(err.at, 17);
    he_import_clear(&import);
    ply_file f;
    ply_begin(
        &f, MOST_FIRST,
        "element vertex 3\nproperty char x\nproperty char y\nproperty char z\nelement face 4\n"
        "property list uchar char vertex_indices\nend_header\n");
    size_t body = f.length;
    for (size_t k = 0; k < 9; k++) {
        ply_put_value(&f, UCHAR, 0);
    }
    static const double faces[] = {3, 0, 1, 2, 4, 0, 1, 2, 0, 3, 0, 2, 1, 2, 0, 1};
    for (size_t k = 0; k < sizeof faces / sizeof *faces; k++) {
        ply_put_value(&f, UCHAR, faces[k]);
    }
    import = ply_read(&f);
    static const size_t places[] = {9, 13, 18, 22};
    for (uint32_t i = 0; i < 4; i++) {
        assert_int_equal(he_source_map_find(&import.faces, i), body + places[i]);
    }
    for (uint32_t v = 0; v < 3; v++) {
        assert_int_equal(he_source_map_find(&import.vertices, v), body + 3 * v);
    }
    he_import_clear(&import);
}

static void first_bytes_tell(void **state)
{
    (void)state;
    static const char *const plys[] = {"ply\n", "ply\r\nformat", "\n ply \n", "\xEF\xBB\xBFply\n"};
    static const char *const others[] = {"", "ply", "plyx\n", "PLY\n", "OFF\n", "solid ply\n"};
    for (size_t i = 0; i < sizeof plys / sizeof *plys; i++) {
        assert_ptr_equal(he_format_sniff(plys[i], strlen(plys[i])), he_format_find("ply"));
    }
    for (size_t i = 0; i < sizeof others / sizeof *others; i++) {
        assert_ptr_not_equal(he_format_sniff(others[i], strlen(others[i])), he_format_find("ply"));
    }
    assert_ptr_equal(he_format_of_media_type("model/ply"), he_format_find("ply"));
    assert_ptr_equal(he_format_of_extension("PLY"), he_format_find("ply"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_type_in_every_encoding),
        cmocka_unit_test(extreme_values_arrive),
        cmocka_unit_test(elements_and_properties_in_any_order),
        cmocka_unit_test(properties_become_attributes),
        cmocka_unit_test(groups_have_several_spellings),
        cmocka_unit_test(colors_of_every_type_are_fractions),
        cmocka_unit_test(what_is_left_out_is_noted),
        cmocka_unit_test(values_that_are_not_finite),
        cmocka_unit_test(lines_that_end_in_returns),
        cmocka_unit_test(a_header_that_ends_in_returns_before_a_binary_body),
        cmocka_unit_test(strips_become_triangles),
        cmocka_unit_test(line_ends_of_the_header),
        cmocka_unit_test(places_are_known),
        cmocka_unit_test(first_bytes_tell),
    };
    return cmocka_run_group_tests_name("format_ply", tests, NULL, NULL);
}
