#include "select/rules.h"

#include "geometry/vec3.h"

/* Adds the elements whose corners the set `vertices` has to `out`, and frees `vertices`. `status`
 * is the status of the search for the vertices, and returned if it is a failure. */
static he_status finish(const he_mesh *m, const he_select_rule *rule, he_set *vertices, he_set *out,
                        he_status status, he_error *err)
{
    if (status == HE_OK) {
        status = he_set_of_vertices(m, vertices, rule->corners, out, err);
    }
    he_set_clear(vertices);
    return status;
}

static he_status check_box(const he_select_rule *rule, he_error *err)
{
    const he_vec3 low = rule->low, high = rule->high;
    if (!he_vec3_is_finite(low) || !he_vec3_is_finite(high)) {
        return he_fail_plain(err, HE_NOT_FINITE, "the corners of the box must be finite");
    }
    const double lows[3] = {low.x, low.y, low.z}, highs[3] = {high.x, high.y, high.z};
    for (int i = 0; i < 3; i++) {
        if (lows[i] > highs[i]) {
            return he_fail_plain(
                err, HE_BAD_VALUE,
                "the %c of the box's corner min, %.17g, is above that of max, %.17g", "xyz"[i],
                lows[i], highs[i]);
        }
    }
    return HE_OK;
}

he_status he_pick_box(const he_mesh *m, const he_select_rule *rule, he_set *out, he_error *err)
{
    const he_vec3 low = rule->low, high = rule->high;
    he_set in = {.bits = NULL};
    he_status status = check_box(rule, err);
    if (status == HE_OK) {
        status = he_set_new(m, HE_VERTEX, &in, err);
    }
    for (uint32_t v = 0; v < in.issued && status == HE_OK; v++) {
        const he_vec3 p = he_position(m, (he_vertex){v});
        status = he_progress_at(m->progress, v, in.issued, err);
        if (p.x >= low.x && p.x <= high.x && p.y >= low.y && p.y <= high.y && p.z >= low.z &&
            p.z <= high.z && he_vertex_is_live(m, (he_vertex){v})) {
            he_set_add(&in, v);
        }
    }
    return finish(m, rule, &in, out, status, err);
}

he_status he_pick_half_space(const he_mesh *m, const he_select_rule *rule, he_set *out,
                             he_error *err)
{
    he_set in = {.bits = NULL};
    he_sides sides = {.distance = NULL};
    he_status status = he_sides_find(m, &rule->plane, &sides, err);
    if (status == HE_OK) {
        status = he_set_new(m, HE_VERTEX, &in, err);
    }
    for (uint32_t v = 0; v < in.issued && status == HE_OK; v++) {
        if (he_vertex_is_live(m, (he_vertex){v}) && he_side_of(&sides, (he_vertex){v}) >= 0) {
            he_set_add(&in, v);
        }
    }
    he_sides_clear(&sides);
    return finish(m, rule, &in, out, status, err);
}

he_status he_pick_lasso(const he_mesh *m, const he_select_rule *rule, he_set *out, he_error *err)
{
    he_set in = {.bits = NULL};
    he_noose *noose = NULL;
    he_status status = he_noose_new(&rule->lasso, &noose, err);
    if (status == HE_OK) {
        status = he_set_new(m, HE_VERTEX, &in, err);
    }
    for (uint32_t v = 0; v < in.issued && status == HE_OK; v++) {
        status = he_progress_at(m->progress, v, in.issued, err);
        if (he_vertex_is_live(m, (he_vertex){v}) &&
            he_noose_holds(noose, he_position(m, (he_vertex){v}))) {
            he_set_add(&in, v);
        }
    }
    he_noose_free(noose);
    return finish(m, rule, &in, out, status, err);
}
