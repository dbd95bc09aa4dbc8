/* subdivide_step.h - one step of subdivide: makes the arrays (he_content) of the finer mesh from
 * those of the coarser mesh.
 *
 *     subdivide.c         sizes, memory, the loop over the steps, replacing the mesh
 *     subdivide_split.c   links where edges are cut in halves (loop, catmull_clark, linear)
 *     subdivide_sqrt3.c   links where edges are flipped
 *     subdivide_rules.c   positions of vertices
 *     subdivide_carry.c   attributes
 *
 * The ids of new elements follow the last id of the coarser mesh, in the order that subdivide.h
 * states. */
#ifndef HE_ALGO_SUBDIVIDE_STEP_H
#define HE_ALGO_SUBDIVIDE_STEP_H

#include "algo/subdivide.h"
#include "mesh/layout.h"

/* The numbers of elements of a mesh after a step. They have 64 bits because an estimate may exceed
 * what fits into a mesh. */
typedef struct he_sizes {
    uint64_t vertices, edges, faces; /* numbers of elements, deleted ones included */
    uint64_t live_vertices, live_edges, live_faces;
    uint64_t boundary; /* number of boundary half-edges */
    /* `sharp`: number of sharp edges; `sharp_sides`: number of their half-edges that have a face */
    uint64_t sharp, sharp_sides;
    /* `polygons`: number of faces that are no triangles; `corners`: number of corners of these
     * faces */
    uint64_t polygons, corners;
} he_sizes;

/* How a corner's values are computed. */
typedef enum he_source_how {
    HE_FROM_NOWHERE, /* default of the attribute */
    HE_FROM_ROW,     /* value of half-edge a */
    HE_FROM_MIDDLE,  /* mean of the values of half-edges a and b */
    HE_FROM_THIRD,   /* 2/3 of the value of half-edge a and 1/3 of that of half-edge b */
    HE_FROM_FACE,    /* mean of the values of all corners in the face of half-edge a */
    /* a copy of the value of half-edge a; here a is a half-edge of the finer mesh */
    HE_FROM_NEW
} he_source_how;

typedef struct he_corner_source {
    uint32_t a, b;
    he_source_how how;
} he_corner_source;

typedef struct he_subdivide_step {
    const he_content *from;
    he_content *to;
    he_progress *progress;
    he_scheme scheme;
    bool thirds;    /* the scheme is sqrt3, and this step cuts sharp edges in three */
    bool polygonal; /* the coarser mesh has faces that are no triangles */
    /* The index of each live edge among the live edges, and of each live face among the live faces;
     * NULL if none is deleted. */
    uint32_t *edge_rank, *face_rank;
    /* one bit for each edge: set if the edge is a feature; NULL if no edge is */
    uint64_t *feature;
    uint64_t *feature_next; /* features of the finer content */
    /* A bit for each of the first `fixed_count` vertices: set if the vertex must stay in place;
     * NULL if none must. */
    uint64_t *fixed;
    uint32_t fixed_count;
    /* Number of sharp edges at each vertex; 3 stands for 3 or more, and for a vertex that must stay
     * in place; NULL if all vertices are smooth. */
    uint8_t *sharp;
    uint32_t *degree;
    /* Only for the scheme sqrt3. `centre`: the new vertex in each face, HE_NONE if the face is cut
     * at a sharp edge; `spoke`: the first new edge inside each face; `third`: for each edge the
     * index among the edges that are cut in three, HE_NONE if it is not. */
    uint32_t *centre, *spoke, *third;
    /* The parent (old element) of each new element, in arrays that start with the first new id.
     * They are made only if the mesh has attribute columns of this kind of element. A new edge
     * inside a face has no parent: HE_NONE. */
    uint32_t *vertex_from, *edge_from, *face_from;
    /* Says for each half-edge of `to` how its attribute values are computed. */
    he_corner_source *corner_from;
} he_subdivide_step;

static inline bool he_subdivide_is_live(const uint32_t *link, uint32_t row)
{
    return link[row] != HE_DEAD;
}
static inline uint32_t he_subdivide_edge_rank(const he_subdivide_step *s, uint32_t e)
{
    return s->edge_rank == NULL ? e : s->edge_rank[e];
}
static inline uint32_t he_subdivide_face_rank(const he_subdivide_step *s, uint32_t f)
{
    return s->face_rank == NULL ? f : s->face_rank[f];
}
static inline bool he_subdivide_is_sharp(const he_subdivide_step *s, uint32_t e)
{
    const uint32_t *face = s->from->face;
    return face[2 * e] == HE_NONE || face[2 * e + 1] == HE_NONE ||
           (s->feature != NULL && he_bits_get(s->feature, e));
}

/* Returns true if the face of h has the same three vertices as the face of twin(h). Both faces must
 * be triangles; `after` must be the half-edge after twin(h). */
static inline bool he_subdivide_is_doubled(const he_content *from, uint32_t h, uint32_t after)
{
    uint32_t f = from->face[h];
    return f != HE_NONE && f == from->face[after ^ 1] && from->next[from->next[from->next[h]]] == h;
}

/* All links of a half-edge. */
typedef struct he_subdivide_links {
    uint32_t next, prev, origin, face;
} he_subdivide_links;

static inline void he_subdivide_set(he_content *to, uint32_t h, he_subdivide_links links)
{
    to->next[h] = links.next;
    to->prev[h] = links.prev;
    to->origin[h] = links.origin;
    to->face[h] = links.face;
}

/* Each function writes the links of the finer mesh `to`, the stored half-edges of its vertices, its
 * features, and the parents of its new elements: he_subdivide_sqrt3 for that scheme,
 * he_subdivide_split for all others. */
HE_NODISCARD he_status he_subdivide_split(he_subdivide_step *s, he_error *err);
HE_NODISCARD he_status he_subdivide_sqrt3(he_subdivide_step *s, he_error *err);

/* Computes a vector for each vertex of the finer mesh from the vectors of the coarser mesh by the
 * scheme's rules. The vectors are positions, or three components of an attribute. The results are
 * finite if the vectors in `from` are, however large these are. */
HE_NODISCARD he_status he_subdivide_place(const he_subdivide_step *s, const he_vec3 *from,
                                          he_vec3 *to, he_error *err);

/* Allocates the arrays `vertex_from`, `edge_from`, `face_from` and `corner_from`, each only if
 * attribute columns need it. */
HE_NODISCARD he_status he_subdivide_reserve_parents(he_subdivide_step *s, he_error *err);
HE_NODISCARD he_status he_subdivide_attributes(const he_subdivide_step *s, he_error *err);

#endif
