#include "deform/deform.h"

#include "edit/whole/positions.h"
#include "geometry/scale.h"
#include "geometry/vec3.h"
#include "mesh/marks.h"
#include "mesh/walk.h"

static he_vec3 map(const double k[16], he_vec3 p)
{
    return (he_vec3){k[0] * p.x + k[1] * p.y + k[2] * p.z + k[3],
                     k[4] * p.x + k[5] * p.y + k[6] * p.z + k[7],
                     k[8] * p.x + k[9] * p.y + k[10] * p.z + k[11]};
}

static he_status check_goal(const he_deform_sets *sets, const he_deform_goal *goal, he_error *err)
{
    const double *k = goal->matrix;
    if (k != NULL && (k[12] != 0 || k[13] != 0 || k[14] != 0 || k[15] != 1)) {
        return he_fail_plain(err, HE_BAD_VALUE, "the last row of the matrix must be 0 0 0 1");
    }
    if (k == NULL && goal->count != 1 && goal->count != sets->handle_count) {
        return he_fail_plain(err, HE_BAD_VALUE, "%zu points are given for %zu vertices",
                             goal->count, sets->handle_count);
    }
    return HE_OK;
}

he_status he_deform_goals(const he_mesh *m, const he_deform_sets *sets, const he_deform_goal *goal,
                          he_vec3 *out, he_error *err)
{
    he_marks marks = {.feature = NULL};
    (void)he_marks_find(m, &marks);
    he_status status = check_goal(sets, goal, err);
    for (size_t i = 0; i < sets->handle_count && status == HE_OK; i++) {
        const uint32_t v = sets->handles[i];
        const he_vec3 p = he_position(m, (he_vertex){v});
        const size_t k = goal->count == 1 ? 0 : i;
        out[i] = goal->matrix != NULL ? map(goal->matrix, p)
                 : goal->to != NULL   ? goal->to[k]
                                      : he_vec3_add(p, goal->by[k]);
        if (!he_vec3_is_finite(out[i])) {
            return he_fail(err, HE_NOT_FINITE, HE_VERTEX, v,
                           "vertex %u would have a position that is not finite", v);
        }
        if (he_vec3_extent(he_vec3_sub(out[i], p)) > 0) {
            status = he_require_unlocked(&marks, HE_VERTEX, v, err);
        } else {
            out[i] = p; /* which may be -0 where the goal is 0 */
        }
    }
    return status;
}

/* Lists the free vertices and the handles that move, with their new positions, and writes them. */
static he_status write_all(he_mesh *m, const he_deform_sets *sets, const he_deformer *d,
                           const he_deform_motion *motion, he_deformed *out, he_error *err)
{
    uint32_t free_count = 0;
    const uint32_t *free = he_deformer_vertices(d, &free_count);
    const uint32_t issued = he_mesh_issued(m, HE_VERTEX);
    he_vec3 *points = he_mem_array(NULL, (size_t)issued + 1, sizeof *points);
    if (points == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory to deform %u vertices", issued);
    }
    for (uint32_t v = 0; v < issued; v++) {
        points[v] = he_position(m, (he_vertex){v});
    }
    for (uint32_t i = 0; i < free_count; i++) {
        points[free[i]] = motion->positions[i];
    }
    for (size_t i = 0; i < sets->handle_count; i++) {
        points[sets->handles[i]] = motion->goals[i];
    }
    *out = (he_deformed){.energy = motion->energy};
    for (uint32_t v = 0; v < issued; v++) {
        const he_vec3 way = he_vec3_sub(points[v], he_position(m, (he_vertex){v}));
        const double length = he_saturated(hypot(hypot(way.x, way.y), way.z));
        if (length > 0) {
            out->moved++;
            out->largest = fmax(out->largest, length);
            out->mean += (length - out->mean) / out->moved;
        }
    }
    he_status status = he_positions_write(m, NULL, issued, points, false, err);
    he_mem_free(points);
    return status;
}

static he_status deform(he_mesh *m, const he_deform_sets *sets, he_deform_motion *motion,
                        he_deformed *done, he_error *err)
{
    he_deformer *d = NULL;
    he_status status = he_progress_phase(m->progress, "preparing", 0.3, err);
    if (status == HE_OK) {
        status = he_deformer_make(m, sets, m->progress, &d, err);
    }
    if (status != HE_OK) {
        return status;
    }
    uint32_t free_count = 0;
    (void)he_deformer_vertices(d, &free_count);
    he_vec3 *positions = he_mem_array(NULL, (size_t)free_count + 1, sizeof *positions);
    motion->positions = positions;
    status = positions == NULL
                 ? he_fail_plain(err, HE_NO_MEMORY, "no memory to deform %u vertices", free_count)
                 : he_progress_phase(m->progress, "deforming", 0.9, err);
    if (status == HE_OK) {
        status = he_deformer_solve(d, motion, m->progress, err);
    }
    if (status == HE_OK) {
        status = write_all(m, sets, d, motion, done, err);
    }
    he_mem_free(positions);
    he_deformer_free(d);
    return status;
}

he_status he_deform(he_mesh *m, const he_deform_sets *sets, const he_deform_goal *goal,
                    unsigned steps, he_deformed *out, he_error *err)
{
    he_status status = he_deform_check(m, sets, err);
    if (status != HE_OK) {
        return status;
    }
    he_deformed done;
    he_vec3 *goals = he_mem_array(NULL, sets->handle_count, sizeof *goals);
    if (goals == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory for %zu points", sets->handle_count);
    }
    he_deform_motion motion = {.goals = goals, .steps = steps};
    status = he_deform_goals(m, sets, goal, goals, err);
    if (status == HE_OK) {
        status = deform(m, sets, &motion, &done, err);
    }
    he_mem_free(goals);
    if (status == HE_OK && out != NULL) {
        *out = done;
    }
    return status;
}
