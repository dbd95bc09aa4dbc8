/* PLY files that hedge writes: their text, and that reading them gives equal meshes. */
#include "unit/format_fixture.h"

#define ASCII  "ply\nformat ascii 1.0\n"
#define CORNER "property list uchar int vertex_indices\n"

static he_mesh *colored_square(void)
{
    return mesh_of_text(
        "ply", ASCII "element vertex 5\nproperty double x\nproperty double y\nproperty double z\n"
                     "property float nx\nproperty float ny\nproperty float nz\n"
                     "property uchar red\nproperty uchar green\nproperty uchar blue\n"
                     "property uchar alpha\nproperty double s\nproperty double t\n"
                     "property int mark\nelement face 2\n" CORNER
                     "property uchar red\nproperty uchar green\nproperty uchar blue\n"
                     "property uint group\nend_header\n"
                     "0 0 0.1 0 0 1 255 0 7 128 .25 .1 -5\n1 0 1e-7 0 0 1 0 0 0 255 0 0 6\n"
                     "1 1 -0 0 0 1 1 2 3 4 1 1 7\n0 1 5e-324 0 .6 .8 0 0 0 0 0 1 -2147483648\n"
                     "9 9 1e300 0 0 1 9 9 9 9 0 0 0\n"
                     "3 0 1 2 10 20 30 4294967295\n3 0 2 3 1 0 1 0\n");
}

static void text_is_as_expected(void **state)
{
    (void)state;
    he_mesh *mesh = colored_square();
    he_warnings warnings;
    size_t length;
    char *text = write_bytes("ply", "ascii", mesh, &warnings, &length);
    assert_string_equal(
        text, ASCII "element vertex 5\nproperty double x\nproperty double y\nproperty double z\n"
                    "property float nx\nproperty float ny\nproperty float nz\n"
                    "property uchar red\nproperty uchar green\nproperty uchar blue\n"
                    "property uchar alpha\nproperty double s\nproperty double t\n"
                    "property int mark\nelement face 2\n" CORNER
                    "property uchar red\nproperty uchar green\nproperty uchar blue\n"
                    "property uint group\nend_header\n"
                    "0 0 0.1 0 0 1 255 0 7 128 0.25 0.1 -5\n1 0 1e-7 0 0 1 0 0 0 255 0 0 6\n"
                    "1 1 -0 0 0 1 1 2 3 4 1 1 7\n0 1 5e-324 0 0.6 0.8 0 0 0 0 0 1 -2147483648\n"
                    "9 9 1e300 0 0 1 9 9 9 9 0 0 0\n"
                    "3 0 1 2 10 20 30 4294967295\n3 0 2 3 1 0 1 0\n");
    assert_int_equal(warnings.count, 0);
    free(text);
    he_mesh_free(mesh);
}

static void all_encodings_round_trip(void **state)
{
    (void)state;
    static const char *const encodings[] = {"ascii", "binary", "binary_big_endian"};
    he_mesh *meshes[3] = {colored_square(), fixture_mesh("0321,4567,0154,1265,2376,3047"),
                          fixture_mesh("")};
    for (size_t i = 0; i < 9; i++) {
        const he_mesh *mesh = meshes[i % 3];
        const char *name = encodings[i / 3];
        size_t length, again_length;
        he_warnings warnings;
        char *bytes = write_bytes("ply", name, mesh, &warnings, &length);
        assert_int_equal(warnings.count, 0);
        he_import import = {0};
        he_error err = {0};
        if (read_bytes("ply", bytes, length, &import, &err) != HE_OK) {
            fail_msg("%s", err.text);
        }
        assert_int_equal(import.warnings.count, 0);
        he_mesh *again = build_import(&import);
        assert_true(he_mesh_equal(mesh, again));
        char *repeated = write_encoded("ply", name, again, 100, NULL, &again_length);
        assert_int_equal(again_length, length);
        assert_memory_equal(repeated, bytes, length);
        free(repeated);
        free(bytes);
        he_mesh_free(again);
        he_import_clear(&import);
    }
    for (size_t i = 0; i < 3; i++) {
        he_mesh_free(meshes[i]);
    }
}

static void positions_are_floats_where_that_is_exact(void **state)
{
    (void)state;
    static const char *const coordinates[] = {"0.5 -0 3.4028234663852886e38", "0.1 0 0",
                                              "0 3.5e38 0", "0 0 1e-46",
                                              "0 1.401298464324817e-45 0"};
    static const bool floats[] = {true, false, false, false, true};
    for (size_t i = 0; i < sizeof floats / sizeof *floats; i++) {
        char text[200];
        snprintf(text, sizeof text, "OFF 1 0 0\n%s\n", coordinates[i]);
        he_mesh *mesh = mesh_of_text("off", text);
        size_t length;
        char *bytes = write_bytes("ply", "binary", mesh, NULL, &length);
        assert_non_null(strstr(bytes, floats[i] ? "property float x" : "property double x"));
        he_import import = {0};
        assert_int_equal(read_pieces(&(format_file){"ply", bytes, length}, 0, NULL, &import, NULL),
                         HE_OK);
        assert_memory_equal(import.soup.positions, mesh->c.position, sizeof(he_vec3));
        he_import_clear(&import);
        free(bytes);
        he_mesh_free(mesh);
    }
}

static void large_faces_are_counted_in_more_than_a_byte(void **state)
{
    (void)state;
    char text[16384];
    size_t length = (size_t)snprintf(text, sizeof text, "OFF 300 1 0\n");
    for (int i = 0; i < 300; i++) {
        length += (size_t)snprintf(text + length, sizeof text - length, "%d %d 0\n", i, i * i);
    }
    length += (size_t)snprintf(text + length, sizeof text - length, "300");
    for (int i = 0; i < 300; i++) {
        length += (size_t)snprintf(text + length, sizeof text - length, " %d", i);
    }
    he_mesh *mesh = mesh_of_text("off", text);
    char *bytes = write_bytes("ply", "binary_big_endian", mesh, NULL, &length);
    assert_non_null(strstr(bytes, "property list uint int vertex_indices\n"));
    he_import import = {0};
    assert_int_equal(read_pieces(&(format_file){"ply", bytes, length}, 5, NULL, &import, NULL),
                     HE_OK);
    expect_counts(&import, 300, 1, 300);
    he_import_clear(&import);
    free(bytes);
    he_mesh_free(mesh);
}

/* An attribute that has a value for each of the first `rows` elements; all bytes of these values
 * are 1. */
typedef struct attribute {
    const char *name;
    he_kind domain;
    he_type type;
    uint32_t components;
    size_t rows;
} attribute;

static void add_column(he_soup *soup, const attribute *a)
{
    he_column *column;
    const he_column_schema schema = {a->name, a->domain, a->type, a->components, HE_COPY};
    assert_int_equal(he_soup_column(soup, &schema, &column, NULL), HE_OK);
    assert_int_equal(he_column_extend(column, a->rows, NULL), HE_OK);
    memset(column->data, 1, a->rows * column->row_bytes);
}

static void colors_between_bytes_are_rounded_and_counted(void **state)
{
    (void)state;
    he_mesh *mesh = mesh_of_text("obj", "v 0 0 0 0.5 0 1\nv 1 0 0 1.5 -1 0.2\nv 0 1 0 0 1 0.2\n"
                                        "f 1 2 3\n");
    he_warnings warnings;
    size_t length;
    char *text = write_bytes("ply", "ascii", mesh, &warnings, &length);
    assert_non_null(strstr(text, "end_header\n0 0 0 128 0 255\n1 0 0 255 0 51\n0 1 0 0 255 51\n"));
    assert_int_equal(find_warning(&warnings, "rounded_colors", "")->count, 2);
    assert_int_equal(warnings.count, 1);
    free(text);
    he_mesh_free(mesh);
}

static void what_is_lost_is_named(void **state)
{
    (void)state;
    he_soup soup;
    he_mesh *mesh = NULL;
    fixture_soup(&soup, "012,023");
    static const attribute attributes[] = {
        {"x", HE_VERTEX, HE_FLOAT, 1, 4},      {"two words", HE_VERTEX, HE_FLOAT, 1, 4},
        {"pair", HE_VERTEX, HE_FLOAT, 2, 4},   {"flag", HE_VERTEX, HE_BOOL, 1, 4},
        {"color", HE_VERTEX, HE_DOUBLE, 3, 4}, {"color", HE_FACE, HE_UINT32, 3, 1},
        {"red", HE_VERTEX, HE_INT32, 1, 4},    {"heat", HE_HALFEDGE, HE_FLOAT, 2, 6},
        {"mark", HE_FACE, HE_INT32, 1, 1},
    };
    for (size_t i = 0; i < sizeof attributes / sizeof *attributes; i++) {
        add_column(&soup, &attributes[i]);
    }
    assert_int_equal(he_build(&soup, HE_BUILD_TAKE, &mesh, NULL, NULL), HE_OK);
    he_warnings warnings;
    size_t length;
    char *text = write_bytes("ply", "ascii", mesh, &warnings, &length);
    static const char *const lost[] = {"vertex x",   "vertex two words", "vertex pair",
                                       "vertex red", "halfedge heat",    "face color"};
    for (size_t i = 0; i < sizeof lost / sizeof *lost; i++) {
        assert_non_null(find_warning(&warnings, "attribute_lost", lost[i]));
    }
    assert_int_equal(warnings.count, 6);
    assert_non_null(strstr(text, "property uchar red\nproperty uchar green\nproperty uchar blue\n"
                                 "property uchar flag\nelement face"));
    assert_non_null(strstr(text, "3 0 1 2 16843009\n3 0 2 3 0\n"));
    free(text);
    he_mesh_free(mesh);
    he_soup_clear(&soup);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(text_is_as_expected),
        cmocka_unit_test(all_encodings_round_trip),
        cmocka_unit_test(positions_are_floats_where_that_is_exact),
        cmocka_unit_test(large_faces_are_counted_in_more_than_a_byte),
        cmocka_unit_test(colors_between_bytes_are_rounded_and_counted),
        cmocka_unit_test(what_is_lost_is_named),
    };
    return cmocka_run_group_tests_name("format_ply_write", tests, NULL, NULL);
}
