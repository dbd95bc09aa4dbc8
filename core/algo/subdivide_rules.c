/* subdivide_rules.c - computes the positions of the vertices of a subdivided mesh. The weights are
 * those of the papers in subdivide.h. No weight is negative, so a refined mesh stays in the
 * bounding box of the coarser mesh.
 *
 * Old vertices are computed in two passes. The first pass stores in the array `to`, for each old
 * vertex, the sum that its rule needs: of the positions of its neighbours (for catmull_clark also
 * of the means of its faces), or, if the vertex is on a curve of sharp edges, of its two neighbours
 * on the curve. The second pass computes the new position from the sum and the old position. */
#include "algo/subdivide_step.h"
#include "base/parallel.h"

#include "geometry/scale.h"

#include <math.h>

enum { SMOOTH_AT_MOST = 1, CURVE = 2, CORNER = 3 };

/* Returns the vector s * a + t * b. */
static inline he_vec3 mix(double s, he_vec3 a, double t, he_vec3 b)
{
    return (he_vec3){s * a.x + t * b.x, s * a.y + t * b.y, s * a.z + t * b.z};
}
static inline void gather(he_vec3 *to, he_vec3 what)
{
    *to = he_vec3_add(*to, what);
}

/* The weights of a subdivision rule. The new position of a vertex is `own` times its old position
 * plus `sum` times the sum over its neighbours. */
typedef struct weights {
    double own, sum;
} weights;

static weights weights_of(he_scheme scheme, uint32_t degree)
{
    double n = degree, cosine, share;
    switch (scheme) {
    case HE_LOOP:
        cosine = 0.375 + 0.25 * cos(2 * HE_PI / n);
        share = 0.625 - cosine * cosine;
        return (weights){1 - share, share / n};
    case HE_CATMULL_CLARK:
        return (weights){(n - 2) / n, 1 / (n * n)};
    case HE_SQRT3:
        share = (4 - 2 * cos(2 * HE_PI / n)) / 9;
        return (weights){1 - share, share / n};
    case HE_LINEAR:
        break;
    }
    return (weights){1, 0};
}

static uint8_t sharpness(const he_subdivide_step *s, uint32_t v)
{
    return s->sharp == NULL ? 0 : s->sharp[v];
}

/* Adds the position of each end of edge e to the sum of the opposite end, if the rule for the
 * opposite end needs it. */
static inline void gather_ends(const he_subdivide_step *s, uint32_t e, const he_vec3 *from,
                               he_vec3 *to)
{
    uint32_t a = s->from->origin[2 * e], b = s->from->origin[2 * e + 1];
    bool sharp = s->sharp != NULL && he_subdivide_is_sharp(s, e);
    if (sharp || sharpness(s, a) <= SMOOTH_AT_MOST) {
        gather(&to[a], from[b]);
    }
    if (sharp || sharpness(s, b) <= SMOOTH_AT_MOST) {
        gather(&to[b], from[a]);
    }
}

static he_vec3 mean_of_face(const he_content *c, uint32_t first, const he_vec3 *from)
{
    he_vec3 total = {0, 0, 0};
    uint32_t h = first, n = 0;
    do {
        gather(&total, from[c->origin[h]]);
        h = c->next[h];
        n++;
    } while (h != first);
    return he_vec3_scale(total, 1 / (double)n);
}

static uint32_t middle(const he_subdivide_step *s, uint32_t e)
{
    return s->from->vertices.issued + he_subdivide_edge_rank(s, e);
}

/* --- points on edges, and what an edge adds to the sums of its two ends, for each scheme --- */

static void loop_edge(const he_subdivide_step *s, uint32_t e, const he_vec3 *from, he_vec3 *to)
{
    const he_content *c = s->from;
    uint32_t a = c->origin[2 * e], b = c->origin[2 * e + 1];
    he_vec3 ends = he_vec3_add(from[a], from[b]);
    if (s->sharp != NULL && he_subdivide_is_sharp(s, e)) {
        to[middle(s, e)] = he_vec3_scale(ends, 0.5);
        return;
    }
    uint32_t left = c->origin[c->prev[2 * e]], right = c->origin[c->prev[2 * e + 1]];
    to[middle(s, e)] = mix(0.375, ends, 0.125, he_vec3_add(from[left], from[right]));
}

/* Returns the mean of the corners of face f, which place_centres has stored in `to`. */
static he_vec3 face_point(const he_subdivide_step *s, uint32_t f, const he_vec3 *to)
{
    return to[s->from->vertices.issued + s->from->edges.live + he_subdivide_face_rank(s, f)];
}

/* Sets sides[k] to the mean of the corners of the face of half-edge k of edge e, or to zero if that
 * half-edge has no face. */
static void find_sides(const he_subdivide_step *s, uint32_t e, const he_vec3 *to, he_vec3 sides[2])
{
    const he_content *c = s->from;
    for (uint32_t k = 0; k < 2; k++) {
        uint32_t f = c->face[2 * e + k];
        sides[k] = f == HE_NONE ? (he_vec3){0, 0, 0} : face_point(s, f, to);
    }
}

static void catmull_clark_edge(const he_subdivide_step *s, uint32_t e, const he_vec3 *from,
                               he_vec3 *to)
{
    const he_content *c = s->from;
    he_vec3 sides[2], ends = he_vec3_add(from[c->origin[2 * e]], from[c->origin[2 * e + 1]]);
    find_sides(s, e, to, sides);
    bool sharp = s->sharp != NULL && he_subdivide_is_sharp(s, e);
    to[middle(s, e)] =
        sharp ? he_vec3_scale(ends, 0.5) : mix(0.25, ends, 0.25, he_vec3_add(sides[0], sides[1]));
}

static void catmull_clark_ends(const he_subdivide_step *s, uint32_t e, const he_vec3 *from,
                               he_vec3 *to)
{
    const he_content *c = s->from;
    uint32_t a = c->origin[2 * e], b = c->origin[2 * e + 1];
    he_vec3 sides[2];
    gather_ends(s, e, from, to);
    find_sides(s, e, to, sides);
    if (sharpness(s, a) <= SMOOTH_AT_MOST) {
        gather(&to[a], sides[0]);
    }
    if (sharpness(s, b) <= SMOOTH_AT_MOST) {
        gather(&to[b], sides[1]);
    }
}

static void linear_edge(const he_subdivide_step *s, uint32_t e, const he_vec3 *from, he_vec3 *to)
{
    he_vec3 a = from[s->from->origin[2 * e]], b = from[s->from->origin[2 * e + 1]];
    to[middle(s, e)] = mix(0.5, a, 0.5, b);
}

/* Returns the point on a sharp edge that is nearer to a than to b, a third of the way along. If a
 * is on a smooth curve of sharp edges, the point also depends on the neighbours of a on the curve,
 * whose sum must be in to[a]; otherwise it lies on the straight line from a to b. */
static he_vec3 third_from(const he_subdivide_step *s, uint32_t a, uint32_t b, const he_vec3 *from,
                          const he_vec3 *to)
{
    if (sharpness(s, a) != CURVE) {
        return mix(2.0 / 3, from[a], 1.0 / 3, from[b]);
    }
    /* The rule gives b the weight 10/27. The sum over the neighbours of a contains b once, which
     * contributes 1/27, so 9/27 remain. */
    return he_vec3_add(mix(16.0 / 27, from[a], 9.0 / 27, from[b]), he_vec3_scale(to[a], 1.0 / 27));
}

static void cut_in_thirds(const he_subdivide_step *s, const he_vec3 *from, he_vec3 *to)
{
    const he_content *c = s->from;
    for (uint32_t e = 0; e < c->edges.issued && s->thirds; e++) {
        if (s->third[e] != HE_NONE) {
            uint32_t a = c->origin[2 * e], b = c->origin[2 * e + 1];
            uint32_t p = c->vertices.issued + 2 * s->third[e];
            to[p] = third_from(s, a, b, from, to);
            to[p + 1] = third_from(s, b, a, from, to);
        }
    }
}

/* The arguments of the parallel loops that compute positions. */
typedef struct placing {
    const he_subdivide_step *s;
    const he_vec3 *from;
    he_vec3 *to;
} placing;

/* --- vertices --- */

static he_status move_vertices(void *context, uint32_t part, size_t from, size_t to, he_error *err)
{
    enum { TABLE = 32 };
    const placing *p = context;
    const he_subdivide_step *s = p->s;
    weights table[TABLE];
    (void)part;
    (void)err;
    for (uint32_t n = 1; n < TABLE; n++) {
        table[n] = weights_of(s->scheme, n);
    }
    /* If the scheme is sqrt3, vertices on sharp curves move only in steps that cut the curves'
     * edges. */
    weights curve = s->scheme != HE_SQRT3 ? (weights){0.75, 0.125}
                    : s->thirds           ? (weights){19.0 / 27, 4.0 / 27}
                                          : (weights){1, 0};
    for (size_t v = from; v < to; v++) {
        uint32_t n = s->degree[v];
        uint8_t sharp = sharpness(s, (uint32_t)v);
        if (n == 0 || sharp == CORNER) {
            p->to[v] = p->from[v];
            continue;
        }
        weights w = sharp == CURVE ? curve : n < TABLE ? table[n] : weights_of(s->scheme, n);
        p->to[v] = mix(w.own, p->from[v], w.sum, p->to[v]);
    }
    return HE_OK;
}

/* Computes the new vertex inside each face, for catmull_clark and sqrt3. For sqrt3 its id is in
 * `centre`; for catmull_clark it follows from the number of live faces before the face. */
static he_status place_centres(void *context, uint32_t part, size_t from, size_t to, he_error *err)
{
    const placing *p = context;
    const he_subdivide_step *s = p->s;
    const he_content *c = s->from;
    (void)part;
    (void)err;
    for (size_t f = from; f < to; f++) {
        uint32_t h = c->face_halfedge[f];
        if (h == HE_DEAD) {
            continue;
        }
        uint32_t at = s->scheme == HE_SQRT3 ? s->centre[f]
                                            : c->vertices.issued + c->edges.live +
                                                  he_subdivide_face_rank(s, (uint32_t)f);
        if (at != HE_NONE) {
            p->to[at] = mean_of_face(c, h, p->from);
        }
    }
    return HE_OK;
}

/* Computes the new vertex inside each face that is no triangle, for the scheme linear. */
static he_status place_some_centres(const placing *p, he_error *err)
{
    const he_content *c = p->s->from;
    uint32_t at = c->vertices.issued + c->edges.live;
    he_status status = HE_OK;
    for (uint32_t f = 0; f < c->faces.issued && status == HE_OK; f++) {
        status = he_progress_at(p->s->progress, f, c->faces.issued, err);
        uint32_t h = c->face_halfedge[f];
        if (h != HE_DEAD && c->next[c->next[c->next[h]]] != h) {
            p->to[at++] = mean_of_face(c, h, p->from);
        }
    }
    return status;
}

static he_status place_middles(void *context, uint32_t part, size_t from, size_t to, he_error *err)
{
    const placing *p = context;
    const he_subdivide_step *s = p->s;
    (void)part;
    (void)err;
    for (size_t e = from; e < to; e++) {
        if (s->from->next[2 * e] == HE_DEAD) {
            continue;
        }
        switch (s->scheme) {
        case HE_LOOP:
            loop_edge(s, (uint32_t)e, p->from, p->to);
            break;
        case HE_CATMULL_CLARK:
            catmull_clark_edge(s, (uint32_t)e, p->from, p->to);
            break;
        case HE_LINEAR:
            linear_edge(s, (uint32_t)e, p->from, p->to);
            break;
        case HE_SQRT3:
            /* cut_in_thirds computes the points on sharp edges later, when the sums of all vertices
             * are complete */
            break;
        }
    }
    return HE_OK;
}

/* Adds up, for every vertex, the sum over its neighbours that the vertex's rule needs. Only one
 * thread does this, because a floating-point sum depends on the order of its terms. */
static he_status sum_ends(void *context, uint32_t lane, size_t from, size_t to, he_error *err)
{
    const placing *p = context;
    const he_subdivide_step *s = p->s;
    (void)lane;
    (void)err;
    for (size_t e = from; e < to; e++) {
        if (s->from->next[2 * e] == HE_DEAD) {
            continue;
        }
        if (s->scheme == HE_CATMULL_CLARK) {
            catmull_clark_ends(s, (uint32_t)e, p->from, p->to);
        } else {
            gather_ends(s, (uint32_t)e, p->from, p->to);
        }
    }
    return HE_OK;
}

static he_status clear_sums(void *context, uint32_t part, size_t from, size_t to, he_error *err)
{
    const placing *p = context;
    (void)part;
    (void)err;
    for (size_t v = from; v < to; v++) {
        p->to[v] = p->s->scheme == HE_LINEAR ? p->from[v] : (he_vec3){0, 0, 0};
    }
    return HE_OK;
}

static he_status smooth(const he_subdivide_step *s, const he_vec3 *from, he_vec3 *to, he_error *err)
{
    const he_content *c = s->from;
    placing p = {s, from, to};
    he_status status = he_run_ranges(s->progress, c->vertices.issued, clear_sums, &p, err);
    if (status == HE_OK && s->scheme == HE_LINEAR && s->polygonal) {
        status = place_some_centres(&p, err);
    } else if (status == HE_OK && (s->scheme == HE_CATMULL_CLARK || s->scheme == HE_SQRT3)) {
        status = he_run_ranges(s->progress, c->faces.issued, place_centres, &p, err);
    }
    if (status == HE_OK && s->scheme != HE_SQRT3) {
        status = he_run_ranges(s->progress, c->edges.issued, place_middles, &p, err);
    }
    if (status == HE_OK && s->scheme != HE_LINEAR) {
        status = he_run_lanes(s->progress, 1, c->edges.issued, sum_ends, &p, err);
    }
    if (status == HE_OK && s->scheme != HE_LINEAR) {
        cut_in_thirds(s, from, to);
        status = he_run_ranges(s->progress, c->vertices.issued, move_vertices, &p, err);
    }
    return status;
}

/* --- large coordinates --- */

/* If no coordinate is larger than this, sums of coordinates do not overflow. */
static const double LARGE = 1e290;

static bool is_large(const he_vec3 *p, uint32_t count)
{
    bool large = false;
    for (uint32_t i = 0; i < count; i++) {
        large |= p[i].x > LARGE || p[i].x < -LARGE || p[i].y > LARGE || p[i].y < -LARGE ||
                 p[i].z > LARGE || p[i].z < -LARGE;
    }
    return large;
}

he_status he_subdivide_place(const he_subdivide_step *s, const he_vec3 *from, he_vec3 *to,
                             he_error *err)
{
    const double scale = 0x1p-64;
    uint32_t rows = s->from->vertices.issued;
    if (!is_large(from, rows)) {
        return smooth(s, from, to, err);
    }
    he_vec3 *small = he_mem_array(NULL, rows, sizeof *small);
    if (small == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory to scale %u vertices", rows);
    }
    for (uint32_t v = 0; v < rows; v++) {
        small[v] = he_vec3_scale(from[v], scale);
    }
    he_status status = smooth(s, small, to, err);
    for (uint32_t v = 0; v < s->to->vertices.issued && status == HE_OK; v++) {
        to[v] = (he_vec3){he_clamped(to[v].x / scale), he_clamped(to[v].y / scale),
                          he_clamped(to[v].z / scale)};
    }
    he_mem_free(small);
    return status;
}
