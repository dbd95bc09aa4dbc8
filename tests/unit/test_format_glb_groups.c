/* A GLB file shows objects, groups and materials to other programs as separate meshes and
 * primitives. From the same file hedge must read the original mesh back, with the order of its
 * faces, its polygons, names and materials. */
#include "unit/edit_script.h"
#include "unit/format_fixture.h"

#include "mesh/compact.h"
#include "mesh/write.h"
#include "tests/failing.h"

/* Six faces of a box and a separate triangle. The faces of a group are not all in succession: faces
 * of other groups come between them. */
static const char box[] =
    "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\nv 5 0 0\nv 6 0 0\n"
    "v 5 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
    "o box\ng bottom\nusemtl red\nf 1/1 4/2 3/3 2/4\ng top\nusemtl blue\nf 5/1 6/2 7/3 8/4\n"
    "o other1\ng\nusemtl red\nf 9/1 10/2 11/3\no box\ng bottom\nusemtl bare\nf 1/1 2/2 6/3 5/4\n"
    "g top\nusemtl blue\nf 2/1 3/2 7/3 6/4\nusemtl red\nf 3/1 4/2 8/3 7/4\n"
    "g bottom\nf 4/1 1/2 5/3 8/4\n";

static he_mesh *grouped(void)
{
    he_mesh *mesh = mesh_of_text("obj", box);
    script_prepare(mesh, "material_set name=red base_color=1,0,0,0.5 emission=3,0,0.1 two_sided=1;"
                         "material_set name=blue base_color=0,0,1 metallic=0.25 roughness=0.75;"
                         "material_set name=unused");
    return mesh;
}

static char *write_glb(const char *encoding, const he_mesh *mesh, he_warnings *warnings,
                       size_t *length)
{
    return write_encoded("glb", encoding, mesh, 700, warnings, length);
}

static he_import read_glb(const char *bytes, size_t length)
{
    he_import import = {0};
    he_error err = {0};
    if (read_bytes("glb", bytes, length, &import, &err) != HE_OK) {
        fail_msg("%s", err.text);
    }
    return import;
}

static void expect_json(const char *bytes, const char *text)
{
    if (strstr(bytes + 20, text) == NULL) {
        fail_msg("no %s in %.3000s", text, bytes + 20);
    }
}

static void other_programs_see_meshes_primitives_and_materials(void **state)
{
    (void)state;
    he_mesh *mesh = grouped();
    size_t length;
    he_warnings warnings;
    char *bytes = write_glb("binary", mesh, &warnings, &length);
    expect_json(bytes, "\"scenes\":[{\"nodes\":[0,1,2]}]");
    expect_json(bytes, "\"nodes\":[{\"mesh\":0,\"name\":\"box\"},{\"mesh\":1,\"name\":\"box\"},"
                       "{\"mesh\":2,\"name\":\"other1\"}]");
    expect_json(bytes,
                "\"materials\":[{\"name\":\"red\",\"pbrMetallicRoughness\":"
                "{\"baseColorFactor\":[1,0,0,0.5],\"metallicFactor\":0,\"roughnessFactor\":1},"
                "\"emissiveFactor\":[0.75,0,0.025],\"extensions\":"
                "{\"KHR_materials_emissive_strength\":{\"emissiveStrength\":4}},"
                "\"alphaMode\":\"BLEND\",\"doubleSided\":true},{\"name\":\"blue\",");
    expect_json(bytes, "{\"name\":\"unused\",");
    expect_json(bytes, "{\"name\":\"bare\",\"extras\":{\"hedge\":\"name\"}}]");
    expect_json(bytes, "\"extensionsUsed\":[\"KHR_materials_emissive_strength\"]");
    /* The group `bottom` has faces of two materials, and so has the group `top`: in the file each
     * group must be one mesh with several primitives. */
    expect_json(bytes, "{\"name\":\"bottom\",\"primitives\":[{");
    expect_json(bytes, "{\"name\":\"top\",\"primitives\":[{");
    free(bytes);
    he_mesh_free(mesh);
}

/* Writes the mesh to a file and reads it back: the two meshes must be equal, except that the new
 * mesh has no entries of deleted elements. */
static void expect_back(he_mesh *mesh, const char *encoding)
{
    size_t length;
    he_warnings warnings;
    char *bytes = write_glb(encoding, mesh, &warnings, &length);
    he_import import = read_glb(bytes, length);
    assert_null(find_warning(&import.warnings, "stale_extras", ""));
    he_mesh *again = build_import(&import);
    assert_int_equal(he_compact(mesh, NULL, NULL), HE_OK);
    char *left = write_text("obj", mesh, NULL), *right = write_text("obj", again, NULL);
    assert_string_equal(left, right);
    free(left);
    free(right);
    assert_true(he_materials_equal(he_mesh_materials(mesh), he_mesh_materials(again)));
    he_import_clear(&import);
    free(bytes);
    he_mesh_free(again);
    he_mesh_free(mesh);
}

static void the_mesh_comes_back_as_it_was(void **state)
{
    (void)state;
    static const char *const edits[] = {"material_set name=red roughness=0.5",
                                        "face_delete face=1",
                                        "vertex_delete vertex=0",
                                        "triangulate",
                                        "material_set name=red faces=0,1,2,3,4,5,6",
                                        "vertex_add position=9,9,9"};
    for (size_t i = 0; i < sizeof edits / sizeof *edits; i++) {
        for (int packed = 0; packed < 2; packed++) {
            he_mesh *mesh = grouped();
            script_prepare(mesh, edits[i]);
            expect_back(mesh, packed ? "meshopt" : "binary");
        }
    }
}

/* If all faces have one group and one material, the file must have only one primitive, with the
 * names of the group and the material. */
static void one_material_is_one_primitive(void **state)
{
    (void)state;
    he_mesh *mesh = mesh_of_text("obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\no thing\ng part\nf 1 2 3\n");
    script_prepare(mesh, "material_set name=red base_color=1,0,0 face=0");
    size_t length;
    char *bytes = write_glb("binary", mesh, NULL, &length);
    expect_json(bytes,
                "\"nodes\":[{\"mesh\":0,\"name\":\"thing\"}],\"meshes\":[{\"name\":\"part\",");
    expect_json(bytes, ",\"material\":0}]}]");
    assert_null(strstr(bytes + 20, "\"order\""));
    free(bytes);
    expect_back(mesh, "binary");
}

/* If another program has changed the scene of a file, hedge must ignore the data that it once added
 * to the file for itself, and read what the other program wrote. */
static void a_changed_scene_is_read_as_it_stands(void **state)
{
    (void)state;
    static const struct {
        const char *from, *to;
    } rows[] = {
        {"{\"name\":\"blue\"", "{\"name\":\"cyan\""},
        {"\"mesh\":2,\"name\":\"other1\"", "\"mesh\":2,\"scale\":[1,1,1]"},
        {"\"nodes\":[0,1,2]", "\"nodes\":[0,2  ]"},
        {"\"primitive\":", "\"primitave\":"},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        he_mesh *mesh = grouped();
        size_t length, size = strlen(rows[i].from);
        char *bytes = write_glb("binary", mesh, NULL, &length);
        char *at = strstr(bytes + 20, rows[i].from);
        assert_non_null(at);
        assert_int_equal(strlen(rows[i].to), size);
        memcpy(at, rows[i].to, size);
        he_import import = read_glb(bytes, length);
        assert_non_null(find_warning(&import.warnings, "stale_extras", ""));
        /* hedge ignores its own data in the file, so the faces are triangles */
        assert_int_equal(import.soup.face_count, i == 2 ? 7 : 13);
        assert_string_equal(face_label(&import, "material", 0), "red");
        assert_int_equal(import.soup.materials.count, 3);
        he_import_clear(&import);
        free(bytes);
        he_mesh_free(mesh);
    }
}

static void too_many_groups_are_told_apart_less(void **state)
{
    (void)state;
    size_t room = 80 * 5000, length = 0;
    char *text = malloc(room);
    assert_non_null(text);
    length += (size_t)snprintf(text, room, "v 0 0 0\nv 1 0 0\nv 0 1 0\n");
    for (int i = 0; i < 4200; i++) {
        length += (size_t)snprintf(text + length, room - length,
                                   "v %d 0 1\nv %d 1 1\nv %d 0 2\no o%d\nusemtl m%d\nf -3 -2 -1\n",
                                   i, i, i, i, i % 3);
    }
    he_mesh *mesh = mesh_of_text("obj", text);
    he_warnings warnings;
    char *bytes = write_glb("binary", mesh, &warnings, &length);
    assert_non_null(find_warning(&warnings, "not_apart", "objects and groups"));
    assert_null(find_warning(&warnings, "not_apart", "materials"));
    expect_json(bytes, "\"nodes\":[{\"mesh\":0}]");
    free(bytes);
    free(text);
    expect_back(mesh, "binary");
}

static void without_memory_nothing_is_written_or_read(void **state)
{
    (void)state;
    he_mesh *mesh = grouped();
    size_t length;
    char *bytes = write_glb("binary", mesh, NULL, &length);
    const he_format *glb = he_format_find("glb");
    failing writing = {0};
    while (failing_next(&writing)) {
        failing_pause();
        he_writer *writer = NULL;
        failing_resume();
        he_status status = he_writer_new(glb, mesh, 0, NULL, &writer, NULL);
        failing_status(&writing, status);
        he_writer_free(status == HE_OK ? writer : NULL);
    }
    failing reading = {0};
    while (failing_next(&reading)) {
        failing_pause();
        he_import import = {0};
        he_reader *reader = NULL;
        failing_resume();
        he_status status = he_reader_new(glb, NULL, &reader, NULL);
        if (status == HE_OK) {
            status = he_reader_feed(reader, bytes, length, NULL);
        }
        if (status == HE_OK) {
            status = he_reader_finish(reader, &import, NULL);
        }
        failing_status(&reading, status);
        he_reader_free(reader);
        he_import_clear(&import);
    }
    free(bytes);
    he_mesh_free(mesh);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(other_programs_see_meshes_primitives_and_materials),
        cmocka_unit_test(the_mesh_comes_back_as_it_was),
        cmocka_unit_test(one_material_is_one_primitive),
        cmocka_unit_test(a_changed_scene_is_read_as_it_stands),
        cmocka_unit_test(too_many_groups_are_told_apart_less),
        cmocka_unit_test(without_memory_nothing_is_written_or_read),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
