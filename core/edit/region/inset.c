#include "edit/region/inset.h"

#include "edit/piece/point.h"
#include "geometry/geometry.h"

/* Describes how the corners on the rim of a region move while time runs from 0 to 1, and has
 * buffers for the corners of one face. */
typedef struct motion {
    he_vec3 *path;  /* the displacement of each corner on the rim until time 1 */
    he_vec3 *at;    /* buffer: the positions of the corners of one face */
    he_vec3 *moves; /* buffer: the displacements of the corners of one face until time 1 */
    /* One vector for each face of the region: the mean of its corners or, if sides move in
     * parallel, its normal. */
    he_vec3 *of;
    /* The first time at which a corner hits a side, a side has no length, or a corner flips. The
     * motion must end before. */
    double end;
    uint64_t budget; /* the number of steps of work that may still be done */
} motion;

static void motion_clear(motion *p)
{
    he_mem_free(p->path);
    he_mem_free(p->at);
    he_mem_free(p->moves);
    he_mem_free(p->of);
}

static he_status motion_init(const he_mesh *m, const he_region *r, motion *out, he_error *err)
{
    uint32_t most = 0;
    for (size_t i = 0; i < r->faces.ids.count; i++) {
        uint32_t degree = he_face_degree(m, (he_face){r->faces.ids.ids[i]});
        most = degree > most ? degree : most;
    }
    *out = (motion){.end = INFINITY, .budget = HE_INSET_STEPS};
    out->path = he_mem_zero(r->rim.count, sizeof *out->path);
    out->at = he_mem_array(NULL, most, sizeof *out->at);
    out->moves = he_mem_array(NULL, most, sizeof *out->moves);
    out->of = he_mem_array(NULL, r->faces.ids.count, sizeof *out->of);
    if (out->path == NULL || out->at == NULL || out->moves == NULL || out->of == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory to shrink an outline");
    }
    return HE_OK;
}

static uint32_t index_of(const he_mesh *m, const he_region *r, uint32_t h)
{
    return he_idmap_find(&r->faces, he_face_of(m, (he_halfedge){h}).i);
}

/* --- displacements of the corners on the rim --- */

/* Lets each corner on the rim move towards a point, by the fraction `factor` of the way. The point
 * is the mean of the centres of the faces at the corner; a centre is the mean of the corners of a
 * face. */
static void aim_at_means(const he_mesh *m, const he_region *r, double factor, motion *p)
{
    for (size_t i = 0; i < r->faces.ids.count; i++) {
        p->of[i] = he_loop_mean(m, he_face_halfedge(m, (he_face){r->faces.ids.ids[i]}));
    }
    size_t k = 0;
    for (size_t i = 0; i < r->rim.count; i++) {
        he_vec3 from = he_position(m, (he_vertex){r->corners.ids.ids[i]});
        he_vec3 mean = p->of[index_of(m, r, r->rim.ids[i])];
        double seen = 1;
        for (; k < r->inner.count && r->inner_at.ids[k] == i; k++) {
            seen++;
            mean = he_point_between(mean, p->of[index_of(m, r, r->inner.ids[k])], 1 / seen);
        }
        p->path[i] = he_vec3_scale(he_vec3_sub(mean, from), factor);
    }
}

/* Returns the displacement of a corner whose two sides move inwards by 1. `a` and `b` are the unit
 * vectors in whose directions the two sides move. */
static he_vec3 miter(he_vec3 a, he_vec3 b)
{
    const double sharpest = 0.125;
    he_vec3 sum = he_vec3_add(a, b);
    if (he_vec3_extent(a) <= 0 || he_vec3_extent(b) <= 0) {
        return sum;
    }
    return he_vec3_scale(sum, 1 / fmax(0.5 * he_vec3_dot(sum, sum), sharpest));
}

/* Returns the unit vector that is perpendicular to a half-edge of the rim and points into its face,
 * or zero if the half-edge has no length. */
static he_vec3 inwards(const he_mesh *m, const he_region *r, const motion *p, uint32_t rim)
{
    he_halfedge h = {rim};
    he_vec3 along =
        he_direction(he_position(m, he_origin(m, h)), he_position(m, he_target(m, h)), NULL);
    he_vec3 across = he_vec3_cross(p->of[index_of(m, r, rim)], along);
    double length = he_vec3_length(across);
    return length > 0 ? he_vec3_scale(across, 1 / length) : across;
}

static he_status aim_at_parallels(const he_mesh *m, const he_region *r, motion *p, he_error *err)
{
    for (size_t i = 0; i < r->faces.ids.count; i++) {
        (void)he_face_normal(m, (he_face){r->faces.ids.ids[i]}, &p->of[i]);
    }
    for (size_t i = 0; i < r->rim.count; i++) {
        uint32_t index = index_of(m, r, r->rim.ids[i]);
        if (he_vec3_extent(p->of[index]) <= 0) {
            return he_fail(err, HE_NO_NORMAL, HE_FACE, r->faces.ids.ids[index],
                           "face %u has no area, so its border cannot have a width given as a "
                           "distance: give a factor instead",
                           r->faces.ids.ids[index]);
        }
    }
    /* p->path[i] is the motion of the origin of rim half-edge i. This loop sets the motion of the
     * target of each rim half-edge, from which the rim half-edge with the index `after` leaves. */
    for (size_t i = 0; i < r->rim.count; i++) {
        he_halfedge h = {r->rim.ids[i]};
        uint32_t after = he_idmap_find(&r->corners, he_target(m, h).i);
        p->path[after] = miter(inwards(m, r, p, h.i), inwards(m, r, p, r->rim.ids[after]));
    }
    return HE_OK;
}

/* --- when the motion must end --- */

static void happens(motion *p, double time)
{
    if (time > 0 && time < p->end) {
        p->end = time;
    }
}

/* The polynomial c0 + c1 t + c2 t^2. */
typedef struct quadratic {
    double c0, c1, c2;
} quadratic;

/* Returns the smallest positive root of a polynomial with c0 > 0, or infinity if it has none. A
 * double root is found even if rounding errors make the discriminant slightly negative. */
static double first_root(quadratic p)
{
    const double noise = 1e-9;
    double square = p.c1 * p.c1 - 4 * p.c0 * p.c2;
    if (!(square >= -noise * p.c1 * p.c1)) {
        return INFINITY;
    }
    double q = -0.5 * (p.c1 + copysign(sqrt(fmax(square, 0)), p.c1));
    double one = q / p.c2, other = p.c0 / q;
    one = one > 0 ? one : INFINITY;
    other = other > 0 ? other : INFINITY;
    return fmin(one, other);
}

typedef struct corner {
    he_vec3 at, moves;
} corner;

static corner corner_of(const motion *p, size_t i)
{
    return (corner){p->at[i], p->moves[i]};
}

/* Returns twice the signed area of the triangle of three moving corners, projected along the
 * normal, as a polynomial in time. */
static quadratic turn(corner a, corner b, corner c, he_vec3 normal)
{
    he_vec3 x = he_vec3_sub(b.at, a.at), y = he_vec3_sub(c.at, b.at);
    he_vec3 dx = he_vec3_sub(b.moves, a.moves), dy = he_vec3_sub(c.moves, b.moves);
    return (quadratic){
        .c0 = he_vec3_dot(he_vec3_cross(x, y), normal),
        .c1 = he_vec3_dot(he_vec3_add(he_vec3_cross(x, dy), he_vec3_cross(dx, y)), normal),
        .c2 = he_vec3_dot(he_vec3_cross(dx, dy), normal)};
}

static void watch_side(motion *p, corner a, corner b)
{
    double length;
    he_vec3 along = he_direction(a.at, b.at, &length);
    happens(p, length / he_vec3_dot(he_vec3_sub(a.moves, b.moves), along));
}

/* Finds the time at which corner c, coming from inside the face, hits the side from a to b. The
 * motion then ends at this time, unless it ends earlier. */
static void watch_hit(motion *p, corner a, corner b, corner c, he_vec3 normal)
{
    quadratic area = turn(a, b, c, normal);
    double time = area.c0 > 0 ? first_root(area) : INFINITY;
    if (!(time < p->end)) {
        return;
    }
    he_vec3 from = he_vec3_add(a.at, he_vec3_scale(a.moves, time));
    he_vec3 to = he_vec3_add(b.at, he_vec3_scale(b.moves, time));
    he_vec3 hit = he_vec3_add(c.at, he_vec3_scale(c.moves, time));
    he_vec3 side = he_vec3_sub(to, from);
    double along = he_vec3_dot(he_vec3_sub(hit, from), side);
    if (along >= 0 && along <= he_vec3_dot(side, side)) {
        happens(p, time);
    }
}

static he_status watch_face(const he_mesh *m, const he_region *r, he_face f, motion *p,
                            he_error *err)
{
    size_t n = 0;
    bool any = false;
    he_halfedge first = he_face_halfedge(m, f), h = first;
    do {
        uint32_t i = he_idmap_find(&r->corners, he_origin(m, h).i);
        p->at[n] = he_position(m, he_origin(m, h));
        p->moves[n++] = i != HE_NONE ? p->path[i] : (he_vec3){0, 0, 0};
        any |= i != HE_NONE;
        h = he_next(m, h);
    } while (h.i != first.i);
    he_vec3 normal;
    if (!any || !he_face_normal(m, f, &normal)) {
        return HE_OK;
    }
    for (size_t i = 0; i < n; i++) {
        corner a = corner_of(p, i), b = corner_of(p, (i + 1) % n), c = corner_of(p, (i + 2) % n);
        quadratic area = turn(a, b, c, normal);
        watch_side(p, a, b);
        if (area.c0 > 0) {
            happens(p, first_root(area));
            continue;
        }
        /* Corner b is reflex (its angle is above pi), so it may hit any side of the face that does
         * not end at b. */
        if (p->budget < n) {
            return he_fail(
                err, HE_LIMIT, HE_FACE, f.i,
                "face %u has too many corners, many of them reflex, for an inset to be checked",
                f.i);
        }
        p->budget -= n;
        for (size_t k = i + 2; k < i + n; k++) {
            watch_hit(p, corner_of(p, k % n), corner_of(p, (k + 1) % n), b, normal);
        }
    }
    return HE_OK;
}

static he_status place(const he_mesh *m, const he_region *r, void *context, he_vec3 *to,
                       he_vec3 *shift, bool *shifts, he_error *err)
{
    const he_inset_width *in = context;
    motion p;
    double time = in->factor > 0 ? 1 : in->distance;
    (void)shift;
    (void)shifts;
    he_status status = motion_init(m, r, &p, err);
    if (status == HE_OK && in->factor > 0) {
        aim_at_means(m, r, in->factor, &p);
    } else if (status == HE_OK) {
        status = aim_at_parallels(m, r, &p, err);
    }
    for (size_t i = 0; status == HE_OK && i < r->faces.ids.count; i++) {
        status = watch_face(m, r, (he_face){r->faces.ids.ids[i]}, &p, err);
    }
    if (status == HE_OK) {
        time = time < p.end ? time : 0.99 * p.end;
        for (size_t i = 0; i < r->rim.count; i++) {
            he_vec3 from = he_position(m, (he_vertex){r->corners.ids.ids[i]});
            to[i] = he_vec3_add(from, he_vec3_scale(p.path[i], time));
        }
    }
    motion_clear(&p);
    return status;
}

/* --- interpolated values of new vertices --- */

/* Finds the point of a triangle that is nearest to the point `way`, up to rounding. The sides `a`
 * and `b` and the vector `way` start at one corner. The result is *x times a plus *y times b, where
 * *x and *y are at least 0 and their sum is at most 1. Returns the squared distance. */
static double find_in_triangle(he_vec3 way, he_vec3 a, he_vec3 b, double *x, double *y)
{
    double aa = he_vec3_dot(a, a), ab = he_vec3_dot(a, b), bb = he_vec3_dot(b, b);
    double wa = he_vec3_dot(way, a), wb = he_vec3_dot(way, b), square = aa * bb - ab * ab;
    *x = square > 0 ? (wa * bb - wb * ab) / square : 0;
    *y = square > 0 ? (wb * aa - wa * ab) / square : 0;
    if (!(square > 0) || *y < 0) {
        *x = aa > 0 ? wa / aa : 0;
        *y = 0;
    } else if (*x < 0) {
        *x = 0;
        *y = wb / bb;
    }
    *x = fmin(fmax(*x, 0), 1);
    *y = fmin(fmax(*y, 0), 1);
    if (*x + *y > 1) {
        he_vec3 side = he_vec3_sub(b, a);
        double along = he_vec3_dot(he_vec3_sub(way, a), side) / he_vec3_dot(side, side);
        *y = fmin(fmax(along, 0), 1);
        *x = 1 - *y;
    }
    he_vec3 missing = he_vec3_sub(way, he_vec3_add(he_vec3_scale(a, *x), he_vec3_scale(b, *y)));
    return he_vec3_dot(missing, missing);
}

/* Looks at two triangles, each made of the origin of h, a corner beside it, and the mean of the
 * face of h. If one of them is nearer to the new position `to` than *least, *out becomes the
 * mixture of its three points and *least becomes its squared distance. */
static void mix_in_face(const he_mesh *m, he_halfedge h, he_vec3 mean, he_vec3 to,
                        he_region_mix *out, double *least)
{
    const he_vertex sides[2] = {he_target(m, h), he_origin(m, he_prev(m, h))};
    he_vec3 from = he_position(m, he_origin(m, h)), middle = he_vec3_sub(mean, from);
    he_vec3 way = he_vec3_sub(to, from);
    for (unsigned i = 0; i < 2; i++) {
        he_vec3 side = he_vec3_sub(he_position(m, sides[i]), from);
        double scale = 1 / fmax(he_vec3_extent(middle), he_vec3_extent(side)), x, y;
        if (!isfinite(scale)) {
            continue;
        }
        double missing = find_in_triangle(he_vec3_scale(way, scale), he_vec3_scale(middle, scale),
                                          he_vec3_scale(side, scale), &x, &y) /
                         scale / scale;
        if (missing < *least) {
            *least = missing;
            *out = (he_region_mix){h, sides[i], x, y};
        }
    }
}

static he_status mix(const he_mesh *m, const he_region *r, const he_vec3 *to, he_region_mix *out,
                     he_error *err)
{
    he_vec3 *means = he_mem_array(NULL, r->faces.ids.count, sizeof *means);
    if (means == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory for the centres of faces");
    }
    for (size_t i = 0; i < r->faces.ids.count; i++) {
        means[i] = he_loop_mean(m, he_face_halfedge(m, (he_face){r->faces.ids.ids[i]}));
    }
    size_t k = 0;
    for (size_t i = 0; i < r->rim.count; i++) {
        double least = INFINITY;
        he_halfedge h = {r->rim.ids[i]};
        out[i] = (he_region_mix){h, he_target(m, h), 0, 0};
        mix_in_face(m, h, means[index_of(m, r, h.i)], to[i], &out[i], &least);
        for (; k < r->inner.count && r->inner_at.ids[k] == i; k++) {
            h.i = r->inner.ids[k];
            mix_in_face(m, h, means[index_of(m, r, h.i)], to[i], &out[i], &least);
        }
    }
    he_mem_free(means);
    return HE_OK;
}

he_status he_face_inset(he_mesh *m, const uint32_t *faces, size_t count, bool region,
                        he_inset_width width, he_region_parts *out, he_error *err)
{
    const double factor = width.factor, distance = width.distance;
    bool by_factor = factor < 0 || factor > 0;
    if (by_factor ? !(factor > 0 && factor < 1) : !(distance > 0)) {
        return he_fail_plain(err, HE_BAD_VALUE,
                             by_factor ? "the factor must be above 0 and below 1, not %g"
                                       : "the distance must be above 0, not %g",
                             by_factor ? factor : distance);
    }
    return he_region_draw(m, faces, count, region, (he_region_place){place, &width, mix}, out, err);
}
