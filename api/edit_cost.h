/* edit_cost.h - is an edit too much for a worker?
 *
 * An operation that is local costs what it lies among: the degree of a vertex, the corners of a
 * face, the length of a hole, and where its row says so (HE_REACHES) what lies about their
 * neighbours. Those are few, but for a face of a million corners. The elements that
 * operations name are gathered as they are decoded, and looked at under the mesh's lock. */
#ifndef HE_API_EDIT_COST_H
#define HE_API_EDIT_COST_H

#include "api/decode_op.h"

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

#endif
