#include "remesh/remesh.h"

#include "algo/result_write.h"
#include "edit/piece/list.h"
#include "geometry/geometry.h"
#include "geometry/scale.h"
#include "mesh/walk.h"
#include "mesh/write.h"
#include "remesh/net_make.h"
#include "remesh/net_write.h"
#include "remesh/remeshing.h"
#include "remesh/sizing.h"

const char *const he_remesh_stop_names[HE_REMESH_STOP_COUNT + 1] = {"settled", "steps", NULL};

static he_status require_positive(const char *name, double value, he_error *err)
{
    return value > 0 && isfinite(value)
               ? HE_OK
               : he_fail_plain(err, HE_BAD_VALUE, "%s must be above 0 and finite, not %g", name,
                               value);
}

static he_status check(const he_mesh *m, const he_remesh_options *options, he_error *err)
{
    he_status status = HE_OK;
    switch (options->by) {
    case HE_REMESH_BY_LENGTH:
        status = require_positive("edge_length", options->edge_length, err);
        break;
    case HE_REMESH_BY_FACES:
        if (!(options->target_faces >= 1 && options->target_faces <= HE_REMESH_FACES)) {
            return he_fail_plain(err, HE_BAD_VALUE, "target_faces must be from 1 to %u, not %u",
                                 HE_REMESH_FACES, options->target_faces);
        }
        break;
    case HE_REMESH_BY_ERROR:
        status = require_positive("error", options->error, err);
        break;
    }
    if (status == HE_OK && options->by != HE_REMESH_BY_ERROR &&
        (options->min_length != 0 || options->max_length != 0)) {
        status = he_fail_plain(err, HE_BAD_VALUE, "%s is only allowed together with error",
                               options->min_length != 0 ? "min_length" : "max_length");
    }
    if (status == HE_OK && options->min_length != 0) {
        status = require_positive("min_length", options->min_length, err);
    }
    if (status == HE_OK && options->max_length != 0) {
        status = require_positive("max_length", options->max_length, err);
    }
    if (status == HE_OK && options->max_length != 0 && options->max_length < options->min_length) {
        status = he_fail_plain(err, HE_BAD_VALUE, "max_length %g is less than min_length %g",
                               options->max_length, options->min_length);
    }
    if (status != HE_OK) {
        return status;
    }
    if (options->steps < 1 || options->steps > HE_REMESH_STEPS) {
        return he_fail_plain(err, HE_BAD_VALUE, "steps must be from 1 to %d, not %u",
                             (int)HE_REMESH_STEPS, options->steps);
    }
    if (!(options->crease >= 0 && options->crease <= HE_PI)) {
        return he_fail_plain(err, HE_BAD_VALUE, "crease must be from 0 to pi, not %g",
                             options->crease);
    }
    return options->faces == NULL ? HE_OK
                                  : he_list_require(m, HE_FACE, options->faces, options->face_count,
                                                    HE_REPEATED_ELEMENT, err);
}

/* Estimates how many triangles are needed if edges are `scale` times as long as wanted: so many as
 * have the same area, and for a triangle that is longer but much lower than the length, as many as
 * fit along it. */
typedef struct expected {
    double by_area, in_slivers;
} expected;

static expected estimate(const he_net *n, double scale)
{
    expected sum = {0, 0};
    for (uint32_t t = 0; t < n->triangle_count; t++) {
        if (he_net_is_gone(n, t)) {
            continue;
        }
        const uint32_t *v = n->triangles[t].v;
        const he_net_vertex *p = &n->vertices[v[0]], *q = &n->vertices[v[1]];
        const he_net_vertex *r = &n->vertices[v[2]];
        double length = scale * (double)(p->size + q->size + r->size) / 3;
        double area = 0.5 * he_vec3_length(he_roundness_of(p->p, q->p, r->p).area);
        double longest =
            sqrt(fmax(he_remesh_square(p->p, q->p),
                      fmax(he_remesh_square(q->p, r->p), he_remesh_square(r->p, p->p))));
        sum.by_area += area / (HE_REMESH_MEAN_AREA * length * length);
        if (longest > length && 2 * area < 0.5 * length * longest) {
            sum.in_slivers += longest / length;
        }
    }
    return sum;
}

static double extent_of(const he_net *n)
{
    double most = 0;
    for (uint32_t v = 0; v < n->vertex_count; v++) {
        most = fmax(most, he_vec3_extent(he_net_place(n, v)));
    }
    return 2 * most;
}

static void set_sizes(he_net *n, double length)
{
    for (uint32_t v = 0; v < n->vertex_count; v++) {
        n->vertices[v].size = (float)length;
    }
}

/* Finds the length with which about `target` triangles are needed, not below `least`. */
static double length_for(he_net *n, double target, double least)
{
    double low = least, high = fmax(2 * extent_of(n), least);
    if (!(low > 0)) {
        return 1;
    }
    set_sizes(n, 1);
    while (high > low * (1 + 1e-3)) {
        double middle = sqrt(low * high);
        const expected e = estimate(n, middle);
        if (e.by_area + e.in_slivers > target) {
            low = middle;
        } else {
            high = middle;
        }
    }
    return high;
}

/* Refuses what would make too many triangles. Slivers are counted only if `slivers` is true: where
 * they lie side by side, collapses leave few of them. */
static he_status require_few(const he_net *n, const he_remesh_options *options, bool slivers,
                             he_error *err)
{
    const expected e = estimate(n, 1);
    const double faces = e.by_area + (slivers ? e.in_slivers : 0);
    if (faces <= HE_REMESH_FACES) {
        return HE_OK;
    }
    bool adaptive = options->by == HE_REMESH_BY_ERROR;
    return he_fail_plain(err, HE_LIMIT,
                         "with %s %g there would be about %.3g faces; at most %u are allowed",
                         adaptive ? "error" : "edges of length",
                         adaptive ? options->error : options->edge_length, faces, HE_REMESH_FACES);
}

/* Lengths in coordinates of the net are at most this, so that a float can hold their squares. */
static const double MOST_LENGTH = 1e15;

/* Converts a length to coordinates of the net, and refuses one that is too small. */
static he_status convert(const he_net *n, const char *name, double length, double *out,
                         he_error *err)
{
    double least = HE_REMESH_LEAST * extent_of(n);
    *out = fmin(ldexp(length, -n->exponent), MOST_LENGTH);
    return *out >= least
               ? HE_OK
               : he_fail_plain(err, HE_BAD_VALUE,
                               "%s %g is too small for faces in a box of extent %g: the least is "
                               "%g",
                               name, length, ldexp(extent_of(n), n->exponent),
                               ldexp(least, n->exponent));
}

/* Finds sizes that depend on the curvature. */
static he_status find_sizes(he_net *n, const he_remesh_options *options, he_progress *progress,
                            he_error *err)
{
    he_sizing s = {.most = extent_of(n) * HE_REMESH_MOST_LENGTH};
    he_status status = convert(n, "error", options->error, &s.error, err);
    s.least = fmin(s.error, s.most);
    if (status == HE_OK && options->min_length > 0) {
        status = convert(n, "min_length", options->min_length, &s.least, err);
    }
    if (status == HE_OK && options->max_length > 0) {
        status = convert(n, "max_length", options->max_length, &s.most, err);
    }
    s.most = fmax(s.most, s.least);
    return status == HE_OK ? he_sizing_find(n, &s, progress, err) : status;
}

/* Sets the wanted length at each vertex; *length is the length if it is the same everywhere. */
static he_status find_lengths(he_net *n, const he_remesh_options *options, he_progress *progress,
                              double *length, he_error *err)
{
    he_status status = HE_OK;
    *length = 0;
    switch (options->by) {
    case HE_REMESH_BY_LENGTH:
        status = convert(n, "edge_length", options->edge_length, length, err);
        break;
    case HE_REMESH_BY_FACES:
        *length = length_for(n, options->target_faces, HE_REMESH_LEAST * extent_of(n));
        break;
    case HE_REMESH_BY_ERROR:
        return find_sizes(n, options, progress, err);
    }
    set_sizes(n, *length);
    return status;
}

/* A step has changed almost nothing if it made fewer splits, collapses and flips than this fraction
 * of the triangles, and moved vertices by less than this fraction of the wanted length on the
 * average. */
static const double FEW_CHANGES = 2e-3, SMALL_MOVES = 0.01;

static bool has_settled(const he_remeshing *r)
{
    return (double)r->changes <= FEW_CHANGES * r->net.live_triangles &&
           r->moved <= SMALL_MOVES * r->net.live_vertices;
}

/* How often all edges are tested for flips in the first step, and at the end. */
enum { FIRST_SWEEPS = 3, LAST_SWEEPS = 4 };

/* The net is put into order again in the first step if this fraction of its triangles are new after
 * the splits; and at the end of the first step, after which only few triangles change. */
static const double MANY_NEW = 0.5;

static he_status step(he_remeshing *r, bool first, he_error *err)
{
    he_net *n = &r->net;
    uint32_t before = n->triangle_count;
    r->changes = 0;
    r->moved = 0;
    he_status status = he_remesh_split(r, first, err);
    if (status == HE_OK && n->triangle_count - before > MANY_NEW * n->triangle_count) {
        status = he_net_tidy(n, err);
    }
    if (status == HE_OK) {
        status = he_remesh_collapse(r, first, err);
    }
    if (status == HE_OK) {
        status = he_remesh_flip(r, HE_FLIP_DEGREES, first ? FIRST_SWEEPS : 1, err);
    }
    if (status == HE_OK) {
        status = he_remesh_relax(r, err);
    }
    return status == HE_OK && first ? he_net_tidy(n, err) : status;
}

/* Makes angles even: what the steps leave are edges that bring degrees nearer to 6, but not
 * angles. */
static he_status finish_angles(he_remeshing *r, he_error *err)
{
    he_status status = he_remesh_flip(r, HE_FLIP_ANGLES, LAST_SWEEPS, err);
    if (status == HE_OK) {
        status = he_remesh_relax(r, err);
    }
    for (unsigned i = 0; i < 2 && status == HE_OK; i++) {
        status = he_remesh_flip(r, HE_FLIP_ANGLES, LAST_SWEEPS, err);
        if (status == HE_OK) {
            status = he_remesh_round(r, err);
        }
    }
    return status == HE_OK && r->project ? he_remesh_fit(r, err) : status;
}

/* The reported progress (0 to 1) after the preparations, and after all steps. */
static const double PREPARED = 0.1, STEPPED = 0.9;

/* If a number of faces is wanted, the length that was estimated first is changed by at most this
 * factor: the number may be out of reach, because of frozen edges. */
static const double MOST_CHANGE = 2;

static he_status run_steps(he_remeshing *r, const he_remesh_options *options, double length,
                           he_remesh_stop *stop, he_error *err)
{
    const double first = length;
    *stop = HE_REMESH_DONE;
    /* Short edges are collapsed before the first split: otherwise long edges beside them would be
     * cut into more pieces than are needed. */
    he_status status = he_remesh_collapse(r, true, err);
    if (status == HE_OK && options->by != HE_REMESH_BY_FACES) {
        status = require_few(&r->net, options, true, err);
    }
    for (unsigned i = 0; i < options->steps && status == HE_OK; i++) {
        double to = PREPARED + (STEPPED - PREPARED) * (i + 1) / options->steps;
        /* The steps of a small mesh are too short to be told of one by one. */
        if (i == 0 || r->net.triangle_count >= HE_PROGRESS_STRIDE) {
            status = he_progress_phase(r->progress, "remeshing", to, err);
        }
        if (status == HE_OK) {
            status = step(r, i == 0, err);
        }
        if (status == HE_OK && options->by == HE_REMESH_BY_FACES) {
            double wrong = sqrt((double)r->net.live_triangles / options->target_faces);
            length = fmin(fmax(length * wrong, first / MOST_CHANGE), first * MOST_CHANGE);
            set_sizes(&r->net, length);
        }
        if (status == HE_OK && has_settled(r)) {
            *stop = HE_REMESH_SETTLED;
            break;
        }
    }
    if (status == HE_OK) {
        status = he_progress_phase(r->progress, "making angles even", STEPPED, err);
    }
    return status == HE_OK ? finish_angles(r, err) : status;
}

/* Makes the net and the ground, and runs all steps. */
static he_status compute(const he_mesh *m, const he_remesh_options *options, he_remeshing *r,
                         he_remesh_stop *stop, he_error *err)
{
    const he_net_choice choice = {options->faces, options->face_count, options->crease,
                                  options->fixed_boundary, options->keep_seams};
    double length = 0;
    he_status status = he_progress_phase(r->progress, "preparing", PREPARED, err);
    if (status == HE_OK) {
        status = he_net_make(m, &choice, &r->net, err);
    }
    if (status == HE_OK) {
        status = find_lengths(&r->net, options, r->progress, &length, err);
    }
    if (status == HE_OK && options->by != HE_REMESH_BY_FACES) {
        status = require_few(&r->net, options, false, err);
    }
    if (status == HE_OK) {
        r->net.most_triangles = HE_REMESH_FACES;
        status = he_ground_copy(&r->net, options->by == HE_REMESH_BY_ERROR, &r->ground, err);
    }
    return status == HE_OK ? run_steps(r, options, length, stop, err) : status;
}

/* Writes the result. Changed faces of a small set are recorded one by one. */
static he_status write(he_mesh *m, he_remeshing *r, he_error *err)
{
    he_mesh *copy = NULL;
    bool replace =
        r->ground.triangle_count > HE_REMESH_RECORDED || r->net.live_triangles > HE_REMESH_RECORDED;
    he_status status = he_progress_phase(r->progress, "writing", 1, err);
    if (status == HE_OK) {
        status = he_net_write(&r->net, &r->ground, m, &copy, err);
    }
    if (status == HE_OK && m->c.column_count > 0) {
        status = he_net_carry(&r->net, &r->ground, m, copy, err);
    }
    if (status == HE_OK && replace) {
        he_mesh_set_progress(copy, NULL);
        status = he_mesh_replace(m, copy, HE_KEEPS_IDS, err);
        copy = status == HE_OK ? NULL : copy;
    } else if (status == HE_OK) {
        status = he_result_write(m, copy, 0, err);
    }
    he_mesh_free(copy);
    return status;
}

/* --- the report --- */

/* What the report is made of: the sum and the number of the lengths of edges, and the cotangents of
 * the smallest and the largest angle so far. */
typedef struct measured {
    double sum;
    uint64_t count;
    double of_smallest, of_largest;
} measured;

/* Measures an angle if it is the smallest or largest one so far. The sides at all three angles of a
 * triangle have the same cross product, so that comparing the cotangents needs one square root for
 * the triangle, and no arc tangent for most triangles. `area` is the length of that product. */
static void look_at_angle(he_vec3 along, he_vec3 back, double area, measured *of, he_remeshed *out)
{
    const double cotangent = he_vec3_dot(along, back) / area;
    const bool is_flat = !(area > 0);
    if (is_flat || cotangent >= of->of_smallest) {
        of->of_smallest = is_flat ? of->of_smallest : cotangent;
        out->smallest_angle = fmin(out->smallest_angle, he_vec3_angle(along, back));
    }
    if (is_flat || cotangent <= of->of_largest) {
        of->of_largest = is_flat ? of->of_largest : cotangent;
        out->largest_angle = fmax(out->largest_angle, he_vec3_angle(along, back));
    }
}

static void look_at(const he_net *n, uint32_t t, measured *of, he_remeshed *out)
{
    const he_net_triangle *at = &n->triangles[t];
    he_vec3 side[3];
    for (unsigned i = 0; i < 3; i++) {
        side[i] =
            he_vec3_sub(he_net_place(n, at->v[i == 2 ? 0 : i + 1]), he_net_place(n, at->v[i]));
    }
    const double area = he_vec3_length(he_vec3_cross(side[0], side[1]));
    for (unsigned i = 0; i < 3; i++) {
        look_at_angle(side[i], he_vec3_scale(side[i == 0 ? 2 : i - 1], -1), area, of, out);
        if (4 * t + i < at->twin[i]) { /* HE_NONE is larger than all corners */
            const double length = he_vec3_length(side[i]);
            out->shortest = fmin(out->shortest, length);
            out->longest = fmax(out->longest, length);
            of->sum += length;
            of->count++;
        }
    }
}

static double regular_share(const he_net *n)
{
    uint64_t regular = 0, all = 0;
    for (uint32_t v = 0; v < n->vertex_count; v++) {
        const he_net_vertex *at = &n->vertices[v];
        if ((at->flags & (HE_NET_DEAD | HE_NET_FIXED | HE_NET_LINE | HE_NET_BORDER)) == 0) {
            regular += at->degree == 6;
            all++;
        }
    }
    return all > 0 ? (double)regular / (double)all : 1;
}

static void report(const he_remeshing *r, double distance, he_remesh_stop stop, he_remeshed *out)
{
    const he_net *n = &r->net;
    measured of = {.of_smallest = -HUGE_VAL, .of_largest = HUGE_VAL};
    *out = (he_remeshed){.faces_before = r->ground.triangle_count,
                         .faces = n->live_triangles,
                         .shortest = HUGE_VAL,
                         .smallest_angle = HUGE_VAL,
                         .stop = stop};
    for (uint32_t t = 0; t < n->triangle_count; t++) {
        if (!he_net_is_gone(n, t)) {
            look_at(n, t, &of, out);
        }
    }
    if (of.count == 0) {
        out->shortest = out->smallest_angle = 0;
    }
    out->shortest = he_saturated(ldexp(out->shortest, n->exponent));
    out->longest = he_saturated(ldexp(out->longest, n->exponent));
    out->mean = of.count > 0 ? he_saturated(ldexp(of.sum / (double)of.count, n->exponent)) : 0;
    out->regular = regular_share(n);
    out->distance = he_saturated(ldexp(distance, n->exponent));
}

he_status he_remesh(he_mesh *m, const he_remesh_options *options, he_remeshed *out, he_error *err)
{
    he_remeshing r = {.progress = m->progress, .project = options->project};
    he_remesh_stop stop = HE_REMESH_SETTLED;
    double distance = 0;
    he_status status = check(m, options, err);
    if (status == HE_OK) {
        status = compute(m, options, &r, &stop, err);
    }
    if (status == HE_OK && out != NULL) {
        status = he_remesh_bound(&r, &distance, err);
    }
    if (status == HE_OK && r.ground.triangle_count > 0) {
        status = write(m, &r, err);
    }
    if (status == HE_OK && out != NULL) {
        report(&r, distance, stop, out);
    }
    he_net_clear(&r.net);
    he_ground_clear(&r.ground);
    return status;
}
