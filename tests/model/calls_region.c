#include "model/rows.h"

#include "edit/local/erase.h"
#include "edit/local/face_collapse.h"
#include "mesh/column.h"
#include "mesh/walk.h"
#include "mesh/write.h"
#include "model/marks.h"
#include "model/shapes.h"

static void find_starts(const he_mesh *m, uint32_t start[OR_FACES])
{
    for (uint32_t f = 0; f < he_mesh_issued(m, HE_FACE); f++) {
        start[f] = OR_NONE;
        if (he_face_is_live(m, (he_face){f})) {
            start[f] = he_origin(m, he_face_halfedge(m, (he_face){f})).i;
        }
    }
}

/* Returns whether the oracle has room for the faces that extruding these faces makes. */
static bool have_room(const or_mesh *o, const he_arg *faces)
{
    uint32_t corners = 0;
    for (size_t i = 0; i < faces->count; i++) {
        corners += or_require(o, HE_FACE, faces->ids[i]) == 0 ? o->face[faces->ids[i]].count : 0;
    }
    return o->vertices + corners < OR_VERTICES && o->edges + 2 * corners < OR_EDGES &&
           o->faces + corners < OR_FACES && corners < 4 * OR_LIST;
}

/* Picks a few connected faces in most cases, sometimes a whole small component. */
static void pick_patch(md_draft *d)
{
    uint32_t ids[MD_LIST];
    uint32_t most = md_chance(d->r, 30) ? MD_LIST : md_from(d->r, 2, 5);
    uint32_t n = 0;
    uint32_t f = md_live(d, HE_FACE);
    if (or_require(d->o, HE_FACE, f) != 0) {
        (void)md_pick_some(d, "face", "faces", HE_FACE, 3);
        return;
    }
    ids[n++] = f;
    for (uint32_t k = 0; k < n; k++) {
        const or_face *face = &d->o->face[ids[k]];
        for (uint32_t i = 0; i < face->count && n < most; i++) {
            uint32_t g = d->o->left[face->v[(i + 1) % face->count]][face->v[i]];
            bool there = g == OR_NONE || md_chance(d->r, 10);
            for (uint32_t j = 0; j < n; j++) {
                there = there || ids[j] == g;
            }
            if (!there) {
                ids[n++] = g;
            }
        }
    }
    md_give_ids(d, "faces", ids, n, true);
}

/* Picks a face whose corners are at only two positions, so that it has no normal. */
static bool pick_flat(md_draft *d)
{
    uint32_t start = md_below(d->r, d->o->faces + 1);
    for (uint32_t i = 0; i < d->o->faces; i++) {
        uint32_t f = (start + i) % d->o->faces;
        if (d->o->face[f].alive && or_is_flat(d->o, f)) {
            md_give_ids(d, "faces", &f, 1, true);
            return true;
        }
    }
    return false;
}

static void draw_faces(md_draft *d)
{
    if (md_chance(d->r, 15) && pick_flat(d)) {
        return;
    }
    if (md_chance(d->r, 60)) {
        pick_patch(d);
        md_give_flag(d, "region", md_chance(d->r, 80));
    } else {
        (void)md_pick_some(d, "face", "faces", HE_FACE, 3);
        if (md_chance(d->r, 40)) {
            md_give_flag(d, "region", md_chance(d->r, 60));
        }
    }
}

static or_region region_of(const md_call *c, const uint32_t *start)
{
    const he_arg *f = md_get(c, "face");
    return (or_region){f->ids, start, (uint32_t)f->count, md_get(c, "region")->flag};
}

/* Returns whether the faces have a direction that rounding cannot change, which an extrusion by a
 * distance needs. */
static bool is_clear(md_draft *d, bool inset)
{
    uint32_t start[OR_FACES];
    find_starts(d->m, start);
    return md_require_all(d->o, HE_FACE, md_get(d->c, "face")) != 0 ||
           !or_faces_vaguely(d->o, region_of(d->c, start), inset);
}

static bool draw_face_extrude(md_draft *d)
{
    draw_faces(d);
    if (!have_room(d->o, md_get(d->c, "face"))) {
        return false;
    }
    if (d->far || md_chance(d->r, 50)) {
        md_give_points(d, "by", 1, false);
        return true;
    }
    md_give_number(d, "distance", md_unit(d->r) * 2 - 1);
    return is_clear(d, false);
}

static uint64_t play_face_extrude(const md_call *c, or_mesh *o, const he_mesh *m)
{
    uint32_t start[OR_FACES];
    const he_arg *by = md_get(c, "by");
    uint64_t refused = md_require_all(o, HE_FACE, md_get(c, "face"));
    find_starts(m, start);
    return refused != 0 ? refused
                        : or_face_extrude(o, region_of(c, start), by->given ? by->points : NULL,
                                          md_get(c, "distance")->number);
}

static bool draw_face_inset(md_draft *d)
{
    draw_faces(d);
    if (!have_room(d->o, md_get(d->c, "face"))) {
        return false;
    }
    if (d->far || md_chance(d->r, 50)) {
        md_give_number(d, "factor", 0.05 + 0.9 * md_unit(d->r));
        return true;
    }
    md_give_number(d, "distance", md_chance(d->r, 5) ? -1 : md_unit(d->r));
    return is_clear(d, true);
}

static uint64_t play_face_inset(const md_call *c, or_mesh *o, const he_mesh *m)
{
    uint32_t start[OR_FACES];
    const he_arg *factor = md_get(c, "factor");
    double distance = md_get(c, "distance")->number;
    uint64_t refused = md_require_all(o, HE_FACE, md_get(c, "face"));
    find_starts(m, start);
    if (refused != 0) {
        return refused | (!factor->given && distance <= 0 ? OR_BIT(HE_BAD_VALUE) : 0);
    }
    return or_face_inset(o, region_of(c, start), factor->given ? factor->number : 0, distance);
}

/* Draws a face_collapse, but not of a face with so large surroundings that hedge may refuse the
 * work; limits.h tests that refusal. */
static bool draw_face_collapse(md_draft *d)
{
    uint32_t f = md_pick(d, HE_FACE);
    uint64_t steps = 0;
    md_give_id(d, "face", f);
    if (or_require(d->o, HE_FACE, f) != 0) {
        return true;
    }
    const or_face *face = &d->o->face[f];
    for (uint32_t i = 0; i < face->count; i++) {
        uint32_t v = face->v[i];
        for (uint32_t k = 0; k < or_degree(d->o, v); k++) {
            uint32_t g = d->o->left[v][d->o->around[v][k]];
            steps += g != OR_NONE ? d->o->face[g].count + 2 : 2;
        }
    }
    return steps * face->count < HE_FACE_COLLAPSE_STEPS;
}

static uint64_t play_face_collapse(const md_call *c, or_mesh *o, const he_mesh *m)
{
    uint32_t f = md_get(c, "face")->id;
    uint64_t refused = or_require(o, HE_FACE, f);
    return refused != 0 ? refused
                        : or_face_collapse(o, f, he_origin(m, he_face_halfedge(m, (he_face){f})).i);
}

static bool draw_triangulate(md_draft *d)
{
    uint32_t polygons = 0;
    for (uint32_t f = 0; f < d->o->faces; f++) {
        polygons += d->o->face[f].alive && d->o->face[f].count > 3;
    }
    return polygons < OR_LIST && md_chance(d->r, 20);
}

static uint64_t play_triangulate(const md_call *c, or_mesh *o, const he_mesh *m)
{
    uint32_t start[OR_FACES];
    uint32_t ids[OR_LIST];
    uint32_t origins[OR_LIST];
    uint32_t n = 0;
    (void)c;
    find_starts(m, start);
    for (uint32_t f = 0; f < o->faces; f++) {
        if (o->face[f].alive && o->face[f].count > 3) {
            ids[n] = f;
            origins[n++] = start[f];
        }
    }
    return or_face_triangulate(o, ids, origins, n);
}

static bool draw_reverse(md_draft *d)
{
    switch (md_below(d->r, 4)) {
    case 0:
        break;
    case 1:
        (void)md_pick_some(d, "face", "faces", HE_FACE, 3);
        break;
    default:
        pick_patch(d);
        break;
    }
    return true;
}

static uint64_t play_reverse(const md_call *c, or_mesh *o, const he_mesh *m)
{
    (void)m;
    const he_arg *f = md_get(c, "face");
    uint64_t refused = f->given ? md_require_all(o, HE_FACE, f) : 0;
    return refused != 0
               ? refused
               : or_reverse(o, f->given ? f->ids : NULL, f->given ? (uint32_t)f->count : 0);
}

static bool draw_dual(md_draft *d)
{
    return d->o->vertices + or_live_faces(d->o) < OR_VERTICES &&
           d->o->edges + or_live_edges(d->o) < OR_EDGES &&
           d->o->faces + or_live_vertices(d->o) < OR_FACES &&
           (he_mesh_boundary_halfedges(d->m) == 0 || md_chance(d->r, 30));
}

static uint64_t play_dual(const md_call *c, or_mesh *o, const he_mesh *m)
{
    (void)c;
    (void)m;
    return or_dual(o);
}

/* --- another mesh, which lives until the next one is drawn --- */

static or_mesh *other_oracle;
static he_mesh *other;

/* Adds the attribute `locked` of faces as numbers; if the mesh that is edited has it as bools, the
 * two clash. */
static bool add_numbers(he_mesh *m)
{
    he_column *column = NULL;
    if (he_column_new(&(he_column_schema){"locked", HE_FACE, HE_INT32, 1, HE_COPY}, &column,
                      NULL) != HE_OK) {
        return false;
    }
    if (he_mesh_add_column(m, column, NULL) == HE_OK) {
        return true;
    }
    he_column_free(column);
    return true;
}

static bool draw_append(md_draft *d)
{
    if (other_oracle == NULL) {
        other_oracle = or_new();
    }
    he_mesh_free(other);
    md_shape(other_oracle, d->r, md_fill_mixed);
    other = md_build(other_oracle);
    if (other == NULL || !md_mark(other, d->r) || (md_chance(d->r, 10) && !add_numbers(other))) {
        return false;
    }
    if (he_mesh_faces(other) > 0 && md_chance(d->r, 50)) {
        uint32_t f = md_below(d->r, he_mesh_faces(other));
        he_status status = he_face_delete(other, &f, 1, HE_DROP_ISOLATED, NULL);
        if (status == HE_OK) {
            (void)or_face_delete(other_oracle, &f, 1, false);
        }
    }
    he_arg *arg = &d->c->args[md_index(d->c, "mesh")];
    arg->given = true;
    arg->mesh = other;
    return he_mesh_faces(other) < 40 && d->o->vertices + he_mesh_vertices(other) < OR_VERTICES &&
           d->o->edges + he_mesh_edges(other) < OR_EDGES &&
           d->o->faces + he_mesh_faces(other) < OR_FACES;
}

static bool clashes(const he_mesh *m, const he_mesh *theirs)
{
    for (size_t i = 0; i < he_mesh_columns(theirs); i++) {
        const he_column *column = he_mesh_column(theirs, i);
        const he_column *own = he_mesh_find_column(m, column->domain, column->name);
        if (own != NULL && own->type != column->type) {
            return true;
        }
    }
    return false;
}

static uint64_t play_append(const md_call *c, or_mesh *o, const he_mesh *m)
{
    (void)c;
    if (clashes(m, other)) {
        return OR_BIT(HE_ATTRIBUTE_CLASH);
    }
    or_append(o, other_oracle);
    return 0;
}

const md_row md_region_rows[] = {
    {"face_extrude", 1, draw_face_extrude, play_face_extrude, NULL, true},
    {"face_inset", 1, draw_face_inset, play_face_inset, NULL, true},
    {"face_collapse", -1, draw_face_collapse, play_face_collapse, NULL, false},
    {"triangulate", 1, draw_triangulate, play_triangulate, NULL, false},
    {"reverse", 0, draw_reverse, play_reverse, NULL, false},
    {"dual", 0, draw_dual, play_dual, NULL, false},
    {"append", 1, draw_append, play_append, NULL, false},
    {.name = NULL},
};
