/* foretell.c - estimates how many faces there will be, from a sample of the faces that there are.
 */
#include "geometry/geometry.h"
#include "geometry/scale.h"
#include "mesh/walk.h"
#include "remesh/remesh.h"
#include "remesh/remeshing.h"
#include "remesh/sizing.h"

#include <float.h>

/* The most faces that are looked at. */
enum { SAMPLES = 4096 };

/* Every `stride`-th of the faces that are to be replaced is looked at. */
typedef struct sample {
    const he_mesh *m;
    const he_remesh_options *options;
    size_t count, stride;
    he_sizing sizing;    /* if lengths depend on the curvature */
    double least_cosine; /* of the angle of an edge that is no crease */
} sample;

static bool is_triangle(const he_mesh *m, he_face f)
{
    const he_halfedge h = he_face_halfedge(m, f);
    return he_next(m, he_next(m, he_next(m, h))).i == h.i;
}

/* Finds the i-th face. Returns false if there is no such face, because the list was not checked, or
 * if the face is no triangle: remeshing refuses such a face, and it may have millions of corners.
 */
static bool find_face(const sample *s, size_t i, he_face *out)
{
    out->i = s->options->faces != NULL ? s->options->faces[i] : (uint32_t)i;
    return he_mesh_is_live(s->m, HE_FACE, out->i) && is_triangle(s->m, *out);
}

static double extent_of(const sample *s)
{
    he_vec3 low = {DBL_MAX, DBL_MAX, DBL_MAX}, high = {-DBL_MAX, -DBL_MAX, -DBL_MAX};
    he_face f;
    for (size_t i = 0; i < s->count; i += s->stride) {
        if (find_face(s, i, &f)) {
            he_halfedge h = he_face_halfedge(s->m, f);
            for (unsigned k = 0; k < 3; k++, h = he_next(s->m, h)) {
                const he_vec3 p = he_position(s->m, he_origin(s->m, h));
                low = (he_vec3){fmin(low.x, p.x), fmin(low.y, p.y), fmin(low.z, p.z)};
                high = (he_vec3){fmax(high.x, p.x), fmax(high.y, p.y), fmax(high.z, p.z)};
            }
        }
    }
    return fmax(high.x - low.x, fmax(high.y - low.y, high.z - low.z));
}

/* Returns the area vector of the first three corners of a face, twice as long as the area. */
static he_vec3 area_at(const he_mesh *m, he_halfedge h)
{
    const he_vec3 a = he_position(m, he_origin(m, h)), b = he_position(m, he_target(m, h));
    const he_vec3 c = he_position(m, he_target(m, he_next(m, h)));
    return he_vec3_cross(he_vec3_sub(b, a), he_vec3_sub(c, a));
}

/* Adds a face, and the halves of its edges that are no creases. */
static void add_face(const sample *s, he_face f, he_bending *to)
{
    const he_mesh *m = s->m;
    he_halfedge h = he_face_halfedge(m, f);
    he_vec3 own, beside;
    const he_vec3 area = area_at(m, h);
    to->area += 0.5 * he_vec3_length(area);
    if (!he_vec3_normalise(area, &own)) {
        return;
    }
    for (unsigned i = 0; i < 3; i++, h = he_next(m, h)) {
        const he_halfedge twin = he_twin(h);
        if (!he_is_boundary_halfedge(m, twin) && he_vec3_normalise(area_at(m, twin), &beside) &&
            he_vec3_dot(own, beside) >= s->least_cosine) {
            const he_vec3 p = he_position(m, he_origin(m, h));
            he_sizing_bend(he_vec3_sub(he_position(m, he_target(m, h)), p), own, beside, to);
        }
    }
}

/* Returns the wanted length at a face: from the curvature of the face and those beside it. */
static double length_at(const sample *s, he_face f)
{
    he_bending around = {.area = 0};
    if (s->options->by != HE_REMESH_BY_ERROR) {
        return s->options->edge_length;
    }
    add_face(s, f, &around);
    he_halfedge h = he_face_halfedge(s->m, f);
    for (unsigned i = 0; i < 3; i++, h = he_next(s->m, h)) {
        if (!he_is_boundary_halfedge(s->m, he_twin(h))) {
            add_face(s, he_face_of(s->m, he_twin(h)), &around);
        }
    }
    return he_sizing_length(&around, &s->sizing);
}

/* Estimates how many triangles take the place of a face: so many as have the same area, and for a
 * face that is longer but much lower than the wanted length, as many as fit along it. */
static double replace(const sample *s, he_face f)
{
    const he_mesh *m = s->m;
    const double length = length_at(s, f), area = he_face_area(m, f);
    const double many = area / length / length / HE_REMESH_MEAN_AREA;
    double longest = 0;
    he_halfedge h = he_face_halfedge(m, f);
    for (unsigned i = 0; i < 3; i++, h = he_next(m, h)) {
        longest = fmax(longest, he_edge_length(m, he_edge_of(h)));
    }
    const bool is_sliver = longest > length && 2 * area < 0.5 * length * longest;
    return is_sliver ? many + longest / length : many;
}

double he_remesh_foretell(const he_mesh *m, const he_remesh_options *options)
{
    const bool all = options->faces == NULL;
    const double faces = he_mesh_faces(m);
    const double chosen = all ? faces : fmin((double)options->face_count, faces);
    sample s = {.m = m,
                .options = options,
                .count = all ? he_mesh_issued(m, HE_FACE) : options->face_count,
                .least_cosine = cos(options->crease)};
    s.stride = s.count / SAMPLES + 1;
    if (options->by == HE_REMESH_BY_FACES) {
        return fmin(faces - chosen + options->target_faces, HE_REMESH_FACES);
    }
    if (options->by == HE_REMESH_BY_ERROR) {
        const double least = options->min_length > 0 ? options->min_length : options->error;
        const double most =
            options->max_length > 0 ? options->max_length : HE_REMESH_MOST_LENGTH * extent_of(&s);
        s.sizing = (he_sizing){options->error, fmin(least, most), most};
    }
    double sum = 0, count = 0;
    he_face f;
    for (size_t i = 0; i < s.count; i += s.stride) {
        if (find_face(&s, i, &f)) {
            sum += replace(&s, f);
            count++;
        }
    }
    const double made = count > 0 ? sum / count * chosen : 0;
    return made < HE_REMESH_FACES ? fmin(faces - chosen + made, HE_REMESH_FACES) : HE_REMESH_FACES;
}
