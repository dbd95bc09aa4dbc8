/* remesh_split.c - splits edges that are too long. */
#include "remesh/net_make.h"
#include "remesh/remeshing.h"

/* Makes the vertex in the middle of the edge of corner c. On a line, it is the middle of that part
 * of the line for which the edge stands. */
static uint32_t make_vertex(he_net *n, uint32_t c)
{
    uint32_t a = he_net_origin(n, c), b = he_net_target(n, c), ground = n->ground[a];
    uint32_t line = he_net_line_of(n, c);
    bool border = he_net_twin(n, c) == HE_NONE;
    he_vec3 place = he_vec3_scale(he_vec3_add(he_net_place(n, a), he_net_place(n, b)), 0.5);
    double arc = 0;
    if (line != HE_NONE) {
        arc = 0.5 * (he_net_line_arc(n, line, a) + he_net_line_arc(n, line, b));
        place = he_net_line_place(n, line, arc, &ground);
    }
    uint32_t v = he_net_new_vertex(n, place);
    he_net_vertex *to = &n->vertices[v];
    to->size = 0.5F * (n->vertices[a].size + n->vertices[b].size);
    to->degree = border ? 3 : 4;
    to->ideal = border ? 4 : 6;
    to->flags |= line != HE_NONE ? HE_NET_LINE : HE_NET_LOOSE;
    to->flags |= border ? HE_NET_BORDER : 0;
    n->ground[v] = ground;
    if (n->arc != NULL) {
        n->arc[v] = arc;
    }
    return v;
}

/* Adds a triangle, whose corners have no twins, ids and marks yet. Returns its first corner. */
static uint32_t add_triangle(he_net *n, uint32_t a, uint32_t b, uint32_t c)
{
    uint32_t t = n->triangle_count++;
    n->triangles[t] = (he_net_triangle){{a, b, c}, 0, {HE_NONE, HE_NONE, HE_NONE}, 0};
    n->ids[t].face = HE_NONE;
    n->live_triangles++;
    return 4 * t;
}

/* Moves the twin, the id and the marks of the edge of corner `from` to corner `to`. */
static void move_edge(he_net *n, uint32_t to, uint32_t from)
{
    he_net_pair(n, to, he_net_twin(n, from));
    n->ids[to >> 2].halfedge[to & 3] = he_net_halfedge(n, from);
    he_net_set_edge_marks(n, to, he_net_edge_marks(n, from));
}

/* Makes two corners twins by a new edge inside a face. */
static void join(he_net *n, uint32_t a, uint32_t b)
{
    uint32_t h = he_net_new_edge(n, HE_NONE);
    he_net_pair(n, a, b);
    n->ids[a >> 2].halfedge[a & 3] = h;
    n->ids[b >> 2].halfedge[b & 3] = h + 1;
    he_net_set_edge_marks(n, a, 0);
    he_net_set_edge_marks(n, b, 0);
}

/* Splits the edge of corner c, from a to b, at the new vertex w:
 *
 *           o z                        o z
 *         /   \                      / | \
 *       /   t   \                  / t | t1\
 *   a o-----c-----o b   --->   a o-----w-----o b
 *       \   u   /                  \ u | u1/
 *         \   /                      \ | /
 *           o x                        o x
 *
 * There must be room. */
static void split(he_net *n, uint32_t c)
{
    uint32_t next = he_net_next(c), before = he_net_prev(c), twin = he_net_twin(n, c);
    uint32_t b = he_net_origin(n, next), z = he_net_origin(n, before);
    uint32_t w = make_vertex(n, c), h = he_net_halfedge(n, c);
    uint32_t half = he_net_new_edge(n, he_net_parent(n, h >> 1)) | (h & 1);
    if (n->line != NULL) {
        n->line[half >> 1] = n->line[h >> 1];
    }
    uint32_t t1 = add_triangle(n, w, b, z);
    n->triangles[t1 >> 2].v[0] = w;
    n->triangles[c >> 2].v[next & 3] = w;
    move_edge(n, t1 + 1, next);
    join(n, next, t1 + 2);
    n->ids[t1 >> 2].halfedge[0] = half;
    he_net_set_edge_marks(n, t1, he_net_edge_marks(n, c));
    if (n->corner[b] == next) {
        n->corner[b] = t1 + 1;
    }
    n->corner[w] = t1;
    he_net_add_degree(n, z, 1);
    if (twin == HE_NONE) {
        return;
    }
    uint32_t last = he_net_prev(twin), x = he_net_origin(n, last);
    uint32_t u1 = add_triangle(n, b, w, x);
    n->triangles[twin >> 2].v[twin & 3] = w;
    move_edge(n, u1 + 2, last);
    join(n, last, u1 + 1);
    he_net_pair(n, t1, u1);
    n->ids[u1 >> 2].halfedge[0] = half ^ 1;
    he_net_set_edge_marks(n, u1, he_net_edge_marks(n, c));
    if (n->corner[b] == twin) {
        n->corner[b] = u1;
    }
    if (n->corner[x] == last) {
        n->corner[x] = u1 + 2;
    }
    he_net_add_degree(n, x, 1);
}

/* Returns the square of an edge's length divided by the square of the wanted length. */
static double ratio(const he_net *n, uint32_t a, uint32_t b)
{
    const he_net_vertex *from = &n->vertices[a], *to = &n->vertices[b];
    double size = (double)(from->size < to->size ? from->size : to->size);
    return he_remesh_square(from->p, to->p) / (size * size);
}

/* Returns true if the edge of a corner may be split: it is not frozen, and the triangles beside it
 * have different opposite vertices, which two new edges will join with the new one. */
static bool can_split(const he_net *n, uint32_t c)
{
    uint32_t twin = he_net_twin(n, c);
    return !he_net_is_frozen(n, c) &&
           (twin == HE_NONE || he_net_opposite(n, c) != he_net_opposite(n, twin));
}

/* Finds the corner at the longest edge of a triangle; *longest is its ratio. */
static uint32_t longest_of(const he_net *n, uint32_t t, double *longest)
{
    const uint32_t *v = n->triangles[t].v;
    uint32_t found = 0;
    *longest = -1;
    for (uint32_t i = 0; i < 3; i++) {
        double own = ratio(n, v[i], v[i == 2 ? 0 : i + 1]);
        if (own > *longest) {
            *longest = own;
            found = i;
        }
    }
    return 4 * t + found;
}

/* Ratios that differ by less than this factor count as equal. */
static const double EQUAL = 1 + 1e-9;
/* The number of triangles after which the search for an edge that may be split is given up. */
enum { HOPS = 64 };

/* Finds the edge to split so that triangle t may lose its longest edge: an edge that is the longest
 * one of both its triangles, reached from t by going to the triangle beside the longest edge again
 * and again (M.-C. Rivara, "New longest-edge algorithms for the refinement and/or improvement of
 * unstructured triangulations", 1997). Returns HE_NONE if the longest edge of t is not longer than
 * `most`, or if the edge that was found may not be split.
 *
 * Without this rule, the triangles beside a long frozen edge would be split without end: two of
 * their edges together are always longer than that edge. */
static uint32_t edge_to_split(const he_net *n, uint32_t t, double most)
{
    double longest, beside;
    uint32_t c = longest_of(n, t, &longest);
    if (longest <= most) {
        return HE_NONE;
    }
    for (unsigned hop = 0; hop < HOPS; hop++) {
        uint32_t twin = he_net_twin(n, c);
        uint32_t other = twin == HE_NONE ? HE_NONE : longest_of(n, twin >> 2, &beside);
        if (twin == HE_NONE || beside <= longest * EQUAL) {
            return can_split(n, c) ? c : HE_NONE;
        }
        c = other;
        longest = beside;
    }
    return HE_NONE;
}

/* Splits edges until triangle t has no edge that is longer than `most` (a ratio) and may be
 * split. */
static he_status split_triangle(he_remeshing *r, uint32_t t, double most, he_error *err)
{
    he_net *n = &r->net;
    for (;;) {
        uint32_t c = edge_to_split(n, t, most);
        if (c == HE_NONE) {
            return HE_OK;
        }
        he_status status = he_net_reserve(n, err);
        if (status != HE_OK) {
            return status;
        }
        split(n, c);
        r->changes++;
    }
}

/* Finds the longest edge that may be split, as a ratio. */
static double find_longest(const he_net *n)
{
    double longest = 0;
    for (uint32_t t = 0; t < n->triangle_count; t++) {
        const he_net_triangle *of = &n->triangles[t];
        for (unsigned i = 0; i < 3 && (of->marks & HE_NET_GONE) == 0; i++) {
            double own = ratio(n, of->v[i], of->v[i == 2 ? 0 : i + 1]);
            if (own > longest && can_split(n, 4 * t + i)) {
                longest = own;
            }
        }
    }
    return longest;
}

he_status he_remesh_split(he_remeshing *r, bool rounds, he_error *err)
{
    he_net *n = &r->net;
    const double least = HE_REMESH_LONG * HE_REMESH_LONG;
    double most = least, longest = rounds ? find_longest(n) : 0;
    he_status status = HE_OK;
    while (most * 4 < longest) {
        most *= 4;
    }
    for (; most >= least && status == HE_OK; most /= 4) {
        for (uint32_t t = 0; t < n->triangle_count && status == HE_OK; t++) {
            status = he_progress_at(r->progress, t + 1, n->triangle_count, err);
            if (status == HE_OK && !he_net_is_gone(n, t)) {
                status = split_triangle(r, t, most, err);
            }
        }
    }
    return status;
}
