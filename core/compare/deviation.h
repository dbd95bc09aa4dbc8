/* deviation.h - the operation deviation: the signed distance of each vertex of a mesh from the
 * surface of another mesh.
 *
 *         +        The distance is above 0 on the side to which the normals of the other surface
 *      ___|___     point: outside a closed surface.
 *         |
 *         -
 *
 * The sign is that of the scalar product with the normal of the nearest feature: of the triangle,
 * or the sum of the normals of the triangles at an edge, or that sum weighted by angles at a vertex
 * (J. A. Baerentzen and H. Aanaes, "Signed distance computation using the angle weighted
 * pseudonormal", 2005). This is exact for closed surfaces without self-intersections. Beside the
 * boundary of an open surface the sign says on which side of the triangles there the vertex is. A
 * seam of vertices that lie at one place but are not joined, as in files that store each triangle
 * by itself, is such a boundary: there signs may be wrong until the surface is welded. */
#ifndef HE_COMPARE_DEVIATION_H
#define HE_COMPARE_DEVIATION_H

#include "mesh/mesh.h"

typedef struct he_deviated {
    double least, largest;    /* of all vertices; `least` is below 0 if a vertex is inside */
    double mean, rms;         /* mean and root mean square of all vertices */
    uint32_t farthest_vertex; /* the vertex with the largest absolute value, HE_NONE if none */
} he_deviated;

/* Writes the deviations into an attribute of vertices. If it does not exist, it is created as a
 * float that is interpolated. Isolated vertices count, too. An edit: CHECK, RESERVE, COMMIT; V, E
 * and F stay. `out` may be NULL.
 * Returns HE_NO_FACES if `with` has no faces.
 * Returns HE_BAD_VALUE if the name is empty, too long or "position".
 * Returns HE_ATTRIBUTE_CLASH if the attribute is no float or double with one component.
 * Returns HE_LIMIT if a coordinate is more than 2^90 times larger than all of the other mesh.
 * Returns HE_IDS_EXHAUSTED if `with` has too many triangles for a tree of boxes (query/bvh.h).
 * Returns HE_CANCELLED if the work was cancelled, HE_NO_MEMORY if memory is out. */
HE_NODISCARD he_status he_deviation(he_mesh *m, const he_mesh *with, const char *attribute,
                                    he_deviated *out, he_error *err);

#endif
