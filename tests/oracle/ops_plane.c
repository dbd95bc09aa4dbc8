#include "oracle/oracle.h"

#include <assert.h>
#include <math.h>
#include <string.h>

static double dot(he_vec3 a, he_vec3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static bool has_edge(const or_mesh *o, uint32_t v)
{
    bool found = false;
    for (uint32_t e = 0; e < o->edges && !found; e++) {
        found = o->edge[e].alive && (o->edge[e].a == v || o->edge[e].b == v);
    }
    return found;
}

/* Returns hedge's default tolerance, 1e-9 of the longest side of the box around the vertices that
 * have edges. hedge takes a larger one for small meshes far from the origin because of rounding,
 * but the model has no such meshes. */
static double tolerance_of(const or_mesh *o)
{
    he_vec3 low = {INFINITY, INFINITY, INFINITY};
    he_vec3 high = {-INFINITY, -INFINITY, -INFINITY};
    for (uint32_t v = 0; v < o->vertices; v++) {
        if (o->vertex[v].alive && has_edge(o, v)) {
            he_vec3 p = o->vertex[v].at;
            low = (he_vec3){fmin(low.x, p.x), fmin(low.y, p.y), fmin(low.z, p.z)};
            high = (he_vec3){fmax(high.x, p.x), fmax(high.y, p.y), fmax(high.z, p.z)};
        }
    }
    return 1e-9 * fmax(0, fmax(high.x - low.x, fmax(high.y - low.y, high.z - low.z)));
}

/* Finds the distances of all vertices from the plane, 0 if within the tolerance. Returns false if a
 * distance is so close to the tolerance that rounding decides. */
static bool find_distances(const or_mesh *o, const or_plane *plane, double distance[OR_VERTICES])
{
    he_vec3 point = plane->point;
    he_vec3 normal = plane->normal;
    const double extent = tolerance_of(o) / 1e-9;
    double within = plane->tolerance != NULL ? *plane->tolerance : 1e-9 * extent;
    bool clear = true;
    memset(distance, 0, OR_VERTICES * sizeof *distance);
    for (uint32_t v = 0; v < o->vertices; v++) {
        if (o->vertex[v].alive) {
            he_vec3 p = o->vertex[v].at;
            double d = dot((he_vec3){p.x - point.x, p.y - point.y, p.z - point.z}, normal) /
                       sqrt(dot(normal, normal));
            clear = clear && fabs(fabs(d) - within) > 1e-12 * fmax(1, extent);
            distance[v] = fabs(d) <= within ? 0 : d;
        }
    }
    return clear;
}

static bool is_crossed(const double distance[], uint32_t a, uint32_t b)
{
    return (distance[a] < 0 && distance[b] > 0) || (distance[a] > 0 && distance[b] < 0);
}

static bool is_cut(const double distance[], const or_face *f)
{
    bool above = false;
    bool below = false;
    for (uint32_t i = 0; i < f->count; i++) {
        above = above || distance[f->v[i]] > 0;
        below = below || distance[f->v[i]] < 0;
    }
    return above && below;
}

or_plane_size or_plane_measure(const or_mesh *o, const or_plane *plane)
{
    or_plane_size size = {0, 0, 0, false};
    double distance[OR_VERTICES];
    size.doubtful = !find_distances(o, plane, distance);
    /* where the plane meets an edge that is almost parallel to it depends on rounding, too */
    const double least = 1e-6 * tolerance_of(o) / 1e-9;
    for (uint32_t e = 0; e < o->edges; e++) {
        const or_edge *edge = &o->edge[e];
        if (edge->alive && is_crossed(distance, edge->a, edge->b)) {
            size.crossed++;
            size.doubtful |= fabs(distance[edge->a] - distance[edge->b]) < least;
        }
    }
    for (uint32_t f = 0; f < o->faces; f++) {
        const or_face *face = &o->face[f];
        uint32_t corners = face->count;
        if (!face->alive) {
            continue;
        }
        for (uint32_t i = 0; i < face->count; i++) {
            corners += is_crossed(distance, face->v[i], face->v[(i + 1) % face->count]);
        }
        size.cut += is_cut(distance, face);
        size.longest = corners > size.longest ? corners : size.longest;
    }
    return size;
}

/* Finds the points in which the plane meets the sides of a face. A point is a vertex, or lies
 * inside an edge; then the edge stands for the vertex that the cut makes there. */
static uint32_t meetings(const or_mesh *o, const or_face *f, uint32_t out[2 * OR_CORNERS])
{
    uint32_t n = 0;
    for (uint32_t i = 0; i < f->count; i++) {
        uint32_t a = f->v[i];
        uint32_t b = f->v[(i + 1) % f->count];
        if (o->distance[a] == 0) {
            out[n++] = a;
        }
        if (is_crossed(o->distance, a, b)) {
            out[n++] = OR_VERTICES + o->joined[a][b];
        }
    }
    return n;
}

static bool holds(const uint32_t *list, uint32_t n, uint32_t x)
{
    for (uint32_t i = 0; i < n; i++) {
        if (list[i] == x) {
            return true;
        }
    }
    return false;
}

/* Returns whether a diagonal of the cut face i may connect two vertices that an edge, or a diagonal
 * of another cut face, connects already. Sets `*certain` if the plane meets each of these cut faces
 * in only two points, so that no other diagonal is possible. */
static bool can_double(const or_mesh *o, uint32_t i, bool *certain)
{
    const or_face *f = &o->face[o->cut[i].id];
    uint32_t here[2 * OR_CORNERS];
    uint32_t n = meetings(o, f, here);
    bool can = false;
    for (uint32_t x = 0; x < n; x++) {
        for (uint32_t y = 0; y < x; y++) {
            uint32_t a = here[x];
            uint32_t b = here[y];
            bool old = a < OR_VERTICES && b < OR_VERTICES;
            if (old && (or_after(f, a) == b || or_after(f, b) == a)) {
                continue;
            }
            if (old && o->joined[a][b] != OR_NONE) {
                can = true;
                *certain = *certain || n == 2;
            }
            for (uint32_t k = 0; k < i; k++) {
                uint32_t there[2 * OR_CORNERS];
                uint32_t p = meetings(o, &o->face[o->cut[k].id], there);
                if (holds(there, p, a) && holds(there, p, b)) {
                    can = true;
                    *certain = *certain || (n == 2 && p == 2);
                }
            }
        }
    }
    return can;
}

uint64_t or_plane_split(or_mesh *o, const or_plane *plane, const uint32_t *faces, uint32_t count,
                        const uint32_t *start)
{
    if (dot(plane->normal, plane->normal) == 0 ||
        (plane->tolerance != NULL && *plane->tolerance < 0)) {
        return OR_BIT(HE_BAD_VALUE);
    }
    (void)find_distances(o, plane, o->distance);
    for (uint32_t f = 0; f < o->faces; f++) {
        o->chosen[f] = o->face[f].alive && (faces == NULL || holds(faces, count, f));
        if (o->chosen[f] && is_cut(o->distance, &o->face[f])) {
            assert(o->cuts < OR_LIST);
            o->cut[o->cuts].id = f;
            o->cut[o->cuts++].start = start[f];
        }
    }
    bool can = false;
    bool certain = false;
    for (uint32_t i = 0; i < o->cuts; i++) {
        can = can_double(o, i, &certain) || can;
    }
    if (certain) {
        o->cuts = 0;
        return OR_BIT(HE_DOUBLED_EDGE);
    }
    o->may |= can ? OR_BIT(HE_DOUBLED_EDGE) : 0;
    o->by_plane = true;
    return 0;
}

void or_plane_vertices(or_mesh *o)
{
    uint32_t edges = o->edges;
    for (uint32_t e = 0; e < edges; e++) {
        uint32_t a = o->edge[e].a;
        uint32_t b = o->edge[e].b;
        if (!o->edge[e].alive || !is_crossed(o->distance, a, b)) {
            continue;
        }
        uint32_t f = o->left[a][b];
        uint32_t g = o->left[b][a];
        if ((f == OR_NONE || !o->chosen[f]) && (g == OR_NONE || !o->chosen[g])) {
            continue;
        }
        double apart = o->distance[a] - o->distance[b];
        or_vertex *w = &o->vertex[o->vertices];
        (void)or_edge_bisect(o, e, o->distance[a] / apart);
        o->distance[o->vertices - 1] = 0;
        if (fabs(apart) < 1e-4) {
            /* The edge is so nearly parallel to the plane that rounding decides where the new point
             * is. */
            he_vec3 p = o->vertex[a].at;
            he_vec3 q = o->vertex[b].at;
            w->near = false;
            w->inside = true;
            w->low = (he_vec3){fmin(p.x, q.x), fmin(p.y, q.y), fmin(p.z, q.z)};
            w->high = (he_vec3){fmax(p.x, q.x), fmax(p.y, q.y), fmax(p.z, q.z)};
        }
    }
    for (uint32_t i = 0; i < o->cuts; i++) {
        o->cut[i].was = o->face[o->cut[i].id];
    }
}
