#include "oracle/oracle.h"

#include "edit/border/bridge.h"

#include <assert.h>
#include <math.h>
#include <string.h>

static bool holds(const uint32_t *list, uint32_t n, uint32_t x)
{
    for (uint32_t i = 0; i < n; i++) {
        if (list[i] == x) {
            return true;
        }
    }
    return false;
}

static bool repeats(const uint32_t *list, uint32_t n)
{
    for (uint32_t i = 0; i < n; i++) {
        if (holds(list, i, list[i])) {
            return true;
        }
    }
    return false;
}

static bool overlap(const uint32_t *a, uint32_t n, const uint32_t *b, uint32_t m)
{
    for (uint32_t i = 0; i < n; i++) {
        if (holds(b, m, a[i])) {
            return true;
        }
    }
    return false;
}

/* --- loop_bridge --- */

static double square_apart(const or_mesh *o, uint32_t v, uint32_t w)
{
    he_vec3 p = o->vertex[v].at;
    he_vec3 q = o->vertex[w].at;
    return (p.x - q.x) * (p.x - q.x) + (p.y - q.y) * (p.y - q.y) + (p.z - q.z) * (p.z - q.z);
}

/* Tries all ways to join two loops of equal length corner by corner (one loop is rotated against
 * the other), except those in which two edges would join the same two vertices. Returns the least
 * sum of the squared lengths of the new edges, or infinity if no way is left. */
static double least_twist(const or_mesh *o, const uint32_t *a, const uint32_t *b, uint32_t n)
{
    double least = INFINITY;
    for (uint32_t s = 0; s < n; s++) {
        double sum = 0;
        bool doubled = false;
        for (uint32_t i = 0; i < n; i++) {
            uint32_t w = b[(s + n - i) % n];
            sum += square_apart(o, a[i], w);
            doubled = doubled || o->joined[a[i]][w] != OR_NONE;
            for (uint32_t k = 0; k < i; k++) {
                doubled = doubled || (a[k] == a[i] && b[(s + n - k) % n] == w);
            }
        }
        least = doubled ? least : fmin(least, sum);
    }
    return least;
}

uint64_t or_loop_bridge(or_mesh *o, const uint32_t *a, uint32_t n, const uint32_t *b, uint32_t m)
{
    if (overlap(a, n, b, m)) {
        return OR_BIT(HE_SHARED_VERTEX);
    }
    o->twist = n == m ? least_twist(o, a, b, n) : 0;
    if (o->twist == INFINITY) {
        return OR_BIT(HE_DOUBLED_EDGE);
    }
    /* Between loops of different lengths hedge chooses each triangle freely. So the oracle does not
     * know whether an edge would be doubled, nor whether hedge finds a solution within its number
     * of attempts. */
    bool can_double = false;
    for (uint32_t i = 0; i < n && n != m; i++) {
        for (uint32_t k = 0; k < m; k++) {
            can_double = can_double || o->joined[a[i]][b[k]] != OR_NONE;
        }
    }
    bool passes_twice = repeats(a, n) || repeats(b, m);
    can_double = can_double || (passes_twice && (n != m || n > HE_TWIST_TRIES));
    o->may |= can_double ? OR_BIT(HE_DOUBLED_EDGE) : 0;
    o->bridging = true;
    o->bridge[0] = (or_face){.alive = true, .count = n};
    o->bridge[1] = (or_face){.alive = true, .count = m};
    memcpy(o->bridge[0].v, a, n * sizeof *a);
    memcpy(o->bridge[1].v, b, m * sizeof *b);
    return 0;
}

static bool is_side(const or_face *loop, uint32_t a, uint32_t b)
{
    for (uint32_t i = 0; i < loop->count; i++) {
        if (loop->v[i] == a && loop->v[(i + 1) % loop->count] == b) {
            return true;
        }
    }
    return false;
}

/* Returns whether a face belongs to the strip between two loops: it has one side of each loop, or,
 * if it is a triangle, one side of one loop; its other sides connect the loops. */
static bool is_in_strip(const or_mesh *o, const or_face *f)
{
    const or_face *a = &o->bridge[0];
    const or_face *b = &o->bridge[1];
    uint32_t sides[2] = {0, 0};
    for (uint32_t i = 0; i < f->count; i++) {
        uint32_t x = f->v[i];
        uint32_t y = f->v[(i + 1) % f->count];
        if (is_side(a, x, y)) {
            sides[0]++;
        } else if (is_side(b, x, y)) {
            sides[1]++;
        } else if (holds(a->v, a->count, x) == holds(a->v, a->count, y)) {
            return false;
        }
    }
    return a->count == b->count ? f->count == 4 && sides[0] == 1 && sides[1] == 1
                                : f->count == 3 && sides[0] + sides[1] == 1;
}

/* hedge tries all ways to join two loops of equal length corner by corner. Returns whether no
 * allowed way has shorter connecting edges than the one that hedge chose. */
static bool is_least_twisted(const or_mesh *o)
{
    const or_face *a = &o->bridge[0];
    uint32_t n = a->count;
    double made = 0;
    for (uint32_t i = 0; i < n; i++) {
        uint32_t f = o->left[a->v[i]][a->v[(i + 1) % n]];
        made += square_apart(o, a->v[i], or_before(&o->face[f], a->v[i]));
    }
    return made <= o->twist + 1e-9 * (1 + o->twist);
}

bool or_strip_is_right(const or_mesh *o, uint32_t first_new)
{
    for (int k = 0; k < 2; k++) {
        const or_face *loop = &o->bridge[k];
        for (uint32_t i = 0; i < loop->count; i++) {
            uint32_t f = o->left[loop->v[i]][loop->v[(i + 1) % loop->count]];
            if (f == OR_NONE || f < first_new) {
                return false;
            }
        }
    }
    for (uint32_t f = first_new; f < o->faces; f++) {
        if (!is_in_strip(o, &o->face[f])) {
            return false;
        }
    }
    uint32_t n = o->bridge[0].count;
    return n != o->bridge[1].count || n > HE_TWIST_PAIRS || is_least_twisted(o);
}

/* --- loop_join --- */

/* Returns the vertex that v becomes when each vertex of the loop b is merged into the vertex of the
 * loop a with the same index. */
static uint32_t becomes(or_loop a, or_loop b, uint32_t v)
{
    for (uint32_t i = 0; i < b.count; i++) {
        if (b.v[i] == v) {
            return a.v[i];
        }
    }
    return v;
}

static bool is_edge_of(const or_mesh *o, or_loop loop, uint32_t e)
{
    for (uint32_t i = 0; i < loop.count; i++) {
        if (o->joined[loop.v[i]][loop.v[(i + 1) % loop.count]] == e) {
            return true;
        }
    }
    return false;
}

static uint64_t join_clashes(const or_mesh *o, or_loop a, or_loop b)
{
    const uint32_t n = a.count;
    uint64_t refused = 0;
    for (uint32_t i = 0; i < n; i++) {
        uint32_t k = (i + 1) % n;
        if (o->left[a.v[k]][a.v[i]] == OR_NONE && o->left[b.v[i]][b.v[k]] == OR_NONE) {
            refused |= OR_BIT(HE_BOUNDARY_EDGE);
        }
        for (uint32_t f = 0; f < o->faces; f++) {
            const or_face *face = &o->face[f];
            if (face->alive && f != a.face && f != b.face && or_place(face, a.v[i]) != OR_NONE &&
                or_place(face, b.v[i]) != OR_NONE) {
                refused |= OR_BIT(HE_REPEATED_CORNER);
            }
        }
    }
    or_edge after[OR_EDGES];
    for (uint32_t e = 0; e < o->edges; e++) {
        after[e].alive = o->edge[e].alive && !is_edge_of(o, b, e);
        after[e].a = becomes(a, b, o->edge[e].a);
        after[e].b = becomes(a, b, o->edge[e].b);
        for (uint32_t f = 0; f < e && after[e].alive; f++) {
            const or_edge *x = &after[e];
            const or_edge *y = &after[f];
            if (y->alive && ((x->a == y->a && x->b == y->b) || (x->a == y->b && x->b == y->a))) {
                refused |= OR_BIT(HE_DOUBLED_EDGE);
            }
        }
    }
    return refused;
}

static bool join_is_locked(const or_mesh *o, or_loop a, or_loop b)
{
    const uint32_t n = a.count;
    bool locked = (a.face != OR_NONE && o->face[a.face].locked) ||
                  (b.face != OR_NONE && o->face[b.face].locked);
    for (uint32_t i = 0; i < n; i++) {
        locked = locked || o->vertex[b.v[i]].locked ||
                 (o->vertex[a.v[i]].locked &&
                  !or_same_point(o->vertex[a.v[i]].at, o->vertex[b.v[i]].at));
    }
    for (uint32_t e = 0; e < o->edges; e++) {
        locked = locked || (o->edge[e].alive && o->edge[e].locked &&
                            (holds(b.v, n, o->edge[e].a) || holds(b.v, n, o->edge[e].b)));
    }
    for (uint32_t f = 0; f < o->faces; f++) {
        const or_face *face = &o->face[f];
        locked = locked || (face->alive && face->locked && overlap(face->v, face->count, b.v, n));
    }
    return locked;
}

uint64_t or_loop_join(or_mesh *o, or_loop a, or_loop b)
{
    const uint32_t n = a.count;
    uint64_t refused = 0;
    refused |= repeats(a.v, n) || repeats(b.v, n) ? OR_BIT(HE_REPEATED_CORNER) : 0;
    refused |= overlap(a.v, n, b.v, n) ? OR_BIT(HE_SHARED_VERTEX) : 0;
    if (refused != 0) {
        return refused;
    }
    refused = join_clashes(o, a, b);
    refused |= join_is_locked(o, a, b) ? OR_BIT(HE_LOCKED_ELEMENT) : 0;
    if (refused != 0) {
        return refused;
    }
    for (uint32_t e = 0; e < o->edges; e++) {
        o->edge[e].alive = o->edge[e].alive && !is_edge_of(o, b, e);
        o->edge[e].a = becomes(a, b, o->edge[e].a);
        o->edge[e].b = becomes(a, b, o->edge[e].b);
    }
    for (uint32_t f = 0; f < o->faces; f++) {
        or_face *face = &o->face[f];
        face->alive = face->alive && f != a.face && f != b.face;
        for (uint32_t i = 0; i < face->count; i++) {
            face->v[i] = becomes(a, b, face->v[i]);
        }
    }
    for (uint32_t i = 0; i < n; i++) {
        he_vec3 p = o->vertex[a.v[i]].at;
        he_vec3 q = o->vertex[b.v[i]].at;
        o->vertex[a.v[i]].at = (he_vec3){(p.x + q.x) / 2, (p.y + q.y) / 2, (p.z + q.z) / 2};
        o->vertex[a.v[i]].near = true;
        o->vertex[b.v[i]].alive = false;
    }
    return 0;
}

/* --- loop_split --- */

bool or_find_cycle(const or_mesh *o, const uint32_t e[3], uint32_t cycle[3])
{
    const or_edge *x = &o->edge[e[0]];
    for (int k = 1; k < 3; k++) {
        const or_edge *y = &o->edge[e[k]];
        const or_edge *z = &o->edge[e[3 - k]];
        uint32_t w = y->a == x->b ? y->b : y->b == x->b ? y->a : OR_NONE;
        bool closes = (z->a == w && z->b == x->a) || (z->b == w && z->a == x->a);
        if (w != OR_NONE && w != x->a && closes) {
            cycle[0] = x->a;
            cycle[1] = x->b;
            cycle[2] = w;
            return true;
        }
    }
    return false;
}

uint64_t or_loop_split(or_mesh *o, const uint32_t e[3])
{
    uint32_t u[3];
    uint32_t faces[6];
    if (!or_find_cycle(o, e, u)) {
        return OR_BIT(HE_NOT_A_CYCLE);
    }
    for (int i = 0; i < 3; i++) {
        if (or_on_boundary(o, u[i])) {
            return OR_BIT(HE_BOUNDARY_VERTEX);
        }
        faces[i] = o->left[u[i]][u[(i + 1) % 3]];
        faces[3 + i] = o->left[u[(i + 1) % 3]][u[i]];
    }
    if (repeats(faces, 6)) {
        return OR_BIT(HE_SHARED_FACE);
    }
    /* `beyond` holds the neighbours and `around` the faces of each corner of the cycle on the right
     * of the cycle, counter-clockwise from the corner before it to the corner after it. */
    uint32_t beyond[3][OR_VERTICES];
    uint32_t around[3][OR_VERTICES];
    uint32_t count[3];
    bool locked = false;
    for (int i = 0; i < 3; i++) {
        uint32_t x = u[(i + 2) % 3];
        for (count[i] = 0; x != u[(i + 1) % 3]; count[i]++) {
            around[i][count[i]] = o->left[u[i]][x];
            locked = locked || o->face[o->left[u[i]][x]].locked;
            x = or_turn(o, u[i], x);
            beyond[i][count[i]] = x;
            locked = locked || (x != u[(i + 1) % 3] && o->edge[o->joined[u[i]][x]].locked);
        }
    }
    if (locked) {
        return OR_BIT(HE_LOCKED_ELEMENT);
    }
    uint32_t new[3];
    for (int i = 0; i < 3; i++) {
        new[i] = or_add_vertex(o, o->vertex[u[i]].at);
        for (uint32_t k = 0; k < count[i]; k++) {
            or_face *f = &o->face[around[i][k]];
            f->v[or_place(f, u[i])] = new[i];
        }
        for (uint32_t k = 0; k + 1 < count[i]; k++) {
            or_edge *edge = &o->edge[o->joined[u[i]][beyond[i][k]]];
            *(edge->a == u[i] ? &edge->a : &edge->b) = new[i];
        }
    }
    (void)or_add_face(o, (uint32_t[]){u[1], u[0], u[2]}, 3);
    (void)or_add_face(o, new, 3);
    return 0;
}

/* --- plane_cut --- */

bool or_face_is_above(const or_mesh *o, uint32_t f, he_vec3 normal)
{
    const or_face *face = &o->face[f];
    double up = 0;
    for (uint32_t i = 0; i < face->count; i++) {
        if (o->distance[face->v[i]] != 0) {
            return o->distance[face->v[i]] > 0;
        }
        he_vec3 p = o->vertex[face->v[i]].at;
        he_vec3 q = o->vertex[face->v[(i + 1) % face->count]].at;
        up += normal.x * (p.y * q.z - p.z * q.y) + normal.y * (p.z * q.x - p.x * q.z) +
              normal.z * (p.x * q.y - p.y * q.x);
    }
    return up <= 0;
}
