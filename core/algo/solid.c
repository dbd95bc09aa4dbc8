#include "algo/solid.h"

#include "geometry/vec3.h"

#include <assert.h>
#include <string.h>

bool he_solid_goes_on(const he_soup *soup)
{
    return he_progress_step(soup->limits.progress, soup->vertex_count + soup->corner_count,
                            soup->vertex_capacity + soup->corner_capacity, NULL) == HE_OK;
}

void he_solid_vertex(he_soup *soup, double x, double y, double z)
{
    assert(soup->vertex_count < soup->vertex_capacity);
    /* Adding 0.0 turns -0.0 into 0.0, so that no coordinate is printed as -0. */
    soup->positions[soup->vertex_count++] = (he_vec3){x + 0.0, y + 0.0, z + 0.0};
}

void he_solid_face(he_soup *soup, const uint32_t *corners, size_t count)
{
    assert(soup->face_count < soup->face_capacity);
    assert(count <= soup->corner_capacity - soup->corner_count);
    soup->starts[soup->face_count++] = (uint32_t)soup->corner_count;
    memcpy(soup->corners + soup->corner_count, corners, count * sizeof *corners);
    soup->corner_count += count;
}

static void triangle(he_soup *soup, uint32_t a, uint32_t b, uint32_t c)
{
    he_solid_face(soup, (uint32_t[]){a, b, c}, 3);
}

void he_solid_tetrahedron(he_soup *soup, double radius)
{
    double r = radius / sqrt(3);
    he_solid_vertex(soup, r, r, r);
    he_solid_vertex(soup, r, -r, -r);
    he_solid_vertex(soup, -r, r, -r);
    he_solid_vertex(soup, -r, -r, r);
    triangle(soup, 0, 1, 2);
    triangle(soup, 0, 2, 3);
    triangle(soup, 0, 3, 1);
    triangle(soup, 1, 3, 2);
}

void he_solid_cube(he_soup *soup, double size)
{
    static const uint32_t sides[6][4] = {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4},
                                         {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}};
    double r = size / 2;
    for (int i = 0; i < 2; i++) {
        double z = i == 0 ? -r : r;
        he_solid_vertex(soup, -r, -r, z);
        he_solid_vertex(soup, r, -r, z);
        he_solid_vertex(soup, r, r, z);
        he_solid_vertex(soup, -r, r, z);
    }
    for (int i = 0; i < 6; i++) {
        he_solid_face(soup, sides[i], 4);
    }
}

void he_solid_octahedron(he_soup *soup, double radius)
{
    he_solid_vertex(soup, radius, 0, 0);
    he_solid_vertex(soup, -radius, 0, 0);
    he_solid_vertex(soup, 0, radius, 0);
    he_solid_vertex(soup, 0, -radius, 0);
    he_solid_vertex(soup, 0, 0, radius);
    he_solid_vertex(soup, 0, 0, -radius);
    /* The octahedron has one triangle in each octant. Octants that a reflection at a coordinate
     * plane maps to each other have triangles of opposite vertex order. */
    for (uint32_t i = 0; i < 8; i++) {
        uint32_t x = i & 1u, y = i >> 1 & 1u, z = i >> 2;
        if ((x ^ y ^ z) == 0) {
            triangle(soup, x, 2 + y, 4 + z);
        } else {
            triangle(soup, x, 4 + z, 2 + y);
        }
    }
}

/* The vertices of an icosahedron are the corners of three golden rectangles, one in each coordinate
 * plane. Its edges join the vertices that are nearest to each other. Its faces are the triples of
 * vertices that are joined pairwise, oriented outwards. */
typedef struct icosahedron {
    he_vec3 vertex[12];
    uint32_t face[20][3];
    uint32_t edge[12][12]; /* edge[a][b] is the number (0 to 29) of the edge from vertex a to b */
} icosahedron;

static icosahedron icosahedron_make(void)
{
    icosahedron ico = {0};
    double golden = (1 + sqrt(5)) / 2, r = sqrt(1 + golden * golden);
    for (unsigned i = 0; i < 12; i++) {
        double s = (i & 1u ? -1 : 1) / r, l = (i & 2u ? -golden : golden) / r;
        ico.vertex[i] = i < 4   ? (he_vec3){0, s, l}
                        : i < 8 ? (he_vec3){l, 0, s}
                                : (he_vec3){s, l, 0};
    }
    bool joined[12][12];
    uint32_t edges = 0, faces = 0;
    for (uint32_t a = 0; a < 12; a++) {
        for (uint32_t b = 0; b < 12; b++) {
            /* The cosine of the angle between two vertices, seen from the centre, is 1, 1/sqrt 5,
             * -1/sqrt 5 or -1. It is 1/sqrt 5 if an edge joins the vertices. */
            double cosine = he_vec3_dot(ico.vertex[a], ico.vertex[b]);
            joined[a][b] = cosine > 0 && cosine < 0.9;
            if (a < b && joined[a][b]) {
                ico.edge[a][b] = ico.edge[b][a] = edges++;
            }
        }
    }
    for (uint32_t a = 0; a < 12; a++) {
        for (uint32_t b = a + 1; b < 12; b++) {
            for (uint32_t c = b + 1; c < 12; c++) {
                if (!joined[a][b] || !joined[b][c] || !joined[a][c]) {
                    continue;
                }
                he_vec3 turn = he_vec3_cross(ico.vertex[b], ico.vertex[c]);
                bool outwards = he_vec3_dot(ico.vertex[a], turn) > 0;
                ico.face[faces][0] = a;
                ico.face[faces][1] = outwards ? b : c;
                ico.face[faces][2] = outwards ? c : b;
                faces++;
            }
        }
    }
    assert(edges == 30 && faces == 20);
    return ico;
}

void he_solid_icosahedron(he_soup *soup, double radius)
{
    he_solid_icosphere(soup, 0, radius);
}

/* Returns the face of the icosahedron in which vertex `b` follows vertex `at`, and sets *after to
 * the vertex that follows `b`. */
static uint32_t face_from(const icosahedron *ico, uint32_t at, uint32_t b, uint32_t *after)
{
    for (uint32_t f = 0; f < 20; f++) {
        for (unsigned i = 0; i < 3; i++) {
            if (ico->face[f][i] == at && ico->face[f][(i + 1) % 3] == b) {
                *after = ico->face[f][(i + 2) % 3];
                return f;
            }
        }
    }
    assert(!"every edge of the icosahedron has a face on its left");
    return 0;
}

/* The dodecahedron is the dual of the icosahedron: it has a vertex for each face of the icosahedron
 * and a face for each vertex. */
void he_solid_dodecahedron(he_soup *soup, double radius)
{
    icosahedron ico = icosahedron_make();
    for (unsigned f = 0; f < 20; f++) {
        const uint32_t *v = ico.face[f];
        he_vec3 p = he_vec3_add(ico.vertex[v[0]], ico.vertex[v[1]]);
        p = he_vec3_add(p, ico.vertex[v[2]]);
        p = he_vec3_scale(p, radius / he_vec3_length(p));
        he_solid_vertex(soup, p.x, p.y, p.z);
    }
    for (uint32_t v = 0; v < 12; v++) {
        uint32_t corners[5], spoke = 0;
        while (he_vec3_dot(ico.vertex[v], ico.vertex[spoke]) < 0 ||
               he_vec3_dot(ico.vertex[v], ico.vertex[spoke]) > 0.9) {
            spoke++;
        }
        for (unsigned i = 0; i < 5; i++) {
            corners[i] = face_from(&ico, v, spoke, &spoke);
        }
        he_solid_face(soup, corners, 5);
    }
}

/* A triangle of the icosahedron, divided into a grid with `n` steps along each side. The grid point
 * (i, j) is i steps from corner 0 towards corner 1, and j steps towards corner 2. */
typedef struct patch {
    const icosahedron *ico;
    uint32_t n, face;
} patch;

/* Returns the number of the vertex at step t of the n steps along the edge from corner `from` to
 * corner `to`. The two triangles beside the edge share its vertices, so steps are counted from the
 * corner with the lower number. */
static uint32_t on_edge(const patch *p, uint32_t from, uint32_t to, uint32_t t)
{
    uint32_t step = from < to ? t : p->n - t;
    return 12 + p->ico->edge[from][to] * (p->n - 1) + step - 1;
}

/* Returns the number of the vertex at grid point (i, j). Numbers are given first to the 12 corners
 * of the icosahedron, then to the points inside its 30 edges, then to the points inside its 20
 * faces. */
static uint32_t grid_vertex(const patch *p, uint32_t i, uint32_t j)
{
    const uint32_t *corner = p->ico->face[p->face];
    uint32_t n = p->n;
    if (i + j == 0 || i == n || j == n) {
        return i == n ? corner[1] : j == n ? corner[2] : corner[0];
    }
    if (j == 0) {
        return on_edge(p, corner[0], corner[1], i);
    }
    if (i == 0) {
        return on_edge(p, corner[0], corner[2], j);
    }
    if (i + j == n) {
        return on_edge(p, corner[1], corner[2], j);
    }
    /* inner: number of points inside a face; below: number of them in rows 1 to j - 1, where row j
     * of the grid has n - 1 - j of them. */
    uint32_t inner = (uint32_t)((uint64_t)(n - 1) * (n - 2) / 2);
    uint32_t below = (uint32_t)((uint64_t)(j - 1) * (n - 1) - (uint64_t)(j - 1) * j / 2);
    return 12 + 30 * (n - 1) + p->face * inner + below + i - 1;
}

static void halve(he_vec3 *at, uint32_t a, uint32_t b, uint32_t middle)
{
    he_vec3 sum = he_vec3_add(at[a], at[b]);
    at[middle] = he_vec3_scale(sum, 1 / he_vec3_length(sum));
}

/* Computes the midpoints of all edges of one level of subdivision of a triangle of the icosahedron.
 * The loop visits only the smaller triangles that are oriented like the large one; each edge is a
 * side of exactly one such triangle and is thus halved once. */
static void place_level(const patch *p, uint32_t step, he_vec3 *at)
{
    uint32_t half = step / 2;
    for (uint32_t j = 0; j < p->n; j += step) {
        for (uint32_t i = 0; i + j < p->n; i += step) {
            uint32_t a = grid_vertex(p, i, j), b = grid_vertex(p, i + step, j);
            uint32_t c = grid_vertex(p, i, j + step);
            halve(at, a, b, grid_vertex(p, i + half, j));
            halve(at, b, c, grid_vertex(p, i + half, j + half));
            halve(at, c, a, grid_vertex(p, i, j + half));
        }
    }
}

void he_solid_icosphere(he_soup *soup, unsigned subdivisions, double radius)
{
    icosahedron ico = icosahedron_make();
    patch p = {.ico = &ico, .n = 1u << subdivisions};
    uint32_t vertices = 10u * p.n * p.n + 2;
    assert(vertices <= soup->vertex_capacity);
    memcpy(soup->positions, ico.vertex, sizeof ico.vertex);
    soup->vertex_count = vertices;
    for (uint32_t step = p.n; step > 1; step /= 2) {
        for (p.face = 0; p.face < 20 && he_solid_goes_on(soup); p.face++) {
            place_level(&p, step, soup->positions);
        }
    }
    if (!he_solid_goes_on(soup)) {
        return;
    }
    for (uint32_t v = 0; v < vertices; v++) {
        soup->positions[v] = he_vec3_scale(soup->positions[v], radius);
    }
    for (p.face = 0; p.face < 20; p.face++) {
        for (uint32_t j = 0; j < p.n && he_solid_goes_on(soup); j++) {
            for (uint32_t i = 0; i + j < p.n; i++) {
                uint32_t b = grid_vertex(&p, i + 1, j), c = grid_vertex(&p, i, j + 1);
                triangle(soup, grid_vertex(&p, i, j), b, c);
                if (i + j + 1 < p.n) {
                    triangle(soup, b, grid_vertex(&p, i + 1, j + 1), c);
                }
            }
        }
    }
}
