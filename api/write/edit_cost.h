/* edit_cost.h - estimates whether an edit takes too long for a worker thread.
 *
 * The cost of a local operation depends on the surroundings of its elements: the degree of a
 * vertex, the corners of a face, the length of a hole and, if the parameter has HE_REACHES, the
 * surroundings of the neighbours. Such numbers are usually small, but a face may have a million
 * corners. So the elements that operations name are collected while decoding, and the half-edges
 * around them are counted while the mesh is locked. */
#ifndef HE_API_WRITE_EDIT_COST_H
#define HE_API_WRITE_EDIT_COST_H

#include "api/write/decode_op.h"

/* The elements that the operations of an edit name. {0} is empty. Elements given by references to
 * results are missing, because they are not known yet. */
typedef struct api_edit_cost {
    he_ids named[HE_KIND_COUNT];
    he_ids reached[HE_KIND_COUNT]; /* elements that were given for parameters with HE_REACHES */
    size_t count;
} api_edit_cost;

void api_edit_cost_clear(api_edit_cost *cost);
/* Collects the elements that `call` names, up to API_COSTLY_ELEMENTS. Returns HE_NO_MEMORY if
 * memory is out. */
HE_NODISCARD he_status api_edit_cost_add(api_edit_cost *cost, const api_call *call, he_error *err);
/* Returns true if there are more than `most` half-edges around the named elements, or if not all
 * named elements were collected, because they were too many. Visits hardly more than `most`
 * half-edges. */
bool api_edit_cost_exceeds(const api_edit_cost *cost, const he_mesh *mesh, uint64_t most);

/* A cache of high degrees of vertices and faces, used while a list of operations runs. A list of a
 * megabyte can name one vertex of 60,000 edges 30,000 times. The vertex's degree is counted again
 * only after API_HUB_USES uses, because one operation hardly changes it. {0} is empty. */
typedef struct api_hubs {
    struct {
        uint32_t key; /* 2 * id + 2 of a vertex, 2 * id + 3 of a face; 0: the slot is empty */
        uint32_t uses;
        uint64_t steps;
    } slots[16];
} api_hubs;

/* Returns how many steps one operation takes, in all its runs, around the elements of those
 * parameters that have HE_WALKS. Ids of elements that are not live count 0 steps. Counting stops
 * when the number exceeds `most`, which is at most UINT64_MAX / 2. */
uint64_t api_edit_cost_steps(const api_call *call, const he_mesh *mesh, uint64_t most,
                             api_hubs *hubs);

#endif
