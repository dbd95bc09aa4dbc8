#include "edit/local/vertex.h"

#include "edit/piece/list.h"
#include "edit/piece/point.h"
#include "mesh/marks.h"
#include "mesh/write.h"

he_status he_vertex_add(he_mesh *m, he_vec3 position, he_vertex *out, he_error *err)
{
    if (!he_point_is_finite(position)) {
        return he_fail_plain(err, HE_NOT_FINITE, "the position of a vertex must be finite");
    }
    he_status status = he_reserve(m, (he_reservation){.vertices = 1}, err);
    if (status != HE_OK) {
        return status;
    }
    /* Nothing below can fail. */
    he_vertex v = he_new_vertex(m);
    he_set_vertex_halfedge(m, v, (he_halfedge){HE_NONE});
    he_set_position(m, v, position);
    if (out != NULL) {
        *out = v;
    }
    return HE_OK;
}

static he_vec3 moved(const he_mesh *m, he_vertex v, he_move how, he_vec3 point)
{
    if (how == HE_MOVE_TO) {
        return point;
    }
    he_vec3 p = he_position(m, v);
    return (he_vec3){p.x + point.x, p.y + point.y, p.z + point.z};
}

he_status he_vertex_move(he_mesh *m, const uint32_t *vertices, size_t count, he_move how,
                         const he_vec3 *points, size_t point_count, he_error *err)
{
    if (point_count != 1 && point_count != count) {
        return he_fail_plain(err, HE_BAD_VALUE, "%zu points are given for %zu vertices",
                             point_count, count);
    }
    he_status status = he_list_require(m, HE_VERTEX, vertices, count, HE_REPEATED_ELEMENT, err);
    if (status != HE_OK) {
        return status;
    }
    size_t step = point_count == 1 ? 0 : 1;
    he_marks marks;
    bool marked = he_marks_find(m, &marks);
    status = he_progress_phase(m->progress, "checking", 0.5, err);
    for (size_t i = 0; status == HE_OK && i < count; i++) {
        he_vertex v = {vertices[i]};
        status = he_progress_at(m->progress, i, count, err);
        if (status == HE_OK && marked) {
            status = he_require_unlocked(&marks, HE_VERTEX, v.i, err);
        }
        if (status == HE_OK && !he_point_is_finite(moved(m, v, how, points[i * step]))) {
            status = he_fail(err, HE_NOT_FINITE, HE_VERTEX, v.i,
                             "vertex %u would have a position that is not finite", v.i);
        }
    }
    if (status == HE_OK) {
        status = he_progress_phase(m->progress, "moving", 1, err);
    }
    if (status == HE_OK) {
        status = he_reserve(m, (he_reservation){.positions = count}, err);
    }
    if (status != HE_OK) {
        return status;
    }
    /* Nothing below can fail. */
    for (size_t i = 0; i < count; i++) {
        he_vertex v = {vertices[i]};
        he_progress_note(m->progress, i, count);
        he_set_position(m, v, moved(m, v, how, points[i * step]));
    }
    return HE_OK;
}
