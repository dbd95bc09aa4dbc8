#include "tests/unit/dense.h"

#include "algo/shape.h"
#include "edit/whole/triangulate.h"
#include "geometry/vec3.h"
#include "query/bvh.h"

#include <math.h>

he_decimated dense_decimate(he_mesh *m, uint32_t faces, double max_error)
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

he_mesh *dense_built(he_soup *takes)
{
    he_mesh *m = NULL;
    he_error err = {0};
    if (he_build(takes, HE_BUILD_TAKE, &m, NULL, &err) != HE_OK) {
        fail_msg("%s", err.text);
    }
    he_soup_clear(takes);
    return m;
}

uint32_t dense_add_vertex(he_soup *soup, double x, double y, double z)
{
    assert_int_equal(he_soup_add_vertex(soup, (he_vec3){x, y, z}, NULL), HE_OK);
    return (uint32_t)soup->vertex_count - 1;
}

void dense_add_triangle(he_soup *soup, uint32_t a, uint32_t b, uint32_t c)
{
    const uint32_t corners[3] = {a, b, c};
    assert_int_equal(he_soup_add_face(soup, corners, 3, NULL), HE_OK);
}

he_mesh *dense_grid(uint32_t side, double (*height)(double x, double y), double scale)
{
    he_soup soup;
    he_soup_init(&soup, NULL);
    uint32_t across = side + 1;
    for (uint32_t i = 0; i < across * across; i++) {
        uint32_t column = i % across, row = i / across;
        double x = column, y = row;
        double z = height != NULL ? height(x / side, y / side) * side : 0;
        (void)dense_add_vertex(&soup, x * scale, y * scale, z * scale);
    }
    for (uint32_t i = 0; i < side * side; i++) {
        uint32_t v = i / side * across + i % side;
        dense_add_triangle(&soup, v, v + 1, v + across + 1);
        dense_add_triangle(&soup, v, v + across + 1, v + across);
    }
    return dense_built(&soup);
}

he_mesh *dense_torus(uint32_t side)
{
    he_soup soup;
    he_soup_init(&soup, NULL);
    const double turn = 6.283185307179586 / side;
    for (uint32_t i = 0; i < side * side; i++) {
        uint32_t around = i / side, across = i % side;
        double a = turn * around, b = turn * across, r = 3 + cos(b) + 0.1 * sin(9 * a);
        (void)dense_add_vertex(&soup, r * cos(a), r * sin(a), sin(b));
    }
    for (uint32_t i = 0; i < side; i++) {
        for (uint32_t j = 0; j < side; j++) {
            uint32_t here = i * side, down = (i + 1) % side * side, right = (j + 1) % side;
            dense_add_triangle(&soup, here + j, down + j, down + right);
            dense_add_triangle(&soup, here + j, down + right, here + right);
        }
    }
    return dense_built(&soup);
}

he_mesh *dense_shape(const char *name, const char *param, double value)
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
    he_mesh *m = dense_built(&soup);
    assert_int_equal(he_triangulate(m, NULL, NULL, NULL, NULL), HE_OK);
    return m;
}

he_mesh *dense_cube(uint32_t side)
{
    he_soup soup;
    he_soup_init(&soup, NULL);
    uint32_t across = side + 1, *at = calloc((size_t)across * across * across, sizeof *at);
    assert_non_null(at);
    for (uint32_t i = 0; i < across * across * across; i++) {
        uint32_t x = i % across, y = i / across % across, z = i / across / across;
        bool outside = x == 0 || y == 0 || z == 0 || x == side || y == side || z == side;
        at[i] = outside ? dense_add_vertex(&soup, x, y, z) : HE_NONE;
    }
    for (unsigned axis = 0; axis < 3; axis++) {
        const uint32_t step[3] = {1, across, across * across};
        uint32_t u = step[(axis + 1) % 3], v = step[(axis + 2) % 3];
        for (uint32_t cell = 0; cell < 2 * side * side; cell++) {
            bool far = cell >= side * side;
            uint32_t i = cell % side, j = cell / side % side;
            uint32_t a = i * u + j * v + (far ? side * step[axis] : 0);
            const uint32_t q[4] = {at[a], at[a + u], at[a + u + v], at[a + v]};
            dense_add_triangle(&soup, q[0], q[far ? 1 : 2], q[far ? 2 : 1]);
            dense_add_triangle(&soup, q[0], q[far ? 2 : 3], q[far ? 3 : 2]);
        }
    }
    free(at);
    return dense_built(&soup);
}

double dense_waves(double x, double y)
{
    return 0.05 * sin(9 * x) * cos(7 * y);
}

he_mesh *dense_copy(const he_mesh *m)
{
    he_mesh *copy = NULL;
    assert_int_equal(he_mesh_copy(m, &copy, NULL), HE_OK);
    return copy;
}

bool dense_same_point(he_vec3 a, he_vec3 b)
{
    const double before[] = {a.x, a.y, a.z}, after[] = {b.x, b.y, b.z};
    uint64_t x[3], y[3];
    memcpy(x, before, sizeof x);
    memcpy(y, after, sizeof y);
    return x[0] == y[0] && x[1] == y[1] && x[2] == y[2];
}

he_vec3 dense_corner(const he_mesh *m, uint32_t f, unsigned i)
{
    he_halfedge h = he_face_halfedge(m, (he_face){f});
    for (; i > 0; i--) {
        h = he_next(m, h);
    }
    return he_position(m, he_origin(m, h));
}

he_vec3 dense_area(const he_mesh *m, uint32_t f)
{
    he_vec3 a = dense_corner(m, f, 0);
    return he_vec3_scale(
        he_vec3_cross(he_vec3_sub(dense_corner(m, f, 1), a), he_vec3_sub(dense_corner(m, f, 2), a)),
        0.5);
}

dense_apart dense_measure(const he_mesh *from, const he_mesh *to)
{
    he_bvh *tree = NULL;
    assert_int_equal(he_bvh_new(to, NULL, &tree, NULL), HE_OK);
    dense_apart out = {0, 0, 0};
    double squares = 0, weights = 0;
    for (uint32_t f = 0; f < he_mesh_issued(from, HE_FACE); f++) {
        if (!he_mesh_is_live(from, HE_FACE, f)) {
            continue;
        }
        he_vec3 a = dense_corner(from, f, 0), b = dense_corner(from, f, 1),
                c = dense_corner(from, f, 2);
        he_vec3 area = dense_area(from, f);
        for (unsigned i = 0; i < 16; i++) {
            unsigned row = i / 4;
            double u = (i % 4 + 0.5) / 4, v = (row + 0.5) / 4;
            if (u + v > 1) {
                u = 1 - u;
                v = 1 - v;
            }
            he_vec3 p = he_vec3_add(he_vec3_scale(a, 1 - u - v),
                                    he_vec3_add(he_vec3_scale(b, u), he_vec3_scale(c, v)));
            he_budget budget = {.left = UINT64_MAX};
            he_hit hit;
            assert_int_equal(he_bvh_closest(tree, to, p, HUGE_VAL, &budget, &hit, NULL), HE_OK);
            out.farthest = fmax(out.farthest, hit.distance);
            squares += hit.distance * hit.distance * he_vec3_length(area);
            weights += he_vec3_length(area);
            out.turned += he_vec3_dot(area, dense_area(to, hit.face)) <= 0;
        }
    }
    out.root_mean_square = sqrt(squares / weights);
    he_bvh_free(tree);
    return out;
}
