#include "model/rows.h"

#include "algo/decimate.h"
#include "mesh/delta.h"
#include "mesh/walk.h"
#include "model/marks.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static bool has_polygon(const or_mesh *o)
{
    bool found = false;
    for (uint32_t f = 0; f < o->faces; f++) {
        found |= o->face[f].alive && o->face[f].count != 3;
    }
    return found;
}

static bool draw_decimate(md_draft *d)
{
    if (has_polygon(d->o) && md_chance(d->r, 80)) {
        return false;
    }
    if (md_chance(d->r, 50)) {
        md_give_number(d, "ratio", md_from(d->r, 5, 10) / 10.0);
    } else {
        uint32_t faces = md_from(d->r, he_mesh_faces(d->m) / 2, he_mesh_faces(d->m) + 1);
        md_give_number(d, "faces", faces);
    }
    if (md_chance(d->r, 50)) {
        md_give_number(d, "max_error", md_chance(d->r, 20) ? 0 : md_from(d->r, 1, 50) / 100.0);
    }
    if (md_chance(d->r, 20)) {
        md_give_number(d, "boundary_weight", md_from(d->r, 0, 20));
    }
    return true;
}

/* Runs a decimation on the oracle. hedge may choose which edges to collapse; a copy of its mesh
 * shows the choice. Each collapse must be one that edge_collapse allows, and the ids and faces must
 * be as these collapses give. */
static uint64_t play_decimate(const md_call *c, or_mesh *o, const he_mesh *m)
{
    const he_arg *faces = md_get(c, "faces"), *most = md_get(c, "max_error");
    uint64_t refused = has_polygon(o) ? OR_BIT(HE_NOT_TRIANGLE) : 0;
    if (refused != 0) {
        return refused;
    }
    he_decimate_options options = {.max_error = most->given ? most->number : INFINITY};
    options.boundary_weight = md_get(c, "boundary_weight")->number;
    options.faces = (uint32_t)(faces->given ? faces->number
                                            : floor(md_get(c, "ratio")->number * he_mesh_faces(m)));
    he_mesh *copy = NULL;
    he_delta *delta = he_delta_new();
    if (delta == NULL || he_mesh_copy(m, &copy, NULL) != HE_OK) {
        abort();
    }
    he_mesh_record(copy, delta);
    if (he_decimate(copy, &options, NULL, NULL) != HE_OK) {
        abort();
    }
    for (size_t i = 0; i < delta->count && refused == 0; i++) {
        const he_record *r = &delta->records[i];
        if (r->column == HE_COL_MERGED && r->word == HE_VERTEX) {
            refused = or_edge_collapse(o, &(or_collapse){r->row, r->before, 1, NULL});
            (void)or_derive(o);
        }
    }
    for (uint32_t v = 0; v < o->vertices; v++) {
        if (o->vertex[v].alive) {
            o->vertex[v].at = he_position(copy, (he_vertex){v});
        }
    }
    he_delta_free(delta);
    he_mesh_free(copy);
    return refused;
}

const md_row md_decimate_rows[] = {
    {"decimate", -1, draw_decimate, play_decimate, NULL, true},
    {.name = NULL},
};
