/* budget.h - a limit on how much work a call may still do.
 *
 * Work is charged in STEPS while it is done, not estimated beforehand. A step is work that takes
 * about as long as looking at one half-edge or one box, some nanoseconds; work that takes longer,
 * such as testing a pair of triangles, is charged as several steps. The number of steps depends on
 * the input alone, never on a clock or on the number of threads.
 *
 * A budget may carry a watch (progress and cancellation, progress.h), which is asked every
 * HE_BUDGET_STRIDE steps whether to go on, so that work that is charged while it is done can be
 * cancelled within a millisecond. */
#ifndef HE_BASE_BUDGET_H
#define HE_BASE_BUDGET_H

#include "base/progress.h"

typedef struct he_budget {
    uint64_t left;         /* steps that may still be taken; UINT64_MAX means no limit */
    he_progress *progress; /* the watch, borrowed; NULL if the work cannot be cancelled */
    uint32_t unheard;      /* steps charged since the watch was last asked */
} he_budget;

enum { HE_BUDGET_STRIDE = 1 << 15 };

/* Only he_budget_take calls these two functions: he_budget_exhausted refuses work for which too few
 * steps are left, he_budget_ask asks the watch whether to go on. */
HE_NODISCARD he_status he_budget_exhausted(he_budget *budget, he_error *err);
HE_NODISCARD he_status he_budget_ask(he_budget *budget, he_error *err);

/* Charges `steps` of work that the caller is about to do.
 * Returns HE_LIMIT if fewer steps are left; the budget is then empty.
 * Returns HE_CANCELLED if the work was cancelled. */
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
