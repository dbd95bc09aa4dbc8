#include "fill/fill.h"

#include "fill/patch.h"

#include "base/progress.h"
#include "geometry/geometry.h"
#include "geometry/scale.h"
#include "mesh/layout.h"

#include <float.h>

/* A face may have very many edges of the hole, so the normal of the last one is kept. */
typedef struct last_normal {
    uint32_t face;
    bool known;
    he_vec3 normal;
} last_normal;

static bool find_normal(const he_mesh *m, he_face f, last_normal *last, he_vec3 *out)
{
    if (last->face != f.i) {
        *last = (last_normal){.face = f.i};
        last->known = f.i != HE_NONE && he_face_normal(m, f, &last->normal);
    }
    *out = last->normal;
    return last->known;
}

double he_fill_bend(const he_mesh *m, const he_ids *loop)
{
    double most = 0;
    last_normal inside = {.face = HE_NONE}, outside = {.face = HE_NONE};
    for (size_t i = 0; i < loop->count; i++) {
        const he_halfedge h = {loop->ids[i]};
        he_vec3 a, b;
        if (find_normal(m, he_face_of(m, h), &inside, &a) &&
            find_normal(m, he_face_of(m, he_twin(h)), &outside, &b)) {
            most = fmax(most, he_vec3_angle(a, b));
        }
    }
    return most;
}

/* Tells the lookup of edges about those that the patch will make between corners of the hole. */
static he_status note_chords(const he_patch *p, he_rim_chords *chords, bool add, he_error *err)
{
    he_status status =
        chords->made && !add ? he_edge_lookup_reserve(&chords->lookup, p->rim, err) : HE_OK;
    for (uint32_t s = 0; s < 3 * p->triangles && chords->made && add; s++) {
        const uint32_t a = p->corners[s], b = p->corners[he_patch_next(s)];
        if (p->twins[s] != UINT32_MAX && s < p->twins[s] && a < p->rim && b < p->rim) {
            he_edge_lookup_add(&chords->lookup, he_origin(p->mesh, (he_halfedge){p->loop[a]}),
                               he_origin(p->mesh, (he_halfedge){p->loop[b]}));
        }
    }
    return status;
}

/* Begins the next phase of the progress, if the steps of a patch are phases. */
static he_status begin(const he_patch *p, const he_fill_shared *shared, const char *name, double to,
                       he_error *err)
{
    return shared->phases ? he_progress_phase(p->mesh->progress, name, to, err) : HE_OK;
}

he_status he_fill_loop(he_mesh *m, const he_ids *loop, const he_smooth_fill *options,
                       he_fill_shared *shared, he_filled *out, he_error *err)
{
    he_rim_chords *chords = &shared->chords;
    he_patch p;
    he_patch_values values = {.columns = NULL};
    he_filled made = {.vertex = {HE_NONE}};
    he_status status = he_patch_make(m, loop, chords, &p, err);
    if (status == HE_OK) {
        p.left = shared->left;
        status = begin(&p, shared, "covering the hole", 0.03, err);
    }
    if (status == HE_OK) {
        status = he_patch_cover(&p, err);
    }
    /* The equations are for the surface that they change, so a coarse patch is bent first. It has
     * about a ninth of the triangles, and takes an eighth of the time. */
    static const double coarseness[] = {3, 1}, refined[] = {0.06, 0.3}, faired[] = {0.12, 0.95};
    const double wanted =
        options->edge_length > 0 ? fmax(options->edge_length / p.unit, DBL_MIN) : 0;
    for (size_t i = 0; i < 2 && status == HE_OK; i++) {
        status = begin(&p, shared, "refining", refined[i], err);
        if (status == HE_OK) {
            status = he_patch_refine(&p, wanted, coarseness[i], err);
        }
        if (status == HE_OK) {
            status = begin(&p, shared, "fairing", faired[i], err);
        }
        if (status == HE_OK) {
            status = he_patch_fair(&p, (unsigned)options->continuity, err);
        }
    }
    if (status == HE_OK) {
        status = begin(&p, shared, "finding attributes", 1, err);
    }
    if (status == HE_OK) {
        status = he_patch_values_find(&p, &values, err);
    }
    if (status == HE_OK) {
        status = note_chords(&p, chords, false, err);
    }
    if (status == HE_OK) {
        status = he_patch_write(m, &p, &values, &made.edges, &made.faces, err);
    }
    if (status == HE_OK) {
        made.vertex.i = p.vertices == p.rim + 1 ? he_mesh_issued(m, HE_VERTEX) - 1 : HE_NONE;
        status = note_chords(&p, chords, true, err); /* cannot fail */
        shared->left -= p.triangles;
    }
    he_patch_values_clear(&values);
    he_patch_clear(&p);
    if (status == HE_OK && out != NULL) {
        *out = made;
    } else {
        he_filled_clear(&made);
    }
    return status;
}

he_status he_hole_fill_smooth(he_mesh *m, he_halfedge h, const he_smooth_fill *options,
                              he_filled *out, he_error *err)
{
    he_ids loop = {0};
    he_fill_shared shared = {.left = INFINITY};
    uint64_t steps = UINT64_MAX;
    if (!isfinite(options->edge_length) || options->edge_length < 0) {
        return he_fail_plain(err, HE_BAD_VALUE,
                             "the length of edges must be finite and not below 0");
    }
    he_status status = he_hole_loop(m, h, &loop, err);
    if (status == HE_OK) {
        const double faces = he_fill_foretell(m, h, options, &steps);
        shared.phases = faces >= HE_PROGRESS_STRIDE; /* others are too short for six reports */
        status =
            options->edge_length > 0 ? he_fill_within(faces, options->edge_length, err) : HE_OK;
    }
    if (status == HE_OK) {
        status = he_fill_loop(m, &loop, options, &shared, out, err);
    }
    if (status == HE_OK && out != NULL) {
        out->loop = loop;
        loop = (he_ids){0};
    }
    he_edge_lookup_clear(&shared.chords.lookup);
    he_ids_clear(&loop);
    return status;
}
