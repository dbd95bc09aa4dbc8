/* smooth_local.c - methods that move each vertex by what is around it: taubin and tangential. */
#include "smooth/smoothing.h"

#include "geometry/vec3.h"

he_vec3 he_smooth_double_area(const he_smoothing *s, he_face f)
{
    const he_halfedge h = he_face_halfedge(s->mesh, f), k = he_next(s->mesh, h);
    const he_vec3 p = s->at[he_origin(s->mesh, h).i];
    return he_vec3_cross(he_vec3_sub(s->at[he_origin(s->mesh, k).i], p),
                         he_vec3_sub(s->at[he_target(s->mesh, k).i], p));
}

he_vec3 he_smooth_centre(const he_smoothing *s, he_face f)
{
    const he_halfedge h = he_face_halfedge(s->mesh, f), k = he_next(s->mesh, h);
    const he_vec3 sum =
        he_vec3_add(he_vec3_add(s->at[he_origin(s->mesh, h).i], s->at[he_origin(s->mesh, k).i]),
                    s->at[he_target(s->mesh, k).i]);
    return he_vec3_scale(sum, 1.0 / 3);
}

/* Moves all free vertices at once to what s->next holds for them. */
static void take_next(he_smoothing *s)
{
    for (uint32_t i = 0; i < s->count; i++) {
        s->at[s->free[i]] = s->next[s->free[i]];
    }
}

/* --- taubin --- */

/* The two factors of Taubin's filter: it lets frequencies below 0.1 pass. */
static const double SHRINK = 0.5, GROW = -1 / 1.9;

/* Moves each free vertex by a part of the way to the mean of its neighbours. */
static he_status pull(he_smoothing *s, double part, he_error *err)
{
    const he_mesh *m = s->mesh;
    he_status status = HE_OK;
    for (uint32_t i = 0; i < s->count && status == HE_OK; i++) {
        const he_vertex v = {s->free[i]};
        const he_halfedge first = he_vertex_halfedge(m, v);
        const he_vec3 p = s->at[v.i];
        he_vec3 sum = {0, 0, 0};
        unsigned count = 0;
        he_halfedge h = first;
        do {
            sum = he_vec3_add(sum, he_vec3_sub(s->at[he_target(m, h).i], p));
            count++;
            h = he_swing_ccw(m, h);
        } while (h.i != first.i);
        s->next[v.i] = he_vec3_add(p, he_vec3_scale(sum, part / count));
        status = he_progress_at(m->progress, i + 1, s->count, err);
    }
    if (status == HE_OK) {
        take_next(s);
    }
    return status;
}

he_status he_smooth_taubin(he_smoothing *s, he_error *err)
{
    he_status status = pull(s, SHRINK, err);
    return status == HE_OK ? pull(s, GROW, err) : status;
}

/* --- tangential --- */

/* Returns where a vertex should move to: half of the way to the mean of the centres of its faces,
 * without the part along its normal. */
static he_vec3 tangential(const he_smoothing *s, he_vertex v)
{
    const he_mesh *m = s->mesh;
    const he_halfedge first = he_vertex_halfedge(m, v);
    const he_vec3 p = s->at[v.i];
    he_vec3 way = {0, 0, 0}, normal = {0, 0, 0};
    double area = 0;
    he_halfedge h = first;
    do {
        const he_face f = he_face_of(m, h);
        const he_vec3 doubled = he_smooth_double_area(s, f);
        const double weight = he_vec3_length(doubled);
        way = he_vec3_add(way, he_vec3_scale(he_vec3_sub(he_smooth_centre(s, f), p), weight));
        normal = he_vec3_add(normal, doubled);
        area += weight;
        h = he_swing_ccw(m, h);
    } while (h.i != first.i);
    const double square = he_vec3_dot(normal, normal);
    if (!(area > 0) || !(square > 0)) {
        return p;
    }
    way = he_vec3_scale(way, 0.5 / area);
    way = he_vec3_sub(way, he_vec3_scale(normal, he_vec3_dot(way, normal) / square));
    return he_vec3_add(p, way);
}

he_status he_smooth_tangential(he_smoothing *s, he_error *err)
{
    he_status status = HE_OK;
    for (uint32_t i = 0; i < s->count && status == HE_OK; i++) {
        s->next[s->free[i]] = tangential(s, (he_vertex){s->free[i]});
        status = he_progress_at(s->mesh->progress, i + 1, s->count, err);
    }
    if (status == HE_OK) {
        take_next(s);
    }
    return status;
}
