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
    const he_column *barrier; /* the mark `feature` that patches respect, or NULL */
    he_set borders;           /* the edges to be marked */
    he_column *column;        /* the new attribute, or one to compare the present one with */
    /* The values of the column. While patches are searched: the face's parent in a forest, or the
     * label of its patch. In the end: the number of its patch, from 1; 0 for deleted faces. */
    uint32_t *patch;
    uint32_t patches;
} segmentation;

static void clear(segmentation *s)
{
    he_mem_free(s->normals);
    he_column_free(s->column);
    he_set_clear(&s->borders);
}

static he_status prepare(segmentation *s, const he_segment_options *options, he_error *err)
{
    const he_mesh *m = s->m;
    const uint32_t faces = m->c.faces.issued;
    he_status status = he_column_new(
        &(he_column_schema){options->into, HE_FACE, HE_INT32, 1, HE_COPY}, &s->column, err);
    if (status == HE_OK) {
        status = he_column_reserve(s->column, (size_t)faces + 1, err);
    }
    if (status == HE_OK) {
        status = he_set_new(m, HE_EDGE, &s->borders, err);
    }
    if (status != HE_OK) {
        return status;
    }
    s->column->rows = faces;
    s->patch = (uint32_t *)(void *)s->column->data;
    s->barrier = options->features == HE_FEATURES_ADD ? he_mark_find(m, HE_EDGE, "feature") : NULL;
    s->normals = he_mem_array(NULL, (size_t)faces + 1, sizeof *s->normals);
    return s->normals != NULL
               ? he_face_normals(m, m->progress, s->normals, err)
               : he_fail_plain(err, HE_NO_MEMORY, "no memory for the normals of %u faces",
                               m->c.faces.live);
}

/* --- patches by angle --- */

/* How many edges ahead the data of a face are requested from memory. */
enum { AHEAD = 24 };

/* Requests the data of the face of an edge's second half-edge. The faces of first half-edges mostly
 * follow each other, because he_build numbers edges in the order of faces. */
static inline void prefetch(const segmentation *s, uint32_t e)
{
    const he_content *c = &s->m->c;
    if (e < c->edges.issued && c->face[2u * e + 1u] < c->faces.issued) {
        __builtin_prefetch(&s->normals[c->face[2u * e + 1u]]);
        __builtin_prefetch(&s->patch[c->face[2u * e + 1u]], 1);
    }
}

/* Joins the faces on both sides of each edge that is no border, in a forest whose trees are the
 * patches. Returns at the first face without a normal if `*lacks` is false, and sets it. */
static he_status join(segmentation *s, double square, bool *lacks, he_error *err)
{
    const he_mesh *m = s->m;
    const uint32_t faces = m->c.faces.issued, edges = m->c.edges.issued;
    he_status status = HE_OK;
    for (uint32_t f = 0; f < faces; f++) {
        s->patch[f] = f;
    }
    for (uint32_t e = 0; e < edges && status == HE_OK; e++) {
        const uint32_t a = m->c.face[2u * e], b = m->c.face[2u * e + 1u];
        status = he_progress_at(m->progress, e, edges, err);
        prefetch(s, e + AHEAD);
        if (a >= faces || b >= faces) {
            continue; /* the edge is on the boundary, or deleted */
        }
        if (!*lacks && (he_is_no_normal(s->normals[a]) || he_is_no_normal(s->normals[b]))) {
            *lacks = true;
            break;
        }
        if (!he_is_within_chord(s->normals[a], s->normals[b], square)) {
            he_set_add(&s->borders, e);
        } else if (!he_is_marked(s->barrier, e)) {
            (void)he_forest_unite(s->patch, a, b);
        }
    }
    return status;
}

/* Numbers the trees of the forest in the order of their roots, which have the lowest ids. A parent,
 * too, has a lower id than its child, so it has its number when the child needs it. */
static void number(segmentation *s)
{
    const he_content *c = &s->m->c;
    uint32_t *patch = s->patch;
    for (uint32_t f = 0; f < c->faces.issued; f++) {
        if (c->face_halfedge[f] == HE_DEAD) {
            patch[f] = 0;
        } else {
            patch[f] = patch[f] == f ? ++s->patches : patch[patch[f]];
        }
    }
}

static he_status divide(segmentation *s, double angle, he_error *err)
{
    const double square = he_square_chord(angle);
    bool lacks = false;
    he_status status = join(s, square, &lacks, err);
    if (status == HE_OK && lacks) {
        status = he_normals_spread(s->m, s->normals, err);
        if (status == HE_OK) {
            memset(s->borders.bits, 0, ((size_t)s->borders.issued / 64 + 1) * sizeof(uint64_t));
            status = join(s, square, &lacks, err);
        }
    }
    if (status == HE_OK) {
        number(s);
    }
    return status;
}

/* --- patches by planes --- */

/* Finds the areas of all faces, in a unit in which the largest is at most 1. */
static he_status measure(const he_mesh *m, double *areas, he_error *err)
{
    const uint32_t faces = m->c.faces.issued;
    double largest = 0;
    he_status status = HE_OK;
    for (uint32_t f = 0; f < faces && status == HE_OK; f++) {
        status = he_progress_at(m->progress, f, faces, err);
        areas[f] = he_face_is_live(m, (he_face){f}) ? he_face_area(m, (he_face){f}) : 0;
        largest = fmax(largest, areas[f]);
    }
    const int exponent = he_exponent_of(largest);
    for (uint32_t f = 0; f < faces && status == HE_OK; f++) {
        areas[f] = ldexp(areas[f], -exponent);
    }
    return status;
}

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
        if (label != HE_NONE && numbers[label] == 0) {
            numbers[label] = ++s->patches;
        }
        s->patch[f] = label == HE_NONE ? 0 : numbers[label];
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

/* Returns the deviation of he_segmented. */
static he_status find_deviation(const segmentation *s, const double *areas, double *out,
                                he_error *err)
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
        *mean = he_vec3_add(*mean, he_vec3_scale(s->normals[f], areas[f]));
    }
    for (uint32_t p = 0; p <= s->patches; p++) {
        (void)he_vec3_normalise(means[p], &means[p]);
    }
    for (uint32_t f = 0; f < faces; f++) {
        const he_vec3 d = he_vec3_sub(s->normals[f], means[s->patch[f]]);
        sum += areas[f] * he_vec3_dot(d, d);
        area += areas[f];
    }
    he_mem_free(means);
    *out = area > 0 ? sqrt(sum / area) : 0;
    return HE_OK;
}

static he_status fit_planes(segmentation *s, uint32_t planes, double *deviation, he_error *err)
{
    double *areas = he_mem_array(NULL, (size_t)s->m->c.faces.issued + 1, sizeof *areas);
    if (areas == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory for the areas of %u faces",
                             s->m->c.faces.live);
    }
    const he_proxy_task task = {s->m, s->normals, areas, s->barrier, planes};
    he_status status = he_normals_spread(s->m, s->normals, err);
    if (status == HE_OK) {
        status = measure(s->m, areas, err);
    }
    if (status == HE_OK) {
        status = he_proxies_fit(&task, s->patch, err);
    }
    if (status == HE_OK) {
        status = renumber(s, err);
    }
    if (status == HE_OK) {
        status = find_borders(s, err);
    }
    if (status == HE_OK) {
        status = find_deviation(s, areas, deviation, err);
    }
    he_mem_free(areas);
    return status;
}

static he_status find_patches(segmentation *s, const he_segment_options *options, he_segmented *out,
                              he_error *err)
{
    return options->planes > 0 ? fit_planes(s, options->planes, &out->deviation, err)
                               : divide(s, options->angle, err);
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

/* Adds the attribute with the numbers of patches to the mesh, which owns it afterwards. */
static he_status put_patches(he_mesh *m, segmentation *s, he_error *err)
{
    he_status status = he_attribute_put(m, s->column, err);
    if (status == HE_OK) {
        s->column = NULL;
        s->patch = NULL;
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

static he_status write(he_mesh *m, segmentation *s, const he_segment_options *options,
                       he_segmented *out, he_error *err)
{
    const he_column *column = he_mesh_find_column(m, HE_FACE, options->into);
    he_set_counts counts = {0, 0, 0};
    he_bracket bracket;
    he_status status = he_edit_begin(m, &bracket, err);
    if (status != HE_OK) {
        return status;
    }
    status = column == NULL ? put_patches(m, s, err) : write_patches(m, column, s->patch, err);
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
        status = he_progress_phase(m->progress, "dividing", 0.9, err);
    }
    if (status == HE_OK) {
        status = find_patches(&s, options, &done, err);
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
