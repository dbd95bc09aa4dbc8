/* Tests of each repair by itself; then tests of failing allocations, of cancelling, and of soups
 * that cannot be repaired. */
#include "repair_fixture.h"
#include "tests/failing.h"

/* --- one repair at a time --- */

#define CUBE "0321,4567,0154,1265,2376,3047"

static void the_set_that_is_named_lets_each_refused_soup_pass(void **state)
{
    (void)state;
    static const struct {
        const char *faces;
        he_status reason;
        unsigned which;
        unsigned v, e, f;
    } rows[] = {
        /* an edge with three faces, and an edge with four faces, where two tetrahedra share a
         * face */
        {"012,103,014", HE_NONMANIFOLD_EDGE, SPLIT, 7, 8, 3},
        {"021,032,013,123,132,124,234,314", HE_NONMANIFOLD_EDGE, SPLIT, 8, 12, 8},
        /* faces with a repeated corner, faces with too few corners, and a soup without any valid
         * face */
        {"012,0230", HE_REPEATED_CORNER, DEGENERATE, 4, 5, 2},
        {"012,23", HE_TOO_FEW_CORNERS, DEGENERATE, 4, 3, 1},
        {"011,22", HE_REPEATED_CORNER, DEGENERATE, 3, 0, 0},
        /* neighbouring faces whose orientations do not agree */
        {"012,123,032", HE_ORIENTATION, ORIENT, 4, 6, 3},
        {CUBE ",0", HE_TOO_FEW_CORNERS, DEGENERATE, 8, 12, 6},
        {"0321,4567,0154,1562,2376,3047", HE_ORIENTATION, ORIENT, 8, 12, 6},
        /* a vertex with a closed fan of faces and a second fan, which is closed in one soup and
         * open in the other */
        {"021,032,013,123,354,365,346,456", HE_CLOSED_FAN, SPLIT, 8, 12, 8},
        {"021,032,013,123,345", HE_CLOSED_FAN, SPLIT, 7, 9, 5},
        /* a face that occurs twice, in equal or in opposite orientation; the face is alone or
         * belongs to a closed surface */
        {"012,012", HE_ORIENTATION, DUPLICATES, 3, 3, 1},
        {"021,032,013,123,231", HE_NONMANIFOLD_EDGE, DUPLICATES, 4, 6, 4},
        {"021,032,013,123,132", HE_NONMANIFOLD_EDGE, DUPLICATES, 4, 6, 4},
        /* In the first soup a face occurs twice, and another edge has three faces. In the second
         * soup an edge has three faces, of which one occurs twice. */
        {"021,032,013,123,231,456,547,458", HE_NONMANIFOLD_EDGE, DUPLICATES | SPLIT, 11, 14, 7},
        {"012,103,014,012", HE_NONMANIFOLD_EDGE, DUPLICATES | SPLIT, 7, 8, 3},
        /* a Moebius band of five triangles */
        {"012,123,234,340,401", HE_ORIENTATION, ORIENT | SPLIT, 7, 11, 5},
        /* several defects at once */
        {"012,103,014,11,3345", HE_REPEATED_CORNER, DEGENERATE | SPLIT, 10, 11, 4},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        he_soup soup, copy;
        he_mesh *mesh = NULL;
        he_report report;
        unsigned which = 0;
        fixture_soup(&soup, rows[i].faces);
        repair_copy_soup(&soup, &copy);
        he_status status = he_build(&copy, HE_BUILD_TAKE, &mesh, &report, NULL);
        bool listed = false;
        for (size_t k = 0; k < report.total; k++) {
            listed = listed || report.defects[k].reason == rows[i].reason;
        }
        assert_int_not_equal(status, HE_OK);
        assert_true(listed);
        assert_int_equal(he_repair_advise(&copy, 0, &which, NULL), HE_OK);
        if (which != rows[i].which) {
            fail_msg("%s: %x", rows[i].faces, which);
        }
        he_repaired done = {0};
        he_repair_plan plan = repair_plan_of(which);
        mesh = repair_mend(&soup, &plan, &done);
        fixture_counts(mesh, rows[i].v, rows[i].e, rows[i].f);
        he_mesh_free(mesh);
        he_repaired_clear(&done);
        he_soup_clear(&soup);
        he_soup_clear(&copy);
    }
}

static void nothing_is_done_to_what_is_good(void **state)
{
    (void)state;
    he_repaired done = {0};
    he_mesh *mesh = repair_mend_faces(CUBE, ALL, &done);
    fixture_counts(mesh, 8, 12, 6);
    assert_false(he_repaired_soup(&done));
    for (he_repair r = HE_REPAIR_WELD; r < HE_REPAIR_COUNT; r++) {
        assert_int_equal(repair_account_of(&done, r)->count, 0);
        assert_int_equal(repair_account_of(&done, r)->named, 0);
    }
    he_mesh_free(mesh);
    he_repaired_clear(&done);
}

static void no_repair_mends_an_index_that_names_nothing(void **state)
{
    (void)state;
    he_soup soup;
    unsigned which = ALL;
    he_mesh *mesh = NULL;
    he_repaired done = {0};
    he_repair_plan plan = repair_plan_of(ALL);
    fixture_soup(&soup, "012,11");
    soup.corners[1] = 3;
    assert_int_equal(he_repair_soup(&soup, &plan, &done, NULL), HE_OK);
    assert_false(he_repaired_soup(&done));
    assert_int_not_equal(he_build(&soup, 0, &mesh, NULL, NULL), HE_OK);
    assert_int_equal(he_repair_advise(&soup, ALL, &which, NULL), HE_OK);
    assert_int_equal(which, 0);
    he_soup_clear(&soup);
}

static void a_moebius_band_is_not_orientable(void **state)
{
    (void)state;
    he_soup soup;
    he_error err = {0};
    he_repaired done = {0};
    he_repair_plan plan = repair_plan_of(DEGENERATE | ORIENT);
    unsigned which;
    fixture_soup(&soup, "01,012,123,234,340,401");
    assert_int_equal(he_repair_soup(&soup, &plan, &done, &err), HE_NOT_ORIENTABLE);
    static const uint32_t left[] = {0, 1, 2, 1, 2, 3, 2, 3, 4, 3, 4, 0, 4, 0, 1};
    assert_int_equal(soup.face_count, 5); /* only drop_degenerate changed the faces */
    assert_int_equal(soup.corner_count, sizeof left / sizeof *left);
    assert_memory_equal(soup.corners, left, sizeof left);
    assert_int_equal(err.kind, HE_FACE);
    assert_in_range(err.id, 1, 5); /* the error names a face by its number in the input */
    assert_int_equal(he_repair_advise(&soup, plan.which, &which, NULL), HE_OK);
    assert_int_equal(which, DEGENERATE | ORIENT | SPLIT);
    he_repaired_clear(&done);
    he_soup_clear(&soup);

    done = (he_repaired){0};
    he_mesh *mesh = repair_mend_faces("01,012,123,234,340,401", which, &done);
    assert_int_equal(repair_account_of(&done, HE_REPAIR_ORIENT)->left, 1);
    assert_int_equal(repair_account_of(&done, HE_REPAIR_SPLIT)->count, 2);
    he_mesh_free(mesh);
    he_repaired_clear(&done);
}

static void the_larger_part_keeps_its_direction(void **state)
{
    (void)state;
    he_repaired done = {0};
    he_mesh *mesh = repair_mend_faces("0123,4567,0154,1265,2376,3047", ORIENT, &done);
    assert_int_equal(repair_account_of(&done, HE_REPAIR_ORIENT)->count, 1);
    assert_int_equal(repair_account_of(&done, HE_REPAIR_ORIENT)->parts, 1);
    assert_int_equal(repair_account_of(&done, HE_REPAIR_ORIENT)->pairs[0].a, 0);
    /* The face was reversed, but its first corner must still be the first. */
    he_halfedge h = he_face_halfedge(mesh, (he_face){0});
    assert_int_equal(he_origin(mesh, h).i, 0);
    assert_int_equal(he_target(mesh, h).i, 3);
    he_mesh_free(mesh);
    he_repaired_clear(&done);
}

static void copies_know_their_parents(void **state)
{
    (void)state;
    he_repaired done = {0};
    he_mesh *mesh = repair_mend_faces("021,032,013,123,354,365,346,456", SPLIT, &done);
    const he_repair_account *split = repair_account_of(&done, HE_REPAIR_SPLIT);
    assert_int_equal(split->count, 1);
    assert_int_equal(split->parts, 1);
    assert_int_equal(split->named, 1);
    assert_int_equal(split->pairs[0].a, 7);
    assert_int_equal(split->pairs[0].b, 3);
    he_mesh_free(mesh);
    he_repaired_clear(&done);
}

static void bow_ties_of_open_fans_are_split_too(void **state)
{
    (void)state;
    he_repaired done = {0};
    he_mesh *mesh = repair_mend_faces("012,034,056", SPLIT, &done);
    assert_int_equal(repair_account_of(&done, HE_REPAIR_SPLIT)->count, 2);
    assert_int_equal(repair_account_of(&done, HE_REPAIR_SPLIT)->parts, 1);
    fixture_counts(mesh, 9, 9, 3);
    he_mesh_free(mesh);
    he_repaired_clear(&done);
}

static void small_holes_are_filled(void **state)
{
    (void)state;
    he_repaired done = {0};
    /* The mesh is a cube without its three faces at vertex 7. */
    he_mesh *mesh = repair_mend_faces("0321,0154,1265,2376,3047", FILL, &done);
    fixture_counts(mesh, 8, 12, 6);
    assert_int_equal(repair_account_of(&done, HE_REPAIR_FILL)->count, 1);
    assert_int_equal(repair_account_of(&done, HE_REPAIR_FILL)->pairs[0].a, 5);
    assert_int_equal(repair_account_of(&done, HE_REPAIR_FILL)->pairs[0].b, 4);
    he_mesh_free(mesh);
    he_repaired_clear(&done);

    /* The outline of a single face must not be filled, and a hole with more sides than allowed must
     * not be filled. */
    done = (he_repaired){0};
    mesh = repair_mend_faces("0123", FILL, &done);
    fixture_counts(mesh, 4, 4, 1);
    assert_int_equal(repair_account_of(&done, HE_REPAIR_FILL)->left, 1);
    he_mesh_free(mesh);
    he_soup soup;
    he_repair_plan plan = {.which = FILL, .hole_edges = 3};
    done = (he_repaired){0};
    fixture_soup(&soup, "0321,0154,1265,2376,3047");
    mesh = repair_mend(&soup, &plan, &done);
    fixture_counts(mesh, 8, 12, 5);
    assert_int_equal(repair_account_of(&done, HE_REPAIR_FILL)->left, 1);
    he_mesh_free(mesh);
    he_soup_clear(&soup);
}

/* --- failing allocations, cancelling, and soups that cannot be repaired --- */

static he_status mend_or_fail(const he_soup *soup, unsigned which, he_progress *progress)
{
    he_soup copy;
    he_repaired done = {0};
    he_mesh *mesh = NULL;
    he_error err = {0};
    he_repair_plan plan = repair_plan_of(which);
    failing_pause();
    repair_copy_soup(soup, &copy);
    copy.limits.progress = progress;
    failing_resume();
    he_status status = he_repair_soup(&copy, &plan, &done, &err);
    if (status == HE_OK) {
        status = he_build(&copy, 0, &mesh, NULL, &err);
    }
    if (status == HE_OK) {
        he_mesh_set_progress(mesh, progress);
        status = he_repair_mesh(mesh, &plan, &done, &err);
    }
    assert_int_equal(err.status, status);
    he_mesh_free(mesh);
    he_repaired_clear(&done);
    he_soup_clear(&copy);
    return status;
}

#define BROKEN "0,012,103,014,033,015,567,576,0321,785,012"

static void every_failing_allocation_is_survived(void **state)
{
    (void)state;
    he_soup soup;
    fixture_soup(&soup, BROKEN);
    soup.positions[8] = soup.positions[0];
    for (unsigned which = 0; which <= ALL; which++) {
        if ((which & (DEGENERATE | SPLIT)) != (DEGENERATE | SPLIT)) {
            continue;
        }
        failing f = {.what = "repair"};
        while (failing_next(&f)) {
            failing_status(&f, mend_or_fail(&soup, which, NULL));
        }
    }
    failing f = {.what = "advice"};
    while (failing_next(&f)) {
        failing_pause();
        he_soup copy;
        unsigned which;
        repair_copy_soup(&soup, &copy);
        failing_resume();
        failing_status(&f, he_repair_advise(&copy, 0, &which, NULL));
        he_soup_clear(&copy);
    }
    he_soup_clear(&soup);
}

typedef struct teller {
    int left;
    double done;
} teller;

static bool tell(void *context, const char *phase, double done)
{
    teller *t = context;
    assert_non_null(phase);
    assert_true(done >= t->done && done <= 1);
    t->done = done;
    return --t->left > 0;
}

static void it_can_be_given_up_at_any_time(void **state)
{
    (void)state;
    he_soup soup;
    fixture_soup(&soup, BROKEN);
    he_status status = HE_CANCELLED;
    for (int n = 1; status != HE_OK; n++) {
        teller t = {.left = n};
        he_progress progress;
        he_progress_init(&progress, tell, &t);
        status = mend_or_fail(&soup, ALL, &progress);
        assert_true(status == HE_OK || status == HE_CANCELLED);
    }
    he_soup_clear(&soup);
}

static void copies_keep_within_the_limits(void **state)
{
    (void)state;
    he_soup soup;
    he_error err = {0};
    he_repaired done = {0};
    he_repair_plan plan = repair_plan_of(SPLIT);
    fixture_soup(&soup, "012,034,056");
    soup.limits.vertices = 8;
    assert_int_equal(he_repair_soup(&soup, &plan, &done, &err), HE_LIMIT);
    he_repaired_clear(&done);
    he_soup_clear(&soup);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_set_that_is_named_lets_each_refused_soup_pass),
        cmocka_unit_test(nothing_is_done_to_what_is_good),
        cmocka_unit_test(no_repair_mends_an_index_that_names_nothing),
        cmocka_unit_test(a_moebius_band_is_not_orientable),
        cmocka_unit_test(the_larger_part_keeps_its_direction),
        cmocka_unit_test(copies_know_their_parents),
        cmocka_unit_test(bow_ties_of_open_fans_are_split_too),
        cmocka_unit_test(small_holes_are_filled),
        cmocka_unit_test(every_failing_allocation_is_survived),
        cmocka_unit_test(it_can_be_given_up_at_any_time),
        cmocka_unit_test(copies_keep_within_the_limits),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
