/* edit_cost.h - is an edit too much for a worker?
 *
 * An operation that is local costs what it lies among: the degree of a vertex, the corners of a
 * face, the length of a hole, and where its row says so (HE_REACHES) what lies about their
 * neighbours. Those are few, but for a face of a million corners. The elements that
 * operations name are gathered as they are decoded, and looked at under the mesh's lock. */
#ifndef HE_API_WRITE_EDIT_COST_H
#define HE_API_WRITE_EDIT_COST_H

#include "api/write/decode_op.h"

/* Cleared by {0}. What references stand for is not known yet and left out. */
typedef struct api_edit_cost {
    he_ids named[HE_KIND_COUNT];
    he_ids reached[HE_KIND_COUNT]; /* of parameters that reach further */
    size_t count;
} api_edit_cost;

void api_edit_cost_clear(api_edit_cost *cost);
/* Gather what `call` names, until API_COSTLY_ELEMENTS are; HE_NO_MEMORY. */
HE_NODISCARD he_status api_edit_cost_add(api_edit_cost *cost, const api_call *call, he_error *err);
/* Are there more than `most` half-edges about the named elements, or more elements than were
 * gathered? Looks at hardly more. */
bool api_edit_cost_exceeds(const api_edit_cost *cost, const he_mesh *mesh, uint64_t most);

/* What was counted of hubs while a list of operations runs. A list of a megabyte names one vertex
 * of 60,000 edges 30,000 times: its degree is counted anew only after API_HUB_USES looks, since one
 * operation hardly changes it. Cleared by {0}. */
typedef struct api_hubs {
    struct {
        uint32_t key; /* twice the id, and 1 of a face; 0 is empty */
        uint32_t uses;
        uint64_t steps;
    } slots[16];
} api_hubs;

/* Steps that one operation walks about the elements of its parameters that say HE_WALKS; ids that
 * are not live are left out. Stops where it has counted more than `most`. */
uint64_t api_edit_cost_steps(const api_call *call, const he_mesh *mesh, uint64_t most,
                             api_hubs *hubs);

#endif
