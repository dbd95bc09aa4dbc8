#include "smooth/smooth.h"

#include "edit/piece/list.h"
#include "edit/whole/positions.h"
#include "geometry/scale.h"
#include "mesh/marks.h"
#include "smooth/smoothing.h"

#include <float.h>
#include <string.h>

static void clear(he_smoothing *s)
{
    he_mem_free(s->at);
    he_mem_free(s->next);
    he_mem_free(s->is_free);
    he_mem_free(s->free);
}

static he_status allocate(he_smoothing *s, he_error *err)
{
    const uint32_t issued = he_mesh_issued(s->mesh, HE_VERTEX);
    const size_t room = (size_t)issued + 1;
    s->at = he_mem_array(NULL, room, sizeof *s->at);
    s->next = he_mem_array(NULL, room, sizeof *s->next);
    s->is_free = he_bits_new(room);
    s->free = he_mem_array(NULL, room, sizeof *s->free);
    return s->at != NULL && s->next != NULL && s->is_free != NULL && s->free != NULL
               ? HE_OK
               : he_fail_plain(err, HE_NO_MEMORY, "no memory to smooth %u vertices", issued);
}

/* --- the vertices that may move --- */

/* Returns true if nothing around a vertex keeps it in place. */
static bool may_move(const he_mesh *m, const he_marks *marks, he_vertex v)
{
    const he_halfedge first = he_vertex_halfedge(m, v);
    if (first.i == HE_NONE || he_is_locked(marks, HE_VERTEX, v.i)) {
        return false;
    }
    he_halfedge h = first;
    do {
        const he_face f = he_face_of(m, h);
        const he_edge e = he_edge_of(h);
        if (f.i == HE_NONE || he_is_feature(marks, e) || he_is_locked(marks, HE_EDGE, e.i) ||
            he_is_locked(marks, HE_FACE, f.i)) {
            return false;
        }
        h = he_swing_ccw(m, h);
    } while (h.i != first.i);
    return true;
}

static he_status list_free(he_smoothing *s, he_error *err)
{
    const he_mesh *m = s->mesh;
    const he_smooth_options *o = s->options;
    const uint32_t issued = he_mesh_issued(m, HE_VERTEX);
    he_marks marks = {.feature = NULL};
    (void)he_marks_find(m, &marks);
    for (size_t i = 0; i < o->vertex_count && o->vertices != NULL; i++) {
        he_bits_set(s->is_free, o->vertices[i]);
    }
    he_status status = HE_OK;
    for (uint32_t i = 0; i < issued && status == HE_OK; i++) {
        const he_vertex v = {i};
        status = he_progress_at(m->progress, i + 1, issued, err);
        const bool chosen = o->vertices == NULL || he_bits_get(s->is_free, i);
        s->is_free[i >> 6] &= ~((uint64_t)1 << (i & 63));
        if (chosen && he_vertex_is_live(m, v) && may_move(m, &marks, v)) {
            he_bits_set(s->is_free, i);
            s->free[s->count++] = i;
        }
    }
    return status;
}

static he_status require_triangles(const he_smoothing *s, he_error *err)
{
    const he_mesh *m = s->mesh;
    for (uint32_t i = 0; i < s->count && s->options->method != HE_SMOOTH_TAUBIN; i++) {
        const he_halfedge first = he_vertex_halfedge(m, (he_vertex){s->free[i]});
        he_halfedge h = first;
        do {
            if (he_next(m, he_next(m, he_next(m, h))).i != h.i) {
                const uint32_t f = he_face_of(m, h).i;
                return he_fail(err, HE_NOT_TRIANGLE, HE_FACE, f, "face %u is not a triangle", f);
            }
            h = he_swing_ccw(m, h);
        } while (h.i != first.i);
    }
    return HE_OK;
}

static he_status require_closed(const he_smoothing *s, he_error *err)
{
    const uint32_t sides = he_mesh_issued(s->mesh, HE_HALFEDGE);
    for (uint32_t h = 0; h < sides && s->options->keep_volume; h++) {
        const uint32_t e = h / 2;
        if (he_edge_is_live(s->mesh, (he_edge){e}) &&
            he_face_of(s->mesh, (he_halfedge){h}).i == HE_NONE) {
            return he_fail(err, HE_BOUNDARY_EDGE, HE_EDGE, e,
                           "only a closed surface has a volume to keep, but edge %u is on a "
                           "boundary",
                           e);
        }
    }
    return HE_OK;
}

/* --- scaled positions --- */

static void scale(he_smoothing *s)
{
    const he_mesh *m = s->mesh;
    const uint32_t issued = he_mesh_issued(m, HE_VERTEX);
    he_vec3 low = {INFINITY, INFINITY, INFINITY}, high = {-INFINITY, -INFINITY, -INFINITY};
    for (uint32_t v = 0; v < issued; v++) {
        const he_vec3 p = he_position(m, (he_vertex){v});
        if (he_vertex_is_live(m, (he_vertex){v})) {
            low = (he_vec3){fmin(low.x, p.x), fmin(low.y, p.y), fmin(low.z, p.z)};
            high = (he_vec3){fmax(high.x, p.x), fmax(high.y, p.y), fmax(high.z, p.z)};
        }
    }
    if (he_mesh_vertices(m) == 0) {
        s->scale = 1;
        return;
    }
    const he_vec3 middle = he_vec3_add(he_vec3_scale(low, 0.5), he_vec3_scale(high, 0.5));
    const double extent = he_vec3_extent(he_vec3_sub(high, middle));
    s->scale = he_unit_of(extent);
    for (uint32_t v = 0; v < issued; v++) {
        const he_vec3 p = he_vec3_sub(he_position(m, (he_vertex){v}), middle);
        s->at[v] = he_vertex_is_live(m, (he_vertex){v}) ? he_vec3_scale(p, 1 / s->scale)
                                                        : (he_vec3){0, 0, 0};
    }
}

/* Returns the time of a step that evens out bumps about as large as a triangle: a tenth of the
 * square of the mean length of the edges at free vertices, in scaled units. */
static double usual_amount(const he_smoothing *s)
{
    double sum = 0, count = 0;
    for (uint32_t i = 0; i < s->count; i++) {
        const he_halfedge first = he_vertex_halfedge(s->mesh, (he_vertex){s->free[i]});
        he_halfedge h = first;
        do {
            const uint32_t end = he_target(s->mesh, h).i;
            sum += he_vec3_length(he_vec3_sub(s->at[end], s->at[s->free[i]]));
            count++;
            h = he_swing_ccw(s->mesh, h);
        } while (h.i != first.i);
    }
    const double mean = count > 0 ? sum / count : 0;
    return mean * mean / 10;
}

/* --- the volume --- */

/* Returns the scaled volume. If `slopes` is not NULL, sets, for each vertex, the vector by which
 * the volume grows if the vertex moves. Faces are cut into fans of triangles. */
static double volume_of(const he_smoothing *s, he_vec3 *slopes)
{
    const he_mesh *m = s->mesh;
    double sum = 0;
    if (slopes != NULL) {
        memset(slopes, 0, he_mesh_issued(m, HE_VERTEX) * sizeof *slopes);
    }
    for (uint32_t f = 0; f < he_mesh_issued(m, HE_FACE); f++) {
        if (!he_face_is_live(m, (he_face){f})) {
            continue;
        }
        const he_halfedge first = he_face_halfedge(m, (he_face){f});
        const uint32_t a = he_origin(m, first).i;
        he_halfedge h = he_next(m, first);
        for (; he_next(m, h).i != first.i; h = he_next(m, h)) {
            const uint32_t b = he_origin(m, h).i, c = he_target(m, h).i;
            const he_vec3 at_a = he_vec3_cross(s->at[b], s->at[c]);
            sum += he_vec3_dot(s->at[a], at_a) / 6;
            if (slopes != NULL) {
                const he_vec3 at_b = he_vec3_cross(s->at[c], s->at[a]),
                              at_c = he_vec3_cross(s->at[a], s->at[b]);
                slopes[a] = he_vec3_add(slopes[a], he_vec3_scale(at_a, 1.0 / 6));
                slopes[b] = he_vec3_add(slopes[b], he_vec3_scale(at_b, 1.0 / 6));
                slopes[c] = he_vec3_add(slopes[c], he_vec3_scale(at_c, 1.0 / 6));
            }
        }
    }
    return sum;
}

/* Moves the free vertices along the slopes of the volume until it is `wanted`, by Newton's method
 * with the slopes of each position. */
static void restore_volume(he_smoothing *s, double wanted)
{
    enum { TRIES = 20 };
    for (int i = 0; i < TRIES; i++) {
        const double missing = wanted - volume_of(s, s->next);
        double square = 0;
        for (uint32_t k = 0; k < s->count; k++) {
            square += he_vec3_dot(s->next[s->free[k]], s->next[s->free[k]]);
        }
        if (!(square > 0) || fabs(missing) <= 1e-15 * fabs(wanted)) {
            return;
        }
        for (uint32_t k = 0; k < s->count; k++) {
            const uint32_t v = s->free[k];
            s->at[v] = he_vec3_add(s->at[v], he_vec3_scale(s->next[v], missing / square));
        }
    }
}

/* --- the whole --- */

static he_status step(he_smoothing *s, he_error *err)
{
    switch (s->options->method) {
    case HE_SMOOTH_TAUBIN:
        return he_smooth_taubin(s, err);
    case HE_SMOOTH_BILATERAL:
        return he_smooth_bilateral(s, err);
    case HE_SMOOTH_TANGENTIAL:
        return he_smooth_tangential(s, err);
    case HE_SMOOTH_LAPLACIAN:
    case HE_SMOOTH_METHODS:
        break;
    }
    return he_smooth_laplacian(s, err);
}

/* Surfaces that have shrunk to less than this scaled area are not smoothed further. */
static const double NO_AREA = 1e-250;

/* Does all steps. The steps of a small mesh are too short to be told of one by one. */
static he_status do_steps(he_smoothing *s, he_error *err)
{
    he_progress *progress = s->mesh->progress;
    he_status status = HE_OK;
    for (unsigned i = 0; i < s->options->steps && status == HE_OK && s->count > 0; i++) {
        if (i == 0 || s->count >= HE_PROGRESS_STRIDE) {
            const double to = 0.1 + 0.7 * (i + 1) / s->options->steps;
            status = he_progress_phase(progress, "smoothing", to, err);
        }
        if (s->options->method == HE_SMOOTH_LAPLACIAN && !(s->options->time > 0)) {
            s->amount = usual_amount(s);
            if (!(s->amount > NO_AREA)) {
                break;
            }
        }
        if (status == HE_OK) {
            status = step(s, err);
        }
    }
    return status;
}

/* Turns the scaled positions into those of the mesh: each free vertex moves by the scaled
 * difference, so that a coordinate that did not change keeps its bits. */
static void unscale(he_smoothing *s, const he_vec3 *before, he_smoothed *out)
{
    const uint32_t issued = he_mesh_issued(s->mesh, HE_VERTEX);
    *out = (he_smoothed){.moved = 0};
    for (uint32_t v = 0; v < issued; v++) {
        const he_vec3 p = he_position(s->mesh, (he_vertex){v});
        const he_vec3 way = he_vec3_scale(he_vec3_sub(s->at[v], before[v]), s->scale);
        s->at[v] = he_bits_get(s->is_free, v) ? he_vec3_add(p, way) : p;
        const double length = hypot(hypot(s->at[v].x - p.x, s->at[v].y - p.y), s->at[v].z - p.z);
        if (length > 0) {
            out->moved++;
            out->largest = fmax(out->largest, length);
            out->mean += (length - out->mean) / out->moved;
        }
    }
}

static he_status smooth(he_smoothing *s, he_vec3 *before, he_smoothed *out, he_error *err)
{
    const bool closed = s->mesh->c.boundary_halfedges == 0;
    const double given = s->options->time;
    scale(s);
    memcpy(before, s->at, he_mesh_issued(s->mesh, HE_VERTEX) * sizeof *before);
    s->amount = given / s->scale / s->scale;
    if (isinf(s->amount)) {
        return he_fail_plain(err, HE_BAD_VALUE, "the time of a step, %g, is too large", given);
    }
    const double volume = volume_of(s, NULL);
    he_status status = do_steps(s, err);
    if (status != HE_OK) {
        return status;
    }
    if (s->options->keep_volume) {
        restore_volume(s, volume);
    }
    const double grown = volume_of(s, NULL) - volume;
    unscale(s, before, out);
    const double volume_grown = grown * s->scale * s->scale * s->scale;
    out->volume = closed ? fmin(fmax(volume_grown, -DBL_MAX), DBL_MAX) : 0;
    return HE_OK;
}

static he_status check_options(const he_mesh *m, const he_smooth_options *o, he_error *err)
{
    if (o->method >= HE_SMOOTH_METHODS || o->steps < 1 || o->steps > HE_SMOOTH_STEPS) {
        return he_fail_plain(err, HE_BAD_VALUE, "a smoothing does 1 to %d steps, not %u",
                             (int)HE_SMOOTH_STEPS, o->steps);
    }
    if (!(o->time >= 0) || isinf(o->time)) {
        return he_fail_plain(err, HE_BAD_VALUE, "the time of a step must be above 0, not %g",
                             o->time);
    }
    return o->vertices == NULL ? HE_OK
                               : he_list_require(m, HE_VERTEX, o->vertices, o->vertex_count,
                                                 HE_REPEATED_ELEMENT, err);
}

he_status he_smooth(he_mesh *m, const he_smooth_options *options, he_smoothed *out, he_error *err)
{
    he_smoothing s = {.mesh = m, .options = options};
    he_smoothed done = {.moved = 0};
    he_vec3 *before = NULL;
    he_status status = check_options(m, options, err);
    if (status == HE_OK) {
        status = he_progress_phase(m->progress, "preparing", 0.1, err);
    }
    if (status == HE_OK) {
        status = allocate(&s, err);
    }
    if (status == HE_OK) {
        status = list_free(&s, err);
    }
    if (status == HE_OK) {
        status = require_triangles(&s, err);
    }
    if (status == HE_OK) {
        status = require_closed(&s, err);
    }
    if (status == HE_OK) {
        before = he_mem_array(NULL, (size_t)he_mesh_issued(m, HE_VERTEX) + 1, sizeof *before);
        status = before == NULL
                     ? he_fail_plain(err, HE_NO_MEMORY, "no memory to smooth %u vertices", s.count)
                     : smooth(&s, before, &done, err);
    }
    if (status == HE_OK) {
        status = he_positions_write(m, NULL, he_mesh_issued(m, HE_VERTEX), s.at, false, err);
    }
    if (status == HE_OK && out != NULL) {
        *out = done;
    }
    he_mem_free(before);
    clear(&s);
    return status;
}
