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

/* A corner of the ground as seen from a face: `left` says for each edge of the face how far the
 * corner is to the left of it, as twice the area of the triangle that they make. */
typedef struct spot {
    flat at;
    double left[3];
} spot;

static spot look_at(const face *f, he_vec3 p)
{
    spot s = {.at = flatten(f, p)};
    for (unsigned i = 0; i < 3; i++) {
        s.left[i] = turn(f->corner[i], f->corner[i == 2 ? 0 : i + 1], s.at);
    }
    return s;
}

/* Returns true if a part of the segment between two corners is over the face. */
static bool crosses(const spot *a, const spot *b)
{
    double from = 0, to = 1;
    for (unsigned i = 0; i < 3; i++) {
        double at_a = a->left[i], at_b = b->left[i];
        if (at_a < 0 && at_b < 0) {
            return false;
        }
        if (at_a < 0) {
            const double t = at_a / (at_a - at_b);
            from = t > from ? t : from;
        } else if (at_b < 0) {
            const double t = at_a / (at_a - at_b);
            to = t < to ? t : to;
        }
    }
    return from <= to;
}

static bool has_middle(const spot ground[3])
{
    flat middle = {0, 0, 0};
    return turn(ground[0].at, ground[1].at, middle) >= 0 &&
           turn(ground[1].at, ground[2].at, middle) >= 0 &&
           turn(ground[2].at, ground[0].at, middle) >= 0;
}

/* A triangle of the ground that was found over a face. It is entered across its edge `entry`, whose
 * ends have been looked at; 3 stands for the first triangle, of which nothing is known. */
typedef struct over {
    uint32_t triangle, entry;
    spot corner[3];
} over;

/* The triangles of the ground that were found over a face. */
typedef struct flood {
    over found[MOST_GROUND];
    uint32_t count;
    bool has_middle; /* one of them is over the middle of the face */
    double highest;  /* the largest height of one of their corners */
} flood;

static bool has(const flood *of, uint32_t t)
{
    for (uint32_t i = of->count; i-- > 0;) {
        if (of->found[i].triangle == t) {
            return true;
        }
    }
    return false;
}

static void look_at_corner(const face *f, over *own, unsigned k, flood *to)
{
    own->corner[k] = look_at(f, f->g->place[f->g->triangles[own->triangle].v[k]]);
    const double height = fabs(own->corner[k].at.z);
    to->highest = height > to->highest ? height : to->highest;
}

/* Adds the triangle beyond the edge k of a triangle that was looked at. */
static void enter(const over *from, unsigned k, uint32_t twin, flood *to)
{
    over *next = &to->found[to->count++];
    next->triangle = twin >> 2;
    next->entry = twin & 3;
    next->corner[twin & 3] = from->corner[k == 2 ? 0 : k + 1];
    next->corner[(twin & 3) == 2 ? 0 : (twin & 3) + 1] = from->corner[k];
}

/* Looks at a triangle of the ground, and adds those beside it over the face. Returns false if the
 * face is not surely below the ground. */
static bool look(const face *f, over *own, flood *to)
{
    const spot *at = own->corner;
    if (own->entry < 3) {
        look_at_corner(f, own, own->entry == 0 ? 2 : own->entry - 1, to);
    } else {
        for (unsigned k = 0; k < 3; k++) {
            look_at_corner(f, own, k, to);
        }
    }
    if (!(turn(at[0].at, at[1].at, at[2].at) > 0)) {
        return false;
    }
    to->has_middle = to->has_middle || has_middle(at);
    for (unsigned k = 0; k < 3; k++) {
        const uint32_t twin = f->g->triangles[own->triangle].twin[k];
        if (k == own->entry || !crosses(&at[k], &at[k == 2 ? 0 : k + 1]) ||
            (twin != HE_NONE && has(to, twin >> 2))) {
            continue;
        }
        if (twin == HE_NONE || to->count == MOST_GROUND) {
            return false;
        }
        enter(own, k, twin, to);
    }
    return true;
}

/* Returns the largest distance of a face from the ground over it, of which `t` is a triangle; or a
 * larger number up to `enough`. Returns HUGE_VAL if the face is not surely below the ground. */
static double height_of(const face *f, uint32_t t, double enough)
{
    flood all; /* it is large, so only members that are used are set */
    double most = 0;
    all.found[0].triangle = t;
    all.found[0].entry = 3;
    all.count = 1;
    all.has_middle = false;
    all.highest = 0;
    for (uint32_t i = 0; i < all.count; i++) {
        if (!look(f, &all.found[i], &all)) {
            return HUGE_VAL;
        }
    }
    if (!all.has_middle) {
        return HUGE_VAL;
    }
    for (uint32_t i = 0; i < all.count && all.highest > enough; i++) {
        const spot *at = all.found[i].corner;
        raise(f, (flat[3]){at[0].at, at[1].at, at[2].at}, &most);
    }
    return all.highest > enough ? most : all.highest;
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
