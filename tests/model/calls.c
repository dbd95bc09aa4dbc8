#include "model/calls.h"

#include "mesh/walk.h"
#include "model/rows.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

/* --- the rows --- */

static bool draw_vertex_add(md_draft *d)
{
    md_give_points(d, "position", 1, false);
    return true;
}

static uint64_t play_vertex_add(const md_call *c, or_mesh *o, const he_mesh *m)
{
    (void)m;
    return or_vertex_add(o, md_get(c, "position")->points[0]);
}

static bool draw_vertex_move(md_draft *d)
{
    uint32_t n = md_pick_some(d, "vertex", "vertices", HE_VERTEX, 4);
    bool each = n > 1 && md_chance(d->r, 50);
    uint32_t points = each ? n : 1;
    if (each && he_op_declares(d->c->op, HE_BAD_VALUE) && md_chance(d->r, 10)) {
        points++;
    }
    md_give_points(d, md_chance(d->r, 50) ? "to" : "by", points, each);
    return true;
}

static uint64_t play_vertex_move(const md_call *c, or_mesh *o, const he_mesh *m)
{
    (void)m;
    const he_arg *v = md_get(c, "vertex");
    const he_arg *to = md_get(c, "to");
    const he_arg *by = md_get(c, "by");
    const he_arg *where = to->given ? to : by;
    uint64_t refused = md_require_all(o, HE_VERTEX, v);
    if (where->list && where->count != v->count) {
        refused |= OR_BIT(HE_BAD_VALUE);
    }
    he_vec3 goal[MD_LIST];
    for (size_t i = 0; i < v->count && refused == 0; i++) {
        he_vec3 p = where->points[where->list ? i : 0];
        he_vec3 at = by->given ? o->vertex[v->ids[i]].at : (he_vec3){0, 0, 0};
        goal[i] = (he_vec3){at.x + p.x, at.y + p.y, at.z + p.z};
    }
    return refused != 0 ? refused : or_vertex_move(o, v->ids, goal, (uint32_t)v->count);
}

static bool draw_vertex_delete(md_draft *d)
{
    md_give_id(d, "vertex", md_pick(d, HE_VERTEX));
    if (md_chance(d->r, 50)) {
        md_give_flag(d, "keep_isolated", md_chance(d->r, 60));
    }
    return true;
}

static uint64_t play_vertex_delete(const md_call *c, or_mesh *o, const he_mesh *m)
{
    (void)m;
    uint64_t refused = or_require(o, HE_VERTEX, md_get(c, "vertex")->id);
    return refused != 0
               ? refused
               : or_vertex_delete(o, md_get(c, "vertex")->id, md_get(c, "keep_isolated")->flag);
}

static bool draw_vertex_split(md_draft *d)
{
    uint32_t v = md_pick(d, HE_VERTEX);
    uint32_t around[OR_VERTICES];
    uint32_t n = 0;
    if (or_require(d->o, HE_VERTEX, v) == 0) {
        n = or_neighbours(d->o, v, around, OR_VERTICES);
    }
    md_give_id(d, "vertex", v);
    for (int side = 0; side < 2; side++) {
        uint32_t x =
            n > 0 && md_chance(d->r, 90) ? around[md_below(d->r, n)] : md_pick(d, HE_VERTEX);
        bool none = md_chance(d->r, n > 0 && or_on_boundary(d->o, v) ? 25 : 5);
        md_give_id(d, side == 0 ? "left" : "right", none ? HE_NONE : x);
    }
    if (md_chance(d->r, 60) || (d->c->op->params[md_index(d->c, "to")].flags & HE_REQUIRED) != 0) {
        md_give_points(d, "to", 1, false);
    }
    return true;
}

static uint64_t play_vertex_split(const md_call *c, or_mesh *o, const he_mesh *m)
{
    (void)m;
    uint32_t left = md_get(c, "left")->id;
    uint32_t right = md_get(c, "right")->id;
    uint64_t refused = or_require(o, HE_VERTEX, md_get(c, "vertex")->id);
    uint64_t sides = left == HE_NONE ? 0 : or_require(o, HE_VERTEX, left);
    sides |= right == HE_NONE ? 0 : or_require(o, HE_VERTEX, right);
    if (sides != 0) {
        /* If another refusal also applies, hedge may report that refusal first. */
        bool null = left == HE_NONE || right == HE_NONE;
        uint32_t v = md_get(c, "vertex")->id;
        bool there = refused == 0;
        refused |= sides | OR_BIT(HE_NOT_NEIGHBOUR);
        refused |= left == right ? OR_BIT(HE_REPEATED_ELEMENT) : 0;
        refused |= there && or_fans(o, v) > 1 ? OR_BIT(HE_BOWTIE) : 0;
        refused |= there && null && !or_on_boundary(o, v) ? OR_BIT(HE_NOT_BOUNDARY) : 0;
    }
    const he_arg *to = md_get(c, "to");
    return refused != 0 ? refused
                        : or_vertex_split(o, md_get(c, "vertex")->id, left, right,
                                          to->given ? to->points : NULL);
}

static bool draw_face_add(md_draft *d)
{
    uint32_t v[MD_LIST];
    uint32_t n = 0;
    uint32_t h = md_boundary_halfedge(d);
    switch (md_is_live_boundary(d->m, h) ? md_below(d->r, 6) : md_below(d->r, 3)) {
    case 0: /* random vertices */
        n = md_from(d->r, 2, 5);
        for (uint32_t i = 0; i < n; i++) {
            v[i] = md_pick(d, HE_VERTEX);
        }
        break;
    case 1: /* the corners of an existing face, in the opposite or in the same order */
    {
        uint32_t f = md_live(d, HE_FACE);
        if (or_require(d->o, HE_FACE, f) != 0 || d->o->face[f].count > MD_LIST) {
            return false;
        }
        bool same = md_chance(d->r, 20);
        n = d->o->face[f].count;
        for (uint32_t i = 0; i < n; i++) {
            v[i] = d->o->face[f].v[same ? i : n - 1 - i];
        }
        break;
    }
    case 2: /* vertices that are on the boundary or isolated are used as corners */
        n = md_from(d->r, 3, 4);
        for (uint32_t i = 0; i < n; i++) {
            v[i] = md_live(d, HE_VERTEX);
            for (int tries = 0; tries < 20 && or_require(d->o, HE_VERTEX, v[i]) == 0 &&
                                !or_on_boundary(d->o, v[i]);
                 tries++) {
                v[i] = md_live(d, HE_VERTEX);
            }
        }
        break;
    default: /* consecutive vertices along a hole are used as corners, so that the face fills a part
                of the hole; another vertex may be added */
    {
        he_halfedge at = {h};
        uint32_t run = md_from(d->r, 2, 5);
        for (uint32_t i = 0; i < run && (i == 0 || at.i != h); i++) {
            v[n++] = he_origin(d->m, at).i;
            at = he_next(d->m, at);
        }
        if (n < 3 || md_chance(d->r, 20)) {
            v[n++] = md_live(d, HE_VERTEX);
        }
        break;
    }
    }
    if (n > 0 && md_chance(d->r, 4)) {
        v[md_below(d->r, n)] = v[0];
    }
    md_give_ids(d, "vertices", v, n, true);
    return true;
}

static uint64_t play_face_add(const md_call *c, or_mesh *o, const he_mesh *m)
{
    (void)m;
    const he_arg *v = md_get(c, "vertices");
    uint64_t refused = 0;
    for (size_t i = 0; i < v->count; i++) {
        refused |= or_require(o, HE_VERTEX, v->ids[i]);
        for (size_t k = 0; k < i; k++) {
            refused |= v->ids[i] == v->ids[k] ? OR_BIT(HE_REPEATED_CORNER) : 0;
        }
    }
    if (refused != 0) {
        return refused | (v->count < 3 ? OR_BIT(HE_TOO_FEW_CORNERS) : 0);
    }
    return or_face_add(o, v->ids, (uint32_t)v->count);
}

static bool draw_face_delete(md_draft *d)
{
    (void)md_pick_some(d, "face", "faces", HE_FACE, 3);
    if (md_chance(d->r, 50)) {
        md_give_flag(d, "keep_isolated", md_chance(d->r, 60));
    }
    return true;
}

static uint64_t play_face_delete(const md_call *c, or_mesh *o, const he_mesh *m)
{
    (void)m;
    const he_arg *f = md_get(c, "face");
    uint64_t refused = md_require_all(o, HE_FACE, f);
    return refused != 0
               ? refused
               : or_face_delete(o, f->ids, (uint32_t)f->count, md_get(c, "keep_isolated")->flag);
}

/* The request names a corner of the face by its vertex or by the half-edge that leaves it. */
static const char *const split_corner[2][2] = {{"from", "from_halfedge"}, {"to", "to_halfedge"}};

static bool draw_face_split(md_draft *d)
{
    uint32_t f = md_pick(d, HE_FACE);
    for (int tries = 0; tries < 4 && or_require(d->o, HE_FACE, f) == 0 && d->o->face[f].count == 3;
         tries++) {
        f = md_live(d, HE_FACE);
    }
    md_give_id(d, "face", f);
    bool there = or_require(d->o, HE_FACE, f) == 0;
    for (int side = 0; side < 2; side++) {
        uint32_t v = md_pick(d, HE_VERTEX);
        uint32_t h = md_pick(d, HE_HALFEDGE);
        if (there && md_chance(d->r, 93)) {
            v = d->o->face[f].v[md_below(d->r, d->o->face[f].count)];
            uint32_t e = d->o->joined[v][or_after(&d->o->face[f], v)];
            h = 2 * e + (d->o->edge[e].a != v);
        }
        bool by_vertex = md_chance(d->r, 60);
        md_give_id(d, split_corner[side][by_vertex ? 0 : 1], by_vertex ? v : h);
    }
    return true;
}

static uint64_t play_face_split(const md_call *c, or_mesh *o, const he_mesh *m)
{
    (void)m;
    uint32_t f = md_get(c, "face")->id;
    uint32_t corner[2];
    uint64_t refused = or_require(o, HE_FACE, f);
    uint64_t missing = 0;
    for (int side = 0; side < 2; side++) {
        const he_arg *v = md_get(c, split_corner[side][0]);
        const he_arg *h = md_get(c, split_corner[side][1]);
        corner[side] = v->id;
        missing |= v->given ? or_require(o, HE_VERTEX, v->id) : or_require(o, HE_HALFEDGE, h->id);
        if (h->given && missing == 0) {
            const or_edge *e = &o->edge[h->id / 2];
            uint32_t a = h->id % 2 == 0 ? e->a : e->b;
            uint32_t b = h->id % 2 == 0 ? e->b : e->a;
            corner[side] = a;
            if (o->left[a][b] != f) {
                missing |= OR_BIT(HE_NOT_A_CORNER);
            }
        }
    }
    refused |= missing;
    if (refused != 0) {
        /* If another refusal also applies, hedge may report first that the two corners are
         * equal. */
        return refused | OR_BIT(HE_NOT_A_CORNER) | OR_BIT(HE_SAME_CORNER);
    }
    return or_face_split(o, f, corner[0], corner[1]);
}

static bool draw_edge(md_draft *d)
{
    md_give_id(d, "edge", md_pick(d, HE_EDGE));
    return true;
}

/* Returns whether the faces beside a live edge stay small enough for the oracle's tables. */
static bool edge_has_room(const or_mesh *o, uint32_t e, uint32_t most)
{
    uint32_t corners = 0;
    if (or_require(o, HE_EDGE, e) != 0) {
        return true;
    }
    uint32_t f = o->left[o->edge[e].a][o->edge[e].b];
    uint32_t g = o->left[o->edge[e].b][o->edge[e].a];
    corners += f == OR_NONE ? 0 : o->face[f].count;
    corners += g == OR_NONE ? 0 : o->face[g].count;
    return corners < most;
}

static bool draw_face_join(md_draft *d)
{
    return draw_edge(d) && edge_has_room(d->o, md_get(d->c, "edge")->id, OR_CORNERS);
}

static uint64_t play_face_join(const md_call *c, or_mesh *o, const he_mesh *m)
{
    (void)m;
    uint64_t refused = or_require(o, HE_EDGE, md_get(c, "edge")->id);
    return refused != 0 ? refused : or_face_join(o, md_get(c, "edge")->id);
}

static bool draw_face_poke(md_draft *d)
{
    md_give_id(d, "face", md_pick(d, HE_FACE));
    if (md_chance(d->r, 50)) {
        md_give_points(d, "position", 1, false);
    }
    return true;
}

static uint64_t play_face_poke(const md_call *c, or_mesh *o, const he_mesh *m)
{
    uint32_t f = md_get(c, "face")->id;
    const he_arg *at = md_get(c, "position");
    uint64_t refused = or_require(o, HE_FACE, f);
    if (refused != 0) {
        return refused;
    }
    uint32_t start = he_origin(m, he_face_halfedge(m, (he_face){f})).i;
    return or_face_poke(o, f, start, at->given ? at->points : NULL);
}

static bool draw_face_triangulate(md_draft *d)
{
    (void)md_pick_some(d, "face", "faces", HE_FACE, 3);
    return true;
}

static uint64_t play_face_triangulate(const md_call *c, or_mesh *o, const he_mesh *m)
{
    const he_arg *f = md_get(c, "face");
    uint64_t refused = md_require_all(o, HE_FACE, f);
    if (refused != 0) {
        return refused;
    }
    uint32_t start[MD_LIST];
    for (size_t i = 0; i < f->count; i++) {
        start[i] = he_origin(m, he_face_halfedge(m, (he_face){f->ids[i]})).i;
    }
    return or_face_triangulate(o, f->ids, start, (uint32_t)f->count);
}

static bool draw_edge_cut(md_draft *d)
{
    if (md_chance(d->r, 70)) {
        md_give_number(d, "t", md_unit(d->r) * 0.98 + 0.01);
    }
    return draw_edge(d) && edge_has_room(d->o, md_get(d->c, "edge")->id, OR_CORNERS - 2);
}

static uint64_t play_edge_bisect(const md_call *c, or_mesh *o, const he_mesh *m)
{
    (void)m;
    uint64_t refused = or_require(o, HE_EDGE, md_get(c, "edge")->id);
    return refused != 0 ? refused
                        : or_edge_bisect(o, md_get(c, "edge")->id, md_get(c, "t")->number);
}

static uint64_t play_edge_split(const md_call *c, or_mesh *o, const he_mesh *m)
{
    (void)m;
    uint64_t refused = or_require(o, HE_EDGE, md_get(c, "edge")->id);
    return refused != 0 ? refused : or_edge_split(o, md_get(c, "edge")->id, md_get(c, "t")->number);
}

static bool draw_edge_join(md_draft *d)
{
    uint32_t v = md_pick(d, HE_VERTEX);
    uint32_t issued = he_mesh_issued(d->m, HE_VERTEX);
    if (md_chance(d->r, 70)) {
        for (uint32_t i = 0; i < issued; i++) {
            uint32_t x = (v % issued + i) % issued;
            if (d->o->vertex[x].alive && or_degree(d->o, x) == 2) {
                v = x;
                break;
            }
        }
    }
    md_give_id(d, "vertex", v);
    return true;
}

static uint64_t play_edge_join(const md_call *c, or_mesh *o, const he_mesh *m)
{
    (void)m;
    uint64_t refused = or_require(o, HE_VERTEX, md_get(c, "vertex")->id);
    return refused != 0 ? refused : or_edge_join(o, md_get(c, "vertex")->id);
}

static uint64_t play_edge_flip(const md_call *c, or_mesh *o, const he_mesh *m)
{
    (void)m;
    uint64_t refused = or_require(o, HE_EDGE, md_get(c, "edge")->id);
    return refused != 0 ? refused : or_edge_flip(o, md_get(c, "edge")->id);
}

static bool draw_edge_collapse(md_draft *d)
{
    if (md_chance(d->r, 60)) {
        md_give_id(d, "halfedge", md_pick(d, HE_HALFEDGE));
    } else {
        md_give_id(d, "edge", md_pick(d, HE_EDGE));
    }
    switch (md_below(d->r, 4)) {
    case 0:
        break;
    case 1:
        md_give_points(d, "to", 1, false);
        break;
    case 2:
        md_give_number(d, "t", md_below(d->r, 2));
        break;
    default:
        md_give_number(d, "t", md_unit(d->r));
        break;
    }
    return true;
}

static uint64_t play_edge_collapse(const md_call *c, or_mesh *o, const he_mesh *m)
{
    (void)m;
    const he_arg *halfedge = md_get(c, "halfedge");
    const he_arg *edge = md_get(c, "edge");
    const he_arg *to = md_get(c, "to");
    uint64_t refused = halfedge->given ? or_require(o, HE_HALFEDGE, halfedge->id)
                                       : or_require(o, HE_EDGE, edge->id);
    if (refused != 0) {
        return refused;
    }
    const or_edge *e = &o->edge[halfedge->given ? halfedge->id / 2 : edge->id];
    bool turned = halfedge->given && halfedge->id % 2 == 1;
    return or_edge_collapse(o, &(or_collapse){.u = turned ? e->b : e->a,
                                              .v = turned ? e->a : e->b,
                                              .t = md_get(c, "t")->number,
                                              .to = to->given ? to->points : NULL});
}

/* Draws a rotation about z, a translation, and sometimes a mirror: repeated many times, these keep
 * the coordinates small. */
static bool draw_transform(md_draft *d)
{
    double angle = md_unit(d->r) * 6;
    double mirror = md_chance(d->r, 20) ? -1 : 1;
    const double matrix[16] = {cos(angle), -sin(angle), 0,      md_unit(d->r) - 0.5,
                               sin(angle), cos(angle),  0,      md_unit(d->r) - 0.5,
                               0,          0,           mirror, md_unit(d->r) - 0.5,
                               0,          0,           0,      1};
    he_arg *arg = &d->c->args[md_index(d->c, "matrix")];
    arg->given = true;
    memcpy(arg->matrix, matrix, sizeof matrix);
    if (md_chance(d->r, 5)) {
        /* The matrix makes all coordinates overflow, except those of vertices near the plane x =
         * 0. */
        bool overflows = false;
        for (uint32_t v = 0; v < d->o->vertices; v++) {
            overflows = overflows || (d->o->vertex[v].alive && d->o->vertex[v].at.x > 0.2);
        }
        arg->matrix[0] = overflows ? 1.7e308 : 1;
        arg->matrix[1] = 0;
        arg->matrix[3] = overflows ? 1.7e308 : 0;
        return true;
    }
    if (md_chance(d->r, 60)) {
        const he_param *p = &d->c->op->params[md_index(d->c, "vertices")];
        const char *many = p->plural != NULL ? p->plural : p->name;
        (void)md_pick_some(d, p->name, many, HE_VERTEX, 4);
    }
    return true;
}

static uint64_t play_transform(const md_call *c, or_mesh *o, const he_mesh *m)
{
    (void)m;
    const he_arg *v = md_get(c, "vertices");
    uint64_t refused = v->given ? md_require_all(o, HE_VERTEX, v) : 0;
    return refused != 0 ? refused
                        : or_transform(o, md_get(c, "matrix")->matrix, v->given ? v->ids : NULL,
                                       v->given ? (uint32_t)v->count : 0);
}

static bool draw_plane_split(md_draft *d)
{
    md_give_plane(d);
    if (md_chance(d->r, 30)) {
        md_give_number(d, "tolerance", md_chance(d->r, 5) ? -1 : md_unit(d->r) * 0.5);
    }
    if (or_live_faces(d->o) > 40 || md_chance(d->r, 30)) {
        (void)md_pick_some(d, "face", "faces", HE_FACE, 5);
    }
    const or_plane plane = md_plane(d->c);
    or_plane_size size = or_plane_measure(d->o, &plane);
    return !size.doubtful && d->o->vertices + size.crossed < OR_VERTICES &&
           d->o->edges + 3 * size.crossed + size.cut < OR_EDGES &&
           d->o->faces + size.crossed + size.cut < OR_FACES && size.cut < OR_LIST &&
           size.longest < OR_CORNERS;
}

static uint64_t play_plane_split(const md_call *c, or_mesh *o, const he_mesh *m)
{
    const he_arg *f = md_get(c, "face");
    const he_arg *tolerance = md_get(c, "tolerance");
    uint64_t refused = f->given ? md_require_all(o, HE_FACE, f) : 0;
    uint32_t start[OR_FACES];
    for (uint32_t i = 0; i < o->faces; i++) {
        start[i] = OR_NONE;
        if (o->face[i].alive) {
            start[i] = he_origin(m, he_face_halfedge(m, (he_face){i})).i;
        }
    }
    const or_plane plane = md_plane(c);
    if (refused != 0) {
        bool zero = fabs(plane.normal.x) + fabs(plane.normal.y) + fabs(plane.normal.z) == 0;
        return refused | (zero || tolerance->number < 0 ? OR_BIT(HE_BAD_VALUE) : 0);
    }
    return or_plane_split(o, &plane, f->given ? f->ids : NULL, (uint32_t)f->count, start);
}

static bool draw_delaunay(md_draft *d)
{
    if (md_chance(d->r, 50)) {
        (void)md_pick_some(d, "edge", "edges", HE_EDGE, 4);
    }
    return true;
}

static uint64_t play_delaunay(const md_call *c, or_mesh *o, const he_mesh *m)
{
    (void)m;
    const he_arg *e = md_get(c, "edge");
    return e->given ? md_require_all(o, HE_EDGE, e) : 0;
}

static bool follow_delaunay(const md_call *c, or_mesh *o, const he_results *results,
                            char text[OR_TEXT])
{
    const he_arg *begin = md_get(c, "edge");
    bool looked[OR_EDGES];
    for (uint32_t e = 0; e < OR_EDGES; e++) {
        looked[e] = !begin->given;
    }
    for (size_t i = 0; i < begin->count; i++) {
        looked[begin->ids[i]] = true;
    }
    const he_ids *flips = &results->list[1];
    if (results->number[0] != (double)flips->count) {
        (void)snprintf(text, OR_TEXT, "%g flips, %zu listed", results->number[0], flips->count);
        return false;
    }
    for (size_t i = 0; i < flips->count; i++) {
        if (!or_delaunay_flip(o, flips->ids[i], looked, text, OR_TEXT)) {
            return false;
        }
    }
    return or_delaunay_done(o, looked, text, OR_TEXT);
}

static bool draw_compact(md_draft *d)
{
    return md_chance(d->r, 15);
}

static uint64_t play_compact(const md_call *c, or_mesh *o, const he_mesh *m)
{
    (void)c;
    (void)m;
    or_compact(o);
    return 0;
}

static const md_row rows[] = {
    {"vertex_add", 1, draw_vertex_add, play_vertex_add, NULL, true},
    {"vertex_move", 0, draw_vertex_move, play_vertex_move, NULL, true},
    {"vertex_delete", -1, draw_vertex_delete, play_vertex_delete, NULL, true},
    {"vertex_split", 1, draw_vertex_split, play_vertex_split, NULL, false},
    {"face_add", 1, draw_face_add, play_face_add, NULL, true},
    {"face_delete", -1, draw_face_delete, play_face_delete, NULL, true},
    {"face_split", 1, draw_face_split, play_face_split, NULL, true},
    {"face_join", -1, draw_face_join, play_face_join, NULL, true},
    {"face_poke", 1, draw_face_poke, play_face_poke, NULL, false},
    {"face_triangulate", 1, draw_face_triangulate, play_face_triangulate, NULL, false},
    {"edge_bisect", 1, draw_edge_cut, play_edge_bisect, NULL, false},
    {"edge_join", -1, draw_edge_join, play_edge_join, NULL, false},
    {"edge_split", 1, draw_edge_cut, play_edge_split, NULL, false},
    {"edge_flip", 0, draw_edge, play_edge_flip, NULL, true},
    {"edge_collapse", -1, draw_edge_collapse, play_edge_collapse, NULL, false},
    {"transform", 0, draw_transform, play_transform, NULL, false},
    {"plane_split", 1, draw_plane_split, play_plane_split, NULL, false},
    {"delaunay", 0, draw_delaunay, play_delaunay, follow_delaunay, false},
    {"compact", 0, draw_compact, play_compact, NULL, true},
    {.name = NULL},
};

static const md_row *const groups[] = {
    rows,           md_border_rows, md_weld_rows,    md_corner_rows,
    md_loop_rows,   md_region_rows, md_refine_rows,  md_decimate_rows,
    md_remesh_rows, md_smooth_rows, md_fill_rows,    md_material_rows,
    md_deform_rows, md_select_rows, md_segment_rows, md_compare_rows};

static const md_row *row_of(const char *name)
{
    for (size_t g = 0; g < sizeof groups / sizeof *groups; g++) {
        for (const md_row *row = groups[g]; row->name != NULL; row++) {
            if (strcmp(row->name, name) == 0) {
                return row;
            }
        }
    }
    return NULL;
}

const char *md_missing(void)
{
    for (size_t i = 0; i < he_op_count(); i++) {
        if (row_of(he_op_at(i)->name) == NULL) {
            return he_op_at(i)->name;
        }
    }
    return NULL;
}

static void choose(md_call *c, const char *name)
{
    for (c->row = 0; strcmp(he_op_at(c->row)->name, name) != 0; c->row++) {
    }
    c->op = he_op_at(c->row);
}

bool md_draw(md_call *c, const or_mesh *o, const he_mesh *m, md_random *r, bool far, bool room)
{
    md_draft d = {c, o, m, r, far};
    c->row = md_below(r, (uint32_t)he_op_count());
    c->op = he_op_at(c->row);
    if (he_mesh_faces(m) > 0 && he_mesh_boundary_halfedges(m) == 0 && md_chance(r, 10)) {
        /* The operation `dual` is preferred on closed meshes, because these are rare and other
         * edits soon open them. */
        choose(c, "dual");
    }
    he_op_defaults(c->op, c->args);
    const md_row *row = row_of(c->op->name);
    /* If a mesh has few faces, operations that make it smaller are mostly skipped. */
    if (row->growth < 0 && he_mesh_faces(m) < 8 && md_chance(r, 60)) {
        return false;
    }
    return (room || row->growth <= 0) && (!far || row->far) && row->draw(&d);
}

uint64_t md_play(const md_call *c, or_mesh *o, const he_mesh *m)
{
    return row_of(c->op->name)->play(c, o, m);
}

bool md_follow(const md_call *c, or_mesh *o, const he_results *results, char text[OR_TEXT])
{
    const md_row *row = row_of(c->op->name);
    return row->follow == NULL || row->follow(c, o, results, text);
}
