/* Cutting a mesh by a plane: the parts above and below the plane together must be the whole mesh,
 * and caps must close the cuts. */
#include "edit_script.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "algo/shape.h"
#include "edit/plane/plane_cut.h"
#include "edit/whole/triangulate.h"
#include "geometry/geometry.h"
#include "geometry/vec3.h"
#include "mesh/walk.h"
#include "model/random.h"

static const he_vec3 ORIGIN = {0, 0, 0}, UP = {0, 0, 1};

/* A stair with two steps. It is 2 wide, 2 high at the back and 1 high in front. */
#define STAIRS "0176,1287,2398,34a9,45ba,506b,543210,6789ab"
static const he_vec3 STAIRS_LIE[] = {{0, 0, 0}, {0, 0, 1}, {1, 0, 1}, {1, 0, 2},
                                     {2, 0, 2}, {2, 0, 0}, {0, 1, 0}, {0, 1, 1},
                                     {1, 1, 1}, {1, 1, 2}, {2, 1, 2}, {2, 1, 0}};

static double volume(const he_mesh *m)
{
    he_measures measures;
    assert_int_equal(he_mesh_measure(m, &measures, NULL), HE_OK);
    assert_true(measures.has_volume);
    return measures.volume;
}

/* Makes a mesh of triangles of the closed primitive shape `name`. */
static he_mesh *shape(const char *name)
{
    he_soup soup;
    he_mesh *m = NULL;
    he_ids faces = {0};
    double args[HE_SHAPE_PARAMS];
    const he_shape *row = he_shape_find(name, strlen(name));
    assert_non_null(row);
    he_shape_defaults(row, args);
    assert_int_equal(he_shape_make(row, args, NULL, &soup, NULL), HE_OK);
    assert_int_equal(he_build(&soup, HE_BUILD_TAKE, &m, NULL, NULL), HE_OK);
    he_soup_clear(&soup);
    for (uint32_t f = 0; f < he_mesh_issued(m, HE_FACE); f++) {
        assert_int_equal(he_ids_add(&faces, f, NULL), HE_OK);
    }
    assert_int_equal(he_face_triangulate(m, faces.ids, faces.count, NULL, NULL, NULL, NULL), HE_OK);
    he_ids_clear(&faces);
    return m;
}

static he_mesh *part_of(const he_mesh *m, he_vec3 at, he_vec3 normal, he_cut_side keep, bool cap,
                        he_cut_parts *out)
{
    he_mesh *part = copy_of(m);
    he_error err = {.status = HE_OK};
    if (he_plane_cut(part, &(he_plane){at, normal, NULL}, keep, cap, out, &err) != HE_OK) {
        fail_msg("%s: %s", he_status_slug(err.status), err.text);
    }
    assert_valid(part);
    return part;
}

/* Cuts a closed mesh into the parts above and below a plane, and checks both. Returns the number of
 * caps (faces that close the cut), which must be equal for both parts. */
static size_t check_halves(const he_mesh *m, he_vec3 at, he_vec3 normal)
{
    double whole = volume(m), around = area_of(m), volumes = 0, areas = 0;
    size_t caps[2];
    uint32_t kept = 0, deleted = 0;
    for (int side = 0; side < 2; side++) {
        he_cut_parts parts;
        he_cut_side keep = side == 0 ? HE_CUT_ABOVE : HE_CUT_BELOW;
        he_mesh *part = part_of(m, at, normal, keep, false, &parts);
        areas += area_of(part);
        kept += he_mesh_faces(part);
        deleted += parts.faces_deleted;
        assert_int_equal(parts.caps.count, 0);
        he_cut_parts_clear(&parts);
        he_mesh_free(part);

        part = part_of(m, at, normal, keep, true, &parts);
        volumes += volume(part);
        caps[side] = parts.caps.count;
        for (size_t i = 0; i < parts.caps.count; i++) {
            he_halfedge first = he_face_halfedge(part, (he_face){parts.caps.ids[i]}), h = first;
            do {
                he_vec3 way = he_vec3_sub(he_position(part, he_origin(part, h)), at);
                assert_true(fabs(he_vec3_dot(way, normal)) < 1e-8 * he_vec3_length(normal));
                h = he_next(part, h);
            } while (h.i != first.i);
        }
        he_cut_parts_clear(&parts);
        he_mesh_free(part);
    }
    assert_true(fabs(volumes - whole) < 1e-9 * whole);
    assert_true(fabs(areas - around) < 1e-9 * around);
    assert_int_equal(kept, deleted);
    assert_int_equal(caps[0], caps[1]);
    return caps[0];
}

static void the_halves_of_a_cut_make_up_the_whole(void **state)
{
    (void)state;
    static const char *const names[] = {"cube", "dodecahedron", "icosahedron", "icosphere",
                                        "torus"};
    md_random r = {1};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        he_mesh *m = shape(names[i]);
        bool torus = i == 4;
        assert_int_equal(check_halves(m, ORIGIN, UP), torus ? 2 : 1);
        assert_int_equal(check_halves(m, ORIGIN, (he_vec3){1e-100, 0, 0}), torus ? 2 : 1);
        for (unsigned k = 0; k < 20; k++) {
            he_vec3 normal = {md_unit(&r) - 0.5, md_unit(&r) - 0.5, md_unit(&r) - 0.5};
            he_vec3 at = {md_unit(&r) * 0.2, md_unit(&r) * 0.2, md_unit(&r) * 0.2};
            size_t caps = check_halves(m, at, normal);
            assert_true(torus ? caps <= 2 : caps == 1);
        }
        he_mesh_free(m);
    }
}

/* A face that lies in the cutting plane must go to the part of the mesh, above or below the plane,
 * to whose surface it belongs. */
static void a_face_in_the_plane_goes_to_the_part_it_bounds(void **state)
{
    (void)state;
    he_mesh *m = shape("cube");
    he_vec3 top = {0, 0, 0};
    for (uint32_t v = 0; v < he_mesh_issued(m, HE_VERTEX); v++) {
        top.z = fmax(top.z, he_position(m, (he_vertex){v}).z);
    }
    he_mesh *part = part_of(m, top, UP, HE_CUT_BELOW, true, NULL);
    assert_equal(part, m);
    he_mesh_free(part);
    part = part_of(m, top, UP, HE_CUT_ABOVE, true, NULL);
    assert_counts(part, 0, 0, 0);
    he_mesh_free(part);
    part = part_of(m, (he_vec3){0, 0, -top.z}, UP, HE_CUT_ABOVE, true, NULL);
    assert_equal(part, m);
    he_mesh_free(part);
    he_mesh_free(m);

    m = script_mesh(STAIRS, STAIRS_LIE);
    assert_true(fabs(volume(m) - 3) < 1e-12);
    assert_int_equal(check_halves(m, (he_vec3){0, 0, 1}, UP), 1);
    he_cut_parts parts;
    part = part_of(m, (he_vec3){0, 0, 1}, UP, HE_CUT_ABOVE, true, &parts);
    assert_counts(part, 8, 12, 6);
    assert_true(fabs(volume(part) - 1) < 1e-12);
    assert_int_equal(parts.edges_split, 2);
    assert_int_equal(parts.faces_split, 3);
    assert_int_equal(parts.faces_deleted, 6);
    assert_int_equal(parts.caps.count, 1);
    he_cut_parts_clear(&parts);
    he_mesh_free(part);
    he_mesh_free(m);
}

static void a_hole_off_the_plane_stays_and_one_across_it_forbids_caps(void **state)
{
    (void)state;
    /* A plane cuts the mesh, but does not meet its hole: the hole must stay. */
    he_mesh *m = shape("icosphere");
    script_prepare(m, "face_delete face=0");
    he_vec3 hole = {0, 0, 0};
    for (uint32_t v = 0; v < he_mesh_issued(m, HE_VERTEX); v++) {
        if (he_is_boundary_vertex(m, (he_vertex){v})) {
            hole = he_vec3_add(hole, he_position(m, (he_vertex){v}));
        }
    }
    he_cut_parts parts;
    he_mesh *part = part_of(m, ORIGIN, hole, HE_CUT_ABOVE, true, &parts);
    assert_loops(part, "3");
    assert_int_equal(euler_of(part), 1);
    assert_int_equal(parts.caps.count, 1);
    he_cut_parts_clear(&parts);
    he_mesh_free(part);
    part = part_of(m, ORIGIN, hole, HE_CUT_BELOW, true, NULL);
    assert_loops(part, "");
    assert_int_equal(euler_of(part), 2);
    he_mesh_free(part);

    /* A plane through a hole cuts the mesh along an open line, which no cap can close: with caps
     * the operation must be refused, without caps it must succeed. */
    he_vec3 across = he_vec3_cross(hole, UP), at = he_vec3_scale(hole, 1.0 / 3);
    he_error err = {.status = HE_OK};
    part = copy_of(m);
    assert_int_equal(
        he_plane_cut(part, &(he_plane){at, across, NULL}, HE_CUT_ABOVE, true, NULL, &err),
        HE_OPEN_LOOP);
    assert_int_equal(err.kind, HE_VERTEX);
    assert_equal(part, m);
    he_mesh_free(part);
    part = part_of(m, at, across, HE_CUT_ABOVE, false, NULL);
    assert_int_equal(euler_of(part), 1);
    he_mesh_free(part);
    he_mesh_free(m);
}

static void a_plane_without_normal_or_finite_numbers_is_refused(void **state)
{
    (void)state;
    he_mesh *m = shape("cube"), *before = copy_of(m);
    assert_int_equal(
        he_plane_cut(m, &(he_plane){ORIGIN, ORIGIN, NULL}, HE_CUT_ABOVE, true, NULL, NULL),
        HE_BAD_VALUE);
    assert_int_equal(he_plane_cut(m, &(he_plane){(he_vec3){NAN, 0, 0}, UP, NULL}, HE_CUT_ABOVE,
                                  true, NULL, NULL),
                     HE_NOT_FINITE);
    assert_int_equal(he_plane_cut(m, &(he_plane){ORIGIN, (he_vec3){0, INFINITY, 0}, NULL},
                                  HE_CUT_BELOW, false, NULL, NULL),
                     HE_NOT_FINITE);
    assert_equal(m, before);
    he_mesh_free(before);
    he_mesh_free(m);
}

static void corners_within_the_tolerance_lie_in_the_plane(void **state)
{
    (void)state;
    const double near = 0.1, none = 0, less = -1, no_number = (double)NAN;
    const he_vec3 at = {0, 0, 0.05};
    he_cut_parts parts;
    he_mesh *m = script_mesh(STAIRS, STAIRS_LIE), *before = copy_of(m);
    /* The bottom of the stair lies in the cutting plane, within the tolerance, and faces down: the
     * part of the mesh above the plane must keep this face. */
    assert_int_equal(he_plane_cut(m, &(he_plane){at, UP, &near}, HE_CUT_ABOVE, true, &parts, NULL),
                     HE_OK);
    assert_int_equal(parts.edges_split, 0);
    assert_int_equal(parts.faces_deleted, 0);
    he_cut_parts_clear(&parts);
    assert_equal(m, before);
    assert_int_equal(he_plane_cut(m, &(he_plane){at, UP, &less}, HE_CUT_ABOVE, true, NULL, NULL),
                     HE_BAD_VALUE);
    assert_int_equal(
        he_plane_cut(m, &(he_plane){at, UP, &no_number}, HE_CUT_ABOVE, true, NULL, NULL),
        HE_NOT_FINITE);
    assert_equal(m, before);
    assert_int_equal(he_plane_cut(m, &(he_plane){at, UP, &none}, HE_CUT_ABOVE, true, &parts, NULL),
                     HE_OK);
    assert_int_equal(parts.edges_split, 4);
    assert_int_equal(parts.caps.count, 1);
    he_cut_parts_clear(&parts);
    assert_valid(m);
    he_mesh_free(before);
    he_mesh_free(m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(corners_within_the_tolerance_lie_in_the_plane),
        cmocka_unit_test(the_halves_of_a_cut_make_up_the_whole),
        cmocka_unit_test(a_face_in_the_plane_goes_to_the_part_it_bounds),
        cmocka_unit_test(a_hole_off_the_plane_stays_and_one_across_it_forbids_caps),
        cmocka_unit_test(a_plane_without_normal_or_finite_numbers_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
