/* remesh_flip.c - flips edges. */
#include "remesh/remeshing.h"

/* The four vertices of the two triangles beside an edge, which runs from a to b; c is to its left,
 * d to its right. */
typedef struct kite {
    uint32_t a, b, c, d;
} kite;

/* Returns by how many edges a vertex has more than the ideal. */
static int excess(const he_net *n, uint32_t v)
{
    return (int)n->vertices[v].degree - (int)n->vertices[v].ideal;
}

/* Returns true if a flip brings the degrees nearer to the ideal: if the sum of the squares of the
 * excesses, of which two fall and two rise by one, becomes less. */
static bool evens_degrees(const he_net *n, const kite *k)
{
    return excess(n, k->a) + excess(n, k->b) - excess(n, k->c) - excess(n, k->d) > 2;
}

/* Returns true if a vertex keeps enough edges when it loses one. */
static bool can_lose(const he_net *n, uint32_t v)
{
    return n->vertices[v].degree > (he_net_has(n, v, HE_NET_BORDER) ? 2 : 3);
}

/* Returns true if an edge joins two vertices, or if that cannot be found out in a few steps. */
static bool are_joined(const he_net *n, uint32_t c, uint32_t d)
{
    he_net_ring ring;
    bool first = n->vertices[c].degree <= n->vertices[d].degree;
    uint32_t v = he_net_can_turn(n, c) && (first || !he_net_can_turn(n, d)) ? c : d;
    if (!he_net_turn(n, v, &ring)) {
        return true;
    }
    for (uint32_t i = 0; i < ring.count; i++) {
        if (ring.vertex[i] == (v == c ? d : c)) {
            return true;
        }
    }
    return false;
}

/* A flip for the degrees may not make triangles whose roundness is below both this and the
 * roundness of the triangles before. */
static const double LEAST_ROUND = 0.25;

/* Returns true if the angles at c and d, opposite the edge from a to b, add up to more than pi:
 * then the sum of their cotangents is negative. */
static bool is_crooked(he_vec3 a, he_vec3 b, he_vec3 c, he_vec3 d)
{
    he_vec3 ca = he_vec3_sub(a, c), cb = he_vec3_sub(b, c);
    he_vec3 da = he_vec3_sub(a, d), db = he_vec3_sub(b, d);
    double at_c = he_vec3_dot(ca, cb), at_d = he_vec3_dot(da, db);
    if (at_c >= 0 && at_d >= 0) {
        return false;
    }
    double left = he_vec3_length(he_vec3_cross(ca, cb));
    double right = he_vec3_length(he_vec3_cross(da, db));
    return at_c * right + at_d * left < -1e-9 * (left * right);
}

static bool is_wanted(const he_net *n, const kite *k, he_flip_aim aim)
{
    if (aim == HE_FLIP_DEGREES && !evens_degrees(n, k)) {
        return false;
    }
    he_vec3 a = he_net_place(n, k->a), b = he_net_place(n, k->b);
    he_vec3 c = he_net_place(n, k->c), d = he_net_place(n, k->d);
    if (aim == HE_FLIP_ANGLES && !is_crooked(a, b, c, d)) {
        return false;
    }
    he_roundness left = he_roundness_of(a, b, c), right = he_roundness_of(b, a, d);
    he_roundness fore = he_roundness_of(d, c, a), back = he_roundness_of(c, d, b);
    he_roundness before = left, after = fore;
    he_roundness_lower(&before, &right);
    he_roundness_lower(&after, &back);
    bool rounder = he_roundness_is_less(&before, &after);
    if (!rounder && (aim == HE_FLIP_ANGLES || he_roundness_is_below(&after, LEAST_ROUND))) {
        return false;
    }
    he_vec3 old = he_vec3_add(left.area, right.area);
    return he_remesh_agree(left.area, right.area) && he_remesh_agree(old, fore.area) &&
           he_remesh_agree(old, back.area);
}

static void take_edge(he_net *n, uint32_t to, uint32_t twin, uint32_t h, uint32_t marks)
{
    he_net_pair(n, to, twin);
    n->ids[to >> 2].halfedge[to & 3] = h;
    he_net_set_edge_marks(n, to, marks);
}

static void replace_corner(he_net *n, uint32_t v, const uint32_t lost[2], uint32_t other)
{
    if (n->corner[v] == lost[0] || n->corner[v] == lost[1]) {
        n->corner[v] = other;
    }
}

/* Flips the edge of corner e, which turns counter-clockwise: it runs from d to c afterwards. */
static void flip(he_net *n, uint32_t e, const kite *k)
{
    uint32_t twin = he_net_twin(n, e);
    uint32_t from_b = he_net_next(e), from_c = he_net_prev(e);
    uint32_t from_a = he_net_next(twin), from_d = he_net_prev(twin);
    uint32_t side[4] = {from_b, from_c, from_a, from_d}, beside[4], h[4], marks[4];
    for (unsigned i = 0; i < 4; i++) {
        beside[i] = he_net_twin(n, side[i]);
        h[i] = he_net_halfedge(n, side[i]);
        marks[i] = he_net_edge_marks(n, side[i]);
    }
    uint32_t *left = n->triangles[e >> 2].v, *right = n->triangles[twin >> 2].v;
    left[e & 3] = k->d;
    left[from_b & 3] = k->c;
    left[from_c & 3] = k->a;
    right[twin & 3] = k->c;
    right[from_a & 3] = k->d;
    right[from_d & 3] = k->b;
    take_edge(n, from_b, beside[1], h[1], marks[1]);
    take_edge(n, from_c, beside[2], h[2], marks[2]);
    take_edge(n, from_a, beside[3], h[3], marks[3]);
    take_edge(n, from_d, beside[0], h[0], marks[0]);
    replace_corner(n, k->c, (uint32_t[2]){from_c, from_c}, from_b);
    replace_corner(n, k->d, (uint32_t[2]){from_d, from_d}, from_a);
    replace_corner(n, k->a, (uint32_t[2]){e, from_a}, from_c);
    replace_corner(n, k->b, (uint32_t[2]){twin, from_b}, from_d);
    he_net_add_degree(n, k->a, -1);
    he_net_add_degree(n, k->b, -1);
    he_net_add_degree(n, k->c, 1);
    he_net_add_degree(n, k->d, 1);
}

static bool try_flip(he_net *n, uint32_t e, he_flip_aim aim)
{
    uint32_t twin = he_net_twin(n, e);
    kite k = {he_net_origin(n, e), he_net_origin(n, twin), he_net_opposite(n, e),
              he_net_opposite(n, twin)};
    if (k.c == k.d || !can_lose(n, k.a) || !can_lose(n, k.b) || !is_wanted(n, &k, aim) ||
        are_joined(n, k.c, k.d)) {
        return false;
    }
    flip(n, e, &k);
    return true;
}

/* Returns true if something has changed around a corner of a triangle. */
static bool is_restless(const he_net *n, uint32_t t)
{
    const uint32_t *v = n->triangles[t].v;
    return ((n->vertices[v[0]].flags | n->vertices[v[1]].flags | n->vertices[v[2]].flags) &
            HE_NET_RESTLESS) != 0;
}

/* What a sweep over the triangles does. `changed` has the triangles that were flipped since they
 * were looked at. */
typedef struct sweep {
    he_flip_aim aim;
    bool first;
    uint64_t *changed;
    uint64_t flips;
} sweep;

static void try_edge(he_net *n, uint32_t c, sweep *s)
{
    const uint32_t twin = he_net_twin(n, c);
    if (!he_net_is_held(n, c) && try_flip(n, c, s->aim)) {
        he_bits_set(s->changed, c >> 2);
        he_bits_set(s->changed, twin >> 2);
        s->flips++;
    }
}

/* Returns true if edges of a triangle are to be tested. For even angles, only a flip of one of its
 * edges changes what the test of the last sweep found. */
static bool looks_at(const he_net *n, uint32_t t, sweep *s)
{
    if (he_net_is_gone(n, t)) {
        return false;
    }
    if (s->aim == HE_FLIP_DEGREES) {
        return is_restless(n, t);
    }
    const bool looks = s->first || he_bits_get(s->changed, t);
    s->changed[t >> 6] &= ~((uint64_t)1 << (t & 63));
    return looks;
}

he_status he_remesh_flip(he_remeshing *r, he_flip_aim aim, unsigned sweeps, he_error *err)
{
    he_net *n = &r->net;
    sweep s = {.aim = aim, .changed = he_bits_new((size_t)n->triangle_count + 1), .flips = 1};
    he_status status = s.changed == NULL
                           ? he_fail_plain(err, HE_NO_MEMORY, "no memory to flip edges of %u faces",
                                           n->triangle_count)
                           : HE_OK;
    for (unsigned i = 0; i < sweeps && s.flips > 0 && status == HE_OK; i++) {
        s.flips = 0;
        s.first = i == 0;
        for (uint32_t t = 0; t < n->triangle_count && status == HE_OK; t++) {
            status = he_progress_at(r->progress, t + 1, n->triangle_count, err);
            if (!looks_at(n, t, &s)) {
                continue;
            }
            const bool once = s.first || aim == HE_FLIP_DEGREES;
            for (uint32_t c = 4 * t; c < 4 * t + 3; c++) {
                const uint32_t twin = he_net_twin(n, c);
                if (twin != HE_NONE && (c < twin || !once)) {
                    try_edge(n, c < twin ? c : twin, &s);
                }
            }
        }
        r->changes += s.flips;
    }
    he_mem_free(s.changed);
    return status;
}
