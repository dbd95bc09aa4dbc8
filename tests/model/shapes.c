#include "model/shapes.h"

#include "build/build.h"
#include "model/parts.h"

#include <assert.h>
#include <math.h>

static void swap_faces(or_mesh *o, uint32_t f, uint32_t g)
{
    or_face swap = o->face[f];
    o->face[f] = o->face[g];
    o->face[g] = swap;
}

static void shuffle(or_mesh *o, md_random *r)
{
    for (uint32_t i = 1; i < o->fresh; i++) {
        swap_faces(o, i, md_below(r, i + 1));
    }
}

static void make_holes(or_mesh *o, md_random *r, uint32_t holes)
{
    for (uint32_t i = 0; i < holes && o->fresh > 0; i++) {
        swap_faces(o, md_below(r, o->fresh), o->fresh - 1);
        or_remove_last_face(o);
    }
}

/* --- the families --- */

static void add_any_grid(or_mesh *o, md_random *r)
{
    md_sheet g = {.wrap_x = md_chance(r, 40), .triangles = md_below(r, 3) * 50};
    g.wrap_y = g.wrap_x && md_chance(r, 60);
    g.board = !g.wrap_x && md_chance(r, 25);
    g.columns = md_from(r, g.wrap_x ? 3 : 1, 5);
    g.rows = md_from(r, g.wrap_y ? 3 : 1, 5);
    md_add_grid(o, r, g);
}

static void add_part(or_mesh *o, md_random *r)
{
    switch (md_below(r, 6)) {
    case 0:
        md_add_polygon(o, r, md_chance(r, 30));
        break;
    case 1:
        md_add_prism(o, r, md_below(r, 3) * 50, 70);
        break;
    case 2:
        md_add_pyramid(o, r, md_below(r, 3));
        break;
    case 3:
        md_add_bowtie(o, r);
        break;
    default:
        add_any_grid(o, r);
        break;
    }
}

void md_fill_mixed(or_mesh *o, md_random *r)
{
    uint32_t parts = md_chance(r, 3) ? 0 : md_chance(r, 70) ? 1 : md_from(r, 2, 3);
    for (uint32_t i = 0; i < parts; i++) {
        add_part(o, r);
    }
    if (md_chance(r, 25)) {
        (void)md_add_vertices(o, r, md_from(r, 1, 2));
    }
    make_holes(o, r, md_chance(r, 40) ? md_below(r, 4) : 0);
    shuffle(o, r);
}

void md_fill_closed_triangles(or_mesh *o, md_random *r)
{
    if (md_chance(r, 50)) {
        md_add_pyramid(o, r, 0);
    } else {
        uint32_t columns = md_from(r, 3, 6);
        md_add_grid(o, r, (md_sheet){columns, md_from(r, 3, 6), true, true, false, 100});
    }
    shuffle(o, r);
}

void md_fill_open_triangles(or_mesh *o, md_random *r)
{
    uint32_t columns = md_from(r, 3, 7);
    md_add_grid(o, r, (md_sheet){columns, md_from(r, 1, 7), md_chance(r, 40), false, false, 100});
    make_holes(o, r, md_below(r, 4));
    shuffle(o, r);
}

void md_fill_quads(or_mesh *o, md_random *r)
{
    bool tube = md_chance(r, 50);
    uint32_t columns = md_from(r, 3, 7);
    md_add_grid(o, r,
                (md_sheet){columns, md_from(r, 3, 6), tube, tube && md_chance(r, 50), false, 0});
    make_holes(o, r, md_below(r, 3));
    shuffle(o, r);
}

/* A prism whose caps have 3 to 12 sides, and two polygons, each as one face or as two faces back to
 * back. */
void md_fill_polygons(or_mesh *o, md_random *r)
{
    md_add_prism(o, r, 0, 100);
    md_add_polygon(o, r, md_chance(r, 50));
    md_add_polygon(o, r, md_chance(r, 50));
    shuffle(o, r);
}

/* Removes a vertex from a mesh of quads; the last vertex takes its id. */
static void drop_vertex(or_mesh *o, uint32_t v)
{
    uint32_t last = --o->vertices;
    o->vertex[v] = o->vertex[last];
    for (uint32_t f = 0; f < o->fresh; f++) {
        for (uint32_t k = 0; k < 4; k++) {
            o->face[f].v[k] = o->face[f].v[k] == last ? v : o->face[f].v[k];
        }
    }
}

/* Makes a closed mesh of genus 2: two tori of quads, each with a missing face, are joined along the
 * rims of the missing faces. */
void md_fill_genus_2(or_mesh *o, md_random *r)
{
    uint32_t torus[2];
    uint32_t rim[2][4];
    uint32_t triangles = md_below(r, 3) * 50;
    for (int i = 0; i < 2; i++) {
        torus[i] = o->fresh;
        uint32_t columns = md_from(r, 4, 5);
        md_add_grid(o, r, (md_sheet){columns, md_from(r, 4, 5), true, true, false, 0});
        for (uint32_t k = 0; k < 4; k++) {
            rim[i][k] = o->face[torus[i]].v[k];
        }
    }
    /* The vertices of the second rim are replaced by those of the first, in the opposite
     * direction. */
    for (uint32_t f = torus[1]; f < o->fresh; f++) {
        for (uint32_t k = 0; k < 4; k++) {
            for (uint32_t j = 0; j < 4; j++) {
                if (o->face[f].v[k] == rim[1][j]) {
                    o->face[f].v[k] = rim[0][(4 - j) % 4];
                    break;
                }
            }
        }
    }
    /* The vertices of the second rim are removed from the highest id on, so that the last vertex,
     * which takes the free id, is never one of the rim. */
    static const int order[4] = {2, 3, 1, 0};
    for (int k = 0; k < 4; k++) {
        drop_vertex(o, rim[1][order[k]]);
    }
    swap_faces(o, torus[1], o->fresh - 1);
    or_remove_last_face(o);
    swap_faces(o, torus[0], o->fresh - 1);
    or_remove_last_face(o);
    uint32_t quads = o->fresh;
    for (uint32_t f = 0; f < quads; f++) {
        if (md_chance(r, triangles)) {
            const uint32_t half[3] = {o->face[f].v[0], o->face[f].v[2], o->face[f].v[3]};
            (void)or_add_face(o, half, 3);
            o->face[f].count = 3;
        }
    }
    shuffle(o, r);
}

void md_fill_components(or_mesh *o, md_random *r)
{
    uint32_t parts = md_from(r, 3, 5);
    for (uint32_t i = 0; i < parts; i++) {
        switch (md_below(r, 3)) {
        case 0:
            md_add_polygon(o, r, md_chance(r, 50));
            break;
        case 1:
            md_add_prism(o, r, md_below(r, 3) * 50, 80);
            break;
        default:
            md_add_pyramid(o, r, md_below(r, 3));
            break;
        }
    }
    (void)md_add_vertices(o, r, md_from(r, 0, 2));
    shuffle(o, r);
}

void md_fill_bowties(or_mesh *o, md_random *r)
{
    if (md_chance(r, 50)) {
        md_add_bowtie(o, r);
        md_add_bowtie(o, r);
    } else {
        md_add_grid(o, r, (md_sheet){md_from(r, 2, 5), md_from(r, 2, 5), false, false, true, 50});
    }
    shuffle(o, r);
}

/* A fan of triangles around one vertex. It goes not quite all the way around, or all the way
 * around; or its outer side is also closed by one large face. */
void md_fill_fan_1000(or_mesh *o, md_random *r)
{
    const uint32_t fan = 1000;
    uint32_t hub = or_add_vertex(o, (he_vec3){0, 0, 0.3});
    uint32_t first = o->vertices;
    uint32_t kind = md_below(r, 3);
    for (uint32_t i = 0; i < (kind == 0 ? fan + 1 : fan); i++) {
        double angle = 6.283185307179586 * i / (fan + 1);
        double radius = 1 + md_unit(r);
        (void)or_add_vertex(o, (he_vec3){radius * cos(angle), radius * sin(angle), md_unit(r)});
    }
    for (uint32_t i = 0; i < fan; i++) {
        uint32_t next = kind == 0 ? i + 1 : (i + 1) % fan;
        (void)or_add_face(o, (uint32_t[]){hub, first + i, first + next}, 3);
    }
    if (kind == 2) {
        md_add_row(o, first, fan, true);
    }
    shuffle(o, r);
}

void md_fill_triangle(or_mesh *o, md_random *r)
{
    md_add_row(o, md_add_vertices(o, r, 3), 3, false);
}

void md_fill_doubled_square(or_mesh *o, md_random *r)
{
    uint32_t first = md_add_vertices(o, r, 4);
    md_add_row(o, first, 4, false);
    md_add_row(o, first, 4, true);
}

void md_fill_tetrahedron(or_mesh *o, md_random *r)
{
    uint32_t v = md_add_vertices(o, r, 4);
    (void)or_add_face(o, (uint32_t[]){v, v + 2, v + 1}, 3);
    (void)or_add_face(o, (uint32_t[]){v, v + 1, v + 3}, 3);
    (void)or_add_face(o, (uint32_t[]){v + 1, v + 2, v + 3}, 3);
    (void)or_add_face(o, (uint32_t[]){v + 2, v, v + 3}, 3);
}

/* Makes a mesh with coordinates so large that the sum of two may overflow. */
void md_fill_far(or_mesh *o, md_random *r)
{
    md_add_grid(o, r, (md_sheet){md_from(r, 1, 3), md_from(r, 1, 3), false, false, false, 50});
    md_add_polygon(o, r, md_chance(r, 50));
    for (uint32_t v = 0; v < o->vertices; v++) {
        o->vertex[v].at.x *= MD_FAR / 2;
        o->vertex[v].at.y *= MD_FAR / 2;
        o->vertex[v].at.z *= MD_FAR / 2;
    }
    shuffle(o, r);
}

/* --- giving ids --- */

void md_shape(or_mesh *o, md_random *r, void (*fill)(or_mesh *, md_random *))
{
    or_empty(o);
    fill(o, r);
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
