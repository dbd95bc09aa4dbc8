/* Tests of lengths, areas, normals and angles: the results are compared with closed forms and with
 * other formulas. */
#include "query_specimens.h"

#include "edit/local/vertex.h"
#include "geometry/geometry.h"
#include "tests/failing.h"

#include <float.h>
#include <math.h>

static const double PI = 3.14159265358979323846;

static void assert_near(double got, double wanted)
{
    if (!(fabs(got - wanted) <= 1e-12 * fmax(1, fabs(wanted)))) {
        fail_msg("%.17g is not %.17g", got, wanted);
    }
}

static void assert_vector(he_vec3 got, double x, double y, double z)
{
    if (!(fabs(got.x - x) < 1e-12 && fabs(got.y - y) < 1e-12 && fabs(got.z - z) < 1e-12)) {
        fail_msg("(%g %g %g) is not (%g %g %g)", got.x, got.y, got.z, x, y, z);
    }
}

static he_mesh *cube(void)
{
    return query_shape("cube", 2, 0, 0, 0);
}

static void place(he_mesh *m, uint32_t v, double x, double y, double z)
{
    m->c.position[v] = (he_vec3){x, y, z};
}

static uint32_t edge_between(const he_mesh *m, uint32_t a, uint32_t b)
{
    he_halfedge h = he_find_halfedge(m, (he_vertex){a}, (he_vertex){b});
    assert_int_not_equal(h.i, HE_NONE);
    return h.i >> 1;
}

static void a_cube_has_its_known_areas_angles_normals_and_volume(void **state)
{
    (void)state;
    he_mesh *m = cube();
    for (uint32_t f = 0; f < 6; f++) {
        he_face_shape shape = he_face_measure(m, (he_face){f});
        assert_true(shape.area == 4 && shape.degree == 4 && !shape.degenerate);
        /* In a regular solid around the origin, the normal of a face is parallel to its
         * centroid. */
        assert_vector(shape.normal, shape.centroid.x, shape.centroid.y, shape.centroid.z);
        he_vec3 normal, centroid = he_face_centroid(m, (he_face){f});
        assert_true(he_face_normal(m, (he_face){f}, &normal));
        assert_memory_equal(&normal, &shape.normal, sizeof normal);
        assert_memory_equal(&centroid, &shape.centroid, sizeof centroid);
        assert_true(he_face_area(m, (he_face){f}) == 4);
    }
    for (uint32_t e = 0; e < 12; e++) {
        double angle;
        assert_true(he_edge_length(m, (he_edge){e}) == 2);
        assert_true(he_edge_dihedral(m, (he_edge){e}, &angle));
        assert_near(angle, PI / 2);
    }
    for (uint32_t h = 0; h < 24; h++) {
        assert_near(he_corner_angle(m, (he_halfedge){h}), PI / 2);
    }
    static const he_weight weights[] = {HE_WEIGHT_AREA, HE_WEIGHT_ANGLE, HE_WEIGHT_UNIFORM};
    for (int w = 0; w < 3; w++) {
        for (uint32_t v = 0; v < 8; v++) {
            he_vec3 p = m->c.position[v], normal;
            assert_true(he_vertex_normal(m, (he_vertex){v}, weights[w], &normal));
            assert_vector(normal, p.x / sqrt(3), p.y / sqrt(3), p.z / sqrt(3));
        }
    }
    he_box box;
    assert_true(he_mesh_box(m, &box));
    assert_vector(box.min, -1, -1, -1);
    assert_vector(box.max, 1, 1, 1);
    he_measures measures;
    assert_int_equal(he_mesh_measure(m, &measures, NULL), HE_OK);
    assert_true(measures.has_volume && measures.volume == 8 && measures.area == 24);
    he_mesh_free(m);
}

static void normals_of_vertices_depend_on_their_weights(void **state)
{
    (void)state;
    /* At the corner of a box of 1 x 2 x 3, faces with the areas 6, 3 and 2 meet at right angles. */
    he_mesh *m = cube();
    for (uint32_t v = 0; v < 8; v++) {
        he_vec3 *p = &m->c.position[v];
        place(m, v, p->x / 2, p->y, p->z * 1.5);
    }
    he_vec3 normal;
    assert_true(he_vertex_normal(m, (he_vertex){6}, HE_WEIGHT_AREA, &normal));
    assert_vector(normal, 6 / 7.0, 3 / 7.0, 2 / 7.0);
    assert_true(he_vertex_normal(m, (he_vertex){6}, HE_WEIGHT_ANGLE, &normal));
    assert_vector(normal, 1 / sqrt(3), 1 / sqrt(3), 1 / sqrt(3));
    he_mesh_free(m);
    /* If a face is divided into two at the vertex, a vertex normal weighted by angle must not
     * change, but a vertex normal with equal weights must change. */
    m = fixture_mesh("0123,034,045,051");
    place(m, 0, 0, 0, 0);
    place(m, 1, 0, 1, 0);
    place(m, 2, 1, 1, 0);
    place(m, 3, 1, 0, 0);
    place(m, 4, 1, 0, 1);
    place(m, 5, 0, 0, 1);
    assert_true(he_vertex_normal(m, (he_vertex){0}, HE_WEIGHT_ANGLE, &normal));
    assert_vector(normal, -1 / sqrt(3), -1 / sqrt(3), -1 / sqrt(3));
    assert_true(he_vertex_normal(m, (he_vertex){0}, HE_WEIGHT_UNIFORM, &normal));
    assert_vector(normal, -1 / sqrt(6), -2 / sqrt(6), -1 / sqrt(6));
    he_mesh_free(m);
}

static void dihedral_angles_tell_ridges_from_valleys(void **state)
{
    (void)state;
    he_mesh *m = fixture_mesh("012,103");
    double angle;
    place(m, 0, 0, 0, 0);
    place(m, 1, 1, 0, 0);
    place(m, 2, 0, 1, 0);
    for (int i = -8; i <= 8; i++) {
        /* Face 103 is folded by the angle: down for positive angles, which makes a ridge, or up,
         * which makes a valley. */
        double wanted = i * PI / 9;
        place(m, 3, 0, -cos(wanted), -sin(wanted));
        assert_true(he_edge_dihedral(m, (he_edge){edge_between(m, 0, 1)}, &angle));
        assert_near(angle, wanted);
    }
    place(m, 3, 0, 1, 0); /* face 103 is folded onto the other face, so they coincide */
    assert_true(he_edge_dihedral(m, (he_edge){edge_between(m, 0, 1)}, &angle));
    assert_near(angle, PI);
    assert_false(he_edge_dihedral(m, (he_edge){edge_between(m, 1, 2)}, &angle));
    assert_true(angle == 0);
    place(m, 3, 0.5, 0, 0);
    assert_false(he_edge_dihedral(m, (he_edge){edge_between(m, 0, 1)}, &angle));
    he_mesh_free(m);
}

static uint64_t bits_of(double value)
{
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits;
}

static void assert_dihedrals_agree(const he_mesh *m)
{
    double *all = he_mem_array(NULL, (size_t)m->c.edges.issued + 1, sizeof *all);
    assert_non_null(all);
    assert_int_equal(he_edge_dihedrals(m, NULL, all, NULL), HE_OK);
    for (uint32_t e = 0; e < m->c.edges.issued; e++) {
        double one = NAN;
        bool known = he_edge_is_live(m, (he_edge){e}) && he_edge_dihedral(m, (he_edge){e}, &one);
        assert_true(known ? bits_of(one) == bits_of(all[e]) : isnan(all[e]));
    }
    he_mem_free(all);
}

static void dihedrals_of_a_mesh_are_those_of_its_edges_one_by_one(void **state)
{
    (void)state;
    for (int i = 0; i < QUERY_SPECIMENS; i++) {
        he_mesh *m = fixture_mesh(query_specimens[i]);
        assert_dihedrals_agree(m);
        if (m->c.vertices.issued > 2) {
            m->c.position[1] = m->c.position[2]; /* faces with vertices 1 and 2 become degenerate,
                                                    because the two positions are now equal */
        }
        assert_dihedrals_agree(m);
        he_mesh_free(m);
    }
    he_mesh *m = query_with_dead_rows();
    assert_dihedrals_agree(m);
    he_mesh_free(m);
}

/* Each edge on the rim of a cone belongs to the cone's base, a face of 200,000 corners. If the base
 * were measured again for each edge, 40 billion steps would be needed, and the test would not end
 * in time. */
static void dihedrals_measure_a_face_of_many_corners_once(void **state)
{
    (void)state;
    he_mesh *m = query_shape("cone", 200000, 1, 1, 1);
    double *all = he_mem_array(NULL, m->c.edges.issued, sizeof *all);
    assert_non_null(all);
    assert_int_equal(he_edge_dihedrals(m, NULL, all, NULL), HE_OK);
    assert_true(all[0] > 0 && all[m->c.edges.issued - 1] > 0);
    he_mem_free(all);
    he_mesh_free(m);
}

static void dihedrals_are_refused_where_memory_is_out(void **state)
{
    (void)state;
    he_mesh *m = cube();
    double all[12];
    failing_at(1);
    he_status status = he_edge_dihedrals(m, NULL, all, NULL);
    failing_off();
    assert_int_equal(status, HE_NO_MEMORY);
    he_mesh_free(m);
}

/* The theorem of Gauss and Bonnet: if the angles at each vertex are subtracted from 2 pi, the sum
 * of these differences over all vertices is 2 pi times the Euler number. */
static void angle_defects_sum_to_two_pi_euler(void **state)
{
    (void)state;
    static const struct {
        const char *name;
        double args[3];
        int euler;
    } rows[] = {{"icosphere", {2, 1, 0}, 2}, {"octahedron", {3, 0, 0}, 2}, {"cube", {1, 0, 0}, 2}};
    for (size_t i = 0; i < 3; i++) {
        const double *a = rows[i].args;
        he_mesh *m = query_shape(rows[i].name, a[0], a[1], a[2], 0);
        double sum = 2 * PI * he_mesh_vertices(m);
        for (uint32_t h = 0; h < he_mesh_issued(m, HE_HALFEDGE); h++) {
            sum -= he_corner_angle(m, (he_halfedge){h});
        }
        assert_true(fabs(sum - 2 * PI * rows[i].euler) < 1e-9);
        he_mesh_free(m);
    }
}

static void a_degenerate_face_has_no_normal(void **state)
{
    (void)state;
    static const struct {
        double p[3][3];
        bool degenerate;
    } rows[] = {
        {{{0, 0, 0}, {0, 0, 0}, {0, 0, 0}}, true},
        {{{1, 2, 3}, {1, 2, 3}, {4, 5, 6}}, true},
        {{{1, 2, 3}, {4, 5, 6}, {4, 5, 6}}, true},
        {{{0, 0, 0}, {1, 1, 1}, {2, 2, 2}}, true},
        {{{0.1, 0.1, 0.1}, {0.2, 0.2, 0.2}, {0.7, 0.7, 0.7}}, true},
        {{{0, 0, 0}, {1e-300, 0, 0}, {0, 1e-300, 0}}, false},
        {{{0, 0, 0}, {5e-324, 0, 0}, {0, 5e-324, 0}}, false},
        {{{0, 0, 0}, {1e300, 0, 0}, {0, 1e300, 0}}, false},
        {{{-1e308, 0, 0}, {1e308, 0, 0}, {0, 1e308, 0}}, false},
        {{{0, 0, 0}, {1, 0, 0}, {1, 1e-12, 0}}, false},
        {{{0, 0, 0}, {1, 0, 0}, {0, 1e-100, 0}}, false},
        {{{1e200, 1e200, 1e200}, {-1e200, -1e200, -1e200}, {0, 0, 0}}, true},
    };
    he_mesh *m = fixture_mesh("012");
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        for (uint32_t v = 0; v < 3; v++) {
            const double *p = rows[i].p[v];
            place(m, v, p[0], p[1], p[2]);
        }
        he_vec3 normal, all[1];
        he_face_shape shape = he_face_measure(m, (he_face){0});
        assert_int_equal(he_face_normal(m, (he_face){0}, &normal), !rows[i].degenerate);
        assert_int_equal(shape.degenerate, rows[i].degenerate);
        assert_int_equal(he_face_normals(m, NULL, all, NULL), HE_OK);
        assert_vector(all[0], normal.x, normal.y, normal.z);
        if (rows[i].degenerate) {
            assert_true(normal.x == 0 && normal.y == 0 && normal.z == 0);
        } else {
            assert_vector(normal, 0, 0, 1);
        }
        he_vec3 at_vertex;
        assert_int_equal(he_vertex_normal(m, (he_vertex){0}, HE_WEIGHT_AREA, &at_vertex),
                         !rows[i].degenerate);
        assert_vector(at_vertex, normal.x, normal.y, normal.z);
    }
    he_mesh_free(m);
}

/* Scaling by a power of two must change no bit of a normal, and no bit of a length or area that
 * does not overflow. */
static void geometry_does_not_depend_on_scale(void **state)
{
    (void)state;
    he_mesh *m = query_shape("icosphere", 1, 0.7, 0, 0);
    uint32_t faces = he_mesh_faces(m), vertices = he_mesh_vertices(m);
    he_vec3 *normals = calloc(faces, sizeof *normals), *scaled = calloc(faces, sizeof *scaled);
    he_vec3 *smooth = calloc(vertices, sizeof *smooth);
    he_vec3 *positions = calloc(vertices, sizeof *positions);
    he_vec3 *again = calloc(vertices, sizeof *again);
    assert_true(normals && scaled && smooth && positions && again);
    memcpy(positions, m->c.position, vertices * sizeof *positions);
    assert_int_equal(he_face_normals(m, NULL, normals, NULL), HE_OK);
    assert_int_equal(he_vertex_normals(m, HE_WEIGHT_AREA, NULL, smooth, NULL), HE_OK);
    he_measures unit;
    assert_int_equal(he_mesh_measure(m, &unit, NULL), HE_OK);
    double length = he_edge_length(m, (he_edge){5});
    double dihedral, angle = he_corner_angle(m, (he_halfedge){5});
    assert_true(he_edge_dihedral(m, (he_edge){5}, &dihedral));
    for (int k = -960; k <= 1020; k += 60) {
        for (uint32_t v = 0; v < vertices; v++) {
            m->c.position[v] = he_vec3_scale(positions[v], ldexp(1, k));
        }
        double other;
        assert_int_equal(he_face_normals(m, NULL, scaled, NULL), HE_OK);
        for (uint32_t f = 0; f < faces; f++) {
            he_vec3 n = normals[f];
            assert_vector(scaled[f], n.x, n.y, n.z);
        }
        assert_int_equal(he_vertex_normals(m, HE_WEIGHT_AREA, NULL, again, NULL), HE_OK);
        for (uint32_t v = 0; v < vertices; v++) {
            he_vec3 n = smooth[v];
            assert_vector(again[v], n.x, n.y, n.z);
        }
        assert_near(he_edge_length(m, (he_edge){5}) / ldexp(length, k), 1);
        assert_near(he_corner_angle(m, (he_halfedge){5}), angle);
        assert_true(he_edge_dihedral(m, (he_edge){5}, &other));
        assert_near(other, dihedral);
        he_measures measures;
        assert_int_equal(he_mesh_measure(m, &measures, NULL), HE_OK);
        double area = ldexp(unit.area, 2 * k), volume = ldexp(unit.volume, 3 * k);
        assert_true(measures.area == fmin(area, DBL_MAX));
        assert_true(measures.volume == fmin(volume, DBL_MAX));
    }
    free(normals);
    free(scaled);
    free(smooth);
    free(positions);
    free(again);
    he_mesh_free(m);
}

static bool finite_and_at_most_one(he_vec3 n)
{
    return he_vec3_is_finite(n) && he_vec3_length(n) < 1 + 1e-12;
}

static void geometry_of_extreme_coordinates_is_finite(void **state)
{
    (void)state;
    static const double odd[] = {0,      1,      -1,     DBL_MAX, -DBL_MAX, DBL_MIN,
                                 5e-324, 1e-200, 1e-125, 1e-77,   1e77,     1e125,
                                 1e154,  -1e200, 3.5,    -1e308,  1e-160,   -0.0};
    uint64_t seed = 6;
    for (int round = 0; round < 2000; round++) {
        he_mesh *m = fixture_mesh(query_specimens[query_random(&seed) % QUERY_SPECIMENS]);
        uint32_t vertices = he_mesh_vertices(m), faces = he_mesh_faces(m);
        uint64_t kinds = 1 + query_random(&seed) % 18;
        for (uint32_t v = 0; v < vertices; v++) {
            double *p = &m->c.position[v].x;
            for (int i = 0; i < 3; i++) {
                p[i] = odd[query_random(&seed) % kinds];
            }
        }
        he_vec3 normals[16], normal;
        assert_true(vertices <= 16 && faces <= 16);
        assert_int_equal(he_face_normals(m, NULL, normals, NULL), HE_OK);
        for (uint32_t f = 0; f < faces; f++) {
            he_face_shape shape = he_face_measure(m, (he_face){f});
            assert_true(finite_and_at_most_one(shape.normal));
            assert_true(finite_and_at_most_one(normals[f]));
            assert_true(isfinite(shape.area) && shape.area >= 0);
            assert_true(he_vec3_is_finite(shape.centroid));
            assert_int_equal(shape.degenerate, he_vec3_extent(shape.normal) == 0);
        }
        for (int weight = 0; weight < 3; weight++) {
            assert_int_equal(he_vertex_normals(m, (he_weight)weight, NULL, normals, NULL), HE_OK);
            for (uint32_t v = 0; v < vertices; v++) {
                he_vertex_normal(m, (he_vertex){v}, (he_weight)weight, &normal);
                assert_true(finite_and_at_most_one(normal));
                assert_true(finite_and_at_most_one(normals[v]));
            }
        }
        for (uint32_t h = 0; h < 2 * he_mesh_edges(m); h++) {
            double angle = he_corner_angle(m, (he_halfedge){h}), dihedral;
            assert_true(angle >= 0 && angle <= PI);
            assert_true(he_edge_length(m, (he_edge){h >> 1}) <= DBL_MAX);
            he_edge_dihedral(m, (he_edge){h >> 1}, &dihedral);
            assert_true(dihedral > -PI && dihedral <= PI);
        }
        he_measures measures;
        assert_int_equal(he_mesh_measure(m, &measures, NULL), HE_OK);
        assert_true(isfinite(measures.area) && isfinite(measures.volume));
        he_mesh_free(m);
    }
}

/* The functions for the whole mesh must give the same results as the functions for one element. The
 * area vector of a face is compared with another form of Newell's sum. */
static void geometry_of_a_whole_mesh_agrees_with_single_elements(void **state)
{
    (void)state;
    uint64_t seed = 8;
    for (int round = 0; round < 300; round++) {
        he_mesh *m = fixture_mesh(query_specimens[query_random(&seed) % QUERY_SPECIMENS]);
        uint32_t vertices = he_mesh_vertices(m), faces = he_mesh_faces(m);
        for (uint32_t v = 0; v < vertices; v++) {
            double *p = &m->c.position[v].x;
            for (int i = 0; i < 3; i++) {
                p[i] = (double)(query_random(&seed) % 1000) / 7 - 50;
            }
        }
        he_vec3 normals[16], normal;
        double total = 0;
        assert_int_equal(he_face_normals(m, NULL, normals, NULL), HE_OK);
        for (uint32_t f = 0; f < faces; f++) {
            he_vec3 sum = {0, 0, 0}, mean = {0, 0, 0};
            uint32_t first = m->c.face_halfedge[f], h = m->c.next[first], last = h, n = 0;
            do {
                he_vec3 p = m->c.position[m->c.origin[h]];
                he_vec3 q = m->c.position[m->c.origin[h ^ 1u]];
                sum.x += (p.y - q.y) * (p.z + q.z) / 2;
                sum.y += (p.z - q.z) * (p.x + q.x) / 2;
                sum.z += (p.x - q.x) * (p.y + q.y) / 2;
                mean = he_vec3_add(mean, p);
                n++;
                h = m->c.next[h];
            } while (h != last);
            double area = he_vec3_length(sum);
            total += area;
            he_face_shape shape = he_face_measure(m, (he_face){f});
            assert_true(fabs(shape.area - area) < 1e-9 * (1 + area));
            assert_vector(shape.centroid, mean.x / n, mean.y / n, mean.z / n);
            assert_vector(normals[f], shape.normal.x, shape.normal.y, shape.normal.z);
            if (area > 1) {
                assert_vector(normals[f], sum.x / area, sum.y / area, sum.z / area);
            }
        }
        he_measures measures;
        assert_int_equal(he_mesh_measure(m, &measures, NULL), HE_OK);
        assert_true(fabs(measures.area - total) < 1e-9 * (1 + total));
        assert_int_equal(measures.has_volume,
                         he_mesh_boundary_halfedges(m) == 0 && he_mesh_faces(m) > 0);
        for (int weight = 0; weight < 3; weight++) {
            assert_int_equal(he_vertex_normals(m, (he_weight)weight, NULL, normals, NULL), HE_OK);
            for (uint32_t v = 0; v < vertices; v++) {
                bool some = he_vertex_normal(m, (he_vertex){v}, (he_weight)weight, &normal);
                assert_int_equal(some, he_vec3_extent(normal) > 0);
                assert_true(he_vec3_extent(he_vec3_sub(normal, normals[v])) < 1e-9);
            }
        }
        he_mesh_free(m);
    }
}

/* The volume of a mesh is compared with a sum of tetrahedra, one for each triangle of the mesh; all
 * these tetrahedra have their tips at one point far away. The volume must be negative if the mesh
 * is inside out. */
static void volumes_agree_with_a_sum_of_tetrahedra_and_have_a_sign(void **state)
{
    (void)state;
    he_mesh *meshes[] = {query_shape("torus", 12, 7, 3, 1), query_shape("icosphere", 2, 2, 0, 0),
                         query_shape("dodecahedron", 2, 0, 0, 0), fixture_mesh("012,023,031,132"),
                         fixture_mesh("021,032,013,123")};
    for (size_t i = 0; i < 5; i++) {
        he_mesh *m = meshes[i];
        long double six = 0;
        for (uint32_t f = 0; f < he_mesh_faces(m); f++) {
            uint32_t a = m->c.face_halfedge[f];
            for (uint32_t h = m->c.next[a]; m->c.next[h] != a; h = m->c.next[h]) {
                he_vec3 p = m->c.position[m->c.origin[a]], q = m->c.position[m->c.origin[h]];
                he_vec3 r = m->c.position[m->c.origin[h ^ 1u]];
                p.x -= 10, q.x -= 10, r.x -= 10;
                six += he_vec3_dot(p, he_vec3_cross(q, r));
            }
        }
        he_measures measures;
        assert_int_equal(he_mesh_measure(m, &measures, NULL), HE_OK);
        assert_true(measures.has_volume);
        assert_true(fabs(measures.volume - (double)six / 6) < 1e-10 * (1 + fabs(measures.volume)));
        assert_true(i < 3 ? measures.volume > 0 : measures.volume != 0);
        he_mesh_free(m);
    }
    he_mesh *m = cube();
    for (uint32_t v = 0; v < 8; v++) {
        m->c.position[v].x *= -1;
    }
    he_measures measures;
    assert_int_equal(he_mesh_measure(m, &measures, NULL), HE_OK);
    assert_true(measures.volume == -8);
    /* A cube that lies far from the origin must have the volume of a cube of its size. */
    for (uint32_t v = 0; v < 8; v++) {
        m->c.position[v].x = 1e9 - m->c.position[v].x;
    }
    assert_int_equal(he_mesh_measure(m, &measures, NULL), HE_OK);
    assert_true(measures.volume == 8 && measures.area == 24);
    he_mesh_free(m);
    m = fixture_mesh("012,034,056");
    assert_int_equal(he_mesh_measure(m, &measures, NULL), HE_OK);
    assert_true(!measures.has_volume && measures.volume == 0 && measures.area > 0);
    he_mesh_free(m);
}

static he_vertex add_vertex(he_mesh *m, double x, double y, double z)
{
    he_vertex v;
    assert_int_equal(he_vertex_add(m, (he_vec3){x, y, z}, &v, NULL), HE_OK);
    return v;
}

static void assert_measures(const he_mesh *m, double area, double volume)
{
    he_measures got;
    assert_int_equal(he_mesh_measure(m, &got, NULL), HE_OK);
    if (got.area != area || got.volume != volume) {
        fail_msg("%.17g and %.17g, not %.17g and %.17g", got.area, got.volume, area, volume);
    }
}

/* coordinates of far vertices */
static const double far_away[] = {1e60, 1e81, 1e108, 1e160, -1e200, 1e300, DBL_MAX};
enum { DISTANCES = sizeof far_away / sizeof *far_away };

static void a_far_vertex_does_not_change_the_area(void **state)
{
    (void)state;
    for (int i = 0; i < DISTANCES; i++) {
        he_mesh *m = cube();
        he_vec3 before[8], after[9];
        assert_int_equal(he_vertex_normals(m, HE_WEIGHT_AREA, NULL, before, NULL), HE_OK);
        add_vertex(m, far_away[i], -far_away[i], 1);
        assert_measures(m, 24, 8);
        assert_int_equal(he_vertex_normals(m, HE_WEIGHT_AREA, NULL, after, NULL), HE_OK);
        assert_memory_equal(after, before, sizeof before);
        he_mesh_free(m);
    }
}

/* The mesh has a component near the origin, and a component far away in which all vertices
 * coincide. The area and the volume of the mesh must be those of the near component. */
static void a_far_face_without_size_does_not_change_area_and_volume(void **state)
{
    (void)state;
    for (int i = 0; i < DISTANCES; i++) {
        for (int first = 0; first < 2; first++) {
            he_mesh *m = fixture_mesh("021,032,013,123,465,476,457,567");
            uint32_t near = first ? 4 : 0, far = 4 - near;
            for (uint32_t k = 0; k < 4; k++) {
                m->c.position[near + k] = (he_vec3){k == 1, k == 2, k == 3};
                m->c.position[far + k] = (he_vec3){far_away[i], far_away[i], -far_away[i]};
            }
            he_measures got;
            assert_int_equal(he_mesh_measure(m, &got, NULL), HE_OK);
            assert_near(got.area, 1.5 + sqrt(3) / 2);
            assert_near(got.volume, 1.0 / 6);
            he_mesh_free(m);
        }
    }
}

/* A tetrahedron with three perpendicular edges of length `leg` has the volume leg^3 / 6, whatever
 * its size. */
static void sizes_in_one_mesh_are_summed_as_far_as_a_double_reaches(void **state)
{
    (void)state;
    static const double legs[] = {1e-100, 1e-60, 0x1p-20, 1, 0x1p70, 1e100, 1e-160, 1e160};
    for (size_t a = 0; a < 8; a++) {
        for (size_t b = 0; b < 8; b++) {
            he_mesh *m = fixture_mesh("021,032,013,123,465,476,457,567");
            for (uint32_t k = 0; k < 4; k++) {
                double p = legs[a], q = legs[b];
                m->c.position[k] = (he_vec3){k == 1 ? p : 0, k == 2 ? p : 0, k == 3 ? p : 0};
                m->c.position[4 + k] = (he_vec3){k == 1 ? q : 0, k == 2 ? q : 0, k == 3 ? q : 0};
            }
            long double p = legs[a], q = legs[b];
            long double area = (1.5L + sqrtl(3) / 2) * (p * p + q * q);
            long double volume = (p * p * p + q * q * q) / 6;
            he_measures got;
            assert_int_equal(he_mesh_measure(m, &got, NULL), HE_OK);
            double wanted = (double)(area < DBL_MAX ? area : DBL_MAX);
            assert_true(fabs(got.area - wanted) <= 1e-14 * wanted);
            wanted = (double)(volume < DBL_MAX ? volume : DBL_MAX);
            assert_true(fabs(got.volume - wanted) <= 1e-14 * wanted);
            he_mesh_free(m);
        }
    }
}

/* The area of a face must not lose digits because the face is far from the origin, even along an
 * axis in which the face has no extent. */
static void a_small_face_far_from_the_origin_has_its_area(void **state)
{
    (void)state;
    static const double legs[] = {1e-150, 1e-100, 1e-70, 0x1p-30, 1e70, 1e150};
    for (int i = 0; i < DISTANCES; i++) {
        for (size_t k = 0; k < 6; k++) {
            he_mesh *m = fixture_mesh("012");
            place(m, 0, 0, 0, far_away[i]);
            place(m, 1, legs[k], 0, far_away[i]);
            place(m, 2, 0, legs[k], far_away[i]);
            he_face_shape shape = he_face_measure(m, (he_face){0});
            double wanted = legs[k] * legs[k] / 2;
            assert_true(fabs(shape.area - wanted) <= 1e-14 * wanted);
            assert_vector(shape.normal, 0, 0, 1);
            assert_measures(m, shape.area, 0);
            he_mesh_free(m);
        }
    }
}

static void volume_is_of_closed_meshes_with_faces_only(void **state)
{
    (void)state;
    he_measures got;
    he_mesh *m = fixture_mesh("");
    assert_int_equal(he_mesh_measure(m, &got, NULL), HE_OK);
    assert_false(got.has_volume);
    add_vertex(m, 1, 2, 3);
    assert_int_equal(he_mesh_measure(m, &got, NULL), HE_OK);
    assert_true(!got.has_volume && got.volume == 0 && got.area == 0);
    he_mesh_free(m);
}

static void an_empty_mesh_and_deleted_elements_have_no_geometry(void **state)
{
    (void)state;
    he_mesh *m = fixture_mesh("");
    he_box box = {{1, 1, 1}, {1, 1, 1}};
    he_measures measures = {1, 1, true};
    assert_false(he_mesh_box(m, &box));
    assert_vector(box.min, 0, 0, 0);
    assert_int_equal(he_mesh_measure(m, &measures, NULL), HE_OK);
    assert_true(measures.area == 0 && measures.volume == 0 && !measures.has_volume);
    he_mesh_free(m);
    m = query_with_dead_rows();
    place(m, 3, -100, 0, 0);
    he_vec3 normals[8];
    assert_true(he_mesh_box(m, &box));
    assert_true(box.min.x == -100);
    assert_int_equal(he_face_normals(m, NULL, normals, NULL), HE_OK);
    assert_true(he_vec3_extent(normals[1]) == 0);
    assert_int_equal(he_vertex_normals(m, HE_WEIGHT_ANGLE, NULL, normals, NULL), HE_OK);
    assert_near(he_vec3_length(normals[0]), 1);
    for (uint32_t v = 3; v < 7; v++) {
        assert_true(he_vec3_extent(normals[v]) == 0);
    }
    assert_false(he_vertex_normal(m, (he_vertex){3}, HE_WEIGHT_AREA, normals));
    he_mesh_free(m);
}

static void geometry_ends_on_broken_links(void **state)
{
    (void)state;
    uint64_t seed = 9;
    int corrupt = 0;
    for (int round = 0; round < 3000; round++) {
        he_mesh *m = fixture_mesh(query_specimens[query_random(&seed) % QUERY_SPECIMENS]);
        for (uint64_t n = 1 + query_random(&seed) % 3; n > 0; n--) {
            query_spoil(m, &seed);
        }
        he_vec3 normals[16];
        he_measures measures;
        he_status got[4];
        he_error err = {0};
        got[0] = he_face_normals(m, NULL, normals, &err);
        got[1] = he_vertex_normals(m, HE_WEIGHT_AREA, NULL, normals, &err);
        got[2] = he_vertex_normals(m, HE_WEIGHT_ANGLE, NULL, normals, &err);
        got[3] = he_mesh_measure(m, &measures, &err);
        for (int i = 0; i < 4; i++) {
            assert_true(got[i] == HE_OK || got[i] == HE_CORRUPT);
            corrupt += got[i] == HE_CORRUPT;
        }
        he_mesh_free(m);
    }
    assert_true(corrupt > 1000);
    /* The links of the mesh are broken: following the half-edges of one face, or turning around one
     * vertex, never comes back to the beginning. */
    he_mesh *m = fixture_mesh("0123,7654,1045,2156,3267,0374");
    m->c.next[4] = 2;
    m->c.prev[8] = 8 ^ 1;
    he_vec3 normal;
    he_face_measure(m, (he_face){0});
    he_face_normal(m, (he_face){0}, &normal);
    for (uint32_t v = 0; v < 8; v++) {
        he_vertex_normal(m, (he_vertex){v}, HE_WEIGHT_AREA, &normal);
        assert_true(finite_and_at_most_one(normal));
    }
    he_mesh_free(m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_cube_has_its_known_areas_angles_normals_and_volume),
        cmocka_unit_test(normals_of_vertices_depend_on_their_weights),
        cmocka_unit_test(dihedral_angles_tell_ridges_from_valleys),
        cmocka_unit_test(dihedrals_of_a_mesh_are_those_of_its_edges_one_by_one),
        cmocka_unit_test(dihedrals_measure_a_face_of_many_corners_once),
        cmocka_unit_test(dihedrals_are_refused_where_memory_is_out),
        cmocka_unit_test(angle_defects_sum_to_two_pi_euler),
        cmocka_unit_test(a_degenerate_face_has_no_normal),
        cmocka_unit_test(geometry_does_not_depend_on_scale),
        cmocka_unit_test(geometry_of_extreme_coordinates_is_finite),
        cmocka_unit_test(geometry_of_a_whole_mesh_agrees_with_single_elements),
        cmocka_unit_test(volumes_agree_with_a_sum_of_tetrahedra_and_have_a_sign),
        cmocka_unit_test(a_far_vertex_does_not_change_the_area),
        cmocka_unit_test(a_far_face_without_size_does_not_change_area_and_volume),
        cmocka_unit_test(sizes_in_one_mesh_are_summed_as_far_as_a_double_reaches),
        cmocka_unit_test(a_small_face_far_from_the_origin_has_its_area),
        cmocka_unit_test(volume_is_of_closed_meshes_with_faces_only),
        cmocka_unit_test(an_empty_mesh_and_deleted_elements_have_no_geometry),
        cmocka_unit_test(geometry_ends_on_broken_links),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
