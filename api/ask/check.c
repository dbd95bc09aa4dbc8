/* check.c - GET .../check: reports broken invariants, and defects that a valid mesh may have.
 *
 * A check visits the mesh several times, so for a large mesh it becomes a job if the client would
 * not wait that long. Self-intersections, which take longest, are searched for only on request. */
#include "api/request/handlers.h"

#include "api/ask/spatial.h"
#include "mesh/check.h"
#include "mesh/walk.h"
#include "query/defects.h"

#include <assert.h>
#include <stdio.h>

/* How many broken invariants, and how many defects of each code, the report lists; those beyond
 * this number are only counted. */
enum { NAMED = API_PROBLEM_ELEMENTS };
static_assert((int)NAMED == HE_DEFECTS_LISTED,
              "the OpenAPI document states one limit for the listed broken invariants and defects");

/* The progress (0 to 1) of a check when only the search for self-intersections is left to do. */
static const double FOUND = 0.2;

typedef struct report {
    he_problem problems[NAMED];
    size_t broken;
    he_thresholds thresholds;
    he_defects defects;
    bool meets; /* true if the client wants a search for faces that intersect */
    bool complete;
} report;

/* --- finding defects --- */

static he_thresholds read_thresholds(const api_exchange *x, const he_mesh *mesh)
{
    he_thresholds t = he_thresholds_of(mesh);
    return (he_thresholds){api_param_number(x, "merge", t.merge),
                           api_param_number(x, "flat", t.flat),
                           api_param_number(x, "small", t.small), st_secret(x->store)[0]};
}

static bool find_intersections(api_asker *a, report *r)
{
    if (!api_asker_intersections(a, NULL, &r->complete)) {
        return false;
    }
    for (size_t i = 0; i < a->first.count; i += 2) {
        he_defects_add(&r->defects, HE_DEFECT_INTERSECTION, a->first.ids[i], a->first.ids[i + 1],
                       0);
    }
    return true;
}

static bool examine(api_asker *a, report *r)
{
    he_progress *progress = &a->x->progress;
    he_error err = {0};
    if (he_check_with_progress(a->mesh, progress, r->problems, NAMED, &r->broken, &err) != HE_OK) {
        return api_fail_core(a->x, &err);
    }
    if (r->broken > 0) {
        /* The tests for defects rely on valid links, so they are not made on a mesh with broken
         * invariants. */
        return true;
    }
    he_progress_span(progress, r->meets ? FOUND : 1);
    r->thresholds = read_thresholds(a->x, a->mesh);
    if (he_defects_find(a->mesh, &r->thresholds, progress, &r->defects, &err) != HE_OK) {
        return api_fail_core(a->x, &err);
    }
    return !r->meets || find_intersections(a, r);
}

/* --- writing the report --- */

static void write_problems(api_out *out, const report *r)
{
    api_out_key(out, "problems");
    api_out_array_begin(out);
    for (size_t i = 0; i < r->broken && i < NAMED; i++) {
        char rule[16];
        snprintf(rule, sizeof rule, "I%d", r->problems[i].rule);
        api_out_object_begin(out);
        api_out_key_string(out, "rule", rule);
        api_out_key_string(out, "kind", he_kind_name(r->problems[i].kind));
        api_out_key_id(out, "id", r->problems[i].id);
        api_out_key_string(out, "detail", r->problems[i].text);
        api_out_object_end(out);
    }
    api_out_array_end(out);
}

/* Writes one sentence about a defect into `text`. Returns true if the report also shows the value
 * of the defect. */
static bool describe(const he_mesh *m, he_defect_code code, const he_defect_found *d, char *text,
                     size_t size)
{
    switch (code) {
    case HE_DEFECT_BOWTIE:
        snprintf(text, size, "vertex %u has %.0f fans", d->id, d->value);
        return false;
    case HE_DEFECT_ISOLATED:
        snprintf(text, size, "vertex %u has no edge", d->id);
        return false;
    case HE_DEFECT_DUPLICATE:
        snprintf(text, size, "vertex %u is in the same place as vertex %u", d->id, d->other);
        return true;
    case HE_DEFECT_SHORT:
        snprintf(text, size, "edge %u joins vertices %u and %u, which are in the same place", d->id,
                 he_origin(m, he_edge_halfedge((he_edge){d->id}, 0)).i,
                 he_origin(m, he_edge_halfedge((he_edge){d->id}, 1)).i);
        return true;
    case HE_DEFECT_DEGENERATE:
        snprintf(text, size, "face %u has no area", d->id);
        return true;
    case HE_DEFECT_NONPLANAR:
        snprintf(text, size, "face %u is not flat", d->id);
        return true;
    case HE_DEFECT_SMALL:
        snprintf(text, size, "the component of face %u is small", d->id);
        return true;
    case HE_DEFECT_INSIDE_OUT:
        snprintf(text, size, "the component of face %u is closed, and its faces look inward",
                 d->id);
        return true;
    case HE_DEFECT_INTERSECTION:
        snprintf(text, size, "faces %u and %u meet", d->id, d->other);
        return false;
    case HE_DEFECTS:
        break;
    }
    return false;
}

static void write_defects(api_out *out, const he_mesh *m, const report *r)
{
    api_out_key(out, "defects");
    api_out_array_begin(out);
    for (he_defect_code code = 0; code < HE_DEFECTS; code++) {
        const he_defect_list *list = &r->defects.of[code];
        for (uint32_t i = 0; i < list->count; i++) {
            const he_defect_found *d = &list->listed[i];
            char text[HE_PROBLEM_TEXT];
            bool has_value = describe(m, code, d, text, sizeof text);
            api_out_object_begin(out);
            api_out_key_string(out, "code", he_defect_name(code));
            api_out_key_string(out, "kind", he_kind_name(he_defect_kind(code)));
            api_out_key_id(out, "id", d->id);
            api_out_key_string(out, "detail", text);
            if (d->other != HE_NONE) {
                api_out_key_id(out, "other", d->other);
            }
            if (has_value) {
                api_out_key_number(out, "value", d->value);
            }
            api_out_object_end(out);
        }
    }
    api_out_array_end(out);
}

static void write_totals(api_out *out, const report *r)
{
    api_out_key(out, "totals");
    api_out_object_begin(out);
    api_out_key_u64(out, "problems", r->broken);
    for (he_defect_code code = 0; code < HE_DEFECTS; code++) {
        if (code != HE_DEFECT_INTERSECTION || r->meets) {
            api_out_key_u64(out, he_defect_name(code), r->defects.of[code].total);
        }
    }
    api_out_object_end(out);
}

static void write_report(api_asker *a, const report *r)
{
    api_out *out = a->out;
    api_out_object_begin(out);
    api_out_key_u64(out, "revision", a->revision);
    api_out_key_bool(out, "valid", r->broken == 0);
    write_problems(out, r);
    write_defects(out, a->mesh, r);
    write_totals(out, r);
    api_out_key(out, "thresholds");
    api_out_object_begin(out);
    api_out_key_number(out, "merge", r->thresholds.merge);
    api_out_key_number(out, "flat", r->thresholds.flat);
    api_out_key_number(out, "small", r->thresholds.small);
    api_out_object_end(out);
    api_out_key_bool(out, "complete", r->complete);
    api_out_object_end(out);
}

/* --- the handler of the route --- */

static void answer(api_exchange *x, api_asker *a)
{
    report *r = he_mem_zero(1, sizeof *r);
    if (r == NULL) {
        api_fail_memory(x);
        return;
    }
    r->meets = api_param_flag(x, "self_intersections");
    r->complete = true;
    if (examine(a, r)) {
        write_report(a, r);
        api_answer_json(x, 200);
    }
    he_mem_free(r);
}

bool api_check_cost(api_exchange *x, const he_mesh *mesh, api_cost *out)
{
    double rate =
        api_param_flag(x, "self_intersections") ? API_MEET_PER_SECOND : API_CHECK_PER_SECOND;
    out->elements = api_elements_of(mesh);
    out->seconds = (double)out->elements / rate;
    return true;
}

void api_check_get(api_exchange *x)
{
    api_asker_run(x, answer);
}
