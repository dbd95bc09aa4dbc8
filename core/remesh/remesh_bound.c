/* remesh_bound.c - how far the new faces are from the given surface at most.
 *
 * A face and the ground are seen along the normal of the face:
 *
 *          o-------o-------o          The triangles of the ground over the face are found from one
 *         / \    /.|\     /           to the next, across all edges over the face. If all look the
 *        /   \ /__.|_\.  /            same way as the face, and one of them has a point over it,
 *       /    /\    |   \/             every point of the face has a point of the ground over it:
 *      o---/---\---o----o             the number of triangles over a point of the face changes only
 *                                     where an edge with a triangle on one side ends.
 *
 * The point of the face is then no farther from the ground than the height of that point. Over the
 * part of a face that is over one triangle, the height is linear, and largest at a corner of the
 * part.
 *
 * Faces end a little beside the surface at boundaries and sharp edges. There, a smaller copy of the
 * face is looked at, and the distance between the two is added. If no copy is over the ground, the
 * distance of the middle and the size of the face are a bound. */
#include "remesh/remeshing.h"

#include "base/parallel.h"
#include "geometry/scale.h"

#include <float.h>

/* By how much the copies are smaller than the face. */
static const double SMALLER[] = {1e-11, 1e-6, 0.02, 0.1, 0.3};

enum {
    MOST_GROUND = 64, /* the most triangles of the ground over a face that are looked at */
    CLIPPED = 12      /* more corners than the part of a triangle over another one has */
};

typedef struct flat {
    double x, y, z; /* in the plane of the face, and the height above it */
} flat;

/* A face, or a smaller copy of it, in coordinates of its own. */
typedef struct face {
    const he_ground *g;
    he_vec3 middle, along, across, up;
    flat corner[3]; /* counter-clockwise around the origin, which is the middle of the face */
    double radius;  /* distance of the farthest corner from the middle */
} face;

static flat flatten(const face *f, he_vec3 p)
{
    he_vec3 d = he_vec3_sub(p, f->middle);
    return (flat){he_vec3_dot(d, f->along), he_vec3_dot(d, f->across), he_vec3_dot(d, f->up)};
}

/* Returns twice the area of a triangle, above 0 if it is counter-clockwise. */
static double turn(flat a, flat b, flat c)
{
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

static flat between(flat a, flat b, double t)
{
    return (flat){a.x + t * (b.x - a.x), a.y + t * (b.y - a.y), a.z + t * (b.z - a.z)};
}

/* Keeps the part of a convex polygon that is to the left of the line from a to b. Returns the
 * number of its corners (I. E. Sutherland and G. W. Hodgman, "Reentrant polygon clipping", 1974).
 */
static unsigned clip(const flat *in, unsigned count, flat a, flat b, flat *out)
{
    unsigned kept = 0;
    for (unsigned i = 0; i < count; i++) {
        flat p = in[i], q = in[i + 1 < count ? i + 1 : 0];
        double at_p = turn(a, b, p), at_q = turn(a, b, q);
        if (at_p >= 0 && kept < CLIPPED) {
            out[kept++] = p;
        }
        if (((at_p > 0 && at_q < 0) || (at_p < 0 && at_q > 0)) && kept < CLIPPED) {
            out[kept++] = between(p, q, at_p / (at_p - at_q));
        }
    }
    return kept;
}

/* Raises *most to the largest height of the part of a triangle of the ground that is over the face.
 */
static void raise(const face *f, const flat ground[3], double *most)
{
    flat one[CLIPPED], two[CLIPPED];
    unsigned count = clip(ground, 3, f->corner[0], f->corner[1], one);
    count = clip(one, count, f->corner[1], f->corner[2], two);
    count = clip(two, count, f->corner[2], f->corner[0], one);
    for (unsigned i = 0; i < count; i++) {
        *most = fmax(*most, fabs(one[i].z));
    }
}

/* Returns true if a part of the segment from a to b is over the face. */
static bool crosses(const face *f, flat a, flat b)
{
    double from = 0, to = 1;
    for (unsigned i = 0; i < 3; i++) {
        flat p = f->corner[i], q = f->corner[(i + 1) % 3];
        double at_a = turn(p, q, a), at_b = turn(p, q, b);
        if (at_a < 0 && at_b < 0) {
            return false;
        }
        if (at_a < 0) {
            from = fmax(from, at_a / (at_a - at_b));
        } else if (at_b < 0) {
            to = fmin(to, at_a / (at_a - at_b));
        }
    }
    return from <= to;
}

static bool has_middle(const flat ground[3])
{
    flat middle = {0, 0, 0};
    return turn(ground[0], ground[1], middle) >= 0 && turn(ground[1], ground[2], middle) >= 0 &&
           turn(ground[2], ground[0], middle) >= 0;
}

/* The triangles of the ground that were found over a face. */
typedef struct flood {
    uint32_t found[MOST_GROUND];
    flat corner[MOST_GROUND][3];
    uint32_t count;
    bool has_middle; /* one of them is over the middle of the face */
    double highest;  /* the largest height of one of their corners */
} flood;

static bool has(const flood *of, uint32_t t)
{
    for (uint32_t i = of->count; i-- > 0;) {
        if (of->found[i] == t) {
            return true;
        }
    }
    return false;
}

/* Looks at a triangle of the ground, and adds those beside it over the face. Returns false if the
 * face is not surely below the ground. */
static bool look(const face *f, uint32_t i, flood *to)
{
    const he_ground_triangle *own = &f->g->triangles[to->found[i]];
    flat *at = to->corner[i];
    for (unsigned k = 0; k < 3; k++) {
        at[k] = flatten(f, f->g->place[own->v[k]]);
        to->highest = fmax(to->highest, fabs(at[k].z));
    }
    if (!(turn(at[0], at[1], at[2]) > 0)) {
        return false;
    }
    to->has_middle |= has_middle(at);
    for (unsigned k = 0; k < 3; k++) {
        const uint32_t twin = own->twin[k];
        if ((twin != HE_NONE && has(to, twin >> 2)) || !crosses(f, at[k], at[(k + 1) % 3])) {
            continue;
        }
        if (twin == HE_NONE || to->count == MOST_GROUND) {
            return false;
        }
        to->found[to->count++] = twin >> 2;
    }
    return true;
}

/* Returns the largest distance of a face from the ground over it, of which `t` is a triangle; or a
 * larger number up to `enough`. Returns HUGE_VAL if the face is not surely below the ground. */
static double height_of(const face *f, uint32_t t, double enough)
{
    flood over;
    double most = 0;
    over.found[0] = t;
    over.count = 1;
    over.has_middle = false;
    over.highest = 0;
    for (uint32_t i = 0; i < over.count; i++) {
        if (!look(f, i, &over)) {
            return HUGE_VAL;
        }
    }
    if (!over.has_middle) {
        return HUGE_VAL;
    }
    for (uint32_t i = 0; i < over.count && over.highest > enough; i++) {
        raise(f, over.corner[i], &most);
    }
    return over.highest > enough ? most : over.highest;
}

/* Returns a bound of the distance of the points of a face from the ground, which need not be the
 * least one if it is below `enough`. */
static double bound_of(const he_net *n, const he_ground *g, uint32_t t, double enough)
{
    const uint32_t *v = n->triangles[t].v;
    he_vec3 p[3];
    he_ground_point near;
    face f = {.g = g};
    for (unsigned i = 0; i < 3; i++) {
        p[i] = he_net_place(n, v[i]);
    }
    f.middle = he_vec3_scale(he_vec3_add(p[0], he_vec3_add(p[1], p[2])), 1.0 / 3);
    for (unsigned i = 0; i < 3; i++) {
        f.radius = fmax(f.radius, sqrt(he_remesh_square(f.middle, p[i])));
    }
    he_ground_walk(g, f.middle, n->ground[v[0]], &near);
    double bound = sqrt(near.square) + f.radius;
    if (!he_vec3_normalise(he_vec3_sub(p[1], p[0]), &f.along) ||
        !he_vec3_normalise(he_roundness_of(p[0], p[1], p[2]).area, &f.up)) {
        return bound;
    }
    f.across = he_vec3_cross(f.up, f.along);
    for (size_t k = 0; k < sizeof SMALLER / sizeof *SMALLER; k++) {
        for (unsigned i = 0; i < 3; i++) {
            flat at = flatten(&f, p[i]);
            f.corner[i] = between(at, (flat){0, 0, 0}, SMALLER[k]);
        }
        double height = height_of(&f, near.triangle, enough - SMALLER[k] * f.radius);
        if (height < HUGE_VAL) {
            return fmin(bound, height + SMALLER[k] * f.radius);
        }
    }
    return bound;
}

typedef struct bounding {
    const he_net *n;
    const he_ground *g;
    double *most; /* of each range */
} bounding;

static he_status bound_range(void *context, uint32_t which, size_t from, size_t to, he_error *err)
{
    const bounding *b = context;
    double most = 0;
    (void)err;
    for (uint32_t t = (uint32_t)from; t < to; t++) {
        most = he_net_is_gone(b->n, t) ? most : fmax(most, bound_of(b->n, b->g, t, most));
    }
    b->most[which] = most;
    return HE_OK;
}

he_status he_remesh_bound(const he_remeshing *r, double *out, he_error *err)
{
    const he_net *n = &r->net;
    const size_t ranges = he_ranges(n->triangle_count);
    bounding b = {n, &r->ground, he_mem_zero(ranges + 1, sizeof *b.most)};
    he_status status = b.most == NULL
                           ? he_fail_plain(err, HE_NO_MEMORY, "no memory to bound distances")
                           : he_run_ranges(r->progress, n->triangle_count, bound_range, &b, err);
    double most = 0;
    for (size_t i = 0; i < ranges && status == HE_OK; i++) {
        most = fmax(most, b.most[i]);
    }
    *out = most;
    he_mem_free(b.most);
    return status;
}
