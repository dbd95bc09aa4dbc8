#include "model/rows.h"

#include "mesh/walk.h"

static bool draw_edge_delete(md_draft *d)
{
    (void)md_pick_some(d, "edge", "edges", HE_EDGE, 3);
    if (md_chance(d->r, 50)) {
        md_give_flag(d, "keep_isolated", md_chance(d->r, 60));
    }
    return true;
}

static uint64_t play_edge_delete(const md_call *c, or_mesh *o, const he_mesh *m)
{
    (void)m;
    const he_arg *e = md_get(c, "edge");
    uint64_t refused = md_require_all(o, HE_EDGE, e);
    return refused != 0
               ? refused
               : or_edge_delete(o, e->ids, (uint32_t)e->count, md_get(c, "keep_isolated")->flag);
}

/* Returns an edge with two faces that has the vertex v as an end, other than the edge `not`;
 * OR_NONE if there is none. */
static uint32_t interior_edge_at(md_draft *d, uint32_t v, uint32_t not )
{
    uint32_t around[OR_VERTICES];
    uint32_t n = or_neighbours(d->o, v, around, OR_VERTICES);
    uint32_t start = n > 0 ? md_below(d->r, n) : 0;
    for (uint32_t i = 0; i < n; i++) {
        uint32_t x = around[(start + i) % n];
        if (d->o->joined[v][x] != not &&d->o->left[v][x] != OR_NONE &&
            d->o->left[x][v] != OR_NONE) {
            return d->o->joined[v][x];
        }
    }
    return OR_NONE;
}

/* Chooses random edges for edge_cut: consecutive edges of a path, or edges anywhere in the mesh. */
static bool draw_edge_cut(md_draft *d)
{
    uint32_t path[5];
    uint32_t n = 0;
    uint32_t e = md_live(d, HE_EDGE);
    if (or_require(d->o, HE_EDGE, e) != 0 || md_chance(d->r, 30)) {
        (void)md_pick_some(d, "edge", "edges", HE_EDGE, 4);
        return true;
    }
    uint32_t v = d->o->edge[e].a;
    uint32_t most = md_from(d->r, 1, 5);
    e = OR_NONE;
    while (n < most) {
        e = interior_edge_at(d, v, e);
        for (uint32_t i = 0; i < n; i++) {
            e = path[i] == e ? OR_NONE : e;
        }
        if (e == OR_NONE) {
            break;
        }
        path[n++] = e;
        v = md_chance(d->r, 20) ? v : d->o->edge[e].a == v ? d->o->edge[e].b : d->o->edge[e].a;
    }
    if (n > 0) {
        bool list = n > 1 || md_chance(d->r, 30);
        md_give_ids(d, list ? "edges" : "edge", path, n, list);
    }
    return n > 0;
}

static uint64_t play_edge_cut(const md_call *c, or_mesh *o, const he_mesh *m)
{
    (void)m;
    const he_arg *e = md_get(c, "edge");
    uint64_t refused = md_require_all(o, HE_EDGE, e);
    return refused != 0 ? refused : or_edge_cut(o, e->ids, (uint32_t)e->count);
}

/* Draws two consecutive edges along a hole, or two random edges. */
static bool draw_edge_weld(md_draft *d)
{
    uint32_t h = md_boundary_halfedge(d);
    uint32_t k = md_boundary_halfedge(d);
    if (md_is_live_boundary(d->m, h) && md_chance(d->r, 50)) {
        k = he_next(d->m, (he_halfedge){h}).i;
    }
    bool turn = md_chance(d->r, 50);
    md_give_id(d, "a", md_chance(d->r, 90) ? (turn ? k : h) / 2 : md_pick(d, HE_EDGE));
    md_give_id(d, "b", md_chance(d->r, 90) ? (turn ? h : k) / 2 : md_pick(d, HE_EDGE));
    if (md_chance(d->r, 60)) {
        he_arg *keep = &d->c->args[md_index(d->c, "keep")];
        keep->given = true;
        keep->choice = (int)md_below(d->r, 3);
    }
    return true;
}

static uint64_t play_edge_weld(const md_call *c, or_mesh *o, const he_mesh *m)
{
    (void)m;
    uint32_t a = md_get(c, "a")->id;
    uint32_t b = md_get(c, "b")->id;
    uint64_t refused = or_require(o, HE_EDGE, a);
    if (refused == 0 && or_require(o, HE_EDGE, b) != 0) {
        const or_edge *e = &o->edge[a];
        bool inside = o->left[e->a][e->b] != OR_NONE && o->left[e->b][e->a] != OR_NONE;
        refused = or_require(o, HE_EDGE, b) | (inside ? OR_BIT(HE_NOT_BOUNDARY) : 0);
    }
    static const or_keep keeps[] = {OR_MEAN, OR_A, OR_B};
    return refused != 0 ? refused : or_edge_weld(o, a, b, keeps[md_get(c, "keep")->choice]);
}

/* Draws a chain of edges along a hole, or random edges. */
static bool draw_edge_extrude(md_draft *d)
{
    uint32_t chain[5];
    uint32_t n = 0;
    uint32_t h = md_boundary_halfedge(d);
    md_give_points(d, "by", 1, false);
    if (!md_is_live_boundary(d->m, h) || md_chance(d->r, 25)) {
        uint32_t most = md_from(d->r, 1, 3);
        (void)md_pick_some(d, "edge", "edges", HE_EDGE, most);
        return true;
    }
    uint32_t most = md_from(d->r, 1, 5);
    he_halfedge k = {h};
    while (n < most && (n == 0 || k.i != h)) {
        chain[n++] = k.i / 2;
        /* The chain goes on along its hole, or sometimes jumps to another one. */
        k = md_chance(d->r, 85) ? he_next(d->m, k) : (he_halfedge){md_boundary_halfedge(d)};
        for (uint32_t i = 1; i < n; i++) {
            most = chain[i] == k.i / 2 ? n : most;
        }
    }
    bool list = n > 1 || md_chance(d->r, 30);
    md_give_ids(d, list ? "edges" : "edge", chain, n, list);
    return true;
}

static uint64_t play_edge_extrude(const md_call *c, or_mesh *o, const he_mesh *m)
{
    (void)m;
    const he_arg *e = md_get(c, "edge");
    uint64_t refused = md_require_all(o, HE_EDGE, e);
    return refused != 0
               ? refused
               : or_edge_extrude(o, e->ids, (uint32_t)e->count, md_get(c, "by")->points[0]);
}

static bool draw_edge_bevel(md_draft *d)
{
    uint32_t e = md_pick(d, HE_EDGE);
    md_give_id(d, "edge", e);
    md_give_number(d, "width", md_chance(d->r, 3) ? -md_unit(d->r) : 0.01 + md_unit(d->r) * 3);
    if (md_chance(d->r, 2)) {
        md_give_number(d, "width", 0);
    }
    if (or_require(d->o, HE_EDGE, e) != 0) {
        return true;
    }
    /* The bevel adds corners to the faces at both ends of the edge, which must fit into the
     * oracle's tables. */
    uint32_t ends[2] = {d->o->edge[e].a, d->o->edge[e].b};
    for (uint32_t f = 0; f < d->o->faces; f++) {
        bool beside = d->o->face[f].alive && (or_place(&d->o->face[f], ends[0]) != OR_NONE ||
                                              or_place(&d->o->face[f], ends[1]) != OR_NONE);
        if (beside && d->o->face[f].count + 2 > OR_CORNERS) {
            return false;
        }
    }
    uint32_t degrees = or_degree(d->o, ends[0]) + or_degree(d->o, ends[1]);
    return d->o->vertices + degrees < OR_VERTICES && degrees < OR_CORNERS;
}

static uint64_t play_edge_bevel(const md_call *c, or_mesh *o, const he_mesh *m)
{
    (void)m;
    uint64_t refused = or_require(o, HE_EDGE, md_get(c, "edge")->id);
    return refused != 0 ? refused
                        : or_edge_bevel(o, md_get(c, "edge")->id, md_get(c, "width")->number);
}

const md_row md_border_rows[] = {
    {"edge_delete", -1, draw_edge_delete, play_edge_delete, NULL, true},
    {"edge_cut", 1, draw_edge_cut, play_edge_cut, NULL, false},
    {"edge_weld", -1, draw_edge_weld, play_edge_weld, NULL, false},
    {"edge_extrude", 1, draw_edge_extrude, play_edge_extrude, NULL, true},
    {"edge_bevel", 1, draw_edge_bevel, play_edge_bevel, NULL, false},
    {.name = NULL},
};
