/* remesh_relax.c - moves vertices along the surface, so that triangles become even. */
#include "remesh/net_make.h"
#include "remesh/remeshing.h"

/* A vertex may not move if a triangle then has a roundness below both this and the least roundness
 * around the vertex before. */
static const double LEAST_ROUND = 0.3;
/* The step towards the middle of the faces around a vertex is this many times as long: that way
 * fewer steps are needed. */
static const double OVER = 1.3;
/* Moves that are shorter than this fraction of the wanted length are not made. */
static const double LEAST_MOVE = 0.01;
/* A move that is longer than this fraction makes the vertices around it restless. */
static const double STIR = 0.05;

/* The surroundings of a vertex: positions of its neighbours, and facts about the faces between
 * them. */
typedef struct around {
    he_net_ring ring;
    he_vec3 at[HE_NET_HUB + 2];   /* the first one again after the last, if the fan is closed */
    he_vec3 area[HE_NET_HUB + 1]; /* area vector of each face */
    he_vec3 normal;               /* sum of the area vectors */
    he_vec3 middle;               /* mean of the faces' centroids, weighed by area and size */
    he_roundness worst;           /* the least roundness */
    /* The line, if the vertex is inside one, else HE_NONE; where the two neighbours on the line are
     * on it, and the wanted lengths there. */
    uint32_t line;
    double line_arc[2], line_size[2];
} around;

/* Finds the neighbours of a vertex on its line. */
static void find_line(const he_net *n, const he_net_ring *ring, around *out)
{
    unsigned found = 0;
    uint32_t line = HE_NONE;
    for (uint32_t i = 0; i < ring->count && found < 2; i++) {
        uint32_t c = i < ring->corners ? ring->corner[i] : he_net_prev(ring->corner[i - 1]);
        if (he_net_is_held(n, c)) {
            line = he_net_line_of(n, c);
            out->line_arc[found] = he_net_line_arc(n, line, ring->vertex[i]);
            out->line_size[found++] = (double)n->vertices[ring->vertex[i]].size;
        }
    }
    out->line = found == 2 ? line : HE_NONE;
}

/* Adds a face of the surroundings, between the neighbours i and i + 1. Returns its weight. */
static double add_face(around *out, uint32_t i, he_vec3 p, double wanted)
{
    he_vec3 a = he_vec3_sub(out->at[i], p), b = he_vec3_sub(out->at[i + 1], p);
    he_vec3 area = he_vec3_cross(a, b), side = he_vec3_sub(b, a);
    double square = he_vec3_dot(area, area);
    double sum = he_vec3_dot(a, a) + he_vec3_dot(b, b) + he_vec3_dot(side, side);
    he_roundness own = {area, 12 * square, sum > 0 ? sum * sum : 1};
    he_roundness_lower(&out->worst, &own);
    out->area[i] = area;
    out->normal = he_vec3_add(out->normal, area);
    double share = sqrt(square) / (wanted * wanted);
    out->middle = he_vec3_add(out->middle, he_vec3_scale(he_vec3_add(a, b), share));
    return share;
}

/* Collects the surroundings. Returns false if the vertex cannot be walked around. */
static bool gather(const he_net *n, uint32_t v, around *out)
{
    he_net_ring *ring = &out->ring;
    double weight = 0, size = (double)n->vertices[v].size;
    he_vec3 p = he_net_place(n, v);
    double sizes[HE_NET_HUB + 2];
    if (!he_net_turn(n, v, ring)) {
        return false;
    }
    for (uint32_t i = 0; i < ring->count; i++) {
        const he_net_vertex *w = &n->vertices[ring->vertex[i]];
        out->at[i] = w->p;
        sizes[i] = (double)w->size;
    }
    if (ring->corners == ring->count) {
        out->at[ring->count] = out->at[0];
        sizes[ring->count] = sizes[0];
    }
    out->line = HE_NONE;
    if (he_net_has(n, v, HE_NET_LINE)) {
        find_line(n, ring, out);
    }
    out->normal = out->middle = (he_vec3){0, 0, 0};
    out->worst = (he_roundness){.part = 1, .whole = 1};
    for (uint32_t i = 0; i < ring->corners; i++) {
        weight += add_face(out, i, p, size + sizes[i] + sizes[i + 1]);
    }
    double factor = weight > 0 ? 1 / (3 * weight) : 0;
    out->middle = he_vec3_add(p, he_vec3_scale(out->middle, factor));
    return true;
}

/* Returns the roundness below which no face may fall when a vertex is relaxed. */
static double least_round(const around *of)
{
    return he_roundness_is_below(&of->worst, LEAST_ROUND) ? of->worst.part / of->worst.whole
                                                          : LEAST_ROUND;
}

/* Returns true if the vertex may move to a place: no face turns over or gets a roundness below
 * `least`. */
static bool is_good(const around *of, he_vec3 place, double least)
{
    for (uint32_t i = 0; i < of->ring.corners; i++) {
        he_roundness new = he_roundness_of(place, of->at[i], of->at[i + 1]);
        if (he_roundness_is_below(&new, least) || !he_remesh_agree(of->area[i], new.area)) {
            return false;
        }
    }
    return true;
}

static void move(he_remeshing *r, uint32_t v, const around *of, he_vec3 place)
{
    he_net_vertex *at = &r->net.vertices[v];
    double far = sqrt(he_remesh_square(at->p, place)) / (double)at->size;
    r->moved += far;
    for (uint32_t i = 0; i < of->ring.count && far > STIR; i++) {
        r->net.vertices[of->ring.vertex[i]].flags |= HE_NET_RESTLESS;
    }
    at->p = place;
    at->flags |= HE_NET_MOVED;
    at->flags &= (uint8_t)~HE_NET_LOOSE;
}

/* Tries to move a vertex that is not on a line to a place near the surface. */
static bool try_place(he_remeshing *r, uint32_t v, const around *of, he_vec3 place, double least)
{
    he_ground_point point;
    if (r->project || r->ground.size != NULL) {
        he_ground_walk(&r->ground, place, r->net.ground[v], &point);
        place = r->project ? point.place : place;
    }
    if (!is_good(of, place, least)) {
        return false;
    }
    move(r, v, of, place);
    if (r->project || r->ground.size != NULL) {
        r->net.ground[v] = point.triangle;
    }
    if (r->ground.size != NULL) {
        r->net.vertices[v].size = he_ground_size(&r->ground, &point);
    }
    return true;
}

/* Tries to move a vertex that is inside a line to another place of the line. */
static bool try_arc(he_remeshing *r, uint32_t v, const around *of, double arc, double least)
{
    he_net *n = &r->net;
    uint32_t ground;
    he_vec3 place = he_net_line_place(n, of->line, arc, &ground);
    if (!is_good(of, place, least)) {
        return false;
    }
    move(r, v, of, place);
    n->arc[v] = arc;
    n->ground[v] = ground;
    if (r->ground.size != NULL) {
        he_ground_point point;
        he_ground_nearest(&r->ground, place, ground, &point);
        n->vertices[v].size = he_ground_size(&r->ground, &point);
    }
    return true;
}

static void relax_inside(he_remeshing *r, uint32_t v)
{
    const he_net_vertex *at = &r->net.vertices[v];
    around of;
    if (!gather(&r->net, v, &of)) {
        return;
    }
    he_vec3 way = he_vec3_scale(he_vec3_sub(of.middle, at->p), OVER);
    double square = he_vec3_dot(of.normal, of.normal);
    if (square > 0) {
        double up = he_vec3_dot(way, of.normal) / square;
        way = he_vec3_sub(way, he_vec3_scale(of.normal, up));
    }
    double least = LEAST_MOVE * (double)at->size;
    bool loose = r->project && (at->flags & HE_NET_LOOSE) != 0;
    if (!loose && he_vec3_dot(way, way) < least * least) {
        return;
    }
    double worst = least_round(&of);
    if (!try_place(r, v, &of, he_vec3_add(at->p, way), worst) &&
        !try_place(r, v, &of, he_vec3_add(at->p, he_vec3_scale(way, 0.5)), worst) && loose) {
        (void)try_place(r, v, &of, at->p, worst);
    }
}

/* Moves a vertex of a line along it, to the middle between its neighbours on the line. */
static void relax_line(he_remeshing *r, uint32_t v)
{
    const he_net *n = &r->net;
    around of;
    if (!gather(n, v, &of) || of.line == HE_NONE) {
        return;
    }
    double size = (double)n->vertices[v].size;
    double own[2] = {size + of.line_size[0], size + of.line_size[1]};
    double arc = (of.line_arc[0] * own[1] + of.line_arc[1] * own[0]) / (own[0] + own[1]);
    if (fabs(arc - n->arc[v]) >= LEAST_MOVE * size) {
        (void)try_arc(r, v, &of, arc, least_round(&of));
    }
}

he_status he_remesh_relax(he_remeshing *r, he_error *err)
{
    he_net *n = &r->net;
    he_status status = HE_OK;
    for (uint32_t v = 0; v < n->vertex_count && status == HE_OK; v++) {
        uint32_t flags = n->vertices[v].flags;
        status = he_progress_at(r->progress, v + 1, n->vertex_count, err);
        if ((flags & (HE_NET_FIXED | HE_NET_DEAD)) != 0 || (flags & HE_NET_RESTLESS) == 0) {
            continue;
        }
        n->vertices[v].flags &= (uint8_t)~HE_NET_RESTLESS;
        if ((flags & HE_NET_LINE) != 0) {
            relax_line(r, v);
        } else {
            relax_inside(r, v);
        }
    }
    return status;
}

/* --- the least round triangles --- */

/* Triangles whose roundness is below this, which have angles below 33 or above 100 degrees, are
 * improved one by one. */
static const double ROUND = 0.66;

/* Returns the place at which a triangle with this corner and the side from a to b would be
 * regular. */
static he_vec3 regular_place(he_vec3 corner, he_vec3 a, he_vec3 b)
{
    he_vec3 side = he_vec3_sub(b, a), middle = he_vec3_scale(he_vec3_add(a, b), 0.5);
    he_vec3 up = he_vec3_sub(corner, middle);
    double square = he_vec3_dot(side, side);
    if (square > 0) {
        up = he_vec3_sub(up, he_vec3_scale(side, he_vec3_dot(up, side) / square));
    }
    double height = he_vec3_length(up);
    return height > 0 ? he_vec3_add(middle, he_vec3_scale(up, sqrt(0.75 * square) / height))
                      : corner;
}

/* Tries to move the corner c of a triangle so that the least roundness around it rises. Shorter
 * moves are tried after longer ones. */
static bool improve(he_remeshing *r, uint32_t c)
{
    static const double steps[] = {0.6, 0.3, 0.1};
    const he_net *n = &r->net;
    uint32_t v = he_net_origin(n, c);
    around of;
    if (he_net_has(n, v, HE_NET_FIXED) || !gather(n, v, &of)) {
        return false;
    }
    he_vec3 p = he_net_place(n, v);
    he_vec3 to = regular_place(p, he_net_place(n, he_net_target(n, c)),
                               he_net_place(n, he_net_opposite(n, c)));
    double least = of.worst.part / of.worst.whole + 1e-3;
    bool done = false;
    for (unsigned i = 0; i < sizeof steps / sizeof *steps && !done; i++) {
        if (!he_net_has(n, v, HE_NET_LINE)) {
            he_vec3 way = he_vec3_scale(he_vec3_sub(to, p), steps[i]);
            done = try_place(r, v, &of, he_vec3_add(p, way), least);
            continue;
        }
        for (unsigned k = 0; k < 2 && of.line != HE_NONE && !done; k++) {
            double arc = n->arc[v] + 0.5 * steps[i] * (of.line_arc[k] - n->arc[v]);
            done = try_arc(r, v, &of, arc, least);
        }
    }
    return done;
}

/* Returns true if a triangle is to be improved. */
static bool is_bad(const he_net *n, uint32_t t)
{
    const uint32_t *v = n->triangles[t].v;
    he_roundness own =
        he_roundness_of(he_net_place(n, v[0]), he_net_place(n, v[1]), he_net_place(n, v[2]));
    return he_roundness_is_below(&own, ROUND);
}

/* The most sweeps over the triangles that are to be improved. */
enum { SWEEPS = 10 };

he_status he_remesh_round(he_remeshing *r, he_error *err)
{
    const he_net *n = &r->net;
    he_ids bad = {0};
    he_status status = HE_OK;
    bool any = true;
    for (uint32_t t = 0; t < n->triangle_count && status == HE_OK; t++) {
        status = he_progress_at(r->progress, t + 1, n->triangle_count, err);
        if (status == HE_OK && !he_net_is_gone(n, t) && is_bad(n, t)) {
            status = he_ids_add(&bad, t, err);
        }
    }
    for (unsigned sweep = 0; sweep < SWEEPS && any && status == HE_OK; sweep++) {
        any = false;
        for (size_t i = 0; i < bad.count && status == HE_OK; i++) {
            status = he_progress_at(r->progress, i + 1, bad.count, err);
            for (uint32_t c = 4 * bad.ids[i]; c < 4 * bad.ids[i] + 3 && is_bad(n, c >> 2); c++) {
                any |= improve(r, c);
            }
        }
    }
    he_ids_clear(&bad);
    return status;
}
