/* Tests of corner normals, cotangent weights and curvature: the results are compared with closed
 * forms. */
#include "query_specimens.h"

#include "geometry/geometry.h"
#include "query/curvature.h"
#include "tests/failing.h"

#include <float.h>
#include <math.h>

static const double PI = 3.14159265358979323846;

static void assert_close(double got, double wanted, double tolerance)
{
    if (!(fabs(got - wanted) <= tolerance)) {
        fail_msg("%.17g is not %.17g", got, wanted);
    }
}

static he_curvature *curvatures(const he_mesh *m)
{
    he_curvature *all = calloc(he_mesh_vertices(m) + 1u, sizeof *all);
    assert_non_null(all);
    assert_int_equal(he_curvatures(m, NULL, 0, UINT64_MAX, NULL, all, NULL), HE_OK);
    return all;
}

static double *cotangents(const he_mesh *m)
{
    double *all = calloc(he_mesh_edges(m) + 1u, sizeof *all);
    assert_non_null(all);
    assert_int_equal(he_edge_cotangents(m, NULL, 0, UINT64_MAX, NULL, all, NULL), HE_OK);
    return all;
}

/* --- corner normals --- */

static void corner_normals_of_a_cube_follow_the_crease(void **state)
{
    (void)state;
    he_mesh *m = query_shape("cube", 2, 0, 0, 0);
    he_vec3 sharp[24], smooth[24], one;
    assert_int_equal(he_corner_normals(m, PI / 4, NULL, sharp, NULL), HE_OK);
    assert_int_equal(he_corner_normals(m, 0.51 * PI, NULL, smooth, NULL), HE_OK);
    for (uint32_t h = 0; h < 24; h++) {
        he_vec3 face, vertex;
        assert_true(he_face_normal(m, (he_face){m->c.face[h]}, &face));
        assert_true(he_vertex_normal(m, (he_vertex){m->c.origin[h]}, HE_WEIGHT_ANGLE, &vertex));
        assert_close(he_vec3_extent(he_vec3_sub(sharp[h], face)), 0, 1e-12);
        assert_close(he_vec3_extent(he_vec3_sub(smooth[h], vertex)), 0, 1e-12);
        assert_int_equal(he_corner_normal(m, (he_halfedge){h}, PI / 4, &one, NULL), HE_OK);
        assert_memory_equal(&one, &sharp[h], sizeof one);
    }
    he_mesh_free(m);
}

/* If two faces at a vertex are separated by a crease, their corner normals there must differ. The
 * corner normals of the other faces at the vertex must not be separated. */
static void a_crease_parts_only_the_faces_across_it(void **state)
{
    (void)state;
    /* Three faces meet at vertex 0. There is a sharp fold at edge 0-3 and hardly any fold at the
     * other edges. */
    he_mesh *m = fixture_mesh("012,023,034");
    const he_vec3 places[] = {{0, 0, 0}, {1, -1, 0}, {1, 0.5, 0}, {0.2, 1, 0.02}, {-0.3, 0, 1}};
    memcpy(m->c.position, places, sizeof places);
    he_vec3 n[3], corner[16];
    double fold[2];
    for (uint32_t f = 0; f < 3; f++) {
        assert_true(he_face_normal(m, (he_face){f}, &n[f]));
    }
    fold[0] = acos(he_vec3_dot(n[0], n[1]));
    fold[1] = acos(he_vec3_dot(n[1], n[2]));
    assert_true(fold[0] < 0.1 && fold[1] > 0.5);
    assert_int_equal(he_corner_normals(m, 0.3, NULL, corner, NULL), HE_OK);
    uint32_t at[3];
    for (uint32_t h = 0; h < he_mesh_issued(m, HE_HALFEDGE); h++) {
        if (m->c.origin[h] == 0 && m->c.face[h] != HE_NONE) {
            at[m->c.face[h]] = h;
        } else if (m->c.face[h] == HE_NONE) {
            assert_true(he_vec3_extent(corner[h]) == 0);
        }
    }
    assert_memory_equal(&corner[at[0]], &corner[at[1]], sizeof corner[0]);
    assert_close(he_vec3_extent(he_vec3_sub(corner[at[2]], n[2])), 0, 1e-12);
    assert_true(he_vec3_dot(corner[at[0]], n[0]) > 0.99);
    he_mesh_free(m);
}

static void corner_normals_alone_are_those_of_the_whole(void **state)
{
    (void)state;
    for (size_t i = 0; i < QUERY_SPECIMENS; i++) {
        he_mesh *m = fixture_mesh(query_specimens[i]);
        uint32_t halfedges = he_mesh_issued(m, HE_HALFEDGE);
        he_vec3 all[64], one;
        assert_true(halfedges <= 64);
        for (double crease = 0; crease < 3.2; crease += 0.4) {
            assert_int_equal(he_corner_normals(m, crease, NULL, all, NULL), HE_OK);
            for (uint32_t h = 0; h < halfedges; h++) {
                double length = he_vec3_length(all[h]);
                assert_true(length == 0 || fabs(length - 1) < 1e-12);
                assert_int_equal(he_corner_normal(m, (he_halfedge){h}, crease, &one, NULL), HE_OK);
                assert_memory_equal(&one, &all[h], sizeof one);
            }
        }
        he_mesh_free(m);
    }
}

static void a_degenerate_face_parts_no_others(void **state)
{
    (void)state;
    /* The three triangles lie in a plane; the middle one, 0-2-3, has no area. */
    he_mesh *m = fixture_mesh("012,023,034");
    const he_vec3 places[] = {{0, 0, 0}, {1, -1, 0}, {1, 1, 0}, {2, 2, 0}, {-1, 1, 0}};
    memcpy(m->c.position, places, sizeof places);
    he_vec3 corner[16];
    assert_int_equal(he_corner_normals(m, 0.1, NULL, corner, NULL), HE_OK);
    for (uint32_t h = 0; h < he_mesh_issued(m, HE_HALFEDGE); h++) {
        if (m->c.origin[h] == 0 && m->c.face[h] != HE_NONE) {
            assert_close(corner[h].z, 1, 1e-12);
        }
    }
    he_mesh_free(m);
}

static void corner_normals_end_on_broken_links(void **state)
{
    (void)state;
    uint64_t seed = 19;
    for (int round = 0; round < 2000; round++) {
        he_mesh *m = fixture_mesh(query_specimens[query_random(&seed) % QUERY_SPECIMENS]);
        query_spoil(m, &seed);
        he_vec3 normals[64];
        he_status status = he_corner_normals(m, 1, NULL, normals, NULL);
        assert_true(status == HE_OK || status == HE_CORRUPT);
        he_mesh_free(m);
    }
}

/* --- cotangents --- */

static void cotangents_of_equilateral_triangles(void **state)
{
    (void)state;
    he_mesh *m = query_shape("octahedron", 1, 0, 0, 0);
    double *weights = cotangents(m);
    for (uint32_t e = 0; e < he_mesh_edges(m); e++) {
        assert_close(weights[e], 1 / sqrt(3), 1e-14);
    }
    free(weights);
    he_mesh_free(m);
}

static void cotangents_of_a_square_are_those_of_its_triangles(void **state)
{
    (void)state;
    he_mesh *m = query_shape("cube", 3, 0, 0, 0);
    double *weights = cotangents(m);
    for (uint32_t e = 0; e < 12; e++) {
        assert_close(weights[e], 1, 1e-14); /* the angles opposite the edge are 45 degrees */
    }
    free(weights);
    he_mesh_free(m);
}

static void cotangents_beside_degenerate_triangles_are_none(void **state)
{
    (void)state;
    he_mesh *m = fixture_mesh("012,023");
    const he_vec3 places[] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {2, 2, 0}};
    memcpy(m->c.position, places, sizeof places);
    double *weights = cotangents(m);
    int none = 0;
    for (uint32_t e = 0; e < 5; e++) {
        none += isnan(weights[e]);
    }
    assert_int_equal(none, 3);
    free(weights);
    he_mesh_free(m);
}

/* --- curvature --- */

static void spheres_bend_by_their_radius(void **state)
{
    (void)state;
    for (double radius = 0.5; radius < 8; radius *= 3) {
        he_mesh *m = query_shape("icosphere", 4, radius, 0, 0);
        he_curvature *c = curvatures(m);
        double area = 0, mean = 0, gaussian = 0, surface;
        uint32_t vertices = he_mesh_vertices(m);
        he_measures measures;
        assert_int_equal(he_mesh_measure(m, &measures, NULL), HE_OK);
        surface = measures.area;
        for (uint32_t v = 0; v < vertices; v++) {
            assert_close(c[v].mean * radius, 1, 0.02);
            assert_close(c[v].gaussian * radius * radius, 1, 0.05);
            area += c[v].area;
            mean += c[v].mean * c[v].area;
            gaussian += c[v].gaussian * c[v].area;
        }
        assert_close(area / surface, 1, 1e-12);
        assert_close(mean / surface * radius, 1, 0.002);
        assert_close(gaussian, 4 * PI, 1e-9);
        free(c);
        he_mesh_free(m);
    }
}

static void a_sphere_turned_inside_out_bends_the_other_way(void **state)
{
    (void)state;
    he_mesh *m = query_shape("icosphere", 2, 1, 0, 0);
    for (uint32_t v = 0; v < he_mesh_vertices(m); v++) {
        m->c.position[v] = he_vec3_scale(m->c.position[v], -1); /* turns the mesh inside out */
    }
    he_curvature *c = curvatures(m);
    for (uint32_t v = 0; v < he_mesh_vertices(m); v++) {
        assert_true(c[v].mean < -0.9 && c[v].gaussian > 0.9);
    }
    free(c);
    he_mesh_free(m);
}

static void planes_do_not_bend(void **state)
{
    (void)state;
    he_mesh *m = query_shape("grid", 4, 5, 1, 1);
    he_curvature *c = curvatures(m);
    uint32_t inside = 0;
    for (uint32_t v = 0; v < he_mesh_vertices(m); v++) {
        bool boundary = he_is_boundary_vertex(m, (he_vertex){v});
        assert_true(boundary == (isnan(c[v].mean) != 0) && boundary == (isnan(c[v].gaussian) != 0));
        inside += !boundary;
        if (!boundary) {
            assert_close(c[v].mean, 0, 1e-12);
            assert_close(c[v].gaussian, 0, 1e-12);
        }
    }
    assert_true(inside > 0);
    free(c);
    he_mesh_free(m);
}

/* The sum of the angle defects must be 2 pi times the Euler number for any faces and positions,
 * even with bow-ties and reflex corners. */
static void angle_defects_sum_to_the_euler_number(void **state)
{
    (void)state;
    uint64_t seed = 31;
    for (int round = 0; round < 400; round++) {
        he_mesh *m = fixture_mesh(query_specimens[query_random(&seed) % QUERY_SPECIMENS]);
        for (uint32_t v = 0; round >= 50 && v < he_mesh_vertices(m); v++) {
            m->c.position[v] =
                (he_vec3){(double)(query_random(&seed) % 9), (double)(query_random(&seed) % 9),
                          (double)(query_random(&seed) % 9)};
        }
        he_curvature *c = curvatures(m);
        double sum = 0;
        int euler = (int)he_mesh_faces(m) - (int)he_mesh_edges(m);
        for (uint32_t v = 0; v < he_mesh_vertices(m); v++) {
            bool isolated = he_is_isolated(m, (he_vertex){v});
            assert_int_equal(isolated, isnan(c[v].angle_defect) != 0);
            euler += !isolated;
            sum += isolated ? 0 : c[v].angle_defect;
        }
        assert_close(sum, 2 * PI * euler, 1e-9);
        free(c);
        he_mesh_free(m);
    }
    he_mesh *torus = fixture_mesh("0143,1254,2035,3476,4587,5368,6710,7821,8602");
    he_curvature *c = curvatures(torus);
    double sum = 0;
    for (uint32_t v = 0; v < 9; v++) {
        sum += c[v].angle_defect;
    }
    assert_close(sum, 0, 1e-9);
    free(c);
    he_mesh_free(torus);
}

static void an_element_alone_has_the_value_it_has_among_all(void **state)
{
    (void)state;
    for (size_t i = 0; i < QUERY_SPECIMENS; i++) {
        he_mesh *m = fixture_mesh(query_specimens[i]);
        he_curvature *c = curvatures(m), one[3];
        double *weights = cotangents(m), weight[2];
        uint32_t vertices = he_mesh_vertices(m), edges = he_mesh_edges(m);
        for (uint32_t v = 0; v < vertices; v++) {
            uint32_t list[3] = {v, vertices - 1, v}; /* a repeated element must be answered twice */
            assert_int_equal(he_curvatures(m, list, 3, UINT64_MAX, NULL, one, NULL), HE_OK);
            assert_memory_equal(&one[0], &c[v], sizeof one[0]);
            assert_memory_equal(&one[1], &c[vertices - 1], sizeof one[0]);
            assert_memory_equal(&one[2], &c[v], sizeof one[0]);
        }
        for (uint32_t e = 0; e < edges; e++) {
            uint32_t list[2] = {edges - 1, e};
            assert_int_equal(he_edge_cotangents(m, list, 2, UINT64_MAX, NULL, weight, NULL), HE_OK);
            assert_memory_equal(&weight[1], &weights[e], sizeof weight[0]);
        }
        free(c);
        free(weights);
        he_mesh_free(m);
    }
}

static void curvature_scales_with_the_mesh(void **state)
{
    (void)state;
    static const int exponents[] = {-300, -60, 60, 300};
    he_mesh *m = query_shape("icosphere", 2, 1, 0, 0);
    he_curvature *unit = curvatures(m);
    uint32_t vertices = he_mesh_vertices(m);
    he_vec3 *places = malloc(vertices * sizeof *places);
    assert_non_null(places);
    memcpy(places, m->c.position, vertices * sizeof *places);
    for (int i = 0; i < 4; i++) {
        for (uint32_t v = 0; v < vertices; v++) {
            m->c.position[v] = he_vec3_scale(places[v], ldexp(1, exponents[i]));
        }
        he_curvature *c = curvatures(m);
        for (uint32_t v = 0; v < vertices; v++) {
            assert_true(c[v].angle_defect == unit[v].angle_defect);
            assert_true(c[v].mean == ldexp(unit[v].mean, -exponents[i]));
            assert_true(c[v].gaussian == ldexp(unit[v].gaussian, -2 * exponents[i]));
        }
        free(c);
    }
    free(places);
    free(unit);
    he_mesh_free(m);
}

static void curvature_of_extreme_coordinates_is_finite_or_none(void **state)
{
    (void)state;
    static const double odd[] = {0,      1,     -1,    DBL_MAX, -DBL_MAX, DBL_MIN,
                                 5e-324, 1e-77, 1e154, -1e308,  1e-160,   -0.0};
    uint64_t seed = 77;
    for (int round = 0; round < 2000; round++) {
        he_mesh *m = fixture_mesh(query_specimens[query_random(&seed) % QUERY_SPECIMENS]);
        uint64_t kinds = 1 + query_random(&seed) % 12;
        for (uint32_t v = 0; v < he_mesh_vertices(m); v++) {
            m->c.position[v] =
                (he_vec3){odd[query_random(&seed) % kinds], odd[query_random(&seed) % kinds],
                          odd[query_random(&seed) % kinds]};
        }
        he_curvature *c = curvatures(m);
        double *weights = cotangents(m);
        for (uint32_t v = 0; v < he_mesh_vertices(m); v++) {
            assert_true(isfinite(c[v].area) && c[v].area >= 0);
            assert_true(isnan(c[v].mean) || isfinite(c[v].mean));
            assert_true(isnan(c[v].gaussian) || isfinite(c[v].gaussian));
        }
        for (uint32_t e = 0; e < he_mesh_edges(m); e++) {
            assert_true(isnan(weights[e]) || isfinite(weights[e]));
        }
        free(c);
        free(weights);
        he_mesh_free(m);
    }
}

static void a_face_too_costly_to_cut_is_refused(void **state)
{
    (void)state;
    he_mesh *m = fixture_mesh("01234567");
    he_curvature c;
    he_error err = {0};
    assert_int_equal(he_curvatures(m, &(uint32_t){0}, 1, 63, NULL, &c, &err), HE_LIMIT);
    assert_true(err.kind == HE_FACE && err.id == 0);
    assert_int_equal(he_curvatures(m, &(uint32_t){0}, 1, 64, NULL, &c, &err), HE_OK);
    he_mesh_free(m);
}

static void dead_rows_are_left_out(void **state)
{
    (void)state;
    he_mesh *m = query_with_dead_rows();
    he_curvature c[4] = {{0}};
    double weights[3];
    assert_int_equal(he_curvatures(m, NULL, 0, UINT64_MAX, NULL, c, NULL), HE_OK);
    assert_int_equal(he_edge_cotangents(m, NULL, 0, UINT64_MAX, NULL, weights, NULL), HE_OK);
    assert_true(isnan(c[3].angle_defect) && c[3].area == 0);
    he_mesh_free(m);
}

static void starved_questions_say_so(void **state)
{
    (void)state;
    he_mesh *m = fixture_mesh("01234567,1089");
    he_curvature c[10];
    double weights[16];
    he_vec3 normals[64];
    uint32_t list[] = {0, 3, 5};
    for (int what = 0; what < 5; what++) {
        failing f = {0};
        while (failing_next(&f)) {
            he_status status = HE_OK;
            switch (what) {
            case 0:
                status = he_curvatures(m, NULL, 0, UINT64_MAX, NULL, c, NULL);
                break;
            case 1:
                status = he_curvatures(m, list, 3, UINT64_MAX, NULL, c, NULL);
                break;
            case 2:
                status = he_edge_cotangents(m, list, 3, UINT64_MAX, NULL, weights, NULL);
                break;
            case 3:
                status = he_corner_normals(m, 1, NULL, normals, NULL);
                break;
            default:
                status = he_corner_normal(m, (he_halfedge){1}, 1, normals, NULL);
            }
            failing_status(&f, status);
        }
    }
    he_mesh_free(m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(corner_normals_of_a_cube_follow_the_crease),
        cmocka_unit_test(a_crease_parts_only_the_faces_across_it),
        cmocka_unit_test(corner_normals_alone_are_those_of_the_whole),
        cmocka_unit_test(a_degenerate_face_parts_no_others),
        cmocka_unit_test(corner_normals_end_on_broken_links),
        cmocka_unit_test(cotangents_of_equilateral_triangles),
        cmocka_unit_test(cotangents_of_a_square_are_those_of_its_triangles),
        cmocka_unit_test(cotangents_beside_degenerate_triangles_are_none),
        cmocka_unit_test(spheres_bend_by_their_radius),
        cmocka_unit_test(a_sphere_turned_inside_out_bends_the_other_way),
        cmocka_unit_test(planes_do_not_bend),
        cmocka_unit_test(angle_defects_sum_to_the_euler_number),
        cmocka_unit_test(an_element_alone_has_the_value_it_has_among_all),
        cmocka_unit_test(curvature_scales_with_the_mesh),
        cmocka_unit_test(curvature_of_extreme_coordinates_is_finite_or_none),
        cmocka_unit_test(a_face_too_costly_to_cut_is_refused),
        cmocka_unit_test(dead_rows_are_left_out),
        cmocka_unit_test(starved_questions_say_so),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
