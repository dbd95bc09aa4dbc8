/* net.h - the triangles on which remesh works, in flat arrays of their own.
 *
 * A NET is a copy of those faces of a mesh that remesh may change. Triangle t has the corners 4t,
 * 4t + 1 and 4t + 2; corner 4t + 3 does not exist. Corner i of a triangle stands for the half-edge
 * that leaves vertex v[i] and ends in the next corner, and `twin` is the corner of the half-edge
 * that runs in the opposite direction:
 *
 *                    v[2]
 *                     o
 *                   /   \
 *       corner 2  /       \  corner 1        next(c), prev(c): the other corners of the triangle
 *               /           \                 turning about v[0] counter-clockwise: twin(prev(c))
 *         v[0] o-------------o v[1]
 *                 corner 0
 *                 twin(c)
 *
 * All that a step around a vertex reads is in one half of a cache line, so that walks are faster
 * than in the mesh. A border of the net is where the mesh has its boundary, or faces that remesh
 * may not change; `twin` is HE_NONE there.
 *
 * VERTICES of the net have numbers of their own; `vertex_id` has their ids in the mesh. `corner` is
 * a corner at the vertex; on a border it is the first one in counter-clockwise order, which has no
 * twin.
 *
 * COORDINATES are relative to the middle of the faces, in units of a power of two about half the
 * size of their box, so that no product of coordinates leaves the range of a double, and so that
 * meshes far from the origin lose no digits.
 *
 * EDGES that are HELD are part of a line or FROZEN. A frozen edge is never changed: it is
 * locked, or on the border to faces that remesh may not change. A held edge is never flipped.
 *
 * LINES are boundaries and feature lines from corner to corner: chains of edges that may be cut and
 * joined, but whose vertices stay on the chain of edges that the mesh had at first, which is stored
 * as a list of points. Each line has two different ends, which are fixed vertices. A vertex inside
 * a line is described by its distance from the line's first point, measured along the line.
 *
 * IDS. Half-edges and faces have the ids of the mesh. New edges have provisional ids, from
 * `first_edge` on; new faces and vertices have the id HE_NONE. Final ids are issued when the net is
 * written back, so that elements that were made and deleted again need none. */
#ifndef HE_REMESH_NET_H
#define HE_REMESH_NET_H

#include "base/mem.h"
#include "geometry/vec3.h"

#include <assert.h>

/* Flags of a vertex of the net. */
enum {
    HE_NET_FIXED = 1, /* the vertex is neither moved nor removed */
    /* Not all faces around the vertex can be visited by turning about it in the net: it is a
     * bow-tie, or has faces that do not belong to the net. It is fixed. */
    HE_NET_PART = 2,
    HE_NET_LINE = 4,   /* the vertex is inside a line, and moves only along it */
    HE_NET_BORDER = 8, /* the vertex is on a border of the net */
    HE_NET_MOVED = 16, /* the position of the vertex is not that of the mesh */
    HE_NET_LOOSE =
        32, /* the vertex was made in the middle of an edge and not yet put on the ground */
    HE_NET_DEAD = 64, /* the vertex was removed */
    /* The vertex, or something around it, has changed since it was relaxed last. */
    HE_NET_RESTLESS = 128
};

/* A vertex with more edges is a hub: turning about it would take too long. As long as it has so
 * many, it is neither moved nor removed. */
enum { HE_NET_HUB = 64 };

typedef struct he_net_vertex {
    he_vec3 p;
    float size;      /* the wanted length of edges at the vertex */
    uint16_t degree; /* number of edges; UINT16_MAX stands for that many or more */
    uint8_t ideal;   /* the degree at which the triangles around the vertex are most regular */
    uint8_t flags;
} he_net_vertex;

/* Marks of a triangle. */
enum {
    HE_NET_HELD = 1,   /* shifted left by i: edge i is held */
    HE_NET_FROZEN = 8, /* shifted left by i: edge i is frozen */
    HE_NET_EDGES = 63, /* all marks of edges */
    HE_NET_GONE = 64   /* the triangle was deleted */
};

typedef struct he_net_triangle {
    uint32_t v[3], marks, twin[3];
    uint32_t unused; /* fills the half of a cache line */
} he_net_triangle;

/* The ids of the half-edges of a triangle, and of its face. */
typedef struct he_net_ids {
    uint32_t halfedge[3], face;
} he_net_ids;

typedef struct he_net_line {
    uint32_t first, count; /* which of the points of all lines are this line's */
    uint32_t end[2];       /* the vertices at the first and the last point */
} he_net_line;

/* The lines of a net: arrays of lines, and of the points of all lines. */
typedef struct he_net_lines {
    he_net_line *line;
    he_vec3 *point;
    double *arc;      /* for each point: its distance along the line from the line's first point */
    uint32_t *ground; /* for each point but the last of a line: a triangle of the ground beside the
                         segment that begins there */
    uint32_t count;
} he_net_lines;

typedef struct he_net {
    he_net_triangle *triangles;
    he_net_ids *ids;
    uint32_t triangle_count, triangle_room, live_triangles;
    he_net_vertex *vertices;
    uint32_t *corner;    /* a corner at each vertex */
    uint32_t *ground;    /* a triangle of the ground near each vertex */
    uint32_t *vertex_id; /* the id of each vertex in the mesh; HE_NONE if it is new */
    uint32_t vertex_count, vertex_room, live_vertices;
    /* The place of each vertex that is inside a line: its distance along the line from the line's
     * first point. NULL if the net has no lines. */
    double *arc;
    he_net_lines lines;
    /* The line of which each edge, by its id, is a part; HE_NONE if there is none. NULL if the net
     * has no lines. */
    uint32_t *line;
    /* The edge of the mesh of which each new edge, from `first_edge` on, is a part; HE_NONE if it
     * was made inside a face. */
    uint32_t *edge_parent;
    uint32_t first_edge, edge_count, edge_room;
    /* The last of the new edges that were deleted, HE_NONE if there is none; its entry in
     * `edge_parent` is the one before it, and so on. Their provisional ids are used again. */
    uint32_t spare_edge;
    uint32_t most_triangles; /* more must not be made */
    he_vec3 middle;
    int exponent; /* coordinates of the net are (coordinates - middle) / 2^exponent */
} he_net;

/* --- corners --- */

static inline uint32_t he_net_next(uint32_t c)
{
    return (c & 3) == 2 ? c - 2 : c + 1;
}
static inline uint32_t he_net_prev(uint32_t c)
{
    return (c & 3) == 0 ? c + 2 : c - 1;
}
static inline he_net_triangle *he_net_of(const he_net *n, uint32_t c)
{
    return &n->triangles[c >> 2];
}
static inline uint32_t he_net_twin(const he_net *n, uint32_t c)
{
    return n->triangles[c >> 2].twin[c & 3];
}
static inline uint32_t he_net_origin(const he_net *n, uint32_t c)
{
    return n->triangles[c >> 2].v[c & 3];
}
static inline uint32_t he_net_target(const he_net *n, uint32_t c)
{
    return he_net_origin(n, he_net_next(c));
}
static inline uint32_t he_net_opposite(const he_net *n, uint32_t c)
{
    return he_net_origin(n, he_net_prev(c));
}
static inline uint32_t he_net_halfedge(const he_net *n, uint32_t c)
{
    return n->ids[c >> 2].halfedge[c & 3];
}
static inline bool he_net_is_held(const he_net *n, uint32_t c)
{
    return (n->triangles[c >> 2].marks & ((uint32_t)HE_NET_HELD << (c & 3))) != 0;
}
static inline bool he_net_is_frozen(const he_net *n, uint32_t c)
{
    return (n->triangles[c >> 2].marks & ((uint32_t)HE_NET_FROZEN << (c & 3))) != 0;
}
static inline bool he_net_is_gone(const he_net *n, uint32_t t)
{
    return (n->triangles[t].marks & HE_NET_GONE) != 0;
}
/* The marks of the edge of a corner, as a mask that does not depend on the corner. */
static inline uint32_t he_net_edge_marks(const he_net *n, uint32_t c)
{
    return n->triangles[c >> 2].marks >> (c & 3) & (HE_NET_HELD | HE_NET_FROZEN);
}
static inline void he_net_set_edge_marks(he_net *n, uint32_t c, uint32_t marks)
{
    uint32_t *to = &n->triangles[c >> 2].marks;
    *to = (*to & ~((uint32_t)(HE_NET_HELD | HE_NET_FROZEN) << (c & 3))) | marks << (c & 3);
}
/* Makes two corners twins of each other. If `b` is HE_NONE, `a` gets no twin. */
static inline void he_net_pair(he_net *n, uint32_t a, uint32_t b)
{
    if (a != HE_NONE) {
        n->triangles[a >> 2].twin[a & 3] = b;
    }
    if (b != HE_NONE) {
        n->triangles[b >> 2].twin[b & 3] = a;
    }
}
/* Returns the corner at the origin of c that follows counter-clockwise; HE_NONE at a border. */
static inline uint32_t he_net_ccw(const he_net *n, uint32_t c)
{
    return he_net_twin(n, he_net_prev(c));
}
/* Returns the corner at the origin of c that precedes c; HE_NONE at a border. */
static inline uint32_t he_net_cw(const he_net *n, uint32_t c)
{
    uint32_t twin = he_net_twin(n, c);
    return twin == HE_NONE ? HE_NONE : he_net_next(twin);
}

/* --- vertices --- */

static inline he_vec3 he_net_place(const he_net *n, uint32_t v)
{
    return n->vertices[v].p;
}
static inline bool he_net_has(const he_net *n, uint32_t v, uint32_t flag)
{
    return (n->vertices[v].flags & flag) != 0;
}
/* Adds `change` to the degree of a vertex. */
static inline void he_net_add_degree(he_net *n, uint32_t v, int change)
{
    int degree = n->vertices[v].degree;
    n->vertices[v].flags |= HE_NET_RESTLESS;
    if (degree < UINT16_MAX) {
        degree += change;
        n->vertices[v].degree = (uint16_t)(degree < UINT16_MAX ? degree : UINT16_MAX);
    }
}
/* Returns true if the vertex can be walked around in the net, in not too many steps. */
static inline bool he_net_can_turn(const he_net *n, uint32_t v)
{
    return !he_net_has(n, v, HE_NET_PART) && n->vertices[v].degree <= HE_NET_HUB;
}

/* The corners around a vertex in counter-clockwise order, and the vertices at their other ends. At
 * a border there is one more vertex than corners. */
typedef struct he_net_ring {
    uint32_t corners, count;
    uint32_t corner[HE_NET_HUB + 1], vertex[HE_NET_HUB + 1];
} he_net_ring;

/* Fills a ring. Returns false if the vertex cannot be walked around (he_net_can_turn). */
static inline bool he_net_turn(const he_net *n, uint32_t v, he_net_ring *out)
{
    if (!he_net_can_turn(n, v)) {
        return false;
    }
    uint32_t first = n->corner[v], c = first, count = 0;
    do {
        out->corner[count] = c;
        out->vertex[count++] = he_net_target(n, c);
        uint32_t before = he_net_prev(c);
        c = he_net_twin(n, before);
        if (c == HE_NONE) {
            out->corners = count;
            out->vertex[count] = he_net_origin(n, before);
            out->count = count + 1;
            return true;
        }
    } while (c != first);
    out->corners = out->count = count;
    return true;
}

/* Makes room for one more vertex, and for the edges and triangles that a split of an edge makes.
 * Returns HE_NO_MEMORY if memory is out.
 * Returns HE_LIMIT if the net has `most_triangles` already. */
HE_NODISCARD he_status he_net_reserve_more(he_net *n, he_error *err);
static inline he_status he_net_reserve(he_net *n, he_error *err)
{
    return n->triangle_count + 2 <= n->triangle_room && n->vertex_count < n->vertex_room &&
                   n->edge_count + 3 <= n->edge_room && n->triangle_count + 2 <= n->most_triangles
               ? HE_OK
               : he_net_reserve_more(n, err);
}
/* Makes a vertex without edges at a place; there must be room. */
uint32_t he_net_new_vertex(he_net *n, he_vec3 place);
/* Makes an edge that is part of the edge `parent` of the mesh, or inside a face if that is HE_NONE,
 * and returns its half-edge with the even id. There must be room. */
uint32_t he_net_new_edge(he_net *n, uint32_t parent);
void he_net_delete_edge(he_net *n, uint32_t edge);
/* Returns the edge of the mesh of which an edge is a part; HE_NONE if there is none. */
static inline uint32_t he_net_parent(const he_net *n, uint32_t edge)
{
    return edge < n->first_edge ? edge : n->edge_parent[edge - n->first_edge];
}
static inline uint32_t he_net_line_of(const he_net *n, uint32_t c)
{
    return n->line == NULL ? HE_NONE : n->line[he_net_halfedge(n, c) >> 1];
}

/* Renumbers triangles and vertices in the order in which a search from neighbour to neighbour finds
 * them, and drops those that were deleted, so that neighbours are near in memory.
 * Returns HE_NO_MEMORY if memory is out; the net is as it was. */
HE_NODISCARD he_status he_net_tidy(he_net *n, he_error *err);
void he_net_clear(he_net *n);

/* --- coordinates --- */

static inline he_vec3 he_net_inside(const he_net *n, he_vec3 outside)
{
    he_vec3 p = he_vec3_sub(outside, n->middle);
    return (he_vec3){ldexp(p.x, -n->exponent), ldexp(p.y, -n->exponent), ldexp(p.z, -n->exponent)};
}

#endif
