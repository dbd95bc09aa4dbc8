#include "tests/unit/random_meshes.h"

#include "tests/unit/dense.h"

#include "algo/shape.h"
#include "edit/local/erase.h"
#include "geometry/geometry.h"
#include "mesh/marks.h"
#include "mesh/write.h"

#include <math.h>

/* --- random meshes --- */

static double wobble(md_random *r, double size)
{
    return (2 * md_unit(r) - 1) * size;
}

void random_shake(he_mesh *m, md_random *r, double size)
{
    for (uint32_t v = 0; v < he_mesh_issued(m, HE_VERTEX); v++) {
        if (!he_mesh_is_live(m, HE_VERTEX, v)) {
            continue;
        }
        he_vec3 p = he_position(m, (he_vertex){v});
        const he_vec3 to =
            he_vec3_add(p, (he_vec3){wobble(r, size), wobble(r, size), wobble(r, size)});
        he_set_position(m, (he_vertex){v}, he_vec3_is_finite(to) ? to : p);
    }
}

static void delete_faces(he_mesh *m, md_random *r, uint32_t percent)
{
    for (uint32_t f = 0; f < he_mesh_issued(m, HE_FACE); f++) {
        if (he_mesh_is_live(m, HE_FACE, f) && md_chance(r, percent)) {
            assert_int_equal(he_face_delete(m, &f, 1,
                                            md_chance(r, 20) ? HE_KEEP_ISOLATED : HE_DROP_ISOLATED,
                                            NULL),
                             HE_OK);
        }
    }
}

static he_mesh *make_scan(md_random *r)
{
    he_mesh *m = dense_shape("icosphere", "subdivisions", md_from(r, 1, 4));
    random_shake(m, r, md_unit(r) * 0.1);
    delete_faces(m, r, md_chance(r, 50) ? 0 : md_below(r, 30));
    return m;
}

static he_mesh *make_solid(md_random *r)
{
    static const char *const names[] = {"cube",     "tetrahedron", "octahedron", "dodecahedron",
                                        "cylinder", "cone",        "prism",      "torus"};
    he_mesh *m = NULL;
    while (m == NULL) {
        const char *name = names[md_below(r, sizeof names / sizeof *names)];
        m = he_shape_find(name, strlen(name)) == NULL ? NULL : dense_shape(name, NULL, 0);
    }
    return m;
}

static he_mesh *make_sheet(md_random *r)
{
    he_mesh *m = dense_grid(md_from(r, 1, 20), md_chance(r, 50) ? dense_waves : NULL, 1);
    if (md_chance(r, 40)) {
        random_shake(m, r, md_unit(r) * 0.3);
    }
    delete_faces(m, r, md_chance(r, 30) ? 0 : md_below(r, 40));
    return m;
}

/* A checkerboard: all inner vertices are bow-ties. */
static he_mesh *make_bowties(md_random *r)
{
    uint32_t side = md_from(r, 2, 9);
    he_mesh *m = dense_grid(side, NULL, 1);
    for (uint32_t i = 0; i < side * side; i++) {
        const uint32_t two[2] = {2 * i, 2 * i + 1};
        if ((i / side + i % side) % 2 == 1 && md_chance(r, 90)) {
            assert_int_equal(he_face_delete(m, two, 2, HE_DROP_ISOLATED, NULL), HE_OK);
        }
    }
    return m;
}

/* A grid that is squeezed in one or two directions, with vertices that are at one place or on one
 * line. */
static he_mesh *make_slivers(md_random *r)
{
    he_mesh *m = md_chance(r, 50) ? dense_grid(md_from(r, 1, 12), dense_waves, 1)
                                  : dense_cube(md_from(r, 1, 6));
    double x = pow(10, -(double)md_below(r, 12)), z = pow(10, -(double)md_below(r, 12));
    he_vec3 last = {0, 0, 0};
    for (uint32_t v = 0; v < he_mesh_issued(m, HE_VERTEX); v++) {
        he_vec3 p = he_position(m, (he_vertex){v});
        p = (he_vec3){p.x * x, p.y, p.z * z};
        p = md_chance(r, 5) ? last : p;
        p.x = md_chance(r, 5) ? last.x : p.x;
        he_set_position(m, (he_vertex){v}, p);
        last = p;
    }
    return m;
}

/* A mesh whose coordinates are huge, tiny, or large compared with its size. */
static he_mesh *make_far(md_random *r)
{
    he_mesh *m = md_chance(r, 50) ? make_scan(r) : make_solid(r);
    static const double scales[] = {1e300, 1e-300, 1e150, 1e-150, 1, 1, 1};
    double scale = scales[md_below(r, sizeof scales / sizeof *scales)];
    double shift = scale == 1 ? pow(10, md_below(r, 14)) : md_below(r, 10);
    for (uint32_t v = 0; v < he_mesh_issued(m, HE_VERTEX); v++) {
        he_vec3 p = he_position(m, (he_vertex){v});
        if (he_mesh_is_live(m, HE_VERTEX, v)) {
            p = (he_vec3){(p.x + shift) * scale, (p.y - shift) * scale, p.z * scale};
            he_set_position(m, (he_vertex){v}, p);
        }
    }
    return m;
}

/* A fan around one vertex of very many edges. */
static he_mesh *make_hub(md_random *r)
{
    uint32_t count = md_from(r, 3, 400);
    he_soup soup;
    he_soup_init(&soup, NULL);
    (void)dense_add_vertex(&soup, 0, 0, md_unit(r));
    for (uint32_t i = 0; i < count; i++) {
        double a = 6.283185307179586 * i / count;
        (void)dense_add_vertex(&soup, cos(a), sin(a), 0);
    }
    uint32_t last = md_chance(r, 50) ? count : count - 1;
    for (uint32_t i = 0; i < last; i++) {
        dense_add_triangle(&soup, 0, 1 + i, 1 + (i + 1) % count);
    }
    return dense_built(&soup);
}

const random_family random_families[RANDOM_FAMILIES] = {
    {"scan", make_scan},       {"solid", make_solid},     {"sheet", make_sheet},
    {"bowties", make_bowties}, {"slivers", make_slivers}, {"far", make_far},
    {"hub", make_hub},
};

/* --- marks and attributes --- */

static void set_bytes(he_mesh *m, he_kind kind, const char *name, md_random *r, uint32_t percent)
{
    he_column *column = NULL;
    assert_int_equal(
        he_column_new(&(he_column_schema){name, kind, HE_BOOL, 1, HE_COPY}, &column, NULL), HE_OK);
    assert_int_equal(he_column_extend(column, he_mesh_issued(m, kind), NULL), HE_OK);
    for (uint32_t i = 0; i < he_mesh_issued(m, kind); i++) {
        bool live = kind == HE_HALFEDGE ? he_edge_is_live(m, (he_edge){i >> 1})
                                        : he_mesh_is_live(m, kind, i);
        *he_column_row(column, i) = live && md_chance(r, percent);
    }
    assert_int_equal(he_mesh_add_column(m, column, NULL), HE_OK);
}

static void set_numbers(he_mesh *m, he_kind kind, he_rule rule, md_random *r)
{
    he_column *column = NULL;
    uint32_t rows = he_mesh_issued(m, kind == HE_HALFEDGE ? HE_EDGE : kind);
    rows *= kind == HE_HALFEDGE ? 2 : 1;
    const he_column_schema schema = {"number", kind, HE_DOUBLE, 2, rule};
    assert_int_equal(he_column_new(&schema, &column, NULL), HE_OK);
    assert_int_equal(he_column_extend(column, rows, NULL), HE_OK);
    for (uint32_t i = 0; i < rows; i++) {
        const double value[2] = {md_unit(r), 1};
        bool live = kind == HE_HALFEDGE ? he_edge_is_live(m, (he_edge){i >> 1}) &&
                                              !he_is_boundary_halfedge(m, (he_halfedge){i})
                                        : he_mesh_is_live(m, kind, i);
        if (live) {
            memcpy(he_column_row(column, i), value, sizeof value);
        }
    }
    assert_int_equal(he_mesh_add_column(m, column, NULL), HE_OK);
}

void random_decorate(he_mesh *m, md_random *r)
{
    static const he_kind kinds[] = {HE_VERTEX, HE_EDGE, HE_FACE, HE_HALFEDGE};
    static const he_rule rules[] = {HE_COPY, HE_INTERPOLATE, HE_DEFAULT};
    for (size_t i = 0; i < 4; i++) {
        if (i < 3 && md_chance(r, 15)) {
            set_bytes(m, kinds[i], "locked", r, md_from(r, 1, 20));
        }
        if (md_chance(r, 15)) {
            set_numbers(m, kinds[i], rules[md_below(r, 3)], r);
        }
    }
    if (md_chance(r, 25)) {
        set_bytes(m, HE_EDGE, "feature", r, md_from(r, 1, 20));
    }
}
