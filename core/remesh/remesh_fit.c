/* remesh_fit.c - moves vertices a little off the given surface, so that faces come nearer to it.
 *
 *            ___---o---___            Vertices on a curved surface: all faces lie inside of it, so
 *        _o-               -o_        that the volume shrinks.
 *
 *           __o---------o__           Vertices as far outside as the middles of their edges lay
 *        _o~               ~o_        inside: the faces are on both sides of the surface.
 *
 * Where the surface is curved evenly, the mean distance of a face is the mean of those at the
 * middles of its edges, because these distances are a polynomial of the second degree. */
#include "remesh/remeshing.h"

#include "base/parallel.h"
#include "geometry/scale.h"

/* A vertex moves at most this fraction of the wanted length. Moves that are shorter than the other
 * fraction are not made: on a plane, all would be rounding errors. */
static const double MOST = 0.1, LEAST = 1e-9;

/* A face that is less round than this, with angles below 33 or above 100 degrees, may not become
 * less round. */
static const double ROUND = 0.66;

typedef struct fitting {
    const he_net *n;
    const he_ground *g;
    /* How far the ground is above the middle of each edge, at the smaller of its corners. Floats
     * are exact enough, and halve the memory. */
    float *above;
    float *rise; /* how far each vertex is to move along its normal */
} fitting;

static he_vec3 area_of(const he_net *n, uint32_t t)
{
    const uint32_t *v = n->triangles[t].v;
    return he_roundness_of(he_net_place(n, v[0]), he_net_place(n, v[1]), he_net_place(n, v[2]))
        .area;
}

/* Returns how far the ground is above the middle of the edge of a corner. */
static double measure(const fitting *f, uint32_t c)
{
    const he_net *n = f->n;
    uint32_t twin = he_net_twin(n, c), v = he_net_origin(n, c);
    he_vec3 up = area_of(n, c >> 2), normal;
    up = twin == HE_NONE ? up : he_vec3_add(up, area_of(n, twin >> 2));
    if (!he_vec3_normalise(up, &normal)) {
        return 0;
    }
    he_vec3 middle =
        he_vec3_scale(he_vec3_add(he_net_place(n, v), he_net_place(n, he_net_target(n, c))), 0.5);
    he_ground_point at;
    he_ground_walk(f->g, middle, n->ground[v], &at);
    return he_vec3_dot(he_vec3_sub(at.place, middle), normal);
}

static he_status measure_range(void *context, uint32_t which, size_t from, size_t to, he_error *err)
{
    const fitting *f = context;
    (void)which;
    (void)err;
    for (uint32_t t = (uint32_t)from; t < to; t++) {
        for (uint32_t c = 4 * t; c < 4 * t + 3 && !he_net_is_gone(f->n, t); c++) {
            if (c < he_net_twin(f->n, c)) { /* HE_NONE is larger than all corners */
                f->above[c] = (float)measure(f, c);
            }
        }
    }
    return HE_OK;
}

static double above(const fitting *f, uint32_t c)
{
    uint32_t twin = he_net_twin(f->n, c);
    return (double)f->above[c < twin ? c : twin];
}

static he_status raise_range(void *context, uint32_t which, size_t from, size_t to, he_error *err)
{
    const fitting *f = context;
    const uint32_t stays = HE_NET_FIXED | HE_NET_LINE | HE_NET_BORDER | HE_NET_DEAD;
    (void)which;
    (void)err;
    for (uint32_t v = (uint32_t)from; v < to; v++) {
        he_net_ring ring;
        double sum = 0;
        f->rise[v] = 0;
        if ((f->n->vertices[v].flags & stays) != 0 || !he_net_turn(f->n, v, &ring)) {
            continue;
        }
        for (uint32_t i = 0; i < ring.corners; i++) {
            sum += above(f, ring.corner[i]);
        }
        f->rise[v] = (float)(sum / ring.corners);
    }
    return HE_OK;
}

/* Moves a vertex along its normal unless a face around it would turn over or become too thin. */
static void move(he_remeshing *r, uint32_t v, double rise)
{
    he_net *n = &r->net;
    he_net_vertex *at = &n->vertices[v];
    he_net_ring ring;
    he_roundness before[HE_NET_HUB + 1];
    he_vec3 up = {0, 0, 0}, normal;
    double most = MOST * (double)at->size;
    if (!(fabs(rise) >= LEAST * (double)at->size) || !he_net_turn(n, v, &ring)) {
        return;
    }
    for (uint32_t i = 0; i < ring.count; i++) {
        he_vec3 a = he_net_place(n, ring.vertex[i]);
        he_vec3 b = he_net_place(n, ring.vertex[i + 1 < ring.count ? i + 1 : 0]);
        before[i] = he_roundness_of(at->p, a, b);
        up = he_vec3_add(up, before[i].area);
    }
    if (!he_vec3_normalise(up, &normal)) {
        return;
    }
    he_vec3 to = he_vec3_add(at->p, he_vec3_scale(normal, fmin(fmax(rise, -most), most)));
    for (uint32_t i = 0; i < ring.count; i++) {
        he_vec3 a = he_net_place(n, ring.vertex[i]);
        he_vec3 b = he_net_place(n, ring.vertex[i + 1 < ring.count ? i + 1 : 0]);
        he_roundness after = he_roundness_of(to, a, b);
        if (!he_remesh_agree(before[i].area, after.area) ||
            (he_roundness_is_below(&after, ROUND) && he_roundness_is_less(&after, &before[i]))) {
            return;
        }
    }
    at->p = to;
    at->flags |= HE_NET_MOVED;
}

he_status he_remesh_fit(he_remeshing *r, he_error *err)
{
    he_net *n = &r->net;
    fitting f = {.n = n, .g = &r->ground};
    f.above = he_mem_array(NULL, 4 * (size_t)n->triangle_count + 1, sizeof *f.above);
    f.rise = he_mem_array(NULL, (size_t)n->vertex_count + 1, sizeof *f.rise);
    he_status status =
        f.above != NULL && f.rise != NULL
            ? he_run_ranges(r->progress, n->triangle_count, measure_range, &f, err)
            : he_fail_plain(err, HE_NO_MEMORY, "no memory to fit %u triangles", n->triangle_count);
    if (status == HE_OK) {
        status = he_run_ranges(r->progress, n->vertex_count, raise_range, &f, err);
    }
    for (uint32_t v = 0; v < n->vertex_count && status == HE_OK; v++) {
        status = he_progress_at(r->progress, v + 1, n->vertex_count, err);
        move(r, v, (double)f.rise[v]);
    }
    he_mem_free(f.above);
    he_mem_free(f.rise);
    return status;
}
