#include "unit/repair_fixture.h"

he_repair_plan repair_plan_of(unsigned which)
{
    return (he_repair_plan){.which = which, .hole_edges = 8};
}

void repair_copy_soup(const he_soup *from, he_soup *to)
{
    static const he_kind domains[] = {HE_VERTEX, HE_FACE, HE_HALFEDGE};
    const size_t rows[] = {from->vertex_count, from->face_count, from->corner_count};
    he_soup_init(to, NULL);
    for (size_t v = 0; v < from->vertex_count; v++) {
        assert_int_equal(he_soup_add_vertex(to, from->positions[v], NULL), HE_OK);
    }
    for (size_t f = 0; f < from->face_count; f++) {
        uint32_t begin = from->starts[f], end = he_soup_end(from, f);
        assert_int_equal(he_soup_add_face(to, from->corners + begin, end - begin, NULL), HE_OK);
    }
    static const char *const names[] = {"vertex", "face", "corner"};
    for (size_t i = 0; i < 3; i++) {
        he_column *column;
        assert_int_equal(
            he_soup_column(to, &(he_column_schema){names[i], domains[i], HE_UINT32, 1, HE_COPY},
                           &column, NULL),
            HE_OK);
        assert_int_equal(he_column_extend(column, rows[i], NULL), HE_OK);
        for (uint32_t row = 0; row < rows[i]; row++) {
            memcpy(he_column_row(column, row), &row, sizeof row);
        }
    }
}

static uint32_t value(const he_soup *soup, size_t column, size_t row)
{
    uint32_t out;
    memcpy(&out, he_column_value(soup->columns[column], row), sizeof out);
    return out;
}

const he_repair_account *repair_account_of(const he_repaired *done, he_repair repair)
{
    return &done->accounts[repair];
}

void repair_expect_carried(const he_soup *before, const he_soup *after, const he_repaired *done,
                           bool welded)
{
    bool moved = after->columns[0]->domain == HE_HALFEDGE;
    assert_true(welded || !moved);
    for (uint32_t v = 0; v < after->vertex_count; v++) {
        uint32_t from = done->vertex_from == NULL ? v : done->vertex_from[v];
        if (!moved) {
            assert_int_equal(value(after, 0, v), from);
        }
        assert_memory_equal(&after->positions[v], &before->positions[from], sizeof(he_vec3));
    }
    for (uint32_t f = 0; f < after->face_count; f++) {
        uint32_t from = done->face_from == NULL ? f : done->face_from[f];
        assert_int_equal(value(after, 1, f), from);
        uint32_t degree = he_soup_end(after, f) - after->starts[f];
        uint32_t read = he_soup_end(before, from) - before->starts[from];
        if (degree == read) {
            assert_int_equal(value(after, 2, after->starts[f]), before->starts[from]);
            /* the face has lost corners, so the repair of degenerate faces must have changed it */
        } else {
            assert_true(degree < read &&
                        repair_account_of(done, HE_REPAIR_DROP_DEGENERATE)->parts > 0);
        }
        for (uint32_t c = after->starts[f]; c < he_soup_end(after, f); c++) {
            uint32_t corner = value(after, 2, c);
            uint32_t v = after->corners[c];
            assert_int_equal(he_soup_face_of(before, corner), from);
            if (moved) {
                assert_int_equal(value(after, 0, c), before->corners[corner]);
            } else if (!welded) {
                assert_int_equal(before->corners[corner],
                                 done->vertex_from == NULL ? v : done->vertex_from[v]);
            }
        }
    }
}

void repair_expect_failures_survived(const he_soup *soup, unsigned which, long least)
{
    /* a repair may succeed although an allocation fails, if that allocation was only meant to
     * shrink a block */
    failing f = {.may_succeed = true};
    while (failing_next(&f)) {
        failing_pause();
        he_soup copy;
        he_repaired done = {0};
        he_error err = {0};
        he_repair_plan plan = repair_plan_of(which);
        repair_copy_soup(soup, &copy);
        failing_resume();
        he_status status = he_repair_soup(&copy, &plan, &done, &err);
        assert_true(!failing_status(&f, status) || f.n > least);
        assert_int_equal(err.status, status);
        he_repaired_clear(&done);
        he_soup_clear(&copy);
    }
}

he_mesh *repair_mend(const he_soup *soup, const he_repair_plan *plan, he_repaired *done)
{
    he_soup copy;
    he_mesh *mesh = NULL;
    he_error err = {0};
    repair_copy_soup(soup, &copy);
    if (he_repair_soup(&copy, plan, done, &err) != HE_OK) {
        fail_msg("%s", err.text);
    }
    repair_expect_carried(soup, &copy, done, (plan->which & WELD) != 0);
    if (he_build(&copy, HE_BUILD_TAKE, &mesh, NULL, &err) != HE_OK) {
        fail_msg("%s", err.text);
    }
    if (he_repair_mesh(mesh, plan, done, &err) != HE_OK) {
        fail_msg("%s", err.text);
    }
    fixture_check(mesh);
    he_soup_clear(&copy);
    return mesh;
}

he_mesh *repair_mend_faces(const char *faces, unsigned which, he_repaired *done)
{
    he_soup soup;
    he_repair_plan plan = repair_plan_of(which);
    fixture_soup(&soup, faces);
    he_mesh *mesh = repair_mend(&soup, &plan, done);
    he_soup_clear(&soup);
    return mesh;
}
