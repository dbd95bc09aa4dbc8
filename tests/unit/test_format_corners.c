/* Attribute values of corners, written in formats that have only values of vertices: other programs
 * must see a separate vertex for each different value, and hedge must read the original mesh
 * back. */
#include "unit/format_fixture.h"

#include "mesh/write.h"
#include "tests/failing.h"

/* A quadrilateral and a triangle that share the edge between the second and the third vertex. At
 * the second vertex, the corners of the two faces differ in texture coordinates and normals; at the
 * third vertex, they differ only in texture coordinates. */
static const char seam[] = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\nv 9 9 9\n"
                           "vt 0 0\nvt 0.5 0\nvt 0.5 1\nvt 0 1\nvt 0.75 0\nvt 1 0.25\nvt 0.75 1\n"
                           "vn 0 0 1\nvn 0 1 0\n"
                           "f 1/1/1 2/2/1 3/3/1 4/4/1\nf 2/5/2 5/6/1 3/7/1\n";

static const struct {
    const char *format, *encoding;
} ways[] = {{"glb", "binary"}, {"ply", "ascii"}, {"ply", "binary"}, {"ply", "binary_big_endian"}};
enum { WAYS = sizeof ways / sizeof *ways };

static void replace_all(char *bytes, size_t length, const char *word, const char *other)
{
    size_t n = strlen(word);
    assert_int_equal(strlen(other), n);
    for (size_t i = 0; i + n <= length; i++) {
        if (memcmp(bytes + i, word, n) == 0) {
            memcpy(bytes + i, other, n);
        }
    }
}

/* Renames the data that only hedge reads in a file: hedge then ignores this data and reads the file
 * as other programs do. */
static void hide_marks(char *bytes, size_t length)
{
    replace_all(bytes, length, "\"hedge\":{", "\"Hedge\":{");
    replace_all(bytes, length, "comment hedge corners", "comment Hedge corners");
    replace_all(bytes, length, "uint hedge_vertex", "uint other_vertex");
    replace_all(bytes, length, "float texcoord\n", "float texFoord\n");
}

static he_import read_it(const char *format, const char *bytes, size_t length)
{
    he_import import = {0};
    he_error err = {0};
    if (read_bytes(format, bytes, length, &import, &err) != HE_OK) {
        fail_msg("%s", err.text);
    }
    return import;
}

static void the_mesh_comes_back(void **state)
{
    (void)state;
    for (size_t i = 0; i < WAYS; i++) {
        he_mesh *mesh = mesh_of_text("obj", seam);
        char *wanted = write_text("obj", mesh, NULL);
        he_warnings warnings;
        size_t length;
        char *bytes = write_bytes(ways[i].format, ways[i].encoding, mesh, &warnings, &length);
        assert_int_equal(find_warning(&warnings, "split_vertices", "")->count, 2);
        assert_null(find_warning(&warnings, "in_extras", "halfedge uv"));
        assert_null(find_warning(&warnings, "attribute_lost", "halfedge uv"));
        he_import import = read_it(ways[i].format, bytes, length);
        assert_int_equal(import.warnings.count, 0);
        expect_counts(&import, 6, 2, 7);
        assert_int_equal(import.soup.column_count, 2);
        he_mesh *again = build_import(&import);
        char *text = write_text("obj", again, NULL);
        assert_string_equal(text, wanted);
        free(text);
        free(wanted);
        free(bytes);
        he_import_clear(&import);
        he_mesh_free(again);
        he_mesh_free(mesh);
    }
}

/* Other programs read attribute values of vertices only. Through the vertices in the file, each
 * corner must get the value that it has in the mesh. */
static void others_get_the_same_values_at_the_same_corners(void **state)
{
    (void)state;
    static const double uv[7][2] = {{0, 0}, {.5, 0}, {.5, 1}, {0, 1}, {.75, 0}, {1, .25}, {.75, 1}};
    for (size_t i = 0; i < WAYS; i++) {
        he_mesh *mesh = mesh_of_text("obj", seam);
        size_t length, seen = 0;
        char *bytes = write_encoded(ways[i].format, ways[i].encoding, mesh, 4096, NULL, &length);
        hide_marks(bytes, length);
        he_import import = read_it(ways[i].format, bytes, length);
        const he_soup *soup = &import.soup;
        assert_int_equal(soup->vertex_count, 8);
        const he_column *uvs = find_column(&import, HE_VERTEX, "uv");
        const he_column *normals = find_column(&import, HE_VERTEX, "normal");
        assert_non_null(uvs);
        assert_non_null(normals);
        for (size_t c = 0; c < soup->corner_count; c++) {
            double pair[2], up;
            float narrow[3];
            uint32_t v = soup->corners[c];
            assert_int_equal(uvs->type, HE_DOUBLE);
            memcpy(pair, he_column_value(uvs, v), sizeof pair);
            if (normals->type == HE_FLOAT) {
                memcpy(narrow, he_column_value(normals, v), sizeof narrow);
                up = (double)narrow[1];
            } else {
                memcpy(&up, he_column_value(normals, v) + sizeof up, sizeof up);
            }
            size_t k = 0;
            while (k < 7 && (uv[k][0] != pair[0] || uv[k][1] != pair[1])) {
                k++;
            }
            assert_true(k < 7);
            assert_true((up == 1) == (k == 4));
            he_vec3 p = soup->positions[v];
            assert_true(p.x == (k == 5 ? 2 : k == 0 || k == 3 ? 0 : 1));
            seen |= (size_t)1 << k;
        }
        assert_int_equal(seen, 127);
        free(bytes);
        he_import_clear(&import);
        he_mesh_free(mesh);
    }
}

/* MeshLab stores texture coordinates of corners as one list per face. */
static void texcoord_lists_are_values_of_corners(void **state)
{
    (void)state;
    static const char head[] = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\n"
                               "property float y\nproperty float z\nelement face 2\n"
                               "property list uchar int vertex_indices\n"
                               "property list uchar %s texcoord\nproperty int texnumber\n"
                               "end_header\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n"
                               "3 0 1 2 6 0 .25 .5 0 1 1 7\n3 0 2 3 %s 8\n";
    static const struct {
        const char *type, *second, *note;
    } rows[] = {{"float", "6 1 .5 1 .75 0 1", NULL},
                {"double", "6 1 .5 1 .75 0 1", NULL},
                {"float", "0", "faces_without_uv"},
                {"float", "4 1 1 1 1", "texcoord_count"},
                {"float", "6 1 .5 1 .75 0 nan", "not_finite"}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        char text[600];
        snprintf(text, sizeof text, head, rows[i].type, rows[i].second);
        he_import import = read_text("ply", text);
        assert_int_equal(import.warnings.count, rows[i].note != NULL);
        assert_true(rows[i].note == NULL ||
                    strcmp(import.warnings.items[0].code, rows[i].note) == 0);
        assert_null(find_column(&import, HE_VERTEX, "uv"));
        he_mesh *mesh = build_import(&import);
        char *obj = write_text("obj", mesh, NULL);
        assert_non_null(strstr(obj, "vt 0 0.25\nvt 0.5 0\nvt 1 1\n"));
        assert_int_equal(strstr(obj, "vt 1 0.5\nvt 1 0.75\nvt 0 1\n") != NULL,
                         rows[i].note == NULL);
        free(obj);
        he_mesh_free(mesh);
        he_import_clear(&import);
    }
}

static void texcoord_lists_are_written(void **state)
{
    (void)state;
    he_mesh *mesh = mesh_of_text("obj", seam);
    char *text = write_text("ply", mesh, NULL);
    assert_non_null(strstr(text, "property list uchar float texcoord\n"));
    assert_non_null(strstr(text, "4 0 1 2 3 8 0 0 0.5 0 0.5 1 0 1\n"
                                 "3 6 4 7 6 0.75 0 1 0.25 0.75 1\n"));
    free(text);
    he_mesh_free(mesh);
}

/* Hedge has written several copies of a vertex, with notes that the copies belong together. Another
 * program has moved one of the copies, but kept the notes: hedge must not join vertices at
 * different positions. */
static void marks_that_do_not_fit_are_not_believed(void **state)
{
    (void)state;
    he_mesh *mesh = mesh_of_text("obj", seam);
    size_t length;
    char *text = write_text("ply", mesh, NULL);
    char *copy = strstr(text, "1 0 0 0 1 0 0.75 0 1\n");
    assert_non_null(copy);
    copy[0] = '3';
    he_import import = read_text("ply", text);
    expect_counts(&import, 8, 2, 7);
    assert_non_null(find_warning(&import.warnings, "stale_copies", ""));
    assert_non_null(find_column(&import, HE_HALFEDGE, "uv"));
    he_import_clear(&import);
    free(text);

    char *bytes = write_encoded("glb", "binary", mesh, 4096, NULL, &length);
    size_t json = 0;
    memcpy(&json, bytes + 12, 4);
    float *x = (float *)(void *)(bytes + 28 + json + 12 * 7);
    assert_true((double)*x == 1);
    *x = 3;
    import = read_it("glb", bytes, length);
    expect_counts(&import, 8, 3, 9);
    assert_non_null(find_warning(&import.warnings, "stale_extras", ""));
    assert_non_null(find_column(&import, HE_VERTEX, "uv"));
    he_import_clear(&import);
    free(bytes);
    he_mesh_free(mesh);
}

/* A vertex attribute and a corner attribute have the same name: in the file, other programs must
 * see the attribute of corners, and hedge must read both attributes. */
static void corners_come_before_vertices(void **state)
{
    (void)state;
    he_mesh *mesh = mesh_of_text("obj", seam);
    he_column *column;
    assert_int_equal(
        he_column_new(&(he_column_schema){"uv", HE_VERTEX, HE_DOUBLE, 2, HE_COPY}, &column, NULL),
        HE_OK);
    assert_int_equal(he_column_extend(column, 6, NULL), HE_OK);
    memcpy(he_column_row(column, 3), (double[]){7, 8}, 16);
    assert_int_equal(he_mesh_add_column(mesh, column, NULL), HE_OK);
    he_warnings warnings;
    size_t length;
    char *bytes = write_encoded("glb", "binary", mesh, 4096, &warnings, &length);
    assert_non_null(find_warning(&warnings, "in_extras", "vertex uv"));
    he_import import = read_it("glb", bytes, length);
    assert_memory_equal(he_column_value(find_column(&import, HE_VERTEX, "uv"), 3),
                        ((double[]){7, 8}), 16);
    assert_non_null(find_column(&import, HE_HALFEDGE, "uv"));
    assert_int_equal(import.warnings.count, 0);
    he_import_clear(&import);
    free(bytes);
    free(write_encoded("ply", "ascii", mesh, 4096, &warnings, &length));
    assert_non_null(find_warning(&warnings, "attribute_lost", "vertex uv"));
    he_mesh_free(mesh);
}

static void a_writer_without_memory_is_refused(void **state)
{
    (void)state;
    he_mesh *mesh = mesh_of_text("obj", seam);
    for (size_t i = 0; i < 2; i++) {
        failing f = {.what = ways[i].format};
        while (failing_next(&f)) {
            he_writer *writer = NULL;
            he_status status =
                he_writer_new(he_format_find(ways[i].format), mesh, 0, NULL, &writer, NULL);
            he_writer_free(failing_status(&f, status) ? writer : NULL);
        }
    }
    he_mesh_free(mesh);
}

static void a_reader_without_memory_is_refused(void **state)
{
    (void)state;
    he_mesh *mesh = mesh_of_text("obj", seam);
    for (size_t i = 0; i < 2; i++) {
        size_t length;
        char *bytes = write_encoded(ways[i].format, ways[i].encoding, mesh, 4096, NULL, &length);
        failing f = {.what = ways[i].format};
        while (failing_next(&f)) {
            he_import import = {0};
            he_reader *reader = NULL;
            he_status status = he_reader_new(he_format_find(ways[i].format), NULL, &reader, NULL);
            if (status == HE_OK) {
                status = he_reader_feed(reader, bytes, length, NULL);
                he_status end = he_reader_finish(reader, &import, NULL);
                status = status == HE_OK ? end : status;
            }
            he_reader_free(reader);
            if (failing_status(&f, status)) {
                he_import_clear(&import);
            }
        }
        free(bytes);
    }
    he_mesh_free(mesh);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_mesh_comes_back),
        cmocka_unit_test(others_get_the_same_values_at_the_same_corners),
        cmocka_unit_test(texcoord_lists_are_values_of_corners),
        cmocka_unit_test(texcoord_lists_are_written),
        cmocka_unit_test(marks_that_do_not_fit_are_not_believed),
        cmocka_unit_test(corners_come_before_vertices),
        cmocka_unit_test(a_writer_without_memory_is_refused),
        cmocka_unit_test(a_reader_without_memory_is_refused),
    };
    return cmocka_run_group_tests_name("format_corners", tests, NULL, NULL);
}
