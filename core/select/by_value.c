#include "select/rules.h"

#include "geometry/geometry.h"
#include "geometry/scale.h"
#include "query/curvature.h"
#include "select/smooth_normals.h"

#include <string.h>

/* The work that measuring curvatures may take, counted as he_curvatures counts it: less than a
 * minute. */
static const uint64_t MOST_CURVATURE_STEPS = (uint64_t)1 << 31;

/* --- the cone of normals --- */

static he_status new_normals(const he_mesh *m, he_kind kind, he_vec3 **out, he_error *err)
{
    *out = he_mem_array(NULL, (size_t)he_mesh_issued(m, kind) + 1, sizeof **out);
    return *out != NULL ? HE_OK
                        : he_fail_plain(err, HE_NO_MEMORY, "no memory for the normals of %s",
                                        he_kind_plural(kind));
}

static bool has_normal(he_vec3 normal)
{
    return normal.x != 0 || normal.y != 0 || normal.z != 0;
}

/* Finds the normal of an edge, the mean of those of its faces. Returns false if the edge has
 * none. */
static bool edge_normal(const he_mesh *m, const he_vec3 *of_faces, uint32_t e, he_vec3 *out)
{
    he_vec3 sum = {0, 0, 0};
    for (unsigned side = 0; side < 2; side++) {
        const uint32_t f = he_face_of(m, he_edge_halfedge((he_edge){e}, side)).i;
        sum = f == HE_NONE ? sum : he_vec3_add(sum, of_faces[f]);
    }
    /* Opposite normals cancel each other out, up to rounding. */
    return he_vec3_extent(sum) > HE_ANGLE_NOISE && he_vec3_normalise(sum, out);
}

he_status he_pick_cone(const he_mesh *m, const he_select_rule *rule, he_set *out, he_error *err)
{
    he_vec3 axis, *normals = NULL;
    if (!he_vec3_is_finite(rule->direction)) {
        return he_fail_plain(err, HE_NOT_FINITE, "the axis of the cone must be finite");
    }
    if (!he_vec3_normalise(rule->direction, &axis)) {
        return he_fail_plain(err, HE_BAD_VALUE, "the axis of the cone must not be zero");
    }
    const double square = he_square_chord(rule->angle);
    const he_kind measured = rule->of == HE_VERTEX ? HE_VERTEX : HE_FACE;
    he_status status = new_normals(m, measured, &normals, err);
    if (status == HE_OK) {
        status = measured == HE_VERTEX
                     ? he_vertex_normals(m, HE_WEIGHT_ANGLE, m->progress, normals, err)
                     : he_face_normals(m, m->progress, normals, err);
    }
    for (uint32_t id = 0; id < out->issued && status == HE_OK; id++) {
        he_vec3 normal = {0, 0, 0};
        status = he_progress_at(m->progress, id, out->issued, err);
        if (rule->of != HE_EDGE) {
            normal = normals[id];
        } else if (he_edge_is_live(m, (he_edge){id}) && !edge_normal(m, normals, id, &normal)) {
            continue;
        }
        if (has_normal(normal) && he_is_within_chord(normal, axis, square)) {
            he_set_add(out, id);
        }
    }
    he_mem_free(normals);
    return status;
}

/* --- measures --- */

/* The kinds of elements that have a measure, as bits. */
static unsigned kinds_of(he_select_measure measure)
{
    switch (measure) {
    case HE_MEASURE_AREA:
    case HE_MEASURE_DEGREE:
        return 1u << HE_VERTEX | 1u << HE_FACE;
    case HE_MEASURE_LENGTH:
    case HE_MEASURE_DIHEDRAL:
        return 1u << HE_EDGE;
    case HE_MEASURE_SMALLEST_ANGLE:
        return 1u << HE_FACE;
    case HE_MEASURE_ANGLE_DEFECT:
    case HE_MEASURE_MEAN_CURVATURE:
    case HE_MEASURE_GAUSSIAN_CURVATURE:
        return 1u << HE_VERTEX;
    }
    return 0;
}

static double curvature_of(const he_curvature *c, he_select_measure measure)
{
    switch (measure) {
    case HE_MEASURE_AREA:
        return c->area;
    case HE_MEASURE_ANGLE_DEFECT:
        return c->angle_defect;
    case HE_MEASURE_MEAN_CURVATURE:
        return c->mean;
    case HE_MEASURE_GAUSSIAN_CURVATURE:
        return c->gaussian;
    case HE_MEASURE_LENGTH:
    case HE_MEASURE_DIHEDRAL:
    case HE_MEASURE_DEGREE:
    case HE_MEASURE_SMALLEST_ANGLE:
        break;
    }
    return NAN;
}

/* Measures an element whose measure needs no array of all elements. */
static double measure_one(const he_mesh *m, const he_select_rule *rule, uint32_t id)
{
    switch (rule->measure) {
    case HE_MEASURE_AREA:
        return he_face_area(m, (he_face){id});
    case HE_MEASURE_LENGTH:
        return he_edge_length(m, (he_edge){id});
    case HE_MEASURE_SMALLEST_ANGLE:
        return he_face_smallest_angle(m, (he_face){id});
    case HE_MEASURE_DEGREE:
        return rule->of == HE_FACE ? he_face_degree(m, (he_face){id})
                                   : he_vertex_degree(m, (he_vertex){id});
    case HE_MEASURE_DIHEDRAL:
    case HE_MEASURE_ANGLE_DEFECT:
    case HE_MEASURE_MEAN_CURVATURE:
    case HE_MEASURE_GAUSSIAN_CURVATURE:
        break;
    }
    return NAN;
}

/* Adds an element to the set if its value is in the range of the rule; NaN is not. */
static void judge(const he_select_rule *rule, uint32_t id, double value, he_set *out)
{
    if (value >= rule->from && value <= rule->to) {
        he_set_add(out, id);
    }
}

static he_status pick_dihedral(const he_mesh *m, const he_select_rule *rule, he_set *out,
                               he_error *err)
{
    double *angles = he_mem_array(NULL, (size_t)out->issued + 1, sizeof *angles);
    if (angles == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory for the angles at %u edges",
                             m->c.edges.live);
    }
    he_status status = he_edge_dihedrals(m, m->progress, angles, err);
    for (uint32_t e = 0; e < out->issued && status == HE_OK; e++) {
        judge(rule, e, angles[e], out);
    }
    he_mem_free(angles);
    return status;
}

static he_status pick_curvature(const he_mesh *m, const he_select_rule *rule, he_set *out,
                                he_error *err)
{
    const size_t count = m->c.vertices.live;
    he_curvature *all = he_mem_array(NULL, count + 1, sizeof *all);
    if (all == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory for the curvature of %zu vertices",
                             count);
    }
    he_status status = he_curvatures(m, NULL, count, MOST_CURVATURE_STEPS, m->progress, all, err);
    size_t i = 0;
    for (uint32_t v = 0; v < out->issued && status == HE_OK; v++) {
        if (he_vertex_is_live(m, (he_vertex){v})) {
            judge(rule, v, curvature_of(&all[i++], rule->measure), out);
        }
    }
    he_mem_free(all);
    return status;
}

static he_status pick_each(const he_mesh *m, const he_select_rule *rule, he_set *out, he_error *err)
{
    he_status status = HE_OK;
    for (uint32_t id = 0; id < out->issued && status == HE_OK; id++) {
        status = he_progress_at(m->progress, id, out->issued, err);
        if (he_mesh_is_live(m, out->kind, id)) {
            judge(rule, id, measure_one(m, rule, id), out);
        }
    }
    return status;
}

static he_status check_range(const he_select_rule *rule, he_error *err)
{
    return rule->from <= rule->to
               ? HE_OK
               : he_fail_plain(err, HE_BAD_VALUE,
                               "the range is empty: from %.17g is above to %.17g", rule->from,
                               rule->to);
}

he_status he_pick_measure(const he_mesh *m, const he_select_rule *rule, he_set *out, he_error *err)
{
    const he_select_measure measure = rule->measure;
    he_status status = check_range(rule, err);
    if (status != HE_OK) {
        return status;
    }
    if ((kinds_of(measure) & 1u << rule->of) == 0) {
        return he_fail_plain(err, HE_BAD_VALUE, "%s do not have this measure",
                             he_kind_plural(rule->of));
    }
    if (measure == HE_MEASURE_DIHEDRAL) {
        return pick_dihedral(m, rule, out, err);
    }
    if (rule->of == HE_VERTEX && measure != HE_MEASURE_DEGREE) {
        return pick_curvature(m, rule, out, err);
    }
    return pick_each(m, rule, out, err);
}

/* --- attributes --- */

he_status he_pick_attribute(const he_mesh *m, const he_select_rule *rule, he_set *out,
                            he_error *err)
{
    const char *kinds = he_kind_plural(rule->of);
    he_status status = check_range(rule, err);
    if (status != HE_OK) {
        return status;
    }
    he_column positions;
    const he_column *column = he_mesh_find_column(m, rule->of, rule->attribute);
    if (rule->of == HE_VERTEX && strcmp(rule->attribute, "position") == 0) {
        he_mesh_position_column(m, &positions);
        column = &positions;
    }
    if (column == NULL) {
        return he_fail_plain(err, HE_NO_SUCH_ATTRIBUTE, "%s have no attribute \"%.80s\"", kinds,
                             rule->attribute);
    }
    if (rule->component >= column->components) {
        return he_fail_plain(
            err, HE_BAD_VALUE,
            "the attribute \"%s\" has %u components, counted from 0, so there is no "
            "component %u",
            column->name, column->components, rule->component);
    }
    for (uint32_t id = 0; id < out->issued && status == HE_OK; id++) {
        status = he_progress_at(m->progress, id, out->issued, err);
        if (he_mesh_is_live(m, rule->of, id)) {
            judge(rule, id, he_column_number(column, id, rule->component), out);
        }
    }
    return status;
}
