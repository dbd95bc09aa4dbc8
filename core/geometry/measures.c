#include "geometry/geometry.h"
#include "geometry/ring.h"
#include "mesh/walk.h"

static void extend(he_box *box, bool *any, he_vec3 p)
{
    if (!*any) {
        box->min = box->max = p;
        *any = true;
    }
    he_vec3 low = box->min, high = box->max;
    box->min =
        (he_vec3){p.x < low.x ? p.x : low.x, p.y < low.y ? p.y : low.y, p.z < low.z ? p.z : low.z};
    box->max = (he_vec3){p.x > high.x ? p.x : high.x, p.y > high.y ? p.y : high.y,
                         p.z > high.z ? p.z : high.z};
}

/* Finds the box around all live vertices. Isolated vertices (without an edge) count only if
 * `isolated` is true. */
static bool find_box(const he_mesh *m, bool isolated, he_box *out)
{
    he_box box = {{0, 0, 0}, {0, 0, 0}};
    bool any = false;
    for (uint32_t v = 0; v < m->c.vertices.issued; v++) {
        uint32_t h = m->c.vertex_halfedge[v];
        if (h != HE_DEAD && (isolated || h != HE_NONE)) {
            extend(&box, &any, m->c.position[v]);
        }
    }
    *out = box;
    return any;
}

bool he_mesh_box(const he_mesh *m, he_box *out)
{
    return find_box(m, true, out);
}

bool he_surface_box(const he_mesh *m, he_box *out)
{
    return find_box(m, false, out);
}

/* A sum by Neumaier's method: the rounding errors of the additions are summed up separately. */
typedef struct total {
    double sum, error;
} total;

static void add(total *t, double x)
{
    double sum = t->sum + x;
    t->error += fabs(t->sum) >= fabs(x) ? (t->sum - sum) + x : (x - sum) + t->sum;
    t->sum = sum;
}

/* Terms of very different sizes are summed up in several totals, so that small terms are not lost
 * beside large ones. The binary exponents from LEAST on are divided into WINDOWS ranges (windows)
 * of WINDOW exponents; terms whose exponents are in one window share a total. The windows cover the
 * exponents of all volumes, which are products of three doubles. */
enum { WINDOW = 256, LEAST = -14 * WINDOW, WINDOWS = 28 };

typedef struct sums {
    /* a total for each window i; the true total is of[i] * 2^(LEAST + WINDOW * i) */
    total of[WINDOWS];
} sums;

/* Adds the term x * 2^exponent to the total of the window in which the term's exponent lies. */
static void add_scaled(sums *s, double x, int exponent)
{
    int own;
    double part = frexp(x, &own);
    if (part == 0) {
        return;
    }
    int above = own + exponent - LEAST;
    int window = above < 0 ? 0 : above / WINDOW < WINDOWS ? above / WINDOW : WINDOWS - 1;
    add(&s->of[window], ldexp(part, above - window * WINDOW));
}

/* Returns the sum of the totals in `s` and of the total `plain`, divided by `divisor`. A result
 * that is too large for a double becomes DBL_MAX or -DBL_MAX. */
static double sum_of(sums *s, const total *plain, double divisor)
{
    add_scaled(s, plain->sum, 0);
    add_scaled(s, plain->error, 0);
    int top = WINDOWS - 1;
    while (top > 0 && s->of[top].sum + s->of[top].error == 0) {
        top--;
    }
    total all = {0, 0};
    for (int i = top, down = 0; i >= 0; i--, down -= WINDOW) {
        add(&all, ldexp(s->of[i].sum, down));
        add(&all, ldexp(s->of[i].error, down));
    }
    return he_clamped(ldexp((all.sum + all.error) / divisor, LEAST + top * WINDOW));
}

/* Finds the base point of the volume. The volume of the mesh is the sum of the volumes of the cones
 * from this point to each face. The base point is the vertex with edges that is nearest to the
 * origin of coordinates, where a mesh may have its smallest parts. If the base point were far from
 * a small part, the large volumes of the cones to that part would cancel out and lose digits. */
static he_vec3 find_base(const he_mesh *m)
{
    double least = HUGE_VAL;
    bool any = false;
    he_vec3 base = {0, 0, 0};
    for (uint32_t v = 0; v < m->c.vertices.issued; v++) {
        if (m->c.vertex_halfedge[v] < HE_DEAD) {
            he_vec3 p = m->c.position[v];
            /* The squared distance may overflow to infinity; a vertex with a finite one is
             * preferred. */
            double square = he_vec3_dot(p, p);
            if (square < least || !any) {
                least = square;
                base = p;
                any = true;
            }
        }
    }
    return base;
}

/* Adds six times the volume of the cone from the point `base` to a face. `corner` is the position
 * of a corner of the face. `vector` is twice the face's area vector in a scale of its own: the true
 * vector is `vector` * 4^exponent. */
static void add_cone(sums *volume, he_vec3 base, he_vec3 corner, he_vec3 vector, int exponent)
{
    int halved = 0;
    he_vec3 way = he_vec3_sub(corner, base);
    if (!he_vec3_is_finite(way)) {
        way = he_vec3_sub(he_vec3_scale(corner, 0.5), he_vec3_scale(base, 0.5));
        halved = 1;
    }
    int own = he_exponent_of(he_vec3_extent(way));
    double term = he_vec3_dot(he_vec3_scale(way, ldexp(1, -own)), vector);
    add_scaled(volume, term, own + halved + 2 * exponent);
}

he_status he_mesh_measure(const he_mesh *m, he_measures *out, he_error *err)
{
    sums area = {0}, volume = {0};
    /* Sums of the terms that are neither very large nor very small, so that they need no window. */
    total plain_area = {0, 0}, plain_volume = {0, 0};
    uint32_t budget = he_ring_budget(m);
    bool closed = m->c.boundary_halfedges == 0 && m->c.faces.live > 0;
    he_vec3 base = closed ? find_base(m) : (he_vec3){0, 0, 0};
    he_status status = he_progress_phase(m->progress, "measuring", 1, err);
    for (uint32_t f = 0; f < m->c.faces.issued; f++) {
        if (status == HE_OK) {
            status = he_progress_at(m->progress, f, m->c.faces.issued, err);
        }
        if (status != HE_OK) {
            return status;
        }
        if (!he_face_is_live(m, (he_face){f})) {
            continue;
        }
        int exponent;
        uint32_t first = m->c.face_halfedge[f];
        he_ring r = he_ring_measure(m, first, &budget, &exponent);
        if (r.degree == 0) {
            return he_ring_corrupt(f, err);
        }
        double twice = he_vec3_length(r.vector);
        if (exponent == 0) {
            add(&plain_area, twice);
        } else {
            add_scaled(&area, twice, 2 * exponent);
        }
        /* The face is divided into a fan of triangles from its corner p0. Each triangle and the
         * base point b make a tetrahedron. The volumes of these tetrahedra add up to a third of the
         * dot product of p0 - b and the area vector of the face, because p0 is a corner of every
         * triangle. */
        if (!closed) {
            continue;
        }
        he_vec3 corner = m->c.position[m->c.origin[first]];
        double six = he_vec3_dot(he_vec3_sub(corner, base), r.vector);
        if (exponent == 0 && fabs(six) > HE_LEAST_PRODUCT && fabs(six) < HE_MOST_PRODUCT) {
            add(&plain_volume, six);
        } else {
            add_cone(&volume, base, corner, r.vector, exponent);
        }
    }
    out->area = sum_of(&area, &plain_area, 2);
    out->has_volume = closed;
    out->volume = closed ? sum_of(&volume, &plain_volume, 6) : 0;
    return HE_OK;
}
