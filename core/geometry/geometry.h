/* geometry.h - lengths, areas, normals, angles.
 *
 * AREA VECTOR. A face of any degree, planar or not, has the vector
 *
 *     A = 1/2 sum p[i] x p[i + 1]           (Newell; Sutherland, Sproull, Schumacker 1974)
 *
 * Its length is the face's area and its direction the normal: towards the side from which the
 * corners run counter-clockwise. It does not depend on the first corner.
 *
 * A face is DEGENERATE if the direction of its area vector is nothing but rounding noise. Its
 * normal is the zero vector, and functions that find the normal return false. No finite input gives
 * NaN or infinity: coordinates are scaled by powers of two where their products would overflow or
 * underflow, and an area, length or volume that a double cannot hold is DBL_MAX.
 *
 * Functions that take one element check nothing (as in walk.h): the element must be live, and its
 * links must be as mesh.h promises. If links do not close, a walk still ends after as many steps as
 * there are half-edges, and its result means nothing. Functions that take the whole mesh return
 * HE_CORRUPT in that case. Angles are in radians. */
#ifndef HE_GEOMETRY_GEOMETRY_H
#define HE_GEOMETRY_GEOMETRY_H

#include "geometry/vec3.h"

/* Returns the unit vector from one point to another, zero if they are equal. `*length`, which may
 * be NULL, gets the distance. */
he_vec3 he_direction(he_vec3 from, he_vec3 to, double *length);

double he_edge_length(const he_mesh *m, he_edge e);

/* Finds the angle between the normals of the two faces of an edge, in (-pi, pi]: positive for a
 * convex ridge, negative for a valley, 0 for coplanar faces. A face that is not planar counts with
 * the direction of its area vector, which need not be perpendicular to the edge: the angle is
 * atan2((a x b) . d, a . b) for the unit normals a of the first half-edge's face and b of its
 * twin's, with d the unit vector along the first half-edge, and |sin| of it may be less than |a x
 * b|. On the boundary and beside a degenerate face the angle is 0 and the function returns false.
 */
bool he_edge_dihedral(const he_mesh *m, he_edge e, double *out);
/* Finds the dihedral angles of the whole mesh, into an array with one entry for each issued edge:
 * NaN for edges where he_edge_dihedral returns false, and for deleted edges. Each face is measured
 * once, so the time is linear in the half-edges however many corners a face has.
 * Returns HE_NO_MEMORY if memory is out.
 * Returns HE_CANCELLED if the work was cancelled; the array is then half written. */
HE_NODISCARD he_status he_edge_dihedrals(const he_mesh *m, he_progress *progress, double *out,
                                         he_error *err);

/* Returns the angle between a half-edge and the one before it, in [0, pi]; for a reflex corner this
 * is not the angle inside the face but the smaller one outside. At a boundary half-edge it is the
 * angle between two boundary edges. Returns 0 if one of the two edges has no length. */
double he_corner_angle(const he_mesh *m, he_halfedge h);

/* The results of one walk around a face: area, normal and centroid. */
typedef struct he_face_shape {
    he_vec3 normal;   /* unit vector, or zero if the face is degenerate */
    he_vec3 centroid; /* the mean of the corners' positions */
    double area;
    uint32_t degree;
    bool degenerate;
} he_face_shape;

he_face_shape he_face_measure(const he_mesh *m, he_face f);
/* Each of these functions finds one property of a face. he_face_normal finds zero and returns false
 * if the face is degenerate. */
bool he_face_normal(const he_mesh *m, he_face f, he_vec3 *out);
double he_face_area(const he_mesh *m, he_face f);
he_vec3 he_face_centroid(const he_mesh *m, he_face f);

/* How the faces around a vertex are weighted in the vertex's normal. */
typedef enum he_weight {
    HE_WEIGHT_AREA,   /* the weight is the face's area */
    HE_WEIGHT_ANGLE,  /* the weight is the corner's angle (Thuermer and Wuethrich 1998) */
    HE_WEIGHT_UNIFORM /* all faces weigh the same */
} he_weight;

/* Finds the unit normal of a vertex. If the vertex is isolated, if all its faces are degenerate, or
 * if their normals cancel out, the normal is zero and the function returns false. */
bool he_vertex_normal(const he_mesh *m, he_vertex v, he_weight weight, he_vec3 *out);

/* These functions find the normals of all faces or vertices of a mesh, into an array of one entry
 * for each issued row, in linear time. The rows of deleted elements, and of elements without a
 * normal, are zero. `progress`, which may be NULL, can cancel the work and lends threads to
 * he_face_normals. On failure the array is half written.
 * Returns HE_CANCELLED if the work was cancelled.
 * Returns HE_CORRUPT if links do not close. */
HE_NODISCARD he_status he_face_normals(const he_mesh *m, he_progress *progress, he_vec3 *out,
                                       he_error *err);
HE_NODISCARD he_status he_vertex_normals(const he_mesh *m, he_weight weight, he_progress *progress,
                                         he_vec3 *out, he_error *err);

/* Finds normals of corners, smooth except at creases: the mean, weighted by the corners' angles, of
 * the faces around the half-edge's origin that can be reached without crossing a hole or an edge
 * between faces whose normals differ by more than `crease`, in [0, pi]. A degenerate face is
 * grouped with the next face clockwise, so that it separates no others. The normal is zero on
 * boundary half-edges, and if the mean has no direction.
 *
 * he_corner_normal takes time linear in the faces around the origin; he_corner_normals fills an
 * array of one entry for each issued half-edge in linear time, with the threads of `progress`. On
 * failure the array is half written.
 * Returns HE_NO_MEMORY if memory is out.
 * Returns HE_CANCELLED if the work was cancelled.
 * Returns HE_CORRUPT if links do not close. */
HE_NODISCARD he_status he_corner_normal(const he_mesh *m, he_halfedge h, double crease,
                                        he_vec3 *out, he_error *err);
HE_NODISCARD he_status he_corner_normals(const he_mesh *m, double crease, he_progress *progress,
                                         he_vec3 *out, he_error *err);

/* An axis-aligned box. */
typedef struct he_box {
    he_vec3 min, max;
} he_box;

/* Finds the box around all live vertices, isolated ones included. If there are none, the box is
 * zero and the function returns false. */
bool he_mesh_box(const he_mesh *m, he_box *out);
/* Finds the box around the vertices that have edges. Scales and tolerances are derived from this
 * box, so that an isolated vertex far away has no influence on them. If there are no edges, the box
 * is zero and the function returns false. */
bool he_surface_box(const he_mesh *m, he_box *out);

/* The sum of the faces' areas, and the volume that a closed mesh encloses: positive if normals
 * point outward, each face taken as the fan from the corner its stored half-edge leaves (divergence
 * theorem); for planar faces any fan gives the same volume. Sums are compensated (Neumaier 1974)
 * and each face is measured in a scale of its own, so small faces count with all the digits that a
 * sum in one double can hold, whatever large faces there are elsewhere, and however far the mesh is
 * from the origin. */
typedef struct he_measures {
    double area;
    double volume;   /* 0 unless the mesh is closed */
    bool has_volume; /* the mesh is closed: it has faces and no boundary half-edge */
} he_measures;

HE_NODISCARD he_status he_mesh_measure(const he_mesh *m, he_measures *out, he_error *err);

#endif
