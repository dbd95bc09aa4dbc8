/* spatial.c - answers spatial questions: rays, nearest points, and self-intersections. */
#include "api/ask/spatial.h"

#include <float.h>
#include <math.h>

static bool read_max(const api_in *in, double *out)
{
    api_in max;
    *out = HUGE_VAL;
    return !api_in_find(in, "max", &max) || api_in_number_within(&max, 0, DBL_MAX, false, out);
}

/* Writes the point where a ray hits a face, or the nearest point of a face, with its barycentric
 * coordinates. Corners with weight 0 are left out, so a point on an edge has two corners, and a
 * point at a vertex has one. */
static void write_hit(api_out *out, const char *key, const he_hit *hit)
{
    api_out_object_begin(out);
    api_out_key(out, key);
    if (hit->face == HE_NONE) {
        api_out_null(out);
        api_out_object_end(out);
        return;
    }
    api_out_object_begin(out);
    api_out_key_id(out, "face", hit->face);
    api_out_key_number(out, "distance", hit->distance);
    api_out_key_vec3(out, "point", hit->point);
    api_out_key(out, "barycentric");
    api_out_array_begin(out);
    for (int k = 0; k < 3; k++) {
        if (hit->weight[k] > 0) {
            api_out_object_begin(out);
            api_out_key_id(out, "vertex", hit->vertex[k]);
            api_out_key_number(out, "weight", hit->weight[k]);
            api_out_object_end(out);
        }
    }
    api_out_array_end(out);
    api_out_object_end(out);
    api_out_object_end(out);
}

bool api_ray_ask(api_asker *a, const api_in *question)
{
    static const char *const members[] = {"ray", NULL};
    static const char *const parts[] = {"origin", "direction", "max", NULL};
    api_in ray, in, along;
    he_ray cast;
    if (!api_in_only(question, members) || !api_in_need(question, "ray", &ray) ||
        !api_in_only(&ray, parts) || !api_in_need(&ray, "origin", &in) ||
        !api_in_vec3(&in, &cast.origin) || !api_in_need(&ray, "direction", &along) ||
        !api_in_vec3(&along, &cast.direction) || !read_max(&ray, &cast.max)) {
        return false;
    }
    if (cast.direction.x == 0 && cast.direction.y == 0 && cast.direction.z == 0) {
        return api_in_fail(&along, HE_BAD_VALUE, "the ray's direction must not be zero");
    }
    const he_bvh *tree = api_asker_bvh(a, question);
    if (tree == NULL) {
        return false;
    }
    he_hit hit;
    he_error err = {0};
    if (he_bvh_ray(tree, a->mesh, &cast, &a->budget, &hit, &err) != HE_OK) {
        return api_asker_refuse(a, question, &err);
    }
    write_hit(a->out, "hit", &hit);
    return true;
}

bool api_closest_ask(api_asker *a, const api_in *question)
{
    static const char *const members[] = {"closest", "max", NULL};
    api_in in;
    he_vec3 point;
    double max;
    if (!api_in_only(question, members) || !api_in_need(question, "closest", &in) ||
        !api_in_vec3(&in, &point) || !read_max(question, &max)) {
        return false;
    }
    const he_bvh *tree = api_asker_bvh(a, question);
    if (tree == NULL) {
        return false;
    }
    he_hit hit;
    he_error err = {0};
    if (he_bvh_closest(tree, a->mesh, point, max, &a->budget, &hit, &err) != HE_OK) {
        return api_asker_refuse(a, question, &err);
    }
    write_hit(a->out, "closest", &hit);
    return true;
}

static bool write_pairs(api_asker *a, size_t limit, bool complete)
{
    size_t total = a->first.count / 2;
    api_out_object_begin(a->out);
    api_out_key(a->out, "pairs");
    api_out_pairs(a->out, a->first.ids, 2 * (total < limit ? total : limit));
    api_out_key_u64(a->out, "total", total);
    api_out_key_bool(a->out, "complete", complete);
    api_out_object_end(a->out);
    return true;
}

/* Returns the additional steps that the first search for intersections in a request gets, so that a
 * large mesh can be searched. */
static uint64_t granted_for(const api_asker *a)
{
    return a->on_worker || a->has_met ? 0 : API_MEET_STEPS * api_elements_of(a->mesh);
}

bool api_asker_intersections(api_asker *a, const api_in *in, bool *complete)
{
    he_progress *progress = &a->x->progress;
    a->asked = "self_intersections";
    /* Making the tree of boxes takes about half of the time, the search the other half. */
    he_progress_span(progress, 0.5 * (1 + progress->done));
    const he_bvh *tree = api_asker_bvh(a, in);
    if (tree == NULL) {
        return false;
    }
    uint64_t granted = granted_for(a), left = a->budget.left;
    he_budget budget = {.left = left + granted, .progress = progress};
    he_error err = {0};
    a->first.count = 0;
    he_progress_span(progress, 1);
    if (he_bvh_intersections(tree, a->mesh, API_MAX_PAIRS, &budget, &a->first, complete, &err) !=
        HE_OK) {
        return api_asker_refuse(a, in, &err);
    }
    a->budget.left = budget.left < left ? budget.left : left;
    a->has_met = true;
    return budget.left > 0 || *complete || api_asker_exceed(a, in);
}

bool api_self_intersections_ask(api_asker *a, const api_in *question)
{
    static const char *const members[] = {"self_intersections", NULL};
    static const char *const parts[] = {"limit", NULL};
    api_in in, limited;
    uint64_t limit = API_PROBLEM_ELEMENTS;
    if (!api_in_only(question, members) || !api_in_need(question, "self_intersections", &in) ||
        !api_in_only(&in, parts)) {
        return false;
    }
    if (api_in_find(&in, "limit", &limited) && !api_in_u64(&limited, 0, API_MAX_PAIRS, &limit)) {
        return false;
    }
    bool complete;
    double seconds = a->has_met ? 0 : (double)api_elements_of(a->mesh) / API_SEARCH_PER_SECOND;
    if (!api_asker_waits(a, seconds) || !api_asker_intersections(a, question, &complete)) {
        return false;
    }
    size_t total = a->first.count / 2;
    /* Charges the cost of writing the pairs as text. */
    api_asker_pay(a, total < limit ? total : limit);
    return write_pairs(a, (size_t)limit, complete);
}
