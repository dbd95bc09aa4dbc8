#include "model/parts.h"

static uint32_t somewhere(or_mesh *o, md_random *r)
{
    return or_add_vertex(o, (he_vec3){md_unit(r) * 4 - 2, md_unit(r) * 4 - 2, md_unit(r) * 4 - 2});
}

uint32_t md_add_vertices(or_mesh *o, md_random *r, uint32_t n)
{
    uint32_t first = o->vertices;
    for (uint32_t i = 0; i < n; i++) {
        (void)somewhere(o, r);
    }
    return first;
}

void md_add_row(or_mesh *o, uint32_t first, uint32_t n, bool backwards)
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

void md_add_polygon(or_mesh *o, md_random *r, bool both_sides)
{
    uint32_t n = md_from(r, 3, 12);
    uint32_t first = md_add_vertices(o, r, n);
    md_add_row(o, first, n, false);
    if (both_sides) {
        md_add_row(o, first, n, true);
    }
}

void md_add_prism(or_mesh *o, md_random *r, uint32_t triangles, uint32_t caps)
{
    uint32_t n = md_from(r, 3, 12);
    uint32_t first = md_add_vertices(o, r, 2 * n);
    for (uint32_t i = 0; i < n; i++) {
        uint32_t k = (i + 1) % n;
        add_quad(o, r, triangles, (uint32_t[]){first + i, first + k, first + n + k, first + n + i});
    }
    if (md_chance(r, caps)) {
        md_add_row(o, first, n, true);
    }
    if (md_chance(r, caps)) {
        md_add_row(o, first + n, n, false);
    }
}

void md_add_pyramid(or_mesh *o, md_random *r, uint32_t below)
{
    uint32_t n = md_from(r, 3, 8);
    uint32_t first = md_add_vertices(o, r, n);
    uint32_t top = somewhere(o, r);
    uint32_t bottom = below == 0 ? somewhere(o, r) : 0;
    for (uint32_t i = 0; i < n; i++) {
        uint32_t k = (i + 1) % n;
        (void)or_add_face(o, (uint32_t[]){first + i, first + k, top}, 3);
        if (below == 0) {
            (void)or_add_face(o, (uint32_t[]){first + k, first + i, bottom}, 3);
        }
    }
    if (below == 1) {
        md_add_row(o, first, n, true);
    }
}

void md_add_grid(or_mesh *o, md_random *r, md_sheet g)
{
    uint32_t across = g.wrap_x ? g.columns : g.columns + 1;
    uint32_t along = g.wrap_y ? g.rows : g.rows + 1;
    uint32_t first = md_add_vertices(o, r, across * along);
    for (uint32_t y = 0; y < g.rows; y++) {
        for (uint32_t x = 0; x < g.columns; x++) {
            if (g.board && (x + y) % 2 == 1) {
                continue;
            }
            uint32_t right = (x + 1) % across;
            uint32_t up = (y + 1) % along;
            add_quad(o, r, g.triangles,
                     (uint32_t[]){first + y * across + x, first + y * across + right,
                                  first + up * across + right, first + up * across + x});
        }
    }
}

void md_add_bowtie(or_mesh *o, md_random *r)
{
    uint32_t fans = md_from(r, 2, 4);
    uint32_t centre = somewhere(o, r);
    for (uint32_t i = 0; i < fans; i++) {
        uint32_t n = md_from(r, 2, 4);
        uint32_t first = md_add_vertices(o, r, n);
        uint32_t v[8] = {centre};
        for (uint32_t k = 0; k < n; k++) {
            v[1 + k] = first + k;
        }
        (void)or_add_face(o, v, n + 1);
    }
}
