#include "geometry/geometry.h"

#include "geometry/ring.h"
#include "mesh/walk.h"

he_vec3 he_direction(he_vec3 from, he_vec3 to, double *length)
{
    he_vec3 d = he_vec3_sub(to, from);
    double square = he_vec3_dot(d, d);
    if (square > HE_LEAST_PRODUCT && square < HE_MOST_PRODUCT) {
        double root = sqrt(square);
        if (length != NULL) {
            *length = root;
        }
        return (he_vec3){d.x / root, d.y / root, d.z / root};
    }
    int halved = 0;
    if (!he_vec3_is_finite(d)) {
        d = he_vec3_sub(he_vec3_scale(to, 0.5), he_vec3_scale(from, 0.5));
        halved = 1;
    }
    int exponent = he_exponent_of(he_vec3_extent(d));
    d = he_vec3_scale(d, ldexp(1, -exponent));
    double scaled = he_vec3_length(d);
    if (length != NULL) {
        *length = he_saturated(ldexp(scaled, exponent + halved));
    }
    he_vec3 unit;
    he_vec3_normalise(d, &unit);
    return unit;
}

double he_edge_length(const he_mesh *m, he_edge e)
{
    double length;
    he_direction(m->c.position[m->c.origin[2u * e.i]], m->c.position[m->c.origin[2u * e.i + 1u]],
                 &length);
    return length;
}

he_face_shape he_face_measure(const he_mesh *m, he_face f)
{
    int exponent;
    he_ring r = he_ring_of_face(m, f, &exponent);
    he_face_shape shape = {.centroid = he_ring_centroid(m, m->c.face_halfedge[f.i], &r, exponent),
                           .area = he_ring_area(&r, exponent),
                           .degree = r.degree};
    shape.degenerate = !he_ring_normal(&r, &shape.normal);
    return shape;
}

bool he_face_normal(const he_mesh *m, he_face f, he_vec3 *out)
{
    int exponent;
    he_ring r = he_ring_of_face(m, f, &exponent);
    return he_ring_normal(&r, out);
}

double he_face_area(const he_mesh *m, he_face f)
{
    int exponent;
    he_ring r = he_ring_of_face(m, f, &exponent);
    return he_ring_area(&r, exponent);
}

he_vec3 he_face_centroid(const he_mesh *m, he_face f)
{
    int exponent;
    he_ring r = he_ring_of_face(m, f, &exponent);
    return he_ring_centroid(m, m->c.face_halfedge[f.i], &r, exponent);
}

double he_corner_angle(const he_mesh *m, he_halfedge h)
{
    uint32_t prev = m->c.prev[h.i];
    uint32_t at = m->c.origin[h.i], to = m->c.origin[h.i ^ 1u];
    uint32_t from = prev < he_ring_budget(m) ? m->c.origin[prev] : HE_NONE;
    uint32_t vertices = m->c.vertices.issued;
    if (at >= vertices || to >= vertices || from >= vertices) {
        return 0;
    }
    double ahead, behind;
    he_vec3 a = he_direction(m->c.position[at], m->c.position[to], &ahead);
    he_vec3 b = he_direction(m->c.position[at], m->c.position[from], &behind);
    return ahead == 0 || behind == 0 ? 0 : he_vec3_angle(a, b);
}

double he_face_smallest_angle(const he_mesh *m, he_face f)
{
    he_halfedge first = he_face_halfedge(m, f), h = first;
    double least = HE_PI;
    do {
        least = fmin(least, he_corner_angle(m, h));
        h = he_next(m, h);
    } while (h.i != first.i);
    return least;
}

/* Returns the dihedral angle of edge e. `left` and `right` are the unit normals of the faces of the
 * edge's first and second half-edge. */
static double dihedral_between(const he_mesh *m, he_edge e, he_vec3 left, he_vec3 right)
{
    he_halfedge h = he_edge_halfedge(e, 0);
    he_vec3 along =
        he_direction(he_position(m, he_origin(m, h)), he_position(m, he_target(m, h)), NULL);
    double sine = he_vec3_dot(he_vec3_cross(left, right), along);
    double angle = atan2(sine, he_vec3_dot(left, right)) + 0.0; /* turns -0 into 0 */
    return angle > -HE_PI ? angle : HE_PI;
}

bool he_edge_dihedral(const he_mesh *m, he_edge e, double *out)
{
    he_halfedge h = he_edge_halfedge(e, 0);
    he_vec3 left, right;
    *out = 0;
    if (he_is_boundary_edge(m, e) || !he_face_normal(m, he_face_of(m, h), &left) ||
        !he_face_normal(m, he_face_of(m, he_twin(h)), &right)) {
        return false;
    }
    *out = dihedral_between(m, e, left, right);
    return true;
}

static bool is_zero(he_vec3 v)
{
    return v.x == 0 && v.y == 0 && v.z == 0;
}

static double dihedral_or_nan(const he_mesh *m, he_edge e, const he_vec3 *normals)
{
    if (!he_edge_is_live(m, e) || he_is_boundary_edge(m, e)) {
        return NAN;
    }
    he_vec3 left = normals[he_face_of(m, he_edge_halfedge(e, 0)).i];
    he_vec3 right = normals[he_face_of(m, he_edge_halfedge(e, 1)).i];
    return is_zero(left) || is_zero(right) ? NAN : dihedral_between(m, e, left, right);
}

he_status he_edge_dihedrals(const he_mesh *m, he_progress *progress, double *out, he_error *err)
{
    uint32_t faces = m->c.faces.issued, edges = m->c.edges.issued;
    he_vec3 *normals = he_mem_array(NULL, (size_t)faces + 1, sizeof *normals);
    he_status status = HE_OK;
    if (normals == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory for the normals of %u faces", faces);
    }
    for (uint32_t f = 0; f < faces && status == HE_OK; f++) {
        status = he_progress_at(progress, f, (uint64_t)faces + edges, err);
        if (he_face_is_live(m, (he_face){f})) {
            (void)he_face_normal(m, (he_face){f}, &normals[f]);
        }
    }
    for (uint32_t e = 0; e < edges && status == HE_OK; e++) {
        status = he_progress_at(progress, (uint64_t)faces + e, (uint64_t)faces + edges, err);
        out[e] = dihedral_or_nan(m, (he_edge){e}, normals);
    }
    he_mem_free(normals);
    return status;
}
