/* tree.h - the tree of boxes (query/bvh.h) that rays and nearest points of a revision are asked of.
 *
 * It is made when the first question needs it, on the job pool unless the mesh is small, and kept
 * with the mesh until somebody asks about a later revision or memory is short. Whoever asks while
 * it is being made waits for it, on the job pool. Who holds one may go on asking it when it is no
 * longer kept. */
#ifndef HE_API_ASK_TREE_H
#define HE_API_ASK_TREE_H

#include "api/ask/question.h"
#include "query/bvh.h"

/* The tree of the mesh the asker asks, which holds it to its end. `in` is the question, NULL for
 * none in a body. NULL with the problem filled, or with a->spent. */
const he_bvh *api_asker_tree(api_asker *a, const api_in *in);
void api_tree_release(struct api_tree *tree);

#endif
