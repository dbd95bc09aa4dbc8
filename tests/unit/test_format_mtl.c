/* MTL files, which are libraries of materials: reading a library gives a mesh its table of
 * materials, hedge writes the table as a library again, and OBJ files keep the names of their
 * libraries. */
#include "unit/edit_script.h"
#include "unit/format_fixture.h"

#include "format/obj/mtl.h"
#include "mesh/write.h"
#include "tests/failing.h"

#define TRIANGLE "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"

static he_import read_library(const char *text)
{
    he_import import = {0};
    he_error err = {0};
    if (he_mtl_read(text, strlen(text), &import, &err) != HE_OK) {
        fail_msg("%s\n%s", text, err.text);
    }
    return import;
}

static void expect_look(const he_materials *table, size_t slot, const char *name,
                        const double numbers[9])
{
    assert_true(slot < table->count);
    const he_material *row = table->rows[slot];
    assert_non_null(row);
    assert_string_equal(row->name, name);
    const double is[9] = {row->look.base_color[0], row->look.base_color[1], row->look.base_color[2],
                          row->look.base_color[3], row->look.metallic,      row->look.roughness,
                          row->look.emission[0],   row->look.emission[1],   row->look.emission[2]};
    for (size_t i = 0; i < 9; i++) {
        if (is[i] != numbers[i]) {
            fail_msg("number %zu of %s is %.17g, not %.17g", i, name, is[i], numbers[i]);
        }
    }
}

static void a_library_fills_the_table(void **state)
{
    (void)state;
    he_import import = read_library(
        "\xEF\xBB\xBF# all\r\nnewmtl  the red one \r\n Kd 1 0.25 0\nKe 2 0 0 # bright\n"
        "d 0.5\nTr 0.9\nPm 0.75\nPr .125\nillum 4\n\nnewmtl grey\nTr .25\nKd .5\n"
        "newmtl K\xF6rper\nd -halo 0.75\nnewmtl plain");
    const he_materials *table = &import.soup.materials;
    assert_int_equal(table->count, 4);
    expect_look(table, 0, "the red one", (double[]){1, 0.25, 0, 0.5, 0.75, 0.125, 2, 0, 0});
    expect_look(table, 1, "grey", (double[]){0.5, 0.5, 0.5, 0.75, 0, 1, 0, 0, 0});
    expect_look(table, 2, "K\xC3\xB6rper", (double[]){1, 1, 1, 0.75, 0, 1, 0, 0, 0});
    expect_look(table, 3, "plain", (double[]){1, 1, 1, 1, 0, 1, 0, 0, 0});
    assert_int_equal(import.warnings.count, 1);
    expect_warning(&import, "not_utf8", "K??rper", 1, 0);
    he_import_clear(&import);
    import = read_library("# nothing\n");
    assert_int_equal(import.soup.materials.count, 0);
    assert_int_equal(import.warnings.count, 0);
    he_import_clear(&import);
}

static void what_is_not_held_is_told_by_name(void **state)
{
    (void)state;
    he_import import =
        read_library("newmtl a\nmap_Kd -s 1 1 1 the brick.png\nbump b.png\nKs 1 1 1\n"
                     "Ns 10\nNs 20\nKd spectral x.rfl\nsheen 1\n");
    expect_warning(&import, "ignored_texture", "map_Kd -s 1 1 1 the brick.png", 1, 0);
    expect_warning(&import, "ignored_texture", "bump b.png", 1, 0);
    expect_warning(&import, "ignored_keyword", "Ks", 1, 0);
    expect_warning(&import, "ignored_keyword", "Ns", 2, 0);
    expect_warning(&import, "ignored_color", "Kd", 1, 0);
    expect_warning(&import, "unknown_keyword", "sheen", 1, 0);
    assert_int_equal(import.warnings.count, 6);
    he_import_clear(&import);
}

static void numbers_and_names_are_made_to_fit_with_a_note(void **state)
{
    (void)state;
    char text[3000];
    he_import import =
        read_library("newmtl a\nKd 2 -1 nan\nnewmtl b\nKd 1 0 0\nnewmtl b\nKd 1 0 0\n"
                     "newmtl b\nKd 0 1 0\nnewmtl\nKd 1 1 1\n");
    expect_look(&import.soup.materials, 0, "a", (double[]){1, 0, 0, 1, 0, 1, 0, 0, 0});
    expect_look(&import.soup.materials, 1, "b", (double[]){1, 0, 0, 1, 0, 1, 0, 0, 0});
    assert_int_equal(import.soup.materials.count, 2);
    expect_warning(&import, "material_range", "a", 1, 0);
    expect_warning(&import, "material_twice", "b", 1, 0);
    expect_warning(&import, "material_name", "", 1, 0);
    he_import_clear(&import);
    snprintf(text, sizeof text, "newmtl %01023d\nnewmtl %01024d\n", 7, 7);
    import = read_library(text);
    assert_int_equal(import.soup.materials.count, 1);
    assert_int_equal(import.warnings.count, 1);
    assert_string_equal(import.warnings.items[0].code, "material_name");
    he_import_clear(&import);
}

static void a_table_has_an_end(void **state)
{
    (void)state;
    size_t room = 40 * (HE_MATERIALS + 20), length = 0;
    char *text = malloc(room);
    assert_non_null(text);
    for (int i = 0; i < HE_MATERIALS + 10; i++) {
        length += (size_t)snprintf(text + length, room - length, "newmtl m%d\n", i);
    }
    (void)snprintf(text + length, room - length, "newmtl m0\nnewmtl m%d\n", HE_MATERIALS);
    he_import import = read_library(text);
    assert_int_equal(import.soup.materials.count, HE_MATERIALS);
    expect_warning(&import, "material_limit", "", 10, 0);
    he_import_clear(&import);
    free(text);
}

static void what_is_no_library_is_refused_with_its_line(void **state)
{
    (void)state;
    static const struct {
        const char *text, *words;
        he_status status;
        uint64_t line;
    } rows[] = {
        {"newmtl a\nKd 1 0\n", "a colour has 3 numbers, not 2", HE_SYNTAX, 2},
        {"newmtl a\nKd\n", "a colour has 3 numbers, not 0", HE_SYNTAX, 2},
        {"newmtl a\n\nKd 1 x 0\n", "'x' is not a number", HE_SYNTAX, 3},
        {"newmtl a\nd\n", "a number is missing", HE_SYNTAX, 2},
        {"newmtl a\nPm red\n", "'red' is not a number", HE_SYNTAX, 2},
        {"newmtl a\x01\n", "control character 1", HE_SYNTAX, 1},
        {"# x\n\x89PNG\n", "cannot be part of a material library", HE_SYNTAX, 2},
        {"\xFF\xFEn\n", "UTF-16", HE_UNSUPPORTED, 1},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        he_import import = {0};
        he_error err = {0};
        assert_int_equal(he_mtl_read(rows[i].text, strlen(rows[i].text), &import, &err),
                         rows[i].status);
        if (strstr(err.text, rows[i].words) == NULL || err.at != rows[i].line) {
            fail_msg("%s\ngot line %d: %s", rows[i].text, (int)err.at, err.text);
        }
        he_import_clear(&import);
    }
}

/* Reads an OBJ file together with the files that it refers to. */
static he_status read_obj(const char *text, he_beside *beside, he_import *out, he_error *err)
{
    he_reader *reader;
    assert_int_equal(he_reader_new(he_format_find("obj"), NULL, &reader, err), HE_OK);
    he_reader_beside(reader, beside);
    he_status status = he_reader_feed(reader, text, strlen(text), err);
    if (status == HE_OK) {
        status = he_reader_finish(reader, out, err);
    }
    he_reader_free(reader);
    return status;
}

static void an_obj_file_brings_the_library_it_came_with(void **state)
{
    (void)state;
    static const char a[] = "newmtl red\nKd 1 0 0\nmap_Kd brick.png\n",
                      b[] = "newmtl blue\nKd 0 0 1";
    he_beside_file files[] = {{"dir/a.mtl", a, sizeof a - 1, false},
                              {"b c.mtl", b, sizeof b - 1, false},
                              {"brick.png", "x", 1, false}};
    he_beside beside = {files, 3};
    he_import import = {0};
    he_error err = {0};
    assert_int_equal(read_obj("mtllib a.mtl gone.mtl\nmtllib b c.mtl\nusemtl red\n" TRIANGLE,
                              &beside, &import, &err),
                     HE_OK);
    expect_look(&import.soup.materials, 0, "red", (double[]){1, 0, 0, 1, 0, 1, 0, 0, 0});
    expect_look(&import.soup.materials, 1, "blue", (double[]){0, 0, 1, 1, 0, 1, 0, 0, 0});
    expect_warning(&import, "library_missing", "gone.mtl", 1, 1);
    expect_warning(&import, "ignored_texture", "map_Kd brick.png", 1, 0);
    assert_int_equal(import.warnings.count, 2);
    he_mesh *mesh = build_import(&import);
    he_import_clear(&import);
    he_warnings warnings;
    char *text = write_text("obj", mesh, &warnings);
    assert_string_equal(text, "# 3 vertices, 1 faces\nmtllib a.mtl gone.mtl\nmtllib b c.mtl\n"
                              "v 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl red\nf 1 2 3\n");
    assert_int_equal(warnings.count, 1);
    assert_non_null(find_warning(&warnings, "in_library", ""));
    free(text);
    text = write_text("mtl", mesh, &warnings);
    assert_string_equal(text,
                        "# materials\nnewmtl red\nKd 1 0 0\nd 1\nKe 0 0 0\nPm 0\nPr 1\nillum 2\n"
                        "newmtl blue\nKd 0 0 1\nd 1\nKe 0 0 0\nPm 0\nPr 1\nillum 2\n");
    assert_int_equal(warnings.count, 0);
    free(text);
    he_mesh_free(mesh);
}

static void a_library_that_is_wrong_is_named(void **state)
{
    (void)state;
    static const char bad[] = "newmtl a\nKd red\n";
    he_beside_file files[] = {{"a.mtl", bad, sizeof bad - 1, false}};
    he_beside beside = {files, 1};
    he_import import = {0};
    he_error err = {0};
    assert_int_equal(read_obj(TRIANGLE "mtllib a.mtl\n", &beside, &import, &err), HE_SYNTAX);
    assert_string_equal(err.text, "material library a.mtl, line 2: 'red' is not a number");
    assert_int_equal(err.place, HE_PLACE_LINE);
    assert_int_equal(err.at, 5);
}

/* The table of materials has names that must be escaped in MTL, a value for every number of a
 * material, and both values of two_sided: all must be read back from the library that is
 * written. */
static void a_table_comes_back_from_its_library(void **state)
{
    (void)state;
    he_mesh *mesh = mesh_of_text("obj", TRIANGLE);
    script_prepare(mesh, "material_set name=a base_color=0.1,0.2,0.3,0.4 metallic=0.5 "
                         "roughness=0.6 emission=7e100,0.8,1e-9;material_set name=b two_sided=1");
    he_warnings warnings;
    char *text = write_text("mtl", mesh, &warnings);
    assert_int_equal(warnings.count, 1);
    assert_non_null(find_warning(&warnings, "two_sided_lost", "b"));
    he_import import = read_library(text);
    assert_true(he_material_equal(import.soup.materials.rows[0], he_mesh_materials(mesh)->rows[0]));
    assert_false(import.soup.materials.rows[1]->look.two_sided);
    he_import_clear(&import);
    free(text);
    text = write_text("obj", mesh, NULL);
    assert_non_null(strstr(text, "\nmtllib materials.mtl\n"));
    free(text);
    free(write_text("ply", mesh, &warnings));
    assert_int_equal(find_warning(&warnings, "materials_lost", "")->count, 2);
    free(write_text("off", mesh, &warnings));
    assert_non_null(find_warning(&warnings, "materials_lost", ""));
    free(write_text("stl", mesh, &warnings));
    assert_non_null(find_warning(&warnings, "materials_lost", ""));
    script_prepare(mesh, "material_set name=a rename=\\");
    free(write_text("mtl", mesh, &warnings));
    assert_non_null(find_warning(&warnings, "names_changed", "\\"));
    he_mesh_free(mesh);
    mesh = mesh_of_text("obj", TRIANGLE);
    text = write_text("mtl", mesh, &warnings);
    assert_string_equal(text, "# materials\n");
    free(text);
    he_mesh_free(mesh);
}

static void without_memory_nothing_is_lost_or_kept(void **state)
{
    (void)state;
    static const char library[] = "newmtl red\nKd 1 0 0\nnewmtl blue\nnewmtl red\nKd 0 1 0\n";
    he_beside_file files[] = {{"a.mtl", library, sizeof library - 1, false}};
    he_beside beside = {files, 1};
    failing f = {0};
    while (failing_next(&f)) {
        failing_pause();
        he_import import = {0};
        he_error err = {0};
        he_reader *reader = NULL;
        failing_resume();
        he_status status = he_reader_new(he_format_find("obj"), NULL, &reader, &err);
        if (status == HE_OK) {
            static const char text[] = "mtllib a.mtl\nusemtl red\n" TRIANGLE;
            he_reader_beside(reader, &beside);
            status = he_reader_feed(reader, text, sizeof text - 1, &err);
        }
        if (status == HE_OK) {
            status = he_reader_finish(reader, &import, &err);
        }
        failing_status(&f, status);
        he_reader_free(reader);
        he_import_clear(&import);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_library_fills_the_table),
        cmocka_unit_test(what_is_not_held_is_told_by_name),
        cmocka_unit_test(numbers_and_names_are_made_to_fit_with_a_note),
        cmocka_unit_test(a_table_has_an_end),
        cmocka_unit_test(what_is_no_library_is_refused_with_its_line),
        cmocka_unit_test(an_obj_file_brings_the_library_it_came_with),
        cmocka_unit_test(a_library_that_is_wrong_is_named),
        cmocka_unit_test(a_table_comes_back_from_its_library),
        cmocka_unit_test(without_memory_nothing_is_lost_or_kept),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
