#include "model/shapes.h"

#include "mesh/build.h"

#include <assert.h>

static uint32_t somewhere(or_mesh *o, md_random *r)
{
    return or_add_vertex(o, (he_vec3){md_unit(r) * 4 - 2, md_unit(r) * 4 - 2, md_unit(r) * 4 - 2});
}

static uint32_t add_vertices(or_mesh *o, md_random *r, uint32_t n)
{
    uint32_t first = o->vertices;
    for (uint32_t i = 0; i < n; i++) {
        (void)somewhere(o, r);
    }
    return first;
}

/* A face of the vertices from `first` on, in order or backwards. */
static void add_row(or_mesh *o, uint32_t first, uint32_t n, bool backwards)
{
    uint32_t v[OR_CORNERS];
    for (uint32_t i = 0; i < n; i++) {
        v[i] = first + (backwards ? n - 1 - i : i);
    }
    (void)or_add_face(o, v, n);
}

static void add_quad(or_mesh *o, md_random *r, uint32_t triangles, const uint32_t q[4])
{
    if (!md_chance(r, triangles)) {
        (void)or_add_face(o, q, 4);
    } else {
        (void)or_add_face(o, (uint32_t[]){q[0], q[1], q[2]}, 3);
        (void)or_add_face(o, (uint32_t[]){q[0], q[2], q[3]}, 3);
    }
}

static void polygon(or_mesh *o, md_random *r)
{
    uint32_t n = md_from(r, 3, 12);
    uint32_t first = add_vertices(o, r, n);
    add_row(o, first, n, false);
    if (md_chance(r, 30)) {
        add_row(o, first, n, true);
    }
}

/* Two rings of n, with or without their caps. */
static void prism(or_mesh *o, md_random *r)
{
    uint32_t n = md_from(r, 3, 12);
    uint32_t first = add_vertices(o, r, 2 * n);
    uint32_t triangles = md_below(r, 3) * 50;
    for (uint32_t i = 0; i < n; i++) {
        uint32_t k = (i + 1) % n;
        add_quad(o, r, triangles, (uint32_t[]){first + i, first + k, first + n + k, first + n + i});
    }
    if (md_chance(r, 70)) {
        add_row(o, first, n, true);
    }
    if (md_chance(r, 70)) {
        add_row(o, first + n, n, false);
    }
}

/* A fan about a vertex, closed below by another fan, by a polygon, or not; of three sides this is
 * the tetrahedron. */
static void pyramid(or_mesh *o, md_random *r)
{
    uint32_t n = md_from(r, 3, 8);
    uint32_t first = add_vertices(o, r, n);
    uint32_t top = somewhere(o, r);
    uint32_t below = md_below(r, 3);
    uint32_t bottom = below == 0 ? somewhere(o, r) : 0;
    for (uint32_t i = 0; i < n; i++) {
        uint32_t k = (i + 1) % n;
        (void)or_add_face(o, (uint32_t[]){first + i, first + k, top}, 3);
        if (below == 0) {
            (void)or_add_face(o, (uint32_t[]){first + k, first + i, bottom}, 3);
        }
    }
    if (below == 1) {
        add_row(o, first, n, true);
    }
}

/* Cells of a grid, either direction of which may wrap: sheet, tube or torus. The white squares of a
 * checkerboard may be missing. */
static void grid(or_mesh *o, md_random *r)
{
    bool wrap_x = md_chance(r, 40);
    bool wrap_y = wrap_x && md_chance(r, 60);
    bool board = !wrap_x && md_chance(r, 25);
    uint32_t triangles = md_below(r, 3) * 50;
    uint32_t columns = md_from(r, wrap_x ? 3 : 1, 5);
    uint32_t rows = md_from(r, wrap_y ? 3 : 1, 5);
    uint32_t across = wrap_x ? columns : columns + 1;
    uint32_t along = wrap_y ? rows : rows + 1;
    uint32_t first = add_vertices(o, r, across * along);
    for (uint32_t y = 0; y < rows; y++) {
        for (uint32_t x = 0; x < columns; x++) {
            if (board && (x + y) % 2 == 1) {
                continue;
            }
            uint32_t right = (x + 1) % across;
            uint32_t up = (y + 1) % along;
            add_quad(o, r, triangles,
                     (uint32_t[]){first + y * across + x, first + y * across + right,
                                  first + up * across + right, first + up * across + x});
        }
    }
}

/* Polygons that share nothing but one vertex. */
static void bowtie(or_mesh *o, md_random *r)
{
    uint32_t fans = md_from(r, 2, 4);
    uint32_t centre = somewhere(o, r);
    for (uint32_t i = 0; i < fans; i++) {
        uint32_t n = md_from(r, 2, 4);
        uint32_t first = add_vertices(o, r, n);
        uint32_t v[8] = {centre};
        for (uint32_t k = 0; k < n; k++) {
            v[1 + k] = first + k;
        }
        (void)or_add_face(o, v, n + 1);
    }
}

static void swap_faces(or_mesh *o, uint32_t f, uint32_t g)
{
    or_face swap = o->face[f];
    o->face[f] = o->face[g];
    o->face[g] = swap;
}

void md_shape(or_mesh *o, md_random *r)
{
    static void (*const shape[])(or_mesh *, md_random *) = {polygon, prism, pyramid,
                                                            grid,    grid,  bowtie};
    or_empty(o);
    uint32_t parts = md_chance(r, 3) ? 0 : md_chance(r, 70) ? 1 : md_from(r, 2, 3);
    for (uint32_t i = 0; i < parts; i++) {
        shape[md_below(r, sizeof shape / sizeof shape[0])](o, r);
    }
    if (md_chance(r, 25)) {
        (void)add_vertices(o, r, md_from(r, 1, 2));
    }
    uint32_t holes = md_chance(r, 40) ? md_below(r, 4) : 0;
    for (uint32_t i = 0; i < holes && o->fresh > 0; i++) {
        swap_faces(o, md_below(r, o->fresh), o->fresh - 1);
        or_remove_last_face(o);
    }
    for (uint32_t i = 1; i < o->fresh; i++) {
        swap_faces(o, i, md_below(r, i + 1));
    }
    o->faces = o->fresh;
    o->fresh = 0;
    uint64_t wrong = or_derive(o);
    assert(wrong == 0);
    (void)wrong;
    for (uint32_t f = 0; f < o->faces; f++) {
        for (uint32_t i = 0; i < o->face[f].count; i++) {
            uint32_t a = o->face[f].v[i];
            uint32_t b = o->face[f].v[(i + 1) % o->face[f].count];
            if (o->joined[a][b] == OR_NONE) {
                o->edge[o->edges] = (or_edge){.alive = true, .a = a, .b = b};
                or_set_joined(o, o->edges++);
            }
        }
    }
}

he_mesh *md_build(const or_mesh *o)
{
    he_soup soup;
    he_mesh *m = NULL;
    he_soup_init(&soup, NULL);
    he_status status = HE_OK;
    for (uint32_t v = 0; v < o->vertices && status == HE_OK; v++) {
        status = he_soup_add_vertex(&soup, o->vertex[v].at, NULL);
    }
    for (uint32_t f = 0; f < o->faces && status == HE_OK; f++) {
        status = he_soup_add_face(&soup, o->face[f].v, o->face[f].count, NULL);
    }
    if (status == HE_OK) {
        status = he_build(&soup, 0, &m, NULL, NULL);
    }
    he_soup_clear(&soup);
    return status == HE_OK ? m : NULL;
}
