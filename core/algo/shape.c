#include "algo/shape.h"

#include "algo/solid.h"
#include "format/text/number.h"

#include <assert.h>
#include <math.h>
#include <string.h>

static const double QUARTER_TURN = 1.57079632679489661923;

/* Computes point i of the n points that divide the unit circle evenly. Whole quarter turns are
 * split off first, so that points on the axes are exact and the circle is as symmetric as n
 * allows. */
static void circle_point(uint32_t i, uint32_t n, double *x, double *y)
{
    uint64_t quarters = 4 * (uint64_t)i;
    double angle = QUARTER_TURN * (double)(quarters % n) / n;
    double c = cos(angle), s = sin(angle);
    switch (quarters / n % 4) {
    case 0:
        *x = c;
        *y = s;
        break;
    case 1:
        *x = -s;
        *y = c;
        break;
    case 2:
        *x = -c;
        *y = -s;
        break;
    default: /* case 3: quarter turns are counted modulo 4 */
        *x = s;
        *y = -c;
        break;
    }
}

/* Adds n vertices on a circle around the z axis, counter-clockwise as seen from above. */
static void circle(he_soup *soup, uint32_t n, double radius, double z)
{
    for (uint32_t i = 0; i < n; i++) {
        double x, y;
        circle_point(i, n, &x, &y);
        he_solid_vertex(soup, radius * x, radius * y, z);
    }
}

/* Adds a polygon over the n vertices from `first` on. The polygon faces up; if `up` is false, its
 * vertices are taken in reverse order and it faces down. */
static void cap(he_soup *soup, uint32_t first, uint32_t n, bool up)
{
    assert(soup->face_count < soup->face_capacity);
    assert(n <= soup->corner_capacity - soup->corner_count);
    soup->starts[soup->face_count++] = (uint32_t)soup->corner_count;
    for (uint32_t i = 0; i < n; i++) {
        soup->corners[soup->corner_count++] = first + (up ? i : n - 1 - i);
    }
}

/* Adds a fan of triangles between the vertex `tip` and the circle of the n vertices from `first`
 * on. If `up` is true, the circle must be counter-clockwise as seen from `tip`; if it is false,
 * clockwise. */
static void fan(he_soup *soup, uint32_t first, uint32_t n, uint32_t tip, bool up)
{
    for (uint32_t i = 0; i < n; i++) {
        uint32_t a = first + i, b = first + (i + 1) % n;
        he_solid_face(soup, (uint32_t[]){up ? a : b, up ? b : a, tip}, 3);
    }
}

/* Adds a ring of n quads between two circles of n vertices, whose first vertices are `below` and
 * `above`. The normals of the quads point away from the axis if the circle of `above` is higher. */
static void band(he_soup *soup, uint32_t below, uint32_t above, uint32_t n)
{
    for (uint32_t i = 0; i < n; i++) {
        uint32_t j = (i + 1) % n;
        he_solid_face(soup, (uint32_t[]){below + i, below + j, above + j, above + i}, 4);
    }
}

static he_shape_size tetrahedron_size(const double *args)
{
    (void)args;
    return (he_shape_size){4, 4, 12};
}

static void tetrahedron_fill(const double *args, he_soup *soup)
{
    he_solid_tetrahedron(soup, args[0]);
}

static he_shape_size cube_size(const double *args)
{
    (void)args;
    return (he_shape_size){8, 6, 24};
}

static void cube_fill(const double *args, he_soup *soup)
{
    he_solid_cube(soup, args[0]);
}

static he_shape_size octahedron_size(const double *args)
{
    (void)args;
    return (he_shape_size){6, 8, 24};
}

static void octahedron_fill(const double *args, he_soup *soup)
{
    he_solid_octahedron(soup, args[0]);
}

static he_shape_size icosahedron_size(const double *args)
{
    (void)args;
    return (he_shape_size){12, 20, 60};
}

static void icosahedron_fill(const double *args, he_soup *soup)
{
    he_solid_icosahedron(soup, args[0]);
}

static he_shape_size dodecahedron_size(const double *args)
{
    (void)args;
    return (he_shape_size){20, 12, 60};
}

static void dodecahedron_fill(const double *args, he_soup *soup)
{
    he_solid_dodecahedron(soup, args[0]);
}

static he_shape_size icosphere_size(const double *args)
{
    uint64_t parts = (uint64_t)1 << 2 * (unsigned)args[0];
    return (he_shape_size){10 * parts + 2, 20 * parts, 60 * parts};
}

static void icosphere_fill(const double *args, he_soup *soup)
{
    he_solid_icosphere(soup, (unsigned)args[0], args[1]);
}

static he_shape_size uv_sphere_size(const double *args)
{
    uint64_t n = (uint64_t)args[0], bands = (uint64_t)args[1];
    return (he_shape_size){n * (bands - 1) + 2, n * bands, 4 * n * (bands - 2) + 6 * n};
}

/* The sphere's vertices are numbered in this order: the south pole, the circles of latitude from
 * south to north, the north pole. */
static void uv_sphere_fill(const double *args, he_soup *soup)
{
    uint32_t n = (uint32_t)args[0], bands = (uint32_t)args[1];
    double radius = args[2];
    he_solid_vertex(soup, 0, 0, -radius);
    for (uint32_t i = 1; i < bands && he_solid_goes_on(soup); i++) {
        double out, down;
        circle_point(i, 2 * bands, &down, &out);
        circle(soup, n, radius * out, -radius * down);
    }
    uint32_t north = (uint32_t)soup->vertex_count;
    he_solid_vertex(soup, 0, 0, radius);
    fan(soup, 1, n, 0, false);
    for (uint32_t i = 0; i + 2 < bands && he_solid_goes_on(soup); i++) {
        band(soup, 1 + i * n, 1 + (i + 1) * n, n);
    }
    fan(soup, north - n, n, north, true);
}

static he_shape_size grid_size(const double *args)
{
    uint64_t columns = (uint64_t)args[0], rows = (uint64_t)args[1];
    return (he_shape_size){(columns + 1) * (rows + 1), columns * rows, 4 * columns * rows};
}

static void grid_fill(const double *args, he_soup *soup)
{
    uint32_t columns = (uint32_t)args[0], rows = (uint32_t)args[1];
    double width = args[2], height = args[3];
    for (uint32_t j = 0; j <= rows && he_solid_goes_on(soup); j++) {
        for (uint32_t i = 0; i <= columns; i++) {
            he_solid_vertex(soup, width * (i / (double)columns - 0.5),
                            height * (j / (double)rows - 0.5), 0);
        }
    }
    for (uint32_t j = 0; j < rows && he_solid_goes_on(soup); j++) {
        for (uint32_t i = 0; i < columns; i++) {
            uint32_t a = j * (columns + 1) + i, b = a + columns + 1;
            he_solid_face(soup, (uint32_t[]){a, a + 1, b + 1, b}, 4);
        }
    }
}

static he_shape_size torus_size(const double *args)
{
    uint64_t quads = (uint64_t)args[0] * (uint64_t)args[1];
    return (he_shape_size){quads, quads, 4 * quads};
}

/* The torus is a ring of circles around its tube; the vertices are numbered circle by circle, and
 * along each circle. */
static void torus_fill(const double *args, he_soup *soup)
{
    uint32_t major = (uint32_t)args[0], minor = (uint32_t)args[1];
    for (uint32_t i = 0; i < major && he_solid_goes_on(soup); i++) {
        double x, y;
        circle_point(i, major, &x, &y);
        for (uint32_t j = 0; j < minor; j++) {
            double out, up;
            circle_point(j, minor, &out, &up);
            double r = args[2] + args[3] * out;
            he_solid_vertex(soup, r * x, r * y, args[3] * up);
        }
    }
    for (uint32_t i = 0; i < major && he_solid_goes_on(soup); i++) {
        uint32_t a = i * minor, b = (i + 1) % major * minor;
        for (uint32_t j = 0; j < minor; j++) {
            uint32_t k = (j + 1) % minor;
            he_solid_face(soup, (uint32_t[]){a + j, b + j, b + k, a + k}, 4);
        }
    }
}

static he_shape_size cylinder_size(const double *args)
{
    uint64_t n = (uint64_t)args[0], caps = args[3] != 0 ? 2 : 0;
    return (he_shape_size){2 * n, n + caps, 4 * n + caps * n};
}

static void cylinder_fill(const double *args, he_soup *soup)
{
    uint32_t n = (uint32_t)args[0];
    circle(soup, n, args[1], -args[2] / 2);
    circle(soup, n, args[1], args[2] / 2);
    band(soup, 0, n, n);
    if (args[3] != 0) {
        cap(soup, 0, n, false);
        cap(soup, n, n, true);
    }
}

static he_shape_size cone_size(const double *args)
{
    uint64_t n = (uint64_t)args[0], caps = args[3] != 0 ? 1 : 0;
    return (he_shape_size){n + 1, n + caps, 3 * n + caps * n};
}

static void cone_fill(const double *args, he_soup *soup)
{
    uint32_t n = (uint32_t)args[0];
    circle(soup, n, args[1], -args[2] / 2);
    he_solid_vertex(soup, 0, 0, args[2] / 2);
    fan(soup, 0, n, n, true);
    if (args[3] != 0) {
        cap(soup, 0, n, false);
    }
}

static he_shape_size disk_size(const double *args)
{
    uint64_t n = (uint64_t)args[0];
    return (he_shape_size){n + 1, n, 3 * n};
}

static void disk_fill(const double *args, he_soup *soup)
{
    uint32_t n = (uint32_t)args[0];
    circle(soup, n, args[1], 0);
    he_solid_vertex(soup, 0, 0, args[2]);
    fan(soup, 0, n, n, true);
}

static he_shape_size polygon_size(const double *args)
{
    uint64_t n = (uint64_t)args[0];
    return (he_shape_size){n, 1, n};
}

static void polygon_fill(const double *args, he_soup *soup)
{
    uint32_t n = (uint32_t)args[0];
    circle(soup, n, args[1], 0);
    cap(soup, 0, n, true);
}

/* The largest length that a shape may have. The square of a much larger length would overflow. */
#define LONGEST 1e100
/* The largest number of segments along one side of a shape. A shape with so many segments along two
 * sides is too large for a mesh; the limits on vertices and faces refuse it. */
#define MOST 16777216

#define LENGTH(name, fallback, doc)                            \
    {                                                          \
        name, HE_SHAPE_NUMBER, true, fallback, 0, LONGEST, doc \
    }
#define COUNT(name, fallback, min, max, doc)                   \
    {                                                          \
        name, HE_SHAPE_INTEGER, false, fallback, min, max, doc \
    }
#define FLAG(name, fallback, doc)                       \
    {                                                   \
        name, HE_SHAPE_FLAG, false, fallback, 0, 1, doc \
    }

static const he_shape shapes[] = {
    {"tetrahedron",
     "Four triangles.",
     {LENGTH("radius", 1, "radius of the sphere through the vertices")},
     tetrahedron_size,
     tetrahedron_fill},
    {"cube", "Six squares.", {LENGTH("size", 1, "length of an edge")}, cube_size, cube_fill},
    {"octahedron",
     "Eight triangles.",
     {LENGTH("radius", 1, "radius of the sphere through the vertices")},
     octahedron_size,
     octahedron_fill},
    {"icosahedron",
     "Twenty triangles.",
     {LENGTH("radius", 1, "radius of the sphere through the vertices")},
     icosahedron_size,
     icosahedron_fill},
    {"dodecahedron",
     "Twelve pentagons.",
     {LENGTH("radius", 1, "radius of the sphere through the vertices")},
     dodecahedron_size,
     dodecahedron_fill},
    {"icosphere",
     "A sphere of nearly equal triangles: an icosahedron, subdivided.",
     {COUNT("subdivisions", 2, 0, 12, "how often each triangle is divided into four"),
      LENGTH("radius", 1, "radius of the sphere")},
     icosphere_size,
     icosphere_fill},
    {"uv_sphere",
     "A sphere of quads between circles of latitude, with triangles at the poles.",
     {COUNT("segments", 32, 3, MOST, "number of vertices on each circle of latitude"),
      COUNT("rings", 16, 2, MOST, "number of bands from pole to pole"),
      LENGTH("radius", 1, "radius of the sphere")},
     uv_sphere_size,
     uv_sphere_fill},
    {"grid",
     "A flat rectangle of quads that faces up.",
     {COUNT("columns", 10, 1, MOST, "number of cells along x"),
      COUNT("rows", 10, 1, MOST, "number of cells along y"), LENGTH("width", 1, "length along x"),
      LENGTH("height", 1, "length along y")},
     grid_size,
     grid_fill},
    {"torus",
     "A ring of quads about the z axis.",
     {COUNT("major_segments", 32, 3, MOST, "number of segments around the axis"),
      COUNT("minor_segments", 16, 3, MOST, "number of segments around the tube"),
      LENGTH("major_radius", 1, "distance from the axis to the middle of the tube"),
      LENGTH("minor_radius", 0.25, "radius of the tube")},
     torus_size,
     torus_fill},
    {"cylinder",
     "A tube of quads around the z axis, open or closed by a polygon at each end.",
     {COUNT("segments", 32, 3, MOST, "sides"), LENGTH("radius", 1, "radius of the circles"),
      LENGTH("height", 2, "height along z"), FLAG("caps", 1, "close the ends")},
     cylinder_size,
     cylinder_fill},
    {"cone",
     "Triangles from a circle to a tip above it. The circle is closed by a polygon or open.",
     {COUNT("segments", 32, 3, MOST, "sides"), LENGTH("radius", 1, "radius of the circle"),
      LENGTH("height", 2, "height along z"), FLAG("caps", 1, "close the base")},
     cone_size,
     cone_fill},
    {"disk",
     "A disk of triangles around its centre that faces up.",
     {COUNT("segments", 32, 3, MOST, "triangles"),
      LENGTH("radius", 1, "radius of the circle"),
      {"height", HE_SHAPE_NUMBER, false, 0, -LONGEST, LONGEST,
       "height of the centre above the circle"}},
     disk_size,
     disk_fill},
    {"polygon",
     "One regular polygon that faces up.",
     {COUNT("sides", 6, 3, MOST, "corners"),
      LENGTH("radius", 1, "radius of the circle through the corners")},
     polygon_size,
     polygon_fill},
};

size_t he_shape_count(void)
{
    return sizeof shapes / sizeof shapes[0];
}

const he_shape *he_shape_at(size_t i)
{
    return &shapes[i];
}

const he_shape *he_shape_find(const char *name, size_t length)
{
    for (size_t i = 0; i < he_shape_count(); i++) {
        if (strlen(shapes[i].name) == length && memcmp(shapes[i].name, name, length) == 0) {
            return &shapes[i];
        }
    }
    return NULL;
}

size_t he_shape_params(const he_shape *shape)
{
    size_t n = 0;
    while (n < HE_SHAPE_PARAMS && shape->params[n].name != NULL) {
        n++;
    }
    return n;
}

void he_shape_defaults(const he_shape *shape, double args[HE_SHAPE_PARAMS])
{
    for (size_t i = 0; i < HE_SHAPE_PARAMS; i++) {
        args[i] = shape->params[i].fallback;
    }
}

/* The text of a number in a message; it has a decimal point in every locale. */
typedef struct shown {
    char text[HE_NUMBER_TEXT + 1];
} shown;

static shown show(double x)
{
    shown s;
    s.text[he_double_print(x, s.text)] = '\0';
    return s;
}

static he_status check_one(const he_shape_param *p, double x, he_error *err)
{
    if (!isfinite(x)) {
        return he_fail_plain(err, HE_NOT_FINITE, "%s is not a finite number", p->name);
    }
    if (x < p->min || x > p->max || (p->exclusive && x == p->min)) {
        return he_fail_plain(err, HE_BAD_VALUE, "%s is %s, but must be %s %s and at most %s",
                             p->name, show(x).text, p->exclusive ? "above" : "at least",
                             show(p->min).text, show(p->max).text);
    }
    if (p->type != HE_SHAPE_NUMBER && x != floor(x)) {
        return he_fail_plain(err, HE_BAD_VALUE, "%s is %s, which is not a whole number", p->name,
                             show(x).text);
    }
    return HE_OK;
}

he_status he_shape_check(const he_shape *shape, const double args[HE_SHAPE_PARAMS], size_t *param,
                         he_error *err)
{
    for (size_t i = 0; i < he_shape_params(shape); i++) {
        he_status status = check_one(&shape->params[i], args[i], err);
        if (status != HE_OK) {
            if (param != NULL) {
                *param = i;
            }
            return status;
        }
    }
    return HE_OK;
}

static he_status within(const he_shape *shape, uint64_t count, uint64_t limit, const char *what,
                        he_error *err)
{
    /* A mesh has no more edges than corners, so limiting the corners to HE_MAX_ROWS also limits the
     * edges. */
    if (limit == 0 || limit > HE_MAX_ROWS) {
        limit = HE_MAX_ROWS;
    }
    if (count > limit) {
        return he_fail_plain(err, HE_LIMIT, "this %s would have %llu %s; at most %llu are allowed",
                             shape->name, (unsigned long long)count, what,
                             (unsigned long long)limit);
    }
    return HE_OK;
}

static uint64_t bytes_of(he_shape_size size)
{
    return size.vertices * sizeof(he_vec3) + (size.faces + size.corners) * sizeof(uint32_t);
}

static he_status check_limits(const he_shape *shape, he_shape_size size, const he_limits *limits,
                              he_error *err)
{
    he_status status = within(shape, size.vertices, limits->vertices, "vertices", err);
    if (status == HE_OK) {
        status = within(shape, size.faces, limits->faces, "faces", err);
    }
    if (status == HE_OK) {
        status = within(shape, size.corners, limits->corners, "corners", err);
    }
    if (status == HE_OK && limits->bytes != 0 && bytes_of(size) > limits->bytes) {
        status = he_fail_plain(
            err, HE_LIMIT, "this %s would need %llu bytes; at most %llu are allowed", shape->name,
            (unsigned long long)bytes_of(size), (unsigned long long)limits->bytes);
    }
    return status;
}

he_status he_shape_make(const he_shape *shape, const double args[HE_SHAPE_PARAMS],
                        const he_limits *limits, he_soup *out, he_error *err)
{
    static const he_limits none = {0};
    if (limits == NULL) {
        limits = &none;
    }
    he_status status = he_shape_check(shape, args, NULL, err);
    if (status != HE_OK) {
        return status;
    }
    he_shape_size size = shape->size(args);
    status = check_limits(shape, size, limits, err);
    if (status != HE_OK) {
        return status;
    }
    he_soup soup;
    he_soup_init(&soup, limits);
    soup.positions = he_mem_array(NULL, size.vertices, sizeof *soup.positions);
    soup.corners = he_mem_array(NULL, size.corners, sizeof *soup.corners);
    soup.starts = he_mem_array(NULL, size.faces, sizeof *soup.starts);
    if (soup.positions == NULL || soup.corners == NULL || soup.starts == NULL) {
        he_soup_clear(&soup);
        return he_fail_plain(err, HE_NO_MEMORY, "no memory for a %s of %llu vertices", shape->name,
                             (unsigned long long)size.vertices);
    }
    soup.vertex_capacity = size.vertices;
    soup.corner_capacity = size.corners;
    soup.face_capacity = size.faces;
    status = he_progress_phase(limits->progress, "shaping", 1, err);
    if (status == HE_OK) {
        shape->fill(args, &soup);
        status = he_progress_step(limits->progress, 1, 1, err);
    }
    if (status != HE_OK) {
        he_soup_clear(&soup);
        return status;
    }
    *out = soup;
    return HE_OK;
}
