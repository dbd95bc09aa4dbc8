/* rules.h - the rules of select.h, one function each. Only core/select uses this header.
 *
 * Every function adds the elements that the rule finds to the set `out`, whose kind is the kind
 * that the rule is asked for. Errors are those of he_select. On failure the set is half filled. */
#ifndef HE_SELECT_RULES_H
#define HE_SELECT_RULES_H

#include "select/select.h"

HE_NODISCARD he_status he_pick_region(const he_mesh *m, const he_select_rule *rule, he_set *out,
                                      he_error *err);
HE_NODISCARD he_status he_pick_component(const he_mesh *m, const he_select_rule *rule, he_set *out,
                                         he_error *err);
HE_NODISCARD he_status he_pick_boundary(const he_mesh *m, const he_select_rule *rule, he_set *out,
                                        he_error *err);
HE_NODISCARD he_status he_pick_grown(const he_mesh *m, const he_select_rule *rule, he_set *out,
                                     he_error *err);
HE_NODISCARD he_status he_pick_shrunk(const he_mesh *m, const he_select_rule *rule, he_set *out,
                                      he_error *err);
HE_NODISCARD he_status he_pick_box(const he_mesh *m, const he_select_rule *rule, he_set *out,
                                   he_error *err);
HE_NODISCARD he_status he_pick_half_space(const he_mesh *m, const he_select_rule *rule, he_set *out,
                                          he_error *err);
HE_NODISCARD he_status he_pick_lasso(const he_mesh *m, const he_select_rule *rule, he_set *out,
                                     he_error *err);
HE_NODISCARD he_status he_pick_cone(const he_mesh *m, const he_select_rule *rule, he_set *out,
                                    he_error *err);
HE_NODISCARD he_status he_pick_measure(const he_mesh *m, const he_select_rule *rule, he_set *out,
                                       he_error *err);
HE_NODISCARD he_status he_pick_attribute(const he_mesh *m, const he_select_rule *rule, he_set *out,
                                         he_error *err);

#endif
