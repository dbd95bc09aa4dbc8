/* walk.h - inline functions that read a mesh. The caller must pass live elements of the mesh,
 * because these functions check nothing. An id that a client has sent must first pass
 * he_mesh_require. */
#ifndef HE_MESH_WALK_H
#define HE_MESH_WALK_H

#include "mesh/layout.h"

static inline he_halfedge he_twin(he_halfedge h)
{
    return (he_halfedge){h.i ^ 1u};
}
static inline he_edge he_edge_of(he_halfedge h)
{
    return (he_edge){h.i >> 1};
}
/* Returns a half-edge of edge e: 2e for side 0, or 2e + 1 for side 1. */
static inline he_halfedge he_edge_halfedge(he_edge e, unsigned side)
{
    return (he_halfedge){2u * e.i + side};
}
static inline he_halfedge he_next(const he_mesh *m, he_halfedge h)
{
    return (he_halfedge){m->c.next[h.i]};
}
static inline he_halfedge he_prev(const he_mesh *m, he_halfedge h)
{
    return (he_halfedge){m->c.prev[h.i]};
}
static inline he_vertex he_origin(const he_mesh *m, he_halfedge h)
{
    return (he_vertex){m->c.origin[h.i]};
}
static inline he_vertex he_target(const he_mesh *m, he_halfedge h)
{
    return (he_vertex){m->c.origin[h.i ^ 1u]};
}
/* Returns the face to the left of h; HE_NONE for a boundary half-edge. */
static inline he_face he_face_of(const he_mesh *m, he_halfedge h)
{
    return (he_face){m->c.face[h.i]};
}
/* Returns the half-edge that v stores; HE_NONE for an isolated vertex. */
static inline he_halfedge he_vertex_halfedge(const he_mesh *m, he_vertex v)
{
    return (he_halfedge){m->c.vertex_halfedge[v.i]};
}
static inline he_halfedge he_face_halfedge(const he_mesh *m, he_face f)
{
    return (he_halfedge){m->c.face_halfedge[f.i]};
}
static inline he_vec3 he_position(const he_mesh *m, he_vertex v)
{
    return m->c.position[v.i];
}

/* Returns the half-edge that follows h in counter-clockwise order around h's origin. */
static inline he_halfedge he_swing_ccw(const he_mesh *m, he_halfedge h)
{
    return he_twin(he_prev(m, h));
}

/* Returns the half-edge that precedes h in counter-clockwise order around h's origin. */
static inline he_halfedge he_swing_cw(const he_mesh *m, he_halfedge h)
{
    return (he_halfedge){m->c.next[h.i ^ 1u]};
}

/* An edit at a random place of a large mesh spends most of its time waiting for memory. The
 * prefetch functions request all array entries that the edit will read at once, so that the edit
 * waits once and not for each entry. These functions accept any id, also of deleted elements. */
static inline void he_prefetch_links(const he_mesh *m, he_halfedge h)
{
    if (h.i < 2u * m->c.edges.issued) {
        __builtin_prefetch(&m->c.next[h.i], 1);
        __builtin_prefetch(&m->c.prev[h.i], 1);
        __builtin_prefetch(&m->c.origin[h.i], 1);
        __builtin_prefetch(&m->c.face[h.i], 1);
    }
}
/* Prefetches the memory that an edit of edge e reads: the links of the half-edges before and after
 * its two half-edges, and the stored half-edges of its faces and ends. */
static inline void he_prefetch_about(const he_mesh *m, he_edge e)
{
    for (uint32_t h = 2u * e.i; h <= 2u * e.i + 1u && e.i < m->c.edges.issued; h++) {
        he_prefetch_links(m, (he_halfedge){m->c.next[h]});
        he_prefetch_links(m, (he_halfedge){m->c.prev[h]});
        if (m->c.face[h] < m->c.faces.issued) {
            __builtin_prefetch(&m->c.face_halfedge[m->c.face[h]], 1);
        }
        if (m->c.origin[h] < m->c.vertices.issued) {
            __builtin_prefetch(&m->c.vertex_halfedge[m->c.origin[h]], 1);
        }
    }
}

/* Prefetches the positions of the two ends of an edge. */
static inline void he_prefetch_ends(const he_mesh *m, he_edge e)
{
    for (uint32_t h = 2u * e.i; h <= 2u * e.i + 1u && e.i < m->c.edges.issued; h++) {
        if (m->c.origin[h] < m->c.vertices.issued) {
            __builtin_prefetch(&m->c.position[m->c.origin[h]], 1);
        }
    }
}

/* Prefetches for a loop that edits edges and knows which edges it will edit after the present one:
 * edge `next` directly afterwards, edge `soon` later. The processor then reads the memory of these
 * edges while the present edge is edited. */
static inline void he_prefetch_coming(const he_mesh *m, he_edge next, he_edge soon)
{
    he_prefetch_links(m, he_edge_halfedge(soon, 0));
    he_prefetch_about(m, next);
    he_prefetch_ends(m, next);
}

static inline bool he_is_none(uint32_t id)
{
    return id == HE_NONE;
}
static inline bool he_is_boundary_halfedge(const he_mesh *m, he_halfedge h)
{
    return m->c.face[h.i] == HE_NONE;
}
static inline bool he_is_boundary_edge(const he_mesh *m, he_edge e)
{
    return m->c.face[2u * e.i] == HE_NONE || m->c.face[2u * e.i + 1u] == HE_NONE;
}
static inline bool he_is_isolated(const he_mesh *m, he_vertex v)
{
    return m->c.vertex_halfedge[v.i] == HE_NONE;
}
/* Returns true if a vertex is on the boundary. An isolated vertex counts as on the
 * boundary, too. */
static inline bool he_is_boundary_vertex(const he_mesh *m, he_vertex v)
{
    uint32_t h = m->c.vertex_halfedge[v.i];
    return h == HE_NONE || m->c.face[h] == HE_NONE;
}
static inline bool he_vertex_is_live(const he_mesh *m, he_vertex v)
{
    return v.i < m->c.vertices.issued && m->c.vertex_halfedge[v.i] != HE_DEAD;
}
static inline bool he_edge_is_live(const he_mesh *m, he_edge e)
{
    return e.i < m->c.edges.issued && m->c.next[2u * e.i] != HE_DEAD;
}
static inline bool he_face_is_live(const he_mesh *m, he_face f)
{
    return f.i < m->c.faces.issued && m->c.face_halfedge[f.i] != HE_DEAD;
}

/* Returns true if the face to the left of h is a triangle. */
static inline bool he_is_triangle(const he_mesh *m, he_halfedge h)
{
    return !he_is_boundary_halfedge(m, h) && m->c.next[m->c.next[m->c.next[h.i]]] == h.i;
}

/* Returns the number of edges at a vertex, in time linear in that number. */
uint32_t he_vertex_degree(const he_mesh *m, he_vertex v);
/* Returns the number of corners of a face, in time linear in that number. */
uint32_t he_face_degree(const he_mesh *m, he_face f);
/* Returns the number of half-edges in the loop of h, which is the border of a face or of a hole, in
 * time linear in that number. */
uint32_t he_loop_length(const he_mesh *m, he_halfedge h);
/* Returns the number of fans at a vertex (mesh.h): 0 if the vertex is isolated, 1 if it is
 * manifold, more if it is a bow-tie. */
uint32_t he_vertex_fans(const he_mesh *m, he_vertex v);
/* Finds the half-edge from a to b. Returns HE_NONE if no edge joins them. The function searches
 * around a; if a has many edges, it searches around a and b alternately, so the time is linear in
 * the smaller degree of a and b. */
he_halfedge he_find_halfedge(const he_mesh *m, he_vertex a, he_vertex b);
/* Finds the half-edge from the origin of the half-edge `leaving` to vertex `to`, like
 * he_find_halfedge. */
he_halfedge he_find_halfedge_from(const he_mesh *m, he_halfedge leaving, he_vertex to);
/* Finds a half-edge like he_find_halfedge, and adds the number of steps of the search to `*steps`,
 * for callers that limit their work. */
he_halfedge he_find_halfedge_counted(const he_mesh *m, he_vertex a, he_vertex b, uint64_t *steps);

#endif
