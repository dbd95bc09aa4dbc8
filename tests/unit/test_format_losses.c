/* Writers must warn of everything that a file format cannot represent, and refuse meshes that it
 * cannot hold at all. */
#include "unit/format_fixture.h"

#include "model/random.h"
#include "seed.h"

/* --- STL, which stores the positions of corners, but no vertices --- */

/* Reads an STL file that hedge wrote. Building a mesh from it must fail exactly if the writer
 * warned that this would happen, and the number of defects must be the number in the warning. */
static void expect_foretold(const char *bytes, size_t length, const he_warnings *warnings)
{
    he_import import = {0};
    he_error err = {0};
    he_mesh *mesh = NULL;
    he_report *report = calloc(1, sizeof *report);
    const he_warning *note = find_warning(warnings, "no_mesh_again", "");
    assert_non_null(report);
    assert_int_equal(read_pieces(&(format_file){"stl", bytes, length}, 0, NULL, &import, &err),
                     HE_OK);
    he_status status = he_build(&import.soup, 0, &mesh, report, &err);
    assert_int_equal(status == HE_OK, note == NULL);
    assert_int_equal(report->total, note == NULL ? 0 : note->count);
    he_mesh_free(mesh);
    he_import_clear(&import);
    free(report);
}

static void an_stl_that_is_no_mesh_again_says_so(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        /* expected number of defects in the writer's warning, for text and binary STL files */
        uint64_t binary, ascii;
    } rows[] = {
        {"v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n", 0, 0},
        {"v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n", 0, 0},
        /* two faces with equal corner positions and the same orientation */
        {"v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 4 5 6\n", 3, 3},
        /* a face with two corners that differ as doubles but are equal as floats */
        {"v 1 0 0\nv 1.00000000001 0 0\nv 0 1 0\nf 1 2 3\n", 1, 0},
        /* two faces with one corner at the same position: the corners become a bow-tie vertex,
         * which a mesh can represent */
        {"v 0 0 0\nv 1 0 0\nv 0 1 0\nv -0 0 0\nv -1 0 0\nv 0 -1 0\nf 1 2 3\nf 4 5 6\n", 0, 0},
        /* a closed fan of faces around a position, and another face with one corner at the same
         * position */
        {"v 0 0 0\nv 1 0 0\nv 0 1 0\nv -1 -1 0\nf 1 2 3\nf 1 3 4\nf 1 4 2\nv 0 0 0\nv 1 0 5\n"
         "v 0 1 5\nf 5 6 7\n",
         1, 1},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        he_mesh *mesh = mesh_of_text("obj", rows[i].text);
        for (size_t k = 0; k < 2; k++) {
            size_t length;
            he_warnings warnings;
            char *bytes = write_bytes("stl", k == 0 ? "binary" : "ascii", mesh, &warnings, &length);
            const he_warning *note = find_warning(&warnings, "no_mesh_again", "");
            assert_int_equal(note == NULL ? 0 : note->count,
                             k == 0 ? rows[i].binary : rows[i].ascii);
            expect_foretold(bytes, length, &warnings);
            free(bytes);
        }
        he_mesh_free(mesh);
    }
}

/* Makes random faces of three to five corners among a few points of a grid, but only faces that a
 * mesh can represent together. */
static void fill_randomly(md_random *random, he_soup *soup)
{
    uint32_t vertices = 4 + md_below(random, 8);
    for (uint32_t v = 0; v < vertices; v++) {
        he_vec3 p = {md_below(random, 3), md_below(random, 2), md_below(random, 2)};
        assert_int_equal(he_soup_add_vertex(soup, p, NULL), HE_OK);
    }
    for (unsigned tries = 0; tries < 12; tries++) {
        uint64_t defects;
        uint32_t corners[5], count = 3 + md_below(random, 3);
        size_t faces = soup->face_count, before = soup->corner_count;
        for (uint32_t i = 0; i < count; i++) {
            corners[i] = md_below(random, vertices);
        }
        assert_int_equal(he_soup_add_face(soup, corners, count, NULL), HE_OK);
        assert_int_equal(he_build_try(soup, &defects, NULL), HE_OK);
        if (defects > 0) {
            soup->face_count = faces;
            soup->corner_count = before;
        }
    }
}

static void an_stl_without_notes_comes_back_the_same(void **state)
{
    (void)state;
    enum { MESHES = 4000 };
    md_random random = {seed_of_run()};
    unsigned same = 0, refused = 0;
    for (unsigned i = 0; i < MESHES; i++) {
        he_soup soup;
        he_warnings warnings;
        he_import import = {0};
        size_t length;
        he_error err = {0};
        he_soup_init(&soup, NULL);
        fill_randomly(&random, &soup);
        he_mesh *mesh = NULL;
        assert_int_equal(he_build(&soup, HE_BUILD_TAKE, &mesh, NULL, NULL), HE_OK);
        char *bytes = write_encoded("stl", "binary", mesh, 4096, &warnings, &length);
        expect_foretold(bytes, length, &warnings);
        if (warnings.count == 0) {
            assert_int_equal(
                read_pieces(&(format_file){"stl", bytes, length}, 0, NULL, &import, &err), HE_OK);
            he_mesh *again = build_import(&import);
            fixture_counts(again, he_mesh_vertices(mesh), he_mesh_edges(mesh), he_mesh_faces(mesh));
            he_mesh_free(again);
            he_import_clear(&import);
            same++;
        }
        refused += find_warning(&warnings, "no_mesh_again", "") != NULL;
        free(bytes);
        he_mesh_free(mesh);
        he_soup_clear(&soup);
    }
    print_message("note: %u of %d meshes come back from STL the same, %u are no mesh again\n", same,
                  MESHES, refused);
    assert_true(same > 10 && refused > 10);
}

/* --- floats --- */

static void positions_beyond_floats_are_counted_and_refused(void **state)
{
    (void)state;
    static const struct {
        const char *format, *encoding, *text;
    } rows[] = {
        {"stl", "binary",
         "vertex 1 has a coordinate too large for the floats of this format (and 1 more)"},
        {"glb", "binary",
         "vertex 0 has a coordinate too large for the floats of this format (and 2 more)"},
        {"stl", "ascii", NULL},
        {"ply", "binary", NULL},
        {"obj", "ascii", NULL},
        {"off", "ascii", NULL},
    };
    /* vertex 0 has no face, so it is not written to an STL file and its large coordinate does no
     * harm */
    he_mesh *mesh = mesh_of_text("obj", "v 0 0 1e39\nv 0 1e300 0\nv -1e39 0 -1e39\n"
                                        "v 0 3.4028234663852886e38 0\nf 2 3 4\n");
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        he_writer *writer = NULL;
        he_error err = {0};
        const he_format *format = he_format_find(rows[i].format);
        int encoding = he_format_encoding(format, rows[i].encoding);
        he_status status = he_writer_new(format, mesh, (size_t)encoding, NULL, &writer, &err);
        assert_int_equal(status, rows[i].text == NULL ? HE_OK : HE_BEYOND_FLOAT);
        if (rows[i].text != NULL) {
            assert_string_equal(err.text, rows[i].text);
            assert_int_equal(err.kind, HE_VERTEX);
        }
        he_writer_free(writer);
    }
    he_mesh_free(mesh);
}

/* --- OBJ, in which normals can be given only at the corners of faces --- */

static void normals_of_a_point_cloud_are_told(void **state)
{
    (void)state;
    static const char cloud[] = "ply\nformat ascii 1.0\nelement vertex 3\nproperty double x\n"
                                "property double y\nproperty double z\nproperty float nx\n"
                                "property float ny\nproperty float nz\nproperty float s\n"
                                "property float t\nend_header\n0 0 0 0 0 1 .5 .5\n"
                                "1 0 0 0 1 0 0 0\n0 1 0 0 0 0 0 0\n";
    he_warnings warnings;
    he_mesh *mesh = mesh_of_text("ply", cloud);
    char *text = write_text("obj", mesh, &warnings);
    assert_non_null(strstr(text, "vn 0 1 0\n"));
    assert_int_equal(find_warning(&warnings, "unnamed_normal", "")->count, 2);
    assert_int_equal(find_warning(&warnings, "unnamed_uv", "")->count, 1);
    free(text);
    he_mesh_free(mesh);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_stl_that_is_no_mesh_again_says_so),
        cmocka_unit_test(an_stl_without_notes_comes_back_the_same),
        cmocka_unit_test(positions_beyond_floats_are_counted_and_refused),
        cmocka_unit_test(normals_of_a_point_cloud_are_told),
    };
    return cmocka_run_group_tests_name("format_losses", tests, NULL, NULL);
}
