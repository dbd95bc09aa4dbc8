/* merge_plan.h - what a merge of vertices (he_merge_vertices) will do to each element concerned.
 * merge_plan.c computes this plan and merge.c writes it. */
#ifndef HE_EDIT_MERGE_MERGE_PLAN_H
#define HE_EDIT_MERGE_MERGE_PLAN_H

#include "edit/merge/merge.h"
#include "mesh/write.h"

/* What a merge does to an edge if one of its ends is merged, or if a face beside it is deleted. */
typedef struct he_merge_fate {
    /* The edge into which the edge is merged; its own id if it stays; HE_NONE if its ends become
     * one vertex, so that it is deleted. */
    uint32_t into;
    /* 1 if the edge e is merged into an edge of the opposite direction: half-edge 2e becomes
     * half-edge 2 * into + 1. */
    uint32_t turned;
    /* If the edge stays: occupant[0] and occupant[1] are the old half-edges whose faces will be to
     * the left of half-edges 2e and 2e + 1. */
    uint32_t occupant[2];
    /* the numbers of faces that would be to the left of half-edges 2e and 2e + 1 */
    uint32_t uses[2];
} he_merge_fate;

/* What a merge will do to each element concerned. Lists of ids are sorted, unless their comment
 * says otherwise; each array has an entry for each id of the nearest list declared before the
 * array. */
typedef struct he_merge_plan {
    he_mesh *m;
    const he_merge *how;
    he_ids group;  /* the vertices to be merged */
    uint32_t *rep; /* the vertex that each vertex of `group` becomes */
    /* Links the vertices of `group` that become one vertex into a list: the next vertex of the list
     * for each vertex of `group`. A list begins with the vertex in `rep` and ends with HE_NONE. */
    uint32_t *next;
    he_ids edges;
    he_merge_fate *fates;
    /* A hash table of the edges that stay, by their ends; an entry is the index of an edge in
     * `edges`, plus 1, or 0. */
    uint32_t *slots;
    size_t slot_count;
    he_ids faces;
    /* What becomes of each face: HE_NONE if it stays, HE_DEAD if it is deleted; if it is deleted
     * because another face has the same corners, the id of that face. */
    uint32_t *goes;
    he_ids rim; /* vertices that stay and whose half-edges change */
    /* The half-edge that each vertex of `rim` will store; HE_DEAD if the vertex is deleted. */
    uint32_t *stored;
    /* pairs of boundary half-edges of which the second will be the next of the first; unsorted */
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

/* Returns the vertex into which v is merged; v itself if it is merged into none. */
static inline he_vertex he_merge_rep(const he_merge_plan *p, he_vertex v)
{
    uint32_t i = he_merge_index(&p->group, v.i);
    return i == HE_NONE ? v : (he_vertex){p->rep[i]};
}

/* Returns true if both ends of h are merged into one vertex, so that its edge is deleted. */
static inline bool he_merge_shrinks(const he_merge_plan *p, he_halfedge h)
{
    return he_merge_rep(p, he_origin(p->m, h)).i == he_merge_rep(p, he_target(p->m, h)).i;
}

/* Returns the first half-edge after h in its loop whose ends are not merged into one vertex. There
 * must be one. */
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

/* These functions plan a merge and must be called in this order, because each uses the results of
 * the ones before. They return the errors that merge.h lists. */
HE_NODISCARD he_status he_merge_find_group(he_merge_plan *p, he_error *err);
HE_NODISCARD he_status he_merge_find_rings(he_merge_plan *p, he_error *err);
HE_NODISCARD he_status he_merge_find_faces(he_merge_plan *p, he_error *err);
HE_NODISCARD he_status he_merge_pair_edges(he_merge_plan *p, he_error *err);
HE_NODISCARD he_status he_merge_occupy_edges(he_merge_plan *p, he_error *err);
HE_NODISCARD he_status he_merge_find_fans(he_merge_plan *p, he_error *err);

#endif
