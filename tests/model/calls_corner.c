#include "model/rows.h"

#include "mesh/walk.h"

/* Returns an interior vertex if a few random tries find one, else any vertex. */
static uint32_t draw_interior(md_draft *d)
{
    uint32_t v = md_pick(d, HE_VERTEX);
    for (int tries = 0; tries < 6 && or_require(d->o, HE_VERTEX, v) == 0 &&
                        or_on_boundary(d->o, v) && md_chance(d->r, 90);
         tries++) {
        v = md_live(d, HE_VERTEX);
    }
    return v;
}

/* Returns whether the oracle has room for the face that dissolving the vertex v makes: the face has
 * all corners of the faces around v, except v itself. */
static bool has_room_about(const or_mesh *o, uint32_t v)
{
    uint32_t corners = 0;
    if (or_require(o, HE_VERTEX, v) != 0) {
        return true;
    }
    for (uint32_t x = 0; x < o->vertices; x++) {
        corners += o->left[v][x] != OR_NONE ? o->face[o->left[v][x]].count - 2 : 0;
    }
    return corners + 4 < OR_CORNERS;
}

static uint32_t stored_neighbour(const he_mesh *m, uint32_t v)
{
    he_halfedge h = he_vertex_halfedge(m, (he_vertex){v});
    return h.i == HE_NONE ? OR_NONE : he_target(m, h).i;
}

static bool draw_vertex_dissolve(md_draft *d)
{
    uint32_t v = draw_interior(d);
    md_give_id(d, "vertex", v);
    return has_room_about(d->o, v);
}

static uint64_t play_vertex_dissolve(const md_call *c, or_mesh *o, const he_mesh *m)
{
    uint32_t v = md_get(c, "vertex")->id;
    uint64_t refused = or_require(o, HE_VERTEX, v);
    return refused != 0 ? refused : or_vertex_dissolve(o, v, stored_neighbour(m, v));
}

static bool draw_vertex_split_corners(md_draft *d)
{
    uint32_t a = md_pick(d, HE_HALFEDGE);
    uint32_t b = md_pick(d, HE_HALFEDGE);
    if (or_require(d->o, HE_HALFEDGE, a) == 0 && md_chance(d->r, 90)) {
        if (!has_room_about(d->o, he_origin(d->m, (he_halfedge){a}).i)) {
            return false;
        }
        he_halfedge h = {a};
        for (uint32_t turns = md_below(d->r, 6); turns > 0; turns--) {
            h = he_swing_ccw(d->m, h);
        }
        b = h.i;
    }
    md_give_id(d, "a", a);
    md_give_id(d, "b", b);
    return true;
}

static uint64_t play_vertex_split_corners(const md_call *c, or_mesh *o, const he_mesh *m)
{
    he_halfedge a = {md_get(c, "a")->id};
    he_halfedge b = {md_get(c, "b")->id};
    uint64_t refused = or_require(o, HE_HALFEDGE, a.i) | or_require(o, HE_HALFEDGE, b.i);
    uint32_t moved[OR_VERTICES];
    uint32_t count = 0;
    if (refused != 0) {
        return refused;
    }
    if (a.i == b.i) {
        return OR_BIT(HE_SAME_CORNER);
    }
    if (he_origin(m, a).i != he_origin(m, b).i) {
        return OR_BIT(HE_DIFFERENT_ORIGINS);
    }
    /* The new vertex takes the edges to the vertices `moved`. At a bow-tie (a vertex with several
     * fans of faces) the order of the fans is hedge's choice, so it is read from hedge's mesh. */
    for (he_halfedge h = a; h.i != b.i; h = he_swing_ccw(m, h)) {
        moved[count++] = he_target(m, h).i;
    }
    return or_vertex_split_corners(o, he_origin(m, a).i, moved, count);
}

static bool draw_vertex_bevel(md_draft *d)
{
    uint32_t v = draw_interior(d);
    md_give_id(d, "vertex", v);
    md_give_number(d, "width", md_chance(d->r, 4) ? -md_unit(d->r) : md_unit(d->r) * 3 + 1e-3);
    return has_room_about(d->o, v);
}

static uint64_t play_vertex_bevel(const md_call *c, or_mesh *o, const he_mesh *m)
{
    uint32_t v = md_get(c, "vertex")->id;
    double width = md_get(c, "width")->number;
    uint64_t refused = or_require(o, HE_VERTEX, v);
    if (refused != 0 || width <= 0) {
        return refused | (width <= 0 ? OR_BIT(HE_BAD_VALUE) : 0);
    }
    return or_vertex_bevel(o, v, stored_neighbour(m, v), width);
}

const md_row md_corner_rows[] = {
    {"vertex_dissolve", -1, draw_vertex_dissolve, play_vertex_dissolve, NULL, false},
    {"vertex_split_corners", 1, draw_vertex_split_corners, play_vertex_split_corners, NULL, false},
    {"vertex_bevel", 1, draw_vertex_bevel, play_vertex_bevel, NULL, false},
    {.name = NULL},
};
