/* smooth_bilateral.c - the method bilateral: filtered normals of faces, which the vertices then
 * follow. */
#include "smooth/smoothing.h"

#include "geometry/vec3.h"

/* Normals that differ by this vector's length count 0.6 times as much as equal ones. */
static const double LIKENESS = 0.35;

enum { FOLLOW_STEPS = 10 };

typedef struct filter {
    he_vec3 *normals, *filtered, *centres;
    double *areas;
    double reach; /* mean distance of the centres of neighbouring faces */
} filter;

static void clear(filter *f)
{
    he_mem_free(f->normals);
    he_mem_free(f->filtered);
    he_mem_free(f->centres);
    he_mem_free(f->areas);
}

static bool is_triangle(const he_mesh *m, he_face f)
{
    const he_halfedge h = he_face_halfedge(m, f);
    return he_next(m, he_next(m, he_next(m, h))).i == h.i;
}

/* Measures all triangles. Other faces, which are not near any free vertex, have no weight. */
static he_status measure(he_smoothing *s, filter *f, he_error *err)
{
    const uint32_t issued = he_mesh_issued(s->mesh, HE_FACE);
    he_status status = HE_OK;
    for (uint32_t i = 0; i < issued && status == HE_OK; i++) {
        const he_face face = {i};
        status = he_progress_at(s->mesh->progress, i + 1, issued, err);
        f->areas[i] = 0;
        f->normals[i] = f->filtered[i] = (he_vec3){0, 0, 0};
        if (!he_face_is_live(s->mesh, face) || !is_triangle(s->mesh, face)) {
            continue;
        }
        const he_vec3 doubled = he_smooth_double_area(s, face);
        const double length = he_vec3_length(doubled);
        f->centres[i] = he_smooth_centre(s, face);
        if (length > 0) {
            f->areas[i] = length / 2;
            f->normals[i] = f->filtered[i] = he_vec3_scale(doubled, 1 / length);
        }
    }
    return status;
}

/* Finds the mean distance of the centres of faces at a common edge. */
static void find_reach(const he_smoothing *s, filter *f)
{
    double sum = 0, count = 0;
    for (uint32_t e = 0; e < he_mesh_issued(s->mesh, HE_EDGE); e++) {
        if (!he_edge_is_live(s->mesh, (he_edge){e})) {
            continue;
        }
        const he_face a = he_face_of(s->mesh, (he_halfedge){2 * e}),
                      b = he_face_of(s->mesh, (he_halfedge){2 * e + 1});
        if (a.i != HE_NONE && b.i != HE_NONE && f->areas[a.i] > 0 && f->areas[b.i] > 0) {
            sum += he_vec3_length(he_vec3_sub(f->centres[a.i], f->centres[b.i]));
            count++;
        }
    }
    f->reach = sum > 0 ? sum / count : 1;
}

/* Returns the normal of a face, filtered over the faces around its corners; a face that shares an
 * edge counts twice, because two corners lead to it. */
static he_vec3 filter_normal(const he_smoothing *s, const filter *f, he_face face)
{
    const he_mesh *m = s->mesh;
    const he_vec3 normal = f->normals[face.i];
    he_vec3 sum = he_vec3_scale(normal, f->areas[face.i]);
    const he_halfedge begin = he_face_halfedge(m, face);
    he_halfedge h = begin;
    do {
        for (he_halfedge k = he_swing_ccw(m, h); k.i != h.i; k = he_swing_ccw(m, k)) {
            const he_face other = he_face_of(m, k);
            if (other.i == HE_NONE || !(f->areas[other.i] > 0)) {
                continue;
            }
            const double far =
                he_vec3_length(he_vec3_sub(f->centres[other.i], f->centres[face.i])) / f->reach;
            const double unlike =
                he_vec3_length(he_vec3_sub(f->normals[other.i], normal)) / LIKENESS;
            const double weight = f->areas[other.i] * exp(-(far * far + unlike * unlike) / 2);
            sum = he_vec3_add(sum, he_vec3_scale(f->normals[other.i], weight));
        }
        h = he_next(m, h);
    } while (h.i != begin.i);
    const double length = he_vec3_length(sum);
    return length > 0 ? he_vec3_scale(sum, 1 / length) : normal;
}

/* Moves the free vertices towards the planes through the centres of their faces with the filtered
 * normals (Sun, Rosin, Martin and Langbein 2007). */
static he_status follow(he_smoothing *s, const filter *f, he_error *err)
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
            const he_face face = he_face_of(m, h);
            const he_vec3 normal = f->filtered[face.i];
            const double away = he_vec3_dot(normal, he_vec3_sub(he_smooth_centre(s, face), p));
            sum = he_vec3_add(sum, he_vec3_scale(normal, away));
            count++;
            h = he_swing_ccw(m, h);
        } while (h.i != first.i);
        s->next[v.i] = he_vec3_add(p, he_vec3_scale(sum, 1.0 / count));
        status = he_progress_at(m->progress, i + 1, s->count, err);
    }
    for (uint32_t i = 0; i < s->count && status == HE_OK; i++) {
        s->at[s->free[i]] = s->next[s->free[i]];
    }
    return status;
}

he_status he_smooth_bilateral(he_smoothing *s, he_error *err)
{
    const uint32_t issued = he_mesh_issued(s->mesh, HE_FACE);
    const size_t room = (size_t)issued + 1;
    filter f = {.normals = he_mem_array(NULL, room, sizeof *f.normals),
                .filtered = he_mem_array(NULL, room, sizeof *f.filtered),
                .centres = he_mem_array(NULL, room, sizeof *f.centres),
                .areas = he_mem_array(NULL, room, sizeof *f.areas)};
    he_status status = HE_OK;
    if (f.normals == NULL || f.filtered == NULL || f.centres == NULL || f.areas == NULL) {
        status = he_fail_plain(err, HE_NO_MEMORY, "no memory for the normals of %u faces", issued);
    } else {
        status = measure(s, &f, err);
        find_reach(s, &f);
    }
    for (uint32_t i = 0; i < issued && status == HE_OK; i++) {
        status = he_progress_at(s->mesh->progress, i + 1, issued, err);
        if (f.areas[i] > 0) {
            f.filtered[i] = filter_normal(s, &f, (he_face){i});
        }
    }
    for (int i = 0; i < FOLLOW_STEPS && status == HE_OK; i++) {
        status = follow(s, &f, err);
    }
    clear(&f);
    return status;
}
