#include "compare/deviation.h"

#include "compare/compare.h"
#include "compare/feature_normals.h"
#include "edit/whole/attribute.h"

#include <string.h>

/* --- checks --- */

/* Finds the attribute that is to be replaced; *out is NULL if there is none. */
static he_status find(const he_mesh *m, const char *name, const he_column **out, he_error *err)
{
    const size_t length = strlen(name);
    if (length == 0 || length >= HE_COLUMN_NAME) {
        return he_fail_plain(err, HE_BAD_VALUE,
                             "the name of an attribute must have 1 to %d bytes, but has %zu",
                             HE_COLUMN_NAME - 1, length);
    }
    if (strcmp(name, "position") == 0) {
        return he_fail_plain(err, HE_BAD_VALUE,
                             "an attribute cannot have the name \"position\", which is built in");
    }
    *out = he_mesh_find_column(m, HE_VERTEX, name);
    if (*out == NULL || (((*out)->type == HE_FLOAT || (*out)->type == HE_DOUBLE) &&
                         (*out)->components == 1 && (*out)->labels == NULL)) {
        return HE_OK;
    }
    return he_fail_plain(err, HE_ATTRIBUTE_CLASH,
                         "the attribute \"%s\" of vertices has %u components of type %s; "
                         "deviations need one float or double",
                         name, (*out)->components, he_type_name((*out)->type));
}

/* --- measuring --- */

/* The surface from which distances are measured. */
typedef struct measuring {
    const he_mesh *with;
    he_bvh *tree;
    he_feature_normals normals;
    he_budget budget;
} measuring;

static he_status prepare(measuring *s, he_progress *progress, he_error *err)
{
    he_status status = he_bvh_new(s->with, progress, &s->tree, err);
    if (status == HE_OK && s->tree->count == 0) {
        status = he_fail_plain(err, HE_NO_FACES, "the mesh to compare with has no faces");
    }
    if (status == HE_OK) {
        status = he_feature_normals_make(s->with, s->tree, &s->budget, &s->normals, err);
    }
    return status;
}

/* Finds the signed distance of a vertex. */
static he_status measure(measuring *s, const he_mesh *m, uint32_t v, uint32_t *hint, double *out,
                         he_error *err)
{
    const he_vec3 p = he_vec3_scale(m->c.position[v], s->tree->scale);
    he_bvh_found found;
    if (!(he_vec3_extent(p) < 0x1p90)) {
        return he_fail(err, HE_LIMIT, HE_VERTEX, v,
                       "vertex %u is more than 2^90 times farther from the origin than the other "
                       "mesh",
                       v);
    }
    he_status status =
        he_bvh_near(s->tree, s->with, &(he_bvh_asked){p, *hint}, &s->budget, &found, err);
    if (status != HE_OK) {
        return status;
    }
    he_vec3 corner[3], way = p;
    he_bvh_corners(s->tree, s->with, found.triangle, corner);
    for (int k = 0; k < 3; k++) {
        way = he_vec3_sub(way, he_vec3_scale(corner[k], found.weight[k]));
    }
    const double distance = he_clamped(ldexp(sqrt(found.far), s->tree->exponent));
    const double side = he_vec3_dot(way, he_feature_normal(&s->normals, &found));
    *hint = found.triangle;
    *out = side < 0 ? -distance : distance;
    return HE_OK;
}

/* --- writing --- */

static void put_value(const he_column *column, uint32_t v, double value)
{
    const double most = column->type == HE_FLOAT ? FLT_MAX : DBL_MAX;
    he_column_put_number(column, 0, fmax(fmin(value, most), -most), he_column_row(column, v));
}

static he_status make_column(const he_mesh *m, const char *name, const he_column *former,
                             he_column **out, he_error *err)
{
    const he_column_schema schema = {name, HE_VERTEX, HE_FLOAT, 1, HE_INTERPOLATE};
    if (former != NULL) {
        return he_column_like(former, m->c.vertices.issued, out, err);
    }
    he_status status = he_column_new(&schema, out, err);
    return status == HE_OK ? he_column_extend(*out, m->c.vertices.issued, err) : status;
}

/* Sums of the values, scaled by the largest one, so that squares do not overflow. */
static void add(he_deviated *sums, uint32_t v, double value, double scale)
{
    const double scaled = value * scale;
    if (sums->farthest_vertex == HE_NONE ||
        fabs(value) > fmax(fabs(sums->least), fabs(sums->largest))) {
        sums->farthest_vertex = v;
    }
    sums->least = fmin(sums->least, value);
    sums->largest = fmax(sums->largest, value);
    sums->mean += scaled;
    sums->rms += scaled * scaled;
}

static he_status fill(he_mesh *m, measuring *s, he_column *column, he_deviated *out, he_error *err)
{
    uint32_t hint = HE_NONE;
    he_deviated sums = {HUGE_VAL, -HUGE_VAL, 0, 0, HE_NONE};
    he_status status = HE_OK;
    for (uint32_t v = 0; v < m->c.vertices.issued && status == HE_OK; v++) {
        double value = 0;
        if (!he_mesh_is_live(m, HE_VERTEX, v)) {
            continue;
        }
        status = measure(s, m, v, &hint, &value, err);
        if (status == HE_OK) {
            put_value(column, v, value);
            add(&sums, v, value, s->tree->scale);
            status = he_progress_at(m->progress, v, m->c.vertices.issued, err);
        }
    }
    const uint32_t count = m->c.vertices.live;
    *out = (he_deviated){.farthest_vertex = HE_NONE};
    if (count > 0 && status == HE_OK) {
        *out = sums;
        out->mean = he_clamped(ldexp(sums.mean / count, s->tree->exponent));
        out->rms = he_clamped(ldexp(sqrt(sums.rms / count), s->tree->exponent));
    }
    return status;
}

/* Writes the values that differ from those of an attribute of the mesh. The rows of `column` are
 * moved together. */
static he_status write_changed(he_mesh *m, const he_column *former, he_column *column,
                               he_error *err)
{
    he_ids changed = {0};
    he_status status = HE_OK;
    for (uint32_t v = 0; v < m->c.vertices.issued && status == HE_OK; v++) {
        const unsigned char *value = he_column_row(column, v);
        if (he_mesh_is_live(m, HE_VERTEX, v) &&
            memcmp(value, he_column_value(former, v), column->row_bytes) != 0) {
            memmove(he_column_row(column, changed.count), value, column->row_bytes);
            status = he_ids_add(&changed, v, err);
        }
    }
    if (status == HE_OK && changed.count > 0) {
        status =
            he_attribute_write(m, former, changed.ids, changed.count, column->data, false, err);
    }
    he_ids_clear(&changed);
    return status;
}

static he_status commit(he_mesh *m, const he_column *former, he_column **takes, he_error *err)
{
    if (former != NULL) {
        return write_changed(m, former, *takes, err);
    }
    he_status status = he_attribute_put(m, *takes, err);
    *takes = status == HE_OK ? NULL : *takes;
    return status;
}

he_status he_deviation(he_mesh *m, const he_mesh *with, const char *attribute, he_deviated *out,
                       he_error *err)
{
    const he_column *former = NULL;
    he_column *column = NULL;
    he_deviated done;
    const he_compared both[2] = {{.mesh = m}, {.mesh = with}};
    measuring s = {.with = with,
                   .budget = {.left = he_compare_budget(both), .progress = m->progress}};
    he_status status = find(m, attribute, &former, err);
    if (status == HE_OK) {
        status = prepare(&s, m->progress, err);
    }
    if (status == HE_OK) {
        status = he_progress_phase(m->progress, "measuring deviations", 1, err);
    }
    if (status == HE_OK) {
        status = make_column(m, attribute, former, &column, err);
    }
    if (status == HE_OK) {
        status = fill(m, &s, column, &done, err);
    }
    if (status == HE_OK) {
        status = commit(m, former, &column, err);
    }
    if (status == HE_OK && out != NULL) {
        *out = done;
    }
    he_column_free(column);
    he_feature_normals_clear(&s.normals);
    he_bvh_free(s.tree);
    return status;
}
