#include "geometry/flat.h"

#include <math.h>

/* Twice the area of a triangle, relative to its squared sides, under which it has none. */
static const double THIN = 1e-12;

static he_vec3 minus(he_vec3 a, he_vec3 b)
{
    return (he_vec3){a.x - b.x, a.y - b.y, a.z - b.z};
}

static he_vec3 cross(he_vec3 a, he_vec3 b)
{
    return (he_vec3){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

static double dot(he_vec3 a, he_vec3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static double largest(he_vec3 p)
{
    return fmax(fabs(p.x), fmax(fabs(p.y), fabs(p.z)));
}

/* A power of two, which may itself be no double: as two factors. */
typedef struct power {
    double one, other;
} power;

static he_vec3 scaled(he_vec3 p, power by)
{
    return (he_vec3){p.x * by.one * by.other, p.y * by.one * by.other, p.z * by.one * by.other};
}

/* What brings `size` into [0.5, 1). */
static power power_for(double size)
{
    int exponent = 0;
    (void)frexp(size, &exponent);
    return (power){ldexp(1, -exponent / 2), ldexp(1, -exponent - -exponent / 2)};
}

/* Corner i, relative to corner 0 and scaled: first so that differences are finite, then so that
 * the loop fills the unit cube. */
typedef struct frame {
    power first, second;
    he_vec3 base;
} frame;

static he_vec3 place(const he_mesh *m, const he_flat *flat, const frame *unit, uint32_t i)
{
    he_vec3 p = he_position(m, he_origin(m, (he_halfedge){flat->halfedge[i]}));
    return scaled(minus(scaled(p, unit->first), unit->base), unit->second);
}

static frame find_frame(const he_mesh *m, const he_flat *flat)
{
    frame found = {{1, 1}, {1, 1}, {0, 0, 0}};
    double size = 0;
    for (uint32_t i = 0; i < flat->n; i++) {
        size = fmax(size, largest(he_position(m, he_origin(m, (he_halfedge){flat->halfedge[i]}))));
    }
    found.first = power_for(size);
    found.base = place(m, flat, &found, 0);
    size = 0;
    for (uint32_t i = 0; i < flat->n; i++) {
        size = fmax(size, largest(place(m, flat, &found, i)));
    }
    found.second = power_for(size);
    return found;
}

static he_vec3 newell(const he_mesh *m, const he_flat *flat, const frame *unit, double *length2)
{
    he_vec3 sum = {0, 0, 0}, a = place(m, flat, unit, flat->n - 1);
    for (uint32_t i = 0; i < flat->n; i++) {
        he_vec3 b = place(m, flat, unit, i), n = cross(a, b), side = minus(b, a);
        sum = (he_vec3){sum.x + n.x, sum.y + n.y, sum.z + n.z};
        *length2 += dot(side, side);
        a = b;
    }
    return sum;
}

static void project(const he_mesh *m, he_flat *flat, const frame *unit, he_vec3 normal)
{
    double length = sqrt(dot(normal, normal));
    normal = (he_vec3){normal.x / length, normal.y / length, normal.z / length};
    /* Any direction far from the normal gives the first axis. */
    he_vec3 away = fabs(normal.x) < 0.6 ? (he_vec3){1, 0, 0} : (he_vec3){0, 1, 0};
    he_vec3 v = cross(normal, away);
    length = sqrt(dot(v, v));
    v = (he_vec3){v.x / length, v.y / length, v.z / length};
    he_vec3 u = cross(v, normal);
    for (uint32_t i = 0; i < flat->n; i++) {
        he_vec3 p = place(m, flat, unit, i);
        flat->x[i] = dot(p, u);
        flat->y[i] = dot(p, v);
    }
}

void he_flat_clear(he_flat *flat)
{
    he_mem_free(flat->memory);
    *flat = (he_flat){0};
}

he_status he_flat_init(he_flat *out, const he_mesh *m, he_halfedge first, he_error *err)
{
    he_flat flat = {.n = he_loop_length(m, first)};
    flat.memory = he_mem_zero(flat.n, 2 * sizeof *flat.x + sizeof *flat.halfedge);
    flat.x = flat.memory;
    if (flat.x == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory to triangulate a loop");
    }
    flat.y = flat.x + flat.n;
    flat.halfedge = (uint32_t *)(flat.y + flat.n);
    he_halfedge h = first;
    for (uint32_t i = 0; i < flat.n; i++, h = he_next(m, h)) {
        flat.halfedge[i] = h.i;
    }
    frame unit = find_frame(m, &flat);
    double length2 = 0;
    he_vec3 normal = newell(m, &flat, &unit, &length2);
    flat.degenerate = !(sqrt(dot(normal, normal)) > THIN * length2);
    if (!flat.degenerate) {
        project(m, &flat, &unit, normal);
    }
    *out = flat;
    return HE_OK;
}

bool he_flat_turns_left(const he_flat *f, uint32_t a, uint32_t b, uint32_t c)
{
    double abx = f->x[b] - f->x[a], aby = f->y[b] - f->y[a];
    double acx = f->x[c] - f->x[a], acy = f->y[c] - f->y[a];
    double bcx = acx - abx, bcy = acy - aby;
    double sides = abx * abx + aby * aby + acx * acx + acy * acy + bcx * bcx + bcy * bcy;
    return abx * acy - aby * acx > THIN * sides;
}
