/* Tests of the repair drop_degenerate: which part of a face it keeps if the face uses a vertex more
 * than once. */
#include "repair_fixture.h"

#include <math.h>

/* Writes the faces of a soup as text, for example "012,230" for two triangles. */
static void faces_of(const he_soup *soup, char *text)
{
    for (size_t f = 0; f < soup->face_count; f++) {
        *text = ',';
        text += f > 0;
        for (uint32_t c = soup->starts[f]; c < he_soup_end(soup, f); c++) {
            *text++ = (char)('0' + soup->corners[c]);
        }
    }
    *text = '\0';
}

static void a_face_keeps_what_has_an_area(void **state)
{
    (void)state;
    static const struct {
        const char *before, *after;
        unsigned gone, mended;
    } rows[] = {
        /* faces that use a vertex twice in succession, at the beginning, in the middle or at the
         * end of the face */
        {"0122", "012", 0, 1},
        {"0012", "012", 0, 1},
        {"0120", "012", 0, 1},
        {"00122", "012", 0, 1},
        {"0000123", "0123", 0, 1},
        /* Faces with spikes (paths that go out and straight back), at the end, at the beginning, or
         * all around the face. */
        {"01232", "012", 0, 1},
        {"012343", "0123", 0, 1},
        {"20123", "201", 0, 1},
        {"0123432", "012", 0, 1},
        {"30123", "3012", 0, 1},
        {"3012333", "3012", 0, 1},
        /* faces that must be dropped, because fewer than three corners are left */
        {"011", "", 1, 0},
        {"0101", "", 1, 0},
        {"01210", "", 1, 0},
        {"0", "", 1, 0},
        {"01", "", 1, 0},
        /* faces whose corners go around twice; such a face has no outline and must be dropped */
        {"012012", "", 1, 0},
        {"01230123", "", 1, 0},
        /* a face that must be mended between other faces; all faces must keep their order */
        {"045,0122,11,123", "045,012,123", 1, 1},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        he_soup soup, copy;
        he_repaired done = {0};
        he_repair_plan plan = repair_plan_of(DEGENERATE);
        char text[80];
        fixture_soup(&soup, rows[i].before);
        repair_copy_soup(&soup, &copy);
        assert_int_equal(he_repair_soup(&copy, &plan, &done, NULL), HE_OK);
        repair_expect_carried(&soup, &copy, &done, false);
        faces_of(&copy, text);
        if (strcmp(text, rows[i].after) != 0) {
            fail_msg("%s becomes %s, not %s", rows[i].before, text, rows[i].after);
        }
        const he_repair_account *a = repair_account_of(&done, HE_REPAIR_DROP_DEGENERATE);
        assert_int_equal(a->count, rows[i].gone);
        assert_int_equal(a->parts, rows[i].mended);
        he_repaired_clear(&done);
        he_soup_clear(&copy);
        he_soup_clear(&soup);
    }
}

/* Returns twice the area of a triangle in the plane z = 0, positive if it is counter-clockwise. */
static double twice_area(const he_soup *soup, size_t f)
{
    const uint32_t *v = soup->corners + soup->starts[f];
    he_vec3 a = soup->positions[v[0]], b = soup->positions[v[1]], c = soup->positions[v[2]];
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/* Makes one face that covers the ring between two regular polygons of `sides` corners. The face's
 * outline goes around the outer polygon, along an edge to the inner polygon, around the inner
 * polygon in the opposite direction, and back along the same edge. */
static void make_keyhole(he_soup *soup, uint32_t sides)
{
    const double turn = 6.283185307179586 / sides;
    he_soup_init(soup, NULL);
    for (uint32_t i = 0; i < 2 * sides; i++) {
        double radius = i < sides ? 2 : 1;
        he_vec3 p = {radius * cos(i * turn), radius * sin(i * turn), 0};
        assert_int_equal(he_soup_add_vertex(soup, p, NULL), HE_OK);
    }
    assert_int_equal(he_soup_begin_face(soup, NULL), HE_OK);
    for (uint32_t i = 0; i <= sides; i++) {
        assert_int_equal(he_soup_add_corner(soup, i % sides, NULL), HE_OK);
    }
    for (uint32_t i = 0; i <= sides; i++) {
        assert_int_equal(he_soup_add_corner(soup, sides + (sides - i) % sides, NULL), HE_OK);
    }
}

static void a_keyhole_is_cut_into_triangles(void **state)
{
    (void)state;
    static const uint32_t sides[] = {3, 4, 20, 31, 32, 500};
    for (size_t i = 0; i < sizeof sides / sizeof *sides; i++) {
        he_soup soup, copy;
        he_repaired done = {0};
        he_repair_plan plan = repair_plan_of(DEGENERATE);
        uint32_t n = sides[i];
        make_keyhole(&soup, n);
        repair_copy_soup(&soup, &copy);
        assert_int_equal(he_repair_soup(&copy, &plan, &done, NULL), HE_OK);
        repair_expect_carried(&soup, &copy, &done, false);
        assert_int_equal(copy.face_count, 2 * n);
        double area = 0;
        for (size_t f = 0; f < copy.face_count; f++) {
            assert_true(twice_area(&copy, f) > 0);
            area += twice_area(&copy, f) / 2;
        }
        double ring = 3 * n / 2.0 * sin(6.283185307179586 / n);
        assert_true(fabs(area - ring) < 1e-9 * ring);
        he_repaired_clear(&done);
        he_soup_clear(&copy);
        he_mesh *mesh = repair_mend(&soup, &plan, &done);
        fixture_counts(mesh, 2 * n, 4 * n, 2 * n); /* the Euler number of a ring is 0 */
        assert_int_equal(he_mesh_boundary_halfedges(mesh), 2 * n);
        he_mesh_free(mesh);
        he_repaired_clear(&done);
        he_soup_clear(&soup);
    }
}

/* Each tested face consists of two loops that touch at a vertex. The loops are side by side, or one
 * is inside the other. */
static void a_face_that_touches_itself_is_cut_where_it_is(void **state)
{
    (void)state;
    static const he_vec3 points[] = {{0, 0, 0},  {4, 0, 0}, {4, 4, 0}, {0, 4, 0},
                                     {-2, 0, 0}, {1, 2, 0}, {2, 1, 0}};
    static const struct {
        uint32_t corners[8], count;
        double twice;
        size_t faces;
    } rows[] = {
        {{0, 1, 2, 0, 3, 4}, 6, 16 + 8, 2},
        {{0, 1, 2, 3, 0, 5, 6}, 7, 32 - 3, 5},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        he_soup soup, copy;
        he_repaired done = {0};
        he_repair_plan plan = repair_plan_of(DEGENERATE);
        he_soup_init(&soup, NULL);
        for (size_t v = 0; v < sizeof points / sizeof *points; v++) {
            assert_int_equal(he_soup_add_vertex(&soup, points[v], NULL), HE_OK);
        }
        assert_int_equal(he_soup_add_face(&soup, rows[i].corners, rows[i].count, NULL), HE_OK);
        repair_copy_soup(&soup, &copy);
        assert_int_equal(he_repair_soup(&copy, &plan, &done, NULL), HE_OK);
        double twice = 0;
        for (size_t f = 0; f < copy.face_count; f++) {
            assert_true(twice_area(&copy, f) > 0);
            twice += twice_area(&copy, f);
        }
        assert_int_equal(copy.face_count, rows[i].faces);
        assert_true(twice == rows[i].twice);
        he_repaired_clear(&done);
        he_soup_clear(&copy);
        he_soup_clear(&soup);
    }
}

/* A face that uses a vertex very often must be dropped: dividing the face into loops would take too
 * long. */
static void a_face_that_repeats_its_corners_is_left_out(void **state)
{
    (void)state;
    he_soup soup;
    he_repaired done = {0};
    he_repair_plan plan = repair_plan_of(DEGENERATE);
    fixture_soup(&soup, "0123");
    assert_int_equal(he_soup_begin_face(&soup, NULL), HE_OK);
    for (uint32_t i = 0; i < 400000; i++) {
        assert_int_equal(he_soup_add_corner(&soup, i % 4, NULL), HE_OK);
    }
    he_mesh *mesh = repair_mend(&soup, &plan, &done);
    fixture_counts(mesh, 4, 4, 1);
    assert_int_equal(repair_account_of(&done, HE_REPAIR_DROP_DEGENERATE)->pairs[0].a, 1);
    assert_int_equal(repair_account_of(&done, HE_REPAIR_DROP_DEGENERATE)->pairs[0].b, 0);
    he_mesh_free(mesh);
    he_repaired_clear(&done);
    he_soup_clear(&soup);
}

static void cuts_keep_within_the_limits(void **state)
{
    (void)state;
    static const struct {
        he_limits limits;
        he_status status;
    } rows[] = {
        {{.faces = 8}, HE_OK},       {{.faces = 7}, HE_LIMIT},   {{.corners = 24}, HE_OK},
        {{.corners = 23}, HE_LIMIT}, {{.bytes = 100}, HE_LIMIT},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        he_soup soup;
        he_error err = {0};
        he_repaired done = {0};
        he_repair_plan plan = repair_plan_of(DEGENERATE);
        make_keyhole(&soup, 4);
        soup.limits = rows[i].limits;
        assert_int_equal(he_repair_soup(&soup, &plan, &done, &err), rows[i].status);
        he_repaired_clear(&done);
        he_soup_clear(&soup);
    }
}

static void every_failing_allocation_is_survived(void **state)
{
    (void)state;
    he_soup soup;
    make_keyhole(&soup, 40);
    static const uint32_t quad[] = {0, 1, 2, 2}, none[] = {5, 5};
    assert_int_equal(he_soup_add_face(&soup, quad, 4, NULL), HE_OK);
    assert_int_equal(he_soup_add_face(&soup, none, 2, NULL), HE_OK);
    repair_expect_failures_survived(&soup, DEGENERATE, 20);
    he_soup_clear(&soup);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_face_keeps_what_has_an_area),
        cmocka_unit_test(a_keyhole_is_cut_into_triangles),
        cmocka_unit_test(a_face_that_touches_itself_is_cut_where_it_is),
        cmocka_unit_test(a_face_that_repeats_its_corners_is_left_out),
        cmocka_unit_test(cuts_keep_within_the_limits),
        cmocka_unit_test(every_failing_allocation_is_survived),
    };
    return cmocka_run_group_tests_name("repair_degenerate", tests, NULL, NULL);
}
