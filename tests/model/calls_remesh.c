#include "model/rows.h"
#include "model/adopt.h"

#include "geometry/geometry.h"
#include "mesh/walk.h"
#include "remesh/remesh.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* Returns the sum of the lengths of all edges, and the length of the longest in *longest. */
static double edge_lengths(const he_mesh *m, double *longest)
{
    double sum = 0;
    *longest = 0;
    for (uint32_t e = 0; e < he_mesh_issued(m, HE_EDGE); e++) {
        if (he_mesh_is_live(m, HE_EDGE, e)) {
            double length = he_edge_length(m, (he_edge){e});
            sum += length;
            *longest = fmax(*longest, length);
        }
    }
    return sum;
}

/* Returns true if the operation works on face f of the oracle. */
static bool is_chosen(const or_mesh *o, const he_arg *faces, uint32_t f)
{
    return o->face[f].alive && !o->face[f].locked && md_covers(faces, f);
}

/* Returns about how many regular triangles with sides of this length have the area of the chosen
 * faces. */
static double triangles(const or_mesh *o, const he_mesh *m, const he_arg *faces, double length)
{
    double count = 0;
    for (uint32_t f = 0; f < o->faces; f++) {
        if (is_chosen(o, faces, f)) {
            count += he_face_area(m, (he_face){f}) / length / length * 2.3094;
        }
    }
    return count;
}

/* Draws a length with which the result fits into the oracle's tables: about as many edges as fit
 * into the sum of the lengths. */
static bool draw_remesh(md_draft *d)
{
    enum { ROOM = 600, MOST = 300 };
    double longest, sum = edge_lengths(d->m, &longest);
    if (d->o->vertices + ROOM > OR_VERTICES || d->o->edges + 3 * ROOM > OR_EDGES ||
        d->o->faces + 2 * ROOM > OR_FACES || !isfinite(sum)) {
        return false;
    }
    for (uint32_t f = 0; f < d->o->faces; f++) {
        if (d->o->face[f].alive && d->o->face[f].count != 3 && md_chance(d->r, 95)) {
            return false;
        }
    }
    double length = fmax(sum / MOST, longest * md_from(d->r, 10, 60) / 50.0);
    if (!isfinite(length)) {
        return false; /* JSON has no such number */
    }
    if (md_chance(d->r, 10) && longest > 0 &&
        triangles(d->o, d->m, md_get(d->c, "faces"), longest * 1e-8) > 1e9) {
        md_give_number(d, "edge_length", longest * 1e-8);
        return true;
    }
    if (md_chance(d->r, 75)) {
        md_give_number(d, "edge_length", md_chance(d->r, 5) ? 0 : length > 0 ? length : 1);
    } else if (md_chance(d->r, 40) && length > 0) {
        md_give_number(d, "error", length / 10);
        md_give_number(d, "min_length", length);
        md_give_number(d, "max_length", length * 2);
    } else {
        md_give_number(d, "target_faces", md_from(d->r, 1, 1 + 2 * he_mesh_faces(d->m)));
    }
    md_give_number(d, "steps", md_from(d->r, 1, 4));
    if (md_chance(d->r, 30)) {
        md_give_number(d, "crease", md_from(d->r, 0, 31) / 10.0);
    }
    if (md_chance(d->r, 20)) {
        md_give_flag(d, "keep_boundary", true);
    }
    if (md_chance(d->r, 50)) {
        md_give_flag(d, "keep_seams", false);
    }
    if (md_chance(d->r, 20)) {
        md_give_flag(d, "project", false);
    }
    if (md_chance(d->r, 40)) {
        (void)md_pick_some(d, "face", "faces", HE_FACE, MD_LIST);
    }
    return true;
}

static he_status run(const md_call *c, he_mesh *m)
{
    const he_arg *faces = md_get(c, "faces");
    he_remesh_options options = {.by = md_get(c, "error")->given         ? HE_REMESH_BY_ERROR
                                       : md_get(c, "edge_length")->given ? HE_REMESH_BY_LENGTH
                                                                         : HE_REMESH_BY_FACES,
                                 .error = md_get(c, "error")->number,
                                 .min_length = md_get(c, "min_length")->number,
                                 .max_length = md_get(c, "max_length")->number,
                                 .edge_length = md_get(c, "edge_length")->number,
                                 .target_faces = (uint32_t)md_get(c, "target_faces")->number,
                                 .steps = (unsigned)md_get(c, "steps")->number,
                                 .crease = md_get(c, "crease")->number,
                                 .fixed_boundary = md_get(c, "keep_boundary")->flag,
                                 .keep_seams = md_get(c, "keep_seams")->flag,
                                 .project = md_get(c, "project")->flag,
                                 .faces = faces->given ? faces->ids : NULL,
                                 .face_count = faces->count};
    return he_remesh(m, &options, NULL, NULL);
}

static void require(bool holds, const char *what, uint32_t id)
{
    if (!holds) {
        fprintf(stderr, "remesh changed %s %u\n", what, id);
        abort();
    }
}

/* Requires that what must stay has stayed: locked elements, faces that were not chosen, and the
 * vertices of both. */
static void require_stays(const md_call *c, const or_mesh *o, const he_mesh *m, const he_mesh *made)
{
    const he_arg *faces = md_get(c, "faces");
    for (uint32_t v = 0; v < o->vertices; v++) {
        require(
            !o->vertex[v].alive || !o->vertex[v].locked ||
                (he_mesh_is_live(made, HE_VERTEX, v) &&
                 or_same_point(he_position(m, (he_vertex){v}), he_position(made, (he_vertex){v}))),
            "vertex", v);
    }
    for (uint32_t e = 0; e < o->edges; e++) {
        require(
            !o->edge[e].alive || !o->edge[e].locked ||
                (he_mesh_is_live(made, HE_EDGE, e) &&
                 he_origin(m, (he_halfedge){2 * e}).i == he_origin(made, (he_halfedge){2 * e}).i &&
                 he_target(m, (he_halfedge){2 * e}).i == he_target(made, (he_halfedge){2 * e}).i),
            "edge", e);
    }
    for (uint32_t f = 0; f < o->faces; f++) {
        if (!o->face[f].alive || is_chosen(o, faces, f)) {
            continue;
        }
        require(he_mesh_is_live(made, HE_FACE, f), "face", f);
        for (uint32_t i = 0; i < o->face[f].count; i++) {
            he_vertex v = md_corner(m, f, i);
            require(v.i == md_corner(made, f, i).i &&
                        or_same_point(he_position(m, v), he_position(made, v)),
                    "face", f);
        }
    }
    int before = (int)he_mesh_vertices(m) - (int)he_mesh_edges(m) + (int)he_mesh_faces(m);
    int after = (int)he_mesh_vertices(made) - (int)he_mesh_edges(made) + (int)he_mesh_faces(made);
    require(before == after, "the Euler characteristic, which was", (uint32_t)before);
}

/* Runs a remeshing on the oracle. Hedge chooses the result, which a copy of its mesh shows; the
 * oracle takes it over after checking what must stay. */
static uint64_t play_remesh(const md_call *c, or_mesh *o, const he_mesh *m)
{
    const he_arg *faces = md_get(c, "faces"), *length = md_get(c, "edge_length");
    uint64_t refused = faces->given ? md_require_all(o, HE_FACE, faces) : 0;
    for (uint32_t f = 0; f < o->faces && refused == 0; f++) {
        if (is_chosen(o, faces, f) && o->face[f].count != 3) {
            refused = OR_BIT(HE_NOT_TRIANGLE);
        }
    }
    if (length->given && !(length->number > 0)) {
        return refused | OR_BIT(HE_BAD_VALUE);
    }
    if (refused != 0) {
        return refused;
    }
    if (length->given && triangles(o, m, faces, length->number) > 2 * (double)HE_REMESH_FACES) {
        return OR_BIT(HE_LIMIT);
    }
    he_mesh *made = NULL;
    if (he_mesh_copy(m, &made, NULL) != HE_OK || run(c, made) != HE_OK) {
        abort();
    }
    require_stays(c, o, m, made);
    md_adopt_mesh(o, made);
    he_mesh_free(made);
    return 0;
}

const md_row md_remesh_rows[] = {
    {"remesh", 0, draw_remesh, play_remesh, NULL, true},
    {.name = NULL},
};
