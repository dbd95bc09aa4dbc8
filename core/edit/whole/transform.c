#include "edit/whole/transform.h"

#include "edit/piece/list.h"
#include "edit/piece/point.h"
#include "edit/whole/normals.h"
#include "mesh/marks.h"
#include "mesh/write.h"

static he_vec3 apply(const double k[16], he_vec3 p)
{
    return (he_vec3){k[0] * p.x + k[1] * p.y + k[2] * p.z + k[3],
                     k[4] * p.x + k[5] * p.y + k[6] * p.z + k[7],
                     k[8] * p.x + k[9] * p.y + k[10] * p.z + k[11]};
}

he_status he_transform(he_mesh *m, const double matrix[16], const uint32_t *vertices, size_t count,
                       he_error *err)
{
    if (matrix[12] != 0 || matrix[13] != 0 || matrix[14] != 0 || matrix[15] != 1) {
        return he_fail_plain(err, HE_BAD_VALUE, "the last row of the matrix must be 0 0 0 1");
    }
    if (vertices != NULL) {
        he_status status = he_list_require(m, HE_VERTEX, vertices, count, HE_REPEATED_ELEMENT, err);
        if (status != HE_OK) {
            return status;
        }
    }
    he_marks marks;
    bool marked = he_marks_find(m, &marks);
    he_status status = he_progress_phase(m->progress, "checking", 0.3, err);
    size_t places = vertices != NULL ? count : m->c.vertices.issued, moved = 0;
    for (size_t i = 0; i < places && status == HE_OK; i++) {
        he_vertex v = {vertices != NULL ? vertices[i] : (uint32_t)i};
        status = he_progress_at(m->progress, i, places, err);
        if (!he_vertex_is_live(m, v)) {
            continue;
        }
        if (!he_point_is_finite(apply(matrix, he_position(m, v)))) {
            return he_fail(err, HE_NOT_FINITE, HE_VERTEX, v.i,
                           "vertex %u would have a position that is not finite", v.i);
        }
        if (status == HE_OK && marked) {
            status = he_require_unlocked(&marks, HE_VERTEX, v.i, err);
        }
        moved++;
    }
    he_normals normals = {0};
    he_reservation need = {.positions = moved};
    if (status == HE_OK) {
        status = he_progress_phase(m->progress, "moving", 1, err);
    }
    if (status == HE_OK) {
        status = he_normals_init(&normals, m, matrix, vertices, count, &need.links, err);
    }
    if (status == HE_OK) {
        status = he_reserve(m, need, err);
    }
    if (status != HE_OK) {
        he_normals_clear(&normals);
        return status;
    }
    /* Nothing below can fail. */
    for (size_t i = 0; i < places; i++) {
        he_vertex v = {vertices != NULL ? vertices[i] : (uint32_t)i};
        he_progress_note(m->progress, i, places);
        if (he_vertex_is_live(m, v)) {
            he_set_position(m, v, apply(matrix, he_position(m, v)));
        }
    }
    he_normals_commit(&normals);
    he_normals_clear(&normals);
    return HE_OK;
}
