#include "select/select.h"

#include "select/rules.h"

static he_status pick(const he_mesh *m, const he_select_rule *rule, he_set *out, he_error *err)
{
    switch (rule->by) {
    case HE_BY_REGION:
        return he_pick_region(m, rule, out, err);
    case HE_BY_COMPONENT:
        return he_pick_component(m, rule, out, err);
    case HE_BY_BOX:
        return he_pick_box(m, rule, out, err);
    case HE_BY_HALF_SPACE:
        return he_pick_half_space(m, rule, out, err);
    case HE_BY_LASSO:
        return he_pick_lasso(m, rule, out, err);
    case HE_BY_CONE:
        return he_pick_cone(m, rule, out, err);
    case HE_BY_MEASURE:
        return he_pick_measure(m, rule, out, err);
    case HE_BY_ATTRIBUTE:
        return he_pick_attribute(m, rule, out, err);
    case HE_BY_GROW:
        return he_pick_grown(m, rule, out, err);
    case HE_BY_SHRINK:
        return he_pick_shrunk(m, rule, out, err);
    case HE_BY_BOUNDARY:
        return he_pick_boundary(m, rule, out, err);
    }
    return HE_OK;
}

he_status he_select(he_mesh *m, const he_select_rule *rule, const he_set_into *into,
                    he_set_counts *out, he_error *err)
{
    he_set found = {.bits = NULL};
    he_status status = he_set_into_check(m, rule->of, into, err);
    if (status == HE_OK) {
        status = he_progress_phase(m->progress, "searching", 0.8, err);
    }
    if (status == HE_OK) {
        status = he_set_new(m, rule->of, &found, err);
    }
    if (status == HE_OK) {
        status = pick(m, rule, &found, err);
    }
    if (status == HE_OK) {
        status = he_progress_phase(m->progress, "writing the set", 1, err);
    }
    if (status == HE_OK) {
        status = he_set_write(m, &found, into, out, err);
    }
    he_set_clear(&found);
    return status;
}
