/* A number must mean the same in every format. The texture coordinate v runs upward in hedge's
 * meshes, OBJ, PLY and OFF, but downward in glTF. A colour component is from 0 to 1 in hedge's
 * meshes, but from 0 to 255 in files that store bytes. */
#include "unit/format_fixture.h"

#include "model/random.h"
#include "tests/seed.h"

#include <math.h>

/* Replaces each occurrence of a word in a file by another word of equal length. */
static void rename_all(char *bytes, size_t length, const char *word, const char *other)
{
    size_t n = strlen(word);
    for (size_t i = 0; i + n <= length; i++) {
        if (memcmp(bytes + i, word, n) == 0) {
            memcpy(bytes + i, other, n);
        }
    }
}

static he_import read_whole(const char *format, const char *bytes, size_t length)
{
    he_import import = {0};
    he_error err = {0};
    if (read_pieces(&(format_file){format, bytes, length}, 0, NULL, &import, &err) != HE_OK) {
        fail_msg("%s", err.text);
    }
    return import;
}

/* Writes a mesh as a GLB file, and reads the texture coordinates from it unchanged: the test
 * renames the attribute in the file, so that the reader does not recognize and convert it. */
static he_import read_raw(const he_mesh *mesh)
{
    size_t length;
    char *bytes = write_encoded("glb", "binary", mesh, 4096, NULL, &length);
    rename_all(bytes, length, "\"hedge\":{", "\"Hedge\":{");
    rename_all(bytes, length, "TEXCOORD_0", "_raw_uv___");
    he_import import = read_whole("glb", bytes, length);
    free(bytes);
    return import;
}

static void v_runs_down_in_gltf_alone(void **state)
{
    (void)state;
    static const char *const texts[][2] = {
        {"off", "STOFF\n3 1 0\n0 0 0 0.25 0.125\n1 0 0 1 0\n0 1 0 0 1\n3 0 1 2\n"},
        {"ply", "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
                "property float z\nproperty float s\nproperty float t\nelement face 1\n"
                "property list uchar int vertex_indices\nend_header\n"
                "0 0 0 0.25 0.125\n1 0 0 1 0\n0 1 0 0 1\n3 0 1 2\n"},
    };
    static const float down[] = {0.25f, 0.875f, 1, 1, 0, 0};
    for (size_t i = 0; i < 2; i++) {
        he_mesh *mesh = mesh_of_text(texts[i][0], texts[i][1]);
        he_import raw = read_raw(mesh);
        assert_memory_equal(find_column(&raw, HE_VERTEX, "raw_uv___")->data, down, sizeof down);
        he_import_clear(&raw);

        size_t length;
        char *bytes = write_encoded("glb", "binary", mesh, 4096, NULL, &length);
        for (int hidden = 0; hidden < 2; hidden++) {
            he_import import = read_whole("glb", bytes, length);
            he_mesh *again = build_import(&import);
            char *text = write_text("obj", again, NULL);
            assert_non_null(strstr(text, "vt 0.25 0.125\nvt 1 0\nvt 0 1\n"));
            free(text);
            he_mesh_free(again);
            he_import_clear(&import);
            rename_all(bytes, length, "\"hedge\":{", "\"Hedge\":{");
        }
        free(bytes);
        he_mesh_free(mesh);
    }
}

/* The reader and the writer of glTF both replace the texture coordinate v by 1 - v: a float that
 * was read and written again must have its original bits. */
static void no_bit_of_v_is_lost_on_the_way_through(void **state)
{
    (void)state;
    enum { COUNT = 3000 };
    md_random random = {seed_of_run()};
    he_soup soup;
    he_column *column;
    he_mesh *mesh;
    float given[COUNT];
    he_soup_init(&soup, NULL);
    assert_int_equal(
        he_soup_column(&soup, &(he_column_schema){"uv", HE_VERTEX, HE_DOUBLE, 2, HE_INTERPOLATE},
                       &column, NULL),
        HE_OK);
    assert_int_equal(he_column_extend(column, COUNT, NULL), HE_OK);
    for (uint32_t i = 0; i < COUNT; i++) {
        assert_int_equal(he_soup_add_vertex(&soup, (he_vec3){i, 0, 0}, NULL), HE_OK);
        given[i] = (float)ldexp((double)(md_bits(&random) >> 40), -24 - (int)md_below(&random, 4));
        given[i] = i % 3 == 0 ? -given[i] : i % 3 == 1 ? 1 + given[i] : given[i];
        double pair[2] = {0, 1 - (double)given[i]};
        memcpy(he_column_row(column, i), pair, sizeof pair);
    }
    assert_int_equal(he_build(&soup, 0, &mesh, NULL, NULL), HE_OK);
    he_import raw = read_raw(mesh);
    const he_column *uv = find_column(&raw, HE_VERTEX, "raw_uv___");
    for (uint32_t i = 0; uv != NULL && i < COUNT; i++) {
        assert_memory_equal(he_column_value(uv, i) + sizeof(float), &given[i], sizeof(float));
    }
    he_import_clear(&raw);
    /* glTF's own attribute already holds these texture coordinates exactly, so the writer must not
     * store them a second time in hedge's extras */
    he_warnings warnings;
    size_t length;
    free(write_encoded("glb", "binary", mesh, 4096, &warnings, &length));
    assert_null(find_warning(&warnings, "in_extras", "vertex uv"));
    he_mesh_free(mesh);
    he_soup_clear(&soup);
}

/* A colour component with one of the 256 values that a byte can store must have the same value
 * after the mesh was written to any format and read back. */
static void bytes_of_colors_come_back_from_every_format(void **state)
{
    (void)state;
    static const struct {
        const char *format, *encoding;
        bool alpha;
    } ways[] = {{"obj", "ascii", false}, {"off", "ascii", true},  {"ply", "ascii", true},
                {"ply", "binary", true}, {"glb", "binary", true}, {"glb", "hidden", true}};
    for (size_t i = 0; i < sizeof ways / sizeof *ways; i++) {
        char text[16384];
        bool hidden = strcmp(ways[i].encoding, "hidden") == 0;
        int n = snprintf(text, sizeof text,
                         "ply\nformat ascii 1.0\nelement vertex 256\nproperty float x\n"
                         "property float y\nproperty float z\nproperty uchar red\n"
                         "property uchar green\nproperty uchar blue\n%selement face 1\n"
                         "property list uchar int vertex_indices\nend_header\n",
                         ways[i].alpha ? "property uchar alpha\n" : "");
        for (int k = 0; k < 256; k++) {
            n += snprintf(text + n, sizeof text - (size_t)n, "%d 0 0 %d %d %d", k, k, 255 - k,
                          k * 7 % 256);
            n += snprintf(text + n, sizeof text - (size_t)n, ways[i].alpha ? " %d\n" : "\n", k / 2);
        }
        snprintf(text + n, sizeof text - (size_t)n, "3 0 1 2\n");
        he_mesh *mesh = mesh_of_text("ply", text);
        he_warnings warnings;
        size_t length;
        char *bytes = write_encoded(ways[i].format, hidden ? "binary" : ways[i].encoding, mesh,
                                    4096, &warnings, &length);
        assert_int_equal(warnings.count, 0);
        if (hidden) {
            rename_all(bytes, length, "\"hedge\":{", "\"Hedge\":{");
        }
        he_import import = read_whole(ways[i].format, bytes, length);
        assert_int_equal(import.warnings.count, 0);
        he_mesh *again = build_import(&import);
        char *back = write_text("ply", again, &warnings);
        assert_string_equal(back, text);
        assert_int_equal(warnings.count, 0);
        free(back);
        free(bytes);
        he_import_clear(&import);
        he_mesh_free(mesh);
        he_mesh_free(again);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(v_runs_down_in_gltf_alone),
        cmocka_unit_test(no_bit_of_v_is_lost_on_the_way_through),
        cmocka_unit_test(bytes_of_colors_come_back_from_every_format),
    };
    return cmocka_run_group_tests_name("format_meaning", tests, NULL, NULL);
}
