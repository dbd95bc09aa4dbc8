/* Decimation: what is kept exactly, how far surfaces go apart, where it ends. */
#include "tests/unit/fixture.h"

#include "algo/decimate.h"
#include "algo/progressive.h"
#include "algo/shape.h"
#include "edit/triangulate.h"
#include "mesh/marks.h"
#include "mesh/write.h"
#include "query/bvh.h"
#include "query/geometry.h"
#include "query/vec3.h"

#include <float.h>
#include <math.h>

static const he_decimate_options all = {0, INFINITY, 100};

static he_decimated decimate(he_mesh *m, uint32_t faces, double max_error)
{
    he_decimate_options options = {faces, max_error, 100};
    he_decimated out = {HE_STOP_COUNT, -1};
    he_error err = {0};
    if (he_decimate(m, &options, &out, &err) != HE_OK) {
        fail_msg("%s", err.text);
    }
    fixture_check(m);
    return out;
}

/* --- meshes --- */

static he_mesh *built(he_soup *soup)
{
    he_mesh *m = NULL;
    he_error err = {0};
    if (he_build(soup, HE_BUILD_TAKE, &m, NULL, &err) != HE_OK) {
        fail_msg("%s", err.text);
    }
    he_soup_clear(soup);
    return m;
}

static uint32_t add_vertex(he_soup *soup, double x, double y, double z)
{
    assert_int_equal(he_soup_add_vertex(soup, (he_vec3){x, y, z}, NULL), HE_OK);
    return (uint32_t)soup->vertex_count - 1;
}

static void add_triangle(he_soup *soup, uint32_t a, uint32_t b, uint32_t c)
{
    const uint32_t corners[3] = {a, b, c};
    assert_int_equal(he_soup_add_face(soup, corners, 3, NULL), HE_OK);
}

/* side by side cells of two triangles; row by row, z by `height`. */
static he_mesh *grid(uint32_t side, double (*height)(double x, double y), double scale)
{
    he_soup soup;
    he_soup_init(&soup, NULL);
    uint32_t across = side + 1;
    for (uint32_t i = 0; i < across * across; i++) {
        uint32_t column = i % across, row = i / across;
        double x = column, y = row;
        double z = height != NULL ? height(x / side, y / side) * side : 0;
        (void)add_vertex(&soup, x * scale, y * scale, z * scale);
    }
    for (uint32_t i = 0; i < side * side; i++) {
        uint32_t v = i / side * across + i % side;
        add_triangle(&soup, v, v + 1, v + across + 1);
        add_triangle(&soup, v, v + across + 1, v + across);
    }
    return built(&soup);
}

static he_mesh *torus(uint32_t side)
{
    he_soup soup;
    he_soup_init(&soup, NULL);
    const double turn = 6.283185307179586 / side;
    for (uint32_t i = 0; i < side * side; i++) {
        uint32_t around = i / side, across = i % side;
        double a = turn * around, b = turn * across, r = 3 + cos(b) + 0.1 * sin(9 * a);
        (void)add_vertex(&soup, r * cos(a), r * sin(a), sin(b));
    }
    for (uint32_t i = 0; i < side; i++) {
        for (uint32_t j = 0; j < side; j++) {
            uint32_t here = i * side, down = (i + 1) % side * side, right = (j + 1) % side;
            add_triangle(&soup, here + j, down + j, down + right);
            add_triangle(&soup, here + j, down + right, here + right);
        }
    }
    return built(&soup);
}

/* A shape of the table, in triangles. */
static he_mesh *shape(const char *name, const char *param, double value)
{
    const he_shape *s = he_shape_find(name, strlen(name));
    assert_non_null(s);
    double args[HE_SHAPE_PARAMS];
    he_shape_defaults(s, args);
    for (size_t i = 0; i < he_shape_params(s); i++) {
        if (param != NULL && strcmp(s->params[i].name, param) == 0) {
            args[i] = value;
        }
    }
    he_soup soup;
    assert_int_equal(he_shape_make(s, args, NULL, &soup, NULL), HE_OK);
    he_mesh *m = built(&soup);
    assert_int_equal(he_triangulate(m, NULL, NULL, NULL, NULL), HE_OK);
    return m;
}

/* The six sides of a cube of edge `side`, each of side by side cells. */
static he_mesh *cube(uint32_t side)
{
    he_soup soup;
    he_soup_init(&soup, NULL);
    uint32_t across = side + 1, *at = calloc((size_t)across * across * across, sizeof *at);
    assert_non_null(at);
    for (uint32_t i = 0; i < across * across * across; i++) {
        uint32_t x = i % across, y = i / across % across, z = i / across / across;
        bool outside = x == 0 || y == 0 || z == 0 || x == side || y == side || z == side;
        at[i] = outside ? add_vertex(&soup, x, y, z) : HE_NONE;
    }
    for (unsigned axis = 0; axis < 3; axis++) {
        const uint32_t step[3] = {1, across, across * across};
        uint32_t u = step[(axis + 1) % 3], v = step[(axis + 2) % 3];
        for (uint32_t cell = 0; cell < 2 * side * side; cell++) {
            bool far = cell >= side * side;
            uint32_t i = cell % side, j = cell / side % side;
            uint32_t a = i * u + j * v + (far ? side * step[axis] : 0);
            const uint32_t q[4] = {at[a], at[a + u], at[a + u + v], at[a + v]};
            add_triangle(&soup, q[0], q[far ? 1 : 2], q[far ? 2 : 1]);
            add_triangle(&soup, q[0], q[far ? 2 : 3], q[far ? 3 : 2]);
        }
    }
    free(at);
    return built(&soup);
}

static he_mesh *copy_of(const he_mesh *m)
{
    he_mesh *copy = NULL;
    assert_int_equal(he_mesh_copy(m, &copy, NULL), HE_OK);
    return copy;
}

/* --- measures --- */

static bool is_in(const double *values, size_t count, double value)
{
    size_t i = 0;
    while (i < count && values[i] != value) {
        i++;
    }
    return i < count;
}

static he_vec3 corner(const he_mesh *m, uint32_t f, unsigned i)
{
    he_halfedge h = he_face_halfedge(m, (he_face){f});
    for (; i > 0; i--) {
        h = he_next(m, h);
    }
    return he_position(m, he_origin(m, h));
}

static he_vec3 area_of(const he_mesh *m, uint32_t f)
{
    he_vec3 a = corner(m, f, 0);
    return he_vec3_scale(
        he_vec3_cross(he_vec3_sub(corner(m, f, 1), a), he_vec3_sub(corner(m, f, 2), a)), 0.5);
}

static double volume_of(const he_mesh *m)
{
    double sum = 0;
    for (uint32_t f = 0; f < he_mesh_issued(m, HE_FACE); f++) {
        if (he_mesh_is_live(m, HE_FACE, f)) {
            sum +=
                he_vec3_dot(corner(m, f, 0), he_vec3_cross(corner(m, f, 1), corner(m, f, 2))) / 6;
        }
    }
    return sum;
}

typedef struct apart {
    double farthest, root_mean_square;
    uint32_t turned; /* samples whose face looks away from where the nearest one looks */
} apart;

/* From 16 points in each face of `from` to the nearest of `to`. */
static apart measure(const he_mesh *from, const he_mesh *to)
{
    he_bvh *tree = NULL;
    assert_int_equal(he_bvh_new(to, NULL, &tree, NULL), HE_OK);
    apart out = {0, 0, 0};
    double squares = 0, weights = 0;
    for (uint32_t f = 0; f < he_mesh_issued(from, HE_FACE); f++) {
        if (!he_mesh_is_live(from, HE_FACE, f)) {
            continue;
        }
        he_vec3 a = corner(from, f, 0), b = corner(from, f, 1), c = corner(from, f, 2);
        he_vec3 area = area_of(from, f);
        for (unsigned i = 0; i < 16; i++) {
            unsigned row = i / 4;
            double u = (i % 4 + 0.5) / 4, v = (row + 0.5) / 4;
            if (u + v > 1) {
                u = 1 - u;
                v = 1 - v;
            }
            he_vec3 p = he_vec3_add(he_vec3_scale(a, 1 - u - v),
                                    he_vec3_add(he_vec3_scale(b, u), he_vec3_scale(c, v)));
            uint64_t budget = UINT64_MAX;
            he_hit hit;
            assert_int_equal(he_bvh_closest(tree, to, p, HUGE_VAL, &budget, &hit, NULL), HE_OK);
            out.farthest = fmax(out.farthest, hit.distance);
            squares += hit.distance * hit.distance * he_vec3_length(area);
            weights += he_vec3_length(area);
            out.turned += he_vec3_dot(area, area_of(to, hit.face)) <= 0;
        }
    }
    out.root_mean_square = sqrt(squares / weights);
    he_bvh_free(tree);
    return out;
}

/* --- exact ones --- */

static void a_flat_grid_becomes_two_triangles(void **state)
{
    (void)state;
    static const uint32_t sides[] = {1, 2, 3, 8, 20};
    for (size_t i = 0; i < sizeof sides / sizeof *sides; i++) {
        double side = sides[i];
        he_mesh *m = grid(sides[i], NULL, 1);
        he_decimated done = decimate(m, 0, 0);
        assert_int_equal(done.stop, HE_STOP_ERROR);
        assert_true(done.error == 0);
        fixture_counts(m, 4, 5, 2);
        for (uint32_t v = 0; v < he_mesh_issued(m, HE_VERTEX); v++) {
            he_vec3 p = he_position(m, (he_vertex){v});
            if (he_mesh_is_live(m, HE_VERTEX, v)) {
                assert_true((p.x == 0 || p.x == side) && (p.y == 0 || p.y == side) && p.z == 0);
            }
        }
        he_mesh_free(m);
    }
}

static void a_cube_keeps_its_corners_and_its_volume(void **state)
{
    (void)state;
    he_mesh *m = cube(10);
    fixture_check(m);
    assert_true(fabs(volume_of(m) - 1000) < 1e-9);
    he_decimated done = decimate(m, 0, 1e-9);
    assert_int_equal(done.stop, HE_STOP_ERROR);
    assert_true(done.error == 0);
    fixture_counts(m, 8, 18, 12);
    assert_true(fabs(volume_of(m) - 1000) < 1e-9);
    static const double ends[2] = {0, 10};
    for (uint32_t v = 0; v < he_mesh_issued(m, HE_VERTEX); v++) {
        he_vec3 p = he_position(m, (he_vertex){v});
        if (he_mesh_is_live(m, HE_VERTEX, v)) {
            assert_true(is_in(ends, 2, p.x) && is_in(ends, 2, p.y) && is_in(ends, 2, p.z));
        }
    }
    he_mesh_free(m);
}

static void nothing_happens_where_there_are_few_enough(void **state)
{
    (void)state;
    he_mesh *m = torus(10), *before = copy_of(m);
    he_decimated done = decimate(m, 200, INFINITY);
    assert_int_equal(done.stop, HE_STOP_FACES);
    assert_true(done.error == 0);
    assert_true(he_mesh_equal(m, before));
    he_mesh_free(before);
    he_mesh_free(m);
}

/* --- how far apart --- */

/* Asked for so much that it would replace the mesh, and allowed nothing. */
static void nothing_is_recorded_where_no_edge_may_go(void **state)
{
    (void)state;
    he_mesh *m = torus(104), *before = copy_of(m);
    he_delta *delta = he_delta_new();
    assert_non_null(delta);
    assert_true(he_mesh_faces(m) > HE_DECIMATE_RECORDED);
    he_mesh_record(m, delta);
    he_decimated done = decimate(m, 0, 0);
    assert_int_equal(done.stop, HE_STOP_ERROR);
    assert_int_equal(delta->count, 0);
    assert_true(he_mesh_equal(m, before));
    he_mesh_record(m, NULL);
    he_delta_free(delta);
    he_mesh_free(before);
    he_mesh_free(m);
}

static void more_faces_less_error(void **state)
{
    (void)state;
    double last = 0, last_error = 0;
    he_mesh *sphere = shape("icosphere", "subdivisions", 4);
    for (uint32_t part = 2; part <= 64; part *= 2) {
        he_mesh *m = copy_of(sphere);
        uint32_t faces = he_mesh_faces(sphere) / part;
        he_decimated done = decimate(m, faces, INFINITY);
        assert_int_equal(done.stop, HE_STOP_FACES);
        assert_in_range(he_mesh_faces(m), faces - 1, faces);
        apart there = measure(m, sphere), back = measure(sphere, m);
        double farthest = fmax(there.farthest, back.farthest);
        assert_true(farthest > last && done.error > last_error);
        /* Of a smooth closed surface no point goes much farther than the worst vertex. */
        assert_true(farthest < 4 * done.error);
        assert_true(there.root_mean_square < 2 * done.error);
        assert_int_equal(there.turned + back.turned, 0);
        last = farthest;
        last_error = done.error;
        he_mesh_free(m);
    }
    he_mesh_free(sphere);
}

static double waves(double x, double y)
{
    return 0.05 * sin(9 * x) * cos(7 * y);
}

static void no_face_is_turned_over(void **state)
{
    (void)state;
    he_mesh *meshes[] = {torus(40), grid(40, waves, 1), shape("icosphere", "subdivisions", 4)};
    for (size_t i = 0; i < sizeof meshes / sizeof *meshes; i++) {
        he_mesh *m = copy_of(meshes[i]);
        decimate(m, he_mesh_faces(m) / 8, INFINITY);
        assert_int_equal(measure(m, meshes[i]).turned, 0);
        for (uint32_t f = 0; f < he_mesh_issued(m, HE_FACE); f++) {
            assert_true(!he_mesh_is_live(m, HE_FACE, f) || he_vec3_length(area_of(m, f)) > 1e-9);
        }
        he_mesh_free(m);
        he_mesh_free(meshes[i]);
    }
}

static void the_error_stays_below_its_limit(void **state)
{
    (void)state;
    he_mesh *first = grid(40, waves, 1);
    uint32_t last = he_mesh_faces(first);
    for (double most = 0.001; most < 1; most *= 4) {
        he_mesh *m = copy_of(first);
        he_decimated done = decimate(m, 0, most);
        assert_int_equal(done.stop, HE_STOP_ERROR);
        assert_true(done.error <= most && done.error > most / 4);
        assert_true(he_mesh_faces(m) < last);
        /* The planes of the walls at the boundary count too, so that it is not quite the same. */
        assert_true(measure(m, first).root_mean_square <= 1.5 * most);
        assert_true(measure(first, m).root_mean_square <= 1.5 * most);
        last = he_mesh_faces(m);
        he_mesh_free(m);
    }
    he_mesh_free(first);
}

/* The outline of a grid that is bent out of its plane stays where it was. */
static void boundaries_are_kept(void **state)
{
    (void)state;
    he_mesh *m = grid(30, waves, 1), *first = copy_of(m);
    decimate(m, he_mesh_faces(m) / 6, INFINITY);
    assert_int_equal(he_mesh_vertices(m) + he_mesh_faces(m) - he_mesh_edges(m), 1);
    for (uint32_t e = 0; e < he_mesh_issued(m, HE_EDGE); e++) {
        if (!he_mesh_is_live(m, HE_EDGE, e) || !he_is_boundary_edge(m, (he_edge){e})) {
            continue;
        }
        for (unsigned side = 0; side < 2; side++) {
            he_vec3 p = he_position(m, he_origin(m, he_edge_halfedge((he_edge){e}, side)));
            double out = fmin(fmin(fabs(p.x), fabs(p.x - 30)), fmin(fabs(p.y), fabs(p.y - 30)));
            assert_true(out < 0.05);
        }
    }
    static const uint32_t corners[4] = {0, 30, 31 * 30, 31 * 31 - 1};
    apart there = measure(first, m);
    assert_true(there.farthest < 0.6);
    for (unsigned i = 0; i < 4; i++) {
        uint64_t budget = UINT64_MAX;
        he_bvh *tree = NULL;
        he_hit hit;
        assert_int_equal(he_bvh_new(m, NULL, &tree, NULL), HE_OK);
        assert_int_equal(he_bvh_closest(tree, m, he_position(first, (he_vertex){corners[i]}),
                                        HUGE_VAL, &budget, &hit, NULL),
                         HE_OK);
        assert_true(hit.distance < 0.05);
        he_bvh_free(tree);
    }
    he_mesh_free(first);
    he_mesh_free(m);
}

/* --- marks --- */

static void mark(he_mesh *m, he_kind kind, const char *name, uint32_t id)
{
    if (he_mark_find(m, kind, name) == NULL) {
        he_column *column = NULL;
        assert_int_equal(he_column_new(name, kind, HE_BOOL, 1, HE_COPY, &column, NULL), HE_OK);
        assert_int_equal(he_column_extend(column, he_mesh_issued(m, kind), NULL), HE_OK);
        assert_int_equal(he_mesh_add_column(m, column, NULL), HE_OK);
    }
    const unsigned char yes = 1;
    size_t slot = he_mesh_column_slot(m, he_mark_find(m, kind, name));
    assert_int_equal(he_reserve_values(m, slot, 1, NULL), HE_OK);
    he_set_attribute(m, slot, id, &yes);
}

static void locked_elements_stay(void **state)
{
    (void)state;
    he_mesh *m = torus(20), *first = copy_of(m);
    for (uint32_t i = 0; i < 12; i++) {
        mark(m, HE_VERTEX, "locked", 31 * i);
        mark(m, HE_FACE, "locked", 61 * i + 3);
        mark(m, HE_EDGE, "locked", 97 * i + 1);
    }
    he_decimated done = decimate(m, 0, INFINITY);
    assert_int_equal(done.stop, HE_STOP_EXHAUSTED);
    assert_true(he_mesh_faces(m) < 300);
    for (uint32_t i = 0; i < 12; i++) {
        he_vec3 p = he_position(m, (he_vertex){31 * i});
        he_vec3 q = he_position(first, (he_vertex){31 * i});
        assert_true(he_mesh_is_live(m, HE_VERTEX, 31 * i) && p.x == q.x && p.y == q.y &&
                    p.z == q.z);
        assert_true(he_mesh_is_live(m, HE_FACE, 61 * i + 3));
        for (unsigned k = 0; k < 2; k++) {
            he_halfedge h = {2 * (97 * i + 1) + k};
            assert_true(he_edge_is_live(m, he_edge_of(h)));
            assert_int_equal(he_origin(m, h).i, he_origin(first, h).i);
        }
    }
    he_mesh_free(first);
    he_mesh_free(m);
}

/* A line across a flat grid would be lost; as a feature it stays, and straight. */
static void feature_lines_keep_their_shape(void **state)
{
    (void)state;
    enum { SIDE = 16 };
    he_mesh *m = grid(SIDE, NULL, 1);
    for (uint32_t i = 0; i < SIDE; i++) {
        uint32_t v = SIDE / 2 * (SIDE + 1) + i;
        he_halfedge h = he_find_halfedge(m, (he_vertex){v}, (he_vertex){v + 1});
        assert_true(h.i != HE_NONE);
        mark(m, HE_EDGE, "feature", he_edge_of(h).i);
    }
    he_decimated done = decimate(m, 0, 0);
    assert_true(done.error == 0);
    double length = 0;
    const he_column *feature = he_mark_find(m, HE_EDGE, "feature");
    for (uint32_t e = 0; e < he_mesh_issued(m, HE_EDGE); e++) {
        if (he_mesh_is_live(m, HE_EDGE, e) && he_is_marked(feature, e)) {
            he_vec3 a = he_position(m, he_origin(m, he_edge_halfedge((he_edge){e}, 0)));
            he_vec3 b = he_position(m, he_origin(m, he_edge_halfedge((he_edge){e}, 1)));
            assert_true(a.y == SIDE / 2.0 && b.y == SIDE / 2.0);
            length += fabs(a.x - b.x);
        }
    }
    assert_true(fabs(length - SIDE) < 1e-9);
    assert_in_range(he_mesh_vertices(m), 6, 6);
    he_mesh_free(m);
}

static void attributes_follow_the_place(void **state)
{
    (void)state;
    enum { SIDE = 16 };
    he_mesh *m = grid(SIDE, NULL, 1);
    he_column *column = NULL;
    assert_int_equal(
        he_column_new("height", HE_VERTEX, HE_DOUBLE, 1, HE_INTERPOLATE, &column, NULL), HE_OK);
    assert_int_equal(he_column_extend(column, he_mesh_issued(m, HE_VERTEX), NULL), HE_OK);
    assert_int_equal(he_mesh_add_column(m, column, NULL), HE_OK);
    size_t slot = he_mesh_column_slot(m, column);
    for (uint32_t v = 0; v < he_mesh_issued(m, HE_VERTEX); v++) {
        he_vec3 p = he_position(m, (he_vertex){v});
        double value = 3 * p.x - 2 * p.y;
        assert_int_equal(he_reserve_values(m, slot, 1, NULL), HE_OK);
        he_set_attribute(m, slot, v, &value);
    }
    decimate(m, 60, INFINITY);
    column = NULL;
    const he_column *heights = he_mesh_find_column(m, HE_VERTEX, "height");
    for (uint32_t v = 0; v < he_mesh_issued(m, HE_VERTEX); v++) {
        if (he_mesh_is_live(m, HE_VERTEX, v)) {
            he_vec3 p = he_position(m, (he_vertex){v});
            double value;
            memcpy(&value, he_column_value(heights, v), sizeof value);
            assert_true(fabs(value - (3 * p.x - 2 * p.y)) < 1e-3);
        }
    }
    he_mesh_free(m);
}

/* --- ends --- */

static void what_cannot_be_collapsed_is_left(void **state)
{
    (void)state;
    he_mesh *m = torus(12);
    he_decimated done = decimate(m, 0, INFINITY);
    assert_int_equal(done.stop, HE_STOP_EXHAUSTED);
    /* No torus has fewer than 7 vertices; whether that is reached depends on shapes. */
    assert_true(he_mesh_faces(m) >= 14 && he_mesh_faces(m) < 100);
    assert_int_equal(he_mesh_vertices(m) + he_mesh_faces(m), he_mesh_edges(m));
    he_decimated again = decimate(m, 0, INFINITY);
    assert_int_equal(again.stop, HE_STOP_EXHAUSTED);
    he_mesh_free(m);
}

static void a_face_of_more_corners_is_refused(void **state)
{
    (void)state;
    he_mesh *m = fixture_mesh("012,0234"), *before = copy_of(m);
    he_error err = {0};
    assert_int_equal(he_decimate(m, &all, NULL, &err), HE_NOT_TRIANGLE);
    assert_int_equal(err.kind, HE_FACE);
    assert_int_equal(err.id, 1);
    assert_true(he_mesh_equal(m, before));
    he_mesh_free(before);
    he_mesh_free(m);
}

static void options_outside_their_range_are_refused(void **state)
{
    (void)state;
    static const he_decimate_options bad[] = {
        {0, -1, 1}, {0, NAN, 1}, {0, 1, -1}, {0, 1, NAN}, {0, 1, INFINITY}};
    he_mesh *m = fixture_mesh("012");
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        assert_int_equal(he_decimate(m, &bad[i], NULL, NULL), HE_BAD_VALUE);
    }
    he_mesh_free(m);
}

/* Scaled by a power of two the same comes out, to the last bit. */
static void size_and_place_do_not_matter(void **state)
{
    (void)state;
    static const int exponents[] = {-900, -40, 40, 900, 1015};
    he_mesh *first = grid(12, waves, 1);
    decimate(first, 60, INFINITY);
    for (size_t i = 0; i < sizeof exponents / sizeof *exponents; i++) {
        he_mesh *m = grid(12, waves, ldexp(1, exponents[i]));
        decimate(m, 60, INFINITY);
        assert_int_equal(he_mesh_vertices(m), he_mesh_vertices(first));
        for (uint32_t v = 0; v < he_mesh_issued(m, HE_VERTEX); v++) {
            he_vec3 p = he_position(m, (he_vertex){v}), q = he_position(first, (he_vertex){v});
            assert_int_equal(he_mesh_is_live(m, HE_VERTEX, v),
                             he_mesh_is_live(first, HE_VERTEX, v));
            assert_true(ldexp(p.x, -exponents[i]) == q.x && ldexp(p.z, -exponents[i]) == q.z);
        }
        he_mesh_free(m);
    }
    he_mesh_free(first);
}

static void points_in_one_place_are_no_harm(void **state)
{
    (void)state;
    static const double scales[] = {0, DBL_TRUE_MIN, 1e-320, DBL_MAX / 64};
    for (size_t i = 0; i < sizeof scales / sizeof *scales; i++) {
        he_mesh *m = grid(6, NULL, scales[i]);
        decimate(m, 10, INFINITY);
        he_mesh_free(m);
    }
}

/* A vertex of very many edges must not be turned about for each of them. */
static void a_hub_of_many_edges_is_no_work(void **state)
{
    (void)state;
    enum { SPOKES = 200000 };
    for (unsigned closed = 0; closed < 2; closed++) {
        he_soup soup;
        he_soup_init(&soup, NULL);
        uint32_t top = add_vertex(&soup, 0, 0, 1), bottom = add_vertex(&soup, 0, 0, -1);
        for (uint32_t i = 0; i < SPOKES; i++) {
            double angle = 6.283185307179586 * i / SPOKES;
            (void)add_vertex(&soup, cos(angle), sin(angle), 0);
        }
        for (uint32_t i = 0; i < SPOKES; i++) {
            uint32_t a = 2 + i, b = 2 + (i + 1) % SPOKES;
            add_triangle(&soup, top, a, b);
            if (closed != 0) {
                add_triangle(&soup, bottom, b, a);
            }
        }
        he_mesh *m = built(&soup);
        decimate(m, SPOKES / 10, INFINITY);
        assert_in_range(he_mesh_faces(m), SPOKES / 10 - 1, SPOKES / 10);
        he_mesh_free(m);
    }
}

/* --- as an edit --- */

/* A few faces and many are done in two ways. */
static const struct {
    uint32_t side, faces;
    bool replaced;
} ways[] = {{20, 200, false}, {110, 3000, true}};

static void it_is_undone_and_done_again(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof ways / sizeof *ways; i++) {
        he_mesh *m = torus(ways[i].side), *before = copy_of(m);
        he_delta *delta = he_delta_new();
        he_mesh_record(m, delta);
        decimate(m, ways[i].faces, INFINITY);
        he_mesh_record(m, NULL);
        he_mesh *after = copy_of(m);
        he_changes changes;
        assert_int_equal(he_changes_find(m, delta, 0, delta->count, false, &changes, NULL), HE_OK);
        assert_int_equal(changes.replaced, ways[i].replaced);
        assert_int_equal(changes.created[HE_VERTEX].count, 0);
        if (!changes.replaced) {
            assert_int_equal(changes.deleted[HE_FACE].count,
                             he_mesh_faces(before) - he_mesh_faces(m));
            assert_int_equal(changes.merged[HE_VERTEX].count,
                             2 * (he_mesh_vertices(before) - he_mesh_vertices(m)));
        }
        he_changes_clear(&changes);
        he_delta_undo(delta, m);
        assert_true(he_mesh_equal(m, before));
        he_delta_redo(delta, m);
        assert_true(he_mesh_equal(m, after));
        he_delta_free(delta);
        he_mesh_free(after);
        he_mesh_free(before);
        he_mesh_free(m);
    }
}

static void both_ways_and_each_time_it_is_the_same(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof ways / sizeof *ways; i++) {
        he_mesh *a = torus(ways[i].side), *b = torus(ways[i].side);
        he_delta *delta = he_delta_new();
        he_mesh_record(b, delta);
        decimate(a, ways[i].faces, INFINITY);
        decimate(b, ways[i].faces, INFINITY);
        assert_true(he_mesh_equal(a, b));
        he_mesh_free(b);
        he_delta_free(delta);
        he_mesh_free(a);
    }
}

static void memory_may_end_anywhere(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof ways / sizeof *ways; i++) {
        he_mesh *first = torus(ways[i].side);
        bool failed = true;
        for (long n = 1; failed; n++) {
            he_mesh *m = copy_of(first);
            he_decimate_options options = {ways[i].faces, INFINITY, 100};
            fixture_fail_at(n);
            he_status status = he_decimate(m, &options, NULL, NULL);
            failed = status != HE_OK;
            fixture_fail_at(0);
            if (failed) {
                assert_int_equal(status, HE_NO_MEMORY);
                assert_true(he_mesh_equal(m, first));
            }
            he_mesh_free(m);
            assert_true(n < 200);
        }
        he_mesh_free(first);
    }
}

static void a_progressive_mesh_may_run_out_of_memory(void **state)
{
    (void)state;
    he_mesh *first = torus(20);
    bool failed = true;
    for (long n = 1; failed; n++) {
        he_progressive made = {0};
        fixture_fail_at(n);
        he_status status = he_progressive_new(first, 0, NULL, &made, NULL);
        failed = status != HE_OK;
        fixture_fail_at(0);
        assert_int_equal(status, failed ? HE_NO_MEMORY : HE_OK);
        assert_true(failed ? made.base == NULL : made.count > 100);
        if (!failed) {
            fixture_check(made.base);
            assert_int_equal(he_mesh_vertices(made.base) + made.count, 400);
        }
        he_progressive_clear(&made);
        assert_true(n < 200);
    }
    he_mesh_free(first);
}

static bool give_up(void *context, const char *phase, double done)
{
    long *left = context;
    (void)phase;
    assert_true(done >= 0 && done <= 1);
    return --*left > 0;
}

static void it_can_be_given_up(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof ways / sizeof *ways; i++) {
        he_mesh *first = torus(ways[i].side);
        bool cancelled = true;
        long told = 0;
        for (long n = 1; cancelled; n++) {
            he_mesh *m = copy_of(first);
            he_watch watch;
            long left = n;
            he_watch_init(&watch, give_up, &left);
            he_mesh_watch(m, &watch);
            he_decimate_options options = {ways[i].faces, INFINITY, 100};
            he_status status = he_decimate(m, &options, NULL, NULL);
            he_mesh_watch(m, NULL);
            cancelled = status != HE_OK;
            if (cancelled) {
                assert_int_equal(status, HE_CANCELLED);
                assert_true(he_mesh_equal(m, first));
            }
            told = n;
            he_mesh_free(m);
        }
        assert_true(told > 3);
        he_mesh_free(first);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_flat_grid_becomes_two_triangles),
        cmocka_unit_test(a_cube_keeps_its_corners_and_its_volume),
        cmocka_unit_test(nothing_happens_where_there_are_few_enough),
        cmocka_unit_test(nothing_is_recorded_where_no_edge_may_go),
        cmocka_unit_test(more_faces_less_error),
        cmocka_unit_test(no_face_is_turned_over),
        cmocka_unit_test(the_error_stays_below_its_limit),
        cmocka_unit_test(boundaries_are_kept),
        cmocka_unit_test(locked_elements_stay),
        cmocka_unit_test(feature_lines_keep_their_shape),
        cmocka_unit_test(attributes_follow_the_place),
        cmocka_unit_test(what_cannot_be_collapsed_is_left),
        cmocka_unit_test(a_face_of_more_corners_is_refused),
        cmocka_unit_test(options_outside_their_range_are_refused),
        cmocka_unit_test(size_and_place_do_not_matter),
        cmocka_unit_test(points_in_one_place_are_no_harm),
        cmocka_unit_test(a_hub_of_many_edges_is_no_work),
        cmocka_unit_test(it_is_undone_and_done_again),
        cmocka_unit_test(both_ways_and_each_time_it_is_the_same),
        cmocka_unit_test(memory_may_end_anywhere),
        cmocka_unit_test(a_progressive_mesh_may_run_out_of_memory),
        cmocka_unit_test(it_can_be_given_up),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
