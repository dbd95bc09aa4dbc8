#include "model/adopt.h"
#include "model/rows.h"

#include "mesh/walk.h"
#include "smooth/smooth.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static bool draw_smooth(md_draft *d)
{
    for (uint32_t v = 0; v < d->o->vertices; v++) {
        const he_vec3 p = d->o->vertex[v].at;
        if (d->o->vertex[v].alive && !(fabs(p.x) + fabs(p.y) + fabs(p.z) < 1e100)) {
            return false; /* a position could become infinite */
        }
    }
    static const char *const methods[] = {"laplacian", "taubin", "bilateral", "tangential"};
    const uint32_t method = md_below(d->r, HE_SMOOTH_METHODS);
    md_give_choice(d, "method", methods[method]);
    md_give_number(d, "steps", md_from(d->r, 1, 3));
    if (method == HE_SMOOTH_LAPLACIAN && md_chance(d->r, 50)) {
        md_give_number(d, "time", md_chance(d->r, 10) ? -(double)md_below(d->r, 2) : 0.01);
    }
    if (md_chance(d->r, 20)) {
        md_give_flag(d, "keep_volume", true);
    }
    if (md_chance(d->r, 40)) {
        (void)md_pick_some(d, "vertex", "vertices", HE_VERTEX, MD_LIST);
    }
    return md_is_tame(d);
}

static he_status run(const md_call *c, he_mesh *m)
{
    const he_arg *vertices = md_get(c, "vertices"), *time = md_get(c, "time");
    const he_smooth_options options = {.method = (he_smooth_method)md_get(c, "method")->choice,
                                       .steps = (unsigned)md_get(c, "steps")->number,
                                       .time = time->given ? time->number : 0,
                                       .keep_volume = md_get(c, "keep_volume")->flag,
                                       .vertices = vertices->given ? vertices->ids : NULL,
                                       .vertex_count = vertices->count};
    return he_smooth(m, &options, NULL, NULL);
}

/* Returns true if an edge of the oracle has fewer than two faces. */
static bool is_boundary(const or_mesh *o, uint32_t e)
{
    unsigned faces = 0;
    for (uint32_t f = 0; f < o->faces; f++) {
        for (uint32_t i = 0; o->face[f].alive && i < o->face[f].count; i++) {
            const uint32_t a = o->face[f].v[i], b = o->face[f].v[(i + 1) % o->face[f].count];
            faces += (a == o->edge[e].a && b == o->edge[e].b) ||
                     (a == o->edge[e].b && b == o->edge[e].a);
        }
    }
    return faces < 2;
}

/* Returns true if the vertex may move: it has faces, no boundary or feature edge, and nothing
 * around it is locked. */
static bool may_move(const or_mesh *o, uint32_t v)
{
    bool has_face = false, stays = !o->vertex[v].alive || o->vertex[v].locked;
    for (uint32_t e = 0; e < o->edges && !stays; e++) {
        if (o->edge[e].alive && (o->edge[e].a == v || o->edge[e].b == v)) {
            stays = o->edge[e].locked || o->edge[e].feature || is_boundary(o, e);
        }
    }
    for (uint32_t f = 0; f < o->faces && !stays; f++) {
        for (uint32_t i = 0; o->face[f].alive && i < o->face[f].count; i++) {
            if (o->face[f].v[i] == v) {
                has_face = true;
                stays |= o->face[f].locked;
            }
        }
    }
    return has_face && !stays;
}

static bool has_other_face(const or_mesh *o, uint32_t v)
{
    for (uint32_t f = 0; f < o->faces; f++) {
        for (uint32_t i = 0; o->face[f].alive && i < o->face[f].count; i++) {
            if (o->face[f].v[i] == v && o->face[f].count != 3) {
                return true;
            }
        }
    }
    return false;
}

/* Runs a smoothing on the oracle. Hedge chooses the positions, which a copy of its mesh shows; the
 * oracle takes them over after checking what must stay. */
static uint64_t play_smooth(const md_call *c, or_mesh *o, const he_mesh *m)
{
    const he_arg *vertices = md_get(c, "vertices"), *time = md_get(c, "time");
    const bool only_triangles = md_get(c, "method")->choice != HE_SMOOTH_TAUBIN;
    uint64_t refused = vertices->given ? md_require_all(o, HE_VERTEX, vertices) : 0;
    if (time->given && !(time->number > 0)) {
        return refused | OR_BIT(HE_BAD_VALUE);
    }
    if (refused != 0) {
        return refused;
    }
    for (uint32_t v = 0; v < o->vertices && only_triangles; v++) {
        if (md_covers(vertices, v) && may_move(o, v) && has_other_face(o, v)) {
            refused |= OR_BIT(HE_NOT_TRIANGLE);
        }
    }
    for (uint32_t e = 0; e < o->edges && md_get(c, "keep_volume")->flag; e++) {
        if (o->edge[e].alive && is_boundary(o, e)) {
            refused |= OR_BIT(HE_BOUNDARY_EDGE);
        }
    }
    if (refused != 0) {
        return refused;
    }
    he_mesh *made = NULL;
    if (he_mesh_copy(m, &made, NULL) != HE_OK || run(c, made) != HE_OK) {
        abort();
    }
    for (uint32_t v = 0; v < o->vertices; v++) {
        const he_vec3 at = he_position(made, (he_vertex){v});
        if (!o->vertex[v].alive) {
            continue;
        }
        if (!(md_covers(vertices, v) && may_move(o, v)) && !or_same_point(o->vertex[v].at, at)) {
            fprintf(stderr, "smooth moved vertex %u\n", v);
            abort();
        }
        o->vertex[v].at = at;
    }
    he_mesh_free(made);
    return 0;
}

const md_row md_smooth_rows[] = {
    {"smooth", 0, draw_smooth, play_smooth, NULL, true},
    {.name = NULL},
};
