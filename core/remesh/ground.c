#include "remesh/ground.h"

/* A walk consists of a few calls, whose arguments and results are points: passing these in memory
 * takes as long as computing them. */
#define ALWAYS_INLINE inline __attribute__((always_inline))

/* The part of a triangle in which its nearest point lies: inside, on edge i, or at corner i. */
enum { INSIDE, ON_EDGE = 1, AT_CORNER = 4 };

static double share(double part, double whole)
{
    return whole > 0 ? part / whole : 0;
}

static void set_weights(double weight[3], double a, double b, double c)
{
    weight[0] = a;
    weight[1] = b;
    weight[2] = c;
}

/* Finds the point of a triangle that is nearest to p, by the regions of C. Ericson, "Real-Time
 * Collision Detection", 2005, 5.1.5. Returns the part of the triangle in which it lies. */
static ALWAYS_INLINE unsigned nearest(const he_vec3 corner[3], he_vec3 p, double weight[3])
{
    he_vec3 ab = he_vec3_sub(corner[1], corner[0]), ac = he_vec3_sub(corner[2], corner[0]);
    he_vec3 ap = he_vec3_sub(p, corner[0]);
    double d1 = he_vec3_dot(ab, ap), d2 = he_vec3_dot(ac, ap);
    if (d1 <= 0 && d2 <= 0) {
        set_weights(weight, 1, 0, 0);
        return AT_CORNER;
    }
    he_vec3 bp = he_vec3_sub(p, corner[1]);
    double d3 = he_vec3_dot(ab, bp), d4 = he_vec3_dot(ac, bp);
    if (d3 >= 0 && d4 <= d3) {
        set_weights(weight, 0, 1, 0);
        return AT_CORNER + 1;
    }
    double c = d1 * d4 - d3 * d2;
    if (c <= 0 && d1 >= 0 && d3 <= 0) {
        double t = share(d1, d1 - d3);
        set_weights(weight, 1 - t, t, 0);
        return ON_EDGE;
    }
    he_vec3 cp = he_vec3_sub(p, corner[2]);
    double d5 = he_vec3_dot(ab, cp), d6 = he_vec3_dot(ac, cp);
    if (d6 >= 0 && d5 <= d6) {
        set_weights(weight, 0, 0, 1);
        return AT_CORNER + 2;
    }
    double b = d5 * d2 - d1 * d6;
    if (b <= 0 && d2 >= 0 && d6 <= 0) {
        double t = share(d2, d2 - d6);
        set_weights(weight, 1 - t, 0, t);
        return ON_EDGE + 2;
    }
    double a = d3 * d6 - d5 * d4;
    if (a <= 0 && d4 >= d3 && d5 >= d6) {
        double t = share(d4 - d3, (d4 - d3) + (d5 - d6));
        set_weights(weight, 0, 1 - t, t);
        return ON_EDGE + 1;
    }
    double sum = a + b + c;
    /* Rounding may put the weights of a thin triangle outside their range. */
    b = share(b, sum);
    c = share(c, sum);
    b = b < 1 ? b : 1;
    c = c < 1 - b ? c : 1 - b;
    set_weights(weight, 1 - b - c, b, c);
    return INSIDE;
}

/* Finds the nearest point of one triangle. Returns the part in which it lies. */
static ALWAYS_INLINE unsigned try_triangle(const he_ground *g, uint32_t t, he_vec3 place,
                                           he_ground_point *out)
{
    const uint32_t *v = g->triangles[t].v;
    const he_vec3 corner[3] = {g->place[v[0]], g->place[v[1]], g->place[v[2]]};
    unsigned part = nearest(corner, place, out->weight);
    out->triangle = t;
    out->place = he_vec3_add(he_vec3_add(he_vec3_scale(corner[0], out->weight[0]),
                                         he_vec3_scale(corner[1], out->weight[1])),
                             he_vec3_scale(corner[2], out->weight[2]));
    he_vec3 way = he_vec3_sub(place, out->place);
    out->square = he_vec3_dot(way, way);
    return part;
}

void he_ground_nearest(const he_ground *g, he_vec3 place, uint32_t triangle, he_ground_point *out)
{
    (void)try_triangle(g, triangle, place, out);
}

/* The most triangles around a corner that a step of the walk looks at. */
enum { LOOKS = 32 };

/* Returns the twin of a corner; HE_NONE if there is none, or if the edge is held and `held` is
 * false. */
static uint32_t across(const he_ground *g, uint32_t c, bool held)
{
    if (!held && g->held != NULL && (g->held[c >> 2] >> (c & 3) & 1) != 0) {
        return HE_NONE;
    }
    return g->triangles[c >> 2].twin[c & 3];
}

static uint32_t turn(const he_ground *g, uint32_t c, bool ccw, bool held)
{
    if (ccw) {
        return across(g, he_net_prev(c), held);
    }
    uint32_t twin = across(g, c, held);
    return twin == HE_NONE ? HE_NONE : he_net_next(twin);
}

/* Looks for a triangle around the origin of corner c that is nearer than `best`. Returns the part
 * of it in which the nearest point lies; INSIDE if there is no such triangle. */
static unsigned step_around(const he_ground *g, uint32_t c, he_vec3 place, bool held,
                            he_ground_point *best)
{
    unsigned found = INSIDE;
    uint32_t looks = 0;
    for (unsigned ccw = 0; ccw < 2; ccw++) {
        uint32_t at = turn(g, c, ccw != 0, held);
        for (; at != HE_NONE && at != c && looks < LOOKS; at = turn(g, at, ccw != 0, held)) {
            he_ground_point point;
            unsigned part = try_triangle(g, at >> 2, place, &point);
            looks++;
            if (point.square < best->square) {
                *best = point;
                found = part;
            }
        }
        if (at == c) {
            break;
        }
    }
    return found;
}

/* Walks, across edges that are held only if `held` is true. */
static inline void walk(const he_ground *g, he_vec3 place, uint32_t from, bool held,
                        he_ground_point *out)
{
    unsigned part = try_triangle(g, from, place, out);
    for (unsigned steps = 0; part != INSIDE && steps < HE_GROUND_STEPS; steps++) {
        if (part >= AT_CORNER) {
            part = step_around(g, 4 * out->triangle + (part - AT_CORNER), place, held, out);
            continue;
        }
        uint32_t twin = across(g, 4 * out->triangle + (part - ON_EDGE), held);
        he_ground_point point;
        if (twin == HE_NONE) {
            return;
        }
        part = try_triangle(g, twin >> 2, place, &point);
        if (!(point.square < out->square)) {
            return;
        }
        *out = point;
    }
}

void he_ground_walk(const he_ground *g, he_vec3 place, uint32_t from, he_ground_point *out)
{
    walk(g, place, from, true, out);
}

void he_ground_walk_beside(const he_ground *g, he_vec3 place, uint32_t from, he_ground_point *out)
{
    walk(g, place, from, false, out);
}

he_status he_ground_copy(const he_net *n, bool sizes, he_ground *out, he_error *err)
{
    he_ground g = {.triangle_count = n->triangle_count, .vertex_count = n->vertex_count};
    g.triangles = he_mem_array(NULL, (size_t)n->triangle_count + 1, sizeof *g.triangles);
    g.place = he_mem_array(NULL, (size_t)n->vertex_count + 1, sizeof *g.place);
    g.face = he_mem_array(NULL, (size_t)n->triangle_count + 1, sizeof *g.face);
    g.vertex = he_mem_array(NULL, (size_t)n->vertex_count + 1, sizeof *g.vertex);
    g.size = sizes ? he_mem_array(NULL, (size_t)n->vertex_count + 1, sizeof *g.size) : NULL;
    const bool held = n->line != NULL;
    g.held = held ? he_mem_array(NULL, (size_t)n->triangle_count + 1, sizeof *g.held) : NULL;
    if (g.triangles == NULL || g.place == NULL || g.face == NULL || g.vertex == NULL ||
        (sizes && g.size == NULL) || (held && g.held == NULL)) {
        he_ground_clear(&g);
        return he_fail_plain(err, HE_NO_MEMORY, "no memory for a copy of %u triangles",
                             n->triangle_count);
    }
    for (uint32_t t = 0; t < n->triangle_count; t++) {
        for (unsigned i = 0; i < 3; i++) {
            g.triangles[t].v[i] = n->triangles[t].v[i];
            g.triangles[t].twin[i] = n->triangles[t].twin[i];
        }
        g.face[t] = n->ids[t].face;
        if (held) {
            g.held[t] = n->triangles[t].marks & (7 * HE_NET_HELD);
        }
    }
    for (uint32_t v = 0; v < n->vertex_count; v++) {
        g.place[v] = n->vertices[v].p;
        g.vertex[v] = n->vertex_id[v];
        if (sizes) {
            g.size[v] = n->vertices[v].size;
        }
    }
    *out = g;
    return HE_OK;
}

void he_ground_clear(he_ground *g)
{
    he_mem_free(g->triangles);
    he_mem_free(g->place);
    he_mem_free(g->size);
    he_mem_free(g->face);
    he_mem_free(g->vertex);
    he_mem_free(g->held);
    *g = (he_ground){.triangles = NULL};
}
