/* Recording of changes: undo, redo, rollback, sets of changed elements, attribute columns, and
 * compaction. The tests change the mesh directly by the functions of write.h; deltas of whole
 * operations are tested with the operations. */
#include "fixture.h"

#include "mesh/compact.h"
#include "mesh/write.h"
#include "tests/failing.h"

static he_mesh *copy_of(const he_mesh *m)
{
    he_mesh *copy;
    assert_int_equal(he_mesh_copy(m, &copy, NULL), HE_OK);
    assert_true(he_mesh_equal(m, copy));
    return copy;
}

/* Adds a separate triangle to the mesh with the functions of write.h. */
static he_status add_triangle(he_mesh *m, he_error *err)
{
    he_status status = he_reserve(m, (he_reservation){.vertices = 3, .edges = 3, .faces = 1}, err);
    if (status != HE_OK) {
        return status;
    }
    he_vertex v[3];
    he_edge e[3];
    he_face f = he_new_face(m);
    for (uint32_t i = 0; i < 3; i++) {
        v[i] = he_new_vertex(m);
        he_set_position(m, v[i], (he_vec3){i, 1.5 * i, -2});
        e[i] = he_new_edge(m);
    }
    for (uint32_t i = 0; i < 3; i++) {
        he_halfedge in = he_edge_halfedge(e[i], 0), out = he_edge_halfedge(e[i], 1);
        he_link(m, in, he_edge_halfedge(e[(i + 1) % 3], 0));
        he_link(m, out, he_edge_halfedge(e[(i + 2) % 3], 1));
        he_set_origin(m, in, v[i]);
        he_set_origin(m, out, v[(i + 1) % 3]);
        he_set_face(m, in, f);
        he_set_face(m, out, (he_face){HE_NONE});
        he_set_vertex_halfedge(m, v[(i + 1) % 3], out);
    }
    he_set_face_halfedge(m, f, he_edge_halfedge(e[0], 0));
    return HE_OK;
}

/* Removes a separate triangle from the mesh with the functions of write.h. */
static he_status remove_triangle(he_mesh *m, he_face f, he_error *err)
{
    he_reservation need = {.deleted_vertices = 3, .deleted_edges = 3, .deleted_faces = 1};
    he_status status = he_reserve(m, need, err);
    if (status != HE_OK) {
        return status;
    }
    he_halfedge h = he_face_halfedge(m, f);
    for (int i = 0; i < 3; i++) {
        he_halfedge next = he_next(m, h);
        he_delete_vertex(m, he_origin(m, h));
        he_delete_edge(m, he_edge_of(h));
        h = next;
    }
    he_delete_face(m, f);
    return HE_OK;
}

static he_mesh *mesh_with_columns(void)
{
    he_mesh *m = fixture_mesh("012,023");
    he_column *column;
    assert_int_equal(
        he_column_new(&(he_column_schema){"tag", HE_FACE, HE_UINT32, 1, HE_COPY}, &column, NULL),
        HE_OK);
    assert_int_equal(he_mesh_add_column(m, column, NULL), HE_OK);
    assert_int_equal(
        he_column_new(&(he_column_schema){"flag", HE_VERTEX, HE_BOOL, 3, HE_COPY}, &column, NULL),
        HE_OK);
    column->fallback[1] = 1;
    assert_int_equal(he_mesh_add_column(m, column, NULL), HE_OK);
    assert_int_equal(
        he_column_new(&(he_column_schema){"flag", HE_VERTEX, HE_BOOL, 1, HE_COPY}, &column, NULL),
        HE_OK);
    assert_int_equal(he_mesh_add_column(m, column, NULL), HE_BAD_VALUE);
    he_column_free(column);
    return m;
}

static void undo_and_redo_restore_the_mesh_but_ids_stay_issued(void **state)
{
    (void)state;
    he_mesh *m = mesh_with_columns(), *start = copy_of(m);
    he_delta *d = he_delta_new();
    assert_null(he_mesh_record(m, d));
    assert_int_equal(add_triangle(m, NULL), HE_OK);
    assert_int_equal(remove_triangle(m, (he_face){2}, NULL), HE_OK);
    assert_int_equal(add_triangle(m, NULL), HE_OK);
    he_mesh_record(m, NULL);
    fixture_check(m);
    fixture_counts(m, 7, 8, 3);
    he_mesh *end = copy_of(m);
    for (int round = 0; round < 3; round++) {
        he_delta_undo(d, m);
        fixture_check(m);
        assert_true(he_mesh_equal_live(m, start));
        /* undo does not take back the ids that were issued: their number stays the same */
        assert_false(he_mesh_equal(m, start));
        assert_int_equal(he_mesh_issued(m, HE_FACE), 4);
        he_error err;
        assert_int_equal(he_mesh_require(m, HE_FACE, 3, &err), HE_DELETED_ELEMENT);
        assert_int_equal(he_mesh_require(m, HE_FACE, 4, &err), HE_NO_SUCH_ELEMENT);
        he_delta_redo(d, m);
        fixture_check(m);
        assert_true(he_mesh_equal(m, end));
    }
    he_delta_free(d);
    he_mesh_free(m);
    he_mesh_free(start);
    he_mesh_free(end);
}

static void a_rollback_takes_issued_ids_back(void **state)
{
    (void)state;
    he_mesh *m = mesh_with_columns(), *start = copy_of(m);
    he_bracket bracket;
    assert_int_equal(he_edit_begin(m, &bracket, NULL), HE_OK);
    assert_int_equal(add_triangle(m, NULL), HE_OK);
    he_column *column;
    assert_int_equal(
        he_column_new(&(he_column_schema){"late", HE_EDGE, HE_DOUBLE, 2, HE_COPY}, &column, NULL),
        HE_OK);
    assert_int_equal(he_mesh_add_column(m, column, NULL), HE_OK);
    assert_int_equal(he_mesh_drop_column(m, 0, NULL), HE_OK);
    assert_int_equal(he_compact(m, NULL, NULL), HE_OK);
    assert_int_equal(add_triangle(m, NULL), HE_OK);
    assert_int_equal(he_edit_end(m, &bracket, HE_LIMIT), HE_LIMIT);
    fixture_check(m);
    assert_true(he_mesh_equal(m, start));
    assert_null(he_mesh_record(m, NULL));
    he_mesh_free(m);
    he_mesh_free(start);
}

static void expect_ids(const he_ids *list, size_t count, const uint32_t *ids)
{
    assert_int_equal(list->count, count);
    for (size_t i = 0; i < count; i++) {
        assert_int_equal(list->ids[i], ids[i]);
    }
}

static void changes_that_cancel_out_are_not_reported(void **state)
{
    (void)state;
    he_mesh *m = mesh_with_columns();
    he_delta *d = he_delta_new();
    he_changes changes;
    he_mesh_record(m, d);
    assert_int_equal(add_triangle(m, NULL), HE_OK);
    assert_int_equal(remove_triangle(m, (he_face){2}, NULL), HE_OK);
    assert_int_equal(he_changes_find(m, d, 0, d->count, false, &changes, NULL), HE_OK);
    assert_true(he_changes_none(&changes));
    he_changes_clear(&changes);

    size_t from = d->count;
    assert_int_equal(
        he_reserve(m, (he_reservation){.positions = 4, .attributes = 1, .lineage = 2}, NULL),
        HE_OK);
    he_vec3 at = he_position(m, (he_vertex){1});
    he_set_position(m, (he_vertex){1}, (he_vec3){5, 5, 5});
    he_set_position(m, (he_vertex){3}, (he_vec3){6, 6, 6});
    he_set_position(m, (he_vertex){1}, at);
    he_set_attribute(m, 0, 1, &(uint32_t){7});
    assert_int_equal(add_triangle(m, NULL), HE_OK);
    he_note_parent(m, HE_FACE, 3, 0);
    he_note_parent(m, HE_FACE, 1, 0); /* face 1 is not new, so its parent must not be reported */
    he_mesh_record(m, NULL);
    assert_int_equal(he_changes_find(m, d, from, d->count, false, &changes, NULL), HE_OK);
    expect_ids(&changes.created[HE_VERTEX], 3, (const uint32_t[]){7, 8, 9});
    expect_ids(&changes.created[HE_EDGE], 3, (const uint32_t[]){8, 9, 10});
    expect_ids(&changes.created[HE_FACE], 1, (const uint32_t[]){3});
    expect_ids(&changes.modified[HE_VERTEX], 1, (const uint32_t[]){3});
    expect_ids(&changes.modified[HE_FACE], 1, (const uint32_t[]){1});
    expect_ids(&changes.parents[HE_FACE], 2, (const uint32_t[]){3, 0});
    assert_int_equal(changes.deleted[HE_FACE].count, 0);
    he_changes_clear(&changes);

    he_delta_undo(d, m);
    assert_int_equal(he_changes_find(m, d, 0, d->count, true, &changes, NULL), HE_OK);
    expect_ids(&changes.deleted[HE_FACE], 1, (const uint32_t[]){3});
    assert_int_equal(changes.created[HE_FACE].count, 0);
    expect_ids(&changes.modified[HE_VERTEX], 1, (const uint32_t[]){3});
    he_changes_clear(&changes);
    he_delta_free(d);
    he_mesh_free(m);
}

static void many_created_rows_are_listed_in_order_and_not_as_modified(void **state)
{
    (void)state;
    he_mesh *m = fixture_mesh("012,023");
    he_delta *d = he_delta_new();
    he_changes changes;
    he_mesh_record(m, d);
    for (int i = 0; i < 700; i++) {
        assert_int_equal(add_triangle(m, NULL), HE_OK);
    }
    assert_int_equal(he_changes_find(m, d, 0, d->count, false, &changes, NULL), HE_OK);
    assert_int_equal(changes.created[HE_VERTEX].count, 2100);
    for (uint32_t i = 0; i < 2100; i++) {
        assert_int_equal(changes.created[HE_VERTEX].ids[i], 4 + i);
    }
    assert_int_equal(changes.modified[HE_VERTEX].count, 0);
    assert_int_equal(changes.modified[HE_FACE].count, 0);
    he_changes_clear(&changes);
    he_mesh_record(m, NULL);
    he_delta_free(d);
    he_mesh_free(m);
}

static void undo_and_redo_restore_added_and_dropped_columns(void **state)
{
    (void)state;
    he_mesh *m = mesh_with_columns(), *start = copy_of(m);
    he_delta *d = he_delta_new();
    he_mesh_record(m, d);
    he_column *column;
    assert_int_equal(he_column_new(&(he_column_schema){"weight", HE_VERTEX, HE_DOUBLE, 1, HE_COPY},
                                   &column, NULL),
                     HE_OK);
    assert_int_equal(he_mesh_add_column(m, column, NULL), HE_OK);
    assert_int_equal(he_mesh_drop_column(m, 1, NULL), HE_OK);
    assert_int_equal(he_reserve(m, (he_reservation){.attributes = 1}, NULL), HE_OK);
    he_set_attribute(m, 2, 1, &(double){2.5});
    he_mesh_record(m, NULL);
    he_mesh *end = copy_of(m);
    for (int i = 0; i < 2; i++) {
        assert_null(he_mesh_find_column(m, HE_VERTEX, "flag"));
        assert_non_null(he_mesh_find_column(m, HE_VERTEX, "weight"));
        he_delta_undo(d, m);
        assert_true(he_mesh_equal(m, start));
        assert_non_null(he_mesh_find_column(m, HE_VERTEX, "flag"));
        assert_null(he_mesh_find_column(m, HE_VERTEX, "weight"));
        he_delta_redo(d, m);
        assert_true(he_mesh_equal(m, end));
    }
    he_delta_free(d);
    he_mesh_free(m);
    he_mesh_free(start);
    he_mesh_free(end);
}

/* A value of the mesh itself or of a half-edge along a hole belongs to no vertex, edge or face that
 * could be reported as modified; setting such a value must still count as a change. */
static void values_of_no_vertex_edge_or_face_count_as_changes(void **state)
{
    (void)state;
    static const he_kind domains[] = {HE_MESH_KIND, HE_HALFEDGE};
    for (size_t i = 0; i < 2; i++) {
        he_mesh *m = fixture_mesh("012");
        he_delta *d = he_delta_new();
        he_column *column;
        he_changes changes;
        he_mesh_record(m, d);
        assert_int_equal(
            he_column_new(&(he_column_schema){"mark", domains[i], HE_UINT32, 1, HE_COPY}, &column,
                          NULL),
            HE_OK);
        size_t rows = i == 0 ? 1 : he_mesh_issued(m, HE_HALFEDGE);
        assert_int_equal(he_column_extend(column, rows, NULL), HE_OK);
        assert_int_equal(he_mesh_add_column(m, column, NULL), HE_OK);
        assert_int_equal(he_changes_find(m, d, 0, d->count, false, &changes, NULL), HE_OK);
        assert_false(he_changes_none(&changes));
        he_changes_clear(&changes);
        size_t from = d->count;
        assert_int_equal(he_reserve(m, (he_reservation){.attributes = 1}, NULL), HE_OK);
        /* Half-edge 1 runs along the hole, so it belongs to no corner of a face. */
        he_set_attribute(m, 0, (uint32_t)rows == 1 ? 0 : 1, &(uint32_t){7});
        assert_int_equal(d->count, from + 1);
        assert_int_equal(he_changes_find(m, d, from, d->count, false, &changes, NULL), HE_OK);
        assert_false(he_changes_none(&changes));
        assert_int_equal(changes.modified[HE_FACE].count, 0);
        he_changes_clear(&changes);
        he_mesh_record(m, NULL);
        he_delta_free(d);
        he_mesh_free(m);
    }
}

static void put_column(he_mesh *m, const char *name, he_kind domain)
{
    he_column *column;
    assert_int_equal(
        he_column_new(&(he_column_schema){name, domain, HE_UINT32, 1, HE_COPY}, &column, NULL),
        HE_OK);
    assert_int_equal(he_column_extend(column, he_mesh_issued(m, domain), NULL), HE_OK);
    assert_int_equal(he_mesh_add_column(m, column, NULL), HE_OK);
}

/* A column of attributes is removed, and a new column takes the index of the removed one: a value
 * that was written to the removed column must not be reported as a value of the new one. */
static void changes_of_a_dropped_column_are_not_those_of_its_successor(void **state)
{
    (void)state;
    static const he_kind domains[] = {HE_FACE, HE_HALFEDGE, HE_EDGE, HE_MESH_KIND};
    for (size_t i = 0; i < sizeof domains / sizeof *domains; i++) {
        he_mesh *m = fixture_mesh("012,345");
        he_vertex far = {0};
        assert_int_equal(he_reserve(m, (he_reservation){.vertices = 1000}, NULL), HE_OK);
        for (int k = 0; k < 1000; k++) {
            far = he_new_vertex(m);
            he_set_vertex_halfedge(m, far, (he_halfedge){HE_NONE});
        }
        he_delta *steps[3] = {he_delta_new(), he_delta_new(), he_delta_new()};
        he_changes changes;
        put_column(m, "first", HE_VERTEX);
        he_mesh_record(m, steps[0]);
        assert_int_equal(he_reserve_values(m, 0, 2, NULL), HE_OK);
        he_set_attribute(m, 0, 1, &(uint32_t){7});
        he_set_attribute(m, 0, far.i, &(uint32_t){7});
        he_mesh_record(m, steps[1]);
        assert_int_equal(he_mesh_drop_column(m, 0, NULL), HE_OK);
        he_mesh_record(m, steps[2]);
        put_column(m, "second", domains[i]);
        he_mesh_record(m, NULL);
        const he_change_part done[3] = {{steps[0], 0, steps[0]->count, false},
                                        {steps[1], 0, steps[1]->count, false},
                                        {steps[2], 0, steps[2]->count, false}};
        assert_int_equal(he_changes_sum(m, done, 3, &changes, NULL), HE_OK);
        assert_true(changes.others);
        assert_int_equal(changes.modified[HE_VERTEX].count, 0);
        assert_int_equal(changes.modified[HE_EDGE].count, 0);
        assert_int_equal(changes.modified[HE_FACE].count, 0);
        he_changes_clear(&changes);
        for (size_t k = 0; k < 3; k++) {
            he_delta_free(steps[k]);
        }
        he_mesh_free(m);
    }
}

/* The memory that is reserved for one attribute value must be enough for the widest possible value,
 * for every kind of element. */
static void a_reservation_has_room_for_the_widest_value(void **state)
{
    (void)state;
    for (int kind = 0; kind < HE_KIND_COUNT; kind++) {
        he_mesh *m = fixture_mesh("012"), *start = NULL;
        he_column *column;
        double value[HE_COLUMN_COMPONENTS];
        for (size_t i = 0; i < HE_COLUMN_COMPONENTS; i++) {
            value[i] = -1.0 / (double)(3 + i);
        }
        assert_int_equal(he_column_new(&(he_column_schema){"wide", (he_kind)kind, HE_DOUBLE,
                                                           HE_COLUMN_COMPONENTS, HE_COPY},
                                       &column, NULL),
                         HE_OK);
        assert_int_equal(he_column_extend(column, he_mesh_issued(m, (he_kind)kind), NULL), HE_OK);
        assert_int_equal(he_mesh_add_column(m, column, NULL), HE_OK);
        start = copy_of(m);
        he_delta *d = he_delta_new();
        he_mesh_record(m, d);
        assert_int_equal(he_reserve(m, (he_reservation){.attributes = 1}, NULL), HE_OK);
        assert_in_range(d->capacity, sizeof value / 4, SIZE_MAX);
        he_set_attribute(m, 0, 0, value);
        he_mesh_record(m, NULL);
        he_delta_undo(d, m);
        assert_true(he_mesh_equal(m, start));
        he_delta_free(d);
        he_mesh_free(m);
        he_mesh_free(start);
    }
}

static void compact_renumbers_elements_and_can_be_undone(void **state)
{
    (void)state;
    he_mesh *m = mesh_with_columns();
    assert_int_equal(add_triangle(m, NULL), HE_OK);
    assert_int_equal(he_reserve(m, (he_reservation){.attributes = 1}, NULL), HE_OK);
    he_set_attribute(m, 0, 1, &(uint32_t){77});
    assert_int_equal(add_triangle(m, NULL), HE_OK);
    assert_int_equal(remove_triangle(m, (he_face){2}, NULL), HE_OK);
    he_mesh *before = copy_of(m);
    he_delta *d = he_delta_new();
    he_mesh_record(m, d);
    he_maps maps;
    assert_int_equal(he_compact(m, &maps, NULL), HE_OK);
    fixture_check(m);
    fixture_counts(m, 7, 8, 3);
    assert_int_equal(he_mesh_issued(m, HE_VERTEX), 7);
    assert_int_equal(maps.faces, 4);
    assert_int_equal(maps.face[2], HE_NONE);
    assert_int_equal(maps.face[3], 2);
    assert_memory_equal(he_column_value(he_mesh_find_column(m, HE_FACE, "tag"), 1), &(uint32_t){77},
                        4);
    he_vec3 moved = he_position(m, (he_vertex){maps.vertex[8]});
    assert_true(moved.y == 1.5);
    he_changes changes;
    assert_int_equal(he_changes_find(m, d, 0, d->count, false, &changes, NULL), HE_OK);
    assert_true(changes.replaced && !he_changes_none(&changes));
    he_changes_clear(&changes);
    assert_true(he_delta_bytes(d) > he_mesh_bytes(m) / 2);
    he_mesh_record(m, NULL);
    he_delta_undo(d, m);
    assert_true(he_mesh_equal(m, before));
    he_delta_redo(d, m);
    fixture_counts(m, 7, 8, 3);
    he_maps_clear(&maps);
    he_delta_free(d);
    he_mesh_free(m);
    he_mesh_free(before);
}

static void edits_without_memory_are_rolled_back_and_copies_not_made(void **state)
{
    (void)state;
    he_mesh *m = mesh_with_columns(), *start = copy_of(m);
    failing editing = {.what = "editing"}, copying = {.what = "copying"};
    while (failing_next(&editing)) {
        failing_pause();
        he_delta *d = he_delta_new();
        he_mesh_record(m, d);
        he_savepoint mark = he_delta_mark(m);
        failing_resume();
        he_status status = add_triangle(m, NULL);
        if (status == HE_OK) {
            status = he_compact(m, NULL, NULL);
        }
        failing_status(&editing, status);
        he_delta_rollback(m, mark);
        he_mesh_record(m, NULL);
        he_delta_free(d);
        fixture_check(m);
        assert_true(he_mesh_equal(m, start));
    }
    while (failing_next(&copying)) {
        he_mesh *copy = NULL;
        bool copied = failing_status(&copying, he_mesh_copy(m, &copy, NULL));
        assert_true(copied || copy == NULL);
        he_mesh_free(copy);
    }
    print_message("%ld allocations failed in turn\n", editing.n - 1);
    assert_true(editing.n > 11);
    he_mesh_free(m);
    he_mesh_free(start);
}

static void carried_values_follow_the_rule_of_their_column(void **state)
{
    (void)state;
    he_mesh *m = fixture_mesh("012,023");
    static const struct {
        he_rule rule;
        double expected;
    } rows[] = {{HE_COPY, 10}, {HE_INTERPOLATE, 12.5}, {HE_DEFAULT, 3}};
    for (size_t i = 0; i < 3; i++) {
        he_column *column;
        assert_int_equal(he_column_new(&(he_column_schema){he_rule_name(rows[i].rule), HE_VERTEX,
                                                           HE_DOUBLE, 1, rows[i].rule},
                                       &column, NULL),
                         HE_OK);
        memcpy(column->fallback, &(double){3}, 8);
        assert_int_equal(he_mesh_add_column(m, column, NULL), HE_OK);
    }
    assert_int_equal(he_reserve(m, (he_reservation){.attributes = 12}, NULL), HE_OK);
    for (size_t slot = 0; slot < 3; slot++) {
        he_set_attribute(m, slot, 0, &(double){10});
        he_set_attribute(m, slot, 1, &(double){20});
    }
    he_attributes_between(m, HE_VERTEX, 2, 0, 1, 0.25);
    uint32_t many[200];
    for (uint32_t i = 0; i < 200; i++) {
        many[i] = i % 4 == 0 ? 1 : 0;
    }
    he_attributes_mean(m, HE_VERTEX, 3, many, 200);
    for (size_t slot = 0; slot < 3; slot++) {
        double value;
        memcpy(&value, he_column_value(m->c.columns[slot], 2), 8);
        assert_true(value == rows[slot].expected);
        memcpy(&value, he_column_value(m->c.columns[slot], 3), 8);
        double mean = slot == 0 ? 20 : rows[slot].expected;
        assert_true(value > mean - 1e-9 && value < mean + 1e-9);
    }
    he_mesh_free(m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(undo_and_redo_restore_the_mesh_but_ids_stay_issued),
        cmocka_unit_test(a_rollback_takes_issued_ids_back),
        cmocka_unit_test(changes_that_cancel_out_are_not_reported),
        cmocka_unit_test(many_created_rows_are_listed_in_order_and_not_as_modified),
        cmocka_unit_test(undo_and_redo_restore_added_and_dropped_columns),
        cmocka_unit_test(values_of_no_vertex_edge_or_face_count_as_changes),
        cmocka_unit_test(changes_of_a_dropped_column_are_not_those_of_its_successor),
        cmocka_unit_test(a_reservation_has_room_for_the_widest_value),
        cmocka_unit_test(compact_renumbers_elements_and_can_be_undone),
        cmocka_unit_test(edits_without_memory_are_rolled_back_and_copies_not_made),
        cmocka_unit_test(carried_values_follow_the_rule_of_their_column),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
