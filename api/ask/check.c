/* check.c - GET .../check: reports broken invariants, and defects that a valid mesh may have.
 *
 * A check visits the mesh several times, so for a large mesh it becomes a job if the client would
 * not wait that long. Self-intersections, which take longest, are searched for only on request. */
#include "api/request/handlers.h"

#include "api/ask/records.h"
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

/* What was found, from which the JSON members of the answer are written. */
typedef struct report {
    const he_mesh *mesh;
    uint64_t revision;
    bool valid;
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
    r->valid = r->broken == 0;
    if (!r->valid) {
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

static void write_rule(api_out *out, const void *rule)
{
    char text[16];
    snprintf(text, sizeof text, "I%d", *(const int *)rule);
    api_out_string(out, text);
}

static void write_kind(api_out *out, const void *kind)
{
    api_out_string(out, he_kind_name(*(const he_kind *)kind));
}

static const api_field broken_fields[] = {
    API_FIELD_MADE_OF("rule", "text", he_problem, rule, write_rule, .required = true,
                      .doc = "The number of the invariant, I1 to I13."),
    API_FIELD_MADE_OF("kind", "#element_kind", he_problem, kind, write_kind, .required = true),
    API_FIELD("id", "id", he_problem, id, .required = true),
    API_FIELD("detail", "text", he_problem, text, .required = true),
};
const api_record api_broken_record = API_RECORD("broken", broken_fields);

static void write_problems(api_out *out, const void *value)
{
    const report *r = value;
    api_out_array_begin(out);
    for (size_t i = 0; i < r->broken && i < NAMED; i++) {
        api_record_write(out, &api_broken_record, &r->problems[i]);
    }
    api_out_array_end(out);
}

/* The values of the JSON members of a defect. */
typedef struct shown_defect {
    const char *code;
    he_kind kind;
    he_defect_found found;
    char text[HE_PROBLEM_TEXT];
    bool has_other, has_value;
} shown_defect;

static const api_field defect_fields[] = {
    API_FIELD("code", "text", shown_defect, code, .required = true),
    API_FIELD_MADE_OF("kind", "#element_kind", shown_defect, kind, write_kind, .required = true),
    API_FIELD("id", "id", shown_defect, found.id, .required = true),
    API_FIELD("detail", "text", shown_defect, text, .required = true),
    API_FIELD("other", "id", shown_defect, found.other, .known = API_KNOWN(shown_defect, has_other),
              .doc = "The other vertex in the same place, or the other face, which this face "
                     "intersects."),
    API_FIELD("value", "number", shown_defect, found.value,
              .known = API_KNOWN(shown_defect, has_value),
              .doc = "The measured distance, length, width, diagonal or volume."),
};
const api_record api_defect_record = API_RECORD("defect", defect_fields);

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

static void write_defects(api_out *out, const void *value)
{
    const report *r = value;
    api_out_array_begin(out);
    for (he_defect_code code = 0; code < HE_DEFECTS; code++) {
        const he_defect_list *list = &r->defects.of[code];
        for (uint32_t i = 0; i < list->count; i++) {
            shown_defect shown = {.code = he_defect_name(code),
                                  .kind = he_defect_kind(code),
                                  .found = list->listed[i],
                                  .has_other = list->listed[i].other != HE_NONE};
            shown.has_value = describe(r->mesh, code, &shown.found, shown.text, sizeof shown.text);
            api_record_write(out, &api_defect_record, &shown);
        }
    }
    api_out_array_end(out);
}

static void write_totals(api_out *out, const void *value)
{
    const report *r = value;
    api_out_object_begin(out);
    api_out_key_u64(out, "problems", r->broken);
    for (he_defect_code code = 0; code < HE_DEFECTS; code++) {
        if (code != HE_DEFECT_INTERSECTION || r->meets) {
            api_out_key_u64(out, he_defect_name(code), r->defects.of[code].total);
        }
    }
    api_out_object_end(out);
}

static const api_field thresholds_fields[] = {
    API_FIELD("merge", "number", he_thresholds, merge, .required = true),
    API_FIELD("flat", "number", he_thresholds, flat, .required = true),
    API_FIELD("small", "number", he_thresholds, small, .required = true),
};
const api_record api_thresholds_record = API_RECORD("thresholds", thresholds_fields);

static const api_field check_fields[] = {
    API_FIELD("revision", "count", report, revision, .required = true),
    API_FIELD("valid", "flag", report, valid, .required = true),
    API_FIELD_MADE("problems", "*#broken", write_problems, .required = true,
                   .doc = "Broken invariants."),
    API_FIELD_MADE("defects", "*#defect", write_defects, .required = true,
                   .doc = "Defects that a valid mesh may have, such as a bow-tie."),
    API_FIELD_MADE("totals", "#totals", write_totals, .required = true,
                   .doc = "The number of defects with each code; the first 100 of each are listed. "
                          "`self_intersection` is present if the request asked for it."),
    API_FIELD_RECORD("thresholds", "#thresholds", report, thresholds, &api_thresholds_record,
                     .required = true,
                     .doc = "The lengths that decide what is a defect: given by the request, or "
                            "derived from the bounding box of the edges. 0 if the mesh is not "
                            "valid, because defects are then not searched for."),
    API_FIELD("complete", "flag", report, complete, .required = true,
              .doc = "False if the search stopped at 1048576 pairs of intersecting faces, so that "
                     "there may be more."),
};
const api_record api_check_record = API_RECORD("check", check_fields);

/* --- the handler of the route --- */

static void answer(api_exchange *x, api_asker *a)
{
    report *r = he_mem_zero(1, sizeof *r);
    if (r == NULL) {
        api_fail_memory(x);
        return;
    }
    r->mesh = a->mesh;
    r->revision = a->revision;
    r->meets = api_param_flag(x, "self_intersections");
    r->complete = true;
    if (examine(a, r)) {
        api_record_write(a->out, &api_check_record, r);
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
