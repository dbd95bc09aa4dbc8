#include "base/budget.h"

he_status he_budget_exhausted(he_budget *budget, he_error *err)
{
    budget->left = 0;
    return he_fail_plain(
        err, HE_LIMIT,
        "the request needs more computing steps than are left of the steps that it may take");
}

he_status he_budget_ask(he_budget *budget, he_error *err)
{
    budget->unheard = 0;
    return he_progress_step(budget->progress, 0, 1, err);
}
