#include "oracle/oracle.h"

#include <assert.h>
#include <math.h>
#include <string.h>

/* --- parts: connected sets of the listed faces, and their rims --- */

typedef struct part {
    uint32_t faces[OR_LIST];
    uint32_t count;
    bool in[OR_FACES];
    /* The directed sides on the rim of the part: side i runs from from[i] to to[i]. */
    uint32_t from[OR_LIST * 4], to[OR_LIST * 4];
    uint32_t rim;
} part;

static bool is_listed(or_region region, uint32_t f)
{
    for (uint32_t i = 0; i < region.count; i++) {
        if (region.faces[i] == f) {
            return true;
        }
    }
    return false;
}

/* Returns the corner of the face f that comes i corners after the vertex region.start[f]. */
static uint32_t corner(const or_mesh *o, or_region region, uint32_t f, uint32_t i)
{
    const or_face *face = &o->face[f];
    return face->v[(or_place(face, region.start[f]) + i) % face->count];
}

/* Finds the part that contains the face `first`: all listed faces that are connected with it,
 * breadth-first. */
static void find_part(const or_mesh *o, or_region region, uint32_t first, part *p)
{
    memset(p, 0, sizeof *p);
    p->faces[p->count++] = first;
    p->in[first] = true;
    for (uint32_t k = 0; k < p->count && region.joined; k++) {
        uint32_t f = p->faces[k];
        for (uint32_t i = 0; i < o->face[f].count; i++) {
            uint32_t g = o->left[corner(o, region, f, i + 1)][corner(o, region, f, i)];
            if (g != OR_NONE && !p->in[g] && is_listed(region, g)) {
                p->in[g] = true;
                p->faces[p->count++] = g;
            }
        }
    }
    for (uint32_t k = 0; k < p->count; k++) {
        uint32_t f = p->faces[k];
        for (uint32_t i = 0; i < o->face[f].count; i++) {
            uint32_t a = corner(o, region, f, i);
            uint32_t b = corner(o, region, f, i + 1);
            uint32_t g = o->left[b][a];
            if (g == OR_NONE || !p->in[g]) {
                p->from[p->rim] = a;
                p->to[p->rim++] = b;
            }
        }
    }
}

static uint32_t rim_place(const part *p, uint32_t v)
{
    for (uint32_t i = 0; i < p->rim; i++) {
        if (p->from[i] == v) {
            return i;
        }
    }
    return OR_NONE;
}

static bool is_done(const or_region region, uint32_t at, const bool *done)
{
    return done[region.faces[at]];
}

static uint64_t check_part(const or_mesh *o, const part *p, bool moves_inside)
{
    uint64_t refused = p->rim == 0 ? OR_BIT(HE_NO_RIM) : 0;
    for (uint32_t i = 0; i < p->rim; i++) {
        refused |= rim_place(p, p->from[i]) != i ? OR_BIT(HE_RIM_MEETS_ITSELF) : 0;
    }
    for (uint32_t k = 0; k < p->count; k++) {
        const or_face *face = &o->face[p->faces[k]];
        for (uint32_t i = 0; i < face->count; i++) {
            uint32_t a = face->v[i];
            uint32_t b = face->v[(i + 1) % face->count];
            uint32_t beyond = o->left[b][a];
            bool at_rim = rim_place(p, a) != OR_NONE;
            bool inner = beyond != OR_NONE && p->in[beyond];
            bool locked = at_rim ? face->locked : moves_inside && o->vertex[a].locked;
            locked |=
                inner && (at_rim || rim_place(p, b) != OR_NONE) && o->edge[o->joined[a][b]].locked;
            refused |= locked ? OR_BIT(HE_LOCKED_ELEMENT) : 0;
        }
    }
    return refused;
}

/* Returns twice the area vector of a face (Newell's method). */
static he_vec3 newell(const or_mesh *o, uint32_t f)
{
    const or_face *face = &o->face[f];
    he_vec3 c = o->vertex[face->v[0]].at;
    he_vec3 sum = {0, 0, 0};
    for (uint32_t i = 0; i < face->count; i++) {
        he_vec3 p = o->vertex[face->v[i]].at;
        he_vec3 q = o->vertex[face->v[(i + 1) % face->count]].at;
        p = (he_vec3){p.x - c.x, p.y - c.y, p.z - c.z};
        q = (he_vec3){q.x - c.x, q.y - c.y, q.z - c.z};
        sum.x += p.y * q.z - p.z * q.y;
        sum.y += p.z * q.x - p.x * q.z;
        sum.z += p.x * q.y - p.y * q.x;
    }
    return sum;
}

static double length_of(he_vec3 a)
{
    return sqrt(a.x * a.x + a.y * a.y + a.z * a.z);
}

static he_vec3 direction_of(const or_mesh *o, const part *p, double *length, double *total)
{
    he_vec3 sum = {0, 0, 0};
    *total = 0;
    for (uint32_t k = 0; k < p->count; k++) {
        he_vec3 a = newell(o, p->faces[k]);
        sum = (he_vec3){sum.x + a.x, sum.y + a.y, sum.z + a.z};
        *total += length_of(a);
    }
    *length = length_of(sum);
    return (he_vec3){sum.x / *length, sum.y / *length, sum.z / *length};
}

bool or_is_flat(const or_mesh *o, uint32_t f)
{
    const or_face *face = &o->face[f];
    he_vec3 one = o->vertex[face->v[0]].at;
    he_vec3 other = one;
    for (uint32_t i = 0; i < face->count; i++) {
        he_vec3 p = o->vertex[face->v[i]].at;
        if (!or_same_point(p, one) && !or_same_point(other, one) && !or_same_point(p, other)) {
            return false;
        }
        other = or_same_point(p, one) ? other : p;
    }
    return true;
}

static bool is_all_flat(const or_mesh *o, const part *p)
{
    bool flat = true;
    for (uint32_t k = 0; k < p->count; k++) {
        flat = flat && or_is_flat(o, p->faces[k]);
    }
    return flat;
}

bool or_faces_vaguely(const or_mesh *o, or_region region, bool inset)
{
    static part p;
    for (uint32_t i = 0; i < region.count; i++) {
        double length;
        double total;
        find_part(o, region, region.faces[i], &p);
        (void)direction_of(o, &p, &length, &total);
        bool clear = length > 1e-3 * total && length_of(newell(o, region.faces[i])) > 1e-3;
        if (!clear && !(or_is_flat(o, region.faces[i]) && (inset || is_all_flat(o, &p)))) {
            return true;
        }
    }
    return false;
}

/* --- separating a part --- */

static void draw_off(or_mesh *o, const part *p)
{
    uint32_t first = o->vertices;
    bool inner[OR_EDGES] = {false};
    for (uint32_t e = 0; e < o->edges; e++) {
        uint32_t f = o->left[o->edge[e].a][o->edge[e].b];
        uint32_t g = o->left[o->edge[e].b][o->edge[e].a];
        inner[e] = o->edge[e].alive && f != OR_NONE && g != OR_NONE && p->in[f] && p->in[g];
    }
    for (uint32_t i = 0; i < p->rim; i++) {
        (void)or_add_vertex(o, o->vertex[p->from[i]].at);
    }
    for (uint32_t k = 0; k < p->count; k++) {
        or_face *face = &o->face[p->faces[k]];
        for (uint32_t i = 0; i < face->count; i++) {
            uint32_t at = rim_place(p, face->v[i]);
            face->v[i] = at != OR_NONE ? first + at : face->v[i];
        }
    }
    for (uint32_t e = 0; e < o->edges; e++) {
        uint32_t a = rim_place(p, o->edge[e].a);
        uint32_t b = rim_place(p, o->edge[e].b);
        if (inner[e] && a != OR_NONE) {
            o->edge[e].a = first + a;
        }
        if (inner[e] && b != OR_NONE) {
            o->edge[e].b = first + b;
        }
    }
    for (uint32_t i = 0; i < p->rim; i++) {
        uint32_t next = rim_place(p, p->to[i]);
        const uint32_t quad[4] = {p->from[i], p->to[i], first + next, first + i};
        (void)or_add_face(o, quad, 4);
    }
}

static bool is_finite(he_vec3 a, he_vec3 b)
{
    return isfinite(a.x + b.x) && isfinite(a.y + b.y) && isfinite(a.z + b.z);
}

/* Returns the refusals that apply if the vertices of a part are moved by `by`. */
static uint64_t check_shift(const or_mesh *o, const part *p, const he_vec3 *by)
{
    uint64_t refused = by == NULL && is_all_flat(o, p) ? OR_BIT(HE_NO_NORMAL) : 0;
    for (uint32_t k = 0; k < p->count && by != NULL; k++) {
        const or_face *face = &o->face[p->faces[k]];
        for (uint32_t i = 0; i < face->count; i++) {
            refused |= is_finite(o->vertex[face->v[i]].at, *by) ? 0 : OR_BIT(HE_NOT_FINITE);
        }
    }
    return refused;
}

uint64_t or_face_extrude(or_mesh *o, or_region region, const he_vec3 *by, double distance)
{
    static part p;
    bool done[OR_FACES] = {false};
    uint64_t refused = 0;
    /* Each part is checked and moved by itself, so the order of the parts does not matter. */
    for (uint32_t k = 0; k < region.count; k++) {
        find_part(o, region, region.faces[k], &p);
        refused |= check_part(o, &p, true) | check_shift(o, &p, by);
    }
    for (uint32_t k = 0; k < region.count && refused == 0; k++) {
        if (is_done(region, k, done)) {
            continue;
        }
        find_part(o, region, region.faces[k], &p);
        double length;
        double total;
        he_vec3 shift = direction_of(o, &p, &length, &total);
        shift = (he_vec3){shift.x * distance, shift.y * distance, shift.z * distance};
        shift = by != NULL ? *by : shift;
        uint32_t first = o->vertices;
        draw_off(o, &p);
        bool moved[OR_VERTICES] = {false};
        for (uint32_t i = 0; i < p.count; i++) {
            const or_face *face = &o->face[p.faces[i]];
            done[p.faces[i]] = true;
            for (uint32_t c = 0; c < face->count; c++) {
                moved[face->v[c]] = true;
            }
        }
        assert(o->vertices == first + p.rim);
        for (uint32_t v = 0; v < o->vertices; v++) {
            if (moved[v]) {
                he_vec3 at = o->vertex[v].at;
                o->vertex[v].at = (he_vec3){at.x + shift.x, at.y + shift.y, at.z + shift.z};
                o->vertex[v].near = true;
            }
        }
        /* The new side faces are in no part yet; `left` and `joined` are computed again to include
         * these faces. */
        uint64_t wrong = or_derive(o);
        assert(wrong == 0);
        (void)wrong;
    }
    return refused;
}

/* Marks that hedge may put a vertex anywhere within a box around its old position. */
static void may_move(or_vertex *v, double reach)
{
    v->inside = true;
    v->low = (he_vec3){v->at.x - reach, v->at.y - reach, v->at.z - reach};
    v->high = (he_vec3){v->at.x + reach, v->at.y + reach, v->at.z + reach};
}

/* Returns the mean of the centroids of those faces at vertex v that belong to the part p, a set of
 * connected faces. */
static he_vec3 middle(const or_mesh *o, const part *p, uint32_t v)
{
    he_vec3 sum = {0, 0, 0};
    uint32_t n = 0;
    for (uint32_t k = 0; k < p->count; k++) {
        n += or_place(&o->face[p->faces[k]], v) != OR_NONE;
    }
    for (uint32_t k = 0; k < p->count; k++) {
        const or_face *face = &o->face[p->faces[k]];
        for (uint32_t i = 0; i < face->count && or_place(face, v) != OR_NONE; i++) {
            he_vec3 c = o->vertex[face->v[i]].at;
            sum.x += c.x / face->count / n;
            sum.y += c.y / face->count / n;
            sum.z += c.z / face->count / n;
        }
    }
    return sum;
}

/* Returns the vector from a vertex on the rim to the mean of the centroids of the part's faces at
 * this vertex. */
static he_vec3 way_inside(const or_mesh *o, const part *p, uint32_t v)
{
    he_vec3 from = o->vertex[v].at;
    he_vec3 to = middle(o, p, v);
    return (he_vec3){to.x - from.x, to.y - from.y, to.z - from.z};
}

/* Returns the refusals that apply if the rim of an inset is moved inward. */
static uint64_t check_way(const or_mesh *o, const part *p, bool by_factor)
{
    uint64_t refused = 0;
    for (uint32_t i = 0; i < p->rim; i++) {
        if (by_factor) {
            he_vec3 way = way_inside(o, p, p->from[i]);
            refused |= is_finite(way, (he_vec3){0, 0, 0}) ? 0 : OR_BIT(HE_NOT_FINITE);
        } else {
            bool flat = or_is_flat(o, o->left[p->from[i]][p->to[i]]);
            refused |= flat ? OR_BIT(HE_NO_NORMAL) : 0;
        }
    }
    return refused;
}

uint64_t or_face_inset(or_mesh *o, or_region region, double factor, double distance)
{
    static part p;
    bool done[OR_FACES] = {false};
    uint64_t refused = 0;
    for (uint32_t k = 0; k < region.count; k++) {
        find_part(o, region, region.faces[k], &p);
        refused |= check_part(o, &p, false) | check_way(o, &p, factor > 0);
    }
    if (factor == 0 && !(distance > 0)) {
        refused |= OR_BIT(HE_BAD_VALUE);
    }
    for (uint32_t k = 0; k < region.count && refused == 0; k++) {
        if (is_done(region, k, done)) {
            continue;
        }
        find_part(o, region, region.faces[k], &p);
        double reach[OR_LIST * 4];
        for (uint32_t i = 0; i < p.rim; i++) {
            he_vec3 way = way_inside(o, &p, p.from[i]);
            reach[i] = factor > 0 ? factor * length_of(way) : 4 * distance;
        }
        uint32_t first = o->vertices;
        draw_off(o, &p);
        for (uint32_t i = 0; i < p.rim; i++) {
            may_move(&o->vertex[first + i], reach[i]);
        }
        for (uint32_t i = 0; i < p.count; i++) {
            done[p.faces[i]] = true;
        }
        uint64_t wrong = or_derive(o);
        assert(wrong == 0);
        (void)wrong;
    }
    return refused;
}
