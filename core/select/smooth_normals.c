#include "select/smooth_normals.h"

#include "geometry/geometry.h"
#include "geometry/scale.h"
#include "mesh/walk.h"

/* Appends the live faces without a normal that have a neighbour with one. */
static he_status find_first(const he_mesh *m, const he_vec3 *normals, he_ids *queue, he_error *err)
{
    he_status status = HE_OK;
    for (uint32_t f = 0; f < m->c.faces.issued && status == HE_OK; f++) {
        if (!he_is_no_normal(normals[f]) || !he_face_is_live(m, (he_face){f})) {
            continue;
        }
        he_halfedge first = he_face_halfedge(m, (he_face){f}), h = first;
        bool found = false;
        do {
            uint32_t g = he_face_of(m, he_twin(h)).i;
            found = g != HE_NONE && !he_is_no_normal(normals[g]);
            h = he_next(m, h);
        } while (!found && h.i != first.i);
        status = found ? he_ids_add(queue, f, err) : HE_OK;
    }
    return status;
}

/* Gives face f the normal of the first of its neighbours that has one, and appends its neighbours
 * without a normal to the queue. */
static he_status take(const he_mesh *m, he_vec3 *normals, uint32_t f, he_ids *queue, he_error *err)
{
    he_halfedge first = he_face_halfedge(m, (he_face){f}), h = first;
    he_status status = HE_OK;
    do {
        uint32_t g = he_face_of(m, he_twin(h)).i;
        if (g != HE_NONE && he_is_no_normal(normals[f])) {
            normals[f] = normals[g];
        }
        h = he_next(m, h);
    } while (h.i != first.i);
    do {
        uint32_t g = he_face_of(m, he_twin(h)).i;
        if (g != HE_NONE && he_is_no_normal(normals[g])) {
            status = he_ids_add(queue, g, err);
        }
        h = he_next(m, h);
    } while (status == HE_OK && h.i != first.i);
    return status;
}

/* Works breadth first. A face may be in the queue several times; only the first time counts, so the
 * queue has at most one entry for each half-edge. */
he_status he_normals_spread(const he_mesh *m, he_vec3 *normals, he_error *err)
{
    he_ids queue = {0};
    he_status status = find_first(m, normals, &queue, err);
    for (size_t i = 0; i < queue.count && status == HE_OK; i++) {
        status = he_progress_at(m->progress, i, queue.count, err);
        if (status == HE_OK && he_is_no_normal(normals[queue.ids[i]])) {
            status = take(m, normals, queue.ids[i], &queue, err);
        }
    }
    he_ids_clear(&queue);
    return status;
}

he_status he_smooth_normals(const he_mesh *m, he_vec3 **out, he_error *err)
{
    he_vec3 *normals = he_mem_array(NULL, (size_t)m->c.faces.issued + 1, sizeof *normals);
    if (normals == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory for the normals of %u faces",
                             m->c.faces.live);
    }
    he_status status = he_face_normals(m, m->progress, normals, err);
    if (status == HE_OK) {
        status = he_normals_spread(m, normals, err);
    }
    if (status != HE_OK) {
        he_mem_free(normals);
        return status;
    }
    *out = normals;
    return HE_OK;
}

double he_square_chord(double angle)
{
    const double noisy = angle + HE_ANGLE_NOISE;
    const double chord = noisy >= HE_PI ? 2 + HE_ANGLE_NOISE : 2 * sin(noisy / 2);
    return chord * chord;
}
