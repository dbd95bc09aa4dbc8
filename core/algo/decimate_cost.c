/* decimate_cost.c - computes what the collapse of an edge costs, and where the remaining vertex
 * would move. */
#include "algo/decimation.h"

/* How strongly the point to which an edge collapses is pulled to the middle of the edge, relative
 * to the sum of the weights of the planes. The pull makes the point well defined in flat regions
 * and is too weak to matter on curved surfaces. */
static const double PULL = 1e-6;
/* An edge collapses to one of its ends, and not to the best point, only if the cost at this end is
 * lower by more than ROUNDING. So rounding errors do not decide where an edge collapses to. */
static const double ROUNDING = 1e-14;
/* The length of an edge times LENGTH is added to the cost of its collapse, so that of the edges
 * that cost nothing the shortest is collapsed first. */
static const double LENGTH = 1e-9;
/* Priorities of edges are multiplied by WITHIN. Otherwise the priorities in a small part of a large
 * mesh would be too small for a float. */
static const double WITHIN = 0x1p40;
/* An error below NOTHING, relative to the size of the mesh, may be only rounding and counts as
 * zero. */
static const double NOTHING = 1e-12;

/* Returns true if the collapse of an edge may move `vertex`, which is an end of the edge. `along`
 * is true if the edge is a feature. */
static bool may_move(const he_decimation *d, uint32_t vertex, bool along)
{
    const he_node *node = &d->nodes[vertex];
    return (d->flags[vertex] & HE_NODE_LOCKED) == 0 && !he_node_is_hub(node) &&
           (node->features == 0 || (along && node->features == 2));
}

typedef struct ends {
    he_halfedge h; /* half-edge from vertex a to vertex b */
    const he_node *a, *b;
    he_quadric sum; /* sum of the quadrics of a and b, relative to the position of a */
    he_vec3 across; /* vector from a to b */
    bool a_goes, b_goes, a_moves, b_moves;
} ends;

static void take(const ends *e, he_vec3 x, bool a_goes, bool moves, he_candidate *out)
{
    out->h = a_goes ? e->h : he_twin(e->h);
    out->moves = moves;
    out->place = moves ? he_vec3_add(e->a->place, x) : a_goes ? e->b->place : e->a->place;
    out->cost = he_quadric_at(&e->sum, x);
}

/* Finds the point with the lowest cost for the vertex that remains after the collapse. Returns
 * false if there is no such point, or if neither end of the edge may move. */
static bool take_best(const ends *e, he_candidate *out)
{
    bool a_goes = e->a_goes && e->b_moves, b_goes = e->b_goes && e->a_moves;
    he_vec3 x;
    double trace = e->sum.xx + e->sum.yy + e->sum.zz;
    if ((!a_goes && !b_goes) ||
        !he_quadric_least(&e->sum, PULL * trace, he_vec3_scale(e->across, 0.5), &x)) {
        return false;
    }
    /* The collapse deletes the end with fewer edges; if the two ends have equally many edges, the
     * end with the higher id. */
    if (a_goes && b_goes) {
        a_goes = e->a->degree < e->b->degree;
    }
    take(e, x, a_goes, true, out);
    return true;
}

static bool find_place(const ends *e, he_candidate *out)
{
    double length = he_vec3_dot(e->across, e->across);
    double rounding = ROUNDING * e->sum.weight * length;
    bool found = take_best(e, out);
    he_candidate end;
    if (e->a_goes) {
        take(e, e->across, true, false, &end);
        if (!found || end.cost + rounding < out->cost) {
            *out = end;
            found = true;
        }
    }
    if (e->b_goes) {
        take(e, (he_vec3){0, 0, 0}, false, false, &end);
        if (!found || end.cost + rounding < out->cost) {
            *out = end;
            found = true;
        }
    }
    if (found) {
        double weight = e->sum.weight;
        out->error = weight > 0 ? sqrt(out->cost / weight) : 0;
        out->error = out->error > NOTHING ? out->error : 0;
        double dear = out->cost + LENGTH * weight * length;
        out->priority = (float)(weight > 0 ? dear * sqrt(dear / weight) * WITHIN : 0);
    }
    return found;
}

bool he_decimation_cost(const he_decimation *d, he_edge edge, he_candidate *out)
{
    he_halfedge h = he_edge_halfedge(edge, 0);
    uint32_t a = he_origin(d->mesh, h).i, b = he_target(d->mesh, h).i;
    if (a > b) {
        uint32_t swap = a;
        a = b;
        b = swap;
        h = he_twin(h);
    }
    ends e = {.h = h, .a = &d->nodes[a], .b = &d->nodes[b]};
    bool along = d->feature != NULL && *he_column_value(d->feature, edge.i) != 0;
    e.a_moves = may_move(d, a, along);
    e.b_moves = may_move(d, b, along);
    e.a_goes = e.a_moves && (d->flags[a] & HE_NODE_HELD) == 0;
    e.b_goes = e.b_moves && (d->flags[b] & HE_NODE_HELD) == 0;
    if (!e.a_goes && !e.b_goes) {
        return false;
    }
    e.across = he_vec3_sub(e.b->place, e.a->place);
    e.sum = e.b->quadric;
    he_quadric_shift(&e.sum, he_vec3_scale(e.across, -1));
    he_quadric_add(&e.sum, &e.a->quadric);
    return find_place(&e, out);
}
