/* subdivide_step.h - one step of subdivide, shared by its parts: from one content a finer one.
 *
 *     subdivide.c         sizes, room, steps, and the replace
 *     subdivide_split.c   links where edges are cut in halves (loop, catmull_clark, linear)
 *     subdivide_sqrt3.c   links where edges are flipped
 *     subdivide_rules.c   where vertices come to lie
 *     subdivide_carry.c   attributes
 *
 * Ids of new elements count from the rows issued in `from`, in the order subdivide.h tells. */
#ifndef HE_ALGO_SUBDIVIDE_STEP_H
#define HE_ALGO_SUBDIVIDE_STEP_H

#include "algo/subdivide.h"
#include "mesh/layout.h"

/* What a step makes of so many. 64 bits: estimates run ahead of what fits. */
typedef struct he_sizes {
    uint64_t vertices, edges, faces; /* rows */
    uint64_t live_vertices, live_edges, live_faces;
    uint64_t boundary;           /* half-edges */
    uint64_t sharp, sharp_sides; /* sharp edges, and the faces at them */
    uint64_t polygons, corners;  /* faces that are no triangles, and their corners */
} he_sizes;

/* Where a corner's values come from. */
typedef enum he_source_how {
    HE_FROM_NOWHERE, /* the default */
    HE_FROM_ROW,     /* half-edge a */
    HE_FROM_MIDDLE,  /* of half-edges a and b */
    HE_FROM_THIRD,   /* two parts a, one part b */
    HE_FROM_FACE,    /* the mean over the face of half-edge a */
    HE_FROM_NEW      /* as half-edge a of the finer content */
} he_source_how;

typedef struct he_corner_source {
    uint32_t a, b;
    he_source_how how;
} he_corner_source;

typedef struct he_subdivide_step {
    const he_content *from;
    he_content *to;
    he_watch *watch;
    he_scheme scheme;
    bool thirds;    /* sqrt3: sharp edges are cut in three */
    bool polygonal; /* there are faces that are no triangles */
    /* A live row's place among the live ones; NULL when all rows live. */
    uint32_t *edge_rank, *face_rank;
    uint64_t *feature;      /* bits of the edges, NULL when there are none */
    uint64_t *feature_next; /* of the finer content's */
    uint64_t *fixed;        /* bits of the first `fixed_count` vertices, NULL when there are none */
    uint32_t fixed_count;
    uint8_t *sharp; /* of each vertex: its sharp edges, at most 3; 3 when fixed. NULL: all smooth */
    uint32_t *degree;
    /* sqrt3: of each face the vertex in it (HE_NONE when cut at a sharp edge) and the first edge
     * inside; of each edge cut in three, its place among those, else HE_NONE. */
    uint32_t *centre, *spoke, *third;
    /* Parents of new rows, by their distance from the old; where there are columns. */
    uint32_t *vertex_from, *edge_from, *face_from; /* an edge inside has HE_NONE */
    he_corner_source *corner_from;                 /* of every half-edge of `to` */
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

/* Is the face of h another triangle on the same three vertices as the one of its twin, whose next
 * half-edge is `after`? */
static inline bool he_subdivide_is_doubled(const he_content *from, uint32_t h, uint32_t after)
{
    uint32_t f = from->face[h];
    return f != HE_NONE && f == from->face[after ^ 1] && from->next[from->next[from->next[h]]] == h;
}
static inline void he_subdivide_set(he_content *to, uint32_t h, uint32_t next, uint32_t prev,
                                    uint32_t origin, uint32_t face)
{
    to->next[h] = next;
    to->prev[h] = prev;
    to->origin[h] = origin;
    to->face[h] = face;
}

/* The links of `to`, its vertices' half-edges among them; features and parents too. */
HE_NODISCARD he_status he_subdivide_split(he_subdivide_step *s, he_error *err);
HE_NODISCARD he_status he_subdivide_sqrt3(he_subdivide_step *s, he_error *err);

/* Vectors of `to` from those of `from`, by the scheme's rules: positions, or three components of a
 * column. Finite where `from` is, however large. */
HE_NODISCARD he_status he_subdivide_place(const he_subdivide_step *s, const he_vec3 *from,
                                          he_vec3 *to, he_error *err);

/* Make the arrays of parents that the columns ask for. */
HE_NODISCARD he_status he_subdivide_reserve_parents(he_subdivide_step *s, he_error *err);
HE_NODISCARD he_status he_subdivide_carry(const he_subdivide_step *s, he_error *err);

#endif
