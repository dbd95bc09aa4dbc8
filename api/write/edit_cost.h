/* edit_cost.h - estimates whether an edit takes too long for a worker thread.
 *
 * The cost of a local operation depends on the surroundings of its elements: the degree of a
 * vertex, the corners of a face, the length of a hole and, if its row has HE_REACHES, the
 * surroundings of their neighbours. These are usually small, but a face may have a million corners.
 * So the elements that operations name are collected while decoding, and their surroundings counted
 * under the mesh's lock. */
#ifndef HE_API_WRITE_EDIT_COST_H
#define HE_API_WRITE_EDIT_COST_H

#include "api/write/decode_op.h"

/* The elements whose surroundings an edit visits. {0} is empty. Elements named by references are
 * not known yet and are missing. */
typedef struct api_edit_cost {
    he_ids named[HE_KIND_COUNT];
    he_ids reached[HE_KIND_COUNT]; /* elements of parameters with HE_REACHES */
    size_t count;
} api_edit_cost;

void api_edit_cost_clear(api_edit_cost *cost);
/* Collects the elements that `call` names, up to API_COSTLY_ELEMENTS. Returns HE_NO_MEMORY if
 * memory is out. */
HE_NODISCARD he_status api_edit_cost_add(api_edit_cost *cost, const api_call *call, he_error *err);
/* Returns true if there are more than `most` half-edges around the named elements, or more elements
 * than were collected. Visits hardly more than `most` half-edges. */
bool api_edit_cost_exceeds(const api_edit_cost *cost, const he_mesh *mesh, uint64_t most);

/* A cache of degrees while a list of operations runs. A list of a megabyte can name one vertex of
 * 60,000 edges 30,000 times; its degree is counted again only after API_HUB_USES uses, since one
 * operation hardly changes it. {0} is empty. */
typedef struct api_hubs {
    struct {
        uint32_t key; /* twice the id, plus 1 for a face; 0: empty */
        uint32_t uses;
        uint64_t steps;
    } slots[16];
} api_hubs;

/* Returns the steps that one operation walks around the elements of its parameters with HE_WALKS;
 * ids that are not live count nothing. Stops counting above `most`. */
uint64_t api_edit_cost_steps(const api_call *call, const he_mesh *mesh, uint64_t most,
                             api_hubs *hubs);

#endif
