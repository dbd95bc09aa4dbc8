/* Tests of materials: the table of materials must survive every edit that makes a new mesh, faces
 * must keep their materials, and two meshes with different tables must be joinable. */
#include "unit/edit_script.h"
#include "unit/fixture.h"

#include "edit/whole/append.h"
#include "mesh/check.h"
#include "mesh/column.h"
#include "mesh/write.h"

#define QCUBE "0123,7654,1045,2156,3267,0374"

static const char *name_of(const he_mesh *m, uint32_t face)
{
    const he_column *column = he_mesh_find_column(m, HE_FACE, HE_MATERIAL_ATTRIBUTE);
    uint32_t label;
    assert_non_null(column);
    assert_true(he_is_material_column(column));
    memcpy(&label, he_column_value(column, face), sizeof label);
    assert_true(label < he_labels_count(column->labels));
    return he_labels_get(column->labels, label);
}

static const he_look *look_of(const he_mesh *m, const char *name)
{
    const he_materials *table = he_mesh_materials(m);
    size_t slot = he_materials_find(table, name, strlen(name));
    if (slot == SIZE_MAX) {
        fail_msg("there is no material %s", name);
    }
    return &table->rows[slot]->look;
}

static void a_material_is_made_changed_and_given(void **state)
{
    (void)state;
    he_mesh *m = script_mesh(QCUBE, NULL);
    script_prepare(m, "material_set name=red base_color=1,0,0,0.5 faces=0,1");
    assert_string_equal(name_of(m, 1), "red");
    assert_string_equal(name_of(m, 2), "");
    assert_true(look_of(m, "red")->base_color[3] == 0.5);
    assert_true(look_of(m, "red")->roughness == 1 && look_of(m, "red")->metallic == 0);
    script_prepare(m, "material_set name=red base_color=0,1,0 emission=3,0,0 two_sided=1");
    const he_look *look = look_of(m, "red");
    assert_true(look->base_color[0] == 0 && look->base_color[1] == 1);
    assert_true(look->base_color[3] ==
                0.5); /* a colour given by three numbers leaves the opacity unchanged */
    assert_true(look->emission[0] == 3 && look->two_sided);
    script_prepare(m, "material_set name=red rename=green;material_set name=blue faces=1,2");
    assert_string_equal(name_of(m, 0), "green");
    assert_string_equal(name_of(m, 1), "blue");
    assert_int_equal(he_materials_count(he_mesh_materials(m)), 2);
    he_mesh_free(m);
}

static size_t label_count(const he_mesh *m)
{
    return he_labels_count(he_mesh_find_column(m, HE_FACE, HE_MATERIAL_ATTRIBUTE)->labels);
}

static void a_material_is_replaced_wholly(void **state)
{
    (void)state;
    he_mesh *m = script_mesh(QCUBE, NULL);
    script_prepare(m,
                   "material_set name=red base_color=1,0,0,0.5 emission=2,0,0 two_sided=1 face=0;"
                   "material_set name=red replace=1 base_color=0,0,1 metallic=1");
    const he_look *look = look_of(m, "red");
    assert_true(look->base_color[2] == 1 && look->base_color[3] == 1);
    assert_true(look->metallic == 1 && look->emission[0] == 0 && !look->two_sided);
    assert_string_equal(name_of(m, 0), "red");
    he_mesh_free(m);
}

static void what_had_a_deleted_material_has_none_or_another(void **state)
{
    (void)state;
    he_mesh *m = script_mesh(QCUBE, NULL);
    script_prepare(m, "material_set name=a face=0;material_set name=b faces=1,2;"
                      "material_set name=c face=3;material_delete name=a");
    assert_string_equal(name_of(m, 0), "");
    assert_string_equal(name_of(m, 2), "b");
    assert_string_equal(name_of(m, 3), "c");
    assert_int_equal(label_count(m), 3); /* the three labels are b, c and the empty name */
    assert_int_equal(he_materials_count(he_mesh_materials(m)), 2);
    script_prepare(m, "material_delete name=c to=b");
    assert_string_equal(name_of(m, 3), "b");
    assert_int_equal(label_count(m), 2);
    /* The faces of a deleted material must get the replacement `d`, even if no face had `d` before.
     * The new faces that face_poke makes must get the material of the poked face. */
    script_prepare(m, "material_set name=d;material_delete name=b to=d;face_poke face=3");
    assert_string_equal(name_of(m, 1), "d");
    assert_string_equal(name_of(m, he_mesh_issued(m, HE_FACE) - 1), "d");
    assert_int_equal(he_materials_count(he_mesh_materials(m)), 1);
    script_prepare(m, "material_set name= faces=1,2");
    assert_string_equal(name_of(m, 1), "");
    assert_string_equal(name_of(m, 3), "d");
    assert_valid(m);
    he_mesh_free(m);
}

/* The default value of the material attribute may be any material. If that material is deleted, the
 * empty name becomes the default value. */
static void a_default_material_is_deleted_like_any(void **state)
{
    (void)state;
    he_mesh *m = script_mesh(QCUBE, NULL);
    he_column *column = NULL;
    uint32_t index = 0;
    he_labels *labels = he_labels_new();
    assert_int_equal(he_labels_add(labels, "oak", 3, &index, NULL), HE_OK);
    assert_int_equal(he_labels_add(labels, "elm", 3, &index, NULL), HE_OK);
    assert_int_equal(
        he_column_new(&(he_column_schema){HE_MATERIAL_ATTRIBUTE, HE_FACE, HE_UINT32, 1, HE_COPY},
                      &column, NULL),
        HE_OK);
    memcpy(column->fallback, &index, sizeof index);
    column->labels = labels;
    assert_int_equal(he_column_extend(column, he_mesh_issued(m, HE_FACE), NULL), HE_OK);
    assert_int_equal(he_mesh_add_column(m, column, NULL), HE_OK);
    assert_string_equal(name_of(m, 5), "elm");
    script_prepare(m, "material_delete name=elm");
    assert_string_equal(name_of(m, 5), ""); /* the empty name replaces "elm" */
    script_prepare(m, "material_delete name=oak;vertex_add position=9,9,9");
    assert_int_equal(label_count(m), 1);
    assert_string_equal(name_of(m, 5), "");
    assert_valid(m);
    he_mesh_free(m);
}

static void expect_faces(const he_mesh *m, const he_delta *delta, size_t from, bool undone,
                         const char *faces)
{
    he_changes changes;
    char text[200] = "";
    assert_int_equal(he_changes_find(m, delta, from, delta->count, undone, &changes, NULL), HE_OK);
    for (size_t i = 0; i < changes.modified[HE_FACE].count; i++) {
        size_t length = strlen(text);
        (void)snprintf(text + length, sizeof text - length, "%s%u", i > 0 ? "," : "",
                       changes.modified[HE_FACE].ids[i]);
    }
    assert_string_equal(text, faces);
    assert_int_equal(changes.modified[HE_VERTEX].count + changes.modified[HE_EDGE].count, 0);
    assert_int_equal(changes.created[HE_FACE].count + changes.deleted[HE_FACE].count, 0);
    assert_false(he_changes_none(&changes));
    he_changes_clear(&changes);
}

/* The edits assign materials to faces. Some of these materials are new to the mesh, and the first
 * edit adds the material attribute itself. Each edit must report exactly those faces as modified
 * whose material changes. */
static void faces_whose_material_changes_are_modified(void **state)
{
    (void)state;
    static const char *const steps[][2] = {
        {"material_set name=red faces=1,3", "1,3"},
        {"material_set name=blue faces=3,4", "3,4"},
        {"material_set name=red face=4", "4"},
        {"material_set name=green;material_set name=red metallic=1", ""},
        {"material_set name=red rename=rot", "1,4"},
        {"material_set name=rot rename=a;material_set name=a rename=b faces=0", "0,1,4"},
        {"material_set name= face=0", "0"},
        {"material_delete name=green", ""},
        {"material_delete name=b to=blue", "1,4"},
        {"material_delete name=blue", "1,3,4"},
    };
    he_mesh *m = script_mesh(QCUBE, NULL);
    for (size_t i = 0; i < sizeof steps / sizeof *steps; i++) {
        he_delta *delta = he_delta_new();
        he_mesh_record(m, delta);
        script_prepare(m, steps[i][0]);
        he_mesh_record(m, NULL);
        expect_faces(m, delta, 0, false, steps[i][1]);
        he_delta_undo(delta, m);
        expect_faces(m, delta, 0, true, steps[i][1]);
        he_delta_redo(delta, m);
        expect_faces(m, delta, 0, false, steps[i][1]);
        he_delta_free(delta);
    }
    he_mesh_free(m);
}

/* The delta contains changes of attribute columns that `compact` removes. The whole edit must
 * therefore be reported as a replacement of the mesh data. */
static void a_material_set_before_a_compact_is_a_replacement(void **state)
{
    (void)state;
    he_mesh *m = script_mesh(QCUBE, NULL);
    he_delta *delta = he_delta_new();
    he_changes changes;
    script_add_columns(m);
    script_prepare(m, "material_set name=red face=0");
    for (size_t i = 0; i + 1 < he_mesh_columns(m); i++) {
        if (he_mesh_column(m, i) != NULL) {
            assert_int_equal(he_mesh_drop_column(m, i, NULL), HE_OK);
        }
    }
    he_mesh_record(m, delta);
    script_prepare(m, "material_set name=red face=1;material_set name=blue face=2;"
                      "material_set name=blue face=3;compact");
    he_mesh_record(m, NULL);
    assert_int_equal(he_mesh_columns(m), 1);
    assert_int_equal(he_changes_find(m, delta, 0, delta->count, false, &changes, NULL), HE_OK);
    assert_true(changes.replaced);
    he_changes_clear(&changes);
    he_delta_free(delta);
    he_mesh_free(m);
}

/* If material_set sets only values that the material has already, it must record nothing, so that
 * no revision is made. */
static void what_changes_nothing_is_no_edit(void **state)
{
    (void)state;
    he_mesh *m = script_mesh(QCUBE, NULL);
    script_prepare(m, "material_set name=red base_color=1,0,0 face=0");
    he_delta *delta = he_delta_new();
    he_mesh_record(m, delta);
    script_prepare(m, "material_set name=red base_color=1,0,0 face=0;material_set name=red;"
                      "material_set name= face=3");
    assert_int_equal(delta->count, 0);
    script_prepare(m, "material_set name=red roughness=0.5");
    assert_int_equal(delta->count, 1); /* the change of one material takes one record */
    he_mesh_record(m, NULL);
    he_delta_free(delta);
    he_mesh_free(m);
}

static void edits_of_the_whole_keep_the_table_and_faces_theirs(void **state)
{
    (void)state;
    static const char *const edits[] = {"subdivide",
                                        "subdivide scheme=linear",
                                        "triangulate",
                                        "compact",
                                        "reverse",
                                        "face_poke face=0",
                                        "face_split face=0 from=0 to=2",
                                        "face_delete face=5;compact",
                                        "triangulate;decimate faces=8",
                                        "plane_split point=3.5,0,0 normal=1,0,0",
                                        "triangulate;subdivide scheme=loop;decimate faces=20"};
    for (size_t i = 0; i < sizeof edits / sizeof *edits; i++) {
        he_mesh *m = script_mesh(QCUBE, NULL);
        script_prepare(m, "material_set name=red metallic=0.5 faces=0,1,2,3,4,5");
        he_materials before = {0};
        assert_int_equal(he_materials_copy(he_mesh_materials(m), &before, NULL), HE_OK);
        script_prepare(m, edits[i]);
        assert_true(he_materials_equal(he_mesh_materials(m), &before));
        for (uint32_t f = 0; f < he_mesh_issued(m, HE_FACE); f++) {
            if (he_mesh_is_live(m, HE_FACE, f)) {
                assert_string_equal(name_of(m, f), "red");
            }
        }
        assert_valid(m);
        he_materials_clear(&before);
        he_mesh_free(m);
    }
}

/* `compact` must close the gaps that deleted materials leave in the table. */
static void compact_closes_gaps(void **state)
{
    (void)state;
    he_mesh *m = script_mesh(QCUBE, NULL);
    script_prepare(m, "material_set name=a;material_set name=b;material_set name=c");
    assert_int_equal(he_mesh_put_material(m, 1, NULL, NULL), HE_OK);
    assert_int_equal(he_mesh_materials(m)->count, 3);
    script_prepare(m, "compact");
    assert_int_equal(he_mesh_materials(m)->count, 2);
    assert_string_equal(he_mesh_materials(m)->rows[1]->name, "c");
    he_mesh_free(m);
}

static void append_merges_equal_rows_and_numbers_others(void **state)
{
    (void)state;
    he_mesh *m = script_mesh("012,034", NULL), *other = script_mesh("012,034,056", NULL);
    script_prepare(m, "material_set name=same metallic=0.5 face=0;"
                      "material_set name=red base_color=1,0,0 face=1");
    script_prepare(other, "material_set name=red base_color=0,1,0 face=0;"
                          "material_set name=same metallic=0.5 face=1;"
                          "material_set name=red_2 base_color=0,0,1 face=2");
    he_appended appended = {.vertices = {0}};
    assert_int_equal(he_append(m, other, &appended, NULL), HE_OK);
    assert_int_equal(he_materials_count(he_mesh_materials(m)), 4);
    assert_string_equal(name_of(m, 0), "same");
    assert_string_equal(name_of(m, 1), "red");
    assert_string_equal(name_of(m, appended.faces.ids[0]), "red_3");
    assert_string_equal(name_of(m, appended.faces.ids[1]), "same");
    assert_string_equal(name_of(m, appended.faces.ids[2]), "red_2");
    assert_true(look_of(m, "red_3")->base_color[1] == 1);
    assert_true(look_of(m, "red_2")->base_color[2] == 1);
    assert_true(look_of(m, "red")->base_color[1] == 0);
    he_appended_clear(&appended);
    /* The first append renamed materials by adding numbers, as in "red_2". A second append must
     * find these names again. */
    assert_int_equal(he_append(m, other, NULL, NULL), HE_OK);
    assert_int_equal(he_materials_count(he_mesh_materials(m)), 4);
    assert_valid(m);
    he_mesh_free(m);
    /* If no face of the mesh has a material yet, the materials of the appended mesh must
     * nevertheless get new names at once. */
    m = script_mesh("012", NULL);
    script_prepare(m, "material_set name=red roughness=0.5");
    assert_int_equal(he_append(m, other, &appended, NULL), HE_OK);
    assert_string_equal(name_of(m, 0), "");
    assert_string_equal(name_of(m, appended.faces.ids[0]), "red_3");
    assert_string_equal(name_of(m, appended.faces.ids[2]), "red_2");
    he_appended_clear(&appended);
    he_mesh_free(m);
    he_mesh_free(other);
}

static void the_checker_sees_a_table_that_cannot_be(void **state)
{
    (void)state;
    he_mesh *m = script_mesh("012", NULL);
    he_problem problem;
    size_t total = 0;
    script_prepare(m, "material_set name=a;material_set name=b");
    m->c.materials.rows[1]->name[0] = 'a';
    assert_int_equal(he_check(m, &problem, 1, &total, NULL), HE_OK);
    assert_int_equal(total, 1);
    assert_int_equal(problem.rule, 13);
    m->c.materials.rows[1]->name[0] = 'b';
    m->c.materials.rows[0]->look.metallic = 2;
    assert_int_equal(he_check(m, &problem, 1, &total, NULL), HE_OK);
    assert_int_equal(problem.rule, 13);
    he_mesh_free(m);
}

/* The memory of a mesh must include its table of materials; the memory of an edit's delta (the
 * record of its changes) must include the materials that the edit changes. */
static void memory_of_rows_is_counted(void **state)
{
    (void)state;
    he_mesh *m = script_mesh("012", NULL);
    size_t before = he_mesh_bytes(m);
    script_prepare(m, "materials 100");
    assert_true(he_mesh_bytes(m) >= before + 100 * sizeof(he_material));
    he_delta *delta = he_delta_new();
    he_mesh_record(m, delta);
    before = he_delta_bytes(delta);
    script_prepare(m, "material_set name=m1 metallic=1");
    assert_true(he_delta_bytes(delta) >= before + sizeof(he_record) + sizeof(he_material));
    /* The names of materials are labels (texts) of an attribute. If an edit removes labels, their
     * memory must be counted in the edit's delta. */
    char name[HE_MATERIAL_NAME + 30];
    snprintf(name, sizeof name, "material_set name=%0200d face=0", 1);
    script_prepare(m, name);
    before = he_delta_bytes(delta);
    script_prepare(m, "material_set name=m2 face=0");
    assert_true(he_delta_bytes(delta) > before + 200);
    he_mesh_record(m, NULL);
    he_delta_free(delta);
    he_mesh_free(m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_material_is_made_changed_and_given),
        cmocka_unit_test(a_material_is_replaced_wholly),
        cmocka_unit_test(what_had_a_deleted_material_has_none_or_another),
        cmocka_unit_test(a_default_material_is_deleted_like_any),
        cmocka_unit_test(faces_whose_material_changes_are_modified),
        cmocka_unit_test(a_material_set_before_a_compact_is_a_replacement),
        cmocka_unit_test(what_changes_nothing_is_no_edit),
        cmocka_unit_test(edits_of_the_whole_keep_the_table_and_faces_theirs),
        cmocka_unit_test(compact_closes_gaps),
        cmocka_unit_test(append_merges_equal_rows_and_numbers_others),
        cmocka_unit_test(the_checker_sees_a_table_that_cannot_be),
        cmocka_unit_test(memory_of_rows_is_counted),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
