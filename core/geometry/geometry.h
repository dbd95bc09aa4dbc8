/* geometry.h - lengths, areas, normals, angles.
 *
 * AREA VECTOR. A face of any degree, planar or not, has the area vector
 *
 *     A = 1/2 sum p[i] x p[i + 1]           (Newell; Sutherland, Sproull, Schumacker 1974)
 *
 * The length of A is the area of the face. The direction of A is the normal of the face, which
 * points to the side from which the corners run counter-clockwise. A does not depend on which
 * corner is the first.
 *
 * A face is DEGENERATE if the direction of its area vector is nothing but rounding noise. The
 * normal of such a face is the zero vector, and functions that find the normal return false. No
 * finite input gives NaN or infinity: coordinates are scaled by powers of two where their products
 * would overflow or underflow, and an area, length or volume that a double cannot hold is DBL_MAX.
 *
 * Functions that take one element check nothing (as in walk.h): the element must be live, and its
 * links must satisfy the invariants of mesh.h. If the half-edges of a face do not form a loop, a
 * walk around the face still ends, after as many steps as the mesh has half-edges, and its result
 * is meaningless. Functions that take the whole mesh return HE_CORRUPT in that case. Angles are in
 * radians. */
#ifndef HE_GEOMETRY_GEOMETRY_H
#define HE_GEOMETRY_GEOMETRY_H

#include "geometry/vec3.h"

/* Returns the unit vector from one point to another, or the zero vector if the points are equal.
 * `*length` gets the distance between the points; `length` may be NULL. */
he_vec3 he_direction(he_vec3 from, he_vec3 to, double *length);

double he_edge_length(const he_mesh *m, he_edge e);

/* Finds the angle between the normals of the two faces of an edge, in (-pi, pi]: positive for a
 * convex ridge, negative for a valley, 0 for coplanar faces. The normal of a face that is not
 * planar is the direction of its area vector, which need not be perpendicular to the edge. The
 * angle is atan2((a x b) . d, a . b), where a is the unit normal of the first half-edge's face, b
 * the unit normal of its twin's face, and d the unit vector along the first half-edge. If the edge
 * is on the boundary or one of its faces is degenerate, the angle is 0 and the function returns
 * false. */
bool he_edge_dihedral(const he_mesh *m, he_edge e, double *out);
/* Finds the dihedral angles of all edges, into an array with one entry for each edge id ever
 * issued. An entry is NaN if the edge was deleted or he_edge_dihedral returns false for the edge.
 * The normal of each face is computed once, so the time is linear in the number of half-edges.
 * Returns HE_NO_MEMORY if memory is out.
 * Returns HE_CANCELLED if the work was cancelled; the array is then filled only in part. */
HE_NODISCARD he_status he_edge_dihedrals(const he_mesh *m, he_progress *progress, double *out,
                                         he_error *err);

/* Returns the angle at the origin of half-edge h between the edges of h and prev(h), in [0, pi]. At
 * a reflex corner this is the smaller angle outside the face and not the angle inside it. At a
 * boundary half-edge it is the angle between two boundary edges. Returns 0 if one of the two edges
 * has no length. */
double he_corner_angle(const he_mesh *m, he_halfedge h);

/* Returns the smallest of the angles at the corners of a face, in radians: pi / 3 for a triangle
 * with equal sides, and near 0 for a sliver. */
double he_face_smallest_angle(const he_mesh *m, he_face f);

/* The results of one walk around a face: area, normal and centroid. */
typedef struct he_face_shape {
    he_vec3 normal;   /* unit vector, or zero if the face is degenerate */
    he_vec3 centroid; /* the mean of the corners' positions */
    double area;
    uint32_t degree;
    bool degenerate;
} he_face_shape;

he_face_shape he_face_measure(const he_mesh *m, he_face f);
/* Each of these functions finds one property of a face. he_face_normal sets *out to the zero vector
 * and returns false if the face is degenerate. */
bool he_face_normal(const he_mesh *m, he_face f, he_vec3 *out);
double he_face_area(const he_mesh *m, he_face f);
he_vec3 he_face_centroid(const he_mesh *m, he_face f);

/* How the faces around a vertex are weighted in the vertex's normal. */
typedef enum he_weight {
    HE_WEIGHT_AREA, /* the weight is the face's area */
    /* the weight is the angle of the face's corner at the vertex (Thuermer and Wuethrich 1998) */
    HE_WEIGHT_ANGLE,
    HE_WEIGHT_UNIFORM /* all faces have equal weights */
} he_weight;

/* Finds the unit normal of a vertex. If the vertex is isolated, if all its faces are degenerate, or
 * if the normals of its faces cancel each other out, the normal is zero and the function returns
 * false. */
bool he_vertex_normal(const he_mesh *m, he_vertex v, he_weight weight, he_vec3 *out);

/* These functions find the normals of all faces or vertices of a mesh in linear time. They fill an
 * array that has one entry for each id ever issued. The entries of deleted elements, and of
 * elements without a normal, are zero vectors. `progress`, which may be NULL, can cancel the work,
 * and provides threads for he_face_normals. On failure the array is filled only in part.
 * Returns HE_CANCELLED if the work was cancelled.
 * Returns HE_CORRUPT if the half-edges of a face do not form a loop. */
HE_NODISCARD he_status he_face_normals(const he_mesh *m, he_progress *progress, he_vec3 *out,
                                       he_error *err);
HE_NODISCARD he_status he_vertex_normals(const he_mesh *m, he_weight weight, he_progress *progress,
                                         he_vec3 *out, he_error *err);

/* These functions find normals of corners that are smooth except at creases. A crease is an edge
 * between two faces whose normals differ by more than the angle `crease`, in [0, pi]. The normal of
 * a corner is the mean of the normals of those faces around the half-edge's origin that can be
 * reached from the corner's face without crossing a crease or a hole; a face is weighted by the
 * angle of its corner at that origin. A degenerate face is grouped with the next face clockwise, so
 * that it does not separate its neighbours. The normal of a boundary half-edge is zero, and so is a
 * mean without a direction.
 *
 * he_corner_normal takes time linear in the number of faces around the origin. he_corner_normals
 * fills an array that has one entry for each half-edge id ever issued, in linear time, with the
 * threads of `progress`. On failure the array is filled only in part.
 * Returns HE_NO_MEMORY if memory is out.
 * Returns HE_CANCELLED if the work was cancelled.
 * Returns HE_CORRUPT if the half-edges of a face or around a vertex do not form a loop. */
HE_NODISCARD he_status he_corner_normal(const he_mesh *m, he_halfedge h, double crease,
                                        he_vec3 *out, he_error *err);
HE_NODISCARD he_status he_corner_normals(const he_mesh *m, double crease, he_progress *progress,
                                         he_vec3 *out, he_error *err);

/* An axis-aligned box. */
typedef struct he_box {
    he_vec3 min, max;
} he_box;

/* Finds the smallest box around all live vertices, isolated ones included. If the mesh has no
 * vertices, the box is zero and the function returns false. */
bool he_mesh_box(const he_mesh *m, he_box *out);
/* Finds the smallest box around the vertices that have edges. Scales and tolerances are derived
 * from this box, so that an isolated vertex far away has no influence on them. If the mesh has no
 * edges, the box is zero and the function returns false. */
bool he_surface_box(const he_mesh *m, he_box *out);

/* The area of a mesh, which is the sum of the areas of its faces, and the volume that a closed mesh
 * encloses, which is positive if normals point outward (divergence theorem). For the volume, each
 * face is taken as a fan of triangles from the corner at the origin of the face's stored half-edge;
 * for planar faces every fan gives the same volume. Sums are compensated (Neumaier 1974), and each
 * face is measured in a scale of its own. So small faces count with all digits that a double can
 * hold in the sum, however large other faces are and however far the mesh is from the origin of
 * coordinates. */
typedef struct he_measures {
    double area;
    double volume;   /* 0 unless the mesh is closed */
    bool has_volume; /* true if the mesh is closed: it has faces and no boundary half-edge */
} he_measures;

HE_NODISCARD he_status he_mesh_measure(const he_mesh *m, he_measures *out, he_error *err);

#endif
