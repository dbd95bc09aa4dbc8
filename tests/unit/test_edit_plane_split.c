/* The edit plane_split is compared with counts and areas that the test computes in another way. The
 * environment variable SEED=n repeats a random run, ROUNDS=n makes it longer. */
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
#include "edit/plane/plane_split.h"
#include "edit/whole/triangulate.h"
#include "geometry/geometry.h"
#include "mesh/write.h"
#include "model/shapes.h"
#include "query/topology.h"
#include "tests/failing.h"
#include "tests/seed.h"

static const he_vec3 ORIGIN = {0, 0, 0}, UP = {0, 0, 1};

static he_mesh *shape(const char *name, double first, double second)
{
    he_soup soup;
    he_mesh *m = NULL;
    double args[HE_SHAPE_PARAMS];
    const he_shape *row = he_shape_find(name, strlen(name));
    assert_non_null(row);
    he_shape_defaults(row, args);
    args[0] = first != 0 ? first : args[0];
    args[1] = second != 0 ? second : args[1];
    assert_int_equal(he_shape_make(row, args, NULL, &soup, NULL), HE_OK);
    assert_int_equal(he_build(&soup, HE_BUILD_TAKE, &m, NULL, NULL), HE_OK);
    he_soup_clear(&soup);
    return m;
}

/* Returns 1 if a vertex lies above the plane, -1 if it lies below the plane, and 0 if it lies in
 * the plane; the tolerance only allows for rounding errors. */
static int side(const he_mesh *m, he_vertex v, he_vec3 point, he_vec3 normal)
{
    he_vec3 p = he_position(m, v);
    double d = (p.x - point.x) * normal.x + (p.y - point.y) * normal.y + (p.z - point.z) * normal.z;
    return fabs(d) < 1e-7 ? 0 : d > 0 ? 1 : -1;
}

/* How a face lies relative to a plane: whether the face has corners above and below the plane, how
 * many corners lie in the plane, and how many sides cross the plane. */
typedef struct look {
    bool above, below;
    uint32_t in_plane, crossings;
} look;

static look look_at(const he_mesh *m, uint32_t f, he_vec3 point, he_vec3 normal)
{
    look found = {.above = false};
    he_halfedge first = he_face_halfedge(m, (he_face){f}), h = first;
    do {
        int a = side(m, he_origin(m, h), point, normal),
            b = side(m, he_target(m, h), point, normal);
        found.above |= a > 0;
        found.below |= a < 0;
        found.in_plane += a == 0;
        found.crossings += a * b < 0;
        h = he_next(m, h);
    } while (h.i != first.i);
    return found;
}

static void assert_one_sided(const he_mesh *m, he_vec3 point, he_vec3 normal)
{
    for (uint32_t f = 0; f < he_mesh_issued(m, HE_FACE); f++) {
        if (he_mesh_is_live(m, HE_FACE, f)) {
            look there = look_at(m, f, point, normal);
            assert_false(there.above && there.below);
        }
    }
}

static void assert_same_topology(const he_mesh *m, const he_mesh *before)
{
    he_topology a = {0}, b = {0};
    assert_int_equal(he_topology_find(m, &a, NULL), HE_OK);
    assert_int_equal(he_topology_find(before, &b, NULL), HE_OK);
    assert_int_equal(a.euler, b.euler);
    assert_int_equal(a.components, b.components);
    assert_int_equal(a.components_by_edge, b.components_by_edge);
    assert_int_equal(a.boundary_loops, b.boundary_loops);
    assert_int_equal(a.isolated_vertices, b.isolated_vertices);
    assert_int_equal(a.bowties, b.bowties);
    he_topology_clear(&a);
    he_topology_clear(&b);
}

/* Checks the numbers of new vertices, edges and faces, which can be predicted from the old mesh.
 * For faces with corners in the plane the prediction is exact only if the faces are convex. */
static void assert_predicted(const he_mesh *before, const he_plane_parts *parts, he_vec3 point,
                             he_vec3 normal, bool convex)
{
    uint32_t edges = 0, faces = 0, least = 0;
    bool exact = true;
    for (uint32_t e = 0; e < he_mesh_issued(before, HE_EDGE); e++) {
        he_halfedge h = {2 * e};
        edges += he_mesh_is_live(before, HE_EDGE, e) &&
                 side(before, he_origin(before, h), point, normal) *
                         side(before, he_target(before, h), point, normal) <
                     0;
    }
    for (uint32_t f = 0; f < he_mesh_issued(before, HE_FACE); f++) {
        if (he_mesh_is_live(before, HE_FACE, f)) {
            look there = look_at(before, f, point, normal);
            bool cut = there.above && there.below;
            faces += cut;
            least += cut && convex ? 1 : there.crossings / 2;
            exact &= convex || there.in_plane == 0;
        }
    }
    assert_int_equal(parts->vertices.count, edges);
    assert_int_equal(parts->faces_split, faces);
    assert_int_equal(parts->faces.count, parts->edges.count);
    assert_true(exact ? parts->faces.count == least : parts->faces.count >= least);
}

/* Splits the faces of the mesh by a plane, and checks all that can be predicted. Returns false if
 * the split was refused. */
static bool split_and_check(he_mesh *m, he_vec3 point, he_vec3 normal, bool convex)
{
    he_mesh *before = copy_of(m);
    he_delta *delta = he_delta_new();
    he_plane_parts parts = {.faces_split = 0};
    assert_non_null(delta);
    he_mesh_record(m, delta);
    he_status status = he_plane_split(m, &(he_plane){point, normal, NULL}, NULL, 0, &parts, NULL);
    assert_valid(m);
    if (status != HE_OK) {
        assert_int_equal(status, HE_DOUBLED_EDGE);
        assert_int_equal(delta->count, 0);
        assert_equal(m, before);
    } else {
        assert_one_sided(m, point, normal);
        assert_same_topology(m, before);
        assert_predicted(before, &parts, point, normal, convex);
        assert_int_equal(he_mesh_vertices(m), he_mesh_vertices(before) + parts.vertices.count);
        assert_int_equal(he_mesh_faces(m), he_mesh_faces(before) + parts.faces.count);
        for (size_t i = 0; i < parts.edges.count; i++) {
            he_halfedge h = {2 * parts.edges.ids[i]};
            assert_int_equal(side(m, he_origin(m, h), point, normal), 0);
            assert_int_equal(side(m, he_target(m, h), point, normal), 0);
        }
        he_mesh *after = copy_of(m);
        size_t records = delta->count;
        assert_int_equal(he_plane_split(m, &(he_plane){point, normal, NULL}, NULL, 0, NULL, NULL),
                         HE_OK);
        assert_int_equal(delta->count, records);
        he_mesh_record(m, NULL);
        he_delta_undo(delta, m);
        assert_true(he_mesh_equal_live(m, before));
        he_delta_redo(delta, m);
        assert_equal(m, after);
        he_mesh_free(after);
    }
    he_mesh_record(m, NULL);
    he_plane_parts_clear(&parts);
    he_delta_free(delta);
    he_mesh_free(before);
    return status == HE_OK;
}

/* --- small cases --- */

static const he_vec3 SQUARE[] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};

static void a_square_is_cut_only_if_corners_lie_on_both_sides(void **state)
{
    (void)state;
    static const struct {
        const char *operation;
        uint32_t counts[3];
    } cases[] = {
        {"plane_split point=0,0,0 normal=1,-1,0", {4, 5, 2}},
        {"plane_split point=0.5,0,0 normal=1,0,0", {6, 7, 2}},
        {"plane_split point=0.5,0,0 normal=-3e300,0,0", {6, 7, 2}},
        {"plane_split point=0.5,0,0 normal=5e-324,0,0", {6, 7, 2}},
        {"plane_split point=0.25,0,0 normal=2,-1,0", {6, 7, 2}},
        {"plane_split point=0.5,0,0 normal=2,-1,0", {5, 6, 2}},
        {"plane_split point=0,0,0 normal=2,-1,0", {5, 6, 2}},
        {"plane_split point=3,0,0 normal=1,0,0", {4, 4, 1}},
        {"plane_split point=0,0,0 normal=1,0,0", {4, 4, 1}},
        {"plane_split point=0,0,0 normal=1,1,0", {4, 4, 1}},
        {"plane_split point=0,0,0 normal=0,0,1", {4, 4, 1}},
        {"plane_split point=0.25,0,0 normal=1,0,0 tolerance=0.3", {4, 4, 1}},
        {"plane_split point=0.25,0,0 normal=4,0,0 tolerance=0.2", {6, 7, 2}},
        {"plane_split point=1e-10,0,0 normal=1,-1,0", {4, 5, 2}},
        {"plane_split point=1e-10,0,0 normal=1,-1,0 tolerance=0", {6, 7, 2}},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        print_message("%s\n", cases[i].operation);
        he_mesh *m = script_mesh("0123", SQUARE), *before = copy_of(m);
        script_prepare(m, cases[i].operation);
        assert_counts(m, cases[i].counts[0], cases[i].counts[1], cases[i].counts[2]);
        if (cases[i].counts[2] == 1) {
            assert_equal(m, before);
        }
        he_mesh_free(before);
        he_mesh_free(m);
    }
}

/* If a face is split, one of the parts has the origin of the half-edge that the face stores: this
 * part must keep the face's id. */
static void the_part_of_the_first_side_keeps_the_id_of_the_face(void **state)
{
    (void)state;
    he_mesh *m = script_mesh("0123", SQUARE);
    he_plane_parts parts;
    he_delta *delta = he_delta_new();
    he_changes changes = {.replaced = false};
    assert_non_null(delta);
    he_mesh_record(m, delta);
    assert_int_equal(he_plane_split(m, &(he_plane){(he_vec3){0.25, 0, 0}, (he_vec3){1, 0, 0}, NULL},
                                    NULL, 0, &parts, NULL),
                     HE_OK);
    he_mesh_record(m, NULL);
    assert_face(m, 0, "0453");
    assert_face(m, 1, "4125");
    assert_true(he_position(m, (he_vertex){4}).x == 0.25);
    assert_true(he_position(m, (he_vertex){5}).y == 1);
    assert_int_equal(edge_between(m, 0, 4).i, 0);
    assert_int_equal(edge_between(m, 4, 1).i, 4);
    assert_int_equal(edge_between(m, 2, 5).i, 2);
    assert_int_equal(edge_between(m, 5, 3).i, 5);
    assert_int_equal(parts.edges.ids[0], 6);
    assert_int_equal(parts.faces.ids[0], 1);
    assert_int_equal(he_changes_find(m, delta, 0, delta->count, false, &changes, NULL), HE_OK);
    assert_int_equal(changes.parents[HE_FACE].count, 2);
    assert_int_equal(changes.parents[HE_FACE].ids[1], 0);
    assert_int_equal(changes.parents[HE_EDGE].count, 4);
    assert_int_equal(changes.parents[HE_VERTEX].count, 0);
    he_changes_clear(&changes);
    he_plane_parts_clear(&parts);
    he_delta_free(delta);
    he_mesh_free(m);
}

/* Only the faces in the request's list are split. A neighbour of a split face gets the new vertex
 * on their common edge as a corner, but is not split unless it is in the list itself. */
static void only_listed_faces_are_cut_and_neighbours_get_the_corner(void **state)
{
    (void)state;
    static const he_vec3 strip[] = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0},
                                    {0, 1, 0}, {1, 1, 0}, {2, 1, 0}, {3, 1, 0}};
    he_mesh *m = script_mesh("0154,1265,2376", strip);
    script_prepare(m, "plane_split point=0,0.5,0 normal=0,1,0 faces=0");
    assert_counts(m, 10, 13, 4);
    assert_int_equal(he_face_degree(m, (he_face){0}), 4);
    assert_int_equal(he_face_degree(m, (he_face){1}), 5);
    assert_int_equal(he_face_degree(m, (he_face){2}), 4);
    /* The first split gave the neighbours a corner in the plane: a second split, of all faces, must
     * use this corner instead of making another one. */
    script_prepare(m, "plane_split point=0,0.5,0 normal=0,1,0 faces=2,1,0,3");
    assert_counts(m, 12, 17, 6);
    he_mesh_free(m);
}

static void values_are_copied_to_parts_and_interpolated_at_the_cut(void **state)
{
    (void)state;
    static const he_kind domains[] = {HE_VERTEX, HE_HALFEDGE, HE_EDGE, HE_FACE};
    he_mesh *m = script_mesh("0123", SQUARE);
    for (unsigned k = 0; k < 4; k++) {
        he_column *column = NULL;
        assert_int_equal(he_column_new(&(he_column_schema){"a", domains[k], HE_DOUBLE, 1,
                                                           k < 2 ? HE_INTERPOLATE : HE_COPY},
                                       &column, NULL),
                         HE_OK);
        size_t rows = he_mesh_issued(m, domains[k]);
        assert_int_equal(he_column_extend(column, rows, NULL), HE_OK);
        for (size_t i = 0; i < rows; i++) {
            double value = 10.0 * (double)(i + 1);
            memcpy(he_column_row(column, i), &value, sizeof value);
        }
        assert_int_equal(he_mesh_add_column(m, column, NULL), HE_OK);
    }
    script_prepare(m, "plane_split point=0.25,0,0 normal=1,0,0");
    /* The split makes vertex 4 between 0 and 1, edge 4 from edge 0, and face 1 from face 0. The
     * value of the corner at vertex 4 in face 0 must lie between the values of half-edges 0 and 2,
     * which are the corners at vertices 0 and 1. */
    const struct {
        he_kind domain;
        uint32_t row;
        double value;
    } expected[] = {{HE_VERTEX, 4, 12.5}, {HE_VERTEX, 5, 37.5}, {HE_EDGE, 4, 10}, {HE_EDGE, 5, 30},
                    {HE_FACE, 1, 10},     {HE_HALFEDGE, 8, 15}, {HE_EDGE, 6, 0}};
    for (size_t i = 0; i < sizeof expected / sizeof *expected; i++) {
        double value;
        const he_column *column = he_mesh_find_column(m, expected[i].domain, "a");
        memcpy(&value, he_column_value(column, expected[i].row), sizeof value);
        if (!(fabs(value - expected[i].value) < 1e-12)) {
            fail_msg("%s %u holds %g, not %g", he_kind_name(expected[i].domain), expected[i].row,
                     value, expected[i].value);
        }
    }
    he_mesh_free(m);
}

static void what_cannot_be_cut_is_refused_and_changes_nothing(void **state)
{
    (void)state;
    he_mesh *m = script_mesh("0123,3210", SQUARE), *before = copy_of(m);
    he_vec3 middle = {0.5, 0, 0}, across = {1, 0, 0};
    const double below = -1, none = NAN;
    static const uint32_t twice[] = {0, 1, 0}, fifth[] = {4};
    const struct {
        he_vec3 point, normal;
        const double *tolerance;
        const uint32_t *faces;
        size_t count;
        he_status expected;
    } cases[] = {
        {middle, ORIGIN, NULL, NULL, 0, HE_BAD_VALUE},
        {middle, {NAN, 0, 1}, NULL, NULL, 0, HE_NOT_FINITE},
        {{0, INFINITY, 0}, across, NULL, NULL, 0, HE_NOT_FINITE},
        {middle, across, &none, NULL, 0, HE_NOT_FINITE},
        {middle, across, &below, NULL, 0, HE_BAD_VALUE},
        {middle, across, NULL, twice, 3, HE_REPEATED_ELEMENT},
        {middle, across, NULL, fifth, 1, HE_NO_SUCH_ELEMENT},
        {middle, across, NULL, NULL, 0, HE_DOUBLED_EDGE},
        {ORIGIN, {1, -1, 0}, NULL, NULL, 0, HE_DOUBLED_EDGE},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        he_error err = {.status = HE_OK};
        he_plane_parts parts = {.faces_split = 77};
        assert_int_equal(
            he_plane_split(m, &(he_plane){cases[i].point, cases[i].normal, cases[i].tolerance},
                           cases[i].faces, cases[i].count, &parts, &err),
            cases[i].expected);
        assert_int_equal(err.status, cases[i].expected);
        assert_int_equal(parts.faces_split, 77);
        assert_equal(m, before);
    }
    /* The plane meets two sheets of faces: splitting both sheets is refused, but the faces of one
     * sheet can be split. */
    script_prepare(m, "plane_split point=0.5,0,0 normal=1,0,0 faces=1");
    assert_counts(m, 6, 7, 3);
    he_mesh_free(before);
    he_mesh_free(m);
}

/* --- concave faces --- */

typedef struct point {
    double x, y;
} point;

static double area2(const he_mesh *m, const point *at, uint32_t f)
{
    double sum = 0;
    he_halfedge first = he_face_halfedge(m, (he_face){f}), h = first;
    do {
        point a = at[he_origin(m, h).i], b = at[he_target(m, h).i];
        sum += a.x * b.y - a.y * b.x;
        h = he_next(m, h);
    } while (h.i != first.i);
    return sum;
}

/* Maps a point to a tilted plane far from the origin; back() is the inverse. */
static he_vec3 lay(point p, double scale)
{
    return (he_vec3){scale * (0.6 * p.x - 0.48 * p.y + 10), scale * (0.8 * p.y + 3),
                     scale * (0.8 * p.x + 0.36 * p.y - 7)};
}

static point back(he_vec3 p, double scale)
{
    he_vec3 q = {p.x / scale - 10, p.y / scale - 3, p.z / scale + 7};
    return (point){0.6 * q.x + 0.8 * q.z, q.y / 0.8};
}

/* Splits a polygon at the line y = height. There must be `parts` parts, none of them may be turned
 * over, and the areas of the parts must add up to the area of the polygon. */
static void check_cut(const point *points, uint32_t n, double height, uint32_t parts, double scale)
{
    he_soup soup;
    he_mesh *m = NULL;
    double whole = 0, sum = 0;
    he_soup_init(&soup, NULL);
    assert_int_equal(he_soup_begin_face(&soup, NULL), HE_OK);
    for (uint32_t i = 0; i < n; i++) {
        point next = points[(i + 1) % n];
        whole += points[i].x * next.y - points[i].y * next.x;
        assert_int_equal(he_soup_add_vertex(&soup, lay(points[i], scale), NULL), HE_OK);
        assert_int_equal(he_soup_add_corner(&soup, i, NULL), HE_OK);
    }
    assert_int_equal(he_build(&soup, HE_BUILD_TAKE, &m, NULL, NULL), HE_OK);
    he_soup_clear(&soup);
    /* The normal of the cutting plane lies in the tilted plane of the polygon. It is the image of
     * the y axis of the coordinates in which the polygon's points are given. */
    he_vec3 normal = {-0.48, 0.8, 0.36};
    assert_int_equal(he_plane_split(m, &(he_plane){lay((point){5, height}, scale), normal, NULL},
                                    NULL, 0, NULL, NULL),
                     HE_OK);
    assert_valid(m);
    assert_int_equal(he_mesh_faces(m), parts);
    uint32_t vertices = he_mesh_vertices(m);
    point *at = malloc(vertices * sizeof *at);
    assert_non_null(at);
    for (uint32_t v = 0; v < vertices; v++) {
        at[v] = back(he_position(m, (he_vertex){v}), scale);
    }
    for (uint32_t f = 0; f < parts; f++) {
        double part = area2(m, at, f);
        assert_true(part > 1e-9);
        sum += part;
        bool above = false, below = false;
        he_halfedge first = he_face_halfedge(m, (he_face){f}), h = first;
        do {
            above |= at[he_origin(m, h).i].y > height + 1e-6;
            below |= at[he_origin(m, h).i].y < height - 1e-6;
            h = he_next(m, h);
        } while (h.i != first.i);
        assert_true(above != below);
    }
    assert_true(fabs(sum - whole) < 1e-9 * whole);
    free(at);
    he_mesh_free(m);
}

static void parts_of_a_concave_face_are_one_sided_and_fill_it(void **state)
{
    (void)state;
    static const point angle[] = {{0, 0}, {3, 0}, {3, 1}, {1, 1}, {1, 3}, {0, 3}};
    static const point bridge[] = {{0, 0}, {1, 0}, {1, 2}, {2, 2}, {2, 0}, {3, 0}, {3, 3}, {0, 3}};
    static const point ring[] = {{0, 0}, {5, 0}, {5, 5}, {0, 5}, {0, 3}, {1, 3},
                                 {1, 4}, {4, 4}, {4, 1}, {1, 1}, {1, 2}, {0, 2}};
    static const point spiral[] = {{0, 0}, {9, 0}, {9, 9}, {2, 9}, {2, 4}, {5, 4}, {5, 6}, {4, 6},
                                   {4, 5}, {3, 5}, {3, 8}, {8, 8}, {8, 1}, {1, 1}, {1, 9}, {0, 9}};
    check_cut(angle, 6, 1, 2, 1);
    check_cut(angle, 6, 0.5, 2, 1);
    check_cut(angle, 6, 2, 2, 1);
    check_cut(bridge, 8, 1, 3, 1);
    check_cut(bridge, 8, 2, 3, 1);
    check_cut(bridge, 8, 2.5, 2, 1);
    check_cut(bridge, 8, 0, 1, 1);
    check_cut(bridge, 8, 3, 1, 1);
    check_cut(ring, 12, 2.5, 2, 1);
    check_cut(ring, 12, 1, 3, 1);
    check_cut(ring, 12, 1.5, 3, 1);
    check_cut(ring, 12, 4.5, 2, 1);
    check_cut(spiral, 16, 4.5, 4, 1);
    check_cut(spiral, 16, 5, 5, 1);
    check_cut(spiral, 16, 8, 4, 1);
}

static void a_comb_of_3000_teeth_is_cut_into_teeth_and_back(void **state)
{
    (void)state;
    enum { TEETH = 3000 };
    point *points = malloc((2 * TEETH + 3) * sizeof *points);
    uint32_t n = 0;
    assert_non_null(points);
    points[n++] = (point){0, -1};
    points[n++] = (point){2 * TEETH, -1};
    for (uint32_t i = 0; i <= 2 * TEETH; i++) {
        points[n++] = (point){2 * TEETH - i, i % 2 ? 5 : 1};
        if (n == 2 * TEETH + 3) {
            break;
        }
    }
    check_cut(points, n, 2, TEETH + 1, 1);
    check_cut(points, n, 1, TEETH + 1, 1);
    check_cut(points, n, 0, 2, 1);
    free(points);
}

/* Polygons with corners at integer heights are split at integer heights. Some corners and sides
 * therefore lie in the cutting plane or touch it from above or below, also at the polygon's left
 * and right ends. */
static void random_profiles_have_one_part_for_each_rise_above_the_cut(void **state)
{
    (void)state;
    static const double scales[] = {1, 1e300, 1e-300};
    uint64_t seed = seed_setting("SEED", 1), rounds = seed_setting("ROUNDS", 3000);
    for (uint64_t round = 0; round < rounds; round++) {
        md_random r = {seed + round};
        print_message("SEED=%llu ROUNDS=1\n", (unsigned long long)r.state);
        uint32_t n = md_from(&r, 1, 12), heights = md_from(&r, 1, 4), above = 0;
        point points[16];
        uint32_t h[16], cut = md_below(&r, heights + 1), count = 0;
        points[count++] = (point){0, -1};
        points[count++] = (point){n, -1};
        for (uint32_t i = 0; i <= n; i++) {
            h[i] = md_below(&r, heights + 1);
        }
        for (uint32_t i = n + 1; i-- > 0;) {
            points[count++] = (point){i, h[i]};
        }
        /* Counts the parts of the polygon above the cutting line: a side with an end above the line
         * begins a new part, unless the side before it ends above the line. */
        for (uint32_t i = 0; i < n; i++) {
            above += h[i] > cut || h[i + 1] > cut;
            above -= i > 0 && h[i] > cut;
        }
        /* `turned` has the points of the polygon, but begins at a random one. */
        point turned[16];
        uint32_t start = md_below(&r, count);
        for (uint32_t i = 0; i < count; i++) {
            turned[i] = points[(start + i) % count];
        }
        check_cut(turned, count, cut, above + 1, scales[md_below(&r, 3)]);
    }
}

/* --- meshes --- */

static he_vec3 random_vector(md_random *r)
{
    return (he_vec3){md_unit(r) * 2 - 1, md_unit(r) * 2 - 1, md_unit(r) * 2 - 1};
}

static void cut_shapes_keep_topology_and_area_with_faces_on_one_side(void **state)
{
    (void)state;
    static const char *const names[] = {"cube",      "dodecahedron", "icosahedron",
                                        "icosphere", "grid",         "torus"};
    md_random r = {seed_setting("SEED", 1)};
    for (unsigned i = 0; i < sizeof names / sizeof *names; i++) {
        for (unsigned k = 0; k < 20; k++) {
            print_message("%s, plane %u\n", names[i], k);
            he_mesh *m = shape(names[i], 0, 0);
            /* Quadrilaterals of the torus need not be planar, so a split may change the torus's
             * area. */
            bool flat = strcmp(names[i], "torus") != 0;
            double area = area_of(m);
            he_vec3 normal = k == 0 ? UP : random_vector(&r);
            he_vec3 at = k < 2 ? ORIGIN : he_vec3_scale(random_vector(&r), 0.3);
            assert_true(split_and_check(m, at, normal, true));
            assert_true(!flat || fabs(area_of(m) - area) < 1e-9 * area);
            /* The mesh is split again and again by planes in random directions through one
             * point. */
            for (unsigned fold = 0; fold < 4; fold++) {
                assert_true(split_and_check(m, at, random_vector(&r), flat));
            }
            assert_true(!flat || fabs(area_of(m) - area) < 1e-9 * area);
            he_mesh_free(m);
        }
    }
}

/* memory for the random shapes, allocated once because their tables are large */
static or_mesh *shapes;

static he_mesh *random_mesh(md_random *r)
{
    shapes = shapes == NULL ? or_new() : shapes;
    md_shape(shapes, r, md_fill_mixed);
    he_mesh *m = md_build(shapes);
    assert_non_null(m);
    return m;
}

static bool triangulate(he_mesh *m)
{
    he_ids faces = {0};
    bool done = true;
    for (uint32_t f = 0; f < he_mesh_issued(m, HE_FACE); f++) {
        assert_int_equal(he_ids_add(&faces, f, NULL), HE_OK);
    }
    if (faces.count > 0) {
        he_status status = he_face_triangulate(m, faces.ids, faces.count, NULL, NULL, NULL, NULL);
        assert_true(status == HE_OK || status == HE_DOUBLED_EDGE);
        done = status == HE_OK;
    }
    he_ids_clear(&faces);
    return done;
}

/* Chooses a plane through three vertices of the mesh, or a random plane. */
static void random_plane(const he_mesh *m, md_random *r, he_vec3 *at, he_vec3 *normal)
{
    uint32_t n = he_mesh_issued(m, HE_VERTEX);
    *at = random_vector(r);
    *normal = random_vector(r);
    if (n >= 3 && md_chance(r, 40)) {
        he_vec3 p[3];
        for (unsigned i = 0; i < 3; i++) {
            p[i] = he_position(m, (he_vertex){md_below(r, n)});
        }
        he_vec3 across = he_vec3_cross(he_vec3_sub(p[1], p[0]), he_vec3_sub(p[2], p[0]));
        if (he_vec3_extent(across) > 0.1) {
            *at = p[0];
            *normal = across;
        }
    }
}

static void random_meshes_are_cut_as_predicted_or_stay_unchanged(void **state)
{
    (void)state;
    uint64_t seed = seed_setting("SEED", 1), rounds = seed_setting("ROUNDS", 1500);
    uint64_t done = 0, refused = 0;
    for (uint64_t round = 0; round < rounds; round++) {
        md_random r = {seed + round};
        print_message("SEED=%llu ROUNDS=1\n", (unsigned long long)r.state);
        he_mesh *m = random_mesh(&r);
        bool triangles = md_chance(&r, 50) && triangulate(m);
        for (unsigned k = 0; k < 3; k++) {
            he_vec3 at, normal;
            random_plane(m, &r, &at, &normal);
            double area = area_of(m);
            if (split_and_check(m, at, normal, triangles && k == 0)) {
                done++;
                assert_true(!triangles || fabs(area_of(m) - area) < 1e-7 * (1 + area));
            } else {
                refused++;
            }
        }
        he_mesh_free(m);
    }
    print_message("%llu done, %llu refused\n", (unsigned long long)done,
                  (unsigned long long)refused);
    assert_true(rounds < 100 || done > 20 * refused);
}

static void a_plane_split_without_memory_leaves_the_mesh_unchanged(void **state)
{
    (void)state;
    for (unsigned record = 0; record < 2; record++) {
        failing f = {0};
        while (failing_next(&f)) {
            failing_pause();
            he_mesh *m = shape("cube", 0, 0), *before;
            script_add_columns(m);
            before = copy_of(m);
            he_delta *delta = record ? he_delta_new() : NULL;
            he_mesh_record(m, delta);
            he_plane_parts parts = {.faces_split = 77};
            failing_resume();
            he_status status = he_plane_split(m, &(he_plane){ORIGIN, (he_vec3){1, 2, 3}, NULL},
                                              NULL, 0, &parts, NULL);
            bool failed = !failing_status(&f, status);
            he_mesh_record(m, NULL);
            if (failed) {
                assert_equal(m, before);
                assert_int_equal(parts.faces_split, 77);
            } else {
                he_plane_parts_clear(&parts);
            }
            he_delta_free(delta);
            he_mesh_free(before);
            he_mesh_free(m);
        }
        assert_true(f.n > 5);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_square_is_cut_only_if_corners_lie_on_both_sides),
        cmocka_unit_test(the_part_of_the_first_side_keeps_the_id_of_the_face),
        cmocka_unit_test(only_listed_faces_are_cut_and_neighbours_get_the_corner),
        cmocka_unit_test(values_are_copied_to_parts_and_interpolated_at_the_cut),
        cmocka_unit_test(what_cannot_be_cut_is_refused_and_changes_nothing),
        cmocka_unit_test(parts_of_a_concave_face_are_one_sided_and_fill_it),
        cmocka_unit_test(a_comb_of_3000_teeth_is_cut_into_teeth_and_back),
        cmocka_unit_test(random_profiles_have_one_part_for_each_rise_above_the_cut),
        cmocka_unit_test(cut_shapes_keep_topology_and_area_with_faces_on_one_side),
        cmocka_unit_test(random_meshes_are_cut_as_predicted_or_stay_unchanged),
        cmocka_unit_test(a_plane_split_without_memory_leaves_the_mesh_unchanged),
    };
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    or_free(shapes);
    return failed;
}
