/* The arrays of triangles that clients draw are compared with the polygons from which they are
 * made. */
#include "query_specimens.h"

#include "draw/draw_arrays.h"
#include "edit/local/vertex.h"
#include "geometry/geometry.h"
#include "geometry/triangulation.h"
#include "tests/failing.h"

#include <float.h>
#include <math.h>

typedef struct row {
    uint32_t corner[3], face, sides;
} row;

typedef struct rows {
    row *row;
    uint32_t count;
} rows;

static rows draw(const he_mesh *m, he_frame *frame)
{
    he_draw_arrays d;
    uint32_t words[HE_DRAWN_ROW], most = 2 * m->c.edges.live - m->c.boundary_halfedges;
    rows all = {calloc(most + 1, sizeof *all.row), 0};
    he_frame own = he_frame_of(m);
    assert_non_null(all.row);
    assert_int_equal(he_draw_arrays_init(&d, m, &own, NULL), HE_OK);
    for (uint32_t f = 0; f < m->c.faces.issued; f++) {
        he_draw_arrays_walk walk = {0};
        if (he_face_is_live(m, (he_face){f})) {
            he_draw_arrays_begin(&d, f, &walk);
        }
        while (he_draw_arrays_next(&d, &walk, words)) {
            assert_true(all.count < most);
            row *r = &all.row[all.count++];
            memcpy(r->corner, words, sizeof r->corner);
            r->face = words[3] & ((1u << HE_DRAWN_SIDES) - 1);
            r->sides = words[3] >> HE_DRAWN_SIDES;
        }
    }
    assert_int_equal(all.count, most - 2 * m->c.faces.live);
    if (frame != NULL) {
        *frame = own;
    }
    he_draw_arrays_clear(&d);
    return all;
}

static he_vec3 area_vector(const he_mesh *m, const row *r)
{
    he_vec3 a = m->c.position[r->corner[0]], b = m->c.position[r->corner[1]];
    he_vec3 c = m->c.position[r->corner[2]];
    return he_vec3_scale(he_vec3_cross(he_vec3_sub(b, a), he_vec3_sub(c, a)), 0.5);
}

/* Returns whether the face has a side from vertex `from` to vertex `to`. The function walks around
 * the face to find the side. */
static bool is_side(const he_mesh *m, uint32_t face, uint32_t from, uint32_t to)
{
    uint32_t first = m->c.face_halfedge[face], h = first;
    do {
        if (m->c.origin[h] == from && m->c.origin[h ^ 1] == to) {
            return true;
        }
        h = m->c.next[h];
    } while (h != first);
    return false;
}

/* Checks the triangles of one face. There must be two fewer than the face has corners. Each side of
 * the face must occur once, in its own direction, and be marked as a side; each diagonal must occur
 * once in either direction and not be marked. */
static void check_face(const he_mesh *m, uint32_t face, const row *r, uint32_t count)
{
    uint32_t degree = he_face_degree(m, (he_face){face}), marked = 0;
    assert_int_equal(count, degree - 2);
    for (uint32_t i = 0; i < 3 * count; i++) {
        uint32_t from = r[i / 3].corner[i % 3], to = r[i / 3].corner[(i + 1) % 3];
        bool side = (r[i / 3].sides >> (i % 3) & 1) != 0;
        uint32_t same = 0, back = 0;
        for (uint32_t k = 0; k < 3 * count; k++) {
            uint32_t a = r[k / 3].corner[k % 3], b = r[k / 3].corner[(k + 1) % 3];
            same += a == from && b == to;
            back += a == to && b == from;
        }
        assert_int_equal(side, is_side(m, face, from, to));
        assert_int_equal(same, 1);
        assert_int_equal(back, side ? 0 : 1);
        marked += side;
    }
    assert_int_equal(marked, degree);
}

/* What a test requires of the triangles of each face. OUTLINED: the sides of the face are right.
 * SUMMED: the area vectors of the triangles also add up to that of the face. COVERED: the areas of
 * the triangles also add up to that of the face, as they must if the face is planar and does not
 * cross itself. */
typedef enum promise { OUTLINED, SUMMED, COVERED } promise;

static void check_drawing(const he_mesh *m, promise promised)
{
    rows all = draw(m, NULL);
    uint32_t at = 0;
    for (uint32_t f = 0; f < m->c.faces.issued; f++) {
        if (!he_face_is_live(m, (he_face){f})) {
            continue;
        }
        uint32_t begin = at;
        he_vec3 sum = {0, 0, 0};
        double area = 0;
        for (; at < all.count && all.row[at].face == f; at++) {
            he_vec3 vector = area_vector(m, &all.row[at]);
            sum = he_vec3_add(sum, vector);
            area += he_vec3_length(vector);
        }
        check_face(m, f, all.row + begin, at - begin);
        double whole = he_face_area(m, (he_face){f});
        if (promised >= SUMMED && fabs(he_vec3_length(sum) - whole) > 1e-9 * (area + whole)) {
            fail_msg("face %u: triangles of %g, not %g", f, he_vec3_length(sum), whole);
        }
        if (promised >= COVERED && fabs(area - whole) > 1e-9 * whole) {
            fail_msg("face %u: triangles cover %.17g, not %.17g", f, area, whole);
        }
    }
    assert_int_equal(at, all.count);
    free(all.row);
}

static void check_vertices(const he_mesh *m)
{
    he_draw_arrays d;
    he_frame own = he_frame_of(m);
    assert_int_equal(he_draw_arrays_init(&d, m, &own, NULL), HE_OK);
    for (uint32_t v = 0; v < m->c.vertices.issued; v++) {
        float drawn[HE_DRAWN_ROW];
        he_draw_arrays_vertex(&d, v, drawn);
        if (!he_vertex_is_live(m, (he_vertex){v})) {
            assert_true(drawn[0] == 0 && drawn[1] == 0 && drawn[2] == 0 &&
                        drawn[3] == HE_DRAWN_DEAD);
            continue;
        }
        bool alone = he_is_isolated(m, (he_vertex){v});
        assert_true(drawn[3] == (alone ? HE_DRAWN_ISOLATED : HE_DRAWN_USED));
        double r2 = 0, p[3] = {m->c.position[v].x, m->c.position[v].y, m->c.position[v].z};
        double origin[3] = {d.frame.origin.x, d.frame.origin.y, d.frame.origin.z};
        for (int i = 0; i < 3; i++) {
            double wanted = p[i] * d.frame.scale - origin[i] * d.frame.scale;
            assert_true(fabs(drawn[i] - wanted) <= 1e-7);
            r2 += wanted * wanted;
        }
        assert_true(r2 <= 1);
    }
    he_draw_arrays_clear(&d);
}

static void add_vertex(he_mesh *m, he_vec3 at)
{
    he_vertex v;
    assert_int_equal(he_vertex_add(m, at, &v, NULL), HE_OK);
}

static void a_far_isolated_vertex_leaves_the_frame_alone(void **state)
{
    (void)state;
    static const he_vec3 far[] = {{1e100, 0, 0}, {-1.7e308, 1.7e308, 0}, {0, 0, -1e6}};
    he_mesh *m = fixture_mesh(query_specimens[2]);
    const he_frame own = he_frame_of(m);
    uint32_t first = m->c.vertices.issued;
    for (size_t i = 0; i < sizeof far / sizeof *far; i++) {
        add_vertex(m, far[i]);
    }
    const he_frame with = he_frame_of(m);
    assert_memory_equal(&with, &own, sizeof own);
    he_draw_arrays d;
    assert_int_equal(he_draw_arrays_init(&d, m, &own, NULL), HE_OK);
    for (uint32_t v = 0; v < m->c.vertices.issued; v++) {
        float drawn[HE_DRAWN_ROW];
        he_draw_arrays_vertex(&d, v, drawn);
        double length = sqrt((double)drawn[0] * drawn[0] + (double)drawn[1] * drawn[1] +
                             (double)drawn[2] * drawn[2]);
        assert_true(v < first ? length <= 1 : fabs(length - 1) < 1e-6);
        assert_true(v < first || drawn[3] == HE_DRAWN_ISOLATED);
    }
    float drawn[HE_DRAWN_ROW];
    he_draw_arrays_vertex(&d, first + 1, drawn);
    assert_true(drawn[0] < -0.7F && drawn[1] > 0.7F);
    he_draw_arrays_clear(&d);
    he_mesh_free(m);
}

static void an_isolated_vertex_that_is_near_is_drawn_where_it_is(void **state)
{
    (void)state;
    he_mesh *m = fixture_mesh(query_specimens[2]);
    he_box box;
    assert_true(he_surface_box(m, &box));
    double side = he_vec3_extent(he_vec3_sub(box.max, box.min));
    add_vertex(m, he_vec3_add(box.max, (he_vec3){500 * side, 0, 0}));
    check_vertices(m);
    he_mesh_free(m);
}

static void triangles_of_a_face_sum_up_to_its_area(void **state)
{
    (void)state;
    for (int i = 0; i < QUERY_SPECIMENS; i++) {
        he_mesh *m = fixture_mesh(query_specimens[i]);
        check_drawing(m, SUMMED);
        check_vertices(m);
        he_mesh_free(m);
    }
}

static void triangles_cover_the_faces_of_shapes_exactly(void **state)
{
    (void)state;
    static const struct {
        const char *name;
        double a, b, c, d;
    } shapes[] = {
        {"cube", 2, 0, 0, 0},     {"icosphere", 2, 1, 0, 0},  {"dodecahedron", 1, 0, 0, 0},
        {"torus", 12, 9, 2, 0.5}, {"cylinder", 9, 1, 2, 0},   {"cylinder", 9, 1, 2, 1},
        {"cone", 9, 1, 2, 1},     {"uv_sphere", 12, 9, 1, 0}, {"grid", 5, 4, 2, 1},
        {"disk", 9, 1, 0, 0},     {"polygon", 100, 1, 0, 0}};
    for (size_t i = 0; i < sizeof shapes / sizeof *shapes; i++) {
        /* All faces of the tested shapes are planar, even the quadrilaterals of the torus and the
         * sphere. */
        he_mesh *m =
            query_shape(shapes[i].name, shapes[i].a, shapes[i].b, shapes[i].c, shapes[i].d);
        check_drawing(m, COVERED);
        check_vertices(m);
        he_mesh_free(m);
    }
}

/* --- polygons in space --- */

typedef struct polygon {
    double (*point)[2];
    uint32_t n;
} polygon;

/* Makes one face in a slanted plane. Corner `turn` of the polygon becomes the face's first corner,
 * coordinates are multiplied by `size`, and the face is moved away from the origin by `away`. */
static he_mesh *face_of(const polygon *p, uint32_t turn, double size, double away)
{
    he_soup soup;
    he_mesh *m = NULL;
    he_soup_init(&soup, NULL);
    for (uint32_t i = 0; i < p->n; i++) {
        double x = p->point[i][0] * size, y = p->point[i][1] * size;
        he_vec3 at = {away + 0.6 * x, away + y, away - 0.8 * x};
        assert_int_equal(he_soup_add_vertex(&soup, at, NULL), HE_OK);
    }
    assert_int_equal(he_soup_begin_face(&soup, NULL), HE_OK);
    for (uint32_t i = 0; i < p->n; i++) {
        assert_int_equal(he_soup_add_corner(&soup, (i + turn) % p->n, NULL), HE_OK);
    }
    assert_int_equal(he_build(&soup, HE_BUILD_TAKE, &m, NULL, NULL), HE_OK);
    he_soup_clear(&soup);
    return m;
}

static void triangles_cover_concave_faces_from_every_first_corner(void **state)
{
    (void)state;
    static double arrow[][2] = {{0, 0}, {4, 2}, {0, 4}, {1, 2}};
    static double ell[][2] = {{0, 0}, {4, 0}, {4, 1}, {1, 1}, {1, 4}, {0, 4}};
    static double star[][2] = {{3, 0},  {0.9, 0.6},   {0.9, 2.9}, {-0.4, 1},   {-2.4, 1.8},
                               {-1, 0}, {-2.4, -1.8}, {-0.4, -1}, {0.9, -2.9}, {0.9, -0.6}};
    static double flat[][2] = {{0, 0}, {1, 0}, {2, 0}, {3, 0}, {3, 1}, {3, 2}, {0, 2}, {0, 1}};
    static double spiral[][2] = {{0, 0}, {6, 0}, {6, 6}, {0, 6}, {0, 2},   {4, 2},
                                 {4, 4}, {2, 4}, {2, 3}, {3, 3}, {3, 2.5}, {1, 2.5},
                                 {1, 5}, {5, 5}, {5, 1}, {0, 1}};
    const polygon polygons[] = {{arrow, 4}, {ell, 6}, {star, 10}, {flat, 8}, {spiral, 16}};
    for (size_t i = 0; i < sizeof polygons / sizeof *polygons; i++) {
        for (uint32_t turn = 0; turn < polygons[i].n; turn++) {
            static const double sizes[] = {1, 1e-70, 1e70, 0x1p-40};
            for (size_t k = 0; k < sizeof sizes / sizeof *sizes; k++) {
                he_mesh *m = face_of(&polygons[i], turn, sizes[k], 0);
                check_drawing(m, COVERED);
                check_vertices(m);
                he_mesh_free(m);
            }
            he_mesh *m = face_of(&polygons[i], turn, 1, 1024);
            check_drawing(m, COVERED);
            check_vertices(m);
            he_mesh_free(m);
        }
    }
}

/* The polygons are star-shaped around the origin (each corner is visible from there), so they do
 * not cross themselves. */
static void triangles_cover_random_polygons_exactly(void **state)
{
    (void)state;
    uint64_t seed = 20261121;
    static const uint32_t sizes[] = {4, 5, 6, 9, 20, 63, 64, 65, 100, 300};
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        for (int round = 0; round < 4; round++) {
            double point[300][2];
            for (uint32_t k = 0; k < sizes[i]; k++) {
                double angle = 2 * acos(-1) * k / sizes[i];
                double radius = 1 + (double)(query_random(&seed) % 1000) / 100;
                point[k][0] = radius * cos(angle);
                point[k][1] = radius * sin(angle);
            }
            he_mesh *m = face_of(&(polygon){point, sizes[i]}, 0, 1, 0);
            check_drawing(m, COVERED);
            he_mesh_free(m);
        }
    }
}

/* The corners lie in a line or in one point, or the sides cross each other: even then each face
 * must have two triangles fewer than corners. */
static void faces_without_a_plane_have_all_their_triangles(void **state)
{
    (void)state;
    static double line[][2] = {{0, 0}, {1, 0}, {2, 0}, {3, 0}, {4, 0}, {5, 0}};
    static double point[][2] = {{1, 1}, {1, 1}, {1, 1}, {1, 1}, {1, 1}};
    static double pentagram[][2] = {{0, 3}, {-2, -3}, {3, 1}, {-3, 1}, {2, -3}};
    static double eight[][2] = {{0, 0}, {2, 2}, {2, 0}, {0, 2}};
    const polygon polygons[] = {{line, 6}, {point, 5}, {pentagram, 5}, {eight, 4}};
    for (size_t i = 0; i < sizeof polygons / sizeof *polygons; i++) {
        he_mesh *m = face_of(&polygons[i], 0, 1, 0);
        check_drawing(m, OUTLINED);
        check_vertices(m);
        he_mesh_free(m);
    }
}

static void triangles_cover_a_comb_of_20000_teeth_in_linear_time(void **state)
{
    (void)state;
    enum { TEETH = 20000, N = 2 * TEETH + 2 };
    double(*point)[2] = calloc(N, sizeof *point);
    assert_non_null(point);
    point[1][0] = 2 * TEETH;
    for (int i = 0; i < 2 * TEETH; i++) {
        point[i + 2][0] = 2 * TEETH - i;
        point[i + 2][1] = i % 2 == 0 ? 1 : 100;
    }
    he_mesh *m = face_of(&(polygon){point, N}, 0, 1, 0);
    rows all = draw(m, NULL);
    assert_int_equal(all.count, N - 2);
    double area = 0;
    for (uint32_t i = 0; i < all.count; i++) {
        area += he_vec3_length(area_vector(m, &all.row[i]));
    }
    double whole = he_face_area(m, (he_face){0});
    assert_true(fabs(area - whole) < 1e-9 * whole);
    free(all.row);
    /* The estimated work for one large face must be proportional to the number of its corners, not
     * to the square of this number. */
    const uint32_t face = 0;
    he_frame frame = he_frame_of(m);
    he_draw_arrays d;
    uint64_t cost = (uint64_t)HE_EXACT_CORNERS * N;
    assert_int_equal(he_draw_arrays_init_faces(&d, m, &frame, &face, 1, cost - 1, NULL), HE_LIMIT);
    assert_int_equal(he_draw_arrays_init_faces(&d, m, &frame, &face, 1, cost, NULL), HE_OK);
    he_draw_arrays_clear(&d);
    free(point);
    he_mesh_free(m);
}

/* --- meshes with deleted elements, and changes of some elements that leave others unchanged --- */

static void deleted_elements_are_not_drawn(void **state)
{
    (void)state;
    he_mesh *m = query_with_dead_rows();
    check_drawing(m, SUMMED);
    check_vertices(m);
    rows all = draw(m, NULL);
    assert_int_equal(all.count, 1);
    free(all.row);
    he_mesh_free(m);
}

static void moving_a_vertex_changes_only_faces_at_it(void **state)
{
    (void)state;
    he_mesh *m = query_shape("grid", 6, 6, 1, 1);
    he_frame before, after;
    rows old = draw(m, &before);
    uint32_t moved = 24; /* the vertex in the middle of the grid, which the test moves */
    assert_int_equal(he_vertex_degree(m, (he_vertex){moved}), 4);
    m->c.position[moved].x += 0.1;
    m->c.position[moved].y += 0.12;
    rows new = draw(m, &after);
    assert_memory_equal(&before, &after, sizeof before);
    assert_int_equal(old.count, new.count);
    uint32_t changed = 0;
    for (uint32_t i = 0; i < new.count; i++) {
        bool at = false;
        for (uint32_t h = 2 * m->c.edges.issued; h-- > 0;) {
            at = at || (m->c.face[h] == new.row[i].face && m->c.origin[h] == moved);
        }
        if (memcmp(&old.row[i], &new.row[i], sizeof(row)) != 0) {
            assert_true(at);
            changed++;
        }
    }
    assert_true(changed > 0);
    free(old.row);
    free(new.row);
    he_mesh_free(m);
}

static void a_frame_fits_the_mesh_closely_at_any_scale(void **state)
{
    (void)state;
    static const double low[][3] = {{0, 0, 0},       {-DBL_MAX, -1, 0},       {1e300, 0, 0},
                                    {5e-324, 0, 0},  {1e15, 1e15, 1e15},      {-1, -1, -1},
                                    {DBL_MAX, 0, 0}, {-DBL_MAX, -DBL_MAX, 0}, {7, 7, 7}};
    static const double high[][3] = {{0, 0, 1},       {DBL_MAX, 1, 0},        {1e300, 1e-300, 0},
                                     {0, 5e-324, 0},  {1e15 + 1, 1e15, 1e15}, {1, 1, 1},
                                     {DBL_MAX, 0, 0}, {DBL_MAX, DBL_MAX, 0},  {7, 7, 7}};
    for (size_t i = 0; i < sizeof low / sizeof *low; i++) {
        he_mesh *m = fixture_mesh("012");
        m->c.position[0] = (he_vec3){low[i][0], low[i][1], low[i][2]};
        m->c.position[1] = m->c.position[0];
        m->c.position[2] = (he_vec3){high[i][0], high[i][1], high[i][2]};
        check_vertices(m);
        he_frame frame = he_frame_of(m);
        int exponent;
        assert_true(frexp(frame.scale, &exponent) == 0.5);
        assert_true(he_vec3_is_finite(frame.origin));
        he_mesh_free(m);
    }
    /* The drawn coordinates lose precision if the frame is much larger than the mesh: the mesh must
     * fill a reasonable part of the frame's width. */
    he_mesh *m = query_shape("cube", 3.7, 0, 0, 0);
    he_frame frame = he_frame_of(m);
    assert_true(3.7 * frame.scale >= 0.5);
    he_mesh_free(m);
}

static void a_drawing_without_memory_is_refused(void **state)
{
    (void)state;
    static double ell[][2] = {{0, 0}, {4, 0}, {4, 1}, {1, 1}, {1, 4}, {0, 4}};
    he_mesh *m = face_of(&(polygon){ell, 6}, 1, 1, 0);
    he_frame frame = he_frame_of(m);
    failing f = {0};
    while (failing_next(&f)) {
        he_draw_arrays d;
        he_error err = {0};
        if (failing_status(&f, he_draw_arrays_init(&d, m, &frame, &err))) {
            he_draw_arrays_clear(&d);
        } else {
            assert_int_equal(err.status, HE_NO_MEMORY);
        }
    }
    assert_true(f.n > 3);
    he_mesh_free(m);
}

/* A single face must get the triangles that it has in the arrays of all faces. If the work exceeds
 * a limit, the function must refuse before the work begins. */
static void a_face_alone_has_the_triangles_it_has_among_all(void **state)
{
    (void)state;
    static double ell[][2] = {{0, 0}, {4, 0}, {4, 1}, {1, 1}, {1, 4}, {0, 4}};
    he_mesh *m = face_of(&(polygon){ell, 6}, 1, 1, 0);
    he_frame frame = he_frame_of(m);
    rows all = draw(m, NULL);
    const uint32_t face = 0;
    he_draw_arrays d;
    he_draw_arrays_walk walk;
    uint32_t words[HE_DRAWN_ROW];
    assert_int_equal(he_draw_arrays_init_faces(&d, m, &frame, &face, 1, 35, NULL), HE_LIMIT);
    assert_int_equal(he_draw_arrays_init_faces(&d, m, &frame, &face, 1, 36, NULL), HE_OK);
    he_draw_arrays_begin(&d, face, &walk);
    for (uint32_t i = 0; i < all.count; i++) {
        assert_true(he_draw_arrays_next(&d, &walk, words));
        assert_memory_equal(words, all.row[i].corner, sizeof all.row[i].corner);
    }
    assert_false(he_draw_arrays_next(&d, &walk, words));
    he_draw_arrays_clear(&d);
    free(all.row);
    he_mesh_free(m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(triangles_of_a_face_sum_up_to_its_area),
        cmocka_unit_test(a_far_isolated_vertex_leaves_the_frame_alone),
        cmocka_unit_test(an_isolated_vertex_that_is_near_is_drawn_where_it_is),
        cmocka_unit_test(triangles_cover_the_faces_of_shapes_exactly),
        cmocka_unit_test(triangles_cover_concave_faces_from_every_first_corner),
        cmocka_unit_test(triangles_cover_random_polygons_exactly),
        cmocka_unit_test(faces_without_a_plane_have_all_their_triangles),
        cmocka_unit_test(triangles_cover_a_comb_of_20000_teeth_in_linear_time),
        cmocka_unit_test(deleted_elements_are_not_drawn),
        cmocka_unit_test(moving_a_vertex_changes_only_faces_at_it),
        cmocka_unit_test(a_frame_fits_the_mesh_closely_at_any_scale),
        cmocka_unit_test(a_face_alone_has_the_triangles_it_has_among_all),
        cmocka_unit_test(a_drawing_without_memory_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
