/* remesh_collapse.c - collapses edges that are too short. */
#include "remesh/net_make.h"
#include "remesh/remeshing.h"

/* A part of a line may be replaced by a straight edge that is nowhere farther from it than this
 * fraction of the wanted length. */
static const double BULGE = 0.1;
/* The collapse of an edge without length may make edges that are longer than the limit by this
 * fraction. */
static const double SLACK = 0.3;
/* A collapse may not make a triangle whose roundness is below both this and the least roundness of
 * the triangles before. */
static const double LEAST_ROUND = 0.05;

/* Flags of vertices that a collapse does not move. */
enum { STILL = HE_NET_FIXED | HE_NET_LINE };

/* A collapse of the edge of corner c: vertex u is removed; v stays.
 *
 *           w o                     If u is the target of c, there is no other triangle: then the
 *           /   \                   figure is that for an edge on a border, reflected.
 *   gone  /       \  kept
 *       /           \
 *   u o------c-------o v
 *       \           /
 *   gone  \       /  kept
 *           \   /
 *           x o
 */
typedef struct removal {
    uint32_t c, u, v;
    uint32_t w, x;       /* the vertices opposite the edge; x is HE_NONE on a border */
    uint32_t gone, kept; /* corners of the triangle of c at the sides u-w and v-w */
    he_net_ring ring;    /* around u */
    he_net_ring about;   /* around v; empty if v cannot be walked around */
    bool moves;          /* v moves to the middle of the edge */
} removal;

/* How one end of a collapsed edge moves. */
typedef struct moving {
    he_vec3 from, to;
    double size; /* the wanted length of edges at v */
    double most; /* no edge may become longer than this many wanted lengths */
} moving;

/* Returns true if vertex v is adjacent to w, which can be walked around. */
static bool is_beside(const he_net *n, uint32_t w, uint32_t v)
{
    he_net_ring ring;
    if (!he_net_turn(n, w, &ring)) {
        return true;
    }
    for (uint32_t i = 0; i < ring.count; i++) {
        if (ring.vertex[i] == v) {
            return true;
        }
    }
    return false;
}

/* Checks that the only common neighbours of u and v are opposite corners of the edge: then no two
 * edges join the same two vertices after the collapse. If it is not possible to walk around v, its
 * neighbours are asked instead. */
static bool are_links_good(const he_net *n, const removal *e)
{
    bool can = e->about.count > 0;
    for (uint32_t i = 0; i < e->ring.count; i++) {
        uint32_t other = e->ring.vertex[i];
        if (other == e->v || other == e->w || other == e->x) {
            continue;
        }
        if (!can) {
            if (is_beside(n, other, e->v)) {
                return false;
            }
            continue;
        }
        for (uint32_t k = 0; k < e->about.count; k++) {
            if (e->about.vertex[k] == other) {
                return false;
            }
        }
    }
    return true;
}

/* Returns true if a vertex opposite the collapsed edge keeps enough edges. */
static bool can_lose(const he_net *n, uint32_t vertex)
{
    return vertex == HE_NONE ||
           n->vertices[vertex].degree > (he_net_has(n, vertex, HE_NET_BORDER) ? 2 : 3);
}

/* Checks two sides of a triangle, which become one edge. */
static bool can_close(const he_net *n, uint32_t gone, uint32_t kept)
{
    return !he_net_is_held(n, gone) &&
           (he_net_twin(n, gone) != HE_NONE || he_net_twin(n, kept) != HE_NONE);
}

/* Returns true if the marks allow removing vertex u by a collapse of its edge. */
static bool may_go(const he_net *n, uint32_t u, bool held)
{
    const he_net_vertex *of = &n->vertices[u];
    if ((of->flags & (HE_NET_FIXED | HE_NET_PART)) != 0 || of->degree > HE_NET_HUB) {
        return false;
    }
    return (of->flags & HE_NET_LINE) == 0 || held;
}

/* Checks the triangles around one end of the edge, which moves from its place to `to`: no edge may
 * become too long, and no triangle may turn or become thin. `other` is the other end of the edge.
 * Lowers *old and *new to the least roundness before and after. */
static bool are_shapes_good(const he_net *n, const he_net_ring *ring, uint32_t other,
                            const moving *how)
{
    double longest = 0;
    for (uint32_t i = 0; i < ring->count; i++) {
        double square = he_remesh_square(how->from, he_net_place(n, ring->vertex[i]));
        longest = square > longest ? square : longest;
    }
    for (uint32_t i = 0; i < ring->count; i++) {
        const he_net_vertex *at = &n->vertices[ring->vertex[i]];
        double size = (double)at->size, wanted = (size < how->size ? size : how->size) * how->most;
        double square = he_remesh_square(how->to, at->p);
        if (ring->vertex[i] != other && square > wanted * wanted && square > longest) {
            return false;
        }
    }
    he_roundness worst_old = {.part = 1, .whole = 1}, worst_new = worst_old;
    for (uint32_t i = 0; i < ring->corners; i++) {
        uint32_t next = i + 1 < ring->count ? i + 1 : 0;
        uint32_t a = ring->vertex[i], b = ring->vertex[next];
        he_vec3 at_a = he_net_place(n, a), at_b = he_net_place(n, b);
        he_roundness old = he_roundness_of(how->from, at_a, at_b);
        he_roundness_lower(&worst_old, &old);
        if (a == other || b == other) {
            continue;
        }
        he_roundness new = he_roundness_of(how->to, at_a, at_b);
        he_roundness_lower(&worst_new, &new);
        if (!he_remesh_agree(old.area, new.area)) {
            return false;
        }
    }
    return !he_roundness_is_below(&worst_new, LEAST_ROUND) ||
           !he_roundness_is_less(&worst_new, &worst_old);
}

/* Returns true if a line stays near its place without vertex u. */
static bool is_line_good(const he_net *n, const removal *e)
{
    uint32_t line = he_net_line_of(n, e->c);
    if (line == HE_NONE) {
        return true;
    }
    uint32_t far = HE_NONE;
    for (uint32_t i = 0; i < e->ring.count; i++) {
        uint32_t before = e->ring.corner[i < e->ring.corners ? i : i - 1];
        uint32_t c = i < e->ring.corners ? before : he_net_prev(before);
        if (e->ring.vertex[i] != e->v && he_net_is_held(n, c)) {
            far = e->ring.vertex[i];
        }
    }
    if (far == HE_NONE) {
        return false;
    }
    double bulge =
        he_net_line_bulge(n, line, he_net_line_arc(n, line, far), he_net_line_arc(n, line, e->v));
    return bulge <= BULGE * (double)n->vertices[e->v].size;
}

/* Deletes a triangle, two sides of which become one: `kept` stays, `gone` is deleted. */
static void close_triangle(he_net *n, uint32_t gone, uint32_t kept)
{
    uint32_t beside_gone = he_net_twin(n, gone), beside_kept = he_net_twin(n, kept);
    he_net_delete_edge(n, he_net_halfedge(n, gone) >> 1);
    he_net_pair(n, beside_gone, beside_kept);
    he_net_pair(n, beside_kept, beside_gone);
    if (beside_gone != HE_NONE) {
        n->ids[beside_gone >> 2].halfedge[beside_gone & 3] = he_net_halfedge(n, kept);
        he_net_set_edge_marks(n, beside_gone, he_net_edge_marks(n, kept));
    }
    n->triangles[gone >> 2].marks = HE_NET_GONE;
    n->live_triangles--;
}

/* Lets vertex v store corner c, or on a border the first corner of its fan. */
static void set_corner(he_net *n, uint32_t v, uint32_t c)
{
    if (he_net_has(n, v, HE_NET_BORDER) && !he_net_has(n, v, HE_NET_PART)) {
        for (uint32_t at = he_net_cw(n, c); at != HE_NONE; at = he_net_cw(n, c)) {
            c = at;
        }
    }
    n->corner[v] = c;
}

/* Returns a corner at the vertex opposite to a closed triangle, in a triangle beside it. `into` and
 * `from` are the twins of the triangle's sides that end and begin at the vertex, as seen in the
 * triangle: the twin of the side that ends there begins there. */
static uint32_t corner_beside(uint32_t into, uint32_t from)
{
    return into != HE_NONE ? into : he_net_next(from);
}

static void lose_edge(he_net *n, uint32_t vertex, uint32_t lost, uint32_t other)
{
    he_net_add_degree(n, vertex, -1);
    if (n->corner[vertex] == lost) {
        n->corner[vertex] = other;
    }
}

static void collapse(he_net *n, const removal *e)
{
    uint32_t c = e->c, twin = he_net_twin(n, c), keeps = HE_NONE;
    uint32_t next = he_net_next(c), before = he_net_prev(c);
    for (uint32_t i = 0; i < e->ring.corners; i++) {
        uint32_t at = e->ring.corner[i];
        if (at >> 2 != c >> 2 && (twin == HE_NONE || at >> 2 != twin >> 2)) {
            n->triangles[at >> 2].v[at & 3] = e->v;
            keeps = at;
        }
    }
    uint32_t other = corner_beside(he_net_twin(n, next), he_net_twin(n, before));
    close_triangle(n, e->gone, e->kept);
    lose_edge(n, e->w, before, other);
    if (twin != HE_NONE) {
        uint32_t after = he_net_next(twin), last = he_net_prev(twin);
        other = corner_beside(he_net_twin(n, after), he_net_twin(n, last));
        close_triangle(n, after, last);
        lose_edge(n, e->x, last, other);
    }
    he_net_delete_edge(n, he_net_halfedge(n, c) >> 1);
    he_net_add_degree(n, e->v, (int)n->vertices[e->u].degree - (twin == HE_NONE ? 3 : 4));
    n->vertices[e->u].flags = HE_NET_DEAD;
    n->live_vertices--;
    set_corner(n, e->v, keeps);
}

/* Returns how long edges may be after a collapse of the edge between two points, in wanted lengths.
 * If the edge is much shorter than the limit, they may be a little too long: else edges between
 * rows of long thin triangles would never be collapsed. */
static double longest_after(he_vec3 u, he_vec3 v, double size, double scale)
{
    double lacks = 1 - sqrt(he_remesh_square(u, v)) / (HE_REMESH_SHORT * scale * size);
    return HE_REMESH_LONG * scale * (1 + SLACK * fmax(lacks, 0));
}

/* Tries to remove an end of the edge of corner c: its origin, or on a border its target. */
static bool try_removal(he_net *n, uint32_t c, bool target, double scale)
{
    removal e; /* its rings are large, so only members that are used are set */
    uint32_t twin = he_net_twin(n, c);
    e.c = c;
    e.u = target ? he_net_target(n, c) : he_net_origin(n, c);
    e.v = target ? he_net_origin(n, c) : he_net_target(n, c);
    e.w = he_net_opposite(n, c);
    e.x = twin == HE_NONE ? HE_NONE : he_net_opposite(n, twin);
    e.gone = target ? he_net_next(c) : he_net_prev(c);
    e.kept = target ? he_net_prev(c) : he_net_next(c);
    if (e.w == e.x || !can_lose(n, e.w) || !can_lose(n, e.x) || !can_close(n, e.gone, e.kept) ||
        (twin != HE_NONE && !can_close(n, he_net_next(twin), he_net_prev(twin))) ||
        !he_net_turn(n, e.u, &e.ring) || e.ring.corners < (twin == HE_NONE ? 2U : 3U)) {
        return false;
    }
    if (!he_net_turn(n, e.v, &e.about)) {
        e.about.count = 0;
    }
    e.moves = !he_net_has(n, e.u, STILL) && !he_net_has(n, e.v, STILL) && e.about.count > 0;
    he_vec3 at_u = he_net_place(n, e.u), at_v = he_net_place(n, e.v);
    he_vec3 to = e.moves ? he_vec3_scale(he_vec3_add(at_u, at_v), 0.5) : at_v;
    double size = (double)n->vertices[e.v].size, most = longest_after(at_u, at_v, size, scale);
    if (!are_shapes_good(n, &e.ring, e.v, &(moving){at_u, to, size, most}) ||
        (e.moves && !are_shapes_good(n, &e.about, e.u, &(moving){at_v, to, size, most})) ||
        !are_links_good(n, &e) || !is_line_good(n, &e)) {
        return false;
    }
    collapse(n, &e);
    if (e.moves) {
        n->vertices[e.v].p = to;
        n->vertices[e.v].flags |= HE_NET_MOVED | HE_NET_LOOSE;
    }
    return true;
}

/* Tries to collapse the edge of corner c. The end with fewer edges is removed if possible, else the
 * other one; if both ends would move to the middle, it makes no difference which one is removed. */
static bool try_edge(he_net *n, uint32_t c, double scale)
{
    uint32_t u = he_net_origin(n, c), v = he_net_target(n, c), twin = he_net_twin(n, c);
    bool held = he_net_is_held(n, c), border = twin == HE_NONE;
    if (he_net_is_frozen(n, c)) {
        return false;
    }
    bool u_goes = may_go(n, u, held), v_goes = may_go(n, v, held);
    bool u_first = n->vertices[u].degree <= n->vertices[v].degree;
    if (u_goes && v_goes && !he_net_has(n, u, STILL) && !he_net_has(n, v, STILL)) {
        return try_removal(n, u_first ? c : twin, false, scale);
    }
    return (u_goes && u_first && try_removal(n, c, false, scale)) ||
           (v_goes && try_removal(n, border ? c : twin, border, scale)) ||
           (u_goes && !u_first && try_removal(n, c, false, scale));
}

static double ratio(const he_net *n, uint32_t a, uint32_t b)
{
    const he_net_vertex *from = &n->vertices[a], *to = &n->vertices[b];
    double size = (double)(from->size < to->size ? from->size : to->size);
    return he_remesh_square(from->p, to->p) / (size * size);
}

/* Returns true if something has changed around an end of the edge of a corner: else it has been
 * tried before. */
static bool is_restless(const he_net *n, uint32_t c)
{
    return ((n->vertices[he_net_origin(n, c)].flags | n->vertices[he_net_target(n, c)].flags) &
            HE_NET_RESTLESS) != 0;
}

/* Collapses edges of a triangle that are shorter than `scale` times the limit. */
static void collapse_triangle(he_remeshing *r, uint32_t t, double scale)
{
    he_net *n = &r->net;
    const double limit = HE_REMESH_SHORT * scale;
    for (uint32_t i = 0; i < 3 && !he_net_is_gone(n, t); i++) {
        uint32_t c = 4 * t + i, twin = he_net_twin(n, c);
        if ((twin == HE_NONE || c < twin) && is_restless(n, c) &&
            ratio(n, he_net_origin(n, c), he_net_target(n, c)) < limit * limit &&
            try_edge(n, c, scale)) {
            r->changes++;
        }
    }
}

static double find_shortest(const he_net *n)
{
    double shortest = HUGE_VAL;
    for (uint32_t t = 0; t < n->triangle_count; t++) {
        const he_net_triangle *of = &n->triangles[t];
        for (unsigned i = 0; i < 3 && (of->marks & HE_NET_GONE) == 0; i++) {
            shortest = fmin(shortest, ratio(n, of->v[i], of->v[i == 2 ? 0 : i + 1]));
        }
    }
    return shortest;
}

/* The first of the rounds collapses edges shorter than 2^-ROUNDS of the limit. */
enum { ROUNDS = 6 };

he_status he_remesh_collapse(he_remeshing *r, bool rounds, he_error *err)
{
    he_net *n = &r->net;
    double scale = 1, shortest = rounds ? sqrt(find_shortest(n)) / HE_REMESH_SHORT : 1;
    he_status status = HE_OK;
    for (unsigned i = 0; i < ROUNDS && shortest < 0.5 * scale; i++) {
        scale *= 0.5;
    }
    for (; scale <= 1 && status == HE_OK; scale *= 2) {
        for (uint32_t t = 0; t < n->triangle_count && status == HE_OK; t++) {
            status = he_progress_at(r->progress, t + 1, n->triangle_count, err);
            if (!he_net_is_gone(n, t)) {
                collapse_triangle(r, t, scale);
            }
        }
    }
    return status;
}
