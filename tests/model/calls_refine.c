#include "model/rows.h"

#include "mesh/walk.h"

static const or_scheme schemes[] = {OR_LOOP, OR_CATMULL_CLARK, OR_LINEAR, OR_SQRT3};

static void give_scheme(md_draft *d, or_scheme scheme)
{
    he_arg *arg = &d->c->args[md_index(d->c, "scheme")];
    arg->given = true;
    arg->choice = (int)scheme;
}

/* Returns whether the result of a step of subdivision fits into the oracle's tables, with space
 * left. */
static bool fits(const or_mesh *o, or_scheme scheme, uint32_t faces, uint32_t corners)
{
    enum { ROOM = 200 };
    uint32_t edges = or_live_edges(o);
    uint32_t vertices = scheme == OR_SQRT3 ? faces : edges + (scheme == OR_LOOP ? 0 : faces);
    return o->vertices + vertices + ROOM < OR_VERTICES &&
           o->edges + edges + corners + ROOM < OR_EDGES && o->faces + corners + ROOM < OR_FACES;
}

/* Draws a subdivision, mostly of small meshes, since one face becomes four. A large number of steps
 * tests the limit, which even a mesh of four faces then exceeds by far. */
static bool draw_subdivide(md_draft *d)
{
    enum { FEW = 3, MANY = 40, LEAST_BEYOND = 4, BEYOND = 12 };
    uint32_t faces = or_live_faces(d->o);
    uint32_t corners = 0;
    for (uint32_t f = 0; f < d->o->faces; f++) {
        corners += d->o->face[f].alive ? d->o->face[f].count : 0;
    }
    or_scheme scheme = schemes[md_below(d->r, 4)];
    give_scheme(d, scheme);
    if (md_chance(d->r, 3) && faces >= LEAST_BEYOND && scheme != OR_SQRT3) {
        md_give_number(d, "steps", BEYOND);
        return true;
    }
    return fits(d->o, scheme, faces, corners) && md_chance(d->r, faces <= FEW    ? 60
                                                                 : faces <= MANY ? 30
                                                                                 : 5);
}

static uint64_t play_subdivide(const md_call *c, or_mesh *o, const he_mesh *m)
{
    static uint32_t start[OR_FACES];
    if (md_get(c, "steps")->number != 1) {
        return OR_BIT(HE_LIMIT);
    }
    for (uint32_t f = 0; f < o->faces; f++) {
        if (o->face[f].alive) {
            start[f] = he_origin(m, he_face_halfedge(m, (he_face){f})).i;
        }
    }
    return or_subdivide(o, (or_scheme)md_get(c, "scheme")->choice, start);
}

const md_row md_refine_rows[] = {
    {"subdivide", 1, draw_subdivide, play_subdivide, NULL, false},
    {.name = NULL},
};
