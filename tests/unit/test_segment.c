/* The operation segment: solids whose patches are known, patches by planes against the error of
 * other divisions, and what it does with marks that exist. */
#include "edit_script.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "algo/shape.h"
#include "build/build.h"
#include "geometry/geometry.h"
#include "mesh/marks.h"
#include "mesh/walk.h"
#include "select/segment.h"

/* Makes a shape whose first parameters are `first` and `second`. */
static he_mesh *shape_mesh(const char *name, double first, double second)
{
    double args[HE_SHAPE_PARAMS];
    const he_shape *shape = he_shape_find(name, strlen(name));
    he_soup soup;
    he_mesh *m = NULL;
    assert_non_null(shape);
    he_shape_defaults(shape, args);
    args[0] = first;
    args[1] = second;
    assert_int_equal(he_shape_make(shape, args, NULL, &soup, NULL), HE_OK);
    assert_int_equal(he_build(&soup, HE_BUILD_TAKE, &m, NULL, NULL), HE_OK);
    he_soup_clear(&soup);
    return m;
}

static int32_t patch_of(const he_mesh *m, uint32_t face)
{
    const he_column *column = he_mesh_find_column(m, HE_FACE, "patch");
    int32_t number;
    assert_non_null(column);
    memcpy(&number, he_column_value(column, face), sizeof number);
    return number;
}

static uint32_t marked_in(const he_mesh *m)
{
    const he_column *mark = he_mark_find(m, HE_EDGE, "feature");
    uint32_t count = 0;
    for (uint32_t e = 0; e < he_mesh_issued(m, HE_EDGE); e++) {
        count += he_mesh_is_live(m, HE_EDGE, e) && he_is_marked(mark, e);
    }
    return count;
}

/* Segments a mesh, and checks the numbers of patches: from 1, in the order of lowest face ids. */
static he_segmented segment(he_mesh *m, const char *operation)
{
    he_results results = {.each = false};
    assert_int_equal(script_run(m, operation, &results, NULL), HE_OK);
    const he_segmented done = {(uint32_t)results.number[0], (uint32_t)results.number[1],
                               results.number[2]};
    int32_t highest = 0;
    for (uint32_t f = 0; f < he_mesh_issued(m, HE_FACE); f++) {
        if (he_mesh_is_live(m, HE_FACE, f)) {
            const int32_t patch = patch_of(m, f);
            assert_in_range(patch, 1, highest + 1);
            highest = patch > highest ? patch : highest;
        }
    }
    assert_int_equal(highest, done.patches);
    assert_int_equal(marked_in(m), done.features);
    he_results_clear(&results);
    return done;
}

static void a_cube_has_six_patches(void **state)
{
    (void)state;
    static const char *const operations[] = {"segment angle=0.5", "segment planes=6",
                                             "segment planes=60"};
    for (int finer = 0; finer < 3; finer++) {
        for (size_t i = 0; i < sizeof operations / sizeof *operations; i++) {
            he_mesh *m = shape_mesh("cube", 1, 0);
            if (finer > 0) {
                script_prepare(m, finer == 1 ? "triangulate"
                                             : "triangulate;subdivide "
                                               "scheme=linear steps=3");
            }
            const he_segmented done = segment(m, operations[i]);
            assert_int_equal(done.patches, 6);
            assert_int_equal(done.features, finer < 2 ? 12 : 96);
            assert_true(done.deviation < 1e-12); /* 0 if it was not measured */
            for (uint32_t e = 0; e < he_mesh_edges(m); e++) {
                const he_halfedge h = {2 * e};
                const bool marked = he_is_marked(he_mark_find(m, HE_EDGE, "feature"), e);
                assert_int_equal(marked, patch_of(m, he_face_of(m, h).i) !=
                                             patch_of(m, he_face_of(m, he_twin(h)).i));
            }
            he_mesh_free(m);
        }
    }
}

static void a_capped_cylinder_has_three_patches(void **state)
{
    (void)state;
    for (int triangles = 0; triangles < 2; triangles++) {
        he_mesh *m = shape_mesh("cylinder", 32, 1);
        script_prepare(m, triangles ? "triangulate" : NULL);
        const he_segmented done = segment(m, "segment angle=0.5");
        assert_int_equal(done.patches, 3);
        assert_int_equal(done.features, 64);
        /* The sides meet at an angle of 2 pi / 32: a smaller limit divides them. */
        assert_int_equal(segment(m, "segment angle=0.19").patches, 34);
        assert_int_equal(segment(m, "segment angle=0.2 features=replace").patches, 3);
        assert_int_equal(segment(m, "segment angle=1.6 features=replace").patches, 1);
        assert_int_equal(marked_in(m), 0);
        he_mesh_free(m);
    }
}

static void marks_are_kept_replaced_or_ignored_as_asked(void **state)
{
    (void)state;
    he_mesh *m = shape_mesh("cube", 1, 0);
    script_prepare(m, "triangulate");
    /* Marks the diagonal of a side, which divides the side. */
    uint32_t diagonal = 0;
    double angle = 0;
    while (!he_edge_dihedral(m, (he_edge){diagonal}, &angle) || fabs(angle) > 0.1) {
        diagonal++;
    }
    char text[48];
    snprintf(text, sizeof text, "mark feature edge=#%u", diagonal);
    script_prepare(m, text);
    he_results results = {.each = false};
    assert_int_equal(script_run(m, "segment angle=0.5 features=ignore", &results, NULL), HE_OK);
    assert_true(results.number[0] == 6 && results.number[1] == 0);
    assert_int_equal(marked_in(m), 1);
    he_segmented done = segment(m, "segment angle=0.5");
    assert_int_equal(done.patches, 7);
    assert_int_equal(done.features, 13);
    done = segment(m, "segment planes=6");
    assert_int_equal(done.patches, 7);
    done = segment(m, "segment angle=0.5 features=replace");
    assert_int_equal(done.patches, 6);
    assert_int_equal(done.features, 12);
    he_results_clear(&results);
    he_mesh_free(m);
}

static void a_crease_that_ends_inside_a_patch_is_marked(void **state)
{
    (void)state;
    /* A ridge along 1-4, from a flat floor around 4 upwards. */
    static const he_vec3 at[] = {{1, -1, 0},  {1, 0, 1}, {1, 1, 0},
                                 {-1, -1, 0}, {0, 0, 0}, {-1, 1, 0}};
    he_mesh *m = script_mesh("014,124,425,453,430", at);
    const he_segmented done = segment(m, "segment angle=1.1");
    assert_int_equal(done.patches, 1);
    assert_int_equal(done.features, 1);
    assert_true(he_is_marked(he_mark_find(m, HE_EDGE, "feature"), edge_between(m, 1, 4).i));
    he_mesh_free(m);
}

static void every_component_gets_a_patch(void **state)
{
    (void)state;
    he_mesh *m = script_mesh("012,345,678,9ab,0cd", NULL);
    assert_int_equal(segment(m, "segment planes=1").patches, 5);
    assert_int_equal(segment(m, "segment angle=3").patches, 5);
    he_mesh_free(m);
    m = script_mesh("+++", NULL);
    assert_int_equal(segment(m, "segment planes=4").patches, 0);
    he_mesh_free(m);
}

/* Returns the deviation of a mesh by the numbers in its attribute `patch`, computed in another way
 * than by the operation: from dot products. */
static double deviation_of(const he_mesh *m, int32_t patches)
{
    he_vec3 *sums = calloc((size_t)patches + 1, sizeof *sums);
    double *areas = calloc((size_t)patches + 1, sizeof *areas), all = 0, spread = 0;
    assert_true(sums != NULL && areas != NULL);
    for (uint32_t f = 0; f < he_mesh_faces(m); f++) {
        he_vec3 n;
        const double area = he_face_area(m, (he_face){f});
        assert_true(he_face_normal(m, (he_face){f}, &n));
        he_vec3 *sum = &sums[patch_of(m, f)];
        *sum = (he_vec3){sum->x + area * n.x, sum->y + area * n.y, sum->z + area * n.z};
        areas[patch_of(m, f)] += area;
        all += area;
    }
    for (int32_t p = 1; p <= patches; p++) {
        const he_vec3 s = sums[p];
        spread += 2 * (areas[p] - sqrt(s.x * s.x + s.y * s.y + s.z * s.z));
    }
    free(sums);
    free(areas);
    return sqrt(spread / all);
}

/* A polyhedron with as many faces as there are planes falls into its faces, however finely they are
 * divided. */
static void planes_find_the_faces_of_a_polyhedron(void **state)
{
    (void)state;
    static const struct {
        const char *name;
        uint32_t faces;
    } solids[] = {{"octahedron", 8}, {"dodecahedron", 12}, {"icosahedron", 20}};
    for (size_t i = 0; i < sizeof solids / sizeof *solids; i++) {
        for (int steps = 0; steps <= 4; steps++) {
            he_mesh *m = shape_mesh(solids[i].name, 1, 0);
            char text[64];
            snprintf(text, sizeof text, "triangulate;subdivide scheme=linear steps=%d", steps);
            script_prepare(m, steps > 0 ? text : "triangulate");
            snprintf(text, sizeof text, "segment planes=%u", solids[i].faces);
            const he_segmented done = segment(m, text);
            assert_int_equal(done.patches, solids[i].faces);
            assert_true(done.deviation < 1e-9);
            he_mesh_free(m);
        }
    }
}

static void more_planes_fit_better(void **state)
{
    (void)state;
    he_mesh *m = shape_mesh("torus", 48, 24);
    double before = 3;
    for (int planes = 1; planes <= 256; planes *= 4) {
        char text[64];
        snprintf(text, sizeof text, "segment planes=%d features=replace", planes);
        const he_segmented done = segment(m, text);
        assert_int_equal(done.patches, planes);
        assert_true(fabs(done.deviation - deviation_of(m, planes)) < 1e-9);
        assert_true(done.deviation < 0.8 * before);
        before = done.deviation;
    }
    he_mesh_free(m);
}

/* Whatever unit the lengths have and wherever the mesh lies, the patches are those of the mesh
 * itself. */
static void patches_do_not_depend_on_size_or_place(void **state)
{
    (void)state;
    static const char *const maps[] = {
        "transform matrix=1e150,0,0,0,0,1e150,0,0,0,0,1e150,0,0,0,0,1",
        "transform matrix=1e-150,0,0,0,0,1e-150,0,0,0,0,1e-150,0,0,0,0,1",
        "transform matrix=1,0,0,1e9,0,1,0,-1e9,0,0,1,1e9,0,0,0,1",
    };
    for (size_t i = 0; i < sizeof maps / sizeof *maps; i++) {
        he_mesh *m = shape_mesh("cylinder", 24, 1), *moved = copy_of(m);
        script_prepare(moved, maps[i]);
        script_prepare(m, "segment angle=0.5");
        script_prepare(moved, "segment angle=0.5");
        for (uint32_t f = 0; f < he_mesh_faces(m); f++) {
            assert_int_equal(patch_of(m, f), patch_of(moved, f));
        }
        he_results results = {.each = false};
        assert_int_equal(script_run(moved, "segment planes=7 features=ignore", &results, NULL),
                         HE_OK);
        assert_true(results.number[0] == 7 && results.number[2] < 0.4);
        he_results_clear(&results);
        he_mesh_free(moved);
        he_mesh_free(m);
    }
}

static bool count_down(void *context, const char *phase, double done)
{
    uint32_t *left = context;
    (void)phase;
    assert_true(done >= 0 && done <= 1);
    return *left > 0 && (*left)--;
}

static void a_segmentation_can_be_cancelled_at_any_time(void **state)
{
    (void)state;
    static const char *const operations[] = {"segment angle=0.5", "segment planes=40"};
    he_mesh *m = shape_mesh("torus", 96, 64);
    script_prepare(m, "mark feature edges=#0,#7");
    for (size_t i = 0; i < sizeof operations / sizeof *operations; i++) {
        uint32_t cancelled = 0;
        he_status status = HE_CANCELLED;
        while (status == HE_CANCELLED) {
            he_mesh *copy = copy_of(m);
            uint32_t left = cancelled;
            he_progress progress;
            he_progress_init(&progress, count_down, &left);
            he_mesh_set_progress(copy, &progress);
            status = script_run(copy, operations[i], NULL, NULL);
            he_mesh_set_progress(copy, NULL);
            if (status == HE_CANCELLED) {
                assert_equal(copy, m);
                cancelled++;
            }
            he_mesh_free(copy);
        }
        assert_int_equal(status, HE_OK);
        assert_true(cancelled > 8);
    }
    he_mesh_free(m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_cube_has_six_patches),
        cmocka_unit_test(a_capped_cylinder_has_three_patches),
        cmocka_unit_test(marks_are_kept_replaced_or_ignored_as_asked),
        cmocka_unit_test(a_crease_that_ends_inside_a_patch_is_marked),
        cmocka_unit_test(every_component_gets_a_patch),
        cmocka_unit_test(planes_find_the_faces_of_a_polyhedron),
        cmocka_unit_test(more_planes_fit_better),
        cmocka_unit_test(patches_do_not_depend_on_size_or_place),
        cmocka_unit_test(a_segmentation_can_be_cancelled_at_any_time),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
