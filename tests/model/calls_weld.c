#include "model/rows.h"

#include "mesh/walk.h"

#include <math.h>

/* --- merging vertices --- */

/* Draws the two outer ends of two consecutive boundary edges. Merging these vertices makes one edge
 * of the two edges. */
static uint32_t draw_zip(md_draft *d, uint32_t v[2])
{
    he_halfedge h = {md_boundary_halfedge(d)};
    if (!md_is_live_boundary(d->m, h.i)) {
        return 0;
    }
    v[0] = he_origin(d->m, h).i;
    v[1] = he_target(d->m, he_next(d->m, h)).i;
    return v[0] == v[1] ? 0 : 2;
}

static uint32_t draw_edge_ends(md_draft *d, uint32_t v[2])
{
    uint32_t e = md_live(d, HE_EDGE);
    if (or_require(d->o, HE_EDGE, e) != 0) {
        return 0;
    }
    v[0] = d->o->edge[e].a;
    v[1] = d->o->edge[e].b;
    return 2;
}

static uint32_t draw_face_corners(md_draft *d, uint32_t *v)
{
    uint32_t f = md_live(d, HE_FACE);
    if (or_require(d->o, HE_FACE, f) != 0 || d->o->face[f].count > MD_LIST) {
        return 0;
    }
    for (uint32_t i = 0; i < d->o->face[f].count; i++) {
        v[i] = d->o->face[f].v[i];
    }
    return d->o->face[f].count;
}

/* Draws vertices on the boundary; merging them may make bow-ties (vertices with several fans of
 * faces). */
static uint32_t draw_boundary(md_draft *d, uint32_t v[2])
{
    for (uint32_t i = 0; i < 2; i++) {
        he_halfedge h = {md_boundary_halfedge(d)};
        v[i] = md_is_live_boundary(d->m, h.i) ? he_origin(d->m, h).i : md_live(d, HE_VERTEX);
    }
    return v[0] == v[1] ? 0 : 2;
}

/* Returns a tolerance: slightly more than the distance of two vertices, a small value, or 0. */
static double draw_tolerance(md_draft *d)
{
    if (md_chance(d->r, 3)) {
        return -md_unit(d->r) - 1e-3;
    }
    if (md_chance(d->r, 30) || or_live_vertices(d->o) == 0) {
        return 0;
    }
    he_vec3 p = d->o->vertex[md_live(d, HE_VERTEX)].at;
    he_vec3 q = d->o->vertex[md_live(d, HE_VERTEX)].at;
    double x = p.x - q.x;
    double y = p.y - q.y;
    double z = p.z - q.z;
    double apart = sqrt(x * x + y * y + z * z) * 1.001;
    return apart < 0.6 || md_chance(d->r, 10) ? apart : md_unit(d->r) * 0.6;
}

static bool draw_near(md_draft *d)
{
    uint32_t to[OR_VERTICES];
    double tolerance = draw_tolerance(d);
    md_give_number(d, "tolerance", tolerance);
    return tolerance < 0 || or_weld_near(d->o, tolerance, to);
}

static bool draw_vertex_weld(md_draft *d)
{
    uint32_t v[MD_LIST];
    uint32_t n = 0;
    if (md_chance(d->r, 50)) {
        d->c->args[md_index(d->c, "position")].given = true;
        d->c->args[md_index(d->c, "position")].choice = (int)md_below(d->r, 2);
    }
    switch (md_below(d->r, 8)) {
    case 0:
        return draw_near(d);
    case 1:
        (void)md_pick_some(d, "vertex", "vertices", HE_VERTEX, 4);
        return true;
    case 2:
        n = draw_edge_ends(d, v);
        break;
    case 3:
        n = draw_face_corners(d, v);
        break;
    case 4:
    case 5:
        n = draw_boundary(d, v);
        break;
    default:
        n = draw_zip(d, v);
        break;
    }
    if (n > 0) {
        md_give_ids(d, "vertices", v, n, true);
    }
    return n > 0;
}

static uint64_t play_near(const md_call *c, or_mesh *o, bool mean)
{
    uint32_t to[OR_VERTICES];
    double tolerance = md_get(c, "tolerance")->number;
    if (tolerance < 0) {
        return OR_BIT(HE_BAD_VALUE);
    }
    (void)or_weld_near(o, tolerance, to);
    return or_weld(o, to, mean);
}

static uint64_t play_vertex_weld(const md_call *c, or_mesh *o, const he_mesh *m)
{
    (void)m;
    bool mean = md_get(c, "position")->choice == 0;
    const he_arg *v = md_get(c, "vertices");
    if (!v->given) {
        return play_near(c, o, mean);
    }
    uint64_t refused = md_require_all(o, HE_VERTEX, v);
    uint32_t to[OR_VERTICES];
    uint32_t lowest = OR_NONE;
    for (size_t i = 0; i < v->count; i++) {
        lowest = v->ids[i] < lowest ? v->ids[i] : lowest;
    }
    for (uint32_t i = 0; i < OR_VERTICES; i++) {
        to[i] = i;
    }
    for (size_t i = 0; refused == 0 && i < v->count; i++) {
        to[v->ids[i]] = lowest;
    }
    return refused != 0 ? refused : or_weld(o, to, mean);
}

static bool draw_weld(md_draft *d)
{
    return md_chance(d->r, 30) && draw_near(d);
}

static uint64_t play_weld(const md_call *c, or_mesh *o, const he_mesh *m)
{
    (void)m;
    return play_near(c, o, true);
}

/* --- separating bow-ties --- */

static bool draw_vertex_separate(md_draft *d)
{
    uint32_t start = md_below(d->r, d->o->vertices + 1);
    for (uint32_t i = 0; i < d->o->vertices && md_chance(d->r, 97); i++) {
        uint32_t v = (start + i) % d->o->vertices;
        if (d->o->vertex[v].alive && or_fans(d->o, v) > 1) {
            const uint32_t ids[2] = {v, md_pick(d, HE_VERTEX)};
            uint32_t n = ids[1] == v || md_chance(d->r, 70) ? 1 : 2;
            md_give_ids(d, n > 1 ? "vertices" : "vertex", ids, n, n > 1);
            return true;
        }
    }
    (void)md_pick_some(d, "vertex", "vertices", HE_VERTEX, 3);
    return md_chance(d->r, 30);
}

/* Finds the fans of faces that get a new vertex when the vertex v is separated: all fans but the
 * one that ends with the stored half-edge of v. Writes the first neighbour of v in each of these
 * fans. */
static uint32_t leaving(const he_mesh *m, uint32_t v, uint32_t starts[OR_VERTICES])
{
    uint32_t n = 0;
    if (he_vertex_fans(m, (he_vertex){v}) > 1) {
        he_halfedge stored = he_vertex_halfedge(m, (he_vertex){v});
        for (he_halfedge h = stored; n == 0 || h.i != stored.i; h = he_swing_ccw(m, h)) {
            if (he_is_boundary_halfedge(m, h)) {
                starts[n++] = he_target(m, he_swing_ccw(m, h)).i;
            }
        }
        n--;
    }
    return n;
}

static uint64_t separate(or_mesh *o, const he_mesh *m, const uint32_t *v, size_t count)
{
    uint64_t refused = 0;
    uint32_t starts[OR_VERTICES];
    for (size_t i = 0; i < count; i++) {
        refused |= or_check_separate(o, v[i], starts, leaving(m, v[i], starts));
    }
    for (size_t i = 0; i < count && refused == 0; i++) {
        uint32_t n = leaving(m, v[i], starts);
        /* An earlier vertex in the list may have been separated already, so a neighbour at which a
         * fan begins may have been replaced by a new vertex. */
        for (uint32_t k = 0; k < n; k++) {
            he_halfedge h = he_find_halfedge(m, (he_vertex){v[i]}, (he_vertex){starts[k]});
            const or_edge *e = &o->edge[h.i / 2];
            starts[k] = h.i % 2 == 0 ? e->b : e->a;
        }
        or_separate(o, v[i], starts, n);
    }
    return refused;
}

static uint64_t play_vertex_separate(const md_call *c, or_mesh *o, const he_mesh *m)
{
    const he_arg *v = md_get(c, "vertex");
    uint64_t refused = md_require_all(o, HE_VERTEX, v);
    return refused != 0 ? refused : separate(o, m, v->ids, v->count);
}

static bool draw_seldom(md_draft *d)
{
    return md_chance(d->r, 15);
}

static uint64_t play_separate_bowties(const md_call *c, or_mesh *o, const he_mesh *m)
{
    (void)c;
    uint32_t all[OR_VERTICES];
    size_t n = 0;
    for (uint32_t v = 0; v < o->vertices; v++) {
        if (o->vertex[v].alive) {
            all[n++] = v;
        }
    }
    return separate(o, m, all, n);
}

static uint64_t play_delete_isolated(const md_call *c, or_mesh *o, const he_mesh *m)
{
    (void)c;
    (void)m;
    return or_delete_isolated(o);
}

const md_row md_weld_rows[] = {
    {"vertex_weld", -1, draw_vertex_weld, play_vertex_weld, NULL, false},
    {"vertex_separate", 1, draw_vertex_separate, play_vertex_separate, NULL, false},
    {"weld", -1, draw_weld, play_weld, NULL, false},
    {"separate_bowties", 1, draw_seldom, play_separate_bowties, NULL, false},
    {"delete_isolated", 0, draw_seldom, play_delete_isolated, NULL, false},
    {.name = NULL},
};
