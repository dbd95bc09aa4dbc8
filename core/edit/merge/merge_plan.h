/* merge_plan.h - what he_merge_vertices finds out before it writes: merge_plan.c looks, merge.c
 * writes. */
#ifndef HE_EDIT_MERGE_MERGE_PLAN_H
#define HE_EDIT_MERGE_MERGE_PLAN_H

#include "edit/merge/merge.h"
#include "mesh/write.h"

/* What becomes of an edge with an end in a merge, or beside a face that goes. */
typedef struct he_merge_fate {
    uint32_t into;   /* the edge that takes its place, itself, or HE_NONE when its ends are one */
    uint32_t turned; /* 1 when half-edge 2e takes the place of 2 * into + 1 */
    uint32_t
        occupant[2];  /* of one that stays: the old half-edge that runs there with its face now */
    uint32_t uses[2]; /* how many faces run along either side */
} he_merge_fate;

/* Lists of ids are sorted unless they say otherwise, and arrays run along with them. */
typedef struct he_merge_plan {
    he_mesh *m;
    const he_merge *how;
    he_ids group;   /* the vertices that take part */
    uint32_t *rep;  /* which one each becomes */
    uint32_t *next; /* the one that follows among those that become one, from rep on; HE_NONE */
    he_ids edges;
    he_merge_fate *fates;
    uint32_t *slots; /* a hash table of those that stay, by their ends: index in edges + 1 */
    size_t slot_count;
    he_ids faces;
    uint32_t *goes;   /* HE_NONE: it stays; HE_DEAD: it goes; else the face it is the same as */
    he_ids rim;       /* the vertices whose rings change, as far as they stay */
    uint32_t *stored; /* the half-edge each of those stores then; HE_DEAD when it goes */
    he_ids holes;     /* pairs of boundary half-edges that follow each other; in no order */
    size_t corners;   /* of the faces */
} he_merge_plan;

/* The place of an id in a sorted list, or HE_NONE. */
static inline uint32_t he_merge_index(const he_ids *list, uint32_t id)
{
    size_t low = 0, high = list->count;
    while (low < high) {
        size_t mid = low + (high - low) / 2;
        if (list->ids[mid] < id) {
            low = mid + 1;
        } else {
            high = mid;
        }
    }
    return low < list->count && list->ids[low] == id ? (uint32_t)low : HE_NONE;
}

/* What a vertex becomes. */
static inline he_vertex he_merge_rep(const he_merge_plan *p, he_vertex v)
{
    uint32_t i = he_merge_index(&p->group, v.i);
    return i == HE_NONE ? v : (he_vertex){p->rep[i]};
}

/* Do the ends of h become one? */
static inline bool he_merge_shrinks(const he_merge_plan *p, he_halfedge h)
{
    return he_merge_rep(p, he_origin(p->m, h)).i == he_merge_rep(p, he_target(p->m, h)).i;
}

/* The half-edge of the same loop after h that keeps its ends apart. One of the loop must. */
static inline he_halfedge he_merge_after(const he_merge_plan *p, he_halfedge h)
{
    do {
        h = he_next(p->m, h);
    } while (he_merge_shrinks(p, h));
    return h;
}

/* The half-edge that takes the place of h. */
static inline he_halfedge he_merge_heir(const he_merge_plan *p, he_halfedge h)
{
    uint32_t i = he_merge_index(&p->edges, he_edge_of(h).i);
    return i == HE_NONE ? h
                        : (he_halfedge){2 * p->fates[i].into + ((h.i & 1) ^ p->fates[i].turned)};
}

/* Is h's edge there afterwards, and is it h that stands for it? */
static inline bool he_merge_stays(const he_merge_plan *p, he_halfedge h)
{
    uint32_t i = he_merge_index(&p->edges, he_edge_of(h).i);
    return i == HE_NONE ||
           (p->fates[i].into == he_edge_of(h).i &&
            (p->fates[i].occupant[0] != HE_NONE || p->fates[i].occupant[1] != HE_NONE));
}

/* CHECK, in this order; each uses what those before it found. Errors are those of merge.h. */
HE_NODISCARD he_status he_merge_find_group(he_merge_plan *p, he_error *err);
HE_NODISCARD he_status he_merge_find_rings(he_merge_plan *p, he_error *err);
HE_NODISCARD he_status he_merge_find_faces(he_merge_plan *p, he_error *err);
HE_NODISCARD he_status he_merge_pair_edges(he_merge_plan *p, he_error *err);
HE_NODISCARD he_status he_merge_occupy_edges(he_merge_plan *p, he_error *err);
HE_NODISCARD he_status he_merge_find_fans(he_merge_plan *p, he_error *err);

#endif
