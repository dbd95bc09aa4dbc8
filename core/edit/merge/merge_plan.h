/* merge_plan.h - what a merge of vertices (he_merge_vertices) will do to each element concerned.
 * merge_plan.c computes this plan and merge.c writes it. */
#ifndef HE_EDIT_MERGE_MERGE_PLAN_H
#define HE_EDIT_MERGE_MERGE_PLAN_H

#include "edit/merge/merge.h"
#include "mesh/write.h"

/* What a merge does to an edge if one of its ends is merged, or if a face beside it is deleted. */
typedef struct he_merge_fate {
    /* The id of the edge into which this edge is merged. It is this edge's own id if the edge
     * stays, and HE_NONE if the edge is deleted because its ends become one vertex. */
    uint32_t into;
    /* 1 if this edge e is merged into an edge of the opposite direction, so that half-edge 2e
     * becomes half-edge 2 * into + 1; else 0. */
    uint32_t turned;
    /* If the edge stays: occupant[0] and occupant[1] are the old half-edges whose faces will be to
     * the left of half-edges 2e and 2e + 1. */
    uint32_t occupant[2];
    /* the numbers of faces that would be to the left of half-edges 2e and 2e + 1 */
    uint32_t uses[2];
} he_merge_fate;

/* What a merge will do to each element concerned. Lists of ids are sorted, unless their comment
 * says otherwise. Each array has an entry for each id of the list that is declared last before
 * it. */
typedef struct he_merge_plan {
    he_mesh *m;
    const he_merge *how;
    he_ids group;  /* the vertices to be merged */
    uint32_t *rep; /* the vertex that each vertex of `group` becomes */
    /* Links the vertices of `group` that become one vertex into a list: entry i is the vertex after
     * vertex i of `group` in its list, or HE_NONE at the end. A list begins with the vertex that
     * stays. */
    uint32_t *next;
    he_ids edges;
    he_merge_fate *fates;
    /* A hash table that finds edges that stay by their ends. An entry is 0, or 1 plus the index of
     * an edge in `edges`. */
    uint32_t *slots;
    size_t slot_count;
    he_ids faces;
    /* Says what becomes of each face: HE_NONE if it stays; the id of another face if it is deleted
     * because it will be equal to that face; HE_DEAD if it is deleted because fewer than three
     * corners remain. */
    uint32_t *goes;
    /* the vertices whose half-edges change, without those that are merged into others */
    he_ids rim;
    /* The half-edge that each vertex of `rim` will store; HE_DEAD if the vertex is deleted. */
    uint32_t *stored;
    /* pairs of boundary half-edges, unsorted: the second will be the next of the first */
    he_ids holes;
    size_t corners; /* number of corners of all faces in `faces` */
} he_merge_plan;

/* Returns the index of an id in a sorted list, or HE_NONE if the list does not have it. */
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

/* Returns the vertex into which v is merged, or v itself if it is not merged. */
static inline he_vertex he_merge_rep(const he_merge_plan *p, he_vertex v)
{
    uint32_t i = he_merge_index(&p->group, v.i);
    return i == HE_NONE ? v : (he_vertex){p->rep[i]};
}

/* Returns true if the ends of h become one vertex, so that its edge is deleted. */
static inline bool he_merge_shrinks(const he_merge_plan *p, he_halfedge h)
{
    return he_merge_rep(p, he_origin(p->m, h)).i == he_merge_rep(p, he_target(p->m, h)).i;
}

/* Returns the first half-edge after h in its loop whose ends do not become one vertex. The loop
 * must have such a half-edge. */
static inline he_halfedge he_merge_after(const he_merge_plan *p, he_halfedge h)
{
    do {
        h = he_next(p->m, h);
    } while (he_merge_shrinks(p, h));
    return h;
}

/* Returns the half-edge into which h is merged, or h itself if its edge stays. */
static inline he_halfedge he_merge_heir(const he_merge_plan *p, he_halfedge h)
{
    uint32_t i = he_merge_index(&p->edges, he_edge_of(h).i);
    return i == HE_NONE ? h
                        : (he_halfedge){2 * p->fates[i].into + ((h.i & 1) ^ p->fates[i].turned)};
}

/* Returns true if the edge of h is not merged into another edge or deleted, so that h keeps its
 * id. */
static inline bool he_merge_stays(const he_merge_plan *p, he_halfedge h)
{
    uint32_t i = he_merge_index(&p->edges, he_edge_of(h).i);
    return i == HE_NONE ||
           (p->fates[i].into == he_edge_of(h).i &&
            (p->fates[i].occupant[0] != HE_NONE || p->fates[i].occupant[1] != HE_NONE));
}

/* These functions plan a merge. The caller must call them in this order, because each uses results
 * of the earlier functions. They return the errors that merge.h lists. */
HE_NODISCARD he_status he_merge_find_group(he_merge_plan *p, he_error *err);
HE_NODISCARD he_status he_merge_find_rings(he_merge_plan *p, he_error *err);
HE_NODISCARD he_status he_merge_find_faces(he_merge_plan *p, he_error *err);
HE_NODISCARD he_status he_merge_pair_edges(he_merge_plan *p, he_error *err);
HE_NODISCARD he_status he_merge_occupy_edges(he_merge_plan *p, he_error *err);
HE_NODISCARD he_status he_merge_find_fans(he_merge_plan *p, he_error *err);

#endif
