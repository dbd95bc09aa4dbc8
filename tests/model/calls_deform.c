#include "model/adopt.h"
#include "model/rows.h"

#include "deform/deform.h"
#include "mesh/walk.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Gives the goals of `count` handles in one of the three ways. */
static void give_goal(md_draft *d, uint32_t count)
{
    if (md_chance(d->r, 30)) {
        const double angle = 6.283185307179586 * md_unit(d->r);
        const double matrix[16] = {
            cos(angle), -sin(angle), 0, md_unit(d->r),  sin(angle), cos(angle), 0, 0,
            0,          0,           1, -md_unit(d->r), 0,          0,          0, 1};
        he_arg *arg = &d->c->args[md_index(d->c, "matrix")];
        arg->given = true;
        memcpy(arg->matrix, matrix, sizeof matrix);
        return;
    }
    const bool each = count > 1 && count < MD_LIST && md_chance(d->r, 70), far = d->far;
    d->far = false; /* a position could become infinite */
    md_give_points(d, md_chance(d->r, 50) ? "to" : "by",
                   each ? count + (md_chance(d->r, 5) ? 1 : 0) : 1, each);
    d->far = far;
}

static bool draw_deform(md_draft *d)
{
    for (uint32_t v = 0; v < d->o->vertices; v++) {
        const he_vec3 p = d->o->vertex[v].at;
        if (d->o->vertex[v].alive && !(fabs(p.x) + fabs(p.y) + fabs(p.z) < 1e100)) {
            return false; /* a position could become infinite */
        }
    }
    const bool arap = md_chance(d->r, 60);
    md_give_choice(d, "method", arap ? "arap" : "biharmonic");
    if (arap) {
        md_give_number(d, "steps", md_from(d->r, 1, 3));
    }
    give_goal(d, md_pick_some(d, "vertex", "vertices", HE_VERTEX, 4));
    if (md_chance(d->r, 60)) {
        (void)md_pick_some(d, "fixed_vertex", "fixed", HE_VERTEX, MD_LIST);
    }
    return md_is_tame(d);
}

static he_deform_goal goal_of(const md_call *c)
{
    const he_arg *to = md_get(c, "to"), *by = md_get(c, "by"), *matrix = md_get(c, "matrix");
    return (he_deform_goal){.to = to->given ? to->points : NULL,
                            .by = by->given ? by->points : NULL,
                            .count = to->given ? to->count : by->count,
                            .matrix = matrix->given ? matrix->matrix : NULL};
}

static he_status run(const md_call *c, he_mesh *m)
{
    const he_arg *handles = md_get(c, "vertices"), *fixed = md_get(c, "fixed");
    const he_deform_sets sets = {.method = (he_deform_method)md_get(c, "method")->choice,
                                 .handles = handles->ids,
                                 .handle_count = handles->count,
                                 .fixed = fixed->ids,
                                 .fixed_count = fixed->count};
    const he_deform_goal goal = goal_of(c);
    return he_deform(m, &sets, &goal, (unsigned)md_get(c, "steps")->number, NULL, NULL);
}

/* Returns where handle i goes. */
static he_vec3 goal_at(const md_call *c, const or_mesh *o, size_t i)
{
    const he_deform_goal goal = goal_of(c);
    const he_vec3 p = o->vertex[md_get(c, "vertices")->ids[i]].at;
    const double *k = goal.matrix;
    if (k != NULL) {
        return (he_vec3){k[0] * p.x + k[1] * p.y + k[2] * p.z + k[3],
                         k[4] * p.x + k[5] * p.y + k[6] * p.z + k[7],
                         k[8] * p.x + k[9] * p.y + k[10] * p.z + k[11]};
    }
    const size_t at = goal.count == 1 ? 0 : i;
    if (goal.to != NULL) {
        return goal.to[at];
    }
    return (he_vec3){p.x + goal.by[at].x, p.y + goal.by[at].y, p.z + goal.by[at].z};
}

static bool is_at(he_vec3 a, he_vec3 b)
{
    return !(a.x < b.x || a.x > b.x || a.y < b.y || a.y > b.y || a.z < b.z || a.z > b.z);
}

/* Returns true if the vertex is locked, or has a locked edge or face. */
static bool is_held(const or_mesh *o, uint32_t v)
{
    bool held = o->vertex[v].locked;
    for (uint32_t e = 0; e < o->edges && !held; e++) {
        held = o->edge[e].alive && o->edge[e].locked && (o->edge[e].a == v || o->edge[e].b == v);
    }
    for (uint32_t f = 0; f < o->faces && !held; f++) {
        for (uint32_t i = 0; o->face[f].alive && o->face[f].locked && i < o->face[f].count; i++) {
            held |= o->face[f].v[i] == v;
        }
    }
    return held;
}

/* Marks the vertices that may move: handles, and those that are connected with them by edges
 * between vertices that are not held. */
static void mark_free(const md_call *c, const or_mesh *o, bool may_move[OR_VERTICES])
{
    const he_arg *handles = md_get(c, "vertices"), *fixed = md_get(c, "fixed");
    memset(may_move, 0, OR_VERTICES * sizeof *may_move);
    for (size_t i = 0; i < handles->count; i++) {
        may_move[handles->ids[i]] = true;
    }
    for (bool changed = true; changed;) {
        changed = false;
        for (uint32_t e = 0; e < o->edges; e++) {
            const uint32_t a = o->edge[e].a, b = o->edge[e].b;
            if (!o->edge[e].alive || may_move[a] == may_move[b]) {
                continue;
            }
            const uint32_t other = may_move[a] ? b : a;
            if (!md_is_listed(fixed, other) && !is_held(o, other)) {
                may_move[other] = changed = true;
            }
        }
    }
}

/* Runs a deformation on the oracle. Hedge chooses the positions, which a copy of its mesh shows;
 * the oracle takes them over after checking what must stay, and where the handles are. */
static uint64_t play_deform(const md_call *c, or_mesh *o, const he_mesh *m)
{
    const he_arg *handles = md_get(c, "vertices"), *fixed = md_get(c, "fixed");
    const he_deform_goal goal = goal_of(c);
    uint64_t refused = md_require_all(o, HE_VERTEX, handles);
    refused |= fixed->given ? md_require_all(o, HE_VERTEX, fixed) : 0;
    if (goal.matrix == NULL && goal.count != 1 && goal.count != handles->count) {
        refused |= OR_BIT(HE_BAD_VALUE);
    }
    for (size_t i = 0; i < handles->count; i++) {
        refused |= md_is_listed(fixed, handles->ids[i]) ? OR_BIT(HE_REPEATED_ELEMENT) : 0;
    }
    for (size_t i = 0; i < handles->count && refused == 0; i++) {
        const or_vertex *v = &o->vertex[handles->ids[i]];
        if (v->locked && !is_at(goal_at(c, o, i), v->at)) {
            refused |= OR_BIT(HE_LOCKED_ELEMENT);
        }
    }
    if (refused != 0) {
        return refused;
    }
    he_mesh *made = NULL;
    if (he_mesh_copy(m, &made, NULL) != HE_OK || run(c, made) != HE_OK) {
        abort();
    }
    bool may_move[OR_VERTICES];
    mark_free(c, o, may_move);
    for (size_t i = 0; i < handles->count; i++) {
        const uint32_t v = handles->ids[i];
        if (!is_at(he_position(made, (he_vertex){v}), goal_at(c, o, i))) {
            fprintf(stderr, "deform did not move vertex %u to its goal\n", v);
            abort();
        }
    }
    for (uint32_t v = 0; v < o->vertices; v++) {
        const he_vec3 at = he_position(made, (he_vertex){v});
        if (!o->vertex[v].alive) {
            continue;
        }
        if (!may_move[v] && !or_same_point(o->vertex[v].at, at)) {
            fprintf(stderr, "deform moved vertex %u\n", v);
            abort();
        }
        o->vertex[v].at = at;
    }
    he_mesh_free(made);
    return 0;
}

const md_row md_deform_rows[] = {
    {"deform", 0, draw_deform, play_deform, NULL, true},
    {.name = NULL},
};
