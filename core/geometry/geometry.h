/* geometry.h - lengths, areas, normals, angles.
 *
 * AREA VECTOR. A face of any degree, planar or not, has the vector
 *
 *     A = 1/2 sum p[i] x p[i + 1]           (Newell; Sutherland, Sproull, Schumacker 1974)
 *
 * Its length is the face's area and its direction the normal: towards whoever sees the corners
 * counter-clockwise. It does not depend on the corner it starts from.
 *
 * DEGENERATE faces have no direction that is not rounding noise: the normal is the zero vector and
 * the function says so. No finite input gives NaN or infinity: coordinates are scaled by powers of
 * two where their products would overflow or vanish, and an area, length or volume that a double
 * cannot hold is DBL_MAX.
 *
 * The functions of one element check nothing, like those of walk.h: the element lives, and its
 * links are what mesh.h promises. Links that do not close end the walk all the same, after as many
 * steps as there are half-edges, and the value means nothing. Those of the whole mesh give
 * HE_CORRUPT. Angles are in radians. */
#ifndef HE_GEOMETRY_GEOMETRY_H
#define HE_GEOMETRY_GEOMETRY_H

#include "geometry/vec3.h"

/* The unit vector from one point to another, zero when they are equal. The distance goes to
 * `*length`, which may be NULL. */
he_vec3 he_direction(he_vec3 from, he_vec3 to, double *length);

double he_edge_length(const he_mesh *m, he_edge e);

/* The angle between the normals of the two faces of an edge, in (-pi, pi]: positive where they form
 * a convex ridge, negative in a valley, 0 where they are coplanar. A face that is not flat counts
 * with the direction of its area vector, which is that of the plane nearest to its corners only
 * roughly and need not be perpendicular to the edge: the angle is then atan2((a x b) . d, a . b)
 * of the unit normals a of the first half-edge's face and b of its twin's, with d the unit vector
 * along the first half-edge, and |sin| of it may be less than |a x b|. False, and 0, on the
 * boundary or beside a degenerate face. */
bool he_edge_dihedral(const he_mesh *m, he_edge e, double *out);
/* The dihedrals of the whole mesh, into an array with one entry for each issued edge; NaN where
 * he_edge_dihedral returns false, and in dead rows. Each face is measured once, so the cost is
 * linear in the half-edges however many corners a face has. HE_NO_MEMORY; HE_CANCELLED leaves the
 * array half written. */
HE_NODISCARD he_status he_edge_dihedrals(const he_mesh *m, he_watch *watch, double *out,
                                         he_error *err);

/* Inside its face, between a half-edge and the one before it; in [0, pi], so a reflex corner gives
 * the smaller angle. At a hole the angle between the two boundary edges. 0 where an edge has no
 * length. */
double he_corner_angle(const he_mesh *m, he_halfedge h);

/* What one walk around a face tells. */
typedef struct he_face_shape {
    he_vec3 normal;   /* unit, or zero when degenerate */
    he_vec3 centroid; /* the mean of the corners, where face_poke puts its vertex */
    double area;
    uint32_t degree;
    bool degenerate;
} he_face_shape;

he_face_shape he_face_measure(const he_mesh *m, he_face f);
/* Each alone. The normal's function is false, with zero, on a degenerate face. */
bool he_face_normal(const he_mesh *m, he_face f, he_vec3 *out);
double he_face_area(const he_mesh *m, he_face f);
he_vec3 he_face_centroid(const he_mesh *m, he_face f);

/* How the faces about a vertex share in its normal. */
typedef enum he_weight {
    HE_WEIGHT_AREA,   /* by area */
    HE_WEIGHT_ANGLE,  /* by the corner's angle (Thuermer and Wuethrich 1998) */
    HE_WEIGHT_UNIFORM /* alike */
} he_weight;

/* Unit; zero and false when isolated, when all faces are degenerate, or when they cancel out. */
bool he_vertex_normal(const he_mesh *m, he_vertex v, he_weight weight, he_vec3 *out);

/* Normals of the whole mesh into an array of one entry for each issued row. Dead rows and
 * degenerate ones are zero. Linear. `watch`, which may be NULL, can end the work and lends threads
 * to that of faces: HE_CANCELLED and HE_CORRUPT leave the array half written. */
HE_NODISCARD he_status he_face_normals(const he_mesh *m, he_watch *watch, he_vec3 *out,
                                       he_error *err);
HE_NODISCARD he_status he_vertex_normals(const he_mesh *m, he_weight weight, he_watch *watch,
                                         he_vec3 *out, he_error *err);

/* Normals of corners, smooth but for creases: the mean, weighted by the corners' angles, over the
 * faces that are reached about the half-edge's origin without crossing a hole or an edge whose
 * faces' normals differ by more than `crease`, in [0, pi]. A degenerate face goes with the one
 * clockwise of it, so that it parts no others. Zero on boundary half-edges, and where the mean has
 * no direction.
 *
 * The one costs the faces about its origin; the whole mesh's fill an array of one entry for each
 * issued half-edge in linear time, with the threads of `watch`. HE_NO_MEMORY; HE_CANCELLED and
 * HE_CORRUPT leave the array half written. */
HE_NODISCARD he_status he_corner_normal(const he_mesh *m, he_halfedge h, double crease,
                                        he_vec3 *out, he_error *err);
HE_NODISCARD he_status he_corner_normals(const he_mesh *m, double crease, he_watch *watch,
                                         he_vec3 *out, he_error *err);

/* The box around all live vertices, isolated ones included. False and zero when there are none. */
typedef struct he_box {
    he_vec3 min, max;
} he_box;

bool he_mesh_box(const he_mesh *m, he_box *out);
/* The box around the vertices that have edges: what lengths and areas are measured in goes by this
 * one, so that an isolated vertex far away changes none of them. False and zero when there are no
 * edges. */
bool he_surface_box(const he_mesh *m, he_box *out);

/* The sum of the faces' areas, and the volume that a closed mesh encloses: positive where normals
 * point out of it, each face taken as the fan from the corner its stored half-edge leaves
 * (divergence theorem); for planar faces any fan is the same. Sums are compensated (Neumaier 1974)
 * and each face is measured in a scale of its own, so that large faces elsewhere and the distance
 * to the coordinates' origin take no digits away from small ones but those that the sum itself,
 * being one double, cannot hold. */
typedef struct he_measures {
    double area;
    double volume;   /* 0 unless closed */
    bool has_volume; /* closed: there are faces, and no boundary half-edge */
} he_measures;

HE_NODISCARD he_status he_mesh_measure(const he_mesh *m, he_measures *out, he_error *err);

#endif
