/* budget.h - how much work may still be done, and whether anybody still wants it.
 *
 * Work is charged in STEPS while it is done, not guessed beforehand: a step is what takes about as
 * long as looking at one half-edge or one box, some nanoseconds. What costs more, such as trying a
 * pair of triangles, is charged as many steps as it is worth. How many steps work takes depends on
 * its input alone, never on a clock or on the number of threads.
 *
 * A budget may carry a watch (watch.h), which is asked every HE_BUDGET_STRIDE steps: work that is
 * charged as it goes can be cancelled within a millisecond. */
#ifndef HE_BASE_BUDGET_H
#define HE_BASE_BUDGET_H

#include "base/watch.h"

typedef struct he_budget {
    uint64_t left;    /* steps; UINT64_MAX: as many as it takes */
    he_watch *watch;  /* borrowed, or NULL */
    uint32_t unheard; /* steps since the watch was asked */
} he_budget;

enum { HE_BUDGET_STRIDE = 1 << 15 };

/* The slow part of he_budget_take, called by it alone: the refusal, and the question to the watch.
 */
HE_NODISCARD he_status he_budget_exhausted(he_budget *budget, he_error *err);
HE_NODISCARD he_status he_budget_ask(he_budget *budget, he_error *err);

/* Charge for `steps` of work, about to be done. Returns HE_LIMIT if fewer are left, and then none
 * is left at all. Returns HE_CANCELLED if the watch gave up. */
HE_NODISCARD static inline he_status he_budget_take(he_budget *budget, uint64_t steps,
                                                    he_error *err)
{
    if (budget->left < steps) {
        return he_budget_exhausted(budget, err);
    }
    budget->left -= steps;
    budget->unheard += steps < HE_BUDGET_STRIDE ? (uint32_t)steps : HE_BUDGET_STRIDE;
    return budget->unheard < HE_BUDGET_STRIDE ? HE_OK : he_budget_ask(budget, err);
}

#endif
