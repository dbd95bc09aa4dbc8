/* Filling holes by surfaces that continue the mesh: closed forms, what must stay, and random
 * meshes. The environment variables SEED and ROUNDS repeat the random rounds and make them longer.
 */
#include "tests/unit/dense.h"
#include "tests/unit/random_meshes.h"

#include "edit/local/erase.h"
#include "fill/fill.h"
#include "geometry/geometry.h"
#include "geometry/vec3.h"
#include "mesh/write.h"
#include "op/op.h"
#include "tests/failing.h"
#include "tests/seed.h"

#include <math.h>

static const double PI = 3.14159265358979323846;

static he_vec3 at(const he_mesh *m, uint32_t v)
{
    return he_position(m, (he_vertex){v});
}

static he_halfedge some_hole(const he_mesh *m)
{
    for (uint32_t h = 0; h < he_mesh_issued(m, HE_HALFEDGE); h++) {
        if (he_mesh_is_live(m, HE_EDGE, h / 2) && he_is_boundary_halfedge(m, (he_halfedge){h})) {
            return (he_halfedge){h};
        }
    }
    return (he_halfedge){HE_NONE};
}

static he_filled fill(he_mesh *m, he_halfedge h, he_smooth_fill options)
{
    he_filled filled;
    he_error err = {0};
    if (he_hole_fill_smooth(m, h, &options, &filled, &err) != HE_OK) {
        fail_msg("%s", err.text);
    }
    fixture_check(m);
    return filled;
}

/* Deletes the faces of which `inside` says so for all corners. */
static void cut_hole(he_mesh *m, bool (*inside)(he_vec3 p, double size), double size)
{
    he_ids faces = {0};
    for (uint32_t f = 0; f < he_mesh_issued(m, HE_FACE); f++) {
        bool all = true;
        for (unsigned i = 0; i < 3; i++) {
            all = all && inside(dense_corner(m, f, i), size);
        }
        if (all) {
            assert_int_equal(he_ids_add(&faces, f, NULL), HE_OK);
        }
    }
    assert_true(faces.count > 0);
    assert_int_equal(he_face_delete(m, faces.ids, faces.count, HE_DROP_ISOLATED, NULL), HE_OK);
    he_ids_clear(&faces);
}

/* --- closed forms --- */

static bool near_pole(he_vec3 p, double angle)
{
    return atan2(hypot(p.x, p.y), p.z) < angle;
}

/* Cuts a cap of a sphere of radius 1, fills the hole, and returns the largest distance of a new
 * vertex from the sphere. */
static double off_sphere(unsigned subdivisions, double angle, he_continuity continuity)
{
    he_mesh *m = dense_shape("icosphere", "subdivisions", subdivisions);
    for (uint32_t v = 0; v < he_mesh_issued(m, HE_VERTEX); v++) {
        he_set_position(m, (he_vertex){v}, he_vec3_scale(at(m, v), 1 / he_vec3_length(at(m, v))));
    }
    const uint32_t issued = he_mesh_issued(m, HE_VERTEX);
    cut_hole(m, near_pole, angle);
    he_filled filled = fill(m, some_hole(m), (he_smooth_fill){.continuity = continuity});
    double most = 0;
    for (uint32_t v = issued; v < he_mesh_issued(m, HE_VERTEX); v++) {
        most = fmax(most, fabs(he_vec3_length(at(m, v)) - 1));
    }
    assert_true(he_mesh_issued(m, HE_VERTEX) > issued);
    assert_int_equal(some_hole(m).i, HE_NONE);
    he_filled_clear(&filled);
    he_mesh_free(m);
    return most;
}

static void a_cap_of_a_sphere_comes_back(void **state)
{
    (void)state;
    /* the mean length of edges with n subdivisions is about 1.2 / 2^n */
    for (int continuity = HE_CONTINUOUS_TANGENT; continuity < HE_CONTINUITIES; continuity++) {
        for (unsigned n = 3; n <= 5; n++) {
            const double h = 1.2 / pow(2, n);
            const double off = off_sphere(n, 4 * h, (he_continuity)continuity);
            print_message("note: continuity %d, edges of %.4f: off by %.3g, %.3f h^2\n", continuity,
                          h, off, off / (h * h));
            assert_true(off < 0.5 * h * h);
        }
        print_message("note: a cap of 0.5 rad: off by %.3g with edges of %.3f, %.3g of %.3f\n",
                      off_sphere(3, 0.5, (he_continuity)continuity), 1.2 / 8,
                      off_sphere(5, 0.5, (he_continuity)continuity), 1.2 / 32);
    }
}

static bool in_middle(he_vec3 p, double size)
{
    return fabs(p.x - 0.5) < size && fabs(p.y - 0.5) < size;
}

static double total_area(const he_mesh *m)
{
    double sum = 0;
    for (uint32_t f = 0; f < he_mesh_issued(m, HE_FACE); f++) {
        if (he_mesh_is_live(m, HE_FACE, f)) {
            const he_vec3 a = dense_area(m, f);
            assert_true(a.z > 0);
            sum += he_vec3_length(a);
        }
    }
    return sum;
}

static void a_hole_in_a_plane_stays_in_the_plane(void **state)
{
    (void)state;
    for (int continuity = 0; continuity < HE_CONTINUITIES; continuity++) {
        he_mesh *m = dense_grid(24, NULL, 1.0 / 24);
        for (uint32_t v = 0; v < he_mesh_issued(m, HE_VERTEX); v++) {
            he_set_position(m, (he_vertex){v}, (he_vec3){at(m, v).x, at(m, v).y, 0.1});
        }
        const uint32_t issued = he_mesh_issued(m, HE_VERTEX);
        cut_hole(m, in_middle, 0.3);
        he_halfedge h = some_hole(m);
        while (!in_middle(at(m, he_origin(m, h).i), 0.4)) { /* the outer boundary has lower ids */
            do {
                h.i++;
            } while (!he_mesh_is_live(m, HE_EDGE, h.i / 2) || !he_is_boundary_halfedge(m, h));
        }
        he_filled filled = fill(m, h, (he_smooth_fill){.continuity = (he_continuity)continuity});
        assert_true(he_mesh_issued(m, HE_VERTEX) > issued + 30);
        for (uint32_t v = issued; v < he_mesh_issued(m, HE_VERTEX); v++) {
            assert_true(at(m, v).z >= 0.1 && at(m, v).z <= 0.1);
        }
        assert_true(fabs(total_area(m) - 1) < 1e-12);
        he_filled_clear(&filled);
        he_mesh_free(m);
    }
}

/* Makes the wall of an open box of n x n x n cells, without its bottom and lid. */
static he_mesh *make_tube(uint32_t edges)
{
    he_soup soup;
    he_soup_init(&soup, NULL);
    for (uint32_t level = 0; level < 3; level++) {
        for (uint32_t i = 0; i < edges; i++) {
            const double angle = 2 * PI * i / edges;
            (void)dense_add_vertex(&soup, cos(angle), sin(angle), level * 2 * PI / edges);
        }
    }
    for (uint32_t level = 0; level < 2; level++) {
        for (uint32_t i = 0; i < edges; i++) {
            const uint32_t a = level * edges + i, b = level * edges + (i + 1) % edges;
            dense_add_triangle(&soup, a, b, b + edges);
            dense_add_triangle(&soup, a, b + edges, a + edges);
        }
    }
    return dense_built(&soup);
}

static void edges_are_as_long_as_asked(void **state)
{
    (void)state;
    static const double lengths[] = {0, 0.05, 0.3};
    for (size_t i = 0; i < sizeof lengths / sizeof *lengths; i++) {
        he_mesh *m = make_tube(60);
        const double wanted = lengths[i] > 0 ? lengths[i] : 2 * sin(PI / 60);
        he_filled filled = fill(m, some_hole(m), (he_smooth_fill){.edge_length = lengths[i]});
        double sum = 0;
        for (size_t e = 0; e < filled.edges.count; e++) {
            sum += he_edge_length(m, (he_edge){filled.edges.ids[e]});
        }
        const double mean = sum / (double)filled.edges.count;
        print_message("note: wanted %.3f, %zu edges have the mean length %.3f\n", wanted,
                      filled.edges.count, mean);
        assert_true(mean > 0.6 * wanted && mean < 1.6 * wanted);
        he_filled_clear(&filled);
        he_mesh_free(m);
    }
    he_mesh *m = make_tube(60), *before = dense_copy(m);
    he_error err = {0};
    const he_smooth_fill tiny = {.edge_length = 1e-4}, negative = {.edge_length = -1};
    assert_int_equal(he_hole_fill_smooth(m, some_hole(m), &tiny, NULL, &err), HE_LIMIT);
    assert_int_equal(he_hole_fill_smooth(m, some_hole(m), &negative, NULL, &err), HE_BAD_VALUE);
    assert_true(he_mesh_equal(m, before));
    he_mesh_free(before);
    he_mesh_free(m);
}

/* Returns options that ask for so many faces in a hole of area 1. */
static he_smooth_fill asking_for(double faces)
{
    return (he_smooth_fill){.edge_length = sqrt(1 / (0.4330127 * faces))};
}

/* Makes tubes, each of which has a square hole of area 1 at both ends. */
static he_mesh *make_square_tubes(uint32_t tubes)
{
    he_soup soup;
    he_soup_init(&soup, NULL);
    for (uint32_t i = 0; i < 8 * tubes; i++) {
        const uint32_t tube = i / 8;
        (void)dense_add_vertex(&soup, 2 * tube + (i % 4 == 1 || i % 4 == 2), i % 4 >= 2,
                               i % 8 >= 4);
    }
    for (uint32_t i = 0; i < 4 * tubes; i++) {
        const uint32_t base = 8 * (i / 4), a = base + i % 4, b = base + (i + 1) % 4;
        dense_add_triangle(&soup, a, b, b + 4);
        dense_add_triangle(&soup, a, b + 4, a + 4);
    }
    return dense_built(&soup);
}

static void require_told_limit(he_status status, const he_error *err, const char *limit)
{
    assert_int_equal(status, HE_LIMIT);
    assert_non_null(strstr(err->text, limit));
    assert_non_null(strstr(err->text, "edge_length"));
}

static void too_many_faces_are_refused_before_any_work(void **state)
{
    (void)state;
    he_mesh *m = make_square_tubes(4), *before = dense_copy(m);
    he_error err = {0};
    uint64_t steps = 100;
    const he_smooth_fill over = asking_for(1.02 * HE_FILL_FACES), few = asking_for(1000);
    assert_true(fabs(he_fill_foretell(m, some_hole(m), &few, &steps) - 1000) < 1);
    assert_int_equal(steps, 96);
    require_told_limit(he_hole_fill_smooth(m, some_hole(m), &over, NULL, &err), &err, "100000");
    he_fill_holes_options all = {.method = HE_FILL_ALL_SMOOTH, .smooth = over};
    require_told_limit(he_fill_holes(m, &all, NULL, &err), &err, "100000");
    /* none of the eight holes gets too many, but all together do */
    all.smooth = asking_for(0.13 * HE_FILL_ALL_FACES);
    require_told_limit(he_fill_holes(m, &all, NULL, &err), &err, "500000");
    /* holes that will be left do not count */
    all.max_size = 1;
    assert_int_equal(he_fill_holes(m, &all, NULL, &err), HE_OK);
    assert_true(he_mesh_equal_live(m, before));
    steps = 2; /* the walk around a hole ends when there are no more steps */
    (void)he_fill_foretell(m, some_hole(m), &few, &steps);
    assert_int_equal(steps, 0);
    assert_true(he_fill_foretell(m, some_hole(m), &few, &steps) <= 0);
    he_mesh_free(before);
    he_mesh_free(m);
}

static void a_filling_is_charged_by_the_faces_that_it_makes(void **state)
{
    (void)state;
    const he_op *op = he_op_find("hole_fill", 9);
    he_arg args[HE_OP_PARAMS];
    he_mesh *m = make_square_tubes(1);
    const double elements = (double)he_mesh_issued(m, HE_VERTEX) + he_mesh_issued(m, HE_EDGE) +
                            he_mesh_issued(m, HE_FACE);
    he_op_defaults(op, args);
    args[0] = (he_arg){.given = true, .id = some_hole(m).i};
    assert_true(he_op_growth(op, m, args) <= 1 && he_op_pace(op, args) == 1);
    args[1] = (he_arg){.given = true, .choice = HE_FILL_ALL_SMOOTH};
    args[2] = (he_arg){.given = true, .number = asking_for(10000).edge_length};
    assert_true(fabs((he_op_growth(op, m, args) - 1) * elements - 30000) < 30);
    assert_true(he_op_growth(op, NULL, args) <= 1);
    assert_true(he_op_pace(op, args) > 1);
    const double lengths[] = {asking_for(1000).edge_length, asking_for(2000).edge_length};
    const uint32_t ids[] = {some_hole(m).i, some_hole(m).i};
    args[0] = (he_arg){.given = true, .list = true, .ids = ids, .count = 2};
    args[2] = (he_arg){.given = true, .list = true, .numbers = lengths, .count = 2};
    assert_true(fabs((he_op_growth(op, m, args) - 1) * elements - 9000) < 9);
    he_mesh_free(m);
}

static void a_hole_of_many_edges_does_not_get_too_many_faces(void **state)
{
    (void)state;
    he_mesh *m = make_tube(5000);
    he_filled filled = fill(m, some_hole(m), (he_smooth_fill){.continuity = HE_CONTINUOUS_TANGENT});
    print_message("note: 5000 edges, %zu faces\n", filled.faces.count);
    assert_true(filled.faces.count > 10000 && filled.faces.count < 200000);
    he_filled_clear(&filled);
    he_mesh_free(m);
}

/* A torus of 7 vertices, each of which is joined to all others. Without one of them there is a hole
 * of six edges, all of whose diagonals are edges already. */
static void a_hole_whose_diagonals_exist_gets_a_vertex(void **state)
{
    (void)state;
    he_soup soup;
    he_soup_init(&soup, NULL);
    for (uint32_t i = 0; i < 7; i++) {
        (void)dense_add_vertex(&soup, cos(i), sin(i), i % 3);
    }
    for (uint32_t i = 0; i < 7; i++) {
        dense_add_triangle(&soup, i, (i + 1) % 7, (i + 3) % 7);
        dense_add_triangle(&soup, i, (i + 3) % 7, (i + 2) % 7);
    }
    he_mesh *m = dense_built(&soup);
    assert_int_equal(he_vertex_delete(m, (he_vertex){0}, HE_DROP_ISOLATED, NULL), HE_OK);
    const he_halfedge h = some_hole(m);
    assert_int_equal(he_hole_fill(m, h, HE_FILL_TRIANGULATE, NULL, NULL), HE_DOUBLED_EDGE);
    he_filled filled = fill(m, h, (he_smooth_fill){.continuity = HE_CONTINUOUS_TANGENT});
    assert_true(filled.faces.count >= 6);
    assert_int_equal(some_hole(m).i, HE_NONE);
    he_filled_clear(&filled);
    he_mesh_free(m);
}

/* Makes a pyramid without a base, of base corners at `p`. */
static he_mesh *make_pyramid(const he_vec3 p[4])
{
    he_soup soup;
    he_soup_init(&soup, NULL);
    for (int i = 0; i < 4; i++) {
        (void)dense_add_vertex(&soup, p[i].x, p[i].y, p[i].z);
    }
    (void)dense_add_vertex(&soup, 0, 0, 1);
    for (uint32_t i = 0; i < 4; i++) {
        dense_add_triangle(&soup, i, (i + 1) % 4, 4);
    }
    return dense_built(&soup);
}

static void extreme_holes_get_finite_vertices_and_few_faces(void **state)
{
    (void)state;
    static const double LARGE = 1.7e308;
    static const he_vec3 bases[][4] = {
        {{LARGE, 0, 0}, {0, LARGE, 0}, {-LARGE, 0, 0}, {0, -LARGE, 0}},
        {{0, 0, 0}, {1, 0, 0}, {3, 0, 0}, {2, 0, 0}}, /* without area */
        {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}},
        {{1e-308, 0, 0}, {0, 1e-308, 0}, {-1e-308, 0, 0}, {0, -1e-308, 0}}};
    static const double lengths[] = {LARGE / 20, 1e-6, 1e-6, 1e-309};
    for (size_t i = 0; i < 4; i++) {
        for (int continuity = 0; continuity < HE_CONTINUITIES; continuity++) {
            he_mesh *m = make_pyramid(bases[i]);
            const he_smooth_fill options = {lengths[i], (he_continuity)continuity};
            he_filled filled = fill(m, some_hole(m), options);
            assert_true(filled.faces.count < 10000);
            for (uint32_t v = 0; v < he_mesh_issued(m, HE_VERTEX); v++) {
                assert_true(he_vec3_is_finite(at(m, v)));
            }
            he_filled_clear(&filled);
            he_mesh_free(m);
        }
    }
}

/* --- attributes --- */

static void attributes_continue_into_the_hole(void **state)
{
    (void)state;
    he_mesh *m = dense_grid(16, NULL, 1.0 / 16);
    static const he_rule rules[] = {HE_INTERPOLATE, HE_COPY, HE_DEFAULT};
    static const char *const names[] = {"height", "group", "other"};
    for (size_t i = 0; i < 3; i++) {
        const he_column_schema schema = {names[i], HE_VERTEX, HE_DOUBLE, 1, rules[i]};
        he_column *column;
        assert_int_equal(he_column_new(&schema, &column, NULL), HE_OK);
        assert_int_equal(he_column_extend(column, he_mesh_issued(m, HE_VERTEX), NULL), HE_OK);
        for (uint32_t v = 0; v < he_mesh_issued(m, HE_VERTEX); v++) {
            const double value = i == 0 ? 3 * at(m, v).x - 2 * at(m, v).y + 1 : 7;
            memcpy(he_column_row(column, v), &value, sizeof value);
        }
        assert_int_equal(he_mesh_add_column(m, column, NULL), HE_OK);
    }
    const uint32_t issued = he_mesh_issued(m, HE_VERTEX);
    cut_hole(m, in_middle, 0.3);
    he_filled_holes done;
    const he_fill_holes_options options = {.method = HE_FILL_ALL_SMOOTH, .max_size = 1};
    assert_int_equal(he_fill_holes(m, &options, &done, NULL), HE_OK);
    assert_int_equal(done.filled, 1);
    assert_int_equal(done.large, 1);
    assert_int_equal(done.left.count, 1);
    assert_true(he_mesh_issued(m, HE_VERTEX) > issued);
    for (uint32_t v = issued; v < he_mesh_issued(m, HE_VERTEX); v++) {
        const double wanted[] = {3 * at(m, v).x - 2 * at(m, v).y + 1, 7, 0};
        for (size_t i = 0; i < 3; i++) {
            assert_true(fabs(he_column_number(m->c.columns[i], v, 0) - wanted[i]) < 1e-9);
        }
    }
    he_filled_holes_clear(&done);
    he_mesh_free(m);
}

/* --- all holes --- */

static void fill_holes_says_what_it_left(void **state)
{
    (void)state;
    static const he_fill_method methods[] = {HE_FILL_ALL_SMOOTH, HE_FILL_ALL_POLYGON,
                                             HE_FILL_ALL_FAN, HE_FILL_ALL_TRIANGULATE};
    for (size_t i = 0; i < 4; i++) {
        /* two triangles that touch in a vertex, and a lone one */
        he_mesh *m = fixture_mesh("012,234,567");
        he_filled_holes done;
        const he_fill_holes_options options = {.method = methods[i]};
        assert_int_equal(he_fill_holes(m, &options, &done, NULL), HE_OK);
        assert_int_equal(done.filled, 0);
        assert_int_equal(done.touching, 1);
        assert_int_equal(done.single, 1);
        assert_int_equal(done.left.count, 2);
        he_filled_holes_clear(&done);
        he_mesh_free(m);

        m = make_tube(12);
        const he_fill_holes_options small = {.method = methods[i], .max_edges = 11};
        assert_int_equal(he_fill_holes(m, &small, &done, NULL), HE_OK);
        assert_int_equal(done.large, 2);
        he_filled_holes_clear(&done);
        assert_int_equal(he_fill_holes(m, &options, &done, NULL), HE_OK);
        fixture_check(m);
        assert_int_equal(done.filled, 2);
        assert_true(done.bend > 1 && done.bend < 2);
        assert_int_equal(some_hole(m).i, HE_NONE);
        he_filled_holes_clear(&done);
        he_mesh_free(m);
    }
}

static void what_fills_all_holes_is_foreseen(void **state)
{
    (void)state;
    static const he_fill_holes_options options[] = {
        {.method = HE_FILL_ALL_SMOOTH},
        {.method = HE_FILL_ALL_SMOOTH, .max_edges = 60},
        {.method = HE_FILL_ALL_SMOOTH, .smooth.edge_length = 0.05},
        {.method = HE_FILL_ALL_SMOOTH, .smooth.edge_length = 0.4, .max_edges = 60},
        {.method = HE_FILL_ALL_POLYGON},
        {.method = HE_FILL_ALL_TRIANGULATE}};
    /* As far as is known, the two holes of a tube may be one with twice the edges. */
    for (size_t i = 0; i < sizeof options / sizeof *options; i++) {
        he_mesh *m = make_tube(60);
        const uint32_t before = he_mesh_faces(m);
        const double told = he_fill_holes_foretell(m, &options[i]);
        assert_int_equal(he_fill_holes(m, &options[i], NULL, NULL), HE_OK);
        const double made = he_mesh_faces(m) - before;
        print_message("note: %.0f faces foreseen, %.0f made\n", told, made);
        assert_true(made < 1.3 * told);
        assert_true(options[i].method != HE_FILL_ALL_SMOOTH || told < 4 * made);
        he_mesh_free(m);
    }
    const he_op *op = he_op_find("fill_holes", 10);
    he_arg args[HE_OP_PARAMS];
    he_op_defaults(op, args);
    he_mesh *m = make_tube(60), *closed = dense_shape("icosphere", "subdivisions", 1);
    const double told = he_fill_holes_foretell(m, &options[0]);
    assert_true(fabs(he_op_growth(op, m, args) - (1 + told / he_mesh_faces(m))) < 1e-12);
    assert_true(he_op_growth(op, closed, args) <= 1);
    assert_true(he_op_growth(op, NULL, args) <= 1);
    he_mesh_free(m);
    he_mesh_free(closed);
    /* without end: so many faces as all holes may have, and no more */
    m = make_tube(60);
    const he_fill_holes_options tiny = {.method = HE_FILL_ALL_SMOOTH, .smooth.edge_length = 1e-300};
    assert_true(he_fill_holes_foretell(m, &tiny) <= HE_FILL_ALL_FACES);
    assert_true(he_fill_holes_foretell(m, &tiny) >= HE_FILL_FACES);
    he_mesh_free(m);
}

/* --- random meshes --- */

static bool tell(void *context, const char *phase, double done)
{
    long *left = context;
    (void)phase;
    (void)done;
    return --*left != 0;
}

/* Requires that all elements of the mesh before are as they were, but for the holes. */
static void require_kept(const he_mesh *before, const he_mesh *after)
{
    for (uint32_t v = 0; v < he_mesh_issued(before, HE_VERTEX); v++) {
        if (he_mesh_is_live(before, HE_VERTEX, v)) {
            assert_true(dense_same_point(at(before, v), at(after, v)));
        }
    }
    for (uint32_t h = 0; h < he_mesh_issued(before, HE_HALFEDGE); h++) {
        const he_halfedge k = {h};
        if (!he_mesh_is_live(before, HE_EDGE, h / 2)) {
            continue;
        }
        assert_int_equal(he_origin(before, k).i, he_origin(after, k).i);
        if (!he_is_boundary_halfedge(before, k)) {
            assert_int_equal(he_face_of(before, k).i, he_face_of(after, k).i);
            assert_int_equal(he_next(before, k).i, he_next(after, k).i);
        }
    }
    for (uint32_t f = he_mesh_issued(before, HE_FACE); f < he_mesh_issued(after, HE_FACE); f++) {
        assert_true(he_mesh_is_live(after, HE_FACE, f));
    }
    for (uint32_t v = he_mesh_issued(before, HE_VERTEX); v < he_mesh_issued(after, HE_VERTEX);
         v++) {
        assert_true(he_vec3_is_finite(at(after, v)));
    }
}

static void play(const random_family *of, md_random *r)
{
    he_mesh *m = of->make(r);
    for (uint32_t f = 0; f < he_mesh_issued(m, HE_FACE); f++) {
        if (he_mesh_is_live(m, HE_FACE, f) && md_chance(r, 10)) {
            assert_int_equal(he_face_delete(m, &f, 1, HE_DROP_ISOLATED, NULL), HE_OK);
        }
    }
    random_decorate(m, r);
    he_mesh *before = dense_copy(m);
    const he_fill_holes_options options = {
        .method = md_chance(r, 70) ? HE_FILL_ALL_SMOOTH : (he_fill_method)md_below(r, 4),
        .smooth = {.continuity = (he_continuity)md_below(r, HE_CONTINUITIES)},
        .max_edges = md_chance(r, 30) ? md_from(r, 3, 30) : 0};
    he_progress progress;
    long left = md_chance(r, 20) ? md_from(r, 1, 10) : 0;
    he_progress_init(&progress, tell, &left);
    he_mesh_set_progress(m, &progress);
    he_delta *delta = he_delta_new();
    he_filled_holes done = {.filled = 0};
    he_error err = {0};
    he_mesh_record(m, delta);
    const he_status status = he_fill_holes(m, &options, &done, &err);
    he_mesh_record(m, NULL);
    he_mesh_set_progress(m, NULL);
    if (status == HE_OK) {
        fixture_check(m);
        require_kept(before, m);
        he_mesh *after = dense_copy(m);
        he_delta_undo(delta, m);
        assert_true(he_mesh_equal_live(m, before));
        he_delta_redo(delta, m);
        assert_true(he_mesh_equal(m, after));
        he_mesh_free(after);
    } else {
        if (status != HE_CANCELLED) {
            fail_msg("%s: %s", of->name, err.text);
        }
        assert_true(he_mesh_equal_live(m, before));
    }
    he_filled_holes_clear(&done);
    he_delta_free(delta);
    he_mesh_free(before);
    he_mesh_free(m);
}

static void a_large_filling_can_be_cancelled_at_each_report(void **state)
{
    (void)state;
    he_mesh *m = make_square_tubes(1), *before = dense_copy(m);
    const he_smooth_fill options = asking_for(5000);
    he_status status = HE_CANCELLED;
    long reports = 0;
    while (status == HE_CANCELLED) {
        long left = ++reports;
        he_progress progress;
        he_progress_init(&progress, tell, &left);
        he_mesh_set_progress(m, &progress);
        status = he_hole_fill_smooth(m, some_hole(m), &options, NULL, NULL);
        he_mesh_set_progress(m, NULL);
        assert_true(status == HE_CANCELLED ? he_mesh_equal_live(m, before) : status == HE_OK);
        assert_true(status != HE_OK || strcmp(progress.phase, "finding attributes") == 0);
    }
    print_message("note: %ld reports\n", reports - 1);
    assert_true(reports > 10);
    he_mesh_free(before);
    he_mesh_free(m);
}

static void random_holes_are_filled(void **state)
{
    (void)state;
    const uint64_t seed = seed_of_run(), rounds = seed_setting("ROUNDS", 200);
    for (uint64_t i = 0; i < rounds; i++) {
        md_random r = {seed + i};
        play(&random_families[(seed + i) % RANDOM_FAMILIES], &r);
    }
    printf("note: %llu random meshes\n", (unsigned long long)rounds);
}

static void every_allocation_may_fail(void **state)
{
    (void)state;
    failing f = {0};
    while (failing_next(&f)) {
        failing_pause();
        he_mesh *m = dense_shape("icosphere", "subdivisions", 2);
        const he_column_schema schema = {"height", HE_VERTEX, HE_FLOAT, 2, HE_INTERPOLATE};
        he_column *column;
        assert_int_equal(he_column_new(&schema, &column, NULL), HE_OK);
        assert_int_equal(he_column_extend(column, he_mesh_issued(m, HE_VERTEX), NULL), HE_OK);
        assert_int_equal(he_mesh_add_column(m, column, NULL), HE_OK);
        cut_hole(m, near_pole, 0.8);
        he_mesh *before = dense_copy(m);
        const he_fill_holes_options options = {.method = HE_FILL_ALL_SMOOTH,
                                               .smooth.continuity = HE_CONTINUOUS_CURVATURE};
        failing_resume();
        if (!failing_status(&f, he_fill_holes(m, &options, NULL, NULL))) {
            assert_true(he_mesh_equal_live(m, before));
        }
        he_mesh_free(before);
        he_mesh_free(m);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_cap_of_a_sphere_comes_back),
        cmocka_unit_test(a_hole_in_a_plane_stays_in_the_plane),
        cmocka_unit_test(edges_are_as_long_as_asked),
        cmocka_unit_test(too_many_faces_are_refused_before_any_work),
        cmocka_unit_test(a_filling_is_charged_by_the_faces_that_it_makes),
        cmocka_unit_test(a_hole_of_many_edges_does_not_get_too_many_faces),
        cmocka_unit_test(a_hole_whose_diagonals_exist_gets_a_vertex),
        cmocka_unit_test(extreme_holes_get_finite_vertices_and_few_faces),
        cmocka_unit_test(attributes_continue_into_the_hole),
        cmocka_unit_test(fill_holes_says_what_it_left),
        cmocka_unit_test(what_fills_all_holes_is_foreseen),
        cmocka_unit_test(a_large_filling_can_be_cancelled_at_each_report),
        cmocka_unit_test(random_holes_are_filled),
        cmocka_unit_test(every_allocation_may_fail),
    };
    return cmocka_run_group_tests_name("fill", tests, NULL, NULL);
}
