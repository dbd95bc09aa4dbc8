#include "select/segment.h"

#include "base/forest.h"
#include "edit/whole/attribute.h"
#include "geometry/geometry.h"
#include "geometry/scale.h"
#include "mesh/marks.h"
#include "mesh/write.h"
#include "select/proxies.h"
#include "select/set_write.h"
#include "select/smooth_normals.h"

/* The state of a segmentation, before anything is written. */
typedef struct segmentation {
    const he_mesh *m;
    he_vec3 *normals;         /* of faces */
    double *areas;            /* of faces, divided by a power of two */
    const he_column *barrier; /* the mark `feature` that patches respect, or NULL */
    he_set borders;           /* the edges to be marked */
    uint32_t *patch;          /* of faces: the number of the patch, from 1; 0 for deleted faces */
    uint32_t patches;
} segmentation;

static void clear(segmentation *s)
{
    he_mem_free(s->normals);
    he_mem_free(s->areas);
    he_mem_free(s->patch);
    he_set_clear(&s->borders);
}

static he_status prepare(segmentation *s, const he_segment_options *options, he_error *err)
{
    const he_mesh *m = s->m;
    const uint32_t faces = m->c.faces.issued;
    he_status status = he_smooth_normals(m, &s->normals, err);
    if (status == HE_OK) {
        status = he_set_new(m, HE_EDGE, &s->borders, err);
    }
    if (status != HE_OK) {
        return status;
    }
    s->barrier = options->features == HE_FEATURES_ADD ? he_mark_find(m, HE_EDGE, "feature") : NULL;
    s->areas = he_mem_zero((size_t)faces + 1, sizeof *s->areas);
    s->patch = he_mem_array(NULL, (size_t)faces + 1, sizeof *s->patch);
    return s->areas != NULL && s->patch != NULL
               ? HE_OK
               : he_fail_plain(err, HE_NO_MEMORY, "no memory for the patches of %u faces",
                               m->c.faces.live);
}

/* Finds the areas of all faces, in a unit in which the largest is at most 1. */
static he_status measure(segmentation *s, he_error *err)
{
    const he_mesh *m = s->m;
    const uint32_t faces = m->c.faces.issued;
    double largest = 0;
    he_status status = HE_OK;
    for (uint32_t f = 0; f < faces && status == HE_OK; f++) {
        status = he_progress_at(m->progress, f, faces, err);
        if (he_face_is_live(m, (he_face){f})) {
            s->areas[f] = he_face_area(m, (he_face){f});
            largest = fmax(largest, s->areas[f]);
        }
    }
    const int exponent = he_exponent_of(largest);
    for (uint32_t f = 0; f < faces; f++) {
        s->areas[f] = ldexp(s->areas[f], -exponent);
    }
    return status;
}

/* --- patches by angle --- */

/* Joins the faces on both sides of each edge that is no border, in a forest whose trees are the
 * patches. */
static he_status join(segmentation *s, double angle, he_error *err)
{
    const he_mesh *m = s->m;
    const uint32_t faces = m->c.faces.issued, edges = m->c.edges.issued;
    const double square = he_square_chord(angle);
    he_status status = HE_OK;
    for (uint32_t f = 0; f < faces; f++) {
        s->patch[f] = f;
    }
    for (uint32_t e = 0; e < edges && status == HE_OK; e++) {
        const uint32_t a = m->c.face[2u * e], b = m->c.face[2u * e + 1u];
        status = he_progress_at(m->progress, e, edges, err);
        if (a >= faces || b >= faces) {
            continue; /* the edge is on the boundary, or deleted */
        }
        if (!he_is_within_chord(s->normals[a], s->normals[b], square)) {
            he_set_add(&s->borders, e);
        } else if (!he_is_marked(s->barrier, e)) {
            (void)he_forest_unite(s->patch, a, b);
        }
    }
    return status;
}

/* Numbers the trees of the forest in the order of their roots, which have the lowest ids. */
static void number(segmentation *s)
{
    const uint32_t faces = s->m->c.faces.issued;
    for (uint32_t f = 0; f < faces; f++) {
        s->patch[f] = he_forest_root(s->patch, f);
    }
    for (uint32_t f = 0; f < faces; f++) {
        if (!he_face_is_live(s->m, (he_face){f})) {
            s->patch[f] = 0;
        } else {
            /* The root of another face has a lower id, and so has its number already. */
            s->patch[f] = s->patch[f] == f ? ++s->patches : s->patch[s->patch[f]];
        }
    }
}

/* --- patches by planes --- */

/* Numbers the patches of he_proxies_fit in the order of their lowest face ids. */
static he_status renumber(segmentation *s, he_error *err)
{
    const uint32_t faces = s->m->c.faces.issued;
    uint32_t *numbers = he_mem_zero((size_t)faces + 1, sizeof *numbers);
    if (numbers == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory for the numbers of patches");
    }
    for (uint32_t f = 0; f < faces; f++) {
        const uint32_t label = s->patch[f];
        if (label == HE_NONE) {
            s->patch[f] = 0;
            continue;
        }
        if (numbers[label] == 0) {
            numbers[label] = ++s->patches;
        }
        s->patch[f] = numbers[label];
    }
    he_mem_free(numbers);
    return HE_OK;
}

static he_status find_borders(segmentation *s, he_error *err)
{
    const he_mesh *m = s->m;
    const uint32_t faces = m->c.faces.issued, edges = m->c.edges.issued;
    he_status status = HE_OK;
    for (uint32_t e = 0; e < edges && status == HE_OK; e++) {
        const uint32_t a = m->c.face[2u * e], b = m->c.face[2u * e + 1u];
        status = he_progress_at(m->progress, e, edges, err);
        if (a < faces && b < faces && s->patch[a] != s->patch[b]) {
            he_set_add(&s->borders, e);
        }
    }
    return status;
}

/* --- the result --- */

/* Returns the deviation of he_segmented. */
static he_status find_deviation(const segmentation *s, double *out, he_error *err)
{
    const uint32_t faces = s->m->c.faces.issued;
    he_vec3 *means = he_mem_zero((size_t)s->patches + 1, sizeof *means);
    if (means == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory for the normals of %u patches",
                             s->patches);
    }
    double sum = 0, area = 0;
    for (uint32_t f = 0; f < faces; f++) {
        he_vec3 *mean = &means[s->patch[f]];
        *mean = he_vec3_add(*mean, he_vec3_scale(s->normals[f], s->areas[f]));
    }
    for (uint32_t p = 0; p <= s->patches; p++) {
        (void)he_vec3_normalise(means[p], &means[p]);
    }
    for (uint32_t f = 0; f < faces; f++) {
        const he_vec3 d = he_vec3_sub(s->normals[f], means[s->patch[f]]);
        sum += s->areas[f] * he_vec3_dot(d, d);
        area += s->areas[f];
    }
    he_mem_free(means);
    *out = area > 0 ? sqrt(sum / area) : 0;
    return HE_OK;
}

static he_status find_patches(segmentation *s, const he_segment_options *options, he_error *err)
{
    he_status status = HE_OK;
    if (options->planes == 0) {
        status = join(s, options->angle, err);
        if (status == HE_OK) {
            number(s);
        }
        return status;
    }
    const he_proxy_task task = {s->m, s->normals, s->areas, s->barrier, options->planes};
    status = he_proxies_fit(&task, s->patch, err);
    if (status == HE_OK) {
        status = renumber(s, err);
    }
    return status == HE_OK ? find_borders(s, err) : status;
}

/* --- writing --- */

static he_status check(const he_mesh *m, const he_segment_options *options, he_error *err)
{
    const he_set_into patches = {options->into, 1, HE_SET_ONLY};
    const he_set_into features = {"feature", 0, HE_SET_ADD};
    he_status status = he_set_into_check(m, HE_FACE, &patches, err);
    if (status == HE_OK && options->features != HE_FEATURES_IGNORE) {
        status = he_set_into_check(m, HE_EDGE, &features, err);
    }
    return status;
}

/* Adds the attribute with the numbers of patches to the mesh. */
static he_status put_patches(he_mesh *m, const char *name, const uint32_t *patch, he_error *err)
{
    const uint32_t faces = m->c.faces.issued;
    he_column *made = NULL;
    he_status status =
        he_column_new(&(he_column_schema){name, HE_FACE, HE_INT32, 1, HE_COPY}, &made, err);
    if (status == HE_OK) {
        status = he_column_extend(made, faces, err);
    }
    if (status == HE_OK && faces > 0) {
        memcpy(made->data, patch, faces * sizeof *patch);
    }
    if (status == HE_OK) {
        status = he_attribute_put(m, made, err);
    }
    if (status != HE_OK) {
        he_column_free(made);
    }
    return status;
}

/* Writes the numbers of patches that differ from those in the attribute. */
static he_status write_patches(he_mesh *m, const he_column *column, const uint32_t *patch,
                               he_error *err)
{
    const uint32_t faces = m->c.faces.issued;
    const size_t slot = he_mesh_column_slot(m, column);
    size_t changed = 0;
    for (uint32_t f = 0; f < faces; f++) {
        changed += he_face_is_live(m, (he_face){f}) &&
                   memcmp(he_column_value(column, f), &patch[f], sizeof *patch) != 0;
    }
    he_status status = he_reserve_values(m, slot, changed, err);
    for (uint32_t f = 0; f < faces && status == HE_OK; f++) {
        if (he_face_is_live(m, (he_face){f}) &&
            memcmp(he_column_value(column, f), &patch[f], sizeof *patch) != 0) {
            he_set_attribute(m, slot, f, &patch[f]);
        }
    }
    return status;
}

static he_status write(he_mesh *m, const segmentation *s, const he_segment_options *options,
                       he_segmented *out, he_error *err)
{
    const he_column *column = he_mesh_find_column(m, HE_FACE, options->into);
    he_set_counts counts = {0, 0, 0};
    he_bracket bracket;
    he_status status = he_edit_begin(m, &bracket, err);
    if (status != HE_OK) {
        return status;
    }
    status = column == NULL ? put_patches(m, options->into, s->patch, err)
                            : write_patches(m, column, s->patch, err);
    if (status == HE_OK && options->features != HE_FEATURES_IGNORE) {
        const he_set_into features = {
            "feature", 0, options->features == HE_FEATURES_ADD ? HE_SET_ADD : HE_SET_ONLY};
        status = he_set_write(m, &s->borders, &features, &counts, err);
    }
    status = he_edit_end(m, &bracket, status);
    out->features = counts.selected;
    return status;
}

he_status he_segment(he_mesh *m, const he_segment_options *options, he_segmented *out,
                     he_error *err)
{
    segmentation s = {.m = m};
    he_segmented done = {0, 0, 0};
    he_status status = check(m, options, err);
    if (status == HE_OK) {
        status = he_progress_phase(m->progress, "measuring", 0.3, err);
    }
    if (status == HE_OK) {
        status = prepare(&s, options, err);
    }
    if (status == HE_OK) {
        status = measure(&s, err);
    }
    if (status == HE_OK) {
        status = he_progress_phase(m->progress, "dividing", 0.9, err);
    }
    if (status == HE_OK) {
        status = find_patches(&s, options, err);
    }
    if (status == HE_OK) {
        status = find_deviation(&s, &done.deviation, err);
    }
    if (status == HE_OK) {
        status = he_progress_phase(m->progress, "writing the patches", 1, err);
    }
    if (status == HE_OK) {
        status = write(m, &s, options, &done, err);
    }
    if (status == HE_OK && out != NULL) {
        done.patches = s.patches;
        *out = done;
    }
    clear(&s);
    return status;
}
