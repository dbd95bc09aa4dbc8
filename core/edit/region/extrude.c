#include "edit/region/extrude.h"

#include "geometry/geometry.h"
#include "mesh/walk.h"

/* Finds the normal of a region: the direction of the sum of the vector areas of its faces. Each
 * vector area is divided by the largest area, so that the sum cannot overflow. If the vector areas
 * nearly cancel out, their sum is rounding noise without a direction, and the function returns
 * false. */
static bool find_direction(const he_mesh *m, const he_region *r, he_vec3 *out)
{
    const double noise = 1e-12;
    const he_ids *faces = &r->faces.ids;
    if (faces->count == 1) {
        return he_face_normal(m, (he_face){faces->ids[0]}, out);
    }
    double largest = 0, total = 0;
    for (size_t i = 0; i < faces->count; i++) {
        largest = fmax(largest, he_face_area(m, (he_face){faces->ids[i]}));
    }
    if (largest <= 0) {
        return false;
    }
    he_vec3 sum = {0, 0, 0};
    for (size_t i = 0; i < faces->count; i++) {
        he_face_shape shape = he_face_measure(m, (he_face){faces->ids[i]});
        sum = he_vec3_add(sum, he_vec3_scale(shape.normal, shape.area / largest));
        total += shape.area / largest;
    }
    double length = he_vec3_length(sum);
    if (!(length > noise * total)) {
        return false;
    }
    *out = he_vec3_scale(sum, 1 / length);
    return true;
}

static he_status place(const he_mesh *m, const he_region *r, void *context, he_vec3 *to,
                       he_vec3 *shift, bool *shifts, he_error *err)
{
    const he_extrude_motion *motion = context;
    if (motion->by != NULL) {
        *shift = *motion->by;
    } else {
        uint32_t f = r->faces.ids.ids[0];
        if (!find_direction(m, r, shift)) {
            return he_fail(err, HE_NO_NORMAL, HE_FACE, f,
                           "face %u and the faces extruded with it have no common normal: give a "
                           "vector instead of a distance",
                           f);
        }
        *shift = he_vec3_scale(*shift, motion->distance);
    }
    *shifts = true;
    for (size_t i = 0; i < r->corners.ids.count; i++) {
        to[i] = he_vec3_add(he_position(m, (he_vertex){r->corners.ids.ids[i]}), *shift);
    }
    return HE_OK;
}

he_status he_face_extrude(he_mesh *m, const uint32_t *faces, size_t count, bool region,
                          he_extrude_motion motion, he_region_parts *out, he_error *err)
{
    return he_region_draw(m, faces, count, region, (he_region_place){place, &motion, NULL}, out,
                          err);
}
