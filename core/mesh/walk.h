/* walk.h - reading a mesh, inline. The caller passes live elements of this mesh: these functions
 * check nothing. Ids that come from outside go through he_mesh_require first. */
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
/* Half-edge 2e (side 0) or 2e + 1 (side 1). */
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
/* HE_NONE on a boundary half-edge. */
static inline he_face he_face_of(const he_mesh *m, he_halfedge h)
{
    return (he_face){m->c.face[h.i]};
}
/* HE_NONE at an isolated vertex. */
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

/* The next half-edge that leaves the same origin. */
static inline he_halfedge he_turn_ccw(const he_mesh *m, he_halfedge h)
{
    return he_twin(he_prev(m, h));
}

/* The one before it in that order. */
static inline he_halfedge he_turn_cw(const he_mesh *m, he_halfedge h)
{
    return (he_halfedge){m->c.next[h.i ^ 1u]};
}

/* An edit in a random place of a large mesh waits for memory and for little else. These ask for the
 * rows it will read all at once, so that it waits once and not for one after another. Any id may be
 * given, and links may be dead. */
static inline void he_prefetch_links(const he_mesh *m, he_halfedge h)
{
    if (h.i < 2u * m->c.edges.issued) {
        __builtin_prefetch(&m->c.next[h.i], 1);
        __builtin_prefetch(&m->c.prev[h.i], 1);
        __builtin_prefetch(&m->c.origin[h.i], 1);
        __builtin_prefetch(&m->c.face[h.i], 1);
    }
}
/* The half-edges before and after the two of an edge, its faces, and what leaves its ends. */
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

/* The ends' positions. */
static inline void he_prefetch_ends(const he_mesh *m, he_edge e)
{
    for (uint32_t h = 2u * e.i; h <= 2u * e.i + 1u && e.i < m->c.edges.issued; h++) {
        if (m->c.origin[h] < m->c.vertices.issued) {
            __builtin_prefetch(&m->c.position[m->c.origin[h]], 1);
        }
    }
}

/* For whoever edits one edge after another and knows which come: `next` at once after this edit,
 * `soon` after that. The waiting for them happens during the edits before. */
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
/* True of an isolated vertex too. */
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

/* Is there a triangle to the left of h? */
static inline bool he_is_triangle(const he_mesh *m, he_halfedge h)
{
    return !he_is_boundary_halfedge(m, h) && m->c.next[m->c.next[m->c.next[h.i]]] == h.i;
}

/* Edges at a vertex; linear in the answer. */
uint32_t he_vertex_degree(const he_mesh *m, he_vertex v);
/* Corners of a face; linear in the answer. */
uint32_t he_face_degree(const he_mesh *m, he_face f);
/* Half-edges of the loop of h: of a face, or of a hole; linear in the answer. */
uint32_t he_loop_length(const he_mesh *m, he_halfedge h);
/* Fans at a vertex: 0 isolated, 1 manifold, more at a bow-tie. */
uint32_t he_vertex_fans(const he_mesh *m, he_vertex v);
/* The half-edge from a to b, HE_NONE when no edge joins them. Turns about a, and where that takes
 * long about b in step with it, so it costs the smaller degree. */
he_halfedge he_find_halfedge(const he_mesh *m, he_vertex a, he_vertex b);
/* The same from the origin of a half-edge. */
he_halfedge he_find_halfedge_from(const he_mesh *m, he_halfedge leaving, he_vertex to);
/* The same, adding what it cost: for whoever limits that. */
he_halfedge he_find_halfedge_counted(const he_mesh *m, he_vertex a, he_vertex b, uint64_t *steps);

#endif
