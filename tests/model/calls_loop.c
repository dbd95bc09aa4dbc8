#include "edit/border/hole.h"
#include "edit/local/erase.h"
#include "edit/plane/plane_split.h"
#include "mesh/walk.h"
#include "model/marks.h"
#include "model/rows.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* Finds the origins of the half-edges along the loop of the half-edge h; returns 0 if h is not live
 * or its loop is too long. */
static uint32_t loop_of(const he_mesh *m, uint32_t h, uint32_t loop[OR_CORNERS])
{
    if (h >= he_mesh_issued(m, HE_HALFEDGE) || !he_mesh_is_live(m, HE_HALFEDGE, h)) {
        return 0;
    }
    return md_hole(m, h, loop);
}

static bool is_too_long(const he_mesh *m, uint32_t h)
{
    uint32_t loop[OR_CORNERS];
    bool lives = h < he_mesh_issued(m, HE_HALFEDGE) && he_mesh_is_live(m, HE_HALFEDGE, h);
    uint32_t n = loop_of(m, h, loop);
    return lives && n == 0;
}

static bool on_one_loop(const he_mesh *m, uint32_t a, uint32_t b)
{
    he_halfedge h = {a};
    do {
        if (h.i == b) {
            return true;
        }
        h = he_next(m, h);
    } while (h.i != a);
    return false;
}

static bool meet(const he_mesh *m, uint32_t a, uint32_t b)
{
    uint32_t x[OR_CORNERS];
    uint32_t y[OR_CORNERS];
    uint32_t n = loop_of(m, a, x);
    uint32_t k = loop_of(m, b, y);
    for (uint32_t i = 0; i < n; i++) {
        for (uint32_t j = 0; j < k; j++) {
            if (x[i] == y[j]) {
                return true;
            }
        }
    }
    return false;
}

/* --- loop_bridge --- */

static bool draw_loop_bridge(md_draft *d)
{
    uint32_t a = md_chance(d->r, 95) ? md_boundary_halfedge(d) : md_pick(d, HE_HALFEDGE);
    uint32_t b = md_pick(d, HE_HALFEDGE);
    if (md_chance(d->r, 92) && md_is_live_boundary(d->m, a)) {
        b = md_boundary_halfedge(d);
        for (int tries = 0; tries < 20 && (on_one_loop(d->m, a, b) || meet(d->m, a, b)); tries++) {
            b = md_boundary_halfedge(d);
        }
        /* In most meshes there is only one hole, so two half-edges of one loop are mostly rejected,
         * to try again. */
        if (on_one_loop(d->m, a, b) && md_chance(d->r, 80)) {
            return false;
        }
    }
    md_give_id(d, "a", a);
    md_give_id(d, "b", b);
    return !is_too_long(d->m, a) && !is_too_long(d->m, b);
}

static uint64_t play_loop_bridge(const md_call *c, or_mesh *o, const he_mesh *m)
{
    uint32_t a = md_get(c, "a")->id;
    uint32_t b = md_get(c, "b")->id;
    uint32_t x[OR_CORNERS];
    uint32_t y[OR_CORNERS];
    uint64_t refused = or_require(o, HE_HALFEDGE, a);
    if (refused == 0 && !md_is_live_boundary(m, a)) {
        refused |= OR_BIT(HE_NOT_BOUNDARY);
    }
    refused |= or_require(o, HE_HALFEDGE, b);
    if (refused != 0) {
        return refused;
    }
    if (!md_is_live_boundary(m, b)) {
        return OR_BIT(HE_NOT_BOUNDARY);
    }
    if (on_one_loop(m, a, b)) {
        return OR_BIT(HE_SAME_LOOP);
    }
    uint32_t n = loop_of(m, a, x);
    uint32_t k = loop_of(m, b, y);
    return or_loop_bridge(o, x, n, y, k);
}

/* --- loop_join --- */

static bool draw_loop_join(md_draft *d)
{
    uint32_t x[OR_CORNERS];
    uint32_t y[OR_CORNERS];
    uint32_t a = md_chance(d->r, 30) ? md_boundary_halfedge(d) : md_pick(d, HE_HALFEDGE);
    uint32_t b = md_pick(d, HE_HALFEDGE);
    uint32_t n = loop_of(d->m, a, x);
    bool apart = md_chance(d->r, 85);
    for (int tries = 0; n > 0 && tries < 60; tries++) {
        uint32_t h = md_live(d, HE_HALFEDGE);
        if (loop_of(d->m, h, y) == n && !on_one_loop(d->m, a, h) && !(apart && meet(d->m, a, h))) {
            b = h;
            break;
        }
    }
    md_give_id(d, "a", a);
    md_give_id(d, "b", b);
    return !is_too_long(d->m, a) && !is_too_long(d->m, b);
}

static uint64_t play_loop_join(const md_call *c, or_mesh *o, const he_mesh *m)
{
    uint32_t a = md_get(c, "a")->id;
    uint32_t b = md_get(c, "b")->id;
    uint32_t x[OR_CORNERS];
    uint32_t y[OR_CORNERS];
    uint32_t against[OR_CORNERS];
    uint64_t refused = or_require(o, HE_HALFEDGE, a) | or_require(o, HE_HALFEDGE, b);
    if (refused != 0) {
        return refused;
    }
    uint32_t n = loop_of(m, a, x);
    uint32_t k = loop_of(m, b, y);
    if (on_one_loop(m, a, b)) {
        return OR_BIT(HE_SAME_LOOP);
    }
    if (n != k) {
        return OR_BIT(HE_LOOP_LENGTH);
    }
    /* The second loop begins with the side from y[0] to y[1], which is joined to the side from x[0]
     * to x[1] of the first loop: the two loops must run in opposite directions. */
    for (uint32_t i = 0; i < n; i++) {
        against[i] = y[(n + 1 - i) % n];
    }
    return or_loop_join(o, (or_loop){x, n, o->left[x[0]][x[1]]},
                        (or_loop){against, n, o->left[y[0]][y[1]]});
}

/* --- loop_split --- */

/* Finds three vertices, each adjacent to both others, that are not the corners of one face, where
 * the mesh can be split; returns their edges in `e`, or false if none are found. */
static bool find_neck(md_draft *d, uint32_t e[3])
{
    const or_mesh *o = d->o;
    for (int tries = 0; tries < 40; tries++) {
        e[0] = md_live(d, HE_EDGE);
        if (or_require(o, HE_EDGE, e[0]) != 0) {
            return false;
        }
        uint32_t u = o->edge[e[0]].a;
        uint32_t v = o->edge[e[0]].b;
        for (uint32_t w = 0; w < o->vertices; w++) {
            if (o->joined[u][w] != OR_NONE && o->joined[v][w] != OR_NONE &&
                o->left[u][v] != OR_NONE && o->left[u][v] != o->left[v][w] &&
                o->left[v][u] != o->left[w][v]) {
                e[1] = o->joined[v][w];
                e[2] = o->joined[u][w];
                return true;
            }
        }
    }
    return false;
}

static bool draw_loop_split(md_draft *d)
{
    uint32_t e[3];
    for (int i = 0; i < 3; i++) {
        e[i] = md_pick(d, HE_EDGE);
    }
    if (md_chance(d->r, 92) && !find_neck(d, e) && md_chance(d->r, 90)) {
        return false;
    }
    if (md_chance(d->r, 4)) {
        e[md_below(d->r, 3)] = md_pick(d, HE_EDGE);
    }
    uint32_t turn = md_below(d->r, 3);
    bool back = md_chance(d->r, 50);
    static const char *const names[] = {"a", "b", "c"};
    for (uint32_t i = 0; i < 3; i++) {
        md_give_id(d, names[i], e[(turn + (back ? 3 - i : i)) % 3]);
    }
    return true;
}

static uint64_t play_loop_split(const md_call *c, or_mesh *o, const he_mesh *m)
{
    (void)m;
    const uint32_t e[3] = {md_get(c, "a")->id, md_get(c, "b")->id, md_get(c, "c")->id};
    uint64_t refused = 0;
    for (int i = 0; i < 3; i++) {
        refused |= or_require(o, HE_EDGE, e[i]);
    }
    return refused != 0 ? refused : or_loop_split(o, e);
}

/* --- plane_cut --- */

static double height(const or_plane *plane, he_vec3 p)
{
    return (p.x - plane->point.x) * plane->normal.x + (p.y - plane->point.y) * plane->normal.y +
           (p.z - plane->point.z) * plane->normal.z;
}

/* Returns whether the plane meets two edges or corners of a face at almost the same point, so that
 * the part between them is a sliver and rounding decides on which side it lies. */
static bool is_sliver(const or_mesh *o, const or_plane *plane, const or_face *face)
{
    static he_vec3 met[2 * OR_CORNERS];
    const double length =
        sqrt(plane->normal.x * plane->normal.x + plane->normal.y * plane->normal.y +
             plane->normal.z * plane->normal.z);
    const double within = (plane->tolerance == NULL ? 0 : *plane->tolerance) + 1e-6;
    uint32_t count = 0;
    for (uint32_t i = 0; i < face->count && face->alive; i++) {
        const he_vec3 p = o->vertex[face->v[i]].at, q = o->vertex[or_after(face, face->v[i])].at;
        const double a = height(plane, p), b = height(plane, q);
        if (fabs(a) < within * length) {
            met[count++] = p;
        } else if (a * b < 0 && fabs(b) >= within * length) {
            const double t = a / (a - b);
            met[count++] =
                (he_vec3){p.x + t * (q.x - p.x), p.y + t * (q.y - p.y), p.z + t * (q.z - p.z)};
        }
    }
    for (uint32_t i = 0; i < count; i++) {
        for (uint32_t k = 0; k < i; k++) {
            if (fabs(met[i].x - met[k].x) + fabs(met[i].y - met[k].y) + fabs(met[i].z - met[k].z) <
                1e-6) {
                return true;
            }
        }
    }
    return false;
}

/* Returns whether some face is so nearly in the plane, or its part there is so small, that rounding
 * decides on which side it lies. */
static bool is_doubtful(const or_mesh *o, const or_plane *plane)
{
    he_vec3 point = plane->point;
    he_vec3 normal = plane->normal;
    double within = plane->tolerance == NULL ? 0 : *plane->tolerance;
    double length = sqrt(normal.x * normal.x + normal.y * normal.y + normal.z * normal.z);
    for (uint32_t f = 0; f < o->faces; f++) {
        const or_face *face = &o->face[f];
        double furthest = 0;
        double up = 0;
        for (uint32_t i = 0; i < face->count && face->alive; i++) {
            he_vec3 p = o->vertex[face->v[i]].at;
            he_vec3 q = o->vertex[face->v[(i + 1) % face->count]].at;
            furthest = fmax(furthest, fabs((p.x - point.x) * normal.x + (p.y - point.y) * normal.y +
                                           (p.z - point.z) * normal.z));
            up += normal.x * (p.y * q.z - p.z * q.y) + normal.y * (p.z * q.x - p.x * q.z) +
                  normal.z * (p.x * q.y - p.y * q.x);
        }
        if (face->alive && ((furthest < (within + 1e-6) * length && fabs(up) < 1e-6 * length) ||
                            is_sliver(o, plane, face))) {
            return true;
        }
    }
    return false;
}

static bool draw_plane_cut(md_draft *d)
{
    md_give_plane(d);
    if (md_chance(d->r, 70)) {
        he_arg *keep = &d->c->args[md_index(d->c, "keep")];
        keep->given = true;
        keep->choice = (int)md_below(d->r, 2);
    }
    md_give_flag(d, "cap", md_chance(d->r, 60));
    if (md_chance(d->r, 30)) {
        md_give_number(d, "tolerance", md_chance(d->r, 5) ? -1 : md_unit(d->r) * 0.5);
    }
    const or_plane plane = md_plane(d->c);
    if (plane.normal.x == 0 && plane.normal.y == 0 && plane.normal.z == 0) {
        return true;
    }
    or_plane_size size = or_plane_measure(d->o, &plane);
    return !size.doubtful && !is_doubtful(d->o, &plane) && size.crossed < OR_CORNERS / 2 &&
           d->o->vertices + size.crossed < OR_VERTICES &&
           d->o->edges + 3 * size.crossed + size.cut < OR_EDGES &&
           d->o->faces + 2 * size.crossed + size.cut < OR_FACES && size.cut < OR_LIST &&
           size.longest < OR_CORNERS;
}

/* plane_cut consists of steps that are operations by themselves. hedge runs each step on a copy of
 * the mesh, from which the test takes the ids and the links of holes, and the oracle runs the step,
 * too. Which elements the plane cuts is found here, without hedge. */
typedef struct cutting {
    or_mesh *o;
    he_mesh *copy;
    or_plane plane;
    bool above;
    uint32_t gone[OR_FACES], count;
    uint32_t rim[OR_FACES], rims;
} cutting;

static void follow(const cutting *c, bool done, const char *what)
{
    char text[OR_TEXT] = "";
    if (!done || !or_adopt(c->o, c->copy, text)) {
        (void)fprintf(stderr, "plane_cut: %s of the copy differs: %s\n", what, text);
        abort();
    }
}

static uint64_t cut_faces(cutting *c)
{
    uint32_t start[OR_FACES];
    for (uint32_t f = 0; f < c->o->faces; f++) {
        start[f] = c->o->face[f].alive
                       ? he_origin(c->copy, he_face_halfedge(c->copy, (he_face){f})).i
                       : OR_NONE;
    }
    uint64_t refused = or_plane_split(c->o, &c->plane, NULL, 0, start);
    if (refused != 0) {
        return refused;
    }
    const he_plane plane = {c->plane.point, c->plane.normal, c->plane.tolerance};
    he_status status = he_plane_split(c->copy, &plane, NULL, 0, NULL, NULL);
    if (status == HE_DOUBLED_EDGE && (c->o->may & OR_BIT(HE_DOUBLED_EDGE)) != 0) {
        return OR_BIT(HE_DOUBLED_EDGE);
    }
    follow(c, status == HE_OK, "plane_split");
    md_read_marks(c->o, c->copy);
    return 0;
}

static uint64_t delete_side(cutting *c)
{
    or_mesh *o = c->o;
    for (uint32_t f = 0; f < o->faces; f++) {
        if (o->face[f].alive && or_face_is_above(o, f, c->plane.normal) != c->above) {
            c->gone[c->count++] = f;
        }
    }
    for (uint32_t e = 0; e < o->edges; e++) {
        uint32_t f = o->edge[e].alive ? o->left[o->edge[e].a][o->edge[e].b] : OR_NONE;
        uint32_t g = o->edge[e].alive ? o->left[o->edge[e].b][o->edge[e].a] : OR_NONE;
        if (f != OR_NONE && g != OR_NONE &&
            or_face_is_above(o, f, c->plane.normal) != or_face_is_above(o, g, c->plane.normal)) {
            c->rim[c->rims++] = 2 * e + (or_face_is_above(o, f, c->plane.normal) == c->above);
        }
    }
    uint64_t refused = or_face_delete(o, c->gone, c->count, false);
    for (uint32_t v = 0; v < o->vertices; v++) {
        bool above = o->distance[v] > 0;
        bool away = o->distance[v] != 0 && above != c->above;
        if (refused != 0 || !o->vertex[v].alive || !away) {
            continue;
        }
        /* After the cut each face lies on one side of the plane, so all faces at this vertex are
         * deleted. */
        refused |= or_vertex_delete(o, v, false);
        if (refused == 0 && he_mesh_is_live(c->copy, HE_VERTEX, v) &&
            he_is_isolated(c->copy, (he_vertex){v})) {
            refused |= he_vertex_delete(c->copy, (he_vertex){v}, HE_DROP_ISOLATED, NULL) != HE_OK;
        }
    }
    if (refused == 0) {
        follow(c, he_face_delete(c->copy, c->gone, c->count, HE_DROP_ISOLATED, NULL) == HE_OK,
               "face_delete");
    }
    return refused;
}

static uint64_t cap_loops(const cutting *c)
{
    uint64_t refused = 0;
    for (uint32_t i = 0; i < c->rims && refused == 0; i++) {
        he_halfedge h = {c->rim[i]};
        uint32_t loop[OR_CORNERS];
        if (!he_is_boundary_halfedge(c->copy, h)) {
            continue;
        }
        do {
            refused |= c->o->distance[he_origin(c->copy, h).i] != 0 ? OR_BIT(HE_OPEN_LOOP) : 0;
            h = he_next(c->copy, h);
        } while (h.i != c->rim[i]);
        if (refused != 0) {
            return refused;
        }
        uint32_t n = md_hole(c->copy, h.i, loop);
        assert(n > 0);
        refused = or_hole_fill(c->o, loop, n, OR_POLYGON);
        if (refused == 0) {
            follow(c, he_hole_fill(c->copy, h, HE_FILL_POLYGON, NULL, NULL) == HE_OK, "hole_fill");
        }
    }
    return refused;
}

static uint64_t play_plane_cut(const md_call *call, or_mesh *o, const he_mesh *m)
{
    cutting c = {.o = o, .count = 0};
    or_lists *before = or_save(o);
    he_status status = he_mesh_copy(m, &c.copy, NULL);
    assert(status == HE_OK);
    (void)status;
    c.plane = md_plane(call);
    c.above = md_get(call, "keep")->choice == 0;
    uint64_t refused = cut_faces(&c);
    if (refused == 0) {
        refused = delete_side(&c);
    }
    if (refused == 0 && md_get(call, "cap")->flag) {
        refused = cap_loops(&c);
    }
    if (refused != 0) {
        or_restore(o, before);
    } else {
        or_forget(before);
    }
    he_mesh_free(c.copy);
    return refused;
}

const md_row md_loop_rows[] = {
    {"loop_bridge", 1, draw_loop_bridge, play_loop_bridge, NULL, false},
    {"loop_join", -1, draw_loop_join, play_loop_join, NULL, false},
    {"loop_split", 1, draw_loop_split, play_loop_split, NULL, false},
    {"plane_cut", -1, draw_plane_cut, play_plane_cut, NULL, false},
    {.name = NULL},
};
