#include "compare/compare.h"

#include "compare/comparing.h"
#include "geometry/geometry.h"

#include <stdlib.h>

/* The largest ratio of the coordinates of the two surfaces, as a power of two. */
enum { MOST_RATIO = 90 };

he_status he_comparing_report(const he_comparing *c, uint32_t triangle, he_error *err)
{
    return triangle % 256 == 0
               ? he_progress_step(c->budget.progress, triangle, c->from.tree->count, err)
               : HE_OK;
}

void he_comparing_corners(const he_comparing *c, uint32_t triangle, he_vec3 out[3])
{
    const uint32_t *vertex = c->from.tree->triangles[triangle].vertex;
    for (int k = 0; k < 3; k++) {
        const he_vec3 p = c->from.mesh->c.position[vertex[k]];
        out[k] = he_vec3_scale(p, c->to.tree->scale);
    }
}

he_status he_comparing_ask(he_comparing *c, he_vec3 point, uint32_t triangle, uint32_t *nearest,
                           double *distance, he_error *err)
{
    he_bvh_found found;
    he_status status = he_bvh_near(c->to.tree, c->to.mesh, &(he_bvh_asked){point, *nearest},
                                   &c->budget, &found, err);
    if (status != HE_OK) {
        return status;
    }
    *nearest = found.triangle;
    *distance = sqrt(found.far);
    if (*distance > c->lower || c->triangle == HE_NONE) {
        c->lower = *distance;
        c->target = c->lower + c->bound;
        c->at = point;
        c->triangle = triangle;
        c->found = found;
    }
    return HE_OK;
}

double he_comparing_farthest(const he_comparing *c, const he_vec3 *points, uint32_t count,
                             uint32_t to_triangle, uint32_t *farthest)
{
    he_vec3 corner[3];
    double most = -1, weight[3];
    he_bvh_corners(c->to.tree, c->to.mesh, to_triangle, corner);
    for (uint32_t i = 0; i < count; i++) {
        const he_vec3 back = he_bvh_to_triangle(points[i], corner, weight);
        const double square = he_vec3_dot(back, back);
        if (square > most) {
            most = square;
            *farthest = i;
        }
    }
    return sqrt(most);
}

double he_compare_default_bound(const he_compared surfaces[2])
{
    he_box box[2];
    double diagonal;
    (void)he_surface_box(surfaces[0].mesh, &box[0]);
    (void)he_surface_box(surfaces[1].mesh, &box[1]);
    const he_vec3 min = {fmin(box[0].min.x, box[1].min.x), fmin(box[0].min.y, box[1].min.y),
                         fmin(box[0].min.z, box[1].min.z)};
    const he_vec3 max = {fmax(box[0].max.x, box[1].max.x), fmax(box[0].max.y, box[1].max.y),
                         fmax(box[0].max.z, box[1].max.z)};
    he_direction(min, max, &diagonal);
    return fmax(diagonal / 1000, DBL_MIN);
}

/* --- one direction --- */

static he_status reserve(he_comparing *c, he_error *err)
{
    const size_t vertices = c->samples_wanted ? c->from.mesh->c.vertices.issued : 0;
    const size_t triangles = c->from.tree->count;
    c->upper = he_mem_array(NULL, triangles, sizeof *c->upper);
    c->equal = he_bits_new(triangles);
    if (c->samples_wanted) {
        c->first = he_mem_array(NULL, vertices, sizeof *c->first);
        c->nearest = he_mem_array(NULL, vertices, sizeof *c->nearest);
        c->distance = he_mem_array(NULL, vertices, sizeof *c->distance);
    }
    return c->upper != NULL && c->equal != NULL &&
                   (!c->samples_wanted ||
                    (c->first != NULL && c->nearest != NULL && c->distance != NULL))
               ? HE_OK
               : he_fail_plain(err, HE_NO_MEMORY, "no memory to compare %zu triangles", triangles);
}

static void clear(he_comparing *c)
{
    he_mem_free(c->first);
    he_mem_free(c->nearest);
    he_mem_free(c->distance);
    he_mem_free(c->upper);
    he_mem_free(c->equal);
    he_mem_free(c->samples);
}

/* Makes sure that there is a place, also if all triangles are in both surfaces. */
static he_status find_place(he_comparing *c, he_error *err)
{
    if (c->triangle != HE_NONE) {
        return HE_OK;
    }
    he_vec3 corner[3];
    uint32_t nearest = HE_NONE;
    double distance;
    he_comparing_corners(c, 0, corner);
    return he_comparing_ask(c, corner[0], 0, &nearest, &distance, err);
}

/* The fractions of the progress at which a first lower bound, the upper bounds of all triangles and
 * the cuts of each direction are done. */
static const double DONE[2][3] = {{0.1, 0.3, 0.5}, {0.6, 0.8, 1}};

static he_status go(he_comparing *c, int direction, he_error *err)
{
    he_progress *progress = c->budget.progress;
    const bool samples = c->samples_wanted;
    he_status status = reserve(c, err);
    if (status == HE_OK) {
        status = he_progress_phase(progress, "measuring vertices", DONE[direction][0], err);
    }
    if (status == HE_OK) {
        status = he_find_equal_faces(&c->from, &c->to, &c->budget, c->equal, err);
    }
    if (status == HE_OK) {
        status = samples ? he_compare_reach(c, err) : he_compare_scout(c, err);
    }
    if (status == HE_OK) {
        status = he_progress_phase(progress, samples ? "sampling distances" : "bounding triangles",
                                   DONE[direction][1], err);
    }
    if (status == HE_OK) {
        status = samples ? he_compare_sample(c, err) : he_compare_bound(c, err);
    }
    if (status == HE_OK) {
        status = he_progress_phase(progress, "bounding distances", DONE[direction][2], err);
    }
    if (status == HE_OK) {
        status = he_compare_branch(c, err);
    }
    return status == HE_OK ? find_place(c, err) : status;
}

/* Returns a length or coordinate in the unit of the meshes. */
static double in_unit(const he_comparing *c, double x)
{
    return he_clamped(ldexp(x, c->to.tree->exponent));
}

static void tell(const he_comparing *c, he_one_sided *out)
{
    const he_hit hit = he_bvh_tell(c->to.tree, c->to.mesh, &c->found);
    out->lower = in_unit(c, c->lower);
    out->upper = in_unit(c, fmax(c->settled, c->lower));
    out->place = (he_far_place){
        c->from.tree->triangles[c->triangle].face,
        hit.face,
        {in_unit(c, c->at.x), in_unit(c, c->at.y), in_unit(c, c->at.z)},
        hit.point,
    };
    if (c->samples_wanted) {
        out->mean = in_unit(c, c->sum / c->weight);
        out->rms = in_unit(c, sqrt(c->squares / c->weight));
    }
    out->pieces = c->pieces;
    for (uint32_t i = 0; i < c->from.tree->count; i++) {
        out->equal_faces += he_bits_get(c->equal, i) != 0;
    }
}

static void fill_bins(const he_comparing *c, uint32_t bins, double width, he_one_sided *out)
{
    for (uint32_t i = 0; i < bins; i++) {
        out->share[i] = 0;
    }
    for (size_t i = 0; i < c->sample_count; i++) {
        const double at = in_unit(c, c->samples[i].distance) / width;
        out->share[at < bins ? (uint32_t)at : bins - 1] += c->samples[i].weight / c->weight;
    }
}

/* --- both directions --- */

static he_status check(const he_compared surfaces[2], const he_compare_options *options,
                       he_error *err)
{
    for (int i = 0; i < 2; i++) {
        if (surfaces[i].tree->count == 0) {
            return he_fail_plain(err, HE_NO_FACES, "the %s mesh has no faces",
                                 i == 0 ? "first" : "second");
        }
    }
    if (!isfinite(options->bound)) {
        return he_fail_plain(err, HE_NOT_FINITE, "the bound is not finite");
    }
    if (!(options->bound > 0)) {
        return he_fail_plain(err, HE_BAD_VALUE, "the bound must be above 0, but is %g",
                             options->bound);
    }
    if (options->bins > HE_COMPARE_BINS) {
        return he_fail_plain(err, HE_BAD_VALUE, "a histogram has 0 to %d bins, not %u",
                             (int)HE_COMPARE_BINS, options->bins);
    }
    if (abs(surfaces[0].tree->exponent - surfaces[1].tree->exponent) > MOST_RATIO) {
        return he_fail_plain(err, HE_LIMIT,
                             "the coordinates of one mesh are more than 2^%d times larger than "
                             "those of the other one",
                             (int)MOST_RATIO);
    }
    return HE_OK;
}

uint64_t he_compare_budget(const he_compared surfaces[2])
{
    const uint64_t base = (uint64_t)1 << 33, for_each = 8192;
    return base +
           for_each * ((uint64_t)he_mesh_edges(surfaces[0].mesh) + he_mesh_edges(surfaces[1].mesh));
}

he_status he_compare(const he_compared surfaces[2], const he_compare_options *options,
                     he_progress *progress, he_comparison *out, he_error *err)
{
    he_status status = check(surfaces, options, err);
    if (status != HE_OK) {
        return status;
    }
    he_comparing c[2];
    he_comparison done = {.complete = true};
    for (int i = 0; i < 2; i++) {
        const he_compared *to = &surfaces[1 - i];
        c[i] = (he_comparing){.from = surfaces[i],
                              .to = *to,
                              .budget = {.left = he_compare_budget(surfaces), .progress = progress},
                              .bound = ldexp(options->bound, -to->tree->exponent),
                              .most_pieces = options->most_pieces,
                              .samples_wanted = options->bins > 0,
                              .triangle = HE_NONE,
                              .complete = true};
        c[i].target = c[i].bound;
    }
    for (int i = 0; i < 2 && status == HE_OK; i++) {
        status = go(&c[i], i, err);
    }
    for (int i = 0; i < 2 && status == HE_OK; i++) {
        tell(&c[i], &done.side[i]);
        done.lower = fmax(done.lower, done.side[i].lower);
        done.upper = fmax(done.upper, done.side[i].upper);
        done.complete = done.complete && c[i].complete;
    }
    done.bin_width = options->bins == 0 ? 0 : fmax(done.upper / options->bins, DBL_MIN);
    for (int i = 0; i < 2 && status == HE_OK && options->bins > 0; i++) {
        fill_bins(&c[i], options->bins, done.bin_width, &done.side[i]);
    }
    clear(&c[0]);
    clear(&c[1]);
    if (status == HE_OK) {
        *out = done;
    }
    return status;
}
